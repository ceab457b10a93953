/* Roots of quadratics: their order and the double nearest to each, against MPFR at a precision that exceeds the separation of
   distinct roots of such coefficients many times over. */
#include "number/quad.h"
#include "share.h"

#include <float.h>
#include <math.h>
#include <mpfr.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { ORACLE_BITS = 3000, TIE_BITS = 1200 };

static qn_mem mem;
static qn_ctx ctx;

static int setup(void **state) {
  (void)state;
  qn_mem_init(&mem, NULL);
  qn_ctx_init(&ctx, &mem);
  return 0;
}
static int teardown(void **state) {
  (void)state;
  qn_ctx_free(&ctx);
  return 0;
}

static uint64_t seed = 88172645463325252u;
static uint64_t next(void) {
  seed ^= seed << 13;
  seed ^= seed >> 7;
  seed ^= seed << 17;
  return seed;
}
static int64_t pick(int64_t n) { return (int64_t)(next() % (uint64_t)(2 * n + 1)) - n; } /* -n .. n */

static void to_mpfr(mpfr_t out, qn_int v) {
  char *text = qn_int_text(&ctx, v);
  assert_non_null(text);
  mpfr_set_str(out, text, 10, MPFR_RNDN);
}

/* The root by the textbook formula at ORACLE_BITS. */
static void oracle(mpfr_t out, qn_root x) {
  mpfr_t a, h, c, d;
  mpfr_inits2(ORACLE_BITS, a, h, c, d, (mpfr_ptr)0);
  to_mpfr(a, x.q->a.v);
  to_mpfr(h, x.q->h.v);
  to_mpfr(c, x.q->c.v);
  if (mpfr_zero_p(a)) {
    mpfr_div(out, c, h, MPFR_RNDN);
    mpfr_div_si(out, out, -2, MPFR_RNDN);
  } else {
    mpfr_mul(d, h, h, MPFR_RNDN); /* exact: coefficients are much shorter than the precision */
    mpfr_mul(out, a, c, MPFR_RNDN);
    mpfr_sub(d, d, out, MPFR_RNDN);
    mpfr_sqrt(d, d, MPFR_RNDN);
    if ((x.which == 1) != (mpfr_sgn(a) < 0)) {
      mpfr_sub(out, d, h, MPFR_RNDN);
    } else {
      mpfr_add(out, d, h, MPFR_RNDN);
      mpfr_neg(out, out, MPFR_RNDN);
    }
    mpfr_div(out, out, a, MPFR_RNDN);
  }
  mpfr_clears(a, h, c, d, (mpfr_ptr)0);
}

static int oracle_order(qn_root x, qn_root y) {
  mpfr_t r, s;
  mpfr_inits2(ORACLE_BITS, r, s, (mpfr_ptr)0);
  oracle(r, x);
  oracle(s, y);
  mpfr_sub(r, r, s, MPFR_RNDN);
  int order = mpfr_zero_p(r) || mpfr_get_exp(r) < -TIE_BITS ? 0 : mpfr_sgn(r);
  mpfr_clears(r, s, (mpfr_ptr)0);
  return order;
}

static qn_quad make(int64_t a, int64_t h, int64_t c) {
  qn_quad q;
  qn_quad_make(&ctx, qn_x(qn_int_from(&ctx, a)), qn_x(qn_int_from(&ctx, h)), qn_x(qn_int_from(&ctx, c)), &q);
  return q;
}
static qn_quad times(qn_quad q, int64_t k) {
  qn_quad p;
  qn_quad_make(&ctx, qn_x_scale(&ctx, q.a, k), qn_x_scale(&ctx, q.h, k), qn_x_scale(&ctx, q.c, k), &p);
  return p;
}

static int roots_of(const qn_quad *q) {
  switch (qn_quad_kind(q)) {
  case QN_QUAD_ZERO:
  case QN_QUAD_CONSTANT:
  case QN_QUAD_NONE: return 0;
  case QN_QUAD_LINEAR:
  case QN_QUAD_DOUBLE: return 1;
  case QN_QUAD_TWO: return 2;
  }
  return 0;
}

typedef struct census { unsigned ties, less, more, linear, dbl, two, negative, proportional; } census;

static void judge(const qn_quad *p, const qn_quad *q, census *c) {
  int m = roots_of(p), n = roots_of(q);
  c->linear += qn_quad_kind(p) == QN_QUAD_LINEAR;
  c->dbl += qn_quad_kind(p) == QN_QUAD_DOUBLE;
  c->two += m == 2;
  c->negative += p->sign_a < 0;
  for (int i = 0; i < m; i++) {
    for (int j = 0; j < n; j++) {
      qn_root x = {p, i}, y = {q, j};
      int got = qn_root_cmp(&ctx, x, y), want = oracle_order(x, y);
      assert_int_equal(got, want);
      assert_int_equal(qn_root_cmp(&ctx, y, x), -want);
      c->ties += want == 0;
      c->less += want < 0;
      c->more += want > 0;
      qn_int num, den;
      if (want < 0) {
        qn_root_between(&ctx, x, y, &num, &den);
        assert_true(qn_root_cmp_rat(&ctx, x, num, den) < 0 && qn_root_cmp_rat(&ctx, y, num, den) > 0);
      }
      if (want == 0 && qn_root_rational(&ctx, x, &num, &den)) {
        assert_int_equal(qn_root_cmp_rat(&ctx, y, num, den), 0);
        assert_int_equal(qn_quad_sign_at(&ctx, q, num, den), 0);
      }
    }
  }
}

static void clear(void) {
  qn_ctx_free(&ctx);
  qn_ctx_init(&ctx, &mem);
}

/* Every pair of quadratics with coefficients in -3..3, and larger random ones of every kind. */
static void test_order(void **state) {
  (void)state;
  census c = {0};
  enum { SIDE = 2, COUNT = (2 * SIDE + 1) * (2 * SIDE + 1) * (2 * SIDE + 1) };
  for (int i = 0; i < COUNT; i++) {
    for (int j = 0; j < COUNT; j += 1 + (int)(next() % 3)) {
      qn_quad p = make(i / 25 - SIDE, i / 5 % 5 - SIDE, i % 5 - SIDE), q = make(j / 25 - SIDE, j / 5 % 5 - SIDE, j % 5 - SIDE);
      judge(&p, &q, &c);
    }
    clear();
  }
  for (int i = 0; i < share_of(6000); i++) {
    int64_t size = (int64_t)1 << (1 + next() % 40);
    qn_quad p, q;
    switch (next() % 5) {
    case 0: /* unrelated */
      p = make(pick(size), pick(size), pick(size));
      q = make(pick(size), pick(size), pick(size));
      break;
    case 1: { /* a common rational root r/s: (s t - r)(u t - v), doubled so that h is an integer */
      int64_t n = (int64_t)1 << (1 + next() % 14), r = pick(n), s = pick(n), u = pick(n), v = pick(n), w = pick(n), z = pick(n);
      p = make(2 * s * u, -(s * v + r * u), 2 * r * v);
      q = make(2 * s * w, -(s * z + r * w), 2 * r * z);
      break;
    }
    case 2: { /* proportional, either sign */
      p = make(pick(size), pick(size), pick(size));
      int64_t k = pick(9);
      q = times(p, k ? k : -1);
      c.proportional++;
      break;
    }
    case 3: /* one coefficient differs by one */
      p = make(pick(size), pick(size), pick(size));
      q = p;
      qn_quad_make(&ctx, p.a, p.h, qn_x_add(&ctx, p.c, qn_x(qn_int_from(&ctx, 1))), &q);
      break;
    default: { /* a double root r/s and a neighbour */
      int64_t n = (int64_t)1 << (1 + next() % 20), r = pick(n), s = pick(n), k = (next() & 1) ? 1 : -1;
      p = make(k * s * s, -k * r * s, k * r * r);
      q = make(s * s, -r * s, r * r - 1);
      break;
    }
    }
    judge(&p, &q, &c);
    if (i % 50 == 0) {
      clear();
    }
  }
  assert_true(c.ties > share_min(2000) && c.less > share_min(5000) && c.more > share_min(5000) && c.linear > share_min(500) && c.dbl > share_min(500) && c.two > share_min(5000) && c.negative > share_min(3000) && c.proportional > share_min(500));
}

static void test_kinds(void **state) {
  (void)state;
  qn_quad q = make(0, 0, 0);
  assert_int_equal(qn_quad_kind(&q), QN_QUAD_ZERO);
  q = make(0, 0, -4);
  assert_int_equal(qn_quad_kind(&q), QN_QUAD_CONSTANT);
  q = make(0, -2, 4); /* -4 t + 4 */
  assert_int_equal(qn_quad_kind(&q), QN_QUAD_LINEAR);
  assert_true(qn_root_to_double(&ctx, (qn_root){&q, 0}) == 1.0);
  q = make(1, 1, 2);
  assert_int_equal(qn_quad_kind(&q), QN_QUAD_NONE);
  q = make(-4, 6, -9);
  assert_int_equal(qn_quad_kind(&q), QN_QUAD_DOUBLE);
  assert_true(qn_root_to_double(&ctx, (qn_root){&q, 0}) == 1.5);
  q = make(1, 0, -2);
  assert_int_equal(qn_quad_kind(&q), QN_QUAD_TWO);
  qn_int num, den;
  assert_false(qn_root_rational(&ctx, (qn_root){&q, 0}, &num, &den));
  qn_root_below(&ctx, (qn_root){&q, 0}, &num, &den);
  assert_true(qn_root_cmp_rat(&ctx, (qn_root){&q, 0}, num, den) > 0);
  qn_root_above(&ctx, (qn_root){&q, 1}, &num, &den);
  assert_true(qn_root_cmp_rat(&ctx, (qn_root){&q, 1}, num, den) < 0);
  q = make(-1, -1, 3); /* roots -3 and 1 */
  assert_true(qn_root_rational(&ctx, (qn_root){&q, 0}, &num, &den));
  assert_true(qn_int_equal(num, qn_int_from(&ctx, -3)) && qn_int_equal(den, qn_int_from(&ctx, 1)));
  assert_true(qn_root_rational(&ctx, (qn_root){&q, 1}, &num, &den));
  assert_true(qn_int_equal(num, qn_int_from(&ctx, 1)));
}

static qn_int random_int(size_t bits) {
  mp_limb_t limbs[16];
  size_t n = (bits + 63) / 64;
  for (size_t i = 0; i < n; i++) {
    limbs[i] = next();
  }
  if (bits % 64) {
    limbs[n - 1] &= ((mp_limb_t)1 << (bits % 64)) - 1;
  }
  return qn_int_from_limbs(&ctx, limbs, (mp_size_t)n, (int)(next() & 1));
}

static void check_rounding(const qn_quad *q, unsigned *seen) {
  for (int i = 0; i < roots_of(q); i++) {
    mpfr_t r;
    mpfr_init2(r, ORACLE_BITS);
    oracle(r, (qn_root){q, i});
    double want = mpfr_get_d(r, MPFR_RNDN), got = qn_root_to_double(&ctx, (qn_root){q, i});
    mpfr_clear(r);
    if (want == 0) {
      assert_true(got == 0 && !signbit(got));
    } else {
      assert_true(memcmp(&want, &got, sizeof want) == 0);
    }
    ++*seen;
  }
}

static void test_to_double(void **state) {
  (void)state;
  unsigned seen = 0;
  for (int i = 0; i < share_of(20000); i++) {
    qn_quad q;
    qn_int a = random_int(next() % 300), h = random_int(next() % 300), c = random_int(next() % 400);
    if (next() % 8 == 0) {
      a = qn_int_from(&ctx, 0);
    }
    if (next() % 8 == 0) {
      c = qn_int_from(&ctx, 0);
    }
    if (next() % 8 == 0) {
      h = qn_int_from(&ctx, 0);
    }
    qn_quad_make(&ctx, qn_x(a), qn_x(h), qn_x(c), &q);
    check_rounding(&q, &seen);
    if (i % 50 == 0) {
      clear();
    }
  }
  assert_true(seen > share_min(15000));
}

/* (D t - m)(t - k) with m/D in the middle between two doubles, and off it by 2^-300: ties go to even, the rest to their side. */
static void test_to_double_middles(void **state) {
  (void)state;
  unsigned seen = 0;
  for (int i = 0; i < share_of(4000); i++) {
    int64_t m = (int64_t)(((uint64_t)1 << 53) + (next() >> 12 << 1) + 1); /* 54 bits, odd: a middle */
    if (next() & 1) {
      m = -m;
    }
    size_t shift = next() % 4 ? next() % 90 : 1000 + next() % 100;
    qn_int d = qn_int_shl(&ctx, qn_int_from(&ctx, 1), shift), num = qn_int_from(&ctx, m);
    int off = (int)(next() % 3) - 1; /* below, at, above */
    if (off) {
      num = qn_int_add(&ctx, qn_int_shl(&ctx, num, 300), qn_int_from(&ctx, off));
      d = qn_int_shl(&ctx, d, 300);
    }
    qn_int k = qn_int_from(&ctx, pick(1000));
    qn_int two_h = qn_int_neg(qn_int_add(&ctx, qn_int_mul(&ctx, d, k), num));
    qn_quad q;
    qn_quad_make(&ctx, qn_x(qn_int_shl(&ctx, d, 1)), qn_x(two_h), qn_x(qn_int_shl(&ctx, qn_int_mul(&ctx, num, k), 1)), &q);
    check_rounding(&q, &seen);
    /* sqrt(m^2 + off 2^-j): irrational roots within 2^-100 of a middle */
    qn_int mm = qn_int_shl(&ctx, qn_int_mul(&ctx, qn_int_from(&ctx, m), qn_int_from(&ctx, m)), 120);
    mm = qn_int_add(&ctx, mm, qn_int_from(&ctx, off));
    qn_quad_make(&ctx, qn_x(qn_int_shl(&ctx, qn_int_from(&ctx, 1), 120)), qn_x(qn_int_from(&ctx, 0)), qn_x(qn_int_neg(mm)), &q);
    check_rounding(&q, &seen);
    if (i % 50 == 0) {
      clear();
    }
  }
  assert_true(seen > share_min(12000));
}

/* Overflow, subnormals, and the least half. */
static void test_to_double_range(void **state) {
  (void)state;
  unsigned seen = 0;
  for (int i = 0; i < share_of(4000); i++) {
    qn_int n = qn_int_from(&ctx, pick((int64_t)1 << (next() % 60))), one = qn_int_from(&ctx, (int64_t)(1 + next() % 7));
    size_t shift = next() & 1 ? 940 + next() % 90 : 1040 + next() % 100;
    qn_quad q;
    if (next() & 1) {
      qn_quad_make(&ctx, qn_x(qn_int_from(&ctx, 0)), qn_x(qn_int_shl(&ctx, one, shift)), qn_x(n), &q);
    } else {
      qn_quad_make(&ctx, qn_x(qn_int_from(&ctx, 0)), qn_x(one), qn_x(qn_int_shl(&ctx, n, shift)), &q);
    }
    check_rounding(&q, &seen);
    qn_quad_make(&ctx, qn_x(qn_int_shl(&ctx, one, shift)), qn_x(n), qn_x(qn_int_neg(one)), &q);
    check_rounding(&q, &seen);
    qn_quad_make(&ctx, qn_x(one), qn_x(n), qn_x(qn_int_neg(qn_int_shl(&ctx, one, 2 * shift))), &q);
    check_rounding(&q, &seen);
    if (i % 50 == 0) {
      clear();
    }
  }
  assert_true(seen > share_min(10000));
}

/* S2: the same plane through two roundings ties; a gap of 2^-150 does not. */
static void test_rounded(void **state) {
  (void)state;
  mpfr_t s;
  mpfr_init2(s, 256);
  mpfr_sqrt_ui(s, 2, MPFR_RNDN);
  mpfr_mul_2ui(s, s, 255, MPFR_RNDN);
  char digits[128];
  mpfr_snprintf(digits, sizeof digits, "%.0Rf", s);
  mpfr_clear(s);
  qn_int root2 = qn_int_from_digits(&ctx, digits, strlen(digits));
  qn_xint one = qn_x(qn_int_from(&ctx, 1)), zero = qn_x(qn_int_from(&ctx, 0));
  qn_quad p, q, r, e;
  /* 2^256 t - 2 root2: t = sqrt 2; the same with its last bits wrong; the same moved by 2^-150; and t^2 = 2 exactly */
  qn_quad_make(&ctx, zero, qn_x_shl(&ctx, one, 255), qn_x_rounded(qn_int_neg(qn_int_shl(&ctx, root2, 1))), &p);
  qn_quad_make(&ctx, zero, qn_x_shl(&ctx, one, 255), qn_x_rounded(qn_int_neg(qn_int_shl(&ctx, qn_int_add(&ctx, root2, qn_int_from(&ctx, 1000003)), 1))), &q);
  qn_int moved = qn_int_add(&ctx, root2, qn_int_shl(&ctx, qn_int_from(&ctx, 1), 255 - 150));
  qn_quad_make(&ctx, zero, qn_x_shl(&ctx, one, 255), qn_x_rounded(qn_int_neg(qn_int_shl(&ctx, moved, 1))), &r);
  qn_quad_make(&ctx, one, zero, qn_x(qn_int_from(&ctx, -2)), &e);
  assert_int_equal(qn_root_cmp(&ctx, (qn_root){&p, 0}, (qn_root){&q, 0}), 0);
  assert_int_equal(qn_root_cmp(&ctx, (qn_root){&p, 0}, (qn_root){&r, 0}), -1);
  assert_int_equal(qn_root_cmp(&ctx, (qn_root){&r, 0}, (qn_root){&q, 0}), 1);
  assert_int_equal(qn_root_cmp(&ctx, (qn_root){&p, 0}, (qn_root){&e, 1}), 0);
  assert_int_equal(qn_root_cmp(&ctx, (qn_root){&r, 0}, (qn_root){&e, 1}), 1);
  /* what ties is in the order of the stored forms: p, the exact root on its own side of p, and q */
  const int side = qn_int_cmp(qn_int_mul(&ctx, root2, root2), qn_int_shl(&ctx, qn_int_from(&ctx, 1), 511));
  assert_true(side != 0);
  assert_int_equal(qn_root_cmp_stored(&ctx, (qn_root){&p, 0}, (qn_root){&q, 0}), -1);
  assert_int_equal(qn_root_cmp_stored(&ctx, (qn_root){&q, 0}, (qn_root){&p, 0}), 1);
  assert_int_equal(qn_root_cmp_stored(&ctx, (qn_root){&p, 0}, (qn_root){&e, 1}), side);
  assert_int_equal(qn_root_cmp_stored(&ctx, (qn_root){&e, 1}, (qn_root){&q, 0}), -1);
  assert_int_equal(qn_root_cmp_stored(&ctx, (qn_root){&e, 0}, (qn_root){&e, 1}), -1);
  assert_true(qn_root_rounded((qn_root){&p, 0}) && !qn_root_rounded((qn_root){&e, 0}));
  assert_int_equal(qn_root_cmp(&ctx, (qn_root){&p, 0}, (qn_root){&e, 0}), 1);
  /* t^2 - 2 sqrt2 t + 2 with a rounded sqrt 2: a double root */
  qn_xint a = qn_x_shl(&ctx, one, 255), h = qn_x_rounded(qn_int_neg(root2)), c = qn_x_shl(&ctx, one, 256);
  qn_quad d;
  qn_quad_make(&ctx, a, h, c, &d);
  assert_int_equal(qn_quad_kind(&d), QN_QUAD_DOUBLE);
  assert_true(qn_root_to_double(&ctx, (qn_root){&d, 0}) == sqrt(2.0));
  assert_int_equal(qn_root_cmp(&ctx, (qn_root){&d, 0}, (qn_root){&e, 1}), 0);
  qn_int num, den;
  qn_root_between(&ctx, (qn_root){&p, 0}, (qn_root){&r, 0}, &num, &den);
  assert_true(qn_int_bits(den) > 140);
}

/* A rounded quadratic with roots 2^60 +- r: its coefficients are huge beside the roots' distance, and still only roots that
   agree to about 2^-200 tie. error: added to c, whose terms have 400 bits. */
static qn_quad far_ball(int64_t quarter_r, int64_t error) {
  qn_quad q;
  qn_int one = qn_int_from(&ctx, 1);
  qn_int c = qn_int_sub(&ctx, qn_int_shl(&ctx, one, 120 + 280), qn_int_shl(&ctx, qn_int_from(&ctx, quarter_r * quarter_r), 280 - 4));
  c = qn_int_add(&ctx, c, qn_int_from(&ctx, error));
  qn_quad_make(&ctx, qn_x_rounded(qn_int_shl(&ctx, one, 280)), qn_x_rounded(qn_int_neg(qn_int_shl(&ctx, one, 60 + 280))), qn_x_rounded(c), &q);
  return q;
}

static void test_rounded_far(void **state) {
  (void)state;
  qn_quad big = far_ball(4, 0), small = far_ball(2, 0), again = far_ball(4, 12345);
  assert_int_equal(qn_quad_kind(&big), QN_QUAD_TWO);
  static const int8_t order[4][4] = {{0, -1, -1, -1}, {1, 0, -1, -1}, {1, 1, 0, -1}, {1, 1, 1, 0}}; /* -1, -1/2, 1/2, 1 */
  const qn_root roots[4] = {{&big, 0}, {&small, 0}, {&small, 1}, {&again, 1}};
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      assert_int_equal(qn_root_cmp(&ctx, roots[i], roots[j]), order[i][j]);
    }
  }
  for (int i = 0; i < 2; i++) {
    assert_int_equal(qn_root_cmp(&ctx, (qn_root){&big, i}, (qn_root){&again, i}), 0);
    qn_int place = qn_int_add(&ctx, qn_int_shl(&ctx, qn_int_from(&ctx, 1), 60), qn_int_from(&ctx, 2 * i - 1)), one = qn_int_from(&ctx, 1);
    assert_int_equal(qn_root_cmp_rat(&ctx, (qn_root){&again, i}, place, one), 0);
    qn_int den = qn_int_shl(&ctx, one, 60), num = qn_int_add(&ctx, qn_int_shl(&ctx, place, 60), one); /* 2^-60 beside it */
    assert_int_equal(qn_root_cmp_rat(&ctx, (qn_root){&again, i}, num, den), -1);
  }
}

/* A rounded root at the middle between two doubles, stored a little beside it: it is the middle, and goes to the even one. */
static void test_rounded_middles(void **state) {
  (void)state;
  qn_int one = qn_int_from(&ctx, 1);
  for (int kind = 0; kind < 2; kind++) { /* linear; a double root */
    for (int odd = 0; odd < 2; odd++) {
      for (int beside = -1; beside <= 1; beside++) {
        for (int sign = -1; sign <= 1; sign += 2) {
          /* ((2^53 + odd) + 1/2 + beside 2^-230), over 2^-230 */
          qn_int n = qn_int_shl(&ctx, qn_int_from(&ctx, (((int64_t)1 << 53) + 2 * odd) + 1), 230);
          n = qn_int_add(&ctx, n, qn_int_from(&ctx, beside));
          n = sign < 0 ? qn_int_neg(n) : n;
          qn_xint a = qn_x_shl(&ctx, qn_x(one), 230), root = qn_x_rounded(n), zero = qn_x(qn_int_from(&ctx, 0));
          qn_quad q;
          if (kind == 0) {
            qn_quad_make(&ctx, zero, a, qn_x_neg(qn_x_shl(&ctx, root, 1)), &q);
          } else {
            qn_quad_make(&ctx, qn_x_mul(&ctx, a, a), qn_x_neg(qn_x_mul(&ctx, a, root)), qn_x_mul(&ctx, root, root), &q);
          }
          double want = sign * (0x1p53 + (odd ? 4 : 0)); /* 2^53 + 1 and 2^53 + 3 are middles of neighbours 2 apart */
          assert_true(qn_root_to_double(&ctx, (qn_root){&q, 0}) == want);
        }
      }
    }
  }
  qn_quad q; /* what is zero beside its terms is zero */
  qn_xint tiny = qn_x_sub(&ctx, qn_x_rounded(qn_int_add(&ctx, qn_int_shl(&ctx, one, 255), one)), qn_x_rounded(qn_int_shl(&ctx, one, 255)));
  qn_quad_make(&ctx, qn_x(qn_int_from(&ctx, 0)), qn_x(one), tiny, &q);
  assert_true(qn_root_to_double(&ctx, (qn_root){&q, 0}) == 0);
}

static qn_quad line_of(qn_int num, qn_int den) { /* den t - num, twice */
  qn_quad q;
  qn_quad_make(&ctx, qn_x(qn_int_from(&ctx, 0)), qn_x(den), qn_x(qn_int_neg(qn_int_shl(&ctx, num, 1))), &q);
  return q;
}

/* Rounded roots -5 and 3 times 2^-n: what ties with them is 2^-200 of themselves away, not of 1. */
static void test_rounded_tiny(void **state) {
  (void)state;
  static const size_t scales[] = {0, 40, 64, 100, 400, 1000, 10000};
  const qn_int one = qn_int_from(&ctx, 1), zero = qn_int_from(&ctx, 0);
  for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
    const size_t n = scales[i];
    qn_quad q;
    qn_quad_make(&ctx, qn_x_rounded(qn_int_shl(&ctx, one, 280 + 2 * n)), qn_x_rounded(qn_int_shl(&ctx, one, 280 + n)), qn_x_rounded(qn_int_shl(&ctx, qn_int_from(&ctx, -15), 280)), &q);
    assert_int_equal(qn_quad_kind(&q), QN_QUAD_TWO);
    static const struct { int num, bits, less, more; } places[] = {
      {0, 0, -1, 1}, {1, 0, -1, 1}, {-1, 0, -1, 1}, {3, 0, -1, 0}, {-5, 0, 0, 1}, {4, 0, -1, -1}, {-6, 0, 1, 1},
      {3, 150, -1, -1}, {3, 220, -1, 0}, {-5, 150, -1, 1}, {-5, 220, 0, 1}}; /* bits: 2^-bits of a unit more */
    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
      const size_t bits = (size_t)places[k].bits;
      const qn_int num = qn_int_add(&ctx, qn_int_shl(&ctx, qn_int_from(&ctx, places[k].num), bits), bits ? one : zero), den = qn_int_shl(&ctx, one, n + bits);
      assert_int_equal(qn_root_cmp_rat(&ctx, (qn_root){&q, 0}, num, den), places[k].less);
      assert_int_equal(qn_root_cmp_rat(&ctx, (qn_root){&q, 1}, num, den), places[k].more);
    }
    /* without c: 0, and -2 2^-n */
    qn_quad_make(&ctx, qn_x_rounded(qn_int_shl(&ctx, one, 280 + 2 * n)), qn_x_rounded(qn_int_shl(&ctx, one, 280 + n)), qn_x(zero), &q);
    for (int side = -1; side <= 1; side++) {
      const qn_int num = qn_int_from(&ctx, side), den = qn_int_shl(&ctx, one, n + 1200);
      assert_int_equal(qn_root_cmp_rat(&ctx, (qn_root){&q, 1}, num, den), -side);
      assert_int_equal(qn_root_cmp_rat(&ctx, (qn_root){&q, 0}, num, den), -1);
    }
  }
}

/* What is between two roots lies in the middle half of them, and has no more bits than it takes. */
static void test_between(void **state) {
  (void)state;
  clear();
  for (int n = 0; n < 2000; n++) {
    const size_t gap = 1 + (size_t)(next() % 3000), scale = (size_t)(next() % 5000);
    const int64_t third = n % 4 == 0 ? 0 : pick(1 << 20), wide = 1 + (int64_t)(next() % 1000);
    /* third/3 2^-scale and (third/3 + wide 2^-gap) 2^-scale, over 3 2^(gap + scale) */
    const qn_int den = qn_int_mul(&ctx, qn_int_from(&ctx, 3), qn_int_shl(&ctx, qn_int_from(&ctx, 1), gap + scale));
    const qn_int low = qn_int_shl(&ctx, qn_int_from(&ctx, third), gap), high = qn_int_add(&ctx, low, qn_int_from(&ctx, 3 * wide));
    const qn_quad p = line_of(low, den), q = line_of(high, den);
    qn_int num, two;
    qn_root_between(&ctx, (qn_root){&p, 0}, (qn_root){&q, 0}, &num, &two);
    const qn_int there = qn_int_mul(&ctx, qn_int_shl(&ctx, num, 2), den), quarter = qn_int_from(&ctx, 3 * wide); /* over 4 den two */
    const qn_int least = qn_int_mul(&ctx, qn_int_add(&ctx, qn_int_shl(&ctx, low, 2), quarter), two), most = qn_int_mul(&ctx, qn_int_sub(&ctx, qn_int_shl(&ctx, high, 2), quarter), two);
    assert_true(qn_int_cmp(there, least) > 0 && qn_int_cmp(there, most) < 0);
    assert_true(qn_int_bits(num) <= 12 + (third == 0 ? 0 : gap + 21));
    if (n % 100 == 99) {
      clear();
    }
  }
  /* Roots of two quadratics that agree to 6500 bits: 2^13000 t^2 + 2 h t - 1, h 1 and 2. */
  qn_quad p, q;
  const qn_xint a = qn_x_shl(&ctx, qn_x(qn_int_from(&ctx, 1)), 13000), c = qn_x(qn_int_from(&ctx, -1));
  qn_quad_make(&ctx, a, qn_x(qn_int_from(&ctx, 2)), c, &p);
  qn_quad_make(&ctx, a, qn_x(qn_int_from(&ctx, 1)), c, &q);
  for (int which = 0; which < 2; which++) {
    const qn_root x = {&p, which}, y = {&q, which};
    qn_int num, den;
    qn_root_between(&ctx, x, y, &num, &den);
    assert_true(qn_root_cmp_rat(&ctx, x, num, den) < 0 && qn_root_cmp_rat(&ctx, y, num, den) > 0);
    assert_in_range(qn_int_bits(num), 6000, 6600);
  }
  assert_int_equal(ctx.failed, QUOIN_OK);
  /* Rounded ones may have another order as they are stored. */
  const qn_xint one = qn_x_rounded(qn_int_shl(&ctx, qn_int_from(&ctx, 1), 255)), zero = qn_x(qn_int_from(&ctx, 0));
  qn_quad_make(&ctx, zero, one, qn_x_rounded(qn_int_neg(qn_int_add(&ctx, qn_int_shl(&ctx, qn_int_from(&ctx, 1), 256), qn_int_from(&ctx, 1)))), &p);
  qn_quad_make(&ctx, zero, one, qn_x_rounded(qn_int_neg(qn_int_shl(&ctx, qn_int_from(&ctx, 1), 256))), &q);
  qn_int num, den;
  qn_root_between(&ctx, (qn_root){&p, 0}, (qn_root){&q, 0}, &num, &den);
  assert_int_equal(ctx.failed, QUOIN_E_LIMIT);
  clear();
}

/* A refused allocation is told by the context, and nothing hangs. */
static void test_memory(void **state) {
  (void)state;
  qn_mem small;
  quoin_allocator limits = {NULL, NULL, NULL, NULL, 16384};
  qn_mem_init(&small, &limits);
  qn_ctx c;
  qn_ctx_init(&c, &small);
  qn_int big = qn_int_shl(&c, qn_int_from(&c, 1), 30000);
  qn_quad q, p;
  qn_quad_make(&c, qn_x(qn_int_from(&c, 1)), qn_x(big), qn_x(qn_int_from(&c, 7)), &q);
  qn_quad_make(&c, qn_x(qn_int_from(&c, 1)), qn_x(qn_int_add(&c, big, big)), qn_x(qn_int_from(&c, 5)), &p);
  qn_int num, den;
  (void)qn_root_cmp(&c, (qn_root){&q, 0}, (qn_root){&p, 1});
  (void)qn_root_to_double(&c, (qn_root){&q, 0});
  qn_root_between(&c, (qn_root){&q, 0}, (qn_root){&p, 0}, &num, &den);
  assert_int_equal(c.failed, QUOIN_E_MEMORY);
  qn_ctx_free(&c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_kinds),      cmocka_unit_test(test_order),        cmocka_unit_test(test_to_double), cmocka_unit_test(test_to_double_middles),
    cmocka_unit_test(test_to_double_range), cmocka_unit_test(test_rounded), cmocka_unit_test(test_rounded_far), cmocka_unit_test(test_rounded_tiny),
    cmocka_unit_test(test_rounded_middles), cmocka_unit_test(test_between), cmocka_unit_test(test_memory),
  };
  return cmocka_run_group_tests(tests, setup, teardown);
}
