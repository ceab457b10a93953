/* Splitting by the surface area heuristic (Goldsmith and Salmon 1987; binned: Wald 2007), eight parts a node (Wald, Benthin, Boulos 2008).

   A range is cut in two where the expected cost of a walk is least, then the part of largest area is, until there are eight parts or
   every part is one item. Items are dealt to bins by their middles; both sides keep their order. Large ranges are dealt in chunks by
   several threads: bins are added up, and each chunk's items go to places counted before, so the outcome is that of one thread. */
#include "scene/split.h"

#include "base/thread.h"

#include <math.h>
#include <string.h>

enum {
  BINS = 16, /* at most; 8 for fewer than FEW items */
  FEW = 64,
  CHUNK = 1 << 13
};

static const qn_box4 EMPTY_BOX = {{INFINITY, INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY, -INFINITY}};

QN_INLINE void take_in(qn_box4 *b, qn_four min, qn_four max) {
  qn_four_store(b->min, qn_four_min(min, qn_four_load(b->min)));
  qn_four_store(b->max, qn_four_max(max, qn_four_load(b->max)));
}
QN_INLINE void join(qn_box4 *b, const qn_box4 *a) {
  take_in(b, qn_four_load(a->min), qn_four_load(a->max));
}

static float area(const qn_box4 *b) {
  _Alignas(16) float d[4];
  qn_four_store(d, qn_four_sub(qn_four_load(b->max), qn_four_load(b->min)));
  return d[0] < 0 ? 0 : d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
}

/* --- bins ----------------------------------------------------------------------------------------------------------- */

typedef struct grid {
  _Alignas(16) float origin[4], scale[4];
  float last; /* the last bin */
  size_t bins;
} grid;

typedef struct bins { qn_box4 bounds[3][BINS]; uint32_t count[3][BINS]; } bins;

/* An axis that cannot be used puts all into bin 0, and what is not a number into the last. */
static grid grid_of(const qn_range *r) {
  grid g = {.bins = r->end - r->begin < FEW ? BINS / 2 : BINS};
  g.last = (float)(g.bins - 1);
  for (int k = 0; k < 3; k++) {
    float low = r->middles.min[k], high = r->middles.max[k], scale = (float)g.bins / (high - low);
    int usable = scale > 0 && scale < INFINITY && low > -INFINITY && high < INFINITY;
    g.origin[k] = usable ? low : 0;
    g.scale[k] = usable ? scale : 0;
  }
  return g;
}

static void clear(bins *all, size_t n) {
  memset(all->count, 0, sizeof all->count);
  for (int k = 0; k < 3; k++) {
    for (size_t i = 0; i < n; i++) {
      all->bounds[k][i] = EMPTY_BOX;
    }
  }
}

static void deal(bins *all, const grid *g, const qn_bvh_item *items, size_t n) {
  qn_four origin = qn_four_load(g->origin), scale = qn_four_load(g->scale), last = qn_four_all(g->last);
  for (size_t i = 0; i < n; i++) {
    qn_four min = qn_four_load(items[i].min), max = qn_four_load(items[i].max);
    int32_t at[4];
    qn_four_whole(qn_four_min(qn_four_mul(qn_four_sub(qn_four_add(min, max), origin), scale), last), at);
    for (int k = 0; k < 3; k++) {
      all->count[k][at[k]]++;
      take_in(&all->bounds[k][at[k]], min, max);
    }
  }
}

typedef struct cut { int axis; size_t bin; } cut; /* items in bins below `bin` go left; 0: there is no cut */

/* The axis and bin before which cutting is cheapest. */
static cut best_cut(const bins *all, size_t n_bins) {
  cut best = {0, 0};
  float least = INFINITY;
  for (int k = 0; k < 3; k++) {
    float right_cost[BINS];
    qn_box4 b = EMPTY_BOX;
    uint32_t n = 0;
    for (size_t i = n_bins; i-- > 1;) {
      join(&b, &all->bounds[k][i]);
      n += all->count[k][i];
      right_cost[i] = n ? area(&b) * (float)n : -1;
    }
    b = EMPTY_BOX;
    n = 0;
    for (size_t i = 1; i < n_bins; i++) {
      join(&b, &all->bounds[k][i - 1]);
      n += all->count[k][i - 1];
      /* cppcheck-suppress uninitvar ; filled from n_bins - 1 down to 1 above */
      if (n && right_cost[i] >= 0) {
        float cost = area(&b) * (float)n + right_cost[i];
        if (cost < least) {
          least = cost, best = (cut){k, i};
        }
      }
    }
  }
  return best;
}

/* Which side an item is on: the same arithmetic as in deal(). */
QN_INLINE size_t is_right(const grid *g, cut c, const qn_bvh_item *i) {
  float t = (i->min[c.axis] + i->max[c.axis] - g->origin[c.axis]) * g->scale[c.axis];
  t = t < g->last ? t : g->last;
  return !(t < (float)c.bin);
}

/* The sides of a cut: bounds from the bins; middles are still to be gathered. */
static void sides_of(const qn_range *r, const bins *all, const grid *g, cut c, qn_range side[2]) {
  size_t count = 0;
  side[0].bounds = side[1].bounds = side[0].middles = side[1].middles = EMPTY_BOX;
  for (size_t b = 0; b < g->bins; b++) {
    count += b < c.bin ? all->count[c.axis][b] : 0;
    join(&side[b >= c.bin].bounds, &all->bounds[c.axis][b]);
  }
  side[0].begin = r->begin;
  side[0].end = side[1].begin = r->begin + count;
  side[1].end = r->end;
}

/* --- one cut -------------------------------------------------------------------------------------------------------- */

/* The items' bounds and middles. */
static qn_range range_of(const qn_bvh_item *items, size_t begin, size_t end) {
  qn_range r = {begin, end, EMPTY_BOX, EMPTY_BOX};
  for (size_t i = begin; i < end; i++) {
    qn_four min = qn_four_load(items[i].min), max = qn_four_load(items[i].max), middle = qn_four_add(min, max);
    take_in(&r.bounds, min, max);
    take_in(&r.middles, middle, middle);
  }
  return r;
}

static void in_halves(const qn_bvh_item *items, const qn_range *r, qn_range side[2]) {
  size_t mid = r->begin + (r->end - r->begin) / 2;
  side[0] = range_of(items, r->begin, mid);
  side[1] = range_of(items, mid, r->end);
}

/* Cuts a range of at least two items into two that are not empty. */
static void cut_small(const qn_split *s, const qn_range *r, int by_area, qn_range side[2]) {
  size_t n = r->end - r->begin;
  bins all;
  grid g;
  cut c = {0, 0};
  if (n > 2 && by_area) {
    g = grid_of(r);
    clear(&all, g.bins);
    deal(&all, &g, s->items + r->begin, n);
    c = best_cut(&all, g.bins);
  }
  if (c.bin == 0) { /* all in one place, or infinite */
    in_halves(s->items, r, side);
    return;
  }
  sides_of(r, &all, &g, c, side);
  qn_bvh_item *items = s->items + r->begin, *spare = s->spare + r->begin;
  size_t left = 0, right = 0;
  for (size_t i = 0; i < n; i++) { /* without branches: an item is written to both sides, and one of them moves on */
    qn_four min = qn_four_load(items[i].min), max = qn_four_load(items[i].max), middle = qn_four_add(min, max);
    size_t goes_right = is_right(&g, c, &items[i]);
    take_in(&side[goes_right].middles, middle, middle);
    qn_four_store(spare[right].min, min);
    qn_four_store(spare[right].max, max);
    qn_four_store(items[left].min, min);
    qn_four_store(items[left].max, max);
    right += goes_right;
    left += 1 - goes_right;
  }
  memcpy(items + left, spare, right * sizeof *spare);
}

/* --- by several threads --------------------------------------------------------------------------------------------- */

typedef struct chunk { bins bins; size_t left, right; qn_box4 middles[2]; } chunk;
typedef struct dealing {
  const qn_split *s;
  const qn_range *r;
  grid grid;
  cut cut;
  chunk *chunks;
} dealing;

static size_t chunk_begin(const dealing *d, size_t i) {
  return d->r->begin + i * CHUNK;
}
static size_t chunk_end(const dealing *d, size_t i) {
  return d->r->end - d->r->begin > (i + 1) * CHUNK ? chunk_begin(d, i + 1) : d->r->end;
}

static quoin_status deal_chunk(void *user, unsigned thread, size_t i) {
  (void)thread;
  dealing *d = user;
  size_t begin = chunk_begin(d, i);
  clear(&d->chunks[i].bins, d->grid.bins);
  deal(&d->chunks[i].bins, &d->grid, d->s->items + begin, chunk_end(d, i) - begin);
  return QUOIN_OK;
}

static quoin_status move_chunk(void *user, unsigned thread, size_t i) {
  (void)thread;
  dealing *d = user;
  chunk *t = &d->chunks[i];
  size_t at[2] = {t->left, t->right};
  t->middles[0] = t->middles[1] = EMPTY_BOX;
  for (size_t k = chunk_begin(d, i); k < chunk_end(d, i); k++) {
    const qn_bvh_item *item = &d->s->items[k];
    qn_four middle = qn_four_add(qn_four_load(item->min), qn_four_load(item->max));
    size_t goes_right = is_right(&d->grid, d->cut, item);
    take_in(&t->middles[goes_right], middle, middle);
    d->s->spare[at[goes_right]++] = *item;
  }
  return QUOIN_OK;
}

static quoin_status copy_chunk(void *user, unsigned thread, size_t i) {
  (void)thread;
  dealing *d = user;
  size_t begin = chunk_begin(d, i);
  memcpy(d->s->items + begin, d->s->spare + begin, (chunk_end(d, i) - begin) * sizeof *d->s->items);
  return QUOIN_OK;
}

static quoin_status cut_large(const qn_split *s, const qn_range *r, qn_range side[2]) {
  size_t count = (r->end - r->begin + CHUNK - 1) / CHUNK;
  dealing d = {.s = s, .r = r, .grid = grid_of(r)};
  d.chunks = qn_alloc_line(s->mem, count * sizeof *d.chunks);
  if (!d.chunks) {
    return QUOIN_E_MEMORY;
  }
  quoin_status status = qn_parallel(s->threads, count, deal_chunk, &d, NULL);
  if (status == QUOIN_OK) {
    bins all = d.chunks[0].bins;
    for (size_t i = 1; i < count; i++) {
      for (int k = 0; k < 3; k++) {
        for (size_t b = 0; b < d.grid.bins; b++) {
          all.count[k][b] += d.chunks[i].bins.count[k][b];
          join(&all.bounds[k][b], &d.chunks[i].bins.bounds[k][b]);
        }
      }
    }
    d.cut = best_cut(&all, d.grid.bins);
    if (d.cut.bin == 0) {
      in_halves(s->items, r, side);
    } else {
      sides_of(r, &all, &d.grid, d.cut, side);
      size_t left = side[0].begin, right = side[1].begin;
      for (size_t i = 0; i < count; i++) {
        d.chunks[i].left = left;
        d.chunks[i].right = right;
        for (size_t b = 0; b < d.grid.bins; b++) {
          *(b < d.cut.bin ? &left : &right) += d.chunks[i].bins.count[d.cut.axis][b];
        }
      }
      status = qn_parallel(s->threads, count, move_chunk, &d, NULL);
      status = status == QUOIN_OK ? qn_parallel(s->threads, count, copy_chunk, &d, NULL) : status;
      for (size_t i = 0; i < count; i++) {
        join(&side[0].middles, &d.chunks[i].middles[0]);
        join(&side[1].middles, &d.chunks[i].middles[1]);
      }
    }
  }
  qn_free_line(s->mem, d.chunks, count * sizeof *d.chunks);
  return status;
}

/* --- eight parts ---------------------------------------------------------------------------------------------------- */

/* Which of n parts is cut next, n when none should be. First those that make more than a node's fill, the largest first; then those
   whose items find room among the slots that are left, so that a node is spared: the largest for the room they take. */
static size_t to_cut(const qn_range *parts, const float *weight, size_t n, int by_area) {
  size_t pick = n;
  float most = -1;
  for (size_t i = 0; i < n; i++) {
    if (parts[i].end - parts[i].begin > QN_BVH_WIDE && weight[i] > most) {
      pick = i, most = weight[i];
    }
  }
  if (pick < n || !by_area) {
    for (size_t i = 0; pick == n && i < n; i++) {
      pick = parts[i].end - parts[i].begin > 1 ? i : n;
    }
    return pick;
  }
  const size_t room = QN_BVH_WIDE - n;
  for (size_t i = 0; i < n; i++) {
    const size_t items = parts[i].end - parts[i].begin;
    if (items > 1 && items - 1 <= room && weight[i] / (float)(items - 1) > most) {
      pick = i, most = weight[i] / (float)(items - 1);
    }
  }
  return pick;
}

quoin_status qn_split_wide(const qn_split *s, const qn_range *range, int by_area, qn_range parts[QN_BVH_WIDE], size_t *count) {
  size_t n = range->end - range->begin;
  if (n <= QN_BVH_WIDE) {
    for (size_t i = 0; i < n; i++) {
      parts[i] = range_of(s->items, range->begin + i, range->begin + i + 1);
    }
    *count = n;
    return QUOIN_OK;
  }
  float weight[QN_BVH_WIDE]; /* by_area: the area; else the items */
  parts[0] = *range;
  weight[0] = 0;
  for (n = 1; n < QN_BVH_WIDE; n++) {
    size_t pick = to_cut(parts, weight, n, by_area);
    if (pick == n) {
      break;
    }
    qn_range whole = parts[pick], side[2];
    size_t size = whole.end - whole.begin;
    if (size > QN_SPLIT_LARGE && by_area) {
      quoin_status status = cut_large(s, &whole, side);
      if (status != QUOIN_OK) {
        return status;
      }
    } else {
      cut_small(s, &whole, by_area, side);
    }
    for (int i = 0; i < 2; i++) {
      size_t at = i ? n : pick, items = side[i].end - side[i].begin;
      float w = by_area ? area(&side[i].bounds) : (float)items;
      parts[at] = side[i];
      weight[at] = w >= 0 ? w : 0; /* what is not a number counts as nothing */
    }
  }
  *count = n;
  return QUOIN_OK;
}

/* --- the whole ------------------------------------------------------------------------------------------------------ */

typedef struct gathering { const qn_split *s; size_t n; qn_range *ranges; } gathering;

static quoin_status gather(void *user, unsigned thread, size_t i) {
  (void)thread;
  gathering *g = user;
  g->ranges[i] = range_of(g->s->items, i * CHUNK, (i + 1) * CHUNK < g->n ? (i + 1) * CHUNK : g->n);
  return QUOIN_OK;
}

quoin_status qn_split_whole(const qn_split *s, size_t n, qn_range *out) {
  size_t count = (n + CHUNK - 1) / CHUNK;
  gathering g = {s, n, qn_alloc_line(s->mem, count * sizeof *g.ranges)};
  if (!g.ranges) {
    return QUOIN_E_MEMORY;
  }
  quoin_status status = qn_parallel(n > QN_SPLIT_LARGE ? s->threads : 1, count, gather, &g, NULL);
  *out = (qn_range){0, n, EMPTY_BOX, EMPTY_BOX};
  for (size_t i = 0; i < count; i++) {
    join(&out->bounds, &g.ranges[i].bounds);
    join(&out->middles, &g.ranges[i].middles);
  }
  qn_free_line(s->mem, g.ranges, count * sizeof *g.ranges);
  return status;
}
