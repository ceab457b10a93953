/* Rays in packets: 64 at a time through the wide body that this machine runs; a ray that it gives up is woven. */
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

quoin_status qn_look_woven(quoin_work *work, const qn_packet *packet, unsigned lane, unsigned want, qn_seen *out) {
  const quoin_scene *scene = work->scene;
  const quoin_ray ray = ray_of(packet, lane);
  *out = (qn_seen){.surface = QUOIN_NO_SURFACE};
  qn_query_begin(work);
  qn_line line;
  qn_line_from_doubles(ray.o, ray.d, &line);
  const qn_range range = {{.t = ray.from, .surface = QN_NO_SURFACE}, {.t = ray.to, .surface = QN_NO_SURFACE}};
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

quoin_status qn_look_round(quoin_work *work, const qn_packet *packet, const qn_packet_hits *hits, unsigned lane, double *t) {
  const quoin_ray ray = ray_of(packet, lane);
  qn_query_begin(work);
  qn_line line;
  qn_line_from_doubles(ray.o, ray.d, &line);
  const qn_place place = {.t = hits->t[lane], .e = hits->error[lane], .surface = hits->surface[lane], .which = (int)(hits->far_end >> lane & 1)};
  *t = qn_place_round(work->scene, work->scratch, &line, &place);
  return qn_scratch_ctx(work->scratch)->failed;
}

void qn_look_run(quoin_work *work, qn_packet *packet, qn_packet_hits *hits) {
  const quoin_scene *scene = work->scene;
  hits->found = hits->tied = 0, hits->unsure = packet->live;
  if (scene->normal.made) {
    qn_counts *counts = qn_scratch_counts(work->scratch);
    qn_wide_counts wide = {0};
    const qn_wide *body = work->wide;
    (packet->few == QN_MANY_LANES ? body->first : packet->few == QN_FEW_LANES ? body->few : body->one)(scene, packet, hits, &wide);
    counts->nodes += wide.nodes, counts->leaves += wide.leaves, counts->packets++;
    const unsigned lanes = ~packet->live ? (unsigned)__builtin_popcountll(packet->live) : QN_LANES, unsure = hits->unsure ? (unsigned)__builtin_popcountll(hits->unsure) : 0;
    counts->rays += lanes - unsure;
    counts->exact_rays += unsure;
  }
}

quoin_status qn_look_packet(quoin_work *work, qn_packet *packet, unsigned want, qn_seen out[QN_LANES], uint64_t *met) {
  qn_packet_hits hits;
  qn_look_run(work, packet, &hits);
  uint64_t woven = hits.unsure | (want & QN_LOOK_ANY ? 0 : hits.tied);
  *met = hits.found;
  for (uint64_t m = hits.found; m; m &= m - 1) {
    unsigned lane = qn_trailing_zeros(m);
    out[lane] = (qn_seen){hits.t[lane], hits.surface[lane], hits.leaf[lane], (uint8_t)(hits.leaving >> lane & 1)};
  }
  if (want & QN_LOOK_T) {
    _Alignas(64) double rounded[QN_LANES];
    uint64_t sure = work->wide->round(work->scene, packet, &hits, hits.found & ~woven, rounded, &qn_scratch_counts(work->scratch)->exact_forms);
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
    quoin_status status = qn_look_woven(work, packet, lane, want, &out[lane]);
    *met &= ~((uint64_t)1 << lane);
    *met |= (uint64_t)(out[lane].surface != QUOIN_NO_SURFACE) << lane;
    if (status != QUOIN_OK) {
      return status;
    }
  }
  return QUOIN_OK;
}

/* Whether directions are within some tens of degrees of the first one. Rays that are not are tens of times slower in a packet than alone. */
static int go_together(const quoin_ray *rays, size_t n) {
  const double *a = rays[0].d, square = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
  int together = 1;
  for (size_t i = 1; i < n; i++) {
    const double *b = rays[i].d, way = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    together &= way > 0 && way * way > 0.8 * (square * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]));
  }
  return together;
}

/* Puts rays into the first lanes of a packet and repeats the last in the others up to `lanes`. */
static void fill(qn_packet *p, size_t lanes, size_t n, const quoin_ray *rays, const uint32_t *on) {
  for (size_t lane = 0; lane < lanes; lane++) {
    size_t i = lane < n ? lane : n - 1;
    for (int k = 0; k < 3; k++) {
      p->o[k][lane] = rays[i].o[k], p->d[k][lane] = rays[i].d[k];
    }
    p->from[lane] = rays[i].from, p->to[lane] = rays[i].to;
    p->on[lane] = on ? on[i] : QUOIN_NO_SURFACE;
  }
  p->live = n == QN_LANES ? ~(uint64_t)0 : ((uint64_t)1 << n) - 1;
  p->few = n == 1 ? QN_ONE_LANE : lanes == QN_FEW ? QN_FEW_LANES : QN_MANY_LANES;
  p->new_origins = p->new_directions = 1, p->kept_ranges = 0;
  p->tile = QN_TILE_NONE;
}

int qn_rays_together(const quoin_ray *rays, size_t n) {
  return go_together(rays, n);
}
void qn_packet_fill(qn_packet *packet, size_t lanes, size_t n, const quoin_ray *rays) {
  fill(packet, lanes, n, rays, NULL);
}

static quoin_status look_together(quoin_work *work, qn_packet *packet, size_t lanes, size_t n, const quoin_ray *rays, const uint32_t *on, unsigned want, qn_seen *out) {
  qn_seen seen[QN_LANES];
  uint64_t met;
  fill(packet, lanes, n, rays, on);
  quoin_status status = qn_look_packet(work, packet, want, seen, &met);
  for (size_t i = 0; i < n; i++) {
    out[i] = met >> i & 1 ? seen[i] : (qn_seen){.surface = QUOIN_NO_SURFACE};
  }
  return status;
}

quoin_status qn_look(quoin_work *work, size_t n, const quoin_ray *rays, const uint32_t *on, unsigned want, qn_seen *out) {
  qn_packet packet;
  quoin_status status = QUOIN_OK;
  for (size_t run = 0; run < n && status == QUOIN_OK; run += QN_LANES) {
    size_t in_run = n - run < QN_LANES ? n - run : QN_LANES;
    if (in_run > 2 * QN_FEW && go_together(rays + run, in_run)) {
      status = look_together(work, &packet, QN_LANES, in_run, rays + run, on ? on + run : NULL, want, out + run);
      continue;
    }
    for (size_t at = run; at < run + in_run && status == QUOIN_OK;) { /* a few, or one by one */
      size_t count = run + in_run - at < QN_FEW ? run + in_run - at : QN_FEW, step = count;
      count = count > 1 && !go_together(rays + at, count) ? 1 : count;
      for (step += at; at < step && status == QUOIN_OK; at += count) {
        status = look_together(work, &packet, QN_FEW, count, rays + at, on ? on + at : NULL, want, out + at);
      }
    }
  }
  return status;
}

void qn_seen_normal(const quoin_scene *scene, const quoin_ray *ray, const qn_seen *seen, double normal[3]) {
  const qn_surface *s = &scene->surfaces[seen->surface];
  const qn_leaf *leaf = &scene->leaves[s->leaf];
  double y[3];
  for (int i = 0; i < 3; i++) {
    y[i] = (ray->o[i] - leaf->pivot[i]) + seen->t * ray->d[i];
  }
  qn_half_gradient(scene, &scene->halves[s->half], y, normal);
  double size = 0, way = 0;
  for (int i = 0; i < 3; i++) {
    size = fmax(size, fabs(normal[i]));
  }
  if (!(size > 0) || !isfinite(size)) {
    normal[0] = normal[1] = normal[2] = 0;
    return;
  }
  double square = 0;
  for (int i = 0; i < 3; i++) {
    normal[i] /= size;
    square += normal[i] * normal[i];
    way += normal[i] * ray->d[i];
  }
  double scale = ((way > 0) == (seen->leaving != 0) ? 1 : -1) / sqrt(square); /* out of the solid: with the ray where it leaves */
  for (int i = 0; i < 3; i++) {
    normal[i] *= scale;
  }
}
