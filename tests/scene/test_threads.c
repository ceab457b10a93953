/* A compiled scene is the same, byte by byte, for any number of threads, and what goes wrong on one of them ends the work as on one. */
#include "scene/reading.h"

#include <pthread.h>
#include <stdlib.h>

static uint64_t state = 271828;
static int in(int low, int high) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return low + (int)((state >> 33) % (uint64_t)(high - low + 1));
}

/* --- a model with something of everything, large enough that each part of the work is shared out ------------------------- */

static char *text;
static size_t at, room;
static void put(const char *format, ...) {
  va_list args;
  va_start(args, format);
  at += (size_t)vsnprintf(text + at, room - at, format, args);
  va_end(args);
  assert_true(at < room);
}

static void leaf(void) {
  put("translate([%d.%d, %d, %d]) ", in(-300, 300), in(0, 9), in(-300, 300), in(-300, 300));
  switch (in(0, 9) ? in(0, 2) : in(3, 6)) {
  case 0: case 1: put("sphere(r = %d.5);\n", in(1, 4)); break;
  case 2: put("cube([%d, %d, %d]);\n", in(1, 5), in(1, 5), in(1, 5)); break;
  case 3: put("rotate([%d, %d, 0]) cylinder(h = %d, r = 1);\n", in(0, 3) * 30, in(0, 2) * 45, in(1, 6)); break;
  case 4: put("name(\"n%d\") color([%d / 8, 0, 1]) cube(%d);\n", in(0, 99), in(0, 8), in(1, 3)); break;
  case 5: put("rotate([%d, 5, 7]) cube(2);\n", in(0, 360)); break;
  case 6: put("scale([1, %d, 1]) sphere(%d);\n", in(1, 3), in(1, 2)); break;
  }
}

/* parts: top-level things. meets: with differences and intersections in it; else a union of leaves. */
static void model_of(int parts, int meets) {
  room = (size_t)parts * 700 + 1000;
  text = malloc(room);
  assert_non_null(text);
  at = 0;
  put("halfspace(n = [0, 0, 1], d = -1000);\n");
  for (int i = 0; i < parts; i++) {
    if (!meets || in(0, 3)) {
      leaf();
      continue;
    }
    put(in(0, 1) ? "difference() { cube(%d); union() {\n" : "intersection() { cube(%d, center = true); union() {\n", in(300, 500));
    for (int n = in(1, 5); n > 0; n--) {
      leaf();
    }
    put("} }\n");
  }
}

static quoin_model *read_with(const quoin_allocator *a) {
  quoin_model *m;
  assert_int_equal(quoin_model_new(a, &m), QUOIN_OK);
  assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "t", text, at, NULL), QUOIN_OK);
  return m;
}

/* --- the same bytes ------------------------------------------------------------------------------------------------------ */

typedef struct output { char *text; size_t length, capacity; } output;
static int take(void *user, const char *piece, size_t length) {
  output *o = user;
  if (o->length + length > o->capacity) {
    o->capacity = 2 * (o->length + length);
    o->text = realloc(o->text, o->capacity);
    assert_non_null(o->text);
  }
  memcpy(o->text + o->length, piece, length);
  o->length += length;
  return 0;
}

#define SAME(array, count)                                             \
  do {                                                                 \
    assert_int_equal(a->count, b->count);                              \
    assert_memory_equal(a->array, b->array, a->count * sizeof *a->array); \
  } while (0)

static void same(const quoin_scene *a, const quoin_scene *b) {
  assert_int_equal(a->leaf_count, b->leaf_count);
  for (size_t i = 0; i < a->leaf_count; i++) {
    const qn_leaf *x = &a->leaves[i], *y = &b->leaves[i];
    assert_memory_equal(x->min, y->min, sizeof x->min);
    assert_memory_equal(x->max, y->max, sizeof x->max);
    assert_memory_equal(x->pivot, y->pivot, sizeof x->pivot);
    assert_true(x->half0 == y->half0 && x->gate == y->gate && x->material == y->material && x->negated == y->negated);
    assert_string_equal(quoin_part_name(a, (quoin_part)i), quoin_part_name(b, (quoin_part)i));
  }
  assert_int_equal(a->half_count, b->half_count);
  for (size_t i = 0; i < a->half_count; i++) {
    assert_true(a->halves[i].surface == b->halves[i].surface && a->halves[i].side == b->halves[i].side && a->halves[i].role == b->halves[i].role);
  }
  SAME(planes, plane_count);
  SAME(quadrics, quadric_count);
  SAME(unbounded, unbounded_count);
  SAME(bvh.nodes, bvh.node_count);
  SAME(bvh.items, bvh.item_count);
  SAME(normal.nodes, normal.node_count);
  SAME(normal.terms, normal.term_count);
  SAME(normal.leaves, normal.leaf_count);
  SAME(normal.lists, normal.list_count);
  SAME(normal.unions, normal.union_count);
  assert_int_equal(a->line_count, b->line_count);
  assert_memory_equal(a->lines, b->lines, a->line_count * 64);
  assert_memory_equal(a->line_of, b->line_of, a->leaf_count * sizeof *a->line_of);
  assert_int_equal(a->surface_count, b->surface_count);
  for (size_t i = 0; i < a->surface_count; i++) {
    assert_true(a->surfaces[i].leaf == b->surfaces[i].leaf && a->surfaces[i].half == b->surfaces[i].half && a->surfaces[i].users == b->surfaces[i].users);
  }
  output x = {0}, y = {0};
  assert_int_equal(quoin_scene_write_text(a, take, &x), QUOIN_OK);
  assert_int_equal(quoin_scene_write_text(b, take, &y), QUOIN_OK);
  assert_int_equal(x.length, y.length);
  assert_memory_equal(x.text, y.text, x.length);
  free(x.text), free(y.text);
}

static void any_number(void **unused) {
  (void)unused;
  for (int meets = 0; meets < 2; meets++) {
    model_of(meets ? 6000 : 36000, meets);
    quoin_model *m = read_with(NULL);
    quoin_scene *one, *other;
    quoin_compile_options o = quoin_compile_options_default();
    o.threads = 1;
    assert_int_equal(quoin_scene_compile(m, &o, &one), QUOIN_OK);
    assert_true(one->leaf_count > (meets ? 4000 : 35000) && one->surface_count + 1000 < one->half_count); /* some are shared */
    assert_true(meets ? one->program.gate_count > 500 && one->normal.union_count > 1 : one->program.gate_count == 1);
    for (o.threads = 2; o.threads <= 4; o.threads++) {
      assert_int_equal(quoin_scene_compile(m, &o, &other), QUOIN_OK);
      same(one, other);
      quoin_scene_free(other);
    }
    quoin_scene_free(one);
    quoin_model_free(m);
    free(text);
  }
}

/* --- what goes wrong ----------------------------------------------------------------------------------------------------- */

static void little_memory(void **unused) {
  (void)unused;
  model_of(3000, 1);
  quoin_model *m = read_with(NULL);
  quoin_scene *s;
  quoin_compile_options o = quoin_compile_options_default();
  o.threads = 4;
  size_t before = atomic_load(&m->mem.used), refused = 0, good = 0;
  for (size_t more = 10000; good == 0; more += more / 4) {
    m->mem.a.limit = before + more;
    quoin_status status = quoin_scene_compile(m, &o, &s);
    m->mem.a.limit = 0;
    if (status == QUOIN_OK) {
      good++;
      quoin_scene_free(s);
    } else {
      refused++;
      assert_int_equal(status, QUOIN_E_MEMORY);
      assert_null(s);
    }
    assert_int_equal(atomic_load(&m->mem.used), before);
  }
  assert_true(refused > 10);
  quoin_model_free(m);
  free(text);
}

typedef struct telling { double stop, last; size_t calls; pthread_t caller; } telling;
static int tell(void *user, double done) {
  telling *t = user;
  assert_true(pthread_equal(t->caller, pthread_self()));
  assert_true(done >= 0 && done <= 1);
  t->last = done > t->last ? done : t->last;
  t->calls++;
  return done >= t->stop;
}

static void cancelled(void **unused) {
  (void)unused;
  model_of(3000, 1);
  quoin_model *m = read_with(NULL);
  quoin_scene *s;
  size_t before = atomic_load(&m->mem.used);
  quoin_compile_options o = quoin_compile_options_default();
  o.threads = 4;
  for (double when = 0; when <= 1; when += 0.125) {
    telling t = {.stop = when, .caller = pthread_self()};
    o.progress = (quoin_progress){tell, &t};
    assert_int_equal(quoin_scene_compile(m, &o, &s), QUOIN_E_CANCELLED);
    assert_null(s);
    assert_true(t.last >= when);
    assert_int_equal(atomic_load(&m->mem.used), before);
  }
  telling t = {.stop = 2, .caller = pthread_self()};
  o.progress = (quoin_progress){tell, &t};
  assert_int_equal(quoin_scene_compile(m, &o, &s), QUOIN_OK);
  assert_true(t.last == 1 && t.calls > 2); /* between two stages, and as often as this thread has its turn among the four */
  quoin_scene_free(s);
  quoin_model_free(m);
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(any_number), cmocka_unit_test(little_memory), cmocka_unit_test(cancelled)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
