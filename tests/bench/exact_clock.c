/* What bench_exact knows more than bench_scenes: how many leaves rays meet, and the clock of exact arithmetic.

   Each way into exact arithmetic from the code that works with doubles is wrapped, and the outermost call is timed.

   Small steps on single integers (a point's coordinates) are not wrapped: a look at the clock would cost more than they. */
#include "exact_clock.h"

#include "ray/around_cells.h"
#include "ray/scratch.h"
#include "scene/rounding.h"

#include <stdlib.h>

/* --- leaves that rays meet -------------------------------------------------------------------------------------------- */

typedef struct meeting { const quoin_scene *scene; qn_scratch *scratch; size_t met; } meeting;

static void meet(void *user, uint32_t leaf) {
  meeting *m = user;
  const qn_span *spans;
  int vague;
  if (m->scene->leaves[leaf].gate != QN_NO_GATE) {
    size_t count = qn_leaf_spans(m->scratch, leaf, 0, &spans, &vague);
    m->met += count > 0 && spans[count - 1].hi.t > 0;
  }
}

double bench_leaves_met(const quoin_scene *scene, const bench_camera *camera, size_t n) {
  meeting m = {scene, NULL, 0};
  uint64_t g = 3, nodes = 0;
  if (qn_scratch_new(scene, &m.scratch) != QUOIN_OK) {
    return -1;
  }
  for (size_t r = 0; r < n; r++) {
    double o[3];
    qn_line line;
    bench_camera_ray(camera, (unsigned)(bench_u64(&g) % camera->width), (unsigned)(bench_u64(&g) % camera->height), o);
    qn_scratch_begin(m.scratch);
    qn_line_from_doubles(o, camera->d, &line);
    qn_solve_begin(m.scratch, &line);
    qn_bvh_line(&scene->bvh, line.o, line.d, 0, HUGE_VAL, meet, &m, &nodes);
    for (size_t i = 0; i < scene->unbounded_count; i++) {
      meet(&m, scene->unbounded[i]);
    }
  }
  qn_scratch_free(m.scratch);
  return (double)m.met / (double)n;
}

/* --- the clocks --------------------------------------------------------------------------------------------------------- */

_Thread_local exact_clock bench_exact_clock;
static _Thread_local int exact_depth, woven_depth;

static double enter(int *depth) {
  return (*depth)++ == 0 ? bench_now() : 0;
}
static void leave(int *depth, double begin, double *spent) {
  if (--*depth == 0) {
    *spent += bench_now() - begin;
  }
}

/* A function that was wrapped: its type, name, parameters, and the names of these. */
#define TIMED(clock, type, name, parameters, arguments)       \
  type __real_##name parameters;                              \
  type __wrap_##name parameters;                              \
  type __wrap_##name parameters {                             \
    double begin = enter(&clock##_depth);                     \
    type result = __real_##name arguments;                    \
    leave(&clock##_depth, begin, &bench_exact_clock.clock);   \
    return result;                                            \
  }
#define TIMED_VOID(clock, name, parameters, arguments)        \
  void __real_##name parameters;                              \
  void __wrap_##name parameters;                              \
  void __wrap_##name parameters {                             \
    double begin = enter(&clock##_depth);                     \
    __real_##name arguments;                                  \
    leave(&clock##_depth, begin, &bench_exact_clock.clock);   \
  }

TIMED(exact, const qn_exact_surface *, qn_scene_exact, (const quoin_scene *scene, uint32_t surface, int *made), (scene, surface, made))
TIMED(exact, const qn_rounding *, qn_rounding_make, (const quoin_scene *scene, uint32_t surface, uint64_t *made), (scene, surface, made))
TIMED(exact, qn_form_result, qn_scene_leaf_forms, (const quoin_scene *scene, uint32_t leaf, qn_ctx *ctx, qn_half_form **halves, size_t *count),
      (scene, leaf, ctx, halves, count))
TIMED_VOID(exact, qn_line_make_exact, (qn_ctx *ctx, qn_line *line), (ctx, line))
TIMED_VOID(exact, qn_line_quad, (qn_ctx *ctx, const qn_line *line, const qn_exact_surface *surface, qn_quad *out), (ctx, line, surface, out))
TIMED_VOID(exact, qn_quad_make, (qn_ctx *ctx, qn_xint a, qn_xint h, qn_xint c, qn_quad *out), (ctx, a, h, c, out))
TIMED(exact, qn_quad_shape, qn_quad_kind, (const qn_quad *q), (q))
TIMED(exact, int, qn_root_cmp, (qn_ctx *ctx, qn_root x, qn_root y), (ctx, x, y))
TIMED(exact, double, qn_root_to_double, (qn_ctx *ctx, qn_root x), (ctx, x))
TIMED(exact, int, qn_root_rational, (qn_ctx *ctx, qn_root x, qn_int *num, qn_int *den), (ctx, x, num, den))
TIMED_VOID(exact, qn_root_between, (qn_ctx *ctx, qn_root x, qn_root y, qn_int *num, qn_int *den), (ctx, x, y, num, den))
TIMED_VOID(exact, qn_root_below, (qn_ctx *ctx, qn_root x, qn_int *num, qn_int *den), (ctx, x, num, den))
TIMED_VOID(exact, qn_root_above, (qn_ctx *ctx, qn_root x, qn_int *num, qn_int *den), (ctx, x, num, den))
TIMED(exact, int, qn_surface_sign_at, (qn_ctx *ctx, const qn_exact_surface *surface, const qn_point *point), (ctx, surface, point))
TIMED(exact, quoin_status, qn_around,
      (const quoin_scene *scene, qn_scratch *scratch, const qn_point *point, const qn_near_leaf *leaves, size_t leaf_count, const uint32_t *near_halves,
       size_t near_count, int how, quoin_side *out),
      (scene, scratch, point, leaves, leaf_count, near_halves, near_count, how, out))
TIMED(exact, int, qn_cells_list, (qn_ctx *ctx, size_t n, qn_germ *germs, const qn_int *line, int (*emit)(void *user, const int8_t *signs), void *user),
      (ctx, n, germs, line, emit, user))
TIMED(exact, int, qn_cells_fan,
      (qn_ctx *ctx, size_t n, const qn_germ *germs, const qn_int *line, int (*emit)(void *user, const int8_t *signs), void *user), (ctx, n, germs, line, emit, user))

TIMED(woven, quoin_status, qn_weave, (const quoin_scene *scene, qn_scratch *scratch, qn_line *line, const qn_range *range, unsigned want, qn_woven *out),
      (scene, scratch, line, range, want, out))
struct qn_query_point; /* of query/work.h, which has a qn_cells of its own */
TIMED(woven, quoin_status, qn_query_near, (quoin_work *work, struct qn_query_point *point, int all), (work, point, all))
