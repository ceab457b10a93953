/* Fingerprints of half-spaces, and which of them are alone with theirs. Most are, and then their surface is a new one without any
   comparison; all of this is done by several threads, each half-space by itself.

   Subjects are dealt to square cells of the plane of fingerprints, CELL wide; one that is within reach of a cell's edge to each cell it
   reaches into. Two subjects whose fingerprints are within reach of one another share a cell. A cell is crowded when it has two
   subjects that may be equal: two keyed planes are not, their keys would be the same. Cells are known by a hash; where two have the same,
   they count as one, which only means more comparing. */
#include "scene/identity.h"

#include "base/bounds.h"
#include "base/thread.h"

#include <math.h>
#include <string.h>

#define CELL (64 * QN_PRINT_CELL)
#define REACH (2 * QN_PRINT_ERROR)
enum { STRETCH = 2048, PARTS = 64 }; /* leaves a thread takes at once; parts into which cells are dealt */

typedef struct entry { uint64_t cell; uint32_t half; uint32_t keyed; } entry;
typedef struct entries { entry *items; size_t count, capacity; size_t of_part[PARTS + 1]; } entries; /* in the order of their parts */

typedef struct finding {
  qn_building *b;
  qn_crowd *crowd;
  const qn_print_frame *frame;
  qn_forms *by_thread;   /* b null: not begun */
  entries *by_stretch;
  size_t stretches;
} finding;

/* --- fingerprints ------------------------------------------------------------------------------------------------- */

/* The vector in the frame of fingerprints from exact numbers, where doubles lose too much. */
static quoin_status careful_vector(qn_forms *forms, uint32_t leaf, uint32_t half, const qn_print_frame *frame, qn_vector *out) {
  const qn_half_form *form;
  quoin_status status = qn_forms_half(forms, leaf, half, &form);
  if (status != QUOIN_OK) {
    return status;
  }
  qn_ctx *ctx = &forms->ctx;
  qn_half_form moved = *form;
  qn_num origin[4] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ONE};
  for (int k = 0; k < 3; k++) {
    origin[k] = qn_num_from_double(ctx, frame->origin[k]);
  }
  for (int i = 0; i < (form->kind == QN_PLANE ? 1 : 3); i++) {
    moved.row[i][3] = qn_num_dot(ctx, 4, form->row[i], origin);
  }
  *out = (qn_vector){0};
  if (form->kind == QN_SUPER_BODY) {
    for (int i = 0; i < 14; i++) {
      double c = qn_num_to_double(i < 12 ? moved.row[i / 4][i % 4] : form->s[i - 12]);
      c = i < 12 && i % 4 == 3 ? ldexp(c, -frame->scale) : c;
      out->c[i] = c;
      out->magnitude[i] = fabs(c);
    }
    return ctx->failed;
  }
  qn_exact_surface exact;
  int side;
  qn_exact_of(ctx, &moved, &exact, &side);
  double m[10];
  int64_t e[10], top = INT64_MIN;
  for (int c = 0; c < 10; c++) {
    qn_int_frexp(exact.q[c], &m[c], &e[c]);
    e[c] -= (int64_t)frame->scale * (c < 6 ? 0 : c < 9 ? 1 : 2);
    top = m[c] != 0 && e[c] > top ? e[c] : top;
  }
  for (int c = 0; c < 10; c++) {
    int64_t below = e[c] - top;
    out->c[c] = m[c] == 0 || below < -1000 ? 0 : ldexp(m[c], (int)below);
    out->magnitude[c] = fabs(out->c[c]);
  }
  return ctx->failed;
}

static quoin_status look_at(const finding *f, qn_forms *forms, uint32_t leaf, uint32_t half) {
  const quoin_scene *scene = f->b->scene;
  const qn_half *h = &scene->halves[half];
  qn_crowd *crowd = f->crowd;
  qn_vector v;
  int fit = qn_vector_of(scene, &scene->leaves[leaf], h, f->frame, &v);
  crowd->side[half] = (int8_t)(h->kind == QN_SUPER_BODY ? 1 : fit ? qn_vector_sign(&v) : 0);
  atomic_store_explicit(&crowd->is[half], (uint8_t)(crowd->side[half] ? QN_SUBJECT : QN_SUBJECT | QN_CROWDED), memory_order_relaxed);
  if (fit && qn_print_of(&v, crowd->prints[half])) {
    return QUOIN_OK;
  }
  if (!forms->b) {
    qn_forms_init(forms, f->b);
  }
  quoin_status status = careful_vector(forms, leaf, half, f->frame, &v);
  if (!qn_print_of(&v, crowd->prints[half])) {
    crowd->prints[half][0] = crowd->prints[half][1] = 0; /* sizes beyond doubles: all of these are candidates to one another */
  }
  return status;
}

/* --- cells -------------------------------------------------------------------------------------------------------- */

static uint64_t hash_of(int64_t x, int64_t y, int super) {
  uint64_t h = (uint64_t)x * 0x9E3779B97F4A7C15u ^ ((uint64_t)y * 2 + (unsigned)super) * 0xC2B2AE3D27D4EB4Fu;
  h ^= h >> 29;
  h *= 0xBF58476D1CE4E5B9u;
  return h ^ h >> 32;
}

/* Adds the subject to the cells it reaches into. Fingerprints are from 0 to a few. */
static int deal(entries *list, qn_mem *mem, const double print[2], uint32_t half, int keyed, int super) {
  int64_t low[2], high[2];
  for (int k = 0; k < 2; k++) { /* one more than the floor, so that all are positive */
    low[k] = (int64_t)((print[k] - REACH) * (1 / CELL) + 1);
    high[k] = (int64_t)((print[k] + REACH) * (1 / CELL) + 1);
  }
  for (int64_t x = low[0]; x <= high[0]; x++) {
    for (int64_t y = low[1]; y <= high[1]; y++) {
      if (!qn_grow(mem, &list->items, &list->capacity, list->count + 1)) {
        return 0;
      }
      list->items[list->count++] = (entry){hash_of(x, y, super), half, (uint32_t)keyed};
    }
  }
  return 1;
}

static size_t part_of(const entry *e) {
  return (size_t)(e->cell >> 58);
}

/* Sorts the entries by their part. */
static int sort(entries *list, qn_mem *mem) {
  entry *sorted = qn_alloc(mem, list->count * sizeof *sorted);
  if (!sorted) {
    return 0;
  }
  size_t at[PARTS];
  for (size_t i = 0; i < list->count; i++) {
    list->of_part[part_of(&list->items[i]) + 1]++;
  }
  for (size_t p = 0; p < PARTS; p++) {
    at[p] = list->of_part[p];
    list->of_part[p + 1] += list->of_part[p];
  }
  for (size_t i = 0; i < list->count; i++) {
    sorted[at[part_of(&list->items[i])]++] = list->items[i];
  }
  qn_free(mem, list->items, list->capacity * sizeof *sorted);
  list->items = sorted;
  list->capacity = list->count;
  return 1;
}

static quoin_status look_at_stretch(void *user, unsigned thread, size_t number) {
  finding *f = user;
  const quoin_scene *s = f->b->scene;
  qn_mem *mem = f->b->mem;
  entries *list = &f->by_stretch[number];
  size_t end = (number + 1) * STRETCH < s->leaf_count ? (number + 1) * STRETCH : s->leaf_count;
  for (size_t leaf = number * STRETCH; leaf < end; leaf++) {
    for (uint32_t h = s->leaves[leaf].half0; h < s->leaves[leaf].half0 + s->leaves[leaf].halves; h++) {
      uint32_t key = f->b->keys[h];
      if (key && !(key & QN_KEY_FIRST)) {
        continue;
      }
      quoin_status status = look_at(f, &f->by_thread[thread], (uint32_t)leaf, h);
      if (status == QUOIN_OK && !deal(list, mem, f->crowd->prints[h], h, key != 0, s->halves[h].kind == QN_SUPER_BODY)) {
        status = QUOIN_E_MEMORY;
      }
      if (status != QUOIN_OK) {
        return status;
      }
    }
  }
  return sort(list, mem) ? QUOIN_OK : QUOIN_E_MEMORY;
}

/* A cell: its subjects as a chain through `next`, while they are all keyed; then it is crowded. */
typedef struct cell { uint64_t cell; uint32_t first; uint8_t used, crowded, all_keyed; } cell;
#define NONE UINT32_MAX

static void mark(const finding *f, uint32_t half) {
  atomic_fetch_or_explicit(&f->crowd->is[half], QN_CROWDED, memory_order_relaxed);
}

static quoin_status crowd_of_part(void *user, unsigned thread, size_t part) {
  (void)thread;
  finding *f = user;
  qn_mem *mem = f->b->mem;
  size_t total = 0, slots = 16, at = 0;
  for (size_t i = 0; i < f->stretches; i++) {
    total += f->by_stretch[i].of_part[part + 1] - f->by_stretch[i].of_part[part];
  }
  while (slots < 2 * total) {
    slots *= 2;
  }
  cell *cells = qn_alloc_zeroed(mem, slots * sizeof *cells);
  typedef struct link { uint32_t half, next; } link;
  link *links = qn_alloc(mem, total * sizeof *links);
  for (size_t i = 0; i < f->stretches && cells && links; i++) {
    const entries *list = &f->by_stretch[i];
    for (size_t k = list->of_part[part]; k < list->of_part[part + 1]; k++) {
      const entry *e = &list->items[k];
      size_t slot = (size_t)e->cell & (slots - 1);
      while (cells[slot].used && cells[slot].cell != e->cell) {
        slot = (slot + 1) & (slots - 1);
      }
      cell *c = &cells[slot];
      if (!c->used) {
        *c = (cell){.cell = e->cell, .first = NONE, .used = 1, .all_keyed = 1};
      }
      if (!c->crowded && c->first != NONE && !(e->keyed && c->all_keyed)) {
        c->crowded = 1;
        for (uint32_t l = c->first; l != NONE; l = links[l].next) {
          mark(f, links[l].half);
        }
      }
      if (c->crowded) {
        mark(f, e->half);
      } else {
        links[at] = (link){e->half, c->first};
        c->first = (uint32_t)at++;
        c->all_keyed &= e->keyed != 0;
      }
    }
  }
  quoin_status status = cells && links ? QUOIN_OK : QUOIN_E_MEMORY;
  qn_free(mem, cells, slots * sizeof *cells);
  qn_free(mem, links, total * sizeof *links);
  return status;
}

quoin_status qn_crowd_find(qn_crowd *crowd, qn_building *b, const qn_print_frame *frame) {
  quoin_scene *s = b->scene;
  *crowd = (qn_crowd){.room = s->half_count};
  crowd->prints = qn_alloc(b->mem, s->half_count * sizeof *crowd->prints);
  crowd->side = qn_alloc(b->mem, s->half_count);
  crowd->is = qn_alloc_zeroed(b->mem, s->half_count * sizeof *crowd->is);
  finding f = {.b = b, .crowd = crowd, .frame = frame, .stretches = (s->leaf_count + STRETCH - 1) / STRETCH};
  f.by_thread = qn_alloc_zeroed(b->mem, b->threads * sizeof *f.by_thread);
  f.by_stretch = qn_alloc_zeroed(b->mem, f.stretches * sizeof *f.by_stretch);
  quoin_status status = crowd->prints && crowd->side && crowd->is && f.by_thread && f.by_stretch ? QUOIN_OK : QUOIN_E_MEMORY;
  status = status == QUOIN_OK ? qn_parallel(b->threads, f.stretches, look_at_stretch, &f, NULL) : status;
  status = status == QUOIN_OK ? qn_parallel(f.stretches > 4 ? b->threads : 1, PARTS, crowd_of_part, &f, NULL) : status;
  for (unsigned i = 0; f.by_thread && i < b->threads; i++) {
    qn_forms_free(&f.by_thread[i]);
  }
  for (size_t i = 0; f.by_stretch && i < f.stretches; i++) {
    qn_free(b->mem, f.by_stretch[i].items, f.by_stretch[i].capacity * sizeof *f.by_stretch[i].items);
  }
  qn_free(b->mem, f.by_thread, b->threads * sizeof *f.by_thread);
  qn_free(b->mem, f.by_stretch, f.stretches * sizeof *f.by_stretch);
  return status;
}

void qn_crowd_free(qn_crowd *crowd, qn_mem *mem) {
  qn_free(mem, crowd->prints, crowd->room * sizeof *crowd->prints);
  qn_free(mem, crowd->side, crowd->room);
  qn_free(mem, crowd->is, crowd->room * sizeof *crowd->is);
}
