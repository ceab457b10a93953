/* Where a packet's walk through a hierarchy begins, and what waits in it. Static code of the packet body. */
#ifndef QN_WIDE_HEADS_H
#define QN_WIDE_HEADS_H

#include "wide/term.h"

typedef struct waiting { float near; uint32_t node, parent, slot; } waiting; /* node: or QN_BVH_LEAF | what stands there; it is the parent's child in that slot */

/* What is needed of a node of the normal form, or of a term there. */
QN_INLINE void fetch_child(const walk *w, uint32_t child) {
  if (child & QN_BVH_LEAF) {
    const uint32_t line = qn_plain_line(w->scene, child & ~QN_BVH_LEAF);
    const void *next = line != UINT32_MAX ? (const void *)piece_in(w, line) : &w->normal->terms[child & ~QN_BVH_LEAF];
    QN_FETCH(next);
  } else {
    QN_FETCH(&w->normal->nodes[child]), QN_FETCH(w->normal->nodes[child].max), QN_FETCH(&w->normal->nodes[child].max[2]);
  }
}

/* Onto the stack, below those that are nearer, but for the first ones there. */
QN_INLINE void push_child(const walk *w, waiting child, waiting *stack, int first, int top, int fetch) {
  for (; top > first && stack[top - 1].near < child.near; top--) {
    stack[top] = stack[top - 1];
  }
  stack[top] = child;
  if (fetch) {
    fetch_child(w, child.node);
  }
}

/* Farthest first, so that the nearest is taken next. fetch: the nodes are the normal form's. */
QN_INLINE int push_children(const walk *w, const qn_bvh_node *nodes, uint32_t node, unsigned meets, const float near[8], waiting *stack, int top, int fetch) {
  for (const int first = top; meets; meets &= meets - 1) {
    const unsigned c = qn_trailing_zeros(meets);
    push_child(w, (waiting){near[c], nodes[node].child[c], node, c}, stack, first, top++, fetch);
  }
  return top;
}

/* Which of the root's children may be met, or of an entry's boxes, and where. */
enum { HEADS = QN_LANES_NOW == 64 ? QN_ENTRY_NODES : 1 };
typedef struct heads {
  const qn_entry *entry; /* null: the root */
  unsigned meets[HEADS];
  _Alignas(32) float near[HEADS][8];
} heads;

QN_INLINE const qn_entry *entry_of(const qn_packet *p) {
  return QN_LANES_NOW == 64 && (p->tile == QN_TILE_ORIGINS || p->tile == QN_TILE_DIRECTIONS) ? p->entry : NULL;
}

/* Returns 0 when nothing is met. root: a node, or QN_NO_ROOT. */
QN_INLINE int heads_meet(walk *w, const qn_bvh_node *nodes, uint32_t root, const qn_entry *entry, float start, float end, heads *h) {
  unsigned any = 0;
  h->entry = entry;
  if (QN_LANES_NOW == 64 && entry) {
    for (unsigned k = 0; k < entry->count; k++) {
      any |= h->meets[k] = node_meets(w, &entry->nodes[k], start, end, h->near[k]);
    }
    w->counts.nodes += entry->count;
  } else if (root != QN_NO_ROOT) {
    w->counts.nodes++;
    any = node_meets(w, &nodes[root], start, end, h->near[0]);
    h->meets[0] = any;
  } else {
    h->meets[0] = 0;
  }
  return any != 0;
}

/* The first of an empty stack. */
QN_INLINE int push_heads(const walk *w, const qn_bvh_node *nodes, uint32_t root, const heads *h, waiting *stack, int fetch) {
  if (QN_LANES_NOW == 64 && h->entry) {
    int top = 0;
    for (unsigned k = h->entry->count; k-- > 0;) {
      for (unsigned meets = h->meets[k]; meets;) { /* the last first: they lie in order of where all tiles of the entry meet them */
        const unsigned c = 63 - qn_leading_zeros(meets), at = 8 * k + c;
        meets &= ~(1u << c);
        push_child(w, (waiting){h->near[k][c], h->entry->nodes[k].child[c], h->entry->parent[at], h->entry->slot[at]}, stack, 0, top++, fetch);
      }
    }
    return top;
  }
  return push_children(w, nodes, root, h->meets[0], h->near[0], stack, 0, fetch);
}

#if QN_LANES_NOW == 64
/* The one child that is met, or QN_BVH_NONE where there are several. */
QN_INLINE uint32_t only_head(const qn_bvh_node *nodes, uint32_t root, const heads *h) {
  const qn_bvh_node *n = &nodes[root];
  unsigned meets = h->meets[0];
  for (unsigned k = 0; h->entry && k < h->entry->count; k++) {
    if (h->meets[k] && n != &nodes[root]) {
      return QN_BVH_NONE;
    }
    meets = h->meets[k] ? h->meets[k] : meets, n = h->meets[k] ? &h->entry->nodes[k] : n;
  }
  return (meets & (meets - 1)) != 0 ? QN_BVH_NONE : n->child[qn_trailing_zeros(meets)];
}
#endif

#endif
