#include "shape/super_long.h"

#include <math.h>

enum { LONG = 2048 }; /* bits: shorter fractions are added as quickly */

int qn_super_long_make(const qn_super_exact *line, qn_super_long *out) {
  qn_ctx *ctx = line->ctx;
  size_t longest = 0;
  for (int i = 0; i < 3; i++) {
    if (qn_num_is_rounded(line->O[i]) || qn_num_is_rounded(line->D[i])) {
      return 0;
    }
    const qn_num numbers[2] = {line->O[i], line->D[i]};
    for (int k = 0; k < 2; k++) {
      const qn_mark mark = qn_arena_mark(&ctx->arena);
      const qn_rat r = qn_num_rat(ctx, numbers[k]);
      const size_t bits = qn_int_bits(r.num) + qn_int_bits(r.den);
      longest = bits > longest ? bits : longest;
      qn_arena_release(&ctx->arena, mark);
    }
  }
  if (longest < LONG || ctx->failed != QUOIN_OK) {
    return 0;
  }
  for (int i = 0; i < 3; i++) {
    const qn_rat o = qn_num_rat(ctx, line->O[i]), d = qn_num_rat(ctx, line->D[i]);
    const qn_int common = qn_int_gcd(ctx, o.den, d.den), more = qn_int_divexact(ctx, d.den, common);
    out->over[i] = qn_int_mul(ctx, o.den, more);
    out->O[i] = qn_int_mul(ctx, o.num, more);
    out->D[i] = qn_int_mul(ctx, d.num, qn_int_divexact(ctx, o.den, common));
  }
  return ctx->failed == QUOIN_OK;
}

/* The precision that holds it. */
static mpfr_prec_t length(qn_int v) {
  const size_t bits = qn_int_bits(v);
  return bits < MPFR_PREC_MIN ? MPFR_PREC_MIN : (mpfr_prec_t)bits;
}

static void set(mpfr_t out, qn_int v) {
  mpz_t view; /* nothing of it is freed */
  mpz_roinit_n(view, v.d, v.n);
  mpfr_set_z(out, view, MPFR_RNDN);
}

void qn_super_long_at(qn_ctx *ctx, const qn_super_long *line, int i, double t, mpfr_t out) {
  const qn_mark mark = qn_arena_mark(&ctx->arena);
  int e;
  const int64_t m = (int64_t)ldexp(frexp(t, &e), 53); /* t = m 2^(e - 53) */
  e -= 53;
  qn_int from = line->O[i], way = qn_int_mul(ctx, line->D[i], qn_int_from(ctx, m));
  if (e < 0) {
    from = qn_int_shl(ctx, from, (size_t)-e);
  } else {
    way = qn_int_shl(ctx, way, (size_t)e);
  }
  const qn_int sum = qn_int_add(ctx, from, way);
  mpfr_t over, under;
  mpfr_init2(over, length(sum)), mpfr_init2(under, length(line->over[i]));
  set(over, sum), set(under, line->over[i]);
  mpfr_div(out, over, under, MPFR_RNDN);
  if (e < 0) {
    mpfr_mul_2si(out, out, e, MPFR_RNDN);
  }
  mpfr_clears(over, under, (mpfr_ptr)NULL);
  qn_arena_release(&ctx->arena, mark);
}
