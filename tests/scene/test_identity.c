/* Which surfaces are one (S2, S3), and which are not (S4). */
#include "scene/reading.h"

#include <stdlib.h>
#include <time.h>

static size_t distinct(const char *text, size_t leaves) {
  quoin_scene *s = scene_of(text);
  assert_int_equal(s->leaf_count, leaves);
  size_t users = 0, n = s->surface_count;
  for (size_t i = 0; i < n; i++) {
    users += s->surfaces[i].users;
    const qn_half *first = &s->halves[s->surfaces[i].half]; /* named in the order of first use */
    assert_int_equal(first->surface, i);
    assert_true(i == 0 || s->surfaces[i - 1].half < s->surfaces[i].half);
  }
  assert_int_equal(users, s->half_count);
  quoin_scene_free(s);
  return n;
}

static void planes(void **unused) {
  (void)unused;
  assert_int_equal(distinct("cube(1); translate([1,0,0]) cube(1);", 2), 7);
  assert_int_equal(distinct("cube([0.3,1,1]); translate([0.1+0.2,0,0]) cube([0.7,1,1]);", 2), 7); /* in doubles they differ */
  assert_int_equal(distinct("cube(0.1); translate([8.1-9+0.9,0,0]) cube(0.1);", 2), 6);
  assert_int_equal(distinct("cube(1); translate([1+8.8e-11,0,0]) cube(1);", 2), 8); /* near is not equal */
  assert_int_equal(distinct("cube(1); translate([1+1e-60,0,0]) cube(1);", 2), 8);
  assert_int_equal(distinct("cube(1/3); translate([1/3,0,0]) cube(1/3);", 2), 7); /* no key: thirds */
  assert_int_equal(distinct("cube(1/3); scale(1/3) cube(1);", 2), 6);
  assert_int_equal(distinct("cube([2,2,2],center=true); halfspace(n=[3,0,0],d=3); halfspace(n=[-0.5,0,0],d=-0.5);", 3), 6);
  assert_int_equal(distinct("cube(10); multmatrix([[0.6,0.8,0,0],[-0.8,0.6,0,0],[0,0,1,0]]) multmatrix([[0.6,-0.8,0,0],[0.8,0.6,0,0],[0,0,1,0]]) cube(10);", 2), 6);
  assert_int_equal(distinct("multmatrix([[0.6,0.8,0,0],[-0.8,0.6,0,0],[0,0,1,0]]) { cube(1); translate([1,0,0]) cube(1); translate([1,1,1]) cube(1);}", 3), 9);
  assert_int_equal(distinct("translate([1e9,1e9,0]) { cube(1); translate([1,0,0]) cube(1); rotate([0,0,90]) cube(1);}", 3), 8);
}

static void rounded_planes(void **unused) {
  (void)unused;
  assert_int_equal(distinct("rotate([0,0,30]) rotate([0,0,60]) cube([1,2,3]); rotate([0,0,90]) cube([1,2,3]);", 2), 6);
  assert_int_equal(distinct("rotate([0,0,10]) rotate([0,0,25]) cube([1,2,3]); rotate([0,0,35]) cube([1,2,3]);", 2), 6);
  assert_int_equal(distinct("rotate([0,0,10]) rotate([0,0,25]) cube([1,2,3]); rotate([0,0,35.0000001]) cube([1,2,3]);", 2), 10);
  assert_int_equal(distinct("cube(1); rotate(a=120,v=[1,1,1]) cube(1);", 2), 6);
  assert_int_equal(distinct("translate([5,6,7]) cube(1,center=true); translate([5,6,7]) rotate(a=120,v=[1,1,1]) cube(1,center=true);", 2), 6);
  assert_int_equal(distinct("cube(sqrt(2)); translate([sqrt(2),0,0]) cube(1); scale(sqrt(8)/2) cube(1);", 3), 9);
  assert_int_equal(distinct("rotate([0,0,45]) cube(1); rotate([0,0,45]) mirror([1,0,0]) cube(1);", 2), 7);
  /* rotated lattice: the same planes through many leaves */
  assert_int_equal(distinct("rotate([10,20,30]) { cube(0.1); translate([0.1,0,0]) cube(0.1); translate([0.2,0,0.1]) cube(0.1); translate([0.3,0.1,0]) cube(0.1); }", 4), 11);
  assert_int_equal(distinct("translate([1e6,2e6,0]) rotate([10,20,30]) { cube(0.1); translate([0.1,0,0]) cube(0.1); } translate([1e6,2e6,0]) rotate([10,20,30]) rotate([0,0,90]) translate([0,-0.1,0]) cube(0.1);", 3), 7);
}

static void quadrics(void **unused) {
  (void)unused;
  assert_int_equal(distinct("quadric([1,1,1,0,0,0,0,0,0,-1]); quadric([2,2,2,0,0,0,0,0,0,-2]);", 2), 1);
  assert_int_equal(distinct("quadric([1,1,1,0,0,0,0,0,0,-1]); quadric([-3,-3,-3,0,0,0,0,0,0,3]);", 2), 1); /* opposite sides */
  assert_int_equal(distinct("sphere(2); ellipsoid(r=[2,2,2]); quadric([1,1,1,0,0,0,0,0,0,-4]); scale(2) sphere(1); scale([2,4,1]) ellipsoid(r=[1,0.5,2]);", 5), 1);
  assert_int_equal(distinct("translate([0.1,0.2,0.3]) sphere(2); translate([0.1,0.2,0]) translate([0,0,0.3]) rotate([30,0,0]) sphere(2);", 2), 1);
  assert_int_equal(distinct("sphere(2); sphere(2.0000000001); translate([1e-20,0,0]) sphere(2);", 3), 3);
  assert_int_equal(distinct("cylinder(h=1,r=2); cylinder(h=5,r=2); translate([0,0,-7.5]) rotate([0,0,45]) cylinder(h=2,r=2);",
                            3), 6);
  assert_int_equal(distinct("cylinder(h=5,r=2,base=[0,0,5],axis=[0,0,-1]); cylinder(h=5,r=2);", 2), 3);
  assert_int_equal(distinct("cylinder(h=4,r1=2,r2=0); cylinder(h=2,r1=2,r2=1);", 2), 4); /* one cone, three caps */
  assert_int_equal(distinct("hyperboloid(h=3,r=5,rc=4); quadric([1,1,-1,0,0,0,0,0,0,-16]);", 2), 3);
  assert_int_equal(distinct("translate([1,2,5]) paraboloid(h=2,r=3); quadric([2,2,0,0,0,0,-4,-8,-9,55]);", 2), 2);
  assert_int_equal(distinct("translate([0,0,5]) saddle(a=1,b=2); quadric([-4,1,0,0,0,0,0,0,4,-20]);", 2), 1);
  assert_int_equal(distinct("quadric([0,0,0,0,0,0,2,0,0,-2]); halfspace(n=[1,0,0],d=1); cube(1);", 3), 6); /* a plane is a plane */
  assert_int_equal(distinct("quadric([1,0,0,0,0,0,0,0,0,-1]); quadric([1,0,0,0,0,0,0,0,0,-1.00000001]);", 2), 2);
  assert_int_equal(distinct("scale(1e-12) { sphere(1); sphere(2); } scale(1e12) { sphere(1); sphere(2); }", 4), 4);
  assert_int_equal(distinct("sphere(1e-200); scale(1e-200) sphere(1); sphere(1e200); scale(1e200) sphere(1); sphere(2e200);", 5),
                   3);
}

static void superquadrics(void **unused) {
  (void)unused;
  assert_int_equal(distinct("superquadric(r=[1,2,3],e=0.5,n=1.5); superquadric(r=[1,2,3],e=0.5,n=1.5);", 2), 1);
  assert_int_equal(distinct("superquadric(r=[1,2,3],e=0.5,n=1.5); superquadric(r=[1,2,3],e=0.5,n=1.25);", 2), 2);
  assert_int_equal(distinct("superquadric(r=[1,2,3],e=0.5,n=1.5); translate([1e-9,0,0]) superquadric(r=[1,2,3],e=0.5,n=1.5);",
                            2), 2);
  assert_int_equal(distinct("sphere(1); superquadric(r=[1,1,1],e=0.5,n=1.5);", 2), 2);
}

static int side_of(const quoin_scene *s, uint32_t leaf, uint32_t role) {
  for (uint32_t h = s->leaves[leaf].half0; h < s->leaves[leaf].half0 + s->leaves[leaf].halves; h++) {
    if (s->halves[h].role == role) {
      return s->halves[h].side;
    }
  }
  fail();
  return 0;
}

static void sides(void **unused) {
  (void)unused;
  quoin_scene *s = scene_of("cube(1); translate([1,0,0]) cube(1); mirror([1,0,0]) cube(1);");
  assert_int_equal(side_of(s, 0, QUOIN_FACE), -1);     /* -x: -x <= 0, the plane is x = 0 */
  assert_int_equal(side_of(s, 0, QUOIN_FACE + 1), 1);  /* x - 1 <= 0 */
  assert_int_equal(side_of(s, 1, QUOIN_FACE), -1);     /* the same plane from the other side */
  assert_int_equal(side_of(s, 2, QUOIN_FACE), 1);      /* mirrored */
  assert_int_equal(s->halves[1].surface, s->halves[6].surface);
  quoin_scene_free(s);
  s = scene_of("quadric([1,1,1,0,0,0,0,0,0,-1]); quadric([-3,-3,-3,0,0,0,0,0,0,3]);");
  assert_int_equal(s->halves[0].side, 1);
  assert_int_equal(s->halves[1].side, -1);
  quoin_scene_free(s);
  /* Noise below 2^-200 turns the normalised form round, not the surface. */
  s = scene_of("halfspace(n=[1e-70,sqrt(2),0],d=1); halfspace(n=[-1e-70,sqrt(2),0],d=1); halfspace(n=[1e-70,-sqrt(2),0],d=-1);");
  assert_int_equal(s->surface_count, 1);
  assert_true(s->halves[0].side == 1 && s->halves[1].side == 1 && s->halves[2].side == -1);
  quoin_scene_free(s);
  /* The first coefficient of the rotated cone is an exact 0 that doubles cannot see: x and z trade places at 45 degrees. */
  s = scene_of("quadric([0,1,0,0,1,0,0,0,0,0]); quadric([0,-1,0,0,-1,0,0,0,0,0]);");
  assert_int_equal(s->surface_count, 1);
  assert_int_equal(s->halves[0].side, 1);
  assert_int_equal(s->halves[1].side, -1);
  const qn_exact_surface *e = qn_scene_exact(s, 0, NULL);
  assert_int_equal(qn_int_sign(e->q[0]), 0);
  assert_int_equal(qn_int_sign(e->q[1]), 1);
  quoin_scene_free(s);
}

/* Everything in one order or the other, scaled, moved: the same number of surfaces. */
static void relatives(void **unused) {
  (void)unused;
  static const char *const wrap[] = {"%s", "rotate([0,0,90]) { %s }", "scale(1024) { %s }", "scale(1/1024) { %s }",
                                     "scale(1e-7) { %s }", "translate([1e7,-0.1,1/3]) { %s }",
                                     "multmatrix([[0.6,0.8,0,0],[-0.8,0.6,0,0],[0,0,1,0]]) { %s }", "rotate([12,34,56]) { %s }",
                                         "mirror([1,1,0]) { %s }",
                                     "scale([1e-3,1,1e3]) { %s }", "translate([1e12,1e12,1e12]) rotate([1,2,3]) { %s }"};
  static const struct { const char *text; size_t leaves, distinct; } cases[] = {
    {"cube(1); translate([1,0,0]) cube(1); translate([0.1+0.2,0,0]) cube(1); translate([0.3,0,0]) cube(1);", 4, 9},
    {"sphere(1); cylinder(h=2,r=1,center=true); translate([0,0,2]) cylinder(h=2,r=1,center=true); translate([0,0,2]) sphere(1);",
     4, 6},
    {"cube(1); rotate(a=120,v=[1,1,1]) cube(1); rotate(a=240,v=[1,1,1]) cube(1);", 3, 6},
    {"quadric([1,2,3,0,0,0,0,0,0,-4]); scale(3) quadric([9,18,27,0,0,0,0,0,0,-4]); quadric([1,2,3,0,0,0,0,0,0.001,-4]);", 3, 2},
    {"paraboloid(h=2,r=3); translate([0,0,1]) quadric([2,2,0,0,0,0,0,0,-9,-9]); rotate([180,0,0]) paraboloid(h=2,r=3);", 3, 4},
    {"cube(1); translate([1+1e-11,0,0]) cube(1); translate([1-1e-11,0,0]) cube(1);", 3, 10},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    for (size_t w = 0; w < sizeof wrap / sizeof *wrap; w++) {
      char text[2000];
      snprintf(text, sizeof text, wrap[w], cases[i].text);
      assert_int_equal(distinct(text, cases[i].leaves), cases[i].distinct);
    }
  }
}

/* Random spheres need no exact form. */
static void most_need_no_exact_forms(void **unused) {
  (void)unused;
  enum { N = 20000 };
  char *text = malloc(N * 100);
  size_t at = 0;
  assert_non_null(text);
  srand(1);
  for (int i = 0; i < N; i++) {
    at += (size_t)snprintf(text + at, 100, "translate([%d.%03d,%d.%03d,%d.%03d]) sphere(0.%03d);\n", rand() % 1000,
                           rand() % 1000, rand() % 1000, rand() % 1000,
                           rand() % 1000, rand() % 1000, rand() % 999 + 1);
  }
  quoin_scene *s = scene_of(text);
  assert_int_equal(s->surface_count, N);
  for (size_t i = 0; i < s->surface_count; i++) {
    assert_null(atomic_load(&s->surfaces[i].exact));
  }
  quoin_scene_free(s);
  free(text);
}

/* A Menger-like lattice, straight and turned: every plane once. */
static void lattices(void **unused) {
  (void)unused;
  enum { N = 12 };
  char *text = malloc(N * N * N * 60 + 100);
  assert_non_null(text);
  for (int turned = 0; turned < 2; turned++) {
    size_t at = (size_t)sprintf(text, turned ? "rotate([10,20,30]) {" : "union() {");
    for (int x = 0; x < N; x++) {
      for (int y = 0; y < N; y++) {
        for (int z = 0; z < N; z++) {
          at += (size_t)sprintf(text + at, "translate([%d/10,%d/10,%d/10]) cube(0.1);\n", x, y, z);
        }
      }
    }
    strcpy(text + at, "}");
    assert_int_equal(distinct(text, N * N * N), 3 * (N + 1));
  }
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(planes), cmocka_unit_test(rounded_planes), cmocka_unit_test(quadrics), cmocka_unit_test(superquadrics),
        cmocka_unit_test(sides),
    cmocka_unit_test(relatives), cmocka_unit_test(most_need_no_exact_forms), cmocka_unit_test(lattices),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
