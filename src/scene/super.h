/* A superquadric's frame, in pairs of doubles and exactly: made when first needed, published atomically, kept with the scene. One for a surface, whichever leaf asks. */
#ifndef QN_SCENE_SUPER_H
#define QN_SCENE_SUPER_H

#include "scene/scene.h"
#include "shape/super_frame.h"

typedef struct qn_super_form {
  qn_super_rows rows;
  qn_num row[3][4], e, n; /* X_i = row[i] . (x, 1) */
  qn_ctx ctx;             /* their memory; nothing is added to it */
  uint8_t beyond;         /* a limit was met: there is nothing else */
} qn_super_form;

/* What qn_scene_super does the first time. */
QN_NODISCARD const qn_super_form *qn_super_form_make(const quoin_scene *scene, uint32_t surface, quoin_status *status);

/* Of a superquadric's surface. Null when memory is refused or a limit is met, which *status then says. Threads: any. */
QN_INLINE const qn_super_form *qn_scene_super(const quoin_scene *scene, uint32_t surface, quoin_status *status) {
  const qn_super_form *there = atomic_load_explicit(&scene->surfaces[surface].super, memory_order_acquire);
  return QN_LIKELY(there != NULL && !there->beyond) ? there : qn_super_form_make(scene, surface, status);
}

void qn_super_form_free(qn_mem *mem, qn_super_form *form);

#endif
