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

/* The half-spaces of a primitive's node before its map. */
static qn_form_result own_forms(qn_ctx *ctx, const quoin_model *model, uint32_t node, qn_half_form **halves, size_t *count) {
  const qn_node *n = &model->nodes[node];
  const qn_num *numbers = model->numbers + n->number0;
  size_t args = n->numbers - (n->flags & QN_NODE_PLACED ? 6 : 0);
  qn_placement placement;
  if (n->flags & QN_NODE_PLACED) {
    memcpy(placement.base, numbers + args, sizeof placement.base);
    memcpy(placement.axis, numbers + args + 3, sizeof placement.axis);
  }
  return qn_prims[n->payload].form(ctx, numbers, args, n->flags & QN_NODE_PLACED ? &placement : NULL, halves, count);
}

qn_form_result qn_node_forms(qn_ctx *ctx, const quoin_model *model, uint32_t node, const qn_num map[12], qn_half_form **halves,
                             size_t *count) {
  qn_form_result result = own_forms(ctx, model, node, halves, count);
  if (result == QN_FORM_OK && !qn_map_forms(ctx, map, *halves, *count)) {
    result = QN_FORM_EMPTY;
  }
  return result;
}

int qn_node_half(qn_ctx *ctx, qn_kept_maps *maps, const quoin_model *model, const qn_snaps *snaps, uint32_t node, uint32_t half, qn_half_form *out,
                 uint64_t *spared) {
  const qn_snap *s = NULL;
  size_t n = qn_snaps_of(snaps, node, &s), i = 0, count;
  while (i < n && s[i].half != half && s[i].half != QN_SNAP_GONE) {
    i++;
  }
  if (i < n && s[i].half == QN_SNAP_GONE) {
    return 0;
  }
  int moved = i < n;
  uint32_t from = moved ? s[i].to_node : node, index = moved ? s[i].to_half : half;
  qn_half_form *halves;
  qn_num map[12];
  *spared = qn_path_map(ctx, maps, from, map);
  if (ctx->failed != QUOIN_OK || own_forms(ctx, model, from, &halves, &count) != QN_FORM_OK || index >= count || !qn_map_forms(ctx, map, halves + index, 1)) {
    return 0;
  }
  *out = halves[index];
  if (moved && s[i].turn < 0) {
    qn_half_turn_over(ctx, out);
  }
  return ctx->failed == QUOIN_OK;
}

qn_form_result qn_scene_leaf_forms(const quoin_scene *scene, uint32_t leaf, qn_ctx *ctx, qn_half_form **halves, size_t *count) {
  qn_num map[12];
  uint32_t node = scene->leaves[leaf].node;
  qn_path_map(ctx, scene->kept_maps, node, map);
  qn_form_result result = qn_node_forms(ctx, scene->model, node, map, halves, count);
  if (result == QN_FORM_OK && !qn_snaps_apply(ctx, scene->kept_maps, scene->model, scene->snaps, node, *halves, *count)) {
    result = QN_FORM_EMPTY;
  }
  return result;
}

int qn_scene_make_exact(const quoin_scene *scene, uint32_t surface, qn_ctx *ctx, qn_exact_surface *out) {
  const qn_surface *s = &scene->surfaces[surface];
  const qn_leaf *leaf = &scene->leaves[s->leaf];
  qn_half_form half;
  uint64_t spared = 0;
  int side;
  ctx->max_bits = QN_MAX_SCENE_BITS;
  ctx->max_effort = QN_MAX_SCENE_EFFORT;
  if (!qn_node_half(ctx, scene->kept_maps, scene->model, scene->snaps, leaf->node, s->half - leaf->half0, &half, &spared)) {
    return 0;
  }
  qn_exact_of(ctx, &half, out, &side);
  /* as if no map had been kept: whether a surface is beyond the limit is not to hang on who asked before */
  if (ctx->failed == QUOIN_OK && spared > ctx->max_effort - ctx->effort) {
    ctx->failed = QUOIN_E_LIMIT;
  }
  return ctx->failed == QUOIN_OK;
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
  const qn_exact_surface *exact = s->kind == QN_SUPER_BODY ? NULL : atomic_load_explicit(&s->exact, memory_order_acquire);
  if (!exact && s->kind != QN_SUPER_BODY) {
    qn_ctx ctx;
    qn_exact_surface form = {.beyond = 1};
    qn_ctx_init(&ctx, scene->mem);
    if (qn_scene_make_exact(scene, surface, &ctx, &form)) {
      exact = qn_scene_publish(scene, surface, &form, made);
    } else if (ctx.failed == QUOIN_E_LIMIT) { /* kept too: what took so long once is not tried again */
      form = (qn_exact_surface){.beyond = 1};
      exact = qn_scene_publish(scene, surface, &form, NULL);
    }
    qn_ctx_free(&ctx);
  }
  return exact && !exact->beyond ? exact : NULL;
}

quoin_status qn_scene_no_exact(const quoin_scene *scene, uint32_t surface) {
  const qn_surface *s = &scene->surfaces[surface];
  const qn_exact_surface *exact = s->kind == QN_SUPER_BODY ? NULL : atomic_load_explicit(&s->exact, memory_order_acquire);
  return exact && exact->beyond ? QUOIN_E_LIMIT : QUOIN_E_MEMORY;
}
