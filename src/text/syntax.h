/* The syntax tree: statements in one array, their arguments and assignments in others, and every expression as a
   stretch of postfix code, so that reading and evaluating are loops. Places are offsets in the source.

   1,000,000 `translate([x, y, z]) sphere(r = 1);` take about 230 MB. */
#ifndef QN_TEXT_SYNTAX_H
#define QN_TEXT_SYNTAX_H

#include "number/num.h"
#include "text/names.h"

typedef enum qn_op_kind {
  QN_OP_SMALL,   /* pushes a 2^e2 5^e5 (a as int32_t): nearly every literal */
  QN_OP_NUMBER,  /* pushes numbers[a] */
  QN_OP_STRING,  /* pushes the text of name a */
  QN_OP_TRUE,
  QN_OP_FALSE,
  QN_OP_UNDEF,
  QN_OP_BAD,     /* pushes a value that was in error and has been told */
  QN_OP_LOAD,    /* pushes the value of name a */
  QN_OP_VECTOR,  /* pops a values, pushes their vector */
  QN_OP_CALL,    /* calls[a]: pops its arguments, pushes the result */
  QN_OP_INDEX,   /* v[i] */
  QN_OP_MEMBER,  /* v.name: a is the name */
  QN_OP_NEGATE,
  QN_OP_PLUS,    /* unary */
  QN_OP_NOT,
  QN_OP_ADD,
  QN_OP_SUBTRACT,
  QN_OP_MULTIPLY,
  QN_OP_DIVIDE,
  QN_OP_REMAINDER,
  QN_OP_POWER,
  QN_OP_LESS,
  QN_OP_LESS_EQUAL,
  QN_OP_GREATER,
  QN_OP_GREATER_EQUAL,
  QN_OP_EQUAL,
  QN_OP_NOT_EQUAL,
  QN_OP_BOOL,        /* the top as a truth value */
  QN_OP_AND,         /* top false: make it `false` and jump to a; else pop it */
  QN_OP_OR,          /* top true: make it `true` and jump to a; else pop it */
  QN_OP_UNLESS,      /* pops; jumps to a when it is false */
  QN_OP_JUMP         /* jumps to a */
} qn_op_kind;

typedef struct qn_op {
  uint8_t kind;
  int8_t e2, e5;
  uint8_t unused;
  uint32_t offset;
  uint32_t a;
} qn_op;

typedef struct qn_call_site { uint32_t name, arguments; } qn_call_site;

/* An argument or an assignment: [name =] code[from..to). */
typedef struct qn_argument { uint32_t name, offset, from, to; } qn_argument;
typedef struct qn_assignment { qn_argument value; uint32_t next; } qn_assignment;

#define QN_NO_STATEMENT UINT32_MAX

enum { QN_SIGN_BACKGROUND = 1, QN_SIGN_HIGHLIGHT = 2, QN_SIGN_ONLY = 4, QN_SIGN_DISABLE = 8, QN_STATEMENT_BAD = 16 };

/* word(arguments) { assignments and statements }. Statement 0 is the file itself. */
typedef struct qn_statement {
  uint32_t word, offset;
  uint32_t argument0, arguments;
  uint32_t first, next;  /* children; QN_NO_STATEMENT at the end */
  uint32_t assignment;   /* the first in its scope, QN_NO_STATEMENT: none */
  uint32_t flags;        /* QN_SIGN_*; BAD: its arguments were in error, told */
} qn_statement;

typedef struct qn_syntax {
  qn_mem *mem;
  qn_names names;
  qn_statement *statements;
  size_t statement_count, statement_capacity;
  qn_argument *arguments;
  size_t argument_count, argument_capacity;
  qn_assignment *assignments;
  size_t assignment_count, assignment_capacity;
  qn_op *ops;
  size_t op_count, op_capacity;
  qn_num *numbers;
  size_t number_count, number_capacity;
  qn_call_site *calls;
  size_t call_count, call_capacity;
  int includes; /* the text has include or use: unknown words may come from there */
} qn_syntax;

QN_NODISCARD int qn_syntax_init(qn_syntax *syntax, qn_mem *mem); /* 0 when memory is refused */
void qn_syntax_free(qn_syntax *syntax);

#endif
