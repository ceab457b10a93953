/* Lines that run in surfaces which many leaves share: that they end, whose ends are named, fans of slices about an axis. */
#include "ray/rays.h"
#include "share.h"

static uint64_t seed = 0x2545f4914f6cdd1du;
static uint64_t next(void) {
  seed ^= seed << 13;
  seed ^= seed >> 7;
  seed ^= seed << 17;
  return seed;
}
static int64_t below(int64_t n) { return (int64_t)(next() % (uint64_t)n); }

static qn_woven woven(stage *st, const double o[3], const double d[3], double from, double to) {
  qn_line line;
  qn_range part = WHOLE_LINE;
  qn_woven w;
  part.from.t = from, part.to.t = to;
  qn_scratch_begin(st->scratch);
  qn_line_from_doubles(o, d, &line);
  assert_int_equal(qn_weave(st->scene, st->scratch, &line, &part, QUOIN_WANT_BOUNDARY, &w), QUOIN_OK);
  return w;
}

/* Text that grows. */
typedef struct text { char *at; size_t n, room; } text;
QN_PRINTF(2, 3) static void say(text *t, const char *format, ...) {
  if (t->n + 200 > t->room) {
    t->room = 2 * t->room + 1000;
    t->at = realloc(t->at, t->room);
    assert_non_null(t->at);
  }
  va_list args;
  va_start(args, format);
  t->n += (size_t)vsnprintf(t->at + t->n, t->room - t->n, format, args);
  va_end(args);
}

/* --- many leaves ------------------------------------------------------------------------------------------------------ */

/* n solids with a face, an edge or a generator in common, along it. When each end asked about all leaves of the line anew, a hundred thousand
   took minutes each. */
static void test_many(void **state) {
  (void)state;
  const int N = share_of(100000);
  const struct { const char *each; double o[3], d[3], enter, leave; } asked[] = {
    {"cube([10, 10, 10]);", {0, 5, -5}, {0, 0, 1}, 5, 15},                          /* in a face, all alike */
    {"cube([10, 10, 10]);", {0, 0, -5}, {0, 0, 1}, 5, 15},                          /* along an edge */
    {"cube([%d, 10, 10]);", {-5, 0, 5}, {1, 0, 0}, 5, 5 + N},                       /* begin together */
    {"translate([%d, 0, 0]) cube([100000, 10, 10]);", {-5, 0, 5}, {1, 0, 0}, 6, 5 + 100000 + N}, /* all of them open in the middle */
    {"cylinder(h = %d, r = 5);", {0, 5, -2}, {0, 0, 1}, 2, 2 + N},                  /* along a generator */
    {"cylinder(h = 10, r1 = 5, r2 = 0);", {5, 0, 0}, {-1, 0, 2}, 0, 5},
  };
  for (size_t i = 0; i < sizeof asked / sizeof *asked; i++) {
    text t = {0};
    for (int k = 1; k <= N; k++) {
      const char *hole = strstr(asked[i].each, "%d");
      if (hole) {
        say(&t, "%.*s%d%s", (int)(hole - asked[i].each), asked[i].each, k, hole + 2);
      } else {
        say(&t, "%s", asked[i].each);
      }
    }
    stage st = stage_open(t.at);
    qn_woven w = woven(&st, asked[i].o, asked[i].d, -HUGE_VAL, HUGE_VAL);
    assert_int_equal(w.inside_count, 0);
    assert_int_equal(w.boundary_count, 1);
    assert_true(w.boundary[0].enter.place.t == asked[i].enter && w.boundary[0].leave.place.t == asked[i].leave);
    assert_int_equal(w.boundary[0].enter.leaf, 0); /* the first makes it a boundary, the last ends it */
    assert_int_equal(w.boundary[0].leave.leaf, N - 1);
    stage_close(&st);
    free(t.at);
  }
}

/* Slices about an axis: together they hold it, without one of them it is their edge. */
static void test_slices(void **state) {
  (void)state;
  const double o[3] = {0, 0, -5}, d[3] = {0, 0, 1};
  for (int slices = 3; slices <= 720; slices = slices < 12 ? slices + 1 : 8 * slices) {
    for (int missing = 0; missing < 2; missing++) {
      text t = {0};
      for (int k = 0; k < slices - missing; k++) {
        say(&t, "rotate([0, 0, %d * 360 / %d]) intersection() { cube([4, 8, 10]);"
                "rotate([0, 0, 360 / %d]) translate([0, -8, 0]) cube([4, 8, 10]); }", k, slices, slices);
      }
      stage st = stage_open(t.at);
      qn_woven w = woven(&st, o, d, -HUGE_VAL, HUGE_VAL);
      /* up to 4 slices, each is wider than the quarter that its cubes have in common */
      if (slices >= 4) {
        assert_int_equal(w.inside_count, missing ? 0 : 1);
        assert_int_equal(w.boundary_count, missing);
        const qn_stretch *one = missing ? w.boundary : w.inside;
        assert_true(one->enter.place.t == 5 && one->leave.place.t == 15);
      }
      stage_close(&st);
      free(t.at);
    }
  }
}

/* Beyond a cone's apex its inside lies on the other side of the plane that touches it along the line, so the cells at one place do not
   serve the whole line: two cones on one apex, cut by that plane. */
static void test_changing_cells(void **state) {
  (void)state;
  static const char *const CUT[] = {"", "halfspace(n = [0, 1, 0], d = 0);"};
  const double d[3] = {1, 0, 1};
  for (int third = 0; third < 2; third++) {
    for (int at = -1; at <= 1; at += 2) { /* the line's origin above the apex and below it */
      const double o[3] = {at * 0.5, 0, at * 0.5};
      text t = {0};
      say(&t, "intersection() { union() { cylinder(h = 1, r1 = 0, r2 = 1); translate([0, 0, -1]) cylinder(h = 1, r1 = 1, r2 = 0); }"
              "halfspace(n = [1, 0, -1], d = 0); %s }", CUT[third]);
      stage st = stage_open(t.at);
      qn_woven w = woven(&st, o, d, -HUGE_VAL, HUGE_VAL);
      assert_int_equal(w.inside_count, 0);
      assert_int_equal(w.boundary_count, 1);
      assert_true(w.boundary[0].enter.place.t == -at * 0.5 && w.boundary[0].leave.place.t == 1 - at * 0.5);
      stage_close(&st);
      free(t.at);
    }
  }
}

/* --- names ------------------------------------------------------------------------------------------------------------ */

/* In surfaces whose cells change along the line, where stretches are asked one by one: the names that each event's own question gives. */
static void test_names(void **state) {
  (void)state;
  static const struct { const char *model; double o[3], d[3], from, to; uint32_t enter, leave; } asked[] = {
    {"union() { difference() { rotate([90, 0, 0]) translate([-1, -1, 2]) cube([2, 3, 2]); translate([0, 1, -2]) hyperboloid(h = 2, r = 3, rc = 1); } union() { difference() {"
     "translate([1, 1, 1]) rotate([90, 0, 0]) hyperboloid(h = 2, r = 3, rc = 1); translate([1, 0, 2]) cube([2, 3, 3]); translate([0, 0, -1]) cylinder(h = 1, r = 2); }"
     "translate([1, 2, 2]) rotate([0, 0, 60]) cylinder(h = 1, r = 2); } }", {1, 0, -5}, {0, 0, 1}, 1, 7, 4, 3},
  };
  for (size_t i = 0; i < sizeof asked / sizeof *asked; i++) {
    stage st = stage_open(asked[i].model);
    qn_woven w = woven(&st, asked[i].o, asked[i].d, asked[i].from, asked[i].to);
    assert_int_equal(w.inside_count, 1);
    assert_int_equal(w.inside[0].enter.leaf, asked[i].enter);
    assert_int_equal(w.inside[0].leave.leaf, asked[i].leave);
    stage_close(&st);
  }
}

/* A stretch's side, by its definition: at a point of it, in random heaps of solids that share surfaces with the line. */
static quoin_side side_at(stage *st, quoin_work *work, const double o[3], const double d[3], double t) {
  double p[3];
  quoin_side side;
  for (int k = 0; k < 3; k++) {
    p[k] = o[k] + t * d[k];
  }
  assert_int_equal(quoin_point_side(st->scene, work, p, &side), QUOIN_OK);
  return side;
}

static const char *random_leaf(char *out, size_t size) {
  static const char *const KIND[] = {"cube([%d, %d, %d]);", "cylinder(h = %d, r = %d);", "cylinder(h = %d, r1 = 2, r2 = %d);", "rotate([0, 0, 45]) cube([%d, %d, %d]);",
                                     "rotate([90, 0, 0]) cylinder(h = %d, r = %d);", "rotate([0, 0, 30]) cube([%d, %d, %d]);", "hyperboloid(h = %d, r = 3, rc = 1);"};
  char solid[100];
  const char *kind = KIND[below(sizeof KIND / sizeof *KIND)];
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
  snprintf(solid, sizeof solid, kind, (int)below(3) + 1, (int)below(2) + 1, (int)below(3) + 1);
#pragma GCC diagnostic pop
  snprintf(out, size, "translate([%d, %d, %d]) %s", (int)below(5) - 2, (int)below(5) - 2, (int)below(5) - 2, solid);
  return out;
}

static void test_points(void **state) {
  (void)state;
  static const char *const OPS[] = {"union", "difference", "intersection"};
  static const int WAYS[][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, -1, 0}, {1, 0, 1}};
  size_t kinds[3] = {0};
  for (int round = 0; round < share_of(150); round++) {
    text t = {0};
    char leaf[200];
    say(&t, "%s() {", OPS[below(3)]);
    for (int k = 0; k < 3; k++) {
      say(&t, "%s() {", OPS[below(3)]);
      for (int64_t n = below(3) + 2; n > 0; n--) {
        say(&t, "%s", random_leaf(leaf, sizeof leaf));
      }
      say(&t, "}");
    }
    say(&t, "}");
    stage st = stage_open(t.at);
    quoin_work *work;
    assert_int_equal(quoin_work_new(st.scene, &work), QUOIN_OK);
    for (int r = 0; r < 40; r++) {
      double o[3], d[3];
      int64_t way = below(sizeof WAYS / sizeof *WAYS);
      for (int k = 0; k < 3; k++) {
        o[k] = (double)(below(9) - 4);
        d[k] = WAYS[way][k];
      }
      qn_woven w = woven(&st, o, d, -20, 20);
      double ends[200] = {-20};
      size_t n = 1;
      for (size_t i = 0; i < w.inside_count + w.boundary_count; i++) {
        const qn_stretch *s = i < w.inside_count ? &w.inside[i] : &w.boundary[i - w.inside_count];
        ends[n++] = s->enter.place.t, ends[n++] = s->leave.place.t;
        assert_true(n < 190);
        quoin_side want = i < w.inside_count ? QUOIN_INSIDE : QUOIN_BOUNDARY;
        double a = s->enter.place.t, b = s->leave.place.t;
        if (b - a > 1e-6) { /* at two points that are doubles on the line: thirds and fifths of the way may cross other surfaces */
          double t1 = floor((a + 0.3819 * (b - a)) * 0x1p40) * 0x1p-40, t2 = floor((a + 0.7236 * (b - a)) * 0x1p40) * 0x1p-40;
          assert_int_equal(side_at(&st, work, o, d, t1), want);
          assert_int_equal(side_at(&st, work, o, d, t2), want);
          kinds[want == QUOIN_INSIDE]++;
        }
      }
      for (size_t i = 1; i < n; i++) { /* insertion: few */
        double x = ends[i];
        size_t k = i;
        for (; k > 0 && ends[k - 1] > x; k--) {
          ends[k] = ends[k - 1];
        }
        ends[k] = x;
      }
      ends[n++] = 20;
      for (size_t i = 0; i + 1 < n; i += 2) { /* between stretches that do not meet */
        if (ends[i + 1] - ends[i] > 1e-6) {
          double t1 = floor((ends[i] + 0.3819 * (ends[i + 1] - ends[i])) * 0x1p40) * 0x1p-40;
          assert_int_equal(side_at(&st, work, o, d, t1), QUOIN_OUTSIDE);
          kinds[2]++;
        }
      }
    }
    quoin_work_free(work);
    stage_close(&st);
    free(t.at);
  }
  assert_true(kinds[0] > share_min(300) && kinds[1] > share_min(300) && kinds[2] > share_min(3000));
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_many), cmocka_unit_test(test_slices), cmocka_unit_test(test_changing_cells), cmocka_unit_test(test_names), cmocka_unit_test(test_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
