/* Convex polyhedron: n, m, then n planes a, b, c, d (a x + b y + c z <= d), then m vertices. Faces 0 to n - 1.

   Support: the greatest of the vertices. (u, v): the two coordinates that the face's normal bends least, as shares of the
   vertices' box. */
#include "shape/exact.h"
#include "shape/outward.h"
#include "shape/rows.h"

qn_form_result qn_polyhedron_form(qn_ctx *ctx, const qn_num *args, size_t n, const qn_placement *placement, qn_half_form **halves,
                                  size_t *count) {
  (void)placement;
  *count = 0;
  int64_t planes = 0;
  if (n < 2 || !qn_num_is_integer(args[0], &planes) || planes < 4 || (uint64_t)planes > (n - 2) / 4) {
    return QN_FORM_EMPTY;
  }
  qn_half_form *out = qn_halves_new(ctx, (size_t)planes);
  if (!out) {
    return QN_FORM_EMPTY;
  }
  size_t m = 0;
  for (int64_t i = 0; i < planes; i++) {
    const qn_num *p = args + 2 + 4 * i;
    if (qn_num_is_zero(p[0]) && qn_num_is_zero(p[1]) && qn_num_is_zero(p[2])) {
      if (qn_num_sign(p[3]) < 0) {
        return QN_FORM_EMPTY;
      }
      continue; /* 0 <= d: no face */
    }
    qn_half_plane(ctx, out + m++, QUOIN_FACE + (uint32_t)i, p[0], p[1], p[2], p[3]);
  }
  *halves = out;
  *count = m;
  return QN_FORM_OK;
}

/* The vertices among the arguments; *count is 0 when the arguments are too few. */
static const double *vertices(const double *args, size_t n, size_t *count) {
  *count = 0;
  if (n < 2 || !(args[0] >= 0) || !(args[1] >= 0) || 4 * args[0] + 3 * args[1] + 2 > (double)n) {
    return args;
  }
  *count = (size_t)args[1];
  return args + 2 + 4 * (size_t)args[0];
}

double qn_polyhedron_support(const double *args, size_t n, const double placement[6], const double v[3]) {
  (void)placement;
  size_t m;
  const double *p = vertices(args, n, &m);
  double best = -INFINITY, largest = 0;
  for (size_t i = 0; i < m; i++) {
    qn_terms t = {0, 0};
    for (int k = 0; k < 3; k++) {
      qn_term(&t, p[3 * i + (size_t)k], v[k]);
    }
    best = t.sum > best || t.sum != t.sum ? t.sum : best;
    largest = t.magnitude > largest || t.magnitude != t.magnitude ? t.magnitude : largest;
  }
  return m ? qn_outward((qn_terms){best, largest}, QN_SUPPORT_SLACK(8)) : INFINITY;
}

void qn_polyhedron_uv(const double *args, size_t n, const double placement[6], uint32_t role, const double x[3], double uv[2]) {
  (void)placement;
  size_t m, face = role - QUOIN_FACE;
  const double *p = vertices(args, n, &m);
  uv[0] = uv[1] = 0;
  if (!m || face >= (size_t)args[0]) {
    return;
  }
  const double *normal = args + 2 + 4 * face;
  double ax = fabs(normal[0]), ay = fabs(normal[1]), az = fabs(normal[2]);
  int drop = az >= ax && az >= ay ? 2 : ay >= ax ? 1 : 0;
  for (int k = 0, j = 0; k < 3; k++) {
    if (k == drop) {
      continue;
    }
    double lo = p[k], hi = p[k];
    for (size_t i = 1; i < m; i++) {
      lo = fmin(lo, p[3 * i + (size_t)k]);
      hi = fmax(hi, p[3 * i + (size_t)k]);
    }
    uv[j++] = hi > lo ? qn_clamp01((x[k] - lo) / (hi - lo)) : 0;
  }
}
