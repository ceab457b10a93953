/* Saddle: z <= x^2/a^2 - y^2/b^2, times a^2 b^2:  -b^2 x^2 + a^2 y^2 + a^2 b^2 z <= 0. Unbounded: no support; (u, v) are x/a and
   y/b. */
#include "shape/exact.h"
#include "shape/rows.h"

#include <math.h>

qn_form_result qn_saddle_form(qn_ctx *ctx, const qn_num *args, size_t n, const qn_placement *placement, qn_half_form **halves,
                              size_t *count) {
  (void)n, (void)placement;
  *count = 0;
  if (qn_num_is_zero(args[0]) || qn_num_is_zero(args[1])) {
    return QN_FORM_EMPTY;
  }
  qn_half_form *h = qn_halves_new(ctx, 1);
  if (!h) {
    return QN_FORM_EMPTY;
  }
  qn_num a2 = square(ctx, args[0]), b2 = square(ctx, args[1]);
  h->kind = QN_QUADRIC_BODY;
  h->role = QUOIN_BODY;
  h->row[0][0] = h->row[1][1] = h->row[2][2] = QN_NUM_ONE;
  h->s[0] = neg(ctx, b2);
  h->s[1] = a2;
  h->l = half(ctx, mul(ctx, a2, b2));
  *halves = h;
  *count = 1;
  return QN_FORM_OK;
}

double qn_saddle_support(const double *args, size_t n, const double placement[6], const double v[3]) {
  (void)args, (void)n, (void)placement, (void)v;
  return INFINITY;
}

void qn_saddle_uv(const double *args, size_t n, const double placement[6], uint32_t role, const double x[3], double uv[2]) {
  (void)n, (void)placement, (void)role;
  uv[0] = x[0] / args[0];
  uv[1] = x[1] / args[1];
}
