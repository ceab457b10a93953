/* Laws of sets and of lines (design S5, S8, S9) on random solids full of ties: complement, De Morgan, A - A, operand order,
   translation by decimals, reversal, scaling of the direction; and what intervals and sides say of one another. */
#include "ask.h"
#include "random_solid.h"

#include <math.h>

enum { SOLIDS = 300, RAYS = 40, TEXT = 4000 };

/* Halves: o = n/2, d = m/2; on the grid so that ties occur. */
static void random_ray(dice *d, int o[3], int v[3]) {
  do {
    for (int i = 0; i < 3; i++) {
      o[i] = roll(d, 2) ? 2 * (roll(d, 5) - 2) : roll(d, 9) - 4;
      v[i] = roll(d, 3) ? 2 * (roll(d, 3) - 1) : roll(d, 9) - 4;
    }
  } while (v[0] == 0 && v[1] == 0 && v[2] == 0);
}

static quoin_ray ray_of(const int o[3], const int v[3], double turn) {
  quoin_ray r = {.from = -strtod("inf", NULL), .to = strtod("inf", NULL)};
  for (int i = 0; i < 3; i++) {
    r.o[i] = 0.5 * o[i];
    r.d[i] = turn * 0.5 * v[i];
  }
  return r;
}

typedef struct list { size_t n, boundary; double t[64], b[64]; } list;

static list stretches(const ask *a, const quoin_ray *ray) {
  quoin_intervals got;
  list l = {0};
  assert_int_equal(quoin_ray_intervals(a->scene, a->work, ray, QUOIN_WANT_BOUNDARY, &got), QUOIN_OK);
  assert_true(got.count <= 32 && got.boundary_count <= 32);
  for (size_t i = 0; i < got.count; i++) {
    l.t[l.n++] = got.inside[i].enter.t;
    l.t[l.n++] = got.inside[i].leave.t;
  }
  for (size_t i = 0; i < got.boundary_count; i++) {
    l.b[l.boundary++] = got.boundary[i].enter.t;
    l.b[l.boundary++] = got.boundary[i].leave.t;
  }
  return l;
}

static void same(const list *a, const list *b, const char *law, const char *text, const int o[3], const int v[3]) {
  int wrong = a->n != b->n || a->boundary != b->boundary || memcmp(a->t, b->t, a->n * sizeof *a->t) != 0 || memcmp(a->b, b->b, a->boundary * sizeof *a->b) != 0;
  if (wrong) {
    print_error("%s\n%s\no = %d/2 %d/2 %d/2, d = %d/2 %d/2 %d/2\n", law, text, o[0], o[1], o[2], v[0], v[1], v[2]);
    for (int k = 0; k < 2; k++) {
      const list *l = k ? b : a;
      for (size_t i = 0; i < l->n; i++) {
        print_error(" %.17g", l->t[i]);
      }
      print_error(" ;");
      for (size_t i = 0; i < l->boundary; i++) {
        print_error(" %.17g", l->b[i]);
      }
      print_error("\n");
    }
  }
  assert_false(wrong);
}

static void same_point(const ask *a, const ask *b, const double p[3], const char *law, const char *text) {
  quoin_side x, y;
  assert_int_equal(quoin_point_side(a->scene, a->work, p, &x), QUOIN_OK);
  assert_int_equal(quoin_point_side(b->scene, b->work, p, &y), QUOIN_OK);
  if (x != y) {
    print_error("%s\n%s\nat %g %g %g: %d, %d\n", law, text, p[0], p[1], p[2], x, y);
  }
  assert_int_equal(x, y);
}

/* Two texts are one solid. */
static void alike(const char *x, const char *y, const char *law, dice *d) {
  ask a, b;
  ask_open(&a, x);
  ask_open(&b, y);
  for (int k = 0; k < RAYS; k++) {
    int o[3], v[3];
    random_ray(d, o, v);
    quoin_ray ray = ray_of(o, v, 1);
    list p = stretches(&a, &ray), q = stretches(&b, &ray);
    same(&p, &q, law, x, o, v);
    same_point(&a, &b, (double[]){0.5 * o[0], 0.5 * o[1], 0.5 * o[2]}, law, x);
  }
  ask_close(&a);
  ask_close(&b);
}

static void de_morgan(void **state) {
  (void)state;
  dice d = {0x9e3779b97f4a7c15u};
  for (int i = 0; i < SOLIDS; i++) {
    char p[TEXT], q[TEXT], x[3 * TEXT], y[3 * TEXT];
    random_solid(&d, 0, 1 + roll(&d, 3), p, sizeof p);
    random_solid(&d, 0, 1 + roll(&d, 3), q, sizeof q);
    snprintf(x, sizeof x, "difference() { cube(20, center=true); union() { %s %s } }", p, q);
    snprintf(y, sizeof y, "intersection() { difference() { cube(20, center=true); %s } difference() { cube(20, center=true); %s } }", p, q);
    alike(x, y, "De Morgan, union", &d);
    snprintf(x, sizeof x, "difference() { cube(20, center=true); intersection() { %s %s } }", p, q);
    snprintf(y, sizeof y, "union() { difference() { cube(20, center=true); %s } difference() { cube(20, center=true); %s } }", p, q);
    alike(x, y, "De Morgan, intersection", &d);
  }
}

static void order_of_operands(void **state) {
  (void)state;
  dice d = {0x2545f4914f6cdd1du};
  for (int i = 0; i < SOLIDS; i++) {
    char p[TEXT], q[TEXT], r[TEXT], x[4 * TEXT], y[4 * TEXT];
    random_solid(&d, 0, 1 + roll(&d, 2), p, sizeof p);
    random_solid(&d, 0, 1 + roll(&d, 2), q, sizeof q);
    random_solid(&d, 0, 1 + roll(&d, 2), r, sizeof r);
    static const char *const words[] = {"union", "intersection"};
    const char *word = words[roll(&d, 2)];
    snprintf(x, sizeof x, "%s() { %s %s %s }", word, p, q, r);
    snprintf(y, sizeof y, "%s() { %s %s() { %s %s } }", word, r, word, p, q);
    alike(x, y, "order", &d);
    snprintf(x, sizeof x, "difference() { %s %s %s }", p, q, r);
    snprintf(y, sizeof y, "difference() { difference() { %s %s } %s }", p, r, q);
    alike(x, y, "order of subtraction", &d);
  }
}

static void nothing(void **state) {
  (void)state;
  dice d = {0xd1342543de82ef95u};
  for (int i = 0; i < SOLIDS; i++) {
    char p[TEXT], x[3 * TEXT];
    random_solid(&d, 0, 1 + roll(&d, 4), p, sizeof p);
    snprintf(x, sizeof x, "difference() { %s rotate(360) %s }", p, p);
    ask a;
    ask_open(&a, x);
    for (int k = 0; k < RAYS; k++) {
      int o[3], v[3];
      random_ray(&d, o, v);
      quoin_ray ray = ray_of(o, v, 1);
      list l = stretches(&a, &ray);
      quoin_side side;
      assert_int_equal(l.n + l.boundary, 0);
      assert_int_equal(quoin_point_side(a.scene, a.work, ray.o, &side), QUOIN_OK);
      assert_int_equal(side, QUOIN_OUTSIDE);
    }
    ask_close(&a);
  }
}

static void complement(void **state) {
  (void)state;
  dice d = {0xaf251af3b0f025b5u};
  for (int i = 0; i < SOLIDS; i++) {
    char p[TEXT], x[2 * TEXT];
    random_solid(&d, 0, 1 + roll(&d, 4), p, sizeof p);
    snprintf(x, sizeof x, "difference() { cube(20, center=true); %s }", p);
    ask a, b;
    ask_open(&a, p);
    ask_open(&b, x);
    for (int k = 0; k < RAYS; k++) {
      int o[3], v[3];
      random_ray(&d, o, v);
      quoin_ray ray = ray_of(o, v, 1);
      list in = stretches(&a, &ray), out = stretches(&b, &ray);
      /* Inside, boundary and complement tile the line's stretch in the big cube: merge by ends. */
      size_t i1 = 0, i2 = 0, i3 = 0, used = 0;
      assert_true(in.n + in.boundary + out.n > 0);
      assert_int_equal(in.boundary, out.boundary);
      assert_memory_equal(in.b, out.b, in.boundary * sizeof *in.b);
      double at = -strtod("inf", NULL), begin = at;
      for (;; used++) {
        double next = strtod("inf", NULL);
        size_t *who = NULL;
        const double *ends = NULL;
        if (i1 < in.n && in.t[i1] <= next) { next = in.t[i1], who = &i1, ends = in.t; }
        if (i2 < out.n && out.t[i2] < next) { next = out.t[i2], who = &i2, ends = out.t; }
        if (i3 < in.boundary && in.b[i3] < next) { next = in.b[i3], who = &i3, ends = in.b; }
        if (!who) {
          break;
        }
        if (used == 0) {
          begin = next;
        } else {
          assert_true(next == at); /* no gap, no overlap */
        }
        at = ends[*who + 1];
        *who += 2;
      }
      assert_true(begin < at);
      for (int s = 0; s < 2; s++) { /* and its ends are the cube's */
        double t = s ? at : begin, far = 0;
        for (int j = 0; j < 3; j++) {
          far = fmax(far, fabs(ray.o[j] + t * ray.d[j]));
        }
        assert_true(fabs(far - 10) < 1e-12);
      }
      quoin_side x1, x2;
      assert_int_equal(quoin_point_side(a.scene, a.work, ray.o, &x1), QUOIN_OK);
      assert_int_equal(quoin_point_side(b.scene, b.work, ray.o, &x2), QUOIN_OK);
      assert_int_equal(x1 + x2, 2);
    }
    ask_close(&a);
    ask_close(&b);
  }
}

static void lines(void **state) {
  (void)state;
  dice d = {0x94d049bb133111ebu};
  size_t inside_points = 0, ends = 0;
  for (int i = 0; i < SOLIDS; i++) {
    char p[TEXT], x[2 * TEXT];
    int planar = i % 3 == 0;
    random_solid(&d, planar, 1 + roll(&d, 4), p, sizeof p);
    snprintf(x, sizeof x, "translate([0.1,-0.3,1000.7]) { %s }", p);
    ask a, b;
    ask_open(&a, p);
    ask_open(&b, x);
    for (int k = 0; k < RAYS; k++) {
      int o[3], v[3];
      random_ray(&d, o, v);
      quoin_ray ray = ray_of(o, v, 1), back = ray_of(o, v, -1), fast = ray_of(o, v, 0x1p+40);
      list l = stretches(&a, &ray), r = stretches(&a, &back), f = stretches(&a, &fast), turned = r, slow = f;
      for (size_t e = 0; e < r.n; e++) {
        turned.t[e] = -r.t[r.n - 1 - e] + 0.0;
      }
      for (size_t e = 0; e < r.boundary; e++) {
        turned.b[e] = -r.b[r.boundary - 1 - e] + 0.0;
      }
      same(&l, &turned, "reversal", p, o, v);
      for (size_t e = 0; e < f.n; e++) {
        slow.t[e] = f.t[e] * 0x1p+40;
      }
      for (size_t e = 0; e < f.boundary; e++) {
        slow.b[e] = f.b[e] * 0x1p+40;
      }
      same(&l, &slow, "a longer direction", p, o, v);
      /* translated by decimals that no double holds */
      char moved[6][40];
      const char *text[6];
      static const int tenths[3] = {1, -3, 10007};
      for (int j = 0; j < 3; j++) {
        int n = 5 * o[j] + tenths[j];
        snprintf(moved[j], sizeof *moved, "%s%d.%d", n < 0 ? "-" : "", abs(n) / 10, abs(n) % 10);
        snprintf(moved[3 + j], sizeof *moved, "%de-1", 5 * v[j]);
        text[j] = moved[j], text[3 + j] = moved[3 + j];
      }
      quoin_intervals got;
      list m = {0};
      assert_int_equal(quoin_ray_intervals_text(b.scene, b.work, text, NULL, NULL, QUOIN_WANT_BOUNDARY, &got), QUOIN_OK);
      for (size_t e = 0; e < got.count; e++) {
        m.t[m.n++] = got.inside[e].enter.t, m.t[m.n++] = got.inside[e].leave.t;
      }
      for (size_t e = 0; e < got.boundary_count; e++) {
        m.b[m.boundary++] = got.boundary[e].enter.t, m.b[m.boundary++] = got.boundary[e].leave.t;
      }
      same(&l, &m, "translation", p, o, v);
      quoin_side s1, s2;
      assert_int_equal(quoin_point_side(a.scene, a.work, ray.o, &s1), QUOIN_OK);
      assert_int_equal(quoin_point_side_text(b.scene, b.work, text, &s2), QUOIN_OK);
      assert_int_equal(s1, s2);
      /* a point within a stretch (a little off its middle: a ray may touch a hole there) is inside; an end is on the boundary */
      for (size_t e = 0; e < l.n; e += 2) {
        double t = l.t[e] + 0.37109375 * (l.t[e + 1] - l.t[e]), at[3], end[3];
        int exact = 1;
        for (int j = 0; j < 3; j++) {
          at[j] = ray.o[j] + t * ray.d[j];
          end[j] = ray.o[j] + l.t[e] * ray.d[j];
        }
        quoin_side side;
        if (l.t[e + 1] - l.t[e] > 1e-6) {
          assert_int_equal(quoin_point_side(a.scene, a.work, at, &side), QUOIN_OK);
          assert_int_equal(side, QUOIN_INSIDE);
          inside_points++;
        }
        exact = planar && ldexp(l.t[e], 20) == nearbyint(ldexp(l.t[e], 20)); /* planar on the grid: a dyadic t is the place itself */
        if (exact) {
          assert_int_equal(quoin_point_side(a.scene, a.work, end, &side), QUOIN_OK);
          assert_int_equal(side, QUOIN_BOUNDARY);
          ends++;
        }
      }
    }
    ask_close(&a);
    ask_close(&b);
  }
  print_message("points within stretches %zu, ends of planar solids %zu\n", inside_points, ends);
  assert_true(inside_points > 300 && ends > 100);
}

/* A point against points at distance 2^-40 about it: what they say must be among what is next to it. */
static void samples_around(void **state) {
  (void)state;
  dice d = {0xbf58476d1ce4e5b9u};
  size_t census[3] = {0}, mixed = 0, open = 0;
  for (int i = 0; i < 6 * SOLIDS; i++) {
    char p[TEXT];
    random_solid(&d, 0, 2 + roll(&d, 4), p, sizeof p);
    ask a;
    ask_open(&a, p);
    for (int k = 0; k < 12; k++) {
      const double at[3] = {roll(&d, 4) - 1, roll(&d, 4) - 1, roll(&d, 4) - 1};
      quoin_side side, next;
      assert_int_equal(quoin_point_side(a.scene, a.work, at, &side), QUOIN_OK);
      unsigned seen = 0;
      for (int s = 0; s < 40; s++) {
        double near[3];
        for (int j = 0; j < 3; j++) {
          int small = roll(&d, 3) ? roll(&d, 2001) - 1000 : roll(&d, 3) - 1;
          near[j] = at[j] + ldexp(small, -45);
        }
        assert_int_equal(quoin_point_side(a.scene, a.work, near, &next), QUOIN_OK);
        seen |= next == QUOIN_INSIDE ? 2u : next == QUOIN_OUTSIDE ? 1u : 0;
      }
      int wrong = (seen == 3 && side != QUOIN_BOUNDARY) || (side == QUOIN_INSIDE && (seen & 1)) || (side == QUOIN_OUTSIDE && (seen & 2));
      if (wrong) {
        print_error("%s\nat %g %g %g: %d, samples %u\n", p, at[0], at[1], at[2], side, seen);
      }
      assert_false(wrong);
      census[side]++;
      mixed += seen == 3;
      open += side == QUOIN_BOUNDARY && seen != 3;
    }
    ask_close(&a);
  }
  print_message("outside %zu, boundary %zu, inside %zu; both seen %zu, boundary of one kind %zu\n", census[0], census[1], census[2], mixed, open);
  assert_true(census[0] > 200 && census[1] > 200 && census[2] > 100 && mixed > 200);
  assert_true(open * 20 < census[1]); /* thin cells that the samples missed */
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(de_morgan), cmocka_unit_test(order_of_operands), cmocka_unit_test(nothing), cmocka_unit_test(complement),
    cmocka_unit_test(lines), cmocka_unit_test(samples_around),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
