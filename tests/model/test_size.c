/* Large and deep models: a million leaves in bounded memory, with their time printed; 100,000 levels of nesting. */
#include "model/tree.h"
#include "share.h"

#include <time.h>

static double seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

typedef struct meter { size_t used, peak; } meter;

static void count(meter *m, size_t less, size_t more) {
  m->used = m->used - less + more;
  m->peak = m->used > m->peak ? m->used : m->peak;
}
static void *meter_alloc(void *user, size_t size) {
  count(user, 0, size);
  return malloc(size);
}
static void *meter_resize(void *user, void *block, size_t old_size, size_t new_size) {
  count(user, old_size, new_size);
  return realloc(block, new_size);
}
static void meter_release(void *user, void *block, size_t size) {
  count(user, size, 0);
  free(block);
}

static void million(void **state) {
  (void)state;
  enum { LINE = 60 };
  const int N = share_of(1000000);
  char *text = malloc((size_t)N * LINE);
  assert_non_null(text);
  size_t length = 0;
  uint32_t seed = 1;
  for (int i = 0; i < N; i++) {
    seed = seed * 1664525u + 1013904223u;
    length += (size_t)snprintf(text + length, LINE, "translate([%d.%03d, %d, -%d.5]) sphere(r = 0.%d);\n", i % 100, (int)(seed >> 22) % 1000,
                               i / 100 % 100, i / 10000, (int)(seed >> 28) + 1);
  }
  meter m = {0, 0};
  quoin_allocator a = {meter_alloc, meter_resize, meter_release, &m, 0};
  quoin_model *model;
  assert_int_equal(quoin_model_new(&a, &model), QUOIN_OK);
  double start = seconds();
  assert_int_equal(quoin_model_read_text(model, QUOIN_ROOT, "t", text, length, NULL), QUOIN_OK);
  double took = seconds() - start;
  print_message("%d leaves, %zu bytes of text: %.2f s, peak %zu MB, kept %zu MB\n", N, length, took, m.peak >> 20, m.used >> 20);
  assert_int_equal(model->leaf_count, N);
  assert_true(m.peak < (size_t)800 << 20);
  quoin_model_free(model);
  assert_int_equal(m.used, 0);
  free(text);
}

static void deep(const char *open, const char *close, const char *inside, size_t n) {
  size_t a = strlen(open), b = strlen(close), c = strlen(inside);
  char *text = malloc(n * (a + b) + c + 1);
  assert_non_null(text);
  char *at = text;
  for (size_t i = 0; i < n; i++, at += a) {
    memcpy(at, open, a);
  }
  memcpy(at, inside, c + 1);
  at += c;
  for (size_t i = 0; i < n; i++, at += b) {
    memcpy(at, close, b);
  }
  quoin_model *m = tree_read(text, (size_t)(at - text));
  assert_int_equal(m->node_count, n + 2);
  tree_round(m);
  quoin_model_free(m);
  free(text);
}

static void depth(void **state) {
  (void)state;
  deep("union(){", "}", "cube(1);", 100000);
  deep("translate([1,2,3]) ", "", "cube(1);", 100000);
  deep("difference() { x = 1; ", " y = x; }", "cube(1);", 100000);
}

/* Files that are large in one way must not cost more than linear time. */
static void wide(void **state) {
  (void)state;
  const int N = share_of(200000);
  char *text = malloc((size_t)N * 40 + 100);
  assert_non_null(text);
  static const struct { const char *each, *end; int status; } kinds[] = {
    {"a%d = %d;", "cube(1);", QUOIN_OK},                  /* names */
    {"a = %d + 0*%d;", "cube(a);", QUOIN_OK},             /* one name again and again: a warning each */
    {"name(\"n%d\") cube(%d);", "", QUOIN_OK},
    {"cube(0*%d%d);", "", QUOIN_OK},                      /* warnings */
    {"}%d%d", "", QUOIN_E_MODEL},                         /* errors */
    {"echo(%d, %d);", "", QUOIN_OK},
  };
  for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
    size_t length = 0;
    for (int i = 0; i < N; i++) {
      length += (size_t)snprintf(text + length, 40, kinds[k].each, i, i + 1);
    }
    length += (size_t)snprintf(text + length, 40, "%s", kinds[k].end);
    quoin_model *m;
    assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
    double start = seconds();
    assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "t", text, length, NULL), kinds[k].status);
    assert_true(quoin_model_diag_count(m) <= 101);
    assert_true(seconds() - start < 20);
    quoin_model_free(m);
  }
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(million), cmocka_unit_test(depth), cmocka_unit_test(wide)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
