/* Smaller runs of tests whose size is a count of cases, for programs that are many times as slow (valgrind, sanitizers): QUOIN_TEST_SHARE=0.02 takes one case in
   fifty. Without the variable nothing is left out. docs/reliability.md says who sets it. */
#ifndef QN_TESTS_SHARE_H
#define QN_TESTS_SHARE_H

#include <math.h>
#include <stdlib.h>

static inline double share_asked(void) {
  static double share;
  if (!(share > 0)) {
    const char *text = getenv("QUOIN_TEST_SHARE");
    double asked = text ? strtod(text, NULL) : 1;
    share = asked > 0 && asked < 1 ? asked : 1;
  }
  return share;
}

/* So many of n cases, but not fewer than `fewest` where there are as many: kinds of cases are drawn, and each has to come up. */
static inline int share_from(int fewest, int n) {
  int some = (int)(n * share_asked());
  return some >= fewest || some >= n ? some : n < fewest ? n : fewest;
}
static inline int share_of(int n) {
  return share_from(40, n);
}

/* What a census that counts more than n of a kind asks of a share: half of what is proportional, less three deviations of that many, as cases are drawn in other
   orders by other compilers and a kind may come in clusters. Nothing (a negative number) where the kind may not come up at all. (A double, because counts are of any
   type.) */
static inline double share_min(int n) {
  const double proportional = n * share_asked();
  return share_asked() < 1 ? proportional / 2 - 3 * sqrt(proportional) : n;
}

/* Whether all cases are run: how near the worst of them comes to a bound is asked of all only. */
static inline int share_whole(void) {
  return share_asked() >= 1;
}

#endif
