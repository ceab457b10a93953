#include "text/codes.h"

const qn_code_row qn_codes[QN_CODE_COUNT] = {
#define X(code, severity, meaning) {#code, severity, meaning},
  QN_CODES(X)
#undef X
};
