/* The commonest leaf of large models, a sphere that is only shifted, with a centre and a radius that are plain decimals: its shadow and
   box by machine words. What is made is what the long way makes, but for the box, which is tight here whatever the numbers' length.

   Legend: t the centre, p its nearest double, the pivot; a row is X_i = y_i + (p_i - t_i), y = x - p; k = -r^2; the box is t - r
   to t + r, rounded outward. */
#include "scene/compile.h"

#include "number/dd.h"
#include "shape/prim.h"

#include <math.h>

/* Sizes for which nothing on the way leaves the range of doubles, and the long way would take its box in doubles too. */
static int usual_size(double v) {
  return v == 0 || (fabs(v) < 0x1p300 && fabs(v) > 0x1p-300);
}

int qn_leaf_quick(qn_maker *m, uint32_t node, qn_leaf *leaf, qn_form_result *result, quoin_status *status) {
  const qn_node *n = &m->model->nodes[node];
  const qn_composed *map = &m->maps.stack[m->maps.count - 1];
  if (n->payload != QN_SPHERE || (n->flags & QN_NODE_PLACED) || !map->shift_only || !map->has_exact) {
    return 0;
  }
  qn_num r = m->model->numbers[n->number0];
  qn_quadric_shadow q = {.s = {1, 1, 1}};
  double size, rest_of_size, square;
  if (r.kind != QN_NUM_SMALL || r.u.m <= 0 || !qn_num_quick_pair(r, &size, &rest_of_size) || !usual_size(size) || !qn_num_quick_square(r, &square)) {
    return 0;
  }
  q.k = -square;
  const qn_dd exact = qn_dd_two_prod(size, size); /* r^2 = (size + rest)^2; the two nearest doubles differ exactly */
  q.k_rest = -((exact.hi - square) + (exact.lo + 2 * size * rest_of_size));
  for (int i = 0; i < 3; i++) {
    qn_num t = map->exact[4 * i + 3];
    double rest;
    if (!qn_num_quick_pair(t, &leaf->pivot[i], &rest) || !usual_size(leaf->pivot[i]) ||
        !qn_num_quick_span(t, r, &leaf->min[i], &leaf->max[i])) {
      return 0;
    }
    q.row[i][i] = 1;
    q.row[i][3] = 0 - rest; /* not -0 */
  }
  *status = QUOIN_E_MEMORY;
  qn_batch *b = m->batch;
  if (qn_batch_room(m) && qn_grow(m->mem, &b->quadrics, &b->quadric_capacity, b->quadric_count + 1)) {
    leaf->half0 = (uint32_t)b->half_count;
    leaf->halves = 1;
    leaf->bounded = leaf->convex = 1;
    b->keys[b->half_count] = 0;
    b->halves[b->half_count++] = (qn_half){.shadow = (uint32_t)b->quadric_count, .role = QUOIN_BODY, .kind = QN_QUADRIC_BODY};
    b->quadrics[b->quadric_count++] = q;
    *result = QN_FORM_OK;
    *status = QUOIN_OK;
  }
  return 1;
}
