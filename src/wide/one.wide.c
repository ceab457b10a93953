/* A single ray: a body of its own over numbers instead of vectors; nodes' eight boxes are still tested at once. */
#define QN_SCALAR
#define QN_LANES_NOW 1
#include "wide/one_body.h"
#include "wide/round_ball.h"
#include "wide/round_run.h"

/* Whether the ray is outside the scene's set anywhere in its range. */
static int any_outside(walk *w, place at) {
  union_leave(w, w->normal->root, &at);
  const double gap = w->f.p->to[0] - at.t;
  if (w->unsure || gap < -w->tolerance[0] || at.t >= QN_FAR) {
    return 0;
  }
  w->unsure |= !(gap > w->tolerance[0] && fabs(at.t) <= w->f.reach);
  return !w->unsure;
}

/* Whether a leaf tied at the place that was found (walk.h). */
static int tied_at(const walk *w, double t) {
  int tied = w->ties[0] > TIES;
  for (int i = 0; i < w->ties[0] && i < TIES; i++) {
    tied |= !(fabs(w->tie[i][0] - t) > w->tolerance[0]);
  }
  return tied;
}

/* best: the first place in the set; it becomes the first boundary. 1: found; *left: it is where the ray leaves the set. */
static int boundary_of(walk *w, const place *start, place *best, int *left) {
  *left = 0;
  if (!vsigns(best->p)) { /* QN_STARTS_ON: the ray begins inside the set, and its first boundary is where it leaves it */
    return 1;
  }
  place at = *start;
  *left = union_leave(w, w->normal->root, &at);
  if (w->unsure || !*left) {
    return 0;
  }
  *best = at;
  const double gap = w->f.p->to[0] - at.t;
  if (gap < -w->tolerance[0] || at.t >= QN_FAR) {
    return 0;
  }
  w->unsure |= !(gap > w->tolerance[0]);
  return 1;
}

void QN_OF_ISA(qn_one)(const struct quoin_scene *scene, qn_packet *packet, qn_packet_hits *hits, qn_wide_counts *counts);
void QN_OF_ISA(qn_one)(const struct quoin_scene *scene, qn_packet *packet, qn_packet_hits *hits, qn_wide_counts *counts) {
  walk w;
  w.scene = scene, w.normal = &scene->normal, w.unsure = 0, w.counts = (qn_wide_counts){.budget = counts->budget ? counts->budget : UINT64_MAX};
  w.ties[0] = 0, w.tolerance[0] = 0;
  hits->unsure = hits->found = hits->leaving = hits->far_end = hits->tied = 0;
  if (!quick_facts(&w, packet)) {
    packet->new_origins = packet->new_directions = 1, packet->kept_ranges = 0; /* what was kept was not made by facts() */
    if (!facts(&w, packet)) { /* numbers for which no bound is given */
      hits->unsure = packet->live;
      return;
    }
  }
  counts->packets++;
  if (!packet->live) {
    return;
  }
  if (packet->empty) { /* no stretch is left: of one point, or out of the range of ends */
    hits->unsure = packet->from[0] < packet->to[0];
    return;
  }
  const qn_union *root = &scene->normal.unions[scene->normal.root];
  const place start = {packet->start.t[0], packet->start.p[0]};
  place best = {packet->stop[0], payload_bits(QN_NOBODY)};
  int found, left = 0;
  if (packet->any && scene->normal.complement) {
    found = any_outside(&w, start);
  } else {
    found = union_walk(&w, root, &start, &best, packet->soonest, packet->latest, packet->any);
    found = found && !packet->any && !w.unsure ? boundary_of(&w, &start, &best, &left) : found;
    /* beyond reach planes may have been taken for what they are not: something else is there */
    w.unsure |= CHECKED && found && !(fabs(best.t) <= w.f.reach);
  }
  hits->unsure = w.unsure;
  hits->found = found && !w.unsure;
  counts->nodes += w.counts.nodes, counts->leaves += w.counts.leaves;
  if (packet->any || !hits->found) {
    return;
  }
  const uint64_t payload = vword(best.p);
  hits->t[0] = best.t, hits->error[0] = w.tolerance[0] * 0.5;
  hits->surface[0] = (uint32_t)payload, hits->leaf[0] = (uint32_t)(payload >> 32) & QN_LEAF_BITS;
  hits->far_end = vsecond(best.p);
  hits->leaving = (uint64_t)(scene->normal.complement ? !left : left);
  hits->tied = (uint64_t)tied_at(&w, best.t);
}

int QN_OF_ISA(qn_round_one)(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, double *t, uint64_t *made);
int QN_OF_ISA(qn_round_one)(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, double *t, uint64_t *made) {
  const qn_piece_sphere *sphere = packet->tile != QN_TILE_PAIRS ? sphere_of_lane(scene, hits, 0) : NULL;
  if (sphere) {
    const ball b = ball_of_one(packet, sphere);
    if (ball_round_lanes(packet, hits, &b, 0, t)) {
      return 1;
    }
  }
  const qn_rounding *surface = qn_scene_rounding(scene, hits->surface[0], made);
  return surface && round_run(surface, packet, hits, 0, 1, t) & 1;
}
