/* Keys of aligned planes: a table of the places x_axis = at met so far. Numbers are canonical, so equal places have equal bytes. */
#include "scene/compile.h"

#include <string.h>

typedef struct place { qn_num at; uint32_t axis; } place;
typedef struct qn_key_table {
  place *places; /* key - 1 */
  size_t count, capacity;
  uint32_t *slots; /* key, 0 empty; a power of two of them, at most half of them used */
  size_t slot_count;
} qn_key_table;

static size_t slot_of(const place *p, size_t slot_count) {
  uint64_t exponents = (uint64_t)(uint16_t)p->at.a << 32 | (uint64_t)(uint16_t)p->at.b << 8 | p->axis;
  uint64_t h = (uint64_t)p->at.u.m * 0x9E3779B97F4A7C15u ^ exponents * 0xC2B2AE3D27D4EB4Fu;
  h ^= h >> 29;
  h *= 0xBF58476D1CE4E5B9u;
  return (size_t)(h >> 17) & (slot_count - 1);
}

static int same(const place *x, const place *y) {
  return x->axis == y->axis && x->at.u.m == y->at.u.m && x->at.a == y->at.a && x->at.b == y->at.b;
}

/* Where the place is or belongs. */
static size_t find(const qn_key_table *t, const place *p) {
  size_t i = slot_of(p, t->slot_count);
  while (t->slots[i] && !same(&t->places[t->slots[i] - 1], p)) {
    i = (i + 1) & (t->slot_count - 1);
  }
  return i;
}

static int widen(qn_key_table *t, qn_mem *mem) {
  size_t n = t->slot_count ? t->slot_count * 2 : 64;
  uint32_t *slots = qn_alloc_zeroed(mem, n * sizeof *slots);
  if (!slots) {
    return 0;
  }
  qn_free(mem, t->slots, t->slot_count * sizeof *t->slots);
  t->slots = slots;
  t->slot_count = n;
  for (size_t i = 0; i < t->count; i++) {
    t->slots[find(t, &t->places[i])] = (uint32_t)i + 1;
  }
  return 1;
}

uint32_t qn_key_of(qn_building *b, int axis, qn_num at) {
  if (at.kind != QN_NUM_SMALL) {
    return 0;
  }
  if (!b->key_table && !(b->key_table = qn_alloc_zeroed(b->mem, sizeof *b->key_table))) {
    return UINT32_MAX;
  }
  qn_key_table *t = b->key_table;
  if (2 * (t->count + 1) > t->slot_count && !widen(t, b->mem)) {
    return UINT32_MAX;
  }
  place p = {at, (uint32_t)axis};
  size_t i = find(t, &p);
  if (!t->slots[i]) {
    if (!qn_grow(b->mem, &t->places, &t->capacity, t->count + 1)) {
      return UINT32_MAX;
    }
    t->places[t->count++] = p;
    t->slots[i] = (uint32_t)t->count;
  }
  return t->slots[i];
}

void qn_keys_free(qn_building *b) {
  qn_key_table *t = b->key_table;
  if (t) {
    qn_free(b->mem, t->places, t->capacity * sizeof *t->places);
    qn_free(b->mem, t->slots, t->slot_count * sizeof *t->slots);
    qn_free(b->mem, t, sizeof *t);
    b->key_table = NULL;
  }
}
