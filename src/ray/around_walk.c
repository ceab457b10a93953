/* A walk along a line of parameters: marks at roots, in exact order, and a rational in each gap between two of them.
   Before the first and after the last whoever walks takes the limit: a rational just beyond a root would be as near to it as it
   likes, and with surfaces of design S2 nearer than they tell apart. */
#include "ray/around_cells.h"

#include <string.h>

void qn_walk_sort(qn_ctx *ctx, size_t n, qn_walk_mark *marks) {
  for (size_t i = 1; i < n && ctx->failed == QUOIN_OK; i++) {
    qn_walk_mark mark = marks[i];
    size_t low = 0, high = i;
    while (low < high) {
      size_t middle = low + (high - low) / 2;
      if (qn_root_cmp(ctx, marks[middle].root, mark.root) <= 0) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    memmove(marks + low + 1, marks + low, (i - low) * sizeof *marks);
    marks[low] = mark;
  }
}

size_t qn_walk_group(qn_ctx *ctx, size_t n, const qn_walk_mark *marks, size_t first) {
  size_t end = first + 1;
  while (end < n && qn_root_cmp(ctx, marks[first].root, marks[end].root) == 0) {
    end++;
  }
  return end;
}

void qn_walk_between(qn_ctx *ctx, const qn_walk_mark *marks, size_t at, qn_int *num, qn_int *den) {
  qn_root_between(ctx, marks[at - 1].root, marks[at].root, num, den);
}
