/* Numbers as the commands print them against printf: the same bytes for doubles of every size and kind.

   Run with a number for more: cli_number [millions]. */
#include "../share.h"
#include "cli/number.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static double millions = 0.6;
static uint64_t seed = 0x2545f4914f6cdd1du;
static uint64_t next(void) {
  seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17;
  return seed;
}

static void check(double x) {
  char got[CLI_NUMBER_SIZE], want[64];
  size_t length = cli_format_number(got, x);
  int wanted = snprintf(want, sizeof want, "%.17g", x);
  if (wanted != (int)length || memcmp(got, want, length) != 0) {
    print_error("%a: %.*s, wanted %s\n", x, (int)length, got, want);
    fail();
  }
}

/* x, its negative, and its neighbours. */
static void check_near(double x) {
  check(x), check(-x);
  double up = x, down = x;
  for (int i = 0; i < 4; i++) {
    up = nextafter(up, INFINITY), down = nextafter(down, -INFINITY);
    check(up), check(down);
  }
}

static void edges(void **state) {
  (void)state;
  static const double some[] = {0, -0.0, INFINITY, 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, 0.1, 0.5, 1e16, 1e17, 123456789012345678.0, 9007199254740993.0};
  for (size_t i = 0; i < sizeof some / sizeof *some; i++) {
    check_near(some[i]);
  }
  for (int e = -330; e <= 310; e++) { /* about powers of ten: where the digits are one more */
    char text[16];
    snprintf(text, sizeof text, "1e%d", e);
    check_near(strtod(text, NULL));
    snprintf(text, sizeof text, "5e%d", e);
    check_near(strtod(text, NULL));
  }
  for (int e = -1074; e < 1024; e++) {
    check_near(ldexp(1, e));
  }
}

/* Exactly half-way between two numbers of 17 digits: m 2^-k with an odd m has k places after its point, the last of them a 5. */
static void ties(void **state) {
  (void)state;
  size_t halves = 0;
  for (int k = 1; k < 53; k++) {
    for (int i = 0; i < share_of(4000); i++) {
      double x = ldexp((double)(next() >> (11 + next() % 50) | 1), -k);
      char exact[1200];
      int length = snprintf(exact, sizeof exact, "%.1100g", x), digits = 0;
      for (int j = 0; j < length; j++) {
        digits += exact[j] >= '0' && exact[j] <= '9' && (digits > 0 || exact[j] != '0');
      }
      halves += digits == 18;
      check(x), check(-x);
    }
  }
  assert_true(halves > share_min(1000));
}

static void random_numbers(void **state) {
  (void)state;
  for (long i = 0; i < (long)(millions * 1e6); i++) {
    uint64_t bits = next();
    double x;
    switch (i % 5) {
    case 0: memcpy(&x, &bits, sizeof x); break;
    case 1: x = ldexp((double)(bits >> 11), -(int)(next() % 180)); break;
    case 2: x = (double)(int64_t)(bits >> next() % 60) / pow(10, (double)(next() % 22)); break;
    case 3: x = ldexp((double)(bits >> (11 + next() % 52)), -(int)(next() % 160)); break;
    default: x = ((double)(bits >> 11) * 0x1p-53 - 0.5) * 200; break;
    }
    if (!isnan(x)) {
      check(x);
    }
  }
}

int main(int words, char **word) {
  millions = words > 1 ? atof(word[1]) : millions;
  const struct CMUnitTest tests[] = {cmocka_unit_test(edges), cmocka_unit_test(ties), cmocka_unit_test(random_numbers)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
