/* The order of roots of rounded quadratics: equal when they agree to 2^-QN_S2_BITS (design S2).

   A rounded coefficient v with terms of size 2^mag is known to 2^(mag - QN_S2_BITS) for S2's purposes. That moves a simple root t
   by at most rho = 2^-QN_S2_BITS (2^mag_a t^2 + 2 2^mag_h |t| + 2^mag_c) / (2 sqrt disc), as |p'| = 2 sqrt disc there; a linear
   root by the same over |2 h|; the double root -h/a by 2^-QN_S2_BITS (2^mag_h + 2^mag_a |t|) / |a|. Roots are equal when they are no further
   apart than the larger rho, taken as a power of two. The signs of polynomials in all coefficients (quad.c) would not do here: a
   resultant is a product of four differences of roots, and falls below 2^-QN_S2_BITS of its terms when each is 2^-50. */
#include "number/quad_parts.h"

static int64_t larger(int64_t a, int64_t b) { return a > b ? a : b; }

/* log2 of rho, rounded up; QN_EXACT when the root is exact. */
static int64_t spread(qn_ctx *ctx, qn_root x) {
  const qn_quad *q = x.q;
  if (!qn_quad_rounded_(q)) {
    return QN_EXACT;
  }
  int64_t t = 0; /* |root| <= 2^t */
  const int away = qn_root_size_(ctx, x, &t);
  int64_t of_a = away ? q->a.mag : QN_EXACT, of_h = away ? q->h.mag : QN_EXACT, of_c = q->c.mag;
  int64_t size = QN_EXACT, slope;
  if (of_h != QN_EXACT) {
    size = of_h + 1 + t;
  }
  if (q->sign_a && q->sign_disc == 0) { /* a double root, in units of 2 |a| t: c has no part in it */
    size = larger(size, of_a == QN_EXACT ? QN_EXACT : of_a + 1 + 2 * t);
    slope = (int64_t)qn_int_bits(q->a.v) + t;
  } else {
    size = larger(size, of_a == QN_EXACT ? QN_EXACT : of_a + 2 * t);
    size = larger(size, of_c);
    slope = q->sign_a ? (int64_t)qn_int_bits(q->disc.v) / 2 : (int64_t)qn_int_bits(q->h.v);
  }
  return size == QN_EXACT ? QN_EXACT : size + 2 - slope - QN_S2_BITS;
}

int qn_root_rounded(qn_root x) { return qn_quad_rounded_(x.q); }

int qn_root_cmp_stored(qn_ctx *ctx, qn_root x, qn_root y) {
  const qn_quad p = qn_quad_stored_(x.q), q = qn_quad_stored_(y.q);
  return x.q == y.q ? (x.which > y.which) - (x.which < y.which) : qn_root_cmp(ctx, (qn_root){&p, x.which}, (qn_root){&q, y.which});
}

int qn_root_cmp_s2_(qn_ctx *ctx, qn_root x, qn_root y) {
  int64_t rho = larger(spread(ctx, x), spread(ctx, y));
  if (rho == QN_EXACT) { /* no rounded number has a part in either */
    return qn_root_cmp_stored(ctx, x, y);
  }
  int64_t k = rho < 0 ? 8 - rho : 8;
  qn_int gap = qn_int_sub(ctx, qn_root_scaled_(ctx, x, (size_t)k), qn_root_scaled_(ctx, y, (size_t)k)); /* within 4 of the truth */
  return (int64_t)qn_int_bits(gap) <= k + rho ? 0 : qn_int_sign(gap);
}
