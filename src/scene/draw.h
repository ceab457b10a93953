/* The normal form in the making: what the files that draw it share. For normal.c, sets.c, union.c and draw.c only.

   Legend: a *set* is a gate's set or a leaf, numbered gates first: set s < gates is a gate, else leaf s - gates. A *draft* is a
   term being made; drafts, and the leaves they name, live on two stacks that a union's making pops. */
#ifndef QN_SCENE_DRAW_H
#define QN_SCENE_DRAW_H

#include "scene/scene.h"

#include <math.h>

typedef struct qn_draft {
  double min[3], max[3];
  uint32_t leaf0, leaves; /* in qn_drawing.names */
  uint32_t plus0, plus, minus0, minus; /* in qn_normal.lists */
} qn_draft;

typedef struct qn_drawing {
  const quoin_scene *scene;
  qn_mem *mem;
  qn_normal *n;
  unsigned threads;
  size_t gates;
  uint32_t *kid0, *kids;  /* by gate: its children's sets, kids[kid0[g]] to kids[kid0[g + 1]] */
  double (*box)[6];       /* by gate */
  uint32_t *shared;       /* by gate: the union of what a meet takes away, made once; by gate + gates: the gate's own set */
  uint8_t *truth;         /* by gate: true with every leaf outside */
  uint8_t *joins;         /* by gate: its set is a union of its children's */
  qn_draft *drafts; size_t draft_count, draft_capacity;
  uint32_t *names; size_t name_count, name_capacity; /* leaves of drafts */
  size_t instances, budget;
  quoin_status status;
} qn_drawing;

#define QN_NO_UNION UINT32_MAX

/* Records that memory was refused; 0. */
QN_INLINE int qn_draw_refuse(qn_drawing *m) {
  m->status = QUOIN_E_MEMORY;
  return 0;
}

QN_INLINE void qn_box_meet(double a[6], const double b[6]) {
  for (int i = 0; i < 3; i++) {
    a[i] = fmax(a[i], b[i]), a[3 + i] = fmin(a[3 + i], b[3 + i]);
  }
}

/* --- sets.c: the gates, read as sets -------------------------------------------------------------------------------- */

/* Fills kid0, kids, box, shared, truth and joins. 0: refused, or the gates are nested too deeply (then the status is still good). */
QN_NODISCARD int qn_sets_read(qn_drawing *m);
void qn_sets_free(qn_drawing *m);
void qn_set_box(const qn_drawing *m, uint32_t set, double box[6]);
/* Of a gate whose set is no union: the child is one of those that are met; else it is one of those taken away. */
int qn_set_is_met(const qn_drawing *m, uint32_t gate, uint32_t kid);

/* Sets listed, with a hierarchy over them. */
typedef struct qn_set_index {
  qn_bvh bvh;           /* over the first of sets; none when they are few or will be asked for seldom */
  uint32_t *sets;       /* by item number */
  size_t count, capacity;
  uint32_t *open; size_t open_count; /* sets without a bounded box */
} qn_set_index;
/* Lists sets, the children of unions in their place, and puts a hierarchy over them when it will be asked often. */
QN_NODISCARD int qn_set_index_make(qn_drawing *m, const uint32_t *list, size_t list_count, size_t asked, qn_set_index *x);
void qn_set_index_free(qn_drawing *m, qn_set_index *x);

/* --- union.c: drafts made into unions ------------------------------------------------------------------------------- */

int qn_box_is_finite(const double a[6]);
/* A hierarchy over boxes whose item numbers are the boxes' own. */
QN_NODISCARD quoin_status qn_build_over(qn_drawing *m, qn_bvh *bvh, size_t count, double (*boxes)[6]);
/* Makes a union of the drafts from `first` on and pops them. Returns its number, or QN_NO_UNION for an empty one or on refusal. */
uint32_t qn_union_make(qn_drawing *m, size_t first);
/* Appends `more` to a list of unions; lists are never changed once another follows, so the old part is copied. */
QN_NODISCARD int qn_list_extend(qn_drawing *m, uint32_t *list0, uint32_t *count, const uint32_t *more, uint32_t more_count);

/* --- draw.c: sets made into drafts ---------------------------------------------------------------------------------- */

/* Pushes drafts whose union is the set within `clip`. 0 on refusal. Recursive, as deep as QN_NORMAL_DEPTH. */
QN_NODISCARD int qn_draw(qn_drawing *m, uint32_t set, const double clip[6]);

#endif
