/* Print, read, print: on everything that can be read. */
#include "model/tree.h"

#include <dirent.h>

static void goldens(void **state) {
  (void)state;
  DIR *dir = opendir(QN_SOURCE_DIR "/tests/model/golden");
  assert_non_null(dir);
  int count = 0;
  for (struct dirent *e; (e = readdir(dir)) != NULL;) {
    size_t n = strlen(e->d_name);
    if (n < 5 || strcmp(e->d_name + n - 5, ".scad") != 0) {
      continue;
    }
    char path[4096];
    snprintf(path, sizeof path, "%s/tests/model/golden/%s", QN_SOURCE_DIR, e->d_name);
    quoin_model *m;
    assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
    quoin_status status = quoin_model_read_file(m, QUOIN_ROOT, path, NULL);
    if (status == QUOIN_OK) {
      tree_round(m);
      count++;
    } else { /* nothing was added */
      assert_int_equal(m->node_count, 1);
      assert_int_equal(m->nodes[0].first, QN_NO_NODE);
      assert_int_equal(m->number_count + m->name_count + m->material_count + m->light_count + m->leaf_count, 0);
      assert_int_equal(m->view.has_camera + m->view.has_background, 0);
      assert_int_equal(m->only, QN_NO_NODE);
    }
    quoin_model_free(m);
  }
  closedir(dir);
  assert_true(count >= 10);
}

static uint64_t next(uint64_t *seed) { /* xorshift64* */
  *seed ^= *seed >> 12;
  *seed ^= *seed << 25;
  *seed ^= *seed >> 27;
  return *seed * 2685821657736338717u;
}

/* Trees at random, built by calls from doubles of every size: 16 bits to 53, exponents over the whole range. */
static void random_trees(void **state) {
  (void)state;
  uint64_t seed = 88172645463325252u;
  for (int round = 0; round < 60; round++) {
    quoin_model *m;
    assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
    quoin_node open[8] = {QUOIN_ROOT};
    size_t depth = 1;
    for (int i = 0; i < 60; i++) {
      double v[12];
      for (int k = 0; k < 12; k++) {
        uint64_t bits = next(&seed);
        int wide = (int)(bits % 53) + 1, range = round % 3 == 0 ? 1000 : 20;
        double mantissa = (double)(next(&seed) >> (64 - wide)) + 1;
        int exponent = (int)(next(&seed) % (uint64_t)(2 * range + 1)) - range;
        v[k] = mantissa;
        for (int e = exponent; e != 0; e += e < 0 ? 1 : -1) {
          v[k] *= e < 0 ? 0.5 : 2;
        }
        v[k] = v[k] > 1e300 || v[k] < 1e-300 ? 1.5 : v[k];
      }
      double s[12];
      for (int k = 0; k < 12; k++) {
        s[k] = next(&seed) & 1 ? v[k] : -v[k];
      }
      quoin_node parent = open[depth - 1], n = QUOIN_ROOT;
      quoin_status status = QUOIN_OK;
      switch (next(&seed) % 18) {
      case 0: status = quoin_add_boolean(m, parent, (quoin_op)(next(&seed) % 3), &n); break;
      case 1: status = quoin_add_translate(m, parent, s, &n); break;
      case 2: status = quoin_add_multmatrix(m, parent, s, &n); break;
      case 3: status = quoin_add_rotate(m, parent, s, &n); break;
      case 4: status = quoin_add_scale(m, parent, s, &n); break;
      case 5: status = quoin_add_color(m, parent, v, &n); break;
      case 6: status = quoin_add_name(m, parent, "a \"name\"", &n); break;
      case 7: status = quoin_add_sphere(m, parent, v[0], NULL); break;
      case 8: status = quoin_add_ellipsoid(m, parent, v, NULL); break;
      case 9: status = quoin_add_cube(m, parent, v, i & 1, NULL); break;
      case 10: status = quoin_add_cylinder(m, parent, v[0], v[1], i & 1 ? 0 : v[2], i & 2, NULL); break;
      case 11: status = quoin_add_paraboloid(m, parent, v[0], v[1], NULL); break;
      case 12: status = quoin_add_hyperboloid(m, parent, v[0], v[1], v[2], NULL); break;
      case 13: status = quoin_add_hyperboloid2(m, parent, v[0], v[1], v[0] * 0.5, NULL); break;
      case 14: status = quoin_add_saddle(m, parent, v[0], v[1], NULL); break;
      case 15: status = quoin_add_quadric(m, parent, s, NULL); break;
      case 16: status = quoin_add_halfspace(m, parent, s, s[3], NULL); break;
      case 17: status = quoin_add_superquadric(m, parent, v, v[3], v[4], NULL); break;
      }
      assert_int_equal(status, QUOIN_OK);
      if (n != QUOIN_ROOT && depth < 8) {
        open[depth++] = n;
      } else if (depth > 1 && next(&seed) % 3 == 0) {
        depth--;
      }
    }
    tree_round(m);
    quoin_model_free(m);
  }
}

/* Numbers that are no decimals: fractions, rounded ones, large and small, and exactness of what is read. */
static void numbers(void **state) {
  (void)state;
  static const char *const texts[] = {
    "cube([1/3, 22/7, 1e-30]);",
    "sphere(sqrt(2));",
    "translate([sin(20), -cos(20), tan(1)]) cube([PI, exp(1), ln(2)]);",
    "sphere(2^-2000 * sqrt(3)); sphere(2^2000 * sqrt(3));",
    "sphere(3^-500);",
    "sphere(7^600 / 3);",
    "sphere(1e4000); sphere(1e-4000); sphere(123456789e3990);",
    "sphere(1e4000 * 1e4000);",
    "sphere(3^20000 / 2^20000);",
  };
  for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
    quoin_model *m = tree_read(texts[i], strlen(texts[i]));
    tree_round(m);
    quoin_model_free(m);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(goldens), cmocka_unit_test(random_trees), cmocka_unit_test(numbers)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
