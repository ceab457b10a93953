/* Antialiasing where it shows: one sample at the centre of every pixel first; then, where neighbours differ, up to n x n samples and their mean,
   which is a box filter over the pixel.

   The pattern is fixed and stratified: sample (i, j) lies in cell (i, j) of n x n, at ((i + (j + 1/2)/n)/n, (j + (n - 1 - i + 1/2)/n)/n): a square
   grid turned by atan(1/n). Each of the n^2 columns of width 1/n^2 holds one sample, and each row, so edges near the vertical and the horizontal
   get n^2 levels of grey, and a diagonal edge meets them one by one too. (Sheared to the other side, with i in place of n - 1 - i, the
   samples stand in rows along one diagonal: twice the error at 16 samples.) No random number: the picture is a function of the scene alone. */
#include "image/refine.h"

#include <stdlib.h>
#include <string.h>

static int far_apart(const unsigned char *a, const unsigned char *b) {
  return abs(a[0] - b[0]) > QN_REFINE_LEVELS || abs(a[1] - b[1]) > QN_REFINE_LEVELS || abs(a[2] - b[2]) > QN_REFINE_LEVELS;
}

/* Two pixels: their surfaces and where their colours are. */
static int differ(uint32_t surface, const unsigned char *a, uint32_t other, const unsigned char *b) {
  uint32_t x, y;
  memcpy(&x, a, 4), memcpy(&y, b, 4);
  return surface != other || (x != y && far_apart(a, b));
}

size_t qn_refine_mark(const qn_first_pass *pass, size_t x0, size_t y0, size_t x1, size_t y1, unsigned char *marks) {
  const size_t width = pass->width;
  for (size_t y = y0; y < y1; y++) {
    memset(marks + y * width + x0, 0, x1 - x0);
  }
  /* Each pair of neighbours once, those with one half outside the rectangle included. */
  size_t pairs = 0;
  for (size_t y = y0; y < y1; y++) {
    const unsigned char *line = pass->pixels + y * pass->row_bytes;
    const uint32_t *surfaces = pass->surfaces + y * width;
    for (size_t x = x0 ? x0 : 1; x <= x1 && x < width; x++) {
      if (differ(surfaces[x - 1], line + 4 * (x - 1), surfaces[x], line + 4 * x)) {
        marks[y * width + (x > x0 ? x - 1 : x)] = QN_REFINE_WANTED;
        marks[y * width + (x < x1 ? x : x - 1)] = QN_REFINE_WANTED;
        pairs++;
      }
    }
  }
  for (size_t y = y0 ? y0 : 1; y <= y1 && y < pass->height; y++) {
    const unsigned char *line = pass->pixels + y * pass->row_bytes, *above = line - pass->row_bytes;
    const uint32_t *surfaces = pass->surfaces + y * width, *over = surfaces - width;
    for (size_t x = x0; x < x1; x++) {
      if (differ(over[x], above + 4 * x, surfaces[x], line + 4 * x)) {
        marks[(y > y0 ? y - 1 : y) * width + x] = QN_REFINE_WANTED;
        marks[(y < y1 ? y : y - 1) * width + x] = QN_REFINE_WANTED;
        pairs++;
      }
    }
  }
  return pairs;
}

size_t qn_refine_follow(const qn_first_pass *pass, size_t x0, size_t y0, size_t x1, size_t y1, const unsigned char *sides, unsigned char *marks) {
  size_t count = 0;
  for (size_t y = y0; y < y1; y++) {
    for (size_t x = x0; x < x1; x++) {
      const size_t at = y * pass->width + x;
      const int beyond = (x > 0 && sides[at - 1] & QN_REFINE_RIGHT) || (x + 1 < pass->width && sides[at + 1] & QN_REFINE_LEFT) ||
                         (y > 0 && sides[at - pass->width] & QN_REFINE_BOTTOM) || (y + 1 < pass->height && sides[at + pass->width] & QN_REFINE_TOP);
      if (beyond && marks[at] == 0) {
        marks[at] = QN_REFINE_WANTED;
        count++;
      }
    }
  }
  return count;
}

unsigned qn_refine_side(unsigned samples) {
  unsigned n = 0;
  while ((uint64_t)n * n < samples) {
    n++;
  }
  return (uint64_t)n * n == samples && n <= QN_REFINE_MOST ? n : 0;
}

unsigned qn_refine_enough(unsigned side) {
  return QN_REFINE_LEVELS * 16 / (side * side);
}

unsigned qn_refine_corners(unsigned side) {
  return side > 1 ? 4 : 1;
}

/* The cell of sample k: the corners, then the others row by row. */
static void cell_of(unsigned side, unsigned k, unsigned *i, unsigned *j) {
  const unsigned last = side - 1;
  if (k < 4) {
    *i = k & 1 ? last : 0, *j = k & 2 ? last : 0;
    return;
  }
  const unsigned inner = side - 2, m = k - 4;
  if (m < inner) {
    *i = m + 1, *j = 0;
  } else if (m < inner + side * inner) {
    *i = (m - inner) % side, *j = 1 + (m - inner) / side;
  } else {
    *i = m - inner - side * inner + 1, *j = last;
  }
}

void qn_refine_place(unsigned side, unsigned k, double *x, double *y) {
  unsigned column, row;
  cell_of(side, k, &column, &row);
  const double i = column, j = row, n = side;
  *x = (i + (j + 0.5) / n) / n;
  *y = (j + (n - 1 - i + 0.5) / n) / n;
}

unsigned qn_refine_sides(unsigned side, unsigned k) {
  unsigned i, j;
  cell_of(side, k, &i, &j);
  return (i == 0 ? QN_REFINE_LEFT : 0u) | (i + 1 == side ? QN_REFINE_RIGHT : 0u) | (j == 0 ? QN_REFINE_TOP : 0u) | (j + 1 == side ? QN_REFINE_BOTTOM : 0u);
}
