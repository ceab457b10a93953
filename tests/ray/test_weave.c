/* The weave's other duties: whose ends are named, ranges, surfaces made equal by S2, superquadrics, want of memory. */
#include "rays.h"

static uint64_t seed = 0x2545f4914f6cdd1du;
static uint64_t next(void) {
  seed ^= seed << 13;
  seed ^= seed >> 7;
  seed ^= seed << 17;
  return seed;
}
static int64_t below(int64_t n) { return (int64_t)(next() % (uint64_t)n); }

/* Names of ends: the leaf and the half-space that make each. */
static void test_ends(void **state) {
  (void)state;
  stage st = stage_open("difference() { cube(3); translate([1, 1, -1]) cylinder(h = 5, r = 0.5); }");
  qn_line line;
  const double o[3] = {-1, 1, 1}, d[3] = {1, 0, 0};
  qn_scratch_begin(st.scratch);
  qn_line_from_doubles(o, d, &line);
  qn_woven w;
  assert_int_equal(qn_weave(st.scene, st.scratch, &line, &WHOLE_LINE, 0, &w), QUOIN_OK);
  assert_int_equal(w.inside_count, 2);
  const qn_half *halves = st.scene->halves;
  assert_int_equal(w.inside[0].enter.leaf, 0);
  assert_true(halves[w.inside[0].enter.half].role >= QUOIN_FACE);
  assert_int_equal(w.inside[0].leave.leaf, 1);
  assert_int_equal(halves[w.inside[0].leave.half].role, QUOIN_BODY);
  assert_int_equal(w.inside[1].enter.leaf, 1);
  assert_int_equal(halves[w.inside[1].enter.half].role, QUOIN_BODY);
  assert_int_equal(w.inside[1].leave.leaf, 0);
  /* the ray's ends have no leaf, unless a surface is right there */
  qn_range part = WHOLE_LINE;
  part.from.t = 1.25;
  part.to.t = 4;
  assert_int_equal(qn_weave(st.scene, st.scratch, &line, &part, 0, &w), QUOIN_OK);
  assert_int_equal(w.inside_count, 2);
  assert_int_equal(w.inside[0].enter.leaf, UINT32_MAX);
  assert_true(w.inside[0].enter.place.t == 1.25 && w.inside[0].enter.place.e == 0);
  assert_int_equal(w.inside[1].leave.leaf, 0);
  /* the same range as a rational that is no double */
  part.from.t = 1.3;
  part.from.e = 0x1p-52;
  part.from.num = qn_int_from(qn_scratch_ctx(st.scratch), 13);
  part.from.den = qn_int_from(qn_scratch_ctx(st.scratch), 10);
  assert_int_equal(qn_weave(st.scene, st.scratch, &line, &part, 0, &w), QUOIN_OK);
  assert_true(qn_place_round(st.scene, st.scratch, &line, &w.inside[0].enter.place) == 1.3);
  /* an end of one stretch is a place to begin at */
  qn_place here = w.inside[0].leave.place;
  part.from = here;
  part.to = WHOLE_LINE.to;
  assert_int_equal(qn_weave(st.scene, st.scratch, &line, &part, 0, &w), QUOIN_OK);
  assert_int_equal(w.inside_count, 1);
  assert_int_equal(qn_place_cmp(st.scene, st.scratch, &line, &here, &w.inside[0].enter.place), -1);
  assert_int_equal(qn_place_cmp(st.scene, st.scratch, &line, &w.inside[0].enter.place, &w.inside[0].enter.place), 0);
  stage_close(&st);
}

/* Ends at one place: which leaf is named, and that a range that begins in a wall that is none begins inside. */
static void test_shared_ends(void **state) {
  (void)state;
  static const struct { const char *model; double from; uint32_t enter, leave; } asked[] = {
    {"intersection() { cube(1); cube([1, 2, 2]); }", -HUGE_VAL, 1, 0},            /* the second makes it true, the first makes it false */
    {"cube(1); cube([1, 2, 2]);", -HUGE_VAL, 0, 1},
    {"difference() { cube([2, 1, 1]); translate([1, 0, 0]) cube(3); }", -HUGE_VAL, 0, 1},
    {"cube(1); translate([1, 0, 0]) cube(1);", -HUGE_VAL, 0, 1},
    {"cube(1); translate([1, 0, 0]) cube(1);", 2, UINT32_MAX, 1},                 /* t = 2 is x = 1: no wall */
    {"translate([1, 0, 0]) cube(1);", 2, 0, 0},                                   /* a wall */
    {"difference() { cube([3, 1, 1]); cube(1); }", 2, 1, 0},
  };
  for (size_t i = 0; i < sizeof asked / sizeof *asked; i++) {
    stage st = stage_open(asked[i].model);
    const double o[3] = {-1, 0.5, 0.5}, d[3] = {1, 0, 0};
    qn_range part = WHOLE_LINE;
    part.from.t = asked[i].from;
    qn_line line;
    qn_scratch_begin(st.scratch);
    qn_line_from_doubles(o, d, &line);
    qn_woven w;
    assert_int_equal(qn_weave(st.scene, st.scratch, &line, &part, 0, &w), QUOIN_OK);
    assert_int_equal(w.inside_count, 1);
    assert_int_equal(w.inside[0].enter.leaf, asked[i].enter);
    assert_int_equal(w.inside[0].leave.leaf, asked[i].leave);
    stage_close(&st);
  }
}

/* S2: what irrational rotations make equal is equal on every line. */
static void test_rounded_scenes(void **state) {
  (void)state;
  static const struct { const char *model; int most; } asked[] = { /* most: stretches of a line */
    {"difference() { cube(1, center = true); rotate(a = 120, v = [1, 1, 1]) cube(1, center = true); }", 0},
    {"difference() { rotate(90) { cylinder(h = 1, r = 0.4); cube(0.7); } rotate(30) rotate(60) { cylinder(h = 1, r = 0.4); cube(0.7); } }", 0},
    {"rotate([10, 20, 30]) intersection() { cube(1); translate([1, 0, 0]) cube(1); }", 0},
    {"rotate([10, 20, 30]) { cube(1); translate([-1, 0, 0]) cube(1); }", 1},
    {"rotate([10, 20, 30]) difference() { cube(1); translate([0.25, 0.25, 0]) cube([0.5, 0.5, 1]); }", 2},
    {"difference() { rotate([10, 20, 30]) hyperboloid(h = 1, r = 1, rc = 0.4); rotate([0, 0, 30]) rotate([0, 20, 0]) rotate([10, 0, 0]) hyperboloid(h = 1, r = 1, rc = 0.4); }", 0},
  };
  unsigned hits = 0;
  for (size_t i = 0; i < sizeof asked / sizeof *asked; i++) {
    stage st = stage_open(asked[i].model);
    for (int n = 0; n < 3000; n++) {
      double o[3], d[3];
      for (int j = 0; j < 3; j++) {
        o[j] = (double)(below(2001) - 1000) / 512;
        d[j] = (double)(below(2001) - 1000) / 2048 + 0.3 - o[j]; /* towards the middle */
      }
      qn_line line;
      qn_woven w;
      qn_scratch_begin(st.scratch);
      qn_line_from_doubles(o, d, &line);
      assert_int_equal(qn_weave(st.scene, st.scratch, &line, &WHOLE_LINE, QUOIN_WANT_BOUNDARY | QUOIN_WANT_CONTACTS, &w), QUOIN_OK);
      assert_in_range(w.inside_count, 0, asked[i].most);
      hits += w.inside_count > 0;
    }
    assert_int_equal(qn_scratch_counts(st.scratch)->exact_orders, 0); /* by identity, not by arithmetic */
    stage_close(&st);
  }
  assert_true(hits > 1000);
}

/* A superquadric with other solids: its places are their doubles. */
static void test_superquadric(void **state) {
  (void)state;
  stage st = stage_open("difference() { superquadric(r = [1, 1, 1], e = 0.3, n = 0.3); cube([2, 2, 2]); }");
  qn_line line;
  const double o[3] = {-3, 0.25, 0.25}, d[3] = {1, 0, 0};
  qn_scratch_begin(st.scratch);
  qn_line_from_doubles(o, d, &line);
  qn_woven w;
  assert_int_equal(qn_weave(st.scene, st.scratch, &line, &WHOLE_LINE, 0, &w), QUOIN_OK);
  assert_int_equal(w.inside_count, 1);
  assert_true(fabs(qn_place_round(st.scene, st.scratch, &line, &w.inside[0].enter.place) - 2) < 1e-3);
  assert_true(qn_place_round(st.scene, st.scratch, &line, &w.inside[0].leave.place) == 3);
  stage_close(&st);
}

/* With every bound of memory, the answer is right or refused. */
typedef struct purse { size_t left, largest; } purse; /* allocations that are granted; the largest block asked for */
static void *purse_alloc(void *user, size_t size) {
  purse *p = user;
  if (p->left == 0) {
    return NULL;
  }
  p->left--;
  return malloc(size);
}
static void *purse_resize(void *user, void *block, size_t old_size, size_t new_size) {
  purse *p = user;
  (void)old_size;
  p->largest = new_size > p->largest ? new_size : p->largest;
  if (p->left == 0) {
    return NULL;
  }
  p->left--;
  return realloc(block, new_size);
}
static void purse_release(void *user, void *block, size_t size) {
  (void)user, (void)size;
  free(block);
}

static void test_memory(void **state) {
  (void)state;
  purse p = {SIZE_MAX, 0};
  quoin_allocator allocator = {purse_alloc, purse_resize, purse_release, &p, 0};
  quoin_model *model;
  quoin_scene *scene;
  const char *text = "difference() { cube(1); translate([1, 0, 0]) cube(1); sphere(0.6); }";
  assert_int_equal(quoin_model_new(&allocator, &model), QUOIN_OK);
  assert_int_equal(quoin_model_read_text(model, QUOIN_ROOT, "test", text, strlen(text), NULL), QUOIN_OK);
  assert_int_equal(quoin_scene_compile(model, NULL, &scene), QUOIN_OK);
  unsigned refused = 0, done = 0;
  for (size_t budget = 0; budget < 400 && done < 3; budget++) {
    p.left = budget;
    qn_scratch *scratch;
    quoin_status status = qn_scratch_new(scene, &scratch);
    if (status == QUOIN_OK) {
      qn_line line;
      const double o[3] = {1, 0.5, -1}, d[3] = {0, 0, 1};
      qn_woven w;
      qn_scratch_begin(scratch);
      qn_line_from_doubles(o, d, &line);
      status = qn_weave(scene, scratch, &line, &WHOLE_LINE, QUOIN_WANT_BOUNDARY | QUOIN_WANT_CONTACTS, &w);
      if (status == QUOIN_OK) {
        done++;
        assert_int_equal(w.inside_count, 0);
        assert_int_equal(w.boundary_count, 1);
      }
      p.left = SIZE_MAX; /* and the next question is answered */
      qn_scratch_begin(scratch);
      qn_line_from_doubles(o, d, &line); /* the earlier one's integers are gone */
      assert_int_equal(qn_weave(scene, scratch, &line, &WHOLE_LINE, QUOIN_WANT_BOUNDARY, &w), QUOIN_OK);
      assert_int_equal(w.boundary_count, 1);
    }
    if (status != QUOIN_OK) {
      assert_int_equal(status, QUOIN_E_MEMORY);
      refused++;
    }
    p.left = SIZE_MAX;
    qn_scratch_free(scratch);
  }
  assert_true(refused > 5 && done == 3);
  quoin_scene_free(scene);
  quoin_model_free(model);
}

/* However many lines of however many ends: scratch is as large as the longest of them needs. */
static void test_scratch_stays(void **state) {
  (void)state;
  enum { BALLS = 60, LARGE = 40, LINES = 100 };
  purse p = {SIZE_MAX, 0};
  quoin_allocator allocator = {purse_alloc, purse_resize, purse_release, &p, 0};
  quoin_model *model;
  quoin_scene *scene;
  assert_int_equal(quoin_model_new(&allocator, &model), QUOIN_OK);
  for (int i = 0; i < BALLS; i++) {
    quoin_node at;
    const double v[3] = {3.0 * i, 0, 0};
    assert_int_equal(quoin_add_translate(model, QUOIN_ROOT, v, &at), QUOIN_OK);
    assert_int_equal(quoin_add_sphere(model, at, i < LARGE ? 1 : 0.5, NULL), QUOIN_OK);
  }
  assert_int_equal(quoin_scene_compile(model, NULL, &scene), QUOIN_OK);
  for (int shorter = 0; shorter < 3; shorter++) { /* how many lines that meet the large ones only come first */
    qn_scratch *scratch;
    assert_int_equal(qn_scratch_new(scene, &scratch), QUOIN_OK);
    p.largest = 0;
    size_t after_one = 0;
    for (int i = 0; i < shorter + LINES; i++) {
      qn_line line;
      const double o[3] = {-10, i < shorter ? 0.75 : 0.125, 0}, d[3] = {1, 0, 0};
      qn_woven w;
      qn_scratch_begin(scratch);
      qn_line_from_doubles(o, d, &line);
      assert_int_equal(qn_weave(scene, scratch, &line, &WHOLE_LINE, 0, &w), QUOIN_OK);
      assert_int_equal(w.inside_count, i < shorter ? LARGE : BALLS);
      after_one = i == shorter + 2 ? p.largest : after_one;
    }
    assert_true(after_one > 0 && p.largest == after_one);
    qn_scratch_free(scratch);
  }
  quoin_scene_free(scene);
  quoin_model_free(model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_ends), cmocka_unit_test(test_shared_ends), cmocka_unit_test(test_rounded_scenes), cmocka_unit_test(test_superquadric), cmocka_unit_test(test_memory),
    cmocka_unit_test(test_scratch_stays),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
