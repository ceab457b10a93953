/* Bytes to tokens, one at a time. Comments and blanks are passed over; what is wrong is told once and passed over. */
#ifndef QN_TEXT_LEXER_H
#define QN_TEXT_LEXER_H

#include "number/num.h"
#include "text/names.h"
#include "text/report.h"

typedef enum qn_token_kind {
  QN_T_END,
  QN_T_NUMBER,
  QN_T_STRING,
  QN_T_NAME,
  QN_T_BAD, /* told already */
  QN_T_AND,
  QN_T_OR,
  QN_T_EQUAL,
  QN_T_NOT_EQUAL,
  QN_T_LESS_EQUAL,
  QN_T_GREATER_EQUAL,
  QN_T_MARK /* one character: token.mark */
} qn_token_kind;

typedef struct qn_token {
  qn_token_kind kind;
  char mark;
  uint32_t offset, length;
  uint32_t name;  /* of a name or a string */
  qn_num number;
} qn_token;

typedef struct qn_lexer {
  const qn_source *source;
  qn_reporter *reporter;
  qn_names *names;
  qn_ctx *numbers; /* where literals live */
  size_t at;
  size_t last_end; /* end of the token before the current one: where something missing would stand */
  qn_token token;  /* the current one */
  quoin_status failed;
  char *scratch;   /* the string being read */
  size_t scratch_capacity;
} qn_lexer;

/* Does not read the first token; call qn_lexer_next. */
void qn_lexer_init(qn_lexer *lexer, const qn_source *source, qn_reporter *reporter, qn_names *names, qn_ctx *numbers);
void qn_lexer_free(qn_lexer *lexer);

/* Reads the next token into lexer->token. When memory is refused, lexer->failed is set and the text ends. */
void qn_lexer_next(qn_lexer *lx);

QN_INLINE int qn_lexer_is(const qn_lexer *lexer, char mark) {
  return lexer->token.kind == QN_T_MARK && lexer->token.mark == mark;
}

/* After `include` or `use` as the current token: passes over <path>, and reads the token behind it. 0 when there is none. */
int qn_lexer_path(qn_lexer *lx);

#endif
