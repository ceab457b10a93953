/* A face of a convex polyhedron: its plane, on which side of it a point lies, and the order of its corners.

   Legend: points p, q, ...; a plane is n.x <= d. u = 2^-53. Sides are asked of doubles first (QN_POLYHEDRON_SIDE): of n planes and n points
   only the few that are on a plane, or nearly, are asked exactly. */
#include "model/polyhedron.h"

#include "base/bounds.h"

#include <math.h>

qn_num qn_polyhedron_cross(qn_ctx *ctx, const qn_num *a, const qn_num *b, size_t i) {
  size_t j = (i + 1) % 3, k = (i + 2) % 3;
  qn_num x[2] = {a[j], a[k]}, y[2] = {b[k], qn_num_neg(ctx, b[j])};
  return qn_num_dot(ctx, 2, x, y);
}

int qn_polyhedron_plane(qn_ctx *ctx, const qn_num *points, const uint32_t *corners, size_t count, qn_num plane[4]) {
  const qn_num *origin = points + (size_t)3 * corners[0];
  qn_num n[3] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO};
  qn_num a[3], b[3];
  qn_ctx_spend(ctx, count, QN_EFFORT_CORNER);
  for (size_t i = 0; i + 1 < count && !ctx->failed; i++) { /* relative to the first point: smaller numbers, and its own terms are zero */
    const qn_num *p = points + (size_t)3 * corners[i], *q = points + (size_t)3 * corners[i + 1];
    for (size_t k = 0; k < 3; k++) {
      a[k] = qn_num_sub(ctx, p[k], origin[k]);
      b[k] = qn_num_sub(ctx, q[k], origin[k]);
    }
    for (size_t k = 0; k < 3; k++) {
      n[k] = qn_num_sub(ctx, n[k], qn_polyhedron_cross(ctx, a, b, k));
    }
  }
  size_t lead = 0;
  while (lead < 3 && qn_num_is_zero(n[lead])) {
    lead++;
  }
  if (lead == 3) {
    return 0;
  }
  qn_num by = qn_num_abs(ctx, n[lead]);
  for (size_t k = 0; k < 3; k++) {
    plane[k] = qn_num_div(ctx, n[k], by);
  }
  plane[3] = qn_num_dot(ctx, 3, plane, origin);
  return 1;
}

/* --- sides ---------------------------------------------------------------------------------------------------------- */

void qn_polyhedron_shadow(size_t n, const qn_num *a, double *out) {
  int tame = 1;
  for (size_t i = 0; i < n; i++) {
    double size = fabs(out[i] = qn_num_to_double(a[i]));
    tame &= qn_num_is_zero(a[i]) || (size <= QN_POLYHEDRON_LARGEST && size >= 1 / QN_POLYHEDRON_LARGEST);
  }
  out[0] = tame ? out[0] : (double)NAN;
}

int qn_polyhedron_quick(const double plane[4], const double p[3]) {
  double x = plane[0] * p[0], y = plane[1] * p[1], z = plane[2] * p[2], s = x + y + z - plane[3];
  double e = QN_POLYHEDRON_SIDE * (fabs(x) + fabs(y) + fabs(z) + fabs(plane[3]));
  return (s > e) - (s < -e);
}

int qn_polyhedron_may_be(const double a[4], const double b[4]) {
  int may = 3;
  for (size_t k = 0; k < 4; k++) {
    double e = QN_POLYHEDRON_SIDE * (fabs(a[k]) + fabs(b[k]));
    may &= ~((fabs(a[k] - b[k]) > e) | (fabs(a[k] + b[k]) > e) << 1);
  }
  return may;
}

int qn_polyhedron_side(qn_ctx *ctx, const qn_num plane[4], const double near[4], const qn_num p[3], const double near_p[3]) {
  int sign = qn_polyhedron_quick(near, near_p);
  if (sign == 0) {
    qn_ctx_spend(ctx, 1, QN_EFFORT_SIDE);
    qn_mark mark = qn_arena_mark(&ctx->arena);
    qn_num x[4] = {plane[0], plane[1], plane[2], plane[3]}, y[4] = {p[0], p[1], p[2], qn_num_from_int(ctx, -1)};
    sign = qn_num_sign(qn_num_dot(ctx, 4, x, y));
    qn_arena_release(&ctx->arena, mark);
  }
  return sign;
}

/* --- order ---------------------------------------------------------------------------------------------------------- */

/* Heap sort, as qsort takes no context. */
void qn_polyhedron_sort(uint32_t *items, size_t n, int (*order)(void *user, uint32_t i, uint32_t j), void *user) {
  for (size_t start = n / 2, end = n; end > 1;) {
    if (start > 0) {
      start--;
    } else {
      end--;
      uint32_t swap = items[0];
      items[0] = items[end];
      items[end] = swap;
    }
    for (size_t at = start, child; (child = 2 * at + 1) < end; at = child) {
      child += child + 1 < end && order(user, items[child], items[child + 1]) < 0;
      if (order(user, items[at], items[child]) >= 0) {
        break;
      }
      uint32_t swap = items[at];
      items[at] = items[child];
      items[child] = swap;
    }
  }
}

/* The face seen along axis k, where its normal has a component: (u, v) = the other two axes in turn. Corners are compared along u, then v. */
typedef struct view {
  qn_ctx *ctx;
  const qn_num *vertices;
  size_t u, v;
} view;

static int along(void *user, uint32_t i, uint32_t j) {
  const view *w = user;
  const qn_num *p = w->vertices + (size_t)3 * i, *q = w->vertices + (size_t)3 * j;
  int c = qn_num_cmp(w->ctx, p[w->u], q[w->u]);
  c = c ? c : qn_num_cmp(w->ctx, p[w->v], q[w->v]);
  return c ? c : (i > j) - (i < j);
}

/* The sign of (b - a) x (c - a) in the view. */
static int turn_of(const view *w, uint32_t a, uint32_t b, uint32_t c) {
  const qn_num *o = w->vertices + (size_t)3 * a, *p = w->vertices + (size_t)3 * b, *q = w->vertices + (size_t)3 * c;
  qn_mark mark = qn_arena_mark(&w->ctx->arena);
  qn_num x[2] = {qn_num_sub(w->ctx, p[w->u], o[w->u]), qn_num_sub(w->ctx, o[w->v], p[w->v])};
  qn_num y[2] = {qn_num_sub(w->ctx, q[w->v], o[w->v]), qn_num_sub(w->ctx, q[w->u], o[w->u])};
  int sign = qn_num_sign(qn_num_dot(w->ctx, 2, x, y));
  qn_arena_release(&w->ctx->arena, mark);
  return sign;
}

/* Corners of a convex polygon, sorted along u, lie on one of two chains from the first to the last: left of the line between them (upper) or right.
   Clockwise in the view is up along the upper and back along the lower; from outside too, where the normal looks at the viewer, else the other way round. */
void qn_polyhedron_turn(qn_ctx *ctx, const qn_num plane[4], const qn_num *vertices, uint32_t *corners, size_t count) {
  size_t k = 0;
  while (k < 2 && qn_num_is_zero(plane[k])) {
    k++;
  }
  view w = {ctx, vertices, (k + 1) % 3, (k + 2) % 3};
  uint32_t *sorted = qn_arena_take(&ctx->arena, count * sizeof *sorted), first = corners[0];
  if (!sorted) {
    ctx->failed = QUOIN_E_MEMORY;
  }
  if (ctx->failed || count < 3 || !qn_ctx_spend(ctx, count, QN_EFFORT_CORNER)) {
    return;
  }
  for (size_t i = 0; i < count; i++) {
    sorted[i] = corners[i];
  }
  qn_polyhedron_sort(sorted, count, along, &w);
  int faces_viewer = qn_num_sign(plane[k]) > 0;
  size_t up = 0, down = count; /* corners[0, up) goes there, corners[down, count) comes back */
  for (size_t i = 0; i < count; i++) {
    int side = i == 0 || i + 1 == count ? 1 : turn_of(&w, sorted[0], sorted[count - 1], sorted[i]) * (faces_viewer ? 1 : -1);
    if (side >= 0) {
      corners[up++] = sorted[i];
    } else {
      corners[--down] = sorted[i];
    }
  }
  /* the lowest first */
  size_t at = 0;
  while (corners[at] != first) {
    at++;
  }
  for (size_t i = 0; i < count; i++) {
    sorted[i] = corners[(at + i) % count];
  }
  for (size_t i = 0; i < count; i++) {
    corners[i] = sorted[i];
  }
}

size_t qn_polyhedron_face(qn_ctx *ctx, const qn_num plane[4], const qn_num *vertices, double (*near)[3], size_t m, uint32_t *corners) {
  double near_plane[4];
  size_t count = 0;
  qn_polyhedron_shadow(4, plane, near_plane);
  for (size_t i = 0; i < m; i++) {
    if (qn_polyhedron_side(ctx, plane, near_plane, vertices + 3 * i, near[i]) == 0) {
      corners[count++] = (uint32_t)i;
    }
  }
  if (count >= 3) {
    qn_polyhedron_turn(ctx, plane, vertices, corners, count);
  }
  return count;
}
