/* The numbers of scene/rounding.h against the exact form, shifted to the pivot in rationals: every coefficient within 2^-104 of itself
   up to one power of two, the axes in their order, the kind the first that has the terms, the three sizes not too small. */
#include "base/bounds.h"
#include "scene/rounding.h"
#include "scene/reading.h"

#include <math.h>

static void from_int(mpz_t out, qn_int a) {
  size_t n = (size_t)(a.n < 0 ? -a.n : a.n);
  mpz_import(out, n, -1, sizeof(mp_limb_t), 0, 0, n ? a.d : (const void *)"");
  if (a.n < 0) {
    mpz_neg(out, out);
  }
}

static const int PAIR[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

/* q(c + y) by definition: q at 0, e_i, -e_i and e_i + e_j, differences of which are the coefficients. */
static void value_at(mpq_t out, mpz_t q[10], const double c[3], const int y[3]) {
  mpq_t x[3], term, k;
  mpq_inits(x[0], x[1], x[2], term, k, (mpq_ptr)0);
  for (int j = 0; j < 3; j++) {
    mpq_set_d(x[j], c[j]);
    mpq_set_si(term, y[j], 1);
    mpq_add(x[j], x[j], term);
  }
  mpq_set_z(out, q[9]);
  for (int i = 0; i < 9; i++) {
    mpq_set_z(k, q[i]);
    mpq_mul(term, k, x[i < 6 ? PAIR[i][0] : i - 6]);
    if (i < 6) {
      mpq_mul(term, term, x[PAIR[i][1]]);
    }
    mpq_add(out, out, term);
  }
  mpq_clears(x[0], x[1], x[2], term, k, (mpq_ptr)0);
}

static void shifted(mpq_t out[10], mpz_t q[10], const double c[3]) {
  mpq_t plus, minus, two;
  mpq_inits(plus, minus, two, (mpq_ptr)0);
  mpq_set_si(two, 2, 1);
  const int none[3] = {0, 0, 0};
  value_at(out[9], q, c, none);
  for (int j = 0; j < 3; j++) {
    int e[3] = {0, 0, 0};
    e[j] = 1;
    value_at(plus, q, c, e);
    e[j] = -1;
    value_at(minus, q, c, e);
    mpq_sub(out[6 + j], plus, minus);
    mpq_div(out[6 + j], out[6 + j], two);
    mpq_add(out[j], plus, minus);
    mpq_div(out[j], out[j], two);
    mpq_sub(out[j], out[j], out[9]);
  }
  for (int i = 3; i < 6; i++) {
    int a = PAIR[i][0], b = PAIR[i][1], e[3] = {0, 0, 0};
    e[a] = e[b] = 1;
    value_at(out[i], q, c, e);
    mpq_sub(out[i], out[i], out[9]);
    mpq_sub(out[i], out[i], out[a]);
    mpq_sub(out[i], out[i], out[b]);
    mpq_sub(out[i], out[i], out[6 + a]);
    mpq_sub(out[i], out[i], out[6 + b]);
  }
  mpq_clears(plus, minus, two, (mpq_ptr)0);
}

static unsigned kinds[QN_ROUNDING_KINDS + 1], dropped, checked;

static void check_surface(const quoin_scene *scene, uint32_t surface) {
  uint64_t made = 0;
  const qn_rounding *r = qn_scene_rounding(scene, surface, &made);
  assert_non_null(r);
  assert_true(r == qn_scene_rounding(scene, surface, &made) && made <= 1);
  kinds[r->kind]++;
  if (r->kind == QN_ROUNDING_NONE) {
    return;
  }
  const qn_exact_surface *form = qn_scene_exact(scene, surface, NULL);
  const double *pivot = scene->leaves[scene->surfaces[surface].leaf].pivot;
  mpz_t q[10];
  mpq_t k[10], x, y, factor;
  mpq_inits(x, y, factor, (mpq_ptr)0);
  for (int i = 0; i < 10; i++) {
    mpz_init(q[i]);
    mpq_init(k[i]);
    from_int(q[i], form->q[i]);
  }
  shifted(k, q, pivot);
  int most = 9, there[10], axes = 0;
  assert_true((1u << r->axis[0] | 1u << r->axis[1] | 1u << r->axis[2]) == 7);
  for (int i = 0; i < 10; i++) {
    mpq_abs(x, k[i]);
    mpq_abs(y, k[most]);
    most = mpq_cmp(x, y) > 0 ? i : most;
  }
  mpq_abs(factor, k[most]); /* to the power of two that brings the largest into [1/2, 1) */
  long e = (long)mpz_sizeinbase(mpq_numref(factor), 2) - (long)mpz_sizeinbase(mpq_denref(factor), 2);
  mpq_set_si(x, 1, 1);
  e > 0 ? mpq_mul_2exp(x, x, (mp_bitcnt_t)e) : mpq_div_2exp(x, x, (mp_bitcnt_t)-e);
  if (mpq_cmp(factor, x) >= 0) {
    mpq_mul_2exp(x, x, 1);
  }
  mpq_set(factor, x);
  double sizes[3] = {0, 0, 0};
  for (int i = 0; i < 10; i++) {
    int a = i < 6 ? r->axis[PAIR[i][0]] : 0, b = i < 6 ? r->axis[PAIR[i][1]] : 0, from = i < 9 ? 6 + (i < 6 ? 0 : r->axis[i - 6]) : 9;
    for (int n = 0; i < 6 && n < 6; n++) {
      from = (PAIR[n][0] == a && PAIR[n][1] == b) || (PAIR[n][0] == b && PAIR[n][1] == a) ? n : from;
    }
    double hi = r->k[QN_ROUNDING_HI + i], lo = r->k[QN_ROUNDING_LO + i];
    assert_true(hi + lo == hi);
    mpq_div(y, k[from], factor); /* the truth */
    there[i] = mpq_sgn(y) != 0;
    mpq_set_d(x, hi);
    mpq_sub(x, y, x);
    mpq_abs(y, y);
    if (hi == 0) {
      mpq_mul_2exp(y, y, -QN_ROUND_DROP);
      mpq_set_si(x, 1, 1);
      assert_true(lo == 0 && mpq_cmp(y, x) < 0);
      dropped += (unsigned)there[i];
    } else {
      mpq_t z;
      mpq_init(z);
      mpq_set_d(z, lo);
      mpq_sub(x, x, z);
      mpq_clear(z);
      mpq_abs(x, x);
      mpq_mul_2exp(x, x, 104);
      assert_true(mpq_cmp(x, y) <= 0);
    }
    double *size = &sizes[i < 6 ? 0 : i < 9 ? 1 : 2];
    *size = fmax(*size, fabs(hi));
    checked++;
  }
  for (int j = 0; j < 3; j++) { /* coordinates that occur come first */
    assert_true(r->k[QN_ROUNDING_PIVOT + j] == pivot[r->axis[j]]);
    int occurs = there[6 + j];
    for (int i = 0; i < 6; i++) {
      occurs |= there[i] && (PAIR[i][0] == j || PAIR[i][1] == j);
    }
    assert_true(!occurs || axes == j);
    axes += occurs;
  }
  int plane = form->plane, crossed = r->k[QN_ROUNDING_HI + 3] != 0 || r->k[QN_ROUNDING_HI + 4] != 0 || r->k[QN_ROUNDING_HI + 5] != 0;
  assert_int_equal(r->kind, plane ? (axes == 1 ? QN_ROUNDING_AXIS : QN_ROUNDING_PLANE)
                            : crossed ? QN_ROUNDING_FULL : axes == 3 ? QN_ROUNDING_DIAGONAL : QN_ROUNDING_ROUND);
  if (r->kind == QN_ROUNDING_AXIS) { /* where it stands */
    mpq_set_z(x, q[9]);
    mpq_set_z(y, q[6 + r->axis[0]]);
    mpq_div(x, x, y);
    mpq_neg(x, x);
    mpq_set_d(y, r->place[0]);
    mpq_sub(y, x, y);
    mpq_set_d(factor, r->place[1]);
    mpq_sub(y, y, factor);
    mpq_mul_2exp(y, y, 105);
    mpq_abs(x, x), mpq_abs(y, y);
    assert_true(mpq_cmp(y, x) <= 0 && r->place[0] + r->place[1] == r->place[0]);
  }
  assert_true(r->k[QN_ROUNDING_SQUARE] >= sizes[0] && r->k[QN_ROUNDING_LINEAR] >= sizes[1] && r->k[QN_ROUNDING_CONSTANT] >= sizes[2]);
  assert_true(r->k[QN_ROUNDING_LINEAR] >= QN_ROUND_LINEAR_TINY && r->k[QN_ROUNDING_CONSTANT] >= QN_ROUND_TINY);
  assert_true(plane || r->k[QN_ROUNDING_SQUARE] >= QN_ROUND_SQUARE_TINY);
  for (int i = 0; i < 10; i++) {
    mpz_clear(q[i]);
    mpq_clear(k[i]);
  }
  mpq_clears(x, y, factor, (mpq_ptr)0);
}

static void test_numbers(void **state) {
  (void)state;
  static const char *const places[] = {
    "union()", "translate([1e9, -0.1, 3])", "translate([0.1, 0.2, 0.3]) rotate([10, 20, 30])", "scale([1e-7, 1e-7, 1e-7])",
    "scale([1, 1e-40, 1])",
    "translate([1e200, 0, 1e-200])", "multmatrix([[0.6, -0.8, 0, 1e5], [0.8, 0.6, 0, 1e-5], [0, 0, 1, 1]])", "rotate([0, 90, 0])",
  };
  for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
    char text[1000];
    snprintf(text, sizeof text,
             "%s { sphere(1.5); translate([0.1, -3.7, 2]) sphere(1 / 3); cube([1, 2.5, 0.7]); cylinder(h = 2, r = 0.7);"
             " cylinder(h = 3, r1 = 0.2, r2 = 1.1); rotate([0, 0, 31]) cylinder(h = 2, r = 1); rotate([17, 0, 0]) sphere(7);"
             " paraboloid(h = 2, r = 1); hyperboloid(h = 2, r = 1, rc = 0.6); halfspace(n = [1, 2, -0.3], d = 0.1); multmatrix([[1, 0.3, 0, 0], [0, 1, 0.7, 0], [0.1, 0, 1.3, 0]]) sphere(0.9); }",
             places[i]);
    quoin_scene *scene = scene_of(text);
    for (uint32_t s = 0; s < scene->surface_count; s++) {
      check_surface(scene, s);
    }
    quoin_scene_free(scene);
  }
  print_message("axis %u plane %u round %u diagonal %u full %u none %u; %u coefficients, %u dropped\n", kinds[0], kinds[1], kinds[2],
                kinds[3], kinds[4], kinds[5], checked, dropped);
  assert_true(kinds[0] > 10 && kinds[1] > 10 && kinds[2] > 3 && kinds[3] > 10 && kinds[4] > 10 && checked > 1000 && dropped > 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_numbers)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
