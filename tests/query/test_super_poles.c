/* Superquadrics grazed where they are flat (design S10). Rays parallel to an axis of the solid have stretches in closed form: with the other two
   coordinates exact rationals of the ray's doubles and the model's decimals, and powers to 400 bits, the truth is known to 2^-390 or so. Rays run within some last bits
   of a pole's plane or a side's, where a coordinate rounded to a double would lose a stretch much wider than 2^-40 of the solid. */
#include "ask.h"
#include "share.h"

#include <gmp.h>
#include <math.h>
#include <mpfr.h>

enum { BITS = 400 };

typedef struct solid { const char *centre[3], *radius[3], *e, *n; } solid;

/* A decimal without an exponent. */
static void decimal(mpq_t out, const char *text) {
  char digits[64];
  size_t k = 0, places = 0;
  int after = 0;
  for (const char *c = text; *c; c++) {
    if (*c == '.') {
      after = 1;
    } else {
      digits[k++] = *c;
      places += (size_t)(after && *c != '-');
    }
  }
  digits[k] = 0;
  assert_int_equal(mpz_set_str(mpq_numref(out), digits, 10), 0);
  mpz_ui_pow_ui(mpq_denref(out), 10, places);
  mpq_canonicalize(out);
}

/* |x|^y, y > 0 */
static void power(mpfr_t out, mpfr_t x, mpfr_t y) {
  mpfr_abs(out, x, MPFR_RNDN);
  mpfr_pow(out, out, y, MPFR_RNDN);
}

/* Where the line through o along the axis with speed d meets the solid: 1 with the ends, *size 2 radius / |d|; 0 when it does not, or in a point. */
static int truth(const solid *s, const double o[3], int axis, double d, mpfr_t ends[2], double *size) {
  mpq_t c, r, x;
  mpq_inits(c, r, x, NULL);
  mpfr_t e, n, X[3], p, k, rest;
  mpfr_inits2(BITS, e, n, X[0], X[1], X[2], p, k, rest, (mpfr_ptr)NULL);
  for (int i = 0; i < 3; i++) {
    decimal(c, s->centre[i]);
    decimal(r, s->radius[i]);
    mpq_set_d(x, o[i]);
    mpq_sub(x, x, c);
    mpq_div(x, x, r);
    mpfr_set_q(X[i], x, MPFR_RNDN);
  }
  decimal(x, s->e);
  mpfr_set_q(e, x, MPFR_RNDN);
  decimal(x, s->n);
  mpfr_set_q(n, x, MPFR_RNDN);
  /* rest: what the moving coordinate may be at most, from (|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n) = 1 */
  mpfr_ui_div(p, 2, n, MPFR_RNDN);
  if (axis < 2) {
    power(rest, X[2], p);
    mpfr_ui_sub(rest, 1, rest, MPFR_RNDN);
    if (mpfr_sgn(rest) > 0) {
      mpfr_div(k, n, e, MPFR_RNDN);
      mpfr_pow(rest, rest, k, MPFR_RNDN);
      mpfr_ui_div(p, 2, e, MPFR_RNDN);
      power(k, X[1 - axis], p);
      mpfr_sub(rest, rest, k, MPFR_RNDN);
    }
  } else {
    mpfr_ui_div(p, 2, e, MPFR_RNDN);
    power(rest, X[0], p);
    power(k, X[1], p);
    mpfr_add(rest, rest, k, MPFR_RNDN);
    mpfr_div(k, e, n, MPFR_RNDN);
    mpfr_pow(rest, rest, k, MPFR_RNDN);
    mpfr_ui_sub(rest, 1, rest, MPFR_RNDN);
    mpfr_ui_div(p, 2, n, MPFR_RNDN);
  }
  int hit = mpfr_sgn(rest) > 0;
  if (hit) {
    mpfr_ui_div(p, 1, p, MPFR_RNDN);
    mpfr_pow(rest, rest, p, MPFR_RNDN);
    for (int way = -1; way < 2; way += 2) { /* t = (way rest - X) r / d */
      mpfr_ptr t = ends[(way > 0) == (d > 0)];
      mpfr_mul_si(t, rest, way, MPFR_RNDN);
      mpfr_sub(t, t, X[axis], MPFR_RNDN);
      decimal(r, s->radius[axis]);
      mpfr_mul_q(t, t, r, MPFR_RNDN);
      mpfr_div_d(t, t, d, MPFR_RNDN);
    }
  }
  decimal(r, s->radius[axis]);
  *size = 2 * mpq_get_d(r) / fabs(d);
  mpfr_clears(e, n, X[0], X[1], X[2], p, k, rest, (mpfr_ptr)NULL);
  mpq_clears(c, r, x, NULL);
  return hit;
}

/* The last bit of t. */
static double last_bit(double t) { return nextafter(fabs(t), INFINITY) - fabs(t); }

/* Asks; 1 when the truth is a stretch that S10 promises, 0 when it is none, -1 when it is narrower, or than t's last bit. */
static int judged(const ask *a, const solid *s, const double o[3], int axis, double d) {
  mpfr_t ends[2], off;
  mpfr_inits2(BITS, ends[0], ends[1], off, (mpfr_ptr)NULL);
  double size;
  int hit = truth(s, o, axis, d, ends, &size);
  quoin_ray ray = {{o[0], o[1], o[2]}, {0, 0, 0}, -INFINITY, INFINITY};
  ray.d[axis] = d;
  quoin_intervals found;
  assert_int_equal(quoin_ray_intervals(a->scene, a->work, &ray, 0, &found), QUOIN_OK);
  if (hit) {
    const double last = fmax(last_bit(mpfr_get_d(ends[0], MPFR_RNDN)), last_bit(mpfr_get_d(ends[1], MPFR_RNDN)));
    mpfr_sub(off, ends[1], ends[0], MPFR_RNDN);
    hit = mpfr_cmp_d(off, fmax(size * 0x1p-40, last)) > 0 ? 1 : -1;
  }
  if (hit == 1) {
    assert_int_equal(found.count, 1);
  } else if (hit == 0) {
    assert_int_equal(found.count, 0);
  }
  for (size_t i = 0; hit == 1 && i < 2; i++) {
    double t = i ? found.inside[0].leave.t : found.inside[0].enter.t;
    mpfr_sub_d(off, ends[i], t, MPFR_RNDN);
    assert_true(fabs(mpfr_get_d(off, MPFR_RNDA)) <= 0x1p-44 * size + (fabs(t) > 0x1p10 * size ? 0.5 : 8) * last_bit(t)); /* from afar: rounded once */
  }
  mpfr_clears(ends[0], ends[1], off, (mpfr_ptr)NULL);
  return hit;
}

static void open_solid(ask *a, const solid *s) {
  char text[512];
  int n = snprintf(text, sizeof text, "translate([%s,%s,%s]) superquadric(r=[%s,%s,%s],e=%s,n=%s);", s->centre[0], s->centre[1], s->centre[2], s->radius[0], s->radius[1], s->radius[2],
                   s->e, s->n);
  assert_true(n > 0 && (size_t)n < sizeof text);
  ask_open(a, text);
}

/* The sign of f - 1 at t, to 400 bits. */
static int sign_at(const solid *s, const double o[3], const double d[3], double t) {
  mpq_t c, r, x, y;
  mpq_inits(c, r, x, y, NULL);
  mpfr_t p[2], X[3], ratio;
  mpfr_inits2(BITS, p[0], p[1], X[0], X[1], X[2], ratio, (mpfr_ptr)NULL);
  for (int k = 0; k < 2; k++) {
    decimal(c, k ? s->n : s->e);
    mpfr_set_q(ratio, c, MPFR_RNDN);
    mpfr_ui_div(p[k], 2, ratio, MPFR_RNDN);
  }
  for (int i = 0; i < 3; i++) { /* |X_i| to its power */
    decimal(c, s->centre[i]);
    decimal(r, s->radius[i]);
    mpq_set_d(x, t);
    mpq_set_d(y, d[i]);
    mpq_mul(x, x, y);
    mpq_set_d(y, o[i]);
    mpq_add(x, x, y);
    mpq_sub(x, x, c);
    mpq_div(x, x, r);
    mpfr_set_q(X[i], x, MPFR_RNDN);
    power(X[i], X[i], p[i == 2]);
  }
  mpfr_add(X[0], X[0], X[1], MPFR_RNDN);
  mpfr_div(ratio, p[1], p[0], MPFR_RNDN);
  mpfr_pow(X[0], X[0], ratio, MPFR_RNDN);
  mpfr_add(X[0], X[0], X[2], MPFR_RNDN);
  int sign = mpfr_cmp_ui(X[0], 1);
  mpfr_clears(p[0], p[1], X[0], X[1], X[2], ratio, (mpfr_ptr)NULL);
  mpq_clears(c, r, x, y, NULL);
  return sign;
}

/* A gap of 2^-19 between two stretches, nearly a tangent: the search for it ended before it was found. */
static void gap(void **state) {
  (void)state;
  const solid s = {{"-5", "-1.5", "0"}, {"0.01", "3.98", "3.60"}, "1.9", "8"};
  const quoin_ray ray = {{-4.9906176571252709, -3.7207982005882316, -5.2436101539446884}, {-0.0033848385355713644, 0.82305555699640209, 2.1195183452422079}, -INFINITY, INFINITY};
  const double places[7] = {2.43, 2.48, 2.6, 2.70708, 2.70733454, 2.75, 2.78};
  ask a;
  open_solid(&a, &s);
  quoin_intervals found;
  assert_int_equal(quoin_ray_intervals(a.scene, a.work, &ray, 0, &found), QUOIN_OK);
  assert_int_equal(found.count, 3);
  for (size_t i = 0; i < 7; i++) {
    assert_true(i % 2 ? sign_at(&s, ray.o, ray.d, places[i]) < 0 : sign_at(&s, ray.o, ray.d, places[i]) > 0);
    assert_true(i == 0 || (i % 2 ? found.inside[i / 2].enter.t < places[i] : found.inside[i / 2 - 1].leave.t < places[i]));
    assert_true(i == 6 || (i % 2 ? found.inside[i / 2].leave.t > places[i] : found.inside[i / 2].enter.t > places[i]));
  }
  ask_close(&a);
}

/* The ray that was answered as a miss: z/1.3 - 1 is -8.5e-18, the stretch 2^-13 of the solid. */
static void known(void **state) {
  (void)state;
  const solid s = {{"3.6", "4", "-1"}, {"0.2", "0.01", "1.3"}, "3", "0.5"};
  const double o[3] = {3.1428249999999998, 4, 0.29999999999999999};
  ask a;
  open_solid(&a, &s);
  assert_int_equal(judged(&a, &s, o, 0, 0.51249999999999996), 1);
  ask_close(&a);
}

/* Some last bits from the planes that bound the solid, in the middle and beside it; each of the three planes, both ways across it. */
static void poles(void **state) {
  (void)state;
  static const char *const centres[] = {"3.6", "4", "-1", "0.7", "-100.3", "0", "1234567.8", "0.001"}, *const radii[] = {"0.2", "0.01", "1.3", "7", "0.3", "1", "1000.1", "0.00003"},
                    *const exponents[] = {"0.5", "3", "0.3", "1", "0.1", "2", "0.7", "1.9", "0.05", "2.5", "6", "0.004"};
  uint64_t seed = 1;
  int census[3] = {0, 0, 0};
  for (int round = 0; round < share_of(1500); round++) {
    uint64_t x[12];
    for (int i = 0; i < 12; i++) {
      seed = seed * 6364136223846793005u + 1442695040888963407u;
      x[i] = seed >> 40;
    }
    solid s = {.e = exponents[x[0] % 12], .n = exponents[x[1] % 12]};
    if (s.e == s.n && x[0] % 12 == 3) {
      continue; /* an ellipsoid: exact */
    }
    double centre[3], radius[3], o[3];
    for (size_t i = 0; i < 3; i++) {
      s.centre[i] = centres[x[2 + i] % 8], s.radius[i] = radii[x[5 + i] % 8];
      centre[i] = atof(s.centre[i]), radius[i] = atof(s.radius[i]);
      o[i] = centre[i];
    }
    int plane = (int)(x[8] % 3), axis = (plane + 1 + (int)(x[9] & 1)) % 3, third = 3 - plane - axis;
    o[plane] = centre[plane] + (x[9] & 2 ? 1 : -1) * radius[plane];
    for (int i = 0; i < (int)(x[10] % 4); i++) {
      o[plane] = nextafter(o[plane], x[10] & 16 ? centre[plane] : 2 * o[plane] - centre[plane]);
    }
    o[axis] -= (x[11] & 1 ? 2.5 : 1000) * radius[axis];
    o[third] += x[11] & 2 ? 0 : (x[11] & 4 ? 0.01 : 1e-5) * radius[third];
    ask a;
    open_solid(&a, &s);
    census[judged(&a, &s, o, axis, (x[11] & 8 ? 0.5125 : -3) * radius[axis]) + 1]++;
    ask_close(&a);
  }
  assert_true(census[0] > share_min(50) && census[1] > share_min(500) && census[2] > share_min(200));
}

/* From so far away that the solid is a few of t's last bits: to 2^52 of its sizes. */
static void from_afar(void **state) {
  (void)state;
  static const char *const radii[] = {"0.2", "1.3", "7", "1", "5", "2.32"}, *const exponents[] = {"0.5", "3", "0.3", "1", "2", "0.7", "1.9", "2.5", "6", "8", "0.001"};
  uint64_t seed = 7;
  int census[3] = {0, 0, 0}, few = 0;
  for (int round = 0; round < share_of(3000); round++) {
    uint64_t x[12];
    for (int i = 0; i < 12; i++) {
      seed = seed * 6364136223846793005u + 1442695040888963407u;
      x[i] = seed >> 40;
    }
    solid s = {.centre = {"0", "-0.5", "0.3"}, .e = exponents[x[0] % 11], .n = exponents[x[1] % 11]};
    if (x[0] % 11 == 3 && x[1] % 11 == 3) {
      continue; /* an ellipsoid: exact */
    }
    double o[3], radius[3];
    for (size_t i = 0; i < 3; i++) {
      s.radius[i] = radii[x[2 + i] % 6], radius[i] = atof(s.radius[i]);
      o[i] = atof(s.centre[i]) + (x[5 + i] & 1 ? 0 : radius[i] * ldexp((double)(x[5 + i] >> 1) - 0x1p22, -22 - (int)(x[8] % 8)));
    }
    const int axis = (int)(x[9] % 3), back = 3 + (int)(x[10] % 50);
    if (x[11] & 1) { /* near a pole's plane */
      const int plane = (axis + 1 + (x[11] & 2 ? 1 : 0)) % 3;
      o[plane] = atof(s.centre[plane]) + radius[plane] * (1 - ldexp(1, -(int)(x[11] >> 2 & 15) - 2));
    }
    o[axis] -= ldexp(1, back) * radius[axis];
    ask a;
    open_solid(&a, &s);
    const int hit = judged(&a, &s, o, axis, (x[11] & 64 ? 0.5125 : -3) * radius[axis]);
    census[hit + 1]++;
    few += hit == 1 && back > 46;
    ask_close(&a);
  }
  assert_true(census[0] > share_min(20) && census[1] > share_min(300) && census[2] > share_min(1000) && few > share_min(80));
}

/* Beside a ruling of n = 2, from beside the tip to beside the rim: f is 1 but for some 2^-50 all along. Most of these lines were refused. */
static void rulings(void **state) {
  (void)state;
  uint64_t seed = 5;
  int inside = 0, outside = 0, places = 0;
  for (int round = 0; round < share_of(60); round++) {
    const solid s = {{"0", "0", "0"}, {"1", "1", "1"}, round % 2 ? "3" : "0.7", "2"};
    const double p = 2 / atof(s.e);
    double x[8];
    for (int i = 0; i < 8; i++) {
      seed = seed * 6364136223846793005u + 1442695040888963407u;
      x[i] = (double)(seed >> 40) * 0x1p-24;
    }
    const double d[3] = {x[0], pow(1 - pow(x[0], p), 1 / p), -1};
    double o[3];
    for (int i = 0; i < 3; i++) {
      o[i] = (i == 2) - 3 * d[i] + (x[4 + i] < 0.5 ? -1 : 1) * ldexp(1, -44 - (int)(16 * x[1 + i]));
    }
    ask a;
    open_solid(&a, &s);
    const quoin_ray ray = {{o[0], o[1], o[2]}, {d[0], d[1], d[2]}, -INFINITY, INFINITY};
    quoin_intervals found;
    assert_int_equal(quoin_ray_intervals(a.scene, a.work, &ray, 0, &found), QUOIN_OK);
    for (int k = -50; k <= 0; k++) { /* from the tip, a factor of two a step, and from the rim */
      for (int end = 0; end < 2; end++) {
        const double t = end ? 4 - ldexp(1, k) : 3 + ldexp(1, k);
        int in = 0, near = 0;
        for (size_t i = 0; i < found.count; i++) {
          in |= found.inside[i].enter.t <= t && t <= found.inside[i].leave.t;
          near |= fabs(found.inside[i].enter.t - t) < 0x1p-39 || fabs(found.inside[i].leave.t - t) < 0x1p-39;
        }
        const int sign = near ? 0 : sign_at(&s, o, d, t);
        if (sign && ldexp(1, k) > 0x1p-38) { /* what is narrower than 2^-40 may be lost */
          assert_int_equal(in, sign < 0);
          inside += in, outside += !in, places++;
        }
      }
    }
    ask_close(&a);
  }
  assert_true(inside > share_min(200) && outside > share_min(200) && places > share_min(2000));
}

/* Directions from the shortest to the longest there are: t's are near the ends of the doubles' range. */
static void lengths(void **state) {
  (void)state;
  static const char *const radii[] = {"0.2", "1.3", "7", "1"}, *const exponents[] = {"0.5", "3", "0.3", "1", "2", "0.7", "2.5", "6", "0.001"};
  uint64_t seed = 11;
  int census[3] = {0, 0, 0};
  for (int round = 0; round < share_of(1500); round++) {
    uint64_t x[9];
    for (int i = 0; i < 9; i++) {
      seed = seed * 6364136223846793005u + 1442695040888963407u;
      x[i] = seed >> 40;
    }
    solid s = {.centre = {"0", "-0.5", "0.3"}, .e = exponents[x[0] % 9], .n = exponents[x[1] % 9]};
    if (x[0] % 9 == 3 && x[1] % 9 == 3) {
      continue; /* an ellipsoid: exact */
    }
    double o[3], radius[3];
    for (size_t i = 0; i < 3; i++) {
      s.radius[i] = radii[x[2 + i] % 4], radius[i] = atof(s.radius[i]);
      o[i] = atof(s.centre[i]) + (x[5] >> i & 1 ? 0 : radius[i] * ldexp((double)(x[6] % 1024) - 512, -10 - (int)i));
    }
    const int axis = (int)(x[7] % 3), power = (int)(x[8] % 2036) - 1016;
    o[axis] += (x[5] & 8 ? 2 : 0.25) * radius[axis];
    ask a;
    open_solid(&a, &s);
    census[judged(&a, &s, o, axis, ldexp((x[5] & 16 ? 0.8 : -1) * radius[axis], power)) + 1]++;
    ask_close(&a);
  }
  assert_true(census[1] > share_min(20) && census[2] > share_min(700));
}

/* Rays that were answered as misses, refused, or not at all. */
static void lengths_known(void **state) {
  (void)state;
  static const struct { solid s; double o[3], d[3]; } cases[] = {
    {{{"0", "0", "0"}, {"1", "1", "1"}, "0.25", "4"}, {0.25, 0.7, 0.3}, {0, 1e308, 1e308}},
    {{{"0", "0", "0"}, {"1", "1", "1"}, "0.25", "0.5"}, {1e-17, 0.3, 0.7}, {1e-300, 0, -1e-160}},
    {{{"0", "0", "0"}, {"1", "1", "1"}, "0.25", "4"}, {0.1, 0.1, 0.1}, {1e308, 1.5e308, 0}},
    {{{"0", "0", "0"}, {"0.3", "1", "1"}, "0.5", "2.5"}, {1e-17, 0.3, 0.7}, {1e-300, 0, -1e-160}},
    {{{"0", "0", "0"}, {"1", "1", "0.3"}, "0.001", "3"}, {1e-17, -1e-9, 0.25}, {-1e-160, -1e-160, 1e-300}}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const quoin_ray ray = {{cases[i].o[0], cases[i].o[1], cases[i].o[2]}, {cases[i].d[0], cases[i].d[1], cases[i].d[2]}, -INFINITY, INFINITY};
    ask a;
    open_solid(&a, &cases[i].s);
    quoin_intervals found;
    assert_int_equal(quoin_ray_intervals(a.scene, a.work, &ray, 0, &found), QUOIN_OK);
    assert_int_equal(found.count, 1);
    const double t[2] = {found.inside[0].enter.t, found.inside[0].leave.t}, off = 0x1p-40 * (t[1] - t[0]);
    assert_true(sign_at(&cases[i].s, ray.o, ray.d, t[0] - off) > 0 && sign_at(&cases[i].s, ray.o, ray.d, t[0] + off) < 0);
    assert_true(sign_at(&cases[i].s, ray.o, ray.d, t[1] - off) < 0 && sign_at(&cases[i].s, ray.o, ray.d, t[1] + off) > 0);
    ask_close(&a);
  }
  const solid s = cases[0].s;
  const quoin_ray slow = {{0.1, 0.1, 0.1}, {1e-310, 2e-310, 0}, 0, 1e300}; /* it does not come out within the doubles' range */
  uint8_t blocked = 0;
  ask a;
  open_solid(&a, &s);
  assert_int_equal(quoin_rays_blocked(a.scene, a.work, 1, &slow, NULL, &blocked), QUOIN_OK);
  assert_int_equal(blocked, 1);
  ask_close(&a);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(known),     cmocka_unit_test(gap),     cmocka_unit_test(poles),
                                     cmocka_unit_test(from_afar), cmocka_unit_test(rulings), cmocka_unit_test(lengths), cmocka_unit_test(lengths_known)};
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  mpfr_free_cache();
  return failed;
}
