/* The filter's bounds in rationals: numbers biased towards cancellation, tangency and structural zeros; each bound is
   compared with the exact error, and each certain answer with the exact roots. Names as in base/bounds.h. */
#include "base/bounds.h"
#include "ray/scratch.h"
#include "share.h"

#include <float.h>
#include <gmp.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static uint64_t seed = 0x9e3779b97f4a7c15u;
static uint64_t next(void) {
  seed ^= seed << 13;
  seed ^= seed >> 7;
  seed ^= seed << 17;
  return seed;
}
static int one_in(unsigned n) { return next() % n == 0; }

/* A double of magnitude about 2^low .. 2^high, with few or many bits. */
static double number(int low, int high) {
  double m = (double)(next() >> 11) * 0x1p-53 + 0.5;
  if (one_in(3)) {
    m = ldexp(floor(ldexp(m, 4)), -4);
  }
  int e = low + (int)(next() % (uint64_t)(high - low + 1));
  return (next() & 1 ? -1 : 1) * ldexp(m, e);
}

/* v times 1 + theta u, theta in [-1, 1], often an end. */
static void spread(mpq_t out, double v) {
  mpq_t f;
  mpq_init(f);
  mpq_set_d(out, v);
  uint64_t k = next() % 4;
  mpq_set_si(f, k == 0 ? 0 : k == 1 ? 1000 : k == 2 ? -1000 : (long)(next() % 2001) - 1000, 1000);
  mpq_canonicalize(f);
  mpq_div_2exp(f, f, 53);
  mpq_mul(f, f, out);
  mpq_add(out, out, f);
  mpq_clear(f);
}

typedef struct truth { mpq_t o[3], d[3], row[3][4], s[3], l, k, a, h, c, disc, t, u, v; } truth;
static truth T;

static void all(void (*f)(mpq_ptr)) {
  mpq_t *each = T.o;
  for (size_t i = 0; i < sizeof T / sizeof *each; i++) {
    f(((mpq_t *)(void *)&T)[i]);
  }
}

/* Exact p at start: a, h, c, disc. */
static void exact_form(const double pivot[3], double start) {
  mpq_t y[3], O, D;
  mpq_inits(y[0], y[1], y[2], O, D, (mpq_ptr)0);
  for (int j = 0; j < 3; j++) {
    mpq_set_d(T.t, pivot[j]);
    mpq_sub(y[j], T.o[j], T.t);
    mpq_set_d(T.t, start);
    mpq_mul(T.t, T.t, T.d[j]);
    mpq_add(y[j], y[j], T.t);
  }
  mpq_set_si(T.a, 0, 1);
  mpq_set_si(T.h, 0, 1);
  mpq_set(T.c, T.k);
  for (int i = 0; i < 3; i++) {
    mpq_set(O, T.row[i][3]);
    mpq_set_si(D, 0, 1);
    for (int j = 0; j < 3; j++) {
      mpq_mul(T.t, T.row[i][j], y[j]);
      mpq_add(O, O, T.t);
      mpq_mul(T.t, T.row[i][j], T.d[j]);
      mpq_add(D, D, T.t);
    }
    mpq_mul(T.t, D, D);
    mpq_mul(T.t, T.t, T.s[i]);
    mpq_add(T.a, T.a, T.t);
    mpq_mul(T.t, O, D);
    mpq_mul(T.t, T.t, T.s[i]);
    mpq_add(T.h, T.h, T.t);
    mpq_mul(T.t, O, O);
    mpq_mul(T.t, T.t, T.s[i]);
    mpq_add(T.c, T.c, T.t);
    if (i == 2) {
      mpq_mul(T.t, T.l, D);
      mpq_add(T.h, T.h, T.t);
      mpq_mul(T.t, T.l, O);
      mpq_add(T.c, T.c, T.t);
      mpq_add(T.c, T.c, T.t);
    }
  }
  mpq_mul(T.disc, T.h, T.h);
  mpq_mul(T.t, T.a, T.c);
  mpq_sub(T.disc, T.disc, T.t);
  mpq_clears(y[0], y[1], y[2], O, D, (mpq_ptr)0);
}

/* |computed - exact| / bound; asserts it is at most 1, and that bound 0 means equal. */
static double ratio(double computed, const mpq_t exact, double bound) {
  mpq_t e, b;
  mpq_inits(e, b, (mpq_ptr)0);
  mpq_set_d(e, computed);
  mpq_sub(e, e, exact);
  mpq_abs(e, e);
  mpq_set_d(b, bound);
  assert_true(mpq_cmp(e, b) <= 0);
  double r = 0;
  if (bound > 0) {
    mpq_div(e, e, b);
    r = mpq_get_d(e);
  }
  mpq_clears(e, b, (mpq_ptr)0);
  return r;
}

/* Sign of p at t + shift e, p of the line's own parameter when the form was made at start. */
static int sign_at(double t, double e, int side, double start) {
  mpq_set_d(T.t, t);
  mpq_set_d(T.u, e);
  if (side < 0) {
    mpq_sub(T.t, T.t, T.u);
  } else {
    mpq_add(T.t, T.t, T.u);
  }
  mpq_set_d(T.u, start);
  mpq_sub(T.t, T.t, T.u);
  mpq_mul(T.u, T.a, T.t);
  mpq_add(T.u, T.u, T.h);
  mpq_add(T.u, T.u, T.h);
  mpq_mul(T.u, T.u, T.t);
  mpq_add(T.u, T.u, T.c);
  return mpq_sgn(T.u);
}

typedef struct census {
  unsigned certain, uncertain, none, one, two, zero, near_tangent, near_tangent_certain, tiny, rounded, a_zero, far;
  double map_a, map_h, map_c, disc, widest;
} census;

static void judge(const qn_filtered *f, double start, census *c) {
  int sign = mpq_sgn(T.a) ? mpq_sgn(T.a) : mpq_sgn(T.h) ? -mpq_sgn(T.h) : mpq_sgn(T.c);
  assert_int_equal(f->sign, sign);
  if (f->count == 0) {
    assert_true(mpq_sgn(T.a) ? mpq_sgn(T.disc) < 0 : mpq_sgn(T.h) == 0);
    c->none++;
    c->zero += sign == 0;
    return;
  }
  assert_int_equal(f->count, mpq_sgn(T.a) ? 2 : 1);
  c->one += f->count == 1;
  c->two += f->count == 2;
  for (int i = 0; i < f->count; i++) {
    double t = f->at[i].t, e = f->at[i].e;
    int before = sign_at(t, e, -1, start), after = sign_at(t, e, 1, start);
    assert_true(before == 0 || before == (i == 0 ? sign : -sign));
    assert_true(after == 0 || after == (i == 0 ? -sign : sign));
    if (t != 0 && mpq_sgn(T.a) && e / fabs(t) > c->widest) {
      c->widest = e / fabs(t);
    }
  }
  if (f->count == 2) {
    assert_true(f->at[1].t - f->at[0].t > f->at[0].e + f->at[1].e);
  }
}

/* A line, its exact form in T, and a pivot. */
static void random_line(qn_line *line, double pivot[3], census *c) {
  memset(line, 0, sizeof *line);
  int rounded = one_in(3), far = one_in(4), aligned = one_in(3), near = !far && one_in(3);
  int place = one_in(2) ? 0 : (int)(next() % 40);
  for (int j = 0; j < 3; j++) {
    pivot[j] = place ? number(place, place) : one_in(3) ? 0 : number(-4, 4);
    double off = far ? number(10, 40) : number(-3, 5);
    line->o[j] = near && one_in(2) ? pivot[j] : pivot[j] + off;
    line->d[j] = aligned && one_in(2) ? 0 : number(-3, 3);
    if (one_in(40)) {
      line->d[j] = number(-160, -60);
    }
    if (one_in(40)) {
      line->o[j] = number(-160, -60);
    }
  }
  if (line->d[0] == 0 && line->d[1] == 0 && line->d[2] == 0) {
    line->d[next() % 3] = 1;
  }
  if (far) { /* aimed at the pivot, more or less */
    double t = number(10, 40);
    for (int j = 0; j < 3; j++) {
      line->o[j] = pivot[j] + number(-3, 1) - t * line->d[j];
    }
  }
  line->rounded = rounded;
  for (int j = 0; j < 3; j++) {
    mpq_set_d(T.o[j], line->o[j]);
    mpq_set_d(T.d[j], line->d[j]);
    if (rounded) {
      spread(T.o[j], line->o[j]);
      spread(T.d[j], line->d[j]);
    }
  }
  c->rounded += (unsigned)rounded;
  c->far += (unsigned)far;
}

static void test_quadrics(void **state) {
  (void)state;
  census c = {0};
  all(mpq_init);
  for (int n = 0; n < share_of(60000); n++) {
    qn_line line;
    double pivot[3];
    random_line(&line, pivot, &c);
    qn_quadric_shadow q = {0};
    int tiny = one_in(4), diagonal = one_in(3), scale = (int)(next() % 7) - 3;
    static const double signs[6][5] = {{1, 1, 1, 0, -1}, {1, 1, 0, 0, -1}, {1, 1, -1, 0, 0}, {1, 1, 0, -0.5, 0}, {1, 1, -1, 0, -1}, {1, -1, 0, -0.5, 0}};
    const double *kind = signs[next() % 6];
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 4; j++) {
        q.row[i][j] = diagonal ? (i == j ? ldexp(1, scale) : 0) : j == 3 && one_in(2) ? 0 : one_in(8) ? 0 : number(scale - 2, scale);
        if (tiny && one_in(4)) {
          q.row[i][j] = number(-160, -60);
        }
      }
      q.s[i] = one_in(2) ? kind[i] : kind[i] * fabs(number(-2, 2));
    }
    q.l = kind[3] != 0 ? number(-2, 2) : 0;
    q.k = kind[4] * fabs(number(-2, 2));
    if (tiny && one_in(8)) {
      q.l = number(-100, -60);
    }
    if (diagonal && one_in(3) && !line.rounded) { /* towards an asymptote, or nearly */
      double v[3] = {3, 4, 5};
      for (int j = 0; j < 3; j++) {
        line.d[j] = v[j] + (one_in(6) ? number(-50, -20) : 0);
        mpq_set_d(T.d[j], line.d[j]);
      }
    }
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 4; j++) {
        spread(T.row[i][j], q.row[i][j]);
      }
      spread(T.s[i], q.s[i]);
    }
    spread(T.l, q.l);
    mpq_set_si(T.k, 0, 1);
    int tangent = one_in(3);
    if (tangent) { /* k so that disc is small beside h^2: c = h^2/a */
      exact_form(pivot, 0);
      if (mpq_sgn(T.a)) {
        mpq_div(T.t, T.disc, T.a);
        double k = mpq_get_d(T.t), off = ldexp((double)((int)(next() % 3) - 1), -(int)(next() % 60));
        if (fabs(k) < 0x1p60) {
          q.k = k * (1 + off);
        }
      }
    }
    spread(T.k, q.k);
    double flat[17];
    memcpy(flat, q.row, sizeof q.row);
    memcpy(flat + 12, q.s, sizeof q.s);
    flat[15] = q.l;
    flat[16] = q.k;
    int range = qn_filter_range(flat, 17);
    if (range == 0) {
      continue;
    }
    qn_filter_line fl;
    qn_filter_line_make(&line, &fl);
    if (fl.wild) {
      continue;
    }
    qn_filter_leaf frame;
    qn_filter_leaf_begin(&fl, pivot, &frame);
    qn_filter_form f;
    qn_filter_form_make(&fl, &frame, &q, range == 2, &f);
    exact_form(pivot, f.start);
    c.map_a = fmax(c.map_a, ratio(f.a, T.a, f.ea));  /* QN_QUAD_A_E */
    c.map_h = fmax(c.map_h, ratio(f.h, T.h, f.eh));  /* QN_QUAD_H_E */
    c.map_c = fmax(c.map_c, ratio(f.c, T.c, f.ec));  /* QN_QUAD_C_E, QN_QUAD_K_E */
    c.disc = fmax(c.disc, ratio(f.disc, T.disc, f.ed)); /* QN_DISC_E */
    qn_filtered out;
    int certain = qn_filter_quadric(&fl, &frame, &q, range == 2, &out);
    c.certain += (unsigned)certain;
    c.uncertain += (unsigned)!certain;
    c.tiny += range == 2;
    c.near_tangent += (unsigned)tangent;
    c.near_tangent_certain += (unsigned)(tangent && certain);
    c.a_zero += f.ea == 0;
    if (certain) {
      judge(&out, f.start, &c); /* QN_ROOT_E */
    }
  }
  all(mpq_clear);
  print_message("error/bound: a %.3f h %.3f c %.3f disc %.3f; certain %u, uncertain %u, none %u, one %u, two %u, tangent %u (certain %u), tiny %u, a zero %u, far %u\n",
                c.map_a, c.map_h, c.map_c, c.disc, c.certain, c.uncertain, c.none, c.one, c.two, c.near_tangent, c.near_tangent_certain, c.tiny, c.a_zero, c.far);
  assert_true(c.certain > share_min(20000) && c.uncertain > share_min(2000) && c.none > share_min(5000) && c.one > share_min(200) && c.two > share_min(5000) && c.near_tangent > share_min(10000));
  assert_true(c.near_tangent_certain > share_min(3000) && c.tiny > share_min(5000) && c.rounded > share_min(10000) && c.a_zero > share_min(200) && c.far > share_min(8000));
  assert_true(!share_whole() || (c.map_a > 0.1 && c.map_h > 0.1 && c.map_c > 0.1 && c.disc > 0.05)); /* the data come near the bounds */
}

static void test_planes(void **state) {
  (void)state;
  census c = {0};
  double nearest = 0;
  all(mpq_init);
  for (int n = 0; n < share_of(60000); n++) {
    qn_line line;
    double pivot[3];
    random_line(&line, pivot, &c);
    qn_plane_shadow p;
    for (int j = 0; j < 3; j++) {
      p.n[j] = one_in(3) ? 0 : one_in(10) ? number(-160, -60) : number(-2, 2);
    }
    p.d = one_in(4) ? 0 : number(-3, 3);
    if (one_in(3)) { /* through the origin, nearly */
      p.d = -(p.n[0] * (line.o[0] - pivot[0]) + p.n[1] * (line.o[1] - pivot[1]) + p.n[2] * (line.o[2] - pivot[2]));
    }
    double flat[4] = {p.n[0], p.n[1], p.n[2], p.d};
    int range = qn_filter_range(flat, 4);
    qn_filter_line fl;
    qn_filter_line_make(&line, &fl);
    if (range == 0 || fl.wild) {
      continue;
    }
    for (int i = 0; i < 3; i++) {
      mpq_set_si(T.s[i], 0, 1);
      for (int j = 0; j < 4; j++) {
        mpq_set_si(T.row[i][j], 0, 1);
      }
    }
    for (int j = 0; j < 3; j++) {
      spread(T.row[2][j], p.n[j]);
    }
    spread(T.row[2][3], p.d);
    mpq_set_si(T.l, 1, 2); /* p = 2 l X_2 */
    mpq_set_si(T.k, 0, 1);
    exact_form(pivot, 0);
    qn_filter_leaf frame;
    qn_filter_leaf_begin(&fl, pivot, &frame);
    qn_filtered out;
    int certain = qn_filter_plane(&fl, &frame, &p, range == 2, &out);
    c.certain += (unsigned)certain;
    c.uncertain += (unsigned)!certain;
    if (certain) {
      judge(&out, 0, &c);
      if (out.count == 1) { /* how near the error comes to the enclosure */
        mpq_div(T.t, T.c, T.h);
        mpq_div_2exp(T.t, T.t, 1);
        mpq_neg(T.t, T.t);
        nearest = fmax(nearest, ratio(out.at[0].t, T.t, out.at[0].e));
      }
    }
  }
  all(mpq_clear);
  print_message("planes: error/enclosure %.3f; certain %u, uncertain %u, none %u, one %u, zero %u\n", nearest, c.certain, c.uncertain, c.none, c.one, c.zero);
  assert_true(c.certain > share_min(20000) && c.uncertain > share_min(500) && c.none > share_min(1000) && c.one > share_min(20000) && (!share_whole() || nearest > 0.1));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_planes), cmocka_unit_test(test_quadrics)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
