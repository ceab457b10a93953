/* A walk along a line of parameters: marks at roots, in exact order, and a rational in each gap between two of them.
   Before the first and after the last whoever walks takes the limit: a rational just beyond a root would be as near to it as it
   likes, and with surfaces of design S2 nearer than they tell apart. */
#include "ray/around_cells.h"

#include <string.h>

/* Ties of rounded roots (design S2) are not transitive: the stored numbers put them in an order that is. */
static int root_order(qn_ctx *ctx, qn_root x, qn_root y) {
  const int order = qn_root_cmp(ctx, x, y);
  return order || !(qn_root_rounded(x) || qn_root_rounded(y)) ? order : qn_root_cmp_stored(ctx, x, y);
}

void qn_walk_sort(qn_cells *cells, size_t n, qn_walk_mark *marks) {
  qn_ctx *ctx = cells->ctx;
  qn_walk_mark *other = qn_arena_take(&ctx->arena, (n + 1) * sizeof *other);
  if (!other) {
    ctx->failed = QUOIN_E_MEMORY;
    return;
  }
  qn_mark memory = qn_arena_mark(&ctx->arena);
  for (size_t width = 1; width < n && qn_cells_spend(cells, n, QN_WORK_ROOT); width *= 2) {
    for (size_t begin = 0; begin + width < n; begin += 2 * width) {
      size_t middle = begin + width, end = middle + width < n ? middle + width : n, left = width, i = 0, j = middle, k = begin;
      memcpy(other, marks + begin, left * sizeof *marks);
      while (i < left && j < end) {
        marks[k++] = root_order(ctx, other[i].root, marks[j].root) <= 0 ? other[i++] : marks[j++];
      }
      memcpy(marks + k, other + i, (left - i) * sizeof *marks);
    }
    qn_arena_release(&ctx->arena, memory);
  }
}

size_t qn_walk_group(qn_ctx *ctx, size_t n, const qn_walk_mark *marks, size_t first) {
  size_t end = first + 1;
  while (end < n && qn_root_cmp(ctx, marks[end - 1].root, marks[end].root) == 0) {
    end++;
  }
  return end;
}

void qn_walk_between(qn_ctx *ctx, const qn_walk_mark *marks, size_t at, qn_int *num, qn_int *den) {
  qn_root_between(ctx, marks[at - 1].root, marks[at].root, num, den);
}
