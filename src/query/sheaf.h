/* All stretches of rays that go together: a packet's stretches in the leaves (wide/packet.h), merged lane by lane. */
#ifndef QN_QUERY_SHEAF_H
#define QN_QUERY_SHEAF_H

#include "query/work.h"

typedef struct qn_sheaf_event { double t; uint64_t name; } qn_sheaf_event; /* name: a payload with the slot in the leaf's place, and QN_SHEAF_ENTERS */
#define QN_SHEAF_ENTERS ((uint64_t)1 << 63)

enum { QN_SHEAF_FEW = 64 }; /* slots of a group that are sorted as one */

struct qn_sheaf {
  qn_packet packet;
  qn_packet_spans spans;
  uint32_t *count;       /* by gate: true children; at rest (every leaf outside) between lanes */
  qn_eval *deep;         /* instead of count, in a deep program; likewise */
  uint8_t order[QN_SHEAF_FEW];
  uint32_t ordered;      /* the group whose slots `order` is of */
  qn_sheaf_event *events, *sorting; size_t event_capacity, sorting_capacity;
  quoin_interval *found; size_t found_count, found_capacity;
  qn_span_role roles[1 << QN_SPAN_ROLE_BITS];
  qn_span_flat flats[1 << QN_FLAT_BITS];
  qn_span_plan plans[1 << QN_PLAN_BITS]; /* of a program that is not deep */
  uint32_t first[QN_LANES + 1]; /* lane i's stretches: found[first[i]] to found[first[i + 1] - 1] */
  /* Of a grid: found is all of it, and */
  quoin_interval *boundary; size_t boundary_count, boundary_capacity;
  quoin_run *found_of, *boundary_of; size_t run_capacity, boundary_run_capacity; /* by ray */
};

/* Where the exact line of ray i is when it is wanted: after qn_query_begin. */
typedef quoin_status (*qn_sheaf_line)(quoin_work *work, const void *user, size_t i, qn_line *line);

/* The stretches of n rays, at most QN_LANES, each with a finite origin and direction, as one packet. *sure: the rays that are answered: of ray i, found from
   first[i] on, in full and as the woven path would; the others are for that path. Rays that do not go together are slow here.
   low: null, or for each ray the rests of its origin and direction (QN_TILE_PAIRS in wide/packet.h); kept: the rays differ from those of the last packet of this work in their origins
   alone, and it had low and a place for as many; line, user: null, or the lines where rays are not all of them. */
quoin_status qn_sheaf_rays(quoin_work *work, size_t n, const quoin_ray *rays, double (*low)[6], int kept, qn_sheaf_line line, const void *user, uint64_t *sure);

/* The packet to fill in for qn_sheaf_tile, the same each time; null when memory is refused. */
qn_packet *qn_sheaf_packet(quoin_work *work);
/* Answers that packet. *sure: the lanes that are; lane i has work->sheaf->spans.row_count[i] / 2 stretches (none where it is not sure), which are found[first[i]] and on: found_count
   is increased by them all. */
quoin_status qn_sheaf_tile(quoin_work *work, uint64_t *sure);
void qn_sheaf_free(quoin_work *work);

#endif
