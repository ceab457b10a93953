/* A scene made of text, and questions to it as text: what the tests of this station share. */
#ifndef QN_TESTS_ASK_H
#define QN_TESTS_ASK_H

#include "quoin/quoin.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct ask {
  quoin_model *model;
  quoin_scene *scene;
  quoin_work *work;
} ask;

static inline void ask_open(ask *a, const char *text) {
  assert_int_equal(quoin_model_new(NULL, &a->model), QUOIN_OK);
  quoin_status status = quoin_model_read_text(a->model, QUOIN_ROOT, "test", text, strlen(text), NULL);
  for (size_t i = 0; status != QUOIN_OK && i < quoin_model_diag_count(a->model); i++) {
    quoin_diag diag;
    char line[1000];
    if (quoin_model_diag(a->model, i, &diag) == QUOIN_OK) {
      quoin_diag_format(&diag, line, sizeof line);
      print_error("%s\n", line);
    }
  }
  assert_int_equal(status, QUOIN_OK);
  assert_int_equal(quoin_scene_compile(a->model, NULL, &a->scene), QUOIN_OK);
  assert_int_equal(quoin_work_new(a->scene, &a->work), QUOIN_OK);
}

static inline void ask_close(ask *a) {
  quoin_work_free(a->work);
  quoin_scene_free(a->scene);
  quoin_model_free(a->model);
}

/* "x y z" -> 'i', 'b' or 'o' */
static inline char ask_side(const ask *a, const char *text) {
  char copy[256];
  assert_true(strlen(text) < sizeof copy);
  strcpy(copy, text);
  const char *point[3];
  char *at = copy;
  for (int i = 0; i < 3; i++) {
    while (*at == ' ') {
      at++;
    }
    point[i] = at;
    at += strcspn(at, " ");
    if (*at) {
      *at++ = '\0';
    }
  }
  quoin_side side;
  assert_int_equal(quoin_point_side_text(a->scene, a->work, point, &side), QUOIN_OK);
  return side == QUOIN_INSIDE ? 'i' : side == QUOIN_BOUNDARY ? 'b' : 'o';
}

/* One model, and what it says of points: expect_sides(text, "0 0 0", 'i', ..., NULL). */
static inline void expect_sides(const char *text, ...) {
  ask a;
  ask_open(&a, text);
  va_list points;
  va_start(points, text);
  for (const char *p; (p = va_arg(points, const char *)) != NULL;) {
    char want = (char)va_arg(points, int), got = ask_side(&a, p);
    if (want != got) {
      print_error("%s\nat %s: %c, wanted %c\n", text, p, got, want);
    }
    assert_int_equal(got, want);
  }
  va_end(points);
  ask_close(&a);
}

#endif
