/* Numbers as text that reads back to the same number.

   A decimal of at most DECIMAL_DIGITS digits is written as one, plainly or with an exponent; a longer dyadic number as
   (M/2^K), which is how doubles of a program come out; any other number as a fraction (p/q) or, where exponents are
   out of the range of literals, as a product of powers. */
#include "base/limits.h"
#include "number/num_parts.h"

#include <stdio.h>
#include <string.h>

enum {
  DECIMAL_DIGITS = 40, /* of a number written as a decimal rather than a fraction: a choice of looks, not of value */
  PIECE = 4000,        /* digits of one literal within a longer integer: QN_MAX_EXPONENT allows so many */
};
_Static_assert(PIECE <= QN_MAX_EXPONENT && PIECE <= QN_MAX_DIGITS, "the pieces of a long integer can be read");

/* Text that grows at the end of the arena: pieces are joined once, when all are known. */
typedef struct line {
  qn_ctx *ctx;
  const char *piece[24];
  size_t size[24], count;
} line;

static void put(line *l, const char *text, size_t size) {
  l->piece[l->count] = text;
  l->size[l->count++] = text ? size : 0;
}
static void put_text(line *l, const char *text) {
  put(l, text, text ? strlen(text) : 0);
}
static void put_count(line *l, int64_t v) {
  char number[24];
  int n = snprintf(number, sizeof number, "%lld", (long long)v);
  put(l, qn_arena_text(&l->ctx->arena, number, (size_t)n), (size_t)n);
}

static char *joined(line *l) {
  size_t total = 1;
  for (size_t i = 0; i < l->count; i++) {
    total += l->size[i];
    if (!l->piece[i]) {
      qn_ctx_fail_(l->ctx, QUOIN_E_MEMORY);
    }
  }
  char *text = l->ctx->failed == QUOIN_OK ? qn_arena_take(&l->ctx->arena, total) : NULL;
  if (!text) {
    qn_ctx_fail_(l->ctx, QUOIN_E_MEMORY);
    return NULL;
  }
  char *at = text;
  for (size_t i = 0; i < l->count; i++) {
    /* NOLINTNEXTLINE(clang-analyzer-core.NonNullParamChecker): with a piece that is null the context has failed */
    memcpy(at, l->piece[i], l->size[i]);
    at += l->size[i];
  }
  *at = '\0';
  return text;
}

/* [-]digits 10^e. The exponent of the first digit is x: plain for -7 < x < 21, as is usual. */
static char *decimal(qn_ctx *ctx, int negative, const char *digits, int64_t e) {
  static const char zeros[] = "00000000000000000000";
  line l = {.ctx = ctx};
  int64_t n = (int64_t)strlen(digits), x = n - 1 + e;
  put_text(&l, negative ? "-" : "");
  if (x >= 21 || x <= -7) {
    put(&l, digits, 1);
    put(&l, ".", n > 1);
    put(&l, digits + 1, (size_t)n - 1);
    put_text(&l, x < 0 ? "e-" : "e+");
    put_text(&l, x < 10 && x > -10 ? "0" : "");
    put_count(&l, x < 0 ? -x : x);
  } else if (e >= 0) {
    put(&l, digits, (size_t)n);
    put(&l, zeros, (size_t)e);
  } else if (x >= 0) {
    put(&l, digits, (size_t)(x + 1));
    put_text(&l, ".");
    put(&l, digits + x + 1, (size_t)(n - x - 1));
  } else {
    put_text(&l, "0.");
    put(&l, zeros, (size_t)(-x - 1));
    put(&l, digits, (size_t)n);
  }
  return joined(&l);
}

/* v 10^e as a decimal, if it is short enough and a literal may have its exponent; null otherwise. v != 0. */
static char *as_decimal(qn_ctx *ctx, qn_int v, int64_t e) {
  if (qn_int_bits(v) > 4 * PIECE) {
    return NULL;
  }
  char *digits = qn_int_text(ctx, qn_int_abs(v));
  size_t n = digits ? strlen(digits) : 0;
  while (n > 1 && digits[n - 1] == '0') {
    digits[--n] = '\0';
    e++;
  }
  int64_t x = (int64_t)n - 1 + e;
  return n == 0 || n > DECIMAL_DIGITS || x > QN_MAX_EXPONENT || x < -QN_MAX_EXPONENT ? NULL : decimal(ctx, v.n < 0, digits, e);
}

/* An integer as an expression: a literal, or pieces put together by ((p 1e4000 + p) 1e4000 + p). */
static char *integer(qn_ctx *ctx, qn_int v) {
  char *digits = qn_int_text(ctx, v);
  if (!digits || strlen(digits) <= PIECE) {
    return digits;
  }
  int negative = digits[0] == '-';
  digits += negative;
  size_t n = strlen(digits), pieces = (n + PIECE - 1) / PIECE, first = n - (pieces - 1) * PIECE;
  char *text = qn_arena_take(&ctx->arena, n + pieces * 16 + 4);
  if (!text) {
    qn_ctx_fail_(ctx, QUOIN_E_MEMORY);
    return NULL;
  }
  char *at = text;
  at += sprintf(at, "%s", negative ? "-" : "");
  memset(at, '(', pieces - 1);
  at += pieces - 1;
  memcpy(at, digits, first);
  at += first;
  for (digits += first; *digits; digits += PIECE) {
    at += sprintf(at, "*1e%d+", (int)PIECE);
    memcpy(at, digits, PIECE);
    at += PIECE;
    *at++ = ')';
  }
  *at = '\0';
  return text;
}

/* (v * 2^a * 5^b), a negative power as a division. */
static char *powers(qn_ctx *ctx, qn_int v, int64_t a, int64_t b) {
  line l = {.ctx = ctx};
  put_text(&l, "(");
  put_text(&l, integer(ctx, v));
  if (a != 0) {
    put_text(&l, a < 0 ? "/2^" : "*2^");
    put_count(&l, a < 0 ? -a : a);
  }
  if (b != 0) {
    put_text(&l, b < 0 ? "/5^" : "*5^");
    put_count(&l, b < 0 ? -b : b);
  }
  put_text(&l, ")");
  return joined(&l);
}

/* v 2^a 5^b, v != 0. */
static char *product(qn_ctx *ctx, qn_int v, int64_t a, int64_t b) {
  int64_t e = a < b ? a : b, twos = a - e, fives = b - e;
  if (twos <= 4 * DECIMAL_DIGITS && fives <= 2 * DECIMAL_DIGITS) { /* more make too many digits */
    qn_int power = fives ? qn_int_pow(ctx, qn_int_from(ctx, 5), (unsigned)fives) : QN_INT_ONE_;
    char *text = as_decimal(ctx, qn_int_shl(ctx, qn_int_mul(ctx, v, power), (size_t)twos), e);
    if (text) {
      return text;
    }
  }
  return powers(ctx, v, a, b);
}

static char *fraction(qn_ctx *ctx, const qn_rat *r) {
  size_t twos = qn_int_trailing_zeros(r->den);
  int64_t fives = 0;
  qn_int odd = qn_int_shr(ctx, r->den, twos);
  if (odd.n > 0) {
    odd = qn_int_strip_fives_(ctx, odd, &fives);
  }
  if (odd.n == 1 && odd.d[0] == 1) {
    char *text = product(ctx, r->num, -(int64_t)twos, -fives);
    if (twos != 0 || fives != 0 || !text || text[0] != '(') {
      return text;
    }
    return integer(ctx, r->num);
  }
  line l = {.ctx = ctx};
  put_text(&l, "(");
  put_text(&l, integer(ctx, r->num));
  put_text(&l, "/");
  put_text(&l, integer(ctx, r->den));
  put_text(&l, ")");
  return joined(&l);
}

static char *rounded(qn_ctx *ctx, const qn_rat *r) {
  line l = {.ctx = ctx};
  size_t up = qn_int_trailing_zeros(r->num), down = qn_int_trailing_zeros(r->den);
  put_text(&l, "rounded(");
  put_text(&l, qn_int_text(ctx, qn_int_shr(ctx, r->num, up)));
  put_text(&l, down ? "/2^" : "*2^");
  put_count(&l, (int64_t)(down ? down : up));
  put_text(&l, ")");
  return joined(&l);
}

char *qn_num_text(qn_ctx *ctx, qn_num a) {
  if (qn_num_is_zero(a)) {
    char *zero = qn_arena_text(&ctx->arena, "0", 1);
    if (!zero) {
      qn_ctx_fail_(ctx, QUOIN_E_MEMORY);
    }
    return zero;
  }
  if (a.kind == QN_NUM_ROUNDED) {
    return rounded(ctx, a.u.big);
  }
  char *text = a.kind == QN_NUM_BIG ? fraction(ctx, a.u.big) : product(ctx, qn_int_from(ctx, a.u.m), a.a, a.b);
  return ctx->failed == QUOIN_OK ? text : NULL;
}
