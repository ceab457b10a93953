/* One thread's scratch for questions: what the files of this station share. */
#ifndef QN_QUERY_WORK_H
#define QN_QUERY_WORK_H

#include "ray/around.h"
#include "wide/points.h"

/* A leaf's own coordinates, in doubles: local = inverse . (x, 1); its primitive's arguments (a polyhedron has thousands). */
typedef struct qn_local {
  uint32_t leaf; /* and one: 0 where none is held */
  int singular;
  double inverse[12];
  double placement[6];
  double *args;
  size_t arg_count, arg_capacity;
  int placed;
} qn_local;

typedef struct qn_sheaf qn_sheaf; /* sheaf.h */
typedef struct qn_text_rays qn_text_rays; /* text_rays.c */

/* How long wide code may walk before a ray is woven instead; see packets.c. */
typedef struct qn_patience { uint32_t fair, lost, turn; int learns; } qn_patience;

struct quoin_work {
  const quoin_scene *scene;
  qn_mem *mem;
  qn_scratch *scratch;
  const qn_wide *wide; /* the packet body in use */
  double apart;        /* about how far leaves are from one another; infinite when that means nothing */
  qn_patience patience;
  int takes_turns;     /* incoherent rays of an array are walked several at a time: what they walk through is larger than the caches */

  /* A point's question (point.c). */
  uint32_t *stamp, now;   /* by surface: sign[] was found in question `now` */
  int8_t *sign;           /* by surface: of its exact form */
  uint32_t *candidates;      size_t candidate_count, candidate_capacity;
  qn_near_leaf *near;        size_t near_count, near_capacity;
  uint32_t *near_halves;     size_t near_half_count, near_half_capacity;
  quoin_status status;    /* QUOIN_E_MEMORY when an array could not grow */

  qn_point_walk *point_walk; /* of batches; made when first needed */
  const qn_cells *cells;     /* the scene's, once as many points have been asked as there are terms; or null */
  int cells_asked;

  /* A ray's answer. */
  quoin_interval *inside;    size_t inside_capacity;
  quoin_interval *boundary;  size_t boundary_capacity;
  quoin_end *contacts;       size_t contact_capacity;

  qn_sheaf *sheaf; /* of rays in packets; made when first needed */
  qn_text_rays *text_rays; /* a block of rays of decimals; made when first needed */

  qn_local *locals; size_t local_count; /* by leaf modulo; made when first needed */
};

/* A point as a question takes it: doubles with weights, and the exact coordinates when needed.
   |true x_i - x[i]| <= u weight[i]; weight 0: x[i] is exact. */
typedef struct qn_query_point {
  double x[3], weight[3];
  const char *text[3]; /* null: x[i] is exact; else the decimal, which must hold as long as the point */
  qn_num exact[3];
  qn_point point;
  int made; /* exact and point are there */
} qn_query_point;

/* Starts a question: the context is cleared, so it comes before the point is made. */
void qn_query_begin(quoin_work *work);
quoin_status qn_query_point_doubles(quoin_work *work, const double x[3], qn_query_point *out);
quoin_status qn_query_point_text(quoin_work *work, const char *const text[3], qn_query_point *out);
/* A decimal as a double, and the weight of what it lacks: 0 where it is exactly that. */
quoin_status qn_query_decimal(quoin_work *work, const char *text, double *x, double *weight);
/* A whole text as a number. */
quoin_status qn_query_number(quoin_work *work, const char *text, qn_num *out);

/* Fills work->near and work->near_halves: the leaves whose closed solids hold the point. all: also those that have no part
   in the scene's answer. */
quoin_status qn_query_near(quoin_work *work, qn_query_point *point, int all);

/* The side of one point, exactly: what wide code leaves. After qn_query_begin and the point's making. */
quoin_status qn_query_side(quoin_work *work, qn_query_point *point, quoin_side *out);

/* The leaf's coordinates; null when memory is refused. */
const qn_local *qn_query_local(quoin_work *work, uint32_t leaf);
void qn_query_locals_free(quoin_work *work);
void qn_text_rays_free(quoin_work *work);

#endif
