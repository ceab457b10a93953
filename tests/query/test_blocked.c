/* Arrays of rays asked whether they are blocked, in every order and by every instruction set: as their intervals say. Rays of one direction from scattered places are
   sorted and their starts moved (src/query/blocked.c), so starts and ends of ranges lie exactly on faces here, and in places where sums round. */
#include "ask.h"

#include <math.h>

static unsigned dice(uint64_t *state, unsigned n) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (unsigned)(*state >> 33) % n;
}

enum { COUNT = 9000 };
static quoin_ray rays[COUNT];
static uint8_t truth[COUNT], blocked[COUNT];

typedef struct kind { const char *what; double d[3]; } kind;
static const kind KINDS[] = {{"along z", {0, 0, 1}}, {"along -y", {0, -4, 0}}, {"slantwise", {1, 2, 3}}, {"in tenths", {0.1, -0.7, 0.3}}};

/* Quarters and tenths: the cubes' faces lie at whole numbers. */
static void draw(uint64_t *state, const double d[3], quoin_ray *r) {
  static const double froms[] = {0, 0, 0, 0, 0.1, -0.75, 0.3, -INFINITY}, tos[] = {INFINITY, INFINITY, 0.25, 0.5, 2, 0.7, 1, 3};
  for (int k = 0; k < 3; k++) {
    r->o[k] = dice(state, 5) ? 0.25 * (int)dice(state, 160) : 0.1 * (int)dice(state, 400);
    r->d[k] = d[k];
  }
  r->from = froms[dice(state, 8)];
  r->to = tos[dice(state, 8)];
  if (r->to < r->from) {
    r->to = INFINITY;
  }
}

static const char *const ISAS[] = {"sse2", "avx2", "avx512"};

static void ask_all(const ask *a, const char *what) {
  for (size_t isa = 0; isa < sizeof ISAS / sizeof *ISAS; isa++) {
    quoin_work *work;
    assert_int_equal(setenv("QUOIN_ISA", ISAS[isa], 1), 0);
    assert_int_equal(quoin_work_new(a->scene, &work), QUOIN_OK);
    memset(blocked, 7, sizeof blocked);
    assert_int_equal(quoin_rays_blocked(a->scene, work, COUNT, rays, NULL, blocked), QUOIN_OK);
    for (size_t i = 0; i < COUNT; i++) {
      if (blocked[i] != truth[i]) {
        const quoin_ray *r = &rays[i];
        fail_msg("%s, %s: ray %zu, %a %a %a along %a %a %a from %a to %a: %d, not %d", what, ISAS[isa], i, r->o[0], r->o[1], r->o[2], r->d[0], r->d[1], r->d[2],
                 r->from, r->to, blocked[i], truth[i]);
      }
    }
    quoin_stats stats;
    quoin_work_stats(work, &stats);
    assert_true(stats.packets < COUNT / 3); /* they do share packets */
    quoin_work_free(work);
  }
  assert_int_equal(unsetenv("QUOIN_ISA"), 0);
}

static void shuffle(uint64_t *state) {
  for (size_t i = COUNT - 1; i > 0; i--) {
    const size_t j = dice(state, (unsigned)i + 1);
    const quoin_ray ray = rays[i];
    const uint8_t was = truth[i];
    rays[i] = rays[j], truth[i] = truth[j];
    rays[j] = ray, truth[j] = was;
  }
}

static void scattered(void **unused) {
  (void)unused;
  char *text = malloc(64 * 1024);
  assert_non_null(text);
  size_t length = 0;
  for (int i = 0; i < 216; i++) { /* cubes and balls of 4 on a lattice of 7 */
    length += (size_t)snprintf(text + length, 64 * 1024 - length, "translate([%d, %d, %d]) %s;\n", 1 + i % 6 * 7, 1 + i / 6 % 6 * 7, 1 + i / 36 * 7,
                               i % 3 ? "cube(4)" : "translate([2, 2, 2]) sphere(2)");
  }
  ask a;
  ask_open(&a, text);
  free(text);
  uint64_t state = 11;
  size_t count[2] = {0, 0}, touches = 0;
  for (size_t k = 0; k < sizeof KINDS / sizeof *KINDS; k++) {
    for (size_t i = 0; i < COUNT; i++) {
      draw(&state, KINDS[k].d, &rays[i]);
      quoin_intervals answer;
      assert_int_equal(quoin_ray_intervals(a.scene, a.work, &rays[i], 0, &answer), QUOIN_OK);
      truth[i] = answer.count > 0;
      count[truth[i]]++;
      quoin_ray longer = rays[i]; /* what a range that ended later would meet */
      longer.to = nextafter(longer.to, INFINITY);
      assert_int_equal(quoin_ray_intervals(a.scene, a.work, &longer, 0, &answer), QUOIN_OK);
      touches += (answer.count > 0) != truth[i];
    }
    ask_all(&a, KINDS[k].what);
    shuffle(&state);
    ask_all(&a, KINDS[k].what);
  }
  print_message("%zu rays are blocked, %zu are not, %zu would be with a range that ended one double later\n", count[1], count[0], touches);
  assert_true(count[0] > COUNT && count[1] > COUNT && touches > 50);
  ask_close(&a);
}

/* Arrays with one entry that is no ray, wherever it stands. */
static void no_rays(void **unused) {
  (void)unused;
  ask a;
  ask_open(&a, "sphere(1);");
  enum { N = 130 };
  for (size_t at = 0; at < N; at += 43) {
    for (int what = 0; what < 8; what++) {
      for (size_t i = 0; i < N; i++) {
        rays[i] = (quoin_ray){{-5, 0.01 * (double)i, 0}, {1, 0, 0}, 0, INFINITY};
      }
      quoin_ray *r = &rays[at];
      switch (what) {
      case 0: r->o[1] = NAN; break;
      case 1: r->o[2] = INFINITY; break;
      case 2: r->d[1] = NAN; break;
      case 3: r->d[0] = -INFINITY; break;
      case 4: r->d[0] = 0; break;
      case 5: r->from = 2, r->to = 1; break;
      case 6: r->from = NAN; break;
      default: r->from = INFINITY; break;
      }
      assert_int_equal(quoin_rays_blocked(a.scene, a.work, N, rays, NULL, blocked), QUOIN_E_ARGUMENT);
    }
  }
  for (size_t i = 0; i < N; i++) {
    rays[i] = (quoin_ray){{-5, 0.01 * (double)i, 0}, {1, 0, i % 2 ? -0.0 : 0.0}, 0, INFINITY};
  }
  assert_int_equal(quoin_rays_blocked(a.scene, a.work, N, rays, NULL, blocked), QUOIN_OK);
  for (size_t i = 0; i < N; i++) {
    assert_int_equal(blocked[i], i < 100);
  }
  ask_close(&a);
}

/* Rays that all meet the ball, but for one that has one number of its own and does not, wherever it stands. */
static void one_differs(void **unused) {
  (void)unused;
  ask a;
  ask_open(&a, "sphere(1);");
  for (size_t n = 64; n <= 84; n += 20) {
    for (size_t at = 0; at < n; at++) {
      for (int what = 0; what < 5; what++) {
        for (size_t i = 0; i < n; i++) {
          rays[i] = (quoin_ray){{-5, 0.01 * (double)i, 0}, {1, 0, 0}, 0, INFINITY};
        }
        quoin_ray *r = &rays[at];
        double *const number[] = {&r->d[0], &r->d[1], &r->d[2], &r->from, &r->to};
        static const double own[] = {-1, 0.3, 0.3, 7, 3};
        *number[what] = own[what];
        assert_int_equal(quoin_rays_blocked(a.scene, a.work, n, rays, NULL, blocked), QUOIN_OK);
        for (size_t i = 0; i < n; i++) {
          assert_int_equal(blocked[i], i != at);
        }
      }
    }
  }
  ask_close(&a);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(scattered), cmocka_unit_test(no_rays), cmocka_unit_test(one_differs)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
