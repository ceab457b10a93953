/* Superquadrics: the exact special exponents against the function itself, the error bound of the value against MPFR, the gradient
   against differences, the same function along a line against MPFR, roots against the certain sign, against a dense walk along the
   ray, and of both tiers against each other. */
#include <mpfr.h>

#include "shape/super_line.h"
#include "shapes.h"
#include "share.h"

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

/* |x|^p with the exponent 2/e, e > 0. */
static void power(mpfr_t out, mpfr_t x, double e) {
  mpfr_t p;
  mpfr_init2(p, 300);
  mpfr_set_ui(p, 2, MPFR_RNDN);
  mpfr_div_d(p, p, e, MPFR_RNDN);
  mpfr_abs(out, x, MPFR_RNDN);
  mpfr_pow(out, out, p, MPFR_RNDN);
  mpfr_clear(p);
}

/* f - 1 as Barr writes it, in 300 bits: (|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n) - 1, n > 0; at e = 0 max(|x|, |y|)^(2/n). */
static void barr_at(mpfr_t out, double e, double n, mpfr_t X[3]) {
  mpfr_t t, q;
  mpfr_inits2(300, t, q, (mpfr_ptr)NULL);
  if (e > 0) {
    power(out, X[0], e);
    power(t, X[1], e);
    mpfr_add(out, out, t, MPFR_RNDN);
    mpfr_set_d(q, e, MPFR_RNDN);
    mpfr_div_d(q, q, n, MPFR_RNDN);
    mpfr_pow(out, out, q, MPFR_RNDN);
  } else {
    power(out, X[mpfr_cmpabs(X[0], X[1]) < 0], n);
  }
  power(t, X[2], n);
  mpfr_add(out, out, t, MPFR_RNDN);
  mpfr_sub_ui(out, out, 1, MPFR_RNDN);
  mpfr_clears(t, q, (mpfr_ptr)NULL);
}

static void barr(mpfr_t out, double e, double n, const double X[3]) {
  mpfr_t x[3];
  mpfr_inits2(300, x[0], x[1], x[2], (mpfr_ptr)NULL);
  for (int i = 0; i < 3; i++) {
    mpfr_set_d(x[i], X[i], MPFR_RNDN);
  }
  barr_at(out, e, n, x);
  mpfr_clears(x[0], x[1], x[2], (mpfr_ptr)NULL);
}

static double exponent(bench *b) {
  switch (below(b, 8)) {
    case 0: return 1;
    case 1: return 2;
    case 2: return real(b, 0.01, 0.1);
    case 3: return real(b, 2, 6);
    case 4: return 0.5;
    default: return real(b, 0.1, 2);
  }
}

static void value_is_within_its_error(void **state) {
  bench *b = *state;
  mpfr_t truth, difference;
  mpfr_inits2(300, truth, difference, (mpfr_ptr)NULL);
  int vouched = 0, near = 0;
  double worst = 0;
  for (int round = 0; round < share_of(30000); round++) {
    double e = exponent(b), n = exponent(b), X[3], error;
    for (int i = 0; i < 3; i++) {
      X[i] = below(b, 10) ? real(b, -1.5, 1.5) : below(b, 2) ? 0 : real(b, -1e-9, 1e-9);
    }
    if (below(b, 2)) { /* to the surface */
      double v = qn_superquadric_value(e, n, X, &error) + 1, s = pow(v, -0.5 * n);
      for (int i = 0; i < 3 && isfinite(s); i++) {
        X[i] *= s;
      }
    }
    double v = qn_superquadric_value(e, n, X, &error);
    assert_false(isnan(v) || isnan(error) || error < 0);
    barr(truth, e, n, X);
    if (isfinite(v) && isfinite(error)) {
      mpfr_sub_d(difference, truth, v, MPFR_RNDN);
      assert_true(mpfr_cmpabs(difference, truth) == 0 || fabs(mpfr_get_d(difference, MPFR_RNDA)) <= error);
      worst = error > 0 ? fmax(worst, fabs(mpfr_get_d(difference, MPFR_RNDN)) / error) : worst;
      vouched++;
      near += fabs(v) < 1e-10;
    } else if (isinf(v)) {
      assert_true(error == 0 && mpfr_cmp_d(truth, 0x1p1000) > 0);
    }
  }
  assert_true(vouched > share_min(25000) && near > share_min(5000));
  assert_true(!share_whole() || worst > 0.02); /* the bound is a bound, not a blanket */
  mpfr_clears(truth, difference, (mpfr_ptr)NULL);
  mpfr_free_cache();
}

/* QN_SUPER_SLOPE: phi(r) = (1 + r^p)^(1/p - 1), with r off by up to 3u. */
static void slope_is_within_its_error(void **state) {
  bench *b = *state;
  mpfr_t w, p, c, one;
  mpfr_inits2(300, w, p, c, one, (mpfr_ptr)NULL);
  mpfr_set_ui(one, 1, MPFR_RNDN);
  int far = 0;
  for (int round = 0; round < share_of(20000); round++) {
    double e = exponent(b), r = below(b, 3) ? exp(real(b, -1, 1)) : exp(real(b, -40, 40));
    double off = r * (1 + (below(b, 7) - 3) * QN_U * 0.99), phi = qn_super_slope(e, 2 / e, off);
    mpfr_set_ui(p, 2, MPFR_RNDN);
    mpfr_div_d(p, p, e, MPFR_RNDN);
    mpfr_set_d(w, r, MPFR_RNDN);
    mpfr_pow(w, w, p, MPFR_RNDN);
    mpfr_add(w, w, one, MPFR_RNDN);
    mpfr_div(c, one, p, MPFR_RNDN);
    mpfr_sub(c, c, one, MPFR_RNDN);
    mpfr_pow(w, w, c, MPFR_RNDN);
    if (mpfr_cmp_d(w, 1e-300) > 0 && mpfr_cmp_d(w, 1e300) < 0) {
      mpfr_sub_d(c, w, phi, MPFR_RNDN);
      mpfr_div(c, c, w, MPFR_RNDN);
      assert_true(fabs(mpfr_get_d(c, MPFR_RNDA)) <= QN_SUPER_SLOPE(e, 2 / e) * (1 + fabs(log(r))));
      far += fabs(mpfr_get_d(c, MPFR_RNDN)) > 0.02 * QN_SUPER_SLOPE(e, 2 / e) * (1 + fabs(log(r)));
    }
  }
  assert_true(far > share_min(300));
  mpfr_clears(w, p, c, one, (mpfr_ptr)NULL);
  mpfr_free_cache();
}

static void zero_exponents(void **state) {
  (void)state;
  double X[3] = {0.5, -2, 0.25}, error;
  assert_true(qn_superquadric_value(0, 0, X, &error) == 1); /* the greatest of the coordinates, less 1 */
  assert_true(fabs(qn_superquadric_value(0, 1, X, &error) - (4 + 0.0625 - 1)) <= error && error < 1e-13);
  double Y[3] = {0.6, 0.8, 3};
  double v = qn_superquadric_value(1, 0, Y, &error);
  assert_true(fabs(v - 2) <= error && error < 1e-14);
  double g[3], edge[3] = {1, 1, 0.5}, face[3] = {1, 0.5, -0.25}, top[3] = {0.1, 0.2, -1};
  qn_superquadric_gradient(0, 0, edge, g);
  assert_true(g[0] == g[1] && g[0] > 0 && g[2] == 0); /* an edge: the mean of its faces */
  qn_superquadric_gradient(0, 0, face, g);
  assert_true(g[0] > 0 && g[1] == 0 && g[2] == 0);
  qn_superquadric_gradient(0, 0, top, g);
  assert_true(g[0] == 0 && g[1] == 0 && g[2] < 0);
  double ridge[3] = {0, 1, 0};
  qn_superquadric_gradient(4, 1, ridge, g); /* a spike's tip: outward along the axis */
  assert_true(g[0] == 0 && g[1] > 0 && g[2] == 0);
  qn_superquadric_gradient(2, 2, ridge, g);
  assert_true(g[0] == 0 && g[1] > 0 && g[2] == 0);
}

static void gradient_is_the_functions(void **state) {
  bench *b = *state;
  for (int round = 0; round < share_of(3000); round++) {
    double e = real(b, 0.3, 3), n = real(b, 0.3, 3), X[3], g[3], d[3], error;
    for (int i = 0; i < 3; i++) {
      X[i] = real(b, 0.2, 1) * (below(b, 2) ? 1 : -1);
    }
    qn_superquadric_gradient(e, n, X, g);
    double gg = 0, dd = 0, gd = 0;
    for (int i = 0; i < 3; i++) { /* central differences: parallel to the gradient */
      double Y[3] = {X[0], X[1], X[2]}, step = 0x1p-20;
      Y[i] = X[i] + step;
      d[i] = qn_superquadric_value(e, n, Y, &error);
      Y[i] = X[i] - step;
      d[i] -= qn_superquadric_value(e, n, Y, &error);
      gg += g[i] * g[i], dd += d[i] * d[i], gd += g[i] * d[i];
    }
    assert_true(gd > 0.999999 * sqrt(gg * dd));
  }
}

/* All nine exact pairs: the half-spaces against value and sign at random points, many on faces, edges and nappes. */
static void exact_exponents(void **state) {
  bench *b = *state;
  static const size_t counts[3][3] = {{6, 2, 8}, {3, 1, 4}, {6, 2, 8}}; /* by e, n */
  for (int e = 0; e < 3; e++) {
    for (int n = 0; n < 3; n++) {
      int census[3] = {0, 0, 0};
      for (int round = 0; round < 40; round++) {
        qn_mark mark = qn_arena_mark(&b->ctx.arena);
        solid s = {.prim = QN_SUPERQUADRIC, .args = {size(b), size(b), size(b), INT(e), INT(n)}, .n = 5};
        make(b, &s, NULL);
        assert_int_equal(s.result, QN_FORM_OK);
        assert_int_equal(s.count, counts[e][n]);
        for (int i = 0; i < 60; i++) {
          qn_num X[3], x[3];
          double Y[3], error;
          for (int k = 0; k < 3; k++) {
            X[k] = ratio(b, below(b, 4) ? 5 : 15, 5); /* 3/5, 4/5, 1 are among them */
          }
          for (int k = 0; k < 3; k++) {
            x[k] = MUL(X[k], s.args[k]);
            Y[k] = qn_num_to_double(X[k]);
          }
          int exact = side(b, &s, x), sign = qn_superquadric_sign(&b->ctx, INT(e), INT(n), X);
          double v = qn_superquadric_value(e, n, Y, &error);
          assert_int_equal(sign, exact);
          assert_true(v > error ? exact > 0 : v < -error ? exact < 0 : 1);
          census[exact + 1]++;
        }
        qn_arena_release(&b->ctx.arena, mark);
      }
      assert_true(census[0] > 60 && census[1] > 20 && census[2] > 60);
    }
  }
}

static void signs(void **state) {
  bench *b = *state;
  qn_num one = INT(1), zero = INT(0), e = num(b, "0.5"), n = num(b, "0.3");
  qn_num on[3] = {one, zero, zero}, inside[3] = {num(b, "0.99999999999999999999999999999999999999999"), zero, zero};
  qn_num outside[3] = {one, num(b, "1e-6"), zero};
  assert_int_equal(qn_superquadric_sign(&b->ctx, e, n, on), 0);
  assert_int_equal(qn_superquadric_sign(&b->ctx, e, n, inside), -1);
  assert_int_equal(qn_superquadric_sign(&b->ctx, e, n, outside), 1);
  /* x = y = 2^(-1/4) is on |x|^4 + |y|^4 = 1; rounded to 256 bits its sign is open, moved by 1e-60 it is not */
  qn_num corner;
  assert_true(qn_num_pow(&b->ctx, num(b, "0.5"), num(b, "0.25"), &corner));
  qn_num at[3] = {corner, corner, zero};
  assert_int_equal(qn_superquadric_sign(&b->ctx, e, n, at), 0);
  at[0] = ADD(corner, num(b, "1e-60"));
  assert_int_equal(qn_superquadric_sign(&b->ctx, e, n, at), 1);
  at[0] = SUB(corner, num(b, "1e-60"));
  assert_int_equal(qn_superquadric_sign(&b->ctx, e, n, at), -1);
  /* extreme exponents */
  qn_num tiny = num(b, "1e-300"), huge = num(b, "1e300"), half[3] = {num(b, "0.5"), num(b, "0.5"), num(b, "0.5")}, big[3] = {num(b, "1.1"), zero, zero};
  assert_int_equal(qn_superquadric_sign(&b->ctx, tiny, tiny, half), -1);
  assert_int_equal(qn_superquadric_sign(&b->ctx, tiny, tiny, big), 1);
  assert_int_equal(qn_superquadric_sign(&b->ctx, huge, huge, half), 1);
  assert_int_equal(qn_superquadric_sign(&b->ctx, huge, huge, on), 0);
  for (int i = 0; i < 2; i++) {
    double X[3] = {i ? 1.1 : 0.5, i ? 0 : 0.5, i ? 0 : 0.5}, error;
    double v = qn_superquadric_value(1e-300, 1e-300, X, &error);
    assert_true(i ? v - error > 0 : v < 0);
  }
}

/* --- roots -------------------------------------------------------------------------------------------------------------- */

static int exact_sign_at(bench *b, double e, double n, const double O[3], const double D[3], double t) {
  qn_num X[3];
  for (int i = 0; i < 3; i++) {
    X[i] = ADD(qn_num_from_double(&b->ctx, O[i]), MUL(qn_num_from_double(&b->ctx, D[i]), qn_num_from_double(&b->ctx, t)));
  }
  return qn_superquadric_sign(&b->ctx, qn_num_from_double(&b->ctx, e), qn_num_from_double(&b->ctx, n), X);
}

/* df/dt at X with X' = D, and the sum of its addends' magnitudes: q [A^(e/n - 1) (x^p X'/X + y^p Y'/Y) + z^q Z'/Z], A = x^p + y^p. */
static void barr_slope(mpfr_t out, mpfr_t all, double e, double n, mpfr_t X[3], const double D[3]) {
  mpfr_t g[3], A, t;
  mpfr_inits2(300, g[0], g[1], g[2], A, t, (mpfr_ptr)NULL);
  mpfr_set_zero(A, 1);
  for (int i = 0; i < 3; i++) {
    power(g[i], X[i], i < 2 ? e : n);
    if (i < 2) {
      mpfr_add(A, A, g[i], MPFR_RNDN);
    }
    mpfr_mul_d(g[i], g[i], D[i], MPFR_RNDN);
    if (!mpfr_zero_p(X[i])) {
      mpfr_div(g[i], g[i], X[i], MPFR_RNDN);
    }
  }
  mpfr_set_d(t, e, MPFR_RNDN);
  mpfr_div_d(t, t, n, MPFR_RNDN);
  mpfr_sub_ui(t, t, 1, MPFR_RNDN);
  mpfr_pow(A, A, t, MPFR_RNDN);
  mpfr_set_zero(out, 1);
  mpfr_set_zero(all, 1);
  for (int i = 0; i < 3; i++) {
    if (i < 2 && !mpfr_zero_p(g[i])) {
      mpfr_mul(g[i], g[i], A, MPFR_RNDN);
    }
    mpfr_mul_ui(g[i], g[i], 2, MPFR_RNDN);
    mpfr_div_d(g[i], g[i], n, MPFR_RNDN);
    mpfr_add(out, out, g[i], MPFR_RNDN);
    mpfr_abs(g[i], g[i], MPFR_RNDN);
    mpfr_add(all, all, g[i], MPFR_RNDN);
  }
  mpfr_clears(g[0], g[1], g[2], A, t, (mpfr_ptr)NULL);
}

/* A line whose numbers are doubles: exactly, and as a frame. */
typedef struct given { bench *b; double e, n; const double *O, *D; } given;
static int exactly(void *user, qn_super_exact *out) {
  const given *g = user;
  qn_ctx *ctx = &g->b->ctx;
  *out = (qn_super_exact){.ctx = ctx, .e = qn_num_from_double(ctx, g->e), .n = qn_num_from_double(ctx, g->n)};
  for (int i = 0; i < 3; i++) {
    out->O[i] = qn_num_from_double(ctx, g->O[i]), out->D[i] = qn_num_from_double(ctx, g->D[i]);
  }
  return 1;
}
static size_t all_roots(bench *b, double e, double n, const double O[3], const double D[3], double (*roots)[2], size_t max) {
  given g = {b, e, n, O, D};
  return qn_superquadric_roots(NULL, exactly, &g, roots, max);
}
static int line_make(bench *b, double e, double n, const double O[3], const double D[3], double from, double to, qn_super_line *out) {
  given g = {b, e, n, O, D};
  qn_super_exact x;
  qn_super_frame frame;
  exactly(&g, &x);
  qn_super_frame_from_exact(&x, &frame);
  return qn_super_line_make(&frame, from, to, out);
}

static double line_exponent(bench *b) {
  static const double halves[] = {0.25, 0.5, 0.8, 1, 2, 4, 8, 0.125, 0.0625, 0.4, 0.2};
  return below(b, 2) ? halves[below(b, 11)] : below(b, 4) ? real(b, 0.1, 2) : below(b, 2) ? real(b, 2, 8) : below(b, 2) ? real(b, QN_SUPER_LEAST, 0.1) : real(b, QN_SUPER_LEAST, 0.01);
}

/* QN_SUPER_VALUE, QN_SUPER_FINER, QN_SUPER_RATE, QN_SUPER_FADED. */
static void line_is_within_its_error(void **state) {
  bench *b = *state;
  mpfr_t truth, difference, all, Y[3];
  mpfr_inits2(300, truth, difference, all, Y[0], Y[1], Y[2], (mpfr_ptr)NULL);
  int inner[5] = {0}, near = 0, slopes = 0;
  double worst[2] = {0, 0};
  for (int round = 0; round < share_of(30000); round++) {
    double e = line_exponent(b), n = below(b, 4) ? line_exponent(b) : e, O[3], D[3], X[3], error;
    e = below(b, 10) ? e : 0;
    if ((e == 1 && n == 1) || e > QN_SUPER_QUOTIENT * n) {
      continue;
    }
    int exact = below(b, 2); /* O + D t is a double */
    for (int i = 0; i < 3; i++) {
      X[i] = below(b, 10) ? real(b, -1, 1) : below(b, 2) ? 0 : real(b, -1e-6, 1e-6);
    }
    if (below(b, 3)) { /* to the surface */
      double v = qn_superquadric_value(e, n, X, &error) + 1, s = pow(v, -0.5 * n);
      for (int i = 0; i < 3 && isfinite(s); i++) {
        X[i] = fmax(-1, fmin(1, X[i] * s));
      }
    }
    double t = exact ? 8 : real(b, 3, 1000);
    for (int i = 0; i < 3; i++) {
      D[i] = below(b, 6) ? real(b, -1, 1) : 0;
      if (exact) {
        X[i] = ldexp(rint(ldexp(X[i], 30)), -30), D[i] = ldexp(rint(ldexp(D[i], 20)), -20);
      }
      O[i] = X[i] - t * D[i];
    }
    qn_super_line c, finer;
    if (!line_make(b, e, n, O, D, 0, t, &c)) {
      assert_true(D[0] == 0 && D[1] == 0 && D[2] == 0);
      continue;
    }
    inner[c.inner]++;
    int tiers = qn_super_finer(&c, &finer) ? 2 : 1;
    for (int i = 0; i < 3; i++) { /* O + t D without rounding */
      mpfr_set_d(Y[i], D[i], MPFR_RNDN);
      mpfr_mul_d(Y[i], Y[i], t, MPFR_RNDN);
      mpfr_add_d(Y[i], Y[i], O[i], MPFR_RNDN);
      assert_true(!exact || mpfr_cmp_d(Y[i], X[i]) == 0);
    }
    barr_at(truth, e, n, Y);
    for (int tier = 0; tier < tiers; tier++) {
      qn_super_look s = qn_super_look_at(tier ? &finer : &c, t);
      mpfr_sub_d(difference, truth, s.over, MPFR_RNDN);
      double off = fabs(mpfr_get_d(difference, MPFR_RNDA));
      assert_true(off <= s.error);
      worst[tier] = fmax(worst[tier], off / s.error);
      near += fabs(s.over) < 1e-10;
      if (exact && e > 0 && !(X[0] == 0 && X[1] == 0)) { /* its error is that at the coordinates as rounded */
        barr_slope(difference, all, e, n, Y, D);
        mpfr_sub_d(difference, difference, s.slope, MPFR_RNDN);
        if (mpfr_number_p(all)) {
          double most = mpfr_get_d(all, MPFR_RNDA);
          assert_true(fabs(mpfr_get_d(difference, MPFR_RNDA)) <= QN_SUPER_RATE * most + QN_SUPER_FADED * 2 / c.size);
          assert_true(s.slope_error >= 0.99 * QN_SUPER_RATE * most);
          slopes++;
        }
      }
    }
  }
  for (int i = 0; i < 5; i++) {
    assert_true(inner[i] > share_min(300));
  }
  assert_true(near > share_min(10000) && slopes > share_min(5000));
  assert_true((!share_whole() || worst[0] > 0.1) && worst[1] < 1);
  mpfr_clears(truth, difference, all, Y[0], Y[1], Y[2], (mpfr_ptr)NULL);
  mpfr_free_cache();
}

/* The pairs are within their errors of the exact line; counts those without an error. Gives the largest share of an error that there is. */
static double checked_frame(bench *b, const qn_super_exact *line, const qn_super_frame *frame, int *exact) {
  double worst = 0;
  for (int k = 0; k < 6; k++) {
    const double *pair = k < 3 ? frame->O[k] : frame->D[k - 3];
    double off = k < 3 ? frame->O_off[k] : frame->D_off[k - 3];
    qn_num rest = SUB(SUB(k < 3 ? line->O[k] : line->D[k - 3], qn_num_from_double(&b->ctx, pair[0])), qn_num_from_double(&b->ctx, pair[1]));
    assert_true(fabs(qn_num_to_double(rest)) <= off);
    worst = off > 0 ? fmax(worst, fabs(qn_num_to_double(rest)) / off) : worst;
    *exact += off == 0;
  }
  return worst;
}

/* QN_SUPER_FRAME: rows and lines of random exact numbers, near the pivot and far from it. QN_SUPER_LOW and QN_SUPER_CRUDE: f along such a line, both tiers,
   near the coordinate planes too, against the exact line in 300 bits. */
static void frames_are_within_their_error(void **state) {
  bench *b = *state;
  mpfr_t truth, difference, Y[3];
  mpfr_inits2(300, truth, difference, Y[0], Y[1], Y[2], (mpfr_ptr)NULL);
  double worst[3] = {0, 0, 0};
  int exact = 0, exact_anew = 0, close = 0, given_up = 0, crude = 0;
  for (int round = 0; round < share_of(6000); round++) {
    qn_mark mark = qn_arena_mark(&b->ctx.arena);
    qn_super_rows rows;
    qn_num row[3][4], o[3], d[3], zero = QN_NUM_ZERO;
    double x[3], v[3], e = line_exponent(b), n = line_exponent(b), t = real(b, 0.5, 2);
    int dyadic = below(b, 3) == 0, turned = below(b, 2), far = below(b, 4) ? 3 : 40;
    if ((e == 1 && n == 1) || e > QN_SUPER_QUOTIENT * n || (e == 2 || n == 2)) {
      continue;
    }
    for (int j = 0; j < 3; j++) {
      rows.pivot[j] = ldexp(below(b, 2001) - 1000, -below(b, 8));
      v[j] = below(b, 6) ? (dyadic ? ldexp(below(b, 65) - 32, -4) : real(b, -1, 1)) : 0;
      x[j] = rows.pivot[j] - t * v[j] + ldexp(real(b, -1, 1), below(b, far));
      x[j] = dyadic ? ldexp(rint(ldexp(x[j], 8)), -8) : x[j];
      o[j] = qn_num_from_double(&b->ctx, x[j]);
      d[j] = qn_num_from_double(&b->ctx, v[j]);
    }
    qn_super_exact line = {.ctx = &b->ctx, .e = qn_num_from_double(&b->ctx, e), .n = qn_num_from_double(&b->ctx, n)};
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 4; j++) {
        qn_num r = dyadic ? qn_num_from_double(&b->ctx, ldexp(below(b, 17) - 8, -3)) : ratio(b, 1000, 1 + below(b, 999));
        row[i][j] = i == j || turned || j == 3 ? r : zero;
        qn_num_to_dd(&b->ctx, row[i][j], &rows.row[i][j][0], &rows.row[i][j][1]);
      }
      qn_num at = row[i][3];
      line.D[i] = zero;
      for (int j = 0; j < 3; j++) {
        at = ADD(at, MUL(row[i][j], SUB(o[j], qn_num_from_double(&b->ctx, rows.pivot[j]))));
        line.D[i] = ADD(line.D[i], MUL(row[i][j], d[j]));
      }
      line.O[i] = at;
    }
    qn_super_frame frame, near;
    qn_super_rows_finish(&rows);
    qn_num_to_dd(&b->ctx, line.e, &rows.e[0], &rows.e[1]);
    qn_num_to_dd(&b->ctx, line.n, &rows.n[0], &rows.n[1]);
    if (qn_super_frame_make(&rows, x, v, &frame)) {
      worst[0] = fmax(worst[0], checked_frame(b, &line, &frame, &exact));
      /* begun anew far away, at times where a coordinate is next to 0 */
      const int i = below(b, 3);
      const double far_away = below(b, 2) && frame.D[i][0] != 0 ? -frame.O[i][0] / frame.D[i][0] : ldexp(real(b, -1, 1), below(b, 60));
      qn_super_exact anew = line;
      if (below(b, 2)) { /* pairs whose own errors count: the line is as far off as they allow */
        for (int k = 0; k < 3; k++) {
          const double o_off = ldexp(1, -100 + below(b, 40)), d_off = ldexp(1, -100 + below(b, 40));
          anew.O[k] = ADD(line.O[k], qn_num_from_double(&b->ctx, o_off));
          anew.D[k] = ADD(line.D[k], qn_num_from_double(&b->ctx, far_away < 0 ? -d_off : d_off));
          frame.O_off[k] += o_off, frame.D_off[k] += d_off;
        }
      }
      qn_super_exact_begin(&anew, far_away);
      qn_super_frame_begin(&frame, far_away, &near);
      worst[2] = fmax(worst[2], checked_frame(b, &anew, &near, &exact_anew));
    }
    /* the line moved so that at t it is next to the surface, and at times a coordinate of it next to 0; then pairs with a greater error than they have */
    double X[3], error;
    for (int i = 0; i < 3; i++) {
      X[i] = real(b, -1, 1);
    }
    double s = pow(qn_superquadric_value(e, n, X, &error) + 1, -0.5 * n);
    for (int i = 0; i < 3; i++) {
      X[i] = below(b, 4) ? X[i] * s : ldexp(real(b, -1, 1), -below(b, 100));
      X[i] = fmax(-1, fmin(1, X[i]));
      line.O[i] = SUB(qn_num_from_double(&b->ctx, X[i]), MUL(line.D[i], qn_num_from_double(&b->ctx, t)));
    }
    qn_super_frame_from_exact(&line, &frame);
    near = frame;
    double off[3];
    for (int i = 0; i < 3; i++) {
      off[i] = below(b, 3) ? ldexp(1, -90 - below(b, 15)) : 0;
      near.O_off[i] = off[i] + frame.O_off[i];
    }
    qn_super_line c[2];
    if (qn_super_line_make(&near, 0, t, &c[0]) && qn_super_finer(&c[0], &c[1])) {
      for (int i = 0; i < 3; i++) { /* the truth at the far end of what the errors allow */
        mpfr_set_d(Y[i], X[i], MPFR_RNDN);
        mpfr_set_d(difference, below(b, 2) ? off[i] : -off[i], MPFR_RNDN);
        mpfr_add(Y[i], Y[i], difference, MPFR_RNDN);
      }
      barr_at(truth, e, n, Y);
      for (int tier = 0; tier < 2; tier++) {
        qn_super_look look = qn_super_look_at(&c[tier], t);
        if (!isfinite(look.error)) {
          given_up++;
          continue;
        }
        mpfr_sub_d(difference, truth, look.over, MPFR_RNDN);
        double is = fabs(mpfr_get_d(difference, MPFR_RNDA));
        assert_true(is <= look.error);
        worst[1] = fmax(worst[1], is / look.error);
        close += fabs(look.over) < 1e-10;
        crude += look.crude > 0x1p-20;
      }
    }
    qn_arena_release(&b->ctx.arena, mark);
  }
  assert_true(exact > share_min(2000) && close > share_min(500) && given_up > share_min(50) && crude > share_min(20));
  assert_true(exact_anew > share_min(1000) && worst[2] <= 1 && worst[2] > 0.6);
  assert_true(worst[0] < 1 && (!share_whole() || (worst[0] > 0.005 && worst[1] > 0.1)));
  mpfr_clears(truth, difference, Y[0], Y[1], Y[2], (mpfr_ptr)NULL);
  mpfr_free_cache();
}

/* A line begun anew where first doubles add up exactly and only second ones are rounded. */
static void begun_from_second_doubles(void **state) {
  bench *b = *state;
  qn_super_exact line = {.ctx = &b->ctx, .e = QN_NUM_ONE, .n = QN_NUM_ONE};
  for (int i = 0; i < 3; i++) {
    line.O[i] = ADD(qn_num_from_double(&b->ctx, 3 + i), qn_num_from_double(&b->ctx, ldexp(1 + 0x1p-50, -60 - i)));
    line.D[i] = ADD(qn_num_from_double(&b->ctx, 1), qn_num_from_double(&b->ctx, ldexp(1 + 0x1p-52, -55)));
  }
  qn_super_frame frame, begun;
  int exact = 0;
  qn_super_frame_from_exact(&line, &frame);
  for (int i = 0; i < 3; i++) {
    frame.O_off[i] = frame.D_off[i] = 0; /* the pairs are the line */
  }
  assert_true(checked_frame(b, &line, &frame, &exact) == 0 && exact == 6);
  qn_super_frame_begin(&frame, 8, &begun);
  qn_super_exact_begin(&line, 8);
  checked_frame(b, &line, &begun, &exact);
}

enum { MAX = 64 };

/* Checks the enclosures' order and the certain sign at their ends; gives the count. Roots from afar are places: their enclosures are made of what the exact root may be off by (S10). */
static size_t checked_roots(bench *b, double e, double n, const double O[3], const double D[3], double roots[MAX][2]) {
  size_t count = all_roots(b, e, n, O, D, roots, MAX);
  const double longest = 2 / fmax(fabs(D[0]), fmax(fabs(D[1]), fabs(D[2])));
  assert_true(count < MAX && count % 2 == 0);
  for (size_t i = 0; i < count; i++) {
    int before = i % 2 ? -1 : 1;
    if (roots[i][0] == roots[i][1]) {
      double t = roots[i][0], off = QN_SUPER_FINE * longest + 0.5 * (nextafter(fabs(t), INFINITY) - fabs(t));
      assert_true(fabs(t) > 0.9 * QN_SUPER_FAR * longest);
      roots[i][0] = nextafter(t - off, -INFINITY), roots[i][1] = nextafter(t + off, INFINITY);
    }
    assert_true(roots[i][0] < roots[i][1]);
    assert_true(i == 0 || roots[i - 1][1] <= roots[i][0]);
    assert_int_equal(exact_sign_at(b, e, n, O, D, roots[i][0]), before);
    assert_int_equal(exact_sign_at(b, e, n, O, D, roots[i][1]), -before);
  }
  return count;
}

static void random_ray(bench *b, double O[3], double D[3]) {
  for (int i = 0; i < 3; i++) {
    double p = real(b, -0.9, 0.9);
    D[i] = below(b, 6) ? real(b, -1, 1) : 0;
    O[i] = p;
  }
  D[below(b, 3)] += 1;
  double back = below(b, 4) ? 3 : 1000;
  for (int i = 0; i < 3; i++) {
    O[i] -= back * D[i];
  }
}

static void roots_bracket_the_sign(void **state) {
  bench *b = *state;
  int census[8] = {0};
  double widest = 0;
  for (int round = 0; round < share_of(1500); round++) {
    qn_mark mark = qn_arena_mark(&b->ctx.arena);
    double e = exponent(b), n = exponent(b), O[3], D[3], roots[MAX][2];
    random_ray(b, O, D);
    if (below(b, 10) == 0) {
      *(below(b, 2) ? &e : &n) = 0;
    }
    if (round % 4 == 0) { /* spiky, and a ray through two of the six arms */
      double A[3], B[3];
      e = real(b, 1.5, 6);
      n = real(b, e > 2 ? 0.3 : 2, 6);
      for (int i = 0; i < 3; i++) {
        A[i] = real(b, -0.02, 0.02);
        B[i] = real(b, -0.02, 0.02);
      }
      int arm = below(b, 3);
      A[arm] = real(b, 0.3, 0.9);
      B[(arm + 1 + below(b, 2)) % 3] = -real(b, 0.3, 0.9);
      for (int i = 0; i < 3; i++) {
        D[i] = B[i] - A[i];
        O[i] = A[i] - 3 * D[i];
      }
    }
    size_t count = checked_roots(b, e, n, O, D, roots);
    for (size_t i = 0; i < count; i++) {
      widest = fmax(widest, (roots[i][1] - roots[i][0]) / (1 + fabs(roots[i][0])));
    }
    assert_true(e > 2 || n > 2 || count <= 2);
    census[count < 7 ? count : 7]++;
    /* a walk along the ray in steps sees no change of sign that the roots do not have */
    double v, error;
    for (int i = 0; i < 400; i++) {
      double t = 997 + 6 * (i + 0.5) / 400, X[3];
      t = O[0] * O[0] + O[1] * O[1] + O[2] * O[2] > 1e4 ? t : t - 997; /* from 0 to 6, or about 1000 */
      for (int k = 0; k < 3; k++) {
        X[k] = fma(D[k], t, O[k]);
      }
      v = qn_superquadric_value(e, n, X, &error);
      int sign = v > error ? 1 : v < -error ? -1 : 0, expected = 1, close = 0;
      for (size_t k = 0; k < count; k++) {
        expected = t >= roots[k][1] ? -expected : expected;
        close |= t > roots[k][0] && t < roots[k][1];
      }
      assert_true(close || sign == 0 || sign == expected);
    }
    qn_arena_release(&b->ctx.arena, mark);
  }
  assert_true(census[0] > share_min(100) && census[2] > share_min(300) && census[4] > share_min(20));
  assert_true(widest < 0x1p-40);
}

/* Rays that graze: through a point next to the surface, at right angles to the normal, off by a power of two either way. A chord wider
   than 2^-40 of the size is found; a miss is a miss. */
static void grazing(void **state) {
  bench *b = *state;
  int hits = 0, misses = 0;
  for (int round = 0; round < share_of(400); round++) {
    qn_mark mark = qn_arena_mark(&b->ctx.arena);
    double e = real(b, 0.4, 1.9), n = real(b, 0.4, 1.9), X[3], g[3], D[3], O[3], error, roots[MAX][2];
    for (int i = 0; i < 3; i++) {
      X[i] = real(b, 0.2, 1) * (below(b, 2) ? 1 : -1);
    }
    int power_of_two = 4 + below(b, 46);
    double s = pow(qn_superquadric_value(e, n, X, &error) + 1, -0.5 * n), off = ldexp(below(b, 2) ? 1 : -1, -power_of_two);
    for (int i = 0; i < 3; i++) {
      X[i] *= s * (1 + off);
    }
    qn_superquadric_gradient(e, n, X, g);
    double other[3] = {real(b, -1, 1), real(b, -1, 1), real(b, -1, 1)};
    D[0] = g[1] * other[2] - g[2] * other[1];
    D[1] = g[2] * other[0] - g[0] * other[2];
    D[2] = g[0] * other[1] - g[1] * other[0];
    for (int i = 0; i < 3; i++) {
      O[i] = X[i] - 2 * D[i];
    }
    size_t count = checked_roots(b, e, n, O, D, roots);
    int at = exact_sign_at(b, e, n, O, D, 2); /* the point of the ray next to X */
    if (at < 0) {
      assert_int_equal(count, 2); /* its chord is wider than 2^-40: sqrt(2^-50) and a curvature of the order 1 */
      assert_true(roots[0][1] <= 2 && roots[1][0] >= 2);
      hits++;
    } else if (off > 0 && power_of_two < 40) { /* the tangent plane, moved outward by far more than D's rounding, misses a convex solid */
      assert_int_equal(count, 0);
      misses++;
    }
    qn_arena_release(&b->ctx.arena, mark);
  }
  assert_true(hits > share_min(100) && misses > share_min(30));
}

/* The quick searches and the careful one, each by itself: the same roots, and the quick ones nearly always answer. */
static void tiers_agree(void **state) {
  bench *b = *state;
  int rays = 0, unsure = 0, found[2] = {0, 0}, grazes = 0;
  for (int round = 0; round < share_of(6000); round++) {
    qn_mark mark = qn_arena_mark(&b->ctx.arena);
    double e = below(b, 4) ? real(b, 0.1, 2) : 0.5, n = below(b, 4) ? real(b, 0.1, 2) : 1, O[3], D[3], error;
    int kind = below(b, 4);
    e = kind == 0 || kind == 1 ? real(b, 2, 6) : e, n = kind == 0 || kind == 2 ? real(b, 2, 6) : n;
    e = below(b, 20) ? e : 0, e = below(b, 20) ? e : 2;
    random_ray(b, O, D);
    if (round % 3 == 0) { /* a chord from about 2^-1 to 2^-16 of the size, or a miss */
      double X[3], g[3], other[3];
      for (int i = 0; i < 3; i++) {
        X[i] = real(b, 0.2, 1) * (below(b, 2) ? 1 : -1);
        other[i] = real(b, -1, 1);
      }
      double s = pow(qn_superquadric_value(e, n, X, &error) + 1, -0.5 * n) * (1 + ldexp(below(b, 2) ? 1 : -1, -2 - below(b, 30)));
      X[0] *= s, X[1] *= s, X[2] *= s;
      qn_superquadric_gradient(e, n, X, g);
      for (int i = 0; i < 3; i++) {
        D[i] = g[(i + 1) % 3] * other[(i + 2) % 3] - g[(i + 2) % 3] * other[(i + 1) % 3];
        O[i] = X[i] - 2 * D[i];
      }
      grazes++;
    }
    double a, c, quick[MAX][2], careful[MAX][2];
    qn_super_exact exact;
    qn_super_frame frame;
    exactly(&(given){b, e, n, O, D}, &exact);
    qn_super_frame_from_exact(&exact, &frame);
    if (qn_super_clip(&frame, &a, &c)) {
      size_t more = qn_super_careful(&exact, careful, MAX);
      qn_super_line line;
      size_t count = 0;
      qn_super_answer answer;
      assert_true(qn_super_line_make(&frame, a, c, &line));
      double t0 = a, t1 = c;
      if (e <= 2 && n <= 2) {
        answer = qn_super_convex(&line, t0, t1, quick);
        count = answer == QN_SUPER_FOUND ? 2 : 0;
      } else {
        answer = qn_super_pieces(&line, t0, t1, quick, MAX, &count);
        qn_super_line hull; /* the narrowed stretch keeps every root */
        assert_true(line_make(b, fmin(e, 2), fmin(n, 2), O, D, a, c, &hull));
        if (qn_super_narrow(&hull, &t0, &t1) == QN_SUPER_NONE) {
          assert_int_equal(more, 0);
        } else {
          assert_true(t0 >= a && t1 <= c);
          assert_true(more == 0 || (t0 < careful[0][1] && t1 > careful[more - 1][0]));
        }
      }
      rays += round % 3 != 0;
      unsure += round % 3 != 0 && answer == QN_SUPER_UNSURE;
      if (answer != QN_SUPER_UNSURE) {
        assert_int_equal(count, more); /* no chord here is as narrow as 2^-40 */
        found[e > 2 || n > 2] += count > 0;
      }
      for (size_t i = 0; i < count && answer != QN_SUPER_UNSURE; i++) {
        assert_true(quick[i][0] < careful[i][1] && careful[i][0] < quick[i][1]);
        assert_true(quick[i][1] - quick[i][0] <= fmax(QN_SUPER_FINE * line.size, 8 * QN_STEP * fabs(quick[i][1])));
      }
      for (size_t i = 0; i < more && round % 4 == 0; i++) {
        int before = i % 2 ? -1 : 1;
        assert_int_equal(exact_sign_at(b, e, n, O, D, careful[i][0]), before);
        assert_int_equal(exact_sign_at(b, e, n, O, D, careful[i][1]), -before);
      }
    }
    qn_arena_release(&b->ctx.arena, mark);
  }
  assert_true(found[0] > share_min(700) && found[1] > share_min(1500) && grazes > share_min(1500));
  assert_true(rays > share_min(3000) && unsure * 500 < rays);
}

/* Known roots. */
static void known_roots(void **state) {
  bench *b = *state;
  double roots[MAX][2];
  double O[3] = {-5, 0, 0}, D[3] = {1, 0, 0};
  assert_int_equal(checked_roots(b, 0.5, 0.5, O, D, roots), 2);
  assert_true(roots[0][0] < 4 && 4 < roots[0][1] && roots[1][0] < 6 && 6 < roots[1][1]);
  double side_on[3] = {-5, 1, 0.25}; /* grazes the flat side's bulge: |y| = 1 is met at x = z = 0 only */
  assert_int_equal(all_roots(b, 0.5, 0.5, side_on, D, roots, MAX), 0);
  double beside[3] = {-5, 0.5, 0.5}, away[3] = {0, 1, 0};
  assert_int_equal(checked_roots(b, 0.5, 0.5, beside, away, roots), 0);
  /* astroid-like sections: a chord through one arm, one across two arms, which leaves the solid between them */
  double chord[3] = {-5, 0.1, 0};
  assert_int_equal(checked_roots(b, 3, 1, chord, D, roots), 2);
  double arms[3] = {-2, 1.3, 0}, slope[3] = {1, -0.5, 0}; /* y = 0.3 - x/2 */
  assert_int_equal(checked_roots(b, 5, 1, arms, slope, roots), 4);
  double parallel[3] = {0, 0, 5}, none[3] = {0, 0, 0};
  assert_int_equal(all_roots(b, 0.5, 0.5, parallel, none, roots, MAX), 0);
  assert_int_equal(all_roots(b, 0.5, 0.5, O, D, roots, 1), 1);
}

/* Support: above every sampled point of the surface, and close to the highest. */
static void support(void **state) {
  bench *b = *state;
  for (int round = 0; round < share_of(2000); round++) {
    double e = below(b, 6) ? exponent(b) : 0, n = below(b, 6) ? exponent(b) : 0, args[5] = {real(b, 0.1, 9), real(b, 0.1, 9), real(b, 0.1, 9), e, n};
    double v[3] = {real(b, -1, 1), real(b, -1, 1), real(b, -1, 1)}, best = 0, error;
    double bound = qn_prims[QN_SUPERQUADRIC].support(args, 5, NULL, v);
    assert_true(isfinite(bound));
    for (int i = 0; i < 40; i++) {
      double X[3] = {real(b, -1, 1), real(b, -1, 1), real(b, -1, 1)}, d[3];
      if (i == 0) { /* the place itself, where the dual norm's gradient points: X = grad of the dual norm at (a v_x, b v_y, c v_z) */
        for (int k = 0; k < 3; k++) {
          X[k] = args[k] * v[k];
        }
        double e2 = e < 2 ? 2 - e : 0, n2 = n < 2 ? 2 - n : 0;
        qn_superquadric_gradient(e2, n2, X, d);
        memcpy(X, d, sizeof d);
      }
      double f = qn_superquadric_value(e, n, X, &error) + 1, s = n > 0 ? pow(f, -0.5 * n) : 1 / f, h = 0;
      s *= 1 - 0x1p-45; /* just inside, whatever pow's last bits */
      for (int k = 0; k < 3; k++) {
        X[k] *= s;
        h += args[k] * v[k] * X[k];
      }
      double g = qn_superquadric_value(e, n, X, &error);
      if (isfinite(h) && g <= error) {
        assert_true(h <= bound);
        best = h > best ? h : best;
      }
    }
    assert_true(best >= bound * (1 - (n < 0.1 || e < 0.1 ? 1e-9 : 1e-12)));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(value_is_within_its_error, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(slope_is_within_its_error, setup_bench, teardown_bench),
    cmocka_unit_test(zero_exponents),
    cmocka_unit_test_setup_teardown(gradient_is_the_functions, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(exact_exponents, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(signs, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(line_is_within_its_error, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(frames_are_within_their_error, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(begun_from_second_doubles, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(known_roots, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(roots_bracket_the_sign, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(grazing, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(tiers_agree, setup_bench, teardown_bench),
    cmocka_unit_test_setup_teardown(support, setup_bench, teardown_bench),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
