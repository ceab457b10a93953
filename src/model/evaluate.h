/* The evaluator's state: the syntax tree on one side, the solid tree on the other. One per text that is read. */
#ifndef QN_MODEL_EVALUATE_H
#define QN_MODEL_EVALUATE_H

#include "model/solid.h"
#include "model/value.h"
#include "text/report.h"
#include "text/syntax.h"

/* What a name means now. Inner scopes shadow outer ones and put the old value back when they end. */
typedef struct qn_binding {
  qn_value value;
  uint32_t bound;  /* has a value */
  uint32_t scope;  /* the scope that saw an assignment of it last */
  uint32_t plan;   /* its place in that scope's order */
  uint32_t later;  /* offset + 1 of an assignment that has not been evaluated yet, 0: none */
} qn_binding;

typedef struct qn_undo { uint32_t name, bound; qn_value value; } qn_undo;

typedef struct qn_level {
  uint32_t statement, child; /* the next child to evaluate */
  uint32_t node;             /* where children are added */
  size_t undo;
  qn_mark mark;
} qn_level;

typedef struct qn_evaluator {
  quoin_model *model;
  qn_mem *mem;
  qn_syntax *syntax;
  const qn_source *source;
  qn_reporter *reporter;
  quoin_read_options options;
  qn_ctx ctx;              /* values; taken back when their statement ends */
  qn_value *stack;
  size_t stack_count, stack_capacity;
  qn_binding *bindings;    /* by name */
  uint16_t *words;         /* by name: row of the table of words + 1 */
  uint16_t *functions;     /* by name: row of the table of functions + 1 */
  size_t name_count, name_capacity;
  uint32_t *parameters;    /* names of all words' parameters; word i has those from parameter0[i] */
  uint16_t *parameter0;
  qn_undo *undo;
  size_t undo_count, undo_capacity;
  qn_level *levels;
  size_t level_count, level_capacity;
  qn_argument *plan;       /* of the scope being entered */
  size_t plan_count, plan_capacity;
  uint32_t scopes;         /* entered so far */
  size_t hint;             /* of qn_source_loc */
  int facets_noted;
  int camera_here, background_here; /* said in this text */
  quoin_status failed;
} qn_evaluator;

/* Evaluates a syntax tree under node `parent`. Errors are told to the reporter. QUOIN_E_MEMORY: refused. */
quoin_status qn_evaluate(quoin_model *model, uint32_t parent, qn_syntax *syntax, const qn_source *source, qn_reporter *reporter,
                         const quoin_read_options *options);

/* The value of code[from, to). (expression.c) */
qn_value qn_evaluate_expression(qn_evaluator *ev, uint32_t from, uint32_t to);

/* Whether the text has asked for too much arithmetic, which is told, and ends the reading. (expression.c) */
int qn_too_much(qn_evaluator *ev, uint32_t offset);

/* Operators and functions (operate.c, functions.c). Errors are told at `offset`, and give BAD. */
qn_value qn_operate_unary(qn_evaluator *ev, qn_op_kind op, uint32_t offset, qn_value a);
qn_value qn_operate(qn_evaluator *ev, qn_op_kind op, uint32_t offset, qn_value a, qn_value b);
qn_value qn_index(qn_evaluator *ev, uint32_t offset, qn_value v, qn_value i);
qn_value qn_member(qn_evaluator *ev, uint32_t offset, qn_value v, uint32_t name);
qn_value qn_number_operate(qn_ctx *ctx, qn_op_kind op, qn_value a, qn_value b); /* of two numbers, special ones included */
int qn_number_compare(qn_ctx *ctx, qn_value a, qn_value b);                     /* -1, 0, 1; 2 when one is nan */
qn_value qn_call_function(qn_evaluator *ev, uint32_t name, uint32_t offset, const qn_value *arguments, size_t count);
QN_NODISCARD int qn_functions_init(qn_evaluator *ev); /* fills ev->functions */
const char *qn_functions_near(const char *name);      /* the function a misspelt name may mean, or null */
extern const size_t qn_function_count;

/* Words and arguments (words.c, arguments.c). */
QN_NODISCARD int qn_words_init(qn_evaluator *ev); /* interns the table's names; must come before bindings are made */

/* Binds a name until the level that is open now ends. */
void qn_bind(qn_evaluator *ev, uint32_t name, qn_value value);

#endif
