/* All stretches of a ray, as the public answer: places become correctly rounded parameters, ends get their part and surface. */
#include "query/look.h"
#include "query/sheaf.h"

#include <math.h>
#include <string.h>

static quoin_end end_of(quoin_work *work, qn_line *line, const qn_stop *stop) {
  quoin_end end = {.t = qn_place_round(work->scene, work->scratch, line, &stop->place), .part = QUOIN_NO_PART, .role = QUOIN_BODY};
  if (stop->leaf != UINT32_MAX) {
    end.part = stop->leaf;
    end.role = stop->half == UINT32_MAX ? QUOIN_BODY : work->scene->halves[stop->half].role;
  }
  return end;
}

static quoin_status stretches(quoin_work *work, qn_line *line, size_t n, const qn_stretch *from, quoin_interval **to, size_t *capacity) {
  if (!qn_grow(work->mem, to, capacity, n)) {
    return QUOIN_E_MEMORY;
  }
  for (size_t i = 0; i < n; i++) {
    (*to)[i] = (quoin_interval){end_of(work, line, &from[i].enter), end_of(work, line, &from[i].leave)};
  }
  return QUOIN_OK;
}

static quoin_status answer(quoin_work *work, qn_line *line, const qn_range *range, unsigned want, quoin_intervals *out) {
  qn_woven woven;
  quoin_status status = qn_weave(work->scene, work->scratch, line, range, want, &woven);
  if (status == QUOIN_OK) {
    status = stretches(work, line, woven.inside_count, woven.inside, &work->inside, &work->inside_capacity);
  }
  if (status == QUOIN_OK) {
    status = stretches(work, line, woven.boundary_count, woven.boundary, &work->boundary, &work->boundary_capacity);
  }
  if (status == QUOIN_OK && !qn_grow(work->mem, &work->contacts, &work->contact_capacity, woven.contact_count)) {
    status = QUOIN_E_MEMORY;
  }
  if (status != QUOIN_OK) {
    return status;
  }
  for (size_t i = 0; i < woven.contact_count; i++) {
    work->contacts[i] = end_of(work, line, &woven.contacts[i]);
  }
  *out = (quoin_intervals){woven.inside_count, work->inside, woven.boundary_count, work->boundary, woven.contact_count, work->contacts};
  return qn_scratch_ctx(work->scratch)->failed;
}

quoin_status quoin_ray_intervals(const quoin_scene *scene, quoin_work *work, const quoin_ray *ray, unsigned want, quoin_intervals *out) {
  if (!scene || !work || work->scene != scene || !ray || !out || want > (QUOIN_WANT_BOUNDARY | QUOIN_WANT_CONTACTS) || !qn_is_ray(ray)) {
    return QUOIN_E_ARGUMENT;
  }
  qn_line line;
  qn_query_begin(work);
  qn_line_from_doubles(ray->o, ray->d, &line);
  const qn_range range = {{.t = ray->from, .surface = QN_NO_SURFACE}, {.t = ray->to, .surface = QN_NO_SURFACE}};
  return answer(work, &line, &range, want, out);
}

/* Rays [0, n) as one packet, the ones it gives up woven; `first` is the number of rays[0] for who asked. */
static quoin_status together(const quoin_scene *scene, quoin_work *work, size_t n, const quoin_ray *rays, size_t first, unsigned want,
                             int (*each)(void *user, size_t i, const quoin_intervals *answer), void *user) {
  uint64_t sure;
  quoin_status status = qn_sheaf_rays(work, n, rays, NULL, 0, NULL, NULL, &sure);
  for (size_t i = 0; i < n && status == QUOIN_OK; i++) {
    const qn_sheaf *sheaf = work->sheaf;
    quoin_intervals one = {sheaf->first[i + 1] - sheaf->first[i], sheaf->found ? sheaf->found + sheaf->first[i] : NULL, 0, work->boundary, 0, work->contacts};
    if (!(sure >> i & 1)) {
      status = quoin_ray_intervals(scene, work, &rays[i], want, &one);
    }
    if (status == QUOIN_OK && each(user, first + i, &one) != 0) {
      status = QUOIN_E_CANCELLED;
    }
  }
  return status;
}

/* How far apart rays pass by the middle of the solid's box: the longest side of a box about those places. */
static double spread(const quoin_scene *scene, size_t n, const quoin_ray *rays) {
  double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, most = 0;
  for (size_t i = 0; i < n; i++) {
    double along = 0, dd = 0;
    for (int k = 0; k < 3; k++) {
      along += ((scene->min[k] + scene->max[k]) / 2 - rays[i].o[k]) * rays[i].d[k], dd += rays[i].d[k] * rays[i].d[k];
    }
    for (int k = 0; k < 3; k++) {
      double x = rays[i].o[k] + along / dd * rays[i].d[k];
      low[k] = x < low[k] ? x : low[k], high[k] = x > high[k] ? x : high[k];
    }
  }
  for (int k = 0; k < 3; k++) {
    most = high[k] - low[k] > most ? high[k] - low[k] : most;
  }
  return most;
}

size_t qn_rays_share(const quoin_scene *scene, size_t n, const quoin_ray *rays, size_t *alone) {
  double side = 0;
  if (*alone) {
    --*alone;
    return 1;
  }
  for (int k = 0; k < 3; k++) {
    side = fmax(side, scene->max[k] - scene->min[k]);
  }
  const int bounded = side < HUGE_VAL;
  n = n < QN_LANES ? n : QN_LANES;
  const size_t few = n < QN_FEW ? n : QN_FEW;
  if (n < 2 || !qn_rays_together(rays, few) || (bounded && !(spread(scene, few, rays) <= side / 8))) {
    *alone = few - 1;
    return 1;
  }
  return n > 2 * QN_FEW && qn_rays_together(rays, n) && !(bounded && !(spread(scene, n, rays) <= side / 3)) ? n : few;
}

quoin_status quoin_ray_intervals_many(const quoin_scene *scene, quoin_work *work, size_t n, const quoin_ray *rays, unsigned want,
                                      int (*each)(void *user, size_t i, const quoin_intervals *answer), void *user) {
  if (!scene || !work || work->scene != scene || !each || (n != 0 && !rays) || want > (QUOIN_WANT_BOUNDARY | QUOIN_WANT_CONTACTS)) {
    return QUOIN_E_ARGUMENT;
  }
  size_t alone = 0, good = 0; /* good: where the rays end that are known to be ones; the answers before a wrong one are given */
  for (size_t at = 0, count; at < n; at += count) {
    while (good < n && good - at < QN_LANES && qn_is_ray(&rays[good])) {
      good++;
    }
    if (good == at) {
      return QUOIN_E_ARGUMENT;
    }
    quoin_status status;
    count = want & QUOIN_WANT_CONTACTS ? 1 : qn_rays_share(scene, good - at, rays + at, &alone);
    if (want & QUOIN_WANT_CONTACTS) {
      quoin_intervals one;
      status = quoin_ray_intervals(scene, work, &rays[at], want, &one);
      status = status == QUOIN_OK && each(user, at, &one) != 0 ? QUOIN_E_CANCELLED : status;
    } else {
      status = together(scene, work, count, rays + at, at, want, each, user);
    }
    if (status != QUOIN_OK) {
      return status;
    }
  }
  return QUOIN_OK;
}

/* A decimal end of the range. */
static quoin_status place_text(quoin_work *work, const char *text, double none, qn_place *out, qn_num *value) {
  *out = (qn_place){.t = none, .surface = QN_NO_SURFACE};
  if (!text) {
    return QUOIN_OK;
  }
  quoin_status status = qn_query_number(work, text, value);
  if (status != QUOIN_OK) {
    return status;
  }
  qn_ctx *ctx = qn_scratch_ctx(work->scratch);
  double t = qn_num_to_double(*value);
  out->t = t;
  if (!isfinite(t) || !qn_num_equal(qn_num_from_double(ctx, t), *value)) {
    /* Enclosed by its neighbours: half a spacing is enough, one is given. */
    double far = fmin(fabs(t), 0x1.fffffffffffffp+1023);
    out->t = copysign(far, t);
    out->e = isfinite(t) ? nextafter(far, HUGE_VAL) - far : HUGE_VAL;
    qn_rat r = qn_num_rat(ctx, *value);
    out->num = r.num;
    out->den = r.den;
  }
  return ctx->failed;
}

quoin_status quoin_ray_intervals_text(const quoin_scene *scene, quoin_work *work, const char *const ray[6], const char *from, const char *to,
                                      unsigned want, quoin_intervals *out) {
  if (!scene || !work || work->scene != scene || !ray || !out || want > (QUOIN_WANT_BOUNDARY | QUOIN_WANT_CONTACTS)) {
    return QUOIN_E_ARGUMENT;
  }
  qn_num v[6], from_value = QN_NUM_ZERO, to_value = QN_NUM_ZERO;
  qn_line line;
  qn_range range;
  qn_query_begin(work);
  qn_ctx *ctx = qn_scratch_ctx(work->scratch);
  quoin_status status = QUOIN_OK;
  for (int i = 0; i < 6 && status == QUOIN_OK; i++) {
    status = qn_query_number(work, ray[i], &v[i]);
  }
  if (status == QUOIN_OK) {
    status = place_text(work, from, -HUGE_VAL, &range.from, &from_value);
  }
  if (status == QUOIN_OK) {
    status = place_text(work, to, HUGE_VAL, &range.to, &to_value);
  }
  if (status != QUOIN_OK) {
    return status;
  }
  if ((qn_num_is_zero(v[3]) && qn_num_is_zero(v[4]) && qn_num_is_zero(v[5])) || (from && to && qn_num_cmp(ctx, from_value, to_value) > 0)) {
    return QUOIN_E_ARGUMENT;
  }
  qn_line_from_numbers(ctx, v, v + 3, &line);
  return ctx->failed != QUOIN_OK ? ctx->failed : answer(work, &line, &range, want, out);
}
