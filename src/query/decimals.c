#include "query/decimals.h"

int qn_decimal_pair(const char *text, double *high, double *low) {
  const size_t read = text ? qn_decimal_quick_pair(text, high, low) : 0;
  return read != 0 && text[read] == '\0';
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
