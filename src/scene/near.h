/* Surfaces that nearly coincide (design S4): what their gap is, and how near ones are found. docs/decisions/0007-snap.md. */
#ifndef QN_SCENE_NEAR_H
#define QN_SCENE_NEAR_H

#include "scene/scene.h"

/* Planes whose normals enclose an angle with sin^2 over 2^-QN_NEAR_ANGLE cross; they do not nearly coincide, however small the place. */
#define QN_NEAR_ANGLE 12

/* Where a surface is used: the hull of the boxes of its users. Infinite where one is not bounded. */
typedef struct qn_region { double min[3], max[3]; } qn_region;

/* --- gap.c --------------------------------------------------------------------------------------------------------- */

/* The gap of two surfaces, `own` being the region of x, the smaller of the two, and `theirs` that of y. 0: they have none (they are of different kinds, or
   cross). *turn: 1, or -1 where their normalised forms point in opposite directions. Exact for rationals with rational roots, else to
   256 bits (S2). ctx->failed is to be looked at. */
int qn_gap(qn_ctx *ctx, const qn_exact_surface *x, const qn_exact_surface *y, const qn_region *own, const qn_region *theirs, qn_num *gap,
           int *turn);

/* --- near.c -------------------------------------------------------------------------------------------------------- */

/* Surfaces within `limit`: the smaller one, and the one that stands for both. Of regions of one size, the first in the file stands. */
typedef struct qn_near_pair {
  uint32_t small, stands;
  uint32_t leaf[2];  /* a user of each, those of QN_NEAR_ALL near one another where this was looked for */
  int8_t turn;
  double gap;        /* nearest to it */
  const char *exact; /* the gap exactly, where that is short, else "" */
} qn_near_pair;

typedef struct qn_near_pairs {
  qn_near_pair *items;
  size_t count, capacity;
  qn_arena texts;
  int cut; /* not all pairs were looked at, or kept; of a search for a snap, it was refused */
} qn_near_pairs;

typedef enum qn_near_want {
  QN_NEAR_ALL,  /* every pair of which users' boxes come within the limit of each other too */
  QN_NEAR_SNAP  /* for each surface that has a standing one within the limit, the nearest of these; those without stand themselves */
} qn_near_want;

/* n log n, and bounded by n times a constant in all: then *out is cut, and a search for a snap is QUOIN_E_LIMIT. Threads: one. */
QN_NODISCARD quoin_status qn_near_find(const quoin_scene *scene, qn_num limit, qn_near_want want, qn_near_pairs *out);
void qn_near_pairs_free(qn_near_pairs *pairs, qn_mem *mem);

/* The limit of `quoin check`: how far apart two six-digit roundings of one number of the scene may be (docs/decisions/0007-snap.md). */
double qn_near_usual(const quoin_scene *scene);

#endif
