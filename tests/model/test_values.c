/* Expressions: what they come to, shown by echo, whose text of a number is exact. */
#include "quoin/quoin.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static void value(const char *expression, const char *want) {
  char text[1000];
  snprintf(text, sizeof text, "echo(%s);", expression);
  quoin_model *m;
  assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
  quoin_status status = quoin_model_read_text(m, QUOIN_ROOT, "t", text, strlen(text), NULL);
  quoin_diag d = {0};
  if (status != QUOIN_OK || quoin_model_diag_count(m) != 1) {
    quoin_model_diag(m, 0, &d);
    fail_msg("%s: %s", expression, d.problem ? d.problem : "nothing said");
  }
  assert_int_equal(quoin_model_diag(m, 0, &d), QUOIN_OK);
  if (strcmp(d.problem + 6, want) != 0) {
    fail_msg("%s: wanted %s, got %s", expression, want, d.problem + 6);
  }
  quoin_model_free(m);
}

static void error(const char *expression, const char *code) {
  char text[1000];
  snprintf(text, sizeof text, "x = %s; cube(x);", expression);
  quoin_model *m;
  assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
  quoin_status status = quoin_model_read_text(m, QUOIN_ROOT, "t", text, strlen(text), NULL);
  quoin_diag d;
  assert_true(status == QUOIN_E_MODEL || status == QUOIN_E_LIMIT);
  assert_int_equal(quoin_model_diag_count(m), 1); /* no cascade */
  assert_int_equal(quoin_model_diag(m, 0, &d), QUOIN_OK);
  if (strcmp(d.code, code) != 0) {
    fail_msg("%s: wanted %s, got %s", expression, code, d.code);
  }
  quoin_model_free(m);
}

static void arithmetic(void **state) {
  (void)state;
  value("8.1-9+0.9", "0");
  value("0.1+0.2 == 0.3", "true");
  value("1/3", "(1/3)");
  value("1/3 + 1/6", "0.5");
  value("1/3*3", "1");
  value("7 % 3", "1");
  value("-7 % 3", "-1");
  value("7.5 % -2", "1.5");
  value("2^10", "1024");
  value("2^-2", "0.25");
  value("-2^2", "-4");
  value("4^0.5", "2");
  value("0^0", "1");
  value("(2/3)^3", "(8/27)");
  value("1e3 - 999.999", "0.001");
  value("1 - 1", "0");
  value("-0", "0");
}

/* What is not finite follows IEEE 754, as in OpenSCAD; a finite result is exact again. */
static void not_finite(void **state) {
  (void)state;
  value("1/0", "inf");
  value("inf", "inf");
  value("-inf", "-inf");
  value("nan", "nan");
  value("-1/0", "-inf");
  value("0/0", "nan");
  value("1/0 - 1/0", "nan");
  value("1/(1/0)", "0");
  value("(1/0) * 0", "nan");
  value("(1/0) * -3", "-inf");
  value("5 % 0", "nan");
  value("5 % (1/0)", "5");
  value("0 ^ -1", "inf");
  value("(-8) ^ (1/3)", "nan");
  value("2 ^ (1/0)", "inf");
  value("(1/2) ^ (1/0)", "0");
  value("1/0 > 1e300", "true");
  value("0/0 == 0/0", "false");
  value("0/0 < 1", "false");
  value("sqrt(-1)", "nan");
  value("ln(0)", "-inf");
  value("ln(-1)", "nan");
  value("tan(90)", "inf");
  value("tan(270)", "-inf");
  value("asin(2)", "nan");
  value("atan(1/0)", "90");
  value("atan2(1/0, -1/0)", "135");
  value("atan2(1, -1/0)", "180");
  value("exp(-1/0)", "0");
  value("max(1, 1/0)", "inf");
  value("abs(-1/0)", "inf");
  value("sin(1/0)", "nan");
}

static void logic(void **state) {
  (void)state;
  value("1 < 2 && 2 < 3", "true");
  value("1 > 2 || 0", "false");
  value("!0", "true");
  value("![]", "true");
  value("!\"\"", "true");
  value("!undef", "true");
  value("![0]", "false");
  value("3 && \"a\"", "true");
  value("false && 1/0 > 0", "false");
  value("true ? 1 : 2", "1");
  value("false ? 1 : true ? 2 : 3", "2");
  value("1 == true", "false");
  value("\"a\" < \"b\"", "true");
  value("\"ab\" > \"a\"", "true");
  value("\"a\" == \"a\"", "true");
  value("[1, [2, \"x\"]] == [1, [2, \"x\"]]", "true");
  value("[1, 2] != [1, 3]", "true");
  value("[1] == [1, 2]", "false");
  value("undef == undef", "true");
  value("false < true", "true");
  value("1 <= 1 && 1 >= 1", "true");
}

static void vectors(void **state) {
  (void)state;
  value("[1, 2, 3] + [0.1, 0.2, 0.3]", "[1.1, 2.2, 3.3]");
  value("[1, 2] - [3, 5]", "[-2, -3]");
  value("2 * [1, 2]", "[2, 4]");
  value("[1, 2] * 0.5", "[0.5, 1]");
  value("[3, 6] / 3", "[1, 2]");
  value("6 / [3, 2]", "[2, 3]");
  value("-[1, [2, -3]]", "[-1, [-2, 3]]");
  value("[[1, 2], [3, 4]] + [[1, 1], [1, 1]]", "[[2, 3], [4, 5]]");
  value("[1, 2, 3] * [4, 5, 6]", "32");
  value("[[1, 2], [3, 4]] * [5, 6]", "[17, 39]");
  value("[5, 6] * [[1, 2], [3, 4]]", "[23, 34]");
  value("[[1, 2], [3, 4]] * [[5, 6], [7, 8]]", "[[19, 22], [43, 50]]");
  value("[[1, 2, 3]] * [[1], [2], [3]]", "[[14]]");
  value("[1, 1/0] * [2, 3]", "inf");
  value("[10, 20, 30][1]", "20");
  value("[10, 20, 30][1.9]", "20");
  value("[10, 20, 30].z", "30");
  value("[[1, 2], [3, 4]][1].x", "3");
  value("\"caf\xC3\xA9!\"[3]", "\"\xC3\xA9\"");
}

static void functions(void **state) {
  (void)state;
  value("sqrt(4)", "2");
  value("sqrt(4/9)", "(2/3)");
  value("sqrt(0.01)", "0.1");
  value("sqrt(2) * sqrt(2) == 2", "true");
  value("sqrt(2) * sqrt(3) == sqrt(6)", "true");
  value("sin(30)", "0.5");
  value("cos(60)", "0.5");
  value("sin(-90)", "-1");
  value("cos(720)", "1");
  value("tan(45)", "1");
  value("sin(45) == sqrt(2) / 2", "true");
  value("sin(20)^2 + cos(20)^2 == 1", "true");
  value("asin(0.5)", "30");
  value("acos(-1)", "180");
  value("atan(1)", "45");
  value("atan2(1, -1)", "135");
  value("atan2(0, 0)", "0");
  value("abs(-2.5)", "2.5");
  value("min(3, 1, 2)", "1");
  value("max([3, 1, 2])", "3");
  value("floor(-0.5)", "-1");
  value("ceil(-0.5)", "0");
  value("round(2.5)", "3");
  value("round(-2.5)", "-3");
  value("sign(-0.1)", "-1");
  value("sign(0)", "0");
  value("pow(2, 0.5) == sqrt(2)", "true");
  value("exp(0)", "1");
  value("ln(1)", "0");
  value("log(1000)", "3");
  value("log(0.01)", "-2");
  value("ln(exp(2)) == 2", "true");
  value("len([1, 2, 3])", "3");
  value("len(\"\xE2\x82\xAC\")", "1");
  value("norm([3, 4])", "5");
  value("norm([1, 2, 2])", "3");
  value("norm([])", "0");
  value("cross([1, 0, 0], [0, 1, 0])", "[0, 0, 1]");
  value("cross([2, 3], [5, 7])", "-1");
  value("PI > 3.14159265358979323846 && PI < 3.14159265358979323847", "true");
  value("rounded(1/4) == 1/4", "true");
  value("[$fn, $fa, $fs, $t, $preview]", "[0, 12, 2, 0, false]");
}

static void errors(void **state) {
  (void)state;
  error("1 + \"a\"", "Q0305");
  error("[1] + 1", "Q0305");
  error("true * 2", "Q0305");
  error("[1, 2] % 2", "Q0305");
  error("undef + 1", "Q0305");
  error("[[1, 2], [3]] * [1, 2]", "Q0305");
  error("[1] < [2]", "Q0305");
  error("[1, 2][2]", "Q0306");
  error("[1, 2][-1]", "Q0306");
  error("sqrt(1, 2)", "Q0307");
  error("sqrt(\"4\")", "Q0307");
  error("cross([1], [2])", "Q0307");
  error("nope", "Q0301");
  error("nope()", "Q0303");
  error("x", "Q0302");
  error("7 ^ 100000", "Q0904");
  error("exp(10 ^ 10)", "Q0904"); /* once without end: beyond the exponents of MPFR */
  error("1.1 ^ (10 ^ 10 + 0.5)", "Q0904");
  error("true && nope", "Q0301");
  error("nope ? 1 : 2", "Q0301");
  error("-nope", "Q0301");
  error("nope[0].x", "Q0301");
  error("sqrt(nope)", "Q0301");
  error("[1, nope]", "Q0301");
}

static void scopes(void **state) {
  (void)state;
  static const struct { const char *text, *want; } cases[] = {
    {"a = 1; a = 2; echo(a);", "2"},                                  /* the last one counts, everywhere */
    {"echo(a); a = 5;", "5"},
    {"a = 1; group() { echo(a); }", "1"},
    {"a = 1; group() { a = 2; echo(a); }", "2"},
    {"a = 1; group() { a = 2; } echo(a);", "1"},
    {"a = 1; group() { b = a; a = 2; echo(b); }", "1"},               /* the inner a is not known yet */
    {"a = 1; { a = 3; } echo(a);", "3"},                              /* bare braces open no scope */
    {"a = b; b = 1; a = 4; echo(a);", "4"},                           /* the place of the first, the value of the last */
    {"$fn = 5; group() group() echo($fn);", "5"},
    {"group($fn = 7) { echo($fn); }", "7"},                           /* seen by children */
    {"group($fn = 7) cube(1); echo($fn);", "0"},
    {"group($fn = 7) { $fn = 8; group() echo($fn); }", "8"},
    {"translate([1, 2, 3], $mine = 4) { echo($mine); }", "4"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    quoin_model *m;
    assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
    assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "t", cases[i].text, strlen(cases[i].text), NULL), QUOIN_OK);
    const char *got = NULL;
    quoin_diag d;
    for (size_t k = 0; k < quoin_model_diag_count(m); k++) {
      assert_int_equal(quoin_model_diag(m, k, &d), QUOIN_OK);
      got = strcmp(d.code, "Q0310") == 0 ? d.problem + 6 : got;
    }
    if (!got || strcmp(got, cases[i].want) != 0) {
      fail_msg("%s: wanted %s, got %s", cases[i].text, cases[i].want, got ? got : "nothing");
    }
    quoin_model_free(m);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(arithmetic), cmocka_unit_test(not_finite), cmocka_unit_test(logic),  cmocka_unit_test(vectors),
    cmocka_unit_test(functions),  cmocka_unit_test(errors),     cmocka_unit_test(scopes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
