/* Convex polyhedra: from points and faces to planes and corners, and back. */
#ifndef QN_MODEL_POLYHEDRON_H
#define QN_MODEL_POLYHEDRON_H

#include "model/solid.h"

/* The corners that lie on a plane (a, b, c, d: a x + b y + c z <= d inside), as indices into m vertices, clockwise seen
   from outside, the lowest first. corners has room for m. Returns how many. */
size_t qn_polyhedron_face(qn_ctx *ctx, const qn_num plane[4], const qn_num *vertices, size_t m, uint32_t *corners);

#endif
