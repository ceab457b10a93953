/* The packet body: the first boundary of up to QN_LANES_NOW rays. Compiled once for each instruction set, for 64 lanes (packet.wide.c) and
   for 8 (few.wide.c; see CMakeLists.txt). A single ray has a body of its own (one_body.h).

   Two questions that call each other walk the normal form (scene/normal.h). enter: the first place in a union at or after a
   lane's place. leave: the place after which no term of a union holds the lane. A term [a, b) minus S is entered at leave(S, max(a, t))
   when that is before b, and is left, when it holds t, at the sooner of b and enter(S, t). Ends compare as reals: apart by more than
   the errors' sum, sure; else equal when they are the same root of the same surface; else the lane is given up (unsure).
   A place stands for the stretch just after it, so ends are half-open and coincident faces come out regularised (S5). */
#ifndef QN_WIDE_PACKET_BODY_H
#define QN_WIDE_PACKET_BODY_H

#include "wide/facts.h"
#include "wide/heads.h"
#include "wide/lane_points.h"
#include "wide/lasts.h"
#include "wide/leaf_enter.h"
#include "wide/outline.h"

/* NOLINTBEGIN(misc-no-recursion): as deep as lists stand within lists, at most QN_NORMAL_DEPTH */

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
        if (next.t[k] < was.t[k] || next.t[k] > was.t[k]) {
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

static void term_enter(walk *w, const qn_nterm *t, const lanes *from, uint64_t mask, lanes *best, uint64_t *found) {
  const uint32_t line = qn_plain_line(w->scene, (uint32_t)(t - w->normal->terms));
  if (line != UINT32_MAX && piece_enter(w, t, piece_in(w, line), from, mask, best, found)) {
    return;
  }
  ends e;
  mask = term_solve(w, t, mask & ~w->unsure, &e);
  const int plain = !t->minus && !t->plus;
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
      *found |= (uint64_t)improve(w, t, g, m, t1, p1, best) << o;
    } else {
      order_entry(w, t, g, t1, p1, limit_t, limit_p, &m, &before, &equal);
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

/* Bounds of the true places of some lanes, as floats. */
QN_INLINE void span_of(const walk *w, const lanes *at, uint64_t mask, float *first, float *last) {
  vd low = vset(INFINITY), high = vset(-INFINITY);
  for (int g = 0; g < QN_GROUPS; g++) {
    unsigned in = (unsigned)(mask >> (g * QN_W)) & QN_ALL_BITS;
    if (in) {
      vm m = vmask(in);
      vd t = vload(at->t + g * QN_W), error = vload(w->tolerance + g * QN_W);
      low = vpick(m, vmin(low, vsub(t, error)), low), high = vpick(m, vmax(high, vadd(t, error)), high);
    }
  }
  _Alignas(64) double x[QN_W], y[QN_W];
  vstore(x, low), vstore(y, high);
  for (int i = 1; i < QN_W; i++) {
    x[0] = least(x[0], x[i]), y[0] = most(y[0], y[i]);
  }
  *first = down(x[0]), *last = up(y[0]);
}
static float latest(const walk *w, const lanes *at, uint64_t mask) {
  float first, last;
  span_of(w, at, mask, &first, &last);
  return last;
}
static float earliest(const walk *w, const lanes *at, uint64_t mask) {
  float first, last;
  span_of(w, at, mask, &first, &last);
  return first;
}

#if QN_LANES_NOW == 64
/* The ball that a node's child is, or null. */
QN_INLINE const qn_piece_sphere *ball_of(const walk *w, uint32_t child) {
  const uint32_t line = child & QN_BVH_LEAF ? qn_plain_line(w->scene, child & ~QN_BVH_LEAF) : UINT32_MAX;
  const qn_piece_head *head = line != UINT32_MAX ? piece_in(w, line) : NULL;
  return head && head->kind == QN_PIECE_SPHERE ? (const qn_piece_sphere *)(const void *)head : NULL;
}

/* Whether all that a tile may meet is one ball, and no lane meets that. */
QN_INLINE int misses_only(walk *w, const qn_union *un, const heads *h) {
  const uint32_t only = w->f.p->tile == QN_TILE_ORIGINS ? only_head(w->normal->nodes, un->root, h) : QN_BVH_NONE;
  const qn_piece_sphere *b = only == QN_BVH_NONE ? NULL : ball_of(w, only);
  return b && !outline_lanes(w, b);
}
#else
QN_INLINE int misses_only(walk *w, const qn_union *un, const heads *h) {
  (void)w, (void)un, (void)h;
  return 0;
}
#endif

/* The lanes, of `fours`, that may meet a node's child that is a term. */
QN_INLINE uint64_t lanes_meet_term(walk *w, const waiting *at, unsigned fours) {
#if QN_LANES_NOW == 64
  const qn_piece_sphere *b = outline_pays(w) ? ball_of(w, at->node) : NULL;
  if (b) {
    return w->f.p->tile == QN_TILE_ORIGINS ? lanes_of_fours(outline_fours(w, b) & fours) : outline_lanes(w, b) & lanes_of_fours(fours);
  }
  return subs_meet_child(w, &w->normal->nodes[at->parent], at->slot) & lanes_of_fours(fours);
#else
  (void)fours;
  return subs_meet_child(w, &w->normal->nodes[at->parent], at->slot);
#endif
}

/* No lane starts before `start` or has a best place after `end`. h: where the walk begins. any: a lane is done when a
   place is found, the first or not. */
static uint64_t union_walk(walk *w, const qn_union *un, const lanes *from, uint64_t mask, lanes *best, float start, float end, const heads *h, int any) {
  const qn_nterm *terms = w->normal->terms;
  uint64_t found = 0, better = 0;
  for (uint32_t i = 0; i < un->wide; i++) {
    term_enter(w, &terms[un->wide0 + i], from, any ? mask & ~better : mask, best, &better);
  }
  if (un->root == QN_NO_ROOT) {
    return better & ~w->unsure;
  }
  waiting stack[STACK];
  int top = push_heads(w, w->normal->nodes, un->root, h, stack, 1);
#if QN_LANES_NOW == 64
  lasts last;
  fstore(last.of, fset(end)), fstore(last.of + 8, fset(end));
  uint64_t changed = 0;
#endif
  for (int stale = 0;;) { /* stale: `end` is from before a place was found */
    if (better) {
      found |= better;
      mask &= any ? ~better : ~(uint64_t)0;
#if QN_LANES_NOW == 64
      changed |= better;
#endif
      better = 0, stale = 1;
      if (!mask) {
        return found & ~w->unsure;
      }
    }
    do {
      if (!top) {
        return found & ~w->unsure;
      }
    } while (stack[--top].near > end);
#if QN_LANES_NOW == 64
    if (changed) {
      see_lasts(w, best, mask & ~w->unsure, changed, &last);
      changed = 0;
    }
    const unsigned fours = fours_before(&last, stack[top].near);
    if (!fours) {
      continue;
    }
    if (stale && !(stack[top].node & QN_BVH_LEAF)) {
      end = last_of_all(&last), stale = 0;
    }
#else
    const unsigned fours = ~0u;
    if (stale && !(stack[top].node & QN_BVH_LEAF)) { /* of many lanes, as much work as a leaf: worth it for nodes only */
      end = latest(w, best, mask & ~w->unsure), stale = 0;
      if (stack[top].near > end) {
        continue;
      }
    }
#endif
    uint32_t at = stack[top].node;
    if (at & QN_BVH_LEAF) {
      uint64_t in = lanes_meet_term(w, &stack[top], fours) & mask & ~w->unsure;
      if (in) {
        term_enter(w, &terms[at & ~QN_BVH_LEAF], from, in, best, &better);
        if (!top) {
          return (found | better) & ~w->unsure;
        }
      }
      continue;
    }
    const qn_bvh_node *n = &w->normal->nodes[at];
    w->counts.nodes++;
    _Alignas(32) float near[8];
    const unsigned meets = node_meets(w, n, start, end, near);
    top = push_children(w, w->normal->nodes, at, meets, near, stack, top, 1);
  }
}

static uint64_t union_enter(walk *w, uint32_t u, const lanes *from, uint64_t mask, lanes *best) {
  mask &= ~w->unsure;
  if (!mask) {
    return 0;
  }
  const qn_union *un = &w->normal->unions[u];
  heads h;
  float start = earliest(w, from, mask), end = latest(w, best, mask);
  heads_meet(w, w->normal->nodes, un->root, NULL, start, end, &h);
  return union_walk(w, un, from, mask, best, start, end, &h, 0);
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
  lane_points s;
  lane_points_of(w, at, mask, &s);
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
      uint64_t lanes_in = points_meet_term(&s, t, in) & mask & ~w->unsure & ~moved; /* a lane that moved is elsewhere now: the next pass looks there */
      if (lanes_in) {
        moved |= term_leave(w, t, at, lanes_in);
      }
      continue;
    }
    const qn_bvh_node *n = &w->normal->nodes[node];
    w->counts.nodes++;
    unsigned in = fle(fload(n->min[0]), fload(n->max[0])); /* slots in use */
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

/* NOLINTEND(misc-no-recursion) */

/* The lanes that are outside the scene's set somewhere in their range. */
static uint64_t any_outside(walk *w, const lanes *start, uint64_t mask) {
  const qn_packet *p = w->f.p;
  lanes at = *start;
  uint64_t found = 0;
  union_leave(w, w->normal->root, &at, mask);
  for (uint64_t m = mask & ~w->unsure; m; m &= m - 1) {
    unsigned k = qn_trailing_zeros(m);
    double gap = p->to[k] - at.t[k];
    if (gap < -w->tolerance[k] || at.t[k] >= QN_FAR) {
      continue;
    }
    if (gap > w->tolerance[k] && fabs(at.t[k]) <= w->f.reach) {
      found |= (uint64_t)1 << k;
    } else {
      w->unsure |= (uint64_t)1 << k;
    }
  }
  return found;
}

void QN_FIRST(const struct quoin_scene *scene, qn_packet *packet, qn_packet_hits *hits, qn_wide_counts *counts);
void QN_FIRST(const struct quoin_scene *scene, qn_packet *packet, qn_packet_hits *hits, qn_wide_counts *counts) {
  walk w;
  w.scene = scene, w.normal = &scene->normal, w.unsure = 0, w.counts = (qn_wide_counts){.budget = counts->budget ? counts->budget * QN_GROUPS : UINT64_MAX};
  memset(w.ties, 0, sizeof w.ties), memset(w.open, 0, sizeof w.open);
#if QN_LANES_NOW == 64
  w.outline.made = 0, w.outline.asked = 0;
#endif
  hits->unsure = hits->found = hits->leaving = hits->far_end = hits->tied = hits->tied_surface = 0;
  if (!facts(&w, packet)) { /* numbers for which no bound is given */
    hits->unsure = packet->live;
    return;
  }
  const qn_union *root = &scene->normal.unions[scene->normal.root];
  heads h;
  const int meets = heads_meet(&w, scene->normal.nodes, root->root, entry_of(packet), packet->soonest, packet->latest, &h);
  counts->packets++;
  if (root->wide == 0 && (!meets || misses_only(&w, root, &h)) && !(packet->any && scene->normal.complement)) { /* nothing near: no ray need be made */
    counts->nodes += w.counts.nodes;
    return;
  }
  if (packet->tile == QN_TILE_ORIGINS) {
    fill_tile(packet, packet->o);
  }
#if QN_LANES_NOW == 64
  const lanes *start = &packet->start;
#else
  lanes first;
  memcpy(first.t, packet->start.t, sizeof first.t), memcpy(first.p, packet->start.p, sizeof first.p);
  const lanes *start = &first;
#endif
  lanes best;
  const vd none = vset(payload_bits(QN_NOBODY));
  for (int j = 0; j < QN_LANES_NOW; j += QN_W) {
    vstore(w.tolerance + j, vset(0));
    vstore(best.t + j, vload(packet->stop + j)), vstore(best.p + j, none);
  }
  uint64_t mask = packet->live & ~packet->empty, leaving = 0;
  for (uint64_t m = packet->live & packet->empty; m; m &= m - 1) { /* no stretch is left: of one point, or out of the range of ends */
    unsigned k = qn_trailing_zeros(m);
    w.unsure |= (uint64_t)(packet->from[k] < packet->to[k]) << k;
  }
  if (packet->any) {
    hits->found = (scene->normal.complement ? any_outside(&w, start, mask) : mask ? union_walk(&w, root, start, mask, &best, packet->soonest, packet->latest, &h, 1) : 0);
    for (uint64_t m = scene->normal.complement ? 0 : hits->found; m; m &= m - 1) {
      unsigned k = qn_trailing_zeros(m);
      w.unsure |= (uint64_t)!(fabs(best.t[k]) <= w.f.reach) << k; /* as below */
    }
    hits->unsure = w.unsure & packet->live;
    hits->found &= packet->live & ~w.unsure;
    counts->nodes += w.counts.nodes, counts->leaves += w.counts.leaves;
    return;
  }
  uint64_t found = mask ? union_walk(&w, root, start, mask, &best, packet->soonest, packet->latest, &h, 0) : 0;
  uint64_t within = 0; /* lanes whose ray begins inside the set: their first boundary is where they leave it */
  vd payloads = vset(0); /* of any lane */
  for (int j = 0; j < QN_LANES_NOW; j += QN_W) {
    payloads = vbitor(payloads, vload(best.p + j));
  }
  for (int g = 0; vsigns(payloads) && g < QN_GROUPS; g++) {
    within |= (uint64_t)vsigns(vload(best.p + g * QN_W)) << (g * QN_W); /* QN_STARTS_ON */
  }
  within &= found;
  if (within) {
    lanes at = *start;
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
  if (!found) {
    counts->nodes += w.counts.nodes, counts->leaves += w.counts.leaves;
    return;
  }
  const vd reach = vset(w.f.reach);
  vm near_all = vmask(QN_ALL_BITS);
  for (int j = 0; j < QN_LANES_NOW; j += QN_W) {
    vd t = vload(best.t + j);
    near_all = vand(near_all, vle(vabs(t), reach));
    vstore(hits->t + j, t), vstore(hits->error + j, vmul(vload(w.tolerance + j), vset(0.5)));
  }
  for (int g = 0; CHECKED && vbits(near_all) != QN_ALL_BITS && g < QN_GROUPS; g++) { /* beyond reach planes may have been taken for what they are not: something else is there */
    w.unsure |= (uint64_t)(QN_ALL_BITS & ~vbits(vle(vabs(vload(best.t + g * QN_W)), reach))) << (g * QN_W) & found;
  }
  for (int g = 0; (within || vsecond(payloads)) && g < QN_GROUPS; g++) {
    hits->far_end |= (uint64_t)vsecond(vload(best.p + g * QN_W)) << (g * QN_W);
  }
  hits->unsure = w.unsure & packet->live;
  hits->found = found & packet->live & ~w.unsure;
  hits->leaving = (scene->normal.complement ? hits->found & ~leaving : leaving) & hits->found;
  hits->far_end &= hits->found;
  enum { RUN = 8 };
  for (int j = 0; j < QN_LANES_NOW; j += RUN) {
    uint64_t any = 0, payload[RUN];
    memcpy(payload, best.p + j, sizeof payload);
    for (int k = 0; k < RUN; k++) {
      hits->surface[j + k] = (uint32_t)payload[k];
      hits->leaf[j + k] = (uint32_t)(payload[k] >> 32) & QN_LEAF_BITS;
    }
    memcpy(&any, w.ties + j, RUN);
    for (int k = j; any && k < j + RUN; k++) {
      unsigned here = w.ties[k] > TIES ? ALL_TIES : 0;
      for (int i = 0; i < w.ties[k] && i < TIES; i++) {
        here |= (unsigned)!(fabs(w.tie[i][k] - best.t[k]) > w.tolerance[k]) << i;
      }
      hits->tied |= (uint64_t)(here != 0) << k, hits->tied_surface |= (uint64_t)((here & w.open[k]) != 0) << k;
    }
  }
  hits->tied &= hits->found, hits->tied_surface &= hits->found;
  counts->nodes += w.counts.nodes, counts->leaves += w.counts.leaves;
}

#endif
