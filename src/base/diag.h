/* Diagnostics: collected as data while a model is read and compiled; shown by whoever asked. */
#ifndef QN_BASE_DIAG_H
#define QN_BASE_DIAG_H

#include "base/mem.h"

/* A place: a file of the list's (1 is the first; 0: no place), a line and a column, both from 1, in bytes. */
typedef struct qn_loc {
  uint32_t line;
  uint32_t column : 20; /* columns past 2^20 - 1 are given as that */
  uint32_t file : 12;
} qn_loc;
#define QN_NO_LOC ((qn_loc){0, 0, 0})

typedef struct qn_diags {
  qn_arena arena;
  quoin_diag *items;
  size_t count, capacity;
  const char **files; /* names, by number - 1 */
  size_t file_count, file_capacity;
  size_t errors;
  int lost; /* a diagnostic could not be kept for want of memory */
} qn_diags;

void qn_diags_init(qn_diags *diags, qn_mem *mem);
void qn_diags_free(qn_diags *diags);

/* Adds a file name and gives its number, 0 when memory is refused. A name that is there already gives a new number, until there are
   QN_MAX_FILES - 1 of them: then known names keep theirs, and new ones share the last number, "(another text)". */
unsigned qn_diags_file(qn_diags *diags, const char *name);

/* One diagnostic. `code` is a literal. `source` is the source line (source_length bytes, copied) or null. The texts
   are copied; null means absent. Never fails visibly: want of memory sets diags->lost. */
typedef struct qn_report {
  quoin_severity severity;
  const char *code;
  qn_loc loc;
  uint32_t length;
  const char *source;
  size_t source_length;
  const char *reason, *way_out;
} qn_report;
void qn_diags_add(qn_diags *diags, const qn_report *report, const char *problem_format, ...) QN_PRINTF(3, 4);

/* Sorts by file and place, keeping the order of equals; those without a place come last. */
void qn_diags_sort(qn_diags *diags);

#endif
