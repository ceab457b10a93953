#include "text/report.h"

#include <stdarg.h>
#include <stdio.h>

void qn_reporter_init(qn_reporter *reporter, qn_diags *diags, const qn_source *source, size_t max_errors) {
  *reporter = (qn_reporter){.diags = diags, .source = source, .max_errors = max_errors ? max_errors : 1};
}

void qn_tell(qn_reporter *r, qn_code code, size_t offset, size_t length, const char *reason, const char *way_out,
             const char *problem, ...) {
  if (r->stop) {
    return;
  }
  const qn_code_row *row = &qn_codes[code];
  if (row->severity == QUOIN_ERROR) {
    r->errors++;
    r->limit |= code >= QN_Q0901;
  } else if (r->told[code] >= QN_REPEATS) {
    r->told[code]++;
    return;
  }
  r->told[code]++;
  char text[900];
  va_list args;
  va_start(args, problem);
  vsnprintf(text, sizeof text, problem, args);
  va_end(args);
  qn_report report = {.severity = row->severity, .code = row->text, .reason = reason, .way_out = way_out};
  report.loc = qn_source_loc(r->source, offset, &r->hint);
  report.length = (uint32_t)(length ? length : 1);
  report.source = qn_source_line(r->source, report.loc.line, report.loc.column, &report.source_length);
  qn_diags_add(r->diags, &report, "%s", text);
  if (row->severity == QUOIN_ERROR && r->errors >= r->max_errors) {
    qn_report last = {.severity = qn_codes[QN_Q0908].severity, .code = qn_codes[QN_Q0908].text, .loc = report.loc};
    qn_diags_add(r->diags, &last, "stopped after %zu error%s", r->errors, r->errors == 1 ? "" : "s");
    r->stop = 1;
  }
}

void qn_reporter_end(qn_reporter *r) {
  for (int code = 0; code < QN_CODE_COUNT; code++) {
    if (qn_codes[code].severity != QUOIN_ERROR && r->told[code] > QN_REPEATS) {
      qn_report rest = {.severity = qn_codes[QN_Q0909].severity, .code = qn_codes[QN_Q0909].text};
      size_t more = r->told[code] - QN_REPEATS;
      qn_diags_add(r->diags, &rest, "%zu more of %s are not shown (%s)", more, qn_codes[code].text, qn_codes[code].meaning);
    }
  }
  qn_diags_sort(r->diags);
}
