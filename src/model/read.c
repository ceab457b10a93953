/* Reading a model: text to syntax tree to solid tree. A text with errors adds nothing. */
#include "base/limits.h"
#include "model/evaluate.h"
#include "text/parse.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

enum { MOST_ERRORS = 100 };

QUOIN_API quoin_read_options quoin_read_options_default(void) {
  return (quoin_read_options){.facets = QUOIN_FACETS_AUTO, .max_errors = MOST_ERRORS};
}

/* What a failed read puts back. */
typedef struct before {
  size_t nodes, numbers, names, materials, lights, leaves, diags, errors;
  uint32_t last, only;
  qn_view view;
  qn_mark ctx, arena;
} before;

static before remember(const quoin_model *m, uint32_t parent) {
  return (before){m->node_count, m->number_count, m->name_count, m->material_count, m->light_count, m->leaf_count, m->diags.count,
                  m->diags.errors, m->nodes[parent].last, m->only, m->view, qn_arena_mark(&m->ctx.arena), qn_arena_mark(&m->arena)};
}

static void put_back(quoin_model *m, uint32_t parent, const before *b) {
  m->node_count = b->nodes;
  m->number_count = b->numbers;
  m->name_count = b->names;
  m->material_count = b->materials;
  m->light_count = b->lights;
  m->leaf_count = b->leaves;
  m->only = b->only;
  m->view = b->view;
  m->nodes[parent].last = b->last;
  if (b->last == QN_NO_NODE) {
    m->nodes[parent].first = QN_NO_NODE;
  } else {
    m->nodes[b->last].next = QN_NO_NODE;
  }
  m->ctx.failed = QUOIN_OK;
  qn_arena_release(&m->ctx.arena, b->ctx);
  qn_arena_release(&m->arena, b->arena);
}

/* A diagnostic about a whole file. */
static void tell_file(quoin_model *m, unsigned file, qn_code code, const char *reason, const char *problem) {
  qn_report report = {.severity = qn_codes[code].severity, .code = qn_codes[code].text, .loc = {.file = file & 0xFFFu}, .reason = reason};
  qn_diags_add(&m->diags, &report, "%s", problem);
}

static quoin_status too_large(quoin_model *m, unsigned file) {
  tell_file(m, file, QN_Q0905, "at most 2^31 bytes are read", "file too large");
  return QUOIN_E_LIMIT;
}

static quoin_status read(quoin_model *m, uint32_t parent, unsigned file, const char *text, size_t length,
                         const quoin_read_options *options) {
  if ((unsigned)options->facets > QUOIN_FACETS_IGNORE) {
    return QUOIN_E_ARGUMENT;
  }
  before b = remember(m, parent);
  if (length > QN_MAX_TEXT) {
    return too_large(m, file);
  }
  qn_source source;
  if (!qn_source_init(&source, &m->mem, file, text, length)) {
    return QUOIN_E_MEMORY;
  }
  qn_reporter reporter;
  qn_reporter_init(&reporter, &m->diags, &source, options->max_errors ? options->max_errors : MOST_ERRORS);
  qn_syntax syntax = {0};
  qn_ctx literals;
  qn_ctx_init(&literals, &m->mem);
  quoin_status status = qn_syntax_init(&syntax, &m->mem) ? QUOIN_OK : QUOIN_E_MEMORY;
  if (status == QUOIN_OK) {
    status = qn_parse(&syntax, &source, &reporter, &literals);
  }
  if (status == QUOIN_OK) {
    status = literals.failed;
  }
  if (status == QUOIN_OK && !reporter.stop && syntax.statement_count > 0) {
    status = qn_evaluate(m, parent, &syntax, &source, &reporter, options);
  }
  if (status == QUOIN_OK && m->diags.lost) {
    status = QUOIN_E_MEMORY;
  }
  if (status == QUOIN_OK && reporter.errors) {
    status = reporter.limit ? QUOIN_E_LIMIT : QUOIN_E_MODEL;
  }
  qn_reporter_end(&reporter);
  if (status == QUOIN_OK && m->diags.lost) {
    status = QUOIN_E_MEMORY;
  }
  if (status != QUOIN_OK) {
    put_back(m, parent, &b);
  }
  if (status == QUOIN_E_MEMORY) { /* what was said so far may not be all: the call had no effect */
    m->diags.count = b.diags;
    m->diags.errors = b.errors;
    m->diags.lost = 0;
  }
  qn_syntax_free(&syntax);
  qn_ctx_free(&literals);
  qn_source_free(&source);
  return status;
}

static int may_add(const quoin_model *m, quoin_node parent) {
  return m && !m->frozen && parent < m->node_count && m->nodes[parent].kind != QN_NODE_LEAF;
}

QUOIN_API quoin_status quoin_model_read_text(quoin_model *m, quoin_node parent, const char *name, const char *text, size_t length,
                                             const quoin_read_options *options) {
  quoin_read_options usual = quoin_read_options_default();
  if (!may_add(m, parent) || (!text && length)) {
    return QUOIN_E_ARGUMENT;
  }
  unsigned file = qn_diags_file(&m->diags, name ? name : "text");
  if (!file) {
    return QUOIN_E_MEMORY;
  }
  return read(m, parent, file, length ? text : "", length, options ? options : &usual);
}

enum { MORE = 1 << 16 }; /* bytes asked for at least at a time */

/* Room for a file whose length can be told, so that it need not grow; nothing is lost when it cannot. 0: memory was refused. */
static int make_room(qn_mem *mem, FILE *f, char **text, size_t *capacity) {
  long end = fseek(f, 0, SEEK_END) == 0 ? ftell(f) : 0;
  return fseek(f, 0, SEEK_SET) != 0 || end <= 0 || (unsigned long)end > QN_MAX_TEXT || qn_grow(mem, text, capacity, (size_t)end + MORE);
}

/* The whole of a file: QUOIN_E_IO with errno, QUOIN_E_LIMIT when it is too long, QUOIN_E_MEMORY. */
static quoin_status slurp(qn_mem *mem, const char *path, char **text, size_t *length, size_t *capacity) {
  FILE *f = strcmp(path, "-") == 0 ? stdin : fopen(path, "rb");
  quoin_status status = QUOIN_OK;
  if (!f) {
    return QUOIN_E_IO;
  }
  if (f != stdin && !make_room(mem, f, text, capacity)) {
    status = QUOIN_E_MEMORY;
  }
  errno = 0;
  while (status == QUOIN_OK) {
    if (*length > QN_MAX_TEXT) {
      status = QUOIN_E_LIMIT;
    } else if (!qn_grow(mem, text, capacity, *length + MORE)) {
      status = QUOIN_E_MEMORY;
    } else {
      size_t n = fread(*text + *length, 1, *capacity - *length, f);
      *length += n;
      if (n == 0) {
        status = ferror(f) ? QUOIN_E_IO : QUOIN_OK;
        break;
      }
    }
  }
  int number = errno;
  if (f != stdin) {
    (void)fclose(f); /* it was only read */
  }
  errno = number;
  return status;
}

QUOIN_API quoin_status quoin_model_read_file(quoin_model *m, quoin_node parent, const char *path, const quoin_read_options *options) {
  quoin_read_options usual = quoin_read_options_default();
  if (!may_add(m, parent) || !path) {
    return QUOIN_E_ARGUMENT;
  }
  unsigned file = qn_diags_file(&m->diags, strcmp(path, "-") == 0 ? "<stdin>" : path);
  if (!file) {
    return QUOIN_E_MEMORY;
  }
  char *text = NULL;
  size_t length = 0, capacity = 0;
  quoin_status status = slurp(&m->mem, path, &text, &length, &capacity);
  int number = errno;
  if (status == QUOIN_OK) {
    status = read(m, parent, file, text, length, options ? options : &usual);
  } else if (status != QUOIN_E_MEMORY) {
    char why[128] = "";
    if (status == QUOIN_E_LIMIT) {
      too_large(m, file);
    } else {
      tell_file(m, file, QN_Q0801, strerror_r(number, why, sizeof why) == 0 ? why : NULL, "the file cannot be read");
    }
  }
  qn_free(&m->mem, text, capacity);
  errno = number;
  return status;
}
