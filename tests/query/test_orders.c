/* Every order of a body's and its caps' ends along a ray (design, section 2), and every special case, for each primitive: one named
   test each. c1 < c2 are the ends on the caps, b1 < b2 those on the body; the name says in which order a ray meets them, or which
   special case it is. What is expected was derived by hand from the primitive's equation and is rational.

   Each row is asked in five ways: as it stands; from the other end (d becomes -d, t becomes -t); with a direction four times as
   long; from an origin three steps further; with solid and ray under a rational rotation and a translation. Round solids are asked
   twice more, placed by base and axis along x, and upside down. */
#include "ask.h"

#include <math.h>
#include <stdbool.h>

/* One ray. ray: "ox oy oz dx dy dz", decimals with up to three digits behind the point. inside: "t surface t surface, ..." in
   increasing order; t is a decimal, a fraction p/q, -inf or inf; a surface is b (body), c0, c1, fK (face K), "-" where there is none,
   "*" where several surfaces end the interval at one place. on: the stretches in the boundary, "t t, ...". touch: the contacts, "t ...". */
typedef struct row {
  const char *name, *ray, *inside, *on, *touch;
} row;

typedef struct primitive {
  const char *name, *model;
  const char *placed, *upside; /* the same solid with base = [4, 3, -4] and an axis along +x, -x; or null */
  int flip;                    /* its own z runs from the base along the axis (0), or from h against it (h) */
  bool soft;                   /* a superquadric: t to the last bits only */
  const row *rows;
  size_t count;
} primitive;

/* ---------------------------------------------------------------- numbers: integers over a power of ten, fractions */

typedef struct fraction {
  int64_t p, q; /* q > 0; q = 0: p times infinity */
} fraction;

static fraction read_fraction(const char **at) {
  fraction f = {0, 1};
  const char *s = *at;
  int sign = 1;
  while (*s == ' ' || *s == ',') {
    s++;
  }
  if (*s == '-') {
    sign = -1;
    s++;
  }
  if (strncmp(s, "inf", 3) == 0) {
    *at = s + 3;
    return (fraction){sign, 0};
  }
  assert_true(*s >= '0' && *s <= '9');
  bool point = false;
  for (; (*s >= '0' && *s <= '9') || *s == '.'; s++) {
    if (*s == '.') {
      point = true;
    } else {
      f.p = 10 * f.p + (*s - '0');
      f.q *= point ? 10 : 1;
    }
  }
  if (*s == '/') {
    f.q = 0;
    for (s++; *s >= '0' && *s <= '9'; s++) {
      f.q = 10 * f.q + (*s - '0');
    }
  }
  f.p *= sign;
  *at = s;
  return f;
}
/* The double nearest to (p/q + shift) / scale. Both sides of the quotient are exact, so it is rounded once. */
static double nearest(fraction f, int64_t shift, int64_t scale) {
  return f.q == 0 ? (double)f.p * strtod("inf", NULL) * (scale < 0 ? -1 : 1) : (double)(f.p + shift * f.q) / (double)(f.q * scale);
}

/* ---------------------------------------------------------------- what is expected */

enum { MOST = 8 };
typedef struct end {
  fraction t;
  uint32_t role;
  bool any, none;
} end;
typedef struct answer {
  size_t inside, on, touch;
  end in[2 * MOST];
  fraction stretch[2 * MOST], contact[MOST];
} answer;

static void skip_blanks(const char **at) { *at += strspn(*at, " ,"); }

static end read_end(const char **at) {
  end e = {.t = read_fraction(at)};
  skip_blanks(at);
  const char *s = (*at)++;
  if (*s == 'c') {
    e.role = s[1] == '0' ? QUOIN_CAP0 : QUOIN_CAP1;
    (*at)++;
  } else if (*s == 'f') {
    e.role = QUOIN_FACE + (uint32_t)(s[1] - '0');
    (*at)++;
  } else if (*s == 'b') {
    e.role = QUOIN_BODY;
  } else {
    assert_true(*s == '-' || *s == '*');
    e.any = *s == '*';
    e.none = *s == '-';
  }
  skip_blanks(at);
  return e;
}
static answer read_answer(const row *r) {
  answer a = {0};
  const char *at = r->inside ? r->inside : "";
  while (*at) {
    assert_true(a.inside < MOST);
    a.in[2 * a.inside] = read_end(&at);
    a.in[2 * a.inside + 1] = read_end(&at);
    a.inside++;
  }
  for (at = r->on ? r->on : ""; *at;) {
    assert_true(a.on < MOST);
    a.stretch[2 * a.on] = read_fraction(&at);
    a.stretch[2 * a.on + 1] = read_fraction(&at);
    a.on++;
    skip_blanks(&at);
  }
  for (at = r->touch ? r->touch : ""; *at;) {
    assert_true(a.touch < MOST);
    a.contact[a.touch++] = read_fraction(&at);
    skip_blanks(&at);
  }
  return a;
}

static bool same_t(double got, fraction t, int64_t shift, int64_t scale, bool soft) {
  double want = nearest(t, shift, scale);
  return soft && isfinite(want) ? fabs(got - want) <= 0x1p-48 * (fabs(want) + 1) : got == want;
}
static bool same_end(const quoin_end *got, const end *want, int64_t shift, int64_t scale, bool soft) {
  return same_t(got->t, want->t, shift, scale, soft) && (want->none ? got->part == QUOIN_NO_PART : got->part != QUOIN_NO_PART) &&
         (want->any || want->none || got->role == want->role);
}

/* Whether the answer is the expected one with every t changed to (t + shift) / scale; a negative scale turns the order round. */
static bool same(const quoin_intervals *got, const answer *want, int64_t shift, int64_t scale, bool soft) {
  if (got->count != want->inside || got->boundary_count != want->on || got->contact_count != want->touch) {
    return false;
  }
  bool back = scale < 0;
  for (size_t i = 0; i < want->inside; i++) {
    size_t k = back ? want->inside - 1 - i : i;
    if (!same_end(&got->inside[i].enter, &want->in[2 * k + back], shift, scale, soft) ||
        !same_end(&got->inside[i].leave, &want->in[2 * k + !back], shift, scale, soft)) {
      return false;
    }
  }
  for (size_t i = 0; i < want->on; i++) {
    size_t k = back ? want->on - 1 - i : i;
    if (!same_t(got->boundary[i].enter.t, want->stretch[2 * k + back], shift, scale, soft) ||
        !same_t(got->boundary[i].leave.t, want->stretch[2 * k + !back], shift, scale, soft)) {
      return false;
    }
  }
  for (size_t i = 0; i < want->touch; i++) {
    if (!same_t(got->contacts[i].t, want->contact[back ? want->touch - 1 - i : i], shift, scale, soft)) {
      return false;
    }
  }
  return true;
}

/* ---------------------------------------------------------------- asking */

/* A ray in units of 10^-5: origin, direction. */
typedef struct line {
  int64_t x[6];
} line;

static line read_line(const char *text) {
  line l;
  for (int i = 0; i < 6; i++) {
    fraction f = read_fraction(&text);
    assert_int_equal(100000 % f.q, 0);
    l.x[i] = f.p * (100000 / f.q);
  }
  return l;
}

static void expect(const ask *a, const line *l, const primitive *p, const row *r, const answer *want, int64_t shift, int64_t scale, const char *how) {
  char text[6][40];
  const char *ray[6];
  for (int i = 0; i < 6; i++) {
    snprintf(text[i], sizeof text[i], "%llde-5", (long long)l->x[i]);
    ray[i] = text[i];
  }
  quoin_intervals got;
  assert_int_equal(quoin_ray_intervals_text(a->scene, a->work, ray, NULL, NULL, QUOIN_WANT_BOUNDARY | QUOIN_WANT_CONTACTS, &got), QUOIN_OK);
  if (!same(&got, want, shift, scale, p->soft)) {
    print_error("%s: %s (%s)\nray %s, wanted inside %s on %s touch %s; got", p->name, r->name, how, r->ray, r->inside ? r->inside : "nothing",
                r->on ? r->on : "nothing", r->touch ? r->touch : "nothing");
    for (size_t i = 0; i < got.count; i++) {
      char enter[20], leave[20];
      quoin_role_text(got.inside[i].enter.role, enter, sizeof enter);
      quoin_role_text(got.inside[i].leave.role, leave, sizeof leave);
      print_error(" [%.17g %s, %.17g %s]", got.inside[i].enter.t, enter, got.inside[i].leave.t, leave);
    }
    for (size_t i = 0; i < got.boundary_count; i++) {
      print_error(" on [%.17g, %.17g]", got.boundary[i].enter.t, got.boundary[i].leave.t);
    }
    for (size_t i = 0; i < got.contact_count; i++) {
      print_error(" touch %.17g", got.contacts[i].t);
    }
    print_error("\n");
    fail();
  }
}

/* About z by the angle of (3/5, 4/5), about x by the same, then a translation; the text is of the same map. */
static const char turned_before[] = "translate([7, -0.25, 2]) multmatrix([[1, 0, 0], [0, 3/5, -4/5], [0, 4/5, 3/5]]) "
                                    "multmatrix([[3/5, -4/5, 0], [4/5, 3/5, 0], [0, 0, 1]]) {";
static line turned(line l) {
  for (int k = 0; k < 6; k += 3) {
    int64_t *x = l.x + k;
    int64_t a = (3 * x[0] - 4 * x[1]) / 5, b = (4 * x[0] + 3 * x[1]) / 5; /* multiples of 100, 25: exact */
    x[0] = a;
    x[1] = (3 * b - 4 * x[2]) / 5;
    x[2] = (4 * b + 3 * x[2]) / 5;
  }
  l.x[0] += 700000;
  l.x[1] -= 25000;
  l.x[2] += 200000;
  return l;
}
/* (x, y, z) to (z, y, -x) or (-z, -y, -x), with z counted from the base. */
static line laid(line l, const primitive *p, int sign) {
  for (int k = 0; k < 6; k += 3) {
    int64_t *x = l.x + k, z = p->flip ? (k ? 0 : p->flip * INT64_C(100000)) - x[2] : x[2], first = x[0];
    x[0] = sign * z + (k ? 0 : 400000);
    x[1] = sign * x[1] + (k ? 0 : 300000);
    x[2] = -first - (k ? 0 : 400000);
  }
  return l;
}

typedef struct test {
  const primitive *of;
  const row *row;
} test;

static void check(void **state) {
  const test *t = *state;
  const primitive *p = t->of;
  const answer want = read_answer(t->row);
  const line l = read_line(t->row->ray);
  ask a;
  ask_open(&a, p->model);
  expect(&a, &l, p, t->row, &want, 0, 1, "as it stands");
  line m = l;
  for (int i = 3; i < 6; i++) {
    m.x[i] = -l.x[i];
  }
  expect(&a, &m, p, t->row, &want, 0, -1, "from the other end");
  for (int i = 3; i < 6; i++) {
    m.x[i] = 4 * l.x[i];
  }
  expect(&a, &m, p, t->row, &want, 0, 4, "a longer direction");
  m = l;
  for (int i = 0; i < 3; i++) {
    m.x[i] += 3 * l.x[i + 3];
  }
  expect(&a, &m, p, t->row, &want, -3, 1, "a later origin");
  ask_close(&a);

  char text[2000];
  snprintf(text, sizeof text, "%s %s }", turned_before, p->model);
  ask_open(&a, text);
  m = turned(l);
  expect(&a, &m, p, t->row, &want, 0, 1, "turned");
  ask_close(&a);
  for (int k = 0; k < 2 && p->placed; k++) {
    ask_open(&a, k ? p->upside : p->placed);
    m = laid(l, p, k ? -1 : 1);
    expect(&a, &m, p, t->row, &want, 0, 1, k ? "base and axis, upside down" : "base and axis");
    ask_close(&a);
  }
}

#include "order_rows.h"

int main(void) {
  enum { ROOM = 600, NAME = 160 };
  static struct CMUnitTest tests[ROOM];
  static test of[ROOM];
  static char names[ROOM][NAME];
  size_t n = 0;
  for (size_t i = 0; i < sizeof primitives / sizeof *primitives; i++) {
    for (size_t k = 0; k < primitives[i].count; k++) {
      if (n == ROOM) {
        fprintf(stderr, "too many rows\n");
        return 1;
      }
      of[n] = (test){&primitives[i], &primitives[i].rows[k]};
      snprintf(names[n], NAME, "%s: %s", primitives[i].name, primitives[i].rows[k].name);
      tests[n] = (struct CMUnitTest){.name = names[n], .test_func = check, .initial_state = &of[n]};
      n++;
    }
  }
  return _cmocka_run_group_tests("orders", tests, n, NULL, NULL);
}
