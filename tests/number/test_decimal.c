/* The quick reader of decimals against qn_num_read: the same bytes read, the nearest double, and exactness. */
#include "number/num.h"
#include "share.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static uint64_t state = 5;
static uint64_t bits(void) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return state ^ state >> 29;
}
static int below(int n) { return (int)((bits() >> 8) % (uint64_t)n); }

typedef struct census { size_t read, exact, half, left, none, zero; } census;

static void compare(qn_ctx *ctx, const char *text, census *c) {
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_num n;
  quoin_status status;
  size_t read = qn_num_read(ctx, text, strlen(text), &n, &status);
  double x = NAN;
  int exact = -1;
  size_t quick = qn_decimal_quick(text, &x, &exact);
  c->none += read == 0;
  c->left += read != 0 && quick == 0;
  if (quick) {
    double true_x = qn_num_to_double(n);
    if (quick != read || status != QUOIN_OK || x != true_x || signbit(x) != signbit(true_x) || exact != qn_num_equal(n, qn_num_from_double(ctx, true_x))) {
      print_error("%s: read %zu of %zu, %a for %a, exact %d\n", text, quick, read, x, true_x, exact);
      fail();
    }
    c->read++;
    c->exact += exact;
    c->zero += x == 0;
  }
  qn_arena_release(&ctx->arena, mark);
}

static void put_digits(char *text, int n) {
  for (int i = 0; i < n; i++) {
    text[i] = (char)('0' + (below(4) ? below(10) : below(2) * 9));
  }
  text[n] = '\0';
}

static void random_texts(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  qn_ctx ctx;
  qn_ctx_init(&ctx, &mem);
  census c = {0};
  for (int i = 0; i < share_of(400000); i++) {
    char text[100], part[60];
    static const char *const signs[] = {"", "", "", "-", "+"}, *const points[] = {"", ".", ".", "."};
    snprintf(text, sizeof text, "%s", signs[below(5)]);
    if (below(8) == 0) {
      strcat(text, "000");
    }
    put_digits(part, below(12));
    strcat(text, part);
    strcat(text, points[below(4)]);
    put_digits(part, below(12));
    strcat(text, part);
    if (below(3) == 0) {
      snprintf(part, sizeof part, "%c%s%d", below(2) ? 'e' : 'E', signs[below(5)], below(below(2) ? 12 : 45));
      strcat(text, part);
    }
    if (below(8) == 0) { /* anything may follow, or stand within */
      text[(size_t)below((int)strlen(text) + 1)] = "x.e-+ 0"[below(7)];
    }
    compare(&ctx, text, &c);
    double d; /* and what a program prints: doubles, with their digits or fewer */
    uint64_t b = (bits() >> 12 & 0xfffffffffffff) | (uint64_t)(1023 - 30 + below(60)) << 52;
    memcpy(&d, &b, sizeof d);
    snprintf(text, sizeof text, "%.*g", 1 + below(19), d);
    compare(&ctx, text, &c);
  }
  print_message("%zu read, %zu of them exact, %zu zero; %zu left; %zu no numbers\n", c.read, c.exact, c.zero, c.left, c.none);
  assert_true(c.read > share_min(500000) && c.exact > share_min(40000) && c.read - c.exact > share_min(200000) && c.left > share_min(20000) && c.none > share_min(2000) && c.zero > share_min(500));
  qn_ctx_free(&ctx);
  assert_int_equal(mem.used, 0);
}

/* Decimals amid two doubles, and next to such: k + 1/2 units of the last place, written out. */
static void halves(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  qn_ctx ctx;
  qn_ctx_init(&ctx, &mem);
  census c = {0};
  for (int i = 0; i < share_of(100000); i++) {
    uint64_t m = (bits() >> 10 & 0x3fffffffffffff) | UINT64_C(0x20000000000001); /* 54 bits, odd: its double is a tie */
    char text[60];
    int64_t off = below(3) - 1;
    snprintf(text, sizeof text, "%llu", (unsigned long long)(m + (uint64_t)off));
    compare(&ctx, text, &c);
    snprintf(text, sizeof text, "%llu.%s", (unsigned long long)(m >> 1), off < 0 ? "4" : off > 0 ? "51" : "50");
    compare(&ctx, text, &c);
    snprintf(text, sizeof text, "%llu5e-1", (unsigned long long)(m >> 1));
    compare(&ctx, text, &c);
  }
  assert_int_equal(c.read, (size_t)share_of(100000) * 3);
  qn_ctx_free(&ctx);
}

static void corners(void **unused) {
  (void)unused;
  static const char *const texts[] = {"", "-", "+", ".", "-.", "0", "-0", "00", "0.", ".0", "-.0", "0e5", "0e99999999999999999999", "1e", "1e+", "1e-", "1e+ ", "1.e3", ".5e1",
    "1e27", "1e28", "1e-27", "1e-28", "9999999999999999999", "10000000000000000000", "0000000000000000000001", "0.0000000000000000000000000001", "18446744073709551615",
    "1e9999", "1e10000", "1e99999", "1e00000000000000000003", "0x10", "inf", "nan", "1,2", "1.2.3", "--1", "+-1", "1e5.5", "9007199254740993", "9007199254740992.5", "1 ", " 1"};
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  qn_ctx ctx;
  qn_ctx_init(&ctx, &mem);
  census c = {0};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    compare(&ctx, texts[i], &c);
  }
  assert_true(c.read > 20 && c.none > 6);
  double x;
  int exact;
  assert_int_equal(qn_decimal_quick("0.1", &x, &exact), 3);
  assert_true(x == 0.1 && !exact);
  assert_int_equal(qn_decimal_quick("-2.5e1,", &x, &exact), 6);
  assert_true(x == -25 && exact);
  qn_ctx_free(&ctx);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(random_texts), cmocka_unit_test(halves), cmocka_unit_test(corners)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
