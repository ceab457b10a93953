/* Values of expressions. They live in the evaluator's scratch arena, or are small and own nothing. */
#ifndef QN_MODEL_VALUE_H
#define QN_MODEL_VALUE_H

#include "number/num.h"
#include "text/syntax.h"

typedef enum qn_value_kind {
  QN_V_UNDEF,
  QN_V_BAD,     /* was in error, and that has been told: whatever it meets becomes it */
  QN_V_BOOL,
  QN_V_NUMBER,
  QN_V_SPECIAL, /* inf, -inf, nan */
  QN_V_STRING,
  QN_V_VECTOR
} qn_value_kind;

typedef struct qn_value {
  uint8_t kind;
  uint8_t depth;  /* of a vector: 1 + its deepest element's, at most QN_MAX_VECTOR_DEPTH, so recursion over it is bounded */
  uint16_t unused;
  uint32_t count; /* elements of a vector, bytes of a string */
  union {
    int truth;
    qn_num number;
    double special;
    const char *text;
    const struct qn_value *items;
  } u;
} qn_value;

#define QN_UNDEF ((qn_value){.kind = QN_V_UNDEF})
#define QN_BAD ((qn_value){.kind = QN_V_BAD})

QN_INLINE qn_value qn_value_number(qn_num n) { return (qn_value){.kind = QN_V_NUMBER, .u.number = n}; }
QN_INLINE qn_value qn_value_bool(int truth) { return (qn_value){.kind = QN_V_BOOL, .u.truth = truth != 0}; }
QN_INLINE int qn_value_is_number(qn_value v) { return v.kind == QN_V_NUMBER || v.kind == QN_V_SPECIAL; }

/* A double as a value: a finite one exactly, else inf, -inf or nan. */
qn_value qn_value_double(qn_ctx *ctx, double d);

/* A vector of `count` items, copied into the arena. UNDEF when memory is refused (ctx->failed), BAD when it nests too deeply. */
qn_value qn_value_vector(qn_ctx *ctx, const qn_value *items, size_t count);

/* OpenSCAD's truth: false, 0, "", [], undef are false. */
int qn_value_truth(qn_value v);

/* a == b as OpenSCAD has it: different kinds differ, nan differs from itself. */
int qn_value_equal(qn_ctx *ctx, qn_value a, qn_value b);

/* "a number", "a vector", ... for messages. */
const char *qn_value_what(qn_value v);

/* The value as text for echo and messages, cut to size. Strings stand in quotes. */
void qn_value_text(qn_ctx *ctx, qn_value v, char *text, size_t size);

#endif
