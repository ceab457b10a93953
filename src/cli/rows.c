#include "cli/rows.h"
#include "cli/say.h"

#include <stdio.h>
#include <string.h>

/* What a byte of a line is. */
enum { PART, BLANK, COMMENT, NUL };
static const unsigned char KIND[256] = {['\0'] = NUL, [' '] = BLANK, ['\t'] = BLANK, [','] = BLANK, ['\r'] = BLANK, ['\v'] = BLANK, ['\f'] = BLANK, ['#'] = COMMENT};
static unsigned kind_of(const char *at) { return KIND[(unsigned char)*at]; }

/* Eight bytes, the first one lowest: one load where that is how memory is read. */
static uint64_t eight(const char *at) {
  uint64_t v = 0;
  for (int i = 0; i < 8; i++) {
    v |= (uint64_t)(unsigned char)at[i] << (8 * i);
  }
  return v;
}

/* The first byte from `at` on, before `end`, that is no part of a number; or end. All such bytes lie below '-', and so do few others; the lowest bit of `less` is that of the
   first byte below it. */
static char *part_end(char *at, const char *end) {
  const uint64_t each = UINT64_C(0x0101010101010101);
  while (end - at >= 8) {
    const uint64_t v = eight(at), less = (v - each * '-') & ~v & each * 128;
    if (less == 0) {
      at += 8;
      continue;
    }
    at += ((less & (~less + 1)) >> 7) * UINT64_C(0x0001020304050607) >> 56;
    if (kind_of(at) != PART) {
      return at;
    }
    at++;
  }
  while (at < end && kind_of(at) == PART) {
    at++;
  }
  return at;
}

void cli_row_cut(cli_row *row, const char **numbers, char *line, char *end) {
  row->line = line;
  row->numbers = numbers;
  row->end = end;
  row->count = 0;
  row->junk = row->empty = NULL;
  char *at = line;
  int commas = 1; /* since a number; one stands before the first */
  while (row->count <= CLI_MAX_NUMBERS) {
    const char *second = NULL;
    for (; at < end && kind_of(at) == BLANK; at++) {
      if (*at == ',' && commas++) {
        second = second ? second : at;
      }
    }
    if (at == end || kind_of(at) == COMMENT) {
      return;
    }
    row->empty = row->empty ? row->empty : second;
    char *start = at;
    for (;; at++) {
      at = part_end(at, end);
      if (at == end || kind_of(at) != NUL) {
        break;
      }
      row->junk = row->junk ? row->junk : at;
    }
    int comment = at < end && kind_of(at) == COMMENT;
    unsigned i = row->count++;
    row->numbers[i] = start;
    row->cut[i] = (uint32_t)(at - line);
    row->under[i] = *at;
    commas = at < end && *at == ',';
    *at = '\0';
    if (at == end || comment) {
      return;
    }
    at++;
  }
}

void cli_row_mend(cli_row *row) {
  for (unsigned i = 0; i < row->count; i++) {
    row->line[row->cut[i]] = row->under[i];
  }
}

/* Marks the bytes [from, to) of the mended row. */
static void mark(cli_fault *fault, const cli_row *row, const char *from, const char *to, uint64_t line) {
  fault->line = line;
  fault->column = (size_t)(from - row->line) + 1;
  fault->length = to > from ? (size_t)(to - from) : 1;
  size_t length = (size_t)(row->end - row->line);
  length -= length > 0 && row->line[length - 1] == '\r';
  int shown = length < sizeof fault->source; /* the caret under a longer line would not be where one sees it */
  for (size_t i = 0; i < length && shown; i++) {
    shown = (unsigned char)row->line[i] >= 32 || row->line[i] == '\t'; /* nor are binary bytes worth a look */
  }
  length = shown ? length : 0;
  memcpy(fault->source, row->line, length);
  fault->source[length] = '\0';
}

int cli_row_fault(cli_row *row, const cli_row_kind *kind, uint64_t line, cli_fault *fault) {
  if (!row->junk && !row->empty && row->count == kind->numbers) {
    return 0;
  }
  fault->status = QUOIN_E_NUMBER;
  fault->reason = "";
  cli_row_mend(row);
  if (row->junk) {
    mark(fault, row, row->junk, row->junk + 1, line);
    snprintf(fault->problem, sizeof fault->problem, "a NUL byte among the numbers");
    fault->reason = "this is no text";
    fault->code = "Q1002";
  } else if (row->empty) {
    mark(fault, row, row->empty, row->empty + 1, line);
    snprintf(fault->problem, sizeof fault->problem, "no number before this comma");
    fault->reason = "a field is empty";
    fault->code = "Q1001";
  } else {
    int more = row->count > kind->numbers;
    unsigned i = more ? kind->numbers : row->count - 1; /* the first too many, or the last there is; an empty row is no row */
    mark(fault, row, row->numbers[i], row->line + row->cut[i], line);
    snprintf(fault->problem, sizeof fault->problem, "a %s is %u numbers: %s", kind->what, kind->numbers, kind->shape);
    fault->reason = more ? "here are more" : "here are fewer";
    fault->code = "Q1003";
  }
  return 1;
}

unsigned cli_first_bad_number(const quoin_scene *scene, quoin_work *work, const char *const *numbers, unsigned n) {
  for (unsigned i = 0; i < n; i++) { /* the library alone decides what a number is; far away a point is cheap */
    const char *const probe[3] = {numbers[i], "7e999", "-3e1000"};
    quoin_side side;
    quoin_status status = quoin_point_side_text(scene, work, probe, &side);
    if (status == QUOIN_E_NUMBER || status == QUOIN_E_LIMIT) {
      return i;
    }
  }
  return n;
}

int cli_is_zero(const char *number) {
  for (; *number && *number != 'e' && *number != 'E'; number++) {
    if (*number >= '1' && *number <= '9') {
      return 0;
    }
  }
  return 1;
}

void cli_row_refused(cli_row *row, const quoin_scene *scene, quoin_work *work, quoin_status status, uint64_t line, cli_fault *fault) {
  int by_number = status == QUOIN_E_NUMBER || status == QUOIN_E_LIMIT;
  unsigned bad = by_number ? cli_first_bad_number(scene, work, row->numbers, row->count) : row->count;
  int no_direction = status == QUOIN_E_ARGUMENT && row->count == 6 && cli_is_zero(row->numbers[3]) && cli_is_zero(row->numbers[4]) &&
                     cli_is_zero(row->numbers[5]);
  fault->status = status;
  fault->reason = "";
  fault->code = "Q1004";
  if (bad < row->count) {
    cli_quoted q;
    snprintf(fault->problem, sizeof fault->problem, "%s is not a number", cli_quote(&q, row->numbers[bad]));
    fault->reason = CLI_NUMBER_RULE(status);
    fault->code = "Q1001";
    fault->status = QUOIN_E_NUMBER;
  } else if (no_direction) {
    snprintf(fault->problem, sizeof fault->problem, "the ray's direction is zero");
  } else {
    snprintf(fault->problem, sizeof fault->problem, "no answer: %s", quoin_status_text(status));
  }
  cli_row_mend(row);
  unsigned first = bad < row->count ? bad : no_direction ? 3 : 0;
  mark(fault, row, row->numbers[first], row->line + row->cut[bad < row->count ? bad : row->count - 1], line);
}

void cli_say_fault(const cli_fault *fault, const char *file) {
  quoin_diag diag = {
    .severity = QUOIN_ERROR,
    .code = fault->code,
    .file = file,
    .line = fault->line > UINT32_MAX ? UINT32_MAX : (uint32_t)fault->line,
    .column = fault->column > UINT32_MAX ? UINT32_MAX : (uint32_t)fault->column,
    .length = fault->length > UINT32_MAX ? UINT32_MAX : (uint32_t)fault->length,
    .problem = fault->problem,
    .reason = fault->reason,
    .way_out = "",
    .source = fault->source,
  };
  cli_say_diag(&diag);
}
