/* Building by calls: nodes, exact doubles, what is refused; reading files; limits of errors; what is frozen. */
#include "model/tree.h"

#include <math.h>
#include <unistd.h>

static quoin_model *new_model(void) {
  quoin_model *m;
  assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
  return m;
}

static void tree(void **state) {
  (void)state;
  quoin_model *m = new_model();
  quoin_node d, t, n;
  static const double v[3] = {0.1, -2, 3}, red[4] = {1, 0, 0, 0.5}, size[3] = {1, 2, 3};
  static const double matrix[12] = {1, 0, 0, 5, 0, 2, 0, 6, 0, 0, 4, 7}, q[10] = {1, 1, 1, 0, 0, 0, 0, 0, 0, -1};
  assert_int_equal(quoin_add_boolean(m, QUOIN_ROOT, QUOIN_DIFFERENCE, &d), QUOIN_OK);
  assert_int_equal(quoin_add_cube(m, d, size, 1, &n), QUOIN_OK);
  assert_int_equal(quoin_add_translate(m, d, v, &t), QUOIN_OK);
  assert_int_equal(quoin_add_sphere(m, t, 0.5, NULL), QUOIN_OK);
  assert_int_equal(quoin_add_rotate(m, t, v, &t), QUOIN_OK);
  assert_int_equal(quoin_add_scale(m, t, size, &t), QUOIN_OK);
  assert_int_equal(quoin_add_multmatrix(m, t, matrix, &t), QUOIN_OK);
  assert_int_equal(quoin_add_color(m, t, red, &t), QUOIN_OK);
  assert_int_equal(quoin_add_name(m, t, "part", &t), QUOIN_OK);
  assert_int_equal(quoin_add_cylinder(m, t, 3, 2, 1, 0, NULL), QUOIN_OK);
  assert_int_equal(quoin_add_ellipsoid(m, t, size, NULL), QUOIN_OK);
  assert_int_equal(quoin_add_wedge(m, t, size, 0, NULL), QUOIN_OK);
  assert_int_equal(quoin_add_paraboloid(m, t, 3, 2, NULL), QUOIN_OK);
  assert_int_equal(quoin_add_hyperboloid(m, t, 3, 2, 1, NULL), QUOIN_OK);
  assert_int_equal(quoin_add_hyperboloid2(m, t, 3, 2, 1, NULL), QUOIN_OK);
  assert_int_equal(quoin_add_saddle(m, t, 3, 2, NULL), QUOIN_OK);
  assert_int_equal(quoin_add_quadric(m, t, q, NULL), QUOIN_OK);
  assert_int_equal(quoin_add_halfspace(m, t, size, 4, NULL), QUOIN_OK);
  assert_int_equal(quoin_add_superquadric(m, t, size, 0.5, 2, NULL), QUOIN_OK);
  /* A double is itself: 0.1 is 0x1.999999999999ap-4, which takes 55 digits. */
  static const char want[] =
    "difference() {\n  cube(size = [1, 2, 3], center = true);\n  translate([(3602879701896397/2^55), -2, 3]) {\n    sphere(r = 0.5);\n"
    "    rotate([(3602879701896397/2^55), -2, 3]) {\n      scale([1, 2, 3]) {\n"
    "        multmatrix([[1, 0, 0, 5], [0, 2, 0, 6], [0, 0, 4, 7]]) {\n          color([1, 0, 0, 0.5]) {\n            name(\"part\") {\n"
    "              cylinder(h = 3, r1 = 2, r2 = 1, $fn = 0);\n              ellipsoid(r = [1, 2, 3]);\n              wedge(size = [1, 2, 3]);\n"
    "              paraboloid(h = 3, r = 2);\n              hyperboloid(h = 3, r = 2, rc = 1);\n              hyperboloid(h = 3, r = 2, gap = 1);\n"
    "              saddle(a = 3, b = 2);\n              quadric([1, 1, 1, 0, 0, 0, 0, 0, 0, -1]);\n              halfspace(n = [1, 2, 3], d = 4);\n"
    "              superquadric(r = [1, 2, 3], e = 0.5, n = 2);\n            }\n          }\n        }\n      }\n    }\n  }\n}\n";
  tree_text got = tree_print(m);
  assert_string_equal(got.at, want);
  free(got.at);
  tree_round(m);
  assert_int_equal(m->leaf_count, 12);
  /* Text goes below any node, and what it says is added behind. */
  assert_int_equal(quoin_model_read_text(m, d, "more", "sphere(0.1);", 12, NULL), QUOIN_OK);
  assert_int_equal(m->nodes[m->nodes[d].last].payload, QN_SPHERE);
  quoin_model_free(m);
}

static void refused(void **state) {
  (void)state;
  quoin_model *m = new_model();
  quoin_node leaf, n = 77;
  static const double v[3] = {1, 2, 3}, bad[3] = {1, (double)INFINITY, 3}, zero[3] = {0, 0, 0};
  assert_int_equal(quoin_add_sphere(m, QUOIN_ROOT, 1, &leaf), QUOIN_OK);
  assert_int_equal(quoin_add_sphere(m, leaf, 1, &n), QUOIN_E_ARGUMENT); /* a leaf has no children */
  assert_int_equal(quoin_add_sphere(m, 99, 1, &n), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_add_sphere(m, QUOIN_ROOT, (double)NAN, &n), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_add_sphere(NULL, QUOIN_ROOT, 1, &n), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_add_translate(m, QUOIN_ROOT, bad, &n), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_add_translate(m, QUOIN_ROOT, NULL, &n), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_add_halfspace(m, QUOIN_ROOT, zero, 1, &n), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_add_halfspace(m, QUOIN_ROOT, v, (double)INFINITY, &n), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_add_superquadric(m, QUOIN_ROOT, v, -1, 1, &n), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_add_hyperboloid2(m, QUOIN_ROOT, 1, 2, 1, &n), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_add_hyperboloid2(m, QUOIN_ROOT, 1, 2, -0.5, &n), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "t", "cube(1);", 8, &(quoin_read_options){.facets = (quoin_facets)99}), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_add_name(m, QUOIN_ROOT, NULL, &n), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_model_read_text(m, leaf, "t", "", 0, NULL), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "t", NULL, 3, NULL), QUOIN_E_ARGUMENT);
  assert_int_equal(n, 77);
  assert_int_equal(m->node_count, 2);
  assert_int_equal(quoin_model_diag_count(m), 0);
  /* Sizes of zero are empty solids, in their place, with a warning; so is what a singular transform acts on. */
  assert_int_equal(quoin_add_cube(m, QUOIN_ROOT, zero, 0, &n), QUOIN_OK);
  assert_int_equal(m->nodes[n].kind, QN_NODE_UNION);
  static const double singular[12] = {0.1, 0.2, 0, 0, 0.2, 0.4, 0, 0, 0, 0, 1, 0};
  assert_int_equal(quoin_add_multmatrix(m, QUOIN_ROOT, singular, &n), QUOIN_OK);
  assert_int_equal(quoin_add_cube(m, n, v, 0, NULL), QUOIN_OK);
  assert_int_equal(m->nodes[n].kind, QN_NODE_INTERSECTION);
  assert_int_equal(m->nodes[m->nodes[n].first].first, QN_NO_NODE);
  quoin_diag d;
  assert_int_equal(quoin_model_diag_count(m), 2);
  quoin_model_diag(m, 0, &d);
  assert_string_equal(d.code, "Q0501");
  quoin_model_diag(m, 1, &d);
  assert_string_equal(d.code, "Q0503");
  assert_int_equal(quoin_model_diag(m, 2, &d), QUOIN_E_ARGUMENT);
  /* Frozen: as compiling does. */
  m->frozen = 1;
  assert_int_equal(quoin_add_sphere(m, QUOIN_ROOT, 1, NULL), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "t", "", 0, NULL), QUOIN_E_ARGUMENT);
  qn_model_retain(m);
  quoin_model_free(m);
  assert_int_equal(m->node_count, 6); /* a scene would still hold it */
  qn_model_release(m);
  quoin_model_free(NULL);
}

static void errors_add_nothing(void **state) {
  (void)state;
  quoin_model *m = new_model();
  static const char first[] = "cube(1);", bad[] = "sphere(2); name(\"x\") color(\"red\") light(at = [1, 2, 3]); !cube(2);", last[] = "sphere(3);";
  assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "a", first, sizeof first - 1, NULL), QUOIN_OK);
  assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "b", bad, sizeof bad - 1, NULL), QUOIN_E_MODEL);
  assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "c", last, sizeof last - 1, NULL), QUOIN_OK);
  tree_text got = tree_print(m);
  assert_string_equal(got.at, "cube(size = [1, 1, 1]);\nsphere(r = 3);\n");
  free(got.at);
  quoin_diag d;
  assert_int_equal(quoin_model_diag_count(m), 1);
  quoin_model_diag(m, 0, &d);
  assert_string_equal(d.file, "b");
  assert_string_equal(d.code, "Q0409");
  quoin_model_free(m);
}

static void error_limit(void **state) {
  (void)state;
  static const char text[] = "cube(a); cube(b); cube(c); cube(d); }";
  for (size_t most = 0; most < 8; most++) { /* 0: the default */
    quoin_model *m = new_model();
    quoin_read_options o = quoin_read_options_default();
    o.max_errors = most;
    assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "t", text, sizeof text - 1, &o), QUOIN_E_MODEL);
    size_t errors = 0;
    for (size_t i = 0; i < quoin_model_diag_count(m); i++) {
      quoin_diag d;
      quoin_model_diag(m, i, &d);
      errors += d.severity == QUOIN_ERROR;
    }
    assert_int_equal(errors, most && most < 5 ? most : 5);
    assert_int_equal(quoin_model_diag_count(m), most && most <= 5 ? errors + 1 : 5);
    char none[4] = "old";
    assert_true(quoin_diag_format(NULL, none, sizeof none) == 0 && none[0] == '\0');
    quoin_model_free(m);
  }
}

static void files(void **state) {
  (void)state;
  quoin_model *m = new_model();
  quoin_diag d;
  assert_int_equal(quoin_model_read_file(m, QUOIN_ROOT, "no/such/file.scad", NULL), QUOIN_E_IO);
  assert_int_equal(quoin_model_read_file(m, QUOIN_ROOT, QN_SOURCE_DIR, NULL), QUOIN_E_IO); /* a folder */
  assert_int_equal(quoin_model_diag_count(m), 2);
  for (size_t i = 0; i < 2; i++) {
    quoin_model_diag(m, i, &d);
    assert_string_equal(d.code, "Q0801");
    assert_int_equal(d.line, 0);
    assert_true(d.reason[0] != '\0');
  }
  assert_string_equal(d.file, QN_SOURCE_DIR);
  char path[200];
  snprintf(path, sizeof path, "%s/model_test_build_%ld.scad", QN_BINARY_DIR, (long)getpid());
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  fputs("cube(1);\nsphere(oops);\n", f);
  fclose(f);
  assert_int_equal(quoin_model_read_file(m, QUOIN_ROOT, path, NULL), QUOIN_E_MODEL);
  char text[600];
  quoin_model_diag(m, 0, &d);
  assert_string_equal(d.file, path);
  assert_int_equal(d.line, 2);
  assert_int_equal(d.column, 8);
  size_t need = quoin_diag_format(&d, text, sizeof text);
  assert_int_equal(need, strlen(text));
  assert_non_null(strstr(text, ":2:8: error: unknown name 'oops'"));
  assert_non_null(strstr(text, "\n  sphere(oops);\n         ^^^^\n"));
  f = fopen(path, "wb");
  assert_non_null(f);
  fputs("cube(1);", f);
  fclose(f);
  assert_int_equal(quoin_model_read_file(m, QUOIN_ROOT, path, NULL), QUOIN_OK);
  remove(path);
  assert_int_equal(m->leaf_count, 1);
  quoin_model_free(m);
}

static int stop_at(void *user, const char *text, size_t length) {
  (void)text, (void)length;
  int *left = user;
  return (*left)-- <= 0;
}

static void write_stops(void **state) {
  (void)state;
  quoin_model *m = new_model();
  for (int i = 0; i < 2000; i++) {
    assert_int_equal(quoin_add_sphere(m, QUOIN_ROOT, i + 0.5, NULL), QUOIN_OK);
  }
  for (int left = 0; left < 2; left++) {
    int n = left;
    assert_int_equal(quoin_model_write_tree(m, stop_at, &n), QUOIN_E_IO);
  }
  quoin_model_free(m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(tree),  cmocka_unit_test(refused),     cmocka_unit_test(errors_add_nothing), cmocka_unit_test(error_limit),
    cmocka_unit_test(files), cmocka_unit_test(write_stops),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
