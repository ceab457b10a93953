/* Finding near surfaces. Doubles propose pairs, exact forms decide (gap.c).

   Surfaces are taken from the largest region to the smallest, those of one size in the order of the file. Each asks an index of those before
   it for candidates, and is then put into the index (of QN_NEAR_SNAP, when it stands).

   Legend: y = x - O, O amid the scene; h the half extents of a region, c its middle; T the limit.

   Planes: n.y + d, |n| = 1. Where |s1 - s2| <= T all over the region, its gradient e = n1 -+ n2 has |e_k| h_k <= T, so |e| <= sqrt 3 T / min h.
   Normals of one direction (to 2^-40) are one group; groups are found by cells of normals, as wide as the angle asked for, at one of
   several levels; a surface asks at its own level, and a group is in the cells of all levels that are asked at. In a group the
   planes are in cells of d: at c the standing plane must pass within T of the other, which says what its d is.

   Curved surfaces: equal quadratic parts have equal f = (w.A)^2 / A.A; their centres (of cylinders: the nearest place of the axis to O; of
   paraboloids: the vertex) are no further apart than the gap. Cells of f and of the centre; a surface whose centre is less well known is in
   wider cells, at a level of its own, and all ask at all levels from their own up.

   Every number here is a double with a bound of its error in the filter; none of them decides. */
#include "scene/near.h"

#include "base/limits.h"
#include "scene/compile.h"
#include "scene/fingerprint.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NONE UINT32_MAX

/* How many candidates are compared before the search for all pairs is cut, and how many pairs are kept. A search for a snap is never cut. */
enum { COMPARED = 1 << 26, KEPT = 1 << 20 };
/* Levels of cells: of normals 2^-6 to 2^-36 wide by steps of 2^-3; of centres by steps of 2^4. */
enum { LEVELS = 11, CENTRE_LEVELS = 16 };
/* Errors of the filter, relative: of a unit normal, of offsets and centres; of f. Generous: 2^10 roundings and more. */
#define NORMAL_ERROR 0x1p-46
#define PLACE_ERROR 0x1p-46
#define SHAPE_ERROR 0x1p-24
#define SHAPE_CELL 0x1p-20
#define GROUP_CELL 0x1p-40

typedef enum kind { NOT_LOOKED_FOR, PLANE, CURVED } kind;

typedef struct item {
  qn_region region;
  double size;
  double n[3], d; /* of a plane; of a curved surface its centre and f */
  double error;   /* of d, of the centre */
  uint8_t kind, level, indexed;
} item;

typedef struct entry { uint64_t hash; uint32_t what, next; } entry; /* what: surface or group */
typedef struct table {
  entry *entries;
  size_t count, capacity;
  uint32_t *heads;
  size_t head_count;
} table;

typedef struct group { double n[3]; uint32_t first; } group;

typedef struct finder {
  const quoin_scene *scene;
  qn_mem *mem;
  qn_near_want want;
  qn_num limit;
  double most;        /* of the limit, rounded up */
  double offset_cell, centre_cell;
  double plane_error; /* the largest */
  double origin[3];
  item *items;
  uint32_t *order, *next_in_group;
  group *groups;
  size_t group_count, group_capacity;
  table directions, exact_directions, offsets, centres;
  unsigned levels, centre_levels; /* bits: those that are asked at */
  uint32_t *found;
  size_t found_count, found_capacity;
  size_t compared;
  uint32_t *users, *users_of; /* leaves by surface, from users_of[i] to users_of[i + 1] */
  double unit;
  const item *asking;         /* of boxes_near */
  size_t met;
  int refused;
  qn_ctx ctx;
  qn_near_pairs *out;
} finder;

/* --- a table of lists by hash ---------------------------------------------------------------------------------------- */

static uint64_t mix(uint64_t h, int64_t v) {
  h = (h ^ (uint64_t)v) * 0x9E3779B97F4A7C15u;
  return h ^ h >> 29;
}

static void link_in(table *t, uint32_t i) {
  size_t head = (size_t)(t->entries[i].hash >> 20) & (t->head_count - 1);
  t->entries[i].next = t->heads[head];
  t->heads[head] = i;
}

static int put(table *t, qn_mem *mem, uint64_t hash, uint32_t what) {
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

static uint32_t first_of(const table *t, uint64_t hash) {
  uint32_t i = t->head_count ? t->heads[(size_t)(hash >> 20) & (t->head_count - 1)] : NONE;
  while (i != NONE && t->entries[i].hash != hash) {
    i = t->entries[i].next;
  }
  return i;
}
static uint32_t next_of(const table *t, uint32_t i) {
  uint64_t hash = t->entries[i].hash;
  do {
    i = t->entries[i].next;
  } while (i != NONE && t->entries[i].hash != hash);
  return i;
}

static void table_free(table *t, qn_mem *mem) {
  qn_free(mem, t->entries, t->capacity * sizeof *t->entries);
  qn_free(mem, t->heads, t->head_count * sizeof *t->heads);
}

static int64_t cell(double v, double width) {
  double c = floor(v / width);
  return c > -0x1p62 && c < 0x1p62 ? (int64_t)c : 0; /* beyond, all are in one cell */
}

/* --- what doubles know of a surface ---------------------------------------------------------------------------------- */

static double middle(const qn_region *r, int k) {
  return 0.5 * r->min[k] + 0.5 * r->max[k];
}
static double half_extent(const qn_region *r, int k) {
  return (0.5 * r->max[k] - 0.5 * r->min[k]) * (1 + 0x1p-50);
}

static void look_at_plane(const finder *f, const qn_leaf *leaf, const qn_plane_shadow *p, item *it) {
  double length = sqrt(p->n[0] * p->n[0] + p->n[1] * p->n[1] + p->n[2] * p->n[2]), d = p->d, size = fabs(p->d);
  for (int k = 0; k < 3; k++) {
    double term = p->n[k] * (leaf->pivot[k] - f->origin[k]);
    d -= term;
    size += fabs(term);
    it->n[k] = p->n[k] / length;
  }
  it->d = d / length;
  it->error = PLACE_ERROR * size / length;
  it->kind = isfinite(it->error) && length > 0x1p-400 && length < 0x1p400 ? PLANE : NOT_LOOKED_FOR;
}

/* Columns of the inverse of the rows' 3x3 part; 0 where rows are too nearly dependent for doubles. */
static int invert(double row[3][4], double inverse[3][3]) {
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < 3; i++) {
      int a = (i + 1) % 3, b = (i + 2) % 3, c = (k + 1) % 3, d = (k + 2) % 3;
      inverse[k][i] = row[a][c] * row[b][d] - row[a][d] * row[b][c];
    }
  }
  double det = 0;
  for (int k = 0; k < 3; k++) {
    det += row[0][k] * inverse[k][0];
  }
  for (int i = 0; i < 9; i++) {
    inverse[i / 3][i % 3] /= det;
  }
  return fabs(det) > 0x1p-16; /* of unit rows */
}

static void look_at_body(const finder *f, const qn_leaf *leaf, const qn_quadric_shadow *q, item *it) {
  static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  static const double weight[6] = {0.7548776662466927, 0.5698402909980532, 0.8191725133961644, 0.6710436067037893, 0.5497004779019703, 0.9318321442141524};
  double row[3][4], s[3], inverse[3][3], X[3] = {0, 0, 0}, l = q->l;
  it->kind = NOT_LOOKED_FOR;
  for (int i = 0; i < 3; i++) {
    const double *r = q->row[i];
    double length = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    if (!(length > 0x1p-200 && length < 0x1p200)) {
      return;
    }
    for (int j = 0; j < 4; j++) {
      row[i][j] = r[j] / length;
    }
    s[i] = q->s[i] * length * length;
    l = i == 2 ? q->l * length : l;
  }
  if (!invert(row, inverse) || s[0] == 0 || s[1] == 0) {
    return;
  }
  X[2] = s[2] != 0 ? -l / s[2] : l != 0 ? -q->k / (2 * l) : 0;
  double size = 0, along = 0, w2 = 0;
  for (int k = 0; k < 3; k++) {
    double at = leaf->pivot[k] - f->origin[k];
    size += fabs(at);
    for (int i = 0; i < 3; i++) {
      double term = inverse[k][i] * (X[i] - row[i][3]);
      at += term;
      size += fabs(inverse[k][i]) * (fabs(X[i]) + fabs(row[i][3]));
    }
    it->n[k] = at;
    along += at * inverse[k][2];
    w2 += inverse[k][2] * inverse[k][2];
  }
  if (s[2] == 0 && l == 0) { /* of the axis, the place nearest to O */
    for (int k = 0; k < 3; k++) {
      it->n[k] -= along / w2 * inverse[k][2];
    }
  }
  double most = 0;
  for (int i = 0; i < 9; i++) {
    most = fmax(most, fabs(inverse[i / 3][i % 3]));
  }
  it->error = PLACE_ERROR * (most < 4 ? 1 : 0x1p16) * size; /* rows nearly orthogonal: the usual thing */
  double A2 = 0, wA = 0, magnitude = 0;
  for (int c = 0; c < 6; c++) {
    double a = 0;
    for (int i = 0; i < 3; i++) {
      double term = s[i] * row[i][pair[c][0]] * row[i][pair[c][1]] * (c < 3 ? 1 : 2);
      a += term;
      magnitude += fabs(term);
    }
    A2 += a * a;
    wA += weight[c] * a;
  }
  it->d = wA * wA / A2;
  if (isfinite(it->error) && isfinite(it->d) && magnitude * magnitude < 0x1p32 * A2) { /* f is known to 2^-48 2^16 and a few bits */
    it->kind = CURVED;
  }
}

/* To 20 bits: boxes are rounded, and parts of one size should count as that. */
static double rounded_size(double size) {
  int e;
  double m = frexp(size, &e);
  return isfinite(size) ? ldexp(nearbyint(ldexp(m, 20)), e - 20) : size;
}

static void look_at(const finder *f, uint32_t i, item *it) {
  const quoin_scene *s = f->scene;
  const qn_surface *surface = &s->surfaces[i];
  const qn_leaf *leaf = &s->leaves[surface->leaf];
  const qn_half *half = &s->halves[surface->half];
  if (surface->kind == QN_PLANE) {
    look_at_plane(f, leaf, &s->planes[half->shadow], it);
  } else if (surface->kind == QN_QUADRIC_BODY) {
    look_at_body(f, leaf, &s->quadrics[half->shadow], it);
  }
  it->size = 0;
  for (int k = 0; k < 3; k++) {
    it->size += it->region.max[k] - it->region.min[k];
  }
  it->size = it->size >= 0 ? rounded_size(it->size) : INFINITY;
}

/* The greatest angle (as a distance of unit normals) at which another plane can be near this one. */
static double angle_of(const finder *f, const item *it) {
  double least = INFINITY;
  for (int k = 0; k < 3; k++) {
    least = fmin(least, half_extent(&it->region, k));
  }
  double angle = 4 * NORMAL_ERROR + (isfinite(least) && isfinite(it->size) ? 2 * (f->most + it->error) / least : 0), widest = ldexp(1, -QN_NEAR_ANGLE / 2 + 1);
  return angle < widest ? angle : widest; /* also when it is not a number */
}
static double direction_cell(int level) {
  return ldexp(1, 2 - QN_NEAR_ANGLE / 2 - 3 * level); /* twice the widest angle, then finer */
}
static uint8_t level_of(const finder *f, const item *it) {
  double angle = angle_of(f, it);
  int level = 0;
  while (level + 1 < LEVELS && direction_cell(level + 1) >= 2 * (angle + 2 * GROUP_CELL)) {
    level++;
  }
  return (uint8_t)level;
}

static int by_size(const void *a, const void *b, const item *items) {
  uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
  return items[x].size != items[y].size ? (items[x].size < items[y].size) - (items[x].size > items[y].size) : (x > y) - (x < y);
}

/* Merge sort: qsort takes no context. */
static int sort_order(finder *f, size_t n) {
  uint32_t *other = qn_alloc(f->mem, n * sizeof *other), *from = f->order, *to = other;
  if (!other) {
    return 0;
  }
  for (size_t width = 1; width < n; width *= 2) {
    for (size_t i = 0; i < n; i += 2 * width) {
      size_t a = i, a_end = i + width < n ? i + width : n, b = a_end, b_end = i + 2 * width < n ? i + 2 * width : n;
      for (size_t k = i; k < b_end; k++) {
        to[k] = a < a_end && (b == b_end || by_size(&from[a], &from[b], f->items) <= 0) ? from[a++] : from[b++];
      }
    }
    uint32_t *swap = from;
    from = to;
    to = swap;
  }
  if (from != f->order) {
    memcpy(f->order, from, n * sizeof *from);
  }
  qn_free(f->mem, other, n * sizeof *other);
  return 1;
}

/* --- the index ------------------------------------------------------------------------------------------------------- */

static uint64_t direction_hash(const double n[3], double width, int level) {
  uint64_t h = (uint64_t)level + 1;
  for (int k = 0; k < 3; k++) {
    h = mix(h, cell(n[k], width));
  }
  return h;
}

static int group_of(finder *f, const item *it, uint32_t *out) {
  uint64_t hash = direction_hash(it->n, GROUP_CELL, LEVELS);
  for (uint32_t e = first_of(&f->exact_directions, hash); e != NONE; e = next_of(&f->exact_directions, e)) {
    const group *g = &f->groups[f->exact_directions.entries[e].what];
    if (fabs(g->n[0] - it->n[0]) <= GROUP_CELL && fabs(g->n[1] - it->n[1]) <= GROUP_CELL && fabs(g->n[2] - it->n[2]) <= GROUP_CELL) {
      *out = f->exact_directions.entries[e].what;
      return 1;
    }
  }
  *out = (uint32_t)f->group_count;
  if (!qn_grow(f->mem, &f->groups, &f->group_capacity, f->group_count + 1) || !put(&f->exact_directions, f->mem, hash, *out)) {
    return 0;
  }
  memcpy(f->groups[*out].n, it->n, sizeof it->n);
  f->groups[*out].first = NONE;
  f->group_count++;
  for (int level = 0; level < LEVELS; level++) {
    if ((f->levels >> level & 1) && !put(&f->directions, f->mem, direction_hash(it->n, direction_cell(level), level), *out)) {
      return 0;
    }
  }
  return 1;
}

static uint64_t offset_hash(uint32_t g, int64_t c) {
  return mix(mix(7, g), c);
}

static double centre_cell(const finder *f, int level) {
  return ldexp(f->centre_cell, 4 * level);
}
static uint64_t centre_hash(int level, int64_t shape, const int64_t c[3]) {
  return mix(mix(mix(mix(mix(11, level), shape), c[0]), c[1]), c[2]);
}

static int add(finder *f, uint32_t i) {
  item *it = &f->items[i];
  it->indexed = 1;
  if (it->kind == PLANE) {
    uint32_t g;
    if (!group_of(f, it, &g)) {
      return 0;
    }
    f->next_in_group[i] = f->groups[g].first;
    f->groups[g].first = i;
    return put(&f->offsets, f->mem, offset_hash(g, cell(it->d, f->offset_cell)), i);
  }
  for (int level = it->level; level < CENTRE_LEVELS; level++) {
    int64_t c[3];
    for (int k = 0; k < 3; k++) {
      c[k] = cell(it->n[k], centre_cell(f, level));
    }
    if ((f->centre_levels >> level & 1) && !put(&f->centres, f->mem, centre_hash(level, cell(it->d, SHAPE_CELL), c), i)) {
      return 0;
    }
  }
  return 1;
}

static int note(finder *f, uint32_t i) {
  if (!qn_grow(f->mem, &f->found, &f->found_capacity, f->found_count + 1)) {
    return 0;
  }
  f->found[f->found_count++] = i;
  return 1;
}

static int come_close(const finder *f, const double min[3], const double max[3], const double other_min[3], const double other_max[3]) {
  for (int k = 0; k < 3; k++) {
    if (nextafter(min[k] - f->most, -INFINITY) > other_max[k] || nextafter(other_min[k] - f->most, -INFINITY) > max[k]) {
      return 0;
    }
  }
  return 1;
}

/* Whether doubles allow the planes to be near; a: the smaller. */
static int may_be_near(const finder *f, const item *a, const item *b, int turn) {
  double e[3], sum = a->d - turn * b->d, spread = 0, size = fabs(a->d) + fabs(b->d), tilt = 0;
  for (int k = 0; k < 3; k++) {
    e[k] = a->n[k] - turn * b->n[k];
    tilt = fmax(tilt, fabs(e[k]));
  }
  int parallel = tilt <= 4 * NORMAL_ERROR; /* it may be */
  if (!parallel && !come_close(f, a->region.min, a->region.max, b->region.min, b->region.max)) {
    return 0;
  }
  if (!isfinite(a->size)) { /* near only when parallel */
    return parallel && fabs(sum) <= f->most + a->error + b->error + PLACE_ERROR * size;
  }
  for (int k = 0; k < 3; k++) {
    double c = middle(&a->region, k) - f->origin[k];
    sum += e[k] * c;
    spread += fabs(e[k]) * half_extent(&a->region, k);
    size += fabs(c) + half_extent(&a->region, k);
  }
  return fabs(sum) + spread <= f->most + a->error + b->error + PLACE_ERROR * size;
}

static int planes_in_group(finder *f, const item *it, uint32_t g, int turn) {
  const group *gr = &f->groups[g];
  double at = it->d, size = fabs(it->d), place[3], apart = 0;
  int bounded = isfinite(it->size) != 0;
  for (int k = 0; k < 3; k++) { /* a place to compare at: the region's middle, or the plane's nearest to O */
    place[k] = bounded ? middle(&it->region, k) - f->origin[k] : -it->d * it->n[k];
    at += it->n[k] * place[k];
    size += fabs(place[k]);
    apart = fmax(apart, fabs(it->n[k] - turn * gr->n[k]));
  }
  if (apart > angle_of(f, it) + 2 * GROUP_CELL) {
    return 1;
  }
  double want = turn * at; /* s of the group's plane at the place, so d = want - n.place */
  for (int k = 0; k < 3; k++) {
    want -= gr->n[k] * place[k];
  }
  double room = f->most + it->error + f->plane_error + 4 * GROUP_CELL * size;
  int64_t low = cell(want - room, f->offset_cell), high = cell(want + room, f->offset_cell);
  if (high - low > 64 || !isfinite(room)) {
    for (uint32_t i = gr->first; i != NONE; i = f->next_in_group[i]) {
      f->compared++;
      if (may_be_near(f, it, &f->items[i], turn) && !note(f, i)) {
        return 0;
      }
    }
    return 1;
  }
  for (int64_t c = low; c <= high; c++) {
    uint64_t hash = offset_hash(g, c);
    for (uint32_t e = first_of(&f->offsets, hash); e != NONE; e = next_of(&f->offsets, e)) {
      f->compared++;
      if (may_be_near(f, it, &f->items[f->offsets.entries[e].what], turn) && !note(f, f->offsets.entries[e].what)) {
        return 0;
      }
    }
  }
  return 1;
}

static int planes_near(finder *f, const item *it, int level) {
  double width = direction_cell(level), reach = level == it->level ? angle_of(f, it) + 2 * GROUP_CELL : 4 * NORMAL_ERROR + 2 * GROUP_CELL;
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
          for (uint32_t e = first_of(&f->directions, hash); e != NONE; e = next_of(&f->directions, e)) {
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

static int curved_near_at(finder *f, const item *it, int level) {
  double width = centre_cell(f, level);
  int64_t low[4], high[4];
  for (int k = 0; k < 3; k++) {
    double reach = f->most + 2 * it->error + width / 16; /* theirs is no larger than of this level */
    low[k] = cell(it->n[k] - reach, width);
    high[k] = cell(it->n[k] + reach, width);
  }
  low[3] = cell(it->d - 2 * SHAPE_ERROR, SHAPE_CELL);
  high[3] = cell(it->d + 2 * SHAPE_ERROR, SHAPE_CELL);
  for (int64_t shape = low[3]; shape <= high[3]; shape++) {
    int64_t c[3];
    for (c[0] = low[0]; c[0] <= high[0]; c[0]++) {
      for (c[1] = low[1]; c[1] <= high[1]; c[1]++) {
        for (c[2] = low[2]; c[2] <= high[2]; c[2]++) {
          uint64_t hash = centre_hash(level, shape, c);
          for (uint32_t e = first_of(&f->centres, hash); e != NONE; e = next_of(&f->centres, e)) {
            uint32_t i = f->centres.entries[e].what;
            const item *other = &f->items[i];
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

/* --- by boxes, for planes that may be near at wide angles: then few parts are where they are ------------------------- */

enum { FEW_USERS = 8, FEW_MET = 256, FINE_LEVEL = 5, COMPARED_USERS = 4096 };

static void meet_leaf(void *user, uint32_t number) {
  finder *f = user;
  const qn_leaf *leaf = &f->scene->leaves[number];
  const qn_half *halves = f->scene->halves + leaf->half0;
  f->met++;
  for (uint32_t h = 0; h < leaf->halves && f->met <= FEW_MET && !f->refused; h++) {
    uint32_t other = halves[h].surface;
    const item *it = &f->items[other];
    if (it->kind == PLANE && it->indexed && (may_be_near(f, f->asking, it, 1) || may_be_near(f, f->asking, it, -1))) {
      f->refused = !note(f, other);
    }
  }
}

/* 0: better asked of the index. */
static int boxes_near(finder *f, uint32_t i) {
  const item *it = &f->items[i];
  uint32_t users = f->users_of[i + 1] - f->users_of[i];
  uint64_t nodes = 0;
  if (it->level >= FINE_LEVEL || users > FEW_USERS || !(it->size <= 64 * f->unit) || f->scene->unbounded_count) {
    return 0;
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
  f->compared += f->met;
  if (f->met > FEW_MET) {
    f->found_count = 0;
    return 0;
  }
  return 1;
}

/* --- one surface ----------------------------------------------------------------------------------------------------- */

/* Users of the two whose boxes come close; where there are very many, their hulls answer. */
static int users_close(finder *f, uint32_t x, uint32_t y, uint32_t leaf[2]) {
  const qn_leaf *leaves = f->scene->leaves;
  const uint32_t *a = f->users + f->users_of[x], *b = f->users + f->users_of[y];
  size_t n = f->users_of[x + 1] - f->users_of[x], m = f->users_of[y + 1] - f->users_of[y];
  const qn_region *r = &f->items[x].region, *s = &f->items[y].region;
  leaf[0] = a[0], leaf[1] = b[0];
  if (!come_close(f, r->min, r->max, s->min, s->max)) {
    return 0;
  }
  if (n * m > COMPARED_USERS) {
    return 1;
  }
  for (size_t i = 0; i < n; i++) {
    for (size_t j = 0; j < m; j++) {
      const qn_leaf *p = &leaves[a[i]], *q = &leaves[b[j]];
      if (come_close(f, p->min, p->max, q->min, q->max)) {
        leaf[0] = a[i], leaf[1] = b[j];
        return 1;
      }
    }
  }
  return 0;
}

static int by_number(const void *a, const void *b) {
  uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
  return (x > y) - (x < y);
}

static quoin_status keep(finder *f, const qn_near_pair *pair) {
  if (f->want == QN_NEAR_ALL && f->out->count >= KEPT) {
    f->out->cut = 1;
    return QUOIN_OK;
  }
  if (!qn_grow(f->mem, &f->out->items, &f->out->capacity, f->out->count + 1)) {
    return QUOIN_E_MEMORY;
  }
  f->out->items[f->out->count++] = *pair;
  return QUOIN_OK;
}

/* The number as text where it is exact and short. */
static const char *exactly(finder *f, qn_num gap) {
  enum { LONGEST = 40, BITS = 140 };
  if (qn_num_is_rounded(gap) || (gap.kind == QN_NUM_BIG && qn_int_bits(gap.u.big->num) + qn_int_bits(gap.u.big->den) > BITS)) {
    return "";
  }
  const char *text = qn_num_text(&f->ctx, gap);
  size_t length = text ? strlen(text) : 0;
  text = length && length <= LONGEST ? qn_arena_text(&f->out->texts, text, length) : "";
  return text ? text : "";
}

/* Compares with the candidates. *stands: no surface of the index stands for this one. */
static quoin_status compare(finder *f, uint32_t i, int *stands) {
  qn_near_pair best = {.small = i, .stands = NONE};
  quoin_status status = QUOIN_OK;
  if (f->found_count > 1) {
    qsort(f->found, f->found_count, sizeof *f->found, by_number);
  }
  for (size_t k = 0; k < f->found_count && status == QUOIN_OK; k++) {
    uint32_t other = f->found[k], leaf[2] = {f->scene->surfaces[i].leaf, f->scene->surfaces[other].leaf};
    if ((k && other == f->found[k - 1]) || (f->want == QN_NEAR_ALL && !users_close(f, i, other, leaf))) {
      continue;
    }
    const qn_exact_surface *x = qn_scene_exact(f->scene, i, NULL), *y = qn_scene_exact(f->scene, other, NULL);
    if (!x || !y) {
      return QUOIN_E_MEMORY;
    }
    qn_mark mark = qn_arena_mark(&f->ctx.arena);
    qn_num gap;
    int turn, near = qn_gap(&f->ctx, x, y, &f->items[i].region, &f->items[other].region, &gap, &turn) && qn_num_cmp(&f->ctx, gap, f->limit) <= 0;
    qn_near_pair pair = {i, other, {leaf[0], leaf[1]}, (int8_t)turn, near ? qn_num_to_double(gap) : 0, near ? exactly(f, gap) : ""};
    qn_arena_release(&f->ctx.arena, mark);
    status = f->ctx.failed;
    if (near && status == QUOIN_OK && f->want == QN_NEAR_ALL) {
      status = keep(f, &pair);
    }
    /* of equally near ones that of the larger region, then the first in the file: neither hangs on the order of comparing */
    if (near && (best.stands == NONE || pair.gap < best.gap ||
                 (pair.gap == best.gap && by_size(&other, &best.stands, f->items) < 0))) {
      best = pair;
    }
  }
  *stands = best.stands == NONE;
  return status == QUOIN_OK && f->want == QN_NEAR_SNAP && !*stands ? keep(f, &best) : status;
}

static quoin_status take(finder *f, uint32_t i) {
  const item *it = &f->items[i];
  int stands = 1;
  if (it->kind == NOT_LOOKED_FOR) {
    return QUOIN_OK;
  }
  f->found_count = 0;
  int good = 1;
  if (f->want == QN_NEAR_ALL && f->compared > COMPARED) {
    f->out->cut = 1;
    return QUOIN_OK;
  }
  if (it->kind == PLANE) {
    /* where boxes told all that is near at an angle, only parallel planes are left, which for a snap may be anywhere */
    int told = boxes_near(f, i);
    good = (told && f->want == QN_NEAR_ALL) || planes_near(f, it, told ? LEVELS - 1 : it->level);
    good = good && !f->refused;
  } else {
    for (int level = it->level; level < CENTRE_LEVELS && good; level++) {
      good = !(f->centre_levels >> level & 1) || curved_near_at(f, it, level);
    }
  }
  quoin_status status = good ? compare(f, i, &stands) : QUOIN_E_MEMORY;
  if (status == QUOIN_OK && (stands || f->want == QN_NEAR_ALL) && !add(f, i)) {
    status = QUOIN_E_MEMORY;
  }
  return status;
}

/* --- all of them ----------------------------------------------------------------------------------------------------- */

static void gather_regions(finder *f) {
  const quoin_scene *s = f->scene;
  for (size_t i = 0; i < s->surface_count; i++) {
    f->items[i].region = (qn_region){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
  }
  for (size_t i = 0; i < s->leaf_count; i++) {
    const qn_leaf *leaf = &s->leaves[i];
    for (uint32_t h = leaf->half0; h < leaf->half0 + leaf->halves; h++) {
      qn_region *r = &f->items[s->halves[h].surface].region;
      for (int k = 0; k < 3; k++) {
        r->min[k] = leaf->min[k] < r->min[k] ? leaf->min[k] : r->min[k];
        r->max[k] = leaf->max[k] > r->max[k] ? leaf->max[k] : r->max[k];
      }
    }
  }
}

static int gather_users(finder *f) {
  const quoin_scene *s = f->scene;
  f->users = qn_alloc(f->mem, s->half_count * sizeof *f->users);
  f->users_of = qn_alloc_zeroed(f->mem, (s->surface_count + 1) * sizeof *f->users_of);
  if (!f->users || !f->users_of) {
    return 0;
  }
  for (uint32_t i = 0, n = 0; i < s->surface_count; i++) { /* first where they begin, and then, each moved on by its users, where they end */
    f->users_of[i] = n;
    n += s->surfaces[i].users;
  }
  for (uint32_t i = 0; i < s->leaf_count; i++) {
    for (uint32_t h = s->leaves[i].half0; h < s->leaves[i].half0 + s->leaves[i].halves; h++) {
      f->users[f->users_of[s->halves[h].surface]++] = i;
    }
  }
  memmove(f->users_of + 1, f->users_of, s->surface_count * sizeof *f->users_of);
  f->users_of[0] = 0;
  return 1;
}

static quoin_status start(finder *f) {
  size_t n = f->scene->surface_count;
  qn_print_frame frame;
  qn_print_frame_of(f->scene, &frame);
  memcpy(f->origin, frame.origin, sizeof f->origin);
  double unit = f->unit = ldexp(1, frame.scale);
  f->most = nextafter(qn_num_to_double(f->limit), INFINITY);
  f->offset_cell = 2 * f->most + 0x1p-36 * unit;
  f->centre_cell = 4 * f->most + 0x1p-34 * unit;
  f->items = qn_alloc_zeroed(f->mem, n * sizeof *f->items);
  f->order = qn_alloc(f->mem, n * sizeof *f->order);
  f->next_in_group = qn_alloc(f->mem, n * sizeof *f->next_in_group);
  if (!f->items || !f->order || !f->next_in_group) {
    return QUOIN_E_MEMORY;
  }
  gather_regions(f);
  if (!gather_users(f)) {
    return QUOIN_E_MEMORY;
  }
  for (uint32_t i = 0; i < n; i++) {
    item *it = &f->items[i];
    look_at(f, i, it);
    f->order[i] = i;
    if (it->kind == PLANE) {
      it->level = level_of(f, it);
      f->levels |= 1u << it->level | 1u << (LEVELS - 1);
      f->plane_error = fmax(f->plane_error, it->error);
    } else if (it->kind == CURVED) {
      while (it->level + 1 < CENTRE_LEVELS && it->error > centre_cell(f, it->level) / 16) {
        it->level++;
      }
      if (it->error > centre_cell(f, it->level) / 16) {
        it->kind = NOT_LOOKED_FOR;
        continue;
      }
      f->centre_levels |= 1u << it->level;
    }
  }
  return sort_order(f, n) ? QUOIN_OK : QUOIN_E_MEMORY;
}

static int by_small(const void *a, const void *b) {
  const qn_near_pair *x = a, *y = b;
  return (x->small > y->small) - (x->small < y->small);
}

quoin_status qn_near_find(const quoin_scene *scene, qn_num limit, qn_near_want want, qn_near_pairs *out) {
  finder f = {.scene = scene, .mem = scene->mem, .want = want, .limit = limit, .out = out};
  *out = (qn_near_pairs){0};
  qn_arena_init(&out->texts, scene->mem);
  qn_ctx_init(&f.ctx, scene->mem);
  f.ctx.max_bits = QN_MAX_SCENE_BITS;
  quoin_status status = start(&f);
  for (size_t i = 0; i < scene->surface_count && status == QUOIN_OK; i++) {
    status = take(&f, f.order[i]);
  }
  qn_free(f.mem, f.items, scene->surface_count * sizeof *f.items);
  qn_free(f.mem, f.order, scene->surface_count * sizeof *f.order);
  qn_free(f.mem, f.next_in_group, scene->surface_count * sizeof *f.next_in_group);
  qn_free(f.mem, f.users, scene->half_count * sizeof *f.users);
  qn_free(f.mem, f.users_of, (scene->surface_count + 1) * sizeof *f.users_of);
  qn_free(f.mem, f.groups, f.group_capacity * sizeof *f.groups);
  qn_free(f.mem, f.found, f.found_capacity * sizeof *f.found);
  table_free(&f.directions, f.mem);
  table_free(&f.exact_directions, f.mem);
  table_free(&f.offsets, f.mem);
  table_free(&f.centres, f.mem);
  qn_ctx_free(&f.ctx);
  if (want == QN_NEAR_SNAP && out->count > 1) {
    qsort(out->items, out->count, sizeof *out->items, by_small);
  }
  if (status != QUOIN_OK) {
    qn_near_pairs_free(out, scene->mem);
  }
  return status;
}

void qn_near_pairs_free(qn_near_pairs *pairs, qn_mem *mem) {
  qn_free(mem, pairs->items, pairs->capacity * sizeof *pairs->items);
  qn_arena_free(&pairs->texts);
  *pairs = (qn_near_pairs){0};
}

double qn_near_usual(const quoin_scene *scene) {
  double most = 0;
  for (size_t i = 0; i < scene->leaf_count; i++) {
    for (int k = 0; k < 3 && scene->leaves[i].bounded; k++) {
      most = fmax(most, fmax(fabs(scene->leaves[i].min[k]), fabs(scene->leaves[i].max[k])));
    }
  }
  return most / 100000;
}
