/* Refinement: which pixels are chosen, and followed, and that the pattern is stratified. */
#include "image/refine.h"

#include <setjmp.h>
#include <stdarg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { W = 6, H = 5, ROW = 4 * W + 8 };

/* Marks the whole picture, in rectangles as tiles of a picture are. */
static void mark_all(const qn_first_pass *pass, unsigned char marks[W * H]) {
  memset(marks, 77, W * H);
  static const size_t cuts[2][4] = {{0, 2, 3, W}, {0, 1, 4, H}};
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      qn_refine_mark(pass, cuts[0][i], cuts[1][j], cuts[0][i + 1], cuts[1][j + 1], marks);
    }
  }
}

static void only_pixels_at_a_surface_edge(void **state) {
  (void)state;
  unsigned char pixels[H * ROW];
  uint32_t surfaces[W * H];
  memset(pixels, 77, sizeof pixels);
  memset(surfaces, 0, sizeof surfaces);
  surfaces[2 * W + 3] = 5;
  const qn_first_pass pass = {W, H, ROW, pixels, surfaces};
  unsigned char marks[W * H];
  mark_all(&pass, marks);
  for (size_t y = 0; y < H; y++) {
    for (size_t x = 0; x < W; x++) {
      const int dx = abs((int)x - 3), dy = abs((int)y - 2);
      assert_int_equal(marks[y * W + x], dx + dy <= 1 ? QN_REFINE_WANTED : 0);
    }
  }
}

/* A step of the threshold is no edge, one level more is, in any component; alpha and the bytes between rows do not count. */
static void light_threshold(void **state) {
  (void)state;
  for (size_t c = 0; c < 4; c++) {
    for (int step = -QN_REFINE_LEVELS - 1; step <= QN_REFINE_LEVELS + 1; step++) {
      unsigned char pixels[H * ROW];
      uint32_t surfaces[W * H];
      for (size_t i = 0; i < sizeof pixels; i++) {
        pixels[i] = i % ROW < 4 * W ? 100 : (unsigned char)(i * 37);
      }
      memset(surfaces, 0, sizeof surfaces);
      pixels[0 * ROW + 4 * (W - 1) + c] = (unsigned char)(100 + step); /* the top right corner */
      const qn_first_pass pass = {W, H, ROW, pixels, surfaces};
      unsigned char marks[W * H];
      mark_all(&pass, marks);
      const int edge = c < 3 && abs(step) > QN_REFINE_LEVELS;
      assert_int_equal(marks[0 * W + W - 1], edge);
      assert_int_equal(marks[0 * W + W - 2], edge);
      assert_int_equal(marks[1 * W + W - 1], edge);
      assert_int_equal(marks[1 * W + W - 2], 0);
      assert_int_equal(marks[0 * W + 0], 0);
    }
  }
}

/* Whatever the rectangles: a pixel is wanted when it differs from a neighbour, over random pictures of few colours. */
static void rectangles_do_not_show(void **state) {
  (void)state;
  srand(3);
  for (int round = 0; round < 200; round++) {
    unsigned char pixels[H * ROW], marks[W * H];
    uint32_t surfaces[W * H];
    for (size_t i = 0; i < sizeof pixels; i++) {
      pixels[i] = (unsigned char)(100 + (rand() % 8 == 0 ? 9 : rand() % 9));
    }
    for (size_t i = 0; i < W * H; i++) {
      surfaces[i] = rand() % 10 == 0;
    }
    const qn_first_pass pass = {W, H, ROW, pixels, surfaces};
    mark_all(&pass, marks);
    for (int y = 0; y < H; y++) {
      for (int x = 0; x < W; x++) {
        int wanted = 0;
        for (int side = 0; side < 4; side++) {
          const int u = x + (const int[]){-1, 1, 0, 0}[side], v = y + (const int[]){0, 0, -1, 1}[side];
          if (u < 0 || v < 0 || u >= W || v >= H) {
            continue;
          }
          wanted |= surfaces[y * W + x] != surfaces[v * W + u];
          for (int c = 0; c < 3; c++) {
            wanted |= abs(pixels[y * ROW + 4 * x + c] - pixels[v * ROW + 4 * u + c]) > QN_REFINE_LEVELS;
          }
        }
        assert_int_equal(marks[y * W + x], wanted ? QN_REFINE_WANTED : 0);
      }
    }
  }
}

/* What lies beyond a side that shows something becomes wanted, unless it is marked already. */
static void features_are_followed(void **state) {
  (void)state;
  static const struct { unsigned side; int dx, dy; } ways[] = {{QN_REFINE_LEFT, -1, 0}, {QN_REFINE_RIGHT, 1, 0}, {QN_REFINE_TOP, 0, -1}, {QN_REFINE_BOTTOM, 0, 1}};
  const qn_first_pass pass = {.width = W, .height = H};
  for (int way = 0; way < 4; way++) {
    for (int y = 0; y < H; y++) {
      for (int x = 0; x < W; x++) {
        unsigned char side_of[W * H] = {0}, marks[W * H] = {0}, before[W * H];
        side_of[y * W + x] = (unsigned char)ways[way].side;
        const int u = x + ways[way].dx, v = y + ways[way].dy, inside = u >= 0 && v >= 0 && u < W && v < H;
        for (int done = 0; done < 2; done++) {
          memset(marks, 0, sizeof marks);
          if (done && inside) {
            marks[v * W + u] = QN_REFINE_DONE;
          }
          memcpy(before, marks, sizeof marks);
          size_t count = qn_refine_follow(&pass, 0, 0, 3, H, side_of, marks);
          count += qn_refine_follow(&pass, 3, 0, W, H, side_of, marks);
          assert_int_equal(count, inside && !done);
          if (inside && !done) {
            before[v * W + u] = QN_REFINE_WANTED;
          }
          assert_memory_equal(marks, before, sizeof marks);
        }
      }
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
  assert_int_equal(qn_refine_side(65536), 256);
  assert_int_equal(qn_refine_side(257 * 257), 0);
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
      const unsigned i = (unsigned)(x * n), j = (unsigned)(y * n);
      assert_int_equal(qn_refine_sides(n, k), (i == 0 ? QN_REFINE_LEFT : 0) | (i == n - 1 ? QN_REFINE_RIGHT : 0) | (j == 0 ? QN_REFINE_TOP : 0) |
                                                (j == n - 1 ? QN_REFINE_BOTTOM : 0));
      assert_int_equal((i == 0 || i == n - 1) && (j == 0 || j == n - 1), k < qn_refine_corners(n)); /* corners first */
      cell[j * n + i]++;
      column[(unsigned)(x * n * n)]++;
      row[(unsigned)(y * n * n)]++;
      sum_x += x, sum_y += y;
    }
    for (unsigned k = 0; k < n * n; k++) {
      assert_true(cell[k] == 1 && column[k] == 1 && row[k] == 1);
    }
    /* Along a diagonal too the samples are met by few at a time: the n^2 of them at half as many places at least. */
    for (int way = -1; way <= 1; way += 2) {
      unsigned places = 0;
      for (unsigned k = 0; k < n * n; k++) {
        unsigned first = 1;
        double x, y, u, v;
        qn_refine_place(n, k, &x, &y);
        for (unsigned m = 0; m < k; m++) {
          qn_refine_place(n, m, &u, &v);
          first &= fabs((x + way * y) - (u + way * v)) > 1e-9;
        }
        places += first;
      }
      assert_true(2 * places >= n * n);
    }
    const double off = n * n * 0x1p-50; /* roundings of the sum */
    assert_true(sum_x / (n * n) - 0.5 < off && 0.5 - sum_x / (n * n) < off && sum_y / (n * n) - 0.5 < off && 0.5 - sum_y / (n * n) < off);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(only_pixels_at_a_surface_edge), cmocka_unit_test(light_threshold),
                                     cmocka_unit_test(rectangles_do_not_show), cmocka_unit_test(features_are_followed),
                                     cmocka_unit_test(sides),
                                     cmocka_unit_test(pattern_is_stratified)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
