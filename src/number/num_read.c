/* Reading decimals. A literal of up to 19 digits that count is a small number made without memory; a longer one goes
   through integers. */
#include "base/limits.h"
#include "number/num_parts.h"

#include <string.h>

static int is_digit(char c) {
  return c >= '0' && c <= '9';
}

/* The exponent after a mantissa, its length in *length; 0 bytes where there is none ("2e" is the number 2 and a letter). */
static int64_t read_exponent(const char *text, size_t length, size_t *read) {
  size_t p = 1;
  int negative = 0;
  int64_t e = 0;
  *read = 0;
  if (length < 2 || (text[0] != 'e' && text[0] != 'E')) {
    return 0;
  }
  if (text[p] == '+' || text[p] == '-') {
    negative = text[p++] == '-';
  }
  if (p >= length || !is_digit(text[p])) {
    return 0;
  }
  for (; p < length && is_digit(text[p]); p++) {
    e = e < INT32_MAX ? e * 10 + (text[p] - '0') : e; /* beyond every limit already */
  }
  *read = p;
  return negative ? -e : e;
}

/* D 10^e for the digits of text, a point among them skipped. */
static QN_NOINLINE qn_num long_number(qn_ctx *ctx, const char *text, size_t length, int negative, int64_t e) {
  qn_mark mark = qn_arena_mark(&ctx->arena);
  char *digits = qn_arena_take(&ctx->arena, length);
  size_t count = 0;
  if (!digits) {
    qn_ctx_fail_(ctx, QUOIN_E_MEMORY);
    return QN_NUM_ZERO;
  }
  for (size_t i = 0; i < length; i++) {
    digits[count] = text[i];
    count += text[i] != '.';
  }
  qn_int num = qn_int_from_digits(ctx, digits, count), den = QN_INT_ONE_;
  num = negative ? qn_int_neg(num) : num;
  mp_limb_t ten = 10;
  qn_int power = qn_int_pow(ctx, (qn_int){1, &ten}, (unsigned)(e < 0 ? -e : e));
  if (e < 0) {
    qn_int g = qn_int_gcd(ctx, num, power);
    num = qn_int_divexact(ctx, num, g);
    den = qn_int_divexact(ctx, power, g);
  } else {
    num = qn_int_mul(ctx, num, power);
  }
  return qn_num_settle_(ctx, mark, num, den, 0);
}

size_t qn_num_read(qn_ctx *ctx, const char *text, size_t length, qn_num *out, quoin_status *status) {
  size_t p = 0, count = 0, any = 0, from; /* count: digits from the first that is not 0 */
  int64_t scale = 0;
  uint64_t m = 0;
  int negative = 0;
  *out = QN_NUM_ZERO;
  *status = QUOIN_OK;
  if (p < length && (text[p] == '+' || text[p] == '-')) {
    negative = text[p++] == '-';
  }
  from = p;
  for (; p < length && is_digit(text[p]); p++) {
    m = m * 10 + (uint64_t)(text[p] - '0'); /* wraps past 19 digits, and is then not used */
    count += count > 0 || text[p] != '0';
    any = 1;
  }
  if (p < length && text[p] == '.' && (any || (p + 1 < length && is_digit(text[p + 1])))) {
    size_t point = ++p;
    for (; p < length && is_digit(text[p]); p++) {
      m = m * 10 + (uint64_t)(text[p] - '0');
      count += count > 0 || text[p] != '0';
      any = 1;
    }
    scale = -(int64_t)(p - point);
  }
  if (!any) {
    return 0;
  }
  size_t mantissa = p, read = 0;
  if (p < length && (text[p] == 'e' || text[p] == 'E')) {
    scale += read_exponent(text + p, length - p, &read);
    p += read;
  }
  if (count == 0) {
    return p;
  }
  int64_t magnitude = (int64_t)count - 1 + scale;
  if (count > QN_MAX_DIGITS || magnitude > QN_MAX_EXPONENT || magnitude < -QN_MAX_EXPONENT) {
    *status = QUOIN_E_LIMIT;
    return p;
  }
  if (count > 19 || !qn_num_small_(m, negative, scale, scale, out)) {
    *out = long_number(ctx, text + from, mantissa - from, negative, scale);
    *status = ctx->failed;
  }
  return p;
}
