/* The table of primitives. Adding one is adding a row here and its file.

   A primitive is a meet (intersection) of half-spaces q(x) <= 0. Each half-space is a plane or a quadric in the diagonal form
       q = s0 X0^2 + s1 X1^2 + s2 X2^2 + 2 l X2 + k,     X_i = row_i . (x, y, z, 1)
   with rows of its own, all numbers exact (or S2). A plane is q = X0 (one row). A superquadric body has rows and its
   two exponents, and is the one form that is not algebraic (S10). Forms are the one source of truth: the double
   shadows and the integer surfaces of a scene are both made from them. */
#ifndef QN_SHAPE_PRIM_H
#define QN_SHAPE_PRIM_H

#include "number/num.h"
#include "quoin/scene.h" /* quoin_role */
#include "shape/super_frame.h"

typedef enum qn_prim {
  QN_SPHERE,       /* r */
  QN_ELLIPSOID,    /* a, b, c */
  QN_CUBE,         /* x, y, z, center (0 or 1) */
  QN_CYLINDER,     /* h, a1, b1, a2, b2, center: semi-axes of the ellipse at the bottom and at the top; a1 b2 = a2 b1
                      (so a cone or frustum is one too; a zero pair makes an apex, not both pairs) */
  QN_PRISM,        /* n, h, r1, r2, center: the n-gon OpenSCAD makes of a cylinder, vertex 0 on +x */
  QN_PARABOLOID,   /* h, a, b, center: vertex at the origin, cap at z = h with semi-axes a, b; placed: base is the cap's
                      centre and axis points to the vertex */
  QN_HYPERBOLOID1, /* h, r, rc: waist rc at z = 0, r at z = -h, h; capped there; placed: base is the centre (of both kinds) */
  QN_HYPERBOLOID2, /* h, r, gap: vertices at z = -gap, gap; r at z = -h, h; capped there */
  QN_SADDLE,       /* a, b: z <= x^2/a^2 - y^2/b^2 */
  QN_QUADRIC,      /* A..J as in the language: A x2 + B y2 + C z2 + D xy + E xz + F yz + G x + H y + I z + J <= 0 */
  QN_HALFSPACE,    /* a, b, c, d: a x + b y + c z <= d */
  QN_WEDGE,        /* x, y, z, center: the cube's half with z/sz + x/sx <= 1 */
  QN_SUPERQUADRIC, /* a, b, c, e, n: (|x/a|^(2/e) + |y/b|^(2/e))^(e/n) + |z/c|^(2/n) <= 1; limits at exponent 0 */
  QN_POLYHEDRON,   /* n planes: 4 n numbers a, b, c, d of a x + b y + c z <= d, bounded, convex; then 3 m numbers: its vertices; first of all n and m */
  QN_PRIM_COUNT
} qn_prim;

/* A placement: base point and axis vector (exact, axis not zero). The local z axis goes to axis / |axis|, the local x and y axes
   where
   rotate([0, acos(w_z / |w|), atan2(w_y, w_x)]) takes them (w the axis), so that axis +z changes nothing and -z is half a turn
   about y.
   Only round primitives (row->round; a prism is one) take it. Sphere, ellipsoid, hyperboloids: base is the centre; cylinder and
   prism: the
   bottom's centre, or the middle when centred. */
typedef struct qn_placement { qn_num base[3], axis[3]; } qn_placement;

typedef enum qn_half_kind { QN_PLANE, QN_QUADRIC_BODY, QN_SUPER_BODY } qn_half_kind;

typedef struct qn_half_form {
  qn_half_kind kind;
  uint32_t role;     /* QUOIN_BODY, QUOIN_CAP0, QUOIN_CAP1, QUOIN_FACE + k. cap0: z = 0, -h, -h/2 or the paraboloid's one; cap1 the other.
                        Faces: cube -x, +x, -y, +y, -z, +z; wedge -x, the slanted one, -y, +y, -z; prism side k from vertex k to k
                        + 1; polyhedron plane k.
                        A superquadric's are all QUOIN_BODY. */
  qn_num row[3][4];  /* QN_PLANE uses row[0] */
  qn_num s[3], l, k; /* QN_SUPER_BODY: s[0] = e, s[1] = n */
} qn_half_form;

typedef enum qn_form_result { QN_FORM_OK, QN_FORM_EMPTY, QN_FORM_ALL } qn_form_result; /* EMPTY: no interior; ALL: all of space */

typedef struct qn_prim_row {
  const char *word;     /* the language's word */
  int args;             /* numbers it takes; -1: varies */
  int round;            /* may be placed by base and axis */
  int bounded;
  int faces;            /* most half-spaces it makes; -1: varies */
  /* Makes the half-spaces into the context's arena (*halves, *count). placement may be null. Sizes were checked by the
     reader, but anything degenerate that is left gives EMPTY. */
  qn_form_result (*form)(qn_ctx *ctx, const qn_num *args, size_t n, const qn_placement *placement, qn_half_form **halves, size_t *count);
  /* The support function of the solid in local coordinates (a placed one where it was placed): at least max of v . x over the exact solid, and
     over it by a few roundings at most, relative to the size of the terms (docs/bounds.md, QN_SUPPORT_SLACK); infinite where
     unbounded
     (of a half-space finite along its normal when both lie along one axis; of a quadric finite when it is an ellipsoid for
     certain).
     args as doubles rounded to nearest; placement likewise (base, axis) or null. Numbers that are not 0 should lie within 2^-300
     and 2^300, so that no product underflows. Cost: a few dozen flops. */
  double (*support)(const double *args, size_t n, const double placement[6], const double v[3]);
  /* (u, v) of a surface point given in the leaf's local coordinates (before the leaf's map), for the surface `role`;
     both in [0, 1] on bounded primitives. In doubles. */
  void (*uv)(const double *args, size_t n, const double placement[6], uint32_t role, const double x[3], double uv[2]);
} qn_prim_row;

extern const qn_prim_row qn_prims[QN_PRIM_COUNT];

/* A general quadric brought to the diagonal form by a rational congruence (Lagrange's reduction): exact. q: A..J. */
qn_form_result qn_quadric_diagonal(qn_ctx *ctx, const qn_num q[10], qn_half_form *out);

/* A superquadric's inside-outside value minus 1 at a point of its own frame (X_i as the rows give), with a bound of its
   error: the true value lies within *error of the result, also when X, e and n are each the doubles nearest to the exact ones. e,
   n >= 0; the
   limits at 0 are maxima: f = max(rho, |z|) at n = 0, where rho = max(|x|, |y|) at e = 0. Infinite with error 0: beyond the range
   for certain. */
double qn_superquadric_value(double e, double n, const double X[3], double *error);
/* Its direction of growth (the gradient up to a positive factor, outward), with limits where an exponent makes it discontinuous:
   on an edge the mean of
   both sides. Finite. */
void qn_superquadric_gradient(double e, double n, const double X[3], double g[3]);
/* The sign of value - 1 at a point with exact coordinates, in MPFR at growing precision to QN_S2_PRECISION bits; 0 when still
   undecided. */
int qn_superquadric_sign(qn_ctx *ctx, qn_num e, qn_num n, const qn_num X[3]);
/* Roots of the superquadric along a line, X(t) = O + t D in its frame (super_frame.h): disjoint enclosures [lo, hi] in increasing order into roots[] (at most
   max), isolated by interval arithmetic with bisection and refined by safeguarded Newton to the last bits; a pair closer than
   2^-40 of the solid's size may be missed (S10). The value is positive before the first and changes sign at each: at both ends of
   an enclosure the sign is certain for the exact line, but where t is beyond QN_SUPER_FAR sizes: both ends are then the double nearest to the root, and neighbours may be equal. frame: null where it is to be made from the exact line, which else is asked for only where frame leaves
   something open; 0 roots when it was refused. Returns the count. Cost: 0.4 to 1.5 us; very
   near a tangent, and with exponents under 2^-9 (but e = 0) or over 8, 10 us to a few ms. */
size_t qn_superquadric_roots(const qn_super_frame *frame, qn_super_ask ask, void *user, double (*roots)[2], size_t max);

#endif
