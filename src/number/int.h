/* Exact integers on GMP's mpn layer, as values that live in an arena: an expression of them is written as it is read,
   nothing is freed one by one, and want of memory is a flag looked at once at the end.

   Legend: a qn_int is sign and magnitude; |n| limbs at d, least first, the top one not zero; n < 0 means negative,
   n == 0 is zero (d unused). Limbs are never written after they were made, so copies may share them. */
#ifndef QN_NUMBER_INT_H
#define QN_NUMBER_INT_H

#include "base/mem.h"

#include <gmp.h>

typedef struct qn_int {
  mp_size_t n;
  const mp_limb_t *d;
} qn_int;

/* Where results live. `failed` is set when memory was refused or a number passed `max_bits` (when that is not 0): results are then
   zero, and whoever owns the context must look before it believes a sign. One thread at a time. */
typedef struct qn_ctx {
  qn_arena arena;
  quoin_status failed; /* QUOIN_OK, QUOIN_E_MEMORY or QUOIN_E_LIMIT */
  size_t max_bits;     /* a larger result fails with QUOIN_E_LIMIT; 0: none */
  uint64_t effort;     /* what was done: the square of the limbs of every result, which bounds its cost, and what else is spent */
  uint64_t max_effort; /* more fails with QUOIN_E_LIMIT; 0: none */
} qn_ctx;

void qn_ctx_init(qn_ctx *ctx, qn_mem *mem);
void qn_ctx_free(qn_ctx *ctx);

int qn_ctx_spend(qn_ctx *ctx, size_t count, unsigned each); /* count things of so much effort; 0 when that is too much, and the context has failed */

qn_int qn_int_from(qn_ctx *ctx, int64_t v);
qn_int qn_int_from_limbs(qn_ctx *ctx, const mp_limb_t *limbs, mp_size_t n, int negative); /* copies, strips leading zeros */
qn_int qn_int_copy(qn_ctx *to, qn_int a); /* into another context */
QN_INLINE int qn_int_sign(qn_int a) { return (a.n > 0) - (a.n < 0); }
QN_INLINE qn_int qn_int_neg(qn_int a) { return (qn_int){-a.n, a.d}; }
QN_INLINE qn_int qn_int_abs(qn_int a) { return (qn_int){a.n < 0 ? -a.n : a.n, a.d}; }
size_t qn_int_bits(qn_int a); /* of |a|: 0 for 0, 1 for 1, 2 for 2 and 3 */
int qn_int_cmp(qn_int a, qn_int b); /* -1, 0, 1 */
int qn_int_equal(qn_int a, qn_int b);
uint64_t qn_int_hash(qn_int a);
int qn_int_fits(qn_int a, int64_t *out);

qn_int qn_int_add(qn_ctx *ctx, qn_int a, qn_int b);
qn_int qn_int_sub(qn_ctx *ctx, qn_int a, qn_int b);
qn_int qn_int_mul(qn_ctx *ctx, qn_int a, qn_int b);
qn_int qn_int_shl(qn_ctx *ctx, qn_int a, size_t bits);
qn_int qn_int_shr(qn_ctx *ctx, qn_int a, size_t bits); /* of the magnitude: towards zero */
size_t qn_int_trailing_zeros(qn_int a); /* 0 for 0 */
qn_int qn_int_gcd(qn_ctx *ctx, qn_int a, qn_int b); /* >= 0; gcd(0, b) = |b| */
qn_int qn_int_divexact(qn_ctx *ctx, qn_int a, qn_int b); /* b divides a, b != 0 */
void qn_int_divmod(qn_ctx *ctx, qn_int a, qn_int b, qn_int *quotient, qn_int *remainder); /* towards zero; b != 0 */
qn_int qn_int_sqrt(qn_ctx *ctx, qn_int a, int *exact); /* floor of the root, a >= 0 */
qn_int qn_int_pow(qn_ctx *ctx, qn_int a, unsigned e);

/* |a| = m * 2^e with m rounded to nearest (ties to even) on 53 bits, as the double a itself where it fits; infinite beyond. */
double qn_int_to_double(qn_int a);
/* a = *m * 2^*e with 0.5 <= |*m| < 1, rounded towards zero to 53 bits; *m = 0 for 0. Never over- or underflows. */
void qn_int_frexp(qn_int a, double *m, int64_t *e);

/* Decimal digits with a leading '-' where negative; into the arena, null on failure. */
char *qn_int_text(qn_ctx *ctx, qn_int a);
/* Reads `length` decimal digits (no sign). */
qn_int qn_int_from_digits(qn_ctx *ctx, const char *digits, size_t length);

#endif
