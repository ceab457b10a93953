/* Light: the transfer function of sRGB, powers, Phong's terms at angles with known cosines, and the bound of a shadow ray's start, in
   rationals. What is wide is asked of every body that this machine runs. */
#include "base/bounds.h"
#include "image/colour.h"
#include "image/power.h"
#include "image/shade.h"
#include "image/vec.h"

#include <gmp.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static void srgb_known_points(void **state) {
  (void)state;
  assert_true(qn_srgb_to_linear(0) == 0 && qn_srgb_to_linear(1) == 1);
  assert_true(qn_srgb_from_linear(0) == 0 && fabs(qn_srgb_from_linear(1) - 1) <= 0x1p-52);
  assert_true(qn_srgb_to_linear(0.04) == 0.04 / 12.92); /* the straight part */
  assert_true(qn_srgb_to_linear(-3) == 0 && qn_srgb_to_linear(7) == 1 && qn_srgb_to_linear(NAN) == 0);
  /* sRGB 188 is the byte nearest to half the light: 0.5 lies between bytes 187 and 189 */
  assert_true(qn_srgb_to_linear(187 / 255.0) < 0.5 && qn_srgb_to_linear(189 / 255.0) > 0.5);
}

/* Every level comes back to itself, and the byte is the one whose level is nearest. */
static void tone_rounds_to_nearest(void **state) {
  (void)state;
  qn_tone tone;
  qn_tone_make(&tone);
  for (int k = 0; k < 256; k++) {
    assert_int_equal(qn_tone_byte(&tone, qn_srgb_to_linear(k / 255.0)), k);
    assert_int_equal(qn_tone_byte(&tone, qn_srgb_to_linear((k + 0.49) / 255.0)), k);
    assert_int_equal(qn_tone_byte(&tone, qn_srgb_to_linear((k - 0.49) / 255.0)), k);
  }
  /* All the way, a hundred places in each part of the table: the number of steps at or below. */
  for (int i = 0; i <= 100 * QN_TONE_PARTS; i++) {
    const double x = i / (100.0 * QN_TONE_PARTS);
    const unsigned level = qn_tone_byte(&tone, x);
    assert_true((level == 0 || x >= tone.step[level - 1]) && (level == 255 || x < tone.step[level]));
  }
}

static uint64_t next_random(uint64_t *s) { /* splitmix64 */
  uint64_t z = (*s += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}
static double random_part(uint64_t *s) { /* in (0, 1) */
  return ((double)(next_random(s) >> 12) + 0.5) * 0x1p-52;
}

/* The error that power.h states, against long doubles. */
static void powers(void **state) {
  (void)state;
  uint64_t seed = 5;
  long double worst = 0;
  for (int k = 0; k < 200000; k++) {
    const double u = random_part(&seed), x = k % 3 == 0 ? u * 2 : k % 3 == 1 ? 1 - u * 0x1p-10 : ldexp(u, -(int)(next_random(&seed) % 300));
    const double m = k % 2 ? 100 * random_part(&seed) : k % 4 ? 2.4 : 1 / 2.4;
    const long double want = powl(x, m), size = 1 + fabsl(m * log2l(x));
    if (want > 0x1p-1000L) {
      worst = fmaxl(worst, fabsl((long double)qn_power(x, m) / want - 1) / size);
    }
  }
  assert_true(worst < 0x1p-49L && worst > 0x1p-54L);
  assert_true(qn_power(1, 3) == 1 && qn_power(0.25, 0) == 1 && fabs(qn_power(0.5, 2) - 0.25) <= 0x1p-50);
  assert_true(qn_power(1e-5, 1e6) < 1e-300 && qn_power(1e-5, 1e6) >= 0);
}

/* --- the wide bodies ------------------------------------------------------------------------------------------------- */

static const qn_shade *bodies[3];
static size_t body_count;
static void find_bodies(void) {
  static const char *const names[] = {"sse2", "avx2", "avx512"};
  for (size_t i = 0; i < 3; i++) {
    setenv("QUOIN_ISA", names[i], 1);
    if (strcmp(qn_wide_pick()->name, names[i]) == 0) {
      bodies[body_count] = qn_shade_of(names[i]);
      assert_string_equal(bodies[body_count++]->name, names[i]);
    }
  }
  unsetenv("QUOIN_ISA");
}

/* Lane 37 of a packet lit by one lamp; the light of lane 36, which is not asked for, must stay. */
enum { LANE = 37 };
typedef struct spot { double point[3], normal[3], viewer[3]; } spot;
static int light_one(const qn_shade *body, const qn_lamp *lamp, const spot *p, double shininess, double *cosine, double light[3]) {
  static qn_spots s;
  memset(&s, 0, sizeof s);
  for (int i = 0; i < 3; i++) {
    s.point[i][LANE] = p->point[i], s.normal[i][LANE] = p->normal[i], s.viewer[i][LANE] = p->viewer[i];
    s.color[i][LANE] = (const double[]){0.5, 0.25, 1}[i];
    s.light[i][LANE] = light[i];
    s.light[i][LANE - 1] = 0.75;
  }
  s.diffuse[LANE] = 0.5, s.specular[LANE] = 0.25, s.shininess[LANE] = shininess;
  s.shiny = 1;
  const uint64_t lit = body->face(lamp, (uint64_t)1 << LANE, &s);
  assert_true(lit == 0 || lit == (uint64_t)1 << LANE);
  if (lit) {
    body->add(lamp, lit, &s);
    *cosine = s.cosine[LANE];
  }
  for (int i = 0; i < 3; i++) {
    light[i] = s.light[i][LANE];
    assert_true(s.light[i][LANE - 1] == 0.75);
  }
  return lit != 0;
}

/* The lamp straight above, the viewer too: cosine 1, mirror 1. All numbers are dyadic, so the sums are exact. */
static void lamp_at_the_viewer(void **state) {
  (void)state;
  const qn_lamp lamp = {.place = {0, 0, 1}, .color = {1, 1, 0.5}, .directional = 1};
  const spot p = {.normal = {0, 0, 1}, .viewer = {0, 0, 1}};
  for (size_t b = 0; b < body_count; b++) {
    double cosine, light[3] = {0, 0, 0.125};
    assert_true(light_one(bodies[b], &lamp, &p, 2, &cosine, light));
    assert_true(cosine == 1);
    assert_true(light[0] == 0.25 + 0.25 && light[1] == 0.125 + 0.25 && light[2] == 0.125 + 0.5 * (0.5 + 0.25));
  }
}

/* A lamp at (3, 0, 4)/5 and the viewer in the mirror direction (-3, 0, 4)/5: cosine 4/5, mirror 1; with the viewer at the
   lamp: mirror 2 (4/5)^2 - 1 = 7/25; with the viewer low on the lamp's side the mirror image is behind: no highlight. */
static void diffuse_and_highlight_at_known_angles(void **state) {
  (void)state;
  const qn_lamp lamp = {.place = {3, 0, 4}, .color = {1, 1, 1}};
  for (size_t b = 0; b < body_count; b++) {
    spot p = {.normal = {0, 0, 1}, .viewer = {-0.6, 0, 0.8}};
    double cosine, light[3] = {0, 0, 0};
    assert_true(light_one(bodies[b], &lamp, &p, 2, &cosine, light));
    assert_true(fabs(cosine - 0.8) <= 4 * 0x1p-53);
    assert_true(fabs(light[0] - (0.5 * 0.5 * 0.8 + 0.25)) <= 16 * 0x1p-53);
    p.viewer[0] = 0.6;
    memset(light, 0, sizeof light);
    assert_true(light_one(bodies[b], &lamp, &p, 2, &cosine, light));
    assert_true(fabs(light[0] - (0.5 * 0.5 * 0.8 + 0.25 * (7.0 / 25) * (7.0 / 25))) <= 16 * 0x1p-53);
    p = (spot){.normal = {0, 0, 1}, .viewer = {1, 0, 0}};
    memset(light, 0, sizeof light);
    assert_true(light_one(bodies[b], &lamp, &p, 2, &cosine, light));
    assert_true(fabs(light[0] - 0.5 * 0.5 * 0.8) <= 16 * 0x1p-53);
  }
}

static void lamps_that_give_nothing(void **state) {
  (void)state;
  const spot p = {.point = {1, 2, 3}, .normal = {0, 0, 1}, .viewer = {0, 0, 1}};
  const qn_lamp behind = {.place = {1, 2, 2}, .color = {1, 1, 1}};
  const qn_lamp grazing = {.place = {1, 0, 0}, .color = {1, 1, 1}, .directional = 1};
  const qn_lamp here = {.place = {1, 2, 3}, .color = {1, 1, 1}};
  for (size_t b = 0; b < body_count; b++) {
    double cosine, light[3] = {0, 0, 0};
    assert_false(light_one(bodies[b], &behind, &p, 2, &cosine, light));
    assert_false(light_one(bodies[b], &grazing, &p, 2, &cosine, light));
    assert_false(light_one(bodies[b], &here, &p, 2, &cosine, light));
  }
  qn_lamp lamp;
  const qn_light zero = {.directional = 1, .color = {1, 1, 1}};
  assert_false(qn_lamp_from_light(&zero, &lamp));
  const qn_light infinite = {.at = {INFINITY, 0, 0}, .color = {1, 1, 1}};
  assert_false(qn_lamp_from_light(&infinite, &lamp));
}

/* A light that travels downwards is above. */
static void direction_is_the_way_the_light_travels(void **state) {
  (void)state;
  const qn_light sun = {.directional = 1, .direction = {0, 0, -2}, .color = {1, 1, 1}};
  qn_lamp lamp;
  assert_true(qn_lamp_from_light(&sun, &lamp));
  assert_true(lamp.place[0] == 0 && lamp.place[1] == 0 && lamp.place[2] == 1);
}

/* The headlight of the default pair has no highlight; the key is a unit vector on the viewer's side, from the upper left. */
static void default_lamps(void **state) {
  (void)state;
  const quoin_camera c = {.eye = {0, -10, 0}, .look = {0, 0, 0}, .up = {0, 0, 1}, .fov = 90};
  qn_frustum f;
  assert_int_equal(qn_frustum_make(&c, 100, 100, &f), QUOIN_OK);
  qn_lamp lamps[QN_DEFAULT_LAMPS];
  qn_lamps_default(&f, lamps);
  assert_true(lamps[0].place[0] < 0 && lamps[0].place[1] < 0 && lamps[0].place[2] > 0);
  assert_true(fabs(qn_dot3(lamps[0].place, lamps[0].place) - 1) <= 8 * 0x1p-53);
  assert_true(lamps[1].headlight && !lamps[1].directional && lamps[1].place[1] == -10);
  const spot p = {.normal = {0, -1, 0}, .viewer = {0, -1, 0}};
  for (size_t b = 0; b < body_count; b++) {
    double cosine, light[3] = {0, 0, 0};
    assert_true(light_one(bodies[b], &lamps[1], &p, 2, &cosine, light));
    assert_true(light[0] == lamps[1].color[0] * (0.5 * 0.5 * cosine));
  }
}

/* --- QN_SHADE_POINT, in rationals ---------------------------------------------------------------------------------- */

/* A double of random sign and mantissa with an exponent from 2^-range to 2^range. */
static double random_double(uint64_t *s, int range) {
  const double m = 1 + (double)(next_random(s) >> 11) * 0x1p-53;
  const int e = (int)(next_random(s) % (2 * (unsigned)range + 1)) - range;
  return ldexp(next_random(s) & 1 ? -m : m, e);
}

/* A packet of hits and the shadow rays that a body makes of them towards a sun. */
typedef struct hits { qn_packet rays, shadows; qn_spots spots; } hits;

/* The true parameter T is t plus or minus half an ulp of t, at most: the worst rounding. A plane with a random normal
   through the true hit: the start must be strictly outside it; so must the start of a hit that cancels (the point near 0). */
static void shadow_rays_start_outside(void **state) {
  (void)state;
  static hits h;
  uint64_t seed = 20240611;
  mpq_t T, x, y, side;
  mpq_inits(T, x, y, side, NULL);
  double largest = 0;
  size_t cancelled = 0;
  const qn_lamp lamp = {.place = {0, 0, 1}, .directional = 1};
  for (int round = 0; round < 300; round++) {
    memset(&h, 0, sizeof h);
    for (int lane = 0; lane < QN_LANES; lane++) {
      double n[3];
      const double t = fabs(random_double(&seed, 20));
      h.spots.t[lane] = t;
      for (int i = 0; i < 3; i++) {
        const double d = random_double(&seed, 3);
        const double o = lane % 2 ? random_double(&seed, 20) : -t * d * (1 + random_double(&seed, 2) * 0x1p-50);
        n[i] = random_double(&seed, 3);
        h.rays.d[i][lane] = d, h.rays.o[i][lane] = o;
        h.spots.point[i][lane] = o + t * d;
        cancelled += fabs(o + t * d) < fabs(o) * 0x1p-40;
      }
      assert_true(qn_unit3(n));
      for (int i = 0; i < 3; i++) {
        h.spots.normal[i][lane] = n[i];
      }
    }
    const uint64_t asked = ~((uint64_t)next_random(&seed) & (uint64_t)next_random(&seed));
    const uint64_t made = bodies[(size_t)round % body_count]->shadow(&lamp, &h.rays, asked, &h.spots, &h.shadows);
    assert_true(made == asked);
    for (unsigned lane = 0; lane < QN_LANES; lane++) {
      for (int i = 0; i < 3; i++) { /* also of those that are not asked for */
        assert_true(isfinite(h.shadows.o[i][lane]) && h.shadows.d[i][lane] == lamp.place[i]);
      }
      for (int sign = -1; asked >> lane & 1 && sign <= 1; sign += 2) {
        /* T = t + sign ulp/2, taken the full half ulp */
        const double t = h.spots.t[lane];
        mpq_set_d(T, nextafter(t, sign * INFINITY));
        mpq_set_d(x, t);
        mpq_add(T, T, x);
        mpq_div_2exp(T, T, 1);
        mpq_set_ui(side, 0, 1);
        for (int i = 0; i < 3; i++) {
          const double d = h.rays.d[i][lane], point = h.spots.point[i][lane];
          mpq_set_d(x, d);
          mpq_mul(x, x, T);
          mpq_set_d(y, h.rays.o[i][lane]);
          mpq_add(x, x, y); /* p_i */
          mpq_set_d(y, point);
          mpq_sub(y, y, x);
          const double bound = QN_SHADE_POINT * (fabs(t * d) + fabs(point));
          const double share = fabs(mpq_get_d(y)) / bound;
          assert_true(share <= 0.5); /* the derivation: half of the bound is the point's, half the moved point's */
          largest = fmax(largest, share);
          mpq_set_d(y, h.shadows.o[i][lane]);
          mpq_sub(x, y, x);
          mpq_set_d(y, h.spots.normal[i][lane]);
          mpq_mul(x, x, y);
          mpq_add(side, side, x);
        }
        assert_true(mpq_sgn(side) > 0);
      }
    }
  }
  mpq_clears(T, x, y, side, NULL);
  assert_true(largest > 0.25);   /* the bound is not idle */
  assert_true(cancelled > 1000); /* and hits that cancel did occur */
}

/* Towards a lamp that is a place the ray's end at 1 is the lamp; there is none from the lamp itself, and its lane holds a ray all the same. */
static void shadow_rays_end_at_the_lamp(void **state) {
  (void)state;
  static hits h;
  const qn_lamp bulb = {.place = {0, 0, 16}};
  for (size_t b = 0; b < body_count; b++) {
    memset(&h, 0, sizeof h);
    for (int lane = 0; lane < QN_LANES; lane++) {
      h.spots.t[lane] = 4;
      h.rays.o[2][lane] = 8, h.rays.d[2][lane] = -1;
      h.spots.point[2][lane] = 4, h.spots.normal[2][lane] = 1;
    }
    h.spots.t[5] = 0, h.rays.o[2][5] = h.spots.point[2][5] = 16, h.spots.normal[2][5] = 0;
    const uint64_t asked = (uint64_t)1 << 5 | (uint64_t)1 << 60;
    assert_true(bodies[b]->shadow(&bulb, &h.rays, asked, &h.spots, &h.shadows) == (uint64_t)1 << 60);
    assert_true(h.shadows.o[2][60] > 4 && h.shadows.o[2][60] + h.shadows.d[2][60] == 16);
    for (int lane = 0; lane < QN_LANES; lane++) {
      assert_true(h.shadows.d[0][lane] != 0 || h.shadows.d[2][lane] != 0);
    }
  }
}

/* The same bytes from every body, in all lanes that were asked for, over random hits. */
static void bodies_agree(void **state) {
  (void)state;
  static hits h[3];
  uint64_t seed = 99;
  for (int round = 0; round < 200; round++) {
    memset(&h[0], 0, sizeof h[0]);
    qn_spots *s = &h[0].spots;
    qn_lamp lamp = {.directional = round & 1};
    for (int lane = 0; lane < QN_LANES; lane++) {
      double n[3], v[3];
      for (int i = 0; i < 3; i++) {
        s->point[i][lane] = random_double(&seed, 4);
        s->color[i][lane] = random_part(&seed), s->light[i][lane] = random_part(&seed);
        h[0].rays.o[i][lane] = random_double(&seed, 4), h[0].rays.d[i][lane] = random_double(&seed, 4);
        n[i] = random_double(&seed, 2), v[i] = random_double(&seed, 2);
        lamp.place[i] = random_double(&seed, 2), lamp.color[i] = random_part(&seed);
      }
      assert_true(qn_unit3(n) && qn_unit3(v) && (!lamp.directional || qn_unit3(lamp.place)));
      for (int i = 0; i < 3; i++) {
        s->normal[i][lane] = n[i], s->viewer[i][lane] = v[i];
      }
      s->t[lane] = random_part(&seed);
      s->diffuse[lane] = random_part(&seed), s->specular[lane] = random_part(&seed), s->shininess[lane] = random_double(&seed, 5);
      s->shininess[lane] = fabs(s->shininess[lane]);
    }
    s->shiny = 1;
    const uint64_t asked = round % 3 ? ~(uint64_t)0 : next_random(&seed) | 1;
    uint64_t lit[3];
    for (size_t b = 0; b < body_count; b++) {
      if (b) {
        h[b] = h[b - 1];
        h[b].spots = *s;
      }
    }
    const qn_spots before = *s;
    for (size_t b = 0; b < body_count; b++) {
      h[b].spots = before;
      lit[b] = bodies[b]->face(&lamp, asked, &h[b].spots);
      if (lit[b]) {
        bodies[b]->add(&lamp, lit[b], &h[b].spots);
        (void)bodies[b]->shadow(&lamp, &h[b].rays, lit[b], &h[b].spots, &h[b].shadows);
      }
      bodies[b]->clamp(&h[b].spots);
      assert_true(lit[b] == lit[0] && memcmp(h[b].spots.light, h[0].spots.light, sizeof s->light) == 0);
      assert_true(memcmp(h[b].shadows.o, h[0].shadows.o, sizeof h[b].shadows.o) == 0 && memcmp(h[b].shadows.d, h[0].shadows.d, sizeof h[b].shadows.d) == 0);
    }
  }
}

int main(void) {
  find_bodies();
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(srgb_known_points),         cmocka_unit_test(tone_rounds_to_nearest),
    cmocka_unit_test(powers),                    cmocka_unit_test(bodies_agree),
    cmocka_unit_test(lamp_at_the_viewer),
    cmocka_unit_test(diffuse_and_highlight_at_known_angles), cmocka_unit_test(lamps_that_give_nothing),
    cmocka_unit_test(direction_is_the_way_the_light_travels), cmocka_unit_test(default_lamps),
    cmocka_unit_test(shadow_rays_start_outside), cmocka_unit_test(shadow_rays_end_at_the_lamp),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
