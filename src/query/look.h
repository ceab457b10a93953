/* Rays in packets, for whoever asks many at once. */
#ifndef QN_QUERY_LOOK_H
#define QN_QUERY_LOOK_H

#include "query/work.h"
#include "wide/packet.h"

#include <math.h>

/* What a ray meets first. Everything here follows from the ray, its parameter and its surface, so it is the same by
   whatever route the ray was answered. */
typedef struct qn_seen {
  double t;          /* correctly rounded */
  uint32_t surface;  /* QUOIN_NO_SURFACE: no boundary is met, and nothing else is set */
  uint32_t leaf;     /* the part */
  uint8_t leaving;
} qn_seen;

QN_INLINE quoin_spot qn_spot_of(const qn_seen *seen) {
  /* cppcheck-suppress internalAstError ; it cannot read compound literals after a question mark */
  return seen->surface == QUOIN_NO_SURFACE ? (quoin_spot){.surface = QUOIN_NO_SURFACE} : (quoin_spot){seen->t, seen->surface, seen->leaving};
}

enum {
  QN_LOOK_T = 1,       /* t correctly rounded; without it t is only near */
  QN_LOOK_SURFACE = 2  /* the surface that is met is wanted, not the part: of its parts any will do; else the one that the woven path names */
};

/* Finite, with a direction and a range. */
QN_INLINE int qn_is_ray(const quoin_ray *ray) {
  double all = 0, any = 0;
  for (int i = 0; i < 3; i++) {
    all += ray->o[i] * 0 + ray->d[i] * 0;
    any += fabs(ray->d[i]) > 0;
  }
  return all == 0 && any > 0 && ray->from <= ray->to && ray->from < HUGE_VAL && ray->to > -HUGE_VAL;
}

/* The first boundaries of n rays: calls each(user, i, seen) for every ray in order, until it returns anything but QUOIN_OK; QUOIN_E_ARGUMENT at the first that is no ray, or soon before it. A ray
   that goes alone is looked at when its turn comes and told of at once: an array that is read far ahead, or answered in passes, has left the nearest cache by then (1 to 3 % of such a ray).
   Rays that go the same way do best in runs of 64, each run an 8 by 8 tile in the order of wide/packet.h. */
/* on: null, or for each ray the surface that its start lies on (or QUOIN_NO_SURFACE): a hint that spares a ray that starts at a hit, shifted by
   rounding, a comparison of two nearly equal places. */
typedef quoin_status (*qn_seen_fn)(void *user, size_t i, const qn_seen *seen);
quoin_status qn_look(quoin_work *work, size_t n, const quoin_ray *rays, const uint32_t *on, unsigned want, qn_seen_fn each, void *user);

/* The same for one ray, with the surface that its start lies on, or QUOIN_NO_SURFACE. */
quoin_status qn_look_alone(quoin_work *work, const quoin_ray *ray, uint32_t on, unsigned want, qn_seen *out);

/* The first boundaries as the public call gives them; runs of 64 that go the same way do best as 8 by 8 tiles, row after row. want: QN_LOOK_T or 0.
   QUOIN_E_ARGUMENT as of qn_look. */
quoin_status qn_look_spots(quoin_work *work, size_t n, const quoin_ray *rays, unsigned want, quoin_spot *out);

/* Whether each ray is inside the solid anywhere in its range: blocked[i] is 1 or 0 (blocked.c). QUOIN_E_ARGUMENT where one of them is no ray. */
quoin_status qn_look_blocked(quoin_work *work, size_t n, const quoin_ray *rays, const uint32_t *on, uint8_t *blocked);
/* The same for rays that are known to be such, of which only neighbours in the array share packets. */
quoin_status qn_look_blocked_in_order(quoin_work *work, size_t n, const quoin_ray *rays, const uint32_t *on, uint8_t *blocked);

/* One ray of them by the woven path: for a lane that a packet with `any` (wide/packet.h) has given up. */
quoin_status qn_look_woven_blocked(quoin_work *work, const quoin_ray *ray, uint8_t *blocked);

/* The same for lanes that are in a packet already. out: an entry for each lane up to the last live one. *met: the lanes that meet a boundary; the others' entries are not set. */
quoin_status qn_look_packet(quoin_work *work, qn_packet *packet, unsigned want, qn_seen *out, uint64_t *met);

/* How many of the next n rays are to go as one packet: a whole one, a few, or 1; the next *alone rays are known to go one by one. Rays that go one way but pass far from one another meet few leaves together: 64 of
   them took four times what they take one by one. In an unbounded solid only their directions count. */
size_t qn_rays_share(const quoin_scene *scene, size_t n, const quoin_ray *rays, size_t *alone);

/* Whether a packet of these rays pays. */
int qn_rays_together(const quoin_ray *rays, size_t n);
/* Puts n rays into the first lanes of a packet of `lanes` lanes; low: null, or for each ray the rests of its origin and direction (QN_TILE_PAIRS). */
void qn_packet_fill(qn_packet *packet, size_t lanes, size_t n, const quoin_ray *rays, double (*low)[6]);
/* The same for a packet of as many lanes that was filled with low and has been through its body, and rays that differ from its own in nothing but their origins and these rests. */
void qn_packet_move(qn_packet *packet, size_t lanes, size_t n, const quoin_ray *rays, double (*low)[6]);
/* Answers lane by lane, for whoever has run a packet: by the woven path, and a found lane's parameter, correctly rounded. */
quoin_status qn_look_woven(quoin_work *work, const qn_packet *packet, unsigned lane, unsigned want, qn_seen *out);
quoin_status qn_look_round(quoin_work *work, const qn_packet *packet, const qn_packet_hits *hits, unsigned lane, double *t);
/* A packet's answers as rows of eight spots. */
quoin_status qn_look_tile(quoin_work *work, qn_packet *packet, unsigned want, quoin_spot *out, size_t stride);
/* The entry of neighbouring tiles (qn_enter_fn in wide/packet.h), counted. */
int qn_look_enter(quoin_work *work, qn_packet *packet, int leaves, qn_entry *entry);
/* Runs a packet's body and counts; without a normal form every lane is unsure. */
void qn_look_run(quoin_work *work, qn_packet *packet, qn_packet_hits *hits);

/* Of `lanes`, found and tied ones of a packet that has been through its body: those whose surface the packet names as the woven path would, since no other passes at the
   hit. Which of its parts is met is still open (alone.c). */
uint64_t qn_alone_lanes(const quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes);
/* Those of them whose parts are certain too; hits->leaf of these becomes the part that the woven path names. eval: at rest, and left so. */
uint64_t qn_name_parts(const quoin_scene *scene, qn_eval *eval, const qn_packet *packet, qn_packet_hits *hits, uint64_t lanes);

/* The gradient of a half-space's form at pivot + y, in doubles (hit.c). */
void qn_half_gradient(const quoin_scene *scene, const qn_half *half, const double y[3], double g[3]);

#endif
