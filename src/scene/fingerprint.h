/* Fingerprints of surfaces, for finding candidates of equality. */
#ifndef QN_SCENE_FINGERPRINT_H
#define QN_SCENE_FINGERPRINT_H

#include "scene/scene.h"

enum { QN_PRINT_SIZE = 14 };

/* Coefficients and, for each, the sum of the magnitudes of its terms: 0 when it is 0 structurally. The error of c[i] is at most
   QN_PRINT_TERM magnitude[i]. */
typedef struct qn_vector { double c[QN_PRINT_SIZE], magnitude[QN_PRINT_SIZE]; } qn_vector;

/* The frame all fingerprints of a scene are taken in: amid its leaves, at their scale. */
typedef struct qn_print_frame { double origin[3]; int scale; } qn_print_frame;
void qn_print_frame_of(const quoin_scene *scene, qn_print_frame *out);

/* From the shadows. 0: numbers too large or small for doubles. */
int qn_vector_of(const quoin_scene *scene, const qn_leaf *leaf, const qn_half *half, const qn_print_frame *frame, qn_vector *out);
/* The sign of the first coefficient that is not 0, for all but superquadrics; 0 when it is not certain. The frame's origin does not
   change it: the first coefficient belongs to the part of highest degree. */
int qn_vector_sign(const qn_vector *v);
/* The fingerprint; 0 when its error may pass QN_PRINT_ERROR. */
int qn_print_of(const qn_vector *v, double print[2]);

#endif
