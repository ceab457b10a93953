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

static uint64_t centre_hash(int level, int64_t shape, const int64_t c[4]) {
  return mix(mix(mix(mix(mix(mix(11, level), shape), c[0]), c[1]), c[2]), c[3]);
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
    int64_t c[4] = {0, 0, 0, cell(it->radius, qn_near_centre_cell(f, level))};
    for (int k = 0; k < 3; k++) {
      c[k] = cell(it->n[k], qn_near_centre_cell(f, level));
    }
    if ((f->centre_levels >> level & 1) && !put(&f->centres, f->mem, centre_hash(level, cell(it->d, QN_NEAR_SHAPE_CELL), c), i)) {
      return 0;
    }
  }
  return 1;
}

static int note(qn_near_finder *f, uint32_t i, double least) {
  if (!qn_grow(f->mem, &f->found, &f->found_capacity, f->found_count + 1)) {
    return 0;
  }
  f->found[f->found_count++] = (qn_near_candidate){least > 0 ? least : 0, i};
  return 1;
}

/* Whether doubles allow the planes to be near, and what their gap is at least; a: the smaller. */
static int may_be_near(const qn_near_finder *f, const qn_near_item *a, const qn_near_item *b, int turn, double *least) {
  double e[3], sum = a->d - turn * b->d, spread = 0, size = fabs(a->d) + fabs(b->d), tilt = 0;
  for (int k = 0; k < 3; k++) {
    e[k] = a->n[k] - turn * b->n[k];
    tilt = fmax(tilt, fabs(e[k]));
  }
  int parallel = tilt <= 4 * QN_NEAR_NORMAL; /* it may be */
  if (!isfinite(a->size)) { /* near only when parallel */
    *least = fabs(sum) - (a->error + b->error + QN_NEAR_PLACE * size);
    return parallel && !(*least > f->most);
  }
  for (int k = 0; k < 3; k++) {
    double c = qn_near_middle(&a->region, k) - f->origin[k];
    sum += e[k] * c;
    spread += fabs(e[k]) * qn_near_half_extent(&a->region, k);
    size += fabs(c) + qn_near_half_extent(&a->region, k);
  }
  *least = fabs(sum) + spread - (a->error + b->error + QN_NEAR_PLACE * size);
  return !(*least > f->most) && (parallel || qn_near_close(f, a->region.min, a->region.max, b->region.min, b->region.max));
}

/* reach: how far apart normals may be. */
static int planes_in_group(qn_near_finder *f, const qn_near_item *it, double reach, uint32_t g, int turn) {
  const qn_near_group *gr = &f->groups[g];
  double at = it->d, size = fabs(it->d), place[3], least;
  f->compared++;
  for (int k = 0; k < 3; k++) {
    if (fabs(it->n[k] - turn * gr->n[k]) > reach) {
      return 1;
    }
  }
  int bounded = isfinite(it->size) != 0;
  for (int k = 0; k < 3; k++) { /* a place to compare at: the region's middle, or the plane's nearest to O */
    place[k] = bounded ? qn_near_middle(&it->region, k) - f->origin[k] : -it->d * it->n[k];
    at += it->n[k] * place[k];
    size += fabs(place[k]);
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
      if (may_be_near(f, it, &f->items[i], turn, &least) && !note(f, i, least)) {
        return 0;
      }
    }
    return 1;
  }
  for (int64_t c = low; c <= high; c++) {
    uint64_t hash = offset_hash(g, c);
    for (uint32_t e = first_of(&f->offsets, hash); e != QN_NEAR_NONE; e = next_of(&f->offsets, e)) {
      f->compared++;
      if (may_be_near(f, it, &f->items[f->offsets.entries[e].what], turn, &least) && !note(f, f->offsets.entries[e].what, least)) {
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
            if (!planes_in_group(f, it, reach, f->directions.entries[e].what, turn)) {
              return 0;
            }
          }
        }
      }
    }
  }
  return 1;
}

/* Whether doubles allow curved surfaces to be near but for their shapes; a: the smaller. */
static int may_be_near_curved(const qn_near_finder *f, const qn_near_item *a, const qn_near_item *b, double *least) {
  double square = 0, off = a->error + b->error;
  for (int k = 0; k < 3; k++) {
    square += (a->n[k] - b->n[k]) * (a->n[k] - b->n[k]);
  }
  *least = sqrt(square) - 2 * off;
  return !(*least > f->most) && fabs(a->radius - b->radius) <= 2 * (a->reach + off);
}

static int curved_near_at(qn_near_finder *f, const qn_near_item *it, int level) {
  double width = qn_near_centre_cell(f, level), least;
  int64_t low[5], high[5];
  for (int k = 0; k < 4; k++) {
    double at = k < 3 ? it->n[k] : it->radius, reach = (k < 3 ? f->most : 2 * it->reach) + 2 * it->error + width / 16; /* theirs is no larger than of this level */
    low[k] = cell(at - reach, width);
    high[k] = cell(at + reach, width);
  }
  low[4] = cell(it->d - 2 * QN_NEAR_SHAPE, QN_NEAR_SHAPE_CELL);
  high[4] = cell(it->d + 2 * QN_NEAR_SHAPE, QN_NEAR_SHAPE_CELL);
  for (int64_t shape = low[4]; shape <= high[4]; shape++) {
    int64_t c[4];
    for (c[0] = low[0]; c[0] <= high[0]; c[0]++) {
      for (c[1] = low[1]; c[1] <= high[1]; c[1]++) {
        for (c[2] = low[2]; c[2] <= high[2]; c[2]++) {
          for (c[3] = low[3]; c[3] <= high[3]; c[3]++) {
            uint64_t hash = centre_hash(level, shape, c);
            for (uint32_t e = first_of(&f->centres, hash); e != QN_NEAR_NONE; e = next_of(&f->centres, e)) {
              uint32_t i = f->centres.entries[e].what;
              const qn_near_item *other = &f->items[i];
              f->compared++;
              if ((it->level > other->level ? it->level : other->level) == level && may_be_near_curved(f, it, other, &least) && !note(f, i, least)) {
                return 0;
              }
            }
          }
        }
      }
    }
  }
  return 1;
}

/* One whose radius may be very unlike theirs is compared with each. */
static int curved_near_any(qn_near_finder *f, const qn_near_item *it) {
  double least;
  for (uint32_t i = 0; i < f->scene->surface_count; i++) {
    const qn_near_item *other = &f->items[i];
    f->compared++;
    if (other->indexed && other->kind == QN_NEAR_CURVED && fabs(it->d - other->d) <= 2 * QN_NEAR_SHAPE && may_be_near_curved(f, it, other, &least) && !note(f, i, least)) {
      return 0;
    }
  }
  return 1;
}

int qn_near_curved(qn_near_finder *f, const qn_near_item *it) {
  int good = 1;
  if (!(it->reach <= 4 * qn_near_centre_cell(f, it->level))) {
    return curved_near_any(f, it);
  }
  for (int level = it->level; level < QN_NEAR_CENTRE_LEVELS && good; level++) {
    good = !(f->centre_levels >> level & 1) || curved_near_at(f, it, level);
  }
  return good;
}

/* --- by boxes, for planes that may be near at wide angles: then few parts are where they are ------------------------- */

enum { FEW_USERS = 8, FEW_UNBOUNDED = 64, FINE_LEVEL = 5 };

static void compare_with_leaf(qn_near_finder *f, uint32_t number) {
  const qn_leaf *leaf = &f->scene->leaves[number];
  const qn_half *halves = f->scene->halves + leaf->half0;
  for (uint32_t h = 0; h < leaf->halves && !f->refused; h++) {
    uint32_t other = halves[h].surface;
    const qn_near_item *it = &f->items[other];
    f->compared++;
    double least;
    if (it->kind == QN_NEAR_PLANE && it->indexed && (may_be_near(f, f->asking, it, 1, &least) || may_be_near(f, f->asking, it, -1, &least))) {
      f->refused = !note(f, other, least);
    }
  }
}

/* Leaves whose boxes meet [min, max], into f->met_leaves after those that are there; 0: there are more than QN_NEAR_FEW_MET. The walk ends there: in a crowd it would be one over all. */
static int meet_leaves(qn_near_finder *f, const double min[3], const double max[3]) {
  const qn_bvh *bvh = &f->scene->bvh;
  uint32_t stack[QN_BVH_DEPTH * QN_BVH_WIDE];
  size_t top = 0;
  if (bvh->node_count) {
    stack[top++] = 0;
  }
  while (top) {
    const qn_bvh_node *n = &bvh->nodes[stack[--top]];
    for (int i = 0; i < QN_BVH_WIDE; i++) {
      int meets = 1;
      for (int k = 0; k < 3; k++) {
        meets &= (double)n->min[k][i] <= max[k] && (double)n->max[k][i] >= min[k];
      }
      if (!meets || n->child[i] == QN_BVH_NONE) {
        continue;
      }
      if (!(n->child[i] & QN_BVH_LEAF)) {
        stack[top++] = n->child[i];
      } else if (f->met == QN_NEAR_FEW_MET) {
        return 0;
      } else {
        f->met_leaves[f->met++] = bvh->items[n->child[i] & ~QN_BVH_LEAF];
      }
    }
  }
  return 1;
}

int qn_near_boxes(qn_near_finder *f, uint32_t i, int *told) {
  const qn_near_item *it = &f->items[i];
  uint32_t users = f->users_of[i + 1] - f->users_of[i];
  *told = 0;
  if (it->level >= FINE_LEVEL || users > FEW_USERS || !(it->size <= 64 * f->unit) || f->scene->unbounded_count > FEW_UNBOUNDED) {
    return 1;
  }
  f->asking = it;
  f->met = 0;
  for (uint32_t u = f->users_of[i]; u < f->users_of[i + 1]; u++) {
    const qn_leaf *leaf = &f->scene->leaves[f->users[u]];
    double min[3], max[3];
    for (int k = 0; k < 3; k++) {
      min[k] = nextafter(leaf->min[k] - f->most, -INFINITY);
      max[k] = nextafter(leaf->max[k] + f->most, INFINITY);
    }
    if (!meet_leaves(f, min, max)) {
      f->compared += QN_NEAR_FEW_MET;
      return 1;
    }
  }
  for (size_t u = 0; u < f->met; u++) {
    compare_with_leaf(f, f->met_leaves[u]);
  }
  for (size_t u = 0; u < f->scene->unbounded_count; u++) {
    compare_with_leaf(f, f->scene->unbounded[u]);
  }
  *told = 1;
  return !f->refused;
}

void qn_near_index_free(qn_near_finder *f) {
  qn_free(f->mem, f->groups, f->group_capacity * sizeof *f->groups);
  table_free(&f->directions, f->mem);
  table_free(&f->exact_directions, f->mem);
  table_free(&f->offsets, f->mem);
  table_free(&f->centres, f->mem);
}
