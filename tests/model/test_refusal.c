/* Each allocation refused once: the call says so, changes nothing, and leaks nothing. And a limit of memory is kept. */
#include "model/tree.h"

typedef struct meter { size_t used, blocks, countdown; int refused; } meter;

static void *meter_alloc(void *user, size_t size) {
  meter *m = user;
  if (m->countdown && --m->countdown == 0) {
    m->refused = 1;
    return NULL;
  }
  m->used += size;
  m->blocks++;
  return malloc(size);
}
static void *meter_resize(void *user, void *block, size_t old_size, size_t new_size) {
  meter *m = user;
  if (m->countdown && --m->countdown == 0) {
    m->refused = 1;
    return NULL;
  }
  m->used += new_size - old_size;
  return realloc(block, new_size);
}
static void meter_release(void *user, void *block, size_t size) {
  meter *m = user;
  m->used -= size;
  m->blocks--;
  free(block);
}

static const char good[] =
  "w = [1/3, sqrt(2), 2^300]; $fn = 6; a = 1 < 2 ? w[1] : 3;\n"
  "camera(eye = [1, 2, 3]); light(at = [1, 2, 3]); background(\"white\");\n"
  "difference() { cube(w); translate([a, 0, 1]) rotate(a = 30, v = [1, 2, 3]) cylinder(h = 1, r = 2); }\n"
  "name(\"n\") color(\"red\", 0.5) material(specular = 0.5) { x = sin(20); sphere(x, nope = 1); }\n"
  "polyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]);\n"
  "quadric([1, 1, 1, 0, 0, 0, 0, 0, 0, -12345678901234567890.1]); multmatrix([[2, 0, 0], [0, 1/3, 0]]) cube(0);\n"
  "sphere(12345678901234567890123456789.5); echo(w, \"text\"); x = 1; x = 2; scale([0, 1, 1]) !cube(1);\n";
static const char bad[] =
  "cube(nope); sphere(1 2); translate([1, 2) cube(\"a\"); x = 3 ^ 100000; hull() cyllinder(); cube(0); } \"open";

static void sweep(const char *text, quoin_status want) {
  size_t refusals = 0;
  for (size_t k = 1;; k++) {
    meter m = {.countdown = k};
    quoin_allocator a = {meter_alloc, meter_resize, meter_release, &m, 0};
    quoin_model *model;
    quoin_status status = quoin_model_new(&a, &model);
    if (status == QUOIN_OK) {
      quoin_node node;
      status = quoin_add_boolean(model, QUOIN_ROOT, QUOIN_UNION, &node);
      if (status == QUOIN_OK) {
        size_t nodes = model->node_count, numbers = model->number_count, diags = quoin_model_diag_count(model);
        status = quoin_model_read_text(model, node, "t", text, strlen(text), NULL);
        if (status == QUOIN_E_MEMORY) {
          assert_true(m.refused);
          assert_int_equal(model->node_count, nodes);
          assert_int_equal(model->number_count, numbers);
          assert_int_equal(model->nodes[node].first, QN_NO_NODE);
          assert_int_equal(model->light_count + model->name_count + model->material_count + model->leaf_count, 0);
          assert_int_equal(model->view.has_camera, 0);
          assert_int_equal(model->only, QN_NO_NODE);
          assert_int_equal(quoin_model_diag_count(model), diags);
          /* and it works the next time */
          assert_int_equal(quoin_model_read_text(model, node, "t", text, strlen(text), NULL), want);
        }
      }
      if (status != QUOIN_E_MEMORY) {
        assert_int_equal(status, want);
        if (want == QUOIN_OK) {
          tree_text t = {NULL, 0, 0};
          meter before = m;
          status = quoin_model_write_tree(model, tree_write, &t);
          assert_true(status == QUOIN_OK || (status == QUOIN_E_MEMORY && m.refused));
          assert_int_equal(m.blocks, before.blocks);
          free(t.at);
        }
      }
      quoin_model_free(model);
    } else {
      assert_int_equal(status, QUOIN_E_MEMORY);
    }
    assert_int_equal(m.used, 0);
    assert_int_equal(m.blocks, 0);
    if (!m.refused) {
      break;
    }
    refusals++;
  }
  print_message("%zu allocations refused, one at a time\n", refusals);
  assert_true(refusals > 20);
}

static void one_by_one(void **state) {
  (void)state;
  sweep(good, QUOIN_OK);
  sweep(bad, QUOIN_E_LIMIT); /* one of its errors is a limit */
}

static void limit(void **state) {
  (void)state;
  for (size_t bytes = 1 << 10; bytes < (1 << 22); bytes *= 2) {
    quoin_allocator a = {.limit = bytes};
    quoin_model *model;
    quoin_status status = quoin_model_new(&a, &model);
    if (status == QUOIN_OK) {
      status = quoin_model_read_text(model, QUOIN_ROOT, "t", good, sizeof good - 1, NULL);
      quoin_model_free(model);
    }
    assert_true(status == QUOIN_OK || status == QUOIN_E_MEMORY);
    if (bytes >= 1 << 21) {
      assert_int_equal(status, QUOIN_OK);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(one_by_one), cmocka_unit_test(limit)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
