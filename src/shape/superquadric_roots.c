/* Roots of a superquadric along X(t) = O + t D, isolated with certainty and refined (design S10). In tiers, as for quadrics:
   searches in doubles with error bounds, which may say that they cannot tell, then the careful one.

   First the line is clipped: the solid lies in the box |X_i| <= 1, and outside the box's stretch [a, b] of the line, widened a
   little, f > 1. With an exponent beyond 2 the solid lies in its hull, that of the exponent 2, and the stretch is narrowed to
   that. */
#include "shape/interval.h"
#include "shape/prim.h"
#include "shape/super_line.h"

/* The stretch of the line in the box |X_i| <= 1, widened so that its ends are outside for certain, where it has a width at all. */
static int clip(const double O[3], const double D[3], double *a, double *b) {
  double lo = -INFINITY, hi = INFINITY;
  for (int i = 0; i < 3; i++) {
    double o = O[i], d = fabs(D[i]);
    if (d == 0) {
      if (fabs(o) > 1) {
        return 0;
      }
      continue;
    }
    o = D[i] < 0 ? -o : o;
    double l = qn_step_down(qn_step_down(-1 - o) / d), h = qn_step_up(qn_step_up(1 - o) / d);
    lo = l > lo ? l : lo;
    hi = h < hi ? h : hi;
  }
  if (!(lo <= hi) || isinf(lo) || isinf(hi)) {
    return 0;
  }
  double more = (hi - lo) * QN_SUPER_MARGIN;
  *a = qn_step_down(lo - more);
  *b = qn_step_up(hi + more);
  return 1;
}

static qn_super_answer quick(const qn_super_line *c, double *a, double *b, double (*roots)[2], size_t max, size_t *count) {
  if (c->e <= 2 && c->n <= 2) {
    double found[2][2];
    qn_super_answer answer = qn_super_convex(c, *a, *b, found);
    for (*count = 0; answer == QN_SUPER_FOUND && *count < 2 && *count < max; ++*count) {
      roots[*count][0] = found[*count][0], roots[*count][1] = found[*count][1];
    }
    return answer;
  }
  qn_super_line hull;
  if (!qn_super_line_make(fmin(c->e, 2), fmin(c->n, 2), c->O, c->D, &hull)) {
    return QN_SUPER_UNSURE;
  }
  if (qn_super_narrow(&hull, a, b) == QN_SUPER_NONE) {
    return QN_SUPER_NONE;
  }
  return qn_super_pieces(c, *a, *b, roots, max, count);
}

size_t qn_superquadric_roots(double e, double n, const double O[3], const double D[3], double (*roots)[2], size_t max) {
  double a, b;
  if (!clip(O, D, &a, &b)) {
    return 0;
  }
  qn_super_line c;
  size_t count = 0;
  if (qn_super_line_make(e, n, O, D, &c)) {
    switch (quick(&c, &a, &b, roots, max, &count)) {
    case QN_SUPER_NONE: return 0;
    case QN_SUPER_FOUND: return count;
    case QN_SUPER_UNSURE: break;
    }
  }
  return qn_super_careful(e, n, O, D, a, b, roots, max);
}
