/* What each primitive's file gives to the table. */
#ifndef QN_SHAPE_ROWS_H
#define QN_SHAPE_ROWS_H

#include "shape/prim.h"

#define QN_ROW(name)                                                                                                      \
  qn_form_result qn_##name##_form(qn_ctx *ctx, const qn_num *args, size_t n, const qn_placement *placement,                \
                                  qn_half_form **halves, size_t *count);                                                  \
  double qn_##name##_support(const double *args, size_t n, const double placement[6], const double v[3]);                  \
  void qn_##name##_uv(const double *args, size_t n, const double placement[6], uint32_t role, const double x[3], double uv[2])

QN_ROW(sphere);
QN_ROW(ellipsoid);
QN_ROW(cube);
QN_ROW(cylinder);
QN_ROW(prism);
QN_ROW(paraboloid);
QN_ROW(hyperboloid1);
QN_ROW(hyperboloid2);
QN_ROW(saddle);
QN_ROW(quadric);
QN_ROW(halfspace);
QN_ROW(wedge);
QN_ROW(superquadric);
QN_ROW(polyhedron);

#undef QN_ROW

#endif
