/* Roots of a superquadric along X(t) = O + t D: the search that answers where the others (super_line.h) cannot tell, and for
   exponents out of their range (design S10).

   The function is G(X(t)) - 1 (super.h), which has the sign of the inside-outside function less 1. A sign is taken in doubles
   with its bound, and in MPFR with QN_SUPER_BITS bits where the bound leaves it open.

   1. e, n <= 2: G is a norm, so convex along the line: none or two roots. The minimum is bracketed by the sign of the slope
      until a point inside is found, or the tangent's lower bound is positive, or the bracket is narrow.
   2. Else: the places where the line meets a coordinate plane divide it into pieces on each of which |X_i| is linear. A piece
      [c, d] is settled when G over the corners of its box (G grows with each |X_i|) is above 1 or below it, when its slope
      is of one sign, or when the lines from its ends with the steepest slopes do not reach 1; else it is halved, down to QN_SUPER_NARROW of the solid's size.
      A line may lie in the surface (in a flat cap, along a ruling): G is then 1 all along a piece but where it is more, and a piece with MOST_ZEROS places that no precision tells from 1
      is such a one; other pieces have a few roots at most. Slope: dG = phi_q(Z/rho) (phi_p(Y/X) d|X|
      + phi_p(X/Y) d|Y|) + phi_q(rho/Z) d|Z|, each phi monotone.
   What comes out is a list of places with certain signs in increasing order; two neighbours of different signs bracket a root.
   3. Refinement: Newton from one end, kept in the bracket, halving it when a step does not; then the bracket is closed from
      both sides to the nearest places with certain signs. */
#include "shape/interval.h"
#include "shape/outward.h"
#include "shape/prim.h"
#include "shape/super_line.h"
#include "shape/super_long.h"

#include <string.h>

enum { MOST_NODES = 40000, MOST_FINE = 8192, MOST_ZEROS = 64, STACK = 256, MOST_SIGNS = 256, KEPT = 64 };

/* What MPFR says of a place: the sign of G - 1, and what its size is at least. */
typedef struct known { double t, least; int sign; } known;

typedef struct curve {
  qn_super s;
  qn_super_frame frame;
  double off[3], size; /* off: what the frame's pairs leave of a coordinate; size: the longest stretch of such a line in the box */
  int convex, straight; /* straight: G is linear on every piece */
  const qn_super_exact *exact;
  const qn_super_long *whole; /* the same, where its numbers are long; or null */
  qn_super_mp mp[2]; /* of QN_SUPER_BITS/2 and QN_SUPER_BITS bits */
  int mp_ready[2];
  known kept[KEPT];   /* by t; t nan: empty */
  int fines, zeros;   /* places asked in MPFR; of them, on this piece, those with sign 0 */
} curve;

typedef struct sample { double value, slope, error, slope_error; } sample;

static double along(const curve *c, int i, double t) {
  return fma(c->frame.D[i][0], t, c->frame.O[i][0]) + (c->frame.D[i][1] * t + c->frame.O[i][1]);
}

/* What the coordinates add to the error of G, in which they are within 2u: its gradient is at most 1 where it is convex, else it is homogeneous. */
static double moved(const curve *c, const double X[3], double norm) {
  double all = 0, share = 0;
  for (int i = 0; i < 3; i++) {
    all += c->off[i];
    share = c->off[i] > 0 ? fmax(share, c->off[i] / fabs(X[i])) : share;
  }
  return c->convex ? 2 * all : share < QN_SUPER_CRUDE ? 2 * share * norm : INFINITY;
}

static sample look(const curve *c, double t) {
  double X[3] = {along(c, 0, t), along(c, 1, t), along(c, 2, t)}, g[3], D[3] = {c->frame.D[0][0], c->frame.D[1][0], c->frame.D[2][0]};
  sample r;
  double norm = qn_super_norm(&c->s, X, g, &r.error);
  r.value = norm - 1;
  r.error += moved(c, X, norm);
  r.slope = g[0] * D[0] + g[1] * D[1] + g[2] * D[2];
  double size = fabs(g[0] * D[0]) + fabs(g[1] * D[1]) + fabs(g[2] * D[2]);
  /* The slope at a point a few u away, which is as good where G is convex: p does not enter (see find_inside). */
  r.slope_error = (QN_SUPER_SLOPE(c->s.e, 0) + QN_SUPER_SLOPE(c->s.n, 0)) * size;
  for (int i = 0; i < 3; i++) {
    r.slope_error += c->frame.D_off[i];
  }
  return r;
}

static int sample_sign(sample s) { return s.value > s.error || s.value == INFINITY ? 1 : s.value < -s.error ? -1 : 0; }

/* Signs of G - 1 and of its slope in MPFR, at the exact point. *slope: NULL when it does not matter; where its addends cancel by more than half of the bits
   it is 0 at the first level. */
static int finely(curve *c, int level, double t, int *slope) {
  qn_super_mp *mp = &c->mp[level];
  qn_ctx *ctx = c->exact->ctx;
  if (!c->mp_ready[level]) {
    qn_super_mp_init(mp, level ? QN_SUPER_BITS : QN_SUPER_BITS / 2);
    qn_super_mp_set(ctx, mp->e, c->exact->e);
    qn_super_mp_set(ctx, mp->n, c->exact->n);
    qn_super_mp_exponents(mp);
    c->mp_ready[level] = 1;
  }
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_num at[2] = {qn_num_from_double(ctx, t), QN_NUM_ONE};
  for (int i = 0; i < 3; i++) {
    const qn_num line[2] = {c->exact->D[i], c->exact->O[i]};
    c->whole ? qn_super_long_at(ctx, c->whole, i, t, mp->x[i]) : qn_super_mp_set(ctx, mp->x[i], qn_num_dot(ctx, 2, line, at));
  }
  int sign = qn_super_mp_sign(mp);
  if (slope) {
    mpfr_set_zero(mp->t, 1);
    mpfr_set_zero(mp->bound, 1);
    for (int i = 0; i < 3; i++) {
      qn_super_mp_set(ctx, mp->w, c->exact->D[i]);
      mpfr_mul(mp->w, mp->g[i], mp->w, MPFR_RNDN);
      mpfr_add(mp->t, mp->t, mp->w, MPFR_RNDN);
      mpfr_abs(mp->w, mp->w, MPFR_RNDN);
      mpfr_max(mp->bound, mp->bound, mp->w, MPFR_RNDN);
    }
    mpfr_div_2ui(mp->bound, mp->bound, QN_SUPER_BITS / 4, MPFR_RNDN);
    *slope = mpfr_nan_p(mp->t) || (level == 0 && mpfr_cmpabs(mp->t, mp->bound) < 0) ? 0 : mpfr_sgn(mp->t);
  }
  qn_arena_release(&ctx->arena, mark);
  return ctx->failed ? 0 : sign;
}

static int fine_sign(curve *c, double t, int *slope) {
  int sign = finely(c, 0, t, slope);
  return sign && (!slope || *slope) ? sign : finely(c, 1, t, slope);
}

/* The place in MPFR; places that were asked of late are kept. */
static known fine_at(curve *c, double t) {
  uint64_t bits;
  memcpy(&bits, &t, sizeof bits);
  known *f = &c->kept[(bits * 0x9e3779b97f4a7c15u) >> 58];
  if (f->t != t) {
    f->t = t, f->least = 0, f->sign = finely(c, 0, t, NULL);
    const int level = f->sign == 0;
    f->sign = f->sign ? f->sign : finely(c, 1, t, NULL);
    if (f->sign) {
      qn_super_mp *mp = &c->mp[level];
      mpfr_abs(mp->c, mp->c, MPFR_RNDN);
      mpfr_sub(mp->c, mp->c, mp->bound, MPFR_RNDZ);
      f->least = fmax(0, mpfr_get_d(mp->c, MPFR_RNDZ));
    }
    c->fines++;
    c->zeros += f->sign == 0;
  }
  return *f;
}

static int sign_at(curve *c, double t) {
  int s = sample_sign(look(c, t));
  return s ? s : fine_at(c, t).sign;
}

static double middle(double a, double b) { return a + 0.5 * (b - a); }
static int between(double a, double t, double b) { return a < t && t < b; }

/* --- refinement --------------------------------------------------------------------------------------------------- */

/* Closes [lo, hi] round t from both sides: the nearest places with certain signs at growing distances from `near`. */
static void close_in(curve *c, double *lo, double *hi, int sign_lo, double t, double near) {
  /* NOLINTNEXTLINE(cert-flp30-c): a geometric walk, exact by powers of two */
  for (double d = near; t - d > *lo; d *= 4) {
    int s = sample_sign(look(c, t - d));
    if (s == sign_lo) {
      *lo = t - d;
      break;
    }
    if (s == -sign_lo) {
      *hi = t - d;
    }
  }
  /* NOLINTNEXTLINE(cert-flp30-c): as above */
  for (double d = near; t + d < *hi; d *= 4) {
    int s = sample_sign(look(c, t + d));
    if (s == -sign_lo) {
      *hi = t + d;
      break;
    }
    if (s == sign_lo) {
      *lo = t + d;
    }
  }
}

/* The bracket [lo, hi], signs sign_lo and -sign_lo at its ends, made narrow. */
static void refine(curve *c, double *lo, double *hi, int sign_lo) {
  double t = sign_lo > 0 ? *lo : *hi, width = *hi - *lo; /* from outside: where G is convex Newton does not overshoot */
  int slow = 0;
  sample s = look(c, t);
  for (;;) {
    double next = t - s.value / s.slope;
    if (!between(*lo, next, *hi) || slow > 2) {
      next = middle(*lo, *hi);
      slow = 0;
    }
    if (!between(*lo, next, *hi)) {
      return; /* neighbours */
    }
    double moved = fabs(next - t), near;
    t = next;
    s = look(c, t);
    int sign = sample_sign(s);
    if (sign) {
      *(sign == sign_lo ? lo : hi) = t;
    }
    near = fmax(QN_STEP * fabs(t) + QN_U * QN_U * c->size + DBL_TRUE_MIN, 2 * s.error / fabs(s.slope));
    if (sign == 0 || moved <= near) {
      if (!(near < *hi - *lo)) { /* no slope to judge by */
        near = QN_STEP * fabs(t) + QN_SUPER_FINE * c->size + DBL_TRUE_MIN;
      }
      close_in(c, lo, hi, sign_lo, t, near);
      break;
    }
    if (*hi - *lo > 0.5 * width) {
      slow++;
    } else {
      width = *hi - *lo;
      slow = 0;
    }
  }
  while (*hi - *lo > fmax(QN_SUPER_FINE * c->size, 2 * QN_STEP * fabs(*hi))) { /* too flat for doubles */
    double m = middle(*lo, *hi);
    if (!between(*lo, m, *hi)) {
      break;
    }
    int sign = sign_at(c, m);
    if (sign == 0) { /* the root itself, for all that can be told */
      double l = nextafter(m, -INFINITY), h = nextafter(m, INFINITY);
      if (l > *lo && sign_at(c, l) == sign_lo) {
        *lo = l;
      }
      if (h < *hi && sign_at(c, h) == -sign_lo) {
        *hi = h;
      }
      break;
    }
    *(sign == sign_lo ? lo : hi) = m;
  }
}

/* --- convex ------------------------------------------------------------------------------------------------------- */

/* A place inside, when there is one that is not hidden in a narrow bracket, and places outside to its left and right.

   At a point with G > 1 + error a computed slope is the slope at a point a few u away, so the tangent bounds G from below within
   less than the error:
   G > 1 on the side to which it rises, and on the other side too when it does not sink to 1 before the bracket's end. Where the
   value is
   open, value and slope are MPFR's. */
static int find_inside(curve *c, double a, double b, double *inside, double *left, double *right) {
  double least = QN_SUPER_NARROW * c->size;
  *left = a;
  *right = b;
  for (;;) {
    double m = middle(a, b);
    if (!between(a, m, b)) {
      return 0;
    }
    sample s = look(c, m);
    int sign = sample_sign(s), slope = s.slope > s.slope_error ? 1 : s.slope < -s.slope_error ? -1 : 0;
    if (sign == 0 || (sign > 0 && slope == 0)) {
      int fine_slope;
      int fine = fine_sign(c, m, &fine_slope);
      slope = sign ? slope ? slope : fine_slope : fine_slope;
      sign = sign ? sign : fine;
    } else if (sign > 0 && s.value - 2 * s.error > (fabs(s.slope) + s.slope_error) * fmax(b - m, m - a)) {
      return 0;
    }
    if (sign < 0) {
      *inside = m;
      return 1;
    }
    if (slope == 0) {
      return 0; /* the minimum itself, not inside */
    }
    if (slope > 0) {
      b = m;
      *right = sign > 0 ? m : *right;
    } else {
      a = m;
      *left = sign > 0 ? m : *left;
    }
    if (b - a <= least) { /* a root pair as wide as this would have held an end */
      return 0;
    }
  }
}

/* --- not convex --------------------------------------------------------------------------------------------------- */

/* Places with certain signs, in increasing order, those between two of one sign left out. */
typedef struct places {
  double t[MOST_SIGNS];
  int sign[MOST_SIGNS];
  size_t count;
} places;

static void place(places *p, double t, int sign) {
  if (!sign) {
    return;
  }
  size_t n = p->count;
  if (n >= 2 && p->sign[n - 1] == sign && p->sign[n - 2] == sign) {
    p->t[n - 1] = t;
  } else if (n < MOST_SIGNS) {
    p->t[n] = t;
    p->sign[n] = sign;
    p->count = n + 1;
  }
}

/* phi at a ratio, moved by its error upward (way 1) or downward (-1). */
static double slope_bound(double e, double p, double ratio, int way) {
  double phi = ratio < INFINITY ? qn_super_slope(e, p, ratio) : p > 1 ? 0 : INFINITY;
  double error = ratio > 0 && ratio < INFINITY ? QN_SUPER_SLOPE(e, p) * (1 + fabs(log(ratio))) : 0;
  if (way > 0) {
    return phi + phi * error + DBL_MIN; /* it may have underflown */
  }
  return phi < INFINITY ? fmax(0, phi - phi * error - DBL_MIN) : DBL_MAX;
}

/* b/a of numbers >= 0. */
static qn_interval quotient(qn_interval b, qn_interval a) {
  return (qn_interval){a.hi > 0 ? b.lo / a.hi : b.lo > 0 ? INFINITY : 0, a.lo > 0 ? b.hi / a.lo : INFINITY};
}
static qn_interval hull(qn_interval a, qn_interval b) { return (qn_interval){fmin(a.lo, b.lo), fmax(a.hi, b.hi)}; }
static qn_interval inverse(qn_interval a) { return (qn_interval){a.hi < INFINITY ? 1 / a.hi : 0, a.lo > 0 ? 1 / a.lo : INFINITY}; }

/* phi over ratios b/a with a, b in intervals of numbers >= 0. sure: the exponent is exactly e. */
static qn_interval slope_range(double e, double p, int sure, qn_interval a, qn_interval b, qn_interval ratio) {
  if (p == 1) {
    double off = sure ? 0 : QN_SUPER_SLOPE(e, p) * (1 - log(DBL_TRUE_MIN));
    return (qn_interval){1 - off, 1 + off};
  }
  qn_interval open = p > 1 ? (qn_interval){0, 1} : (qn_interval){1, INFINITY};
  if (e == 0 && (b.hi < a.lo || b.lo > a.hi)) {
    double phi = b.hi < a.lo ? 1 : 0; /* of the greater one */
    return (qn_interval){phi, phi};
  }
  if (!(QN_SUPER_SLOPE(e, p) < QN_SUPER_SLOPE_MOST)) {
    return open;
  }
  double f = slope_bound(e, p, ratio.lo, p > 1 ? 1 : -1), g = slope_bound(e, p, ratio.hi, p > 1 ? -1 : 1);
  qn_interval r = p > 1 ? (qn_interval){g, f} : (qn_interval){f, g};
  return r.lo == r.lo && r.hi == r.hi ? r : open;
}

/* Times the speed of a coordinate, of which d is the first double: way 1 or -1. */
static qn_interval scaled(qn_interval a, const curve *c, int i, int way) {
  double d = way * c->frame.D[i][0], off = c->frame.D_off[i] + 2 * fabs(c->frame.D[i][1]);
  return d == 0 && off == 0 ? (qn_interval){0, 0} : qn_interval_mul(a, (qn_interval){d - off, d + off});
}

typedef enum verdict { SPLIT, ABOVE, BELOW, MONOTONE } verdict;

/* An end of a piece on which G changes by no more than `most`; a sign that doubles leave open is looked for only where the piece may be told by it. */
static known end_at(curve *c, double t, double most) {
  const sample s = look(c, t);
  const int sign = sample_sign(s);
  return sign || !(most < 16 * s.error) ? (known){t, fabs(s.value) - s.error, sign} : fine_at(c, t);
}

/* Two lines from the ends, with the steepest slopes, bound G from either side. */
static verdict by_ends(curve *c, double a, double b, qn_interval slope) {
  if (!(slope.hi - slope.lo < INFINITY)) {
    return SPLIT;
  }
  const double change = fmax(slope.hi, -slope.lo) * (b - a);
  const known from = end_at(c, a, change), to = end_at(c, b, change);
  const int sign = from.sign;
  if (!sign || sign != to.sign || !isfinite(from.least) || !isfinite(to.least)) {
    return SPLIT;
  }
  if (change * (1 + 16 * QN_U) < from.least) {
    return sign > 0 ? ABOVE : BELOW;
  }
  const double near = from.least, far = to.least, lo = sign > 0 ? slope.lo : -slope.hi, hi = sign > 0 ? slope.hi : -slope.lo;
  double most = near * hi - far * lo, bend = lo * hi * (b - a); /* where the lines meet: sign G is at least (most + bend)/(hi - lo); bend < 0 */
  return most + bend > 16 * QN_U * (most - bend) ? (sign > 0 ? ABOVE : BELOW) : SPLIT;
}

/* A coordinate as computed, without its sign. */
static qn_interval around(const curve *c, int i, double at) { return (qn_interval){fmax(0, at * (1 - 4 * QN_U) - c->off[i]), at * (1 + 4 * QN_U) + c->off[i]}; }

static verdict judge(curve *c, double a, double b) {
  qn_interval x[3], from[3], to[3];
  double lo[3], hi[3], g[3], error;
  int crossing = 0, way[3]; /* way: d|X_i|/dt is way D_i on a piece of one sign */
  for (int i = 0; i < 3; i++) {
    double l = along(c, i, a), h = along(c, i, b), d = c->frame.D[i][0];
    int cross = d != 0 && ((l < c->off[i] && h > -c->off[i]) || (l > -c->off[i] && h < c->off[i]));
    crossing |= cross;
    way[i] = l < 0 || h < 0 ? -1 : 1;
    from[i] = around(c, i, fabs(l)), to[i] = around(c, i, fabs(h));
    x[i] = hull(from[i], to[i]);
    x[i].lo = cross ? 0 : x[i].lo;
    lo[i] = x[i].lo, hi[i] = x[i].hi;
  }
  double least = qn_super_norm(&c->s, lo, g, &error);
  if (least - error > 1 || least == INFINITY) {
    return ABOVE;
  }
  double most = qn_super_norm(&c->s, hi, g, &error);
  if (most + error < 1) {
    return BELOW;
  }
  if (crossing) {
    return SPLIT;
  }
  double rho_error, flat_lo[3] = {lo[0], lo[1], 0}, flat_hi[3] = {hi[0], hi[1], 0};
  qn_interval rho;
  rho.lo = qn_super_norm(&c->s, flat_lo, g, &rho_error);
  rho.lo = fmax(0, rho.lo - rho_error);
  rho.hi = qn_super_norm(&c->s, flat_hi, g, &rho_error);
  rho.hi += rho_error;
  double e = c->s.e, p = c->s.p, n = c->s.n, q = c->s.q;
  int sure_e = c->frame.e[1] == 0, sure_n = c->frame.n[1] == 0;
  const qn_interval y_to_x = hull(quotient(from[1], from[0]), quotient(to[1], to[0])), z_to_rho = quotient(x[2], rho); /* the first is monotone along the piece; else it were wide beside a ruling */
  qn_interval dx = scaled(slope_range(e, p, sure_e, x[0], x[1], y_to_x), c, 0, way[0]), dy = scaled(slope_range(e, p, sure_e, x[1], x[0], inverse(y_to_x)), c, 1, way[1]);
  qn_interval flat = qn_interval_mul(slope_range(n, q, sure_n, rho, x[2], z_to_rho), qn_interval_add(dx, dy));
  qn_interval slope = qn_interval_add(flat, scaled(slope_range(n, q, sure_n, x[2], rho, quotient(rho, x[2])), c, 2, way[2]));
  return slope.lo > 0 || slope.hi < 0 ? MONOTONE : by_ends(c, a, b, slope);
}

/* Where e is 2 and neither |X| + |Y| nor Z changes on a piece, nor does G. */
static int is_still(const curve *c, double a, double b) {
  const qn_super_exact *line = c->exact;
  const double m = middle(a, b);
  const int together = (along(c, 0, m) < 0) == (along(c, 1, m) < 0); /* of one sign */
  return c->s.e == 2 && c->frame.e[1] == 0 && qn_num_is_zero(line->D[2]) &&
         qn_num_cmp(line->ctx, line->D[0], together ? qn_num_neg(line->ctx, line->D[1]) : line->D[1]) == 0;
}

/* A piece that would take more than it may fails: nothing is said of what was not looked at. */
static void settle(curve *c, double a, double b, places *p) {
  struct { double a, b; } stack[STACK];
  size_t depth = 0;
  double least = QN_SUPER_NARROW * c->size;
  stack[depth].a = a, stack[depth].b = b;
  depth++;
  c->zeros = 0;
  const int ends_do = c->straight || is_still(c, a, b);
  for (int nodes = 0; depth && c->zeros < MOST_ZEROS; nodes++) {
    depth--;
    a = stack[depth].a, b = stack[depth].b;
    double m = middle(a, b);
    verdict v = ends_do ? MONOTONE : judge(c, a, b);
    if (v == SPLIT && b - a > least && between(a, m, b)) {
      if (nodes >= MOST_NODES || c->fines > MOST_FINE || depth + 2 > STACK) {
        c->exact->ctx->failed = c->exact->ctx->failed ? c->exact->ctx->failed : QUOIN_E_LIMIT;
        return;
      }
      stack[depth].a = m, stack[depth].b = b;
      stack[depth + 1].a = a, stack[depth + 1].b = m;
      depth += 2;
      continue;
    }
    int sa = v == ABOVE ? 1 : v == BELOW ? -1 : sign_at(c, a), sb = v == ABOVE ? 1 : v == BELOW ? -1 : sign_at(c, b);
    place(p, a, sa);
    place(p, b, sb);
  }
}

/* The place where the line crosses a coordinate plane, between two others near it; 0: it does not, or too slowly. */
static int crossed_at(const curve *c, int i, double *l, double *h) {
  qn_ctx *ctx = c->exact->ctx;
  if (qn_num_is_zero(c->exact->D[i])) {
    return 0;
  }
  qn_mark mark = qn_arena_mark(&ctx->arena);
  double t = -qn_num_to_double(qn_num_div(ctx, c->exact->O[i], c->exact->D[i]));
  qn_arena_release(&ctx->arena, mark);
  double gap = QN_SUPER_NARROW * 0x1p-4 * c->size;
  *l = qn_step_down(t - gap), *h = qn_step_up(t + gap);
  return isfinite(t);
}

static void general(curve *c, double a, double b, places *p) {
  double cut[8];
  size_t n = 0;
  cut[n++] = a;
  for (int i = 0; i < 3; i++) { /* either side of each coordinate plane, where the sign is certain */
    double l, h;
    if (crossed_at(c, i, &l, &h)) {
      if (between(a, l, b)) {
        cut[n++] = l;
      }
      if (between(a, h, b)) {
        cut[n++] = h;
      }
    }
  }
  cut[n++] = b;
  for (size_t i = 1; i < n; i++) {
    for (size_t k = i; k > 0 && cut[k] < cut[k - 1]; k--) {
      double t = cut[k];
      cut[k] = cut[k - 1];
      cut[k - 1] = t;
    }
  }
  place(p, a, 1);
  for (size_t i = 0; i + 1 < n; i++) {
    if (cut[i] < cut[i + 1]) {
      settle(c, cut[i], cut[i + 1], p);
    }
  }
  place(p, b, 1);
}

/* ------------------------------------------------------------------------------------------------------------------ */

/* A line that runs beside an axis at 1 or beyond it is in the solid nowhere, since no |X_i| is above G. Where n is 0 a Z that stands still below 1 counts for nothing: it is made 0. */
static int passes_by(qn_super_exact *line) {
  const qn_num one = qn_num_from_int(line->ctx, 1);
  for (int i = 0; i < 3; i++) {
    if (qn_num_is_zero(line->D[i]) && qn_num_cmp(line->ctx, qn_num_abs(line->ctx, line->O[i]), one) >= 0) {
      return 1;
    }
  }
  if (qn_num_is_zero(line->n) && qn_num_is_zero(line->D[2])) {
    line->O[2] = QN_NUM_ZERO;
  }
  return 0;
}

/* Where n is 2 and the line meets the axis of Z, rho and so G are linear on every piece: it may run along a ruling, or as near to one as numbers come. */
static int is_straight(const qn_super_exact *line) {
  qn_ctx *ctx = line->ctx;
  return qn_num_cmp(ctx, line->n, qn_num_from_int(ctx, 2)) == 0 && qn_num_cmp(ctx, qn_num_mul(ctx, line->O[0], line->D[1]), qn_num_mul(ctx, line->O[1], line->D[0])) == 0;
}

/* A line along Z: G falls to where Z = 0 and rises again. It is rho there. */
static void upright(curve *c, double a, double b, places *p) {
  qn_ctx *ctx = c->exact->ctx;
  qn_super_exact flat = *c->exact;
  flat.O[2] = flat.D[2] = QN_NUM_ZERO;
  const double m = -qn_num_to_double(qn_num_div(ctx, c->exact->O[2], c->exact->D[2]));
  const qn_super_exact *line = c->exact;
  const qn_super_long *whole = c->whole;
  c->exact = &flat, c->whole = NULL;
  const int least = fine_sign(c, 0, NULL);
  c->exact = line, c->whole = whole;
  if (least < 0 && between(a, m, b) && sign_at(c, m) < 0) {
    place(p, a, 1);
    place(p, m, -1);
    place(p, b, 1);
  }
}

size_t qn_super_careful(const qn_super_exact *line, double (*roots)[2], size_t max) {
  qn_super_exact own = *line;
  curve c = {.exact = &own};
  const qn_num two = qn_num_from_int(line->ctx, 2);
  double a, b, most = 0;
  if (passes_by(&own)) {
    return 0;
  }
  line = &own;
  qn_super_long whole;
  c.whole = qn_super_long_make(line, &whole) ? &whole : NULL;
  for (int i = 0; i < KEPT; i++) {
    c.kept[i].t = NAN;
  }
  qn_super_frame_from_exact(line, &c.frame);
  c.s = qn_super_make(c.frame.e[0], c.frame.n[0]);
  c.straight = is_straight(line);
  c.convex = qn_num_cmp(line->ctx, line->e, two) <= 0 && qn_num_cmp(line->ctx, line->n, two) <= 0;
  if (line->ctx->failed || !qn_super_clip(&c.frame, &a, &b) || !isfinite(a) || !isfinite(b)) {
    return 0;
  }
  for (int i = 0; i < 3; i++) {
    const double *O = c.frame.O[i], *D = c.frame.D[i];
    c.off[i] = qn_super_off(&c.frame, i, fmax(fabs(a), fabs(b)));
    if ((fabs(O[0]) < 0x1p-900 && O[0] != 0) || (fabs(D[0]) < 0x1p-900 && D[0] != 0)) {
      c.off[i] += 0x1p-1060; /* a product may underflow */
    }
    most = fmax(most, fabs(D[0]));
  }
  c.size = fmin(2 / most, DBL_MAX);
  places p = {.count = 0};
  if (c.convex) {
    double inside, left, right;
    if (find_inside(&c, a, b, &inside, &left, &right)) {
      place(&p, left, 1);
      place(&p, inside, -1);
      place(&p, right, 1);
    }
  } else if (qn_num_is_zero(line->D[0]) && qn_num_is_zero(line->D[1])) {
    upright(&c, a, b, &p);
  } else {
    general(&c, a, b, &p);
  }
  size_t count = 0;
  for (size_t i = 0; i + 1 < p.count && count < max && !line->ctx->failed; i++) {
    if (p.sign[i] != p.sign[i + 1]) {
      roots[count][0] = p.t[i];
      roots[count][1] = p.t[i + 1];
      refine(&c, &roots[count][0], &roots[count][1], p.sign[i]);
      count++;
    }
  }
  for (int level = 0; level < 2; level++) {
    if (c.mp_ready[level]) {
      qn_super_mp_free(&c.mp[level]);
    }
  }
  return count;
}
