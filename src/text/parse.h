/* Tokens to the syntax tree. */
#ifndef QN_TEXT_PARSE_H
#define QN_TEXT_PARSE_H

#include "text/report.h"
#include "text/syntax.h"

/* Reads a source into `syntax` (initialised, empty). Literals live in `numbers`. Errors are told to the reporter, and
   what could be read stands in the tree, with QN_OP_BAD and QN_STATEMENT_BAD where it could not.
   QUOIN_E_MEMORY: memory was refused. QUOIN_E_LIMIT: the text is too deep; told. */
quoin_status qn_parse(qn_syntax *syntax, const qn_source *source, qn_reporter *reporter, qn_ctx *numbers);

#endif
