/* Short names for exact arithmetic, and the making of half-spaces, inside this station only. */
#ifndef QN_SHAPE_EXACT_H
#define QN_SHAPE_EXACT_H

#include "shape/prim.h"

#define QN_HALF ((qn_num){{1}, -1, 0, QN_NUM_SMALL}) /* 1/2 */

static inline qn_num add(qn_ctx *ctx, qn_num a, qn_num b) { return qn_num_add(ctx, a, b); }
static inline qn_num sub(qn_ctx *ctx, qn_num a, qn_num b) { return qn_num_sub(ctx, a, b); }
static inline qn_num mul(qn_ctx *ctx, qn_num a, qn_num b) { return qn_num_mul(ctx, a, b); }
static inline qn_num mul3(qn_ctx *ctx, qn_num a, qn_num b, qn_num c) { return qn_num_mul(ctx, qn_num_mul(ctx, a, b), c); }
static inline qn_num square(qn_ctx *ctx, qn_num a) { return qn_num_mul(ctx, a, a); }
static inline qn_num neg(qn_ctx *ctx, qn_num a) { return qn_num_neg(ctx, a); }
static inline qn_num half(qn_ctx *ctx, qn_num a) { return qn_num_mul(ctx, a, QN_HALF); }
static inline int positive(qn_num a) { return qn_num_sign(a) > 0; }
static inline int equal(qn_ctx *ctx, qn_num a, qn_num b) { return qn_num_cmp(ctx, a, b) == 0; }

/* n half-spaces, all numbers zero, in the arena. Null and ctx->failed when memory is refused. */
qn_half_form *qn_halves_new(qn_ctx *ctx, size_t n);

/* The plane a x + b y + c z - d <= 0. */
void qn_half_plane(qn_ctx *ctx, qn_half_form *out, uint32_t role, qn_num a, qn_num b, qn_num c, qn_num d);

/* The planes lo <= x_axis and x_axis <= hi with the roles face 2 axis and face 2 axis + 1 (-x, +x, -y, +y, -z, +z). */
void qn_half_slab(qn_ctx *ctx, qn_half_form out[2], int axis, qn_num lo, qn_num hi);

#endif
