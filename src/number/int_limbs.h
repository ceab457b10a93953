/* What the files of qn_int share: taking limbs, and making an integer of them. For src/number only. */
#ifndef QN_NUMBER_INT_LIMBS_H
#define QN_NUMBER_INT_LIMBS_H

#include "number/int.h"

#include <math.h>

#define QN_INT_ZERO_ ((qn_int){0, NULL})

QN_INLINE mp_size_t qn_limbs_(qn_int a) { return a.n < 0 ? -a.n : a.n; }

void qn_ctx_fail_(qn_ctx *ctx, quoin_status status); /* the first failure stays */
mp_limb_t *qn_limbs_take_(qn_ctx *ctx, size_t limbs); /* null when refused, and then the context has failed */

/* Whether a result of so many bits is allowed; the context has failed where not. */
QN_INLINE int qn_bits_allowed_(qn_ctx *ctx, size_t bits) {
  if (QN_UNLIKELY(ctx->max_bits != 0 && bits > ctx->max_bits)) {
    qn_ctx_fail_(ctx, QUOIN_E_LIMIT);
    return 0;
  }
  return 1;
}

/* An integer of limbs that belong to the arena already: strips leading zeros, checks the size. */
qn_int qn_limbs_int_(qn_ctx *ctx, const mp_limb_t *d, mp_size_t n, int negative);

#endif
