/* What the batches made becomes the scene's arrays: leaves that the program does not ask for are left out, with their half-spaces and
   shadows, keeping the order. Counted first, then written to their places, both by several threads. */
#include "scene/compile.h"

#include "base/thread.h"

#include <string.h>

static int is_kept(const qn_building *b, size_t visit) {
  const qn_term *t = &b->terms[b->visits[visit].term];
  return t->kind == QN_TERM_LEAF && t->gate != QN_NO_GATE;
}

static quoin_status count(void *user, unsigned thread, size_t number) {
  (void)thread;
  qn_building *b = user;
  qn_batch *t = &b->batches[number];
  for (size_t i = t->visit0; i < t->visit0 + t->visits; i++) {
    const qn_leaf *leaf = &b->scene->leaves[i];
    if (!is_kept(b, i)) {
      continue;
    }
    t->leaves++;
    t->kept_halves += leaf->halves;
    for (uint32_t h = leaf->half0; h < leaf->half0 + leaf->halves; h++) {
      if (t->halves[h].kind == QN_PLANE) {
        t->kept_planes++;
      } else {
        t->kept_quadrics++;
      }
    }
    if (b->visits[i].name == QN_NO_NAME) {
      t->text += qn_name_length(b->model, b->visits[i].node, i);
    }
  }
  return QUOIN_OK;
}

typedef struct packing {
  qn_building *b;
  qn_leaf *leaves; /* where they go: the same array when all are kept */
} packing;

static quoin_status write(void *user, unsigned thread, size_t number) {
  (void)thread;
  packing *p = user;
  qn_building *b = p->b;
  quoin_scene *s = b->scene;
  qn_batch *t = &b->batches[number];
  size_t leaves = t->leaves, halves = t->kept_halves, planes = t->kept_planes, quadrics = t->kept_quadrics, text = t->text; /* places, by now */
  for (size_t i = t->visit0; i < t->visit0 + t->visits; i++) {
    if (!is_kept(b, i)) {
      continue;
    }
    const qn_visit *v = &b->visits[i];
    qn_leaf leaf = s->leaves[i];
    size_t from = leaf.half0;
    leaf.gate = b->terms[v->term].gate;
    leaf.half0 = (uint32_t)halves;
    for (size_t h = from; h < from + leaf.halves; h++) {
      qn_half half = t->halves[h];
      if (half.kind == QN_PLANE) {
        s->planes[planes] = t->planes[half.shadow];
        half.shadow = (uint32_t)planes++;
      } else {
        s->quadrics[quadrics] = t->quadrics[half.shadow];
        half.shadow = (uint32_t)quadrics++;
      }
      uint32_t key = t->keys[h] ? t->global[t->keys[h] - 1] : 0;
      b->keys[halves] = key;
      if (key) { /* the next one with this key is not the first */
        t->global[t->keys[h] - 1] = key & ~QN_KEY_FIRST;
      }
      s->halves[halves++] = half;
    }
    if (v->name == QN_NO_NAME) {
      char name[QN_PLACE_NAME];
      size_t length = qn_name_of_leaf(b->model, v->node, i, name);
      memcpy(s->name_text + text, name, length);
      s->part_names[leaves] = (uint32_t)text;
      text += length;
    } else {
      s->part_names[leaves] = v->name;
    }
    b->kinds[leaves] = (uint8_t)qn_piece_kind_of(s, &leaf);
    p->leaves[leaves++] = leaf;
  }
  qn_free(b->mem, t->halves, t->half_capacity * sizeof *t->halves);
  qn_free(b->mem, t->planes, t->plane_capacity * sizeof *t->planes);
  qn_free(b->mem, t->quadrics, t->quadric_capacity * sizeof *t->quadrics);
  t->halves = NULL, t->planes = NULL, t->quadrics = NULL;
  t->half_capacity = t->plane_capacity = t->quadric_capacity = 0;
  return QUOIN_OK;
}

/* Makes *count the sum of those before it, and returns the sum with it. */
static size_t add_up(size_t *count, size_t before) {
  size_t mine = *count;
  *count = before;
  return before + mine;
}

quoin_status qn_pack(qn_building *b) {
  quoin_scene *s = b->scene;
  quoin_status status = qn_parallel(b->threads, b->batch_count, count, b, NULL);
  if (status != QUOIN_OK) {
    return status;
  }
  size_t leaves = 0, halves = 0, planes = 0, quadrics = 0, text = s->name_size;
  for (size_t i = 0; i < b->batch_count; i++) {
    qn_batch *t = &b->batches[i];
    leaves = add_up(&t->leaves, leaves);
    halves = add_up(&t->kept_halves, halves);
    planes = add_up(&t->kept_planes, planes);
    quadrics = add_up(&t->kept_quadrics, quadrics);
    text = add_up(&t->text, text);
  }
  if (halves >= UINT32_MAX / 2 || text >= UINT32_MAX) {
    return QUOIN_E_LIMIT;
  }
  char *names = qn_resize(b->mem, s->name_text, b->name_capacity, text);
  if (!names) {
    return QUOIN_E_MEMORY;
  }
  s->name_text = names;
  b->name_capacity = s->name_size = text;
  s->halves = qn_alloc(b->mem, halves * sizeof *s->halves);
  s->half_count = halves;
  s->planes = qn_alloc(b->mem, planes * sizeof *s->planes);
  s->plane_count = planes;
  s->quadrics = qn_alloc(b->mem, quadrics * sizeof *s->quadrics);
  s->quadric_count = quadrics;
  s->part_names = qn_alloc(b->mem, leaves * sizeof *s->part_names);
  s->leaf_count = leaves;
  b->keys = qn_alloc(b->mem, halves * sizeof *b->keys);
  b->key_room = halves;
  b->kinds = qn_alloc(b->mem, leaves);
  b->kind_room = leaves;
  packing p = {b, leaves == b->visit_count ? s->leaves : qn_alloc(b->mem, leaves * sizeof *p.leaves)};
  if (!s->halves || !s->planes || !s->quadrics || !s->part_names || !b->keys || !b->kinds || !p.leaves) {
    status = QUOIN_E_MEMORY;
  } else {
    status = qn_parallel(b->threads, b->batch_count, write, &p, NULL);
  }
  if (p.leaves != s->leaves && status == QUOIN_OK) {
    qn_free(b->mem, s->leaves, b->leaf_room * sizeof *s->leaves);
    s->leaves = p.leaves;
    b->leaf_room = leaves;
  } else if (p.leaves != s->leaves) {
    qn_free(b->mem, p.leaves, leaves * sizeof *p.leaves);
  }
  return status;
}
