/* The hierarchy's making: boxes are sorted into a tree by the surface area heuristic (Goldsmith and Salmon 1987; binned:
   Wald 2007), eight children a node (Wald, Benthin, Boulos 2008).

   A node takes its range of items, splits it in two where the expected cost of a walk is least, then splits the part of largest
   area again, until there are eight parts or every part is one item. The upper tree is made by one thread until ranges
   are small; the ranges left are independent tasks, each with nodes of its own, which are then laid one behind another.
   What is a task depends on the number of items only, so the tree does not depend on the number of threads. */
#include "scene/bvh.h"

#include "base/thread.h"

#include <math.h>
#include <string.h>

enum {
  BINS = 16, /* at most; 8 for fewer than FEW items */
  FEW = 64,
  TASK_FLOOR = 4096, /* items: smaller ranges are not worth a task */
  TASKS = 256,       /* about so many tasks at most */
  SAH_DEPTH = 24     /* levels by area; below, by halves, so that depth is bounded for any input: 24 + log8 2^31 < QN_BVH_DEPTH */
};

/* Four lanes, the last one idle, so that a minimum of two boxes is one instruction. An item's number is kept in its min[3]. */
enum { LANES = 4 };
typedef struct item { float min[LANES], max[LANES]; } item;
typedef struct box { float min[LANES], max[LANES]; } box;
/* qn_bvh_node without its alignment */
typedef struct node { float min[3][QN_BVH_WIDE], max[3][QN_BVH_WIDE]; uint32_t child[QN_BVH_WIDE]; } node;
typedef struct range { size_t begin, end; box bounds; } range;

static const box EMPTY_BOX = {{INFINITY, INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY, -INFINITY}};

/* Single precision, not above and not below. */
static float round_down(double v) {
  float f = (float)v;
  return (double)f > v ? nextafterf(f, -INFINITY) : f;
}
static float round_up(double v) {
  float f = (float)v;
  return (double)f < v ? nextafterf(f, INFINITY) : f;
}

static inline void take_in(box *b, const float *min, const float *max) {
  for (int k = 0; k < LANES; k++) {
    b->min[k] = min[k] < b->min[k] ? min[k] : b->min[k];
    b->max[k] = max[k] > b->max[k] ? max[k] : b->max[k];
  }
}
static float area(const box *b) {
  float x = b->max[0] - b->min[0], y = b->max[1] - b->min[1], z = b->max[2] - b->min[2];
  return x < 0 ? 0 : x * y + y * z + z * x;
}
static float middle(const item *i, int k) {
  return 0.5f * i->min[k] + 0.5f * i->max[k];
}

static box bounds_of(const item *items, size_t begin, size_t end) {
  box b = EMPTY_BOX;
  for (size_t i = begin; i < end; i++) {
    take_in(&b, items[i].min, items[i].max);
  }
  return b;
}

typedef struct bins { uint32_t count[3][BINS]; box bounds[3][BINS]; } bins;
typedef struct grid { float origin[3], scale[3]; size_t bins; } grid;

/* Inputs give 0 <= (middle - origin) scale <= bins. */
static size_t bin_of(const grid *g, const item *i, int k) {
  if (!(g->scale[k] > 0)) {
    return 0;
  }
  size_t b = (size_t)(int)((middle(i, k) - g->origin[k]) * g->scale[k]);
  return b < g->bins ? b : g->bins - 1;
}

/* The axis and bin before which cutting is cheapest; 0 when there is none. */
static int best_cut(const bins *all, size_t n_bins, int *best_axis, size_t *best_bin) {
  float best = INFINITY;
  for (int k = 0; k < 3; k++) {
    float right_cost[BINS];
    box b = EMPTY_BOX;
    uint32_t n = 0;
    for (size_t i = n_bins; i-- > 1;) {
      take_in(&b, all->bounds[k][i].min, all->bounds[k][i].max);
      n += all->count[k][i];
      right_cost[i] = n ? area(&b) * (float)n : -1;
    }
    b = EMPTY_BOX;
    n = 0;
    for (size_t i = 1; i < n_bins; i++) {
      take_in(&b, all->bounds[k][i - 1].min, all->bounds[k][i - 1].max);
      n += all->count[k][i - 1];
      if (n && right_cost[i] >= 0) {
        float cost = area(&b) * (float)n + right_cost[i];
        if (cost < best) {
          best = cost, *best_axis = k, *best_bin = i;
        }
      }
    }
  }
  return best < INFINITY;
}

static void split_in_half(const item *items, const range *r, range *left, range *right) {
  size_t mid = r->begin + (r->end - r->begin) / 2;
  *left = (range){r->begin, mid, bounds_of(items, r->begin, mid)};
  *right = (range){mid, r->end, bounds_of(items, mid, r->end)};
}

/* Splits a range of at least two items into two that are not empty. */
static void split(item *items, const range *r, int by_area, range *left, range *right) {
  size_t n = r->end - r->begin;
  if (n == 2 || !by_area) {
    split_in_half(items, r, left, right);
    return;
  }
  box middles = EMPTY_BOX;
  for (size_t i = r->begin; i < r->end; i++) {
    float c[LANES];
    for (int k = 0; k < LANES; k++) {
      c[k] = 0.5f * items[i].min[k] + 0.5f * items[i].max[k];
    }
    take_in(&middles, c, c);
  }
  const float *low = middles.min, *high = middles.max;
  grid g = {.bins = n < FEW ? BINS / 2 : BINS};
  for (int k = 0; k < 3; k++) {
    float scale = (float)g.bins / (high[k] - low[k]);
    int usable = scale > 0 && scale < INFINITY && low[k] > -INFINITY && high[k] < INFINITY;
    g.origin[k] = usable ? low[k] : 0;
    g.scale[k] = usable ? scale : 0;
  }
  bins all;
  memset(all.count, 0, sizeof all.count);
  for (int k = 0; k < 3; k++) {
    for (size_t i = 0; i < g.bins; i++) {
      all.bounds[k][i] = EMPTY_BOX;
    }
  }
  for (size_t i = r->begin; i < r->end; i++) {
    for (int k = 0; k < 3; k++) { /* an axis that cannot be used puts all into bin 0, where no cut is */
      size_t b = bin_of(&g, &items[i], k);
      all.count[k][b]++;
      take_in(&all.bounds[k][b], items[i].min, items[i].max);
    }
  }
  int axis = 0;
  size_t cut = 0;
  if (!best_cut(&all, g.bins, &axis, &cut)) { /* all in one place, or infinite */
    split_in_half(items, r, left, right);
    return;
  }
  size_t i = r->begin, j = r->end;
  while (i < j) {
    if (bin_of(&g, &items[i], axis) < cut) {
      i++;
    } else {
      item t = items[--j];
      items[j] = items[i];
      items[i] = t;
    }
  }
  *left = (range){r->begin, i, EMPTY_BOX};
  *right = (range){i, r->end, EMPTY_BOX};
  for (size_t b = 0; b < g.bins; b++) {
    range *side = b < cut ? left : right;
    take_in(&side->bounds, all.bounds[axis][b].min, all.bounds[axis][b].max);
  }
}

/* Splits a range into 2 to 8. Returns how many. */
static size_t split_wide(item *items, const range *r, int by_area, range parts[QN_BVH_WIDE]) {
  if (r->end - r->begin <= QN_BVH_WIDE) {
    for (size_t i = r->begin; i < r->end; i++) {
      parts[i - r->begin] = (range){i, i + 1, bounds_of(items, i, i + 1)};
    }
    return r->end - r->begin;
  }
  size_t n = 1;
  parts[0] = *r;
  while (n < QN_BVH_WIDE) {
    size_t pick = n;
    float most = -1;
    for (size_t i = 0; i < n; i++) {
      size_t count = parts[i].end - parts[i].begin;
      float weight = by_area ? area(&parts[i].bounds) : (float)count;
      if (count > 1 && (pick == n || weight > most)) {
        pick = i, most = weight;
      }
    }
    if (pick == n) {
      break;
    }
    range whole = parts[pick];
    split(items, &whole, by_area, &parts[pick], &parts[n]);
    n++;
  }
  return n;
}

/* --- trees of ranges ------------------------------------------------------------------------------------------- */

typedef struct job { range r; size_t parent; unsigned slot, depth; } job; /* parent SIZE_MAX: the root */
typedef struct tree { node *nodes; size_t count, capacity; } tree;
typedef struct jobs { job *items; size_t count, capacity; } jobs;

static int push(jobs *list, qn_mem *mem, job j) {
  if (!qn_grow(mem, &list->items, &list->capacity, list->count + 1)) {
    return 0;
  }
  list->items[list->count++] = j;
  return 1;
}

/* Builds the tree of one range. Ranges of at most task_size items (0: none) below the root are left to `later`. */
static quoin_status grow(tree *t, qn_mem *mem, item *items, job first, size_t task_size, jobs *later) {
  jobs stack = {0};
  quoin_status status = push(&stack, mem, first) ? QUOIN_OK : QUOIN_E_MEMORY;
  while (status == QUOIN_OK && stack.count) {
    job j = stack.items[--stack.count];
    if (j.parent != SIZE_MAX && j.r.end - j.r.begin <= task_size) {
      status = push(later, mem, j) ? QUOIN_OK : QUOIN_E_MEMORY;
      continue;
    }
    if (!qn_grow(mem, &t->nodes, &t->capacity, t->count + 1)) {
      status = QUOIN_E_MEMORY;
      break;
    }
    size_t me = t->count++;
    if (j.parent != SIZE_MAX) {
      t->nodes[j.parent].child[j.slot] = (uint32_t)me;
    }
    range parts[QN_BVH_WIDE];
    size_t n = split_wide(items, &j.r, j.depth < SAH_DEPTH, parts);
    node *out = &t->nodes[me];
    for (unsigned i = 0; i < QN_BVH_WIDE; i++) {
      const box *b = i < n ? &parts[i].bounds : &EMPTY_BOX;
      for (int k = 0; k < 3; k++) {
        out->min[k][i] = b->min[k];
        out->max[k][i] = b->max[k];
      }
      out->child[i] = QN_BVH_NONE;
    }
    for (unsigned i = (unsigned)n; i-- > 0 && status == QUOIN_OK;) { /* the first part is taken first */
      if (parts[i].end - parts[i].begin == 1) {
        out->child[i] = QN_BVH_LEAF | (uint32_t)parts[i].begin;
      } else {
        status = push(&stack, mem, (job){parts[i], me, i, j.depth + 1}) ? QUOIN_OK : QUOIN_E_MEMORY;
      }
    }
  }
  qn_free(mem, stack.items, stack.capacity * sizeof *stack.items);
  return status;
}

typedef struct building {
  qn_mem *mem;
  item *items;
  const jobs *tasks;
  tree *trees; /* by task */
} building;

static quoin_status run_task(void *user, unsigned thread, size_t i) {
  (void)thread;
  building *b = user;
  job j = b->tasks->items[i];
  j.parent = SIZE_MAX;
  return grow(&b->trees[i], b->mem, b->items, j, 0, NULL);
}

/* Lays the upper tree and the tasks' trees one behind another. */
static quoin_status assemble(qn_bvh *bvh, qn_mem *mem, const tree *upper, const jobs *tasks, const tree *trees) {
  size_t total = upper->count;
  for (size_t i = 0; i < tasks->count; i++) {
    total += trees[i].count;
  }
  bvh->nodes = qn_alloc_line(mem, total * sizeof *bvh->nodes);
  if (!bvh->nodes) {
    return QUOIN_E_MEMORY;
  }
  bvh->node_count = total;
  size_t at = 0;
  for (size_t i = 0; i <= tasks->count; i++) {
    const tree *t = i ? &trees[i - 1] : upper;
    size_t base = at;
    if (i) {
      const job *j = &tasks->items[i - 1];
      bvh->nodes[j->parent].child[j->slot] = (uint32_t)base;
    }
    for (size_t n = 0; n < t->count; n++, at++) {
      qn_bvh_node *to = &bvh->nodes[at];
      memset(to, 0, sizeof *to);
      memcpy(to->min, t->nodes[n].min, sizeof to->min);
      memcpy(to->max, t->nodes[n].max, sizeof to->max);
      for (int k = 0; k < QN_BVH_WIDE; k++) {
        uint32_t child = t->nodes[n].child[k];
        to->child[k] = child & QN_BVH_LEAF ? child : child + (uint32_t)base;
      }
    }
  }
  return QUOIN_OK;
}

static quoin_status build(qn_bvh *bvh, qn_mem *mem, item *items, size_t n, unsigned threads) {
  tree upper = {0}, *trees = NULL;
  jobs tasks = {0};
  size_t task_size = n / TASKS > TASK_FLOOR ? n / TASKS : TASK_FLOOR;
  job whole = {{0, n, bounds_of(items, 0, n)}, SIZE_MAX, 0, 0};
  quoin_status status = grow(&upper, mem, items, whole, task_size, &tasks);
  if (status == QUOIN_OK && !(trees = qn_alloc_zeroed(mem, tasks.count * sizeof *trees))) {
    status = QUOIN_E_MEMORY;
  }
  if (status == QUOIN_OK) {
    building b = {mem, items, &tasks, trees};
    status = qn_parallel(threads, tasks.count, run_task, &b, NULL);
  }
  if (status == QUOIN_OK) {
    status = assemble(bvh, mem, &upper, &tasks, trees);
  }
  for (size_t i = 0; trees && i < tasks.count; i++) {
    qn_free(mem, trees[i].nodes, trees[i].capacity * sizeof *trees[i].nodes);
  }
  qn_free(mem, trees, tasks.count * sizeof *trees);
  qn_free(mem, tasks.items, tasks.capacity * sizeof *tasks.items);
  qn_free(mem, upper.nodes, upper.capacity * sizeof *upper.nodes);
  return status;
}

quoin_status qn_bvh_build(qn_bvh *bvh, qn_mem *mem, size_t n, const double (*boxes)[6], const uint32_t *numbers, unsigned threads) {
  *bvh = (qn_bvh){0};
  if (n == 0) {
    return QUOIN_OK;
  }
  if (n >= QN_BVH_LEAF - 1) {
    return QUOIN_E_LIMIT;
  }
  item *items = qn_alloc(mem, n * sizeof *items);
  quoin_status status = QUOIN_E_MEMORY;
  if (items && (bvh->items = qn_alloc(mem, n * sizeof *bvh->items))) {
    bvh->item_count = n;
    for (size_t i = 0; i < n; i++) {
      items[i] = (item){{0}, {0}};
      memcpy(&items[i].min[3], &numbers[i], sizeof numbers[i]);
      for (int k = 0; k < 3; k++) {
        items[i].min[k] = round_down(boxes[i][k]);
        items[i].max[k] = round_up(boxes[i][3 + k]);
      }
    }
    status = build(bvh, mem, items, n, threads);
    for (size_t i = 0; i < n; i++) {
      memcpy(&bvh->items[i], &items[i].min[3], sizeof bvh->items[i]);
    }
  }
  qn_free(mem, items, n * sizeof *items);
  if (status != QUOIN_OK) {
    qn_bvh_free(bvh, mem);
  }
  return status;
}

void qn_bvh_free(qn_bvh *bvh, qn_mem *mem) {
  qn_free_line(mem, bvh->nodes, bvh->node_count * sizeof *bvh->nodes);
  qn_free(mem, bvh->items, bvh->item_count * sizeof *bvh->items);
  *bvh = (qn_bvh){0};
}
