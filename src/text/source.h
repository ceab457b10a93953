/* A text and where its lines start: offsets in bytes become file:line:col. */
#ifndef QN_TEXT_SOURCE_H
#define QN_TEXT_SOURCE_H

#include "base/diag.h"

typedef struct qn_source {
  qn_mem *mem;
  const char *text; /* without a byte order mark; not owned */
  size_t length;    /* bytes, at most QN_MAX_TEXT */
  unsigned file;    /* number in the diagnostics */
  uint32_t *lines;  /* offset of each line's first byte */
  size_t line_count, line_capacity;
} qn_source;

/* Finds the lines. 0 when memory is refused. The text must outlive the source. */
QN_NODISCARD int qn_source_init(qn_source *source, qn_mem *mem, unsigned file, const char *text, size_t length);
void qn_source_free(qn_source *source);

/* The place of an offset. *hint (start with 0) remembers the line of the last question: questions in the order of the
   text cost O(1), others a binary search. */
qn_loc qn_source_loc(const qn_source *source, size_t offset, size_t *hint);

/* The text of a line (from 1), without its end. Empty when the line is longer than a screen could show and `column`
   lies past what would be kept; a long line is cut otherwise. */
const char *qn_source_line(const qn_source *source, size_t line, size_t column, size_t *length);

#endif
