/* Surfaces whose exact numbers pass a limit: each question that needs one says QUOIN_E_LIMIT, not that memory ran out; those that need none are answered. */
#include "ask.h"
#include "scene/compile.h"

static void each_question(void **state) {
  (void)state;
  ask a;
  ask_open(&a, "rotate(10) cube(2); translate([0, 0, 1]) sphere(1);");
  for (uint32_t i = 0; i < a.scene->surface_count; i++) {
    const qn_exact_surface beyond = {.beyond = 1};
    assert_non_null(qn_scene_publish(a.scene, i, &beyond, NULL));
    assert_null(qn_scene_exact(a.scene, i, NULL));
    assert_int_equal(qn_scene_no_exact(a.scene, i), QUOIN_E_LIMIT);
  }
  static const char *const corner[3] = {"0", "0", "2"}, *const inside[3] = {"0.5", "0.5", "0.5"};
  static const char *const tangent[6] = {"-5", "0", "2", "1", "0", "0"}, *const miss[6] = {"-5", "0", "9", "1", "0", "0"};
  static const double place[3] = {0, 0, 2};
  quoin_side side;
  quoin_intervals got;
  assert_int_equal(quoin_point_side_text(a.scene, a.work, corner, &side), QUOIN_E_LIMIT);
  assert_int_equal(quoin_point_side(a.scene, a.work, place, &side), QUOIN_E_LIMIT);
  assert_int_equal(quoin_point_sides(a.scene, a.work, 1, place, &side), QUOIN_E_LIMIT);
  assert_int_equal(quoin_ray_intervals_text(a.scene, a.work, tangent, NULL, NULL, QUOIN_WANT_CONTACTS, &got), QUOIN_E_LIMIT);
  assert_int_equal(quoin_ray_intervals(a.scene, a.work, &(quoin_ray){{-5, 0, 2}, {1, 0, 0}, 0, 99}, QUOIN_WANT_BOUNDARY, &got), QUOIN_E_LIMIT);
  assert_int_equal(quoin_point_side_text(a.scene, a.work, inside, &side), QUOIN_OK);
  assert_int_equal(side, QUOIN_INSIDE);
  assert_int_equal(quoin_ray_intervals_text(a.scene, a.work, miss, NULL, NULL, 0, &got), QUOIN_OK);
  assert_int_equal(got.count, 0);
  quoin_near_list *list = NULL;
  quoin_status status = quoin_near_find(a.scene, "1", &list);
  assert_true(status == QUOIN_E_LIMIT || (status == QUOIN_OK && quoin_near_count(list) == 0));
  quoin_near_free(list);
  ask_close(&a);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(each_question)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
