/* The normal form against a plain evaluation of the tree it was made of.

   Leaves are sets of cells of a small grid: any subset of the cells in the leaf's box, drawn by a hash. So a leaf is not its box, a
   clipped union that is used outside its clip shows, and so does a term or a node whose box is too small. */
#include "scene/scene.h"
#include "share.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static uint64_t state = 2024;
static uint32_t rnd(uint32_t n) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return (uint32_t)((state >> 33) % n);
}

enum { GRID = 6, MOST = 700 };

/* --- a world of leaves ---------------------------------------------------------------------------------------------- */

typedef struct world {
  qn_mem *mem;
  quoin_scene scene;
  qn_term terms[MOST], plain[MOST]; /* plain: as drawn, with leaf numbers of this world */
  size_t count;
  qn_leaf leaves[MOST];             /* by term: the leaf as drawn */
  uint64_t salt;
  uint32_t fill;                    /* of 8 cells of a leaf's box, how many are in it */
} world;

static int in_leaf(const world *w, size_t term, const double p[3]) {
  const qn_leaf *l = &w->leaves[term];
  uint64_t h = w->salt ^ term * 0x9E3779B97F4A7C15u;
  for (int k = 0; k < 3; k++) {
    if (p[k] < l->min[k] || p[k] > l->max[k]) {
      return 0;
    }
    h = (h ^ (uint64_t)(int64_t)floor(p[k])) * 0xBF58476D1CE4E5B9u;
    h ^= h >> 31;
  }
  return h % 8 < w->fill;
}

static int by_tree(const world *w, const double p[3]) {
  static int any[MOST], all[MOST];
  for (size_t i = 0; i < w->count; i++) {
    any[i] = 0, all[i] = 1;
  }
  for (size_t i = w->count; i-- > 0;) {
    int v = 0;
    switch ((qn_term_kind)w->plain[i].kind) {
    case QN_TERM_OR: v = any[i]; break;
    case QN_TERM_AND: v = all[i]; break;
    case QN_TERM_LEAF: v = in_leaf(w, i, p) != w->plain[i].negated; break;
    case QN_TERM_FALSE: v = 0; break;
    case QN_TERM_TRUE: v = 1; break;
    }
    if (i == 0) {
      return v;
    }
    any[w->plain[i].parent] |= v;
    all[w->plain[i].parent] &= v;
  }
  return 0;
}

/* --- the normal form, evaluated ------------------------------------------------------------------------------------- */

static int in_union(const world *w, uint32_t number, const double p[3], int depth);

static int in_box(const float min[3], const float max[3], const double p[3]) {
  return p[0] >= min[0] && p[0] <= max[0] && p[1] >= min[1] && p[1] <= max[1] && p[2] >= min[2] && p[2] <= max[2];
}

static int in_term(const world *w, uint32_t number, const double p[3], int depth) {
  const qn_normal *n = &w->scene.normal;
  assert_true(number < n->term_count);
  const qn_nterm *t = &n->terms[number];
  assert_true((size_t)t->leaf0 + t->leaves <= n->leaf_count && (size_t)t->plus0 + t->plus <= n->list_count &&
              (size_t)t->minus0 + t->minus <= n->list_count);
  if (!in_box(t->min, t->max, p)) {
    return 0;
  }
  for (uint32_t i = 0; i < t->leaves; i++) {
    uint32_t leaf = n->leaves[t->leaf0 + i];
    assert_true(leaf < w->scene.leaf_count);
    if (!in_leaf(w, w->scene.leaves[leaf].node, p)) { /* node: its term in this world */
      return 0;
    }
  }
  for (uint32_t i = 0; i < t->plus; i++) {
    if (!in_union(w, n->lists[t->plus0 + i], p, depth + 1)) {
      return 0;
    }
  }
  for (uint32_t i = 0; i < t->minus; i++) {
    if (in_union(w, n->lists[t->minus0 + i], p, depth + 1)) {
      return 0;
    }
  }
  return 1;
}

/* By its hierarchy, as a walk does it: a box that does not hold the point is not entered. */
static int in_union(const world *w, uint32_t number, const double p[3], int depth) {
  const qn_normal *n = &w->scene.normal;
  assert_true(number < n->union_count && depth < 2 * QN_NORMAL_DEPTH + 4);
  const qn_union *u = &n->unions[number];
  int in = 0;
  for (uint32_t i = 0; i < u->wide; i++) {
    in |= in_term(w, u->wide0 + i, p, depth);
  }
  uint32_t stack[QN_BVH_DEPTH * QN_BVH_WIDE];
  size_t top = 0;
  assert_true((u->root == QN_NO_ROOT) == (u->terms == 0));
  if (u->root != QN_NO_ROOT) {
    stack[top++] = u->root;
  }
  while (top && !in) {
    uint32_t at = stack[--top];
    assert_true(at < n->node_count);
    const qn_bvh_node *node = &n->nodes[at];
    for (int i = 0; i < QN_BVH_WIDE; i++) {
      float min[3], max[3];
      for (int k = 0; k < 3; k++) {
        min[k] = node->min[k][i], max[k] = node->max[k][i];
      }
      if (!in_box(min, max, p)) {
        continue;
      }
      uint32_t child = node->child[i];
      if (child & QN_BVH_LEAF) {
        uint32_t term = child & ~QN_BVH_LEAF;
        assert_true(term >= u->term0 && term < u->term0 + u->terms);
        in |= in_term(w, term, p, depth);
      } else {
        stack[top++] = child;
      }
    }
  }
  return in;
}

static int by_normal(const world *w, const double p[3]) {
  return in_union(w, w->scene.normal.root, p, 0) != w->scene.normal.complement;
}

/* Each term of a union is found below its root exactly once. */
static void check_unions(const qn_normal *n) {
  uint8_t *seen = calloc(n->term_count + 1, 1);
  uint32_t *stack = malloc((n->node_count + 1) * sizeof *stack);
  assert_true(seen && stack);
  for (size_t u = 0; u < n->union_count; u++) {
    size_t top = 0, found = 0;
    if (n->unions[u].root != QN_NO_ROOT) {
      stack[top++] = n->unions[u].root;
    }
    while (top) {
      const qn_bvh_node *node = &n->nodes[stack[--top]];
      for (int i = 0; i < QN_BVH_WIDE; i++) {
        if (node->min[0][i] > node->max[0][i]) { /* an empty slot */
          continue;
        }
        if (node->child[i] & QN_BVH_LEAF) {
          uint32_t t = node->child[i] & ~QN_BVH_LEAF;
          assert_true(t < n->term_count && !seen[t]);
          seen[t] = 1;
          found++;
          for (int k = 0; k < 3; k++) {
            assert_true(node->min[k][i] <= n->terms[t].min[k] && node->max[k][i] >= n->terms[t].max[k]);
          }
        } else {
          stack[top++] = node->child[i];
        }
      }
    }
    assert_int_equal(found, n->unions[u].terms);
  }
  free(seen);
  free(stack);
}

/* --- making worlds --------------------------------------------------------------------------------------------------- */

typedef struct shape {
  uint32_t gates, negated, open, size; /* of 16: gates, negated leaves, leaves without a box; the largest side of a box */
  int deep;                            /* one long chain of gates */
} shape;

static void make_leaf(world *w, size_t i, const shape *s) {
  qn_leaf *l = &w->leaves[i];
  *l = (qn_leaf){.node = (uint32_t)i, .bounded = 1};
  for (int k = 0; k < 3; k++) {
    l->min[k] = rnd(GRID);
    l->max[k] = l->min[k] + 1 + rnd(s->size);
  }
  if (rnd(16) < s->open) {
    l->bounded = 0;
    uint32_t sides = 1 + rnd(63);
    for (int k = 0; k < 3; k++) {
      l->min[k] = sides >> (2 * k) & 1 ? -INFINITY : l->min[k];
      l->max[k] = sides >> (2 * k + 1) & 1 ? INFINITY : l->max[k];
    }
  }
}

static void draw_tree(world *w, size_t n, const shape *s) {
  uint32_t path[MOST] = {0}, room[MOST], depth = 1; /* room: children a gate may still have, few where all must hold */
  w->terms[0] = (qn_term){.parent = QN_NO_GATE, .kind = (uint8_t)rnd(2)};
  room[0] = w->terms[0].kind == QN_TERM_AND && !s->deep ? 2 + rnd(4) : UINT32_MAX;
  for (size_t i = 1; i < n; i++) {
    while (depth > 1 && !room[depth - 1]) {
      depth--;
    }
    if (!room[depth - 1]) {
      n = i;
      break;
    }
    uint32_t up = path[depth - 1];
    room[depth - 1]--;
    w->terms[i] = (qn_term){.parent = up, .leaf = (uint32_t)i, .kind = QN_TERM_LEAF, .negated = rnd(16) < s->negated};
    if (s->deep ? i % 2 == 0 : up == 0 ? rnd(4) > 0 : rnd(16) < s->gates) {
      w->terms[i].kind = s->deep ? !w->terms[up].kind : (uint8_t)rnd(2);
      path[depth] = (uint32_t)i;
      room[depth++] = s->deep ? UINT32_MAX : 2 + rnd(w->terms[i].kind == QN_TERM_AND ? 3 : 20);
    }
  }
  uint8_t kids[MOST] = {0};
  for (size_t i = n; i-- > 1;) { /* no gate without children */
    if (w->terms[i].kind <= QN_TERM_AND && !kids[i]) {
      w->terms[i].kind = QN_TERM_LEAF;
    }
    kids[w->terms[i].parent] = 1;
  }
  w->count = n;
  w->fill = 1 + rnd(8);
  w->salt = state;
  for (size_t i = 0; i < n; i++) {
    make_leaf(w, i, s);
  }
}

/* Terms to a program and its leaves. */
static void make_scene(world *w) {
  memcpy(w->plain, w->terms, w->count * sizeof *w->terms);
  w->scene = (quoin_scene){.mem = w->mem};
  assert_int_equal(qn_program_build(&w->scene.program, w->mem, w->terms, w->count), QUOIN_OK);
  w->scene.leaves = qn_alloc(w->mem, w->count * sizeof *w->scene.leaves);
  assert_non_null(w->scene.leaves);
  for (size_t i = 0; i < w->count; i++) {
    if (w->terms[i].kind == QN_TERM_LEAF && w->terms[i].gate != QN_NO_GATE) {
      qn_leaf *l = &w->scene.leaves[w->scene.leaf_count++];
      *l = w->leaves[i];
      l->gate = w->terms[i].gate;
      l->negated = w->terms[i].negated;
    }
  }
}

static void free_scene(world *w) {
  qn_normal_free(&w->scene.normal, w->mem);
  qn_program_free(&w->scene.program, w->mem);
  qn_free(w->mem, w->scene.leaves, w->count * sizeof *w->scene.leaves);
}

static void compare(const world *w, int points) {
  check_unions(&w->scene.normal);
  for (int i = 0; i < points; i++) {
    double p[3];
    for (int k = 0; k < 3; k++) { /* the middles of cells, some far out */
      p[k] = (double)rnd(GRID + 6) - 2.5;
      p[k] = rnd(40) ? p[k] : p[k] * 1000;
    }
    assert_int_equal(by_normal(w, p), by_tree(w, p));
  }
}

typedef struct census { size_t shared, copied, complements, wide, plus, several, empty; } census;

static void count(const world *w, census *c) {
  const qn_normal *n = &w->scene.normal;
  c->shared += n->shared > 0;
  c->copied += n->copies > 0;
  c->complements += n->complement != 0;
  c->empty += n->term_count == 0;
  for (size_t i = 0; i < n->term_count; i++) {
    c->plus += n->terms[i].plus > 0;
    c->several += n->terms[i].leaves > 2;
  }
  for (size_t i = 0; i < n->union_count; i++) {
    c->wide += n->unions[i].wide && n->unions[i].terms > QN_BVH_WIDE;
  }
}

static void random_trees(void **unused) {
  (void)unused;
  static const shape shapes[] = {
    {.gates = 5, .negated = 0, .open = 0, .size = 9},  {.gates = 7, .negated = 4, .open = 1, .size = 12}, {.gates = 4, .negated = 8, .open = 2, .size = 5},
    {.gates = 9, .negated = 2, .open = 0, .size = 14}, {.gates = 6, .negated = 15, .open = 1, .size = 8}, {.gates = 3, .negated = 1, .open = 1, .size = 12},
    {.gates = 6, .negated = 2, .open = 16, .size = 9}, {.gates = 8, .negated = 7, .open = 0, .size = 16}, {.negated = 4, .open = 1, .size = 12, .deep = 1},
  };
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  static world w;
  w.mem = &mem;
  census c = {0};
  for (int round = 0; round < share_from(300, 1800); round++) {
    const shape *s = &shapes[(size_t)round % (sizeof shapes / sizeof *shapes)];
    static const uint32_t sizes[] = {3, 12, 40, 100, 220};
    draw_tree(&w, 1 + rnd(sizes[(round / 9) % (s->deep ? 4 : 5)]), s);
    make_scene(&w);
    size_t leaves = w.scene.leaf_count;
    static const size_t budgets[] = {0, 20, 300, SIZE_MAX};
    size_t budget = budgets[rnd(4)];
    budget = budget == SIZE_MAX && leaves > 40 ? QN_COPY_BUDGET * leaves + QN_COPY_FLOOR : budget; /* without one, products of products */
    assert_int_equal(qn_normal_build_within(&w.scene.normal, &w.scene, &mem, 1 + rnd(3), budget), QUOIN_OK);
    assert_true(w.scene.normal.made);
    compare(&w, 100);
    count(&w, &c);
    free_scene(&w);
  }
  print_message("shared %zu, copied %zu, complements %zu, wide %zu, plus %zu, several %zu, empty %zu\n", c.shared, c.copied, c.complements,
                c.wide, c.plus, c.several, c.empty);
  assert_true(c.shared > share_min(80) && c.copied > share_min(50) && c.complements > share_min(300) && c.wide > share_min(10) && c.plus > share_min(100) && c.several > share_min(500) && c.empty > share_min(2));
  assert_int_equal(mem.used, 0);
}

/* A few big gates, so that their children are found through hierarchies: (A or A ...) and (B or B ...) minus (C or C ...). */
static void wide_gates(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  static world w;
  w.mem = &mem;
  size_t shared = 0;
  for (int round = 0; round < share_from(8, 60); round++) {
    const shape s = {.open = (uint32_t)(round % 3 == 0), .size = 2};
    size_t n = 1;
    int negative = round % 2;
    w.terms[0] = (qn_term){.parent = QN_NO_GATE, .kind = negative ? QN_TERM_OR : QN_TERM_AND};
    for (int group = 0; group < 3; group++) {
      uint32_t gate = (uint32_t)n++;
      int taken = group == 2;
      w.terms[gate] = (qn_term){.parent = 0, .kind = taken == negative ? QN_TERM_OR : QN_TERM_AND};
      for (uint32_t i = 0; i < 150; i++) {
        if (i % 10 == 0) { /* a difference among them */
          uint32_t inner = (uint32_t)n++;
          w.terms[inner] = (qn_term){.parent = gate, .kind = taken == negative ? QN_TERM_AND : QN_TERM_OR};
          w.terms[n++] = (qn_term){.parent = inner, .kind = QN_TERM_LEAF, .negated = taken != negative};
          w.terms[n++] = (qn_term){.parent = inner, .kind = QN_TERM_LEAF, .negated = taken == negative};
        } else {
          w.terms[n++] = (qn_term){.parent = gate, .kind = QN_TERM_LEAF, .negated = taken != negative};
        }
      }
    }
    assert_true(n < MOST);
    w.count = n;
    w.fill = 1 + rnd(8);
    w.salt = state;
    for (size_t i = 0; i < n; i++) {
      w.terms[i].leaf = (uint32_t)i;
      make_leaf(&w, i, &s);
    }
    make_scene(&w);
    assert_int_equal(qn_normal_build_within(&w.scene.normal, &w.scene, &mem, 2, round % 4 == 3 ? 500 : 100000), QUOIN_OK);
    assert_true(w.scene.normal.made && w.scene.normal.complement == negative);
    shared += w.scene.normal.shared > 0;
    compare(&w, 300);
    free_scene(&w);
  }
  assert_true(shared >= share_min(10));
  assert_int_equal(mem.used, 0);
}

/* A chain of `depth` gates, AND and OR in turn, a leaf beside each. */
static void make_chain(world *w, size_t depth) {
  const shape s = {.open = 0, .size = 7};
  w->terms[0] = (qn_term){.parent = QN_NO_GATE, .kind = QN_TERM_OR};
  size_t n = 1, gate = 0;
  for (size_t d = 0; d < depth; d++) {
    w->terms[n++] = (qn_term){.parent = (uint32_t)gate, .kind = QN_TERM_LEAF, .negated = d % 7 == 3};
    w->terms[n] = (qn_term){.parent = (uint32_t)gate, .kind = w->terms[gate].kind == QN_TERM_OR ? QN_TERM_AND : QN_TERM_OR};
    gate = n++;
  }
  w->terms[n++] = (qn_term){.parent = (uint32_t)gate, .kind = QN_TERM_LEAF};
  w->terms[n++] = (qn_term){.parent = (uint32_t)gate, .kind = QN_TERM_LEAF};
  w->count = n;
  w->fill = 7;
  w->salt = state;
  for (size_t i = 0; i < n; i++) {
    w->terms[i].leaf = (uint32_t)i;
    make_leaf(w, i, &s);
  }
}

static void depth_limit(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  static world w;
  w.mem = &mem;
  for (size_t depth = QN_NORMAL_DEPTH - 2; depth <= QN_NORMAL_DEPTH + 2; depth++) {
    for (int budget = 0; budget < 2; budget++) {
      make_chain(&w, depth);
      make_scene(&w);
      assert_int_equal(qn_normal_build_within(&w.scene.normal, &w.scene, &mem, 1, budget ? 0 : 1000), QUOIN_OK);
      assert_int_equal(w.scene.normal.made, depth <= QN_NORMAL_DEPTH);
      if (w.scene.normal.made) {
        compare(&w, 500);
      }
      free_scene(&w);
    }
  }
  assert_int_equal(mem.used, 0);
}

/* Nothing, everything, one leaf. */
static void small_ones(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  static world w;
  w.mem = &mem;
  const shape s = {.size = 3};
  for (int kind = 0; kind < 4; kind++) {
    w.count = kind < 2 ? 1 : 2;
    w.fill = 8;
    w.terms[0] = (qn_term){.parent = QN_NO_GATE, .kind = kind % 2 ? QN_TERM_AND : QN_TERM_OR};
    w.terms[1] = (qn_term){.parent = 0, .leaf = 1, .kind = QN_TERM_LEAF, .negated = kind == 3};
    make_leaf(&w, 1, &s);
    make_scene(&w);
    assert_int_equal(qn_normal_build(&w.scene.normal, &w.scene, &mem, 1), QUOIN_OK);
    assert_true(w.scene.normal.made && w.scene.normal.complement == kind % 2);
    assert_int_equal(w.scene.normal.term_count, kind < 2 ? 0 : 1);
    compare(&w, 100);
    free_scene(&w);
  }
  assert_int_equal(mem.used, 0);
}

/* The same for any number of threads, with hierarchies large enough to be shared out. */
static void any_number_of_threads(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  enum { N = 30000 };
  quoin_scene s = {.mem = &mem};
  qn_term *terms = calloc(N + 1, sizeof *terms);
  s.leaves = calloc(N, sizeof *s.leaves);
  assert_true(terms && s.leaves);
  terms[0] = (qn_term){.parent = QN_NO_GATE, .kind = QN_TERM_OR};
  for (uint32_t i = 0; i < N; i++) {
    terms[i + 1] = (qn_term){.parent = 0, .leaf = i, .kind = QN_TERM_LEAF};
    s.leaves[i].bounded = 1;
    for (int k = 0; k < 3; k++) {
      s.leaves[i].min[k] = rnd(100000);
      s.leaves[i].max[k] = s.leaves[i].min[k] + rnd(3000);
    }
  }
  assert_int_equal(qn_program_build(&s.program, &mem, terms, N + 1), QUOIN_OK);
  s.leaf_count = N;
  qn_normal one, other;
  assert_int_equal(qn_normal_build(&one, &s, &mem, 1), QUOIN_OK);
  check_unions(&one);
  for (unsigned threads = 2; threads <= 5; threads++) {
    assert_int_equal(qn_normal_build(&other, &s, &mem, threads), QUOIN_OK);
    assert_true(other.node_count == one.node_count && other.term_count == one.term_count && other.leaf_count == one.leaf_count);
    assert_memory_equal(other.nodes, one.nodes, one.node_count * sizeof *one.nodes);
    assert_memory_equal(other.terms, one.terms, one.term_count * sizeof *one.terms);
    assert_memory_equal(other.leaves, one.leaves, one.leaf_count * sizeof *one.leaves);
    qn_normal_free(&other, &mem);
  }
  qn_normal_free(&one, &mem);
  qn_program_free(&s.program, &mem);
  free(terms);
  free(s.leaves);
  assert_int_equal(mem.used, 0);
}

/* --- refused memory --------------------------------------------------------------------------------------------------- */

typedef struct stingy { long left; } stingy;
static void *stingy_alloc(void *user, size_t size) {
  stingy *s = user;
  return s->left-- > 0 ? malloc(size) : NULL;
}
static void *stingy_resize(void *user, void *block, size_t old_size, size_t new_size) {
  stingy *s = user;
  (void)old_size;
  return s->left-- > 0 ? realloc(block, new_size) : NULL;
}
static void stingy_release(void *user, void *block, size_t size) {
  (void)user, (void)size;
  free(block);
}

static void refused_memory(void **unused) {
  (void)unused;
  static world w;
  size_t refusals = 0;
  for (int round = 0; round < 12; round++) {
    stingy s = {1000000};
    qn_mem mem;
    qn_mem_init(&mem, &(quoin_allocator){stingy_alloc, stingy_resize, stingy_release, &s, 0});
    w.mem = &mem;
    draw_tree(&w, 150, &(shape){.gates = 4, .negated = (uint32_t)round, .open = 1, .size = 3});
    make_scene(&w);
    size_t before = mem.used;
    for (long allowed = 0;; allowed++) {
      s.left = allowed;
      quoin_status status = qn_normal_build_within(&w.scene.normal, &w.scene, &mem, 1, round % 2 ? 100 : 10000);
      if (status == QUOIN_OK) {
        break;
      }
      assert_int_equal(status, QUOIN_E_MEMORY);
      assert_int_equal(mem.used, before);
      assert_true(w.scene.normal.made == 0 && w.scene.normal.terms == NULL);
      refusals++;
    }
    compare(&w, 100);
    free_scene(&w);
    assert_int_equal(mem.used, 0);
  }
  print_message("%zu refusals\n", refusals);
  assert_true(refusals > 200);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(random_trees), cmocka_unit_test(wide_gates),            cmocka_unit_test(depth_limit),
    cmocka_unit_test(small_ones),   cmocka_unit_test(any_number_of_threads), cmocka_unit_test(refused_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
