/* A surface in doubles that are as good as two, for rounding places on it in wide code (wide/newton.h): made from its exact form
   when first needed, published atomically, kept with the scene.

   Legend: c the pivot, a double point near a leaf of the surface; y the coordinates of x - c, those that occur in the form first;
   the surface is k . (y0^2, y1^2, y2^2, y0 y1, y0 y2, y1 y2, y0, y1, y2, 1) = 0, scaled by a power of two so that every
   |k_i| <= 1. k_i = hi_i + lo_i within 2^-104 |k_i|, lo_i at most half a unit in the last place of hi_i; a |k_i| below
   2^QN_ROUND_DROP is taken as 0 (docs/bounds.md, QN_ROUND_EVAL). */
#ifndef QN_SCENE_ROUNDING_H
#define QN_SCENE_ROUNDING_H

#include "scene/scene.h"

/* Places of the numbers in qn_rounding.k. */
enum {
  QN_ROUNDING_PIVOT = 0,
  QN_ROUNDING_HI = 3,
  QN_ROUNDING_LO = 13,
  QN_ROUNDING_SQUARE = 23,   /* the largest |k_i| of degree 2, and QN_ROUND_SQUARE_TINY where there are any */
  QN_ROUNDING_LINEAR = 24,   /* of degree 1, and QN_ROUND_LINEAR_TINY */
  QN_ROUNDING_CONSTANT = 25, /* |k_9|, and QN_ROUND_TINY */
  QN_ROUNDING_NUMBERS = 26
};

/* The shapes of forms, from the fewest terms to all of them: a form is of the first that has its terms. */
typedef enum qn_rounding_kind {
  QN_ROUNDING_AXIS,     /* a plane across an axis: y0 and 1 */
  QN_ROUNDING_PLANE,
  QN_ROUNDING_ROUND,    /* a cylinder along an axis and the like: y0, y1, their squares, and 1 */
  QN_ROUNDING_DIAGONAL, /* no products of different coordinates */
  QN_ROUNDING_FULL,
  QN_ROUNDING_KINDS,
  QN_ROUNDING_NONE = QN_ROUNDING_KINDS /* a form too large for all this: places on this surface are rounded elsewhere */
} qn_rounding_kind;

typedef struct qn_rounding {
  double k[QN_ROUNDING_NUMBERS];
  uint8_t axis[3]; /* y_j is coordinate axis[j] of x - c */
  uint8_t kind;
  double place[2]; /* QN_ROUNDING_AXIS: where on its axis the plane stands, as a sum within 2^-105 of itself, the second at most half a unit of the first */
} qn_rounding;

/* What qn_scene_rounding does the first time. */
QN_NODISCARD const qn_rounding *qn_rounding_make(const quoin_scene *scene, uint32_t surface, uint64_t *made);

/* Null when memory is refused, and for superquadrics. *made is increased when the surface's exact form was made for it. Threads: any. */
QN_INLINE const qn_rounding *qn_scene_rounding(const quoin_scene *scene, uint32_t surface, uint64_t *made) {
  const qn_rounding *there = atomic_load_explicit(&scene->surfaces[surface].rounding, memory_order_acquire);
  return QN_LIKELY(there != NULL) ? there : qn_rounding_make(scene, surface, made);
}

void qn_rounding_free(qn_mem *mem, qn_rounding *rounding);

#endif
