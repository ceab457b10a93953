/* How far four lanes each of a packet of 64 still look: spheres of a few pixels lie behind most of a packet's hits, and are not solved for those lanes. Static code of
   the packet body. */
#ifndef QN_WIDE_LASTS_H
#define QN_WIDE_LASTS_H

#include "wide/walk.h"

#if QN_LANES_NOW == 64
/* Of each four lanes (lanes_of_fours) a float not before their best places: what begins later need not be solved for them. */
enum { FOURS = QN_LANES_NOW / 4 };
typedef struct lasts { _Alignas(32) float of[FOURS]; } lasts;

/* changed: the lanes whose best place is another since. */
QN_INLINE void see_lasts(const walk *w, const lanes *best, uint64_t mask, uint64_t changed, lasts *last) {
  while (changed) {
    const unsigned o = qn_trailing_zeros(changed) & ~3u;
    changed &= ~((uint64_t)15 << o);
    last->of[o / 8 + 2 * (o & 4)] = up(vfour_most(best->t + o, w->tolerance + o, (unsigned)(mask >> o) & 15));
  }
}
/* The fours that something from `near` on may matter to. */
QN_INLINE unsigned fours_before(const lasts *last, float near) { return fle(fset(near), fload(last->of)) | fle(fset(near), fload(last->of + 8)) << 8; }
QN_INLINE float last_of_all(const lasts *last) { return fmost(fmax8(fload(last->of), fload(last->of + 8))); }
#endif

#endif
