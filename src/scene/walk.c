/* Walks over the hierarchy. Nothing that meets the line or the point may be passed by, whatever rounding does; to visit a box
   too many is no error. Derivation of the slack: docs/bounds.md, QN_BOX_SLACK.

   Legend: axis k of the line is o + t d. The line is inside the slab [min, max] for t between (min - o)/d and (max - o)/d (d > 0).
   t is measured in units of 1/scale, where scale is the power of two that brings the largest |d| into [1, 2). */
#include "base/bounds.h"
#include "scene/bvh.h"

#include <math.h>

typedef enum axis_kind {
  AXIS_SLAB,    /* |d| and |o| are in the range where nothing over- or underflows */
  AXIS_ACROSS,  /* d = 0: o itself decides */
  AXIS_SKIPPED  /* not in the range: no information */
} axis_kind;

typedef struct axis {
  axis_kind kind;
  int flip;          /* d < 0: the line meets max first */
  double o, inverse; /* 1/d */
  double slack;      /* of t, for the roundings of o */
  double low, high;  /* ACROSS: holds o */
} axis;

static axis axis_of(double o, double d) {
  axis a = {.kind = AXIS_SKIPPED, .o = o};
  double size = fabs(o);
  if (!(size < QN_BOX_LARGEST)) {
    return a;
  }
  if (d == 0) {
    a.kind = AXIS_ACROSS;
    a.low = o - 4 * QN_U * size - QN_BOX_TINY;
    a.high = o + 4 * QN_U * size + QN_BOX_TINY;
  } else if (fabs(d) > 1 / QN_BOX_LARGEST) {
    a.kind = AXIS_SLAB;
    a.flip = d < 0;
    a.inverse = 1 / d;
    a.slack = 2 * QN_U * size * fabs(a.inverse) + QN_BOX_TINY;
  }
  return a;
}

/* Which of four of the node's boxes, from the first on, may be met for t in [from, to] (widened already): a bit each. Four, so that all stays in registers.
   An axis without information leaves an infinity, which the slack does not change. */
QN_INLINE unsigned four_met(const qn_bvh_node *n, size_t first, const axis axes[3], double from, double to) {
  enum { FOUR = 4 };
  double near[FOUR], far[FOUR];
  unsigned met = (1u << FOUR) - 1;
  for (int i = 0; i < FOUR; i++) {
    near[i] = -INFINITY;
    far[i] = INFINITY;
  }
  for (int k = 0; k < 3; k++) {
    const axis *a = &axes[k];
    const float *min = n->min[k] + first, *max = n->max[k] + first;
    if (a->kind == AXIS_SLAB) {
      const float *begin = a->flip ? max : min, *end = a->flip ? min : max;
      for (int i = 0; i < FOUR; i++) {
        double enter = ((double)begin[i] - a->o) * a->inverse - a->slack;
        double leave = ((double)end[i] - a->o) * a->inverse + a->slack;
        near[i] = enter > near[i] ? enter : near[i];
        far[i] = leave < far[i] ? leave : far[i];
      }
    } else if (a->kind == AXIS_ACROSS) {
      for (int i = 0; i < FOUR; i++) {
        unsigned inside = ((double)min[i] <= a->high) & ((double)max[i] >= a->low);
        met &= ~((inside ^ 1u) << i);
      }
    }
  }
  for (int i = 0; i < FOUR; i++) {
    double enter = near[i] - QN_BOX_SLACK * fabs(near[i]), leave = far[i] + QN_BOX_SLACK * fabs(far[i]);
    unsigned hit = (enter <= leave) & (enter <= to) & (leave >= from);
    met &= ~((hit ^ 1u) << i);
  }
  return met;
}

_Static_assert(QN_BVH_WIDE == 8, "twice four");
static unsigned boxes_met(const qn_bvh_node *n, const axis axes[3], double from, double to) {
  return four_met(n, 0, axes, from, to) | four_met(n, 4, axes, from, to) << 4;
}

/* One level leaves at most 7 siblings behind. */
enum { STACK = (QN_BVH_WIDE - 1) * QN_BVH_DEPTH + 1 };

static size_t push_children(const qn_bvh *bvh, const qn_bvh_node *n, unsigned met, uint32_t *stack, size_t top,
                            void (*visit)(void *user, uint32_t leaf), void *user) {
  for (; met; met &= met - 1) {
    uint32_t child = n->child[qn_trailing_zeros(met)];
    if (child == QN_BVH_NONE) {
      continue;
    }
    if (child & QN_BVH_LEAF) {
      visit(user, bvh->items[child & ~QN_BVH_LEAF]);
    } else {
      stack[top++] = child;
    }
  }
  return top;
}

void qn_bvh_line(const qn_bvh *bvh, const double o[3], const double d[3], double from, double to,
                 void (*visit)(void *user, uint32_t leaf), void *user, uint64_t *nodes) {
  if (bvh->node_count == 0) {
    return;
  }
  double largest = fmax(fabs(d[0]), fmax(fabs(d[1]), fabs(d[2])));
  int e = 0;
  frexp(largest, &e);
  axis axes[3];
  for (int k = 0; k < 3; k++) {
    double scaled = ldexp(d[k], 1 - e);
    axes[k] = axis_of(o[k], scaled);
    if (scaled == 0 && d[k] != 0) {
      axes[k].kind = AXIS_SKIPPED; /* so small beside the largest that it vanished */
    }
  }
  from = ldexp(from, e - 1);
  to = ldexp(to, e - 1);
  from = isinf(from) ? from : from - QN_BOX_SLACK * fabs(from) - QN_BOX_TINY;
  to = isinf(to) ? to : to + QN_BOX_SLACK * fabs(to) + QN_BOX_TINY;
  uint32_t stack[STACK];
  size_t top = 0;
  stack[top++] = 0;
  uint64_t seen = 0;
  while (top) {
    const qn_bvh_node *n = &bvh->nodes[stack[--top]];
    seen++;
    top = push_children(bvh, n, boxes_met(n, axes, from, to), stack, top, visit, user);
  }
  *nodes += seen;
}

void qn_bvh_point(const qn_bvh *bvh, const double min[3], const double max[3], void (*visit)(void *user, uint32_t leaf),
                  void *user, uint64_t *nodes) {
  if (bvh->node_count == 0) {
    return;
  }
  uint32_t stack[STACK];
  size_t top = 0;
  stack[top++] = 0;
  uint64_t seen = 0;
  while (top) {
    const qn_bvh_node *n = &bvh->nodes[stack[--top]];
    seen++;
    unsigned met = (1u << QN_BVH_WIDE) - 1;
    for (int k = 0; k < 3; k++) {
      for (int i = 0; i < QN_BVH_WIDE; i++) {
        unsigned inside = ((double)n->min[k][i] <= max[k]) & ((double)n->max[k][i] >= min[k]);
        met &= ~((inside ^ 1u) << i);
      }
    }
    top = push_children(bvh, n, met, stack, top, visit, user);
  }
  *nodes += seen;
}
