/* Hyperboloids of one sheet (h, r, rc) and of two (h, r, gap), both sheets kept; capped at z = -h (cap0) and z = h (cap1).
   Placed: the base is the centre (the waist's), the axis the direction of +z.

   One sheet: x^2 + y^2 = rc^2 + (r^2 - rc^2) z^2 / h^2, times h^2:  h^2 x^2 + h^2 y^2 - (r^2 - rc^2) z^2 - rc^2 h^2. A waist
   wider than the ends
   gives a barrel (an ellipsoid's zone), equal radii a cylinder, rc = 0 a double cone.
   Two sheets, g = gap: x^2 + y^2 = r^2 (z^2 - g^2) / (h^2 - g^2), times h^2 - g^2:  (h^2 - g^2)(x^2 + y^2) - r^2 z^2 + r^2 g^2.

   Support. rc <= r and two sheets: the solid lies in the cylinder between its end discs and holds the discs, so the discs'
   support is its own. A barrel with E^2 = rc^2 - r^2 is a zone of the ellipsoid with semi-axes rc and h rc / E; with
   H = h |v_z| and s = |(v_x, v_y)| the ellipsoid's support rc sqrt((H/E)^2 + s^2) is reached at a height h rc H / (E sqrt(H^2 +
   E^2 s^2)), inside
   the zone when r H < E^2 s; else the disc's, H + r s, is the greatest. The first is an upper bound in any case, so it is taken
   unless the other is certain. */
#include "shape/outward.h"
#include "shape/round.h"
#include "shape/rows.h"

static qn_form_result capped(qn_ctx *ctx, qn_num h, const qn_round_body *body, const qn_placement *placement, qn_half_form **halves,
                             size_t *count) {
  qn_frame frame;
  if (!qn_frame_make(ctx, placement, &frame)) {
    return QN_FORM_EMPTY;
  }
  qn_half_form *out = qn_halves_new(ctx, 3);
  if (!out) {
    return QN_FORM_EMPTY;
  }
  qn_frame_body(ctx, &frame, body, out);
  qn_frame_cap(ctx, &frame, QUOIN_CAP0, -1, neg(ctx, h), out + 1);
  qn_frame_cap(ctx, &frame, QUOIN_CAP1, 1, h, out + 2);
  *halves = out;
  *count = 3;
  return QN_FORM_OK;
}

qn_form_result qn_hyperboloid1_form(qn_ctx *ctx, const qn_num *args, size_t n, const qn_placement *placement, qn_half_form **halves,
                                    size_t *count) {
  (void)n;
  *count = 0;
  qn_num h = args[0], r = args[1], rc = args[2];
  if (!positive(h) || qn_num_sign(r) < 0 || qn_num_sign(rc) < 0 || (qn_num_is_zero(r) && qn_num_is_zero(rc))) {
    return QN_FORM_EMPTY;
  }
  qn_num h2 = square(ctx, h), r2 = square(ctx, r), rc2 = square(ctx, rc);
  qn_round_body body = {.p = QN_NUM_ONE};
  if (equal(ctx, r, rc)) {
    body.a = body.b = QN_NUM_ONE;
    body.k = neg(ctx, r2);
  } else {
    body.a = body.b = h2;
    body.c = sub(ctx, rc2, r2);
    body.k = neg(ctx, mul(ctx, rc2, h2));
  }
  return capped(ctx, h, &body, placement, halves, count);
}

qn_form_result qn_hyperboloid2_form(qn_ctx *ctx, const qn_num *args, size_t n, const qn_placement *placement, qn_half_form **halves,
                                    size_t *count) {
  (void)n;
  *count = 0;
  qn_num h = args[0], r = args[1], gap = args[2];
  if (!positive(h) || !positive(r) || qn_num_sign(gap) < 0 || qn_num_cmp(ctx, gap, h) >= 0) {
    return QN_FORM_EMPTY;
  }
  qn_num r2 = square(ctx, r), g2 = square(ctx, gap), rest = sub(ctx, square(ctx, h), g2);
  qn_round_body body = {.a = rest, .b = rest, .c = neg(ctx, r2), .k = mul(ctx, r2, g2), .p = QN_NUM_ONE};
  return capped(ctx, h, &body, placement, halves, count);
}

double qn_hyperboloid2_support(const double *args, size_t n, const double placement[6], const double v[3]) {
  (void)n;
  double h = args[0], r = args[1];
  return qn_frame_two_discs(placement, v, -h, r, r, h, r, r, h + 2 * r);
}

double qn_hyperboloid1_support(const double *args, size_t n, const double placement[6], const double v[3]) {
  double h = args[0], r = args[1], rc = args[2];
  if (rc <= r) { /* in doubles; the exact rc is then above the exact r by 2u at most, which the slack covers */
    return qn_hyperboloid2_support(args, n, placement, v);
  }
  double d[3];
  qn_frame_direction(placement, v, d);
  double s = qn_norm2(d[0], d[1]), H = h * fabs(d[2]), E2 = (rc - r) * (rc + r), E = sqrt(E2);
  qn_terms t = {0, 0};
  if (r * H < (E2 + QN_SUPPORT_SLACK(16) * rc * rc) * s) {
    qn_term(&t, rc, qn_norm2(H / E, s));
  } else {
    qn_term(&t, H, 1);
    qn_term(&t, r, s);
  }
  return qn_outward((qn_terms){qn_frame_outward(placement, v, t.sum, t.magnitude, h + 2 * rc), t.magnitude}, QN_SUPPORT_SLACK(64));
}

void qn_hyperboloid1_uv(const double *args, size_t n, const double placement[6], uint32_t role, const double x[3], double uv[2]) {
  (void)n;
  double d[3];
  qn_frame_point(placement, x, d);
  uv[0] = qn_turn(d[0], d[1]);
  uv[1] = role == QUOIN_BODY ? qn_clamp01(0.5 * (d[2] / args[0]) + 0.5) : args[1] > 0 ? qn_clamp01(qn_norm2(d[0], d[1]) / args[1]) : 0;
}

void qn_hyperboloid2_uv(const double *args, size_t n, const double placement[6], uint32_t role, const double x[3], double uv[2]) {
  qn_hyperboloid1_uv(args, n, placement, role, x, uv);
}
