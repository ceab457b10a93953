/* Operators, with OpenSCAD's meaning on exact numbers. What OpenSCAD makes undef with a warning is an error here: it would
   become a wrong solid. */
#include "base/limits.h"
#include "model/evaluate.h"

#include <math.h>
#include <string.h>

/* A finite number as a double that has its sign and lies on its side of 1: all that matters beside an infinity. */
static double stand_in(qn_ctx *ctx, qn_value v) {
  if (v.kind == QN_V_SPECIAL) {
    return v.u.special;
  }
  int sign = qn_num_sign(v.u.number);
  int against_one = qn_num_cmp(ctx, qn_num_abs(ctx, v.u.number), QN_NUM_ONE);
  return sign * (against_one < 0 ? 0.5 : against_one == 0 ? 1.0 : 2.0);
}

static qn_value special(double d) {
  return (qn_value){.kind = QN_V_SPECIAL, .u.special = d};
}

/* At least one operand is inf, -inf or nan: IEEE 754's rules on stand-ins. A finite result is exact: 0, 1 or an operand. */
static qn_value special_operate(qn_ctx *ctx, qn_op_kind op, qn_value va, qn_value vb) {
  double a = stand_in(ctx, va), b = stand_in(ctx, vb);
  switch (op) {
  case QN_OP_ADD: return special(a + b);
  case QN_OP_SUBTRACT: return special(a - b);
  case QN_OP_MULTIPLY: return special(a * b);
  case QN_OP_DIVIDE: return qn_value_double(ctx, a / b);
  case QN_OP_REMAINDER: return va.kind == QN_V_NUMBER && isinf(b) ? va : special((double)NAN);
  default: return qn_value_double(ctx, pow(a, b));
  }
}

qn_value qn_number_operate(qn_ctx *ctx, qn_op_kind op, qn_value a, qn_value b) {
  if (a.kind == QN_V_SPECIAL || b.kind == QN_V_SPECIAL) {
    return special_operate(ctx, op, a, b);
  }
  qn_num x = a.u.number, y = b.u.number, z;
  switch (op) {
  case QN_OP_ADD: return qn_value_number(qn_num_add(ctx, x, y));
  case QN_OP_SUBTRACT: return qn_value_number(qn_num_sub(ctx, x, y));
  case QN_OP_MULTIPLY: return qn_value_number(qn_num_mul(ctx, x, y));
  case QN_OP_DIVIDE:
    if (qn_num_is_zero(y)) {
      int sign = qn_num_sign(x);
      return special(sign ? sign * (double)INFINITY : (double)NAN);
    }
    return qn_value_number(qn_num_div(ctx, x, y));
  case QN_OP_REMAINDER:
    return qn_num_is_zero(y) ? special((double)NAN) : qn_value_number(qn_num_mod(ctx, x, y));
  default:
    if (qn_num_pow(ctx, x, y, &z)) {
      return qn_value_number(z);
    }
    return special(qn_num_is_zero(x) ? (double)INFINITY : (double)NAN);
  }
}

int qn_number_compare(qn_ctx *ctx, qn_value a, qn_value b) {
  if (a.kind == QN_V_NUMBER && b.kind == QN_V_NUMBER) {
    return qn_num_cmp(ctx, a.u.number, b.u.number);
  }
  double x = stand_in(ctx, a), y = stand_in(ctx, b);
  return isnan(x) || isnan(y) ? 2 : (x > y) - (x < y);
}

static const char *symbol(qn_op_kind op) {
  switch (op) {
  case QN_OP_ADD: return "+";
  case QN_OP_SUBTRACT:
  case QN_OP_NEGATE: return "-";
  case QN_OP_PLUS: return "+";
  case QN_OP_MULTIPLY: return "*";
  case QN_OP_DIVIDE: return "/";
  case QN_OP_REMAINDER: return "%";
  case QN_OP_POWER: return "^";
  case QN_OP_LESS: return "<";
  case QN_OP_LESS_EQUAL: return "<=";
  case QN_OP_GREATER: return ">";
  case QN_OP_GREATER_EQUAL: return ">=";
  default: return "?";
  }
}

static qn_value undefined(qn_evaluator *ev, qn_op_kind op, uint32_t offset, qn_value a, qn_value b, const char *reason) {
  if (a.kind != QN_V_BAD && b.kind != QN_V_BAD) {
    qn_tell(ev->reporter, QN_Q0305, offset, 1, reason, NULL, "'%s' is not defined for %s and %s", symbol(op), qn_value_what(a),
            qn_value_what(b));
  }
  return QN_BAD;
}

/* A vector of n values to be filled in; null when memory or the effort is refused. */
static qn_value *room(qn_evaluator *ev, size_t n) {
  if (!qn_ctx_spend(&ev->ctx, n, QN_EFFORT_ELEMENT)) {
    return NULL;
  }
  qn_value *items = qn_arena_take(&ev->ctx.arena, n * sizeof *items);
  if (!items) {
    ev->ctx.failed = QUOIN_E_MEMORY;
  }
  return items;
}

static int all_numbers(qn_value v) {
  for (size_t i = 0; i < v.count; i++) {
    if (!qn_value_is_number(v.u.items[i])) {
      return 0;
    }
  }
  return 1;
}

/* The sum of a[i] b[i], n of them; `stride`: b's items are rows, of which element `column` is meant. */
static qn_value dot(qn_evaluator *ev, const qn_value *a, const qn_value *b, size_t n, int rows, size_t column) {
  qn_mark mark = qn_arena_mark(&ev->ctx.arena);
  if (!qn_ctx_spend(&ev->ctx, n, QN_EFFORT_ELEMENT)) {
    return QN_BAD;
  }
  qn_num *x = qn_arena_take(&ev->ctx.arena, 2 * n * sizeof *x);
  if (!x) {
    ev->ctx.failed = QUOIN_E_MEMORY;
    return QN_BAD;
  }
  qn_num *y = x + n;
  int finite = 1;
  for (size_t i = 0; i < n; i++) {
    const qn_value *bi = rows ? &b[i].u.items[column] : &b[i];
    finite &= a[i].kind == QN_V_NUMBER && bi->kind == QN_V_NUMBER;
    x[i] = a[i].u.number;
    y[i] = bi->u.number;
  }
  if (finite) {
    qn_num sum = qn_num_dot(&ev->ctx, n, x, y);
    if (sum.kind == QN_NUM_SMALL) {
      qn_arena_release(&ev->ctx.arena, mark);
    }
    return qn_value_number(sum);
  }
  qn_arena_release(&ev->ctx.arena, mark);
  qn_value sum = qn_value_number(QN_NUM_ZERO);
  for (size_t i = 0; i < n; i++) {
    qn_value bi = rows ? b[i].u.items[column] : b[i];
    sum = qn_number_operate(&ev->ctx, QN_OP_ADD, sum, qn_number_operate(&ev->ctx, QN_OP_MULTIPLY, a[i], bi));
  }
  return sum;
}

/* Columns of a matrix of numbers, 0 when it is none. */
static size_t columns(qn_value m) {
  size_t n = m.count ? m.u.items[0].count : 0;
  for (size_t i = 0; i < m.count; i++) {
    if (m.u.items[i].kind != QN_V_VECTOR || m.u.items[i].count != n || !all_numbers(m.u.items[i])) {
      return 0;
    }
  }
  return n;
}

/* Dot product, matrix times vector, vector times matrix, matrix times matrix. */
static qn_value product(qn_evaluator *ev, uint32_t offset, qn_value a, qn_value b) {
  const char *sizes = "their sizes do not fit";
  if (a.count && b.count && all_numbers(a) && all_numbers(b)) {
    return a.count == b.count ? dot(ev, a.u.items, b.u.items, a.count, 0, 0)
                              : undefined(ev, QN_OP_MULTIPLY, offset, a, b, "a dot product needs vectors of one length");
  }
  size_t na = columns(a), nb = columns(b);
  if (na && b.count == na && all_numbers(b)) {
    qn_value *items = room(ev, a.count);
    for (size_t i = 0; items && i < a.count && !ev->ctx.failed; i++) {
      items[i] = dot(ev, a.u.items[i].u.items, b.u.items, na, 0, 0);
    }
    return items && !ev->ctx.failed ? qn_value_vector(&ev->ctx, items, a.count) : QN_BAD;
  }
  if (nb && a.count == b.count && all_numbers(a)) {
    qn_value *items = room(ev, nb);
    for (size_t j = 0; items && j < nb && !ev->ctx.failed; j++) {
      items[j] = dot(ev, a.u.items, b.u.items, a.count, 1, j);
    }
    return items && !ev->ctx.failed ? qn_value_vector(&ev->ctx, items, nb) : QN_BAD;
  }
  if (na && nb && na == b.count) {
    qn_value *rows = room(ev, a.count), *items = room(ev, nb);
    for (size_t i = 0; rows && items && i < a.count && !ev->ctx.failed; i++) {
      for (size_t j = 0; j < nb && !ev->ctx.failed; j++) {
        items[j] = dot(ev, a.u.items[i].u.items, b.u.items, na, 1, j);
      }
      rows[i] = ev->ctx.failed ? QN_BAD : qn_value_vector(&ev->ctx, items, nb);
    }
    return rows && items && !ev->ctx.failed ? qn_value_vector(&ev->ctx, rows, a.count) : QN_BAD;
  }
  return undefined(ev, QN_OP_MULTIPLY, offset, a, b, sizes);
}

/* Element by element: two vectors, or a vector and a number on either side. Depth is at most QN_MAX_VECTOR_DEPTH. */
/* NOLINTNEXTLINE(misc-no-recursion): no deeper than QN_MAX_VECTOR_DEPTH */
static qn_value each(qn_evaluator *ev, qn_op_kind op, uint32_t offset, qn_value a, qn_value b) {
  size_t n = a.kind == QN_V_VECTOR ? a.count : b.count;
  qn_value *items = room(ev, n);
  if (!items) {
    return QN_BAD;
  }
  for (size_t i = 0; i < n; i++) {
    items[i] = qn_operate(ev, op, offset, a.kind == QN_V_VECTOR ? a.u.items[i] : a, b.kind == QN_V_VECTOR ? b.u.items[i] : b);
    if (items[i].kind == QN_V_BAD) {
      return QN_BAD;
    }
  }
  return qn_value_vector(&ev->ctx, items, n);
}

static qn_value compare(qn_evaluator *ev, qn_op_kind op, uint32_t offset, qn_value a, qn_value b) {
  int c;
  if (qn_value_is_number(a) && qn_value_is_number(b)) {
    c = qn_number_compare(&ev->ctx, a, b);
    if (c == 2) {
      return qn_value_bool(0);
    }
  } else if (a.kind == QN_V_STRING && b.kind == QN_V_STRING) {
    size_t n = a.count < b.count ? a.count : b.count;
    c = qn_ctx_spend(&ev->ctx, n, 1) ? memcmp(a.u.text, b.u.text, n) : 0;
    c = c ? c : (a.count > b.count) - (a.count < b.count);
  } else if (a.kind == QN_V_BOOL && b.kind == QN_V_BOOL) {
    c = a.u.truth - b.u.truth;
  } else {
    return undefined(ev, op, offset, a, b, NULL);
  }
  switch (op) {
  case QN_OP_LESS: return qn_value_bool(c < 0);
  case QN_OP_LESS_EQUAL: return qn_value_bool(c <= 0);
  case QN_OP_GREATER: return qn_value_bool(c > 0);
  default: return qn_value_bool(c >= 0);
  }
}

/* NOLINTNEXTLINE(misc-no-recursion): no deeper than QN_MAX_VECTOR_DEPTH */
qn_value qn_operate(qn_evaluator *ev, qn_op_kind op, uint32_t offset, qn_value a, qn_value b) {
  if (a.kind == QN_V_BAD || b.kind == QN_V_BAD) {
    return QN_BAD;
  }
  int number_a = qn_value_is_number(a), number_b = qn_value_is_number(b);
  int vector_a = a.kind == QN_V_VECTOR, vector_b = b.kind == QN_V_VECTOR;
  switch (op) {
  case QN_OP_EQUAL: return qn_value_bool(qn_value_equal(&ev->ctx, a, b));
  case QN_OP_NOT_EQUAL: return qn_value_bool(!qn_value_equal(&ev->ctx, a, b));
  case QN_OP_LESS:
  case QN_OP_LESS_EQUAL:
  case QN_OP_GREATER:
  case QN_OP_GREATER_EQUAL: return compare(ev, op, offset, a, b);
  default: break;
  }
  if (number_a && number_b) {
    return qn_number_operate(&ev->ctx, op, a, b);
  }
  switch (op) {
  case QN_OP_ADD:
  case QN_OP_SUBTRACT:
    if (vector_a && vector_b) {
      return a.count == b.count ? each(ev, op, offset, a, b)
                                : undefined(ev, op, offset, a, b, "the vectors differ in length");
    }
    break;
  case QN_OP_MULTIPLY:
    if (vector_a && vector_b) {
      return product(ev, offset, a, b);
    }
    if ((vector_a && number_b) || (number_a && vector_b)) {
      return each(ev, op, offset, a, b);
    }
    break;
  case QN_OP_DIVIDE:
    if ((vector_a && number_b) || (number_a && vector_b)) {
      return each(ev, op, offset, a, b);
    }
    break;
  default:
    break;
  }
  return undefined(ev, op, offset, a, b, NULL);
}

/* NOLINTNEXTLINE(misc-no-recursion): no deeper than QN_MAX_VECTOR_DEPTH */
qn_value qn_operate_unary(qn_evaluator *ev, qn_op_kind op, uint32_t offset, qn_value a) {
  switch (a.kind) {
  case QN_V_BAD: return QN_BAD;
  case QN_V_NUMBER:
    if (op == QN_OP_NEGATE) {
      a.u.number = qn_num_neg(&ev->ctx, a.u.number);
    }
    return a;
  case QN_V_SPECIAL:
    if (op == QN_OP_NEGATE) {
      a.u.special = -a.u.special;
    }
    return a;
  case QN_V_VECTOR: {
    qn_value *items = room(ev, a.count);
    if (!items) {
      return QN_BAD;
    }
    for (size_t i = 0; i < a.count && !ev->ctx.failed; i++) {
      items[i] = qn_operate_unary(ev, op, offset, a.u.items[i]);
    }
    if (ev->ctx.failed) {
      return QN_BAD;
    }
    return qn_value_vector(&ev->ctx, items, a.count);
  }
  default:
    qn_tell(ev->reporter, QN_Q0305, offset, 1, NULL, NULL, "'%s' is not defined for %s", symbol(op), qn_value_what(a));
    return QN_BAD;
  }
}

qn_value qn_index(qn_evaluator *ev, uint32_t offset, qn_value v, qn_value i) {
  if (v.kind == QN_V_BAD || i.kind == QN_V_BAD) {
    return QN_BAD;
  }
  if ((v.kind != QN_V_VECTOR && v.kind != QN_V_STRING) || i.kind != QN_V_NUMBER) {
    qn_tell(ev->reporter, QN_Q0305, offset, 1, NULL, NULL, "%s cannot be indexed with %s", qn_value_what(v), qn_value_what(i));
    return QN_BAD;
  }
  int64_t n;
  qn_num whole = qn_num_floor(&ev->ctx, i.u.number); /* OpenSCAD takes the whole part */
  int fits = qn_num_is_integer(whole, &n) && n >= 0;
  if (v.kind == QN_V_STRING) {
    size_t at = 0;
    if (!qn_ctx_spend(&ev->ctx, v.count, QN_EFFORT_BYTE)) {
      return QN_BAD;
    }
    for (int64_t c = 0; fits && at < v.count; c++) { /* characters, not bytes */
      size_t end = at + 1;
      while (end < v.count && ((unsigned char)v.u.text[end] & 0xC0) == 0x80) {
        end++;
      }
      if (c == n) {
        return (qn_value){.kind = QN_V_STRING, .count = (uint32_t)(end - at), .u.text = v.u.text + at};
      }
      at = end;
    }
  } else if (fits && n < (int64_t)v.count) {
    return v.u.items[n];
  }
  char text[40];
  qn_value_text(&ev->ctx, i, text, sizeof text);
  qn_tell(ev->reporter, QN_Q0306, offset, 1, "the first element is [0]", NULL, "index %s is out of range", text);
  return QN_BAD;
}

qn_value qn_member(qn_evaluator *ev, uint32_t offset, qn_value v, uint32_t name) {
  if (v.kind == QN_V_BAD) {
    return QN_BAD;
  }
  const char *text = ev->syntax->names.items[name].text;
  if (v.kind != QN_V_VECTOR || text[0] < 'x' || text[0] > 'z' || text[1]) {
    qn_tell(ev->reporter, QN_Q0305, offset, 1, "a vector has .x, .y and .z", NULL, "%s has no member '%.60s'", qn_value_what(v), text);
    return QN_BAD;
  }
  size_t n = (size_t)(text[0] - 'x');
  if (n < v.count) {
    return v.u.items[n];
  }
  qn_tell(ev->reporter, QN_Q0306, offset, 1, NULL, NULL, "a vector of %u has no .%c", (unsigned)v.count, text[0]);
  return QN_BAD;
}
