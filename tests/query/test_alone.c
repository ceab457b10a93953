/* Lanes of a tile that end on one plane, and other surfaces that pass through their places or between them (query/alone.c): boxes, balls and cylinders with whole
   numbers, so that arithmetic on integers knows which lanes have the plane for themselves. And whose the plane is there, worked out by hand. */
#include "ask.h"
#include "share.h"

#include "query/look.h"

#include <math.h>

static uint64_t seed = 0x853c49e6748fea9bu;
static int roll(int n) {
  seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17;
  return (int)(seed % (uint64_t)n);
}

enum { BOX, BALL, UPRIGHT, LYING, KINDS, LEAVES = 12, HEIGHT = 8 }; /* places lie on z = HEIGHT; lengths are halves */
typedef struct thing { int kind, at[3], size[3]; } thing; /* a box from `at`; a ball or cylinder of radius size[0] about or from `at`, size[2] high or long */

static void write_thing(const thing *t, char *out, size_t room) {
  const double h = 0.5;
  const int *a = t->at, *s = t->size;
  static const char *const FORM[KINDS] = {"cube([%g,%g,%g]);\n", "sphere(r=%g);\n", "cylinder(r=%g,h=%g);\n", "rotate([0,90,0]) cylinder(r=%g,h=%g);\n"};
  size_t n = (size_t)snprintf(out, room, "translate([%g,%g,%g]) ", h * a[0], h * a[1], h * a[2]);
  if (t->kind == BOX) {
    snprintf(out + n, room - n, FORM[BOX], h * s[0], h * s[1], h * s[2]);
  } else if (t->kind == BALL) {
    snprintf(out + n, room - n, FORM[BALL], h * s[0]);
  } else {
    snprintf(out + n, room - n, FORM[t->kind], h * s[0], h * s[2]);
  }
}

/* Whether the place is in the closed solid, and on another of its surfaces than the plane z = HEIGHT. */
static int passes(const thing *t, const int x[3]) {
  int on = 0;
  if (t->kind == BOX) {
    for (int i = 0; i < 3; i++) {
      const int low = x[i] - t->at[i], high = t->at[i] + t->size[i] - x[i];
      if (low < 0 || high < 0) {
        return 0;
      }
      on |= i < 2 && (low == 0 || high == 0);
    }
    return on; /* the faces across z are on HEIGHT or not at the place */
  }
  const int axis = t->kind == UPRIGHT ? 2 : t->kind == LYING ? 0 : -1;
  int q = -t->size[0] * t->size[0];
  for (int i = 0; i < 3; i++) {
    const int y = x[i] - t->at[i];
    if (i != axis) {
      q += y * y;
    } else {
      if (y < 0 || y > t->size[2]) {
        return 0;
      }
      on |= axis != 2 && (y == 0 || y == t->size[2]);
    }
  }
  return q == 0 || (q < 0 && on);
}

static void lattice(void **state) {
  (void)state;
  size_t kept = 0, free_lanes = 0, taken = 0, whole = 0;
  for (int round = 0; round < share_of(3000); round++) {
    thing things[LEAVES];
    static char text[LEAVES * 200];
    size_t n = 0;
    for (int i = 0; i < LEAVES; i++) {
      thing *t = &things[i];
      *t = (thing){i == 0 ? BOX : roll(KINDS), {roll(33) - 8, roll(33) - 8, roll(13)}, {1 + roll(10), 1 + roll(10), 1 + roll(10)}};
      if (i == 0 || (t->kind == UPRIGHT && roll(2)) || (t->kind == BOX && roll(2))) { /* this one has the plane */
        t->at[2] = HEIGHT - t->size[2];
      }
      write_thing(t, text + n, sizeof text - n);
      n += strlen(text + n);
    }
    ask a;
    ask_open(&a, text);
    uint32_t plane = QUOIN_NO_SURFACE;
    for (uint32_t h = 0; h < a.scene->half_count; h++) { /* the top of the first leaf */
      const qn_half *half = &a.scene->halves[h];
      if (half->kind == QN_PLANE && a.scene->planes[half->shadow].n[2] > 0 && a.scene->planes[half->shadow].n[0] == 0 && a.scene->planes[half->shadow].n[1] == 0 &&
          h >= a.scene->leaves[0].half0 && h < a.scene->leaves[0].half0 + a.scene->leaves[0].halves) {
        plane = half->surface;
      }
    }
    if (plane == QUOIN_NO_SURFACE) { /* folded away */
      ask_close(&a);
      continue;
    }
    qn_packet p = {.tile = QN_TILE_NONE, .few = QN_MANY_LANES};
    qn_packet_hits hits = {.found = ~(uint64_t)0};
    const int x0 = roll(20) - 6, y0 = roll(20) - 6, step = 1 + roll(2);
    int place[QN_LANES][3];
    for (unsigned k = 0; k < QN_LANES; k++) {
      place[k][0] = x0 + step * (int)qn_lane_column(k), place[k][1] = y0 + step * (int)qn_lane_row(k), place[k][2] = HEIGHT;
      p.o[0][k] = 0.5 * place[k][0], p.o[1][k] = 0.5 * place[k][1], p.o[2][k] = 0.5 * HEIGHT + 4, p.d[2][k] = -0.5;
      hits.t[k] = 8, hits.error[k] = 0x1p-40, hits.surface[k] = plane;
    }
    uint64_t lanes = ~(uint64_t)0;
    for (int i = roll(4); i > 0; i--) {
      lanes &= ((uint64_t)roll(1 << 30) << 40) ^ ((uint64_t)roll(1 << 30) << 20) ^ (uint64_t)roll(1 << 30);
    }
    const uint64_t alone = qn_alone_lanes(a.scene, &p, &hits, lanes);
    assert_true((alone & ~lanes) == 0);
    whole += alone == ~(uint64_t)0;
    for (uint64_t m = lanes; m; m &= m - 1) {
      const unsigned k = qn_trailing_zeros(m);
      int another = 0;
      for (int i = 0; i < LEAVES; i++) {
        another |= passes(&things[i], place[k]);
      }
      if (another && alone >> k & 1) {
        fail_msg("lane %u at %g %g %g is not alone in\n%s", k, 0.5 * place[k][0], 0.5 * place[k][1], 0.5 * place[k][2], text);
      }
      taken += (size_t)another, free_lanes += !another, kept += alone >> k & 1;
    }
    ask_close(&a);
  }
  print_message("lanes with another surface %zu, without %zu, of which known %zu; whole tiles %zu\n", taken, free_lanes, kept, whole);
  assert_true(taken > share_min(5000) && whole > share_min(50));
  assert_true(kept > free_lanes - free_lanes / 10); /* else nothing is gained */
}

/* Places known to e: rays down x, y or their negatives end on z = 0, some of them less than e before another face. Only e can tell that they may be on it. */
static void known_to(void **state) {
  (void)state;
  static const char *const FACE[4] = {"translate([1,-20,-20]) cube(40);", "translate([-20,1,-20]) cube(40);", "translate([-41,-20,-20]) cube(40);", "translate([-20,-41,-20]) cube(40);"};
  for (int way = 0; way < 4; way++) {
    const int axis = way & 1;
    const double sign = way & 2 ? -1 : 1;
    char text[200];
    snprintf(text, sizeof text, "translate([-9,-9,-9]) cube([18,18,9]); %s", FACE[way]);
    ask a;
    ask_open(&a, text);
    qn_seen seen;
    assert_int_equal(qn_look_alone(a.work, &(quoin_ray){{0, 0, 1}, {0, 0, -1}, 0, HUGE_VAL}, QUOIN_NO_SURFACE, QN_LOOK_T, &seen), QUOIN_OK);
    for (int lane = 0; lane < QN_LANES; lane++) {
      for (int far = 0; far < 2; far++) {
        qn_packet p = {.tile = QN_TILE_NONE, .few = QN_MANY_LANES};
        qn_packet_hits hits = {.found = ~(uint64_t)0};
        for (int k = 0; k < QN_LANES; k++) {
          const double x = 0.25 + k / 128.0;
          p.o[axis][k] = sign * (x - 2), p.o[2][k] = 1, p.d[axis][k] = sign, p.d[2][k] = -0.5;
          hits.t[k] = 2, hits.error[k] = k == lane ? (1 - x) * (far ? 0.75 : 1.25) : 0x1p-40, hits.surface[k] = seen.surface;
        }
        const uint64_t one = (uint64_t)1 << lane, pair = one | (uint64_t)1 << (lane ^ 1);
        const uint64_t lanes[3] = {one, pair, ~(uint64_t)0};
        for (int i = 0; i < 3; i++) {
          assert_int_equal(qn_alone_lanes(a.scene, &p, &hits, lanes[i]), far ? lanes[i] : lanes[i] & ~one);
        }
      }
    }
    ask_close(&a);
  }
}

/* Rays along x through the middle of slabs, from `from` on: the first boundary is at `at`, where several slabs have a face. Slabs change in the order of the text, and the one at
   which the solid's value last changes is named. */
#define SLAB(from, to) "translate([" #from ",-9,-9]) cube([" #to "-(" #from "),18,18]);"
static const struct { const char *text; double from, at; uint32_t part; } PARTS[] = {
  {"union(){" SLAB(0, 9) SLAB(0, 7) "}", -5, 0, 0},                                         /* in with the first */
  {"union(){" SLAB(0, 9) SLAB(3, 9) "}", 5, 9, 1},                                          /* out with the last */
  {"intersection(){" SLAB(0, 9) SLAB(0, 7) "}", -5, 0, 1},
  {"intersection(){" SLAB(0, 9) SLAB(3, 9) "}", 5, 9, 0},
  {"union(){difference(){" SLAB(0, 9) SLAB(0, 3) "}" SLAB(0, 7) "}", -5, 0, 2},             /* in, out again, in */
  {"union(){intersection(){" SLAB(0, 9) SLAB(-2, 9) "}" SLAB(0, 7) "}", -1, 0, 0},          /* the second holds the place */
  {"intersection(){union(){" SLAB(0, 9) SLAB(-2, 9) "}" SLAB(0, 7) SLAB(-3, 8) "}", -1, 0, 2},
  {"difference(){" SLAB(0, 9) SLAB(1, 4) SLAB(2, 4) "}", 3, 4, 2},                          /* in where the last of two is left */
  {"difference(){union(){" SLAB(0, 4) SLAB(4, 8) "}" SLAB(4, 6) "}", 2, 4, 2},              /* out, in, out */
  {"difference(){union(){" SLAB(4, 8) SLAB(0, 4) "}" SLAB(4, 6) "}", 2, 4, 2},              /* no change, out, no change: the third makes it end */
};

static void parts(void **state) {
  (void)state;
  for (size_t n = 0; n < sizeof PARTS / sizeof *PARTS; n++) {
    ask a;
    ask_open(&a, PARTS[n].text);
    static quoin_ray rays[QN_LANES];
    static quoin_hit hits[QN_LANES];
    for (unsigned k = 0; k < QN_LANES; k++) {
      rays[k] = (quoin_ray){{0, 0.125 * (k & 7), 0.125 * (k >> 3)}, {1, 0, 0}, PARTS[n].from, HUGE_VAL};
    }
    assert_int_equal(quoin_first_hits(a.scene, a.work, QN_LANES, rays, hits), QUOIN_OK);
    for (unsigned k = 0; k < QN_LANES; k++) {
      quoin_hit one;
      assert_int_equal(quoin_first_hit(a.scene, a.work, &rays[k], &one), QUOIN_OK);
      assert_true(hits[k].found && one.found && hits[k].t == PARTS[n].at && one.t == PARTS[n].at);
      if (hits[k].part != PARTS[n].part || one.part != PARTS[n].part) {
        fail_msg("parts %u and %u, not %u, in %s", hits[k].part, one.part, PARTS[n].part, PARTS[n].text);
      }
    }
    ask_close(&a);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(lattice), cmocka_unit_test(known_to), cmocka_unit_test(parts)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
