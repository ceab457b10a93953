/* Numbers of a model: their canonical form, how they are made, compared and taken apart.

   Legend: small is m 2^a 5^b, m free of 2 and 5; big is a reduced fraction num/den that has no small form; rounded is
   M/2^K or M 2^K, M odd, of at most QN_S2_PRECISION bits. Zero is small. */
#include "number/num_parts.h"

#include <string.h>

const uint64_t qn_five_to_[QN_FIVES_ + 1] = {
    1, 5, 25, 125, 625, 3125, 15625, 78125, 390625, 1953125, 9765625, 48828125, 244140625, 1220703125, 6103515625,
    30517578125, 152587890625, 762939453125, 3814697265625, 19073486328125, 95367431640625, 476837158203125,
    2384185791015625, 11920928955078125, 59604644775390625, 298023223876953125, 1490116119384765625, 7450580596923828125,
};
const mp_limb_t qn_limb_one_ = 1;

static int in_range(int64_t a, int64_t b) {
  return a >= INT16_MIN && a <= INT16_MAX && b >= INT16_MIN && b <= INT16_MAX;
}

int qn_num_small_(qn_u128 v, int negative, int64_t a, int64_t b, qn_num *out) {
  uint64_t low = (uint64_t)v, high = (uint64_t)(v >> 64);
  if ((low | high) == 0) {
    *out = QN_NUM_ZERO;
    return 1;
  }
  unsigned twos = low ? qn_trailing_zeros(low) : 64 + qn_trailing_zeros(high);
  v >>= twos;
  a += twos;
  low = (uint64_t)v;
  high = (uint64_t)(v >> 64);
  while (high && (high % 5 + low % 5) % 5 == 0) { /* 2^64 is 1 modulo 5 */
    v /= 5;
    b++;
    low = (uint64_t)v;
    high = (uint64_t)(v >> 64);
  }
  if (high) {
    return 0;
  }
  b += qn_strip_fives_(&low);
  if (low > INT64_MAX || !in_range(a, b)) {
    return 0;
  }
  *out = (qn_num){{negative ? -(int64_t)low : (int64_t)low}, (int16_t)a, (int16_t)b, QN_NUM_SMALL};
  return 1;
}

qn_int qn_int_strip_fives_(qn_ctx *ctx, qn_int v, int64_t *n) {
  *n = 0;
  while (qn_limbs_(v) > 1 && mpn_mod_1(v.d, qn_limbs_(v), (mp_limb_t)qn_five_to_[QN_FIVES_]) == 0) {
    v = qn_int_divexact(ctx, v, (qn_int){1, (const mp_limb_t *)&qn_five_to_[QN_FIVES_]});
    *n += QN_FIVES_;
  }
  while (qn_limbs_(v) > 1 && mpn_mod_1(v.d, qn_limbs_(v), 5) == 0) {
    v = qn_int_divexact(ctx, v, (qn_int){1, (const mp_limb_t *)&qn_five_to_[1]});
    ++*n;
  }
  if (qn_limbs_(v) == 1) {
    uint64_t d = v.d[0];
    int more = qn_strip_fives_(&d);
    *n += more;
    v = more ? qn_int_from_limbs(ctx, &d, 1, v.n < 0) : v;
  }
  return v;
}

/* The small form of a reduced fraction, if it has one. */
static int demoted(qn_ctx *ctx, qn_int num, qn_int den, qn_num *out) {
  size_t dz = qn_int_trailing_zeros(den), nz = qn_int_trailing_zeros(num);
  int64_t df = 0, nf = 0;
  if (qn_int_bits(den) - dz > 1) {
    if (qn_int_bits(num) - nz > 64) {
      return 0; /* beside fives below there are none above: its size is what it is */
    }
    qn_int odd = qn_int_shr(ctx, den, dz);
    if (odd.n == 0 || mpn_mod_1(odd.d, odd.n, 5) != 0) {
      return 0;
    }
    odd = qn_int_strip_fives_(ctx, odd, &df);
    if (odd.n != 1 || odd.d[0] != 1) {
      return 0;
    }
  }
  qn_int odd = qn_int_shr(ctx, num, nz);
  if (df == 0 && odd.n != 0) {
    odd = qn_int_strip_fives_(ctx, odd, &nf);
  }
  return qn_limbs_(odd) == 1 && qn_num_small_(odd.d[0], odd.n < 0, (int64_t)nz - (int64_t)dz, nf - df, out);
}

void qn_num_round_rat_(qn_ctx *ctx, qn_int *num, qn_int *den) {
  qn_int n = qn_int_abs(*num), d = *den;
  int negative = num->n < 0, sticky = 0;
  int64_t e;
  size_t dz = qn_int_trailing_zeros(d), db = qn_int_bits(d), nb = qn_int_bits(n);
  if (n.n == 0 || d.n == 0) {
    *num = QN_INT_ZERO_;
    *den = QN_INT_ONE_;
    return;
  }
  if (db == dz + 1) {
    e = -(int64_t)dz;
  } else { /* a quotient of at least QN_S2_PRECISION + 2 bits, and whether anything is left */
    e = (int64_t)nb - (int64_t)db - (QN_S2_PRECISION + 2);
    if (e < 0) {
      n = qn_int_shl(ctx, n, (size_t)-e);
    } else {
      d = qn_int_shl(ctx, d, (size_t)e);
    }
    qn_int r;
    qn_int_divmod(ctx, n, d, &n, &r);
    sticky = r.n != 0;
    nb = qn_int_bits(n);
  }
  if (nb > QN_S2_PRECISION) {
    size_t drop = nb - QN_S2_PRECISION;
    int half = (int)(n.d[(drop - 1) / 64] >> ((drop - 1) % 64) & 1);
    sticky |= qn_int_trailing_zeros(n) < drop - 1;
    n = qn_int_shr(ctx, n, drop);
    e += (int64_t)drop;
    if (half && n.n != 0 && (sticky || (n.d[0] & 1))) {
      n = qn_int_add(ctx, n, QN_INT_ONE_);
    }
  }
  size_t z = qn_int_trailing_zeros(n);
  n = qn_int_shr(ctx, n, z);
  e += (int64_t)z;
  *den = e < 0 ? qn_int_shl(ctx, QN_INT_ONE_, (size_t)-e) : QN_INT_ONE_;
  n = e > 0 ? qn_int_shl(ctx, n, (size_t)e) : n;
  *num = negative ? qn_int_neg(n) : n;
}

/* A fraction in one block: its two headers and then the limbs of both. */
static const qn_rat *stored(qn_ctx *ctx, qn_int num, qn_int den) {
  size_t nn = (size_t)qn_limbs_(num), dn = (size_t)den.n;
  qn_rat *rat = qn_arena_take(&ctx->arena, sizeof *rat + (nn + dn) * sizeof(mp_limb_t));
  if (!rat) {
    qn_ctx_fail_(ctx, QUOIN_E_MEMORY);
    return NULL;
  }
  mp_limb_t *d = (mp_limb_t *)(rat + 1);
  mpn_copyi(d, num.d, (mp_size_t)nn);
  mpn_copyi(d + nn, den.d, (mp_size_t)dn);
  *rat = (qn_rat){{num.n, d}, {den.n, d + nn}};
  return rat;
}

/* A fraction in the arena, after giving back what was taken since the mark: through a buffer when it is short. */
static const qn_rat *moved(qn_ctx *ctx, qn_mark mark, qn_int num, qn_int den) {
  enum { SHORT = 96 };
  mp_limb_t buffer[SHORT];
  size_t nn = (size_t)qn_limbs_(num), dn = (size_t)den.n;
  if (nn + dn > SHORT) {
    return stored(ctx, num, den);
  }
  mpn_copyi(buffer, num.d, (mp_size_t)nn);
  mpn_copyi(buffer + nn, den.d, (mp_size_t)dn);
  qn_arena_release(&ctx->arena, mark);
  return stored(ctx, (qn_int){num.n, buffer}, (qn_int){den.n, buffer + nn});
}

qn_num qn_num_settle_(qn_ctx *ctx, qn_mark mark, qn_int num, qn_int den, int rounded) {
  qn_num small = QN_NUM_ZERO;
  if (rounded && num.n != 0) {
    qn_num_round_rat_(ctx, &num, &den);
  }
  if (num.n == 0 || (!rounded && demoted(ctx, num, den, &small)) || ctx->failed != QUOIN_OK) {
    qn_arena_release(&ctx->arena, mark);
    return ctx->failed == QUOIN_OK ? small : QN_NUM_ZERO;
  }
  const qn_rat *rat = moved(ctx, mark, num, den);
  return rat ? (qn_num){{.big = rat}, 0, 0, rounded ? QN_NUM_ROUNDED : QN_NUM_BIG} : QN_NUM_ZERO;
}

qn_num qn_num_keep_(qn_ctx *ctx, qn_mark mark, qn_num a) {
  if (ctx->failed != QUOIN_OK || a.kind == QN_NUM_SMALL) {
    qn_arena_release(&ctx->arena, mark);
    return ctx->failed == QUOIN_OK ? a : QN_NUM_ZERO;
  }
  a.u.big = moved(ctx, mark, a.u.big->num, a.u.big->den);
  return a.u.big ? a : QN_NUM_ZERO;
}

qn_num qn_num_from_int(qn_ctx *ctx, int64_t v) {
  (void)ctx;
  qn_num r = QN_NUM_ZERO;
  qn_num_small_(qn_magnitude_(v), v < 0, 0, 0, &r); /* always small */
  return r;
}

qn_num qn_num_from_double(qn_ctx *ctx, double v) {
  (void)ctx;
  int e;
  qn_num r = QN_NUM_ZERO;
  double m = frexp(fabs(v), &e);
  qn_num_small_((uint64_t)ldexp(m, 53), v < 0, (int64_t)e - 53, 0, &r); /* always small: m < 2^53, |e| < 1100 */
  return r;
}

qn_num qn_num_from_rat(qn_ctx *ctx, qn_int num, qn_int den, int rounded) {
  qn_mark mark = qn_arena_mark(&ctx->arena);
  if (den.n < 0) {
    num = qn_int_neg(num);
    den = qn_int_neg(den);
  }
  if (!rounded) {
    qn_int g = qn_int_gcd(ctx, num, den);
    if (g.n != 1 || g.d[0] != 1) {
      num = qn_int_divexact(ctx, num, g);
      den = qn_int_divexact(ctx, den, g);
    }
  }
  return qn_num_settle_(ctx, mark, num, den, rounded);
}

qn_num qn_num_copy(qn_ctx *to, qn_num a) {
  if (a.kind == QN_NUM_SMALL) {
    return a;
  }
  a.u.big = stored(to, a.u.big->num, a.u.big->den);
  return a.u.big ? a : QN_NUM_ZERO;
}

int qn_num_sign(qn_num a) {
  return a.kind == QN_NUM_SMALL ? (a.u.m > 0) - (a.u.m < 0) : qn_int_sign(a.u.big->num);
}

int qn_num_equal(qn_num a, qn_num b) {
  if (a.kind != b.kind) {
    return 0;
  }
  if (a.kind == QN_NUM_SMALL) {
    return a.u.m == b.u.m && a.a == b.a && a.b == b.b;
  }
  return a.u.big == b.u.big || (qn_int_equal(a.u.big->num, b.u.big->num) && qn_int_equal(a.u.big->den, b.u.big->den));
}

/* v 2^twos 5^fives, exponents >= 0. */
static qn_int with_powers(qn_ctx *ctx, qn_int v, int64_t twos, int64_t fives) {
  if (fives > 0) {
    qn_int p = fives <= QN_FIVES_ ? (qn_int){1, (const mp_limb_t *)&qn_five_to_[fives]}
                                  : qn_int_pow(ctx, (qn_int){1, (const mp_limb_t *)&qn_five_to_[1]}, (unsigned)fives);
    v = v.n == 1 && v.d[0] == 1 ? p : qn_int_mul(ctx, v, p);
  }
  return twos > 0 ? qn_int_shl(ctx, v, (size_t)twos) : v;
}

qn_rat qn_num_rat(qn_ctx *ctx, qn_num a) {
  if (a.kind != QN_NUM_SMALL) {
    return *a.u.big;
  }
  return (qn_rat){with_powers(ctx, qn_int_from(ctx, a.u.m), a.a, a.b), with_powers(ctx, QN_INT_ONE_, -(int64_t)a.a, -(int64_t)a.b)};
}

int qn_num_agree_(qn_ctx *ctx, qn_int difference, qn_int larger) {
  size_t d = qn_int_bits(difference) + QN_S2_BITS, l = qn_int_bits(larger);
  if (d != l) {
    return d < l;
  }
  return qn_int_cmp(qn_int_abs(qn_int_shl(ctx, difference, QN_S2_BITS)), qn_int_abs(larger)) < 0;
}

int qn_num_cmp(qn_ctx *ctx, qn_num a, qn_num b) {
  int sa = qn_num_sign(a), sb = qn_num_sign(b);
  if (sa != sb || sa == 0) {
    return (sa > sb) - (sa < sb);
  }
  if (a.kind == QN_NUM_SMALL && b.kind == QN_NUM_SMALL) {
    if (a.a == b.a && a.b == b.b) {
      return (a.u.m > b.u.m) - (a.u.m < b.u.m);
    }
    int twos = a.a < b.a ? a.a : b.a, fives = a.b < b.b ? a.b : b.b;
    qn_u128 x, y;
    if (qn_num_scaled_(a.u.m, a.a - twos, a.b - fives, &x) && qn_num_scaled_(b.u.m, b.a - twos, b.b - fives, &y)) {
      return x == y ? 0 : (x > y) == (sa > 0) ? 1 : -1;
    }
  }
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_rat x = qn_num_rat(ctx, a), y = qn_num_rat(ctx, b);
  qn_int p = qn_int_mul(ctx, x.num, y.den), q = qn_int_mul(ctx, y.num, x.den);
  int order = qn_int_cmp(p, q);
  if (order != 0 && (qn_num_is_rounded(a) || qn_num_is_rounded(b))) {
    qn_int larger = (order > 0) == (sa > 0) ? p : q;
    order = qn_num_agree_(ctx, qn_int_sub(ctx, p, q), larger) ? 0 : order;
  }
  qn_arena_release(&ctx->arena, mark);
  return ctx->failed == QUOIN_OK ? order : 0;
}
