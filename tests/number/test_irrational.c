/* Irrational functions: exact values, correct rounding against MPFR's own functions in degrees (mpfr_sinu and its
   kin, another code path) where the argument is dyadic and against plain evaluation at 6000 bits where it is not. */
#include "judge.h"
#include "share.h"

/* The relative distance of r from y, y at high precision: at most half a unit of 256 bits, so it is the nearest. */
static int nearest_to(qn_num r, mpfr_t y) {
  mpq_t q;
  mpfr_t n, x;
  mpq_init(q);
  mpfr_init2(n, QN_S2_PRECISION);
  mpfr_init2(x, QN_S2_PRECISION);
  mpfr_set(n, y, MPFR_RNDN);
  to_mpq(q, r);
  int inexact = mpfr_set_q(x, q, MPFR_RNDN);
  int same = r.kind == QN_NUM_ROUNDED && canonical(r) && inexact == 0 && mpfr_equal_p(x, n);
  mpfr_clears(n, x, (mpfr_ptr)0);
  mpq_clear(q);
  return same;
}

/* The same, or an exact value that is y. */
static int matches(qn_num r, mpfr_t y) {
  if (r.kind == QN_NUM_ROUNDED) {
    return nearest_to(r, y);
  }
  mpq_t q;
  mpfr_t n, x;
  mpq_init(q);
  mpfr_init2(n, QN_S2_PRECISION);
  mpfr_init2(x, QN_S2_PRECISION);
  mpfr_set(n, y, MPFR_RNDN);
  to_mpq(q, r);
  mpfr_set_q(x, q, MPFR_RNDN);
  int same = canonical(r) && mpfr_equal_p(x, n);
  mpfr_clears(n, x, (mpfr_ptr)0);
  mpq_clear(q);
  return same;
}

static qn_num ratio(qn_ctx *c, int64_t n, int64_t d) {
  return qn_num_div(c, qn_num_from_int(c, n), qn_num_from_int(c, d));
}

static void test_exact_values(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  qn_num half = ratio(c, 1, 2), t;
  for (int turn = -3; turn <= 3; turn++) {
    for (int degrees = 0; degrees < 360; degrees += 15) {
      qn_num a = qn_num_from_int(c, degrees + 360 * turn), sine = qn_num_sin(c, a), cosine = qn_num_cos(c, a);
      static const int twice[12] = {0, 1, 9, 2, 9, 1, 0, -1, 9, -2, 9, -1}; /* 2 sin of 0, 30, ... degrees; 9: irrational */
      int i = degrees / 30, j = (i + 3) % 12;
      if (degrees % 30 == 0 && twice[i] != 9) {
        assert_true(qn_num_equal(sine, qn_num_mul(c, half, qn_num_from_int(c, twice[i]))));
      } else {
        assert_int_equal(sine.kind, QN_NUM_ROUNDED);
      }
      if (degrees % 30 == 0 && twice[j] != 9) {
        assert_true(qn_num_equal(cosine, qn_num_mul(c, half, qn_num_from_int(c, twice[j]))));
      } else {
        assert_int_equal(cosine.kind, QN_NUM_ROUNDED);
      }
      int defined = qn_num_tan(c, a, &t);
      assert_int_equal(defined, degrees % 180 != 90);
      if (degrees % 45 == 0 && defined) {
        assert_true(qn_num_equal(t, qn_num_from_int(c, degrees % 90 == 0 ? 0 : degrees % 180 == 45 ? 1 : -1)));
      }
      /* sin^2 + cos^2 = 1 to the rule of S2 */
      qn_num pair[2] = {sine, cosine};
      assert_int_equal(qn_num_cmp(c, qn_num_dot(c, 2, pair, pair), QN_NUM_ONE), 0);
    }
  }
  struct { int n, d, asin, acos; } arcs[] = {{0, 1, 0, 90}, {1, 2, 30, 60}, {-1, 2, -30, 120}, {1, 1, 90, 0}, {-1, 1, -90, 180}};
  for (size_t i = 0; i < 5; i++) {
    assert_true(qn_num_equal(qn_num_asin(c, ratio(c, arcs[i].n, arcs[i].d)), qn_num_from_int(c, arcs[i].asin)));
    assert_true(qn_num_equal(qn_num_acos(c, ratio(c, arcs[i].n, arcs[i].d)), qn_num_from_int(c, arcs[i].acos)));
  }
  struct { int y, x, degrees; } around[] = {{0, 0, 0}, {0, 5, 0}, {3, 3, 45}, {2, 0, 90}, {1, -1, 135}, {0, -7, 180}, {-1, -1, -135}, {-9, 0, -90}, {-4, 4, -45}};
  for (size_t i = 0; i < 9; i++) {
    assert_true(qn_num_equal(qn_num_atan2(c, ratio(c, around[i].y, 7), ratio(c, around[i].x, 7)), qn_num_from_int(c, around[i].degrees)));
  }
  assert_true(qn_num_equal(qn_num_atan(c, qn_num_from_int(c, -1)), qn_num_from_int(c, -45)));
  assert_true(qn_num_equal(qn_num_sqrt(c, ratio(c, 49, 9)), ratio(c, 7, 3)));
  assert_true(qn_num_equal(qn_num_sqrt(c, ratio(c, 1, 100)), ratio(c, 1, 10)));
  assert_true(qn_num_is_zero(qn_num_sqrt(c, QN_NUM_ZERO)));
  assert_true(qn_num_equal(qn_num_exp(c, QN_NUM_ZERO), QN_NUM_ONE));
  assert_true(qn_num_is_zero(qn_num_ln(c, QN_NUM_ONE)));
  /* sin / sqrt(n): rational where sin^2 / n is a square. */
  assert_true(qn_num_equal(qn_num_sin_over_sqrt(c, qn_num_from_int(c, 120), qn_num_from_int(c, 3)), half));
  assert_true(qn_num_equal(qn_num_sin_over_sqrt(c, qn_num_from_int(c, -45), qn_num_from_int(c, 2)), qn_num_neg(c, half)));
  assert_true(qn_num_equal(qn_num_sin_over_sqrt(c, qn_num_from_int(c, 90), qn_num_from_int(c, 4)), half));
  assert_true(qn_num_equal(qn_num_sin_over_sqrt(c, qn_num_from_int(c, 210), ratio(c, 9, 16)), ratio(c, -2, 3)));
  assert_true(qn_num_is_zero(qn_num_sin_over_sqrt(c, qn_num_from_int(c, 540), qn_num_from_int(c, 7))));
  assert_int_equal(qn_num_sin_over_sqrt(c, qn_num_from_int(c, 90), qn_num_from_int(c, 3)).kind, QN_NUM_ROUNDED);
  assert_int_equal(qn_num_sin_over_sqrt(c, qn_num_from_int(c, 20), qn_num_from_int(c, 4)).kind, QN_NUM_ROUNDED);
  assert_int_equal(c->failed, QUOIN_OK);
  setup_free(&s);
}

static void power_is(qn_ctx *c, qn_num a, qn_num b, qn_num r) {
  qn_num p;
  assert_int_equal(qn_num_pow(c, a, b, &p), 1);
  assert_true(qn_num_equal(p, r));
}

static void test_powers(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  qn_num p, zero = QN_NUM_ZERO, one = QN_NUM_ONE, two = qn_num_from_int(c, 2);
  power_is(c, ratio(c, -2, 3), qn_num_from_int(c, 3), ratio(c, -8, 27));
  power_is(c, ratio(c, -2, 3), qn_num_from_int(c, -2), ratio(c, 9, 4));
  power_is(c, ratio(c, 8, 27), ratio(c, 2, 3), ratio(c, 4, 9));
  power_is(c, ratio(c, 8, 27), ratio(c, -1, 3), ratio(c, 3, 2));
  power_is(c, zero, zero, one);
  power_is(c, zero, two, zero);
  power_is(c, one, qn_num_from_double(c, 1e300), one);
  power_is(c, one, qn_num_sqrt(c, two), one);
  power_is(c, qn_num_from_int(c, -1), qn_num_from_double(c, 0x1p300), one);
  assert_int_equal(qn_num_pow(c, zero, qn_num_from_int(c, -1), &p), 0);
  assert_int_equal(qn_num_pow(c, qn_num_from_int(c, -8), ratio(c, 1, 3), &p), 0);
  /* Rounded: one rounding of the stored value's power; a rounded whole exponent is whole. */
  qn_num root = qn_num_sqrt(c, two);
  assert_int_equal(qn_num_pow(c, root, two, &p), 1);
  assert_int_equal(p.kind, QN_NUM_ROUNDED);
  assert_int_equal(qn_num_cmp(c, p, two), 0);
  assert_int_equal(qn_num_pow(c, two, qn_num_mul(c, root, root), &p), 1);
  assert_true(qn_num_equal(p, qn_num_from_int(c, 4)));
  /* A stored 3 to the 162nd has 257 bits: a tie, and no search for more bits would end. */
  mpq_t q;
  mpq_init(q);
  for (unsigned e = 60; e < 400; e++) {
    assert_int_equal(qn_num_pow(c, qn_num_from_rat(c, qn_int_from(c, 3), qn_int_from(c, 1), 1), qn_num_from_int(c, e), &p), 1);
    mpz_ui_pow_ui(mpq_numref(q), 3, e);
    mpz_set_ui(mpq_denref(q), 1);
    round_mpq(q);
    assert_true(same_mpq(p, q) && p.kind == QN_NUM_ROUNDED);
  }
  mpq_clear(q);
  assert_int_equal(qn_num_pow(c, qn_num_from_rat(c, qn_int_from(c, 4), qn_int_from(c, 1), 1), ratio(c, 1, 2), &p), 1);
  assert_true(qn_num_equal(p, qn_num_from_rat(c, qn_int_from(c, 2), qn_int_from(c, 1), 1)));
  assert_int_equal(c->failed, QUOIN_OK);
  c->max_bits = 1 << 17;
  qn_num_pow(c, qn_num_from_int(c, 3), qn_num_from_int(c, 100000), &p);
  assert_int_equal(c->failed, QUOIN_E_LIMIT);
  c->failed = QUOIN_OK;
  qn_num_pow(c, two, qn_num_from_double(c, 1e300), &p);
  assert_int_equal(c->failed, QUOIN_E_LIMIT);
  c->failed = QUOIN_OK;
  qn_num_exp(c, qn_num_from_double(c, 1e300));
  assert_int_equal(c->failed, QUOIN_E_LIMIT);
  c->failed = QUOIN_OK;
  qn_num_exp(c, qn_num_from_int(c, -1000000));
  assert_int_equal(c->failed, QUOIN_E_LIMIT);
  setup_free(&s);
}

enum { HIGH = 6000 };

/* Dyadic arguments against MPFR's functions of degrees. */
static void test_dyadic_degrees(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  uint64_t seed = 21;
  mpfr_t x, y, z;
  mpfr_init2(x, 1200);
  mpfr_init2(z, 1200);
  mpfr_init2(y, QN_S2_PRECISION);
  for (int round = 0; round < share_of(3000); round++) {
    qn_mark mark = qn_arena_mark(&c->arena);
    double v = ldexp((double)(int64_t)random_bits(&seed), (int)random_below(&seed, 120) - 110), w = ldexp((double)(int64_t)random_bits(&seed), -58);
    if (round % 4 == 0) { /* next to the exact places */
      v = 15.0 * (double)((int)random_below(&seed, 100) - 50);
      v = random_below(&seed, 2) ? nextafter(v, INFINITY) : v + ldexp(1, -(int)random_below(&seed, 60));
    }
    qn_num a = qn_num_from_double(c, v), b = qn_num_from_double(c, w), t;
    mpfr_set_d(x, v, MPFR_RNDN);
    mpfr_set_d(z, w, MPFR_RNDN);
    mpfr_sinu(y, x, 360, MPFR_RNDN);
    qn_num r = qn_num_sin(c, a);
    assert_true(matches(r, y));
    mpfr_cosu(y, x, 360, MPFR_RNDN);
    r = qn_num_cos(c, a);
    assert_true(matches(r, y));
    mpfr_tanu(y, x, 360, MPFR_RNDN);
    assert_true(!qn_num_tan(c, a, &t) || matches(t, y));
    mpfr_atanu(y, x, 360, MPFR_RNDN);
    r = qn_num_atan(c, a);
    assert_true(matches(r, y));
    mpfr_atan2u(y, x, z, 360, MPFR_RNDN);
    r = qn_num_atan2(c, a, b);
    assert_true(matches(r, y));
    double f = v - trunc(v);
    mpfr_set_d(x, f, MPFR_RNDN);
    mpfr_asinu(y, x, 360, MPFR_RNDN);
    r = qn_num_asin(c, qn_num_from_double(c, f));
    assert_true(matches(r, y));
    mpfr_acosu(y, x, 360, MPFR_RNDN);
    r = qn_num_acos(c, qn_num_from_double(c, f));
    assert_true(matches(r, y));
    mpfr_exp(y, z, MPFR_RNDN);
    r = qn_num_exp(c, b);
    assert_true(matches(r, y));
    if (w > 0) {
      mpfr_log(y, z, MPFR_RNDN);
      r = qn_num_ln(c, b);
      assert_true(matches(r, y));
      mpfr_set_d(x, f, MPFR_RNDN);
      mpfr_pow(y, z, x, MPFR_RNDN);
      assert_int_equal(qn_num_pow(c, b, qn_num_from_double(c, f), &r), 1);
      assert_true(matches(r, y));
      mpfr_sqrt(y, z, MPFR_RNDN);
      r = qn_num_sqrt(c, b);
      assert_true(matches(r, y));
    }
    qn_arena_release(&c->arena, mark);
  }
  assert_int_equal(c->failed, QUOIN_OK);
  mpfr_clears(x, y, z, (mpfr_ptr)0);
  setup_free(&s);
}

/* Any rational, at 6000 bits; the values themselves from textbook forms, not from the reductions of the code. */
static void test_rational_arguments(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  uint64_t seed = 22;
  mpfr_t x, y, pi;
  mpq_t q, n;
  mpfr_inits2(HIGH, x, y, pi, (mpfr_ptr)0);
  mpq_inits(q, n, NULL);
  mpfr_const_pi(pi, MPFR_RNDN);
  mpfr_div_ui(pi, pi, 180, MPFR_RNDN);
  for (int round = 0; round < share_of(300); round++) {
    qn_mark mark = qn_arena_mark(&c->arena);
    qn_int num = random_int(c, &seed, 3), den = random_int(c, &seed, 3);
    if (!num.n || !den.n) {
      continue;
    }
    qn_num a = qn_num_from_rat(c, num, den, 0), m = qn_num_from_rat(c, qn_int_from(c, 1 + (int64_t)random_below(&seed, 50)), qn_int_from(c, 1 + (int64_t)random_below(&seed, 50)), 0);
    to_mpq(q, a);
    to_mpq(n, m);
    mpfr_set_q(x, q, MPFR_RNDN);
    mpfr_mul(x, x, pi, MPFR_RNDN);
    qn_num r = qn_num_sin(c, a);
    mpfr_sin(y, x, MPFR_RNDN);
    assert_true(matches(r, y));
    r = qn_num_sin_over_sqrt(c, a, m);
    mpfr_t root;
    mpfr_init2(root, HIGH);
    mpfr_set_q(root, n, MPFR_RNDN);
    mpfr_sqrt(root, root, MPFR_RNDN);
    mpfr_div(y, y, root, MPFR_RNDN);
    mpfr_clear(root);
    assert_true(matches(r, y));
    r = qn_num_cos(c, a);
    mpfr_cos(y, x, MPFR_RNDN);
    assert_true(matches(r, y));
    assert_true(!qn_num_tan(c, a, &r) || (mpfr_tan(y, x, MPFR_RNDN), matches(r, y)));
    mpfr_set_q(x, q, MPFR_RNDN);
    r = qn_num_atan(c, a);
    mpfr_atan(y, x, MPFR_RNDN);
    mpfr_div(y, y, pi, MPFR_RNDN);
    assert_true(matches(r, y));
    mpfr_abs(x, x, MPFR_RNDN);
    r = qn_num_ln(c, qn_num_abs(c, a));
    mpfr_log(y, x, MPFR_RNDN);
    assert_true(matches(r, y));
    r = qn_num_sqrt(c, qn_num_abs(c, a));
    mpfr_sqrt(y, x, MPFR_RNDN);
    assert_true(matches(r, y));
    qn_arena_release(&c->arena, mark);
  }
  /* exp and ln next to 1: thousands of bits agree before the value shows. */
  mpfr_set_ui_2exp(x, 1, -3000, MPFR_RNDN);
  qn_num tiny = qn_num_from_rat(c, qn_int_from(c, 1), qn_int_shl(c, qn_int_from(c, 1), 3000), 0);
  mpfr_exp(y, x, MPFR_RNDN);
  assert_true(nearest_to(qn_num_exp(c, tiny), y));
  mpfr_log1p(y, x, MPFR_RNDN);
  assert_true(nearest_to(qn_num_ln(c, qn_num_add(c, QN_NUM_ONE, tiny)), y));
  /* Next to a tie of 256 bits, and not on the side that ties to even would take: exp(z) = 1 + z + z^2/2 + ...,
     ln(1 + z) = z - z^2/2 + ..., sqrt(m^2 + z). */
  qn_int one = qn_int_from(c, 1), up = qn_int_shl(c, one, 256);
  qn_num above = qn_num_exp(c, qn_num_from_rat(c, one, up, 0));
  assert_true(qn_num_equal(above, qn_num_from_rat(c, qn_int_add(c, qn_int_shl(c, one, 255), one), qn_int_shl(c, one, 255), 1)));
  qn_int tie = qn_int_add(c, up, qn_int_from(c, 3)), deep = qn_int_shl(c, one, 1500);
  qn_num below = qn_num_ln(c, qn_num_from_rat(c, qn_int_add(c, deep, tie), deep, 0));
  assert_true(qn_num_equal(below, qn_num_from_rat(c, qn_int_add(c, up, qn_int_from(c, 2)), deep, 1)));
  tie = qn_int_add(c, up, one);
  qn_num root = qn_num_sqrt(c, qn_num_from_rat(c, qn_int_add(c, qn_int_shl(c, qn_int_mul(c, tie, tie), 1000), one), qn_int_shl(c, one, 1000), 0));
  assert_true(qn_num_equal(root, qn_num_from_rat(c, qn_int_add(c, up, qn_int_from(c, 2)), one, 1)));
  mpfr_const_pi(y, MPFR_RNDN);
  assert_true(nearest_to(qn_num_pi(c), y));
  assert_int_equal(c->failed, QUOIN_OK);
  mpq_clears(q, n, NULL);
  mpfr_clears(x, y, pi, (mpfr_ptr)0);
  setup_free(&s);
}

/* Design S2: what was computed in two ways is the same. */
static void test_two_ways(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  /* Two turns by 30 and 60 are one by 90; four by 22.5 too. */
  qn_num sa = qn_num_sin(c, qn_num_from_int(c, 30)), ca = qn_num_cos(c, qn_num_from_int(c, 30));
  qn_num sb = qn_num_sin(c, qn_num_from_int(c, 60)), cb = qn_num_cos(c, qn_num_from_int(c, 60));
  qn_num left[2] = {ca, qn_num_neg(c, sa)}, right[2] = {cb, sb};
  assert_true(qn_num_is_zero(qn_num_dot(c, 2, left, right)));
  qn_num s1 = qn_num_sin(c, ratio(c, 45, 2)), c1 = qn_num_cos(c, ratio(c, 45, 2));
  qn_num l[2] = {c1, s1}, r[2] = {c1, qn_num_neg(c, s1)}, x[2] = {s1, c1}, y[2] = {c1, s1};
  qn_num c2 = qn_num_dot(c, 2, l, r), s2 = qn_num_dot(c, 2, x, y);
  assert_int_equal(qn_num_cmp(c, c2, s2), 0);
  assert_true(qn_num_is_zero(qn_num_sub(c, qn_num_mul(c, c2, c2), qn_num_mul(c, s2, s2))));
  /* An angle that is 60 or 180 up to its rounding is that. */
  qn_num sixty = qn_num_atan(c, qn_num_sqrt(c, qn_num_from_int(c, 3)));
  assert_true(qn_num_equal(qn_num_cos(c, sixty), ratio(c, 1, 2)));
  qn_num straight = qn_num_add(c, qn_num_acos(c, ratio(c, 1, 3)), qn_num_acos(c, ratio(c, -1, 3)));
  assert_true(qn_num_is_zero(qn_num_sin(c, straight)));
  qn_num t;
  assert_int_equal(qn_num_tan(c, qn_num_mul(c, straight, ratio(c, 1, 2)), &t), 0);
  for (int k = -30; k <= 30; k++) { /* rounded(15 k + 2^-240) is 15 k; rounded(15 k + 2^-150) is not */
    for (int side = -1; side <= 1; side += 2) {
      qn_num exact = qn_num_from_int(c, 15 * k), u, v;
      for (size_t bits = 150; bits <= 240 && k; bits += 90) {
        qn_int down = qn_int_shl(c, qn_int_from(c, 1), bits);
        qn_int num = qn_int_add(c, qn_int_mul(c, qn_int_from(c, 15 * k), down), qn_int_from(c, side));
        qn_num near = qn_num_from_rat(c, num, down, 1);
        int same = bits == 240;
        assert_int_equal(qn_num_equal(qn_num_sin(c, near), qn_num_sin(c, exact)), same);
        assert_int_equal(qn_num_equal(qn_num_cos(c, near), qn_num_cos(c, exact)), same);
        assert_int_equal(qn_num_tan(c, near, &u), !same || k % 12 == 0 || k % 6 != 0);
        assert_int_equal(qn_num_tan(c, exact, &v), k % 12 == 0 || k % 6 != 0);
        assert_int_equal(qn_num_equal(u, v), same);
        qn_num su = qn_num_sin_over_sqrt(c, near, ratio(c, 3, 1)), sv = qn_num_sin_over_sqrt(c, exact, ratio(c, 3, 1));
        assert_int_equal(qn_num_equal(su, sv), same || k % 12 == 6 || k % 12 == -6); /* next to 90 degrees 1 - 2^-300 rounds to 1 */
      }
    }
  }
  qn_num almost = qn_num_sqrt(c, qn_num_add(c, qn_num_mul(c, s1, s1), qn_num_mul(c, c1, c1)));
  assert_true(qn_num_equal(qn_num_asin(c, almost), qn_num_from_int(c, 90)));
  assert_true(qn_num_is_zero(qn_num_ln(c, almost)));
  assert_true(qn_num_equal(qn_num_atan2(c, almost, qn_num_neg(c, almost)), qn_num_from_int(c, 135)));
  setup_free(&s);
}

static void test_refused_memory(void **unused) {
  (void)unused;
  int finished = 0;
  for (size_t k = 0; k < 200 && !finished; k++) {
    refusing r = {k, 0};
    setup s;
    setup_init(&s, &r);
    qn_ctx *c = &s.ctx;
    for (int i = 1; i < 200; i++) {
      qn_num a = ratio(c, i, 301), t;
      qn_num_sin(c, a);
      qn_num_tan(c, a, &t);
      qn_num_asin(c, a);
      qn_num_acos(c, a);
      qn_num_exp(c, a);
      qn_num_ln(c, a);
      qn_num_pow(c, a, ratio(c, 7, 11), &t);
      qn_num_sqrt(c, a);
      qn_num_pi(c);
      qn_num_sin_over_sqrt(c, a, ratio(c, 3, 7));
    }
    finished = c->failed == QUOIN_OK;
    assert_true(finished || c->failed == QUOIN_E_MEMORY);
    setup_free(&s);
    assert_int_equal(r.out, 0);
  }
  assert_true(finished);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_exact_values),       cmocka_unit_test(test_powers),   cmocka_unit_test(test_dyadic_degrees),
      cmocka_unit_test(test_rational_arguments), cmocka_unit_test(test_two_ways), cmocka_unit_test(test_refused_memory),
  };
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  mpfr_free_cache();
  return failed;
}
