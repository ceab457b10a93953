/* One Newton step against QN_W places at once, precise enough to round a place to the nearest double, and the test that says when
   it did. Static code, included by the body that is compiled for each instruction set (round.wide.c) and by its test.

   Legend: q the surface's form about its pivot c (scene/rounding.h), y = o - c + t d, p(t) = q(y), r the root, |r - t| <= e. Low
   parts are a unit or so in the last place of what they belong to; what is of second order to them is dropped. With rho = r - t,
   p + p' rho + a rho^2 = 0 exactly (p, p' at t, a = q2(d)). Where |a| e and the slope's error are together below half of |p'^|,
   |rho| <= g = 2 |p| / |p'^|, so that delta = -p^/p'^ has
       |rho - delta| <= (|p - p^| + |p' - p'^| g + |a| g^2) / |p'^|.
   Then Ziv's test, as in ray/round.c. Bounds: docs/bounds.md, QN_ROUND_EVAL, QN_ROUND_SLOPE. */
#ifndef QN_WIDE_NEWTON_H
#define QN_WIDE_NEWTON_H

#include "base/bounds.h"
#include "scene/rounding.h"
#include "wide/vec.h"

/* The numbers of the surfaces of QN_W lanes: of one for all of them (shared), or of one each. terms: bit i, k_i may be other than 0;
   axes: bit j, y_j occurs. */
typedef struct surface_numbers {
  const double *k[QN_W]; /* shared: k[0] alone */
  unsigned terms, axes;
  int shared;
  int pairs; /* the rays have low parts */
} surface_numbers;
QN_INLINE vd number_of(const surface_numbers *f, int i) { return f->shared ? vset(f->k[0][i]) : vcollect(f->k, i); }
QN_INLINE vd hi_of(const surface_numbers *f, int i) { return number_of(f, QN_ROUNDING_HI + i); }
QN_INLINE vd lo_of(const surface_numbers *f, int i) { return number_of(f, QN_ROUNDING_LO + i); }

typedef struct rough_places { vd o[3], d[3], t, e, olow[3], dlow[3]; } rough_places; /* low parts: where the surface_numbers say so */

/* p and p' at t; bounds of their errors and of |a|; the lanes in whose range the bounds hold. */
typedef struct residual { vd p, slope, p_error, slope_error, curve; vm sound; } residual;

/* sum += (hi + lo) x */
QN_INLINE void add_term(vdd *sum, vd hi, vd lo, vd x) {
  vdd p = vtwo_product(hi, x), s = vtwo_sum(sum->hi, p.hi);
  sum->hi = s.hi;
  sum->lo = vadd(sum->lo, vadd(s.lo, vfma(lo, x, p.lo)));
}

/* Where the line is at t: y + low, and what is summed up on the way. Everything below is called with constants for i and j and for the
   terms and axes of f, so that each kind of form has straight code of its own. */
typedef struct spot { vd y[3], low[3], g[3], S, D; } spot;

QN_INLINE void find_coordinate(const surface_numbers *f, const rough_places *at, int j, spot *s) {
  s->y[j] = s->low[j] = s->g[j] = vset(0);
  if (f->axes >> j & 1) {
    vdd w = vtwo_difference(at->o[j], number_of(f, QN_ROUNDING_PIVOT + j)), m = vtwo_product(at->t, at->d[j]);
    vdd x = vtwo_sum(w.hi, m.hi);
    s->y[j] = x.hi, s->low[j] = vadd(vadd(w.lo, m.lo), x.lo);
    s->S = vadd(s->S, vadd(vabs(w.hi), vabs(m.hi))), s->D = vadd(s->D, vabs(at->d[j]));
    if (f->pairs) {
      s->low[j] = vadd(s->low[j], vfma(at->t, at->dlow[j], at->olow[j]));
      s->S = vadd(s->S, vabs(at->o[j]));
    }
  }
}

/* k_at y_i y_j in row i, and in the gradient's component j (in component i it comes with the row). */
QN_INLINE void add_product(const surface_numbers *f, int at, int i, int j, spot *s, vdd *row) {
  if (f->terms >> at & 1) {
    add_term(row, hi_of(f, at), lo_of(f, at), s->y[j]);
    s->g[j] = vfma(hi_of(f, at), s->y[i], s->g[j]);
  }
}

/* (...) y_i of (A x + D y + E z + G) x + (B y + F z + H) y + (C z + I) z + J; square, first and second: the terms' places. */
QN_INLINE void add_row(const surface_numbers *f, int i, int square, int first, int second, spot *s, vdd *p) {
  if (f->axes >> i & 1) {
    vdd row = {hi_of(f, 6 + i), lo_of(f, 6 + i)};
    add_product(f, square, i, i, s, &row);
    if (i < 2) {
      add_product(f, first, i, i + 1, s, &row);
    }
    if (i < 1) {
      add_product(f, second, i, i + 2, s, &row);
    }
    s->g[i] = vadd(s->g[i], row.hi);
    add_term(p, row.hi, row.lo, s->y[i]);
  }
}

QN_INLINE residual residual_at(const surface_numbers *f, const rough_places *at) {
  const vd zero = vset(0);
  spot s = {.S = zero, .D = zero};
  find_coordinate(f, at, 0, &s);
  find_coordinate(f, at, 1, &s);
  find_coordinate(f, at, 2, &s);
  vdd p = {hi_of(f, 9), lo_of(f, 9)};
  add_row(f, 0, 0, 3, 4, &s, &p);
  add_row(f, 1, 1, 5, 0, &s, &p);
  add_row(f, 2, 2, 0, 0, &s, &p);
  vd slope = zero, rest = zero;
  for (int j = 0; j < 3; j++) {
    if (f->axes >> j & 1) {
      slope = vfma(s.g[j], at->d[j], slope), rest = vfma(s.g[j], s.low[j], rest);
    }
  }
  vd K2 = number_of(f, QN_ROUNDING_SQUARE), K1 = number_of(f, QN_ROUNDING_LINEAR), K0 = number_of(f, QN_ROUNDING_CONSTANT);
  vd KS = f->terms & 63 ? vmul(K2, s.S) : zero;
  residual r = {.p = vadd(p.hi, vadd(p.lo, rest)), .slope = slope};
  r.p_error = vmul(vset(f->pairs ? QN_ROUND_PAIR_EVAL : QN_ROUND_EVAL), vfma(vadd(KS, K1), s.S, K0));
  r.slope_error = vmul(vmul(vset(QN_ROUND_SLOPE), s.D), vadd(vadd(KS, KS), K1));
  r.curve = f->terms & 63 ? vmul(vmul(K2, s.D), s.D) : zero;
  r.sound = vand(vle(s.S, vset(QN_ROUND_LARGEST)), vand(vle(vset(1 / QN_ROUND_WIDEST), s.D), vle(s.D, vset(QN_ROUND_WIDEST))));
  return r;
}

/* The lanes whose *out is certainly the double nearest to their root. */
QN_INLINE vm round_places(const surface_numbers *f, const rough_places *at, vd *out) {
  const vd slack = vset(QN_SLACK), four_u = vset(4 * QN_U), zero = vset(0);
  residual r = residual_at(f, at);
  vd steep = vabs(r.slope), bend = vmul(slack, vfma(r.curve, at->e, r.slope_error));
  vm alone = vlt(vadd(bend, bend), steep);
  vd inverse = vdiv(vset(1), r.slope), size = vabs(inverse), step = vmul(r.p, inverse); /* -delta */
  vd length = vabs(step), g = vmul(vset(2), vfma(r.p_error, size, length));
  vd error = vfma(vfma(vfma(r.curve, g, r.slope_error), g, r.p_error), size, vmul(four_u, length));
  vdd sum = vtwo_difference(at->t, step);
  error = vmul(slack, vfma(four_u, vabs(sum.lo), vmul(slack, error)));
  vm same = vand(veq(vadd(sum.hi, vadd(sum.lo, error)), sum.hi), veq(vadd(sum.hi, vsub(sum.lo, error)), sum.hi));
  vm nonzero = vor(vlt(sum.hi, zero), vlt(zero, sum.hi));
  *out = sum.hi;
  return vand(vand(same, nonzero), vand(alone, r.sound));
}

#endif
