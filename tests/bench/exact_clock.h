/* How long a thread was in exact arithmetic, and in rays answered one by one: kept by a program that is linked with exact_clock.c, whose functions
   stand before the library's (--wrap). */
#ifndef BENCH_EXACT_CLOCK_H
#define BENCH_EXACT_CLOCK_H

#include "grid.h"

typedef struct exact_clock {
  double exact; /* seconds in exact forms, quadratics, roots and cells of integers */
  double woven; /* seconds in rays and points that left their packet, or that were none's, exact arithmetic included */
} exact_clock;

extern _Thread_local exact_clock bench_exact_clock;

/* How many leaves one of the camera's rays meets from its origin on: those with a stretch along it. The mean of n rays; negative when memory is short. */
double bench_leaves_met(const quoin_scene *scene, const bench_camera *camera, size_t n);

#endif
