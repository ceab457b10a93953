#define _GNU_SOURCE /* sched_getaffinity */
#include "base/thread.h"
#include "base/limits.h"

#include <mpfr.h>
#include <sched.h>
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

typedef qn_crew_worker worker;

static int told_to_stop(const quoin_progress *progress, double done) {
  return progress && progress->report && progress->report(progress->user, done);
}

static void work(worker *w, const quoin_progress *progress) {
  qn_crew *p = w->crew;
  while (!atomic_load_explicit(&p->stop, memory_order_relaxed)) {
    size_t i = atomic_fetch_add_explicit(&p->next, 1, memory_order_relaxed);
    if (i >= p->n) {
      return;
    }
    quoin_status s = p->body(p->user, w->number, i);
    if (s == QUOIN_OK && told_to_stop(progress, (double)i / (double)p->n)) {
      s = QUOIN_E_CANCELLED;
    }
    if (s != QUOIN_OK) {
      w->status = s;
      w->failed_at = i;
      atomic_store_explicit(&p->stop, 1, memory_order_relaxed);
    }
  }
}

/* A thread of the crew: takes part in each pass that is open when it comes to look. One that comes late finds the next one, or none; nobody waits for it. */
static void *serve(void *arg) {
  worker *w = arg;
  qn_crew *c = w->crew;
  uint64_t seen = 0;
  pthread_mutex_lock(&c->lock);
  while (!c->over) {
    if (!c->open || c->pass == seen || w->number >= c->wide) {
      pthread_cond_wait(&c->called, &c->lock);
      continue;
    }
    seen = c->pass;
    c->busy++;
    pthread_mutex_unlock(&c->lock);
    work(w, NULL);
    pthread_mutex_lock(&c->lock);
    if (--c->busy == 0) {
      pthread_cond_signal(&c->left);
    }
  }
  pthread_mutex_unlock(&c->lock);
  mpfr_free_cache2(MPFR_FREE_LOCAL_CACHE); /* what exact arithmetic kept for this thread alone would be lost with it */
  return NULL;
}

void qn_crew_open(qn_crew *c) {
  c->started = 1;
  c->workers[0].crew = c, c->workers[0].number = 0;
  c->wide = c->busy = 0;
  c->pass = 0;
  c->open = c->over = 0;
  pthread_mutex_init(&c->lock, NULL);
  pthread_cond_init(&c->called, NULL);
  pthread_cond_init(&c->left, NULL);
}

quoin_status qn_crew_run(qn_crew *c, unsigned threads, size_t n, quoin_status (*body)(void *, unsigned, size_t), void *user, const quoin_progress *progress) {
  threads = threads > QN_MAX_THREADS ? QN_MAX_THREADS : threads < 1 ? 1 : threads;
  threads = threads > n ? (n ? (unsigned)n : 1) : threads;
  if (told_to_stop(progress, 0)) { /* the caller is asked once at least, also where other threads take every i */
    return QUOIN_E_CANCELLED;
  }
  pthread_mutex_lock(&c->lock); /* no pass is open: nobody but this thread looks at what is set here */
  c->n = n, c->body = body, c->user = user;
  atomic_store_explicit(&c->next, 0, memory_order_relaxed);
  atomic_store_explicit(&c->stop, 0, memory_order_relaxed);
  for (unsigned i = 0; i < threads; i++) {
    worker *w = &c->workers[i];
    w->failed_at = n, w->status = QUOIN_OK;
    if (i >= c->started) { /* the others' threads may only now come to read who they are */
      w->crew = c, w->number = i;
    }
  }
  c->wide = threads;
  c->pass++;
  c->open = 1;
  pthread_cond_broadcast(&c->called);
  pthread_mutex_unlock(&c->lock);
  while (c->started < threads && pthread_create(&c->ids[c->started], NULL, serve, &c->workers[c->started]) == 0) {
    c->started++;
  }
  work(&c->workers[0], progress);
  pthread_mutex_lock(&c->lock);
  c->open = 0;
  while (c->busy) {
    pthread_cond_wait(&c->left, &c->lock);
  }
  pthread_mutex_unlock(&c->lock);
  const worker *first = &c->workers[0];
  for (unsigned i = 1; i < threads; i++) {
    if (c->workers[i].failed_at < first->failed_at) {
      first = &c->workers[i];
    }
  }
  return first->status;
}

void qn_crew_close(qn_crew *c) {
  pthread_mutex_lock(&c->lock);
  c->over = 1;
  pthread_cond_broadcast(&c->called);
  pthread_mutex_unlock(&c->lock);
  for (unsigned i = 1; i < c->started; i++) {
    pthread_join(c->ids[i], NULL);
  }
  pthread_cond_destroy(&c->left);
  pthread_cond_destroy(&c->called);
  pthread_mutex_destroy(&c->lock);
}

quoin_status qn_parallel(unsigned threads, size_t n, quoin_status (*body)(void *, unsigned, size_t), void *user, const quoin_progress *progress) {
  qn_crew crew;
  qn_crew_open(&crew);
  const quoin_status status = qn_crew_run(&crew, threads, n, body, user, progress);
  qn_crew_close(&crew);
  return status;
}
