/* Compilation: one walk over the solid tree gives leaves with their shadows and the terms of the program; then terms are
   simplified, what dropped out is taken away, equal surfaces are found, and the hierarchy is built.

   Complements are pushed down during the walk: below the second operand of a difference everything is negated, a union of
   negated things being a meet of them. A node with one child, or of the kind of the gate above it, adds no gate. */
#include "scene/compile.h"
#include "scene/rounding.h"

#include "base/limits.h"
#include "base/thread.h"

#include <math.h>
#include <string.h>

/* A node whose children are being visited. */
typedef struct level {
  uint32_t node, next; /* next: the child to visit, QN_NO_NODE when done */
  uint32_t term;       /* the gate its children belong to */
  uint32_t material, name;
  uint8_t negated;     /* of the node */
  uint8_t first;       /* no child was visited yet */
  uint8_t mapped;      /* the node pushed a map */
} level;

typedef struct walk {
  qn_building *b;
  level *stack;
  size_t count, capacity;
  size_t seen_leaves;
  const quoin_progress *progress;
} walk;

#define NO_NAME UINT32_MAX

static int is_transform(const qn_node *n) {
  switch ((qn_node_kind)n->kind) {
  case QN_NODE_TRANSLATE: case QN_NODE_ROTATE: case QN_NODE_ROTATE_AXIS: case QN_NODE_SCALE: case QN_NODE_MIRROR:
  case QN_NODE_MULTMATRIX:
    return 1;
  case QN_NODE_UNION: case QN_NODE_DIFFERENCE: case QN_NODE_INTERSECTION: case QN_NODE_COLOR: case QN_NODE_NAME: case QN_NODE_LEAF:
    return 0;
  }
  return 0;
}

static int absent(const quoin_model *model, uint32_t node) {
  return (model->nodes[node].flags & QN_MOD_BACKGROUND) != 0;
}

/* The first present child at or after `child`. */
static uint32_t present(const quoin_model *model, uint32_t child) {
  while (child != QN_NO_NODE && absent(model, child)) {
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

/* A subtree that is nothing (or, negated, everything). */
static quoin_status add_constant(qn_building *b, uint32_t term, int value) {
  uint32_t unused;
  return add_term(b, term, value ? QN_TERM_TRUE : QN_TERM_FALSE, 0, 0, &unused);
}

static quoin_status visit_leaf(walk *w, uint32_t node, uint32_t term, int negated, uint32_t material, uint32_t name) {
  qn_building *b = w->b;
  quoin_scene *s = b->scene;
  size_t ordinal = w->seen_leaves++;
  if (w->progress && w->progress->report && ordinal % 8192 == 0 &&
      w->progress->report(w->progress->user, 0.6 * (double)ordinal / (double)(b->model->leaf_count + 1))) {
    return QUOIN_E_CANCELLED;
  }
  quoin_status status = qn_local_make(b, node);
  if (status != QUOIN_OK) {
    return status;
  }
  if (b->local.result != QN_FORM_OK) {
    return add_constant(b, term, (b->local.result == QN_FORM_ALL) != negated);
  }
  if (s->leaf_count >= QN_MAX_LEAVES) {
    return QUOIN_E_LIMIT;
  }
  if (!qn_grow(b->mem, &s->leaves, &b->leaf_capacity, s->leaf_count + 1)) {
    return QUOIN_E_MEMORY;
  }
  qn_leaf *leaf = &s->leaves[s->leaf_count];
  *leaf = (qn_leaf){.node = node, .material = material, .gate = QN_NO_GATE, .negated = (uint8_t)negated,
                    .prim = (uint8_t)b->local.prim};
  leaf->bounded = (uint8_t)qn_leaf_box(b, leaf->min, leaf->max);
  qn_form_result result;
  status = qn_leaf_add(b, leaf, &result);
  if (status != QUOIN_OK) {
    return status;
  }
  if (result == QN_FORM_EMPTY) { /* a singular map */
    return add_constant(b, term, negated);
  }
  s->part_names[s->leaf_count] = name != NO_NAME ? name : qn_name_of_leaf(b, node, ordinal);
  if (s->part_names[s->leaf_count] == UINT32_MAX) {
    return QUOIN_E_MEMORY;
  }
  uint32_t unused;
  return add_term(b, term, QN_TERM_LEAF, (uint32_t)s->leaf_count++, negated, &unused);
}

/* Applies what the node says about place, looks and name to what is below it. */
static quoin_status put_on(qn_building *b, uint32_t node, uint32_t *material, uint32_t *name) {
  const qn_node *n = &b->model->nodes[node];
  if (is_transform(n)) {
    return qn_maps_push(&b->maps, b->mem, node);
  }
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
  if (n->kind == QN_NODE_LEAF) {
    return visit_leaf(w, node, term, negated, material, name);
  }
  uint32_t first = present(b->model, n->first);
  if (first == QN_NO_NODE) {
    return add_constant(b, term, negated);
  }
  int meet = (n->kind == QN_NODE_DIFFERENCE || n->kind == QN_NODE_INTERSECTION) != negated;
  qn_term_kind kind = meet ? QN_TERM_AND : QN_TERM_OR;
  quoin_status status = QUOIN_OK;
  if (present(b->model, b->model->nodes[first].next) != QN_NO_NODE && b->terms[term].kind != kind) {
    status = add_term(b, term, kind, 0, 0, &term);
  }
  if (status == QUOIN_OK) {
    status = put_on(b, node, &material, &name);
  }
  if (status == QUOIN_OK && !qn_grow(b->mem, &w->stack, &w->capacity, w->count + 1)) {
    status = QUOIN_E_MEMORY;
  }
  if (status == QUOIN_OK) {
    w->stack[w->count++] = (level){node, first, term, material, name, (uint8_t)negated, 1, (uint8_t)is_transform(n)};
  }
  return status;
}

/* The path from the root to the node marked with '!', without its own node. */
static quoin_status enter_only(walk *w, uint32_t node, uint32_t *material, uint32_t *name) {
  qn_building *b = w->b;
  uint32_t *path = NULL;
  size_t count = 0, capacity = 0;
  quoin_status status = QUOIN_OK;
  for (uint32_t n = b->model->nodes[node].parent; n != QN_NO_NODE && status == QUOIN_OK; n = b->model->nodes[n].parent) {
    if (qn_grow(b->mem, &path, &capacity, count + 1)) {
      path[count++] = n;
    } else {
      status = QUOIN_E_MEMORY;
    }
  }
  while (count && status == QUOIN_OK) {
    status = put_on(b, path[--count], material, name);
  }
  qn_free(b->mem, path, capacity * sizeof *path);
  return status;
}

static quoin_status walk_tree(qn_building *b, const quoin_progress *progress) {
  walk w = {.b = b, .progress = progress};
  uint32_t root, node = 0, material = qn_material_under(b, 0, NULL), name = NO_NAME;
  quoin_status status = material == UINT32_MAX ? QUOIN_E_MEMORY : add_term(b, QN_NO_GATE, QN_TERM_OR, 0, 0, &root);
  if (status == QUOIN_OK && b->model->only != QN_NO_NODE) {
    node = b->model->only;
    status = enter_only(&w, node, &material, &name);
  }
  if (status == QUOIN_OK) {
    status = enter(&w, node, root, 0, material, name);
  }
  while (status == QUOIN_OK && w.count) {
    level *l = &w.stack[w.count - 1];
    uint32_t child = l->next;
    if (child == QN_NO_NODE) {
      if (l->mapped) {
        qn_maps_pop(&b->maps);
      }
      w.count--;
      continue;
    }
    int negated = l->negated != (b->model->nodes[l->node].kind == QN_NODE_DIFFERENCE && !l->first);
    l->next = present(b->model, b->model->nodes[child].next);
    l->first = 0;
    status = enter(&w, child, l->term, negated, l->material, l->name);
  }
  qn_free(b->mem, w.stack, w.capacity * sizeof *w.stack);
  return status;
}

/* --- after the walk ---------------------------------------------------------------------------------------------- */

/* Takes away the leaves that the program does not ask for, with their half-spaces and shadows, keeping the order. */
static void compact(qn_building *b) {
  quoin_scene *s = b->scene;
  for (size_t i = 0; i < b->term_count; i++) {
    if (b->terms[i].kind == QN_TERM_LEAF) {
      s->leaves[b->terms[i].leaf].gate = b->terms[i].gate;
    }
  }
  size_t leaves = 0, halves = 0, planes = 0, quadrics = 0;
  for (size_t i = 0; i < s->leaf_count; i++) {
    qn_leaf leaf = s->leaves[i];
    if (leaf.gate == QN_NO_GATE) {
      continue;
    }
    size_t from = leaf.half0;
    leaf.half0 = (uint32_t)halves;
    for (size_t h = from; h < from + leaf.halves; h++) {
      qn_half half = s->halves[h];
      if (half.kind == QN_PLANE) {
        s->planes[planes] = s->planes[half.shadow];
        half.shadow = (uint32_t)planes++;
      } else {
        s->quadrics[quadrics] = s->quadrics[half.shadow];
        half.shadow = (uint32_t)quadrics++;
      }
      b->keys[halves] = b->keys[h];
      s->halves[halves++] = half;
    }
    s->part_names[leaves] = s->part_names[i];
    s->leaves[leaves++] = leaf;
  }
  s->leaf_count = leaves;
  s->half_count = halves;
  s->plane_count = planes;
  s->quadric_count = quadrics;
}

static quoin_status build_hierarchy(qn_building *b, unsigned threads) {
  quoin_scene *s = b->scene;
  size_t n = 0;
  for (size_t i = 0; i < s->leaf_count; i++) {
    n += s->leaves[i].bounded;
  }
  double(*boxes)[6] = qn_alloc(b->mem, n * sizeof *boxes);
  uint32_t *numbers = qn_alloc(b->mem, n * sizeof *numbers);
  s->unbounded = qn_alloc(b->mem, (s->leaf_count - n) * sizeof *s->unbounded);
  s->unbounded_count = s->leaf_count - n;
  quoin_status status = boxes && numbers && s->unbounded ? QUOIN_OK : QUOIN_E_MEMORY;
  if (status == QUOIN_OK) {
    size_t at = 0, free_at = 0;
    for (size_t i = 0; i < s->leaf_count; i++) {
      if (s->leaves[i].bounded) {
        memcpy(boxes[at], s->leaves[i].min, sizeof s->leaves[i].min);
        memcpy(boxes[at] + 3, s->leaves[i].max, sizeof s->leaves[i].max);
        numbers[at++] = (uint32_t)i;
      } else {
        s->unbounded[free_at++] = (uint32_t)i;
      }
    }
    status = qn_bvh_build(&s->bvh, b->mem, n, (const double(*)[6])boxes, numbers, threads);
  }
  qn_free(b->mem, boxes, n * sizeof *boxes);
  qn_free(b->mem, numbers, n * sizeof *numbers);
  return status;
}

/* Gives back what an array has too much; *capacity becomes its length. */
static quoin_status fit(qn_mem *mem, void *items, size_t *capacity, size_t count, size_t item) {
  void **array = items;
  if (*capacity != count) {
    void *moved = *array ? qn_resize(mem, *array, *capacity * item, count * item) : qn_alloc(mem, count * item);
    if (!moved) {
      return QUOIN_E_MEMORY;
    }
    *array = moved;
    *capacity = count;
  }
  return QUOIN_OK;
}
#define FIT(array, capacity, count) fit(b->mem, &(array), &(capacity), (count), sizeof *(array))

static quoin_status fit_all(qn_building *b) {
  quoin_scene *s = b->scene;
  quoin_status status[] = {
    FIT(s->leaves, b->leaf_capacity, s->leaf_count),         FIT(s->halves, b->half_capacity, s->half_count),
    FIT(s->planes, b->plane_capacity, s->plane_count),       FIT(s->quadrics, b->quadric_capacity, s->quadric_count),
    FIT(s->materials, b->material_capacity, s->material_count), FIT(s->surfaces, s->surface_room, s->surface_count),
    FIT(s->name_text, b->name_capacity, s->name_size),
  };
  for (size_t i = 0; i < sizeof status / sizeof *status; i++) {
    if (status[i] != QUOIN_OK) {
      return status[i];
    }
  }
  s->bytes = sizeof *s + s->leaf_count * (sizeof *s->leaves + sizeof *s->part_names) + s->half_count * sizeof *s->halves +
             s->plane_count * sizeof *s->planes + s->quadric_count * sizeof *s->quadrics + s->surface_count * sizeof *s->surfaces +
             s->program.gate_count * sizeof *s->program.gates + s->bvh.node_count * sizeof *s->bvh.nodes +
             s->bvh.item_count * sizeof *s->bvh.items + s->unbounded_count * sizeof *s->unbounded +
             s->material_count * sizeof *s->materials + s->name_size;
  return QUOIN_OK;
}

static quoin_status report(const quoin_compile_options *options, double done) {
  return options->progress.report && options->progress.report(options->progress.user, done) ? QUOIN_E_CANCELLED : QUOIN_OK;
}

static quoin_status make(qn_building *b, const quoin_compile_options *options) {
  quoin_scene *s = b->scene;
  quoin_status status = qn_maps_init(&b->maps, b->model, b->mem);
  s->part_name_room = b->model->leaf_count;
  if (status == QUOIN_OK && !(s->part_names = qn_alloc(b->mem, s->part_name_room * sizeof *s->part_names))) {
    status = QUOIN_E_MEMORY;
  }
  if (status == QUOIN_OK) {
    status = walk_tree(b, &options->progress);
  }
  qn_keys_free(b);
  if (status == QUOIN_OK) {
    status = qn_simplify(b, s->min, s->max);
  }
  if (status == QUOIN_OK) {
    status = qn_program_build(&s->program, b->mem, b->terms, b->term_count);
  }
  if (status == QUOIN_OK) {
    compact(b);
    const qn_gate *root = &s->program.gates[0];
    s->empty = root->kids == 0 && !root->is_and;
    qn_free(b->mem, b->terms, b->term_capacity * sizeof *b->terms);
    b->terms = NULL;
    b->term_capacity = 0;
    status = report(options, 0.65);
  }
  status = status == QUOIN_OK ? qn_identify(b) : status;
  status = status == QUOIN_OK ? report(options, 0.85) : status;
  status = status == QUOIN_OK ? build_hierarchy(b, qn_thread_count(options->threads)) : status;
  status = status == QUOIN_OK ? report(options, 1) : status;
  return status;
}

QUOIN_API quoin_compile_options quoin_compile_options_default(void) {
  return (quoin_compile_options){0};
}

QUOIN_API quoin_status quoin_scene_compile(quoin_model *model, const quoin_compile_options *options, quoin_scene **out) {
  if (!model || !out) {
    return QUOIN_E_ARGUMENT;
  }
  *out = NULL;
  if (model->diags.errors) {
    return QUOIN_E_MODEL;
  }
  quoin_compile_options usual = quoin_compile_options_default();
  options = options ? options : &usual;
  quoin_scene *s = qn_alloc_zeroed(&model->mem, sizeof *s);
  if (!s) {
    return QUOIN_E_MEMORY;
  }
  s->mem = &model->mem;
  qn_building b = {.model = model, .scene = s, .mem = &model->mem, .local = {.node = QN_NO_NODE}};
  qn_ctx_init(&b.local.ctx, b.mem);
  b.local.ctx.max_bits = QN_MAX_SCENE_BITS;
  quoin_status status = make(&b, options);
  status = status == QUOIN_OK ? fit_all(&b) : status;
  status = status == QUOIN_OK ? qn_normal_build(&s->normal, s, b.mem, qn_thread_count(options->threads)) : status;
  status = status == QUOIN_OK ? qn_pieces_build(s, b.mem) : status;
  s->bytes += qn_normal_bytes(&s->normal) + s->line_count * 64 + s->leaf_count * sizeof *s->line_of;
  qn_maps_free(&b.maps, b.mem);
  qn_ctx_free(&b.local.ctx);
  qn_free(b.mem, b.local.rows, b.local.rows_capacity * sizeof *b.local.rows);
  qn_free(b.mem, b.local.args, b.local.args_capacity * sizeof *b.local.args);
  qn_free(b.mem, b.keys, b.key_capacity * sizeof *b.keys);
  qn_free(b.mem, b.terms, b.term_capacity * sizeof *b.terms);
  qn_materials_free(&b);
  if (status != QUOIN_OK) { /* the arrays still have the room they had grown to */
    qn_free(b.mem, s->leaves, b.leaf_capacity * sizeof *s->leaves);
    qn_free(b.mem, s->halves, b.half_capacity * sizeof *s->halves);
    qn_free(b.mem, s->planes, b.plane_capacity * sizeof *s->planes);
    qn_free(b.mem, s->quadrics, b.quadric_capacity * sizeof *s->quadrics);
    qn_free(b.mem, s->materials, b.material_capacity * sizeof *s->materials);
    qn_free(b.mem, s->name_text, b.name_capacity);
    s->leaves = NULL, s->halves = NULL, s->planes = NULL, s->quadrics = NULL, s->materials = NULL, s->name_text = NULL;
    quoin_scene_free(s);
    return status;
  }
  qn_model_retain(model);
  s->model = model;
  model->frozen = 1;
  *out = s;
  return QUOIN_OK;
}

QUOIN_API void quoin_scene_free(quoin_scene *s) {
  if (!s) {
    return;
  }
  qn_mem *mem = s->mem;
  quoin_model *model = s->model;
  for (size_t i = 0; i < s->surface_count; i++) {
    qn_exact_free(mem, atomic_load_explicit(&s->surfaces[i].exact, memory_order_relaxed));
    qn_rounding_free(mem, atomic_load_explicit(&s->surfaces[i].rounding, memory_order_relaxed));
  }
  qn_free(mem, s->surfaces, s->surface_room * sizeof *s->surfaces);
  qn_free(mem, s->leaves, s->leaf_count * sizeof *s->leaves);
  qn_free(mem, s->halves, s->half_count * sizeof *s->halves);
  qn_free(mem, s->planes, s->plane_count * sizeof *s->planes);
  qn_free(mem, s->quadrics, s->quadric_count * sizeof *s->quadrics);
  qn_program_free(&s->program, mem);
  qn_bvh_free(&s->bvh, mem);
  qn_normal_free(&s->normal, mem);
  qn_free_line(mem, s->lines, s->line_count * 64);
  qn_free(mem, s->line_of, s->leaf_count * sizeof *s->line_of);
  qn_free(mem, s->unbounded, s->unbounded_count * sizeof *s->unbounded);
  qn_free(mem, s->materials, s->material_count * sizeof *s->materials);
  qn_free(mem, s->part_names, s->part_name_room * sizeof *s->part_names);
  qn_free(mem, s->name_text, s->name_size);
  qn_free(mem, s, sizeof *s);
  if (model) {
    qn_model_release(model);
  }
}
