/* One thread's scratch, opened: what the files of this station share. Not for other stations. */
#ifndef QN_RAY_SCRATCH_H
#define QN_RAY_SCRATCH_H

#include "ray/weave.h"

/* One surface solved along the line of the question: its roots of odd multiplicity, in order. */
typedef enum qn_solved_kind {
  QN_SOLVED_SURFACE, /* roots of a quadratic, as enclosures; its exact form when needed */
  QN_SOLVED_EXACTLY  /* places that are exactly their doubles (a superquadric's), or a rational: an end of the range */
} qn_solved_kind;

typedef struct qn_root_at { double t, e; } qn_root_at; /* |root - t| <= e */

typedef struct qn_solved {
  uint32_t surface;      /* or QN_NO_SURFACE */
  uint32_t root0, roots; /* into scratch->roots */
  int8_t sign;           /* of the surface's form before the first root; 0: zero all along the line */
  uint8_t kind;
  uint8_t touches;       /* a double root at roots[root0], which is not counted in `roots` */
  uint8_t rational;      /* num/den are there */
  const qn_quad *quad;   /* null until needed */
  qn_int num, den;
} qn_solved;

/* A place on the line as this station handles it: t = -inf or +inf with solved = QN_NO_SOLVED, or a root. */
typedef struct qn_bound {
  double t, e;
  uint32_t solved, half; /* half: of scene->halves, the one that makes it */
  uint32_t which;
} qn_bound;
#define QN_NO_SOLVED UINT32_MAX
#define QN_NO_HALF UINT32_MAX
#define QN_NO_LEAF UINT32_MAX

typedef struct qn_span { qn_bound lo, hi; } qn_span;

typedef struct qn_event {
  qn_bound at;
  uint32_t leaf;
  uint8_t enter;
  uint8_t vague; /* the leaf has half-spaces in whose surfaces the line runs: they were taken as satisfied */
} qn_event;

typedef struct qn_event_key { uint32_t key, event; } qn_event_key;

typedef struct qn_memo { uint32_t stamp, solved; } qn_memo;

/* The line as the double filter takes it: tiny components flushed, with the weight of what that loses (docs/bounds.md, QN_FLUSH). */
typedef struct qn_filter_line {
  double o[3], d[3];
  double wo[3], wd[3]; /* |true o - o| <= u wo, |true d - d| <= u wd */
  double inverse;      /* about 1/(d . d), or 0 */
  int wild;            /* out of the filter's range: all is exact */
} qn_filter_line;

struct qn_scratch {
  const quoin_scene *scene;
  qn_mem *mem;
  qn_ctx ctx;
  qn_eval eval;  /* at rest between questions: for whoever asks */
  qn_eval weave; /* the weave's own */
  qn_counts counts;
  quoin_status status; /* of the question: QUOIN_E_MEMORY when an array could not grow */

  qn_line *line;       /* of the memo */
  qn_filter_line filter;
  uint32_t stamp;
  int rounded_ties;    /* ends were put in order that tie by the rule for rounded numbers */
  qn_memo *memo;       /* by surface */
  uint8_t *range;      /* by half: qn_half_range */
  qn_solved *solved;     size_t solved_count, solved_capacity;
  qn_root_at *roots;     size_t root_count, root_capacity;
  uint32_t *candidates;  size_t candidate_count, candidate_capacity;
  uint32_t *sorted;      size_t sorted_capacity; /* another room for as many */
  qn_span *spans;        size_t span_capacity; /* a leaf's, two buffers of span_capacity / 2 */
  qn_event *events;      size_t event_count, event_capacity;
  qn_event *sorting;     size_t sorting_capacity;
  qn_event_key *keys;    size_t key_capacity;
  qn_bound *touches;     size_t touch_count, touch_capacity;
  qn_stretch *inside;    size_t inside_count, inside_capacity;
  qn_stretch *boundary;  size_t boundary_count, boundary_capacity;
  qn_stop *contacts;     size_t contact_count, contact_capacity;
};

/* Records want of memory in the question's status. */
QN_INLINE void qn_scratch_fail(qn_scratch *s, quoin_status status) {
  if (s->status == QUOIN_OK) {
    s->status = status;
  }
}
/* The question's status: of the arrays and of the exact context. */
QN_INLINE quoin_status qn_scratch_status(const qn_scratch *s) { return s->status != QUOIN_OK ? s->status : s->ctx.failed; }

/* --- solve.c, filter.c: one surface along the line ------------------------------------------------------------------ */

/* Starts a line: forgets what was solved, sets the filter up. */
void qn_solve_begin(qn_scratch *s, qn_line *line);

/* A leaf's share of the filter: the line's origin relative to its pivot, and the same moved near to it. */
typedef struct qn_filter_leaf {
  double o[3], wo[3];           /* o - pivot, |true - o| <= u wo */
  double shift, y[3], wy[3];    /* o - pivot + shift d; made when `shifted` */
  int shifted;
} qn_filter_leaf;
void qn_filter_leaf_begin(const qn_filter_line *line, const double pivot[3], qn_filter_leaf *leaf);

/* What the double filter finds of one half-space, signs and roots of its own q. */
typedef struct qn_filtered {
  int count;
  int sign; /* before the first root; 0: identically zero, for certain */
  qn_root_at at[2];
} qn_filtered;
/* A quadric along the line: p(start + s) = a s^2 + 2 h s + c, each within its e of the truth. */
typedef struct qn_filter_form { double a, h, c, ea, eh, ec, disc, ed, start; } qn_filter_form;
void qn_filter_form_make(const qn_filter_line *line, qn_filter_leaf *leaf, const qn_quadric_shadow *q, int tiny, qn_filter_form *f);
/* The line as the filter takes it. */
void qn_filter_line_make(const qn_line *line, qn_filter_line *f);
/* Whether numbers of a shadow are in the filter's range: 0 no, 1 yes, 2 yes but some are tiny. */
int qn_filter_range(const double *v, size_t n);
/* 1 when everything in out is certain. tiny: the shadow has entries below QN_FLUSH. */
int qn_filter_plane(const qn_filter_line *line, const qn_filter_leaf *leaf, const qn_plane_shadow *p, int tiny, qn_filtered *out);
int qn_filter_quadric(const qn_filter_line *line, qn_filter_leaf *leaf, const qn_quadric_shadow *q, int tiny, qn_filtered *out);

/* Index of the solved surface of a half-space of a leaf. */
uint32_t qn_solve_half(qn_scratch *s, const qn_leaf *leaf, qn_filter_leaf *frame, uint32_t index);
/* The quadratic of a solved surface (never of a QN_SOLVED_EXACTLY); null when memory was refused. */
const qn_quad *qn_solved_quad(qn_scratch *s, uint32_t solved);
/* A bound for a place that is not a root found here. */
qn_bound qn_bound_from_place(qn_scratch *s, const qn_place *place);
qn_place qn_bound_place(const qn_scratch *s, const qn_bound *b);
/* A bound for a root of a quadratic that lives as long as the question and is no surface's. */
qn_bound qn_bound_from_root(qn_scratch *s, qn_root root);

/* A finite double as num/den (line.c). */
void qn_exact_double(qn_ctx *ctx, double v, qn_int *num, qn_int *den);

/* --- place.c: order ------------------------------------------------------------------------------------------------- */
int qn_bound_cmp_slow(qn_scratch *s, const qn_bound *a, const qn_bound *b);
QN_INLINE int qn_bound_cmp(qn_scratch *s, const qn_bound *a, const qn_bound *b) {
  double gap = b->t - a->t, e = a->e + b->e;
  if (gap > e) {
    return -1;
  }
  if (-gap > e) {
    return 1;
  }
  return qn_bound_cmp_slow(s, a, b);
}
/* The same order with ties of rounded places broken, so that it is transitive (qn_root_cmp_stored). */
int qn_bound_order(qn_scratch *s, const qn_bound *a, const qn_bound *b);
/* The root that a finite bound is; a rational as the root of a linear one. */
qn_root qn_bound_root(qn_scratch *s, const qn_bound *b);
/* A rational strictly between two bounds a < b, either of which may be infinite. */
void qn_bound_between(qn_scratch *s, const qn_bound *a, const qn_bound *b, qn_int *num, qn_int *den);

/* --- order.c: what a line meets, in order --------------------------------------------------------------------------- */
/* Many candidates in the order of their numbers; few as they are. */
void qn_order_candidates(qn_scratch *s);
/* All events by place, exactly. */
void qn_order_events(qn_scratch *s);
/* n events by place, exactly; those at one place keep their order. */
void qn_order_places(qn_scratch *s, qn_event *events, size_t n);
/* Events at one place by leaf. */
void qn_order_group(qn_scratch *s, qn_event *events, size_t n);

/* --- leafspan.c: the stretches of one leaf -------------------------------------------------------------------------- */

/* The leaf's stretches in order, closed, of positive length, half-spaces in whose surface the line runs taken as satisfied
   (then *vague). They live until the next call. touches: places where half-spaces only meet are added to s->touches. */
size_t qn_leaf_spans(qn_scratch *s, uint32_t leaf, int touches, const qn_span **spans, int *vague);

/* --- turn.c: where what is beside a line in surfaces may change, though it crosses none ------------------------------- */
/* Events of which `at` and `leaf` are a surface's that turns there; in order, each place once, from the events' leaves. 0: memory was refused; the context tells
   of other failures. */
int qn_find_turns(qn_scratch *s, qn_event **out, size_t *count);

/* --- coplanar.c: stretches that run in surfaces (S7); contact.c ----------------------------------------------------- */
void qn_weave_coplanar(qn_scratch *s, const qn_bound *from, const qn_bound *to);
void qn_weave_contacts(qn_scratch *s, const qn_bound *from, const qn_bound *to);

/* --- weave.c: what the two share with it ----------------------------------------------------------------------------- */
/* The end of the group of events at one place that begins at `at`; the group comes out in the order of leaves. */
size_t qn_weave_group(qn_scratch *s, size_t at);
/* Adds a stretch between two stops to a list, cut to the range; drops what lies outside it. */
void qn_weave_add(qn_scratch *s, int boundary, const qn_event *enter, const qn_event *leave, const qn_bound *from, const qn_bound *to);

#endif
