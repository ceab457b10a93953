/* The doubles nearest to the hits of a packet, compiled once for each instruction set. Neighbouring lanes mostly hit one surface: its
   numbers are then the same in all lanes; the lanes of mixed groups are gathered, planes apart from quadrics. */
#include "wide/newton.h"
#include "wide/packet.h"

enum { GROUPS = QN_LANES / QN_W };

/* Lanes of mixed groups, all on planes or all on quadrics. */
typedef struct gathered {
  unsigned count;
  uint8_t lane[QN_LANES];
  const qn_rounding *surface[QN_LANES];
} gathered;

static uint64_t round_group(const qn_rounding *surface, const qn_packet *p, const qn_packet_hits *hits, int g, double *t) {
  const surface_numbers f = {surface->k, surface->terms, surface->axes, 1};
  int at = g * QN_W;
  rough_places places = {.t = vload(hits->t + at), .e = vload(hits->error + at)};
  for (int j = 0; j < 3; j++) {
    places.o[j] = vload(p->o[j] + at), places.d[j] = vload(p->d[j] + at);
  }
  vd out;
  unsigned sure = vbits(round_places(&f, &places, &out));
  vstore(t + at, out);
  return (uint64_t)sure << at;
}

static uint64_t round_gathered(const gathered *list, const qn_packet *p, const qn_packet_hits *hits, double *t) {
  uint64_t sure = 0;
  for (unsigned first = 0; first < list->count; first += QN_W) {
    _Alignas(64) double k[QN_ROUNDING_NUMBERS * QN_W], o[3][QN_W], d[3][QN_W], near[QN_W], error[QN_W], out[QN_W];
    surface_numbers f = {k, 0, 0, 0};
    for (unsigned i = 0; i < QN_W; i++) {
      unsigned from = first + i < list->count ? first + i : first, lane = list->lane[from]; /* filled up with copies of the first */
      const qn_rounding *surface = list->surface[from];
      f.terms |= surface->terms, f.axes |= surface->axes;
      for (unsigned n = 0; n < QN_ROUNDING_NUMBERS; n++) {
        k[n * QN_W + i] = surface->k[n];
      }
      for (int j = 0; j < 3; j++) {
        o[j][i] = p->o[j][lane], d[j][i] = p->d[j][lane];
      }
      near[i] = hits->t[lane], error[i] = hits->error[lane];
    }
    rough_places places = {.t = vload(near), .e = vload(error)};
    for (int j = 0; j < 3; j++) {
      places.o[j] = vload(o[j]), places.d[j] = vload(d[j]);
    }
    vd rounded;
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

uint64_t QN_OF_ISA(qn_round)(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes, double t[QN_LANES],
                             uint64_t *made);
uint64_t QN_OF_ISA(qn_round)(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes, double t[QN_LANES],
                             uint64_t *made) {
  uint64_t sure = 0;
  gathered lists[2]; /* planes, quadrics */
  lists[0].count = lists[1].count = 0;
  for (int g = 0; g < GROUPS; g++) {
    unsigned bits = (unsigned)(lanes >> (g * QN_W)) & QN_ALL_BITS, differ = 0;
    if (!bits) {
      continue;
    }
    const uint32_t *surface = hits->surface + g * QN_W;
    uint32_t one = surface[qn_trailing_zeros(bits)];
    for (unsigned i = 0; i < QN_W; i++) {
      differ |= (unsigned)(surface[i] != one) << i;
    }
    if (!(differ & bits)) {
      const qn_rounding *shared = qn_scene_rounding(scene, one, made);
      if (shared && shared->sound) {
        sure |= round_group(shared, packet, hits, g, t) & (uint64_t)bits << (g * QN_W);
      }
      continue;
    }
    for (; bits; bits &= bits - 1) {
      unsigned i = qn_trailing_zeros(bits);
      const qn_rounding *own = qn_scene_rounding(scene, surface[i], made);
      if (own && own->sound) {
        gathered *list = &lists[(own->terms & 63) != 0];
        list->lane[list->count] = (uint8_t)((unsigned)g * QN_W + i);
        list->surface[list->count++] = own;
      }
    }
  }
  for (int i = 0; i < 2; i++) {
    sure |= round_gathered(&lists[i], packet, hits, t);
  }
  return sure;
}
