/* The side of a point (design S6), and the parts that hold it. */
#include "query/work.h"

#include <stdlib.h>

static quoin_status side_of(quoin_work *work, qn_query_point *point, quoin_side *out) {
  qn_scratch_counts(work->scratch)->points++;
  quoin_status status = qn_query_near(work, point, 0);
  if (status != QUOIN_OK) {
    return status;
  }
  return qn_around(work->scene, work->scratch, &point->point, work->near, work->near_count, work->near_halves, work->near_half_count, out);
}

quoin_status quoin_point_side(const quoin_scene *scene, quoin_work *work, const double point[3], quoin_side *out) {
  return quoin_point_sides(scene, work, 1, point, out);
}

quoin_status quoin_point_sides(const quoin_scene *scene, quoin_work *work, size_t n, const double *points, quoin_side *out) {
  if (!scene || !work || work->scene != scene || (n != 0 && (!points || !out))) {
    return QUOIN_E_ARGUMENT;
  }
  for (size_t i = 0; i < n; i++) {
    qn_query_point p;
    qn_query_begin(work);
    quoin_status status = qn_query_point_doubles(work, points + 3 * i, &p);
    if (status == QUOIN_OK) {
      status = side_of(work, &p, &out[i]);
    }
    if (status != QUOIN_OK) {
      return status;
    }
  }
  return QUOIN_OK;
}

quoin_status quoin_point_sides_text(const quoin_scene *scene, quoin_work *work, size_t n, const char *const *points, quoin_side *out, size_t *done) {
  if (done) {
    *done = 0;
  }
  if (!scene || !work || work->scene != scene || (n != 0 && (!points || !out))) {
    return QUOIN_E_ARGUMENT;
  }
  for (size_t i = 0; i < n; i++) {
    qn_query_point p;
    qn_query_begin(work);
    quoin_status status = qn_query_point_text(work, points + 3 * i, &p);
    if (status == QUOIN_OK) {
      status = side_of(work, &p, &out[i]);
    }
    if (done) {
      *done = i + (status == QUOIN_OK);
    }
    if (status != QUOIN_OK) {
      return status;
    }
  }
  return QUOIN_OK;
}

quoin_status quoin_point_side_text(const quoin_scene *scene, quoin_work *work, const char *const point[3], quoin_side *out) {
  return quoin_point_sides_text(scene, work, 1, point, out, NULL);
}

static int by_leaf(const void *a, const void *b) {
  uint32_t x = ((const qn_near_leaf *)a)->leaf, y = ((const qn_near_leaf *)b)->leaf;
  return (x > y) - (x < y);
}

static quoin_status parts_of(quoin_work *work, qn_query_point *point, quoin_part *parts, size_t size, size_t *count) {
  quoin_status status = qn_query_near(work, point, 1);
  if (status != QUOIN_OK) {
    return status;
  }
  if (work->near_count != 0) {
    qsort(work->near, work->near_count, sizeof *work->near, by_leaf);
  }
  for (size_t i = 0; i < work->near_count && i < size; i++) {
    parts[i] = work->near[i].leaf;
  }
  *count = work->near_count;
  return QUOIN_OK;
}

quoin_status quoin_point_parts(const quoin_scene *scene, quoin_work *work, const double point[3], quoin_part *parts, size_t size, size_t *count) {
  if (!scene || !work || work->scene != scene || !point || !count || (size != 0 && !parts)) {
    return QUOIN_E_ARGUMENT;
  }
  qn_query_point p;
  qn_query_begin(work);
  quoin_status status = qn_query_point_doubles(work, point, &p);
  return status == QUOIN_OK ? parts_of(work, &p, parts, size, count) : status;
}

quoin_status quoin_point_parts_text(const quoin_scene *scene, quoin_work *work, const char *const point[3], quoin_part *parts, size_t size, size_t *count) {
  if (!scene || !work || work->scene != scene || !point || !count || (size != 0 && !parts)) {
    return QUOIN_E_ARGUMENT;
  }
  qn_query_point p;
  qn_query_begin(work);
  quoin_status status = qn_query_point_text(work, point, &p);
  return status == QUOIN_OK ? parts_of(work, &p, parts, size, count) : status;
}
