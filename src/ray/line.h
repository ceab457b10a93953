/* A line: the ray without its ends, exactly and as doubles. */
#ifndef QN_RAY_LINE_H
#define QN_RAY_LINE_H

#include "number/quad.h"
#include "scene/scene.h"

/* The point at t is (origin + t direction) / w, with integers; made from the doubles when first needed. */
typedef struct qn_line {
  double o[3], d[3]; /* rounded to nearest when `rounded`, else exactly the line */
  int rounded;       /* given as decimals that are not doubles: |o| and |d| have relative error u */
  int exact;         /* the integers below are there */
  qn_int origin[3], direction[3], w; /* w > 0 */
} qn_line;

/* From doubles: finite, direction not zero (the caller checks). */
void qn_line_from_doubles(const double o[3], const double d[3], qn_line *out);
/* From exact numbers. */
void qn_line_from_numbers(qn_ctx *ctx, const qn_num o[3], const qn_num d[3], qn_line *out);
/* Makes the integers when they are not there. */
void qn_line_make_exact(qn_ctx *ctx, qn_line *line);
/* w^2 q(line(t)) = a t^2 + 2 h t + c for a surface (a, h, c doubled where the surface's mixed terms are odd: a positive multiple). */
void qn_line_quad(qn_ctx *ctx, const qn_line *line, const qn_exact_surface *surface, qn_quad *out);

#endif
