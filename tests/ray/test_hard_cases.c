/* The hard cases of exact ray casting and their relatives.

   Every hard case is asked as it stands and with model and ray moved together: translated by decimals and by doubles, turned by
   (3/5, 4/5) about two axes, scaled by powers of two, reversed, and with d scaled by powers of two. The answers are exact
   numbers, rounded once. */
#include "rays.h"

#include <mpfr.h>

/* An expected place: p + s sqrt(d1 + d2), strings in MPFR's notation. */
typedef struct place { const char *p; int s; const char *d1, *d2; } place;
#define AT(p) {p, 0, "0", "0"}

enum { MOST = 4 };
typedef struct hard {
  const char *name, *model, *o[3], *d[3];
  place inside[2 * MOST], on[2 * MOST], at[MOST];
} hard;

#define BALL "sphere(1);"
#define TUBE "cylinder(h = 2, r = 5);"
#define CONE "intersection() { quadric([1, 1, -1, 0, 0, 0, 0, 0, 0, 0]); halfspace(n = [0, 0, -1], d = 0); halfspace(n = [0, 0, 1], d = 5); }"
#define FRUSTUM "cylinder(h = 5, r1 = 0, r2 = 5);"
#define NAPPES "quadric([1, 1, -1, 0, 0, 0, 0, 0, 0, 0]);"
#define PAIR(op) #op "() { cube(1); translate([1, 0, 0]) cube(1); }"

static const hard cases[] = {
  {"1 tangent", BALL, {"-5", "1", "0"}, {"1", "0", "0"}, {{0}}, {{0}}, {AT("5")}},
  {"2 tangent far away", "sphere(7);", {"-3000007", "2000009", "6"}, {"3", "-2", "0"}, {{0}}, {{0}}, {AT("1000003")}},
  {"3 a hair below", "translate([0, -1, 0]) sphere(1);", {"-5", "-0x1p-60", "0"}, {"1", "0", "0"}, {{"5", -1, "0x1p-59", "-0x1p-120"}, {"5", 1, "0x1p-59", "-0x1p-120"}}, {{0}}, {{0}}},
  {"3 a hair above", "translate([0, -1, 0]) sphere(1);", {"-5", "0x1p-60", "0"}, {"1", "0", "0"}, {{0}}, {{0}}, {{0}}},
  {"4 both ends in one double", BALL, {"-0x1p60", "0x1.fffffffffffffp-1", "0"}, {"1", "0", "0"}, {AT("0x1p60"), AT("0x1p60")}, {{0}}, {{0}}},
  {"5 a short direction", BALL, {"-3", "0", "0"}, {"0x1p-600", "0", "0"}, {AT("0x1p601"), AT("0x1p602")}, {{0}}, {{0}}},
  {"6 touching balls, union", "sphere(1); translate([2, 0, 0]) sphere(1);", {"-5", "0", "0"}, {"1", "0", "0"}, {AT("4"), AT("8")}, {{0}}, {{0}}},
  {"6 touching balls, intersection", "intersection() { sphere(1); translate([2, 0, 0]) sphere(1); }", {"-5", "0", "0"}, {"1", "0", "0"}, {{0}}, {{0}}, {{0}}},
  {"6 touching balls, difference", "difference() { sphere(1); translate([2, 0, 0]) sphere(1); }", {"-5", "0", "0"}, {"1", "0", "0"}, {AT("4"), AT("6")}, {{0}}, {{0}}},
  {"7 one surface twice", "difference() { sphere(1); quadric([2, 2, 2, 0, 0, 0, 0, 0, 0, -2]); }", {"-5", "0.5", "0"}, {"1", "0", "0"}, {{0}}, {{0}}, {{0}}},
  {"8 tenths, union", "cube([0.3, 1, 1]); translate([0.1 + 0.2, 0, 0]) cube([0.7, 1, 1]);", {"-1", "0.5", "0.5"}, {"1", "0", "0"}, {AT("1"), AT("2")}, {{0}}, {{0}}},
  {"8 tenths, intersection", "intersection() { cube([0.3, 1, 1]); translate([0.1 + 0.2, 0, 0]) cube([0.7, 1, 1]); }", {"-1", "0.5", "0.5"}, {"1", "0", "0"}, {{0}}, {{0}}, {{0}}},
  {"9 flush hole, through it", "difference() { cube(1); translate([0.25, 0.25, 0]) cube([0.5, 0.5, 1]); }", {"0.5", "0.5", "-1"}, {"0", "0", "1"}, {{0}}, {{0}}, {{0}}},
  {"9 flush hole, across it", "difference() { cube(1); translate([0.25, 0.25, 0]) cube([0.5, 0.5, 1]); }", {"-1", "0.5", "0.5"}, {"1", "0", "0"}, {AT("1"), AT("1.25"), AT("1.75"), AT("2")}, {{0}}, {{0}}},
  {"9 flush hole, along its wall", "difference() { cube(1); translate([0.25, 0.25, 0]) cube([0.5, 0.5, 1]); }", {"0.25", "0.5", "-1"}, {"0", "0", "1"}, {{0}}, {AT("1"), AT("2")}, {{0}}},
  {"10 shared face, union", PAIR(union), {"1", "0.5", "-1"}, {"0", "0", "1"}, {AT("1"), AT("2")}, {{0}}, {{0}}},
  {"10 one face", "cube(1);", {"1", "0.5", "-1"}, {"0", "0", "1"}, {{0}}, {AT("1"), AT("2")}, {{0}}},
  {"10 shared face, intersection", PAIR(intersection), {"1", "0.5", "-1"}, {"0", "0", "1"}, {{0}}, {{0}}, {{0}}},
  {"10 shared face, difference", PAIR(difference), {"1", "0.5", "-1"}, {"0", "0", "1"}, {{0}}, {AT("1"), AT("2")}, {{0}}},
  {"11 along an edge", "cube(1);", {"0", "0", "-1"}, {"0", "0", "1"}, {{0}}, {AT("1"), AT("2")}, {{0}}},
  {"11 in a face, aslant", "cube(1);", {"-1", "-1", "0"}, {"1", "1", "0"}, {{0}}, {AT("1"), AT("2")}, {{0}}},
  {"12 leaves through the rim", TUBE, {"0", "1", "-1"}, {"1", "1", "1"}, {AT("1"), AT("3")}, {{0}}, {{0}}},
  {"13 enters by the rim", TUBE, {"12", "16", "5"}, {"-3", "-4", "-1"}, {AT("3"), AT("5")}, {{0}}, {{0}}},
  {"13 touches the rim", TUBE, {"12", "16", "-1"}, {"-3", "-4", "1"}, {{0}}, {{0}}, {AT("3")}},
  {"14 along the wall", TUBE, {"3", "4", "-1"}, {"0", "0", "1"}, {{0}}, {AT("1"), AT("3")}, {{0}}},
  {"14 just inside the wall", TUBE, {"3", "0x1.fffffffffffffp+1", "-1"}, {"0", "0", "1"}, {AT("1"), AT("3")}, {{0}}, {{0}}},
  {"14 just outside the wall", TUBE, {"3", "0x1.0000000000001p+2", "-1"}, {"0", "0", "1"}, {{0}}, {{0}}, {{0}}},
  {"15 nearly along an endless tube", "quadric([1, 1, 0, 0, 0, 0, 0, 0, 0, -1]);", {"0", "0", "0"}, {"0x1p-300", "0", "1"}, {AT("-0x1p300"), AT("0x1p300")}, {{0}}, {{0}}},
  {"16 parallel to a generator", CONE, {"0", "0", "1"}, {"3", "4", "5"}, {AT("-0.1"), AT("0.8")}, {{0}}, {{0}}},
  {"16 a generator", CONE, {"0", "0", "0"}, {"3", "4", "5"}, {{0}}, {AT("0"), AT("1")}, {{0}}},
  {"16 beside the cone", CONE, {"1", "0", "0"}, {"3", "4", "5"}, {{0}}, {{0}}, {{0}}},
  {"16 parallel to a generator, primitive", FRUSTUM, {"0", "0", "1"}, {"3", "4", "5"}, {AT("-0.1"), AT("0.8")}, {{0}}, {{0}}},
  {"16 a generator, primitive", FRUSTUM, {"0", "0", "0"}, {"3", "4", "5"}, {{0}}, {AT("0"), AT("1")}, {{0}}},
  {"17 through the apex", NAPPES, {"-1", "0", "-2"}, {"1", "0", "2"}, {AT("-inf"), AT("inf")}, {{0}}, {{0}}},
  {"17 through the apex, upper nappe", "intersection() { " NAPPES " halfspace(n = [0, 0, -1], d = 0); }", {"-1", "0", "-2"}, {"1", "0", "2"}, {AT("1"), AT("inf")}, {{0}}, {{0}}},
  {"17 past the apex", "intersection() { " NAPPES " halfspace(n = [0, 0, -1], d = 0); }", {"-2", "0", "-1"}, {"2", "0", "1"}, {{0}}, {{0}}, {AT("1")}},
  {"18 a ruling", "quadric([1, 1, -1, 0, 0, 0, 0, 0, 0, -1]);", {"1", "0", "0"}, {"0", "1", "1"}, {{0}}, {AT("-inf"), AT("inf")}, {{0}}},
  {"18 parallel to the asymptotic cone", "quadric([1, 1, -1, 0, 0, 0, 0, 0, 0, -1]);", {"2", "0", "0"}, {"3", "4", "5"}, {AT("-inf"), AT("-0.25")}, {{0}}, {{0}}},
  {"19 two sheets", "quadric([1, 1, -1, 0, 0, 0, 0, 0, 0, 1]);", {"0", "0", "0"}, {"0", "0", "1"}, {AT("-inf"), AT("-1"), AT("1"), AT("inf")}, {{0}}, {{0}}},
  {"20 a thin disc's edge, decimal", "quadric([1, 1, 1000000000000, 0, 0, 0, 0, 0, 0, -1]);", {"-5", "0", "0.000001"}, {"1", "0", "0"}, {{0}}, {{0}}, {AT("5")}},
  /* 1 - 1e12 z^2, z the double nearest to 1e-6 */
  {"20 a thin disc's edge, double", "quadric([1, 1, 1000000000000, 0, 0, 0, 0, 0, 0, -1]);", {"-5", "0", "0x1.0c6f7a0b5ed8dp-20"}, {"1", "0", "0"}, {{"5", -1, "1", "disc20"}, {"5", 1, "1", "disc20"}}, {{0}}, {{0}}},
  /* others of their kind */
  {"cube through a corner to a corner", "cube(1);", {"-1", "-1", "-1"}, {"1", "1", "1"}, {AT("1"), AT("2")}, {{0}}, {{0}}},
  {"cube touched at a corner", "cube(1);", {"-1", "1", "0.5"}, {"1", "-1", "-0.5"}, {{0}}, {{0}}, {AT("1")}},
  {"cube touched at an edge", "cube(1);", {"-1", "1", "0.5"}, {"1", "-1", "0"}, {{0}}, {{0}}, {AT("1")}},
  {"cubes that share an edge, through it", "cube(1); translate([1, 1, 0]) cube(1);", {"0", "2", "0.5"}, {"1", "-1", "0"}, {{0}}, {{0}}, {AT("1")}},
  {"cubes that share an edge, along it", "cube(1); translate([1, 1, 0]) cube(1);", {"1", "1", "-1"}, {"0", "0", "1"}, {{0}}, {AT("1"), AT("2")}, {{0}}},
  {"a lens touched at its rim", "intersection() { sphere(5); translate([6, 0, 0]) sphere(5); }", {"3", "4", "-1"}, {"0", "0", "1"}, {{0}}, {{0}}, {AT("1")}},
  {"a lens passed through its rim twice, irrational", "intersection() { sphere(5); translate([6, 0, 0]) sphere(5); }", {"3", "1", "0"}, {"0", "0", "1"}, {{"0", -1, "15", "0"}, {"0", 1, "15", "0"}}, {{0}}, {{0}}},
  {"a ball less another, through their circle", "difference() { sphere(5); translate([6, 0, 0]) sphere(5); }", {"3", "1", "0"}, {"0", "0", "1"}, {{0}}, {{0}}, {{"0", -1, "15", "0"}, {"0", 1, "15", "0"}}},
  {"a ball less a tube around it, through their circle", "difference() { sphere(5); quadric([1, 1, 0, 0, 0, 0, 0, 0, 0, -25]); }", {"1", "-7", "0"}, {"0", "1", "0"}, {{0}}, {{0}}, {{0}}},
  {"a lens crossed at a rim point aslant", "intersection() { sphere(5); translate([6, 0, 0]) sphere(5); }", {"2", "4", "-1"}, {"1", "0", "1"}, {{0}}, {{0}}, {AT("1")}},
  {"a film that is not there", "difference() { cube(2); cube([2, 2, 1]); translate([0, 0, 1]) cube([2, 2, 1]); }", {"1", "1", "-1"}, {"0", "0", "1"}, {{0}}, {{0}}, {{0}}},
  {"in the plane of a film that is not there", "difference() { cube(2); cube([2, 2, 1]); translate([0, 0, 1]) cube([2, 2, 1]); }", {"-1", "1", "1"}, {"1", "0", "0"}, {{0}}, {{0}}, {{0}}},
  {"stack, in an inner face", "cube([2, 2, 1]); translate([0, 0, 1]) cube([1, 2, 1]);", {"-1", "1", "1"}, {"1", "0", "0"}, {AT("1"), AT("2")}, {AT("2"), AT("3")}, {{0}}},
  {"all of space but a ball", "difference() { quadric([0, 0, 0, 0, 0, 0, 0, 0, 1, -3]); sphere(1); }", {"0", "0", "-5"}, {"0", "0", "1"}, {AT("-inf"), AT("4"), AT("6"), AT("8")}, {{0}}, {{0}}},
};
enum { CASES = sizeof cases / sizeof *cases };

static void expect_number(char *out, size_t size, const place *p, int reversed, int shift) {
  mpfr_t v, d, e;
  mpfr_inits2(600, v, d, e, (mpfr_ptr)0);
  mpfr_strtofr(d, p->d1, NULL, 0, MPFR_RNDN);
  if (strcmp(p->d2, "disc20") == 0) {
    mpfr_set_d(e, 0x1.0c6f7a0b5ed8dp-20, MPFR_RNDN);
    mpfr_sqr(e, e, MPFR_RNDN);
    mpfr_mul_ui(e, e, 1000000, MPFR_RNDN);
    mpfr_mul_ui(e, e, 1000000, MPFR_RNDN);
    mpfr_neg(e, e, MPFR_RNDN);
  } else {
    mpfr_strtofr(e, p->d2, NULL, 0, MPFR_RNDN);
  }
  mpfr_add(d, d, e, MPFR_RNDN);
  mpfr_sqrt(d, d, MPFR_RNDN);
  mpfr_mul_si(d, d, p->s, MPFR_RNDN);
  mpfr_strtofr(v, p->p, NULL, 0, MPFR_RNDN);
  mpfr_add(v, v, d, MPFR_RNDN);
  mpfr_mul_2si(v, v, -shift, MPFR_RNDN);
  if (reversed) {
    mpfr_neg(v, v, MPFR_RNDN);
  }
  double t = mpfr_get_d(v, MPFR_RNDN);
  add_number(out, size, t == 0 ? 0 : t);
  mpfr_clears(v, d, e, (mpfr_ptr)0);
}

static void expect_list(char *out, size_t size, const char *word, const place *list, size_t most, int reversed, int shift) {
  size_t n = 0;
  while (n < most && list[n].p) {
    n++;
  }
  if (n && word) {
    snprintf(out + strlen(out), size - strlen(out), "%s%s", out[0] ? " " : "", word);
  }
  for (size_t i = 0; i < n; i++) {
    expect_number(out, size, &list[reversed ? n - 1 - i : i], reversed, shift);
  }
}

/* A relative: text before the model, and the same map for the ray. */
typedef struct relative {
  const char *name, *before;
  const char *m[12]; /* rows of [A | t] */
} relative;

static const relative relatives[] = {
  {"itself", "", {"1", "0", "0", "0", "0", "1", "0", "0", "0", "0", "1", "0"}},
  {"translated by decimals", "translate([0.1, -7.3, 100000.7]) ", {"1", "0", "0", "0.1", "0", "1", "0", "-7.3", "0", "0", "1", "100000.7"}},
  {"translated by doubles", "translate([4096, -0.375, 1]) ", {"1", "0", "0", "4096", "0", "1", "0", "-0.375", "0", "0", "1", "1"}},
  {"turned about z", "multmatrix([[0.6, -0.8, 0, 0], [0.8, 0.6, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) ",
   {"0.6", "-0.8", "0", "0", "0.8", "0.6", "0", "0", "0", "0", "1", "0"}},
  {"turned about x and moved", "multmatrix([[1, 0, 0, 3], [0, 0.6, -0.8, 0.7], [0, 0.8, 0.6, -11], [0, 0, 0, 1]]) ",
   {"1", "0", "0", "3", "0", "0.6", "-0.8", "0.7", "0", "0.8", "0.6", "-11"}},
  {"scaled up", "scale(2 ^ 37) ", {"0x1p37", "0", "0", "0", "0", "0x1p37", "0", "0", "0", "0", "0x1p37", "0"}},
  {"scaled down", "scale(2 ^ -41) ", {"0x1p-41", "0", "0", "0", "0", "0x1p-41", "0", "0", "0", "0", "0x1p-41", "0"}},
  {"sheared", "multmatrix([[1, 0.5, 0, 0], [0, 1, 0.1, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) ", {"1", "0.5", "0", "0", "0", "1", "0.1", "0", "0", "0", "1", "0"}},
};
enum { RELATIVES = sizeof relatives / sizeof *relatives };

static void test_hard_cases(void **state) {
  (void)state;
  unsigned asked = 0, wrong = 0, doubles = 0;
  for (size_t i = 0; i < CASES; i++) {
    const hard *c = &cases[i];
    for (size_t r = 0; r < RELATIVES; r++) {
      const relative *rel = &relatives[r];
      char text[2000];
      snprintf(text, sizeof text, "%s{ %s }", rel->before[0] ? rel->before : "union() ", c->model);
      stage st = stage_open(text);
      for (int way = 0; way < 4; way++) { /* reversed or not; d scaled by 2^19 or not */
        int reversed = way & 1, shift = way & 2 ? 19 : 0;
        qn_scratch_begin(st.scratch);
        qn_ctx *ctx = qn_scratch_ctx(st.scratch);
        qn_num o[3], d[3], o0[3], d0[3];
        for (int j = 0; j < 3; j++) {
          o0[j] = number_of(ctx, c->o[j]);
          d0[j] = qn_num_mul(ctx, number_of(ctx, c->d[j]), qn_num_from_double(ctx, ldexp(reversed ? -1 : 1, shift)));
        }
        for (int j = 0; j < 3; j++) {
          d[j] = QN_NUM_ZERO;
          o[j] = number_of(ctx, rel->m[4 * j + 3]);
          for (int k = 0; k < 3; k++) {
            qn_num m = number_of(ctx, rel->m[4 * j + k]);
            o[j] = qn_num_add(ctx, o[j], qn_num_mul(ctx, m, o0[k]));
            d[j] = qn_num_add(ctx, d[j], qn_num_mul(ctx, m, d0[k]));
          }
        }
        char want[1000] = "", got[1000] = "";
        expect_list(want, sizeof want, NULL, c->inside, 2 * MOST, reversed, shift);
        expect_list(want, sizeof want, "on", c->on, 2 * MOST, reversed, shift);
        expect_list(want, sizeof want, "at", c->at, MOST, reversed, shift);
        qn_line line;
        qn_line_from_numbers(ctx, o, d, &line);
        answer_of(&st, &line, &WHOLE_LINE, got, sizeof got);
        asked++;
        if (strcmp(want, got) != 0) {
          print_error("%s, %s, way %d: want [%s] got [%s]\n", c->name, rel->name, way, want, got);
          wrong++;
        }
        if (!line.rounded) { /* the same from doubles */
          qn_line plain;
          double od[3], dd[3];
          memcpy(od, line.o, sizeof od);
          memcpy(dd, line.d, sizeof dd);
          qn_scratch_begin(st.scratch);
          qn_line_from_doubles(od, dd, &plain);
          answer_of(&st, &plain, &WHOLE_LINE, got, sizeof got);
          asked++;
          doubles++;
          if (strcmp(want, got) != 0) {
            print_error("%s, %s, way %d, doubles: want [%s] got [%s]\n", c->name, rel->name, way, want, got);
            wrong++;
          }
        }
      }
      stage_close(&st);
    }
  }
  print_message("%u questions, %u of doubles\n", asked, doubles);
  assert_int_equal(wrong, 0);
  assert_true(asked > CASES * RELATIVES * 5);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_hard_cases)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
