/* Doubles of small numbers by multiplication with reciprocals: what a scene of a million leaves asks for.

   Legend: a small number is m 2^a 5^b. Its size is N 2^e / 5^k with an integer N < 2^127, k <= 27. D = 5^k 2^s has its top bit set; N is moved
   up until it has 127 bits, so that Q = floor(N / D) has 63 or 64 bits. Q, and whether the rest R is 0, tell how the number rounds.
   Division by an invariant: Moeller, Granlund 2011. */
#include "number/num_parts.h"

#include <stddef.h>
#include <string.h>

enum { SIZES = 400 }; /* exponents of two beyond it are left to the slow way: here nothing over- or underflows */

typedef struct divisor { uint64_t d, reciprocal; int shift; } divisor; /* D; floor((2^128 - 1) / D) - 2^64; s */
static const divisor FIVES[QN_FIVES_ + 1] = {
  {UINT64_C(0x8000000000000000), UINT64_C(0xffffffffffffffff), 63}, {UINT64_C(0xa000000000000000), UINT64_C(0x9999999999999999), 61},
  {UINT64_C(0xc800000000000000), UINT64_C(0x47ae147ae147ae14), 59}, {UINT64_C(0xfa00000000000000), UINT64_C(0x0624dd2f1a9fbe76), 57},
  {UINT64_C(0x9c40000000000000), UINT64_C(0xa36e2eb1c432ca57), 54}, {UINT64_C(0xc350000000000000), UINT64_C(0x4f8b588e368f0846), 52},
  {UINT64_C(0xf424000000000000), UINT64_C(0x0c6f7a0b5ed8d36b), 50}, {UINT64_C(0x9896800000000000), UINT64_C(0xad7f29abcaf48578), 47},
  {UINT64_C(0xbebc200000000000), UINT64_C(0x5798ee2308c39df9), 45}, {UINT64_C(0xee6b280000000000), UINT64_C(0x12e0be826d694b2e), 43},
  {UINT64_C(0x9502f90000000000), UINT64_C(0xb7cdfd9d7bdbab7d), 40}, {UINT64_C(0xba43b74000000000), UINT64_C(0x5fd7fe17964955fd), 38},
  {UINT64_C(0xe8d4a51000000000), UINT64_C(0x19799812dea11197), 36}, {UINT64_C(0x9184e72a00000000), UINT64_C(0xc25c268497681c26), 33},
  {UINT64_C(0xb5e620f480000000), UINT64_C(0x6849b86a12b9b01e), 31}, {UINT64_C(0xe35fa931a0000000), UINT64_C(0x203af9ee756159b2), 29},
  {UINT64_C(0x8e1bc9bf04000000), UINT64_C(0xcd2b297d889bc2b6), 26}, {UINT64_C(0xb1a2bc2ec5000000), UINT64_C(0x70ef54646d496892), 24},
  {UINT64_C(0xde0b6b3a76400000), UINT64_C(0x2725dd1d243aba0e), 22}, {UINT64_C(0x8ac7230489e80000), UINT64_C(0xd83c94fb6d2ac34a), 19},
  {UINT64_C(0xad78ebc5ac620000), UINT64_C(0x79ca10c9242235d5), 17}, {UINT64_C(0xd8d726b7177a8000), UINT64_C(0x2e3b40a0e9b4f7dd), 15},
  {UINT64_C(0x878678326eac9000), UINT64_C(0xe392010175ee5962), 12}, {UINT64_C(0xa968163f0a57b400), UINT64_C(0x82db34012b25144e), 10},
  {UINT64_C(0xd3c21bcecceda100), UINT64_C(0x357c299a88ea76a5), 8}, {UINT64_C(0x84595161401484a0), UINT64_C(0xef2d0f5da7dd8aa2), 5},
  {UINT64_C(0xa56fa5b99019a5c8), UINT64_C(0x8c240c4aecb13bb5), 3}, {UINT64_C(0xcecb8f27f4200f3a), UINT64_C(0x3ce9a36f23c0fc90), 1}};

static unsigned bits_of(qn_u128 v) {
  uint64_t high = (uint64_t)(v >> 64), low = (uint64_t)v;
  return high ? 128 - qn_leading_zeros(high) : 64 - qn_leading_zeros(low);
}

/* Numbers come in any order, so what depends on their last digits or their sign is computed without branches: no guess would be right. */

/* v as a double, rounded once: without the test that the machine's signed conversion of an unsigned v has need of. */
QN_INLINE double rounded(uint64_t v) {
  return 2 * (double)(int64_t)(v >> 1 | (v & 1));
}

QN_INLINE double with_sign(double v, int negative) {
  static const double sign[2] = {1, -1};
  return v * sign[negative];
}

/* v 2^e for v <= 2^53 and an exponent of usual size: exact. */
static double scaled(uint64_t v, int e) {
  uint64_t bits = (uint64_t)(e + 1023) << 52;
  double power;
  memcpy(&power, &bits, sizeof power);
  return (double)(int64_t)v * power;
}

/* The size (q + rest / d) 2^e. */
typedef struct quotient { uint64_t q, rest, d; int e; } quotient;

/* n 2^e / 5^k for 0 < n < 2^127. */
QN_INLINE quotient divide(qn_u128 n, int k, int e) {
  const divisor *f = &FIVES[k];
  int up = 127 - (int)bits_of(n);
  n <<= up;
  uint64_t high = (uint64_t)(n >> 64), low = (uint64_t)n;
  qn_u128 q = (qn_u128)f->reciprocal * high + n;
  uint64_t top = (uint64_t)(q >> 64) + 1, rest = low - top * f->d;
  const uint64_t back = 0 - (uint64_t)(rest > (uint64_t)q);
  top += back, rest += back & f->d;
  if (QN_UNLIKELY(rest >= f->d)) {
    top++;
    rest -= f->d;
  }
  return (quotient){top, rest, f->d, e - up + f->shift};
}

/* The 53 bits of the quotient from above; what was cut off is in *low, of *cut bits, 10 or 11. */
QN_INLINE uint64_t top_of(const quotient *r, unsigned *cut, uint64_t *low) {
  *cut = 11 - qn_leading_zeros(r->q);
  *low = r->q & ((UINT64_C(1) << *cut) - 1);
  return r->q >> *cut;
}

QN_INLINE int rounds_up(const quotient *r, uint64_t top, unsigned cut, uint64_t low) {
  uint64_t half = UINT64_C(1) << (cut - 1);
  return (low > half) | ((low == half) & ((r->rest != 0) | (int)(top & 1)));
}

static double nearest(const quotient *r) {
  unsigned cut;
  uint64_t low, top = top_of(r, &cut, &low);
  return scaled(top + (uint64_t)rounds_up(r, top, cut, low), r->e + (int)cut);
}

static int usual(qn_num a) {
  return a.kind == QN_NUM_SMALL && a.a > -SIZES && a.a < SIZES && a.b >= -QN_FIVES_ && a.b <= QN_FIVES_;
}

int qn_num_quick_pair(qn_num a, double *hi, double *lo) {
  *hi = *lo = 0;
  if (!usual(a)) {
    return 0;
  }
  if (a.u.m == 0) {
    return 1;
  }
  qn_u128 n = (qn_u128)qn_magnitude_(a.u.m) * (a.b > 0 ? qn_five_to_[a.b] : 1);
  int k = a.b < 0 ? -a.b : 0, negative = a.u.m < 0;
  quotient r = divide(n, k, a.a);
  unsigned cut;
  uint64_t low, top = top_of(&r, &cut, &low);
  int up = rounds_up(&r, top, cut, low);
  double h = scaled(top + (uint64_t)up, r.e + (int)cut);
  *hi = negative ? -h : h;
  /* The rest is (low + rest / D) 2^e, or that minus 2^(e + cut) when rounded up: over D = 5^k 2^s an integer of at most 75 bits. */
  qn_u128 part = (qn_u128)low * r.d + r.rest, left = up ? ((qn_u128)r.d << cut) - part : part;
  if (left) {
    quotient l = divide(left, k, r.e - FIVES[k].shift);
    double v = nearest(&l);
    *lo = negative != up ? -v : v;
  }
  return 1;
}

/* The doubles next to x 2^e / 5^k, given its sign: the one below and the one above. */
QN_INLINE void around(qn_u128 x, int negative, int k, int e, double *down, double *up) {
  if (x == 0) {
    *down = *up = 0;
    return;
  }
  quotient r = divide(x, k, e);
  unsigned cut;
  uint64_t low, top = top_of(&r, &cut, &low);
  double near = scaled(top, r.e + (int)cut), far = low || r.rest ? scaled(top + 1, r.e + (int)cut) : near;
  *down = negative ? -far : near;
  *up = negative ? -near : far;
}

int qn_num_quick_span(qn_num a, qn_num b, double *down, double *up) {
  if (!usual(a) || !usual(b) || b.u.m < 0) {
    return 0;
  }
  int twos = a.u.m == 0 ? b.a : b.u.m == 0 ? a.a : a.a < b.a ? a.a : b.a, fives = a.b < b.b ? a.b : b.b;
  fives = fives > 0 ? 0 : fives;
  qn_u128 x = 0, y = 0;
  if ((a.u.m && !qn_num_scaled_(a.u.m, a.a - twos, a.b - fives, &x)) || (b.u.m && !qn_num_scaled_(b.u.m, b.a - twos, b.b - fives, &y))) {
    return 0;
  }
  double unused;
  int negative = a.u.m < 0, beyond = x < y; /* beyond: the end nearer to 0 lies on the other side of it */
  qn_u128 outer = x + y, inner = beyond ? y - x : x - y;
  around(negative ? outer : inner, negative || beyond, -fives, twos, down, &unused);
  around(negative ? inner : outer, negative && !beyond, -fives, twos, &unused, up);
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
  if (a.b > 0 || a.a < -SIZES / 2 || a.a > SIZES / 2) {
    return 0;
  }
  uint64_t m = qn_magnitude_(a.u.m);
  qn_u128 n = (qn_u128)m * m;
  if (-2 * a.b <= QN_FIVES_) {
    quotient r = divide(n, -2 * a.b, 2 * a.a);
    *out = nearest(&r);
  } else {
    uint64_t f = qn_five_to_[-a.b];
    qn_u128 d = (qn_u128)f * f;
    mp_limb_t num[2] = {(mp_limb_t)n, (mp_limb_t)(n >> 64)}, den[2] = {(mp_limb_t)d, (mp_limb_t)(d >> 64)};
    *out = qn_limbs_to_double_(num, num[1] ? 2 : 1, den, den[1] ? 2 : 1, 2 * a.a);
  }
  return 1;
}

/* --- decimals --------------------------------------------------------------------------------------------------------- */

QN_INLINE unsigned digit_of(char c) {
  return (unsigned)(unsigned char)c - '0'; /* above 9 when it is none */
}

/* rest: null, or set to what the nearest double lacks, rounded. */
QN_INLINE size_t read_decimal(const char *text, double *nearest_out, int *exact, double *rest) {
  const char *at = text + (*text == '-' || *text == '+'), *first, *point;
  uint64_t m = 0;
  unsigned d;
  while (*at == '0') {
    at++;
  }
  int any = at > text && at[-1] == '0';
  for (first = at; (d = digit_of(*at)) <= 9; at++) {
    m = m * 10 + d;
  }
  ptrdiff_t count = at - first, scale = 0;
  any |= count > 0;
  if (*at == '.') {
    point = ++at;
    if (count == 0) { /* zeros before the first digit that counts */
      while (*at == '0') {
        at++;
      }
    }
    for (first = at; (d = digit_of(*at)) <= 9; at++) {
      m = m * 10 + d;
    }
    any |= at > point;
    count += at - first;
    scale = point - at;
  }
  if (!any || count > 19) {
    return 0;
  }
  if (*at == 'e' || *at == 'E') {
    int negative = *++at == '-', e = 0;
    at += *at == '-' || *at == '+';
    for (first = at; (d = digit_of(*at)) <= 9 && e < 10000; at++) {
      e = e * 10 + (int)d;
    }
    if (at == first || digit_of(*at) <= 9) {
      return 0;
    }
    scale += negative ? -e : e;
  }
  if (m == 0) {
    *nearest_out = 0;
    *exact = 1;
    if (rest) {
      *rest = 0;
    }
    return (size_t)(at - text);
  }
  if (scale < -QN_FIVES_ || scale > QN_FIVES_) {
    return 0;
  }
  quotient r = divide((qn_u128)m * (scale > 0 ? qn_five_to_[scale] : 1), scale < 0 ? (int)-scale : 0, (int)scale);
  unsigned cut;
  uint64_t low, top = top_of(&r, &cut, &low);
  const int up = rounds_up(&r, top, cut, low);
  double v = scaled(top + (uint64_t)up, r.e + (int)cut);
  *nearest_out = with_sign(v, *text == '-');
  *exact = low == 0 && r.rest == 0;
  if (rest) { /* docs/bounds.md, "Lines of decimals" */
    const double part = (double)(int64_t)low + rounded(r.rest) / rounded(r.d);
    *rest = with_sign((part - (double)((int64_t)up << cut)) * scaled(1, r.e), *text == '-');
  }
  return (size_t)(at - text);
}

size_t qn_decimal_quick(const char *text, double *nearest_out, int *exact) {
  return read_decimal(text, nearest_out, exact, NULL);
}

size_t qn_decimal_quick_pair(const char *text, double *high, double *low) {
  int exact;
  return read_decimal(text, high, &exact, low);
}
