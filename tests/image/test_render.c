/* Pictures through the whole library: what pixels must show, computed here by hand. Flat materials (ambient 1, no diffuse, no
   specular) make a pixel's bytes the material's colour. */
#include "image/colour.h"
#include "quoin/quoin.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define FLAT "ambient = 1, diffuse = 0, specular = 0"

static quoin_scene *compile_with(const char *text, const quoin_allocator *allocator) {
  quoin_model *model;
  quoin_scene *scene;
  assert_int_equal(quoin_model_new(allocator, &model), QUOIN_OK);
  assert_int_equal(quoin_model_read_text(model, QUOIN_ROOT, "test", text, strlen(text), NULL), QUOIN_OK);
  assert_int_equal(quoin_scene_compile(model, NULL, &scene), QUOIN_OK);
  quoin_model_free(model);
  return scene;
}
static quoin_scene *compile(const char *text) {
  return compile_with(text, NULL);
}

/* Looking along +y from -50, orthographic: the picture is size x size pixels of one unit, x to the right, z upwards, the
   origin in its middle. */
static quoin_render_options front(size_t size) {
  quoin_render_options o = quoin_render_options_default();
  o.width = o.height = size;
  o.has_camera = 1;
  o.camera = (quoin_camera){.eye = {0, -(double)size / 2, 0}, .up = {0, 0, 1}, .fov = 90, .projection = QUOIN_ORTHOGRAPHIC};
  o.antialias = 0;
  o.threads = 1;
  return o;
}

static void assert_pixel(const unsigned char *pixel, int r, int g, int b) {
  assert_int_equal(pixel[0], r);
  assert_int_equal(pixel[1], g);
  assert_int_equal(pixel[2], b);
  assert_int_equal(pixel[3], 255);
}

/* x^2 + z^2 at a pixel's centre is an odd multiple of 1/2, so the circle of radius^2 30 passes none of them by less than
   1/2. */
static void outline_of_a_ball(void **state) {
  (void)state;
  enum { N = 16 };
  quoin_scene *scene = compile("background([0, 0, 1]); material(color = [1, 0, 0], " FLAT ") quadric([1, 1, 1, 0, 0, 0, 0, 0, 0, -30]);");
  quoin_render_options o = front(N);
  o.camera.eye[1] = -8;
  unsigned char p[N * N * 4];
  quoin_render_stats stats;
  assert_int_equal(quoin_render(scene, &o, p, N * 4, &stats), QUOIN_OK);
  for (int j = 0; j < N; j++) {
    for (int i = 0; i < N; i++) {
      const double x = i + 0.5 - N / 2, z = N / 2 - (j + 0.5);
      const int in = x * x + z * z < 30;
      assert_pixel(p + (j * N + i) * 4, in ? 255 : 0, 0, in ? 0 : 255);
    }
  }
  assert_int_equal(stats.camera_rays, N * N);
  assert_int_equal(stats.hits, 88); /* the pixels of the disc, a quarter of them 5 + 5 + 5 + 4 + 3 */
  assert_int_equal(stats.refined_pixels, 0);
  quoin_scene_free(scene);
}

/* An upright edge a quarter into a column of pixels: 4 of the 16 columns of samples are covered, and the mean is of light,
   not of bytes. */
static void antialiased_edge(void **state) {
  (void)state;
  enum { N = 40 };
  quoin_scene *scene = compile("background([0, 0, 0]); material(color = [1, 1, 1], " FLAT ")"
                               "intersection() { cube([100, 10, 100], center = true);"
                               "halfspace(n = [1, 0, 0], d = 3.25); }");
  quoin_render_options o = front(N);
  o.antialias = 1;
  unsigned char p[N * N * 4];
  quoin_render_stats stats;
  assert_int_equal(quoin_render(scene, &o, p, N * 4, &stats), QUOIN_OK);
  qn_tone tone;
  qn_tone_make(&tone);
  const int quarter = qn_tone_byte(&tone, 0.25);
  for (int j = 0; j < N; j++) {
    for (int i = 0; i < N; i++) {
      const int level = i < N / 2 + 3 ? 255 : i == N / 2 + 3 ? quarter : 0;
      assert_pixel(p + (j * N + i) * 4, level, level, level);
    }
  }
  assert_int_equal(stats.refined_pixels, 2 * N); /* the pixels on both sides of the step of the first pass, which shows at 3 | 4 */
  assert_int_equal(stats.camera_rays, N * N + N * 16 + N * 4); /* the four corners of the whole ones show no edge */
  quoin_scene_free(scene);
}

static const char scene_of_some_parts[] =
  "color([0.8, 0.3, 0.2]) difference() { cube(10, center = true); color([0.2, 0.6, 0.3]) cylinder(h = 10, r = 3, center = true); }"
  "color([0.3, 0.4, 0.8]) translate([0, 0, 7]) sphere(4); translate([0, 0, -6]) cylinder(h = 1, r = 12);";

/* The same bytes for every number of threads; the bytes between rows stay. */
static void threads_do_not_show(void **state) {
  (void)state;
  enum { W = 101, H = 75, ROW = W * 4 + 12 };
  quoin_scene *scene = compile(scene_of_some_parts);
  quoin_render_options o = quoin_render_options_default();
  o.width = W, o.height = H;
  static unsigned char first[H * ROW], other[H * ROW];
  memset(first, 0xA5, sizeof first);
  o.threads = 1;
  quoin_render_stats one, many;
  assert_int_equal(quoin_render(scene, &o, first, ROW, &one), QUOIN_OK);
  assert_true(one.refined_pixels > 100 && one.shadow_rays > 1000);
  for (unsigned threads = 2; threads <= 8; threads += 3) {
    o.threads = threads;
    memset(other, 0xA5, sizeof other);
    assert_int_equal(quoin_render(scene, &o, other, ROW, &many), QUOIN_OK);
    assert_memory_equal(first, other, sizeof first);
    assert_true(many.camera_rays == one.camera_rays && many.shadow_rays == one.shadow_rays && many.refined_pixels == one.refined_pixels);
  }
  for (size_t y = 0; y < H; y++) {
    for (size_t i = W * 4; i < ROW; i++) {
      assert_int_equal(first[y * ROW + i], 0xA5);
    }
  }
  quoin_scene_free(scene);
}

/* The same bytes from every instruction set that this machine runs, on every number of threads (design S9): models with curved, coincident and
   many-coloured faces, and a scene with a lamp that is a place, seen at a wide angle. */
static void machines_do_not_show(void **state) {
  (void)state;
  enum { W = 120, H = 90 };
  static const char *const files[] = {"quoin", "chess", "superquadrics", "menger_sponge", "ten_materials", "conic_sections", "die", "nut_and_bolt"};
  static const char *const isas[] = {"sse2", "avx2", "avx512"};
  static const char wide[] = "camera(eye = [0, -3, 1], look = [0, 0, 0.5], fov = 150); light(at = [1, -1, 3], color = [1, 1, 1]); light(direction = [1, 2, -1]);"
                             "difference() { cube(2, center = true); sphere(1.2); } translate([0, 0, -1.5]) cube([9, 9, 1], center = true);"
                             "material(color = [0.5, 0.6, 0.7], specular = 0.5, shininess = 33.5) superquadric(r = [1, 1, 1], e = 0.7, n = 1.4);";
  static unsigned char first[W * H * 4], other[W * H * 4];
  const size_t count = sizeof files / sizeof *files;
  for (size_t k = 0; k <= count; k++) {
    char path[1024];
    quoin_model *model;
    quoin_scene *scene;
    assert_int_equal(quoin_model_new(NULL, &model), QUOIN_OK);
    if (k < count) {
      snprintf(path, sizeof path, "%s/models/%s.scad", QN_SOURCE_DIR, files[k]);
      assert_int_equal(quoin_model_read_file(model, QUOIN_ROOT, path, NULL), QUOIN_OK);
    } else {
      assert_int_equal(quoin_model_read_text(model, QUOIN_ROOT, "wide", wide, strlen(wide), NULL), QUOIN_OK);
    }
    assert_int_equal(quoin_scene_compile(model, NULL, &scene), QUOIN_OK);
    quoin_model_free(model);
    quoin_render_options o = quoin_render_options_default();
    o.width = W, o.height = H;
    for (size_t isa = 0; isa < 3; isa++) { /* one that the machine lacks stands for its widest */
      setenv("QUOIN_ISA", isas[isa], 1);
      for (o.threads = 1; o.threads <= 4; o.threads++) {
        assert_int_equal(quoin_render(scene, &o, isa == 0 && o.threads == 1 ? first : other, W * 4, NULL), QUOIN_OK);
        if (isa || o.threads > 1) {
          assert_memory_equal(first, other, sizeof first);
        }
      }
    }
    unsetenv("QUOIN_ISA");
    quoin_scene_free(scene);
  }
}

/* The default view of round solids: what is seen fills 0.92 of the picture in one direction (of those whose hull is a guess, no more than
   that and most of it), lies within it and in its middle, to a pixel and a half. */
static void round_solids_are_framed(void **state) {
  (void)state;
  static const struct { const char *text; double least; } solids[] = {
    {"translate([3, 4, 5]) sphere(20);", 0.9},
    {"translate([1e4, 0, 0]) rotate([10, 20, 30]) scale([1, 3, 0.2]) sphere(2);", 0.9},
    {"ellipsoid(r = [1, 2, 9]);", 0.9},
    {"rotate([40, 10, 0]) cylinder(h = 30, r = 4);", 0.9},
    {"rotate([90, 0, 20]) cylinder(h = 1, r = [8, 3]);", 0.9},
    {"translate([0, 0, -7]) cylinder(h = 3, r1 = 9, r2 = 2);", 0.9},
    {"cylinder(base = [5, 5, 5], axis = [1, 2, -3], h = 3, r1 = 0, r2 = 6);", 0.9},
    {"rotate([0, 70, 0]) hyperboloid(h = 5, r = 6, rc = 2);", 0.9},
    {"rotate([20, 0, 10]) hyperboloid(h = 5, r = 6, gap = 1);", 0.9},
    {"rotate([200, 0, 10]) paraboloid(h = 5, r = 6);", 0.8},
    {"scale([1, 1, 4]) paraboloid(h = 5, r = 1);", 0.8},
    {"difference() { sphere(10); translate([0, -20, 0]) cube(20); cylinder(h = 90, r = 3, center = true); }", 0.9},
  };
  enum { W = 240, H = 180 };
  static unsigned char p[W * H * 4];
  for (size_t k = 0; k < sizeof solids / sizeof *solids; k++) {
    char text[512];
    snprintf(text, sizeof text, "background([0, 0, 0]); material(color = [1, 1, 1], " FLAT ") %s", solids[k].text);
    quoin_scene *scene = compile(text);
    quoin_render_options o = quoin_render_options_default();
    o.width = W, o.height = H, o.antialias = 0, o.has_camera = 1;
    for (int turn = 0; turn < 6; turn++) {
      const double fov = turn % 3 == 0 ? 0 : turn % 3 == 1 ? 12 : 75;
      quoin_camera_fit(scene, (double)W / H, turn < 3 ? QUOIN_ORTHOGRAPHIC : QUOIN_PERSPECTIVE, fov, &o.camera);
      assert_true(o.camera.fov == (fov > 0 ? fov : 30));
      assert_int_equal(quoin_render(scene, &o, p, W * 4, NULL), QUOIN_OK);
      int left = W, right = -1, top = H, bottom = -1;
      for (int y = 0; y < H; y++) {
        for (int x = 0; x < W; x++) {
          if (p[(y * W + x) * 4]) {
            left = x < left ? x : left, right = x > right ? x : right, top = y < top ? y : top, bottom = y > bottom ? y : bottom;
          }
        }
      }
      const double wide = (right + 1.0 - left) / W, high = (bottom + 1.0 - top) / H, fill = wide > high ? wide : high;
      assert_true(fill > solids[k].least && fill < 0.92 + 2.0 / H);
      if (solids[k].least == 0.9) {
        assert_true(abs(left + right + 1 - W) <= 3 && abs(top + bottom + 1 - H) <= 3);
      } else {
        assert_true(left > 0 && right < W - 1 && top > 0 && bottom < H - 1);
      }
    }
    quoin_scene_free(scene);
  }
}

/* A bore's wall has the colour of what bored it; the rest has the block's. Seen through a slanted view of the bore from the
   front. */
static void cut_face_takes_the_cutter(void **state) {
  (void)state;
  enum { N = 16 };
  quoin_scene *scene = compile("background([0, 0, 0]); difference() { material(color = [1, 0, 0], " FLAT ") cube(12, center = true);"
                               "material(color = [0, 1, 0], " FLAT ") translate([0, -6, 0]) cube([6, 6, 6], center = true); }");
  const quoin_render_options o = front(N);
  unsigned char p[N * N * 4];
  assert_int_equal(quoin_render(scene, &o, p, N * 4, NULL), QUOIN_OK);
  for (int j = 0; j < N; j++) {
    for (int i = 0; i < N; i++) {
      const double x = fabs(i + 0.5 - N / 2), z = fabs(j + 0.5 - N / 2);
      assert_pixel(p + (j * N + i) * 4, x < 6 && z < 6 && !(x < 3 && z < 3) ? 255 : 0, x < 3 && z < 3 ? 255 : 0, 0);
    }
  }
  quoin_scene_free(scene);
}

/* A sun from above, a plate between it and the floor: seen from below the plate's height the floor in front has light 1
   where the sun reaches it and the ambient term in the plate's shadow. Plan view from above would hide it; so the sun comes
   aslant, by exactly 45 degrees. */
static void shadow_lies_where_it_must(void **state) {
  (void)state;
  enum { N = 32 };
  /* Looking along +y at the wall y = 0 (facing -y). The sun travels along (1, 1, 0): a bar at y = -8 .. -7, x = -6 .. -2,
     throws the shadow x = 1 .. 6 (edges -6 + 7 = 1 at its back left, -2 + 8 = 6 at its front right), over its height |z| <
     4. */
  static const char text[] = "background([0, 0, 0]); light(direction = [1, 1, 0], color = [1, 1, 1]);"
                             "material(color = [1, 1, 1], ambient = 0.25, diffuse = 0.5, specular = 0) {"
                             "translate([-20, 0, -20]) cube([40, 1, 40]); translate([-6, -8, -4]) cube([4, 1, 8]); }";
  quoin_scene *scene = compile(text);
  quoin_render_options o = front(N);
  unsigned char p[N * N * 4];
  qn_tone tone;
  qn_tone_make(&tone);
  const int dark = qn_tone_byte(&tone, 0.25), lit = qn_tone_byte(&tone, 0.25 + 0.5 * sqrt(0.5));
  for (int shadows = 0; shadows < 2; shadows++) {
    o.shadows = shadows;
    quoin_render_stats stats;
    assert_int_equal(quoin_render(scene, &o, p, N * 4, &stats), QUOIN_OK);
    assert_int_equal(stats.shadow_rays, shadows ? N * N : 0);
    for (int j = 0; j < N; j++) {
      for (int i = 0; i < N; i++) {
        const double x = i + 0.5 - N / 2, z = j + 0.5 - N / 2;
        const int shade = shadows && x > 1 && x < 6 && fabs(z) < 4;
        const int level = shade ? dark : lit; /* the bar's own front faces the sun as the wall does */
        assert_pixel(p + (j * N + i) * 4, level, level, level);
      }
    }
  }
  quoin_scene_free(scene);
}

/* No surface shadows itself: a ball of any size anywhere, lit from the eye's side by a lamp that is a place, has no dark
   pixel. */
static void no_specks(void **state) {
  (void)state;
  enum { N = 64 };
  static const char *const texts[] = {"sphere(20);", "translate([0, 40, 0]) rotate([17, 29, 3]) cube(30, center = true);",
                                      "translate([0, 20, -5]) rotate([70, 0, 20]) cylinder(h = 30, r1 = 20, r2 = 3);"};
  for (size_t k = 0; k < 3; k++) {
    char text[512];
    strcpy(text, "background([1, 1, 1]); light(at = [0, -32, 0], color = [1, 1, 1]);"
                 "material(color = [1, 1, 1], ambient = 0, diffuse = 1, specular = 0) ");
    strcat(text, texts[k]);
    quoin_scene *scene = compile(text);
    quoin_render_options o = front(N);
    o.camera.projection = QUOIN_PERSPECTIVE; /* the lamp is at the eye: what is seen is lit */
    static unsigned char p[N * N * 4];
    assert_int_equal(quoin_render(scene, &o, p, N * 4, NULL), QUOIN_OK);
    size_t seen = 0;
    for (size_t i = 0; i < N * N; i++) {
      assert_true(p[4 * i] > 0);
      seen += p[4 * i] < 255;
    }
    assert_true(seen > 200);
    quoin_scene_free(scene);
  }
}

/* The eye in the solid sees its wall from inside, lit from its side although the solid is around it. A near plane within the
   solid does the same. */
static void inside_walls(void **state) {
  (void)state;
  enum { N = 8 };
  quoin_scene *scene = compile("background([0, 0, 0]); light(direction = [0, 1, 0], color = [1, 1, 1]);"
                               "material(color = [1, 0.5, 0], ambient = 0, diffuse = 1, specular = 0) sphere(20);");
  quoin_render_options o = front(N);
  unsigned char p[N * N * 4];
  for (int near = 0; near < 2; near++) {
    o.camera.projection = QUOIN_PERSPECTIVE;
    o.camera.eye[1] = near ? -50 : 0;
    o.camera.look[1] = 10;
    o.camera.near = near ? 50 : 0;
    o.camera.fov = 20;
    assert_int_equal(quoin_render(scene, &o, p, N * 4, NULL), QUOIN_OK);
    for (size_t i = 0; i < N * N; i++) {
      assert_true(p[4 * i] > 60 && p[4 * i + 1] > 30 && p[4 * i + 2] == 0);
    }
  }
  quoin_scene_free(scene);
}

static void refused_arguments(void **state) {
  (void)state;
  quoin_scene *scene = compile("sphere(1);");
  unsigned char p[8 * 8 * 4];
  quoin_render_options o = front(8);
  assert_int_equal(quoin_render(NULL, &o, p, 32, NULL), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_render(scene, NULL, p, 32, NULL), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_render(scene, &o, NULL, 32, NULL), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_render(scene, &o, p, 31, NULL), QUOIN_E_ARGUMENT);
  o.width = 0;
  assert_int_equal(quoin_render(scene, &o, p, 32, NULL), QUOIN_E_ARGUMENT);
  o = front(8);
  o.antialias = 1;
  o.samples = 15;
  assert_int_equal(quoin_render(scene, &o, p, 32, NULL), QUOIN_E_ARGUMENT);
  o = front(8);
  o.camera.fov = 200;
  assert_int_equal(quoin_render(scene, &o, p, 32, NULL), QUOIN_E_ARGUMENT);
  quoin_scene_free(scene);
}

/* Empty solids give the background. */
static void empty_scene(void **state) {
  (void)state;
  quoin_scene *scene = compile("background([0, 1, 0]); difference() { cube(1); cube(1); }");
  quoin_render_options o = quoin_render_options_default();
  o.width = o.height = 8;
  unsigned char p[8 * 8 * 4];
  quoin_render_stats stats;
  assert_int_equal(quoin_render(scene, &o, p, 32, &stats), QUOIN_OK);
  for (size_t i = 0; i < 64; i++) {
    assert_pixel(p + 4 * i, 0, 255, 0);
  }
  assert_true(stats.camera_rays == 64 && stats.hits == 0);
  quoin_scene_free(scene);
}

typedef struct progress_log { double last; int calls, stop_at; } progress_log;
static int log_progress(void *user, double done) {
  progress_log *log = user;
  assert_true(done >= log->last && done <= 1);
  log->last = done;
  return ++log->calls == log->stop_at;
}

static void progress_and_cancelling(void **state) {
  (void)state;
  quoin_scene *scene = compile(scene_of_some_parts);
  quoin_render_options o = quoin_render_options_default();
  o.width = 128, o.height = 96;
  o.threads = 2;
  progress_log log = {0};
  o.progress = (quoin_progress){log_progress, &log};
  static unsigned char p[128 * 96 * 4];
  assert_int_equal(quoin_render(scene, &o, p, 128 * 4, NULL), QUOIN_OK);
  assert_true(log.calls > 0);
  log = (progress_log){.stop_at = 1};
  o.threads = 1;
  assert_int_equal(quoin_render(scene, &o, p, 128 * 4, NULL), QUOIN_E_CANCELLED);
  assert_int_equal(log.calls, 1);
  quoin_scene_free(scene);
}

/* An allocator that refuses the n-th request after it is armed, and counts what is in use. */
typedef struct stingy { size_t left; int armed; long in_use; } stingy;
static int refuses(stingy *s) {
  return s->armed && s->left-- == 0;
}
static void *stingy_alloc(void *user, size_t size) {
  stingy *s = user;
  void *p = refuses(s) ? NULL : malloc(size);
  s->in_use += p != NULL;
  return p;
}
static void *stingy_resize(void *user, void *block, size_t old_size, size_t new_size) {
  (void)old_size;
  return refuses(user) ? NULL : realloc(block, new_size);
}
static void stingy_release(void *user, void *block, size_t size) {
  (void)size;
  stingy *s = user;
  s->in_use--;
  free(block);
}

/* Whatever request is refused, the call says so, frees what it took, and the scene can be used again. */
static void memory_is_refused(void **state) {
  (void)state;
  stingy s = {0};
  const quoin_allocator allocator = {stingy_alloc, stingy_resize, stingy_release, &s, 0};
  quoin_scene *scene = compile_with(scene_of_some_parts, &allocator);
  quoin_render_options o = quoin_render_options_default();
  o.width = 40, o.height = 30;
  o.threads = 1;
  static unsigned char p[40 * 30 * 4];
  quoin_status status = QUOIN_E_MEMORY;
  size_t n = 0;
  assert_int_equal(quoin_render(scene, &o, p, 160, NULL), QUOIN_OK); /* what is made on demand and kept is made here */
  const long in_use = s.in_use;
  for (; status != QUOIN_OK && n < 100000; n++) {
    s.left = n;
    s.armed = 1;
    status = quoin_render(scene, &o, p, 160, NULL);
    s.armed = 0;
    assert_true(status == QUOIN_OK || status == QUOIN_E_MEMORY);
    assert_int_equal(s.in_use, in_use);
  }
  assert_int_equal(status, QUOIN_OK);
  assert_true(n > 4); /* several requests were refused before */
  quoin_scene_free(scene);
  assert_int_equal(s.in_use, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(outline_of_a_ball),         cmocka_unit_test(antialiased_edge), cmocka_unit_test(threads_do_not_show), cmocka_unit_test(machines_do_not_show), cmocka_unit_test(round_solids_are_framed),
    cmocka_unit_test(cut_face_takes_the_cutter), cmocka_unit_test(shadow_lies_where_it_must), cmocka_unit_test(no_specks),
    cmocka_unit_test(inside_walls),              cmocka_unit_test(refused_arguments), cmocka_unit_test(empty_scene),
    cmocka_unit_test(progress_and_cancelling),   cmocka_unit_test(memory_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
