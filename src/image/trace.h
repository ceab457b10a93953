/* From places in the picture to light: camera rays, their hits, shadow rays. */
#ifndef QN_IMAGE_TRACE_H
#define QN_IMAGE_TRACE_H

#include "image/shade.h"
#include "query/look.h"
#include "scene/scene.h"

enum { QN_TILE = 32 }; /* pixels a side, of the tiles in which a picture is made */
#define QN_NARROW 0.3  /* a tile's side at distance 1 */

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
  int narrow; /* the rays of any tile go the same way, near enough for packets */
} qn_picture;

QN_NODISCARD quoin_status qn_picture_make(const quoin_scene *scene, const quoin_render_options *options, qn_picture *out);
void qn_picture_free(qn_picture *picture);

/* One thread's scratch. */
typedef struct qn_tracer {
  qn_packet tile;     /* camera rays of the first pass */
  qn_packet samples;  /* camera rays one by one */
  qn_packet shadows;
  qn_spots spots;
  qn_seen seen[QN_LANES];
  quoin_ray alone[QN_LANES]; /* of packets that are too spread out */
  uint32_t alone_on[QN_LANES];
  uint64_t hits;      /* of the packet traced last: lanes that meet the solid; the others' surface is QUOIN_NO_SURFACE */
  const qn_lamp *shadows_of; /* whose directions stand in `shadows` */
  quoin_work *work;
  const qn_shade *shade;
  uint64_t camera_rays, shadow_ray_count, refined_pixels, hit_count;
} qn_tracer;

QN_NODISCARD quoin_status qn_tracer_new(const qn_picture *picture, qn_tracer **out);
void qn_tracer_free(const quoin_scene *scene, qn_tracer *tracer); /* null is allowed */

/* Traces the rays in tracer->tile or tracer->samples; the light of the live lanes, each component in [0, 1], and their surfaces are then in
   tracer->spots. */
QN_NODISCARD quoin_status qn_trace(const qn_picture *picture, qn_tracer *tracer, qn_packet *rays);

/* The rays through count <= QN_LANES places (x and y in pixels, from the picture's top left corner), one at least, into tracer->samples. The
   places behind them are set to the last. */
void qn_trace_places(const qn_picture *picture, qn_tracer *tracer, size_t count, double x[QN_LANES], double y[QN_LANES]);

#endif
