/* One packet: through the wide body that this machine runs; a ray that it gives up is woven. */
#include "base/bounds.h"
#include "query/look.h"

#include <math.h>

static quoin_ray ray_of(const qn_packet *p, unsigned lane) {
  quoin_ray ray = {{p->o[0][lane], p->o[1][lane], p->o[2][lane]}, {p->d[0][lane], p->d[1][lane], p->d[2][lane]}, p->from[lane], p->to[lane]};
  if (p->tile != QN_TILE_NONE) { /* the body may not have filled it in */
    for (int k = 0; k < 3; k++) {
      (p->tile == QN_TILE_ORIGINS ? ray.o : ray.d)[k] = p->across[k][qn_lane_column(lane)] + p->up[k][qn_lane_row(lane)];
    }
  }
  return ray;
}

/* What a packet may cost. Where terms overlap through many levels a walk may be far longer than solving all leaves along the ray, which is what weaving comes to. So
   a packet that has solved more leaves than a woven ray does, and some, is given up; and where that happens to most packets, only one in
   32 is tried at all. Answers are the same either way. */
enum { PATIENCE_FIRST = 1024, PATIENCE_SOME = 96, LOST_MANY = 8, LOST_MOST = 16, TRY_EACH = 32 };

static uint64_t patience_budget(qn_patience *p) { /* 0: it is not tried */
  return p->lost >= LOST_MANY && ++p->turn % TRY_EACH ? 0 : (p->fair ? p->fair : PATIENCE_FIRST) + PATIENCE_SOME;
}
static void patience_won(qn_patience *p) { p->lost -= p->lost > 0; }
static void patience_lost(qn_patience *p) {
  p->lost += p->lost < LOST_MOST;
  p->learns = 1;
}
static void patience_learns(qn_patience *p, uint64_t leaves_of_a_ray) {
  uint64_t fair = ((uint64_t)3 * (p->fair ? p->fair : PATIENCE_FIRST) + leaves_of_a_ray) / 4;
  p->fair = fair < 1 << 20 ? (uint32_t)fair + 1 : 1 << 20;
  p->learns = 0;
}

/* few: the packet's, where a constant spares what its kind has no need of. */
QN_INLINE void run(quoin_work *work, qn_packet *packet, int few, qn_packet_hits *hits) {
  const quoin_scene *scene = work->scene;
  hits->found = hits->tied = hits->tied_surface = hits->leaving = hits->far_end = 0, hits->unsure = packet->live;
  if (!scene->normal.made) {
    return;
  }
  qn_wide_counts wide = {.budget = patience_budget(&work->patience)};
  const qn_wide *bodies = work->wide;
  const qn_first_fn body = few == QN_MANY_LANES ? bodies->first : few == QN_FEW_LANES ? bodies->few : few == QN_ONE_LANE ? bodies->one : bodies->each;
  if (wide.budget == 0) {
    /* What the body derives from the rays is made all the same: the next packet may say that it keeps their directions. */
    const uint64_t live = packet->live;
    packet->live = 0;
    body(scene, packet, hits, &wide);
    packet->live = live;
    hits->found = hits->tied = hits->tied_surface = hits->leaving = hits->far_end = 0, hits->unsure = live;
  } else {
    qn_counts *counts = qn_scratch_counts(work->scratch);
    body(scene, packet, hits, &wide);
    counts->nodes += wide.nodes, counts->leaves += wide.leaves, counts->packets++;
    const unsigned lanes = few == QN_ONE_LANE ? 1 : qn_bits_set(packet->live), unsure = few == QN_ONE_LANE ? hits->unsure & 1 : qn_bits_set(hits->unsure);
    counts->rays += lanes - unsure;
    counts->exact_rays += unsure;
    /* Rays that go each by itself are won or lost one by one, others together, as one. */
    const int each = few == QN_EACH_LANE;
    const unsigned asked = each ? lanes : 1, lost = each ? (unsigned)wide.lost : hits->unsure == packet->live && wide.leaves > wide.budget; /* or nearly so */
    for (unsigned i = lost; i < asked; i++) {
      patience_won(&work->patience);
    }
    for (unsigned i = 0; QN_UNLIKELY(i < lost); i++) {
      patience_lost(&work->patience);
    }
  }
}

void qn_look_run(quoin_work *work, qn_packet *packet, qn_packet_hits *hits) {
  run(work, packet, packet->few, hits);
}

int qn_look_enter(quoin_work *work, qn_packet *packet, int leaves, qn_entry *entry) {
  qn_wide_counts wide = {0};
  const int entered = (leaves || work->scene->normal.made) && work->wide->enter(work->scene, packet, leaves, entry, &wide);
  qn_scratch_counts(work->scratch)->nodes += wide.nodes;
  return entered;
}

/* The first boundary between two parameters of a lane's ray. */
static quoin_status weave_between(quoin_work *work, const quoin_ray *ray, double from, double to, unsigned want, qn_seen *out) {
  const quoin_scene *scene = work->scene;
  *out = (qn_seen){.surface = QUOIN_NO_SURFACE};
  qn_query_begin(work);
  qn_line line;
  qn_line_from_doubles(ray->o, ray->d, &line);
  const qn_range range = {{.t = from, .surface = QN_NO_SURFACE}, {.t = to, .surface = QN_NO_SURFACE}};
  qn_woven woven;
  quoin_status status = qn_weave(scene, work->scratch, &line, &range, QN_WANT_FIRST, &woven);
  if (status != QUOIN_OK || woven.inside_count == 0) {
    return status;
  }
  const qn_stretch *first = &woven.inside[0];
  int leaving = first->enter.leaf == UINT32_MAX;
  const qn_stop *stop = leaving ? &first->leave : &first->enter;
  if (stop->leaf != UINT32_MAX) {
    *out = (qn_seen){.t = stop->place.t, .surface = scene->halves[stop->half].surface, .leaf = stop->leaf, .leaving = (uint8_t)leaving};
    if (want & QN_LOOK_T) {
      out->t = qn_place_round(scene, work->scratch, &line, &stop->place);
    }
  }
  return qn_scratch_ctx(work->scratch)->failed;
}

quoin_status qn_look_woven(quoin_work *work, const qn_packet *packet, unsigned lane, unsigned want, qn_seen *out) {
  const quoin_ray ray = ray_of(packet, lane);
  const uint64_t *leaves = &qn_scratch_counts(work->scratch)->leaves, before = *leaves;
  quoin_status status = weave_between(work, &ray, ray.from, ray.to, want, out);
  if (work->patience.learns) {
    patience_learns(&work->patience, *leaves - before);
  }
  return status;
}

/* A tied lane: where its boundary is was certain, who makes it is not. Only what is at that place is woven. known: null, or the place, correctly rounded: it is one place whoever makes it. */
static quoin_status look_tied(quoin_work *work, const qn_packet *packet, const qn_packet_hits *hits, unsigned lane, unsigned want, const double *known, qn_seen *out) {
  const quoin_ray ray = ray_of(packet, lane);
  const double t = hits->t[lane], e = 2 * hits->error[lane], from = nextafter(t - e, -HUGE_VAL), to = nextafter(t + e, HUGE_VAL);
  quoin_status status = weave_between(work, &ray, from > ray.from ? from : ray.from, to < ray.to ? to : ray.to, known ? want & ~(unsigned)QN_LOOK_T : want, out);
  if (status == QUOIN_OK && out->surface == QUOIN_NO_SURFACE) {
    return qn_look_woven(work, packet, lane, want, out);
  }
  out->t = known ? *known : out->t;
  return status;
}

quoin_status qn_look_round(quoin_work *work, const qn_packet *packet, const qn_packet_hits *hits, unsigned lane, double *t) {
  const quoin_ray ray = ray_of(packet, lane);
  qn_query_begin(work);
  qn_line line;
  qn_line_from_doubles(ray.o, ray.d, &line);
  const qn_place place = {.t = hits->t[lane], .e = hits->error[lane], .surface = hits->surface[lane], .which = (int)(hits->far_end >> lane & 1)};
  *t = qn_place_round(work->scene, work->scratch, &line, &place);
  return qn_scratch_ctx(work->scratch)->failed;
}

/* What rounding asks first of a leaf, which is far from the other leaves'. */
QN_INLINE void fetch_lines(const quoin_work *work, const qn_packet_hits *hits, uint64_t lanes) {
  for (uint64_t m = lanes; m && work->takes_turns && work->scene->line_of; m &= m - 1) {
    QN_FETCH(&work->scene->line_of[hits->leaf[qn_trailing_zeros(m)]]);
  }
}

/* Of lanes that went each by itself: rounding has one bound of their directions' lengths, which is good for those of about one length. */
static uint64_t round_each(quoin_work *work, qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes, double t[QN_LANES], uint64_t *made) {
  double dd[QN_LANES], least = HUGE_VAL, most = 0;
  for (uint64_t m = lanes; m; m &= m - 1) {
    const unsigned i = qn_trailing_zeros(m);
    dd[i] = packet->d[0][i] * packet->d[0][i] + packet->d[1][i] * packet->d[1][i] + packet->d[2][i] * packet->d[2][i];
    least = dd[i] < least ? dd[i] : least, most = dd[i] > most ? dd[i] : most;
  }
  fetch_lines(work, hits, lanes);
  if (most <= 4 * least) {
    packet->d_most = sqrt(QN_WIDE_SLACK * most);
    return work->wide->round(work->scene, packet, hits, lanes, t, made);
  }
  uint64_t sure = 0;
  for (uint64_t m = lanes; m; m &= m - 1) {
    const unsigned i = qn_trailing_zeros(m);
    _Alignas(64) double own[QN_LANES];
    packet->d_most = sqrt(QN_WIDE_SLACK * dd[i]);
    sure |= work->wide->round(work->scene, packet, hits, (uint64_t)1 << i, own, made);
    t[i] = own[i];
  }
  return sure;
}

QN_INLINE quoin_status look_packet(quoin_work *work, qn_packet *packet, int few, unsigned want, qn_seen *out, uint64_t *met) {
  qn_packet_hits hits;
  run(work, packet, few, &hits);
  uint64_t tied = (want & QN_LOOK_SURFACE ? hits.tied_surface : hits.tied) & ~hits.unsure;
  if (tied) {
    tied &= ~(want & QN_LOOK_SURFACE ? qn_alone_lanes(work->scene, packet, &hits, tied) : qn_name_parts(work->scene, qn_scratch_eval(work->scratch), packet, &hits, tied));
  }
  const uint64_t woven = hits.unsure | tied;
  *met = hits.found;
  for (uint64_t m = hits.found; m; m &= m - 1) {
    unsigned lane = qn_trailing_zeros(m);
    out[lane] = (qn_seen){hits.t[lane], hits.surface[lane], hits.leaf[lane], (uint8_t)(hits.leaving >> lane & 1)};
  }
  _Alignas(64) double rounded[QN_LANES];
  uint64_t sure = 0;
  if (want & QN_LOOK_T) {
    uint64_t *made = &qn_scratch_counts(work->scratch)->exact_forms;
    sure = hits.found;
    if (few == QN_ONE_LANE) {
      sure = sure && work->wide->round_one(work->scene, packet, &hits, rounded, made);
    } else if (few == QN_EACH_LANE) {
      sure = sure ? round_each(work, packet, &hits, sure, rounded, made) : 0;
    } else {
      fetch_lines(work, &hits, sure);
      sure = work->wide->round(work->scene, packet, &hits, sure, rounded, made);
    }
    for (uint64_t m = sure; m; m &= m - 1) {
      unsigned lane = qn_trailing_zeros(m);
      out[lane].t = rounded[lane];
    }
    for (uint64_t m = hits.found & ~woven & ~sure; m; m &= m - 1) {
      unsigned lane = qn_trailing_zeros(m);
      quoin_status status = qn_look_round(work, packet, &hits, lane, &out[lane].t);
      if (status != QUOIN_OK) {
        return status;
      }
    }
  }
  for (uint64_t m = woven; m; m &= m - 1) {
    unsigned lane = qn_trailing_zeros(m);
    quoin_status status = hits.unsure >> lane & 1 ? qn_look_woven(work, packet, lane, want, &out[lane])
                                                  : look_tied(work, packet, &hits, lane, want, sure >> lane & 1 ? &rounded[lane] : NULL, &out[lane]);
    *met &= ~((uint64_t)1 << lane);
    *met |= (uint64_t)(out[lane].surface != QUOIN_NO_SURFACE) << lane;
    if (status != QUOIN_OK) {
      return status;
    }
  }
  return QUOIN_OK;
}

quoin_status qn_look_packet(quoin_work *work, qn_packet *packet, unsigned want, qn_seen *out, uint64_t *met) {
  return look_packet(work, packet, packet->few, want, out, met);
}

quoin_status qn_look_tile(quoin_work *work, qn_packet *packet, unsigned want, quoin_spot *out, size_t stride) {
  qn_packet_hits hits;
  qn_look_run(work, packet, &hits);
  const uint64_t woven = hits.unsure | (hits.tied_surface ? hits.tied_surface & ~qn_alone_lanes(work->scene, packet, &hits, hits.tied_surface) : 0), found = hits.found & ~woven;
  _Alignas(64) double rounded[QN_LANES];
  const double *t = hits.t;
  uint64_t sure = found, known = 0;
  if (want & QN_LOOK_T && hits.found) {
    fetch_lines(work, &hits, hits.found);
    known = sure = work->wide->round(work->scene, packet, &hits, hits.found, rounded, &qn_scratch_counts(work->scratch)->exact_forms);
    t = rounded;
  }
  work->wide->spots(&hits, found, t, out, stride);
  quoin_status status = QUOIN_OK;
  for (uint64_t m = found & ~sure; QN_UNLIKELY(m) && status == QUOIN_OK; m &= m - 1) {
    unsigned lane = qn_trailing_zeros(m);
    status = qn_look_round(work, packet, &hits, lane, &out[qn_lane_row(lane) * stride + qn_lane_column(lane)].t);
  }
  for (uint64_t m = woven; QN_UNLIKELY(m) && status == QUOIN_OK; m &= m - 1) {
    unsigned lane = qn_trailing_zeros(m);
    qn_seen seen;
    status = hits.unsure >> lane & 1 ? qn_look_woven(work, packet, lane, want, &seen) : look_tied(work, packet, &hits, lane, want, known >> lane & 1 ? &rounded[lane] : NULL, &seen);
    out[qn_lane_row(lane) * stride + qn_lane_column(lane)] = qn_spot_of(&seen);
  }
  return status;
}

quoin_status qn_look_alone(quoin_work *work, const quoin_ray *ray, uint32_t on, unsigned want, qn_seen *out) {
  qn_packet p; /* only what the body for one reads is filled in */
  for (int k = 0; k < 3; k++) {
    p.o[k][0] = ray->o[k], p.d[k][0] = ray->d[k];
  }
  p.from[0] = ray->from, p.to[0] = ray->to;
  p.on[0] = on;
  p.live = 1, p.few = QN_ONE_LANE;
  p.new_origins = p.new_directions = 1, p.kept_ranges = 0, p.tile = QN_TILE_NONE, p.any = 0;
  uint64_t met;
  quoin_status status = look_packet(work, &p, QN_ONE_LANE, want, out, &met);
  if (!met) {
    *out = (qn_seen){.surface = QUOIN_NO_SURFACE};
  }
  return status;
}

quoin_status qn_look_woven_blocked(quoin_work *work, const quoin_ray *ray, uint8_t *blocked) {
  qn_query_begin(work);
  qn_line line;
  qn_line_from_doubles(ray->o, ray->d, &line);
  const qn_range range = {{.t = ray->from, .surface = QN_NO_SURFACE}, {.t = ray->to, .surface = QN_NO_SURFACE}};
  qn_woven woven;
  quoin_status status = qn_weave(work->scene, work->scratch, &line, &range, QN_WANT_FIRST, &woven);
  *blocked = status == QUOIN_OK && woven.inside_count > 0;
  return status == QUOIN_OK ? qn_scratch_ctx(work->scratch)->failed : status;
}
