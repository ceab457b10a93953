/* The prism that $fn makes of a cylinder: n-gon, h, r1 at the bottom, r2 at the top, center; vertex k at the angle 360 k / n.

   Side k lies between vertices k and k + 1. With p = 180 (2k + 1) / n the angle of its middle and c = cos(180 / n) it is
       h cos p x + h sin p y + c (r1 - r2) (z - z0) <= c r1 h      (r1 = r2: cos p x + sin p y <= c r1),
   rational wherever p is a multiple of 90 and c is; for n = 4 all is divided by c, and is rational.
   The sides of a pyramid meet in its apex and need no cap there.
   Support: a vertex nearest to the direction; it and its two neighbours are tried. */
#include "base/limits.h"
#include "shape/outward.h"
#include "shape/round.h"
#include "shape/rows.h"

qn_form_result qn_prism_form(qn_ctx *ctx, const qn_num *args, size_t n, const qn_placement *placement, qn_half_form **halves,
                             size_t *count) {
  (void)n;
  *count = 0;
  int64_t sides = 0;
  qn_num h = args[1], r1 = args[2], r2 = args[3];
  qn_frame frame;
  if (!qn_num_is_integer(args[0], &sides) || sides < 3 || sides > QN_MAX_FACES || !positive(h) || qn_num_sign(r1) < 0 ||
      qn_num_sign(r2) < 0 || (qn_num_is_zero(r1) && qn_num_is_zero(r2)) || !qn_frame_make(ctx, placement, &frame)) {
    return QN_FORM_EMPTY;
  }
  qn_half_form *out = qn_halves_new(ctx, (size_t)sides + 2);
  if (!out) {
    return QN_FORM_EMPTY;
  }
  int center = !qn_num_is_zero(args[4]), straight = equal(ctx, r1, r2);
  qn_num lo = center ? neg(ctx, half(ctx, h)) : QN_NUM_ZERO, hi = center ? half(ctx, h) : h;
  qn_num step = qn_num_div(ctx, qn_num_from_int(ctx, 180), args[0]);
  qn_num c = sides == 4 ? QN_NUM_ONE : qn_num_cos(ctx, step);
  qn_num lean = straight ? QN_NUM_ZERO : mul(ctx, c, sub(ctx, r1, r2));
  /* c (r1 h + (r1 - r2) z0), which is c h (r1 + r2) / 2 when centred */
  qn_num reach = straight ? mul(ctx, c, r1) : mul3(ctx, c, h, center ? half(ctx, add(ctx, r1, r2)) : r1);
  for (int64_t k = 0; k < sides; k++) {
    qn_num p = mul(ctx, step, qn_num_from_int(ctx, 2 * k + 1)), x, y;
    if (sides == 4) {
      x = qn_num_from_int(ctx, k == 0 || k == 3 ? 1 : -1);
      y = qn_num_from_int(ctx, k < 2 ? 1 : -1);
    } else {
      x = qn_num_cos(ctx, p);
      y = qn_num_sin(ctx, p);
    }
    qn_num plane[4] = {straight ? x : mul(ctx, h, x), straight ? y : mul(ctx, h, y), lean, reach};
    qn_frame_plane(ctx, &frame, QUOIN_FACE + (uint32_t)k, plane, out + k);
  }
  size_t m = (size_t)sides;
  if (!qn_num_is_zero(r1)) {
    qn_frame_cap(ctx, &frame, QUOIN_CAP0, -1, lo, out + m++);
  }
  if (!qn_num_is_zero(r2)) {
    qn_frame_cap(ctx, &frame, QUOIN_CAP1, 1, hi, out + m++);
  }
  *halves = out;
  *count = m;
  return QN_FORM_OK;
}

static const double turn = 6.283185307179586477;

double qn_prism_support(const double *args, size_t n, const double placement[6], const double v[3]) {
  (void)n;
  double sides = args[0], h = args[1], d[3];
  qn_frame_direction(placement, v, d);
  double nearest = floor(qn_turn(d[0], d[1]) * sides + 0.5), reach = -INFINITY;
  for (int i = -1; i <= 1; i++) {
    double share = (nearest + i) / sides;
    double a = turn * (share > 0.5 ? share - 1 : share); /* within a turn of 0 */
    double along = cos(a) * d[0] + sin(a) * d[1];
    reach = along > reach ? along : reach;
  }
  double lo = args[4] != 0 ? -0.5 * h : 0, hi = args[4] != 0 ? 0.5 * h : h;
  qn_terms bottom = {0, 0}, top = {0, 0};
  qn_term(&bottom, args[2], reach);
  qn_term(&bottom, lo, d[2]);
  qn_term(&top, args[3], reach);
  qn_term(&top, hi, d[2]);
  double sum = bottom.sum > top.sum ? bottom.sum : top.sum, r = args[2] > args[3] ? args[2] : args[3];
  /* The angles are off by some u of a turn: the slack is taken of the whole size, placed or not. */
  double base_size, base = qn_frame_base(placement, v, &base_size);
  return qn_outward((qn_terms){base + sum, base_size + (h + r) * qn_norm3(v[0], v[1], v[2])}, QN_SUPPORT_SLACK(64));
}

void qn_prism_uv(const double *args, size_t n, const double placement[6], uint32_t role, const double x[3], double uv[2]) {
  (void)n;
  double d[3], largest = args[2] > args[3] ? args[2] : args[3];
  qn_frame_point(placement, x, d);
  uv[0] = qn_turn(d[0], d[1]);
  if (role >= QUOIN_FACE) {
    uv[1] = qn_clamp01(d[2] / args[1] + (args[4] != 0 ? 0.5 : 0));
  } else {
    uv[1] = qn_clamp01(qn_norm2(d[0], d[1]) / largest);
  }
}
