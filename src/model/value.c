#include "model/value.h"

#include "base/limits.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

qn_value qn_value_double(qn_ctx *ctx, double d) {
  if (isfinite(d)) {
    return qn_value_number(qn_num_from_double(ctx, d));
  }
  return (qn_value){.kind = QN_V_SPECIAL, .u.special = d};
}

qn_value qn_value_vector(qn_ctx *ctx, const qn_value *items, size_t count) {
  uint8_t depth = 0;
  for (size_t i = 0; i < count; i++) {
    if (items[i].kind == QN_V_BAD) {
      return QN_BAD;
    }
    if (items[i].kind == QN_V_VECTOR && items[i].depth > depth) {
      depth = items[i].depth;
    }
  }
  if (depth >= QN_MAX_VECTOR_DEPTH) {
    return QN_BAD;
  }
  qn_value *copy = qn_arena_take(&ctx->arena, count * sizeof *copy);
  if (!copy) {
    ctx->failed = QUOIN_E_MEMORY;
    return QN_UNDEF;
  }
  if (count) {
    memcpy(copy, items, count * sizeof *copy);
  }
  return (qn_value){.kind = QN_V_VECTOR, .depth = (uint8_t)(depth + 1), .count = (uint32_t)count, .u.items = copy};
}

int qn_value_truth(qn_value v) {
  switch ((qn_value_kind)v.kind) {
  case QN_V_BOOL: return v.u.truth;
  case QN_V_NUMBER: return !qn_num_is_zero(v.u.number);
  case QN_V_SPECIAL: return 1;
  case QN_V_STRING:
  case QN_V_VECTOR: return v.count > 0;
  case QN_V_UNDEF:
  case QN_V_BAD: break;
  }
  return 0;
}

/* NOLINTNEXTLINE(misc-no-recursion): no deeper than QN_MAX_VECTOR_DEPTH */
int qn_value_equal(qn_ctx *ctx, qn_value a, qn_value b) {
  if (a.kind != b.kind) {
    return 0;
  }
  switch ((qn_value_kind)a.kind) {
  case QN_V_BOOL: return a.u.truth == b.u.truth;
  case QN_V_NUMBER: return qn_num_cmp(ctx, a.u.number, b.u.number) == 0;
  case QN_V_SPECIAL: return a.u.special == b.u.special;
  case QN_V_STRING: return a.count == b.count && qn_ctx_spend(ctx, a.count, 1) && memcmp(a.u.text, b.u.text, a.count) == 0;
  case QN_V_VECTOR:
    if (a.count != b.count || !qn_ctx_spend(ctx, a.count, QN_EFFORT_ELEMENT / 4)) {
      return 0;
    }
    for (size_t i = 0; i < a.count; i++) {
      if (!qn_value_equal(ctx, a.u.items[i], b.u.items[i])) {
        return 0;
      }
    }
    return 1;
  case QN_V_UNDEF:
  case QN_V_BAD: break;
  }
  return 1;
}

const char *qn_value_what(qn_value v) {
  switch ((qn_value_kind)v.kind) {
  case QN_V_BOOL: return v.u.truth ? "true" : "false";
  case QN_V_NUMBER: return "a number";
  case QN_V_SPECIAL: return isnan(v.u.special) ? "nan" : v.u.special > 0 ? "inf" : "-inf";
  case QN_V_STRING: return "a string";
  case QN_V_VECTOR: return "a vector";
  case QN_V_UNDEF:
  case QN_V_BAD: break;
  }
  return "undef";
}

typedef struct out { char *text; size_t size, length; } out;

static void put(out *o, const char *text, size_t n) {
  for (size_t i = 0; i < n && o->length + 1 < o->size; i++) {
    o->text[o->length++] = text[i];
  }
}

/* NOLINTNEXTLINE(misc-no-recursion): no deeper than QN_MAX_VECTOR_DEPTH */
static void put_value(qn_ctx *ctx, out *o, qn_value v) {
  const char *text;
  switch ((qn_value_kind)v.kind) {
  case QN_V_NUMBER:
    if (qn_num_is_rounded(v.u.number)) { /* exactly it is a fraction of some eighty digits */
      char digits[32] = "";
      snprintf(digits, sizeof digits, "%.17g", qn_num_to_double(v.u.number));
      put(o, digits, strlen(digits));
      break;
    }
    text = qn_num_text(ctx, v.u.number);
    put(o, text ? text : "?", text ? strlen(text) : 1);
    break;
  case QN_V_STRING:
    put(o, "\"", 1);
    for (size_t i = 0; i < v.count; i++) { /* a message is one line */
      const char c = v.u.text[i];
      const char *escaped = c == '\n' ? "\\n" : c == '\r' ? "\\r" : c == '\t' ? "\\t" : NULL;
      put(o, escaped ? escaped : (unsigned char)c < 32 || c == 127 ? "?" : &v.u.text[i], escaped ? 2 : 1);
    }
    put(o, "\"", 1);
    break;
  case QN_V_VECTOR:
    put(o, "[", 1);
    for (size_t i = 0; i < v.count && o->length + 1 < o->size; i++) {
      put(o, ", ", i ? 2 : 0);
      put_value(ctx, o, v.u.items[i]);
    }
    put(o, "]", 1);
    break;
  case QN_V_BOOL:
  case QN_V_SPECIAL:
  case QN_V_UNDEF:
  case QN_V_BAD:
    text = qn_value_what(v);
    put(o, text, strlen(text));
    break;
  }
}

void qn_value_text(qn_ctx *ctx, qn_value v, char *text, size_t size) {
  out o = {text, size, 0};
  put_value(ctx, &o, v);
  while (o.length > 0 && o.length + 1 == size && ((unsigned char)text[o.length - 1] & 0x80)) {
    o.length--; /* not inside a character */
  }
  text[o.length] = '\0';
}
