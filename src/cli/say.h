/* What the command says on standard error, and the codes with which it ends. */
#ifndef QN_CLI_SAY_H
#define QN_CLI_SAY_H

#include <quoin/quoin.h>

/* How a run ends. They are part of the interface: the help lists them. */
typedef enum cli_exit {
  CLI_OK = 0, /* answered */
  CLI_NO = 1, /* --exit-code: the answer is no */
  CLI_USAGE = 2, /* wrong options, arguments or points */
  CLI_MODEL = 3, /* the model has errors or passes a limit */
  CLI_IO = 4 /* reading or writing failed, or memory ran out */
} cli_exit;

/* "quoin: error: ..." on standard error. */
void cli_error(const char *format, ...);

/* A user's word fit for a message: in quotes, control bytes as '?', cut when long. Returns buffer. */
typedef struct cli_quoted {
  char text[96];
} cli_quoted;
const char *cli_quote(cli_quoted *buffer, const char *word);

/* A diagnostic with its source line and caret. */
void cli_say_diag(const quoin_diag *diag);

/* All diagnostics of a model; only the errors when quiet. Returns how many errors there were. */
size_t cli_say_diags(const quoin_model *model, int quiet);

/* The exit code of a status. */
int cli_code(quoin_status status);

#endif
