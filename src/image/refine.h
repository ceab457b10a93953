/* Which pixels deserve more samples, and where those lie. */
#ifndef QN_IMAGE_REFINE_H
#define QN_IMAGE_REFINE_H

#include <stddef.h>
#include <stdint.h>

/* Two neighbouring pixels of one surface whose 8-bit sRGB components differ by more than this are refined: about three
   hundredths of the scale from black to white, a step that the eye begins to see as an edge. A threshold of perception, not
   of geometry. */
#define QN_REFINE_LEVELS 8

/* The first pass's picture: for each pixel its colour (RGBA bytes, rows row_bytes apart) and the surface seen (rows of
   width). */
typedef struct qn_first_pass {
  size_t width, height, row_bytes;
  const unsigned char *pixels;
  const uint64_t *surfaces;
} qn_first_pass;

/* Whether pixel (x, y) differs from one of its four neighbours in surface or light. */
int qn_refine_needed(const qn_first_pass *pass, size_t x, size_t y);

/* n when samples = n * n with n > 0, else 0. */
unsigned qn_refine_side(unsigned samples);

/* The place of sample k < side * side in its pixel, in (0, 1). */
void qn_refine_place(unsigned side, unsigned k, double *x, double *y);

#endif
