/* Integers: division, greatest common divisor, square root, powers, and decimal digits. */
#include "number/int_limbs.h"

#include <string.h>

/* The magnitude divided, by schoolbook to subquadratic division of mpn. b != 0 except after a failure. */
void qn_int_divmod(qn_ctx *ctx, qn_int a, qn_int b, qn_int *quotient, qn_int *remainder) {
  mp_size_t an = qn_limbs_(a), bn = qn_limbs_(b);
  if (bn == 0 || an < bn) { /* bn = 0: only after a failure, when numbers are zero */
    *quotient = QN_INT_ZERO_;
    *remainder = a;
    return;
  }
  mp_limb_t *q = qn_limbs_take_(ctx, (size_t)(an - bn) + 1);
  mp_limb_t *r = qn_limbs_take_(ctx, (size_t)bn);
  if (!q || !r) {
    *quotient = *remainder = QN_INT_ZERO_;
    return;
  }
  if (bn == 1) {
    r[0] = mpn_divrem_1(q, 0, a.d, an, b.d[0]);
  } else {
    mpn_tdiv_qr(q, r, 0, a.d, an, b.d, bn);
  }
  *quotient = qn_limbs_int_(ctx, q, an - bn + 1, (a.n < 0) != (b.n < 0));
  *remainder = qn_limbs_int_(ctx, r, bn, a.n < 0);
}

qn_int qn_int_divexact(qn_ctx *ctx, qn_int a, qn_int b) {
  mp_size_t an = qn_limbs_(a), bn = qn_limbs_(b);
  if (bn == 0 || an < bn) {
    return QN_INT_ZERO_;
  }
  int negative = (a.n < 0) != (b.n < 0);
  if (bn == 1 && b.d[0] == 1) {
    return (qn_int){negative ? -an : an, a.d};
  }
  if (bn == 1) {
    mp_limb_t *q = qn_limbs_take_(ctx, (size_t)an);
    if (!q) {
      return QN_INT_ZERO_;
    }
    mpn_divexact_1(q, a.d, an, b.d[0]);
    return qn_limbs_int_(ctx, q, an, negative);
  }
  mp_limb_t *q = qn_limbs_take_(ctx, (size_t)(an - bn) + 1);
  qn_mark mark = qn_arena_mark(&ctx->arena);
  mp_limb_t *r = qn_limbs_take_(ctx, (size_t)bn);
  if (!q || !r) {
    return QN_INT_ZERO_;
  }
  mpn_tdiv_qr(q, r, 0, a.d, an, b.d, bn);
  qn_arena_release(&ctx->arena, mark);
  return qn_limbs_int_(ctx, q, an - bn + 1, negative);
}

qn_int qn_int_gcd(qn_ctx *ctx, qn_int a, qn_int b) {
  a = qn_int_abs(a);
  b = qn_int_abs(b);
  if (a.n == 0) {
    return b;
  }
  if (b.n == 0) {
    return a;
  }
  if (a.n == 1 || b.n == 1) {
    mp_limb_t *d = qn_limbs_take_(ctx, 1);
    if (!d) {
      return QN_INT_ZERO_;
    }
    d[0] = a.n == 1 ? mpn_gcd_1(b.d, b.n, a.d[0]) : mpn_gcd_1(a.d, a.n, b.d[0]);
    return qn_limbs_int_(ctx, d, 1, 0);
  }
  /* mpn_gcd destroys its operands, wants the longer one first and one of them odd: both are taken odd here, and the
     common twos are put back. */
  size_t za = qn_int_trailing_zeros(a), zb = qn_int_trailing_zeros(b), twos = za < zb ? za : zb;
  mp_limb_t *d = qn_limbs_take_(ctx, (size_t)(a.n < b.n ? a.n : b.n) + 1);
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_int x = qn_int_copy(ctx, qn_int_shr(ctx, a, za)), y = qn_int_copy(ctx, qn_int_shr(ctx, b, zb));
  if (!d || x.n == 0 || y.n == 0) {
    return QN_INT_ZERO_;
  }
  if (qn_int_cmp(x, y) < 0) {
    qn_int t = x;
    x = y;
    y = t;
  }
  /* x and y are copies that nobody else sees: the one place where limbs are written after they were made. */
  /* NOLINTNEXTLINE(performance-no-int-to-ptr): takes const away */
  mp_size_t n = mpn_gcd(d, (mp_limb_t *)(uintptr_t)x.d, x.n, (mp_limb_t *)(uintptr_t)y.d, y.n);
  qn_arena_release(&ctx->arena, mark);
  return qn_int_shl(ctx, qn_limbs_int_(ctx, d, n, 0), twos);
}

qn_int qn_int_sqrt(qn_ctx *ctx, qn_int a, int *exact) {
  *exact = 1;
  if (a.n <= 0) {
    return QN_INT_ZERO_;
  }
  mp_size_t n = (a.n + 1) / 2;
  mp_limb_t *d = qn_limbs_take_(ctx, (size_t)n);
  if (!d) {
    return QN_INT_ZERO_;
  }
  *exact = mpn_sqrtrem(d, NULL, a.d, a.n) == 0;
  return qn_limbs_int_(ctx, d, n, 0);
}

qn_int qn_int_pow(qn_ctx *ctx, qn_int a, unsigned e) {
  size_t bits = qn_int_bits(a);
  if (bits > 1 && e > 0 && ctx->max_bits != 0 && (bits - 1) > (ctx->max_bits - 1) / e) {
    qn_ctx_fail_(ctx, QUOIN_E_LIMIT); /* |a|^e >= 2^((bits - 1) e), which has (bits - 1) e + 1 bits */
    return QN_INT_ZERO_;
  }
  qn_int r = qn_int_from(ctx, 1);
  for (unsigned bit = e ? 1u << (31 - (qn_leading_zeros(e) - 32)) : 0; bit; bit >>= 1) {
    r = qn_int_mul(ctx, r, r);
    if (e & bit) {
      r = qn_int_mul(ctx, r, a);
    }
  }
  return r;
}

char *qn_int_text(qn_ctx *ctx, qn_int a) {
  mp_size_t n = qn_limbs_(a);
  if (n == 0) {
    char *zero = qn_arena_text(&ctx->arena, "0", 1);
    if (!zero) {
      qn_ctx_fail_(ctx, QUOIN_E_MEMORY);
    }
    return zero;
  }
  size_t room = (size_t)n * 20 + 3; /* a limb has 19.27 digits; a sign, a NUL, and one that mpn_get_str wants */
  char *text = qn_arena_take(&ctx->arena, room);
  qn_mark mark = qn_arena_mark(&ctx->arena);
  mp_limb_t *d = qn_limbs_take_(ctx, (size_t)n + 1);
  if (!text || !d) {
    qn_ctx_fail_(ctx, QUOIN_E_MEMORY);
    return NULL;
  }
  mpn_copyi(d, a.d, n); /* mpn_get_str destroys its operand */
  unsigned char *digits = (unsigned char *)text + 1;
  size_t count = mpn_get_str(digits, 10, d, n), skip = 0;
  qn_arena_release(&ctx->arena, mark);
  while (skip + 1 < count && digits[skip] == 0) {
    skip++;
  }
  for (size_t i = 0; i < count; i++) {
    digits[i] = (unsigned char)(digits[i] + '0');
  }
  text[0] = '-';
  size_t sign = a.n < 0;
  memmove(text + sign, digits + skip, count - skip);
  text[sign + count - skip] = '\0';
  return text;
}

qn_int qn_int_from_digits(qn_ctx *ctx, const char *digits, size_t length) {
  while (length > 0 && *digits == '0') {
    digits++;
    length--;
  }
  if (length == 0) {
    return QN_INT_ZERO_;
  }
  if (length <= 19) {
    mp_limb_t v = 0;
    for (size_t i = 0; i < length; i++) {
      v = v * 10 + (mp_limb_t)(digits[i] - '0');
    }
    return qn_int_from_limbs(ctx, &v, 1, 0);
  }
  size_t limbs = length / 19 + 3; /* a limb holds 19.27 digits; and one that mpn_set_str wants */
  mp_limb_t *d = qn_limbs_take_(ctx, limbs);
  qn_mark mark = qn_arena_mark(&ctx->arena);
  unsigned char *values = qn_arena_take(&ctx->arena, length);
  if (!d || !values) {
    qn_ctx_fail_(ctx, QUOIN_E_MEMORY);
    return QN_INT_ZERO_;
  }
  for (size_t i = 0; i < length; i++) {
    values[i] = (unsigned char)(digits[i] - '0');
  }
  mp_size_t n = mpn_set_str(d, values, length, 10);
  qn_arena_release(&ctx->arena, mark);
  return qn_limbs_int_(ctx, d, n, 0);
}
