/* Roots of a superquadric along X(t) = O + t D, isolated with certainty and refined (design S10). In tiers, as for quadrics:
   searches in doubles with error bounds, which may say that they cannot tell, then the careful one, with the exact line.

   First the line is clipped: the solid lies in the box |X_i| <= 1, and outside the stretch [a, b] of the line in a box a little larger
   f > 1. Where that stretch is far from t = 0 the line is begun anew there, and the roots are moved at the end. With an exponent beyond 2 the solid lies in its hull, that of the exponent 2, and the stretch is narrowed to
   that. */
#include "shape/interval.h"
#include "shape/prim.h"
#include "shape/super_line.h"

/* The stretch of the line in the box |X_i| <= 1 + m, m more than what roundings, the pairs and t's own last bits move X_i by at its ends
   (docs/bounds.md, QN_SUPER_MARGIN). A coordinate whose speed is not known well enough for that is passed over. */
int qn_super_clip(const qn_super_frame *f, double *a, double *b) {
  double lo = -INFINITY, hi = INFINITY;
  for (int i = 0; i < 3; i++) {
    double o = f->O[i][0], d = fabs(f->D[i][0]), m = QN_SUPER_MARGIN + 16 * QN_U * fabs(o) + 2 * f->O_off[i];
    if (d == 0) {
      if (f->D_off[i] == 0 && fabs(o) > 1 + m) {
        return 0;
      }
      continue;
    }
    double spread = 2 * (fabs(o) + 2) * (f->D_off[i] / d);
    if (!(spread < 1)) {
      continue;
    }
    m += spread;
    o = f->D[i][0] < 0 ? -o : o;
    double l = ((-1 - m) - o) / d, h = ((1 + m) - o) / d;
    lo = l > lo ? l : lo;
    hi = h < hi ? h : hi;
  }
  *a = lo, *b = hi;
  return lo <= hi;
}

static qn_super_answer quick(const qn_super_frame *frame, const qn_super_line *c, double *a, double *b, double (*roots)[2], size_t max,
                             size_t *count) {
  if (c->convex) {
    double found[2][2];
    qn_super_answer answer = qn_super_convex(c, *a, *b, found);
    for (*count = 0; answer == QN_SUPER_FOUND && *count < 2 && *count < max; ++*count) {
      roots[*count][0] = found[*count][0], roots[*count][1] = found[*count][1];
    }
    return answer;
  }
  qn_super_line hull;
  qn_super_frame around = *frame;
  if (c->e > 2) {
    around.e[0] = 2, around.e[1] = 0;
  }
  if (c->n > 2) {
    around.n[0] = 2, around.n[1] = 0;
  }
  if (!qn_super_line_make(&around, *a, *b, &hull)) {
    return QN_SUPER_UNSURE;
  }
  if (qn_super_narrow(&hull, a, b) == QN_SUPER_NONE) {
    return QN_SUPER_NONE;
  }
  return qn_super_pieces(c, *a, *b, roots, max, count);
}

/* [a, b] lies so far from t = 0 that t's last bits are too wide to search by. */
static int is_far(const qn_super_frame *f, double a, double b) {
  const double most = fmax(fabs(f->D[0][0]), fmax(fabs(f->D[1][0]), fabs(f->D[2][0])));
  return isfinite(a) && isfinite(b) && fmax(fabs(a), fabs(b)) * most > 2 * QN_SUPER_FAR;
}

size_t qn_superquadric_roots(const qn_super_frame *frame, qn_super_ask ask, void *user, double (*roots)[2], size_t max) {
  qn_super_exact exact;
  qn_super_frame made, begun;
  int asked = frame == NULL;
  if (asked) {
    if (!ask(user, &exact)) {
      return 0;
    }
    qn_super_frame_from_exact(&exact, &made);
    frame = &made;
  }
  double a, b, begin = 0;
  if (!qn_super_clip(frame, &a, &b)) {
    return 0;
  }
  if (is_far(frame, a, b)) {
    begin = 0.5 * a + 0.5 * b;
    if (asked) {
      qn_super_exact_begin(&exact, begin);
      qn_super_frame_from_exact(&exact, &begun);
    } else {
      qn_super_frame_begin(frame, begin, &begun);
    }
    frame = &begun;
    if (!qn_super_clip(frame, &a, &b)) {
      return 0;
    }
  }
  qn_super_line c;
  qn_super_answer answer = QN_SUPER_UNSURE;
  size_t count = 0;
  if (isfinite(a) && isfinite(b) && qn_super_line_make(frame, a, b, &c)) {
    answer = quick(frame, &c, &a, &b, roots, max, &count);
  }
  if (answer == QN_SUPER_NONE) {
    return 0;
  }
  if (answer == QN_SUPER_UNSURE) {
    if (!asked) {
      if (!ask(user, &exact)) {
        return 0;
      }
      if (begin != 0) {
        qn_super_exact_begin(&exact, begin);
      }
    }
    count = qn_super_careful(&exact, roots, max);
  }
  for (size_t i = 0; begin != 0 && i < count; i++) {
    roots[i][0] = roots[i][1] = begin + (roots[i][0] + 0.5 * (roots[i][1] - roots[i][0]));
  }
  return count;
}
