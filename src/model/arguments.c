/* What makers share: taking arguments, and adding nodes. */
#include "base/limits.h"
#include "model/words.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

int qn_arg_given(const qn_call *call, int parameter) {
  return call->value[parameter].kind != QN_V_UNDEF;
}

static const char *parameter_name(const qn_call *call, int parameter) {
  return call->ev->syntax->names.items[call->name[parameter]].text;
}

void qn_arg_tell(qn_call *call, qn_code code, int parameter, const char *reason, const char *way_out, const char *problem, ...) {
  char text[400];
  va_list args;
  va_start(args, problem);
  vsnprintf(text, sizeof text, problem, args);
  va_end(args);
  size_t offset = call->statement->offset, length = call->ev->syntax->names.items[call->statement->word].length;
  if (parameter >= 0 && call->place[parameter]) {
    offset = call->place[parameter];
    const char *source = call->ev->source->text;
    length = 0; /* the name of the argument, or the first character of its value */
    while (offset + length < call->ev->source->length &&
           (source[offset + length] == '_' || (source[offset + length] >= 'a' && source[offset + length] <= 'z'))) {
      length++;
    }
  }
  if (qn_codes[code].severity == QUOIN_ERROR) {
    call->bad = 1;
  }
  qn_tell(call->ev->reporter, code, offset, length, reason, way_out, "%s: %s", call->word->word, text);
}

static void wrong_type_of(qn_call *call, int parameter, const char *must, const char *way_out) {
  qn_value v = call->value[parameter];
  if (v.kind == QN_V_BAD) {
    call->bad = 1;
    return;
  }
  char reason[128];
  char text[60];
  qn_value_text(&call->ev->ctx, v, text, sizeof text);
  snprintf(reason, sizeof reason, "it is %s", text);
  qn_arg_tell(call, QN_Q0406, parameter, reason, way_out, "'%s' must be %s", parameter_name(call, parameter), must);
}
static void wrong_type(qn_call *call, int parameter, const char *must) { wrong_type_of(call, parameter, must, NULL); }

int qn_arg_item(qn_call *call, int parameter, qn_value v, qn_num *out) {
  if (v.kind == QN_V_NUMBER) {
    *out = v.u.number;
    return 1;
  }
  if (v.kind == QN_V_SPECIAL) {
    call->not_finite = parameter + 1;
    return 2;
  }
  return 0;
}

qn_num qn_arg_number(qn_call *call, int parameter, qn_num fallback) {
  qn_num n = fallback;
  if (qn_arg_given(call, parameter) && !qn_arg_item(call, parameter, call->value[parameter], &n)) {
    wrong_type(call, parameter, "a number");
  }
  return n;
}

int qn_arg_truth(qn_call *call, int parameter) {
  qn_value v = call->value[parameter];
  if (v.kind == QN_V_BOOL) {
    return v.u.truth;
  }
  if (qn_value_is_number(v)) { /* OpenSCAD takes any for false, and does not say so */
    wrong_type_of(call, parameter, "true or false", parameter == 1 ? "three sizes are a vector: [x, y, z]" : "OpenSCAD takes any number for false");
  } else if (qn_arg_given(call, parameter)) {
    wrong_type(call, parameter, "true or false");
  }
  return 0;
}

size_t qn_arg_vector(qn_call *call, int parameter, size_t least, size_t most, int scalar, qn_num *out) {
  qn_value v = call->value[parameter];
  if (!qn_arg_given(call, parameter)) {
    return 0;
  }
  if (scalar && qn_value_is_number(v)) {
    qn_num n = out[0];
    qn_arg_item(call, parameter, v, &n);
    for (size_t i = 0; i < most; i++) {
      out[i] = n;
    }
    return most;
  }
  int good = v.kind == QN_V_VECTOR && v.count >= least && v.count <= most;
  for (size_t i = 0; good && i < v.count; i++) {
    good = qn_arg_item(call, parameter, v.u.items[i], &out[i]) != 0;
  }
  if (!good) {
    char must[80];
    const char *first = scalar ? "a number or " : "";
    if (least == most) {
      snprintf(must, sizeof must, "%sa vector of %zu numbers", first, most);
    } else {
      snprintf(must, sizeof must, "%sa vector of %zu %s %zu numbers", first, least, most - least == 1 ? "or" : "to", most);
    }
    wrong_type(call, parameter, must);
    return 0;
  }
  return v.count;
}

const char *qn_arg_string(qn_call *call, int parameter, size_t *length) {
  qn_value v = call->value[parameter];
  *length = v.count;
  if (v.kind == QN_V_STRING) {
    return v.u.text;
  }
  if (qn_arg_given(call, parameter)) {
    wrong_type(call, parameter, "a string");
  }
  return NULL;
}

double qn_arg_finite(qn_call *call, int parameter, qn_num n) {
  const double v = qn_num_to_double(n);
  if (!isfinite(v)) {
    qn_arg_tell(call, QN_Q0508, parameter, "what a picture takes is at most 1.79e308", "write a smaller number", "a number is too large");
    return 0;
  }
  return v;
}

double qn_arg_double(qn_call *call, int parameter, double fallback) {
  if (!qn_arg_given(call, parameter)) {
    return fallback;
  }
  return qn_arg_finite(call, parameter, qn_arg_number(call, parameter, QN_NUM_ZERO));
}

static void size_told(qn_call *call, int parameter, const char *what, qn_num n) {
  char text[60];
  qn_value_text(&call->ev->ctx, qn_value_number(n), text, sizeof text);
  if (!call->empty && !call->bad) {
    qn_arg_tell(call, QN_Q0501, parameter, NULL, NULL, "%s is %s, so the solid is empty", what, text);
  }
  call->empty = 1;
}

void qn_arg_positive(qn_call *call, int parameter, const char *what, qn_num n) {
  if (qn_num_sign(n) <= 0) {
    size_told(call, parameter, what, n);
  }
}

void qn_arg_not_negative(qn_call *call, int parameter, const char *what, qn_num n) {
  if (qn_num_sign(n) < 0) {
    size_told(call, parameter, what, n);
  }
}

/* A number as the model keeps it; 0 when it is too large, which is told. */
static int keep(qn_call *call, qn_num n, qn_num *out) {
  *out = n;
  if (n.kind == QN_NUM_SMALL) {
    return 1; /* its exponents have 16 bits */
  }
  if (qn_int_bits(n.u.big->num) > QN_MAX_KEPT_BITS || qn_int_bits(n.u.big->den) > QN_MAX_KEPT_BITS) {
    qn_arg_tell(call, QN_Q0904, -1, "an argument has more than 32768 bits", "use fewer digits", "exact number too large");
    *out = QN_NUM_ZERO;
    return 0;
  }
  qn_ctx_spend(&call->ev->ctx, n.u.big->num.n < 0 ? (size_t)-n.u.big->num.n : (size_t)n.u.big->num.n, QN_EFFORT_ELEMENT);
  qn_ctx_spend(&call->ev->ctx, (size_t)n.u.big->den.n, QN_EFFORT_ELEMENT);
  *out = qn_num_copy(&call->ev->model->ctx, n);
  return 1;
}

uint32_t qn_call_node(qn_call *call, qn_node_kind kind, uint32_t payload, const qn_num *numbers, size_t count) {
  qn_evaluator *ev = call->ev;
  qn_num few[32], *kept = few;
  if (count > 32) {
    kept = qn_arena_take(&ev->ctx.arena, count * sizeof *kept);
    if (!kept) {
      ev->failed = QUOIN_E_MEMORY;
      return QN_NO_NODE;
    }
  }
  for (size_t i = 0; i < count; i++) {
    if (!keep(call, numbers[i], &kept[i])) {
      return QN_NO_NODE;
    }
  }
  uint32_t node = qn_solid_add(ev->model, call->parent, kind, payload, call->loc, count ? kept : NULL, count);
  if (node == QN_NO_NODE || ev->model->ctx.failed) {
    ev->failed = QUOIN_E_MEMORY;
  }
  return node;
}

uint32_t qn_call_empty(qn_call *call) {
  return qn_call_node(call, QN_NODE_UNION, 0, NULL, 0);
}

/* An intersection whose first operand is empty stays empty, whatever is added. */
uint32_t qn_call_void(qn_call *call) {
  uint32_t node = qn_call_node(call, QN_NODE_INTERSECTION, 0, NULL, 0);
  if (node != QN_NO_NODE) {
    uint32_t parent = call->parent;
    call->parent = node;
    qn_call_empty(call);
    call->parent = parent;
  }
  return node;
}

int qn_call_hindered(qn_call *call) {
  if (call->bad) {
    return 1;
  }
  if (call->not_finite) {
    int parameter = call->not_finite - 1;
    qn_arg_tell(call, QN_Q0502, parameter, NULL, NULL, "'%s' is not finite, so the solid is empty", parameter_name(call, parameter));
    return 1;
  }
  return call->empty;
}

uint32_t qn_call_leaf(qn_call *call, qn_prim prim, const qn_num *numbers, size_t count) {
  if (qn_call_hindered(call)) {
    return qn_call_empty(call);
  }
  if (call->ev->model->leaf_count >= QN_MAX_LEAVES) {
    qn_arg_tell(call, QN_Q0906, -1, "at most 268435456 in one model", NULL, "too many primitives");
    return QN_NO_NODE;
  }
  return qn_call_node(call, QN_NODE_LEAF, (uint32_t)prim, numbers, count);
}
