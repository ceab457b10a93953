/* A leaf's own coordinates in doubles, for (u, v) at a hit: the maps along its path composed and inverted, kept for the leaves
   hit last. Nothing decides by them. */
#include "query/work.h"

#include <math.h>
#include <string.h>

enum { FEWEST_LOCALS = 64, MOST_LOCALS = 4096 }; /* powers of two; 750 kB at most */

/* out = a after b. */
static void after(const double a[12], const double b[12], double out[12]) {
  double m[12];
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 4; j++) {
      m[4 * i + j] = a[4 * i] * b[j] + a[4 * i + 1] * b[4 + j] + a[4 * i + 2] * b[8 + j] + (j == 3 ? a[4 * i + 3] : 0);
    }
  }
  memcpy(out, m, sizeof m);
}

static int invert(const double m[12], double out[12]) {
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      int r0 = (j + 1) % 3, r1 = (j + 2) % 3, c0 = (i + 1) % 3, c1 = (i + 2) % 3;
      out[4 * i + j] = m[4 * r0 + c0] * m[4 * r1 + c1] - m[4 * r0 + c1] * m[4 * r1 + c0];
    }
  }
  double det = m[0] * out[0] + m[1] * out[4] + m[2] * out[8];
  if (!(fabs(det) > 0) || !isfinite(1 / det)) {
    return 0;
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      out[4 * i + j] /= det;
    }
    out[4 * i + 3] = -(out[4 * i] * m[3] + out[4 * i + 1] * m[7] + out[4 * i + 2] * m[11]);
  }
  return 1;
}

/* 0 when memory is refused; then the place holds no leaf. */
static int make(quoin_work *work, uint32_t leaf, qn_local *local) {
  const quoin_model *model = work->scene->model;
  const qn_node *node = &model->nodes[work->scene->leaves[leaf].node];
  qn_ctx *ctx = qn_scratch_ctx(work->scratch);
  qn_mark mark = qn_arena_mark(&ctx->arena);
  double map[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  for (uint32_t at = node->parent; at != QN_NO_NODE; at = model->nodes[at].parent) {
    uint8_t kind = model->nodes[at].kind;
    if (kind >= QN_NODE_TRANSLATE && kind <= QN_NODE_MULTMATRIX) {
      qn_num exact[12];
      double one[12];
      qn_solid_map(ctx, model, at, exact);
      for (int i = 0; i < 12; i++) {
        one[i] = qn_num_to_double(exact[i]);
      }
      after(one, map, map);
    }
  }
  qn_arena_release(&ctx->arena, mark);
  *local = (qn_local){.leaf = 0, .args = local->args, .arg_capacity = local->arg_capacity};
  local->singular = !invert(map, local->inverse);
  local->placed = (node->flags & QN_NODE_PLACED) != 0;
  size_t args = node->numbers - (local->placed ? 6u : 0u);
  for (size_t i = 0; local->placed && i < 6; i++) {
    local->placement[i] = qn_num_to_double(model->numbers[node->number0 + args + i]);
  }
  local->arg_count = args;
  if (!qn_grow(work->mem, &local->args, &local->arg_capacity, args)) {
    return 0;
  }
  for (size_t i = 0; i < local->arg_count; i++) {
    local->args[i] = qn_num_to_double(model->numbers[node->number0 + i]);
  }
  local->leaf = leaf + 1;
  return 1;
}

const qn_local *qn_query_local(quoin_work *work, uint32_t leaf) {
  if (!work->locals) {
    size_t count = FEWEST_LOCALS;
    while (count < work->scene->leaf_count && count < MOST_LOCALS) {
      count *= 2;
    }
    work->locals = qn_alloc_zeroed(work->mem, count * sizeof *work->locals);
    if (!work->locals) {
      return NULL;
    }
    work->local_count = count;
  }
  qn_local *local = &work->locals[leaf & (work->local_count - 1)];
  return local->leaf == leaf + 1 || make(work, leaf, local) ? local : NULL;
}

void qn_query_locals_free(quoin_work *work) {
  for (size_t i = 0; i < work->local_count; i++) {
    qn_free(work->mem, work->locals[i].args, work->locals[i].arg_capacity * sizeof *work->locals[i].args);
  }
  qn_free(work->mem, work->locals, work->local_count * sizeof *work->locals);
}
