/* Integers that know whether a rounding of design S2 went into them.

   An S2 integer carries the size of the terms it was made of: `mag` bounds log2 of the sum of the magnitudes of its
   terms. Its sign is zero when |value| < 2^(mag - QN_S2_BITS): that is "agree to 2^-200" of design S2, in the one place
   where it decides anything along a ray. An exact integer (mag = QN_EXACT) has the sign of its value. */
#ifndef QN_NUMBER_XINT_H
#define QN_NUMBER_XINT_H

#include "number/int.h"

#define QN_S2_PRECISION 256 /* bits kept of an irrational number (S2) */
#define QN_S2_BITS 200      /* two numbers that agree to so many bits are the same (S2) */
#define QN_EXACT INT64_MIN

typedef struct qn_xint {
  qn_int v;
  int64_t mag;
} qn_xint;

QN_INLINE qn_xint qn_x(qn_int v) { return (qn_xint){v, QN_EXACT}; }
QN_INLINE qn_xint qn_x_rounded(qn_int v) { return (qn_xint){v, (int64_t)qn_int_bits(v)}; } /* one term */

int qn_x_sign(qn_xint a);
QN_INLINE qn_xint qn_x_neg(qn_xint a) { return (qn_xint){qn_int_neg(a.v), a.mag}; }
qn_xint qn_x_add(qn_ctx *ctx, qn_xint a, qn_xint b);
qn_xint qn_x_sub(qn_ctx *ctx, qn_xint a, qn_xint b);
qn_xint qn_x_mul(qn_ctx *ctx, qn_xint a, qn_xint b); /* an exact zero makes an exact zero */
qn_xint qn_x_scale(qn_ctx *ctx, qn_xint a, int64_t small);
qn_xint qn_x_shl(qn_ctx *ctx, qn_xint a, size_t bits);

#endif
