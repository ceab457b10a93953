/* Double-double arithmetic (Dekker 1971, Shewchuk 1997, Joldes Muller Popescu 2017), the same bits with or without a
   fused multiply-add in the machine: two_prod is exact either way.

   Legend: a dd is hi + lo, hi the nearest double to the sum. u = 2^-53. Relative errors: add 3u^2 (of the result, for
   the accurate sum), mul 5u^2, div 10u^2, sqrt 4u^2, barring over- and underflow. */
#ifndef QN_NUMBER_DD_H
#define QN_NUMBER_DD_H

#include "base/attrs.h"

#include <math.h>

typedef struct qn_dd { double hi, lo; } qn_dd;

QN_INLINE qn_dd qn_dd_from(double a) { return (qn_dd){a, 0}; }
QN_INLINE qn_dd qn_dd_quick_sum(double a, double b) { /* |a| >= |b| or a = 0 */
  double s = a + b;
  return (qn_dd){s, b - (s - a)};
}
QN_INLINE qn_dd qn_dd_two_sum(double a, double b) {
  double s = a + b, t = s - a;
  return (qn_dd){s, (a - (s - t)) + (b - t)};
}
QN_INLINE qn_dd qn_dd_two_prod(double a, double b) {
  double p = a * b;
#ifdef __FMA__
  return (qn_dd){p, __builtin_fma(a, b, -p)};
#else
  const double split = 134217729.0; /* 2^27 + 1 (Dekker) */
  double ca = split * a, ah = ca - (ca - a), al = a - ah;
  double cb = split * b, bh = cb - (cb - b), bl = b - bh;
  return (qn_dd){p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
#endif
}
QN_INLINE qn_dd qn_dd_neg(qn_dd a) { return (qn_dd){-a.hi, -a.lo}; }
QN_INLINE qn_dd qn_dd_add(qn_dd a, qn_dd b) { /* accurate: AccurateDWPlusDW of Joldes et al. */
  qn_dd s = qn_dd_two_sum(a.hi, b.hi), t = qn_dd_two_sum(a.lo, b.lo);
  qn_dd v = qn_dd_quick_sum(s.hi, s.lo + t.hi);
  return qn_dd_quick_sum(v.hi, t.lo + v.lo);
}
QN_INLINE qn_dd qn_dd_sub(qn_dd a, qn_dd b) { return qn_dd_add(a, qn_dd_neg(b)); }
QN_INLINE qn_dd qn_dd_mul(qn_dd a, qn_dd b) {
  qn_dd p = qn_dd_two_prod(a.hi, b.hi);
  return qn_dd_quick_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}
QN_INLINE qn_dd qn_dd_mul_d(qn_dd a, double b) {
  qn_dd p = qn_dd_two_prod(a.hi, b);
  return qn_dd_quick_sum(p.hi, p.lo + a.lo * b);
}
QN_INLINE qn_dd qn_dd_div(qn_dd a, qn_dd b) {
  double q = a.hi / b.hi;
  qn_dd r = qn_dd_sub(a, qn_dd_mul_d(b, q));
  double q2 = r.hi / b.hi;
  r = qn_dd_sub(r, qn_dd_mul_d(b, q2));
  return qn_dd_add(qn_dd_quick_sum(q, q2), qn_dd_from(r.hi / b.hi));
}
QN_INLINE qn_dd qn_dd_sqrt(qn_dd a) { /* a >= 0 */
  if (a.hi <= 0) {
    return (qn_dd){0, 0};
  }
  double s = sqrt(a.hi);
  qn_dd r = qn_dd_sub(a, qn_dd_two_prod(s, s));
  return qn_dd_quick_sum(s, r.hi / (2 * s));
}

#endif
