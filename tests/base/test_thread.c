/* The parallel loop: each index once, the lowest failure's status, progress from the caller's thread, stopping. */
#include "base/limits.h"
#include "base/thread.h"

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { N = 5000 };
typedef struct tally {
  atomic_int done[N];
  atomic_size_t count;
  unsigned threads;
  size_t fail_from; /* this index and all above it fail */
  pthread_t caller;
  size_t reports, stop_at;
  double last;
} tally;

static quoin_status body(void *user, unsigned thread, size_t i) {
  tally *t = user;
  assert_true(thread < t->threads);
  if (i >= t->fail_from) {
    return i == t->fail_from ? QUOIN_E_LIMIT : QUOIN_E_MODEL;
  }
  atomic_fetch_add(&t->done[i], 1);
  atomic_fetch_add(&t->count, 1);
  return QUOIN_OK;
}
static int report(void *user, double done) {
  tally *t = user;
  assert_true(pthread_equal(t->caller, pthread_self()));
  assert_true(done >= t->last && done >= 0 && done <= 1);
  t->last = done;
  return ++t->reports == t->stop_at;
}

static const unsigned widths[] = {1, 2, 3, 8, 300};

static void each_index_once(void **state) {
  (void)state;
  for (size_t k = 0; k < sizeof widths / sizeof *widths; k++) {
    for (size_t n = 0; n <= N; n = n ? n * 17 : 1) {
      static tally t;
      t = (tally){.threads = widths[k] < QN_MAX_THREADS ? widths[k] : QN_MAX_THREADS, .fail_from = N};
      assert_int_equal(qn_parallel(widths[k], n, body, &t, NULL), QUOIN_OK);
      assert_int_equal(t.count, n);
      for (size_t i = 0; i < n; i++) {
        assert_int_equal(t.done[i], 1);
      }
    }
  }
}

/* Every index below the one that fails was handed out before it, so the lowest failure is the same for every number of threads. */
static void the_lowest_failure_counts(void **state) {
  (void)state;
  for (size_t k = 0; k < sizeof widths / sizeof *widths; k++) {
    for (size_t from = 0; from < N; from = 3 * from + 1) {
      static tally t;
      t = (tally){.threads = QN_MAX_THREADS, .fail_from = from};
      assert_int_equal(qn_parallel(widths[k], N, body, &t, NULL), QUOIN_E_LIMIT);
      assert_int_equal(t.count, from);
    }
  }
}

static void progress_comes_from_the_caller_and_stops(void **state) {
  (void)state;
  for (size_t k = 0; k < sizeof widths / sizeof *widths; k++) {
    static tally t;
    t = (tally){.threads = QN_MAX_THREADS, .fail_from = N, .caller = pthread_self()};
    quoin_progress p = {report, &t};
    assert_int_equal(qn_parallel(widths[k], N, body, &t, &p), QUOIN_OK);
    assert_int_equal(t.count, N);
    /* asked before anything is done, so that it is asked also where the other threads take everything */
    t = (tally){.threads = QN_MAX_THREADS, .fail_from = N, .caller = pthread_self(), .stop_at = 1};
    assert_int_equal(qn_parallel(widths[k], N, body, &t, &p), QUOIN_E_CANCELLED);
    assert_int_equal(t.count, 0);
  }
  static tally t;
  t = (tally){.threads = 1, .fail_from = N, .caller = pthread_self(), .stop_at = 21};
  quoin_progress p = {report, &t};
  assert_int_equal(qn_parallel(1, N, body, &t, &p), QUOIN_E_CANCELLED);
  assert_int_equal(t.count, 20);
}

/* Loops of one crew, wide and narrow in turn, some shorter than their threads take to start: each index of each once, on no more threads than the loop may have. */
static void a_crew_runs_loop_after_loop(void **state) {
  (void)state;
  qn_crew crew;
  qn_crew_open(&crew);
  for (size_t k = 0; k < 400; k++) {
    static tally t;
    const unsigned width = widths[k * 7 % (sizeof widths / sizeof *widths)];
    const size_t n = k % 5 == 0 ? k % 3 : k * 37 % N, from = k % 4 == 3 ? n / 2 : N;
    t = (tally){.threads = width < QN_MAX_THREADS ? width : QN_MAX_THREADS, .fail_from = from};
    assert_int_equal(qn_crew_run(&crew, width, n, body, &t, NULL), from < n ? QUOIN_E_LIMIT : QUOIN_OK);
    assert_int_equal(t.count, from < n ? from : n);
    for (size_t i = 0; i < t.count; i++) {
      assert_int_equal(t.done[i], 1);
    }
  }
  qn_crew_close(&crew);
}

static void counts(void **state) {
  (void)state;
  assert_true(qn_processors() >= 1);
  assert_true(qn_thread_count(0) >= 1 && qn_thread_count(0) <= QN_MAX_THREADS);
  assert_int_equal(qn_thread_count(7), 7);
  assert_int_equal(qn_thread_count(100000), QN_MAX_THREADS);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(each_index_once), cmocka_unit_test(the_lowest_failure_counts), cmocka_unit_test(progress_comes_from_the_caller_and_stops),
    cmocka_unit_test(a_crew_runs_loop_after_loop), cmocka_unit_test(counts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
