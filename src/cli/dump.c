/* quoin tree and quoin scene: what the reader made of a text, and what the compiler made of that, as stable text. */
#include "cli/commands.h"
#include "cli/load.h"
#include "cli/out.h"
#include "cli/say.h"
#include "cli/stats.h"

enum { OUTPUT = CLI_OWN };

#define OUTPUT_OPTION {OUTPUT, 'o', "output", "FILE", "write to FILE, whole or not at all; - or none: standard output"}
static const cli_option tree_options[] = {OUTPUT_OPTION, CLI_COMMON_OPTIONS};
static const cli_option scene_options[] = {OUTPUT_OPTION, CLI_SNAP_OPTION, CLI_COMMON_OPTIONS};

static int take(void *user, int id, const char *value) {
  (void)id;
  const char **path = user;
  *path = value;
  return 0;
}

static int write_out(void *user, const char *text, size_t length) {
  return cli_out_write(user, text, length);
}

static int run(const cli_command *self, int argc, char **argv, int compile) {
  cli_common common;
  const char *output = NULL;
  int code = cli_parse(self, argc, argv, &common, take, &output);
  if (code >= 0) {
    return code;
  }
  const char *path = cli_model_operand(self, &common);
  if (!path) {
    return CLI_USAGE;
  }
  cli_quoted q;
  if (common.operand_count > 1) {
    cli_error("one MODEL at a time: %s is one too many", cli_quote(&q, common.operands[1]));
    return cli_try_help(self);
  }
  cli_loaded loaded;
  code = cli_load(&common, path, compile, &loaded);
  if (code == CLI_OK) {
    cli_out out;
    cli_out_open(&out, output);
    quoin_status status =
      compile ? quoin_scene_write_text(loaded.scene, write_out, &out) : quoin_model_write_tree(loaded.model, write_out, &out);
    int closed = cli_out_close(&out, status == QUOIN_OK);
    if (status != QUOIN_OK && closed == CLI_OK) { /* it was not the writing that failed */
      cli_why why;
      cli_error("cannot print %s: %s", cli_quote(&q, path), cli_memory_status(&loaded.memory, status, &why));
    }
    code = closed != CLI_OK ? closed : cli_code(status);
  }
  if (common.stats) {
    cli_stats stats = {.json = 0};
    cli_stats_load(&stats, &loaded);
    cli_stats_say(&stats);
  }
  cli_unload(&loaded);
  return code;
}

static int run_tree(const cli_command *self, int argc, char **argv) {
  return run(self, argc, argv, 0);
}

static int run_scene(const cli_command *self, int argc, char **argv) {
  return run(self, argc, argv, 1);
}

const cli_command cli_tree_command = {
  "tree",
  "MODEL",
  "Print a model's tree as canonical text.",
  "Constants are replaced by their values and arguments are named; the text is itself a model and reads back to the same\n"
  "tree, every number exactly.\n",
  tree_options,
  run_tree,
};

const cli_command cli_scene_command = {
  "scene",
  "MODEL",
  "Print a compiled scene: its surfaces, leaves and program.",
  "The text is for reading and for tests: equal models give equal text, on any number of threads.\n",
  scene_options,
  run_scene,
};
