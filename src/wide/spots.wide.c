/* A tile's answers as spots, row by row: two columns of a row are neighbours both in the tile's lanes and in memory. */
#include "wide/packet.h"
#include "wide/vec.h"

#include <string.h>

_Static_assert(sizeof(quoin_spot) == 16 && sizeof(double) == 8, "a spot is its parameter and one more word");

QN_INLINE double word_of(uint32_t surface, uint32_t leaving) {
  const quoin_spot spot = {0, surface, leaving};
  double word;
  memcpy(&word, (const char *)&spot + sizeof spot.t, sizeof word);
  return word;
}

/* Lanes of two columns and two rows (of twice as many columns, where a vector has eight) from a column and a row on, those at `at` first. whole: all are met, none
   is left there. */
QN_INLINE void block(const qn_packet_hits *hits, uint64_t met, const double *t, int whole, unsigned column, unsigned at, quoin_spot *row, size_t stride) {
  const vd none = vset(word_of(QUOIN_NO_SURFACE, 0)), leaving = vset(word_of(0, 1)), zero = vset(0);
  for (unsigned half = 0; half < 4; half += QN_W) {
    const unsigned lane = at + half;
    vd place = vload(t + lane), word = vwords(hits->surface + lane);
    if (!whole) {
      const vm m = vmask((unsigned)(met >> lane) & QN_ALL_BITS), left = vmask((unsigned)(hits->leaving >> lane) & QN_ALL_BITS);
      place = vpick(m, place, zero);
      word = vbitor(vpick(m, word, none), vpick(vand(m, left), leaving, zero));
    }
    /* cppcheck-suppress duplicateValueTernary ; for two lanes both are 1 */
    double *to[QN_W > 2 ? QN_W / 2 : 1];
    /* cppcheck-suppress duplicateValueTernary ; as above */
    for (unsigned k = 0; k < (QN_W > 2 ? QN_W / 2 : 1); k++) {
      const unsigned pair = half / 2 + k;
      to[k] = (double *)(void *)(row + (pair & 1) * stride + column + (pair & 2));
    }
    vweave(place, word, to);
  }
}

QN_INLINE void rows(const qn_packet_hits *hits, uint64_t met, const double *t, int whole, quoin_spot *out, size_t stride) {
  for (unsigned y = 0; y < 8; y += 2) {
    const unsigned at = qn_lane_of(0, y);
    quoin_spot *row = out + y * stride;
    block(hits, met, t, whole, 0, at, row, stride);
    if (QN_W <= 4) {
      block(hits, met, t, whole, 2, at + qn_lane_of(2, 0), row, stride);
    }
    block(hits, met, t, whole, 4, at + qn_lane_of(4, 0), row, stride);
    if (QN_W <= 4) {
      block(hits, met, t, whole, 6, at + qn_lane_of(6, 0), row, stride);
    }
  }
}

void QN_OF_ISA(qn_spots)(const qn_packet_hits *hits, uint64_t met, const double t[QN_LANES], quoin_spot *out, size_t stride);
void QN_OF_ISA(qn_spots)(const qn_packet_hits *hits, uint64_t met, const double t[QN_LANES], quoin_spot *out, size_t stride) {
  if (met == ~(uint64_t)0 && !hits->leaving) {
    rows(hits, met, t, 1, out, stride);
  } else if (met) {
    rows(hits, met, t, 0, out, stride);
  } else {
    const quoin_spot none = {0, QUOIN_NO_SURFACE, 0};
    for (unsigned y = 0; y < 8; y++) {
      for (unsigned x = 0; x < 8; x++) {
        out[y * stride + x] = none;
      }
    }
  }
}
