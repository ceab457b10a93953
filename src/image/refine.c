/* Antialiasing where it shows: one sample at the centre of every pixel first; then, where neighbours differ, n x n samples
   and their mean, which is a box filter over the pixel.

   The pattern is fixed and stratified: sample (i, j) lies in cell (i, j) of n x n, at ((i + (j + 1/2)/n)/n, (j + (i +
   1/2)/n)/n). Each of the n^2 columns of width 1/n^2 holds one sample, and each row: edges near the vertical and the
   horizontal get n^2 levels of grey (the canonical arrangement of Kensler, "Correlated multi-jittered sampling", 2013,
   without its jitter). No random number: the picture is a function of the scene alone. */
#include "image/refine.h"

#include <stdlib.h>

static int differ(const qn_first_pass *pass, size_t x0, size_t y0, size_t x1, size_t y1) {
  if (pass->surfaces[y0 * pass->width + x0] != pass->surfaces[y1 * pass->width + x1]) {
    return 1;
  }
  const unsigned char *a = pass->pixels + y0 * pass->row_bytes + 4 * x0, *b = pass->pixels + y1 * pass->row_bytes + 4 * x1;
  return abs(a[0] - b[0]) > QN_REFINE_LEVELS || abs(a[1] - b[1]) > QN_REFINE_LEVELS || abs(a[2] - b[2]) > QN_REFINE_LEVELS;
}

int qn_refine_needed(const qn_first_pass *pass, size_t x, size_t y) {
  return (x > 0 && differ(pass, x, y, x - 1, y)) || (x + 1 < pass->width && differ(pass, x, y, x + 1, y)) ||
         (y > 0 && differ(pass, x, y, x, y - 1)) || (y + 1 < pass->height && differ(pass, x, y, x, y + 1));
}

unsigned qn_refine_side(unsigned samples) {
  unsigned n = 0;
  while ((uint64_t)n * n < samples) {
    n++;
  }
  return (uint64_t)n * n == samples ? n : 0;
}

void qn_refine_place(unsigned side, unsigned k, double *x, double *y) {
  const double i = k % side, j = k / side, n = side;
  *x = (i + (j + 0.5) / n) / n;
  *y = (j + (i + 0.5) / n) / n;
}
