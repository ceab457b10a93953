/* Refinement: which pixels are chosen, and that the pattern is stratified. */
#include "image/refine.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { W = 6, H = 5, ROW = 4 * W + 8 };

static void only_pixels_at_a_surface_edge(void **state) {
  (void)state;
  unsigned char pixels[H * ROW];
  uint64_t surfaces[W * H];
  memset(pixels, 77, sizeof pixels);
  memset(surfaces, 0, sizeof surfaces);
  surfaces[2 * W + 3] = 5;
  const qn_first_pass pass = {W, H, ROW, pixels, surfaces};
  for (size_t y = 0; y < H; y++) {
    for (size_t x = 0; x < W; x++) {
      const int dx = abs((int)x - 3), dy = abs((int)y - 2);
      assert_int_equal(qn_refine_needed(&pass, x, y), dx + dy <= 1);
    }
  }
}

/* A step of the threshold is no edge, one level more is, in any component; alpha and the bytes between rows do not count. */
static void light_threshold(void **state) {
  (void)state;
  for (size_t c = 0; c < 4; c++) {
    for (int step = -QN_REFINE_LEVELS - 1; step <= QN_REFINE_LEVELS + 1; step++) {
      unsigned char pixels[H * ROW];
      uint64_t surfaces[W * H];
      for (size_t i = 0; i < sizeof pixels; i++) {
        pixels[i] = i % ROW < 4 * W ? 100 : (unsigned char)(i * 37);
      }
      memset(surfaces, 0, sizeof surfaces);
      pixels[0 * ROW + 4 * (W - 1) + c] = (unsigned char)(100 + step); /* the top right corner */
      const qn_first_pass pass = {W, H, ROW, pixels, surfaces};
      const int edge = c < 3 && abs(step) > QN_REFINE_LEVELS;
      assert_int_equal(qn_refine_needed(&pass, W - 1, 0), edge);
      assert_int_equal(qn_refine_needed(&pass, W - 2, 0), edge);
      assert_int_equal(qn_refine_needed(&pass, W - 1, 1), edge);
      assert_int_equal(qn_refine_needed(&pass, W - 2, 1), 0);
      assert_int_equal(qn_refine_needed(&pass, 0, 0), 0);
    }
  }
}

static void sides(void **state) {
  (void)state;
  assert_int_equal(qn_refine_side(0), 0);
  assert_int_equal(qn_refine_side(1), 1);
  assert_int_equal(qn_refine_side(2), 0);
  assert_int_equal(qn_refine_side(15), 0);
  assert_int_equal(qn_refine_side(16), 4);
  assert_int_equal(qn_refine_side(4294836225u), 65535);
  assert_int_equal(qn_refine_side(4294967295u), 0);
}

/* One sample in each cell of n x n, in each of the n^2 columns, in each of the n^2 rows, and their mean is the pixel's
   centre. */
static void pattern_is_stratified(void **state) {
  (void)state;
  for (unsigned n = 1; n <= 9; n++) {
    unsigned char cell[81] = {0}, column[81] = {0}, row[81] = {0};
    double sum_x = 0, sum_y = 0;
    for (unsigned k = 0; k < n * n; k++) {
      double x, y;
      qn_refine_place(n, k, &x, &y);
      assert_true(x > 0 && x < 1 && y > 0 && y < 1);
      cell[(unsigned)(y * n) * n + (unsigned)(x * n)]++;
      column[(unsigned)(x * n * n)]++;
      row[(unsigned)(y * n * n)]++;
      sum_x += x, sum_y += y;
    }
    for (unsigned k = 0; k < n * n; k++) {
      assert_true(cell[k] == 1 && column[k] == 1 && row[k] == 1);
    }
    const double off = n * n * 0x1p-50; /* roundings of the sum */
    assert_true(sum_x / (n * n) - 0.5 < off && 0.5 - sum_x / (n * n) < off && sum_y / (n * n) - 0.5 < off && 0.5 - sum_y / (n * n) < off);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(only_pixels_at_a_surface_edge), cmocka_unit_test(light_threshold),
                                     cmocka_unit_test(sides),
                                     cmocka_unit_test(pattern_is_stratified)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
