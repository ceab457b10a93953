/* The first boundary along a ray, with what a picture wants of it. Which boundary it is, is exact; point, normal and (u, v)
   are doubles made for that one hit.

   Legend: y = o - pivot + t d; a leaf's half-space q <= 0 has its gradient outward of the leaf: a plane's n, a quadric's
   2 sum s_i X_i row_i + 2 l row_2, a superquadric's by the chain rule. Where the leaf is taken away (its literal is negated) the solid's
   outward normal is the other way. */
#include "query/look.h"

#include <math.h>

static int has_direction(const double g[3]) {
  return g[0] * 0 + g[1] * 0 + g[2] * 0 == 0 && (g[0] != 0 || g[1] != 0 || g[2] != 0);
}
/* A power of two that brings x near to 1. */
static double down(double x) {
  return x > 0 && isfinite(x) ? ldexp(1, -(int)fmax(-1000, fmin(1000, ilogb(x)))) : 1;
}

/* The gradient at y, or a multiple of it: with the rows times `rows`, y and the constants times `place`. (A superquadric's slope is no multiple of one elsewhere; its X
   is about 1 at most anyway.) */
QN_INLINE void slope_at(const qn_quadric_shadow *q, int super, const double y[3], double rows, double place, double g[3]) {
  const double to_x = super ? 1 : rows, to_y = super ? 1 : place;
  double X[3], slope[3];
  for (int i = 0; i < 3; i++) {
    const double *row = q->row[i];
    X[i] = (((row[0] * to_x) * (y[0] * to_y) + (row[1] * to_x) * (y[1] * to_y)) + (row[2] * to_x) * (y[2] * to_y)) + row[3] * to_x * to_y;
    slope[i] = q->s[i] * X[i] + (i == 2 ? q->l * to_x * to_y : 0);
  }
  if (super) {
    qn_superquadric_gradient(q->s[0], q->s[1], X, slope);
  }
  g[0] = g[1] = g[2] = 0;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      g[j] += slope[i] * (q->row[i][j] * rows);
    }
  }
}

void qn_half_gradient(const quoin_scene *scene, const qn_half *half, const double y[3], double g[3]) {
  g[0] = g[1] = g[2] = 0;
  if (half->kind == QN_PLANE) {
    for (int j = 0; j < 3; j++) {
      g[j] = scene->planes[half->shadow].n[j];
    }
    return;
  }
  const qn_quadric_shadow *q = &scene->quadrics[half->shadow];
  slope_at(q, half->kind == QN_SUPER_BODY, y, 1, 1, g);
  if (!has_direction(g)) { /* beyond the doubles, or below: powers of two are taken out of the rows, and of places where the slope is a multiple of */
    double rows = 0, place = 0;
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++) {
        rows = fmax(rows, fabs(q->row[i][j]));
      }
      place = fmax(place, fabs(y[i]));
    }
    slope_at(q, half->kind == QN_SUPER_BODY, y, down(rows), down(place), g);
  }
}

/* To unit length, turned by way; left at zero when it has no direction. */
QN_INLINE void unit(double g[3], double way) {
  double most = fmax(fabs(g[0]), fmax(fabs(g[1]), fabs(g[2])));
  if (!has_direction(g)) {
    g[0] = g[1] = g[2] = 0;
    return;
  }
  double x = g[0] / most, y = g[1] / most, z = g[2] / most, scale = way / sqrt(x * x + y * y + z * z);
  g[0] = x * scale + 0.0, g[1] = y * scale + 0.0, g[2] = z * scale + 0.0; /* no negative zeros */
}

/* t: correctly rounded; index: the half-space, in scene->halves, of the leaf `part`. */
static quoin_status describe(quoin_work *work, const quoin_ray *ray, double t, uint32_t part, uint32_t index, int leaving, quoin_hit *out) {
  const quoin_scene *scene = work->scene;
  const qn_leaf *leaf = &scene->leaves[part];
  const qn_half *half = &scene->halves[index];
  out->found = 1, out->leaving = leaving, out->part = part, out->role = half->role, out->t = t;
  out->uv[0] = out->uv[1] = 0;
  double y[3];
  for (int i = 0; i < 3; i++) {
    out->point[i] = ray->o[i] + out->t * ray->d[i];
    y[i] = (ray->o[i] - leaf->pivot[i]) + out->t * ray->d[i];
  }
  qn_half_gradient(scene, half, y, out->normal);
  unit(out->normal, leaf->negated ? -1 : 1);
  const qn_local *local = qn_query_local(work, part);
  if (!local) {
    return QUOIN_E_MEMORY;
  }
  const qn_prim_row *row = &qn_prims[leaf->prim];
  if (!local->singular && row->uv) {
    double x[3];
    for (int i = 0; i < 3; i++) {
      const double *m = local->inverse + 4 * i;
      x[i] = ((m[0] * out->point[0] + m[1] * out->point[1]) + m[2] * out->point[2]) + m[3];
    }
    row->uv(local->args, local->arg_count, local->placed ? local->placement : NULL, half->role, x, out->uv);
  }
  return QUOIN_OK;
}

/* The same for a sphere that is only shifted, from its piece alone, which the walk has just read: a leaf's own numbers, and where it is in the model, lie far
   from one another in memory. */
static void describe_ball(const quoin_ray *ray, double t, const qn_piece_sphere *ball, int leaving, quoin_hit *out) {
  out->found = 1, out->leaving = leaving, out->part = ball->head.leaf, out->role = QUOIN_BODY, out->t = t;
  double x[3];
  for (int i = 0; i < 3; i++) {
    out->point[i] = ray->o[i] + t * ray->d[i];
    x[i] = ((ray->o[i] - ball->centre[i]) + t * ray->d[i]) - (double)ball->rest[i];
    out->normal[i] = x[i];
  }
  unit(out->normal, ball->head.flags & QN_BALL_NEGATED ? -1 : 1);
  qn_prims[QN_SPHERE].uv(NULL, 0, NULL, QUOIN_BODY, x, out->uv);
}

/* What is there, where something is. */
static quoin_status describe_seen(quoin_work *work, const quoin_ray *ray, const qn_seen *seen, quoin_hit *hit) {
  const quoin_scene *scene = work->scene;
  if (seen->surface == QUOIN_NO_SURFACE) {
    *hit = (quoin_hit){.part = QUOIN_NO_PART};
    return QUOIN_OK;
  }
  const uint32_t line = scene->line_of ? scene->line_of[seen->leaf] : UINT32_MAX;
  if (line != UINT32_MAX) {
    const qn_piece_sphere *ball = (const qn_piece_sphere *)(const void *)((const char *)scene->lines + (size_t)line * 64);
    if (ball->head.kind == QN_PIECE_SPHERE && ball->head.flags & QN_BALL_SHIFTED) {
      describe_ball(ray, seen->t, ball, seen->leaving, hit);
      return QUOIN_OK;
    }
  }
  const qn_leaf *leaf = &scene->leaves[seen->leaf];
  uint32_t half = leaf->half0;
  while (half + 1 < leaf->half0 + leaf->halves && scene->halves[half].surface != seen->surface) {
    half++;
  }
  return describe(work, ray, seen->t, seen->leaf, half, seen->leaving, hit);
}

typedef struct asked { quoin_work *work; const quoin_ray *rays; quoin_hit *out; } asked;

static quoin_status each_seen(void *user, size_t i, const qn_seen *seen) {
  const asked *a = user;
  return describe_seen(a->work, &a->rays[i], seen, &a->out[i]);
}

static int are_given(const quoin_scene *scene, const quoin_work *work, size_t n, const quoin_ray *rays, const void *out) {
  return scene && work && work->scene == scene && (n == 0 || (rays && out));
}

quoin_status quoin_first_hits(const quoin_scene *scene, quoin_work *work, size_t n, const quoin_ray *rays, quoin_hit *out) {
  if (!are_given(scene, work, n, rays, out)) {
    return QUOIN_E_ARGUMENT;
  }
  return qn_look(work, n, rays, NULL, QN_LOOK_T, each_seen, &(asked){work, rays, out});
}

quoin_status quoin_first_hit(const quoin_scene *scene, quoin_work *work, const quoin_ray *ray, quoin_hit *out) {
  if (!are_given(scene, work, 1, ray, out) || !qn_is_ray(ray)) {
    return QUOIN_E_ARGUMENT;
  }
  qn_seen seen;
  const quoin_status status = qn_look_alone(work, ray, QUOIN_NO_SURFACE, QN_LOOK_T, &seen);
  return status == QUOIN_OK ? describe_seen(work, ray, &seen, out) : status;
}

quoin_status quoin_first_spots(const quoin_scene *scene, quoin_work *work, size_t n, const quoin_ray *rays, unsigned want, quoin_spot *out) {
  if (!are_given(scene, work, n, rays, out) || (want & ~(unsigned)QUOIN_WANT_T)) {
    return QUOIN_E_ARGUMENT;
  }
  const unsigned look = want & QUOIN_WANT_T ? QN_LOOK_T : 0;
  if (n != 1) {
    return qn_look_spots(work, n, rays, look, out);
  }
  qn_seen seen;
  const quoin_status status = qn_is_ray(rays) ? qn_look_alone(work, rays, QUOIN_NO_SURFACE, look | QN_LOOK_SURFACE, &seen) : QUOIN_E_ARGUMENT;
  if (status == QUOIN_OK) {
    *out = qn_spot_of(&seen);
  }
  return status;
}

enum { RUN = 4096 }; /* rays between two questions whether to stop */

quoin_status quoin_rays_blocked(const quoin_scene *scene, quoin_work *work, size_t n, const quoin_ray *rays, const quoin_progress *progress, uint8_t *blocked) {
  quoin_status status = are_given(scene, work, n, rays, blocked) ? QUOIN_OK : QUOIN_E_ARGUMENT;
  for (size_t at = 0; at < n && status == QUOIN_OK; at += RUN) {
    if (progress && progress->report && progress->report(progress->user, (double)at / (double)n)) {
      return QUOIN_E_CANCELLED;
    }
    status = qn_look_blocked(work, n - at < RUN ? n - at : RUN, rays + at, NULL, blocked + at);
  }
  return status;
}
