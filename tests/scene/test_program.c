/* Programs against a plain evaluation of the tree they were made of. */
#include "scene/program.h"
#include "share.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

static uint64_t state = 12345;
static uint32_t rnd(uint32_t n) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return (uint32_t)((state >> 33) % n);
}

enum { MOST = 200 };

/* The value of the tree, children before parents. */
static int plain(const qn_term *terms, size_t n, const int *inside) {
  int any[MOST] = {0}, all[MOST];
  for (size_t i = 0; i < n; i++) {
    all[i] = 1;
  }
  for (size_t i = n; i-- > 0;) {
    int v = 0;
    switch ((qn_term_kind)terms[i].kind) {
    case QN_TERM_OR: v = any[i]; break;
    case QN_TERM_AND: v = all[i]; break;
    case QN_TERM_LEAF: v = inside[i] != terms[i].negated; break;
    case QN_TERM_FALSE: v = 0; break;
    case QN_TERM_TRUE: v = 1; break;
    }
    if (i == 0) {
      return v;
    }
    any[terms[i].parent] |= v;
    all[terms[i].parent] &= v;
  }
  return 0;
}

static size_t random_tree(qn_term *terms, size_t n, uint32_t constants) {
  terms[0] = (qn_term){.parent = QN_NO_GATE, .kind = (uint8_t)rnd(2)};
  uint32_t path[MOST] = {0}, depth = 1;
  for (size_t i = 1; i < n; i++) {
    depth = rnd(3) ? depth : 1 + rnd(depth);
    terms[i] = (qn_term){.parent = path[depth - 1], .leaf = (uint32_t)i, .kind = QN_TERM_LEAF, .negated = (uint8_t)rnd(2)};
    uint32_t what = rnd(10);
    if (what < 4) {
      terms[i].kind = (uint8_t)rnd(2);
      path[depth++] = (uint32_t)i;
    } else if (what == 4 && constants) {
      terms[i].kind = rnd(2) ? QN_TERM_TRUE : QN_TERM_FALSE;
    }
  }
  uint8_t kids[MOST] = {0};
  for (size_t i = n; i-- > 1;) { /* a gate without children is a constant: mostly not wanted */
    if (terms[i].kind <= QN_TERM_AND && !kids[i] && (!constants || rnd(4))) {
      terms[i].kind = QN_TERM_LEAF;
    }
    kids[terms[i].parent] = 1;
  }
  return n;
}

static void check_shape(const qn_program *p) {
  assert_true(p->gate_count >= 1);
  assert_int_equal(p->gates[0].parent, QN_NO_GATE);
  for (size_t i = 1; i < p->gate_count; i++) {
    assert_true(p->gates[i].parent < i);
    assert_int_not_equal(p->gates[i].is_and, p->gates[p->gates[i].parent].is_and);
    assert_true(p->gates[i].kids >= 2);
  }
}

/* with_paths: whatever the depth; else without them. */
static void random_trees_one_way(int with_paths) {
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  size_t kept = 0, dropped = 0, constant = 0, deep = 0;
  state = 12345;
  for (int round = 0; round < share_of(3000); round++) {
    qn_term terms[MOST], copy[MOST];
    size_t n = random_tree(terms, 1 + rnd(MOST - 1), rnd(3) == 0);
    for (size_t i = 0; i < n; i++) {
      copy[i] = terms[i];
    }
    qn_program p;
    assert_int_equal(qn_program_build(&p, &mem, terms, n), QUOIN_OK);
    check_shape(&p);
    qn_paths_free(p.paths, &mem);
    p.paths = NULL;
    if (with_paths) {
      assert_int_equal(qn_paths_build(&p, &mem), QUOIN_OK);
    }
    constant += p.gates[0].kids == 0;
    deep += p.gate_count > 5;
    qn_eval eval;
    assert_true(qn_eval_init(&eval, &p, &mem));
    int inside[MOST] = {0};
    assert_int_equal(eval.value, plain(copy, n, inside));
    for (int pass = 0; pass < 2; pass++) {
      for (int step = 0; step < 100; step++) {
        size_t i = rnd((uint32_t)n);
        if (copy[i].kind != QN_TERM_LEAF) {
          continue;
        }
        inside[i] = !inside[i];
        if (terms[i].gate == QN_NO_GATE) {
          dropped++;
        } else {
          kept++;
          assert_int_equal(qn_eval_change(&eval, terms[i].gate, inside[i] != copy[i].negated ? 1 : -1), plain(copy, n, inside));
        }
        assert_int_equal(eval.value, plain(copy, n, inside));
      }
      qn_eval_reset(&eval);
      for (size_t i = 0; i < n; i++) {
        inside[i] = 0;
      }
      assert_int_equal(eval.value, plain(copy, n, inside));
    }
    qn_eval_free(&eval, &mem);
    qn_program_free(&p, &mem);
  }
  assert_true(kept > share_min(10000) && dropped > share_min(1000) && constant > share_min(50) && deep > share_min(500)); /* each kind did occur */
  assert_int_equal(mem.used, 0);
}

static void random_trees(void **unused) {
  (void)unused;
  random_trees_one_way(0);
}
static void random_trees_by_paths(void **unused) {
  (void)unused;
  random_trees_one_way(1);
}

/* Chains with twigs, long enough for stops in words of words of words; paths against the walk. */
static void long_paths(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  enum { GATES = 300000 };
  size_t n = 0;
  qn_term *terms = qn_alloc(&mem, 4 * GATES * sizeof *terms);
  assert_non_null(terms);
  uint32_t up = QN_NO_GATE;
  for (uint32_t i = 0; i < GATES; i++) { /* each gate: itself, a leaf or two, now and then a twig of some gates */
    uint32_t gate = (uint32_t)n;
    terms[n++] = (qn_term){.parent = up, .kind = i % 2 ? QN_TERM_AND : QN_TERM_OR};
    uint32_t wanted = i % 2; /* the value of what hangs beside the chain with which this gate passes */
    terms[n++] = (qn_term){.parent = gate, .kind = QN_TERM_LEAF, .leaf = wanted, .negated = (uint8_t)(rnd(8) ? wanted : rnd(2))};
    up = gate;
    if (rnd(1000) == 0) {
      uint32_t twig = gate;
      for (uint32_t k = i + 1; k < i + 1 + rnd(100); k++) {
        terms[n++] = (qn_term){.parent = twig, .kind = k % 2 ? QN_TERM_AND : QN_TERM_OR};
        twig = (uint32_t)n - 1;
        terms[n++] = (qn_term){.parent = twig, .kind = QN_TERM_LEAF, .leaf = wanted, .negated = (uint8_t)rnd(2)};
        terms[n++] = (qn_term){.parent = twig, .kind = QN_TERM_LEAF, .leaf = wanted, .negated = (uint8_t)rnd(2)};
      }
    }
  }
  terms[n++] = (qn_term){.parent = up, .kind = QN_TERM_LEAF};
  qn_program p;
  assert_int_equal(qn_program_build(&p, &mem, terms, n), QUOIN_OK);
  assert_non_null(p.paths);
  assert_true(p.paths->words > 300000 / 64 + 300000 / 4096 + 1);
  qn_program walked = p;
  walked.paths = NULL;
  qn_eval a, b;
  assert_true(qn_eval_init(&a, &p, &mem));
  assert_true(qn_eval_init(&b, &walked, &mem));
  uint8_t *now = qn_alloc_zeroed(&mem, n);
  assert_non_null(now);
  size_t turned = 0;
  for (int pass = 0; pass < 40; pass++) {
    /* first what makes a gate stop is turned, deepest first, so that changes far below come to matter */
    uint32_t reach = pass % 4 == 0 ? 0 : pass % 4 == 1 ? 20000 : pass % 4 == 2 ? 270000 : 600000;
    for (size_t i = 0; i < reach && i < n; i++) {
      const qn_term *t = &terms[reach < n ? reach - 1 - i : n - 1 - i];
      if (t->kind == QN_TERM_LEAF && t->gate != QN_NO_GATE && t->negated != t->leaf) {
        now[t - terms] = 1;
        int up_now = t->leaf ? 1 : -1;
        assert_int_equal(qn_eval_change(&a, t->gate, up_now), qn_eval_change(&b, t->gate, up_now));
      }
    }
    for (int step = 0; step < 50; step++) {
      size_t i = step % 2 ? rnd((uint32_t)n) : n - 1 - rnd(100);
      const qn_term *t = &terms[i];
      if (t->kind != QN_TERM_LEAF || t->gate == QN_NO_GATE) {
        continue;
      }
      now[i] ^= 1;
      int up_now = now[i] != t->negated ? 1 : -1, before = b.value;
      assert_int_equal(qn_eval_change(&a, t->gate, up_now), qn_eval_change(&b, t->gate, up_now));
      assert_int_equal(a.value, b.value);
      turned += b.value != before;
    }
    qn_eval_reset(&a);
    qn_eval_reset(&b);
    for (size_t i = 0; i < n; i++) {
      now[i] = 0;
    }
    for (size_t g = 0; g < p.gate_count; g++) { /* as at first */
      assert_true(a.count[g] == p.paths->base[g] && a.truth[g] == p.paths->truth[g] && !a.listed[g]);
    }
    assert_memory_equal(a.stops, p.paths->stops, p.paths->words * sizeof *a.stops);
  }
  assert_true(turned > 20);
  qn_free(&mem, now, n);
  qn_eval_free(&a, &mem);
  qn_eval_free(&b, &mem);
  qn_program_free(&p, &mem);
  qn_free(&mem, terms, 4 * GATES * sizeof *terms);
  assert_int_equal(mem.used, 0);
}

static void small_ones(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  qn_program p;
  qn_term none[] = {{.parent = QN_NO_GATE, .kind = QN_TERM_OR}};
  assert_int_equal(qn_program_build(&p, &mem, none, 1), QUOIN_OK);
  assert_int_equal(p.gate_count, 1);
  assert_int_equal(p.base, 0);
  qn_program_free(&p, &mem);

  qn_term all[] = {{.parent = QN_NO_GATE, .kind = QN_TERM_OR}, {.parent = 0, .kind = QN_TERM_LEAF}, {.parent = 0, .kind = QN_TERM_AND}};
  assert_int_equal(qn_program_build(&p, &mem, all, 3), QUOIN_OK);
  assert_int_equal(p.gate_count, 1);
  assert_int_equal(p.base, 1);
  assert_int_equal(all[1].gate, QN_NO_GATE);
  qn_program_free(&p, &mem);

  /* A - B below wrappers of one child: one AND gate, the root itself. */
  qn_term difference[] = {{.parent = QN_NO_GATE, .kind = QN_TERM_OR}, {.parent = 0, .kind = QN_TERM_OR}, {.parent = 1, .kind = QN_TERM_AND},
                          {.parent = 2, .kind = QN_TERM_LEAF}, {.parent = 2, .kind = QN_TERM_LEAF, .negated = 1}};
  assert_int_equal(qn_program_build(&p, &mem, difference, 5), QUOIN_OK);
  assert_int_equal(p.gate_count, 1);
  assert_true(p.gates[0].is_and && p.gates[0].kids == 2 && p.gates[0].base == 1 && p.gates[0].need == 2 && p.base == 0);
  assert_int_equal(difference[3].gate, 0);
  assert_int_equal(difference[4].gate, 0);
  qn_program_free(&p, &mem);
}

static void deep_chain(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  enum { LEVELS = 100000 };
  qn_term *terms = qn_alloc(&mem, 2 * LEVELS * sizeof *terms);
  assert_non_null(terms);
  for (uint32_t i = 0; i < LEVELS; i++) {
    terms[2 * i] = (qn_term){.parent = i ? 2 * (i - 1) : QN_NO_GATE, .kind = i % 2 ? QN_TERM_AND : QN_TERM_OR};
    terms[2 * i + 1] = (qn_term){.parent = 2 * i, .kind = QN_TERM_LEAF};
  }
  qn_program p;
  assert_int_equal(qn_program_build(&p, &mem, terms, 2 * LEVELS), QUOIN_OK);
  assert_int_equal(p.gate_count, LEVELS - 1); /* the last gate has one child */
  qn_eval eval;
  assert_true(qn_eval_init(&eval, &p, &mem));
  for (uint32_t i = LEVELS; i-- > 1;) { /* all but the root's own leaf: then the deepest decides */
    assert_int_equal(qn_eval_change(&eval, terms[2 * i + 1].gate, 1), i == 1);
  }
  assert_int_equal(qn_eval_change(&eval, terms[2 * LEVELS - 1].gate, -1), 1); /* an OR above has its own leaf */
  qn_eval_reset(&eval);
  for (uint32_t i = 0; i < LEVELS; i++) { /* the ANDs' own leaves: now all gates pass the last leaf on, up to the root */
    if (terms[2 * i].kind == QN_TERM_AND) {
      (void)qn_eval_change(&eval, terms[2 * i + 1].gate, 1);
    }
  }
  size_t touched = eval.touched_count;
  for (uint32_t i = 0; i < 100000; i++) { /* each change turns 99999 gates, and is seen at one */
    assert_int_equal(qn_eval_change(&eval, terms[2 * LEVELS - 1].gate, i % 2 ? 1 : -1), i % 2);
  }
  assert_int_equal(eval.touched_count, touched);
  qn_eval_free(&eval, &mem);
  qn_program_free(&p, &mem);
  qn_free(&mem, terms, 2 * LEVELS * sizeof *terms);
  assert_int_equal(mem.used, 0);
}

static void refused_memory(void **unused) {
  (void)unused;
  int refused = 0;
  for (size_t limit = 1; limit < 2000; limit += 7) {
    quoin_allocator a = {.limit = limit};
    qn_mem mem;
    qn_mem_init(&mem, &a);
    state = 7;
    qn_term terms[60];
    size_t n = random_tree(terms, 60, 0);
    qn_program p;
    if (qn_program_build(&p, &mem, terms, n) == QUOIN_OK && (limit % 2 || qn_paths_build(&p, &mem) == QUOIN_OK || !(refused++, qn_program_free(&p, &mem), 1))) {
      qn_eval eval;
      if (qn_eval_init(&eval, &p, &mem)) {
        qn_eval_free(&eval, &mem);
      } else {
        refused++;
      }
      qn_program_free(&p, &mem);
    } else {
      refused++;
    }
    assert_int_equal(mem.used, 0);
  }
  assert_true(refused > 3 && refused < 280);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(random_trees), cmocka_unit_test(random_trees_by_paths), cmocka_unit_test(long_paths), cmocka_unit_test(small_ones), cmocka_unit_test(deep_chain),
                                     cmocka_unit_test(refused_memory)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
