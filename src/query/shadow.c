/* Signs of half-spaces at a point from their double shadows. Bounds: docs/bounds.md, QN_POINT_MAP_E, QN_POINT_FORM_E.

   Legend: y = x - pivot as rounded, W its weight; X_i = row_i . (y, 1), Omega_i = sum |row_ij| W_j + |row_i3|,
   Omega'_i = |X_i| + QN_POINT_MAP_E Omega_i. */
#include "query/shadow.h"

#include "base/bounds.h"

#include <math.h>

qn_frame qn_frame_of(const double x[3], const double weight[3], const double pivot[3]) {
  qn_frame f;
  for (int i = 0; i < 3; i++) {
    f.y[i] = x[i] - pivot[i];
    f.w[i] = fabs(f.y[i]) + weight[i];
  }
  return f;
}

typedef struct mapped { double x, omega; } mapped;

static mapped map_row(const double row[4], const qn_frame *f) {
  return (mapped){((row[0] * f->y[0] + row[1] * f->y[1]) + row[2] * f->y[2]) + row[3],
                  ((fabs(row[0]) * f->w[0] + fabs(row[1]) * f->w[1]) + fabs(row[2]) * f->w[2]) + fabs(row[3])};
}

double qn_plane_value(const qn_plane_shadow *s, const qn_frame *f, double *bound) {
  const double row[4] = {s->n[0], s->n[1], s->n[2], s->d};
  mapped m = map_row(row, f);
  if (m.omega == 0 && row[3] == 0 && (row[0] == 0 || f->w[0] == 0) && (row[1] == 0 || f->w[1] == 0) && (row[2] == 0 || f->w[2] == 0)) {
    *bound = 0; /* every term is zero */
    return 0;
  }
  *bound = m.omega <= QN_POINT_LARGEST ? QN_POINT_MAP_E * m.omega + QN_POINT_TINY : HUGE_VAL;
  return m.x;
}

double qn_quadric_value(const qn_quadric_shadow *s, const qn_frame *f, double *bound) {
  double q = 0, size = fabs(s->k);
  int small = fabs(s->l) <= QN_POINT_LARGEST;
  for (int i = 0; i < 3; i++) {
    int linear = i == 2 && s->l != 0;
    if (s->s[i] == 0 && !linear) {
      continue;
    }
    mapped m = map_row(s->row[i], f);
    small &= m.omega <= QN_POINT_LARGEST && fabs(s->s[i]) <= QN_POINT_LARGEST;
    q += s->s[i] * (m.x * m.x);
    size += fabs(s->s[i]) * (m.omega * (fabs(m.x) + QN_POINT_MAP_E * m.omega));
    if (linear) {
      q += 2 * (s->l * m.x);
      size += fabs(s->l) * m.omega;
    }
  }
  *bound = small ? QN_POINT_FORM_E * size + QN_POINT_TINY : HUGE_VAL;
  return q + s->k;
}

/* The norm grows with each |X_i|, so its values at the ends of their enclosures hold it. */
static int super_sign(const qn_quadric_shadow *s, const qn_frame *f) {
  double low[3], high[3], error = 0;
  for (int i = 0; i < 3; i++) {
    mapped m = map_row(s->row[i], f);
    if (!(m.omega <= QN_POINT_LARGEST)) {
      return QN_UNSURE;
    }
    double e = QN_SLACK * (QN_POINT_MAP_E * m.omega + QN_POINT_TINY), size = fabs(m.x);
    low[i] = size > e ? (size - e) * (1 - 2 * QN_U) : 0;
    high[i] = (size + e) * (1 + 2 * QN_U);
  }
  double value = qn_superquadric_value(s->s[0], s->s[1], low, &error);
  if (value > error) {
    return 1;
  }
  value = qn_superquadric_value(s->s[0], s->s[1], high, &error);
  return -value > error ? -1 : QN_UNSURE;
}

int qn_shadow_sign(const quoin_scene *scene, const qn_half *half, const qn_frame *f) {
  double value = 0, bound = HUGE_VAL;
  switch ((qn_half_kind)half->kind) {
    case QN_PLANE:
      value = qn_plane_value(&scene->planes[half->shadow], f, &bound);
      break;
    case QN_QUADRIC_BODY:
      value = qn_quadric_value(&scene->quadrics[half->shadow], f, &bound);
      break;
    case QN_SUPER_BODY:
      return super_sign(&scene->quadrics[half->shadow], f);
  }
  if (bound == 0) {
    return 0;
  }
  return fabs(value) > bound ? (value > 0 ? 1 : -1) : QN_UNSURE;
}
