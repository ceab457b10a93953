/* Statements. The open ones stand on a stack of their own, so nesting costs memory only. After an error the text is passed
   over to the next ';' or '}', and reading goes on, so that one run tells every error. */
#include "text/parse.h"

#include "base/limits.h"
#include "text/parser.h"

#include <stdio.h>
#include <string.h>

static void next(qn_parser *p) {
  qn_lexer_next(&p->lexer);
}
static int is(const qn_parser *p, char mark) {
  return qn_lexer_is(&p->lexer, mark);
}
static int at_end(const qn_parser *p) {
  return p->lexer.token.kind == QN_T_END;
}

const char *qn_parse_found(const qn_parser *p, char text[64]) {
  const qn_token *t = &p->lexer.token;
  int n = t->length < 40 ? (int)t->length : 40;
  const char *at = p->lexer.source->text + t->offset;
  while (n > 0 && (size_t)n < t->length && ((unsigned char)at[n] & 0xC0) == 0x80) {
    n--;
  }
  switch (t->kind) {
  case QN_T_END: return "the end of the file";
  case QN_T_STRING: return "a string";
  default: break;
  }
  snprintf(text, 64, "'%.*s'", n, at);
  return text;
}

int qn_parse_depth(qn_parser *p) {
  if (p->open_count + p->waiting_count < QN_MAX_DEPTH) {
    return 1;
  }
  if (!p->failed) {
    qn_tell(p->reporter, QN_Q0901, p->lexer.token.offset, p->lexer.token.length, "at most 200000 levels are read", NULL,
            "nested too deeply");
    p->failed = QUOIN_E_LIMIT;
  }
  return 0;
}

/* --- building the tree ------------------------------------------------------------------------------------------- */

static qn_open *owner(qn_parser *p) {
  return &p->open[p->open[p->open_count - 1].owner];
}

static uint32_t add_statement(qn_parser *p, uint32_t word, uint32_t offset, uint32_t flags) {
  qn_syntax *s = p->syntax;
  if (s->statement_count >= QN_NO_STATEMENT - 1 || !qn_grow(p->mem, &s->statements, &s->statement_capacity, s->statement_count + 1)) {
    p->failed = QUOIN_E_MEMORY;
    return QN_NO_STATEMENT;
  }
  uint32_t n = (uint32_t)s->statement_count++;
  s->statements[n] = (qn_statement){.word = word, .offset = offset, .argument0 = (uint32_t)s->argument_count, .first = QN_NO_STATEMENT,
                                    .next = QN_NO_STATEMENT, .assignment = QN_NO_STATEMENT, .flags = flags};
  if (p->open_count) {
    qn_open *o = owner(p);
    if (o->last == QN_NO_STATEMENT) {
      s->statements[o->statement].first = n;
    } else {
      s->statements[o->last].next = n;
    }
    o->last = n;
  }
  return n;
}

static void add_argument(qn_parser *p, qn_argument argument) {
  qn_syntax *s = p->syntax;
  if (s->argument_count >= UINT32_MAX || !qn_grow(p->mem, &s->arguments, &s->argument_capacity, s->argument_count + 1)) {
    p->failed = QUOIN_E_MEMORY;
    return;
  }
  s->arguments[s->argument_count++] = argument;
}

static void add_assignment(qn_parser *p, qn_argument value) {
  qn_syntax *s = p->syntax;
  if (s->assignment_count >= QN_NO_STATEMENT - 1 || !qn_grow(p->mem, &s->assignments, &s->assignment_capacity, s->assignment_count + 1)) {
    p->failed = QUOIN_E_MEMORY;
    return;
  }
  uint32_t n = (uint32_t)s->assignment_count++;
  s->assignments[n] = (qn_assignment){value, QN_NO_STATEMENT};
  qn_open *o = owner(p);
  if (o->last_assignment == QN_NO_STATEMENT) {
    s->statements[o->statement].assignment = n;
  } else {
    s->assignments[o->last_assignment].next = n;
  }
  o->last_assignment = n;
}

/* Opens a frame for a statement's child; block: for the children of { at `brace`. inlined: a bare { }. */
static void open_frame(qn_parser *p, uint32_t statement, int block, uint32_t brace, int inlined) {
  if (!qn_parse_depth(p)) {
    return;
  }
  if (!qn_grow(p->mem, &p->open, &p->open_capacity, p->open_count + 1)) {
    p->failed = QUOIN_E_MEMORY;
    return;
  }
  uint32_t n = (uint32_t)p->open_count++;
  p->open[n] = (qn_open){.statement = statement, .owner = inlined ? p->open[n - 1].owner : n, .last = QN_NO_STATEMENT,
                         .last_assignment = QN_NO_STATEMENT, .brace = brace, .block = (uint8_t)block};
}

/* The innermost frame's statement is complete; behind an `if` an `else` may stand, and behind an `else` that of an `if` further out. */
static void close_frame(qn_parser *p) {
  uint32_t word = p->syntax->statements[p->open[--p->open_count].statement].word;
  p->behind_if |= word == QN_WORD_IF || word == QN_WORD_ELSE;
}

/* A statement is complete: so are those that waited for it as their one child. */
static void complete(qn_parser *p) {
  while (p->open_count > 1 && !p->open[p->open_count - 1].block) {
    close_frame(p);
  }
}

static int waits_for_child(const qn_parser *p) {
  return !p->open[p->open_count - 1].block;
}

/* The statement that waits for a child gets none; if its arguments were in error, that may be why. */
static void no_child(qn_parser *p) {
  if (!(p->syntax->statements[p->open[p->open_count - 1].statement].flags & QN_STATEMENT_BAD)) {
    qn_tell(p->reporter, QN_Q0202, p->lexer.last_end, 1, NULL, "write a ';' here", "missing ';'");
  }
  complete(p);
}

/* --- recovery ---------------------------------------------------------------------------------------------------- */

/* Passes over the rest of a statement: behind its ';' or its { }, or before the '}' that ends its surroundings. */
static void panic(qn_parser *p) {
  size_t depth = 0;
  for (;; next(p)) {
    if (at_end(p)) {
      break;
    }
    if (is(p, ';') && depth == 0) {
      next(p);
      break;
    }
    if (is(p, '{')) {
      depth++;
    } else if (is(p, '}')) {
      if (depth == 0) {
        break;
      }
      if (--depth == 0) {
        next(p);
        break;
      }
    }
  }
  complete(p);
  p->behind_if = 1; /* it may have been one that was passed over */
}

static void expected(qn_parser *p, const char *what) {
  if (p->lexer.token.kind == QN_T_BAD) {
    return;
  }
  char found[64];
  qn_tell(p->reporter, QN_Q0201, p->lexer.token.offset, p->lexer.token.length, NULL, NULL, "expected %s, found %s", what,
          qn_parse_found(p, found));
}

/* --- arguments --------------------------------------------------------------------------------------------------- */

/* Passes over ( ... ) of a word that is not supported, whose inside has a syntax of its own. */
static void skip_parentheses(qn_parser *p) {
  uint32_t start = p->lexer.token.offset;
  size_t depth = 0;
  for (;; next(p)) {
    if (at_end(p) || is(p, '{') || is(p, '}') || is(p, ';')) {
      qn_tell(p->reporter, QN_Q0203, start, 1, NULL, "close it with ')'", "this '(' is never closed");
      return;
    }
    if (is(p, '(') || is(p, '[')) {
      depth++;
    } else if (is(p, ')') || is(p, ']')) {
      if (--depth == 0) {
        next(p);
        return;
      }
    }
  }
}

/* Is the current name followed by '=' (and not '==')? */
static int names_argument(qn_parser *p) {
  const qn_lexer *lx = &p->lexer;
  const char *text = lx->source->text;
  size_t at = lx->at, length = lx->source->length;
  for (;;) { /* blanks and comments, without telling anything */
    while (at < length && strchr(" \t\r\n\f\v", text[at])) {
      at++;
    }
    if (at + 1 < length && text[at] == '/' && text[at + 1] == '/') {
      while (at < length && text[at] != '\n') {
        at++;
      }
    } else if (at + 1 < length && text[at] == '/' && text[at + 1] == '*') {
      for (at += 2; at < length && !(text[at] == '*' && at + 1 < length && text[at + 1] == '/');) {
        at++;
      }
      at = at + 2 < length ? at + 2 : length;
    } else {
      break;
    }
  }
  return at < length && text[at] == '=' && !(at + 1 < length && text[at + 1] == '=');
}

/* ( arguments ) of a statement, from '('. Returns 0 when the rest of the statement must be passed over. */
static int arguments(qn_parser *p, uint32_t statement) {
  uint32_t start = p->lexer.token.offset;
  next(p);
  while (!is(p, ')')) {
    if (p->failed) {
      return 0;
    }
    qn_argument a = {QN_WORD_NONE, p->lexer.token.offset, 0, 0};
    if (p->lexer.token.kind == QN_T_NAME && names_argument(p)) {
      a.name = p->lexer.token.name;
      next(p);
      next(p);
    }
    int good = qn_parse_expression(p, &a.from, &a.to);
    if (p->failed) {
      return 0;
    }
    add_argument(p, a);
    if (!good) {
      p->syntax->statements[statement].flags |= QN_STATEMENT_BAD;
    }
    if (is(p, ',')) {
      next(p);
    } else if (!is(p, ')')) {
      p->syntax->statements[statement].flags |= QN_STATEMENT_BAD;
      int ends = at_end(p) || is(p, ';') || is(p, '{') || is(p, '}');
      if (good && ends) {
        char found[64], reason[96];
        snprintf(reason, sizeof reason, "%s comes first", qn_parse_found(p, found));
        qn_tell(p->reporter, QN_Q0203, start, 1, reason, "close it with ')'", "this '(' is never closed");
      } else if (good) {
        expected(p, "',' or ')'");
      }
      p->syntax->statements[statement].arguments = (uint32_t)p->syntax->argument_count - p->syntax->statements[statement].argument0;
      return ends;
    }
  }
  next(p);
  p->syntax->statements[statement].arguments = (uint32_t)p->syntax->argument_count - p->syntax->statements[statement].argument0;
  return 1;
}

/* --- statements -------------------------------------------------------------------------------------------------- */

/* Is it a word that no variable can have as its name? */
static int reserved(uint32_t word) {
  return word != QN_WORD_NONE && word < QN_WORD_FN && word != QN_WORD_INTERSECTION_FOR && word != QN_WORD_ASSIGN;
}

/* name = expression ; with the name read and '=' the current token. */
static void assignment(qn_parser *p, qn_token name) {
  if (reserved(name.name)) {
    qn_tell(p->reporter, QN_Q0201, name.offset, name.length, NULL, "take another name", "'%s' is a word of the language, not a variable",
            p->syntax->names.items[name.name].text);
    panic(p);
    return;
  }
  if (waits_for_child(p)) {
    qn_tell(p->reporter, QN_Q0206, name.offset, name.length, "a solid was expected here", "put it before, or inside { }",
            "an assignment cannot be a child");
    panic(p);
    return;
  }
  next(p);
  qn_argument a = {name.name, name.offset, 0, 0};
  int good = qn_parse_expression(p, &a.from, &a.to);
  if (p->failed) {
    return;
  }
  add_assignment(p, a);
  if (is(p, ';')) {
    next(p);
  } else if (!good) {
    panic(p);
  } else if (p->lexer.token.kind == QN_T_NAME || at_end(p) || is(p, '}')) {
    qn_tell(p->reporter, QN_Q0202, p->lexer.last_end, 1, NULL, "write a ';' here", "missing ';' after the value");
  } else {
    expected(p, "';' after the value");
    panic(p);
  }
}

/* module NAME(...) body, function NAME(...) = value; : passed over; the statement stays for the evaluator to speak of. */
static void declaration(qn_parser *p, qn_token word) {
  next(p);
  if (p->lexer.token.kind != QN_T_NAME) {
    expected(p, "a name");
    panic(p);
    return;
  }
  p->syntax->names.items[p->lexer.token.name].declared = 1;
  next(p);
  if (!is(p, '(')) {
    expected(p, "'('");
    panic(p);
    return;
  }
  uint32_t n = add_statement(p, word.name, word.offset, 0);
  skip_parentheses(p);
  if (p->failed || n == QN_NO_STATEMENT) {
    return;
  }
  if (word.name == QN_WORD_MODULE) {
    open_frame(p, n, 0, 0, 0);
    return;
  }
  if (!is(p, '=')) {
    expected(p, "'='");
    panic(p);
    return;
  }
  next(p);
  size_t ops = p->syntax->op_count;
  uint32_t from, to;
  int good = qn_parse_expression(p, &from, &to);
  p->syntax->op_count = ops;
  if (is(p, ';')) {
    next(p);
    complete(p);
  } else {
    if (good) {
      expected(p, "';' after the function");
    }
    panic(p);
  }
}

/* word(arguments), then its child is expected; behind_if: an `if` has just ended. */
static void call(qn_parser *p, uint32_t flags, int behind_if) {
  qn_token word = p->lexer.token;
  switch (word.name) {
  case QN_WORD_MODULE:
  case QN_WORD_FUNCTION:
    declaration(p, word);
    return;
  case QN_WORD_INCLUDE:
  case QN_WORD_USE:
    p->syntax->includes = 1;
    add_statement(p, word.name, word.offset, 0);
    if (!qn_lexer_path(&p->lexer)) {
      next(p);
      expected(p, "<file>");
      panic(p);
      return;
    }
    if (is(p, ';')) {
      next(p);
    }
    complete(p);
    return;
  default:
    break;
  }
  next(p);
  if (is(p, '=')) {
    assignment(p, word);
    return;
  }
  uint32_t n = add_statement(p, word.name, word.offset, flags);
  if (n == QN_NO_STATEMENT) {
    return;
  }
  if (word.name == QN_WORD_ELSE) {
    if (!behind_if) {
      qn_tell(p->reporter, QN_Q0201, word.offset, word.length, "it must stand right behind an if(...) and its solid", "remove the word 'else'",
              "this 'else' belongs to no 'if'");
    }
    open_frame(p, n, 0, 0, 0);
    return;
  }
  if (!is(p, '(')) {
    char what[96];
    const char *text = p->syntax->names.items[word.name].text;
    snprintf(what, sizeof what, "'(' after '%.60s'", text);
    expected(p, what);
    p->syntax->statements[n].flags |= QN_STATEMENT_BAD;
    if (is(p, ';') || is(p, '{')) {
      open_frame(p, n, 0, 0, 0);
    } else {
      panic(p);
    }
    return;
  }
  int good = 1;
  switch (word.name) {
  case QN_WORD_FOR:
  case QN_WORD_INTERSECTION_FOR:
  case QN_WORD_IF:
  case QN_WORD_LET:
  case QN_WORD_ASSIGN:
    skip_parentheses(p);
    break;
  default:
    good = arguments(p, n);
    break;
  }
  if (p->failed) {
    return;
  }
  if (good) {
    open_frame(p, n, 0, 0, 0);
  } else {
    panic(p);
  }
}

/* '}' as the current token. */
static void close_block(qn_parser *p) {
  uint32_t offset = p->lexer.token.offset;
  if (waits_for_child(p)) {
    no_child(p);
  }
  if (p->open_count == 1) {
    qn_tell(p->reporter, QN_Q0204, offset, 1, NULL, "remove it", "this '}' closes nothing");
    next(p);
    return;
  }
  int inlined = p->open[p->open_count - 1].owner != p->open_count - 1;
  if (inlined) {
    p->open_count--;
  } else {
    close_frame(p);
  }
  next(p);
  if (!inlined) {
    complete(p);
  }
}

static void statement(qn_parser *p) {
  uint32_t flags = 0;
  int behind_if = p->behind_if;
  p->behind_if = 0;
  for (;;) {
    uint32_t sign = is(p, '%')   ? QN_SIGN_BACKGROUND
                    : is(p, '#') ? QN_SIGN_HIGHLIGHT
                    : is(p, '!') ? QN_SIGN_ONLY
                    : is(p, '*') ? QN_SIGN_DISABLE
                                 : 0;
    if (!sign) {
      break;
    }
    flags |= sign;
    next(p);
  }
  if (p->lexer.token.kind == QN_T_NAME) {
    call(p, flags, behind_if);
  } else if (flags) {
    expected(p, "a word after the modifier");
    panic(p);
  } else if (is(p, ';')) {
    next(p);
    complete(p);
  } else if (is(p, '{')) {
    uint32_t brace = p->lexer.token.offset;
    if (waits_for_child(p)) {
      p->open[p->open_count - 1].block = 1;
      p->open[p->open_count - 1].brace = brace;
    } else {
      open_frame(p, p->open[p->open_count - 1].statement, 1, brace, 1);
    }
    next(p);
  } else if (is(p, '}')) {
    close_block(p);
  } else if (is(p, ')') || is(p, ']')) {
    qn_tell(p->reporter, QN_Q0204, p->lexer.token.offset, 1, NULL, "remove it", "this '%c' closes nothing", p->lexer.token.mark);
    next(p);
  } else {
    expected(p, waits_for_child(p) ? "';' or '{' or a word" : "a word");
    if (!at_end(p)) {
      next(p);
      panic(p);
    }
  }
}

quoin_status qn_parse(qn_syntax *syntax, const qn_source *source, qn_reporter *reporter, qn_ctx *numbers) {
  const char *nul = source->length ? memchr(source->text, '\0', source->length) : NULL;
  if (nul) {
    qn_tell(reporter, QN_Q0101, (size_t)(nul - source->text), 1, "it contains a zero byte", "give a model in text form",
            "the file is not text");
    return QUOIN_OK;
  }
  qn_parser p = {.syntax = syntax, .reporter = reporter, .mem = syntax->mem};
  qn_lexer_init(&p.lexer, source, reporter, &syntax->names, numbers);
  uint32_t root = add_statement(&p, QN_WORD_NONE, 0, 0);
  if (!p.failed) {
    open_frame(&p, root, 1, 0, 0);
    next(&p);
  }
  while (!p.failed && !p.lexer.failed && !at_end(&p)) {
    statement(&p);
  }
  p.failed = p.failed ? p.failed : p.lexer.failed;
  if (!p.failed && !reporter->stop) {
    if (waits_for_child(&p)) {
      no_child(&p);
    }
    while (p.open_count > 1) {
      const qn_open *o = &p.open[--p.open_count];
      if (o->block) {
        qn_tell(reporter, QN_Q0203, o->brace, 1, "the file ends first", "close it with '}'", "this '{' is never closed");
        break; /* one cause: those further out follow from it */
      }
    }
  }
  qn_lexer_free(&p.lexer);
  qn_free(p.mem, p.waiting, p.waiting_capacity * sizeof *p.waiting);
  qn_free(p.mem, p.open, p.open_capacity * sizeof *p.open);
  return p.failed;
}
