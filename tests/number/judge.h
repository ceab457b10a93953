/* The judge of numbers: GMP's rationals, MPFR's rounding, and the canonical form looked at from outside. */
#ifndef JUDGE_H
#define JUDGE_H

#include "numbers.h"

#include <mpfr.h>

static inline void to_mpq(mpq_t q, qn_num a) {
  if (a.kind != QN_NUM_SMALL) {
    to_mpz(mpq_numref(q), a.u.big->num);
    to_mpz(mpq_denref(q), a.u.big->den);
    return;
  }
  mpq_set_si(q, a.u.m, 1);
  mpz_t p;
  mpz_init(p);
  mpz_ui_pow_ui(p, 5, (unsigned long)abs(a.b));
  mpz_ptr fives = a.b < 0 ? mpq_denref(q) : mpq_numref(q), twos = a.a < 0 ? mpq_denref(q) : mpq_numref(q);
  mpz_mul(fives, fives, p);
  mpz_mul_2exp(twos, twos, (mp_bitcnt_t)abs(a.a));
  mpz_clear(p);
  mpq_canonicalize(q);
}

/* Whether the form is the canonical one of its value. */
static inline int canonical(qn_num a) {
  if (a.kind == QN_NUM_SMALL) {
    return a.u.m == 0 ? a.a == 0 && a.b == 0 : a.u.m % 2 != 0 && a.u.m % 5 != 0;
  }
  mpz_t n, d, g, five;
  mpz_inits(n, d, g, NULL);
  mpz_init_set_ui(five, 5);
  to_mpz(n, a.u.big->num);
  to_mpz(d, a.u.big->den);
  mpz_gcd(g, n, d);
  int good = mpz_sgn(n) != 0 && mpz_sgn(d) > 0 && mpz_cmp_ui(g, 1) == 0;
  long twos = mpz_sgn(n) ? (long)mpz_scan1(n, 0) - (long)mpz_scan1(d, 0) : 0;
  mpz_tdiv_q_2exp(d, d, mpz_scan1(d, 0));
  if (a.kind == QN_NUM_ROUNDED) {
    mpz_tdiv_q_2exp(n, n, mpz_scan1(n, 0));
    good = good && mpz_cmp_ui(d, 1) == 0 && mpz_sizeinbase(n, 2) <= QN_S2_PRECISION;
  } else { /* big only if it has no small form */
    mpz_tdiv_q_2exp(n, n, mpz_scan1(n, 0));
    long fives = (long)mpz_remove(n, n, five);
    fives -= (long)mpz_remove(d, d, five);
    int small = mpz_cmp_ui(d, 1) == 0 && mpz_fits_slong_p(n) && twos >= -32768 && twos < 32768 && fives >= -32768 && fives < 32768;
    good = good && !small;
  }
  mpz_clears(n, d, g, five, NULL);
  return good;
}

static inline int same_mpq(qn_num a, const mpq_t q) {
  mpq_t x;
  mpq_init(x);
  to_mpq(x, a);
  int same = mpq_equal(x, q);
  mpq_clear(x);
  return same;
}

/* |q| rounded to QN_S2_PRECISION bits by MPFR, to nearest. */
static inline void round_mpq(mpq_t q) {
  mpfr_t y;
  mpfr_init2(y, QN_S2_PRECISION);
  mpfr_set_q(y, q, MPFR_RNDN);
  mpfr_get_q(q, y);
  mpfr_clear(y);
}

/* Whether |x| < 2^-QN_S2_BITS |larger|. */
static inline int negligible(const mpq_t x, const mpq_t larger) {
  mpq_t a, b;
  mpq_inits(a, b, NULL);
  mpq_abs(a, x);
  mpq_abs(b, larger);
  mpq_mul_2exp(a, a, QN_S2_BITS);
  int r = mpq_cmp(a, b) < 0;
  mpq_clears(a, b, NULL);
  return r;
}

/* Whether d is the double nearest to q, ties to even, signed zero aside. */
static inline int is_nearest(const mpq_t q, double d) {
  mpq_t a, b;
  mpq_inits(a, b, NULL);
  double s = fabs(d), up = nextafter(s, INFINITY), down = nextafter(s, -INFINITY);
  int good = mpq_sgn(q) == 0 ? d == 0 : d == 0 || (mpq_sgn(q) < 0) == (d < 0), even = 1;
  if (isfinite(s)) {
    uint64_t bits;
    memcpy(&bits, &s, sizeof bits);
    even = (bits & 1) == 0;
  } else {
    s = ldexp(1, 1023), down = ldexp(0x1.fffffffffffffp0, 1023);
  }
  /* 2 |q| against s + up and s + down; infinity counts as 2^1024. */
  mpq_abs(a, q);
  mpq_mul_2exp(a, a, 1);
  mpq_t sum;
  mpq_init(sum);
  mpq_set_d(sum, s);
  if (isinf(d)) {
    mpq_mul_2exp(sum, sum, 1);
  } else if (isinf(up)) {
    mpq_set_d(b, ldexp(1, 1023));
    mpq_mul_2exp(b, b, 1);
  } else {
    mpq_set_d(b, up);
  }
  if (!isinf(d)) {
    mpq_add(b, b, sum);
    int order = mpq_cmp(a, b);
    good = good && (order < 0 || (order == 0 && even));
  }
  mpq_set_d(b, down);
  mpq_add(b, b, sum);
  int order = mpq_cmp(a, b);
  good = good && (order > 0 || (order == 0 && even));
  mpq_clears(a, b, sum, NULL);
  return good;
}

/* A number of any kind: integers, decimals, doubles, small ones with far exponents, fractions, long ones, rounded ones. */
static inline qn_num random_num(qn_ctx *c, uint64_t *seed, int with_rounded) {
  qn_int n, d;
  int negative = (int)random_below(seed, 2);
  qn_num r = QN_NUM_ZERO;
  switch (random_below(seed, with_rounded ? 10 : 8)) {
    case 0: return qn_num_from_int(c, (int64_t)random_bits(seed) >> random_below(seed, 64));
    case 1: { /* a decimal */
      char text[64];
      int size = snprintf(text, sizeof text, "%s%llu.%llue%d", negative ? "-" : "",
                          (unsigned long long)(random_bits(seed) >> random_below(seed, 64)),
                          (unsigned long long)random_below(seed, 100000), (int)random_below(seed, 30) - 15);
      quoin_status status;
      assert_int_equal(qn_num_read(c, text, (size_t)size, &r, &status), size);
      return r;
    }
    case 2: { /* any finite double */
      uint64_t bits = random_bits(seed);
      double v;
      memcpy(&v, &bits, sizeof v);
      return isfinite(v) ? qn_num_from_double(c, v) : QN_NUM_ONE;
    }
    case 3: return qn_num_from_double(c, ldexp((double)random_below(seed, 1000), (int)random_below(seed, 40) - 20));
    case 4: /* far exponents */
      n = qn_int_mul(c, qn_int_from(c, (int64_t)random_bits(seed) >> 1), qn_int_pow(c, qn_int_from(c, 5), (unsigned)random_below(seed, 300)));
      d = qn_int_shl(c, qn_int_from(c, 1), random_below(seed, 1200));
      return random_below(seed, 2) || n.n == 0 ? qn_num_from_rat(c, n, d, 0) : qn_num_from_rat(c, d, n, 0);
    case 5: case 6:
      n = random_int(c, seed, random_below(seed, 4) ? 1 : 6);
      d = random_int(c, seed, random_below(seed, 4) ? 1 : 6);
      return d.n ? qn_num_from_rat(c, n, d, 0) : QN_NUM_ZERO;
    case 7: return QN_NUM_ZERO;
    default: /* at most 256 bits, so that the value is known: the rounding has a test of its own */
      n = random_int(c, seed, 4);
      d = qn_int_shl(c, qn_int_from(c, 1), random_below(seed, 400));
      return qn_num_from_rat(c, n, d, 1);
  }
}

#endif
