/* Options and operands, as POSIX writes them: -q, -oFILE, -o FILE, --name, --name=value, --name value, -- ends options,
   a lone - is an operand, and so is a negative number. Options may stand before and after operands. */
#ifndef QN_CLI_OPTIONS_H
#define QN_CLI_OPTIONS_H

#include <quoin/quoin.h>

/* One row of a command's options; the help is printed from the same row. */
typedef struct cli_option {
  int id;
  char letter; /* 0: none */
  const char *name; /* without the dashes; null ends the table */
  const char *value; /* what stands for the value in the help; null: takes none */
  const char *help;
} cli_option;

typedef struct cli_command cli_command;
struct cli_command {
  const char *name;
  const char *operands; /* "MODEL [X Y Z ...]" */
  const char *summary; /* one line */
  const char *details; /* the rest of the help; lines end with \n */
  const cli_option *options;
  int (*run)(const cli_command *self, int argc, char **argv); /* arguments after the command's name; the exit code */
};

/* Options every command has. */
enum { CLI_HELP = 1, CLI_QUIET, CLI_STATS, CLI_THREADS, CLI_FACETS, CLI_MAX_MEMORY, CLI_SNAP, CLI_OWN };
/* clang-format off */
#define CLI_COMMON_OPTIONS \
  {CLI_THREADS, 0, "threads", "N", "use N threads; 0, the default: as many as the machine has"}, \
  {CLI_FACETS, 0, "facets", "auto|honour|ignore", "what $fn does to round primitives: auto, the default, makes a\n" \
                                                  "polygon of 3 to 12 sides written by the user, and ignores more"}, \
  {CLI_MAX_MEMORY, 0, "max-memory", "SIZE", "fail with exit code 4 rather than take more memory than SIZE:\n" \
                                            "bytes, or with K, M or G units of 1024; default: no limit"}, \
  {CLI_STATS, 0, "stats", NULL, "print times and counters on standard error"}, \
  {CLI_QUIET, 'q', "quiet", NULL, "hide warnings and notes"}, \
  {CLI_HELP, 'h', "help", NULL, "print this help"}, \
  {0, 0, NULL, NULL, NULL}
/* Of the commands that compile. */
#define CLI_SNAP_OPTION \
  {CLI_SNAP, 0, "snap", "TOL", "make surfaces no further apart than TOL, a decimal, one; what\n" \
                               "moves and how far is said; default: nothing moves"}
/* clang-format on */

typedef struct cli_common {
  int quiet, stats;
  unsigned threads;
  quoin_facets facets;
  const char *snap; /* null: not given */
  size_t max_memory; /* bytes; 0: no limit */
  char **operands; /* in the array that was given */
  int operand_count;
} cli_common;

/* Reads all arguments: common ones into common, the command's own through take(user, id, value), which returns 0, or
   non-zero after it has printed a message. Returns -1 to go on, else the exit code to end with (the help was printed,
   or a message). */
int cli_parse(const cli_command *command, int argc, char **argv, cli_common *common, int (*take)(void *user, int id, const char *value),
              void *user);

/* Prints "Try ..." and returns CLI_USAGE. */
int cli_try_help(const cli_command *command);

/* Prints a command's help on standard output; the exit code. */
int cli_help(const cli_command *command);

/* The word of a list nearest to a mistyped one, or null if none is near. names(user, i) gives the words, null at the end. */
const char *cli_nearest(const char *word, const char *(*names)(const void *user, int i), const void *user);

/* Values of options. Each returns 0, or non-zero after a message that names the option. */
int cli_take_unsigned(const char *option, const char *value, unsigned long low, unsigned long high, unsigned *out);
/* Bytes: a whole number over 0, with K, M or G for units of 1024, 1024^2 and 1024^3. */
int cli_take_size(const char *option, const char *value, size_t *out);
/* A decimal, 0 or more, left as text: its value is exact. */
int cli_take_decimal(const char *option, const char *value);
/* count numbers with commas (or spaces) between them, finite. */
int cli_take_numbers(const char *option, const char *value, int count, double *out);

#endif
