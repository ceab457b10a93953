/* Random solids on a coarse grid, so that faces, edges, tangencies and apexes meet often. */
#ifndef QN_TESTS_RANDOM_SOLID_H
#define QN_TESTS_RANDOM_SOLID_H

#include <stdint.h>
#include <stdio.h>
#include <string.h>

typedef struct dice { uint64_t state; } dice;
static inline int roll(dice *d, int n) {
  d->state ^= d->state << 13, d->state ^= d->state >> 7, d->state ^= d->state << 17;
  return (int)((d->state >> 20) % (uint64_t)n);
}

/* Dice for the n-th model of a test: the model does not depend on what was rolled before, of which there is more where more instruction sets run. */
static inline dice dice_of(uint64_t seed, size_t n) {
  dice d = {(seed + n) * UINT64_C(0xd1342543de82ef95) | 1};
  for (int i = 0; i < 8; i++) {
    (void)roll(&d, 2);
  }
  return d;
}

/* One primitive about the origin's neighbourhood; planar: faces only. */
static inline void random_leaf(dice *d, int planar, char *text, size_t size) {
  int x = roll(d, 4) - 2, y = roll(d, 4) - 2, z = roll(d, 4) - 2, a = 1 + roll(d, 2), b = 1 + roll(d, 2);
  static const char *const turns[] = {"", "", "rotate([90,0,0])", "rotate([0,90,0])", "rotate([180,0,0])", "rotate([45,0,0])"};
  const char *turn = turns[roll(d, planar ? 5 : 6)];
  switch (planar ? roll(d, 2) : roll(d, 10)) {
    case 0: snprintf(text, size, "translate([%d,%d,%d]) %s cube([%d,%d,%d]);", x, y, z, turn, a, b, 1 + roll(d, 2)); break;
    case 1: snprintf(text, size, "translate([%d,%d,%d]) %s wedge([%d,%d,%d]);", x, y, z, turn, a, b, 1 + roll(d, 2)); break;
    case 2: case 3: snprintf(text, size, "translate([%d,%d,%d]) sphere(%d);", x, y, z, a); break;
    case 4: case 5: snprintf(text, size, "translate([%d,%d,%d]) %s cylinder(r=%d,h=%d);", x, y, z, turn, a, b); break;
    case 6: snprintf(text, size, "translate([%d,%d,%d]) %s cylinder(r1=%d,r2=0,h=%d);", x, y, z, turn, a, b); break;
    case 7: snprintf(text, size, "translate([%d,%d,%d]) %s paraboloid(r=%d,h=%d);", x, y, z, turn, a, b); break;
    case 8: snprintf(text, size, "translate([%d,%d,%d]) %s cylinder(r1=%d,r2=%d,h=1);", x, y, z, turn, a, 3 - a); break;
    default: snprintf(text, size, "translate([%d,%d,%d]) scale([%d,%d,1]) sphere(1);", x, y, z, a, b); break;
  }
}

/* A tree of `leaves` primitives. */
static inline void random_solid(dice *d, int planar, int leaves, char *text, size_t size) {
  static const char *const words[] = {"union", "difference", "union", "intersection", "union"};
  if (leaves <= 1) {
    random_leaf(d, planar, text, size);
    return;
  }
  int left = 1 + roll(d, leaves - 1);
  size_t at = (size_t)snprintf(text, size, "%s() { ", words[roll(d, 5)]);
  random_solid(d, planar, left, text + at, size - at);
  at += strlen(text + at);
  random_solid(d, planar, leaves - left, text + at, size - at);
  at += strlen(text + at);
  snprintf(text + at, size - at, " }");
}

#endif
