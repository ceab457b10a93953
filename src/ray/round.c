/* The double nearest to a place (design S8): a Newton step in double-doubles on the surface's exact coefficients, taken
   when the result with its bound rounds to one double (Ziv's test), else exact arithmetic.

   Legend: q the surface's form in world coordinates, p(t) = q(o + t d), r the root, |r - t| <= e. With rho = r - t,
   p + p' rho + a rho^2 = 0 exactly (p, p' at t), so for the computed p^, p'^ and delta = -p^/p'^
       |rho - delta| <= (|p - p^| + |p' - p'^| e + |a| e^2)/|p'^|.
   Bounds: docs/bounds.md, QN_DD_EVAL, QN_SLOPE_E. Source of the test: Ziv (1991), see docs/references.md. */
#include "base/bounds.h"
#include "number/dd.h"
#include "ray/scratch.h"

#include <math.h>
#include <string.h>

/* a 2^-scale to 2^-105 of itself. */
static qn_dd scaled(qn_int a, int64_t scale) {
  mp_size_t n = a.n < 0 ? -a.n : a.n;
  if (n == 0) {
    return (qn_dd){0, 0};
  }
  uint64_t top = a.d[n - 1], next = n > 1 ? a.d[n - 2] : 0, last = n > 2 ? a.d[n - 3] : 0;
  unsigned shift = qn_leading_zeros(top);
  if (shift) {
    top = top << shift | next >> (64 - shift);
    next = next << shift | last >> (64 - shift);
  }
  /* 128 bits: 53, then 53 more */
  double hi = (double)(top >> 11), lo = (double)((top & 0x7ff) << 42 | next >> 22);
  int64_t e = (int64_t)qn_int_bits(a) - 53 - scale;
  if (e < -1000) {
    return (qn_dd){0, 0}; /* within QN_DD_TINY */
  }
  uint64_t power = (uint64_t)(e + 1023) << 52; /* 2^e: e <= 0 */
  double unit;
  memcpy(&unit, &power, sizeof unit);
  unit = a.n < 0 ? -unit : unit;
  return qn_dd_quick_sum(hi * unit, lo * 0x1p-53 * unit);
}

static int usable(double v) {
  v = fabs(v);
  return v == 0 || (v <= QN_DD_LARGEST && v >= 1 / QN_DD_LARGEST);
}

/* The surface's coefficients, and which of them there are. */
typedef struct coefficients {
  qn_dd k[10];
  double m[10]; /* magnitudes */
  int plane, mixed; /* mixed: D, E, F are not all zero */
} coefficients;

static void take(const qn_exact_surface *form, coefficients *out) {
  size_t scale = 0;
  for (int i = form->plane ? 6 : 0; i < 10; i++) {
    size_t bits = qn_int_bits(form->q[i]);
    scale = bits > scale ? bits : scale;
  }
  out->plane = form->plane;
  for (int i = form->plane ? 6 : 0; i < 10; i++) {
    out->k[i] = scaled(form->q[i], (int64_t)scale);
    out->m[i] = fabs(out->k[i].hi);
  }
  out->mixed = !form->plane && (form->q[3].n || form->q[4].n || form->q[5].n);
}

/* Where the line is at t, and how large the terms are that make it. */
typedef struct spot { qn_dd x[3]; double X[3]; } spot;

/* p and its slope at a spot with the sizes M, M' and A of docs/bounds.md. */
typedef struct value { double p, slope, size, slope_size, curve; } value;

static void value_of_plane(const coefficients *c, const spot *at, const double d[3], value *v) {
  const qn_dd *k = c->k + 6;
  const double *m = c->m + 6;
  qn_dd p = qn_dd_add(qn_dd_add(qn_dd_mul(k[0], at->x[0]), qn_dd_mul(k[1], at->x[1])), qn_dd_add(qn_dd_mul(k[2], at->x[2]), k[3]));
  v->p = p.hi;
  v->size = m[0] * at->X[0] + m[1] * at->X[1] + m[2] * at->X[2] + m[3];
  v->slope = k[0].hi * d[0] + k[1].hi * d[1] + k[2].hi * d[2];
  v->slope_size = m[0] * fabs(d[0]) + m[1] * fabs(d[1]) + m[2] * fabs(d[2]);
  v->curve = 0;
}

static void value_of_quadric(const coefficients *c, const spot *at, const double d[3], value *v) {
  const qn_dd *k = c->k, *x = at->x;
  const double *m = c->m, *X = at->X;
  /* p = (A x + D y + E z + G) x + (B y + F z + H) y + (C z + I) z + J; g: the gradient */
  qn_dd inner[3];
  double M[3], g[3], size[3], curve[3], D[3] = {fabs(d[0]), fabs(d[1]), fabs(d[2])};
  for (int i = 0; i < 3; i++) {
    inner[i] = qn_dd_add(qn_dd_mul(k[i], x[i]), k[6 + i]);
    M[i] = m[i] * X[i] + m[6 + i];
    g[i] = 2 * k[i].hi * x[i].hi + k[6 + i].hi;
    size[i] = 2 * m[i] * X[i] + m[6 + i];
    curve[i] = m[i] * D[i];
  }
  if (c->mixed) {
    inner[0] = qn_dd_add(inner[0], qn_dd_add(qn_dd_mul(k[3], x[1]), qn_dd_mul(k[4], x[2])));
    inner[1] = qn_dd_add(inner[1], qn_dd_mul(k[5], x[2]));
    M[0] += m[3] * X[1] + m[4] * X[2];
    M[1] += m[5] * X[2];
    g[0] += k[3].hi * x[1].hi + k[4].hi * x[2].hi;
    g[1] += k[3].hi * x[0].hi + k[5].hi * x[2].hi;
    g[2] += k[4].hi * x[0].hi + k[5].hi * x[1].hi;
    size[0] += m[3] * X[1] + m[4] * X[2];
    size[1] += m[3] * X[0] + m[5] * X[2];
    size[2] += m[4] * X[0] + m[5] * X[1];
    curve[0] += m[3] * D[1] + m[4] * D[2];
    curve[1] += m[5] * D[2];
  }
  qn_dd p = qn_dd_add(qn_dd_add(qn_dd_mul(inner[0], x[0]), qn_dd_mul(inner[1], x[1])), qn_dd_add(qn_dd_mul(inner[2], x[2]), k[9]));
  v->p = p.hi;
  v->size = M[0] * X[0] + M[1] * X[1] + M[2] * X[2] + m[9];
  v->slope = g[0] * d[0] + g[1] * d[1] + g[2] * d[2];
  v->slope_size = size[0] * D[0] + size[1] * D[1] + size[2] * D[2];
  v->curve = curve[0] * D[0] + curve[1] * D[1] + curve[2] * D[2];
}

typedef struct newton { double step, error; } newton;

/* One step from t, |r - t| <= e. */
static newton step_from(const coefficients *c, const double o[3], const double d[3], double t, double e) {
  spot at;
  for (int j = 0; j < 3; j++) {
    at.x[j] = qn_dd_add(qn_dd_from(o[j]), qn_dd_two_prod(t, d[j]));
    at.X[j] = fabs(o[j]) + fabs(t * d[j]);
  }
  value v;
  if (c->plane) {
    value_of_plane(c, &at, d, &v);
  } else {
    value_of_quadric(c, &at, d, &v);
  }
  newton n;
  n.step = -v.p / v.slope;
  n.error = QN_SLACK * ((QN_SLOPE_E * v.slope_size * e + v.curve * e * e + QN_DD_EVAL * v.size + QN_DD_TINY) / fabs(v.slope) + 4 * QN_U * fabs(n.step));
  return n;
}

/* 1 when *out is certainly the double nearest to the root. */
static int round_in_doubles(const qn_exact_surface *form, const qn_line *line, double t, double e, double *out) {
  if (line->rounded || !(e <= QN_DD_LARGEST)) {
    return 0;
  }
  for (int j = 0; j < 3; j++) {
    if (!usable(line->o[j]) || !usable(line->d[j])) {
      return 0;
    }
  }
  coefficients c;
  take(form, &c);
  for (int tries = 0; tries < 3; tries++) {
    if (!usable(t)) {
      return 0;
    }
    newton n = step_from(&c, line->o, line->d, t, e);
    qn_dd sum = qn_dd_two_sum(t, n.step);
    double error = QN_SLACK * (n.error + 4 * QN_U * fabs(sum.lo));
    if (sum.hi != 0 && sum.hi + (sum.lo + error) == sum.hi && sum.hi + (sum.lo - error) == sum.hi) {
      *out = sum.hi;
      return 1;
    }
    double next = n.error + fabs(sum.lo);
    if (!(next < e / 4)) {
      return 0;
    }
    t = sum.hi;
    e = QN_SLACK * next;
  }
  return 0;
}

double qn_place_round(const quoin_scene *scene, qn_scratch *s, qn_line *line, const qn_place *place) {
  if (place->surface == QN_NO_SURFACE) {
    if (place->turn) {
      return qn_root_to_double(&s->ctx, (qn_root){place->turn, place->which});
    }
    if (qn_int_sign(place->den) > 0) {
      return qn_rat_to_double(&s->ctx, place->num, place->den);
    }
    return place->t == 0 ? 0 : place->t; /* no negative zero */
  }
  int made = 0;
  const qn_exact_surface *form = qn_scene_exact(scene, place->surface, &made);
  s->counts.exact_forms += (uint64_t)made;
  if (!form) {
    s->ctx.failed = qn_scene_no_exact(scene, place->surface); /* where who asks for a rounding looks: it may not be part of a weave */
    return place->t;
  }
  double nearest = 0;
  if (round_in_doubles(form, line, place->t, place->e, &nearest)) {
    return nearest;
  }
  s->counts.exact_roundings++;
  qn_mark mark = qn_arena_mark(&s->ctx.arena);
  qn_quad quad;
  if (s->line == line && s->memo[place->surface].stamp == s->stamp && s->solved[s->memo[place->surface].solved].quad) {
    quad = *s->solved[s->memo[place->surface].solved].quad;
  } else {
    qn_line_make_exact(&s->ctx, line);
    mark = qn_arena_mark(&s->ctx.arena); /* the line's integers stay */
    qn_line_quad(&s->ctx, line, form, &quad);
  }
  nearest = qn_root_to_double(&s->ctx, (qn_root){&quad, place->which});
  qn_arena_release(&s->ctx.arena, mark);
  return nearest;
}
