/* Whether one surface alone passes through the places where lanes of a packet end, many lanes at once.

   As alone.c for one place: of parts that share a surface a packet may have named another than the woven path does, and where a second surface passes even another surface. Lanes
   that are neighbours in a tile and end on one surface lie in a small box; a half-space of another surface that has one sign all over the box passes through none of their
   places. Where that is not certain the lanes are asked in four parts, down to one by one.

   Legend: the box is c + [-e, e], y = c - pivot, X_i = row_i . (y, 1); R_i = sum |row_ij| e_j, which no X_i differs by from what it is at c. Bounds: docs/bounds.md, "A box of places". */
#include "base/bounds.h"
#include "query/look.h"
#include "query/shadow.h"

#include <math.h>

typedef struct patch {
  const quoin_scene *scene;
  double c[3], e[3];
  uint32_t surface;
  int alone;
} patch;

static double reach_of(const double row[3], const double e[3]) { return (fabs(row[0]) * e[0] + fabs(row[1]) * e[1]) + fabs(row[2]) * e[2]; }

/* -1 or 1: the sign of q all over the box; 0: not certain. */
static int sign_over(const patch *p, const qn_half *half, const qn_frame *frame) {
  double value = 0, bound = 0, reach = 0;
  if (half->kind == QN_PLANE) {
    const qn_plane_shadow *s = &p->scene->planes[half->shadow];
    value = qn_plane_value(s, frame, &bound);
    reach = reach_of(s->n, p->e);
  } else if (half->kind == QN_QUADRIC_BODY) {
    const qn_quadric_shadow *s = &p->scene->quadrics[half->shadow];
    value = qn_quadric_value(s, frame, &bound);
    for (int i = 0; i < 3; i++) {
      if (s->s[i] == 0 && (i != 2 || s->l == 0)) {
        continue;
      }
      const double *row = s->row[i], r = reach_of(row, p->e);
      const double x = ((row[0] * frame->y[0] + row[1] * frame->y[1]) + row[2] * frame->y[2]) + row[3];
      const double omega = ((fabs(row[0]) * frame->w[0] + fabs(row[1]) * frame->w[1]) + fabs(row[2]) * frame->w[2]) + fabs(row[3]);
      reach += fabs(s->s[i]) * (r * (2 * (fabs(x) + QN_POINT_MAP_E * omega) + r));
      reach += i == 2 ? 2 * fabs(s->l) * r : 0;
    }
  } else {
    return 0;
  }
  const double most = QN_SLACK * (bound + reach) + QN_POINT_TINY;
  return value > most ? 1 : -value > most ? -1 : 0;
}

static void see_leaf(void *user, uint32_t number) {
  patch *p = user;
  const qn_leaf *leaf = &p->scene->leaves[number];
  const double exact[3] = {0, 0, 0};
  const qn_frame frame = qn_frame_of(p->c, exact, leaf->pivot);
  int open = 0; /* another surface may pass */
  for (uint32_t h = leaf->half0; h < leaf->half0 + leaf->halves && p->alone; h++) {
    const qn_half *half = &p->scene->halves[h];
    const int sign = half->surface == p->surface ? -1 : sign_over(p, half, &frame);
    if (sign > 0) {
      return; /* all of the box is out of the leaf */
    }
    open |= sign == 0;
  }
  p->alone &= !open;
}

/* The lanes, all on one surface, surely with no other one. */
static int is_alone(const quoin_work *work, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes) {
  patch p = {.scene = work->scene, .surface = hits->surface[qn_trailing_zeros(lanes)], .alone = 1};
  double min[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, max[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (uint64_t m = lanes; m; m &= m - 1) {
    const unsigned lane = qn_trailing_zeros(m);
    const double t = hits->t[lane], error = hits->error[lane];
    if (hits->surface[lane] != p.surface) {
      return 0;
    }
    for (int i = 0; i < 3; i++) {
      const double d = packet->d[i][lane], x = packet->o[i][lane] + t * d, off = QN_SLACK * (error * fabs(d) + QN_U * (fabs(t * d) + fabs(x))) + QN_POINT_TINY;
      min[i] = x - off < min[i] ? x - off : min[i], max[i] = x + off > max[i] ? x + off : max[i];
    }
  }
  for (int i = 0; i < 3; i++) { /* off is that of a place times QN_SLACK: the rounding of its sums is within it */
    p.c[i] = 0.5 * (min[i] + max[i]);
    p.e[i] = QN_SLACK * (max[i] - p.c[i] > p.c[i] - min[i] ? max[i] - p.c[i] : p.c[i] - min[i]);
    if (!isfinite(p.c[i]) || !isfinite(p.e[i])) {
      return 0;
    }
  }
  uint64_t nodes = 0;
  qn_bvh_point(&p.scene->bvh, min, max, see_leaf, &p, &nodes);
  for (size_t i = 0; i < p.scene->unbounded_count && p.alone; i++) {
    see_leaf(&p, p.scene->unbounded[i]);
  }
  return p.alone;
}

uint64_t qn_alone_lanes(const quoin_work *work, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes) {
  uint64_t alone = 0;
  unsigned size = QN_LANES;
  for (unsigned at = 0; at < QN_LANES;) {
    const uint64_t some = size == QN_LANES ? lanes : lanes & ((((uint64_t)1 << size) - 1) << at);
    if (some && (some & (some - 1)) && !is_alone(work, packet, hits, some)) {
      size /= 4;
      continue;
    }
    alone |= some;
    if (some && !(some & (some - 1))) {
      const unsigned lane = qn_trailing_zeros(some);
      const quoin_ray ray = {{packet->o[0][lane], packet->o[1][lane], packet->o[2][lane]}, {packet->d[0][lane], packet->d[1][lane], packet->d[2][lane]}, 0, 0};
      if (!qn_alone_there(work, &ray, hits->t[lane], hits->error[lane], hits->surface[lane])) {
        alone &= ~some;
      }
    }
    at += size;
    for (; size < QN_LANES && at % (4 * size) == 0; size *= 4) {
    }
  }
  return alone;
}
