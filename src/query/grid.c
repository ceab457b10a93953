/* A grid of rays, tile by tile. */
#include "query/look.h"
#include "query/sheaf.h"

#include <math.h>
#include <string.h>

enum { STRIP = 16, TOGETHER = 4 }; /* tiles side by side whose columns are computed at once; and that share an entry (wide/packet.h), as many one above the other */

static int finite3(const double v[3]) { return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]); }

/* (i + 0.5) / n for i from first; no further than last. */
static void shares(double out[8], size_t first, size_t last, size_t n) {
  double i[8];
  for (unsigned k = 0; k < 8; k++) {
    i[k] = (double)(first + k);
  }
  for (unsigned k = 0; QN_UNLIKELY(first + 7 > last) && k < 8; k++) {
    i[k] = (double)(first + k < last ? first + k : last);
  }
  for (unsigned k = 0; k < 8; k++) {
    out[k] = (i[k] + 0.5) / (double)n;
  }
}

static void columns_of(const quoin_grid *g, size_t first, size_t last, double out[3][8]) {
  const double *base = g->converging ? g->d : g->o;
  double s[8];
  shares(s, first, last, g->width);
  for (int k = 0; k < 3; k++) {
    for (unsigned i = 0; i < 8; i++) {
      out[k][i] = base[k] + s[i] * g->u[k];
    }
  }
}
static void rows_of(const quoin_grid *g, size_t first, size_t last, double out[3][8]) {
  double r[8];
  shares(r, first, last, g->height);
  for (int k = 0; k < 3; k++) {
    for (unsigned i = 0; i < 8; i++) {
      out[k][i] = r[i] * g->v[k];
    }
  }
}

/* Whether a part of a grid has no ray but those that a ray may be: finite, and none without a direction. *near_zero: a direction may be the zero vector. */
static int are_rays(const quoin_grid *g, size_t x0, size_t y0, size_t x1, size_t y1, int *near_zero) {
  double left[3][8], right[3][8], top[3][8], bottom[3][8];
  columns_of(g, x0, x0, left), columns_of(g, x1 - 1, x1 - 1, right);
  rows_of(g, y0, y0, top), rows_of(g, y1 - 1, y1 - 1, bottom);
  *near_zero = g->converging;
  for (int k = 0; k < 3; k++) { /* sums are monotone, so that the least and the largest stand in the corners */
    const double a = left[k][0], b = right[k][0], c = top[k][0], d = bottom[k][0];
    const double low = fmin(fmin(a + c, a + d), fmin(b + c, b + d)), high = fmax(fmax(a + c, a + d), fmax(b + c, b + d));
    if (!isfinite(a + c) || !isfinite(a + d) || !isfinite(b + c) || !isfinite(b + d)) {
      return 0;
    }
    *near_zero &= low <= 0 && high >= 0;
  }
  return finite3(g->o) && finite3(g->u) && finite3(g->v) && finite3(g->d) && (g->converging || g->d[0] != 0 || g->d[1] != 0 || g->d[2] != 0) &&
         g->from <= g->to && g->from < HUGE_VAL && g->to > -HUGE_VAL;
}

/* What all tiles of a grid share. */
static void fill_shared(const quoin_grid *g, qn_packet *p) {
  const double *same = g->converging ? g->o : g->d;
  for (unsigned lane = 0; lane < QN_LANES; lane++) {
    for (int k = 0; k < 3; k++) {
      (g->converging ? p->o : p->d)[k][lane] = same[k];
    }
    p->from[lane] = g->from, p->to[lane] = g->to;
    p->on[lane] = QUOIN_NO_SURFACE;
  }
  p->new_origins = p->new_directions = 1, p->kept_ranges = 0;
  p->few = QN_MANY_LANES;
  p->any = 0;
  p->entry = NULL;
  p->tile = g->converging ? QN_TILE_DIRECTIONS : QN_TILE_ORIGINS;
}

/* Lanes past the edges repeat the last column and row. */
static uint64_t lanes_within(unsigned columns, unsigned rows) {
  uint64_t live = 0;
  for (unsigned lane = 0; lane < QN_LANES; lane++) {
    live |= (uint64_t)(qn_lane_column(lane) < columns && qn_lane_row(lane) < rows) << lane;
  }
  return live;
}

static int has_zero(const qn_packet *p) {
  int zero = 0;
  for (unsigned lane = 0; lane < QN_LANES; lane++) {
    int all = 1;
    for (int k = 0; k < 3; k++) {
      all &= p->across[k][qn_lane_column(lane)] + p->up[k][qn_lane_row(lane)] == 0;
    }
    zero |= all;
  }
  return zero;
}

/* --- tile by tile ------------------------------------------------------------------------------------------------------ */

typedef struct tiles {
  quoin_work *work;
  const quoin_grid *grid;
  qn_packet *packet;
  size_t x0, y0, x1, y1, strip; /* of the grid; and where this strip begins */
  int leaves, enters;           /* leaves: what is walked is the hierarchy of all leaves; enters: it has more than one node */
  size_t x, y;                  /* of this tile, */
  unsigned columns, rows;       /* and how much of it there is */
  double across[STRIP][3][8];
  qn_entry entry[STRIP / TOGETHER];
  int entered[STRIP / TOGETHER];
} tiles;

static void tiles_begin(tiles *t, quoin_work *work, const quoin_grid *grid, size_t x0, size_t y0, size_t x1, size_t y1, int leaves, qn_packet *packet) {
  t->work = work, t->grid = grid, t->packet = packet;
  t->x0 = x0, t->y0 = y0, t->x1 = x1, t->y1 = y1, t->leaves = leaves;
  t->enters = (leaves ? work->scene->bvh.node_count : work->scene->normal.node_count) > 1;
  memset(t->entered, 0, sizeof t->entered);
  t->strip = t->x = x0, t->y = y0, t->columns = 0;
  fill_shared(grid, packet);
}

/* After its body has seen a tile. */
static void packet_seen(tiles *t) { t->packet->new_origins = !t->grid->converging, t->packet->new_directions = t->grid->converging, t->packet->kept_ranges = 1; }

/* The entries of TOGETHER rows of tiles of a strip, from y on. A few tiles alone do without. */
static void enter(tiles *t, size_t y) {
  qn_packet *p = t->packet;
  const size_t tiles_up = (t->y1 - y + 7) / 8, up = tiles_up < TOGETHER ? tiles_up : TOGETHER;
  double top[3][8];
  rows_of(t->grid, y, t->y1 - 1, p->up), rows_of(t->grid, y + 8 * (up - 1), t->y1 - 1, top);
  for (int k = 0; k < 3; k++) {
    memcpy(p->up[k] + 4, top[k] + 4, 4 * sizeof **top);
  }
  for (size_t i = 0; i < STRIP && t->strip + 8 * i < t->x1; i += TOGETHER) {
    const size_t tiles_on = (t->x1 - t->strip + 7) / 8 - i, on = tiles_on < TOGETHER ? tiles_on : TOGETHER;
    t->entered[i / TOGETHER] = 0;
    if (on * up >= TOGETHER) {
      for (int k = 0; k < 3; k++) {
        memcpy(p->across[k], t->across[i][k], 4 * sizeof(double)), memcpy(p->across[k] + 4, t->across[i + on - 1][k] + 4, 4 * sizeof(double));
      }
      if (qn_look_enter(t->work, p, t->leaves, &t->entry[i / TOGETHER])) {
        t->entered[i / TOGETHER] = 1;
        packet_seen(t);
      }
    }
  }
}

/* The next row of tiles of a strip, or the first one of the next strip; 0: there is none. */
static int next_row(tiles *t) {
  t->y += t->columns == 0 ? 0 : 8;
  if (t->y >= t->y1) {
    t->strip += 8 * STRIP, t->y = t->y0;
  }
  if (t->strip >= t->x1) {
    return 0;
  }
  t->x = t->strip;
  for (size_t i = 0; t->y == t->y0 && i < STRIP && t->strip + 8 * i < t->x1; i++) {
    columns_of(t->grid, t->strip + 8 * i, t->x1 - 1, t->across[i]);
  }
  if (t->enters && (t->y - t->y0) % (8 * TOGETHER) == 0) {
    enter(t, t->y);
  }
  t->rows = t->y1 - t->y < 8 ? (unsigned)(t->y1 - t->y) : 8;
  rows_of(t->grid, t->y, t->y1 - 1, t->packet->up);
  return 1;
}

/* Fills the packet with the next tile; 0: there is none. */
QN_INLINE int next_tile(tiles *t) {
  qn_packet *p = t->packet;
  if (t->columns != 0) {
    packet_seen(t);
    t->x += 8;
  }
  if (t->columns == 0 || t->x >= t->x1 || t->x - t->strip == 8 * STRIP) {
    if (!next_row(t)) {
      return 0;
    }
  }
  const size_t i = (t->x - t->strip) / 8;
  t->columns = t->x1 - t->x < 8 ? (unsigned)(t->x1 - t->x) : 8;
  memcpy(p->across, t->across[i], sizeof p->across);
  p->live = t->columns == 8 && t->rows == 8 ? ~(uint64_t)0 : lanes_within(t->columns, t->rows);
  p->entry = t->entered[i / TOGETHER] ? &t->entry[i / TOGETHER] : NULL;
  return 1;
}

quoin_status quoin_grid_hits(const quoin_scene *scene, quoin_work *work, const quoin_grid *grid, size_t x0, size_t y0, size_t x1, size_t y1, unsigned want,
                             quoin_spot *out) {
  if (!scene || !work || work->scene != scene || !grid || !out || x0 > x1 || y0 > y1 || x1 > grid->width || y1 > grid->height || (want & ~(unsigned)QUOIN_WANT_T)) {
    return QUOIN_E_ARGUMENT;
  }
  if (x0 == x1 || y0 == y1) {
    return QUOIN_OK;
  }
  int near_zero;
  if (!are_rays(grid, x0, y0, x1, y1, &near_zero)) {
    return QUOIN_E_ARGUMENT;
  }
  qn_packet packet;
  tiles t;
  tiles_begin(&t, work, grid, x0, y0, x1, y1, 0, &packet);
  const size_t stride = x1 - x0;
  const unsigned look = want & QUOIN_WANT_T ? QN_LOOK_T : 0;
  while (next_tile(&t)) {
    const int whole = t.columns == 8 && t.rows == 8;
    if (near_zero && has_zero(&packet)) {
      return QUOIN_E_ARGUMENT;
    }
    quoin_spot part[QN_LANES], *tile = out + (t.y - y0) * stride + (t.x - x0);
    quoin_status status = qn_look_tile(work, &packet, look, whole ? tile : part, whole ? stride : 8);
    if (status != QUOIN_OK) {
      return status;
    }
    for (unsigned w = 0; !whole && w < t.rows; w++) {
      memcpy(tile + w * stride, part + 8 * w, t.columns * sizeof *part);
    }
  }
  return QUOIN_OK;
}

/* --- all intervals ----------------------------------------------------------------------------------------------------- */

static quoin_status append(quoin_work *work, size_t n, const quoin_interval *from, quoin_interval **to, size_t *count, size_t *capacity, quoin_run *run) {
  if (*count + n > UINT32_MAX || !qn_grow(work->mem, to, capacity, *count + n)) {
    return QUOIN_E_MEMORY;
  }
  *run = (quoin_run){(uint32_t)*count, (uint32_t)n};
  for (size_t i = 0; i < n; i++) { /* from may be null when n is 0 */
    (*to)[*count + i] = from[i];
  }
  *count += n;
  return QUOIN_OK;
}

/* A lane that its packet has given up, alone. */
static quoin_status woven(quoin_work *work, unsigned lane, unsigned want, size_t place) {
  qn_sheaf *s = work->sheaf;
  const qn_packet *p = &s->packet;
  const unsigned x = qn_lane_column(lane), y = qn_lane_row(lane);
  quoin_ray ray = {{p->o[0][lane], p->o[1][lane], p->o[2][lane]}, {p->d[0][lane], p->d[1][lane], p->d[2][lane]}, p->from[lane], p->to[lane]};
  for (int k = 0; k < 3; k++) { /* the body may not have filled it in */
    (p->tile == QN_TILE_ORIGINS ? ray.o : ray.d)[k] = p->across[k][x] + p->up[k][y];
  }
  quoin_intervals one;
  quoin_status status = quoin_ray_intervals(work->scene, work, &ray, want, &one);
  if (status == QUOIN_OK) {
    status = append(work, one.count, one.inside, &s->found, &s->found_count, &s->found_capacity, &s->found_of[place]);
  }
  if (status == QUOIN_OK && want) {
    status = append(work, one.boundary_count, one.boundary, &s->boundary, &s->boundary_count, &s->boundary_capacity, &s->boundary_of[place]);
  }
  return status;
}

QN_INLINE quoin_run run_of(const qn_sheaf *s, unsigned lane) { return (quoin_run){s->first[lane], s->spans.row_count[lane] / 2}; }

/* One tile; its first ray is number `first` of the answer, a row has `stride`. */
static quoin_status tile_intervals(quoin_work *work, unsigned want, size_t first, size_t stride, unsigned columns, unsigned rows) {
  qn_sheaf *s = work->sheaf;
  uint64_t sure;
  quoin_status status = qn_sheaf_tile(work, &sure);
  if (status != QUOIN_OK) {
    return status;
  }
  for (unsigned y = 0; want && y < rows; y++) {
    for (unsigned x = 0; x < columns; x++) { /* what is certain has nothing in the boundary */
      s->boundary_of[first + y * stride + x] = (quoin_run){(uint32_t)s->boundary_count, 0};
    }
  }
  if (s->spans.rows == 0) {
    for (unsigned y = 0; y < rows; y++) {
      for (unsigned x = 0; x < columns; x++) {
        s->found_of[first + y * stride + x] = (quoin_run){(uint32_t)s->found_count, 0};
      }
    }
  } else if (columns == 8 && rows == 8) {
    for (unsigned lane = 0; lane < QN_LANES; lane += 4) { /* two columns and two rows */
      quoin_run *run = s->found_of + first + qn_lane_row(lane) * stride + qn_lane_column(lane);
      run[0] = run_of(s, lane), run[1] = run_of(s, lane + 1), run[stride] = run_of(s, lane + 2), run[stride + 1] = run_of(s, lane + 3);
    }
  } else {
    for (unsigned y = 0; y < rows; y++) {
      for (unsigned x = 0; x < columns; x++) {
        s->found_of[first + y * stride + x] = run_of(s, qn_lane_of(x, y));
      }
    }
  }
  for (uint64_t m = s->packet.live & ~sure; m && status == QUOIN_OK; m &= m - 1) {
    const unsigned lane = qn_trailing_zeros(m);
    status = woven(work, lane, want, first + qn_lane_row(lane) * stride + qn_lane_column(lane));
  }
  return status;
}

quoin_status quoin_grid_intervals(const quoin_scene *scene, quoin_work *work, const quoin_grid *grid, size_t x0, size_t y0, size_t x1, size_t y1, unsigned want,
                                  quoin_grid_answer *out) {
  if (!scene || !work || work->scene != scene || !grid || !out || x0 > x1 || y0 > y1 || x1 > grid->width || y1 > grid->height || want > QUOIN_WANT_BOUNDARY) {
    return QUOIN_E_ARGUMENT;
  }
  *out = (quoin_grid_answer){0};
  if (x0 == x1 || y0 == y1) {
    return QUOIN_OK;
  }
  int near_zero;
  const size_t stride = x1 - x0, rays = stride * (y1 - y0);
  if (!are_rays(grid, x0, y0, x1, y1, &near_zero)) {
    return QUOIN_E_ARGUMENT;
  }
  qn_packet *packet = rays / stride == y1 - y0 ? qn_sheaf_packet(work) : NULL;
  qn_sheaf *s = work->sheaf;
  if (!packet || !qn_grow(work->mem, &s->found_of, &s->run_capacity, rays) || (want && !qn_grow(work->mem, &s->boundary_of, &s->boundary_run_capacity, rays))) {
    return QUOIN_E_MEMORY;
  }
  s->found_count = s->boundary_count = 0;
  tiles t;
  tiles_begin(&t, work, grid, x0, y0, x1, y1, 1, packet);
  while (next_tile(&t)) {
    if (near_zero && has_zero(packet)) {
      return QUOIN_E_ARGUMENT;
    }
    quoin_status status = tile_intervals(work, want, (t.y - y0) * stride + (t.x - x0), stride, t.columns, t.rows);
    if (status != QUOIN_OK) {
      return status;
    }
  }
  *out = (quoin_grid_answer){rays, s->found_of, s->found_count, s->found, want ? s->boundary_of : NULL, s->boundary_count, s->boundary};
  return QUOIN_OK;
}
