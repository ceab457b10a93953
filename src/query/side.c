/* The side of a point (design S6), and the parts that hold it. */
#include "base/bounds.h"
#include "query/work.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

quoin_status qn_query_side(quoin_work *work, qn_query_point *point, quoin_side *out) {
  qn_scratch_counts(work->scratch)->exact_points++;
  quoin_status status = qn_query_near(work, point, 0);
  if (status != QUOIN_OK) {
    return status;
  }
  return qn_around(work->scene, work->scratch, &point->point, work->near, work->near_count, work->near_halves, work->near_half_count, QN_AROUND_POINT, out);
}

/* Points for wide code, xyz after xyz, with their weights (or null), into verdicts: QN_NOT_SURE for all when there is no normal form. */
static quoin_status certify(quoin_work *work, size_t n, const double *points, const double *weights, uint8_t verdict[QN_POINTS]) {
  qn_counts *counts = qn_scratch_counts(work->scratch);
  const qn_normal *normal = &work->scene->normal;
  counts->points += n;
  if (!normal->made) {
    memset(verdict, QN_NOT_SURE, n);
    return QUOIN_OK;
  }
  if (!work->point_walk && !(work->point_walk = qn_alloc_line(work->mem, sizeof *work->point_walk))) {
    return QUOIN_E_MEMORY;
  }
  if (!work->cells_asked && counts->points >= normal->term_count) { /* by now they pay */
    work->cells_asked = 1;
    work->cells = qn_scene_cells(work->scene);
  }
  work->point_walk->cells = work->cells;
  qn_wide_counts wide = {0};
  work->wide->points(work->scene, work->point_walk, n, points, weights, verdict, &wide);
  counts->nodes += wide.nodes, counts->leaves += wide.leaves;
  return QUOIN_OK;
}

static const quoin_side SIDES[] = {[QN_SURELY_OUT] = QUOIN_OUTSIDE, [QN_SURELY_IN] = QUOIN_INSIDE};

static quoin_status side_of_doubles(quoin_work *work, const double x[3], quoin_side *out) {
  qn_query_point p;
  qn_query_begin(work);
  quoin_status status = qn_query_point_doubles(work, x, &p);
  return status == QUOIN_OK ? qn_query_side(work, &p, out) : status;
}

quoin_status quoin_point_side(const quoin_scene *scene, quoin_work *work, const double point[3], quoin_side *out) {
  return quoin_point_sides(scene, work, 1, point, out);
}

quoin_status quoin_point_sides(const quoin_scene *scene, quoin_work *work, size_t n, const double *points, quoin_side *out) {
  if (!scene || !work || work->scene != scene || (n != 0 && (!points || !out))) {
    return QUOIN_E_ARGUMENT;
  }
  uint8_t verdict[QN_POINTS];
  for (size_t at = 0; at < n; at += QN_POINTS) {
    const double *x = points + 3 * at;
    size_t count = n - at < QN_POINTS ? n - at : QN_POINTS;
    quoin_status status = certify(work, count, x, NULL, verdict);
    if (status != QUOIN_OK) {
      return status;
    }
    unsigned open = 0;
    for (size_t i = 0; i < count; i++) {
      out[at + i] = SIDES[verdict[i]];
      open |= verdict[i] == QN_NOT_SURE;
    }
    for (size_t i = 0; QN_UNLIKELY(open) && i < count && status == QUOIN_OK; i++) {
      if (verdict[i] == QN_NOT_SURE) {
        status = side_of_doubles(work, x + 3 * i, &out[at + i]);
      }
    }
    if (status != QUOIN_OK) {
      return status;
    }
  }
  return QUOIN_OK;
}

/* A batch of decimals. */
typedef struct decimals {
  size_t n;
  double x[3 * QN_POINTS], weight[QN_POINTS];
  uint8_t verdict[QN_POINTS];
} decimals;

/* The sides of a batch, in order; *done is increased by those that were found. */
static quoin_status settle(quoin_work *work, decimals *d, const char *const *texts, quoin_side *out, size_t *done) {
  quoin_status status = certify(work, d->n, d->x, d->weight, d->verdict);
  for (size_t i = 0; i < d->n && status == QUOIN_OK; i++) {
    out[i] = SIDES[d->verdict[i]];
    if (QN_UNLIKELY(d->verdict[i] == QN_NOT_SURE)) {
      qn_query_point p;
      qn_query_begin(work);
      status = qn_query_point_text(work, texts + 3 * i, &p);
      status = status == QUOIN_OK ? qn_query_side(work, &p, &out[i]) : status;
    }
    *done += status == QUOIN_OK;
  }
  return status;
}

quoin_status quoin_point_sides_text(const quoin_scene *scene, quoin_work *work, size_t n, const char *const *points, quoin_side *out, size_t *done) {
  size_t unused = 0;
  done = done ? done : &unused;
  *done = 0;
  if (!scene || !work || work->scene != scene || (n != 0 && (!points || !out))) {
    return QUOIN_E_ARGUMENT;
  }
  quoin_status status = QUOIN_OK, wrong = QUOIN_OK; /* wrong: of the first point that is none */
  while (*done < n && status == QUOIN_OK && wrong == QUOIN_OK) {
    const char *const *texts = points + 3 * *done;
    size_t most = n - *done < QN_POINTS ? n - *done : QN_POINTS;
    decimals d;
    d.n = 0;
    qn_query_begin(work);
    for (; d.n < most; d.n++) {
      double weight = 0, *x = d.x + 3 * d.n;
      d.weight[d.n] = 0;
      for (int k = 0; k < 3 && wrong == QUOIN_OK; k++) {
        wrong = qn_query_decimal(work, texts[3 * d.n + (size_t)k], &x[k], &weight);
        d.weight[d.n] = weight > d.weight[d.n] ? weight : d.weight[d.n];
      }
      if (wrong != QUOIN_OK) {
        break;
      }
    }
    status = settle(work, &d, texts, out + *done, done);
  }
  return status != QUOIN_OK ? status : wrong;
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
