/* The combinations of sides next to a point where surfaces meet: the cells of their germs.

   Legend: P the point, with coordinates over one denominator w; u = w (x - P). A surface that vanishes at P is, up to a
   positive factor and exactly,
       q(u) = 2 g.u + uᵗHu,
   g the gradient at P, H the Hessian (symmetric, six numbers xx yy zz xy xz yz). A cell is a set of signs (one for each
   surface) that some open set with P in its closure has. A surface is smooth at P when g is not zero, else singular: then
   it is the cone uᵗHu = 0 with its apex at P. Its leading form is g.v when smooth and vᵗHv when singular.
   Surfaces with parallel gradients make a class; a class has a plane T, g.v = 0. */
#ifndef QN_RAY_AROUND_CELLS_H
#define QN_RAY_AROUND_CELLS_H

#include "ray/around.h"

typedef struct qn_germ {
  qn_xint g[3], h[6];
  uint8_t plane;    /* h is zero */
  uint8_t opaque;   /* nothing exact is known (superquadrics): either sign is taken as possible everywhere */
  /* filled by qn_cells_list: */
  uint8_t singular;
  int8_t orient;    /* of g along the gradient of the class's first member */
  uint32_t class;
  qn_xint size;     /* |g| on the class's axis: gradients of a class are size * orient times one vector */
} qn_germ;

/* The germ of a surface that vanishes at P. */
void qn_surface_germ_at(qn_ctx *ctx, const qn_exact_surface *surface, const qn_point *point, qn_germ *germ);

typedef struct qn_class {
  uint32_t first;    /* its first member: gives the normal */
  uint32_t members;  /* how many */
  uint32_t axis;     /* a coordinate in which the normal is not zero */
  qn_int normal[3];  /* of the first member */
} qn_class;

/* Two surfaces whose forms, scaled, differ by a semidefinite form: a can not be of sign_a while b is of sign_b. */
typedef struct qn_forbid { uint32_t a, b; int8_t sign_a, sign_b; } qn_forbid;

typedef struct qn_cells {
  qn_ctx *ctx;
  size_t n;
  qn_germ *germs;
  qn_class *classes;
  size_t class_count, singular_count;
  qn_forbid *forbids;
  size_t forbid_count;
  int8_t *signs;  /* the record being made: 0 means either */
  int8_t *full;   /* the record with its zeros filled in */
  uint32_t *order, *free;
  int (*emit)(void *user, const int8_t *signs); /* signs are all -1 or 1; non-zero: no more */
  void *user;
  int stop;
  int gave_up;
  uint64_t work; /* in signs written, about */
  uint64_t unit; /* of numbers as long as these: 1 for those of some hundred bits */
} qn_cells;

/* Surfaces whose signs are open at once in one record: 2^12 fillings. Beyond it the list is given up, and whoever asked
   takes the point as undecided (design S6: boundary). */
enum { QN_CELLS_OPEN = 12 };
/* Signs written in one list, and what takes as long: 160 planes through a point, a second of work. Beyond it the list is given up likewise. */
#define QN_CELLS_WORK ((size_t)1 << 23)
/* What takes as long as so many signs. */
enum { QN_WORK_PARALLEL = 4, QN_WORK_ORDER = 8, QN_WORK_DEFINITE = 32, QN_WORK_ROOT = 16, QN_WORK_FAN = 16 };

/* Calls emit for every cell next to P, some more than once. Where second-order forms do not tell whether a combination is
   realisable it is given too (docs/exactness.md lists where): what is given holds every cell, and equals the cells but in those places.
   line: null, or the direction of a line through P that all surfaces are known to hold, P being none of its turns (turn.c): what is given is then exactly the cells, opaque surfaces
   and apexes apart, and more work than QN_CELLS_WORK is QUOIN_E_LIMIT.
   0: given up (QN_CELLS_OPEN, QN_CELLS_WORK). ctx->failed tells of failure. Cost: about n^3 products in the worst case. */
int qn_cells_list(qn_ctx *ctx, size_t n, qn_germ *germs, const qn_int *line, int (*emit)(void *user, const int8_t *signs), void *user);

/* The same for three planes or more of which all but at most one hold one line, or, if all surfaces are known to hold one line, for three or more with
   distinct tangent planes (around_fan.c): exactly the cells, in about n log n products. 0: the germs are not such, and none was given. Of germs it reads g, `plane`
   and `opaque`. */
int qn_cells_fan(qn_ctx *ctx, size_t n, const qn_germ *germs, const qn_int *line, int (*emit)(void *user, const int8_t *signs), void *user);

/* The same for surfaces that hold one line, of direction d, pairs of planes with that edge and surfaces that touch all along it too (around_sheets.c), for germs that have been
   sorted into smooth and singular ones. 0: one is opaque, or has an apex at P (a stop aside), and none was given. */
int qn_cells_sheets(qn_cells *cells, const qn_int d[3]);

/* --- forms and vectors (around_form.c) --- */
qn_int qn_settled(qn_xint a); /* the value, 0 when its sign is 0 by S2: nothing of a rounding is left to be read as a length */
qn_xint qn_dot_x(qn_ctx *ctx, const qn_xint g[3], const qn_int v[3]);
qn_xint qn_form_x(qn_ctx *ctx, const qn_xint h[6], const qn_int u[3], const qn_int v[3]); /* uᵗHv */
void qn_form_apply(qn_ctx *ctx, const qn_xint h[6], const qn_int v[3], qn_xint out[3]);   /* Hv */
/* The same with what S2 rounded still known of each term: a product of three normals is 0 when they are in one plane by that rule. */
void qn_cross_x(qn_ctx *ctx, const qn_xint a[3], const qn_xint b[3], qn_xint out[3]); /* not in place */
qn_xint qn_product_x(qn_ctx *ctx, const qn_xint a[3], const qn_xint b[3]);
void qn_cross_int(qn_ctx *ctx, const qn_int a[3], const qn_int b[3], qn_int out[3]);
/* a v + b w */
void qn_combine_int(qn_ctx *ctx, qn_int a, const qn_int v[3], qn_int b, const qn_int w[3], qn_int out[3]);
int qn_parallel_x(qn_ctx *ctx, const qn_xint a[3], const qn_xint b[3]);
/* Three independent vectors that are orthogonal for H, and the signs of H on them (Lagrange's reduction). */
void qn_form_axes(qn_ctx *ctx, const qn_xint h[6], qn_int axes[3][3], int signs[3]);
/* 1: H >= 0; -1: H <= 0; 2: H = 0; 0: indefinite. */
int qn_form_definite(qn_ctx *ctx, const qn_xint h[6]);
/* The leading form of a germ at v: its sign. */
int qn_germ_sign(qn_ctx *ctx, const qn_germ *germ, const qn_int v[3]);

/* --- the record (around_cells.c) --- */
void qn_cells_give(qn_cells *cells); /* every filling of cells->signs that no forbid excludes */
int qn_cells_done(const qn_cells *cells);
/* Counts work, in signs; 0 when the list is given up, or done. */
int qn_cells_spend(qn_cells *cells, size_t count, unsigned each);

/* --- a walk along a line of parameters with marks at roots (around_walk.c) --- */
typedef struct qn_walk_mark { qn_root root; uint32_t tag; } qn_walk_mark;
void qn_walk_sort(qn_cells *cells, size_t n, qn_walk_mark *marks); /* stable */
/* The marks at the place of marks[first], each tied with the one before it, end before the index returned. */
size_t qn_walk_group(qn_ctx *ctx, size_t n, const qn_walk_mark *marks, size_t first);
/* A rational between marks[at - 1] and marks[at], which are at different places. */
void qn_walk_between(qn_ctx *ctx, const qn_walk_mark *marks, size_t at, qn_int *num, qn_int *den);

/* --- a class's plane (around_tangent.c) and one direction (tangent.c) --- */
void qn_cells_circle(qn_cells *cells, uint32_t class);
/* The cells next to P + eps v, v a direction in which several leading forms vanish: second order. */
void qn_cells_direction(qn_cells *cells, const qn_int v[3]);
/* D = size_j orient_i H_i - size_i orient_j H_j: positive multiple of the difference of two germs of one class. */
void qn_class_difference(qn_ctx *ctx, const qn_germ *a, const qn_germ *b, qn_xint d[6]);

#endif
