/* The camera: from a pixel to a ray. */
#ifndef QN_IMAGE_CAMERA_H
#define QN_IMAGE_CAMERA_H

#include "quoin/render.h"

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

/* The camera of the model's text, with what the text does not say filled in; the default view where it has none. */
void qn_camera_of_scene(const quoin_scene *scene, double aspect, quoin_camera *out);

#endif
