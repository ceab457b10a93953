/* Support functions in doubles, rounded outward.

   A support value is a sum of products. It is gathered as the sum and the sum of magnitudes; at the end the magnitude times
   a slack is added, so that rounding of the arguments (each within u of the exact one) and of the work cannot leave the result
   below the true support (docs/bounds.md, QN_SUPPORT_SLACK). Not a number becomes infinite: "no bound". */
#ifndef QN_SHAPE_OUTWARD_H
#define QN_SHAPE_OUTWARD_H

#include "base/attrs.h"
#include "base/bounds.h"

#include <math.h>

typedef struct qn_terms { double sum, magnitude; } qn_terms;

/* Adds a times b; b is of the arguments' making and so is a. */
QN_INLINE void qn_term(qn_terms *t, double a, double b) {
  double p = a * b;
  t->sum += p;
  t->magnitude += fabs(p);
  if (fabs(p) < QN_SUPPORT_TINY && a != 0 && b != 0) { /* it may have lost bits to underflow */
    t->magnitude += QN_SUPPORT_TINY;
  }
}

QN_INLINE double qn_outward(qn_terms t, double slack) {
  double r = t.sum + slack * t.magnitude;
  return r == r ? r : INFINITY;
}

/* sqrt(a^2 + b^2) and sqrt(a^2 + b^2 + c^2), free of overflow; at most 4.6u off, relatively. */
QN_INLINE double qn_norm3(double a, double b, double c) {
  a = fabs(a), b = fabs(b), c = fabs(c);
  double m = a > b ? a : b;
  m = m > c ? m : c;
  if (!(m > 0)) {
    return 0;
  }
  a /= m, b /= m, c /= m;
  return m * sqrt(a * a + b * b + c * c);
}
QN_INLINE double qn_norm2(double a, double b) { return qn_norm3(a, b, 0); }

/* Angle about the axis as a share of the turn, in [0, 1). */
QN_INLINE double qn_turn(double x, double y) {
  double u = atan2(y, x) * 0.15915494309189533577; /* 1 / 2 pi */
  u = u < 0 ? u + 1 : u;
  return u < 1 ? u : 0;
}
QN_INLINE double qn_clamp01(double v) { return v > 0 ? v < 1 ? v : 1 : 0; }

#endif
