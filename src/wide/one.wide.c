/* A single ray: the same body over numbers instead of vectors; nodes' eight boxes are still tested at once. */
#define QN_SCALAR
#define QN_LANES_NOW 1
#define QN_FIRST QN_OF_ISA(qn_one)
#include "wide/packet_body.h"
#include "wide/round_ball.h"
#include "wide/round_run.h"

int QN_OF_ISA(qn_round_one)(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, double *t, uint64_t *made);
int QN_OF_ISA(qn_round_one)(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, double *t, uint64_t *made) {
  const qn_piece_sphere *sphere = packet->tile != QN_TILE_PAIRS ? sphere_of_lane(scene, hits, 0) : NULL;
  if (sphere) {
    const ball b = ball_of_one(packet, sphere);
    if (ball_round_lanes(packet, hits, &b, 0, t)) {
      return 1;
    }
  }
  const qn_rounding *surface = qn_scene_rounding(scene, hits->surface[0], made);
  return surface && round_run(surface, packet, hits, 0, 1, t) & 1;
}
