/* The catalogue of hard rays with answers known in closed form, and its relatives: translated, turned by (3/5, 4/5), with
   the axes changed round, scaled, reversed, with the direction scaled. A parameter is c + s sqrt(r) with decimals or powers of two, and the
   expected double is that number rounded to nearest by MPFR. */
#include "ask.h"

#include <gmp.h>
#include <math.h>
#include <mpfr.h>

/* "3", "-0.5", "1-2^-53", "2^601+1": exactly. */
static void number(mpq_t out, const char *text) {
  mpq_t term, ten;
  mpq_inits(term, ten, NULL);
  mpq_set_ui(out, 0, 1);
  for (const char *at = text; *at;) {
    int minus = *at == '-';
    at += *at == '-' || *at == '+';
    size_t n = strcspn(at, "+-");
    if (strncmp(at, "2^", 2) == 0) {
      long e = strtol(at + 2, NULL, 10);
      n = 2 + (size_t)(at[2] == '-') + strspn(at + 2 + (at[2] == '-'), "0123456789");
      mpq_set_ui(term, 1, 1);
      e < 0 ? mpq_div_2exp(term, term, (mp_bitcnt_t)-e) : mpq_mul_2exp(term, term, (mp_bitcnt_t)e);
    } else {
      mpq_set_ui(term, 0, 1);
      mpq_set_ui(ten, 10, 1);
      int after = 0;
      for (size_t i = 0; i < n; i++) {
        if (at[i] == '.') {
          after = 1;
          continue;
        }
        mpq_t digit;
        mpq_init(digit);
        mpq_mul(term, term, ten);
        mpq_set_ui(digit, (unsigned long)(at[i] - '0'), 1);
        mpq_add(term, term, digit);
        mpq_clear(digit);
        after += after != 0;
      }
      for (int i = 1; i < after; i++) {
        mpq_div(term, term, ten);
      }
    }
    minus ? mpq_sub(out, out, term) : mpq_add(out, out, term);
    at += n;
  }
  mpq_clears(term, ten, NULL);
}

/* A number whose denominator has factors 2 and 5 only, as a decimal. Freed by the caller. */
static char *decimal(const mpq_t v) {
  mpz_t n, d;
  mpz_inits(n, d, NULL);
  mpz_set(n, mpq_numref(v));
  mpz_set(d, mpq_denref(v));
  unsigned long places = 0;
  while (mpz_cmp_ui(d, 1) != 0) {
    mpz_mul_ui(n, n, 10);
    places++;
    mpz_t g;
    mpz_init(g);
    mpz_gcd(g, n, d);
    mpz_divexact(n, n, g);
    mpz_divexact(d, d, g);
    mpz_clear(g);
    assert_true(places < 3000);
  }
  char *digits = mpz_get_str(NULL, 10, n), *text = malloc(strlen(digits) + 32);
  assert_non_null(text);
  sprintf(text, "%se-%lu", digits, places);
  free(digits);
  mpz_clears(n, d, NULL);
  return text;
}

static double expected(const char *c, int s, const char *r) {
  if (s == 2 || s == -2) {
    return s * strtod("inf", NULL);
  }
  mpq_t q;
  mpfr_t x, y;
  mpq_init(q);
  mpfr_init2(x, 4000);
  mpfr_init2(y, 4000);
  number(q, c);
  mpfr_set_q(x, q, MPFR_RNDN);
  number(q, r);
  mpfr_set_q(y, q, MPFR_RNDN);
  mpfr_sqrt(y, y, MPFR_RNDN);
  mpfr_mul_si(y, y, s, MPFR_RNDN);
  mpfr_add(x, x, y, MPFR_RNDN);
  double v = mpfr_get_d(x, MPFR_RNDN);
  mpq_clear(q);
  mpfr_clears(x, y, NULL);
  return v;
}

typedef struct at { const char *c; int s; const char *r; } at; /* c + s sqrt(r); s = +-2: infinite */
#define T(c) {c, 0, "0"}
#define INF {"0", 2, "0"}
#define MINUS_INF {"0", -2, "0"}

typedef struct hard {
  const char *name, *text, *ray[6];
  int count, boundary_count;
  at ends[4], boundary[4];
} hard;

static const hard HARD[] = {
  {"1", "sphere(1);", {"-5", "1", "0", "1", "0", "0"}, 0, 0, {{0}}, {{0}}},
  {"2", "sphere(7);", {"-3000007", "2000009", "6", "3", "-2", "0"}, 0, 0, {{0}}, {{0}}},
  {"3", "translate([0,-1,0]) sphere(1);", {"-5", "-2^-60", "0", "1", "0", "0"}, 1, 0, {{"5", -1, "2^-59-2^-120"}, {"5", 1, "2^-59-2^-120"}}, {{0}}},
  {"3+", "translate([0,-1,0]) sphere(1);", {"-5", "2^-60", "0", "1", "0", "0"}, 0, 0, {{0}}, {{0}}},
  {"4", "sphere(1);", {"-2^60", "1-2^-53", "0", "1", "0", "0"}, 1, 0, {{"2^60", -1, "2^-52-2^-106"}, {"2^60", 1, "2^-52-2^-106"}}, {{0}}},
  {"5", "sphere(1);", {"-3", "0", "0", "2^-600", "0", "0"}, 1, 0, {T("2^601"), T("2^602")}, {{0}}},
  {"6 union", "sphere(1); translate([2,0,0]) sphere(1);", {"-5", "0", "0", "1", "0", "0"}, 1, 0, {T("4"), T("8")}, {{0}}},
  {"6 meet", "intersection() { sphere(1); translate([2,0,0]) sphere(1); }", {"-5", "0", "0", "1", "0", "0"}, 0, 0, {{0}}, {{0}}},
  {"6 less", "difference() { sphere(1); translate([2,0,0]) sphere(1); }", {"-5", "0", "0", "1", "0", "0"}, 1, 0, {T("4"), T("6")}, {{0}}},
  {"7", "difference() { quadric([1,1,1,0,0,0,0,0,0,-1]); quadric([2,2,2,0,0,0,0,0,0,-2]); }", {"-5", "0.3", "0.1", "1", "0", "0"}, 0, 0, {{0}}, {{0}}},
  {"8 union", "cube([0.3,1,1]); translate([0.1+0.2,0,0]) cube([0.7,1,1]);", {"-1", "0.5", "0.5", "1", "0", "0"}, 1, 0, {T("1"), T("2")}, {{0}}},
  {"8 meet", "intersection() { cube([0.3,1,1]); translate([0.1+0.2,0,0]) cube([0.7,1,1]); }", {"-1", "0.5", "0.5", "1", "0", "0"}, 0, 0, {{0}}, {{0}}},
  {"9 z", "difference() { cube(1); translate([0.25,0.25,0]) cube([0.5,0.5,1]); }", {"0.5", "0.5", "-1", "0", "0", "1"}, 0, 0, {{0}}, {{0}}},
  {"9 x", "difference() { cube(1); translate([0.25,0.25,0]) cube([0.5,0.5,1]); }", {"-1", "0.5", "0.5", "1", "0", "0"}, 2, 0,
   {T("1"), T("1.25"), T("1.75"), T("2")}, {{0}}},
  {"10 union", "cube(1); translate([1,0,0]) cube(1);", {"1", "0.5", "-1", "0", "0", "1"}, 1, 0, {T("1"), T("2")}, {{0}}},
  {"10 one", "cube(1);", {"1", "0.5", "-1", "0", "0", "1"}, 0, 1, {{0}}, {T("1"), T("2")}},
  {"10 meet", "intersection() { cube(1); translate([1,0,0]) cube(1); }", {"1", "0.5", "-1", "0", "0", "1"}, 0, 0, {{0}}, {{0}}},
  {"10 less", "difference() { cube(1); translate([1,0,0]) cube(1); }", {"1", "0.5", "-1", "0", "0", "1"}, 0, 1, {{0}}, {T("1"), T("2")}},
  {"11 edge", "cube(1);", {"1", "1", "-1", "0", "0", "1"}, 0, 1, {{0}}, {T("1"), T("2")}},
  {"12", "cylinder(r=5,h=2);", {"0", "1", "-1", "1", "1", "1"}, 1, 0, {T("1"), T("3")}, {{0}}},
  {"13 in", "cylinder(r=5,h=2);", {"12", "16", "5", "-3", "-4", "-1"}, 1, 0, {T("3"), T("5")}, {{0}}},
  {"13 touch", "cylinder(r=5,h=2);", {"12", "16", "-1", "-3", "-4", "1"}, 0, 0, {{0}}, {{0}}},
  {"14", "cylinder(r=5,h=2);", {"3", "4", "-1", "0", "0", "1"}, 0, 1, {{0}}, {T("1"), T("3")}},
  {"14-", "cylinder(r=5,h=2);", {"3", "4-2^-50", "-1", "0", "0", "1"}, 1, 0, {T("1"), T("3")}, {{0}}},
  {"14+", "cylinder(r=5,h=2);", {"3", "4+2^-50", "-1", "0", "0", "1"}, 0, 0, {{0}}, {{0}}},
  {"15", "quadric([1,1,0,0,0,0,0,0,0,-1]);", {"0", "0", "0", "2^-300", "0", "1"}, 1, 0, {T("-2^300"), T("2^300")}, {{0}}},
  {"16 a", "cylinder(h=5,r1=0,r2=5);", {"0", "0", "1", "3", "4", "5"}, 1, 0, {T("-0.1"), T("0.8")}, {{0}}},
  {"16 b", "cylinder(h=5,r1=0,r2=5);", {"0", "0", "0", "3", "4", "5"}, 0, 1, {{0}}, {T("0"), T("1")}},
  {"16 c", "cylinder(h=5,r1=0,r2=5);", {"1", "0", "0", "3", "4", "5"}, 0, 0, {{0}}, {{0}}},
  {"17", "quadric([1,1,-1,0,0,0,0,0,0,0]);", {"-1", "0", "-2", "1", "0", "2"}, 1, 0, {MINUS_INF, INF}, {{0}}},
  {"17 z>0", "intersection() { quadric([1,1,-1,0,0,0,0,0,0,0]); halfspace(n=[0,0,-1],d=0); }", {"-1", "0", "-2", "1", "0", "2"}, 1, 0, {T("1"), INF}, {{0}}},
  {"18 a", "quadric([1,1,-1,0,0,0,0,0,0,-1]);", {"1", "0", "0", "0", "1", "1"}, 0, 1, {{0}}, {MINUS_INF, INF}},
  {"18 b", "quadric([1,1,-1,0,0,0,0,0,0,-1]);", {"2", "0", "0", "3", "4", "5"}, 1, 0, {MINUS_INF, T("-0.25")}, {{0}}},
  {"19", "quadric([1,1,-1,0,0,0,0,0,0,1]);", {"0", "0", "0", "0", "0", "1"}, 2, 0, {MINUS_INF, T("-1"), T("1"), INF}, {{0}}},
  {"20", "quadric([1,1,1000000000000,0,0,0,0,0,0,-1]);", {"-5", "0", "0.000001", "1", "0", "0"}, 0, 0, {{0}}, {{0}}},
  /* In surfaces, with a turn (src/ray/turn.c): an apex; two; one curvature (cone minus cylinder, x - z <= -y2/2t against -y2/4); tangent planes that are one,
     at a rational place (xy <= z <= 2y) and at an irrational one (xy <= z, xz <= 2y, y >= 0). */
  {"21 a", "intersection() { quadric([1,1,-1,0,0,0,0,0,0,0]); halfspace(n=[1,0,-1],d=0); }", {"-5", "0", "-5", "1", "0", "1"}, 0, 1, {{0}}, {T("5"), INF}},
  {"21 b", "intersection() { quadric([1,1,-1,0,0,0,0,0,0,0]); translate([6,8,10]) quadric([1,1,-1,0,0,0,0,0,0,0]); }", {"0", "0", "0", "3", "4", "5"}, 0, 2, {{0}}, {MINUS_INF, T("0"), T("2"), INF}},
  {"21 c", "difference() { quadric([1,1,-1,0,0,0,0,0,0,0]); quadric([1,1,1,0,-2,0,4,0,-4,0]); }", {"0", "0", "0", "1", "0", "1"}, 0, 2, {{0}}, {MINUS_INF, T("0"), T("2"), INF}},
  {"21 d", "intersection() { quadric([0,0,0,1,0,0,0,0,-1,0]); halfspace(n=[0,-2,1],d=0); halfspace(n=[0,-1,0],d=0); }", {"0", "0", "0", "1", "0", "0"}, 0, 1, {{0}}, {MINUS_INF, T("2")}},
  {"21 e", "intersection() { quadric([0,0,0,1,0,0,0,0,-1,0]); quadric([0,0,0,0,1,0,0,-2,0,0]); halfspace(n=[0,-1,0],d=0); }", {"0", "0", "0", "1", "0", "0"}, 0, 1, {{0}},
   {MINUS_INF, {"0", 1, "2"}}},
  /* The edge of pairs of planes, xy <= z beside it, which has ty = z for its tangent plane: y (z - 2y) <= 0; z^2 <= 2y^2; that and yz >= 0; y >= 0 in each. In the last
     two pairs and a cone: y = 0 is the tangent plane at 1/2. */
  {"21 f", "intersection() { quadric([0,0,0,1,0,0,0,0,-1,0]); quadric([0,-2,0,0,0,1,0,0,0,0]); halfspace(n=[0,-1,0],d=0); }", {"0", "0", "0", "1", "0", "0"}, 0, 1, {{0}}, {MINUS_INF, T("2")}},
  {"21 g", "intersection() { quadric([0,0,0,1,0,0,0,0,-1,0]); quadric([0,-2,1,0,0,0,0,0,0,0]); halfspace(n=[0,-1,0],d=0); }", {"0", "0", "0", "1", "0", "0"}, 0, 1, {{0}},
   {MINUS_INF, {"0", 1, "2"}}},
  {"21 h", "intersection() { quadric([0,0,0,1,0,0,0,0,-1,0]); quadric([0,-2,1,0,0,0,0,0,0,0]); quadric([0,0,0,0,0,-1,0,0,0,0]); halfspace(n=[0,-1,0],d=0); }", {"0", "0", "0", "1", "0", "0"}, 0, 1,
   {{0}}, {MINUS_INF, {"0", 1, "2"}}},
  {"21 i", "difference() { rotate([0,180,0]) difference() { quadric([-3,1,-3,-2,6,2,0,0,0,0]); halfspace(n=[-1,0,1],d=0); quadric([1,1,-1,0,0,0,0,1,0,0]); } quadric([-3,1,-3,-2,6,2,0,0,0,0]); }",
   {"1", "0", "1", "-1", "0", "-1"}, 0, 1, {{0}}, {MINUS_INF, T("0.5")}},
  {"21 k", "quadric([1,1,-1,0,0,0,0,0,0,0]);", {"0", "0", "0", "1", "0", "1"}, 0, 1, {{0}}, {MINUS_INF, INF}}, /* from an apex */
  /* The same with a pair whose plane the cone touches all along the line, u = x - z = 0 against u (x + z) + y2 = 0: behind its apex the cone bends to the other side. */
  {"21 j", "difference() { rotate([0,180,0]) difference() { quadric([-3,1,-3,-2,6,2,0,0,0,0]); halfspace(n=[-1,1,1],d=0); quadric([1,1,-1,0,0,0,0,0,0,0]); } quadric([-3,0,-3,-2,6,2,0,0,0,0]); }",
   {"1", "0", "1", "-1", "0", "-1"}, 0, 1, {{0}}, {T("1"), INF}},
};
#define HARD_COUNT (sizeof HARD / sizeof *HARD)

/* Relatives: the model's wrapper; the same done to the ray; what becomes of t: t' = turn t 2^-raise. */
typedef struct relative {
  const char *name, *wrap;
  const char *map[12];
  int turn, raise;
} relative;
static const relative RELATIVES[] = {
  {"itself", "{", {"1", "0", "0", "0", "0", "1", "0", "0", "0", "0", "1", "0"}, 1, 0},
  {"translated", "translate([0.1,-0.7,1000000.3]) {", {"1", "0", "0", "0.1", "0", "1", "0", "-0.7", "0", "0", "1", "1000000.3"}, 1, 0},
  {"turned", "multmatrix([[0.6,-0.8,0,0],[0.8,0.6,0,0],[0,0,1,0]]) {", {"0.6", "-0.8", "0", "0", "0.8", "0.6", "0", "0", "0", "0", "1", "0"}, 1, 0},
  {"turned twice", "multmatrix([[0.6,-0.8,0,0],[0.48,0.36,-0.8,0],[0.64,0.48,0.6,1]]) {",
   {"0.6", "-0.8", "0", "0", "0.48", "0.36", "-0.8", "0", "0.64", "0.48", "0.6", "1"}, 1, 0},
  {"axes", "multmatrix([[0,1,0,0],[0,0,1,0],[1,0,0,0]]) {", {"0", "1", "0", "0", "0", "0", "1", "0", "1", "0", "0", "0"}, 1, 0},
  {"scaled", "scale(1048576) {", {"2^20", "0", "0", "0", "0", "2^20", "0", "0", "0", "0", "2^20", "0"}, 1, 0},
  {"squeezed", "scale([0.1,1,7]) {", {"0.1", "0", "0", "0", "0", "1", "0", "0", "0", "0", "7", "0"}, 1, 0},
  {"reversed", "{", {"1", "0", "0", "0", "0", "1", "0", "0", "0", "0", "1", "0"}, -1, 0},
  {"faster", "{", {"1", "0", "0", "0", "0", "1", "0", "0", "0", "0", "1", "0"}, 1, 7},
  {"all", "translate([0.1,-0.7,3]) multmatrix([[0.6,-0.8,0,0],[0.8,0.6,0,0],[0,0,1,0]]) {", {"0.6", "-0.8", "0", "0.1", "0.8", "0.6", "0", "-0.7", "0", "0", "1", "3"}, -1, 40},
};
#define RELATIVE_COUNT (sizeof RELATIVES / sizeof *RELATIVES)

static void check(const hard *h, const relative *r, const char *what, int count, const at *ends, size_t got_count, const quoin_interval *got) {
  int wrong = got_count != (size_t)count;
  for (int i = 0; i < count && !wrong; i++) {
    int k = r->turn > 0 ? i : count - 1 - i;
    const at *a = &ends[2 * k + (r->turn < 0)], *b = &ends[2 * k + (r->turn > 0)];
    double enter = ldexp(r->turn * expected(a->c, a->s, a->r), -r->raise) + 0.0, leave = ldexp(r->turn * expected(b->c, b->s, b->r), -r->raise) + 0.0;
    wrong |= got[i].enter.t != enter || got[i].leave.t != leave;
    wrong |= (enter == -strtod("inf", NULL)) != (got[i].enter.part == QUOIN_NO_PART) || (leave == strtod("inf", NULL)) != (got[i].leave.part == QUOIN_NO_PART);
  }
  if (wrong) {
    print_error("case %s, %s, %s: %zu of %d\n", h->name, r->name, what, got_count, count);
    for (size_t i = 0; i < got_count; i++) {
      print_error("  %.17g %.17g\n", got[i].enter.t, got[i].leave.t);
    }
  }
  assert_false(wrong);
}

static void one(const hard *h, const relative *r) {
  char text[2000];
  snprintf(text, sizeof text, "%s %s }", strcmp(r->wrap, "{") == 0 ? "union() {" : r->wrap, h->text);
  ask a;
  ask_open(&a, text);
  mpq_t v[6], m, sum;
  mpq_inits(m, sum, NULL);
  char *ray[6];
  for (int i = 0; i < 6; i++) {
    mpq_init(v[i]);
    number(v[i], h->ray[i]);
  }
  for (int i = 0; i < 6; i++) {
    mpq_set_ui(sum, 0, 1);
    for (int j = 0; j < 4; j++) {
      number(m, r->map[4 * (i % 3) + j]);
      if (j < 3) {
        mpq_mul(m, m, v[3 * (i / 3) + j]);
      }
      if (j < 3 || i < 3) {
        mpq_add(sum, sum, m);
      }
    }
    if (i >= 3) {
      mpq_mul_2exp(sum, sum, (mp_bitcnt_t)r->raise);
      if (r->turn < 0) {
        mpq_neg(sum, sum);
      }
    }
    ray[i] = decimal(sum);
  }
  quoin_intervals got;
  assert_int_equal(quoin_ray_intervals_text(a.scene, a.work, (const char *const *)ray, NULL, NULL, QUOIN_WANT_BOUNDARY, &got), QUOIN_OK);
  check(h, r, "inside", h->count, h->ends, got.count, got.inside);
  check(h, r, "boundary", h->boundary_count, h->boundary, got.boundary_count, got.boundary);
  for (int i = 0; i < 6; i++) {
    mpq_clear(v[i]);
    free(ray[i]);
  }
  mpq_clears(m, sum, NULL);
  ask_close(&a);
}

static void catalogue(void **state) {
  (void)state;
  for (size_t i = 0; i < HARD_COUNT; i++) {
    for (size_t k = 0; k < RELATIVE_COUNT; k++) {
      one(&HARD[i], &RELATIVES[k]);
    }
  }
}

/* The tenth and the twentieth, where the doubles are other numbers than the decimals. */
static void doubles(void **state) {
  (void)state;
  ask a;
  ask_open(&a, "quadric([1,1,1000000000000,0,0,0,0,0,0,-1]);");
  quoin_intervals got;
  const quoin_ray ray = {{-5, 0, 0.000001}, {1, 0, 0}, -strtod("inf", NULL), strtod("inf", NULL)};
  assert_int_equal(quoin_ray_intervals(a.scene, a.work, &ray, 0, &got), QUOIN_OK);
  assert_int_equal(got.count, 1); /* the double is a little less than 1e-6 */
  assert_true(got.inside[0].enter.t < 5 && got.inside[0].enter.t > 5 - 1e-8 && got.inside[0].leave.t > 5 && got.inside[0].leave.t < 5 + 1e-8);
  ask_close(&a);
}

static void ranges(void **state) {
  (void)state;
  ask a;
  ask_open(&a, "cube(1); translate([2,0,0]) cube(1);");
  quoin_intervals got;
  static const char *const ray[6] = {"-1", "0.5", "0.5", "1", "0", "0"};
  const double inf = strtod("inf", NULL);
  assert_int_equal(quoin_ray_intervals_text(a.scene, a.work, ray, "1.5", "3.25", 0, &got), QUOIN_OK);
  assert_int_equal(got.count, 2);
  assert_true(got.inside[0].enter.t == 1.5 && got.inside[0].leave.t == 2 && got.inside[1].enter.t == 3 && got.inside[1].leave.t == 3.25);
  assert_int_equal(got.inside[0].enter.part, QUOIN_NO_PART);
  assert_int_equal(got.inside[0].leave.part, 0);
  assert_int_equal(got.inside[1].enter.part, 1);
  assert_int_equal(got.inside[1].leave.part, QUOIN_NO_PART);
  /* an end that no double is: one third of the way beyond it */
  assert_int_equal(quoin_ray_intervals_text(a.scene, a.work, ray, "1.1", "1.9", 0, &got), QUOIN_OK);
  assert_int_equal(got.count, 1);
  assert_true(got.inside[0].enter.t == 1.1 && got.inside[0].leave.t == 1.9);
  assert_int_equal(quoin_ray_intervals_text(a.scene, a.work, ray, "2", "3", 0, &got), QUOIN_OK);
  assert_int_equal(got.count, 0);
  assert_int_equal(quoin_ray_intervals_text(a.scene, a.work, ray, "2.00000000000000000000000000000001", NULL, 0, &got), QUOIN_OK);
  assert_int_equal(got.count, 1);
  assert_int_equal(quoin_ray_intervals_text(a.scene, a.work, ray, "1.99999999999999999999999999999999", NULL, 0, &got), QUOIN_OK);
  assert_int_equal(got.count, 2);
  assert_true(got.inside[0].enter.t == 2 && got.inside[0].leave.t == 2);
  assert_int_equal(quoin_ray_intervals_text(a.scene, a.work, ray, "-1e400", "1e400", 0, &got), QUOIN_OK);
  assert_int_equal(got.count, 2);
  assert_int_equal(quoin_ray_intervals_text(a.scene, a.work, ray, "1e400", NULL, 0, &got), QUOIN_OK);
  assert_int_equal(got.count, 0);
  assert_int_equal(quoin_ray_intervals_text(a.scene, a.work, ray, "2", "1", 0, &got), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_ray_intervals_text(a.scene, a.work, ray, "x", "1", 0, &got), QUOIN_E_NUMBER);
  static const char *const still[6] = {"-1", "0.5", "0.5", "0", "0.0", "-0"};
  assert_int_equal(quoin_ray_intervals_text(a.scene, a.work, still, NULL, NULL, 0, &got), QUOIN_E_ARGUMENT);
  quoin_ray bad = {{0, 0, 0}, {0, 0, 0}, 0, 1};
  assert_int_equal(quoin_ray_intervals(a.scene, a.work, &bad, 0, &got), QUOIN_E_ARGUMENT);
  bad = (quoin_ray){{0, inf, 0}, {1, 0, 0}, 0, 1};
  assert_int_equal(quoin_ray_intervals(a.scene, a.work, &bad, 0, &got), QUOIN_E_ARGUMENT);
  bad = (quoin_ray){{0, 0, 0}, {1, 0, 0}, strtod("nan", NULL), 1};
  assert_int_equal(quoin_ray_intervals(a.scene, a.work, &bad, 0, &got), QUOIN_E_ARGUMENT);
  bad = (quoin_ray){{0, 0, 0}, {1, 0, 0}, 2, 1};
  assert_int_equal(quoin_ray_intervals(a.scene, a.work, &bad, 0, &got), QUOIN_E_ARGUMENT);
  bad = (quoin_ray){{0, 0, 0}, {1, 0, 0}, 0, 1};
  assert_int_equal(quoin_ray_intervals(a.scene, a.work, &bad, 4, &got), QUOIN_E_ARGUMENT);
  ask_close(&a);
}

/* Surfaces that turn along one line, c xy - k y + m z >= 0: their sheets cross and cross again, and the fan they make with z <= 2y and y >= 0 is empty where one is steeper than 2. Up
   to a limit of surfaces the place is found; beyond it the ray is refused, not answered. */
static void many_on_a_line(void **state) {
  (void)state;
  static const char *const ray[6] = {"0", "0", "0", "1", "0", "0"};
  for (int n = 100; n <= 400; n += 100) {
    static char text[40000];
    size_t end = (size_t)snprintf(text, sizeof text, "intersection() { halfspace(n=[0,-2,1],d=0); halfspace(n=[0,-1,0],d=0);");
    double least = 1e300;
    for (int i = 0; i < n; i++) {
      end += (size_t)snprintf(text + end, sizeof text - end, "quadric([0,0,0,%d,0,0,0,%d,%d,0]);", i + 1, -(i * i + 1), -(i + 7));
      const double here = (2.0 * (i + 7) + i * i + 1) / (i + 1); /* c t - k = 2 m */
      least = here < least ? here : least;
    }
    snprintf(text + end, sizeof text - end, "}");
    ask a;
    ask_open(&a, text);
    quoin_intervals got;
    const quoin_status status = quoin_ray_intervals_text(a.scene, a.work, ray, NULL, NULL, QUOIN_WANT_BOUNDARY, &got);
    assert_int_equal(status, n == 100 ? QUOIN_OK : QUOIN_E_LIMIT);
    if (status == QUOIN_OK) {
      assert_int_equal(got.count, 0);
      assert_int_equal(got.boundary_count, 1);
      assert_true(got.boundary[0].leave.t == least && least == 7.5);
    }
    ask_close(&a);
  }
}

static void surfaces(void **state) {
  (void)state;
  ask a;
  ask_open(&a, "difference() { cube([4,4,1]); translate([2,2,0]) cylinder(r=1, h=1); }");
  quoin_intervals got;
  static const char *const ray[6] = {"-1", "2", "0.5", "1", "0", "0"};
  assert_int_equal(quoin_ray_intervals_text(a.scene, a.work, ray, NULL, NULL, 0, &got), QUOIN_OK);
  assert_int_equal(got.count, 2);
  assert_int_equal(got.inside[0].leave.part, 1);
  assert_int_equal(got.inside[0].leave.role, QUOIN_BODY);
  assert_int_equal(got.inside[0].enter.part, 0);
  assert_true(got.inside[0].enter.role >= QUOIN_FACE);
  ask_close(&a);
  ask_open(&a, "translate([1,0,0]) sphere(1); translate([-1,0,0]) sphere(1);");
  static const char *const touch[6] = {"0", "-5", "0", "0", "1", "0"};
  assert_int_equal(quoin_ray_intervals_text(a.scene, a.work, touch, NULL, NULL, QUOIN_WANT_CONTACTS, &got), QUOIN_OK);
  assert_int_equal(got.count, 0);
  assert_int_equal(got.contact_count, 1);
  assert_true(got.contacts[0].t == 5);
  ask_close(&a);
}

/* Walls of a pentagon are irrational planes: along a ray so fast, all that it passes about its centre is one place (design S2). What touches there is looked for among
   directions that tie, but not all with one another; found with random models, where it was refused. */
static void ties(void **state) {
  (void)state;
  static const char *const models[] = {"intersection() { sphere(0.3); cylinder(h=1, r=1, $fn=5); hyperboloid(1, 2, 0.7); paraboloid(1.5, 1); }",
                                       "difference() { intersection() { hyperboloid(1, 2, 1); cylinder(h=1, r=1, $fn=5); cone(0.7, 1.5); } union() { saddle(1.5, 2); sphere(0.3); wedge([1, 1.5, 2]); } }"};
  static const double rays[][3] = {{1e300, -1e160, 1}, {-1e160, 1, 1}};
  const double inf = strtod("inf", NULL);
  for (size_t k = 0; k < 2; k++) {
    ask a;
    ask_open(&a, models[k]);
    for (int way = -1; way <= 1; way += 2) {
      quoin_ray r = {.from = -inf, .to = inf};
      for (int i = 0; i < 3; i++) {
        r.o[i] = -rays[k][i] / 64, r.d[i] = way * rays[k][i];
      }
      quoin_intervals got;
      assert_int_equal(quoin_ray_intervals(a.scene, a.work, &r, QUOIN_WANT_BOUNDARY | QUOIN_WANT_CONTACTS, &got), QUOIN_OK);
      assert_int_equal(got.count, 0);
    }
    ask_close(&a);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(catalogue), cmocka_unit_test(doubles), cmocka_unit_test(ranges), cmocka_unit_test(many_on_a_line), cmocka_unit_test(surfaces), cmocka_unit_test(ties)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
