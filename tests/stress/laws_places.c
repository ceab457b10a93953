/* Laws of places: a model and a ray moved, turned or scaled alike give the same parameters; an interval's ends are where its solid's
   boundary is, its middle is inside. */
#include "laws.h"

#include <gmp.h>

/* The exact decimal of v into a text of its own; freed by the caller. */
static char *decimal_of(const mpq_t v) {
  mpz_t n, d;
  mpz_inits(n, d, NULL);
  mpz_set(n, mpq_numref(v));
  mpz_set(d, mpq_denref(v));
  unsigned long places = 0;
  mp_bitcnt_t twos = mpz_scan1(d, 0);
  mpz_tdiv_q_2exp(d, d, twos);
  mpz_t five;
  mpz_init_set_ui(five, 5);
  unsigned long fives = mpz_remove(d, d, five);
  if (mpz_cmp_ui(d, 1) != 0) {
    fputs("not a decimal\n", stderr);
    exit(2);
  }
  places = twos > fives ? twos : fives;
  for (unsigned long i = twos; i < places; i++) {
    mpz_mul_2exp(n, n, 1);
  }
  for (unsigned long i = fives; i < places; i++) {
    mpz_mul_ui(n, n, 5);
  }
  char *digits = mpz_get_str(NULL, 10, n), *out = malloc(strlen(digits) + 40);
  if (!out) {
    exit(2);
  }
  sprintf(out, "%se-%lu", digits, places);
  free(digits);
  mpz_clears(n, d, five, NULL);
  return out;
}
static void read_decimal(mpq_t out, const char *s) { /* digits with a point and an exponent */
  mpz_t n, ten;
  mpz_init(n);
  mpz_init_set_ui(ten, 10);
  char digits[200];
  size_t k = 0;
  long places = 0;
  int point = 0;
  for (; *s && *s != 'e' && k < sizeof digits - 1; s++) {
    if (*s == '.') {
      point = 1;
    } else {
      digits[k++] = *s;
      places += point;
    }
  }
  digits[k] = 0;
  places -= *s == 'e' ? atol(s + 1) : 0;
  mpz_set_str(n, digits, 10);
  mpq_set_z(out, n);
  mpz_ui_pow_ui(ten, 10, (unsigned long)labs(places));
  mpq_t p;
  mpq_init(p);
  mpq_set_z(p, ten);
  places > 0 ? mpq_div(out, out, p) : mpq_mul(out, out, p);
  mpq_clear(p);
  mpz_clears(n, ten, NULL);
}
static char *number(double v, const char *times, const char *add) {
  mpq_t q, p;
  mpq_inits(q, p, NULL);
  mpq_set_d(q, v);
  read_decimal(p, times);
  mpq_mul(q, q, p);
  if (add) {
    read_decimal(p, add);
    mpq_add(q, q, p);
  }
  char *out = decimal_of(q);
  mpq_clears(q, p, NULL);
  return out;
}

void ask_decimals(const scene *s, const quoin_ray *ray, const char *times, const char *const add[3], said *out) {
  char *t[8] = {0};
  for (int i = 0; i < 3; i++) {
    t[i] = number(ray->o[i], times, add ? add[i] : NULL);
    t[3 + i] = number(ray->d[i], times, NULL);
  }
  t[6] = isfinite(ray->from) ? number(ray->from, "1", NULL) : NULL;
  t[7] = isfinite(ray->to) ? number(ray->to, "1", NULL) : NULL;
  quoin_intervals got;
  quoin_status status = quoin_ray_intervals_text(s->scene, s->work, (const char *const *)t, t[6], t[7], QUOIN_WANT_BOUNDARY, &got);
  keep(out, status, &got);
  for (int i = 0; i < 8; i++) {
    free(t[i]);
  }
}

/* The model in a wrapper against itself, the ray mapped by `map`. */
static void wrapped(trial *t, const char *wrap, void (*map)(quoin_ray *r, const int *with), const int *with, const char *what) {
  clear_text(&t->first);
  clear_text(&t->second);
  tree_put(&t->first, t->tree, NULL);
  put(&t->second, "%s {\n%s}\n", wrap, t->first.at);
  scene a, b;
  if (!scene_open(t, t->first.at, 1, &a)) {
    return;
  }
  if (scene_open(t, t->second.at, 1, &b)) {
    for (size_t i = 0; i < t->n && !t->wrong; i++) {
      quoin_ray r = t->rays[i];
      map(&r, with);
      said x, y;
      ask_one(&a, &t->rays[i], &x);
      ask_one(&b, &r, &y);
      alike(t, &x, &y, SAME_T, what, &t->rays[i]);
      quoin_side p, q;
      if (quoin_point_side(a.scene, a.work, t->rays[i].o, &p) != QUOIN_OK || quoin_point_side(b.scene, b.work, r.o, &q) != QUOIN_OK || p != q) {
        blame(t, "%s: the side of %.17g %.17g %.17g", what, t->rays[i].o[0], t->rays[i].o[1], t->rays[i].o[2]);
      }
    }
    t->asked += 2 * t->n;
    scene_close(&b);
  }
  scene_close(&a);
}
static void by_shift(quoin_ray *r, const int *v) {
  for (int i = 0; i < 3; i++) {
    r->o[i] += v[i];
  }
}
static void by_power(quoin_ray *r, const int *e) {
  for (int i = 0; i < 3; i++) {
    r->o[i] = ldexp(r->o[i], *e), r->d[i] = ldexp(r->d[i], *e);
  }
}
static void by_quarters(quoin_ray *r, const int *n) {
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < n[i]; k++) {
      int a = (i + 1) % 3, b = (i + 2) % 3;
      double o = r->o[a], d = r->d[a];
      r->o[a] = -r->o[b], r->o[b] = o;
      r->d[a] = -r->d[b], r->d[b] = d;
    }
  }
}
static void by_mirror(quoin_ray *r, const int *axis) {
  r->o[*axis] = -r->o[*axis];
  r->d[*axis] = -r->d[*axis];
}
static void by_nothing(quoin_ray *r, const int *with) {
  (void)r;
  (void)with;
}

static void translation(trial *t) {
  dice d = {t->seed};
  char wrap[100];
  int v[3];
  for (int i = 0; i < 3; i++) {
    v[i] = chance(&d, 50) ? from_to(&d, -9, 9) : from_to(&d, -9, 9) * 1000;
  }
  for (size_t i = 0; i < t->n; i++) { /* only where the sum is a double: else the ray is another */
    for (int k = 0; k < 3; k++) {
      if ((t->rays[i].o[k] + v[k]) - v[k] != t->rays[i].o[k] || (t->rays[i].o[k] + v[k]) - t->rays[i].o[k] != v[k]) {
        return;
      }
    }
  }
  snprintf(wrap, sizeof wrap, "translate([%d,%d,%d])", v[0], v[1], v[2]);
  wrapped(t, wrap, by_shift, v, "translation");
}
static void powers_of_two(trial *t) {
  dice d = {t->seed};
  char wrap[100];
  int e = from_to(&d, -40, 40);
  snprintf(wrap, sizeof wrap, "scale(2^(%d))", e);
  wrapped(t, wrap, by_power, &e, "scaled by a power of two");
}
static void quarter_turns(trial *t) {
  dice d = {t->seed};
  char wrap[100];
  int n[3] = {roll(&d, 4), roll(&d, 4), roll(&d, 4)};
  snprintf(wrap, sizeof wrap, "rotate([%d,%d,%d])", 90 * n[0], 90 * n[1], 90 * n[2]);
  wrapped(t, wrap, by_quarters, n, "quarter turns");
}
static void mirrored(trial *t) {
  int axis = (int)(t->seed % 3);
  static const char *const wraps[] = {"mirror([1,0,0])", "scale([1,-1,1])", "mirror([0,0,3])"};
  wrapped(t, wraps[axis], by_mirror, &axis, "mirrored");
}
/* Turns that come back to where they began, through 256 bits or exactly. */
static void full_turns(trial *t) {
  static const char *const wraps[] = {"rotate([0,0,30]) rotate([0,0,-30])", "rotate(120,[1,1,1]) rotate(240,[1,1,1])", "rotate([20,0,0]) rotate([25,0,0]) rotate([-45,0,0])",
                                      "rotate(360)", "scale(sqrt(3)) scale(1/sqrt(3))", "scale(0.1) scale(10)", "rotate(17,[1,2,3]) rotate(-17,[1,2,3])", "mirror([1,2,3]) mirror([1,2,3])",
                                      "multmatrix([[0.6,-0.8,0,0],[0.8,0.6,0,0],[0,0,1,0]]) multmatrix([[0.6,0.8,0,0],[-0.8,0.6,0,0],[0,0,1,0]])"};
  wrapped(t, wraps[t->seed % 9], by_nothing, NULL, "a full turn");
}
/* Decimals that no double holds. */
static void decimals(trial *t) {
  dice d = {t->seed};
  char wrap[200], add[3][40];
  const char *to[3] = {add[0], add[1], add[2]};
  char times[40] = "1";
  if (chance(&d, 70)) {
    snprintf(times, sizeof times, "%d.%de%d", chance(&d, 50) ? 1 : from_to(&d, 1, 9), chance(&d, 50) ? 0 : from_to(&d, 0, 9999), from_to(&d, -12, 9));
  }
  for (int i = 0; i < 3; i++) {
    snprintf(add[i], sizeof *add, "%d.%d", from_to(&d, -300, 300), from_to(&d, 0, 99999));
  }
  snprintf(wrap, sizeof wrap, "translate([%s,%s,%s]) scale(%s)", add[0], add[1], add[2], times);
  clear_text(&t->first);
  clear_text(&t->second);
  tree_put(&t->first, t->tree, NULL);
  put(&t->second, "%s {\n%s}\n", wrap, t->first.at);
  scene a, b;
  if (!scene_open(t, t->first.at, 1, &a)) {
    return;
  }
  if (scene_open(t, t->second.at, 1, &b)) {
    for (size_t i = 0; i < t->n && !t->wrong; i++) {
      said x, y;
      ask_one(&a, &t->rays[i], &x);
      ask_decimals(&b, &t->rays[i], times, to, &y);
      alike(t, &x, &y, SAME_T, "moved and scaled by decimals", &t->rays[i]);
    }
    t->asked += 2 * t->n;
    scene_close(&b);
  }
  scene_close(&a);
}

static quoin_status side_on(const scene *s, const quoin_ray *r, const mpq_t at, quoin_side *side) {
  mpq_t p, q;
  mpq_inits(p, q, NULL);
  char *c[3];
  for (int i = 0; i < 3; i++) {
    mpq_set_d(p, r->d[i]);
    mpq_mul(p, p, at);
    mpq_set_d(q, r->o[i]);
    mpq_add(p, p, q);
    c[i] = decimal_of(p);
  }
  quoin_status status = quoin_point_side_text(s->scene, s->work, (const char *const *)c, side);
  for (int i = 0; i < 3; i++) {
    free(c[i]);
  }
  mpq_clears(p, q, NULL);
  return status;
}
/* The true place of an end lies within half a spacing of the parameter reported. A spacing further out the ray is not inside, a
   spacing further in it is; and halfway through the stretch it is. */
static void ends(trial *t) {
  scene s;
  clear_text(&t->first);
  tree_put(&t->first, t->tree, NULL);
  if (!scene_open(t, t->first.at, 1, &s)) {
    return;
  }
  mpq_t at, other;
  mpq_inits(at, other, NULL);
  for (size_t i = 0; i < t->n && i < 16 && !t->wrong; i++) {
    const quoin_ray *r = &t->rays[i];
    said x;
    ask_one(&s, r, &x);
    t->asked++;
    for (size_t e = 0; e < 2 * x.n && e < 24 && !t->wrong; e++) {
      const quoin_end *end = &x.end[e];
      double inward = e & 1 ? -infinity() : infinity(), far = x.end[e ^ 1].t;
      double within = nextafter(end->t, inward), out = nextafter(end->t, -inward);
      /* the neighbour stretch, inside or in the boundary, must be further than that */
      double last = e & 1 ? (e + 1 < 2 * x.n ? x.end[e + 1].t : infinity()) : e > 0 ? x.end[e - 1].t : -infinity();
      quoin_side side;
      if (!isfinite(end->t)) {
        continue;
      }
      t->checks++;
      if (e & 1 ? within > nextafter(far, infinity()) : within < nextafter(far, -infinity())) {
        mpq_set_d(at, within);
        if (side_on(&s, r, at, &side) != QUOIN_OK || side == QUOIN_OUTSIDE) {
          blame(t, "just inside the end %.17g: side %d, ray %zu", end->t, (int)side, i);
        }
      }
      if (end->part != QUOIN_NO_PART && (e & 1 ? out < last : out > last)) {
        mpq_set_d(at, out);
        if (side_on(&s, r, at, &side) != QUOIN_OK || side == QUOIN_INSIDE) {
          blame(t, "just outside the end %.17g: side %d, ray %zu", end->t, (int)side, i);
        }
      }
      if (!(e & 1) && isfinite(far)) {
        mpq_set_d(at, end->t);
        mpq_set_d(other, far);
        mpq_add(at, at, other);
        mpq_div_2exp(at, at, 1);
        /* halfway; a touch from outside may be exactly there, so a boundary is looked at again a little beside */
        if (far > end->t && nextafter(end->t, far) < far) {
          if (side_on(&s, r, at, &side) != QUOIN_OK || side == QUOIN_OUTSIDE) {
            blame(t, "halfway from %.17g to %.17g: side %d, ray %zu", end->t, far, (int)side, i);
          } else if (side == QUOIN_BOUNDARY) {
            mpq_set_d(other, 0.3642578125 * end->t + (1 - 0.3642578125) * far);
            if (side_on(&s, r, other, &side) != QUOIN_OK || side != QUOIN_INSIDE) {
              blame(t, "between %.17g and %.17g: side %d, ray %zu", end->t, far, (int)side, i);
            }
          }
        }
      }
      if (end->part != QUOIN_NO_PART && end->t == nearbyint(end->t * 16) / 16) { /* on the lattice the parameter may be exact: then it is on the boundary */
        quoin_side before, after;
        mpq_set_d(at, end->t);
        mpq_set_d(other, ldexp(1, -400));
        if (side_on(&s, r, at, &side) != QUOIN_OK) {
          blame(t, "a place is refused");
        }
        mpq_sub(at, at, other);
        quoin_status s1 = side_on(&s, r, at, &before);
        mpq_add(at, at, other);
        mpq_add(at, at, other);
        quoin_status s2 = side_on(&s, r, at, &after);
        if (s1 != QUOIN_OK || s2 != QUOIN_OK || (before != after && before != QUOIN_BOUNDARY && after != QUOIN_BOUNDARY && side != QUOIN_BOUNDARY && fabs(end->t) < 1024 && fabs(end->t) > 0)) {
          mpq_set_d(at, end->t); /* the sides change within 2^-400 of it: it is the place, since these numbers have no root that near to a short one */
          blame(t, "the end %.17g is not on the boundary: side %d, ray %zu", end->t, (int)side, i);
        }
      }
    }
  }
  mpq_clears(at, other, NULL);
  scene_close(&s);
}

const law PLACE_LAWS[] = {{"translation", translation, 0}, {"powers of two", powers_of_two, 0}, {"quarter turns", quarter_turns, 0}, {"mirrored", mirrored, 0},
                          {"full turns", full_turns, 0}, {"decimals", decimals, 0}, {"ends", ends, 0}};
const size_t PLACE_COUNT = sizeof PLACE_LAWS / sizeof *PLACE_LAWS;
