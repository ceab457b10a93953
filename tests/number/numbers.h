/* What the tests of number/ share: random numbers of every shape, an allocator that refuses, and GMP's mpz and mpq as
   the judge. */
#ifndef NUMBERS_H
#define NUMBERS_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "number/num.h"

static inline uint64_t random_bits(uint64_t *state) { /* splitmix64 */
  uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return z ^ (z >> 31);
}
static inline size_t random_below(uint64_t *state, size_t n) { return (size_t)(random_bits(state) % n); }

/* Up to `most` limbs, often fewer; runs of ones, zeros, powers of two and limbs that are all ones are frequent. */
static inline qn_int random_int(qn_ctx *ctx, uint64_t *state, size_t most) {
  mp_limb_t d[64];
  size_t n = random_below(state, most + 1);
  for (size_t i = 0; i < n; i++) {
    switch (random_below(state, 5)) {
      case 0: d[i] = 0; break;
      case 1: d[i] = ~(mp_limb_t)0; break;
      case 2: d[i] = (mp_limb_t)1 << random_below(state, 64); break;
      case 3: d[i] = random_bits(state) >> random_below(state, 64); break;
      default: d[i] = random_bits(state);
    }
  }
  return qn_int_from_limbs(ctx, d, (mp_size_t)n, (int)random_below(state, 2));
}

static inline void to_mpz(mpz_t z, qn_int a) {
  mpz_t view;
  mpz_set(z, mpz_roinit_n(view, a.d, a.n));
}
/* The same number in the same canonical form. */
static inline int same_mpz(qn_int a, const mpz_t z) {
  mpz_t view;
  mp_size_t n = a.n < 0 ? -a.n : a.n;
  return (n == 0 || a.d[n - 1] != 0) && mpz_cmp(mpz_roinit_n(view, a.d, a.n), z) == 0;
}

/* An allocator that refuses everything after `left` allocations, and counts what is out. */
typedef struct refusing { size_t left, out; } refusing;
static inline void *refusing_alloc(void *user, size_t size) {
  refusing *r = user;
  void *p = r->left ? malloc(size) : NULL;
  r->left -= r->left > 0;
  r->out += p != NULL;
  return p;
}
static inline void *refusing_resize(void *user, void *block, size_t old_size, size_t new_size) {
  refusing *r = user;
  (void)old_size;
  if (!r->left) {
    return NULL;
  }
  r->left--;
  return realloc(block, new_size);
}
static inline void refusing_release(void *user, void *block, size_t size) {
  refusing *r = user;
  (void)size;
  r->out--;
  free(block);
}

typedef struct setup { qn_mem mem; qn_ctx ctx; } setup;
static inline void setup_init(setup *s, refusing *r) { /* r null: malloc */
  quoin_allocator a = {refusing_alloc, refusing_resize, refusing_release, r, 0};
  qn_mem_init(&s->mem, r ? &a : NULL);
  qn_ctx_init(&s->ctx, &s->mem);
}
static inline void setup_free(setup *s) {
  qn_ctx_free(&s->ctx);
  assert_int_equal(s->mem.used, 0);
}

#endif
