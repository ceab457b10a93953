/* Where the walks of neighbouring tiles begin: the upper part of a hierarchy, walked once for all of them. A tile met two nodes in five of those on its way to a leaf of 10,000 spheres for nothing
   but to be where its neighbour had been. Compiled behind packet_body.h. */
#ifndef QN_WIDE_ENTRY_BODY_H
#define QN_WIDE_ENTRY_BODY_H

enum { CUT = QN_ENTRY_BOXES }; /* boxes of an entry at most: more to be looked at by each tile, fewer on its way down */

typedef struct cut {
  waiting box[CUT], stack[CUT]; /* done with, by near; and what may be divided yet, the nearest last */
  unsigned done;
} cut;

/* A box that is smaller than so much of all the tiles' width is met by too few of them: what stands in it is left to those. */
#define CUT_SHARE 0.6f

/* How wide the tiles lie together; of rays that converge, at t = 1. */
static float width_of(const qn_packet *p) {
  double widest = 0;
  for (int i = 0; i < 3; i++) {
    widest = most(widest, fabs(p->across[i][7] - p->across[i][0]) + fabs(p->up[i][7] - p->up[i][0]));
  }
  return (float)widest;
}

static int is_small(const qn_packet *p, const qn_bvh_node *nodes, const waiting *at, float width) {
  const qn_bvh_node *n = &nodes[at->parent];
  float size = 0;
  for (int i = 0; i < 3; i++) {
    const float length = n->max[i][at->slot] - n->min[i][at->slot];
    size = length > size ? length : size;
  }
  return size < CUT_SHARE * width * (p->tile == QN_TILE_DIRECTIONS ? at->near : 1);
}

static void cut_done(cut *c, waiting box) {
  unsigned k = c->done++;
  for (; k > 0 && box.near < c->box[k - 1].near; k--) {
    c->box[k] = c->box[k - 1];
  }
  c->box[k] = box;
}

/* A node's children that are met take its place, those of the nearest first, while there is room. */
static void cut_make(walk *w, const qn_bvh_node *nodes, uint32_t root, cut *c) {
  const qn_packet *p = w->f.p;
  const float start = p->soonest, end = p->latest, width = width_of(p);
  _Alignas(32) float near[8];
  c->done = 0;
  int top = push_children(w, nodes, root, node_meets(w, &nodes[root], start, end, near), near, c->stack, 0, 0);
  w->counts.nodes++;
  while (top) {
    const waiting at = c->stack[--top];
    if (at.node & QN_BVH_LEAF || is_small(p, nodes, &at, width)) {
      cut_done(c, at);
      continue;
    }
    const unsigned meets = node_meets(w, &nodes[at.node], start, end, near);
    w->counts.nodes++;
    if (c->done + (unsigned)top + qn_bits_set(meets) > CUT) {
      cut_done(c, at);
      continue;
    }
    for (unsigned m = meets; m; m &= m - 1) { /* among all that wait, where a walk sorts a node's children only */
      const unsigned slot = qn_trailing_zeros(m);
      push_child(w, (waiting){near[slot], nodes[at.node].child[slot], at.node, slot}, c->stack, 0, top++, 0);
    }
  }
}

int QN_OF_ISA(qn_enter)(const struct quoin_scene *scene, qn_packet *packet, int leaves, qn_entry *entry, qn_wide_counts *counts);
int QN_OF_ISA(qn_enter)(const struct quoin_scene *scene, qn_packet *packet, int leaves, qn_entry *entry, qn_wide_counts *counts) {
  const qn_bvh_node *nodes = leaves ? scene->bvh.nodes : scene->normal.nodes;
  const uint32_t root = !leaves ? scene->normal.unions[scene->normal.root].root : scene->bvh.node_count ? 0 : QN_NO_ROOT;
  int inner = 0;
  for (int i = 0; root != QN_NO_ROOT && i < QN_BVH_WIDE; i++) {
    inner |= !(nodes[root].child[i] & QN_BVH_LEAF); /* QN_BVH_NONE has that bit */
  }
  walk w;
  w.scene = scene, w.normal = &scene->normal, w.counts = (qn_wide_counts){0};
  cut c;
  if (!inner || !facts(&w, packet) || packet->empty || !(packet->soonest <= packet->latest)) {
    return 0;
  }
  cut_make(&w, nodes, root, &c);
  counts->nodes += w.counts.nodes;
  entry->count = (c.done + 7) / 8;
  for (unsigned i = 0; i < 8 * entry->count; i++) {
    qn_bvh_node *to = &entry->nodes[i / 8];
    const unsigned slot = i % 8;
    for (int k = 0; k < 3; k++) { /* what is left over is as an empty slot of any node */
      to->min[k][slot] = i < c.done ? nodes[c.box[i].parent].min[k][c.box[i].slot] : INFINITY;
      to->max[k][slot] = i < c.done ? nodes[c.box[i].parent].max[k][c.box[i].slot] : -INFINITY;
    }
    to->child[slot] = i < c.done ? c.box[i].node : QN_BVH_NONE;
    entry->parent[i] = i < c.done ? c.box[i].parent : 0, entry->slot[i] = i < c.done ? c.box[i].slot : 0;
  }
  return 1;
}

#endif
