/* Near surfaces and snapping (S4): gaps by hand, and the property on random models. */
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

/* --- gaps by hand ---------------------------------------------------------------------------------------------------- */

typedef struct gap_row { const char *text, *limit; size_t pairs; const char *exact; double gap; int opposite; } gap_row;

static const gap_row gaps[] = {
  /* planes */
  {"cube(1); translate([1+8.8e-11,0,0]) cube(1);", "1e-10", 1, "8.8e-11", 8.8e-11, 1},
  {"cube(1); translate([1+8.8e-11,0,0]) cube(1);", "8.8e-11", 1, "8.8e-11", 8.8e-11, 1}, /* as large as the limit: near */
  {"cube(1); translate([1+8.8e-11,0,0]) cube(1);", "8.7999999999e-11", 0, "", 0, 0},
  {"cube(1); translate([0.1,0.1,1e-60]) cube(1.5);", "1e-50", 1, "1e-60", 1e-60, 0},
  {"cube(1); translate([1/3,1/3,1/3000000]) cube(2);", "1e-6", 1, "(1/3000000)", 1.0 / 3000000, 0},
  {"cube(0.300000012); translate([0,0,0.3]) cube(0.2);", "1e-7", 1, "1.2e-08", 1.2e-8, 1}, /* 0.3 as a single, in nine digits */
  {"cube(1); translate([0,0,50]) cube([2,2,1e-7]);", "1e-6", 1, "1e-07", 1e-7, 1},          /* both faces of one part */
  {"cube(1); translate([1e-7,9,9]) cube(1);", "1e-6", 0, "", 0, 0},                         /* not near where they are used */
  {"halfspace([3,4,0],10); halfspace([-6,-8,0],-20.001);", "1e-3", 1, "0.0001", 1e-4, 1},   /* normals of length 5 and 10 */
  {"halfspace([1,1,0],2); halfspace([1,1,0],2.00001);", "1e-5", 1, "", 7.0710678118654752e-6, 0},
  /* over the smaller region, [0,1]^3: s1 = z, s2 = (4096 z - 3 x) / L, L = sqrt(4096^2 + 9) = 4096.00109863; at x = z = 1 their difference is
     (L - 4093) / L */
  {"cube([1,1,1]); intersection() { halfspace([3,0,-4096],0); translate([-9,-9,-9]) cube(20); }", "1e-3", 1, "", 7.3268989934e-4, 0},
  {"cube(1); rotate([0,0,2]) cube(1);", "10", 5, NULL, 0, 0}, /* sides cross at over 2^-6: left are the opposite faces of each, top and bottom being shared */
  /* spheres */
  {"sphere(5); translate([0.003,0.004,0]) sphere(5.001);", "0.01", 1, "0.006", 0.006, 0},
  {"sphere(5); translate([0.003,0.004,0]) sphere(5.001);", "0.0059", 0, "", 0, 0},
  {"sphere(sqrt(2)); sphere(1.41421356);", "1e-8", 1, "", 2.3730950488e-9, 0},
  {"sphere(5); translate([1e-9,0,0]) quadric([-1,-1,-1,0,0,0,0,0,0,25]);", "1e-8", 1, "1e-09", 1e-9, 1},
  {"scale([1,2,3]) sphere(1); translate([0,1e-9,0]) ellipsoid([1,2,3]);", "1e-8", 1, "1e-09", 1e-9, 0},
  {"sphere(1); ellipsoid([1,1,1.0000001]);", "1e-6", 0, "", 0, 0}, /* not looked for: their quadratic parts differ */
  /* an ellipsoid drawn by 1 + 1e-7 from its centre: times the distance of its box's corner, sqrt(1 + 4 + 4) = 3; the smaller moves, by 1 - 1/(1+1e-7) */
  {"ellipsoid([1,2,2]); scale(1.0000001) ellipsoid([1,2,2]);", "1e-6", 1, NULL, 3e-7, 0},
  /* cylinders: distance of the axes and difference of the radii, wherever along the axis */
  {"cylinder(h=3,r=2); translate([3e-6,4e-6,1]) cylinder(h=1,r=2.000001);", "1e-5", 1, "0.000006", 6e-6, 0},
  {"rotate([30,40,50]) { cylinder(h=3,r=2); translate([3e-6,4e-6,1]) cylinder(h=1,r=2.000001); }", "1e-5", 1, NULL, 6e-6, 0},
  {"cylinder(h=1,r=2); translate([4+1e-9,0,0]) cylinder(h=3,r=2);", "1e-6", 0, "", 0, 0}, /* nearly tangent is not near */
  /* others: moved without turning */
  {"cylinder(h=4,r1=2,r2=0); translate([0,0,1e-6]) cylinder(h=2,r1=2,r2=1);", "1e-6", 2, "0.000001", 1e-6, 0},
  {"paraboloid(h=2,r=3); translate([2e-6,3e-6,6e-6]) paraboloid(h=2,r=3);", "1e-5", 2, NULL, 6e-6, 0},
  {"hyperboloid(h=3,r=5,rc=4); translate([0,1e-9,0]) hyperboloid(h=2,r=sqrt(20),rc=4);", "1e-8", 1, NULL, 1e-9, 0},
  {"superquadric([1,2,3],0.5,0.5); translate([1e-9,0,0]) superquadric([1,2,3],0.5,0.5);", "1e-6", 0, "", 0, 0},
};

static void gaps_by_hand(void **unused) {
  (void)unused;
  for (size_t i = 0; i < sizeof gaps / sizeof *gaps; i++) {
    quoin_scene *s = scene_of(gaps[i].text);
    quoin_near_list *list;
    quoin_near near;
    assert_int_equal(quoin_near_find(s, gaps[i].limit, &list), QUOIN_OK);
    if (quoin_near_count(list) != gaps[i].pairs) {
      fail_msg("%s: %zu pairs", gaps[i].text, quoin_near_count(list));
    }
    if (gaps[i].pairs && gaps[i].gap > 0) {
      assert_int_equal(quoin_near_get(list, 0, &near), QUOIN_OK);
      if (fabs(near.gap - gaps[i].gap) > 1e-9 * gaps[i].gap || (gaps[i].exact && strcmp(near.exact, gaps[i].exact)) || near.opposite != gaps[i].opposite) {
        fail_msg("%s: %.17g '%s' %d", gaps[i].text, near.gap, near.exact, near.opposite);
      }
    }
    assert_int_equal(quoin_near_get(list, quoin_near_count(list), &near), QUOIN_E_ARGUMENT);
    quoin_near_free(list);
    quoin_scene_free(s);
  }
}

/* --- where surfaces go ----------------------------------------------------------------------------------------------- */

typedef struct count_row { const char *text, *snap; size_t leaves, distinct, moved; } count_row;

static const count_row counts[] = {
  {"cube(1); translate([1+8.8e-11,0,0]) cube(1);", "1e-12", 2, 8, 0},
  {"cube(1); translate([1+8.8e-11,0,0]) cube(1);", "1e-10", 2, 7, 1}, /* the face of the other is not within 1e-10 of x = 2 */
  {"sphere(2); sphere(2.0000000001); translate([1e-20,0,0]) sphere(2);", "1e-9", 3, 1, 2},
  {"sphere(2); sphere(2.0000000001); translate([1e-20,0,0]) sphere(2);", "1e-15", 3, 2, 1},
  /* a chain of planes 0.6 apart: x = 0, 0.6, 1.2, 1.8, 2.4 of slabs of one size; 0.6 goes to 0, 1.2 stands, 1.8 goes to 1.2, 2.4 stands; far ends are 100 away */
  {"cube([100,9,9]); translate([0.6,0,0]) cube([100,9,9]); translate([1.2,0,0]) cube([100,9,9]); translate([1.8,0,0]) cube([100,9,9]); "
   "translate([2.4,0,0]) cube([100,9,9]);", "1", 5, 4 + 6, 4},
  {"cube(10); translate([20,0,0]) cube([5,5,0.001]); translate([40,0,0]) cube([5,5,0.01]);", "0.001", 2, 10, 1}, /* y = 0, y = 5 and z = 0 are shared; a film is gone: its top went to its bottom */
  {"intersection() { cube([1,1,1]); translate([1.0000001,0,0]) cube([1,1,1]); } sphere(3);", "1e-6", 3, 8, 1}, /* they touch, once snapped */
  {"halfspace([1,0,0],1); halfspace([-1,0,0],-1.0000001);", "1e-6", 2, 1, 1},
  /* cylinders written as quadrics, one beside a cylinder of radius 1; two planes that cross, as one quadric */
  {"quadric([1,2,0,0,0,0,0,0,0,-1]); translate([1e-9,0,5]) quadric([1,2,0,0,0,0,0,0,0,-1]);", "1e-9", 2, 1, 1},
  {"quadric([0,1,-2,0,0,0,0,0,0,-1]); translate([7,1e-9,0]) quadric([0,1,-2,0,0,0,0,0,0,-1]);", "9e-10", 2, 2, 0},
  {"cylinder(r=1,h=3,center=true); translate([0,0,9]) quadric([1,1,0,0,0,0,0,0,0,-1.000000010000000025]);", "5e-9", 2, 3, 1},
  {"quadric([1,-1,0,0,0,0,0,0,0,0]); translate([0,1e-9,0]) quadric([1,-1,0,0,0,0,0,0,0,0]);", "1e-9", 2, 1, 1},
  {"difference() { cube(10); translate([2,2,-1e-7]) cylinder(h=10.0000002,r=1); }", "1e-6", 2, 7, 2},
  {"rotate([10,20,30]) cube(1); rotate([10,20,30.0000001]) translate([1,0,0]) cube(1);", "1e-8", 2, 7, 5},
  {"rotate([10,20,30]) cube(1); rotate([10,20,30.0000001]) translate([1,0,0]) cube(1);", "1e-10", 2, 12, 0}, /* 1e-7 degrees are 1.7e-9 */
};

static void where_surfaces_go(void **unused) {
  (void)unused;
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
    const count_row *r = &counts[i];
    quoin_scene *s = snapped(r->text, r->snap, 0);
    if (s->leaf_count != r->leaves || s->surface_count != r->distinct || quoin_near_count(quoin_scene_snapped(s)) != r->moved) {
      fail_msg("%s: %zu leaves, %zu distinct, %zu moved", r->text, s->leaf_count, s->surface_count, quoin_near_count(quoin_scene_snapped(s)));
    }
    quoin_near_list *left;
    assert_int_equal(quoin_near_find(s, r->snap, &left), QUOIN_OK);
    assert_int_equal(quoin_near_count(left), 0);
    quoin_near_free(left);
    quoin_scene_free(s);
  }
}

/* x = 0 and x = 1.5 stand, x = 0.9 goes to the nearer one: names, roles and places are said. */
static void to_the_nearest(void **unused) {
  (void)unused;
  quoin_scene *s = snapped("cube([50,9,9]);\ntranslate([1.5,0,0]) cube([60,9,9]);\n  name(\"it\") translate([0.9,0,0]) cube([40,9,9]);", "1", 1);
  const quoin_near_list *list = quoin_scene_snapped(s);
  quoin_near near;
  assert_int_equal(quoin_near_count(list), 1);
  assert_true(quoin_near_limit(list) == 1 && quoin_near_complete(list));
  assert_int_equal(quoin_near_get(list, 0, &near), QUOIN_OK);
  assert_string_equal(near.exact, "0.6");
  assert_true(near.gap == 0.6 && !near.opposite);
  assert_string_equal(near.face[0].name, "it");
  assert_string_equal(near.face[1].name, "cube@2:22");
  assert_true(near.face[0].role == QUOIN_FACE && near.face[1].role == QUOIN_FACE);
  assert_true(near.face[0].line == 3 && near.face[0].column == 35 && near.face[1].line == 2 && near.face[1].column == 22);
  assert_string_equal(near.face[0].file, "t");
  quoin_scene_free(s);
}

/* A frustum that widens to its cap, which moved onto z = 25: with x = X + 0.012 Z, z = 22 - 0.012 X + Z, its rim at the angle a is at
   Z = (3 + 0.012 cos a) / (1 - 0.012 cos a), radius 1 + Z. */
static void box_of_a_tilted_cap(void **unused) {
  (void)unused;
  quoin_scene *s = snapped("cube(50,center=true); multmatrix([[1,0,0.012,0],[0,1,0,0],[-0.012,0,1,22]]) cylinder(h=3,r1=1,r2=4);", "0.2", 1);
  assert_int_equal(quoin_near_count(quoin_scene_snapped(s)), 1);
  const qn_leaf *leaf = &s->leaves[1];
  double most[2] = {0, 0}, least = 0;
  for (int i = 0; i < 1000; i++) {
    double c = cos(i * 0.00628), n = sin(i * 0.00628), z = (3 + 0.012 * c) / (1 - 0.012 * c);
    most[0] = fmax(most[0], (1 + z) * c + 0.012 * z);
    most[1] = fmax(most[1], (1 + z) * n);
    least = fmin(least, (1 + z) * c + 0.012 * z);
  }
  assert_true(leaf->max[0] >= most[0] && leaf->max[0] < most[0] + 0.1 && leaf->max[1] >= most[1] && leaf->min[0] <= least);
  assert_true(leaf->max[2] == 25);
  quoin_scene_free(s);
}

/* Places so far out that their cells cannot be counted: the search once went through 2^63 of them. */
static void far_out(void **unused) {
  (void)unused;
  quoin_scene *s = snapped("translate([1e300,0,0]) wedge([2,0.1,1/3]); rotate([0,0,1e-4]) translate([1e300,0,0]) wedge([2,0.1,1/3]); halfspace([0.3,1e300,1],sqrt(2)); "
                           "ellipsoid([1e300,1/3,3]); translate([-1e300,1e-300,0]) ellipsoid([1e300,1/3,3]); cylinder(h=3,r1=1e-300,r2=7); cube(1e-3);",
                           "1", 1);
  quoin_near_list *list;
  assert_int_equal(quoin_near_find(s, NULL, &list), QUOIN_OK);
  quoin_near_free(list);
  quoin_scene_free(s);
}

static void bad_limits(void **unused) {
  (void)unused;
  const struct { const char *limit; quoin_status status; } rows[] = {
    {"", QUOIN_E_NUMBER}, {"x", QUOIN_E_NUMBER}, {"1e-3x", QUOIN_E_NUMBER}, {"-1", QUOIN_E_ARGUMENT}, {"nan", QUOIN_E_NUMBER}, {"0", QUOIN_OK}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    quoin_model *m;
    quoin_scene *s = NULL;
    quoin_near_list *list = NULL;
    quoin_compile_options options = quoin_compile_options_default();
    options.snap = rows[i].limit;
    assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
    assert_int_equal(quoin_add_sphere(m, QUOIN_ROOT, 1, NULL), QUOIN_OK);
    assert_int_equal(quoin_scene_compile(m, &options, &s), rows[i].status);
    quoin_scene_free(s);
    assert_int_equal(quoin_scene_compile(m, NULL, &s), QUOIN_OK);
    assert_null(quoin_scene_snapped(s));
    assert_int_equal(quoin_near_find(s, rows[i].limit, &list), rows[i].status);
    quoin_near_free(list);
    quoin_scene_free(s);
    quoin_model_free(m);
  }
}

/* --- refusals -------------------------------------------------------------------------------------------------------- */

typedef struct meter { size_t left, blocks; } meter; /* allocations still granted */

static void *grant(void *user, size_t size) {
  meter *m = user;
  if (m->left == 0) {
    return NULL;
  }
  m->left--;
  m->blocks++;
  return malloc(size);
}
static void *regrant(void *user, void *block, size_t old_size, size_t size) {
  (void)old_size;
  meter *m = user;
  if (m->left == 0) {
    return NULL;
  }
  m->left--;
  return realloc(block, size);
}
static void give_back(void *user, void *block, size_t size) {
  (void)size;
  ((meter *)user)->blocks--;
  free(block);
}

static const char *const SEVERAL = "cube(3); translate([3.0000001,0,0]) cube(2); sphere(1); translate([0,0,1e-7]) sphere(1); rotate([0,0,1e-6]) cylinder(h=3.0000001,r=1); cube([2,2,1e-8]);";

static void memory_refused(void **unused) {
  (void)unused;
  size_t refusals = 0;
  for (size_t n = 0, done = 0; !done; n++) {
    meter all = {SIZE_MAX, 0};
    quoin_allocator a = {.alloc = grant, .resize = regrant, .release = give_back, .user = &all};
    quoin_model *m;
    quoin_scene *s = NULL;
    quoin_near_list *list = NULL;
    quoin_compile_options options = quoin_compile_options_default();
    options.snap = "1e-6";
    options.threads = 1;
    assert_int_equal(quoin_model_new(&a, &m), QUOIN_OK);
    assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "t", SEVERAL, strlen(SEVERAL), NULL), QUOIN_OK);
    all.left = n;
    quoin_status status = quoin_scene_compile(m, &options, &s);
    if (status == QUOIN_OK) {
      assert_int_equal(quoin_near_count(quoin_scene_snapped(s)), 4); /* a side, a sphere, a cap, a film */
      status = quoin_near_find(s, "0.1", &list);
      done = status == QUOIN_OK;
    } else {
      assert_null(s);
    }
    assert_true(done || status == QUOIN_E_MEMORY);
    refusals += !done;
    quoin_near_free(list);
    quoin_scene_free(s);
    quoin_model_free(m);
    assert_int_equal(all.blocks, 0);
  }
  assert_true(refusals > 100);
}

typedef struct stop { int calls, at; double last; } stop;
static int count_calls(void *user, double done) {
  stop *s = user;
  assert_true(done >= s->last && done <= 1);
  s->last = done;
  return s->calls++ == s->at;
}

static void stopped(void **unused) {
  (void)unused;
  quoin_status status = QUOIN_E_CANCELLED;
  for (int at = 0; status != QUOIN_OK; at++) {
    quoin_model *m;
    quoin_scene *s = NULL;
    stop when = {0, at, 0};
    quoin_compile_options options = quoin_compile_options_default();
    options.snap = "1e-6";
    options.progress = (quoin_progress){count_calls, &when};
    assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
    assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "t", SEVERAL, strlen(SEVERAL), NULL), QUOIN_OK);
    status = quoin_scene_compile(m, &options, &s);
    assert_true(status == QUOIN_OK || status == QUOIN_E_CANCELLED);
    assert_true(status == QUOIN_E_CANCELLED || (at > 3 && when.last == 1));
    quoin_scene_free(s);
    quoin_model_free(m);
  }
}

/* --- the property, on boxes, judged in rationals --------------------------------------------------------------------- */

static uint64_t state;
static uint64_t next(void) {
  state ^= state << 13, state ^= state >> 7, state ^= state << 17;
  return state;
}
static int below(int n) {
  return (int)(next() % (uint64_t)n);
}

/* A coordinate: one of a few places, and a small way off it. */
static void put_place(char *text, int low, int kind) {
  int place = low + below(3), off = below(5) - 2;
  switch (kind) {
  case 0: sprintf(text, "%d%+d/2^%d", place, off, 20 + below(41)); break;
  case 1: sprintf(text, "%.9g", (double)((float)place + (float)off * 1e-6F)); break; /* a single, as decimals */
  case 2: sprintf(text, "%d%+de-%d", place, off, 3 + below(6)); break;
  default: sprintf(text, "%d%+d.%d/10000", place, off, below(10)); break;
  }
}

enum { BOXES = 24 };

/* places[6 i + face] of the boxes' faces. */
static void places_of(const quoin_scene *s, mpq_t places[6 * BOXES], int there[BOXES]) {
  uint32_t first = UINT32_MAX;
  memset(there, 0, BOXES * sizeof *there);
  for (uint32_t n = 0; n < s->model->node_count && first == UINT32_MAX; n++) {
    first = s->model->nodes[n].kind == QN_NODE_LEAF ? n : UINT32_MAX;
  }
  for (uint32_t i = 0; i < s->leaf_count; i++) {
    uint32_t box = (s->leaves[i].node - first) / 2; /* each is a translation and a cube */
    assert_true(box < BOXES);
    there[box] = 1;
    for (uint32_t h = 0; h < 6; h++) {
      const qn_half *half = &s->halves[s->leaves[i].half0 + h];
      const qn_exact_surface *e = qn_scene_exact(s, half->surface, NULL);
      uint32_t axis = (half->role - QUOIN_FACE) / 2;
      mpz_t n, d;
      assert_non_null(e);
      assert_int_equal(half->side, half->role % 2 == QUOIN_FACE % 2 ? -1 : 1);
      mpz_set(mpq_numref(places[6 * box + h]), mpz_roinit_n(n, e->q[9].d, -e->q[9].n));
      mpz_set(mpq_denref(places[6 * box + h]), mpz_roinit_n(d, e->q[6 + axis].d, e->q[6 + axis].n));
      mpq_canonicalize(places[6 * box + h]);
    }
  }
}

static int further(const mpq_t a, const mpq_t b, const mpq_t limit) {
  mpq_t d;
  mpq_init(d);
  mpq_sub(d, a, b);
  mpq_abs(d, d);
  int is = mpq_cmp(d, limit) > 0;
  mpq_clear(d);
  return is;
}

static void property_of_boxes(void **unused) {
  (void)unused;
  static const struct { const char *text; unsigned long num, den; } limits[] = {{"0.001", 1, 1000}, {"1e-6", 1, 1000000}, {"0.00001", 1, 100000}, {"0", 0, 1}};
  mpq_t was[6 * BOXES], now[6 * BOXES], limit;
  size_t moved = 0, gone = 0, kept = 0;
  state = 0x123456789abcdefu;
  mpq_init(limit);
  for (int i = 0; i < 6 * BOXES; i++) {
    mpq_init(was[i]);
    mpq_init(now[i]);
  }
  for (int round = 0; round < share_of(400); round++) {
    static char text[BOXES * 300];
    char *at = text;
    for (int i = 0; i < BOXES; i++) {
      char a[3][40], b[3][40];
      int kind = round % 5 == 4 ? below(4) : round % 5;
      for (int k = 0; k < 3; k++) {
        put_place(a[k], 0, kind);
        put_place(b[k], below(30) ? 3 : 0, kind); /* sometimes the far face is near the other, or before it: then it is nothing */
      }
      at += sprintf(at, "translate([%s,%s,%s]) cube([%s-(%s),%s-(%s),%s-(%s)]);\n", a[0], a[1], a[2], b[0], a[0], b[1], a[1], b[2], a[2]);
    }
    size_t which = (size_t)below(4);
    mpq_set_ui(limit, limits[which].num, limits[which].den);
    quoin_scene *plain = scene_of(text), *snap = snapped(text, limits[which].text, 1 + round % 3);
    int before[BOXES], after[BOXES];
    places_of(plain, was, before);
    places_of(snap, now, after);
    for (int i = 0; i < 6 * BOXES; i++) {
      int axis = i % 6 / 2, from_file = 0, alone = 1;
      if (!before[i / 6]) {
        assert_false(after[i / 6]);
        continue;
      }
      if (!after[i / 6]) { /* gone: then some axis' faces are within twice the limit */
        int thin = 0;
        mpq_t twice;
        mpq_init(twice);
        mpq_add(twice, limit, limit);
        for (int k = 0; k < 3; k++) {
          thin |= !further(was[6 * (i / 6) + 2 * k], was[6 * (i / 6) + 2 * k + 1], twice);
        }
        mpq_clear(twice);
        assert_true(thin);
        gone++;
        continue;
      }
      assert_false(further(was[i], now[i], limit)); /* nothing farther has moved */
      for (int j = 0; j < 6 * BOXES; j++) {
        if (j % 6 / 2 != axis || !before[j / 6]) {
          continue;
        }
        from_file |= mpq_equal(now[i], was[j]) != 0;
        alone &= mpq_equal(was[i], was[j]) || further(was[i], was[j], limit);
        if (after[j / 6]) { /* no pair is left */
          assert_true(mpq_equal(now[i], now[j]) || further(now[i], now[j], limit));
        }
        assert_true(!mpq_equal(was[i], was[j]) || !after[j / 6] || mpq_equal(now[i], now[j])); /* what was one is one */
      }
      assert_true(from_file);
      assert_true(!alone || mpq_equal(was[i], now[i]));
      moved += !mpq_equal(was[i], now[i]);
      kept += mpq_equal(was[i], now[i]) != 0;
    }
    quoin_scene_free(plain);
    quoin_scene_free(snap);
  }
  for (int i = 0; i < 6 * BOXES; i++) {
    mpq_clear(was[i]);
    mpq_clear(now[i]);
  }
  mpq_clear(limit);
  assert_true(moved > share_min(1000) && kept > share_min(1000) && gone > share_min(20));
}

/* --- the property, on round solids ----------------------------------------------------------------------------------- */

/* Centre and radius of a sphere, or of a cylinder along z (its centre's z is 0). */
static void round_of(const quoin_scene *s, uint32_t leaf, int axes, long double c[3], long double *r) {
  const qn_exact_surface *e = qn_scene_exact(s, s->halves[s->leaves[leaf].half0].surface, NULL);
  mpq_t q, sum, x;
  mpz_t a, b;
  mpq_inits(q, sum, x, NULL);
  assert_non_null(e);
  for (int k = 0; k < 4; k++) { /* -G/2A, and r^2 = sum c^2 - J/A */
    int from = k < 3 ? 6 + k : 9;
    mpz_set(mpq_numref(q), mpz_roinit_n(a, e->q[from].d, -e->q[from].n));
    mpz_set(mpq_denref(q), mpz_roinit_n(b, e->q[0].d, e->q[0].n));
    mpq_canonicalize(q);
    if (k < 3) {
      mpq_div_2exp(q, q, 1);
      mpf_t f;
      mpf_init2(f, 256);
      mpf_set_q(f, q);
      double high = mpf_get_d(f);
      mpf_t g;
      mpf_init2(g, 256);
      mpf_set_d(g, high);
      mpf_sub(f, f, g);
      c[k] = k < axes ? (long double)high + (long double)mpf_get_d(f) : 0;
      mpf_clears(f, g, NULL);
      mpq_mul(x, q, q);
      mpq_add(sum, sum, x);
    } else {
      mpq_add(sum, sum, q);
    }
  }
  mpf_t f, g;
  mpf_init2(f, 256);
  mpf_init2(g, 256);
  mpf_set_q(f, sum);
  mpf_sqrt(f, f);
  mpf_set_d(g, mpf_get_d(f));
  *r = (long double)mpf_get_d(f);
  mpf_sub(f, f, g);
  *r += (long double)mpf_get_d(f);
  mpf_clears(f, g, NULL);
  mpq_clears(q, sum, x, NULL);
}

static long double gap_of(const long double a[4], const long double b[4]) {
  long double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return sqrtl(x * x + y * y + z * z) + fabsl(a[3] - b[3]);
}

static void property_of_round_solids(void **unused) {
  (void)unused;
  enum { N = 40 };
  size_t moved = 0, kept = 0;
  state = 0xfedcba987654321u;
  for (int round = 0; round < share_of(100); round++) {
    static char text[N * 200];
    char *at = text;
    int axes = round % 2 ? 2 : 3;
    for (int i = 0; i < N; i++) {
      char a[3][40], r[40];
      for (int k = 0; k < 3; k++) {
        put_place(a[k], 0, round % 4);
      }
      put_place(r, 1, round % 4);
      at += axes == 3 ? sprintf(at, "translate([%s,%s,%s]) sphere(%s);\n", a[0], a[1], a[2], r)
                      : sprintf(at, "translate([%s,%s,%d]) cylinder(h=%d,r=%s);\n", a[0], a[1], 10 * i, 1 + i % 3, r);
    }
    const char *limits[] = {"0.002", "1e-6", "0.00001"};
    const long double limit = strtold(limits[round % 3], NULL);
    quoin_scene *plain = scene_of(text), *snap = snapped(text, limits[round % 3], 2);
    long double was[N][4], now[N][4];
    assert_int_equal(plain->leaf_count, N);
    assert_int_equal(snap->leaf_count, N);
    for (uint32_t i = 0; i < N; i++) {
      round_of(plain, i, axes, was[i], &was[i][3]);
      round_of(snap, i, axes, now[i], &now[i][3]);
    }
    for (uint32_t i = 0; i < N; i++) {
      assert_true(gap_of(was[i], now[i]) <= limit * (1 + 0x1p-40L));
      int from_file = 0, alone = 1;
      for (uint32_t j = 0; j < N; j++) {
        from_file |= gap_of(now[i], was[j]) == 0;
        alone &= i == j || gap_of(was[i], was[j]) == 0 || gap_of(was[i], was[j]) > limit;
        assert_true(gap_of(now[i], now[j]) == 0 || gap_of(now[i], now[j]) > limit * (1 - 0x1p-40L));
        assert_int_equal(gap_of(now[i], now[j]) == 0, snap->halves[snap->leaves[i].half0].surface == snap->halves[snap->leaves[j].half0].surface);
      }
      assert_true(from_file && (!alone || gap_of(was[i], now[i]) == 0));
      moved += gap_of(was[i], now[i]) > 0;
      kept += gap_of(was[i], now[i]) == 0;
    }
    quoin_scene_free(plain);
    quoin_scene_free(snap);
  }
  assert_true(moved > share_min(500) && kept > share_min(500));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(gaps_by_hand), cmocka_unit_test(where_surfaces_go), cmocka_unit_test(to_the_nearest), cmocka_unit_test(far_out), cmocka_unit_test(box_of_a_tilted_cap), cmocka_unit_test(bad_limits),
                                     cmocka_unit_test(memory_refused), cmocka_unit_test(stopped),
                                     cmocka_unit_test(property_of_boxes), cmocka_unit_test(property_of_round_solids)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
