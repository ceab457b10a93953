/* What follows from a packet's rays before any piece is met. Static code of the packet body. */
#ifndef QN_WIDE_FACTS_H
#define QN_WIDE_FACTS_H

#include "wide/walk.h"

/* The least and largest of eight neighbouring lanes. */
QN_INLINE void extremes(const double *v, double *low, double *high) {
  if (SUB_LANES == 1) {
    *low = *high = *v;
    return;
  }
  vd a = vload(v), b = a;
  for (int i = QN_W; i < SUB_LANES; i += QN_W) {
    vd x = vload(v + i);
    a = vmin(a, x), b = vmax(b, x);
  }
  _Alignas(64) double x[QN_W], y[QN_W];
  vstore(x, a), vstore(y, b);
  *low = x[0], *high = y[0];
  for (int i = 1; i < QN_W; i++) {
    *low = least(*low, x[i]), *high = most(*high, y[i]);
  }
}

static void see_origins(qn_packet *p) {
  for (int i = 0; i < 3; i++) {
    p->low[i] = INFINITY, p->high[i] = -INFINITY;
    for (int k = 0; k < SUBS; k++) {
      double low, high;
      extremes(p->o[i] + k * SUB_LANES, &low, &high);
      p->omin[i][k] = down(low), p->omax[i][k] = up(high);
      p->low[i] = least(p->low[i], low), p->high[i] = most(p->high[i], high);
    }
  }
}

/* Eight lanes are four columns and two rows (packet.h); sums of what is monotone are extreme in the corners. */
static void see_tile_origins(qn_packet *p) {
  for (int i = 0; i < 3; i++) {
    double x[2][2], y[4][2];
    for (int h = 0; h < 2; h++) {
      double a = p->across[i][4 * h], b = p->across[i][4 * h + 3];
      x[h][0] = least(a, b), x[h][1] = most(a, b);
    }
    for (int h = 0; h < 4; h++) {
      double a = p->up[i][2 * h], b = p->up[i][2 * h + 1];
      y[h][0] = least(a, b), y[h][1] = most(a, b);
    }
    for (int k = 0; k < SUBS; k++) {
      int c = k >> 1 & 1, r = (k & 1) | (k >> 1 & 2);
      p->omin[i][k] = down(x[c][0] + y[r][0]), p->omax[i][k] = up(x[c][1] + y[r][1]);
    }
    p->low[i] = least(x[0][0], x[1][0]) + least(y[0][0], y[3][0]);
    p->high[i] = most(x[0][1], x[1][1]) + most(y[0][1], y[3][1]);
  }
}

static void fill_tile(qn_packet *p, double (*to)[QN_LANES]) {
  for (int i = 0; i < 3; i++) {
    for (unsigned q = 0; q < QN_LANES_NOW / 4; q++) { /* four lanes are two columns and two rows */
      unsigned c = (q & 1) << 1 | (q >> 1 & 2) << 1, r = (q >> 1 & 1) << 1 | (q >> 2 & 2) << 1;
      double *t = to[i] + 4 * q, a = p->across[i][c], b = p->across[i][c + 1], v = p->up[i][r], w = p->up[i][r + 1];
      t[0] = a + v, t[1] = b + v;
      t[2] = a + w, t[3] = b + w;
    }
  }
}

static void see_directions(qn_packet *p) {
  const vd zero = vset(0), one = vset(1);
  for (int g = 0; g < QN_LANES_NOW; g += QN_W) {
    vd dd = zero;
    for (int i = 0; i < 3; i++) {
      vd d = vload(p->d[i] + g);
      vm none = vandnot(vmask(QN_ALL_BITS), vor(vlt(d, zero), vlt(zero, d)));
      vstore(p->inv[i] + g, vpick(none, zero, vdiv(one, vpick(none, one, d))));
      dd = vfma(d, d, dd);
    }
    vstore(p->idd + g, vdiv(one, dd));
  }
  double low, high;
  p->dd_min = INFINITY, p->dd_max = 0;
  for (int k = 0; k < SUBS; k++) {
    extremes(p->idd + k * SUB_LANES, &low, &high);
    p->dd_min = least(p->dd_min, 1 / (QN_WIDE_SLACK * high)), p->dd_max = most(p->dd_max, QN_WIDE_SLACK / low);
  }
  for (int i = 0; i < 3; i++) {
    double dlow = INFINITY, dhigh = -INFINITY;
    int finite = 1;
    for (int k = 0; k < SUBS; k++) {
      extremes(p->d[i] + k * SUB_LANES, &low, &high);
      dlow = least(dlow, low), dhigh = most(dhigh, high);
      extremes(p->inv[i] + k * SUB_LANES, &low, &high);
      /* Widened away from the true range in either direction, so that the products' rounding cannot matter. */
      p->imin[i][k] = down(low - fabs(low) * QN_WIDE_FLOAT), p->imax[i][k] = up(high + fabs(high) * QN_WIDE_FLOAT);
      finite &= isfinite(p->imin[i][k]) && isfinite(p->imax[i][k]);
    }
    p->dabs[i] = most(fabs(dlow), fabs(dhigh));
    p->axis[i] = !finite ? AXIS_MIXED : dlow > 0 ? AXIS_UP : dhigh < 0 ? AXIS_DOWN : dlow == 0 && dhigh == 0 ? AXIS_FLAT : AXIS_MIXED;
  }
}

/* Returns 0 when the rays' numbers are not in the range that the bounds are for. */
static int facts(walk *w, qn_packet *p) {
  packet_facts *f = &w->f;
  f->p = p;
  if (p->tile == QN_TILE_DIRECTIONS) {
    fill_tile(p, p->d);
  }
  if (p->tile == QN_TILE_ORIGINS) {
    see_tile_origins(p);
  } else if (p->new_origins) {
    see_origins(p);
  }
  if (p->new_directions) {
    see_directions(p);
  }
  for (int i = 0; i < 3; i++) {
    f->share[i] = p->tile == QN_TILE_PAIRS ? most(fabs(p->low[i]), fabs(p->high[i])) : 0;
  }
  double reach2 = 0;
  int in_range = p->dd_min >= 1 / (QN_WIDE_LARGEST * QN_WIDE_LARGEST) && p->dd_max <= QN_WIDE_LARGEST * QN_WIDE_LARGEST;
  for (int i = 0; i < 3; i++) {
    w->all_omin[i] = INFINITY, w->all_omax[i] = -INFINITY, w->all_imin[i] = INFINITY, w->all_imax[i] = -INFINITY;
    for (int k = 0; k < SUBS; k++) {
      w->all_omin[i] = p->omin[i][k] < w->all_omin[i] ? p->omin[i][k] : w->all_omin[i], w->all_omax[i] = p->omax[i][k] > w->all_omax[i] ? p->omax[i][k] : w->all_omax[i];
      w->all_imin[i] = p->imin[i][k] < w->all_imin[i] ? p->imin[i][k] : w->all_imin[i], w->all_imax[i] = p->imax[i][k] > w->all_imax[i] ? p->imax[i][k] : w->all_imax[i];
    }
    double far = farthest(f, i, 0) + most(fabs(w->scene->min[i]), fabs(w->scene->max[i]));
    reach2 += far * far;
    in_range &= farthest(f, i, 0) <= QN_WIDE_LARGEST && w->all_imin[i] >= -QN_WIDE_LARGEST && w->all_imax[i] <= QN_WIDE_LARGEST;
  }
  f->reach = QN_WIDE_SLACK * sqrt(reach2 / p->dd_min);
  return in_range;
}

#endif
