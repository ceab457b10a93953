/* The double nearest to a root, and rationals beside and between roots.

   Legend: a > 0, d = h^2 - a c > 0, S = |h| + sqrt d. The root away from zero is -+S/a and the other one c/(-+S): neither
   formula cancels. s = floor(2^k sqrt d) gives s <= 2^k sqrt d < s + 1, so S 2^k lies in [|h| 2^k + s, |h| 2^k + s + 1).
   When both ends round to one double that is the answer; else they round to neighbours (the enclosure is 2^-GUARD_BITS
   wide, relatively) and the exact order of the root and the middle between them decides. */
#include "number/int_limbs.h"
#include "number/quad_parts.h"

#include <float.h>
#include <math.h>

enum { GUARD_BITS = 130 };

/* q 2^e to nearest, ties to even; bit 0 of q may stand for anything more below it. q has 55 to 63 bits. */
static double scaled(uint64_t q, int64_t e) {
  int bits = 64 - (int)qn_leading_zeros(q);
  int64_t top = e + bits - 1;
  if (top > DBL_MAX_EXP - 1) {
    return HUGE_VAL;
  }
  if (top < DBL_MIN_EXP - DBL_MANT_DIG - 1) {
    return 0; /* under half of the least subnormal */
  }
  int64_t keep = top >= DBL_MIN_EXP - 1 ? DBL_MANT_DIG : top - (DBL_MIN_EXP - 1) + DBL_MANT_DIG;
  int drop = bits - (int)keep;
  uint64_t r = q >> drop, rest = q & (((uint64_t)1 << drop) - 1), half = (uint64_t)1 << (drop - 1);
  if (rest > half || (rest == half && (r & 1))) {
    r++;
  }
  return ldexp((double)r, (int)(e + drop)); /* exact, or infinite by the last carry */
}

/* n/d to nearest, ties to even; n >= 0, d > 0. */
static double ratio(qn_ctx *ctx, qn_int n, qn_int d) {
  if (qn_int_sign(n) == 0) {
    return 0;
  }
  int64_t shift = 62 - ((int64_t)qn_int_bits(n) - (int64_t)qn_int_bits(d)); /* the quotient has 62 or 63 bits */
  if (shift > 0) {
    n = qn_int_shl(ctx, n, (size_t)shift);
  } else {
    d = qn_int_shl(ctx, d, (size_t)-shift);
  }
  qn_int q, r;
  qn_int_divmod(ctx, n, d, &q, &r);
  int64_t v = 0;
  if (ctx->failed || !qn_int_fits(q, &v)) {
    return 0; /* only when memory was refused: the context says so */
  }
  return scaled((uint64_t)v | (uint64_t)(qn_int_sign(r) != 0), -shift);
}

static double with_sign(int sign, double v) {
  return sign < 0 && v != 0 ? -v : v;
}

/* Of the neighbours lo < hi (hi may be infinite) around |x| > 0, the nearer one. */
static double nearer(qn_ctx *ctx, qn_root x, int sign, double lo, double hi) {
  int e = DBL_MIN_EXP - DBL_MANT_DIG; /* lo = m 2^e */
  if (lo >= DBL_MIN) {
    frexp(lo, &e);
    e -= DBL_MANT_DIG;
  }
  int64_t m = (int64_t)ldexp(lo, -e);
  qn_int num = qn_int_from(ctx, 2 * m + 1), den = qn_int_from(ctx, 1);
  e--;
  if (e > 0) {
    num = qn_int_shl(ctx, num, (size_t)e);
  } else {
    den = qn_int_shl(ctx, den, (size_t)-e);
  }
  int order = sign < 0 ? -qn_root_cmp_rat(ctx, x, qn_int_neg(num), den) : qn_root_cmp_rat(ctx, x, num, den);
  return order < 0 ? lo : order > 0 ? hi : m % 2 == 0 ? lo : hi;
}

int qn_root_plain_(qn_ctx *ctx, qn_root x, qn_int *num, qn_int *den) {
  const qn_quad *q = x.q;
  if (q->sign_a == 0) {
    *num = qn_int_neg(q->c.v);
    *den = qn_int_shl(ctx, q->h.v, 1);
  } else if (q->sign_disc == 0) {
    *num = qn_int_neg(q->h.v);
    *den = q->a.v;
  } else {
    return 0;
  }
  if (qn_int_sign(*den) < 0) {
    *num = qn_int_neg(*num);
    *den = qn_int_neg(*den);
  }
  return 1;
}

static double two_to_double(qn_ctx *ctx, qn_root x) {
  const qn_quad *q = x.q;
  if (q->sign_c == 0 && (q->sign_h < 0) == (x.which == (q->sign_a < 0))) {
    return 0; /* roots 0 and -2h/a: 0 is the lesser one where -h/a > 0 */
  }
  qn_int a = qn_int_abs(q->a.v), c = q->sign_a < 0 ? qn_int_neg(q->c.v) : q->c.v;
  int sign_h = q->sign_a < 0 ? -q->sign_h : q->sign_h;
  size_t half = qn_int_bits(q->disc.v) / 2, k = half < GUARD_BITS ? GUARD_BITS - half : 0;
  int square = 0;
  qn_int s = qn_int_sqrt(ctx, qn_int_shl(ctx, q->disc.v, 2 * k), &square);
  qn_int lo = qn_int_add(ctx, qn_int_shl(ctx, qn_int_abs(q->h.v), k), s);
  qn_int hi = square ? lo : qn_int_add(ctx, lo, qn_int_from(ctx, 1));
  int big = (sign_h <= 0) == (x.which == 1); /* the root away from zero: -h and the square root have one sign */
  int sign = sign_h <= 0 ? 1 : -1;           /* of that root */
  double least, most;
  if (big) {
    a = qn_int_shl(ctx, a, k);
    least = ratio(ctx, lo, a);
    most = square ? least : ratio(ctx, hi, a);
  } else {
    sign *= qn_int_sign(c);
    c = qn_int_shl(ctx, qn_int_abs(c), k);
    least = ratio(ctx, c, hi);
    most = square ? least : ratio(ctx, c, lo);
  }
  if (ctx->failed) {
    return 0;
  }
  return with_sign(sign, least == most ? least : nearer(ctx, x, sign, least, most));
}

double qn_rat_to_double(qn_ctx *ctx, qn_int num, qn_int den) {
  qn_mark mark = qn_arena_mark(&ctx->arena);
  double v = with_sign(qn_int_sign(num), ratio(ctx, qn_int_abs(num), den));
  qn_arena_release(&ctx->arena, mark);
  return v;
}

/* A root num/den of a quadratic with rounded numbers (S2): where it agrees with the middle of two doubles it is that middle, as it is in
   every comparison; the stored quotient may lie on either side, depending on what else was done to the solid. */
static double rounded_to_double(qn_ctx *ctx, qn_root x, qn_int num, qn_int den) {
  if (x.q->sign_a == 0 ? x.q->sign_c == 0 : x.q->sign_h == 0) {
    return 0;
  }
  int sign = qn_int_sign(num);
  double v = ratio(ctx, qn_int_abs(num), den);
  if (ctx->failed == QUOIN_OK && v > 0) {
    double under = nextafter(v, 0), over = nextafter(v, HUGE_VAL);
    v = nearer(ctx, x, sign, under, v) == under ? under : v < over && nearer(ctx, x, sign, v, over) == over ? over : v;
  }
  return with_sign(sign, v);
}

double qn_root_to_double(qn_ctx *ctx, qn_root x) {
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_int num, den;
  double v;
  if (!qn_root_plain_(ctx, x, &num, &den)) {
    v = two_to_double(ctx, x);
  } else if (qn_quad_rounded_(x.q)) {
    v = rounded_to_double(ctx, x, num, den);
  } else {
    v = with_sign(qn_int_sign(num), ratio(ctx, qn_int_abs(num), den));
  }
  qn_arena_release(&ctx->arena, mark);
  return v;
}

int qn_root_rational(qn_ctx *ctx, qn_root x, qn_int *num, qn_int *den) {
  if (qn_root_plain_(ctx, x, num, den)) {
    return 1;
  }
  int square = 0;
  qn_int s = qn_int_sqrt(ctx, x.q->disc.v, &square);
  if (!square) {
    return 0;
  }
  if (x.q->sign_a < 0) { /* the larger root is (h + s)/-a, the smaller (h - s)/-a */
    *num = x.which ? qn_int_add(ctx, x.q->h.v, s) : qn_int_sub(ctx, x.q->h.v, s);
  } else {
    *num = x.which ? qn_int_sub(ctx, s, x.q->h.v) : qn_int_neg(qn_int_add(ctx, x.q->h.v, s));
  }
  *den = qn_int_abs(x.q->a.v);
  return 1;
}

qn_int qn_root_scaled_(qn_ctx *ctx, qn_root x, size_t k) {
  qn_int num, den, quotient, rest;
  if (qn_root_plain_(ctx, x, &num, &den)) {
    num = qn_int_shl(ctx, num, k);
  } else {
    int square;
    qn_int s = qn_int_sqrt(ctx, qn_int_shl(ctx, x.q->disc.v, 2 * k), &square);
    qn_int h = qn_int_shl(ctx, x.q->sign_a < 0 ? qn_int_neg(x.q->h.v) : x.q->h.v, k);
    num = x.which ? qn_int_sub(ctx, s, h) : qn_int_neg(qn_int_add(ctx, s, h));
    den = qn_int_abs(x.q->a.v);
  }
  qn_int_divmod(ctx, num, den, &quotient, &rest);
  return quotient;
}

qn_quad qn_quad_stored_(const qn_quad *q) {
  qn_quad p = *q;
  p.a.mag = p.h.mag = p.c.mag = p.disc.mag = QN_EXACT;
  return p;
}

/* A number m 2^e within a few units of 2^e; 0, or m has at least so many bits as were asked for. */
typedef struct rough { qn_int m; int64_t e; } rough;

/* Its first bits, 2^*e of them dropped. */
static qn_int leading(qn_ctx *ctx, qn_int v, size_t bits, int64_t *e) {
  const size_t all = qn_int_bits(v), drop = all > bits ? all - bits : 0;
  *e += (int64_t)drop;
  return qn_int_shr(ctx, v, drop);
}

/* Roots of long numbers from their first bits alone: nothing cancels in either formula. */
static rough approximate(qn_ctx *ctx, qn_root x, size_t bits) {
  const qn_quad *q = x.q;
  const size_t more = bits + 4;
  qn_int n, d;
  int64_t en = 0, ed = 0;
  int negative = 0;
  if (!qn_root_plain_(ctx, x, &n, &d)) {
    const qn_int h = q->sign_a < 0 ? qn_int_neg(q->h.v) : q->h.v, c = q->sign_a < 0 ? qn_int_neg(q->c.v) : q->c.v;
    const size_t all = qn_int_bits(q->disc.v), half = all > 2 * more ? (all - 2 * more) / 2 : 0; /* S in units of 2^half */
    const size_t finer = all < 2 * more ? more - all / 2 : 0;                                    /* or of 2^-finer */
    int square;
    const qn_int root = qn_int_sqrt(ctx, finer ? qn_int_shl(ctx, q->disc.v, 2 * finer) : qn_int_shr(ctx, q->disc.v, 2 * half), &square);
    const qn_int size = qn_int_abs(h), S = qn_int_add(ctx, root, finer ? qn_int_shl(ctx, size, finer) : qn_int_shr(ctx, size, half));
    const int64_t unit = (int64_t)half - (int64_t)finer;
    negative = qn_int_sign(h) > 0;
    if ((qn_int_sign(h) <= 0) == (x.which == 1)) {
      n = S, en = unit, d = qn_int_abs(q->a.v);
    } else {
      n = c, d = S, ed = unit;
    }
  }
  n = leading(ctx, n, more, &en), d = leading(ctx, d, more, &ed);
  if (ctx->failed != QUOIN_OK || qn_int_sign(n) == 0 || qn_int_sign(d) == 0) {
    return (rough){QN_INT_ZERO_, 0};
  }
  const size_t wanted = bits + qn_int_bits(d), there = qn_int_bits(n), up = wanted > there ? wanted - there : 0;
  qn_int quotient, rest;
  qn_int_divmod(ctx, qn_int_shl(ctx, n, up), d, &quotient, &rest);
  return (rough){negative ? qn_int_neg(quotient) : quotient, en - ed - (int64_t)up};
}

int qn_root_size_(qn_ctx *ctx, qn_root x, int64_t *e) {
  enum { FEW = 8 };
  const rough v = approximate(ctx, x, FEW);
  *e = v.e + (int64_t)qn_int_bits(v.m) + 1;
  return qn_int_sign(v.m) != 0;
}

/* In units of 2^e, of which nothing is known beyond. */
static qn_int in_units(qn_ctx *ctx, rough v, int64_t e) { return v.e >= e ? v.m : qn_int_shr(ctx, v.m, (size_t)(e - v.e)); }

/* Near the middle, and of few bits: roots may be 2^-10000 apart, and 10000 bits long. What is proposed is asked of both roots exactly. */
void qn_root_between(qn_ctx *ctx, qn_root x, qn_root y, qn_int *num, qn_int *den) {
  enum { APART = 9 }; /* bits of units, which the few that either root is off do not matter to */
  const int rounded = qn_quad_rounded_(x.q) || qn_quad_rounded_(y.q);
  qn_quad p = qn_quad_stored_(x.q), q = qn_quad_stored_(y.q);
  x.q = &p;
  y.q = &q;
  if (rounded && qn_root_cmp(ctx, x, y) >= 0) {
    qn_ctx_fail_(ctx, QUOIN_E_LIMIT);
  }
  for (size_t bits = 64; !ctx->failed; bits *= 2) { /* ends: distinct roots are some distance apart */
    const rough a = approximate(ctx, x, bits), b = approximate(ctx, y, bits);
    int64_t e = qn_int_sign(a.m) == 0 || (qn_int_sign(b.m) != 0 && b.e > a.e) ? b.e : a.e;
    const qn_int low = in_units(ctx, a, e), high = in_units(ctx, b, e), gap = qn_int_sub(ctx, high, low);
    const size_t wide = qn_int_bits(gap);
    if (wide < APART) {
      continue;
    }
    *num = qn_int_shr(ctx, qn_int_add(ctx, low, high), wide - APART);
    e += (int64_t)(wide - APART) - 1;
    *den = qn_int_shl(ctx, qn_int_from(ctx, 1), e < 0 ? (size_t)-e : 0);
    *num = e > 0 ? qn_int_shl(ctx, *num, (size_t)e) : *num;
    if (qn_root_cmp_rat(ctx, x, *num, *den) < 0 && qn_root_cmp_rat(ctx, y, *num, *den) > 0) {
      return;
    }
  }
}

void qn_root_below(qn_ctx *ctx, qn_root x, qn_int *num, qn_int *den) {
  *num = qn_int_sub(ctx, qn_root_scaled_(ctx, x, 0), qn_int_from(ctx, 3));
  *den = qn_int_from(ctx, 1);
}

void qn_root_above(qn_ctx *ctx, qn_root x, qn_int *num, qn_int *den) {
  *num = qn_int_add(ctx, qn_root_scaled_(ctx, x, 0), qn_int_from(ctx, 3));
  *den = qn_int_from(ctx, 1);
}
