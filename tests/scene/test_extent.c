/* Boxes of leaves along the axes are exact where numbers are rational, whatever the primitive: each is given by hand. Others hold the
   solid and are no more than some ulps wider. */
#include "reading.h"

#include <math.h>

static void expect(const char *text, double x0, double y0, double z0, double x1, double y1, double z1) {
  quoin_scene *s = scene_of(text);
  const double min[3] = {x0, y0, z0}, max[3] = {x1, y1, z1};
  for (int k = 0; k < 3; k++) {
    if (s->leaves[0].min[k] != min[k] || s->leaves[0].max[k] != max[k]) {
      print_error("%s: axis %d: [%.17g, %.17g] for [%.17g, %.17g]\n", text, k, s->leaves[0].min[k], s->leaves[0].max[k], min[k], max[k]);
    }
    assert_true(s->leaves[0].min[k] == min[k] && s->leaves[0].max[k] == max[k]);
  }
  quoin_scene_free(s);
}

static void round_solids(void **state) {
  (void)state;
  expect("sphere(2);", -2, -2, -2, 2, 2, 2);
  expect("ellipsoid([5, 3, 2]);", -5, -3, -2, 5, 3, 2);
  expect("cylinder(h = 7, r = 3);", -3, -3, 0, 3, 3, 7);
  expect("cylinder(h = 2, r = [5, 3], center = true);", -5, -3, -1, 5, 3, 1);
  expect("cylinder(h = 2, r1 = 4, r2 = 3);", -4, -4, 0, 4, 4, 2);
  expect("cylinder(h = 2, r1 = 1, r2 = 3, center = true);", -3, -3, -1, 3, 3, 1);
  expect("cylinder(h = 2, r1 = [4, 2], r2 = [2, 1]);", -4, -2, 0, 4, 2, 2);
  expect("cone(h = 10, r = 5);", -5, -5, 0, 5, 5, 10);
  expect("cylinder(h = 10, r1 = 0, r2 = 5);", -5, -5, 0, 5, 5, 10);
  expect("paraboloid(h = 4, r = 2);", -2, -2, 0, 2, 2, 4);
  expect("paraboloid(h = 4, r = [2, 1], center = true);", -2, -1, -2, 2, 1, 2);
  expect("hyperboloid(h = 2, r = 5, rc = 3);", -5, -5, -2, 5, 5, 2);
  expect("hyperboloid(h = 2, r = 4, rc = 0);", -4, -4, -2, 4, 4, 2);
  expect("hyperboloid(h = 2, r = 3, rc = 5);", -5, -5, -2, 5, 5, 2); /* a barrel */
  expect("hyperboloid(h = 5, r = 4, gap = 3);", -4, -4, -5, 4, 4, 5);
}

static void solids_of_planes(void **state) {
  (void)state;
  expect("cube([1, 2, 3]);", 0, 0, 0, 1, 2, 3);
  expect("wedge([4, 2, 6]);", 0, 0, 0, 4, 2, 6);
  expect("wedge([4, 2, 6], center = true);", -2, -1, -3, 2, 1, 3);
  expect("cylinder(h = 2, r = 3, $fn = 4);", -3, -3, 0, 3, 3, 2);
  expect("cylinder(h = 2, r1 = 1, r2 = 3, $fn = 8);", -3, -3, 0, 3, 3, 2);
  expect("polyhedron(points = [[0, 0, 1], [4, 0, 1], [0, 7, 1], [0, 0, 5]], faces = [[0, 2, 3], [0, 3, 1], [0, 1, 2], [1, 3, 2]]);", 0, 0, 1, 4, 7, 5);
}

static void placed_solids(void **state) {
  (void)state;
  expect("cylinder(base = [4, 3, -4], axis = [2, 0, 0], r1 = 4, r2 = 3, h = 2);", 4, -1, -8, 6, 7, 0);
  expect("cone(base = [4, 3, -4], axis = [-2, 0, 0], r = 5, h = 10);", -6, -2, -9, 4, 8, 1);
  expect("paraboloid(base = [4, 3, -4], axis = [0, 3, 0], r = 2, h = 4);", 2, 3, -6, 6, 7, -2);
  expect("hyperboloid(base = [4, 3, -4], axis = [0, 0, -1], r = 5, rc = 3, h = 2);", -1, -2, -6, 9, 8, -2);
  expect("hyperboloid(base = [4, 3, -4], axis = [0, 1, 0], r = 4, gap = 3, h = 5);", 0, -2, -8, 8, 8, 0);
}

/* Axes go to axes: shifts, scales, mirrors, quarter turns. */
static void mapped_solids(void **state) {
  (void)state;
  expect("translate([7, 0, -1]) cone(h = 10, r = 5);", 2, -5, -1, 12, 5, 9);
  expect("rotate([0, 90, 0]) cone(h = 10, r = 5);", 0, -5, -5, 10, 5, 5);
  expect("mirror([0, 0, 1]) scale([1, 2, 0.5]) cone(h = 10, r = 5);", -5, -10, -5, 5, 10, 0);
  expect("rotate([90, 0, 0]) paraboloid(h = 4, r = 2);", -2, -4, -2, 2, 0, 2);
  expect("rotate([0, 0, 90]) wedge([4, 2, 6]);", -2, 0, 0, 0, 4, 6);
  expect("scale(1/2) cylinder(h = 2, r1 = 4, r2 = 3);", -2, -2, 0, 2, 2, 1);
}

/* What is not a double is rounded outward, once: the neighbours of 1/3 are the ends. */
static void rounded_outward(void **state) {
  (void)state;
  const double above = 0x1.5555555555556p-2, below = 0x1.5555555555555p-2; /* 0.0101... in twos */
  expect("cone(h = 1/3, r = 1);", -1, -1, 0, 1, 1, above);
  expect("cone(h = 1, r = 1/3);", -above, -above, 0, above, above, 1);
  expect("cylinder(h = 1/3, r1 = 1/3, r2 = 0.1);", -above, -above, 0, above, above, above);
  expect("cube([1/3, 1, 1]);", 0, 0, 0, above, 1, 1);
  expect("polyhedron(points = [[1/3, 0, 1], [4, 0, 1], [1/3, 7, 1], [1/3, 0, 5]], faces = [[0, 2, 3], [0, 3, 1], [0, 1, 2], [1, 3, 2]]);", below, 0, 1, 4, 7,
         5);
}

/* A size without a rational value, a slanted map: the box holds the solid and is at most 2^-40 of its size wider. */
static void near_for_the_rest(void **state) {
  (void)state;
  quoin_scene *s = scene_of("hyperboloid(h = 2, r = sqrt(2), rc = 1);");
  assert_true(s->leaves[0].max[0] > 1.4142135623730950 && s->leaves[0].max[0] < 1.4142135623730951 + 0x1p-40);
  quoin_scene_free(s);
  s = scene_of("rotate([0, 0, 45]) cube(1);");
  assert_true(s->leaves[0].max[1] >= 1.4142135623730951 && s->leaves[0].max[1] < 1.4142135623730951 + 0x1p-40);
  quoin_scene_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(round_solids),  cmocka_unit_test(solids_of_planes), cmocka_unit_test(placed_solids),
    cmocka_unit_test(mapped_solids), cmocka_unit_test(rounded_outward),  cmocka_unit_test(near_for_the_rest),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
