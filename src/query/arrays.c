/* Arrays of rays: which of them share a packet. */
#include "query/look.h"

#include <string.h>

/* Whether directions are within some tens of degrees of the first one. Rays that are not are tens of times slower in a packet than alone. */
static int go_together(const quoin_ray *rays, size_t n) {
  const double *a = rays[0].d, square = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
  int together = 1;
  for (size_t i = 1; i < n && together; i++) {
    const double *b = rays[i].d, way = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    together = way > 0 && way * way > 0.8 * (square * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]));
  }
  return together;
}

/* How far apart the lines are at most, across the first one's direction, times its square's length; about: it decides only what is faster. */
static double width2(const quoin_ray *rays, size_t n) {
  const double *d = rays[0].d, *o = rays[0].o;
  double most = 0;
  for (size_t i = 1; i < n; i++) {
    const double x = rays[i].o[0] - o[0], y = rays[i].o[1] - o[1], z = rays[i].o[2] - o[2];
    const double u = y * d[2] - z * d[1], v = z * d[0] - x * d[2], w = x * d[1] - y * d[0], e = u * u + v * v + w * w;
    most = e > most ? e : most;
  }
  return most;
}

/* The next rays of an array to be answered together: `count` from `at`, in packets of `lanes` lanes: QN_LANES, QN_FEW or 1. A packet meets what any of its rays
   meets: it pays while it is not much wider than things are apart (measured: three times for 64 rays, not once for 8). */
typedef struct batch {
  quoin_work *work;
  const quoin_ray *rays;
  size_t n, at, count, run; /* run: the end of the rays that were tried as 64 */
  unsigned lanes, last;     /* last: the lanes of the packet before */
} batch;

/* Whether a few rays from `at` on, *count of them, share a packet. */
static int few_together(const batch *b, size_t at, size_t *count) {
  const quoin_ray *rays = b->rays + at;
  const double *d = rays[0].d, apart2 = b->work->apart * b->work->apart * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  *count = b->run - at < QN_FEW ? b->run - at : QN_FEW;
  return *count > 1 && go_together(rays, *count) && width2(rays, *count) <= apart2 / 2;
}

static int next_batch(batch *b) {
  b->last = b->lanes;
  b->at += b->count;
  if (b->at >= b->n) {
    return 0;
  }
  const quoin_ray *rays = b->rays + b->at;
  const double *d = rays[0].d, apart2 = b->work->apart * b->work->apart * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  if (b->at >= b->run) {
    b->count = b->n - b->at < QN_LANES ? b->n - b->at : QN_LANES;
    b->run = b->at + b->count;
    b->lanes = QN_LANES;
    if (b->count > 2 * QN_FEW && go_together(rays, b->count) && width2(rays, b->count) <= 9 * apart2) {
      return 1;
    }
  }
  b->lanes = few_together(b, b->at, &b->count) ? QN_FEW : 1;
  for (size_t more; b->lanes == 1 && b->work->takes_turns && b->at + b->count < b->run && !few_together(b, b->at + b->count, &more);) {
    b->count += more;
  }
  return 1;
}

static int are_rays(const batch *b) {
  int all = 1;
  for (size_t i = b->at; i < b->at + b->count && all; i++) {
    all = qn_is_ray(&b->rays[i]);
  }
  return all;
}

/* Whether rays that go one by one are walked several at a time (wide/packet.h, QN_EACH_LANE). */
static int in_turns(const batch *b) { return b->lanes == 1 && b->count > 1 && b->work->takes_turns; }

/* Where ray i of a run goes: into lane i; or as an 8 by 8 tile, row after row. */
typedef enum order { IN_ORDER, AS_TILE } order;
QN_INLINE unsigned lane_for(order way, unsigned i) {
  if (way == IN_ORDER) {
    return i;
  }
  unsigned c = i & 7, r = i >> 3 & 7;
  return (c & 1) | (r & 1) << 1 | (c & 2) << 1 | (r & 2) << 2 | (c & 4) << 2 | (r & 4) << 3;
}

/* Puts rays into the first lanes of a packet and repeats the last in the others up to `lanes`. kept: the packet has been through its body with as many lanes. */
static void fill(qn_packet *p, order way, unsigned lanes, unsigned n, const quoin_ray *rays, const uint32_t *on, int kept) {
  int new_directions = !kept;
  uint64_t live = 0;
  for (unsigned i = 0; i < lanes; i++) {
    const unsigned lane = lane_for(way, i), from = i < n ? i : n - 1;
    const quoin_ray *ray = &rays[from];
    for (int k = 0; k < 3; k++) {
      new_directions |= kept && p->d[k][lane] != ray->d[k]; /* a zero's sign counts for nothing */
      p->o[k][lane] = ray->o[k], p->d[k][lane] = ray->d[k];
    }
    p->from[lane] = ray->from, p->to[lane] = ray->to;
    p->on[lane] = on ? on[from] : QUOIN_NO_SURFACE;
    live |= (uint64_t)(i < n) << lane;
  }
  p->live = live;
  p->few = lanes == 1 ? QN_ONE_LANE : lanes == QN_FEW ? QN_FEW_LANES : QN_MANY_LANES;
  p->new_origins = 1, p->new_directions = new_directions, p->kept_ranges = 0;
  p->tile = QN_TILE_NONE;
  p->any = 0;
}

/* n rays that go each by itself; rounding takes eight lanes at a time. */
static void fill_each(qn_packet *p, unsigned n, const quoin_ray *rays, const uint32_t *on) {
  fill(p, IN_ORDER, (n + QN_FEW - 1) / QN_FEW * QN_FEW, n, rays, on, 0);
  p->few = QN_EACH_LANE;
}

int qn_rays_together(const quoin_ray *rays, size_t n) {
  return go_together(rays, n);
}
void qn_packet_fill(qn_packet *packet, size_t lanes, size_t n, const quoin_ray *rays, double (*low)[6]) {
  fill(packet, IN_ORDER, (unsigned)lanes, (unsigned)n, rays, NULL, 0);
  packet->tile = low ? QN_TILE_PAIRS : QN_TILE_NONE;
  for (size_t lane = 0; low && lane < lanes; lane++) {
    const double *v = low[lane < n ? lane : n - 1];
    for (int k = 0; k < 3; k++) {
      packet->olow[k][lane] = v[k], packet->dlow[k][lane] = v[3 + k];
    }
  }
}

void qn_packet_move(qn_packet *packet, size_t lanes, size_t n, const quoin_ray *rays, double (*low)[6]) {
  packet->live = 0;
  for (size_t lane = 0; lane < lanes; lane++) {
    const size_t from = lane < n ? lane : n - 1;
    for (int k = 0; k < 3; k++) {
      packet->o[k][lane] = rays[from].o[k], packet->olow[k][lane] = low[from][k];
    }
    packet->live |= (uint64_t)(lane < n) << lane;
  }
  packet->new_origins = 1, packet->new_directions = 0, packet->kept_ranges = 1;
}

static quoin_status look_together(const batch *b, qn_packet *packet, const uint32_t *on, unsigned want, qn_seen out[QN_LANES]) {
  const quoin_ray *rays = b->rays + b->at;
  uint64_t met;
  on = on ? on + b->at : NULL;
  if (b->lanes == 1) {
    fill_each(packet, (unsigned)b->count, rays, on);
  } else {
    fill(packet, IN_ORDER, b->lanes, (unsigned)b->count, rays, on, 0);
  }
  quoin_status status = qn_look_packet(b->work, packet, want, out, &met);
  for (size_t i = 0; i < b->count; i++) {
    out[i] = met >> i & 1 ? out[i] : (qn_seen){.surface = QUOIN_NO_SURFACE};
  }
  return status;
}

/* Rays that go one by one. */
static quoin_status look_apart(const batch *b, const uint32_t *on, unsigned want, qn_seen_fn each, void *user) {
  quoin_status status = QUOIN_OK;
  for (size_t at = b->at; at < b->at + b->count && status == QUOIN_OK; at++) {
    qn_seen seen;
    status = qn_is_ray(&b->rays[at]) ? qn_look_alone(b->work, &b->rays[at], on ? on[at] : QUOIN_NO_SURFACE, want, &seen) : QUOIN_E_ARGUMENT;
    status = status == QUOIN_OK ? each(user, at, &seen) : status;
  }
  return status;
}

quoin_status qn_look(quoin_work *work, size_t n, const quoin_ray *rays, const uint32_t *on, unsigned want, qn_seen_fn each, void *user) {
  qn_packet packet;
  qn_seen seen[QN_LANES];
  quoin_status status = QUOIN_OK;
  batch b = {.work = work, .rays = rays, .n = n};
  while (status == QUOIN_OK && next_batch(&b)) {
    if (b.lanes == 1 && !in_turns(&b)) {
      status = look_apart(&b, on, want, each, user);
      continue;
    }
    status = are_rays(&b) ? look_together(&b, &packet, on, want, seen) : QUOIN_E_ARGUMENT;
    for (size_t i = 0; i < b.count && status == QUOIN_OK; i++) {
      status = each(user, b.at + i, &seen[i]);
    }
  }
  return status;
}

/* A packet that is no tile of 64. */
static quoin_status look_rest(quoin_work *work, qn_packet *packet, unsigned want, unsigned n, quoin_spot *out) {
  qn_seen seen[QN_LANES];
  uint64_t met = 0;
  quoin_status status = qn_look_packet(work, packet, want | QN_LOOK_SURFACE, seen, &met);
  for (unsigned i = 0; i < n; i++) {
    out[i] = met >> i & 1 ? qn_spot_of(&seen[i]) : (quoin_spot){.surface = QUOIN_NO_SURFACE};
  }
  return status;
}

/* Rays that go one by one. */
static quoin_status spots_apart(const batch *b, unsigned want, quoin_spot *out) {
  quoin_status status = QUOIN_OK;
  for (size_t at = b->at; at < b->at + b->count && status == QUOIN_OK; at++) {
    qn_seen seen;
    status = qn_is_ray(&b->rays[at]) ? qn_look_alone(b->work, &b->rays[at], QUOIN_NO_SURFACE, want | QN_LOOK_SURFACE, &seen) : QUOIN_E_ARGUMENT;
    if (status == QUOIN_OK) {
      out[at] = qn_spot_of(&seen);
    }
  }
  return status;
}

static quoin_status spots_together(const batch *b, qn_packet *packet, unsigned want, quoin_spot *out) {
  const quoin_ray *rays = b->rays + b->at;
  const unsigned n = (unsigned)b->count;
  if (b->lanes == QN_LANES) {
    quoin_spot part[QN_LANES];
    const int whole = n == QN_LANES;
    fill(packet, AS_TILE, QN_LANES, n, rays, NULL, b->lanes == b->last);
    quoin_status status = qn_look_tile(b->work, packet, want, whole ? out : part, 8);
    if (!whole) {
      memcpy(out, part, n * sizeof *out);
    }
    return status;
  }
  if (b->lanes == QN_FEW) {
    fill(packet, IN_ORDER, QN_FEW, n, rays, NULL, b->lanes == b->last);
  } else {
    fill_each(packet, n, rays, NULL);
  }
  return look_rest(b->work, packet, want, n, out);
}

quoin_status qn_look_spots(quoin_work *work, size_t n, const quoin_ray *rays, unsigned want, quoin_spot *out) {
  qn_packet packet;
  quoin_status status = QUOIN_OK;
  batch b = {.work = work, .rays = rays, .n = n};
  while (status == QUOIN_OK && next_batch(&b)) {
    if (b.lanes == 1 && !in_turns(&b)) {
      status = spots_apart(&b, want, out);
    } else {
      status = are_rays(&b) ? spots_together(&b, &packet, want, out + b.at) : QUOIN_E_ARGUMENT;
    }
  }
  return status;
}

quoin_status qn_look_blocked_in_order(quoin_work *work, size_t n, const quoin_ray *rays, const uint32_t *on, uint8_t *blocked) {
  qn_packet packet;
  quoin_status status = QUOIN_OK;
  batch b = {.work = work, .rays = rays, .n = n};
  while (status == QUOIN_OK && next_batch(&b)) {
    const unsigned step = b.lanes == 1 && !in_turns(&b) ? 1 : (unsigned)b.count;
    const order way = b.lanes == QN_LANES ? AS_TILE : IN_ORDER;
    for (size_t at = b.at; at < b.at + b.count; at += step) {
      qn_packet_hits hits;
      const uint32_t *starts = on ? on + at : NULL;
      if (b.lanes == 1 && step > 1) {
        fill_each(&packet, step, rays + at, starts);
      } else {
        fill(&packet, way, b.lanes, step, rays + at, starts, b.lanes == b.last || at != b.at);
      }
      packet.any = 1;
      qn_look_run(work, &packet, &hits);
      for (unsigned i = 0; i < step; i++) {
        const unsigned lane = lane_for(way, i);
        blocked[at + i] = hits.found >> lane & 1;
        if (QN_UNLIKELY(hits.unsure >> lane & 1) && status == QUOIN_OK) {
          status = qn_look_woven_blocked(work, &rays[at + i], &blocked[at + i]);
        }
      }
    }
  }
  return status;
}
