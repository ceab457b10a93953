/* Expressions to postfix code, by operator precedence with a stack of its own (Dijkstra's shunting yard), so that the
   depth of an expression costs memory only.

   Ranks, from OpenSCAD's grammar: ?: 1, || 2, && 3, == != 4, < <= > >= 5, + - 6, * / % 7, unary + - ! 8, ^ 9 (to the
   right; its right side may begin with a sign: 2 ^ -1; -2 ^ 2 is -4), then indexing and members. */
#include "text/parser.h"

#include "base/limits.h"

#include <stdio.h>

enum { W_PREFIX, W_BINARY, W_SHORT, W_THEN, W_ELSE, W_PAREN, W_CALL, W_VECTOR, W_INDEX };

enum { RANK_CHOICE = 1, RANK_UNARY = 8, RANK_POWER = 9 };

static void emit(qn_parser *p, qn_op_kind kind, uint32_t offset, uint32_t a) {
  qn_syntax *s = p->syntax;
  if (s->op_count >= UINT32_MAX || !qn_grow(p->mem, &s->ops, &s->op_capacity, s->op_count + 1)) {
    p->failed = QUOIN_E_MEMORY;
    return;
  }
  s->ops[s->op_count++] = (qn_op){.kind = (uint8_t)kind, .offset = offset, .a = a};
}

static void emit_number(qn_parser *p, qn_num n, uint32_t offset) {
  qn_syntax *s = p->syntax;
  if (n.kind == QN_NUM_SMALL && n.u.m >= -INT32_MAX && n.u.m <= INT32_MAX && n.a >= -128 && n.a < 128 && n.b >= -128 && n.b < 128) {
    emit(p, QN_OP_SMALL, offset, (uint32_t)(int32_t)n.u.m);
    if (!p->failed) {
      s->ops[s->op_count - 1].e2 = (int8_t)n.a;
      s->ops[s->op_count - 1].e5 = (int8_t)n.b;
    }
    return;
  }
  if (s->number_count >= UINT32_MAX || !qn_grow(p->mem, &s->numbers, &s->number_capacity, s->number_count + 1)) {
    p->failed = QUOIN_E_MEMORY;
    return;
  }
  s->numbers[s->number_count++] = n;
  emit(p, QN_OP_NUMBER, offset, (uint32_t)(s->number_count - 1));
}

static void emit_call(qn_parser *p, const qn_waiting *w) {
  qn_syntax *s = p->syntax;
  if (s->call_count >= UINT32_MAX || !qn_grow(p->mem, &s->calls, &s->call_capacity, s->call_count + 1)) {
    p->failed = QUOIN_E_MEMORY;
    return;
  }
  s->calls[s->call_count++] = (qn_call_site){w->a, w->count};
  emit(p, QN_OP_CALL, w->offset, (uint32_t)(s->call_count - 1));
}

/* A sign before a literal becomes part of it. */
static void emit_negate(qn_parser *p, uint32_t offset, size_t from) {
  qn_syntax *s = p->syntax;
  if (s->op_count > from && s->op_count > p->joined) {
    qn_op *last = &s->ops[s->op_count - 1];
    if (last->kind == QN_OP_SMALL) {
      last->a = (uint32_t) - (int32_t)last->a;
      return;
    }
    if (last->kind == QN_OP_NUMBER) {
      s->numbers[last->a] = qn_num_neg(p->lexer.numbers, s->numbers[last->a]);
      return;
    }
  }
  emit(p, QN_OP_NEGATE, offset, 0);
}

static void push(qn_parser *p, int kind, int op, int rank, uint32_t offset, uint32_t a) {
  if (!qn_parse_depth(p)) {
    return;
  }
  if (!qn_grow(p->mem, &p->waiting, &p->waiting_capacity, p->waiting_count + 1)) {
    p->failed = QUOIN_E_MEMORY;
    return;
  }
  p->waiting[p->waiting_count++] =
    (qn_waiting){.kind = (uint8_t)kind, .op = (uint8_t)op, .rank = (uint8_t)rank, .offset = offset, .a = a};
}

static void join(qn_parser *p, uint32_t jump) {
  p->syntax->ops[jump].a = (uint32_t)p->syntax->op_count;
  p->joined = p->syntax->op_count;
}

/* Emits the operators on top of the stack whose rank is at least `rank`. */
static void reduce(qn_parser *p, int rank, size_t from) {
  while (p->waiting_count > 0 && !p->failed) {
    qn_waiting w = p->waiting[p->waiting_count - 1];
    if (w.rank == 0 || w.rank < rank) {
      return;
    }
    p->waiting_count--;
    switch (w.kind) {
    case W_SHORT:
      emit(p, QN_OP_BOOL, w.offset, 0);
      join(p, w.a);
      break;
    case W_ELSE:
      join(p, w.a);
      break;
    case W_PREFIX:
      if (w.op == QN_OP_NEGATE) {
        emit_negate(p, w.offset, from);
        break;
      }
      emit(p, (qn_op_kind)w.op, w.offset, 0);
      break;
    default:
      emit(p, (qn_op_kind)w.op, w.offset, 0);
      break;
    }
  }
}

static qn_waiting *top(qn_parser *p) {
  return p->waiting_count ? &p->waiting[p->waiting_count - 1] : NULL;
}
static int top_is(qn_parser *p, int kind) {
  return p->waiting_count && p->waiting[p->waiting_count - 1].kind == kind;
}

static void next(qn_parser *p) {
  qn_lexer_next(&p->lexer);
}
static int is(const qn_parser *p, char mark) {
  return qn_lexer_is(&p->lexer, mark);
}

/* Passes over the rest of an expression that is in error. In what is balanced but not supported (`lenient`), a ';' inside
   parentheses is part of it. */
static int recover(qn_parser *p, size_t from, int lenient) {
  size_t depth = 0;
  for (size_t i = 0; i < p->waiting_count; i++) {
    depth += p->waiting[i].kind >= W_PAREN;
  }
  p->waiting_count = 0;
  p->syntax->op_count = from;
  for (;; next(p)) {
    if (p->lexer.token.kind == QN_T_END || is(p, '{') || is(p, '}') || (is(p, ';') && !(lenient && depth > 0))) {
      break;
    }
    if (is(p, '(') || is(p, '[')) {
      depth++;
    } else if (is(p, ')') || is(p, ']')) {
      if (depth == 0) {
        break;
      }
      depth--;
    } else if (is(p, ',') && depth == 0) {
      break;
    }
  }
  emit(p, QN_OP_BAD, (uint32_t)p->lexer.token.offset, 0);
  return 0;
}

/* Says that something else was expected, unless the lexer spoke already. */
static void expected(qn_parser *p, qn_code code, const char *what) {
  if (p->lexer.token.kind == QN_T_BAD) {
    return;
  }
  char found[64];
  qn_tell(p->reporter, code, p->lexer.token.offset, p->lexer.token.length, NULL, NULL, "expected %s, found %s", what,
          qn_parse_found(p, found));
}

/* An open bracket whose end is not where the expression stops. */
static void unclosed(qn_parser *p) {
  const qn_waiting *w = top(p);
  char mark = w->kind == W_PAREN || w->kind == W_CALL ? '(' : '[';
  char close = mark == '(' ? ')' : ']';
  if (p->lexer.token.kind == QN_T_END || is(p, ';') || is(p, '{') || is(p, '}')) {
    uint32_t at = w->offset;
    if (w->kind == W_CALL) { /* the place is the name's; the bracket follows it */
      at += p->syntax->names.items[w->a].length;
    }
    char found[64], reason[96];
    snprintf(reason, sizeof reason, "%s comes first", qn_parse_found(p, found));
    char way_out[] = "close it with '?'";
    way_out[15] = close;
    qn_tell(p->reporter, QN_Q0203, at, 1, reason, way_out, "this '%c' is never closed", mark);
    return;
  }
  expected(p, QN_Q0201, w->kind == W_PAREN ? "')'" : w->kind == W_CALL ? "',' or ')'" : w->kind == W_VECTOR ? "',' or ']'" : "']'");
}

static const char *unsupported(uint32_t name) {
  switch (name) {
  case QN_WORD_FOR: return "a list made by 'for'";
  case QN_WORD_IF: return "'if' in a list";
  case QN_WORD_LET: return "'let', names inside an expression,";
  case QN_WORD_EACH: return "'each', the elements of a list,";
  case QN_WORD_FUNCTION: return "a function as a value";
  case QN_WORD_ASSERT: return "'assert' inside an expression";
  case QN_WORD_ECHO: return "'echo' inside an expression";
  default: return NULL;
  }
}

/* An operand, or what opens one. Returns 1 when an operand stands complete, 0 when one is still expected, -1 on an error. */
static int operand(qn_parser *p) {
  qn_token t = p->lexer.token;
  switch (t.kind) {
  case QN_T_NUMBER:
    emit_number(p, t.number, t.offset);
    next(p);
    return 1;
  case QN_T_STRING:
    emit(p, QN_OP_STRING, t.offset, t.name);
    next(p);
    return 1;
  case QN_T_NAME:
    if (t.name == QN_WORD_TRUE || t.name == QN_WORD_FALSE || t.name == QN_WORD_UNDEF) {
      emit(p, t.name == QN_WORD_TRUE ? QN_OP_TRUE : t.name == QN_WORD_FALSE ? QN_OP_FALSE : QN_OP_UNDEF, t.offset, 0);
      next(p);
      return 1;
    }
    if (unsupported(t.name)) {
      qn_tell(p->reporter, QN_Q0210, t.offset, t.length, NULL, QN_FLATTEN, "%s is not supported yet", unsupported(t.name));
      return -2;
    }
    next(p);
    if (!is(p, '(')) {
      emit(p, QN_OP_LOAD, t.offset, t.name);
      return 1;
    }
    push(p, W_CALL, 0, 0, t.offset, t.name);
    next(p);
    return 0;
  case QN_T_MARK:
    switch (t.mark) {
    case '(':
      push(p, W_PAREN, 0, 0, t.offset, 0);
      next(p);
      return 0;
    case '[':
      push(p, W_VECTOR, 0, 0, t.offset, 0);
      next(p);
      return 0;
    case '-':
    case '+':
    case '!':
      push(p, W_PREFIX, t.mark == '-' ? QN_OP_NEGATE : t.mark == '+' ? QN_OP_PLUS : QN_OP_NOT, RANK_UNARY, t.offset, 0);
      next(p);
      return 0;
    case ']': /* [] and a comma before the end */
      if (top_is(p, W_VECTOR)) {
        emit(p, QN_OP_VECTOR, top(p)->offset, top(p)->count);
        p->waiting_count--;
        next(p);
        return 1;
      }
      break;
    case ')':
      if (top_is(p, W_CALL)) {
        qn_waiting w = *top(p);
        p->waiting_count--;
        emit_call(p, &w);
        next(p);
        return 1;
      }
      break;
    default:
      break;
    }
    break;
  default:
    break;
  }
  expected(p, QN_Q0205, "an expression");
  return -1;
}

typedef struct binary { qn_op_kind op; int rank; } binary;

static binary binary_of(qn_token t) {
  switch (t.kind) {
  case QN_T_OR: return (binary){QN_OP_OR, 2};
  case QN_T_AND: return (binary){QN_OP_AND, 3};
  case QN_T_EQUAL: return (binary){QN_OP_EQUAL, 4};
  case QN_T_NOT_EQUAL: return (binary){QN_OP_NOT_EQUAL, 4};
  case QN_T_LESS_EQUAL: return (binary){QN_OP_LESS_EQUAL, 5};
  case QN_T_GREATER_EQUAL: return (binary){QN_OP_GREATER_EQUAL, 5};
  case QN_T_MARK:
    switch (t.mark) {
    case '<': return (binary){QN_OP_LESS, 5};
    case '>': return (binary){QN_OP_GREATER, 5};
    case '+': return (binary){QN_OP_ADD, 6};
    case '-': return (binary){QN_OP_SUBTRACT, 6};
    case '*': return (binary){QN_OP_MULTIPLY, 7};
    case '/': return (binary){QN_OP_DIVIDE, 7};
    case '%': return (binary){QN_OP_REMAINDER, 7};
    case '^': return (binary){QN_OP_POWER, RANK_POWER};
    default: break;
    }
    break;
  default:
    break;
  }
  return (binary){QN_OP_BAD, 0};
}

/* What follows an operand. Returns 1 when an operand stands complete, 0 when one is expected, 2 at the end of the
   expression, -1 on an error (told), -2 on what is not supported. */
static int after_operand(qn_parser *p, size_t from) {
  qn_token t = p->lexer.token;
  binary b = binary_of(t);
  if (b.rank) {
    reduce(p, b.rank == RANK_POWER ? RANK_POWER + 1 : b.rank, from);
    if (b.op == QN_OP_AND || b.op == QN_OP_OR) {
      emit(p, b.op, t.offset, 0);
      push(p, W_SHORT, (int)b.op, b.rank, t.offset, (uint32_t)p->syntax->op_count - 1);
    } else {
      push(p, W_BINARY, (int)b.op, b.rank, t.offset, 0);
    }
    next(p);
    return 0;
  }
  if (t.kind != QN_T_MARK) {
    return 2;
  }
  qn_waiting w;
  switch (t.mark) {
  case '?':
    reduce(p, RANK_CHOICE + 1, from);
    emit(p, QN_OP_UNLESS, t.offset, 0);
    push(p, W_THEN, 0, 0, t.offset, (uint32_t)p->syntax->op_count - 1);
    next(p);
    return 0;
  case ':':
    reduce(p, RANK_CHOICE, from);
    if (top_is(p, W_THEN)) {
      qn_waiting *choice = top(p);
      w = *choice;
      emit(p, QN_OP_JUMP, t.offset, 0);
      if (!p->failed) {
        join(p, w.a);
        *choice = (qn_waiting){.kind = W_ELSE, .rank = RANK_CHOICE, .offset = w.offset, .a = (uint32_t)p->syntax->op_count - 1};
      }
      next(p);
      return 0;
    }
    if (top_is(p, W_VECTOR)) {
      qn_tell(p->reporter, QN_Q0210, t.offset, 1, NULL, QN_FLATTEN, "a range [from : to] is not supported yet");
      return -2;
    }
    return 2;
  case '[':
    push(p, W_INDEX, 0, 0, t.offset, 0);
    next(p);
    return 0;
  case '.':
    next(p);
    if (p->lexer.token.kind != QN_T_NAME) {
      expected(p, QN_Q0201, "x, y or z");
      return -1;
    }
    emit(p, QN_OP_MEMBER, t.offset, p->lexer.token.name);
    next(p);
    return 1;
  case ',':
    reduce(p, RANK_CHOICE, from);
    if (top_is(p, W_VECTOR) || top_is(p, W_CALL)) {
      top(p)->count++;
      next(p);
      return 0;
    }
    return 2;
  case ')':
    reduce(p, RANK_CHOICE, from);
    if (top_is(p, W_PAREN)) {
      p->waiting_count--;
    } else if (top_is(p, W_CALL)) {
      w = *top(p);
      p->waiting_count--;
      w.count++;
      emit_call(p, &w);
    } else {
      return 2;
    }
    next(p);
    return 1;
  case ']':
    reduce(p, RANK_CHOICE, from);
    if (top_is(p, W_VECTOR)) {
      w = *top(p);
      p->waiting_count--;
      emit(p, QN_OP_VECTOR, w.offset, w.count + 1);
    } else if (top_is(p, W_INDEX)) {
      w = *top(p);
      p->waiting_count--;
      emit(p, QN_OP_INDEX, w.offset, 0);
    } else {
      return 2;
    }
    next(p);
    return 1;
  case '=':
    if (top_is(p, W_CALL)) {
      qn_tell(p->reporter, QN_Q0201, t.offset, 1, "functions take their arguments by position", "leave the name out",
              "an argument with a name in a function call");
      return -1;
    }
    return 2;
  default:
    return 2;
  }
}

int qn_parse_expression(qn_parser *p, uint32_t *from, uint32_t *to) {
  size_t start = p->syntax->op_count;
  *from = (uint32_t)start;
  p->waiting_count = 0;
  p->joined = start;
  int state = 0, good = 1;
  while (!p->failed) {
    state = state == 1 ? after_operand(p, start) : operand(p);
    if (state == 2) {
      reduce(p, RANK_CHOICE, start);
      if (p->waiting_count == 0) {
        break;
      }
      if (top_is(p, W_THEN)) {
        expected(p, QN_Q0201, "':' and the other value of '?'");
      } else {
        unclosed(p);
      }
      good = recover(p, start, 0);
      break;
    }
    if (state < 0) {
      good = p->failed ? 0 : recover(p, start, state == -2);
      break;
    }
    if (p->lexer.failed) {
      p->failed = p->lexer.failed;
    }
  }
  *to = (uint32_t)p->syntax->op_count;
  return good && !p->failed;
}
