/* Compilation: one walk over the solid tree lists the leaves and the terms of the program; leaves are made with their shadows; terms are
   simplified, what dropped out is taken away, equal surfaces are found, and the hierarchy, the normal form and the pieces are
   built. */
#include "scene/cells.h"
#include "scene/compile.h"
#include "scene/rounding.h"
#include "scene/super.h"
#include "scene/snap.h"

#include "base/limits.h"
#include "base/thread.h"

#include <math.h>
#include <string.h>

enum { STRETCH = 4096 }; /* leaves a thread takes at once */
typedef struct sorting { quoin_scene *scene; qn_bvh_item *items; size_t *bounded; } sorting; /* bounded: by stretch, the ones before it */

static quoin_status sort_in(void *user, unsigned thread, size_t number) {
  (void)thread;
  const sorting *p = user;
  quoin_scene *s = p->scene;
  size_t begin = number * STRETCH, end = begin + STRETCH < s->leaf_count ? begin + STRETCH : s->leaf_count, at = p->bounded[number];
  size_t free_at = begin - at;
  for (size_t i = begin; i < end; i++) {
    const qn_leaf *l = &s->leaves[i];
    if (l->bounded) {
      qn_bvh_item_make(&p->items[at++], l->min, l->max, (uint32_t)i);
    } else {
      s->unbounded[free_at++] = (uint32_t)i;
    }
  }
  return QUOIN_OK;
}

static quoin_status build_hierarchy(qn_building *b) {
  quoin_scene *s = b->scene;
  size_t stretches = (s->leaf_count + STRETCH - 1) / STRETCH, n = 0;
  sorting p = {s, NULL, qn_alloc(b->mem, stretches * sizeof *p.bounded)};
  if (!p.bounded) {
    return QUOIN_E_MEMORY;
  }
  for (size_t i = 0; i < s->leaf_count; i++) {
    if (i % STRETCH == 0) {
      p.bounded[i / STRETCH] = n;
    }
    n += s->leaves[i].bounded;
  }
  p.items = qn_alloc_line(b->mem, n * sizeof *p.items);
  s->unbounded_count = s->leaf_count - n;
  s->unbounded = qn_alloc(b->mem, s->unbounded_count * sizeof *s->unbounded);
  quoin_status status = p.items && s->unbounded ? qn_parallel(b->threads, stretches, sort_in, &p, NULL) : QUOIN_E_MEMORY;
  status = status == QUOIN_OK ? qn_bvh_build_items(&s->bvh, b->mem, n, p.items, b->threads) : status;
  qn_free_line(b->mem, p.items, n * sizeof *p.items);
  qn_free(b->mem, p.bounded, stretches * sizeof *p.bounded);
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
  quoin_status status = FIT(s->materials, b->material_capacity, s->material_count);
  return status == QUOIN_OK ? FIT(s->surfaces, s->surface_room, s->surface_count) : status;
}

static size_t bytes_of(const quoin_scene *s) {
  size_t hierarchy = s->bvh.node_count * sizeof *s->bvh.nodes + s->bvh.item_count * sizeof *s->bvh.items;
  size_t snapped = s->snaps ? sizeof *s->snaps + s->snaps->capacity * sizeof *s->snaps->items + qn_near_list_bytes(s->snapped) : 0;
  return sizeof *s + s->leaf_count * (sizeof *s->leaves + sizeof *s->part_names + sizeof *s->line_of) + s->half_count * sizeof *s->halves +
         s->plane_count * sizeof *s->planes + s->quadric_count * sizeof *s->quadrics + s->surface_count * sizeof *s->surfaces +
         s->program.gate_count * sizeof *s->program.gates + qn_paths_bytes(s->program.paths) + hierarchy + s->unbounded_count * sizeof *s->unbounded +
         s->material_count * sizeof *s->materials + s->name_size + qn_normal_bytes(&s->normal) + s->line_count * 64 + s->plain_count * sizeof *s->plain +
         snapped;
}

quoin_status qn_tell_progress(const quoin_progress *progress, double done) {
  return progress && progress->report && progress->report(progress->user, done) ? QUOIN_E_CANCELLED : QUOIN_OK;
}

typedef struct stretch { const quoin_progress *whole; double from, to; } stretch;
static int report_part(void *user, double done) {
  const stretch *s = user;
  return qn_tell_progress(s->whole, s->from + (s->to - s->from) * done) != QUOIN_OK;
}

quoin_status qn_parallel_part(qn_building *b, size_t n, quoin_status (*body)(void *user, unsigned thread, size_t i), void *user, double from,
                              double to) {
  stretch s = {b->progress, from, to};
  quoin_progress part = {report_part, &s};
  return qn_parallel(b->threads, n, body, user, &part);
}

/* The walk, and the leaves that the program asks for. */
static quoin_status make_leaves(qn_building *b) {
  quoin_scene *s = b->scene;
  quoin_status status = qn_tree_walk(b);
  status = status == QUOIN_OK ? qn_leaves_make(b) : status;
  status = status == QUOIN_OK ? qn_keys_join(b) : status;
  status = status == QUOIN_OK && !b->whole ? qn_simplify(b, s->min, s->max) : status;
  status = status == QUOIN_OK ? qn_program_build(&s->program, b->mem, b->terms, b->term_count) : status;
  status = status == QUOIN_OK ? qn_pack(b) : status;
  qn_batches_free(b);
  qn_free(b->mem, b->visits, b->visit_room * sizeof *b->visits);
  qn_free(b->mem, b->terms, b->term_capacity * sizeof *b->terms);
  if (status == QUOIN_OK) {
    s->dropped = b->visit_count - s->leaf_count;
    const qn_gate *root = &s->program.gates[0];
    s->empty = root->kids == 0 && !root->is_and;
  }
  return status;
}

static quoin_status make(qn_building *b) {
  quoin_scene *s = b->scene;
  quoin_status status = make_leaves(b);
  status = status == QUOIN_OK ? qn_tell_progress(b->progress, 0.6) : status;
  status = status == QUOIN_OK ? qn_identify(b) : status;
  status = status == QUOIN_OK ? qn_find_empty(b) : status;
  status = status == QUOIN_OK ? fit_all(b) : status;
  status = status == QUOIN_OK ? qn_tell_progress(b->progress, 0.7) : status;
  status = status == QUOIN_OK ? build_hierarchy(b) : status;
  status = status == QUOIN_OK ? qn_tell_progress(b->progress, 0.85) : status;
  status = status == QUOIN_OK ? qn_normal_build(&s->normal, s, b->mem, b->threads) : status;
  status = status == QUOIN_OK ? qn_pieces_build(s, b->model, b->mem, b->kinds, b->threads) : status;
  if (status == QUOIN_OK && (s->cells = qn_alloc(b->mem, sizeof *s->cells)) != NULL) {
    atomic_init(s->cells, NULL);
  }
  status = status == QUOIN_OK && !s->cells ? QUOIN_E_MEMORY : status;
  return status == QUOIN_OK ? qn_tell_progress(b->progress, 1) : status;
}

/* What only serves the making. Of a scene that was not made, also arrays that still have the room they had grown to. */
static void drop(qn_building *b, int made) {
  quoin_scene *s = b->scene;
  qn_free(b->mem, b->keys, b->key_room * sizeof *b->keys);
  qn_free(b->mem, b->kinds, b->kind_room);
  qn_materials_free(b);
  if (!made) {
    qn_free(b->mem, s->leaves, b->leaf_room * sizeof *s->leaves);
    qn_free(b->mem, s->materials, b->material_capacity * sizeof *s->materials);
    qn_free(b->mem, s->name_text, b->name_capacity);
    s->leaves = NULL, s->materials = NULL, s->name_text = NULL;
  }
}

/* A scene with all leaves, their surfaces and their hierarchy, and nothing more, tells what is to be moved. */
static quoin_status survey(quoin_model *model, unsigned threads, const quoin_progress *progress, qn_num limit, quoin_scene *into) {
  quoin_scene *s = qn_alloc_zeroed(&model->mem, sizeof *s);
  qn_snaps *snaps = qn_alloc_zeroed(&model->mem, sizeof *snaps);
  if (!s || !snaps) {
    qn_free(&model->mem, s, sizeof *s);
    qn_free(&model->mem, snaps, sizeof *snaps);
    return QUOIN_E_MEMORY;
  }
  s->mem = &model->mem;
  s->kept_maps = qn_kept_maps_new(model, s->mem);
  qn_building b = {.model = model, .scene = s, .mem = &model->mem, .threads = threads, .progress = progress, .whole = 1};
  quoin_status status = s->kept_maps ? make_leaves(&b) : QUOIN_E_MEMORY;
  status = status == QUOIN_OK ? qn_identify(&b) : status;
  status = status == QUOIN_OK ? fit_all(&b) : status;
  status = status == QUOIN_OK ? build_hierarchy(&b) : status;
  drop(&b, status == QUOIN_OK);
  qn_model_retain(model);
  s->model = model;
  status = status == QUOIN_OK ? qn_snaps_find(s, limit, snaps, &into->snapped) : status;
  quoin_scene_free(s);
  if (status != QUOIN_OK) {
    qn_free(&model->mem, snaps, sizeof *snaps);
    return status;
  }
  into->snaps = snaps;
  return qn_tell_progress(progress, 1);
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
  s->kept_maps = qn_kept_maps_new(model, s->mem);
  qn_building b = {.model = model, .scene = s, .mem = &model->mem, .threads = qn_thread_count(options->threads), .progress = &options->progress};
  stretch parts[2] = {{&options->progress, 0, 0.5}, {&options->progress, 0.5, 1}};
  quoin_progress first = {report_part, &parts[0]}, second = {report_part, &parts[1]};
  quoin_status status = s->kept_maps ? QUOIN_OK : QUOIN_E_MEMORY;
  if (status == QUOIN_OK && options->snap) {
    qn_ctx ctx;
    qn_num limit = QN_NUM_ZERO;
    qn_ctx_init(&ctx, &model->mem);
    status = qn_snap_limit(&ctx, options->snap, &limit);
    status = status == QUOIN_OK ? survey(model, b.threads, &first, limit, s) : status;
    qn_ctx_free(&ctx);
    b.progress = &second;
  }
  status = status == QUOIN_OK ? make(&b) : status;
  drop(&b, status == QUOIN_OK);
  if (status != QUOIN_OK) {
    quoin_scene_free(s);
    return status;
  }
  if (s->snapped) {
    qn_snaps_tell(model, s->snaps, s->snapped);
  }
  s->bytes = bytes_of(s);
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
    if (s->surfaces[i].kind == QN_SUPER_BODY) {
      qn_super_form_free(mem, atomic_load_explicit(&s->surfaces[i].super, memory_order_relaxed));
    } else {
      qn_exact_free(mem, atomic_load_explicit(&s->surfaces[i].exact, memory_order_relaxed));
    }
    qn_rounding_free(mem, atomic_load_explicit(&s->surfaces[i].rounding, memory_order_relaxed));
  }
  qn_free(mem, s->surfaces, s->surface_room * sizeof *s->surfaces);
  qn_free(mem, s->leaves, s->leaf_count * sizeof *s->leaves);
  qn_free(mem, s->halves, s->half_count * sizeof *s->halves);
  qn_free(mem, s->planes, s->plane_count * sizeof *s->planes);
  qn_free(mem, s->quadrics, s->quadric_count * sizeof *s->quadrics);
  qn_kept_maps_free(s->kept_maps);
  qn_program_free(&s->program, mem);
  qn_normal_free(&s->normal, mem);
  qn_bvh_free(&s->bvh, mem);
  qn_free_line(mem, s->lines, s->line_count * 64);
  qn_free_line(mem, s->line_of, s->leaf_count * sizeof *s->line_of);
  if (s->cells) {
    qn_cells_free(atomic_load_explicit(s->cells, memory_order_relaxed), mem);
    qn_free(mem, s->cells, sizeof *s->cells);
  }
  qn_free_line(mem, s->plain, s->plain_count * sizeof *s->plain);
  qn_free(mem, s->unbounded, s->unbounded_count * sizeof *s->unbounded);
  qn_free(mem, s->materials, s->material_count * sizeof *s->materials);
  qn_free(mem, s->part_names, s->leaf_count * sizeof *s->part_names);
  qn_free(mem, s->name_text, s->name_size);
  quoin_near_free(s->snapped);
  if (s->snaps) {
    qn_snaps_free(s->snaps, mem);
    qn_free(mem, s->snaps, sizeof *s->snaps);
  }
  qn_free(mem, s, sizeof *s);
  if (model) {
    qn_model_release(model);
  }
}
