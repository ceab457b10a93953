/* Superquadric: (|x/a|^(2/e) + |y/b|^(2/e))^(e/n) + |z/c|^(2/n) <= 1 (Barr 1981).

   With X = x/a, Y = y/b, Z = z/c and p-norms, p = 2/e, q = 2/n:  rho = |(X, Y)|_p and the solid is |(rho, Z)|_q <= 1. An exponent 0
   means the greatest, 1 the Euclidean length, 2 the sum. So for e, n in {0, 1, 2} the solid is an exact meet:
       n = 0: rho <= 1 and |Z| <= 1           n = 1: rho^2 + Z^2 <= 1             n = 2: rho + |Z| <= 1
       e = 0: rho = max(|X|, |Y|)             e = 1: rho^2 = X^2 + Y^2            e = 2: rho = |X| + |Y| = max(|X + Y|, |X - Y|)
   e, n:  0,0 box          1,0 cylinder and two planes            2,0 four planes and two
          0,1 X^2 + Z^2 <= 1, Y^2 + Z^2 <= 1      1,1 ellipsoid      2,1 (X + Y)^2 + Z^2 <= 1, (X - Y)^2 + Z^2 <= 1
          0,2 eight planes +-X +- Z, +-Y +- Z     2,2 eight planes +-X +- Y +- Z
          1,2 X^2 + Y^2 <= (1 - Z)^2 and (1 + Z)^2, and |Z| <= 1, which cuts the second nappes off.
   Other exponents: one body that is not algebraic (S10).

   Support: for e, n <= 2 the norms are convex and the support is the dual norm, |(|(a v_x, b v_y)|_p', c v_z)|_q' with 1/p + 1/p'
   = 1, which is
   the norm for e' = 2 - e, n' = 2 - n. Larger exponents have the hull of exponent 2 (the points on the axes). */
#include "shape/exact.h"
#include "shape/outward.h"
#include "shape/rows.h"
#include "shape/super.h"

/* 0, 1, 2 when the number is that, else -1. */
static int simple_exponent(qn_num e) {
  int64_t v;
  return qn_num_is_integer(e, &v) && v >= 0 && v <= 2 ? (int)v : -1;
}

/* A maker of half-spaces in X, Y, Z: role body throughout, for the surface is one. */
typedef struct maker {
  qn_ctx *ctx;
  qn_num a[3]; /* semi-axes */
  qn_half_form *out;
  size_t count;
} maker;

/* sx X + sy Y + sz Z <= 1, the signs -1, 0, 1; times the semi-axes of what is in it. */
static void plane(maker *m, int sx, int sy, int sz) {
  int sign[3] = {sx, sy, sz};
  qn_num c[4];
  for (int i = 0; i < 4; i++) {
    c[i] = qn_num_from_int(m->ctx, i < 3 ? sign[i] : 1);
    for (int k = 0; k < 3; k++) {
      c[i] = k != i && sign[k] ? mul(m->ctx, c[i], m->a[k]) : c[i];
    }
  }
  qn_half_plane(m->ctx, m->out + m->count++, QUOIN_BODY, c[0], c[1], c[2], c[3]);
}

static qn_half_form *body(maker *m) {
  qn_half_form *h = m->out + m->count++;
  h->kind = QN_QUADRIC_BODY;
  h->role = QUOIN_BODY;
  return h;
}

/* X_i^2 + X_k^2 <= 1 as a_k^2 x_i^2 + a_i^2 x_k^2 - a_i^2 a_k^2 */
static void cylinder(maker *m, int i, int k) {
  qn_half_form *h = body(m);
  qn_num i2 = square(m->ctx, m->a[i]), k2 = square(m->ctx, m->a[k]);
  h->row[0][i] = h->row[1][k] = QN_NUM_ONE;
  h->s[0] = k2;
  h->s[1] = i2;
  h->k = neg(m->ctx, mul(m->ctx, i2, k2));
}

/* (X + sign Y)^2 + Z^2 <= 1 as c^2 (b x + sign a y)^2 + a^2 b^2 z^2 - a^2 b^2 c^2 */
static void slanted_cylinder(maker *m, int sign) {
  qn_half_form *h = body(m);
  qn_num c2 = square(m->ctx, m->a[2]), ab2 = square(m->ctx, mul(m->ctx, m->a[0], m->a[1]));
  h->row[0][0] = m->a[1];
  h->row[0][1] = sign > 0 ? m->a[0] : neg(m->ctx, m->a[0]);
  h->row[1][2] = QN_NUM_ONE;
  h->s[0] = c2;
  h->s[1] = ab2;
  h->k = neg(m->ctx, mul(m->ctx, ab2, c2));
}

/* X^2 + Y^2 <= (1 - sign Z)^2 as c^2 b^2 x^2 + c^2 a^2 y^2 - a^2 b^2 (sign z - c)^2 */
static void cone(maker *m, int sign) {
  qn_half_form *h = body(m);
  qn_num a2 = square(m->ctx, m->a[0]), b2 = square(m->ctx, m->a[1]), c2 = square(m->ctx, m->a[2]);
  h->row[0][0] = h->row[1][1] = QN_NUM_ONE;
  h->row[2][2] = qn_num_from_int(m->ctx, sign);
  h->row[2][3] = neg(m->ctx, m->a[2]);
  h->s[0] = mul(m->ctx, b2, c2);
  h->s[1] = mul(m->ctx, a2, c2);
  h->s[2] = neg(m->ctx, mul(m->ctx, a2, b2));
}

static void slab(maker *m, int axis) {
  plane(m, axis == 0, axis == 1, axis == 2);
  plane(m, -(axis == 0), -(axis == 1), -(axis == 2));
}

static void exact_forms(maker *m, int e, int n) {
  static const int signs[4][2] = {{1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
  switch (3 * n + e) {
    case 0: /* box */
      slab(m, 0), slab(m, 1), slab(m, 2);
      break;
    case 1:
      cylinder(m, 0, 1);
      slab(m, 2);
      break;
    case 2:
      for (int i = 0; i < 4; i++) {
        plane(m, signs[i][0], signs[i][1], 0);
      }
      slab(m, 2);
      break;
    case 3:
      cylinder(m, 0, 2);
      cylinder(m, 1, 2);
      break;
    case 5:
      slanted_cylinder(m, 1);
      slanted_cylinder(m, -1);
      break;
    case 6:
      for (int i = 0; i < 4; i++) {
        plane(m, signs[i][0], 0, signs[i][1]);
        plane(m, 0, signs[i][0], signs[i][1]);
      }
      break;
    case 7:
      cone(m, 1);
      cone(m, -1);
      slab(m, 2);
      break;
    default: /* 8: octahedron; 4, the ellipsoid, is made elsewhere */
      for (int i = 0; i < 4; i++) {
        plane(m, signs[i][0], signs[i][1], 1);
        plane(m, signs[i][0], signs[i][1], -1);
      }
  }
}

qn_form_result qn_superquadric_form(qn_ctx *ctx, const qn_num *args, size_t n, const qn_placement *placement, qn_half_form **halves,
                                    size_t *count) {
  (void)n;
  *count = 0;
  if (!positive(args[0]) || !positive(args[1]) || !positive(args[2]) || qn_num_sign(args[3]) < 0 || qn_num_sign(args[4]) < 0) {
    return QN_FORM_EMPTY;
  }
  int e = simple_exponent(args[3]), ne = simple_exponent(args[4]);
  if (e == 1 && ne == 1) {
    return qn_ellipsoid_form(ctx, args, 3, placement, halves, count);
  }
  maker m = {ctx, {args[0], args[1], args[2]}, qn_halves_new(ctx, 8), 0};
  if (!m.out) {
    return QN_FORM_EMPTY;
  }
  if (e >= 0 && ne >= 0) {
    exact_forms(&m, e, ne);
  } else {
    qn_half_form *h = body(&m);
    h->kind = QN_SUPER_BODY;
    for (int i = 0; i < 3; i++) {
      h->row[i][i] = qn_num_div(ctx, QN_NUM_ONE, args[i]);
    }
    h->s[0] = args[3];
    h->s[1] = args[4];
  }
  *halves = m.out;
  *count = m.count;
  return QN_FORM_OK;
}

double qn_superquadric_support(const double *args, size_t n, const double placement[6], const double v[3]) {
  (void)n, (void)placement;
  double e = args[3] < 2 ? 2 - args[3] : 0, ne = args[4] < 2 ? 2 - args[4] : 0, g[3], error;
  qn_super s = qn_super_make(e, ne);
  double X[3] = {args[0] * v[0], args[1] * v[1], args[2] * v[2]};
  double norm = qn_super_norm(&s, X, g, &error);
  return qn_outward((qn_terms){norm, norm}, QN_SUPPORT_SLACK(32));
}

void qn_superquadric_uv(const double *args, size_t n, const double placement[6], uint32_t role, const double x[3], double uv[2]) {
  qn_ellipsoid_uv(args, n, placement, role, x, uv);
}
