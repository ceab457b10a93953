/* Lamps and finishes made ready. What they do to a point is in shade.h. All colours here are linear. */
#ifndef QN_IMAGE_LIGHT_H
#define QN_IMAGE_LIGHT_H

#include "image/camera.h"
#include "model/solid.h"

/* A light made ready. */
typedef struct qn_lamp {
  double place[3]; /* where it is; directional: the unit vector towards it */
  double color[3]; /* linear intensity; it does not fall off with distance */
  int directional;
  int headlight;   /* at the eye: what the camera sees it sees too, so it has no shadows; diffuse only */
} qn_lamp;

enum { QN_DEFAULT_LAMPS = 2 };
/* The lights of a model without any: a key over the viewer's left shoulder and a fill at the eye, fixed to the view. */
void qn_lamps_default(const qn_frustum *frustum, qn_lamp out[QN_DEFAULT_LAMPS]);
/* A light of the model. 0: it gives no light (a direction of zero, or not finite). */
int qn_lamp_from_light(const qn_light *light, qn_lamp *out);

/* A material made ready. */
typedef struct qn_finish { double color[3], ambient, diffuse, specular, shininess; } qn_finish;
void qn_finish_from_material(const qn_material *material, qn_finish *out);

#endif
