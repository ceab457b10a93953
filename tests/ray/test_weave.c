/* The hard cases and their relatives, the laws, and random scenes against an evaluator of its own in many bits.

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

/* --- random scenes of small integers, against an evaluator in 400 bits ------------------------------------------------ */

static uint64_t seed = 0x2545f4914f6cdd1du;
static uint64_t next(void) {
  seed ^= seed << 13;
  seed ^= seed >> 7;
  seed ^= seed << 17;
  return seed;
}
static int64_t below(int64_t n) { return (int64_t)(next() % (uint64_t)n); }

/* A half-space of a leaf: A..J of the general quadric in world coordinates. */
typedef struct form { int64_t q[10]; } form;
typedef struct leaf { form forms[6]; int count; } leaf;
typedef struct tree { int op, left, right, leaf; } tree; /* op: 'u', 'd', 'i', or 'l' for a leaf */

enum { LEAVES = 6, NODES = 2 * LEAVES };
static leaf leaves[LEAVES];
static int leaf_total;
static tree nodes[NODES];
static int node_total;

static void add_form(leaf *l, int64_t A, int64_t B, int64_t C, int64_t G, int64_t H, int64_t I, int64_t J, const int64_t at[3]) {
  /* moved by at: x -> x - at */
  form *f = &l->forms[l->count++];
  memset(f, 0, sizeof *f);
  f->q[0] = A, f->q[1] = B, f->q[2] = C;
  f->q[6] = G - 2 * A * at[0], f->q[7] = H - 2 * B * at[1], f->q[8] = I - 2 * C * at[2];
  f->q[9] = J + A * at[0] * at[0] + B * at[1] * at[1] + C * at[2] * at[2] - G * at[0] - H * at[1] - I * at[2];
}

static void random_leaf(leaf *l, char *text, size_t size) {
  int64_t at[3] = {below(7) - 3, below(7) - 3, below(7) - 3}, r = 1 + below(4), h = 1 + below(4);
  char body[200];
  l->count = 0;
  switch (below(6)) {
  case 0:
    add_form(l, 1, 1, 1, 0, 0, 0, -r * r, at);
    snprintf(body, sizeof body, "sphere(%d);", (int)r);
    break;
  case 1:
  case 2: {
    int64_t s[3] = {r, h, 1 + below(4)};
    for (int k = 0; k < 3; k++) {
      add_form(l, 0, 0, 0, -(k == 0), -(k == 1), -(k == 2), 0, at);
      add_form(l, 0, 0, 0, k == 0, k == 1, k == 2, -s[k], at);
    }
    snprintf(body, sizeof body, "cube([%d, %d, %d]);", (int)s[0], (int)s[1], (int)s[2]);
    break;
  }
  case 3:
    add_form(l, 1, 1, 0, 0, 0, 0, -r * r, at);
    add_form(l, 0, 0, 0, 0, 0, -1, 0, at);
    add_form(l, 0, 0, 0, 0, 0, 1, -h, at);
    snprintf(body, sizeof body, "cylinder(h = %d, r = %d);", (int)h, (int)r);
    break;
  case 4: /* x^2 + y^2 <= (h - z)^2 */
    add_form(l, 1, 1, -1, 0, 0, 2 * h, -h * h, at);
    add_form(l, 0, 0, 0, 0, 0, -1, 0, at);
    add_form(l, 0, 0, 0, 0, 0, 1, -h, at);
    snprintf(body, sizeof body, "cylinder(h = %d, r1 = %d, r2 = 0);", (int)h, (int)h);
    break;
  default: /* one sheet or two, or a cone of two nappes: not convex, not bounded */
    r = below(3) - 1;
    add_form(l, 1, 1, -1, 0, 0, 0, -r, at);
    snprintf(body, sizeof body, "quadric([1, 1, -1, 0, 0, 0, 0, 0, 0, %d]);", (int)-r);
    break;
  }
  snprintf(text, size, "translate([%d, %d, %d]) %s", (int)at[0], (int)at[1], (int)at[2], body);
}

/* A tree over leaves first .. first + n - 1; its text. */
static int random_tree(int first, int n, char texts[LEAVES][300], char *text, size_t size) {
  int me = node_total++;
  if (n == 1) {
    nodes[me] = (tree){'l', 0, 0, first};
    snprintf(text, size, "%s", texts[first]);
    return me;
  }
  static const char *const words[3] = {"union", "difference", "intersection"};
  int op = (int)below(3), split = 1 + (int)below(n - 1);
  char left[4000], right[4000];
  int a = random_tree(first, split, texts, left, sizeof left), b = random_tree(first + split, n - split, texts, right, sizeof right);
  nodes[me] = (tree){words[op][0], a, b, 0};
  snprintf(text, size, "%s() { %.1900s %.1900s }", words[op], left, right);
  return me;
}

static int value_of(int node, const int *inside) {
  const tree *t = &nodes[node];
  if (t->op == 'l') {
    return inside[t->leaf];
  }
  int a = value_of(t->left, inside), b = value_of(t->right, inside);
  return t->op == 'u' ? a | b : t->op == 'd' ? a & !b : a & b;
}

/* Twice the form along the line: a t^2 + b t + c. */
static void along(const form *f, const int64_t o[3], const int64_t d[3], int64_t p[3]) {
  p[0] = p[1] = 0;
  p[2] = f->q[9];
  for (int k = 0; k < 3; k++) {
    p[0] += f->q[k] * d[k] * d[k];
    p[1] += 2 * f->q[k] * o[k] * d[k] + f->q[6 + k] * d[k];
    p[2] += f->q[k] * o[k] * o[k] + f->q[6 + k] * o[k];
  }
}

enum { BITS = 400, ROOTS = 2 * 6 * LEAVES + 2 };

static int sign_of(const int64_t p[3], mpfr_t t) {
  mpfr_t v;
  mpfr_init2(v, 3 * BITS);
  mpfr_mul_si(v, t, (long)p[0], MPFR_RNDN);
  mpfr_add_si(v, v, (long)p[1], MPFR_RNDN);
  mpfr_mul(v, v, t, MPFR_RNDN);
  mpfr_add_si(v, v, (long)p[2], MPFR_RNDN);
  int s = mpfr_sgn(v);
  mpfr_clear(v);
  return s;
}

static int by_value(const void *a, const void *b) {
  mpfr_srcptr x = a, y = b;
  return mpfr_cmp(x, y);
}

/* The answer by sampling between all roots; 0 when the line runs in a surface. */
static int evaluate(int root, const int64_t o[3], const int64_t d[3], const double range[2], char *out, size_t size, unsigned *ties) {
  mpfr_t roots[ROOTS], x, t;
  int n = 0, runs = 0;
  mpfr_inits2(BITS, x, t, (mpfr_ptr)0);
  for (int i = 0; i < ROOTS; i++) {
    mpfr_init2(roots[i], BITS);
  }
  for (int k = 0; k < 2; k++) {
    if (isfinite(range[k])) {
      mpfr_set_d(roots[n++], range[k], MPFR_RNDN);
    }
  }
  for (int i = 0; i < leaf_total; i++) {
    for (int k = 0; k < leaves[i].count; k++) {
      int64_t p[3];
      along(&leaves[i].forms[k], o, d, p);
      int64_t disc = p[1] * p[1] - 4 * p[0] * p[2];
      runs |= p[0] == 0 && p[1] == 0 && p[2] == 0;
      if (p[0] != 0 && disc >= 0) {
        for (int s = -1; s <= 1; s += 2) {
          mpfr_set_si(x, (long)disc, MPFR_RNDN);
          mpfr_sqrt(x, x, MPFR_RNDN);
          mpfr_mul_si(x, x, s, MPFR_RNDN);
          mpfr_sub_si(x, x, (long)p[1], MPFR_RNDN);
          mpfr_div_si(roots[n++], x, (long)(2 * p[0]), MPFR_RNDN);
        }
      } else if (p[0] == 0 && p[1] != 0) {
        mpfr_set_si(x, (long)-p[2], MPFR_RNDN);
        mpfr_div_si(roots[n++], x, (long)p[1], MPFR_RNDN);
      }
    }
  }
  qsort(roots, (size_t)n, sizeof *roots, by_value);
  int kept = 0;
  for (int i = 0; i < n; i++) {
    if (kept) {
      mpfr_sub(x, roots[i], roots[kept - 1], MPFR_RNDN);
      if (mpfr_zero_p(x) || mpfr_get_exp(x) < -BITS / 2) {
        ++*ties;
        continue;
      }
    }
    mpfr_set(roots[kept++], roots[i], MPFR_RNDN);
  }
  out[0] = '\0';
  int was = 0;
  for (int i = 0; i <= kept; i++) { /* the stretch before root i */
    if (kept == 0) {
      mpfr_set_si(t, 0, MPFR_RNDN);
    } else if (i == 0) {
      mpfr_sub_si(t, roots[0], 1, MPFR_RNDN);
    } else if (i == kept) {
      mpfr_add_si(t, roots[kept - 1], 1, MPFR_RNDN);
    } else {
      mpfr_add(t, roots[i - 1], roots[i], MPFR_RNDN);
      mpfr_div_si(t, t, 2, MPFR_RNDN);
    }
    int inside[LEAVES];
    for (int k = 0; k < leaf_total; k++) {
      inside[k] = 1;
      for (int f = 0; f < leaves[k].count; f++) {
        int64_t p[3];
        along(&leaves[k].forms[f], o, d, p);
        inside[k] &= sign_of(p, t) < 0;
      }
    }
    int now = value_of(root, inside) && mpfr_cmp_d(t, range[0]) > 0 && mpfr_cmp_d(t, range[1]) < 0;
    if (now != was) {
      double end = i == 0 ? -HUGE_VAL : mpfr_get_d(roots[i - 1], MPFR_RNDN);
      add_number(out, size, end == 0 ? 0 : end);
    }
    was = now;
  }
  if (was) {
    add_number(out, size, HUGE_VAL);
  }
  for (int i = 0; i < ROOTS; i++) {
    mpfr_clear(roots[i]);
  }
  mpfr_clears(x, t, (mpfr_ptr)0);
  return !runs;
}

static void inside_of(stage *st, qn_line *line, const qn_range *range, unsigned want, char *out, size_t size) {
  qn_woven w;
  assert_int_equal(qn_weave(st->scene, st->scratch, line, range, want, &w), QUOIN_OK);
  out[0] = '\0';
  for (size_t i = 0; i < w.inside_count; i++) {
    add_number(out, size, qn_place_round(st->scene, st->scratch, line, &w.inside[i].enter.place));
    add_number(out, size, qn_place_round(st->scene, st->scratch, line, &w.inside[i].leave.place));
  }
}

static void test_random_scenes(void **state) {
  (void)state;
  unsigned rays = 0, in_surface = 0, with_answer = 0, ties = 0, wrong = 0, many = 0, cut = 0;
  qn_counts counts = {0};
  for (int n = 0; n < 600; n++) {
    char texts[LEAVES][300], text[4000];
    leaf_total = 1 + (int)below(LEAVES);
    node_total = 0;
    for (int i = 0; i < leaf_total; i++) {
      random_leaf(&leaves[i], texts[i], sizeof texts[i]);
    }
    int root = random_tree(0, leaf_total, texts, text, sizeof text);
    stage st = stage_open(text);
    for (int k = 0; k < 60; k++) {
      int64_t o[3], d[3];
      int aimed = below(2) == 0;
      do {
        for (int j = 0; j < 3; j++) {
          o[j] = below(15) - 7;
          d[j] = aimed ? below(7) - 2 - o[j] : below(3) == 0 ? 0 : below(9) - 4;
        }
      } while (d[0] == 0 && d[1] == 0 && d[2] == 0);
      double range[2] = {-HUGE_VAL, HUGE_VAL}, od[3], dd[3];
      if (below(4) == 0) {
        range[0] = (double)(below(17) - 8) / 4;
      }
      if (below(4) == 0) {
        range[1] = (isfinite(range[0]) ? range[0] : -2) + (double)(1 + below(12)) / 4;
      }
      cut += isfinite(range[0]) || isfinite(range[1]);
      for (int j = 0; j < 3; j++) {
        od[j] = (double)o[j];
        dd[j] = (double)d[j];
      }
      char want[2000], got[2000], first[2000];
      int plain = evaluate(root, o, d, range, want, sizeof want, &ties);
      qn_range part = WHOLE_LINE;
      part.from.t = range[0];
      part.to.t = range[1];
      qn_line line;
      qn_scratch_begin(st.scratch);
      qn_line_from_doubles(od, dd, &line);
      inside_of(&st, &line, &part, 0, got, sizeof got);
      rays++;
      if (!plain) {
        in_surface++;
        continue;
      }
      with_answer += want[0] != 0;
      many += strchr(want, ' ') && strchr(strchr(want, ' ') + 1, ' ');
      int same = strcmp(want, got) == 0;
      if (same) { /* with more wanted, and with less */
        inside_of(&st, &line, &part, QUOIN_WANT_BOUNDARY | QUOIN_WANT_CONTACTS, got, sizeof got);
        same = strcmp(want, got) == 0;
        inside_of(&st, &line, &part, QN_WANT_FIRST, first, sizeof first);
        same &= strncmp(want, first, strlen(first)) == 0 && (first[0] != 0) == (want[0] != 0);
      }
      if (!same && wrong++ < 10) {
        print_error("%s\n  o %d %d %d d %d %d %d range %g %g\n  want [%s]\n  got  [%s]\n", text, (int)o[0], (int)o[1], (int)o[2], (int)d[0], (int)d[1], (int)d[2], range[0],
                    range[1], want, got);
      }
    }
    const qn_counts *c = qn_scratch_counts(st.scratch);
    counts.filter_sure += c->filter_sure;
    counts.exact_signs += c->exact_signs;
    counts.exact_orders += c->exact_orders;
    counts.exact_roundings += c->exact_roundings;
    stage_close(&st);
  }
  print_message("%u rays, %u in a surface, %u with an answer, %u of many pieces, %u cut, %u ties; sure %llu, exact signs %llu, orders %llu, roundings %llu\n", rays, in_surface,
                with_answer, many, cut, ties, (unsigned long long)counts.filter_sure, (unsigned long long)counts.exact_signs, (unsigned long long)counts.exact_orders,
                (unsigned long long)counts.exact_roundings);
  assert_int_equal(wrong, 0);
  assert_true(in_surface > 500 && with_answer > 3000 && many > 300 && cut > 5000 && ties > 10000);
}

/* --- boxes: what is beside a line that runs in faces or touches corners, by the eight octants of a point -------------- */

/* The side at t: 0 outside, 1 boundary, 2 inside. */
static int octants(int root, const int64_t o[3], const int64_t d[3], mpfr_t t) {
  int in = 0;
  for (int v = 0; v < 8; v++) {
    int inside[LEAVES];
    for (int k = 0; k < leaf_total; k++) {
      inside[k] = 1;
      for (int f = 0; f < leaves[k].count; f++) {
        int64_t p[3];
        const int64_t *q = leaves[k].forms[f].q;
        along(&leaves[k].forms[f], o, d, p);
        mpfr_t value;
        mpfr_init2(value, BITS);
        mpfr_mul_si(value, t, (long)p[1], MPFR_RNDN);
        mpfr_add_si(value, value, (long)p[2], MPFR_RNDN);
        int sign = mpfr_zero_p(value) || mpfr_get_exp(value) < -BITS / 2 ? 0 : mpfr_sgn(value);
        mpfr_clear(value);
        if (sign == 0) { /* the face's normal is along one axis */
          for (int j = 0; j < 3; j++) {
            sign += (int)q[6 + j] * (v >> j & 1 ? 1 : -1);
          }
        }
        inside[k] &= sign < 0;
      }
    }
    in += value_of(root, inside);
  }
  return in == 8 ? 2 : in > 0;
}

static void boxes_answer(int root, const int64_t o[3], const int64_t d[3], const double range[2], char *out, size_t size, unsigned *on, unsigned *at) {
  mpfr_t roots[ROOTS], t;
  int n = 0, side[ROOTS], runs = 0, touches = 0;
  int seen[ROOTS];
  mpfr_init2(t, BITS);
  for (int k = 0; k < 2; k++) {
    if (isfinite(range[k])) {
      mpfr_init2(roots[n], BITS);
      mpfr_set_d(roots[n++], range[k], MPFR_RNDN);
    }
  }
  for (int i = 0; i < leaf_total; i++) {
    for (int k = 0; k < leaves[i].count; k++) {
      int64_t p[3];
      along(&leaves[i].forms[k], o, d, p);
      if (p[1]) {
        mpfr_init2(roots[n], BITS);
        mpfr_set_si(t, (long)-p[2], MPFR_RNDN);
        mpfr_div_si(roots[n++], t, (long)p[1], MPFR_RNDN);
      }
    }
  }
  qsort(roots, (size_t)n, sizeof *roots, by_value);
  int kept = 0;
  for (int i = 0; i < n; i++) {
    if (kept == 0 || !mpfr_equal_p(roots[i], roots[kept - 1])) {
      mpfr_swap(roots[kept++], roots[i]);
    }
  }
  for (int i = 0; i <= kept; i++) {
    if (i == 0) {
      mpfr_sub_si(t, roots[0], 1, MPFR_RNDN);
    } else if (i == kept) {
      mpfr_add_si(t, roots[kept - 1], 1, MPFR_RNDN);
    } else {
      mpfr_add(t, roots[i - 1], roots[i], MPFR_RNDN);
      mpfr_div_si(t, t, 2, MPFR_RNDN);
    }
    side[i] = octants(root, o, d, t);
    seen[i] = mpfr_cmp_d(t, range[0]) > 0 && mpfr_cmp_d(t, range[1]) < 0 ? side[i] : 0;
  }
  out[0] = '\0';
  for (int wanted = 2; wanted >= 1; wanted--) {
    for (int i = 1; i <= kept; i++) {
      if ((seen[i] == wanted) != (seen[i - 1] == wanted)) {
        if (wanted == 1 && !runs++) {
          snprintf(out + strlen(out), size - strlen(out), "%son", out[0] ? " " : "");
        }
        double end = mpfr_get_d(roots[i - 1], MPFR_RNDN);
        add_number(out, size, end == 0 ? 0 : end);
      }
    }
  }
  for (int i = 0; i < kept; i++) {
    if (side[i] == 0 && side[i + 1] == 0 && mpfr_cmp_d(roots[i], range[0]) >= 0 && mpfr_cmp_d(roots[i], range[1]) <= 0 && octants(root, o, d, roots[i])) {
      if (!touches++) {
        snprintf(out + strlen(out), size - strlen(out), "%sat", out[0] ? " " : "");
      }
      double touch = mpfr_get_d(roots[i], MPFR_RNDN);
      add_number(out, size, touch == 0 ? 0 : touch);
    }
  }
  *on += runs > 0;
  *at += touches > 0;
  for (int i = 0; i < n; i++) {
    mpfr_clear(roots[i]);
  }
  mpfr_clear(t);
}

static void stretches_of(stage *st, qn_line *line, const qn_range *range, char *out, size_t size) {
  qn_woven w;
  assert_int_equal(qn_weave(st->scene, st->scratch, line, range, QUOIN_WANT_BOUNDARY, &w), QUOIN_OK);
  out[0] = '\0';
  for (size_t i = 0; i < w.inside_count + w.boundary_count; i++) {
    const qn_stretch *piece = i < w.inside_count ? &w.inside[i] : &w.boundary[i - w.inside_count];
    if (i == w.inside_count) {
      snprintf(out + strlen(out), size - strlen(out), "%son", out[0] ? " " : "");
    }
    add_number(out, size, qn_place_round(st->scene, st->scratch, line, &piece->enter.place));
    add_number(out, size, qn_place_round(st->scene, st->scratch, line, &piece->leave.place));
  }
}

static void test_boxes(void **state) {
  (void)state;
  unsigned rays = 0, on = 0, at = 0, answers = 0, wrong = 0;
  for (int n = 0; n < 200; n++) {
    char texts[LEAVES][300], text[4000];
    leaf_total = 1 + (int)below(LEAVES);
    node_total = 0;
    for (int i = 0; i < leaf_total; i++) {
      int64_t corner[3] = {below(4), below(4), below(4)}, s[3] = {1 + below(3), 1 + below(3), 1 + below(3)};
      leaves[i].count = 0;
      for (int k = 0; k < 3; k++) {
        add_form(&leaves[i], 0, 0, 0, -(k == 0), -(k == 1), -(k == 2), 0, corner);
        add_form(&leaves[i], 0, 0, 0, k == 0, k == 1, k == 2, -s[k], corner);
      }
      snprintf(texts[i], sizeof texts[i], "translate([%d, %d, %d]) cube([%d, %d, %d]);", (int)corner[0], (int)corner[1], (int)corner[2], (int)s[0], (int)s[1], (int)s[2]);
    }
    int root = random_tree(0, leaf_total, texts, text, sizeof text);
    stage st = stage_open(text);
    for (int k = 0; k < 40; k++) {
      int64_t o[3], d[3];
      int aligned = below(2) == 0;
      do {
        for (int j = 0; j < 3; j++) {
          o[j] = below(8) - 1;
          d[j] = aligned ? (below(2) ? 0 : below(3) - 1) : below(5) - 2;
        }
      } while (d[0] == 0 && d[1] == 0 && d[2] == 0);
      double od[3], dd[3];
      for (int j = 0; j < 3; j++) {
        od[j] = (double)o[j];
        dd[j] = (double)d[j];
      }
      char want[2000], got[2000];
      double range[2] = {-HUGE_VAL, HUGE_VAL};
      if (below(4) == 0) {
        range[0] = (double)(below(21) - 10) / 2;
      }
      if (below(4) == 0) {
        range[1] = (isfinite(range[0]) ? range[0] : -4) + (double)(1 + below(12)) / 2;
      }
      boxes_answer(root, o, d, range, want, sizeof want, &on, &at);
      qn_range part = WHOLE_LINE;
      part.from.t = range[0];
      part.to.t = range[1];
      qn_line line;
      qn_scratch_begin(st.scratch);
      qn_line_from_doubles(od, dd, &line);
      answer_of(&st, &line, &part, got, sizeof got);
      if (strncmp(want, got, strlen(want)) == 0) { /* without contacts, which are woven in another way */
        stretches_of(&st, &line, &part, got, sizeof got);
        char *at_end = strstr(want, "at");
        if (at_end) {
          *(at_end == want ? at_end : at_end - 1) = '\0';
        }
      }
      rays++;
      answers += want[0] != 0;
      if (strcmp(want, got) != 0 && wrong++ < 10) {
        print_error("%s\n  o %d %d %d d %d %d %d\n  want [%s]\n  got  [%s]\n", text, (int)o[0], (int)o[1], (int)o[2], (int)d[0], (int)d[1], (int)d[2], want, got);
      }
    }
    stage_close(&st);
  }
  print_message("%u rays, %u with an answer, %u on a boundary, %u contacts\n", rays, answers, on, at);
  assert_int_equal(wrong, 0);
  assert_true(rays == 8000 && answers > 500 && on > 300 && at > 200);
}

/* Names of ends: the leaf and the half-space that make each. */
static void test_ends(void **state) {
  (void)state;
  stage st = stage_open("difference() { cube(3); translate([1, 1, -1]) cylinder(h = 5, r = 0.5); }");
  qn_line line;
  const double o[3] = {-1, 1, 1}, d[3] = {1, 0, 0};
  qn_scratch_begin(st.scratch);
  qn_line_from_doubles(o, d, &line);
  qn_woven w;
  assert_int_equal(qn_weave(st.scene, st.scratch, &line, &WHOLE_LINE, 0, &w), QUOIN_OK);
  assert_int_equal(w.inside_count, 2);
  const qn_half *halves = st.scene->halves;
  assert_int_equal(w.inside[0].enter.leaf, 0);
  assert_true(halves[w.inside[0].enter.half].role >= QUOIN_FACE);
  assert_int_equal(w.inside[0].leave.leaf, 1);
  assert_int_equal(halves[w.inside[0].leave.half].role, QUOIN_BODY);
  assert_int_equal(w.inside[1].enter.leaf, 1);
  assert_int_equal(halves[w.inside[1].enter.half].role, QUOIN_BODY);
  assert_int_equal(w.inside[1].leave.leaf, 0);
  /* the ray's ends have no leaf, unless a surface is right there */
  qn_range part = WHOLE_LINE;
  part.from.t = 1.25;
  part.to.t = 4;
  assert_int_equal(qn_weave(st.scene, st.scratch, &line, &part, 0, &w), QUOIN_OK);
  assert_int_equal(w.inside_count, 2);
  assert_int_equal(w.inside[0].enter.leaf, UINT32_MAX);
  assert_true(w.inside[0].enter.place.t == 1.25 && w.inside[0].enter.place.e == 0);
  assert_int_equal(w.inside[1].leave.leaf, 0);
  /* the same range as a rational that is no double */
  part.from.t = 1.3;
  part.from.e = 0x1p-52;
  part.from.num = qn_int_from(qn_scratch_ctx(st.scratch), 13);
  part.from.den = qn_int_from(qn_scratch_ctx(st.scratch), 10);
  assert_int_equal(qn_weave(st.scene, st.scratch, &line, &part, 0, &w), QUOIN_OK);
  assert_true(qn_place_round(st.scene, st.scratch, &line, &w.inside[0].enter.place) == 1.3);
  /* an end of one stretch is a place to begin at */
  qn_place here = w.inside[0].leave.place;
  part.from = here;
  part.to = WHOLE_LINE.to;
  assert_int_equal(qn_weave(st.scene, st.scratch, &line, &part, 0, &w), QUOIN_OK);
  assert_int_equal(w.inside_count, 1);
  assert_int_equal(qn_place_cmp(st.scene, st.scratch, &line, &here, &w.inside[0].enter.place), -1);
  assert_int_equal(qn_place_cmp(st.scene, st.scratch, &line, &w.inside[0].enter.place, &w.inside[0].enter.place), 0);
  stage_close(&st);
}

/* Ends at one place: which leaf is named, and that a range that begins in a wall that is none begins inside. */
static void test_shared_ends(void **state) {
  (void)state;
  static const struct { const char *model; double from; uint32_t enter, leave; } asked[] = {
    {"intersection() { cube(1); cube([1, 2, 2]); }", -HUGE_VAL, 1, 0},            /* the second makes it true, the first makes it false */
    {"cube(1); cube([1, 2, 2]);", -HUGE_VAL, 0, 1},
    {"difference() { cube([2, 1, 1]); translate([1, 0, 0]) cube(3); }", -HUGE_VAL, 0, 1},
    {"cube(1); translate([1, 0, 0]) cube(1);", -HUGE_VAL, 0, 1},
    {"cube(1); translate([1, 0, 0]) cube(1);", 2, UINT32_MAX, 1},                 /* t = 2 is x = 1: no wall */
    {"translate([1, 0, 0]) cube(1);", 2, 0, 0},                                   /* a wall */
    {"difference() { cube([3, 1, 1]); cube(1); }", 2, 1, 0},
  };
  for (size_t i = 0; i < sizeof asked / sizeof *asked; i++) {
    stage st = stage_open(asked[i].model);
    const double o[3] = {-1, 0.5, 0.5}, d[3] = {1, 0, 0};
    qn_range part = WHOLE_LINE;
    part.from.t = asked[i].from;
    qn_line line;
    qn_scratch_begin(st.scratch);
    qn_line_from_doubles(o, d, &line);
    qn_woven w;
    assert_int_equal(qn_weave(st.scene, st.scratch, &line, &part, 0, &w), QUOIN_OK);
    assert_int_equal(w.inside_count, 1);
    assert_int_equal(w.inside[0].enter.leaf, asked[i].enter);
    assert_int_equal(w.inside[0].leave.leaf, asked[i].leave);
    stage_close(&st);
  }
}

/* A superquadric with other solids: its places are their doubles. */
static void test_superquadric(void **state) {
  (void)state;
  stage st = stage_open("difference() { superquadric(r = [1, 1, 1], e = 0.3, n = 0.3); cube([2, 2, 2]); }");
  qn_line line;
  const double o[3] = {-3, 0.25, 0.25}, d[3] = {1, 0, 0};
  qn_scratch_begin(st.scratch);
  qn_line_from_doubles(o, d, &line);
  qn_woven w;
  assert_int_equal(qn_weave(st.scene, st.scratch, &line, &WHOLE_LINE, 0, &w), QUOIN_OK);
  assert_int_equal(w.inside_count, 1);
  assert_true(fabs(qn_place_round(st.scene, st.scratch, &line, &w.inside[0].enter.place) - 2) < 1e-3);
  assert_true(qn_place_round(st.scene, st.scratch, &line, &w.inside[0].leave.place) == 3);
  stage_close(&st);
}

/* With every bound of memory, the answer is right or refused. */
typedef struct purse { size_t left; } purse;
static void *purse_alloc(void *user, size_t size) {
  purse *p = user;
  if (p->left == 0) {
    return NULL;
  }
  p->left--;
  return malloc(size);
}
static void *purse_resize(void *user, void *block, size_t old_size, size_t new_size) {
  purse *p = user;
  (void)old_size;
  if (p->left == 0) {
    return NULL;
  }
  p->left--;
  return realloc(block, new_size);
}
static void purse_release(void *user, void *block, size_t size) {
  (void)user, (void)size;
  free(block);
}

static void test_memory(void **state) {
  (void)state;
  purse p = {SIZE_MAX};
  quoin_allocator allocator = {purse_alloc, purse_resize, purse_release, &p, 0};
  quoin_model *model;
  quoin_scene *scene;
  const char *text = "difference() { cube(1); translate([1, 0, 0]) cube(1); sphere(0.6); }";
  assert_int_equal(quoin_model_new(&allocator, &model), QUOIN_OK);
  assert_int_equal(quoin_model_read_text(model, QUOIN_ROOT, "test", text, strlen(text), NULL), QUOIN_OK);
  assert_int_equal(quoin_scene_compile(model, NULL, &scene), QUOIN_OK);
  unsigned refused = 0, done = 0;
  for (size_t budget = 0; budget < 400 && done < 3; budget++) {
    p.left = budget;
    qn_scratch *scratch;
    quoin_status status = qn_scratch_new(scene, &scratch);
    if (status == QUOIN_OK) {
      qn_line line;
      const double o[3] = {1, 0.5, -1}, d[3] = {0, 0, 1};
      qn_woven w;
      qn_scratch_begin(scratch);
      qn_line_from_doubles(o, d, &line);
      status = qn_weave(scene, scratch, &line, &WHOLE_LINE, QUOIN_WANT_BOUNDARY | QUOIN_WANT_CONTACTS, &w);
      if (status == QUOIN_OK) {
        done++;
        assert_int_equal(w.inside_count, 0);
        assert_int_equal(w.boundary_count, 1);
      }
      p.left = SIZE_MAX; /* and the next question is answered */
      qn_scratch_begin(scratch);
      qn_line_from_doubles(o, d, &line); /* the earlier one's integers are gone */
      assert_int_equal(qn_weave(scene, scratch, &line, &WHOLE_LINE, QUOIN_WANT_BOUNDARY, &w), QUOIN_OK);
      assert_int_equal(w.boundary_count, 1);
    }
    if (status != QUOIN_OK) {
      assert_int_equal(status, QUOIN_E_MEMORY);
      refused++;
    }
    p.left = SIZE_MAX;
    qn_scratch_free(scratch);
  }
  assert_true(refused > 5 && done == 3);
  quoin_scene_free(scene);
  quoin_model_free(model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_hard_cases), cmocka_unit_test(test_random_scenes), cmocka_unit_test(test_boxes), cmocka_unit_test(test_ends), cmocka_unit_test(test_shared_ends), cmocka_unit_test(test_superquadric), cmocka_unit_test(test_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
