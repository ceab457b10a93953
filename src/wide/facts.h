/* What follows from a packet's rays before any piece is met. Static code of the packet body. */
#ifndef QN_WIDE_FACTS_H
#define QN_WIDE_FACTS_H

#include "wide/outline.h"

static void see_origins(qn_packet *p) {
  for (int i = 0; i < 3; i++) {
    const double off = p->tile == QN_TILE_MOVED ? 2 * QN_U * p->moved[i] : 0; /* a moved start may be small beside what its rounding is a share of */
    _Alignas(64) double low[SUBS], high[SUBS];
    sub_extremes(p->o[i], 0, low), sub_extremes(p->o[i], 1, high);
    p->low[i] = INFINITY, p->high[i] = -INFINITY;
    for (int k = 0; k < SUBS; k++) {
      low[k] -= off, high[k] += off;
      p->low[i] = least(p->low[i], low[k]), p->high[i] = most(p->high[i], high[k]);
    }
    outward(low, high, p->omin[i], p->omax[i]);
  }
}

#if QN_LANES_NOW >= 8 /* tiles */
/* Eight lanes are four columns and two rows (packet.h); sums of what is monotone are extreme in the corners. */
static void see_tile_origins(qn_packet *p) {
  for (int i = 0; i < 3; i++) {
    const double *a = p->across[i], *u = p->up[i];
    const double x[2] = {least(a[0], a[3]), least(a[4], a[7])}, X[2] = {most(a[0], a[3]), most(a[4], a[7])};
    const double y[4] = {least(u[0], u[1]), least(u[2], u[3]), least(u[4], u[5]), least(u[6], u[7])}, Y[4] = {most(u[0], u[1]), most(u[2], u[3]), most(u[4], u[5]), most(u[6], u[7])};
    fstore(p->omin[i], downs(ftable(x, y))), fstore(p->omax[i], ups(ftable(X, Y)));
    p->low[i] = least(x[0], x[1]) + least(y[0], y[3]);
    p->high[i] = most(X[0], X[1]) + most(Y[0], Y[3]);
  }
}

/* Four lanes are two columns and two rows, eight of them four columns. */
static void fill_tile(qn_packet *p, double (*to)[QN_LANES]) {
  for (int i = 0; i < 3; i++) {
    const double *a = p->across[i], *u = p->up[i];
#if QN_W == 8
    const vd columns = vload(a), up = vload(u), pairs[2] = {vlanes(columns, 0, 1, 0, 1, 2, 3, 2, 3), vlanes(columns, 4, 5, 4, 5, 6, 7, 6, 7)};
    const vd rows[4] = {vlanes(up, 0, 0, 1, 1, 0, 0, 1, 1), vlanes(up, 2, 2, 3, 3, 2, 2, 3, 3), vlanes(up, 4, 4, 5, 5, 4, 4, 5, 5), vlanes(up, 6, 6, 7, 7, 6, 6, 7, 7)};
    for (unsigned q = 0; q < QN_LANES_NOW / 8; q++) {
      vstore(to[i] + 8 * q, vadd(pairs[q >> 1 & 1], rows[(q & 1) | (q >> 1 & 2)]));
    }
#elif QN_W == 4
    vd pairs[4], rows[4];
    for (int k = 0; k < 4; k++) {
      pairs[k] = vfour(a[2 * k], a[2 * k + 1], a[2 * k], a[2 * k + 1]), rows[k] = vfour(u[2 * k], u[2 * k], u[2 * k + 1], u[2 * k + 1]);
    }
    for (unsigned q = 0; q < QN_LANES_NOW / 4; q++) {
      vstore(to[i] + 4 * q, vadd(pairs[(q & 1) | (q >> 1 & 2)], rows[(q >> 1 & 1) | (q >> 2 & 2)]));
    }
#else
    for (unsigned q = 0; q < QN_LANES_NOW / 4; q++) {
      unsigned c = (q & 1) << 1 | (q >> 1 & 2) << 1, r = (q >> 1 & 1) << 1 | (q >> 2 & 2) << 1;
      double *t = to[i] + 4 * q;
      t[0] = a[c] + u[r], t[1] = a[c + 1] + u[r];
      t[2] = a[c] + u[r + 1], t[3] = a[c + 1] + u[r + 1];
    }
#endif
  }
}
#endif

static void see_directions(qn_packet *p) {
  const vd zero = vset(0), one = vset(1);
  vd shortest = vset(INFINITY), longest = zero, most_idd = zero;
  for (int g = 0; g < QN_LANES_NOW; g += QN_W) {
    vd dd = zero;
    for (int i = 0; i < 3; i++) {
      vd d = vload(p->d[i] + g);
      vm none = vandnot(vmask(QN_ALL_BITS), vor(vlt(d, zero), vlt(zero, d)));
      vstore(p->inv[i] + g, vpick(none, zero, vdiv(one, vpick(none, one, d))));
      dd = vfma(d, d, dd);
    }
    vd idd = vdiv(one, dd);
    vstore(p->idd + g, idd);
    shortest = vmin(shortest, dd), longest = vmax(longest, dd), most_idd = vmax(most_idd, idd);
  }
  _Alignas(64) double x[QN_W], y[QN_W], z[QN_W];
  vstore(x, shortest), vstore(y, longest), vstore(z, most_idd);
  for (int i = 1; i < QN_W; i++) {
    x[0] = least(x[0], x[i]), y[0] = most(y[0], y[i]), z[0] = most(z[0], z[i]);
  }
  p->dd_min = (2 - QN_WIDE_SLACK) * x[0], p->dd_max = QN_WIDE_SLACK * y[0];
  p->d_most = sqrt(p->dd_max), p->idd_most = QN_WIDE_SLACK * QN_WIDE_SLACK * z[0], p->shy = p->idd_most * p->d_most * QN_WIDE_SHY_ROOT;
  p->one_way = 1;
  for (int i = 0; i < 3; i++) {
    _Alignas(64) double low[SUBS], high[SUBS];
    double dlow = INFINITY, dhigh = -INFINITY;
    int finite = 1;
    sub_extremes(p->d[i], 0, low), sub_extremes(p->d[i], 1, high);
    for (int k = 0; k < SUBS; k++) {
      dlow = least(dlow, low[k]), dhigh = most(dhigh, high[k]);
    }
    sub_extremes(p->inv[i], 0, low), sub_extremes(p->inv[i], 1, high);
    for (int k = 0; k < SUBS; k++) { /* widened away from the true range in either direction, so that the products' rounding cannot matter */
      low[k] -= fabs(low[k]) * QN_WIDE_FLOAT, high[k] += fabs(high[k]) * QN_WIDE_FLOAT;
    }
    outward(low, high, p->imin[i], p->imax[i]);
    p->all_imin[i] = p->imin[i][0], p->all_imax[i] = p->imax[i][0];
    for (int k = 0; k < SUBS; k++) {
      finite &= isfinite(p->imin[i][k]) && isfinite(p->imax[i][k]);
      p->all_imin[i] = p->imin[i][k] < p->all_imin[i] ? p->imin[i][k] : p->all_imin[i], p->all_imax[i] = p->imax[i][k] > p->all_imax[i] ? p->imax[i][k] : p->all_imax[i];
    }
    p->one_way &= dlow == dhigh;
    p->dabs[i] = most(fabs(dlow), fabs(dhigh));
    p->axis[i] = !finite ? AXIS_MIXED : dlow > 0 ? AXIS_UP : dhigh < 0 ? AXIS_DOWN : dlow == 0 && dhigh == 0 ? AXIS_FLAT : AXIS_MIXED;
  }
}

/* The ranges as ends are compared. */
static void see_ranges(qn_packet *p) {
  double low = INFINITY, high = -INFINITY;
  p->empty = 0;
  for (int g = 0; g < QN_GROUPS; g++) {
    vd from = vmax(vload(p->from + g * QN_W), vset(-QN_FAR)), to = vmin(vload(p->to + g * QN_W), vset(QN_FAR));
    vstore(p->start.t + g * QN_W, from), vstore(p->stop + g * QN_W, to);
    p->empty |= (uint64_t)(QN_ALL_BITS & ~vbits(vlt(from, to))) << (g * QN_W);
  }
  for (int j = 0; j < QN_LANES_NOW; j++) {
    p->start.p[j] = payload_bits(p->on[j] | QN_STARTS_ON);
    low = least(low, p->start.t[j]), high = most(high, p->stop[j]);
  }
  p->soonest = down(low), p->latest = up(high);
}

/* Returns 0 when the rays' numbers are not in the range that the bounds are for. */
static int facts(walk *w, qn_packet *p) {
  packet_facts *f = &w->f;
  f->p = p;
  int seen = !p->new_origins;
#if QN_LANES_NOW >= 8
  if (p->tile == QN_TILE_DIRECTIONS) {
    fill_tile(p, p->d);
  } else if (p->tile == QN_TILE_ORIGINS) {
    see_tile_origins(p);
    seen = 1;
  }
#endif
  if (!seen) {
    see_origins(p);
  }
  if (p->new_directions) {
    see_directions(p);
#if QN_LANES_NOW == 64
    if (p->one_way) {
      see_across(p);
    }
#endif
  }
  for (int i = 0; i < 3; i++) {
    f->share[i] = p->tile == QN_TILE_PAIRS ? most(fabs(p->low[i]), fabs(p->high[i])) : p->tile == QN_TILE_MOVED ? p->moved[i] : 0;
  }
  if (!p->kept_ranges) {
    see_ranges(p);
  }
  double far = 0; /* at least the length of the way from an origin to any place of the solid */
  int in_range = p->dd_min >= 1 / (QN_WIDE_LARGEST * QN_WIDE_LARGEST) && p->dd_max <= QN_WIDE_LARGEST * QN_WIDE_LARGEST;
  for (int i = 0; i < 3; i++) {
    w->all_omin[i] = down(p->low[i]), w->all_omax[i] = up(p->high[i]);
    w->all_imin[i] = p->all_imin[i], w->all_imax[i] = p->all_imax[i];
    far += farthest(f, i, 0) + most(fabs(w->scene->min[i]), fabs(w->scene->max[i]));
    in_range &= farthest(f, i, 0) <= QN_WIDE_LARGEST && w->all_imin[i] >= -QN_WIDE_LARGEST && w->all_imax[i] <= QN_WIDE_LARGEST;
  }
#if QN_LANES_NOW == 1
  beam_make(w);
#endif
  f->reach = QN_WIDE_SLACK * far * p->idd_most * p->d_most;
  return in_range;
}

#endif
