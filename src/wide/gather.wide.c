/* Rays of an array into a packet's lanes, and what is seen of them on the way: compiled once for each instruction set. */
#include "base/bounds.h"
#include "wide/packet.h"
#include "wide/vec.h"

#include <emmintrin.h>
#include <math.h>
#include <stddef.h>

/* Of an 8 by 8 tile, row after row. */
#define ROW_OF(r) (r), (r) + 1, (r) + 4, (r) + 5, (r) + 16, (r) + 17, (r) + 20, (r) + 21
static const uint8_t TILE_LANE[QN_LANES] = {ROW_OF(0), ROW_OF(2), ROW_OF(8), ROW_OF(10), ROW_OF(32), ROW_OF(34), ROW_OF(40), ROW_OF(42)};

/* A ray's numbers two by two; o0 and o1 are left out. */
_Static_assert(sizeof(quoin_ray) == 64 && offsetof(quoin_ray, d) == 24 && offsetof(quoin_ray, from) == 48 && offsetof(quoin_ray, to) == 56, "a ray is eight doubles");
typedef struct pairs { __m128i z_x, y_z, range; } pairs; /* o2 d0, d1 d2, from to */

QN_INLINE pairs pairs_of(const quoin_ray *r) {
  return (pairs){_mm_loadu_si128((const void *)(r->o + 2)), _mm_loadu_si128((const void *)(r->d + 1)), _mm_loadu_si128((const void *)&r->from)};
}

/* The bits in which rays differ from the first: of ways in the first word, of ranges in the second. */
QN_INLINE void differences(pairs all, uint64_t differ[2]) {
  uint64_t zx[2], yz[2], range[2];
  _mm_storeu_si128((void *)zx, all.z_x), _mm_storeu_si128((void *)yz, all.y_z), _mm_storeu_si128((void *)range, all.range);
  differ[0] |= zx[1] | yz[0] | yz[1], differ[1] |= range[0] | range[1];
}

QN_INLINE void compare(pairs a, pairs b, pairs *all) {
  all->z_x = _mm_or_si128(all->z_x, _mm_xor_si128(a.z_x, b.z_x)), all->y_z = _mm_or_si128(all->y_z, _mm_xor_si128(a.y_z, b.y_z));
  all->range = _mm_or_si128(all->range, _mm_xor_si128(a.range, b.range));
}

/* Origins into lanes. which: null, for a tile row after row. n: a constant where all lanes are there. */
QN_INLINE void gather_origins(const quoin_ray *rays, const uint16_t *which, unsigned n, qn_packet *p, uint64_t differ[2]) {
  const pairs first = pairs_of(&rays[which ? which[0] : 0]);
  pairs all = {_mm_setzero_si128(), _mm_setzero_si128(), _mm_setzero_si128()};
  for (unsigned i = 0; i < QN_LANES; i++) {
    const unsigned from = n == QN_LANES || i < n ? i : n - 1, lane = which ? i : TILE_LANE[i];
    const quoin_ray *r = &rays[which ? which[from] : from];
    p->o[0][lane] = r->o[0], p->o[1][lane] = r->o[1], p->o[2][lane] = r->o[2];
    compare(pairs_of(r), first, &all);
  }
  differences(all, differ);
}

QN_INLINE void each(double to[QN_LANES], double x) {
  const vd v = vset(x);
  for (unsigned i = 0; i < QN_LANES; i += QN_W) {
    vstore(to + i, v);
  }
}

/* Whether all origins (and, where they are not the same, directions) are finite. */
QN_INLINE int are_finite(const qn_packet *p, int ways) {
  const vd zero = vset(0);
  vd sum = zero; /* 0 times what is not finite is not 0 */
  for (unsigned i = 0; i < QN_LANES; i += QN_W) {
    for (int k = 0; k < 3; k++) {
      sum = vadd(sum, vmul(vload(p->o[k] + i), zero));
      if (ways) {
        sum = vadd(sum, vmul(vload(p->d[k] + i), zero));
      }
    }
  }
  return vbits(veq(sum, zero)) == QN_ALL_BITS;
}

static int are_ranges(const qn_packet *p, unsigned step) {
  int good = 1;
  for (unsigned i = 0; i < QN_LANES; i += step) {
    good &= p->from[i] <= p->to[i] && p->from[i] < HUGE_VAL && p->to[i] > -HUGE_VAL;
  }
  return good;
}

static int have_ways(const qn_packet *p, unsigned step) {
  int good = 1;
  for (unsigned i = 0; i < QN_LANES; i += step) {
    good &= fabs(p->d[0][i]) + fabs(p->d[1][i]) + fabs(p->d[2][i]) > 0;
  }
  return good;
}

QN_INLINE double largest_of(vd v) {
  _Alignas(64) double x[QN_W];
  vstore(x, v);
  double most = x[0];
  for (int i = 1; i < QN_W; i++) {
    most = x[i] > most ? x[i] : most;
  }
  return most;
}

/* The largest square of a distance of a line from the first one, across that one's direction, times that one's square; and whether all go within some tens of degrees of it. */
QN_INLINE double width2(const qn_packet *p, int ways, int *together) {
  const vd x0 = vset(p->o[0][0]), y0 = vset(p->o[1][0]), z0 = vset(p->o[2][0]), dx = vset(p->d[0][0]), dy = vset(p->d[1][0]), dz = vset(p->d[2][0]);
  const vd square = vmul(vset(0.8), vfma(dx, dx, vfma(dy, dy, vmul(dz, dz)))), zero = vset(0);
  vd most = zero;
  unsigned all = QN_ALL_BITS;
  for (unsigned i = 0; i < QN_LANES; i += QN_W) {
    const vd x = vsub(vload(p->o[0] + i), x0), y = vsub(vload(p->o[1] + i), y0), z = vsub(vload(p->o[2] + i), z0);
    const vd u = vfms(y, dz, vmul(z, dy)), v = vfms(z, dx, vmul(x, dz)), w = vfms(x, dy, vmul(y, dx));
    most = vmax(most, vfma(u, u, vfma(v, v, vmul(w, w))));
    if (ways) {
      const vd a = vload(p->d[0] + i), b = vload(p->d[1] + i), c = vload(p->d[2] + i);
      const vd way = vfma(a, dx, vfma(b, dy, vmul(c, dz))), length = vfma(a, a, vfma(b, b, vmul(c, c)));
      all &= vbits(vand(vlt(zero, way), vlt(vmul(square, length), vmul(way, way))));
    }
  }
  *together = all == QN_ALL_BITS;
  return largest_of(most);
}

void QN_OF_ISA(qn_gather)(const quoin_ray *rays, const uint16_t *which, unsigned n, qn_packet *p, qn_gathered *g);
void QN_OF_ISA(qn_gather)(const quoin_ray *rays, const uint16_t *which, unsigned n, qn_packet *p, qn_gathered *g) {
  const quoin_ray *first = &rays[which ? which[0] : 0];
  uint64_t differ[2] = {0, 0}, held[2] = {0, 0};
  if (n < QN_LANES) {
    gather_origins(rays, which, n, p, differ);
  } else if (which) {
    gather_origins(rays, which, QN_LANES, p, differ);
  } else {
    gather_origins(rays, NULL, QN_LANES, p, differ);
  }
  if (g->one_way || g->one_range) {
    const quoin_ray before = {{0, 0, 0}, {p->d[0][0], p->d[1][0], p->d[2][0]}, p->from[0], p->to[0]};
    pairs all = {_mm_setzero_si128(), _mm_setzero_si128(), _mm_setzero_si128()};
    compare(pairs_of(first), pairs_of(&before), &all);
    differences(all, held);
  }
  g->new_ways = !g->one_way || differ[0] || held[0];
  g->new_ranges = !g->one_range || differ[1] || held[1];
  g->one_way = !differ[0], g->one_range = !differ[1];
  for (int k = 0; g->new_ways && k < 3; k++) {
    each(p->d[k], first->d[k]);
  }
  if (g->new_ranges) {
    each(p->from, first->from), each(p->to, first->to);
  }
  for (unsigned i = 0; (differ[0] || differ[1]) && i < QN_LANES; i++) {
    const quoin_ray *r = i < n ? &rays[which ? which[i] : i] : &rays[which ? which[n - 1] : n - 1];
    const unsigned lane = which ? i : TILE_LANE[i];
    p->d[0][lane] = r->d[0], p->d[1][lane] = r->d[1], p->d[2][lane] = r->d[2];
    p->from[lane] = r->from, p->to[lane] = r->to;
  }
  g->rays = are_finite(p, g->new_ways) && (!g->new_ranges || are_ranges(p, g->one_range ? QN_LANES : 1)) && (!g->new_ways || have_ways(p, g->one_way ? QN_LANES : 1));
  g->width2 = width2(p, !g->one_way, &g->together);
}

/* Lanes in which a + b, b finite, is itself a double, or a is infinite. */
QN_INLINE vm sums_exactly(vd a, vd b) {
  const vd sum = vadd(a, b), back = vsub(sum, a), rest = vadd(vsub(a, vsub(sum, back)), vsub(b, back));
  return vor(veq(rest, vset(0)), vle(vset(INFINITY), vabs(a)));
}

/* Legend: blocked.c in query. Bounds: docs/bounds.md, "Moved starts". */
void QN_OF_ISA(qn_move)(qn_packet *p);
void QN_OF_ISA(qn_move)(qn_packet *p) {
  const vd d[3] = {vset(p->d[0][0]), vset(p->d[1][0]), vset(p->d[2][0])}, zero = vset(0);
  const vd share = vdiv(vset(1), vfma(d[0], d[0], vfma(d[1], d[1], vmul(d[2], d[2]))));
  _Alignas(64) double depth[QN_LANES];
  vd least = vset(INFINITY), most[3] = {zero, zero, zero};
  for (unsigned i = 0; i < QN_LANES; i += QN_W) {
    const vd x = vmul(share, vfma(d[0], vload(p->o[0] + i), vfma(d[1], vload(p->o[1] + i), vmul(d[2], vload(p->o[2] + i)))));
    vstore(depth + i, x);
    least = vmin(least, x);
  }
  const vd first = vset(-largest_of(vsub(zero, least)));
  for (unsigned i = 0; i < QN_LANES; i += QN_W) {
    const vd from = vload(p->from + i), to = vload(p->to + i), far = vsub(vload(depth + i), first);
    const vm good = vand(vand(vlt(zero, far), vlt(far, vset(INFINITY))), vand(sums_exactly(from, far), sums_exactly(to, far)));
    const vd s = vpick(good, far, zero);
    vstore(p->from + i, vadd(from, s)), vstore(p->to + i, vadd(to, s));
    for (int k = 0; k < 3; k++) {
      const vd way = vmul(s, d[k]), o = vsub(vload(p->o[k] + i), way);
      vstore(p->o[k] + i, o);
      most[k] = vmax(most[k], vadd(vabs(way), vabs(o)));
    }
  }
  for (int k = 0; k < 3; k++) {
    p->moved[k] = QN_SLACK * largest_of(most[k]) + QN_POINT_TINY;
  }
  p->tile = QN_TILE_MOVED;
}
