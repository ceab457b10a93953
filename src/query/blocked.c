/* Whether rays are blocked, for arrays of them: those that neighbours in the array cannot share a packet with are sorted across their direction first.

   Shadow rays start where a camera's rays end: at any depth, and in places that are far apart seen from the light. Packets are made of neighbours across the
   direction, and each ray's start is moved back along it to where the first of its packet starts: the boxes that a packet may meet follow from its starts, and
   these then lie side by side. Moving rounds; docs/bounds.md, "Moved starts". A ray that wide code gives up is woven as it was given.

   Legend: the line is o + t d = o' + t' d with t' = t + s and o' = o - s d as rounded. */
#include "base/bounds.h"
#include "query/across.h"
#include "query/look.h"

#include <math.h>

enum { RUN = QN_ACROSS_MOST, FEWEST = 2 * QN_FEW };
/* How many times as wide as things are apart (work->apart) a packet may be: as rays of one direction or of several come; sorted; and from where on starts are moved. Measured on the scenes of tools/bench. */
enum { WIDE_AS_GIVEN = 2, WIDE_ANY_WAY = 3, WIDE_SORTED = 5, WIDE_AS_IS = 1 };

typedef struct asked {
  quoin_work *work;
  const quoin_ray *rays;
  const uint32_t *on; /* or null */
  uint8_t *blocked;
  qn_gathered seen;
  qn_packet packet;
  uint16_t rest[RUN]; /* rays that wait to be sorted; of one direction */
  size_t rest_count;
  qn_across_room room;
} asked;

/* A bit each to a byte each. */
static void put_bytes(unsigned bits, uint8_t out[8]) {
  for (unsigned k = 0; k < 8; k++) {
    out[k] = bits >> k & 1;
  }
}

/* The lanes of a tile's row, of its bits in the tile. */
static unsigned row_of(uint64_t lanes, unsigned row) {
  const unsigned x = (unsigned)(lanes >> qn_lane_of(0, row));
  return (x & 3) | (x >> 2 & 12) | (x >> 12 & 48) | (x >> 14 & 192);
}

static void set_lanes(asked *a, size_t first, const uint16_t *which, unsigned n) {
  qn_packet *p = &a->packet;
  p->live = n == QN_LANES ? ~(uint64_t)0 : 0;
  for (unsigned i = 0; i < n && (a->on || n < QN_LANES); i++) {
    const unsigned lane = which ? i : qn_lane_of(i & 7, i >> 3);
    p->live |= (uint64_t)1 << lane;
    p->on[lane] = a->on ? a->on[which ? which[i] : first + i] : QUOIN_NO_SURFACE;
  }
}

/* Runs the packet that has been gathered. */
static quoin_status run(asked *a, size_t first, const uint16_t *which, unsigned n) {
  qn_packet *p = &a->packet;
  set_lanes(a, first, which, n);
  p->new_directions = a->seen.new_ways, p->kept_ranges = !a->on && !a->seen.new_ranges;
  qn_packet_hits hits;
  qn_look_run(a->work, p, &hits);
  if (!which && n == QN_LANES) {
    for (unsigned row = 0; row < 8; row++) {
      put_bytes(row_of(hits.found, row), a->blocked + first + 8 * row);
    }
  } else {
    for (unsigned i = 0; i < n; i++) {
      a->blocked[which ? which[i] : first + i] = hits.found >> (which ? i : qn_lane_of(i & 7, i >> 3)) & 1;
    }
  }
  quoin_status status = QUOIN_OK;
  for (unsigned i = 0; QN_UNLIKELY(hits.unsure) && i < n && status == QUOIN_OK; i++) { /* alone its bounds are tighter */
    if (hits.unsure >> (which ? i : qn_lane_of(i & 7, i >> 3)) & 1) {
      const size_t ray = which ? which[i] : first + i;
      status = qn_look_blocked_in_order(a->work, 1, a->rays + ray, a->on ? a->on + ray : NULL, a->blocked + ray);
    }
  }
  return status;
}

/* Whether the packet is no wider than so many times what things are apart. */
static int narrow(const asked *a, int times) {
  const double *x = a->packet.d[0], *y = a->packet.d[1], *z = a->packet.d[2], most = times * a->work->apart;
  return a->seen.width2 <= most * most * (x[0] * x[0] + y[0] * y[0] + z[0] * z[0]);
}

static void move_starts(asked *a) {
  a->work->wide->move(&a->packet);
  a->seen.one_range = 0, a->seen.new_ranges = 1;
}

/* Sorted rays that pass too wide apart for one packet: neighbours among them may share smaller ones. */
static quoin_status in_order(asked *a, const uint16_t *which, unsigned n) {
  quoin_ray rays[QN_LANES];
  uint32_t on[QN_LANES];
  uint8_t blocked[QN_LANES];
  for (unsigned i = 0; i < n; i++) {
    rays[i] = a->rays[which[i]], on[i] = a->on ? a->on[which[i]] : QUOIN_NO_SURFACE;
  }
  quoin_status status = qn_look_blocked_in_order(a->work, n, rays, a->on ? on : NULL, blocked);
  for (unsigned i = 0; i < n && status == QUOIN_OK; i++) {
    a->blocked[which[i]] = blocked[i];
  }
  return status;
}

static quoin_status answer_rest(asked *a) {
  qn_sort_across(a->rays, a->rest_count, a->rest, &a->room);
  quoin_status status = QUOIN_OK;
  for (size_t at = 0; at < a->rest_count && status == QUOIN_OK;) {
    const unsigned n = a->rest_count - at < QN_LANES ? (unsigned)(a->rest_count - at) : QN_LANES;
    a->packet.tile = QN_TILE_NONE;
    a->work->wide->gather(a->rays, a->rest + at, n, &a->packet, &a->seen);
    if (n > FEWEST && narrow(a, WIDE_SORTED)) {
      move_starts(a);
      status = run(a, 0, a->rest + at, n);
    } else {
      a->seen.one_way = a->seen.one_range = 0;
      status = in_order(a, a->rest + at, n);
    }
    at += n;
  }
  a->rest_count = 0;
  return status;
}

static quoin_status answer(asked *a, size_t n) {
  quoin_status status = QUOIN_OK;
  a->rest_count = 0;
  for (size_t at = 0; at < n && status == QUOIN_OK; at += QN_LANES) {
    const unsigned count = n - at < QN_LANES ? (unsigned)(n - at) : QN_LANES;
    a->packet.tile = QN_TILE_NONE;
    a->work->wide->gather(a->rays + at, NULL, count, &a->packet, &a->seen);
    if (!a->seen.rays) {
      return QUOIN_E_ARGUMENT;
    }
    if (count > FEWEST && a->seen.together && narrow(a, a->seen.one_way ? WIDE_AS_GIVEN : WIDE_ANY_WAY)) {
      if (a->seen.one_way && !narrow(a, WIDE_AS_IS)) {
        move_starts(a);
      }
      status = run(a, at, NULL, count);
    } else if (a->seen.one_way && (a->rest_count == 0 || qn_same_way(&a->rays[a->rest[0]], &a->rays[at]))) {
      for (unsigned i = 0; i < count; i++) {
        a->rest[a->rest_count++] = (uint16_t)(at + i);
      }
      a->seen.one_way = a->seen.one_range = 0; /* the body has not seen this filling */
    } else {
      status = qn_look_blocked_in_order(a->work, count, a->rays + at, a->on ? a->on + at : NULL, a->blocked + at);
      a->seen.one_way = a->seen.one_range = 0;
    }
  }
  return status == QUOIN_OK && a->rest_count ? answer_rest(a) : status;
}

quoin_status qn_look_blocked(quoin_work *work, size_t n, const quoin_ray *rays, const uint32_t *on, uint8_t *blocked) {
  if (n <= FEWEST) {
    for (size_t i = 0; i < n; i++) {
      if (!qn_is_ray(&rays[i])) {
        return QUOIN_E_ARGUMENT;
      }
    }
    return qn_look_blocked_in_order(work, n, rays, on, blocked);
  }
  asked a;
  a.work = work;
  a.seen = (qn_gathered){0};
  a.packet.few = QN_MANY_LANES, a.packet.any = 1, a.packet.new_origins = 1;
  for (unsigned i = 0; i < QN_LANES; i++) {
    a.packet.on[i] = QUOIN_NO_SURFACE;
  }
  quoin_status status = QUOIN_OK;
  for (size_t at = 0; at < n && status == QUOIN_OK; at += RUN) {
    a.rays = rays + at, a.on = on ? on + at : NULL, a.blocked = blocked + at;
    status = answer(&a, n - at < RUN ? n - at : RUN);
  }
  return status;
}
