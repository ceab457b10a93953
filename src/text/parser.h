/* The parser's state, shared by its two files: statements (parse.c) and expressions (parse_expression.c). */
#ifndef QN_TEXT_PARSER_H
#define QN_TEXT_PARSER_H

#include "text/lexer.h"
#include "text/syntax.h"

/* What waits on the expression's stack: operators for their right operand, brackets for their end. */
typedef struct qn_waiting {
  uint8_t kind;    /* in parse_expression.c */
  uint8_t op;      /* qn_op_kind of an operator */
  uint8_t rank;    /* its precedence; 0 for brackets */
  uint8_t unused;
  uint32_t offset;
  uint32_t a;      /* the jump to patch, or the name called */
  uint32_t count;  /* elements so far */
} qn_waiting;

/* An open statement: its child is being read. */
typedef struct qn_open {
  uint32_t statement; /* whose child is read */
  uint32_t owner;     /* the frame whose scope takes the children: itself, or one further out for a bare { } */
  uint32_t last, last_assignment;
  uint32_t brace;     /* offset of '{' */
  uint8_t block;      /* { ... }: many children; else exactly one */
} qn_open;

typedef struct qn_parser {
  qn_lexer lexer;
  qn_syntax *syntax;
  qn_reporter *reporter;
  qn_mem *mem;
  qn_waiting *waiting;
  size_t waiting_count, waiting_capacity;
  qn_open *open;
  size_t open_count, open_capacity;
  int behind_if;       /* an `if` or `else` has just ended: an `else` may follow */
  size_t joined;       /* op count where two branches met last: a literal before it is not an operand of its own */
  quoin_status failed; /* stop at once */
} qn_parser;

/* Reads one expression into syntax->ops[*from, *to). On an error, which is told, the code is one QN_OP_BAD, the text is passed
   over up to where the expression should have ended, and 0 is returned. */
int qn_parse_expression(qn_parser *p, uint32_t *from, uint32_t *to);

/* What stands at the current token, for messages: "'cube'", "the end of the file". */
const char *qn_parse_found(const qn_parser *p, char text[64]);

/* Tells Q0901 and stops when the nesting passes its limit. */
int qn_parse_depth(qn_parser *p);

#endif
