/* Balls hold the exact value of what was computed, taken in rationals (QN_SHADOW). */
#include "base/bounds.h"
#include "scene/ball.h"

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

static uint64_t state = 4242;
static uint64_t rnd(void) {
  state ^= state << 13, state ^= state >> 7, state ^= state << 17;
  return state * 0x2545F4914F6CDD1Du;
}

static void power_of_two(mpq_t x, long e) { /* x 2^e */
  if (e >= 0) {
    mpq_mul_2exp(x, x, (mp_bitcnt_t)e);
  } else {
    mpq_div_2exp(x, x, (mp_bitcnt_t)-e);
  }
}

static void centre(const qn_ball *a, mpq_t out) {
  mpz_import(mpq_numref(out), QN_BALL_LIMBS, -1, sizeof(mp_limb_t), 0, 0, a->m);
  mpz_set_ui(mpq_denref(out), 1);
  power_of_two(out, (long)a->e - 256);
  if (a->sign < 0) {
    mpq_neg(out, out);
  }
  if (a->sign == 0) {
    mpq_set_ui(out, 0, 1);
  }
}

/* |x - centre| <= err 2^-253 |centre| */
static void check(const qn_ball *a, const mpq_t x) {
  if (!qn_ball_known(a)) {
    return;
  }
  if (a->sign) {
    assert_true(a->m[3] >> 63);
  }
  mpq_t c, e;
  mpq_inits(c, e, NULL);
  centre(a, c);
  mpq_set_d(e, a->err);
  mpq_mul(e, e, c);
  power_of_two(e, -253);
  mpq_abs(e, e);
  mpq_sub(c, x, c);
  mpq_abs(c, c);
  assert_true(mpq_cmp(c, e) <= 0);
  mpq_clears(c, e, NULL);
}

static qn_num small(int64_t m, int a, int b) { /* canonical */
  while (m && m % 2 == 0) {
    m /= 2, a++;
  }
  while (m && m % 5 == 0) {
    m /= 5, b++;
  }
  return m ? (qn_num){{m}, (int16_t)a, (int16_t)b, QN_NUM_SMALL} : QN_NUM_ZERO;
}

static qn_ball random_ball(qn_ctx *ctx, mpq_t x) {
  int64_t m = (int64_t)rnd() >> (rnd() % 63);
  int b = 0, a = (int)(rnd() % 41) - 20;
  switch (rnd() % 5) {
  case 0: m %= 4, a = 0; break;
  case 1: b = -(int)(rnd() % 10), a = b; break; /* a decimal */
  case 2: b = (int)(rnd() % 55) - 27; break;
  case 3: {
    double d = ldexp((double)m, a);
    mpq_set_d(x, d);
    return qn_ball_from_double(d);
  }
  default: break;
  }
  qn_num n = small(m, a, b);
  mpq_set_si(x, 1, 1);
  mpz_set_si(mpq_numref(x), m);
  mpz_t five;
  mpz_init(five);
  mpz_ui_pow_ui(five, 5, (unsigned long)(b < 0 ? -b : b));
  if (b < 0) {
    mpz_set(mpq_denref(x), five);
  } else {
    mpz_mul(mpq_numref(x), mpq_numref(x), five);
  }
  mpz_clear(five);
  mpq_canonicalize(x);
  power_of_two(x, a);
  return qn_ball_from_num(ctx, n);
}

enum { POOL = 30 };

static void QN_SHADOW_expressions(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  qn_ctx ctx;
  qn_ctx_init(&ctx, &mem);
  mpq_t x[POOL], r, s;
  for (int i = 0; i < POOL; i++) {
    mpq_init(x[i]);
  }
  mpq_inits(r, s, NULL);
  size_t known = 0, lost = 0, exact = 0, zeros = 0, cancelled = 0;
  for (int round = 0; round < 3000; round++) {
    qn_ball b[POOL];
    for (int i = 0; i < POOL; i++) {
      if (i < 6) {
        b[i] = random_ball(&ctx, x[i]);
      } else {
        int p = (int)(rnd() % (unsigned)i), q = (int)(rnd() % (unsigned)i), op = (int)(rnd() % 5);
        if (op == 4 && i >= 8) { /* nearly equal: p + small - p */
          qn_ball tiny = qn_ball_from_double(ldexp(1, -(int)(rnd() % 90)));
          qn_ball_mul(&tiny, &b[q], &b[i]);
          qn_ball_add(&b[p], &b[i], &b[i]);
          qn_ball_sub(&b[i], &b[p], &b[i]);
          mpq_set_d(x[i], ldexp(1, -60));
          centre(&tiny, r);
          mpq_mul(x[i], r, x[q]);
          cancelled++;
        } else if (op == 0 || op == 4) {
          qn_ball_add(&b[p], &b[q], &b[i]);
          mpq_add(x[i], x[p], x[q]);
        } else if (op == 1) {
          qn_ball_sub(&b[p], &b[q], &b[i]);
          mpq_sub(x[i], x[p], x[q]);
        } else if (op == 2 || mpq_sgn(x[q]) == 0 || b[q].sign == 0) {
          qn_ball_mul(&b[p], &b[q], &b[i]);
          mpq_mul(x[i], x[p], x[q]);
        } else {
          qn_ball_div(&b[p], &b[q], &b[i]);
          mpq_div(x[i], x[p], x[q]);
        }
        if (mpz_sizeinbase(mpq_denref(x[i]), 2) + mpz_sizeinbase(mpq_numref(x[i]), 2) > 4000) {
          b[i] = random_ball(&ctx, x[i]);
        }
      }
      check(&b[i], x[i]);
      if (!qn_ball_known(&b[i])) {
        lost++;
        b[i] = random_ball(&ctx, x[i]);
        continue;
      }
      known++;
      exact += b[i].err == 0;
      zeros += b[i].sign == 0;
      assert_int_equal(b[i].sign, mpq_sgn(x[i]));
      double d = qn_ball_to_double(&b[i]);
      mpq_set_d(r, d);
      mpq_sub(r, r, x[i]);
      mpq_abs(r, r);
      mpq_set_d(s, QN_SHADOW);
      mpq_mul(s, s, x[i]);
      mpq_abs(s, s);
      assert_true(b[i].e > 1000 || b[i].e < -999 || mpq_cmp(r, s) <= 0);
    }
  }
  print_message("known %zu exact %zu zero %zu cancelled %zu unknown %zu\n", known, exact, zeros, cancelled, lost);
  assert_true(known > 50000 && exact > 10000 && exact < known - 10000 && zeros > 1000 && cancelled > 5000 && lost > 100);
  for (int i = 0; i < POOL; i++) {
    mpq_clear(x[i]);
  }
  mpq_clears(r, s, NULL);
  qn_ctx_free(&ctx);
  assert_int_equal(mem.used, 0);
}

static void sizes_beyond_doubles(void **unused) {
  (void)unused;
  qn_ball big = qn_ball_from_double(-0x1p1000), small_one = qn_ball_from_double(0x1p-999), square;
  assert_true(qn_ball_to_double(&small_one) == 0x1p-999);
  qn_ball_mul(&big, &big, &square);
  assert_true(qn_ball_to_double(&square) == QN_SHADOW_LARGEST);
  qn_ball_mul(&small_one, &small_one, &square);
  qn_ball_neg(&square);
  assert_true(qn_ball_to_double(&square) == -1 / QN_SHADOW_LARGEST);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(QN_SHADOW_expressions), cmocka_unit_test(sizes_beyond_doubles)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
