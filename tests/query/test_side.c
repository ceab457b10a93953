/* Points on surfaces (design S5, S6), through the public interface; answers worked out by hand. Each model is also asked turned by
   angles that only S2 knows (irrational maps), about its point. */
#include "ask.h"

static void walls(void **state) {
  (void)state;
  expect_sides("cube([0.3, 1, 1]); translate([0.1 + 0.2, 0, 0]) cube([0.7, 1, 1]);", "0.3 0.5 0.5", 'i', "0.3 0 0.5", 'b', "0.3 0 0", 'b',
               "0.3 1.1 0.5", 'o', NULL);
  /* two, three, four and eight boxes about a corner */
  expect_sides("cube(1); translate([-1, -1, 0]) cube(1);", "0 0 0.5", 'b', "0 0 0", 'b', NULL);
  expect_sides("cube(1); translate([-1, -1, 0]) cube(1); translate([-1, 0, 0]) cube(1);", "0 0 0.5", 'b', "0 0.5 0.5", 'i', NULL);
  expect_sides("translate([-1,-1,0]) cube([2,1,1]); cube(1); translate([-1,0,0]) cube(1);", "0 0 0.5", 'i', "0 0 0", 'b', "0 0 1", 'b', NULL);
  expect_sides("cube(1); translate([-1,0,0]) cube(1); translate([0,-1,0]) cube(1); translate([-1,-1,0]) cube(1);"
               "translate([0,0,-1]) cube(1); translate([-1,0,-1]) cube(1); translate([0,-1,-1]) cube(1); translate([-1,-1,-1]) cube(1);",
               "0 0 0", 'i', "0 0 1", 'b', "0 0 0.5", 'i', "0 0.5 0", 'i', NULL);
  expect_sides("cube(1); translate([-1,0,0]) cube(1); translate([0,-1,0]) cube(1); translate([-1,-1,0]) cube(1);"
               "translate([0,0,-1]) cube(1); translate([-1,0,-1]) cube(1); translate([0,-1,-1]) cube(1);",
               "0 0 0", 'b', NULL);
  /* a cut flush with a face */
  expect_sides("difference() { cube(1); translate([0.25, 0.25, 0]) cube([0.5, 0.5, 1]); }", "0.5 0.5 1", 'o', "0.25 0.5 1", 'b', "0.125 0.5 1", 'b',
               "0.5 0.5 0.5", 'o', NULL);
  expect_sides("difference() { cube(1); cube(1); }", "0 0 0", 'o', "0.5 0.5 0.5", 'o', "1 0.5 0.5", 'o', NULL);
  expect_sides("intersection() { cube(1); translate([1, 0, 0]) cube(1); }", "1 0.5 0.5", 'o', "1 0 0", 'o', NULL);
}

static void hexagon(void **state) {
  (void)state;
  /* six wedges about the z axis: half-spaces through one line */
  expect_sides("intersection() { union() {"
               "intersection() { halfspace(n=[-1,0,0], d=0); halfspace(n=[0,-1,0], d=0); }"
               "intersection() { halfspace(n=[1,0,0], d=0); halfspace(n=[-1,-1,0], d=0); }"
               "intersection() { halfspace(n=[1,1,0], d=0); halfspace(n=[0,-1,0], d=0); }"
               "intersection() { halfspace(n=[1,0,0], d=0); halfspace(n=[0,1,0], d=0); }"
               "intersection() { halfspace(n=[-1,0,0], d=0); halfspace(n=[1,1,0], d=0); }"
               "intersection() { halfspace(n=[-1,-1,0], d=0); halfspace(n=[0,1,0], d=0); } } cube(2, center = true); }",
               "0 0 0", 'i', "0 0 1", 'b', "0 0 0.5", 'i', "0.5 0 0", 'i', "0.5 -0.5 0.3", 'i', NULL);
  expect_sides("intersection() { union() {"
               "intersection() { halfspace(n=[-1,0,0], d=0); halfspace(n=[0,-1,0], d=0); }"
               "intersection() { halfspace(n=[1,0,0], d=0); halfspace(n=[-1,-1,0], d=0); }"
               "intersection() { halfspace(n=[1,1,0], d=0); halfspace(n=[0,-1,0], d=0); }"
               "intersection() { halfspace(n=[1,0,0], d=0); halfspace(n=[0,1,0], d=0); }"
               "intersection() { halfspace(n=[-1,0,0], d=0); halfspace(n=[1,1,0], d=0); } } cube(2, center = true); }",
               "0 0 0", 'b', NULL);
}

static void touching_spheres(void **state) {
  (void)state;
  expect_sides("sphere(1); translate([2, 0, 0]) sphere(1);", "1 0 0", 'b', NULL);
  expect_sides("intersection() { sphere(1); translate([2, 0, 0]) sphere(1); }", "1 0 0", 'o', NULL);
  expect_sides("difference() { sphere(1); translate([2, 0, 0]) sphere(1); }", "1 0 0", 'b', NULL);
  /* from inside */
  expect_sides("translate([2, 0, 0]) sphere(2); translate([1, 0, 0]) sphere(1);", "0 0 0", 'b', "1 0 0", 'i', "2 0 0", 'i', NULL);
  expect_sides("difference() { translate([2, 0, 0]) sphere(2); translate([1, 0, 0]) sphere(1); }", "0 0 0", 'b', "2 0 0", 'b', "1 0 0", 'o', NULL);
  expect_sides("difference() { translate([1, 0, 0]) sphere(1); translate([2, 0, 0]) sphere(2); }", "0 0 0", 'o', NULL);
  expect_sides("intersection() { translate([2, 0, 0]) sphere(2); translate([1, 0, 0]) sphere(1); }", "0 0 0", 'b', "2 0 0", 'b', NULL);
}

static void tangent_planes(void **state) {
  (void)state;
  /* sphere on z = 0 */
  expect_sides("translate([0,0,1]) sphere(1); halfspace(n=[0,0,1], d=0);", "0 0 0", 'b', NULL);
  expect_sides("intersection() { translate([0,0,1]) sphere(1); halfspace(n=[0,0,1], d=0); }", "0 0 0", 'o', NULL);
  expect_sides("intersection() { translate([0,0,1]) sphere(1); halfspace(n=[0,0,-1], d=0); }", "0 0 0", 'b', "0 0 1", 'i', NULL);
  expect_sides("difference() { translate([0,0,1]) sphere(1); halfspace(n=[0,0,-1], d=0); }", "0 0 0", 'o', NULL);
  expect_sides("difference() { translate([0,0,1]) sphere(1); halfspace(n=[0,0,1], d=0); }", "0 0 0", 'b', NULL);
  expect_sides("difference() { halfspace(n=[0,0,1], d=0); translate([0,0,1]) sphere(1); }", "0 0 0", 'b', NULL);
  expect_sides("difference() { halfspace(n=[0,0,-1], d=0); translate([0,0,1]) sphere(1); }", "0 0 0", 'b', NULL);
  /* all of space by halves: a wall that the sphere touches */
  expect_sides("halfspace(n=[0,0,-1], d=0); halfspace(n=[0,0,1], d=0); translate([0,0,1]) sphere(1);", "0 0 0", 'i', NULL);
  /* a cylinder along a generator */
  expect_sides("translate([0,1,0]) cylinder(r=1, h=4, center=true); halfspace(n=[0,1,0], d=0);", "0 0 0", 'b', "0 0 2", 'b', NULL);
  expect_sides("intersection() { translate([0,1,0]) cylinder(r=1, h=4, center=true); halfspace(n=[0,1,0], d=0); }", "0 0 0", 'o', "0 0 2", 'o', NULL);
  expect_sides("difference() { translate([-2,0,-2]) cube(4); translate([0,1,0]) cylinder(r=1, h=4, center=true); }", "0 0 0", 'b', "0 0 2", 'b', NULL);
}

static void rounded_box(void **state) {
  (void)state;
  /* [-3,3]^3 rounded by 1: slabs, edges, corners; everything touches everything */
  const char text[] =
    "cube([6,4,4], center=true); cube([4,6,4], center=true); cube([4,4,6], center=true);"
    "translate([2,2,0]) cylinder(r=1,h=4,center=true); translate([-2,2,0]) cylinder(r=1,h=4,center=true);"
    "translate([2,-2,0]) cylinder(r=1,h=4,center=true); translate([-2,-2,0]) cylinder(r=1,h=4,center=true);"
    "rotate([90,0,0]) { translate([2,2,0]) cylinder(r=1,h=4,center=true); translate([-2,2,0]) cylinder(r=1,h=4,center=true);"
    "translate([2,-2,0]) cylinder(r=1,h=4,center=true); translate([-2,-2,0]) cylinder(r=1,h=4,center=true); }"
    "rotate([0,90,0]) { translate([2,2,0]) cylinder(r=1,h=4,center=true); translate([-2,2,0]) cylinder(r=1,h=4,center=true);"
    "translate([2,-2,0]) cylinder(r=1,h=4,center=true); translate([-2,-2,0]) cylinder(r=1,h=4,center=true); }"
    "translate([2,2,2]) sphere(1); translate([2,2,-2]) sphere(1); translate([2,-2,2]) sphere(1); translate([2,-2,-2]) sphere(1);"
    "translate([-2,2,2]) sphere(1); translate([-2,2,-2]) sphere(1); translate([-2,-2,2]) sphere(1); translate([-2,-2,-2]) sphere(1);";
  expect_sides(text, "3 2 0", 'b', "3 2 2", 'b', "2 3 2", 'b', "2 2 3", 'b', "2.6 2.8 0", 'b', "2.6 2.8 2", 'b', "2 2 2", 'i', "2 2 0", 'i',
               "2 2 1", 'i', "2 1 2", 'i', "3 0 0", 'b', "3 1 2", 'b', "2.5 2 2", 'i', "2 2.5 2", 'i', "2.5 2 0", 'i', "2.6 2 2.8", 'b', "3 3 0", 'o',
               "2.9 2 2", 'i', NULL);
}

static void apexes(void **state) {
  (void)state;
  expect_sides("cone(h=1, r=1);", "0 0 1", 'b', "0 0 1.5", 'o', "0 0 0", 'b', "0 0 0.5", 'i', "0.5 0 0.5", 'b', NULL);
  expect_sides("cylinder(h=5, r1=0, r2=5);", "0 0 0", 'b', "0 0 -1", 'o', "3 4 5", 'b', "0 0 -0.001", 'o', NULL);
  /* two cones, apex to apex: a double cone */
  expect_sides("cylinder(h=5, r1=0, r2=5); mirror([0,0,1]) cylinder(h=5, r1=0, r2=5);", "0 0 0", 'b', NULL);
  /* a box minus its cone; and filled again */
  expect_sides("difference() { cube(4, center=true); cylinder(h=1, r1=0, r2=1); }", "0 0 0", 'b', NULL);
  expect_sides("difference() { cube(4, center=true); cylinder(h=1, r1=0, r2=1); } cylinder(h=1, r1=0, r2=1);", "0 0 0", 'i', "0.5 0 0.5", 'i',
               "0 0 1", 'i', "1 0 1", 'i', NULL);
  expect_sides("quadric([1,1,-1,0,0,0,0,0,0,0]);", "0 0 0", 'b', "0 0 1", 'i', "0 0 -1", 'i', "1 0 0", 'o', NULL);
  /* a cone stands on its apex on a plane */
  expect_sides("cylinder(h=1, r1=0, r2=1); halfspace(n=[0,0,1], d=0);", "0 0 0", 'b', NULL);
  expect_sides("intersection() { cylinder(h=1, r1=0, r2=1); halfspace(n=[0,0,1], d=0); }", "0 0 0", 'o', NULL);
}

static void crossings(void **state) {
  (void)state;
  expect_sides("intersection() { rotate([90,0,0]) cylinder(r=1,h=4,center=true); rotate([0,90,0]) cylinder(r=1,h=4,center=true); }", "0 0 1", 'b',
               "0 0 0", 'i', "1 1 0", 'b', NULL);
  expect_sides("rotate([90,0,0]) cylinder(r=1,h=4,center=true); rotate([0,90,0]) cylinder(r=1,h=4,center=true);", "0 0 1", 'b', NULL);
  expect_sides("difference() { rotate([90,0,0]) cylinder(r=1,h=4,center=true); rotate([0,90,0]) cylinder(r=1,h=4,center=true); }", "0 0 1", 'b', NULL);
  /* a sphere that touches a box's edge in its middle: only along the edge is there anything left */
  expect_sides("difference() { translate([-2,-2,-2]) cube([2,2,4]); translate([-0.5,-0.5,0]) quadric([2,2,2,0,0,0,0,0,0,-1]); }", "0 0 0", 'b', "0 0 1", 'b',
               "-0.5 -0.5 0", 'o', NULL);
}

/* The same contacts in frames that only S2 can hold: turned by 20 degrees about a slanted axis; the origin stays. */
static void turned(void **state) {
  (void)state;
  static const struct { const char *text; char side; } at_origin[] = {
    {"translate([-1,0,0]) sphere(1); translate([1,0,0]) sphere(1);", 'b'},
    {"intersection() { translate([-1,0,0]) sphere(1); translate([1,0,0]) sphere(1); }", 'o'},
    {"difference() { translate([1,0,0]) sphere(1); translate([2,0,0]) sphere(2); }", 'o'},
    {"difference() { translate([2,0,0]) sphere(2); translate([1,0,0]) sphere(1); }", 'b'},
    {"translate([0,-1,-1]) cube(2); translate([-2,-1,-1]) cube(2);", 'i'},
    {"intersection() { translate([0,-1,-1]) cube(2); translate([-2,-1,-1]) cube(2); }", 'o'},
    {"intersection() { translate([0,0,1]) sphere(1); translate([-1,-1,-2]) cube(2); }", 'o'},
    {"translate([0,0,1]) sphere(1); translate([-1,-1,-2]) cube(2);", 'b'},
    {"translate([0,0,1]) sphere(1); translate([-1,-1,-2]) cube(2); translate([-1,-1,0]) cube(2);", 'i'},
    {"intersection() { translate([0,1,0]) cylinder(r=1,h=4,center=true); translate([-1,-2,-1]) cube(2); }", 'o'},
    {"cylinder(h=1,r1=0,r2=1);", 'b'},
    {"difference() { cube(4, center=true); cylinder(h=1, r1=0, r2=1); } cylinder(h=1, r1=0, r2=1);", 'i'},
    {"intersection() { cylinder(h=1,r1=0,r2=1); translate([-1,-1,-2]) cube(2); }", 'o'},
    {"difference() { translate([-1,-1,-1]) cube(2); translate([-1,-1,-1]) cube(2); }", 'o'},
    {"intersection() { translate([0,0,-1]) rotate([90,0,0]) cylinder(r=1,h=4,center=true); translate([0,0,-1]) rotate([0,90,0]) cylinder(r=1,h=4,center=true); }", 'b'},
    {"cube(1); translate([-1,0,0]) cube(1); translate([0,-1,0]) cube(1); translate([-1,-1,0]) cube(1);"
     "translate([0,0,-1]) cube(1); translate([-1,0,-1]) cube(1); translate([0,-1,-1]) cube(1); translate([-1,-1,-1]) cube(1);", 'i'},
  };
  for (size_t i = 0; i < sizeof at_origin / sizeof *at_origin; i++) {
    char text[1200];
    snprintf(text, sizeof text, "%s", at_origin[i].text);
    expect_sides(text, "0 0 0", at_origin[i].side, NULL);
    snprintf(text, sizeof text, "rotate(20, [1,2,3]) { %s }", at_origin[i].text);
    expect_sides(text, "0 0 0", at_origin[i].side, NULL);
    snprintf(text, sizeof text, "translate([0.1,0.2,0.3]) rotate([10,20,30]) { %s }", at_origin[i].text);
    expect_sides(text, "0.1 0.2 0.3", at_origin[i].side, NULL);
  }
}

static void doubles_and_decimals(void **state) {
  (void)state;
  ask a;
  ask_open(&a, "cube([0.3, 1, 1]);");
  quoin_side side;
  assert_int_equal(ask_side(&a, "0.3 0.5 0.5"), 'b');
  assert_int_equal(ask_side(&a, "0.30000000000000000000000000001 0.5 0.5"), 'o');
  assert_int_equal(ask_side(&a, "0.29999999999999999999999999999 0.5 0.5"), 'i');
  assert_int_equal(quoin_point_side(a.scene, a.work, (double[]){0.3, 0.5, 0.5}, &side), QUOIN_OK);
  assert_int_equal(side, QUOIN_INSIDE); /* the double 0.3 is below 3/10 */
  assert_int_equal(quoin_point_side(a.scene, a.work, (double[]){0.1 + 0.2, 0.5, 0.5}, &side), QUOIN_OK);
  assert_int_equal(side, QUOIN_OUTSIDE);
  assert_int_equal(ask_side(&a, "1e-400 0.5 0.5"), 'i');
  assert_int_equal(ask_side(&a, "-1e-400 0.5 0.5"), 'o');
  assert_int_equal(ask_side(&a, "1e400 0.5 0.5"), 'o');
  assert_int_equal(quoin_point_side(a.scene, a.work, (double[]){0x1p-1074, 0.5, 0.5}, &side), QUOIN_OK);
  assert_int_equal(side, QUOIN_INSIDE);
  assert_int_equal(quoin_point_side(a.scene, a.work, (double[]){-0x1p-1074, 0.5, 0.5}, &side), QUOIN_OK);
  assert_int_equal(side, QUOIN_OUTSIDE);
  assert_int_equal(quoin_point_side(a.scene, a.work, (double[]){0x1p+1023, 0.5, 0.5}, &side), QUOIN_OK);
  assert_int_equal(side, QUOIN_OUTSIDE);
  ask_close(&a);
}

static void superquadrics(void **state) {
  (void)state;
  expect_sides("superquadric(r=[1,2,3], e=1, n=1);", "0 0 0", 'i', "1 0 0", 'b', "0 2 0", 'b', "0 0 3", 'b', "0.6 1.6 0", 'b', "1.01 0 0", 'o', NULL);
  expect_sides("superquadric(r=[1,1,1], e=0.5, n=0.5); translate([1,0,0]) cube(1, center = true);", "1 0 0", 'i', "0 0 0.5", 'i', "0 0 1", 'b', NULL);
}

static void parts(void **state) {
  (void)state;
  ask a;
  ask_open(&a, "difference() { name(\"plate\") cube([4,4,1]); name(\"hole\") translate([2,2,0]) cylinder(r=1, h=1); }");
  quoin_part found[4];
  size_t count = 0;
  assert_int_equal(quoin_point_parts(a.scene, a.work, (double[]){2, 2, 0.5}, found, 4, &count), QUOIN_OK);
  assert_int_equal(count, 2);
  assert_string_equal(quoin_part_name(a.scene, found[0]), "plate");
  assert_string_equal(quoin_part_name(a.scene, found[1]), "hole");
  assert_int_equal(quoin_point_parts_text(a.scene, a.work, (const char *[]){"3", "2", "1"}, found, 1, &count), QUOIN_OK);
  assert_int_equal(count, 2); /* on the hole's rim: closed solids */
  assert_string_equal(quoin_part_name(a.scene, found[0]), "plate");
  assert_int_equal(quoin_point_parts(a.scene, a.work, (double[]){0.5, 0.5, 0.5}, NULL, 0, &count), QUOIN_OK);
  assert_int_equal(count, 1);
  assert_int_equal(quoin_point_parts(a.scene, a.work, (double[]){9, 0, 0}, found, 4, &count), QUOIN_OK);
  assert_int_equal(count, 0);
  ask_close(&a);
}

static void arguments(void **state) {
  (void)state;
  ask a, b;
  ask_open(&a, "cube(1);");
  ask_open(&b, "sphere(1);");
  quoin_side side;
  size_t count;
  const double nan_point[3] = {0, strtod("nan", NULL), 0}, far[3] = {0, strtod("inf", NULL), 0}, good[3] = {0, 0, 0};
  assert_int_equal(quoin_point_side(a.scene, a.work, nan_point, &side), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_point_side(a.scene, a.work, far, &side), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_point_side(a.scene, b.work, good, &side), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_point_side(a.scene, NULL, good, &side), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_point_side(a.scene, a.work, good, NULL), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_point_sides(a.scene, a.work, 0, NULL, NULL), QUOIN_OK);
  assert_int_equal(quoin_point_parts(a.scene, a.work, good, NULL, 1, &count), QUOIN_E_ARGUMENT);
  static const char *const bad[] = {"", "x", "1x", "1 ", " 1", "nan", "inf", "--1", "1e", "0x1p3", "1,5"};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    assert_int_equal(quoin_point_side_text(a.scene, a.work, (const char *[]){"0", bad[i], "0"}, &side), QUOIN_E_NUMBER);
  }
  assert_int_equal(quoin_point_side_text(a.scene, a.work, (const char *[]){"0", NULL, "0"}, &side), QUOIN_E_ARGUMENT);
  ask_close(&a);
  ask_close(&b);
}

/* --- memory that is refused ---------------------------------------------------------------------------------------- */

typedef struct meter { int armed; size_t left, asked; } meter;
static void *meter_alloc(void *user, size_t size) {
  meter *m = user;
  m->asked++;
  if (m->armed && m->left-- == 0) {
    m->left = 0;
    return NULL;
  }
  return malloc(size);
}
static void *meter_resize(void *user, void *block, size_t old_size, size_t new_size) {
  meter *m = user;
  (void)old_size;
  m->asked++;
  if (m->armed && m->left-- == 0) {
    m->left = 0;
    return NULL;
  }
  return realloc(block, new_size);
}
static void meter_release(void *user, void *block, size_t size) {
  (void)user, (void)size;
  free(block);
}

/* Every allocation of a question refused in turn: a status, no crash, and the next question is answered. */
static void refusals(void **state) {
  (void)state;
  static const char text[] = "difference() { rotate(20,[1,2,3]) { translate([2,0,0]) sphere(2); translate([-1,-1,-1]) cube(1); cylinder(h=1,r1=0,r2=1);"
                             " superquadric(r=[1,1,1],e=0.5,n=0.5); } translate([1,0,0]) sphere(1); }";
  size_t refused = 0;
  for (size_t n = 0; n < 60; n++) {
    meter m = {0};
    const quoin_allocator allocator = {meter_alloc, meter_resize, meter_release, &m, 0};
    quoin_model *model;
    quoin_scene *scene;
    quoin_work *work = NULL;
    assert_int_equal(quoin_model_new(&allocator, &model), QUOIN_OK);
    assert_int_equal(quoin_model_read_text(model, QUOIN_ROOT, "test", text, sizeof text - 1, NULL), QUOIN_OK);
    assert_int_equal(quoin_scene_compile(model, NULL, &scene), QUOIN_OK);
    m.armed = 1, m.left = n;
    quoin_status status = quoin_work_new(scene, &work);
    quoin_side side;
    quoin_part part;
    size_t count;
    quoin_intervals got;
    quoin_hit hit;
    static const char *const at[3] = {"0", "0", "0.0"};
    static const char *const ray[6] = {"0.1", "0", "0", "0", "0.3", "0.4"};
    const quoin_ray first = {{-9, 0.1, 0.2}, {1, 0, 0}, 0, 99};
    for (int k = 0; k < 4 && status == QUOIN_OK; k++) {
      status = k == 0   ? quoin_point_side_text(scene, work, at, &side)
               : k == 1 ? quoin_point_parts_text(scene, work, at, &part, 1, &count)
               : k == 2 ? quoin_ray_intervals_text(scene, work, ray, "-1e-400", NULL, 3, &got)
                        : quoin_first_hit(scene, work, &first, &hit);
    }
    assert_true(status == QUOIN_OK || status == QUOIN_E_MEMORY);
    refused += status != QUOIN_OK;
    m.armed = 0;
    if (work) {
      assert_int_equal(quoin_point_side_text(scene, work, at, &side), QUOIN_OK);
      assert_int_equal(side, QUOIN_BOUNDARY);
      assert_int_equal(quoin_ray_intervals_text(scene, work, ray, "-1e-400", NULL, 3, &got), QUOIN_OK);
      assert_int_equal(quoin_first_hit(scene, work, &first, &hit), QUOIN_OK);
      assert_true(hit.found);
    }
    quoin_work_free(work);
    quoin_scene_free(scene);
    quoin_model_free(model);
  }
  print_message("questions refused: %zu\n", refused);
  assert_true(refused > 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(walls), cmocka_unit_test(hexagon), cmocka_unit_test(touching_spheres), cmocka_unit_test(tangent_planes),
    cmocka_unit_test(rounded_box), cmocka_unit_test(apexes), cmocka_unit_test(crossings), cmocka_unit_test(turned),
    cmocka_unit_test(doubles_and_decimals), cmocka_unit_test(superquadrics), cmocka_unit_test(parts), cmocka_unit_test(arguments), cmocka_unit_test(refusals),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
