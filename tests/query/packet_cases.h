/* Models and bundles of rays on which packets are likely to go wrong: families, each with a name, drawn at random on coarse grids so that
   faces, edges, tangencies and apexes are met exactly, under maps that take them far away, make them tiny, thin or huge. */
#ifndef QN_TESTS_PACKET_CASES_H
#define QN_TESTS_PACKET_CASES_H

#include "random_solid.h"
#include "wide/packet.h"

#include <math.h>

/* A map of coordinates, written as model text and applied to rays: x' = scale x turned, then moved. */
typedef struct frame {
  char text[400];
  double scale[3], move[3];
  int turn; /* 0: none; k: 90 degrees about axis k - 1; 4: by (3/5, 4/5) about z; 5: rotate(30), whose ends are irrational */
} frame;

enum { FRAMES = 9 };
static const char *const FRAME_NAMES[FRAMES] = {"as is", "moved", "far 1e6", "far 1e12", "tiny", "huge", "thin", "turned", "moved and thin"};

static inline void make_frame(dice *d, int kind, frame *f) {
  static const double small[] = {1e-3, 1e-6, 1e-9, 1e-20}, large[] = {1e3, 1e6, 1e9, 1e20};
  *f = (frame){.scale = {1, 1, 1}};
  switch (kind) {
  case 1: case 8:
    for (int i = 0; i < 3; i++) {
      f->move[i] = 0.1 * (roll(d, 81) - 40);
    }
    break;
  case 2: case 3: {
    const double far = kind == 2 ? 1e6 : pow(10, 8 + roll(d, 5));
    for (int i = 0; i < 3; i++) {
      f->move[i] = roll(d, 2) ? far * (roll(d, 3) - 1) : 0;
    }
    break;
  }
  case 4: case 5: {
    double s = (kind == 4 ? small : large)[roll(d, 4)];
    f->scale[0] = f->scale[1] = f->scale[2] = s;
    break;
  }
  case 7: f->turn = 1 + roll(d, 5); break;
  default: break;
  }
  if (kind == 6 || kind == 8) {
    f->scale[roll(d, 3)] = pow(10, -2 - roll(d, 5));
  }
  char turn[200] = "";
  if (f->turn >= 1 && f->turn <= 3) {
    snprintf(turn, sizeof turn, "rotate([%d,%d,%d])", f->turn == 1 ? 90 : 0, f->turn == 2 ? 90 : 0, f->turn == 3 ? 90 : 0);
  } else if (f->turn == 4) {
    snprintf(turn, sizeof turn, "multmatrix([[0.6,-0.8,0,0],[0.8,0.6,0,0],[0,0,1,0],[0,0,0,1]])");
  } else if (f->turn == 5) {
    snprintf(turn, sizeof turn, "rotate(30)");
  }
  snprintf(f->text, sizeof f->text, "translate([%.17g,%.17g,%.17g]) %s scale([%.17g,%.17g,%.17g])", f->move[0], f->move[1], f->move[2], turn, f->scale[0],
           f->scale[1], f->scale[2]);
}
static inline void frame_apply(const frame *f, const double x[3], int point, double out[3]) {
  double v[3], c = 0, s = 1;
  for (int i = 0; i < 3; i++) {
    v[i] = f->scale[i] * x[i];
  }
  if (f->turn >= 1 && f->turn <= 3) {
    int i = f->turn - 1, a = (i + 1) % 3, b = (i + 2) % 3;
    double t = v[a];
    v[a] = -v[b], v[b] = t;
  } else if (f->turn >= 4) {
    c = f->turn == 4 ? 0.6 : sqrt(0.75), s = f->turn == 4 ? 0.8 : 0.5;
    double t = c * v[0] - s * v[1];
    v[1] = s * v[0] + c * v[1], v[0] = t;
  }
  for (int i = 0; i < 3; i++) {
    out[i] = v[i] + (point ? f->move[i] : 0);
  }
}

/* --- models, about the cube [-4, 4]^3 ------------------------------------------------------------------------------- */

enum { MODELS = 20, SUPERQUADRICS = 18 };
static const char *const MODEL_NAMES[MODELS] = {
  "spheres",    "boxes",      "cylinders",  "cones",       "paraboloids", "hyperboloids", "saddles",    "any",      "stacked", "tangent",
  "flush cuts", "half-spaces", "complement", "union meets", "alternating", "lattice",      "polyhedra",  "quadrics", "superquadrics", "one face"};

typedef struct writer { char *text; size_t size, at; } writer;
static inline void put(writer *w, const char *format, ...) {
  va_list list;
  va_start(list, format);
  int n = vsnprintf(w->text + w->at, w->size - w->at, format, list);
  va_end(list);
  assert_true(n >= 0 && w->at + (size_t)n < w->size);
  w->at += (size_t)n;
}

static inline void put_place(dice *d, writer *w) {
  static const char *const turns[] = {"", "", "", "rotate([90,0,0])", "rotate([0,90,0])", "rotate([180,0,0])", "rotate([45,0,0])", "rotate([0,30,0])"};
  put(w, "translate([%d,%d,%d]) %s ", roll(d, 5) - 2, roll(d, 5) - 2, roll(d, 5) - 2, turns[roll(d, 8)]);
}

/* One leaf of a kind: 0 sphere, 1 box, 2 cylinder, 3 cone, 4 paraboloid, 5 one sheet, 6 two sheets, 7 saddle in a cube, 8 wedge, 9 ellipsoid,
   10 elliptic cylinder, 11 prism, 12 quadric in a sphere, 13 superquadric, 14 half-space. */
static inline void put_kind(dice *d, writer *w, int kind) {
  int a = 1 + roll(d, 2), b = 1 + roll(d, 3), c = 1 + roll(d, 3);
  switch (kind) {
  case 0: put(w, "sphere(%d);", a); break;
  case 1: put(w, "cube([%d,%d,%d], center=%s);", a, b, c, roll(d, 2) ? "true" : "false"); break;
  case 2: put(w, "cylinder(r=%d,h=%d);", a, b); break;
  case 3: roll(d, 2) ? put(w, "cylinder(r1=%d,r2=0,h=%d);", a, b) : put(w, "cylinder(r1=%d,r2=%d,h=%d);", a, 3 - a, b); break;
  case 4: put(w, "paraboloid(r=%d,h=%d);", a, b); break;
  case 5: roll(d, 2) ? put(w, "hyperboloid(h=%d,r=5,rc=3);", b) : put(w, "hyperboloid(h=%d,r=%d,rc=%d);", b, a + 1, a); break;
  case 6: put(w, "hyperboloid(h=%d,r=%d,gap=%d);", b + 1, a, roll(d, 2) ? 1 : b); break;
  case 7: put(w, "intersection() { saddle(a=%d,b=%d); cube(%d, center=true); }", a, b, 2 + c); break;
  case 8: put(w, "wedge([%d,%d,%d]);", a, b, c); break;
  case 9: put(w, "ellipsoid(r=[%d,%d,%d]);", a, b, c); break;
  case 10: put(w, "cylinder(r=[%d,%d],h=%d);", a, b, c); break;
  case 11: put(w, "cylinder(r=%d,h=%d,$fn=%d);", a, b, 3 + roll(d, 6)); break;
  case 12: {
    put(w, "intersection() { quadric([%d", roll(d, 5) - 2);
    for (int i = 1; i < 9; i++) {
      put(w, ",%d", roll(d, 5) - 2);
    }
    put(w, ",%d]); sphere(4); }", roll(d, 5) - 2);
    break;
  }
  case 13: put(w, "superquadric(r=[%d,%d,%d],e=%s,n=%s);", a, b, c, roll(d, 2) ? "0.5" : "1", roll(d, 2) ? "0.5" : "1.5"); break;
  default: {
    int n[3] = {roll(d, 5) - 2, roll(d, 5) - 2, roll(d, 3) - 1};
    n[2] = n[0] || n[1] || n[2] ? n[2] : 1;
    put(w, "halfspace(n=[%d,%d,%d],d=%d);", n[0], n[1], n[2], roll(d, 5) - 2);
    break;
  }
  }
}
static inline void put_leaf(dice *d, writer *w, const int *kinds, int count) {
  put_place(d, w);
  put_kind(d, w, kinds[roll(d, count)]);
  put(w, "\n");
}

static inline void put_tree(dice *d, writer *w, const int *kinds, int count, int leaves) {
  static const char *const words[] = {"union", "difference", "union", "intersection", "difference"};
  if (leaves <= 1) {
    put_leaf(d, w, kinds, count);
    return;
  }
  int left = 1 + roll(d, leaves - 1);
  put(w, "%s() {\n", words[roll(d, 5)]);
  put_tree(d, w, kinds, count, left);
  put_tree(d, w, kinds, count, leaves - left);
  put(w, "}\n");
}

static inline void write_model(dice *d, int family, const frame *f, char *text, size_t size) {
  static const int all[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  static const int spheres[] = {0, 0, 0, 9}, boxes[] = {1, 1, 8}, cylinders[] = {2, 2, 10}, cones[] = {3}, paraboloids[] = {4}, hyperboloids[] = {5, 6}, saddles[] = {7},
                   polyhedra[] = {8, 11, 1}, quadrics[] = {12}, supers[] = {13, 0, 1};
  writer w = {text, size, 0};
  put(&w, "%s {\n", f->text);
  int n = 1 + roll(d, 6);
  switch (family) {
  case 0: put_tree(d, &w, spheres, 4, n); break;
  case 1: put_tree(d, &w, boxes, 3, n); break;
  case 2: put_tree(d, &w, cylinders, 3, n); break;
  case 3: put_tree(d, &w, cones, 1, n); break;
  case 4: put_tree(d, &w, paraboloids, 1, n); break;
  case 5: put_tree(d, &w, hyperboloids, 2, n); break;
  case 6: put_tree(d, &w, saddles, 1, n); break;
  case 7: put_tree(d, &w, all, 13, 2 + roll(d, 9)); break;
  case 8: /* cylinders one on another about one axis: radii and heights coincide */
    put(&w, "%s() {\n", roll(d, 3) ? "union" : "difference");
    for (int i = 0; i < n + 1; i++) {
      put(&w, "translate([0,0,%d]) cylinder(h=%d, r1=%d, r2=%d);\n", roll(d, 5) - 2, 1 + roll(d, 3), 1 + roll(d, 2), 1 + roll(d, 2));
    }
    put(&w, "}\n");
    break;
  case 9: /* spheres and cylinders that touch */
    put(&w, "%s() {\n", roll(d, 2) ? "union" : "difference");
    for (int i = 0; i < n + 1; i++) {
      put(&w, "translate([%d,%d,0]) %s;\n", 2 * roll(d, 3) - 2, 2 * roll(d, 3) - 2, roll(d, 2) ? "sphere(1)" : "cylinder(r=1,h=1)");
    }
    put(&w, "}\n");
    break;
  case 10: { /* cuts flush with both faces */
    put(&w, "difference() { cube([4,4,2]);\n");
    for (int i = 0; i < n; i++) {
      put(&w, "translate([%d,%d,0]) %s\n", roll(d, 5), roll(d, 5), roll(d, 2) ? "cylinder(r=1,h=2);" : "cube([1,1,2]);");
    }
    if (roll(d, 2)) {
      put(&w, "translate([0,0,1]) cube([4,2,1]);\n");
    }
    put(&w, "}\n");
    break;
  }
  case 11: { /* unbounded */
    static const int halves[] = {14, 14, 14, 1, 0};
    put_tree(d, &w, halves, 5, 2 + roll(d, 4));
    break;
  }
  case 12:
    put(&w, "difference() { halfspace(n=[0,0,1],d=3); union() {\n");
    put_tree(d, &w, all, 13, n);
    put(&w, "} }\n");
    break;
  case 13:
    put(&w, "intersection() {\n");
    for (int k = 0; k < 2 + roll(d, 2); k++) {
      put(&w, "union() {\n");
      for (int i = 0; i < 2 + roll(d, 3); i++) {
        put_leaf(d, &w, all, roll(d, 2) ? 3 : 13);
      }
      put(&w, "}\n");
    }
    put(&w, "}\n");
    break;
  case 14: { /* a deep tree that adds and takes away in turn */
    int depth = 3 + roll(d, 9);
    for (int i = 0; i < depth; i++) {
      put(&w, "%s() {\n", i % 2 ? "union" : "difference");
      put_leaf(d, &w, all, roll(d, 2) ? 4 : 13);
    }
    put_leaf(d, &w, all, 13);
    for (int i = 0; i < depth; i++) {
      put_leaf(d, &w, all, roll(d, 2) ? 4 : 13);
      put(&w, "}\n");
    }
    break;
  }
  case 15: { /* a lattice taken out of a cube, perhaps from two sides */
    int m = 2 + roll(d, 3), round = roll(d, 2);
    put(&w, "difference() { translate([-3,-3,-3]) cube(6);\n");
    for (int x = 0; x < m; x++) {
      for (int y = 0; y < m; y++) {
        for (int way = 0; way < 1 + round; way++) {
          put(&w, "%s translate([%d,%d,-3]) %s\n", way ? "rotate([90,0,0])" : "", 2 * x - 3, 2 * y - 3, round ? "cylinder(r=0.5,h=6);" : "cube([1,1,6]);");
        }
      }
    }
    put(&w, "}\n");
    break;
  }
  case 16: put_tree(d, &w, polyhedra, 3, n); break;
  case 17: put_tree(d, &w, quadrics, 1, 1 + roll(d, 3)); break;
  case SUPERQUADRICS: put_tree(d, &w, supers, 3, 1 + roll(d, 3)); break;
  default: { /* solids that overlap and have faces in common, less others: all of them, or each less its own */
    static const char *const stands[] = {"cube([%d,%d,%d]);\n", "cylinder(r=%d,h=%d);\n", "cylinder(r1=%d,r2=%d,h=1);\n", "translate([0,0,-1]) cube([%d,%d,%d]);\n"};
    const int count = 2 + roll(d, 4), each = roll(d, 2);
    put(&w, each ? "union() {\n" : "difference() { union() {\n");
    for (int i = 0; i < count; i++) {
      const int way = roll(d, 4);
      put(&w, "%stranslate([%d,%d,0]) ", each ? "difference() { " : "", roll(d, 5) - 3, roll(d, 5) - 3);
      way == 0 || way == 3 ? put(&w, stands[way], 1 + roll(d, 4), 1 + roll(d, 4), 1 + roll(d, 3)) : put(&w, stands[way], 1 + roll(d, 2), 1 + roll(d, 3));
      for (int k = 0; each && k < 1 + roll(d, 2); k++) {
        put_tree(d, &w, all, roll(d, 2) ? 4 : 13, 1 + roll(d, 3));
      }
      put(&w, "%s", each ? "}\n" : "");
    }
    put(&w, "}\n");
    for (int i = 0; !each && i < 1 + roll(d, 4); i++) {
      put_tree(d, &w, all, roll(d, 2) ? 4 : 13, 1 + roll(d, 4));
    }
    put(&w, "%s", each ? "" : "}\n");
    break;
  }
  }
  put(&w, "}\n");
}

/* --- bundles of rays ------------------------------------------------------------------------------------------------- */

enum { BUNDLES = 17 };
static const char *const BUNDLE_NAMES[BUNDLES] = {
  "axis, on the grid", "axis, off it",  "diagonal",     "turned view",    "perspective", "eye within",  "eye on a face", "nearly along an axis", "one way tiny",
  "limits on faces",   "incoherent",    "from far off", "d tiny or huge", "d subnormal", "grazing",     "one ray",       "starts at nothing"};

static inline double grid(dice *d) { return 0.5 * (roll(d, 17) - 8); }

/* Lane i of an 8 by 8 tile in the order of wide/packet.h. */
static inline void fill_bundle(dice *d, int kind, const frame *f, quoin_ray rays[64]) {
  static const int ways[][3] = {{1, 1, 0}, {1, 1, 1}, {1, 0, 1}, {1, 2, 0}, {3, 4, 0}, {1, 2, 2}, {0, 3, 4}, {2, -1, 1}, {1, -1, 0}, {5, 3, 4}};
  const double inf = HUGE_VAL;
  double o[3] = {0, 0, 0}, dir[3] = {0, 0, 0}, u[3] = {0, 0, 0}, v[3] = {0, 0, 0};
  int k = roll(d, 3), a = (k + 1) % 3, b = (k + 2) % 3, sign = roll(d, 2) ? 1 : -1, converging = 0;
  double step = kind == 0 || kind == 9 ? 0.25 : roll(d, 2) ? 0.25 : 0.0371;
  dir[k] = sign, o[k] = -sign * (double)(4 + roll(d, 4));
  u[a] = step, v[b] = step;
  o[a] = -4 * step + grid(d) / 2, o[b] = -4 * step + grid(d) / 2;
  double from = roll(d, 3) ? 0 : -inf, to = roll(d, 4) ? inf : 6;
  switch (kind) {
  case 1: o[a] += 0.01 * roll(d, 100), o[b] += 0.013 * roll(d, 100); break;
  case 2: case 3: case 14: {
    const int *way = ways[roll(d, 10)];
    for (int i = 0; i < 3; i++) {
      dir[(k + i) % 3] = sign * way[i] * (kind == 3 ? 0.37 + 0.01 * roll(d, 50) : 1);
    }
    for (int i = 0; i < 3; i++) {
      o[i] = grid(d) / (kind == 14 ? 1 : 2) - (kind == 3 ? 5.1 : 5) * dir[i];
    }
    if (kind == 14) { /* a tight bundle about a grazing ray */
      u[a] = v[b] = ldexp(1, -20 - 4 * roll(d, 8));
      o[a] -= 4 * u[a], o[b] -= 4 * v[b];
    }
    break;
  }
  case 4: case 5: case 6: {
    converging = 1;
    for (int i = 0; i < 3; i++) {
      o[i] = kind == 6 ? roll(d, 7) - 3 : grid(d) / 2;
    }
    if (kind == 4) {
      o[k] = -sign * 6;
    }
    double wide = roll(d, 2) ? 0.0625 : 0.5;
    dir[a] = -4 * wide + (roll(d, 2) ? 0.03 * roll(d, 20) : 0), dir[b] = -4 * wide + (roll(d, 2) ? 0.017 * roll(d, 20) : 0);
    u[a] = wide, v[b] = wide;
    break;
  }
  case 7: dir[a] = ldexp(roll(d, 3) - 1, -20 - roll(d, 40)), dir[b] = ldexp(roll(d, 3) - 1, -20 - roll(d, 40)); break;
  case 8: dir[a] = roll(d, 2) ? 1e-17 : ldexp(1, -40 - roll(d, roll(d, 6) ? 50 : 1000)); break;
  case 9: from = 0.5 * roll(d, 12), to = roll(d, 2) ? from + 0.5 * roll(d, 8) : inf; break;
  case 15: u[a] = v[b] = 0, o[a] = grid(d), o[b] = grid(d); break;
  case 16: from = roll(d, 2) ? from : -1e200, to = roll(d, 2) ? -1e160 : roll(d, 2) ? 1e200 : 1e-310, from = from < to ? from : to; break;
  default: break;
  }
  double lift = 1;
  if (kind == 12) {
    lift = ldexp(1 + 0.125 * roll(d, 8), (roll(d, 2) ? 1 : -1) * roll(d, roll(d, 6) ? 90 : 700));
  } else if (kind == 13) {
    lift = ldexp(1, -1074 + 60 + roll(d, 20));
    dir[a] += ldexp(0.7, -62 - roll(d, 16));
  }
  for (unsigned i = 0; i < 64; i++) {
    double x = qn_lane_column(i), y = qn_lane_row(i), p[3], q[3];
    for (int j = 0; j < 3; j++) {
      p[j] = o[j] + (converging ? 0 : x * u[j] + y * v[j]);
      q[j] = dir[j] + (converging ? x * u[j] + y * v[j] : 0);
    }
    if (kind == 10) {
      for (int j = 0; j < 3; j++) {
        p[j] = grid(d), q[j] = roll(d, 2) ? grid(d) : 0.1 * roll(d, 100) - 5;
      }
      q[k] = q[0] == 0 && q[1] == 0 && q[2] == 0 ? 1 : q[k];
    }
    if (kind == 11) {
      const double far = pow(10, 3 + (f->turn + (int)(f->move[0] != 0)) + 4 * (k + 1));
      for (int j = 0; j < 3; j++) {
        p[j] -= far * q[j];
      }
    }
    rays[i] = (quoin_ray){.from = from, .to = to};
    frame_apply(f, p, 1, rays[i].o);
    frame_apply(f, q, 0, rays[i].d);
    for (int j = 0; j < 3; j++) {
      rays[i].d[j] *= lift;
    }
  }
}

/* Whether it may be asked. */
static inline int is_line(const quoin_ray *r) {
  double finite = 0, size = 0;
  for (int i = 0; i < 3; i++) {
    finite += 0 * r->o[i] + 0 * r->d[i];
    size += r->d[i] != 0;
  }
  return finite == 0 && size > 0 && r->from <= r->to;
}

/* The bodies that this machine runs; how many there are. */
static inline size_t find_bodies(const qn_wide *bodies[3]) {
  static const char *const names[3] = {"sse2", "avx2", "avx512"};
  size_t count = 0;
  for (size_t i = 0; i < 3; i++) {
    setenv("QUOIN_ISA", names[i], 1);
    const qn_wide *w = qn_wide_pick();
    if (strcmp(w->name, names[i]) == 0) {
      bodies[count++] = w;
    }
  }
  unsetenv("QUOIN_ISA");
  return count;
}

#endif
