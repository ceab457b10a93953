#include "wide/points.h"

#include <stdlib.h>
#include <string.h>

#define BODIES_OF(isa)                                                                                   \
  void qn_first_##isa(const struct quoin_scene *, qn_packet *, qn_packet_hits *, qn_wide_counts *);      \
  int qn_enter_##isa(const struct quoin_scene *, qn_packet *, int, qn_entry *, qn_wide_counts *);        \
  void qn_few_##isa(const struct quoin_scene *, qn_packet *, qn_packet_hits *, qn_wide_counts *);        \
  void qn_one_##isa(const struct quoin_scene *, qn_packet *, qn_packet_hits *, qn_wide_counts *);        \
  void qn_each_##isa(const struct quoin_scene *, qn_packet *, qn_packet_hits *, qn_wide_counts *);       \
  void qn_spans_##isa(const struct quoin_scene *, qn_packet *, qn_packet_spans *, qn_wide_counts *);     \
  void qn_spans_few_##isa(const struct quoin_scene *, qn_packet *, qn_packet_spans *, qn_wide_counts *); \
  void qn_points_##isa(const struct quoin_scene *, qn_point_walk *, size_t, const double *, const double *, uint8_t *, qn_wide_counts *); \
  void qn_spots_##isa(const qn_packet_hits *, uint64_t, const double *, quoin_spot *, size_t);           \
  void qn_round_rows_##isa(const struct quoin_scene *, const qn_packet *, qn_packet_spans *, uint64_t *); \
  void qn_write_rows_##isa(const struct quoin_scene *, const qn_packet_spans *, qn_span_role *, const uint32_t *, quoin_interval *); \
  int qn_round_one_##isa(const struct quoin_scene *, const qn_packet *, const qn_packet_hits *, double *, uint64_t *); \
  void qn_gather_##isa(const quoin_ray *, const uint16_t *, unsigned, qn_packet *, qn_gathered *);       \
  void qn_move_##isa(qn_packet *);                                                                       \
  uint64_t qn_round_##isa(const struct quoin_scene *, const qn_packet *, const qn_packet_hits *, uint64_t, double *, uint64_t *);
BODIES_OF(sse2)
BODIES_OF(avx2)
#ifndef QN_NO_AVX512
BODIES_OF(avx512)
#endif

/* NOLINTBEGIN(bugprone-macro-parentheses): a part of names */
#define ROW(isa, lanes)                                                                                                                  \
  {                                                                                                                                      \
    .name = #isa, .width = lanes, .first = qn_first_##isa, .few = qn_few_##isa, .one = qn_one_##isa, .each = qn_each_##isa, .enter = qn_enter_##isa, .spans = qn_spans_##isa, \
    .spans_few = qn_spans_few_##isa, .points = qn_points_##isa, .spots = qn_spots_##isa, .round = qn_round_##isa, .round_one = qn_round_one_##isa, \
    .round_rows = qn_round_rows_##isa, .write_rows = qn_write_rows_##isa, .gather = qn_gather_##isa, .move = qn_move_##isa                                                  \
  }
/* NOLINTEND(bugprone-macro-parentheses) */
/* From the widest to the one that always runs. */
static const qn_wide bodies[] = {
#ifndef QN_NO_AVX512
  ROW(avx512, 8),
#endif
  ROW(avx2, 4), ROW(sse2, 2)};

static int runs(const qn_wide *body) {
  if (body->width == 8) {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma");
  }
  return body->width != 4 || (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"));
}

const qn_wide *qn_wide_pick(void) {
  const char *forced = getenv("QUOIN_ISA");
  const qn_wide *best = NULL;
  for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++) {
    if (runs(&bodies[i])) {
      if (forced && !strcmp(forced, bodies[i].name)) {
        return &bodies[i];
      }
      best = best ? best : &bodies[i];
    }
  }
  return best;
}
