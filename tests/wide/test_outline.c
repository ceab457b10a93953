/* Tiles, other packets of one direction, and balls seen along the rays (wide/outline.h): a lane that is said to miss a ball does so in rationals, with every stored number as far off as its contract allows.
   Balls are laid so that the line of one lane, mostly the nearest of its four, touches them or nearly so. */
#define QN_LANES_NOW 64
#if !defined(QN_ISA_AVX2) && !defined(QN_ISA_AVX512) /* those that the machine has run too: tests/CMakeLists.txt */
#define QN_ISA_SSE2
#endif
#include "dice.h"
#include "share.h"
#include "wide/facts.h"

#include <gmp.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

static double part(void) { return part_of(5, 4); } /* in [-1, 1], with few or many bits */
static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static void minus_along(double a[3], const double d[3]) {
  const double along = dot(a, d) / dot(d, d);
  for (int i = 0; i < 3; i++) {
    a[i] -= along * d[i];
  }
}
/* Whether it has a length; if so, it is 1 then. */
static int unit(double a[3]) {
  const double size = sqrt(dot(a, a));
  for (int i = 0; i < 3 && size > 0; i++) {
    a[i] /= size;
  }
  return size > 0;
}

/* A tile: its columns go along u and its rows along v, and the last may be repeated. */
static int make_tile(qn_packet *p) {
  double u[3], v[3], d[3], o[3];
  const double scale = one_in(3) ? ldexp(1, below(160) - 80) : 1, away = one_in(4) ? ldexp(1, below(54)) : one_in(2) ? ldexp(1, below(30)) : 4;
  for (int i = 0; i < 3; i++) {
    d[i] = one_in(4) ? 0 : part(), u[i] = part(), v[i] = part(), o[i] = away * scale * part();
  }
  const int straight = !one_in(4), columns = one_in(6) ? below(8) : 7, rows = one_in(6) ? below(8) : 7;
  if (!unit(d)) {
    return 0;
  }
  if (straight) { /* as cameras make them: across the rays and each other */
    minus_along(u, d), minus_along(v, d);
    if (!unit(u)) {
      return 0;
    }
    minus_along(v, u);
    if (!unit(v)) {
      return 0;
    }
  } else if (one_in(4)) { /* rows along the rays, or nearly so */
    for (int i = 0; i < 3; i++) {
      u[i] = d[i] + (one_in(2) ? 0 : part() * 0x1p-40);
    }
  }
  const double wide = scale * fabs(part()), tall = one_in(2) ? wide : scale * fabs(part()), length = ldexp(1 + fabs(part()), one_in(2) ? 0 : below(80) - 40);
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 8; k++) {
      p->across[i][k] = o[i] + wide * u[i] * (k < columns ? k : columns), p->up[i][k] = tall * v[i] * (k < rows ? k : rows);
    }
    for (int k = 0; k < QN_LANES; k++) {
      p->d[i][k] = length * d[i];
    }
  }
  p->tile = QN_TILE_ORIGINS;
  return 1;
}

/* Lanes of the same direction that lie in no order, at any depth; their starts are exact, or within u moved. */
static void scatter(qn_packet *p) {
  const double shake = one_in(3) ? 0 : 1, deep = one_in(2) ? 0 : ldexp(part(), below(20));
  for (unsigned k = 0; k < QN_LANES; k++) {
    const unsigned c = (unsigned)below(8), r = (unsigned)below(8);
    const double along = deep * part();
    for (int i = 0; i < 3; i++) {
      const double wide = fabs(p->across[i][7] - p->across[i][0]) + fabs(p->up[i][7] - p->up[i][0]);
      p->o[i][k] = p->across[i][c] + p->up[i][r] + shake * wide * part() + along * p->d[i][0];
    }
  }
  p->tile = one_in(2) ? QN_TILE_NONE : QN_TILE_MOVED;
  for (int i = 0; i < 3; i++) {
    p->moved[i] = fabs(p->o[i][0]) * ldexp(fabs(part()), below(40));
  }
}

/* Where the ray comes nearest to the centre, from there. */
static void nearest(const qn_packet *p, unsigned lane, const double c[3], double out[3]) {
  const double d[3] = {p->d[0][lane], p->d[1][lane], p->d[2][lane]};
  for (int i = 0; i < 3; i++) {
    out[i] = p->o[i][lane] - c[i];
  }
  minus_along(out, d);
}

/* Exactly: (y . d)^2 - |d|^2 (|y|^2 - r^2) < 0. The true centre is off by as much as it may be, towards the line; r^2 is larger. */
static int misses(const qn_packet *p, unsigned lane, const qn_piece_sphere *b) {
  double to[3];
  nearest(p, lane, b->centre, to);
  mpq_t y, x, yd, dd, yy;
  mpq_inits(y, x, yd, dd, yy, NULL);
  for (int i = 0; i < 3; i++) {
    mpq_set_d(y, p->o[i][lane]);
    mpq_set_d(x, b->centre[i]), mpq_sub(y, y, x);
    mpq_set_d(x, to[i] > 0 ? (double)b->off : -(double)b->off), mpq_sub(y, y, x);
    if (p->tile == QN_TILE_MOVED) {
      mpq_set_d(x, to[i] > 0 ? QN_U * p->moved[i] : -QN_U * p->moved[i]), mpq_sub(y, y, x);
    }
    mpq_set_d(x, p->d[i][lane]), mpq_mul(x, x, y), mpq_add(yd, yd, x);
    mpq_set_d(x, p->d[i][lane]), mpq_mul(x, x, x), mpq_add(dd, dd, x);
    mpq_mul(x, y, y), mpq_add(yy, yy, x);
  }
  mpq_set_d(x, 1 + 8 * QN_U), mpq_set_d(y, b->r2), mpq_mul(x, x, y);
  mpq_sub(yy, yy, x), mpq_mul(yy, yy, dd), mpq_mul(yd, yd, yd);
  const int out = mpq_cmp(yd, yy) < 0;
  mpq_clears(y, x, yd, dd, yy, NULL);
  return out;
}

static void certain(int scattered) {
  static qn_packet p;
  static walk w;
  static struct quoin_scene scene;
  w.scene = &scene;
  unsigned said = 0, close = 0, kept = 0, idle = 0;
  for (int n = 0; n < share_of(100000); n++) {
    if (!make_tile(&p)) {
      continue;
    }
    if (scattered) {
      scatter(&p);
    }
    p.new_origins = p.new_directions = 1;
    if (!facts(&w, &p)) {
      continue;
    }
    if (!scattered) {
      fill_tile(&p, p.o);
    }
    w.outline.made = 0;
    for (int balls = 0; balls < 3; balls++) {
      const unsigned lane = (unsigned)below(64), four = lane & ~3u, together = scattered ? 1 : 4;
      const double d[3] = {p.d[0][0], p.d[1][0], p.d[2][0]}, apart = fabs(p.across[0][1] - p.across[0][0]) + fabs(p.across[1][1] - p.across[1][0]) + fabs(p.up[2][1] - p.up[2][0]);
      double away[3], out[3];
      for (int i = 0; i < 3; i++) {
        const double middle = 0.25 * (p.o[i][four] + p.o[i][four + 1] + p.o[i][four + 2] + p.o[i][four + 3]);
        away[i] = p.o[i][lane] - middle, out[i] = part();
      }
      minus_along(away, d), minus_along(out, d);
      if (!unit(out)) {
        continue;
      }
      for (int i = 0; i < 3 && !one_in(4) && unit(away); i++) { /* outwards */
        out[i] = away[i];
      }
      minus_along(out, d);
      if (!unit(out)) {
        continue;
      }
      const double r = (apart > 0 ? apart : 1) * ldexp(1 + fabs(part()), below(12) - 6), gap = r * ldexp(part(), -below(46)), on = part() * ldexp(r, below(20)) / sqrt(dot(d, d));
      qn_piece_sphere b = {.r2 = r * r, .off = one_in(2) ? 0 : (float)(r * ldexp(fabs(part()), one_in(2) ? -45 : -10))};
      for (int i = 0; i < 3; i++) {
        b.centre[i] = p.o[i][lane] + on * d[i] + (r + gap) * out[i];
      }
      const uint64_t may = outline_lanes(&w, &b);
      for (unsigned i = 0; i < QN_LANES; i++) {
        double to[3];
        nearest(&p, i, b.centre, to);
        const double far = sqrt(dot(to, to));
        const int near = far < 1.01 * r + 0x1p-40 * (fabs(p.o[0][i]) + fabs(p.o[1][i]) + fabs(p.o[2][i]) + fabs(on) * sqrt(dot(d, d)));
        kept += (may >> i & 1) && i / together == lane / together, idle += (may >> i & 1) && i / together == lane / together && far > 2 * (r + apart);
        if (!(may >> i & 1)) {
          said++, close += far < 1.002 * r;
          assert_true(!near || misses(&p, i, &b));
        }
      }
    }
  }
  print_message("%u lanes miss, %u of them by little; of the touched fours %u lanes kept, %u of them far away\n", said, close, kept, idle);
  assert_true(said > share_min(1000000) && close > share_min(1000) && kept > share_min(scattered ? 50000 : 100000) && idle < kept / 20);
}
static void tiles(void **state) {
  (void)state;
  certain(0);
}
static void scattered_lanes(void **state) {
  (void)state;
  certain(1);
}

/* Where numbers leave the range of floats nothing is said to miss that does not. */
static void beyond_floats(void **state) {
  (void)state;
  static qn_packet p;
  static walk w;
  unsigned said = 0;
  for (int e = -540; e <= 300; e += 3) {
    for (int k = 0; k < 8; k++) {
      for (int i = 0; i < 3; i++) {
        p.across[i][k] = i == 0 ? ldexp(k, e) : 0, p.up[i][k] = i == 1 ? ldexp(k, e) : 0;
      }
    }
    for (int k = 0; k < QN_LANES; k++) {
      p.d[0][k] = p.d[1][k] = 0, p.d[2][k] = 1;
    }
    p.tile = QN_TILE_ORIGINS;
    see_tile_origins(&p), fill_tile(&p, p.o), see_across(&p);
    w.f.p = &p, w.outline.made = 0;
    for (int size = -20; size <= 20; size++) {
      qn_piece_sphere b = {.centre = {-ldexp(1.5, e + size), 0, ldexp(1, e)}, .r2 = ldexp(1, 2 * (e + size))};
      const uint64_t may = outline_lanes(&w, &b);
      b.centre[0] = -ldexp(1 - 0x1p-20, e + size); /* it holds the first lane */
      assert_true(outline_lanes(&w, &b) & 1);
      for (unsigned i = 0; i < QN_LANES; i++) {
        said += !(may >> i & 1);
      }
    }
  }
  assert_true(said > 10000);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(tiles), cmocka_unit_test(scattered_lanes), cmocka_unit_test(beyond_floats)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
