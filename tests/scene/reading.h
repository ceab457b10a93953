/* Scenes from text, for the tests of this station. */
#ifndef QN_TESTS_SCENE_READING_H
#define QN_TESTS_SCENE_READING_H

#include "quoin/quoin.h"
#include "scene/scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static inline quoin_scene *scene_of(const char *text) {
  quoin_model *m;
  quoin_scene *s;
  assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
  quoin_status status = quoin_model_read_text(m, QUOIN_ROOT, "t", text, strlen(text), NULL);
  for (size_t i = 0; status != QUOIN_OK && i < quoin_model_diag_count(m); i++) {
    quoin_diag d;
    char line[1000];
    quoin_model_diag(m, i, &d);
    quoin_diag_format(&d, line, sizeof line);
    print_message("%s", line);
  }
  assert_int_equal(status, QUOIN_OK);
  assert_int_equal(quoin_scene_compile(m, NULL, &s), QUOIN_OK);
  quoin_model_free(m);
  return s;
}

#endif
