/* What the files that find equal surfaces share. */
#ifndef QN_SCENE_IDENTITY_H
#define QN_SCENE_IDENTITY_H

#include "scene/compile.h"
#include "scene/fingerprint.h"

/* --- forms.c: exact half-spaces of leaves, one thread's ----------------------------------------------------------- */

struct qn_known_map;
typedef struct qn_forms {
  const qn_building *b;
  qn_ctx ctx;          /* forms of the leaf in work */
  uint32_t leaf;       /* the leaf whose forms are there, or QN_NO_LEAF */
  qn_half_form *forms;
  qn_ctx other;        /* forms of the surface compared with */
} qn_forms;
#define QN_NO_LEAF UINT32_MAX

void qn_forms_init(qn_forms *f, const qn_building *b);
void qn_forms_free(qn_forms *f);
/* The exact half-space in world coordinates, in f->ctx until another leaf is asked for. */
QN_NODISCARD quoin_status qn_forms_half(qn_forms *f, uint32_t leaf, uint32_t half, const qn_half_form **form);
/* The same of another leaf, in f->other (emptied first). */
QN_NODISCARD quoin_status qn_forms_other(qn_forms *f, uint32_t leaf, uint32_t half, qn_half_form *form);

/* --- crowd.c: fingerprints, and which half-spaces have another near theirs ---------------------------------------- */

enum {
  QN_SUBJECT = 1, /* its fingerprint is made: it has no key, or is the first with its key in a batch */
  QN_CROWDED = 2  /* another subject may have its fingerprint, or its side is not known: the exact forms are to be compared */
};

typedef struct qn_crowd {
  double (*prints)[2];   /* by half-space, of subjects */
  int8_t *side;          /* likewise: against its own normalised form; 0: not known */
  _Atomic uint8_t *is;   /* likewise */
  size_t room;
} qn_crowd;

QN_NODISCARD quoin_status qn_crowd_find(qn_crowd *crowd, qn_building *b, const qn_print_frame *frame);
void qn_crowd_free(qn_crowd *crowd, qn_mem *mem);

#endif
