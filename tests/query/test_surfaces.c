/* Point, normal and (u, v) of hits on every primitive, against formulas that stand here and share nothing with the library: the
   gradient of each surface as a textbook has it, and the parameters as docs/rendering.md defines them. Each solid is hit as it stands,
   under a rotation, a stretch and a mirroring, and, when it is round, placed by base and axis.

   Legend: X the hit in the solid's own frame, p = M X + shift in the world's; a normal goes by the inverse transpose of M. */
#include "ask.h"

#include <math.h>
#include <stdbool.h>

static const double PI = 3.14159265358979323846;

typedef struct surface {
  double g[3];  /* along the outward normal, any length */
  double u, v;
  bool turns;   /* u is an angle: 0 and 1 are the same */
} surface;

static double turn(double x, double y) {
  double u = atan2(y, x) / (2 * PI);
  return u < 0 ? u + 1 : u;
}
static double latitude(double x, double y, double z) { return acos(-z / sqrt(x * x + y * y + z * z)) / PI; }
static surface round_at(double gx, double gy, double gz, double u, double v) { return (surface){{gx, gy, gz}, u, v, true}; }
static surface flat_at(double gx, double gy, double gz, double u, double v) { return (surface){{gx, gy, gz}, u, v, false}; }
static surface disc(double gz, const double *X, double a, double b) { /* a cap: the angle, and the share of the radius */
  return round_at(0, 0, gz, turn(X[0] / a, X[1] / b), hypot(X[0] / a, X[1] / b));
}

static surface sphere(uint32_t role, const double *X) {
  (void)role;
  return round_at(X[0], X[1], X[2], turn(X[0], X[1]), latitude(X[0], X[1], X[2]));
}
static surface ellipsoid(uint32_t role, const double *X) { /* semi-axes 5, 3, 2 */
  (void)role;
  return round_at(X[0] / 25, X[1] / 9, X[2] / 4, turn(X[0] / 5, X[1] / 3), latitude(X[0] / 5, X[1] / 3, X[2] / 2));
}
static surface cylinder(uint32_t role, const double *X) { /* h = 2, r = 5 */
  return role == QUOIN_BODY ? round_at(X[0], X[1], 0, turn(X[0], X[1]), X[2] / 2) : disc(role == QUOIN_CAP1 ? 1 : -1, X, 5, 5);
}
static surface elliptic_cylinder(uint32_t role, const double *X) { /* h = 2, r = [5, 3] */
  return role == QUOIN_BODY ? round_at(X[0] / 25, X[1] / 9, 0, turn(X[0] / 5, X[1] / 3), X[2] / 2) : disc(role == QUOIN_CAP1 ? 1 : -1, X, 5, 3);
}
static surface frustum(uint32_t role, const double *X) { /* radius 4 - z/2, h = 2 */
  double r = hypot(X[0], X[1]);
  return role == QUOIN_BODY ? round_at(X[0] / r, X[1] / r, 0.5, turn(X[0], X[1]), X[2] / 2)
                            : disc(role == QUOIN_CAP1 ? 1 : -1, X, role == QUOIN_CAP1 ? 3 : 4, role == QUOIN_CAP1 ? 3 : 4);
}
static surface cone(uint32_t role, const double *X) { /* radius 5 - z/2, h = 10 */
  double r = hypot(X[0], X[1]);
  return role == QUOIN_BODY ? round_at(X[0] / r, X[1] / r, 0.5, turn(X[0], X[1]), X[2] / 10) : disc(-1, X, 5, 5);
}
static surface paraboloid(uint32_t role, const double *X) { /* x2 + y2 = z <= 4 */
  return role == QUOIN_BODY ? round_at(2 * X[0], 2 * X[1], -1, turn(X[0], X[1]), X[2] / 4) : disc(1, X, 2, 2);
}
static surface elliptic_paraboloid(uint32_t role, const double *X) { /* x2 + 4 y2 = z <= 4 */
  return role == QUOIN_BODY ? round_at(2 * X[0], 8 * X[1], -1, turn(X[0] / 2, X[1]), X[2] / 4) : disc(1, X, 2, 1);
}
static surface hyperboloid1(uint32_t role, const double *X) { /* x2 + y2 = 9 + 4 z2, |z| <= 2 */
  return role == QUOIN_BODY ? round_at(X[0], X[1], -4 * X[2], turn(X[0], X[1]), (X[2] + 2) / 4) : disc(role == QUOIN_CAP1 ? 1 : -1, X, 5, 5);
}
static surface hyperboloid2(uint32_t role, const double *X) { /* x2 + y2 = z2 - 9, |z| <= 5 */
  return role == QUOIN_BODY ? round_at(X[0], X[1], -X[2], turn(X[0], X[1]), (X[2] + 5) / 10) : disc(role == QUOIN_CAP1 ? 1 : -1, X, 4, 4);
}
static surface saddle(uint32_t role, const double *X) { /* z = x2/4 - y2 */
  (void)role;
  return flat_at(-X[0] / 2, 2 * X[1], 1, X[0] / 2, X[1]);
}
static surface quadric(uint32_t role, const double *X) { /* (x - 1)2 + y2 + z2 = 25 */
  (void)role;
  return round_at(X[0] - 1, X[1], X[2], turn(X[0], X[1]), latitude(X[0], X[1], X[2]));
}
static surface halfspace(uint32_t role, const double *X) { /* x + 2 y + 2 z = 3 */
  (void)role;
  return flat_at(1, 2, 2, (2 * X[0] - X[1]) / sqrt(5), (2 * X[0] + 4 * X[1] - 5 * X[2]) / sqrt(45));
}
static surface cube(uint32_t role, const double *X) { /* [4, 2, 6] */
  const double side = (role - QUOIN_FACE) % 2 ? 1 : -1;
  switch ((role - QUOIN_FACE) / 2) {
    case 0: return flat_at(side, 0, 0, X[1] / 2, X[2] / 6);
    case 1: return flat_at(0, side, 0, X[0] / 4, X[2] / 6);
    default: return flat_at(0, 0, side, X[0] / 4, X[1] / 2);
  }
}
static surface wedge(uint32_t role, const double *X) { /* [4, 2, 4] */
  switch (role - QUOIN_FACE) {
    case 0: return flat_at(-1, 0, 0, X[1] / 2, X[2] / 4);
    case 1: return flat_at(1, 0, 1, X[1] / 2, X[2] / 4);
    case 2: return flat_at(0, -1, 0, X[0] / 4, X[2] / 4);
    case 3: return flat_at(0, 1, 0, X[0] / 4, X[2] / 4);
    default: return flat_at(0, 0, -1, X[0] / 4, X[1] / 2);
  }
}
static surface prism(uint32_t role, const double *X) { /* |x| + |y| <= 2, 0 <= z <= 2 */
  static const double way[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  if (role < QUOIN_FACE) {
    return disc(role == QUOIN_CAP1 ? 1 : -1, X, 2, 2);
  }
  return round_at(way[role - QUOIN_FACE][0], way[role - QUOIN_FACE][1], 0, turn(X[0], X[1]), X[2] / 2);
}
static surface tetrahedron(uint32_t role, const double *X) {
  switch (role - QUOIN_FACE) {
    case 0: return flat_at(-1, 0, 0, X[1] / 4, X[2] / 4);
    case 1: return flat_at(0, -1, 0, X[0] / 4, X[2] / 4);
    case 2: return flat_at(0, 0, -1, X[0] / 4, X[1] / 4);
    default: return flat_at(1, 1, 1, X[0] / 4, X[1] / 4);
  }
}
static surface quartic(uint32_t role, const double *X) { /* x4 + y4 + z4 = 16: e = n = 1/2 */
  (void)role;
  return round_at(pow(X[0], 3), pow(X[1], 3), pow(X[2], 3), turn(X[0], X[1]), latitude(X[0], X[1], X[2]));
}
static surface octahedron(uint32_t role, const double *X) { /* |x| + |y| + |z| = 2: e = n = 2 */
  (void)role;
  return round_at(X[0] < 0 ? -1 : 1, X[1] < 0 ? -1 : 1, X[2] < 0 ? -1 : 1, turn(X[0], X[1]), latitude(X[0], X[1], X[2]));
}

typedef struct kind {
  const char *name, *text;
  surface (*at)(uint32_t role, const double *X);
  double lo[3], hi[3]; /* rays aim into this box */
  unsigned roles;      /* the roles that must be hit, a bit each */
  const char *placed;  /* base = [4, 3, -4], an axis along +x: X goes to (4 + z, 3 + y, -4 - x), z counted from the base */
  double flip;         /* the paraboloid's z is counted from the vertex, against the axis: h; else 0 */
} kind;

#define BODY 1u
#define CAPS 6u
#define FACES(n) (((1u << (n)) - 1) << 3)
static const kind kinds[] = {
  {"sphere", "sphere(5);", sphere, {-4, -4, -4}, {4, 4, 4}, BODY, "sphere(base = [4, 3, -4], axis = [2, 0, 0], r = 5);", 0},
  {"ellipsoid", "ellipsoid([5, 3, 2]);", ellipsoid, {-4, -2, -1}, {4, 2, 1}, BODY, "ellipsoid(base = [4, 3, -4], axis = [2, 0, 0], r = [5, 3, 2]);", 0},
  {"cylinder", "cylinder(h = 2, r = 5);", cylinder, {-3, -3, 0}, {3, 3, 2}, BODY | CAPS, "cylinder(base = [4, 3, -4], axis = [1, 0, 0], r = 5, h = 2);", 0},
  {"elliptic cylinder", "cylinder(h = 2, r = [5, 3]);", elliptic_cylinder, {-3, -2, 0}, {3, 2, 2}, BODY | CAPS,
   "cylinder(base = [4, 3, -4], axis = [1, 0, 0], r = [5, 3], h = 2);", 0},
  {"truncated cone", "cylinder(h = 2, r1 = 4, r2 = 3);", frustum, {-2, -2, 0}, {2, 2, 2}, BODY | CAPS,
   "cylinder(base = [4, 3, -4], axis = [1, 0, 0], r1 = 4, r2 = 3, h = 2);", 0},
  {"cone", "cone(h = 10, r = 5);", cone, {-2, -2, 0}, {2, 2, 4}, BODY | 2u, "cone(base = [4, 3, -4], axis = [1, 0, 0], r = 5, h = 10);", 0},
  {"paraboloid", "paraboloid(h = 4, r = 2);", paraboloid, {-1, -1, 2}, {1, 1, 4}, BODY | 2u,
   "paraboloid(base = [4, 3, -4], axis = [1, 0, 0], r = 2, h = 4);", 4},
  {"elliptic paraboloid", "paraboloid(h = 4, r = [2, 1]);", elliptic_paraboloid, {-1, -0.5, 2}, {1, 0.5, 4}, BODY | 2u, NULL, 0},
  {"hyperboloid of one sheet", "hyperboloid(h = 2, r = 5, rc = 3);", hyperboloid1, {-2, -2, -2}, {2, 2, 2}, BODY | CAPS,
   "hyperboloid(base = [4, 3, -4], axis = [1, 0, 0], r = 5, h = 2, rc = 3);", 0},
  {"hyperboloid of two sheets", "hyperboloid(h = 5, r = 4, gap = 3);", hyperboloid2, {-2, -2, -5}, {2, 2, 5}, BODY | CAPS,
   "hyperboloid(base = [4, 3, -4], axis = [1, 0, 0], r = 4, h = 5, gap = 3);", 0},
  {"saddle", "saddle(2, 1);", saddle, {-4, -2, -3}, {4, 2, 3}, BODY, NULL, 0},
  {"quadric", "quadric([1, 1, 1, 0, 0, 0, -2, 0, 0, -24]);", quadric, {-3, -3, -3}, {4, 3, 3}, BODY, NULL, 0},
  {"half-space", "halfspace([1, 2, 2], 3);", halfspace, {-3, -3, -3}, {3, 3, 3}, FACES(1), NULL, 0},
  {"cube", "cube([4, 2, 6]);", cube, {0, 0, 0}, {4, 2, 6}, FACES(6), NULL, 0},
  {"wedge", "wedge([4, 2, 4]);", wedge, {0, 0, 0}, {2, 2, 2}, FACES(5), NULL, 0},
  {"prism", "cylinder(h = 2, r = 2, $fn = 4);", prism, {-1, -1, 0}, {1, 1, 2}, CAPS | FACES(4), NULL, 0},
  {"polyhedron", "polyhedron(points = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]], faces = [[0, 2, 3], [0, 3, 1], [0, 1, 2], [1, 3, 2]]);", tetrahedron,
   {0, 0, 0}, {2, 2, 2}, FACES(4), NULL, 0},
  {"superquadric 1/2 1/2", "superquadric(r = [2, 2, 2], e = 0.5, n = 0.5);", quartic, {-1, -1, -1}, {1, 1, 1}, BODY, NULL, 0},
  {"superquadric 2 2", "superquadric(r = [2, 2, 2], e = 2, n = 2);", octahedron, {-1, -1, -1}, {1, 1, 1}, BODY, NULL, 0},
};

/* --- frames ------------------------------------------------------------------------------------------------------------------------ */

typedef struct frame {
  double m[3][3], shift[3];
} frame;

static double det(const double m[3][3]) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}
/* Cofactors over the determinant: the inverse transpose. */
static void cofactors(const double m[3][3], double c[3][3]) {
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      int a = (i + 1) % 3, b = (i + 2) % 3, p = (j + 1) % 3, q = (j + 2) % 3;
      c[i][j] = (m[a][p] * m[b][q] - m[a][q] * m[b][p]) / det(m);
    }
  }
}
static void to_world(const frame *f, const double X[3], double p[3]) {
  for (int i = 0; i < 3; i++) {
    p[i] = f->m[i][0] * X[0] + f->m[i][1] * X[1] + f->m[i][2] * X[2] + f->shift[i];
  }
}

static double dice(uint64_t *state) {
  *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (double)(*state >> 11) * 0x1p-53;
}

/* 400 rays from a sphere of radius 60 around the middle into the box. The hits' normals, (u, v) and places are the formulas', to what
   doubles allow; near = 2^-30 is far above the rounding of such a hit, and far below what a wrong formula gives. */
static void hits(const kind *k, const char *text, const frame *f, uint64_t seed) {
  const double near = 0x1p-30, inf = strtod("inf", NULL);
  double c[3][3];
  cofactors(f->m, c);
  ask a;
  ask_open(&a, text);
  unsigned seen = 0;
  size_t found = 0;
  for (int n = 0; n < 400; n++) {
    double target[3], eye[3], q[3], e[3];
    double z = 2 * dice(&seed) - 1, phi = 2 * PI * dice(&seed);
    const double way[3] = {sqrt(1 - z * z) * cos(phi), sqrt(1 - z * z) * sin(phi), z};
    for (int i = 0; i < 3; i++) {
      target[i] = k->lo[i] + (k->hi[i] - k->lo[i]) * dice(&seed);
      eye[i] = target[i] + 60 * way[i];
    }
    to_world(f, target, q);
    to_world(f, eye, e);
    const quoin_ray ray = {{e[0], e[1], e[2]}, {q[0] - e[0], q[1] - e[1], q[2] - e[2]}, 0, inf};
    quoin_hit hit;
    assert_int_equal(quoin_first_hit(a.scene, a.work, &ray, &hit), QUOIN_OK);
    if (!hit.found) {
      continue;
    }
    found++;
    assert_in_range(hit.role, 0, 12);
    seen |= 1u << hit.role;
    double X[3] = {0}, want[3] = {0}, length = 0, dot = 0, own = 0;
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++) {
        X[i] += c[j][i] * (hit.point[j] - f->shift[j]);
      }
    }
    const surface s = k->at(hit.role, X);
    for (int i = 0; i < 3; i++) {
      want[i] = c[i][0] * s.g[0] + c[i][1] * s.g[1] + c[i][2] * s.g[2];
      length += want[i] * want[i];
      own += hit.normal[i] * hit.normal[i];
      dot += want[i] * hit.normal[i];
    }
    double across = 0; /* the sine of the angle between them */
    for (int i = 0; i < 3; i++) {
      across += pow(hit.normal[i] - want[i] / sqrt(length), 2);
    }
    double du = fabs(hit.uv[0] - s.u), dv = fabs(hit.uv[1] - s.v);
    du = s.turns ? fmin(du, 1 - du) : du;
    double radius = hypot(X[0], X[1]); /* the angle is as sharp as the point is far from the axis */
    if (!(fabs(own - 1) < near && dot > 0 && sqrt(across) < near && du < near * (s.turns ? 1 + 1 / radius : 1) && dv < near)) {
      print_error("%s: role %u at (%g, %g, %g): normal (%g, %g, %g) for (%g, %g, %g), uv (%g, %g) for (%g, %g)\n", k->name, hit.role, X[0], X[1], X[2],
                  hit.normal[0], hit.normal[1], hit.normal[2], want[0] / sqrt(length), want[1] / sqrt(length), want[2] / sqrt(length), hit.uv[0],
                  hit.uv[1], s.u, s.v);
      fail();
    }
  }
  assert_true(found > 150);
  if ((seen & k->roles) != k->roles) {
    print_error("%s: roles %#x of %#x were hit\n", k->name, seen, k->roles);
    fail();
  }
  ask_close(&a);
}

static void surfaces(void **state) {
  const kind *k = *state;
  const frame plain = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};
  hits(k, k->text, &plain, 1);

  /* rotated about z and x by the angle of (3/5, 4/5), after a stretch and a mirroring */
  const frame bent = {{{0.6, -1.6, 0}, {0.48, 0.72, 0.4}, {0.64, 0.96, -0.3}}, {7, -0.25, 2}};
  char text[1000];
  snprintf(text, sizeof text,
           "translate([7, -0.25, 2]) multmatrix([[1, 0, 0], [0, 0.6, -0.8], [0, 0.8, 0.6]]) multmatrix([[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]]) "
           "scale([1, 2, -0.5]) %s",
           k->text);
  hits(k, text, &bent, 2);

  if (k->placed) { /* (4 + z, 3 + y, -4 - x) */
    frame laid = {{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}, {4, 3, -4}};
    if (k->flip != 0) { /* z runs from h to 0 along the axis, and the angle goes about the axis as it is given */
      laid = (frame){{{0, 0, -1}, {0, 1, 0}, {-1, 0, 0}}, {4 + k->flip, 3, -4}};
    }
    hits(k, k->placed, &laid, 3);
  }
}

int main(void) {
  enum { KINDS = sizeof kinds / sizeof *kinds };
  static struct CMUnitTest tests[KINDS];
  static kind state[KINDS]; /* cmocka's state is not const */
  for (size_t i = 0; i < KINDS; i++) {
    state[i] = kinds[i];
    tests[i] = (struct CMUnitTest){.name = kinds[i].name, .test_func = surfaces, .initial_state = &state[i]};
  }
  return _cmocka_run_group_tests("surfaces", tests, KINDS, NULL, NULL);
}
