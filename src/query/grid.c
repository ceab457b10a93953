/* A grid of rays, tile by tile. */
#include "query/look.h"

#include <math.h>

static int finite3(const double v[3]) { return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]); }

/* What all tiles of a grid share. Returns 0 when the shared vector is not one for rays. */
static int fill_shared(const quoin_grid *g, qn_packet *p) {
  const double *same = g->converging ? g->o : g->d;
  for (unsigned lane = 0; lane < QN_LANES; lane++) {
    for (int k = 0; k < 3; k++) {
      (g->converging ? p->o : p->d)[k][lane] = same[k];
    }
    p->from[lane] = g->from, p->to[lane] = g->to;
    p->on[lane] = QUOIN_NO_SURFACE;
  }
  p->new_origins = p->new_directions = 1;
  p->few = 0;
  p->tile = g->converging ? QN_TILE_DIRECTIONS : QN_TILE_ORIGINS;
  return finite3(g->o) && finite3(g->u) && finite3(g->v) && finite3(g->d) && (g->converging || g->d[0] != 0 || g->d[1] != 0 || g->d[2] != 0);
}

/* Describes the tile at (x, y); lanes past the edges repeat the last column and row. Returns 0 when a ray is not one (a direction
   that is zero, or numbers beyond doubles). */
static int fill_tile(const quoin_grid *g, size_t x, size_t y, size_t x1, size_t y1, qn_packet *p) {
  unsigned columns = x1 - x < 8 ? (unsigned)(x1 - x) : 8, rows = y1 - y < 8 ? (unsigned)(y1 - y) : 8;
  const double *base = g->converging ? g->d : g->o;
  double s[8], r[8];
  for (unsigned i = 0; i < 8; i++) {
    s[i] = ((double)(x + (i < columns ? i : columns - 1)) + 0.5) / (double)g->width;
    r[i] = ((double)(y + (i < rows ? i : rows - 1)) + 0.5) / (double)g->height;
  }
  int finite = 1, through_zero = g->converging;
  for (int k = 0; k < 3; k++) {
    for (unsigned i = 0; i < 8; i++) {
      p->across[k][i] = base[k] + s[i] * g->u[k];
      p->up[k][i] = r[i] * g->v[k];
    }
    const double *a = p->across[k], *u = p->up[k];
    const double corner[4] = {a[0] + u[0], a[7] + u[0], a[0] + u[7], a[7] + u[7]}; /* sums are monotone: the rest lies between */
    int low = 0, high = 0;
    for (int i = 0; i < 4; i++) {
      finite &= isfinite(corner[i]) != 0;
      low |= corner[i] <= 0, high |= corner[i] >= 0;
    }
    through_zero &= low && high;
  }
  p->live = columns == 8 && rows == 8 ? ~(uint64_t)0 : 0;
  if (!p->live || through_zero) {
    for (unsigned lane = 0; lane < QN_LANES; lane++) {
      unsigned c = qn_lane_column(lane), w = qn_lane_row(lane);
      double any = 0;
      for (int k = 0; k < 3; k++) {
        any += fabs(p->across[k][c] + p->up[k][w]);
      }
      p->live |= (uint64_t)(c < columns && w < rows) << lane;
      finite &= !through_zero || any > 0;
    }
  }
  return finite;
}

quoin_status quoin_grid_hits(const quoin_scene *scene, quoin_work *work, const quoin_grid *grid, size_t x0, size_t y0, size_t x1, size_t y1, unsigned want,
                             quoin_spot *out) {
  if (!scene || !work || work->scene != scene || !grid || !out || x0 > x1 || y0 > y1 || x1 > grid->width || y1 > grid->height) {
    return QUOIN_E_ARGUMENT;
  }
  qn_packet packet;
  if (!fill_shared(grid, &packet) || !(grid->from <= grid->to && grid->from < HUGE_VAL && grid->to > -HUGE_VAL)) {
    return QUOIN_E_ARGUMENT;
  }
  qn_seen seen[QN_LANES];
  const unsigned look = want & QUOIN_WANT_T ? QN_LOOK_T : 0;
  for (size_t y = y0; y < y1; y += 8) {
    for (size_t x = x0; x < x1; x += 8) {
      if (!fill_tile(grid, x, y, x1, y1, &packet)) {
        return QUOIN_E_ARGUMENT;
      }
      uint64_t met;
      quoin_status status = qn_look_packet(work, &packet, look, seen, &met);
      if (status != QUOIN_OK) {
        return status;
      }
      packet.new_origins = !grid->converging, packet.new_directions = grid->converging;
      quoin_spot *tile = out + (y - y0) * (x1 - x0) + (x - x0);
      const unsigned columns = x1 - x < 8 ? (unsigned)(x1 - x) : 8, rows = y1 - y < 8 ? (unsigned)(y1 - y) : 8;
      for (unsigned w = 0; w < rows; w++) {
        for (unsigned c = 0; c < columns; c++) {
          tile[w * (x1 - x0) + c] = (quoin_spot){.surface = QUOIN_NO_SURFACE};
        }
      }
      for (; met; met &= met - 1) {
        unsigned lane = qn_trailing_zeros(met);
        tile[qn_lane_row(lane) * (x1 - x0) + qn_lane_column(lane)] = (quoin_spot){seen[lane].t, seen[lane].surface, seen[lane].leaving};
      }
    }
  }
  return QUOIN_OK;
}
