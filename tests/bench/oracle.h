/* What a ray's intervals are, found the slow and sure way: every leaf, 640 bits, no hierarchy, no code of the library.

   A number with 640 bits is not exact, but the scenes' numbers are decimals of 17 digits and doubles: two roots that are not equal
   differ by far more than 2^-200, and equal ones come out within 2^-500. So two places within 2^-200 (relative) are one place. */
#ifndef BENCH_ORACLE_H
#define BENCH_ORACLE_H

#include "flat.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct oracle oracle;
typedef struct oracle_interval {
  double enter, leave; /* correctly rounded */
} oracle_interval;

oracle *oracle_new(const flat_scene *scene); /* null when memory is short */
void oracle_free(oracle *o);
/* The stretches of o + t d, t >= 0, inside the solid. Returns their number, at most max of which are stored; -1 when the ray runs in a
   plane or along a generator (such a ray is not judged here). *entered_at_zero: the first begins at t = 0. */
long oracle_ray(oracle *o, const double origin[3], const double direction[3], size_t max, oracle_interval *out, int *entered_at_zero);
/* 0 outside, 2 inside; -1 when the point lies on a leaf's surface (not judged here). */
int oracle_point(oracle *o, const double point[3]);

#ifdef __cplusplus
}
#endif
#endif
