/* Double-double: the error bounds of dd.h, judged in rationals. u = 2^-53; each bound is multiplied out, never rounded. */
#include "judge.h"

#include "number/dd.h"

enum { ROUNDS = 20000 };

static void dd_to_mpq(mpq_t q, qn_dd a) {
  mpq_t lo;
  mpq_init(lo);
  mpq_set_d(q, a.hi);
  mpq_set_d(lo, a.lo);
  mpq_add(q, q, lo);
  mpq_clear(lo);
}

/* |q - r| (1 - 4u) <= k u^2 |q|: the bounds of Joldes et al. are k u^2 / (1 - 4u) at most. */
static int within(const mpq_t q, qn_dd r, unsigned k) {
  mpq_t x, e, f;
  mpq_inits(x, e, f, NULL);
  dd_to_mpq(x, r);
  mpq_sub(e, x, q);
  mpq_abs(e, e);
  mpq_div_2exp(f, e, 51);
  mpq_sub(e, e, f);
  mpq_mul_2exp(e, e, 106);
  mpq_set_ui(f, k, 1);
  mpq_abs(x, q);
  mpq_mul(f, f, x);
  int good = mpq_cmp(e, f) <= 0 && (r.hi == r.hi + r.lo); /* and hi is the nearest double to the sum */
  mpq_clears(x, e, f, NULL);
  return good;
}

static double random_double(uint64_t *seed, int spread) {
  double m = 1 + (double)(random_bits(seed) >> 12) * 0x1p-52;
  if (random_below(seed, 4) == 0) { /* ends of the binade */
    m = random_below(seed, 2) ? 1 : 0x1.fffffffffffffp0;
  }
  m = ldexp(m, (int)random_below(seed, 2 * (size_t)spread + 1) - spread);
  return random_below(seed, 2) ? -m : m;
}

static qn_dd random_dd(uint64_t *seed, int spread) {
  double hi = random_double(seed, spread), lo = 0;
  if (random_below(seed, 5)) {
    lo = ldexp(random_double(seed, 0), ilogb(hi) - 54 - (random_below(seed, 2) ? 0 : (int)random_below(seed, 50)));
  }
  return qn_dd_two_sum(hi, lo);
}

static void test_exact_parts(void **unused) {
  (void)unused;
  uint64_t seed = 41;
  mpq_t a, b, r;
  mpq_inits(a, b, r, NULL);
  for (int i = 0; i < ROUNDS; i++) {
    double x = random_double(&seed, 60), y = random_double(&seed, 60);
    mpq_set_d(a, x);
    mpq_set_d(b, y);
    mpq_t sum;
    mpq_init(sum);
    mpq_add(sum, a, b);
    dd_to_mpq(r, qn_dd_two_sum(x, y));
    assert_true(mpq_equal(sum, r) && qn_dd_two_sum(x, y).hi == x + y);
    qn_dd q = fabs(x) >= fabs(y) ? qn_dd_quick_sum(x, y) : qn_dd_quick_sum(y, x);
    dd_to_mpq(r, q);
    assert_true(mpq_equal(sum, r));
    mpq_mul(sum, a, b);
    dd_to_mpq(r, qn_dd_two_prod(x, y));
    assert_true(mpq_equal(sum, r) && qn_dd_two_prod(x, y).hi == x * y);
    mpq_clear(sum);
  }
  mpq_clears(a, b, r, NULL);
}

static void test_bounds(void **unused) {
  (void)unused;
  uint64_t seed = 42;
  mpq_t a, b, r, s;
  mpq_inits(a, b, r, s, NULL);
  size_t cancelled = 0;
  for (int i = 0; i < ROUNDS; i++) {
    int spread = i % 2 ? 2 : 60;
    qn_dd x = random_dd(&seed, spread), y = random_dd(&seed, spread);
    if (i % 5 == 0) { /* nearly opposite */
      y = qn_dd_add(qn_dd_neg(x), qn_dd_mul_d(x, random_double(&seed, 0) * ldexp(1, -(int)random_below(&seed, 107))));
    }
    dd_to_mpq(a, x);
    dd_to_mpq(b, y);
    mpq_add(r, a, b);
    assert_true(within(r, qn_dd_add(x, y), 3));
    cancelled += fabs(x.hi + y.hi) < 0x1p-40 * fabs(x.hi);
    mpq_sub(r, a, b);
    assert_true(within(r, qn_dd_sub(x, y), 3));
    mpq_mul(r, a, b);
    assert_true(within(r, qn_dd_mul(x, y), 5));
    mpq_set_d(s, y.hi);
    mpq_mul(r, a, s);
    assert_true(within(r, qn_dd_mul_d(x, y.hi), 5));
    if (y.hi != 0) {
      mpq_div(r, a, b);
      assert_true(within(r, qn_dd_div(x, y), 10));
    }
    if (x.hi > 0) { /* (1 - 4u^2)^2 a <= root^2 <= (1 + 4u^2)^2 a */
      dd_to_mpq(r, qn_dd_sqrt(x));
      mpq_mul(r, r, r);
      mpq_set_ui(s, 4, 1);
      mpq_div_2exp(s, s, 106);
      mpq_t one;
      mpq_init(one);
      mpq_set_ui(one, 1, 1);
      mpq_add(b, one, s);
      mpq_sub(s, one, s);
      mpq_mul(b, b, b);
      mpq_mul(s, s, s);
      mpq_mul(b, b, a);
      mpq_mul(s, s, a);
      assert_true(mpq_cmp(s, r) <= 0 && mpq_cmp(r, b) <= 0);
      mpq_clear(one);
    }
  }
  assert_true(cancelled > 500);
  assert_true(qn_dd_sqrt(qn_dd_from(0)).hi == 0);
  mpq_clears(a, b, r, s, NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_exact_parts), cmocka_unit_test(test_bounds)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
