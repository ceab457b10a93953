/* Roots of a superquadric with an exponent beyond 2 along a line, piece by piece between the coordinate planes.

   On a piece no coordinate changes its sign.
   Both exponents >= 2: p, q <= 1, so G is concave on a piece, and f = G^q too. Two ends outside: all of it is outside. Ends of
   two signs: one root. Two ends inside: at a place inside the tangent rules out the side to which f falls, so the search goes
   to the other side, until a place outside is found or the tangent stays below 1.
   One exponent below 2: f' = q [rho^(q-1) rho' + z^(q-1) z'], where z' is constant and rho convex on a piece (e <= 2) or
   concave (e >= 2), so that the ends of a piece bound rho, rho' and each factor. A piece is settled when f' is of one sign, or
   when the lines from its ends with the steepest slopes do not reach 1; else it is halved.

   A root alone in its bracket is refined by Newton's method kept in the bracket; at last places on either side of it are looked
   at. */
#include "shape/interval.h"
#include "shape/super_line.h"

#include <stdint.h>

enum { MOST_LOOKS = 60, MOST_NODES = 200, STACK = 64 };

static int sign_of(const qn_super_look *s) { return s->over > s->error ? 1 : s->over < -s->error ? -1 : 0; }
static int sign_at(const qn_super_line *c, double t) {
  qn_super_look s = qn_super_look_at(c, t);
  return sign_of(&s);
}
static double middle(double a, double b) { return a + 0.5 * (b - a); }
static int between(double a, double t, double b) { return a < t && t < b; }

/* The bracket [lo, hi] of one root, signs sign_lo and -sign_lo at its ends, made narrow. 0: cannot tell. */
static int refine(const qn_super_line *c, double *lo, double *hi, int sign_lo) {
  qn_super_line finer;
  double t = middle(*lo, *hi), last = 0, last_slope = 0, width = *hi - *lo, ends = fmax(fabs(*lo), fabs(*hi));
  const double first = *lo, end = *hi; /* up to and from where the signs are known, the root being alone */
  double wide = fmax(QN_SUPER_FINE * c->size, 8 * QN_STEP * ends);
  int slopes = 0, slow = 0;
  for (int looks = 0; looks < MOST_LOOKS; looks++) {
    qn_super_look s = qn_super_look_at(c, t);
    int sign = sign_of(&s);
    if (sign) {
      *(sign == sign_lo ? lo : hi) = t;
    }
    double step = -s.over / s.slope, next = t + step, near = 1.5 * s.error / fabs(s.slope) + QN_STEP * fabs(t);
    double left = next - near, right = next + near; /* at last the enclosure, its middle the best guess */
    /* what the step leaves */
    double bend = slopes ? 0.5 * step * step * fabs((s.slope - last_slope) / (s.slope * (t - last))) : INFINITY;
    if ((sign == 0 || bend < 0.25 * near) && right - left <= wide && first < left && right < end) {
      int at_left = left <= *lo ? sign_lo : sign_at(c, left), at_right = right >= *hi ? -sign_lo : sign_at(c, right);
      if (at_left == sign_lo && at_right == -sign_lo) {
        *lo = left, *hi = right;
        return 1;
      }
      if (at_left && between(*lo, left, *hi)) {
        *(at_left == sign_lo ? lo : hi) = left;
      }
      if (at_right && between(*lo, right, *hi)) {
        *(at_right == sign_lo ? lo : hi) = right;
      }
    }
    if (*hi - *lo <= fmin(4 * near, wide)) {
      return 1;
    }
    if (sign == 0) {
      if (!qn_super_finer(c, &finer)) {
        return 0;
      }
      c = &finer;
      slopes = slow = 0;
      continue;
    }
    slow = *hi - *lo > 0.5 * width ? slow + 1 : 0;
    width = slow ? width : *hi - *lo;
    last = t, last_slope = s.slope, slopes = 1;
    if (!between(*lo, next, *hi) || slow > 3) {
      next = middle(*lo, *hi);
      slopes = slow = 0;
      width = *hi - *lo;
      if (!between(*lo, next, *hi)) {
        return 1; /* neighbours */
      }
    }
    t = next;
  }
  return 0;
}

typedef struct finder {
  const qn_super_line *c;
  double (*roots)[2];
  size_t count, max;
} finder;

static int add(finder *f, double lo, double hi, int sign_lo) {
  if (!refine(f->c, &lo, &hi, sign_lo)) {
    return 0;
  }
  if (f->count < f->max) {
    f->roots[f->count][0] = lo, f->roots[f->count][1] = hi;
    f->count++;
  }
  return 1;
}

/* --- both exponents 2 or more ------------------------------------------------------------------------------------- */

/* Two ends inside: is there a place outside between them? */
static qn_super_answer find_outside(const qn_super_line *c, double a, double b, double *outside) {
  for (int looks = 0; looks < MOST_LOOKS; looks++) {
    double m = middle(a, b);
    qn_super_look s = qn_super_look_at(c, m);
    if (s.over > s.error) {
      *outside = m;
      return QN_SUPER_FOUND;
    }
    double reach = s.slope > 0 ? b - m : m - a;
    if (s.over + 2 * s.error + (fabs(s.slope) + s.slope_error) * reach < 0) {
      return QN_SUPER_NONE;
    }
    if (!(s.over < -s.error) || !(fabs(s.slope) > s.slope_error) || !between(a, m, b)) {
      return QN_SUPER_UNSURE;
    }
    *(s.slope > 0 ? &a : &b) = m;
  }
  return QN_SUPER_UNSURE;
}

static int concave(finder *f, double a, double b, int sa, int sb) {
  if (sa != sb) {
    return add(f, a, b, sa);
  }
  double m;
  if (sa > 0) {
    return 1;
  }
  switch (find_outside(f->c, a, b, &m)) {
  case QN_SUPER_NONE: return 1;
  case QN_SUPER_FOUND: return add(f, a, m, -1) && add(f, m, b, 1);
  case QN_SUPER_UNSURE: break;
  }
  return 0;
}

/* --- one exponent beyond 2, the other not ------------------------------------------------------------------------- */

typedef struct end {
  double t, z, rho, way; /* way: drho/dt */
  double way_error;
  int sign;
  qn_super_look s;
} end;

static end end_at(const qn_super_line *c, double t) {
  end r = {.t = t, .z = fabs(qn_super_along(c, 2, t)), .s = qn_super_look_at(c, t)};
  r.sign = sign_of(&r.s);
  r.rho = pow(r.s.inner, 0.5 * c->n);
  if (r.s.inner > QN_SUPER_RATIO) {
    double k = r.rho / (c->q * r.s.inner);
    r.way = r.s.rise * k, r.way_error = 2 * r.s.rise_error * k;
  } else { /* on the z axis, or lost to underflow */
    r.way = 0, r.way_error = c->D[0] == 0 && c->D[1] == 0 ? 0 : INFINITY;
  }
  return r;
}

/* Widened by the slopes' errors: rate of themselves. */
static qn_interval loose(double lo, double hi, double rate) {
  return (qn_interval){lo - rate * fabs(lo) - QN_SUPER_FADED, hi + rate * fabs(hi) + QN_SUPER_FADED};
}

/* Bounds of df/dt on the piece between two ends. */
static qn_interval slopes(const qn_super_line *c, const end *a, const end *b) {
  double width = b->t - a->t, least = a->rho < b->rho ? a->rho : b->rho, most = a->rho < b->rho ? b->rho : a->rho;
  double sure = QN_SUPER_RATE + (a->s.crude > b->s.crude ? a->s.crude : b->s.crude);
  qn_interval way;
  if (c->e <= 2) { /* rho is convex: its slope rises, and it is above its tangents */
    way = (qn_interval){a->way - a->way_error, b->way + b->way_error};
    if (way.lo < 0 && way.hi > 0) {
      double left = a->rho + way.lo * width, right = b->rho - way.hi * width;
      least = (left > right ? left : right) - sure * (most + width * (way.hi - way.lo));
      least = least > 0 ? least : 0;
    }
  } else {
    way = (qn_interval){b->way - b->way_error, a->way + a->way_error};
    if (way.lo < 0 && way.hi > 0) {
      double left = a->rho + way.hi * width, right = b->rho - way.lo * width;
      most = (left < right ? left : right) * (1 + sure);
    }
  }
  double f = pow(least, c->q - 1), g = pow(most, c->q - 1); /* 0^(q - 1) is infinite for q < 1 */
  qn_interval factor = c->q < 1 ? loose(g, f, sure) : loose(f, g, sure), inner = qn_interval_mul(factor, way);
  if (c->D[2] == 0) {
    return qn_interval_mul(inner, (qn_interval){c->q, c->q});
  }
  double za = a->s.outer / a->z, zb = b->s.outer / b->z, rate = a->z < b->z ? fabs(c->D[2]) : -fabs(c->D[2]);
  qn_interval outer = qn_interval_mul(za < zb ? loose(za, zb, sure) : loose(zb, za, sure), (qn_interval){rate, rate});
  return qn_interval_mul(qn_interval_add(inner, outer), (qn_interval){c->q, c->q});
}

/* Is f monotone on the piece, or of the sign of its ends throughout? Two lines from the ends bound f from either side. */
static int settled(const end *a, const end *b, qn_interval slope) {
  if (slope.lo >= 0 || slope.hi <= 0) {
    return 1;
  }
  if (a->sign != b->sign || !(slope.hi - slope.lo < INFINITY)) {
    return 0;
  }
  double width = b->t - a->t, room = 2 * (a->s.error + b->s.error) + QN_SUPER_RATE * width * (slope.hi - slope.lo);
  if (a->sign > 0) {
    return a->s.over * slope.hi - b->s.over * slope.lo + slope.lo * slope.hi * width > room * (slope.hi - slope.lo);
  }
  return b->s.over * slope.hi - a->s.over * slope.lo - slope.lo * slope.hi * width < -room * (slope.hi - slope.lo);
}

static int mixed(finder *f, double from, double to) {
  const qn_super_line *c = f->c;
  end stack[STACK], a = end_at(c, from);
  size_t depth = 0;
  stack[depth++] = end_at(c, to);
  if (!a.sign || !stack[0].sign) {
    return 0;
  }
  for (int nodes = 0; depth > 0; nodes++) {
    end b = stack[depth - 1];
    if (settled(&a, &b, slopes(c, &a, &b))) {
      if (a.sign != b.sign && !add(f, a.t, b.t, a.sign)) {
        return 0;
      }
      a = b;
      depth--;
      continue;
    }
    double m = middle(a.t, b.t);
    if (b.t - a.t < QN_SUPER_NARROW * c->size || !between(a.t, m, b.t) || nodes >= MOST_NODES || depth >= STACK) {
      return 0;
    }
    stack[depth] = end_at(c, m);
    if (!stack[depth].sign) {
      return 0;
    }
    depth++;
  }
  return 1;
}

/* ------------------------------------------------------------------------------------------------------------------ */

/* Places on either side of each coordinate plane that the line crosses in (a, b), where the coordinates' signs are certain. They are apart by little
   enough that a pair of roots between them is none that S10 promises. In increasing order; 0 when two planes are too close. */
static int cuts(const qn_super_line *c, double a, double b, double cut[3][2], size_t *count) {
  size_t n = 0;
  for (int i = 0; i < 3; i++) {
    double d = c->D[i], o = c->O[i];
    if (d == 0) {
      continue;
    }
    double t = -o / d, gap = QN_SUPER_GAP * c->size + 2 * QN_STEP * fabs(t), l = t - gap, h = t + gap;
    if (h <= a || l >= b) {
      continue;
    }
    if (copysign(1, d) * qn_super_along(c, i, l) >= -c->off[i] || copysign(1, d) * qn_super_along(c, i, h) <= c->off[i]) {
      return 0;
    }
    if (!between(a, l, b) || !between(a, h, b)) {
      return 0;
    }
    size_t k = n++;
    for (; k > 0 && cut[k - 1][0] > l; k--) {
      cut[k][0] = cut[k - 1][0], cut[k][1] = cut[k - 1][1];
    }
    cut[k][0] = l, cut[k][1] = h;
  }
  for (size_t k = 1; k < n; k++) {
    if (!(cut[k - 1][1] < cut[k][0])) {
      return 0;
    }
  }
  *count = n;
  return 1;
}

qn_super_answer qn_super_pieces(const qn_super_line *c, double a, double b, double (*roots)[2], size_t max, size_t *count) {
  double cut[3][2];
  size_t n;
  if (!cuts(c, a, b, cut, &n)) {
    return QN_SUPER_UNSURE;
  }
  finder f = {c, roots, 0, max};
  int is_concave = c->e >= 2 && c->n >= 2, before = 1;
  for (size_t i = 0; i <= n; i++) {
    double from = i ? cut[i - 1][1] : a, to = i < n ? cut[i][0] : b;
    int after = i < n ? sign_at(c, to) : 1;
    if (!after || !(is_concave ? concave(&f, from, to, before, after) : mixed(&f, from, to))) {
      return QN_SUPER_UNSURE;
    }
    if (i < n) { /* across the plane, a few last bits */
      before = sign_at(c, cut[i][1]);
      if (!before) {
        return QN_SUPER_UNSURE;
      }
      if (before != after && f.count < max) {
        roots[f.count][0] = cut[i][0], roots[f.count][1] = cut[i][1];
        f.count++;
      }
    }
  }
  *count = f.count;
  return QN_SUPER_FOUND;
}
