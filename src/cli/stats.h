/* The figures of --stats: of every command in one shape, on standard error, when all else is done. Lines "name value"; with --json one object on one line,
   {"stats":{"name":value,...}}. What the names mean is said in docs/api.md. */
#ifndef QN_CLI_STATS_H
#define QN_CLI_STATS_H

#include "cli/load.h"
#include "cli/text.h"

/* Start from zeros, or with json set. */
typedef struct cli_stats {
  int json;
  cli_text text;
} cli_stats;

void cli_stats_seconds(cli_stats *stats, const char *word, double seconds);
void cli_stats_count(cli_stats *stats, const char *word, uint64_t count);
/* The times of reading and compiling, and what the scene is made of. */
void cli_stats_load(cli_stats *stats, const cli_loaded *loaded);
/* The counters of questions. */
void cli_stats_work(cli_stats *stats, const quoin_stats *work);
/* Prints them, and the most memory that the program has used. */
void cli_stats_say(cli_stats *stats);

/* sum += stats of work, which may be null. */
void cli_add_work_stats(const quoin_work *work, quoin_stats *sum);

#endif
