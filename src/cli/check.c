/* quoin check: a model's diagnostics and a summary of what it is. */
#include "cli/commands.h"
#include "cli/load.h"
#include "cli/out.h"
#include "cli/say.h"

#include <errno.h>
#include <string.h>

enum { JSON = CLI_OWN };

static const cli_option options[] = {
  {JSON, 0, "json", NULL, "print the diagnostics and the summary as one JSON object"},
  CLI_COMMON_OPTIONS,
};

static int take(void *user, int id, const char *value) {
  (void)value;
  int *json = user;
  *json = id == JSON;
  return 0;
}

static void put_corner(cli_text *text, const double corner[3]) {
  for (int i = 0; i < 3; i++) {
    cli_puts(text, " ");
    cli_put_number(text, corner[i]);
  }
}

static void put_summary(cli_text *text, const quoin_scene_info *info) {
  cli_putf(text, "leaves %zu\nsurfaces %zu\ndistinct_surfaces %zu\n", info->leaves, info->surfaces, info->distinct_surfaces);
  cli_putf(text, "extent %s\n", info->empty ? "empty" : info->unbounded ? "unbounded" : "bounded");
  if (!info->empty) {
    cli_puts(text, "box");
    put_corner(text, info->box_min);
    put_corner(text, info->box_max);
    cli_puts(text, "\n");
  }
}

static void put_json_corner(cli_text *text, const double corner[3]) {
  for (int i = 0; i < 3; i++) {
    cli_puts(text, i ? "," : "[");
    cli_put_json_number(text, corner[i]);
  }
  cli_puts(text, "]");
}

static void put_json_summary(cli_text *text, const quoin_scene_info *info) {
  cli_putf(text, ",\"leaves\":%zu,\"surfaces\":%zu,\"distinct_surfaces\":%zu", info->leaves, info->surfaces, info->distinct_surfaces);
  cli_putf(text, ",\"empty\":%s,\"unbounded\":%s,\"box\":", info->empty ? "true" : "false", info->unbounded ? "true" : "false");
  if (info->empty) {
    cli_puts(text, "null");
  } else {
    cli_puts(text, "{\"min\":");
    put_json_corner(text, info->box_min);
    cli_puts(text, ",\"max\":");
    put_json_corner(text, info->box_max);
    cli_puts(text, "}");
  }
  cli_putf(text, ",\"bytes\":%zu", info->memory);
}

static void put_json_diag(cli_text *text, const quoin_diag *d, int quiet, int *any) {
  static const char *const words[] = {[QUOIN_NOTE] = "note", [QUOIN_WARNING] = "warning", [QUOIN_ERROR] = "error"};
  if (quiet && d->severity != QUOIN_ERROR) {
    return;
  }
  const struct {
    const char *name, *value;
  } fields[] = {
    {"severity", words[d->severity]}, {"code", d->code},     {"file", d->file},
    {"problem", d->problem},          {"reason", d->reason}, {"way_out", d->way_out},
  };
  cli_puts(text, *any ? "," : "");
  *any = 1;
  for (size_t i = 0; i < sizeof fields / sizeof *fields; i++) {
    cli_putf(text, "%s\"%s\":", i ? "," : "{", fields[i].name);
    cli_put_json(text, fields[i].value);
  }
  cli_putf(text, ",\"line\":%lu,\"column\":%lu,\"length\":%lu}", (unsigned long)d->line, (unsigned long)d->column,
           (unsigned long)d->length);
}

/* The object: {"status":..., "diagnostics":[...], and what is known of the scene}. */
static void put_json(cli_text *text, const cli_loaded *loaded, quoin_status status, int system_error, int quiet) {
  cli_puts(text, "{\"model\":");
  cli_put_json(text, loaded->path);
  cli_puts(text, ",\"status\":");
  cli_put_json(text, status == QUOIN_OK ? "ok" : status == QUOIN_E_IO && system_error ? strerror(system_error) : quoin_status_text(status));
  cli_puts(text, ",\"diagnostics\":[");
  int any = 0;
  size_t count = loaded->model ? quoin_model_diag_count(loaded->model) : 0;
  for (size_t i = 0; i < count; i++) {
    quoin_diag diag;
    if (quoin_model_diag(loaded->model, i, &diag) == QUOIN_OK) {
      put_json_diag(text, &diag, quiet, &any);
    }
  }
  cli_puts(text, "]");
  if (loaded->scene) {
    quoin_scene_info info;
    quoin_scene_get_info(loaded->scene, &info);
    put_json_summary(text, &info);
  }
  cli_puts(text, "}\n");
}

static int run(const cli_command *self, int argc, char **argv) {
  cli_common common;
  int json = 0;
  int code = cli_parse(self, argc, argv, &common, take, &json);
  if (code >= 0) {
    return code;
  }
  const char *path = cli_model_operand(self, &common);
  if (!path) {
    return CLI_USAGE;
  }
  if (common.operand_count > 1) {
    cli_quoted q;
    cli_error("one MODEL at a time: %s is one too many", cli_quote(&q, common.operands[1]));
    return cli_try_help(self);
  }
  cli_loaded loaded;
  cli_text text = {0};
  if (json) {
    quoin_status status = cli_read(&common, path, 1, &loaded);
    put_json(&text, &loaded, status, errno, common.quiet);
    code = cli_code(status);
  } else {
    code = cli_load(&common, path, 1, &loaded);
    if (code == CLI_OK) {
      quoin_scene_info info;
      quoin_scene_get_info(loaded.scene, &info);
      put_summary(&text, &info);
    }
  }
  if (common.stats) {
    cli_say_load_stats(&loaded);
  }
  cli_unload(&loaded);
  cli_out out;
  cli_out_open(&out, NULL);
  cli_out_write(&out, text.data, text.length);
  int closed = cli_out_close(&out, 1);
  if (text.failed) {
    cli_error("%s", quoin_status_text(QUOIN_E_MEMORY));
    closed = CLI_IO;
  }
  cli_text_free(&text);
  return closed != CLI_OK ? closed : code;
}

const cli_command cli_check_command = {
  "check",
  "MODEL",
  "Read and compile a model; print its diagnostics and a summary.",
  "Errors, warnings and notes go to standard error, each with file:line:column, the line and a caret. The summary goes to\n"
  "standard output, one \"name value\" a line: leaves (primitives that were kept), surfaces (their half-spaces),\n"
  "distinct_surfaces (after equal ones were made one), extent (bounded, unbounded or empty: nothing is left after\n"
  "simplification), and box xmin ymin zmin xmax ymax zmax, which holds the solid.\n"
  "With --json both go to standard output as one object: model, status (\"ok\" or what failed), diagnostics, and the summary;\n"
  "infinite numbers are the strings \"-inf\" and \"inf\", the box of an empty solid is null.\n",
  options,
  run,
};
