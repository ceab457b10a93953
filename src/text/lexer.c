#include "text/lexer.h"

#include "base/limits.h"

#include <string.h>

void qn_lexer_init(qn_lexer *lexer, const qn_source *source, qn_reporter *reporter, qn_names *names, qn_ctx *numbers) {
  *lexer = (qn_lexer){.source = source, .reporter = reporter, .names = names, .numbers = numbers};
}

void qn_lexer_free(qn_lexer *lexer) {
  qn_free(lexer->names->arena.mem, lexer->scratch, lexer->scratch_capacity);
  lexer->scratch = NULL;
  lexer->scratch_capacity = 0;
}

enum { DIGIT = 1, LETTER = 2, BLANK = 4, MARK = 8 };
static const unsigned char classes[256] = {
  ['0'] = DIGIT, ['1'] = DIGIT, ['2'] = DIGIT, ['3'] = DIGIT, ['4'] = DIGIT, ['5'] = DIGIT, ['6'] = DIGIT, ['7'] = DIGIT, ['8'] = DIGIT,
  ['9'] = DIGIT, ['a'] = LETTER, ['b'] = LETTER, ['c'] = LETTER, ['d'] = LETTER, ['e'] = LETTER, ['f'] = LETTER, ['g'] = LETTER,
  ['h'] = LETTER, ['i'] = LETTER, ['j'] = LETTER, ['k'] = LETTER, ['l'] = LETTER, ['m'] = LETTER, ['n'] = LETTER, ['o'] = LETTER,
  ['p'] = LETTER, ['q'] = LETTER, ['r'] = LETTER, ['s'] = LETTER, ['t'] = LETTER, ['u'] = LETTER, ['v'] = LETTER, ['w'] = LETTER,
  ['x'] = LETTER, ['y'] = LETTER, ['z'] = LETTER, ['A'] = LETTER, ['B'] = LETTER, ['C'] = LETTER, ['D'] = LETTER, ['E'] = LETTER,
  ['F'] = LETTER, ['G'] = LETTER, ['H'] = LETTER, ['I'] = LETTER, ['J'] = LETTER, ['K'] = LETTER, ['L'] = LETTER, ['M'] = LETTER,
  ['N'] = LETTER, ['O'] = LETTER, ['P'] = LETTER, ['Q'] = LETTER, ['R'] = LETTER, ['S'] = LETTER, ['T'] = LETTER, ['U'] = LETTER,
  ['V'] = LETTER, ['W'] = LETTER, ['X'] = LETTER, ['Y'] = LETTER, ['Z'] = LETTER, ['_'] = LETTER, [' '] = BLANK, ['\t'] = BLANK,
  ['\n'] = BLANK, ['\r'] = BLANK, ['\f'] = BLANK, ['\v'] = BLANK, ['('] = MARK, [')'] = MARK, ['{'] = MARK, ['}'] = MARK,
  ['['] = MARK, [']'] = MARK, [','] = MARK, [';'] = MARK, [':'] = MARK, ['='] = MARK, ['+'] = MARK, ['-'] = MARK, ['*'] = MARK,
  ['/'] = MARK, ['%'] = MARK, ['^'] = MARK, ['<'] = MARK, ['>'] = MARK, ['?'] = MARK, ['!'] = MARK, ['#'] = MARK, ['.'] = MARK,
};

static int is(char c, int class) {
  return classes[(unsigned char)c] & class;
}
static int is_digit(char c) {
  return is(c, DIGIT);
}
static int is_letter(char c) {
  return is(c, LETTER);
}
static int is_word(char c) {
  return is(c, LETTER | DIGIT);
}
static int is_blank(char c) {
  return is(c, BLANK);
}

/* The length of the UTF-8 character at `at`, 0 when the bytes are not one (overlong forms, surrogates and numbers over
   10FFFF are none). Source: the Unicode Standard, table 3-7. */
static size_t utf8(const char *text, size_t length) {
  const unsigned char *s = (const unsigned char *)text;
  unsigned char c = s[0];
  if (c < 0x80) {
    return 1;
  }
  size_t n = c >= 0xC2 && c <= 0xDF ? 2 : c >= 0xE0 && c <= 0xEF ? 3 : c >= 0xF0 && c <= 0xF4 ? 4 : 0;
  if (n == 0 || n > length) {
    return 0;
  }
  unsigned char low = c == 0xE0 ? 0xA0 : c == 0xF0 ? 0x90 : 0x80, high = c == 0xED ? 0x9F : c == 0xF4 ? 0x8F : 0xBF;
  if (s[1] < low || s[1] > high) {
    return 0;
  }
  for (size_t i = 2; i < n; i++) {
    if ((s[i] & 0xC0) != 0x80) {
      return 0;
    }
  }
  return n;
}

static void skip_blanks(qn_lexer *lx) {
  const char *text = lx->source->text;
  size_t length = lx->source->length, at = lx->at;
  for (;;) {
    while (at < length && is_blank(text[at])) {
      at++;
    }
    if (at + 1 >= length || text[at] != '/') {
      break;
    }
    if (text[at + 1] == '/') {
      const char *end = memchr(text + at, '\n', length - at);
      at = end ? (size_t)(end - text) + 1 : length;
    } else if (text[at + 1] == '*') {
      size_t start = at;
      at += 2;
      for (;;) {
        const char *star = at < length ? memchr(text + at, '*', length - at) : NULL;
        if (!star) {
          qn_tell(lx->reporter, QN_Q0104, start, 2, "the file ends first", "end it with */", "this comment has no end");
          at = length;
          break;
        }
        at = (size_t)(star - text) + 1;
        if (at < length && text[at] == '/') {
          at++;
          break;
        }
      }
    } else {
      break;
    }
  }
  lx->at = at;
}

static void number(qn_lexer *lx) {
  const char *text = lx->source->text;
  size_t length = lx->source->length, start = lx->at, at = start, digits = 0;
  for (; at < length && is_digit(text[at]); at++) {
    digits++;
  }
  if (at < length && text[at] == '.') {
    for (at++; at < length && is_digit(text[at]); at++) {
      digits++;
    }
  }
  int good = digits > 0;
  if (good && at < length && (text[at] == 'e' || text[at] == 'E')) {
    size_t e = at + 1;
    if (e < length && (text[e] == '+' || text[e] == '-')) {
      e++;
    }
    good = e < length && is_digit(text[e]);
    for (at = e; at < length && is_digit(text[at]);) {
      at++;
    }
  }
  if (at < length && (is_word(text[at]) || text[at] == '.')) {
    good = 0;
    while (at < length && (is_word(text[at]) || text[at] == '.')) {
      at++;
    }
  }
  lx->at = at;
  lx->token.kind = QN_T_NUMBER;
  lx->token.number = QN_NUM_ZERO;
  if (!good) {
    lx->token.kind = QN_T_BAD;
    int shown = at - start < 40 ? (int)(at - start) : 40;
    int leads = digits && is_digit(text[start]) && memchr(text + start, '.', at - start) == NULL;
    qn_tell(lx->reporter, QN_Q0106, start, at - start, leads ? "a name does not begin with a digit" : NULL,
            "numbers look like 12, 0.5, 1e-3", "'%.*s' is not a number", shown, text + start);
    return;
  }
  quoin_status status = QUOIN_OK;
  size_t read = qn_num_read(lx->numbers, text + start, at - start, &lx->token.number, &status);
  if (status == QUOIN_E_LIMIT) {
    lx->token.kind = QN_T_BAD;
    size_t counted = 0; /* those from the first that is not 0, as the number's reader counts them */
    for (const char *c = text + start; c < text + at && *c != 'e' && *c != 'E'; c++) {
      counted += *c != '.' && (counted > 0 || *c != '0');
    }
    if (counted > QN_MAX_DIGITS) {
      qn_tell(lx->reporter, QN_Q0902, start, at - start, "at most 10000 digits are read", "shorten it",
              "number too long: %zu digits", counted);
    } else {
      qn_tell(lx->reporter, QN_Q0903, start, at - start, "its decimal exponent is beyond 4000", "use other units",
              "number out of range");
    }
  } else if (status != QUOIN_OK || read == 0) {
    lx->failed = status != QUOIN_OK ? status : QUOIN_E_MEMORY;
  }
}

static int keep_byte(qn_lexer *lx, size_t *n, char c) {
  if (*n >= lx->scratch_capacity && !qn_grow(lx->names->arena.mem, &lx->scratch, &lx->scratch_capacity, *n + 64)) {
    lx->failed = QUOIN_E_MEMORY;
    return 0;
  }
  lx->scratch[(*n)++] = c;
  return 1;
}

static int hex(const char *text, size_t length, unsigned digits, uint32_t *out) {
  *out = 0;
  if (length < digits) {
    return 0;
  }
  for (unsigned i = 0; i < digits; i++) {
    char c = text[i];
    int v = is_digit(c) ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
    if (v < 0) {
      return 0;
    }
    *out = *out * 16 + (uint32_t)v;
  }
  return 1;
}

static int keep_character(qn_lexer *lx, size_t *n, uint32_t c) {
  if (c < 0x80) {
    return keep_byte(lx, n, (char)c);
  }
  if (c < 0x800) {
    return keep_byte(lx, n, (char)(0xC0 | c >> 6)) && keep_byte(lx, n, (char)(0x80 | (c & 63)));
  }
  if (c < 0x10000) {
    return keep_byte(lx, n, (char)(0xE0 | c >> 12)) && keep_byte(lx, n, (char)(0x80 | (c >> 6 & 63))) &&
           keep_byte(lx, n, (char)(0x80 | (c & 63)));
  }
  return keep_byte(lx, n, (char)(0xF0 | c >> 18)) && keep_byte(lx, n, (char)(0x80 | (c >> 12 & 63))) &&
         keep_byte(lx, n, (char)(0x80 | (c >> 6 & 63))) && keep_byte(lx, n, (char)(0x80 | (c & 63)));
}

/* After a backslash at lx->at - 1: one escape. 0 when memory is refused. */
static int escape(qn_lexer *lx, size_t *n) {
  const char *text = lx->source->text;
  size_t left = lx->source->length - lx->at;
  char c = left ? text[lx->at] : '\0';
  const char *simple = "\"\\nrt", *value = "\"\\\n\r\t";
  const char *found = left && c ? strchr(simple, c) : NULL;
  if (found) {
    lx->at++;
    return keep_byte(lx, n, value[found - simple]);
  }
  unsigned digits = c == 'x' ? 2 : c == 'u' ? 4 : c == 'U' ? 6 : 0;
  uint32_t code;
  if (digits && hex(text + lx->at + 1, left - 1, digits, &code) && code != 0 && code <= 0x10FFFF &&
      !(code >= 0xD800 && code <= 0xDFFF)) {
    lx->at += 1 + digits;
    return keep_character(lx, n, code);
  }
  size_t shown = left ? utf8(text + lx->at, left) : 0;
  qn_tell(lx->reporter, QN_Q0105, lx->at - 1, 1 + shown, "known are \\\" \\\\ \\n \\r \\t \\xHH \\uHHHH \\UHHHHHH, not for the character 0",
          "write \\\\ for a backslash", "unknown escape \\%.*s in a string", (int)shown, text + lx->at);
  return 1;
}

static void string(qn_lexer *lx) {
  const char *text = lx->source->text;
  size_t length = lx->source->length, start = lx->at++, n = 0;
  lx->token.kind = QN_T_STRING;
  int told = 0;
  while (lx->at < length && text[lx->at] != '"') {
    char c = text[lx->at];
    if (c == '\\') {
      lx->at++;
      if (!escape(lx, &n)) {
        return;
      }
      continue;
    }
    size_t size = utf8(text + lx->at, length - lx->at);
    if (size == 0) {
      if (!told) {
        qn_tell(lx->reporter, QN_Q0102, lx->at, 1, "the byte is not part of a UTF-8 character", "save the file as UTF-8",
                "invalid byte 0x%02X in a string", (unsigned)(unsigned char)c);
        told = 1;
      }
      lx->at++;
      continue;
    }
    for (; size > 0; size--) {
      if (!keep_byte(lx, &n, text[lx->at++])) {
        return;
      }
    }
  }
  if (lx->at >= length) {
    /* The quote is what is wrong; go on behind its line, so that the rest of the file is looked at too. */
    const char *end = memchr(text + start, '\n', length - start);
    lx->at = end ? (size_t)(end - text) : length;
    lx->token.kind = QN_T_BAD;
    qn_tell(lx->reporter, QN_Q0103, start, 1, "the file ends first", "close it with \"", "this string has no closing quote");
    return;
  }
  lx->at++;
  lx->token.name = qn_names_find(lx->names, lx->scratch ? lx->scratch : "", n);
  if (lx->token.name == QN_NO_NAME) {
    lx->failed = QUOIN_E_MEMORY;
  }
}

/* A run of bytes that can begin no token: told once. */
static void junk(qn_lexer *lx) {
  const char *text = lx->source->text;
  size_t length = lx->source->length, start = lx->at;
  size_t size = utf8(text + start, length - start);
  unsigned char first = (unsigned char)text[start];
  lx->at += size ? size : 1;
  while (lx->at < length && ((unsigned char)text[lx->at] >= 0x80 || (unsigned char)text[lx->at] < 9)) {
    lx->at++;
  }
  lx->token.kind = QN_T_BAD;
  if (size > 1) {
    int quote = size == 3 && (memcmp(text + start, "\xE2\x80\x9C", 3) == 0 || memcmp(text + start, "\xE2\x80\x9D", 3) == 0);
    const char *way_out = quote ? "use plain quotes \"" : "such characters may stand in strings and comments";
    qn_tell(lx->reporter, QN_Q0102, start, lx->at - start, "names and operators are ASCII", way_out, "unexpected character '%.*s'",
            (int)size, text + start);
  } else if (first >= 0x80) {
    qn_tell(lx->reporter, QN_Q0102, start, lx->at - start, "the bytes are not UTF-8", "save the file as UTF-8 text",
            "invalid byte 0x%02X", (unsigned)first);
  } else if (first < 32 || first == 127) {
    qn_tell(lx->reporter, QN_Q0102, start, lx->at - start, NULL, "remove it", "control character 0x%02X", (unsigned)first);
  } else {
    qn_tell(lx->reporter, QN_Q0102, start, lx->at - start, NULL, first == '\'' ? "strings stand in double quotes" : "remove it",
            "unexpected character '%c'", (char)first);
  }
}

void qn_lexer_next(qn_lexer *lx) {
  lx->last_end = lx->at;
  skip_blanks(lx);
  const char *text = lx->source->text;
  size_t length = lx->source->length, start = lx->at;
  lx->token = (qn_token){.kind = QN_T_END, .offset = (uint32_t)start};
  if (start >= length || lx->failed || lx->reporter->stop) {
    lx->at = length;
    lx->token.offset = (uint32_t)length;
    return;
  }
  char c = text[start], d = start + 1 < length ? text[start + 1] : '\0';
  if (is_letter(c) || (c == '$' && is_word(d))) {
    size_t at = start + 1;
    while (at < length && is_word(text[at])) {
      at++;
    }
    lx->at = at;
    lx->token.kind = QN_T_NAME;
    lx->token.name = qn_names_find(lx->names, text + start, at - start);
    if (lx->token.name == QN_NO_NAME) {
      lx->failed = QUOIN_E_MEMORY;
    }
  } else if (is_digit(c) || (c == '.' && is_digit(d))) {
    number(lx);
  } else if (c == '"') {
    string(lx);
  } else {
    qn_token_kind two = c == '&' && d == '&'   ? QN_T_AND
                        : c == '|' && d == '|' ? QN_T_OR
                        : d != '='             ? QN_T_MARK
                        : c == '='             ? QN_T_EQUAL
                        : c == '!'             ? QN_T_NOT_EQUAL
                        : c == '<'             ? QN_T_LESS_EQUAL
                        : c == '>'             ? QN_T_GREATER_EQUAL
                                               : QN_T_MARK;
    if (two != QN_T_MARK) {
      lx->token.kind = two;
      lx->at += 2;
    } else if (is(c, MARK)) {
      lx->token.kind = QN_T_MARK;
      lx->token.mark = c;
      lx->at++;
    } else {
      junk(lx);
    }
  }
  lx->token.length = (uint32_t)(lx->at - start);
  if (lx->failed) {
    lx->token = (qn_token){.kind = QN_T_END, .offset = (uint32_t)length};
    lx->at = length;
  }
}

int qn_lexer_path(qn_lexer *lx) {
  const char *text = lx->source->text;
  size_t length = lx->source->length;
  skip_blanks(lx);
  if (lx->at >= length || text[lx->at] != '<') {
    return 0;
  }
  size_t at = lx->at;
  while (at < length && text[at] != '>' && text[at] != '\n') {
    at++;
  }
  if (at >= length || text[at] != '>') {
    return 0;
  }
  lx->at = at + 1;
  qn_lexer_next(lx);
  return 1;
}
