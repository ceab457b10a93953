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

void QN_OF_ISA(qn_spots)(const qn_packet_hits *hits, uint64_t met, const double t[QN_LANES], quoin_spot *out, size_t stride);
void QN_OF_ISA(qn_spots)(const qn_packet_hits *hits, uint64_t met, const double t[QN_LANES], quoin_spot *out, size_t stride) {
  const vd none = vset(word_of(QUOIN_NO_SURFACE, 0)), leaving = vset(word_of(0, 1)), zero = vset(0);
  for (unsigned at = 0; at < QN_LANES; at += QN_W) {
    const unsigned in = (unsigned)(met >> at) & QN_ALL_BITS, left = (unsigned)(hits->leaving >> at) & QN_ALL_BITS;
    vd place = zero, word = none;
    if (in == QN_ALL_BITS && !left) {
      place = vload(t + at), word = vwords(hits->surface + at);
    } else if (in) {
      vm m = vmask(in);
      place = vpick(m, vload(t + at), zero);
      word = vpick(m, vwords(hits->surface + at), none);
      if (left) {
        word = vbitor(word, vpick(vand(m, vmask(left)), leaving, zero));
      }
    }
    /* cppcheck-suppress duplicateValueTernary ; for two lanes both are 1 */
    double *to[QN_W > 2 ? QN_W / 2 : 1];
    /* cppcheck-suppress duplicateValueTernary ; as above */
    for (unsigned k = 0; k < (QN_W > 2 ? QN_W / 2 : 1); k++) {
      unsigned lane = at + 2 * k;
      to[k] = (double *)(void *)(out + qn_lane_row(lane) * stride + qn_lane_column(lane));
    }
    vweave(place, word, to);
  }
}
