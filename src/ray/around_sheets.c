/* The cells next to a line that planes, curved surfaces and pairs of planes hold (quadrics that factor, singular all along their edge), whatever touches along it: a sort by angle
   as in around_fan.c, of all sheets at once.

   Derivation. Next to the line a pair is its own leading form, vᵗHv with H d = 0, d along the line; a surface that is smooth there is a graph over its tangent plane with a slope as
   small as one likes. So all are sheets of one fan. Directions across the line are u + s v, s from -infinity to infinity for half a turn and the same turned for the other half, with
   v one in which no leading form is zero; leading forms are then polynomials in s, linear of smooth surfaces and quadratic of pairs, and the sheets are their roots: rational or not, no
   pair need be split. A linear form changes sign from one half turn to the other, a quadratic one does not.

   Sheets at one angle lie in one plane T to first order. Where a curved surface is among them, T is its tangent plane, with the normal g and e = d x g across the line. At the place
   y e + z g a smooth surface 2 g_i.w + wᵗH_i w = 0, g_i = a_i g, has z = -y^2 eᵗH_i e / (2 a_i |g|^2) + ..., and a plane of a pair z = 0. These heights order them. Two that are one plane
   there, or hold it, are of one height all along. Two curved ones of one height touch so all along the line (else a turn is there, ray/turn.c): a_1 : a_2 is constant, and a_2 q_1 - a_1 q_2
   = wᵗDw with Dd = 0 and eᵗDe = 0. On the second sheet that is 2 y z eᵗDg + z^2 gᵗDg, z like y^2: of third degree, with another sign on the other side of the line, or of fourth. If
   both are zero the surfaces are one. */
#include "ray/around_cells.h"

#include <string.h>

/* Whether it is singular all along the line, and not at an apex there. */
static int is_edge(qn_ctx *ctx, const qn_germ *germ, const qn_int d[3]) {
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

/* Sheets at one angle, of which some are curved: T's normal and its axis, e across the line; which way the turn goes there, and on which side along e it is. */
typedef struct touching {
  qn_cells *cells;
  qn_int g[3], e[3];
  int axis, way, side;
} touching;

static void touch(touching *t, const qn_germ *curved, const qn_int d[3], const qn_int v[3], int half) {
  qn_ctx *ctx = t->cells->ctx;
  t->axis = 0;
  for (int i = 0; i < 3; i++) {
    t->g[i] = qn_settled(curved->g[i]);
    t->axis = qn_int_bits(t->g[i]) > qn_int_bits(t->g[t->axis]) ? i : t->axis;
  }
  qn_cross_int(ctx, d, t->g, t->e);
  int k = 0;
  while (d[k].n == 0) {
    k++;
  }
  t->way = qn_x_sign(qn_dot_x(ctx, curved->g, v)) * (half ? -1 : 1);
  t->side = t->way * qn_int_sign(d[k]); /* (u + s v).e where g.(u + s v) = 0 has the sign of -(g.v) d.(u x v), and u x v = -1 along axis k (across) */
}

/* A sheet as heights are compared: eᵗHe and a, times one positive number. */
typedef struct height { qn_xint bend, size; int flat, sign; } height;

static height height_of(const touching *t, const qn_germ *germ) {
  height h = {.bend = qn_x((qn_int){0, NULL}), .size = qn_x(qn_int_from(t->cells->ctx, 1)), .flat = 1, .sign = 1};
  if (!germ->singular) {
    h.size = qn_int_sign(t->g[t->axis]) < 0 ? qn_x_neg(germ->g[t->axis]) : germ->g[t->axis];
    h.sign = qn_x_sign(h.size);
    h.bend = qn_form_x(t->cells->ctx, germ->h, t->e, t->e);
    h.flat = qn_x_sign(h.bend) == 0;
  }
  return h;
}

/* Which of two curved sheets of one height is higher. */
static int cmp_beyond(const touching *t, const qn_germ *x, const height *hx, const qn_germ *y, const height *hy) {
  qn_ctx *ctx = t->cells->ctx;
  qn_xint d[6];
  for (int k = 0; k < 6; k++) {
    d[k] = qn_x_sub(ctx, qn_x_mul(ctx, hy->size, x->h[k]), qn_x_mul(ctx, hx->size, y->h[k]));
  }
  const int up = -qn_x_sign(hy->bend) * hy->sign; /* of z on the second sheet */
  int sign = qn_x_sign(qn_form_x(ctx, d, t->e, t->g)) * up * t->side;
  if (sign == 0) {
    sign = qn_x_sign(qn_form_x(ctx, d, t->g, t->g));
  }
  return -sign * hx->sign * hy->sign;
}

/* The order in which the turn meets two of them. */
static int cmp_heights(const touching *t, const qn_walk_mark *x, const qn_walk_mark *y) {
  qn_ctx *ctx = t->cells->ctx;
  const qn_germ *gx = &t->cells->germs[x->tag], *gy = &t->cells->germs[y->tag];
  const height hx = height_of(t, gx), hy = height_of(t, gy);
  const int higher = -qn_x_sign(qn_x_sub(ctx, qn_x_mul(ctx, hx.bend, hy.size), qn_x_mul(ctx, hy.bend, hx.size))) * hx.sign * hy.sign;
  return t->way * (higher != 0 || hx.flat || hy.flat ? higher : cmp_beyond(t, gx, &hx, gy, &hy));
}

/* Orders the sheets at one angle; joined: at one place with the one before. */
static void order_group(qn_cells *cells, const qn_int d[3], const qn_int v[3], int half, size_t n, qn_walk_mark *marks, uint8_t *joined) {
  touching t = {.cells = cells};
  size_t curved = 0;
  while (curved < n && (cells->germs[marks[curved].tag].plane || cells->germs[marks[curved].tag].singular)) {
    curved++;
  }
  memset(joined, curved == n, n);
  joined[0] = 0;
  if (curved == n || n == 1) {
    return;
  }
  touch(&t, &cells->germs[marks[curved].tag], d, v, half);
  const qn_mark memory = qn_arena_mark(&cells->ctx->arena);
  for (size_t i = 1; i < n && qn_cells_spend(cells, 16, QN_WORK_ORDER); i++) { /* by halving: places are cheap to move */
    const qn_walk_mark moved = marks[i];
    size_t low = 0, high = i;
    while (low < high) {
      const size_t middle = (low + high) / 2;
      cmp_heights(&t, &marks[middle], &moved) > 0 ? (high = middle) : (low = middle + 1);
    }
    memmove(marks + low + 1, marks + low, (i - low) * sizeof *marks);
    marks[low] = moved;
    qn_arena_release(&cells->ctx->arena, memory);
  }
  for (size_t i = 1; i < n; i++) {
    joined[i] = cmp_heights(&t, &marks[i - 1], &marks[i]) == 0;
  }
}

static void cross_sheets(qn_cells *cells, size_t n, const qn_walk_mark *marks, const uint8_t *joined) {
  for (size_t k = 0; k < n && !qn_cells_done(cells); k++) {
    cells->signs[marks[k].tag] = (int8_t)-cells->signs[marks[k].tag];
    if (k + 1 == n || !joined[k + 1]) {
      qn_cells_give(cells);
    }
  }
}

int qn_cells_sheets(qn_cells *cells, const qn_int d[3]) {
  qn_ctx *ctx = cells->ctx;
  const size_t n = cells->n;
  qn_int u[3], v[3];
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    if (cells->germs[i].opaque || (cells->germs[i].singular && !is_edge(ctx, &cells->germs[i], d))) {
      return 0;
    }
  }
  qn_quad *quads = qn_arena_take(&ctx->arena, n * sizeof *quads);
  qn_walk_mark *marks = qn_arena_take(&ctx->arena, 2 * n * sizeof *marks);
  uint8_t *joined = qn_arena_take(&ctx->arena, 2 * n);
  if (!quads || !marks || !joined) {
    ctx->failed = QUOIN_E_MEMORY;
    return 0;
  }
  if (!across(cells, d, u, v)) {
    return 0;
  }
  for (size_t i = 0; i < n; i++) {
    count += mark_sheets(ctx, &cells->germs[i], (uint32_t)i, u, v, &quads[i], marks + count);
    const int sign = qn_germ_sign(ctx, &cells->germs[i], v);
    cells->signs[i] = (int8_t)(cells->germs[i].singular ? sign : -sign);
  }
  qn_walk_sort(cells, count, marks);
  if (count == 0) { /* each pair is the line alone */
    qn_cells_give(cells);
  }
  for (int half = 0; half < 2; half++) {
    for (size_t first = 0, end; first < count && !qn_cells_done(cells); first = end) {
      end = qn_walk_group(ctx, count, marks, first);
      order_group(cells, d, v, half, end - first, marks + first, joined);
      cross_sheets(cells, end - first, marks + first, joined);
    }
  }
  return 1;
}
