/* The bound of wide/spans_flat.h in rationals, in its baseline body: places on planes across an axis against their exact values, biased towards cancellation; and
   what is called certain is the nearest double. */
#include "dice.h"
#include "share.h"
#include "wide/spans_flat.h"

#include <gmp.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* A double of magnitude about 2^low .. 2^high, with few or many bits. */
static double number(int low, int high) {
  double m = (double)(next() >> 11) * 0x1p-53 + 0.5;
  if (one_in(4)) {
    m = ldexp(floor(ldexp(m, 4)), -4);
  }
  return (next() & 1 ? -1 : 1) * ldexp(m, low + (int)(next() % (uint64_t)(high - low + 1)));
}

typedef struct census { unsigned sound, sure, near, far, odd; double worst; } census;

/* Whether no double is nearer to t than x is. */
static int nearest(double x, const mpq_t t, mpq_t a, mpq_t b) {
  const double beside[2] = {nextafter(x, HUGE_VAL), nextafter(x, -HUGE_VAL)};
  mpq_set_d(a, x);
  mpq_sub(a, a, t);
  mpq_abs(a, a);
  for (int i = 0; i < 2; i++) {
    mpq_set_d(b, beside[i]);
    mpq_sub(b, b, t);
    mpq_abs(b, b);
    if (mpq_cmp(b, a) < 0) {
      return 0;
    }
  }
  return 1;
}

static void places_in_rationals(void **state) {
  (void)state;
  census c = {0};
  mpq_t X, t, a, b;
  mpq_inits(X, t, a, b, NULL);
  for (int n = 0; n < share_of(60000); n++) {
    _Alignas(64) double high[QN_W], low[QN_W], o[QN_W], d[QN_W], inverse[QN_W], hi[QN_W], lo[QN_W], error[QN_W], out[QN_W];
    for (int i = 0; i < QN_W; i++) {
      const int size = one_in(3) ? 60 : 3, kind = (int)(next() % 4);
      high[i] = number(-size, size);
      low[i] = one_in(4) ? 0 : high[i] * number(-8, -1) * QN_U * 0.5;
      d[i] = one_in(40) ? number(-420, -380) : number(-size, size);
      o[i] = kind == 0 ? number(-size, size) : kind == 1 ? high[i] * (1 + number(-50, -2)) : kind == 2 ? high[i] - d[i] * number(-3, 3) : one_in(30) ? high[i] : number(-200, size);
      inverse[i] = 1 / d[i];
      c.near += fabs(o[i] - high[i]) < 1e-6 * fabs(high[i]), c.far += fabs(o[i]) > 1e6 * fabs(high[i]);
    }
    const flat_place f = flat_at(vload(high), vload(low), vload(o), vload(d), vload(inverse));
    vstore(hi, f.sum.hi), vstore(lo, f.sum.lo), vstore(error, f.error);
    vd rounded;
    const unsigned sound = vbits(f.sound), sure = flat_round(vload(high), vload(low), vload(o), vload(d), vload(inverse), &rounded);
    vstore(out, rounded);
    assert_true((sure & ~sound) == 0);
    for (int i = 0; i < QN_W; i++) {
      c.odd += !(sound >> i & 1);
      if (!(sound >> i & 1)) {
        continue;
      }
      mpq_set_d(X, high[i]);
      mpq_set_d(a, low[i]);
      mpq_add(X, X, a);
      mpq_div_2exp(a, X, 105); /* what X may be off */
      (one_in(2) ? mpq_add : mpq_sub)(X, X, a);
      mpq_set_d(a, o[i]);
      mpq_sub(t, X, a);
      mpq_set_d(a, d[i]);
      mpq_div(t, t, a);
      mpq_set_d(a, hi[i]);
      mpq_set_d(b, lo[i]);
      mpq_add(a, a, b);
      mpq_sub(a, a, t);
      mpq_abs(a, a);
      mpq_set_d(b, error[i]);
      assert_true(mpq_cmp(a, b) <= 0);
      mpq_div(a, a, b);
      c.worst = fmax(c.worst, mpq_get_d(a));
      c.sound++, c.sure += sure >> i & 1;
      if (sure >> i & 1) {
        assert_true(nearest(out[i], t, a, b));
      }
    }
  }
  mpq_clears(X, t, a, b, NULL);
  print_message("  %u places, %u certain, %u out of range; %u near, %u far; largest error over its bound %.3f\n", c.sound, c.sure, c.odd, c.near, c.far, c.worst);
  assert_true(c.sound > share_min(100000) && c.sure > c.sound - c.sound / 4 && c.odd > share_min(100) && c.near > share_min(1000) && c.far > share_min(1000));
  assert_true(!share_whole() || c.worst > 1.0 / 64); /* the bound is not idle */
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(places_in_rationals)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
