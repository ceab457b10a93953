/* The side of a point that lies on surfaces: the program asked in every cell next to it (design S6). */
#include "base/limits.h"
#include "ray/around_cells.h"
#include "ray/scratch.h"

#include <stdlib.h>
#include <string.h>

static qn_xint coefficient(const qn_exact_surface *s, int i) {
  return s->rounded && s->q[i].n != 0 ? qn_x_rounded(s->q[i]) : qn_x(s->q[i]);
}

/* sum of q[i] a b over the named coefficients: terms[k] = {coefficient, first, second} with the point's numbers x, y, z, w. */
typedef struct term { int8_t coefficient, first, second, twice; } term;

static qn_xint sum_of(qn_ctx *ctx, const qn_exact_surface *s, const qn_point *p, const term *terms, size_t n) {
  const qn_int v[5] = {p->x[0], p->x[1], p->x[2], p->w, {0, NULL}};
  qn_xint sum = qn_x((qn_int){0, NULL});
  for (size_t i = 0; i < n; i++) {
    const term *t = &terms[i];
    if (s->q[t->coefficient].n == 0) {
      continue;
    }
    qn_xint product = qn_x_mul(ctx, coefficient(s, t->coefficient), qn_x(v[t->first]));
    if (t->second >= 0) {
      product = qn_x_mul(ctx, product, qn_x(v[t->second]));
    }
    sum = qn_x_add(ctx, sum, t->twice ? qn_x_scale(ctx, product, 2) : product);
  }
  return sum;
}

int qn_surface_sign_at(qn_ctx *ctx, const qn_exact_surface *surface, const qn_point *point) {
  static const term quadric[10] = {{0, 0, 0, 0}, {1, 1, 1, 0}, {2, 2, 2, 0}, {3, 0, 1, 0}, {4, 0, 2, 0},
                                   {5, 1, 2, 0}, {6, 0, 3, 0}, {7, 1, 3, 0}, {8, 2, 3, 0}, {9, 3, 3, 0}};
  static const term plane[4] = {{6, 0, -1, 0}, {7, 1, -1, 0}, {8, 2, -1, 0}, {9, 3, -1, 0}};
  return qn_x_sign(surface->plane ? sum_of(ctx, surface, point, plane, 4) : sum_of(ctx, surface, point, quadric, 10));
}

void qn_surface_gradient_at(qn_ctx *ctx, const qn_exact_surface *surface, const qn_point *point, qn_xint g[3]) {
  /* w times the gradient: 2 A x + D y + E z + G w, and so on. */
  static const term rows[3][4] = {{{0, 0, -1, 1}, {3, 1, -1, 0}, {4, 2, -1, 0}, {6, 3, -1, 0}},
                                  {{1, 1, -1, 1}, {3, 0, -1, 0}, {5, 2, -1, 0}, {7, 3, -1, 0}},
                                  {{2, 2, -1, 1}, {4, 0, -1, 0}, {5, 1, -1, 0}, {8, 3, -1, 0}}};
  for (int i = 0; i < 3; i++) {
    g[i] = surface->plane ? coefficient(surface, 6 + i) : sum_of(ctx, surface, point, rows[i], 4);
  }
}

void qn_surface_germ_at(qn_ctx *ctx, const qn_exact_surface *surface, const qn_point *point, qn_germ *germ) {
  *germ = (qn_germ){0};
  qn_surface_gradient_at(ctx, surface, point, germ->g);
  germ->plane = surface->plane;
  for (int k = 0; k < 6; k++) {
    germ->h[k] = surface->plane ? qn_x((qn_int){0, NULL}) : coefficient(surface, k);
    if (k < 3) {
      germ->h[k] = qn_x_scale(ctx, germ->h[k], 2);
    }
  }
}

/* --- the program, in one cell after another ------------------------------------------------------------------------ */

/* A half-space that vanishes at the point, in the order of surfaces. */
typedef struct vanishing { uint32_t surface, leaf; int8_t side; } vanishing; /* leaf: its number among the near ones */

typedef struct asking {
  const quoin_scene *scene;
  qn_scratch *scratch;
  qn_eval *eval;
  const qn_near_leaf *leaves;
  size_t leaf_count;
  vanishing *halves;  /* by surface */
  uint32_t *surfaces; /* each once */
  uint32_t *first;    /* by surface, and one more: of its halves */
  size_t n;           /* surfaces */
  int8_t *signs;      /* by surface: in the program now; 0: none yet, its half-spaces fail */
  uint32_t *failing;  /* by near leaf: its vanishing half-spaces that do not hold now */
  int value;          /* the program's now */
  unsigned seen;      /* 1: outside was met, 2: inside was */
} asking;

static void set_leaf(asking *a, size_t i, int inside) {
  const qn_leaf *leaf = &a->scene->leaves[a->leaves[i].leaf];
  if (leaf->gate != QN_NO_GATE) {
    a->value = qn_eval_change(a->eval, leaf->gate, inside != leaf->negated);
  }
}

/* From one cell to another: what changes with the surfaces whose sides differ. */
static int ask(void *user, const int8_t *signs) {
  asking *a = user;
  size_t looked = 0;
  for (size_t i = 0; i < a->n; i++) {
    if (a->signs[i] == signs[i]) {
      continue;
    }
    for (uint32_t k = a->first[i]; k < a->first[i + 1]; k++) {
      const vanishing *h = &a->halves[k];
      int held = h->side * a->signs[i] < 0, holds = h->side * signs[i] < 0;
      if (holds && !held && --a->failing[h->leaf] == 0) {
        set_leaf(a, h->leaf, 1);
      } else if (held && !holds && a->failing[h->leaf]++ == 0) {
        set_leaf(a, h->leaf, 0);
      }
    }
    a->signs[i] = signs[i];
    looked += a->first[i + 1] - a->first[i];
  }
  a->seen |= a->value ? 2u : 1u;
  return a->seen == 3 || !qn_scratch_spend(a->scratch, looked + a->n / 32, QN_EFFORT_CHANGE);
}

static int by_surface(const void *x, const void *y) {
  const vanishing *a = x, *b = y;
  return a->surface != b->surface ? (a->surface > b->surface) - (a->surface < b->surface) : (a->leaf > b->leaf) - (a->leaf < b->leaf);
}

/* The half-spaces that vanish, by their surfaces. */
static void gather(asking *a, const uint32_t *near_halves) {
  size_t count = 0;
  for (size_t i = 0; i < a->leaf_count; i++) {
    const qn_near_leaf *leaf = &a->leaves[i];
    a->failing[i] = leaf->count;
    for (uint32_t k = leaf->first; k < leaf->first + leaf->count; k++) {
      const qn_half *half = &a->scene->halves[near_halves[k]];
      a->halves[count++] = (vanishing){half->surface, (uint32_t)i, half->side};
    }
  }
  if (count > 1) {
    qsort(a->halves, count, sizeof *a->halves, by_surface);
  }
  for (size_t k = 0; k < count; k++) {
    if (k == 0 || a->halves[k].surface != a->halves[k - 1].surface) {
      a->first[a->n] = (uint32_t)k;
      a->surfaces[a->n++] = a->halves[k].surface;
    }
  }
  a->first[a->n] = (uint32_t)count;
}

static quoin_status ask_around(asking *a, qn_ctx *ctx, qn_counts *counts, const qn_point *point, const qn_int *line) {
  const quoin_scene *scene = a->scene;
  const uint32_t *surfaces = a->surfaces;
  const size_t n = a->n;
  qn_germ *germs = qn_arena_take(&ctx->arena, n * sizeof *germs);
  if (!germs) {
    return QUOIN_E_MEMORY;
  }
  memset(germs, 0, n * sizeof *germs);
  int planes = 1;
  for (size_t i = 0; i < n; i++) {
    uint8_t kind = scene->surfaces[surfaces[i]].kind;
    germs[i].opaque = kind == QN_SUPER_BODY;
    planes &= kind == QN_PLANE;
  }
  if (planes && n <= 2) { /* distinct planes through one point cross: no need of their forms */
    for (int k = 0; k < 1 << n; k++) {
      const int8_t signs[2] = {(int8_t)(k & 1 ? 1 : -1), (int8_t)(k & 2 ? 1 : -1)};
      if (ask(a, signs)) {
        break;
      }
    }
    return QUOIN_OK;
  }
  for (size_t i = 0; i < n; i++) {
    if (!germs[i].opaque) {
      int made = 0;
      const qn_exact_surface *surface = qn_scene_exact(scene, surfaces[i], &made);
      counts->exact_forms += (uint64_t)(made != 0);
      if (!surface) {
        return qn_scene_no_exact(scene, surfaces[i]);
      }
      qn_surface_germ_at(ctx, surface, point, &germs[i]);
    }
  }
  if (!qn_cells_list(ctx, n, germs, line, ask, a)) {
    a->seen = 3;
  }
  (void)qn_scratch_spend(a->scratch, 0, 1); /* the list has */
  return ctx->failed;
}

quoin_status qn_around(const quoin_scene *scene, qn_scratch *scratch, const qn_point *point, const qn_near_leaf *leaves, size_t leaf_count,
                       const uint32_t *near_halves, size_t near_count, int how, quoin_side *out) {
  qn_ctx *ctx = qn_scratch_ctx(scratch);
  qn_eval *eval = qn_scratch_eval(scratch);
  qn_mark mark = qn_arena_mark(&ctx->arena);
  asking a = {.scene = scene, .scratch = scratch, .eval = eval, .leaves = leaves, .leaf_count = leaf_count, .value = eval->value};
  a.halves = qn_arena_take(&ctx->arena, (near_count + 1) * sizeof *a.halves);
  a.surfaces = qn_arena_take(&ctx->arena, (near_count + 1) * sizeof *a.surfaces);
  a.first = qn_arena_take(&ctx->arena, (near_count + 1) * sizeof *a.first);
  a.signs = qn_arena_take(&ctx->arena, near_count + 1);
  a.failing = qn_arena_take(&ctx->arena, (leaf_count + 1) * sizeof *a.failing);
  if (!a.halves || !a.surfaces || !a.first || !a.signs || !a.failing) {
    qn_arena_release(&ctx->arena, mark);
    return QUOIN_E_MEMORY;
  }
  if (!qn_scratch_spend(scratch, leaf_count + near_count, 2 * QN_EFFORT_CHANGE)) {
    qn_arena_release(&ctx->arena, mark);
    return ctx->failed;
  }
  memset(a.signs, 0, near_count + 1);
  gather(&a, near_halves);
  for (size_t i = 0; i < leaf_count; i++) {
    if (leaves[i].count == 0) {
      set_leaf(&a, i, 1);
    }
  }
  quoin_status status = QUOIN_OK;
  if (a.n == 0) {
    a.seen = a.value ? 2u : 1u;
  } else {
    status = ask_around(&a, ctx, qn_scratch_counts(scratch), point, how == QN_AROUND_LINE ? scratch->line->direction : NULL);
  }
  for (size_t i = 0; i < leaf_count && how == QN_AROUND_HELD; i++) {
    if (a.failing[i] == 0) {
      set_leaf(&a, i, 0);
    }
  }
  if (how != QN_AROUND_HELD) {
    qn_eval_reset(eval);
  }
  qn_arena_release(&ctx->arena, mark);
  *out = a.seen == 3 ? QUOIN_BOUNDARY : a.seen == 2 ? QUOIN_INSIDE : QUOIN_OUTSIDE;
  return status;
}
