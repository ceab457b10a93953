/* Keys of aligned planes. Each batch has a table of the places x_axis = at it met, a key being a place's number there. Then the batches'
   tables are joined: places are dealt to parts by their hash, and the parts are joined by several threads, each going through
   the batches in order. */
#include "scene/compile.h"

#include "base/thread.h"

#include <string.h>

/* --- in a batch --------------------------------------------------------------------------------------------------- */

static uint32_t hash_of(qn_num at, uint32_t axis) {
  uint64_t exponents = (uint64_t)(uint16_t)at.a << 32 | (uint64_t)(uint16_t)at.b << 8 | axis;
  uint64_t h = (uint64_t)at.u.m * 0x9E3779B97F4A7C15u ^ exponents * 0xC2B2AE3D27D4EB4Fu;
  h ^= h >> 29;
  h *= 0xBF58476D1CE4E5B9u;
  return (uint32_t)(h >> 32);
}

static int same(const qn_place *x, const qn_place *y) {
  return x->hash == y->hash && x->axis == y->axis && x->at.u.m == y->at.u.m && x->at.a == y->at.a && x->at.b == y->at.b;
}

/* Where the place is or belongs. */
static size_t find(const qn_key_table *t, const qn_place *places, const qn_place *p) {
  size_t i = p->hash & (t->slot_count - 1);
  while (t->slots[i] && !same(&places[t->slots[i] - 1], p)) {
    i = (i + 1) & (t->slot_count - 1);
  }
  return i;
}

static int widen(qn_key_table *t, qn_mem *mem, const qn_place *places, size_t count) {
  size_t n = t->slot_count ? t->slot_count * 2 : 64;
  uint32_t *slots = qn_alloc_zeroed(mem, n * sizeof *slots);
  if (!slots) {
    return 0;
  }
  qn_free(mem, t->slots, t->slot_count * sizeof *t->slots);
  t->slots = slots;
  t->slot_count = n;
  for (size_t i = 0; i < count; i++) {
    slots[find(t, places, &places[i])] = (uint32_t)i + 1;
  }
  return 1;
}

uint32_t qn_key_of(qn_maker *m, int axis, qn_num at) {
  qn_batch *b = m->batch;
  qn_key_table *t = &m->keys;
  if (at.kind != QN_NUM_SMALL) {
    return 0;
  }
  if (2 * (b->place_count + 1) > t->slot_count && !widen(t, m->mem, b->places, b->place_count)) {
    return UINT32_MAX;
  }
  qn_place p = {at, (uint32_t)axis, hash_of(at, (uint32_t)axis)};
  size_t i = find(t, b->places, &p);
  if (!t->slots[i]) {
    if (!qn_grow(m->mem, &b->places, &b->place_capacity, b->place_count + 1)) {
      return UINT32_MAX;
    }
    b->places[b->place_count++] = p;
    t->slots[i] = (uint32_t)b->place_count;
  }
  return t->slots[i];
}

/* --- all batches -------------------------------------------------------------------------------------------------- */

enum { PARTS = 64, FEW = 1 << 14 }; /* fewer places than FEW are one part */

/* order[i]: the places of batch i, those of part p from dealt[i][p] to dealt[i][p + 1]. */
typedef struct joining { qn_building *b; size_t parts; uint32_t (*dealt)[PARTS + 1]; uint32_t **order, *keys; } joining;

static size_t part_of(const joining *j, const qn_place *p) {
  return j->parts == 1 ? 0 : p->hash >> 26;
}

static quoin_status deal(void *user, unsigned thread, size_t i) {
  (void)thread;
  joining *j = user;
  qn_batch *t = &j->b->batches[i];
  uint32_t *dealt = j->dealt[i], at[PARTS];
  t->global = qn_alloc(j->b->mem, t->place_count * sizeof *t->global);
  j->order[i] = qn_alloc(j->b->mem, t->place_count * sizeof **j->order);
  if (!t->global || !j->order[i]) {
    return QUOIN_E_MEMORY;
  }
  for (size_t p = 0; p < t->place_count; p++) {
    dealt[part_of(j, &t->places[p]) + 1]++;
  }
  for (size_t p = 0; p < PARTS; p++) {
    at[p] = dealt[p];
    dealt[p + 1] += dealt[p];
  }
  for (size_t p = 0; p < t->place_count; p++) {
    j->order[i][at[part_of(j, &t->places[p])]++] = (uint32_t)p;
  }
  return QUOIN_OK;
}

/* Numbers the places of one part, first come, first numbered, from 1. */
static quoin_status join_part(void *user, unsigned thread, size_t number) {
  (void)thread;
  joining *j = user;
  qn_mem *mem = j->b->mem;
  size_t most = 0, slot_count = 16, count = 0;
  for (size_t i = 0; i < j->b->batch_count; i++) {
    most += j->dealt[i][number + 1] - j->dealt[i][number];
  }
  while (slot_count < 2 * most) {
    slot_count *= 2;
  }
  qn_place *places = qn_alloc(mem, most * sizeof *places);
  qn_key_table t = {qn_alloc_zeroed(mem, slot_count * sizeof *t.slots), slot_count};
  quoin_status status = places && t.slots ? QUOIN_OK : QUOIN_E_MEMORY;
  for (size_t i = 0; i < j->b->batch_count && status == QUOIN_OK; i++) {
    qn_batch *batch = &j->b->batches[i];
    for (size_t k = j->dealt[i][number]; k < j->dealt[i][number + 1]; k++) {
      uint32_t p = j->order[i][k];
      size_t slot = find(&t, places, &batch->places[p]);
      if (!t.slots[slot]) {
        places[count++] = batch->places[p];
        t.slots[slot] = (uint32_t)count;
      }
      batch->global[p] = t.slots[slot];
    }
  }
  j->keys[number] = (uint32_t)count;
  qn_free(mem, places, most * sizeof *places);
  qn_free(mem, t.slots, slot_count * sizeof *t.slots);
  return status;
}

static quoin_status renumber(void *user, unsigned thread, size_t i) {
  (void)thread;
  joining *j = user;
  qn_batch *t = &j->b->batches[i];
  for (size_t p = 0; p < t->place_count; p++) {
    t->global[p] = (t->global[p] + j->keys[part_of(j, &t->places[p])]) | QN_KEY_FIRST;
  }
  return QUOIN_OK;
}

quoin_status qn_keys_join(qn_building *b) {
  size_t total = 0;
  for (size_t i = 0; i < b->batch_count; i++) {
    total += b->batches[i].place_count;
  }
  b->key_count = 1;
  if (total == 0) {
    return QUOIN_OK;
  }
  if (total >= UINT32_MAX / 2) {
    return QUOIN_E_LIMIT;
  }
  uint32_t keys[PARTS] = {0};
  joining j = {b, total < FEW ? 1 : PARTS, NULL, NULL, keys};
  j.dealt = qn_alloc_zeroed(b->mem, b->batch_count * sizeof *j.dealt);
  j.order = qn_alloc_zeroed(b->mem, b->batch_count * sizeof *j.order);
  quoin_status status = j.dealt && j.order ? QUOIN_OK : QUOIN_E_MEMORY;
  unsigned threads = total < FEW ? 1 : b->threads;
  status = status == QUOIN_OK ? qn_parallel(threads, b->batch_count, deal, &j, NULL) : status;
  status = status == QUOIN_OK ? qn_parallel(threads, j.parts, join_part, &j, NULL) : status;
  if (status == QUOIN_OK) {
    uint32_t at = 0;
    for (size_t p = 0; p < j.parts; p++) { /* each part's keys follow those before it; 0 is no key */
      uint32_t mine = keys[p];
      keys[p] = at;
      at += mine;
    }
    b->key_count = at + 1;
    status = qn_parallel(threads, b->batch_count, renumber, &j, NULL);
  }
  for (size_t i = 0; j.order && i < b->batch_count; i++) {
    qn_free(b->mem, j.order[i], b->batches[i].place_count * sizeof **j.order);
  }
  qn_free(b->mem, j.order, b->batch_count * sizeof *j.order);
  qn_free(b->mem, j.dealt, b->batch_count * sizeof *j.dealt);
  return status;
}
