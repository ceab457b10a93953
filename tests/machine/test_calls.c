/* Each public call alone on a machine that refuses: a fresh model, scene and work, then the k-th allocation of the call refused, k = 1, 2, ... until none is
   left to refuse; and at random. A call that is refused says QUOIN_E_MEMORY and spoils nothing: the same call then gives the answer of one that was
   never refused, from the same objects. Whatever happens, every block is given back. */
#include "quoin/quoin.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const char text[] =
  "difference() { name(\"plate\") cube([4, 3, 1]); name(\"hole\") translate([1, 1, 0]) cylinder(h = 1, r = 0.5);\n"
  "  translate([3, 1, 0]) rotate(20) cylinder(h = 1, r = 0.3, $fn = 6); cube(0); }\n"
  "color(\"red\") translate([0, 0, 2]) sphere(1); translate([0, 0, 4.0000001]) sphere(1); translate([0, 3.00000001, 0]) cube(1);\n"
  "intersection() { saddle(1, 1); translate([5, 0, 0]) cube([2, 2, 2]); } translate([-3, 0, 0]) superquadric([1, 1, 1], 0.3, 1.7);\n"
  "camera(eye = [20, -30, 20], look = [0, 0, 1], fov = 35); light(at = [9, -9, 30]);\n";

/* --- an allocator that refuses ------------------------------------------------------------------------------------------------ */

typedef struct meter { size_t used, countdown, one_in, refusals; uint64_t dice; } meter;
static int refuses(meter *m) {
  m->dice ^= m->dice << 13, m->dice ^= m->dice >> 7, m->dice ^= m->dice << 17;
  if ((m->countdown && --m->countdown == 0) || (m->one_in && (m->dice >> 20) % m->one_in == 0)) {
    m->refusals++;
    return 1;
  }
  return 0;
}
static void *take(void *user, size_t size) {
  meter *m = user;
  void *block = refuses(m) ? NULL : malloc(size);
  m->used += block ? size : 0;
  return block;
}
static void *resize(void *user, void *block, size_t old_size, size_t new_size) {
  meter *m = user;
  void *moved = refuses(m) ? NULL : realloc(block, new_size);
  m->used += moved ? new_size - old_size : 0;
  return moved;
}
static void release(void *user, void *block, size_t size) {
  meter *m = user;
  m->used -= size;
  free(block);
}

/* --- the calls ------------------------------------------------------------------------------------------------------------------- */

typedef struct bench {
  quoin_model *model; /* read; frozen when there is a scene */
  quoin_scene *scene;
  quoin_work *work;
  meter *m;
} bench;
/* What a call answered, as a number of all its bytes. */
typedef uint64_t answer;
static void add(answer *a, const void *bytes, size_t n) {
  for (size_t i = 0; i < n; i++) {
    *a = (*a ^ ((const unsigned char *)bytes)[i]) * UINT64_C(0x100000001b3);
  }
}
static int write_to(void *user, const char *bytes, size_t n) {
  add(user, bytes, n);
  return 0;
}
static answer tree_of(const quoin_model *m) {
  answer a = 1;
  assert_int_equal(quoin_model_write_tree(m, write_to, &a), QUOIN_OK);
  return a;
}

enum { RAYS = 24, SIDE = 16 };
static quoin_ray rays[RAYS];
static const char *ray_texts[6 * RAYS];
static double points[3 * RAYS];
static const char *const touching[3] = {"0", "0", "3"};
static const char *const along[6] = {"0.1", "1e-3", "-9", "0", "0.1", "1"};

static void intervals(answer *a, const quoin_intervals *v) {
  const quoin_interval *lists[2] = {v->inside, v->boundary};
  const size_t counts[2] = {v->count, v->boundary_count};
  for (int k = 0; k < 2; k++) {
    for (size_t i = 0; i < counts[k]; i++) {
      const quoin_end *ends[2] = {&lists[k][i].enter, &lists[k][i].leave};
      for (int e = 0; e < 2; e++) {
        add(a, &ends[e]->t, sizeof ends[e]->t), add(a, &ends[e]->part, sizeof ends[e]->part), add(a, &ends[e]->role, sizeof ends[e]->role);
      }
    }
  }
  add(a, &v->contact_count, sizeof v->contact_count);
}
static int each(void *user, size_t i, const quoin_intervals *v) {
  add(user, &i, sizeof i);
  intervals(user, v);
  return 0;
}
static void near_rows(answer *a, const quoin_near_list *list) {
  for (size_t i = 0; i < quoin_near_count(list); i++) {
    quoin_near n;
    assert_int_equal(quoin_near_get(list, i, &n), QUOIN_OK);
    add(a, &n.gap, sizeof n.gap), add(a, n.exact, strlen(n.exact)), add(a, n.face[0].name, strlen(n.face[0].name)), add(a, n.face[1].name, strlen(n.face[1].name));
  }
}

#define CALL(name) static quoin_status name(bench *b, answer *a)
CALL(read_text) {
  quoin_status s = quoin_model_read_text(b->model, QUOIN_ROOT, "more", text, sizeof text - 1, NULL);
  if (s == QUOIN_OK) {
    b->m->countdown = b->m->one_in = 0; /* what follows is not the call that is tried */
    *a = tree_of(b->model);
  }
  return s;
}
CALL(read_errors) { /* a text with errors, every one told */
  static const char wrong[] = "cube(;\nfoo(1);\ncube([1, 2]);\nsphere(r = \"a\");\ncube(1/0);\nx = 1;\n";
  quoin_status s = quoin_model_read_text(b->model, QUOIN_ROOT, "wrong", wrong, sizeof wrong - 1, NULL);
  if (s == QUOIN_E_MODEL) {
    size_t n = quoin_model_diag_count(b->model), told = 0;
    for (size_t i = 0; i < n; i++) {
      quoin_diag d;
      assert_int_equal(quoin_model_diag(b->model, i, &d), QUOIN_OK);
      told += strcmp(d.file, "wrong") == 0;
      if (strcmp(d.file, "wrong") == 0) {
        add(a, d.problem, strlen(d.problem));
      }
    }
    return told > 3 ? QUOIN_OK : QUOIN_E_ARGUMENT;
  }
  return s;
}
CALL(build) {
  quoin_node n, child;
  const double v[12] = {1, 0, 0, 0.5, 0, 1, 0, 0.25, 0, 0, 1, 3};
  quoin_status s = quoin_add_boolean(b->model, QUOIN_ROOT, QUOIN_DIFFERENCE, &n);
  if (s == QUOIN_OK) {
    s = quoin_add_multmatrix(b->model, n, v, &child);
  }
  if (s == QUOIN_OK) {
    s = quoin_add_name(b->model, child, "part", &child);
  }
  if (s == QUOIN_OK) {
    s = quoin_add_rotate(b->model, child, v + 3, &child);
  }
  if (s == QUOIN_OK) {
    s = quoin_add_cylinder(b->model, child, 1, 0.1, 0.3, 1, NULL);
  }
  if (s == QUOIN_OK) {
    s = quoin_add_superquadric(b->model, n, v + 9, 0.5, 1.5, NULL);
  }
  if (s == QUOIN_OK) {
    s = quoin_add_quadric(b->model, n, v, NULL);
  }
  *a = 1;
  return s;
}
CALL(build_rest) { /* what build does not add, each below the one before as far as that is a transform */
  quoin_node n = QUOIN_ROOT;
  const double v[4] = {1, 0.5, 0.25, 1};
  static const double q[10] = {1, 1, 1, 0, 0, 0, 0, 0, 0, -1};
  quoin_status s = quoin_add_translate(b->model, n, v, &n);
  s = s == QUOIN_OK ? quoin_add_scale(b->model, n, v, &n) : s;
  s = s == QUOIN_OK ? quoin_add_color(b->model, n, v, &n) : s;
  s = s == QUOIN_OK ? quoin_add_sphere(b->model, n, 1, NULL) : s;
  s = s == QUOIN_OK ? quoin_add_ellipsoid(b->model, n, v, NULL) : s;
  s = s == QUOIN_OK ? quoin_add_cube(b->model, n, v, 0, NULL) : s;
  s = s == QUOIN_OK ? quoin_add_wedge(b->model, n, v, 1, NULL) : s;
  s = s == QUOIN_OK ? quoin_add_paraboloid(b->model, n, 1, 0.5, NULL) : s;
  s = s == QUOIN_OK ? quoin_add_hyperboloid(b->model, n, 1, 0.5, 0.25, NULL) : s;
  s = s == QUOIN_OK ? quoin_add_hyperboloid2(b->model, n, 1, 0.5, 0.25, NULL) : s;
  s = s == QUOIN_OK ? quoin_add_saddle(b->model, n, 1, 2, NULL) : s;
  s = s == QUOIN_OK ? quoin_add_halfspace(b->model, n, v, 3, NULL) : s;
  s = s == QUOIN_OK ? quoin_add_quadric(b->model, n, q, NULL) : s;
  *a = 1;
  return s;
}
CALL(model_new) {
  const quoin_allocator allocator = {take, resize, release, b->m, 0};
  quoin_model *model = NULL;
  quoin_status s = quoin_model_new(&allocator, &model);
  *a += model != NULL;
  assert_true((s == QUOIN_OK) == (model != NULL));
  quoin_model_free(model);
  return s;
}
static char file[] = "machine_calls_XXXXXX";
CALL(read_file) {
  quoin_status s = quoin_model_read_file(b->model, QUOIN_ROOT, file, NULL);
  if (s == QUOIN_OK) {
    b->m->countdown = b->m->one_in = 0;
    *a = tree_of(b->model);
  }
  return s;
}
CALL(write_tree) { return quoin_model_write_tree(b->model, write_to, a); }
CALL(compile) {
  quoin_scene *scene = NULL;
  quoin_status s = quoin_scene_compile(b->model, NULL, &scene);
  if (s == QUOIN_OK) {
    b->m->countdown = b->m->one_in = 0;
    assert_int_equal(quoin_scene_write_text(scene, write_to, a), QUOIN_OK);
  } else {
    assert_null(scene);
  }
  quoin_scene_free(scene);
  return s;
}
CALL(snap) {
  quoin_scene *scene = NULL;
  quoin_compile_options o = quoin_compile_options_default();
  o.snap = "1e-6", o.threads = 1;
  quoin_status s = quoin_scene_compile(b->model, &o, &scene);
  if (s == QUOIN_OK) {
    assert_int_equal(quoin_near_count(quoin_scene_snapped(scene)), 1);
    near_rows(a, quoin_scene_snapped(scene));
  }
  quoin_scene_free(scene);
  return s;
}
CALL(near_pairs) {
  quoin_near_list *list = NULL;
  quoin_status s = quoin_near_find(b->scene, NULL, &list);
  if (s == QUOIN_OK) {
    assert_true(quoin_near_count(list) > 0);
    near_rows(a, list);
  }
  quoin_near_free(list);
  return s;
}
CALL(scene_text) { return quoin_scene_write_text(b->scene, write_to, a); }
CALL(work_new) {
  quoin_work *work = NULL;
  quoin_status s = quoin_work_new(b->scene, &work);
  *a += work != NULL;
  quoin_work_free(work);
  return s;
}
CALL(point) {
  quoin_side side;
  quoin_status s = quoin_point_side(b->scene, b->work, (const double[3]){0, 0, 3}, &side);
  add(a, &side, s == QUOIN_OK ? sizeof side : 0);
  return s;
}
CALL(point_batch) {
  quoin_side sides[RAYS];
  quoin_status s = quoin_point_sides(b->scene, b->work, RAYS, points, sides);
  add(a, sides, s == QUOIN_OK ? sizeof sides : 0);
  return s;
}
CALL(point_text) {
  quoin_side side;
  quoin_part parts[8];
  size_t count = 0;
  quoin_status s = quoin_point_side_text(b->scene, b->work, touching, &side);
  if (s == QUOIN_OK) {
    s = quoin_point_parts_text(b->scene, b->work, touching, parts, 8, &count);
  }
  if (s == QUOIN_OK) {
    add(a, &side, sizeof side), add(a, parts, (count < 8 ? count : 8) * sizeof *parts);
  }
  return s;
}
CALL(point_texts) {
  quoin_side sides[2 * RAYS];
  size_t done = 0;
  quoin_status s = quoin_point_sides_text(b->scene, b->work, 2 * RAYS, ray_texts, sides, &done);
  assert_true(s != QUOIN_OK || done == 2 * RAYS);
  add(a, sides, s == QUOIN_OK ? sizeof sides : 0);
  return s;
}
CALL(point_parts) {
  quoin_part parts[8];
  size_t count = 0;
  quoin_status s = quoin_point_parts(b->scene, b->work, (const double[3]){0, 0, 3}, parts, 8, &count);
  add(a, parts, s == QUOIN_OK ? (count < 8 ? count : 8) * sizeof *parts : 0);
  return s;
}
CALL(ray) {
  for (int i = 0; i < RAYS; i++) {
    quoin_intervals v;
    quoin_status s = quoin_ray_intervals(b->scene, b->work, &rays[i], QUOIN_WANT_BOUNDARY | QUOIN_WANT_CONTACTS, &v);
    if (s != QUOIN_OK) {
      return s;
    }
    intervals(a, &v);
  }
  return QUOIN_OK;
}
CALL(ray_block) { return quoin_ray_intervals_many(b->scene, b->work, RAYS, rays, QUOIN_WANT_BOUNDARY, each, a); }
CALL(ray_text) {
  quoin_intervals v;
  quoin_status s = quoin_ray_intervals_text(b->scene, b->work, along, "-1.5", NULL, 0, &v);
  if (s == QUOIN_OK) {
    intervals(a, &v);
  }
  return s;
}
CALL(ray_texts_block) { return quoin_ray_intervals_many_text(b->scene, b->work, RAYS, ray_texts, NULL, "100", 0, each, a); }
CALL(hit) {
  quoin_hit got;
  quoin_status s = QUOIN_OK;
  for (int i = 0; i < RAYS && s == QUOIN_OK; i++) {
    s = quoin_first_hit(b->scene, b->work, &rays[i], &got);
    add(a, &got.t, s == QUOIN_OK ? sizeof got.t : 0);
  }
  return s;
}
CALL(hits) {
  quoin_hit got[RAYS];
  quoin_status s = quoin_first_hits(b->scene, b->work, RAYS, rays, got);
  for (int i = 0; i < RAYS && s == QUOIN_OK; i++) {
    add(a, &got[i].t, sizeof got[i].t), add(a, got[i].normal, sizeof got[i].normal), add(a, &got[i].part, sizeof got[i].part);
  }
  return s;
}
CALL(spots) {
  quoin_spot got[RAYS];
  quoin_status s = quoin_first_spots(b->scene, b->work, RAYS, rays, QUOIN_WANT_T, got);
  for (int i = 0; i < RAYS && s == QUOIN_OK; i++) {
    add(a, &got[i].t, sizeof got[i].t), add(a, &got[i].surface, sizeof got[i].surface);
  }
  return s;
}
CALL(blocked) {
  uint8_t got[RAYS];
  quoin_status s = quoin_rays_blocked(b->scene, b->work, RAYS, rays, NULL, got);
  add(a, got, s == QUOIN_OK ? sizeof got : 0);
  return s;
}
CALL(grid) {
  quoin_spot got[SIDE * SIDE];
  const quoin_grid g = {{-8, -8, 9}, {20, 0, 0}, {0, 12, 0}, {0.125, 0.25, -1}, SIDE, SIDE, 0, 0, HUGE_VAL};
  quoin_status s = quoin_grid_hits(b->scene, b->work, &g, 0, 0, SIDE, SIDE, QUOIN_WANT_T, got);
  for (int i = 0; i < SIDE * SIDE && s == QUOIN_OK; i++) {
    add(a, &got[i].t, sizeof got[i].t), add(a, &got[i].surface, sizeof got[i].surface);
  }
  return s;
}
CALL(grid_intervals) {
  const quoin_grid g = {{-8, -8, 9}, {20, 0, 0}, {0, 12, 0}, {0.125, 0.25, -1}, SIDE, SIDE, 0, 0, HUGE_VAL};
  quoin_grid_answer got;
  quoin_status s = quoin_grid_intervals(b->scene, b->work, &g, 0, 0, SIDE, SIDE, QUOIN_WANT_BOUNDARY, &got);
  for (size_t i = 0; s == QUOIN_OK && i < got.rays; i++) {
    const quoin_intervals v = {.count = got.inside_of[i].count, .inside = got.inside + got.inside_of[i].first,
                               .boundary_count = got.boundary_of[i].count, .boundary = got.boundary_count ? got.boundary + got.boundary_of[i].first : NULL};
    intervals(a, &v);
  }
  return s;
}
CALL(render) {
  unsigned char pixels[4 * SIDE * SIDE];
  quoin_render_options o = quoin_render_options_default();
  o.width = o.height = SIDE, o.samples = 4, o.threads = 1;
  quoin_status s = quoin_render(b->scene, &o, pixels, 4 * SIDE, NULL);
  add(a, pixels, s == QUOIN_OK ? sizeof pixels : 0);
  return s;
}

/* --- each alone -------------------------------------------------------------------------------------------------------------------- */

enum { MODEL, SCENE, WORK };
static const struct { const char *name; int needs; int allocates; quoin_status (*run)(bench *, answer *); } calls[] = {
  {"read_text", MODEL, 1, read_text}, {"read_errors", MODEL, 1, read_errors}, {"build", MODEL, 0, build},
  {"build_rest", MODEL, 0, build_rest}, {"model_new", MODEL, 1, model_new}, {"read_file", MODEL, 1, read_file}, {"write_tree", MODEL, 1, write_tree},
  {"compile", MODEL, 1, compile}, {"snap", MODEL, 1, snap}, {"near_find", SCENE, 1, near_pairs}, {"scene_write_text", SCENE, 1, scene_text},
  {"work_new", SCENE, 1, work_new}, {"point_side", WORK, 0, point}, {"point_sides", WORK, 0, point_batch}, {"point_side_text", WORK, 0, point_text},
  {"point_sides_text", WORK, 0, point_texts}, {"point_parts", WORK, 0, point_parts}, {"ray_intervals", WORK, 1, ray}, {"ray_intervals_many", WORK, 1, ray_block},
  {"ray_intervals_text", WORK, 0, ray_text}, {"ray_intervals_many_text", WORK, 1, ray_texts_block}, {"first_hit", WORK, 0, hit}, {"first_hits", WORK, 1, hits},
  {"first_spots", WORK, 1, spots}, {"rays_blocked", WORK, 1, blocked}, {"grid_hits", WORK, 1, grid}, {"grid_intervals", WORK, 1, grid_intervals}, {"render", SCENE, 1, render},
};
enum { CALLS = sizeof calls / sizeof *calls };

static void open_bench(meter *m, int needs, bench *b) {
  const quoin_allocator allocator = {take, resize, release, m, 0};
  *b = (bench){.m = m};
  assert_int_equal(quoin_model_new(&allocator, &b->model), QUOIN_OK);
  assert_int_equal(quoin_model_read_text(b->model, QUOIN_ROOT, "test", text, sizeof text - 1, NULL), QUOIN_OK);
  quoin_compile_options o = quoin_compile_options_default();
  o.threads = 1;
  if (needs >= SCENE) {
    assert_int_equal(quoin_scene_compile(b->model, &o, &b->scene), QUOIN_OK);
  }
  if (needs >= WORK) {
    assert_int_equal(quoin_work_new(b->scene, &b->work), QUOIN_OK);
  }
}
static void close_bench(meter *m, bench *b) {
  quoin_work_free(b->work);
  quoin_scene_free(b->scene);
  quoin_model_free(b->model);
  assert_int_equal(m->used, 0);
}

/* Runs call i with the meter so set; 0 when nothing was refused. *failed: it was not done. */
static int refused_once(size_t i, const meter *set, answer want, int *failed) {
  meter m = {.dice = set->dice};
  bench b;
  open_bench(&m, calls[i].needs, &b);
  const answer before = calls[i].needs == MODEL ? tree_of(b.model) : 0;
  m.countdown = set->countdown, m.one_in = set->one_in;
  answer got = 1;
  quoin_status s = calls[i].run(&b, &got);
  m.countdown = m.one_in = 0;
  *failed = s != QUOIN_OK;
  if (*failed) {
    if (s != QUOIN_E_MEMORY || m.refusals == 0) {
      fail_msg("%s, allocation %zu (one in %zu): status %d", calls[i].name, set->countdown, set->one_in, (int)s);
    }
    if (calls[i].run == read_text || calls[i].run == read_errors || calls[i].run == read_file || calls[i].run == compile) {
      assert_true(tree_of(b.model) == before); /* no effect */
    }
    got = 1;
    s = calls[i].run(&b, &got);
  }
  if (s != QUOIN_OK || got != want) {
    fail_msg("%s after allocation %zu (one in %zu): status %d, %s answer", calls[i].name, set->countdown, set->one_in, (int)s, got == want ? "the same" : "another");
  }
  close_bench(&m, &b);
  return m.refusals > 0;
}

static void each_call(void **state) {
  (void)state;
  for (size_t i = 0; i < CALLS; i++) {
    meter m = {.dice = 1};
    bench b;
    open_bench(&m, calls[i].needs, &b);
    answer want = 1;
    assert_int_equal(calls[i].run(&b, &want), QUOIN_OK);
    close_bench(&m, &b);
    size_t refusals = 0, failures = 0;
    int failed;
    for (size_t k = 1; refused_once(i, &(meter){.countdown = k, .dice = 1}, want, &failed); k++) {
      refusals++, failures += failed;
    }
    size_t random = 0;
    for (uint64_t seed = 1; seed <= 20; seed++) {
      static const size_t chances[] = {2, 3, 10, 40, 200};
      refused_once(i, &(meter){.one_in = chances[seed % 5], .dice = seed * UINT64_C(0x9e3779b97f4a7c15)}, want, &failed);
      random += (size_t)failed;
    }
    print_message("%-24s %4zu allocations, refused each: %4zu failures; 20 runs at random: %zu\n", calls[i].name, refusals, failures, random);
    assert_true(!calls[i].allocates || (failures > 0 && random > 0));
  }
}

int main(void) {
  static char words[6 * RAYS][24];
  for (int i = 0; i < RAYS; i++) {
    rays[i] = (quoin_ray){.o = {0.5 * (7 * i % 11) - 1, 0.5 * (5 * i % 11) - 0.5, 0.25 * (3 * i % 11)},
                          .d = {i % 3 - 1, i % 2, i % 5 == 0 ? 0.5 : 1}, .from = -HUGE_VAL, .to = HUGE_VAL};
    for (int k = 0; k < 6; k++) {
      snprintf(words[6 * i + k], sizeof *words, "%.17g", k < 3 ? rays[i].o[k] + 0.1 * (i % 2) : rays[i].d[k - 3]);
      ray_texts[6 * i + k] = words[6 * i + k];
    }
    memcpy(points + 3 * i, rays[i].o, sizeof rays[i].o);
  }
  int made = mkstemp(file);
  if (made < 0 || write(made, text, sizeof text - 1) != (ssize_t)(sizeof text - 1) || close(made)) {
    perror(file);
    return 1;
  }
  const struct CMUnitTest tests[] = {cmocka_unit_test(each_call)};
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  unlink(file);
  return failed;
}
