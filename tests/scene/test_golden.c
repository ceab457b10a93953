/* Compiled scenes as text: every file golden/NAME.scad must print as NAME.txt. With QUOIN_UPDATE_GOLDEN=1 in the environment
   (tests/scene/update) the .txt files are written anew: read them before they are committed. */
#include "scene/reading.h"

#include <dirent.h>
#include <stdlib.h>

typedef struct text { char at[1 << 16]; size_t length; } text;

static int append(void *user, const char *t, size_t length) {
  text *out = user;
  if (out->length + length >= sizeof out->at) {
    return 1;
  }
  memcpy(out->at + out->length, t, length);
  out->length += length;
  out->at[out->length] = '\0';
  return 0;
}

static void read_into(const char *path, text *out) {
  FILE *f = fopen(path, "rb");
  out->length = f ? fread(out->at, 1, sizeof out->at - 1, f) : 0;
  out->at[out->length] = '\0';
  if (f) {
    fclose(f);
  }
}

static void goldens(void **unused) {
  (void)unused;
  static text source, wanted, got, again;
  int update = getenv("QUOIN_UPDATE_GOLDEN") != NULL;
  size_t count = 0, failed = 0;
  DIR *dir = opendir(QN_SOURCE_DIR "/tests/scene/golden");
  assert_non_null(dir);
  for (struct dirent *e; (e = readdir(dir)) != NULL;) {
    size_t n = strlen(e->d_name);
    if (n < 6 || strcmp(e->d_name + n - 5, ".scad")) {
      continue;
    }
    count++;
    char path[4096];
    snprintf(path, sizeof path, "%s/tests/scene/golden/%s", QN_SOURCE_DIR, e->d_name);
    read_into(path, &source);
    assert_true(source.length > 0);
    for (unsigned threads = 1; threads <= 3; threads += 2) {
      quoin_model *m;
      quoin_scene *s;
      assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
      assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, e->d_name, source.at, source.length, NULL), QUOIN_OK);
      quoin_compile_options o = quoin_compile_options_default();
      o.threads = threads;
      assert_int_equal(quoin_scene_compile(m, &o, &s), QUOIN_OK);
      text *out = threads == 1 ? &got : &again;
      out->length = 0;
      assert_int_equal(quoin_scene_write_text(s, append, out), QUOIN_OK);
      quoin_scene_free(s);
      quoin_model_free(m);
    }
    assert_string_equal(got.at, again.at);
    memcpy(strrchr(path, '.'), ".txt", 5);
    if (update) {
      FILE *f = fopen(path, "wb");
      assert_non_null(f);
      fwrite(got.at, 1, got.length, f);
      fclose(f);
      continue;
    }
    read_into(path, &wanted);
    if (strcmp(wanted.at, got.at)) {
      print_error("%s: got\n%s\n", e->d_name, got.at);
      failed++;
    }
  }
  closedir(dir);
  assert_int_equal(failed, 0);
  assert_true(count >= 5);
}

/* A writer that stops is an I/O error. */
static int refuse(void *user, const char *t, size_t length) {
  (void)user, (void)t, (void)length;
  return 1;
}

static void stopped(void **unused) {
  (void)unused;
  quoin_scene *s = scene_of("cube(1);");
  assert_int_equal(quoin_scene_write_text(s, refuse, NULL), QUOIN_E_IO);
  assert_int_equal(quoin_scene_write_text(s, NULL, NULL), QUOIN_E_ARGUMENT);
  quoin_scene_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(goldens), cmocka_unit_test(stopped)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
