/* The ways of textbooks and papers, in the order of their care. */
#include "solvers.h"

#include <math.h>

static solved_roots none(void) { return (solved_roots){0, {0, 0}, {0, 0}}; }
static solved_roots one(double t) { return (solved_roots){1, {t, t}, {0, 0}}; }
static solved_roots two(double t, double u) { return t < u ? (solved_roots){2, {t, u}, {0, 0}} : (solved_roots){2, {u, t}, {0, 0}}; }

/* The formula as it is taught. */
static solved_roots taught(double a, double b, double c) {
  if (a == 0) {
    return b == 0 ? none() : one(-c / b);
  }
  double disc = b * b - 4 * a * c;
  if (disc < 0) {
    return none();
  }
  if (disc == 0) {
    return one(-b / (2 * a));
  }
  double root = sqrt(disc);
  return two((-b - root) / (2 * a), (-b + root) / (2 * a));
}

/* a t^2 + 2 h t + c without cancellation between -h and the root. */
static solved_roots careful(double a, double h, double c) {
  if (a == 0) {
    return h == 0 ? none() : one(-c / (2 * h));
  }
  double disc = h * h - a * c;
  if (disc < 0) {
    return none();
  }
  if (disc == 0) {
    return one(-h / a);
  }
  double q = -(h + copysign(sqrt(disc), h));
  return two(q / a, c / q);
}

/* The quadric expanded to ten coefficients in the world's frame. */
solved_roots solve_world(const prepared *solid, const double o[3], const double d[3]) {
  const double *w = solid->world;
  double a = w[0] * d[0] * d[0] + w[1] * d[1] * d[1] + w[2] * d[2] * d[2] + w[3] * d[0] * d[1] + w[4] * d[0] * d[2] + w[5] * d[1] * d[2];
  double b = 2 * (w[0] * o[0] * d[0] + w[1] * o[1] * d[1] + w[2] * o[2] * d[2]) + w[3] * (o[0] * d[1] + o[1] * d[0]) +
             w[4] * (o[0] * d[2] + o[2] * d[0]) + w[5] * (o[1] * d[2] + o[2] * d[1]) + w[6] * d[0] + w[7] * d[1] + w[8] * d[2];
  double c = w[0] * o[0] * o[0] + w[1] * o[1] * o[1] + w[2] * o[2] * o[2] + w[3] * o[0] * o[1] + w[4] * o[0] * o[2] + w[5] * o[1] * o[2] +
             w[6] * o[0] + w[7] * o[1] + w[8] * o[2] + w[9];
  return taught(a, b, c);
}

typedef struct local_line { double O[3], D[3]; } local_line;

static void coefficients(const prepared *s, const local_line *v, double *a, double *h, double *c) {
  *a = s->s[0] * v->D[0] * v->D[0] + s->s[1] * v->D[1] * v->D[1] + s->s[2] * v->D[2] * v->D[2];
  *h = s->s[0] * v->O[0] * v->D[0] + s->s[1] * v->O[1] * v->D[1] + s->s[2] * v->O[2] * v->D[2] + s->l * v->D[2];
  *c = s->s[0] * v->O[0] * v->O[0] + s->s[1] * v->O[1] * v->O[1] + s->s[2] * v->O[2] * v->O[2] + 2 * s->l * v->O[2] + s->k;
}

static void map(const prepared *s, const double x[3], double out[3]) {
  for (int i = 0; i < 3; i++) {
    out[i] = s->A[i][0] * x[0] + s->A[i][1] * x[1] + s->A[i][2] * x[2];
  }
}

/* The line brought into the quadric's frame by the inverse matrix, then the formula. */
solved_roots solve_textbook(const prepared *s, const double o[3], const double d[3]) {
  local_line v;
  double a, h, c;
  map(s, o, v.O);
  map(s, d, v.D);
  for (int i = 0; i < 3; i++) {
    v.O[i] += s->b[i];
  }
  coefficients(s, &v, &a, &h, &c);
  return taught(a, 2 * h, c);
}

/* The same with the place subtracted first, and the careful formula. */
solved_roots solve_stable(const prepared *s, const double o[3], const double d[3]) {
  local_line v;
  double a, h, c, y[3] = {o[0] - s->p[0], o[1] - s->p[1], o[2] - s->p[2]};
  map(s, y, v.O);
  map(s, d, v.D);
  coefficients(s, &v, &a, &h, &c);
  return careful(a, h, c);
}

/* The same from a new origin on the line, the one nearest to the quadric's own in its frame (Haines and others, 2019). */
solved_roots solve_shifted(const prepared *s, const double o[3], const double d[3]) {
  local_line v;
  double a, h, c, y[3] = {o[0] - s->p[0], o[1] - s->p[1], o[2] - s->p[2]};
  map(s, y, v.O);
  map(s, d, v.D);
  double shift = -(v.O[0] * v.D[0] + v.O[1] * v.D[1] + v.O[2] * v.D[2]) / (v.D[0] * v.D[0] + v.D[1] * v.D[1] + v.D[2] * v.D[2]);
  for (int i = 0; i < 3; i++) {
    y[i] += shift * d[i];
  }
  map(s, y, v.O);
  coefficients(s, &v, &a, &h, &c);
  solved_roots r = careful(a, h, c);
  r.t[0] += shift;
  r.t[1] += shift;
  return r;
}

static qn_dd sum3(qn_dd a, qn_dd b, qn_dd c) { return qn_dd_add(qn_dd_add(a, b), c); }

/* Everything in double-doubles, some 106 bits. */
solved_roots solve_dd(const prepared *s, const double o[3], const double d[3]) {
  qn_dd O[3], D[3], y[3], a[3], h[3], c[3];
  for (int i = 0; i < 3; i++) {
    y[i] = qn_dd_two_sum(o[i], -s->p[i]);
  }
  for (int i = 0; i < 3; i++) {
    O[i] = sum3(qn_dd_mul(s->Ad[i][0], y[0]), qn_dd_mul(s->Ad[i][1], y[1]), qn_dd_mul(s->Ad[i][2], y[2]));
    D[i] = sum3(qn_dd_mul_d(s->Ad[i][0], d[0]), qn_dd_mul_d(s->Ad[i][1], d[1]), qn_dd_mul_d(s->Ad[i][2], d[2]));
    qn_dd sD = qn_dd_mul_d(D[i], s->s[i]);
    a[i] = qn_dd_mul(sD, D[i]);
    h[i] = qn_dd_mul(sD, O[i]);
    c[i] = qn_dd_mul(qn_dd_mul_d(O[i], s->s[i]), O[i]);
  }
  qn_dd A = sum3(a[0], a[1], a[2]);
  qn_dd H = qn_dd_add(sum3(h[0], h[1], h[2]), qn_dd_mul_d(D[2], s->l));
  qn_dd C = qn_dd_add(qn_dd_add(sum3(c[0], c[1], c[2]), qn_dd_mul_d(O[2], 2 * s->l)), qn_dd_from(s->k));
  if (A.hi == 0) {
    if (H.hi == 0) {
      return none();
    }
    qn_dd t = qn_dd_div(qn_dd_neg(C), qn_dd_mul_d(H, 2));
    return (solved_roots){1, {t.hi, t.hi}, {t.lo, t.lo}};
  }
  qn_dd disc = qn_dd_sub(qn_dd_mul(H, H), qn_dd_mul(A, C));
  if (disc.hi < 0) {
    return none();
  }
  if (disc.hi == 0) {
    qn_dd t = qn_dd_div(qn_dd_neg(H), A);
    return (solved_roots){1, {t.hi, t.hi}, {t.lo, t.lo}};
  }
  qn_dd root = qn_dd_sqrt(disc);
  qn_dd q = qn_dd_neg(H.hi < 0 ? qn_dd_sub(H, root) : qn_dd_add(H, root));
  qn_dd t = qn_dd_div(q, A), u = qn_dd_div(C, q);
  int first = t.hi < u.hi || (t.hi == u.hi && t.lo < u.lo);
  return first ? (solved_roots){2, {t.hi, u.hi}, {t.lo, u.lo}} : (solved_roots){2, {u.hi, t.hi}, {u.lo, t.lo}};
}
