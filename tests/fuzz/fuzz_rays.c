/* Rays on any model. Laws, byte for byte: as doubles (packets and single-ray code) and as decimals (woven) alike; reversed; many at once; the first hit, in
   short, blocked. Between an interval's ends no point is outside, between two intervals none is inside. */
#include "fuzz.h"

#include <gmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RAYS = 12, ENDS = 64 };

typedef struct said {
  size_t n, boundary;
  quoin_end end[ENDS], side[ENDS];
} said;

static void keep(said *to, const quoin_intervals *got) {
  to->n = got->count;
  to->boundary = got->boundary_count;
  for (size_t i = 0; i < ENDS / 2; i++) {
    if (i < got->count) {
      to->end[2 * i] = got->inside[i].enter;
      to->end[2 * i + 1] = got->inside[i].leave;
    }
    if (i < got->boundary_count) {
      to->side[2 * i] = got->boundary[i].enter;
      to->side[2 * i + 1] = got->boundary[i].leave;
    }
  }
}

static int keep_each(void *user, size_t i, const quoin_intervals *got) {
  keep(&((said *)user)[i], got);
  return 0;
}

static void say_ray(const quoin_ray *r, char text[400]) {
  snprintf(text, 400, "ray %.17g %.17g %.17g  %.17g %.17g %.17g  from %.17g to %.17g", r->o[0], r->o[1], r->o[2], r->d[0], r->d[1], r->d[2], r->from, r->to);
}

enum { ONLY_T = 0, PARTS = 1 };
static void same_ends(const quoin_end *a, const quoin_end *b, size_t n, int parts, const char *what, const quoin_ray *ray) {
  for (size_t i = 0; i < n && i < ENDS; i++) {
    if (memcmp(&a[i].t, &b[i].t, sizeof a->t) != 0 || (parts && (a[i].part != b[i].part || a[i].role != b[i].role))) {
      char text[400];
      say_ray(ray, text);
      fuzz_wrong("%s: end %zu is %.17g of part %u role %u, %.17g of part %u role %u: %s", what, i, a[i].t, a[i].part, a[i].role, b[i].t, b[i].part, b[i].role, text);
    }
  }
}

static void same(const said *a, const said *b, int parts, int boundary, const char *what, const quoin_ray *ray) {
  if (a->n != b->n || (boundary && a->boundary != b->boundary)) {
    char text[400];
    say_ray(ray, text);
    fuzz_wrong("%s: %zu intervals and %zu in the boundary, %zu and %zu: %s", what, a->n, a->boundary, b->n, b->boundary, text);
  }
  same_ends(a->end, b->end, 2 * a->n, parts, what, ray);
  if (boundary) {
    same_ends(a->side, b->side, 2 * a->boundary, parts, what, ray);
  }
}

static int as_decimals(const fuzz_scene *s, const quoin_ray *r, said *out) {
  char text[8][FUZZ_DECIMAL];
  const char *at[6];
  for (int i = 0; i < 3; i++) {
    fuzz_decimal(r->o[i], text[i]);
    fuzz_decimal(r->d[i], text[3 + i]);
  }
  for (int i = 0; i < 6; i++) {
    at[i] = text[i];
  }
  fuzz_decimal(r->from, text[6]);
  fuzz_decimal(r->to, text[7]);
  quoin_intervals got;
  quoin_status status =
    quoin_ray_intervals_text(s->scene, s->work, at, isfinite(r->from) ? text[6] : NULL, isfinite(r->to) ? text[7] : NULL, QUOIN_WANT_BOUNDARY, &got);
  if (!fuzz_answered(status, "a ray as decimals")) {
    return 0;
  }
  keep(out, &got);
  return 1;
}

/* ends backwards, as the ray the other way has them */
static void turn_round(said *s) {
  for (int list = 0; list < 2; list++) {
    quoin_end *e = list ? s->side : s->end;
    size_t n = 2 * (list ? s->boundary : s->n);
    for (size_t i = 0; i < n / 2; i++) {
      quoin_end k = e[i];
      e[i] = e[n - 1 - i];
      e[n - 1 - i] = k;
    }
    for (size_t i = 0; i < n; i++) {
      e[i].t = 0.0 - e[i].t;
    }
  }
}

/* The side of o + ((a + b)/2 + beside 2^-190 (b - a)) d, exactly. */
static quoin_side side_beside(const fuzz_scene *s, const quoin_ray *r, double a, double b, int beside, int *known) {
  mpf_t t, d, x;
  mpf_init2(t, 4300); /* holds every sum and product of doubles */
  mpf_init2(d, 4300);
  mpf_init2(x, 8600);
  char text[3][1100];
  const char *at[3];
  mpf_set_d(t, a);
  mpf_set_d(d, b);
  mpf_add(t, t, d);
  mpf_div_2exp(t, t, 1);
  if (beside) {
    mpf_set_d(x, a);
    mpf_sub(d, d, x);
    mpf_div_2exp(d, d, 190);
    (beside > 0 ? mpf_add : mpf_sub)(t, t, d);
  }
  for (int i = 0; i < 3; i++) {
    mpf_set_d(d, r->d[i]);
    mpf_mul(x, t, d);
    mpf_set_d(d, r->o[i]);
    mpf_add(x, x, d);
    gmp_snprintf(text[i], sizeof text[i], "%.1000Fe", x);
    at[i] = text[i];
  }
  mpf_clears(t, d, x, NULL);
  quoin_side side = QUOIN_OUTSIDE;
  *known = fuzz_answered(quoin_point_side_text(s->scene, s->work, at, &side), "a point on a ray");
  return side;
}

/* In the middle between two places; where a point is not on the side that it should be on, on either side of it: of irrational numbers what agrees to 2^-200 is equal (S2), so that a gap
   narrower than that is none along a ray, and may be one for a point in it. */
static quoin_side side_between(const fuzz_scene *s, const quoin_ray *r, double a, double b, quoin_side should, int *known) {
  const quoin_side side = side_beside(s, r, a, b, 0, known);
  int left_known, right_known;
  if (!*known || side == should || side == QUOIN_BOUNDARY) {
    return side;
  }
  const quoin_side left = side_beside(s, r, a, b, -1, &left_known), right = side_beside(s, r, a, b, 1, &right_known);
  *known = left_known && right_known;
  return left == should && right == should ? should : side;
}

static int far_apart(double a, double b) { /* a double or two between them, so that the middle is between the exact places as well */
  return isfinite(a) && isfinite(b) && nextafter(a, b) < b && fabs(a) < 0x1p300 && fabs(b) < 0x1p300 && (a == 0 || fabs(a) > 0x1p-300) && (b == 0 || fabs(b) > 0x1p-300);
}

static int moderate(const quoin_ray *r) { /* decimals of 1000 digits hold the points */
  for (int i = 0; i < 3; i++) {
    if ((r->o[i] != 0 && (fabs(r->o[i]) < 0x1p-300 || fabs(r->o[i]) > 0x1p300)) || (r->d[i] != 0 && (fabs(r->d[i]) < 0x1p-300 || fabs(r->d[i]) > 0x1p300))) {
      return 0;
    }
  }
  return 1;
}

static void middles(const fuzz_scene *s, const quoin_ray *r, const said *x) {
  char text[400];
  int known;
  for (size_t i = 0; moderate(r) && i < x->n && i < 6 && !fuzz_late(); i++) {
    const quoin_end *e = x->end + 2 * i;
    if (far_apart(e[0].t, e[1].t) && side_between(s, r, e[0].t, e[1].t, QUOIN_INSIDE, &known) == QUOIN_OUTSIDE && known) {
      say_ray(r, text);
      fuzz_wrong("a point halfway from %.17g to %.17g is outside: %s", e[0].t, e[1].t, text);
    }
    if (i + 1 < x->n && x->boundary == 0 && far_apart(e[1].t, e[2].t) && side_between(s, r, e[1].t, e[2].t, QUOIN_OUTSIDE, &known) == QUOIN_INSIDE && known) {
      say_ray(r, text);
      fuzz_wrong("a point between stretches, halfway from %.17g to %.17g, is inside: %s", e[1].t, e[2].t, text);
    }
  }
}

/* The first boundary as the intervals have it. */
static void first_of(const said *s, quoin_hit *h) {
  *h = (quoin_hit){0};
  if (s->n) {
    int leaving = s->end[0].part == QUOIN_NO_PART;
    const quoin_end *e = &s->end[leaving];
    if (e->part != QUOIN_NO_PART) {
      *h = (quoin_hit){.found = 1, .leaving = leaving, .t = e->t, .part = e->part, .role = e->role};
    }
  }
}

static void first_hits(const fuzz_scene *s, size_t n, const quoin_ray *rays, const said *want) {
  quoin_hit hits[RAYS];
  quoin_spot spots[RAYS];
  uint8_t blocked[RAYS];
  if (!fuzz_answered(quoin_first_hits(s->scene, s->work, n, rays, hits), "first hits") ||
      !fuzz_answered(quoin_first_spots(s->scene, s->work, n, rays, QUOIN_WANT_T, spots), "first spots") ||
      !fuzz_answered(quoin_rays_blocked(s->scene, s->work, n, rays, NULL, blocked), "blocked rays")) {
    return;
  }
  for (size_t i = 0; i < n; i++) {
    quoin_hit h;
    char text[400];
    say_ray(&rays[i], text);
    first_of(&want[i], &h);
    if (h.found != hits[i].found || (h.found && (h.leaving != hits[i].leaving || memcmp(&h.t, &hits[i].t, sizeof h.t) != 0 || h.part != hits[i].part || h.role != hits[i].role))) {
      fuzz_wrong("first hit: found %d leaving %d t %.17g part %u role %u, intervals say %d, %d, %.17g, %u, %u: %s", hits[i].found, hits[i].leaving, hits[i].t, hits[i].part,
                 hits[i].role, h.found, h.leaving, h.t, h.part, h.role, text);
    }
    if ((spots[i].surface != QUOIN_NO_SURFACE) != h.found || (h.found && ((int)spots[i].leaving != h.leaving || memcmp(&spots[i].t, &h.t, sizeof h.t) != 0))) {
      fuzz_wrong("first spot: surface %u t %.17g, intervals say found %d t %.17g: %s", spots[i].surface, spots[i].t, h.found, h.t, text);
    }
    if ((blocked[i] != 0) != (want[i].n != 0)) {
      fuzz_wrong("blocked %d, but %zu intervals: %s", blocked[i], want[i].n, text);
    }
  }
}

static void look(const fuzz_scene *s, fuzz_bytes *tail) {
  quoin_ray rays[RAYS];
  said alone[RAYS], other[RAYS], batch[RAYS];
  size_t n = 0, answered = 0;
  do { /* one ray at least */
    quoin_ray r = {.from = -(double)INFINITY, .to = (double)INFINITY};
    for (int i = 0; i < 3; i++) {
      r.o[i] = fuzz_number(tail);
    }
    for (int i = 0; i < 3; i++) {
      r.d[i] = fuzz_number(tail);
    }
    if (n % 3 == 2) {
      r.from = fuzz_number(tail);
      r.to = r.from + fabs(fuzz_number(tail));
    }
    if (r.d[0] == 0 && r.d[1] == 0 && r.d[2] == 0) {
      r.d[n % 3] = 1;
    }
    rays[n++] = r;
  } while (n < RAYS && fuzz_more(tail));
  for (; answered < n && !fuzz_late(); answered++) {
    const quoin_ray *r = &rays[answered];
    quoin_intervals got;
    if (!fuzz_answered(quoin_ray_intervals(s->scene, s->work, r, QUOIN_WANT_BOUNDARY, &got), "a ray")) {
      return;
    }
    keep(&alone[answered], &got);
    if (alone[answered].n > ENDS / 2 || alone[answered].boundary > ENDS / 2) {
      return;
    }
    if (!as_decimals(s, r, &other[answered])) {
      return;
    }
    same(&alone[answered], &other[answered], PARTS, 1, "as doubles and as decimals", r);
    if (!s->super) {
      quoin_ray back = *r;
      for (int i = 0; i < 3; i++) {
        back.d[i] = -back.d[i];
      }
      back.from = -r->to;
      back.to = -r->from;
      if (!fuzz_answered(quoin_ray_intervals(s->scene, s->work, &back, QUOIN_WANT_BOUNDARY, &got), "a ray reversed")) {
        return;
      }
      if (got.count > ENDS / 2 || got.boundary_count > ENDS / 2) {
        fuzz_wrong("reversed: %zu intervals, not %zu", got.count, alone[answered].n);
      }
      keep(&other[answered], &got);
      turn_round(&other[answered]);
      said forth = alone[answered];
      for (size_t i = 0; i < ENDS; i++) { /* no -0 */
        forth.end[i].t += 0.0;
        forth.side[i].t += 0.0;
      }
      same(&forth, &other[answered], ONLY_T, 1, "reversed", r);
      middles(s, r, &alone[answered]);
    }
  }
  n = answered;
  if (n == 0 || fuzz_late()) {
    return;
  }
  if (fuzz_answered(quoin_ray_intervals_many(s->scene, s->work, n, rays, 0, keep_each, batch), "many rays")) {
    for (size_t i = 0; i < n; i++) {
      same(&alone[i], &batch[i], PARTS, 0, "alone and among many", &rays[i]);
    }
  }
  first_hits(s, n, rays, alone);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_begin(data, size);
  fuzz_bytes tail;
  size_t length = fuzz_split(data, size, &tail);
  fuzz_scene s;
  if (fuzz_read(data, length, &s) && fuzz_compile(&s, NULL) && !fuzz_late()) {
    look(&s, &tail);
  }
  fuzz_close(&s);
  fuzz_end();
  return 0;
}
