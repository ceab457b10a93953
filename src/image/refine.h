/* Which pixels deserve more samples, where those lie, and when they are enough. */
#ifndef QN_IMAGE_REFINE_H
#define QN_IMAGE_REFINE_H

#include <stddef.h>
#include <stdint.h>

/* Two neighbouring pixels of one surface whose 8-bit sRGB components differ by more than this are refined: about three
   hundredths of the scale from black to white, a step that the eye begins to see as an edge. A threshold of perception, not
   of geometry. */
#define QN_REFINE_LEVELS 8

/* A pixel whose first samples, at its corners, and whose centre differ by at most this many levels takes no more of them; of n x n
   samples, QN_REFINE_LEVELS 4 / n^2 levels. So the error that is left shrinks as samples grow. */
unsigned qn_refine_enough(unsigned side);

/* How many times pixels beyond a side that shows something are looked at as well: a feature thinner than a pixel is followed so many
   pixels from where the first pass saw it. */
#define QN_REFINE_ROUNDS 8

/* The first pass's picture: for each pixel its colour (RGBA bytes, rows row_bytes apart) and the surface seen (rows of
   width). */
typedef struct qn_first_pass {
  size_t width, height, row_bytes;
  const unsigned char *pixels;
  const uint32_t *surfaces;
} qn_first_pass;

enum { QN_REFINE_WANTED = 1, QN_REFINE_DONE = 2 }; /* what is to be done with a pixel */

/* marks[y * width + x] for x0 <= x < x1, y0 <= y < y1: QN_REFINE_WANTED when the pixel differs from one of its four neighbours in
   surface or light, else 0. Returns 0 when none is wanted. */
size_t qn_refine_mark(const qn_first_pass *pass, size_t x0, size_t y0, size_t x1, size_t y1, unsigned char *marks);

/* The sides of a pixel at which samples differ from its centre: something is there that the first pass missed in the pixel beyond. */
enum { QN_REFINE_LEFT = 1, QN_REFINE_RIGHT = 2, QN_REFINE_TOP = 4, QN_REFINE_BOTTOM = 8 };

/* Pixels of the rectangle that are beyond such a side and not marked become wanted; returns how many. */
size_t qn_refine_follow(const qn_first_pass *pass, size_t x0, size_t y0, size_t x1, size_t y1, const unsigned char *sides, unsigned char *marks);

/* n when samples = n * n with 0 < n <= QN_REFINE_MOST, else 0. */
enum { QN_REFINE_MOST = 256 };
unsigned qn_refine_side(unsigned samples);

/* The place of sample k < side * side in its pixel, in (0, 1), and the pixel's sides that it is next to. The first qn_refine_corners(side)
   are those nearest to the corners. */
unsigned qn_refine_corners(unsigned side);
void qn_refine_place(unsigned side, unsigned k, double *x, double *y);
unsigned qn_refine_sides(unsigned side, unsigned k);

#endif
