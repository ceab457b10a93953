/* Whether one surface alone passes through the places where lanes of a packet end, and whose it is there.

   Where several parts share the surface of a hit, a packet may have named another of them than the woven path does, and at a place where a second surface passes too even another surface
   (wide/packet.h). Here all other half-spaces nearby are ruled out by the bounds of points (shadow.h), so that the surface is known; its parts may still be several. Lanes that are neighbours in a
   tile and end on one surface lie in a small box: a half-space that has one sign all over it passes through none of their places. Where that is not certain the lanes are asked in four
   parts, down to one by one.

   Each leaf is then inside all over the box, outside all over it, or changes with the surface alone: what the program makes of these changes, in the order of the leaves as in the weave
   (ray/weave.c), names the part.

   Legend: the box is c + [-e, e], y = c - pivot, X_i = row_i . (y, 1); R_i = sum |row_ij| e_j, which no X_i differs by from what it is at c. Bounds: docs/bounds.md, "A hit", "A box of places". */
#include "base/bounds.h"
#include "query/look.h"
#include "query/shadow.h"

#include <math.h>

enum { MOST_PARTS = 32 };
#define NO_PART UINT32_MAX
typedef struct changing { uint32_t leaf; int8_t side; } changing; /* side: of the leaf's half-space on the surface */

typedef struct patch {
  const quoin_scene *scene;
  qn_eval *eval; /* null: parts do not matter */
  double c[3], e[3], weight[3]; /* of one place e is 0 and c has weights; of several c is exact */
  uint32_t surface;
  int one, alone;
  uint32_t inside[MOST_PARTS]; /* leaves that are inside all over the box */
  changing changing[MOST_PARTS];
  size_t inside_count, changing_count;
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
  int open = 0;    /* another surface may pass */
  int8_t side = 0; /* of the half-space on the surface; 0: the leaf has none */
  for (uint32_t h = leaf->half0; h < leaf->half0 + leaf->halves && p->alone; h++) {
    const qn_half *half = &p->scene->halves[h];
    if (half->surface == p->surface) {
      open |= side != 0 && side != half->side;
      side = half->side;
      continue;
    }
    const int sign = sign_over(p, half, &frame);
    if (sign == 1) {
      return; /* all of the box is out of the leaf */
    }
    open |= sign != -1;
  }
  p->alone &= !open;
  if (!p->alone || !p->eval || leaf->gate == QN_NO_GATE) {
    return;
  }
  if (p->inside_count == MOST_PARTS || p->changing_count == MOST_PARTS) {
    p->alone = 0;
  } else if (side == 0) {
    p->inside[p->inside_count++] = number;
  } else {
    size_t k = p->changing_count++;
    for (; k > 0 && p->changing[k - 1].leaf > number; k--) {
      p->changing[k] = p->changing[k - 1];
    }
    p->changing[k] = (changing){number, side};
  }
}

static int turn(const patch *p, uint32_t number, int enter) {
  const qn_leaf *leaf = &p->scene->leaves[number];
  return qn_eval_change(p->eval, leaf->gate, enter != leaf->negated ? 1 : -1);
}

/* The part that makes the boundary for a ray that passes through the surface and enters the half-spaces of one side; NO_PART: the program does not say that the solid is entered or left. */
static uint32_t part_of(const patch *p, int entered_side, int leaving) {
  for (size_t i = 0; i < p->inside_count; i++) {
    turn(p, p->inside[i], 1);
  }
  for (size_t i = 0; i < p->changing_count; i++) {
    if (p->changing[i].side != entered_side) {
      turn(p, p->changing[i].leaf, 1);
    }
  }
  const int before = p->eval->value;
  int value = before;
  uint32_t last = NO_PART;
  for (size_t i = 0; i < p->changing_count; i++) {
    const int now = turn(p, p->changing[i].leaf, p->changing[i].side == entered_side);
    last = now != value ? p->changing[i].leaf : last;
    value = now;
  }
  qn_eval_reset(p->eval);
  return before == leaving && value != before ? last : NO_PART;
}

/* The side of the half-spaces that a lane's ray enters, from the leaf that its packet names: that one's literal becomes true where the solid is entered. */
static int entered_side(const patch *p, const qn_packet_hits *hits, unsigned lane) {
  const qn_leaf *leaf = &p->scene->leaves[hits->leaf[lane]];
  const int leaving = (int)(hits->leaving >> lane & 1), enters = leaving == leaf->negated;
  for (uint32_t h = leaf->half0; h < leaf->half0 + leaf->halves; h++) {
    const qn_half *half = &p->scene->halves[h];
    if (half->surface == p->surface) {
      return enters ? half->side : -half->side;
    }
  }
  return 0;
}

/* Names the parts of lanes that are alone; those of them for which there is one. */
static uint64_t name_parts(const patch *p, const qn_packet_hits *hits, uint64_t lanes, uint32_t leaf[QN_LANES]) {
  uint32_t part[4];
  unsigned known = 0;
  uint64_t named = 0;
  for (uint64_t m = lanes; m; m &= m - 1) {
    const unsigned lane = qn_trailing_zeros(m);
    const int side = entered_side(p, hits, lane), leaving = (int)(hits->leaving >> lane & 1), way = 2 * leaving + (side > 0);
    if (side == 0) {
      continue;
    }
    if (!(known >> way & 1)) {
      part[way] = part_of(p, side, leaving);
      known |= 1u << way;
    }
    if (part[way] != NO_PART) {
      leaf[lane] = part[way];
      named |= (uint64_t)1 << lane;
    }
  }
  return named;
}

/* min, max: the box, or more. */
static int ask(patch *p, const double min[3], const double max[3]) {
  for (int i = 0; i < 3; i++) {
    if (!isfinite(min[i]) || !isfinite(max[i]) || !isfinite(p->e[i])) {
      return 0;
    }
  }
  uint64_t nodes = 0;
  p->alone = 1, p->inside_count = p->changing_count = 0;
  qn_bvh_point(&p->scene->bvh, min, max, see_leaf, p, &nodes);
  for (size_t i = 0; i < p->scene->unbounded_count && p->alone; i++) {
    see_leaf(p, p->scene->unbounded[i]);
  }
  return p->alone;
}

/* The true place is o + T d with |T - t| <= error. As computed, x_i = fl(o_i + fl(t d_i)): |x_i - true| <= error |d_i| + u |t d_i| + u |x_i|; a face of a box about it takes u |x_i| more. */
static int one_is_alone(patch *p, const qn_packet *packet, const qn_packet_hits *hits, unsigned lane) {
  double min[3], max[3];
  p->surface = hits->surface[lane], p->one = 1;
  for (int i = 0; i < 3; i++) {
    const double d = packet->d[i][lane], step = hits->t[lane] * d;
    p->e[i] = 0;
    p->c[i] = packet->o[i][lane] + step;
    p->weight[i] = QN_SLACK * (hits->error[lane] * fabs(d) / QN_U + fabs(step) + fabs(p->c[i])) + QN_POINT_TINY;
    const double off = QN_SLACK * QN_U * (p->weight[i] + fabs(p->c[i]));
    min[i] = p->c[i] - off, max[i] = p->c[i] + off;
  }
  return ask(p, min, max);
}

/* The same of several lanes, with the largest error, step and place of any in place of each one's own. */
static int some_are_alone(patch *p, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes) {
  const unsigned first = qn_trailing_zeros(lanes);
  double min[3], max[3], d[3] = {0}, step[3] = {0}, error = 0;
  p->surface = hits->surface[first], p->one = 0;
  for (int i = 0; i < 3; i++) {
    min[i] = max[i] = packet->o[i][first] + hits->t[first] * packet->d[i][first];
  }
  for (uint64_t m = lanes; m; m &= m - 1) {
    const unsigned lane = qn_trailing_zeros(m);
    if (hits->surface[lane] != p->surface) {
      return 0;
    }
    error = hits->error[lane] > error ? hits->error[lane] : error;
    for (int i = 0; i < 3; i++) {
      const double e = packet->d[i][lane], s = hits->t[lane] * e, x = packet->o[i][lane] + s;
      min[i] = x < min[i] ? x : min[i], max[i] = x > max[i] ? x : max[i];
      d[i] = fabs(e) > d[i] ? fabs(e) : d[i], step[i] = fabs(s) > step[i] ? fabs(s) : step[i];
    }
  }
  for (int i = 0; i < 3; i++) {
    const double most = -min[i] > max[i] ? -min[i] : max[i], off = QN_SLACK * (error * d[i] + QN_U * (step[i] + 2 * most)) + QN_POINT_TINY;
    min[i] -= off, max[i] += off;
    p->weight[i] = 0;
    p->c[i] = 0.5 * (min[i] + max[i]);
    p->e[i] = QN_SLACK * (max[i] - p->c[i] > p->c[i] - min[i] ? max[i] - p->c[i] : p->c[i] - min[i]);
  }
  return ask(p, min, max);
}

/* Lanes that are alone; with an eval, those whose parts are named in leaf. */
static uint64_t alone_in_parts(patch *p, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes, uint32_t *leaf) {
  uint64_t alone = 0;
  unsigned size = QN_LANES;
  for (unsigned at = 0; at < QN_LANES;) {
    const uint64_t some = size == QN_LANES ? lanes : lanes & ((((uint64_t)1 << size) - 1) << at);
    const int several = (some & (some - 1)) != 0;
    if (some && (several ? some_are_alone(p, packet, hits, some) : one_is_alone(p, packet, hits, qn_trailing_zeros(some)))) {
      alone |= p->eval ? name_parts(p, hits, some, leaf) : some;
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

uint64_t qn_alone_lanes(const quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes) {
  patch p = {.scene = scene};
  return alone_in_parts(&p, packet, hits, lanes, NULL);
}

uint64_t qn_name_parts(const quoin_scene *scene, qn_eval *eval, const qn_packet *packet, qn_packet_hits *hits, uint64_t lanes) {
  patch p = {.scene = scene, .eval = eval};
  return alone_in_parts(&p, packet, hits, lanes, hits->leaf);
}
