/* The cells next to a line that is the edge of pairs of planes (quadrics that factor, singular all along the line), of planes and of curved surfaces that hold it too: a sort by
   angle as in around_fan.c, of all sheets at once.

   Derivation. Next to the line a pair is its own leading form, vᵗHv with H d = 0, d along the line; a surface that is smooth there is a graph over its tangent plane with a slope as
   small as one likes. So all are sheets of one fan. Directions across the line are u + s v, s from -infinity to infinity for half a turn and the same turned for the other half, with
   v one in which no leading form is zero; leading forms are then polynomials in s, linear of smooth surfaces and quadratic of pairs, and the sheets are their roots: rational or not, no
   pair need be split. A linear form changes sign from one half turn to the other, a quadratic one does not. Sheets at one angle change sides together where they are planes; where a curved
   surface is among them the order beside it is of second degree, and the list is left to around_cells.c. */
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

/* Whether sheets stand at angles of their own, but for planes. */
static int apart(qn_cells *cells, size_t count, const qn_walk_mark *marks) {
  for (size_t first = 0, end; first < count && !qn_cells_done(cells); first = end) {
    end = qn_walk_group(cells->ctx, count, marks, first);
    for (size_t k = first; end - first > 1 && k < end; k++) {
      const qn_germ *germ = &cells->germs[marks[k].tag];
      if (!germ->plane && !germ->singular) {
        return 0;
      }
    }
  }
  return 1;
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
  if (!quads || !marks) {
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
  if (qn_cells_done(cells) || !apart(cells, count, marks)) {
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
    for (size_t first = 0, end; first < count && !qn_cells_done(cells); first = end) {
      end = qn_walk_group(ctx, count, marks, first);
      for (size_t k = first; k < end; k++) {
        cells->signs[marks[k].tag] = (int8_t)-cells->signs[marks[k].tag];
      }
      qn_cells_give(cells);
    }
  }
  return 1;
}
