/* %.17g without printf, exact, for numbers of usual size.

   |x| = m 2^e with 2^52 <= m < 2^53 (subnormal numbers are left to printf). Let X be the decimal exponent and k = 16 - X: then
   |x| 10^k = m 5^k 2^(e + k) has 17 digits before its point. 5^k has at most 128 bits for k <= 55, so the product m 5^k is had whole, and the bits that
   2^(e + k) shifts out tell exactly how the digits round: to nearest, ties to even, as printf does. X is guessed from the binary exponent; the guess
   is right or one too small. */
#include "cli/number.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { MOST_PLACES = 55, DIGITS = 17 };
static const struct { uint64_t high, low; } FIVES[MOST_PLACES + 1] = {
  {0x0u, 0x1u}, {0x0u, 0x5u}, {0x0u, 0x19u}, {0x0u, 0x7du}, {0x0u, 0x271u}, {0x0u, 0xc35u}, {0x0u, 0x3d09u}, {0x0u, 0x1312du},
  {0x0u, 0x5f5e1u}, {0x0u, 0x1dcd65u}, {0x0u, 0x9502f9u}, {0x0u, 0x2e90eddu}, {0x0u, 0xe8d4a51u}, {0x0u, 0x48c27395u},
  {0x0u, 0x16bcc41e9u}, {0x0u, 0x71afd498du}, {0x0u, 0x2386f26fc1u}, {0x0u, 0xb1a2bc2ec5u}, {0x0u, 0x3782dace9d9u},
  {0x0u, 0x1158e460913du}, {0x0u, 0x56bc75e2d631u}, {0x0u, 0x1b1ae4d6e2ef5u}, {0x0u, 0x878678326eac9u},
  {0x0u, 0x2a5a058fc295edu}, {0x0u, 0xd3c21bcecceda1u}, {0x0u, 0x422ca8b0a00a425u}, {0x0u, 0x14adf4b7320334b9u},
  {0x0u, 0x6765c793fa10079du}, {0x2u, 0x4fce5e3e2502611u}, {0xau, 0x18f07d736b90be55u}, {0x32u, 0x7cb2734119d3b7a9u},
  {0xfcu, 0x6f7c40458122964du}, {0x4eeu, 0x2d6d415b85acef81u}, {0x18a6u, 0xe32246c99c60ad85u}, {0x7b42u, 0x6fab61f00de36399u},
  {0x2684cu, 0x2e58e9b04570f1fdu}, {0xc097cu, 0xe7bc90715b34b9f1u}, {0x3c2f70u, 0x86aed236c807a1b5u},
  {0x12ced32u, 0xa16a1b11e8262889u}, {0x5e0a1fdu, 0x2712875988becaadu}, {0x1d6329f1u, 0xc35ca4bfabb9f561u},
  {0x92efd1b8u, 0xd0cf37be5aa1cae5u}, {0x2deaf189cu, 0x140c16b7c528f679u}, {0xe596b7b0cu, 0x643c7196d9ccd05du},
  {0x47bf19673du, 0xf52e37f2410011d1u}, {0x166bb7f0435u, 0xc9e717bb45005915u}, {0x701a97b150cu, 0xf18376a85901bd69u},
  {0x23084f676940u, 0xb7915149bd08b30du}, {0xaf298d050e43u, 0x95d69670b12b7f41u}, {0x36bcfc1194751u, 0xed30f03375d97c45u},
  {0x111b0ec57e6499u, 0xa1f4b1014d3f6d59u}, {0x558749db77f700u, 0x29c77506823d22bdu},
  {0x1aba4714957d300u, 0xd0e549208b31adb1u}, {0x85a36366eb71f04u, 0x147a6da2b7f86475u},
  {0x29c30f1029939b14u, 0x6664242d97d9f649u}, {0xd0cf4b50cfe20765u, 0xfff4b4e3f741cf6du}};

typedef struct product { uint64_t w[3]; } product; /* w[0] the lowest */

static void multiply(uint64_t a, uint64_t b, uint64_t *high, uint64_t *low) {
  uint64_t a0 = a & 0xffffffffu, a1 = a >> 32, b0 = b & 0xffffffffu, b1 = b >> 32;
  uint64_t x = a0 * b0, y = a1 * b0 + (x >> 32), z = a0 * b1 + (y & 0xffffffffu);
  *low = z << 32 | (x & 0xffffffffu);
  *high = a1 * b1 + (y >> 32) + (z >> 32);
}

/* m 5^k */
static product times_five(uint64_t m, int k) {
  product p;
  uint64_t high, low;
  multiply(m, FIVES[k].low, &p.w[1], &p.w[0]);
  multiply(m, FIVES[k].high, &high, &low);
  p.w[1] += low;
  p.w[2] = high + (p.w[1] < low);
  return p;
}

/* p 2^-shift, which is below 2^64, rounded to nearest, ties to even; *floor: not rounded. 0 < shift < 192. */
static uint64_t shifted(const product *p, int shift, uint64_t *floor) {
  int word = shift / 64, bits = shift % 64;
  uint64_t rest = 0, half;
  for (int i = 0; i < word; i++) {
    rest |= p->w[i];
  }
  if (bits) {
    uint64_t above = word < 2 ? p->w[word + 1] << (64 - bits) : 0;
    *floor = p->w[word] >> bits | above;
    half = p->w[word] >> (bits - 1) & 1;
    rest |= p->w[word] & (((uint64_t)1 << (bits - 1)) - 1);
  } else { /* word > 0 */
    *floor = p->w[word];
    half = p->w[word - 1] >> 63;
    rest = p->w[word - 1] << 1;
    for (int i = 0; i < word - 1; i++) {
      rest |= p->w[i];
    }
  }
  return *floor + (half & (uint64_t)(rest != 0 || (*floor & 1)));
}

/* The 17 digits of m 2^e and the decimal exponent; 0 where this is not for it. */
static int seventeen(uint64_t m, int e, uint64_t *digits, int *exponent) {
  static const uint64_t most = UINT64_C(100000000000000000); /* 10^17 */
  int x = (int)(((int64_t)(e + 52) * 78913) >> 18); /* floor((e + 52) log10 2) for |e| < 1650 */
  for (;; x++) {
    int k = DIGITS - 1 - x;
    if (k < 0 || k > MOST_PLACES) {
      return 0;
    }
    int shift = -(e + k);
    uint64_t floor;
    if (shift > 0) {
      product p = times_five(m, k);
      *digits = shifted(&p, shift, &floor);
    } else { /* k <= 1: the product is small */
      *digits = floor = m * FIVES[k].low << -shift;
    }
    if (floor >= most) {
      continue;
    }
    if (*digits == most) {
      *digits = most / 10;
      x++;
    }
    *exponent = x;
    return 1;
  }
}

static void put_pairs(char *out, uint32_t v, int pairs) {
  static const char two[] = "00010203040506070809101112131415161718192021222324252627282930313233343536373839404142434445464748495051525354555657585960616263646566676869707172"
                            "737475767778798081828384858687888990919293949596979899";
  for (int i = pairs - 1; i >= 0; i--, v /= 100) {
    memcpy(out + 2 * i, two + 2 * (v % 100), 2);
  }
}

size_t cli_format_number(char out[CLI_NUMBER_SIZE], double x) {
  uint64_t bits, digits;
  memcpy(&bits, &x, sizeof bits);
  int biased = (int)(bits >> 52 & 2047), exponent;
  char *at = out;
  if (x == 0) {
    if (bits >> 63) {
      *at++ = '-';
    }
    *at++ = '0';
    return (size_t)(at - out);
  }
  if (biased == 0 || biased == 2047 || !seventeen((bits & 0xfffffffffffffu) | UINT64_C(1) << 52, biased - 1075, &digits, &exponent)) {
    return (size_t)snprintf(out, CLI_NUMBER_SIZE, "%.17g", x);
  }
  char text[DIGITS + 1]; /* one digit more than pairs come to */
  uint32_t upper = (uint32_t)(digits / 100000000), lower = (uint32_t)(digits % 100000000); /* 9 and 8 digits */
  text[0] = (char)('0' + upper / 100000000);
  put_pairs(text + 1, upper % 100000000, 4);
  put_pairs(text + 9, lower, 4);
  int count = DIGITS; /* without zeros at the end */
  while (text[count - 1] == '0') {
    count--;
  }
  if (bits >> 63) {
    *at++ = '-';
  }
  if (exponent >= 0 && exponent < DIGITS) {
    int whole = exponent + 1;
    memcpy(at, text, (size_t)whole);
    at += whole;
    if (count > whole) {
      *at++ = '.';
      memcpy(at, text + whole, (size_t)(count - whole));
      at += count - whole;
    }
  } else if (exponent < 0 && exponent >= -4) {
    memcpy(at, "0.000", 5); /* NOLINT(bugprone-not-null-terminated-result): the end comes later */
    at += 1 - exponent;
    memcpy(at, text, (size_t)count);
    at += count;
  } else {
    *at++ = text[0];
    if (count > 1) {
      *at++ = '.';
      memcpy(at, text + 1, (size_t)(count - 1));
      at += count - 1;
    }
    memcpy(at, "e-", 2); /* NOLINT(bugprone-not-null-terminated-result) as above; */ /* a large exponent is not for this */
    put_pairs(at + 2, (uint32_t)-exponent, 1);
    at += 4;
  }
  return (size_t)(at - out);
}
