/* The exact half-spaces of every primitive: known points, the text book's definition at random rational points, placement. */
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

static void roles(const solid *s, size_t count, const uint32_t *expected) {
  assert_int_equal(s->count, count);
  for (size_t i = 0; i < count; i++) {
    assert_int_equal(s->halves[i].role, expected[i]);
  }
}

static void known_points_round(void **state) {
  bench *b = *state;
  solid s = solid_of(b, QN_SPHERE, "7", NULL);
  IN(&s, "0", "0", "0");
  ON(&s, "2", "3", "6");
  ON(&s, "-2", "6", "-3");
  OUT(&s, "2", "3", "6.0000000000000000000000001");
  IN(&s, "2", "3", "5.9999999999999999999999999");

  s = solid_of(b, QN_ELLIPSOID, "1", "2", "3", NULL);
  ON(&s, "1/3", "4/3", "2"); /* 1/9 + 4/9 + 4/9 */
  ON(&s, "0", "0", "-3");
  OUT(&s, "1/3", "4/3", "2.01");
  solid ball = solid_of(b, QN_ELLIPSOID, "0.5", "0.5", "0.5", NULL), rugby = solid_of(b, QN_ELLIPSOID, "3", "3", "5", NULL);
  ON(&ball, "0.3", "0.4", "0");
  ON(&rugby, "0", "9/5", "4");
  rugby = solid_of(b, QN_ELLIPSOID, "5", "3", "3", NULL);
  ON(&rugby, "4", "9/5", "0");
  rugby = solid_of(b, QN_ELLIPSOID, "3", "5", "3", NULL);
  ON(&rugby, "9/5", "4", "0");

  s = solid_of(b, QN_CYLINDER, "2", "5", "5", "5", "5", "0", NULL);
  roles(&s, 3, (const uint32_t[]){QUOIN_BODY, QUOIN_CAP0, QUOIN_CAP1});
  ON(&s, "3", "4", "2"); /* rim */
  ON(&s, "3", "4", "1");
  ON(&s, "0", "0", "0");
  IN(&s, "3", "3.999999", "1");
  OUT(&s, "0", "0", "-1e-30");
  OUT(&s, "3", "4", "2.0000001");
  s = solid_of(b, QN_CYLINDER, "0.2", "5", "10", "5", "10", "1", NULL);
  ON(&s, "3", "8", "0.1");
  ON(&s, "3", "8", "-0.1");
  IN(&s, "3", "7.9", "0.05");

  s = solid_of(b, QN_CYLINDER, "3", "1", "1", "0", "0", "0", NULL); /* cone, apex up */
  ON(&s, "0", "0", "3");
  OUT(&s, "0", "0", "3.0001"); /* the second nappe */
  OUT(&s, "0.1", "0", "4");
  ON(&s, "3/5", "4/5", "0");
  ON(&s, "1/3", "0", "2");
  IN(&s, "0", "0", "2.9999");
  s = solid_of(b, QN_CYLINDER, "3", "0", "0", "1", "2", "1", NULL); /* apex down, elliptic, centred */
  ON(&s, "0", "0", "-1.5");
  OUT(&s, "0", "0", "-1.6");
  ON(&s, "3/5", "8/5", "1.5");
  IN(&s, "0", "0", "-1.4999");
  s = solid_of(b, QN_CYLINDER, "1", "2", "2", "1", "1", "0", NULL); /* frustum */
  ON(&s, "1.5", "0", "0.5");
  ON(&s, "0", "-1", "1");
  OUT(&s, "0", "0", "2"); /* its cone's apex */

  s = solid_of(b, QN_PARABOLOID, "4", "2", "2", "0", NULL);
  roles(&s, 2, (const uint32_t[]){QUOIN_BODY, QUOIN_CAP0});
  ON(&s, "0", "0", "0");
  ON(&s, "6/5", "8/5", "4");
  ON(&s, "1", "0", "1");
  IN(&s, "0", "0", "3.99");
  OUT(&s, "0", "0", "-0.01");
  OUT(&s, "0", "0", "4.01");
  s = solid_of(b, QN_PARABOLOID, "4", "2", "3", "1", NULL);
  ON(&s, "0", "0", "-2");
  ON(&s, "0", "3", "2");
  ON(&s, "1", "0", "-1");

  s = solid_of(b, QN_HYPERBOLOID1, "2", "5", "3", NULL);
  roles(&s, 3, (const uint32_t[]){QUOIN_BODY, QUOIN_CAP0, QUOIN_CAP1});
  ON(&s, "3", "0", "0");
  ON(&s, "3", "4", "2");
  ON(&s, "3", "4", "-2");
  ON(&s, "3", "2", "1"); /* 9 + 16/4 */
  OUT(&s, "3", "2.01", "1");
  OUT(&s, "0", "0", "2.01");
  s = solid_of(b, QN_HYPERBOLOID1, "2", "3", "3", NULL);
  ON(&s, "0", "3", "1.7");
  s = solid_of(b, QN_HYPERBOLOID1, "4", "0", "2", NULL); /* a barrel that closes: an ellipsoid */
  ON(&s, "0", "0", "4");
  ON(&s, "0", "8/5", "12/5");
  s = solid_of(b, QN_HYPERBOLOID1, "2", "1", "0", NULL); /* double cone */
  ON(&s, "0", "0", "0");
  IN(&s, "0", "0.4", "-1");

  s = solid_of(b, QN_HYPERBOLOID2, "5", "4", "3", NULL); /* x^2 + y^2 = z^2 - 9 */
  roles(&s, 3, (const uint32_t[]){QUOIN_BODY, QUOIN_CAP0, QUOIN_CAP1});
  ON(&s, "0", "0", "3");
  ON(&s, "0", "0", "-3");
  OUT(&s, "0", "0", "2.99");
  OUT(&s, "0", "0", "0");
  ON(&s, "4", "0", "5");
  ON(&s, "0", "-4", "-5");
  IN(&s, "0", "0", "4");
}

static void known_points_planes(void **state) {
  bench *b = *state;
  solid s = solid_of(b, QN_CUBE, "1", "0.2", "3", "0", NULL);
  roles(&s, 6, (const uint32_t[]){QUOIN_FACE, QUOIN_FACE + 1, QUOIN_FACE + 2, QUOIN_FACE + 3, QUOIN_FACE + 4, QUOIN_FACE + 5});
  for (int k = 0; k < 6; k++) { /* face k lies where its name says */
    qn_num x[3] = {num(b, "0.5"), num(b, "0.1"), num(b, "1.5")};
    x[k / 2] = k % 2 ? s.args[k / 2] : INT(0);
    assert_int_equal(qn_num_sign(form_at(b, s.halves + k, x)), 0);
    assert_int_equal(side(b, &s, x), 0);
  }
  IN(&s, "0.5", "0.1", "1.5");
  ON(&s, "1", "0.2", "3");
  OUT(&s, "1", "0.2000000000000000000001", "3");
  s = solid_of(b, QN_CUBE, "1", "1", "1", "1", NULL);
  ON(&s, "0.5", "-0.5", "0.5");
  IN(&s, "0", "0", "0");

  s = solid_of(b, QN_WEDGE, "2", "1", "4", "0", NULL);
  roles(&s, 5, (const uint32_t[]){QUOIN_FACE, QUOIN_FACE + 1, QUOIN_FACE + 2, QUOIN_FACE + 3, QUOIN_FACE + 4});
  ON(&s, "2", "0", "0");
  ON(&s, "0", "1", "4");
  ON(&s, "1", "0.5", "2");
  IN(&s, "0.99", "0.5", "2");
  OUT(&s, "1.01", "0.5", "2");
  s = solid_of(b, QN_WEDGE, "2", "1", "4", "1", NULL);
  ON(&s, "0", "0", "0");
  ON(&s, "-1", "-0.5", "2");
  IN(&s, "-0.01", "0", "0");

  s = solid_of(b, QN_HALFSPACE, "1", "2", "2", "3", NULL);
  ON(&s, "1", "1", "0");
  IN(&s, "0", "0", "0");
  OUT(&s, "1", "1", "0.0000000001");
  assert_int_equal(solid_of(b, QN_HALFSPACE, "0", "0", "0", "1", NULL).result, QN_FORM_ALL);
  assert_int_equal(solid_of(b, QN_HALFSPACE, "0", "0", "0", "0", NULL).result, QN_FORM_ALL);
  assert_int_equal(solid_of(b, QN_HALFSPACE, "0", "0", "0", "-1", NULL).result, QN_FORM_EMPTY);

  s = solid_of(b, QN_SADDLE, "2", "1", NULL);
  ON(&s, "2", "0", "1");
  ON(&s, "0", "1", "-1");
  IN(&s, "0", "0", "-0.1");
  OUT(&s, "0", "0", "0.1");

  s = solid_of(b, QN_PRISM, "4", "2", "1", "1", "0", NULL);
  assert_int_equal(s.count, 6);
  ON(&s, "1", "0", "1");
  ON(&s, "0.5", "0.5", "1"); /* rational: x + y <= 1 */
  ON(&s, "-0.25", "0.75", "2");
  OUT(&s, "0.5", "0.50000000000000000000000000000001", "1");
  s = solid_of(b, QN_PRISM, "3", "2", "1", "1", "1", NULL);
  ON(&s, "-0.5", "0.1", "0"); /* the side across vertex 0 */
  ON(&s, "1", "0", "1");
  s = solid_of(b, QN_PRISM, "6", "2", "1", "0", "0", NULL); /* a pyramid: no cap at the apex */
  assert_int_equal(s.count, 7);
  ON(&s, "0", "0", "2");
  OUT(&s, "0", "0", "2.1");
  ON(&s, "0.5", "0", "1");
  IN(&s, "0.49", "0", "1");

  s = solid_of(b, QN_POLYHEDRON, "4", "0", "-1", "0", "0", "0", "0", "-1", "0", "0", NULL); /* too few numbers */
  assert_int_equal(s.result, QN_FORM_EMPTY);
}

static void polyhedron_points(void **state) {
  bench *b = *state;
  static const char *text[] = {"4", "4", "-1", "0", "0", "0", "0", "-1", "0", "0", "0", "0", "-1", "0", "1",
                               "1", "1", "1", "0", "0", "0", "1", "0", "0", "0", "1", "0", "0", "0", "1"};
  enum { N = sizeof text / sizeof *text };
  qn_num args[N];
  double rounded[N];
  for (int i = 0; i < N; i++) {
    args[i] = num(b, text[i]);
    rounded[i] = qn_num_to_double(args[i]);
  }
  solid s = {.prim = QN_POLYHEDRON};
  s.result = qn_prims[QN_POLYHEDRON].form(&b->ctx, args, N, NULL, &s.halves, &s.count);
  roles(&s, 4, (const uint32_t[]){QUOIN_FACE, QUOIN_FACE + 1, QUOIN_FACE + 2, QUOIN_FACE + 3});
  ON(&s, "1/3", "1/3", "1/3");
  ON(&s, "0", "0", "1");
  IN(&s, "0.1", "0.1", "0.1");
  OUT(&s, "1/3", "1/3", "0.3334");
  double v[3] = {-1, 2, -3}, h = qn_prims[QN_POLYHEDRON].support(rounded, N, NULL, v);
  assert_true(h >= 2 && h <= 2 + 1e-14);
}

/* Sizes that are no sizes give an empty solid. */
static void degenerate(void **state) {
  bench *b = *state;
  assert_int_equal(solid_of(b, QN_SPHERE, "0", NULL).result, QN_FORM_EMPTY);
  assert_int_equal(solid_of(b, QN_SPHERE, "-1", NULL).result, QN_FORM_EMPTY);
  assert_int_equal(solid_of(b, QN_ELLIPSOID, "1", "0", "1", NULL).result, QN_FORM_EMPTY);
  assert_int_equal(solid_of(b, QN_CUBE, "1", "1", "-1", "0", NULL).result, QN_FORM_EMPTY);
  assert_int_equal(solid_of(b, QN_CYLINDER, "0", "1", "1", "1", "1", "0", NULL).result, QN_FORM_EMPTY);
  assert_int_equal(solid_of(b, QN_CYLINDER, "1", "0", "0", "0", "0", "0", NULL).result, QN_FORM_EMPTY);
  assert_int_equal(solid_of(b, QN_CYLINDER, "1", "-1", "-1", "2", "2", "0", NULL).result, QN_FORM_EMPTY);
  assert_int_equal(solid_of(b, QN_PRISM, "2", "1", "1", "1", "0", NULL).result, QN_FORM_EMPTY);
  assert_int_equal(solid_of(b, QN_PRISM, "5", "1", "0", "0", "0", NULL).result, QN_FORM_EMPTY);
  assert_int_equal(solid_of(b, QN_PARABOLOID, "1", "0", "1", "0", NULL).result, QN_FORM_EMPTY);
  assert_int_equal(solid_of(b, QN_HYPERBOLOID1, "1", "0", "0", NULL).result, QN_FORM_EMPTY);
  assert_int_equal(solid_of(b, QN_HYPERBOLOID2, "1", "1", "1", NULL).result, QN_FORM_EMPTY);
  assert_int_equal(solid_of(b, QN_WEDGE, "1", "1", "0", "0", NULL).result, QN_FORM_EMPTY);
  assert_int_equal(solid_of(b, QN_SADDLE, "0", "1", NULL).result, QN_FORM_EMPTY);
  assert_int_equal(solid_of(b, QN_SUPERQUADRIC, "1", "1", "0", "1", "1", NULL).result, QN_FORM_EMPTY);
  qn_placement p = {{INT(0), INT(0), INT(0)}, {INT(0), INT(0), INT(0)}};
  for (qn_prim prim = QN_ELLIPSOID; prim <= QN_HYPERBOLOID2; prim++) {
    solid s = {.prim = prim, .args = {INT(3), INT(3), INT(1), INT(1), INT(1), INT(0)}};
    if (prim != QN_CUBE) {
      make(b, &s, &p);
      assert_int_equal(s.result, QN_FORM_EMPTY); /* no axis */
    }
  }
}

/* Random arguments, every kind of each primitive met often. */
static solid random_solid(bench *b, qn_prim prim) {
  solid s = {.prim = prim};
  for (int i = 0; i < 10; i++) {
    s.args[i] = size(b);
  }
  switch (prim) {
    case QN_ELLIPSOID:
      if (below(b, 2)) {
        s.args[below(b, 3)] = s.args[below(b, 3)];
      }
      break;
    case QN_CUBE:
    case QN_WEDGE:
    case QN_PARABOLOID:
      s.args[3] = INT(below(b, 2));
      s.args[2] = prim == QN_PARABOLOID && below(b, 2) ? s.args[1] : s.args[2];
      break;
    case QN_CYLINDER: {
      s.args[2] = below(b, 2) ? s.args[1] : s.args[2];
      int kind = below(b, 4); /* straight, an apex above, an apex below, a frustum */
      qn_num f = kind == 0 ? INT(1) : kind == 1 ? INT(0) : ratio(b, 9, 4);
      f = qn_num_abs(&b->ctx, f);
      s.args[3] = MUL(f, s.args[1]);
      s.args[4] = MUL(f, s.args[2]);
      if (kind == 2) {
        s.args[3] = s.args[1];
        s.args[4] = s.args[2];
        s.args[1] = s.args[2] = INT(0);
      }
      s.args[5] = INT(below(b, 2));
      break;
    }
    case QN_HYPERBOLOID1: s.args[2] = below(b, 8) ? s.args[2] : below(b, 2) ? INT(0) : s.args[1]; break;
    case QN_HYPERBOLOID2: s.args[2] = MUL(s.args[0], DIV(INT(below(b, 10)), INT(10))); break;
    case QN_HALFSPACE:
      for (int i = 0; i < 4; i++) {
        s.args[i] = ratio(b, 20, 7);
      }
      break;
    case QN_QUADRIC:
      for (int i = 0; i < 10; i++) {
        s.args[i] = below(b, 3) ? ratio(b, 6, 1 + below(b, 3)) : INT(0);
      }
      break;
    default: break;
  }
  return s;
}

static const qn_prim textbook_prims[] = {QN_SPHERE, QN_ELLIPSOID, QN_CUBE, QN_WEDGE, QN_CYLINDER, QN_PARABOLOID, QN_HYPERBOLOID1,
                                         QN_HYPERBOLOID2, QN_SADDLE, QN_HALFSPACE, QN_QUADRIC};
enum { TEXTBOOK_PRIMS = sizeof textbook_prims / sizeof *textbook_prims };

static void random_points_agree_with_the_textbook(void **state) {
  bench *b = *state;
  for (int p = 0; p < TEXTBOOK_PRIMS; p++) {
    int census[3] = {0, 0, 0};
    for (int round = 0; round < 60; round++) {
      qn_mark mark = qn_arena_mark(&b->ctx.arena);
      solid s = random_solid(b, textbook_prims[p]);
      qn_num on[3] = {ratio(b, 9, 4), ratio(b, 9, 5), ratio(b, 9, 7)};
      if (s.prim == QN_QUADRIC) { /* through a known point */
        s.args[9] = INT(0);
        s.args[9] = SUB(INT(0), quadric_at(b, s.args, on));
      }
      make(b, &s, NULL);
      for (int i = 0; i < 40; i++) {
        qn_num x[3];
        for (int k = 0; k < 3; k++) { /* some on the solid's own measures */
          x[k] = below(b, 3) ? ratio(b, 60, 1 + below(b, 12)) : below(b, 2) ? INT(0) : MUL(s.args[below(b, 4)], DIV(ratio(b, 2, 1), INT(2)));
        }
        if (i < 10 && s.prim == QN_QUADRIC) {
          memcpy(x, on, sizeof x);
          x[0] = i ? ADD(x[0], ratio(b, 1, 1 << 20)) : x[0];
        } else if (i < 20 && surface_point(b, s.prim, s.args, x) && i >= 10) { /* on it, then just off it */
          qn_num f = DIV(INT(i % 2 ? 63 : 65), INT(64));
          for (int k = 0; k < 3; k++) {
            x[k] = MUL(x[k], f);
          }
        }
        int expected = textbook(b, s.prim, s.args, x);
        if (s.result == QN_FORM_OK) {
          assert_int_equal(side(b, &s, x), expected);
        } else if (expected) { /* quadrics without a body: the text book may say "on" where no interior is near */
          assert_int_equal(side(b, &s, x), expected);
        }
        census[expected + 1]++;
      }
      qn_arena_release(&b->ctx.arena, mark);
    }
    assert_true(census[0] > 100 && census[1] > 20 && census[2] > 100);
  }
}

/* --- placement ---------------------------------------------------------------------------------------------------------- */

/* The axis w = (3, 4, 0) s of length 5 s, and its frame as rotate([0, acos(w_z/|w|), atan2(w_y, w_x)]): x -> (0, 0, -1), y -> (-4/5, 3/5, 0). */
static void to_world(bench *b, const qn_num local[3], const qn_num base[3], int axis, qn_num out[3]) {
  static const int frames[4][3][3] = {
    {{0, 0, -5}, {-4, 3, 0}, {3, 4, 0}},  /* images of x, y, z, in fifths */
    {{-5, 0, 0}, {0, 5, 0}, {0, 0, -5}},  /* axis -z */
    {{0, 0, -5}, {-5, 0, 0}, {0, 5, 0}},  /* axis +y */
    {{4, 0, -3}, {0, 5, 0}, {3, 0, 4}},   /* axis (3, 0, 4) */
  };
  for (int i = 0; i < 3; i++) {
    qn_num sum = INT(0);
    for (int k = 0; k < 3; k++) {
      sum = ADD(sum, MUL(local[k], INT(frames[axis][k][i])));
    }
    out[i] = ADD(base[i], DIV(sum, INT(5)));
  }
}

static void placed_is_the_turned_unplaced(void **state) {
  bench *b = *state;
  static const int axes[4][3] = {{3, 4, 0}, {0, 0, -1}, {0, 1, 0}, {3, 0, 4}};
  static const qn_prim prims[] = {QN_SPHERE, QN_ELLIPSOID, QN_CYLINDER, QN_PRISM, QN_PARABOLOID, QN_HYPERBOLOID1, QN_HYPERBOLOID2};
  for (size_t p = 0; p < sizeof prims / sizeof *prims; p++) {
    for (int round = 0; round < 40; round++) {
      qn_mark mark = qn_arena_mark(&b->ctx.arena);
      solid s = random_solid(b, prims[p]), t;
      if (prims[p] == QN_PRISM) {
        s.args[0] = INT(3 + below(b, 5));
        s.args[3] = below(b, 2) ? s.args[2] : below(b, 2) ? INT(0) : s.args[3];
        s.args[4] = INT(below(b, 2));
      }
      t = s;
      make(b, &s, NULL);
      int axis = round % 4;
      qn_placement place;
      qn_num stretch = size(b);
      for (int i = 0; i < 3; i++) {
        place.base[i] = ratio(b, 30, 7);
        place.axis[i] = MUL(stretch, INT(axes[axis][i]));
      }
      make(b, &t, &place);
      assert_int_equal(s.count, t.count);
      for (int i = 0; i < 30; i++) {
        qn_num x[3], y[3], world[3];
        for (int k = 0; k < 3; k++) {
          x[k] = below(b, 3) ? ratio(b, 60, 1 + below(b, 12)) : below(b, 2) ? INT(0) : s.args[below(b, 3)];
        }
        memcpy(y, x, sizeof y);
        if (prims[p] == QN_PARABOLOID) { /* the base is the cap's centre, the axis points to the vertex: half a turn about y and a shift */
          y[0] = SUB(INT(0), x[0]);
          y[2] = SUB(qn_num_is_zero(s.args[3]) ? s.args[0] : INT(0), x[2]);
        }
        to_world(b, y, place.base, axis, world);
        for (size_t h = 0; h < s.count; h++) {
          assert_int_equal(s.halves[h].role, t.halves[h].role);
          assert_int_equal(qn_num_sign(form_at(b, s.halves + h, x)), qn_num_sign(form_at(b, t.halves + h, world)));
          if (prims[p] != QN_PRISM) { /* |w| is rational: nothing was rounded */
            for (int k = 0; k < 12; k++) {
              assert_false(qn_num_is_rounded(t.halves[h].row[k / 4][k % 4]));
            }
          }
        }
      }
      qn_arena_release(&b->ctx.arena, mark);
    }
  }
}

/* A slanted axis of irrational length: bodies stay rational where |w| does not enter, and points on the axis and rims are on. */
static void irrational_axis(void **state) {
  bench *b = *state;
  qn_placement place = {{INT(1), INT(2), INT(3)}, {INT(1), INT(1), INT(0)}};
  solid s = {.prim = QN_CYLINDER, .args = {INT(2), INT(1), INT(1), INT(1), INT(1), INT(0)}};
  make(b, &s, &place);
  for (int k = 0; k < 12; k++) {
    assert_false(qn_num_is_rounded(s.halves[0].row[k / 4][k % 4]));
  }
  ON(&s, "1", "2", "4");  /* on the bottom's rim */
  ON(&s, "2", "3", "4");
  IN(&s, "2", "3", "3.5");
  qn_num root = qn_num_sqrt(&b->ctx, INT(2)), top[3] = {ADD(INT(1), root), ADD(INT(2), root), INT(3)}; /* base + 2 w/|w| */
  assert_int_equal(side(b, &s, top), 0);
  solid cone = {.prim = QN_CYLINDER, .args = {INT(2), INT(1), INT(1), INT(0), INT(0), INT(0)}};
  make(b, &cone, &place);
  assert_int_equal(side(b, &cone, top), 0); /* the apex */
  ON(&cone, "1", "2", "2");
  solid bowl = {.prim = QN_PARABOLOID, .args = {INT(2), INT(1), INT(1), INT(0)}};
  make(b, &bowl, &place);
  assert_int_equal(side(b, &bowl, top), 0); /* the vertex */
  ON(&bowl, "1", "2", "4");
  solid waist = {.prim = QN_HYPERBOLOID1, .args = {INT(2), INT(3), INT(1)}};
  make(b, &waist, &place);
  ON(&waist, "1", "2", "4");
  assert_false(qn_num_is_rounded(waist.halves[0].row[2][3]));
}

/* Memory refused at any moment: a status in the context, no crash, nothing lost. */
static void *refusing_alloc(void *user, size_t bytes) {
  size_t *left = user;
  return *left > 0 ? (--*left, malloc(bytes)) : NULL;
}
static void *refusing_resize(void *user, void *block, size_t old_bytes, size_t bytes) {
  (void)user, (void)block, (void)old_bytes, (void)bytes;
  return NULL;
}
static void refusing_release(void *user, void *block, size_t bytes) {
  (void)user, (void)bytes;
  free(block);
}
static void refused_memory(void **state) {
  (void)state;
  static const char *const args[] = {"5", "1.234567890123456789123", "0.7", "0.35", "1/3", "1", "0.3", "2/7", "1/11", "-1"};
  int refused = 0, made = 0;
  for (qn_prim prim = 0; prim < QN_POLYHEDRON; prim++) {
    for (size_t allow = 1; allow < 6; allow++) {
      size_t left = 100;
      quoin_allocator allocator = {refusing_alloc, refusing_resize, refusing_release, &left, 0};
      bench local, *b = &local;
      qn_mem_init(&b->mem, &allocator);
      qn_ctx_init(&b->ctx, &b->mem);
      solid s = {.prim = prim, .n = 10};
      for (int i = 0; i < 10; i++) {
        s.args[i] = num(b, args[prim == QN_PRISM && i == 2 ? 1 : i]);
      }
      qn_placement place = {{s.args[1], s.args[2], s.args[3]}, {s.args[1], s.args[4], s.args[2]}};
      left = allow - 1;
      s.result = qn_prims[prim].form(&b->ctx, s.args, s.n, qn_prims[prim].round ? &place : NULL, &s.halves, &s.count);
      refused += b->ctx.failed == QUOIN_E_MEMORY;
      made += b->ctx.failed == QUOIN_OK && s.result == QN_FORM_OK;
      qn_ctx_free(&b->ctx);
      assert_int_equal(b->mem.used, 0);
    }
  }
  assert_true(refused > 5 && made > 20);
}

/* The table itself. */
static void table(void **state) {
  (void)state;
  for (int p = 0; p < QN_PRIM_COUNT; p++) {
    assert_non_null(qn_prims[p].word);
    assert_non_null(qn_prims[p].form);
    assert_non_null(qn_prims[p].support);
    assert_non_null(qn_prims[p].uv);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(table),
    cmocka_unit_test(refused_memory),
    cmocka_unit_test_setup_teardown(known_points_round, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(known_points_planes, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(polyhedron_points, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(degenerate, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(random_points_agree_with_the_textbook, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(placed_is_the_turned_unplaced, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(irrational_axis, setup_bench, teardown_bench),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
