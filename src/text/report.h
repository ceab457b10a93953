/* How the reader speaks: diagnostics at offsets of one source, with a limit on errors and on repetition. */
#ifndef QN_TEXT_REPORT_H
#define QN_TEXT_REPORT_H

#include "text/codes.h"
#include "text/source.h"

/* Diagnostics of one code that are kept; the others are counted and told in one line at the end. */
#define QN_REPEATS 20

typedef struct qn_reporter {
  qn_diags *diags;
  const qn_source *source;
  size_t max_errors;
  size_t errors;  /* of this source */
  size_t hint;    /* of qn_source_loc */
  int stop;       /* max_errors was met: say and read no more */
  int limit;      /* one of the errors was a limit (Q09xx) */
  size_t told[QN_CODE_COUNT];
} qn_reporter;

void qn_reporter_init(qn_reporter *reporter, qn_diags *diags, const qn_source *source, size_t max_errors);

/* The way out where OpenSCAD itself resolves what is missing here. */
#define QN_FLATTEN "flatten the file first: openscad -o model.csg model.scad (it drops words that are not its own)"

/* Says one thing about `length` bytes at `offset`. reason and way_out may be null. */
void qn_tell(qn_reporter *reporter, qn_code code, size_t offset, size_t length, const char *reason, const char *way_out,
             const char *problem, ...) QN_PRINTF(7, 8);

/* At the end: tells how many diagnostics of each kind were not kept, and sorts. */
void qn_reporter_end(qn_reporter *reporter);

#endif
