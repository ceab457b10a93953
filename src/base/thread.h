/* Threads: one parallel loop with work taken in turn, and the number of processors. */
#ifndef QN_BASE_THREAD_H
#define QN_BASE_THREAD_H

#include "quoin/types.h"

/* Processors this process may run on, at least 1. */
unsigned qn_processors(void);

/* The number of threads to use for a wish (0: qn_processors()), at least 1 and at most QN_MAX_THREADS. */
unsigned qn_thread_count(unsigned wish);

/* Calls body(user, thread, i) once for each i in [0, n), i in increasing order per thread, on up to `threads` threads of
   which the calling one is number 0. Stops handing out work when a body returns other than QUOIN_OK, and returns the
   status of the lowest such i that ran; calls the progress report (may be null) from the calling thread. If a thread cannot be
   started the others do its work. */
quoin_status qn_parallel(unsigned threads, size_t n, quoin_status (*body)(void *user, unsigned thread, size_t i), void *user,
                         const quoin_progress *progress);

#endif
