/* Rays that cut an edge of a box 2^-30 deep: where they come into the box and where they leave it is one place in single precision, in which the walks over boxes compare
   (QN_WIDE_FLOAT, QN_BOX_SLACK). Each goes through a place known to be inside, so it has to meet something. */
#include "ask.h"
#include "share.h"

#include <math.h>

enum { RAYS = 64, SIDE = 3, APART = 4, FIRST = 100 };
static uint64_t seed = 0x2545f4914f6cdd1du;
static double unit(void) {
  seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17;
  return (double)(seed >> 11) * 0x1p-53;
}

/* From about the world's origin or from anywhere: beside the one the planes' share of a rounded sum is the greater, beside the other the ray's. */
static quoin_ray through_edge(int from_origin) {
  const int axis = (int)(3 * unit()), outward = (axis + 1 + (unit() < 0.5)) % 3; /* out of the one face as it comes in by the other */
  const double away = 1 + 200 * unit();
  double p[3];
  quoin_ray ray = {.from = 0, .to = INFINITY};
  for (int i = 0; i < 3; i++) {
    p[i] = FIRST + APART * floor(SIDE * unit()) + (i == axis ? 0.25 + 0.5 * unit() : i == outward ? 1 - 0x1p-30 : 0x1p-30);
    ray.d[i] = from_origin ? (p[i] - 1e-3 * unit()) / away : 0.5 + unit();
    ray.o[i] = p[i] - away * ray.d[i]; /* rounded by 2^-44 at most */
  }
  return ray;
}

static void no_edge_is_passed(void **unused) {
  (void)unused;
  char text[SIDE * SIDE * SIDE * 40] = "";
  for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
    sprintf(text + strlen(text), "translate([%d,%d,%d]) cube(1);\n", FIRST + APART * (i % 3), FIRST + APART * (i / 3 % 3), FIRST + APART * (i / 9));
  }
  ask a;
  ask_open(&a, text);
  for (int round = 0; round < share_of(200); round++) {
    quoin_ray rays[RAYS];
    quoin_hit hits[RAYS];
    quoin_spot spots[RAYS], spot;
    uint8_t blocked[RAYS], one;
    for (int i = 0; i < RAYS; i++) {
      rays[i] = through_edge(round % 2);
      assert_int_equal(quoin_first_spots(a.scene, a.work, 1, &rays[i], QUOIN_WANT_T, &spot), QUOIN_OK);
      assert_int_not_equal(spot.surface, QUOIN_NO_SURFACE);
      assert_int_equal(quoin_rays_blocked(a.scene, a.work, 1, &rays[i], NULL, &one), QUOIN_OK);
      assert_int_equal(one, 1);
      quoin_intervals in = {0};
      assert_int_equal(quoin_ray_intervals(a.scene, a.work, &rays[i], 0, &in), QUOIN_OK);
      assert_true(in.count > 0);
    }
    assert_int_equal(quoin_first_hits(a.scene, a.work, RAYS, rays, hits), QUOIN_OK);
    assert_int_equal(quoin_first_spots(a.scene, a.work, RAYS, rays, 0, spots), QUOIN_OK);
    assert_int_equal(quoin_rays_blocked(a.scene, a.work, RAYS, rays, NULL, blocked), QUOIN_OK);
    for (int i = 0; i < RAYS; i++) {
      assert_int_not_equal(spots[i].surface, QUOIN_NO_SURFACE);
      assert_true(hits[i].found);
      assert_int_equal(blocked[i], 1);
    }
  }
  ask_close(&a);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(no_edge_is_passed)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
