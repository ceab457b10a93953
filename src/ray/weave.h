/* All boundaries of the scene along a line, in exact order: leaves are solved, their ends sorted, the program woven through them.

   How: the hierarchy gives the leaves the line may meet. A leaf's half-spaces are solved in doubles with certified
   enclosures; a verdict or an order that the enclosures cannot give is taken in exact arithmetic for just that pair.
   Ends at one place are one event. Surfaces in which the line runs (p = 0) are resolved as design S7 says. */
#ifndef QN_RAY_WEAVE_H
#define QN_RAY_WEAVE_H

#include "ray/line.h"

/* A place on the line: a root of a surface, or a dyadic of a superquadric's root or of the ray's end, or infinity. */
typedef struct qn_place {
  double t, e;        /* |true t - t| <= e; e = 0: exactly t; t infinite: the line's end */
  uint32_t surface;   /* QN_NO_SURFACE: the place is exactly t, or the rational num/den */
  int which;          /* the root's index */
  qn_int num, den;    /* for a rational end given as a decimal */
  const qn_quad *turn; /* with QN_NO_SURFACE: the place is this quadratic's root (turn.c); lives until the next question */
} qn_place;
#define QN_NO_SURFACE UINT32_MAX

/* A stretch's end: its place, and who makes it. */
typedef struct qn_stop {
  qn_place place;
  uint32_t leaf, half; /* the leaf and its half-space (index in scene->halves); UINT32_MAX at the ray's ends */
} qn_stop;
typedef struct qn_stretch { qn_stop enter, leave; } qn_stretch;

typedef struct qn_counts { /* see quoin_stats */
  uint64_t rays, points, packets, nodes, leaves, filter_sure, exact_signs, exact_orders, exact_rays, exact_points, exact_roundings, exact_forms;
} qn_counts;

/* One thread's scratch for one scene. */
typedef struct qn_scratch qn_scratch;
quoin_status qn_scratch_new(const quoin_scene *scene, qn_scratch **out);
void qn_scratch_free(qn_scratch *scratch);
qn_counts *qn_scratch_counts(qn_scratch *scratch);
qn_ctx *qn_scratch_ctx(qn_scratch *scratch); /* cleared at the start of each question */
qn_eval *qn_scratch_eval(qn_scratch *scratch); /* at rest (every leaf outside) between questions */
/* Spends effort of the question on count things (base/limits.h); 0 when that is too much, and the question has failed. Long numbers are not
   counted: a text that spells them is as long. */
int qn_scratch_spend(qn_scratch *scratch, size_t count, unsigned each);
/* Starts a question: clears the context. Lines and numbers of earlier questions are gone. */
void qn_scratch_begin(qn_scratch *scratch);

typedef struct qn_range { qn_place from, to; } qn_range; /* the part of the line that is asked for */

typedef struct qn_woven { /* arrays live until the next question */
  const qn_stretch *inside; size_t inside_count;
  const qn_stretch *boundary; size_t boundary_count; /* when wanted */
  const qn_stop *contacts; size_t contact_count;     /* when wanted */
} qn_woven;

/* want: QUOIN_WANT_* and QN_WANT_FIRST: only the first stretch is needed (fewer leaves may be solved). */
enum { QN_WANT_FIRST = 64 };
quoin_status qn_weave(const quoin_scene *scene, qn_scratch *scratch, qn_line *line, const qn_range *range, unsigned want, qn_woven *out);

/* The order of two places on one line, exact: -1, 0, 1. */
int qn_place_cmp(const quoin_scene *scene, qn_scratch *scratch, qn_line *line, const qn_place *a, const qn_place *b);
/* The double nearest to a place: from doubles where they certify the rounding, else exactly. */
double qn_place_round(const quoin_scene *scene, qn_scratch *scratch, qn_line *line, const qn_place *place);

#endif
