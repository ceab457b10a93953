/* The packet body, compiled once for each instruction set (see CMakeLists.txt): the first boundary of up to 64 rays.

   Two questions that call each other walk the normal form (scene/normal.h). enter: the first place in a union at or after a
   lane's place. leave: the place after which no term of a union holds the lane. A term [a, b) minus S is entered at leave(S, max(a, t))
   when that is before b, and is left, when it holds t, at the sooner of b and enter(S, t). Ends compare as reals: apart by more than
   the errors' sum, sure; else equal when they are the same root of the same surface; else the lane is given up (unsure).
   A place stands for the stretch just after it, so ends are half-open and coincident faces come out regularised (S5). */
#include "wide/solve.h"

typedef struct lanes { _Alignas(64) double t[QN_LANES], p[QN_LANES]; } lanes; /* places and payloads */

enum { SUBS = 8, SUB_LANES = QN_LANES / SUBS, STACK = 256 };

/* How a packet's directions lie on an axis. */
enum { AXIS_UP, AXIS_DOWN, AXIS_FLAT, AXIS_MIXED };

typedef struct walk {
  packet_facts f;
  const struct quoin_scene *scene;
  const qn_normal *normal;
  uint64_t unsure;
  qn_wide_counts counts;
  float all_omin[3], all_omax[3], all_imin[3], all_imax[3];                       /* of the packet */
  _Alignas(64) double tolerance[QN_LANES]; /* the sum of any two errors of this lane so far */
} walk;

/* A float at most, or at least, v: rounding moves by under 2^-24 of it, or by under the smallest normal float. */
QN_INLINE float down(double v) {
  float f = (float)v;
  return f - (fabsf(f) * 0x1p-22f + 0x1p-126f);
}
QN_INLINE float up(double v) {
  float f = (float)v;
  return f + (fabsf(f) * 0x1p-22f + 0x1p-126f);
}

/* Byte k all ones where bit k is set. */
QN_INLINE uint64_t eights(unsigned bits) {
  uint64_t x = bits * 0x0101010101010101u & 0x8040201008040201u;
  return ((x + 0x7f7f7f7f7f7f7f7fu) >> 7 & 0x0101010101010101u) * 255;
}

/* --- order --------------------------------------------------------------------------------------------------------- */

static QN_NOINLINE void settle_ties(walk *w, int g, unsigned near, vd px, vd py, unsigned *equal) {
  _Alignas(64) double x[QN_W], y[QN_W];
  vstore(x, px), vstore(y, py);
  for (int i = 0; i < QN_W; i++) {
    if (near >> i & 1) {
      uint64_t a, b;
      memcpy(&a, &x[i], 8), memcpy(&b, &y[i], 8);
      const uint64_t who = (a | b) & QN_STARTS_ON ? 0xffffffffu : QN_LARGER_ROOT | 0xffffffffu;
      if ((a & who) == (b & who)) {
        *equal |= 1u << i;
      } else {
        w->unsure |= (uint64_t)1 << (g * QN_W + i);
      }
    }
  }
}

/* x before y, and x equal to y, for the lanes of `mask`; lanes in neither are after, or were given up: these leave `mask`. */
QN_INLINE void order(walk *w, int g, vd x, vd px, vd y, vd py, vm *mask, vm *before, vm *equal) {
  vd tolerance = vload(w->tolerance + g * QN_W), gap = vsub(y, x);
  vm sure = vlt(tolerance, gap), near = vle(vabs(gap), tolerance);
  *before = vand(sure, *mask);
  unsigned close = vbits(vand(near, *mask));
  if (QN_LIKELY(close == 0)) {
    *equal = vmask(0);
    return;
  }
  unsigned same = 0;
  settle_ties(w, g, close, px, py, &same);
  *equal = vmask(same);
  *mask = vandnot(*mask, vmask(close & ~same));
}

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

QN_INLINE unsigned node_meets(const walk *w, const qn_bvh_node *n, float start, float end, float near[8]) {
  vf8 bmin[3], bmax[3], omin[3], omax[3], imin[3], imax[3], when;
  for (int i = 0; i < 3; i++) {
    bmin[i] = fload(n->min[i]), bmax[i] = fload(n->max[i]);
    omin[i] = fset(w->all_omin[i]), omax[i] = fset(w->all_omax[i]), imin[i] = fset(w->all_imin[i]), imax[i] = fset(w->all_imax[i]);
  }
  unsigned meets = slabs(w->f.p->axis, bmin, bmax, omin, omax, imin, imax, fset(start), fset(end), &when);
  fstore(near, when);
  return meets;
}

/* The sub-packets that may meet a term's box, as lanes. */
QN_INLINE uint64_t subs_meet(const walk *w, const qn_nterm *t) {
  vf8 bmin[3], bmax[3], omin[3], omax[3], imin[3], imax[3], when;
  for (int i = 0; i < 3; i++) {
    bmin[i] = fset(t->min[i]), bmax[i] = fset(t->max[i]);
    omin[i] = fload(w->f.p->omin[i]), omax[i] = fload(w->f.p->omax[i]), imin[i] = fload(w->f.p->imin[i]), imax[i] = fload(w->f.p->imax[i]);
  }
  unsigned meets = slabs(w->f.p->axis, bmin, bmax, omin, omax, imin, imax, fset(-INFINITY), fset(INFINITY), &when);
  return eights(meets);
}

/* --- one term ------------------------------------------------------------------------------------------------------ */

/* Of a meet: its half-spaces' constants, planes first, since they settle which side of a body that opens counts. */
typedef struct meet_constants {
  int planes, bodies;
  plane_constants plane[QN_MEET_PLANES];
  body_constants body[QN_MEET_BODIES];
} meet_constants;

typedef union piece_constants {
  sphere_constants sphere;
  box_constants box;
  struct { plane_constants cap[2]; body_constants body; } round;
  meet_constants meet;
} piece_constants;

static const qn_piece_head *piece_at(const walk *w, uint32_t leaf) {
  return (const qn_piece_head *)(const void *)((const char *)w->scene->lines + (size_t)w->scene->line_of[leaf] * 64);
}

static void meet_prepare(const walk *w, uint32_t leaf, meet_constants *k) {
  const struct quoin_scene *scene = w->scene;
  const qn_leaf *l = &scene->leaves[leaf];
  k->planes = k->bodies = 0;
  for (uint32_t i = l->half0; i < l->half0 + l->halves; i++) {
    const qn_half *half = &scene->halves[i];
    if (half->kind == QN_PLANE) {
      const qn_plane_shadow *p = &scene->planes[half->shadow];
      plane_prepare(&w->f, l->pivot, p->n, p->d, half->surface, leaf, &k->plane[k->planes++]);
      continue;
    }
    const qn_quadric_shadow *q = &scene->quadrics[half->shadow];
    double reach = 0; /* of what lies in the leaf's box and the solid's: no more of it matters */
    for (int r = 0; r < 3; r++) {
      double size = fabs(q->row[r][3]);
      for (int j = 0; j < 3; j++) {
        double low = most(l->min[j], scene->min[j]), high = least(l->max[j], scene->max[j]);
        size += fabs(q->row[r][j]) * most(fabs(low - l->pivot[j]), fabs(high - l->pivot[j]));
      }
      reach += size * size;
    }
    body_prepare(&w->f, l->pivot, q->row, q->s, q->l, q->k, sqrt(reach) * (1 + 0x1p-40), half->surface, leaf, &k->body[k->bodies++]);
  }
}

static void piece_prepare(const walk *w, const qn_piece_head *head, piece_constants *k) {
  switch ((qn_piece_kind)head->kind) {
  case QN_PIECE_SPHERE: sphere_prepare(&w->f, (const qn_piece_sphere *)(const void *)head, &k->sphere); break;
  case QN_PIECE_BOX: box_prepare(&w->f, (const qn_piece_box *)(const void *)head, &k->box); break;
  case QN_PIECE_ROUND: {
    const qn_piece_round *r = (const qn_piece_round *)(const void *)head;
    for (int i = 0; i < 2; i++) {
      if (r->surface[1 + i] != UINT32_MAX) {
        plane_prepare(&w->f, r->pivot, r->cap[i], r->cap[i][3], r->surface[1 + i], head->leaf, &k->round.cap[i]);
      }
    }
    body_prepare(&w->f, r->pivot, r->row, r->s, r->l, r->k, r->reach, r->surface[0], head->leaf, &k->round.body);
    break;
  }
  case QN_PIECE_MEET: meet_prepare(w, head->leaf, &k->meet); break;
  case QN_PIECE_HARD: break;
  }
}

QN_INLINE void from_pivot(const qn_packet *p, int at, const double pivot[3], vd y[3], vd d[3]) {
  for (int i = 0; i < 3; i++) {
    y[i] = vsub(vload(p->o[i] + at), vset(pivot[i]));
    d[i] = vload(p->d[i] + at);
  }
}

QN_INLINE stretch whole_line(void) {
  vd nobody = vset(payload_bits(QN_NOBODY));
  return (stretch){.a = vset(-QN_FAR), .b = vset(QN_FAR), .pa = nobody, .pb = nobody, .error = vset(0), .hit = vmask(QN_ALL_BITS), .unsure = vmask(0)};
}

static stretch meet_solve(const walk *w, const meet_constants *k, uint32_t leaf, int g) {
  stretch s = whole_line();
  vd y[3], d[3];
  from_pivot(w->f.p, g * QN_W, w->scene->leaves[leaf].pivot, y, d);
  for (int i = 0; i < k->planes; i++) {
    plane_meet(&w->f, &k->plane[i], y, d, &s);
  }
  for (int i = 0; i < k->bodies; i++) {
    body_meet(&w->f, &k->body[i], y, d, &s);
  }
  stretch_settle(&s);
  return s;
}

QN_INLINE stretch piece_solve(const walk *w, const qn_piece_head *head, const piece_constants *k, int g) {
  switch ((qn_piece_kind)head->kind) {
  case QN_PIECE_SPHERE: return sphere_solve(&w->f, &k->sphere, g);
  case QN_PIECE_BOX: return box_solve(&w->f, &k->box, g);
  case QN_PIECE_ROUND: {
    const qn_piece_round *r = (const qn_piece_round *)(const void *)head;
    stretch s = whole_line();
    vd y[3], d[3];
    from_pivot(w->f.p, g * QN_W, r->pivot, y, d);
    for (int i = 0; i < 2; i++) {
      if (r->surface[1 + i] != UINT32_MAX) {
        plane_meet(&w->f, &k->round.cap[i], y, d, &s);
      }
    }
    body_meet(&w->f, &k->round.body, y, d, &s);
    stretch_settle(&s);
    return s;
  }
  case QN_PIECE_MEET: return meet_solve(w, &k->meet, head->leaf, g);
  case QN_PIECE_HARD: break;
  }
  stretch s = whole_line();
  s.unsure = s.hit, s.hit = vmask(0);
  return s;
}

/* The later of two entries and the sooner of two exits. */
static void stretch_meet(walk *w, int g, stretch *s, const stretch *o) {
  vm both = vand(s->hit, o->hit), before, equal;
  s->unsure = vor(vand(s->unsure, vor(o->hit, o->unsure)), vand(o->unsure, vor(s->hit, s->unsure)));
  s->error = vmax(s->error, o->error);
  double *tolerance = w->tolerance + g * QN_W;
  vstore(tolerance, vmax(vload(tolerance), vmul(s->error, vset(2))));
  order(w, g, s->a, s->pa, o->a, o->pa, &both, &before, &equal);
  s->a = vpick(before, o->a, s->a), s->pa = vpick(before, o->pa, s->pa);
  order(w, g, o->b, o->pb, s->b, s->pb, &both, &before, &equal);
  s->b = vpick(before, o->b, s->b), s->pb = vpick(before, o->pb, s->pb);
  order(w, g, s->a, s->pa, s->b, s->pb, &both, &before, &equal);
  s->hit = before;
}

typedef struct ends { _Alignas(64) double a[QN_LANES], b[QN_LANES], pa[QN_LANES], pb[QN_LANES]; } ends;

/* Solves a term's positive part for the lanes of `mask`; returns those that meet it. */
static uint64_t term_solve(walk *w, const qn_nterm *t, uint64_t mask, ends *out) {
  const uint32_t *leaves = w->normal->leaves + t->leaf0;
  uint64_t hits = 0;
  enum { READY = 4 };
  piece_constants k[READY]; /* of the first pieces; the others are prepared group by group */
  const qn_piece_head *head[READY];
  for (uint32_t i = 0; i < t->leaves && i < READY; i++) {
    head[i] = piece_at(w, leaves[i]);
    piece_prepare(w, head[i], &k[i]);
  }
  for (int g = 0; g < QN_GROUPS; g++) {
    unsigned lanes_in = (unsigned)(mask >> (g * QN_W)) & QN_ALL_BITS;
    if (!lanes_in) {
      continue;
    }
    w->counts.leaves += t->leaves;
    stretch s = t->leaves ? piece_solve(w, head[0], &k[0], g) : whole_line();
    for (uint32_t i = 1; i < t->leaves; i++) {
      piece_constants other;
      const qn_piece_head *h = i < READY ? head[i] : piece_at(w, leaves[i]);
      if (i >= READY) {
        piece_prepare(w, h, &other);
      }
      stretch o = piece_solve(w, h, i < READY ? &k[i] : &other, g);
      stretch_meet(w, g, &s, &o);
    }
    double *tolerance = w->tolerance + g * QN_W;
    vstore(tolerance, vmax(vload(tolerance), vmul(s.error, vset(2))));
    w->unsure |= (uint64_t)(vbits(s.unsure) & lanes_in) << (g * QN_W);
    int at = g * QN_W;
    vstore(out->a + at, s.a), vstore(out->b + at, s.b), vstore(out->pa + at, s.pa), vstore(out->pb + at, s.pb);
    hits |= (uint64_t)(vbits(s.hit) & lanes_in) << at;
  }
  return hits & ~w->unsure;
}

/* --- the two questions --------------------------------------------------------------------------------------------- */

static uint64_t union_enter(walk *w, uint32_t u, const lanes *from, uint64_t mask, lanes *best);
static uint64_t union_leave(walk *w, uint32_t u, lanes *at, uint64_t mask);

/* Moves `at` to the first place at or after it that is in all of the term's plus unions and in none of its minus unions. Lanes that
   find none before `limit` leave the mask. */
static uint64_t term_seek(walk *w, const qn_nterm *t, lanes *at, const lanes *limit, uint64_t mask) {
  const uint32_t *list = w->normal->lists;
  for (;;) {
    uint64_t moved = 0;
    for (uint32_t i = 0; i < t->minus; i++) {
      moved |= union_leave(w, list[t->minus0 + i], at, mask);
      mask &= ~w->unsure;
    }
    uint64_t again = t->minus > 1 ? moved : 0;
    for (uint32_t i = 0; i < t->plus; i++) {
      lanes next = *limit, was = *at;
      uint64_t found = union_enter(w, list[t->plus0 + i], at, mask, &next);
      mask &= found & ~w->unsure;
      for (uint64_t m = mask; m; m &= m - 1) {
        unsigned k = qn_trailing_zeros(m);
        if (memcmp(&next.t[k], &was.t[k], 8)) {
          again |= (uint64_t)1 << k;
        }
        at->t[k] = next.t[k], at->p[k] = next.p[k];
      }
    }
    for (int g = 0; g < QN_GROUPS; g++) { /* past the limit: gone */
      unsigned in = (unsigned)(mask >> (g * QN_W)) & QN_ALL_BITS;
      if (in) {
        int o = g * QN_W;
        vm m = vmask(in), before, equal;
        order(w, g, vload(at->t + o), vload(at->p + o), vload(limit->t + o), vload(limit->p + o), &m, &before, &equal);
        mask &= ~((uint64_t)(in & ~vbits(before)) << o);
      }
    }
    again &= mask;
    if (!again) {
      return mask;
    }
  }
}

/* The place of entry becomes the best where it is sooner; of two leaves with this surface there, the first in the file is named. */
QN_INLINE unsigned improve(walk *w, int g, vm m, vd t1, vd p1, lanes *best) {
  int o = g * QN_W;
  vm before, equal;
  vd limit_t = vload(best->t + o), limit_p = vload(best->p + o);
  order(w, g, t1, p1, limit_t, limit_p, &m, &before, &equal);
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

/* A term that is one leaf of a kind known here: solved and compared without leaving the registers. */
QN_INLINE void leaf_enter(walk *w, qn_piece_kind kind, const qn_piece_head *head, const lanes *from, uint64_t mask, lanes *best, uint64_t *found) {
  piece_constants k;
  if (kind == QN_PIECE_SPHERE) {
    sphere_prepare(&w->f, (const qn_piece_sphere *)(const void *)head, &k.sphere);
  } else {
    piece_prepare(w, head, &k);
  }
  for (int g = 0; g < QN_GROUPS; g++) {
    unsigned in = (unsigned)(mask >> (g * QN_W)) & QN_ALL_BITS;
    if (!in) {
      continue;
    }
    int o = g * QN_W;
    w->counts.leaves++;
    stretch s = kind == QN_PIECE_SPHERE ? sphere_solve(&w->f, &k.sphere, g) : kind == QN_PIECE_BOX ? box_solve(&w->f, &k.box, g) : piece_solve(w, head, &k, g);
    w->unsure |= (uint64_t)(vbits(s.unsure) & in) << o;
    vm m = vand(s.hit, vmask(in)), before, equal, ahead;
    if (!vbits(m)) {
      continue;
    }
    vstore(w->tolerance + o, vmax(vload(w->tolerance + o), vmul(s.error, vset(2))));
    vd start = vload(from->t + o), pstart = vload(from->p + o);
    order(w, g, start, pstart, s.b, s.pb, &m, &ahead, &equal); /* not yet over */
    m = vand(m, ahead);
    order(w, g, start, pstart, s.a, s.pa, &m, &before, &equal);
    *found |= (uint64_t)improve(w, g, m, vpick(before, s.a, start), vpick(before, s.pa, pstart), best) << o;
  }
}

static void term_enter(walk *w, const qn_nterm *t, const lanes *from, uint64_t mask, lanes *best, uint64_t *found) {
  if (t->leaves == 1 && !t->minus && !t->plus) {
    const qn_piece_head *head = piece_at(w, w->normal->leaves[t->leaf0]);
    switch ((qn_piece_kind)head->kind) {
    case QN_PIECE_SPHERE: leaf_enter(w, QN_PIECE_SPHERE, head, from, mask & ~w->unsure, best, found); return;
    case QN_PIECE_BOX: leaf_enter(w, QN_PIECE_BOX, head, from, mask & ~w->unsure, best, found); return;
    case QN_PIECE_ROUND: case QN_PIECE_MEET: case QN_PIECE_HARD: break;
    }
  }
  ends e;
  mask = term_solve(w, t, mask & ~w->unsure, &e);
  int plain = !t->minus && !t->plus;
  lanes at, limit;
  uint64_t seek = 0;
  for (int g = 0; g < QN_GROUPS; g++) {
    unsigned in = (unsigned)(mask >> (g * QN_W)) & QN_ALL_BITS;
    if (!in) {
      continue;
    }
    int o = g * QN_W;
    vm m = vmask(in), before, equal, ahead;
    vd start = vload(from->t + o), pstart = vload(from->p + o), a = vload(e.a + o), pa = vload(e.pa + o), b = vload(e.b + o), pb = vload(e.pb + o);
    vd limit_t = vload(best->t + o), limit_p = vload(best->p + o);
    order(w, g, start, pstart, b, pb, &m, &ahead, &equal); /* not yet over */
    m = vand(m, ahead);
    order(w, g, start, pstart, a, pa, &m, &before, &equal);
    vd t1 = vpick(before, a, start), p1 = vpick(before, pa, pstart);
    if (plain) {
      *found |= (uint64_t)improve(w, g, m, t1, p1, best) << o;
    } else {
      order(w, g, t1, p1, limit_t, limit_p, &m, &before, &equal);
      m = vand(m, before);
      vstore(at.t + o, t1), vstore(at.p + o, p1);
      vm sooner; /* the sooner of b and best bounds the search */
      vm both = m;
      order(w, g, b, pb, limit_t, limit_p, &both, &sooner, &equal);
      vstore(limit.t + o, vpick(sooner, b, limit_t)), vstore(limit.p + o, vpick(sooner, pb, limit_p));
      seek |= (uint64_t)vbits(both) << o;
    }
  }
  if (plain || !seek) {
    return;
  }
  seek = term_seek(w, t, &at, &limit, seek & ~w->unsure);
  for (uint64_t m = seek & ~w->unsure; m; m &= m - 1) {
    unsigned k = qn_trailing_zeros(m);
    best->t[k] = at.t[k], best->p[k] = at.p[k];
    *found |= (uint64_t)1 << k;
  }
}

/* The term is left: lanes of `at` that it holds move to its end. Returns those that moved. */
static uint64_t term_leave(walk *w, const qn_nterm *t, lanes *at, uint64_t mask) {
  ends e;
  mask = term_solve(w, t, mask & ~w->unsure, &e);
  uint64_t held = 0;
  lanes end;
  for (int g = 0; g < QN_GROUPS; g++) {
    unsigned in = (unsigned)(mask >> (g * QN_W)) & QN_ALL_BITS;
    if (!in) {
      continue;
    }
    int o = g * QN_W;
    vm m = vmask(in), before, equal;
    vd t0 = vload(at->t + o), p0 = vload(at->p + o), b = vload(e.b + o), pb = vload(e.pb + o);
    order(w, g, t0, p0, b, pb, &m, &before, &equal);
    m = vand(m, before);
    order(w, g, t0, p0, vload(e.a + o), vload(e.pa + o), &m, &before, &equal);
    m = vandnot(m, before); /* a <= t */
    held |= (uint64_t)vbits(m) << o;
    vstore(end.t + o, b), vstore(end.p + o, pb);
  }
  held &= ~w->unsure;
  if (held && (t->minus || t->plus)) {
    const uint32_t *list = w->normal->lists;
    lanes probe = *at;
    for (uint32_t i = 0; i < t->minus; i++) { /* in a subtrahend: not held; else out where the next one begins */
      uint64_t inside = union_leave(w, list[t->minus0 + i], &probe, held);
      held &= ~(inside | w->unsure);
      union_enter(w, list[t->minus0 + i], at, held, &end);
      held &= ~w->unsure;
    }
    for (uint32_t i = 0; i < t->plus; i++) {
      probe = *at;
      uint64_t inside = union_leave(w, list[t->plus0 + i], &probe, held);
      held &= inside & ~w->unsure;
      for (int g = 0; g < QN_GROUPS; g++) {
        unsigned in = (unsigned)(held >> (g * QN_W)) & QN_ALL_BITS;
        if (in) {
          int o = g * QN_W;
          vm m = vmask(in), before, equal;
          vd x = vload(probe.t + o), px = vload(probe.p + o), y = vload(end.t + o), py = vload(end.p + o);
          order(w, g, x, px, y, py, &m, &before, &equal);
          vstore(end.t + o, vpick(before, x, y)), vstore(end.p + o, vpick(before, px, py));
        }
      }
      held &= ~w->unsure;
    }
  }
  for (uint64_t m = held; m; m &= m - 1) {
    unsigned k = qn_trailing_zeros(m);
    at->t[k] = end.t[k], at->p[k] = end.p[k];
  }
  return held;
}

/* Bounds of the places of some lanes, as floats. */
QN_INLINE void span_of(const lanes *at, uint64_t mask, float *first, float *last) {
  vd low = vset(INFINITY), high = vset(-INFINITY);
  for (int g = 0; g < QN_GROUPS; g++) {
    unsigned in = (unsigned)(mask >> (g * QN_W)) & QN_ALL_BITS;
    if (in) {
      vm m = vmask(in);
      vd t = vload(at->t + g * QN_W);
      low = vpick(m, vmin(low, t), low), high = vpick(m, vmax(high, t), high);
    }
  }
  _Alignas(64) double x[QN_W], y[QN_W];
  vstore(x, low), vstore(y, high);
  for (int i = 1; i < QN_W; i++) {
    x[0] = least(x[0], x[i]), y[0] = most(y[0], y[i]);
  }
  *first = down(x[0] - fabs(x[0]) * 0x1p-20), *last = up(y[0] + fabs(y[0]) * 0x1p-20);
}
static float latest(const lanes *at, uint64_t mask) {
  float first, last;
  span_of(at, mask, &first, &last);
  return last;
}
static float earliest(const lanes *at, uint64_t mask) {
  float first, last;
  span_of(at, mask, &first, &last);
  return first;
}

static uint64_t union_enter(walk *w, uint32_t u, const lanes *from, uint64_t mask, lanes *best) {
  const qn_union *un = &w->normal->unions[u];
  const qn_nterm *terms = w->normal->terms;
  uint64_t found = 0;
  mask &= ~w->unsure;
  if (!mask) {
    return 0;
  }
  for (uint32_t i = 0; i < un->wide; i++) {
    term_enter(w, &terms[un->wide0 + i], from, mask, best, &found);
  }
  if (un->root == QN_NO_ROOT) {
    return found & ~w->unsure;
  }
  struct { float near; uint32_t node; } stack[STACK];
  int top = 0;
  float start = earliest(from, mask), end = latest(best, mask);
  stack[top].near = -INFINITY, stack[top++].node = un->root;
  while (top) {
    top--;
    if (stack[top].near > end) {
      continue;
    }
    uint32_t at = stack[top].node;
    if (at & QN_BVH_LEAF) {
      const qn_nterm *t = &terms[at & ~QN_BVH_LEAF];
      uint64_t in = subs_meet(w, t) & mask & ~w->unsure;
      if (in) {
        term_enter(w, t, from, in, best, &found);
        end = latest(best, mask & ~w->unsure);
      }
      continue;
    }
    const qn_bvh_node *n = &w->normal->nodes[at];
    _Alignas(32) float near[8];
    w->counts.nodes++;
    unsigned meets = node_meets(w, n, start, end, near);
    int first = top;
    for (; meets; meets &= meets - 1) { /* farthest first, so that the nearest is taken next */
      unsigned c = qn_trailing_zeros(meets);
      int j = top++;
      for (; j > first && stack[j - 1].near < near[c]; j--) {
        stack[j] = stack[j - 1];
      }
      stack[j].near = near[c], stack[j].node = n->child[c];
    }
  }
  return found & ~w->unsure;
}

/* Boxes of the lanes' points, one for each sub-packet; slack for their rounding. */
typedef struct spots { _Alignas(32) float min[3][SUBS], max[3][SUBS]; float all_min[3], all_max[3]; } spots;

static void spots_of(const walk *w, const lanes *at, uint64_t mask, spots *s) {
  const qn_packet *p = w->f.p;
  for (int i = 0; i < 3; i++) {
    s->all_min[i] = INFINITY, s->all_max[i] = -INFINITY;
    for (int k = 0; k < SUBS; k++) {
      double lo = INFINITY, hi = -INFINITY, size = 0;
      for (uint64_t m = mask >> (k * SUB_LANES) & 0xff; m; m &= m - 1) {
        unsigned j = (unsigned)k * SUB_LANES + qn_trailing_zeros(m);
        double step = at->t[j] * p->d[i][j], x = p->o[i][j] + step;
        size = most(size, fabs(step) + w->tolerance[j] * fabs(p->d[i][j]));
        lo = least(lo, x), hi = most(hi, x);
      }
      double slack = (size + most(fabs(lo), fabs(hi))) * 0x1p-40;
      for (uint64_t m = mask >> (k * SUB_LANES) & 0xff; m; m &= m - 1) {
        unsigned j = (unsigned)k * SUB_LANES + qn_trailing_zeros(m);
        slack = most(slack, w->tolerance[j] * fabs(p->d[i][j]) * 2);
      }
      int used = (mask >> (k * SUB_LANES) & 0xff) != 0;
      s->min[i][k] = used ? down(lo - slack) : INFINITY;
      s->max[i][k] = used ? up(hi + slack) : -INFINITY;
      s->all_min[i] = (s->min[i][k] < s->all_min[i] ? s->min[i][k] : s->all_min[i]), s->all_max[i] = (s->max[i][k] > s->all_max[i] ? s->max[i][k] : s->all_max[i]);
    }
  }
}

/* One pass: every term that holds a lane is left. Returns the lanes that moved. */
static uint64_t leave_once(walk *w, const qn_union *un, lanes *at, uint64_t mask) {
  const qn_nterm *terms = w->normal->terms;
  uint64_t moved = 0;
  for (uint32_t i = 0; i < un->wide; i++) {
    moved |= term_leave(w, &terms[un->wide0 + i], at, mask & ~w->unsure);
  }
  if (un->root == QN_NO_ROOT) {
    return moved;
  }
  mask &= ~w->unsure;
  spots s;
  spots_of(w, at, mask, &s);
  uint32_t stack[STACK];
  int top = 0;
  stack[top++] = un->root;
  while (top) {
    uint32_t node = stack[--top];
    if (node & QN_BVH_LEAF) {
      const qn_nterm *t = &terms[node & ~QN_BVH_LEAF];
      unsigned in = 0xff;
      for (int i = 0; i < 3; i++) {
        in &= fle(fset(t->min[i]), fload(s.max[i])) & fle(fload(s.min[i]), fset(t->max[i]));
      }
      uint64_t lanes_in = eights(in) & mask & ~w->unsure & ~moved; /* a lane that moved is elsewhere now: the next pass looks there */
      if (lanes_in) {
        moved |= term_leave(w, t, at, lanes_in);
      }
      continue;
    }
    const qn_bvh_node *n = &w->normal->nodes[node];
    w->counts.nodes++;
    unsigned in = 0xff;
    for (int i = 0; i < 3; i++) {
      in &= fle(fload(n->min[i]), fset(s.all_max[i])) & fle(fset(s.all_min[i]), fload(n->max[i]));
    }
    for (; in; in &= in - 1) {
      stack[top++] = n->child[qn_trailing_zeros(in)];
    }
  }
  return moved;
}

static uint64_t union_leave(walk *w, uint32_t u, lanes *at, uint64_t mask) {
  const qn_union *un = &w->normal->unions[u];
  uint64_t moved = 0, now = mask & ~w->unsure;
  while (now) {
    now = leave_once(w, un, at, now) & ~w->unsure;
    moved |= now;
  }
  return moved & ~w->unsure;
}

/* --- a packet ------------------------------------------------------------------------------------------------------ */

/* The least and largest of eight neighbouring lanes. */
QN_INLINE void extremes(const double *v, double *low, double *high) {
  vd a = vload(v), b = a;
  for (int i = QN_W; i < SUB_LANES; i += QN_W) {
    vd x = vload(v + i);
    a = vmin(a, x), b = vmax(b, x);
  }
  _Alignas(64) double x[QN_W], y[QN_W];
  vstore(x, a), vstore(y, b);
  *low = x[0], *high = y[0];
  for (int i = 1; i < QN_W; i++) {
    *low = least(*low, x[i]), *high = most(*high, y[i]);
  }
}

static void see_origins(qn_packet *p) {
  for (int i = 0; i < 3; i++) {
    p->low[i] = INFINITY, p->high[i] = -INFINITY;
    for (int k = 0; k < SUBS; k++) {
      double low, high;
      extremes(p->o[i] + k * SUB_LANES, &low, &high);
      p->omin[i][k] = down(low), p->omax[i][k] = up(high);
      p->low[i] = least(p->low[i], low), p->high[i] = most(p->high[i], high);
    }
  }
}

/* Eight lanes are four columns and two rows (packet.h); sums of what is monotone are extreme in the corners. */
static void see_tile_origins(qn_packet *p) {
  for (int i = 0; i < 3; i++) {
    double x[2][2], y[4][2];
    for (int h = 0; h < 2; h++) {
      double a = p->across[i][4 * h], b = p->across[i][4 * h + 3];
      x[h][0] = least(a, b), x[h][1] = most(a, b);
    }
    for (int h = 0; h < 4; h++) {
      double a = p->up[i][2 * h], b = p->up[i][2 * h + 1];
      y[h][0] = least(a, b), y[h][1] = most(a, b);
    }
    for (int k = 0; k < SUBS; k++) {
      int c = k >> 1 & 1, r = (k & 1) | (k >> 1 & 2);
      p->omin[i][k] = down(x[c][0] + y[r][0]), p->omax[i][k] = up(x[c][1] + y[r][1]);
    }
    p->low[i] = least(x[0][0], x[1][0]) + least(y[0][0], y[3][0]);
    p->high[i] = most(x[0][1], x[1][1]) + most(y[0][1], y[3][1]);
  }
}

static void fill_tile(qn_packet *p, double (*to)[QN_LANES]) {
  for (int i = 0; i < 3; i++) {
    for (unsigned q = 0; q < QN_LANES / 4; q++) { /* four lanes are two columns and two rows */
      unsigned c = (q & 1) << 1 | (q >> 1 & 2) << 1, r = (q >> 1 & 1) << 1 | (q >> 2 & 2) << 1;
      double *t = to[i] + 4 * q, a = p->across[i][c], b = p->across[i][c + 1], v = p->up[i][r], w = p->up[i][r + 1];
      t[0] = a + v, t[1] = b + v;
      t[2] = a + w, t[3] = b + w;
    }
  }
}

static void see_directions(qn_packet *p) {
  const vd zero = vset(0), one = vset(1);
  for (int g = 0; g < QN_LANES; g += QN_W) {
    vd dd = zero;
    for (int i = 0; i < 3; i++) {
      vd d = vload(p->d[i] + g);
      vm none = vandnot(vmask(QN_ALL_BITS), vor(vlt(d, zero), vlt(zero, d)));
      vstore(p->inv[i] + g, vpick(none, zero, vdiv(one, vpick(none, one, d))));
      dd = vfma(d, d, dd);
    }
    vstore(p->idd + g, vdiv(one, dd));
  }
  double low, high;
  p->dd_min = INFINITY, p->dd_max = 0;
  for (int k = 0; k < SUBS; k++) {
    extremes(p->idd + k * SUB_LANES, &low, &high);
    p->dd_min = least(p->dd_min, (1 - 0x1p-40) / high), p->dd_max = most(p->dd_max, (1 + 0x1p-40) / low);
  }
  for (int i = 0; i < 3; i++) {
    double dlow = INFINITY, dhigh = -INFINITY;
    int finite = 1;
    for (int k = 0; k < SUBS; k++) {
      extremes(p->d[i] + k * SUB_LANES, &low, &high);
      dlow = least(dlow, low), dhigh = most(dhigh, high);
      extremes(p->inv[i] + k * SUB_LANES, &low, &high);
      /* Widened away from the true range in either direction, so that the products' rounding cannot matter. */
      p->imin[i][k] = down(low - fabs(low) * 0x1p-20), p->imax[i][k] = up(high + fabs(high) * 0x1p-20);
      finite &= isfinite(p->imin[i][k]) && isfinite(p->imax[i][k]);
    }
    p->dabs[i] = most(fabs(dlow), fabs(dhigh));
    p->axis[i] = !finite ? AXIS_MIXED : dlow > 0 ? AXIS_UP : dhigh < 0 ? AXIS_DOWN : dlow == 0 && dhigh == 0 ? AXIS_FLAT : AXIS_MIXED;
  }
}

static void facts(walk *w, qn_packet *p) {
  packet_facts *f = &w->f;
  f->p = p;
  if (p->tile == QN_TILE_DIRECTIONS) {
    fill_tile(p, p->d);
  }
  if (p->tile == QN_TILE_ORIGINS) {
    see_tile_origins(p);
  } else if (p->new_origins) {
    see_origins(p);
  }
  if (p->new_directions) {
    see_directions(p);
  }
  double reach2 = 0;
  for (int i = 0; i < 3; i++) {
    w->all_omin[i] = INFINITY, w->all_omax[i] = -INFINITY, w->all_imin[i] = INFINITY, w->all_imax[i] = -INFINITY;
    for (int k = 0; k < SUBS; k++) {
      w->all_omin[i] = p->omin[i][k] < w->all_omin[i] ? p->omin[i][k] : w->all_omin[i], w->all_omax[i] = p->omax[i][k] > w->all_omax[i] ? p->omax[i][k] : w->all_omax[i];
      w->all_imin[i] = p->imin[i][k] < w->all_imin[i] ? p->imin[i][k] : w->all_imin[i], w->all_imax[i] = p->imax[i][k] > w->all_imax[i] ? p->imax[i][k] : w->all_imax[i];
    }
    double far = farthest(f, i, 0) + most(fabs(w->scene->min[i]), fabs(w->scene->max[i]));
    reach2 += far * far;
  }
  f->reach = 1.001 * sqrt(reach2 / p->dd_min);
}

void QN_FIRST(const struct quoin_scene *scene, qn_packet *packet, qn_packet_hits *hits, qn_wide_counts *counts);
void QN_FIRST(const struct quoin_scene *scene, qn_packet *packet, qn_packet_hits *hits, qn_wide_counts *counts) {
  walk w;
  w.scene = scene, w.normal = &scene->normal, w.unsure = 0, w.counts = (qn_wide_counts){0};
  facts(&w, packet);
  hits->unsure = hits->found = hits->leaving = hits->far_end = 0;
  const qn_union *root = &scene->normal.unions[scene->normal.root];
  if (root->wide == 0) { /* nothing near: no ray need be made */
    _Alignas(32) float near[8];
    counts->packets++, counts->nodes++;
    if (root->root == QN_NO_ROOT || !node_meets(&w, &scene->normal.nodes[root->root], -INFINITY, INFINITY, near)) {
      return;
    }
  }
  if (packet->tile == QN_TILE_ORIGINS) {
    fill_tile(packet, packet->o);
  }
  lanes start, best;
  const double nobody = payload_bits(QN_NOBODY);
  const vd none = vset(nobody);
  for (int j = 0; j < QN_LANES; j += QN_W) {
    vstore(w.tolerance + j, vset(0));
    vstore(start.t + j, vmax(vload(packet->from + j), vset(-QN_FAR)));
    vstore(best.t + j, vmin(vload(packet->to + j), vset(QN_FAR))), vstore(best.p + j, none);
  }
  for (int j = 0; j < QN_LANES; j++) {
    start.p[j] = payload_bits(packet->on[j] | QN_STARTS_ON);
  }
  uint64_t mask = packet->live, leaving = 0;
  uint64_t found = union_enter(&w, scene->normal.root, &start, mask, &best);
  uint64_t within = 0; /* lanes whose ray begins inside the set: their first boundary is where they leave it */
  for (int g = 0; g < QN_GROUPS; g++) {
    within |= (uint64_t)vsigns(vload(best.p + g * QN_W)) << (g * QN_W); /* QN_STARTS_ON */
  }
  within &= found;
  if (within) {
    lanes at = start;
    uint64_t left = union_leave(&w, scene->normal.root, &at, within);
    found &= ~(within & ~left);
    leaving = left;
    for (uint64_t m = left & ~w.unsure; m; m &= m - 1) {
      unsigned k = qn_trailing_zeros(m);
      best.t[k] = at.t[k], best.p[k] = at.p[k];
      double gap = packet->to[k] - at.t[k];
      if (gap < -w.tolerance[k] || at.t[k] >= QN_FAR) {
        found &= ~((uint64_t)1 << k);
      } else if (!(gap > w.tolerance[k])) {
        w.unsure |= (uint64_t)1 << k;
      }
    }
  }
  hits->unsure = w.unsure & packet->live;
  hits->found = found & packet->live & ~w.unsure;
  hits->leaving = (scene->normal.complement ? hits->found & ~leaving : leaving) & hits->found;
  hits->far_end = 0;
  for (uint64_t m = hits->found; m; m &= m - 1) {
    unsigned k = qn_trailing_zeros(m);
    uint64_t payload;
    memcpy(&payload, &best.p[k], 8);
    hits->t[k] = best.t[k];
    hits->error[k] = w.tolerance[k] / 2;
    hits->surface[k] = (uint32_t)payload;
    hits->leaf[k] = (uint32_t)(payload >> 32) & QN_LEAF_BITS;
    hits->far_end |= (payload >> 62 & 1) << k;
  }
  counts->nodes += w.counts.nodes, counts->leaves += w.counts.leaves, counts->packets++;
}
