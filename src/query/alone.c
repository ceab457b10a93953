/* Whether one surface alone passes through the places where lanes of a packet end.

   Where several parts share the surface of a hit, a packet may have named another of them than the woven path does, and at a place where a second surface passes too even another surface
   (wide/packet.h). Here all other half-spaces nearby are ruled out by the bounds of points (shadow.h), so that the surface is known; its parts may still be several. Lanes that are neighbours in a
   tile and end on one surface lie in a small box: a half-space that has one sign all over it passes through none of their places. Where that is not certain the lanes are asked in four
   parts, down to one by one.

   Legend: the box is c + [-e, e], y = c - pivot, X_i = row_i . (y, 1); R_i = sum |row_ij| e_j, which no X_i differs by from what it is at c. Bounds: docs/bounds.md, "A hit", "A box of places". */
#include "base/bounds.h"
#include "query/look.h"
#include "query/shadow.h"

#include <math.h>

typedef struct patch {
  const quoin_scene *scene;
  double c[3], e[3], weight[3]; /* of one place e is 0 and c has weights; of several c is exact */
  uint32_t surface;
  int one, alone;
} patch;

static double reach_of(const double row[3], const double e[3]) { return (fabs(row[0]) * e[0] + fabs(row[1]) * e[1]) + fabs(row[2]) * e[2]; }

/* -1 or 1: the sign of q all over the box; 0, or another number: not certain. */
static int sign_over(const patch *p, const qn_half *half, const qn_frame *frame) {
  double value = 0, bound = 0, reach = 0;
  if (p->one) {
    return qn_shadow_sign(p->scene, half, frame);
  }
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
  const qn_frame frame = qn_frame_of(p->c, p->weight, leaf->pivot);
  int open = 0; /* another surface may pass */
  for (uint32_t h = leaf->half0; h < leaf->half0 + leaf->halves && p->alone; h++) {
    const qn_half *half = &p->scene->halves[h];
    const int sign = half->surface == p->surface ? -1 : sign_over(p, half, &frame);
    if (sign == 1) {
      return; /* all of the box is out of the leaf */
    }
    open |= sign != -1;
  }
  p->alone &= !open;
}

/* min, max: the box, or more. */
static int ask(patch *p, const double min[3], const double max[3]) {
  for (int i = 0; i < 3; i++) {
    if (!isfinite(min[i]) || !isfinite(max[i]) || !isfinite(p->e[i])) {
      return 0;
    }
  }
  uint64_t nodes = 0;
  p->alone = 1;
  qn_bvh_point(&p->scene->bvh, min, max, see_leaf, p, &nodes);
  for (size_t i = 0; i < p->scene->unbounded_count && p->alone; i++) {
    see_leaf(p, p->scene->unbounded[i]);
  }
  return p->alone;
}

/* The true place is o + T d with |T - t| <= error. As computed, x_i = fl(o_i + fl(t d_i)): |x_i - true| <= error |d_i| + u |t d_i| + u |x_i|; a face of a box about it takes u |x_i| more. */
static int one_is_alone(const quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, unsigned lane) {
  patch p = {.scene = scene, .surface = hits->surface[lane], .one = 1};
  double min[3], max[3];
  for (int i = 0; i < 3; i++) {
    const double d = packet->d[i][lane], step = hits->t[lane] * d;
    p.c[i] = packet->o[i][lane] + step;
    p.weight[i] = QN_SLACK * (hits->error[lane] * fabs(d) / QN_U + fabs(step) + fabs(p.c[i])) + QN_POINT_TINY;
    const double off = QN_SLACK * QN_U * (p.weight[i] + fabs(p.c[i]));
    min[i] = p.c[i] - off, max[i] = p.c[i] + off;
  }
  return ask(&p, min, max);
}

static int some_are_alone(const quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes) {
  patch p = {.scene = scene, .surface = hits->surface[qn_trailing_zeros(lanes)]};
  double min[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, max[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (uint64_t m = lanes; m; m &= m - 1) {
    const unsigned lane = qn_trailing_zeros(m);
    if (hits->surface[lane] != p.surface) {
      return 0;
    }
    for (int i = 0; i < 3; i++) {
      const double d = packet->d[i][lane], step = hits->t[lane] * d, x = packet->o[i][lane] + step;
      const double off = QN_SLACK * (hits->error[lane] * fabs(d) + QN_U * (fabs(step) + 2 * fabs(x))) + QN_POINT_TINY;
      min[i] = x - off < min[i] ? x - off : min[i], max[i] = x + off > max[i] ? x + off : max[i];
    }
  }
  for (int i = 0; i < 3; i++) {
    p.c[i] = 0.5 * (min[i] + max[i]);
    p.e[i] = QN_SLACK * (max[i] - p.c[i] > p.c[i] - min[i] ? max[i] - p.c[i] : p.c[i] - min[i]);
  }
  return ask(&p, min, max);
}

uint64_t qn_alone_lanes(const quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes) {
  uint64_t alone = 0;
  unsigned size = QN_LANES;
  for (unsigned at = 0; at < QN_LANES;) {
    const uint64_t some = size == QN_LANES ? lanes : lanes & ((((uint64_t)1 << size) - 1) << at);
    const int several = (some & (some - 1)) != 0;
    if (some && (several ? some_are_alone(scene, packet, hits, some) : one_is_alone(scene, packet, hits, qn_trailing_zeros(some)))) {
      alone |= some;
    } else if (several) {
      size /= 4;
      continue;
    }
    at += size;
    for (; size < QN_LANES && at % (4 * size) == 0; size *= 4) {
    }
  }
  return alone;
}
