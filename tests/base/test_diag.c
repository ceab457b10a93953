/* Diagnostics: the text with its caret, the order of places, names of files without end, refused memory. */
#include "base/diag.h"
#include "base/limits.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static quoin_diag diag_of(const char *source, uint32_t column, uint32_t length) {
  return (quoin_diag){.severity = QUOIN_ERROR, .code = "Q0000", .file = "f", .line = 2, .column = column, .length = length,
                      .problem = "p", .reason = "", .way_out = "", .source = source};
}
static void expect(const quoin_diag *d, const char *want) {
  char text[300];
  assert_int_equal(quoin_diag_format(d, text, sizeof text), strlen(want));
  assert_string_equal(text, want);
}

static void parts_of_a_message(void **state) {
  (void)state;
  quoin_diag d = diag_of("", 1, 1);
  expect(&d, "f:2:1: error: p [Q0000]\n");
  d.reason = "why";
  expect(&d, "f:2:1: error: p (why) [Q0000]\n");
  d.way_out = "do that";
  d.severity = QUOIN_WARNING;
  expect(&d, "f:2:1: warning: p (why); do that [Q0000]\n");
  d.severity = QUOIN_NOTE;
  d.line = 0;
  expect(&d, "f: note: p (why); do that [Q0000]\n");
  d.file = "";
  expect(&d, "note: p (why); do that [Q0000]\n");
}

static void carets(void **state) {
  (void)state;
  quoin_diag d = diag_of("cube(x);", 6, 1);
  expect(&d, "f:2:6: error: p [Q0000]\n  cube(x);\n       ^\n");
  d = diag_of("\tcube(xyz);", 7, 3); /* a tab stays one, so that the caret stands under its word at any width */
  expect(&d, "f:2:7: error: p [Q0000]\n  \tcube(xyz);\n  \t     ^^^\n");
  d = diag_of("a = \"\xC3\xA9\xE2\x82\xAC\" + b;", 15, 1); /* two and three bytes: one column each */
  expect(&d, "f:2:15: error: p [Q0000]\n  a = \"\xC3\xA9\xE2\x82\xAC\" + b;\n             ^\n");
  d = diag_of("ab", 3, 1); /* just behind the end */
  expect(&d, "f:2:3: error: p [Q0000]\n  ab\n    ^\n");
  d = diag_of("ab", 2, 90); /* no longer than the line */
  expect(&d, "f:2:2: error: p [Q0000]\n  ab\n   ^\n");
  d = diag_of("a\x1B[31m\x7F" "b", 1, 1); /* nothing that moves a terminal */
  expect(&d, "f:2:1: error: p [Q0000]\n  a?[31m?b\n  ^\n");
}

static void a_small_buffer(void **state) {
  (void)state;
  const quoin_diag d = diag_of("cube(x);", 6, 1);
  char whole[200], part[200];
  const size_t length = quoin_diag_format(&d, whole, sizeof whole);
  assert_int_equal(quoin_diag_format(&d, NULL, 0), length);
  for (size_t size = 1; size <= length + 1; size++) {
    memset(part, 'z', sizeof part);
    assert_int_equal(quoin_diag_format(&d, part, size), length);
    assert_memory_equal(part, whole, size - 1);
    assert_int_equal(part[size - 1], '\0');
    assert_int_equal(part[size], 'z');
  }
}

static void add(qn_diags *diags, unsigned file, uint32_t line, uint32_t column, const char *problem) {
  const qn_report r = {.severity = QUOIN_ERROR, .code = "Q0000", .loc = {.line = line, .column = column & 0xFFFFFu, .file = file & 0xFFFu}};
  qn_diags_add(diags, &r, "%s", problem);
}

static void order_of_places(void **state) {
  (void)state;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  qn_diags diags;
  qn_diags_init(&diags, &mem);
  const unsigned one = qn_diags_file(&diags, "one");
  add(&diags, one, 5, 1, "d");
  add(&diags, one, 0, 0, "f"); /* without a place: last */
  add(&diags, one, 2, 9, "c");
  add(&diags, one, 2, 3, "a");
  add(&diags, one, 2, 3, "b"); /* equals stay in their order */
  add(&diags, one, 5, 2, "e");
  qn_diags_sort(&diags);
  for (size_t i = 0; i < diags.count; i++) {
    assert_int_equal(diags.items[i].problem[0], 'a' + (int)i);
  }
  assert_int_equal(diags.errors, 6);
  qn_diags_free(&diags);
  assert_int_equal(mem.used, 0);
}

/* A program may read a model in any number of pieces. */
static void more_texts_than_names(void **state) {
  (void)state;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  qn_diags diags;
  qn_diags_init(&diags, &mem);
  char name[40];
  for (int i = 0; i < 6000; i++) {
    snprintf(name, sizeof name, "text %d", i);
    const unsigned file = qn_diags_file(&diags, name);
    assert_in_range(file, 1, QN_MAX_FILES);
    assert_string_equal(diags.files[file - 1], i < QN_MAX_FILES - 1 ? name : "(another text)");
  }
  assert_string_equal(diags.files[qn_diags_file(&diags, "text 17") - 1], "text 17");
  assert_int_equal(diags.file_count, QN_MAX_FILES);
  qn_diags_free(&diags);
  assert_int_equal(mem.used, 0);
}

static void want_of_memory_is_remembered(void **state) {
  (void)state;
  for (size_t limit = 1; limit < 20000; limit += 97) {
    qn_mem mem;
    qn_mem_init(&mem, &(quoin_allocator){.limit = limit});
    qn_diags diags;
    qn_diags_init(&diags, &mem);
    const unsigned file = qn_diags_file(&diags, "one");
    for (int i = 0; i < 60; i++) {
      add(&diags, file, 1, 1, "a problem of some length, so that the arena needs more than one chunk: .......................................");
    }
    assert_int_equal(diags.errors, 60);
    assert_true(diags.lost || diags.count == 60);
    assert_true(mem.used <= limit);
    qn_diags_free(&diags);
    assert_int_equal(mem.used, 0);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(parts_of_a_message), cmocka_unit_test(carets), cmocka_unit_test(a_small_buffer), cmocka_unit_test(order_of_places),
    cmocka_unit_test(more_texts_than_names), cmocka_unit_test(want_of_memory_is_remembered),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
