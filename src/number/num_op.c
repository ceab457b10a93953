/* Arithmetic of numbers. Exact unless an operand is rounded; then the exact result of the operation is rounded once.

   Legend: x = xn/xd, y = yn/yd reduced. A sum with g = gcd(xd, yd): t = xn (yd/g) + yn (xd/g), and gcd(t, xd yd / g) =
   gcd(t, g) (Knuth, TAOCP 2, 4.5.1). A product: only gcd(xn, yd) and gcd(yn, xd) can be common. */
#include "number/num_parts.h"

static int is_one(qn_int v) {
  return v.n == 1 && v.d[0] == 1;
}

qn_num qn_num_neg(qn_ctx *ctx, qn_num a) {
  if (a.kind == QN_NUM_SMALL) {
    a.u.m = -a.u.m;
    return a;
  }
  qn_rat *r = qn_arena_take(&ctx->arena, sizeof *r); /* shares the limbs */
  if (!r) {
    qn_ctx_fail_(ctx, QUOIN_E_MEMORY);
    return QN_NUM_ZERO;
  }
  *r = (qn_rat){qn_int_neg(a.u.big->num), a.u.big->den};
  a.u.big = r;
  return a;
}

qn_num qn_num_abs(qn_ctx *ctx, qn_num a) {
  return qn_num_sign(a) < 0 ? qn_num_neg(ctx, a) : a;
}

/* The sum of two rounded numbers, or of one and an exact one. */
static qn_num rounded_sum(qn_ctx *ctx, qn_mark mark, qn_rat x, qn_rat y) {
  qn_int p = qn_int_mul(ctx, x.num, y.den), q = qn_int_mul(ctx, y.num, x.den), t = qn_int_add(ctx, p, q);
  qn_int larger = qn_int_cmp(qn_int_abs(p), qn_int_abs(q)) > 0 ? p : q;
  if (qn_num_agree_(ctx, t, larger)) {
    t = QN_INT_ZERO_;
  }
  return qn_num_settle_(ctx, mark, t, qn_int_mul(ctx, x.den, y.den), 1);
}

static QN_NOINLINE qn_num big_sum(qn_ctx *ctx, qn_num a, qn_num b) {
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_rat x = qn_num_rat(ctx, a), y = qn_num_rat(ctx, b);
  if (qn_num_is_rounded(a) || qn_num_is_rounded(b)) {
    return rounded_sum(ctx, mark, x, y);
  }
  qn_int g = qn_int_gcd(ctx, x.den, y.den);
  if (is_one(g)) {
    qn_int t = qn_int_add(ctx, qn_int_mul(ctx, x.num, y.den), qn_int_mul(ctx, y.num, x.den));
    return qn_num_settle_(ctx, mark, t, qn_int_mul(ctx, x.den, y.den), 0);
  }
  qn_int xd = qn_int_divexact(ctx, x.den, g), yd = qn_int_divexact(ctx, y.den, g);
  qn_int t = qn_int_add(ctx, qn_int_mul(ctx, x.num, yd), qn_int_mul(ctx, y.num, xd));
  qn_int g2 = qn_int_gcd(ctx, t, g);
  return qn_num_settle_(ctx, mark, qn_int_divexact(ctx, t, g2), qn_int_mul(ctx, xd, qn_int_divexact(ctx, y.den, g2)), 0);
}

/* The sum of two small numbers, the second one's m given apart so that a difference needs no copy; 0: it is not small,
   or the terms are too far apart for 128 bits. */
QN_INLINE int small_sum(qn_num a, qn_num b, int64_t bm, qn_num *out) {
  int64_t twos = a.a < b.a ? a.a : b.a, fives = a.b < b.b ? a.b : b.b;
  qn_u128 x, y;
  if (a.a == b.a && a.b == b.b) {
    x = qn_magnitude_(a.u.m);
    y = qn_magnitude_(bm);
  } else if (!qn_num_scaled_(a.u.m, a.a - twos, a.b - fives, &x) || !qn_num_scaled_(bm, b.a - twos, b.b - fives, &y)) {
    return 0;
  }
  int sx = a.u.m < 0, sy = bm < 0;
  if (sx == sy) {
    return qn_num_small_(x + y, sx, twos, fives, out);
  }
  return x > y ? qn_num_small_(x - y, sx, twos, fives, out) : qn_num_small_(y - x, sy, twos, fives, out);
}

static qn_num sum(qn_ctx *ctx, qn_num a, qn_num b, int minus) {
  if (qn_num_is_zero(b)) {
    return a;
  }
  if (qn_num_is_zero(a)) {
    return minus ? qn_num_neg(ctx, b) : b;
  }
  qn_num r;
  if (a.kind == QN_NUM_SMALL && b.kind == QN_NUM_SMALL && small_sum(a, b, minus ? -b.u.m : b.u.m, &r)) {
    return r;
  }
  qn_rat negated;
  if (minus) { /* for the duration of the sum */
    if (b.kind == QN_NUM_SMALL) {
      b.u.m = -b.u.m;
    } else {
      negated = (qn_rat){qn_int_neg(b.u.big->num), b.u.big->den};
      b.u.big = &negated;
    }
  }
  return big_sum(ctx, a, b);
}

qn_num qn_num_add(qn_ctx *ctx, qn_num a, qn_num b) {
  return sum(ctx, a, b, 0);
}

qn_num qn_num_sub(qn_ctx *ctx, qn_num a, qn_num b) {
  return sum(ctx, a, b, 1);
}

static QN_NOINLINE qn_num big_product(qn_ctx *ctx, qn_mark mark, qn_rat x, qn_rat y, int rounded) {
  if (!rounded) {
    qn_int g = qn_int_gcd(ctx, x.num, y.den), k = qn_int_gcd(ctx, y.num, x.den);
    x.num = qn_int_divexact(ctx, x.num, g);
    y.den = qn_int_divexact(ctx, y.den, g);
    y.num = qn_int_divexact(ctx, y.num, k);
    x.den = qn_int_divexact(ctx, x.den, k);
  }
  return qn_num_settle_(ctx, mark, qn_int_mul(ctx, x.num, y.num), qn_int_mul(ctx, x.den, y.den), rounded);
}

static int in_range(int64_t a, int64_t b) {
  return a >= INT16_MIN && a <= INT16_MAX && b >= INT16_MIN && b <= INT16_MAX;
}

qn_num qn_num_mul(qn_ctx *ctx, qn_num a, qn_num b) {
  if (qn_num_is_zero(a) || qn_num_is_zero(b)) {
    return QN_NUM_ZERO;
  }
  if (a.kind == QN_NUM_SMALL && b.kind == QN_NUM_SMALL) {
    qn_i128 p = (qn_i128)a.u.m * b.u.m; /* free of 2 and 5, as its factors are */
    int twos = a.a + b.a, fives = a.b + b.b;
    if (p == (int64_t)p && in_range(twos, fives)) {
      return (qn_num){{(int64_t)p}, (int16_t)twos, (int16_t)fives, QN_NUM_SMALL};
    }
  }
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_rat x = qn_num_rat(ctx, a), y = qn_num_rat(ctx, b);
  return big_product(ctx, mark, x, y, qn_num_is_rounded(a) || qn_num_is_rounded(b));
}

qn_num qn_num_div(qn_ctx *ctx, qn_num a, qn_num b) {
  if (qn_num_is_zero(a) || qn_num_is_zero(b)) { /* b = 0: only after a failure */
    return QN_NUM_ZERO;
  }
  if (a.kind == QN_NUM_SMALL && b.kind == QN_NUM_SMALL && a.u.m % b.u.m == 0) {
    int twos = a.a - b.a, fives = a.b - b.b;
    if (in_range(twos, fives)) {
      return (qn_num){{a.u.m / b.u.m}, (int16_t)twos, (int16_t)fives, QN_NUM_SMALL};
    }
  }
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_rat x = qn_num_rat(ctx, a), y = qn_num_rat(ctx, b);
  qn_rat inverse = {y.num.n < 0 ? qn_int_neg(y.den) : y.den, qn_int_abs(y.num)};
  return big_product(ctx, mark, x, inverse, qn_num_is_rounded(a) || qn_num_is_rounded(b));
}

qn_num qn_num_dot(qn_ctx *ctx, size_t n, const qn_num *a, const qn_num *b) {
  int rounded = 0;
  for (size_t i = 0; i < n; i++) {
    rounded |= (qn_num_is_rounded(a[i]) && !qn_num_is_zero(b[i])) || (qn_num_is_rounded(b[i]) && !qn_num_is_zero(a[i]));
  }
  if (!rounded) {
    qn_num s = QN_NUM_ZERO;
    for (size_t i = 0; i < n; i++) {
      s = qn_num_add(ctx, s, qn_num_mul(ctx, a[i], b[i]));
    }
    return s;
  }
  /* Exactly, over a common denominator; rounded once at the end. */
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_int s = QN_INT_ZERO_, den = QN_INT_ONE_, largest = QN_INT_ZERO_;
  for (size_t i = 0; i < n; i++) {
    if (qn_num_is_zero(a[i]) || qn_num_is_zero(b[i])) {
      continue;
    }
    qn_rat x = qn_num_rat(ctx, a[i]), y = qn_num_rat(ctx, b[i]);
    qn_int p = qn_int_mul(ctx, x.num, y.num), q = qn_int_mul(ctx, x.den, y.den);
    if (!qn_int_equal(q, den)) {
      p = qn_int_mul(ctx, p, den);
      s = qn_int_mul(ctx, s, q);
      largest = qn_int_mul(ctx, largest, q);
      den = qn_int_mul(ctx, den, q);
    }
    s = qn_int_add(ctx, s, p);
    largest = qn_int_cmp(qn_int_abs(p), largest) > 0 ? qn_int_abs(p) : largest;
  }
  if (qn_num_agree_(ctx, s, largest)) {
    s = QN_INT_ZERO_;
  }
  return qn_num_settle_(ctx, mark, s, den, 1);
}

typedef enum way { DOWN, UP, NEAREST, TOWARDS_ZERO } way;

/* The integer next to num/den, den > 0, in the way given. A rounded number that agrees with an integer to QN_S2_BITS is
   that integer (S2). */
static qn_int integer_at(qn_ctx *ctx, qn_int num, qn_int den, way w, int rounded) {
  qn_int q, r, one = num.n < 0 ? qn_int_neg(QN_INT_ONE_) : QN_INT_ONE_;
  qn_int_divmod(ctx, num, den, &q, &r);
  if (r.n == 0) {
    return q;
  }
  if (rounded) {
    if (q.n != 0 && qn_num_agree_(ctx, r, num)) {
      return q;
    }
    if (qn_num_agree_(ctx, qn_int_sub(ctx, den, qn_int_abs(r)), num)) {
      return qn_int_add(ctx, q, one);
    }
  }
  switch (w) {
    case DOWN: return num.n < 0 ? qn_int_add(ctx, q, one) : q;
    case UP: return num.n > 0 ? qn_int_add(ctx, q, one) : q;
    case NEAREST: return qn_int_cmp(qn_int_shl(ctx, qn_int_abs(r), 1), den) >= 0 ? qn_int_add(ctx, q, one) : q;
    case TOWARDS_ZERO: return q;
  }
  return q;
}

static qn_num to_integer(qn_ctx *ctx, qn_num a, way w) {
  if (a.kind == QN_NUM_SMALL && a.a >= 0 && a.b >= 0) {
    return a;
  }
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_rat r = qn_num_rat(ctx, a);
  if (qn_num_is_rounded(a) && qn_int_bits(r.num) > qn_int_bits(r.den) + QN_S2_BITS) {
    return a; /* every integer near it agrees with it */
  }
  return qn_num_settle_(ctx, mark, integer_at(ctx, r.num, r.den, w, qn_num_is_rounded(a)), QN_INT_ONE_, 0);
}

qn_num qn_num_floor(qn_ctx *ctx, qn_num a) {
  return to_integer(ctx, a, DOWN);
}
qn_num qn_num_ceil(qn_ctx *ctx, qn_num a) {
  return to_integer(ctx, a, UP);
}
qn_num qn_num_round(qn_ctx *ctx, qn_num a) {
  return to_integer(ctx, a, NEAREST);
}

/* The integer within 2^-QN_S2_BITS of a rounded number r = M/2^K, where it fits. M has at most 4 limbs where K > 0. */
static int rounded_integer(qn_rat r, int64_t *out) {
  enum { LIMBS = QN_S2_PRECISION / 64 };
  size_t k = qn_int_bits(r.den) - 1, bits = qn_int_bits(r.num);
  if (k == 0) {
    return qn_int_fits(r.num, out);
  }
  if (bits < k || bits > k + 64 || qn_limbs_(r.num) > LIMBS) { /* below 1/2, too large, or not rounded by this station */
    return 0;
  }
  /* t = floor(M / 2^K) and the rest; above a half the next integer is the near one. */
  mp_limb_t m[LIMBS + 2] = {0}, t[LIMBS + 2] = {0}, rest[LIMBS + 2] = {0};
  mpn_copyi(m, r.num.d, qn_limbs_(r.num));
  mp_size_t whole = (mp_size_t)(k / 64);
  unsigned part = (unsigned)(k % 64);
  t[0] = m[whole] >> part | (part ? m[whole + 1] << (64 - part) : 0);
  mpn_copyi(rest, m, whole + 1);
  rest[whole] = part ? rest[whole] & (((mp_limb_t)1 << part) - 1) : 0;
  if (part ? rest[whole] >> (part - 1) : whole > 0 && rest[whole - 1] >> 63) {
    mp_limb_t unit[LIMBS + 2] = {0};
    unit[whole] = (mp_limb_t)1 << part;
    mpn_sub_n(rest, unit, rest, LIMBS + 2);
    if (++t[0] == 0) {
      return 0;
    }
  }
  mp_limb_t up[2 * LIMBS + 2] = {0};
  up[QN_S2_BITS / 64 + LIMBS + 1] = mpn_lshift(up + QN_S2_BITS / 64, rest, LIMBS + 1, QN_S2_BITS % 64);
  mp_limb_t wide[2 * LIMBS + 2] = {0};
  mpn_copyi(wide, m, LIMBS);
  qn_int v = {t[0] == 0 ? 0 : r.num.n < 0 ? -1 : 1, t};
  return mpn_cmp(up, wide, 2 * LIMBS + 2) < 0 && qn_int_fits(v, out);
}

int qn_num_is_integer(qn_num a, int64_t *out) {
  if (a.kind == QN_NUM_SMALL) {
    uint64_t m = qn_magnitude_(a.u.m);
    if (a.a < 0 || a.b < 0 || a.b > QN_FIVES_ || a.a > 63) {
      return 0;
    }
    qn_u128 v = (qn_u128)m * qn_five_to_[a.b];
    if (v >> (64 - a.a)) {
      return 0;
    }
    uint64_t w = (uint64_t)v << a.a;
    if (w > (uint64_t)INT64_MAX + (a.u.m < 0)) {
      return 0;
    }
    *out = a.u.m < 0 ? -(int64_t)(w - 1) - 1 : (int64_t)w;
    return 1;
  }
  const qn_rat *r = a.u.big;
  return qn_num_is_rounded(a) ? rounded_integer(*r, out) : is_one(r->den) && qn_int_fits(r->num, out);
}

qn_num qn_num_mod(qn_ctx *ctx, qn_num a, qn_num b) {
  if (qn_num_is_zero(a) || qn_num_is_zero(b)) { /* b = 0: only after a failure */
    return QN_NUM_ZERO;
  }
  int rounded = qn_num_is_rounded(a) || qn_num_is_rounded(b);
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_rat x = qn_num_rat(ctx, a), y = qn_num_rat(ctx, b);
  qn_int p = qn_int_mul(ctx, x.num, y.den), q = qn_int_abs(qn_int_mul(ctx, y.num, x.den)), quotient, r;
  qn_int_divmod(ctx, p, q, &quotient, &r);
  /* A rounded quotient that agrees with an integer is that integer. */
  if (rounded && quotient.n != 0 && qn_num_agree_(ctx, r, p)) {
    r = QN_INT_ZERO_;
  }
  if (rounded && qn_num_agree_(ctx, qn_int_sub(ctx, q, qn_int_abs(r)), p)) {
    r = QN_INT_ZERO_;
  }
  qn_int den = qn_int_mul(ctx, x.den, y.den);
  if (rounded) {
    return qn_num_settle_(ctx, mark, r, den, 1);
  }
  qn_int g = qn_int_gcd(ctx, r, den);
  return qn_num_settle_(ctx, mark, qn_int_divexact(ctx, r, g), qn_int_divexact(ctx, den, g), 0);
}
