/* The superquadric's inside-outside function along a line, in doubles. Letters: super_line.h; errors: docs/bounds.md,
   QN_SUPER_VALUE.

   df/dt = q [rho^q (rho'/rho) + z^q (Z'/Z)], rho'/rho = (x^p X'/X + y^p Y'/Y)/(x^p + y^p): every power is used for the value
   and, over its coordinate, for the slope. A coordinate that is 0 adds nothing to the slope: where p, q >= 1 that is a
   subgradient; where not, the callers keep away from coordinate planes that the line crosses. */
#include "shape/super_line.h"

#include "base/attrs.h"

#include <float.h>
#include <math.h>

static unsigned halves(double p) {
  double twice = 2 * p;
  return twice >= 1 && twice <= QN_SUPER_HALVES && twice == floor(twice) ? (unsigned)twice : 0;
}

double qn_super_off(const qn_super_frame *f, int i, double most) {
  double off = f->O_off[i] + 3 * most * f->D_off[i];
  if (f->O[i][1] != 0 || f->D[i][1] != 0) {
    off += QN_SUPER_LOW * (fabs(f->O[i][0]) + 3 * most * fabs(f->D[i][0]));
  }
  return off;
}

/* Exponents that are not 2, or a special case, but round to it, are left to the careful search, or are none. */
static int settle_exponents(const qn_super_frame *f, qn_super_line *out) {
  double e = f->e[0], n = f->n[0];
  if (!((e >= QN_SUPER_LEAST || e == 0) && n >= QN_SUPER_LEAST && e <= QN_SUPER_MOST && n <= QN_SUPER_MOST && e <= QN_SUPER_QUOTIENT * n)) {
    return 0;
  }
  if ((e == 2 && f->e[1] != 0) || (n == 2 && f->n[1] != 0)) {
    return 0;
  }
  out->e = e, out->n = n, out->p = e > 0 ? 2 / e : INFINITY, out->q = 2 / n, out->s = e / n;
  out->e_rest = f->e[1], out->n_rest = f->n[1];
  out->inner = e == n && f->e[1] == f->n[1] ? QN_SUPER_SAME
               : e == 1 && f->e[1] == 0     ? QN_SUPER_ROUND
               : e == 2                     ? QN_SUPER_SUM
               : e == 0                     ? QN_SUPER_LARGER
                                            : QN_SUPER_ANY;
  out->p2 = halves(out->p), out->q2 = halves(out->q), out->r2 = halves(0.5 * out->q);
  out->convex = e <= 2 && n <= 2;
  return 1;
}

int qn_super_line_make(const qn_super_frame *frame, double a, double b, qn_super_line *out) {
  double most = 0, end = fmax(fabs(a), fabs(b)), off = 0, rate = 0;
  for (int i = 0; i < 3; i++) {
    double o = frame->O[i][0], d = frame->D[i][0], size = fabs(d);
    if ((size < QN_SUPER_SHORT && size > 0) || (fabs(o) < QN_SUPER_SHORT && o != 0)) {
      return 0; /* else no power of a coordinate loses bits to underflow that count */
    }
    most = size > most ? size : most;
    out->O[i] = o, out->D[i] = d;
    out->O_rest[i] = frame->O[i][1], out->D_rest[i] = frame->D[i][1];
    out->off[i] = qn_super_off(frame, i, end);
    off += out->off[i];
    rate += frame->D_off[i];
  }
  if (!(most > 0 && most <= QN_SUPER_LONG) || !(off < 0x1p-20) || !settle_exponents(frame, out)) {
    return 0;
  }
  out->shift = 1.125 * out->q * off;
  out->drift = 1.125 * out->q * rate;
  out->crude = 2 * (1 + (out->e > 0 ? out->p : 0) + out->q);
  out->size = 2 / most;
  out->faded = QN_SUPER_FADED * most;
  out->error = QN_SUPER_VALUE(out->inner == QN_SUPER_ANY ? out->s : 0, out->q);
  out->scale = 1;
  out->fine = 0;
  return 1;
}

int qn_super_finer(const qn_super_line *c, qn_super_line *out) {
  if (c->fine || LDBL_MANT_DIG < 64) {
    return 0;
  }
  *out = *c;
  out->fine = 1;
  out->scale = QN_SUPER_FINER;
  return 1;
}

qn_super_line qn_super_reversed(const qn_super_line *c) {
  qn_super_line r = *c;
  for (int i = 0; i < 3; i++) {
    r.D[i] = -r.D[i];
    r.D_rest[i] = -r.D_rest[i];
  }
  return r;
}

static double error_of(const qn_super_line *c, double f) {
  double beyond = f > 1 ? QN_SUPER_BEYOND * (f - 1) : 0;
  return c->scale * ((c->error + beyond) * f + QN_SUPER_VALUE_0);
}

/* The coordinates' errors beyond their roundings. Convex: |df/dX_i| <= q max(1, f). */
QN_INLINE void admit_convex(const qn_super_line *c, double f, qn_super_look *r) {
  double most = f > 1 ? f : 1;
  r->error += c->shift * most;
  r->slope_error += c->drift * most;
}

/* Else f(X) is within (1 + r)^q of f(X^) where every |X_i - X_i^| <= r |X_i^|. all, rising: of the magnitudes of the addends of df/dt and of d(rho^q)/dt. */
static void admit(const qn_super_line *c, const double x[3], double f, double all, double rising, qn_super_look *r) {
  double share = 0;
  for (int i = 0; i < 3; i++) {
    double s = c->off[i] > 0 ? c->off[i] / x[i] : 0;
    share = s > share ? s : share;
  }
  r->crude = c->crude * share;
  if (r->crude <= QN_SUPER_CRUDE) {
    r->error += 2.25 * c->q * share * f;
    r->slope_error += r->crude * all;
    r->rise_error += r->crude * rising;
  } else {
    r->error = r->slope_error = r->rise_error = INFINITY;
  }
}

/* x^p; twice: 2p, or 0 when it is no small integer. */
QN_INLINE double power(double x, double p, unsigned twice) {
  if (!twice) {
    return exp2(p * log2(x)); /* 0 at 0 */
  }
  double r = twice & 1 ? sqrt(x) : 1;
  for (unsigned k = twice >> 1; k; k >>= 1) {
    r = k & 1 ? r * x : r;
    x *= x;
  }
  return r;
}

static qn_super_look look(const qn_super_line *c, double t) {
  double X = qn_super_along(c, 0, t), Y = qn_super_along(c, 1, t), Z = qn_super_along(c, 2, t);
  double x = fabs(X), y = fabs(Y), z = fabs(Z), inner = 0, gx = 0, gy = 0, k; /* gx: what x adds to f'/q, over X' */
  double outer = power(z, c->q, c->q2), gz = z > 0 ? outer / Z : 0;
  switch (c->inner) {
  case QN_SUPER_SAME:
    gx = power(x, c->p, c->p2), gy = power(y, c->p, c->p2);
    inner = gx + gy;
    gx = x > 0 ? gx / X : 0, gy = y > 0 ? gy / Y : 0;
    break;
  case QN_SUPER_ROUND:
    k = x * x + y * y;
    inner = power(k, 0.5 * c->q, c->r2);
    k = k > 0 ? inner / k : 0;
    gx = k * X, gy = k * Y;
    break;
  case QN_SUPER_SUM:
    k = x + y;
    inner = power(k, c->q, c->q2);
    k = k > 0 ? inner / k : 0;
    gx = x > 0 ? copysign(k, X) : 0, gy = y > 0 ? copysign(k, Y) : 0;
    break;
  case QN_SUPER_LARGER:
    k = x > y ? x : y;
    inner = power(k, c->q, c->q2);
    gx = x > y ? inner / X : 0, gy = !(x > y) && y > 0 ? inner / Y : 0;
    break;
  case QN_SUPER_ANY: {
    double a = x > y ? x : y, b = x > y ? y : x, w = 0, l = 0;
    if (b > 0) {
      w = power(b / a, c->p, c->p2);
      l = c->s * log2(1 + w);
    }
    inner = c->q2 ? power(a, c->q, c->q2) * exp2(l) : exp2(c->q * log2(a) + l);
    k = inner / (1 + w);
    w *= k;
    gx = x > 0 ? (x > y ? k : w) / X : 0, gy = y > 0 ? (x > y ? w : k) / Y : 0;
    break;
  }
  }
  gx *= c->q * c->D[0], gy *= c->q * c->D[1], gz *= c->q * c->D[2];
  double f = inner + outer, rise = gx + gy, all = fabs(gx) + fabs(gy);
  qn_super_look r = {f - 1, rise + gz, error_of(c, f), QN_SUPER_RATE * (all + fabs(gz)) + c->faded, inner, rise, QN_SUPER_RATE * all + c->faded, outer, 0};
  if (c->convex) {
    admit_convex(c, f, &r);
  } else if (c->shift > 0) {
    admit(c, (double[3]){x, y, z}, f, all + fabs(gz), all, &r);
  }
  return r;
}

/* --- in long doubles ---------------------------------------------------------------------------------------------- */

static long double finely_powered(long double x, long double p, unsigned twice) {
  if (!twice) {
    return exp2l(p * log2l(x));
  }
  long double r = twice & 1 ? sqrtl(x) : 1;
  for (unsigned k = twice >> 1; k; k >>= 1) {
    r = k & 1 ? r * x : r;
    x *= x;
  }
  return r;
}

/* O + t D: product and sum each with its exact remainder. */
static long double finely_along(const qn_super_line *c, int i, double t) {
  double o = c->O[i], d = c->D[i], product = d * t, rest = fma(d, t, -product), sum = o + product, part = sum - o;
  return (long double)sum + ((long double)((o - (sum - part)) + (product - part)) + rest + (c->O_rest[i] + (long double)c->D_rest[i] * t));
}

/* As look(), with the exponents not rounded: twice p counts only where it is exact. */
static qn_super_look look_finely(const qn_super_line *c, double t) {
  const long double e = (long double)c->e + c->e_rest, n = (long double)c->n + c->n_rest;
  long double X[3], x[3], g[3] = {0}, p = 2 / e, q = 2 / n, inner = 0, k;
  unsigned p2 = c->e_rest == 0 && e * c->p2 == 4 ? c->p2 : 0, q2 = c->n_rest == 0 && n * c->q2 == 4 ? c->q2 : 0;
  unsigned r2 = c->n_rest == 0 && n * c->r2 == 2 ? c->r2 : 0;
  for (int i = 0; i < 3; i++) {
    X[i] = finely_along(c, i, t);
    x[i] = fabsl(X[i]);
  }
  long double outer = finely_powered(x[2], q, q2);
  g[2] = x[2] > 0 ? outer / X[2] : 0;
  switch (c->inner) {
  case QN_SUPER_SAME:
    for (int i = 0; i < 2; i++) {
      k = finely_powered(x[i], p, p2);
      inner += k;
      g[i] = x[i] > 0 ? k / X[i] : 0;
    }
    break;
  case QN_SUPER_ROUND:
    k = x[0] * x[0] + x[1] * x[1];
    inner = finely_powered(k, q / 2, r2);
    k = k > 0 ? inner / k : 0;
    g[0] = k * X[0], g[1] = k * X[1];
    break;
  case QN_SUPER_SUM:
    k = x[0] + x[1];
    inner = finely_powered(k, q, q2);
    k = k > 0 ? inner / k : 0;
    g[0] = x[0] > 0 ? copysignl(k, X[0]) : 0, g[1] = x[1] > 0 ? copysignl(k, X[1]) : 0;
    break;
  case QN_SUPER_LARGER: {
    int big = x[0] > x[1] ? 0 : 1;
    inner = finely_powered(x[big], q, q2);
    g[big] = x[big] > 0 ? inner / X[big] : 0, g[1 - big] = 0;
    break;
  }
  case QN_SUPER_ANY: {
    int big = x[0] > x[1] ? 0 : 1;
    long double a = x[big], b = x[1 - big], w = 0, l = 0;
    if (b > 0) {
      w = finely_powered(b / a, p, p2);
      l = e / n * log2l(1 + w);
    }
    inner = q2 ? finely_powered(a, q, q2) * exp2l(l) : exp2l(q * log2l(a) + l);
    k = inner / (1 + w);
    g[big] = a > 0 ? k / X[big] : 0, g[1 - big] = b > 0 ? k * w / X[1 - big] : 0;
    break;
  }
  }
  long double slope = 0, all = 0, f = inner + outer;
  for (int i = 0; i < 3; i++) {
    g[i] *= q * c->D[i];
    slope += g[i], all += fabsl(g[i]);
  }
  qn_super_look r = {.over = (double)(f - 1), .slope = (double)slope, .slope_error = QN_SUPER_RATE * (double)all + c->faded};
  r.inner = (double)inner, r.rise = (double)(g[0] + g[1]), r.outer = (double)outer;
  r.rise_error = QN_SUPER_RATE * (double)(fabsl(g[0]) + fabsl(g[1])) + c->faded;
  r.error = error_of(c, (double)f) + QN_U * fabs(r.over);
  if (c->convex) {
    admit_convex(c, (double)f, &r);
  } else if (c->shift > 0) {
    admit(c, (double[3]){(double)x[0], (double)x[1], (double)x[2]}, (double)f, (double)all, (double)(fabsl(g[0]) + fabsl(g[1])), &r);
  }
  return r;
}

qn_super_look qn_super_look_at(const qn_super_line *c, double t) { return c->fine ? look_finely(c, t) : look(c, t); }
