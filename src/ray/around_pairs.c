/* The cells next to a line that is the edge of pairs of planes (quadrics that factor, singular all along the line), of planes and of curved surfaces that hold it too: a sort by
   angle as in around_fan.c, of all sheets at once.

   Derivation. Next to the line a pair is its own leading form, vᵗHv with H d = 0, d along the line; a surface that is smooth there is a graph over its tangent plane with a slope as
   small as one likes. So all are sheets of one fan. Directions across the line are u + s v, s from -infinity to infinity for half a turn and the same turned for the other half, with
   v one in which no leading form is zero; leading forms are then polynomials in s, linear of smooth surfaces and quadratic of pairs, and the sheets are their roots: rational or not, no
   pair need be split. A linear form changes sign from one half turn to the other, a quadratic one does not.

   Sheets at one angle lie in one plane T to first order. Where a curved surface is among them, T is its tangent plane, with the normal g and e = d x g across the line; on the place
   y e + z m, m.g > 0, a smooth surface 2 g_i.w + wᵗH_i w = 0 has z = -y^2 eᵗH_i e / (2 g_i.m), and a plane of a pair z = 0. These heights order them; y^2 is the same on either
   side, so that the turn meets them in one order here and in the other half a turn later. Planes of one height are one plane; where a curved surface has the height of another sheet,
   the list is left to around_cells.c. */
#include "ray/around_cells.h"

/* The line along which the pair is singular: two independent rows of H lie across it. */
static int edge_of(qn_ctx *ctx, const qn_xint h[6], qn_int d[3]) {
  const qn_xint rows[3][3] = {{h[0], h[3], h[4]}, {h[3], h[1], h[5]}, {h[4], h[5], h[2]}};
  for (int i = 0; i < 3; i++) {
    qn_xint line[3];
    int zero = 1;
    qn_cross_x(ctx, rows[i], rows[(i + 1) % 3], line);
    for (int j = 0; j < 3; j++) {
      d[j] = qn_settled(line[j]);
      zero &= d[j].n == 0;
    }
    if (!zero) {
      return 1;
    }
  }
  return 0;
}

static int holds_line(qn_ctx *ctx, const qn_germ *germ, const qn_int d[3]) {
  if (germ->opaque || !germ->singular) {
    return !germ->opaque && qn_x_sign(qn_dot_x(ctx, germ->g, d)) == 0;
  }
  qn_xint image[3];
  qn_form_apply(ctx, germ->h, d, image);
  return qn_x_sign(image[0]) == 0 && qn_x_sign(image[1]) == 0 && qn_x_sign(image[2]) == 0;
}

/* Two directions across the line; no leading form is zero along v. Of n forms each is zero along two directions at most. */
static int across(qn_cells *cells, const qn_int d[3], qn_int u[3], qn_int v[3]) {
  qn_ctx *ctx = cells->ctx;
  const qn_int zero = {0, NULL}, one = qn_int_from(ctx, 1);
  int k = 0;
  while (d[k].n == 0) {
    k++;
  }
  u[k] = v[k] = zero;
  u[(k + 1) % 3] = zero, u[(k + 2) % 3] = v[(k + 1) % 3] = one;
  for (size_t step = 0; step <= 2 * cells->n && qn_cells_spend(cells, cells->n, 1); step++) {
    v[(k + 2) % 3] = qn_int_from(ctx, (int64_t)step);
    size_t i = 0;
    while (i < cells->n && qn_germ_sign(ctx, &cells->germs[i], v) != 0) {
      i++;
    }
    if (i == cells->n) {
      return 1;
    }
  }
  return 0;
}

/* The roots of a germ's leading form at u + s v. */
static size_t mark_sheets(qn_ctx *ctx, const qn_germ *germ, uint32_t tag, const qn_int u[3], const qn_int v[3], qn_quad *quad, qn_walk_mark *marks) {
  if (germ->singular) {
    qn_quad_make(ctx, qn_form_x(ctx, germ->h, v, v), qn_form_x(ctx, germ->h, u, v), qn_form_x(ctx, germ->h, u, u), quad);
  } else {
    qn_quad_make(ctx, qn_x((qn_int){0, NULL}), qn_dot_x(ctx, germ->g, v), qn_x_shl(ctx, qn_dot_x(ctx, germ->g, u), 1), quad);
  }
  const qn_quad_shape shape = qn_quad_kind(quad);
  const int roots = shape == QN_QUAD_TWO ? 2 : shape == QN_QUAD_LINEAR;
  for (int i = 0; i < roots; i++) {
    marks[i] = (qn_walk_mark){{quad, i}, tag};
  }
  return (size_t)roots;
}

static int is_curved(const qn_germ *germ) { return !germ->plane && !germ->singular; }

/* Sheets at one angle, of which some are curved: T's normal and its axis, e across the line, and which way the turn goes there. */
typedef struct touching {
  qn_cells *cells;
  qn_int e[3];
  int axis, way;
} touching;

static void touch(touching *t, const qn_germ *curved, const qn_int d[3], const qn_int v[3]) {
  qn_int g[3];
  t->axis = 0;
  for (int i = 0; i < 3; i++) {
    g[i] = qn_settled(curved->g[i]);
    t->axis = qn_int_bits(g[i]) > qn_int_bits(g[t->axis]) ? i : t->axis;
  }
  qn_cross_int(t->cells->ctx, d, g, t->e);
  t->way = qn_x_sign(qn_dot_x(t->cells->ctx, curved->g, v)) * qn_int_sign(g[t->axis]);
}

/* The order in which a turn meets two of them, in the first half turn. */
static int cmp_heights(const touching *t, const qn_walk_mark *x, const qn_walk_mark *y) {
  qn_ctx *ctx = t->cells->ctx;
  const qn_germ *germs[2] = {&t->cells->germs[x->tag], &t->cells->germs[y->tag]};
  qn_xint bend[2], size[2];
  int signs = -t->way;
  for (int i = 0; i < 2; i++) {
    const int flat = germs[i]->singular || germs[i]->plane;
    bend[i] = flat ? qn_x((qn_int){0, NULL}) : qn_form_x(ctx, germs[i]->h, t->e, t->e);
    size[i] = flat ? qn_x(qn_int_from(ctx, 1)) : germs[i]->g[t->axis];
    signs *= qn_x_sign(size[i]);
  }
  return signs * qn_x_sign(qn_x_sub(ctx, qn_x_mul(ctx, bend[0], size[1]), qn_x_mul(ctx, bend[1], size[0])));
}

/* Orders the sheets at one angle; joined: at one place with the one before. 0: that is not known. */
static int order_group(qn_cells *cells, const qn_int d[3], const qn_int v[3], size_t n, qn_walk_mark *marks, uint8_t *joined) {
  touching t = {.cells = cells};
  size_t curved = 0;
  while (curved < n && !is_curved(&cells->germs[marks[curved].tag])) {
    curved++;
  }
  if (curved < n && n > 1) {
    touch(&t, &cells->germs[marks[curved].tag], d, v);
    for (size_t i = 1; i < n && qn_cells_spend(cells, i, QN_WORK_PARALLEL); i++) {
      const qn_walk_mark moved = marks[i];
      size_t k = i;
      for (; k > 0 && cmp_heights(&t, &marks[k - 1], &moved) > 0; k--) {
        marks[k] = marks[k - 1];
      }
      marks[k] = moved;
    }
  }
  joined[0] = 0;
  for (size_t i = 1; i < n; i++) {
    joined[i] = curved == n || cmp_heights(&t, &marks[i - 1], &marks[i]) == 0;
    if (joined[i] && (is_curved(&cells->germs[marks[i - 1].tag]) || is_curved(&cells->germs[marks[i].tag]))) {
      return 0;
    }
  }
  return 1;
}

static void cross_sheets(qn_cells *cells, size_t first, size_t end, const qn_walk_mark *marks, const uint8_t *joined, int half) {
  for (size_t i = 0; i < end - first && !qn_cells_done(cells); i++) {
    const size_t k = half ? end - 1 - i : first + i;
    cells->signs[marks[k].tag] = (int8_t)-cells->signs[marks[k].tag];
    if (half ? !joined[k] : k + 1 == end || !joined[k + 1]) {
      qn_cells_give(cells);
    }
  }
}

int qn_cells_pairs(qn_cells *cells) {
  qn_ctx *ctx = cells->ctx;
  const size_t n = cells->n;
  qn_int d[3], u[3], v[3];
  size_t pair = 0, count = 0;
  while (pair < n && !cells->germs[pair].singular) {
    pair++;
  }
  if (pair == n || !edge_of(ctx, cells->germs[pair].h, d)) {
    return 0;
  }
  for (size_t i = 0; i < n; i++) {
    if (!holds_line(ctx, &cells->germs[i], d)) {
      return 0;
    }
  }
  qn_quad *quads = qn_arena_take(&ctx->arena, n * sizeof *quads);
  qn_walk_mark *marks = qn_arena_take(&ctx->arena, 2 * n * sizeof *marks);
  size_t *ends = qn_arena_take(&ctx->arena, 2 * n * sizeof *ends); /* of groups at one angle */
  uint8_t *joined = qn_arena_take(&ctx->arena, 2 * n);
  if (!quads || !marks || !ends || !joined) {
    ctx->failed = QUOIN_E_MEMORY;
    return 0;
  }
  if (!across(cells, d, u, v)) {
    return 0;
  }
  for (size_t i = 0; i < n; i++) {
    count += mark_sheets(ctx, &cells->germs[i], (uint32_t)i, u, v, &quads[i], marks + count);
  }
  qn_walk_sort(cells, count, marks);
  size_t groups = 0;
  for (size_t first = 0; first < count && !qn_cells_done(cells); first = ends[groups++]) {
    ends[groups] = qn_walk_group(ctx, count, marks, first);
    if (!order_group(cells, d, v, ends[groups] - first, marks + first, joined + first)) {
      return 0;
    }
  }
  if (qn_cells_done(cells)) {
    return 0;
  }
  for (size_t i = 0; i < n; i++) {
    const int sign = qn_germ_sign(ctx, &cells->germs[i], v);
    cells->signs[i] = (int8_t)(cells->germs[i].singular ? sign : -sign);
  }
  if (count == 0) { /* each pair is the line alone */
    qn_cells_give(cells);
  }
  for (int half = 0; half < 2; half++) {
    for (size_t k = 0; k < groups; k++) {
      cross_sheets(cells, k ? ends[k - 1] : 0, ends[k], marks, joined, half);
    }
  }
  return 1;
}
