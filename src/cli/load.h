/* From a MODEL operand to a compiled scene, with everything said on the way */
#ifndef QN_CLI_LOAD_H
#define QN_CLI_LOAD_H

#include "cli/memory.h"
#include "cli/options.h"

typedef struct cli_loaded {
  const char *path;
  cli_memory memory; /* --max-memory */
  quoin_model *model;
  quoin_scene *scene;
  double read_seconds, compile_seconds;
} cli_loaded;

/* Seconds on a clock that only goes forward. */
double cli_clock(void);

/* The MODEL operand, or null after a message. */
const char *cli_model_operand(const cli_command *command, const cli_common *common);

/* Reads, and compiles if asked. Says nothing but what the model's diagnostics lack (see cli_load). cli_unload in any case. */
quoin_status cli_read(const cli_common *common, const char *path, int compile, cli_loaded *out);
/* The same, with all diagnostics said on standard error. Returns the exit code. */
int cli_load(const cli_common *common, const char *path, int compile, cli_loaded *out);
void cli_unload(cli_loaded *loaded);

#endif
