/* Places along a line of long numbers against GMP's rationals rounded by MPFR: the same bits. */
#include <gmp.h>
#include <mpfr.h>

#include "shape/super_long.h"
#include "shapes.h"

/* num / 10^digits times a random fraction of small numbers, or 0; in lowest terms. */
static void random_rational(bench *b, gmp_randstate_t random, int digits, mpq_t out) {
  if (below(b, 8) == 0) {
    mpq_set_ui(out, 0, 1);
    return;
  }
  mpz_urandomb(mpq_numref(out), random, (mp_bitcnt_t)(1 + below(b, 4000)));
  mpz_ui_pow_ui(mpq_denref(out), 10, (unsigned long)digits);
  mpz_mul_ui(mpq_denref(out), mpq_denref(out), (unsigned long)(1 + below(b, 1000)));
  mpz_mul_2exp(mpq_numref(out), mpq_numref(out), (mp_bitcnt_t)below(b, 2000));
  if (below(b, 2)) {
    mpz_neg(mpq_numref(out), mpq_numref(out));
  }
  mpq_canonicalize(out);
}

static qn_int whole_number(qn_ctx *ctx, const mpz_t v) {
  return qn_int_from_limbs(ctx, mpz_limbs_read(v), (mp_size_t)mpz_size(v), mpz_sgn(v) < 0);
}

static void places_are_rounded_to_nearest(void **state) {
  (void)state;
  bench b;
  bench_init(&b);
  gmp_randstate_t random;
  gmp_randinit_default(random);
  mpq_t o, d, t;
  mpq_inits(o, d, t, NULL);
  int cancelled = 0, large = 0, small = 0;
  for (int round = 0; round < 300; round++) {
    const qn_mark mark = qn_arena_mark(&b.ctx.arena);
    qn_super_exact line = {.ctx = &b.ctx, .e = QN_NUM_ONE, .n = QN_NUM_ONE};
    mpq_t at[3][2];
    const double time =
      below(&b, 10) ? ldexp(below(&b, 2) ? real(&b, -1, 1) : below(&b, 65) - 32, below(&b, 3) ? 0 : below(&b, 2000) - 1000) : 0;
    for (int i = 0; i < 3; i++) {
      mpq_inits(at[i][0], at[i][1], NULL);
      random_rational(&b, random, below(&b, 1000), at[i][0]);
      random_rational(&b, random, i == 0 ? 1000 : below(&b, 1000), at[i][1]);
      if (i == 2 && below(&b, 2)) { /* next to nothing is left at this time */
        mpq_set_d(t, time);
        mpq_mul(at[i][0], at[i][1], t);
        mpq_neg(at[i][0], at[i][0]);
        mpq_set_ui(t, 1, 1);
        mpq_div_2exp(t, t, 3000);
        mpq_add(at[i][0], at[i][0], t);
      }
      line.O[i] = qn_num_from_rat(&b.ctx, whole_number(&b.ctx, mpq_numref(at[i][0])), whole_number(&b.ctx, mpq_denref(at[i][0])), 0);
      line.D[i] = qn_num_from_rat(&b.ctx, whole_number(&b.ctx, mpq_numref(at[i][1])), whole_number(&b.ctx, mpq_denref(at[i][1])), 0);
    }
    qn_super_long whole;
    if (qn_super_long_make(&line, &whole)) {
      for (int i = 0; i < 3; i++) {
        mpfr_t got, want;
        mpfr_inits2(64 + below(&b, 300), got, want, (mpfr_ptr)NULL);
        qn_super_long_at(&b.ctx, &whole, i, time, got);
        mpq_set_d(t, time);
        mpq_mul(d, at[i][1], t);
        mpq_add(o, at[i][0], d);
        mpfr_set_q(want, o, MPFR_RNDN);
        assert_true(mpfr_equal_p(got, want) && mpfr_signbit(got) == mpfr_signbit(want));
        cancelled += !mpfr_zero_p(want) && mpq_sgn(at[i][0]) != 0 && mpfr_get_exp(want) < -2500;
        large += fabs(time) > 0x1p100, small += time != 0 && fabs(time) < 0x1p-100;
        mpfr_clears(got, want, (mpfr_ptr)NULL);
      }
    }
    assert_int_equal(b.ctx.failed, QUOIN_OK);
    for (int i = 0; i < 3; i++) {
      mpq_clears(at[i][0], at[i][1], NULL);
    }
    qn_arena_release(&b.ctx.arena, mark);
  }
  assert_true(cancelled > 20 && large > 20 && small > 20);
  mpq_clears(o, d, t, NULL);
  gmp_randclear(random);
  mpfr_free_cache();
  bench_free(&b);
}

/* Short numbers, and rounded ones, go the other way. */
static void which_are_taken(void **state) {
  (void)state;
  bench b;
  bench_init(&b);
  qn_super_exact line = {
    .ctx = &b.ctx, .e = QN_NUM_ONE, .n = QN_NUM_ONE, .O = {QN_NUM_ONE, QN_NUM_ONE, QN_NUM_ONE}, .D = {QN_NUM_ONE, QN_NUM_ONE, QN_NUM_ONE}};
  qn_super_long whole;
  assert_false(qn_super_long_make(&line, &whole));
  line.D[2] = qn_num_from_rat(&b.ctx, qn_int_from(&b.ctx, 1),
                              qn_int_add(&b.ctx, qn_int_shl(&b.ctx, qn_int_from(&b.ctx, 1), 5000), qn_int_from(&b.ctx, 1)), 0);
  assert_true(qn_super_long_make(&line, &whole));
  line.O[0] = qn_num_from_rat(&b.ctx, qn_int_from(&b.ctx, 1), qn_int_from(&b.ctx, 3), 1);
  assert_true(qn_num_is_rounded(line.O[0]));
  assert_false(qn_super_long_make(&line, &whole));
  bench_free(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(places_are_rounded_to_nearest), cmocka_unit_test(which_are_taken)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
