/* quoin: pictures of a scene, into memory or a PNG file. */
#ifndef QUOIN_RENDER_H
#define QUOIN_RENDER_H

#include "quoin/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum quoin_projection { QUOIN_PERSPECTIVE, QUOIN_ORTHOGRAPHIC } quoin_projection;

/* Where the picture is taken from. The field of view is vertical; aspect is width over height, as in a frustum.
   Orthographic: the picture's height covers what perspective would at the distance of `look`. */
typedef struct quoin_camera {
  double eye[3], look[3], up[3];
  double fov;  /* degrees, vertical, over 0 and under 180 */
  double near; /* nothing nearer than this is seen; 0 or more, in world units along the view direction */
  quoin_projection projection;
} quoin_camera;

typedef struct quoin_render_options {
  size_t width, height;  /* pixels; default 800 x 600 */
  int has_camera;        /* 0: the model's camera, else a view that frames the solid */
  quoin_camera camera;
  int antialias;         /* default 1: more samples where neighbours differ in surface or light */
  unsigned samples;      /* samples a refined pixel takes, a square number up to 65536; default 16 */
  int shadows;           /* default 1 */
  unsigned threads;      /* 0: as many as the machine has */
  quoin_progress progress;
} quoin_render_options;
QUOIN_API quoin_render_options quoin_render_options_default(void);

/* The camera that frames the whole solid from a pleasant angle, for a picture of this aspect. An empty or unbounded
   solid gets a view of the unit cube around the origin (of its bounded sides where it has some). */
QUOIN_API void quoin_camera_default(const quoin_scene *scene, double aspect, quoin_projection projection, quoin_camera *out);

/* The same with a field of view of its own, in degrees; where that is not over 0 and under 180, quoin_camera_default's. */
QUOIN_API void quoin_camera_fit(const quoin_scene *scene, double aspect, quoin_projection projection, double fov, quoin_camera *out);

typedef struct quoin_render_stats {
  uint64_t camera_rays, shadow_rays, refined_pixels;
  uint64_t hits; /* camera rays that meet the solid; 0: nothing is in view */
  quoin_stats work; /* summed over threads */
} quoin_render_stats;

/* Renders into pixels: height rows of width RGBA bytes, top row first, sRGB, straight alpha; row_bytes apart.
   stats may be null. The picture does not depend on the number of threads. QUOIN_E_ARGUMENT: no pixels, row_bytes under 4 * width, samples not a square number up
   to 65536 (with antialias), a camera with no direction or a field of view that is not over 0 and under 180. Not QUOIN_OK: pixels may be partly written. */
QUOIN_API quoin_status quoin_render(const quoin_scene *scene, const quoin_render_options *options, unsigned char *pixels, size_t row_bytes, quoin_render_stats *stats);

/* Writes RGBA pixels as a PNG file (without alpha where all are opaque), whole or not at all (a temporary file beside it, then a rename). "-" is standard
   output. QUOIN_E_IO: errno tells why. */
QUOIN_API quoin_status quoin_write_png(const char *path, size_t width, size_t height, const unsigned char *pixels, size_t row_bytes);

#ifdef __cplusplus
}
#endif
#endif
