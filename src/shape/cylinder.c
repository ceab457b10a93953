/* Cylinder, elliptic cylinder, cone, frustum: h, a1, b1 at the bottom, a2, b2 at the top, center.

   With A, B the larger pair of semi-axes and a1 b2 = a2 b1, the semi-axes at height z (from the bottom) are a(z) and a(z) B / A
   with
   h a(z) = a1 h - (a1 - a2) z. The body:
       a1 = a2:  B^2 x^2 + A^2 y^2 - A^2 B^2          (A = B: x^2 + y^2 - A^2)
       else:     B^2 h^2 x^2 + A^2 h^2 y^2 - B^2 Z^2,  Z = (a1 - a2) z - a1 h   (A = B: h^2 x^2 + h^2 y^2 - Z^2)
   both nappes; the caps keep one. An apex's cap z = h or z = 0 stays: it cuts the other nappe off.
   Support: the hull of the two end discs. (u, v): the angle; height on the body, the share of the radius on a cap. */
#include "shape/outward.h"
#include "shape/round.h"
#include "shape/rows.h"

qn_form_result qn_cylinder_form(qn_ctx *ctx, const qn_num *args, size_t n, const qn_placement *placement, qn_half_form **halves,
                                size_t *count) {
  (void)n;
  *count = 0;
  qn_num h = args[0], a1 = args[1], b1 = args[2], a2 = args[3], b2 = args[4];
  int bottom = qn_num_cmp(ctx, a1, a2) >= 0;
  qn_num A = bottom ? a1 : a2, B = bottom ? b1 : b2;
  if (!positive(h) || !positive(A) || !positive(B) || qn_num_sign(a1) < 0 || qn_num_sign(b1) < 0 || qn_num_sign(a2) < 0 ||
      qn_num_sign(b2) < 0) {
    return QN_FORM_EMPTY;
  }
  qn_frame frame;
  if (!qn_frame_make(ctx, placement, &frame)) {
    return QN_FORM_EMPTY;
  }
  qn_half_form *out = qn_halves_new(ctx, 3);
  if (!out) {
    return QN_FORM_EMPTY;
  }
  int center = !qn_num_is_zero(args[5]), round = equal(ctx, A, B);
  qn_num lo = center ? neg(ctx, half(ctx, h)) : QN_NUM_ZERO, hi = center ? half(ctx, h) : h;
  qn_num A2 = square(ctx, A), B2 = square(ctx, B);
  qn_round_body body = {.p = QN_NUM_ONE};
  if (equal(ctx, a1, a2)) {
    body.a = round ? QN_NUM_ONE : B2;
    body.b = round ? QN_NUM_ONE : A2;
    body.k = neg(ctx, round ? A2 : mul(ctx, A2, B2));
  } else {
    qn_num h2 = square(ctx, h);
    body.a = round ? h2 : mul(ctx, B2, h2);
    body.b = round ? h2 : mul(ctx, A2, h2);
    body.c = neg(ctx, round ? QN_NUM_ONE : B2);
    body.p = sub(ctx, a1, a2);
    /* -(a1 - a2) lo - a1 h: centred, -h (a1 + a2) / 2 */
    body.q = neg(ctx, center ? half(ctx, mul(ctx, h, add(ctx, a1, a2))) : mul(ctx, a1, h));
  }
  qn_frame_body(ctx, &frame, &body, out);
  qn_frame_cap(ctx, &frame, QUOIN_CAP0, -1, lo, out + 1);
  qn_frame_cap(ctx, &frame, QUOIN_CAP1, 1, hi, out + 2);
  *halves = out;
  *count = 3;
  return QN_FORM_OK;
}

double qn_cylinder_support(const double *args, size_t n, const double placement[6], const double v[3]) {
  (void)n;
  double h = args[0], lo = args[5] != 0 ? -0.5 * h : 0, hi = args[5] != 0 ? 0.5 * h : h;
  return qn_frame_two_discs(placement, v, lo, args[1], args[2], hi, args[3], args[4],
                            h + qn_norm2(args[1], args[2]) + qn_norm2(args[3], args[4]));
}

void qn_cylinder_uv(const double *args, size_t n, const double placement[6], uint32_t role, const double x[3], double uv[2]) {
  (void)n;
  double d[3], A = args[1] > args[3] ? args[1] : args[3], B = args[1] > args[3] ? args[2] : args[4];
  qn_frame_point(placement, x, d);
  uv[0] = qn_turn(d[0] / A, d[1] / B);
  if (role == QUOIN_BODY) {
    uv[1] = qn_clamp01(d[2] / args[0] + (args[5] != 0 ? 0.5 : 0));
  } else {
    double share = (role == QUOIN_CAP0 ? args[1] : args[3]) / A;
    uv[1] = share > 0 ? qn_clamp01(qn_norm2(d[0] / A, d[1] / B) / share) : 0;
  }
}
