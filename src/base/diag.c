#include "base/diag.h"

#include "base/limits.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void qn_diags_init(qn_diags *diags, qn_mem *mem) {
  *diags = (qn_diags){0};
  qn_arena_init(&diags->arena, mem);
}

void qn_diags_free(qn_diags *diags) {
  qn_mem *mem = diags->arena.mem;
  qn_free(mem, diags->items, diags->capacity * sizeof *diags->items);
  qn_free(mem, (void *)diags->files, diags->file_capacity * sizeof *diags->files);
  qn_arena_free(&diags->arena);
  qn_diags_init(diags, mem);
}

unsigned qn_diags_file(qn_diags *diags, const char *name) {
  if (diags->file_count + 1 >= QN_MAX_FILES) {
    for (size_t i = diags->file_count; i-- > 0;) { /* a caller of many texts gives them one name, or few: the last is tried first */
      if (strcmp(diags->files[i], name) == 0) {
        return (unsigned)(i + 1);
      }
    }
    if (diags->file_count >= QN_MAX_FILES) {
      return QN_MAX_FILES;
    }
    name = "(another text)";
  }
  if (!qn_grow(diags->arena.mem, &diags->files, &diags->file_capacity, diags->file_count + 1)) {
    return 0;
  }
  const char *copy = qn_arena_text(&diags->arena, name, strlen(name));
  if (!copy) {
    return 0;
  }
  diags->files[diags->file_count++] = copy;
  return (unsigned)diags->file_count;
}

static const char *keep(qn_diags *diags, const char *text, size_t length) {
  if (!text || length == 0) {
    return "";
  }
  const char *copy = qn_arena_text(&diags->arena, text, length);
  if (!copy) {
    diags->lost = 1;
  }
  return copy ? copy : "";
}

void qn_diags_add(qn_diags *diags, const qn_report *report, const char *problem_format, ...) {
  if (report->severity == QUOIN_ERROR) {
    diags->errors++;
  }
  if (!qn_grow(diags->arena.mem, &diags->items, &diags->capacity, diags->count + 1)) {
    diags->lost = 1;
    return;
  }
  char problem[1024];
  va_list args;
  va_start(args, problem_format);
  int length = vsnprintf(problem, sizeof problem, problem_format, args);
  va_end(args);
  size_t kept = length < 0 ? 0 : (size_t)length < sizeof problem ? (size_t)length : sizeof problem - 1;
  diags->items[diags->count++] = (quoin_diag){
    .severity = report->severity,
    .code = report->code,
    .file = report->loc.file ? diags->files[report->loc.file - 1] : "",
    .line = report->loc.line,
    .column = report->loc.column,
    .length = report->length ? report->length : 1,
    .problem = keep(diags, problem, kept),
    .reason = keep(diags, report->reason, report->reason ? strlen(report->reason) : 0),
    .way_out = keep(diags, report->way_out, report->way_out ? strlen(report->way_out) : 0),
    .source = keep(diags, report->source, report->source_length),
  };
}

/* The order of two diagnostics of a text: place, then as they came. Insertion sort: lists are short and nearly sorted. */
static int after(const quoin_diag *a, const quoin_diag *b) {
  if (!a->line != !b->line) {
    return !a->line;
  }
  int by_file = strcmp(a->file, b->file);
  if (by_file) {
    return 0; /* files stay in the order in which they were read */
  }
  return a->line != b->line ? a->line > b->line : a->column > b->column;
}

void qn_diags_sort(qn_diags *diags) {
  for (size_t i = 1; i < diags->count; i++) {
    quoin_diag item = diags->items[i];
    size_t j = i;
    for (; j > 0 && after(&diags->items[j - 1], &item); j--) {
      diags->items[j] = diags->items[j - 1];
    }
    diags->items[j] = item;
  }
}

/* Appends to a text of bounded size, counting what it would need. */
typedef struct out { char *text; size_t size, length; } out;

static void put(out *o, const char *text, size_t length) {
  for (size_t i = 0; i < length; i++, o->length++) {
    if (o->length + 1 < o->size) {
      o->text[o->length] = text[i];
    }
  }
}
static void put_text(out *o, const char *text) {
  put(o, text, strlen(text));
}

QUOIN_API size_t quoin_diag_format(const quoin_diag *d, char *text, size_t size) {
  static const char *const words[] = {[QUOIN_NOTE] = "note", [QUOIN_WARNING] = "warning", [QUOIN_ERROR] = "error"};
  out o = {text, size, 0};
  char number[64];
  if (!d) {
    if (size) {
      *text = '\0';
    }
    return 0;
  }
  if (d->file[0]) {
    put_text(&o, d->file);
    if (d->line) {
      snprintf(number, sizeof number, ":%u:%u", (unsigned)d->line, (unsigned)d->column);
      put_text(&o, number);
    }
    put_text(&o, ": ");
  }
  put_text(&o, words[d->severity]);
  put_text(&o, ": ");
  put_text(&o, d->problem);
  if (d->reason[0]) {
    put_text(&o, " (");
    put_text(&o, d->reason);
    put_text(&o, ")");
  }
  if (d->way_out[0]) {
    put_text(&o, "; ");
    put_text(&o, d->way_out);
  }
  put_text(&o, " [");
  put_text(&o, d->code);
  put_text(&o, "]\n");
  if (d->line && d->source[0]) {
    put_text(&o, "  ");
    size_t length = strlen(d->source);
    for (size_t i = 0; i < length; i++) { /* control bytes would move the caret, or the terminal */
      unsigned char c = (unsigned char)d->source[i];
      char shown = (char)(c == '\t' || c >= 32 ? (c == 127 ? '?' : c) : '?');
      put(&o, &shown, 1);
    }
    put_text(&o, "\n  ");
    for (size_t i = 0; i + 1 < d->column && i < length; i++) {
      unsigned char c = (unsigned char)d->source[i];
      if ((c & 0xC0) != 0x80) { /* one column a character, not a byte, on a UTF-8 terminal */
        put(&o, c == '\t' ? "\t" : " ", 1);
      }
    }
    for (size_t i = 0; i < d->length && (i == 0 || d->column - 1 + i < length); i++) {
      unsigned char c = d->column - 1 + i < length ? (unsigned char)d->source[d->column - 1 + i] : ' ';
      if ((c & 0xC0) != 0x80 || i == 0) {
        put(&o, "^", 1);
      }
    }
    put_text(&o, "\n");
  }
  if (size) {
    text[o.length < size ? o.length : size - 1] = '\0';
  }
  return o.length;
}
