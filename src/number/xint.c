/* Integers of design S2: the value, and a bound on the size of the terms it was made of.

   Legend: an exact v has terms of size |v| <= 2^ceil(log2 |v|); mag of a sum: 2^x + 2^y <= 2^(max(x, y) + 1); of a
   product of sums, the product of the sums of magnitudes: x + y. So mag never falls below the true size, and each sum
   loosens it by at most one bit. */
#include "number/xint.h"

/* The least k with |v| <= 2^k, 0 for 0. */
static int64_t size_of(qn_int v) {
  size_t bits = qn_int_bits(v);
  return (int64_t)bits - (bits > 0 && qn_int_trailing_zeros(v) == bits - 1);
}

static int64_t terms_of(qn_xint a) {
  return a.mag == QN_EXACT ? size_of(a.v) : a.mag;
}

static int exact_zero(qn_xint a) {
  return a.v.n == 0 && a.mag == QN_EXACT;
}

int qn_x_sign(qn_xint a) {
  if (a.mag != QN_EXACT && (int64_t)qn_int_bits(a.v) <= a.mag - QN_S2_BITS) {
    return 0;
  }
  return qn_int_sign(a.v);
}

qn_xint qn_x_add(qn_ctx *ctx, qn_xint a, qn_xint b) {
  if (a.mag == QN_EXACT && b.mag == QN_EXACT) {
    return qn_x(qn_int_add(ctx, a.v, b.v));
  }
  if (exact_zero(a)) {
    return b;
  }
  if (exact_zero(b)) {
    return a;
  }
  int64_t x = terms_of(a), y = terms_of(b);
  return (qn_xint){qn_int_add(ctx, a.v, b.v), (x > y ? x : y) + 1};
}

qn_xint qn_x_sub(qn_ctx *ctx, qn_xint a, qn_xint b) {
  return qn_x_add(ctx, a, qn_x_neg(b));
}

qn_xint qn_x_mul(qn_ctx *ctx, qn_xint a, qn_xint b) {
  if (a.mag == QN_EXACT && b.mag == QN_EXACT) {
    return qn_x(qn_int_mul(ctx, a.v, b.v));
  }
  if (exact_zero(a) || exact_zero(b)) {
    return qn_x((qn_int){0, NULL});
  }
  return (qn_xint){qn_int_mul(ctx, a.v, b.v), terms_of(a) + terms_of(b)};
}

qn_xint qn_x_scale(qn_ctx *ctx, qn_xint a, int64_t small) {
  if (small == 1 || small == -1) {
    return small == 1 ? a : qn_x_neg(a);
  }
  mp_limb_t limb = small < 0 ? 0 - (mp_limb_t)small : (mp_limb_t)small; /* a product is always new memory: none keeps it */
  return qn_x_mul(ctx, a, qn_x((qn_int){small < 0 ? -1 : small > 0, &limb}));
}

qn_xint qn_x_shl(qn_ctx *ctx, qn_xint a, size_t bits) {
  return (qn_xint){qn_int_shl(ctx, a.v, bits), a.mag == QN_EXACT ? QN_EXACT : a.mag + (int64_t)bits};
}
