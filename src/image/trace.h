/* From places in the picture to light: camera rays, their hits, shadow rays. */
#ifndef QN_IMAGE_TRACE_H
#define QN_IMAGE_TRACE_H

#include "image/light.h"
#include "query/look.h"
#include "scene/scene.h"

/* What all threads of one rendering share; constant while they run. */
typedef struct qn_picture {
  const quoin_scene *scene;
  qn_frustum frustum;
  qn_lamp *lamps;
  size_t lamp_count, lamp_capacity;
  qn_finish *finishes; /* by the scene's materials */
  size_t finish_count;
  double background[3]; /* linear */
  int shadows;
} qn_picture;

QN_NODISCARD quoin_status qn_picture_make(const quoin_scene *scene, const quoin_render_options *options, qn_picture *out);
void qn_picture_free(qn_picture *picture);

#define QN_NO_SURFACE_SEEN UINT64_MAX
/* One sample: its light, each component in [0, 1], and what is seen: the scene's surface << 32 | the material. */
typedef struct qn_sample { double light[3]; uint64_t surface; } qn_sample;

enum { QN_BATCH = 256 }; /* rays that are asked at once */

/* One thread's scratch. */
typedef struct qn_tracer {
  quoin_work *work;
  quoin_ray rays[QN_BATCH], shadow_rays[QN_BATCH];
  qn_seen hits[QN_BATCH], shadow_hits[QN_BATCH];
  qn_spot spots[QN_BATCH];
  double towards[QN_BATCH][3], cosine[QN_BATCH];
  uint32_t starts_on[QN_BATCH]; /* shadow rays' surfaces */
  uint32_t lit[QN_BATCH]; /* spots that wait for a shadow ray's answer */
  uint64_t camera_rays, shadow_ray_count, refined_pixels;
} qn_tracer;

/* Null when memory is refused; *status says how else it failed. */
QN_NODISCARD quoin_status qn_tracer_new(const quoin_scene *scene, qn_tracer **out);
void qn_tracer_free(const quoin_scene *scene, qn_tracer *tracer); /* null is allowed */

/* n <= QN_BATCH samples at the places xy (pixels from the top left corner). */
QN_NODISCARD quoin_status qn_trace(const qn_picture *picture, qn_tracer *tracer, size_t n, const double (*xy)[2], qn_sample *out);

#endif
