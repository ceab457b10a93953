/* Points in batches against the exact path: every side that the points' body certifies, on every instruction set that this machine runs and at
   every place in a batch, must be the one that the exact path finds, and what it cannot certify must come out of the batch all the same.
   Decimals likewise.

   Run with a number for more: query_test_points [models [seed]]. Prints a census. */
#include "ask.h"
#include "base/bounds.h"
#include "query/work.h"
#include "share.h"

#include "packet_cases.h"

#include <math.h>
#include <pthread.h>

static size_t model_count = 700;
static uint64_t first_seed = 0x51ed270b94f8c6a3u;

enum { MANY = 3 * QN_POINTS };
static const char *const ISAS[3] = {"sse2", "avx2", "avx512"};

static quoin_side exactly(const ask *a, const double x[3]) {
  qn_query_point p;
  quoin_side side = QUOIN_OUTSIDE;
  qn_query_begin(a->work);
  assert_int_equal(qn_query_point_doubles(a->work, x, &p), QUOIN_OK);
  assert_int_equal(qn_query_side(a->work, &p, &side), QUOIN_OK);
  return side;
}

static uint64_t handed(const ask *a) {
  quoin_stats stats;
  quoin_work_stats(a->work, &stats);
  return stats.exact_points;
}

static uint64_t asked(const ask *a) {
  quoin_stats stats;
  quoin_work_stats(a->work, &stats);
  return stats.points;
}

/* Where points go wrong if they do. */
enum { KINDS = 9 };
static const char *const KIND_NAMES[KINDS] = {"random", "lattice", "half lattice", "beside the lattice", "on balls", "far", "huge and tiny", "the same", "close together"};

static void draw_point(dice *d, int kind, const frame *f, double out[3]) {
  double x[3];
  for (int i = 0; i < 3; i++) {
    x[i] = kind == 0 ? 0.001 * (roll(d, 10001) - 5000) + 1e-5 * roll(d, 100) : kind == 1 || kind == 3 ? roll(d, 11) - 5 : 0.5 * (roll(d, 19) - 9);
  }
  if (kind == 3) {
    x[roll(d, 3)] += ldexp(roll(d, 3) - 1, -10 - roll(d, 45));
  } else if (kind == 4) { /* pythagorean: on spheres and cylinders about whole points, and cones' mantles */
    static const double legs[][3] = {{1, 0, 0}, {0.6, 0.8, 0}, {0.8, 0.6, 0}, {2 / 3., 2 / 3., 1 / 3.}, {1.2, 1.6, 0}, {0.28, 0.96, 0}};
    const double *leg = legs[roll(d, 6)];
    int turn = roll(d, 3);
    for (int i = 0; i < 3; i++) {
      x[i] = roll(d, 5) - 2 + (roll(d, 2) ? 1 : -1) * leg[(i + turn) % 3];
    }
  } else if (kind == 5) {
    x[roll(d, 3)] *= pow(10, 2 + roll(d, 12));
  } else if (kind == 7) {
    x[0] = 1, x[1] = 0, x[2] = 0.5;
  } else if (kind == 8) {
    for (int i = 0; i < 3; i++) {
      x[i] = 1 + ldexp(roll(d, 64), -52);
    }
  }
  frame_apply(f, x, 1, out);
  if (kind == 6) {
    static const double odd[] = {0, 5e-324, -5e-324, 2.2250738585072014e-308, 1e-200, 0x1p+100, 0x1.0000000000001p+100, -0x1p+101, 1e200, 1.7976931348623157e308, -1e40, 0.25};
    for (int i = 0; i < 3; i++) {
      out[i] = roll(d, 3) ? odd[roll(d, 12)] : out[i];
    }
  }
}

typedef struct tally { uint64_t points, sides[3], handed; } tally;
static tally by_model[MODELS], by_kind[KINDS], by_frame[FRAMES];

static void count(tally *t, const quoin_side *sides, size_t n, uint64_t left) {
  t->points += n;
  t->handed += left;
  for (size_t i = 0; i < n; i++) {
    t->sides[sides[i]]++;
  }
}

static void say(const char *name, const tally *t) {
  print_message("%-20s %8llu points: %5.1f%% in, %5.1f%% on, handed to the exact path %5.2f%%\n", name, (unsigned long long)t->points,
                100. * (double)t->sides[QUOIN_INSIDE] / (double)t->points, 100. * (double)t->sides[QUOIN_BOUNDARY] / (double)t->points,
                100. * (double)t->handed / (double)t->points);
}

static void blame(const char *text, const char *isa, const double x[3], quoin_side got, quoin_side want) {
  printf("%s(%a, %a, %a) = (%.17g, %.17g, %.17g) on %s: %d for %d\n", text, x[0], x[1], x[2], x[0], x[1], x[2], isa, (int)got, (int)want);
  fail();
}

static void one_model(dice *d, const char *text, int model, int frame_kind, const frame *f) {
  ask a;
  ask_open(&a, text);
  static double points[3 * MANY];
  static quoin_side want[MANY], got[MANY];
  for (int round = 0; round < 2; round++) {
    int kind = roll(d, KINDS);
    size_t n = roll(d, 4) ? (size_t)roll(d, 300) + 1 : (size_t)roll(d, MANY) + 1;
    for (size_t i = 0; i < n; i++) {
      draw_point(d, round ? roll(d, KINDS) : kind, f, points + 3 * i);
      want[i] = exactly(&a, points + 3 * i);
    }
    uint64_t left[3] = {0};
    for (int i = 0; i < 3; i++) {
      setenv("QUOIN_ISA", ISAS[i], 1);
      a.work->wide = qn_wide_pick();
      memset(got, 0x55, sizeof got);
      uint64_t before = handed(&a), points_before = asked(&a);
      assert_int_equal(quoin_point_sides(a.scene, a.work, n, points, got), QUOIN_OK);
      left[i] = handed(&a) - before;
      assert_int_equal(asked(&a) - points_before, n);
      for (size_t k = 0; k < n; k++) {
        if (got[k] != want[k]) {
          blame(text, ISAS[i], points + 3 * k, got[k], want[k]);
        }
      }
      assert_int_equal(left[i], left[0]); /* what is sure is so on every machine alike */
    }
    if (!round) {
      count(&by_model[model], want, n, left[0]);
      count(&by_kind[kind], want, n, left[0]);
      count(&by_frame[frame_kind], want, n, left[0]);
    }
  }
  unsetenv("QUOIN_ISA");
  ask_close(&a);
}

static void random_models(void **state) {
  (void)state;
  dice d = {first_seed};
  static char text[1 << 16];
  for (size_t i = 0; i < model_count; i++) {
    frame f;
    int model = (int)(i % MODELS), kind = roll(&d, 3) ? roll(&d, FRAMES) : 0;
    make_frame(&d, kind, &f);
    write_model(&d, model, &f, text, sizeof text);
    one_model(&d, text, model, kind, &f);
  }
  for (int i = 0; i < MODELS; i++) {
    say(MODEL_NAMES[i], &by_model[i]);
    assert_true(model_count < 700 || (by_model[i].sides[QUOIN_INSIDE] && by_model[i].sides[QUOIN_OUTSIDE] && by_model[i].sides[QUOIN_BOUNDARY]));
  }
  tally all = {0};
  for (int i = 0; i < KINDS; i++) {
    say(KIND_NAMES[i], &by_kind[i]);
    all.points += by_kind[i].points, all.handed += by_kind[i].handed;
  }
  for (int i = 0; i < FRAMES; i++) {
    say(FRAME_NAMES[i], &by_frame[i]);
  }
  assert_true(model_count < 700 || by_kind[0].handed * 10 < by_kind[0].points); /* a random point is hardly ever left; in the superquadrics' boxes it is */
  assert_true(model_count < 700 || all.handed * 100 > all.points * 5); /* and many others are hard */
}

/* Large models, whose hierarchies are deep and whose unions are shared. */
static void large_models(void **state) {
  (void)state;
  dice d = {first_seed ^ 77};
  size_t size = 1 << 20;
  char *text = malloc(size);
  frame f = {.scale = {1, 1, 1}};
  assert_non_null(text);
  for (int round = 0; round < 15; round++) {
    int kind = round % 5, leaves = round < 5 ? 3000 : round < 10 ? 400 : 90;
    writer w = {text, size, 0};
    put(&w, kind == 1 || kind == 3 ? "difference() { translate([-5,-5,-5]) cube(10); \n" : kind == 2 ? "intersection() { union() {\n" : "union() {\n");
    for (int i = 0; i < leaves; i++) {
      double x = 0.01 * (roll(&d, 1001) - 500), y = 0.01 * (roll(&d, 1001) - 500), z = 0.01 * (roll(&d, 1001) - 500);
      if (kind == 2 && i == leaves / 2) {
        put(&w, "} union() {\n");
      }
      if (kind == 4) {
        put(&w, "difference() { translate([%g,%g,%g]) sphere(0.5); translate([%g,%g,%g]) cylinder(r=0.2,h=0.5); translate([%g,%g,%g]) cube(0.25); }\n", x, y, z, x, y, z, x, y, z);
      } else {
        put(&w, "translate([%g,%g,%g]) %s\n", x, y, z, roll(&d, 2) ? "sphere(0.25);" : kind == 3 ? "rotate([0,90,0]) cylinder(r=0.2,h=3);" : "cube(0.4);");
      }
    }
    put(&w, kind == 2 ? "} }\n" : "}\n");
    ask a;
    ask_open(&a, text);
    static double points[3 * 4000];
    static quoin_side got[4000];
    for (size_t i = 0; i < 4000; i++) {
      draw_point(&d, i % 4 ? 0 : 1, &f, points + 3 * i);
    }
    for (int i = 0; i < 3; i++) {
      setenv("QUOIN_ISA", ISAS[i], 1);
      a.work->wide = qn_wide_pick();
      a.work->cells = i ? qn_scene_cells(a.scene) : NULL, a.work->cells_asked = 1;
      uint64_t before = handed(&a);
      assert_int_equal(quoin_point_sides(a.scene, a.work, 4000, points, got), QUOIN_OK);
      assert_true(handed(&a) - before < 500);
      for (size_t k = 0; k < 4000; k++) {
        if (got[k] != exactly(&a, points + 3 * k)) {
          blame("large\n", ISAS[i], points + 3 * k, got[k], exactly(&a, points + 3 * k));
        }
      }
    }
    unsetenv("QUOIN_ISA");
    ask_close(&a);
  }
  free(text);
}

/* Decimals: exact ones, ones that doubles only come near to, and hosts of digits; as a batch and one by one. */
static void decimals(void **state) {
  (void)state;
  ask a;
  ask_open(&a, "difference() { translate([0.1,0.1,0.1]) cube(0.3); translate([0.2,0.2,0]) cylinder(r=0.1,h=0.3); }"
               "translate([0.7,0,0]) sphere(0.1); translate([1e30,0,0]) cube(1e29);");
  dice d = {first_seed ^ 5};
  enum { N = 600 };
  static char room[3 * N][64];
  const char *texts[3 * N];
  quoin_side got[N], one;
  size_t on = 0, done = 0;
  for (int round = 0; round < 20; round++) {
    for (int i = 0; i < 3 * N; i++) {
      static const char *const odd[] = {"0.1", "0.2", "0.3", "0.4", "1e30", "1.1e30", "0.30000000000000000000000001", "0.29999999999999999999999999", "1e400", "1e-400", "0", "-0",
                                        "1e-3", "+.1", "0.10000000000000001", "0.1000000000000000055511151231257827021181583404541015625", "6e-1", "0.8"};
      if (roll(&d, 3)) {
        snprintf(room[i], sizeof room[i], "%s", odd[roll(&d, 18)]);
      } else {
        snprintf(room[i], sizeof room[i], "%.*f", roll(&d, 18), 0.001 * roll(&d, 900));
      }
      texts[i] = room[i];
    }
    assert_int_equal(quoin_point_sides_text(a.scene, a.work, N, texts, got, &done), QUOIN_OK);
    assert_int_equal(done, N);
    for (int i = 0; i < N; i++) {
      qn_query_point p;
      qn_query_begin(a.work);
      assert_int_equal(qn_query_point_text(a.work, texts + 3 * i, &p), QUOIN_OK);
      assert_int_equal(qn_query_side(a.work, &p, &one), QUOIN_OK);
      if (got[i] != one) {
        print_error("%s %s %s: %d for %d\n", texts[3 * i], texts[3 * i + 1], texts[3 * i + 2], (int)got[i], (int)one);
        fail();
      }
      on += got[i] == QUOIN_BOUNDARY;
    }
  }
  assert_true(on > 100);
  /* the first text that is no number ends it, after the answers before it */
  for (size_t bad = 0; bad < N; bad += 37) {
    const char *good = texts[3 * bad + 1];
    memset(got, 0x55, sizeof got);
    texts[3 * bad + 1] = bad % 2 ? "1.2.3" : "";
    assert_int_equal(quoin_point_sides_text(a.scene, a.work, N, texts, got, &done), QUOIN_E_NUMBER);
    assert_int_equal(done, bad);
    for (size_t i = 0; i < bad; i++) {
      assert_int_equal(quoin_point_side_text(a.scene, a.work, texts + 3 * i, &one), QUOIN_OK);
      assert_int_equal(got[i], one);
    }
    texts[3 * bad + 1] = good;
  }
  texts[3] = "1e99999999";
  assert_int_equal(quoin_point_sides_text(a.scene, a.work, N, texts, got, &done), QUOIN_E_LIMIT);
  assert_int_equal(done, 1);
  texts[3] = NULL;
  assert_int_equal(quoin_point_sides_text(a.scene, a.work, N, texts, got, NULL), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_point_sides_text(a.scene, a.work, 0, NULL, NULL, &done), QUOIN_OK);
  ask_close(&a);
}

/* Decimals far out, whose doubles are other places: 2^60 and what rounds to it, beside solids much smaller than that rounding. */
static void far_decimals(void **state) {
  (void)state;
  static const char *const solids[] = {"sphere(20);", "cube(40, center = true);", "cylinder(r = 20, h = 40, center = true);", "cylinder(r = 20, h = 40, center = true, $fn = 8);",
                                       "scale([1, 2, 1]) sphere(20);", "intersection() { sphere(20); cube(30, center = true); }"};
  for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
    char text[300];
    ask a;
    snprintf(text, sizeof text, "translate([1152921504606846976, 0, 0]) %s", solids[i]);
    ask_open(&a, text);
    const char *const points[] = {"1152921504606846976", "0", "0", "1152921504606847000", "0", "0", "1152921504606846980", "0", "0", "1152921504606846950", "0", "0",
                                  "1152921504606846976.000001", "0", "0", "1152921504606846996", "0", "0"};
    quoin_side got[6];
    assert_int_equal(quoin_point_sides_text(a.scene, a.work, 6, points, got, NULL), QUOIN_OK);
    assert_true(got[0] == QUOIN_INSIDE && got[1] == QUOIN_OUTSIDE && got[2] == QUOIN_INSIDE && got[3] == QUOIN_OUTSIDE && got[4] == QUOIN_INSIDE);
    assert_true(i > 4 || i == 3 || got[5] == QUOIN_BOUNDARY);
    ask_close(&a);
  }
}

/* Boxes whose faces are where one cell of the grid ends and the next begins: points on those faces. */
static void on_the_borders_of_cells(void **state) {
  (void)state;
  char *text = malloc(1 << 16);
  assert_non_null(text);
  writer w = {text, 1 << 16, 0};
  for (int i = 0; i < 79; i++) { /* makes 200 cells along 160 */
    put(&w, "translate([%d,0,0]) cube(1);\n", i == 78 ? 159 : 2 * i);
  }
  for (int i = 0; i < 3; i++) {
    setenv("QUOIN_ISA", ISAS[i], 1);
    ask a;
    ask_open(&a, text);
    const qn_cells *cells = qn_scene_cells(a.scene);
    assert_true(cells && cells->grid_count == 1 && cells->grids[0].scale[0] == 1.25f && cells->grids[0].low[0] == 0);
    double points[3 * 642];
    quoin_side got[642];
    for (int k = 0; k < 642; k++) {
      points[3 * k] = 0.25 * k - 0.125 * (k % 2), points[3 * k + 1] = points[3 * k + 2] = 0.5;
    }
    a.work->cells = cells, a.work->cells_asked = 1;
    assert_int_equal(quoin_point_sides(a.scene, a.work, 642, points, got), QUOIN_OK);
    for (int k = 0; k < 642; k++) {
      quoin_side want = exactly(&a, points + 3 * k);
      assert_int_equal(got[k], want);
      assert_true(k % 16 || k > 608 || want == QUOIN_BOUNDARY);
    }
    ask_close(&a);
  }
  unsetenv("QUOIN_ISA");
  free(text);
}

/* Points that are none are refused, after the answers to those before them. */
static void refused(void **state) {
  (void)state;
  ask a;
  ask_open(&a, "sphere(1);");
  enum { N = 600 };
  double points[3 * N] = {0};
  quoin_side got[N];
  static const double none[] = {NAN, INFINITY, -INFINITY};
  for (size_t i = 0; i < N; i++) {
    points[3 * i] = i % 2;
  }
  for (size_t bad = 0; bad < N; bad += 23) {
    points[3 * bad + bad % 3] = none[bad % 2 + (bad % 5 == 0)];
    memset(got, 0x55, sizeof got);
    assert_int_equal(quoin_point_sides(a.scene, a.work, N, points, got), QUOIN_E_ARGUMENT);
    for (size_t i = 0; i < bad; i++) {
      assert_int_equal(got[i], i % 2 ? QUOIN_BOUNDARY : QUOIN_INSIDE);
    }
    points[3 * bad] = (double)(bad % 2), points[3 * bad + 1] = points[3 * bad + 2] = 0;
  }
  assert_int_equal(quoin_point_sides(a.scene, a.work, N, points, got), QUOIN_OK);
  assert_int_equal(quoin_point_sides(a.scene, a.work, 0, NULL, NULL), QUOIN_OK);
  assert_int_equal(quoin_point_sides(a.scene, a.work, 1, NULL, got), QUOIN_E_ARGUMENT);
  ask_close(&a);
}

/* Many threads, one scene. */
typedef struct share { const quoin_scene *scene; const double *points; quoin_side *got; size_t n; quoin_status status; } share;
static void *ask_share(void *user) {
  share *s = user;
  quoin_work *work;
  s->status = quoin_work_new(s->scene, &work);
  for (size_t i = 0; s->status == QUOIN_OK && i < s->n; i += 100) {
    s->status = quoin_point_sides(s->scene, work, s->n - i < 100 ? s->n - i : 100, s->points + 3 * i, s->got + i);
  }
  quoin_work_free(work);
  return NULL;
}
static void threads(void **state) {
  (void)state;
  ask a;
  ask_open(&a, "difference() { cube(4, center = true); rotate(30) cylinder(r = 1, h = 4, center = true); translate([2,2,2]) sphere(1); }");
  dice d = {first_seed ^ 9};
  frame f = {.scale = {1, 1, 1}};
  enum { N = 4000, THREADS = 4 };
  static double points[3 * N];
  static quoin_side got[THREADS][N];
  for (size_t i = 0; i < N; i++) {
    draw_point(&d, roll(&d, 5), &f, points + 3 * i);
  }
  share s[THREADS];
  pthread_t id[THREADS];
  for (int t = 0; t < THREADS; t++) {
    s[t] = (share){a.scene, points, got[t], N, QUOIN_OK};
    assert_int_equal(pthread_create(&id[t], NULL, ask_share, &s[t]), 0);
  }
  for (int t = 0; t < THREADS; t++) {
    pthread_join(id[t], NULL);
    assert_int_equal(s[t].status, QUOIN_OK);
  }
  for (size_t i = 0; i < N; i++) {
    for (int t = 0; t < THREADS; t++) {
      assert_int_equal(got[t][i], exactly(&a, points + 3 * i));
    }
  }
  ask_close(&a);
}

int main(int words, char **word) {
  model_count = words > 1 ? (size_t)strtoull(word[1], NULL, 0) : (size_t)share_of((int)model_count);
  first_seed = words > 2 ? strtoull(word[2], NULL, 0) : first_seed;
  const struct CMUnitTest tests[] = {cmocka_unit_test(random_models), cmocka_unit_test(large_models), cmocka_unit_test(decimals),
                                     cmocka_unit_test(far_decimals), cmocka_unit_test(on_the_borders_of_cells), cmocka_unit_test(refused),       cmocka_unit_test(threads)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
