#include "cli/load.h"
#include "cli/say.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

double cli_clock(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + (double)now.tv_nsec / 1e9;
}

const char *cli_model_operand(const cli_command *command, const cli_common *common) {
  if (common->operand_count == 0) {
    cli_error("no MODEL given: quoin %s %s", command->name, command->operands);
    cli_try_help(command);
    return NULL;
  }
  return common->operands[0];
}

quoin_status cli_read(const cli_common *common, const char *path, int compile, cli_loaded *out) {
  out->path = path;
  out->model = NULL;
  out->scene = NULL;
  out->read_seconds = out->compile_seconds = 0;
  cli_memory_init(&out->memory, common->max_memory);
  quoin_allocator counted = cli_memory_allocator(&out->memory);
  double start = cli_clock();
  quoin_status status = quoin_model_new(common->max_memory ? &counted : NULL, &out->model);
  if (status == QUOIN_OK) {
    quoin_read_options options = quoin_read_options_default();
    options.facets = common->facets;
    errno = 0;
    status = quoin_model_read_file(out->model, QUOIN_ROOT, path, &options);
  }
  double middle = cli_clock();
  out->read_seconds = middle - start;
  if (status == QUOIN_OK && compile) {
    quoin_compile_options options = quoin_compile_options_default();
    options.threads = common->threads;
    options.snap = common->snap;
    status = quoin_scene_compile(out->model, &options, &out->scene);
    out->compile_seconds = cli_clock() - middle;
  }
  return status;
}

int cli_load(const cli_common *common, const char *path, int compile, cli_loaded *out) {
  quoin_status status = cli_read(common, path, compile, out);
  int system_error = errno;
  size_t errors = out->model ? cli_say_diags(out->model, common->quiet) : 0;
  if (status != QUOIN_OK && errors == 0) {
    cli_quoted q;
    cli_why why;
    const char *what = status == QUOIN_E_IO && system_error ? strerror(system_error) : cli_memory_status(&out->memory, status, &why);
    const char *more = status == QUOIN_E_LIMIT ? " while compiling (too many solids, or transforms so deep or so fine that exact numbers grow too long)" : "";
    cli_error("%s: %s%s", cli_quote(&q, path), what, more);
  }
  return cli_code(status);
}

void cli_unload(cli_loaded *loaded) {
  quoin_scene_free(loaded->scene);
  quoin_model_free(loaded->model);
  loaded->scene = NULL;
  loaded->model = NULL;
}
