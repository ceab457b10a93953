#include "scene/cells.h"

#include "scene/scene.h"

#include <math.h>
#include <string.h>

enum {
  SHARE = 4,       /* cells for a term, at most */
  LISTED = 32,     /* entries for a term, at most: else the grid is given up */
  AXIS = 1 << 12,  /* cells along an axis, at most */
  TOTAL = 1 << 22  /* cells of a grid, at most */
};

typedef struct span { uint32_t from[3], to[3]; } span; /* of cells, to included */

static uint32_t cell_along(const qn_cell_grid *g, int k, float x) {
  float v = (x - g->low[k]) * g->scale[k];
  v = v > 0 ? v : 0;
  v = v < g->last[k] ? v : g->last[k];
  return (uint32_t)v;
}

static span span_of(const qn_cell_grid *g, const qn_nterm *t) {
  span s;
  for (int k = 0; k < 3; k++) {
    s.from[k] = cell_along(g, k, t->min[k]);
    s.to[k] = cell_along(g, k, t->max[k]);
  }
  return s;
}

/* How fine a grid is: its cells about half as wide as the mean term, as far as the number of cells allows. */
static size_t choose(const qn_normal *n, const qn_union *u, qn_cell_grid *g) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, mean[3] = {0, 0, 0}, count[3];
  for (uint32_t i = u->term0; i < u->term0 + u->terms; i++) {
    for (int k = 0; k < 3; k++) {
      low[k] = fmin(low[k], n->terms[i].min[k]);
      high[k] = fmax(high[k], n->terms[i].max[k]);
      mean[k] += ((double)n->terms[i].max[k] - n->terms[i].min[k]) / u->terms;
    }
  }
  double most = fmin((double)u->terms * SHARE, TOTAL);
  for (int k = 0; k < 3; k++) {
    count[k] = (high[k] - low[k]) / (0.5 * mean[k]);
    count[k] = count[k] >= 1 ? fmin(count[k], AXIS) : 1; /* not a number: 1 */
  }
  for (int round = 0; round < 3 && count[0] * count[1] * count[2] > most; round++) { /* axes that come to 1 leave the rest to others */
    int axes = (count[0] > 1) + (count[1] > 1) + (count[2] > 1);
    double less = pow(most / (count[0] * count[1] * count[2]), 1. / axes);
    for (int k = 0; k < 3; k++) {
      count[k] = fmax(1, count[k] * less);
    }
  }
  *g = (qn_cell_grid){.across = 1};
  size_t cells = 1;
  for (int k = 0; k < 3; k++) {
    double whole = floor(count[k]);
    g->low[k] = (float)low[k];
    g->scale[k] = (float)(whole / (high[k] - low[k]));
    if (!isfinite(g->scale[k])) {
      whole = 1, g->scale[k] = 0;
    }
    g->last[k] = (float)(whole - 1);
    cells *= (size_t)whole;
    g->across = k == 0 ? (uint32_t)whole : g->across;
    g->layer = k < 2 ? (uint32_t)cells : g->layer;
  }
  return cells;
}

/* Counts the terms of each cell into start[c + 1]; 0 when there are too many. */
static int count_terms(const qn_normal *n, const qn_union *u, const qn_cell_grid *g, uint32_t *start) {
  size_t left = (size_t)u->terms * LISTED;
  for (uint32_t i = u->term0; i < u->term0 + u->terms; i++) {
    span s = span_of(g, &n->terms[i]);
    size_t size = (size_t)(s.to[0] - s.from[0] + 1) * (s.to[1] - s.from[1] + 1) * (s.to[2] - s.from[2] + 1);
    if (size > left) {
      return 0;
    }
    left -= size;
    for (uint32_t z = s.from[2]; z <= s.to[2]; z++) {
      for (uint32_t y = s.from[1]; y <= s.to[1]; y++) {
        uint32_t *row = start + z * g->layer + y * g->across + 1;
        for (uint32_t x = s.from[0]; x <= s.to[0]; x++) {
          row[x]++;
        }
      }
    }
  }
  return 1;
}

static void list_terms(const qn_normal *n, const qn_union *u, const qn_cell_grid *g, uint32_t *at, const uint8_t *crowded, uint32_t *term) {
  for (uint32_t i = u->term0; i < u->term0 + u->terms; i++) {
    span s = span_of(g, &n->terms[i]);
    for (uint32_t z = s.from[2]; z <= s.to[2]; z++) {
      for (uint32_t y = s.from[1]; y <= s.to[1]; y++) {
        size_t row = (size_t)z * g->layer + (size_t)y * g->across;
        for (uint32_t x = s.from[0]; x <= s.to[0]; x++) {
          if (!crowded[row + x]) {
            term[at[row + x]++] = i;
          }
        }
      }
    }
  }
}

/* Adds one union's grid, if it is worth one. */
static quoin_status add_grid(qn_cells *c, qn_mem *mem, const qn_normal *n, uint32_t number) {
  const qn_union *u = &n->unions[number];
  qn_cell_grid g;
  size_t cells = choose(n, u, &g), first = c->start_count;
  uint32_t *at = qn_alloc_zeroed(mem, (cells + 1) * sizeof *at);
  uint8_t *crowded = qn_alloc_zeroed(mem, cells);
  quoin_status status = at && crowded ? QUOIN_OK : QUOIN_E_MEMORY;
  if (status == QUOIN_OK && first + cells < UINT32_MAX && count_terms(n, u, &g, at)) {
    size_t total = c->term_count, many = 0;
    for (size_t i = 0; i < cells; i++) {
      uint32_t here = at[i + 1];
      crowded[i] = here > QN_CELL_MOST;
      at[i] = (uint32_t)total;
      total += crowded[i] ? 1 : here;
      many += crowded[i];
    }
    int worth = many <= cells / 2; /* else most points would be asked twice */
    if (worth && (total >= UINT32_MAX || !qn_grow(mem, &c->start, &c->start_capacity, first + cells + 1) || !qn_grow(mem, &c->term, &c->term_capacity, total + QN_CELL_MOST))) {
      status = QUOIN_E_MEMORY;
    } else if (worth) {
      memcpy(c->start + first, at, cells * sizeof *at);
      c->start[first + cells] = (uint32_t)total;
      for (size_t i = 0; i < cells; i++) {
        if (crowded[i]) {
          c->term[at[i]] = QN_CELL_CROWDED;
        }
      }
      list_terms(n, u, &g, at, crowded, c->term);
      memset(c->term + total, 0, QN_CELL_MOST * sizeof *c->term);
      g.first = (uint32_t)first;
      c->start_count = first + cells + 1;
      c->term_count = total;
      c->grid[number] = (uint32_t)c->grid_count;
      c->grids[c->grid_count++] = g;
    }
  }
  qn_free(mem, at, (cells + 1) * sizeof *at);
  qn_free(mem, crowded, cells);
  return status;
}

void qn_cells_free(qn_cells *c, qn_mem *mem) {
  if (c) {
    qn_free(mem, c->grid, c->union_count * sizeof *c->grid);
    qn_free_line(mem, c->grids, c->grid_room * sizeof *c->grids);
    qn_free(mem, c->start, c->start_capacity * sizeof *c->start);
    qn_free(mem, c->term, c->term_capacity * sizeof *c->term);
    qn_free(mem, c, sizeof *c);
  }
}

quoin_status qn_cells_build(const qn_normal *n, qn_mem *mem, qn_cells **out) {
  qn_cells *c = qn_alloc_zeroed(mem, sizeof *c);
  *out = c;
  if (!c) {
    return QUOIN_E_MEMORY;
  }
  size_t large = 0;
  for (size_t i = 0; i < n->union_count; i++) {
    large += n->unions[i].terms >= QN_CELL_FEWEST;
  }
  if (large == 0) {
    return QUOIN_OK;
  }
  c->union_count = n->union_count;
  c->grid = qn_alloc(mem, c->union_count * sizeof *c->grid);
  c->grids = qn_alloc_line(mem, (c->grid_room = large) * sizeof *c->grids);
  quoin_status status = c->grid && c->grids ? QUOIN_OK : QUOIN_E_MEMORY;
  for (size_t i = 0; i < n->union_count && status == QUOIN_OK; i++) {
    c->grid[i] = QN_NO_GRID;
    if (n->unions[i].terms >= QN_CELL_FEWEST) {
      status = add_grid(c, mem, n, (uint32_t)i);
    }
  }
  if (status != QUOIN_OK) {
    qn_cells_free(c, mem);
    *out = NULL;
  }
  return status;
}

const qn_cells *qn_scene_cells(const quoin_scene *scene) {
  qn_cells *there = atomic_load_explicit(scene->cells, memory_order_acquire), *mine;
  if (!there && qn_cells_build(&scene->normal, scene->mem, &mine) == QUOIN_OK) {
    if (atomic_compare_exchange_strong_explicit(scene->cells, &there, mine, memory_order_acq_rel, memory_order_acquire)) {
      there = mine;
    } else {
      qn_cells_free(mine, scene->mem);
    }
  }
  return there && there->grid_count ? there : NULL;
}
