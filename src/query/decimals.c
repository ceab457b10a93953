#include "query/decimals.h"

#include "number/dd.h"

#include <math.h>

static const double TENS[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                              1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22}; /* all of them exact */

/* The digits of a decimal that qn_decimal_quick has read: up to 19 that count. Its size is *digits / 10^(what is returned), or -1 when that power is not
   in TENS. */
static int digits_of(const char *at, uint64_t *digits) {
  int places = 0, point = 0, exponent = 0;
  uint64_t m = 0;
  at += *at == '-' || *at == '+';
  for (; *at && *at != 'e' && *at != 'E'; at++) {
    if (*at == '.') {
      point = 1;
    } else {
      m = m * 10 + (uint64_t)(*at - '0');
      places += point;
    }
  }
  if (*at) {
    int negative = *++at == '-';
    for (at += *at == '-' || *at == '+'; *at && exponent < 1000; at++) {
      exponent = exponent * 10 + (*at - '0');
    }
    exponent = negative ? -exponent : exponent;
  }
  *digits = m;
  places -= exponent;
  return places >= 0 && places < (int)(sizeof TENS / sizeof *TENS) ? places : -1;
}

int qn_decimal_pair(const char *text, double *high, double *low) {
  int exact;
  size_t read = text ? qn_decimal_quick(text, high, &exact) : 0;
  if (read == 0 || text[read] != '\0') {
    return 0;
  }
  *low = 0;
  if (exact) {
    return 1;
  }
  uint64_t digits;
  int places = digits_of(text, &digits);
  if (places < 0) {
    return 0;
  }
  double n = (double)digits, rest = (double)(int64_t)(digits - (uint64_t)n);
  qn_dd p = qn_dd_two_prod(fabs(*high), TENS[places]);
  double size = (((n - p.hi) - p.lo) + rest) / TENS[places];
  *low = *high < 0 ? -size : size;
  return 1;
}

quoin_status qn_decimal_line(quoin_work *work, const char *const text[6], qn_line *line) {
  qn_num v[6];
  for (int i = 0; i < 6; i++) {
    quoin_status status = qn_query_number(work, text[i], &v[i]);
    if (status != QUOIN_OK) {
      return status;
    }
  }
  qn_ctx *ctx = qn_scratch_ctx(work->scratch);
  qn_line_from_numbers(ctx, v, v + 3, line);
  return ctx->failed;
}
