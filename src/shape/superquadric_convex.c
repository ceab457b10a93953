/* Roots of a convex superquadric (e, n <= 2) along a line, by tangents.

   f is convex, and so is G = f^(1/q), whose tangents are the steeper ones where f is large: at a place t with f > 1 and f' < 0
   there is no root before
       t + (1 - 1/G) G/|G'| = t + (1 - f^(-1/q)) q f/|f'|
   (Newton's step for G). With h <= f - 1: y = 2h/(q (2 + h)) <= ln f/q and y/(1 + y) <= 1 - e^(-y), so that a step that is
   certainly not too long takes no power. So l, the end of what is outside for certain, moves to the root, at last
   quadratically; it passes the minimum only where there is no root, and there a slope upward with f > 1 ends the search. The
   inner end of the enclosure is a place inside, looked for just beyond where the root must be by then.

   A step leaves the error bend = step^2 |G''|/2|G'|, known from the slopes at two places; the next place is moved on by most of
   it.
   Where doubles leave the root wider than QN_SUPER_FINE, or a sign open, long doubles go on. */
#include "shape/interval.h"
#include "shape/super_line.h"

enum { MOST_LOOKS = 60, NARROW_LOOKS = 4 };

/* Up to where there is certainly no root, from a place with f > 1 and slope < 0. */
static double tangent(const qn_super_line *c, double t, const qn_super_look *s) {
  double h = s->over - s->error, y = 2 * h / (c->q * (2 + h));
  double step = c->q * (1 + h) * y / ((1 + y) * (s->slope_error - s->slope));
  double next = qn_step_down(t + step * (1 - QN_SUPER_TANGENT));
  return next > t ? next : t;
}

/* The first root in [a, b], f > 1 up to a. f > 1 up to *lo for certain, f < 1 at *hi. */
static qn_super_answer enter(const qn_super_line *c, double a, double b, double *lo, double *hi) {
  qn_super_line finer;
  double l = a, t = a, h = INFINITY, last = 0, last_rate = 0, near = 0, flat = 1 - 1 / c->q;
  int slopes = 0;
  for (int looks = 0; looks < MOST_LOOKS; looks++) {
    qn_super_look s = qn_super_look_at(c, t);
    double bits = QN_STEP * fabs(t), wide = fmax(QN_SUPER_FINE * c->size, 8 * bits);
    int open = 0; /* cannot tell */
    if (s.over > s.error && s.slope < -s.slope_error) {
      double rate = s.slope / (1 + flat * s.over), bend = 0; /* rate: of G, times q */
      l = tangent(c, t, &s);
      if (l > b) {
        return QN_SUPER_NONE;
      }
      if (slopes) {
        bend = 0.5 * (l - t) * (l - t) * fabs((rate - last_rate) / (rate * (t - last)));
      }
      near = 2.5 * s.error / -s.slope + 2 * bits;
      last = t, last_rate = rate;
      t = l + (!slopes ? 0 : bend < 0.25 * near ? near + 1.5 * bend : 0.75 * bend);
      t = t < h ? t : l;
      slopes = 1;
    } else if (s.over > s.error && t > l) { /* too far */
      t = l;
      slopes = 0;
    } else if (s.over > s.error && s.slope > s.slope_error) {
      return QN_SUPER_NONE;
    } else if (s.over < -s.error && l < t) {
      h = t;
      if (h - l <= 2 * near) {
        double root = t - s.over / s.slope; /* the best guess: the enclosure's middle */
        *lo = fmin(l, root - (h - root)), *hi = h;
        if (*hi - *lo <= wide) {
          return QN_SUPER_FOUND;
        }
        open = 1;
      } else { /* outside, or next to the root */
        double back = s.slope < 0 ? t - (s.over - 2.5 * s.error) / s.slope - bits : l;
        t = back > l && back < h ? back : l;
      }
    } else if (s.slope < -s.slope_error && fabs(s.over) <= s.error) { /* next to the root */
      near = 2.5 * s.error / -s.slope + 2 * bits;
      t += near;
      open = !(near < wide && t < h);
    } else {
      open = 1;
    }
    if (open) {
      if (!qn_super_finer(c, &finer)) {
        return QN_SUPER_UNSURE;
      }
      c = &finer;
      t = l;
      slopes = 0;
    }
  }
  return QN_SUPER_UNSURE;
}

qn_super_answer qn_super_convex(const qn_super_line *c, double a, double b, double roots[2][2]) {
  double lo, hi;
  qn_super_answer answer = enter(c, a, b, &roots[0][0], &roots[0][1]);
  if (answer != QN_SUPER_FOUND) {
    return answer;
  }
  qn_super_line back = qn_super_reversed(c);
  if (enter(&back, -b, -roots[0][1], &lo, &hi) != QN_SUPER_FOUND || !(-hi >= roots[0][1])) {
    return QN_SUPER_UNSURE;
  }
  roots[1][0] = -hi, roots[1][1] = -lo;
  return QN_SUPER_FOUND;
}

static qn_super_answer narrow_from(const qn_super_line *c, double *a, double b) {
  double enough = 0.0625 * (b - *a);
  for (int looks = 0; looks < NARROW_LOOKS; looks++) {
    qn_super_look s = qn_super_look_at(c, *a);
    if (!(s.over > s.error && s.slope < -s.slope_error)) {
      return s.over > s.error && s.slope > s.slope_error ? QN_SUPER_NONE : QN_SUPER_FOUND;
    }
    double next = tangent(c, *a, &s), step = next - *a;
    *a = next;
    if (next > b) {
      return QN_SUPER_NONE;
    }
    if (step < enough) {
      break;
    }
  }
  return QN_SUPER_FOUND;
}

qn_super_answer qn_super_narrow(const qn_super_line *c, double *a, double *b) {
  double end = -*b;
  qn_super_line back = qn_super_reversed(c);
  if (narrow_from(c, a, *b) == QN_SUPER_NONE || narrow_from(&back, &end, -*a) == QN_SUPER_NONE) {
    return QN_SUPER_NONE;
  }
  *b = -end;
  return *a < *b ? QN_SUPER_FOUND : QN_SUPER_NONE;
}
