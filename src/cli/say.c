#include "cli/say.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Standard error is the last place to complain to: when it fails, nothing is left to say, and the code tells. */

void cli_error(const char *format, ...) {
  va_list args;
  va_start(args, format);
  fputs("quoin: error: ", stderr);
  vfprintf(stderr, format, args);
  fputc('\n', stderr);
  va_end(args);
}

const char *cli_quote(cli_quoted *buffer, const char *word) {
  char *text = buffer->text;
  size_t size = sizeof buffer->text, at = 0;
  text[at++] = '\'';
  for (; *word && at + 5 < size; word++) {
    unsigned char c = (unsigned char)*word;
    text[at++] = c < 32 || c == 127 ? '?' : (char)c;
  }
  if (*word) {
    while (at > 1 && ((unsigned char)text[at - 1] & 0xC0) == 0x80) { /* no half characters */
      at--;
    }
    at -= at > 1 && ((unsigned char)text[at - 1] & 0x80);
    memcpy(text + at, "...", 3);
    at += 3;
  }
  text[at++] = '\'';
  text[at] = '\0';
  return text;
}

void cli_say_diag(const quoin_diag *diag) {
  char small[1024];
  size_t need = quoin_diag_format(diag, small, sizeof small);
  if (need < sizeof small) {
    fputs(small, stderr);
    return;
  }
  char *text = malloc(need + 1);
  if (text) {
    quoin_diag_format(diag, text, need + 1);
  }
  fputs(text ? text : small, stderr);
  free(text);
}

size_t cli_say_diags(const quoin_model *model, int quiet) {
  size_t errors = 0, count = quoin_model_diag_count(model);
  for (size_t i = 0; i < count; i++) {
    quoin_diag diag;
    if (quoin_model_diag(model, i, &diag) == QUOIN_OK) {
      errors += diag.severity == QUOIN_ERROR;
      if (diag.severity == QUOIN_ERROR || !quiet) {
        cli_say_diag(&diag);
      }
    }
  }
  return errors;
}

int cli_code(quoin_status status) {
  switch (status) {
  case QUOIN_OK: return CLI_OK;
  case QUOIN_E_MODEL:
  case QUOIN_E_LIMIT: return CLI_MODEL;
  case QUOIN_E_ARGUMENT:
  case QUOIN_E_NUMBER: return CLI_USAGE;
  case QUOIN_E_MEMORY:
  case QUOIN_E_IO:
  case QUOIN_E_CANCELLED: return CLI_IO;
  }
  return CLI_IO;
}
