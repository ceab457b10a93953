/* Lamps and finishes from what the model says. */
#include "image/light.h"
#include "image/colour.h"
#include "image/vec.h"

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
