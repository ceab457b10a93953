/* The side of a point (design S6), and the parts that hold it. */
#include "base/bounds.h"
#include "query/work.h"

#include <math.h>
#include <stdlib.h>

quoin_status qn_query_side(quoin_work *work, qn_query_point *point, quoin_side *out) {
  qn_scratch_counts(work->scratch)->exact_points++;
  quoin_status status = qn_query_near(work, point, 0);
  if (status != QUOIN_OK) {
    return status;
  }
  return qn_around(work->scene, work->scratch, &point->point, work->near, work->near_count, work->near_halves, work->near_half_count, out);
}

/* A batch of points: those that wide code cannot certify are left. */
typedef struct batch {
  size_t n, wide;
  qn_wide_point point[QN_POINTS]; /* for wide code */
  uint16_t place[QN_POINTS];      /* theirs among all n */
  uint8_t verdict[QN_POINTS], left[QN_POINTS];
} batch;

/* 0 for what is no point. */
QN_INLINE int add(batch *b, const double x[3], const double weight[3]) {
  double size = fabs(x[0]) > fabs(x[1]) ? fabs(x[0]) : fabs(x[1]), w = weight[0] > weight[1] ? weight[0] : weight[1];
  size = fabs(x[2]) > size ? fabs(x[2]) : size;
  w = weight[2] > w ? weight[2] : w;
  b->left[b->n] = 1;
  if (QN_LIKELY(size + 0 * (x[0] + x[1] + x[2]) <= QN_WIDE_LARGEST)) { /* then the weight is no larger; and no coordinate is infinite or not a number */
    b->point[b->wide] = (qn_wide_point){{x[0], x[1], x[2]}, w};
    b->place[b->wide++] = (uint16_t)b->n;
  } else if (!isfinite(x[0]) || !isfinite(x[1]) || !isfinite(x[2])) {
    return 0;
  }
  b->n++;
  return 1;
}

static quoin_status certify(quoin_work *work, batch *b, quoin_side *out) {
  static const quoin_side SIDES[] = {[QN_SURELY_OUT] = QUOIN_OUTSIDE, [QN_SURELY_IN] = QUOIN_INSIDE};
  if (!work->scene->normal.made || b->wide == 0) {
    return QUOIN_OK;
  }
  if (!work->point_walk && !(work->point_walk = qn_alloc_line(work->mem, sizeof *work->point_walk))) {
    return QUOIN_E_MEMORY;
  }
  if (!work->cells_asked && qn_scratch_counts(work->scratch)->points >= work->scene->normal.term_count) { /* by now they pay */
    work->cells_asked = 1;
    work->cells = qn_scene_cells(work->scene);
  }
  work->point_walk->cells = work->cells;
  qn_wide_counts counts = {0};
  work->wide->points(work->scene, work->point_walk, b->wide, b->point, b->verdict, &counts);
  qn_scratch_counts(work->scratch)->nodes += counts.nodes;
  qn_scratch_counts(work->scratch)->leaves += counts.leaves;
  for (size_t k = 0; k < b->wide; k++) {
    size_t i = b->place[k];
    b->left[i] = b->verdict[k] == QN_NOT_SURE;
    out[i] = SIDES[b->verdict[k]]; /* of a point that is left it means nothing */
  }
  return QUOIN_OK;
}

quoin_status quoin_point_side(const quoin_scene *scene, quoin_work *work, const double point[3], quoin_side *out) {
  return quoin_point_sides(scene, work, 1, point, out);
}

quoin_status quoin_point_sides(const quoin_scene *scene, quoin_work *work, size_t n, const double *points, quoin_side *out) {
  static const double exact[3] = {0, 0, 0};
  if (!scene || !work || work->scene != scene || (n != 0 && (!points || !out))) {
    return QUOIN_E_ARGUMENT;
  }
  quoin_status status = QUOIN_OK;
  for (size_t at = 0; at < n && status == QUOIN_OK; at += QN_POINTS) {
    batch b;
    b.n = b.wide = 0;
    for (size_t i = at; i < n && b.n < QN_POINTS && add(&b, points + 3 * i, exact); i++) {
    }
    qn_scratch_counts(work->scratch)->points += b.n;
    status = certify(work, &b, out + at);
    for (size_t i = 0; i < b.n && status == QUOIN_OK; i++) {
      if (b.left[i]) {
        qn_query_point p;
        qn_query_begin(work);
        status = qn_query_point_doubles(work, points + 3 * (at + i), &p);
        status = status == QUOIN_OK ? qn_query_side(work, &p, &out[at + i]) : status;
      }
    }
    if (status == QUOIN_OK && b.n < QN_POINTS && at + b.n < n) {
      return QUOIN_E_ARGUMENT;
    }
  }
  return status;
}

quoin_status quoin_point_sides_text(const quoin_scene *scene, quoin_work *work, size_t n, const char *const *points, quoin_side *out, size_t *done) {
  size_t unused;
  done = done ? done : &unused;
  *done = 0;
  if (!scene || !work || work->scene != scene || (n != 0 && (!points || !out))) {
    return QUOIN_E_ARGUMENT;
  }
  quoin_status wrong = QUOIN_OK; /* the first point that is none */
  while (*done < n && wrong == QUOIN_OK) {
    const char *const *texts = points + 3 * *done;
    quoin_side *sides = out + *done;
    batch b;
    b.n = b.wide = 0;
    qn_query_begin(work);
    for (; *done + b.n < n && b.n < QN_POINTS && wrong == QUOIN_OK;) {
      qn_query_point p;
      wrong = qn_query_point_text(work, texts + 3 * b.n, &p);
      if (wrong == QUOIN_OK && !add(&b, p.x, p.weight)) { /* beyond all doubles: left */
        b.n++;
      }
    }
    qn_scratch_counts(work->scratch)->points += b.n;
    quoin_status status = certify(work, &b, sides);
    for (size_t i = 0; i < b.n; i++) {
      if (status == QUOIN_OK && b.left[i]) {
        qn_query_point p;
        qn_query_begin(work);
        status = qn_query_point_text(work, texts + 3 * i, &p);
        status = status == QUOIN_OK ? qn_query_side(work, &p, &sides[i]) : status;
      }
      if (status != QUOIN_OK) {
        return status;
      }
      ++*done;
    }
  }
  return wrong;
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
