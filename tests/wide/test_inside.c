/* QN_POINT_BALL_E and QN_POINT_BOX_SLACK in rationals: what is called sure of a point and a piece is so, with every stored number as far off as its
   contract allows; and the bounds bite: values within them do come out on the wrong side. (Planes and quadrics: tests/query/test_bounds.c
   for the bounds, tests/query/test_points.c for their use.) */
#include "dice.h"
#include "share.h"
#include "wide/inside.h"

#include <gmp.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* In [-1, 1], with few or many bits, of any size down to 2^-range. */
static double part(int range) {
  double v = ldexp((double)(int64_t)next() * 0x1p-63, -below(range));
  return below(3) ? v : ldexp(floor(ldexp(v, 5)), -5);
}

/* out = v + theta e, theta in [-1, 1], mostly at an end. */
static void nearby(mpq_t out, double v, mpq_t e) {
  mpq_t f;
  mpq_init(f);
  mpq_set_si(f, below(3) ? (below(2) ? 1 : -1) : below(2001) - 1000, 1);
  if (mpz_cmpabs_ui(mpq_numref(f), 1) > 0) {
    mpq_set_ui(out, 1000, 1);
    mpq_div(f, f, out);
  }
  mpq_mul(f, f, e);
  mpq_set_d(out, v);
  mpq_add(out, out, f);
  mpq_clear(f);
}

static void units(mpq_t out, double n, double of) { /* n u |of| */
  mpq_t w;
  mpq_init(w);
  mpq_set_d(out, n * QN_U);
  mpq_set_d(w, fabs(of));
  mpq_mul(out, out, w);
  mpq_clear(w);
}

typedef struct census { size_t in, out, open, crossed; } census; /* crossed: the computed value has not the true sign */

static void balls(void **state) {
  (void)state;
  census c = {0};
  mpq_t e, x, y, sum;
  mpq_inits(e, x, y, sum, NULL);
  for (int round = 0; round < share_of(200000); round++) {
    int range = below(3) ? 4 : 40;
    qn_piece_sphere s = {.off = below(2) ? 0 : (float)(fabs(part(range)) * 0x1p-53)};
    double at[3];
    qn_wide_point p = {at, 0};
    double square = 0;
    for (int i = 0; i < 3; i++) {
      s.centre[i] = part(range);
      at[i] = below(3) ? part(range) : s.centre[i] + part(range) * 0x1p-20;
      square += (p.x[i] - s.centre[i]) * (p.x[i] - s.centre[i]);
    }
    p.weight = below(2) ? 0 : fmax(fmax(fabs(p.x[0]), fabs(p.x[1])), fabs(p.x[2]));
    s.r2 = below(4) ? square * (1 + (below(41) - 20) * QN_U) : fabs(part(range)) + 0x1p-60;
    if (!(s.r2 > 0)) {
      continue;
    }
    mpq_set_ui(sum, 0, 1);
    for (int i = 0; i < 3; i++) {
      units(e, 1, p.weight);
      nearby(x, p.x[i], e);
      mpq_set_d(e, s.off);
      nearby(y, s.centre[i], e);
      mpq_sub(x, x, y);
      mpq_mul(x, x, x);
      mpq_add(sum, sum, x);
    }
    units(e, 8 * (1 - 0x1p-40), s.r2); /* relative to the true one: within that of the stored one */
    nearby(y, s.r2, e);
    int truth = mpq_cmp(sum, y);
    unsigned verdict = in_sphere(&s, p);
    assert_true(verdict != QN_SURELY_IN || truth < 0);
    assert_true(verdict != QN_SURELY_OUT || truth > 0);
    c.in += verdict == QN_SURELY_IN, c.out += verdict == QN_SURELY_OUT, c.open += verdict == QN_NOT_SURE;
    double y0 = p.x[0] - s.centre[0], y1 = p.x[1] - s.centre[1], y2 = p.x[2] - s.centre[2], off = s.off + QN_U * p.weight;
    double value = ((y0 * y0 + y1 * y1) + y2 * y2) - s.r2;
    double third = (QN_POINT_BALL_E * (value + 2 * s.r2) + off * (3 * ((fabs(y0) + fabs(y1)) + fabs(y2)) + 4 * off)) / 3;
    c.crossed += (value > third && truth < 0) || (value < -third && truth > 0);
  }
  print_message("balls: %zu in, %zu out, %zu not sure; wrong with a third of the bound: %zu\n", c.in, c.out, c.open, c.crossed);
  assert_true(c.in > share_min(20000) && c.out > share_min(20000) && c.open > share_min(20000) && c.crossed > share_min(500));
  mpq_clears(e, x, y, sum, NULL);
}

static void boxes(void **state) {
  (void)state;
  census c = {0};
  mpq_t e, x, lo, hi;
  mpq_inits(e, x, lo, hi, NULL);
  for (int round = 0; round < share_of(200000); round++) {
    qn_piece_box b = {.off = below(3) ? fabs(part(60)) * 0x1p-50 : 0};
    double at[3];
    qn_wide_point p = {at, 0};
    if (below(2)) {
      p.weight = fabs(part(30));
    }
    double near = b.off + QN_U * p.weight;
    for (int i = 0; i < 3; i++) {
      b.lo[i] = part(30);
      b.hi[i] = b.lo[i] + 1.5 * fabs(part(30)) + 0x1p-50;
      double face = below(2) ? b.lo[i] : b.hi[i];
      at[i] = below(8) == 0 ? part(30) : below(2) ? 0.5 * (b.lo[i] + b.hi[i]) : face + near * (1 + (below(9) - 4) * 0x1p-6) * (below(2) ? 1 : -1);
    }
    int truth = 1; /* of its depth: the least sign */
    for (int i = 0; i < 3; i++) {
      units(e, 1, p.weight);
      nearby(x, p.x[i], e);
      mpq_set_d(e, b.off);
      nearby(lo, b.lo[i], e);
      nearby(hi, b.hi[i], e);
      int low = mpq_cmp(x, lo), high = mpq_cmp(hi, x), least = low < high ? low : high;
      least = (least > 0) - (least < 0);
      truth = least < truth ? least : truth;
    }
    unsigned verdict = in_box(&b, p);
    assert_true(verdict != QN_SURELY_IN || truth > 0);
    assert_true(verdict != QN_SURELY_OUT || truth < 0);
    c.in += verdict == QN_SURELY_IN, c.out += verdict == QN_SURELY_OUT, c.open += verdict == QN_NOT_SURE;
    double depth = INFINITY;
    for (int i = 0; i < 3; i++) {
      depth = fmin(depth, fmin(p.x[i] - b.lo[i], b.hi[i] - p.x[i]));
    }
    c.crossed += (depth > 0.9 * near && truth < 0) || (depth < -0.9 * near && truth > 0);
  }
  print_message("boxes: %zu in, %zu out, %zu not sure; wrong with nine tenths of the bound: %zu\n", c.in, c.out, c.open, c.crossed);
  assert_true(c.in > share_min(5000) && c.out > share_min(20000) && c.open > share_min(20000) && c.crossed > share_min(500));
  mpq_clears(e, x, lo, hi, NULL);
}

/* On a face, a sphere, in the middle; beyond the bounds' range nothing is sure. */
static void known(void **state) {
  (void)state;
  qn_piece_sphere s = {.centre = {1, 0, 0}, .r2 = 25};
  qn_piece_box b = {.lo = {0, 0, 0}, .hi = {1, 2, 3}};
  const double at[4][3] = {{4, 4, 0}, {1, 1, 1}, {0x1p+100, 0x1p+100, -0x1p+100}, {0.5, 2, 1}};
  const qn_wide_point on = {at[0], 0}, middle = {at[1], 0}, far = {at[2], 0x1p+100}, face = {at[3], 0};
  assert_int_equal(in_sphere(&s, on), QN_NOT_SURE);
  assert_int_equal(in_sphere(&s, middle), QN_SURELY_IN);
  assert_int_equal(in_sphere(&s, far), QN_SURELY_OUT);
  assert_int_equal(in_box(&b, face), QN_NOT_SURE);
  assert_int_equal(in_box(&b, far), QN_SURELY_OUT);
  const double huge[4] = {0x1p+300, 0, 0, 0}, flat[4] = {0, 0, 1, -1};
  const double pivot[3] = {0, 0, 0};
  framed f = frame_of(pivot, middle);
  assert_int_equal(in_plane(huge, &f), QN_NOT_SURE);
  assert_int_equal(in_plane(flat, &f), QN_NOT_SURE); /* on it */
  f.y[2] = f.w[2] = 0.5;
  assert_int_equal(in_plane(flat, &f), QN_SURELY_IN);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(balls), cmocka_unit_test(boxes), cmocka_unit_test(known)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
