/* The index of surfaces: lists by hash of cells; and the walk over the boxes of leaves. */
#include "scene/near_parts.h"

#include <string.h>

/* --- a table of lists by hash ---------------------------------------------------------------------------------------- */

static uint64_t mix(uint64_t h, int64_t v) {
  h = (h ^ (uint64_t)v) * 0x9E3779B97F4A7C15u;
  return h ^ h >> 29;
}

static void link_in(qn_near_table *t, uint32_t i) {
  size_t head = (size_t)(t->entries[i].hash >> 20) & (t->head_count - 1);
  t->entries[i].next = t->heads[head];
  t->heads[head] = i;
}

static int put(qn_near_table *t, qn_mem *mem, uint64_t hash, uint32_t what) {
  if (t->count >= UINT32_MAX - 1 || !qn_grow(mem, &t->entries, &t->capacity, t->count + 1)) {
    return 0;
  }
  t->entries[t->count].hash = hash;
  t->entries[t->count].what = what;
  t->count++;
  if (t->count > t->head_count) {
    size_t n = t->head_count ? 2 * t->head_count : 256;
    uint32_t *heads = qn_alloc(mem, n * sizeof *heads);
    if (!heads) {
      t->count--;
      return 0;
    }
    qn_free(mem, t->heads, t->head_count * sizeof *heads);
    t->heads = heads;
    t->head_count = n;
    memset(heads, 0xff, n * sizeof *heads);
    for (uint32_t i = 0; i < t->count; i++) {
      link_in(t, i);
    }
  } else {
    link_in(t, (uint32_t)t->count - 1);
  }
  return 1;
}

static uint32_t first_of(const qn_near_table *t, uint64_t hash) {
  uint32_t i = t->head_count ? t->heads[(size_t)(hash >> 20) & (t->head_count - 1)] : QN_NEAR_NONE;
  while (i != QN_NEAR_NONE && t->entries[i].hash != hash) {
    i = t->entries[i].next;
  }
  return i;
}
static uint32_t next_of(const qn_near_table *t, uint32_t i) {
  uint64_t hash = t->entries[i].hash;
  do {
    i = t->entries[i].next;
  } while (i != QN_NEAR_NONE && t->entries[i].hash != hash);
  return i;
}

static void table_free(qn_near_table *t, qn_mem *mem) {
  qn_free(mem, t->entries, t->capacity * sizeof *t->entries);
  qn_free(mem, t->heads, t->head_count * sizeof *t->heads);
}

static int64_t cell(double v, double width) {
  double c = v / width;
  /* cppcheck-suppress incorrectLogicOperator ; it does not read hexadecimal exponents */
  if (!(c < 0x1p60 && c > -0x1p60)) { /* beyond, all are in one cell; differences do not overflow */
    return c < 0 ? -((int64_t)1 << 60) : (int64_t)1 << 60;
  }
  int64_t whole = (int64_t)c;
  return whole - ((double)whole > c); /* downward, without a call of floor for each of the many cells */
}

/* --- the index ------------------------------------------------------------------------------------------------------- */

static uint64_t direction_hash(const double n[3], double width, int level) {
  uint64_t h = (uint64_t)level + 1;
  for (int k = 0; k < 3; k++) {
    h = mix(h, cell(n[k], width));
  }
  return h;
}

static int group_of(qn_near_finder *f, const qn_near_item *it, uint32_t *out) {
  uint64_t hash = direction_hash(it->n, QN_NEAR_GROUP_CELL, QN_NEAR_LEVELS);
  for (uint32_t e = first_of(&f->exact_directions, hash); e != QN_NEAR_NONE; e = next_of(&f->exact_directions, e)) {
    const qn_near_group *g = &f->groups[f->exact_directions.entries[e].what];
    if (fabs(g->n[0] - it->n[0]) <= QN_NEAR_GROUP_CELL && fabs(g->n[1] - it->n[1]) <= QN_NEAR_GROUP_CELL && fabs(g->n[2] - it->n[2]) <= QN_NEAR_GROUP_CELL) {
      *out = f->exact_directions.entries[e].what;
      return 1;
    }
  }
  *out = (uint32_t)f->group_count;
  if (!qn_grow(f->mem, &f->groups, &f->group_capacity, f->group_count + 1) || !put(&f->exact_directions, f->mem, hash, *out)) {
    return 0;
  }
  memcpy(f->groups[*out].n, it->n, sizeof it->n);
  f->groups[*out].first = QN_NEAR_NONE;
  f->group_count++;
  for (int level = 0; level < QN_NEAR_LEVELS; level++) {
    if ((f->levels >> level & 1) && !put(&f->directions, f->mem, direction_hash(it->n, qn_near_direction_cell(level), level), *out)) {
      return 0;
    }
  }
  return 1;
}

static uint64_t offset_hash(uint32_t g, int64_t c) {
  return mix(mix(7, g), c);
}

static uint64_t centre_hash(int level, int64_t shape, const int64_t c[3]) {
  return mix(mix(mix(mix(mix(11, level), shape), c[0]), c[1]), c[2]);
}

int qn_near_add(qn_near_finder *f, uint32_t i) {
  qn_near_item *it = &f->items[i];
  it->indexed = 1;
  if (it->kind == QN_NEAR_PLANE) {
    uint32_t g;
    if (!group_of(f, it, &g)) {
      return 0;
    }
    f->next_in_group[i] = f->groups[g].first;
    f->groups[g].first = i;
    return put(&f->offsets, f->mem, offset_hash(g, cell(it->d, f->offset_cell)), i);
  }
  for (int level = it->level; level < QN_NEAR_CENTRE_LEVELS; level++) {
    int64_t c[3];
    for (int k = 0; k < 3; k++) {
      c[k] = cell(it->n[k], qn_near_centre_cell(f, level));
    }
    if ((f->centre_levels >> level & 1) && !put(&f->centres, f->mem, centre_hash(level, cell(it->d, QN_NEAR_SHAPE_CELL), c), i)) {
      return 0;
    }
  }
  return 1;
}

static int note(qn_near_finder *f, uint32_t i) {
  if (!qn_grow(f->mem, &f->found, &f->found_capacity, f->found_count + 1)) {
    return 0;
  }
  f->found[f->found_count++] = i;
  return 1;
}

/* Whether doubles allow the planes to be near; a: the smaller. */
static int may_be_near(const qn_near_finder *f, const qn_near_item *a, const qn_near_item *b, int turn) {
  double e[3], sum = a->d - turn * b->d, spread = 0, size = fabs(a->d) + fabs(b->d), tilt = 0;
  for (int k = 0; k < 3; k++) {
    e[k] = a->n[k] - turn * b->n[k];
    tilt = fmax(tilt, fabs(e[k]));
  }
  int parallel = tilt <= 4 * QN_NEAR_NORMAL; /* it may be */
  if (!parallel && !qn_near_close(f, a->region.min, a->region.max, b->region.min, b->region.max)) {
    return 0;
  }
  if (!isfinite(a->size)) { /* near only when parallel */
    return parallel && fabs(sum) <= f->most + a->error + b->error + QN_NEAR_PLACE * size;
  }
  for (int k = 0; k < 3; k++) {
    double c = qn_near_middle(&a->region, k) - f->origin[k];
    sum += e[k] * c;
    spread += fabs(e[k]) * qn_near_half_extent(&a->region, k);
    size += fabs(c) + qn_near_half_extent(&a->region, k);
  }
  return fabs(sum) + spread <= f->most + a->error + b->error + QN_NEAR_PLACE * size;
}

static int planes_in_group(qn_near_finder *f, const qn_near_item *it, uint32_t g, int turn) {
  const qn_near_group *gr = &f->groups[g];
  double at = it->d, size = fabs(it->d), place[3], apart = 0;
  int bounded = isfinite(it->size) != 0;
  for (int k = 0; k < 3; k++) { /* a place to compare at: the region's middle, or the plane's nearest to O */
    place[k] = bounded ? qn_near_middle(&it->region, k) - f->origin[k] : -it->d * it->n[k];
    at += it->n[k] * place[k];
    size += fabs(place[k]);
    apart = fmax(apart, fabs(it->n[k] - turn * gr->n[k]));
  }
  if (apart > qn_near_angle(f, it) + 2 * QN_NEAR_GROUP_CELL) {
    return 1;
  }
  double want = turn * at; /* s of the group's plane at the place, so d = want - n.place */
  for (int k = 0; k < 3; k++) {
    want -= gr->n[k] * place[k];
  }
  double room = f->most + it->error + f->plane_error + 4 * QN_NEAR_GROUP_CELL * size;
  int64_t low = cell(want - room, f->offset_cell), high = cell(want + room, f->offset_cell);
  if (high - low > 64 || !isfinite(room)) {
    for (uint32_t i = gr->first; i != QN_NEAR_NONE; i = f->next_in_group[i]) {
      f->compared++;
      if (may_be_near(f, it, &f->items[i], turn) && !note(f, i)) {
        return 0;
      }
    }
    return 1;
  }
  for (int64_t c = low; c <= high; c++) {
    uint64_t hash = offset_hash(g, c);
    for (uint32_t e = first_of(&f->offsets, hash); e != QN_NEAR_NONE; e = next_of(&f->offsets, e)) {
      f->compared++;
      if (may_be_near(f, it, &f->items[f->offsets.entries[e].what], turn) && !note(f, f->offsets.entries[e].what)) {
        return 0;
      }
    }
  }
  return 1;
}

int qn_near_planes(qn_near_finder *f, const qn_near_item *it, int level) {
  double width = qn_near_direction_cell(level), reach = level == it->level ? qn_near_angle(f, it) + 2 * QN_NEAR_GROUP_CELL : 4 * QN_NEAR_NORMAL + 2 * QN_NEAR_GROUP_CELL;
  for (int turn = 1; turn >= -1; turn -= 2) {
    int64_t low[3], high[3];
    for (int k = 0; k < 3; k++) {
      low[k] = cell(turn * it->n[k] - reach, width);
      high[k] = cell(turn * it->n[k] + reach, width);
    }
    for (int64_t x = low[0]; x <= high[0]; x++) {
      for (int64_t y = low[1]; y <= high[1]; y++) {
        for (int64_t z = low[2]; z <= high[2]; z++) {
          uint64_t hash = mix(mix(mix((uint64_t)level + 1, x), y), z);
          for (uint32_t e = first_of(&f->directions, hash); e != QN_NEAR_NONE; e = next_of(&f->directions, e)) {
            if (!planes_in_group(f, it, f->directions.entries[e].what, turn)) {
              return 0;
            }
          }
        }
      }
    }
  }
  return 1;
}

static int curved_near_at(qn_near_finder *f, const qn_near_item *it, int level) {
  double width = qn_near_centre_cell(f, level);
  int64_t low[4], high[4];
  for (int k = 0; k < 3; k++) {
    double reach = f->most + 2 * it->error + width / 16; /* theirs is no larger than of this level */
    low[k] = cell(it->n[k] - reach, width);
    high[k] = cell(it->n[k] + reach, width);
  }
  low[3] = cell(it->d - 2 * QN_NEAR_SHAPE, QN_NEAR_SHAPE_CELL);
  high[3] = cell(it->d + 2 * QN_NEAR_SHAPE, QN_NEAR_SHAPE_CELL);
  for (int64_t shape = low[3]; shape <= high[3]; shape++) {
    int64_t c[3];
    for (c[0] = low[0]; c[0] <= high[0]; c[0]++) {
      for (c[1] = low[1]; c[1] <= high[1]; c[1]++) {
        for (c[2] = low[2]; c[2] <= high[2]; c[2]++) {
          uint64_t hash = centre_hash(level, shape, c);
          for (uint32_t e = first_of(&f->centres, hash); e != QN_NEAR_NONE; e = next_of(&f->centres, e)) {
            uint32_t i = f->centres.entries[e].what;
            const qn_near_item *other = &f->items[i];
            double square = 0, room = f->most + it->error + other->error;
            for (int k = 0; k < 3; k++) {
              square += (it->n[k] - other->n[k]) * (it->n[k] - other->n[k]);
            }
            f->compared++;
            if (square <= room * room * 4 && (it->level > other->level ? it->level : other->level) == level && !note(f, i)) {
              return 0;
            }
          }
        }
      }
    }
  }
  return 1;
}

int qn_near_curved(qn_near_finder *f, const qn_near_item *it) {
  int good = 1;
  for (int level = it->level; level < QN_NEAR_CENTRE_LEVELS && good; level++) {
    good = !(f->centre_levels >> level & 1) || curved_near_at(f, it, level);
  }
  return good;
}

/* --- by boxes, for planes that may be near at wide angles: then few parts are where they are ------------------------- */

enum { FEW_USERS = 8, FEW_MET = 256, FEW_UNBOUNDED = 64, FINE_LEVEL = 5 };

static void compare_with_leaf(qn_near_finder *f, uint32_t number) {
  const qn_leaf *leaf = &f->scene->leaves[number];
  const qn_half *halves = f->scene->halves + leaf->half0;
  for (uint32_t h = 0; h < leaf->halves && !f->refused; h++) {
    uint32_t other = halves[h].surface;
    const qn_near_item *it = &f->items[other];
    if (it->kind == QN_NEAR_PLANE && it->indexed && (may_be_near(f, f->asking, it, 1) || may_be_near(f, f->asking, it, -1))) {
      f->refused = !note(f, other);
    }
  }
}

static void meet_leaf(void *user, uint32_t number) {
  qn_near_finder *f = user;
  if (++f->met <= FEW_MET) {
    compare_with_leaf(f, number);
  }
}

int qn_near_boxes(qn_near_finder *f, uint32_t i, int *told) {
  const qn_near_item *it = &f->items[i];
  uint32_t users = f->users_of[i + 1] - f->users_of[i];
  uint64_t nodes = 0;
  *told = 0;
  if (it->level >= FINE_LEVEL || users > FEW_USERS || !(it->size <= 64 * f->unit) || f->scene->unbounded_count > FEW_UNBOUNDED) {
    return 1;
  }
  f->asking = it;
  f->met = 0;
  for (uint32_t u = f->users_of[i]; u < f->users_of[i + 1] && f->met <= FEW_MET && !f->refused; u++) {
    const qn_leaf *leaf = &f->scene->leaves[f->users[u]];
    double min[3], max[3];
    for (int k = 0; k < 3; k++) {
      min[k] = nextafter(leaf->min[k] - f->most, -INFINITY);
      max[k] = nextafter(leaf->max[k] + f->most, INFINITY);
    }
    qn_bvh_point(&f->scene->bvh, min, max, meet_leaf, f, &nodes);
  }
  for (size_t u = 0; u < f->scene->unbounded_count; u++) {
    compare_with_leaf(f, f->scene->unbounded[u]);
  }
  f->compared += f->met;
  *told = f->met <= FEW_MET;
  f->found_count = *told ? f->found_count : 0;
  return !f->refused;
}

void qn_near_index_free(qn_near_finder *f) {
  qn_free(f->mem, f->groups, f->group_capacity * sizeof *f->groups);
  table_free(&f->directions, f->mem);
  table_free(&f->exact_directions, f->mem);
  table_free(&f->offsets, f->mem);
  table_free(&f->centres, f->mem);
}
