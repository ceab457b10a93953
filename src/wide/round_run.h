/* Rounding lanes that share a surface: each kind of surface has straight code of its own, with the terms that it has. Static code. */
#ifndef QN_WIDE_ROUND_RUN_H
#define QN_WIDE_ROUND_RUN_H

#include "wide/newton.h"
#include "wide/packet.h"

#define TERM(i) (1u << (i))
static const unsigned TERMS[QN_ROUNDING_KINDS] = {
  [QN_ROUNDING_AXIS] = TERM(6) | TERM(9),
  [QN_ROUNDING_PLANE] = TERM(6) | TERM(7) | TERM(8) | TERM(9),
  [QN_ROUNDING_ROUND] = TERM(0) | TERM(1) | TERM(6) | TERM(7) | TERM(9),
  [QN_ROUNDING_DIAGONAL] = TERM(0) | TERM(1) | TERM(2) | TERM(6) | TERM(7) | TERM(8) | TERM(9),
  [QN_ROUNDING_FULL] = TERM(10) - 1,
};
static const int AXES[QN_ROUNDING_KINDS] = {1, 3, 2, 3, 3};

/* Groups g to end - 1; kind and pairs are constants wherever this is called. */
QN_INLINE uint64_t run_of(qn_rounding_kind kind, int pairs, const qn_rounding *surface, const qn_packet *p, const qn_packet_hits *hits,
                          int g, int end, double *t) {
  const surface_numbers f = {{surface->k}, TERMS[kind], (1u << AXES[kind]) - 1, 1, pairs};
  const double *o[3], *d[3];
  uint64_t sure = 0;
  for (int j = 0; j < AXES[kind]; j++) {
    o[j] = p->o[surface->axis[j]], d[j] = p->d[surface->axis[j]];
  }
  for (int at = g * QN_W; at < end * QN_W; at += QN_W) {
    rough_places places = {.t = vload(hits->t + at), .e = vload(hits->error + at)};
    for (int j = 0; j < AXES[kind]; j++) {
      places.o[j] = vload(o[j] + at), places.d[j] = vload(d[j] + at);
      if (pairs) {
        places.olow[j] = vload(p->olow[surface->axis[j]] + at), places.dlow[j] = vload(p->dlow[surface->axis[j]] + at);
      }
    }
    vd out;
    sure |= (uint64_t)vbits(round_places(&f, &places, &out)) << at;
    vstore(t + at, out);
  }
  return sure;
}

/* pairs: the rays have low parts. */
QN_INLINE uint64_t run_of_kind(int pairs, const qn_rounding *surface, const qn_packet *p, const qn_packet_hits *hits, int g, int end, double *t) {
  switch ((qn_rounding_kind)surface->kind) {
  case QN_ROUNDING_AXIS: return run_of(QN_ROUNDING_AXIS, pairs, surface, p, hits, g, end, t);
  case QN_ROUNDING_PLANE: return run_of(QN_ROUNDING_PLANE, pairs, surface, p, hits, g, end, t);
  case QN_ROUNDING_ROUND: return run_of(QN_ROUNDING_ROUND, pairs, surface, p, hits, g, end, t);
  case QN_ROUNDING_DIAGONAL: return run_of(QN_ROUNDING_DIAGONAL, pairs, surface, p, hits, g, end, t);
  case QN_ROUNDING_FULL: return run_of(QN_ROUNDING_FULL, pairs, surface, p, hits, g, end, t);
  case QN_ROUNDING_NONE: break;
  }
  return 0;
}

static uint64_t round_run(const qn_rounding *surface, const qn_packet *p, const qn_packet_hits *hits, int g, int end, double *t) {
  return p->tile == QN_TILE_PAIRS ? run_of_kind(1, surface, p, hits, g, end, t) : run_of_kind(0, surface, p, hits, g, end, t);
}

#endif
