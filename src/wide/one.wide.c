/* A single ray: the same body over numbers instead of vectors; nodes' eight boxes are still tested at once. */
#define QN_SCALAR
#define QN_LANES_NOW 1
#define QN_FIRST QN_OF_ISA(qn_one)
#include "wide/packet_body.h"
#include "wide/round_run.h"

int QN_OF_ISA(qn_round_one)(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, double *t, uint64_t *made);
int QN_OF_ISA(qn_round_one)(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, double *t, uint64_t *made) {
  const qn_rounding *surface = qn_scene_rounding(scene, hits->surface[0], made);
  return surface && round_run(surface, packet, hits, 0, 1, t) & 1;
}
