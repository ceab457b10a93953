/* Points in batches: where each lies, as far as doubles can certify it. A point that they cannot certify is answered by the exact
   path (src/query/side.c). Nothing that is certified depends on the instruction set. */
#ifndef QN_WIDE_POINTS_H
#define QN_WIDE_POINTS_H

#include "scene/cells.h"
#include "wide/packet.h"

enum {
  QN_POINTS = 256,       /* points in a batch, at most */
  QN_POINT_ROOM = 1 << 15 /* entries of a walk; a walk that would need more gives its points up */
};

/* A point in doubles: each true coordinate is within u weight of x, and weight is at most the largest |x_i| or DBL_MIN. */
typedef struct qn_wide_point { const double *x; double weight; } qn_wide_point;

/* A qn_points_fn (wide/packet.h) takes n <= QN_POINTS points, xyz after xyz, and their weights (null: all 0), and fills verdict[0 .. n-1]; of points
   beyond QN_WIDE_LARGEST, or that are none, nothing is sure. The scene's normal form is made. Where a point is, in the order in which a union takes the largest and a meet the least. */
enum { QN_SURELY_OUT, QN_NOT_SURE, QN_SURELY_IN };

/* A thread's memory for a batch. */
typedef struct qn_point_walk {
  _Alignas(64) float box[QN_POINTS][8]; /* the floats about each point: min xyz, any, max xyz, any */
  const qn_cells *cells;                /* in: of the scene, or null: then all is asked of the hierarchies */
  uint32_t query[QN_POINT_ROOM], node[QN_POINT_ROOM];
} qn_point_walk;

#endif
