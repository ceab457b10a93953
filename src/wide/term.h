/* One term against a packet: the stretch of each lane in its positive part. Static code of the packet body. */
#ifndef QN_WIDE_TERM_H
#define QN_WIDE_TERM_H

#include "wide/walk.h"

/* Of a meet: its half-spaces' constants, planes first, since they settle which side of a body that opens counts. */
typedef struct meet_constants {
  int planes, bodies;
  plane_constants plane[QN_MEET_PLANES];
  body_constants body[QN_MEET_BODIES];
} meet_constants;

typedef union piece_constants {
  sphere_constants sphere;
  box_constants box;
  struct { int slab; slab_constants caps; plane_constants cap[2]; body_constants body; } round; /* slab: `caps` stands for both of cap[]; of one lane that gains nothing */
  meet_constants meet;
} piece_constants;

QN_INLINE const qn_piece_head *piece_in(const walk *w, uint32_t line) {
  return (const qn_piece_head *)(const void *)((const char *)w->scene->lines + (size_t)line * 64);
}
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
    body_prepare(&w->f, l->pivot, q->row, q->s, q->l, q->k, sqrt(reach) * QN_WIDE_SLACK, half->surface, leaf, &k->body[k->bodies++]);
  }
}

#if QN_LANES_NOW > 1
static void piece_prepare(const walk *w, const qn_piece_head *head, piece_constants *k) {
  switch ((qn_piece_kind)head->kind) {
  case QN_PIECE_SPHERE: sphere_prepare(&w->f, (const qn_piece_sphere *)(const void *)head, &k->sphere); break;
  case QN_PIECE_BOX: box_prepare(&w->f, (const qn_piece_box *)(const void *)head, &k->box); break;
  case QN_PIECE_ROUND: {
    const qn_piece_round *r = (const qn_piece_round *)(const void *)head;
    k->round.slab = r->surface[1] != UINT32_MAX && r->surface[2] != UINT32_MAX && r->cap[0][0] == -r->cap[1][0] && r->cap[0][1] == -r->cap[1][1] && r->cap[0][2] == -r->cap[1][2];
    if (k->round.slab) {
      slab_prepare(&w->f, r->pivot, r->cap[0], r->cap[0][3], r->cap[1][3], r->surface[1], r->surface[2], head->leaf, &k->round.caps);
    }
    for (int i = 0; i < 2 && !k->round.slab; i++) {
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

#endif

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
    body_meet(&k->body[i], y, d, &s);
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
    if (k->round.slab) {
      slab_meet(&w->f, &k->round.caps, y, d, &s);
    }
    for (int i = 0; i < 2 && !k->round.slab; i++) {
      if (r->surface[1 + i] != UINT32_MAX) {
        plane_meet(&w->f, &k->round.cap[i], y, d, &s);
      }
    }
    body_meet(&k->round.body, y, d, &s);
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

/* Takes note of the errors of a stretch's ends, where it has ends. */
QN_INLINE void note_errors(walk *w, int g, vd error, vm hit) {
  if (!CHECKED) {
    return;
  }
  double *tolerance = w->tolerance + g * QN_W;
  vstore(tolerance, vmax(vload(tolerance), vpick(hit, vmul(error, vset(2)), vset(0))));
}

/* The later of two entries and the sooner of two exits. */
static void stretch_meet(walk *w, int g, stretch *s, const stretch *o) {
  vm both = vand(s->hit, o->hit), before, equal;
  s->unsure = vor(vand(s->unsure, vor(o->hit, o->unsure)), vand(o->unsure, vor(s->hit, s->unsure)));
  s->error = vmax(s->error, o->error);
  note_errors(w, g, s->error, both);
  order(w, g, s->a, s->pa, o->a, o->pa, &both, &before, &equal);
  s->a = vpick(before, o->a, s->a), s->pa = vpick(before, o->pa, s->pa);
  order(w, g, o->b, o->pb, s->b, s->pb, &both, &before, &equal);
  s->b = vpick(before, o->b, s->b), s->pb = vpick(before, o->pb, s->pb);
  order(w, g, s->a, s->pa, s->b, s->pb, &both, &before, &equal);
  s->hit = before;
}

#if QN_LANES_NOW > 1 /* one ray has its own: wide/one_body.h */
typedef struct ends { _Alignas(64) double a[QN_LANES_NOW], b[QN_LANES_NOW], pa[QN_LANES_NOW], pb[QN_LANES_NOW]; } ends;

/* Solves a term's positive part for the lanes of `mask`; returns those that meet it. */
static uint64_t term_solve(walk *w, const qn_nterm *t, uint64_t mask, ends *out) {
  const uint32_t *leaves = w->normal->leaves + t->leaf0;
  uint64_t hits = 0;
  if (QN_UNLIKELY(w->counts.leaves > w->counts.budget)) {
    w->unsure = ~(uint64_t)0;
    return 0;
  }
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
    s.hit = vand(s.hit, vmask(lanes_in)); /* the others are not to be given up here */
    for (uint32_t i = 1; i < t->leaves; i++) {
      piece_constants other;
      const qn_piece_head *h = i < READY ? head[i] : piece_at(w, leaves[i]);
      if (i >= READY) {
        piece_prepare(w, h, &other);
      }
      stretch o = piece_solve(w, h, i < READY ? &k[i] : &other, g);
      stretch_meet(w, g, &s, &o);
    }
    note_errors(w, g, s.error, s.hit);
    w->unsure |= (uint64_t)(vbits(s.unsure) & lanes_in) << (g * QN_W);
    int at = g * QN_W;
    vstore(out->a + at, s.a), vstore(out->b + at, s.b), vstore(out->pa + at, s.pa), vstore(out->pb + at, s.pb);
    hits |= (uint64_t)(vbits(s.hit) & lanes_in) << at;
  }
  return hits & ~w->unsure;
}
#endif

#endif
