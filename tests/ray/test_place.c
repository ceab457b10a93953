/* The order of places and the doubles nearest to them: the quick ways against the exact ones, always the same answer. */
#include "rays.h"

static uint64_t seed = 0xda3e39cb94b95bdbu;
static uint64_t next(void) {
  seed ^= seed << 13;
  seed ^= seed >> 7;
  seed ^= seed << 17;
  return seed;
}
static double uniform(void) { return (double)(next() >> 11) * 0x1p-52 - 1; }
static int one_in(unsigned n) { return next() % n == 0; }

static const char *const models[] = {
  "sphere(1.3); translate([0.4, 0, 0]) sphere(0.9); cube([0.3, 1.7, 0.1]); cylinder(h = 2.1, r = 0.7); cylinder(h = 1.9, r1 = 1.1, r2 = 0.2); paraboloid(h = 1.2, r = 0.9);",
  "translate([1000.1, -7.3, 100.7]) rotate([10, 20, 30]) { sphere(1.3); hyperboloid(h = 1.1, r = 1.3, rc = 0.4); wedge(size = [1.1, 0.7, 0.9]); ellipsoid(r = [0.7, 1.1, 1.9]); }",
  "scale(0.001) { sphere(2); translate([1, 1, 1]) cube(2); quadric([1, 2, -3, 0.1, -0.2, 0.3, 0.4, 0.5, -0.6, -2]); }",
};

static void check_places(stage *st, qn_line *line, unsigned *places, uint64_t *roundings, unsigned *pairs, unsigned *ties) {
  qn_scratch *s = st->scratch;
  enum { MOST = 64 };
  qn_place found[MOST];
  qn_quad quads[MOST];
  size_t n = 0;
  qn_solve_begin(s, line);
  for (size_t i = 0; i < st->scene->leaf_count; i++) {
    const qn_leaf *leaf = &st->scene->leaves[i];
    qn_filter_leaf frame;
    qn_filter_leaf_begin(&s->filter, leaf->pivot, &frame);
    for (uint32_t h = leaf->half0; h < leaf->half0 + leaf->halves && n + 2 < MOST; h++) {
      uint32_t at = qn_solve_half(s, leaf, &frame, h);
      qn_solved v = s->solved[at];
      for (uint32_t k = 0; k < v.roots + v.touches; k++) {
        found[n++] = (qn_place){.t = s->roots[v.root0 + k].t, .e = s->roots[v.root0 + k].e, .surface = v.surface, .which = (int)k};
      }
    }
  }
  for (size_t i = 0; i < n; i++) {
    int made = 0;
    qn_line exact = *line;
    qn_line_make_exact(&s->ctx, &exact);
    qn_line_quad(&s->ctx, &exact, qn_scene_exact(st->scene, found[i].surface, &made), &quads[i]);
    uint64_t before = s->counts.exact_roundings;
    double want = qn_root_to_double(&s->ctx, (qn_root){&quads[i], found[i].which}), got = qn_place_round(st->scene, s, line, &found[i]);
    *roundings += line->rounded ? 0 : s->counts.exact_roundings - before;
    assert_true(memcmp(&want, &got, sizeof want) == 0);
    for (int blur = 10; blur <= 50; blur += 4) { /* a wider enclosure around another double, still a true one */
      double off = ldexp(fabs(want) * uniform(), -blur);
      qn_place wide = found[i];
      wide.t = want + off;
      wide.e = 1.001 * fabs(off) + 0x1p-52 * fabs(want);
      if (isfinite(wide.t)) {
        got = qn_place_round(st->scene, s, line, &wide);
        assert_true(memcmp(&want, &got, sizeof want) == 0);
      }
    }
    ++*places;
  }
  for (size_t i = 0; i < n; i++) {
    for (size_t j = 0; j < n; j++) {
      int want = found[i].surface == found[j].surface ? (found[i].which > found[j].which) - (found[i].which < found[j].which)
                                                      : qn_root_cmp(&s->ctx, (qn_root){&quads[i], found[i].which}, (qn_root){&quads[j], found[j].which});
      assert_int_equal(qn_place_cmp(st->scene, s, line, &found[i], &found[j]), want);
      ++*pairs;
      *ties += i != j && want == 0;
    }
  }
}

static void test_against_exact(void **state) {
  (void)state;
  unsigned places = 0, pairs = 0, ties = 0;
  uint64_t roundings = 0, orders = 0;
  for (size_t m = 0; m < sizeof models / sizeof *models; m++) {
    stage st = stage_open(models[m]);
    for (int n = 0; n < 300; n++) {
      const qn_leaf *leaf = &st.scene->leaves[next() % st.scene->leaf_count];
      double size = leaf->bounded ? leaf->max[0] - leaf->min[0] : 0.01, o[3], d[3], away = one_in(2) ? 0 : ldexp(1, (int)(next() % 40));
      for (int j = 0; j < 3; j++) {
        d[j] = one_in(6) ? 0 : one_in(3) ? round(4 * uniform()) : uniform();
      }
      if (d[0] == 0 && d[1] == 0 && d[2] == 0) {
        d[next() % 3] = 1;
      }
      for (int j = 0; j < 3; j++) {
        o[j] = (one_in(4) ? leaf->min[j] : leaf->pivot[j] + 0.5 * size * uniform()) - away * size * d[j];
        if (!isfinite(o[j])) {
          o[j] = 0;
        }
      }
      qn_scratch_begin(st.scratch);
      qn_line line;
      if (one_in(4)) {
        qn_ctx *ctx = qn_scratch_ctx(st.scratch);
        qn_num on[3], dn[3];
        for (int j = 0; j < 3; j++) {
          on[j] = qn_num_mul(ctx, qn_num_from_double(ctx, o[j]), number_of(ctx, "0.3"));
          dn[j] = qn_num_mul(ctx, qn_num_from_double(ctx, d[j]), number_of(ctx, "0.7"));
        }
        qn_line_from_numbers(ctx, on, dn, &line);
      } else {
        qn_line_from_doubles(o, d, &line);
      }
      check_places(&st, &line, &places, &roundings, &pairs, &ties);
    }
    orders += qn_scratch_counts(st.scratch)->exact_orders;
    stage_close(&st);
  }
  print_message("%u places, %llu of lines in doubles rounded exactly; %u pairs, %llu ordered exactly, %u ties\n", places, (unsigned long long)roundings, pairs,
                (unsigned long long)orders, ties);
  assert_true(places > 5000 && pairs > 50000 && ties > 20);
  assert_true(roundings < places / 5 && orders > 0); /* Newton's step does nearly all */
}

/* Roots in the middle between two doubles, and 2^-j off it: quick and exact rounding give one answer, to even in the middle. */
static void test_middles(void **state) {
  (void)state;
  unsigned even = 0, quick = 0, all = 0;
  for (int n = 0; n < 300; n++) {
    int k = (int)(next() % 1000), off = (int)(next() % 3) - 1, bits = 54 + (int)(next() % 100);
    char text[300];
    /* a plane x = 1 + (2 k + 1) 2^-53 + off 2^-bits, and the ball through it about the origin */
    snprintf(text, sizeof text, "p = 1 + %d * 2 ^ -53 + %d * 2 ^ -%d; halfspace(n = [1, 0, 0], d = p); sphere(p);", 2 * k + 1, off, bits);
    stage st = stage_open(text);
    const double o[3] = {0, 0, 0}, d[3] = {1, 0, 0};
    double low = 1 + k * 0x1p-52, high = 1 + (k + 1) * 0x1p-52, want = off < 0 ? low : off > 0 ? high : k % 2 == 0 ? low : high;
    if (bits == 54 && off != 0) {
      want = off < 0 ? low : high; /* a quarter of a unit: still nearer to one side */
    }
    qn_scratch_begin(st.scratch);
    qn_line line;
    qn_line_from_doubles(o, d, &line);
    qn_solve_begin(st.scratch, &line);
    for (size_t i = 0; i < st.scene->leaf_count; i++) {
      const qn_leaf *leaf = &st.scene->leaves[i];
      qn_filter_leaf frame;
      qn_filter_leaf_begin(&st.scratch->filter, leaf->pivot, &frame);
      uint32_t at = qn_solve_half(st.scratch, leaf, &frame, leaf->half0);
      qn_solved v = st.scratch->solved[at];
      uint32_t last = v.roots - 1;
      qn_place place = {.t = st.scratch->roots[v.root0 + last].t, .e = st.scratch->roots[v.root0 + last].e, .surface = v.surface, .which = (int)last};
      uint64_t before = qn_scratch_counts(st.scratch)->exact_roundings;
      double got = qn_place_round(st.scene, st.scratch, &line, &place);
      assert_true(got == want);
      all++;
      even += off == 0;
      quick += qn_scratch_counts(st.scratch)->exact_roundings == before;
    }
    stage_close(&st);
  }
  print_message("%u places, %u in the middle, %u rounded by a step in double-doubles\n", all, even, quick);
  assert_true(all == 600 && even > 100 && quick > 50 && quick < all - even + 1);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_against_exact), cmocka_unit_test(test_middles)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
