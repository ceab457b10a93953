/* A point against double shadows: values with bounds of their errors, and the signs these certify. */
#ifndef QN_QUERY_SHADOW_H
#define QN_QUERY_SHADOW_H

#include "scene/scene.h"

/* The point relative to a leaf's pivot: |true y_i - y[i]| <= u w[i], |y[i]| <= w[i]. */
typedef struct qn_frame { double y[3], w[3]; } qn_frame;
/* weight: |true x_i - x[i]| <= u weight[i]. */
qn_frame qn_frame_of(const double x[3], const double weight[3], const double pivot[3]);

/* q as computed, and in *bound how far from the true value it may be; infinite out of the range of the bounds, 0 for a certain zero. */
double qn_plane_value(const qn_plane_shadow *s, const qn_frame *f, double *bound);
double qn_quadric_value(const qn_quadric_shadow *s, const qn_frame *f, double *bound);

enum { QN_UNSURE = 2 };
/* The sign of a half-space's q: -1, 0 or 1, or QN_UNSURE. */
int qn_shadow_sign(const quoin_scene *scene, const qn_half *half, const qn_frame *f);

#endif
