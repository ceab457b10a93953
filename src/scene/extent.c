/* The exact extent of a leaf along the world's axes, where its map takes axes to axes: planes, bodies and corners bound the box, each
   bound rounded outward once. What is not rational, or not aligned, keeps the box that support functions gave.

   Legend: a body is s0 X^2 + s1 Y^2 + s2 Z^2 + 2 l Z + k <= 0, where X, Y, Z are rows of the local point, here each about one axis. With
   g(Z) = -(s2 Z^2 + 2 l Z + k), X^2 <= g(Z) / s0 for s0, s1 > 0. The greatest g over the slab of Z between the caps is at an end of it,
   since g is convex (cone, hyperboloids: s2 < 0) or linear (paraboloid: s2 = 0); where s0, s1, s2 >= 0 and l = 0 it is -k, and Y and Z are
   bounded likewise. */
#include "scene/compile.h"

#include <math.h>

/* Draws the box in to an exact bound along a world axis, rounded outward. */
static void draw_in(qn_ctx *ctx, qn_leaf *leaf, int axis, qn_num at, int is_max) {
  double v = qn_num_to_double(at);
  if (!isfinite(v)) {
    return;
  }
  int below = qn_num_cmp(ctx, qn_num_from_double(ctx, v), at);
  v = is_max && below < 0 ? nextafter(v, INFINITY) : !is_max && below > 0 ? nextafter(v, -INFINITY) : v;
  if (is_max && v < leaf->max[axis]) {
    leaf->max[axis] = v;
  } else if (!is_max && v > leaf->min[axis]) {
    leaf->min[axis] = v;
  }
}

int qn_row_axis(const qn_num row[4]) {
  int axis = -1;
  for (int k = 0; k < 3; k++) {
    if (!qn_num_is_zero(row[k])) {
      if (axis >= 0) {
        return -1;
      }
      axis = k;
    }
  }
  return axis;
}

int qn_world_place(qn_maker *m, const qn_num row[4], int axis, qn_num shift, qn_num *at) {
  const qn_composed *map = &m->maps.stack[m->maps.count - 1];
  qn_ctx *ctx = &m->maps.scratch;
  int world = 0;
  while (qn_num_is_zero(map->exact[4 * world + axis])) {
    world++;
  }
  *at = qn_num_div(ctx, qn_num_sub(ctx, shift, row[3]), row[axis]);
  *at = qn_num_add(ctx, qn_num_mul(ctx, map->exact[4 * world + axis], *at), map->exact[4 * world + 3]);
  return world;
}

void qn_bound_by_plane(qn_maker *m, qn_leaf *leaf, int world, qn_num at, int is_max) {
  if (!qn_num_is_rounded(at)) {
    draw_in(&m->maps.scratch, leaf, world, at, is_max);
  }
}

/* The row's value lies between lo and hi: rational numbers, or left alone. */
static void bound_row(qn_maker *m, qn_leaf *leaf, const qn_num row[4], qn_num lo, qn_num hi) {
  qn_ctx *ctx = &m->maps.scratch;
  int axis = qn_row_axis(row);
  if (axis < 0 || qn_num_is_rounded(lo) || qn_num_is_rounded(hi)) {
    return;
  }
  qn_num one, other;
  int world = qn_world_place(m, row, axis, hi, &one);
  qn_world_place(m, row, axis, lo, &other);
  if (qn_num_is_rounded(one) || qn_num_is_rounded(other)) {
    return;
  }
  int greater = qn_num_cmp(ctx, one, other) > 0;
  draw_in(ctx, leaf, world, greater ? one : other, 1);
  draw_in(ctx, leaf, world, greater ? other : one, 0);
}

/* X^2 <= square */
static void bound_square(qn_maker *m, qn_leaf *leaf, const qn_num row[4], qn_num square) {
  qn_ctx *ctx = &m->maps.scratch;
  if (!qn_num_is_rounded(square) && qn_num_sign(square) >= 0) {
    qn_num root = qn_num_sqrt(ctx, square);
    bound_row(m, leaf, row, qn_num_neg(ctx, root), root);
  }
}

/* The ends of a row's values between the leaf's planes; bit 0: *lo is there, bit 1: *hi is. */
static int slab(qn_maker *m, const qn_num row[4], qn_num *lo, qn_num *hi) {
  const qn_local *l = &m->local;
  qn_ctx *ctx = &m->maps.scratch;
  int axis = qn_row_axis(row), ends = 0;
  for (size_t h = 0; axis >= 0 && h < l->count; h++) {
    const qn_num *plane = l->halves[h].row[0];
    if (l->halves[h].kind != QN_PLANE || qn_row_axis(plane) != axis) {
      continue;
    }
    qn_num place = qn_num_neg(ctx, qn_num_div(ctx, plane[3], plane[axis]));
    qn_num value = qn_num_add(ctx, qn_num_mul(ctx, row[axis], place), row[3]);
    int is_hi = (qn_num_sign(plane[axis]) > 0) == (qn_num_sign(row[axis]) > 0);
    qn_num *end = is_hi ? hi : lo;
    if (!(ends >> is_hi & 1) || (qn_num_cmp(ctx, value, *end) < 0) == is_hi) {
      *end = value;
    }
    ends |= 1 << is_hi;
  }
  return ends;
}

static qn_num g_at(qn_ctx *ctx, const qn_half_form *h, qn_num Z) {
  qn_num square = qn_num_mul(ctx, h->s[2], qn_num_mul(ctx, Z, Z));
  qn_num line = qn_num_mul(ctx, qn_num_from_int(ctx, 2), qn_num_mul(ctx, h->l, Z));
  return qn_num_neg(ctx, qn_num_add(ctx, qn_num_add(ctx, square, line), h->k));
}

static void bound_by_body(qn_maker *m, const qn_half_form *h, qn_leaf *leaf) {
  qn_ctx *ctx = &m->maps.scratch;
  int s[3], l = qn_num_sign(h->l);
  for (int i = 0; i < 3; i++) {
    s[i] = qn_num_sign(h->s[i]);
  }
  if (s[0] >= 0 && s[1] >= 0 && s[2] >= 0 && l == 0 && qn_num_sign(h->k) < 0) {
    for (int i = 0; i < 3; i++) {
      if (s[i]) {
        bound_square(m, leaf, h->row[i], qn_num_div(ctx, qn_num_neg(ctx, h->k), h->s[i]));
      }
    }
    return;
  }
  if (s[0] <= 0 || s[1] <= 0 || s[2] > 0) {
    return;
  }
  qn_num lo = QN_NUM_ZERO, hi = QN_NUM_ZERO, most;
  int ends = slab(m, h->row[2], &lo, &hi);
  if (s[2] == 0 && l != 0) { /* g = -2 l Z - k >= 0 bounds Z on the one side, and is greatest on the other */
    qn_num vertex = qn_num_neg(ctx, qn_num_div(ctx, h->k, qn_num_mul(ctx, qn_num_from_int(ctx, 2), h->l)));
    if (l < 0 ? !(ends & 2) : !(ends & 1)) {
      return;
    }
    most = g_at(ctx, h, l < 0 ? hi : lo);
    bound_row(m, leaf, h->row[2], l < 0 ? vertex : lo, l < 0 ? hi : vertex);
  } else if (ends == 3) {
    qn_num a = g_at(ctx, h, lo), b = g_at(ctx, h, hi);
    most = qn_num_cmp(ctx, a, b) > 0 ? a : b;
  } else {
    return;
  }
  bound_square(m, leaf, h->row[0], qn_num_div(ctx, most, h->s[0]));
  bound_square(m, leaf, h->row[1], qn_num_div(ctx, most, h->s[1]));
}

/* Local coordinate `axis` lies between lo and hi. */
static void bound_axis(qn_maker *m, qn_leaf *leaf, int axis, qn_num lo, qn_num hi) {
  qn_num row[4] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO};
  row[axis] = QN_NUM_ONE;
  bound_row(m, leaf, row, lo, hi);
}

/* Solids of planes: their corners. */
static void bound_by_corners(qn_maker *m, qn_leaf *leaf) {
  qn_ctx *ctx = &m->maps.scratch;
  const qn_node *node = &m->model->nodes[leaf->node];
  const qn_num *args = m->model->numbers + node->number0;
  int64_t planes, corners, sides;
  switch (leaf->prim) {
  case QN_WEDGE:
    for (int k = 0; k < 3; k++) {
      qn_num lo = qn_num_is_zero(args[3]) ? QN_NUM_ZERO : qn_num_neg(ctx, qn_num_div(ctx, args[k], qn_num_from_int(ctx, 2)));
      bound_axis(m, leaf, k, lo, qn_num_add(ctx, lo, args[k]));
    }
    break;
  case QN_POLYHEDRON: /* n, m, n planes, m corners */
    if (qn_num_is_integer(args[0], &planes) && qn_num_is_integer(args[1], &corners) && corners > 0) {
      const qn_num *corner = args + 2 + 4 * planes;
      for (int k = 0; k < 3; k++) {
        qn_num lo = corner[k], hi = corner[k];
        for (int64_t i = 1; i < corners; i++) {
          qn_num x = corner[3 * i + k];
          lo = qn_num_cmp(ctx, x, lo) < 0 ? x : lo;
          hi = qn_num_cmp(ctx, x, hi) > 0 ? x : hi;
        }
        bound_axis(m, leaf, k, lo, hi);
      }
    }
    break;
  case QN_PRISM: /* n, h, r1, r2; a corner on +x, so one on -x for even n, and on y and -y too for multiples of 4 */
    if (!m->local.placed && qn_num_is_integer(args[0], &sides) && sides % 2 == 0) {
      qn_num r = qn_num_cmp(ctx, args[2], args[3]) > 0 ? args[2] : args[3], minus = qn_num_neg(ctx, r);
      bound_axis(m, leaf, 0, minus, r);
      if (sides % 4 == 0) {
        bound_axis(m, leaf, 1, minus, r);
      }
    }
    break;
  default:
    break;
  }
}

void qn_leaf_extent(qn_maker *m, qn_leaf *leaf) {
  qn_ctx *ctx = &m->maps.scratch;
  if (!leaf->bounded || !m->maps.stack[m->maps.count - 1].aligned) {
    return;
  }
  qn_mark mark = qn_arena_mark(&ctx->arena);
  for (size_t h = 0; h < m->local.count; h++) {
    if (m->local.halves[h].kind == QN_QUADRIC_BODY) {
      bound_by_body(m, &m->local.halves[h], leaf);
    }
  }
  if (m->local.node != QN_NO_NODE) { /* else faces were moved, and corners with them */
    bound_by_corners(m, leaf);
  }
  qn_arena_release(&ctx->arena, mark);
}
