/* The exact surfaces of a compiled scene's half-spaces, for a judge that shares nothing else with the library. */
#ifndef QN_STRESS_SNAP_FORMS_H
#define QN_STRESS_SNAP_FORMS_H

#include "quoin/quoin.h"

#include <gmp.h>

/* One half-space: side * q <= 0. leaf: its number among the model's primitives, in the order of the file; half: its number in the leaf; q: x2 y2 z2
   xy xz yz x y z 1, whole numbers. */
typedef struct snap_half {
  uint32_t leaf, half, surface;
  int side;
  mpz_srcptr q[10];
} snap_half;
/* Calls `each` for every half-space. 0: a surface has no exact form, or memory was refused. */
int snap_forms(const quoin_scene *scene, void (*each)(void *user, const snap_half *half), void *user);
#endif
