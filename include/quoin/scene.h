/* quoin: a compiled scene, frozen, and the questions asked of it: a point's side, a ray's intervals, the first hit. */
#ifndef QUOIN_SCENE_H
#define QUOIN_SCENE_H

#include "quoin/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Threads: any number of them may ask one scene at the same time, each with a quoin_work of its own. What a call writes is to be read after QUOIN_OK only,
   unless the call says otherwise. Texts live as long as the scene, those of a list as long as the list. */
typedef struct quoin_scene quoin_scene; /* immutable; shared by any number of threads */
typedef struct quoin_work quoin_work;   /* one thread's scratch for one scene */

typedef struct quoin_compile_options {
  unsigned threads;        /* 0: as many as the machine has */
  quoin_progress progress; /* report may be null */
  const char *snap;        /* a decimal, 0 or more: surfaces no further apart are made one (quoin_scene_snapped says which); null, the
                              default: none, surfaces are as the model says. Read during the call only */
} quoin_compile_options;
QUOIN_API quoin_compile_options quoin_compile_options_default(void);

/* Compiles a model: finds equal surfaces, simplifies, bounds, builds the hierarchy. The model is frozen from then on;
   it may be freed before the scene. Warnings are added to the model's diagnostics. options may be null.
   QUOIN_E_MODEL: the model has errors (a text that was refused, a file that could not be read). QUOIN_E_NUMBER, QUOIN_E_ARGUMENT: `snap` is not a decimal, or is negative.
   QUOIN_E_LIMIT: too much of something, also of surfaces near one another for `snap` (a diagnostic says so).
   Cost: n log n in the number of leaves; with `snap` about three times that. */
QUOIN_API quoin_status quoin_scene_compile(quoin_model *model, const quoin_compile_options *options, quoin_scene **out);
QUOIN_API void quoin_scene_free(quoin_scene *scene); /* null is allowed; every quoin_work of it must be freed first */

typedef struct quoin_scene_info {
  size_t leaves;            /* primitives that were kept */
  size_t surfaces;          /* half-spaces of those leaves */
  size_t distinct_surfaces; /* after equal surfaces were made one */
  int empty;                /* no point is inside: nothing is left after simplification, or equal surfaces show it (a solid minus itself, or minus one that
                               holds it by the same surfaces). Other empty solids are not called so: 0 says nothing */
  int unbounded;            /* no bounding box could be given */
  double box_min[3], box_max[3]; /* holds the solid; infinite where unbounded. A leaf's box is exact, rounded outward, where its frame lies along
                                    the axes and its sizes are rational, else tight to the last bits, as a half-space's and a superquadric's
                                    always; a tree's is the boxes' combination */
  size_t memory;            /* bytes held */
  size_t dropped;           /* primitives that were not kept: nothing depends on them */
  size_t gates;             /* of the program: unions and intersections after flattening */
  size_t terms, copies;     /* of the normal form that packets walk: terms, and leaves in them beyond one of each; 0: there is none */
  size_t shared;            /* unions that are in several terms, uncopied, since copies had run out */
} quoin_scene_info;
QUOIN_API void quoin_scene_get_info(const quoin_scene *scene, quoin_scene_info *out);

/* The compiled scene as stable text: surfaces, leaves, program. For reading and for tests. */
QUOIN_API quoin_status quoin_scene_write_text(const quoin_scene *scene, quoin_write_fn write, void *user);

/* A part: a leaf as the user would name it: the innermost name("...") around it, else "word@line:col" of a text, "word#N" of the N-th node of a model that calls built. */
typedef uint32_t quoin_part;
#define QUOIN_NO_PART UINT32_MAX
QUOIN_API const char *quoin_part_name(const quoin_scene *scene, quoin_part part); /* "" for QUOIN_NO_PART, and for no scene */

/* A surface of a part: the body, cap 0, cap 1, or face k of a solid made of planes. */
typedef enum quoin_role { QUOIN_BODY = 0, QUOIN_CAP0 = 1, QUOIN_CAP1 = 2, QUOIN_FACE = 3 /* + k */ } quoin_role;
/* Writes "body", "cap0", "cap1" or "face K"; returns as snprintf does. */
QUOIN_API int quoin_role_text(uint32_t role, char *text, size_t size);

/* A surface as the user would name it: of several parts that share it, the first. */
typedef struct quoin_near_face {
  const char *name; /* as of quoin_part_name */
  uint32_t role;
  const char *file; /* where the part stands; line 0: it was made by calls */
  uint32_t line, column;
} quoin_near_face;

/* Two surfaces that nearly coincide. docs/exactness.md says what their gap is. */
typedef struct quoin_near {
  double gap;              /* the double nearest to it */
  const char *exact;       /* the gap exactly, as a decimal or a fraction, where it is rational and this takes at most 40 bytes; else "" */
  int opposite;            /* the two parts lie on opposite sides of them */
  quoin_near_face face[2]; /* the one that moves when they are snapped, and the one that stands for both */
} quoin_near;

/* Finds the surfaces of a compiled scene that nearly coincide: whose gap is `limit` (a decimal) or less, and whose parts' boxes come as near;
   the smallest gaps first. limit null: 10^-5 of the largest coordinate of the scene, as far as two roundings of one number to six digits can be
   apart. Nothing is changed. Free the list before the scene. QUOIN_E_NUMBER, QUOIN_E_ARGUMENT: as of quoin_scene_compile.
   Cost: n log n in the number of surfaces, and some 10 us a pair; a search that meets very many pairs is cut (quoin_near_complete). */
typedef struct quoin_near_list quoin_near_list;
QUOIN_API quoin_status quoin_near_find(const quoin_scene *scene, const char *limit, quoin_near_list **out);
QUOIN_API void quoin_near_free(quoin_near_list *list); /* null is allowed */
QUOIN_API size_t quoin_near_count(const quoin_near_list *list); /* 0 for null */
QUOIN_API int quoin_near_complete(const quoin_near_list *list); /* 0: there may be more pairs */
QUOIN_API double quoin_near_limit(const quoin_near_list *list);
QUOIN_API quoin_status quoin_near_get(const quoin_near_list *list, size_t index, quoin_near *out); /* texts live as long as the list */
/* What was moved, in the order of the file, of a scene compiled with `snap`; else null. Belongs to the scene. */
QUOIN_API const quoin_near_list *quoin_scene_snapped(const quoin_scene *scene);

/* Scratch for one thread. Freed with quoin_work_free before its scene. */
QUOIN_API quoin_status quoin_work_new(const quoin_scene *scene, quoin_work **out);
QUOIN_API void quoin_work_free(quoin_work *work);

/* What was done and what was skipped, summed since the work was made. */
typedef struct quoin_stats {
  uint64_t rays, points;   /* answered */
  uint64_t packets;        /* runs of rays that were walked together, or one ray by the same code */
  uint64_t nodes;          /* hierarchy nodes visited */
  uint64_t leaves;         /* leaves solved: in a packet, once for each of its vectors */
  uint64_t filter_sure;    /* half-spaces along a ray of the exact path that doubles certified; in packets all are, or the ray is one of exact_rays */
  uint64_t exact_signs;    /* signs taken in exact arithmetic */
  uint64_t exact_orders;   /* orders of two roots taken in exact arithmetic */
  uint64_t exact_rays;     /* rays answered whole by the exact path */
  uint64_t exact_points;   /* points that wide code could not certify and the exact path answered; the other points took nothing else */
  uint64_t exact_roundings;/* reported parameters rounded in exact arithmetic */
  uint64_t exact_forms;    /* exact surfaces made on demand */
} quoin_stats;
QUOIN_API void quoin_work_stats(const quoin_work *work, quoin_stats *out);

typedef enum quoin_side { QUOIN_OUTSIDE = 0, QUOIN_BOUNDARY = 1, QUOIN_INSIDE = 2 } quoin_side;

/* The side of a point (docs/exactness.md says what boundary is). Exact. The doubles mean themselves. */
QUOIN_API quoin_status quoin_point_side(const quoin_scene *scene, quoin_work *work, const double point[3], quoin_side *out);
/* n points, xyz after xyz. */
QUOIN_API quoin_status quoin_point_sides(const quoin_scene *scene, quoin_work *work, size_t n, const double *points, quoin_side *out);
/* A point as decimals: "0.1" is 1/10. QUOIN_E_NUMBER when a text is not a finite decimal number (blanks are not allowed), QUOIN_E_LIMIT when its exponent is
   beyond 4000 or it is too long. */
QUOIN_API quoin_status quoin_point_side_text(const quoin_scene *scene, quoin_work *work, const char *const point[3], quoin_side *out);
/* n points as decimals, xyz after xyz. *done (may be null): how many were answered, all n with QUOIN_OK, else those before the point that the
   status is about. */
QUOIN_API quoin_status quoin_point_sides_text(const quoin_scene *scene, quoin_work *work, size_t n, const char *const *points, quoin_side *out,
                                              size_t *done);
/* The parts whose closed solids hold a point, in the order of the file: up to `size` of them into parts; *count is how many there are. Parts that do not
   matter to the solid anywhere are not among them; nor is one without a surface, such as a quadric that is all of space. */
QUOIN_API quoin_status quoin_point_parts(const quoin_scene *scene, quoin_work *work, const double point[3], quoin_part *parts, size_t size, size_t *count);
QUOIN_API quoin_status quoin_point_parts_text(const quoin_scene *scene, quoin_work *work, const char *const point[3], quoin_part *parts, size_t size, size_t *count);

/* A ray: o + t d. d need not be a unit vector and t is in its units. Answers lie in [from, to]; either may be infinite. QUOIN_E_ARGUMENT: o or d is not finite, d is zero,
   from or to is a nan, from is inf, to is -inf, or from > to; of an array with such a ray nothing that was written is an answer. */
typedef struct quoin_ray {
  double o[3], d[3];
  double from, to;
} quoin_ray;

/* An end of an interval: the parameter, correctly rounded (to nearest, ties to even) from the exact one; the part and
   the surface that make the end. At from and to, and at infinity, part is QUOIN_NO_PART. */
typedef struct quoin_end {
  double t;
  quoin_part part;
  uint32_t role;
} quoin_end;
typedef struct quoin_interval { quoin_end enter, leave; } quoin_interval;

/* A ray's answer. The arrays belong to the work and hold until its next call. Intervals are disjoint, of positive
   length and in increasing order (exactly; two ends may round to one double). */
typedef struct quoin_intervals {
  size_t count;
  const quoin_interval *inside;   /* stretches inside the solid */
  size_t boundary_count;
  const quoin_interval *boundary; /* stretches that run in the boundary */
  size_t contact_count;
  const quoin_end *contacts;      /* points where the ray touches the solid between stretches outside it */
} quoin_intervals;

enum { QUOIN_WANT_BOUNDARY = 1, QUOIN_WANT_CONTACTS = 2 };

/* All intervals of a ray, exact. want: 0 or a sum of QUOIN_WANT_*. */
QUOIN_API quoin_status quoin_ray_intervals(const quoin_scene *scene, quoin_work *work, const quoin_ray *ray, unsigned want, quoin_intervals *out);
/* Many rays: calls each(user, i, answer) for every ray in order; a non-zero return stops with QUOIN_E_CANCELLED. */
QUOIN_API quoin_status quoin_ray_intervals_many(const quoin_scene *scene, quoin_work *work, size_t n, const quoin_ray *rays, unsigned want,
                                                int (*each)(void *user, size_t i, const quoin_intervals *answer), void *user);
/* The ray as decimals: origin xyz, direction xyz; from and to as decimals too, or null for -inf and inf. */
QUOIN_API quoin_status quoin_ray_intervals_text(const quoin_scene *scene, quoin_work *work, const char *const ray[6], const char *from, const char *to,
                                                unsigned want, quoin_intervals *out);

/* Many rays as decimals, six texts after six: calls each(user, i, answer) for every ray in order, as quoin_ray_intervals_many does; a status about
   a ray is returned after the answers to all rays before it. */
QUOIN_API quoin_status quoin_ray_intervals_many_text(const quoin_scene *scene, quoin_work *work, size_t n, const char *const *rays, const char *from,
                                                     const char *to, unsigned want, int (*each)(void *user, size_t i, const quoin_intervals *answer),
                                                     void *user);

/* The first boundary at or after from (and not after to). Not found: t, point, normal and uv are 0, part is QUOIN_NO_PART. */
typedef struct quoin_hit {
  int found;
  int leaving;      /* the ray was inside before it: it leaves there */
  double t;         /* correctly rounded */
  double point[3];  /* o + t d in doubles */
  double normal[3]; /* unit, outward from the solid, in doubles; zero at a singular point */
  double uv[2];     /* surface parameters: angle about the axis in [0,1), and height or latitude in [0,1] */
  quoin_part part;
  uint32_t role;
} quoin_hit;
QUOIN_API quoin_status quoin_first_hit(const quoin_scene *scene, quoin_work *work, const quoin_ray *ray, quoin_hit *out);
QUOIN_API quoin_status quoin_first_hits(const quoin_scene *scene, quoin_work *work, size_t n, const quoin_ray *rays, quoin_hit *out);

/* What a ray meets first, in short. */
typedef struct quoin_spot {
  double t;         /* see quoin_first_spots */
  uint32_t surface; /* the scene's number of the surface, below quoin_scene_info.distinct_surfaces; QUOIN_NO_SURFACE: no boundary is met */
  uint32_t leaving; /* 1: the ray was inside before */
} quoin_spot;
#define QUOIN_NO_SURFACE UINT32_MAX

enum { QUOIN_WANT_T = 4 };

/* The first boundaries of n rays, without what a picture wants of them: some two times as fast as quoin_first_hits. Which surface is met is exact. t is correctly
   rounded when want has QUOIN_WANT_T; else it is only near the true parameter (an error that is far below the distance to any other boundary,
   but not the same on every machine). Neighbours in the array that go the same way are the fastest, 64 at a time. Threads: one work each. */
QUOIN_API quoin_status quoin_first_spots(const quoin_scene *scene, quoin_work *work, size_t n, const quoin_ray *rays, unsigned want, quoin_spot *out);

/* Whether each of n rays is inside the solid anywhere between from and to: blocked[i] is 1 where quoin_ray_intervals would give at least one interval, else 0.
   Exact, and faster than the first boundary: a ray is done at the first sign of matter. For shadows, visibility and collisions along a segment (from = 0, to = 1 with
   d the way from one end to the other). progress: null, or asked now and then whether to stop (QUOIN_E_CANCELLED; `blocked` is then incomplete). Threads:
   one work each. */
QUOIN_API quoin_status quoin_rays_blocked(const quoin_scene *scene, quoin_work *work, size_t n, const quoin_ray *rays, const quoin_progress *progress, uint8_t *blocked);

/* A grid of rays, width by height, as a camera takes it: with s = (x + 0.5)/width and r = (y + 0.5)/height, the ray of column
   x and row y starts at (o + s u) + r v and goes along d; or, when `converging`, starts at o and goes along (d + s u) + r v; each
   coordinate computed in doubles in that order, and the ray is exactly those doubles. */
typedef struct quoin_grid {
  double o[3], u[3], v[3], d[3];
  size_t width, height;
  int converging;
  double from, to; /* as in quoin_ray */
} quoin_grid;

/* The first boundaries of the rays in columns x0 to x1 - 1 and rows y0 to y1 - 1 of a grid, row after row into out. Which surface is
   met is exact. t is correctly rounded when want has QUOIN_WANT_T; else it is only near the true parameter (an error that is far below
   the distance to any other boundary, but not the same on every machine): enough for pictures, and faster.
   Rays go in packets of 8 by 8; tiles whose sides are multiples of 8 are the fastest. Threads: one work each. */
QUOIN_API quoin_status quoin_grid_hits(const quoin_scene *scene, quoin_work *work, const quoin_grid *grid, size_t x0, size_t y0, size_t x1, size_t y1,
                                       unsigned want, quoin_spot *out);

/* Where a ray's intervals are in an array. */
typedef struct quoin_run { uint32_t first, count; } quoin_run;

/* All intervals of some rays of a grid. The arrays belong to the work and hold until its next call. Ray k's intervals, in increasing order, are
   inside[inside_of[k].first] and the inside_of[k].count - 1 after it; rays follow one another in `inside` in no particular order. */
typedef struct quoin_grid_answer {
  size_t rays;                  /* row after row */
  const quoin_run *inside_of;   /* by ray */
  size_t count;
  const quoin_interval *inside; /* as in quoin_intervals */
  const quoin_run *boundary_of; /* null unless asked for */
  size_t boundary_count;
  const quoin_interval *boundary;
} quoin_grid_answer;

/* All intervals of the rays in columns x0 to x1 - 1 and rows y0 to y1 - 1 of a grid: what quoin_ray_intervals says of each, several times as fast. want: 0 or
   QUOIN_WANT_BOUNDARY. Tiles whose sides are multiples of 8 are the fastest; parts of some thousand rays keep answers in the nearer caches. Threads: one work each. */
QUOIN_API quoin_status quoin_grid_intervals(const quoin_scene *scene, quoin_work *work, const quoin_grid *grid, size_t x0, size_t y0, size_t x1, size_t y1,
                                            unsigned want, quoin_grid_answer *out);

#ifdef __cplusplus
}
#endif
#endif
