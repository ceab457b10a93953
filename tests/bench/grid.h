/* Clocks, drawing of random numbers, camera files and the rays of their grids: what all benchmarks share. */
#ifndef BENCH_GRID_H
#define BENCH_GRID_H

#include "quoin/quoin.h"

#include <math.h>
#include <stdint.h>
#include <time.h>

#ifdef __cplusplus
extern "C" {
#endif

static inline double bench_now(void) { /* seconds */
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static inline uint64_t bench_u64(uint64_t *state) { /* splitmix64 */
  uint64_t z = (*state += 0x9E3779B97F4A7C15u);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}
static inline double bench_between(uint64_t *state, double a, double b) {
  return a + (b - a) * ((double)(bench_u64(state) >> 11) * 0x1p-53);
}

/* An orthographic grid: ray (i, j) starts at (o + (i + 1/2)/width u) + (j + 1/2)/height v, in doubles in that order (as quoin_grid has it), and
   goes along d. */
typedef struct bench_camera {
  double o[3], u[3], v[3], d[3];
  unsigned width, height;
} bench_camera;

/* Reads a camera file; 0 when it cannot, with a message on stderr. */
int bench_camera_read(const char *path, bench_camera *out);

static inline void bench_camera_ray(const bench_camera *c, unsigned i, unsigned j, double o[3]) {
  double x = (i + 0.5) / c->width, y = (j + 0.5) / c->height;
  for (int k = 0; k < 3; k++) {
    o[k] = (c->o[k] + x * c->u[k]) + y * c->v[k];
  }
}

#ifdef __cplusplus
}
#endif
#endif
