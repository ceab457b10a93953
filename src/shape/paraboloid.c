/* Paraboloid, circular or elliptic: h, a, b, center. The vertex at the origin, the cap (cap0) at z = h with semi-axes a, b.

   With ζ the height over the vertex:  h b^2 x^2 + h a^2 y^2 - a^2 b^2 ζ  (a = b: h x^2 + h y^2 - a^2 ζ).
   Unplaced ζ = z, centred ζ = z + h/2. Placed, the base is the cap's centre and the axis points to the vertex: with z along the
   axis ζ = h - z, centred ζ = h/2 - z.

   Support, with r = |(a v_x, b v_y)| and g the part of v along increasing ζ: the rim of ζ = h t^2 gives r t + g h t^2, t in [0,
   1]. For
   g >= 0 that is greatest at t = 1; else at t = r / (-2 g h), when that is below 1. A rounded t costs the second order only. */
#include "shape/outward.h"
#include "shape/round.h"
#include "shape/rows.h"

qn_form_result qn_paraboloid_form(qn_ctx *ctx, const qn_num *args, size_t n, const qn_placement *placement, qn_half_form **halves,
                                  size_t *count) {
  (void)n;
  *count = 0;
  qn_num h = args[0], a = args[1], b = args[2];
  qn_frame frame;
  if (!positive(h) || !positive(a) || !positive(b) || !qn_frame_make(ctx, placement, &frame)) {
    return QN_FORM_EMPTY;
  }
  qn_half_form *out = qn_halves_new(ctx, 2);
  if (!out) {
    return QN_FORM_EMPTY;
  }
  int center = !qn_num_is_zero(args[3]), round = equal(ctx, a, b);
  qn_num a2 = square(ctx, a), b2 = square(ctx, b), h_half = half(ctx, h);
  qn_round_body body = {
    .a = round ? h : mul(ctx, h, b2),
    .b = round ? h : mul(ctx, h, a2),
    .l = neg(ctx, half(ctx, round ? a2 : mul(ctx, a2, b2))),
    .p = placement ? neg(ctx, QN_NUM_ONE) : QN_NUM_ONE,
    .q = center ? h_half : placement ? h : QN_NUM_ZERO,
  };
  qn_frame_body(ctx, &frame, &body, out);
  if (placement) {
    qn_frame_cap(ctx, &frame, QUOIN_CAP0, -1, center ? neg(ctx, h_half) : QN_NUM_ZERO, out + 1);
  } else {
    qn_frame_cap(ctx, &frame, QUOIN_CAP0, 1, center ? h_half : h, out + 1);
  }
  *halves = out;
  *count = 2;
  return QN_FORM_OK;
}

double qn_paraboloid_support(const double *args, size_t n, const double placement[6], const double v[3]) {
  (void)n;
  double h = args[0], d[3];
  qn_frame_direction(placement, v, d);
  double r = qn_norm2(args[1] * d[0], args[2] * d[1]);
  double g = placement ? -d[2] : d[2], t = 1;
  if (g < 0 && r < -2 * h * g) {
    t = r / (-2 * h * g);
  }
  qn_terms s = {0, 0};
  qn_term(&s, r, t);
  qn_term(&s, h * t * t, g);
  double vertex = args[3] != 0 ? -0.5 * h : 0; /* its place along ζ's direction */
  if (placement) {
    vertex = args[3] != 0 ? -0.5 * h : -h;
  }
  qn_term(&s, vertex, g);
  return qn_frame_outward(placement, v, s.sum, s.magnitude, 2 * h + qn_norm2(args[1], args[2]));
}

void qn_paraboloid_uv(const double *args, size_t n, const double placement[6], uint32_t role, const double x[3], double uv[2]) {
  (void)n;
  double d[3];
  qn_frame_point(placement, x, d);
  double share = qn_norm2(d[0] / args[1], d[1] / args[2]);
  uv[0] = qn_turn(d[0] / args[1], d[1] / args[2]);
  uv[1] = qn_clamp01(role == QUOIN_BODY ? share * share : share); /* on the body the share of the height */
}
