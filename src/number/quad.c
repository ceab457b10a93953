/* The order of roots by signs of polynomials in the coefficients.

   Legend: two quadratics with a1, a2 > 0 (a common sign change keeps the roots), d = h^2 - a c > 0, roots
   (-h +- sqrt d)/a; J, G, J', K, N, Res as in quad.h. Roots are named + and - by the sign before sqrt d.

   Derivation. a1 a2 (x - y) for x, y roots with signs s, t is  J + s a2 sqrt d1 - t a1 sqrt d2.
   + against -: J >= 0 gives x > y. Else square J against a2 sqrt d1 + a1 sqrt d2 (both positive):
       (a2 sqrt d1 + a1 sqrt d2)^2 - J^2 = a1 a2 (2 sqrt(d1 d2) - K),
     so K <= 0 gives x > y, and else 4 d1 d2 - K^2 = -Res has the sign.
   + against +: with J >= 0, J + a2 sqrt d1 and a1 sqrt d2 are both >= 0, and
       (J + a2 sqrt d1)^2 - a1^2 d2 = a2 (2 J sqrt d1 - N).
     N < 0, or N = 0 and J > 0, gives x > y; J = 0 leaves the sign of -N; else 4 J^2 d1 - N^2 = -a1^2 Res has it.
     J < 0: the operands change places (J changes its sign).
   - against -: reflect t -> -t, which turns h to -h and - to +, and turn the answer round.
   A root and a rational n/m, m > 0: a m (x - n/m) = B + s m sqrt d with B = -(h m + a n), and
       m^2 d - B^2 = -a (a n^2 + 2 h n m + c m^2) = -a P.
     s = +: B >= 0 gives x > n/m, else -P has the sign. s = -: B <= 0 gives x < n/m, else P has it.
   Quadratics with a rounding of S2 in them are ordered by quad_s2.c instead.
   Source of the scheme: Devillers, Fronville, Mourrain, Teillaud (2002), see docs/references.md. */
#include "number/quad_parts.h"

/* A number that S2 calls zero becomes an exact zero, so that every later step sees one and the same quadratic. */
static qn_xint settle(qn_xint x, int *sign) {
  *sign = qn_x_sign(x);
  return *sign ? x : qn_x((qn_int){0, NULL});
}

void qn_quad_make(qn_ctx *ctx, qn_xint a, qn_xint h, qn_xint c, qn_quad *out) {
  out->a = settle(a, &out->sign_a);
  out->h = settle(h, &out->sign_h);
  out->c = settle(c, &out->sign_c);
  qn_xint disc = qn_x_mul(ctx, out->h, out->h);
  if (out->sign_a && out->sign_c) {
    disc = qn_x_sub(ctx, disc, qn_x_mul(ctx, out->a, out->c));
  }
  out->disc = settle(disc, &out->sign_disc);
}

qn_quad_shape qn_quad_kind(const qn_quad *q) {
  if (q->sign_a == 0) {
    return q->sign_h ? QN_QUAD_LINEAR : q->sign_c ? QN_QUAD_CONSTANT : QN_QUAD_ZERO;
  }
  return q->sign_disc < 0 ? QN_QUAD_NONE : q->sign_disc == 0 ? QN_QUAD_DOUBLE : QN_QUAD_TWO;
}

/* A quadratic with a > 0, and the sign before the square root. */
typedef struct signed_root {
  qn_xint a, h, c, d;
  int plus;
} signed_root;

static signed_root upright(qn_root x) {
  const qn_quad *q = x.q;
  return q->sign_a > 0 ? (signed_root){q->a, q->h, q->c, q->disc, x.which}
                       : (signed_root){qn_x_neg(q->a), qn_x_neg(q->h), qn_x_neg(q->c), q->disc, x.which};
}

/* P: the value at n/m times m^2. */
static qn_xint value_at(qn_ctx *ctx, qn_xint a, qn_xint h, qn_xint c, qn_xint n, qn_xint m) {
  qn_xint inner = qn_x_add(ctx, qn_x_mul(ctx, a, n), qn_x_shl(ctx, qn_x_mul(ctx, h, m), 1));
  return qn_x_add(ctx, qn_x_mul(ctx, inner, n), qn_x_mul(ctx, qn_x_mul(ctx, c, m), m));
}

/* A root of a quadratic with two, against n/m, m > 0. */
static int against_rational(qn_ctx *ctx, signed_root x, qn_xint n, qn_xint m) {
  int b = -qn_x_sign(qn_x_add(ctx, qn_x_mul(ctx, x.h, m), qn_x_mul(ctx, x.a, n)));
  if (x.plus ? b >= 0 : b <= 0) {
    return x.plus ? 1 : -1;
  }
  int p = qn_x_sign(value_at(ctx, x.a, x.h, x.c, n, m));
  return x.plus ? -p : p;
}

/* G^2 - 4 J J'. */
static int resultant_sign(qn_ctx *ctx, const signed_root *x, const signed_root *y, qn_xint j, qn_xint g) {
  qn_xint jj = qn_x_sub(ctx, qn_x_mul(ctx, x->h, y->c), qn_x_mul(ctx, y->h, x->c));
  return qn_x_sign(qn_x_sub(ctx, qn_x_mul(ctx, g, g), qn_x_shl(ctx, qn_x_mul(ctx, j, jj), 2)));
}

static int plus_minus(qn_ctx *ctx, const signed_root *x, const signed_root *y) {
  qn_xint j = qn_x_sub(ctx, qn_x_mul(ctx, x->a, y->h), qn_x_mul(ctx, y->a, x->h));
  if (qn_x_sign(j) >= 0) {
    return 1;
  }
  qn_xint ac = qn_x_mul(ctx, x->a, y->c), ca = qn_x_mul(ctx, y->a, x->c);
  qn_xint k = qn_x_sub(ctx, qn_x_add(ctx, ac, ca), qn_x_shl(ctx, qn_x_mul(ctx, x->h, y->h), 1));
  if (qn_x_sign(k) <= 0) {
    return 1;
  }
  return -resultant_sign(ctx, x, y, j, qn_x_sub(ctx, ac, ca));
}

/* NOLINTNEXTLINE(misc-no-recursion): once, with the operands exchanged */
static int plus_plus(qn_ctx *ctx, const signed_root *x, const signed_root *y) {
  qn_xint j = qn_x_sub(ctx, qn_x_mul(ctx, x->a, y->h), qn_x_mul(ctx, y->a, x->h));
  int sj = qn_x_sign(j);
  if (sj < 0) {
    return -plus_plus(ctx, y, x); /* once: J is then positive */
  }
  qn_xint g = qn_x_sub(ctx, qn_x_mul(ctx, x->a, y->c), qn_x_mul(ctx, y->a, x->c));
  if (sj == 0) {
    return qn_x_sign(g); /* N = -a1 G */
  }
  qn_xint n = qn_x_sub(ctx, qn_x_shl(ctx, qn_x_mul(ctx, x->h, j), 1), qn_x_mul(ctx, x->a, g));
  if (qn_x_sign(n) <= 0) {
    return 1;
  }
  return -resultant_sign(ctx, x, y, j, g);
}

static int compare(qn_ctx *ctx, qn_root x, qn_root y) {
  if (qn_quad_rounded_(x.q) || qn_quad_rounded_(y.q)) {
    return qn_root_cmp_s2_(ctx, x, y);
  }
  qn_int n1, m1, n2, m2;
  int r1 = qn_root_plain_(ctx, x, &n1, &m1), r2 = qn_root_plain_(ctx, y, &n2, &m2);
  if (r1 && r2) {
    return qn_int_cmp(qn_int_mul(ctx, n1, m2), qn_int_mul(ctx, n2, m1));
  }
  if (r1) {
    return -against_rational(ctx, upright(y), qn_x(n1), qn_x(m1));
  }
  if (r2) {
    return against_rational(ctx, upright(x), qn_x(n2), qn_x(m2));
  }
  signed_root p = upright(x), q = upright(y);
  if (p.plus && q.plus) {
    return plus_plus(ctx, &p, &q);
  }
  if (p.plus) {
    return plus_minus(ctx, &p, &q);
  }
  if (q.plus) {
    return -plus_minus(ctx, &q, &p);
  }
  p.h = qn_x_neg(p.h);
  q.h = qn_x_neg(q.h);
  return -plus_plus(ctx, &p, &q);
}

int qn_root_cmp(qn_ctx *ctx, qn_root x, qn_root y) {
  if (x.q == y.q) {
    return (x.which > y.which) - (x.which < y.which);
  }
  qn_mark mark = qn_arena_mark(&ctx->arena);
  int order = compare(ctx, x, y);
  qn_arena_release(&ctx->arena, mark);
  return order;
}

int qn_root_cmp_rat(qn_ctx *ctx, qn_root x, qn_int num, qn_int den) {
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_int n, m;
  int order;
  if (qn_quad_rounded_(x.q)) {
    qn_quad line;
    qn_quad_make(ctx, qn_x(qn_int_from(ctx, 0)), qn_x(den), qn_x(qn_int_neg(qn_int_shl(ctx, num, 1))), &line);
    order = qn_root_cmp_s2_(ctx, x, (qn_root){&line, 0});
  } else if (qn_root_plain_(ctx, x, &n, &m)) {
    order = qn_int_cmp(qn_int_mul(ctx, n, den), qn_int_mul(ctx, num, m));
  } else {
    order = against_rational(ctx, upright(x), qn_x(num), qn_x(den));
  }
  qn_arena_release(&ctx->arena, mark);
  return order;
}

int qn_quad_sign_at(qn_ctx *ctx, const qn_quad *q, qn_int num, qn_int den) {
  qn_mark mark = qn_arena_mark(&ctx->arena);
  int sign = qn_x_sign(value_at(ctx, q->a, q->h, q->c, qn_x(num), qn_x(den)));
  qn_arena_release(&ctx->arena, mark);
  return sign;
}
