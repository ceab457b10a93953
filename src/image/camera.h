/* The camera: from a pixel to a ray. */
#ifndef QN_IMAGE_CAMERA_H
#define QN_IMAGE_CAMERA_H

#include "quoin/render.h"
#include "wide/packet.h"

/* A camera made ready for a picture of width x height pixels. right, up, forward: an orthonormal right-handed frame of the
   picture (right x up = -forward). half_w, half_h: half the picture's width and height at distance 1 (perspective), or in
   world units (orthographic). */
typedef struct qn_frustum {
  double eye[3], right[3], up[3], forward[3];
  double half_w, half_h, near;
  double width, height; /* pixels */
  int orthographic;
} qn_frustum;

/* QUOIN_E_ARGUMENT: a number is not finite, eye and look are one point, up is zero, fov is not between 0 and 180, or near is
   negative. */
quoin_status qn_frustum_make(const quoin_camera *camera, size_t width, size_t height, qn_frustum *out);

/* The ray through (x, y) of the picture, in pixels from its top left corner; the centre of pixel (i, j) is (i + 1/2, j + 1/2).
   Its t is the depth: the distance from the eye along the view direction. It begins at near. */
void qn_frustum_ray(const qn_frustum *frustum, double x, double y, quoin_ray *out);

/* The same doubles for the places of all lanes, into out's o or d; the other of them is qn_frustum_share's. */
void qn_frustum_rays(const qn_frustum *frustum, const double x[QN_LANES], const double y[QN_LANES], qn_packet *out);

/* The rays through the centres of the 8 by 8 pixels from (x, y) on, as a tile of a packet; columns and rows from x1 and y1 on repeat the
   last. The same doubles as qn_frustum_ray's. Fills in everything but what is the same for all tiles (qn_frustum_share). */
void qn_frustum_tile(const qn_frustum *frustum, size_t x, size_t y, size_t x1, size_t y1, qn_packet *out);
/* A tile of that kind between whose first and last columns and rows are all pixels from (x, y) to (x1, y1): for an entry (qn_enter_fn in wide/packet.h). */
void qn_frustum_block(const qn_frustum *frustum, size_t x, size_t y, size_t x1, size_t y1, qn_packet *out);
/* What all packets of camera rays share, for packets of tiles or of rays made one by one: from, to, on, and the eye or the direction. */
void qn_frustum_share(const qn_frustum *frustum, int tiles, qn_packet *out);

/* The camera of the model's text, with what the text does not say filled in; the default view where it has none. */
void qn_camera_of_scene(const quoin_scene *scene, double aspect, quoin_camera *out);

#endif
