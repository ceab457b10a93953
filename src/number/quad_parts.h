/* What the files of qn_quad share. For src/number only. */
#ifndef QN_NUMBER_QUAD_PARTS_H
#define QN_NUMBER_QUAD_PARTS_H

#include "number/quad.h"

/* The root as num/den, den > 0, when its quadratic is linear or has a double root; 0 when it has two. */
int qn_root_plain_(qn_ctx *ctx, qn_root x, qn_int *num, qn_int *den);

/* An integer within 2 of the root times 2^k. */
qn_int qn_root_scaled_(qn_ctx *ctx, qn_root x, size_t k);

/* 0 when the root is 0; else 1, and |root| is at most 2^*e and above 2^(*e - 4). */
int qn_root_size_(qn_ctx *ctx, qn_root x, int64_t *e);

/* The same quadratic taken as its stored form, without the rule of S2. */
qn_quad qn_quad_stored_(const qn_quad *q);

/* Whether a rounding of S2 went into it. */
QN_INLINE int qn_quad_rounded_(const qn_quad *q) { return q->a.mag != QN_EXACT || q->h.mag != QN_EXACT || q->c.mag != QN_EXACT; }

/* The order of two roots at least one of which is rounded (quad_s2.c). */
int qn_root_cmp_s2_(qn_ctx *ctx, qn_root x, qn_root y);

#endif
