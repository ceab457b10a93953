/* A line in a superquadric's frame whose exact numbers are long, each coordinate's two over one denominator: places along it cost what their length does.

   As sums of fractions in lowest terms they cost greatest common divisors: rays at a radius of 1e4000 took 22 times as long. */
#ifndef QN_SHAPE_SUPER_LONG_H
#define QN_SHAPE_SUPER_LONG_H

#include "shape/super_frame.h"

#include <mpfr.h>

/* X_i(t) = (O[i] + t D[i]) / over[i], exactly; over > 0. */
typedef struct qn_super_long {
  qn_int O[3], D[3], over[3];
} qn_super_long;

/* 0: no number is long, or one is rounded (design S2), or memory is refused. *out lies in the context's arena. */
int qn_super_long_make(const qn_super_exact *line, qn_super_long *out);
/* X_i(t), t finite, rounded to nearest in out's precision. */
void qn_super_long_at(qn_ctx *ctx, const qn_super_long *line, int i, double t, mpfr_t out);

#endif
