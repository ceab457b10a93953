/* Exact integers on GMP's mpn layer: making them, comparing them, the four operations and shifts.
   Every result is new memory of the arena, or shares the limbs of an operand that it equals. */
#include "number/int_limbs.h"

_Static_assert(GMP_LIMB_BITS == 64 && GMP_NAIL_BITS == 0, "limbs are whole 64-bit words");

/* More limbs than this are refused as memory would be: sizes in bits and bytes then never overflow. */
#define LARGEST ((size_t)1 << 48)

void qn_ctx_init(qn_ctx *ctx, qn_mem *mem) {
  qn_arena_init(&ctx->arena, mem);
  ctx->failed = QUOIN_OK;
  ctx->max_bits = 0;
  ctx->effort = ctx->max_effort = 0;
}

void qn_ctx_free(qn_ctx *ctx) {
  qn_arena_free(&ctx->arena);
}

void qn_ctx_fail_(qn_ctx *ctx, quoin_status status) {
  if (ctx->failed == QUOIN_OK) {
    ctx->failed = status;
  }
}

int qn_ctx_spend(qn_ctx *ctx, size_t count, unsigned each) {
  const uint64_t most = UINT64_C(1) << 48; /* sums of these do not overflow before they are looked at */
  uint64_t effort = count < most / each ? (uint64_t)count * each : most;
  ctx->effort += effort;
  if (QN_UNLIKELY(ctx->max_effort != 0 && ctx->effort > ctx->max_effort)) {
    ctx->effort = ctx->max_effort + 1;
    qn_ctx_fail_(ctx, QUOIN_E_LIMIT);
    return 0;
  }
  return 1;
}

mp_limb_t *qn_limbs_take_(qn_ctx *ctx, size_t limbs) {
  if (QN_UNLIKELY(limbs > 8) && ctx->max_effort != 0 && !qn_ctx_spend(ctx, limbs, (unsigned)(limbs < UINT32_MAX ? limbs : UINT32_MAX))) {
    return NULL;
  }
  mp_limb_t *d = limbs <= LARGEST ? qn_arena_take(&ctx->arena, limbs * sizeof *d) : NULL;
  if (QN_UNLIKELY(!d)) {
    qn_ctx_fail_(ctx, QUOIN_E_MEMORY);
  }
  return d;
}

qn_int qn_limbs_int_(qn_ctx *ctx, const mp_limb_t *d, mp_size_t n, int negative) {
  while (n > 0 && d[n - 1] == 0) {
    n--;
  }
  qn_int r = {negative ? -n : n, d};
  return QN_LIKELY(qn_bits_allowed_(ctx, qn_int_bits(r))) ? r : QN_INT_ZERO_;
}

qn_int qn_int_from(qn_ctx *ctx, int64_t v) {
  if (v == 0) {
    return QN_INT_ZERO_;
  }
  mp_limb_t *d = qn_limbs_take_(ctx, 1);
  if (!d) {
    return QN_INT_ZERO_;
  }
  d[0] = v < 0 ? 0 - (mp_limb_t)v : (mp_limb_t)v;
  return qn_limbs_int_(ctx, d, 1, v < 0);
}

qn_int qn_int_from_limbs(qn_ctx *ctx, const mp_limb_t *limbs, mp_size_t n, int negative) {
  while (n > 0 && limbs[n - 1] == 0) {
    n--;
  }
  mp_limb_t *d = n > 0 ? qn_limbs_take_(ctx, (size_t)n) : NULL;
  if (!d) {
    return QN_INT_ZERO_;
  }
  mpn_copyi(d, limbs, n);
  return qn_limbs_int_(ctx, d, n, negative);
}

qn_int qn_int_copy(qn_ctx *to, qn_int a) {
  return qn_int_from_limbs(to, a.d, qn_limbs_(a), a.n < 0);
}

size_t qn_int_bits(qn_int a) {
  mp_size_t n = qn_limbs_(a);
  return n == 0 ? 0 : (size_t)n * 64 - qn_leading_zeros(a.d[n - 1]);
}

int qn_int_cmp(qn_int a, qn_int b) {
  if (a.n != b.n) {
    return a.n < b.n ? -1 : 1;
  }
  if (a.n == 0) {
    return 0;
  }
  int c = mpn_cmp(a.d, b.d, qn_limbs_(a));
  c = (c > 0) - (c < 0);
  return a.n < 0 ? -c : c;
}

int qn_int_equal(qn_int a, qn_int b) {
  return a.n == b.n && (a.n == 0 || a.d == b.d || mpn_cmp(a.d, b.d, qn_limbs_(a)) == 0);
}

/* The finaliser of MurmurHash3 on each limb. */
static uint64_t mix(uint64_t h) {
  h = (h ^ (h >> 33)) * UINT64_C(0xff51afd7ed558ccd);
  h = (h ^ (h >> 33)) * UINT64_C(0xc4ceb9fe1a85ec53);
  return h ^ (h >> 33);
}

uint64_t qn_int_hash(qn_int a) {
  uint64_t h = mix((uint64_t)a.n + 1);
  for (mp_size_t i = 0; i < qn_limbs_(a); i++) {
    h = mix(h * 31 + a.d[i]);
  }
  return h;
}

int qn_int_fits(qn_int a, int64_t *out) {
  mp_size_t n = qn_limbs_(a);
  if (n > 1 || (n == 1 && a.d[0] > (mp_limb_t)INT64_MAX + (a.n < 0))) {
    return 0;
  }
  mp_limb_t v = n == 0 ? 0 : a.d[0];
  *out = a.n < 0 ? -(int64_t)(v - 1) - 1 : (int64_t)v;
  return 1;
}

static qn_int sum(qn_ctx *ctx, qn_int a, qn_int b) {
  if (a.n == 0) {
    return b;
  }
  if (b.n == 0) {
    return a;
  }
  if (qn_limbs_(a) < qn_limbs_(b)) {
    qn_int t = a;
    a = b;
    b = t;
  }
  mp_size_t an = qn_limbs_(a), bn = qn_limbs_(b);
  if ((a.n < 0) == (b.n < 0)) {
    mp_limb_t *d = qn_limbs_take_(ctx, (size_t)an + 1);
    if (!d) {
      return QN_INT_ZERO_;
    }
    if (an == 1) {
      d[0] = a.d[0] + b.d[0];
      d[1] = d[0] < a.d[0];
    } else {
      d[an] = mpn_add(d, a.d, an, b.d, bn);
    }
    return qn_limbs_int_(ctx, d, an + 1, a.n < 0);
  }
  int negative = a.n < 0;
  if (an == bn) {
    int c = mpn_cmp(a.d, b.d, an);
    if (c == 0) {
      return QN_INT_ZERO_;
    }
    if (c < 0) {
      const mp_limb_t *t = a.d;
      a.d = b.d;
      b.d = t;
      negative = !negative;
    }
  }
  mp_limb_t *d = qn_limbs_take_(ctx, (size_t)an);
  if (!d) {
    return QN_INT_ZERO_;
  }
  mpn_sub(d, a.d, an, b.d, bn);
  return qn_limbs_int_(ctx, d, an, negative);
}

qn_int qn_int_add(qn_ctx *ctx, qn_int a, qn_int b) {
  return sum(ctx, a, b);
}

qn_int qn_int_sub(qn_ctx *ctx, qn_int a, qn_int b) {
  return sum(ctx, a, qn_int_neg(b));
}

qn_int qn_int_mul(qn_ctx *ctx, qn_int a, qn_int b) {
  if (a.n == 0 || b.n == 0) {
    return QN_INT_ZERO_;
  }
  if (qn_limbs_(a) < qn_limbs_(b)) { /* mpn_mul takes the longer operand first */
    qn_int t = a;
    a = b;
    b = t;
  }
  mp_size_t an = qn_limbs_(a), bn = qn_limbs_(b);
  if (ctx->max_bits != 0 && !qn_bits_allowed_(ctx, qn_int_bits(a) + qn_int_bits(b) - 1)) { /* before the work is done */
    return QN_INT_ZERO_;
  }
  mp_limb_t *d = qn_limbs_take_(ctx, (size_t)an + (size_t)bn);
  if (!d) {
    return QN_INT_ZERO_;
  }
  if (bn == 1) {
    d[an] = mpn_mul_1(d, a.d, an, b.d[0]);
  } else if (a.d == b.d && an == bn) {
    mpn_sqr(d, a.d, an);
  } else {
    mpn_mul(d, a.d, an, b.d, bn);
  }
  return qn_limbs_int_(ctx, d, an + bn, (a.n < 0) != (b.n < 0));
}

qn_int qn_int_shl(qn_ctx *ctx, qn_int a, size_t bits) {
  mp_size_t n = qn_limbs_(a);
  if (n == 0 || bits == 0) {
    return a;
  }
  if (bits / 64 > LARGEST) {
    qn_ctx_fail_(ctx, ctx->max_bits ? QUOIN_E_LIMIT : QUOIN_E_MEMORY);
    return QN_INT_ZERO_;
  }
  if (!qn_bits_allowed_(ctx, qn_int_bits(a) + bits)) {
    return QN_INT_ZERO_;
  }
  mp_size_t whole = (mp_size_t)(bits / 64);
  unsigned part = (unsigned)(bits % 64);
  mp_limb_t *d = qn_limbs_take_(ctx, (size_t)n + (size_t)whole + 1);
  if (!d) {
    return QN_INT_ZERO_;
  }
  mpn_zero(d, whole);
  d[whole + n] = 0;
  if (part) {
    d[whole + n] = mpn_lshift(d + whole, a.d, n, part);
  } else {
    mpn_copyi(d + whole, a.d, n);
  }
  return qn_limbs_int_(ctx, d, n + whole + 1, a.n < 0);
}

qn_int qn_int_shr(qn_ctx *ctx, qn_int a, size_t bits) {
  mp_size_t n = qn_limbs_(a);
  if (n == 0 || bits == 0) {
    return a;
  }
  if (bits >= (size_t)n * 64) {
    return QN_INT_ZERO_;
  }
  mp_size_t whole = (mp_size_t)(bits / 64);
  unsigned part = (unsigned)(bits % 64);
  if (part == 0) {
    return (qn_int){a.n < 0 ? a.n + whole : a.n - whole, a.d + whole}; /* shares the limbs */
  }
  mp_limb_t *d = qn_limbs_take_(ctx, (size_t)(n - whole));
  if (!d) {
    return QN_INT_ZERO_;
  }
  mpn_rshift(d, a.d + whole, n - whole, part);
  return qn_limbs_int_(ctx, d, n - whole, a.n < 0);
}

size_t qn_int_trailing_zeros(qn_int a) {
  return a.n == 0 ? 0 : (size_t)mpn_scan1(a.d, 0);
}

double qn_int_to_double(qn_int a) {
  mp_size_t n = qn_limbs_(a);
  size_t bits = qn_int_bits(a);
  if (bits > 1024) {
    return a.n < 0 ? -HUGE_VAL : HUGE_VAL;
  }
  if (n <= 1) {
    double v = n == 0 ? 0.0 : (double)a.d[0];
    return a.n < 0 ? -v : v;
  }
  /* The top 64 bits, the last of which also stands for everything below: 64 > 53 + 2, so it rounds as the whole does. */
  unsigned up = qn_leading_zeros(a.d[n - 1]);
  mp_limb_t top = a.d[n - 1] << up, rest = a.d[n - 2] << up;
  if (up) {
    top |= a.d[n - 2] >> (64 - up);
  }
  for (mp_size_t i = 0; rest == 0 && i < n - 2; i++) {
    rest = a.d[i];
  }
  double v = ldexp((double)(top | (rest != 0)), (int)bits - 64);
  return a.n < 0 ? -v : v;
}

void qn_int_frexp(qn_int a, double *m, int64_t *e) {
  mp_size_t n = qn_limbs_(a);
  if (n == 0) {
    *m = 0;
    *e = 0;
    return;
  }
  unsigned up = qn_leading_zeros(a.d[n - 1]);
  mp_limb_t top = a.d[n - 1] << up;
  if (up && n > 1) {
    top |= a.d[n - 2] >> (64 - up);
  }
  double v = (double)(top >> 11) * 0x1p-53;
  *m = a.n < 0 ? -v : v;
  *e = (int64_t)qn_int_bits(a);
}
