/* Light: the transfer function of sRGB, Phong's terms at angles with known cosines, and the bound of a shadow ray's start,
   in rationals. */
#include "base/bounds.h"
#include "image/colour.h"
#include "image/light.h"
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
  assert_int_equal(qn_tone_byte(&tone, -1), 0);
  assert_int_equal(qn_tone_byte(&tone, 2), 255);
}

static const qn_finish finish = {.color = {0.5, 0.25, 1}, .ambient = 0.125, .diffuse = 0.5, .specular = 0.25, .shininess = 2};

static void ambient_term(void **state) {
  (void)state;
  double light[3];
  qn_light_ambient(&finish, light);
  assert_true(light[0] == 0.0625 && light[1] == 0.03125 && light[2] == 0.125);
}

/* The lamp straight above, the viewer too: cosine 1, mirror 1. All numbers are dyadic, so the sums are exact. */
static void lamp_at_the_viewer(void **state) {
  (void)state;
  const qn_lamp lamp = {.place = {0, 0, 1}, .color = {1, 1, 0.5}, .directional = 1};
  const qn_spot spot = {.normal = {0, 0, 1}, .viewer = {0, 0, 1}};
  double towards[3], cosine, light[3] = {0, 0, 0};
  assert_true(qn_light_towards(&lamp, &spot, towards, &cosine));
  assert_true(cosine == 1);
  qn_light_add(&finish, &lamp, &spot, towards, cosine, light);
  assert_true(light[0] == 0.25 + 0.25 && light[1] == 0.125 + 0.25 && light[2] == 0.5 * (0.5 + 0.25));
}

/* A lamp at (3, 0, 4)/5 and the viewer in the mirror direction (-3, 0, 4)/5: cosine 4/5, mirror 1; with the viewer at the
   lamp: mirror 2 (4/5)^2 - 1 = 7/25. */
static void diffuse_and_highlight_at_known_angles(void **state) {
  (void)state;
  const qn_lamp lamp = {.place = {3, 0, 4}, .color = {1, 1, 1}};
  qn_spot spot = {.normal = {0, 0, 1}, .viewer = {-0.6, 0, 0.8}};
  double towards[3], cosine;
  assert_true(qn_light_towards(&lamp, &spot, towards, &cosine));
  assert_true(fabs(cosine - 0.8) <= 4 * 0x1p-53);
  double light[3] = {0, 0, 0};
  qn_light_add(&finish, &lamp, &spot, towards, cosine, light);
  assert_true(fabs(light[0] - (0.5 * 0.5 * 0.8 + 0.25)) <= 16 * 0x1p-53);
  spot.viewer[0] = 0.6;
  memset(light, 0, sizeof light);
  qn_light_add(&finish, &lamp, &spot, towards, cosine, light);
  assert_true(fabs(light[0] - (0.5 * 0.5 * 0.8 + 0.25 * (7.0 / 25) * (7.0 / 25))) <= 16 * 0x1p-53);
}

static void lamps_that_give_nothing(void **state) {
  (void)state;
  const qn_spot spot = {.point = {1, 2, 3}, .normal = {0, 0, 1}, .viewer = {0, 0, 1}};
  double towards[3], cosine;
  const qn_lamp behind = {.place = {1, 2, 2}, .color = {1, 1, 1}};
  assert_false(qn_light_towards(&behind, &spot, towards, &cosine));
  const qn_lamp grazing = {.place = {1, 0, 0}, .color = {1, 1, 1}, .directional = 1};
  assert_false(qn_light_towards(&grazing, &spot, towards, &cosine));
  const qn_lamp here = {.place = {1, 2, 3}, .color = {1, 1, 1}};
  assert_false(qn_light_towards(&here, &spot, towards, &cosine));
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
  const qn_spot spot = {.normal = {0, -1, 0}, .viewer = {0, -1, 0}};
  double towards[3], cosine, light[3] = {0, 0, 0};
  assert_true(qn_light_towards(&lamps[1], &spot, towards, &cosine));
  qn_light_add(&finish, &lamps[1], &spot, towards, cosine, light);
  assert_true(light[0] == lamps[1].color[0] * (0.5 * 0.5 * cosine));
}

/* --- QN_SHADE_POINT, in rationals ---------------------------------------------------------------------------------- */

static uint64_t next_random(uint64_t *s) { /* splitmix64 */
  uint64_t z = (*s += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}
/* A double of random sign and mantissa with an exponent from 2^-range to 2^range. */
static double random_double(uint64_t *s, int range) {
  const double m = 1 + (double)(next_random(s) >> 11) * 0x1p-53;
  const int e = (int)(next_random(s) % (2 * (unsigned)range + 1)) - range;
  return ldexp(next_random(s) & 1 ? -m : m, e);
}

/* The true parameter T is t plus or minus half an ulp of t, at most: the worst rounding. A plane with a random normal
   through the true hit: the start must be strictly outside it; so must the start of a hit that cancels (the point near 0). */
static void shadow_rays_start_outside(void **state) {
  (void)state;
  uint64_t seed = 20240611;
  mpq_t T, x, y, side;
  mpq_inits(T, x, y, side, NULL);
  double largest = 0;
  size_t cancelled = 0;
  for (int round = 0; round < 20000; round++) {
    quoin_ray ray = {.to = INFINITY};
    double n[3], point[3];
    const double t = fabs(random_double(&seed, 20));
    for (int i = 0; i < 3; i++) {
      ray.d[i] = random_double(&seed, 3);
      ray.o[i] = round % 2 ? random_double(&seed, 20) : -t * ray.d[i] * (1 + random_double(&seed, 2) * 0x1p-50);
      n[i] = random_double(&seed, 3);
      point[i] = ray.o[i] + t * ray.d[i];
      cancelled += fabs(point[i]) < fabs(ray.o[i]) * 0x1p-40;
    }
    assert_true(qn_unit3(n));
    const qn_lamp lamp = {.place = {0, 0, 1}, .directional = 1};
    quoin_ray shadow;
    qn_shadow_ray(&ray, t, point, n, &lamp, &shadow);
    for (int sign = -1; sign <= 1; sign += 2) {
      /* T = t + sign ulp/2, taken the full half ulp */
      mpq_set_d(T, nextafter(t, sign * INFINITY));
      mpq_set_d(x, t);
      mpq_add(T, T, x);
      mpq_div_2exp(T, T, 1);
      mpq_set_ui(side, 0, 1);
      for (int i = 0; i < 3; i++) {
        mpq_set_d(x, ray.d[i]);
        mpq_mul(x, x, T);
        mpq_set_d(y, ray.o[i]);
        mpq_add(x, x, y); /* p_i */
        mpq_set_d(y, point[i]);
        mpq_sub(y, y, x);
        const double bound = QN_SHADE_POINT * (fabs(t * ray.d[i]) + fabs(point[i]));
        const double share = fabs(mpq_get_d(y)) / bound;
        assert_true(share <= 0.5); /* the derivation: half of the bound is the point's, half the moved point's */
        largest = fmax(largest, share);
        mpq_set_d(y, shadow.o[i]);
        mpq_sub(x, y, x);
        mpq_set_d(y, n[i]);
        mpq_mul(x, x, y);
        mpq_add(side, side, x);
      }
      assert_true(mpq_sgn(side) > 0);
    }
  }
  mpq_clears(T, x, y, side, NULL);
  assert_true(largest > 0.25);   /* the bound is not idle */
  assert_true(cancelled > 1000); /* and hits that cancel did occur */
}

/* Towards a lamp that is a place the ray ends there; towards a direction it does not end. */
static void shadow_rays_end_at_the_lamp(void **state) {
  (void)state;
  const quoin_ray ray = {.o = {0, 0, 8}, .d = {0, 0, -1}};
  const double point[3] = {0, 0, 4}, normal[3] = {0, 0, 1};
  quoin_ray shadow;
  const qn_lamp bulb = {.place = {0, 0, 16}};
  qn_shadow_ray(&ray, 4, point, normal, &bulb, &shadow);
  assert_true(shadow.from == 0 && shadow.to == 1 && shadow.o[2] > 4 && shadow.o[2] + shadow.d[2] == 16);
  const qn_lamp sun = {.place = {0, 0, 1}, .directional = 1};
  qn_shadow_ray(&ray, 4, point, normal, &sun, &shadow);
  assert_true(isinf(shadow.to) && shadow.d[2] == 1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(srgb_known_points),         cmocka_unit_test(tone_rounds_to_nearest),
    cmocka_unit_test(ambient_term),              cmocka_unit_test(lamp_at_the_viewer),
    cmocka_unit_test(diffuse_and_highlight_at_known_angles), cmocka_unit_test(lamps_that_give_nothing),
    cmocka_unit_test(direction_is_the_way_the_light_travels), cmocka_unit_test(default_lamps),
    cmocka_unit_test(shadow_rays_start_outside), cmocka_unit_test(shadow_rays_end_at_the_lamp),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
