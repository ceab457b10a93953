/* The leaves whose closed solids hold a point, and their half-spaces that vanish there.

   A half-space's sign is taken from the double shadow where its bound certifies it, else exactly; a surface is decided once a
   question, for all its users. */
#include "query/shadow.h"
#include "query/work.h"

#include <float.h>
#include <math.h>
#include <string.h>

void qn_query_begin(quoin_work *work) {
  qn_scratch_begin(work->scratch);
  work->status = QUOIN_OK;
  work->candidate_count = work->near_count = work->near_half_count = 0;
  if (++work->now == 0) { /* the stamps have gone round */
    memset(work->stamp, 0, work->scene->surface_count * sizeof *work->stamp);
    work->now = 1;
  }
}

/* --- the point ----------------------------------------------------------------------------------------------------- */

quoin_status qn_query_number(quoin_work *work, const char *text, qn_num *out) {
  if (!text) {
    return QUOIN_E_ARGUMENT;
  }
  qn_ctx *ctx = qn_scratch_ctx(work->scratch);
  size_t length = strlen(text);
  quoin_status status = QUOIN_OK;
  size_t read = qn_num_read(ctx, text, length, out, &status);
  if (ctx->failed != QUOIN_OK) {
    return ctx->failed;
  }
  if (read != 0 && status != QUOIN_OK) {
    return status;
  }
  return read == 0 || read != length ? QUOIN_E_NUMBER : QUOIN_OK;
}

quoin_status qn_query_point_doubles(quoin_work *work, const double x[3], qn_query_point *out) {
  (void)work;
  memset(out, 0, sizeof *out);
  for (int i = 0; i < 3; i++) {
    if (!isfinite(x[i])) {
      return QUOIN_E_ARGUMENT;
    }
    out->x[i] = x[i];
  }
  return QUOIN_OK;
}

quoin_status qn_query_decimal(quoin_work *work, const char *text, double *x, double *weight) {
  int exact = 0;
  size_t read = text ? qn_decimal_quick(text, x, &exact) : 0;
  if (QN_UNLIKELY(read == 0 || text[read] != '\0')) {
    qn_num n;
    quoin_status status = qn_query_number(work, text, &n);
    if (status != QUOIN_OK) {
      return status;
    }
    *x = qn_num_to_double(n);
    exact = isfinite(*x) && qn_num_equal(qn_num_from_double(qn_scratch_ctx(work->scratch), *x), n);
  }
  double size = fabs(*x) < DBL_MIN ? DBL_MIN : fabs(*x);
  *weight = exact ? 0 : size; /* rounded to nearest: within u |x|, or below the least normal number within 2^-1074 */
  return QUOIN_OK;
}

quoin_status qn_query_point_text(quoin_work *work, const char *const text[3], qn_query_point *out) {
  memset(out, 0, sizeof *out);
  for (int i = 0; i < 3; i++) {
    quoin_status status = qn_query_decimal(work, text[i], &out->x[i], &out->weight[i]);
    if (status != QUOIN_OK) {
      return status;
    }
    out->text[i] = out->weight[i] != 0 ? text[i] : NULL;
  }
  return qn_scratch_ctx(work->scratch)->failed;
}

/* The doubles' exact coordinates, over one power of two. */
static void make_doubles(qn_ctx *ctx, qn_query_point *p) {
  int least = 0, e[3];
  double m[3];
  for (int i = 0; i < 3; i++) {
    m[i] = frexp(p->x[i], &e[i]); /* x = (m 2^53) 2^(e - 53), m 2^53 an integer */
    e[i] -= 53;
    least = m[i] != 0 && e[i] < least ? e[i] : least;
  }
  for (int i = 0; i < 3; i++) {
    p->exact[i] = qn_num_from_double(ctx, p->x[i]);
    p->point.x[i] = m[i] == 0 ? (qn_int){0, NULL} : qn_int_shl(ctx, qn_int_from(ctx, (int64_t)ldexp(m[i], 53)), (size_t)(e[i] - least));
  }
  p->point.w = qn_int_shl(ctx, qn_int_from(ctx, 1), (size_t)-least);
}

/* The decimals', over their common denominator. */
static void make_decimals(quoin_work *work, qn_query_point *p) {
  qn_ctx *ctx = qn_scratch_ctx(work->scratch);
  qn_rat r[3];
  qn_int w = qn_int_from(ctx, 1);
  for (int i = 0; i < 3; i++) {
    if (!p->text[i]) {
      p->exact[i] = qn_num_from_double(ctx, p->x[i]);
    } else if (qn_query_number(work, p->text[i], &p->exact[i]) != QUOIN_OK) {
      return; /* memory: it was read before */
    }
    r[i] = qn_num_rat(ctx, p->exact[i]);
    qn_int g = qn_int_gcd(ctx, w, r[i].den);
    if (qn_int_sign(g) > 0) { /* else memory was refused */
      w = qn_int_mul(ctx, w, qn_int_divexact(ctx, r[i].den, g));
    }
  }
  for (int i = 0; i < 3 && ctx->failed == QUOIN_OK; i++) {
    p->point.x[i] = qn_int_mul(ctx, r[i].num, qn_int_divexact(ctx, w, r[i].den));
  }
  p->point.w = w;
}

static void make_exact(quoin_work *work, qn_query_point *p) {
  if (!p->made) {
    if (p->text[0] || p->text[1] || p->text[2]) {
      make_decimals(work, p);
    } else {
      make_doubles(qn_scratch_ctx(work->scratch), p);
    }
    p->made = 1;
  }
}

/* --- exact signs --------------------------------------------------------------------------------------------------- */

/* Of a superquadric half-space's q. */
static int super_sign_exactly(quoin_work *work, uint32_t leaf, qn_query_point *p) {
  qn_ctx *ctx = qn_scratch_ctx(work->scratch);
  qn_half_form *forms = NULL;
  size_t count = 0;
  make_exact(work, p);
  if (qn_scene_leaf_forms(work->scene, leaf, ctx, &forms, &count) != QN_FORM_OK) {
    return 0;
  }
  for (size_t h = 0; h < count; h++) {
    if (forms[h].kind == QN_SUPER_BODY) {
      const qn_num at[4] = {p->exact[0], p->exact[1], p->exact[2], QN_NUM_ONE};
      qn_num X[3];
      for (int i = 0; i < 3; i++) {
        X[i] = qn_num_dot(ctx, 4, forms[h].row[i], at);
      }
      return qn_superquadric_sign(ctx, forms[h].s[0], forms[h].s[1], X);
    }
  }
  return 0;
}

/* Of a half-space's q. */
static int exact_sign(quoin_work *work, uint32_t leaf, const qn_half *half, qn_query_point *p) {
  qn_counts *counts = qn_scratch_counts(work->scratch);
  counts->exact_signs++;
  if (half->kind == QN_SUPER_BODY) {
    return super_sign_exactly(work, leaf, p);
  }
  int made = 0;
  const qn_exact_surface *surface = qn_scene_exact(work->scene, half->surface, &made);
  counts->exact_forms += (uint64_t)(made != 0);
  if (!surface) {
    work->status = qn_scene_no_exact(work->scene, half->surface);
    return 0;
  }
  make_exact(work, p);
  return half->side * qn_surface_sign_at(qn_scratch_ctx(work->scratch), surface, &p->point);
}

/* --- the leaves ---------------------------------------------------------------------------------------------------- */

static void candidate(void *user, uint32_t leaf) {
  quoin_work *work = user;
  if (!qn_grow(work->mem, &work->candidates, &work->candidate_capacity, work->candidate_count + 1)) {
    work->status = QUOIN_E_MEMORY;
    return;
  }
  work->candidates[work->candidate_count++] = leaf;
}

static void find_candidates(quoin_work *work, const qn_query_point *p) {
  const quoin_scene *scene = work->scene;
  double min[3], max[3];
  for (int i = 0; i < 3; i++) {
    min[i] = p->weight[i] == 0 ? p->x[i] : nextafter(p->x[i], -HUGE_VAL);
    max[i] = p->weight[i] == 0 ? p->x[i] : nextafter(p->x[i], HUGE_VAL);
  }
  qn_bvh_point(&scene->bvh, min, max, candidate, work, &qn_scratch_counts(work->scratch)->nodes);
  for (size_t i = 0; i < scene->unbounded_count; i++) {
    candidate(work, scene->unbounded[i]);
  }
}

static void note_sign(quoin_work *work, const qn_half *half, int sign) {
  work->stamp[half->surface] = work->now;
  work->sign[half->surface] = (int8_t)(half->side * sign);
}

/* Whether the closed leaf holds the point; adds it to the near ones. */
static void look_at(quoin_work *work, uint32_t number, qn_query_point *p) {
  const quoin_scene *scene = work->scene;
  const qn_leaf *leaf = &scene->leaves[number];
  const qn_half *halves = &scene->halves[leaf->half0];
  qn_counts *counts = qn_scratch_counts(work->scratch);
  qn_frame f = qn_frame_of(p->x, p->weight, leaf->pivot);
  int unsure = 0;
  counts->leaves++;
  for (uint32_t h = 0; h < leaf->halves; h++) {
    int sign = QN_UNSURE;
    if (work->stamp[halves[h].surface] == work->now) {
      sign = halves[h].side * work->sign[halves[h].surface];
    } else {
      sign = qn_shadow_sign(scene, &halves[h], &f);
      if (sign != QN_UNSURE) {
        counts->filter_sure++;
        note_sign(work, &halves[h], sign);
      }
    }
    if (sign == 1) {
      return;
    }
    unsure |= sign != -1;
  }
  uint32_t first = (uint32_t)work->near_half_count;
  for (uint32_t h = 0; unsure && h < leaf->halves; h++) {
    if (work->stamp[halves[h].surface] != work->now) {
      note_sign(work, &halves[h], exact_sign(work, number, &halves[h], p));
    }
    int sign = halves[h].side * work->sign[halves[h].surface];
    if (sign > 0) {
      work->near_half_count = first;
      return;
    }
    if (sign == 0) {
      if (!qn_grow(work->mem, &work->near_halves, &work->near_half_capacity, work->near_half_count + 1)) {
        work->status = QUOIN_E_MEMORY;
        return;
      }
      work->near_halves[work->near_half_count++] = leaf->half0 + h;
    }
  }
  if (!qn_grow(work->mem, &work->near, &work->near_capacity, work->near_count + 1)) {
    work->status = QUOIN_E_MEMORY;
    return;
  }
  work->near[work->near_count++] = (qn_near_leaf){number, first, (uint32_t)(work->near_half_count - first)};
}

quoin_status qn_query_near(quoin_work *work, qn_query_point *point, int all) {
  qn_ctx *ctx = qn_scratch_ctx(work->scratch);
  find_candidates(work, point);
  for (size_t i = 0; i < work->candidate_count && work->status == QUOIN_OK; i++) {
    uint32_t leaf = work->candidates[i];
    if (all || work->scene->leaves[leaf].gate != QN_NO_GATE) {
      look_at(work, leaf, point);
    }
  }
  if (work->near_half_count != 0) {
    make_exact(work, point);
  }
  return work->status != QUOIN_OK ? work->status : ctx->failed;
}
