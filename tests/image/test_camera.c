/* Cameras: where the rays of known pixels go, and that the default view frames the box. */
#include "image/camera.h"
#include "image/vec.h"
#include "scene/scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static quoin_camera along_y(quoin_projection projection) {
  return (quoin_camera){.eye = {0, -10, 0}, .look = {0, 0, 0}, .up = {0, 0, 1}, .fov = 90, .near = 0.5, .projection = projection};
}

/* Looking along +y with z up, x is to the right; the frame's numbers are exact. */
static void frame_of_a_straight_view(void **state) {
  (void)state;
  qn_frustum f;
  const quoin_camera c = along_y(QUOIN_PERSPECTIVE);
  assert_int_equal(qn_frustum_make(&c, 200, 100, &f), QUOIN_OK);
  const double right[3] = {1, 0, 0}, up[3] = {0, 0, 1}, forward[3] = {0, 1, 0};
  assert_true(memcmp(f.forward, forward, sizeof forward) == 0);
  for (int i = 0; i < 3; i++) {
    assert_true(f.right[i] == right[i] && f.up[i] == up[i]);
  }
}

/* A vertical field of 90 degrees: the picture's top is at slope 1 = tan 45, its right edge at the aspect. tan is a library
   function of some rounding, so these are compared within four roundings. */
static void perspective_corners(void **state) {
  (void)state;
  qn_frustum f;
  const quoin_camera c = along_y(QUOIN_PERSPECTIVE);
  assert_int_equal(qn_frustum_make(&c, 200, 100, &f), QUOIN_OK);
  quoin_ray r;
  qn_frustum_ray(&f, 100, 50, &r); /* the middle */
  assert_true(r.d[0] == 0 && r.d[1] == 1 && r.d[2] == 0);
  assert_true(r.o[0] == 0 && r.o[1] == -10 && r.o[2] == 0);
  assert_true(r.from == 0.5 && isinf(r.to));
  qn_frustum_ray(&f, 200, 0, &r); /* top right */
  assert_true(fabs(r.d[0] - 2) <= 4 * 2 * 0x1p-53 && r.d[1] == 1 && fabs(r.d[2] - 1) <= 4 * 0x1p-53);
  qn_frustum_ray(&f, 0, 100, &r); /* bottom left */
  assert_true(r.d[0] < -1.99 && r.d[2] < -0.99);
}

/* Orthographic: parallel rays; the height is what perspective shows at the distance of `look`: 2 * 10 * tan 45. */
static void orthographic_corners(void **state) {
  (void)state;
  qn_frustum f;
  const quoin_camera c = along_y(QUOIN_ORTHOGRAPHIC);
  assert_int_equal(qn_frustum_make(&c, 200, 100, &f), QUOIN_OK);
  quoin_ray r;
  qn_frustum_ray(&f, 200, 0, &r);
  assert_true(r.d[0] == 0 && r.d[1] == 1 && r.d[2] == 0);
  assert_true(fabs(r.o[0] - 20) <= 8 * 20 * 0x1p-53 && r.o[1] == -10 && fabs(r.o[2] - 10) <= 8 * 10 * 0x1p-53);
}

/* An up along the view leaves a frame that is still a frame. */
static void up_along_the_view(void **state) {
  (void)state;
  quoin_camera c = {.eye = {0, 0, 5}, .look = {0, 0, 0}, .up = {0, 0, 1}, .fov = 40};
  qn_frustum f;
  assert_int_equal(qn_frustum_make(&c, 10, 10, &f), QUOIN_OK);
  const double right[3] = {1, 0, 0}, up[3] = {0, 1, 0}; /* a plan: x to the right, y upwards */
  for (int i = 0; i < 3; i++) {
    assert_true(f.right[i] == right[i] && f.up[i] == up[i]);
  }
}

static void cameras_that_are_refused(void **state) {
  (void)state;
  qn_frustum f;
  quoin_camera c = along_y(QUOIN_PERSPECTIVE);
  c.fov = 180;
  assert_int_equal(qn_frustum_make(&c, 10, 10, &f), QUOIN_E_ARGUMENT);
  c.fov = 0;
  assert_int_equal(qn_frustum_make(&c, 10, 10, &f), QUOIN_E_ARGUMENT);
  c = along_y(QUOIN_PERSPECTIVE);
  c.look[1] = -10; /* eye and look are one */
  assert_int_equal(qn_frustum_make(&c, 10, 10, &f), QUOIN_E_ARGUMENT);
  c = along_y(QUOIN_PERSPECTIVE);
  c.eye[2] = NAN;
  assert_int_equal(qn_frustum_make(&c, 10, 10, &f), QUOIN_E_ARGUMENT);
  c = along_y(QUOIN_PERSPECTIVE);
  c.near = -1;
  assert_int_equal(qn_frustum_make(&c, 10, 10, &f), QUOIN_E_ARGUMENT);
  c = along_y(QUOIN_PERSPECTIVE);
  c.up[2] = 0;
  assert_int_equal(qn_frustum_make(&c, 10, 10, &f), QUOIN_E_ARGUMENT);
}

/* Where a point is in the picture, in [-1, 1], by the frustum's own definition; the depth into *depth. */
static void project(const qn_frustum *f, const double point[3], double *x, double *y, double *depth) {
  double v[3];
  for (int i = 0; i < 3; i++) {
    v[i] = point[i] - f->eye[i];
  }
  *depth = qn_dot3(v, f->forward);
  const double scale = f->orthographic ? 1 : *depth;
  *x = qn_dot3(v, f->right) / (scale * f->half_w);
  *y = qn_dot3(v, f->up) / (scale * f->half_h);
}

/* Frames boxes of many shapes: every corner is in front of the eye and in the picture, and the box fills one of its
   directions. */
static void default_view_frames(void **state) {
  (void)state;
  static const double boxes[][6] = {{-1, -1, -1, 1, 1, 1}, {0, 0, 0, 100, 1, 1}, {5, 5, 5, 5.001, 6, 900},
                                    {-1e6, 2, 3, 1e6, 3, 4}, {0, 0, 0, 10, 10, 0}};
  static const double aspects[] = {4.0 / 3, 1, 0.2, 7};
  quoin_model model = {0};
  for (size_t b = 0; b < sizeof boxes / sizeof *boxes; b++) {
    for (size_t a = 0; a < 4; a++) {
      for (int flat = 0; flat < 2; flat++) {
        quoin_scene scene = {.model = &model};
        memcpy(scene.min, boxes[b], sizeof scene.min);
        memcpy(scene.max, boxes[b] + 3, sizeof scene.max);
        quoin_camera c;
        quoin_camera_default(&scene, aspects[a], flat ? QUOIN_ORTHOGRAPHIC : QUOIN_PERSPECTIVE, &c);
        qn_frustum f;
        assert_int_equal(qn_frustum_make(&c, (size_t)(aspects[a] * 3000 + 0.5), 3000, &f), QUOIN_OK);
        double widest = 0, left = -2, right = -2, low = -2, top = -2;
        for (int k = 0; k < 8; k++) {
          const double corner[3] = {boxes[b][k & 1 ? 3 : 0], boxes[b][k & 2 ? 4 : 1], boxes[b][k & 4 ? 5 : 2]};
          double x, y, depth;
          project(&f, corner, &x, &y, &depth);
          assert_true(depth > 0);
          assert_true(fabs(x) < 1 && fabs(y) < 1);
          widest = fmax(widest, fmax(fabs(x), fabs(y)));
          left = fmax(left, -x), right = fmax(right, x), low = fmax(low, -y), top = fmax(top, y);
        }
        assert_true(fabs(left - right) < 0.02 && fabs(low - top) < 0.02); /* centred, within a hundredth of the picture */
        assert_true(widest > 0.9); /* not lost in the middle: the fill is 0.92 */
      }
    }
  }
}

/* Leaves hold a solid more closely than its box: a mast on a plate is framed from nearer than the box of both; a leaf that
   is cut away does not count, nor does what sticks out of the solid's box. Every corner that counts is in the picture. */
static void leaves_are_framed(void **state) {
  (void)state;
  quoin_model model = {0};
  qn_leaf leaves[] = {{.min = {0, 0, 0}, .max = {10, 10, 1}}, {.min = {4, 4, 1}, .max = {6, 6, 40}},
                      {.min = {-90, -90, -90}, .max = {90, 90, 90}, .negated = 1}};
  quoin_scene box = {.model = &model, .min = {0, 0, 0}, .max = {10, 10, 30}};
  quoin_scene mast = {.model = &model, .min = {0, 0, 0}, .max = {10, 10, 30}, .leaves = leaves, .leaf_count = 3};
  for (int flat = 0; flat < 2; flat++) {
    quoin_camera of_box, c;
    quoin_camera_default(&box, 1, flat ? QUOIN_ORTHOGRAPHIC : QUOIN_PERSPECTIVE, &of_box);
    quoin_camera_default(&mast, 1, flat ? QUOIN_ORTHOGRAPHIC : QUOIN_PERSPECTIVE, &c);
    qn_frustum f, wide;
    assert_int_equal(qn_frustum_make(&c, 100, 100, &f), QUOIN_OK);
    assert_int_equal(qn_frustum_make(&of_box, 100, 100, &wide), QUOIN_OK);
    double widest = 0, x, y, depth, wide_depth;
    for (int k = 0; k < 16; k++) {
      const qn_leaf *l = &leaves[k / 8];
      const double corner[3] = {k & 1 ? l->max[0] : l->min[0], k & 2 ? l->max[1] : l->min[1], fmin(30, k & 4 ? l->max[2] : l->min[2])};
      project(&f, corner, &x, &y, &depth);
      assert_true(depth > 0 && fabs(x) < 1 && fabs(y) < 1);
      widest = fmax(widest, fmax(fabs(x), fabs(y)));
    }
    assert_true(widest > 0.9);
    const double middle[3] = {5, 5, 15};
    project(&f, middle, &x, &y, &depth);
    project(&wide, middle, &x, &y, &wide_depth);
    assert_true(depth * f.half_h < wide_depth * wide.half_h || (flat && f.half_h < wide.half_h));
  }
}

/* A wide field makes `look` near to the eye in an orthographic view; the eye stands clear of the box none the less. */
static void orthographic_eye_is_clear(void **state) {
  (void)state;
  quoin_model model = {.view = {.has_fov = 1, .fov = 170}};
  quoin_scene scene = {.model = &model, .min = {0, 0, 0}, .max = {2, 30, 1}};
  quoin_camera c;
  qn_frustum f;
  quoin_camera_default(&scene, 1, QUOIN_ORTHOGRAPHIC, &c);
  assert_int_equal(qn_frustum_make(&c, 100, 100, &f), QUOIN_OK);
  for (int k = 0; k < 8; k++) {
    const double corner[3] = {k & 1 ? 2 : 0, k & 2 ? 30 : 0, k & 4 ? 1 : 0};
    double x, y, depth;
    project(&f, corner, &x, &y, &depth);
    assert_true(depth > 0 && fabs(x) < 1 && fabs(y) < 1);
  }
}

/* Empty and unbounded solids have a view too; a bounded side is framed. */
static void open_boxes(void **state) {
  (void)state;
  quoin_model model = {0};
  quoin_scene empty = {.model = &model, .empty = 1, .min = {INFINITY, INFINITY, INFINITY}, .max = {-INFINITY, -INFINITY, -INFINITY}};
  quoin_scene unit = {.model = &model, .min = {-0.5, -0.5, -0.5}, .max = {0.5, 0.5, 0.5}};
  quoin_scene all = {.model = &model, .min = {-INFINITY, -INFINITY, -INFINITY}, .max = {INFINITY, INFINITY, INFINITY}};
  quoin_camera c, of_unit;
  quoin_camera_default(&unit, 1.5, QUOIN_PERSPECTIVE, &of_unit);
  quoin_camera_default(&empty, 1.5, QUOIN_PERSPECTIVE, &c);
  assert_memory_equal(c.eye, of_unit.eye, sizeof c.eye);
  quoin_camera_default(&all, 1.5, QUOIN_PERSPECTIVE, &c);
  assert_memory_equal(c.eye, of_unit.eye, sizeof c.eye);
  /* z <= 3 over a square of side 4: as if it ended at z = -1 */
  quoin_scene below = {.model = &model, .min = {0, 0, -INFINITY}, .max = {4, 4, 3}};
  quoin_scene cube = {.model = &model, .min = {0, 0, -1}, .max = {4, 4, 3}};
  quoin_camera of_cube;
  quoin_camera_default(&below, 1.5, QUOIN_PERSPECTIVE, &c);
  quoin_camera_default(&cube, 1.5, QUOIN_PERSPECTIVE, &of_cube);
  assert_memory_equal(c.eye, of_cube.eye, sizeof c.eye);
}

/* What the text says wins; what it does not say is filled in. */
static void camera_of_the_text(void **state) {
  (void)state;
  quoin_model model = {.view = {.has_camera = 1, .eye = {9, 8, 7}, .near = 2, .has_fov = 1, .fov = 50}};
  quoin_scene scene = {.model = &model, .min = {0, 0, 0}, .max = {2, 4, 6}};
  quoin_camera c;
  qn_camera_of_scene(&scene, 1, &c);
  assert_true(c.eye[0] == 9 && c.eye[1] == 8 && c.eye[2] == 7 && c.near == 2 && c.fov == 50);
  assert_true(c.look[0] == 1 && c.look[1] == 2 && c.look[2] == 3); /* the box's centre */
  assert_true(c.up[2] == 1 && c.projection == QUOIN_PERSPECTIVE);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(frame_of_a_straight_view), cmocka_unit_test(perspective_corners),      cmocka_unit_test(orthographic_corners),
    cmocka_unit_test(up_along_the_view),        cmocka_unit_test(cameras_that_are_refused), cmocka_unit_test(default_view_frames),
    cmocka_unit_test(open_boxes),               cmocka_unit_test(leaves_are_framed),        cmocka_unit_test(camera_of_the_text),
    cmocka_unit_test(orthographic_eye_is_clear),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
