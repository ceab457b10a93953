/* The support of a general quadric, finite when it is an ellipsoid for certain, in intervals.

   q = x'M x + 2 g.x + j (g half the linear coefficients). M = L D L' without pivoting; the solid is an ellipsoid (or empty) when
   all d_i > 0. With
   L z = -g and L w = v:  the centre has v.c = sum w_i z_i / d_i, the least value is j - sum z_i^2 / d_i, and the support
       v.c + sqrt(rho sum w_i^2 / d_i),    rho = sum z_i^2 / d_i - j.
   Each coefficient is taken as the interval that its rounding leaves; the result is the upper end. An ill-conditioned M gives a
   d_i that
   is not positive for certain, and so no bound. */
#include "shape/interval.h"
#include "shape/outward.h"
#include "shape/rows.h"

static qn_interval mul(qn_interval a, qn_interval b) { return qn_interval_mul(a, b); }
static qn_interval minus(qn_interval a, qn_interval b, qn_interval c) { return qn_interval_sub(a, qn_interval_mul(b, c)); }

double qn_quadric_support(const double *args, size_t n, const double placement[6], const double v[3]) {
  (void)n, (void)placement;
  qn_interval a[10];
  for (int i = 0; i < 10; i++) {
    double x = i >= 3 && i < 9 ? 0.5 * args[i] : args[i];
    a[i] = qn_around(x);
    if (x == 0 && args[i] != 0) {
      return INFINITY;
    }
  }
  qn_interval d[3], l10, l20, l21, m21, z[3], w[3];
  d[0] = a[0];
  if (!(d[0].lo > 0)) {
    return INFINITY;
  }
  l10 = qn_interval_div(a[3], d[0]);
  l20 = qn_interval_div(a[4], d[0]);
  d[1] = minus(a[1], l10, a[3]);
  if (!(d[1].lo > 0)) {
    return INFINITY;
  }
  m21 = minus(a[5], l20, a[3]);
  l21 = qn_interval_div(m21, d[1]);
  d[2] = minus(minus(a[2], l20, a[4]), l21, m21);
  if (!(d[2].lo > 0)) {
    return INFINITY;
  }
  for (int i = 0; i < 3; i++) {
    z[i] = (qn_interval){-a[6 + i].hi, -a[6 + i].lo};
    w[i] = (qn_interval){v[i], v[i]};
  }
  z[1] = minus(z[1], l10, z[0]);
  z[2] = minus(minus(z[2], l20, z[0]), l21, z[1]);
  w[1] = minus(w[1], l10, w[0]);
  w[2] = minus(minus(w[2], l20, w[0]), l21, w[1]);
  qn_interval centre = {0, 0}, spread = {0, 0}, rho = {-a[9].hi, -a[9].lo};
  for (int i = 0; i < 3; i++) {
    qn_interval zd = qn_interval_div(z[i], d[i]);
    centre = qn_interval_add(centre, mul(w[i], zd));
    rho = qn_interval_add(rho, mul(z[i], zd));
    spread = qn_interval_add(spread, qn_interval_div(mul(w[i], w[i]), d[i]));
  }
  if (!(rho.hi > 0)) {
    return centre.hi;
  }
  double reach = sqrt(qn_step_up(rho.hi * spread.hi));
  double r = qn_step_up(centre.hi + qn_step_up(reach));
  return r == r ? r : INFINITY;
}

/* A general quadric has no axis of its own: longitude and latitude about the origin. */
void qn_quadric_uv(const double *args, size_t n, const double placement[6], uint32_t role, const double x[3], double uv[2]) {
  qn_sphere_uv(args, n, placement, role, x, uv);
}
