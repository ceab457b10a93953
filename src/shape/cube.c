/* The box [0, size] or [-size/2, size/2]: six planes, faces 0 to 5 for -x, +x, -y, +y, -z, +z.

   Support: the sum over the axes of max(v_i lo_i, v_i hi_i). (u, v): the other two coordinates as shares of the size. */
#include "shape/outward.h"
#include "shape/exact.h"
#include "shape/rows.h"

qn_form_result qn_cube_form(qn_ctx *ctx, const qn_num *args, size_t n, const qn_placement *placement, qn_half_form **halves,
                            size_t *count) {
  (void)n, (void)placement;
  *count = 0;
  if (!positive(args[0]) || !positive(args[1]) || !positive(args[2])) {
    return QN_FORM_EMPTY;
  }
  qn_half_form *h = qn_halves_new(ctx, 6);
  if (!h) {
    return QN_FORM_EMPTY;
  }
  int center = !qn_num_is_zero(args[3]);
  for (int i = 0; i < 3; i++) {
    qn_num hi = center ? half(ctx, args[i]) : args[i];
    qn_half_slab(ctx, h + 2 * i, i, center ? neg(ctx, hi) : QN_NUM_ZERO, hi);
  }
  *halves = h;
  *count = 6;
  return QN_FORM_OK;
}

double qn_cube_support(const double *args, size_t n, const double placement[6], const double v[3]) {
  (void)n, (void)placement;
  qn_terms t = {0, 0};
  for (int i = 0; i < 3; i++) {
    if (args[3] != 0) {
      qn_term(&t, 0.5 * args[i], fabs(v[i]));
    } else if (v[i] > 0) {
      qn_term(&t, args[i], v[i]);
    }
  }
  return qn_outward(t, QN_SUPPORT_SLACK(8));
}

void qn_cube_uv(const double *args, size_t n, const double placement[6], uint32_t role, const double x[3], double uv[2]) {
  (void)n, (void)placement;
  uint32_t axis = (role - QUOIN_FACE) / 2 % 3, a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
  double shift = args[3] != 0 ? 0.5 : 0;
  uv[0] = qn_clamp01(x[a] / args[a] + shift);
  uv[1] = qn_clamp01(x[b] / args[b] + shift);
}
