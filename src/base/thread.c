#define _GNU_SOURCE /* sched_getaffinity */
#include "base/thread.h"
#include "base/limits.h"

#include <mpfr.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <unistd.h>

unsigned qn_processors(void) {
#ifdef __linux__
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) {
    int n = CPU_COUNT(&set);
    if (n > 0) {
      return (unsigned)n;
    }
  }
#endif
  long n = sysconf(_SC_NPROCESSORS_ONLN);
  return n > 0 ? (unsigned)n : 1;
}

unsigned qn_thread_count(unsigned wish) {
  unsigned n = wish ? wish : qn_processors();
  return n < QN_MAX_THREADS ? n : QN_MAX_THREADS;
}

typedef struct pool {
  atomic_size_t next;
  size_t n;
  atomic_int stop;
  quoin_status (*body)(void *, unsigned, size_t);
  void *user;
} pool;

typedef struct worker {
  pool *p;
  unsigned number;
  size_t failed_at;
  quoin_status status;
} worker;

static void work(worker *w, const quoin_progress *progress) {
  pool *p = w->p;
  while (!atomic_load_explicit(&p->stop, memory_order_relaxed)) {
    size_t i = atomic_fetch_add_explicit(&p->next, 1, memory_order_relaxed);
    if (i >= p->n) {
      return;
    }
    quoin_status s = p->body(p->user, w->number, i);
    if (s == QUOIN_OK && progress && progress->report && progress->report(progress->user, (double)i / (double)p->n)) {
      s = QUOIN_E_CANCELLED;
    }
    if (s != QUOIN_OK) {
      w->status = s;
      w->failed_at = i;
      atomic_store_explicit(&p->stop, 1, memory_order_relaxed);
    }
  }
}

static void *run(void *arg) {
  work(arg, NULL);
  mpfr_free_cache2(MPFR_FREE_LOCAL_CACHE); /* what exact arithmetic kept for this thread alone would be lost with it */
  return NULL;
}

quoin_status qn_parallel(unsigned threads, size_t n, quoin_status (*body)(void *, unsigned, size_t), void *user, const quoin_progress *progress) {
  pool p = {.n = n, .body = body, .user = user};
  atomic_init(&p.next, 0);
  atomic_init(&p.stop, 0);
  worker workers[QN_MAX_THREADS];
  pthread_t ids[QN_MAX_THREADS];
  threads = threads > QN_MAX_THREADS ? QN_MAX_THREADS : threads;
  threads = threads > n ? (unsigned)n : threads;
  unsigned started = 1;
  for (; started < threads; started++) {
    workers[started] = (worker){&p, started, n, QUOIN_OK};
    if (pthread_create(&ids[started], NULL, run, &workers[started])) {
      break;
    }
  }
  workers[0] = (worker){&p, 0, n, QUOIN_OK};
  work(&workers[0], progress);
  for (unsigned i = 1; i < started; i++) {
    pthread_join(ids[i], NULL);
  }
  const worker *first = &workers[0];
  for (unsigned i = 1; i < started; i++) {
    if (workers[i].failed_at < first->failed_at) {
      first = &workers[i];
    }
  }
  return first->status;
}
