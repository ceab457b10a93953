#include "cli/text.h"

#include "cli/number.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void cli_text_free(cli_text *text) {
  free(text->data);
  *text = (cli_text){0};
}

/* Makes room for `more` bytes; 0 when there is none. */
static int room(cli_text *text, size_t more) {
  if (text->capacity - text->length >= more) {
    return 1;
  }
  if (text->failed || more > SIZE_MAX / 2 - text->length) {
    text->failed = 1;
    return 0;
  }
  size_t capacity = text->capacity ? text->capacity : 256;
  while (capacity - text->length < more) {
    capacity = capacity > SIZE_MAX / 2 ? text->length + more : capacity * 2;
  }
  char *moved = realloc(text->data, capacity);
  if (!moved) {
    text->failed = 1;
    return 0;
  }
  text->data = moved;
  text->capacity = capacity;
  return 1;
}

void cli_put(cli_text *text, const char *bytes, size_t length) {
  if (length && room(text, length)) {
    memcpy(text->data + text->length, bytes, length);
    text->length += length;
  }
}

void cli_puts(cli_text *text, const char *words) {
  cli_put(text, words, strlen(words));
}

void cli_putf(cli_text *text, const char *format, ...) {
  char piece[256];
  va_list args;
  va_start(args, format);
  int length = vsnprintf(piece, sizeof piece, format, args);
  va_end(args);
  if (length > 0) {
    cli_put(text, piece, (size_t)length < sizeof piece ? (size_t)length : sizeof piece - 1);
  }
}

void cli_put_number(cli_text *text, double x) {
  if (room(text, CLI_NUMBER_SIZE)) {
    text->length += cli_format_number(text->data + text->length, x);
  }
}

void cli_put_field(cli_text *text, const char *name) {
  for (; *name; name++) {
    unsigned char c = (unsigned char)*name;
    switch (c) {
    case '\t': cli_puts(text, "\\t"); break;
    case '\n': cli_puts(text, "\\n"); break;
    case '\r': cli_puts(text, "\\r"); break;
    case '\\': cli_puts(text, "\\\\"); break;
    default:
      if (c < 32 || c == 127) {
        cli_putf(text, "\\x%02x", c);
      } else {
        cli_put(text, name, 1);
      }
    }
  }
}

/* The length of the UTF-8 character at s, 0 when the bytes there are none (RFC 3629: shortest form, no surrogates). */
static size_t utf8(const unsigned char *s) {
  size_t length = s[0] < 0x80 ? 1 : s[0] >= 0xC2 && s[0] < 0xE0 ? 2 : (s[0] & 0xF0) == 0xE0 ? 3 : s[0] >= 0xF0 && s[0] < 0xF5 ? 4 : 0;
  for (size_t i = 1; i < length; i++) {
    if ((s[i] & 0xC0) != 0x80) {
      return 0;
    }
  }
  if ((s[0] == 0xE0 && s[1] < 0xA0) || (s[0] == 0xED && s[1] > 0x9F) || (s[0] == 0xF0 && s[1] < 0x90) || (s[0] == 0xF4 && s[1] > 0x8F)) {
    return 0;
  }
  return length;
}

void cli_put_json(cli_text *text, const char *string) {
  cli_puts(text, "\"");
  while (*string) {
    size_t length = utf8((const unsigned char *)string);
    unsigned char c = (unsigned char)*string;
    if (length == 0) {
      cli_puts(text, "\\ufffd");
      length = 1;
    } else if (c == '"' || c == '\\') {
      cli_putf(text, "\\%c", c);
    } else if (c < 32 || c == 127) {
      cli_putf(text, "\\u%04x", c);
    } else {
      cli_put(text, string, length);
    }
    string += length;
  }
  cli_puts(text, "\"");
}

void cli_put_json_number(cli_text *text, double x) {
  if (isfinite(x)) {
    cli_put_number(text, x);
  } else {
    cli_puts(text, x > 0 ? "\"inf\"" : "\"-inf\"");
  }
}
