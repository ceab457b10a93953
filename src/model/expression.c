/* Runs an expression's postfix code on a stack. */
#include "model/evaluate.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void unknown_name(qn_evaluator *ev, const qn_op *op) {
  const qn_name *name = &ev->syntax->names.items[op->a];
  if (ev->syntax->includes) {
    return; /* it may come from a file that was not read; that was told */
  }
  const char *best = NULL;
  unsigned most = name->length <= 3 ? 1 : 2, least = most + 1;
  for (size_t i = QN_WORD_COUNT; i < ev->name_count; i++) {
    const qn_name *other = &ev->syntax->names.items[i];
    if (ev->bindings[i].bound && i != op->a && other->length + 2 >= name->length && other->length <= name->length + 2) {
      unsigned d = qn_names_distance(name->text, other->text, most);
      if (d < least) {
        least = d;
        best = other->text;
      }
    }
  }
  char way_out[128];
  if (ev->words[op->a]) {
    snprintf(way_out, sizeof way_out, "solids are not values");
  } else if (best) {
    snprintf(way_out, sizeof way_out, "did you mean '%.60s'?", best);
  } else {
    snprintf(way_out, sizeof way_out, "assign it first: %.40s = ...;", name->text);
  }
  qn_tell(ev->reporter, QN_Q0301, op->offset, name->length, NULL, way_out, "unknown name '%.60s'", name->text);
}

static qn_value load(qn_evaluator *ev, const qn_op *op) {
  qn_binding *b = &ev->bindings[op->a];
  if (b->bound) {
    return b->value;
  }
  const qn_name *name = &ev->syntax->names.items[op->a];
  if (b->later) {
    qn_loc loc = qn_source_loc(ev->source, b->later - 1, &ev->hint);
    char reason[64];
    snprintf(reason, sizeof reason, "it is assigned on line %u", (unsigned)loc.line);
    qn_tell(ev->reporter, QN_Q0302, op->offset, name->length, reason, "move that assignment up",
            "'%.60s' is used before its value is known", name->text);
    return QN_BAD;
  }
  if (strcmp(name->text, "inf") == 0 || strcmp(name->text, "nan") == 0) { /* what OpenSCAD writes for such numbers into a flat file */
    return qn_value_double(&ev->ctx, name->text[0] == 'i' ? INFINITY : NAN);
  }
  unknown_name(ev, op);
  return QN_BAD;
}

static qn_value small(const qn_op *op) {
  return qn_value_number((qn_num){.u.m = (int32_t)op->a, .a = op->e2, .b = op->e5, .kind = QN_NUM_SMALL});
}

int qn_too_much(qn_evaluator *ev, uint32_t offset) {
  if (ev->ctx.effort <= ev->ctx.max_effort) {
    return 0;
  }
  qn_tell(ev->reporter, QN_Q0910, offset, 1, "its cost is out of proportion to the length of the text", "write fewer and shorter values", "too much arithmetic");
  ev->reporter->stop = 1;
  return 1;
}

qn_value qn_evaluate_expression(qn_evaluator *ev, uint32_t from, uint32_t to) {
  const qn_op *ops = ev->syntax->ops;
  if (to - from == 1 && ops[from].kind == QN_OP_SMALL) { /* most arguments */
    return small(&ops[from]);
  }
  size_t base = ev->stack_count;
  for (uint32_t at = from; at < to; at++) {
    const qn_op *op = &ops[at];
    if (!qn_grow(ev->mem, &ev->stack, &ev->stack_capacity, ev->stack_count + 1)) {
      ev->failed = QUOIN_E_MEMORY;
      break;
    }
    qn_value *top = ev->stack + ev->stack_count; /* one above; the code is well formed, so the operands are there */
    const qn_name *name;
    switch ((qn_op_kind)op->kind) {
    case QN_OP_SMALL:
      *top = small(op);
      ev->stack_count++;
      continue;
    case QN_OP_NUMBER:
      *top = qn_value_number(ev->syntax->numbers[op->a]);
      ev->stack_count++;
      continue;
    case QN_OP_STRING:
      name = &ev->syntax->names.items[op->a];
      *top = (qn_value){.kind = QN_V_STRING, .count = name->length, .u.text = name->text};
      ev->stack_count++;
      continue;
    case QN_OP_TRUE:
    case QN_OP_FALSE:
      *top = qn_value_bool(op->kind == QN_OP_TRUE);
      ev->stack_count++;
      continue;
    case QN_OP_UNDEF:
      *top = QN_UNDEF;
      ev->stack_count++;
      continue;
    case QN_OP_BAD:
      *top = QN_BAD;
      ev->stack_count++;
      continue;
    case QN_OP_LOAD:
      *top = load(ev, op);
      ev->stack_count++;
      continue;
    case QN_OP_VECTOR: {
      qn_value v = qn_value_vector(&ev->ctx, top - op->a, op->a);
      if (v.kind == QN_V_BAD) {
        int told = 0;
        for (size_t i = 0; i < op->a; i++) {
          told |= (top - op->a)[i].kind == QN_V_BAD;
        }
        if (!told) {
          qn_tell(ev->reporter, QN_Q0901, op->offset, 1, "at most 64 vectors within one another", NULL, "nested too deeply");
        }
      }
      ev->stack_count -= op->a;
      ev->stack[ev->stack_count++] = v;
      break;
    }
    case QN_OP_CALL: {
      const qn_call_site *call = &ev->syntax->calls[op->a];
      qn_value v = qn_call_function(ev, call->name, op->offset, top - call->arguments, call->arguments);
      ev->stack_count -= call->arguments;
      ev->stack[ev->stack_count++] = v;
      break;
    }
    case QN_OP_INDEX:
      top[-2] = qn_index(ev, op->offset, top[-2], top[-1]);
      ev->stack_count--;
      break;
    case QN_OP_MEMBER:
      top[-1] = qn_member(ev, op->offset, top[-1], op->a);
      break;
    case QN_OP_NEGATE:
    case QN_OP_PLUS:
      top[-1] = qn_operate_unary(ev, (qn_op_kind)op->kind, op->offset, top[-1]);
      break;
    case QN_OP_NOT:
      top[-1] = top[-1].kind == QN_V_BAD ? QN_BAD : qn_value_bool(!qn_value_truth(top[-1]));
      break;
    case QN_OP_ADD:
    case QN_OP_SUBTRACT:
    case QN_OP_MULTIPLY:
    case QN_OP_DIVIDE:
    case QN_OP_REMAINDER:
    case QN_OP_POWER:
    case QN_OP_LESS:
    case QN_OP_LESS_EQUAL:
    case QN_OP_GREATER:
    case QN_OP_GREATER_EQUAL:
    case QN_OP_EQUAL:
    case QN_OP_NOT_EQUAL:
      top[-2] = qn_operate(ev, (qn_op_kind)op->kind, op->offset, top[-2], top[-1]);
      ev->stack_count--;
      break;
    case QN_OP_BOOL:
      top[-1] = top[-1].kind == QN_V_BAD ? QN_BAD : qn_value_bool(qn_value_truth(top[-1]));
      break;
    case QN_OP_AND:
    case QN_OP_OR:
      if (top[-1].kind == QN_V_BAD || qn_value_truth(top[-1]) == (op->kind == QN_OP_OR)) {
        if (top[-1].kind != QN_V_BAD) {
          top[-1] = qn_value_bool(op->kind == QN_OP_OR);
        }
        at = op->a - 1;
      } else {
        ev->stack_count--;
      }
      break;
    case QN_OP_UNLESS:
      ev->stack_count--;
      if (top[-1].kind == QN_V_BAD) { /* neither branch is known: the whole choice is in error */
        uint32_t end = ops[op->a - 1].a;
        top[-1] = QN_BAD;
        ev->stack_count++;
        at = end - 1;
      } else if (!qn_value_truth(top[-1])) {
        at = op->a - 1;
      }
      break;
    case QN_OP_JUMP:
      at = op->a - 1;
      break;
    }
    if (ev->ctx.failed == QUOIN_E_LIMIT) {
      if (qn_too_much(ev, op->offset)) {
        ev->stack_count = base;
        break;
      }
      ev->ctx.failed = QUOIN_OK;
      qn_tell(ev->reporter, QN_Q0904, op->offset, 1, "an exact result of more than 131072 bits", "use smaller exponents",
              "exact number too large");
      ev->stack[ev->stack_count - 1] = QN_BAD;
    } else if (ev->ctx.failed) {
      ev->failed = ev->ctx.failed;
      break;
    }
  }
  qn_value result = !ev->failed && ev->stack_count > base ? ev->stack[ev->stack_count - 1] : QN_BAD;
  ev->stack_count = base;
  return result;
}
