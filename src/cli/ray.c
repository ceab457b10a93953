/* quoin ray: the stretches of rays that lie inside a solid. */
#include "cli/batch.h"
#include "cli/commands.h"
#include "cli/say.h"

#include <string.h>

enum { INPUT = CLI_OWN, FROM, TO, SURFACES, BOUNDARY, CONTACTS, JSON };

static const cli_option options[] = {
  {INPUT, 'i', "input", "FILE", "read rays from FILE instead of standard input"},
  {FROM, 0, "from", "T", "answer from parameter T on (a decimal, or -inf, the default)"},
  {TO, 0, "to", "T", "answer up to parameter T (a decimal, or inf, the default)"},
  {SURFACES, 0, "surfaces", NULL, "add to each end the part and the surface that make it"},
  {BOUNDARY, 0, "boundary", NULL, "add the stretches that run in the boundary"},
  {CONTACTS, 0, "contacts", NULL, "add the points where the ray only touches the solid"},
  {JSON, 0, "json", NULL, "print each answer as a JSON object on its line"},
  CLI_SNAP_OPTION,
  CLI_COMMON_OPTIONS,
};

typedef struct context {
  const char *input, *from, *to; /* from and to: null when infinite */
  int surfaces, json;
  unsigned want;
  cli_batch batch;
} context;

static int take(void *user, int id, const char *value) {
  context *c = user;
  switch (id) {
  case INPUT: c->input = value; return 0;
  case FROM: c->from = strcmp(value, "-inf") == 0 ? NULL : value; return 0;
  case TO: c->to = strcmp(value, "inf") == 0 || strcmp(value, "+inf") == 0 ? NULL : value; return 0;
  case SURFACES: c->surfaces = 1; return 0;
  case BOUNDARY: c->want |= QUOIN_WANT_BOUNDARY; return 0;
  case CONTACTS: c->want |= QUOIN_WANT_CONTACTS; return 0;
  case JSON: c->json = c->batch.json = 1; return 0;
  default: return -1;
  }
}

static void role_text(uint32_t role, char *text, size_t size) {
  if (quoin_role_text(role, text, size) < 0) {
    text[0] = '\0';
  }
}

/* --- text: one line a ray, fields between blanks, or between tabs when names are among them -------------------------- */

static void put_end(const context *c, const quoin_end *end, cli_text *text) {
  cli_put(text, c->surfaces ? "\t" : " ", 1);
  cli_put_number(text, end->t);
  if (c->surfaces && end->part == QUOIN_NO_PART) {
    cli_puts(text, "\t-\t-");
  } else if (c->surfaces) {
    char role[32];
    role_text(end->role, role, sizeof role);
    cli_puts(text, "\t");
    cli_put_field(text, quoin_part_name(c->batch.scene, end->part));
    cli_putf(text, "\t%s", role);
  }
}

static void put_stretches(const context *c, size_t count, const quoin_interval *stretches, cli_text *text) {
  if (count < 10) { /* nearly always */
    const char digit = (char)('0' + count);
    cli_put(text, &digit, 1);
  } else {
    cli_put_number(text, (double)count); /* some hundreds at most, and as %zu below 10^17 */
  }
  for (size_t i = 0; i < count; i++) {
    put_end(c, &stretches[i].enter, text);
    put_end(c, &stretches[i].leave, text);
  }
}

static void put_text(const context *c, const quoin_intervals *a, cli_text *text) {
  const char *between = c->surfaces ? "\t" : " ";
  put_stretches(c, a->count, a->inside, text);
  if (c->want & QUOIN_WANT_BOUNDARY) {
    cli_putf(text, "%sboundary%s", between, between);
    put_stretches(c, a->boundary_count, a->boundary, text);
  }
  if (c->want & QUOIN_WANT_CONTACTS) {
    cli_putf(text, "%scontacts%s%zu", between, between, a->contact_count);
    for (size_t i = 0; i < a->contact_count; i++) {
      put_end(c, &a->contacts[i], text);
    }
  }
  cli_put(text, "\n", 1);
}

/* --- JSON: one object a ray ------------------------------------------------------------------------------------------ */

static void put_json_end(const context *c, const quoin_end *end, cli_text *text) {
  cli_puts(text, "{\"t\":");
  cli_put_json_number(text, end->t);
  if (c->surfaces && end->part == QUOIN_NO_PART) {
    cli_puts(text, ",\"part\":null,\"surface\":null");
  } else if (c->surfaces) {
    char role[32];
    role_text(end->role, role, sizeof role);
    cli_puts(text, ",\"part\":");
    cli_put_json(text, quoin_part_name(c->batch.scene, end->part));
    cli_putf(text, ",\"surface\":\"%s\"", role);
  }
  cli_puts(text, "}");
}

static void put_json_stretches(const context *c, const char *name, size_t count, const quoin_interval *stretches, cli_text *text) {
  cli_putf(text, "\"%s\":[", name);
  for (size_t i = 0; i < count; i++) {
    cli_puts(text, i ? ",{\"enter\":" : "{\"enter\":");
    put_json_end(c, &stretches[i].enter, text);
    cli_puts(text, ",\"leave\":");
    put_json_end(c, &stretches[i].leave, text);
    cli_puts(text, "}");
  }
  cli_puts(text, "]");
}

static void put_json(const context *c, const quoin_intervals *a, cli_text *text) {
  cli_puts(text, "{");
  put_json_stretches(c, "inside", a->count, a->inside, text);
  if (c->want & QUOIN_WANT_BOUNDARY) {
    cli_puts(text, ",");
    put_json_stretches(c, "boundary", a->boundary_count, a->boundary, text);
  }
  if (c->want & QUOIN_WANT_CONTACTS) {
    cli_puts(text, ",\"contacts\":[");
    for (size_t i = 0; i < a->contact_count; i++) {
      cli_puts(text, i ? "," : "");
      put_json_end(c, &a->contacts[i], text);
    }
    cli_puts(text, "]");
  }
  cli_puts(text, "}\n");
}

static quoin_status answer(void *user, unsigned thread, quoin_work *work, const char *const *numbers, cli_text *text) {
  (void)thread;
  context *c = user;
  quoin_intervals a;
  quoin_status status = quoin_ray_intervals_text(c->batch.scene, work, numbers, c->from, c->to, c->want, &a);
  if (status == QUOIN_OK && c->json) {
    put_json(c, &a, text);
  } else if (status == QUOIN_OK) {
    put_text(c, &a, text);
  }
  return status;
}

typedef struct writing {
  const context *c;
  cli_text *text;
  size_t done;
} writing;

static int write_one(void *user, size_t i, const quoin_intervals *a) {
  writing *w = user;
  (w->c->json ? put_json : put_text)(w->c, a, w->text);
  w->done = i + 1;
  return 0;
}

static quoin_status answer_many(void *user, unsigned thread, quoin_work *work, size_t n, const char *const *numbers, cli_text *text, size_t *done) {
  (void)thread;
  context *c = user;
  writing w = {c, text, 0};
  quoin_status status = quoin_ray_intervals_many_text(c->batch.scene, work, n, numbers, c->from, c->to, c->want, write_one, &w);
  *done = w.done;
  return status;
}

/* --from and --to are checked before the first ray, so that a wrong one is not taken for a wrong ray. */
static int check_range(cli_batch *batch) {
  const context *c = batch->user;
  quoin_work *work = cli_batch_work(batch, 0);
  if (!work) {
    cli_error("%s", quoin_status_text(QUOIN_E_MEMORY));
    return CLI_IO;
  }
  const char *const names[2] = {"from", "to"}, *const values[2] = {c->from, c->to};
  for (int i = 0; i < 2; i++) {
    if (values[i] && cli_first_bad_number(batch->scene, work, &values[i], 1) == 0) {
      cli_quoted q;
      cli_error("%s is not a value for --%s; give a decimal number or %s", cli_quote(&q, values[i]), names[i], i ? "inf" : "-inf");
      return CLI_USAGE;
    }
  }
  static const char *const x_axis[6] = {"0", "0", "0", "1", "0", "0"};
  quoin_intervals a;
  quoin_status status = quoin_ray_intervals_text(batch->scene, work, x_axis, c->from, c->to, 0, &a);
  if (status == QUOIN_E_ARGUMENT) {
    cli_error("--from %s is beyond --to %s", c->from ? c->from : "-inf", c->to ? c->to : "inf");
    return CLI_USAGE;
  }
  return CLI_OK;
}

static int run(const cli_command *self, int argc, char **argv) {
  context c = {.batch = {.kind = {"ray", "ox oy oz dx dy dz", 6}, .answer = answer, .answer_many = answer_many, .user = &c}};
  cli_common common;
  int code = cli_parse(self, argc, argv, &common, take, &c);
  return code >= 0 ? code : cli_batch_run(&c.batch, self, &common, c.input, c.from || c.to ? check_range : NULL);
}

const cli_command cli_ray_command = {
  "ray",
  "MODEL [OX OY OZ DX DY DZ ...]",
  "List every stretch of rays that lies inside a solid. Exact.",
  "A ray is the line o + t d, for all t (--from and --to cut it); d need not be a unit vector. Rays are arguments, or lines\n"
  "\"ox oy oz dx dy dz\" on standard input: blanks or commas between the numbers, # begins a comment, empty lines are\n"
  "skipped. A number is a decimal and means exactly what it spells: 0.1 is 1/10.\n"
  "Prints one line a ray: N, then N pairs t0 t1 in increasing order, each as %.17g, or -inf or inf. Which stretches there\n"
  "are and their order is exact; each t is the double nearest to the exact value.\n"
  "--surfaces makes each end three fields, t, part, surface (body, cap0, cap1, face K), or t - - where the ray is\n"
  "cut or infinite; the fields of a line then stand between tabs, since names may hold blanks.\n"
  "--boundary adds the field boundary, a count and so many pairs; --contacts then adds contacts, a count and so many ends.\n"
  "With --json a line is {\"inside\":[{\"enter\":{\"t\":0},\"leave\":{\"t\":1}}]}, with \"boundary\" and \"contacts\" after it,\n"
  "and \"part\" and \"surface\" after \"t\", if asked for; \"-inf\" and \"inf\" are strings.\n"
  "A wrong line ends the run with its place and exit code 2, after the answers to all lines before it.\n",
  options,
  run,
};
