/* Exact maps of transforms: what is rational is exact, and turns compose to what they must within S2's rule. */
#include "model/tree.h"

/* The exact product of the maps from the root down the first children of a text's only chain. */
static void chain(qn_ctx *ctx, const char *text, qn_num map[12]) {
  quoin_model *m = tree_read(text, strlen(text));
  for (size_t i = 0; i < 12; i++) {
    map[i] = i % 5 == 0 ? QN_NUM_ONE : QN_NUM_ZERO;
  }
  for (uint32_t n = m->nodes[0].first; n != QN_NO_NODE; n = m->nodes[n].first) {
    qn_num next[12], product[12];
    qn_solid_map(ctx, m, n, next);
    for (size_t i = 0; i < 3; i++) {
      for (size_t j = 0; j < 4; j++) {
        qn_num a[4] = {map[4 * i], map[4 * i + 1], map[4 * i + 2], map[4 * i + 3]};
        qn_num b[4] = {next[j], next[4 + j], next[8 + j], j == 3 ? QN_NUM_ONE : QN_NUM_ZERO};
        product[4 * i + j] = qn_num_dot(ctx, 4, a, b);
      }
    }
    for (size_t i = 0; i < 12; i++) {
      map[i] = qn_num_copy(ctx, product[i]);
    }
  }
  quoin_model_free(m);
}

static void is(const char *text, const char *want) {
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  qn_ctx ctx;
  qn_ctx_init(&ctx, &mem);
  qn_num map[12];
  chain(&ctx, text, map);
  char got[2000] = "";
  for (size_t i = 0; i < 12; i++) {
    strcat(got, i == 0 ? "" : i % 4 ? " " : " | ");
    strcat(got, qn_num_text(&ctx, map[i]));
  }
  if (strcmp(got, want) != 0) {
    fail_msg("%s gave %s, not %s", text, got, want);
  }
  qn_ctx_free(&ctx);
}

static void same(const char *one, const char *two) {
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  qn_ctx ctx;
  qn_ctx_init(&ctx, &mem);
  qn_num a[12], b[12];
  chain(&ctx, one, a);
  chain(&ctx, two, b);
  for (size_t i = 0; i < 12; i++) {
    if (qn_num_cmp(&ctx, a[i], b[i]) != 0) {
      fail_msg("%s is not %s at %zu: %s, %s", one, two, i, qn_num_text(&ctx, a[i]), qn_num_text(&ctx, b[i]));
    }
  }
  qn_ctx_free(&ctx);
}

static void exact(void **state) {
  (void)state;
  is("group();", "1 0 0 0 | 0 1 0 0 | 0 0 1 0");
  is("translate([5, 5, 8.1-9+0.9]);", "1 0 0 5 | 0 1 0 5 | 0 0 1 0");
  is("scale([2, 1/3, -4]);", "2 0 0 0 | 0 (1/3) 0 0 | 0 0 -4 0");
  is("rotate([90, 0, 0]);", "1 0 0 0 | 0 0 -1 0 | 0 1 0 0");   /* y to z */
  is("rotate([0, 90, 0]);", "0 0 1 0 | 0 1 0 0 | -1 0 0 0");   /* z to x */
  is("rotate([0, 0, 90]);", "0 -1 0 0 | 1 0 0 0 | 0 0 1 0");   /* x to y */
  is("rotate([180, 0, 270]);", "0 -1 0 0 | -1 0 0 0 | 0 0 -1 0");
  is("rotate(a = 90, v = [0, 0, 2]);", "0 -1 0 0 | 1 0 0 0 | 0 0 1 0");
  is("rotate(a = 120, v = [1, 1, 1]);", "0 0 1 0 | 1 0 0 0 | 0 1 0 0"); /* x to y to z to x */
  is("rotate(a = -120, v = [1, 1, 1]);", "0 1 0 0 | 0 0 1 0 | 1 0 0 0");
  is("rotate(a = 180, v = [3, 4, 0]);", "-0.28 0.96 0 0 | 0.96 0.28 0 0 | 0 0 -1 0");
  is("mirror([1, 0, 0]);", "-1 0 0 0 | 0 1 0 0 | 0 0 1 0");
  is("mirror([1, 1, 1]);", "(1/3) (-2/3) (-2/3) 0 | (-2/3) (1/3) (-2/3) 0 | (-2/3) (-2/3) (1/3) 0");
  is("multmatrix([[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 12, 12]]);", "1 2 3 4 | 5 6 7 8 | 9 10 12 12");
  is("translate([1, 0, 0]) rotate(90) translate([2, 0, 0]);", "0 -1 0 1 | 1 0 0 2 | 0 0 1 0");
  is("color(\"red\") name(\"x\") union();", "1 0 0 0 | 0 1 0 0 | 0 0 1 0");
}

static void composed(void **state) {
  (void)state;
  same("rotate(30) rotate(60);", "rotate(90);");
  same("rotate(17) rotate(23);", "rotate(40);");
  same("rotate([11, 22, 33]);", "rotate([0, 0, 33]) rotate([0, 22, 0]) rotate([11, 0, 0]);");
  same("rotate(a = 41, v = [0, 0, 5]);", "rotate(41);");
  same("rotate(a = 41, v = [0, -5, 0]);", "rotate([0, -41, 0]);");
  same("rotate(a = 41, v = [7, 0, 0]);", "rotate([41, 0, 0]);");
  same("rotate(a = 50, v = [1, 2, 3]) rotate(a = -50, v = [2, 4, 6]);", "group();");
  same("rotate(a = 40, v = [1, 2, 3]) rotate(a = 40, v = [1, 2, 3]) rotate(a = 40, v = [1, 2, 3]);", "rotate(a = 120, v = [1, 2, 3]);");
  same("mirror([1, 2, 3]) mirror([1, 2, 3]);", "group();");
  same("mirror([cos(20), sin(20), 0]) mirror([1, 0, 0]);", "rotate(40);");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(exact), cmocka_unit_test(composed)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
