/* How far four lanes each of a packet of 64 still look: spheres of a few pixels lie behind most of a packet's hits, and are not solved for those lanes. Static code of
   the packet body. */
#ifndef QN_WIDE_LASTS_H
#define QN_WIDE_LASTS_H

#include "wide/walk.h"

#if QN_LANES_NOW == 64
/* Of each four lanes a float not before their best places: what begins later need not be solved for them. */
enum { FOURS = QN_LANES_NOW / 4 };
typedef struct lasts { _Alignas(32) float of[FOURS]; } lasts;

/* changed: the lanes whose best place is another since. */
QN_INLINE void see_lasts(const walk *w, const lanes *best, uint64_t mask, uint64_t changed, lasts *last) {
  while (changed) {
    const unsigned o = qn_trailing_zeros(changed) & ~3u;
    changed &= ~((uint64_t)15 << o);
    double most_t = -0x1p+126; /* of no lane: finite, so that floats stay numbers */
    for (unsigned i = o; i < o + 4; i++) {
      const double t = mask >> i & 1 ? best->t[i] + w->tolerance[i] : most_t;
      most_t = t > most_t ? t : most_t;
    }
    last->of[o / 4] = up(most_t);
  }
}
/* The lanes that something from `near` on may matter to. */
QN_INLINE uint64_t lanes_before(const lasts *last, float near) {
  const uint64_t bits = fle(fset(near), fload(last->of)) | (uint64_t)fle(fset(near), fload(last->of + 8)) << 8;
  uint64_t x = (bits | bits << 24) & 0x000000ff000000ffu; /* each bit to a nibble */
  x = (x | x << 12) & 0x000f000f000f000fu;
  x = (x | x << 6) & 0x0303030303030303u;
  x = (x | x << 3) & 0x1111111111111111u;
  return x * 15;
}
QN_INLINE float last_of_all(const lasts *last) {
  _Alignas(32) float x[8];
  fstore(x, fmax8(fload(last->of), fload(last->of + 8)));
  float most_t = x[0];
  for (int i = 1; i < 8; i++) {
    most_t = x[i] > most_t ? x[i] : most_t;
  }
  return most_t;
}
#endif

#endif
