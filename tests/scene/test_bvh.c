/* The hierarchy against all boxes one by one, the line and the boxes taken as rationals (QN_BOX_SLACK). */
#include "scene/bvh.h"
#include "share.h"

#include <gmp.h>
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <setjmp.h>
#include <stdint.h>
#include <time.h>
#include <cmocka.h>

static uint64_t state = 99;
static uint64_t rnd(void) {
  state ^= state << 13, state ^= state >> 7, state ^= state << 17;
  return state * 0x2545F4914F6CDD1Du;
}
static int64_t rnd_in(int64_t low, int64_t high) {
  return low + (int64_t)(rnd() % (uint64_t)(high - low + 1));
}
static double unit(void) {
  return (double)(rnd() >> 11) * 0x1p-53;
}

enum { MOST = 300 };
typedef struct seen { uint8_t at[MOST]; size_t count; } seen;
static void mark(void *user, uint32_t leaf) {
  seen *s = user;
  assert_true(leaf < MOST);
  assert_false(s->at[leaf]); /* once each */
  s->at[leaf] = 1;
  s->count++;
}

/* Whether o + t d, t in [from, to] (infinite ends allowed), meets the closed box. */
static int meets(mpq_t o[3], mpq_t d[3], double from, double to, const double box[6]) {
  mpq_t low, high, a, b;
  mpq_inits(low, high, a, b, NULL);
  int has_low = !isinf(from), has_high = !isinf(to), result = 1;
  if (has_low) {
    mpq_set_d(low, from);
  }
  if (has_high) {
    mpq_set_d(high, to);
  }
  for (int k = 0; k < 3 && result; k++) {
    mpq_set_d(a, box[k]);
    mpq_set_d(b, box[3 + k]);
    mpq_sub(a, a, o[k]);
    mpq_sub(b, b, o[k]);
    int sign = mpq_sgn(d[k]);
    if (sign == 0) {
      result = mpq_sgn(a) <= 0 && mpq_sgn(b) >= 0;
      continue;
    }
    mpq_div(a, a, d[k]);
    mpq_div(b, b, d[k]);
    if (sign < 0) {
      mpq_swap(a, b);
    }
    if (!has_low || mpq_cmp(a, low) > 0) {
      mpq_set(low, a), has_low = 1;
    }
    if (!has_high || mpq_cmp(b, high) < 0) {
      mpq_set(high, b), has_high = 1;
    }
  }
  if (result && has_low && has_high) {
    result = mpq_cmp(low, high) <= 0;
  }
  mpq_clears(low, high, a, b, NULL);
  return result;
}

/* A scene of boxes with many equal and touching faces, some thin, some far. */
static size_t random_boxes(double (*boxes)[6], uint32_t *numbers, int *coarse) {
  size_t n = (size_t)rnd_in(1, 60);
  double pitch = (double[]){1, 0.1, 0x1p-40, 1e30, 0.3}[rnd() % 5], shift = (double[]){0, 1e6, 0.1, -1e-20}[rnd() % 4];
  *coarse = pitch < 1e-5 * fabs(shift); /* single precision cannot tell its boxes apart */
  for (size_t i = 0; i < n; i++) {
    for (int k = 0; k < 3; k++) {
      int64_t a = rnd_in(-5, 5);
      boxes[i][k] = shift + (double)a * pitch;
      boxes[i][3 + k] = shift + (double)(a + rnd_in(0, 3)) * pitch;
    }
    numbers[i] = (uint32_t)(n - 1 - i);
  }
  return n;
}

/* A line through (or close by) a corner of the box, or in its face, given as a decimal-like rational or as doubles. */
static int aimed_line(const double box[6], mpq_t o[3], mpq_t d[3]) {
  int kind = (int)(rnd() % 6);
  mpq_t t, s;
  mpq_inits(t, s, NULL);
  for (int k = 0; k < 3; k++) {
    switch (kind) {
    case 0: mpq_set_si(d[k], rnd_in(-3, 3), 1); break;                           /* small whole: faces, edges, diagonals */
    case 1: mpq_set_si(d[k], rnd_in(-1000000, 1000000), 1000003); break;         /* not doubles */
    case 2: mpq_set_d(d[k], ldexp(unit() - 0.5, (int)rnd_in(-300, 300))); break; /* all sizes */
    case 3: mpq_set_d(d[k], k == 0 ? 0x1p-300 : k == 1 ? 0 : 1); break;
    case 4: mpq_set_d(d[k], ldexp(1, (int)rnd_in(-1000, 900))); break;
    default: mpq_set_d(d[k], unit() - 0.5); break;
    }
  }
  if (mpq_sgn(d[0]) == 0 && mpq_sgn(d[1]) == 0 && mpq_sgn(d[2]) == 0) {
    mpq_set_si(d[0], 1, 1);
  }
  int back = (int)(rnd() % 4); /* how far back from the corner the origin is */
  for (int k = 0; k < 3; k++) {
    mpq_set_d(o[k], box[k + 3 * (int)(rnd() & 1)]);
    mpq_set_si(t, back == 0 ? 0 : back == 1 ? 7 : back == 2 ? 1000003 : 1, 1);
    if (kind == 2 || kind == 4) {
      mpq_set_d(t, back ? 0x1p-200 : 0);
    }
    mpq_mul(s, t, d[k]);
    mpq_sub(o[k], o[k], s);
  }
  mpq_clears(t, s, NULL);
  return kind;
}

/* The nearest double; mpq_get_d truncates. */
static double nearest(const mpq_t q) {
  double low = mpq_get_d(q), high = nextafter(low, mpq_sgn(q) < 0 ? -INFINITY : INFINITY);
  mpq_t a, b;
  mpq_inits(a, b, NULL);
  mpq_set_d(a, low);
  mpq_set_d(b, high);
  mpq_sub(a, q, a);
  mpq_sub(b, b, q);
  mpq_abs(a, a);
  mpq_abs(b, b);
  int up = mpq_cmp(b, a) < 0;
  mpq_clears(a, b, NULL);
  return up ? high : low;
}

static void QN_BOX_SLACK_lines(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  mpq_t o[3], d[3];
  for (int k = 0; k < 3; k++) {
    mpq_inits(o[k], d[k], NULL);
  }
  size_t met = 0, found = 0, visited = 0, grazed = 0, pairs = 0, not_doubles = 0;
  for (int scene = 0; scene < share_of(400); scene++) {
    static double boxes[MOST][6];
    uint32_t numbers[MOST];
    int coarse = 0;
    size_t n = random_boxes(boxes, numbers, &coarse);
    qn_bvh bvh;
    assert_int_equal(qn_bvh_build(&bvh, &mem, n, (const double(*)[6])boxes, numbers, 1), QUOIN_OK);
    for (int line = 0; line < 40; line++) {
      int plain = aimed_line(boxes[rnd() % n], o, d) < 2 && !coarse;
      double od[3], dd[3], from = -INFINITY, to = INFINITY;
      for (int k = 0; k < 3; k++) {
        od[k] = nearest(o[k]);
        dd[k] = nearest(d[k]);
      }
      int rounded = (int)(rnd() & 1);
      not_doubles += (size_t)rounded;
      for (int k = 0; k < 3 && !rounded; k++) { /* the doubles themselves are the line */
        mpq_set_d(o[k], od[k]);
        mpq_set_d(d[k], dd[k]);
      }
      switch (rnd() % 5) {
      case 0: from = 0; break;
      case 1: to = 1; break;
      case 2: from = 7; to = 7; break;
      default: break;
      }
      seen s = {0};
      uint64_t nodes = 0;
      qn_bvh_line(&bvh, od, dd, from, to, mark, &s, &nodes);
      assert_true(nodes >= 1);
      visited += plain ? s.count : 0;
      for (size_t i = 0; i < n; i++) {
        pairs++;
        if (meets(o, d, from, to, boxes[i])) {
          met++;
          found += (size_t)plain;
          assert_true(s.at[numbers[i]]);
          double smaller[6];
          for (int k = 0; k < 3; k++) {
            smaller[k] = nextafter(boxes[i][k], INFINITY);
            smaller[3 + k] = nextafter(boxes[i][3 + k], -INFINITY);
          }
          grazed += !meets(o, d, from, to, smaller);
        }
      }
    }
    qn_bvh_free(&bvh, &mem);
  }
  print_message("%zu pairs, %zu met; %zu met, %zu visited of plain ones\n", pairs, met, found, visited);
  assert_true(met > share_min(20000) && grazed > share_min(1000) && not_doubles > share_min(5000));
  assert_true(!share_whole() || visited < 2 * found); /* few others */
  for (int k = 0; k < 3; k++) {
    mpq_clears(o[k], d[k], NULL);
  }
  assert_int_equal(mem.used, 0);
}

static void points(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  size_t found = 0;
  for (int scene = 0; scene < share_of(300); scene++) {
    static double boxes[MOST][6];
    uint32_t numbers[MOST];
    int coarse = 0;
    size_t n = random_boxes(boxes, numbers, &coarse);
    qn_bvh bvh;
    assert_int_equal(qn_bvh_build(&bvh, &mem, n, (const double(*)[6])boxes, numbers, 1), QUOIN_OK);
    for (int q = 0; q < 50; q++) {
      double min[3], max[3];
      for (int k = 0; k < 3; k++) {
        min[k] = max[k] = boxes[rnd() % n][k + 3 * (int)(rnd() & 1)];
        if (rnd() & 1) {
          min[k] = nextafter(min[k], -INFINITY);
          max[k] = nextafter(max[k], INFINITY);
        }
      }
      seen s = {0};
      uint64_t nodes = 0;
      qn_bvh_point(&bvh, min, max, mark, &s, &nodes);
      for (size_t i = 0; i < n; i++) {
        int in = 1;
        for (int k = 0; k < 3; k++) {
          in &= boxes[i][k] <= max[k] && boxes[i][3 + k] >= min[k];
        }
        found += (size_t)in;
        assert_true(!in || s.at[numbers[i]]);
      }
    }
    qn_bvh_free(&bvh, &mem);
  }
  assert_true(found > share_min(1000));
  assert_int_equal(mem.used, 0);
}

/* Every item once, every box inside its node's box, no node below QN_BVH_DEPTH. */
static void check_tree(const qn_bvh *bvh, size_t n, double (*boxes)[6]) {
  uint8_t *items = calloc(n, 1), *depth = calloc(bvh->node_count, 1);
  assert_true(items && depth);
  for (size_t i = 0; i < bvh->node_count; i++) {
    const qn_bvh_node *node = &bvh->nodes[i];
    assert_true(depth[i] < QN_BVH_DEPTH);
    for (int c = 0; c < QN_BVH_WIDE; c++) {
      uint32_t child = node->child[c];
      if (child == QN_BVH_NONE) {
        assert_true(node->min[0][c] > node->max[0][c]);
      } else if (child & QN_BVH_LEAF) {
        uint32_t at = child & ~QN_BVH_LEAF, number = bvh->items[at];
        assert_true(number < n && !items[number]);
        items[number] = 1;
        for (int k = 0; k < 3; k++) {
          assert_true(node->min[k][c] <= boxes[number][k] && node->max[k][c] >= boxes[number][3 + k]);
        }
      } else {
        assert_true(child > i && child < bvh->node_count);
        depth[child] = (uint8_t)(depth[i] + 1);
        for (int g = 0; g < QN_BVH_WIDE; g++) {
          if (bvh->nodes[child].child[g] != QN_BVH_NONE) {
            for (int k = 0; k < 3; k++) {
              assert_true(node->min[k][c] <= bvh->nodes[child].min[k][g] && node->max[k][c] >= bvh->nodes[child].max[k][g]);
            }
          }
        }
      }
    }
  }
  for (size_t i = 0; i < n; i++) {
    assert_true(items[i]);
  }
  free(items);
  free(depth);
}

static double now(void) {
  struct timespec t;
  timespec_get(&t, TIME_UTC);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void shapes_of_tree(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  enum { N = 100000 };
  double(*boxes)[6] = malloc(N * sizeof *boxes);
  uint32_t *numbers = malloc(N * sizeof *numbers);
  assert_true(boxes && numbers);
  for (int shape = 0; shape < 5; shape++) {
    for (size_t i = 0; i < N; i++) {
      numbers[i] = (uint32_t)i;
      for (int k = 0; k < 3; k++) {
        double c = unit() * 100, r = 0.2;
        switch (shape) {
        case 1: c = 1, r = 1; break;                              /* all the same */
        case 2: c = ldexp(1, -(int)(i % 900)), r = c / 4; break;  /* ever smaller */
        case 3: c = k ? 0 : (double)i; break;                     /* a row */
        case 4: c = ldexp(unit() - 0.5, 1000), r = c / 2 < 0 ? -c / 2 : c / 2; break; /* beyond single precision */
        default: break;
        }
        boxes[i][k] = c - r;
        boxes[i][3 + k] = c + r;
      }
    }
    qn_bvh one, four;
    double start = now();
    assert_int_equal(qn_bvh_build(&one, &mem, N, (const double(*)[6])boxes, numbers, 1), QUOIN_OK);
    print_message("shape %d: %d boxes in %.3f s, %zu nodes\n", shape, N, now() - start, one.node_count);
    check_tree(&one, N, boxes);
    assert_int_equal(qn_bvh_build(&four, &mem, N, (const double(*)[6])boxes, numbers, 4), QUOIN_OK);
    assert_int_equal(one.node_count, four.node_count);
    assert_memory_equal(one.nodes, four.nodes, one.node_count * sizeof *one.nodes);
    assert_memory_equal(one.items, four.items, N * sizeof *one.items);
    qn_bvh_free(&one, &mem);
    qn_bvh_free(&four, &mem);
  }
  free(boxes);
  free(numbers);
  assert_int_equal(mem.used, 0);
}

static void refused_memory(void **unused) {
  (void)unused;
  enum { N = 300 };
  static double boxes[N][6];
  uint32_t numbers[N];
  for (uint32_t i = 0; i < N; i++) {
    numbers[i] = i;
    for (int k = 0; k < 3; k++) {
      boxes[i][k] = unit();
      boxes[i][3 + k] = boxes[i][k] + 0.01;
    }
  }
  size_t refused = 0, done = 0;
  for (size_t limit = 1; limit < 200000; limit += 501) {
    quoin_allocator a = {.limit = limit};
    qn_mem mem;
    qn_mem_init(&mem, &a);
    qn_bvh bvh;
    quoin_status s = qn_bvh_build(&bvh, &mem, N, (const double(*)[6])boxes, numbers, 2);
    if (s == QUOIN_OK) {
      done++;
      qn_bvh_free(&bvh, &mem);
    } else {
      refused++;
      assert_int_equal(s, QUOIN_E_MEMORY);
    }
    assert_int_equal(mem.used, 0);
  }
  assert_true(refused > 5 && done > 5);
}

int main(int argc, char **argv) {
  if (argc > 1) { /* a size: time one build */
    size_t n = (size_t)strtoul(argv[1], NULL, 10);
    double(*boxes)[6] = malloc(n * sizeof *boxes);
    uint32_t *numbers = malloc(n * sizeof *numbers);
    qn_mem mem;
    qn_mem_init(&mem, NULL);
    if (!boxes || !numbers) {
      return 1;
    }
    for (size_t i = 0; i < n; i++) {
      numbers[i] = (uint32_t)i;
      for (int k = 0; k < 3; k++) {
        boxes[i][k] = unit() * 100;
        boxes[i][3 + k] = boxes[i][k] + 0.1;
      }
    }
    double start = now();
    qn_bvh bvh;
    if (qn_bvh_build(&bvh, &mem, n, (const double(*)[6])boxes, numbers, 1) != QUOIN_OK) {
      return 1;
    }
    printf("%zu boxes: %.3f s, %zu nodes\n", n, now() - start, bvh.node_count);
    return 0;
  }
  const struct CMUnitTest tests[] = {cmocka_unit_test(QN_BOX_SLACK_lines), cmocka_unit_test(points), cmocka_unit_test(shapes_of_tree),
                                     cmocka_unit_test(refused_memory)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
