/* One packet's walk through a scene: its state, the certified order of places, and the boxes that lanes may meet. Static code of the
   packet body. */
#ifndef QN_WIDE_WALK_H
#define QN_WIDE_WALK_H

#include "wide/solve.h"

#include <float.h>
#include <stddef.h>

#if QN_LANES_NOW == 64
typedef qn_ends lanes;
#else
typedef struct lanes { _Alignas(64) double t[QN_LANES_NOW], p[QN_LANES_NOW]; } lanes; /* places and payloads */
#endif

enum { SUBS = QN_LANES_NOW < 8 ? 1 : 8, SUB_LANES = QN_LANES_NOW / SUBS, STACK = 7 * QN_BVH_DEPTH + QN_ENTRY_BOXES, TIES = 4, ALL_TIES = (1 << TIES) - 1 };

#if QN_LANES_NOW == 1
/* A single ray against boxes: which side of a box is met first along each axis, and what makes a plane's place of it: plane inv + near (or far). */
typedef struct beam {
  int ready; /* 0: some number is no usual float */
  unsigned flat; /* axes along which the ray does not go */
  unsigned near_side[3], far_side[3]; /* places in a node */
  float inv[3], near[3], far[3], o_min[3], o_max[3];
} beam;
#endif

#if QN_LANES_NOW == 64
/* Lanes seen along their one direction (outline.h), along two axes from ref: of a tile of origins the middles of each four lanes, the left and then the right ones of each eight; else
   each lane. half: no lane is farther from its place. */
typedef struct outline {
  int made;
  unsigned asked;
  double ref[3], half;
  _Alignas(32) float place[2][QN_LANES];
} outline;
#endif

typedef struct walk {
  packet_facts f;
  const struct quoin_scene *scene;
  const qn_normal *normal;
  uint64_t unsure;
  /* Where ends of two leaves were equal, the first few places: which leaf is named there is not for the packet to say; nor which surface, where bit i of `open` is set, of place i. */
  uint8_t ties[QN_LANES_NOW], open[QN_LANES_NOW];
  double tie[TIES][QN_LANES_NOW];
  qn_wide_counts counts; /* budget: of all lanes, UINT64_MAX for none */
  float all_omin[3], all_omax[3], all_imin[3], all_imax[3];                       /* of the packet */
#if QN_LANES_NOW == 1
  beam beam;
#elif QN_LANES_NOW == 64
  outline outline;
#endif
  _Alignas(64) double tolerance[QN_LANES_NOW]; /* the sum of any two errors of this lane so far */
} walk;

/* A float at most, or at least, v, which is a number: rounding moves by under 2^-24 of it, or by under the smallest normal float. */
QN_INLINE float down(double v) {
  float f = v < FLT_MAX ? (float)v : FLT_MAX; /* infinity less infinity were nothing */
  return f - (fabsf(f) * QN_FLOAT_STEP + QN_FLOAT_TINY);
}
QN_INLINE float up(double v) {
  float f = v > -FLT_MAX ? (float)v : -FLT_MAX;
  return f + (fabsf(f) * QN_FLOAT_STEP + QN_FLOAT_TINY);
}

/* The same of eight floats that doubles were rounded to. */
QN_INLINE vf8 steps(vf8 f) { return fadd(fmul(fmax8(f, fsub(fset(0), f)), fset(QN_FLOAT_STEP)), fset(QN_FLOAT_TINY)); }
QN_INLINE vf8 downs(vf8 f) {
  f = fmin8(f, fset(FLT_MAX));
  return fsub(f, steps(f));
}
QN_INLINE vf8 ups(vf8 f) {
  f = fmax8(f, fset(-FLT_MAX));
  return fadd(f, steps(f));
}

/* Of each sub-packet's lanes, the least, or the largest. */
QN_INLINE void sub_extremes(const double v[QN_LANES_NOW], int largest, double out[SUBS]) {
#if QN_LANES_NOW == 64
  veights(v, largest, out);
#else
  (void)largest;
  memcpy(out, v, SUBS * sizeof *out);
#endif
}
/* Floats at most `low` and at least `high`. */
QN_INLINE void outward(const double low[SUBS], const double high[SUBS], float min[8], float max[8]) {
#if QN_LANES_NOW >= 8
  fstore(min, downs(fnarrow(low))), fstore(max, ups(fnarrow(high)));
#else
  *min = down(*low), *max = up(*high);
#endif
}

/* The lanes of sub-packets: byte k all ones where bit k is set; or, where a sub-packet is one lane, the bits themselves. */
QN_INLINE uint64_t eights(unsigned bits) {
  if (SUB_LANES == 1) {
    return bits;
  }
  uint64_t x = bits * 0x0101010101010101u & 0x8040201008040201u;
  return ((x + 0x7f7f7f7f7f7f7f7fu) >> 7 & 0x0101010101010101u) * 255;
}

#if QN_LANES_NOW == 64
/* The lanes of fours: bit i of the lower eight the first four of sub-packet i, of the upper eight the others. */
QN_INLINE uint64_t lanes_of_fours(unsigned fours) {
  const uint64_t ones = 0x0101010101010101u, each = 0x8040201008040201u, carry = 0x7f7f7f7f7f7f7f7fu;
  const uint64_t first = ((fours & 255) * ones & each) + carry, second = ((fours >> 8) * ones & each) + carry;
  return ((first >> 7 & ones) | (second >> 3 & ones << 4)) * 15;
}
#endif

/* --- order --------------------------------------------------------------------------------------------------------- */

/* A tie may settle what a lane does before all that passes at the place has been looked at, and what has not been is where the woven path may find another surface. Not so where two terms of the root
   are entered at one place and are kin (scene/normal.h): of what is taken from both, all that passes there was looked at when the first of them was found to be entered there. */
QN_INLINE int is_kin(const walk *w, const qn_nterm *t) {
  const qn_union *root = &w->normal->unions[w->normal->root];
  const uint32_t number = (uint32_t)(t - w->normal->terms);
  return w->normal->kin && (number - root->term0 < root->terms || number - root->wide0 < root->wide);
}

/* Of the lanes `near`, which may be at one place: in *equal come those where both are the same root of the same surface, the others are given up. A place where a ray
   starts on a surface is either root of it; two ends that are nobody's are one place if they are one number. entered: null, or the term whose entry x is. */
static QN_NOINLINE void settle_ties(walk *w, int g, unsigned near, vd at, vd apart, vd px, vd py, const qn_nterm *entered, unsigned *equal) {
  const vd zero = vset(0), nobody = vset(payload_bits(QN_NOBODY));
  const unsigned starts = vsigns(px) | vsigns(py), surface = vbits(vsame(px, py, QN_NOBODY)), root = vbits(vsame(px, py, QN_LARGER_ROOT));
  const unsigned apart_ends = vbits(vandnot(vsame(px, nobody, QN_NOBODY), veq(apart, zero)));
  const unsigned same = near & surface & (root | starts) & ~apart_ends;
  *equal |= same;
  w->unsure |= (uint64_t)(near & ~same) << (g * QN_W);
  unsigned named = same & ~starts & ~vbits(vsame(px, py, (uint64_t)QN_LEAF_BITS << 32)); /* by two leaves */
  if (named) {
    _Alignas(64) double t[QN_W];
    vstore(t, at);
    const int kin = entered && is_kin(w, entered);
    for (; named; named &= named - 1) {
      const unsigned i = qn_trailing_zeros(named), lane = (unsigned)g * QN_W + i;
      uint8_t *n = &w->ties[lane];
      *n = (uint8_t)(*n + (*n <= TIES));
      w->tie[*n - 1 < TIES ? *n - 1 : 0][lane] = t[i];
      w->open[lane] |= (uint8_t)(*n > TIES ? ALL_TIES : kin ? 0 : 1u << (*n - 1));
    }
  }
}

/* x before y, and x equal to y, for the lanes of `mask`; lanes in neither are after, or were given up: these leave `mask`. entered: as in settle_ties. */
QN_INLINE void order_entry(walk *w, const qn_nterm *entered, int g, vd x, vd px, vd y, vd py, vm *mask, vm *before, vm *equal) {
  if (!CHECKED) {
    *before = vand(vlt(x, y), *mask), *equal = vmask(0);
    return;
  }
  vd tolerance = vload(w->tolerance + g * QN_W), gap = vsub(y, x);
  vm sure = vlt(tolerance, gap), near = vandnot(vmask(QN_ALL_BITS), vlt(tolerance, vabs(gap))); /* not certain to be apart */
  *before = vand(sure, *mask);
  unsigned close = vbits(vand(near, *mask));
  if (QN_LIKELY(close == 0)) {
    *equal = vmask(0);
    return;
  }
  unsigned same = 0;
  settle_ties(w, g, close, x, gap, px, py, entered, &same);
  *equal = vmask(same);
  *mask = vandnot(*mask, vmask(close & ~same));
}

QN_INLINE void order(walk *w, int g, vd x, vd px, vd y, vd py, vm *mask, vm *before, vm *equal) { order_entry(w, NULL, g, x, px, y, py, mask, before, equal); }

/* --- boxes --------------------------------------------------------------------------------------------------------- */

/* Which of eight boxes the packet, or of eight sub-packets the box, may meet between two parameters. The products bound the
   parameters at which a box's planes are met; imin and imax are widened so that their rounding does not matter. */
QN_INLINE unsigned slabs(const int axis[3], vf8 bmin[3], vf8 bmax[3], vf8 omin[3], vf8 omax[3], vf8 imin[3], vf8 imax[3], vf8 start, vf8 end, vf8 *near_out) {
  vf8 near = start, far = end;
  unsigned meets = 0xff;
  for (int i = 0; i < 3; i++) {
    if (axis[i] == AXIS_UP || axis[i] == AXIS_DOWN) {
      vf8 n = axis[i] == AXIS_UP ? fsub(bmin[i], omax[i]) : fsub(bmax[i], omin[i]);
      vf8 x = axis[i] == AXIS_UP ? fsub(bmax[i], omin[i]) : fsub(bmin[i], omax[i]);
      near = fmax8(near, fmin8(fmul(n, imin[i]), fmul(n, imax[i])));
      far = fmin8(far, fmax8(fmul(x, imin[i]), fmul(x, imax[i])));
    } else if (axis[i] == AXIS_FLAT) {
      meets &= fle(bmin[i], omax[i]) & fle(omin[i], bmax[i]);
    }
  }
  *near_out = near;
  return meets & fle(near, far);
}

#if QN_LANES_NOW == 1
enum { MAX_AT = offsetof(qn_bvh_node, max) / sizeof(float) };

static void beam_make(walk *w) {
  const qn_packet *p = w->f.p;
  beam *b = &w->beam;
  b->ready = 1, b->flat = 0;
  for (int i = 0; i < 3; i++) {
    const int up_ = p->axis[i] != AXIS_DOWN;
    b->near_side[i] = (up_ ? 0 : MAX_AT) + 8 * (unsigned)i, b->far_side[i] = (up_ ? MAX_AT : 0) + 8 * (unsigned)i;
    b->o_min[i] = w->all_omin[i], b->o_max[i] = w->all_omax[i];
    if (p->axis[i] == AXIS_FLAT) {
      b->flat |= 1u << i;
      b->inv[i] = 0, b->near[i] = -FLT_MAX, b->far[i] = FLT_MAX;
      continue;
    }
    const double inv = p->inv[i][0], near = (up_ ? p->high[i] : p->low[i]) * inv, far = (up_ ? p->low[i] : p->high[i]) * inv;
    const double wide = QN_WIDE_FLOAT * most(fabs(near), fabs(far)) + QN_FLOAT_TINY;
    b->ready &= p->axis[i] != AXIS_MIXED && wide <= QN_WIDE_LARGEST * QN_WIDE_FLOAT;
    b->inv[i] = (float)inv;
    b->near[i] = (float)(-near - wide), b->far[i] = (float)(wide - far);
  }
}

/* Each place is within 2^-22 of itself of one that is not on the wrong side; so are the largest and the least, and the comparison allows for both (docs/bounds.md). `near` may be
   above where a box is met by as much: it is compared with a widened end. */
QN_INLINE unsigned beam_meets(const beam *b, const qn_bvh_node *n, float start, float end, float near[8]) {
  const float *planes = (const float *)(const void *)n; /* min, and max from MAX_AT */
  vf8 first = fset(start), last = fset(end);
  unsigned meets = 0xff;
  for (int i = 0; i < 3; i++) { /* where the ray does not go that way, an infinite plane gives no number: then the second operand is taken */
    const vf8 inv = fset(b->inv[i]);
    first = fmax8(ffma(fload(planes + b->near_side[i]), inv, fset(b->near[i])), first);
    last = fmin8(ffma(fload(planes + b->far_side[i]), inv, fset(b->far[i])), last);
  }
  for (int i = 0; QN_UNLIKELY(b->flat) && i < 3; i++) {
    if (b->flat >> i & 1) {
      meets &= fle(fload(n->min[i]), fset(b->o_max[i])) & fle(fset(b->o_min[i]), fload(n->max[i]));
    }
  }
  last = fmax8(last, fset(-FLT_MAX)); /* what has overflowed may be more; and an empty slot's box, which is inverted, is met nowhere */
  fstore(near, first);
  return meets & fle(first, ffma(fmax8(last, fsub(fset(0), last)), fset(QN_WIDE_FLOAT), last));
}
/* What `near` is compared with so that no box is passed that is met by then. */
QN_INLINE float beam_end(float end) { return end + fabsf(end) * (float)QN_WIDE_FLOAT; }
#endif

QN_INLINE unsigned node_meets(const walk *w, const qn_bvh_node *n, float start, float end, float near[8]) {
#if QN_LANES_NOW == 1
  if (QN_LIKELY(w->beam.ready)) {
    return beam_meets(&w->beam, n, start, end, near);
  }
#endif
  vf8 bmin[3], bmax[3], omin[3], omax[3], imin[3], imax[3], when;
  for (int i = 0; i < 3; i++) {
    bmin[i] = fload(n->min[i]), bmax[i] = fload(n->max[i]);
    omin[i] = fset(w->all_omin[i]), omax[i] = fset(w->all_omax[i]), imin[i] = fset(w->all_imin[i]), imax[i] = fset(w->all_imax[i]);
  }
  unsigned used = fle(bmin[0], bmax[0]); /* an empty slot's box is inverted, which the slabs alone may not see */
  unsigned meets = used & slabs(w->f.p->axis, bmin, bmax, omin, omax, imin, imax, fset(start), fset(end), &when);
  fstore(near, when);
  return meets;
}

/* The sub-packets that may meet the box of a node's child, as lanes. */
QN_INLINE uint64_t subs_meet_child(const walk *w, const qn_bvh_node *n, unsigned slot) {
  if (SUBS == 1) {
    return 1; /* the node was tested for the same lane */
  }
  vf8 bmin[3], bmax[3], omin[3], omax[3], imin[3], imax[3], when;
  for (int i = 0; i < 3; i++) {
    bmin[i] = fset(n->min[i][slot]), bmax[i] = fset(n->max[i][slot]);
    omin[i] = fload(w->f.p->omin[i]), omax[i] = fload(w->f.p->omax[i]), imin[i] = fload(w->f.p->imin[i]), imax[i] = fload(w->f.p->imax[i]);
  }
  return eights(slabs(w->f.p->axis, bmin, bmax, omin, omax, imin, imax, fset(-INFINITY), fset(INFINITY), &when));
}

#endif
