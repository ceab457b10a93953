/* The wedge: the half x/sx + z/sz <= 1 of the box [0, size], or of the box about the origin.

   Five planes: face 0 is x = lo, face 1 the slanted one (it stands for the box's +x), 2 and 3 are -y and +y, 4 is z = lo. The
   slanted
   one is sz x + sx z <= sx sz, or <= 0 when centred: the middle of the box lies on it.
   Support: that of y plus the greatest over the triangle's three corners. */
#include "shape/exact.h"
#include "shape/outward.h"
#include "shape/rows.h"

qn_form_result qn_wedge_form(qn_ctx *ctx, const qn_num *args, size_t n, const qn_placement *placement, qn_half_form **halves,
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
  qn_half_plane(ctx, h + 1, QUOIN_FACE + 1, args[2], QN_NUM_ZERO, args[0], center ? QN_NUM_ZERO : mul(ctx, args[0], args[2]));
  *halves = h;
  *count = 5; /* without +z */
  return QN_FORM_OK;
}

double qn_wedge_support(const double *args, size_t n, const double placement[6], const double v[3]) {
  (void)n, (void)placement;
  int center = args[3] != 0;
  double best = -INFINITY, largest = 0;
  for (int corner = 0; corner < 3; corner++) { /* (lo, lo), (hi, lo), (lo, hi) in x, z */
    qn_terms t = {0, 0};
    double x = corner == 1 ? 1 : 0, z = corner == 2 ? 1 : 0, y = v[1] > 0 ? 1 : 0, low = center ? 0.5 : 0;
    qn_term(&t, (x - low) * args[0], v[0]);
    qn_term(&t, (y - low) * args[1], v[1]);
    qn_term(&t, (z - low) * args[2], v[2]);
    best = t.sum > best ? t.sum : best;
    largest = t.magnitude > largest ? t.magnitude : largest;
  }
  return qn_outward((qn_terms){best, largest}, QN_SUPPORT_SLACK(8));
}

void qn_wedge_uv(const double *args, size_t n, const double placement[6], uint32_t role, const double x[3], double uv[2]) {
  (void)n, (void)placement;
  uint32_t face = role - QUOIN_FACE, a = face < 2 ? 1 : 0, b = face < 4 ? 2 : 1;
  double shift = args[3] != 0 ? 0.5 : 0;
  uv[0] = qn_clamp01(x[a] / args[a] + shift);
  uv[1] = qn_clamp01(x[b] / args[b] + shift);
}
