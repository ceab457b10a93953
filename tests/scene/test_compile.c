/* The walk over the tree: Booleans, the dialect's rules on absent and empty things, simplification, materials, names, deep trees,
   refused memory. */
#include "scene/reading.h"
#include "share.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>

static uint64_t state = 31337;
static int in(int low, int high) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return low + (int)((state >> 33) % (uint64_t)(high - low + 1));
}

/* --- random trees of cubes against a plain evaluation ------------------------------------------------------------------ */

/* op: 0 union, 1 difference, 2 intersection, 3 cube */
typedef struct tree { int op; int box[6]; int first, next; int moved[3]; } tree;
enum { MOST = 400 };
static tree nodes[MOST];
static int node_count;
static char text[1 << 18];
static size_t at;

static void put(const char *format, ...) {
  va_list args;
  va_start(args, format);
  at += (size_t)vsnprintf(text + at, sizeof text - at, format, args);
  va_end(args);
  assert_true(at < sizeof text);
}

static int grow(int depth) {
  static const char *const words[] = {"union", "difference", "intersection"};
  int me = node_count++;
  tree *t = &nodes[me];
  *t = (tree){.op = depth == 0 ? 3 : in(0, 1) ? in(3, 4) : in(0, 2), .first = -1, .next = -1};
  for (int k = 0; k < 3; k++) {
    t->moved[k] = in(0, 2) ? 0 : in(-4, 4);
  }
  if (t->moved[0] || t->moved[1] || t->moved[2]) {
    put("translate([%d,%d,%d]) ", t->moved[0], t->moved[1], t->moved[2]);
  }
  if (t->op >= 3) {
    t->op = 3;
    int size[3];
    for (int k = 0; k < 3; k++) {
      size[k] = in(1, 9);
      t->box[k] = 0;
      t->box[3 + k] = size[k];
    }
    put("cube([%d,%d,%d]);\n", size[0], size[1], size[2]);
    return me;
  }
  put("%s() {\n", words[t->op]);
  int last = -1;
  for (int n = in(0, 9) ? in(2, 5) : 0; n && node_count < MOST - 10; n--) {
    int child = grow(depth - 1);
    if (last < 0) {
      nodes[me].first = child;
    } else {
      nodes[last].next = child;
    }
    last = child;
  }
  put("}\n");
  return me;
}

static int value(int n, const double p[3]) {
  const tree *t = &nodes[n];
  double q[3] = {p[0] - t->moved[0], p[1] - t->moved[1], p[2] - t->moved[2]};
  if (t->op == 3) {
    return q[0] > t->box[0] && q[0] < t->box[3] && q[1] > t->box[1] && q[1] < t->box[4] && q[2] > t->box[2] && q[2] < t->box[5];
  }
  int v = t->op == 2 && t->first >= 0;
  for (int c = t->first; c >= 0; c = nodes[c].next) {
    int w = value(c, q);
    v = t->op == 0 ? v || w : t->op == 2 ? v && w : c == t->first ? w : v && !w;
  }
  return v;
}

/* The program's value at a point off all boundaries, of a scene of cubes. */
static int program_value(const quoin_scene *s, qn_eval *eval, const double p[3]) {
  for (size_t i = 0; i < s->leaf_count; i++) {
    const qn_leaf *l = &s->leaves[i];
    if (p[0] > l->min[0] && p[0] < l->max[0] && p[1] > l->min[1] && p[1] < l->max[1] && p[2] > l->min[2] && p[2] < l->max[2]) {
      qn_eval_change(eval, l->gate, l->negated ? -1 : 1);
    }
  }
  int v = eval->value;
  qn_eval_reset(eval);
  return v;
}

static void random_booleans(void **unused) {
  (void)unused;
  size_t inside = 0, dropped = 0, kept = 0;
  for (int round = 0; round < share_of(600); round++) {
    node_count = 0;
    at = 0;
    int root = grow(5), cubes = 0;
    for (int i = 0; i < node_count; i++) {
      cubes += nodes[i].op == 3;
    }
    quoin_scene *s = scene_of(text);
    qn_eval eval;
    assert_true(qn_eval_init(&eval, &s->program, s->mem));
    kept += s->leaf_count;
    dropped += (size_t)cubes - s->leaf_count;
    for (size_t i = 0; i < s->leaf_count; i++) {
      assert_true(s->leaves[i].gate < s->program.gate_count && s->leaves[i].bounded && s->leaves[i].convex && s->leaves[i].halves == 6);
    }
    assert_int_equal(s->bvh.item_count, s->leaf_count);
    for (int n = 0; n < 300; n++) {
      double p[3] = {in(-10, 14) + 0.5, in(-10, 14) + 0.5, in(-10, 14) + 0.5};
      int v = value(root, p);
      assert_int_equal(program_value(s, &eval, p), v);
      inside += (size_t)v;
      for (int k = 0; k < 3 && v; k++) {
        assert_true(s->min[k] < p[k] && p[k] < s->max[k]);
      }
      assert_false(v && s->empty);
    }
    qn_eval_free(&eval, s->mem);
    quoin_scene_free(s);
  }
  print_message("%zu leaves kept, %zu dropped, %zu points inside\n", kept, dropped, inside);
  assert_true(inside > share_min(1000) && dropped > share_min(1000) && kept > share_min(1000));
}

/* --- the dialect's rules ------------------------------------------------------------------------------------------------ */

static void expect(const char *model, size_t leaves, int empty) {
  quoin_scene *s = scene_of(model);
  if (s->leaf_count != leaves || s->empty != empty) {
    print_message("%s: %zu leaves, empty %d\n", model, s->leaf_count, s->empty);
  }
  assert_int_equal(s->leaf_count, leaves);
  assert_int_equal(s->empty, empty);
  quoin_scene_info info;
  quoin_scene_get_info(s, &info);
  assert_int_equal(info.leaves, leaves);
  assert_int_equal(info.empty, empty);
  quoin_scene_free(s);
}

static void absent_and_empty(void **unused) {
  (void)unused;
  expect("", 0, 1);
  expect("group(){}", 0, 1);
  expect("difference(){}", 0, 1);
  expect("intersection(){}", 0, 1);
  expect("difference(){ group(){} cube(1); }", 0, 1);
  expect("difference(){ %cube(1); cube(2); }", 1, 0);
  expect("difference(){ %cube(1); }", 0, 1);
  expect("difference(){ cube(2); group(){} }", 1, 0);
  expect("difference(){ cube(2); difference(){} intersection(){} }", 1, 0);
  expect("intersection(){ cube(2); group(){} }", 0, 1);
  expect("intersection(){ cube(2); %cube(1); }", 1, 0);
  expect("intersection(){ cube(2); translate([0,0,1]) %cube(1); }", 0, 1);
  expect("%cube(1); cube(2); *cube(3); #cube(4);", 2, 0);
  expect("cube(1); translate([9,0,0]) { !cube(2); cube(3); }", 1, 0);
  expect("difference(){ cube(1); !translate([1,0,0]) cube(2); }", 1, 0);
  expect("multmatrix([[1,2,0,0],[2,4,0,0],[0,0,1,0]]) cube(1);", 0, 1);
  expect("difference(){ cube(1); multmatrix([[1,2,0,0],[2,4,0,0],[0,0,1,0]]) cube(1); }", 1, 0);
  expect("multmatrix([[0.1,0.2,0,0],[1,2,0,0],[0,0,1,0]]) rotate([1,2,3]) cube(1);", 0, 1);
  expect("quadric([1,1,1,0,0,0,0,0,0,1]);", 0, 1);
  expect("intersection(){ cube(1); quadric([0,0,0,0,0,0,0,0,0,-1]); }", 1, 0);
  expect("difference(){ cube(1); quadric([0,0,0,0,0,0,0,0,0,-1]); }", 0, 1);
}

static void all_of_space(void **unused) {
  (void)unused;
  quoin_scene *s = scene_of("quadric([0,0,0,0,0,0,0,0,0,-1]); cube(1);");
  assert_int_equal(s->leaf_count, 0);
  assert_false(s->empty);
  assert_int_equal(s->program.base, 1);
  quoin_scene_info info;
  quoin_scene_get_info(s, &info);
  assert_true(info.unbounded);
  quoin_scene_free(s);
}

static void apart(void **unused) {
  (void)unused;
  expect("difference(){ cube(1); translate([2,0,0]) cube(1); }", 1, 0);
  expect("difference(){ cube(1); translate([1.0000001,0,0]) cube(1); translate([0,0.5,0]) cube(1); }", 2, 0);
  expect("intersection(){ cube(1); translate([2,0,0]) cube(1); }", 0, 1);
  expect("intersection(){ cube(1); translate([1/2,0,0]) cube(1); translate([0,-1.001,0]) cube(1); }", 0, 1);
  expect("intersection(){ cube(1); union(){ translate([2,0,0]) cube(1); translate([0.5,0,0]) cube(1); } }", 2, 0);
  expect("difference(){ cube(1); union(){ translate([2,0,0]) cube(1); translate([3,0,0]) sphere(1); } }", 1, 0);
  /* the notch is out of the notched one's reach */
  expect("difference(){ cube(1); difference(){ cube(0.5); translate([0.8,0,0]) cube(0.1); } }", 2, 0);
  expect("difference(){ cube(9); difference(){ cube(8); intersection(){ cube(7); translate([20,0,0]) cube(1); } } }", 2, 0);
  /* boxes only: it stays */
  expect("difference(){ union(){ cube(1); translate([10,0,0]) cube(1); } translate([5,0,0]) cube(1); }", 3, 0);
  expect("intersection(){ rotate([10,20,30]) sphere(1); translate([2.1,0,0]) sphere(1); }", 0, 1);
  expect("intersection(){ halfspace(n=[0,0,1],d=0); translate([0,0,1]) cube(1); }", 0, 1);
  expect("difference(){ cube(1); halfspace(n=[0,0,1],d=-1); }", 1, 0);
}

static void flattened(void **unused) {
  (void)unused;
  quoin_scene *s = scene_of("union(){ group(){ color(\"red\") cube(1); } translate([1,0,0]) { cube(1); union(){ cube(1); sphere(3);} } }");
  assert_int_equal(s->program.gate_count, 1);
  assert_int_equal(s->program.gates[0].kids, 4);
  quoin_scene_free(s);
  s = scene_of("difference(){ cube(5); union(){ cube(1); sphere(1); } translate([1,1,1]) group(){ cube(1); cube(2);} }");
  assert_int_equal(s->program.gate_count, 1);
  assert_true(s->program.gates[0].is_and && s->program.gates[0].kids == 5);
  assert_true(!s->leaves[0].negated && s->leaves[1].negated && s->leaves[4].negated);
  quoin_scene_free(s);
  s = scene_of("difference(){ cube(5); difference(){ cube(3); cube(1); } }");
  assert_int_equal(s->program.gate_count, 2);
  assert_true(s->leaves[1].negated && !s->leaves[2].negated);
  quoin_scene_free(s);
}

/* --- names and materials --------------------------------------------------------------------------------------------------- */

static void names(void **unused) {
  (void)unused;
  quoin_scene *s = scene_of("cube(1);\n  name(\"outer\") { sphere(1); name(\"inner\") translate([1,0,0]) { cube(1); cube(2); } sphere(2); }");
  static const char *const expected[] = {"cube@1:1", "outer", "inner", "inner", "outer"};
  for (uint32_t i = 0; i < 5; i++) {
    assert_string_equal(quoin_part_name(s, i), expected[i]);
  }
  assert_string_equal(quoin_part_name(s, QUOIN_NO_PART), "");
  quoin_scene_free(s);
  quoin_model *m;
  assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
  assert_int_equal(quoin_add_sphere(m, QUOIN_ROOT, 1, NULL), QUOIN_OK);
  assert_int_equal(quoin_add_sphere(m, QUOIN_ROOT, 2, NULL), QUOIN_OK);
  assert_int_equal(quoin_scene_compile(m, NULL, &s), QUOIN_OK);
  assert_string_equal(quoin_part_name(s, 1), "sphere#1");
  assert_int_equal(quoin_add_sphere(m, QUOIN_ROOT, 2, NULL), QUOIN_E_ARGUMENT); /* frozen */
  quoin_model_free(m); /* before its scene */
  assert_string_equal(quoin_part_name(s, 0), "sphere#0");
  quoin_scene_free(s);
  char role[20];
  assert_int_equal(quoin_role_text(QUOIN_FACE + 12, role, sizeof role), 7);
  assert_string_equal(role, "face 12");
  quoin_role_text(QUOIN_CAP1, role, sizeof role);
  assert_string_equal(role, "cap1");
}

static void materials(void **unused) {
  (void)unused;
  quoin_scene *s = scene_of("cube(1); color(\"red\") { cube(1); color(\"blue\") cube(1); material(specular=0.9) cube(1); }"
                            "material(shininess=5) color([0,0,1]) cube(1); color([1,0,0]) cube(1); color([-1,-1,-1,1]) cube(1);");
  assert_int_equal(s->leaf_count, 7);
  const qn_leaf *l = s->leaves;
  assert_int_equal(l[0].material, 0);
  assert_int_equal(s->materials[0].has, 0);
  assert_true(s->materials[l[1].material].color[0] == 1 && s->materials[l[1].material].color[2] == 0);
  assert_int_equal(l[2].material, l[1].material); /* the outer colour wins */
  const qn_material *m = &s->materials[l[3].material];
  assert_true(m->color[0] == 1 && m->color[1] == 0 && m->specular == 0.9 && m->ambient == s->materials[0].ambient);
  m = &s->materials[l[4].material];
  assert_true(m->color[2] == 1 && m->shininess == 5);
  assert_int_equal(l[5].material, l[1].material); /* the same thing said twice is one material */
  assert_int_equal(l[6].material, 0);
  assert_int_equal(s->material_count, 5); /* with "shininess 5" alone, which no leaf has */
  quoin_scene_free(s);
}

/* --- size and want ----------------------------------------------------------------------------------------------------------- */

static void deep_trees(void **unused) {
  (void)unused;
  enum { LEVELS = 100000 };
  for (int kind = 0; kind < 3; kind++) {
    quoin_model *m;
    quoin_scene *s;
    assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
    quoin_node node = QUOIN_ROOT;
    for (int i = 0; i < LEVELS; i++) {
      const double v[3] = {i % 2 ? 1 : -1, 0.5, 0};
      if (kind == 0) {
        assert_int_equal(quoin_add_boolean(m, node, QUOIN_UNION, &node), QUOIN_OK);
      } else if (kind == 1) {
        assert_int_equal(quoin_add_translate(m, node, v, &node), QUOIN_OK);
      } else { /* a - (a - (a - ...)) */
        assert_int_equal(quoin_add_boolean(m, node, QUOIN_DIFFERENCE, &node), QUOIN_OK);
        assert_int_equal(quoin_add_sphere(m, node, 1, NULL), QUOIN_OK);
      }
    }
    assert_int_equal(quoin_add_sphere(m, node, 1, NULL), QUOIN_OK);
    assert_int_equal(quoin_scene_compile(m, NULL, &s), QUOIN_OK);
    assert_int_equal(s->leaf_count, kind == 2 ? LEVELS + 1 : 1);
    assert_int_equal(s->surface_count, 1);
    if (kind == 1) {
      assert_true(s->leaves[0].pivot[1] == LEVELS / 2 && s->leaves[0].pivot[0] == 0);
    }
    assert_non_null(qn_scene_exact(s, 0, NULL));
    quoin_scene_free(s);
    quoin_model_free(m);
  }
}

typedef struct want { size_t left; int on; } want;
static void *want_alloc(void *user, size_t size) {
  want *w = user;
  return w->on && w->left-- == 0 ? (w->left = 0, NULL) : malloc(size);
}
static void *want_resize(void *user, void *block, size_t old_size, size_t new_size) {
  (void)old_size;
  want *w = user;
  return w->on && w->left-- == 0 ? (w->left = 0, NULL) : realloc(block, new_size);
}
static void want_release(void *user, void *block, size_t size) {
  (void)user, (void)size;
  free(block);
}

static int swallow(void *user, const char *t, size_t length) {
  (void)t;
  *(size_t *)user += length;
  return 0;
}

static const char RICH[] =
  "difference() { name(\"plate\") cube([9,9,1]); translate([1/3,1/7,0]) cylinder(h=1,r=0.3); rotate([10,20,30]) cube(2); rotate([0,0,30]) rotate([0,0,60]) cube(1);"
  " rotate([0,0,90]) cube(1); intersection() { sphere(1); color(\"red\") quadric([1,2,3,0,0,0,0,0,0,-4]); color(\"blue\") halfspace(n=[1,2,3],d=1); } }"
  "superquadric(r=[1,1,1],e=0.5,n=1.5); translate([1e20,0.1,0]) translate([-1e20,0,0]) rotate(a=120,v=[1,1,1]) ellipsoid(r=[1,2,3]);";

/* Each allocation refused in turn: a status, nothing lost, and the model can be compiled afterwards. */
static void refused_memory(void **unused) {
  (void)unused;
  size_t refused = 0;
  for (size_t n = 0;; n++) {
    want w = {0, 0};
    quoin_allocator a = {want_alloc, want_resize, want_release, &w, 0};
    quoin_model *m;
    quoin_scene *s = NULL;
    assert_int_equal(quoin_model_new(&a, &m), QUOIN_OK);
    assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "t", RICH, strlen(RICH), NULL), QUOIN_OK);
    size_t used = atomic_load(&m->mem.used);
    w = (want){n, 1};
    quoin_compile_options o = quoin_compile_options_default();
    o.threads = 1;
    quoin_status status = quoin_scene_compile(m, &o, &s);
    w.on = 0;
    if (status != QUOIN_OK) {
      refused++;
      assert_int_equal(status, QUOIN_E_MEMORY);
      assert_null(s);
      assert_int_equal(atomic_load(&m->mem.used), used);
      assert_int_equal(quoin_scene_compile(m, &o, &s), QUOIN_OK);
    }
    size_t length = 0;
    w = (want){n, 1};
    quoin_status printed = quoin_scene_write_text(s, swallow, &length);
    assert_true(printed == QUOIN_OK || printed == QUOIN_E_MEMORY);
    w.on = 0;
    assert_int_equal(quoin_scene_write_text(s, swallow, &length), QUOIN_OK);
    quoin_scene_free(s);
    assert_int_equal(atomic_load(&m->mem.used), used);
    quoin_model_free(m);
    if (status == QUOIN_OK && printed == QUOIN_OK) {
      break;
    }
  }
  print_message("%zu refusals\n", refused);
  assert_true(refused > 50);
}

static int stop_at(void *user, double done) {
  assert_true(done >= 0 && done <= 1);
  return done >= *(double *)user;
}

static void cancelled(void **unused) {
  (void)unused;
  quoin_model *m;
  quoin_scene *s;
  assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
  assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "t", RICH, strlen(RICH), NULL), QUOIN_OK);
  quoin_compile_options o = quoin_compile_options_default();
  for (double when = 0; when <= 1; when += 0.25) {
    o.progress = (quoin_progress){stop_at, &when};
    assert_int_equal(quoin_scene_compile(m, &o, &s), QUOIN_E_CANCELLED);
    assert_null(s);
  }
  o.progress.report = NULL;
  assert_int_equal(quoin_scene_compile(m, &o, &s), QUOIN_OK);
  quoin_scene_free(s);
  quoin_model_free(m);
  assert_int_equal(quoin_scene_compile(NULL, NULL, &s), QUOIN_E_ARGUMENT);
}

/* Two scenes of one model; and threads that ask for the same exact form get the same one. */
static void *ask(void *scene) {
  const quoin_scene *s = scene;
  for (uint32_t i = 0; i < s->surface_count; i++) {
    if (s->surfaces[i].kind != QN_SUPER_BODY && !qn_scene_exact(s, i, NULL)) {
      return NULL;
    }
  }
  return scene;
}

static void shared_by_threads(void **unused) {
  (void)unused;
  quoin_scene *s = scene_of(RICH);
  pthread_t threads[4];
  for (int i = 0; i < 4; i++) {
    assert_int_equal(pthread_create(&threads[i], NULL, ask, s), 0);
  }
  for (int i = 0; i < 4; i++) {
    void *result;
    pthread_join(threads[i], &result);
    assert_ptr_equal(result, s);
  }
  int made = 1;
  const qn_exact_surface *e = qn_scene_exact(s, 0, &made);
  assert_false(made);
  assert_ptr_equal(e, qn_scene_exact(s, 0, NULL));
  quoin_scene_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(random_booleans), cmocka_unit_test(absent_and_empty), cmocka_unit_test(all_of_space), cmocka_unit_test(apart),
    cmocka_unit_test(flattened), cmocka_unit_test(names), cmocka_unit_test(materials), cmocka_unit_test(deep_trees),
    cmocka_unit_test(refused_memory), cmocka_unit_test(cancelled), cmocka_unit_test(shared_by_threads),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
