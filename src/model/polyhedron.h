/* Convex polyhedra: from points and faces to planes and corners, and back. A plane is (a, b, c, d), a x + b y + c z <= d inside; points and vertices
   are three numbers each. */
#ifndef QN_MODEL_POLYHEDRON_H
#define QN_MODEL_POLYHEDRON_H

#include "model/solid.h"

/* What steps cost, in units of QN_MAX_EFFORT: a side asked of doubles, and exactly; a corner that a plane is made of, or that is put in order; a point that is
   read and compared with others. */
enum { QN_EFFORT_QUICK = 4, QN_EFFORT_SIDE = 256, QN_EFFORT_CORNER = 512, QN_EFFORT_POINT = 512 };

/* Component i of a x b. */
qn_num qn_polyhedron_cross(qn_ctx *ctx, const qn_num *a, const qn_num *b, size_t i);
/* The outward plane of a loop of points, clockwise seen from outside; 0 when it has no area. */
int qn_polyhedron_plane(qn_ctx *ctx, const qn_num *points, const uint32_t *corners, size_t count, qn_num plane[4]);

/* Numbers of a point or a plane as doubles, out[0] not a number where any is of unusual size: then doubles decide nothing. */
void qn_polyhedron_shadow(size_t n, const qn_num *a, double *out);
/* The sign of n.p - d by its doubles, where it is certain; else 0. */
int qn_polyhedron_quick(const double plane[4], const double p[3]);
/* That sign. */
int qn_polyhedron_side(qn_ctx *ctx, const qn_num plane[4], const double near[4], const qn_num p[3], const double near_p[3]);
/* Bit 0: two planes may have equal numbers; bit 1: the one's may be the negatives of the other's. */
int qn_polyhedron_may_be(const double a[4], const double b[4]);

/* Puts the corners of a face, the lowest first, in order: clockwise seen from outside, the lowest first. */
void qn_polyhedron_turn(qn_ctx *ctx, const qn_num plane[4], const qn_num *vertices, uint32_t *corners, size_t count);
/* The corners that lie on a plane, as indices into m vertices (near: their doubles), so ordered. corners has room for m. Returns how many. */
size_t qn_polyhedron_face(qn_ctx *ctx, const qn_num plane[4], const qn_num *vertices, double (*near)[3], size_t m, uint32_t *corners);

/* Sorts by a total order. */
void qn_polyhedron_sort(uint32_t *items, size_t n, int (*order)(void *user, uint32_t i, uint32_t j), void *user);

#endif
