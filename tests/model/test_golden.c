/* The messages: every file of golden/ NAME.scad must give the diagnostics of NAME.txt, and every code must occur in one.
   With QUOIN_UPDATE_GOLDEN=1 in the environment (tests/model/update) the .txt files are written anew: read them before
   they are committed. */
#include "quoin/quoin.h"
#include "text/codes.h"

#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct text { char *at; size_t length; } text;

static text read_file(const char *path) {
  FILE *f = fopen(path, "rb");
  if (!f) {
    return (text){NULL, 0};
  }
  size_t capacity = 1 << 20, n = 0;
  char *at = malloc(capacity);
  assert_non_null(at);
  for (size_t got; (got = fread(at + n, 1, capacity - n, f)) > 0;) {
    n += got;
    assert_true(n < capacity);
  }
  fclose(f);
  return (text){at, n};
}

static int by_name(const void *a, const void *b) {
  const char *const *x = a, *const *y = b;
  return strcmp(*x, *y);
}

static void goldens(void **state) {
  (void)state;
  int update = getenv("QUOIN_UPDATE_GOLDEN") != NULL, failed = 0;
  char *names[400];
  size_t count = 0;
  DIR *dir = opendir(QN_SOURCE_DIR "/tests/model/golden");
  assert_non_null(dir);
  for (struct dirent *e; (e = readdir(dir)) != NULL;) {
    size_t n = strlen(e->d_name);
    if (n > 5 && strcmp(e->d_name + n - 5, ".scad") == 0) {
      assert_true(count < 400);
      names[count] = malloc(n + 1);
      memcpy(names[count++], e->d_name, n + 1);
    }
  }
  closedir(dir);
  assert_true(count > 50);
  qsort(names, count, sizeof *names, by_name);
  int seen[QN_CODE_COUNT] = {0};
  for (size_t i = 0; i < count; i++) {
    char path[4096];
    snprintf(path, sizeof path, "%s/tests/model/golden/%s", QN_SOURCE_DIR, names[i]);
    text source = read_file(path);
    assert_non_null(source.at);
    quoin_model *m;
    assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
    quoin_status status = quoin_model_read_text(m, QUOIN_ROOT, names[i], source.at, source.length, NULL);
    size_t size = 1 << 20, at = 0;
    char *got = malloc(size);
    int errors = 0;
    for (size_t d = 0; d < quoin_model_diag_count(m); d++) {
      quoin_diag diag;
      assert_int_equal(quoin_model_diag(m, d, &diag), QUOIN_OK);
      at += quoin_diag_format(&diag, got + at, size - at);
      errors += diag.severity == QUOIN_ERROR;
      for (int c = 0; c < QN_CODE_COUNT; c++) {
        if (strcmp(qn_codes[c].text, diag.code) == 0) {
          seen[c] = 1;
          assert_int_equal(qn_codes[c].severity, diag.severity);
        }
      }
    }
    at += (size_t)snprintf(got + at, size - at, "status: %s\n", quoin_status_text(status));
    assert_int_equal(errors > 0, status != QUOIN_OK);
    memcpy(strrchr(path, '.'), ".txt", 5);
    if (update) {
      FILE *f = fopen(path, "wb");
      assert_non_null(f);
      assert_int_equal(fwrite(got, 1, at, f), at);
      fclose(f);
    } else {
      text want = read_file(path);
      if (!want.at || want.length != at || memcmp(want.at, got, at) != 0) {
        print_message("%s: expected\n%.*s\ngot\n%.*s\n", names[i], (int)want.length, want.at ? want.at : "", (int)at, got);
        failed = 1;
      }
      free(want.at);
    }
    free(got);
    free(source.at);
    free(names[i]);
    quoin_model_free(m);
  }
  assert_false(failed);
  for (int c = 0; c < QN_CODE_COUNT; c++) {
    /* A file that cannot be read, 2 GB of text and 268 million primitives are no golden files. */
    if (!seen[c] && c != QN_Q0801 && c != QN_Q0905 && c != QN_Q0906) {
      fail_msg("no golden file has %s, %s", qn_codes[c].text, qn_codes[c].meaning);
    }
  }
}

/* docs/language.md has a row for every code, and none for what is not. (Q1001 and on are the command's.) */
static void documented(void **state) {
  (void)state;
  text doc = read_file(QN_SOURCE_DIR "/docs/language.md");
  assert_non_null(doc.at);
  doc.at[doc.length] = '\0';
  for (int c = 0; c < QN_CODE_COUNT; c++) {
    char row[64];
    snprintf(row, sizeof row, "| %s |", qn_codes[c].text);
    if (!strstr(doc.at, row)) {
      fail_msg("docs/language.md has no row for %s", qn_codes[c].text);
    }
  }
  size_t rows = 0;
  for (const char *at = doc.at; (at = strstr(at, "\n| Q0")) != NULL; at++) {
    rows++;
  }
  assert_int_equal(rows, QN_CODE_COUNT);
  free(doc.at);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(goldens), cmocka_unit_test(documented)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
