/* The cells next to a point: the surfaces sorted into classes, the cells of their leading forms, the record of signs.

   Derivation. Seen from P, a direction v in which no leading form vanishes lies in one cell, and its signs are those of
   the leading forms. Every other cell hugs a direction in which some leading form vanishes:
   - the plane T of a class (around_tangent.c). Every first-order cell that has a part of T in its closure is met there too:
     walking the circle of T's directions, between the places where other leading forms vanish, and stepping off to either side
     lists all cells of an arrangement of planes, for each of them has such a side;
   - a cone of a singular surface. A part of a cone that no T crosses is one side of it whole, in one of the two opposite
     directions, so that plus and minus a vector inside it and one outside it name its cells (the axes of H are such);
   - a direction in which several leading forms vanish (tangent.c).
   With two cones or more through P their signs against one another are left open, but for what forms prove (forbid). */
#include "base/limits.h"
#include "ray/around_cells.h"

#include <string.h>

int qn_cells_done(const qn_cells *cells) {
  return cells->stop || cells->ctx->failed != QUOIN_OK;
}

int qn_cells_spend(qn_cells *cells, size_t count, unsigned each) {
  cells->work += (uint64_t)count * each * cells->unit;
  if (cells->work > QN_CELLS_WORK) {
    cells->stop = cells->gave_up = 1;
  }
  return !qn_cells_done(cells);
}

/* How much longer products take of numbers as long as these. */
static uint64_t unit_of(size_t n, const qn_germ *germs) {
  size_t bits = 0;
  for (size_t i = 0; i < n; i++) {
    for (int k = 0; k < 3; k++) {
      size_t b = qn_int_bits(germs[i].g[k].v);
      bits = b > bits ? b : bits;
    }
    for (int k = 0; k < 6; k++) {
      size_t b = qn_int_bits(germs[i].h[k].v);
      bits = b > bits ? b : bits;
    }
  }
  const uint64_t words = bits / 256; /* of 256 bits: four limbs */
  return 1 + words * words / 4;
}

static int forbidden(const qn_cells *cells, const int8_t *signs) {
  for (size_t i = 0; i < cells->forbid_count; i++) {
    const qn_forbid *f = &cells->forbids[i];
    if (signs[f->a] == f->sign_a && signs[f->b] == f->sign_b) {
      return 1;
    }
  }
  return 0;
}

void qn_cells_give(qn_cells *cells) {
  size_t open = 0;
  for (size_t i = 0; i < cells->n; i++) {
    cells->full[i] = cells->signs[i];
    if (cells->signs[i] == 0) {
      cells->free[open++] = (uint32_t)i;
      cells->full[i] = -1;
    }
  }
  (void)qn_cells_spend(cells, cells->n, 1);
  if (open > QN_CELLS_OPEN) {
    cells->stop = cells->gave_up = 1;
  }
  while (!qn_cells_done(cells)) {
    if (open != 0) {
      (void)qn_cells_spend(cells, cells->forbid_count / 16, 1);
    }
    if (open == 0 || !forbidden(cells, cells->full)) {
      cells->stop = cells->emit(cells->user, cells->full) != 0;
    }
    size_t k = 0; /* the next filling: a binary count, -1 for 0 */
    while (k < open && cells->full[cells->free[k]] > 0) {
      cells->full[cells->free[k++]] = -1;
    }
    if (k == open) {
      return;
    }
    cells->full[cells->free[k]] = 1;
  }
}

void qn_class_difference(qn_ctx *ctx, const qn_germ *a, const qn_germ *b, qn_xint d[6]) {
  for (int k = 0; k < 6; k++) {
    qn_xint x = qn_x_mul(ctx, b->size, a->h[k]), y = qn_x_mul(ctx, a->size, b->h[k]);
    x = a->orient < 0 ? qn_x_neg(x) : x;
    d[k] = b->orient < 0 ? qn_x_add(ctx, x, y) : qn_x_sub(ctx, x, y);
  }
}

/* --- sorting into classes ------------------------------------------------------------------------------------------ */

static void find_singular(qn_cells *cells) {
  for (size_t i = 0; i < cells->n; i++) {
    qn_germ *germ = &cells->germs[i];
    germ->class = UINT32_MAX;
    germ->orient = 1;
    germ->singular = !germ->opaque && qn_x_sign(germ->g[0]) == 0 && qn_x_sign(germ->g[1]) == 0 && qn_x_sign(germ->g[2]) == 0;
    cells->singular_count += germ->singular;
  }
}

static void classify(qn_cells *cells) {
  for (size_t i = 0; i < cells->n && qn_cells_spend(cells, 1 + cells->class_count, QN_WORK_PARALLEL); i++) {
    qn_germ *germ = &cells->germs[i];
    if (germ->opaque || germ->singular) {
      continue;
    }
    qn_mark mark = qn_arena_mark(&cells->ctx->arena);
    size_t c = 0;
    while (c < cells->class_count && !qn_parallel_x(cells->ctx, cells->germs[cells->classes[c].first].g, germ->g)) {
      c++;
    }
    qn_arena_release(&cells->ctx->arena, mark);
    qn_class *class = &cells->classes[c];
    if (c == cells->class_count) {
      cells->class_count++;
      *class = (qn_class){.first = (uint32_t)i};
      size_t most = 0;
      for (uint32_t k = 0; k < 3; k++) {
        int sign = qn_x_sign(germ->g[k]);
        class->normal[k] = sign == 0 ? (qn_int){0, NULL} : germ->g[k].v;
        if (qn_int_bits(class->normal[k]) > most) {
          most = qn_int_bits(class->normal[k]);
          class->axis = k;
        }
      }
    }
    class->members++;
    int mine = qn_x_sign(germ->g[class->axis]), first = qn_x_sign(cells->germs[class->first].g[class->axis]);
    germ->class = (uint32_t)c;
    germ->orient = (int8_t)(mine == first ? 1 : -1);
    germ->size = mine < 0 ? qn_x_neg(germ->g[class->axis]) : germ->g[class->axis];
  }
}

static void forbid(qn_cells *cells, size_t a, int sign_a, size_t b, int sign_b) {
  cells->forbids[cells->forbid_count++] = (qn_forbid){(uint32_t)a, (uint32_t)b, (int8_t)sign_a, (int8_t)sign_b};
}

/* Two surfaces of one class: with qa, qb oriented alike and scaled to one gradient, qa - qb = uᵗDu exactly. D >= 0 means
   qa >= qb, so qa < 0 < qb is nowhere; D <= 0 the reverse. */
static void forbid_in_class(qn_cells *cells, size_t a, size_t b) {
  const qn_germ *x = &cells->germs[a], *y = &cells->germs[b];
  qn_xint d[6];
  qn_class_difference(cells->ctx, x, y, d);
  int definite = qn_form_definite(cells->ctx, d);
  if (definite == 1 || definite == 2) {
    forbid(cells, a, -x->orient, b, y->orient);
  }
  if (definite == -1 || definite == 2) {
    forbid(cells, a, x->orient, b, -y->orient);
  }
}

/* Two cones: if s A - t B >= 0 for some s, t > 0, then A < 0 < B is nowhere (the easy half of the S-lemma); and so
   with the signs of A and B turned. s and t are tried from pairs of entries, which finds cones about one axis. */
static void forbid_cones(qn_cells *cells, size_t a, size_t b) {
  qn_ctx *ctx = cells->ctx;
  const qn_germ *x = &cells->germs[a], *y = &cells->germs[b];
  int found[2][2] = {{0, 0}, {0, 0}};
  for (int k = 0; k < 6; k++) {
    int sx = qn_x_sign(x->h[k]), sy = qn_x_sign(y->h[k]);
    if (sx == 0 || sy == 0) {
      continue;
    }
    /* |y_k| A -+ |x_k| B, and its signs: e A - f B >= 0 for e, f = +-1. */
    qn_xint s = sy < 0 ? qn_x_neg(y->h[k]) : y->h[k], t = sx < 0 ? qn_x_neg(x->h[k]) : x->h[k], d[6];
    for (int minus = 0; minus < 2; minus++) {
      for (int i = 0; i < 6; i++) {
        qn_xint p = qn_x_mul(ctx, s, x->h[i]), q = qn_x_mul(ctx, t, y->h[i]);
        d[i] = minus ? qn_x_sub(ctx, p, q) : qn_x_add(ctx, p, q);
      }
      int definite = qn_form_definite(ctx, d);
      for (int e = -1; e <= 1; e += 2) {
        int f = minus ? e : -e; /* e (sA -+ tB) = e s A - f t B */
        if ((definite == e || definite == 2) && !found[e > 0][f > 0]) {
          found[e > 0][f > 0] = 1;
          forbid(cells, a, -e, b, f); /* e A < 0 < f B */
        }
      }
    }
  }
}

static void find_forbids(qn_cells *cells) {
  qn_mark mark = qn_arena_mark(&cells->ctx->arena);
  for (size_t a = 0; a < cells->n; a++) {
    for (size_t b = a + 1; b < cells->n; b++) {
      const qn_germ *x = &cells->germs[a], *y = &cells->germs[b];
      if (x->singular && y->singular) {
        forbid_cones(cells, a, b);
      } else if (x->class == y->class && x->class != UINT32_MAX) {
        forbid_in_class(cells, a, b);
      }
      qn_arena_release(&cells->ctx->arena, mark);
    }
  }
}

static size_t count_pairs(const qn_cells *cells) {
  size_t pairs = cells->singular_count * (cells->singular_count + 1) / 2;
  for (size_t c = 0; c < cells->class_count; c++) {
    pairs += (size_t)cells->classes[c].members * (cells->classes[c].members - 1) / 2;
  }
  return pairs;
}

/* --- a direction, and two more against ties ------------------------------------------------------------------------ */

/* The sign of the leading form on v0 + e v1 + e^2 v2, e small: its first coefficient that is not zero. */
static int flag_sign(qn_ctx *ctx, const qn_germ *germ, const qn_int (*v)[3]) {
  if (!germ->singular) {
    for (int k = 0; k < 3; k++) {
      int sign = qn_x_sign(qn_dot_x(ctx, germ->g, v[k]));
      if (sign != 0) {
        return sign;
      }
    }
    return 0;
  }
  const qn_xint *h = germ->h;
  for (int power = 0; power <= 4; power++) {
    qn_xint sum = qn_x((qn_int){0, NULL});
    for (int i = 0; i < 3; i++) {
      int j = power - i;
      if (j >= i && j < 3) {
        qn_xint term = qn_form_x(ctx, h, v[i], v[j]);
        sum = qn_x_add(ctx, sum, i == j ? term : qn_x_scale(ctx, term, 2));
      }
    }
    int sign = qn_x_sign(sum);
    if (sign != 0) {
      return sign;
    }
  }
  return 0;
}

/* The cell of the flag (axes[k], the two others), in the direction `way` (1 or -1) of the first. */
static void give_flag(qn_cells *cells, qn_int axes[3][3], int k, int way) {
  qn_int flag[3][3];
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      qn_int x = axes[(k + i) % 3][j];
      flag[i][j] = i == 0 && way < 0 ? qn_int_neg(x) : x;
    }
  }
  for (size_t i = 0; i < cells->n; i++) {
    cells->signs[i] = 0;
    if (!cells->germs[i].opaque && !(cells->germs[i].singular && cells->singular_count > 1)) {
      cells->signs[i] = (int8_t)flag_sign(cells->ctx, &cells->germs[i], (const qn_int(*)[3])flag);
    }
  }
  qn_cells_give(cells);
}

/* The cells that a cone has away from all planes of classes. */
static void give_cone(qn_cells *cells, size_t cone) {
  qn_int axes[3][3];
  int signs[3];
  qn_form_axes(cells->ctx, cells->germs[cone].h, axes, signs);
  for (int k = 0; k < 3; k++) {
    for (int way = -1; way <= 1; way += 2) {
      give_flag(cells, axes, k, way);
    }
  }
}

/* All leading forms are independent linear ones, so every combination is a cell. */
static int independent(qn_cells *cells) {
  if (cells->singular_count != 0) {
    return 0;
  }
  for (size_t c = 0; c < cells->class_count; c++) {
    if (cells->classes[c].members != 1) {
      return 0;
    }
  }
  if (cells->class_count < 3) {
    return 1;
  }
  if (cells->class_count > 3) {
    return 0;
  }
  const qn_germ *germs = cells->germs;
  const qn_class *classes = cells->classes;
  qn_xint across[3];
  qn_cross_x(cells->ctx, germs[classes[1].first].g, germs[classes[2].first].g, across);
  return qn_x_sign(qn_product_x(cells->ctx, germs[classes[0].first].g, across)) != 0;
}

/* Some cells, in which the leading forms have these signs: where answers differ, they differ in these mostly, and no more are asked for. */
static void give_some(qn_cells *cells) {
  static const int8_t flags[4][3][3] = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}, {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, {{3, 5, 7}, {7, -3, 2}, {1, 2, -9}}};
  for (int f = 0; f < 4; f++) {
    for (int way = -1; way <= 1; way += 2) {
      qn_mark mark = qn_arena_mark(&cells->ctx->arena);
      qn_int flag[3][3];
      int known = 1;
      for (int k = 0; k < 9; k++) {
        flag[k / 3][k % 3] = qn_int_from(cells->ctx, way * flags[f][k / 3][k % 3]);
      }
      for (size_t i = 0; i < cells->n && known; i++) {
        cells->full[i] = (int8_t)flag_sign(cells->ctx, &cells->germs[i], (const qn_int(*)[3])flag);
        known = cells->full[i] != 0;
      }
      qn_arena_release(&cells->ctx->arena, mark);
      if (known && qn_cells_spend(cells, cells->n, 2)) {
        cells->stop = cells->emit(cells->user, cells->full) != 0;
      }
      if (!known || qn_cells_done(cells)) {
        return;
      }
    }
  }
}

static void list(qn_cells *cells, const qn_int *line) {
  enum { MANY = 16 }; /* few are sorted first: most often they are independent */
  qn_ctx *ctx = cells->ctx;
  const size_t n = cells->n;
  cells->signs = qn_arena_take(&ctx->arena, 2 * n + 1);
  cells->order = qn_arena_take(&ctx->arena, (2 * n + 1) * sizeof *cells->order);
  cells->classes = qn_arena_take(&ctx->arena, (n + 1) * sizeof *cells->classes);
  if (!cells->signs || !cells->order || !cells->classes) {
    ctx->failed = QUOIN_E_MEMORY;
    return;
  }
  cells->full = cells->signs + n;
  cells->free = cells->order + n;
  memset(cells->signs, 0, 2 * n + 1);
  find_singular(cells);
  if (n > MANY) {
    give_some(cells);
  }
  if (qn_cells_done(cells) || (line && qn_cells_sheets(cells, line))) {
    return;
  }
  classify(cells);
  if (qn_cells_done(cells)) {
    return;
  }
  if (independent(cells)) {
    qn_cells_give(cells);
    return;
  }
  if (n <= MANY) {
    give_some(cells);
  }
  if (qn_cells_done(cells) || !qn_cells_spend(cells, count_pairs(cells), QN_WORK_DEFINITE)) {
    return;
  }
  cells->forbids = qn_arena_take(&ctx->arena, (4 * count_pairs(cells) + 1) * sizeof *cells->forbids);
  if (!cells->forbids) {
    ctx->failed = QUOIN_E_MEMORY;
    return;
  }
  find_forbids(cells);
  for (size_t i = 0; i < n && !qn_cells_done(cells); i++) {
    if (cells->germs[i].singular) {
      give_cone(cells, i);
    }
  }
  for (uint32_t c = 0; c < cells->class_count && !qn_cells_done(cells); c++) {
    qn_mark mark = qn_arena_mark(&ctx->arena);
    qn_cells_circle(cells, c);
    qn_arena_release(&ctx->arena, mark);
  }
}

int qn_cells_list(qn_ctx *ctx, size_t n, qn_germ *germs, const qn_int *line, int (*emit)(void *user, const int8_t *signs), void *user) {
  qn_cells cells = {.ctx = ctx, .n = n, .germs = germs, .emit = emit, .user = user, .unit = unit_of(n, germs)};
  if (qn_cells_fan(ctx, n, germs, line, emit, user) || ctx->failed != QUOIN_OK) {
    (void)qn_ctx_spend(ctx, n * (size_t)(cells.unit < 4096 ? cells.unit : 4096), QN_EFFORT_CELL * QN_WORK_FAN);
    return ctx->failed == QUOIN_OK;
  }
  list(&cells, line);
  (void)qn_ctx_spend(ctx, cells.work < QN_CELLS_WORK ? (size_t)cells.work : QN_CELLS_WORK, QN_EFFORT_CELL); /* what was too much is not done */
  if (line && cells.work > QN_CELLS_WORK && ctx->failed == QUOIN_OK) {
    ctx->failed = QUOIN_E_LIMIT; /* a point may be undecided, a stretch may not */
  }
  return !cells.gave_up;
}
