/* Doubles of small numbers by division of machine words: what a scene of a million leaves asks for.

   Legend: a small number is m 2^a 5^b. Its size is N 2^e / D with integers N < 2^127 and D = 5^k < 2^63. N is moved up until the quotient
   Q = floor(N / D) has 63 bits at least; R is the rest. Q and whether R is 0 tell how the number rounds. */
#include "number/num_parts.h"

#include <string.h>

enum { SIZES = 400 }; /* exponents of two beyond it are left to the slow way: here nothing over- or underflows */

static unsigned bits_of(qn_u128 v) {
  uint64_t high = (uint64_t)(v >> 64), low = (uint64_t)v;
  return high ? 128 - qn_leading_zeros(high) : low ? 64 - qn_leading_zeros(low) : 0;
}

/* v 2^e for v <= 2^53 and an exponent of usual size: exact. */
static double scaled(uint64_t v, int e) {
  uint64_t bits = (uint64_t)(e + 1023) << 52;
  double power;
  memcpy(&power, &bits, sizeof power);
  return (double)v * power;
}

/* N / D as (q + rest / d) 2^e, q of 63 bits at least. */
typedef struct quotient { qn_u128 q; uint64_t rest, d; int e; } quotient;

static quotient divide(qn_u128 n, uint64_t d, int e) {
  int up = 63 + (int)bits_of(d) - (int)bits_of(n);
  if (up > 0) {
    n <<= up;
    e -= up;
  }
  quotient r = {.d = d, .e = e};
  if ((uint64_t)(n >> 64) == 0 && d == 1) {
    r.q = n;
  } else {
    r.q = n / d;
    r.rest = (uint64_t)(n - r.q * d);
  }
  return r;
}

/* The 53 bits of the quotient from above; what was cut off is in *low, of *cut bits. */
static uint64_t top_of(const quotient *r, unsigned *cut, qn_u128 *low) {
  *cut = bits_of(r->q) - 53;
  *low = r->q & (((qn_u128)1 << *cut) - 1);
  return (uint64_t)(r->q >> *cut);
}

static int rounds_up(const quotient *r, uint64_t top, unsigned cut, qn_u128 low) {
  qn_u128 half = (qn_u128)1 << (cut - 1);
  return low > half || (low == half && (r->rest || (top & 1)));
}

static double nearest(const quotient *r) {
  unsigned cut;
  qn_u128 low;
  uint64_t top = top_of(r, &cut, &low);
  return scaled(top + (uint64_t)rounds_up(r, top, cut, low), r->e + (int)cut);
}

static int usual(qn_num a) {
  return a.kind == QN_NUM_SMALL && a.a > -SIZES && a.a < SIZES && a.b >= -QN_FIVES_ && a.b <= QN_FIVES_;
}

/* |a| as N 2^a / D. */
static void fraction_of(qn_num a, qn_u128 *n, uint64_t *d) {
  *n = (qn_u128)qn_magnitude_(a.u.m) * (a.b > 0 ? qn_five_to_[a.b] : 1);
  *d = a.b < 0 ? qn_five_to_[-a.b] : 1;
}

int qn_num_quick_pair(qn_num a, double *hi, double *lo) {
  *hi = *lo = 0;
  if (!usual(a)) {
    return 0;
  }
  if (a.u.m == 0) {
    return 1;
  }
  qn_u128 n;
  uint64_t d;
  fraction_of(a, &n, &d);
  quotient r = divide(n, d, a.a);
  unsigned cut;
  qn_u128 low;
  uint64_t top = top_of(&r, &cut, &low);
  int up = rounds_up(&r, top, cut, low), negative = a.u.m < 0;
  double h = scaled(top + (uint64_t)up, r.e + (int)cut);
  *hi = negative ? -h : h;
  /* The rest is (low + rest / d) 2^e, or that minus 2^(e + cut) when rounded up; over d it is an integer below 2^127: without a d low has
     up to 74 bits, with one Q has 64 bits and low 11. */
  qn_u128 part = low * r.d + r.rest, whole = ((qn_u128)1 << cut) * r.d, left = up ? whole - part : part;
  if (left) {
    quotient l = divide(left, r.d, r.e);
    double v = nearest(&l);
    *lo = negative != up ? -v : v;
  }
  return 1;
}

int qn_num_quick_sum(qn_num a, qn_num b, double *down, double *up) {
  if (!usual(a) || !usual(b)) {
    return 0;
  }
  int twos = a.u.m == 0 ? b.a : b.u.m == 0 ? a.a : a.a < b.a ? a.a : b.a, fives = a.b < b.b ? a.b : b.b;
  fives = fives > 0 ? 0 : fives;
  qn_u128 x = 0, y = 0;
  if ((a.u.m && !qn_num_scaled_(a.u.m, a.a - twos, a.b - fives, &x)) || (b.u.m && !qn_num_scaled_(b.u.m, b.a - twos, b.b - fives, &y))) {
    return 0;
  }
  int negative = a.u.m < 0;
  if ((a.u.m < 0) == (b.u.m < 0)) {
    x += y;
  } else if (x >= y) {
    x -= y;
  } else {
    x = y - x;
    negative = !negative;
  }
  if (x == 0) {
    *down = *up = 0;
    return 1;
  }
  quotient r = divide(x, qn_five_to_[-fives], twos);
  unsigned cut;
  qn_u128 low;
  uint64_t top = top_of(&r, &cut, &low);
  double near = scaled(top, r.e + (int)cut), far = low || r.rest ? scaled(top + 1, r.e + (int)cut) : near;
  *down = negative ? -far : near;
  *up = negative ? -near : far;
  return 1;
}

int qn_num_quick_square(qn_num a, double *out) {
  *out = 0;
  if (!usual(a)) {
    return 0;
  }
  if (a.u.m == 0) {
    return 1;
  }
  uint64_t m = qn_magnitude_(a.u.m), d = qn_five_to_[a.b < 0 ? -a.b : 0];
  if (a.b > 0 || a.a < -SIZES / 2 || a.a > SIZES / 2) {
    return 0;
  }
  qn_u128 n = (qn_u128)m * m, q = (qn_u128)d * d;
  if (-2 * a.b <= QN_FIVES_) {
    quotient r = divide(n, (uint64_t)q, 2 * a.a);
    *out = nearest(&r);
  } else {
    mp_limb_t num[2] = {(mp_limb_t)n, (mp_limb_t)(n >> 64)}, den[2] = {(mp_limb_t)q, (mp_limb_t)(q >> 64)};
    *out = qn_limbs_to_double_(num, num[1] ? 2 : 1, den, den[1] ? 2 : 1, 2 * a.a);
  }
  return 1;
}
