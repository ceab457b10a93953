/* Faces of polyhedra: sides from doubles against sides in rationals (QN_POLYHEDRON_SIDE), the order of corners against the definition. */
#include "model/polyhedron.h"

#include "base/bounds.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

static uint64_t dice = 1;
static uint64_t roll(void) { /* splitmix64 */
  uint64_t z = dice += UINT64_C(0x9E3779B97F4A7C15);
  z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
  z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
  return z ^ z >> 31;
}
static int64_t between(int64_t low, int64_t high) {
  return low + (int64_t)(roll() % (uint64_t)(high - low + 1));
}

static qn_num quotient(qn_ctx *ctx, int64_t a, int64_t b) {
  return qn_num_div(ctx, qn_num_from_int(ctx, a), qn_num_from_int(ctx, b));
}

/* Planes and points of fractions, the point nearly on the plane: x is solved for, and moved by up to 2^-44 of itself. A certain sign is the true one; the error of what
   doubles give is within the bound, and now and then more than an eighth of it. */
static void sides(void **state) {
  (void)state;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  double worst = 0;
  int certain = 0, open = 0;
  for (int trial = 0; trial < 20000; trial++) {
    qn_ctx ctx;
    qn_ctx_init(&ctx, &mem);
    qn_num plane[4], p[3];
    double near[4], near_p[3];
    for (int i = 0; i < 4; i++) {
      plane[i] = quotient(&ctx, between(-1000000, 1000000), between(1, 1000000));
    }
    if (qn_num_is_zero(plane[0])) {
      plane[0] = QN_NUM_ONE;
    }
    for (int i = 1; i < 3; i++) {
      p[i] = quotient(&ctx, between(-1000000, 1000000), between(1, 1000000));
    }
    qn_num a[3] = {plane[3], plane[1], plane[2]}, b[3] = {QN_NUM_ONE, qn_num_neg(&ctx, p[1]), qn_num_neg(&ctx, p[2])};
    p[0] = qn_num_div(&ctx, qn_num_dot(&ctx, 3, a, b), plane[0]);
    p[0] = qn_num_mul(&ctx, p[0], qn_num_add(&ctx, QN_NUM_ONE, qn_num_mul(&ctx, qn_num_from_int(&ctx, between(-4096, 4096)), qn_num_from_double(&ctx, 0x1p-56))));
    qn_polyhedron_shadow(4, plane, near);
    qn_polyhedron_shadow(3, p, near_p);
    qn_num x[4] = {plane[0], plane[1], plane[2], plane[3]}, y[4] = {p[0], p[1], p[2], qn_num_from_int(&ctx, -1)};
    qn_num s = qn_num_dot(&ctx, 4, x, y);
    int quick = qn_polyhedron_quick(near, near_p);
    assert_true(quick == 0 || quick == qn_num_sign(s));
    assert_int_equal(qn_polyhedron_side(&ctx, plane, near, p, near_p), qn_num_sign(s));
    certain += quick != 0;
    open += quick == 0;
    double t[3] = {near[0] * near_p[0], near[1] * near_p[1], near[2] * near_p[2]};
    double error = fabs(qn_num_to_double(qn_num_sub(&ctx, qn_num_from_double(&ctx, t[0] + t[1] + t[2] - near[3]), s)));
    double share = error / (fabs(t[0]) + fabs(t[1]) + fabs(t[2]) + fabs(near[3]));
    assert_true(share <= QN_POLYHEDRON_SIDE);
    worst = fmax(worst, share);
    assert_int_equal(ctx.failed, QUOIN_OK);
    qn_ctx_free(&ctx);
  }
  assert_true(worst > QN_POLYHEDRON_SIDE / 8);
  assert_true(certain > 1000 && open > 1000);
}

/* Numbers beyond QN_POLYHEDRON_LARGEST, whose products are lost, decide nothing. */
static void sizes(void **state) {
  (void)state;
  qn_mem mem;
  qn_ctx ctx;
  qn_mem_init(&mem, NULL);
  qn_ctx_init(&ctx, &mem);
  for (int e = -1000; e <= 1000; e += 100) {
    qn_num plane[4] = {qn_num_from_double(&ctx, ldexp(1, e)), QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO}, p[3] = {qn_num_from_double(&ctx, ldexp(1, e)), QN_NUM_ONE, QN_NUM_ONE};
    double near[4], near_p[3];
    qn_polyhedron_shadow(4, plane, near);
    qn_polyhedron_shadow(3, p, near_p);
    assert_int_equal(qn_polyhedron_quick(near, near_p), e >= -300 && e <= 300);
    assert_int_equal(qn_polyhedron_side(&ctx, plane, near, p, near_p), 1);
    assert_int_equal(qn_polyhedron_may_be(near, near) & 1, 1);
  }
  qn_ctx_free(&ctx);
}

/* Corners of convex polygons in planes of all directions, shuffled: each follows the one that has all others on its right, seen from outside. */
static void order_of_corners(void **state) {
  (void)state;
  enum { MOST = 40 };
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  for (int trial = 0; trial < 600; trial++) {
    qn_ctx ctx;
    qn_ctx_init(&ctx, &mem);
    size_t count = (size_t)between(3, MOST);
    int k = trial % 3, sign = trial % 2 ? 1 : -1, flat = trial % 5 == 0;
    int64_t a = flat ? 0 : between(-3, 3), b = flat ? 0 : between(-3, 3), start = between(-20, 5);
    qn_num vertices[3 * MOST], plane[4];
    uint32_t corners[MOST];
    int64_t u[MOST], v[MOST];
    for (size_t i = 0; i < count; i++) { /* half of them on one parabola, half on another */
      int64_t x = start + (int64_t)(i / 2);
      u[i] = x;
      v[i] = i % 2 ? x * x - 100000 : 100000 - x * x;
    }
    for (size_t i = count - 1; i > 0; i--) {
      size_t j = (size_t)between(0, (int64_t)i);
      int64_t s = u[i], t = v[i];
      u[i] = u[j], v[i] = v[j], u[j] = s, v[j] = t;
    }
    for (size_t i = 0; i < count; i++) {
      vertices[3 * i + (size_t)k] = qn_num_from_int(&ctx, a * u[i] + b * v[i] + 7);
      vertices[3 * i + (size_t)((k + 1) % 3)] = qn_num_from_int(&ctx, u[i]);
      vertices[3 * i + (size_t)((k + 2) % 3)] = qn_num_from_int(&ctx, v[i]);
      corners[i] = (uint32_t)i;
    }
    plane[k] = qn_num_from_int(&ctx, sign);
    plane[(k + 1) % 3] = qn_num_from_int(&ctx, -sign * a);
    plane[(k + 2) % 3] = qn_num_from_int(&ctx, -sign * b);
    plane[3] = qn_num_from_int(&ctx, sign * 7);
    qn_polyhedron_turn(&ctx, plane, vertices, corners, count);
    assert_int_equal(corners[0], 0);
    for (size_t i = 0; i < count; i++) {
      size_t here = corners[i], next = corners[(i + 1) % count];
      for (size_t j = 0; j < count; j++) {
        size_t other = corners[j];
        if (other != here && other != next) {
          assert_true(sign * ((u[next] - u[here]) * (v[other] - v[here]) - (v[next] - v[here]) * (u[other] - u[here])) < 0);
        }
      }
    }
    assert_int_equal(ctx.failed, QUOIN_OK);
    qn_ctx_free(&ctx);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(sides),
    cmocka_unit_test(sizes),
    cmocka_unit_test(order_of_corners),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
