/* Integers of design S2: exact ones stay exact; the size of the terms is never under the true one and seldom much over it. */
#include "numbers.h"

/* An expression computed twice: as qn_xint, and as its value and the sum of the magnitudes of its terms, in mpz. */
typedef struct pair { qn_xint x; mpz_t value, terms; int exact; } pair;

static void pair_set(pair *p, qn_xint x) {
  p->x = x;
  p->exact = x.mag == QN_EXACT;
  to_mpz(p->value, x.v);
  mpz_abs(p->terms, p->value);
}

static int expected_sign(const pair *p) {
  if (p->exact) {
    return mpz_sgn(p->value);
  }
  mpz_t up;
  mpz_init(up);
  mpz_mul_2exp(up, p->value, QN_S2_BITS);
  int under = mpz_cmpabs(up, p->terms) < 0;
  mpz_clear(up);
  return under ? 0 : mpz_sgn(p->value);
}

static void test_against_mpz(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  uint64_t seed = 31;
  pair p[6];
  mpz_t t;
  mpz_init(t);
  for (int i = 0; i < 6; i++) {
    mpz_inits(p[i].value, p[i].terms, NULL);
  }
  size_t exact = 0, zero = 0, certain = 0;
  for (int round = 0; round < 4000; round++) {
    qn_mark mark = qn_arena_mark(&c->arena);
    for (int i = 0; i < 6; i++) {
      qn_int v = random_int(c, &seed, 4);
      pair_set(&p[i], round % 4 == 0 || random_below(&seed, 2) || !v.n ? qn_x(v) : qn_x_rounded(v));
    }
    if (round % 3 == 0) { /* a neighbour, so that a difference cancels by 150 to 260 bits */
      qn_int v = qn_int_shl(c, qn_int_from(c, 3), 260);
      pair_set(&p[0], qn_x_rounded(v));
      pair_set(&p[1], qn_x_rounded(qn_int_add(c, v, qn_int_shl(c, qn_int_from(c, 1), random_below(&seed, 110)))));
    }
    int depth = 0; /* additions so far: each may loosen mag by a bit */
    pair *r = &p[0];
    for (int step = 1; step < 6; step++) {
      pair *b = &p[step];
      int64_t k = (int64_t)random_bits(&seed) >> random_below(&seed, 64);
      switch (step == 1 && round % 3 == 0 ? 1 : (int)random_below(&seed, 5)) {
        case 0:
          r->x = qn_x_add(c, r->x, b->x);
          mpz_add(r->value, r->value, b->value);
          mpz_add(r->terms, r->terms, b->terms);
          r->exact &= b->exact;
          depth++;
          break;
        case 1:
          r->x = qn_x_sub(c, r->x, b->x);
          mpz_sub(r->value, r->value, b->value);
          mpz_add(r->terms, r->terms, b->terms);
          r->exact &= b->exact;
          depth++;
          break;
        case 2: {
          int none = (r->exact && !mpz_sgn(r->value)) || (b->exact && !mpz_sgn(b->value));
          r->x = qn_x_mul(c, r->x, b->x);
          mpz_mul(r->value, r->value, b->value);
          mpz_mul(r->terms, r->terms, b->terms);
          r->exact = none || (r->exact && b->exact);
          depth += 2;
          break;
        }
        case 3:
          r->x = qn_x_scale(c, r->x, k);
          mpz_set_si(t, k);
          mpz_mul(r->value, r->value, t);
          mpz_abs(t, t);
          mpz_mul(r->terms, r->terms, t);
          r->exact |= k == 0;
          depth++;
          break;
        default:
          k = (int64_t)random_below(&seed, 200);
          r->x = qn_x_shl(c, qn_x_neg(r->x), (size_t)k);
          mpz_mul_2exp(r->value, r->value, (mp_bitcnt_t)k);
          mpz_neg(r->value, r->value);
          mpz_mul_2exp(r->terms, r->terms, (mp_bitcnt_t)k);
      }
      if (r->exact) { /* its terms are its value, once it is a term of something rounded */
        mpz_abs(r->terms, r->value);
      }
      assert_true(same_mpz(r->x.v, r->value));
      assert_int_equal(r->x.mag == QN_EXACT, r->exact);
      int sign = qn_x_sign(r->x);
      if (r->exact) {
        assert_int_equal(sign, mpz_sgn(r->value));
        exact++;
        continue;
      }
      /* mag bounds the terms from above, by no more than a bit for each rounded leaf and each addition */
      mpz_set_ui(t, 1);
      mpz_mul_2exp(t, t, (mp_bitcnt_t)r->x.mag);
      assert_true(mpz_cmp(r->terms, t) <= 0);
      if (mpz_sgn(r->terms)) {
        assert_true((int64_t)mpz_sizeinbase(r->terms, 2) + 2 * (depth + 6) >= r->x.mag);
      }
      /* a sign is never given to what S2 calls nothing; and never wrong */
      assert_true(sign == 0 || sign == mpz_sgn(r->value));
      assert_true(expected_sign(r) != 0 || sign == 0);
      zero += sign == 0 && mpz_sgn(r->value) != 0;
      certain += sign != 0;
    }
    qn_arena_release(&c->arena, mark);
  }
  assert_true(exact > 1000 && zero > 300 && certain > 1000);
  for (int i = 0; i < 6; i++) {
    mpz_clears(p[i].value, p[i].terms, NULL);
  }
  mpz_clear(t);
  setup_free(&s);
}

/* The threshold itself: |value| < 2^(mag - 200) is zero, 2^(mag - 200) is not. */
static void test_threshold(void **unused) {
  (void)unused;
  setup s;
  setup_init(&s, NULL);
  qn_ctx *c = &s.ctx;
  qn_int one = qn_int_from(c, 1), edge = qn_int_shl(c, one, 56);
  assert_int_equal(qn_x_sign((qn_xint){edge, 256}), 1);
  assert_int_equal(qn_x_sign((qn_xint){qn_int_neg(edge), 256}), -1);
  assert_int_equal(qn_x_sign((qn_xint){qn_int_sub(c, edge, one), 256}), 0);
  assert_int_equal(qn_x_sign((qn_xint){one, 199}), 1);
  assert_int_equal(qn_x_sign((qn_xint){qn_int_sub(c, one, one), 5}), 0);
  qn_xint nothing = qn_x_mul(c, qn_x(qn_int_sub(c, one, one)), qn_x_rounded(edge));
  assert_true(nothing.mag == QN_EXACT && nothing.v.n == 0);
  assert_true(qn_x_scale(c, qn_x_rounded(edge), 0).mag == QN_EXACT);
  assert_true(qn_x_add(c, nothing, qn_x_rounded(edge)).mag == 57); /* an exact zero is no term */
  setup_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_against_mpz), cmocka_unit_test(test_threshold)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
