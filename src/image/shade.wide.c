/* Phong's model of light (B. T. Phong, "Illumination for computer generated pictures", 1975), 64 hits at a time.

   Legend: C the material's colour, kd ks m its diffuse and specular coefficients and shininess; n the unit normal on the viewer's side;
   v the unit vector to the viewer; l the unit vector to a light; I the light's colour; r = 2 (n.l) n - l the mirror image of l. All
   colours linear. A light with n.l > 0 that nothing hides adds  I (kd C (n.l) + ks max(0, r.v)^m).

   Normals. y = o - pivot + t d of the surface's first leaf; a half-space q <= 0 has the gradient n (a plane), 2 sum s_i X_i row_i + 2 l row_2 (a
   quadric, half of which is taken here), a superquadric's by the chain rule. Its sign is that which looks at the viewer: what is seen is
   seen from there.

   Shadow rays. A hit at the exact parameter T of o + T d is known as t = T rounded, and as p~ = o + t d computed in doubles: p~ is next to the
   surface, inside or outside. How far at most is derived in docs/bounds.md under QN_SHADE_POINT:
       |p~_i - p_i| + the rounding of the moved point <= B_i = QN_SHADE_POINT (|t d_i| + |p~_i|).
   The start is moved outwards by sum |n_i| B_i, the bound's share along the normal, so that it is not under the tangent plane of the hit. That
   is a matter of the picture alone: it places the ray, whose answer is as exact as any other. */
#include "base/bounds.h"
#include "image/power.h"
#include "image/shade.h"
#include "image/vec.h"
#include "query/look.h"
#include "wide/vec.h"

#include <math.h>

enum { GROUPS = QN_LANES / QN_W };

/* Directions whose mean unit vector is shorter than the root of this are too far apart for a packet. */
#define TOGETHER 0.9

QN_INLINE unsigned lanes_of(uint64_t lanes, int g) {
  return (unsigned)(lanes >> (g * QN_W)) & QN_ALL_BITS;
}
QN_INLINE vd dot(const vd a[3], const vd b[3]) {
  return vadd(vadd(vmul(a[0], b[0]), vmul(a[1], b[1])), vmul(a[2], b[2]));
}

/* To unit length, scaled first so that no square over- or underflows; the lanes in which it had a length. */
QN_INLINE vm unit(vd v[3]) {
  const vd size = vmax(vabs(v[0]), vmax(vabs(v[1]), vabs(v[2]))), one = vset(1);
  const vm some = vand(vlt(vset(0), size), vlt(size, vset(INFINITY)));
  for (int i = 0; i < 3; i++) {
    v[i] = vdiv(v[i], size);
  }
  const vd scale = vdiv(one, vsqrt(dot(v, v)));
  for (int i = 0; i < 3; i++) {
    v[i] = vmul(v[i], scale);
  }
  return some;
}

/* Half the gradient of a quadric at pivot + y. */
QN_INLINE void quadric_gradient(const qn_quadric_shadow *q, const vd y[3], vd out[3]) {
  out[0] = out[1] = out[2] = vset(0);
  for (int i = 0; i < 3; i++) {
    const double *row = q->row[i];
    vd x = vadd(vadd(vadd(vmul(vset(row[0]), y[0]), vmul(vset(row[1]), y[1])), vmul(vset(row[2]), y[2])), vset(row[3]));
    vd slope = vadd(vmul(vset(q->s[i]), x), vset(i == 2 ? q->l : 0));
    for (int j = 0; j < 3; j++) {
      out[j] = vadd(out[j], vmul(slope, vset(row[j])));
    }
  }
}

/* Lane by lane: the gradient of a superquadric takes powers of its own. */
static void super_gradient(const quoin_scene *scene, const qn_half *half, unsigned lanes, const vd y[3], vd out[3]) {
  _Alignas(64) double at[3][QN_W], to[3][QN_W] = {{0}};
  for (int i = 0; i < 3; i++) {
    vstore(at[i], y[i]);
  }
  for (unsigned m = lanes; m; m &= m - 1) {
    const unsigned k = qn_trailing_zeros(m);
    const double place[3] = {at[0][k], at[1][k], at[2][k]};
    double g[3];
    qn_half_gradient(scene, half, place, g);
    to[0][k] = g[0], to[1][k] = g[1], to[2][k] = g[2];
  }
  for (int i = 0; i < 3; i++) {
    out[i] = vload(to[i]);
  }
}

/* The normals of the lanes that are on one surface. */
static void normals_on(const quoin_scene *scene, const qn_packet *rays, uint32_t number, uint64_t lanes, qn_spots *spots) {
  const qn_surface *surface = &scene->surfaces[number];
  const qn_half *half = &scene->halves[surface->half];
  const double *pivot = scene->leaves[surface->leaf].pivot;
  double flat[3] = {0, 0, 0};
  const int plane = half->kind == QN_PLANE;
  if (plane) {
    memcpy(flat, scene->planes[half->shadow].n, sizeof flat);
    (void)qn_unit3(flat); /* of a plane's normal, which is not zero */
  }
  for (int g = 0; g < GROUPS; g++) {
    const unsigned in = lanes_of(lanes, g);
    if (!in) {
      continue;
    }
    const int at = g * QN_W;
    vd n[3], viewer[3];
    if (plane) {
      for (int i = 0; i < 3; i++) {
        n[i] = vset(flat[i]);
        viewer[i] = vload(spots->viewer[i] + at);
      }
    } else {
      vd y[3];
      const vd t = vload(spots->t + at);
      for (int i = 0; i < 3; i++) {
        y[i] = vadd(vsub(vload(rays->o[i] + at), vset(pivot[i])), vmul(t, vload(rays->d[i] + at)));
      }
      if (half->kind == QN_SUPER_BODY) {
        super_gradient(scene, half, in, y, n);
      } else {
        quadric_gradient(&scene->quadrics[half->shadow], y, n);
      }
      const vm some = unit(n);
      for (int i = 0; i < 3; i++) {
        viewer[i] = vload(spots->viewer[i] + at);
        n[i] = vpick(some, n[i], viewer[i]); /* at a singular point */
      }
    }
    const vm away = vlt(dot(n, viewer), vset(0)), here = vmask(in);
    for (int i = 0; i < 3; i++) {
      const vd turned = vpick(away, vsub(vset(0), n[i]), n[i]);
      vstore(spots->normal[i] + at, vpick(here, turned, vload(spots->normal[i] + at)));
    }
  }
}

static void place(const quoin_scene *scene, const qn_packet *rays, uint64_t lanes, qn_spots *spots) {
  for (int g = 0; g < GROUPS; g++) {
    if (!lanes_of(lanes, g)) {
      continue;
    }
    const int at = g * QN_W;
    const vd t = vload(spots->t + at);
    vd viewer[3];
    for (int i = 0; i < 3; i++) {
      const vd d = vload(rays->d[i] + at);
      vstore(spots->point[i] + at, vadd(vload(rays->o[i] + at), vmul(t, d)));
      viewer[i] = vsub(vset(0), d);
    }
    (void)unit(viewer); /* of a direction, which is not zero */
    for (int i = 0; i < 3; i++) {
      vstore(spots->viewer[i] + at, viewer[i]);
    }
  }
  for (uint64_t left = lanes; left;) {
    const uint32_t surface = spots->surface[qn_trailing_zeros(left)];
    uint64_t same = 0;
    for (unsigned i = 0; i < QN_LANES; i++) {
      same |= (uint64_t)(spots->surface[i] == surface) << i;
    }
    same &= left;
    normals_on(scene, rays, surface, same, spots);
    left &= ~same;
  }
}

static uint64_t face(const qn_lamp *lamp, uint64_t lanes, qn_spots *spots) {
  uint64_t lit = 0;
  for (int g = 0; g < GROUPS; g++) {
    const unsigned in = lanes_of(lanes, g);
    if (!in) {
      continue;
    }
    const int at = g * QN_W;
    vd towards[3], normal[3];
    for (int i = 0; i < 3; i++) {
      normal[i] = vload(spots->normal[i] + at);
      towards[i] = lamp->directional ? vset(lamp->place[i]) : vsub(vset(lamp->place[i]), vload(spots->point[i] + at));
    }
    const vm some = lamp->directional ? vmask(QN_ALL_BITS) : unit(towards);
    const vd cosine = dot(normal, towards);
    for (int i = 0; i < 3; i++) {
      vstore(spots->towards[i] + at, towards[i]);
    }
    vstore(spots->cosine + at, cosine);
    lit |= (uint64_t)(vbits(vand(some, vlt(vset(0), cosine))) & in) << at;
  }
  return lit;
}

static uint64_t shadow(const qn_lamp *lamp, const qn_packet *rays, uint64_t lanes, const qn_spots *spots, qn_packet *out) {
  uint64_t rays_made = 0;
  const unsigned first = qn_trailing_zeros(lanes); /* stands for the lanes that are not asked */
  for (unsigned turn = 0; turn <= GROUPS; turn++) { /* that lane's group comes first */
    const unsigned g = turn == 0 ? first / QN_W : turn - 1;
    if (turn != 0 && g == first / QN_W) {
      continue;
    }
    const unsigned at = g * QN_W;
    const vm here = vmask(lanes_of(lanes, (int)g));
    const vd t = vload(spots->t + at);
    vd away = vset(0), p[3], n[3], start[3], way[3];
    for (int i = 0; i < 3; i++) {
      p[i] = vload(spots->point[i] + at), n[i] = vload(spots->normal[i] + at);
      const vd along = vabs(vmul(t, vload(rays->d[i] + at)));
      away = vadd(away, vmul(vabs(n[i]), vmul(vset(QN_SHADE_POINT), vadd(along, vabs(p[i])))));
    }
    for (int i = 0; i < 3; i++) {
      start[i] = vadd(p[i], vmul(away, n[i]));
      way[i] = lamp->directional ? vset(lamp->place[i]) : vsub(vset(lamp->place[i]), start[i]);
    }
    const vd size = vmax(vabs(way[0]), vmax(vabs(way[1]), vabs(way[2])));
    const vm some = vand(vlt(vset(0), size), vlt(size, vset(INFINITY)));
    rays_made |= (uint64_t)(vbits(vand(some, here))) << at;
    for (int i = 0; i < 3; i++) {
      way[i] = vpick(some, way[i], vset(i == 0));
      vstore(out->o[i] + at, start[i]), vstore(out->d[i] + at, way[i]);
    }
    for (int i = 0; i < 3; i++) { /* now that the first lane's are there */
      vstore(out->o[i] + at, vpick(here, start[i], vset(out->o[i][first])));
      vstore(out->d[i] + at, vpick(here, way[i], vset(out->d[i][first])));
    }
  }
  return rays_made;
}

static void highlights(const qn_spots *spots, const double mirror[QN_LANES], double out[QN_LANES]) {
  _Alignas(64) double y[QN_LANES];
  for (int i = 0; i < QN_LANES; i++) {
    y[i] = spots->shininess[i] * qn_log2(mirror[i]);
  }
  for (int at = 0; at < QN_LANES; at += QN_W) {
    vstore(y + at, vmin(vmax(vload(y + at), vset(QN_EXP2_LEAST)), vset(-QN_EXP2_LEAST)));
  }
  for (int i = 0; i < QN_LANES; i++) {
    out[i] = spots->specular[i] * qn_exp2(y[i]);
  }
}

static void add(const qn_lamp *lamp, uint64_t lanes, qn_spots *spots) {
  _Alignas(64) double mirror[QN_LANES], highlight[QN_LANES];
  const int shiny = spots->shiny && !lamp->headlight;
  if (shiny) {
    for (int at = 0; at < QN_LANES; at += QN_W) {
      vd n[3], v[3], l[3];
      for (int i = 0; i < 3; i++) {
        n[i] = vload(spots->normal[i] + at), v[i] = vload(spots->viewer[i] + at), l[i] = vload(spots->towards[i] + at);
      }
      vstore(mirror + at, vsub(vmul(vmul(vset(2), vload(spots->cosine + at)), dot(n, v)), dot(l, v)));
    }
    highlights(spots, mirror, highlight);
  }
  for (int g = 0; g < GROUPS; g++) {
    const unsigned in = lanes_of(lanes, g);
    if (!in) {
      continue;
    }
    const int at = g * QN_W;
    const vm here = vmask(in);
    const vd diffuse = vload(spots->diffuse + at), cosine = vload(spots->cosine + at), zero = vset(0);
    const vd shine = shiny ? vpick(vlt(zero, vload(mirror + at)), vload(highlight + at), zero) : zero;
    for (int i = 0; i < 3; i++) {
      const vd sum = vadd(vmul(vmul(diffuse, vload(spots->color[i] + at)), cosine), shine), before = vload(spots->light[i] + at);
      vstore(spots->light[i] + at, vpick(here, vadd(before, vmul(vset(lamp->color[i]), sum)), before));
    }
  }
}

static void clamp(qn_spots *spots) {
  for (int i = 0; i < 3; i++) {
    for (int at = 0; at < QN_LANES; at += QN_W) {
      vstore(spots->light[i] + at, vmax(vmin(vload(spots->light[i] + at), vset(1)), vset(0)));
    }
  }
}

static int together(const qn_packet *rays, uint64_t lanes) {
  vd sum[3] = {vset(0), vset(0), vset(0)};
  for (int g = 0; g < GROUPS; g++) {
    const vm here = vmask(lanes_of(lanes, g));
    vd d[3];
    for (int i = 0; i < 3; i++) {
      d[i] = vload(rays->d[i] + g * QN_W);
    }
    (void)unit(d);
    for (int i = 0; i < 3; i++) {
      sum[i] = vadd(sum[i], vpick(here, d[i], vset(0)));
    }
  }
  double square = 0;
  for (int i = 0; i < 3; i++) {
    _Alignas(64) double part[QN_W];
    double whole = 0;
    vstore(part, sum[i]);
    for (int k = 0; k < QN_W; k++) {
      whole += part[k];
    }
    square += whole * whole;
  }
  const double n = (double)__builtin_popcountll(lanes);
  return square > TOGETHER * n * n;
}

extern const qn_shade QN_OF_ISA(qn_shade);
#define QN_TEXT_AGAIN_(x) #x
#define QN_TEXT_(x) QN_TEXT_AGAIN_(x)
const qn_shade QN_OF_ISA(qn_shade) = {QN_TEXT_(QN_ISA_NAME), place, face, shadow, add, clamp, together};
