/* quoin check: a model's diagnostics, its surfaces that nearly coincide, and a summary of what it is. */
#include "cli/commands.h"
#include "cli/load.h"
#include "cli/out.h"
#include "cli/say.h"
#include "cli/stats.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { JSON = CLI_OWN, NEAR };

static const cli_option options[] = {
  {JSON, 0, "json", NULL, "print the diagnostics and the summary as one JSON object"},
  {NEAR, 0, "near", "GAP", "report surfaces no further apart than GAP, a decimal; 0: none;\n"
                           "default: 1e-5 of the largest coordinate"},
  CLI_SNAP_OPTION,
  CLI_COMMON_OPTIONS,
};

typedef struct wish { int json; const char *near; } wish;

static int take(void *user, int id, const char *value) {
  wish *w = user;
  if (id == NEAR) {
    w->near = value;
    return cli_take_decimal("near", value);
  }
  w->json = id == JSON;
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

/* --- near surfaces --------------------------------------------------------------------------------------------------- */

enum { SHOWN = 10 };

/* A short decimal no smaller than the gap: a limit that includes it. */
static void put_limit(char text[48], double gap) {
  for (int digits = 1; digits <= 17; digits++) {
    snprintf(text, 48, "%.*g", digits, gap);
    if (strtod(text, NULL) > gap) { /* not equal: the gap may be above its nearest double */
      return;
    }
  }
  snprintf(text, 48, "%.17g", nextafter(gap, INFINITY));
}

static void say_near(const quoin_near_list *list, int quiet) {
  size_t count = quoin_near_count(list);
  for (size_t i = 0; i < count && i < SHOWN && !quiet; i++) {
    quoin_near near;
    char role[2][32], gap[64], limit[48], problem[1000], place[256] = "", way_out[90];
    if (quoin_near_get(list, i, &near) != QUOIN_OK) {
      return;
    }
    const quoin_near_face *own = &near.face[0], *other = &near.face[1];
    for (int k = 0; k < 2; k++) {
      quoin_role_text(near.face[k].role, role[k], sizeof role[k]);
    }
    snprintf(gap, sizeof gap, "%.17g", near.gap);
    if (other->line) {
      snprintf(place, sizeof place, " at %.200s:%lu:%lu", other->file, (unsigned long)other->line, (unsigned long)other->column);
    }
    snprintf(problem, sizeof problem, "%s of '%.200s' is %s from %s of '%.200s'%s", role[0], own->name, near.exact[0] ? near.exact : gap, role[1],
             other->name, place);
    if (near.exact[0] && near.exact[0] != '(') {
      snprintf(limit, sizeof limit, "%s", near.exact);
    } else {
      put_limit(limit, near.gap);
    }
    snprintf(way_out, sizeof way_out, "--snap %s would make them one", limit);
    quoin_diag diag = {.severity = QUOIN_NOTE, .code = "Q1103", .file = own->file, .line = own->line, .column = own->column, .length = 1,
                       .problem = problem, .reason = near.opposite ? "the parts lie on opposite sides" : "", .way_out = way_out, .source = ""};
    cli_say_diag(&diag);
  }
  if (count > SHOWN && !quiet) {
    char problem[120];
    snprintf(problem, sizeof problem, "%zu more pairs of near surfaces are not shown", count - SHOWN);
    quoin_diag diag = {.severity = QUOIN_NOTE, .code = "Q0909", .file = "", .problem = problem, .reason = "", .way_out = "--json lists all", .source = ""};
    cli_say_diag(&diag);
  }
}

static void put_json_near(cli_text *text, const char *name, const quoin_near_list *list) {
  cli_putf(text, ",\"%s\":{\"limit\":", name);
  cli_put_json_number(text, quoin_near_limit(list));
  cli_putf(text, ",\"complete\":%s,\"pairs\":[", quoin_near_complete(list) ? "true" : "false");
  for (size_t i = 0; i < quoin_near_count(list); i++) {
    quoin_near near;
    if (quoin_near_get(list, i, &near) != QUOIN_OK) {
      break;
    }
    cli_puts(text, i ? ",{\"gap\":" : "{\"gap\":");
    cli_put_json_number(text, near.gap);
    cli_puts(text, ",\"exact\":");
    cli_put_json(text, near.exact);
    cli_putf(text, ",\"opposite\":%s,\"faces\":[", near.opposite ? "true" : "false");
    for (int k = 0; k < 2; k++) {
      const quoin_near_face *face = &near.face[k];
      char role[32];
      quoin_role_text(face->role, role, sizeof role);
      cli_puts(text, k ? ",{\"name\":" : "{\"name\":");
      cli_put_json(text, face->name);
      cli_puts(text, ",\"role\":");
      cli_put_json(text, role);
      cli_puts(text, ",\"file\":");
      cli_put_json(text, face->file);
      cli_putf(text, ",\"line\":%lu,\"column\":%lu}", (unsigned long)face->line, (unsigned long)face->column);
    }
    cli_puts(text, "]}");
  }
  cli_puts(text, "]}");
}

/* --- the object of --json --------------------------------------------------------------------------------------------- */

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
static void put_json(cli_text *text, cli_loaded *loaded, const quoin_near_list *near, quoin_status status, int system_error, int quiet) {
  cli_why why;
  cli_puts(text, "{\"model\":");
  cli_put_json(text, loaded->path);
  cli_puts(text, ",\"status\":");
  cli_put_json(text, status == QUOIN_OK ? "ok" : status == QUOIN_E_IO && system_error ? strerror(system_error) : cli_memory_status(&loaded->memory, status, &why));
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
    put_json_near(text, "near", near);
    if (quoin_scene_snapped(loaded->scene)) {
      put_json_near(text, "snapped", quoin_scene_snapped(loaded->scene));
    }
  }
  cli_puts(text, "}\n");
}

static int run(const cli_command *self, int argc, char **argv) {
  cli_common common;
  wish asked = {0, NULL};
  int code = cli_parse(self, argc, argv, &common, take, &asked);
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
  quoin_near_list *near = NULL;
  if (asked.json) {
    quoin_status status = cli_read(&common, path, 1, &loaded);
    int system_error = errno;
    status = status == QUOIN_OK ? quoin_near_find(loaded.scene, asked.near, &near) : status;
    put_json(&text, &loaded, near, status, system_error, common.quiet);
    code = cli_code(status);
  } else {
    code = cli_load(&common, path, 1, &loaded);
    if (code == CLI_OK) {
      quoin_scene_info info;
      quoin_scene_get_info(loaded.scene, &info);
      put_summary(&text, &info);
      quoin_status status = quoin_near_find(loaded.scene, asked.near, &near);
      code = cli_code(status);
      if (status == QUOIN_OK) {
        say_near(near, common.quiet);
        cli_putf(&text, "near_pairs %zu%s\n", quoin_near_count(near), quoin_near_complete(near) ? "" : " and more");
        if (quoin_scene_snapped(loaded.scene)) {
          cli_putf(&text, "snapped %zu\n", quoin_near_count(quoin_scene_snapped(loaded.scene)));
        }
      } else { /* no number of pairs is a false one */
        cli_why why;
        cli_error("no near surfaces: %s", cli_memory_status(&loaded.memory, status, &why));
      }
    }
  }
  if (common.stats) {
    cli_stats stats = {.json = asked.json};
    cli_stats_load(&stats, &loaded);
    cli_stats_say(&stats);
  }
  quoin_near_free(near);
  cli_unload(&loaded);
  cli_out out;
  cli_out_open(&out, NULL);
  cli_out_text(&out, &text);
  int closed = cli_out_close(&out, 1);
  cli_text_free(&text);
  return closed != CLI_OK ? closed : code;
}

const cli_command cli_check_command = {
  "check",
  "MODEL",
  "Read and compile a model; print its diagnostics, near surfaces and a summary.",
  "Errors, warnings and notes go to standard error, each with file:line:column, the line and a caret. The summary goes to\n"
  "standard output, one \"name value\" a line: leaves (primitives that were kept), surfaces (their half-spaces),\n"
  "distinct_surfaces (after equal ones were made one), extent (bounded, unbounded, or empty: no point is inside, as far as\n"
  "boxes and equal surfaces show; docs/language.md says when), box xmin ymin zmin xmax ymax zmax, which holds the solid,\n"
  "near_pairs (pairs of surfaces that nearly coincide), and with --snap snapped (surfaces that were moved). The first ten\n"
  "pairs are notes too, the smallest gaps first.\n"
  "With --json all goes to standard output as one object: model, status (\"ok\" or what failed), diagnostics, the summary, and all\n"
  "near and snapped pairs. Its summary has empty and unbounded in place of extent, and bytes, the scene's memory; a model with\n"
  "errors has none. Infinite numbers are the strings \"-inf\" and \"inf\", the box of an empty solid is null.\n",
  options,
  run,
};
