/* The hierarchy's making: a tree of ranges, each split into eight (split.c).

   The upper tree is made node by node, large ranges being split by all threads; the ranges left are independent tasks, each with nodes of
   its own, which are then laid one behind another. What is a task depends on the items only, so the tree does not depend on the
   number of threads. */
#include "scene/bvh.h"

#include "base/thread.h"
#include "scene/split.h"

#include <string.h>

enum {
  SAH_DEPTH = 24 /* levels by area; below, by halves, so that depth is bounded for any input: 24 + log8 2^31 < QN_BVH_DEPTH */
};

typedef struct job { qn_range r; size_t parent; unsigned slot, depth; } job; /* parent SIZE_MAX: the root */
typedef struct tree { qn_bvh_node *nodes; size_t count, capacity; } tree;    /* from qn_alloc_line */

/* As qn_grow, for what is aligned to cache lines. */
static int grow_lines(qn_mem *mem, void **items, size_t *capacity, size_t count, size_t want, size_t item) {
  if (want <= *capacity) {
    return 1;
  }
  size_t room = *capacity + *capacity / 2 + 16;
  room = room < want ? want : room;
  void *moved = room < SIZE_MAX / item ? qn_alloc_line(mem, room * item) : NULL;
  if (!moved) {
    return 0;
  }
  if (*items) {
    memcpy(moved, *items, count * item);
    qn_free_line(mem, *items, *capacity * item);
  }
  *items = moved;
  *capacity = room;
  return 1;
}

typedef struct jobs { job *items; size_t count, capacity; } jobs;

static int push(jobs *list, qn_mem *mem, const job *j) {
  void *items = list->items;
  if (!grow_lines(mem, &items, &list->capacity, list->count, list->count + 1, sizeof *j)) {
    return 0;
  }
  list->items = items;
  list->items[list->count++] = *j;
  return 1;
}

/* Gives the next node, all zero. */
static qn_bvh_node *add_node(tree *t, qn_mem *mem) {
  void *nodes = t->nodes;
  if (!grow_lines(mem, &nodes, &t->capacity, t->count, t->count + 1, sizeof *t->nodes)) {
    return NULL;
  }
  t->nodes = nodes;
  qn_bvh_node *node = &t->nodes[t->count++];
  memset(node, 0, sizeof *node);
  return node;
}

/* Builds the tree of one range. Ranges below the root that are not large are left to `later`, if there is such a list. */
static quoin_status grow(tree *t, const qn_split *split, const job *first, jobs *later) {
  jobs stack = {0};
  quoin_status status = push(&stack, split->mem, first) ? QUOIN_OK : QUOIN_E_MEMORY;
  while (status == QUOIN_OK && stack.count) {
    job j = stack.items[--stack.count];
    if (j.parent != SIZE_MAX && later && j.r.end - j.r.begin <= QN_SPLIT_LARGE) {
      status = push(later, split->mem, &j) ? QUOIN_OK : QUOIN_E_MEMORY;
      continue;
    }
    qn_bvh_node *out = add_node(t, split->mem);
    if (!out) {
      status = QUOIN_E_MEMORY;
      break;
    }
    size_t me = t->count - 1, n = 0;
    if (j.parent != SIZE_MAX) {
      t->nodes[j.parent].child[j.slot] = (uint32_t)me;
    }
    qn_range parts[QN_BVH_WIDE];
    status = qn_split_wide(split, &j.r, j.depth < SAH_DEPTH, parts, &n);
    for (unsigned i = 0; i < QN_BVH_WIDE; i++) {
      for (int k = 0; k < 3; k++) {
        out->min[k][i] = i < n ? parts[i].bounds.min[k] : INFINITY;
        out->max[k][i] = i < n ? parts[i].bounds.max[k] : -INFINITY;
      }
      out->child[i] = QN_BVH_NONE;
    }
    for (unsigned i = (unsigned)n; i-- > 0 && status == QUOIN_OK;) { /* the first part is taken first */
      if (parts[i].end - parts[i].begin == 1) {
        out->child[i] = QN_BVH_LEAF | (uint32_t)parts[i].begin;
      } else {
        job below = {parts[i], me, i, j.depth + 1};
        status = push(&stack, split->mem, &below) ? QUOIN_OK : QUOIN_E_MEMORY;
      }
    }
  }
  qn_free_line(split->mem, stack.items, stack.capacity * sizeof *stack.items);
  return status;
}

typedef struct building {
  const qn_split *split;
  const jobs *tasks;
  tree *trees;   /* by task */
  size_t *first; /* by task: its first node in the hierarchy */
  qn_bvh *bvh;
} building;

static quoin_status run_task(void *user, unsigned thread, size_t i) {
  (void)thread;
  building *b = user;
  job j = b->tasks->items[i];
  j.parent = SIZE_MAX;
  return grow(&b->trees[i], b->split, &j, NULL);
}

/* Lays a tree at node `first`; its own numbers move up by as much. */
static void lay(qn_bvh *bvh, const tree *t, size_t first) {
  for (size_t n = 0; n < t->count; n++) {
    qn_bvh_node *to = &bvh->nodes[first + n];
    *to = t->nodes[n];
    for (int k = 0; k < QN_BVH_WIDE; k++) {
      to->child[k] += to->child[k] & QN_BVH_LEAF ? 0 : (uint32_t)first;
    }
  }
}

static quoin_status lay_task(void *user, unsigned thread, size_t i) {
  (void)thread;
  const building *b = user;
  const job *j = &b->tasks->items[i];
  lay(b->bvh, &b->trees[i], b->first[i]);
  b->bvh->nodes[j->parent].child[j->slot] = (uint32_t)b->first[i];
  return QUOIN_OK;
}

/* Lays the upper tree and the tasks' trees one behind another. */
static quoin_status assemble(building *b, const tree *upper, unsigned threads) {
  size_t total = upper->count;
  for (size_t i = 0; i < b->tasks->count; i++) {
    b->first[i] = total;
    total += b->trees[i].count;
  }
  b->bvh->nodes = qn_alloc_line(b->split->mem, total * sizeof *b->bvh->nodes);
  if (!b->bvh->nodes) {
    return QUOIN_E_MEMORY;
  }
  b->bvh->node_count = total;
  lay(b->bvh, upper, 0);
  return qn_parallel(threads, b->tasks->count, lay_task, b, NULL);
}

static quoin_status build(qn_bvh *bvh, const qn_split *split, size_t n, unsigned threads) {
  qn_mem *mem = split->mem;
  tree upper = {0};
  jobs tasks = {0};
  building b = {split, &tasks, NULL, NULL, bvh};
  job whole = {.parent = SIZE_MAX};
  threads = n > QN_SPLIT_LARGE / 4 ? threads : 1;
  quoin_status status = qn_split_whole(split, n, &whole.r);
  status = status == QUOIN_OK ? grow(&upper, split, &whole, &tasks) : status;
  if (status == QUOIN_OK) {
    b.trees = qn_alloc_zeroed(mem, tasks.count * sizeof *b.trees);
    b.first = qn_alloc(mem, tasks.count * sizeof *b.first);
    status = b.trees && b.first ? qn_parallel(threads, tasks.count, run_task, &b, NULL) : QUOIN_E_MEMORY;
  }
  status = status == QUOIN_OK ? assemble(&b, &upper, threads) : status;
  for (size_t i = 0; b.trees && i < tasks.count; i++) {
    qn_free_line(mem, b.trees[i].nodes, b.trees[i].capacity * sizeof *b.trees[i].nodes);
  }
  qn_free(mem, b.trees, tasks.count * sizeof *b.trees);
  qn_free(mem, b.first, tasks.count * sizeof *b.first);
  qn_free_line(mem, tasks.items, tasks.capacity * sizeof *tasks.items);
  qn_free_line(mem, upper.nodes, upper.capacity * sizeof *upper.nodes);
  return status;
}

quoin_status qn_bvh_build_items(qn_bvh *bvh, qn_mem *mem, size_t n, qn_bvh_item *items, unsigned threads) {
  *bvh = (qn_bvh){0};
  if (n == 0) {
    return QUOIN_OK;
  }
  if (n >= QN_BVH_LEAF - 1) {
    return QUOIN_E_LIMIT;
  }
  qn_split split = {mem, items, qn_alloc_line(mem, n * sizeof *items), threads};
  quoin_status status = QUOIN_E_MEMORY;
  if (split.spare && (bvh->items = qn_alloc(mem, n * sizeof *bvh->items))) {
    bvh->item_count = n;
    status = build(bvh, &split, n, threads);
    for (size_t i = 0; i < n; i++) {
      bvh->items[i] = (uint32_t)items[i].min[3] | (uint32_t)items[i].max[3] << 16;
    }
  }
  qn_free_line(mem, split.spare, n * sizeof *items);
  if (status != QUOIN_OK) {
    qn_bvh_free(bvh, mem);
  }
  return status;
}

quoin_status qn_bvh_build(qn_bvh *bvh, qn_mem *mem, size_t n, const double (*boxes)[6], const uint32_t *numbers, unsigned threads) {
  *bvh = (qn_bvh){0};
  qn_bvh_item *items = qn_alloc_line(mem, n * sizeof *items);
  if (!items) {
    return QUOIN_E_MEMORY;
  }
  for (size_t i = 0; i < n; i++) {
    qn_bvh_item_make(&items[i], boxes[i], boxes[i] + 3, numbers[i]);
  }
  quoin_status status = qn_bvh_build_items(bvh, mem, n, items, threads);
  qn_free_line(mem, items, n * sizeof *items);
  return status;
}

void qn_bvh_free(qn_bvh *bvh, qn_mem *mem) {
  qn_free_line(mem, bvh->nodes, bvh->node_count * sizeof *bvh->nodes);
  qn_free(mem, bvh->items, bvh->item_count * sizeof *bvh->items);
  *bvh = (qn_bvh){0};
}
