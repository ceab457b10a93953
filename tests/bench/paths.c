#include "paths.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A power of two: a ray's direction times it spells the same digits everywhere, and lies outside the double filter's range, so that
   every decision is taken in exact arithmetic. */
#define UNFILTERED 0x1p70

/* --- answers --------------------------------------------------------------------------------------------------------- */

static void mix(uint64_t *hash, const void *data, size_t size) {
  const unsigned char *p = data;
  for (size_t i = 0; i < size; i++) {
    *hash = (*hash ^ p[i]) * 0x100000001b3u; /* FNV-1a */
  }
}

void path_places(uint64_t *hash, double t) {
  mix(hash, &t, sizeof t);
}

static void keep_hit(path_lane *lane, size_t place, const quoin_hit *h) {
  path_answer *a = &lane->answers[place];
  *a = (path_answer){PATH_NO_PLACES, PATH_NO_PLACES, INFINITY, 0};
  mix(&a->hash, &h->found, sizeof h->found);
  if (h->found) {
    a->count = 1;
    path_places(&a->places, h->t);
    a->t = h->t;
    mix(&a->hash, &h->leaving, sizeof h->leaving);
    mix(&a->hash, &h->t, sizeof h->t);
    mix(&a->hash, &h->part, sizeof h->part);
    mix(&a->hash, &h->role, sizeof h->role);
  }
}

static void keep_intervals(path_lane *lane, size_t place, const quoin_intervals *answer, double scale) {
  path_answer *a = &lane->answers[place];
  *a = (path_answer){PATH_NO_PLACES, PATH_NO_PLACES, INFINITY, (uint32_t)answer->count};
  for (size_t i = 0; i < answer->count; i++) {
    const quoin_end *ends[2] = {&answer->inside[i].enter, &answer->inside[i].leave};
    for (int k = 0; k < 2; k++) {
      double t = ends[k]->t * scale;
      mix(&a->hash, &t, sizeof t);
      path_places(&a->places, t);
      mix(&a->hash, &ends[k]->part, sizeof ends[k]->part);
      mix(&a->hash, &ends[k]->role, sizeof ends[k]->role);
    }
  }
}

/* --- the rays of a block --------------------------------------------------------------------------------------------- */

typedef struct extent { unsigned x, y, w, h; } extent;

static extent block_extent(const bench_camera *c, size_t block) {
  unsigned across = (c->width + BLOCK_EDGE - 1) / BLOCK_EDGE;
  extent e = {(unsigned)(block % across) * BLOCK_EDGE, (unsigned)(block / across) * BLOCK_EDGE, BLOCK_EDGE, BLOCK_EDGE};
  e.w = e.x + e.w > c->width ? c->width - e.x : e.w;
  e.h = e.y + e.h > c->height ? c->height - e.y : e.h;
  return e;
}

static void camera_ray(const bench_camera *c, const extent *e, unsigned i, unsigned j, double scale, size_t k, path_lane *lane) {
  quoin_ray *r = &lane->rays[k];
  bench_camera_ray(c, e->x + i, e->y + j, r->o);
  for (int a = 0; a < 3; a++) {
    r->d[a] = c->d[a] * scale;
  }
  r->from = 0;
  r->to = INFINITY;
  lane->place[k] = (uint16_t)(j * e->w + i);
}

static size_t rows(const bench_camera *c, size_t block, double scale, path_lane *lane) {
  extent e = block_extent(c, block);
  size_t k = 0;
  for (unsigned j = 0; j < e.h; j++) {
    for (unsigned i = 0; i < e.w; i++) {
      camera_ray(c, &e, i, j, scale, k++, lane);
    }
  }
  lane->asked = lane->rays;
  return k;
}

/* 8 by 8 tiles, one after another. */
static size_t tiles(const bench_camera *c, size_t block, path_lane *lane) {
  extent e = block_extent(c, block);
  size_t k = 0;
  for (unsigned j0 = 0; j0 < e.h; j0 += 8) {
    for (unsigned i0 = 0; i0 < e.w; i0 += 8) {
      for (unsigned j = j0; j < j0 + 8 && j < e.h; j++) {
        for (unsigned i = i0; i < i0 + 8 && i < e.w; i++) {
          camera_ray(c, &e, i, j, 1, k++, lane);
        }
      }
    }
  }
  lane->asked = lane->rays;
  return k;
}

static size_t listed(const quoin_ray *all, size_t count, size_t block, path_lane *lane) {
  size_t n = count - block * BLOCK < BLOCK ? count - block * BLOCK : BLOCK;
  lane->asked = all + block * BLOCK;
  for (size_t k = 0; lane->answers && k < n; k++) {
    lane->place[k] = (uint16_t)k;
  }
  return n;
}

/* --- the calls ------------------------------------------------------------------------------------------------------- */

static void keep_hits(path_lane *lane, size_t n) {
  for (size_t k = 0; lane->answers && k < n; k++) {
    keep_hit(lane, lane->place[k], &lane->hits[k]);
  }
}

static void fail(path_lane *lane, quoin_status status) {
  lane->status = status != QUOIN_OK ? status : lane->status;
}

static size_t hits_of(const path_job *job, path_lane *lane, size_t n) {
  for (size_t k = 0; k < n; k += CALL) {
    fail(lane, quoin_first_hits(job->scene, lane->work, n - k < CALL ? n - k : CALL, lane->asked + k, lane->hits + (lane->answers ? k : 0)));
  }
  keep_hits(lane, n);
  return n;
}

/* Hits are kept where an array's are: a ray alone would otherwise be spared the writing. */
static size_t single_hits_of(const path_job *job, path_lane *lane, size_t n) {
  for (size_t k = 0; k < n; k++) {
    fail(lane, quoin_first_hit(job->scene, lane->work, &lane->asked[k], &lane->hits[lane->answers ? k : k % CALL]));
  }
  keep_hits(lane, n);
  return n;
}

static int each_answer(void *user, size_t i, const quoin_intervals *answer) {
  path_lane *lane = user;
  if (lane->answers) {
    keep_intervals(lane, lane->place[i], answer, 1);
  }
  return 0;
}

static size_t block_hits_rows(const path_job *job, path_lane *lane, size_t block) {
  return hits_of(job, lane, rows(job->camera, block, 1, lane));
}
static size_t block_hits_tiles(const path_job *job, path_lane *lane, size_t block) {
  return hits_of(job, lane, tiles(job->camera, block, lane));
}
static size_t block_hits_single(const path_job *job, path_lane *lane, size_t block) {
  return single_hits_of(job, lane, rows(job->camera, block, 1, lane));
}
static size_t block_intervals(const path_job *job, path_lane *lane, size_t block) {
  size_t n = tiles(job->camera, block, lane);
  fail(lane, quoin_ray_intervals_many(job->scene, lane->work, n, lane->rays, 0, each_answer, lane));
  return n;
}
static size_t intervals_one_by_one(const path_job *job, path_lane *lane, size_t block, double scale) {
  size_t n = rows(job->camera, block, scale, lane);
  for (size_t k = 0; k < n; k++) {
    quoin_intervals answer;
    fail(lane, quoin_ray_intervals(job->scene, lane->work, &lane->rays[k], 0, &answer));
    if (lane->answers) {
      keep_intervals(lane, lane->place[k], &answer, scale);
    }
  }
  return n;
}
static size_t block_intervals_single(const path_job *job, path_lane *lane, size_t block) {
  return intervals_one_by_one(job, lane, block, 1);
}
static size_t block_intervals_exact(const path_job *job, path_lane *lane, size_t block) {
  return intervals_one_by_one(job, lane, block, UNFILTERED);
}
static size_t block_shadow(const path_job *job, path_lane *lane, size_t block) {
  return hits_of(job, lane, listed(job->lists.shadow, job->lists.shadow_count, block, lane));
}
static size_t block_shadow_single(const path_job *job, path_lane *lane, size_t block) {
  return single_hits_of(job, lane, listed(job->lists.shadow, job->lists.shadow_count, block, lane));
}
static size_t block_random(const path_job *job, path_lane *lane, size_t block) {
  return hits_of(job, lane, listed(job->lists.random, job->lists.random_count, block, lane));
}
static size_t block_random_single(const path_job *job, path_lane *lane, size_t block) {
  return single_hits_of(job, lane, listed(job->lists.random, job->lists.random_count, block, lane));
}

static void keep_spots(path_lane *lane, size_t n) {
  for (size_t k = 0; lane->answers && k < n; k++) {
    const quoin_spot *s = &lane->spots[k];
    path_answer *a = &lane->answers[lane->place[k]];
    *a = (path_answer){PATH_NO_PLACES, PATH_NO_PLACES, INFINITY, s->surface != QUOIN_NO_SURFACE};
    mix(&a->hash, &s->surface, sizeof s->surface);
    if (a->count) {
      mix(&a->hash, &s->leaving, sizeof s->leaving);
      path_places(&a->places, s->t);
      a->t = s->t;
    }
  }
}

/* Arrays of rays as spots, or whether they are blocked; `call` rays in one call. */
static size_t asked_spots(const path_job *job, path_lane *lane, size_t n, size_t call) {
  for (size_t k = 0; k < n; k += call) {
    fail(lane, quoin_first_spots(job->scene, lane->work, n - k < call ? n - k : call, lane->asked + k, QUOIN_WANT_T, lane->spots + k));
  }
  keep_spots(lane, n);
  return n;
}
static size_t asked_blocked(const path_job *job, path_lane *lane, size_t n, size_t call) {
  for (size_t k = 0; k < n; k += call) {
    fail(lane, quoin_rays_blocked(job->scene, lane->work, n - k < call ? n - k : call, lane->asked + k, NULL, lane->blocked + k));
  }
  for (size_t k = 0; lane->answers && k < n; k++) {
    lane->answers[lane->place[k]] = (path_answer){lane->blocked[k], lane->blocked[k], INFINITY, lane->blocked[k]};
  }
  return n;
}
static size_t block_spots_single(const path_job *job, path_lane *lane, size_t block) {
  return asked_spots(job, lane, rows(job->camera, block, 1, lane), 1);
}
static size_t block_spots(const path_job *job, path_lane *lane, size_t block) {
  return asked_spots(job, lane, tiles(job->camera, block, lane), CALL);
}
static size_t block_random_spots_single(const path_job *job, path_lane *lane, size_t block) {
  return asked_spots(job, lane, listed(job->lists.random, job->lists.random_count, block, lane), 1);
}
static size_t block_random_spots(const path_job *job, path_lane *lane, size_t block) {
  return asked_spots(job, lane, listed(job->lists.random, job->lists.random_count, block, lane), CALL);
}
static size_t block_blocked_single(const path_job *job, path_lane *lane, size_t block) {
  return asked_blocked(job, lane, listed(job->lists.shadow, job->lists.shadow_count, block, lane), 1);
}
static size_t block_blocked(const path_job *job, path_lane *lane, size_t block) {
  return asked_blocked(job, lane, listed(job->lists.shadow, job->lists.shadow_count, block, lane), BLOCK);
}
static size_t block_random_intervals(const path_job *job, path_lane *lane, size_t block) {
  size_t n = listed(job->lists.random, job->lists.random_count, block, lane);
  fail(lane, quoin_ray_intervals_many(job->scene, lane->work, n, lane->asked, 0, each_answer, lane));
  return n;
}
static size_t block_random_intervals_single(const path_job *job, path_lane *lane, size_t block) {
  size_t n = listed(job->lists.random, job->lists.random_count, block, lane);
  for (size_t k = 0; k < n; k++) {
    quoin_intervals answer;
    fail(lane, quoin_ray_intervals(job->scene, lane->work, &lane->asked[k], 0, &answer));
    each_answer(lane, k, &answer);
  }
  return n;
}

static quoin_grid grid_of(const bench_camera *c) {
  quoin_grid g = {.width = c->width, .height = c->height, .from = 0, .to = INFINITY};
  memcpy(g.o, c->o, sizeof g.o);
  memcpy(g.u, c->u, sizeof g.u);
  memcpy(g.v, c->v, sizeof g.v);
  memcpy(g.d, c->d, sizeof g.d);
  return g;
}

/* A block of the grid by the grid's own call. */
static size_t spots_of(const path_job *job, path_lane *lane, size_t block, unsigned want) {
  const bench_camera *c = job->camera;
  extent e = block_extent(c, block);
  const quoin_grid g = grid_of(c);
  fail(lane, quoin_grid_hits(job->scene, lane->work, &g, e.x, e.y, e.x + e.w, e.y + e.h, want, lane->spots));
  size_t n = (size_t)e.w * e.h;
  if (lane->answers) {
    for (size_t k = 0; k < n; k++) {
      lane->place[k] = (uint16_t)k;
    }
  }
  keep_spots(lane, n);
  if (lane->answers) { /* whoever judges wants to see the rays */
    rows(c, block, 1, lane);
  }
  return n;
}
static size_t block_grid(const path_job *job, path_lane *lane, size_t block) {
  return spots_of(job, lane, block, 0);
}
static size_t block_grid_t(const path_job *job, path_lane *lane, size_t block) {
  return spots_of(job, lane, block, QUOIN_WANT_T);
}

/* All intervals of a block of the grid in one call. */
static size_t block_grid_intervals(const path_job *job, path_lane *lane, size_t block) {
  const bench_camera *c = job->camera;
  extent e = block_extent(c, block);
  const quoin_grid g = grid_of(c);
  quoin_grid_answer all;
  fail(lane, quoin_grid_intervals(job->scene, lane->work, &g, e.x, e.y, e.x + e.w, e.y + e.h, 0, &all));
  for (size_t k = 0; lane->answers && lane->status == QUOIN_OK && k < all.rays; k++) {
    const quoin_intervals one = {.count = all.inside_of[k].count, .inside = all.inside + all.inside_of[k].first};
    keep_intervals(lane, k, &one, 1);
  }
  if (lane->answers) { /* whoever judges wants to see the rays */
    rows(c, block, 1, lane);
  }
  return (size_t)e.w * e.h;
}

static void keep_sides(path_lane *lane, size_t n) {
  for (size_t k = 0; lane->answers && k < n; k++) {
    lane->answers[k] = (path_answer){(uint64_t)lane->sides[k], (uint64_t)lane->sides[k], 0, 1};
  }
}
static size_t block_points(const path_job *job, path_lane *lane, size_t block) {
  const path_lists *l = &job->lists;
  size_t n = l->point_count - block * BLOCK < BLOCK ? l->point_count - block * BLOCK : BLOCK;
  fail(lane, quoin_point_sides(job->scene, lane->work, n, l->points + 3 * block * BLOCK, lane->sides));
  keep_sides(lane, n);
  return n;
}
static size_t block_points_single(const path_job *job, path_lane *lane, size_t block) {
  const path_lists *l = &job->lists;
  size_t n = l->point_count - block * BLOCK < BLOCK ? l->point_count - block * BLOCK : BLOCK;
  for (size_t k = 0; k < n; k++) {
    fail(lane, quoin_point_side(job->scene, lane->work, l->points + 3 * (block * BLOCK + k), &lane->sides[k]));
  }
  keep_sides(lane, n);
  return n;
}

const path PATHS[] = {
  {"single", "first hits, camera rays one by one", RAYS_CAMERA, ASK_HITS, block_hits_single, 0},
  {"rows", "first hits, camera rays in rows of 64", RAYS_CAMERA, ASK_HITS, block_hits_rows, 0},
  {"tiles", "first hits, camera rays in 8x8 tiles", RAYS_CAMERA, ASK_HITS, block_hits_tiles, 0},
  {"grid-t", "first hits by the grid call, t rounded correctly", RAYS_CAMERA, ASK_SPOTS, block_grid_t, 0},
  {"grid", "first hits by the grid call", RAYS_CAMERA, ASK_SPOTS, block_grid, 1},
  {"intervals-single", "all intervals, camera rays one by one", RAYS_CAMERA, ASK_INTERVALS, block_intervals_single, 0},
  {"intervals", "all intervals, camera rays in 8x8 tiles", RAYS_CAMERA, ASK_INTERVALS, block_intervals, 0},
  {"grid-intervals", "all intervals by the grid call", RAYS_CAMERA, ASK_INTERVALS, block_grid_intervals, 0},
  {"intervals-exact", "all intervals, the filter off", RAYS_CAMERA, ASK_INTERVALS, block_intervals_exact, 0},
  {"shadow-single", "first hits, rays from what the camera sees to a light, one by one", RAYS_SHADOW, ASK_HITS, block_shadow_single, 0},
  {"shadow", "the same as arrays, in the order of 8x8 tiles", RAYS_SHADOW, ASK_HITS, block_shadow, 0},
  {"random-single", "first hits, incoherent rays, one by one", RAYS_RANDOM, ASK_HITS, block_random_single, 0},
  {"random", "the same as arrays", RAYS_RANDOM, ASK_HITS, block_random, 0},
  {"spots-single", "first boundaries in short, camera rays one by one", RAYS_CAMERA, ASK_SPOTS, block_spots_single, 0},
  {"spots", "the same as arrays, in 8x8 tiles", RAYS_CAMERA, ASK_SPOTS, block_spots, 0},
  {"random-spots-single", "first boundaries in short, incoherent rays one by one", RAYS_RANDOM, ASK_SPOTS, block_random_spots_single, 0},
  {"random-spots", "the same as arrays", RAYS_RANDOM, ASK_SPOTS, block_random_spots, 0},
  {"blocked-single", "whether the shadow rays are blocked, one by one", RAYS_SHADOW, ASK_BLOCKED, block_blocked_single, 0},
  {"blocked", "the same as an array of 4096", RAYS_SHADOW, ASK_BLOCKED, block_blocked, 0},
  {"random-all-single", "all intervals, incoherent rays, one by one", RAYS_RANDOM, ASK_INTERVALS, block_random_intervals_single, 0},
  {"random-all", "the same as arrays", RAYS_RANDOM, ASK_INTERVALS, block_random_intervals, 0},
  {"points-single", "sides of points, one by one", RAYS_POINTS, ASK_SIDES, block_points_single, 0},
  {"points", "the same as arrays", RAYS_POINTS, ASK_SIDES, block_points, 0},
};
const size_t PATH_COUNT = sizeof PATHS / sizeof *PATHS;

/* --- blocks and lists ------------------------------------------------------------------------------------------------ */

static size_t grid_blocks(const bench_camera *c) {
  return (size_t)((c->width + BLOCK_EDGE - 1) / BLOCK_EDGE) * ((c->height + BLOCK_EDGE - 1) / BLOCK_EDGE);
}

size_t path_blocks(const path *p, const path_job *job) {
  switch (p->rays) {
  case RAYS_CAMERA: return grid_blocks(job->camera);
  case RAYS_SHADOW: return (job->lists.shadow_count + BLOCK - 1) / BLOCK;
  case RAYS_RANDOM: return (job->lists.random_count + BLOCK - 1) / BLOCK;
  case RAYS_POINTS: return (job->lists.point_count + BLOCK - 1) / BLOCK;
  case RAY_KINDS: break;
  }
  return 0;
}

path_lane *path_lane_new(const quoin_scene *scene) {
  path_lane *lane = calloc(1, sizeof *lane);
  if (lane && quoin_work_new(scene, &lane->work) != QUOIN_OK) {
    free(lane);
    lane = NULL;
  }
  return lane;
}
void path_lane_free(path_lane *lane) {
  if (lane) {
    quoin_work_free(lane->work);
    free(lane);
  }
}

/* From every hit of blocks that are spread over the grid, in the order of the tiles, towards a light behind the camera's shoulder. */
static int make_shadow(path_job *job, path_lane *lane, size_t n) {
  const bench_camera *c = job->camera;
  path_lists *l = &job->lists;
  double light[3], u = 0, v = 0;
  for (int a = 0; a < 3; a++) {
    u += c->u[a] * c->u[a];
    v += c->v[a] * c->v[a];
  }
  for (int a = 0; a < 3; a++) {
    light[a] = 0.4 * c->u[a] / sqrt(u) + 0.6 * c->v[a] / sqrt(v) - c->d[a];
  }
  double off = 1e-6 * sqrt(u + v);
  size_t all = grid_blocks(c), wanted = (n + BLOCK - 1) / BLOCK, step = all / wanted ? all / wanted : 1;
  l->shadow = malloc((all / step + 1) * BLOCK * sizeof *l->shadow);
  if (!l->shadow) {
    return 0;
  }
  double begin = bench_now();
  for (size_t b = step / 2; b < all && bench_now() - begin < 5; b += step) {
    size_t count = tiles(c, b, lane);
    fail(lane, quoin_first_hits(job->scene, lane->work, count, lane->rays, lane->hits));
    for (size_t k = 0; k < count; k++) {
      const quoin_hit *h = &lane->hits[k];
      if (h->found) {
        quoin_ray *r = &l->shadow[l->shadow_count++];
        for (int a = 0; a < 3; a++) {
          r->o[a] = h->point[a] + off * h->normal[a];
          r->d[a] = light[a];
        }
        r->from = 0;
        r->to = INFINITY;
      }
    }
  }
  return 1;
}

static int make_random(path_job *job, size_t n, int want_rays, int want_points) {
  quoin_scene_info info;
  quoin_scene_get_info(job->scene, &info);
  path_lists *l = &job->lists;
  l->random = want_rays ? malloc(n * sizeof *l->random) : NULL;
  l->points = want_points ? malloc(3 * n * sizeof *l->points) : NULL;
  if ((want_rays && !l->random) || (want_points && !l->points)) {
    return 0;
  }
  uint64_t state = 20260101;
  double radius = 0;
  for (int a = 0; a < 3; a++) {
    radius += (info.box_max[a] - info.box_min[a]) * (info.box_max[a] - info.box_min[a]) / 4;
  }
  radius = sqrt(radius);
  for (size_t k = 0; want_rays && k < n; k++) { /* from a point of the ball's surface to a point of the box */
    quoin_ray *r = &l->random[l->random_count++];
    double z = bench_between(&state, -1, 1), p = bench_between(&state, 0, 6.283185307179586), q = sqrt(1 - z * z), length = 0;
    const double from[3] = {q * cos(p), q * sin(p), z};
    for (int a = 0; a < 3; a++) {
      r->o[a] = (info.box_min[a] + info.box_max[a]) / 2 + radius * from[a];
      r->d[a] = bench_between(&state, info.box_min[a], info.box_max[a]) - r->o[a];
      length += r->d[a] * r->d[a];
    }
    for (int a = 0; a < 3; a++) {
      r->d[a] /= sqrt(length);
    }
    r->from = 0;
    r->to = INFINITY;
  }
  for (size_t k = 0; want_points && k < n; k++) {
    for (int a = 0; a < 3; a++) {
      l->points[3 * k + (size_t)a] = bench_between(&state, info.box_min[a], info.box_max[a]);
    }
    l->point_count++;
  }
  return 1;
}

int path_lists_make(path_job *job, path_lane *lane, size_t n, int want_shadow, int want_random, int want_points) {
  return (!want_shadow || make_shadow(job, lane, n)) && make_random(job, n, want_random, want_points);
}
void path_lists_free(path_job *job) {
  free(job->lists.shadow);
  free(job->lists.random);
  free(job->lists.points);
}
