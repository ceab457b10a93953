/* The ways to ask a scene that are timed. Adding one is adding a row to PATHS in paths.c and its function. */
#ifndef BENCH_PATHS_H
#define BENCH_PATHS_H

#include "grid.h"

enum { BLOCK_EDGE = 64, BLOCK = BLOCK_EDGE * BLOCK_EDGE }; /* the unit of work: 64 x 64 pixels, or 4096 rays or points of a list */
enum { CALL = 512 }; /* rays of an array in one call: 8 tiles of 8 x 8, so that rays and answers stay in the nearer caches */

/* What is asked; answers of paths with the same question about the same rays must be the same bytes. */
typedef enum path_question { ASK_HITS, ASK_SPOTS, ASK_BLOCKED, ASK_INTERVALS, ASK_SIDES, QUESTIONS } path_question;
typedef enum path_rays { RAYS_CAMERA, RAYS_SHADOW, RAYS_RANDOM, RAYS_POINTS, RAY_KINDS } path_rays;

/* An answer boiled down: the same for the same answer. */
typedef struct path_answer {
  uint64_t hash;   /* of everything that is promised to be the same on every path */
  uint64_t places; /* of the parameters only (path_places); points: the side */
  double t;        /* of the first boundary; infinite when there is none */
  uint32_t count;  /* intervals, or 1 for a hit */
} path_answer;

/* Lists of rays and points, in blocks of BLOCK. */
typedef struct path_lists {
  quoin_ray *shadow, *random;
  size_t shadow_count, random_count;
  double *points; /* xyz after xyz */
  size_t point_count;
} path_lists;

typedef struct path_job {
  const quoin_scene *scene;
  const bench_camera *camera;
  path_lists lists;
} path_job;

/* One thread's buffers. */
typedef struct path_lane {
  quoin_work *work;
  quoin_ray rays[BLOCK];
  const quoin_ray *asked;   /* the block's rays: these, or a piece of a list */
  quoin_hit hits[BLOCK];    /* only the first CALL of them in use when nothing is judged */
  quoin_spot spots[BLOCK];
  uint8_t blocked[BLOCK];
  quoin_side sides[BLOCK];
  uint16_t place[BLOCK];    /* of ray k in the block's row-major order */
  path_answer *answers;     /* null when only time is wanted; else BLOCK of them, row-major */
  quoin_status status;
} path_lane;

typedef struct path {
  const char *name, *what;
  path_rays rays;
  path_question question;
  /* Answers one block; returns how many rays or points it had. */
  size_t (*block)(const path_job *job, path_lane *lane, size_t block);
  int near; /* its t is promised only to be near the true one */
} path;

/* `near` means: within this share of the parameter (of 1 where that is more). */
#define PATH_NEAR 1e-9
#define PATH_NO_PLACES 0xcbf29ce484222325u
void path_places(uint64_t *hash, double t); /* takes one more parameter in */

extern const path PATHS[];
extern const size_t PATH_COUNT;

size_t path_blocks(const path *p, const path_job *job);
path_lane *path_lane_new(const quoin_scene *scene);
void path_lane_free(path_lane *lane);
/* Makes the lists: n rays to a light from what the camera sees, n rays at random, n points in the scene's box. 0 when memory is short. */
int path_lists_make(path_job *job, path_lane *lane, size_t n, int want_shadow, int want_random, int want_points);
void path_lists_free(path_job *job);

#endif
