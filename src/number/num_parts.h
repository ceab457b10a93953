/* What the files of qn_num share: the canonical form and the ways into it. For src/number only. */
#ifndef QN_NUMBER_NUM_PARTS_H
#define QN_NUMBER_NUM_PARTS_H

#include "number/int_limbs.h"
#include "number/num.h"

#define QN_FIVES_ 27 /* 5^27 is the largest power of five in a signed limb */
extern const uint64_t qn_five_to_[QN_FIVES_ + 1];
extern const mp_limb_t qn_limb_one_;
#define QN_INT_ONE_ ((qn_int){1, &qn_limb_one_})

QN_INLINE uint64_t qn_magnitude_(int64_t v) { return v < 0 ? 0 - (uint64_t)v : (uint64_t)v; }

/* *v without its factors of five, whose count is returned; *v != 0. v is divisible by 5 when v / 5 modulo 2^64, which is
   v times the inverse of 5, is no larger than (2^64 - 1) / 5. */
QN_INLINE int qn_strip_fives_(uint64_t *v) {
  int n = 0;
  for (uint64_t q; (q = *v * UINT64_C(0xcccccccccccccccd)) <= UINT64_MAX / 5; *v = q) {
    n++;
  }
  return n;
}

/* |v| 2^a 5^b with the sign, as a small number where it is one; 0 otherwise. v < 2^127. */
int qn_num_small_(qn_u128 v, int negative, int64_t a, int64_t b, qn_num *out);
/* |m| 2^da 5^db in 126 bits, or 0 where it does not fit. */
QN_INLINE int qn_num_scaled_(int64_t m, int64_t da, int64_t db, qn_u128 *out) {
  if (db > QN_FIVES_ || da > 126) {
    return 0;
  }
  qn_u128 v = (qn_u128)qn_magnitude_(m) * qn_five_to_[db];
  uint64_t high = (uint64_t)(v >> 64);
  unsigned bits = high ? 128 - qn_leading_zeros(high) : v ? 64 - qn_leading_zeros((uint64_t)v) : 0;
  *out = bits + (unsigned)da <= 126 ? v << da : 0;
  return bits + (unsigned)da <= 126;
}

/* The number num/den, den > 0, reduced unless it is to be rounded. What was taken from the arena since the mark is given
   back, and the result put there. Zero when the context has failed. */
qn_num qn_num_settle_(qn_ctx *ctx, qn_mark mark, qn_int num, qn_int den, int rounded);
/* The same for a number made since the mark. */
qn_num qn_num_keep_(qn_ctx *ctx, qn_mark mark, qn_num a);
/* num/den, den > 0, as M 2^E with M of QN_S2_PRECISION bits, to nearest, ties to even: as a fraction of num and den. */
void qn_num_round_rat_(qn_ctx *ctx, qn_int *num, qn_int *den);

/* Whether |difference| < 2^-QN_S2_BITS |larger|. */
int qn_num_agree_(qn_ctx *ctx, qn_int difference, qn_int larger);

/* v / 5^n for the largest n, which is *n. v != 0. */
qn_int qn_int_strip_fives_(qn_ctx *ctx, qn_int v, int64_t *n);

/* |num / den| 2^e as the nearest double, ties to even; limbs with a non-zero top one. */
double qn_limbs_to_double_(const mp_limb_t *num, mp_size_t nn, const mp_limb_t *den, mp_size_t dn, int64_t e);

#endif
