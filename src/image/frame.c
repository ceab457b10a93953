/* Hulls of leaves, from their double shadows: for looks only, no answer depends on them.

   Legend: y = x - pivot. A body is sum s_i X_i^2 + 2 l X_2 + k <= 0 with X_i = row_i . y + b_i.
   An ellipsoid (all s_i > 0, l = 0): with B the matrix of the rows, the points B^-1 (X - b); its axes are the columns of B^-1 times
   sqrt(-k / s_i).
   A round body with caps: on a cap n . y + d = 0, X_2 is constant (both are about the body's axis), so the disc has its centre where X_0 = X_1 = 0, and
   axes, the first two columns of the inverse of the matrix with rows row_0, row_1, n, times sqrt(rho / s_i), rho = -(s_2 X_2^2 + 2 l X_2 + k).
   Between two caps, cylinders, cones and hyperboloids lie within the hull of their discs. A paraboloid lies within that of its disc and one of half the
   size about its vertex: the tangents at the rim meet the vertex's plane there. Everything else is framed by its box. */
#include "image/frame.h"
#include "image/vec.h"

#include <string.h>

/* The inverse of the matrix with these rows, by columns. 0: it is singular, or too large for doubles. */
static int invert(const double *const rows[3], double column[3][3]) {
  for (int i = 0; i < 3; i++) {
    qn_cross3(rows[(i + 1) % 3], rows[(i + 2) % 3], column[i]);
  }
  const double det = qn_dot3(rows[0], column[0]);
  double sum = 0;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      column[i][j] /= det;
      sum += column[i][j];
    }
  }
  return isfinite(sum) != 0;
}

/* y where the rows' forms are the values. */
static void solve(const double column[3][3], const double values[3], double y[3]) {
  for (int j = 0; j < 3; j++) {
    y[j] = values[0] * column[0][j] + values[1] * column[1][j] + values[2] * column[2][j];
  }
}

/* The oval about pivot + y with the first `axes` columns as axes, the i-th scaled to sqrt(rho / s_i). */
static void set_oval(const qn_quadric_shadow *q, const double pivot[3], const double y[3], const double column[3][3], int axes, double rho, qn_oval *out) {
  memset(out, 0, sizeof *out);
  for (int j = 0; j < 3; j++) {
    out->centre[j] = pivot[j] + y[j];
    for (int i = 0; i < axes; i++) {
      out->axis[i][j] = column[i][j] * sqrt(rho > 0 ? rho / q->s[i] : 0);
    }
  }
}

static double row_at(const double row[4], const double y[3]) {
  return qn_dot3(row, y) + row[3];
}

static int ellipsoid(const qn_quadric_shadow *q, const double pivot[3], qn_oval *out) {
  const double *const rows[3] = {q->row[0], q->row[1], q->row[2]};
  const double values[3] = {-q->row[0][3], -q->row[1][3], -q->row[2][3]};
  double column[3][3], y[3];
  if (!(q->s[0] > 0 && q->s[1] > 0 && q->s[2] > 0 && q->l == 0) || !invert(rows, column)) {
    return 0;
  }
  solve((const double(*)[3])column, values, y);
  set_oval(q, pivot, y, (const double(*)[3])column, 3, -q->k, out);
  return 1;
}

static int disc(const qn_quadric_shadow *q, const qn_plane_shadow *cap, const double pivot[3], qn_oval *out) {
  const double *const rows[3] = {q->row[0], q->row[1], cap->n};
  const double values[3] = {-q->row[0][3], -q->row[1][3], -cap->d};
  double column[3][3], y[3];
  if (!(q->s[0] > 0 && q->s[1] > 0) || !invert(rows, column)) {
    return 0;
  }
  solve((const double(*)[3])column, values, y);
  const double x2 = row_at(q->row[2], y);
  set_oval(q, pivot, y, (const double(*)[3])column, 2, -((q->s[2] * x2 + 2 * q->l) * x2 + q->k), out);
  return 1;
}

static int vertex_disc(const qn_quadric_shadow *q, const double pivot[3], const qn_oval *rim, qn_oval *out) {
  const double *const rows[3] = {q->row[0], q->row[1], q->row[2]};
  const double values[3] = {-q->row[0][3], -q->row[1][3], -q->k / (2 * q->l) - q->row[2][3]};
  double column[3][3], y[3];
  if (q->s[2] != 0 || q->l == 0 || !invert(rows, column)) {
    return 0;
  }
  solve((const double(*)[3])column, values, y);
  *out = *rim;
  for (int j = 0; j < 3; j++) {
    out->centre[j] = pivot[j] + y[j];
    out->axis[0][j] /= 2, out->axis[1][j] /= 2;
  }
  return 1;
}

static int ovals_of(const quoin_scene *scene, const qn_leaf *leaf, qn_oval out[2]) {
  const qn_half *half = leaf->halves ? scene->halves + leaf->half0 : NULL;
  if (!half || half[0].kind != QN_QUADRIC_BODY) {
    return 0;
  }
  const qn_quadric_shadow *body = &scene->quadrics[half[0].shadow];
  switch ((qn_prim)leaf->prim) {
  case QN_SPHERE:
  case QN_ELLIPSOID: return leaf->halves == 1 ? ellipsoid(body, leaf->pivot, out) : 0;
  case QN_CYLINDER:
  case QN_HYPERBOLOID1:
  case QN_HYPERBOLOID2:
    return leaf->halves == 3 && half[1].kind == QN_PLANE && half[2].kind == QN_PLANE && disc(body, &scene->planes[half[1].shadow], leaf->pivot, out) &&
                   disc(body, &scene->planes[half[2].shadow], leaf->pivot, out + 1)
             ? 2
             : 0;
  case QN_PARABOLOID:
    return leaf->halves == 2 && half[1].kind == QN_PLANE && disc(body, &scene->planes[half[1].shadow], leaf->pivot, out) &&
                   vertex_disc(body, leaf->pivot, out, out + 1)
             ? 2
             : 0;
  case QN_CUBE:
  case QN_PRISM:
  case QN_SADDLE:
  case QN_QUADRIC:
  case QN_HALFSPACE:
  case QN_WEDGE:
  case QN_SUPERQUADRIC:
  case QN_POLYHEDRON:
  case QN_PRIM_COUNT: break;
  }
  return 0;
}

/* The leaf's box, clipped. 0: nothing of it is left, or its outside is meant. */
static int clip(const qn_framed *f, const qn_leaf *leaf, double min[3], double max[3]) {
  int some = !leaf->negated;
  for (int i = 0; i < 3; i++) {
    min[i] = fmax(f->min[i], leaf->min[i]);
    max[i] = fmin(f->max[i], leaf->max[i]);
    some = some && min[i] <= max[i];
  }
  return some;
}

void qn_framed_make(const quoin_scene *scene, const double min[3], const double max[3], qn_framed *out) {
  out->scene = scene;
  out->count = 0;
  memcpy(out->min, min, sizeof out->min);
  memcpy(out->max, max, sizeof out->max);
  for (size_t l = 0; l < scene->leaf_count && !scene->empty; l++) {
    qn_hull hull;
    if (!clip(out, &scene->leaves[l], hull.min, hull.max)) {
      continue;
    }
    if (out->count == QN_HULLS) {
      out->count = 0; /* too many */
      return;
    }
    hull.ovals = ovals_of(scene, &scene->leaves[l], hull.oval);
    out->hull[out->count++] = hull;
  }
}

static double box_reach(const double min[3], const double max[3], const double origin[3], const double v[3]) {
  double sum = 0;
  for (int i = 0; i < 3; i++) {
    const double a = v[i] * (min[i] - origin[i]), b = v[i] * (max[i] - origin[i]);
    sum += a > b ? a : b;
  }
  return sum;
}

static double oval_reach(const qn_oval *oval, const double origin[3], const double v[3]) {
  double along = 0, square = 0;
  for (int i = 0; i < 3; i++) {
    along += v[i] * (oval->centre[i] - origin[i]);
    const double part = qn_dot3(oval->axis[i], v);
    square += part * part;
  }
  return along + sqrt(square);
}

double qn_framed_reach(const qn_framed *f, const double origin[3], const double v[3]) {
  double most = -INFINITY, min[3], max[3];
  for (size_t k = 0; k < f->count; k++) {
    const qn_hull *hull = &f->hull[k];
    double reach = box_reach(hull->min, hull->max, origin, v);
    if (hull->ovals && reach > most) {
      double ovals = oval_reach(&hull->oval[0], origin, v);
      if (hull->ovals > 1) {
        const double other = oval_reach(&hull->oval[1], origin, v);
        ovals = other > ovals ? other : ovals;
      }
      reach = ovals < reach ? ovals : reach;
    }
    most = reach > most ? reach : most;
  }
  for (size_t l = 0; f->count == 0 && l < f->scene->leaf_count && !f->scene->empty; l++) {
    if (clip(f, &f->scene->leaves[l], min, max)) {
      const double reach = box_reach(min, max, origin, v);
      most = reach > most ? reach : most;
    }
  }
  return most > -INFINITY ? most : box_reach(f->min, f->max, origin, v);
}
