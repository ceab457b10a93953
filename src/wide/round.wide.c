/* The doubles nearest to the hits of a packet, compiled once for each instruction set. Neighbouring lanes mostly hit one surface, whose
   numbers are then the same in all lanes; a group of two surfaces is taken twice, and lanes of yet other surfaces are gathered by the
   kinds of these. Each kind has a body of its own, with the terms that it has. */
#include "wide/round_ball.h"
#include "wide/round_run.h"

enum { GROUPS = QN_LANES / QN_W };

/* --- lanes with surfaces of their own ------------------------------------------------------------------------------- */

/* Lanes whose surfaces are of one kind. */
typedef struct gathered {
  unsigned count;
  uint8_t lane[QN_LANES];
  const qn_rounding *surface[QN_LANES];
} gathered;

QN_INLINE uint64_t gathered_of(qn_rounding_kind kind, int pairs, const gathered *list, const qn_packet *p, const qn_packet_hits *hits, double *t) {
  surface_numbers f = {{NULL}, TERMS[kind], (1u << AXES[kind]) - 1, 0, pairs};
  uint64_t sure = 0;
  for (unsigned first = 0; first < list->count; first += QN_W) {
    const double *o[3][QN_W], *d[3][QN_W], *near[QN_W], *error[QN_W], *olow[3][QN_W], *dlow[3][QN_W];
    for (unsigned i = 0; i < QN_W; i++) {
      unsigned from = first + i < list->count ? first + i : first, lane = list->lane[from]; /* filled up with copies of the first */
      const qn_rounding *surface = list->surface[from];
      f.k[i] = surface->k;
      for (int j = 0; j < AXES[kind]; j++) {
        o[j][i] = &p->o[surface->axis[j]][lane], d[j][i] = &p->d[surface->axis[j]][lane];
        olow[j][i] = &p->olow[surface->axis[j]][lane], dlow[j][i] = &p->dlow[surface->axis[j]][lane];
      }
      near[i] = &hits->t[lane], error[i] = &hits->error[lane];
    }
    rough_places places = {.t = vcollect(near, 0), .e = vcollect(error, 0)};
    for (int j = 0; j < AXES[kind]; j++) {
      places.o[j] = vcollect(o[j], 0), places.d[j] = vcollect(d[j], 0);
      if (pairs) {
        places.olow[j] = vcollect(olow[j], 0), places.dlow[j] = vcollect(dlow[j], 0);
      }
    }
    vd rounded;
    _Alignas(64) double out[QN_W];
    unsigned bits = vbits(round_places(&f, &places, &rounded));
    vstore(out, rounded);
    for (unsigned i = 0; i < QN_W && first + i < list->count; i++) {
      unsigned lane = list->lane[first + i];
      t[lane] = out[i];
      sure |= (uint64_t)(bits >> i & 1) << lane;
    }
  }
  return sure;
}

QN_INLINE uint64_t gathered_of_kinds(int pairs, const gathered lists[QN_ROUNDING_KINDS], const qn_packet *p, const qn_packet_hits *hits, double *t) {
  return gathered_of(QN_ROUNDING_AXIS, pairs, &lists[QN_ROUNDING_AXIS], p, hits, t) |
         gathered_of(QN_ROUNDING_PLANE, pairs, &lists[QN_ROUNDING_PLANE], p, hits, t) |
         gathered_of(QN_ROUNDING_ROUND, pairs, &lists[QN_ROUNDING_ROUND], p, hits, t) |
         gathered_of(QN_ROUNDING_DIAGONAL, pairs, &lists[QN_ROUNDING_DIAGONAL], p, hits, t) |
         gathered_of(QN_ROUNDING_FULL, pairs, &lists[QN_ROUNDING_FULL], p, hits, t);
}

static uint64_t round_gathered(const gathered lists[QN_ROUNDING_KINDS], const qn_packet *p, const qn_packet_hits *hits, double *t) {
  return p->tile == QN_TILE_PAIRS ? gathered_of_kinds(1, lists, p, hits, t) : gathered_of_kinds(0, lists, p, hits, t);
}

/* --- lanes on spheres ------------------------------------------------------------------------------------------------ */

/* The lanes of a group, of those in `bits`, whose surface, or leaf, is this one. */
QN_INLINE unsigned lanes_on(const uint32_t *names, uint32_t name, unsigned bits) {
  unsigned on = 0;
  for (unsigned i = 0; i < QN_W; i++) {
    on |= (unsigned)(names[i] == name) << i;
  }
  return on & bits;
}

static unsigned round_group_of_balls(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, unsigned at, unsigned in, double *t) {
  const qn_piece_sphere *of[QN_W], *some = NULL;
  unsigned balls = 0;
  for (unsigned m = in; m; m &= m - 1) {
    const unsigned i = qn_trailing_zeros(m);
    of[i] = sphere_of_lane(scene, hits, at + i);
    some = of[i] ? of[i] : some, balls |= (unsigned)(of[i] != NULL) << i;
  }
  if (!balls) {
    return 0;
  }
  for (unsigned i = 0; i < QN_W; i++) {
    of[i] = balls >> i & 1 ? of[i] : some;
  }
  const ball b = ball_of_each(packet, of);
  return ball_round_lanes(packet, hits, &b, at, t) & balls;
}

/* A tile that is all on one leaf, as most of a large one's are. */
static int all_on_one(const uint32_t leaves[QN_LANES]) {
  uint32_t differ = 0;
  for (int i = 1; i < QN_LANES; i++) {
    differ |= leaves[i] ^ leaves[0];
  }
  return !differ;
}

static uint64_t round_balls(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes, double *t) {
  const qn_piece_sphere *last = NULL;
  uint32_t leaf = UINT32_MAX;
  uint64_t sure = 0;
  ball b;
  if (!~lanes && all_on_one(hits->leaf)) {
    last = sphere_of_lane(scene, hits, 0);
    if (last) {
      b = ball_of_one(packet, last);
      for (unsigned at = 0; at < QN_LANES; at += QN_W) {
        sure |= (uint64_t)ball_round_lanes(packet, hits, &b, at, t) << at;
      }
    }
    return sure;
  }
  for (uint64_t m = lanes; m;) {
    const unsigned first = qn_trailing_zeros(m), at = first / QN_W * QN_W, in = (unsigned)(m >> at) & QN_ALL_BITS;
    m &= ~((uint64_t)QN_ALL_BITS << at);
    unsigned on;
    if (lanes_on(hits->leaf + at, hits->leaf[first], in) != in) {
      on = round_group_of_balls(scene, packet, hits, at, in, t);
    } else {
      if (hits->leaf[first] != leaf) {
        leaf = hits->leaf[first];
        if ((last = sphere_of_lane(scene, hits, first)) != NULL) {
          b = ball_of_one(packet, last);
        }
      }
      on = last ? ball_round_lanes(packet, hits, &b, at, t) & in : 0;
    }
    sure |= (uint64_t)on << at;
  }
  return sure;
}

/* --- a packet -------------------------------------------------------------------------------------------------------- */

/* A group's second surface. */
typedef struct second_surface {
  const qn_rounding *surface;
  int group;
  unsigned bits;
} second_surface;

static uint64_t round_by_surfaces(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes, double t[QN_LANES],
                                  uint64_t *made) {
  uint64_t sure = 0, first_lanes = 0;
  const qn_rounding *shared[GROUPS + 1] = {NULL};
  second_surface seconds[GROUPS];
  gathered lists[QN_ROUNDING_KINDS];
  int second_count = 0, mixed = 0;
  for (int g = 0; g < GROUPS; g++) {
    unsigned bits = (unsigned)(lanes >> (g * QN_W)) & QN_ALL_BITS;
    if (!bits) {
      continue;
    }
    const uint32_t *surfaces = hits->surface + g * QN_W;
    uint32_t surface = surfaces[qn_trailing_zeros(bits)];
    unsigned on = lanes_on(surfaces, surface, bits);
    shared[g] = qn_scene_rounding(scene, surface, made);
    first_lanes |= (uint64_t)on << (g * QN_W);
    if (QN_LIKELY(!(bits &= ~on))) {
      continue;
    }
    surface = surfaces[qn_trailing_zeros(bits)];
    on = lanes_on(surfaces, surface, bits);
    const qn_rounding *second = qn_scene_rounding(scene, surface, made);
    if (second) {
      seconds[second_count++] = (second_surface){second, g, on};
    }
    for (bits &= ~on; bits; bits &= bits - 1) {
      unsigned i = qn_trailing_zeros(bits);
      const qn_rounding *own = qn_scene_rounding(scene, surfaces[i], made);
      if (!own || own->kind == QN_ROUNDING_NONE) {
        continue;
      }
      for (int k = 0; !mixed && k < QN_ROUNDING_KINDS; k++) {
        lists[k].count = 0;
      }
      mixed = 1;
      gathered *list = &lists[own->kind];
      list->lane[list->count] = (uint8_t)((unsigned)g * QN_W + i);
      list->surface[list->count++] = own;
    }
  }
  for (int g = 0, end; g < GROUPS; g = end) {
    end = g + 1;
    if (shared[g]) {
      while (shared[end] == shared[g]) { /* the last one is null */
        end++;
      }
      sure |= round_run(shared[g], packet, hits, g, end, t);
    }
  }
  sure &= first_lanes;
  for (int i = 0; i < second_count; i++) {
    const second_surface *s = &seconds[i];
    _Alignas(64) double own[QN_LANES];
    uint64_t on = round_run(s->surface, packet, hits, s->group, s->group + 1, own) & (uint64_t)s->bits << (s->group * QN_W);
    sure |= on;
    for (; on; on &= on - 1) {
      unsigned lane = qn_trailing_zeros(on);
      t[lane] = own[lane];
    }
  }
  return mixed ? sure | round_gathered(lists, packet, hits, t) : sure;
}

uint64_t QN_OF_ISA(qn_round)(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes,
                             double t[QN_LANES], uint64_t *made);
uint64_t QN_OF_ISA(qn_round)(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes,
                             double t[QN_LANES], uint64_t *made) {
  const uint64_t balls = packet->tile != QN_TILE_PAIRS ? round_balls(scene, packet, hits, lanes, t) : 0;
  if (balls == lanes || !balls) {
    return balls ? balls : round_by_surfaces(scene, packet, hits, lanes, t, made);
  }
  _Alignas(64) double own[QN_LANES];
  const uint64_t others = round_by_surfaces(scene, packet, hits, lanes & ~balls, own, made);
  for (uint64_t m = others; m; m &= m - 1) {
    const unsigned lane = qn_trailing_zeros(m);
    t[lane] = own[lane];
  }
  return balls | others;
}
