/* A decimal as a pair of doubles against rationals: the nearest double, and a rest that is right to 2^-104 of the number (docs/bounds.md,
   QN_ROUND_PAIR_EVAL). */
#include "query/decimals.h"
#include "share.h"

#include "random_solid.h"

#include <gmp.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

/* digits 10^-places as a text, one way of many. */
static void spell(dice *d, const char *digits, int places, int negative, char *out, size_t size) {
  int n = (int)strlen(digits), after = roll(d, 2) ? (places > 0 ? places : 0) : roll(d, 25), e = after - places;
  char mantissa[100];
  if (after == 0) {
    snprintf(mantissa, sizeof mantissa, "%s%s", digits, roll(d, 3) ? "" : ".");
  } else if (after >= n) {
    snprintf(mantissa, sizeof mantissa, "%s.%0*d%s", roll(d, 2) ? "0" : roll(d, 2) ? "" : "000", after - n, 0, digits);
    if (after == n) {
      snprintf(mantissa, sizeof mantissa, "0.%s", digits);
    }
  } else {
    snprintf(mantissa, sizeof mantissa, "%.*s.%s", n - after, digits, digits + n - after);
  }
  const char *sign = negative ? "-" : roll(d, 4) ? "" : "+";
  if (e == 0 && roll(d, 4)) {
    snprintf(out, size, "%s%s", sign, mantissa);
  } else {
    snprintf(out, size, "%s%s%c%s%d", sign, mantissa, roll(d, 2) ? 'e' : 'E', e >= 0 && roll(d, 2) ? "+" : "", e);
  }
}

static void pairs(void **state) {
  (void)state;
  dice d = {0x9e3779b97f4a7c15u};
  mpq_t value, sum, x;
  mpq_init(value), mpq_init(sum), mpq_init(x);
  size_t read = 0, inexact = 0;
  double worst = 0;
  for (int n = 0; n < share_of(200000); n++) {
    char digits[32], text[160];
    int count = 1 + roll(&d, 19), places = roll(&d, 26) - 2, negative = roll(&d, 2);
    for (int i = 0; i < count; i++) {
      digits[i] = (char)('0' + (roll(&d, 6) ? roll(&d, 10) : roll(&d, 2) * 9));
    }
    digits[count] = '\0';
    spell(&d, digits, places, negative, text, sizeof text);
    double high, low;
    if (!qn_decimal_pair(text, &high, &low)) {
      continue;
    }
    read++;
    mpq_set_str(value, digits, 10);
    mpz_t ten;
    mpz_init(ten);
    mpz_ui_pow_ui(ten, 10, (unsigned long)abs(places));
    mpq_set_z(x, ten);
    (places > 0 ? mpq_div : mpq_mul)(value, value, x);
    mpz_clear(ten);
    if (negative) {
      mpq_neg(value, value);
    }
    double nearest = strtod(text, NULL);
    assert_true(high == nearest);
    mpq_set_d(sum, high), mpq_set_d(x, low);
    if (low == 0) { /* exactly, or the rest is too */
      assert_int_equal(mpq_cmp(sum, value), 0);
      continue;
    }
    inexact++;
    assert_true(fabs(low) <= 0x1p-53 * fabs(high) * (1 + 0x1p-40));
    mpq_add(sum, sum, x);
    mpq_sub(sum, sum, value);
    mpq_div(sum, sum, value);
    worst = fmax(worst, ldexp(fabs(mpq_get_d(sum)), 104));
  }
  print_message("%zu read, %zu of them not doubles; error/2^-104 %.3f\n", read, inexact, worst);
  assert_true(read > share_min(100000) && inexact > share_min(50000) && worst <= 1 && (!share_whole() || worst > 0.05));
  static const char *const not_for_it[] = {"", "x", "1x", "1e-30", "0.12345678901234567891", "1e400", "inf", "nan", "0.1 ", "1.1e-30"};
  for (size_t i = 0; i < sizeof not_for_it / sizeof *not_for_it; i++) {
    double high, low;
    if (qn_decimal_pair(not_for_it[i], &high, &low)) {
      print_error("%s was read as %g + %g\n", not_for_it[i], high, low);
      fail();
    }
  }
  mpq_clear(value), mpq_clear(sum), mpq_clear(x);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(pairs)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
