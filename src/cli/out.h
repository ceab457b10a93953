/* Output: standard output, or a file that is written whole or not at all. Every error is noticed and said once. */
#ifndef QN_CLI_OUT_H
#define QN_CLI_OUT_H

#include "cli/text.h"

typedef struct cli_out {
  const char *path; /* null: standard output */
  char *target; /* the file to replace: path, with symbolic links followed */
  char *temporary; /* beside target until it is complete; null when the bytes go straight to the path */
  int fd;
  int error; /* errno of the first failure, 0 while all is well */
  cli_text buffer;
} cli_out;

/* path null or "-": standard output. A failure is remembered and told by cli_out_close. */
void cli_out_open(cli_out *out, const char *path);
/* Both return 0, or -1 once anything has failed. */
int cli_out_write(cli_out *out, const char *bytes, size_t length);
int cli_out_flush(cli_out *out);
/* A text, or nothing and an error where it could not be made whole. */
int cli_out_text(cli_out *out, const cli_text *text);
/* Ends the output: flushes, closes and puts the file in its place; with keep 0 the file is given up instead (standard
   output keeps what it has got). Returns CLI_OK or, after a message, CLI_IO. A reader that went away (a broken pipe) is
   CLI_IO without a message. */
int cli_out_close(cli_out *out, int keep);

#endif
