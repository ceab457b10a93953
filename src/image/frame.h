/* What has to be in the picture: how far a solid reaches in any direction, for cameras that frame it. */
#ifndef QN_IMAGE_FRAME_H
#define QN_IMAGE_FRAME_H

#include "scene/scene.h"

/* centre + sum of u_i axis_i over the vectors u of length at most 1: an ellipsoid, a disc when an axis is zero. */
typedef struct qn_oval { double centre[3], axis[3][3]; } qn_oval;

/* The hull of the ovals, if any, within a box. */
typedef struct qn_hull {
  double min[3], max[3];
  int ovals;
  qn_oval oval[2];
} qn_hull;

enum { QN_HULLS = 256 }; /* more leaves than these are framed by their boxes alone */

/* The leaves that hold a bounded solid, each clipped to the box from min to max. Leaves whose outside is meant hold nothing. */
typedef struct qn_framed {
  const quoin_scene *scene; /* asked when there are too many leaves to be listed */
  double min[3], max[3];
  size_t count;             /* 0: too many, or none */
  qn_hull hull[QN_HULLS];
} qn_framed;
void qn_framed_make(const quoin_scene *scene, const double min[3], const double max[3], qn_framed *out);

/* The largest v . (x - origin) over all points x of the hulls, up to rounding. */
double qn_framed_reach(const qn_framed *framed, const double origin[3], const double v[3]);

#endif
