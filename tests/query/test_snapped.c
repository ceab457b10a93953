/* Snapped scenes answer as the same half-spaces do when they are written out one by one, which have no boxes and no kinds. */
#include "scene/reading.h"
#include "scene/snap.h"
#include "share.h"

#include <gmp.h>
#include <math.h>
#include <stdlib.h>

static quoin_scene *snapped(const char *text, const char *snap, unsigned threads) {
  quoin_model *m;
  quoin_scene *s = NULL;
  quoin_compile_options options = quoin_compile_options_default();
  options.snap = snap;
  options.threads = threads;
  assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
  assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "t", text, strlen(text), NULL), QUOIN_OK);
  assert_int_equal(quoin_scene_compile(m, &options, &s), QUOIN_OK);
  quoin_model_free(m);
  return s;
}

static uint64_t state;
static uint64_t next(void) {
  state ^= state << 13, state ^= state >> 7, state ^= state << 17;
  return state;
}
static int below(int n) {
  return (int)(next() % (uint64_t)n);
}

/* The union of leaves as a text of quadrics and half-spaces, which have no boxes. */
static char *written_out(const quoin_scene *s) {
  size_t size = 1 << 22;
  char *text = malloc(size), *at = text;
  assert_non_null(text);
  for (uint32_t i = 0; i < s->leaf_count; i++) {
    const qn_leaf *leaf = &s->leaves[i];
    at += sprintf(at, "intersection() {\n");
    for (uint32_t h = leaf->half0; h < leaf->half0 + leaf->halves; h++) {
      const qn_half *half = &s->halves[h];
      const qn_exact_surface *e = qn_scene_exact(s, half->surface, NULL);
      assert_non_null(e);
      at += sprintf(at, "  quadric([");
      for (int c = 0; c < 10; c++) {
        mpz_t v;
        at += gmp_sprintf(at, "%s%Zd", c ? "," : "", mpz_roinit_n(v, e->q[c].d, half->side < 0 ? -e->q[c].n : e->q[c].n));
      }
      at += sprintf(at, "]);\n");
      assert_true((size_t)(at - text) < size - 100000);
    }
    at += sprintf(at, "}\n");
  }
  return text;
}

static double uniform(double low, double high) {
  return low + (high - low) * (double)(next() >> 11) * 0x1p-53;
}

static size_t same_answers(const quoin_scene *s, int rays) {
  char *text = written_out(s);
  quoin_scene *other = scene_of(text);
  quoin_work *work, *twin;
  size_t ends = 0;
  assert_int_equal(quoin_work_new(s, &work), QUOIN_OK);
  assert_int_equal(quoin_work_new(other, &twin), QUOIN_OK);
  double size = 0;
  for (int k = 0; k < 3; k++) {
    assert_true(isfinite(s->min[k]) && isfinite(s->max[k]));
    size = fmax(size, s->max[k] - s->min[k]);
  }
  for (int i = 0; i < rays; i++) {
    quoin_ray ray = {.from = -INFINITY, .to = INFINITY};
    quoin_intervals a, b;
    const qn_leaf *last = &s->leaves[s->leaf_count - 1];
    for (int k = 0; k < 3; k++) { /* through places in the box of all, or of the last leaf, and a little beyond */
      double low = i % 2 ? s->min[k] : last->min[k], high = i % 2 ? s->max[k] : last->max[k], more = i % 2 ? 0.01 * size : 0.03 * (high - low);
      ray.o[k] = uniform(low - more, high + more);
      ray.d[k] = i % 4 == k ? 0 : uniform(-1, 1);
    }
    assert_int_equal(quoin_ray_intervals(s, work, &ray, 0, &a), QUOIN_OK);
    assert_int_equal(quoin_ray_intervals(other, twin, &ray, 0, &b), QUOIN_OK);
    if (a.count != b.count) {
      fail_msg("ray %.17g %.17g %.17g  %.17g %.17g %.17g of\n%s", ray.o[0], ray.o[1], ray.o[2], ray.d[0], ray.d[1], ray.d[2], text);
    }
    for (size_t k = 0; k < a.count; k++) {
      assert_true(a.inside[k].enter.t == b.inside[k].enter.t && a.inside[k].leave.t == b.inside[k].leave.t);
    }
    ends += a.count;
  }
  quoin_work_free(work);
  quoin_work_free(twin);
  quoin_scene_free(other);
  free(text);
  return ends;
}

/* Solids with caps and faces near the tilted planes of larger ones. */
static void put_solid(char *text) {
  int n = 1 + below(9), h = 1 + below(4);
  double r = 1 + below(3), off = (below(5) - 2) * 1e-5, turn = below(2) ? 0 : (below(9) - 4) * 1e-6;
  text += sprintf(text, "multmatrix([[1,%.9g,0,%.9g],[%.9g,1,%.9g,%d],[0,%.9g,1,%.9g]]) ", turn, (double)below(5) + off, -turn, turn / 2, below(5), -turn / 2,
                  below(3) + off);
  switch (n) {
  case 1: sprintf(text, "cube([%d,2,%d]);\n", h, 1 + below(2)); break;
  case 2: sprintf(text, "wedge([%d,2,1]);\n", h); break;
  case 3: sprintf(text, "cylinder(h=%d,r=%.9g);\n", h, r + off); break;
  case 4: sprintf(text, "cylinder(h=%d,r1=%.9g,r2=%d);\n", h, r, below(2)); break;
  case 5: sprintf(text, "paraboloid(h=%d,r=%.9g);\n", h, r); break;
  case 6: sprintf(text, "hyperboloid(h=%d,r=%.9g,rc=%.9g);\n", h, r + 1, r); break;
  case 7: sprintf(text, "cylinder(h=%d,r=%.9g,$fn=%d);\n", h, r, 3 + below(6)); break;
  case 8: sprintf(text, "sphere(%.9g);\n", r + off); break;
  default: sprintf(text, "hyperboloid(h=%d,r=%.9g,gap=%.9g);\n", h, r, 0.5 * h); break;
  }
}

static void same_as_written_out(void **unused) {
  (void)unused;
  size_t ends = 0, moved = 0;
  state = 0x5555aaaa12345u;
  for (int round = 0; round < share_of(150); round++) {
    static char text[20000];
    text[0] = '\0';
    for (int i = 0; i < 10; i++) {
      put_solid(text + strlen(text));
    }
    quoin_scene *s = snapped(text, round % 2 ? "0.0001" : "0.00003", 1);
    moved += quoin_near_count(quoin_scene_snapped(s));
    ends += same_answers(s, 60);
    quoin_scene_free(s);
  }
  assert_true(moved > share_min(500) && ends > share_min(3000));
}

/* Tilted caps, and bodies whose box has to be found anew: each must be bounded. */
static void boxes_hold(void **unused) {
  (void)unused;
  static const char *const texts[] = {
    "cube(50,center=true); multmatrix([[1,0,1e-6,0],[0,1,0,0],[-1e-6,0,1,25]]) cylinder(h=3,r1=2,r2=0);",
    "cube(50,center=true); multmatrix([[1,0,1e-6,0],[0,1,0,0],[-1e-6,0,1,25]]) cylinder(h=3,r1=2,r2=1);",
    "cube(50,center=true); multmatrix([[1,0,1e-6,0],[0,1,0,0],[-1e-6,0,1,22]]) cylinder(h=3,r1=0,r2=1);",
    "cube(50,center=true); multmatrix([[1,0,1e-6,0],[0,1,0,0],[-1e-6,0,1,22]]) paraboloid(h=3,r=2);",
    "cube(50,center=true); multmatrix([[1,0,1e-6,0],[0,1,0,0],[-1e-6,0,1,22]]) hyperboloid(h=3,r=2,rc=1);",
    "cube(50,center=true); multmatrix([[1,0,1e-6,0],[0,1,0,0],[-1e-6,0,1,22]]) hyperboloid(h=3,r=2,gap=1);",
    "cube(50,center=true); multmatrix([[1,0,1e-6,0],[0,1,0,0],[-1e-6,0,1,25]]) cube([1,2,3]);",
    "cube(50,center=true); multmatrix([[1,0,1e-6,0],[0,1,0,0],[-1e-6,0,1,25]]) wedge([1,2,3]);",
    "cube(50,center=true); multmatrix([[1,0,1e-6,0],[0,1,0,0],[-1e-6,0,1,25]]) cylinder(h=3,r1=2,r2=0,$fn=7);",
    "cube(50,center=true); multmatrix([[1,0,1e-6,0],[0,1,0,0],[-1e-6,0,1,25]]) polyhedron([[0,0,0],[5,0,0],[0,5,0],[0,0,5]],[[0,1,2],[0,3,1],[0,2,3],[1,3,2]]);",
    "cube(50,center=true); multmatrix([[1,0,0.012,0],[0,1,0,0],[-0.012,0,1,22]]) cylinder(h=3,r=2);", /* the cap's far end is 0.024 higher */
    "cube(50,center=true); multmatrix([[1,0,0.012,0],[0,1,0,0],[-0.012,0,1,22]]) cylinder(h=3,r1=1,r2=4);",
    "cube(50,center=true); multmatrix([[1,0,0.012,0],[0,1,0,0],[-0.012,0,1,22]]) hyperboloid(h=3,r=4,rc=1);",
    "cube(50,center=true); multmatrix([[1,0,0.012,0],[0,1,0,0],[-0.012,0,1,28]]) paraboloid(base=[0,0,-3],axis=[0,0,1],h=3,r=3);",
    "cube(50,center=true); multmatrix([[1,0,0.012,0],[0,1,0,0],[-0.012,0,1,22]]) cube([5,2,3]);",
    "cube(50,center=true); multmatrix([[1,0,0.012,0],[0,1,0,0],[-0.012,0,1,25]]) wedge([5,2,3]);",
    "scale([1,2,3]) sphere(1); translate([0,1e-6,0]) rotate([90,0,0]) ellipsoid([1,3,2]); rotate([0,0,1e-5]) sphere(0.5); sphere(0.50001);",
  };
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    quoin_scene *s = snapped(texts[i], strstr(texts[i], "0.012") ? "0.2" : "0.0001", 1);
    assert_true(quoin_near_count(quoin_scene_snapped(s)) > 0);
    assert_int_equal(s->unbounded_count, 0);
    for (int k = 0; k < 3; k++) {
      assert_true(s->max[k] - s->min[k] < 60);
    }
    assert_true(same_answers(s, 300) > 20);
    quoin_scene_free(s);
  }
}

/* The order of operands and the number of threads change nothing but names where the sizes say what stands. */
static void any_order(void **unused) {
  (void)unused;
  const char *a = "cube(10); translate([10.0000001,2,2]) cube(5); translate([2,2,10.00000005]) cylinder(h=2,r=1);";
  const char *b = "translate([2,2,10.00000005]) cylinder(h=2,r=1); translate([10.0000001,2,2]) cube(5); cube(10);";
  quoin_scene *s = snapped(a, "1e-6", 1), *t = snapped(b, "1e-6", 4);
  assert_int_equal(s->surface_count, t->surface_count);
  quoin_work *u, *v;
  assert_int_equal(quoin_work_new(s, &u), QUOIN_OK);
  assert_int_equal(quoin_work_new(t, &v), QUOIN_OK);
  const char *const on[3] = {"10", "3", "3"}, *const wall[3] = {"10", "2", "2"}, *const off[3] = {"10.0000001", "1", "1"};
  quoin_side x, y;
  assert_int_equal(quoin_point_side_text(s, u, on, &x), QUOIN_OK);
  assert_int_equal(quoin_point_side_text(t, v, on, &y), QUOIN_OK);
  assert_true(x == QUOIN_INSIDE && y == QUOIN_INSIDE); /* no film between */
  assert_int_equal(quoin_point_side_text(s, u, wall, &x), QUOIN_OK);
  assert_int_equal(quoin_point_side_text(t, v, wall, &y), QUOIN_OK);
  assert_true(x == QUOIN_BOUNDARY && y == QUOIN_BOUNDARY);
  assert_int_equal(quoin_point_side_text(s, u, off, &x), QUOIN_OK);
  assert_true(x == QUOIN_OUTSIDE);
  quoin_work_free(u);
  quoin_work_free(v);
  quoin_scene_free(s);
  quoin_scene_free(t);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(same_as_written_out), cmocka_unit_test(boxes_hold), cmocka_unit_test(any_order)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
