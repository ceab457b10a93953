/* Booleans and transforms. */
#include "model/words.h"

#include <string.h>

uint32_t qn_make_union(qn_call *call) { return qn_call_node(call, QN_NODE_UNION, 0, NULL, 0); }
uint32_t qn_make_difference(qn_call *call) { return qn_call_node(call, QN_NODE_DIFFERENCE, 0, NULL, 0); }
uint32_t qn_make_intersection(qn_call *call) { return qn_call_node(call, QN_NODE_INTERSECTION, 0, NULL, 0); }

static uint32_t transform(qn_call *call, qn_node_kind kind, const qn_num *numbers, size_t count) {
  return qn_call_hindered(call) ? qn_call_void(call) : qn_call_node(call, kind, 0, numbers, count);
}

/* A missing argument is the identity, as in OpenSCAD, but hardly meant. */
static void required(qn_call *call, int parameter, const char *what) {
  if (!qn_arg_given(call, parameter)) {
    qn_arg_tell(call, QN_Q0412, -1, NULL, NULL, "%s is missing", what);
  }
}

uint32_t qn_make_translate(qn_call *call) {
  enum { V };
  qn_num v[3] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO};
  required(call, V, "the vector 'v'");
  qn_arg_vector(call, V, 2, 3, 0, v);
  return transform(call, QN_NODE_TRANSLATE, v, 3);
}

uint32_t qn_make_rotate(qn_call *call) {
  enum { A, V };
  required(call, A, "the angle 'a'");
  if (call->value[A].kind == QN_V_VECTOR) {
    qn_num a[3] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO};
    qn_arg_vector(call, A, 1, 3, 0, a);
    if (qn_arg_given(call, V)) {
      qn_arg_tell(call, QN_Q0408, V, "with three angles there is no axis", NULL, "'v' is ignored");
    }
    return transform(call, QN_NODE_ROTATE, a, 3);
  }
  qn_num n[4] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ONE};
  n[0] = qn_arg_number(call, A, QN_NUM_ZERO);
  if (!qn_arg_given(call, V)) {
    qn_num about_z[3] = {QN_NUM_ZERO, QN_NUM_ZERO, n[0]};
    return transform(call, QN_NODE_ROTATE, about_z, 3);
  }
  n[3] = QN_NUM_ZERO;
  qn_arg_vector(call, V, 2, 3, 0, n + 1);
  if (!call->bad && !call->not_finite && qn_num_is_zero(n[1]) && qn_num_is_zero(n[2]) && qn_num_is_zero(n[3])) {
    return qn_make_union(call); /* about no axis: OpenSCAD turns nothing */
  }
  return transform(call, QN_NODE_ROTATE_AXIS, n, 4);
}

static void singular(qn_call *call, int parameter, const char *reason) {
  if (!call->bad && !call->not_finite) {
    qn_arg_tell(call, QN_Q0503, parameter, reason, NULL, "the transform flattens its children, so the solid is empty");
    call->empty = 1;
  }
}

uint32_t qn_make_scale(qn_call *call) {
  enum { V };
  qn_num v[3] = {QN_NUM_ONE, QN_NUM_ONE, QN_NUM_ONE};
  required(call, V, "the vector 'v'");
  qn_arg_vector(call, V, 2, 3, 1, v);
  if (qn_num_is_zero(v[0]) || qn_num_is_zero(v[1]) || qn_num_is_zero(v[2])) {
    singular(call, V, "a factor is 0");
  }
  return transform(call, QN_NODE_SCALE, v, 3);
}

uint32_t qn_make_mirror(qn_call *call) {
  enum { V };
  qn_num v[3] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO};
  required(call, V, "the normal 'v'");
  qn_arg_vector(call, V, 2, 3, 0, v);
  if (!call->bad && !call->not_finite && qn_num_is_zero(v[0]) && qn_num_is_zero(v[1]) && qn_num_is_zero(v[2])) {
    return qn_make_union(call); /* as OpenSCAD */
  }
  return transform(call, QN_NODE_MIRROR, v, 3);
}

/* The determinant of the 3x3 part of a row-major matrix of `stride` columns. */
static qn_num determinant(qn_ctx *ctx, const qn_num *m, size_t stride) {
  qn_num terms[3], first[3];
  for (size_t j = 0; j < 3; j++) {
    size_t k = (j + 1) % 3, l = (j + 2) % 3;
    qn_num x[2] = {m[stride + k], m[stride + l]}, y[2] = {m[2 * stride + l], qn_num_neg(ctx, m[2 * stride + k])};
    terms[j] = qn_num_dot(ctx, 2, x, y);
    first[j] = m[j];
  }
  return qn_num_dot(ctx, 3, first, terms);
}

/* OpenSCAD's: up to 4 rows of up to 4, missing ones are the identity's; the last element divides all. */
uint32_t qn_make_multmatrix(qn_call *call) {
  enum { M };
  qn_ctx *ctx = &call->ev->ctx;
  required(call, M, "the matrix 'm'");
  qn_num m[16];
  for (size_t i = 0; i < 16; i++) {
    m[i] = i % 5 == 0 ? QN_NUM_ONE : QN_NUM_ZERO;
  }
  qn_value v = call->value[M];
  int good = v.kind == QN_V_VECTOR && v.count <= 4;
  for (size_t i = 0; good && i < v.count; i++) {
    qn_value row = v.u.items[i];
    good = row.kind == QN_V_VECTOR && row.count <= 4;
    for (size_t j = 0; good && j < row.count; j++) {
      good = qn_arg_item(call, M, row.u.items[j], &m[4 * i + j]) != 0;
    }
  }
  if (!good && v.kind != QN_V_BAD && v.kind != QN_V_UNDEF) {
    qn_arg_tell(call, QN_Q0406, M, NULL, "write [[xx, xy, xz, tx], [yx, yy, yz, ty], [zx, zy, zz, tz]]",
                "'m' must be a matrix of 3 or 4 rows of numbers");
  }
  if (v.kind == QN_V_BAD) {
    call->bad = 1;
  }
  if (!call->bad && !call->not_finite) {
    if (!qn_num_is_zero(m[12]) || !qn_num_is_zero(m[13]) || !qn_num_is_zero(m[14])) {
      qn_arg_tell(call, QN_Q0504, M, "its last row is not [0, 0, 0, w]", NULL, "the matrix is not affine");
    } else if (qn_num_is_zero(m[15])) {
      call->not_finite = M + 1;
    } else if (qn_num_cmp(ctx, m[15], QN_NUM_ONE) != 0) {
      for (size_t i = 0; i < 12; i++) {
        m[i] = qn_num_div(ctx, m[i], m[15]);
      }
    }
    if (!call->bad && !call->not_finite && qn_num_is_zero(determinant(ctx, m, 4))) {
      singular(call, M, "its determinant is 0");
    }
  }
  return transform(call, QN_NODE_MULTMATRIX, m, 12);
}
