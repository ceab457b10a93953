/* Integers against GMP's mpz, which is another layer with its own signs and sizes. */
#include "numbers.h"

enum { ROUNDS = 20000 };

static void test_operations_agree_with_mpz(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  uint64_t seed = 1;
  mpz_t x, y, z, w;
  mpz_inits(x, y, z, w, NULL);
  size_t equal = 0, cancelled = 0, divided = 0, squares = 0;
  for (int round = 0; round < ROUNDS; round++) {
    qn_mark mark = qn_arena_mark(&s.ctx.arena);
    qn_ctx *c = &s.ctx;
    size_t most = round % 8 == 0 ? 40 : 6;
    qn_int a = random_int(c, &seed, most), b = random_int(c, &seed, most);
    if (round % 7 == 0) { /* common factors, neighbours, equals */
      qn_int f = random_int(c, &seed, 3);
      a = qn_int_mul(c, a, f);
      b = round % 2 ? qn_int_mul(c, b, f) : qn_int_add(c, a, qn_int_from(c, (int64_t)random_below(&seed, 3) - 1));
    }
    to_mpz(x, a);
    to_mpz(y, b);
    assert_int_equal(qn_int_sign(a), mpz_sgn(x));
    assert_int_equal(qn_int_bits(a), a.n ? mpz_sizeinbase(x, 2) : 0);
    assert_int_equal(qn_int_trailing_zeros(a), a.n ? mpz_scan1(x, 0) : 0);
    int order = mpz_cmp(x, y);
    assert_int_equal(qn_int_cmp(a, b), (order > 0) - (order < 0));
    assert_int_equal(qn_int_equal(a, b), order == 0);
    equal += order == 0;
    assert_int_equal(qn_int_equal(qn_int_copy(c, a), a), 1);
    assert_true(qn_int_hash(qn_int_copy(c, a)) == qn_int_hash(a));
    int64_t v = 0;
    assert_int_equal(qn_int_fits(a, &v), mpz_fits_slong_p(x));
    assert_true(v == (mpz_fits_slong_p(x) ? mpz_get_si(x) : 0));

    mpz_add(z, x, y);
    assert_true(same_mpz(qn_int_add(c, a, b), z));
    cancelled += a.n && b.n && mpz_sgn(z) == 0;
    mpz_sub(z, x, y);
    assert_true(same_mpz(qn_int_sub(c, a, b), z));
    mpz_mul(z, x, y);
    assert_true(same_mpz(qn_int_mul(c, a, b), z));
    mpz_mul(z, x, x);
    assert_true(same_mpz(qn_int_mul(c, a, a), z));
    assert_true(same_mpz(qn_int_mul(c, a, qn_int_neg(a)), (mpz_neg(w, z), w)));
    size_t shift = random_below(&seed, 3) ? random_below(&seed, 300) : 64 * random_below(&seed, 5);
    mpz_mul_2exp(z, x, shift);
    assert_true(same_mpz(qn_int_shl(c, a, shift), z));
    mpz_tdiv_q_2exp(z, x, shift);
    assert_true(same_mpz(qn_int_shr(c, a, shift), z));
    mpz_gcd(z, x, y);
    qn_int g = qn_int_gcd(c, a, b);
    assert_true(same_mpz(g, z));
    if (b.n) {
      qn_int q, r;
      mpz_tdiv_qr(z, w, x, y);
      qn_int_divmod(c, a, b, &q, &r);
      assert_true(same_mpz(q, z) && same_mpz(r, w));
      mpz_set(z, x);
      assert_true(same_mpz(qn_int_divexact(c, qn_int_mul(c, a, b), b), z));
      mpz_gcd(z, x, y);
      mpz_divexact(w, x, z);
      assert_true(same_mpz(qn_int_divexact(c, a, g), w));
      divided++;
    }
    int exact, perfect = mpz_sgn(x) >= 0 && mpz_perfect_square_p(x);
    mpz_abs(w, x);
    mpz_sqrt(z, w);
    assert_true(same_mpz(qn_int_sqrt(c, qn_int_abs(a), &exact), z));
    assert_int_equal(exact, mpz_perfect_square_p(w) != 0);
    squares += (size_t)perfect;
    assert_true(same_mpz(qn_int_sqrt(c, qn_int_mul(c, a, a), &exact), w) && exact);
    unsigned e = (unsigned)random_below(&seed, 9);
    mpz_pow_ui(z, x, e);
    assert_true(same_mpz(qn_int_pow(c, a, e), z));

    char *text = qn_int_text(c, a), *expected = mpz_get_str(NULL, 10, x);
    assert_string_equal(text, expected);
    free(expected);
    size_t sign = a.n < 0;
    qn_int back = qn_int_from_digits(c, text + sign, strlen(text + sign));
    assert_true(qn_int_equal(sign ? qn_int_neg(back) : back, a));
    assert_int_equal(c->failed, QUOIN_OK);
    qn_arena_release(&c->arena, mark);
  }
  assert_true(equal > 100 && cancelled > 5 && divided > 1000 && squares > 100); /* the hard kinds did occur */
  mpz_clears(x, y, z, w, NULL);
  setup_free(&s);
}

/* Rounding to a double is judged by the distance to the neighbours, in integers. */
static void nearest(qn_ctx *c, qn_int a, mpz_t x, mpz_t lo, mpz_t hi) {
  double d = qn_int_to_double(a);
  to_mpz(x, a);
  if (isinf(d)) {
    mpz_ui_pow_ui(hi, 2, 1024);
    mpz_ui_pow_ui(lo, 2, 970);
    mpz_sub(hi, hi, lo); /* the largest double plus half an ulp: from there on it is infinite */
    assert_true(mpz_cmpabs(x, hi) >= 0 && (d > 0) == (mpz_sgn(x) > 0));
    return;
  }
  mpz_set_d(hi, d);
  mpz_sub(lo, x, hi);
  mpz_abs(lo, lo);
  mpz_mul_2exp(lo, lo, 1); /* twice the error */
  double ulp = nextafter(fabs(d), INFINITY) - fabs(d), below = fabs(d) - nextafter(fabs(d), 0);
  double half = mpz_cmpabs(x, hi) >= 0 ? ulp : below;
  if (half < 1 || d == 0) {
    assert_true(mpz_sgn(lo) == 0);
    return;
  }
  mpz_t step;
  mpz_init_set_d(step, isinf(ulp) ? below : half);
  int order = mpz_cmp(lo, step);
  int even = ((int64_t)ldexp(fabs(d), 52 - ilogb(d)) & 1) == 0;
  assert_true(order < 0 || (order == 0 && even));
  mpz_clear(step);
  double m;
  int64_t e;
  qn_int_frexp(a, &m, &e);
  int plain;
  double toward = fabs(d);
  if (mpz_cmpabs(hi, x) > 0) {
    toward = nextafter(toward, 0);
  }
  double fm = frexp(toward, &plain);
  assert_true(fabs(m) == fm && e == plain && (m < 0) == (a.n < 0));
  (void)c;
}

static void test_doubles(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  uint64_t seed = 2;
  mpz_t x, lo, hi;
  mpz_inits(x, lo, hi, NULL);
  size_t infinite = 0;
  for (int round = 0; round < ROUNDS; round++) {
    qn_mark mark = qn_arena_mark(&c->arena);
    qn_int a;
    if (round % 2) { /* at and next to a tie: 54 bits, then zeros, then perhaps a one */
      a = qn_int_from(c, (int64_t)((random_bits(&seed) >> 10) | 1));
      size_t up = random_below(&seed, 1000);
      a = qn_int_add(c, qn_int_shl(c, a, up), qn_int_from(c, (int64_t)random_below(&seed, 3) - 1));
    } else {
      a = random_int(c, &seed, 17);
    }
    infinite += isinf(qn_int_to_double(a)) != 0;
    nearest(c, a, x, lo, hi);
    nearest(c, qn_int_neg(a), x, lo, hi);
    qn_arena_release(&c->arena, mark);
  }
  /* The edge of the range: 2^1024 - 2^970 is the tie between the largest double and infinity. */
  qn_int edge = qn_int_sub(c, qn_int_shl(c, qn_int_from(c, 1), 1024), qn_int_shl(c, qn_int_from(c, 1), 970));
  assert_true(isinf(qn_int_to_double(edge)));
  assert_true(qn_int_to_double(qn_int_sub(c, edge, qn_int_from(c, 1))) == 0x1.fffffffffffffp1023);
  assert_true(infinite > 0);
  mpz_clears(x, lo, hi, NULL);
  setup_free(&s);
}

static void test_edges(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  int64_t v;
  qn_int least = qn_int_from(c, INT64_MIN), most = qn_int_from(c, INT64_MAX), one = qn_int_from(c, 1), zero = qn_int_from(c, 0);
  assert_true(qn_int_fits(least, &v) && v == INT64_MIN);
  assert_true(qn_int_fits(most, &v) && v == INT64_MAX);
  assert_false(qn_int_fits(qn_int_neg(least), &v));
  assert_false(qn_int_fits(qn_int_sub(c, least, one), &v));
  assert_string_equal(qn_int_text(c, least), "-9223372036854775808");
  assert_string_equal(qn_int_text(c, zero), "0");
  assert_int_equal(qn_int_from_digits(c, "0000", 4).n, 0);
  assert_int_equal(qn_int_from_digits(c, "", 0).n, 0);
  assert_int_equal(qn_int_shl(c, zero, 1000).n, 0);
  assert_true(qn_int_equal(qn_int_pow(c, zero, 0), one));
  assert_true(qn_int_equal(qn_int_pow(c, qn_int_from(c, -1), 4294967295u), qn_int_from(c, -1)));
  assert_true(qn_int_equal(qn_int_gcd(c, zero, least), qn_int_neg(least)));
  assert_int_equal(c->failed, QUOIN_OK);
  setup_free(&s);
}

static void test_limit(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  c->max_bits = 100;
  qn_int a = qn_int_shl(c, qn_int_from(c, 1), 99); /* 100 bits: allowed */
  assert_int_equal(c->failed, QUOIN_OK);
  assert_int_equal(qn_int_add(c, a, a).n, 0);
  assert_int_equal(c->failed, QUOIN_E_LIMIT);
  c->failed = QUOIN_OK;
  assert_int_equal(qn_int_bits(qn_int_mul(c, qn_int_shr(c, a, 49), qn_int_shr(c, a, 50))), 100);
  assert_int_equal(c->failed, QUOIN_OK);
  qn_int_mul(c, qn_int_shr(c, a, 49), qn_int_shr(c, a, 49));
  assert_int_equal(c->failed, QUOIN_E_LIMIT);
  c->failed = QUOIN_OK;
  qn_int_pow(c, qn_int_from(c, 3), 4000000000u); /* refused before the work */
  assert_int_equal(c->failed, QUOIN_E_LIMIT);
  c->failed = QUOIN_OK;
  qn_int_shl(c, a, SIZE_MAX);
  assert_int_equal(c->failed, QUOIN_E_LIMIT);
  setup_free(&s);
}

/* Memory refused after k allocations: no crash, no leak, and the context says so. */
static void test_refused_memory(void **unused) {
  (void)unused;
  int finished = 0;
  for (size_t k = 0; k < 40 && !finished; k++) {
    refusing r = {k, 0};
    setup s;
    setup_init(&s, &r);
    qn_ctx *c = &s.ctx;
    uint64_t seed = 3;
    qn_int total = qn_int_from(c, 1);
    for (int i = 0; i < 60; i++) {
      qn_int a = random_int(c, &seed, 40), b = random_int(c, &seed, 30), q, m;
      int exact;
      qn_int_divmod(c, a, qn_int_add(c, qn_int_mul(c, b, b), qn_int_from(c, 1)), &q, &m);
      total = qn_int_add(c, qn_int_sub(c, total, qn_int_mul(c, q, m)), qn_int_gcd(c, a, b));
      total = qn_int_add(c, total, qn_int_sqrt(c, qn_int_abs(a), &exact));
      total = qn_int_shr(c, qn_int_shl(c, total, 301), 3 * i);
      qn_int p = qn_int_pow(c, b, 5);
      if (p.n) {
        total = qn_int_add(c, total, qn_int_divexact(c, qn_int_mul(c, p, a), p));
      }
      char *text = qn_int_text(c, total);
      if (text && *text != '-') {
        total = qn_int_from_digits(c, text, strlen(text));
      }
    }
    finished = c->failed == QUOIN_OK;
    assert_true(finished || c->failed == QUOIN_E_MEMORY);
    setup_free(&s);
    assert_int_equal(r.out, 0);
  }
  assert_true(finished); /* with enough memory it does end well */
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_operations_agree_with_mpz), cmocka_unit_test(test_doubles),         cmocka_unit_test(test_edges),
      cmocka_unit_test(test_limit),                     cmocka_unit_test(test_refused_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
