/* A line as doubles and as integers, and a surface's form along it.

   Legend: the point at t is (O + t D)/w with integers O, D, w > 0. A quadric's homogeneous form q is of degree 2, so
   w^2 q(line(t)) = q(O + t D, w) = a t^2 + 2 h t + c, with a = q2(D) (q2: the terms of degree 2 in x, y, z),
   2 h the polar form of q at (O, w) and (D, 0), c = q(O, w). 2 h may be odd, so all three are doubled: 2a, (2h), 2c.
   A plane's form is of degree 1: w n(line(t)) = c + 2 h t, doubled alike. */
#include "ray/scratch.h"

#include <math.h>
#include <string.h>

void qn_line_from_doubles(const double o[3], const double d[3], qn_line *out) {
  memset(out, 0, sizeof *out);
  memcpy(out->o, o, sizeof out->o);
  memcpy(out->d, d, sizeof out->d);
}

/* Finite double v = m 2^e with an integer m; e = 0 for 0. */
static int64_t split(double v, int *e) {
  if (v == 0) {
    *e = 0;
    return 0;
  }
  int64_t m = (int64_t)ldexp(frexp(v, e), 53);
  *e -= 53;
  while (m % 2 == 0) {
    m /= 2;
    ++*e;
  }
  return m;
}

void qn_exact_double(qn_ctx *ctx, double v, qn_int *num, qn_int *den) {
  int e;
  int64_t m = split(v, &e);
  *num = qn_int_shl(ctx, qn_int_from(ctx, m), (size_t)(e > 0 ? e : 0));
  *den = qn_int_shl(ctx, qn_int_from(ctx, 1), (size_t)(e < 0 ? -e : 0));
}

void qn_line_make_exact(qn_ctx *ctx, qn_line *line) {
  if (line->exact) {
    return;
  }
  int64_t m[6];
  int e[6], least = 0; /* w = 2^-least */
  for (int i = 0; i < 6; i++) {
    m[i] = split(i < 3 ? line->o[i] : line->d[i - 3], &e[i]);
    least = e[i] < least ? e[i] : least;
  }
  for (int i = 0; i < 6; i++) {
    qn_int v = qn_int_shl(ctx, qn_int_from(ctx, m[i]), (size_t)(m[i] ? e[i] - least : 0));
    *(i < 3 ? &line->origin[i] : &line->direction[i - 3]) = v;
  }
  line->w = qn_int_shl(ctx, qn_int_from(ctx, 1), (size_t)-least);
  line->exact = !ctx->failed;
}

void qn_line_from_numbers(qn_ctx *ctx, const qn_num o[3], const qn_num d[3], qn_line *out) {
  memset(out, 0, sizeof *out);
  qn_rat r[6];
  qn_int w = qn_int_from(ctx, 1);
  for (int i = 0; i < 6; i++) {
    r[i] = qn_num_rat(ctx, i < 3 ? o[i] : d[i - 3]);
    qn_int g = qn_int_gcd(ctx, w, r[i].den);
    if (qn_int_sign(g) > 0) { /* else memory was refused */
      w = qn_int_mul(ctx, w, qn_int_divexact(ctx, r[i].den, g));
    }
  }
  for (int i = 0; i < 6 && !ctx->failed; i++) {
    qn_int v = qn_int_mul(ctx, r[i].num, qn_int_divexact(ctx, w, r[i].den));
    double x = qn_num_to_double(i < 3 ? o[i] : d[i - 3]);
    *(i < 3 ? &out->origin[i] : &out->direction[i - 3]) = v;
    *(i < 3 ? &out->o[i] : &out->d[i - 3]) = x;
    if (!isfinite(x) || !qn_num_equal(qn_num_from_double(ctx, x), i < 3 ? o[i] : d[i - 3])) {
      out->rounded = 1;
    }
  }
  out->w = w;
  out->exact = !ctx->failed;
}

/* One coefficient of the surface. */
static qn_xint coefficient(const qn_exact_surface *s, int i) {
  return s->rounded && qn_int_sign(s->q[i]) != 0 ? qn_x_rounded(s->q[i]) : qn_x(s->q[i]);
}

static qn_xint plus(qn_ctx *ctx, qn_xint sum, qn_xint factor, qn_int by) {
  if (qn_int_sign(factor.v) == 0 || qn_int_sign(by) == 0) {
    return sum;
  }
  return qn_x_add(ctx, sum, qn_x_mul(ctx, factor, qn_x(by)));
}

void qn_line_quad(qn_ctx *ctx, const qn_line *line, const qn_exact_surface *surface, qn_quad *out) {
  const qn_int *o = line->origin, *d = line->direction;
  qn_xint zero = qn_x(qn_int_from(ctx, 0)), q[10];
  for (int i = 0; i < 10; i++) {
    q[i] = coefficient(surface, i);
  }
  qn_xint a = zero, h = zero, c = plus(ctx, zero, q[9], line->w); /* h is the full linear coefficient */
  for (int i = 0; i < 3; i++) {
    h = plus(ctx, h, q[6 + i], d[i]);
    c = plus(ctx, c, q[6 + i], o[i]);
  }
  if (!surface->plane) {
    h = qn_x_mul(ctx, h, qn_x(line->w));
    c = qn_x_mul(ctx, c, qn_x(line->w));
    static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
    for (int k = 0; k < 6; k++) {
      if (qn_int_sign(q[k].v) == 0) {
        continue;
      }
      int i = pair[k][0], j = pair[k][1];
      a = plus(ctx, a, q[k], qn_int_mul(ctx, d[i], d[j]));
      c = plus(ctx, c, q[k], qn_int_mul(ctx, o[i], o[j]));
      h = plus(ctx, h, q[k], qn_int_mul(ctx, o[i], d[j]));
      h = plus(ctx, h, q[k], qn_int_mul(ctx, o[j], d[i]));
    }
  }
  qn_quad_make(ctx, qn_x_shl(ctx, a, 1), h, qn_x_shl(ctx, c, 1), out);
}
