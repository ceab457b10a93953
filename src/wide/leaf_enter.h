/* Where lanes enter a term that is one leaf. Static code of the packet body. */
#ifndef QN_WIDE_LEAF_ENTER_H
#define QN_WIDE_LEAF_ENTER_H

#include "wide/term.h"

/* The place of entry becomes the best where it is sooner; of two leaves with this surface there, the first in the file is named. */
QN_INLINE unsigned improve(walk *w, const qn_nterm *t, int g, vm m, vd t1, vd p1, lanes *best) {
  int o = g * QN_W;
  vm before, equal;
  vd limit_t = vload(best->t + o), limit_p = vload(best->p + o);
  order_entry(w, t, g, t1, p1, limit_t, limit_p, &m, &before, &equal);
  unsigned ties = vbits(equal);
  vstore(best->t + o, vpick(before, t1, limit_t)), vstore(best->p + o, vpick(before, p1, limit_p));
  if (QN_UNLIKELY(ties)) {
    _Alignas(64) double p[QN_W];
    vstore(p, p1);
    for (int i = 0; i < QN_W; i++) {
      if (ties >> i & 1) {
        uint64_t x, y;
        memcpy(&x, &p[i], 8), memcpy(&y, &best->p[o + i], 8);
        if ((x >> 32 & QN_LEAF_BITS) < (y >> 32 & QN_LEAF_BITS)) {
          best->p[o + i] = p[i];
        }
      }
    }
  }
  return vbits(before) | ties;
}

/* leaf_enter where some order of these lanes is not certain at once. */
static QN_NOINLINE uint64_t leaf_enter_near(walk *w, const qn_nterm *t, int g, unsigned in, const stretch *s, const lanes *from, lanes *best) {
  const vd start = vload(from->t + g * QN_W), pstart = vload(from->p + g * QN_W);
  vm m = vmask(in), before, equal, ahead;
  order(w, g, start, pstart, s->b, s->pb, &m, &ahead, &equal); /* not yet over */
  m = vand(m, ahead);
  order(w, g, start, pstart, s->a, s->pa, &m, &before, &equal);
  return (uint64_t)improve(w, t, g, m, vpick(before, s->a, start), vpick(before, s->pa, pstart), best) << (g * QN_W);
}

/* A term that is one leaf of a kind known here: solved and compared without leaving the registers. */
QN_INLINE void leaf_enter(walk *w, const qn_nterm *t, qn_piece_kind kind, const qn_piece_head *head, const lanes *from, uint64_t mask, lanes *best, uint64_t *found) {
  piece_constants k;
  if (kind == QN_PIECE_SPHERE) {
    sphere_prepare(&w->f, (const qn_piece_sphere *)(const void *)head, &k.sphere);
  } else {
    piece_prepare(w, head, &k);
  }
  uint64_t met = 0, solved = 0;
  while (mask) { /* group by group */
    const int g = (int)(qn_trailing_zeros(mask) / QN_W), o = g * QN_W;
    const unsigned in = (unsigned)(mask >> o) & QN_ALL_BITS;
    mask &= ~((uint64_t)QN_ALL_BITS << o);
    solved++;
    stretch s = kind == QN_PIECE_SPHERE ? sphere_solve(&w->f, &k.sphere, g) : kind == QN_PIECE_BOX ? box_solve(&w->f, &k.box, g) : piece_solve(w, head, &k, g);
    const unsigned doubted = vbits(s.unsure) & in;
    if (QN_UNLIKELY(doubted)) {
      w->unsure |= (uint64_t)doubted << o;
    }
    const vm m = vand(s.hit, vmask(in));
    if (!vbits(m)) {
      continue;
    }
    const vd all = CHECKED ? vmax(vload(w->tolerance + o), vpick(m, vadd(s.error, s.error), vset(0))) : vset(0);
    vstore(w->tolerance + o, all);
    const vd start = vload(from->t + o), limit = vload(best->t + o), to_entry = vsub(s.a, start);
    if (QN_LIKELY(!vbits(vandnot(m, vlt(all, to_entry))))) { /* mostly all begin before it, and so before its end */
      const vd ahead = vsub(limit, s.a);
      const vm better = vand(m, vlt(all, ahead));
      if (!CHECKED || QN_LIKELY(!vbits(vandnot(m, vlt(all, vabs(ahead)))))) {
        vstore(best->t + o, vpick(better, s.a, limit)), vstore(best->p + o, vpick(better, s.pa, vload(best->p + o)));
        met |= (uint64_t)vbits(better) << o;
        continue;
      }
    }
    /* Often the three orders below are certain; then they come out as here. */
    const vd pstart = vload(from->p + o);
    vd to_end = vsub(s.b, start);
    vm over = vandnot(m, vlt(all, to_end)), entered = vandnot(m, vlt(all, to_entry));
    vd t1 = vpick(entered, start, s.a), to_limit = vsub(limit, t1);
    vm sure = vand(vlt(all, vabs(to_end)), vor(over, vand(vlt(all, vabs(to_entry)), vlt(all, vabs(to_limit)))));
    if (!CHECKED || QN_LIKELY(!vbits(vandnot(m, sure)))) {
      vm better = vand(vandnot(m, over), vlt(all, to_limit));
      vstore(best->t + o, vpick(better, t1, limit));
      vstore(best->p + o, vpick(better, vpick(entered, pstart, s.pa), vload(best->p + o)));
      met |= (uint64_t)vbits(better) << o;
      continue;
    }
    const stretch near = {s.a, s.b, s.pa, s.pb, s.error, s.hit, s.unsure}; /* of its own: s then lives in registers */
    met |= leaf_enter_near(w, t, g, vbits(m), &near, from, best);
  }
  *found |= met, w->counts.leaves += solved;
}

/* Whether the piece alone says where it is entered. */
QN_INLINE int piece_enter(walk *w, const qn_nterm *t, const qn_piece_head *head, const lanes *from, uint64_t mask, lanes *best, uint64_t *found) {
  switch ((qn_piece_kind)head->kind) {
  case QN_PIECE_SPHERE: leaf_enter(w, t, QN_PIECE_SPHERE, head, from, mask & ~w->unsure, best, found); return 1;
  case QN_PIECE_BOX: leaf_enter(w, t, QN_PIECE_BOX, head, from, mask & ~w->unsure, best, found); return 1;
  case QN_PIECE_ROUND: case QN_PIECE_MEET: case QN_PIECE_HARD: break;
  }
  return 0;
}

#endif
