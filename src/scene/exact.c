/* Exact forms in world coordinates, made from the tree when they are asked for.

   Legend: q = sum_i s_i X_i^2 + 2 l X_2 + k with X_i = r_i.(x, y, z, w); so the coefficient of the product of coordinates a
   and b is sum_i s_i r_ia r_ib, twice that when a and b differ, with l r_2a added to each of the two halves of (a, w) and k to
   w^2. */
#include "scene/compile.h"

#include "base/limits.h"
#include "scene/snap.h"

#include <string.h>

/* --- from rows to a primitive integer form ------------------------------------------------------------------------ */

/* Which coordinates the ten coefficients multiply. */
static const int PAIR[10][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}, {3, 3}};

static void coefficients(qn_ctx *ctx, const qn_half_form *h, qn_num q[10]) {
  const qn_num two = qn_num_from_int(ctx, 2);
  for (int c = 0; c < 10; c++) {
    int a = PAIR[c][0], b = PAIR[c][1];
    if (h->kind == QN_PLANE) {
      q[c] = c < 6 ? QN_NUM_ZERO : h->row[0][c - 6];
      continue;
    }
    qn_num x[6], y[6];
    size_t n = 0;
    for (int i = 0; i < 3; i++) {
      if (!qn_num_is_zero(h->s[i]) && !qn_num_is_zero(h->row[i][a]) && !qn_num_is_zero(h->row[i][b])) {
        x[n] = qn_num_mul(ctx, h->s[i], h->row[i][a]);
        y[n++] = h->row[i][b];
      }
    }
    if (b == 3 && !qn_num_is_zero(h->l)) {
      x[n] = h->l;
      y[n++] = h->row[2][a];
    }
    if (c == 9) { /* here the halves of (w, w) are one: 2 l r_23 + k */
      if (!qn_num_is_zero(h->l)) {
        x[n] = h->l;
        y[n++] = h->row[2][3];
      }
      x[n] = h->k;
      y[n++] = QN_NUM_ONE;
    }
    q[c] = qn_num_dot(ctx, n, x, y);
    if (a != b) {
      q[c] = qn_num_mul(ctx, two, q[c]);
    }
  }
}

void qn_exact_of(qn_ctx *ctx, const qn_half_form *half, qn_exact_surface *out, int *side) {
  qn_num q[10];
  qn_rat r[10];
  *out = (qn_exact_surface){.plane = 1};
  *side = 1;
  coefficients(ctx, half, q);
  qn_int den = qn_int_from(ctx, 1), common = {0, NULL};
  for (int c = 0; c < 10; c++) {
    out->rounded |= qn_num_is_rounded(q[c]) != 0;
    out->plane &= c >= 6 || qn_num_is_zero(q[c]);
    if (!qn_num_is_zero(q[c])) {
      r[c] = qn_num_rat(ctx, q[c]);
      if (ctx->failed != QUOIN_OK) {
        return;
      }
      qn_int g = qn_int_gcd(ctx, den, r[c].den);
      den = qn_int_mul(ctx, den, qn_int_divexact(ctx, r[c].den, g));
    }
  }
  int sign = 0;
  for (int c = 0; c < 10 && ctx->failed == QUOIN_OK; c++) {
    if (!qn_num_is_zero(q[c])) {
      out->q[c] = qn_int_mul(ctx, r[c].num, qn_int_divexact(ctx, den, r[c].den));
      common = qn_int_gcd(ctx, common, out->q[c]);
      sign = sign ? sign : qn_int_sign(out->q[c]);
    }
  }
  *side = sign < 0 ? -1 : 1;
  for (int c = 0; c < 10 && ctx->failed == QUOIN_OK; c++) {
    if (qn_int_sign(out->q[c])) {
      out->q[c] = qn_int_divexact(ctx, out->q[c], common);
      out->q[c] = sign < 0 ? qn_int_neg(out->q[c]) : out->q[c];
    }
  }
  if (ctx->failed != QUOIN_OK) {
    *out = (qn_exact_surface){0};
  }
}

static size_t limbs_of(qn_int a) {
  return (size_t)(a.n < 0 ? -a.n : a.n);
}
static size_t size_of(const qn_exact_surface *e) {
  size_t limbs = 0;
  for (int c = 0; c < 10; c++) {
    limbs += limbs_of(e->q[c]);
  }
  return sizeof *e + limbs * sizeof(mp_limb_t);
}

qn_exact_surface *qn_exact_keep(qn_mem *mem, const qn_exact_surface *from) {
  qn_exact_surface *e = qn_alloc(mem, size_of(from));
  if (e) {
    *e = *from;
    mp_limb_t *at = (mp_limb_t *)(void *)(e + 1);
    for (int c = 0; c < 10; c++) {
      size_t n = limbs_of(from->q[c]);
      if (n) {
        memcpy(at, from->q[c].d, n * sizeof *at);
      }
      e->q[c].d = at;
      at += n;
    }
  }
  return e;
}

void qn_exact_free(qn_mem *mem, qn_exact_surface *exact) {
  if (exact) {
    qn_free(mem, exact, size_of(exact));
  }
}

/* --- the leaf's place in the world --------------------------------------------------------------------------------- */

static int is_transform(const qn_node *n) {
  return n->kind >= QN_NODE_TRANSLATE && n->kind <= QN_NODE_MULTMATRIX;
}

void qn_map_compact(qn_ctx *ctx, qn_mark mark, qn_num map[12]) {
  int small = 1;
  for (int i = 0; i < 12; i++) {
    small &= map[i].kind == QN_NUM_SMALL;
  }
  if (small) {
    qn_arena_release(&ctx->arena, mark);
    return;
  }
  qn_ctx aside;
  qn_num kept[12];
  qn_ctx_init(&aside, ctx->arena.mem);
  for (int i = 0; i < 12; i++) {
    kept[i] = qn_num_copy(&aside, map[i]);
  }
  if (aside.failed == QUOIN_OK) { /* else nothing is gained, and nothing lost */
    qn_arena_release(&ctx->arena, mark);
    for (int i = 0; i < 12; i++) {
      map[i] = qn_num_copy(ctx, kept[i]);
    }
  }
  qn_ctx_free(&aside);
}

void qn_path_map(qn_ctx *ctx, const quoin_model *model, uint32_t node, qn_num map[12]) {
  qn_mark mark = qn_arena_mark(&ctx->arena);
  size_t steps = 0;
  for (int i = 0; i < 12; i++) {
    map[i] = i % 5 == 0 ? QN_NUM_ONE : QN_NUM_ZERO;
  }
  for (uint32_t n = model->nodes[node].parent; n != QN_NO_NODE && ctx->failed == QUOIN_OK; n = model->nodes[n].parent) {
    if (is_transform(&model->nodes[n])) {
      qn_num outer[12], composed[12];
      qn_solid_map(ctx, model, n, outer);
      qn_map_compose(ctx, outer, map, composed);
      memcpy(map, composed, sizeof composed);
      if (++steps % QN_COMPACT_STEPS == 0) {
        qn_map_compact(ctx, mark, map);
      }
    }
  }
}

qn_form_result qn_node_forms(qn_ctx *ctx, const quoin_model *model, uint32_t node, const qn_num map[12], qn_half_form **halves,
                             size_t *count) {
  const qn_node *n = &model->nodes[node];
  const qn_num *numbers = model->numbers + n->number0;
  size_t args = n->numbers - (n->flags & QN_NODE_PLACED ? 6 : 0);
  qn_placement placement;
  if (n->flags & QN_NODE_PLACED) {
    memcpy(placement.base, numbers + args, sizeof placement.base);
    memcpy(placement.axis, numbers + args + 3, sizeof placement.axis);
  }
  qn_form_result result = qn_prims[n->payload].form(ctx, numbers, args, n->flags & QN_NODE_PLACED ? &placement : NULL, halves, count);
  if (result == QN_FORM_OK && !qn_map_forms(ctx, map, *halves, *count)) {
    result = QN_FORM_EMPTY;
  }
  return result;
}

qn_form_result qn_scene_leaf_forms(const quoin_scene *scene, uint32_t leaf, qn_ctx *ctx, qn_half_form **halves, size_t *count) {
  qn_num map[12];
  uint32_t node = scene->leaves[leaf].node;
  qn_path_map(ctx, scene->model, node, map);
  qn_form_result result = qn_node_forms(ctx, scene->model, node, map, halves, count);
  if (result == QN_FORM_OK && !qn_snaps_apply(ctx, scene->model, scene->snaps, node, *halves, *count)) {
    result = QN_FORM_EMPTY;
  }
  return result;
}

const qn_exact_surface *qn_scene_publish(const quoin_scene *scene, uint32_t surface, const qn_exact_surface *form, int *made) {
  qn_exact_surface *mine = qn_exact_keep(scene->mem, form), *there = NULL;
  if (!mine) {
    return NULL;
  }
  if (atomic_compare_exchange_strong_explicit(&scene->surfaces[surface].exact, &there, mine, memory_order_acq_rel,
                                              memory_order_acquire)) {
    if (made) {
      *made = 1;
    }
    return mine;
  }
  qn_exact_free(scene->mem, mine); /* another thread was first; its form is the same */
  return there;
}

const qn_exact_surface *qn_scene_exact(const quoin_scene *scene, uint32_t surface, int *made) {
  const qn_surface *s = &scene->surfaces[surface];
  if (made) {
    *made = 0;
  }
  const qn_exact_surface *exact = atomic_load_explicit(&s->exact, memory_order_acquire);
  if (exact || s->kind == QN_SUPER_BODY) {
    return exact;
  }
  qn_ctx ctx;
  qn_ctx_init(&ctx, scene->mem);
  ctx.max_bits = QN_MAX_SCENE_BITS;
  ctx.max_effort = QN_MAX_SCENE_EFFORT;
  qn_half_form *halves;
  size_t count;
  if (qn_scene_leaf_forms(scene, s->leaf, &ctx, &halves, &count) == QN_FORM_OK && ctx.failed == QUOIN_OK) {
    qn_exact_surface form;
    int side;
    qn_exact_of(&ctx, &halves[s->half - scene->leaves[s->leaf].half0], &form, &side);
    if (ctx.failed == QUOIN_OK) {
      exact = qn_scene_publish(scene, surface, &form, made);
    }
  }
  qn_ctx_free(&ctx);
  return exact;
}
