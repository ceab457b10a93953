/* Many questions to one scene: from the arguments, or from lines that may be many and may come slowly. Answers leave in
   the order of the questions; blocks of lines are answered by several threads, each with a quoin_work of its own. */
#ifndef QN_CLI_BATCH_H
#define QN_CLI_BATCH_H

#include "cli/load.h"
#include "cli/out.h"
#include "cli/rows.h"

enum { CLI_ROWS = 4096 }; /* rows of lines that are answered at once, at most */

typedef struct cli_batch {
  const cli_common *common;
  const quoin_scene *scene;
  cli_row_kind kind;
  /* Answers one row of kind.numbers numbers and puts a line into text. Called by several threads at once; `thread` is below
     cli_batch_threads(). QUOIN_E_NUMBER and QUOIN_E_ARGUMENT mean that the row is wrong. */
  quoin_status (*answer)(void *user, unsigned thread, quoin_work *work, const char *const *numbers, cli_text *text);
  /* The same for n rows at once, their numbers one row after another; may be null. *done is set to the rows answered, whose lines are in text:
     all of them, or fewer (at least one) where it likes to be called again for the others, or those before the row that the status is about. */
  quoin_status (*answer_many)(void *user, unsigned thread, quoin_work *work, size_t n, const char *const *numbers, cli_text *text, size_t *done);
  void *user;
  int json; /* statistics are printed so */
  quoin_work **works; /* made as they are needed */
  unsigned threads;
} cli_batch;

/* Sets threads and works; 0, or the exit code after a message. cli_batch_free in any case. */
int cli_batch_start(cli_batch *batch);
/* A work for thread `thread`, made at the first call; null when memory is out. */
quoin_work *cli_batch_work(cli_batch *batch, unsigned thread);
/* The numbers of the operands after MODEL. */
int cli_batch_arguments(cli_batch *batch, cli_out *out);
/* The lines of a file, or of standard input when path is "-". Whenever the input makes one wait, everything that has
   come is answered and written. */
int cli_batch_lines(cli_batch *batch, const char *path, cli_out *out);
void cli_batch_free(cli_batch *batch);

/* The whole of a command that asks questions: rows from the operands if there are any, else from `input` (null:
   standard input, unless the model came from there). Loads the model, prints statistics if wanted. `prepare` (may be null) runs
   once before the first row; it returns 0 or the exit code after a message. */
int cli_batch_run(cli_batch *batch, const cli_command *command, const cli_common *common, const char *source,
                  int (*prepare)(cli_batch *batch));

#endif
