/* Maps from a node's frame to the world, exactly, for whoever asks for one leaf: kept where paths part, so that thousands of leaves under one
   tower of transforms compose the tower once.

   A map is composed from the root down, whatever of it was kept, so its numbers (rounded ones too) do not depend on who asked before. Kept maps
   hang in lists by a hash of their node; a list only grows, at its head, so readers need no lock. */
#include "scene/compile.h"

#include <string.h>

typedef struct qn_kept_map qn_kept_map;
struct qn_kept_map {
  qn_kept_map *next;
  size_t size;     /* of the whole block */
  uint64_t effort; /* of composing it from the root */
  uint32_t node;
  qn_num map[12];  /* their fractions follow, then the limbs of these */
};

struct qn_kept_maps {
  const quoin_model *model;
  qn_mem *mem;
  size_t lists;    /* a power of two */
  _Atomic(qn_kept_map *) list[];
};

enum { STEPS = 16 }; /* nodes walked past a kept map before another is kept, where no transform is among them */

static size_t limbs_of(qn_int a) {
  return (size_t)(a.n < 0 ? -a.n : a.n);
}

static qn_int copy_int(qn_int a, mp_limb_t **at) {
  size_t n = limbs_of(a);
  if (n) {
    memcpy(*at, a.d, n * sizeof **at);
    a.d = *at;
    *at += n;
  }
  return a;
}

static const qn_kept_map *recall(const qn_kept_maps *maps, uint32_t node) {
  const qn_kept_map *m = atomic_load_explicit(&maps->list[(uint32_t)(node * UINT32_C(0x9E3779B1)) >> 8 & (maps->lists - 1)], memory_order_acquire);
  while (m && m->node != node) {
    m = m->next;
  }
  return m;
}

/* Without memory for it a map is not kept. */
static void keep(qn_kept_maps *maps, uint32_t node, const qn_num map[12], uint64_t effort) {
  size_t limbs = 0, big = 0;
  for (int i = 0; i < 12; i++) {
    if (map[i].kind != QN_NUM_SMALL) {
      big++;
      limbs += limbs_of(map[i].u.big->num) + limbs_of(map[i].u.big->den);
    }
  }
  size_t size = sizeof(qn_kept_map) + big * sizeof(qn_rat) + limbs * sizeof(mp_limb_t);
  qn_kept_map *m = qn_alloc(maps->mem, size);
  if (!m) {
    return;
  }
  m->size = size;
  m->effort = effort;
  m->node = node;
  qn_rat *rat = (qn_rat *)(void *)(m + 1);
  mp_limb_t *at = (mp_limb_t *)(void *)(rat + big);
  for (int i = 0; i < 12; i++) {
    m->map[i] = map[i];
    if (map[i].kind != QN_NUM_SMALL) {
      *rat = (qn_rat){copy_int(map[i].u.big->num, &at), copy_int(map[i].u.big->den, &at)};
      m->map[i].u.big = rat++;
    }
  }
  _Atomic(qn_kept_map *) *list = &maps->list[(uint32_t)(node * UINT32_C(0x9E3779B1)) >> 8 & (maps->lists - 1)];
  m->next = atomic_load_explicit(list, memory_order_relaxed);
  while (!atomic_compare_exchange_weak_explicit(list, &m->next, m, memory_order_release, memory_order_relaxed)) {
  }
}

qn_kept_maps *qn_kept_maps_new(const quoin_model *model, qn_mem *mem) {
  size_t lists = 16;
  while (lists < model->node_count / 16 && lists < (size_t)1 << 16) {
    lists *= 2;
  }
  qn_kept_maps *maps = qn_alloc(mem, sizeof *maps + lists * sizeof *maps->list);
  if (maps) {
    *maps = (qn_kept_maps){.model = model, .mem = mem, .lists = lists};
    for (size_t i = 0; i < lists; i++) {
      atomic_init(&maps->list[i], NULL);
    }
  }
  return maps;
}

void qn_kept_maps_free(qn_kept_maps *maps) {
  if (maps) {
    for (size_t i = 0; i < maps->lists; i++) {
      for (qn_kept_map *m = atomic_load_explicit(&maps->list[i], memory_order_relaxed), *next; m; m = next) {
        next = m->next;
        qn_free(maps->mem, m, m->size);
      }
    }
    qn_free(maps->mem, maps, sizeof *maps + maps->lists * sizeof *maps->list);
  }
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

uint64_t qn_path_map(qn_ctx *ctx, qn_kept_maps *maps, uint32_t node, qn_num map[12]) {
  const qn_node *nodes = maps->model->nodes;
  const qn_kept_map *start = NULL;
  size_t depth = 0, since = 0, composed_maps = 0;
  uint32_t up = qn_above(maps->model, node);
  for (; up != QN_NO_NODE && !start; up = qn_above(maps->model, up)) {
    start = nodes[up].first != nodes[up].last ? recall(maps, up) : NULL;
    depth += !start;
  }
  for (int i = 0; i < 12; i++) {
    map[i] = start ? start->map[i] : i % 5 == 0 ? QN_NUM_ONE : QN_NUM_ZERO;
  }
  uint64_t spared = start ? start->effort : 0, before = ctx->effort;
  uint32_t *path = qn_arena_take(&ctx->arena, (depth + 1) * sizeof *path);
  if (!path) {
    ctx->failed = QUOIN_E_MEMORY;
    return spared;
  }
  up = qn_above(maps->model, node);
  for (size_t i = 0; i < depth; i++, up = qn_above(maps->model, up)) {
    path[i] = up;
  }
  qn_mark mark = qn_arena_mark(&ctx->arena);
  while (depth && ctx->failed == QUOIN_OK) {
    uint32_t n = path[--depth];
    since++;
    if (qn_is_transform(&nodes[n])) {
      qn_num inner[12], composed[12];
      qn_solid_map(ctx, maps->model, n, inner);
      qn_map_compose(ctx, map, inner, composed);
      memcpy(map, composed, sizeof composed);
      since = STEPS;
      if (++composed_maps % QN_COMPACT_STEPS == 0) {
        qn_map_compact(ctx, mark, map);
      }
    }
    if (since >= STEPS && nodes[n].first != nodes[n].last && ctx->failed == QUOIN_OK) {
      keep(maps, n, map, spared + (ctx->effort - before));
      since = 0;
    }
  }
  return spared;
}
