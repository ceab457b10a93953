/* Every stretch of a packet's rays in the leaves that they meet. Compiled behind packet_body.h for each instruction set and number of lanes.

   The hierarchy of all leaves is walked once for the packet, nearest boxes first, so that a lane's stretches come nearly in order; each leaf
   is solved for the lanes whose boxes meet its own. Then they are merged: of a simple program by sorting (spans_merge.h), of another by plans (spans_plan.h); what is not certain there
   is left to others. */
#ifndef QN_WIDE_SPANS_BODY_H
#define QN_WIDE_SPANS_BODY_H

#include "wide/spans_plan.h"

/* NOLINTNEXTLINE(misc-redundant-expression): they are equal today; that is what is asserted */
_Static_assert(QN_SPAN_LARGER == QN_LARGER_ROOT && QN_SPAN_LEAF == QN_LEAF_BITS, "packet.h tells what payloads are");

QN_INLINE void leaf_spans_of(walk *w, qn_piece_kind kind, const qn_piece_head *head, uint64_t mask, qn_packet_spans *out) {
  const qn_leaf *leaf = &w->scene->leaves[head->leaf];
  const qn_span_slot found = {head->leaf, leaf->gate, leaf->negated, leaf->negated == w->scene->program.gates[leaf->gate].is_and, 0};
  piece_constants k;
  if (kind == QN_PIECE_SPHERE) {
    sphere_prepare(&w->f, (const qn_piece_sphere *)(const void *)head, &k.sphere);
  } else if (kind == QN_PIECE_BOX) {
    box_prepare(&w->f, (const qn_piece_box *)(const void *)head, &k.box);
  } else {
    piece_prepare(w, head, &k);
  }
  for (int g = 0; g < QN_GROUPS; g++) {
    unsigned in = (unsigned)(mask >> (g * QN_W)) & QN_ALL_BITS;
    if (!in) {
      continue;
    }
    w->counts.leaves++;
    stretch s = kind == QN_PIECE_SPHERE ? sphere_solve(&w->f, &k.sphere, g) : kind == QN_PIECE_BOX ? box_solve(&w->f, &k.box, g) : piece_solve(w, head, &k, g);
    w->unsure |= (uint64_t)(vbits(s.unsure) & in) << (g * QN_W);
    vm hit = vand(s.hit, vmask(in));
    unsigned bits = vbits(hit);
    if (!bits) {
      continue;
    }
    note_errors(w, g, s.error, hit);
    if (QN_UNLIKELY(out->count[g] == out->capacity)) {
      out->full = 1;
      return;
    }
    size_t slot = (size_t)g * out->capacity + out->count[g]++;
    double *v = out->ends + slot * 4 * QN_W;
    vstore(v, s.a), vstore(v + QN_W, s.b), vstore(v + 2 * QN_W, s.pa), vstore(v + 3 * QN_W, s.pb);
    out->slots[slot] = found, out->slots[slot].hit = (uint8_t)bits;
  }
}

static void leaf_spans(walk *w, uint32_t leaf, uint64_t mask, qn_packet_spans *out) {
  if (w->scene->leaves[leaf].gate == QN_NO_GATE) {
    return; /* it has no part in the answer */
  }
  const qn_piece_head *head = piece_at(w, leaf);
  switch ((qn_piece_kind)head->kind) {
  case QN_PIECE_SPHERE: leaf_spans_of(w, QN_PIECE_SPHERE, head, mask, out); return;
  case QN_PIECE_BOX: leaf_spans_of(w, QN_PIECE_BOX, head, mask, out); return;
  case QN_PIECE_MEET: out->limited = 1; break;
  case QN_PIECE_ROUND: case QN_PIECE_HARD: break;
  }
  leaf_spans_of(w, QN_PIECE_ROUND, head, mask, out);
}

/* The lanes that may meet a node's child that is a leaf. */
QN_INLINE uint64_t lanes_meet_leaf(walk *w, const waiting *at, uint32_t leaf) {
#if QN_LANES_NOW == 64
  if (w->f.p->tile == QN_TILE_ORIGINS) {
    const qn_piece_head *head = piece_at(w, leaf);
    if (head->kind == QN_PIECE_SPHERE) {
      return outline_lanes(w, (const qn_piece_sphere *)(const void *)head);
    }
  }
#endif
  (void)leaf;
  return subs_meet_child(w, &w->scene->bvh.nodes[at->parent], at->slot);
}

/* Asks memory for what is needed of a node of the hierarchy of all leaves, or of a leaf there. */
QN_INLINE void fetch_met(const walk *w, uint32_t child) {
  const qn_bvh *bvh = &w->scene->bvh;
  if (child & QN_BVH_LEAF) {
    const uint32_t leaf = bvh->items[child & ~QN_BVH_LEAF];
    QN_FETCH(&w->scene->leaves[leaf].gate), QN_FETCH(piece_at(w, leaf));
  } else {
    QN_FETCH(&bvh->nodes[child]), QN_FETCH(bvh->nodes[child].max), QN_FETCH(&bvh->nodes[child].max[2]);
  }
}

/* Where some lanes have no range, or one beyond what floats hold. */
static QN_NOINLINE void ranges(const qn_packet *packet, uint64_t *mask, float *start, float *end) {
  double from = INFINITY, to = -INFINITY;
  for (uint64_t m = packet->live; m; m &= m - 1) {
    unsigned k = qn_trailing_zeros(m);
    *mask &= ~((uint64_t)!(packet->from[k] < packet->to[k]) << k);
    from = least(from, packet->from[k]), to = most(to, packet->to[k]);
  }
  const double most_t = QN_WIDE_LARGEST; /* as a float; what lies beyond is not told apart */
  *start = from < -most_t ? -INFINITY : down(least(from, most_t)), *end = to > most_t ? INFINITY : up(most(to, -most_t));
}

void QN_SPANS(const struct quoin_scene *scene, qn_packet *packet, qn_packet_spans *out, qn_wide_counts *counts);
void QN_SPANS(const struct quoin_scene *scene, qn_packet *packet, qn_packet_spans *out, qn_wide_counts *counts) {
  walk w;
  w.scene = scene, w.normal = &scene->normal, w.unsure = 0, w.counts = (qn_wide_counts){0};
#if QN_LANES_NOW == 64
  w.outline.made = 0, w.outline.asked = 0;
#endif
  out->full = out->limited = 0, out->unsure = out->merged = 0, out->reach = INFINITY;
  memset(out->count, 0, sizeof out->count);
  counts->packets++;
  if (!facts(&w, packet)) { /* numbers for which no bound is given */
    out->unsure = packet->live;
    return;
  }
  memset(out->row_count, 0, sizeof out->row_count);
  float start = packet->soonest, end = packet->latest;
  uint64_t mask = packet->live;
  if (QN_UNLIKELY(packet->empty || !(start <= end))) { /* no numbers: they lie beyond floats */
    ranges(packet, &mask, &start, &end);
  }
  const qn_bvh_node *nodes = scene->bvh.nodes;
  const uint32_t root = scene->bvh.node_count && mask ? 0 : QN_NO_ROOT;
  const int far = qn_scene_is_far(scene);
  heads h;
  if (!heads_meet(&w, nodes, root, root == QN_NO_ROOT ? NULL : entry_of(packet), start, end, &h) && !scene->unbounded_count) { /* nothing near: no ray need be made */
    out->merged = scene->program.base ? 0 : packet->live;
    out->reach = w.f.reach;
    counts->nodes += w.counts.nodes;
    return;
  }
  if (packet->tile == QN_TILE_ORIGINS) {
    fill_tile(packet, packet->o);
  }
  for (int j = 0; j < QN_LANES_NOW; j += QN_W) {
    vstore(w.tolerance + j, vset(0));
  }
  for (size_t i = 0; i < scene->unbounded_count; i++) {
    leaf_spans(&w, scene->unbounded[i], mask & ~w.unsure, out);
  }
  waiting stack[STACK];
  int top = push_heads(&w, nodes, root, &h, stack, 0);
  while (top && !out->full) {
    top--;
    uint32_t at = stack[top].node;
    if (at & QN_BVH_LEAF) {
      const uint32_t leaf = scene->bvh.items[at & ~QN_BVH_LEAF];
      const uint64_t in = lanes_meet_leaf(&w, &stack[top], leaf) & mask & ~w.unsure;
      if (in) {
        leaf_spans(&w, leaf, in, out);
      }
      continue;
    }
    w.counts.nodes++;
    _Alignas(32) float near[8];
    const unsigned meets = node_meets(&w, &nodes[at], start, end, near);
    const int below = top;
    top = push_children(&w, nodes, at, meets, near, stack, top, 0);
    for (int i = below; far && i < top; i++) {
      fetch_met(&w, stack[i].node);
    }
  }
  memcpy(out->tolerance, w.tolerance, sizeof w.tolerance);
  out->unsure = w.unsure & packet->live;
  out->reach = w.f.reach;
  counts->nodes += w.counts.nodes, counts->leaves += w.counts.leaves;
  if (!out->full) {
    if (QN_LANES_NOW > QN_FEW && out->plans && !can_merge(&scene->program) && !scene->program.base) {
      plan_groups(&w, out);
    } else {
      merge_groups(&w, out);
    }
    out->merged &= packet->live & ~w.unsure;
  }
}

#endif
