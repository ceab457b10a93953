/* Phong's model of light (B. T. Phong, "Illumination for computer generated pictures", 1975).

   Legend: C the material's colour, ka kd ks m its ambient, diffuse, specular coefficients and shininess; n the unit normal
   on the viewer's side; v the unit vector to the viewer; l the unit vector to a light; I the light's colour; r = 2 (n.l) n -
   l the mirror image of l. All colours linear:
       light = ka C + sum over the lights with n.l > 0 that nothing hides of  I (kd C (n.l) + ks max(0, r.v)^m).
   The ambient light is white, 1. The highlight has the light's colour, not the material's. Intensity does not fall off with
   distance.

   Shadow rays. A hit at the exact parameter T of o + T d is reported as t = T rounded, and as p~ = o + t d computed in
   doubles: p~ is next to the surface, inside or outside. How far at most is derived in docs/bounds.md under QN_SHADE_POINT:
       |p~_i - p_i| + the rounding of the moved point <= B_i = QN_SHADE_POINT (|t d_i| + |p~_i|).
   The start is moved outwards by sum |n_i| B_i, the bound's share along the normal, so that it is not under the tangent
   plane of the hit. That is a matter of the picture alone: it places the ray, whose answer is as exact as any other. */
#include "image/light.h"
#include "base/bounds.h"
#include "image/colour.h"
#include "image/vec.h"

#include <string.h>

/* The default pair: directions in the picture's frame (right, up, towards the viewer), and intensities. */
static const double key_from[3] = {-0.55, 0.75, 0.60};
#define KEY_LIGHT 0.85
#define FILL_LIGHT 0.35

void qn_lamps_default(const qn_frustum *f, qn_lamp out[QN_DEFAULT_LAMPS]) {
  out[0] = (qn_lamp){.color = {KEY_LIGHT, KEY_LIGHT, KEY_LIGHT}, .directional = 1};
  out[1] = (qn_lamp){.color = {FILL_LIGHT, FILL_LIGHT, FILL_LIGHT}, .directional = f->orthographic, .headlight = 1};
  for (int i = 0; i < 3; i++) {
    out[0].place[i] = key_from[0] * f->right[i] + key_from[1] * f->up[i] - key_from[2] * f->forward[i];
    out[1].place[i] = f->orthographic ? -f->forward[i] : f->eye[i];
  }
  (void)qn_unit3(out[0].place); /* of vectors that are not zero */
}

int qn_lamp_from_light(const qn_light *light, qn_lamp *out) {
  *out = (qn_lamp){.directional = light->directional};
  for (int i = 0; i < 3; i++) {
    out->place[i] = light->directional ? -light->direction[i] : light->at[i];
    out->color[i] = light->color[i] > 0 ? light->color[i] : 0;
    if (!isfinite(out->place[i]) || !isfinite(out->color[i])) {
      return 0;
    }
  }
  return !light->directional || qn_unit3(out->place);
}

static double at_least_0(double x) {
  return x > 0 ? x : 0; /* not a number: 0 */
}

void qn_finish_from_material(const qn_material *m, qn_finish *out) {
  for (int i = 0; i < 3; i++) {
    out->color[i] = qn_srgb_to_linear(m->color[i]);
  }
  out->ambient = at_least_0(m->ambient);
  out->diffuse = at_least_0(m->diffuse);
  out->specular = at_least_0(m->specular);
  out->shininess = at_least_0(m->shininess);
}

void qn_light_ambient(const qn_finish *finish, double out[3]) {
  for (int i = 0; i < 3; i++) {
    out[i] = finish->ambient * finish->color[i];
  }
}

int qn_light_towards(const qn_lamp *lamp, const qn_spot *spot, double towards[3], double *cosine) {
  for (int i = 0; i < 3; i++) {
    towards[i] = lamp->directional ? lamp->place[i] : lamp->place[i] - spot->point[i];
  }
  if (!lamp->directional && !qn_unit3(towards)) {
    return 0;
  }
  *cosine = qn_dot3(spot->normal, towards);
  return *cosine > 0;
}

void qn_light_add(const qn_finish *finish, const qn_lamp *lamp, const qn_spot *spot, const double towards[3], double cosine,
                  double out[3]) {
  double highlight = 0;
  if (!lamp->headlight && finish->specular > 0) {
    const double mirror = 2 * cosine * qn_dot3(spot->normal, spot->viewer) - qn_dot3(towards, spot->viewer);
    highlight = mirror > 0 ? finish->specular * pow(mirror, finish->shininess) : 0;
  }
  for (int i = 0; i < 3; i++) {
    out[i] += lamp->color[i] * (finish->diffuse * finish->color[i] * cosine + highlight);
  }
}

void qn_shadow_ray(const quoin_ray *ray, double t, const double point[3], const double normal[3],
                   const qn_lamp *lamp, quoin_ray *out) {
  double away = 0;
  for (int i = 0; i < 3; i++) {
    away += fabs(normal[i]) * (QN_SHADE_POINT * (fabs(t * ray->d[i]) + fabs(point[i])));
  }
  for (int i = 0; i < 3; i++) {
    out->o[i] = point[i] + away * normal[i];
    out->d[i] = lamp->directional ? lamp->place[i] : lamp->place[i] - out->o[i];
  }
  out->from = 0;
  out->to = lamp->directional ? INFINITY : 1;
}
