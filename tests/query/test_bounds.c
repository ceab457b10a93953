/* QN_POINT_MAP_E and QN_POINT_FORM_E in rationals: the computed value lies within its bound of the true one, with numbers from the
   whole range, near cancellation, and stored with the error that a shadow may have. */
#include "ask.h"
#include "share.h"

#include "base/bounds.h"
#include "query/shadow.h"

#include <gmp.h>
#include <math.h>

static uint64_t seed = 0x9e3779b97f4a7c15u;
static uint64_t bits(void) {
  seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17;
  return seed;
}

static double random_double(int range) {
  double v = ldexp((double)(bits() >> 11) + 1, -53 - (int)(bits() % (uint64_t)range));
  switch (bits() % 8) {
    case 0: v = 0; break;
    case 1: v = ldexp((double)(bits() % 16), -2); break;
    case 2: v = 1 - ldexp(1, -(int)(bits() % 53)); break;
    default: break;
  }
  return bits() & 1 ? v : -v;
}

/* A true number that v may be the shadow of: within almost QN_SHADOW of it. */
static void true_number(mpq_t out, double v) {
  mpq_t f;
  mpq_init(f);
  mpq_set_d(out, v);
  mpq_set_si(f, (long)(bits() % 2001) - 1000, 1000);
  mpq_div_2exp(f, f, 53); /* |f| <= u: v = true (1 + d), |d| <= u (1 + 2^-40) */
  mpz_add(mpq_numref(f), mpq_numref(f), mpq_denref(f));
  mpq_canonicalize(f);
  mpq_mul(out, out, f);
  mpq_clear(f);
}

/* x true, from the double and its weight. */
static void true_point(mpq_t out, double x, double weight) {
  mpq_t e, w;
  mpq_inits(e, w, NULL);
  mpq_set_d(out, x);
  mpq_set_si(e, (long)(bits() % 2001) - 1000, 1000);
  mpq_set_d(w, weight);
  mpq_mul(e, e, w);
  mpq_div_2exp(e, e, 53);
  mpq_add(out, out, e);
  mpq_clears(e, w, NULL);
}

static void row_value(mpq_t out, const double row[4], mpq_t y[3]) {
  mpq_t a;
  mpq_init(a);
  true_number(out, row[3]);
  for (int j = 0; j < 3; j++) {
    true_number(a, row[j]);
    mpq_mul(a, a, y[j]);
    mpq_add(out, out, a);
  }
  mpq_clear(a);
}

static double share(mpq_t truth, double value, double bound) {
  mpq_t v;
  mpq_init(v);
  mpq_set_d(v, value);
  mpq_sub(v, v, truth);
  double error = fabs(mpq_get_d(v));
  if (error == 0) {
    mpq_clear(v);
    return 0;
  }
  mpq_t b;
  mpq_init(b);
  mpq_set_d(b, bound);
  mpq_abs(v, v);
  assert_true(mpq_cmp(v, b) <= 0);
  mpq_clears(v, b, NULL);
  return error / bound;
}

static void points(void **state) {
  (void)state;
  double plane_most = 0, quadric_most = 0;
  size_t cancelled = 0, rounded = 0;
  mpq_t y[3], q, x, s;
  mpq_inits(y[0], y[1], y[2], q, x, s, NULL);
  for (int round = 0; round < share_of(60000); round++) {
    int range = round % 3 == 0 ? 3 : round % 3 == 1 ? 30 : 300;
    double p[3], weight[3], pivot[3];
    for (int i = 0; i < 3; i++) {
      p[i] = random_double(range);
      pivot[i] = bits() & 1 ? random_double(range) : p[i] + random_double(60);
      weight[i] = bits() & 1 ? 0 : fabs(p[i]);
      rounded += weight[i] != 0;
      true_point(y[i], p[i], weight[i]);
      mpq_set_d(x, pivot[i]);
      mpq_sub(y[i], y[i], x);
    }
    qn_frame f = qn_frame_of(p, weight, pivot);
    double bound = 0;

    qn_plane_shadow plane = {{random_double(range), random_double(range), random_double(range)}, 0};
    plane.d = bits() & 1 ? random_double(range) : -(plane.n[0] * f.y[0] + plane.n[1] * f.y[1] + plane.n[2] * f.y[2]);
    const double row[4] = {plane.n[0], plane.n[1], plane.n[2], plane.d};
    row_value(q, row, y);
    double value = qn_plane_value(&plane, &f, &bound);
    cancelled += fabs(value) < bound;
    double part = share(q, value, bound);
    plane_most = part > plane_most ? part : plane_most;

    qn_quadric_shadow quadric = {.l = bits() & 1 ? random_double(range) : 0, .k = random_double(range)};
    double sum = 0;
    mpq_set_ui(q, 0, 1);
    for (int i = 0; i < 3; i++) {
      quadric.s[i] = random_double(range);
      for (int j = 0; j < 4; j++) {
        quadric.row[i][j] = random_double(range);
      }
      double X = quadric.row[i][0] * f.y[0] + quadric.row[i][1] * f.y[1] + quadric.row[i][2] * f.y[2] + quadric.row[i][3];
      sum += quadric.s[i] * X * X + (i == 2 ? 2 * quadric.l * X : 0);
      row_value(x, quadric.row[i], y);
      if (i == 2) {
        true_number(s, quadric.l);
        mpq_mul(s, s, x);
        mpq_mul_2exp(s, s, 1);
        mpq_add(q, q, s);
      }
      mpq_mul(x, x, x);
      true_number(s, quadric.s[i]);
      mpq_mul(x, x, s);
      mpq_add(q, q, x);
    }
    if (bits() & 1) {
      quadric.k = -sum; /* on the surface, all but rounding */
    }
    true_number(s, quadric.k);
    mpq_add(q, q, s);
    value = qn_quadric_value(&quadric, &f, &bound);
    cancelled += fabs(value) < bound;
    part = share(q, value, bound);
    quadric_most = part > quadric_most ? part : quadric_most;
  }
  mpq_clears(y[0], y[1], y[2], q, x, s, NULL);
  print_message("largest |error|/bound: plane %.3f, quadric %.3f; cancelled %zu\n", plane_most, quadric_most, cancelled);
  assert_true(cancelled > share_min(20000) && rounded > share_min(50000));
  assert_true(!share_whole() || (plane_most > 0.2 && quadric_most > 0.1)); /* the cases are hard: a bound a few times smaller would fail */
}

static void zeros_and_ranges(void **state) {
  (void)state;
  double bound = 1;
  const double at[3] = {0, 3, -2}, exact[3] = {0, 0, 0}, pivot[3] = {0, 1, 1};
  qn_frame f = qn_frame_of(at, exact, pivot);
  const qn_plane_shadow x0 = {{1, 0, 0}, 0}, huge = {{0x1p+300, 0, 0}, 1e300};
  assert_true(qn_plane_value(&x0, &f, &bound) == 0 && bound == 0); /* certainly on it */
  const double near[3] = {0, 3, 1};
  f = qn_frame_of(at, near, pivot);
  (void)qn_plane_value(&huge, &f, &bound);
  assert_true(bound == HUGE_VAL);
  const double rounded[3] = {0x1p-1022, 0, 0};
  f = qn_frame_of(at, rounded, pivot);
  (void)qn_plane_value(&x0, &f, &bound);
  assert_true(bound > 0); /* it may be off by less than the least double */
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(points), cmocka_unit_test(zeros_and_ranges)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
