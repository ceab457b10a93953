/* Vectors of three doubles, for pictures. */
#ifndef QN_IMAGE_VEC_H
#define QN_IMAGE_VEC_H

#include "base/attrs.h"

#include <math.h>

QN_INLINE double qn_dot3(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

QN_INLINE void qn_cross3(const double a[3], const double b[3], double out[3]) {
  const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
  out[0] = x, out[1] = y, out[2] = z;
}

/* v / |v|, scaled first so that no square over- or underflows. 0 when v is zero or not finite (v is left as it was). */
QN_INLINE int qn_unit3(double v[3]) {
  const double m = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
  if (!(m > 0) || !isfinite(v[0]) || !isfinite(v[1]) || !isfinite(v[2])) {
    return 0;
  }
  const double x = v[0] / m, y = v[1] / m, z = v[2] / m, length = sqrt(x * x + y * y + z * z);
  v[0] = x / length, v[1] = y / length, v[2] = z / length;
  return 1;
}

/* |v|, scaled likewise. */
QN_INLINE double qn_length3(const double v[3]) {
  const double m = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
  if (!(m > 0) || !isfinite(m)) {
    return m;
  }
  const double x = v[0] / m, y = v[1] / m, z = v[2] / m;
  return m * sqrt(x * x + y * y + z * z);
}

#endif
