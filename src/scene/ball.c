/* Derivation of the errors (unit: 2^-253, relative). A mantissa cut to 256 bits loses less than 2^-255 relative: a quarter.
   Product and quotient: errors add; their product, at most 2^150 2^-253 times either, and the rounding of these few sums in
   doubles are covered by the factor GROW. Sum: absolute errors add; they are made relative by the centres' sizes, taken from the
   top limbs (SIZE: off by under 2^-52, covered by GROW too). */
#include "scene/ball.h"

#include "base/bounds.h"

#include <math.h>
#include <string.h>

#define GROW (1 + 0x1p-40)
#define CUT 0.25
enum { L = QN_BALL_LIMBS, LIMB = 64, BITS = L * LIMB };
_Static_assert(GMP_NUMB_BITS == LIMB, "limbs of 64 bits without nails");

static qn_ball unknown(void) {
  return (qn_ball){.m = {0, 0, 0, (mp_limb_t)1 << 63}, .err = INFINITY, .sign = 1};
}

static void checked(qn_ball *a, double err) {
  a->err = err;
  if (!(err <= QN_BALL_ERR)) {
    *a = unknown();
  }
}

/* The centre of |x| = limbs[0 .. n-1] 2^scale, the top limb not zero. Returns whether bits were cut. */
static int take(qn_ball *out, const mp_limb_t *limbs, size_t n, int64_t scale) {
  unsigned shift = qn_leading_zeros(limbs[n - 1]);
  out->e = scale + (int64_t)(n * LIMB) - shift;
  mp_limb_t below = 0; /* what is shifted in from under the four limbs */
  int cut = 0;
  if (n >= L) {
    memcpy(out->m, limbs + (n - L), sizeof out->m);
    for (size_t i = 0; i + L < n; i++) {
      mp_limb_t x = limbs[i];
      if (i + L + 1 == n && shift) {
        below = x >> (LIMB - shift);
        x <<= shift;
      }
      cut |= x != 0;
    }
  } else {
    memset(out->m, 0, sizeof out->m);
    memcpy(out->m + (L - n), limbs, n * sizeof *limbs);
  }
  if (shift) {
    mpn_lshift(out->m, out->m, L, shift);
    out->m[0] |= below;
  }
  return cut;
}

static int is_unit(const qn_ball *a) { /* 1 or -1 */
  return a->e == 1 && a->err == 0 && a->m[3] == (mp_limb_t)1 << 63 && !(a->m[0] | a->m[1] | a->m[2]);
}

/* --- from numbers ---------------------------------------------------------------------------------------------- */

static qn_ball from_int(qn_int a) {
  qn_ball r = {.sign = qn_int_sign(a)};
  if (r.sign) {
    size_t n = (size_t)(a.n < 0 ? -a.n : a.n);
    r.err = take(&r, a.d, n, 0) ? CUT : 0;
  }
  return r;
}

enum { FIVES = 27 }; /* 5^27 < 2^64 */

static mp_limb_t power_of_five(unsigned n) {
  static const mp_limb_t powers[FIVES + 1] = {
    UINT64_C(1), UINT64_C(5), UINT64_C(25), UINT64_C(125), UINT64_C(625), UINT64_C(3125), UINT64_C(15625), UINT64_C(78125), UINT64_C(390625),
    UINT64_C(1953125), UINT64_C(9765625), UINT64_C(48828125), UINT64_C(244140625), UINT64_C(1220703125), UINT64_C(6103515625),
    UINT64_C(30517578125), UINT64_C(152587890625), UINT64_C(762939453125), UINT64_C(3814697265625), UINT64_C(19073486328125),
    UINT64_C(95367431640625), UINT64_C(476837158203125), UINT64_C(2384185791015625), UINT64_C(11920928955078125),
    UINT64_C(59604644775390625), UINT64_C(298023223876953125), UINT64_C(1490116119384765625), UINT64_C(7450580596923828125)};
  return powers[n];
}

qn_ball qn_ball_from_num(qn_ctx *ctx, qn_num a) {
  if (qn_num_is_zero(a)) {
    return QN_BALL_ZERO;
  }
  if (a.kind == QN_NUM_SMALL && a.b >= -FIVES && a.b <= FIVES) {
    mp_limb_t m = a.u.m < 0 ? -(mp_limb_t)a.u.m : (mp_limb_t)a.u.m;
    qn_ball r = {.sign = a.u.m < 0 ? -1 : 1};
    if (a.b == 0) {
      take(&r, &m, 1, a.a);
    } else if (a.b > 0) {
      mp_limb_t two[2];
      two[1] = mpn_mul_1(two, &m, 1, power_of_five((unsigned)a.b));
      take(&r, two, two[1] ? 2 : 1, a.a);
    } else {
      mp_limb_t n[6] = {0, 0, 0, 0, 0, m}; /* m 2^320 / 5^k has more than 257 bits */
      mp_limb_t rest = mpn_divrem_1(n, 0, n, 6, power_of_five((unsigned)-a.b));
      size_t top = 6;
      while (!n[top - 1]) {
        top--;
      }
      int cut = take(&r, n, top, (int64_t)a.a - 5 * LIMB);
      r.err = cut || rest ? CUT : 0;
    }
    return r;
  }
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_rat rat = qn_num_rat(ctx, a);
  qn_ball num = from_int(rat.num), den = from_int(rat.den), r = unknown();
  if (ctx->failed == QUOIN_OK && num.sign && den.sign) {
    qn_ball_div(&num, &den, &r);
  }
  qn_arena_release(&ctx->arena, mark);
  return r;
}

qn_ball qn_ball_from_double(double a) {
  qn_ball r = {.sign = (a > 0) - (a < 0)};
  if (r.sign) {
    int e;
    mp_limb_t m = (mp_limb_t)ldexp(frexp(fabs(a), &e), 53);
    take(&r, &m, 1, (int64_t)e - 53);
  }
  return r;
}

/* --- operations ------------------------------------------------------------------------------------------------ */

void qn_ball_neg(qn_ball *a) {
  a->sign = -a->sign;
}

/* 2^e, 0 or infinity beyond the range of normal doubles. */
static double power(int64_t e) {
  if (e > 1023 || e < -1022) {
    return e > 0 ? INFINITY : 0;
  }
  uint64_t bits = (uint64_t)(e + 1023) << 52;
  double v;
  memcpy(&v, &bits, sizeof v);
  return v;
}

/* The centre's size in units of 2^e, in [1/2, 1), to 2^-53 relative. */
static double size_of(const qn_ball *a) {
  return (double)(a->m[L - 1] >> 11) * 0x1p-53;
}

/* a + b with |a| >= |b| in exponents, neither zero. */
static void add_ordered(const qn_ball *a, const qn_ball *b, qn_ball *out) {
  int64_t gap = a->e - b->e;
  qn_ball r = {.sign = a->sign};
  if (gap > BITS + 8) { /* b is under a's last bit */
    r = *a;
    checked(&r, a->err * GROW + power(254 - gap));
    *out = r;
    return;
  }
  /* Six limbs: a with a limb to spare above and one below; b moved down by gap bits. */
  mp_limb_t x[L + 2] = {0}, y[2 * L + 2] = {0};
  memcpy(x + 1, a->m, sizeof a->m);
  size_t limbs = (size_t)gap / LIMB, bits = (size_t)gap % LIMB;
  mp_limb_t moved[L + 1];
  if (bits) {
    moved[0] = mpn_rshift(moved + 1, b->m, L, (unsigned)bits);
  } else {
    moved[0] = 0;
    memcpy(moved + 1, b->m, sizeof b->m);
  }
  int cut = 0;
  for (size_t i = 0; i <= L; i++) { /* moved[i] belongs to limb i - limbs of y's lower L + 1 */
    if (i >= limbs) {
      y[i - limbs] = moved[i];
    } else {
      cut |= moved[i] != 0;
    }
  }
  double errors = a->err * size_of(a) + b->err * size_of(b) * power(-gap) + (cut ? power(253 - BITS - LIMB) : 0);
  if (a->sign == b->sign) {
    mpn_add_n(x, x, y, L + 2);
  } else if (mpn_cmp(x, y, L + 2) >= 0) {
    mpn_sub_n(x, x, y, L + 2);
  } else {
    mpn_sub_n(x, y, x, L + 2);
    r.sign = -r.sign;
  }
  size_t n = L + 2;
  while (n && !x[n - 1]) {
    n--;
  }
  if (n == 0) {
    *out = errors == 0 ? QN_BALL_ZERO : unknown();
    return;
  }
  int low = take(&r, x, n, a->e - BITS - LIMB);
  int64_t lost = a->e - r.e;
  if (lost > QN_BALL_CANCEL) {
    *out = unknown();
    return;
  }
  checked(&r, errors == 0 && !low ? 0 : errors * power(lost) / size_of(&r) * GROW + (low ? CUT : 0));
  *out = r;
}

void qn_ball_add(const qn_ball *a, const qn_ball *b, qn_ball *out) {
  if (a->sign == 0 || b->sign == 0) {
    *out = a->sign == 0 ? *b : *a;
  } else if (!qn_ball_known(a) || !qn_ball_known(b)) {
    *out = unknown();
  } else if (a->e >= b->e) {
    add_ordered(a, b, out);
  } else {
    add_ordered(b, a, out);
  }
}

void qn_ball_sub(const qn_ball *a, const qn_ball *b, qn_ball *out) {
  qn_ball c = *b;
  c.sign = -c.sign;
  qn_ball_add(a, &c, out);
}

void qn_ball_mul(const qn_ball *a, const qn_ball *b, qn_ball *out) {
  if (a->sign == 0 || b->sign == 0) {
    *out = QN_BALL_ZERO;
    return;
  }
  if (is_unit(a) || is_unit(b)) {
    int sign = a->sign * b->sign;
    *out = is_unit(a) ? *b : *a;
    out->sign = sign;
    return;
  }
  if (!qn_ball_known(a) || !qn_ball_known(b)) {
    *out = unknown();
    return;
  }
  mp_limb_t p[2 * L];
  mpn_mul_n(p, a->m, b->m, L);
  qn_ball r = {.sign = a->sign * b->sign};
  double err = a->err + b->err;
  int cut = take(&r, p, 2 * L, a->e + b->e - 2 * BITS);
  checked(&r, (err > 0 ? err * GROW : 0) + (cut ? CUT : 0));
  *out = r;
}

void qn_ball_div(const qn_ball *a, const qn_ball *b, qn_ball *out) {
  if (a->sign == 0) {
    *out = QN_BALL_ZERO;
    return;
  }
  if (is_unit(b)) {
    int sign = a->sign * b->sign;
    *out = *a;
    out->sign = sign;
    return;
  }
  if (!qn_ball_known(a) || !qn_ball_known(b) || b->sign == 0) {
    *out = unknown();
    return;
  }
  mp_limb_t n[2 * L + 1] = {0}, q[L + 2], rest[L]; /* a 2^320 / b: more than 318 bits */
  memcpy(n + L + 1, a->m, sizeof a->m);
  mpn_tdiv_qr(q, rest, 0, n, 2 * L + 1, b->m, L);
  size_t top = L + 2;
  while (!q[top - 1]) {
    top--;
  }
  qn_ball r = {.sign = a->sign * b->sign};
  int cut = take(&r, q, top, a->e - b->e - BITS - LIMB);
  for (size_t i = 0; i < L; i++) {
    cut |= rest[i] != 0;
  }
  double err = a->err + b->err;
  checked(&r, (err > 0 ? err * GROW : 0) + (cut ? CUT : 0));
  *out = r;
}

double qn_ball_to_double(const qn_ball *a) {
  if (a->sign == 0) {
    return 0;
  }
  mp_limb_t top = a->m[L - 1], m = top >> 11, rest = top << 53;
  mp_limb_t half = (mp_limb_t)1 << 63;
  int below = (a->m[0] | a->m[1] | a->m[2]) != 0;
  if (rest > half || (rest == half && (below || (m & 1)))) {
    m++;
  }
  if (a->e > QN_SHADOW_EXPONENT || a->e <= -QN_SHADOW_EXPONENT) {
    return a->sign * (a->e > 0 ? QN_SHADOW_LARGEST : 1 / QN_SHADOW_LARGEST);
  }
  return a->sign * ((double)m * 0x1p-53 * power(a->e)); /* m is at most 2^53 */
}
