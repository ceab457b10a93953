/* The dice of the tests of wide code: one sequence, the same in every run. */
#ifndef QN_TESTS_WIDE_DICE_H
#define QN_TESTS_WIDE_DICE_H

#include <math.h>
#include <stdint.h>

static uint64_t dice_state = 0x2545f4914f6cdd1du;
static inline uint64_t next(void) {
  dice_state ^= dice_state << 13, dice_state ^= dice_state >> 7, dice_state ^= dice_state << 17;
  return dice_state;
}
static inline int one_in(unsigned n) { return (next() >> 20) % n == 0; }
static inline int below(int n) { return (int)((next() >> 20) % (uint64_t)n); }

/* In [-1, 1]; one in `few` with `bits` bits only. */
static inline double part_of(unsigned few, int bits) {
  double v = (double)(int64_t)next() * 0x1p-63;
  return one_in(few) ? ldexp(floor(ldexp(v, bits)), -bits) : v;
}

#endif
