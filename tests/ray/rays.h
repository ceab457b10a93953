/* For the tests of this station: a scene from text, and a line through it with its answer as text. */
#ifndef QN_TESTS_RAY_RAYS_H
#define QN_TESTS_RAY_RAYS_H

#include "quoin/quoin.h"
#include "ray/scratch.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct stage {
  quoin_model *model;
  quoin_scene *scene;
  qn_scratch *scratch;
} stage;

QN_UNUSED static stage stage_open(const char *text) {
  stage st = {0};
  assert_int_equal(quoin_model_new(NULL, &st.model), QUOIN_OK);
  quoin_status status = quoin_model_read_text(st.model, QUOIN_ROOT, "test", text, strlen(text), NULL);
  if (status != QUOIN_OK) {
    char message[1000] = "no diagnostic";
    quoin_diag diag;
    if (quoin_model_diag(st.model, 0, &diag) == QUOIN_OK) {
      quoin_diag_format(&diag, message, sizeof message);
    }
    fail_msg("%s\n%s", text, message);
  }
  assert_int_equal(quoin_scene_compile(st.model, NULL, &st.scene), QUOIN_OK);
  assert_int_equal(qn_scratch_new(st.scene, &st.scratch), QUOIN_OK);
  return st;
}

QN_UNUSED static void stage_close(stage *st) {
  qn_scratch_free(st->scratch);
  quoin_scene_free(st->scene);
  quoin_model_free(st->model);
}

/* A number of a test: a decimal, or a hexadecimal double. */
QN_UNUSED static qn_num number_of(qn_ctx *ctx, const char *text) {
  qn_num n = QN_NUM_ZERO;
  if (strstr(text, "0x")) {
    return qn_num_from_double(ctx, strtod(text, NULL));
  }
  quoin_status status = QUOIN_OK;
  assert_int_equal(qn_num_read(ctx, text, strlen(text), &n, &status), strlen(text));
  return n;
}

static const qn_range WHOLE_LINE = {{.t = -HUGE_VAL, .surface = QN_NO_SURFACE}, {.t = HUGE_VAL, .surface = QN_NO_SURFACE}};

QN_UNUSED static void add_number(char *out, size_t size, double t) {
  size_t n = strlen(out);
  snprintf(out + n, size - n, "%s%.17g", n ? " " : "", t);
}

/* "t0 t1 ..." of the stretches inside; of those in the boundary after "on", of contacts after "at", where there are any. */
QN_UNUSED static void answer_of(stage *st, qn_line *line, const qn_range *range, char *out, size_t size) {
  qn_woven w;
  assert_int_equal(qn_weave(st->scene, st->scratch, line, range, QUOIN_WANT_BOUNDARY | QUOIN_WANT_CONTACTS, &w), QUOIN_OK);
  out[0] = '\0';
  for (size_t i = 0; i < w.inside_count; i++) {
    add_number(out, size, qn_place_round(st->scene, st->scratch, line, &w.inside[i].enter.place));
    add_number(out, size, qn_place_round(st->scene, st->scratch, line, &w.inside[i].leave.place));
  }
  if (w.boundary_count) {
    snprintf(out + strlen(out), size - strlen(out), "%son", out[0] ? " " : "");
  }
  for (size_t i = 0; i < w.boundary_count; i++) {
    add_number(out, size, qn_place_round(st->scene, st->scratch, line, &w.boundary[i].enter.place));
    add_number(out, size, qn_place_round(st->scene, st->scratch, line, &w.boundary[i].leave.place));
  }
  if (w.contact_count) {
    snprintf(out + strlen(out), size - strlen(out), "%sat", out[0] ? " " : "");
  }
  for (size_t i = 0; i < w.contact_count; i++) {
    add_number(out, size, qn_place_round(st->scene, st->scratch, line, &w.contacts[i].place));
  }
}

#endif
