/* Powers, the same bits on every machine: the C library's pow is not (it may use fused multiply-adds where the processor has them).

   x^m = 2^(m log2 x). Legend: x = 2^e f with f in [sqrt(1/2), sqrt(2)); s = (f - 1)/(f + 1), so that
   log2 f = (2/ln 2)(s + s^3/3 + s^5/5 + ...) with |s| < 0.172, cut after s^17 (what follows is under 2^-53);
   m log2 x = k + r, |r| <= 1/2; 2^r = sum (r ln 2)^i / i!, cut after i = 12 (under 2^-53 again).
   The relative error is under 2^-49 (1 + |m log2 x|), which test image.power measures against long doubles.
   No branches in the two halves: a loop over lanes becomes wide code, and every operation is one of IEEE's, so wide code gives the same. */
#ifndef QN_IMAGE_POWER_H
#define QN_IMAGE_POWER_H

#include "base/attrs.h"

#include <string.h>

#define QN_SQRT_HALF_BITS 0x3fe6a09e667f3bcdu
#define QN_TWO_OVER_LN2 2.8853900817779268
#define QN_LN2 0.6931471805599453
#define QN_EXP2_LEAST (-1022.0) /* of qn_exp2; what is smaller is as good as 0 to light */
#define QN_ROUNDER 0x1.8p52 /* added and taken away again: rounds to a whole number, which stands in the sum's low bits */

QN_INLINE double qn_of_bits(uint64_t bits) {
  double v;
  memcpy(&v, &bits, sizeof v);
  return v;
}
QN_INLINE uint64_t qn_bits_of(double v) {
  uint64_t bits;
  memcpy(&bits, &v, sizeof bits);
  return bits;
}

/* x in (0, 2^1000), not subnormal. Other x: some number. */
QN_INLINE double qn_log2(double x) {
  const uint64_t bits = qn_bits_of(x);
  const uint64_t above = bits - QN_SQRT_HALF_BITS + (2048ull << 52); /* its high twelve bits: e + 2048 */
  const double e = qn_of_bits(above >> 52 | 0x4330000000000000u) - (0x1p52 + 2048);
  const double f = qn_of_bits(bits - (above & 0xfff0000000000000u) + (2048ull << 52));
  const double s = (f - 1) / (f + 1), z = s * s;
  double sum = 1.0 / 17;
  sum = sum * z + 1.0 / 15;
  sum = sum * z + 1.0 / 13;
  sum = sum * z + 1.0 / 11;
  sum = sum * z + 1.0 / 9;
  sum = sum * z + 1.0 / 7;
  sum = sum * z + 1.0 / 5;
  sum = sum * z + 1.0 / 3;
  return e + QN_TWO_OVER_LN2 * (s + s * (z * sum));
}

/* -1022 <= y <= 1022. Other y: some number. */
QN_INLINE double qn_exp2(double y) {
  const double shifted = y + QN_ROUNDER, r = (y - (shifted - QN_ROUNDER)) * QN_LN2;
  double p = 1.0 / 479001600;
  p = p * r + 1.0 / 39916800;
  p = p * r + 1.0 / 3628800;
  p = p * r + 1.0 / 362880;
  p = p * r + 1.0 / 40320;
  p = p * r + 1.0 / 5040;
  p = p * r + 1.0 / 720;
  p = p * r + 1.0 / 120;
  p = p * r + 1.0 / 24;
  p = p * r + 1.0 / 6;
  p = p * r + 1.0 / 2;
  p = p * r + 1;
  p = p * r + 1;
  return p * qn_of_bits((qn_bits_of(shifted) + 1023) << 52);
}

/* x^m for x in (0, 2), not subnormal, and m >= 0. */
QN_INLINE double qn_power(double x, double m) {
  const double y = m * qn_log2(x);
  return qn_exp2(y < QN_EXP2_LEAST ? QN_EXP2_LEAST : y > -QN_EXP2_LEAST ? -QN_EXP2_LEAST : y);
}

#endif
