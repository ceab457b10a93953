/* A superquadric along a line, in doubles with certain errors: the tier before the careful search (superquadric_careful.c).

   Legend: X(t) = O + t D, in pairs of doubles (super_frame.h); x, y, z = |X_i|; p = 2/e, q = 2/n; rho = (x^p + y^p)^(1/p); f = rho^q + z^q, the inside-outside
   function: the solid is f <= 1. Each of these routines answers for certain, for the exact line, or says that it cannot tell. */
#ifndef QN_SHAPE_SUPER_LINE_H
#define QN_SHAPE_SUPER_LINE_H

#include "shape/super.h"
#include "shape/super_frame.h"

#include "base/attrs.h"

#include <math.h>
#include <stddef.h>

/* How rho^q is had. */
typedef enum qn_super_inner {
  QN_SUPER_SAME,   /* e = n: x^p + y^p */
  QN_SUPER_ROUND,  /* p = 2: (x^2 + y^2)^(q/2) */
  QN_SUPER_SUM,    /* p = 1: (x + y)^q */
  QN_SUPER_LARGER, /* e = 0: max(x, y)^q */
  QN_SUPER_ANY     /* a^q 2^(s log2(1 + w)), a = max(x, y), w = (min(x, y)/a)^p, s = e/n */
} qn_super_inner;

typedef struct qn_super_line {
  double e, n, p, q, s, O[3], D[3], O_rest[3], D_rest[3];
  double e_rest, n_rest;
  double off[3];         /* |X_i - X_i^| but for roundings relative to X_i, on the stretch of the line that was given */
  double shift, drift;   /* convex: what that adds to the errors of f and df/dt, times max(1, f); both 0: nothing does, in any case */
  double crude;          /* not convex: times the largest off_i/|X_i| what is added to the errors of df/dt, of itself */
  int convex;            /* e, n <= 2 */
  double size;           /* the longest stretch of such a line in the box |X_i| <= 1 */
  double error, scale;   /* f's error: QN_SUPER_VALUE(s, q); times scale */
  double faded;          /* what df/dt may lose to underflow */
  int fine;              /* in long doubles */
  qn_super_inner inner;
  unsigned p2, q2, r2;   /* twice p, q, q/2 where that is an integer up to QN_SUPER_HALVES, else 0: products and a root, no logarithm */
} qn_super_line;

enum { QN_SUPER_HALVES = 64 };

/* f - 1 and df/dt with their errors; of them rho^q, d(rho^q)/dt with its error, and z^q. */
typedef struct qn_super_look {
  double over, slope, error, slope_error, inner, rise, rise_error, outer;
  double crude; /* what the coordinates add to the slopes' errors, of themselves; 0 where convex */
} qn_super_look;

typedef enum qn_super_answer { QN_SUPER_NONE, QN_SUPER_FOUND, QN_SUPER_UNSURE } qn_super_answer;

/* For t in [a, b]. 0: the exponents or the direction are out of the range for which the errors were derived. */
int qn_super_line_make(const qn_super_frame *frame, double a, double b, qn_super_line *out);

QN_INLINE double qn_super_along(const qn_super_line *c, int i, double t) { return fma(c->D[i], t, c->O[i]) + (c->D_rest[i] * t + c->O_rest[i]); }

/* At a t where |X_i| <= 1 + 2 QN_SUPER_MARGIN. Cost: 20 to 80 ns; fine: about 1 us. */
qn_super_look qn_super_look_at(const qn_super_line *c, double t);

/* The same in long doubles where these have 64 bits and more: errors 2^11 times less. 0: it is so already, or cannot be. */
int qn_super_finer(const qn_super_line *c, qn_super_line *out);

/* The line walked the other way: t changes its sign. */
qn_super_line qn_super_reversed(const qn_super_line *c);

/* Convex (e, n <= 2): the stretch inside, its two ends enclosed, [outside, inside] and [inside, outside]; f > 1 outside [a, b]. */
qn_super_answer qn_super_convex(const qn_super_line *c, double a, double b, double roots[2][2]);
/* Convex: [*a, *b], outside of which f > 1, is made narrower by a few tangents. NONE: f > 1 throughout. */
qn_super_answer qn_super_narrow(const qn_super_line *c, double *a, double *b);
/* Any exponents: all roots in [a, b], f > 1 outside it. FOUND with *count, which may be 0. */
qn_super_answer qn_super_pieces(const qn_super_line *c, double a, double b, double (*roots)[2], size_t max, size_t *count);

/* What the pairs of a frame leave of O_i + t D_i for |t| <= most and where its slope counts over stretches in there; 0: nothing. */
double qn_super_off(const qn_super_frame *frame, int i, double most);
/* A stretch of the line outside of which every point has a coordinate beyond 1 for certain, which may be infinite; 0: every point of the line has. */
int qn_super_clip(const qn_super_frame *frame, double *a, double *b);

/* The search that always answers (within S10). */
size_t qn_super_careful(const qn_super_exact *line, double (*roots)[2], size_t max);

#endif
