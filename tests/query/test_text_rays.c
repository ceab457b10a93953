/* Many rays of decimals at once against the same rays one by one: in no order, so that they are sorted (src/query/text_rays.c), with rays among them that packets do not take. */
#include "ask.h"

enum { COUNT = 6000, SIZE = 32 };
static char texts[COUNT][6][SIZE];
static const char *numbers[COUNT * 6];

static unsigned dice(uint64_t *state, unsigned n) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (unsigned)(*state >> 33) % n;
}

typedef struct told {
  const ask *a;
  const char *from, *to;
  size_t next, stretches, stop; /* stop: who is told wants no more after so many */
  unsigned want;
} told;

static void assert_same(const quoin_end *x, const quoin_end *y) {
  assert_memory_equal(&x->t, &y->t, sizeof x->t);
  assert_int_equal(x->part, y->part);
  assert_int_equal(x->role, y->role);
}

static int compare(void *user, size_t i, const quoin_intervals *answer) {
  told *t = user;
  assert_int_equal(i, t->next);
  t->next++;
  quoin_work *work;
  static quoin_interval mine[64];
  const size_t count = answer->count;
  assert_true(count <= 64);
  memcpy(mine, answer->inside, count * sizeof *mine);
  assert_int_equal(quoin_work_new(t->a->scene, &work), QUOIN_OK);
  quoin_intervals alone;
  assert_int_equal(quoin_ray_intervals_text(t->a->scene, work, numbers + 6 * i, t->from, t->to, t->want, &alone), QUOIN_OK);
  if (count != alone.count) {
    fail_msg("ray %zu, %s %s %s along %s %s %s: %zu stretches, not %zu", i, numbers[6 * i], numbers[6 * i + 1], numbers[6 * i + 2], numbers[6 * i + 3], numbers[6 * i + 4],
             numbers[6 * i + 5], count, alone.count);
  }
  for (size_t k = 0; k < count; k++) {
    assert_same(&mine[k].enter, &alone.inside[k].enter);
    assert_same(&mine[k].leave, &alone.inside[k].leave);
  }
  quoin_work_free(work);
  t->stretches += count;
  return t->next == t->stop;
}

/* Places in a square of 100 seen along z, or in a cube of it; tenths and thousandths, often on the balls' edges and the boxes' faces. */
static void draw(uint64_t *state, const char *const d[3], size_t i) {
  for (int k = 0; k < 6; k++) {
    if (k >= 3) {
      snprintf(texts[i][k], SIZE, "%s", d[k - 3]);
    } else if (dice(state, 3) == 0) {
      snprintf(texts[i][k], SIZE, "%u", dice(state, 101));
    } else {
      snprintf(texts[i][k], SIZE, "%u.%0*u", dice(state, 100), dice(state, 2) ? 1 : 6, dice(state, 10));
    }
    numbers[6 * i + (size_t)k] = texts[i][k];
  }
}

static void unordered(void **unused) {
  (void)unused;
  char *text = malloc(64 * 1024);
  assert_non_null(text);
  size_t length = (size_t)snprintf(text, 64 * 1024, "difference() { cube(100); union() {\n");
  for (int i = 0; i < 400; i++) {
    length += (size_t)snprintf(text + length, 64 * 1024 - length, "translate([%d, %d, %d]) %s;\n", i % 20 * 5, i / 20 * 5, i % 7 * 14 - 5,
                               i % 2 ? "sphere(2)" : "cube([2, 2.1, 30])");
  }
  snprintf(text + length, 64 * 1024 - length, "}}\n");
  ask a;
  ask_open(&a, text);
  free(text);
  static const char *const ways[][3] = {{"0", "0", "1"}, {"0.1", "-0.2", "0.7"}, {"1", "2", "-3"}, {"0.1", "-0.2", "0.7"}};
  uint64_t state = 5;
  for (size_t w = 0; w < sizeof ways / sizeof *ways; w++) {
    const size_t n = w == 0 ? COUNT : 1500;
    for (size_t i = 0; i < n; i++) {
      draw(&state, ways[w], i);
      if (w == 3 && i % 2) { /* the same double, and another direction */
        numbers[6 * i + 5] = "0.70000000000000001";
      }
    }
    if (w == 1) { /* too long for packets: the rest goes on after it */
      numbers[6 * 700] = "0.1234567890123456789012345678901234567890";
    }
    told t = {.a = &a, .from = w == 2 ? "0.1" : NULL, .to = w == 2 ? "20.5" : NULL};
    quoin_work_free(a.work);
    assert_int_equal(quoin_work_new(a.scene, &a.work), QUOIN_OK);
    assert_int_equal(quoin_ray_intervals_many_text(a.scene, a.work, n, numbers, t.from, t.to, 0, compare, &t), QUOIN_OK);
    assert_int_equal(t.next, n);
    assert_true(t.stretches > n / 2);
    quoin_stats stats;
    quoin_work_stats(a.work, &stats);
    print_message("%zu rays, %zu stretches, %zu packets, %zu rays woven\n", n, t.stretches, (size_t)stats.packets, (size_t)stats.exact_rays);
    assert_true(stats.packets < (w == 0 ? n / 3 : n) || w == 3); /* they do share packets; fewer where they lie further apart */
  }
  /* A wrong ray: the answers before it are given. Who wants no more is asked no more. */
  numbers[6 * 900 + 1] = "x";
  told t = {.a = &a, .from = "0.1", .to = "20.5"};
  assert_int_equal(quoin_ray_intervals_many_text(a.scene, a.work, 1500, numbers, t.from, t.to, 0, compare, &t), QUOIN_E_NUMBER);
  assert_int_equal(t.next, 900);
  t.next = 0, t.stop = 333;
  assert_int_equal(quoin_ray_intervals_many_text(a.scene, a.work, 1500, numbers, t.from, t.to, 0, compare, &t), QUOIN_E_CANCELLED);
  assert_int_equal(t.next, 333);
  ask_close(&a);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(unordered)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
