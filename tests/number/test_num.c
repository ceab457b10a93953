/* Numbers against GMP's rationals: values, canonical forms, roundings of design S2, text there and back. */
#include "base/limits.h"
#include "judge.h"
#include "share.h"

enum { ROUNDS = 20000 };

/* What an operation on rounded numbers must give: q rounded, or 0 when it is nothing beside `larger`. */
static int expected_rounded(qn_num r, mpq_t q, const mpq_t larger) {
  if (mpq_sgn(q) == 0 || (larger && negligible(q, larger))) {
    return qn_num_is_zero(r);
  }
  round_mpq(q);
  return r.kind == QN_NUM_ROUNDED && same_mpq(r, q) && canonical(r);
}

static int expected(qn_num r, mpq_t q, const mpq_t larger, int rounded) {
  return rounded ? expected_rounded(r, q, larger) : r.kind != QN_NUM_ROUNDED && same_mpq(r, q) && canonical(r);
}

static const char *larger_of(const mpq_t x, const mpq_t y, mpq_t out) {
  mpq_t a, b;
  mpq_inits(a, b, NULL);
  mpq_abs(a, x);
  mpq_abs(b, y);
  mpq_set(out, mpq_cmp(a, b) > 0 ? a : b);
  mpq_clears(a, b, NULL);
  return NULL;
}

static void test_operations_agree_with_mpq(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  uint64_t seed = 11;
  mpq_t x, y, z, l;
  mpz_t t;
  mpq_inits(x, y, z, l, NULL);
  mpz_init(t);
  size_t kinds[3] = {0}, results[3] = {0}, cancelled = 0, nothing = 0;
  for (int round = 0; round < share_of(ROUNDS); round++) {
    qn_mark mark = qn_arena_mark(&c->arena);
    qn_num a = random_num(c, &seed, 1), b = random_num(c, &seed, 1);
    if (round % 5 == 0) { /* neighbours: equal, or apart by about 2^-200 */
      qn_int one = qn_int_from(c, 1 - 2 * (int64_t)random_below(&seed, 2));
      size_t down = 190 + random_below(&seed, 20);
      qn_num gap = round % 2 ? qn_num_from_rat(c, one, qn_int_shl(c, qn_int_from(c, 1), down), 0) : QN_NUM_ZERO;
      b = qn_num_add(c, a, qn_num_mul(c, a, gap));
    }
    int rounded = qn_num_is_rounded(a) || qn_num_is_rounded(b);
    to_mpq(x, a);
    to_mpq(y, b);
    kinds[a.kind]++;
    assert_true(canonical(a) && canonical(b));
    assert_int_equal(qn_num_sign(a), mpq_sgn(x));
    assert_int_equal(qn_num_is_zero(a), mpq_sgn(x) == 0);
    assert_int_equal(qn_num_equal(a, b), a.kind == b.kind && mpq_equal(x, y));
    assert_true(qn_num_equal(qn_num_copy(c, a), a));
    qn_rat r = qn_num_rat(c, a);
    assert_true(same_mpz(r.num, mpq_numref(x)) && same_mpz(r.den, mpq_denref(x)));

    int order = mpq_cmp(x, y);
    mpq_sub(z, x, y);
    larger_of(x, y, l);
    int agree = mpq_sgn(z) == 0 || (rounded && negligible(z, l));
    nothing += agree && order != 0;
    assert_int_equal(qn_num_cmp(c, a, b), agree ? 0 : (order > 0) - (order < 0));
    qn_num d = qn_num_sub(c, a, b);
    if (qn_num_is_zero(a) || qn_num_is_zero(b)) { /* nothing to round: the operand itself */
      assert_true(same_mpq(d, z));
    } else {
      assert_true(expected(d, z, l, rounded));
    }
    cancelled += order == 0 && mpq_sgn(x);
    mpq_add(z, x, y);
    qn_num u = qn_num_add(c, a, b);
    if (qn_num_is_zero(a) || qn_num_is_zero(b)) {
      assert_true(same_mpq(u, z));
    } else {
      assert_true(expected(u, z, l, rounded));
    }
    results[u.kind]++;
    mpq_mul(z, x, y);
    assert_true(expected(qn_num_mul(c, a, b), z, NULL, rounded && mpq_sgn(z)));
    mpq_neg(z, x);
    assert_true(same_mpq(qn_num_neg(c, a), z) && canonical(qn_num_neg(c, a)));
    mpq_abs(z, x);
    assert_true(same_mpq(qn_num_abs(c, a), z));
    if (mpq_sgn(y)) {
      mpq_div(z, x, y);
      assert_true(expected(qn_num_div(c, a, b), z, NULL, rounded && mpq_sgn(z)));
      if (!rounded && mpz_sizeinbase(mpq_numref(z), 2) < 3000) {
        mpz_tdiv_q(t, mpq_numref(z), mpq_denref(z));
        mpq_set_z(z, t);
        mpq_mul(z, z, y);
        mpq_sub(z, x, z);
        assert_true(expected(qn_num_mod(c, a, b), z, NULL, 0));
      }
    }
    if (!qn_num_is_rounded(a)) {
      qn_num f = qn_num_floor(c, a), e = qn_num_ceil(c, a), n = qn_num_round(c, a);
      mpz_fdiv_q(mpq_numref(z), mpq_numref(x), mpq_denref(x));
      mpz_set_ui(mpq_denref(z), 1);
      assert_true(expected(f, z, NULL, 0));
      mpz_cdiv_q(mpq_numref(z), mpq_numref(x), mpq_denref(x));
      assert_true(expected(e, z, NULL, 0));
      mpz_mul_ui(t, mpq_numref(x), 2);
      if (mpz_sgn(t) < 0) {
        mpz_sub(t, t, mpq_denref(x));
      } else {
        mpz_add(t, t, mpq_denref(x));
      }
      mpz_mul_ui(mpq_numref(z), mpq_denref(x), 2);
      mpz_tdiv_q(mpq_numref(z), t, mpq_numref(z));
      assert_true(expected(n, z, NULL, 0));
      int64_t v = 0;
      int fits = mpz_cmp_ui(mpq_denref(x), 1) == 0 && mpz_fits_slong_p(mpq_numref(x));
      assert_int_equal(qn_num_is_integer(a, &v), fits);
      assert_true(!fits || v == mpz_get_si(mpq_numref(x)));
    }
    assert_int_equal(c->failed, QUOIN_OK);
    qn_arena_release(&c->arena, mark);
  }
  for (int k = 0; k < 3; k++) {
    assert_true(kinds[k] > share_min(500) && results[k] > share_min(500));
  }
  assert_true(cancelled > share_min(500) && nothing > share_min(50));
  mpq_clears(x, y, z, l, NULL);
  mpz_clear(t);
  setup_free(&s);
}

/* Ties and neighbours of ties at 256 bits, against MPFR. */
static void test_rounding(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  uint64_t seed = 12;
  mpq_t q;
  mpq_init(q);
  for (int round = 0; round < share_of(ROUNDS); round++) {
    qn_mark mark = qn_arena_mark(&c->arena);
    qn_int n = random_int(c, &seed, 7), d = random_int(c, &seed, 7);
    if (round % 2) { /* 257 bits with a last one, and perhaps a little beside it */
      n = qn_int_add(c, qn_int_shl(c, qn_int_from(c, 1), 256), qn_int_shr(c, random_int(c, &seed, 4), 1));
      n = qn_int_add(c, qn_int_shl(c, n, 100), qn_int_from(c, (int64_t)random_below(&seed, 3) - 1));
      d = qn_int_shl(c, qn_int_from(c, 1), random_below(&seed, 700));
    }
    if (d.n) {
      to_mpz(mpq_numref(q), n);
      to_mpz(mpq_denref(q), d);
      mpq_canonicalize(q);
      assert_true(expected_rounded(qn_num_from_rat(c, n, d, 1), q, NULL));
    }
    qn_arena_release(&c->arena, mark);
  }
  mpq_clear(q);
  setup_free(&s);
}

static void test_dot(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  uint64_t seed = 13;
  mpq_t z, p, l, q;
  mpq_inits(z, p, l, q, NULL);
  for (int round = 0; round < share_of(4000); round++) {
    qn_mark mark = qn_arena_mark(&c->arena);
    qn_num a[4], b[4];
    size_t n = random_below(&seed, 5);
    int rounded = 0;
    mpq_set_ui(z, 0, 1);
    mpq_set_ui(l, 0, 1);
    for (size_t i = 0; i < n; i++) { /* makes */
      a[i] = random_num(c, &seed, round % 2);
      b[i] = random_num(c, &seed, round % 2);
      if (i == 3 && round % 3 == 0) { /* makes the sum cancel, up to its own rounding */
        a[3] = qn_num_neg(c, qn_num_dot(c, 3, a, b));
        b[3] = QN_NUM_ONE;
      }
      if (i == 2 && round % 3 == 1) { /* the first two cancel, and the third is little beside them */
        a[1] = qn_num_neg(c, a[0]);
        b[1] = b[0];
        qn_int down = qn_int_shl(c, qn_int_from(c, 3), 190 + random_below(&seed, 20));
        a[2] = qn_num_mul(c, a[0], qn_num_from_rat(c, qn_int_from(c, 1), down, 0));
        b[2] = b[0];
      }
    }
    for (size_t i = 0; i < n; i++) { /* judges */
      to_mpq(p, a[i]);
      to_mpq(q, b[i]);
      mpq_mul(p, p, q);
      rounded |= mpq_sgn(p) && (qn_num_is_rounded(a[i]) || qn_num_is_rounded(b[i]));
      mpq_add(z, z, p);
      larger_of(l, p, l);
    }
    assert_true(expected(qn_num_dot(c, n, a, b), z, l, rounded));
    qn_arena_release(&c->arena, mark);
  }
  mpq_clears(z, p, l, q, NULL);
  setup_free(&s);
}

static void test_doubles(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  uint64_t seed = 14;
  mpq_t x, y, e;
  mpq_inits(x, y, e, NULL);
  size_t subnormal = 0, infinite = 0, with_low = 0;
  for (int round = 0; round < share_from(1000, ROUNDS); round++) {
    qn_mark mark = qn_arena_mark(&c->arena);
    qn_num a = random_num(c, &seed, 1);
    if (round % 3 == 1) { /* between two doubles, and a hair off it */
      uint64_t bits = random_bits(&seed) >> 1;
      bits = round % 9 == 1 ? bits % (UINT64_C(1) << 54) : bits;
      double v, w;
      memcpy(&v, &bits, sizeof v);
      w = nextafter(v, INFINITY);
      if (isfinite(v) && isfinite(w)) {
        qn_num half = qn_num_from_double(c, 0.5);
        a = qn_num_mul(c, half, qn_num_add(c, qn_num_from_double(c, v), qn_num_from_double(c, w)));
        qn_int deep = random_below(&seed, 2) ? qn_int_pow(c, qn_int_from(c, 3), 1 + (unsigned)random_below(&seed, 300))
                                             : qn_int_shl(c, qn_int_from(c, 1), random_below(&seed, 1500));
        qn_num hair = qn_num_from_rat(c, qn_int_from(c, (int64_t)random_below(&seed, 3) - 1), deep, 0);
        a = qn_num_add(c, a, qn_num_mul(c, hair, a));
      }
    } else if (round % 6 == 2) { /* few bits, but subnormal or nearly so */
      qn_num five;
      assert_int_equal(qn_num_pow(c, qn_num_from_int(c, 5), qn_num_from_int(c, (int64_t)random_below(&seed, 45) - 22), &five), 1);
      a = qn_num_from_double(c, ldexp((double)(random_bits(&seed) >> (11 + random_below(&seed, 53))), -(int)random_below(&seed, 230) - 850));
      a = qn_num_mul(c, a, five);
    } else if (round % 6 == 5) { /* the ends of the range */
      unsigned long k = (unsigned long)random_below(&seed, 2200) + 9;
      char text[40];
      quoin_status status;
      int n = snprintf(text, sizeof text, "%llu.%lue%d", (unsigned long long)random_below(&seed, 100000000), k, (int)random_below(&seed, 700) - 350);
      assert_int_equal(qn_num_read(c, text, (size_t)n, &a, &status), n);
    }
    to_mpq(x, a);
    double hi, lo, v = qn_num_to_double(a);
    assert_true(is_nearest(x, v));
    qn_num_to_dd(c, a, &hi, &lo);
    assert_true(hi == v);
    subnormal += v != 0 && fabs(v) < 0x1p-1022;
    infinite += isinf(v) != 0;
    if (isinf(v)) {
      assert_true(lo == 0);
    } else {
      mpq_set_d(y, hi);
      mpq_sub(e, x, y);
      assert_true(is_nearest(e, lo));
      with_low += lo != 0;
      if (fabs(lo) > 0x1p-1000 || mpq_sgn(e) == 0) { /* |a - hi - lo| <= 2^-106 |a| */
        mpq_set_d(y, lo);
        mpq_sub(e, e, y);
        mpq_abs(e, e);
        mpq_mul_2exp(e, e, 106);
        mpq_abs(x, x);
        assert_true(mpq_cmp(e, x) <= 0);
      }
    }
    qn_arena_release(&c->arena, mark);
  }
  assert_true(subnormal > share_min(100) && infinite > share_min(100) && with_low > share_min(1000));
  mpq_clears(x, y, e, NULL);
  setup_free(&s);
}

static void read_as(qn_ctx *c, const char *text, size_t length, int64_t n, int64_t d) {
  qn_num a;
  quoin_status status;
  assert_int_equal(qn_num_read(c, text, strlen(text), &a, &status), length);
  assert_int_equal(status, QUOIN_OK);
  assert_true(qn_num_equal(a, qn_num_div(c, qn_num_from_int(c, n), qn_num_from_int(c, d))));
  assert_true(canonical(a));
}

static void test_reading(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  read_as(c, "0", 1, 0, 1);
  read_as(c, "-0.000", 6, 0, 1);
  read_as(c, "0e99999999999", 13, 0, 1);
  read_as(c, "0.1", 3, 1, 10);
  read_as(c, "+12.5e-1", 8, 5, 4);
  read_as(c, ".5", 2, 1, 2);
  read_as(c, "5.", 2, 5, 1);
  read_as(c, "5.e1", 4, 50, 1);
  read_as(c, "1e2x", 3, 100, 1);
  read_as(c, "2e", 1, 2, 1);
  read_as(c, "2e+", 1, 2, 1);
  read_as(c, "2.5.5", 3, 5, 2);
  read_as(c, "00000000000000000000000000001", 29, 1, 1);
  read_as(c, "9223372036854775807", 19, INT64_MAX, 1);
  read_as(c, "-9223372036854775808", 20, INT64_MIN, 1);
  read_as(c, "1.00000000000000000000000000000000000000", 40, 1, 1);
  read_as(c, "1000000000000000000000000000000e-30", 35, 1, 1);
  read_as(c, "0.00000000000000000000000000000000000001e38", 43, 1, 1);
  const char *no[] = {"", "-", "+", ".", "-.", "e5", ".e5", "x", "--1", "inf", "nan"};
  qn_num a;
  quoin_status status;
  for (size_t i = 0; i < sizeof no / sizeof *no; i++) {
    assert_int_equal(qn_num_read(c, no[i], strlen(no[i]), &a, &status), 0);
  }
  assert_int_equal(qn_num_read(c, "1234", 2, &a, &status), 2); /* no further than the length */
  assert_true(qn_num_equal(a, qn_num_from_int(c, 12)));
  assert_int_equal(qn_num_read(c, "1e55", 3, &a, &status), 3);
  assert_true(qn_num_equal(a, qn_num_from_int(c, 100000)));

  /* The limits, on both sides. */
  static char text[QN_MAX_DIGITS + 64];
  assert_int_equal(qn_num_read(c, "1e4000", 6, &a, &status), 6);
  assert_int_equal(status, QUOIN_OK);
  assert_int_equal(qn_num_read(c, "1e4001", 6, &a, &status), 6);
  assert_int_equal(status, QUOIN_E_LIMIT);
  assert_true(qn_num_is_zero(a));
  assert_int_equal(qn_num_read(c, "1e-4000", 7, &a, &status), 7);
  assert_int_equal(status, QUOIN_OK);
  assert_int_equal(qn_num_read(c, "9e-4001", 7, &a, &status), 7);
  assert_int_equal(status, QUOIN_E_LIMIT);
  assert_int_equal(qn_num_read(c, "1e99999999999999999999999", 25, &a, &status), 25);
  assert_int_equal(status, QUOIN_E_LIMIT);
  memset(text, '7', sizeof text);
  text[1] = '.';
  assert_int_equal(qn_num_read(c, text, QN_MAX_DIGITS + 1, &a, &status), QN_MAX_DIGITS + 1);
  assert_int_equal(status, QUOIN_OK);
  assert_int_equal(qn_num_read(c, text, QN_MAX_DIGITS + 2, &a, &status), QN_MAX_DIGITS + 2);
  assert_int_equal(status, QUOIN_E_LIMIT);
  assert_int_equal(c->failed, QUOIN_OK);

  /* Against mpq: digits of any number, a point anywhere. */
  uint64_t seed = 15;
  mpq_t q;
  mpz_t p;
  mpq_init(q);
  mpz_init(p);
  for (int round = 0; round < share_of(3000); round++) {
    qn_mark mark = qn_arena_mark(&c->arena);
    size_t digits = 1 + random_below(&seed, round % 10 ? 24 : 300), point = random_below(&seed, digits + 1);
    int e = (int)random_below(&seed, 100) - 50;
    char plain[400], *at = text;
    for (size_t i = 0; i < digits; i++) {
      if (i == point) {
        *at++ = '.';
      }
      *at++ = plain[i] = (char)('0' + random_below(&seed, 10) * random_below(&seed, 2));
    }
    plain[digits] = '\0';
    at += sprintf(at, "%s%d", e % 2 ? "e" : "E", e);
    mpz_set_str(mpq_numref(q), plain, 10);
    mpz_set_ui(mpq_denref(q), 1);
    long scale = e - (long)(digits - point);
    mpz_ui_pow_ui(p, 10, (unsigned long)labs(scale));
    if (scale < 0) {
      mpz_set(mpq_denref(q), p);
    } else {
      mpz_mul(mpq_numref(q), mpq_numref(q), p);
    }
    mpq_canonicalize(q);
    assert_int_equal(qn_num_read(c, text, (size_t)(at - text), &a, &status), at - text);
    assert_true(status == QUOIN_OK && same_mpq(a, q) && canonical(a));
    qn_arena_release(&c->arena, mark);
  }
  mpq_clear(q);
  mpz_clear(p);
  setup_free(&s);
}

/* A reader of the texts: + * / ^ of literals and parentheses, one level of precedence less than a language needs. */
typedef struct reading { qn_ctx *c; const char *at; } reading;

static qn_num read_literal(reading *r) {
  qn_num a;
  quoin_status status;
  size_t n = qn_num_read(r->c, r->at, strlen(r->at), &a, &status);
  assert_true(n > 0 && status == QUOIN_OK);
  r->at += n;
  return a;
}
static qn_num read_sum(reading *r);
static qn_num read_factor(reading *r) {
  int negative = *r->at == '-' && r->at[1] == '(';
  r->at += negative;
  qn_num a;
  if (*r->at == '(') {
    r->at++;
    a = read_sum(r);
    assert_int_equal(*r->at++, ')');
  } else {
    a = read_literal(r);
  }
  if (*r->at == '^') {
    r->at++;
    assert_int_equal(qn_num_pow(r->c, a, read_literal(r), &a), 1);
  }
  return negative ? qn_num_neg(r->c, a) : a;
}
static qn_num read_product(reading *r) {
  qn_num a = read_factor(r);
  while (*r->at == '*' || *r->at == '/') {
    int divide = *r->at++ == '/';
    qn_num b = read_factor(r);
    a = divide ? qn_num_div(r->c, a, b) : qn_num_mul(r->c, a, b);
  }
  return a;
}
static qn_num read_sum(reading *r) {
  qn_num a = read_product(r);
  while (*r->at == '+') {
    r->at++;
    a = qn_num_add(r->c, a, read_product(r));
  }
  return a;
}
static qn_num read_back(qn_ctx *c, const char *text) {
  reading r = {c, text};
  int rounded = strncmp(text, "rounded", 7) == 0;
  r.at += rounded ? 7 : 0;
  qn_num a = read_sum(&r);
  assert_int_equal(*r.at, '\0');
  if (rounded) {
    qn_rat f = qn_num_rat(c, a);
    a = qn_num_from_rat(c, f.num, f.den, 1);
  }
  return a;
}

static void text_is(qn_ctx *c, qn_num a, const char *text) {
  assert_string_equal(qn_num_text(c, a), text);
  assert_true(qn_num_equal(read_back(c, text), a));
}

static void test_text(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  qn_num one = QN_NUM_ONE, ten = qn_num_from_int(c, 10), p;
  text_is(c, QN_NUM_ZERO, "0");
  text_is(c, qn_num_div(c, one, ten), "0.1");
  text_is(c, qn_num_from_int(c, -1200), "-1200");
  text_is(c, qn_num_div(c, qn_num_from_int(c, -5), qn_num_from_int(c, 4)), "-1.25");
  text_is(c, qn_num_div(c, one, qn_num_from_int(c, 10000000)), "1e-07");
  text_is(c, qn_num_div(c, qn_num_from_int(c, 123), qn_num_from_int(c, 100000000)), "0.00000123");
  text_is(c, qn_num_div(c, one, qn_num_from_int(c, 3)), "(1/3)");
  text_is(c, qn_num_div(c, qn_num_from_int(c, -2), qn_num_from_int(c, 7)), "(-2/7)");
  text_is(c, qn_num_from_double(c, 0.1), "(3602879701896397/2^55)");
  text_is(c, qn_num_from_double(c, 0.375), "0.375");
  text_is(c, qn_num_from_double(c, 1e22), "1e+22");
  assert_int_equal(qn_num_pow(c, ten, qn_num_from_int(c, 3000), &p), 1);
  text_is(c, p, "1e+3000");
  text_is(c, qn_num_div(c, one, p), "1e-3000");
  assert_int_equal(qn_num_pow(c, ten, qn_num_from_int(c, 4001), &p), 1);
  text_is(c, p, "(1*2^4001*5^4001)");
  text_is(c, qn_num_from_rat(c, qn_int_from(c, 3), qn_int_from(c, 8), 1), "rounded(3/2^3)");
  text_is(c, qn_num_from_rat(c, qn_int_from(c, -12), qn_int_from(c, 1), 1), "rounded(-3*2^2)");
  assert_int_equal(qn_num_pow(c, qn_num_from_int(c, 3), qn_num_from_int(c, 30000), &p), 1); /* 14314 digits */
  const char *text = qn_num_text(c, p);
  assert_non_null(text);
  assert_true(qn_num_equal(read_back(c, text), p));
  p = qn_num_neg(c, qn_num_div(c, p, qn_num_from_int(c, 70)));
  assert_true(qn_num_equal(read_back(c, qn_num_text(c, p)), p));
  uint64_t seed = 16;
  for (int round = 0; round < share_of(6000); round++) {
    qn_mark mark = qn_arena_mark(&c->arena);
    qn_num a = random_num(c, &seed, 1);
    text = qn_num_text(c, a);
    assert_non_null(text);
    assert_true(qn_num_equal(read_back(c, text), a));
    qn_arena_release(&c->arena, mark);
  }
  assert_int_equal(c->failed, QUOIN_OK);
  setup_free(&s);
}

/* Design S1 and S2 in the places where they are named. */
static void test_laws(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  qn_num t[5];
  const char *text[] = {"0.1", "0.2", "0.3", "8.1", "0.9"};
  quoin_status status;
  for (int i = 0; i < 5; i++) {
    qn_num_read(c, text[i], 3, &t[i], &status);
  }
  assert_true(qn_num_equal(qn_num_add(c, t[0], t[1]), t[2]));
  assert_true(qn_num_is_zero(qn_num_add(c, qn_num_sub(c, t[3], qn_num_from_int(c, 9)), t[4])));
  /* A fraction that becomes a decimal again is small again. */
  qn_num three = qn_num_from_int(c, 3), third = qn_num_div(c, QN_NUM_ONE, three);
  assert_int_equal(third.kind, QN_NUM_BIG);
  assert_true(qn_num_equal(qn_num_mul(c, third, three), QN_NUM_ONE));
  assert_true(qn_num_equal(qn_num_add(c, third, qn_num_add(c, third, third)), QN_NUM_ONE));
  /* A rounded 2 - 2^-254 is the integer 2; 2 - 2^-190 is not. */
  qn_num two = qn_num_from_int(c, 2);
  for (size_t k = 190; k <= 254; k++) {
    qn_int gap = qn_int_shl(c, qn_int_from(c, 1), k);
    qn_num r = qn_num_from_rat(c, qn_int_sub(c, qn_int_shl(c, gap, 1), qn_int_from(c, 1)), gap, 1);
    int near = k >= 200; /* 2^-k < 2^-200 (2 - 2^-k) from k = 200 on */
    int64_t v = 0;
    assert_int_equal(qn_num_is_integer(r, &v), near);
    assert_int_equal(qn_num_cmp(c, r, two), near ? 0 : -1);
    assert_true(qn_num_equal(qn_num_floor(c, r), near ? two : QN_NUM_ONE));
    assert_true(qn_num_equal(qn_num_ceil(c, r), two));
    assert_int_equal(qn_num_is_zero(qn_num_mod(c, r, QN_NUM_ONE)), near);
    assert_int_equal(qn_num_is_integer(qn_num_neg(c, r), &v), near);
    assert_true(!near || v == -2);
    near = k >= 199; /* 2^-k < 2^-200 (2 + 2^-k) from k = 199 on */
    r = qn_num_from_rat(c, qn_int_add(c, qn_int_shl(c, gap, 1), qn_int_from(c, 1)), gap, 1);
    assert_true(qn_num_equal(qn_num_floor(c, r), two));
    assert_true(qn_num_equal(qn_num_ceil(c, r), near ? two : three));
    assert_int_equal(qn_num_is_integer(r, &v), near);
    assert_int_equal(qn_num_is_zero(qn_num_mod(c, r, two)), near);
    assert_int_equal(qn_num_is_zero(qn_num_sub(c, r, two)), near);
  }
  int64_t v = 0;
  assert_true(qn_num_is_integer(qn_num_from_int(c, INT64_MIN), &v) && v == INT64_MIN);
  assert_true(qn_num_is_integer(qn_num_from_int(c, INT64_MAX), &v) && v == INT64_MAX);
  assert_false(qn_num_is_integer(qn_num_neg(c, qn_num_from_int(c, INT64_MIN)), &v));
  assert_true(qn_num_is_zero(qn_num_mul(c, qn_num_from_rat(c, qn_int_from(c, 7), qn_int_from(c, 1), 1), QN_NUM_ZERO)));
  setup_free(&s);
}

static void test_refused_memory(void **unused) {
  (void)unused;
  int finished = 0;
  for (size_t k = 0; k < 60 && !finished; k++) {
    refusing r = {k, 0};
    setup s;
    setup_init(&s, &r);
    qn_ctx *c = &s.ctx;
    qn_num kept[64];
    qn_num total = QN_NUM_ONE;
    for (int i = 0; i < 64; i++) {
      mp_limb_t limbs[30];
      for (int j = 0; j < 30; j++) {
        limbs[j] = (mp_limb_t)(i + 1) * (mp_limb_t)(2 * j + 3) * UINT64_C(0x9e3779b97f4a7c15);
      }
      kept[i] = qn_num_from_rat(c, qn_int_from_limbs(c, limbs, 25, 0), qn_int_from_limbs(c, limbs + 3, 27, 0), i % 4 == 3);
      total = qn_num_add(c, qn_num_mul(c, total, kept[i]), qn_num_div(c, kept[i], total));
      total = qn_num_sub(c, total, qn_num_floor(c, total));
      total = qn_num_is_zero(total) ? QN_NUM_ONE : qn_num_mod(c, total, kept[i]);
      total = qn_num_is_zero(total) ? QN_NUM_ONE : qn_num_round(c, qn_num_div(c, QN_NUM_ONE, total));
      total = qn_num_is_zero(total) ? QN_NUM_ONE : total;
      if (i % 16 == 15) {
        total = qn_num_dot(c, 16, kept, kept + i - 15);
      }
      double hi, lo;
      qn_num_to_dd(c, total, &hi, &lo);
      qn_num_text(c, total);
      qn_num_cmp(c, total, kept[i]);
      qn_num read;
      quoin_status status;
      char digits[] = "123456789012345678901234567890123456789012345678901234567890.5e-300";
      assert_int_equal(qn_num_read(c, digits, strlen(digits), &read, &status), strlen(digits));
      total = qn_num_copy(c, qn_num_neg(c, qn_num_add(c, total, read)));
    }
    finished = c->failed == QUOIN_OK;
    assert_true(finished || (c->failed == QUOIN_E_MEMORY && qn_num_is_zero(total)));
    setup_free(&s);
    assert_int_equal(r.out, 0);
  }
  assert_true(finished);
}

static void test_limit(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  c->max_bits = 1000;
  qn_num a = qn_num_div(c, qn_num_from_int(c, 5), qn_num_from_int(c, 3));
  for (int i = 0; i < 12; i++) {
    a = qn_num_mul(c, a, a);
  }
  assert_int_equal(c->failed, QUOIN_E_LIMIT);
  assert_true(qn_num_is_zero(a));
  setup_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_operations_agree_with_mpq), cmocka_unit_test(test_rounding), cmocka_unit_test(test_dot),
      cmocka_unit_test(test_doubles),                   cmocka_unit_test(test_reading),  cmocka_unit_test(test_text),
      cmocka_unit_test(test_laws),                      cmocka_unit_test(test_limit),    cmocka_unit_test(test_refused_memory),
  };
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  mpfr_free_cache();
  return failed;
}
