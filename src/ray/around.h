/* What is next to a point that lies on surfaces: which combinations of their sides are realisable there (design S6), and
   what the program says of each. Serves points and the stretches of a line that run in surfaces (S7). */
#ifndef QN_RAY_AROUND_H
#define QN_RAY_AROUND_H

#include "ray/weave.h"

/* A point with exact coordinates x/w, w > 0. */
typedef struct qn_point { qn_int x[3], w; } qn_point;

/* One leaf next to the point: its half-spaces that vanish there are decided by the sides of their surfaces; `others` tells
   whether the rest all hold (then the leaf is inside where its vanishing half-spaces are). Leaves with a half-space that
   fails at the point are not listed. A leaf with no vanishing half-space is listed and is inside. */
typedef struct qn_near_leaf { uint32_t leaf; uint32_t first, count; } qn_near_leaf; /* into near_halves: indices of scene->halves that vanish */

/* The side of a point, given the leaves that hold it (closed) and their half-spaces that vanish there. The program is left
   at rest. Distinct surfaces that vanish are combined as first-order tangent cones allow; at parallel gradients by second-order
   forms; where neither suffices QUOIN_BOUNDARY.
   QN_AROUND_LINE: all surfaces that vanish hold the scratch's line, which has been made exact, and the point is none of its turns. QN_AROUND_HELD: the scratch's program already holds the leaves that have no half-space vanishing there,
   they are not listed, and it is left as it was. */
enum { QN_AROUND_POINT, QN_AROUND_LINE, QN_AROUND_HELD };
quoin_status qn_around(const quoin_scene *scene, qn_scratch *scratch, const qn_point *point, const qn_near_leaf *leaves, size_t leaf_count,
                       const uint32_t *near_halves, size_t near_count, int how, quoin_side *out);

/* The sign of a surface's form at an exact point, S2's rule applied, and its gradient there (a common positive multiple). */
int qn_surface_sign_at(qn_ctx *ctx, const qn_exact_surface *surface, const qn_point *point);
void qn_surface_gradient_at(qn_ctx *ctx, const qn_exact_surface *surface, const qn_point *point, qn_xint g[3]);

#endif
