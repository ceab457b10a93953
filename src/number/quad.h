/* Exact quadratics along a ray, the order of their roots, and the double nearest to a root.

   Legend: p(t) = a t^2 + 2 h t + c with integers; disc = h^2 - a c; roots (-h -+ sqrt disc)/a. No division and no
   square root decides anything. J = a1 h2 - a2 h1; G = a1 c2 - a2 c1; J' = h1 c2 - h2 c1; K = a1 c2 + a2 c1 - 2 h1 h2;
   N = 2 h1 J - a1 G; Res = G^2 - 4 J J'. K^2 - 4 disc1 disc2 = Res and N^2 - 4 J^2 disc1 = a1^2 Res (docs/exactness.md). */
#ifndef QN_NUMBER_QUAD_H
#define QN_NUMBER_QUAD_H

#include "number/xint.h"

typedef struct qn_quad {
  qn_xint a, h, c;
  qn_xint disc;       /* filled by qn_quad_make */
  int sign_a, sign_h, sign_c, sign_disc; /* exact signs (by the rule of S2 for rounded numbers) */
} qn_quad;

/* What a quadratic does along the whole line. */
typedef enum qn_quad_shape {
  QN_QUAD_ZERO,     /* identically zero */
  QN_QUAD_CONSTANT, /* no root, the sign of c */
  QN_QUAD_LINEAR,   /* a = 0: one root, -c / 2h */
  QN_QUAD_NONE,     /* a != 0, disc < 0: no root, the sign of a */
  QN_QUAD_DOUBLE,   /* disc = 0: touches at -h/a and keeps the sign of a on both sides: no event */
  QN_QUAD_TWO       /* two roots: sign of a outside them, the other between */
} qn_quad_shape;

void qn_quad_make(qn_ctx *ctx, qn_xint a, qn_xint h, qn_xint c, qn_quad *out);
qn_quad_shape qn_quad_kind(const qn_quad *q);

/* A root: which = 0 the smaller of two (or the only one), 1 the larger. Of a DOUBLE, 0 is the touching place. */
typedef struct qn_root { const qn_quad *q; int which; } qn_root;

/* The exact order of two roots, -1, 0 or 1; roots of rounded quadratics tie when they agree to 2^-QN_S2_BITS, relative to what
   a change of that size in the coefficients does to them. Cost 0.2 to 1 us, a few us where one is rounded. */
int qn_root_cmp(qn_ctx *ctx, qn_root x, qn_root y);
int qn_root_rounded(qn_root x); /* whether it is of a rounded quadratic */
/* The order of two roots in their stored forms. Ties by that rule are not transitive, this order is. */
int qn_root_cmp_stored(qn_ctx *ctx, qn_root x, qn_root y);
/* The order of a root and the rational num/den, den > 0. */
int qn_root_cmp_rat(qn_ctx *ctx, qn_root x, qn_int num, qn_int den);

/* The double nearest to the root, ties to even; signed zero is +0; infinite beyond the range. Correct, not faithful:
   the one answer that every route to it must give (design S8, S9). A root of a rounded quadratic is taken from its
   stored form, with a disc whose sign is 0 by S2 taken as 0. */
double qn_root_to_double(qn_ctx *ctx, qn_root x);
/* The same for num/den, den > 0. */
double qn_rat_to_double(qn_ctx *ctx, qn_int num, qn_int den);
/* Whether the root is rational, and then num/den, den > 0 (not reduced). */
int qn_root_rational(qn_ctx *ctx, qn_root x, qn_int *num, qn_int *den);
/* A rational strictly between two roots x < y, near the middle and of few bits (num/den, den > 0, den a power of two). Of rounded quadratics, which tie by a rule that is not transitive, the
   stored forms may have the roots in another order; the context then fails with QUOIN_E_LIMIT. Cost: some us, as long as the roots agree to less than some thousand bits. */
void qn_root_between(qn_ctx *ctx, qn_root x, qn_root y, qn_int *num, qn_int *den);
/* A rational strictly below / above a root. */
void qn_root_below(qn_ctx *ctx, qn_root x, qn_int *num, qn_int *den);
void qn_root_above(qn_ctx *ctx, qn_root x, qn_int *num, qn_int *den);
/* p at num/den: the sign. */
int qn_quad_sign_at(qn_ctx *ctx, const qn_quad *q, qn_int num, qn_int den);

#endif
