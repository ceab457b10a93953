/* Frames by base and axis.

   Legend: w the axis, b the base; u2 = (-w_y, w_x, 0), u1 = u2 x w = (w_x w_z, w_y w_z, -(w_x^2 + w_y^2)); when w is along z, u2
   = y and
   u1 = x or -x. So x goes where rotate([0, acos(w_z/|w|), atan2(w_y, w_x)]) takes it, and the axis +z is the identity.

   u1, u2, w are orthogonal and right-handed, rational when w is, and not of unit length: with X0 = u1.(p - b), X1 = u2.(p - b),
   W = w.(p - b), the local coordinates are x = X0/|u1|, y = X1/|u2|, z = W/|w|, and |u1|^2 = |u2|^2 |w|^2. Take Z = p z + q and
   X2 = |w| Z = p W + q |w|. Then
       |u1|^2 (a x^2 + b y^2 + c Z^2 + 2 l Z + k)
         = a X0^2 + b |w|^2 X1^2 + c |u2|^2 X2^2 + 2 l |u2|^2 |w| X2 + k |u1|^2,
   whose coefficients need the irrational |w| only where q or l is not zero. An axis along a coordinate axis is made a unit vector
   first. */
#include "shape/round.h"
#include "shape/outward.h"

#include <string.h>

static qn_num sum_squares(qn_ctx *ctx, const qn_num v[3]) { return qn_num_dot(ctx, 3, v, v); }

int qn_frame_make(qn_ctx *ctx, const qn_placement *placement, qn_frame *out) {
  *out = (qn_frame){.n1 = QN_NUM_ONE, .n2 = QN_NUM_ONE, .nw = QN_NUM_ONE, .length = QN_NUM_ONE, .flat = QN_NUM_ONE, .has_length = 1, .has_flat = 1};
  out->u[0][0] = out->u[1][1] = out->u[2][2] = QN_NUM_ONE;
  if (!placement) {
    return 1;
  }
  out->placed = 1;
  memcpy(out->base, placement->base, sizeof out->base);
  qn_num w[3];
  memcpy(w, placement->axis, sizeof w);
  int zeros = qn_num_is_zero(w[0]) + qn_num_is_zero(w[1]) + qn_num_is_zero(w[2]);
  if (zeros == 3) {
    return 0;
  }
  if (zeros == 2) { /* only its direction counts */
    for (int i = 0; i < 3; i++) {
      w[i] = qn_num_from_int(ctx, qn_num_sign(w[i]));
    }
  }
  memcpy(out->u[2], w, sizeof w);
  if (qn_num_is_zero(w[0]) && qn_num_is_zero(w[1])) {
    out->u[0][0] = w[2]; /* 1 or -1 */
    return 1;
  }
  qn_num n2 = add(ctx, square(ctx, w[0]), square(ctx, w[1]));
  out->u[1][0] = neg(ctx, w[1]);
  out->u[1][1] = w[0];
  out->u[1][2] = QN_NUM_ZERO;
  out->u[0][0] = mul(ctx, w[0], w[2]);
  out->u[0][1] = mul(ctx, w[1], w[2]);
  out->u[0][2] = neg(ctx, n2);
  out->n2 = n2;
  out->nw = sum_squares(ctx, w);
  out->n1 = mul(ctx, out->n2, out->nw);
  out->has_length = out->has_flat = zeros == 2;
  return 1;
}

qn_num qn_frame_length(qn_ctx *ctx, qn_frame *frame) {
  if (!frame->has_length) {
    frame->length = qn_num_sqrt(ctx, frame->nw);
    frame->has_length = 1;
  }
  return frame->length;
}

/* row = scale * axis.(p - base) + shift */
static void linear_row(qn_ctx *ctx, const qn_frame *frame, int axis, qn_num scale, qn_num shift, qn_num row[4]) {
  if (!frame->placed) {
    row[axis] = scale;
    row[3] = shift;
    return;
  }
  qn_num v[4], b[4];
  for (int i = 0; i < 3; i++) {
    row[i] = mul(ctx, scale, frame->u[axis][i]);
    v[i] = neg(ctx, row[i]);
    b[i] = frame->base[i];
  }
  v[3] = shift;
  b[3] = QN_NUM_ONE;
  row[3] = qn_num_dot(ctx, 4, v, b);
}

void qn_frame_body(qn_ctx *ctx, qn_frame *frame, const qn_round_body *body, qn_half_form *out) {
  out->kind = QN_QUADRIC_BODY;
  out->role = QUOIN_BODY;
  linear_row(ctx, frame, 0, QN_NUM_ONE, QN_NUM_ZERO, out->row[0]);
  linear_row(ctx, frame, 1, QN_NUM_ONE, QN_NUM_ZERO, out->row[1]);
  if (!frame->placed) {
    linear_row(ctx, frame, 2, body->p, body->q, out->row[2]);
    out->s[0] = body->a;
    out->s[1] = body->b;
    out->s[2] = body->c;
    out->l = body->l;
    out->k = body->k;
    return;
  }
  qn_num shift = qn_num_is_zero(body->q) ? body->q : mul(ctx, body->q, qn_frame_length(ctx, frame));
  linear_row(ctx, frame, 2, body->p, shift, out->row[2]);
  out->s[0] = body->a;
  out->s[1] = mul(ctx, body->b, frame->nw);
  out->s[2] = mul(ctx, body->c, frame->n2);
  out->l = qn_num_is_zero(body->l) ? body->l : mul3(ctx, body->l, frame->n2, qn_frame_length(ctx, frame));
  out->k = mul(ctx, body->k, frame->n1);
}

void qn_frame_cap(qn_ctx *ctx, qn_frame *frame, uint32_t role, int side, qn_num at, qn_half_form *out) {
  out->kind = QN_PLANE;
  out->role = role;
  qn_num shift = qn_num_is_zero(at) ? at : mul(ctx, at, qn_frame_length(ctx, frame));
  linear_row(ctx, frame, 2, qn_num_from_int(ctx, side), side > 0 ? neg(ctx, shift) : shift, out->row[0]);
}

/* Times |u1| = |u2| |w|:  a X0 + b |w| X1 + c |u2| W - d |u1|. */
void qn_frame_plane(qn_ctx *ctx, qn_frame *frame, uint32_t role, const qn_num abcd[4], qn_half_form *out) {
  if (!frame->placed) {
    qn_half_plane(ctx, out, role, abcd[0], abcd[1], abcd[2], abcd[3]);
    return;
  }
  if (!frame->has_flat) {
    frame->flat = qn_num_sqrt(ctx, frame->n2);
    frame->has_flat = 1;
  }
  qn_num length = qn_frame_length(ctx, frame);
  qn_num c[3] = {abcd[0], mul(ctx, abcd[1], length), mul(ctx, abcd[2], frame->flat)};
  qn_num normal[4], base[4];
  for (int i = 0; i < 3; i++) {
    qn_num column[3] = {frame->u[0][i], frame->u[1][i], frame->u[2][i]};
    normal[i] = qn_num_dot(ctx, 3, c, column);
    base[i] = frame->base[i];
  }
  normal[3] = mul3(ctx, abcd[3], frame->flat, length);
  base[3] = QN_NUM_ONE;
  qn_half_plane(ctx, out, role, normal[0], normal[1], normal[2], qn_num_dot(ctx, 4, normal, base));
}

/* The unit frame in doubles. */
static void unit_frame(const double placement[6], double u[3][3]) {
  const double *w = placement + 3;
  memset(u, 0, 9 * sizeof(double));
  double flat = qn_norm2(w[0], w[1]), length = qn_norm3(w[0], w[1], w[2]);
  if (!(flat > 0)) {
    u[0][0] = u[2][2] = w[2] < 0 ? -1 : 1;
    u[1][1] = 1;
    return;
  }
  for (int i = 0; i < 3; i++) {
    u[2][i] = w[i] / length;
  }
  u[1][0] = -w[1] / flat;
  u[1][1] = w[0] / flat;
  u[0][0] = u[1][1] * u[2][2];
  u[0][1] = -u[1][0] * u[2][2];
  u[0][2] = -flat / length;
}

void qn_frame_direction(const double placement[6], const double v[3], double local[3]) {
  if (!placement) {
    memcpy(local, v, 3 * sizeof(double));
    return;
  }
  double u[3][3];
  unit_frame(placement, u);
  for (int i = 0; i < 3; i++) {
    local[i] = u[i][0] * v[0] + u[i][1] * v[1] + u[i][2] * v[2];
  }
}

void qn_frame_point(const double placement[6], const double x[3], double local[3]) {
  double y[3] = {x[0], x[1], x[2]};
  for (int i = 0; placement && i < 3; i++) {
    y[i] -= placement[i];
  }
  qn_frame_direction(placement, y, local);
}

double qn_frame_base(const double placement[6], const double v[3], double *magnitude) {
  qn_terms t = {0, 0};
  for (int i = 0; placement && i < 3; i++) {
    qn_term(&t, placement[i], v[i]);
  }
  *magnitude = t.magnitude;
  return t.sum;
}

double qn_frame_outward(const double placement[6], const double v[3], double sum, double magnitude, double size) {
  if (!placement) {
    return qn_outward((qn_terms){sum, magnitude}, QN_SUPPORT_SLACK(12));
  }
  double base_size, base = qn_frame_base(placement, v, &base_size);
  return qn_outward((qn_terms){base + sum, base_size + size * qn_norm3(v[0], v[1], v[2])}, QN_SUPPORT_SLACK(64));
}

double qn_frame_two_discs(const double placement[6], const double v[3], double z1, double a1, double b1, double z2, double a2, double b2,
                          double size) {
  double d[3];
  qn_frame_direction(placement, v, d);
  qn_terms t1 = {0, 0}, t2 = {0, 0};
  qn_term(&t1, z1, d[2]);
  qn_term(&t2, z2, d[2]);
  double r1 = qn_norm2(a1 * d[0], b1 * d[1]), r2 = qn_norm2(a2 * d[0], b2 * d[1]);
  qn_term(&t1, r1, 1);
  qn_term(&t2, r2, 1);
  double s1 = t1.sum, s2 = t2.sum;
  return qn_frame_outward(placement, v, s1 > s2 ? s1 : s2, t1.magnitude > t2.magnitude ? t1.magnitude : t2.magnitude, size);
}
