/* A place on a plane across an axis, precise enough to round it: t = (X - o) / d in one coordinate, X the plane's place as a sum of two doubles. Static code of
   spans_round.wide.c and its test.

   Legend: X = h + l + e, |e| <= 2^-105 |X|, |l| <= u |h|; w + w' = h - o exactly; i = fl(1/d); q = fl(w i); q d = p + p' exactly. Then t - q = (w - p - p' + w' + l + e) / d. As
   q is within 3u of w/d, w - p is exact. Bound: docs/bounds.md, QN_ROUND_FLAT. */
#ifndef QN_WIDE_SPANS_FLAT_H
#define QN_WIDE_SPANS_FLAT_H

#include "base/bounds.h"
#include "wide/vec.h"

/* The place as an unevaluated sum, a bound of its error, and the lanes in which the bound holds. */
typedef struct flat_place { vdd sum; vd error; vm sound; } flat_place;

QN_INLINE flat_place flat_at(vd high, vd low, vd o, vd d, vd inverse) {
  const vd least = vset(1 / QN_ROUND_WIDEST), most = vset(QN_ROUND_WIDEST);
  vdd w = vtwo_difference(high, o);
  vd q = vmul(w.hi, inverse), size = vadd(vabs(high), vabs(o)), steep = vabs(inverse);
  vdd p = vtwo_product(q, d);
  vd rest = vadd(vsub(vsub(w.hi, p.hi), p.lo), vadd(w.lo, low));
  flat_place f = {.sum = vtwo_sum(q, vmul(rest, inverse)), .error = vmul(vmul(vset(QN_ROUND_FLAT), size), steep)};
  f.sound = vand(vand(vle(least, vabs(w.hi)), vle(size, most)), vand(vle(least, steep), vle(steep, most)));
  return f;
}

/* The lanes whose *out is certainly the nearest double: Ziv's test, as in wide/newton.h. */
QN_INLINE unsigned flat_round(vd high, vd low, vd o, vd d, vd inverse, vd *out) {
  const flat_place f = flat_at(high, low, o, d, inverse);
  const vd zero = vset(0), error = vmul(vset(QN_SLACK), vfma(vset(4 * QN_U), vabs(f.sum.lo), f.error));
  vm same = vand(veq(vadd(f.sum.hi, vadd(f.sum.lo, error)), f.sum.hi), veq(vadd(f.sum.hi, vsub(f.sum.lo, error)), f.sum.hi));
  vm nonzero = vor(vlt(f.sum.hi, zero), vlt(zero, f.sum.hi));
  *out = f.sum.hi;
  return vbits(vand(vand(same, nonzero), f.sound));
}

#endif
