/* The promises of the public interface, from text to picture, that no single station can show: each allocation of the whole way
   refused once in turn, which gives a status or the same answer, and loses nothing; long work stopped at each of its reports; one
   frozen scene asked by several threads at once. */
#include "quoin/quoin.h"

#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* Coplanar caps, tangent balls, a rotation without exact sines, a superquadric, empty and absent parts. */
static const char text[] =
  "difference() { name(\"plate\") cube([4, 3, 1]); name(\"hole\") translate([1, 1, 0]) cylinder(h = 1, r = 0.5);\n"
  "  translate([3, 1, 0]) rotate(20) cylinder(h = 1, r = 0.3, $fn = 6); cube(0); }\n"
  "color(\"red\") translate([0, 0, 2]) sphere(1); translate([0, 0, 4]) sphere(1);\n"
  "intersection() { saddle(1, 1); translate([5, 0, 0]) cube([2, 2, 2]); }\n"
  "translate([-3, 0, 0]) superquadric([1, 1, 1], 0.3, 1.7); hyperboloid(base = [-6, 0, 0], axis = [1, 1, 1], r = 2, rc = 1, h = 1.5);\n"
  "polyhedron([[9, 0, 0], [10, 0, 0], [9, 1, 0], [9, 0, 1]], [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]);\n"
  "camera(eye = [20, -30, 20], look = [0, 0, 1], fov = 35); light(at = [9, -9, 30]);\n";

/* --- an allocator that refuses the request of one number, and counts what is in use; any thread may use it ---------------------- */

typedef struct meter {
  pthread_mutex_t lock;
  size_t used, countdown; /* countdown 0: refuse nothing */
  int refused;
} meter;

static int meter_refuses(meter *m) {
  if (m->countdown && --m->countdown == 0) {
    m->refused = 1;
    return 1;
  }
  return 0;
}
static void *meter_alloc(void *user, size_t size) {
  meter *m = user;
  pthread_mutex_lock(&m->lock);
  void *block = meter_refuses(m) ? NULL : malloc(size);
  m->used += block ? size : 0;
  pthread_mutex_unlock(&m->lock);
  return block;
}
static void *meter_resize(void *user, void *block, size_t old_size, size_t new_size) {
  meter *m = user;
  pthread_mutex_lock(&m->lock);
  void *moved = meter_refuses(m) ? NULL : realloc(block, new_size);
  m->used += moved ? new_size - old_size : 0;
  pthread_mutex_unlock(&m->lock);
  return moved;
}
static void meter_release(void *user, void *block, size_t size) {
  meter *m = user;
  pthread_mutex_lock(&m->lock);
  m->used -= size;
  pthread_mutex_unlock(&m->lock);
  free(block);
}

/* --- the whole way ----------------------------------------------------------------------------------------------------------------- */

enum { POINTS = 40, RAYS = 40, COLUMNS = 24, ROWS = 16 };
typedef struct answers {
  size_t leaves, surfaces, distinct;
  quoin_side side[POINTS], decimal;
  size_t holders;
  size_t inside[RAYS], boundary[RAYS], contacts[RAYS];
  double sum[RAYS];
  quoin_hit hit[RAYS];
  quoin_spot spot[COLUMNS * ROWS];
  unsigned char pixels[COLUMNS * ROWS * 4];
} answers;

static double point_of(int i, int axis) { /* -1 to 4, -0.5 to 4.5, 0 to 2.5 in halves and quarters */
  return axis == 0 ? 0.5 * (7 * i % 11) - 1 : axis == 1 ? 0.5 * (5 * i % 11) - 0.5 : 0.25 * (3 * i % 11);
}

static quoin_status ask_all(const quoin_scene *scene, unsigned threads, answers *a) {
  quoin_scene_info info;
  quoin_scene_get_info(scene, &info);
  a->leaves = info.leaves, a->surfaces = info.surfaces, a->distinct = info.distinct_surfaces;
  quoin_work *work = NULL;
  quoin_status status = quoin_work_new(scene, &work);
  double points[3 * POINTS];
  for (int i = 0; i < 3 * POINTS; i++) {
    points[i] = point_of(i / 3, i % 3);
  }
  if (status == QUOIN_OK) {
    status = quoin_point_sides(scene, work, POINTS, points, a->side);
  }
  static const char *const touching[3] = {"0", "0", "3"}; /* of the two spheres */
  if (status == QUOIN_OK) {
    status = quoin_point_side_text(scene, work, touching, &a->decimal);
  }
  quoin_part parts[8];
  if (status == QUOIN_OK) {
    status = quoin_point_parts_text(scene, work, touching, parts, 8, &a->holders);
  }
  const double inf = strtod("inf", NULL);
  quoin_ray rays[RAYS];
  for (int i = 0; i < RAYS; i++) {
    rays[i] = (quoin_ray){.o = {point_of(i, 0), point_of(i, 1), point_of(i, 2)}, .d = {i % 3 - 1, i % 2, i % 5 == 0 ? 0.5 : i % 3 == 1}, .from = -inf, .to = inf};
    if (rays[i].d[0] == 0 && rays[i].d[1] == 0 && rays[i].d[2] == 0) {
      rays[i].d[2] = 1;
    }
  }
  for (int i = 0; i < RAYS && status == QUOIN_OK; i++) {
    quoin_intervals got;
    status = quoin_ray_intervals(scene, work, &rays[i], QUOIN_WANT_BOUNDARY | QUOIN_WANT_CONTACTS, &got);
    if (status == QUOIN_OK) {
      a->inside[i] = got.count, a->boundary[i] = got.boundary_count, a->contacts[i] = got.contact_count;
      a->sum[i] = 0;
      for (size_t k = 0; k < got.count; k++) {
        a->sum[i] += isfinite(got.inside[k].enter.t) ? got.inside[k].enter.t : 0;
        a->sum[i] += isfinite(got.inside[k].leave.t) ? got.inside[k].leave.t : 0;
      }
    }
  }
  if (status == QUOIN_OK) {
    status = quoin_first_hits(scene, work, RAYS, rays, a->hit);
  }
  const quoin_grid grid = {{-8, -8, 9}, {20, 0, 0}, {0, 12, 0}, {0.125, 0.25, -1}, COLUMNS, ROWS, 0, 0, inf};
  if (status == QUOIN_OK) {
    status = quoin_grid_hits(scene, work, &grid, 0, 0, COLUMNS, ROWS, QUOIN_WANT_T, a->spot);
  }
  quoin_work_free(work);
  quoin_render_options o = quoin_render_options_default();
  o.width = COLUMNS, o.height = ROWS, o.threads = threads, o.samples = 4;
  return status == QUOIN_OK ? quoin_render(scene, &o, a->pixels, (size_t)4 * COLUMNS, NULL) : status;
}

static quoin_status the_whole_way(const quoin_allocator *allocator, unsigned threads, answers *a) {
  quoin_model *model = NULL;
  quoin_scene *scene = NULL;
  quoin_compile_options o = quoin_compile_options_default();
  o.threads = threads;
  quoin_status status = quoin_model_new(allocator, &model);
  if (status == QUOIN_OK) {
    status = quoin_model_read_text(model, QUOIN_ROOT, "test", text, sizeof text - 1, NULL);
  }
  if (status == QUOIN_OK) {
    status = quoin_scene_compile(model, &o, &scene);
  }
  quoin_model_free(model);
  if (status == QUOIN_OK) {
    status = ask_all(scene, threads, a);
  }
  quoin_scene_free(scene);
  return status;
}

static void same_answers(const answers *a, const answers *b) {
  assert_true(a->leaves == b->leaves && a->surfaces == b->surfaces && a->distinct == b->distinct);
  assert_true(a->decimal == b->decimal && a->holders == b->holders);
  assert_memory_equal(a->side, b->side, sizeof a->side);
  assert_memory_equal(a->inside, b->inside, sizeof a->inside);
  assert_memory_equal(a->boundary, b->boundary, sizeof a->boundary);
  assert_memory_equal(a->contacts, b->contacts, sizeof a->contacts);
  assert_memory_equal(a->sum, b->sum, sizeof a->sum);
  for (int i = 0; i < RAYS; i++) { /* not as bytes: there is padding */
    const quoin_hit *x = &a->hit[i], *y = &b->hit[i];
    assert_true(x->found == y->found && x->leaving == y->leaving && x->part == y->part && x->role == y->role);
    assert_memory_equal(&x->t, &y->t, sizeof x->t);
    assert_memory_equal(x->normal, y->normal, sizeof x->normal);
    assert_memory_equal(x->uv, y->uv, sizeof x->uv);
  }
  for (int i = 0; i < COLUMNS * ROWS; i++) {
    assert_true(a->spot[i].surface == b->spot[i].surface && a->spot[i].leaving == b->spot[i].leaving);
    assert_memory_equal(&a->spot[i].t, &b->spot[i].t, sizeof a->spot[i].t);
  }
  assert_memory_equal(a->pixels, b->pixels, sizeof a->pixels);
}

static answers reference;
static int setup(void **state) {
  (void)state;
  return the_whole_way(NULL, 1, &reference) != QUOIN_OK;
}

static void the_reference_is_not_trivial(void **state) {
  (void)state;
  size_t inside = 0, boundary = 0, sides[3] = {0}, hits = 0, spots = 0;
  for (int i = 0; i < RAYS; i++) {
    inside += reference.inside[i], boundary += reference.boundary[i], hits += reference.hit[i].found != 0;
  }
  for (int i = 0; i < POINTS; i++) {
    sides[reference.side[i]]++;
  }
  for (int i = 0; i < COLUMNS * ROWS; i++) {
    spots += reference.spot[i].surface != QUOIN_NO_SURFACE;
  }
  print_message("%zu stretches inside, %zu in the boundary, %zu hits, %zu spots, sides %zu %zu %zu\n", inside, boundary, hits, spots, sides[0],
                sides[1], sides[2]);
  assert_true(inside > 10 && boundary > 0 && hits > 10 && spots > 30 && spots < COLUMNS * ROWS);
  assert_true(sides[QUOIN_INSIDE] && sides[QUOIN_BOUNDARY] && sides[QUOIN_OUTSIDE]);
  assert_int_equal(reference.decimal, QUOIN_BOUNDARY);
  assert_int_equal(reference.holders, 2);
}

static void sweep(unsigned threads, size_t first_step) {
  size_t refusals = 0, absorbed = 0;
  for (size_t k = 1, step = first_step;; k += step) {
    meter m = {.lock = PTHREAD_MUTEX_INITIALIZER, .countdown = k};
    const quoin_allocator allocator = {meter_alloc, meter_resize, meter_release, &m, 0};
    static answers got;
    const quoin_status status = the_whole_way(&allocator, threads, &got);
    assert_int_equal(m.used, 0);
    if (status == QUOIN_OK) {
      same_answers(&got, &reference);
      if (!m.refused) {
        break;
      }
      absorbed++;
    } else {
      assert_int_equal(status, QUOIN_E_MEMORY);
      assert_true(m.refused);
      refusals++;
    }
  }
  print_message("%u threads: %zu refusals, %zu of them did no harm\n", threads, refusals + absorbed, absorbed);
  assert_true(refusals > 100 / first_step);
}
static void each_allocation_refused(void **state) {
  (void)state;
  sweep(1, 1);
}
static void each_allocation_refused_on_three_threads(void **state) {
  (void)state;
  sweep(3, 3);
}

/* --- progress ---------------------------------------------------------------------------------------------------------------------- */

typedef struct watch {
  pthread_t caller;
  size_t calls, stop_at; /* stop_at 0: never */
  double last;
} watch;
static int on_progress(void *user, double done) {
  watch *w = user;
  assert_true(pthread_equal(w->caller, pthread_self()));
  assert_true(done >= w->last && done <= 1);
  w->last = done;
  return ++w->calls == w->stop_at;
}

static void work_stops_at_any_report(void **state) {
  (void)state;
  size_t stopped_compiling = 0, stopped_drawing = 0;
  for (size_t stop = 1;; stop++) {
    meter m = {.lock = PTHREAD_MUTEX_INITIALIZER};
    const quoin_allocator allocator = {meter_alloc, meter_resize, meter_release, &m, 0};
    quoin_model *model = NULL;
    quoin_scene *scene = NULL;
    assert_int_equal(quoin_model_new(&allocator, &model), QUOIN_OK);
    assert_int_equal(quoin_model_read_text(model, QUOIN_ROOT, "test", text, sizeof text - 1, NULL), QUOIN_OK);
    watch w = {.caller = pthread_self(), .stop_at = stop};
    quoin_compile_options c = {.threads = 2, .progress = {on_progress, &w}};
    quoin_status status = quoin_scene_compile(model, &c, &scene);
    if (status == QUOIN_E_CANCELLED) {
      stopped_compiling++;
      assert_null(scene);
      assert_int_equal(quoin_scene_compile(model, NULL, &scene), QUOIN_OK); /* stopping spoils nothing */
    } else {
      assert_int_equal(status, QUOIN_OK);
      assert_true(w.calls < stop);
    }
    quoin_model_free(model);
    w = (watch){.caller = pthread_self(), .stop_at = stop};
    quoin_render_options o = quoin_render_options_default();
    o.width = 200, o.height = 150, o.threads = 3;
    o.progress = (quoin_progress){on_progress, &w};
    static unsigned char pixels[200 * 150 * 4];
    const quoin_status drawn = quoin_render(scene, &o, pixels, 800, NULL);
    if (drawn == QUOIN_E_CANCELLED) {
      stopped_drawing++;
    } else {
      assert_int_equal(drawn, QUOIN_OK);
      assert_true(w.calls < stop);
    }
    quoin_scene_free(scene);
    assert_int_equal(m.used, 0);
    if (status == QUOIN_OK && drawn == QUOIN_OK) {
      break;
    }
  }
  assert_true(stopped_compiling > 0 && stopped_drawing > 1);
}

/* --- threads ----------------------------------------------------------------------------------------------------------------------- */

typedef struct asker {
  const quoin_scene *scene;
  pthread_barrier_t *start;
  quoin_status status;
  answers got;
} asker;
static void *asking(void *user) {
  asker *a = user;
  pthread_barrier_wait(a->start);
  a->status = ask_all(a->scene, 1, &a->got);
  return NULL;
}
static void threads_share_a_scene(void **state) {
  (void)state;
  enum { THREADS = 6 };
  for (int round = 0; round < 5; round++) {
    quoin_model *model = NULL;
    quoin_scene *scene = NULL; /* a new one each time, so that whatever is made on first use is made under competition */
    assert_int_equal(quoin_model_new(NULL, &model), QUOIN_OK);
    assert_int_equal(quoin_model_read_text(model, QUOIN_ROOT, "test", text, sizeof text - 1, NULL), QUOIN_OK);
    assert_int_equal(quoin_scene_compile(model, NULL, &scene), QUOIN_OK);
    quoin_model_free(model);
    pthread_barrier_t start;
    pthread_barrier_init(&start, NULL, THREADS);
    pthread_t thread[THREADS];
    static asker askers[THREADS];
    for (int i = 0; i < THREADS; i++) {
      askers[i].scene = scene, askers[i].start = &start;
      assert_int_equal(pthread_create(&thread[i], NULL, asking, &askers[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
      pthread_join(thread[i], NULL);
      assert_int_equal(askers[i].status, QUOIN_OK);
      same_answers(&askers[i].got, &reference);
    }
    pthread_barrier_destroy(&start);
    quoin_scene_free(scene);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_reference_is_not_trivial), cmocka_unit_test(each_allocation_refused),
    cmocka_unit_test(each_allocation_refused_on_three_threads), cmocka_unit_test(work_stops_at_any_report), cmocka_unit_test(threads_share_a_scene),
  };
  return cmocka_run_group_tests(tests, setup, NULL);
}
