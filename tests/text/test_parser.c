/* The syntax tree: postfix code of expressions, scopes and children of statements, recovery. */
#include "text/parse.h"

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
  qn_syntax syntax;
  qn_ctx ctx;
  quoin_status status;
} bench;

static void start(bench *b, const char *text) {
  qn_mem_init(&b->mem, NULL);
  qn_diags_init(&b->diags, &b->mem);
  assert_true(qn_source_init(&b->source, &b->mem, qn_diags_file(&b->diags, "t"), text, strlen(text)));
  qn_reporter_init(&b->reporter, &b->diags, &b->source, 100);
  qn_ctx_init(&b->ctx, &b->mem);
  assert_true(qn_syntax_init(&b->syntax, &b->mem));
  b->status = qn_parse(&b->syntax, &b->source, &b->reporter, &b->ctx);
}

static void end(bench *b) {
  qn_syntax_free(&b->syntax);
  qn_ctx_free(&b->ctx);
  qn_source_free(&b->source);
  qn_diags_free(&b->diags);
  assert_int_equal(atomic_load(&b->mem.used), 0);
}

static void code(bench *b, uint32_t from, uint32_t to, char *out) {
  static const char *const words[] = {
    [QN_OP_TRUE] = "true", [QN_OP_FALSE] = "false", [QN_OP_UNDEF] = "undef", [QN_OP_BAD] = "bad", [QN_OP_INDEX] = "[]", [QN_OP_NEGATE] = "neg",
    [QN_OP_PLUS] = "pos", [QN_OP_NOT] = "!", [QN_OP_ADD] = "+", [QN_OP_SUBTRACT] = "-", [QN_OP_MULTIPLY] = "*", [QN_OP_DIVIDE] = "/",
    [QN_OP_REMAINDER] = "%", [QN_OP_POWER] = "^", [QN_OP_LESS] = "<", [QN_OP_LESS_EQUAL] = "<=", [QN_OP_GREATER] = ">",
    [QN_OP_GREATER_EQUAL] = ">=", [QN_OP_EQUAL] = "==", [QN_OP_NOT_EQUAL] = "!=", [QN_OP_BOOL] = "bool"};
  out[0] = '\0';
  for (uint32_t i = from; i < to; i++) {
    const qn_op *op = &b->syntax.ops[i];
    char one[100];
    const qn_name *names = b->syntax.names.items;
    switch ((qn_op_kind)op->kind) {
    case QN_OP_SMALL: {
      qn_num n = {.u.m = (int32_t)op->a, .a = op->e2, .b = op->e5};
      snprintf(one, sizeof one, "%s", qn_num_text(&b->ctx, n));
      break;
    }
    case QN_OP_NUMBER: snprintf(one, sizeof one, "%s", qn_num_text(&b->ctx, b->syntax.numbers[op->a])); break;
    case QN_OP_STRING: snprintf(one, sizeof one, "\"%s\"", names[op->a].text); break;
    case QN_OP_LOAD: snprintf(one, sizeof one, "%s", names[op->a].text); break;
    case QN_OP_MEMBER: snprintf(one, sizeof one, ".%s", names[op->a].text); break;
    case QN_OP_VECTOR: snprintf(one, sizeof one, "vec%u", (unsigned)op->a); break;
    case QN_OP_CALL:
      snprintf(one, sizeof one, "%s/%u", names[b->syntax.calls[op->a].name].text, (unsigned)b->syntax.calls[op->a].arguments);
      break;
    case QN_OP_AND:
    case QN_OP_OR:
    case QN_OP_UNLESS:
    case QN_OP_JUMP:
      snprintf(one, sizeof one, "%s>%u", op->kind == QN_OP_AND ? "and" : op->kind == QN_OP_OR ? "or" : op->kind == QN_OP_UNLESS ? "unless" : "jump",
               (unsigned)(op->a - from));
      break;
    default: snprintf(one, sizeof one, "%s", words[op->kind]); break;
    }
    strcat(out, i > from ? " " : "");
    strcat(out, one);
  }
}

static void expression(const char *text, const char *want) {
  char source[500], got[1000];
  snprintf(source, sizeof source, "x = %s;", text);
  bench b;
  start(&b, source);
  assert_int_equal(b.status, QUOIN_OK);
  assert_int_equal(b.diags.count, 0);
  assert_int_equal(b.syntax.assignment_count, 1);
  code(&b, b.syntax.assignments[0].value.from, b.syntax.assignments[0].value.to, got);
  assert_string_equal(got, want);
  end(&b);
}

static void precedence(void **state) {
  (void)state;
  expression("1", "1");
  expression("-1", "-1"); /* a sign before a literal is part of it */
  expression("- -1", "1");
  expression("1 + 2 * 3", "1 2 3 * +");
  expression("(1 + 2) * 3", "1 2 + 3 *");
  expression("1 - 2 - 3", "1 2 - 3 -");
  expression("1 / 2 * 3 % 4", "1 2 / 3 * 4 %");
  expression("2 ^ 3 ^ 4", "2 3 4 ^ ^");
  expression("-2 ^ 2", "2 2 ^ neg");
  expression("2 ^ -1", "2 -1 ^");
  expression("2 ^ -a ^ 2", "2 a 2 ^ neg ^");
  expression("-a * b", "a neg b *");
  expression("!a == b", "a ! b ==");
  expression("a < b == c >= d", "a b < c d >= ==");
  expression("a + 1 > b - 1", "a 1 + b 1 - >");
  expression("-a[0]", "a 0 [] neg");
  expression("a.x ^ 2", "a .x 2 ^");
  expression("v[i + 1].y[2]", "v i 1 + [] .y 2 []");
  expression("+a", "a pos");
  expression("1234567890.1234567891", "1234567890.1234567891"); /* beyond a small operand */
  expression("-1234567890.1234567891", "-1234567890.1234567891");
}

static void branches(void **state) {
  (void)state;
  expression("a && b", "a and>4 b bool");
  expression("a || b && c", "a or>7 b and>6 c bool bool");
  expression("a && b || c", "a and>4 b bool or>7 c bool");
  expression("a ? b : c", "a unless>4 b jump>5 c");
  expression("a ? b : c ? d : e", "a unless>4 b jump>9 c unless>8 d jump>9 e");
  expression("a ? b ? c : d : e", "a unless>8 b unless>6 c jump>7 d jump>9 e");
  expression("a ? 1 : 2 + 3", "a unless>4 1 jump>7 2 3 +");
  expression("-(a ? 1 : 2)", "a unless>4 1 jump>5 2 neg"); /* the sign is not the last literal's */
  expression("a == 1 ? [1, 2] : [3]", "a 1 == unless>8 1 2 vec2 jump>10 3 vec1");
}

static void vectors_and_calls(void **state) {
  (void)state;
  expression("[]", "vec0");
  expression("[1, [2, 3], -4]", "1 2 3 vec2 -4 vec3");
  expression("[1, 2,]", "1 2 vec2");
  expression("f()", "f/0");
  expression("f(1, g(2), [3])", "1 2 g/1 3 vec1 f/3");
  expression("-f(2)", "2 f/1 neg");
  expression("\"a\"", "\"a\"");
  expression("[true, false, undef]", "true false undef vec3");
  expression("((((1))))", "1");
}

/* Statements as text: word(arguments){children}, assignments as name:. */
static void outline(bench *b, char *out) {
  uint32_t stack[64], depth = 0, n = 0;
  out[0] = '\0';
  for (;;) {
    const qn_statement *st = &b->syntax.statements[n];
    static const char *const signs[] = {"%", "#", "!", "*"};
    for (int i = 0; i < 4; i++) {
      if (st->flags & (1u << i)) {
        strcat(out, signs[i]);
      }
    }
    strcat(out, b->syntax.names.items[st->word].text);
    for (uint32_t i = 0; i < st->arguments; i++) {
      const qn_argument *a = &b->syntax.arguments[st->argument0 + i];
      strcat(out, i ? "," : "(");
      strcat(out, b->syntax.names.items[a->name].text);
      strcat(out, i + 1 == st->arguments ? ")" : "");
    }
    strcat(out, st->flags & QN_STATEMENT_BAD ? "?" : "");
    strcat(out, "{");
    for (uint32_t i = st->assignment; i != QN_NO_STATEMENT; i = b->syntax.assignments[i].next) {
      strcat(out, b->syntax.names.items[b->syntax.assignments[i].value.name].text);
      strcat(out, "=");
    }
    if (st->first != QN_NO_STATEMENT) {
      stack[depth++] = n;
      n = st->first;
      continue;
    }
    strcat(out, "}");
    while (b->syntax.statements[n].next == QN_NO_STATEMENT) {
      if (depth == 0) {
        return;
      }
      n = stack[--depth];
      strcat(out, "}");
    }
    n = b->syntax.statements[n].next;
  }
}

static void tree(const char *text, const char *want, const char *codes) {
  bench b;
  char got[2000];
  start(&b, text);
  outline(&b, got);
  assert_string_equal(got, want);
  char said[200] = "";
  qn_reporter_end(&b.reporter);
  for (size_t i = 0; i < b.diags.count; i++) {
    strcat(said, i ? " " : "");
    strcat(said, b.diags.items[i].code);
  }
  assert_string_equal(said, codes);
  end(&b);
}

static void statements(void **state) {
  (void)state;
  tree("", "{}", "");
  tree(";;{}", "{}", "");
  tree("cube(1);", "{cube(){}}", "");
  tree("cube(1, center = true); a = 1; sphere();", "{a=cube(,center){}sphere{}}", "");
  tree("a() b() c();", "{a{b{c{}}}}", "");
  tree("a() { b(); x = 1; c() d(); } e();", "{a{x=b{}c{d{}}}e{}}", "");
  tree("{ a(); { x = 1; b(); } } c();", "{x=a{}b{}c{}}", "");      /* bare braces open no scope */
  tree("a() { { b(); y = 2; } }", "{a{y=b{}}}", "");
  tree("%#a() !*b();", "{%#a{!*b{}}}", "");
  tree("a(x == 1, y = 2, z /* c */ = 3);", "{a(,y,z){}}", "");
  tree("a(1,);", "{a(){}}", "");
  tree("if (a) b(); else c();", "{if{b{}}else{c{}}}", "");
  tree("if (a) if (b) c(); else d(); else e();", "{if{if{c{}}}else{d{}}else{e{}}}", "");
  tree("a() if (b) { c(); } else if (d) e(); else f();", "{a{if{c{}}}else{if{e{}}}else{f{}}}", "");
  tree("for (i = [0 : 1 : 3]) { b(); }", "{for{b{}}}", "");
  tree("module m(a, b = 2) { c(); } d();", "{module{c{}}d{}}", "");
  tree("function f(a) = a + 1; d();", "{function{}d{}}", "");
  tree("use <a b/c.scad> include <d>; e();", "{use{}include{}e{}}", "");
}

static void recovery(void **state) {
  (void)state;
  tree("a(1 +); b();", "{a()?{}b{}}", "Q0205");
  tree("a(1 2) { c(); } b();", "{a()?{}b{}}", "Q0201");
  tree("a([1, 2) { c(); } b();", "{a()?{c{}}b{}}", "Q0201");
  tree("x = ; b();", "{x=b{}}", "Q0205");
  tree("x = 1 b();", "{x=b{}}", "Q0202");
  tree("a() }; b();", "{a{}b{}}", "Q0202 Q0204");
  tree("a() { b();", "{a{b{}}}", "Q0203");
  tree("a(1; b();", "{a()?{}b{}}", "Q0203");
  tree("a; b();", "{a?{}b{}}", "Q0201");
  tree("a { c(); } b();", "{a?{c{}}b{}}", "Q0201");
  tree("a() x = 1; b();", "{a{}b{}}", "Q0206");
  tree("x = [for (i = 0; i < 3; i = i + 1) i]; b();", "{x=b{}}", "Q0210");
  tree("x = [1 : 2 : 3]; b([for (a = v) a], 2);", "{x=b(,)?{}}", "Q0210 Q0210");
  tree("a(); else b();", "{a{}else{b{}}}", "Q0201");
  tree("{ if (a) b(); } else c();", "{if{b{}}else{c{}}}", "Q0201");
  tree("if (a) b(); ; else c();", "{if{b{}}else{c{}}}", "Q0201");
  tree("a() else b();", "{a{else{b{}}}}", "Q0201");
  tree("if a() b(); else c();", "{if?{}else{c{}}}", "Q0201"); /* one cause: the 'if' may be what was passed over */
  tree("true = 1; if = 2; else = 3; a();", "{a{}}", "Q0201 Q0201 Q0201");
  tree("assign = 1; $fn = 2;", "{assign=$fn=}", "");
  tree("a(@) b();", "{a()?{b{}}}", "Q0102");
}

/* Depth costs memory only, and has a limit with a name. */
static void depth(void **state) {
  (void)state;
  enum { N = 199000, TOO_MANY = 201000 };
  char *text = test_malloc(2 * TOO_MANY + 20);
  static const struct { char open, close; const char *before, *middle, *after; } kinds[] = {
    {'(', ')', "x = ", "1", ";"}, {'[', ']', "x = ", "1", ";"}, {'-', '\0', "x = ", "1", ";"}, {'{', '}', "a()", "", ""}};
  for (size_t k = 0; k < 4; k++) {
    for (int n = N; n <= TOO_MANY; n += TOO_MANY - N) {
      char *at = text + sprintf(text, "%s", kinds[k].before);
      memset(at, kinds[k].open, (size_t)n);
      at += n;
      at += sprintf(at, "%s", kinds[k].middle);
      if (kinds[k].close) {
        memset(at, kinds[k].close, (size_t)n);
        at += n;
      }
      strcpy(at, kinds[k].after);
      bench b;
      start(&b, text);
      if (n == N) {
        assert_int_equal(b.status, QUOIN_OK);
        assert_int_equal(b.diags.count, 0);
      } else {
        assert_int_equal(b.status, QUOIN_E_LIMIT);
        assert_string_equal(b.diags.items[b.diags.count - 1].code, "Q0901");
      }
      end(&b);
    }
  }
  test_free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(precedence), cmocka_unit_test(branches), cmocka_unit_test(vectors_and_calls),
    cmocka_unit_test(statements), cmocka_unit_test(recovery), cmocka_unit_test(depth),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
