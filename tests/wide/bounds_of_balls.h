/* The bounds of wide/round_ball.h in rationals: the computed residual and half slope against their exact values, on spheres and lines of all sizes that the
   code admits, with rests as large as they may be. Names as in base/bounds.h. Included by two programs: products and sums rounded apart, and fused. */
#include "share.h"
#include "wide/round_ball.h"

#include <gmp.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

static uint64_t seed = 0x9fb21c651e98df25u;
static uint64_t next(void) {
  seed ^= seed << 13;
  seed ^= seed >> 7;
  seed ^= seed << 17;
  return seed;
}
static int one_in(unsigned n) { return next() % n == 0; }
static double part(void) { /* in [-1, 1], with few or many bits */
  double v = (double)(int64_t)next() * 0x1p-63;
  return one_in(5) ? ldexp(floor(ldexp(v, 6)), -6) : v;
}
static int below(int n) { return (int)(next() % (uint64_t)n); }

/* value + rest, and up to 2^-23 of the rest either way. */
static void with_rest(mpq_t out, double value, double rest) {
  mpq_t x;
  mpq_init(x);
  mpq_set_d(out, value);
  mpq_set_d(x, rest);
  mpq_add(out, out, x);
  mpq_set_d(x, rest * (one_in(2) ? 1 : part()) * 0x1p-23);
  (one_in(2) ? mpq_add : mpq_sub)(out, out, x);
  mpq_clear(x);
}

typedef struct sums { mpq_t p, slope, y, x, c; } sums;

static void exactly(sums *s, const qn_piece_sphere *stored, const double o[3], const double d[3], double t) {
  with_rest(s->p, stored->r2, stored->r2_rest);
  mpq_neg(s->p, s->p);
  mpq_set_si(s->slope, 0, 1);
  for (int j = 0; j < 3; j++) {
    with_rest(s->c, stored->centre[j], stored->rest[j]);
    mpq_set_d(s->y, t);
    mpq_set_d(s->x, d[j]);
    mpq_mul(s->y, s->y, s->x);
    mpq_set_d(s->x, o[j]);
    mpq_add(s->y, s->y, s->x);
    mpq_sub(s->y, s->y, s->c);
    mpq_set_d(s->x, d[j]);
    mpq_mul(s->x, s->x, s->y);
    mpq_add(s->slope, s->slope, s->x);
    mpq_mul(s->y, s->y, s->y);
    mpq_add(s->p, s->p, s->y);
  }
}

static double size_of(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

static void bounds(void **state) {
  (void)state;
  static qn_packet packet;
  sums s;
  mpq_inits(s.p, s.slope, s.y, s.x, s.c, NULL);
  unsigned near = 0, far = 0, outside = 0;
  double worst_p = 0, worst_slope = 0, worst_plain = 0;
  for (int n = 0; n < share_of(150000); n++) {
    const double scale = one_in(3) ? ldexp(1, below(80) - 40) : 1, r = scale * (1 + 0.999 * fabs(part()));
    qn_piece_sphere sphere = {.r2 = r * r};
    sphere.r2_rest = one_in(3) ? 0 : (float)(sphere.r2 * QN_U * part());
    double length = one_in(3) ? ldexp(1, below(80) - 40) : 1, d[3], o[3], y[3];
    const double away = ldexp(r, one_in(2) ? below(24) : below(6)), distance = ldexp(r, one_in(2) ? below(23) : below(6)) * fabs(part());
    for (int j = 0; j < 3; j++) {
      sphere.centre[j] = one_in(8) ? 0 : away * part();
      const double rest = one_in(4) ? 0 : sphere.centre[j] * QN_U * part();
      sphere.rest[j] = (float)rest;
      sphere.off = fmaxf(sphere.off, fabsf(sphere.rest[j]));
      d[j] = one_in(8) ? 0 : part(), y[j] = part();
    }
    if (size_of(d) == 0 || size_of(y) == 0) {
      continue;
    }
    length /= size_of(d);
    const double onto = (one_in(12) ? 2 : 1) * r / size_of(y);
    double t = distance / (length * size_of(d)) * (one_in(2) ? 1 : -1);
    for (int j = 0; j < 3; j++) {
      d[j] *= length;
      o[j] = sphere.centre[j] + onto * y[j] - t * d[j];
    }
    packet.d_most = size_of(d) * (1 + 0x1p-40);
    const ball b = ball_of_one(&packet, &sphere);
    const ball_residual q = ball_residual_at(&b, o, d, t);
    if (!(fabs(t) <= b.far)) {
      far++;
      continue;
    }
    exactly(&s, &sphere, o, d, t);
    mpq_set_d(s.x, q.p);
    mpq_sub(s.x, s.x, s.p);
    const double own = QN_U * fabs(q.p), off = fmax(fabs(mpq_get_d(s.x)) - own, 0);
    if (!q.near) { /* as it should be: the true one is not small either */
      outside++;
      assert_true(fabs(mpq_get_d(s.p)) > 0.5 * b.rho2);
      continue;
    }
    near++;
    assert_true(off <= b.error);
    worst_p = fmax(worst_p, off / b.error);
    worst_plain = fmax(worst_plain, sphere.off == 0 ? off / b.error : 0); /* QN_BALL_EVAL alone */
    mpq_set_d(s.x, q.slope);
    mpq_sub(s.x, s.x, s.slope);
    const double slope_off = fabs(mpq_get_d(s.x));
    assert_true(slope_off <= b.slope_error);
    worst_slope = fmax(worst_slope, slope_off / b.slope_error);
  }
  print_message("error/bound: p %.4f, without rests %.4f, slope %.4f; %u near, %u outside, %u far\n", worst_p, worst_plain, worst_slope, near, outside, far);
  assert_true(near > share_min(80000) && outside > share_min(5000));
  assert_true(!share_whole() || (worst_p > 0.5 && worst_plain > 0.05 && worst_slope > 0.05)); /* the data come near what the bounds allow for */
  mpq_clears(s.p, s.slope, s.y, s.x, s.c, NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(bounds)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
