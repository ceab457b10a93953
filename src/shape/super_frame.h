/* A line in a superquadric's frame, X(t) = O + t D, in pairs of doubles and exactly.

   Where the solid is flat a rounding of a coordinate to one double moves an end by a root of it: at e = 3, n = 0.5 the fourth root, 2^-53 becomes 2^-13. A pair
   leaves 2^-99 of the line's terms, which is known and kept with it; what that leaves open is decided with the exact numbers. */
#ifndef QN_SHAPE_SUPER_FRAME_H
#define QN_SHAPE_SUPER_FRAME_H

#include "number/num.h"

/* The map into the frame: X_i = row[i] . (x - pivot, 1). Sums of two doubles within 2^-106 of the exact numbers; a second one of 0: the first is exact. */
typedef struct qn_super_rows {
  double pivot[3];
  double row[3][4][2];
  double e[2], n[2];
  double top[3][3], bottom[3][3]; /* the first of the two in halves (Dekker), whose products are exact */
  int fit;                        /* the numbers are in the range for which the errors were derived */
} qn_super_rows;
/* Fills top, bottom and fit. */
void qn_super_rows_finish(qn_super_rows *rows);

/* |O_i - O[i][0] - O[i][1]| <= O_off[i], and D alike; the second doubles are 0 or not below QN_SUPER_SHORT, e and n within 2^-106. */
typedef struct qn_super_frame {
  double e[2], n[2];
  double O[3][2], D[3][2], O_off[3], D_off[3];
} qn_super_frame;

typedef struct qn_super_exact {
  qn_ctx *ctx; /* its arena is given back as it was, its failure is the search's */
  qn_num O[3], D[3], e, n;
} qn_super_exact;
/* Makes the exact line when it is needed; 0 when memory is refused or a limit is met. */
typedef int (*qn_super_ask)(void *user, qn_super_exact *out);

/* From doubles. 0: a number is out of the range for which the errors were derived (docs/bounds.md, QN_SUPER_FRAME). Cost: 30 to 60 ns. */
int qn_super_frame_make(const qn_super_rows *rows, const double o[3], const double d[3], qn_super_frame *out);
void qn_super_frame_from_exact(const qn_super_exact *line, qn_super_frame *out);
/* The same line begun at t: X(t + s) = O' + s D. The first in doubles with their error (docs/bounds.md, QN_SUPER_FRAME), infinite out of their range. */
void qn_super_frame_begin(const qn_super_frame *frame, double t, qn_super_frame *out);
void qn_super_exact_begin(qn_super_exact *line, double t);
/* Takes D, where its largest coordinate is beyond 2^QN_SUPER_USUAL or its reciprocal, times 2^-k so that it is about 1: the line's t are then 2^k times what they were. Returns k, else 0. */
int qn_super_exact_scale(qn_super_exact *line);

#endif
