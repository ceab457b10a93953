/* Cells: whatever point is asked for, every term whose box meets the floats about it is listed in its cell, unless the cell is crowded or the floats
   lie in two. */
#include "reading.h"
#include "scene/cells.h"
#include "scene/scene.h"

#include <math.h>

static uint64_t seed = 0x9e3779b97f4a7c15u;
static uint64_t next(void) {
  seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17;
  return seed >> 11;
}
static float between(float a, float b) { return a + (b - a) * (float)((double)next() * 0x1p-53); }

/* A union of terms of a normal form, with boxes alone. */
typedef struct made { qn_normal normal; qn_nterm terms[3000]; qn_union u[2]; } made;

enum { SHAPES = 8 };
static void make(made *m, int shape, uint32_t count) {
  *m = (made){.u = {{.root = 0, .term0 = 0, .terms = count}, {.root = QN_NO_ROOT, .term0 = 0, .terms = 3}}};
  m->normal = (qn_normal){.terms = m->terms, .term_count = count, .unions = m->u, .union_count = 2, .made = 1};
  static const float sizes[SHAPES][3] = {{1, 1, 1}, {100, 0.01f, 1}, {1e-30f, 1, 1}, {1e30f, 1e30f, 1e30f}, {0, 0, 0}, {1, 1, 0}, {1e-3f, 1e-3f, 1e-3f}, {1, 1, 1}};
  for (uint32_t i = 0; i < count; i++) {
    for (int k = 0; k < 3; k++) {
      float size = sizes[shape][k], place = between(-10 * size, 10 * size);
      place = shape == 7 ? floorf(place) : shape == 6 ? place + 1e4f : place;
      m->terms[i].min[k] = place;
      m->terms[i].max[k] = place + (i % 97 == 5 ? 5 : 1) * (shape == 7 ? 1 : between(0, size));
    }
  }
}

/* The cell of [low, high], or UINT32_MAX. */
static uint32_t cell_of(const qn_cell_grid *g, const float low[3], const float high[3]) {
  uint32_t at[3];
  for (int k = 0; k < 3; k++) {
    float a = (low[k] - g->low[k]) * g->scale[k], b = (high[k] - g->low[k]) * g->scale[k];
    a = a > 0 ? a : 0, b = b > 0 ? b : 0;
    a = a < g->last[k] ? a : g->last[k], b = b < g->last[k] ? b : g->last[k];
    if ((uint32_t)a != (uint32_t)b) {
      return UINT32_MAX;
    }
    at[k] = (uint32_t)a;
  }
  return g->first + at[0] + at[1] * g->across + at[2] * g->layer;
}

static void every_term_is_listed(void **state) {
  (void)state;
  static made m;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  size_t met = 0, crowded = 0, split = 0, grids = 0;
  for (int round = 0; round < 4 * SHAPES; round++) {
    uint32_t count = round % 3 ? 64 + (uint32_t)(next() % 2900) : 64;
    make(&m, round % SHAPES, count);
    qn_cells *c;
    assert_int_equal(qn_cells_build(&m.normal, &mem, &c), QUOIN_OK);
    assert_int_equal(c->grid[1], QN_NO_GRID); /* too few */
    for (int ask = 0; ask < 3000 && c->grid[0] != QN_NO_GRID; ask++) {
      const qn_cell_grid *g = &c->grids[c->grid[0]];
      const qn_nterm *t = &m.terms[next() % count];
      float low[3], high[3];
      grids += ask == 0;
      for (int k = 0; k < 3; k++) {
        switch (next() % 4) {
        case 0: low[k] = t->min[k]; break;
        case 1: low[k] = t->max[k]; break;
        case 2: low[k] = between(t->min[k], t->max[k]); break;
        default: low[k] = t->min[k] + between(-100, 100) * (t->max[k] - t->min[k]); break;
        }
        low[k] = next() % 3 ? low[k] : nextafterf(low[k], next() % 2 ? -INFINITY : INFINITY);
        high[k] = next() % 2 ? low[k] : nextafterf(low[k], INFINITY);
      }
      uint32_t cell = cell_of(g, low, high);
      if (cell == UINT32_MAX) {
        split++;
        continue;
      }
      assert_true(cell + 1 < c->start_count);
      uint32_t from = c->start[cell], to = c->start[cell + 1];
      assert_true(to - from <= QN_CELL_MOST && to <= c->term_count && c->term_count + QN_CELL_MOST <= c->term_capacity);
      if (to > from && c->term[from] == QN_CELL_CROWDED) {
        crowded++;
        continue;
      }
      for (uint32_t i = 0; i < count; i++) {
        int meets = 1, listed = 0;
        for (int k = 0; k < 3; k++) {
          meets &= m.terms[i].min[k] <= high[k] && low[k] <= m.terms[i].max[k];
        }
        for (uint32_t j = from; j < to; j++) {
          assert_true(c->term[j] < count);
          listed |= c->term[j] == i;
        }
        assert_true(listed || !meets);
        met += (size_t)meets;
      }
    }
    qn_cells_free(c, &mem);
  }
  print_message("%zu grids, %zu terms met, %zu asked of crowded cells, %zu in two\n", grids, met, crowded, split);
  assert_true(grids > 12 && met > 10000 && crowded > 100 && split > 10);
  assert_int_equal(mem.used, 0);
}

/* Terms that fill space to the last are not listed thousandfold. */
static void bounded(void **state) {
  (void)state;
  static made m;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  make(&m, 0, 3000);
  for (int i = 0; i < 3000; i++) {
    for (int k = 0; k < 3; k++) {
      m.terms[i].min[k] = i % 2 ? -10 : m.terms[i].min[k], m.terms[i].max[k] = i % 2 ? 10 : m.terms[i].min[k] + 0.1f;
    }
  }
  qn_cells *c;
  assert_int_equal(qn_cells_build(&m.normal, &mem, &c), QUOIN_OK);
  assert_true(c->grid[0] == QN_NO_GRID && c->grid_count == 0 && c->term_capacity == 0);
  qn_cells_free(c, &mem);
  m.normal.union_count = 0;
  assert_int_equal(qn_cells_build(&m.normal, &mem, &c), QUOIN_OK);
  assert_true(c->grid_count == 0);
  qn_cells_free(c, &mem);
  assert_int_equal(mem.used, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_term_is_listed), cmocka_unit_test(bounded)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
