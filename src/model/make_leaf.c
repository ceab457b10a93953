/* Primitives: their arguments become the numbers of shape/prim.h. */
#include "base/limits.h"
#include "model/words.h"

#include <string.h>

/* Numbers of a leaf, with room for a placement at the end. */
typedef struct leaf { qn_num n[16]; size_t count; } leaf;

static void put(leaf *l, qn_num n) {
  l->n[l->count++] = n;
}
static void put_truth(leaf *l, int truth) {
  put(l, truth ? QN_NUM_ONE : QN_NUM_ZERO);
}

/* The leaf, placed where base or axis is given. */
static uint32_t placed(qn_call *call, qn_prim prim, leaf *l, int base, int axis) {
  int has = qn_arg_given(call, base) || qn_arg_given(call, axis);
  if (has) {
    qn_num b[3] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO}, a[3] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ONE};
    qn_arg_vector(call, base, 3, 3, 0, b);
    qn_arg_vector(call, axis, 3, 3, 0, a);
    if (!call->bad && qn_num_is_zero(a[0]) && qn_num_is_zero(a[1]) && qn_num_is_zero(a[2])) {
      qn_arg_tell(call, QN_Q0508, axis, "the zero vector has no direction", NULL, "'axis' must not be zero");
    }
    for (int i = 0; i < 3; i++) {
      put(l, b[i]);
    }
    for (int i = 0; i < 3; i++) {
      put(l, a[i]);
    }
  }
  uint32_t node = qn_call_leaf(call, prim, l->n, l->count);
  if (has && node != QN_NO_NODE && call->ev->model->nodes[node].kind == QN_NODE_LEAF) {
    call->ev->model->nodes[node].flags |= QN_NODE_PLACED;
  }
  return node;
}

static qn_num half(qn_call *call, qn_num n) {
  return qn_num_div(&call->ev->ctx, n, qn_num_from_int(&call->ev->ctx, 2));
}

/* A radius by r or d (d wins, as in OpenSCAD), scalar or two semi-axes. Returns 1 when given. */
static int radius2(qn_call *call, int r, int d, qn_num out[2]) {
  int which = qn_arg_given(call, d) ? d : r;
  if (which == d && qn_arg_given(call, r)) {
    qn_arg_tell(call, QN_Q0408, r, "a radius and a diameter are given", "leave one out", "the radius is ignored");
  }
  if (qn_arg_vector(call, which, 2, 2, 1, out) == 0) {
    return 0;
  }
  if (which == d) {
    out[0] = half(call, out[0]);
    out[1] = half(call, out[1]);
  }
  return 1;
}

static qn_num radius1(qn_call *call, int r, int d, qn_num fallback) {
  int which = qn_arg_given(call, d) ? d : r;
  if (which == d && qn_arg_given(call, r)) {
    qn_arg_tell(call, QN_Q0408, r, "a radius and a diameter are given", "leave one out", "the radius is ignored");
  }
  qn_num n = qn_arg_number(call, which, fallback);
  return which == d ? half(call, n) : n;
}

/* $fn here as a whole number of facets, 0 when it says none. */
static uint32_t facets(qn_call *call) {
  if (call->fn.kind != QN_V_NUMBER || qn_num_sign(call->fn.u.number) <= 0) {
    return 0;
  }
  int64_t n;
  if (!qn_num_is_integer(qn_num_floor(&call->ev->ctx, call->fn.u.number), &n) || n > INT32_MAX) {
    return INT32_MAX;
  }
  return n < 3 ? 3 : (uint32_t)n; /* as OpenSCAD */
}

static void note_facets(qn_call *call, const char *problem) {
  if (!call->ev->facets_noted) {
    call->ev->facets_noted = 1;
    size_t offset = call->fn_place ? call->fn_place : call->statement->offset;
    size_t length = call->fn_place ? 3 : call->ev->syntax->names.items[call->statement->word].length;
    qn_tell(call->ev->reporter, QN_Q0505, offset, length, "curved surfaces are exact", NULL, "%s", problem);
  }
}

/* The n of a regular prism that a cylinder is meant to be, 0 for a round one. */
static uint32_t polygon(qn_call *call, int elliptic) {
  enum { FEW = 12 }; /* include/quoin/model.h: QUOIN_FACETS_AUTO */
  uint32_t n = facets(call);
  if (n == 0 || call->ev->options.facets == QUOIN_FACETS_IGNORE) {
    return 0;
  }
  if (elliptic) {
    note_facets(call, "$fn is ignored on an elliptic solid");
    return 0;
  }
  if (call->ev->options.facets == QUOIN_FACETS_HONOUR) {
    if (n > QN_MAX_FACES) {
      qn_arg_tell(call, QN_Q0907, -1, "at most 4096 of one solid", "use a smaller $fn", "too many faces");
    }
    return n;
  }
  if (n <= FEW) {
    return n;
  }
  note_facets(call, "$fn over 12 is ignored");
  return 0;
}

static void round_only(qn_call *call) {
  if (facets(call) && call->ev->options.facets != QUOIN_FACETS_IGNORE) {
    note_facets(call, facets(call) > 12 ? "$fn over 12 is ignored" : "$fn is ignored on this solid");
  }
}

static void box(qn_call *call, leaf *l) {
  enum { SIZE, CENTER };
  qn_num s[3] = {QN_NUM_ONE, QN_NUM_ONE, QN_NUM_ONE};
  qn_arg_vector(call, SIZE, 3, 3, 1, s);
  for (int i = 0; i < 3; i++) {
    if (!call->not_finite) {
      qn_arg_positive(call, SIZE, "a size", s[i]);
    }
    put(l, s[i]);
  }
  put_truth(l, qn_arg_truth(call, CENTER));
}

uint32_t qn_make_cube(qn_call *call) {
  leaf l = {.count = 0};
  box(call, &l);
  return qn_call_leaf(call, QN_CUBE, l.n, l.count);
}

uint32_t qn_make_wedge(qn_call *call) {
  leaf l = {.count = 0};
  box(call, &l);
  return qn_call_leaf(call, QN_WEDGE, l.n, l.count);
}

uint32_t qn_make_sphere(qn_call *call) {
  enum { R, D, CENTER, BASE, AXIS };
  leaf l = {.count = 0};
  put(&l, radius1(call, R, D, QN_NUM_ONE));
  qn_arg_truth(call, CENTER);
  qn_arg_positive(call, qn_arg_given(call, D) ? D : R, "the radius", l.n[0]);
  round_only(call);
  return placed(call, QN_SPHERE, &l, BASE, AXIS);
}

uint32_t qn_make_ellipsoid(qn_call *call) {
  enum { R, CENTER, BASE, AXIS };
  leaf l = {.n = {QN_NUM_ONE, QN_NUM_ONE, QN_NUM_ONE}, .count = 3};
  qn_arg_vector(call, R, 3, 3, 1, l.n);
  qn_arg_truth(call, CENTER);
  for (int i = 0; i < 3; i++) {
    qn_arg_positive(call, R, "a semi-axis", l.n[i]);
  }
  return placed(call, QN_ELLIPSOID, &l, BASE, AXIS);
}

/* A frustum between the ellipses lo (bottom) and hi (top), or the prism that $fn asks for. */
static uint32_t frustum(qn_call *call, qn_num h, const qn_num lo[2], const qn_num hi[2], int at_lo, int at_hi, int center, int base,
                        int axis) {
  qn_ctx *ctx = &call->ev->ctx;
  qn_arg_positive(call, 0, "the height", h);
  for (int i = 0; i < 2; i++) {
    qn_arg_not_negative(call, at_lo, "a radius", lo[i]);
    qn_arg_not_negative(call, at_hi, "a radius", hi[i]);
  }
  int zero = 0;
  for (int i = 0; i < 2; i++) {
    zero |= qn_num_is_zero(lo[i]) && qn_num_is_zero(hi[i]);
  }
  if (zero) {
    qn_arg_positive(call, at_hi, "the radius", QN_NUM_ZERO);
  }
  if (!call->bad && !call->empty && !call->not_finite &&
      qn_num_cmp(ctx, qn_num_mul(ctx, lo[0], hi[1]), qn_num_mul(ctx, hi[0], lo[1])) != 0) {
    qn_arg_tell(call, QN_Q0506, at_hi, "such a solid is bounded by no quadric", "give both ends one ratio of semi-axes",
                "the ends are ellipses of different shape");
  }
  int elliptic = qn_num_cmp(ctx, lo[0], lo[1]) != 0 || qn_num_cmp(ctx, hi[0], hi[1]) != 0;
  uint32_t n = polygon(call, elliptic);
  leaf l = {.count = 0};
  if (n) {
    put(&l, qn_num_from_int(ctx, n));
    put(&l, h);
    put(&l, lo[0]);
    put(&l, hi[0]);
  } else {
    put(&l, h);
    put(&l, lo[0]);
    put(&l, lo[1]);
    put(&l, hi[0]);
    put(&l, hi[1]);
  }
  put_truth(&l, center);
  return placed(call, n ? QN_PRISM : QN_CYLINDER, &l, base, axis);
}

uint32_t qn_make_cylinder(qn_call *call) {
  enum { H, R1, R2, CENTER, R, D, D1, D2, BASE, AXIS };
  qn_num lo[2] = {QN_NUM_ONE, QN_NUM_ONE}, hi[2] = {QN_NUM_ONE, QN_NUM_ONE};
  int given = radius2(call, R, D, lo);
  if (given) {
    memcpy(hi, lo, sizeof hi);
  }
  int given1 = radius2(call, R1, D1, lo), given2 = radius2(call, R2, D2, hi);
  if (given && (given1 || given2)) {
    qn_arg_tell(call, QN_Q0408, qn_arg_given(call, D) ? D : R, "r1 or r2 is given too", "leave one out", "the common radius is overridden");
  }
  int all = qn_arg_given(call, D) ? D : R;
  int at_lo = given1 ? (qn_arg_given(call, D1) ? D1 : R1) : all, at_hi = given2 ? (qn_arg_given(call, D2) ? D2 : R2) : all;
  return frustum(call, qn_arg_number(call, H, QN_NUM_ONE), lo, hi, at_lo, at_hi, qn_arg_truth(call, CENTER), BASE, AXIS);
}

uint32_t qn_make_cone(qn_call *call) {
  enum { H, R, CENTER, D, BASE, AXIS };
  qn_num lo[2] = {QN_NUM_ONE, QN_NUM_ONE}, hi[2] = {QN_NUM_ZERO, QN_NUM_ZERO};
  radius2(call, R, D, lo);
  int at = qn_arg_given(call, D) ? D : R;
  return frustum(call, qn_arg_number(call, H, QN_NUM_ONE), lo, hi, at, at, qn_arg_truth(call, CENTER), BASE, AXIS);
}

uint32_t qn_make_paraboloid(qn_call *call) {
  enum { H, R, CENTER, D, BASE, AXIS };
  leaf l = {.count = 0};
  qn_num r[2] = {QN_NUM_ONE, QN_NUM_ONE}, h = qn_arg_number(call, H, QN_NUM_ONE);
  radius2(call, R, D, r);
  qn_arg_positive(call, H, "the height", h);
  qn_arg_positive(call, qn_arg_given(call, D) ? D : R, "the radius", r[0]);
  qn_arg_positive(call, qn_arg_given(call, D) ? D : R, "the radius", r[1]);
  put(&l, h);
  put(&l, r[0]);
  put(&l, r[1]);
  put_truth(&l, qn_arg_truth(call, CENTER));
  round_only(call);
  return placed(call, QN_PARABOLOID, &l, BASE, AXIS);
}

uint32_t qn_make_hyperboloid(qn_call *call) {
  enum { H, R, RC, GAP, D, CENTER, BASE, AXIS };
  leaf l = {.count = 0};
  qn_ctx *ctx = &call->ev->ctx;
  qn_num h = qn_arg_number(call, H, QN_NUM_ONE), r = radius1(call, R, D, QN_NUM_ONE);
  int two = qn_arg_given(call, GAP);
  if (two == qn_arg_given(call, RC)) {
    qn_arg_tell(call, QN_Q0412, two ? GAP : -1,
                "rc, the waist's radius, makes one sheet; gap, half the distance of the vertices, two", NULL,
                two ? "'rc' and 'gap' are both given" : "'rc' or 'gap' is missing");
  }
  qn_num inner = two ? qn_arg_number(call, GAP, QN_NUM_ZERO) : qn_arg_number(call, RC, QN_NUM_ZERO);
  qn_arg_truth(call, CENTER);
  qn_arg_positive(call, H, "the height", h);
  qn_arg_positive(call, qn_arg_given(call, D) ? D : R, "the radius", r);
  qn_arg_not_negative(call, two ? GAP : RC, two ? "the gap" : "the waist", inner);
  if (two && !call->bad && !call->empty && !call->not_finite && qn_num_cmp(ctx, inner, h) >= 0) {
    qn_arg_tell(call, QN_Q0508, GAP, "the vertices would lie beyond the caps", NULL, "'gap' must be less than 'h'");
  }
  put(&l, h);
  put(&l, r);
  put(&l, inner);
  round_only(call);
  return placed(call, two ? QN_HYPERBOLOID2 : QN_HYPERBOLOID1, &l, BASE, AXIS);
}

uint32_t qn_make_saddle(qn_call *call) {
  enum { A, B, CENTER };
  qn_num n[2] = {qn_arg_number(call, A, QN_NUM_ONE), qn_arg_number(call, B, QN_NUM_ONE)};
  qn_arg_truth(call, CENTER);
  qn_arg_positive(call, A, "'a'", n[0]);
  qn_arg_positive(call, B, "'b'", n[1]);
  return qn_call_leaf(call, QN_SADDLE, n, 2);
}

uint32_t qn_make_quadric(qn_call *call) {
  enum { COEFFICIENTS, MATRIX, CENTER };
  qn_ctx *ctx = &call->ev->ctx;
  qn_num q[10] = {QN_NUM_ZERO};
  qn_arg_truth(call, CENTER);
  if (qn_arg_given(call, COEFFICIENTS)) {
    qn_arg_vector(call, COEFFICIENTS, 10, 10, 0, q);
    if (qn_arg_given(call, MATRIX)) {
      qn_arg_tell(call, QN_Q0408, MATRIX, "the ten coefficients are given too", "leave one out", "the matrix is ignored");
    }
  } else if (qn_arg_given(call, MATRIX)) {
    qn_value v = call->value[MATRIX];
    qn_num m[16];
    int good = v.kind == QN_V_VECTOR && v.count == 4;
    for (size_t i = 0; good && i < 4; i++) {
      good = v.u.items[i].kind == QN_V_VECTOR && v.u.items[i].count == 4;
      for (size_t j = 0; good && j < 4; j++) {
        m[4 * i + j] = QN_NUM_ZERO;
        good = qn_arg_item(call, MATRIX, v.u.items[i].u.items[j], &m[4 * i + j]) != 0;
      }
    }
    if (!good && v.kind != QN_V_BAD) {
      qn_arg_tell(call, QN_Q0406, MATRIX, NULL, NULL, "'matrix' must be 4 rows of 4 numbers");
    } else if (!good) {
      call->bad = 1;
    } else if (!call->not_finite) {
      for (size_t i = 0; i < 4; i++) {
        for (size_t j = 0; j < i; j++) {
          if (!call->bad && qn_num_cmp(ctx, m[4 * i + j], m[4 * j + i]) != 0) {
            qn_arg_tell(call, QN_Q0509, MATRIX, NULL, NULL, "'matrix' is not symmetric: rows %zu and %zu differ", j + 1, i + 1);
          }
        }
      }
      static const uint8_t from[10] = {0, 5, 10, 1, 2, 6, 3, 7, 11, 15};
      for (size_t i = 0; i < 10; i++) {
        q[i] = i < 3 || i == 9 ? m[from[i]] : qn_num_mul(ctx, qn_num_from_int(ctx, 2), m[from[i]]);
      }
    }
  } else {
    qn_arg_tell(call, QN_Q0412, -1, NULL, "write quadric([A, B, C, D, E, F, G, H, I, J])", "the coefficients are missing");
  }
  return qn_call_leaf(call, QN_QUADRIC, q, 10);
}

uint32_t qn_make_halfspace(qn_call *call) {
  enum { N, D, CENTER };
  qn_num n[4] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ONE, QN_NUM_ZERO};
  qn_arg_vector(call, N, 3, 3, 0, n);
  n[3] = qn_arg_number(call, D, QN_NUM_ZERO);
  qn_arg_truth(call, CENTER);
  if (!call->bad && qn_num_is_zero(n[0]) && qn_num_is_zero(n[1]) && qn_num_is_zero(n[2])) {
    qn_arg_tell(call, QN_Q0508, N, "the zero vector has no direction", NULL, "the normal 'n' must not be zero");
  }
  return qn_call_leaf(call, QN_HALFSPACE, n, 4);
}

uint32_t qn_make_superquadric(qn_call *call) {
  enum { R, E, N, CENTER };
  qn_num n[5] = {QN_NUM_ONE, QN_NUM_ONE, QN_NUM_ONE, QN_NUM_ONE, QN_NUM_ONE};
  qn_arg_vector(call, R, 3, 3, 1, n);
  n[3] = qn_arg_number(call, E, QN_NUM_ONE);
  n[4] = qn_arg_number(call, N, QN_NUM_ONE);
  qn_arg_truth(call, CENTER);
  for (int i = 0; i < 3; i++) {
    qn_arg_positive(call, R, "a semi-axis", n[i]);
  }
  for (int i = 3; i < 5 && !call->bad; i++) {
    if (qn_num_sign(n[i]) < 0) {
      qn_arg_tell(call, QN_Q0508, i == 3 ? E : N, "0 makes edges, 1 is round, 2 is flat", NULL, "an exponent must not be negative");
    }
  }
  return qn_call_leaf(call, QN_SUPERQUADRIC, n, 5);
}
