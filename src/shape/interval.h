/* Intervals of doubles with ends rounded outward by one step of QN_STEP, which passes the next double (docs/bounds.md).
   Ends may be infinite; an end that is not a number makes the whole line. */
#ifndef QN_SHAPE_INTERVAL_H
#define QN_SHAPE_INTERVAL_H

#include "base/attrs.h"
#include "base/bounds.h"

#include <float.h>
#include <math.h>

typedef struct qn_interval { double lo, hi; } qn_interval;

QN_INLINE double qn_step_up(double x) { return x == -INFINITY ? -DBL_MAX : x + (QN_STEP * fabs(x) + DBL_TRUE_MIN); }
QN_INLINE double qn_step_down(double x) { return x == INFINITY ? DBL_MAX : x - (QN_STEP * fabs(x) + DBL_TRUE_MIN); }
QN_INLINE qn_interval qn_widened(double lo, double hi) {
  double a = qn_step_down(lo), b = qn_step_up(hi);
  return (qn_interval){a == a ? a : -INFINITY, b == b ? b : INFINITY};
}
/* What a number may be that was rounded to x. */
QN_INLINE qn_interval qn_around(double x) { return x == 0 ? (qn_interval){0, 0} : qn_widened(x, x); }
QN_INLINE qn_interval qn_interval_add(qn_interval a, qn_interval b) { return qn_widened(a.lo + b.lo, a.hi + b.hi); }
QN_INLINE qn_interval qn_interval_sub(qn_interval a, qn_interval b) { return qn_widened(a.lo - b.hi, a.hi - b.lo); }
QN_INLINE qn_interval qn_interval_mul(qn_interval a, qn_interval b) {
  double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
  if (p != p || q != q || r != r || s != s) {
    return (qn_interval){-INFINITY, INFINITY};
  }
  return qn_widened(fmin(fmin(p, q), fmin(r, s)), fmax(fmax(p, q), fmax(r, s)));
}
/* b > 0 */
QN_INLINE qn_interval qn_interval_div(qn_interval a, qn_interval b) {
  double p = a.lo / b.lo, q = a.lo / b.hi, r = a.hi / b.lo, s = a.hi / b.hi;
  if (p != p || q != q || r != r || s != s) {
    return (qn_interval){-INFINITY, INFINITY};
  }
  return qn_widened(fmin(fmin(p, q), fmin(r, s)), fmax(fmax(p, q), fmax(r, s)));
}

#endif
