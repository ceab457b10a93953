/* The bounds of wide/newton.h in rationals, in its baseline body (whose fused operations round twice: the worst of the bodies): the
   computed p, p' and a against their exact values, on surfaces and lines biased towards cancellation. Names as in base/bounds.h. */
#include "dice.h"
#include "share.h"
#include "wide/newton.h"

#include <gmp.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* A double of magnitude about 2^low .. 2^high, with few or many bits. */
static double number(int low, int high) {
  double m = (double)(next() >> 11) * 0x1p-53 + 0.5;
  if (one_in(4)) {
    m = ldexp(floor(ldexp(m, 4)), -4);
  }
  return (next() & 1 ? -1 : 1) * ldexp(m, low + (int)(next() % (uint64_t)(high - low + 1)));
}

static const int PAIR[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

/* The truth for one lane: K the coefficients, y the place, and p, p', a. */
typedef struct truth { mpq_t K[10], y[3], d[3], p, slope, a, x, z; } truth;
static truth T;
static void all(void (*f)(mpq_ptr)) {
  mpq_t *first = T.K;
  for (size_t i = 0; i < sizeof T / sizeof *first; i++) {
    f(((mpq_t *)(void *)&T)[i]);
  }
}

static void sum_product(mpq_t sum, const mpq_t a, const mpq_t b, const mpq_t c) {
  mpq_mul(T.z, a, b);
  mpq_mul(T.z, T.z, c);
  mpq_add(sum, sum, T.z);
}

/* sum = v + low, and 2^-104 of v either way where it has a low part. */
static void exact_number(mpq_t sum, double v, double low) {
  mpq_set_d(sum, v);
  if (low != 0) {
    mpq_set_d(T.x, v);
    mpq_div_2exp(T.x, T.x, 104);
    (next() & 1 ? mpq_add : mpq_sub)(sum, sum, T.x);
    mpq_set_d(T.x, low);
    mpq_add(sum, sum, T.x);
  }
}

/* low: of o and of d, or all zeros. */
static void exact_place(const double o[3], const double d[3], const double low[6], const double pivot[3], double t) {
  for (int j = 0; j < 3; j++) {
    exact_number(T.d[j], d[j], low[3 + j]);
    mpq_set_d(T.x, t);
    mpq_mul(T.y[j], T.d[j], T.x);
    exact_number(T.z, o[j], low[j]);
    mpq_add(T.y[j], T.y[j], T.z);
    mpq_set_d(T.x, pivot[j]);
    mpq_sub(T.y[j], T.y[j], T.x);
  }
}

static void exact_values(void) {
  mpq_set_si(T.x, 1, 1);
  mpq_set(T.p, T.K[9]);
  mpq_set_si(T.slope, 0, 1);
  mpq_set_si(T.a, 0, 1);
  for (int j = 0; j < 3; j++) {
    sum_product(T.p, T.K[6 + j], T.y[j], T.x);
    sum_product(T.slope, T.K[6 + j], T.d[j], T.x);
  }
  for (int i = 0; i < 6; i++) {
    int a = PAIR[i][0], b = PAIR[i][1];
    sum_product(T.p, T.K[i], T.y[a], T.y[b]);
    sum_product(T.slope, T.K[i], T.y[a], T.d[b]);
    sum_product(T.slope, T.K[i], T.d[a], T.y[b]);
    sum_product(T.a, T.K[i], T.d[a], T.d[b]);
  }
}

/* (|computed - exact| - own) / bound, at most 1. */
static double ratio(double computed, const mpq_t exact, double own, double bound) {
  mpq_set_d(T.x, computed);
  mpq_sub(T.x, T.x, exact);
  mpq_abs(T.x, T.x);
  mpq_set_d(T.z, own);
  mpq_sub(T.x, T.x, T.z);
  mpq_set_d(T.z, bound);
  assert_true(mpq_cmp(T.x, T.z) <= 0);
  if (mpq_sgn(T.z) == 0) {
    return 0;
  }
  mpq_div(T.x, T.x, T.z);
  return mpq_get_d(T.x);
}

/* k = hi + lo with its exact value, which it is within 2^-104 of. */
static void coefficient(int i, int low, double k[QN_ROUNDING_NUMBERS]) {
  double hi = number(low, 0) / 2, lo = one_in(5) ? 0 : hi * number(-60, -54);
  double sum = hi + lo;
  k[QN_ROUNDING_LO + i] = lo - (sum - hi);
  k[QN_ROUNDING_HI + i] = sum;
  mpq_set_d(T.K[i], sum);
  mpq_set_d(T.x, k[QN_ROUNDING_LO + i]);
  mpq_add(T.K[i], T.K[i], T.x);
  mpq_set_d(T.x, one_in(3) ? 0 : number(0, 0));
  mpq_mul(T.x, T.x, T.K[i]);
  mpq_div_2exp(T.x, T.x, 104);
  mpq_add(T.K[i], T.K[i], T.x);
}

typedef struct census { unsigned sound, unsound, planes, mixed, near, dropped, pairs; double p, slope, a; } census;

static void one_vector(census *c) {
  _Alignas(64) double k[QN_ROUNDING_NUMBERS] = {0}, o[3][QN_W], d[3][QN_W], t[QN_W];
  const int pairs = one_in(3); /* o and d have low parts */
  _Alignas(64) double low_parts[6][QN_W];
  surface_numbers f = {{k}, 0, 0, 1, pairs}, each = {{NULL}, 1023, 7, 0, pairs}; /* each: every term there, the missing ones as zeros */
  c->pairs += (unsigned)pairs;
  int plane = one_in(4), mixed = !plane && one_in(2), linear = plane || one_in(2), sphere = !plane && !mixed && one_in(2);
  int low = one_in(3) ? -40 : -4, scale = one_in(5) ? 40 : one_in(3) ? 20 : 3, far = one_in(4) ? (int)(next() % 38) : scale;
  scale = far < scale ? far : scale;
  c->planes += (unsigned)plane, c->mixed += (unsigned)mixed;
  for (int i = 0; i < 10; i++) {
    int there = i < 3 ? !plane && !one_in(4) : i < 6 ? mixed && !one_in(3) : i < 9 ? linear && !one_in(3) : !one_in(4);
    mpq_set_si(T.K[i], 0, 1);
    if (there && (sphere ? i == 0 || i > 2 : 1)) {
      coefficient(i, low, k);
    }
    if (sphere && (i == 1 || i == 2)) {
      k[QN_ROUNDING_HI + i] = k[QN_ROUNDING_HI], k[QN_ROUNDING_LO + i] = k[QN_ROUNDING_LO];
      mpq_set(T.K[i], T.K[0]);
    }
    if (!there && one_in(8) && (i >= 6 || !plane) && (i >= 3 || !sphere)) { /* below what is kept */
      mpq_set_si(T.K[i], next() & 1 ? 1 : -1, 1);
      mpq_div_2exp(T.K[i], T.K[i], -QN_ROUND_DROP);
      c->dropped++;
    }
  }
  double pivot[3];
  for (int j = 0; j < 3; j++) {
    pivot[j] = k[QN_ROUNDING_PIVOT + j] = one_in(3) ? 0 : number(-3, one_in(3) ? 30 : scale);
  }
  for (int lane = 0; lane < QN_W; lane++) {
    t[lane] = number(-3, far);
    for (int j = 0; j < 3; j++) { /* towards a place near the pivot, so that o - c and t d cancel */
      d[j][lane] = one_in(6) ? 0 : number(-2, 2);
      o[j][lane] = one_in(8) ? number(-160, -60) : pivot[j] + number(-3, scale) - t[lane] * d[j][lane];
    }
    if (one_in(20)) {
      t[lane] = number(-200, -50);
    }
    for (int j = 0; j < 6; j++) {
      double v = (j < 3 ? o[j] : d[j - 3])[lane];
      low_parts[j][lane] = pairs && !one_in(4) ? v * number(-1, 0) * QN_U : 0;
    }
  }
  if (one_in(2) && k[QN_ROUNDING_HI + 9] != 0) { /* the constant so that the place of lane 0 is on the surface, as nearly as it can be */
    const double at[3] = {o[0][0], o[1][0], o[2][0]}, way[3] = {d[0][0], d[1][0], d[2][0]};
    const double low0[6] = {low_parts[0][0], low_parts[1][0], low_parts[2][0], low_parts[3][0], low_parts[4][0], low_parts[5][0]};
    exact_place(at, way, low0, pivot, t[0]);
    mpq_set_si(T.K[9], 0, 1);
    exact_values();
    mpq_neg(T.p, T.p);
    double hi = mpq_get_d(T.p);
    if (fabs(hi) <= 1 && (hi == 0 || fabs(hi) > 0x1p-200)) {
      mpq_set(T.K[9], T.p);
      mpq_set_d(T.x, hi);
      mpq_sub(T.p, T.p, T.x);
      double lo = mpq_get_d(T.p), sum = hi + lo;
      k[QN_ROUNDING_HI + 9] = sum, k[QN_ROUNDING_LO + 9] = lo - (sum - hi);
      c->near++;
    } else {
      mpq_set_d(T.K[9], k[QN_ROUNDING_HI + 9]);
      mpq_set_d(T.x, k[QN_ROUNDING_LO + 9]);
      mpq_add(T.K[9], T.K[9], T.x);
    }
  }
  double most[3] = {0, 0, 0};
  for (int i = 0; i < 10; i++) {
    int degree = i < 6 ? 2 : i < 9 ? 1 : 0;
    double v = k[QN_ROUNDING_HI + i];
    most[degree] = fmax(most[degree], fabs(v));
    f.terms |= (unsigned)(v != 0) << i;
    if (mpq_sgn(T.K[i])) {
      f.axes |= degree == 2 ? 1u << PAIR[i][0] | 1u << PAIR[i][1] : degree == 1 ? 1u << (i - 6) : 0;
    }
  }
  if (!plane && most[2] == 0) {
    return; /* scene/rounding.c calls it unsound */
  }
  k[QN_ROUNDING_SQUARE] = plane ? 0 : most[2] + QN_ROUND_SQUARE_TINY;
  k[QN_ROUNDING_LINEAR] = most[1] + QN_ROUND_LINEAR_TINY;
  k[QN_ROUNDING_CONSTANT] = most[0] + QN_ROUND_TINY;

  _Alignas(64) double p[2][QN_W], slope[QN_W], pe[QN_W], se[QN_W], a[QN_W];
  for (int lane = 0; lane < QN_W; lane++) {
    each.k[lane] = k;
  }
  rough_places at = {.t = vload(t), .e = vset(0)};
  for (int j = 0; j < 3; j++) {
    at.o[j] = vload(o[j]), at.d[j] = vload(d[j]), at.olow[j] = vload(low_parts[j]), at.dlow[j] = vload(low_parts[3 + j]);
  }
  residual r = residual_at(&f, &at), all_terms = residual_at(&each, &at);
  vstore(p[0], r.p), vstore(p[1], all_terms.p), vstore(slope, r.slope);
  vstore(pe, r.p_error), vstore(se, r.slope_error), vstore(a, r.curve);
  unsigned sound = vbits(r.sound);
  for (int lane = 0; lane < QN_W; lane++) {
    if (!(sound >> lane & 1)) {
      c->unsound++;
      continue;
    }
    c->sound++;
    const double from[3] = {o[0][lane], o[1][lane], o[2][lane]}, way[3] = {d[0][lane], d[1][lane], d[2][lane]};
    const double rest[6] = {low_parts[0][lane], low_parts[1][lane], low_parts[2][lane], low_parts[3][lane], low_parts[4][lane], low_parts[5][lane]};
    exact_place(from, way, rest, pivot, t[lane]);
    exact_values();
    for (int i = 0; i < 2; i++) {
      c->p = fmax(c->p, ratio(p[i][lane], T.p, QN_U * fabs(p[i][lane]), QN_SLACK * pe[lane])); /* QN_ROUND_EVAL, QN_ROUND_PAIR_EVAL, and the tiny sizes */
    }
    c->slope = fmax(c->slope, ratio(slope[lane], T.slope, 0, QN_SLACK * se[lane])); /* QN_ROUND_SLOPE */
    mpq_abs(T.a, T.a);
    c->a = fmax(c->a, ratio(0, T.a, 0, QN_SLACK * a[lane]));
  }
}

static void test_bounds(void **state) {
  (void)state;
  census c = {0};
  all(mpq_init);
  for (int n = 0; n < share_of(40000); n++) {
    one_vector(&c);
  }
  all(mpq_clear);
  print_message("error/bound: p %.4f, slope %.4f, a %.4f; %u sound, %u not, %u planes, %u mixed, %u near, %u dropped\n", c.p, c.slope,
                c.a, c.sound, c.unsound, c.planes, c.mixed, c.near, c.dropped);
  assert_true(c.sound > share_min(50000) && c.unsound > share_min(50) && c.planes > share_min(5000) && c.mixed > share_min(5000) && c.near > share_min(2000) && c.dropped > share_min(5000) && c.pairs > share_min(10000));
  assert_true(!share_whole() || (c.p > 0.01 && c.slope > 0.02 && c.a > 0.5)); /* the data come near what the bounds allow for */
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_bounds)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
