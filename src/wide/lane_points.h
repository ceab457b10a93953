/* Where the lanes of a packet are at some places: boxes about their points, and which terms' boxes these meet. Static code of the packet body. */
#ifndef QN_WIDE_LANE_POINTS_H
#define QN_WIDE_LANE_POINTS_H

#include "wide/walk.h"

/* Boxes of the lanes' points, of each lane, of each sub-packet and of all; slack for their rounding. */
typedef struct lane_points {
  _Alignas(64) double low[3][QN_LANES_NOW], high[3][QN_LANES_NOW];
  _Alignas(32) float min[3][8], max[3][8];
  float all_min[3], all_max[3];
} lane_points;

static void lane_points_of(const walk *w, const lanes *at, uint64_t mask, lane_points *s) {
  const qn_packet *p = w->f.p;
  for (int g = 0; g < QN_GROUPS; g++) {
    const int o = g * QN_W;
    const unsigned bits = (unsigned)(mask >> o) & QN_ALL_BITS;
    const vm in = vmask(bits);
    const vd t = vload(at->t + o), off = vmul(vload(w->tolerance + o), vset(4)), none = vset(INFINITY);
    for (int i = 0; i < 3; i++) {
      if (!bits) {
        vstore(s->low[i] + o, none), vstore(s->high[i] + o, vsub(vset(0), none));
        continue;
      }
      vd d = vload(p->d[i] + o), step = vmul(t, d), x = vadd(vload(p->o[i] + o), step);
      vd slack = vfma(vadd(vabs(step), vabs(x)), vset(QN_WIDE_SPOT), vmul(off, vabs(d)));
      slack = vadd(slack, vset(2 * QN_U * w->f.share[i]));
      vstore(s->low[i] + o, vpick(in, vsub(x, slack), none));
      /* cppcheck-suppress uninitvar ; written here */
      vstore(s->high[i] + o, vpick(in, vadd(x, slack), vsub(vset(0), none)));
    }
  }
  for (int i = 0; i < 3; i++) {
    _Alignas(64) double lows[SUBS], highs[SUBS];
    sub_extremes(s->low[i], 0, lows), sub_extremes(s->high[i], 1, highs);
    outward(lows, highs, s->min[i], s->max[i]);
    s->all_min[i] = fleast(fload(s->min[i])), s->all_max[i] = fmost(fload(s->max[i]));
  }
}

/* The lanes whose points' boxes meet a term's, of the sub-packets `in` whose boxes do. */
QN_INLINE uint64_t points_meet_term(const lane_points *s, const qn_nterm *t, unsigned in) {
  if (SUB_LANES == 1) {
    return in;
  }
  uint64_t lanes_in = 0;
  const vd low[3] = {vset(t->min[0]), vset(t->min[1]), vset(t->min[2])}, high[3] = {vset(t->max[0]), vset(t->max[1]), vset(t->max[2])};
  for (; in; in &= in - 1) {
    const unsigned first = qn_trailing_zeros(in) * SUB_LANES;
    for (unsigned at = first; at < first + SUB_LANES; at += QN_W) {
      vm m = vle(low[0], vload(s->high[0] + at));
      m = vand(m, vle(vload(s->low[0] + at), high[0]));
      for (int i = 1; i < 3; i++) {
        m = vand(m, vand(vle(low[i], vload(s->high[i] + at)), vle(vload(s->low[i] + at), high[i])));
      }
      lanes_in |= (uint64_t)vbits(m) << at;
    }
  }
  return lanes_in;
}

#endif
