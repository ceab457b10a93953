/* Every word: its arguments by position and by name, its defaults, and the node it makes, seen in the canonical print
   (which is read back and compared too). */
#include "model/tree.h"

static void gives_with(const char *text, const char *want, const quoin_read_options *options) {
  quoin_model *m;
  assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
  assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "t", text, strlen(text), options), QUOIN_OK);
  tree_text got = tree_print(m);
  if (strcmp(got.at, want) != 0) {
    fail_msg("%s\ngave\n%s\nnot\n%s", text, got.at, want);
  }
  free(got.at);
  if (!options) {
    tree_round(m);
  }
  quoin_model_free(m);
}
static void gives(const char *text, const char *want) {
  gives_with(text, want, NULL);
}

/* Does a text give so many diagnostics of a code, and no other? */
static void says(const char *text, const char *code, size_t count) {
  quoin_model *m = tree_read(text, strlen(text));
  assert_int_equal(quoin_model_diag_count(m), count);
  for (size_t i = 0; i < count; i++) {
    quoin_diag d;
    quoin_model_diag(m, i, &d);
    assert_string_equal(d.code, code);
  }
  quoin_model_free(m);
}

static void cube(void **state) {
  (void)state;
  gives("cube();", "cube(size = [1, 1, 1]);\n");
  gives("cube(2);", "cube(size = [2, 2, 2]);\n");
  gives("cube([1, 2.5, 3]);", "cube(size = [1, 2.5, 3]);\n");
  gives("cube(center = true, size = 4);", "cube(size = [4, 4, 4], center = true);\n");
  gives("cube([1, 2, 3], true);", "cube(size = [1, 2, 3], center = true);\n");
  gives("cube(size = 2, 3);", "cube(size = [3, 3, 3]);\n"); /* OpenSCAD: positions do not count named ones */
  gives("wedge([1, 2, 3], center = true);", "wedge(size = [1, 2, 3], center = true);\n");
}

static void sphere(void **state) {
  (void)state;
  gives("sphere();", "sphere(r = 1);\n");
  gives("sphere(2);", "sphere(r = 2);\n");
  gives("sphere(d = 3);", "sphere(r = 1.5);\n");
  gives("sphere(2, base = [1, 2, 3]);", "sphere(r = 2, base = [1, 2, 3], axis = [0, 0, 1]);\n");
  gives("ellipsoid([1, 2, 3]);", "ellipsoid(r = [1, 2, 3]);\n");
  gives("ellipsoid(r = 2, axis = [1, 1, 0]);", "ellipsoid(r = [2, 2, 2], base = [0, 0, 0], axis = [1, 1, 0]);\n");
}

static void cylinder(void **state) {
  (void)state;
  gives("cylinder();", "cylinder(h = 1, r1 = 1, r2 = 1, $fn = 0);\n");
  gives("cylinder(5, 2);", "cylinder(h = 5, r1 = 2, r2 = 1, $fn = 0);\n"); /* OpenSCAD: the second position is r1 */
  gives("cylinder(5, 2, 3, true);", "cylinder(h = 5, r1 = 2, r2 = 3, center = true, $fn = 0);\n");
  gives("cylinder(h = 5, r = 2);", "cylinder(h = 5, r1 = 2, r2 = 2, $fn = 0);\n");
  gives("cylinder(h = 5, d = 2);", "cylinder(h = 5, r1 = 1, r2 = 1, $fn = 0);\n");
  gives("cylinder(h = 5, d1 = 2, d2 = 0);", "cylinder(h = 5, r1 = 1, r2 = 0, $fn = 0);\n");
  gives("cylinder(h = 5, d1 = 2, r2 = 3);", "cylinder(h = 5, r1 = 1, r2 = 3, $fn = 0);\n");
  gives("cylinder(h = 5, r = [3, 2]);", "cylinder(h = 5, r1 = [3, 2], r2 = [3, 2], $fn = 0);\n");
  gives("cylinder(h = 5, r1 = [3, 2], r2 = [1.5, 1]);", "cylinder(h = 5, r1 = [3, 2], r2 = [1.5, 1], $fn = 0);\n");
  gives("cylinder(h = 5, d1 = [3, 2], r2 = 0);", "cylinder(h = 5, r1 = [1.5, 1], r2 = 0, $fn = 0);\n");
  gives("cylinder(base = [4, 3, -4], axis = [1, 0, 0], r = 2, h = 5);",
        "cylinder(h = 5, r1 = 2, r2 = 2, $fn = 0, base = [4, 3, -4], axis = [1, 0, 0]);\n");
  gives("cone(5, 2);", "cylinder(h = 5, r1 = 2, r2 = 0, $fn = 0);\n");
  gives("cone(h = 5, d = 2, center = true, base = [1, 1, 1]);",
        "cylinder(h = 5, r1 = 1, r2 = 0, center = true, $fn = 0, base = [1, 1, 1], axis = [0, 0, 1]);\n");
}

static void facets(void **state) {
  (void)state;
  gives("cylinder(h = 1, r = 2, $fn = 6);", "cylinder(h = 1, r1 = 2, r2 = 2, $fn = 6);\n");
  gives("$fn = 6; group() cylinder(h = 1, r = 2);", "union() {\n  cylinder(h = 1, r1 = 2, r2 = 2, $fn = 6);\n}\n");
  gives("translate([0, 0, 1], $fn = 5) cylinder(h = 1, r = 2);", "translate([0, 0, 1]) {\n  cylinder(h = 1, r1 = 2, r2 = 2, $fn = 5);\n}\n");
  gives("cylinder(h = 1, r = 2, $fn = 1);", "cylinder(h = 1, r1 = 2, r2 = 2, $fn = 3);\n"); /* OpenSCAD: at least 3 */
  gives("cylinder(h = 1, r = 2, $fn = 12.9);", "cylinder(h = 1, r1 = 2, r2 = 2, $fn = 12);\n");
  gives("cylinder(h = 1, r = 2, $fn = 13);", "cylinder(h = 1, r1 = 2, r2 = 2, $fn = 0);\n");
  gives("cylinder(h = 1, r = 2, $fn = 1/0);", "cylinder(h = 1, r1 = 2, r2 = 2, $fn = 0);\n");
  gives("sphere(1, $fn = 6);", "sphere(r = 1);\n");
  gives("cylinder(h = 1, r = [2, 1], $fn = 6);", "cylinder(h = 1, r1 = [2, 1], r2 = [2, 1], $fn = 0);\n");
  gives("cylinder(h = 1, r1 = 2, r2 = 0, center = true, $fn = 4, axis = [0, 1, 0]);",
        "cylinder(h = 1, r1 = 2, r2 = 0, center = true, $fn = 4, base = [0, 0, 0], axis = [0, 1, 0]);\n");
  quoin_read_options o = quoin_read_options_default();
  o.facets = QUOIN_FACETS_HONOUR;
  gives_with("cylinder(h = 1, r = 2, $fn = 64);", "cylinder(h = 1, r1 = 2, r2 = 2, $fn = 64);\n", &o);
  o.facets = QUOIN_FACETS_IGNORE;
  gives_with("cylinder(h = 1, r = 2, $fn = 6);", "cylinder(h = 1, r1 = 2, r2 = 2, $fn = 0);\n", &o);
  says("$fn = 100; cylinder(1); sphere(1); cylinder(2);", "Q0505", 1); /* once a file */
  says("cylinder(h = 1, $fn = 0, $fa = 12, $fs = 2); sphere($fn = 0);", "", 0);
}

static void other_solids(void **state) {
  (void)state;
  gives("paraboloid(2, 3);", "paraboloid(h = 2, r = 3);\n");
  gives("paraboloid(h = 2, r = [3, 4], center = true);", "paraboloid(h = 2, r = [3, 4], center = true);\n");
  gives("paraboloid(base = [0, 0, 5], axis = [0, 0, -1], r = 9, h = 6);", "paraboloid(h = 6, r = 9, base = [0, 0, 5], axis = [0, 0, -1]);\n");
  gives("hyperboloid(2, 3, 1);", "hyperboloid(h = 2, r = 3, rc = 1);\n");
  gives("hyperboloid(2, 3, gap = 0.5, base = [1, 0, 0]);", "hyperboloid(h = 2, r = 3, gap = 0.5, base = [1, 0, 0], axis = [0, 0, 1]);\n");
  gives("saddle(2, 3);", "saddle(a = 2, b = 3);\n");
  gives("quadric([1, 2, 3, 4, 5, 6, 7, 8, 9, -10]);", "quadric([1, 2, 3, 4, 5, 6, 7, 8, 9, -10]);\n");
  /* x^2 + 2 y^2 + 3 z^2 + 2(4 xy + 5 xz + 6 yz + 7 x + 8 y + 9 z) + 10 */
  gives("quadric(matrix = [[1, 4, 5, 7], [4, 2, 6, 8], [5, 6, 3, 9], [7, 8, 9, 10]]);", "quadric([1, 2, 3, 8, 10, 12, 14, 16, 18, 10]);\n");
  gives("halfspace([1, 2, 3], 4);", "halfspace(n = [1, 2, 3], d = 4);\n");
  gives("superquadric([1, 2, 3], 0.5, 0.25);", "superquadric(r = [1, 2, 3], e = 0.5, n = 0.25);\n");
  gives("superquadric();", "superquadric(r = [1, 1, 1], e = 1, n = 1);\n");
}

static void transforms(void **state) {
  (void)state;
  gives("translate([1, 2]) cube();", "translate([1, 2, 0]) {\n  cube(size = [1, 1, 1]);\n}\n");
  gives("translate(v = [1, 2, 3]) { }", "translate([1, 2, 3]);\n");
  gives("rotate(45) { sphere(); cube(); }", "rotate([0, 0, 45]) {\n  sphere(r = 1);\n  cube(size = [1, 1, 1]);\n}\n");
  gives("rotate([10, 20]);", "rotate([10, 20, 0]);\n");
  gives("rotate(a = 120, v = [1, 1, 1]);", "rotate(a = 120, v = [1, 1, 1]);\n");
  gives("rotate(a = 120, v = [0, 0, 0]);", "union();\n"); /* OpenSCAD turns nothing */
  gives("scale(2);", "scale([2, 2, 2]);\n");
  gives("scale([1, 2]);", "scale([1, 2, 1]);\n");
  gives("mirror([1, 1]);", "mirror([1, 1, 0]);\n");
  gives("mirror([0, 0, 0]);", "union();\n");
  gives("multmatrix([[1, 0, 0, 5]]);", "multmatrix([[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0]]);\n");
  gives("multmatrix(m = [[2, 0, 0, 4], [0, 2, 0, 6], [0, 0, 2, 8], [0, 0, 0, 2]]);", "multmatrix([[1, 0, 0, 2], [0, 1, 0, 3], [0, 0, 1, 4]]);\n");
  gives("multmatrix([[0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 3]]);",
        "multmatrix([[0, 0, (1/3), 0], [(1/3), 0, 0, 0], [0, (1/3), 0, 0]]);\n");
}

/* What is empty keeps its place as an operand. */
static void empty(void **state) {
  (void)state;
  gives("difference() { cube(0); cube(1); }", "difference() {\n  union();\n  cube(size = [1, 1, 1]);\n}\n");
  gives("scale([1, 0, 1]) cube(1);", "intersection() {\n  union();\n  cube(size = [1, 1, 1]);\n}\n");
  gives("translate([1 / 0, 0, 0]) cube(1);", "intersection() {\n  union();\n  cube(size = [1, 1, 1]);\n}\n");
  gives("multmatrix([[1, 2], [2, 4]]) cube(1);", "intersection() {\n  union();\n  cube(size = [1, 1, 1]);\n}\n");
  gives("intersection() { group() {} cube(1); }", "intersection() {\n  union();\n  cube(size = [1, 1, 1]);\n}\n");
  gives("difference();", "difference();\n");
  says("cube(0); cylinder(h = -1);", "Q0501", 2);
  says("cube([1/0, -1, 0]); sphere(r = 0/0);", "Q0502", 2);
}

static void groups(void **state) {
  (void)state;
  gives("group() render(convexity = 4) union() cube();", "union() {\n  union() {\n    union() {\n      cube(size = [1, 1, 1]);\n    }\n  }\n}\n");
  gives("difference() { cube(2); sphere(1); }", "difference() {\n  cube(size = [2, 2, 2]);\n  sphere(r = 1);\n}\n");
  gives("%cube(1); #sphere(2); *cube(3); %#cube(4);", "%cube(size = [1, 1, 1]);\n#sphere(r = 2);\n%#cube(size = [4, 4, 4]);\n");
  gives("translate([1, 2, 3]) !cube(1); cube(2);", "translate([1, 2, 3]) {\n  !cube(size = [1, 1, 1]);\n}\ncube(size = [2, 2, 2]);\n");
  gives("name(\"a \\\"b\\\" \\\\ \\n\\x7f\xC3\xA9\") cube(1);", "name(\"a \\\"b\\\" \\\\ \\n\\x7f\xC3\xA9\") {\n  cube(size = [1, 1, 1]);\n}\n");
  gives("name(\"\") name(\"\");", "name(\"\") {\n  name(\"\");\n}\n");
  gives("echo(1); assert(true) cube(1);", "union() {\n  cube(size = [1, 1, 1]);\n}\n");
}

static void looks(void **state) {
  (void)state;
  gives("color(\"red\");", "color([1, 0, 0, 1]);\n");
  gives("color(\"Red\", 0.5);", "color([1, 0, 0, 0.5]);\n");
  gives("color([0.1, 0.2, 0.3], alpha = 0.4);", "color([0.1, 0.2, 0.3, 0.4]);\n");
  gives("color([0.1, 2, 0.3, 0.9]);", "color([0.1, 2, 0.3, 0.9]);\n"); /* values over 1 are kept */
  gives("color(\"#ff0000\");", "color([1, 0, 0, 1]);\n");
  gives("color(\"#0f0\");", "color([0, 1, 0, 1]);\n");
  gives("color(\"#00F0\");", "color([0, 0, 1, 0]);\n");
  gives("color([-1, -1, -1, 1]) cube(1);", "union() {\n  cube(size = [1, 1, 1]);\n}\n");
  gives("material(color = \"blue\", ambient = 0.1, diffuse = 0.2, specular = 0.3, shininess = 20);",
        "material(color = [0, 0, 1, 1], ambient = 0.1, diffuse = 0.2, specular = 0.3, shininess = 20);\n");
  gives("material(specular = 1/3);", "material(specular = 0.3333333333333333);\n");
  gives("material(\"lime\");", "color([0, 1, 0, 1]);\n");
  gives("camera([1, 2, 3], [0, 0, 1], up = [0, 1, 0], fov = 45, near = 0.5, projection = \"ortho\");",
        "camera(eye = [1, 2, 3], look = [0, 0, 1], up = [0, 1, 0], fov = 45, near = 0.5, projection = \"ortho\");\n");
  gives("camera(eye = [1, 2, 3], projection = \"perspective\");", "camera(eye = [1, 2, 3], projection = \"persp\");\n");
  gives("light(at = [1, 2, 3]); light(direction = [0, 0, -1], color = [1, 0.5, 0]);",
        "light(at = [1, 2, 3], color = [1, 1, 1]);\nlight(direction = [0, 0, -1], color = [1, 0.5, 0]);\n");
  gives("background(\"white\");", "background([1, 1, 1]);\n");
}

/* The first and the last row of the table of colours, and one between. */
static void colours(void **state) {
  (void)state;
  gives("color(\"aliceblue\");", "color([0.9411764705882353, 0.9725490196078431, 1, 1]);\n"); /* f0f8ff */
  gives("color(\"yellowgreen\");", "color([0.6039215686274509, 0.803921568627451, 0.19607843137254902, 1]);\n"); /* 9acd32 */
  gives("color(\"rebeccapurple\");", "color([0.4, 0.2, 0.6, 1]);\n"); /* 663399 */
  gives("color(\"Transparent\");", "color([0, 0, 0, 0]);\n");
}

#define TETRAHEDRON "points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]"

static void polyhedron(void **state) {
  (void)state;
  static const char canonical[] = "polyhedron(" TETRAHEDRON ", faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]);\n";
  gives(canonical, canonical);
  gives("polyhedron(" TETRAHEDRON ", triangles = [[1, 2, 0], [0, 3, 1], [2, 3, 0], [3, 2, 1]], convexity = 3);", canonical);
  gives("polyhedron(" TETRAHEDRON ", faces = [[2, 1, 0], [1, 3, 0], [3, 2, 0], [2, 3, 1]]);", canonical); /* inside out */
  /* Facets in pieces, a point in the middle of one, points twice: the same cube. */
  gives("polyhedron(points = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2], [0, 2, 2], [1, 1, 2], [2, 2, 2], [9, 9, 9]],"
        " faces = [[0, 1, 2, 3], [4, 7, 8], [7, 6, 8], [9, 5, 8], [5, 4, 8], [4, 5, 1, 0], [5, 6, 2], [5, 2, 1], [6, 7, 3, 2], [7, 4, 0, 3]]);",
        "polyhedron(points = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2], [0, 2, 2]],"
        " faces = [[0, 1, 2, 3], [4, 7, 6, 5], [0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [0, 3, 7, 4]]);\n");
  /* Corners that are rounded numbers. */
  static const char rounded[] = "s = sqrt(2); polyhedron(points = [[s, 0, -1], [0, s, -1], [-s, 0, -1], [0, -s, -1], [0, 0, s]],"
                                " faces = [[3, 2, 1, 0], [0, 4, 3], [1, 4, 0], [2, 4, 1], [3, 4, 2]]);";
  quoin_model *m = tree_read(rounded, sizeof rounded - 1);
  tree_round(m);
  quoin_model_free(m);
}

/* The numbers that shape/ is given: planes outward, n.x <= d. */
static void polyhedron_numbers(void **state) {
  (void)state;
  static const char text[] = "polyhedron(points = [[0, 0, 0], [2, 0, 0], [0, 4, 0], [0, 0, 8]], faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]);";
  quoin_model *m = tree_read(text, sizeof text - 1);
  static const double want[] = {4, 4, 0, 0, -1, 0, 0, -1, 0, 0, -1, 0, 0, 0, 1, 0.5, 0.25, 2, 0, 0, 0, 2, 0, 0, 0, 4, 0, 0, 0, 8};
  const qn_node *n = &m->nodes[1];
  assert_int_equal(n->numbers, sizeof want / sizeof want[0]);
  for (size_t i = 0; i < n->numbers; i++) {
    assert_true(qn_num_to_double(m->numbers[n->number0 + i]) == want[i]);
  }
  quoin_model_free(m);
}

/* Lists of words in OpenSCAD's dumps, with its modifiers before the blanks, its exponents and its signs. */
static void dump(void **state) {
  (void)state;
  gives("group() {\n\tmultmatrix([[1, 0, 0, -1e-07], [0, 1, 0, 1e+06], [0, 0, 1, -0], [0, 0, 0, 1]]) {\n"
        "%\t\tsphere($fn = 0, $fa = 12, $fs = 2, r = +3);\n#%\t\tcube(size = [.5, 5., 1], center = false);\n\t}\n}\n",
        "union() {\n  multmatrix([[1, 0, 0, -1e-07], [0, 1, 0, 1000000], [0, 0, 1, 0]]) {\n    %sphere(r = 3);\n    %#cube(size = [0.5, 5, 1]);\n  }\n}\n");
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(cube),   cmocka_unit_test(sphere),     cmocka_unit_test(cylinder),           cmocka_unit_test(facets),
    cmocka_unit_test(empty),  cmocka_unit_test(transforms), cmocka_unit_test(other_solids),       cmocka_unit_test(groups),
    cmocka_unit_test(looks),  cmocka_unit_test(colours),    cmocka_unit_test(polyhedron),         cmocka_unit_test(polyhedron_numbers),
    cmocka_unit_test(dump),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
