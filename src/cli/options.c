#include "cli/options.h"
#include "cli/out.h"
#include "cli/say.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* A word that starts with '-' and is yet no option: "-", a negative number, or what printf makes of a negative one that
   is not finite (so that the message will be about the number). */
static int is_operand(const char *word) {
  if (word[0] != '-' || word[1] == '\0') {
    return 1;
  }
  char c = word[1], d = c == '.' ? word[2] : c;
  return (d >= '0' && d <= '9') || strcasecmp(word, "-inf") == 0 || strcasecmp(word, "-nan") == 0 || strcasecmp(word, "-infinity") == 0;
}

int cli_try_help(const cli_command *command) {
  fprintf(stderr, "Try 'quoin %s%s--help'.\n", command ? command->name : "", command ? " " : "");
  return CLI_USAGE;
}

static void put_option(cli_text *text, const cli_option *o) {
  enum { COLUMN = 30 };
  size_t start = text->length;
  cli_puts(text, "  ");
  if (o->letter) {
    cli_putf(text, "-%c, ", o->letter);
  }
  cli_putf(text, "--%s", o->name);
  if (o->value) {
    cli_putf(text, " %s", o->value);
  }
  size_t width = text->length - start;
  if (width + 2 > COLUMN) {
    cli_puts(text, "\n");
    width = 0;
  }
  for (const char *line = o->help; line;) {
    const char *end = strchr(line, '\n');
    cli_putf(text, "%*s", (int)(COLUMN - width), "");
    cli_put(text, line, end ? (size_t)(end - line) : strlen(line));
    cli_puts(text, "\n");
    width = 0;
    line = end ? end + 1 : NULL;
  }
}

int cli_help(const cli_command *command) {
  cli_text text = {0};
  cli_putf(&text, "Usage: quoin %s [OPTION ...] %s\n", command->name, command->operands);
  cli_putf(&text, "%s\n\n", command->summary);
  cli_puts(&text, command->details);
  cli_puts(&text, "\nOptions:\n");
  for (const cli_option *o = command->options; o->name; o++) {
    put_option(&text, o);
  }
  cli_puts(&text, "\nA MODEL of - is standard input; -- ends options; a negative number is never an option.\n"
                  "Exit codes: 0 answered; 1 the answer is no (query --exit-code); 2 wrong usage; 3 bad model;\n"
                  "4 input, output or memory failed.\n");
  cli_out out;
  cli_out_open(&out, NULL);
  cli_out_text(&out, &text);
  cli_text_free(&text);
  return cli_out_close(&out, 1);
}

/* --- suggestions ---------------------------------------------------------------------------------------------------- */

enum { LONGEST = 32 };

/* Edits (a letter put in, taken out, changed, or two swapped) between two words of at most LONGEST letters. */
static unsigned distance(const char *a, const char *b) {
  unsigned rows[3][LONGEST + 1];
  size_t n = strlen(a), m = strlen(b);
  for (size_t j = 0; j <= m; j++) {
    rows[0][j] = (unsigned)j;
  }
  for (size_t i = 1; i <= n; i++) {
    unsigned *now = rows[i % 3], *before = rows[(i + 2) % 3], *older = rows[(i + 1) % 3];
    now[0] = (unsigned)i;
    for (size_t j = 1; j <= m; j++) {
      unsigned best = before[j - 1] + (a[i - 1] != b[j - 1]);
      best = before[j] + 1 < best ? before[j] + 1 : best;
      best = now[j - 1] + 1 < best ? now[j - 1] + 1 : best;
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && older[j - 2] + 1 < best) {
        best = older[j - 2] + 1;
      }
      now[j] = best;
    }
  }
  return rows[n % 3][m];
}

const char *cli_nearest(const char *word, const char *(*names)(const void *user, int i), const void *user) {
  size_t length = strlen(word);
  if (length == 0 || length > LONGEST) {
    return NULL;
  }
  const char *nearest = NULL, *begun = NULL;
  unsigned best = (unsigned)length / 3 + 1;
  int several = 0;
  for (int i = 0;; i++) {
    const char *name = names(user, i);
    if (!name) {
      break;
    }
    if (strlen(name) > LONGEST) {
      continue;
    }
    unsigned d = distance(word, name);
    if (d < best || (d == best && !nearest)) {
      best = d;
      nearest = name;
    }
    if (length >= 2 && strncmp(word, name, length) == 0) { /* "--proj" */
      several = begun != NULL;
      begun = name;
    }
  }
  return begun && !several ? begun : nearest;
}

static const char *option_name(const void *user, int i) {
  const cli_option *options = user;
  return options[i].name;
}

/* --- values --------------------------------------------------------------------------------------------------------- */

int cli_take_unsigned(const char *option, const char *value, unsigned long low, unsigned long high, unsigned *out) {
  unsigned long n = 0;
  int good = value && value[0] != '\0'; /* the command line's options that take a value have one */
  for (const char *c = value; good && *c; c++) {
    good = *c >= '0' && *c <= '9';
    if (good && n <= high) { /* once above, it stays above */
      n = n * 10 + (unsigned long)(*c - '0');
    }
  }
  if (!good || n < low || n > high) {
    cli_quoted q;
    cli_error("%s is not a value for --%s; give a whole number from %lu to %lu", cli_quote(&q, value), option, low, high);
    return -1;
  }
  *out = (unsigned)n;
  return 0;
}

int cli_take_numbers(const char *option, const char *value, int count, double *out) {
  cli_quoted q;
  const char *at = value;
  for (int i = 0; i < count; i++) {
    at += strspn(at, " ");
    size_t length = strspn(at, "0123456789+-.eE"); /* strtod alone would also take inf, nan and hexadecimals */
    char *end;
    out[i] = strtod(at, &end);
    if (length == 0 || end != at + length || !isfinite(out[i])) {
      const char *why = length > 0 && end == at + length ? " (a number is beyond the range of doubles)" : "";
      if (count == 1) {
        cli_error("%s is not a value for --%s%s; give a decimal number", cli_quote(&q, value), option, why);
      } else {
        cli_error("%s is not a value for --%s%s; give %d decimal numbers with commas between them", cli_quote(&q, value), option, why, count);
      }
      return -1;
    }
    at = end + strspn(end, " ");
    if (i + 1 < count && *at == ',') {
      at++;
    }
  }
  if (*at) {
    cli_error("%s is not a value for --%s; give exactly %d number%s", cli_quote(&q, value), option, count, count == 1 ? "" : "s");
    return -1;
  }
  return 0;
}

int cli_take_size(const char *option, const char *value, size_t *out) {
  size_t n = 0;
  int good = value[0] >= '0' && value[0] <= '9';
  const char *c = value;
  for (; *c >= '0' && *c <= '9' && good; c++) {
    size_t digit = (size_t)(*c - '0');
    good = n <= (SIZE_MAX - digit) / 10;
    n = good ? 10 * n + digit : n;
  }
  const char *units = "KMG", *unit = *c ? strchr(units, *c == 'k' || *c == 'm' || *c == 'g' ? *c - 'a' + 'A' : *c) : NULL;
  unsigned shift = unit ? 10 * (unsigned)(unit - units + 1) : 0;
  if (!good || n == 0 || c[unit != NULL] != '\0' || n > SIZE_MAX >> shift) {
    cli_quoted q;
    cli_error("%s is not a value for --%s; give a size such as 500M: bytes, or with K, M or G", cli_quote(&q, value), option);
    return -1;
  }
  *out = n << shift;
  return 0;
}

enum { LONGEST_DECIMAL = 1000 };

int cli_take_decimal(const char *option, const char *value) {
  char *end;
  double v = strtod(value, &end); /* NOLINT(clang-analyzer-core.NonNullParamChecker): as above, there is one */
  if (value[0] == '\0' || strspn(value, "0123456789+-.eE") != strlen(value) || *end || !(v >= 0) || value[0] == '-') {
    cli_quoted q;
    cli_error("%s is not a value for --%s; give a decimal number, 0 or more", cli_quote(&q, value), option);
    return -1;
  }
  if (strlen(value) > LONGEST_DECIMAL || v > 1e300 || (v < 1e-300 && strspn(value, "+-.0") != strcspn(value, "eE"))) {
    cli_quoted q;
    cli_error("%s is out of range for --%s; give 0, or a number from 1e-300 to 1e300 in at most %d characters", cli_quote(&q, value), option, LONGEST_DECIMAL);
    return -1;
  }
  return 0;
}

static int take_common(cli_common *common, int id, const char *value) {
  cli_quoted q;
  switch (id) {
  case CLI_QUIET: common->quiet = 1; return 0;
  case CLI_STATS: common->stats = 1; return 0;
  case CLI_MAX_MEMORY: return cli_take_size("max-memory", value, &common->max_memory);
  case CLI_SNAP: common->snap = value; return cli_take_decimal("snap", value);
  case CLI_THREADS: return cli_take_unsigned("threads", value, 0, 1024, &common->threads);
  case CLI_FACETS:
    if (strcmp(value, "auto") == 0) { /* NOLINT(clang-analyzer-core.NonNullParamChecker): there is one */
      common->facets = QUOIN_FACETS_AUTO;
    } else if (strcmp(value, "honour") == 0 || strcmp(value, "honor") == 0) {
      common->facets = QUOIN_FACETS_HONOUR;
    } else if (strcmp(value, "ignore") == 0) {
      common->facets = QUOIN_FACETS_IGNORE;
    } else {
      cli_error("%s is not a value for --facets; give auto, honour or ignore", cli_quote(&q, value));
      return -1;
    }
    return 0;
  default: return -1;
  }
}

/* --- the loop ------------------------------------------------------------------------------------------------------- */

typedef struct state {
  const cli_command *command;
  cli_common *common;
  int (*take)(void *user, int id, const char *value);
  void *user;
  int argc, at; /* at: the next argument */
  char **argv;
} state;

/* Uses one option. value is what was joined to it, or null. */
static int use(state *s, const cli_option *o, const char *value) {
  if (o->id == CLI_HELP) {
    return cli_help(s->command);
  }
  if (o->value && !value) {
    if (s->at == s->argc) {
      cli_error("option '--%s' needs a value: --%s %s", o->name, o->name, o->value);
      return cli_try_help(s->command);
    }
    value = s->argv[s->at++];
  }
  value = value ? value : ""; /* of an option without one */
  int wrong = o->id < CLI_OWN ? take_common(s->common, o->id, value) : s->take(s->user, o->id, value);
  return wrong ? cli_try_help(s->command) : -1;
}

static int use_long(state *s, const char *word) {
  const char *equals = strchr(word, '=');
  size_t length = equals ? (size_t)(equals - word) : strlen(word);
  for (const cli_option *o = s->command->options; o->name; o++) {
    if (strlen(o->name) == length && strncmp(o->name, word, length) == 0) {
      if (equals && !o->value) {
        cli_error("option '--%s' takes no value", o->name);
        return cli_try_help(s->command);
      }
      return use(s, o, equals ? equals + 1 : NULL);
    }
  }
  cli_quoted q;
  char name[64] = "--";
  memcpy(name + 2, word, length < sizeof name - 3 ? length : sizeof name - 3);
  const char *nearest = cli_nearest(name + 2, option_name, s->command->options);
  if (nearest) {
    cli_error("unknown option %s; did you mean '--%s'?", cli_quote(&q, name), nearest);
  } else {
    cli_error("unknown option %s", cli_quote(&q, name));
  }
  return cli_try_help(s->command);
}

/* -q, -qo FILE, -oFILE */
static int use_letters(state *s, const char *letters) {
  for (; *letters; letters++) {
    const cli_option *o = s->command->options;
    while (o->name && o->letter != *letters) {
      o++;
    }
    if (!o->name) {
      cli_quoted q;
      char word[3] = {'-', *letters, '\0'};
      const char *nearest = letters[1] ? cli_nearest(letters, option_name, s->command->options) : NULL; /* "-stats" */
      if (nearest) {
        cli_error("unknown option %s; did you mean '--%s'?", cli_quote(&q, word), nearest);
      } else {
        cli_error("unknown option %s", cli_quote(&q, word));
      }
      return cli_try_help(s->command);
    }
    if (o->value) {
      return use(s, o, letters[1] ? letters + 1 : NULL);
    }
    int code = use(s, o, NULL);
    if (code >= 0) {
      return code;
    }
  }
  return -1;
}

int cli_parse(const cli_command *command, int argc, char **argv, cli_common *common, int (*take)(void *user, int id, const char *value),
              void *user) {
  *common = (cli_common){.facets = QUOIN_FACETS_AUTO, .operands = argv};
  state s = {command, common, take, user, argc, 0, argv};
  int ended = 0;
  while (s.at < s.argc) {
    char *word = argv[s.at++];
    int code = -1;
    if (ended || is_operand(word)) {
      argv[common->operand_count++] = word; /* never ahead of s.at */
    } else if (strcmp(word, "--") == 0) {
      ended = 1;
    } else if (word[1] == '-') {
      code = use_long(&s, word + 2);
    } else {
      code = use_letters(&s, word + 1);
    }
    if (code >= 0) {
      return code;
    }
  }
  return -1;
}
