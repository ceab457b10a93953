/* Planes: the half-space, and what the polyhedral primitives make theirs with.

   Support: a half-space has a finite one only in the direction of its normal. A direction that was rounded is that normal
   for certain only when both lie along one coordinate axis, whose zeros are exact. */
#include "shape/exact.h"
#include "shape/outward.h"
#include "shape/rows.h"

#include <string.h>

qn_half_form *qn_halves_new(qn_ctx *ctx, size_t n) {
  qn_half_form *halves = n > SIZE_MAX / sizeof *halves ? NULL : qn_arena_take(&ctx->arena, n * sizeof *halves);
  if (!halves) {
    ctx->failed = QUOIN_E_MEMORY;
    return NULL;
  }
  memset(halves, 0, n * sizeof *halves); /* all numbers QN_NUM_ZERO */
  return halves;
}

void qn_half_plane(qn_ctx *ctx, qn_half_form *out, uint32_t role, qn_num a, qn_num b, qn_num c, qn_num d) {
  out->kind = QN_PLANE;
  out->role = role;
  out->row[0][0] = a;
  out->row[0][1] = b;
  out->row[0][2] = c;
  out->row[0][3] = neg(ctx, d);
}

void qn_half_slab(qn_ctx *ctx, qn_half_form out[2], int axis, qn_num lo, qn_num hi) {
  for (int side = 0; side < 2; side++) {
    out[side].kind = QN_PLANE;
    out[side].role = QUOIN_FACE + (uint32_t)(2 * axis + side);
    out[side].row[0][axis] = side ? QN_NUM_ONE : neg(ctx, QN_NUM_ONE);
    out[side].row[0][3] = side ? neg(ctx, hi) : lo;
  }
}

qn_form_result qn_halfspace_form(qn_ctx *ctx, const qn_num *args, size_t n, const qn_placement *placement, qn_half_form **halves,
                                 size_t *count) {
  (void)n, (void)placement;
  *count = 0;
  if (qn_num_is_zero(args[0]) && qn_num_is_zero(args[1]) && qn_num_is_zero(args[2])) {
    return qn_num_sign(args[3]) >= 0 ? QN_FORM_ALL : QN_FORM_EMPTY; /* 0 <= d */
  }
  qn_half_form *h = qn_halves_new(ctx, 1);
  if (!h) {
    return QN_FORM_EMPTY;
  }
  qn_half_plane(ctx, h, QUOIN_FACE, args[0], args[1], args[2], args[3]);
  *halves = h;
  *count = 1;
  return QN_FORM_OK;
}

double qn_halfspace_support(const double *args, size_t n, const double placement[6], const double v[3]) {
  (void)n, (void)placement;
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    if (args[j] == 0 && args[k] == 0 && v[j] == 0 && v[k] == 0 && args[i] != 0 && (args[i] > 0) == (v[i] > 0) && v[i] != 0) {
      double at = args[3] / args[i];
      qn_terms t = {0, 0};
      qn_term(&t, at, v[i]);
      return fabs(at) < QN_SUPPORT_TINY && args[3] != 0 ? INFINITY : qn_outward(t, QN_SUPPORT_SLACK(8));
    }
  }
  return INFINITY;
}

/* Two lengths in the plane, unbounded: along the first of (n cross z, n cross x) that is not zero, and across it. */
void qn_halfspace_uv(const double *args, size_t n, const double placement[6], uint32_t role, const double x[3], double uv[2]) {
  (void)n, (void)placement, (void)role;
  double length = qn_norm3(args[0], args[1], args[2]);
  if (!(length > 0)) {
    uv[0] = uv[1] = 0;
    return;
  }
  double w[3] = {args[0] / length, args[1] / length, args[2] / length};
  double flat = qn_norm2(w[0], w[1]);
  double a[3] = {1, 0, 0};
  if (flat > 0) {
    a[0] = w[1] / flat;
    a[1] = -w[0] / flat;
  }
  double b[3] = {w[1] * a[2] - w[2] * a[1], w[2] * a[0] - w[0] * a[2], w[0] * a[1] - w[1] * a[0]};
  uv[0] = a[0] * x[0] + a[1] * x[1] + a[2] * x[2];
  uv[1] = b[0] * x[0] + b[1] * x[1] + b[2] * x[2];
}
