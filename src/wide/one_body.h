/* The first boundary of one ray: the questions of the packet body (wide/packet_body.h, which says what enter and leave are) asked of a single place, with the same
   solving, the same bounds and the same order of places, so that the answers are the same. Static code of one.wide.c.

   What is its own: a node's eight boxes are met by one multiply-add a plane, nothing is said of groups of lanes, and a ray that is given up is left at once. */
#ifndef QN_WIDE_ONE_BODY_H
#define QN_WIDE_ONE_BODY_H

#include "wide/facts.h"
#include "wide/term.h"

#define QN_USUAL 0x1p+50 /* of coordinates: what follows from them is then in the range of wide code, and of floats */

typedef struct place { double t, p; } place; /* and a payload's bits */
typedef enum turn { TURN_BEFORE, TURN_EQUAL, TURN_AFTER, TURN_UNKNOWN } turn;

/* NOLINTBEGIN(misc-no-recursion): as deep as lists stand within lists, at most QN_NORMAL_DEPTH */

static int union_enter(walk *w, uint32_t u, const place *from, place *best);
static int union_leave(walk *w, uint32_t u, place *at);

/* How x lies to y; unknown: the ray is given up. entered: as in settle_ties. */
QN_INLINE turn turn_of_entry(walk *w, const qn_nterm *entered, double x, double px, double y, double py) {
  const double gap = y - x;
  if (!CHECKED) {
    return gap > 0 ? TURN_BEFORE : TURN_AFTER;
  }
  if (gap > w->tolerance[0]) {
    return TURN_BEFORE;
  }
  if (-gap > w->tolerance[0]) {
    return TURN_AFTER;
  }
  unsigned equal = 0;
  settle_ties(w, 0, 1, x, gap, px, py, entered, &equal);
  return equal ? TURN_EQUAL : TURN_UNKNOWN;
}
QN_INLINE turn turn_of(walk *w, double x, double px, double y, double py) { return turn_of_entry(w, NULL, x, px, y, py); }
QN_INLINE turn turn_at(walk *w, const place *x, const place *y) { return turn_of(w, x->t, x->p, y->t, y->p); }

/* What facts() finds out, of one ray whose numbers are usual; 0: of another, nothing can be told here. */
QN_INLINE int quick_facts(walk *w, qn_packet *p) {
  packet_facts *f = &w->f;
  f->p = p;
  const int pairs = p->tile == QN_TILE_PAIRS;
  double dd = 0, far = 0, largest = 0, least_d = INFINITY;
  for (int i = 0; i < 3; i++) {
    const double o = p->o[i][0], d = p->d[i][0], size = fabs(o), length = fabs(d);
    const int flat = !(length > 0);
    p->low[i] = p->high[i] = o, p->dabs[i] = length;
    p->inv[i][0] = flat ? 0 : 1 / d;
    p->axis[i] = d > 0 ? AXIS_UP : flat ? AXIS_FLAT : AXIS_DOWN;
    w->all_omin[i] = down(o), w->all_omax[i] = up(o);
    f->share[i] = pairs ? size : 0;
    dd = vfma(d, d, dd);
    least_d = flat || least_d < length ? least_d : length, largest = largest > size ? largest : size;
    far += size + f->share[i] + most(fabs(w->scene->min[i]), fabs(w->scene->max[i]));
  }
  if (!(dd <= QN_WIDE_LARGEST && dd >= 1 / QN_WIDE_LARGEST && least_d >= 1 / QN_USUAL && largest <= QN_USUAL) || p->tile == QN_TILE_MOVED) {
    return 0;
  }
  const double idd = 1 / dd;
  p->idd[0] = idd;
  p->dd_min = (2 - QN_WIDE_SLACK) * dd, p->dd_max = QN_WIDE_SLACK * dd;
  p->d_most = sqrt(p->dd_max), p->idd_most = QN_WIDE_SLACK * QN_WIDE_SLACK * idd, p->shy = p->idd_most * p->d_most * QN_WIDE_SHY_ROOT;
  f->reach = QN_WIDE_SLACK * far * p->idd_most * p->d_most;
  const double from = p->from[0] > -QN_FAR ? p->from[0] : -QN_FAR, to = p->to[0] < QN_FAR ? p->to[0] : QN_FAR;
  p->start.t[0] = from, p->start.p[0] = payload_bits(p->on[0] | QN_STARTS_ON), p->stop[0] = to;
  p->empty = !(from < to);
  p->soonest = down(from), p->latest = up(to);
  beam_make(w);
  return w->beam.ready;
}

/* --- one piece, one term ------------------------------------------------------------------------------------------- */

static stretch round_solve_one(const walk *w, const qn_piece_round *r) {
  stretch s = whole_line();
  double y[3], d[3];
  from_pivot(w->f.p, 0, r->pivot, y, d);
  for (int i = 0; i < 2; i++) {
    if (r->surface[1 + i] != UINT32_MAX) {
      plane_constants k;
      plane_prepare(&w->f, r->pivot, r->cap[i], r->cap[i][3], r->surface[1 + i], r->head.leaf, &k);
      plane_meet(&w->f, &k, y, d, &s);
    }
  }
  if (s.b < s.a - 2 * s.error || !(s.hit | s.unsure)) { /* the caps leave nothing, for certain: whatever the body is unsure of does not matter */
    s.hit = s.unsure = 0;
    return s;
  }
  body_constants k;
  body_prepare(&w->f, r->pivot, r->row, r->s, r->l, r->k, r->reach, r->surface[0], r->head.leaf, &k);
  body_meet(&k, y, d, &s);
  stretch_settle(&s);
  return s;
}

QN_INLINE stretch solve_one(const walk *w, const qn_piece_head *head) {
  piece_constants k;
  switch ((qn_piece_kind)head->kind) {
  case QN_PIECE_SPHERE: sphere_prepare(&w->f, (const qn_piece_sphere *)(const void *)head, &k.sphere); return sphere_solve(&w->f, &k.sphere, 0);
  case QN_PIECE_BOX: box_prepare(&w->f, (const qn_piece_box *)(const void *)head, &k.box); return box_solve(&w->f, &k.box, 0);
  case QN_PIECE_ROUND: return round_solve_one(w, (const qn_piece_round *)(const void *)head);
  case QN_PIECE_MEET: meet_prepare(w, head->leaf, &k.meet); return meet_solve(w, &k.meet, head->leaf, 0);
  case QN_PIECE_HARD: break;
  }
  stretch s = whole_line();
  s.unsure = s.hit, s.hit = 0;
  return s;
}

/* The stretch of the ray in a term's leaves: 0 where there is none, or the ray was given up. */
QN_INLINE int stretch_in(walk *w, const qn_piece_head *first, const uint32_t *leaves, uint32_t count, stretch *s) {
  w->counts.leaves += count;
  *s = first ? solve_one(w, first) : whole_line();
  for (uint32_t i = 1; i < count; i++) {
    const stretch o = solve_one(w, piece_at(w, leaves[i]));
    stretch_meet(w, 0, s, &o);
  }
  note_errors(w, 0, s->error, s->hit);
  w->unsure |= s->unsure;
  return s->hit && !w->unsure;
}

static int term_stretch(walk *w, const qn_nterm *t, stretch *s) {
  if (QN_UNLIKELY(w->counts.leaves > w->counts.budget)) {
    w->unsure = 1;
    return 0;
  }
  const uint32_t *leaves = w->normal->leaves + t->leaf0;
  return stretch_in(w, t->leaves ? piece_at(w, leaves[0]) : NULL, leaves, t->leaves, s);
}

/* Moves `at` to the first place at or after it that is in all of the term's plus unions and in none of its minus unions: 0 where there is none before `limit`. */
static int term_seek(walk *w, const qn_nterm *t, place *at, const place *limit) {
  const uint32_t *list = w->normal->lists;
  for (;;) {
    int moved = 0;
    for (uint32_t i = 0; i < t->minus; i++) {
      moved |= union_leave(w, list[t->minus0 + i], at);
      if (w->unsure) {
        return 0;
      }
    }
    int again = t->minus > 1 ? moved : 0;
    for (uint32_t i = 0; i < t->plus; i++) {
      place next = *limit;
      if (!union_enter(w, list[t->plus0 + i], at, &next) || w->unsure) {
        return 0;
      }
      again |= next.t < at->t || next.t > at->t;
      *at = next;
    }
    if (turn_at(w, at, limit) != TURN_BEFORE) {
      return 0;
    }
    if (!again) {
      return 1;
    }
  }
}

/* The place of entry becomes the best where it is sooner; of two leaves with this surface there, the first in the file is named. */
QN_INLINE int improve(walk *w, const qn_nterm *entered, double t, double p, place *best) {
  switch (turn_of_entry(w, entered, t, p, best->t, best->p)) {
  case TURN_BEFORE: best->t = t, best->p = p; return 1;
  case TURN_EQUAL:
    if ((vword(p) >> 32 & QN_LEAF_BITS) < (vword(best->p) >> 32 & QN_LEAF_BITS)) {
      best->p = p;
    }
    return 1;
  case TURN_AFTER: case TURN_UNKNOWN: break;
  }
  return 0;
}

/* A term that is one leaf and no more. */
QN_INLINE int plain_enter(walk *w, const qn_nterm *t, const qn_piece_head *head, const place *from, place *best) {
  stretch s;
  if (!stretch_in(w, head, NULL, 1, &s) || turn_of(w, from->t, from->p, s.b, s.pb) != TURN_BEFORE) {
    return 0;
  }
  const turn ahead = turn_of(w, from->t, from->p, s.a, s.pa);
  if (ahead == TURN_UNKNOWN) {
    return 0;
  }
  return ahead == TURN_BEFORE ? improve(w, t, s.a, s.pa, best) : improve(w, t, from->t, from->p, best);
}

static int term_enter(walk *w, const qn_nterm *t, const place *from, place *best) {
  const uint32_t line = qn_plain_line(w->scene, (uint32_t)(t - w->normal->terms));
  if (line != UINT32_MAX) {
    const qn_piece_head *head = piece_in(w, line);
    if (head->kind == QN_PIECE_SPHERE || head->kind == QN_PIECE_BOX || w->counts.leaves <= w->counts.budget) {
      return plain_enter(w, t, head, from, best);
    }
    w->unsure = 1;
    return 0;
  }
  stretch s;
  if (!term_stretch(w, t, &s) || turn_of(w, from->t, from->p, s.b, s.pb) != TURN_BEFORE) {
    return 0;
  }
  const turn ahead = turn_of(w, from->t, from->p, s.a, s.pa);
  if (ahead == TURN_UNKNOWN) {
    return 0;
  }
  place at = *from;
  if (ahead == TURN_BEFORE) {
    at = (place){s.a, s.pa};
  }
  if (!t->minus && !t->plus) {
    return improve(w, t, at.t, at.p, best);
  }
  if (turn_of_entry(w, t, at.t, at.p, best->t, best->p) != TURN_BEFORE) {
    return 0;
  }
  place limit = *best; /* the sooner of the end and best bounds the search */
  const turn sooner = turn_of(w, s.b, s.pb, best->t, best->p);
  if (sooner == TURN_BEFORE) {
    limit = (place){s.b, s.pb};
  }
  if (sooner == TURN_UNKNOWN || !term_seek(w, t, &at, &limit) || w->unsure) {
    return 0;
  }
  *best = at;
  return 1;
}

/* The term is left: `at`, which it holds, moves to its end. Whether it moved. */
static int term_leave(walk *w, const qn_nterm *t, place *at) {
  stretch s;
  if (!term_stretch(w, t, &s) || turn_of(w, at->t, at->p, s.b, s.pb) != TURN_BEFORE) {
    return 0;
  }
  const turn ahead = turn_of(w, at->t, at->p, s.a, s.pa); /* held where a <= t */
  if (ahead == TURN_BEFORE || ahead == TURN_UNKNOWN) {
    return 0;
  }
  place end = {s.b, s.pb};
  const uint32_t *list = w->normal->lists;
  place probe = *at;
  for (uint32_t i = 0; i < t->minus; i++) { /* in a subtrahend: not held; else out where the next one begins */
    if (union_leave(w, list[t->minus0 + i], &probe) || w->unsure) {
      return 0;
    }
    union_enter(w, list[t->minus0 + i], at, &end);
    if (w->unsure) {
      return 0;
    }
  }
  for (uint32_t i = 0; i < t->plus; i++) {
    probe = *at;
    if (!union_leave(w, list[t->plus0 + i], &probe) || w->unsure) {
      return 0;
    }
    const turn sooner = turn_at(w, &probe, &end);
    if (sooner == TURN_UNKNOWN) {
      return 0;
    }
    if (sooner == TURN_BEFORE) {
      end = probe;
    }
  }
  *at = end;
  return 1;
}

/* --- unions -------------------------------------------------------------------------------------------------------- */

QN_INLINE float latest(const walk *w, const place *at) { return up(at->t + w->tolerance[0]); }
QN_INLINE float earliest(const walk *w, const place *at) { return down(at->t - w->tolerance[0]); }

typedef struct waiting { float near; uint32_t node; } waiting; /* node: or QN_BVH_LEAF | term */

QN_INLINE void fetch_child(const walk *w, uint32_t child) {
  if (child & QN_BVH_LEAF) {
    const uint32_t line = qn_plain_line(w->scene, child & ~QN_BVH_LEAF);
    const void *next = line != UINT32_MAX ? (const void *)piece_in(w, line) : &w->normal->terms[child & ~QN_BVH_LEAF];
    QN_FETCH(next);
  } else {
    const qn_bvh_node *n = &w->normal->nodes[child];
    QN_FETCH(n), QN_FETCH(n->max), QN_FETCH(&n->max[2]), QN_FETCH(&n->min[2]);
  }
}

/* Farthest first, so that the nearest is taken next. fetch: all of them are asked of memory. */
QN_INLINE int push_children(const walk *w, const qn_bvh_node *n, unsigned meets, const float near[8], waiting *stack, int top, int fetch) {
  for (const int first = top; meets; meets &= meets - 1) {
    const unsigned c = qn_trailing_zeros(meets);
    int j = top++;
    for (; j > first && stack[j - 1].near < near[c]; j--) {
      stack[j] = stack[j - 1];
    }
    stack[j] = (waiting){near[c], n->child[c]};
    if (fetch) {
      fetch_child(w, n->child[c]);
    }
  }
  return top;
}

/* A walk through a union's hierarchy, which can be left after each step and taken up again. The ray does not start before `start`. */
typedef struct stroll {
  const place *from;
  place *best;
  int any, found, top; /* any: a place is enough, the first or not */
  uint32_t at;
  float start, last;
} stroll;

/* `end` is not before the best place. 0: there is no more to do. */
QN_INLINE int stroll_begin(walk *w, stroll *s, const qn_union *un, const place *from, place *best, float start, float end, int any) {
  int found = 0;
  for (uint32_t i = 0; i < un->wide && !w->unsure && !(any && found); i++) {
    found |= term_enter(w, &w->normal->terms[un->wide0 + i], from, best);
  }
  *s = (stroll){from, best, any, found, 0, un->root, start, beam_end(found ? latest(w, best) : end)};
  return !(un->root == QN_NO_ROOT || w->unsure || (any && found));
}

/* One node or one term. 0: there is no more to do. ahead: what is next is asked of memory and nothing else, for whoever does something else meanwhile. */
QN_INLINE int stroll_step(walk *w, stroll *s, waiting *stack, int ahead) {
  if (!(s->at & QN_BVH_LEAF)) {
    const qn_bvh_node *n = &w->normal->nodes[s->at];
    _Alignas(32) float near[8];
    w->counts.nodes++;
    const unsigned meets = node_meets(w, n, s->start, s->last, near);
    if (meets & (meets - 1)) {
      s->top = push_children(w, n, meets, near, stack, s->top, !ahead);
    } else if (meets) {
      s->at = n->child[qn_trailing_zeros(meets)];
      if (ahead) {
        fetch_child(w, s->at);
      }
      return 1;
    }
  } else if (term_enter(w, &w->normal->terms[s->at & ~QN_BVH_LEAF], s->from, s->best)) {
    s->found = 1;
    if (s->any) {
      return 0;
    }
    s->last = beam_end(latest(w, s->best));
  } else if (w->unsure) {
    s->found = 0;
    return 0;
  }
  do {
    if (!s->top) {
      return 0;
    }
    /* cppcheck-suppress uninitvar ; what is below top has been pushed */
  } while (stack[--s->top].near > s->last);
  s->at = stack[s->top].node;
  if (ahead) {
    fetch_child(w, s->at);
  }
  return 1;
}

static int union_walk(walk *w, const qn_union *un, const place *from, place *best, float start, float end, int any) {
  stroll s;
  if (stroll_begin(w, &s, un, from, best, start, end, any)) {
    waiting stack[STACK];
    while (stroll_step(w, &s, stack, 0)) {
    }
  }
  return s.found;
}

static int union_enter(walk *w, uint32_t u, const place *from, place *best) {
  return union_walk(w, &w->normal->unions[u], from, best, earliest(w, from), latest(w, best), 0);
}

/* One pass: every term that holds the place is left, the first that does. Whether it moved. */
static int leave_once(walk *w, const qn_union *un, place *at) {
  const qn_nterm *terms = w->normal->terms;
  int moved = 0;
  for (uint32_t i = 0; i < un->wide && !w->unsure; i++) {
    moved |= term_leave(w, &terms[un->wide0 + i], at);
  }
  if (un->root == QN_NO_ROOT || w->unsure || moved) {
    return moved;
  }
  const qn_packet *p = w->f.p;
  vf8 low[3], high[3];
  for (int i = 0; i < 3; i++) { /* where the place is */
    const double d = p->d[i][0], step = at->t * d, x = p->o[i][0] + step;
    const double slack = vfma(fabs(step) + fabs(x), QN_WIDE_SPOT, w->tolerance[0] * fabs(d) * 4) + 2 * QN_U * w->f.share[i];
    low[i] = fset(down(x - slack)), high[i] = fset(up(x + slack));
  }
  uint32_t stack[STACK];
  int top = 0;
  stack[top++] = un->root;
  while (top) {
    const uint32_t node = stack[--top];
    if (node & QN_BVH_LEAF) {
      if (term_leave(w, &terms[node & ~QN_BVH_LEAF], at)) {
        return 1; /* it is elsewhere now: the next pass looks there */
      }
      if (w->unsure) {
        return 0;
      }
      continue;
    }
    const qn_bvh_node *n = &w->normal->nodes[node];
    w->counts.nodes++;
    unsigned in = fle(fload(n->min[0]), fload(n->max[0])); /* slots in use */
    for (int i = 0; i < 3; i++) {
      in &= fle(fload(n->min[i]), high[i]) & fle(low[i], fload(n->max[i]));
    }
    for (; in; in &= in - 1) {
      stack[top++] = n->child[qn_trailing_zeros(in)];
    }
  }
  return 0;
}

static int union_leave(walk *w, uint32_t u, place *at) {
  const qn_union *un = &w->normal->unions[u];
  int moved = 0;
  while (!w->unsure && leave_once(w, un, at)) {
    moved = 1;
  }
  return moved;
}

/* NOLINTEND(misc-no-recursion) */

#endif
