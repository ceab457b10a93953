/* Every surface that the filter solves, against its exact form: number of roots, sign, and enclosures; on compiled scenes, whose
   shadows are the real ones, and on lines near and far, tangent, parallel, tiny and huge. */
#include "rays.h"

static uint64_t seed = 0x853c49e6748fea9bu;
static uint64_t next(void) {
  seed ^= seed << 13;
  seed ^= seed >> 7;
  seed ^= seed << 17;
  return seed;
}
static double uniform(void) { return (double)(next() >> 11) * 0x1p-52 - 1; }
static int one_in(unsigned n) { return next() % n == 0; }

#define ALL_SHAPES                                                                                                                                                    \
  "sphere(1.3); cube([0.3, 1.7, 0.1]); cylinder(h = 2.1, r = 0.7); cylinder(h = 1.9, r1 = 1.1, r2 = 0.2); ellipsoid(r = [0.7, 1.1, 1.9]); paraboloid(h = 1.2, r = 0.9);" \
  "hyperboloid(h = 1.1, r = 1.3, rc = 0.4); hyperboloid(h = 1.4, r = 1.2, gap = 0.3); wedge(size = [1.1, 0.7, 0.9]); cone(h = 1.5, r = 0.6);"                         \
  "intersection() { saddle(a = 1.1, b = 0.9); cube(3, center = true); } quadric([1, 2, 3, 0.1, -0.2, 0.3, 0.4, 0.5, -0.6, -2]); halfspace(n = [1, 2, 3], d = 0.7);"

static const char *const models[] = {
  ALL_SHAPES,
  "translate([0.1, -7.3, 100.7]) rotate([10, 20, 30]) { " ALL_SHAPES " }",
  "translate([12345.678, 0.1, -99999.9]) rotate([0, 0, 45]) { " ALL_SHAPES " }",
  "scale(0.001) multmatrix([[1, 0.5, 0, 0.1], [0, 1, 0.25, 0.2], [0.125, 0, 1, 0.3], [0, 0, 0, 1]]) { " ALL_SHAPES " }",
  /* entries that are all but zero, as exporters write them */
  "multmatrix([[1, 2.2e-16, 0, 0], [-4.9e-32, 6e-17, -1, 1e-30], [0, 1, 3e-40, 0], [0, 0, 0, 1]]) { " ALL_SHAPES " }",
  "scale(1e-12) { " ALL_SHAPES " }",
  "scale(1e15) { " ALL_SHAPES " }",
  "scale(1e30) { " ALL_SHAPES " }", /* out of the filter's range */
};

typedef struct census { unsigned solved, none, one, two, touching, zero, exact, memo; } census;

/* |root - t| <= e, exactly. */
static void check_enclosure(qn_ctx *ctx, qn_root root, qn_root_at at) {
  if (isinf(at.e)) {
    return;
  }
  qn_int t, w, e, v;
  qn_exact_double(ctx, at.t, &t, &w);
  qn_exact_double(ctx, at.e, &e, &v);
  qn_int den = qn_int_mul(ctx, w, v), tv = qn_int_mul(ctx, t, v), ew = qn_int_mul(ctx, e, w);
  assert_true(qn_root_cmp_rat(ctx, root, qn_int_sub(ctx, tv, ew), den) >= 0);
  assert_true(qn_root_cmp_rat(ctx, root, qn_int_add(ctx, tv, ew), den) <= 0);
}

static void check_all(stage *st, qn_line *line, census *c) {
  qn_scratch *s = st->scratch;
  uint64_t sure = s->counts.filter_sure, exact = s->counts.exact_signs;
  unsigned asked = 0;
  qn_solve_begin(s, line);
  for (size_t i = 0; i < st->scene->leaf_count; i++) {
    const qn_leaf *leaf = &st->scene->leaves[i];
    qn_filter_leaf frame;
    qn_filter_leaf_begin(&s->filter, leaf->pivot, &frame);
    for (uint32_t h = leaf->half0; h < leaf->half0 + leaf->halves; h++) {
      uint32_t before = (uint32_t)s->solved_count, at = qn_solve_half(s, leaf, &frame, h);
      assert_true(at != QN_NO_SOLVED);
      c->memo += at < before;
      asked += at >= before;
      qn_solved v = s->solved[at];
      assert_int_equal(v.surface, st->scene->halves[h].surface);
      const qn_quad *q = qn_solved_quad(s, at);
      assert_non_null(q);
      c->solved++;
      int sign = 0;
      unsigned roots = 0, touches = 0;
      switch (qn_quad_kind(q)) {
      case QN_QUAD_ZERO: c->zero++; break;
      case QN_QUAD_CONSTANT: sign = q->sign_c; break;
      case QN_QUAD_LINEAR: roots = 1, sign = -q->sign_h; break;
      case QN_QUAD_NONE: sign = q->sign_a; break;
      case QN_QUAD_DOUBLE: touches = 1, sign = q->sign_a; break;
      case QN_QUAD_TWO: roots = 2, sign = q->sign_a; break;
      }
      c->none += roots == 0;
      c->one += roots == 1;
      c->two += roots == 2;
      c->touching += touches;
      assert_int_equal(v.roots, roots);
      assert_int_equal(v.touches, touches);
      assert_int_equal(v.sign, sign);
      for (unsigned k = 0; k < roots + touches; k++) {
        check_enclosure(&s->ctx, (qn_root){q, (int)k}, s->roots[v.root0 + k]);
      }
    }
  }
  /* every surface was counted once, as sure or as exact */
  assert_int_equal(s->counts.filter_sure - sure + s->counts.exact_signs - exact, asked);
  c->exact += (unsigned)(s->counts.exact_signs - exact);
}

static void test_solved(void **state) {
  (void)state;
  for (size_t m = 0; m < sizeof models / sizeof *models; m++) {
    stage st = stage_open(models[m]);
    census c = {0};
    for (int n = 0; n < 150; n++) {
      const qn_leaf *leaf = &st.scene->leaves[next() % st.scene->leaf_count];
      double size = leaf->bounded ? leaf->max[0] - leaf->min[0] : 1, o[3], d[3], away = one_in(3) ? 0 : ldexp(1, (int)(next() % 30));
      for (int j = 0; j < 3; j++) {
        d[j] = one_in(4) ? 0 : uniform();
      }
      if (d[0] == 0 && d[1] == 0 && d[2] == 0) {
        d[next() % 3] = 1;
      }
      for (int j = 0; j < 3; j++) { /* near the leaf, or on one of its box's planes */
        double at = leaf->bounded && one_in(4) ? (one_in(2) ? leaf->min[j] : leaf->max[j]) : leaf->pivot[j] + size * uniform();
        o[j] = at - away * size * d[j];
        if (one_in(30)) {
          d[j] = ldexp(uniform(), -70);
        }
        if (one_in(60)) {
          o[j] = ldexp(uniform(), -80);
        }
      }
      qn_scratch_begin(st.scratch);
      qn_line line;
      if (one_in(3)) { /* as decimals that are not doubles */
        qn_ctx *ctx = qn_scratch_ctx(st.scratch);
        qn_num on[3], dn[3], tenth = number_of(ctx, "0.1");
        for (int j = 0; j < 3; j++) {
          on[j] = qn_num_mul(ctx, qn_num_from_double(ctx, o[j]), tenth);
          dn[j] = qn_num_mul(ctx, qn_num_from_double(ctx, d[j]), tenth);
        }
        qn_line_from_numbers(ctx, on, dn, &line);
      } else {
        qn_line_from_doubles(o, d, &line);
      }
      check_all(&st, &line, &c);
    }
    print_message("model %zu: %u solved, none %u, one %u, two %u, touching %u, zero %u, exact %u, from memory %u\n", m, c.solved, c.none, c.one, c.two, c.touching, c.zero,
                  c.exact, c.memo);
    assert_true(c.solved > 3000 && c.none > 500 && c.one > 300 && c.two > 300);
    if (m < 4) {
      assert_true(c.exact < c.solved / 20); /* the filter is of use */
    }
    stage_close(&st);
  }
}

/* Lines beyond the filter's range, and beyond the doubles'. */
static void test_wild(void **state) {
  (void)state;
  stage st = stage_open("sphere(1); translate([5, 0, 0]) cube(1, center = true);");
  char got[200];
  static const struct { const char *o[3], *d[3], *want; } rays[] = {
    {{"-3", "0", "0"}, {"0x1p-600", "0", "0"}, NULL}, /* 2, 4, 7.5, 8.5 times 2^600 */
    {{"-1e30", "0", "0"}, {"1e30", "0", "0"}, "1 1 1 1"},
    {{"-1e400", "0", "0"}, {"1e400", "0", "0"}, "1 1 1 1"},
    {{"-1e400", "0", "0"}, {"1", "0", "0"}, "inf inf inf inf"},
    {{"-3", "0", "0"}, {"1e-400", "0", "0"}, "inf inf inf inf"},
    {{"-3", "0", "0"}, {"-1e-400", "0", "0"}, "-inf -inf -inf -inf"},
    {{"-3", "1e-400", "0"}, {"1", "0", "0"}, "2 4 7.5 8.5"},
    {{"-3", "1", "-1e-400"}, {"1", "0", "0"}, ""},
    {{"-3", "0", "0"}, {"1", "1e-400", "-1e-400"}, "2 4 7.5 8.5"},
  };
  for (size_t i = 0; i < sizeof rays / sizeof *rays; i++) {
    qn_scratch_begin(st.scratch);
    qn_ctx *ctx = qn_scratch_ctx(st.scratch);
    qn_num o[3], d[3];
    for (int j = 0; j < 3; j++) {
      o[j] = number_of(ctx, rays[i].o[j]);
      d[j] = number_of(ctx, rays[i].d[j]);
    }
    qn_line line;
    qn_line_from_numbers(ctx, o, d, &line);
    answer_of(&st, &line, &WHOLE_LINE, got, sizeof got);
    char scaled[200] = "";
    if (!rays[i].want) {
      static const double ends[4] = {2, 4, 7.5, 8.5};
      for (int k = 0; k < 4; k++) {
        add_number(scaled, sizeof scaled, ldexp(ends[k], 600));
      }
    }
    assert_string_equal(got, rays[i].want ? rays[i].want : scaled);
  }
  assert_true(qn_scratch_counts(st.scratch)->exact_rays == 3);
  stage_close(&st);
}

/* A surface that two leaves share is solved once, and its places are one place. */
static void test_shared(void **state) {
  (void)state;
  stage st = stage_open("cube(1); translate([1, 0, 0]) cube(1);");
  assert_true(st.scene->surface_count < st.scene->half_count);
  qn_scratch *s = st.scratch;
  const double o[3] = {-0.3, 0.1, 0.2}, d[3] = {0.7, 0.01, 0.02};
  qn_line line;
  qn_scratch_begin(s);
  qn_line_from_doubles(o, d, &line);
  qn_woven w;
  assert_int_equal(qn_weave(st.scene, s, &line, &WHOLE_LINE, 0, &w), QUOIN_OK);
  assert_int_equal(w.inside_count, 1);
  assert_int_equal(s->counts.exact_orders + s->counts.exact_signs, 0);
  assert_true(s->solved_count < st.scene->half_count);
  stage_close(&st);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_solved), cmocka_unit_test(test_wild), cmocka_unit_test(test_shared)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
