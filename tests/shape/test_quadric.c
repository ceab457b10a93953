/* The reduction of general quadrics: the diagonal form expands to the same ten coefficients, exactly, at every rank; what has no
   interior and what is all of space is said; the support of an ellipsoid holds it. */
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

/* The ten coefficients of a form. */
static void expand(bench *b, const qn_half_form *h, qn_num q[10]) {
  static const int pair[10][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}, {3, 3}};
  for (int c = 0; c < 10; c++) {
    int i = pair[c][0], k = pair[c][1];
    q[c] = INT(0);
    if (h->kind == QN_PLANE) {
      q[c] = c >= 6 ? h->row[0][i] : q[c];
      continue;
    }
    for (int r = 0; r < 3; r++) {
      qn_num term = MUL(h->s[r], MUL(h->row[r][i], h->row[r][k]));
      q[c] = ADD(q[c], i == k ? term : MUL(INT(2), term));
    }
    if (k == 3) { /* 2 l X2 */
      q[c] = ADD(q[c], MUL(MUL(INT(2), h->l), h->row[2][i]));
    }
  }
  q[9] = h->kind == QN_PLANE ? h->row[0][3] : ADD(q[9], h->k);
}

static void check_expansion(bench *b, const qn_num q[10], qn_half_form *h, qn_form_result *result) {
  *result = qn_quadric_diagonal(&b->ctx, q, h);
  qn_num back[10];
  expand(b, h, back);
  for (int i = 0; i < 10; i++) {
    assert_true(qn_num_equal(back[i], q[i]));
  }
  if (!qn_num_is_zero(h->l)) { /* row 2 is free for the linear part */
    assert_true(qn_num_is_zero(h->s[2]));
  }
}

/* sum of `rank` random squares s (row . (x, y, z, 1))^2, with a linear part or a constant besides. */
static void random_quadric(bench *b, int rank, int linear, qn_num q[10]) {
  qn_half_form h = {.kind = QN_QUADRIC_BODY};
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 4; k++) {
      h.row[i][k] = below(b, 4) ? ratio(b, 9, 1 + below(b, 4)) : INT(0);
    }
    h.s[i] = i < rank ? ratio(b, 5, 1 + below(b, 3)) : INT(0);
  }
  h.l = linear && rank < 3 ? ratio(b, 4, 3) : INT(0);
  h.k = below(b, 2) ? ratio(b, 9, 2) : INT(0);
  expand(b, &h, q);
}

static void expands_back(void **state) {
  bench *b = *state;
  int census[4][2] = {{0}};
  for (int round = 0; round < 4000; round++) {
    qn_mark mark = qn_arena_mark(&b->ctx.arena);
    qn_num q[10];
    int rank = round % 4;
    random_quadric(b, rank, below(b, 2), q);
    if (below(b, 6) == 0) { /* mixed terms only: no square to begin with */
      q[0] = q[1] = q[2] = INT(0);
    }
    if (below(b, 8) == 0) { /* tiny squares beside large mixed terms */
      q[0] = MUL(q[0], num(b, "1e-30"));
      q[1] = MUL(q[1], num(b, "1e-30"));
    }
    if (below(b, 8) == 0) { /* x and y only */
      q[2] = q[4] = q[5] = q[8] = INT(0);
    }
    qn_half_form h;
    qn_form_result result;
    check_expansion(b, q, &h, &result);
    int squares = 0;
    for (int i = 0; i < 3; i++) {
      squares += !qn_num_is_zero(h.s[i]);
    }
    census[squares][h.kind == QN_PLANE || !qn_num_is_zero(h.l)]++;
    /* sign and result agree with the polynomial at random points */
    for (int i = 0; i < 4; i++) {
      qn_num x[3] = {ratio(b, 9, 2), ratio(b, 9, 4), ratio(b, 9, 5)};
      int sign = textbook(b, QN_QUADRIC, q, x);
      assert_int_equal(qn_num_sign(form_at(b, &h, x)), sign);
      assert_true(result != QN_FORM_ALL || sign <= 0);
      assert_true(result != QN_FORM_EMPTY || sign >= 0);
    }
    qn_arena_release(&b->ctx.arena, mark);
  }
  for (int rank = 0; rank < 4; rank++) {
    assert_true(census[rank][0] > 30);
    assert_true(rank == 3 || census[rank][1] > 30);
  }
  assert_int_equal(census[3][1], 0);
}

static qn_form_result result_of(bench *b, const char *const text[10]) {
  qn_num q[10];
  for (int i = 0; i < 10; i++) {
    q[i] = num(b, text[i]);
  }
  qn_half_form h;
  qn_form_result result;
  check_expansion(b, q, &h, &result);
  return result;
}

static void empty_and_all(void **state) {
  bench *b = *state;
  static const struct { const char *q[10]; qn_form_result result; } cases[] = {
    {{"0", "0", "0", "0", "0", "0", "0", "0", "0", "0"}, QN_FORM_ALL},
    {{"0", "0", "0", "0", "0", "0", "0", "0", "0", "-1"}, QN_FORM_ALL},
    {{"0", "0", "0", "0", "0", "0", "0", "0", "0", "1"}, QN_FORM_EMPTY},
    {{"1", "1", "1", "0", "0", "0", "0", "0", "0", "1"}, QN_FORM_EMPTY},   /* x2 + y2 + z2 + 1 <= 0 */
    {{"1", "1", "1", "0", "0", "0", "0", "0", "0", "0"}, QN_FORM_EMPTY},   /* a point */
    {{"1", "1", "1", "0", "0", "0", "-2", "-4", "-6", "14"}, QN_FORM_EMPTY}, /* a point elsewhere */
    {{"1", "1", "1", "0", "0", "0", "-2", "-4", "-6", "13.99"}, QN_FORM_OK},
    {{"-1", "-1", "-1", "0", "0", "0", "0", "0", "0", "0"}, QN_FORM_ALL},
    {{"-1", "-1", "-1", "0", "0", "0", "0", "0", "0", "-1"}, QN_FORM_ALL},
    {{"-1", "-1", "-1", "0", "0", "0", "0", "0", "0", "1"}, QN_FORM_OK},   /* outside a ball */
    {{"1", "0", "0", "0", "0", "0", "0", "0", "0", "0"}, QN_FORM_EMPTY},   /* a plane */
    {{"1", "0", "0", "0", "0", "0", "0", "0", "0", "-1"}, QN_FORM_OK},     /* a slab */
    {{"1", "1", "0", "2", "0", "0", "0", "0", "0", "0"}, QN_FORM_EMPTY},   /* (x + y)2 */
    {{"1", "1", "0", "2", "0", "0", "1", "0", "0", "0"}, QN_FORM_OK},      /* (x + y)2 + x: a parabolic cylinder */
    {{"0", "0", "0", "1", "0", "0", "0", "0", "0", "0"}, QN_FORM_OK},      /* xy <= 0 */
    {{"0", "0", "0", "1", "1", "1", "0", "0", "0", "-1"}, QN_FORM_OK},
    {{"0", "0", "0", "0", "0", "0", "0", "0", "2", "-3"}, QN_FORM_OK},     /* a plane, as a form */
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    assert_int_equal(result_of(b, cases[i].q), cases[i].result);
  }
}

/* A small pivot is not taken where a mixed term is large: no coefficient of the form grows beyond the quadric's own by more than a few. */
static void pivots_are_tame(void **state) {
  bench *b = *state;
  static const char *const text[10] = {"1e-20", "0", "0", "2", "0", "0", "0", "0", "0", "-1"};
  qn_num q[10];
  for (int i = 0; i < 10; i++) {
    q[i] = num(b, text[i]);
  }
  qn_half_form h;
  qn_form_result result;
  check_expansion(b, q, &h, &result);
  for (int i = 0; i < 3; i++) {
    assert_true(fabs(qn_num_to_double(h.s[i])) < 10);
    for (int k = 0; k < 4; k++) {
      assert_true(fabs(qn_num_to_double(h.row[i][k])) < 10);
    }
  }
}

/* Ellipsoids given as general quadrics, by a rational linear map of the unit sphere: points on them, the support, its tightness. */
static void support_of_an_ellipsoid(void **state) {
  bench *b = *state;
  for (int round = 0; round < 300; round++) {
    qn_mark mark = qn_arena_mark(&b->ctx.arena);
    /* x = c + L y, |y| <= 1, L unit lower triangular times a diagonal; y = L^-1 (x - c) row by row */
    qn_num size[3], l10 = ratio(b, 8, 5), l20 = ratio(b, 8, 5), l21 = ratio(b, 8, 5), c[3];
    qn_half_form h = {.kind = QN_QUADRIC_BODY, .k = INT(-1)};
    for (int i = 0; i < 3; i++) {
      size[i] = DIV(INT(1 + below(b, 30)), INT(10));
      c[i] = ratio(b, 50, 7);
    }
    qn_num rows[3][3] = {{INT(1), INT(0), INT(0)}, {SUB(INT(0), l10), INT(1), INT(0)}, {SUB(MUL(l10, l21), l20), SUB(INT(0), l21), INT(1)}};
    for (int i = 0; i < 3; i++) {
      h.s[i] = INT(1);
      h.row[i][3] = INT(0);
      for (int k = 0; k < 3; k++) {
        h.row[i][k] = DIV(rows[i][k], size[i]);
        h.row[i][3] = SUB(h.row[i][3], MUL(h.row[i][k], c[k]));
      }
    }
    qn_num q[10];
    expand(b, &h, q);
    double rounded[10];
    for (int i = 0; i < 10; i++) {
      rounded[i] = qn_num_to_double(q[i]);
    }
    double v[3] = {real(b, -1, 1), real(b, -1, 1), real(b, -1, 1)};
    double bound = qn_prims[QN_QUADRIC].support(rounded, 10, NULL, v);
    assert_true(isfinite(bound));
    /* y nearest to L'v / |L'v| with rational coordinates: the highest point, to second order */
    double s[3], w[3];
    for (int i = 0; i < 3; i++) {
      s[i] = qn_num_to_double(size[i]);
    }
    w[0] = s[0] * (v[0] + qn_num_to_double(l10) * v[1] + qn_num_to_double(l20) * v[2]);
    w[1] = s[1] * (v[1] + qn_num_to_double(l21) * v[2]);
    w[2] = s[2] * v[2];
    for (int i = 0; i < 10; i++) {
      qn_num lon[2], lat[2];
      circle_at(b, atan2(w[1], w[0]) + (i ? real(b, -1, 1) : 0), lon);
      circle_at(b, atan2(w[2], hypot(w[0], w[1])) + (i ? real(b, -1, 1) : 0), lat);
      qn_num y[3] = {MUL(size[0], MUL(lon[0], lat[0])), MUL(size[1], MUL(lon[1], lat[0])), MUL(size[2], lat[1])};
      qn_num x[3] = {ADD(c[0], y[0]), ADD(c[1], ADD(MUL(l10, y[0]), y[1])), ADD(c[2], ADD(ADD(MUL(l20, y[0]), MUL(l21, y[1])), y[2]))};
      assert_int_equal(textbook(b, QN_QUADRIC, q, x), 0);
      qn_num reach = INT(0);
      for (int k = 0; k < 3; k++) {
        reach = ADD(reach, MUL(x[k], qn_num_from_double(&b->ctx, v[k])));
      }
      assert_true(CMP(reach, qn_num_from_double(&b->ctx, bound)) <= 0);
      if (i == 0) { /* loses what a centre away from the origin costs: coefficients up to 1e5 times the radius squared */
        assert_true(bound - qn_num_to_double(reach) < 1e-7);
      }
    }
    qn_arena_release(&b->ctx.arena, mark);
  }
  double ball[10] = {1, 1, 1, 0, 0, 0, 0, 0, 0, -4}, open[10] = {1, 1, 0, 0, 0, 0, 0, 0, 0, -4}, saddle[10] = {1, 1, -1e-9, 0, 0, 0, 0, 0, 0, -4};
  double outside[10] = {-1, -1, -1, 0, 0, 0, 0, 0, 0, 4}, v[3] = {0, 0.6, 0.8};
  double reach = qn_prims[QN_QUADRIC].support(ball, 10, NULL, v);
  assert_true(reach >= 2 && reach < 2 * (1 + 1e-13));
  assert_true(qn_prims[QN_QUADRIC].support(open, 10, NULL, v) == INFINITY);
  assert_true(qn_prims[QN_QUADRIC].support(saddle, 10, NULL, v) == INFINITY);
  assert_true(qn_prims[QN_QUADRIC].support(outside, 10, NULL, v) == INFINITY);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(expands_back, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(empty_and_all, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(pivots_are_tame, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(support_of_an_ellipsoid, setup_bench, teardown_bench),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
