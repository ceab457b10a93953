/* Irrational functions, correctly rounded to QN_S2_PRECISION bits, and their exact values where there are any.

   Legend: p the working precision; w = 2^-p, which bounds the relative error of each correctly rounded operation. A value
   y computed with relative error at most 2^k w is certain when y - 2^k w |y| and y + 2^k w |y| round to the same number; else p is
   doubled (Ziv 1991). That ends, because every rational value is taken out before:
   - at rational degrees, sin and cos are rational only as 0, 1/2, 1 and their negatives, tan only as 0, 1, -1 (Niven
     1956, cor. 3.12), so asin, acos, atan of a rational are rational degrees only there;
   - exp(x), x != 0, and ln(x), x != 1, of a rational are transcendental (Lindemann);
   - x^(p/q) reduced is rational only when x is a q-th power of a rational.
   Conditions, with x the argument made with 5 roundings at most, each factor being |x f'(x) / f(x)|:
   sin, cos on (0, 45] degrees: at most 1; tan: at most pi/2; atan: at most 1; asin and acos go through atan with
   sqrt(den^2 - num^2) exact below the root; ln through log1p on (1/2, 2): at most 1.45, elsewhere 1/|ln x| < 1.45.
   All stay below 2^5 w. exp: |x| times the error of x, so 2^5 |x| w where |x| > 1. */
#include "base/limits.h"
#include "number/num_parts.h"

#include <mpfr.h>
#include <pthread.h>

/* MPFR keeps constants and scratch for each thread. They are worth keeping (pi, above all), and whichever thread has been here gives
   them back when it ends: the thread may be the caller's, so nobody else would. The key is written once and then only read. */
static pthread_once_t key_once = PTHREAD_ONCE_INIT;
static pthread_key_t key;
static int key_made;

static void give_back(void *used) {
  (void)used;
  mpfr_free_cache2(MPFR_FREE_LOCAL_CACHE);
}
static void make_key(void) {
  key_made = pthread_key_create(&key, give_back) == 0;
}
static void give_back_at_end(void) {
  pthread_once(&key_once, make_key);
  if (key_made) {
    pthread_setspecific(key, &key); /* any non-null value: it makes the thread's end call give_back */
  }
}

typedef enum function { SIN, COS, TAN, ATAN, ATAN_PLUS, EXP, LN, POW, ROOT, SIN_ROOT, COS_ROOT } function;

/* f of n/d, or of n/d and m/e. For ATAN the argument is n/d, or with `root_n` sqrt(n)/d, with `root_d` n/sqrt(d). */
typedef struct call {
  function f;
  qn_int n, d, m, e;
  int root_n, root_d;
} call;

static mpz_srcptr view(mpz_t z, qn_int a) {
  return mpz_roinit_n(z, a.d, a.n);
}

static void set(mpfr_t y, qn_int a) {
  mpz_t z;
  /* cppcheck-suppress uninitvar ; view fills it */
  mpfr_set_z(y, view(z, a), MPFR_RNDN);
}

static void quotient(mpfr_t y, qn_int n, qn_int d) {
  mpz_t z;
  set(y, n);
  /* cppcheck-suppress uninitvar ; view fills it */
  mpfr_div_z(y, y, view(z, d), MPFR_RNDN);
}

/* ln(n/d) into y; t is scratch. */
static void logarithm(mpfr_t y, mpfr_t t, qn_ctx *ctx, qn_int n, qn_int d) {
  int near_one = qn_int_cmp(qn_int_shl(ctx, n, 1), d) > 0 && qn_int_cmp(n, qn_int_shl(ctx, d, 1)) < 0;
  quotient(t, near_one ? qn_int_sub(ctx, n, d) : n, d);
  if (near_one) {
    mpfr_log1p(y, t, MPFR_RNDN);
  } else {
    mpfr_log(y, t, MPFR_RNDN);
  }
}

/* y at its precision; the error is at most 2^k w |y|, k returned. t is scratch of the same precision. */
static long evaluate(qn_ctx *ctx, const call *c, mpfr_t y, mpfr_t t) {
  switch (c->f) {
    case SIN: case COS: case TAN: case SIN_ROOT: case COS_ROOT:
      quotient(y, c->n, c->d);
      mpfr_const_pi(t, MPFR_RNDN);
      mpfr_mul(y, y, t, MPFR_RNDN);
      mpfr_div_ui(y, y, 180, MPFR_RNDN);
      if (c->f == SIN || c->f == SIN_ROOT) {
        mpfr_sin(y, y, MPFR_RNDN);
      } else if (c->f == TAN) {
        mpfr_tan(y, y, MPFR_RNDN);
      } else {
        mpfr_cos(y, y, MPFR_RNDN);
      }
      if (c->f == SIN_ROOT || c->f == COS_ROOT) {
        quotient(t, c->m, c->e);
        mpfr_sqrt(t, t, MPFR_RNDN);
        mpfr_div(y, y, t, MPFR_RNDN);
      }
      return 5;
    case ATAN: case ATAN_PLUS:
      set(y, c->n);
      set(t, c->d);
      if (c->root_n) {
        mpfr_sqrt(y, y, MPFR_RNDN);
      }
      if (c->root_d) {
        mpfr_sqrt(t, t, MPFR_RNDN);
      }
      mpfr_div(y, y, t, MPFR_RNDN);
      mpfr_atan(y, y, MPFR_RNDN);
      mpfr_mul_ui(y, y, 180, MPFR_RNDN);
      mpfr_const_pi(t, MPFR_RNDN);
      mpfr_div(y, y, t, MPFR_RNDN);
      if (c->f == ATAN_PLUS) { /* 180 - y, y in (0, 90): the result is the larger, so nothing is lost */
        mpfr_ui_sub(y, 180, y, MPFR_RNDN);
      }
      return 5;
    case EXP: case POW:
      if (c->f == EXP) {
        quotient(y, c->n, c->d);
      } else {
        logarithm(y, t, ctx, c->n, c->d);
        quotient(t, c->m, c->e);
        mpfr_mul(y, y, t, MPFR_RNDN);
      }
      {
        long size = mpfr_zero_p(y) || mpfr_get_exp(y) < 0 ? 0 : (long)mpfr_get_exp(y);
        if (size > 28) { /* over 2^27 bits before or behind the point; under 2^28 MPFR's exponents (2^30) hold it */
          qn_ctx_fail_(ctx, QUOIN_E_LIMIT);
          return 0;
        }
        mpfr_exp(y, y, MPFR_RNDN);
        return 5 + size;
      }
    case LN:
      logarithm(y, t, ctx, c->n, c->d);
      return 5;
    case ROOT:
      quotient(y, c->n, c->d);
      mpfr_sqrt(y, y, MPFR_RNDN);
      return 5;
  }
  return 0;
}

/* y, of QN_S2_PRECISION bits, as a number. */
static qn_num number_of(qn_ctx *ctx, mpfr_t y, int negative) {
  qn_mark mark = qn_arena_mark(&ctx->arena);
  int64_t limit = ctx->max_bits ? (int64_t)ctx->max_bits : QN_MAX_BITS;
  mpz_t z;
  mpz_init(z);
  int64_t e = (int64_t)mpfr_get_z_2exp(z, y);
  qn_int num = qn_int_from_limbs(ctx, mpz_limbs_read(z), (mp_size_t)mpz_size(z), (mpz_sgn(z) < 0) != negative);
  mpz_clear(z);
  if (e > limit || e < -limit) {
    qn_ctx_fail_(ctx, QUOIN_E_LIMIT);
    return QN_NUM_ZERO;
  }
  qn_int den = e < 0 ? qn_int_shl(ctx, QN_INT_ONE_, (size_t)-e) : QN_INT_ONE_;
  return qn_num_settle_(ctx, mark, e > 0 ? qn_int_shl(ctx, num, (size_t)e) : num, den, 1);
}

/* The value of an irrational call, rounded. */
static qn_num ziv(qn_ctx *ctx, const call *c, int negative) {
  qn_num result = QN_NUM_ZERO;
  mpfr_t y, t, low, high;
  give_back_at_end();
  mpfr_inits2(QN_S2_PRECISION, low, high, (mpfr_ptr)0);
  mpfr_inits2(QN_S2_PRECISION + 64, y, t, (mpfr_ptr)0);
  while (ctx->failed == QUOIN_OK) {
    long p = (long)mpfr_get_prec(y), k = evaluate(ctx, c, y, t);
    if (mpfr_nan_p(y)) { /* outside the domain: the caller's error, but no hang */
      break;
    }
    if (ctx->failed == QUOIN_OK && k + 2 < p && mpfr_regular_p(y)) {
      mpfr_set_ui_2exp(t, 1, mpfr_get_exp(y) + k - p, MPFR_RNDN); /* 2^k w |y| < 2^k w 2^EXP(y) */
      mpfr_sub(low, y, t, MPFR_RNDN);
      mpfr_add(high, y, t, MPFR_RNDN);
      if (mpfr_equal_p(low, high)) {
        result = number_of(ctx, low, negative);
        break;
      }
    }
    mpfr_set_prec(y, 2 * p);
    mpfr_set_prec(t, 2 * p);
  }
  mpfr_clears(y, t, low, high, (mpfr_ptr)0);
  return result;
}

static qn_num negated_if(qn_ctx *ctx, int negative, qn_num a) {
  return negative ? qn_num_neg(ctx, a) : a;
}

/* A rounded number that agrees with the exact one is it (S2). */
static int is(qn_ctx *ctx, qn_num a, int64_t n, int64_t d) {
  return qn_num_cmp(ctx, a, qn_num_div(ctx, qn_num_from_int(ctx, n), qn_num_from_int(ctx, d))) == 0;
}

/* A rounded angle that agrees with a multiple of 15 degrees is that multiple. */
static qn_num snapped(qn_ctx *ctx, qn_num degrees) {
  if (qn_num_is_rounded(degrees)) {
    qn_num fifteen = qn_num_from_int(ctx, 15);
    qn_num near = qn_num_mul(ctx, fifteen, qn_num_round(ctx, qn_num_div(ctx, degrees, fifteen)));
    if (!qn_num_is_rounded(near) && qn_num_cmp(ctx, degrees, near) == 0) {
      return near;
    }
  }
  return degrees;
}

/* A number times d as an integer, for a denominator d. */
static qn_int of_den(qn_ctx *ctx, qn_int d, int64_t v) {
  return qn_int_mul(ctx, qn_int_from(ctx, v), d);
}

/* degrees = n/d reduced to sin(n/d) with 0 <= n/d <= 90 and a sign. */
static qn_int first_quadrant(qn_ctx *ctx, qn_rat a, int64_t add, int *negative) {
  qn_int q, t, half = of_den(ctx, a.den, 180);
  qn_int_divmod(ctx, qn_int_add(ctx, a.num, of_den(ctx, a.den, add)), of_den(ctx, a.den, 360), &q, &t);
  *negative = t.n < 0; /* sin is odd */
  t = qn_int_abs(t);
  if (qn_int_cmp(t, half) >= 0) {
    t = qn_int_sub(ctx, t, half);
    *negative = !*negative;
  }
  return qn_int_cmp(qn_int_shl(ctx, t, 1), half) > 0 ? qn_int_sub(ctx, half, t) : t;
}

static qn_num sine(qn_ctx *ctx, qn_num degrees, int64_t add) {
  qn_num r;
  degrees = snapped(ctx, degrees);
  qn_rat a = qn_num_rat(ctx, degrees);
  int negative;
  qn_int t = first_quadrant(ctx, a, add, &negative), right = of_den(ctx, a.den, 90);
  if (t.n == 0 || ctx->failed != QUOIN_OK) {
    r = QN_NUM_ZERO;
  } else if (qn_int_equal(t, right)) {
    r = QN_NUM_ONE;
  } else if (qn_int_equal(t, of_den(ctx, a.den, 30))) {
    r = qn_num_div(ctx, QN_NUM_ONE, qn_num_from_int(ctx, 2));
  } else if (qn_int_cmp(qn_int_shl(ctx, t, 1), right) > 0) {
    return ziv(ctx, &(call){.f = COS, .n = qn_int_sub(ctx, right, t), .d = a.den}, negative);
  } else {
    return ziv(ctx, &(call){.f = SIN, .n = t, .d = a.den}, negative);
  }
  return negated_if(ctx, negative, r);
}

static int tangent(qn_ctx *ctx, qn_num degrees, qn_num *out) {
  qn_rat a = qn_num_rat(ctx, snapped(ctx, degrees));
  qn_int q, t, half = of_den(ctx, a.den, 180), right = of_den(ctx, a.den, 90), eighth = of_den(ctx, a.den, 45);
  *out = QN_NUM_ZERO;
  qn_int_divmod(ctx, a.num, half, &q, &t);
  int negative = t.n < 0;
  t = qn_int_abs(t);
  if (qn_int_cmp(t, right) > 0) {
    t = qn_int_sub(ctx, half, t);
    negative = !negative;
  }
  if (ctx->failed != QUOIN_OK || t.n == 0) {
    return 1;
  }
  if (qn_int_equal(t, right)) {
    return 0;
  }
  if (qn_int_equal(t, eighth)) {
    *out = negated_if(ctx, negative, QN_NUM_ONE);
  } else {
    *out = ziv(ctx, &(call){.f = TAN, .n = t, .d = a.den}, negative);
  }
  return 1;
}

static qn_num arc_sine(qn_ctx *ctx, qn_num a) {
  qn_num size = qn_num_abs(ctx, a);
  int negative = qn_num_sign(a) < 0;
  if (qn_num_is_zero(a)) {
    return a;
  }
  if (is(ctx, size, 1, 1) || is(ctx, size, 1, 2)) {
    return negated_if(ctx, negative, qn_num_from_int(ctx, is(ctx, size, 1, 1) ? 90 : 30));
  }
  qn_rat r = qn_num_rat(ctx, size); /* tan = num / sqrt(den^2 - num^2) */
  qn_int rest = qn_int_sub(ctx, qn_int_mul(ctx, r.den, r.den), qn_int_mul(ctx, r.num, r.num));
  return ziv(ctx, &(call){.f = ATAN, .n = r.num, .d = rest, .root_d = 1}, negative);
}

static qn_num arc_cosine(qn_ctx *ctx, qn_num a) {
  qn_num size = qn_num_abs(ctx, a);
  int negative = qn_num_sign(a) < 0;
  if (qn_num_is_zero(a)) {
    return qn_num_from_int(ctx, 90);
  }
  if (is(ctx, size, 1, 1) || is(ctx, size, 1, 2)) {
    return qn_num_from_int(ctx, is(ctx, size, 1, 1) ? (negative ? 180 : 0) : (negative ? 120 : 60));
  }
  qn_rat r = qn_num_rat(ctx, size); /* tan = sqrt(den^2 - num^2) / num */
  qn_int rest = qn_int_sub(ctx, qn_int_mul(ctx, r.den, r.den), qn_int_mul(ctx, r.num, r.num));
  return ziv(ctx, &(call){.f = negative ? ATAN_PLUS : ATAN, .n = rest, .d = r.num, .root_n = 1}, 0);
}

static qn_num arc_tangent(qn_ctx *ctx, qn_num y, qn_num x) {
  int sy = qn_num_sign(y), sx = qn_num_sign(x);
  if (sy == 0) {
    return qn_num_from_int(ctx, sx < 0 ? 180 : 0);
  }
  if (sx == 0) {
    return qn_num_from_int(ctx, sy * 90);
  }
  if (qn_num_cmp(ctx, qn_num_abs(ctx, y), qn_num_abs(ctx, x)) == 0) {
    return qn_num_from_int(ctx, sy * (sx < 0 ? 135 : 45));
  }
  qn_rat p = qn_num_rat(ctx, y), q = qn_num_rat(ctx, x);
  qn_int n = qn_int_abs(qn_int_mul(ctx, p.num, q.den)), d = qn_int_abs(qn_int_mul(ctx, q.num, p.den));
  return ziv(ctx, &(call){.f = sx < 0 ? ATAN_PLUS : ATAN, .n = n, .d = d}, sy < 0);
}

static qn_num exponential(qn_ctx *ctx, qn_num a) {
  if (qn_num_is_zero(a)) {
    return QN_NUM_ONE;
  }
  qn_rat r = qn_num_rat(ctx, a);
  return ziv(ctx, &(call){.f = EXP, .n = r.num, .d = r.den}, 0);
}

static qn_num natural_logarithm(qn_ctx *ctx, qn_num a) {
  if (qn_num_sign(a) <= 0 || is(ctx, a, 1, 1)) {
    return QN_NUM_ZERO;
  }
  qn_rat r = qn_num_rat(ctx, a);
  return ziv(ctx, &(call){.f = LN, .n = r.num, .d = r.den}, 0);
}

/* sqrt(num/den), num >= 0, den > 0; rounded when it is irrational or asked to be. */
static qn_num square_root(qn_ctx *ctx, qn_rat r, int rounded, int negative) {
  qn_int g = qn_int_gcd(ctx, r.num, r.den);
  int exact_n, exact_d;
  r = (qn_rat){qn_int_divexact(ctx, r.num, g), qn_int_divexact(ctx, r.den, g)};
  qn_int n = qn_int_sqrt(ctx, r.num, &exact_n), d = qn_int_sqrt(ctx, r.den, &exact_d);
  if (ctx->failed != QUOIN_OK || n.n == 0) {
    return QN_NUM_ZERO;
  }
  if (exact_n && exact_d) {
    return qn_num_from_rat(ctx, negative ? qn_int_neg(n) : n, d, rounded);
  }
  return ziv(ctx, &(call){.f = ROOT, .n = r.num, .d = r.den}, negative);
}

static qn_num sine_over_root(qn_ctx *ctx, qn_num degrees, qn_num n) {
  qn_rat a = qn_num_rat(ctx, snapped(ctx, degrees)), b = qn_num_rat(ctx, n);
  int negative;
  qn_int t = first_quadrant(ctx, a, 0, &negative), right = of_den(ctx, a.den, 90);
  if (ctx->failed != QUOIN_OK || t.n == 0) {
    return QN_NUM_ZERO;
  }
  /* sin^2 is rational at 30, 45, 60 and 90 degrees only: 1/4, 2/4, 3/4, 4/4. Elsewhere sin / sqrt(n) is irrational. */
  static const int angle[4] = {30, 45, 60, 90};
  for (int i = 0; i < 4; i++) {
    if (qn_int_equal(t, of_den(ctx, a.den, angle[i]))) {
      qn_rat square = {of_den(ctx, b.den, i + 1), of_den(ctx, b.num, 4)};
      return square_root(ctx, square, qn_num_is_rounded(n), negative);
    }
  }
  int beyond = qn_int_cmp(qn_int_shl(ctx, t, 1), right) > 0;
  qn_int angle_n = beyond ? qn_int_sub(ctx, right, t) : t;
  return ziv(ctx, &(call){.f = beyond ? COS_ROOT : SIN_ROOT, .n = angle_n, .d = a.den, .m = b.num, .e = b.den}, negative);
}

/* The q-th root of v > 0 where it is an integer; 0 otherwise. */
static int exact_root(qn_ctx *ctx, qn_int v, qn_int q, qn_int *out) {
  if (v.n == 1 && v.d[0] == 1) {
    *out = v;
    return 1;
  }
  if (q.n != 1 || q.d[0] >= qn_int_bits(v)) { /* 2^q > v > 1 */
    return 0;
  }
  mpz_t z, r;
  mpz_init(r);
  /* cppcheck-suppress uninitvar ; view fills it */
  int exact = mpz_root(r, view(z, v), q.d[0]) != 0;
  *out = exact ? qn_int_from_limbs(ctx, mpz_limbs_read(r), (mp_size_t)mpz_size(r), 0) : QN_INT_ZERO_;
  mpz_clear(r);
  return exact;
}

/* (num/den)^e for an integer e, num/den != 0. */
static qn_num integer_power(qn_ctx *ctx, qn_rat x, int64_t e, int rounded) {
  uint64_t size = qn_magnitude_(e);
  int negative = x.num.n < 0 && (e & 1);
  qn_int n = qn_int_abs(x.num), d = x.den;
  if (qn_int_bits(n) == 1 && qn_int_bits(d) == 1) {
    size = 1;
  }
  if (size > UINT32_MAX) {
    qn_ctx_fail_(ctx, QUOIN_E_LIMIT);
    return QN_NUM_ZERO;
  }
  /* A high power of a rounded M 2^k is not worth its length; M odd has so many bits then that it lies on no tie. */
  enum { EXACT_POWER = 64 };
  size_t bits = qn_int_bits(n) - qn_int_trailing_zeros(n);
  if (rounded && size > EXACT_POWER && bits > 1 && (QN_S2_PRECISION + 1) / (bits - 1) < size) {
    return ziv(ctx, &(call){.f = POW, .n = n, .d = d, .m = qn_int_from(ctx, e), .e = QN_INT_ONE_}, negative);
  }
  qn_mark mark = qn_arena_mark(&ctx->arena);
  n = qn_int_pow(ctx, n, (unsigned)size);
  d = qn_int_pow(ctx, d, (unsigned)size);
  qn_int top = e < 0 ? d : n;
  return qn_num_settle_(ctx, mark, negative ? qn_int_neg(top) : top, e < 0 ? n : d, rounded);
}

static int power(qn_ctx *ctx, qn_num a, qn_num b, qn_num *out) {
  int sa = qn_num_sign(a), sb = qn_num_sign(b), rounded = qn_num_is_rounded(a) || qn_num_is_rounded(b);
  int64_t e;
  *out = sb == 0 ? QN_NUM_ONE : QN_NUM_ZERO;
  if (sb == 0 || sa == 0) {
    return sb >= 0;
  }
  if (qn_num_equal(a, QN_NUM_ONE)) {
    *out = a;
    return 1;
  }
  if (qn_num_is_integer(b, &e)) {
    *out = integer_power(ctx, qn_num_rat(ctx, a), e, qn_num_is_rounded(a));
    return 1;
  }
  qn_rat x = qn_num_rat(ctx, a), y = qn_num_rat(ctx, b);
  if (ctx->failed != QUOIN_OK) { /* then they are no numbers */
    return 1;
  }
  if (qn_int_bits(y.den) == 1) { /* an integer beyond 64 bits */
    int even = (y.num.d[0] & 1) == 0, unit = qn_int_bits(x.num) == 1 && qn_int_bits(x.den) == 1;
    if (!unit) {
      qn_ctx_fail_(ctx, QUOIN_E_LIMIT);
    } else {
      *out = qn_num_from_int(ctx, even ? 1 : sa);
    }
    return 1;
  }
  if (sa < 0) {
    return 0;
  }
  qn_int n, d;
  if (exact_root(ctx, x.num, y.den, &n) && exact_root(ctx, x.den, y.den, &d)) {
    qn_rat root = {n, d};
    if (qn_int_fits(y.num, &e)) {
      *out = integer_power(ctx, root, e, rounded);
    } else if (qn_int_bits(n) == 1 && qn_int_bits(d) == 1) {
      *out = qn_num_from_rat(ctx, n, d, rounded);
    } else {
      qn_ctx_fail_(ctx, QUOIN_E_LIMIT);
    }
    return 1;
  }
  *out = ziv(ctx, &(call){.f = POW, .n = x.num, .d = x.den, .m = y.num, .e = y.den}, 0);
  return 1;
}

/* The public names: each gives back what it took from the arena, but its result. */
#define KEPT(ctx, expression) \
  qn_mark mark = qn_arena_mark(&(ctx)->arena); \
  return qn_num_keep_((ctx), mark, (expression))

qn_num qn_num_sqrt(qn_ctx *ctx, qn_num a) {
  KEPT(ctx, qn_num_sign(a) <= 0 ? QN_NUM_ZERO : square_root(ctx, qn_num_rat(ctx, a), qn_num_is_rounded(a), 0));
}
qn_num qn_num_sin(qn_ctx *ctx, qn_num a) {
  KEPT(ctx, sine(ctx, a, 0));
}
qn_num qn_num_cos(qn_ctx *ctx, qn_num a) {
  KEPT(ctx, sine(ctx, a, 90));
}
int qn_num_tan(qn_ctx *ctx, qn_num a, qn_num *out) {
  qn_mark mark = qn_arena_mark(&ctx->arena);
  int defined = tangent(ctx, a, out);
  *out = qn_num_keep_(ctx, mark, *out);
  return defined;
}
qn_num qn_num_asin(qn_ctx *ctx, qn_num a) {
  KEPT(ctx, arc_sine(ctx, a));
}
qn_num qn_num_acos(qn_ctx *ctx, qn_num a) {
  KEPT(ctx, arc_cosine(ctx, a));
}
qn_num qn_num_atan(qn_ctx *ctx, qn_num a) {
  KEPT(ctx, arc_tangent(ctx, a, QN_NUM_ONE));
}
qn_num qn_num_atan2(qn_ctx *ctx, qn_num y, qn_num x) {
  KEPT(ctx, arc_tangent(ctx, y, x));
}
qn_num qn_num_exp(qn_ctx *ctx, qn_num a) {
  KEPT(ctx, exponential(ctx, a));
}
qn_num qn_num_ln(qn_ctx *ctx, qn_num a) {
  KEPT(ctx, natural_logarithm(ctx, a));
}
qn_num qn_num_sin_over_sqrt(qn_ctx *ctx, qn_num degrees, qn_num n) {
  KEPT(ctx, sine_over_root(ctx, degrees, n));
}
int qn_num_pow(qn_ctx *ctx, qn_num a, qn_num b, qn_num *out) {
  qn_mark mark = qn_arena_mark(&ctx->arena);
  int defined = power(ctx, a, b, out);
  *out = qn_num_keep_(ctx, mark, *out);
  return defined;
}
qn_num qn_num_pi(qn_ctx *ctx) {
  mpfr_t y;
  give_back_at_end();
  mpfr_init2(y, QN_S2_PRECISION);
  mpfr_const_pi(y, MPFR_RNDN);
  qn_num r = number_of(ctx, y, 0);
  mpfr_clear(y);
  return r;
}
