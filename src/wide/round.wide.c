/* The doubles nearest to the hits of a packet, compiled once for each instruction set. Neighbouring lanes mostly hit one surface, whose
   numbers are then the same in all lanes; lanes of mixed groups are gathered, by the kinds of their surfaces. Each kind has a body of
   its own, with the terms that it has. */
#include "wide/newton.h"
#include "wide/packet.h"

enum { GROUPS = QN_LANES / QN_W };

#define TERM(i) (1u << (i))
static const unsigned TERMS[QN_ROUNDING_KINDS] = {
  [QN_ROUNDING_AXIS] = TERM(6) | TERM(9),
  [QN_ROUNDING_PLANE] = TERM(6) | TERM(7) | TERM(8) | TERM(9),
  [QN_ROUNDING_ROUND] = TERM(0) | TERM(1) | TERM(6) | TERM(7) | TERM(9),
  [QN_ROUNDING_DIAGONAL] = TERM(0) | TERM(1) | TERM(2) | TERM(6) | TERM(7) | TERM(8) | TERM(9),
  [QN_ROUNDING_FULL] = TERM(10) - 1,
};
static const int AXES[QN_ROUNDING_KINDS] = {1, 3, 2, 3, 3};

/* --- groups that share a surface ------------------------------------------------------------------------------------ */

/* Groups g to end - 1; kind is a constant wherever this is called. */
QN_INLINE uint64_t run_of(qn_rounding_kind kind, const qn_rounding *surface, const qn_packet *p, const qn_packet_hits *hits, int g, int end, double *t) {
  const surface_numbers f = {surface->k, TERMS[kind], (1u << AXES[kind]) - 1, 1};
  const double *o[3], *d[3];
  uint64_t sure = 0;
  for (int j = 0; j < AXES[kind]; j++) {
    o[j] = p->o[surface->axis[j]], d[j] = p->d[surface->axis[j]];
  }
  for (int at = g * QN_W; at < end * QN_W; at += QN_W) {
    rough_places places = {.t = vload(hits->t + at), .e = vload(hits->error + at)};
    for (int j = 0; j < AXES[kind]; j++) {
      places.o[j] = vload(o[j] + at), places.d[j] = vload(d[j] + at);
    }
    vd out;
    sure |= (uint64_t)vbits(round_places(&f, &places, &out)) << at;
    vstore(t + at, out);
  }
  return sure;
}

static uint64_t round_run(const qn_rounding *surface, const qn_packet *p, const qn_packet_hits *hits, int g, int end, double *t) {
  switch ((qn_rounding_kind)surface->kind) {
  case QN_ROUNDING_AXIS: return run_of(QN_ROUNDING_AXIS, surface, p, hits, g, end, t);
  case QN_ROUNDING_PLANE: return run_of(QN_ROUNDING_PLANE, surface, p, hits, g, end, t);
  case QN_ROUNDING_ROUND: return run_of(QN_ROUNDING_ROUND, surface, p, hits, g, end, t);
  case QN_ROUNDING_DIAGONAL: return run_of(QN_ROUNDING_DIAGONAL, surface, p, hits, g, end, t);
  case QN_ROUNDING_FULL: return run_of(QN_ROUNDING_FULL, surface, p, hits, g, end, t);
  case QN_ROUNDING_NONE: break;
  }
  return 0;
}

/* --- lanes with surfaces of their own ------------------------------------------------------------------------------- */

/* Lanes whose surfaces are of one kind. */
typedef struct gathered {
  unsigned count;
  uint8_t lane[QN_LANES];
  const qn_rounding *surface[QN_LANES];
} gathered;

QN_INLINE uint64_t gathered_of(qn_rounding_kind kind, const gathered *list, const qn_packet *p, const qn_packet_hits *hits, double *t) {
  _Alignas(64) double k[QN_ROUNDING_NUMBERS * QN_W], o[3][QN_W], d[3][QN_W], near[QN_W], error[QN_W], out[QN_W];
  const surface_numbers f = {k, TERMS[kind], (1u << AXES[kind]) - 1, 0};
  uint64_t sure = 0;
  for (unsigned first = 0; first < list->count; first += QN_W) {
    for (unsigned i = 0; i < QN_W; i++) {
      unsigned from = first + i < list->count ? first + i : first, lane = list->lane[from]; /* filled up with copies of the first */
      const qn_rounding *surface = list->surface[from];
      for (unsigned n = 0; n < 10; n++) {
        if (TERMS[kind] >> n & 1) {
          k[(QN_ROUNDING_HI + n) * QN_W + i] = surface->k[QN_ROUNDING_HI + n];
          k[(QN_ROUNDING_LO + n) * QN_W + i] = surface->k[QN_ROUNDING_LO + n];
        }
      }
      for (unsigned n = QN_ROUNDING_SQUARE; n <= QN_ROUNDING_CONSTANT; n++) {
        k[n * QN_W + i] = surface->k[n];
      }
      for (int j = 0; j < AXES[kind]; j++) {
        k[(QN_ROUNDING_PIVOT + j) * QN_W + (int)i] = surface->k[QN_ROUNDING_PIVOT + j];
        o[j][i] = p->o[surface->axis[j]][lane], d[j][i] = p->d[surface->axis[j]][lane];
      }
      near[i] = hits->t[lane], error[i] = hits->error[lane];
    }
    rough_places places = {.t = vload(near), .e = vload(error)};
    for (int j = 0; j < AXES[kind]; j++) {
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

static uint64_t round_gathered(const gathered lists[QN_ROUNDING_KINDS], const qn_packet *p, const qn_packet_hits *hits, double *t) {
  return gathered_of(QN_ROUNDING_AXIS, &lists[QN_ROUNDING_AXIS], p, hits, t) | gathered_of(QN_ROUNDING_PLANE, &lists[QN_ROUNDING_PLANE], p, hits, t) |
         gathered_of(QN_ROUNDING_ROUND, &lists[QN_ROUNDING_ROUND], p, hits, t) |
         gathered_of(QN_ROUNDING_DIAGONAL, &lists[QN_ROUNDING_DIAGONAL], p, hits, t) | gathered_of(QN_ROUNDING_FULL, &lists[QN_ROUNDING_FULL], p, hits, t);
}

/* --- a packet -------------------------------------------------------------------------------------------------------- */

uint64_t QN_OF_ISA(qn_round)(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes, double t[QN_LANES],
                             uint64_t *made);
uint64_t QN_OF_ISA(qn_round)(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes, double t[QN_LANES],
                             uint64_t *made) {
  uint64_t sure = 0;
  const qn_rounding *shared[GROUPS + 1] = {NULL};
  gathered lists[QN_ROUNDING_KINDS];
  int mixed = 0;
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
      shared[g] = qn_scene_rounding(scene, one, made);
      continue;
    }
    for (int i = 0; !mixed && i < QN_ROUNDING_KINDS; i++) {
      lists[i].count = 0;
    }
    mixed = 1;
    for (; bits; bits &= bits - 1) {
      unsigned i = qn_trailing_zeros(bits);
      const qn_rounding *own = qn_scene_rounding(scene, surface[i], made);
      if (own && own->kind != QN_ROUNDING_NONE) {
        gathered *list = &lists[own->kind];
        list->lane[list->count] = (uint8_t)((unsigned)g * QN_W + i);
        list->surface[list->count++] = own;
      }
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
  sure &= lanes;
  return mixed ? sure | (round_gathered(lists, packet, hits, t) & lanes) : sure;
}
