#include "text/source.h"

#include "base/limits.h"

#include <string.h>

enum { LONGEST_SHOWN = 1000 }; /* bytes of a source line that a diagnostic keeps: a file may be one line of 100 MB */

int qn_source_init(qn_source *source, qn_mem *mem, unsigned file, const char *text, size_t length) {
  if (length >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0) {
    text += 3;
    length -= 3;
  }
  *source = (qn_source){.mem = mem, .text = text, .length = length, .file = file};
  size_t at = 0;
  for (;;) {
    if (!qn_grow(mem, &source->lines, &source->line_capacity, source->line_count + 1)) {
      qn_source_free(source);
      return 0;
    }
    source->lines[source->line_count++] = (uint32_t)at;
    const char *end = at < length ? memchr(text + at, '\n', length - at) : NULL;
    if (!end) {
      return 1;
    }
    at = (size_t)(end - text) + 1;
  }
}

void qn_source_free(qn_source *source) {
  if (source->mem) {
    qn_free(source->mem, source->lines, source->line_capacity * sizeof *source->lines);
  }
  *source = (qn_source){0};
}

qn_loc qn_source_loc(const qn_source *source, size_t offset, size_t *hint) {
  size_t low = 0, high = source->line_count; /* the line lies in [low, high) */
  size_t guess = *hint;
  if (guess < high && source->lines[guess] <= offset) {
    low = guess;
    for (int step = 0; step < 4 && low + 1 < high; step++) {
      if (source->lines[low + 1] > offset) {
        high = low + 1;
        break;
      }
      low++;
    }
  }
  while (high - low > 1) {
    size_t middle = low + (high - low) / 2;
    if (source->lines[middle] <= offset) {
      low = middle;
    } else {
      high = middle;
    }
  }
  *hint = low;
  size_t column = offset - source->lines[low] + 1;
  const size_t most = (1u << 20) - 1;
  return (qn_loc){.line = (uint32_t)(low + 1), .column = (uint32_t)(column < most ? column : most) & 0xFFFFFu,
                  .file = source->file & 0xFFFu};
}

const char *qn_source_line(const qn_source *source, size_t line, size_t column, size_t *length) {
  size_t from = source->lines[line - 1];
  size_t to = line < source->line_count ? source->lines[line] - 1 : source->length;
  if (to > from && source->text[to - 1] == '\r') {
    to--;
  }
  if (to - from > LONGEST_SHOWN) {
    to = from + LONGEST_SHOWN;
    while (to > from && ((unsigned char)source->text[to] & 0xC0) == 0x80) {
      to--; /* not inside a character */
    }
    if (column > to - from) {
      to = from;
    }
  }
  *length = to - from;
  return source->text + from;
}
