/* Families of cases, easy and hard. Each is drawn for six kinds: sphere, ellipsoid, cylinder, cone, paraboloid, hyperboloid of one sheet. */
#include "grid.h"
#include "solvers.h"

#include <math.h>
#include <string.h>

enum { SPHERE, ELLIPSOID, CYLINDER, CONE, PARABOLOID, HYPERBOLOID };

static void canonical(int kind, placed *out) {
  static const double S[KINDS][5] = { /* s0 s1 s2 l k */
    {1, 1, 1, 0, -1}, {1, 1, 1, 0, -1}, {1, 1, 0, 0, -1}, {1, 1, -1, 0, 0}, {1, 1, 0, -0.5, 0}, {1, 1, -1, 0, -1}};
  memcpy(out->s, S[kind], sizeof out->s);
  out->l = S[kind][3];
  out->k = S[kind][4];
}

static double between(uint64_t *g, double a, double b) { return bench_between(g, a, b); }
static int whole(uint64_t *g, int a, int b) { return a + (int)(bench_u64(g) % (uint64_t)(b - a + 1)); }

static void direction(uint64_t *g, double out[3]) {
  double z = between(g, -1, 1), p = between(g, 0, 6.283185307179586), q = sqrt(1 - z * z);
  out[0] = q * cos(p), out[1] = q * sin(p), out[2] = z;
}
static void cross(const double a[3], const double b[3], double out[3]) {
  for (int i = 0; i < 3; i++) {
    out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
  }
}

/* A rotation with doubles that are not special, its columns scaled. */
static void frame(uint64_t *g, const double scale[3], double M[3][3]) {
  double x[3], y[3], z[3], r = 0;
  direction(g, z);
  do {
    double w[3];
    direction(g, w);
    cross(z, w, x);
    r = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
  } while (r < 0.1);
  for (int i = 0; i < 3; i++) {
    x[i] /= r;
  }
  cross(z, x, y);
  for (int i = 0; i < 3; i++) {
    M[i][0] = x[i] * scale[0], M[i][1] = y[i] * scale[1], M[i][2] = z[i] * scale[2];
  }
}

static void surface_point(uint64_t *g, int kind, double X[3]) {
  double z = between(g, -1, 1), p = between(g, 0, 6.283185307179586), r = 1;
  switch (kind) {
  case SPHERE: case ELLIPSOID: r = sqrt(1 - z * z); break;
  case CONE:
    z = between(g, 0.3, 1);
    r = z;
    break;
  case PARABOLOID:
    r = between(g, 0.2, 1);
    z = r * r;
    break;
  case HYPERBOLOID: r = sqrt(1 + z * z); break;
  default: break;
  }
  X[0] = r * cos(p), X[1] = r * sin(p), X[2] = z;
}

static void to_world(const placed *s, const double X[3], int point, double out[3]) {
  for (int i = 0; i < 3; i++) {
    out[i] = s->M[i][0] * X[0] + s->M[i][1] * X[1] + s->M[i][2] * X[2] + (point ? s->p[i] : 0);
  }
}

/* The partner: the same solid moved along the line by 2^-20 to 2^-50 of the distance. */
static void add_partner(uint64_t *g, double distance, solver_case *c) {
  double step = ldexp(whole(g, 0, 1) ? distance : -distance, -whole(g, 20, 50)), length = 0;
  c->partner = c->solid;
  for (int i = 0; i < 3; i++) {
    length += c->d[i] * c->d[i];
  }
  for (int i = 0; i < 3; i++) {
    c->partner.p[i] += step * (c->d[i] / sqrt(length));
  }
}

/* A line at a place inside, from `distance` away. */
static int aimed(uint64_t *g, int kind, double place, double distance, double thin, solver_case *c) {
  double X[3], target[3], inward = between(g, 0.2, 0.8);
  double scale[3] = {between(g, 0.5, 2), 0, 0};
  scale[1] = scale[2] = scale[0];
  if (kind == ELLIPSOID) {
    scale[1] = between(g, 0.5, 2), scale[2] = between(g, 0.5, 2);
  }
  scale[2] *= thin;
  canonical(kind, &c->solid);
  frame(g, scale, c->solid.M);
  for (int i = 0; i < 3; i++) {
    c->solid.p[i] = place * between(g, -1, 1);
  }
  surface_point(g, kind, X);
  X[0] *= inward, X[1] *= inward;
  to_world(&c->solid, X, 1, target);
  direction(g, c->d);
  for (int i = 0; i < 3; i++) {
    c->o[i] = target[i] - distance * c->d[i];
  }
  add_partner(g, distance, c);
  return 1;
}

static int easy(uint64_t *g, int kind, solver_case *c) { return aimed(g, kind, 10, 10, 1, c); }
static int far_origin(uint64_t *g, int kind, solver_case *c) { return aimed(g, kind, 10, 1e9, 1, c); }
static int translated5(uint64_t *g, int kind, solver_case *c) { return aimed(g, kind, 1e5, 10, 1, c); }
static int translated9(uint64_t *g, int kind, solver_case *c) { return aimed(g, kind, 1e9, 10, 1, c); }
static int thin(uint64_t *g, int kind, solver_case *c) { return aimed(g, kind, 10, 10, 1e-6, c); }

static int apex(uint64_t *g, int kind, solver_case *c) {
  (void)kind;
  aimed(g, CONE, 10, 10, 1, c);
  for (int i = 0; i < 3; i++) {
    c->o[i] = c->solid.p[i] - 10 * c->d[i];
    c->d[i] = c->solid.p[i] - c->o[i];
  }
  add_partner(g, 10, c);
  return 1;
}

static int near30(uint64_t *g, int kind, solver_case *c) {
  double X[3], n[3], w[3], T[3], scale[3] = {1, 1, 1};
  canonical(kind, &c->solid);
  if (kind == ELLIPSOID) {
    scale[1] = between(g, 0.5, 2), scale[2] = between(g, 0.5, 2);
  }
  frame(g, scale, c->solid.M);
  surface_point(g, kind, X);
  for (int i = 0; i < 3; i++) {
    c->solid.p[i] = between(g, -10, 10);
    n[i] = c->solid.s[i] * X[i] + (i == 2 ? c->solid.l : 0);
  }
  direction(g, w);
  cross(n, w, T);
  double off = whole(g, 0, 1) ? 0x1p-30 : -0x1p-30, o[3];
  for (int i = 0; i < 3; i++) {
    o[i] = X[i] + off * n[i] - 5 * T[i];
  }
  to_world(&c->solid, o, 1, c->o);
  to_world(&c->solid, T, 0, c->d);
  add_partner(g, 5, c);
  return T[0] != 0 || T[1] != 0 || T[2] != 0;
}

/* A point with whole coordinates on a quadric with whole coefficients: size bounds the factor by which a small one is multiplied; with size 0 it
   lies on an axis, so that small steps off it are doubles. */
static void whole_point(uint64_t *g, int kind, int size, placed *s, long X[3]) {
  static const int TRIPLES[][4] = {{1, 2, 2, 3}, {2, 3, 6, 7}, {1, 4, 8, 9}, {2, 6, 9, 11}, {4, 4, 7, 9}};
  static const int PAIRS[][3] = {{3, 4, 5}, {5, 12, 13}, {8, 15, 17}, {7, 24, 25}};
  long m = whole(g, 1, size ? size : 1);
  canonical(kind, s);
  memset(s->M, 0, sizeof s->M);
  s->M[0][0] = s->M[1][1] = s->M[2][2] = 1;
  if (kind == ELLIPSOID) {
    s->M[1][1] = 2, s->M[2][2] = 4;
  }
  if (size == 0) {
    X[0] = 1, X[1] = 0, X[2] = kind == CONE || kind == PARABOLOID;
  } else if (kind == SPHERE || kind == ELLIPSOID) {
    const int *t = TRIPLES[whole(g, 0, 4)];
    for (int i = 0; i < 3; i++) {
      X[i] = m * t[i];
    }
    s->k = -(double)(m * m * t[3] * t[3]);
  } else if (kind == CYLINDER || kind == CONE) {
    const int *t = PAIRS[whole(g, 0, 3)];
    X[0] = m * t[0], X[1] = m * t[1], X[2] = kind == CONE ? m * t[2] : whole(g, -size, size);
    s->k = kind == CONE ? 0 : -(double)(m * m * t[2] * t[2]);
  } else if (kind == PARABOLOID) {
    X[0] = whole(g, 1, 60), X[1] = whole(g, 1, 60), X[2] = X[0] * X[0] + X[1] * X[1];
  } else {
    X[0] = 1, X[1] = X[2] = whole(g, 1, 3 * size);
  }
}

static long divisor(long a, long b) {
  while (b) {
    long r = a % b;
    a = b;
    b = r;
  }
  return a < 0 ? -a : a;
}

/* A tangent at a whole point, moved off by `off` times the gradient; 0 when it cannot be in doubles. reduced: its direction is given in the smallest
   whole numbers; far: how many times its direction it starts before the point, at most. */
static int tangent(uint64_t *g, int kind, int size, int place, int reduced, int far, double off, solver_case *c) {
  long X[3], n[3], w[3], T[3];
  whole_point(g, kind, size, &c->solid, X);
  for (int i = 0; i < 3; i++) {
    n[i] = (long)(2 * c->solid.s[i]) * X[i] + (i == 2 ? (long)(2 * c->solid.l) : 0);
    w[i] = whole(g, -2, 2);
    c->solid.p[i] = whole(g, -place, place);
  }
  for (int i = 0; i < 3; i++) {
    T[i] = n[(i + 1) % 3] * w[(i + 2) % 3] - n[(i + 2) % 3] * w[(i + 1) % 3];
  }
  long common = divisor(divisor(T[0], T[1]), T[2]), back = whole(g, 1, far);
  if (common == 0) {
    return 0;
  }
  common = reduced ? common : 1;
  int exact = 1;
  for (int i = 0; i < 3; i++) {
    T[i] /= common;
    double base = (double)(X[i] - back * T[i]), moved = base + off * (double)n[i];
    exact &= moved - base == off * (double)n[i];
    c->o[i] = c->solid.M[i][i] * moved + c->solid.p[i]; /* powers of two and whole numbers */
    exact &= off == 0 || c->solid.p[i] == 0;
    c->d[i] = c->solid.M[i][i] * (double)T[i];
  }
  add_partner(g, (double)back, c);
  return exact;
}

static int near50(uint64_t *g, int kind, solver_case *c) {
  return tangent(g, kind, 0, 0, 1, 1000, whole(g, 0, 1) ? 0x1p-50 : -0x1p-50, c);
}
static int tangent_small(uint64_t *g, int kind, solver_case *c) { return tangent(g, kind, 3, 100, 1, 1000, 0, c); }
static int tangent_large(uint64_t *g, int kind, solver_case *c) { return tangent(g, kind, 1600, 16383, 0, 16383, 0, c); }

const family FAMILIES[] = {
  {"easy random", easy},
  {"near-tangent 2^-30", near30},
  {"near-tangent 2^-50", near50},
  {"tangent, small integers", tangent_small},
  {"tangent, 14-bit integers", tangent_large},
  {"origin 1e9 radii away", far_origin},
  {"translated by 1e5", translated5},
  {"translated by 1e9", translated9},
  {"thin, aspect 1e-6", thin},
  {"cone apex", apex},
};
const size_t FAMILY_COUNT = sizeof FAMILIES / sizeof *FAMILIES;
