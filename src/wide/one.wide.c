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

/* Whether leaves tied at the place that was found, and whether its surface is open (walk.h). */
static int tied_at(const walk *w, double t, int *open) {
  unsigned here = w->ties[0] > TIES ? ALL_TIES : 0;
  for (int i = 0; i < w->ties[0] && i < TIES; i++) {
    here |= (unsigned)!(fabs(w->tie[i][0] - t) > w->tolerance[0]) << i;
  }
  *open = (here & w->open[0]) != 0;
  return here != 0;
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

/* 0: nothing is to be walked; w->unsure: the ray is given up. */
QN_INLINE int ray_begin(walk *w, const struct quoin_scene *scene, qn_packet *packet, uint64_t budget) {
  w->scene = scene, w->normal = &scene->normal, w->unsure = 0, w->counts = (qn_wide_counts){.budget = budget ? budget : UINT64_MAX};
  w->ties[0] = w->open[0] = 0, w->tolerance[0] = 0;
  if (!quick_facts(w, packet)) {
    packet->new_origins = packet->new_directions = 1, packet->kept_ranges = 0; /* what was kept was not made by facts() */
    if (!facts(w, packet)) { /* numbers for which no bound is given */
      w->unsure = 1;
      return 0;
    }
  }
  if (packet->empty) { /* no stretch is left: of one point, or out of the range of ends */
    w->unsure = packet->from[0] < packet->to[0];
    return 0;
  }
  return 1;
}

/* Into one lane of hits. found: *best is a place in the set. */
QN_INLINE void ray_end(walk *w, int found, const place *start, place *best, qn_packet_hits *hits, unsigned lane) {
  const qn_packet *packet = w->f.p;
  const int complement = w->scene->normal.complement;
  int left = 0;
  if (!(packet->any && complement)) {
    found = found && !packet->any && !w->unsure ? boundary_of(w, start, best, &left) : found;
    /* beyond reach planes may have been taken for what they are not: something else is there */
    w->unsure |= CHECKED && found && !(fabs(best->t) <= w->f.reach);
  }
  hits->unsure |= w->unsure << lane;
  if (!found || w->unsure) {
    return;
  }
  hits->found |= (uint64_t)1 << lane;
  if (packet->any) {
    return;
  }
  const uint64_t payload = vword(best->p);
  hits->t[lane] = best->t, hits->error[lane] = w->tolerance[0] * 0.5;
  hits->surface[lane] = (uint32_t)payload, hits->leaf[lane] = (uint32_t)(payload >> 32) & QN_LEAF_BITS;
  hits->far_end |= (uint64_t)vsecond(best->p) << lane;
  hits->leaving |= (uint64_t)(complement ? !left : left) << lane;
  int open;
  hits->tied |= (uint64_t)tied_at(w, best->t, &open) << lane;
  hits->tied_surface |= (uint64_t)open << lane;
}

void QN_OF_ISA(qn_one)(const struct quoin_scene *scene, qn_packet *packet, qn_packet_hits *hits, qn_wide_counts *counts);
void QN_OF_ISA(qn_one)(const struct quoin_scene *scene, qn_packet *packet, qn_packet_hits *hits, qn_wide_counts *counts) {
  walk w;
  hits->unsure = hits->found = hits->leaving = hits->far_end = hits->tied = hits->tied_surface = 0;
  counts->packets++;
  if (!ray_begin(&w, scene, packet, counts->budget)) {
    hits->unsure = w.unsure & packet->live;
    return;
  }
  if (!packet->live) {
    return;
  }
  const place start = {packet->start.t[0], packet->start.p[0]};
  place best = {packet->stop[0], payload_bits(QN_NOBODY)};
  const int found = packet->any && scene->normal.complement ? any_outside(&w, start)
                                                             : union_walk(&w, &scene->normal.unions[scene->normal.root], &start, &best, packet->soonest, packet->latest, packet->any);
  ray_end(&w, found, &start, &best, hits, 0);
  counts->nodes += w.counts.nodes, counts->leaves += w.counts.leaves;
}

/* --- rays abreast --------------------------------------------------------------------------------------------------- */

/* Rays that have nothing in common wait for memory at almost every node of a large scene. So several are walked at a time, a step of each in turn: while one computes,
   what the others need is on its way. What a ray asks, and in which order, is what it asks when it goes alone. */
enum { ABREAST = 8 };

typedef struct strand {
  walk w;
  stroll s;
  place start, best;
  unsigned lane;
  waiting stack[STACK];
  qn_packet p;
  _Alignas(64) char apart[64]; /* so that the strands' like numbers are not all in one set of the cache */
} strand;

/* Takes up the ray of a lane. 0: it has been answered. */
static int strand_begin(strand *t, const struct quoin_scene *scene, const qn_packet *packet, unsigned lane, qn_packet_hits *hits, uint64_t budget) {
  qn_packet *p = &t->p;
  for (int k = 0; k < 3; k++) {
    p->o[k][0] = packet->o[k][lane], p->d[k][0] = packet->d[k][lane];
  }
  p->from[0] = packet->from[lane], p->to[0] = packet->to[lane], p->on[0] = packet->on[lane];
  p->live = 1, p->few = QN_ONE_LANE, p->any = packet->any;
  p->new_origins = p->new_directions = 1, p->kept_ranges = 0, p->tile = QN_TILE_NONE;
  t->lane = lane;
  if (!ray_begin(&t->w, scene, p, budget)) {
    hits->unsure |= t->w.unsure << lane;
    return 0;
  }
  t->start = (place){p->start.t[0], p->start.p[0]};
  t->best = (place){p->stop[0], payload_bits(QN_NOBODY)};
  if (p->any && scene->normal.complement) {
    t->s.found = any_outside(&t->w, t->start);
  } else if (stroll_begin(&t->w, &t->s, &scene->normal.unions[scene->normal.root], &t->start, &t->best, p->soonest, p->latest, p->any)) {
    return 1;
  }
  ray_end(&t->w, t->s.found, &t->start, &t->best, hits, lane);
  return 0;
}

QN_INLINE void strand_counts(const strand *t, qn_wide_counts *counts) {
  const qn_wide_counts *own = &t->w.counts;
  counts->nodes += own->nodes, counts->leaves += own->leaves, counts->lost += own->leaves > own->budget;
}

void QN_OF_ISA(qn_each)(const struct quoin_scene *scene, qn_packet *packet, qn_packet_hits *hits, qn_wide_counts *counts);
void QN_OF_ISA(qn_each)(const struct quoin_scene *scene, qn_packet *packet, qn_packet_hits *hits, qn_wide_counts *counts) {
  strand strands[ABREAST];
  uint64_t rest = packet->live;
  unsigned busy = 0;
  hits->unsure = hits->found = hits->leaving = hits->far_end = hits->tied = hits->tied_surface = 0;
  memset(hits->t, 0, sizeof hits->t), memset(hits->error, 0, sizeof hits->error);
  memset(hits->surface, 0, sizeof hits->surface), memset(hits->leaf, 0, sizeof hits->leaf);
  counts->packets++;
  for (unsigned k = 0; rest || busy; k = (k + 1) % ABREAST) {
    strand *t = &strands[k];
    int more = 0;
    if (busy >> k & 1) {
      /* cppcheck-suppress uninitvar ; it has begun */
      if (stroll_step(&t->w, &t->s, t->stack, 1)) {
        continue;
      }
      ray_end(&t->w, t->s.found, &t->start, &t->best, hits, t->lane);
      strand_counts(t, counts);
    }
    while (rest && !more) {
      const unsigned lane = qn_trailing_zeros(rest);
      rest &= rest - 1;
      more = strand_begin(t, scene, packet, lane, hits, counts->budget);
      if (!more) {
        strand_counts(t, counts);
      }
    }
    busy = (busy & ~(1u << k)) | (unsigned)more << k;
  }
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
