/* A surface in doubles that are as good as two, for rounding places on it in wide code (wide/newton.h): made from its exact form
   when first needed, published atomically, kept with the scene.

   Legend: c the pivot, a double point near a leaf of the surface; y = x - c; the surface is k . (y0^2, y1^2, y2^2, y0 y1, y0 y2,
   y1 y2, y0, y1, y2, 1) = 0, scaled by a power of two so that every |k_i| <= 1. k_i = hi_i + lo_i within 2^-104 |k_i|, lo_i at
   most half a unit in the last place of hi_i; a |k_i| below 2^QN_ROUND_DROP is taken as 0 (docs/bounds.md, QN_ROUND_EVAL). */
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

typedef struct qn_rounding {
  double k[QN_ROUNDING_NUMBERS];
  uint16_t terms; /* bit i: k_i is kept */
  uint8_t axes;   /* bit j: y_j occurs, if only in a term that was dropped */
  uint8_t sound;  /* 0: nothing above holds (a form too large): places on this surface are rounded elsewhere */
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
