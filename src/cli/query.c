/* quoin query: the side of points. */
#include "cli/batch.h"
#include "cli/commands.h"
#include "cli/say.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { INPUT = CLI_OWN, NAMES, JSON, EXIT_CODE };

static const cli_option options[] = {
  {INPUT, 'i', "input", "FILE", "read points from FILE instead of standard input"},
  {NAMES, 0, "names", NULL, "add the names of the parts that hold the point"},
  {JSON, 0, "json", NULL, "print each answer as a JSON object on its line"},
  {EXIT_CODE, 0, "exit-code", NULL, "exit with 0 if all points are inside, with 1 if one is not"},
  CLI_SNAP_OPTION,
  CLI_COMMON_OPTIONS,
};

typedef struct query {
  const char *input;
  int names, json, exit_code;
  atomic_int not_inside; /* some point is not inside */
} query;

static int take(void *user, int id, const char *value) {
  query *q = user;
  switch (id) {
  case INPUT: q->input = value; return 0;
  case NAMES: q->names = 1; return 0;
  case JSON: q->json = 1; return 0;
  case EXIT_CODE: q->exit_code = 1; return 0;
  default: return -1;
  }
}

static const char *side_word(quoin_side side) {
  switch (side) {
  case QUOIN_OUTSIDE: return "outside";
  case QUOIN_BOUNDARY: return "boundary";
  case QUOIN_INSIDE: return "inside";
  }
  return "";
}

static const char *text_line(quoin_side side) {
  return side == QUOIN_INSIDE ? "inside\n" : side == QUOIN_BOUNDARY ? "boundary\n" : "outside\n";
}

static const char *json_line(quoin_side side) {
  return side == QUOIN_INSIDE ? "{\"side\":\"inside\"}\n" : side == QUOIN_BOUNDARY ? "{\"side\":\"boundary\"}\n" : "{\"side\":\"outside\"}\n";
}

static void put_part(const query *q, const quoin_scene *scene, quoin_part part, int first, cli_text *text) {
  const char *name = quoin_part_name(scene, part);
  if (q->json) {
    cli_puts(text, first ? "" : ",");
    cli_put_json(text, name);
  } else {
    cli_puts(text, "\t");
    cli_put_field(text, name);
  }
}

static quoin_status put_parts(const query *q, const quoin_scene *scene, quoin_work *work, const char *const *point, cli_text *text) {
  quoin_part few[32], *parts = few;
  size_t count;
  quoin_status status = quoin_point_parts_text(scene, work, point, few, sizeof few / sizeof *few, &count);
  if (status == QUOIN_OK && count > sizeof few / sizeof *few) {
    size_t size = count;
    parts = malloc(size * sizeof *parts);
    status = parts ? quoin_point_parts_text(scene, work, point, parts, size, &count) : QUOIN_E_MEMORY;
    count = count < size ? count : size;
  }
  for (size_t i = 0; status == QUOIN_OK && i < count; i++) {
    put_part(q, scene, parts[i], i == 0, text);
  }
  if (parts != few) {
    free(parts);
  }
  return status;
}

typedef struct context {
  query q;
  cli_batch batch;
} context;

static quoin_status answer(void *user, unsigned thread, quoin_work *work, const char *const *numbers, cli_text *text) {
  (void)thread;
  context *c = user;
  quoin_side side;
  quoin_status status = quoin_point_side_text(c->batch.scene, work, numbers, &side);
  if (status != QUOIN_OK) {
    return status;
  }
  if (side != QUOIN_INSIDE) {
    atomic_store_explicit(&c->q.not_inside, 1, memory_order_relaxed);
  }
  if (c->q.json) {
    cli_putf(text, "{\"side\":\"%s\"%s", side_word(side), c->q.names ? ",\"parts\":[" : "");
  } else {
    cli_puts(text, side_word(side));
  }
  if (c->q.names) {
    status = put_parts(&c->q, c->batch.scene, work, numbers, text);
  }
  cli_puts(text, !c->q.json ? "\n" : c->q.names ? "]}\n" : "}\n");
  return status;
}

/* Without names: the rows of a block together. */
static quoin_status answer_many(void *user, unsigned thread, quoin_work *work, size_t n, const char *const *numbers, cli_text *text, size_t *done) {
  (void)thread;
  context *c = user;
  quoin_side sides[CLI_ROWS];
  n = n < CLI_ROWS ? n : CLI_ROWS;
  quoin_status status = quoin_point_sides_text(c->batch.scene, work, n, numbers, sides, done);
  int not_inside = 0;
  for (size_t i = 0; i < *done; i++) {
    const char *line = c->q.json ? json_line(sides[i]) : text_line(sides[i]);
    cli_puts(text, line);
    not_inside |= sides[i] != QUOIN_INSIDE;
  }
  if (not_inside) {
    atomic_store_explicit(&c->q.not_inside, 1, memory_order_relaxed);
  }
  return status;
}

static int run(const cli_command *self, int argc, char **argv) {
  context c = {.batch = {.kind = {"point", "x y z", 3}, .answer = answer, .user = &c}};
  cli_common common;
  int code = cli_parse(self, argc, argv, &common, take, &c.q);
  if (code >= 0) {
    return code;
  }
  c.batch.json = c.q.json;
  c.batch.answer_many = c.q.names ? NULL : answer_many;
  code = cli_batch_run(&c.batch, self, &common, c.q.input, NULL);
  return code == CLI_OK && c.q.exit_code && atomic_load(&c.q.not_inside) ? CLI_NO : code;
}

const cli_command cli_query_command = {
  "query",
  "MODEL [X Y Z ...]",
  "Tell whether points are inside a solid, outside it or on its boundary. Exact.",
  "Points are arguments, or lines \"x y z\" on standard input: blanks or commas between the numbers, # begins a comment,\n"
  "empty lines are skipped. A number is a decimal and means exactly what it spells: 0.1 is 1/10.\n"
  "Prints one line a point: inside, boundary or outside. With --names the names of the parts whose closed solids hold\n"
  "the point follow, a tab before each (a tab, newline or backslash in a name is written \\t, \\n, \\\\).\n"
  "With --json a line is {\"side\":\"inside\"}, with --names {\"side\":\"inside\",\"parts\":[\"a\",\"b\"]}.\n"
  "A wrong line ends the run with its place and exit code 2, after the answers to all lines before it.\n",
  options,
  run,
};
