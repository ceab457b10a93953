/* Exact half-spaces of leaves for comparing: the composed maps of nodes with several children are remembered. */
#include "scene/compile.h"
#include "scene/identity.h"

#include "base/limits.h"
#include "scene/snap.h"

#include <string.h>

typedef struct qn_known_map { uint32_t node; qn_num map[12]; } qn_known_map;

static size_t slot_of(uint32_t node, size_t slots) {
  return (size_t)((uint64_t)node * 0x9E3779B97F4A7C15u >> 20) & (slots - 1);
}

static const qn_known_map *recall(const qn_forms *f, uint32_t node) {
  if (f->known_slot_count == 0) {
    return NULL;
  }
  for (size_t i = slot_of(node, f->known_slot_count); f->known_slots[i]; i = (i + 1) & (f->known_slot_count - 1)) {
    if (f->known[f->known_slots[i] - 1].node == node) {
      return &f->known[f->known_slots[i] - 1];
    }
  }
  return NULL;
}

static int remember(qn_forms *f, uint32_t node, const qn_num map[12]) {
  qn_mem *mem = f->b->mem;
  if (!qn_grow(mem, &f->known, &f->known_capacity, f->known_count + 1)) {
    return 0;
  }
  if (2 * (f->known_count + 1) > f->known_slot_count) {
    size_t n = f->known_slot_count ? 2 * f->known_slot_count : 64;
    uint32_t *slots = qn_alloc_zeroed(mem, n * sizeof *slots);
    if (!slots) {
      return 0;
    }
    qn_free(mem, f->known_slots, f->known_slot_count * sizeof *slots);
    f->known_slots = slots;
    f->known_slot_count = n;
    for (size_t i = 0; i < f->known_count; i++) {
      size_t at = slot_of(f->known[i].node, n);
      while (slots[at]) {
        at = (at + 1) & (n - 1);
      }
      slots[at] = (uint32_t)i + 1;
    }
  }
  qn_known_map *k = &f->known[f->known_count++];
  k->node = node;
  for (int i = 0; i < 12; i++) {
    k->map[i] = qn_num_copy(&f->maps, map[i]);
  }
  size_t at = slot_of(node, f->known_slot_count);
  while (f->known_slots[at]) {
    at = (at + 1) & (f->known_slot_count - 1);
  }
  f->known_slots[at] = (uint32_t)f->known_count;
  return f->maps.failed == QUOIN_OK;
}

/* The map of the leaf's node into ctx. */
static quoin_status map_of(qn_forms *f, qn_ctx *ctx, uint32_t node, qn_num map[12]) {
  const quoin_model *model = f->b->model;
  size_t depth = 0;
  const qn_known_map *start = NULL;
  for (uint32_t n = model->nodes[node].parent; n != QN_NO_NODE && !start; n = model->nodes[n].parent) {
    start = recall(f, n);
    if (!start) {
      if (!qn_grow(f->b->mem, &f->path, &f->path_capacity, depth + 1)) {
        return QUOIN_E_MEMORY;
      }
      f->path[depth++] = n;
    }
  }
  for (int i = 0; i < 12; i++) {
    map[i] = start ? start->map[i] : i % 5 == 0 ? QN_NUM_ONE : QN_NUM_ZERO;
  }
  qn_mark mark = qn_arena_mark(&ctx->arena);
  while (depth && ctx->failed == QUOIN_OK) {
    uint32_t n = f->path[--depth];
    if (qn_is_transform(&model->nodes[n])) {
      qn_num inner[12], composed[12];
      qn_solid_map(ctx, model, n, inner);
      qn_map_compose(ctx, map, inner, composed);
      memcpy(map, composed, sizeof composed);
      if (depth % QN_COMPACT_STEPS == 0 && depth) {
        qn_map_compact(ctx, mark, map);
      }
    }
    if (model->nodes[n].first != model->nodes[n].last && !remember(f, n, map)) {
      return QUOIN_E_MEMORY;
    }
  }
  return ctx->failed;
}

static void clear(qn_ctx *ctx) {
  qn_arena_release(&ctx->arena, (qn_mark){NULL, NULL});
}

static quoin_status forms_of(qn_forms *f, qn_ctx *ctx, uint32_t leaf, qn_half_form **forms) {
  qn_num map[12];
  size_t count;
  uint32_t node = f->b->scene->leaves[leaf].node;
  clear(ctx);
  quoin_status status = map_of(f, ctx, node, map);
  if (status == QUOIN_OK) {
    if (qn_node_forms(ctx, f->b->model, node, map, forms, &count) == QN_FORM_OK) {
      qn_snaps_apply(ctx, f->b->model, f->b->scene->snaps, node, *forms, count);
    }
    status = ctx->failed;
  }
  return status;
}

quoin_status qn_forms_half(qn_forms *f, uint32_t leaf, uint32_t half, const qn_half_form **form) {
  quoin_status status = QUOIN_OK;
  if (f->leaf != leaf) {
    f->leaf = QN_NO_LEAF;
    status = forms_of(f, &f->ctx, leaf, &f->forms);
    f->leaf = status == QUOIN_OK ? leaf : QN_NO_LEAF;
  }
  if (status == QUOIN_OK) {
    *form = &f->forms[half - f->b->scene->leaves[leaf].half0];
  }
  return status;
}

quoin_status qn_forms_other(qn_forms *f, uint32_t leaf, qn_half_form **forms) {
  return forms_of(f, &f->other, leaf, forms);
}

void qn_forms_init(qn_forms *f, const qn_building *b) {
  *f = (qn_forms){.b = b, .leaf = QN_NO_LEAF};
  qn_ctx *all[] = {&f->ctx, &f->other, &f->maps};
  for (size_t i = 0; i < 3; i++) {
    qn_ctx_init(all[i], b->mem);
    all[i]->max_bits = QN_MAX_SCENE_BITS;
    /* A leaf under four irrational turns, compared with its equal, takes 60,000; five nodes of it may take ten times that. */
    all[i]->max_effort = QN_MAX_SCENE_EFFORT + (uint64_t)4 * QN_SCENE_EFFORT_PER_NODE * b->model->node_count;
  }
}

void qn_forms_free(qn_forms *f) {
  if (!f->b) {
    return;
  }
  qn_mem *mem = f->b->mem;
  qn_free(mem, f->known, f->known_capacity * sizeof *f->known);
  qn_free(mem, f->known_slots, f->known_slot_count * sizeof *f->known_slots);
  qn_free(mem, f->path, f->path_capacity * sizeof *f->path);
  qn_ctx_free(&f->ctx);
  qn_ctx_free(&f->other);
  qn_ctx_free(&f->maps);
}
