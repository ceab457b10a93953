/* The hierarchy of boxes over the bounded leaves, and the walks over it. */
#ifndef QN_SCENE_BVH_H
#define QN_SCENE_BVH_H

#include "base/mem.h"

#include <math.h>

/* Boxes in single precision, rounded outward from the leaves' boxes. Wide nodes, children's boxes side by side. */
enum { QN_BVH_WIDE = 8 };
typedef struct qn_bvh_node {
  _Alignas(64) float min[3][QN_BVH_WIDE], max[3][QN_BVH_WIDE];
  uint32_t child[QN_BVH_WIDE]; /* a node, or QN_BVH_LEAF | index in items; empty slots have min > max */
} qn_bvh_node;
#define QN_BVH_LEAF 0x80000000u
#define QN_BVH_NONE UINT32_MAX /* the child of an empty slot */
enum { QN_BVH_DEPTH = 40 };    /* no node is deeper: a walk's stack has a fixed size */

typedef struct qn_bvh {
  qn_bvh_node *nodes;
  size_t node_count;
  uint32_t *items; /* leaf numbers */
  size_t item_count;
} qn_bvh;

/* A box to be sorted in; the last lanes: the lower and the upper 16 bits of the leaf's number, as numbers: bits in their place would be
   denormal floats, which are slow. */
typedef struct qn_bvh_item { _Alignas(16) float min[4], max[4]; } qn_bvh_item;

/* Single precision, not above and not below. */
QN_INLINE float qn_round_down(double v) {
  float f = (float)v;
  return (double)f > v ? nextafterf(f, -INFINITY) : f;
}
QN_INLINE float qn_round_up(double v) {
  float f = (float)v;
  return (double)f < v ? nextafterf(f, INFINITY) : f;
}

QN_INLINE void qn_bvh_item_make(qn_bvh_item *item, const double min[3], const double max[3], uint32_t number) {
  for (int k = 0; k < 3; k++) {
    item->min[k] = qn_round_down(min[k]);
    item->max[k] = qn_round_up(max[k]);
  }
  item->min[3] = (float)(number & 0xffff);
  item->max[3] = (float)(number >> 16);
}

/* Builds over items from qn_alloc_line, which it reorders; surface area heuristic in bins, n log n, on up to `threads` threads, the
   same tree for every number of threads. */
QN_NODISCARD quoin_status qn_bvh_build_items(qn_bvh *bvh, qn_mem *mem, size_t n, qn_bvh_item *items, unsigned threads);

/* Builds over n boxes (six doubles each: min xyz, max xyz) numbered 0 .. n-1 by `numbers`. */
QN_NODISCARD quoin_status qn_bvh_build(qn_bvh *bvh, qn_mem *mem, size_t n, const double (*boxes)[6], const uint32_t *numbers,
                                        unsigned threads);
void qn_bvh_free(qn_bvh *bvh, qn_mem *mem);

/* Calls visit for each leaf whose box the line o + t d, t in [from, to], may meet: every leaf it does meet, and few
   others. Conservative in spite of rounding (docs/bounds.md, QN_BOX_SLACK), also of the line: each of o and d may have been
   rounded to nearest (barring over- and underflow: 0 stands for 0), and so may from and to. Adds the nodes visited to *nodes. */
void qn_bvh_line(const qn_bvh *bvh, const double o[3], const double d[3], double from, double to,
                 void (*visit)(void *user, uint32_t leaf), void *user, uint64_t *nodes);
/* The same for the point whose coordinates lie in [min, max] (an enclosure of it). */
void qn_bvh_point(const qn_bvh *bvh, const double min[3], const double max[3], void (*visit)(void *user, uint32_t leaf),
                  void *user, uint64_t *nodes);

#endif
