/* Arithmetic that is refused at any step, because it is too much (QUOIN_E_LIMIT), leaves a failed context and nothing else: every function of numbers over long, rounded and
   usual ones, with its effort cut off everywhere. A compile is cut off so by texts that ask for more than they are long. */
#include "numbers.h"

#include <math.h>
#include <stdio.h>

typedef qn_num (*one_fn)(qn_ctx *, qn_num);
typedef qn_num (*two_fn)(qn_ctx *, qn_num, qn_num);
static const one_fn ONES[] = {qn_num_neg, qn_num_abs, qn_num_floor, qn_num_ceil, qn_num_round, qn_num_sqrt, qn_num_sin, qn_num_cos, qn_num_asin, qn_num_acos, qn_num_atan, qn_num_exp, qn_num_ln};
static const two_fn TWOS[] = {qn_num_add, qn_num_sub, qn_num_mul, qn_num_div, qn_num_mod, qn_num_atan2, qn_num_sin_over_sqrt};
enum { ONE_COUNT = sizeof ONES / sizeof *ONES, TWO_COUNT = sizeof TWOS / sizeof *TWOS, OTHERS = 8, KINDS = ONE_COUNT + TWO_COUNT + OTHERS };

/* The domains are the callers' part. */
static int in_domain(qn_ctx *c, int kind, qn_num a, qn_num b) {
  const one_fn f = kind < ONE_COUNT ? ONES[kind] : NULL;
  const two_fn g = kind >= ONE_COUNT && kind < ONE_COUNT + TWO_COUNT ? TWOS[kind - ONE_COUNT] : NULL;
  if (f == qn_num_sqrt || f == qn_num_ln) {
    return qn_num_sign(a) > 0;
  }
  if (f == qn_num_asin || f == qn_num_acos) {
    return qn_num_cmp(c, qn_num_abs(c, a), QN_NUM_ONE) <= 0;
  }
  if (f == qn_num_exp || f == qn_num_sin || f == qn_num_cos) {
    return fabs(qn_num_to_double(a)) < 1e6;
  }
  if (g == qn_num_div || g == qn_num_mod) {
    return !qn_num_is_zero(b);
  }
  return g != qn_num_sin_over_sqrt || qn_num_sign(b) > 0;
}

static void apply(qn_ctx *c, int kind, qn_num a, qn_num b) {
  if (kind < ONE_COUNT) {
    ONES[kind](c, a);
    return;
  }
  if (kind < ONE_COUNT + TWO_COUNT) {
    TWOS[kind - ONE_COUNT](c, a, b);
    return;
  }
  qn_num out;
  int64_t v;
  double hi, lo;
  const qn_num row[2] = {a, b};
  switch (kind - ONE_COUNT - TWO_COUNT) {
  case 0: qn_num_pow(c, a, b, &out); break;
  case 1: qn_num_tan(c, a, &out); break;
  case 2: qn_num_dot(c, 2, row, row); break;
  case 3: qn_num_text(c, a); break;
  case 4: qn_num_to_dd(c, a, &hi, &lo); break;
  case 5: qn_num_cmp(c, a, b); break;
  case 6: qn_num_is_integer(qn_num_copy(c, a), &v); break;
  default: qn_num_from_rat(c, qn_num_rat(c, a).num, qn_num_rat(c, b).den, 1);
  }
}

static size_t some_numbers(qn_ctx *c, qn_num to[32]) {
  static const char *const texts[] = {"0", "1", "-1", "3", "-3", "0.5", "45", "-60", "1e-400", "-11e1800", "7e300", "123456789012345678901234567890123456789.5", "-0.25e-1200",
                                      "340282366920938463463374607431768211456"};
  size_t n = 0;
  quoin_status status = QUOIN_OK;
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    assert_int_equal(qn_num_read(c, texts[i], strlen(texts[i]), &to[n++], &status), strlen(texts[i]));
  }
  const qn_num seven = qn_num_from_int(c, 7), eleven = qn_num_from_int(c, 11);
  qn_num power;
  assert_true(qn_num_pow(c, seven, qn_num_from_int(c, 1500), &power));
  to[n++] = power;
  to[n++] = qn_num_neg(c, qn_num_div(c, eleven, power));
  to[n++] = qn_num_div(c, qn_num_add(c, power, QN_NUM_ONE), qn_num_mul(c, power, eleven));
  to[n++] = qn_num_div(c, QN_NUM_ONE, qn_num_from_int(c, 3));
  to[n++] = qn_num_sqrt(c, qn_num_from_int(c, 2));
  to[n++] = qn_num_neg(c, qn_num_exp(c, qn_num_from_int(c, 900)));
  to[n++] = qn_num_pi(c);
  assert_int_equal(c->failed, QUOIN_OK);
  return n;
}

static void test_refused_effort(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_num a[32];
  const size_t n = some_numbers(&s.ctx, a);
  size_t cut = 0, whole = 0;
  for (int kind = 0; kind < KINDS; kind++) {
    for (size_t k = 0; k < n * n; k++) {
      const qn_num x = a[k / n], y = a[k % n];
      if ((kind < ONE_COUNT && k % n != 0) || !in_domain(&s.ctx, kind, x, y)) {
        continue;
      }
      uint64_t last = 0; /* what was spent at the first step that was refused: the next one is cut off there */
      for (int step = 0; step < 200; step++) {
        setup t;
        setup_init(&t, NULL);
        t.ctx.max_effort = step ? last : 1;
        apply(&t.ctx, kind, x, y);
        const int refused = t.ctx.failed == QUOIN_E_LIMIT && t.ctx.effort == t.ctx.max_effort + 1;
        assert_true(refused || t.ctx.failed == QUOIN_OK || t.ctx.failed == QUOIN_E_LIMIT);
        cut += (size_t)refused, whole += !refused;
        setup_free(&t);
        if (!refused) {
          break;
        }
        last = step ? last + last / 8 + 40 : 80; /* a result of nine limbs takes 81 */
      }
    }
  }
  print_message("%zu times cut off, %zu times through\n", cut, whole);
  assert_true(cut > 20000 && whole > 2000);
  setup_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_refused_effort)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
