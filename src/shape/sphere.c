/* Sphere and ellipsoid.

   Sphere: X^2 + Y^2 + Z^2 - r^2, the rows the identity; a sphere's axis does not matter. Ellipsoid: the multiple of
   x^2/a^2 + y^2/b^2 + z^2/c^2 - 1 by the distinct ones of a^2, b^2, c^2, so that decimals stay decimals.
   Support: r |v|, and |(a v_x, b v_y, c v_z)|. (u, v): longitude about z, latitude. */
#include "shape/outward.h"
#include "shape/round.h"
#include "shape/rows.h"

static qn_form_result one_body(qn_half_form *h, qn_half_form **halves, size_t *count) {
  *halves = h;
  *count = h != NULL;
  return h ? QN_FORM_OK : QN_FORM_EMPTY;
}

qn_form_result qn_sphere_form(qn_ctx *ctx, const qn_num *args, size_t n, const qn_placement *placement, qn_half_form **halves,
                              size_t *count) {
  (void)n;
  *count = 0;
  if (!positive(args[0])) {
    return QN_FORM_EMPTY;
  }
  qn_half_form *h = qn_halves_new(ctx, 1);
  if (h) {
    h->kind = QN_QUADRIC_BODY;
    h->role = QUOIN_BODY;
    for (int i = 0; i < 3; i++) {
      h->row[i][i] = h->s[i] = QN_NUM_ONE;
      if (placement) {
        h->row[i][3] = neg(ctx, placement->base[i]);
      }
    }
    h->k = neg(ctx, square(ctx, args[0]));
  }
  return one_body(h, halves, count);
}

qn_form_result qn_ellipsoid_form(qn_ctx *ctx, const qn_num *args, size_t n, const qn_placement *placement, qn_half_form **halves,
                                 size_t *count) {
  *count = 0;
  if (!positive(args[0]) || !positive(args[1]) || !positive(args[2])) {
    return QN_FORM_EMPTY;
  }
  int ab = equal(ctx, args[0], args[1]), bc = equal(ctx, args[1], args[2]);
  if (ab && bc) {
    return qn_sphere_form(ctx, args, n, placement, halves, count);
  }
  qn_frame frame;
  if (!qn_frame_make(ctx, placement, &frame)) {
    return QN_FORM_EMPTY;
  }
  qn_num a2 = square(ctx, args[0]), b2 = square(ctx, args[1]), c2 = square(ctx, args[2]);
  qn_round_body body = {.p = QN_NUM_ONE};
  if (ab) {
    body.a = body.b = c2, body.c = a2, body.k = neg(ctx, mul(ctx, a2, c2));
  } else if (bc) {
    body.b = body.c = a2, body.a = b2, body.k = neg(ctx, mul(ctx, a2, b2));
  } else if (equal(ctx, args[0], args[2])) {
    body.a = body.c = b2, body.b = a2, body.k = neg(ctx, mul(ctx, a2, b2));
  } else {
    body.a = mul(ctx, b2, c2), body.b = mul(ctx, a2, c2), body.c = mul(ctx, a2, b2), body.k = neg(ctx, mul(ctx, body.c, c2));
  }
  qn_half_form *h = qn_halves_new(ctx, 1);
  if (h) {
    qn_frame_body(ctx, &frame, &body, h);
  }
  return one_body(h, halves, count);
}

double qn_sphere_support(const double *args, size_t n, const double placement[6], const double v[3]) {
  (void)n;
  double magnitude, base = qn_frame_base(placement, v, &magnitude);
  qn_terms t = {base, magnitude};
  qn_term(&t, args[0], qn_norm3(v[0], v[1], v[2]));
  return qn_outward(t, QN_SUPPORT_SLACK(12));
}

double qn_ellipsoid_support(const double *args, size_t n, const double placement[6], const double v[3]) {
  (void)n;
  double d[3];
  qn_frame_direction(placement, v, d);
  qn_terms t = {0, 0};
  qn_term(&t, qn_norm3(args[0] * d[0], args[1] * d[1], args[2] * d[2]), 1);
  return qn_frame_outward(placement, v, t.sum, t.magnitude, qn_norm3(args[0], args[1], args[2]));
}

static void latitude(double x, double y, double z, double uv[2]) {
  uv[0] = qn_turn(x, y);
  uv[1] = qn_clamp01(atan2(z, qn_norm2(x, y)) * 0.31830988618379067154 + 0.5); /* 1 / pi */
}

void qn_sphere_uv(const double *args, size_t n, const double placement[6], uint32_t role, const double x[3], double uv[2]) {
  (void)args, (void)n, (void)role;
  double d[3];
  qn_frame_point(placement, x, d);
  latitude(d[0], d[1], d[2], uv);
}

void qn_ellipsoid_uv(const double *args, size_t n, const double placement[6], uint32_t role, const double x[3], double uv[2]) {
  (void)n, (void)role;
  double d[3];
  qn_frame_point(placement, x, d);
  latitude(d[0] / args[0], d[1] / args[1], d[2] / args[2], uv);
}
