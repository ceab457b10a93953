/* Lines of numbers: "x y z" with blanks or commas between them, # to the end of the line a comment, empty lines skipped. */
#ifndef QN_CLI_ROWS_H
#define QN_CLI_ROWS_H

#include <quoin/quoin.h>

#define CLI_MAX_NUMBERS 6 /* a row holds at most: a ray's origin and direction */
#define CLI_ROW_ROOM (CLI_MAX_NUMBERS + 1) /* and one more, which is wrong */

/* One line, cut into texts in place. */
typedef struct cli_row {
  char *line, *end; /* the line without its newline */
  const char *junk; /* a NUL byte of the line itself, or null */
  const char *empty; /* a comma where a number is missing before it, or null */
  const char **numbers; /* ended by NUL in the line itself */
  unsigned count; /* numbers found, counting stops at CLI_ROW_ROOM */
  uint32_t cut[CLI_ROW_ROOM]; /* where the NULs stand, from `line` on */
  char under[CLI_ROW_ROOM]; /* and what they stand on */
} cli_row;

/* Cuts [line, end), of less than 2^32 bytes, at its blanks, with the numbers to be put into `numbers`, which has CLI_ROW_ROOM places; *end must be writable. */
void cli_row_cut(cli_row *row, const char **numbers, char *line, char *end);
/* Puts the line back as it was. */
void cli_row_mend(cli_row *row);

/* What is wrong with a row, kept until it is its turn to be said. */
typedef struct cli_fault {
  quoin_status status; /* QUOIN_OK: nothing */
  uint64_t line;
  size_t column, length;
  char problem[160];
  const char *reason, *code;
  char source[320];
} cli_fault;

/* What a row must be. */
typedef struct cli_row_kind {
  const char *what; /* "point" */
  const char *shape; /* "x y z" */
  unsigned numbers;
} cli_row_kind;

/* A row with the wrong count of numbers or a stray byte: describes it and returns non-zero. Mends it then. */
int cli_row_fault(cli_row *row, const cli_row_kind *kind, uint64_t line, cli_fault *fault);
/* A row the library refused with this status: finds the number that was the cause. Mends it. */
void cli_row_refused(cli_row *row, const quoin_scene *scene, quoin_work *work, quoin_status status, uint64_t line, cli_fault *fault);

/* Says a fault on standard error, as a diagnostic of `file`. */
void cli_say_fault(const cli_fault *fault, const char *file);

/* The first of n texts that the library does not take for a number, or n: not a decimal, or too long or out of range. */
unsigned cli_first_bad_number(const quoin_scene *scene, quoin_work *work, const char *const *numbers, unsigned n);
/* What a text that is no number should have been. */
#define CLI_NUMBER_RULE(status) \
  ((status) == QUOIN_E_LIMIT ? "it has too many digits or too large an exponent" : "a number is a finite decimal such as -1.5 or 2e-3")
/* A decimal text whose value is zero. */
int cli_is_zero(const char *number);

#endif
