/* Whether one surface alone passes through a hit.

   Where several parts share the surface of a hit, a packet may have named another of them than the woven path does, and at a place where
   a second surface passes too even another surface (wide/packet.h). Here the places of all other half-spaces nearby are ruled out by
   the bounds of points (shadow.h), so that the surface is known; its parts may still be several. */
#include "base/bounds.h"
#include "query/look.h"
#include "query/shadow.h"

#include <math.h>

typedef struct place_asked {
  const quoin_scene *scene;
  double x[3], weight[3];
  uint32_t surface;
  int alone;
} place_asked;

static void see_leaf(void *user, uint32_t number) {
  place_asked *p = user;
  const qn_leaf *leaf = &p->scene->leaves[number];
  const qn_frame frame = qn_frame_of(p->x, p->weight, leaf->pivot);
  for (uint32_t h = leaf->half0; h < leaf->half0 + leaf->halves && p->alone; h++) {
    const qn_half *half = &p->scene->halves[h];
    if (half->surface != p->surface) {
      const int sign = qn_shadow_sign(p->scene, half, &frame);
      p->alone = sign == 1 || sign == -1;
    }
  }
}

/* The true point is o + T d with |T - t| <= error. As computed, x_i = fl(o_i + fl(t d_i)): |x_i - true| <= error |d_i| + u |t d_i| + u |x_i|. */
int qn_alone_there(const quoin_work *work, const quoin_ray *ray, double t, double error, uint32_t surface) {
  place_asked p = {.scene = work->scene, .surface = surface, .alone = 1};
  double min[3], max[3];
  for (int i = 0; i < 3; i++) {
    p.x[i] = ray->o[i] + t * ray->d[i];
    p.weight[i] = QN_SLACK * (error * fabs(ray->d[i]) / QN_U + fabs(t * ray->d[i]) + fabs(p.x[i])) + QN_POINT_TINY;
    const double off = QN_SLACK * QN_U * p.weight[i];
    min[i] = p.x[i] - off, max[i] = p.x[i] + off;
    if (!isfinite(min[i]) || !isfinite(max[i])) {
      return 0;
    }
  }
  uint64_t nodes = 0;
  qn_bvh_point(&p.scene->bvh, min, max, see_leaf, &p, &nodes);
  for (size_t i = 0; i < p.scene->unbounded_count && p.alone; i++) {
    see_leaf(&p, p.scene->unbounded[i]);
  }
  return p.alone;
}
