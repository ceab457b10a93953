/* What is called empty is empty: random trees of boxes between whole numbers, judged cell by cell; and that the plain cases are seen. */
#include "scene/reading.h"
#include "share.h"

static uint64_t state = 161803;
static int in(int low, int high) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return low + (int)((state >> 33) % (uint64_t)(high - low + 1));
}

enum { SIDE = 3, CELLS = SIDE * SIDE * SIDE };
static char text[1 << 16];
static size_t at;

static void put(const char *format, ...) {
  va_list args;
  va_start(args, format);
  at += (size_t)vsnprintf(text + at, sizeof text - at, format, args);
  va_end(args);
  assert_true(at < sizeof text);
}

/* Writes a random tree and says which cells it fills, as bits. */
static uint32_t grow(int depth) {
  static const char *const words[] = {"union", "difference", "intersection"};
  if (depth == 0 || in(0, 2) == 0) {
    int low[3], high[3];
    uint32_t cells = 0;
    for (int k = 0; k < 3; k++) {
      low[k] = in(0, 3) ? 0 : in(1, SIDE - 1);
      high[k] = in(0, 1) ? SIDE : in(low[k] + 1, SIDE);
    }
    put("translate([%d, %d, %d]) cube([%d, %d, %d]);\n", low[0], low[1], low[2], high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    for (int c = 0; c < CELLS; c++) {
      const int x[3] = {c % SIDE, c / SIDE % SIDE, c / SIDE / SIDE};
      cells |= (uint32_t)(x[0] >= low[0] && x[0] < high[0] && x[1] >= low[1] && x[1] < high[1] && x[2] >= low[2] && x[2] < high[2]) << c;
    }
    return cells;
  }
  int op = in(0, 2);
  put("%s() {\n", words[op]);
  uint32_t cells = grow(depth - 1);
  for (int n = in(1, 3); n > 0; n--) {
    uint32_t other = grow(depth - 1);
    cells = op == 0 ? cells | other : op == 1 ? cells & ~other : cells & other;
  }
  put("}\n");
  return cells;
}

static void random_trees(void **unused) {
  (void)unused;
  size_t called = 0, empty = 0, full = 0;
  for (int round = 0; round < share_of(6000); round++) {
    at = 0;
    uint32_t cells = grow(in(1, 4));
    quoin_scene *s = scene_of(text);
    if (s->empty && cells) {
      print_message("%s", text);
    }
    assert_false(s->empty && cells);
    called += s->empty && s->leaf_count > 0;
    empty += cells == 0 && s->leaf_count > 0;
    full += cells != 0;
    quoin_scene_free(s);
  }
  print_message("%zu called empty of %zu that are\n", called, empty);
  assert_true(full > share_min(2000) && empty > share_min(200) && 3 * called > empty);
}

static void expect(const char *model, int empty) {
  quoin_scene *s = scene_of(model);
  if (s->empty != empty) {
    print_message("%s\n", model);
  }
  assert_int_equal(s->empty, empty);
  quoin_scene_free(s);
}

static void plain_cases(void **unused) {
  (void)unused;
  expect("difference() { cube(1); cube(1); }", 1);
  expect("difference() { cube(0.3); cube([0.1 + 0.2, 0.3, 3 / 10]); }", 1);
  expect("difference() { cylinder(h = 1, r = 1); quadric([2, 2, 0, 0, 0, 0, 0, 0, 0, -2]); }", 1);
  expect("difference() { cube(1, center = true); rotate(a = 120, v = [1, 1, 1]) cube(1, center = true); }", 1);
  expect("difference() { union() { cube(1); sphere(1); } sphere(1); cube(1); }", 1);
  expect("difference() { cube(1); union() { cube(1); sphere(4); } }", 1);
  expect("union() { difference() { cube(1); cube(1); } difference() { sphere(1); sphere(1); } }", 1);
  expect("intersection() { cube(1); translate([1, 0, 0]) cube(1); }", 1);
  expect("difference() { cube(5); union() { halfspace([0, 0, 1], 0); halfspace([0, 0, -1], 0); } }", 1);
  expect("difference() { superquadric([1, 2, 3], 0.5, 1.5); superquadric([1, 2, 3], 0.5, 1.5); }", 1);
  expect("difference() { cube(1); cube([1, 1, 0.999]); }", 0);
  expect("difference() { cube(1); difference() { cube(1); sphere(0.1); } }", 0);
  expect("union() { cube(1); difference() { cube(1); cube(1); } }", 0);
  expect("intersection() { cube(1); cube(1); }", 0);
  expect("difference() { sphere(3); difference() { sphere(3); sphere(3); } }", 0);
  expect("difference() { quadric([1, 1, 0, 0, 0, 0, 0, 0, 0, -2]); cylinder(h = 1, r = 1); }", 0);
  expect("halfspace([0, 0, 1], 0);", 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(random_trees), cmocka_unit_test(plain_cases)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
