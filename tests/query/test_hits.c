/* First hits: which boundary, its normal out of the solid, (u, v), and that many hits are one by one. */
#include "ask.h"
#include "random_solid.h"

#include <math.h>

static quoin_hit shoot(const ask *a, double ox, double oy, double oz, double dx, double dy, double dz, double from, double to) {
  const quoin_ray ray = {{ox, oy, oz}, {dx, dy, dz}, from, to};
  quoin_hit hit;
  assert_int_equal(quoin_first_hit(a->scene, a->work, &ray, &hit), QUOIN_OK);
  return hit;
}

static void expect_normal(const quoin_hit *hit, double x, double y, double z) {
  assert_true(hit->normal[0] == x && hit->normal[1] == y && hit->normal[2] == z);
}

static void faces(void **state) {
  (void)state;
  const double inf = strtod("inf", NULL);
  ask a;
  ask_open(&a, "difference() { name(\"plate\") cube([4,4,2]); name(\"hole\") translate([1,1,0]) cube([2,2,2]); }");
  quoin_hit hit = shoot(&a, -1, 2, 1, 1, 0, 0, 0, inf);
  assert_true(hit.found && !hit.leaving && hit.t == 1 && hit.point[0] == 0 && hit.point[1] == 2);
  expect_normal(&hit, -1, 0, 0);
  assert_string_equal(quoin_part_name(a.scene, hit.part), "plate");
  hit = shoot(&a, -1, 2, 1, 1, 0, 0, 1.5, inf); /* begins within the wall: leaves into the hole */
  assert_true(hit.found && hit.leaving && hit.t == 2);
  expect_normal(&hit, 1, 0, 0);
  assert_string_equal(quoin_part_name(a.scene, hit.part), "hole");
  hit = shoot(&a, 2, 2, 1, 1, 0, 0, 0, inf); /* from the hole into the wall */
  assert_true(hit.found && !hit.leaving && hit.t == 1);
  expect_normal(&hit, -1, 0, 0);
  assert_string_equal(quoin_part_name(a.scene, hit.part), "hole");
  hit = shoot(&a, 2, 2, -1, 0, 0, 1, 0, inf); /* through the hole */
  assert_false(hit.found);
  assert_int_equal(hit.part, QUOIN_NO_PART);
  hit = shoot(&a, -1, 2, 1, 1, 0, 0, 0, 0.5);
  assert_false(hit.found);
  hit = shoot(&a, -1, 2, 1, 1, 0, 0, 1, 1);
  assert_false(hit.found); /* a range of one point holds no stretch */
  hit = shoot(&a, -1, 2, 1, 1, 0, 0, 1, 9);
  assert_true(hit.found && !hit.leaving && hit.t == 1);
  hit = shoot(&a, -1, 2, 1, 1, 0, 0, 1.25, 1.75);
  assert_false(hit.found); /* inside all along */
  ask_close(&a);
}

static void rounds(void **state) {
  (void)state;
  const double inf = strtod("inf", NULL);
  ask a;
  ask_open(&a, "difference() { sphere(2); translate([0,0,2]) sphere(1); }");
  quoin_hit hit = shoot(&a, 0, 0, 5, 0, 0, -1, 0, inf);
  assert_true(hit.found && !hit.leaving && hit.t == 4 && hit.part == 1 && hit.role == QUOIN_BODY);
  expect_normal(&hit, 0, 0, 1); /* the bottom of the dent */
  hit = shoot(&a, 0, 0, 0, 0, 0, 1, 0, inf);
  assert_true(hit.found && hit.leaving && hit.t == 1);
  expect_normal(&hit, 0, 0, 1);
  hit = shoot(&a, 0, 0, -5, 0, 0, 1, 0, inf);
  assert_true(hit.found && hit.t == 3);
  expect_normal(&hit, 0, 0, -1);
  ask_close(&a);
  ask_open(&a, "translate([10,0,0]) cylinder(h=4, r=2);");
  static const double want[4] = {0, 0.25, 0.5, 0.75};
  static const int dx[4] = {1, 0, -1, 0}, dy[4] = {0, 1, 0, -1};
  for (int k = 0; k < 4; k++) {
    hit = shoot(&a, 10 + 5 * dx[k], 5 * dy[k], 1, -dx[k], -dy[k], 0, 0, inf);
    assert_true(hit.found && hit.t == 3);
    expect_normal(&hit, dx[k], dy[k], 0);
    double turn = fabs(hit.uv[0] - want[k]);
    assert_true(fmin(turn, 1 - turn) < 1e-12 && fabs(hit.uv[1] - 0.25) < 1e-12);
  }
  hit = shoot(&a, 10, 0, 9, 0, 0, -1, 0, inf);
  assert_true(hit.found && hit.t == 5 && hit.role == QUOIN_CAP1);
  expect_normal(&hit, 0, 0, 1);
  ask_close(&a);
  ask_open(&a, "rotate([0,90,0]) translate([0,0,3]) cylinder(h=4, r=2);"); /* lies along x from 3 to 7 */
  hit = shoot(&a, 4, 0, 9, 0, 0, -1, 0, inf);
  assert_true(hit.found && hit.t == 7);
  expect_normal(&hit, 0, 0, 1);
  assert_true(fabs(hit.uv[1] - 0.25) < 1e-12);
  ask_close(&a);
}

/* (u, v) and normal of a sphere, from its piece where it is only shifted, are those of the ellipsoid of equal axes, which is described from its leaf. */
static void balls(void **state) {
  (void)state;
  static const char *const ways[][2] = {
    {"translate([0.1,0.2,0.3]) sphere(1.1);", "translate([0.1,0.2,0.3]) ellipsoid(r=[1.1,1.1,1.1]);"},
    {"sphere(r=1.1, base=[0.1,0.2,0.3], axis=[1,0,0]);", "ellipsoid(r=[1.1,1.1,1.1], base=[0.1,0.2,0.3], axis=[1,0,0]);"},
    {"sphere(r=1.1, base=[0.1,0.2,0.3], axis=[0,0,-1]);", "ellipsoid(r=[1.1,1.1,1.1], base=[0.1,0.2,0.3], axis=[0,0,-1]);"},
    {"rotate([90,0,0]) translate([0.1,0.2,0.3]) sphere(1.1);", "rotate([90,0,0]) translate([0.1,0.2,0.3]) ellipsoid(r=[1.1,1.1,1.1]);"},
    {"scale(2) sphere(0.7);", "scale(2) ellipsoid(r=[0.7,0.7,0.7]);"},
    {"difference() { cube(4, center=true); sphere(1.1); }", "difference() { cube(4, center=true); ellipsoid(r=[1.1,1.1,1.1]); }"},
  };
  for (size_t w = 0; w < sizeof ways / sizeof *ways; w++) {
    ask a[2];
    ask_open(&a[0], ways[w][0]), ask_open(&a[1], ways[w][1]);
    for (int k = 0; k < 24; k++) {
      const double x = 0.3 * cos(k), y = 0.3 * sin(k), z = 0.02 * (k - 12), dx = sin(3 * k), dy = cos(5 * k), dz = sin(7 * k + 1);
      const quoin_hit p = shoot(&a[0], x, y, z, dx, dy, dz, 0, 99), q = shoot(&a[1], x, y, z, dx, dy, dz, 0, 99);
      assert_true(p.found && q.found && p.leaving == q.leaving && p.role == q.role && p.part == q.part);
      const double turn = fabs(p.uv[0] - q.uv[0]);
      assert_true(fmin(turn, 1 - turn) < 1e-12 && fabs(p.uv[1] - q.uv[1]) < 1e-12);
      for (int j = 0; j < 3; j++) {
        assert_true(fabs(p.normal[j] - q.normal[j]) < 1e-12);
      }
    }
    ask_close(&a[0]), ask_close(&a[1]);
  }
}

/* On random solids: the hit is the first end of the intervals, its normal points out, its (u, v) is in the unit square. */
static void random_hits(void **state) {
  (void)state;
  const double inf = strtod("inf", NULL);
  dice d = {0x9e3779b97f4a7c15u};
  size_t found = 0, leaving = 0;
  for (int i = 0; i < 300; i++) {
    char p[4000];
    random_solid(&d, 0, 1 + roll(&d, 5), p, sizeof p);
    ask a;
    ask_open(&a, p);
    enum { N = 40 };
    quoin_ray rays[N];
    quoin_hit many[N];
    for (int k = 0; k < N; k++) {
      rays[k] = (quoin_ray){.from = roll(&d, 2) ? 0 : -inf, .to = roll(&d, 4) ? inf : 3};
      do {
        for (int j = 0; j < 3; j++) {
          rays[k].o[j] = 0.25 * (roll(&d, 41) - 20);
          rays[k].d[j] = roll(&d, 2) ? 0.25 * (roll(&d, 9) - 4) : 0.5 - rays[k].o[j];
        }
      } while (rays[k].d[0] == 0 && rays[k].d[1] == 0 && rays[k].d[2] == 0);
    }
    assert_int_equal(quoin_first_hits(a.scene, a.work, N, rays, many), QUOIN_OK);
    for (int k = 0; k < N; k++) {
      quoin_hit hit;
      quoin_intervals got;
      assert_int_equal(quoin_first_hit(a.scene, a.work, &rays[k], &hit), QUOIN_OK);
      assert_memory_equal(&hit.t, &many[k].t, sizeof hit.t);
      assert_memory_equal(hit.normal, many[k].normal, sizeof hit.normal);
      assert_memory_equal(hit.uv, many[k].uv, sizeof hit.uv);
      assert_true(hit.found == many[k].found && hit.leaving == many[k].leaving && hit.part == many[k].part && hit.role == many[k].role);
      assert_int_equal(quoin_ray_intervals(a.scene, a.work, &rays[k], 0, &got), QUOIN_OK);
      const quoin_end *want = got.count == 0 ? NULL : got.inside[0].enter.part != QUOIN_NO_PART ? &got.inside[0].enter : &got.inside[0].leave;
      if (!want || want->part == QUOIN_NO_PART) {
        assert_false(hit.found);
        continue;
      }
      assert_true(hit.found && hit.t == want->t && hit.part == want->part && hit.role == want->role);
      double along = 0, size = 0;
      for (int j = 0; j < 3; j++) {
        along += hit.normal[j] * rays[k].d[j];
        size += hit.normal[j] * hit.normal[j];
      }
      assert_true(size == 0 || fabs(size - 1) < 1e-12);
      assert_true(hit.leaving ? along >= -1e-6 : along <= 1e-6);
      assert_true(hit.uv[0] >= 0 && hit.uv[0] <= 1 && hit.uv[1] >= 0 && hit.uv[1] <= 1);
      found++;
      leaving += hit.leaving != 0;
    }
    ask_close(&a);
  }
  print_message("hits %zu, leaving %zu\n", found, leaving);
  assert_true(found > 1000 && leaving > 50);
}

static void arguments(void **state) {
  (void)state;
  ask a;
  ask_open(&a, "cube(1);");
  quoin_hit hit;
  quoin_ray ray = {{0, 0, 0}, {0, 0, 0}, 0, 1};
  assert_int_equal(quoin_first_hit(a.scene, a.work, &ray, &hit), QUOIN_E_ARGUMENT);
  ray.d[0] = strtod("nan", NULL);
  assert_int_equal(quoin_first_hit(a.scene, a.work, &ray, &hit), QUOIN_E_ARGUMENT);
  ray = (quoin_ray){{0, 0, 0}, {1, 0, 0}, 1, 0};
  assert_int_equal(quoin_first_hit(a.scene, a.work, &ray, &hit), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_first_hit(a.scene, a.work, NULL, &hit), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_first_hits(a.scene, a.work, 0, NULL, NULL), QUOIN_OK);
  quoin_stats stats;
  quoin_work_stats(a.work, &stats);
  assert_int_equal(stats.rays, 0);
  ask_close(&a);
}

/* A scene that holds nothing, and one that holds all of space. */
static void extremes(void **state) {
  (void)state;
  const double inf = strtod("inf", NULL);
  ask a;
  ask_open(&a, "intersection() { cube(1); translate([5,0,0]) cube(1); }");
  assert_false(shoot(&a, -1, 0.5, 0.5, 1, 0, 0, -inf, inf).found);
  assert_int_equal(ask_side(&a, "0.5 0.5 0.5"), 'o');
  ask_close(&a);
  ask_open(&a, "halfspace(n=[1,0,0], d=0); halfspace(n=[-1,0,0], d=0);");
  assert_false(shoot(&a, -1, 0.5, 0.5, 1, 0, 0, -inf, inf).found);
  assert_int_equal(ask_side(&a, "0 0 0"), 'i');
  ask_close(&a);
  ask_open(&a, "");
  assert_false(shoot(&a, -1, 0.5, 0.5, 1, 0, 0, -inf, inf).found);
  assert_int_equal(ask_side(&a, "0 0 0"), 'o');
  ask_close(&a);
}

/* Normals where the gradient is beyond the doubles, or below: far out on two planes that are one quadric, and on solids that are hardly there. */
static void sizes(void **state) {
  (void)state;
  const double inf = strtod("inf", NULL), half = sqrt(0.5);
  ask a;
  ask_open(&a, "scale([1e-10, 1e-10, 1]) quadric([1, -1, 0, 0, 0, 0, 0, 0, 0, 0]);"); /* |x| <= |y| */
  quoin_hit hit = shoot(&a, 0, 1e300, 0, 1e300, 0, 0, 0, inf);
  assert_true(hit.found && hit.leaving && hit.t == 1);
  assert_true(fabs(hit.normal[0] - half) < 1e-15 && fabs(hit.normal[1] + half) < 1e-15 && hit.normal[2] == 0);
  ask_close(&a);
  static const char *const small[] = {"ellipsoid([1e-200, 1e-200, 2e-200]);", "scale(1e-200) ellipsoid([1, 1, 2]);", "scale([1, 1, 2]) sphere(1e-200);", "superquadric([1e-200, 1e-200, 2e-200], 1, 1);",
                                      "superquadric([1e-200, 1e-200, 2e-200], 0.5, 1.5);"};
  for (size_t k = 0; k < sizeof small / sizeof *small; k++) {
    ask_open(&a, small[k]);
    hit = shoot(&a, 0, 0, 4e-200, 0, 0, -1e-200, 0, inf);
    assert_true(hit.found && !hit.leaving);
    expect_normal(&hit, 0, 0, 1);
    ask_close(&a);
  }
  ask_open(&a, "scale(1e200) ellipsoid([1, 1, 2]);");
  hit = shoot(&a, 0, 0, 4e200, 0, 0, -1e200, 0, inf);
  assert_true(hit.found && !hit.leaving && hit.t == 2);
  expect_normal(&hit, 0, 0, 1);
  ask_close(&a);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(faces), cmocka_unit_test(rounds), cmocka_unit_test(balls), cmocka_unit_test(random_hits), cmocka_unit_test(arguments), cmocka_unit_test(extremes), cmocka_unit_test(sizes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
