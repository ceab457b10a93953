/* Leaves made of their nodes, batch by batch, by several threads. Each has its own tools; in a batch it steps from leaf to leaf as
   the walk did, and keeps the maps of the path. */
#include "scene/compile.h"

#include "base/limits.h"
#include "base/thread.h"
#include "scene/snap.h"

#include <string.h>

typedef struct making {
  qn_building *b;
  qn_maker *makers; /* by thread; model null: not begun */
} making;

static quoin_status begin(qn_maker *m, qn_building *b) {
  if (m->model) {
    return QUOIN_OK;
  }
  m->model = b->model;
  m->mem = b->mem;
  m->snaps = b->scene->snaps;
  m->kept_maps = b->scene->kept_maps;
  m->local.node = QN_NO_NODE;
  qn_ctx_init(&m->local.ctx, b->mem);
  m->local.ctx.max_bits = QN_MAX_SCENE_BITS;
  return qn_maps_init(&m->maps, b->model, b->mem);
}

static void end(qn_maker *m) {
  if (m->model) {
    qn_maps_free(&m->maps, m->mem);
    if (m->plain.stack) {
      qn_maps_free(&m->plain, m->mem);
    }
    qn_ctx_free(&m->local.ctx);
    qn_free(m->mem, m->local.rows, m->local.rows_capacity * sizeof *m->local.rows);
    qn_free(m->mem, m->local.args, m->local.args_capacity * sizeof *m->local.args);
    qn_free(m->mem, m->keys.slots, m->keys.slot_count * sizeof *m->keys.slots);
  }
}

/* The maps of the path from the root, or from what is marked with '!', to the node. */
static quoin_status take_path(qn_maker *m, uint32_t node) {
  uint32_t *path = NULL;
  size_t count = 0, capacity = 0;
  quoin_status status = QUOIN_OK;
  while (m->maps.count > 1) {
    qn_maps_pop(&m->maps);
  }
  for (uint32_t n = qn_above(m->model, node); n != QN_NO_NODE && status == QUOIN_OK; n = qn_above(m->model, n)) {
    if (qn_is_transform(&m->model->nodes[n])) {
      if (qn_grow(m->mem, &path, &capacity, count + 1)) {
        path[count++] = n;
      } else {
        status = QUOIN_E_MEMORY;
      }
    }
  }
  while (count && status == QUOIN_OK) {
    status = qn_maps_push(&m->maps, m->mem, path[--count]);
  }
  qn_free(m->mem, path, capacity * sizeof *path);
  return status;
}

/* Steps to the next leaf in the order of the walk; there is one. */
static quoin_status step(qn_maker *m, uint32_t *node) {
  const qn_node *nodes = m->model->nodes;
  uint32_t n = *node;
  for (;;) {
    uint32_t next = qn_present(m->model, nodes[n].next);
    while (next == QN_NO_NODE) {
      n = nodes[n].parent;
      if (qn_is_transform(&nodes[n])) {
        qn_maps_pop(&m->maps);
      }
      next = qn_present(m->model, nodes[n].next);
    }
    n = next;
    for (uint32_t first; (first = qn_present(m->model, nodes[n].first)) != QN_NO_NODE; n = first) {
      if (qn_is_transform(&nodes[n])) {
        quoin_status status = qn_maps_push(&m->maps, m->mem, n);
        if (status != QUOIN_OK) {
          return status;
        }
      }
    }
    if (nodes[n].kind == QN_NODE_LEAF) {
      *node = n;
      return QUOIN_OK;
    }
  }
}

static quoin_status make_leaf(qn_maker *m, uint32_t node, qn_leaf *leaf, qn_form_result *result) {
  quoin_status status = QUOIN_OK;
  const qn_snap *first;
  if (qn_snaps_of(m->snaps, node, &first)) {
    return qn_leaf_snapped(m, node, leaf, result);
  }
  if (qn_leaf_quick(m, node, leaf, result, &status)) {
    return status;
  }
  qn_maps_settle(&m->maps);
  status = m->maps.scratch.failed != QUOIN_OK ? m->maps.scratch.failed : qn_local_make(m, node);
  *result = m->local.result;
  if (status == QUOIN_OK && *result == QN_FORM_OK) {
    leaf->bounded = (uint8_t)qn_leaf_box(m, leaf->min, leaf->max);
    status = qn_leaf_add(m, leaf, result);
  }
  return status;
}

static quoin_status make_batch(void *user, unsigned thread, size_t number) {
  making *all = user;
  qn_building *b = all->b;
  qn_maker *m = &all->makers[thread];
  qn_batch *batch = &b->batches[number];
  quoin_status status = begin(m, b);
  m->batch = batch;
  if (m->keys.slot_count) {
    memset(m->keys.slots, 0, m->keys.slot_count * sizeof *m->keys.slots);
  }
  uint32_t node = b->visits[batch->visit0].node;
  status = status == QUOIN_OK ? take_path(m, node) : status;
  for (size_t i = batch->visit0; i < batch->visit0 + batch->visits && status == QUOIN_OK; i++) {
    const qn_visit *v = &b->visits[i];
    if (i > batch->visit0 && (status = step(m, &node)) != QUOIN_OK) {
      break;
    }
    qn_term *term = &b->terms[v->term];
    qn_leaf *leaf = &b->scene->leaves[i];
    *leaf = (qn_leaf){.node = v->node, .material = v->material, .gate = QN_NO_GATE, .negated = term->negated,
                      .prim = (uint8_t)b->model->nodes[v->node].payload};
    qn_form_result result = QN_FORM_EMPTY;
    status = make_leaf(m, v->node, leaf, &result);
    if (result != QN_FORM_OK) {
      term->kind = (result == QN_FORM_ALL) != (term->negated != 0) ? QN_TERM_TRUE : QN_TERM_FALSE;
    }
  }
  return status;
}

enum { DEEP = 1 << 14 }; /* levels: below them each thread's stack of maps would take 16 MB and more, so one thread does all */

quoin_status qn_leaves_make(qn_building *b) {
  quoin_scene *s = b->scene;
  unsigned threads = b->threads;
  b->leaf_room = b->visit_count;
  s->leaves = qn_alloc(b->mem, b->leaf_room * sizeof *s->leaves);
  making all = {b, qn_alloc_zeroed(b->mem, b->threads * sizeof *all.makers)};
  quoin_status status = QUOIN_E_MEMORY;
  if (s->leaves && all.makers) {
    b->threads = b->deepest > DEEP ? 1 : threads;
    status = qn_parallel_part(b, b->batch_count, make_batch, &all, 0.1, 0.55);
    b->threads = threads;
  }
  for (unsigned i = 0; all.makers && i < b->threads; i++) {
    end(&all.makers[i]);
  }
  qn_free(b->mem, all.makers, b->threads * sizeof *all.makers);
  return status;
}

void qn_batches_free(qn_building *b) {
  for (size_t i = 0; i < b->batch_count; i++) {
    qn_batch *t = &b->batches[i];
    qn_free(b->mem, t->halves, t->half_capacity * sizeof *t->halves);
    qn_free(b->mem, t->planes, t->plane_capacity * sizeof *t->planes);
    qn_free(b->mem, t->quadrics, t->quadric_capacity * sizeof *t->quadrics);
    qn_free(b->mem, t->keys, t->key_capacity * sizeof *t->keys);
    qn_free(b->mem, t->places, t->place_capacity * sizeof *t->places);
    qn_free(b->mem, t->global, t->place_count * sizeof *t->global);
  }
  qn_free(b->mem, b->batches, b->batch_capacity * sizeof *b->batches);
  b->batches = NULL;
  b->batch_count = b->batch_capacity = 0;
}
