/* Support functions: never below v . x for rational points x of the exact solid, whose arguments are decimals that the doubles
   given to the function only approximate (exact comparison); and close above the highest point. (u, v) in its range. */
#include "share.h"
#include "surface.h"
#include "textbook.h"

static int setup_bench(void **state) {
  static bench b;
  bench_init(&b);
  *state = &b;
  return 0;
}
static int teardown_bench(void **state) {
  bench_free(*state);
  return 0;
}

static solid random_bounded(bench *b, qn_prim prim) {
  solid s = {.prim = prim};
  for (int i = 0; i < 6; i++) {
    s.args[i] = size(b);
  }
  if (prim == QN_CUBE || prim == QN_WEDGE || prim == QN_PARABOLOID) {
    s.args[3] = INT(below(b, 2));
  }
  if (prim == QN_CYLINDER) {
    qn_num f = DIV(INT(below(b, 13)), INT(7));
    s.args[3] = MUL(f, s.args[1]);
    s.args[4] = MUL(f, s.args[2]);
    s.args[5] = INT(below(b, 2));
  }
  if (prim == QN_HYPERBOLOID1 && below(b, 3) == 0) {
    s.args[2] = below(b, 2) ? s.args[1] : MUL(s.args[1], num(b, "1.00000000000000000001"));
  }
  if (prim == QN_HYPERBOLOID2) {
    s.args[2] = MUL(s.args[0], DIV(INT(below(b, 10)), INT(10)));
  }
  return s;
}

/* A point of the surface where v . x is greatest, to second order, as an angle about the axis and a share of the height. The
   free parameters are found in doubles; the point itself is exact. Local coordinates. */
static void highest(bench *b, const solid *s, const double v[3], qn_num x[3]) {
  const qn_num *a = s->args;
  double d[6];
  for (int i = 0; i < 6; i++) {
    d[i] = qn_num_to_double(a[i]);
  }
  qn_num c[2], t[2];
  switch (s->prim) {
    case QN_SPHERE:
    case QN_ELLIPSOID: {
      double p = d[0] * v[0], q = d[s->prim == QN_SPHERE ? 0 : 1] * v[1], r = d[s->prim == QN_SPHERE ? 0 : 2] * v[2];
      circle_at(b, atan2(q, p), c);
      circle_at(b, atan2(r, hypot(p, q)), t);
      x[0] = MUL(a[0], MUL(c[0], t[0]));
      x[1] = MUL(a[s->prim == QN_SPHERE ? 0 : 1], MUL(c[1], t[0]));
      x[2] = MUL(a[s->prim == QN_SPHERE ? 0 : 2], t[1]);
      return;
    }
    case QN_CYLINDER: {
      circle_at(b, atan2(d[2] * v[1] + d[4] * v[1], d[1] * v[0] + d[3] * v[0]), c);
      double low = hypot(d[1] * v[0], d[2] * v[1]), high = hypot(d[3] * v[0], d[4] * v[1]) + d[0] * v[2];
      int top = high > low;
      x[0] = MUL(c[0], a[top ? 3 : 1]);
      x[1] = MUL(c[1], a[top ? 4 : 2]);
      x[2] = MUL(a[0], SUB(INT(top), qn_num_is_zero(a[5]) ? INT(0) : num(b, "0.5")));
      return;
    }
    case QN_PARABOLOID: {
      double r = hypot(d[1] * v[0], d[2] * v[1]), share = v[2] < 0 ? fmin(1, r / (-2 * d[0] * v[2])) : 1;
      qn_num e = qn_num_from_double(&b->ctx, share);
      circle_at(b, atan2(d[2] * v[1], d[1] * v[0]), c);
      x[0] = MUL(c[0], MUL(e, a[1]));
      x[1] = MUL(c[1], MUL(e, a[2]));
      x[2] = SUB(MUL(a[0], SQ(e)), qn_num_is_zero(a[3]) ? INT(0) : DIV(a[0], INT(2)));
      return;
    }
    case QN_HYPERBOLOID1: {
      double rho = hypot(v[0], v[1]), E = sqrt((d[2] - d[1]) * (d[2] + d[1]));
      circle_at(b, atan2(v[1], v[0]), c);
      qn_num r = a[1], z = MUL(a[0], INT(v[2] < 0 ? -1 : 1));
      if (d[2] > d[1] && d[1] * d[0] * fabs(v[2]) < E * E * rho) { /* a barrel, not full up: z = h rc sin / E needs E rational: take z, */
        double angle = atan2(d[0] * v[2] / E, rho);                /* and a radius inside the surface by what its own root may be off, terms cancelling */
        z = qn_num_from_double(&b->ctx, d[0] * d[2] / E * sin(angle));
        double r2 = d[2] * d[2] - E * E * pow(qn_num_to_double(z) / d[0], 2);
        r = qn_num_from_double(&b->ctx, sqrt(r2) * (1 - 0x1p-48 * d[2] * d[2] / r2));
      }
      x[0] = MUL(c[0], r);
      x[1] = MUL(c[1], r);
      x[2] = z;
      return;
    }
    case QN_HYPERBOLOID2:
      circle_at(b, atan2(v[1], v[0]), c);
      x[0] = MUL(c[0], a[1]);
      x[1] = MUL(c[1], a[1]);
      x[2] = MUL(a[0], INT(v[2] < 0 ? -1 : 1));
      return;
    case QN_CUBE:
      for (int i = 0; i < 3; i++) {
        qn_num lo = qn_num_is_zero(a[3]) ? INT(0) : DIV(a[i], INT(-2));
        x[i] = v[i] > 0 ? ADD(lo, a[i]) : lo;
      }
      return;
    case QN_WEDGE: {
      double p = d[0] * v[0], q = d[2] * v[2];
      int corner = p > q ? p > 0 ? 1 : 0 : q > 0 ? 2 : 0;
      for (int i = 0; i < 3; i++) {
        int up = i == 1 ? v[1] > 0 : i == 0 ? corner == 1 : corner == 2;
        qn_num lo = qn_num_is_zero(a[3]) ? INT(0) : DIV(a[i], INT(-2));
        x[i] = up ? ADD(lo, a[i]) : lo;
      }
      return;
    }
    default: fail();
  }
}

static qn_num height(bench *b, const double v[3], const qn_num x[3]) {
  qn_num sum = INT(0);
  for (int i = 0; i < 3; i++) {
    sum = ADD(sum, MUL(qn_num_from_double(&b->ctx, v[i]), x[i]));
  }
  return sum;
}

static void direction(bench *b, double v[3]) {
  for (int i = 0; i < 3; i++) {
    v[i] = below(b, 5) ? real(b, -1, 1) : below(b, 2) ? 0 : 1;
  }
  if (below(b, 3) == 0) { /* along an axis */
    int k = below(b, 3);
    v[k] = below(b, 2) ? 1 : -0.3;
    v[(k + 1) % 3] = v[(k + 2) % 3] = 0;
  }
}

static const qn_prim prims[] = {QN_SPHERE, QN_ELLIPSOID, QN_CUBE, QN_WEDGE, QN_CYLINDER, QN_PARABOLOID, QN_HYPERBOLOID1, QN_HYPERBOLOID2};
enum { PRIMS = sizeof prims / sizeof *prims };

static void holds_the_solid_and_is_tight(void **state) {
  bench *b = *state;
  for (int p = 0; p < PRIMS; p++) {
    for (int round = 0; round < share_of(400); round++) {
      qn_mark mark = qn_arena_mark(&b->ctx.arena);
      solid s = random_bounded(b, prims[p]);
      double args[6], v[3];
      for (int i = 0; i < 6; i++) {
        args[i] = qn_num_to_double(s.args[i]);
      }
      direction(b, v);
      double bound = qn_prims[s.prim].support(args, 6, NULL, v);
      qn_num exact = qn_num_from_double(&b->ctx, bound), x[3];
      for (int i = 0; i < 12; i++) {
        surface_point(b, s.prim, s.args, x);
        assert_true(CMP(height(b, v, x), exact) <= 0);
      }
      highest(b, &s, v, x);
      assert_true(textbook(b, s.prim, s.args, x) <= 0);
      qn_num top = height(b, v, x);
      assert_true(CMP(top, exact) <= 0);
      double whole = 0; /* the solid's size, which rounding is relative to when terms cancel */
      for (int i = 0; i < 3; i++) {
        whole += fabs(v[i]) * (fabs(qn_num_to_double(x[i])) + args[0]);
      }
      assert_true(bound - qn_num_to_double(top) <= 1e-12 * whole);
      qn_arena_release(&b->ctx.arena, mark);
    }
  }
}

/* Placed by a base and an axis of rational length 5s or 7s: the frame is exact, and so are the points. */
static void placed(void **state) {
  bench *b = *state;
  static const int axes[3][3] = {{3, 4, 0}, {2, 3, 6}, {-6, 2, 3}};
  static const int lengths[3] = {5, 7, 7};
  for (int p = 0; p < PRIMS; p++) {
    if (!qn_prims[prims[p]].round) {
      continue;
    }
    for (int round = 0; round < share_of(300); round++) {
      qn_mark mark = qn_arena_mark(&b->ctx.arena);
      solid s = random_bounded(b, prims[p]);
      int elliptic = s.prim == QN_ELLIPSOID || s.prim == QN_CYLINDER || s.prim == QN_PARABOLOID, which = elliptic ? 0 : below(b, 3);
      const int *w = axes[which];
      qn_num base[3], stretch = size(b), W = INT(lengths[which]);
      double args[6], v[3], place[6];
      for (int i = 0; i < 6; i++) {
        args[i] = qn_num_to_double(s.args[i]);
      }
      for (int i = 0; i < 3; i++) {
        base[i] = ratio(b, 90, 7);
        place[i] = qn_num_to_double(base[i]);
        place[3 + i] = qn_num_to_double(MUL(stretch, INT(w[i])));
      }
      direction(b, v);
      double bound = qn_prims[s.prim].support(args, 6, place, v);
      qn_num exact = qn_num_from_double(&b->ctx, bound), best = INT(-1000000);
      for (int i = 0; i < 13; i++) {
        qn_num x[3], y[3];
        /* columns of the frame: u2 = (-w_y, w_x, 0)/f and u1 = u2 x w; f = |(w_x, w_y)| is rational for the first axis only; round solids may
           turn freely, so for the others any rational frame about w will do: a Householder mirror of z to w */
        double local[3];
        qn_num frame[3][3];
        if (which == 0) {
          static const char *const f[3][3] = {{"0", "0", "-1"}, {"-0.8", "0.6", "0"}, {"0.6", "0.8", "0"}};
          for (int k = 0; k < 9; k++) {
            frame[k / 3][k % 3] = num(b, f[k / 3][k % 3]);
          }
        } else {
          qn_num h[3] = {DIV(INT(w[0]), W), DIV(INT(w[1]), W), SUB(DIV(INT(w[2]), W), INT(1))};
          qn_num hh = ADD(ADD(SQ(h[0]), SQ(h[1])), SQ(h[2]));
          for (int k = 0; k < 9; k++) {
            frame[k / 3][k % 3] = SUB(INT(k / 3 == k % 3), DIV(MUL(INT(2), MUL(h[k / 3], h[k % 3])), hh));
          }
        }
        for (int k = 0; k < 3; k++) {
          local[k] = 0;
          for (int m = 0; m < 3; m++) {
            local[k] += qn_num_to_double(frame[k][m]) * v[m];
          }
        }
        if (s.prim == QN_PARABOLOID) { /* vertex up: the same solid turned about y by half a turn, and shifted */
          local[0] = -local[0];
          local[2] = -local[2];
        }
        if (i == 0) {
          highest(b, &s, local, x);
        } else {
          surface_point(b, s.prim, s.args, x);
        }
        if (s.prim == QN_PARABOLOID) {
          x[0] = SUB(INT(0), x[0]);
          x[2] = SUB(qn_num_is_zero(s.args[3]) ? s.args[0] : INT(0), x[2]);
        }
        for (int m = 0; m < 3; m++) {
          y[m] = base[m];
          for (int k = 0; k < 3; k++) {
            y[m] = ADD(y[m], MUL(frame[k][m], x[k]));
          }
        }
        qn_num top = height(b, v, y);
        assert_true(CMP(top, exact) <= 0);
        best = CMP(top, best) > 0 ? top : best;
      }
      assert_true(bound - qn_num_to_double(best) <= 1e-12 * (40 + 4 * (args[0] + args[1] + args[2] + args[3])));
      qn_arena_release(&b->ctx.arena, mark);
    }
  }
}

/* Prisms: the vertices, to the S2 precision of their sines. */
static void prism(void **state) {
  bench *b = *state;
  for (int round = 0; round < share_of(300); round++) {
    qn_mark mark = qn_arena_mark(&b->ctx.arena);
    int sides = 3 + below(b, 12);
    qn_num args[5] = {INT(sides), size(b), size(b), below(b, 3) ? size(b) : INT(0), INT(below(b, 2))};
    double rounded[5], v[3];
    for (int i = 0; i < 5; i++) {
      rounded[i] = qn_num_to_double(args[i]);
    }
    direction(b, v);
    if (below(b, 3) == 0) { /* straight at the middle of a side: two vertices tie */
      double angle = 2 * acos(-1) * (below(b, sides) + 0.5) / sides;
      v[0] = cos(angle);
      v[1] = sin(angle);
    }
    double bound = qn_prims[QN_PRISM].support(rounded, 5, NULL, v);
    qn_num exact = qn_num_from_double(&b->ctx, bound), best = INT(-1000000);
    solid s = {.prim = QN_PRISM, .n = 5};
    memcpy(s.args, args, sizeof args);
    make(b, &s, NULL);
    for (int k = 0; k < 2 * sides; k++) {
      qn_num angle = DIV(INT(360 * (k / 2)), INT(sides)), r = args[k % 2 ? 3 : 2], lo = qn_num_is_zero(args[4]) ? INT(0) : DIV(args[1], INT(-2));
      qn_num x[3] = {MUL(r, qn_num_cos(&b->ctx, angle)), MUL(r, qn_num_sin(&b->ctx, angle)), k % 2 ? ADD(lo, args[1]) : lo};
      assert_int_equal(side(b, &s, x), 0); /* a vertex lies on its planes and outside none */
      qn_num top = height(b, v, x);
      best = CMP(top, best) > 0 ? top : best;
    }
    assert_true(CMP(best, exact) <= 0);
    assert_true(bound - qn_num_to_double(best) <= 1e-12 * 40);
    qn_arena_release(&b->ctx.arena, mark);
  }
}

static void unbounded(void **state) {
  (void)state;
  double v[3] = {0, 0, 1}, down[3] = {0, 0, -1}, slanted[3] = {0, 1e-9, 1}, plane[4] = {0, 0, 2, 6}, saddle[2] = {1, 1};
  double h = qn_prims[QN_HALFSPACE].support(plane, 4, NULL, v);
  assert_true(h >= 3 && h < 3 * (1 + 1e-14));
  assert_true(qn_prims[QN_HALFSPACE].support(plane, 4, NULL, down) == INFINITY);
  assert_true(qn_prims[QN_HALFSPACE].support(plane, 4, NULL, slanted) == INFINITY);
  assert_true(qn_prims[QN_SADDLE].support(saddle, 2, NULL, v) == INFINITY);
}

/* A box is bounded without any slack where it touches the coordinate planes. */
static void exact_zero(void **state) {
  (void)state;
  double args[4] = {10, 20, 30, 0}, v[3] = {-1, 0, 0}, up[3] = {1, 0, 0};
  assert_true(qn_prims[QN_CUBE].support(args, 4, NULL, v) == 0);
  double h = qn_prims[QN_CUBE].support(args, 4, NULL, up);
  assert_true(h >= 10 && h < 10 * (1 + 1e-15));
}

/* (u, v) lies in [0, 1] on bounded primitives, u below 1, and runs with angle and height. */
static void parameters(void **state) {
  bench *b = *state;
  for (int p = 0; p < PRIMS; p++) {
    for (int round = 0; round < share_of(300); round++) {
      qn_mark mark = qn_arena_mark(&b->ctx.arena);
      solid s = random_bounded(b, prims[p]);
      make(b, &s, NULL);
      double args[6], x[3], uv[2];
      qn_num point[3];
      surface_point(b, s.prim, s.args, point);
      for (int i = 0; i < 6; i++) {
        args[i] = qn_num_to_double(s.args[i]);
      }
      for (int i = 0; i < 3; i++) {
        x[i] = qn_num_to_double(point[i]);
      }
      for (size_t h = 0; h < s.count; h++) {
        qn_prims[s.prim].uv(args, 6, NULL, s.halves[h].role, x, uv);
        assert_true(uv[0] >= 0 && uv[0] <= 1 && uv[1] >= 0 && uv[1] <= 1);
      }
      qn_arena_release(&b->ctx.arena, mark);
    }
  }
  double tube[6] = {4, 1, 1, 1, 1, 0}, uv[2], x[3] = {0, 1, 3}, place[6] = {1, 2, 3, 0, 0, 5}, y[3] = {1, 3, 6}, ball[1] = {2}, pole[3] = {0, 0, 2};
  qn_prims[QN_CYLINDER].uv(tube, 6, NULL, QUOIN_BODY, x, uv);
  assert_true(fabs(uv[0] - 0.25) < 1e-15 && uv[1] == 0.75);
  qn_prims[QN_CYLINDER].uv(tube, 6, place, QUOIN_BODY, y, uv);
  assert_true(fabs(uv[0] - 0.25) < 1e-15 && uv[1] == 0.75);
  qn_prims[QN_SPHERE].uv(ball, 1, NULL, QUOIN_BODY, pole, uv);
  assert_true(fabs(uv[1] - 1) < 1e-15);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(holds_the_solid_and_is_tight, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(placed, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(prism, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(parameters, setup_bench, teardown_bench),
    cmocka_unit_test(unbounded),
    cmocka_unit_test(exact_zero),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
