#include "wide/points.h"

#include <stdlib.h>
#include <string.h>

#define BODIES_OF(isa)                                                                              \
  void qn_first_##isa(const struct quoin_scene *, qn_packet *, qn_packet_hits *, qn_wide_counts *); \
  void qn_few_##isa(const struct quoin_scene *, qn_packet *, qn_packet_hits *, qn_wide_counts *);   \
  void qn_spans_##isa(const struct quoin_scene *, qn_packet *, qn_packet_spans *, qn_wide_counts *);     \
  void qn_spans_few_##isa(const struct quoin_scene *, qn_packet *, qn_packet_spans *, qn_wide_counts *); \
  void qn_points_##isa(const struct quoin_scene *, qn_point_walk *, size_t, const qn_wide_point *, uint8_t *, qn_wide_counts *); \
  void qn_spots_##isa(const qn_packet_hits *, uint64_t, const double *, quoin_spot *, size_t); \
  uint64_t qn_round_##isa(const struct quoin_scene *, const qn_packet *, const qn_packet_hits *, uint64_t, double *, uint64_t *);
BODIES_OF(sse2)
BODIES_OF(avx2)
BODIES_OF(avx512)

/* From the widest to the one that always runs. */
static const qn_wide bodies[] = {
  {.name = "avx512", .first = qn_first_avx512, .few = qn_few_avx512, .round = qn_round_avx512, .spans = qn_spans_avx512, .spans_few = qn_spans_few_avx512,
   .width = 8, .points = qn_points_avx512, .spots = qn_spots_avx512},
  {.name = "avx2", .first = qn_first_avx2, .few = qn_few_avx2, .round = qn_round_avx2, .spans = qn_spans_avx2, .spans_few = qn_spans_few_avx2,
   .width = 4, .points = qn_points_avx2, .spots = qn_spots_avx2},
  {.name = "sse2", .first = qn_first_sse2, .few = qn_few_sse2, .round = qn_round_sse2, .spans = qn_spans_sse2, .spans_few = qn_spans_few_sse2,
   .width = 2, .points = qn_points_sse2, .spots = qn_spots_sse2},
};

static int runs(size_t i) {
  if (i == 0) {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma");
  }
  return i != 1 || (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"));
}

const qn_wide *qn_wide_pick(void) {
  const char *forced = getenv("QUOIN_ISA");
  const qn_wide *best = NULL;
  for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++) {
    if (runs(i)) {
      if (forced && !strcmp(forced, bodies[i].name)) {
        return &bodies[i];
      }
      best = best ? best : &bodies[i];
    }
  }
  return best;
}
