/* Threads: one parallel loop with work taken in turn, a crew for several of them, and the number of processors. */
#ifndef QN_BASE_THREAD_H
#define QN_BASE_THREAD_H

#include "base/limits.h"
#include "quoin/types.h"

#include <pthread.h>
#include <stdatomic.h>

/* Processors this process may run on, at least 1. */
unsigned qn_processors(void);

/* The number of threads to use for a wish (0: qn_processors()), at least 1 and at most QN_MAX_THREADS. */
unsigned qn_thread_count(unsigned wish);

/* Calls body(user, thread, i) once for each i in [0, n), i in increasing order per thread, on up to `threads` threads of
   which the calling one is number 0. Stops handing out work when a body returns other than QUOIN_OK, and returns the
   status of the lowest such i that ran; calls the progress report (may be null) from the calling thread, once before the first body. If a thread cannot be
   started the others do its work. */
quoin_status qn_parallel(unsigned threads, size_t n, quoin_status (*body)(void *user, unsigned thread, size_t i), void *user,
                         const quoin_progress *progress);

/* Threads for several such loops, one after the other: they start with the first loop that has work for them and wait for the next one. A loop ends when its work is
   done; a thread that has not come to it by then (a busy machine may be slow to start it) is not waited for until the crew is closed. */
typedef struct qn_crew_worker {
  struct qn_crew *crew;
  unsigned number;
  size_t failed_at;
  quoin_status status;
} qn_crew_worker;
typedef struct qn_crew {
  pthread_mutex_t lock;
  pthread_cond_t called, left; /* a pass is open, or all is over; the last one busy is done */
  uint64_t pass;
  int open, over;
  unsigned wide, busy, started; /* wide: threads that may take part in this pass, the caller's among them; started: that there are */
  atomic_size_t next;
  atomic_int stop;
  size_t n;
  quoin_status (*body)(void *user, unsigned thread, size_t i);
  void *user;
  qn_crew_worker workers[QN_MAX_THREADS];
  pthread_t ids[QN_MAX_THREADS];
} qn_crew;
void qn_crew_open(qn_crew *crew);
/* As qn_parallel; by one thread at a time. */
quoin_status qn_crew_run(qn_crew *crew, unsigned threads, size_t n, quoin_status (*body)(void *user, unsigned thread, size_t i), void *user,
                         const quoin_progress *progress);
void qn_crew_close(qn_crew *crew);

#endif
