/* Near surfaces as data for the user: names, places, gaps. */
#include "scene/snap.h"

#include "base/limits.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int in_file(const void *a, const void *b) {
  const qn_near_pair *x = a, *y = b;
  return x->small != y->small ? (x->small > y->small) - (x->small < y->small) : (x->stands > y->stands) - (x->stands < y->stands);
}
static int by_gap(const void *a, const void *b) {
  const qn_near_pair *x = a, *y = b;
  return x->gap != y->gap ? (x->gap > y->gap) - (x->gap < y->gap) : in_file(a, b);
}

/* Names the surface by its user; *side: of the user. */
static int set_face(quoin_near_list *list, const quoin_scene *scene, uint32_t surface, uint32_t leaf, qn_near_face *out, int *side) {
  const char *name = quoin_part_name(scene, leaf);
  uint32_t h = scene->leaves[leaf].half0;
  while (scene->halves[h].surface != surface) {
    h++;
  }
  out->name = qn_arena_text(&list->arena, name, strlen(name));
  out->role = scene->halves[h].role;
  out->node = scene->leaves[leaf].node;
  *side = scene->halves[h].side; /* NOLINT(bugprone-signed-char-misuse,cert-str34-c): a number, -1 or 1 */
  return out->name != NULL;
}

quoin_status qn_near_list_make(const quoin_scene *scene, qn_near_pairs *pairs, qn_num limit, quoin_near_list **out) {
  quoin_near_list *list = qn_alloc_zeroed(scene->mem, sizeof *list);
  if (!list) {
    return QUOIN_E_MEMORY;
  }
  list->mem = scene->mem;
  list->model = scene->model; /* stays: the list belongs to a scene of this model, or is freed before one */
  list->limit = qn_num_to_double(limit);
  list->cut = pairs->cut;
  qn_arena_init(&list->arena, list->mem);
  quoin_status status = qn_grow(list->mem, &list->rows, &list->capacity, pairs->count) ? QUOIN_OK : QUOIN_E_MEMORY;
  for (size_t i = 0; i < pairs->count && status == QUOIN_OK; i++) {
    const qn_near_pair *p = &pairs->items[i];
    qn_near_row *r = &list->rows[list->count++];
    int side[2];
    *r = (qn_near_row){.gap = p->gap, .exact = qn_arena_text(&list->arena, p->exact, strlen(p->exact))};
    if (!r->exact || !set_face(list, scene, p->small, p->leaf[0], &r->face[0], &side[0]) ||
        !set_face(list, scene, p->stands, p->leaf[1], &r->face[1], &side[1])) {
      status = QUOIN_E_MEMORY;
    } else {
      r->opposite = side[0] * side[1] * p->turn < 0;
    }
  }
  if (status != QUOIN_OK) {
    quoin_near_free(list);
    return status;
  }
  *out = list;
  return QUOIN_OK;
}

QUOIN_API quoin_status quoin_near_find(const quoin_scene *scene, const char *limit, quoin_near_list **out) {
  if (!scene || !out) {
    return QUOIN_E_ARGUMENT;
  }
  *out = NULL;
  qn_ctx ctx;
  qn_ctx_init(&ctx, scene->mem);
  qn_num within = qn_num_from_double(&ctx, qn_near_usual(scene));
  quoin_status status = limit ? qn_snap_limit(&ctx, limit, &within) : QUOIN_OK;
  qn_near_pairs pairs = {0};
  if (status == QUOIN_OK) {
    status = qn_near_find(scene, within, QN_NEAR_ALL, &pairs);
  }
  if (status == QUOIN_OK) {
    if (pairs.count > 1) {
      qsort(pairs.items, pairs.count, sizeof *pairs.items, by_gap);
    }
    status = qn_near_list_make(scene, &pairs, within, out);
    qn_near_pairs_free(&pairs, scene->mem);
  }
  qn_ctx_free(&ctx);
  return status;
}

quoin_status qn_snap_limit(qn_ctx *ctx, const char *text, qn_num *out) {
  quoin_status status = QUOIN_OK;
  size_t length = strlen(text);
  if (qn_num_read(ctx, text, length, out, &status) != length || length == 0) {
    return status != QUOIN_OK ? status : QUOIN_E_NUMBER;
  }
  return status != QUOIN_OK ? status : ctx->failed != QUOIN_OK ? ctx->failed : qn_num_sign(*out) < 0 ? QUOIN_E_ARGUMENT : QUOIN_OK;
}

size_t qn_near_list_bytes(const quoin_near_list *list) {
  return list ? sizeof *list + list->capacity * sizeof *list->rows : 0;
}

QUOIN_API size_t quoin_near_count(const quoin_near_list *list) {
  return list ? list->count : 0;
}
QUOIN_API double quoin_near_limit(const quoin_near_list *list) {
  return list ? list->limit : 0;
}
QUOIN_API int quoin_near_complete(const quoin_near_list *list) {
  return list ? !list->cut : 1;
}

QUOIN_API quoin_status quoin_near_get(const quoin_near_list *list, size_t index, quoin_near *out) {
  if (!list || !out || index >= list->count) {
    return QUOIN_E_ARGUMENT;
  }
  const qn_near_row *r = &list->rows[index];
  *out = (quoin_near){.gap = r->gap, .exact = r->exact, .opposite = r->opposite};
  for (int i = 0; i < 2; i++) {
    const qn_loc loc = list->model->nodes[r->face[i].node].loc;
    out->face[i] = (quoin_near_face){.name = r->face[i].name, .role = r->face[i].role, .line = loc.line, .column = loc.column,
                                     .file = loc.file ? list->model->diags.files[loc.file - 1] : ""};
  }
  return QUOIN_OK;
}

QUOIN_API void quoin_near_free(quoin_near_list *list) {
  if (list) {
    qn_free(list->mem, list->rows, list->capacity * sizeof *list->rows);
    qn_arena_free(&list->arena);
    qn_free(list->mem, list, sizeof *list);
  }
}

QUOIN_API const quoin_near_list *quoin_scene_snapped(const quoin_scene *scene) {
  return scene ? scene->snapped : NULL;
}
