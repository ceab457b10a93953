/* Which lanes may meet a ball, seen along the one direction that all of them have: there lanes are points, the ball is a disc. Of a tile of origins, four lanes are two columns and
   two rows (packet.h) and lie in a small disc of their own, where the boxes of eight that other leaves are asked about reach beyond them on all sides; of other packets each lane is asked.
   Static code of the packet body.

   Legend: e the two axes across the direction, unit vectors; places are told from `ref`, a lane's start. docs/bounds.md, QN_OUTLINE_PLACE. */
#ifndef QN_WIDE_OUTLINE_H
#define QN_WIDE_OUTLINE_H

#include "wide/walk.h"

#if QN_LANES_NOW == 64
/* Axes across the direction; the first one along the rows of a tile of origins, where it can be. It matters only for how near the discs come. */
static void see_across(qn_packet *p) {
  const int tile = p->tile == QN_TILE_ORIGINS;
  double d[3], a[3], length2 = 0, along = 0, size2 = 0;
  for (int i = 0; i < 3; i++) {
    d[i] = p->d[i][0], length2 += d[i] * d[i];
  }
  const double inverse = 1 / sqrt(length2);
  for (int i = 0; i < 3; i++) {
    d[i] *= inverse, a[i] = tile ? p->across[i][7] - p->across[i][0] : 0, along += a[i] * d[i];
  }
  for (int i = 0; i < 3; i++) {
    a[i] -= along * d[i], size2 += a[i] * a[i];
  }
  const double to_unit = 1 / sqrt(size2);
  along = 0, size2 = 0;
  for (int i = 0; i < 3; i++) {
    a[i] *= to_unit, along += a[i] * d[i], size2 += a[i] * a[i];
  }
  if (!(fabs(size2 - 1) <= QN_OUTLINE_SKEW / 2 && fabs(along) <= QN_OUTLINE_SKEW / 2)) { /* rows go along the rays, or have no length: across the axis that the direction has the least of */
    const int x = fabs(d[0]) <= fabs(d[1]) ? fabs(d[0]) <= fabs(d[2]) ? 0 : 2 : fabs(d[1]) <= fabs(d[2]) ? 1 : 2, y = (x + 1) % 3, z = (x + 2) % 3;
    const double size = sqrt(d[y] * d[y] + d[z] * d[z]);
    a[x] = 0, a[y] = d[z] / size, a[z] = -d[y] / size;
  }
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    p->plane[0][i] = a[i], p->plane[1][i] = d[j] * a[k] - d[k] * a[j];
  }
}

/* Columns, or rows, two by two: their middles along each of two axes, in the even places, and half of how far two are apart at most. */
typedef struct side { _Alignas(64) double middle[2][8], half[2]; } side;

QN_INLINE void side_of(const double (*e)[3], const double (*v)[8], side *out) {
  const vd first[3] = {vset(v[0][0]), vset(v[1][0]), vset(v[2][0])};
  vd widest[2] = {vset(0), vset(0)};
  for (int k = 0; k < 8; k += QN_W) {
    const vd x = vsub(vload(v[0] + k), first[0]), y = vsub(vload(v[1] + k), first[1]), z = vsub(vload(v[2] + k), first[2]);
    for (int j = 0; j < 2; j++) {
      const vd at = vfma(vset(e[j][0]), x, vfma(vset(e[j][1]), y, vmul(vset(e[j][2]), z))), next = vswap(at);
      vstore(out->middle[j] + k, vmul(vset(0.5), vadd(at, next)));
      widest[j] = vmax(widest[j], vabs(vsub(at, next)));
    }
  }
  for (int j = 0; j < 2; j++) {
    _Alignas(64) double w[QN_W];
    vstore(w, widest[j]);
    for (int i = 2; i < QN_W; i += 2) {
      w[0] = most(w[0], w[i]);
    }
    out->half[j] = 0.5 * w[0];
  }
}

static void outline_of_tile(walk *w, double far) {
  const qn_packet *p = w->f.p;
  outline *s = &w->outline;
  double width = 0;
  for (int i = 0; i < 3; i++) {
    s->ref[i] = p->across[i][0] + p->up[i][0];
    width += fabs(p->across[i][7] - p->across[i][0]) + fabs(p->up[i][7] - p->up[i][0]);
  }
  side x, y;
  side_of(p->plane, p->across, &x), side_of(p->plane, p->up, &y);
  for (int j = 0; j < 2; j++) {
    const double *c = x.middle[j], *r = y.middle[j], left[2] = {c[0], c[4]}, right[2] = {c[2], c[6]}, rows[4] = {r[0], r[2], r[4], r[6]};
    fstore(s->place[j], ftable(left, rows)), fstore(s->place[j] + 8, ftable(right, rows));
  }
  const double half0 = x.half[0] + y.half[0], half1 = x.half[1] + y.half[1];
  s->half = QN_WIDE_SLACK * (sqrt(half0 * half0 + half1 * half1) + QN_OUTLINE_FLOAT * width + QN_OUTLINE_PLACE * far);
}

static void outline_of_lanes(walk *w, double far) {
  const qn_packet *p = w->f.p;
  outline *s = &w->outline;
  double width = 0, moved = 0;
  for (int i = 0; i < 3; i++) {
    s->ref[i] = p->o[i][0];
    width += p->high[i] - p->low[i], moved += p->tile == QN_TILE_MOVED ? p->moved[i] : 0;
  }
  _Alignas(64) double at[2][QN_LANES];
  for (unsigned k = 0; k < QN_LANES; k += QN_W) {
    const vd x = vsub(vload(p->o[0] + k), vset(s->ref[0])), y = vsub(vload(p->o[1] + k), vset(s->ref[1])), z = vsub(vload(p->o[2] + k), vset(s->ref[2]));
    for (int j = 0; j < 2; j++) {
      const double *e = p->plane[j];
      vstore(at[j] + k, vfma(vset(e[0]), x, vfma(vset(e[1]), y, vmul(vset(e[2]), z))));
    }
  }
  for (unsigned k = 0; k < QN_LANES; k += 8) {
    fstore(s->place[0] + k, fnarrow(at[0] + k)), fstore(s->place[1] + k, fnarrow(at[1] + k));
  }
  s->half = QN_WIDE_SLACK * (QN_OUTLINE_FLOAT * width + QN_OUTLINE_PLACE * far + 2 * QN_U * moved);
}

/* Before a ball is looked at. */
static void outline_make(walk *w) {
  const qn_packet *p = w->f.p;
  double far = 0;
  for (int i = 0; i < 3; i++) {
    far += most(fabs(p->low[i]), fabs(p->high[i]));
  }
  if (p->tile == QN_TILE_ORIGINS) {
    outline_of_tile(w, far);
  } else {
    outline_of_lanes(w, far);
  }
  w->outline.made = 1;
}

/* Whether a ball is looked at along the lanes; of lanes that are no tile, the first thing that is met is not: where there are no others, their places were made for nothing. */
QN_INLINE int outline_pays(walk *w) {
  const qn_packet *p = w->f.p;
  return p->tile == QN_TILE_ORIGINS || (p->one_way && p->tile != QN_TILE_PAIRS && w->outline.asked++ != 0);
}

/* Of the eight places from k on, those from which a, c is farther than the root of most2. */
QN_INLINE unsigned outline_misses(const outline *s, unsigned k, vf8 a, vf8 c, vf8 most2) {
  const vf8 x = fsub(a, fload(s->place[0] + k)), z = fsub(c, fload(s->place[1] + k));
  return fle(most2, ffma(x, x, fmul(z, z)));
}

typedef struct disc { vf8 a, c, most2; int usable; } disc; /* the ball's middle along both axes, and the square of how far it reaches */

QN_INLINE disc disc_of(walk *w, const qn_piece_sphere *b) {
  const outline *s = &w->outline;
  if (!s->made) {
    outline_make(w);
  }
  const double (*e)[3] = w->f.p->plane;
  const double y[3] = {b->centre[0] - s->ref[0], b->centre[1] - s->ref[1], b->centre[2] - s->ref[2]};
  const double at0 = e[0][0] * y[0] + e[0][1] * y[1] + e[0][2] * y[2], at1 = e[1][0] * y[0] + e[1][1] * y[1] + e[1][2] * y[2];
  const double reach = sqrt(b->r2) + 2 * (double)b->off + s->half + QN_OUTLINE_PLACE * (fabs(y[0]) + fabs(y[1]) + fabs(y[2]));
  const float limit = (float)(reach * reach * QN_OUTLINE_SQUARE) + QN_FLOAT_TINY;
  return (disc){fset((float)at0), fset((float)at1), fset(limit), limit < FLT_MAX};
}

/* The fours of a tile of origins that do not surely miss the ball. */
QN_INLINE unsigned outline_fours(walk *w, const qn_piece_sphere *b) {
  const disc d = disc_of(w, b);
  return QN_LIKELY(d.usable) ? 0xffff & ~(outline_misses(&w->outline, 0, d.a, d.c, d.most2) | outline_misses(&w->outline, 8, d.a, d.c, d.most2) << 8) : 0xffff;
}

/* The lanes that do not surely miss it. */
QN_INLINE uint64_t outline_lanes(walk *w, const qn_piece_sphere *b) {
  if (w->f.p->tile == QN_TILE_ORIGINS) {
    return lanes_of_fours(outline_fours(w, b));
  }
  const disc d = disc_of(w, b);
  uint64_t misses = 0;
  for (unsigned k = 0; k < QN_LANES; k += 8) {
    misses |= (uint64_t)outline_misses(&w->outline, k, d.a, d.c, d.most2) << k;
  }
  return QN_LIKELY(d.usable) ? ~misses : ~(uint64_t)0;
}
#endif

#endif
