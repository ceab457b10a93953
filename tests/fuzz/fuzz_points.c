/* Points on any model. Laws: one by one, many at once and as decimals alike; the solid's complement has the other side; a point outside the box is
   outside; a point not outside is in a part, when parts are asked for. */
#include "fuzz.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 24 };

/* A solid without a surface, as 0 <= 1 is, is no part: only a scene that has no end in any direction can have one. */
static int everywhere(const quoin_scene_info *info) {
  int all = 1;
  for (int k = 0; k < 3; k++) {
    all &= isinf(info->box_min[k]) && isinf(info->box_max[k]);
  }
  return all;
}

static void wrong(const char *what, const double p[3], quoin_side a, quoin_side b) {
  fuzz_wrong("%s: side %d, %d of the point %.17g %.17g %.17g", what, (int)a, (int)b, p[0], p[1], p[2]);
}

/* Everything but the solid, as another model. */
static void complement(const uint8_t *text, size_t length, size_t n, const double *points, const quoin_side *sides) {
  static const char before[] = "difference() {halfspace([0,0,1],1e300);union(){\n", after[] = "\n}}\n";
  fuzz_text both = {0};
  fuzz_scene s = {0};
  quoin_side other[POINTS];
  if (fuzz_append(&both, before, sizeof before - 1) == 0 && fuzz_append(&both, (const char *)text, length) == 0 && fuzz_append(&both, after, sizeof after - 1) == 0 &&
      fuzz_read((const uint8_t *)both.at, both.length, &s) && fuzz_compile(&s, NULL) && !fuzz_late() &&
      fuzz_answered(quoin_point_sides(s.scene, s.work, n, points, other), "points of the complement")) {
    for (size_t i = 0; i < n; i++) {
      if (points[3 * i + 2] < 1e299 && (int)other[i] != 2 - (int)sides[i]) {
        wrong("a solid and its complement", points + 3 * i, sides[i], other[i]);
      }
    }
  }
  fuzz_close(&s);
  free(both.at);
}

static int has(const uint8_t *text, size_t length, char c) {
  return length && memchr(text, c, length) != NULL;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_begin(data, size);
  fuzz_bytes tail;
  size_t length = fuzz_split(data, size, &tail), n = 0;
  fuzz_scene s;
  double points[3 * POINTS];
  quoin_side many[POINTS], side;
  do {
    for (size_t i = 0; i < 3; i++) {
      points[3 * n + i] = fuzz_number(&tail);
    }
    n++;
  } while (n < POINTS && fuzz_more(&tail));
  if (fuzz_read(data, length, &s) && fuzz_compile(&s, NULL) && !fuzz_late() && fuzz_answered(quoin_point_sides(s.scene, s.work, n, points, many), "points")) {
    quoin_scene_info info;
    quoin_scene_get_info(s.scene, &info);
    for (size_t i = 0; i < n && !fuzz_late(); i++) {
      const double *p = points + 3 * i;
      if (fuzz_answered(quoin_point_side(s.scene, s.work, p, &side), "a point") && side != many[i]) {
        wrong("alone and among many", p, side, many[i]);
      }
      char text[3][FUZZ_DECIMAL];
      for (int k = 0; k < 3; k++) {
        fuzz_decimal(p[k], text[k]);
        if (many[i] != QUOIN_OUTSIDE && (info.empty || p[k] < info.box_min[k] || p[k] > info.box_max[k])) {
          wrong("beyond the box", p, many[i], many[i]);
        }
      }
      const char *const decimals[3] = {text[0], text[1], text[2]};
      size_t count = 0;
      quoin_part part;
      if (fuzz_answered(quoin_point_side_text(s.scene, s.work, decimals, &side), "a point as decimals")) {
        if (side != many[i]) {
          wrong("as decimals and as doubles", p, side, many[i]);
        }
        if (fuzz_answered(quoin_point_parts_text(s.scene, s.work, decimals, &part, 1, &count), "parts of a point") && count == 0 && side != QUOIN_OUTSIDE && !everywhere(&info)) {
          wrong("in no part", p, side, side);
        }
      }
    }
    if (!fuzz_late() && !has(data, length, '!') && s.status == QUOIN_OK) { /* a '!' would make the solid the whole again */
      complement(data, length, n, points, many);
    }
  }
  fuzz_close(&s);
  fuzz_end();
  return 0;
}
