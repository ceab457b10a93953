/* Tokens: kinds, places, values; comments; and what is told about bytes that are none. */
#include "text/lexer.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

typedef struct bench {
  qn_mem mem;
  qn_diags diags;
  qn_source source;
  qn_reporter reporter;
  qn_names names;
  qn_ctx ctx;
  qn_lexer lexer;
} bench;

static void start(bench *b, const char *text, size_t length) {
  qn_mem_init(&b->mem, NULL);
  qn_diags_init(&b->diags, &b->mem);
  unsigned file = qn_diags_file(&b->diags, "t");
  assert_true(qn_source_init(&b->source, &b->mem, file, text, length));
  qn_reporter_init(&b->reporter, &b->diags, &b->source, 100);
  assert_true(qn_names_init(&b->names, &b->mem));
  qn_ctx_init(&b->ctx, &b->mem);
  qn_lexer_init(&b->lexer, &b->source, &b->reporter, &b->names, &b->ctx);
}

static void end(bench *b) {
  qn_lexer_free(&b->lexer);
  qn_names_free(&b->names);
  qn_ctx_free(&b->ctx);
  qn_source_free(&b->source);
  qn_diags_free(&b->diags);
  assert_int_equal(atomic_load(&b->mem.used), 0);
}

/* The tokens as text, one blank between: names and marks as they are, numbers by qn_num_text, strings in < >. */
static void tokens(const char *text, size_t length, const char *want, const char *codes) {
  bench b;
  start(&b, text, length);
  char got[2000] = "";
  for (qn_lexer_next(&b.lexer); b.lexer.token.kind != QN_T_END; qn_lexer_next(&b.lexer)) {
    const qn_token *t = &b.lexer.token;
    char one[500];
    switch (t->kind) {
    case QN_T_NUMBER: snprintf(one, sizeof one, "%s", qn_num_text(&b.ctx, t->number)); break;
    case QN_T_STRING: snprintf(one, sizeof one, "<%s>", b.names.items[t->name].text); break;
    case QN_T_NAME: snprintf(one, sizeof one, "%s", b.names.items[t->name].text); break;
    case QN_T_BAD: snprintf(one, sizeof one, "BAD"); break;
    default: snprintf(one, sizeof one, "%.*s", (int)t->length, b.source.text + t->offset); break;
    }
    strcat(got, got[0] ? " " : "");
    strcat(got, one);
  }
  assert_string_equal(got, want);
  char said[200] = "";
  for (size_t i = 0; i < b.diags.count; i++) {
    strcat(said, i ? " " : "");
    strcat(said, b.diags.items[i].code);
  }
  assert_string_equal(said, codes);
  end(&b);
}
#define TOKENS(text, want, codes) tokens(text, sizeof(text) - 1, want, codes)

static void kinds(void **state) {
  (void)state;
  TOKENS("", "", "");
  TOKENS("cube([1,2.5,-3]);", "cube ( [ 1 , 2.5 , - 3 ] ) ;", "");
  TOKENS("a&&b||!c==d!=e<=f>=g<h>i", "a && b || ! c == d != e <= f >= g < h > i", "");
  TOKENS("x = a ? b : c % d ^ e;", "x = a ? b : c % d ^ e ;", "");
  TOKENS("$fn _a a1 A_9", "$fn _a a1 A_9", "");
  TOKENS("#%!*{}", "# % ! * { }", "");
  TOKENS("v.x [0].y", "v . x [ 0 ] . y", "");
}

static void numbers(void **state) {
  (void)state;
  TOKENS("0 00 1 007 12.50 .5 5. 1e3 1E+3 1e-7 2.5e2", "0 0 1 7 12.5 0.5 5 1000 1000 1e-07 250", "");
  TOKENS("+3 -0", "+ 3 - 0", "");
  TOKENS("0.1234567890123456789012345678901234", "0.1234567890123456789012345678901234", "");
  TOKENS("1..2", "BAD", "Q0106");
  TOKENS("1e+ 2", "BAD 2", "Q0106");
  TOKENS("0x10 1.2.3 3d", "BAD BAD BAD", "Q0106 Q0106 Q0106");
  TOKENS("1e4001 1e-4001 0e9999", "BAD BAD 0", "Q0903 Q0903");
}

static void comments(void **state) {
  (void)state;
  TOKENS("a // b\nc /* d\n * e */ f /**/ g /*/ h */ i", "a c f g i", "");
  TOKENS("a / b /", "a / b /", "");
  TOKENS("a //", "a", "");
  TOKENS("a /* b", "a", "Q0104");
  TOKENS("a /* b *", "a", "Q0104");
  TOKENS("// \xff\xfe\r\nb", "b", "");
}

static void strings(void **state) {
  (void)state;
  TOKENS("\"\" \"a b\"", "<> <a b>", "");
  TOKENS("\"q\\\"b\\\\n\\n\\t\\r\"", "<q\"b\\n\n\t\r>", "");
  TOKENS("\"\\x41\\u00e9\\u20ac\\U01f600\"", "<A\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80>", "");
  TOKENS("\"// no comment /*\"", "<// no comment /*>", "");
  TOKENS("\"two\nlines\"", "<two\nlines>", "");
  TOKENS("\"a\\qb\\x0\\ud800\"", "<aqbx0ud800>", "Q0105 Q0105 Q0105");
  TOKENS("\"open\nb c", "BAD b c", "Q0103");
  TOKENS("\"a\xC3\"", "<a>", "Q0102");
  TOKENS("\"\\", "BAD", "Q0105 Q0103");
}

static void junk(void **state) {
  (void)state;
  TOKENS("a \xC2\xA7 b", "a BAD b", "Q0102");
  TOKENS("\xff\xfe\xfd\xfc b", "BAD b", "Q0102"); /* one run, told once */
  TOKENS("a @ ` \\ ~ ' $ & |", "a BAD BAD BAD BAD BAD BAD BAD BAD", "Q0102 Q0102 Q0102 Q0102 Q0102 Q0102 Q0102 Q0102");
  TOKENS("\x01\x02\x7f", "BAD BAD", "Q0102 Q0102");
  TOKENS("\xEF\xBB\xBF" "a", "a", "");          /* a byte order mark */
  TOKENS("a\xEF\xBB\xBF", "a BAD", "Q0102"); /* only at the start */
}

static void places(void **state) {
  (void)state;
  static const char text[] = "ab\n  cd\r\n\n\tef";
  bench b;
  start(&b, text, sizeof text - 1);
  static const unsigned want[3][2] = {{1, 1}, {2, 3}, {4, 2}};
  for (int i = 0; i < 3; i++) {
    qn_lexer_next(&b.lexer);
    assert_int_equal(b.lexer.token.length, 2);
    size_t hint = i == 1 ? 3 : 0; /* a hint may be wrong */
    qn_loc loc = qn_source_loc(&b.source, b.lexer.token.offset, &hint);
    assert_int_equal(loc.line, want[i][0]);
    assert_int_equal(loc.column, want[i][1]);
  }
  size_t length;
  const char *line = qn_source_line(&b.source, 2, 1, &length);
  assert_int_equal(length, 4); /* without the CR */
  assert_memory_equal(line, "  cd", 4);
  assert_int_equal((qn_source_line(&b.source, 4, 1, &length), length), 3);
  end(&b);
}

/* Every prefix of a text that has everything: no crash, and no byte is read behind the end. */
static void prefixes(void **state) {
  (void)state;
  static const char text[] = "x = 1.5e3; /* c */ name(\"\\u00e9\\x41\xE2\x82\xAC\") // d\n<=&&||!==\xF0\x9F\x98\x80 1e-7 $fn \xE2\x80\x9C \xC2\xA7";
  for (size_t n = 0; n < sizeof text; n++) {
    char *copy = test_malloc(n + 1); /* so that a sanitizer sees a read past the end */
    memcpy(copy, text, n);
    bench b;
    start(&b, copy, n);
    size_t count = 0;
    do {
      qn_lexer_next(&b.lexer);
      assert_true(b.lexer.token.offset + b.lexer.token.length <= n);
    } while (b.lexer.token.kind != QN_T_END && ++count < 100);
    assert_true(count < 100);
    end(&b);
    test_free(copy);
  }
}

static void distances(void **state) {
  (void)state;
  assert_int_equal(qn_names_distance("cube", "cube", 2), 0);
  assert_int_equal(qn_names_distance("cbue", "cube", 2), 1);
  assert_int_equal(qn_names_distance("cub", "cube", 2), 1);
  assert_int_equal(qn_names_distance("cubes", "cube", 2), 1);
  assert_int_equal(qn_names_distance("kuve", "cube", 2), 2);
  assert_int_equal(qn_names_distance("", "ab", 2), 2);
  assert_true(qn_names_distance("sphere", "cube", 2) > 2);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(kinds), cmocka_unit_test(numbers), cmocka_unit_test(comments), cmocka_unit_test(strings),
    cmocka_unit_test(junk),  cmocka_unit_test(places),  cmocka_unit_test(prefixes), cmocka_unit_test(distances),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
