/* The walk over the solid tree: leaves in order, and the terms of the program.

   Complements are pushed down during the walk: below the second operand of a difference everything is negated, a union of
   negated things being a meet of them. A node with one child, or of the kind of the gate above it, adds no gate.

   Leaves are only listed here, in batches; several threads then make them (leaves.c). To begin a batch a thread composes the maps on
   the path from the root anew, so a batch is not ended before as many nodes were met as that path has: all paths together are not
   longer than the walk. */
#include "scene/compile.h"

#include "base/limits.h"

/* A node whose children are being visited. */
typedef struct level {
  uint32_t node, next; /* next: the child to visit, QN_NO_NODE when done */
  uint32_t term;       /* the gate its children belong to */
  uint32_t material, name;
  uint8_t negated;     /* of the node */
  uint8_t first;       /* no child was visited yet */
} level;

typedef struct walk {
  qn_building *b;
  level *stack;
  size_t count, capacity;
  size_t met; /* nodes since the batch began */
} walk;

enum { BATCH = 2048 };

int qn_is_transform(const qn_node *n) {
  switch ((qn_node_kind)n->kind) {
  case QN_NODE_TRANSLATE: case QN_NODE_ROTATE: case QN_NODE_ROTATE_AXIS: case QN_NODE_SCALE: case QN_NODE_MIRROR:
  case QN_NODE_MULTMATRIX:
    return 1;
  case QN_NODE_UNION: case QN_NODE_DIFFERENCE: case QN_NODE_INTERSECTION: case QN_NODE_COLOR: case QN_NODE_NAME: case QN_NODE_LEAF:
    return 0;
  }
  return 0;
}

uint32_t qn_present(const quoin_model *model, uint32_t child) {
  while (child != QN_NO_NODE && (model->nodes[child].flags & QN_MOD_BACKGROUND) != 0) {
    child = model->nodes[child].next;
  }
  return child;
}

static quoin_status add_term(qn_building *b, uint32_t parent, qn_term_kind kind, uint32_t leaf, int negated, uint32_t *out) {
  if (b->term_count >= UINT32_MAX / 2) {
    return QUOIN_E_LIMIT;
  }
  if (!qn_grow(b->mem, &b->terms, &b->term_capacity, b->term_count + 1)) {
    return QUOIN_E_MEMORY;
  }
  b->terms[b->term_count] = (qn_term){.parent = parent, .leaf = leaf, .gate = QN_NO_GATE, .kind = (uint8_t)kind,
                                      .negated = (uint8_t)negated};
  *out = (uint32_t)b->term_count++;
  return QUOIN_OK;
}

static quoin_status visit_leaf(walk *w, uint32_t node, uint32_t term, int negated, uint32_t material, uint32_t name) {
  qn_building *b = w->b;
  if (b->visit_count >= QN_MAX_LEAVES || b->visit_count >= b->visit_room) {
    return QUOIN_E_LIMIT;
  }
  if (b->visit_count % 65536 == 0) {
    quoin_status status = qn_tell_progress(b->progress, 0.1 * (double)b->visit_count / (double)(b->visit_room + 1));
    if (status != QUOIN_OK) {
      return status;
    }
  }
  qn_batch *batch = b->batch_count ? &b->batches[b->batch_count - 1] : NULL;
  if (!batch || (batch->visits >= BATCH && w->met >= w->count)) {
    if (!qn_grow(b->mem, &b->batches, &b->batch_capacity, b->batch_count + 1)) {
      return QUOIN_E_MEMORY;
    }
    batch = &b->batches[b->batch_count++];
    /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): capacity stands for a block */
    *batch = (qn_batch){.visit0 = b->visit_count};
    w->met = 0;
  }
  batch->visits++;
  uint32_t mine = 0;
  quoin_status status = add_term(b, term, QN_TERM_LEAF, (uint32_t)b->visit_count, negated, &mine);
  b->visits[b->visit_count++] = (qn_visit){node, mine, material, name};
  return status;
}

/* Applies what the node says about looks and name to what is below it. */
static quoin_status put_on(qn_building *b, uint32_t node, uint32_t *material, uint32_t *name) {
  const qn_node *n = &b->model->nodes[node];
  if (n->kind == QN_NODE_COLOR) {
    *material = qn_material_under(b, *material, &b->model->materials[n->payload]);
    return *material == UINT32_MAX ? QUOIN_E_MEMORY : QUOIN_OK;
  }
  if (n->kind == QN_NODE_NAME) {
    *name = qn_name_add(b, b->model->names[n->payload]);
    return *name == UINT32_MAX ? QUOIN_E_MEMORY : QUOIN_OK;
  }
  return QUOIN_OK;
}

static quoin_status enter(walk *w, uint32_t node, uint32_t term, int negated, uint32_t material, uint32_t name) {
  qn_building *b = w->b;
  const qn_node *n = &b->model->nodes[node];
  w->met++;
  if (n->kind == QN_NODE_LEAF) {
    return visit_leaf(w, node, term, negated, material, name);
  }
  uint32_t first = qn_present(b->model, n->first), unused;
  if (first == QN_NO_NODE) { /* nothing; negated, everything */
    return add_term(b, term, negated ? QN_TERM_TRUE : QN_TERM_FALSE, 0, 0, &unused);
  }
  int meet = (n->kind == QN_NODE_DIFFERENCE || n->kind == QN_NODE_INTERSECTION) != negated;
  qn_term_kind kind = meet ? QN_TERM_AND : QN_TERM_OR;
  quoin_status status = QUOIN_OK;
  if (b->terms[term].kind != kind && qn_present(b->model, b->model->nodes[first].next) != QN_NO_NODE) {
    status = add_term(b, term, kind, 0, 0, &term);
  }
  if (status == QUOIN_OK) {
    status = put_on(b, node, &material, &name);
  }
  if (status == QUOIN_OK && !qn_grow(b->mem, &w->stack, &w->capacity, w->count + 1)) {
    status = QUOIN_E_MEMORY;
  }
  if (status == QUOIN_OK) {
    w->stack[w->count++] = (level){node, first, term, material, name, (uint8_t)negated, 1};
    b->deepest = w->count > b->deepest ? w->count : b->deepest;
  }
  return status;
}

quoin_status qn_tree_walk(qn_building *b) {
  walk w = {.b = b};
  b->visit_room = b->model->leaf_count;
  b->visits = qn_alloc(b->mem, b->visit_room * sizeof *b->visits);
  uint32_t root, node = 0, material = qn_material_under(b, 0, NULL), name = QN_NO_NAME;
  quoin_status status = !b->visits || material == UINT32_MAX ? QUOIN_E_MEMORY : add_term(b, QN_NO_GATE, QN_TERM_OR, 0, 0, &root);
  if (status == QUOIN_OK && b->model->only != QN_NO_NODE) {
    node = b->model->only;
  }
  if (status == QUOIN_OK) {
    status = enter(&w, node, root, 0, material, name);
  }
  while (status == QUOIN_OK && w.count) {
    level *l = &w.stack[w.count - 1];
    uint32_t child = l->next;
    if (child == QN_NO_NODE) {
      w.count--;
      continue;
    }
    int negated = l->negated != (b->model->nodes[l->node].kind == QN_NODE_DIFFERENCE && !l->first);
    l->next = qn_present(b->model, b->model->nodes[child].next);
    l->first = 0;
    status = enter(&w, child, l->term, negated, l->material, l->name);
  }
  qn_free(b->mem, w.stack, w.capacity * sizeof *w.stack);
  return status;
}
