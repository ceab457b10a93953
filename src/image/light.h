/* Light: what a point of a surface sends to the eye. All colours here are linear. */
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

/* A point to be lit: its place, the unit normal on the viewer's side, the unit vector towards the viewer. */
typedef struct qn_spot { double point[3], normal[3], viewer[3]; } qn_spot;

/* What reaches the eye without any light: the ambient term. */
void qn_light_ambient(const qn_finish *finish, double out[3]);
/* The unit vector from a spot towards a lamp, and its cosine with the normal. 0 when the lamp is behind the surface or at
   the spot. */
int qn_light_towards(const qn_lamp *lamp, const qn_spot *spot, double towards[3], double *cosine);
/* Adds the diffuse and the specular term of a lamp that the spot sees. */
void qn_light_add(const qn_finish *finish, const qn_lamp *lamp, const qn_spot *spot, const double towards[3], double cosine,
                  double out[3]);

/* The shadow ray of a hit at t of `ray`, seen from outside the solid: from the computed point, moved outwards along `normal` by
   QN_SHADE_POINT's bound, towards a lamp; it ends at the lamp where that is a place. */
void qn_shadow_ray(const quoin_ray *ray, double t, const double point[3], const double normal[3],
                   const qn_lamp *lamp, quoin_ray *out);

#endif
