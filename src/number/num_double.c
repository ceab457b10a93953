/* The double nearest to a number, and the double-double.

   Legend: |num/den| 2^e. N the top 128 bits of num, D the top 64 bits of den, both cut off below; Q = floor(N / D) has 64
   or 65 bits. Cutting N loses less than 2^-127 of it, cutting D less than 2^-63 of it, so the true quotient, in units of
   Q, lies in (Q - 4, Q + 2). Unless the place between two doubles lies within 8 of Q, Q rounds as the truth does;
   if it does, num 2^s is compared with (that place) den limb by limb, which needs no memory. */
#include "number/num_parts.h"

#include <string.h>

/* The top 128 bits, the highest of them set; filled up with zeros. */
static qn_u128 top128(const mp_limb_t *d, mp_size_t n) {
  unsigned up = qn_leading_zeros(d[n - 1]);
  uint64_t a = d[n - 1], b = n > 1 ? d[n - 2] : 0, c = n > 2 ? d[n - 3] : 0;
  if (up) {
    a = a << up | b >> (64 - up);
    b = b << up | c >> (64 - up);
  }
  return (qn_u128)a << 64 | b;
}

static int64_t bits_of(const mp_limb_t *d, mp_size_t n) {
  return n * 64 - (int64_t)qn_leading_zeros(d[n - 1]);
}

/* Limb i of v 2^shift, given limbs of v by an index from below; outside they are 0. */
static mp_limb_t shifted_limb(mp_limb_t here, mp_limb_t below, unsigned part) {
  return part ? here << part | below >> (64 - part) : here;
}

/* The order of num 2^s and m den 2^t, s and t >= 0: from the lowest limb up, the last difference counts. */
static int compare(const mp_limb_t *num, mp_size_t nn, int64_t s, const mp_limb_t *den, mp_size_t dn, uint64_t m, int64_t t) {
  mp_size_t sw = s / 64, tw = t / 64, last = nn + sw > dn + tw + 1 ? nn + sw : dn + tw + 1;
  unsigned sp = (unsigned)(s % 64), tp = (unsigned)(t % 64);
  uint64_t carry = 0, previous = 0;
  int order = 0;
  for (mp_size_t i = 0; i <= last; i++) {
    mp_size_t k = i - sw, j = i - tw;
    mp_limb_t x = shifted_limb(k >= 0 && k < nn ? num[k] : 0, k >= 1 && k <= nn ? num[k - 1] : 0, sp);
    mp_limb_t product = 0;
    if (j >= 0) {
      qn_u128 p = (j < dn ? (qn_u128)m * den[j] : 0) + carry;
      product = (mp_limb_t)p;
      carry = (uint64_t)(p >> 64);
    }
    mp_limb_t y = shifted_limb(product, previous, tp);
    previous = product;
    order = x == y ? order : x > y ? 1 : -1;
  }
  return order;
}

double qn_limbs_to_double_(const mp_limb_t *num, mp_size_t nn, const mp_limb_t *den, mp_size_t dn, int64_t e) {
  int64_t nb = bits_of(num, nn), db = bits_of(den, dn);
  qn_u128 q = top128(num, nn) / (uint64_t)(top128(den, dn) >> 64);
  int64_t unit = e + (nb - 128) - (db - 64); /* the value is q 2^unit, nearly */
  int bits = (q >> 64) ? 65 : 64;            /* N >= 2^127 and D < 2^64, so q >= 2^63 */
  int64_t drop = bits - 53;
  if (unit + drop < -1074) { /* subnormal: fewer bits */
    drop = -1074 - unit;
  }
  if (unit + bits > 1100) {
    return HUGE_VAL;
  }
  if (drop > bits + 1) { /* under a quarter of the least double */
    return 0;
  }
  qn_u128 half = (qn_u128)1 << (drop - 1), low = q & ((half << 1) - 1);
  uint64_t kept = (uint64_t)(q >> drop);
  int up = low > half;
  if ((up ? low - half : half - low) <= 8) {
    int64_t s = e - (unit + drop - 1); /* num/den 2^e against (2 kept + 1) 2^(unit + drop - 1) */
    int order = compare(num, nn, s > 0 ? s : 0, den, dn, 2 * kept + 1, s < 0 ? -s : 0);
    up = order > 0 || (order == 0 && (kept & 1));
  }
  return ldexp((double)(kept + (uint64_t)up), (int)(unit + drop));
}

/* m 5^n into limbs, n <= 2^15; the limbs used. */
enum { FIVE_LIMBS = 1192 }; /* 2^15 log2(5) = 76085.3 bits are 1189 limbs, and m one more */
static mp_size_t times_fives(mp_limb_t *d, uint64_t m, int n) {
  mp_size_t size = 1;
  d[0] = m;
  for (; n > 0; n -= QN_FIVES_) {
    mp_limb_t carry = mpn_mul_1(d, d, size, (mp_limb_t)qn_five_to_[n < QN_FIVES_ ? n : QN_FIVES_]);
    if (carry) {
      d[size++] = carry;
    }
  }
  return size;
}

static double small_to_double(uint64_t m, int a, int b) {
  if (m <= (UINT64_C(1) << 53) && b >= -22 && b <= 22 && a >= -900 && a <= 900) {
    /* One rounding, that of the product or quotient, between 2^-52 and 2^105; then an exact power of two. */
    double fives = (double)qn_five_to_[b < 0 ? -b : b]; /* exact: 5^22 < 2^53 */
    double v = b < 0 ? (double)m / fives : (double)m * fives;
    uint64_t bits = (uint64_t)(a + 1023) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return v * power;
  }
  mp_limb_t limbs[FIVE_LIMBS], one = b < 0 ? m : 1;
  mp_size_t n = times_fives(limbs, b < 0 ? 1 : m, b < 0 ? -b : b);
  return b < 0 ? qn_limbs_to_double_(&one, 1, limbs, n, a) : qn_limbs_to_double_(limbs, n, &one, 1, a);
}

double qn_num_to_double(qn_num a) {
  int sign = qn_num_sign(a);
  double v = 0;
  if (sign == 0) {
    return 0;
  }
  if (a.kind == QN_NUM_SMALL) {
    v = small_to_double(qn_magnitude_(a.u.m), a.a, a.b);
  } else {
    v = qn_limbs_to_double_(a.u.big->num.d, qn_limbs_(a.u.big->num), a.u.big->den.d, a.u.big->den.n, 0);
  }
  return sign < 0 ? -v : v;
}

/* |hi| = h 2^*e with h an integer. */
static uint64_t parts(double hi, int64_t *e) {
  int k;
  double m = frexp(fabs(hi), &k);
  *e = (int64_t)k - 53;
  return (uint64_t)ldexp(m, 53);
}

/* The rest |a| - |hi| of a small number in 128 bits; 0 where that is too short. */
static int small_rest(qn_num a, double hi, double *lo) {
  int64_t e;
  uint64_t h = parts(hi, &e);
  int64_t unit = a.a < e ? a.a : e;
  qn_u128 x, y;
  int fives = a.b < 0 ? -a.b : 0;
  if (!qn_num_scaled_(a.u.m, a.a - unit, a.b + fives, &x) || !qn_num_scaled_((int64_t)h, e - unit, fives, &y)) {
    return 0;
  }
  qn_u128 rest = x > y ? x - y : y - x;
  if (rest == 0) {
    *lo = 0;
    return 1;
  }
  mp_limb_t num[2] = {(mp_limb_t)rest, (mp_limb_t)(rest >> 64)}, den = (mp_limb_t)qn_five_to_[fives];
  double v = qn_limbs_to_double_(num, num[1] ? 2 : 1, &den, 1, unit);
  *lo = x > y ? v : -v;
  return 1;
}

void qn_num_to_dd(qn_ctx *ctx, qn_num a, double *hi, double *lo) {
  *hi = qn_num_to_double(a);
  *lo = 0;
  int sign = qn_num_sign(a);
  if (sign == 0 || isinf(*hi)) {
    return;
  }
  if (a.kind != QN_NUM_SMALL || !small_rest(a, *hi, lo)) {
    qn_mark mark = qn_arena_mark(&ctx->arena);
    qn_rat r = qn_num_rat(ctx, a);
    int64_t e;
    uint64_t h = parts(*hi, &e);
    qn_int part = qn_int_mul(ctx, qn_int_from_limbs(ctx, &h, 1, 0), r.den), all = qn_int_abs(r.num);
    qn_int rest = e < 0 ? qn_int_sub(ctx, qn_int_shl(ctx, all, (size_t)-e), part)
                        : qn_int_sub(ctx, all, qn_int_shl(ctx, part, (size_t)e));
    if (ctx->failed == QUOIN_OK && rest.n != 0) {
      double v = qn_limbs_to_double_(rest.d, qn_limbs_(rest), r.den.d, r.den.n, e < 0 ? e : 0);
      *lo = rest.n < 0 ? -v : v;
    }
    qn_arena_release(&ctx->arena, mark);
  }
  *lo = sign < 0 ? -*lo : *lo;
}
