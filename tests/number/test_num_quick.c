/* The quick doubles of small numbers against the slow ones, and against exact comparison. */
#include "number/num.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static uint64_t state = 77;
static uint64_t bits(void) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return state ^ state >> 29;
}
static int64_t rnd(int64_t low, int64_t high) {
  return low + (int64_t)((bits() >> 8) % (uint64_t)(high - low + 1));
}

/* m of any length, plain decimals among them, and numbers amid two doubles. */
static qn_num draw(qn_ctx *ctx, int fives) {
  qn_num n = qn_num_from_int(ctx, (int64_t)(bits() >> (1 + bits() % 63)) * (bits() & 8 ? 1 : -1));
  switch (bits() % 4) {
  case 0: /* a decimal */
    for (int64_t digits = rnd(0, 18); digits > 0; digits--) {
      n = qn_num_div(ctx, n, qn_num_from_int(ctx, 10));
    }
    break;
  case 1: /* odd, of 54 bits: amid two doubles */
    n = qn_num_from_int(ctx, (int64_t)((bits() >> 11) | (UINT64_C(1) << 53) | 1));
    break;
  case 2:
    n = qn_num_from_int(ctx, rnd(-40, 40));
    break;
  default:
    break;
  }
  if (n.u.m && bits() % 2) {
    n.a = (int16_t)(n.a + rnd(-300, 60));
  }
  if (n.u.m && fives) {
    n.b = (int16_t)rnd(-29, 29);
  }
  return n;
}

static void pairs(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  qn_ctx ctx;
  qn_ctx_init(&ctx, &mem);
  size_t done = 0, refused = 0, exact = 0;
  for (int i = 0; i < 400000; i++) {
    qn_num a = draw(&ctx, i % 2);
    double hi, lo, h, l;
    qn_num_to_dd(&ctx, a, &h, &l);
    if (qn_num_quick_pair(a, &hi, &lo)) {
      assert_true(hi == h && lo == l);
      done++;
      exact += lo == 0;
    } else {
      assert_true(a.b < -27 || a.b > 27);
      refused++;
    }
  }
  assert_true(done > 300000 && refused > 5000 && exact > 10000);
  qn_ctx_free(&ctx);
  assert_int_equal(mem.used, 0);
}

static void squares(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  qn_ctx ctx;
  qn_ctx_init(&ctx, &mem);
  size_t done = 0;
  for (int i = 0; i < 200000; i++) {
    qn_mark mark = qn_arena_mark(&ctx.arena);
    qn_num a = draw(&ctx, i % 3 == 0);
    double quick;
    if (qn_num_quick_square(a, &quick)) {
      assert_true(quick == qn_num_to_double(qn_num_mul(&ctx, a, a)));
      done++;
    }
    qn_arena_release(&ctx.arena, mark);
  }
  assert_true(done > 100000);
  qn_ctx_free(&ctx);
  assert_int_equal(mem.used, 0);
}

static void spans(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  qn_ctx ctx;
  qn_ctx_init(&ctx, &mem);
  size_t done = 0, exact = 0, refused = 0, zero = 0, across = 0;
  for (int i = 0; i < 400000; i++) {
    qn_mark mark = qn_arena_mark(&ctx.arena);
    qn_num a = draw(&ctx, i % 5 == 0), b = bits() % 16 ? draw(&ctx, i % 7 == 0) : a;
    if (bits() % 4 == 0 && a.u.m) { /* close in size: much cancels */
      b = qn_num_mul(&ctx, qn_num_from_int(&ctx, a.u.m + (int64_t)(bits() % 3) - 1), (qn_num){{1}, a.a, a.b, QN_NUM_SMALL});
    }
    b = qn_num_abs(&ctx, b);
    double down, up;
    if (qn_num_quick_span(a, b, &down, &up)) {
      qn_num low = qn_num_sub(&ctx, a, b), high = qn_num_add(&ctx, a, b);
      int below = qn_num_cmp(&ctx, qn_num_from_double(&ctx, down), low), above = qn_num_cmp(&ctx, qn_num_from_double(&ctx, up), high);
      assert_true(below <= 0 && above >= 0);
      assert_true(below == 0 || qn_num_cmp(&ctx, qn_num_from_double(&ctx, nextafter(down, INFINITY)), low) > 0);
      assert_true(above == 0 || qn_num_cmp(&ctx, qn_num_from_double(&ctx, nextafter(up, -INFINITY)), high) < 0);
      done++;
      exact += below == 0 && above == 0;
      zero += down == 0 || up == 0;
      across += down < 0 && up > 0;
      assert_false(signbit(down) && down == 0);
      assert_false(signbit(up) && up == 0);
    } else {
      refused++;
    }
    qn_arena_release(&ctx.arena, mark);
  }
  print_message("%zu spans, %zu exact, %zu from or to zero, %zu across, %zu refused\n", done, exact, zero, across, refused);
  assert_true(done > 150000 && exact > 20000 && refused > 20000 && zero > 5000 && across > 20000 && done - exact > 50000);
  qn_ctx_free(&ctx);
  assert_int_equal(mem.used, 0);
}

static void others_are_refused(void **unused) {
  (void)unused;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  qn_ctx ctx;
  qn_ctx_init(&ctx, &mem);
  double x, y;
  qn_num third = qn_num_div(&ctx, qn_num_from_int(&ctx, 1), qn_num_from_int(&ctx, 3));
  assert_false(qn_num_quick_pair(third, &x, &y));
  assert_false(qn_num_quick_square(third, &x));
  assert_false(qn_num_quick_span(QN_NUM_ONE, third, &x, &y));
  assert_false(qn_num_quick_span(QN_NUM_ONE, qn_num_from_int(&ctx, -1), &x, &y));
  assert_false(qn_num_quick_pair((qn_num){{1}, 401, 0, QN_NUM_SMALL}, &x, &y));
  qn_ctx_free(&ctx);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(pairs), cmocka_unit_test(squares), cmocka_unit_test(spans), cmocka_unit_test(others_are_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
