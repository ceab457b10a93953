/* The rows of test_orders.c: for each primitive the rays, and what is expected of them. The equation each was derived from stands
   above its rows. */
#ifndef QN_TESTS_ORDER_ROWS_H
#define QN_TESTS_ORDER_ROWS_H

/* ---------------------------------------------------------------- bodies without caps */

/* x2 + y2 + z2 <= 25 */
static const row sphere_rows[] = {
  {"b1 b2", "-7 3 0 1 0 0", "3 b 11 b", 0, 0},
  {"b1 b2 from its centre", "0 0 0 0 3 4", "-1 b 1 b", 0, 0},
  {"b1 b2 oblique, ends at (-3, 0, 4) and (5, 0, 0)", "-11 0 8 8 0 -4", "1 b 2 b", 0, 0},
  {"tangent: one double root", "-7 5 0 1 0 0", 0, 0, "7"},
  {"tangent, oblique: at (3, 4, 0)", "-5 10 0 4 -3 0", 0, 0, "2"},
  {"no root: miss", "-7 5.001 0 1 0 0", 0, 0, 0},
};

/* x2/25 + y2/9 + z2/4 <= 1 */
static const row ellipsoid_rows[] = {
  {"b1 b2 along x", "-7 1.8 0 1 0 0", "3 b 11 b", 0, 0}, /* y/3 = 3/5: x = -4, 4 */
  {"b1 b2 along y", "3 -4 0 0 1 0", "1.6 b 6.4 b", 0, 0},
  {"b1 b2 along z", "0 1.8 -3 0 0 1", "1.4 b 4.6 b", 0, 0},
  {"b1 b2 from its centre", "0 0 0 0 0 1", "-2 b 2 b", 0, 0},
  {"tangent: one double root", "-7 3 0 1 0 0", 0, 0, "7"},
  {"tangent, oblique: at (4, 1.8, 0)", "1.5 3.8 0 2.5 -2 0", 0, 0, "1"}, /* the gradient there is along (4, 5) */
  {"no root: miss", "-7 3.001 0 1 0 0", 0, 0, 0},
};

/* ---------------------------------------------------------------- cylinders */

/* x2 + y2 <= 25, 0 <= z <= 2 */
static const row cylinder_rows[] = {
  {"c1 c2 b1 b2: miss", "-20 0 -1 1 0 1", 0, 0, 0},
  {"c1 b1 c2 b2: enters by the body, leaves by a cap", "-7 0 -1 1 0 1", "2 b 3 c1", 0, 0},
  {"c1 b1 b2 c2: enters and leaves by the body", "-7 0 0.5 10 0 1", "0.2 b 1.2 b", 0, 0},
  {"b1 c1 b2 c2: enters by a cap, leaves by the body", "3 0 -1 1 0 1", "1 c0 2 b", 0, 0},
  {"b1 c1 c2 b2: enters and leaves by caps", "0 0 -1 1 0 1", "1 c0 3 c1", 0, 0},
  {"b1 b2 c1 c2: miss", "0 0 -10 1 0 1", 0, 0, 0},
  {"tangent: one double root", "-3 5 1 1 0 0", 0, 0, "3"},
  {"tangent beyond the caps", "-3 5 2.001 1 0 0", 0, 0, 0},
  {"no root: misses the body", "-7 6 1 1 0 0", 0, 0, 0},
  {"no root: parallel to the axis, inside", "1 1 -1 0 0 1", "1 c0 3 c1", 0, 0},
  {"no root: parallel to the axis, outside", "6 0 -1 0 0 1", 0, 0, 0},
  {"along a generator", "3 4 -1 0 0 1", 0, "1 3", 0},
  {"parallel to the caps, inside the slab", "-7 0 1 1 0 0", "2 b 12 b", 0, 0},
  {"parallel to the caps, outside the slab", "-7 0 3 1 0 0", 0, 0, 0},
  {"in the plane of cap 1", "-7 0 2 1 0 0", 0, "2 12", 0},
  {"in the plane of cap 0", "-7 3 0 1 0 0", 0, "3 11", 0},
  {"c1 b1 (b2 c2): leaves by the rim", "0 1 -1 1 1 1", "1 c0 3 *", 0, 0},
  {"(c1 b1) (b2 c2): enters and leaves by a rim", "12 16 5 -3 -4 -1", "3 * 5 *", 0, 0},
  {"(c1 b2): touches the rim", "12 16 -1 -3 -4 1", 0, 0, "3"},
  {"tangent in the plane of a cap", "-3 5 2 1 0 0", 0, 0, "3"},
};

/* x2/25 + y2/9 <= 1, 0 <= z <= 2 */
static const row elliptic_cylinder_rows[] = {
  {"c1 c2 b1 b2: miss", "-20 0 -1 1 0 1", 0, 0, 0},
  {"c1 b1 c2 b2: enters by the body, leaves by a cap", "0 -5 -1 0 1 1", "2 b 3 c1", 0, 0},
  {"c1 b1 b2 c2: enters and leaves by the body", "-7 0 0.5 10 0 1", "0.2 b 1.2 b", 0, 0},
  {"b1 c1 b2 c2: enters by a cap, leaves by the body", "0 1 -1 0 1 1", "1 c0 2 b", 0, 0},
  {"b1 c1 c2 b2: enters and leaves by caps", "0 0 -1 1 0 1", "1 c0 3 c1", 0, 0},
  {"b1 b2 c1 c2: miss", "0 0 -10 1 0 1", 0, 0, 0},
  {"tangent: one double root", "5 -3 1 0 1 0", 0, 0, "3"},
  {"no root: misses the body", "-7 3.5 1 1 0 0", 0, 0, 0},
  {"no root: parallel to the axis, inside", "4 1 -1 0 0 1", "1 c0 3 c1", 0, 0},
  {"no root: parallel to the axis, outside", "1 4 -1 0 0 1", 0, 0, 0},
  {"along a generator", "4 1.8 -1 0 0 1", 0, "1 3", 0},
  {"parallel to the caps, inside the slab", "-7 1.8 1 1 0 0", "3 b 11 b", 0, 0},
  {"parallel to the caps, outside the slab", "-7 1.8 -0.001 1 0 0", 0, 0, 0},
  {"in the plane of cap 1", "0 -4 2 0 1 0", 0, "1 7", 0},
};

/* ---------------------------------------------------------------- cones */

/* x2 + y2 <= (4 - z/2)2, 0 <= z <= 2; the apex of its cone is at z = 8 */
static const row frustum_rows[] = {
  {"c1 c2 b1 b2: miss", "-7 0 -1 1 0 1", 0, 0, 0},
  {"c1 b1 c2 b2: enters by the body, leaves by a cap", "-5.5 0 -1 1 0 1", "2 b 3 c1", 0, 0},
  {"c1 b1 b2 c2: enters and leaves by the body", "-8.5 0 0.5 10 0 1", "0.5 b 7/6 b", 0, 0},
  {"b1 c1 b2 c2: enters by a cap, leaves by the body", "1.5 0 -1 1 0 1", "1 c0 2 b", 0, 0},
  {"b1 c1 c2 b2: enters and leaves by caps", "-3 0 -1 1 0 1", "1 c0 3 c1", 0, 0},
  {"b1 b2 c1 c2: miss", "3.75 0 -1 1 0 1", 0, 0, 0},
  {"tangent: one double root", "3.5 -3 1 0 1 0", 0, 0, "3"},
  {"no root: misses the body", "-7 4.5 1 1 0 0", 0, 0, 0},
  {"leading coefficient zero: parallel to a generator, one root", "-2 0 -2 -1 0 2", "1 c0 1.5 b", 0, 0},
  {"leading coefficient zero, the root beyond the caps", "0 0 -2 -1 0 2", "1 c0 2 c1", 0, 0},
  {"leading coefficient zero: along a generator", "4 0 0 -1 0 2", 0, "0 1", 0},
  {"leading coefficient below zero: within the body between the caps", "0 0 -1 0 0 1", "1 c0 3 c1", 0, 0},
  {"leading coefficient below zero: leaves by the body", "3.5 0 -1 0 0 1", "1 c0 2 b", 0, 0},
  {"leading coefficient below zero: a double root at the apex beyond the caps", "-2 0 0 1 0 4", "0 c0 0.5 c1", 0, 0},
  {"the second nappe is not there", "-7 0 12 1 0 0", 0, 0, 0},
  {"parallel to the caps, inside the slab", "-7 0 1 1 0 0", "3.5 b 10.5 b", 0, 0},
  {"parallel to the caps, outside the slab", "-7 0 3 1 0 0", 0, 0, 0},
  {"in the plane of cap 1", "-7 0 2 1 0 0", 0, "4 10", 0},
  {"in the plane of cap 0", "-7 0 0 1 0 0", 0, "3 11", 0},
};

/* x2 + y2 <= (5 - z/2)2, 0 <= z <= 10: the plane z = 10 meets the solid in the apex alone, so orders with a cap on either side go
   through the apex */
static const row cone_rows[] = {
  {"c1 c2 b1 b2: miss, beyond the apex", "-12 0 -1 1 0 1", 0, 0, 0},
  {"c1 b1 c2 b2: enters by the body, leaves by the base", "-7 0 11 1 0 -1", "5 b 11 c0", 0, 0},
  {"c1 b1 b2 c2: enters and leaves by the body", "-4 0 11 1 0 -1", "3 b 7 b", 0, 0},
  {"b1 c1 b2 c2: enters by the base, leaves by the body", "-2 0 -1 1 0 1", "1 c0 5 b", 0, 0},
  {"b1 c1 c2 b2: enters by the base, leaves by the apex", "-1 0 6 1 0 4", "-1.5 c0 1 *", 0, 0},
  {"b1 b2 c1 c2: miss", "5.5 0 -1 1 0 1", 0, 0, 0},
  {"tangent: one double root", "4 -3 2 0 1 0", 0, 0, "3"},
  {"tangent at the apex", "-1 0 10 1 0 0", 0, 0, "1"},
  {"no root: misses the body", "-7 4.5 2 1 0 0", 0, 0, 0},
  {"leading coefficient zero: parallel to a generator, one root", "0 0 4 1 0 -2", "-1.5 b 2 c0", 0, 0},
  {"leading coefficient zero: along a generator", "5 0 0 -1 0 2", 0, "0 5", 0},
  {"leading coefficient below zero: along the axis", "0 0 -1 0 0 1", "1 c0 11 *", 0, 0},
  {"leading coefficient below zero: two roots, one on the second nappe", "3 0 -1 0 0 1", "1 c0 5 b", 0, 0},
  {"the second nappe is not there", "-7 0 12 1 0 0", 0, 0, 0},
  {"parallel to the base, inside", "-7 0 2 1 0 0", "3 b 11 b", 0, 0},
  {"parallel to the base, outside", "-7 0 -1 1 0 0", 0, 0, 0},
  {"in the plane of the base", "-7 0 0 1 0 0", 0, "2 12", 0},
};

/* ---------------------------------------------------------------- paraboloids */

/* x2 + y2 <= z <= 4: one cap, so one of c1, c2 is infinite, and "enters and leaves by caps" cannot be */
static const row paraboloid_rows[] = {
  {"b1 b2 after the cap: miss", "0 0 -12 1 0 7", 0, 0, 0}, /* b1 = 3, b2 = 4, z = 9 and 16 there */
  {"b1 c b2: enters by the body, leaves by the cap", "-3 0 -3 1 0 2", "2 b 3.5 c0", 0, 0},
  {"b1 b2 c: enters and leaves by the body", "-3 0 0 2 0 1", "1 b 2.25 b", 0, 0},
  {"b1 c b2 downwards: enters by the cap, leaves by the body", "3 0 9 -1 0 -2", "2.5 c0 4 b", 0, 0},
  {"b1 b2 before the cap downwards: miss", "4 0 16 -1 0 -7", 0, 0, 0},
  {"tangent at the vertex", "-3 0 0 1 0 0", 0, 0, "3"},
  {"tangent, oblique: one double root", "0 0 -1 1 0 2", 0, 0, "1"},
  {"tangent beyond the cap", "3 -2 9 0 1 0", 0, 0, 0},
  {"no root: misses the body", "-3 0 -1 1 0 0", 0, 0, 0},
  {"leading coefficient zero: along the axis", "0 0 -1 0 0 1", "1 b 5 c0", 0, 0},
  {"leading coefficient zero: parallel to the axis", "1 0 -2 0 0 1", "3 b 6 c0", 0, 0},
  {"leading coefficient zero: parallel to the axis, beside the cap", "3 0 -2 0 0 1", 0, 0, 0},
  {"leading coefficient zero: through the rim", "2 0 -2 0 0 1", 0, 0, "6"},
  {"parallel to the cap, inside", "-7 0 1 1 0 0", "6 b 8 b", 0, 0},
  {"parallel to the cap, outside", "-7 0 5 1 0 0", 0, 0, 0},
  {"in the plane of the cap", "-7 0 4 1 0 0", 0, "5 9", 0},
};

/* x2/4 + y2 <= z/4, z <= 4: x2 + 4 y2 <= z */
static const row elliptic_paraboloid_rows[] = {
  {"b1 b2 after the cap: miss", "0 0 -12 1 0 7", 0, 0, 0},
  {"b1 c b2: enters by the body, leaves by the cap", "-3 0 -3 1 0 2", "2 b 3.5 c0", 0, 0},
  {"b1 b2 c: enters and leaves by the body", "0 -1.5 0 0 1 1", "1 b 2.25 b", 0, 0}, /* 4 (t - 3/2)2 = t: t = 1, 9/4 */
  {"b1 c b2 downwards: enters by the cap, leaves by the body", "3 0 9 -1 0 -2", "2.5 c0 4 b", 0, 0},
  {"tangent at the vertex", "0 -3 0 0 1 0", 0, 0, "3"},
  {"no root: misses the body", "0 -3 -1 0 1 0", 0, 0, 0},
  {"leading coefficient zero: parallel to the axis", "0 0.5 -2 0 0 1", "3 b 6 c0", 0, 0},
  {"leading coefficient zero: parallel to the axis, beside the cap", "0 1.5 -2 0 0 1", 0, 0, 0},
  {"parallel to the cap, inside", "0 -3 1 0 1 0", "2.5 b 3.5 b", 0, 0},
  {"parallel to the cap, outside", "0 -3 5 0 1 0", 0, 0, 0},
  {"in the plane of the cap", "0 -3 4 0 1 0", 0, "2 4", 0},
};

/* ---------------------------------------------------------------- hyperboloids */

/* x2 + y2 <= 9 + 4 z2, -2 <= z <= 2; in the plane y = 0 it passes through (x, z) = (3, 0), (3.25, 0.625), (3.75, 1.125), (5, 2),
   (9.25, 4.375); the asymptotes are x = 2 z and x = -2 z */
static const row hyperboloid1_rows[] = {
  {"c1 c2 b1 b2: miss", "-13.25 0 3.375 4 0 1", 0, 0, 0},
  {"c1 b1 c2 b2: enters by the body, leaves by a cap", "-7.25 0 -0.375 4 0 1", "1 b 2.375 c1", 0, 0},
  {"c1 b1 b2 c2: enters and leaves by the body", "-7.75 0 -2.125 4 0 1", "1 b 2.75 b", 0, 0},
  {"b1 c1 b2 c2: enters by a cap, leaves by the body", "-4.75 0 -2.625 4 0 1", "0.625 c0 2 b", 0, 0},
  {"b1 c1 c2 b2: enters and leaves by caps", "0 0 0 9 0 4", "-0.5 c0 0.5 c1", 0, 0},
  {"b1 b2 c1 c2: miss", "5.25 0 -5.375 4 0 1", 0, 0, 0},
  {"leading coefficient below zero: the complement of [b1, b2], two intervals", "3.25 0 -3 0 0 1", "1 c0 2.375 b, 3.625 b 5 c1", 0, 0},
  {"leading coefficient below zero, no root: within the body", "1 0 -3 0 0 1", "1 c0 5 c1", 0, 0},
  {"leading coefficient below zero, a double root: within the body", "3 0 -3 0 0 1", "1 c0 5 c1", 0, 0},
  {"leading coefficient below zero: both caps within [b1, b2]: miss", "6 0 -3 0 0 1", 0, 0, 0},
  {"leading coefficient below zero: through both rims", "5 0 -3 0 0 1", 0, 0, "1 5"},
  {"leading coefficient zero: parallel to an asymptote, one root", "-4 0 -3 2 0 1", "1 c0 3.625 b", 0, 0},
  {"leading coefficient zero: an asymptote, no root", "-6 0 -3 2 0 1", "1 c0 5 c1", 0, 0},
  {"leading coefficient zero: a ruling", "3 -6 -3 0 2 1", 0, "1 5", 0},
  {"tangent at the waist: one double root", "3 -2 0 0 1 0", 0, 0, "2"},
  {"no root: misses the body", "-7 3.5 0 1 0 0", 0, 0, 0},
  {"parallel to the caps, inside the slab", "-7 0 1.125 1 0 0", "3.25 b 10.75 b", 0, 0},
  {"parallel to the caps, outside the slab", "-7 0 3 1 0 0", 0, 0, 0},
  {"in the plane of cap 1", "-7 0 2 1 0 0", 0, "2 12", 0},
};

/* x2 + y2 <= z2 - 9, -5 <= z <= 5; in the plane y = 0 it passes through (x, z) = (0, 3), (1.25, 3.25), (2.25, 3.75), (4, 5), (8.75, 9.25) */
static const row hyperboloid2_rows[] = {
  {"c1 c2 b1 b2: miss", "-15.75 0 8.25 7 0 1", 0, 0, 0},
  {"c1 b1 c2 b2: enters by the body, leaves by a cap", "-4.25 0 1.25 3 0 2", "1 b 1.875 c1", 0, 0},
  {"c1 b1 b2 c2: enters and leaves by the body of one sheet", "-8.25 0 2.25 7 0 1", "1 b 1.5 b", 0, 0},
  {"b1 c1 b2 c2: enters by a cap, leaves by the body", "-4.75 0 -7.25 3 0 2", "1.125 c0 2 b", 0, 0},
  {"c1 b1 b2 c2, the complement of [b1, b2]: along the axis, both sheets", "0 0 -6 0 0 1", "1 c0 3 b, 9 b 11 c1", 0, 0},
  {"c1 b1 b2 c2, the complement of [b1, b2]: parallel to the axis, both sheets", "1.25 0 -6 0 0 1", "1 c0 2.75 b, 9.25 b 11 c1", 0, 0},
  {"b1 c1 c2 b2, the complement of [b1, b2]: miss", "4.5 0 -6 0 0 1", 0, 0, 0},
  {"b1 b2 c1 c2: miss", "1.75 0 -10.25 7 0 1", 0, 0, 0},
  {"leading coefficient zero: parallel to an asymptote, one root", "-8 0 -6 1 0 1", "9.25 b 11 c1", 0, 0},
  {"leading coefficient zero: an asymptote, no root: miss", "-6 0 -6 1 0 1", 0, 0, 0},
  {"tangent at a vertex", "-2 0 3 1 0 0", 0, 0, "2"},
  {"tangent, oblique: one double root", "-11.75 0 -1.75 13 0 5", 0, 0, "1"},
  {"no root: between the sheets", "-7 0 1 1 0 0", 0, 0, 0},
  {"parallel to the caps, inside the slab", "-7 0 3.75 1 0 0", "4.75 b 9.25 b", 0, 0},
  {"parallel to the caps, outside the slab", "-7 0 6 1 0 0", 0, 0, 0},
  {"in the plane of cap 1", "-7 0 5 1 0 0", 0, "3 11", 0},
};

/* x2 + y2 <= 4 z2, -2 <= z <= 2: both nappes (a hyperboloid whose waist is a point) */
static const row double_cone_rows[] = {
  {"c1 c2 b1 b2: miss", "-12 0 3 4 0 1", 0, 0, 0},
  {"c1 b1 c2 b2: enters by the body, leaves by a cap", "-6 0 0 4 0 1", "1 b 2 c1", 0, 0},
  {"c1 b1 b2 c2: enters and leaves by the body of one nappe", "-7 0 1 1 0 0", "5 b 9 b", 0, 0},
  {"b1 c1 b2 c2: enters by a cap, leaves by the body", "-6 0 -3 4 0 1", "1 c0 2 b", 0, 0},
  {"b1 b2 c1 c2: miss", "4 0 -5 4 0 1", 0, 0, 0},
  {"leading coefficient below zero: the complement of [b1, b2], two nappes", "1 0 -3 0 0 1", "1 c0 2.5 b, 3.5 b 5 c1", 0, 0},
  {"leading coefficient below zero: along the axis, a double root at the apex", "0 0 -3 0 0 1", "1 c0 5 c1", 0, 0},
  {"leading coefficient below zero: oblique through the apex", "-3 0 -3 1 0 1", "1 c0 5 c1", 0, 0},
  {"leading coefficient zero: parallel to a generator, one root", "-4 0 -3 2 0 1", "1 c0 2.5 b", 0, 0},
  {"leading coefficient zero: a generator, through the apex", "-6 0 -3 2 0 1", 0, "1 5", 0},
  {"tangent: one double root", "2 -3 1 0 1 0", 0, 0, "3"},
  {"tangent at the apex", "-3 0 0 1 0 0", 0, 0, "3"},
  {"no root: misses the body", "-7 2.5 1 1 0 0", 0, 0, 0},
  {"parallel to the caps, outside the slab", "-7 0 3 1 0 0", 0, 0, 0},
  {"in the plane of cap 0", "-7 0 -2 1 0 0", 0, "3 11", 0},
};

/* ---------------------------------------------------------------- bodies with caps that are given */

/* z <= x2/4 - y2 in the box -4 <= x <= 4, -2 <= y <= 2, -3 <= z <= 3 */
static const row saddle_rows[] = {
  {"c1 c2 b1 b2: miss", "0 -1 13 0 1 -5.5", 0, 0, 0}, /* in the plane x = 0: z <= -y2 */
  {"c1 b1 c2 b2: enters by the body, leaves by a face", "-6 -4 1 2 1 0", "4 b 5 f1", 0, 0},
  {"c1 b1 b2 c2: enters and leaves by the body", "2 -3 0 0 1 0", "2 b 4 b", 0, 0},
  {"c1 b1 b2 c2, the complement of [b1, b2]: two intervals", "-5 0 1 1 0 0", "1 f0 3 b, 7 b 9 f1", 0, 0},
  {"b1 c1 b2 c2: enters by a face, leaves by the body", "6 2 1 -2 -1 0", "1 f1 2 b", 0, 0},
  {"b1 c1 c2 b2: enters and leaves by faces", "3 -3 -2 0 1 0", "1 f2 5 f3", 0, 0},
  {"b1 b2 c1 c2: miss", "0 -4 -14.5 0 1 5.5", 0, 0, 0},
  {"tangent: one double root", "2 -3 1 0 1 0", 0, 0, "3"},
  {"no root: misses the body", "2 -3 2 0 1 0", 0, 0, 0},
  {"leading coefficient zero: parallel to the axis", "2 0 -4 0 0 1", "1 f4 5 b", 0, 0},
  {"leading coefficient zero: a ruling", "-8 -4 0 2 1 0", 0, "2 6", 0},
  {"parallel to a face, inside the slab", "0 -3 -1 0 1 0", "2 b 4 b", 0, 0},
  {"parallel to a face, outside the slab", "0 -3 -3.5 0 1 0", 0, 0, 0},
  {"in the plane of a face", "-5 0 -3 1 0 0", 0, "1 9", 0},
};
/* The same body in the cylinder x2 + y2 <= 9, -3 <= z <= 3. */
static const row saddle_in_cylinder_rows[] = {
  {"enters by a cap, leaves by the saddle", "2 0 -4 0 0 1", "1 c0 5 b", 0, 0},
  {"two intervals between the cylinder and the saddle", "-5 0 1 1 0 0", "2 b 3 b, 7 b 8 b", 0, 0},
  {"enters and leaves by the saddle", "2 -4 0 0 1 0", "3 b 5 b", 0, 0},
  {"outside the cylinder", "4 -3 -1 0 1 0", 0, 0, 0},
};

/* x2 <= z in the box -5 <= x <= 5, -1 <= y <= 1, -1 <= z <= 4 */
static const row parabolic_cylinder_rows[] = {
  {"c1 c2 b1 b2: miss", "-6 -2 2 1 1 0", 0, 0, 0},
  {"c1 b1 c2 b2: enters by the body, leaves by a face", "-3 0 -3 1 0 2", "2 b 3.5 f5", 0, 0},
  {"c1 b1 b2 c2: enters and leaves by the body", "-7 0 1 1 0 0", "6 b 8 b", 0, 0},
  {"b1 c1 b2 c2: enters by a face, leaves by the body", "3 0 9 -1 0 -2", "2.5 f5 4 b", 0, 0},
  {"b1 c1 c2 b2: enters and leaves by faces", "-2 -2 2 1 1 0", "1 f2 3 f3", 0, 0},
  {"b1 b2 c1 c2: miss", "2 -2 1 1 1 0", 0, 0, 0},
  {"tangent: one double root", "-7 0 0 1 0 0", 0, 0, "7"},
  {"tangent, oblique", "0 0 -1 1 0 2", 0, 0, "1"},
  {"no root: misses the body", "-7 0 -0.5 1 0 0", 0, 0, 0},
  {"leading coefficient zero: parallel to the axis, one root", "1 0 -2 0 0 1", "3 b 6 f5", 0, 0},
  {"leading coefficients zero: along a generator's direction, inside", "1 -3 2 0 1 0", "2 f2 4 f3", 0, 0},
  {"leading coefficients zero: along a generator's direction, outside", "2 -3 2 0 1 0", 0, 0, 0},
  {"along a generator", "1 -3 1 0 1 0", 0, "2 4", 0},
  {"in the plane of a face", "-7 1 1 1 0 0", 0, "6 8", 0},
};

/* x2 - z2 <= 9 in the box -8 <= x <= 8, -1 <= y <= 1, -4 <= z <= 4; through (x, z) = (3, 0), (3.25, 1.25), (3.75, 2.25), (5, 4) */
static const row hyperbolic_cylinder_rows[] = {
  {"c1 c2 b1 b2: miss", "-9 -2 2.25 1 1 0", 0, 0, 0},
  {"c1 b1 c2 b2: enters by the body, leaves by a face", "-5.75 -2 2.25 1 1 0", "2 b 3 f3", 0, 0},
  {"c1 b1 b2 c2: enters and leaves by the body", "-9 0 2.25 1 0 0", "5.25 b 12.75 b", 0, 0},
  {"b1 c1 b2 c2: enters by a face, leaves by the body", "1.75 -2 2.25 1 1 0", "1 f2 2 b", 0, 0},
  {"b1 c1 c2 b2: enters and leaves by faces", "0 -2 2.25 1 1 0", "1 f2 3 f3", 0, 0},
  {"b1 b2 c1 c2: miss", "4.75 -2 2.25 1 1 0", 0, 0, 0},
  {"leading coefficient below zero: the complement of [b1, b2], two intervals", "3.25 0 -5 0 0 1", "1 f4 3.75 b, 6.25 b 9 f5", 0, 0},
  {"leading coefficient below zero, a double root: inside", "3 0 -5 0 0 1", "1 f4 9 f5", 0, 0},
  {"leading coefficient below zero, no root: inside", "2 0 -5 0 0 1", "1 f4 9 f5", 0, 0},
  {"leading coefficient zero: parallel to an asymptote, one root", "-3 0 -5 1 0 1", "1 f4 6.25 b", 0, 0},
  {"leading coefficients zero: along a generator's direction, inside", "1 -3 0 0 1 0", "2 f2 4 f3", 0, 0},
  {"leading coefficients zero: along a generator's direction, outside", "5 -3 0 0 1 0", 0, 0, 0},
  {"along a generator", "3 -3 0 0 1 0", 0, "2 4", 0},
};
/* x2 - z2 >= 9 in that box: the two branches */
static const row two_branches_rows[] = {
  {"the complement of [b1, b2]: two intervals", "-9 0 2.25 1 0 0", "1 f0 5.25 b, 12.75 b 17 f1", 0, 0},
  {"enters and leaves by the body", "3.25 0 -5 0 0 1", "3.75 b 6.25 b", 0, 0},
  {"tangent: one double root", "3 0 -5 0 0 1", 0, 0, "5"},
  {"no root: between the branches", "2 0 -5 0 0 1", 0, 0, 0},
};

/* (x - 1)2 + y2 + z2 <= 25 as ten coefficients and as a matrix */
static const row quadric_rows[] = {
  {"b1 b2", "-7 3 0 1 0 0", "4 b 12 b", 0, 0},
  {"tangent: one double root", "-7 5 0 1 0 0", 0, 0, "8"},
  {"no root: miss", "-7 5.001 0 1 0 0", 0, 0, 0},
};
/* x y <= 1, unbounded: an indefinite form with a mixed term */
static const row mixed_rows[] = {
  {"leading coefficient above zero: one interval", "0 0 0 1 1 0", "-1 b 1 b", 0, 0},
  {"leading coefficient below zero, no root: the whole line", "0 0 0 1 -1 0", "-inf - inf -", 0, 0},
  {"leading coefficient below zero: two unbounded intervals", "1.25 1.25 0 1 -1 0", "-inf - -0.75 b, 0.75 b inf -", 0, 0},
  {"leading coefficient below zero, a double root: the whole line", "1 1 0 1 -1 0", "-inf - inf -", 0, 0},
  {"leading coefficient zero: one root", "-3 2 0 1 0 0", "-inf - 3.5 b", 0, 0},
  {"leading coefficients zero: the whole line", "0.5 1 0 0 0 1", "-inf - inf -", 0, 0},
  {"leading coefficients zero: miss", "3 1 0 0 0 1", 0, 0, 0},
  {"along a generator", "2 0.5 0 0 0 1", 0, "-inf inf", 0},
};
/* x2 <= 0: the closure of its interior is empty */
static const row flat_rows[] = {
  {"a double root: nothing", "-1 0 0 1 0 0", 0, 0, 0},
  {"within it: nothing", "0 0 0 0 1 0", 0, 0, 0},
};

/* ---------------------------------------------------------------- planes alone */

/* x + 2 y + 2 z <= 3 */
static const row halfspace_rows[] = {
  {"one root", "-3 0 0 1 0 0", "-inf - 6 f0", 0, 0},
  {"one root, leaving upwards", "0 0 0 0 1 1", "-inf - 0.75 f0", 0, 0},
  {"parallel, inside", "0 0 0 2 -1 0", "-inf - inf -", 0, 0},
  {"parallel, outside", "4 0 0 2 -1 0", 0, 0, 0},
  {"in the plane", "3 0 0 2 -1 0", 0, "-inf inf", 0},
};

/* [0, 4] x [0, 2] x [0, 6]: the x slab as the caps, the y slab as the body */
static const row cube_rows[] = {
  {"c1 c2 b1 b2: miss", "-1 -6 3 1 1 0", 0, 0, 0},
  {"c1 b1 c2 b2", "-1 -4 3 1 1 0", "4 f2 5 f1", 0, 0},
  {"c1 b1 b2 c2", "-1 -2 3 1 1 0", "2 f2 4 f3", 0, 0},
  {"b1 c1 b2 c2", "-1 0.5 3 1 1 0", "1 f0 1.5 f3", 0, 0},
  {"b1 c1 c2 b2", "-4 -0.5 3 4 1 0", "1 f0 2 f1", 0, 0},
  {"b1 b2 c1 c2: miss", "-1 3 3 1 1 0", 0, 0, 0},
  {"along z", "1 1 -1 0 0 2", "0.5 f4 3.5 f5", 0, 0},
  {"parallel to a slab, inside", "-1 1 3 1 0 0", "1 f0 5 f1", 0, 0},
  {"parallel to a slab, outside", "-1 2.001 3 1 0 0", 0, 0, 0},
  {"in a face", "-1 0 3 1 0 0", 0, "1 5", 0},
  {"along an edge", "-1 0 0 1 0 0", 0, "1 5", 0},
  {"from corner to corner", "-4 -2 -6 4 2 6", "1 * 2 *", 0, 0},
  {"(b2 c1): touches an edge", "-1 1 3 1 1 0", 0, 0, "1"},
  {"touches a corner", "-1 -1 1 1 1 -1", 0, 0, "1"},
};

/* 0 <= x, 0 <= y <= 2, 0 <= z, x + z <= 4 */
static const row wedge_rows[] = {
  {"c1 c2 b1 b2: miss", "-1 -7 1 1 1 0", 0, 0, 0},
  {"c1 b1 c2 b2", "-1 -3 1 1 1 0", "3 f2 4 f1", 0, 0},
  {"c1 b1 b2 c2", "-1 -1.5 1 1 1 0", "1.5 f2 3.5 f3", 0, 0},
  {"b1 c1 b2 c2", "-1 0.5 1 1 1 0", "1 f0 1.5 f3", 0, 0},
  {"b1 c1 c2 b2", "-4 -0.5 2 4 1 0", "1 f0 1.5 f1", 0, 0},
  {"b1 b2 c1 c2: miss", "-1 3 1 1 1 0", 0, 0, 0},
  {"along z", "1 1 -1 0 0 1", "1 f4 4 f1", 0, 0},
  {"parallel to the slanted face, inside", "4 1 -1 -1 0 1", "1 f4 4 f0", 0, 0},
  {"parallel to the slanted face, outside", "6 1 -1 -1 0 1", 0, 0, 0},
  {"in the slanted face", "5 1 -1 -1 0 1", 0, "1 5", 0},
  {"along the edge of two faces", "-1 2 0 1 0 0", 0, "1 5", 0},
  {"touches the sharp edge", "3 1 -1 1 0 1", 0, 0, "1"},
};

/* |x| + |y| <= 2, 0 <= z <= 2: cylinder(h = 2, r = 2, $fn = 4), side k between the vertices k and k + 1 from +x on */
static const row prism_rows[] = {
  {"c1 c2 b1 b2: miss", "-20 0.5 -1 1 0 1", 0, 0, 0},
  {"c1 b1 c2 b2: enters by a side, leaves by a cap", "-3.5 0.5 -1 1 0 1", "2 f1 3 c1", 0, 0},
  {"c1 b1 b2 c2: enters and leaves by sides", "-3 0.5 1 1 0 0", "1.5 f1 4.5 f0", 0, 0},
  {"b1 c1 b2 c2: enters by a cap, leaves by a side", "-0.5 -0.5 -1 1 0 1", "1 c0 2 f3", 0, 0},
  {"b1 c1 c2 b2: enters and leaves by caps", "0 0 -1 0 0 1", "1 c0 3 c1", 0, 0},
  {"b1 b2 c1 c2: miss", "0 0.5 -10 1 0 1", 0, 0, 0},
  {"parallel to the caps, outside the slab", "-3 0.5 2.5 1 0 0", 0, 0, 0},
  {"in the plane of a cap", "-3 0.5 2 1 0 0", 0, "1.5 4.5", 0},
  {"in a side", "3 -1 1 -1 1 0", 0, "1 3", 0},
  {"along an edge between sides", "2 0 -1 0 0 1", 0, "1 3", 0},
  {"touches an edge between sides", "2 -1 1 0 1 0", 0, 0, "1"},
};

/* The tetrahedron 0 <= x, y, z, x + y + z <= 4; its faces in the order of the text: x = 0, y = 0, z = 0, the slanted one. */
static const row polyhedron_rows[] = {
  {"enters and leaves by faces", "-1 1 1 1 0 0", "1 f0 3 f3", 0, 0},
  {"along y", "1 -1 1 0 1 0", "1 f1 3 f3", 0, 0},
  {"along z", "1 1 -1 0 0 1", "1 f2 3 f3", 0, 0},
  {"two faces that stand at an angle", "-1 2 1 1 -1 0", "1 f0 2 f1", 0, 0},
  {"miss", "-1 3 3 1 0 0", 0, 0, 0},
  {"parallel to a face, outside", "-1 -0.001 1 1 0 0", 0, 0, 0},
  {"in a face", "-1 1 0 1 0 0", 0, "1 4", 0},
  {"along an edge", "-1 0 0 1 0 0", 0, "1 5", 0},
  {"touches a corner", "4 -1 0 0 1 0", 0, 0, "1"},
};

/* ---------------------------------------------------------------- superquadrics (S10) */

static const row super_ellipsoid_rows[] = { /* e = n = 1: x2/25 + y2/9 + z2/4 <= 1 */
  {"e = n = 1: b1 b2", "-7 1.8 0 1 0 0", "3 b 11 b", 0, 0},
  {"e = n = 1: no root", "-7 3.001 0 1 0 0", 0, 0, 0},
};
static const row super_octahedron_rows[] = { /* e = n = 2: |x| + |y| + |z| <= 2 */
  {"e = n = 2: b1 b2", "-3 0.5 0.5 1 0 0", "2 b 4 b", 0, 0},
  {"e = n = 2: no root", "-3 1.5 0.75 1 0 0", 0, 0, 0},
};
static const row super_box_rows[] = { /* e = n = 0: |x| <= 2, |y| <= 1, |z| <= 1 */
  {"e = n = 0: b1 b2", "-3 0.5 0.5 1 0 0", "1 b 5 b", 0, 0},
  {"e = n = 0: b1 b2 oblique", "-3 -2 0 1 1 0", "1 b 3 b", 0, 0},
  {"e = n = 0: no root", "-3 1.001 0 1 0 0", 0, 0, 0},
};
static const row super_cylinder_rows[] = { /* e = 1, n = 0: x2 + y2 <= 25, |z| <= 2 */
  {"e = 1, n = 0: across", "-7 3 1 1 0 0", "3 b 11 b", 0, 0},
  {"e = 1, n = 0: along the axis", "3 3 -4 0 0 1", "2 b 6 b", 0, 0},
  {"e = 1, n = 0: enters by the side, leaves by the end", "-7 0 -1 1 0 1", "2 b 3 b", 0, 0},
  {"e = 1, n = 0: no root", "-7 3 2.5 1 0 0", 0, 0, 0},
};
static const row super_prism_rows[] = { /* e = 0, n = 1: max(|x|, |y|)2 + z2 <= 25 */
  {"e = 0, n = 1: across", "-7 1 3 1 0 0", "3 b 11 b", 0, 0},
  {"e = 0, n = 1: along the axis", "4 4 -5 0 0 1", "2 b 8 b", 0, 0},
};
static const row super_general_rows[] = { /* e = n = 1/2: x4 + y4 + z4 <= 16 */
  {"general: along an axis", "-3 0 0 1 0 0", "1 b 5 b", 0, 0},
  {"general: no root", "-3 1.9 1.9 1 0 0", 0, 0, 0},
};

/* ---------------------------------------------------------------- the primitives */

#define ROWS(x) x, sizeof(x) / sizeof *(x)
static const primitive primitives[] = {
  {"sphere", "sphere(5);", "sphere(base = [4, 3, -4], axis = [2, 0, 0], r = 5);", "sphere(base = [4, 3, -4], axis = [-3, 0, 0], r = 5);", 0, false,
   ROWS(sphere_rows)},
  {"ellipsoid", "ellipsoid([5, 3, 2]);", "ellipsoid(base = [4, 3, -4], axis = [1, 0, 0], r = [5, 3, 2]);",
   "ellipsoid(base = [4, 3, -4], axis = [-1, 0, 0], r = [5, 3, 2]);", 0, false, ROWS(ellipsoid_rows)},
  {"cylinder", "cylinder(h = 2, r = 5);", "cylinder(base = [4, 3, -4], axis = [1, 0, 0], r = 5, h = 2);",
   "cylinder(base = [4, 3, -4], axis = [-2, 0, 0], r = 5, h = 2);", 0, false, ROWS(cylinder_rows)},
  {"elliptic cylinder", "cylinder(h = 2, r = [5, 3]);", "cylinder(base = [4, 3, -4], axis = [1, 0, 0], r = [5, 3], h = 2);",
   "cylinder(base = [4, 3, -4], axis = [-2, 0, 0], r = [5, 3], h = 2);", 0, false, ROWS(elliptic_cylinder_rows)},
  {"truncated cone", "cylinder(h = 2, r1 = 4, r2 = 3);", "cylinder(base = [4, 3, -4], axis = [1, 0, 0], r1 = 4, r2 = 3, h = 2);",
   "cylinder(base = [4, 3, -4], axis = [-2, 0, 0], r1 = 4, r2 = 3, h = 2);", 0, false, ROWS(frustum_rows)},
  {"cone", "cone(h = 10, r = 5);", "cone(base = [4, 3, -4], axis = [1, 0, 0], r = 5, h = 10);",
   "cone(base = [4, 3, -4], axis = [-2, 0, 0], r = 5, h = 10);", 0, false, ROWS(cone_rows)},
  {"paraboloid", "paraboloid(h = 4, r = 2);", "paraboloid(base = [4, 3, -4], axis = [1, 0, 0], r = 2, h = 4);",
   "paraboloid(base = [4, 3, -4], axis = [-2, 0, 0], r = 2, h = 4);", 4, false, ROWS(paraboloid_rows)},
  {"elliptic paraboloid", "paraboloid(h = 4, r = [2, 1]);", 0, 0, 0, false, ROWS(elliptic_paraboloid_rows)},
  {"hyperboloid of one sheet", "hyperboloid(h = 2, r = 5, rc = 3);", "hyperboloid(base = [4, 3, -4], axis = [1, 0, 0], r = 5, h = 2, rc = 3);",
   "hyperboloid(base = [4, 3, -4], axis = [-2, 0, 0], r = 5, h = 2, rc = 3);", 0, false, ROWS(hyperboloid1_rows)},
  {"hyperboloid of two sheets", "hyperboloid(h = 5, r = 4, gap = 3);", "hyperboloid(base = [4, 3, -4], axis = [1, 0, 0], r = 4, h = 5, gap = 3);",
   "hyperboloid(base = [4, 3, -4], axis = [-2, 0, 0], r = 4, h = 5, gap = 3);", 0, false, ROWS(hyperboloid2_rows)},
  {"two-nappe cone", "hyperboloid(h = 2, r = 4, rc = 0);", "hyperboloid(base = [4, 3, -4], axis = [1, 0, 0], r = 4, h = 2, rc = 0);",
   "hyperboloid(base = [4, 3, -4], axis = [-2, 0, 0], r = 4, h = 2, rc = 0);", 0, false, ROWS(double_cone_rows)},
  {"saddle in a box", "intersection() { saddle(2, 1); translate([-4, -2, -3]) cube([8, 4, 6]); }", 0, 0, 0, false, ROWS(saddle_rows)},
  {"saddle in a cylinder", "intersection() { saddle(2, 1); cylinder(h = 6, r = 3, center = true); }", 0, 0, 0, false,
   ROWS(saddle_in_cylinder_rows)},
  {"parabolic cylinder", "intersection() { quadric([1, 0, 0, 0, 0, 0, 0, 0, -1, 0]); translate([-5, -1, -1]) cube([10, 2, 5]); }", 0, 0, 0, false,
   ROWS(parabolic_cylinder_rows)},
  {"hyperbolic cylinder", "intersection() { quadric([1, 0, -1, 0, 0, 0, 0, 0, 0, -9]); translate([-8, -1, -4]) cube([16, 2, 8]); }", 0, 0, 0, false,
   ROWS(hyperbolic_cylinder_rows)},
  {"hyperbolic cylinder, its outside", "intersection() { quadric([-1, 0, 1, 0, 0, 0, 0, 0, 0, 9]); translate([-8, -1, -4]) cube([16, 2, 8]); }", 0, 0, 0,
   false, ROWS(two_branches_rows)},
  {"quadric of ten coefficients", "quadric([1, 1, 1, 0, 0, 0, -2, 0, 0, -24]);", 0, 0, 0, false, ROWS(quadric_rows)},
  {"quadric of a matrix", "quadric(matrix = [[1, 0, 0, -1], [0, 1, 0, 0], [0, 0, 1, 0], [-1, 0, 0, -24]]);", 0, 0, 0, false, ROWS(quadric_rows)},
  {"quadric with a mixed term", "quadric([0, 0, 0, 1, 0, 0, 0, 0, 0, -1]);", 0, 0, 0, false, ROWS(mixed_rows)},
  {"quadric without interior", "quadric([1, 0, 0, 0, 0, 0, 0, 0, 0, 0]);", 0, 0, 0, false, ROWS(flat_rows)},
  {"half-space", "halfspace([1, 2, 2], 3);", 0, 0, 0, false, ROWS(halfspace_rows)},
  {"cube", "cube([4, 2, 6]);", 0, 0, 0, false, ROWS(cube_rows)},
  {"wedge", "wedge([4, 2, 4]);", 0, 0, 0, false, ROWS(wedge_rows)},
  {"prism", "cylinder(h = 2, r = 2, $fn = 4);", 0, 0, 0, false, ROWS(prism_rows)},
  {"convex polyhedron", "polyhedron(points = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]], faces = [[0, 2, 3], [0, 3, 1], [0, 1, 2], [1, 3, 2]]);", 0, 0, 0,
   false, ROWS(polyhedron_rows)},
  {"superquadric", "superquadric(r = [5, 3, 2], e = 1, n = 1);", 0, 0, 0, true, ROWS(super_ellipsoid_rows)},
  {"superquadric", "superquadric(r = [2, 2, 2], e = 2, n = 2);", 0, 0, 0, true, ROWS(super_octahedron_rows)},
  {"superquadric", "superquadric(r = [2, 1, 1], e = 0, n = 0);", 0, 0, 0, true, ROWS(super_box_rows)},
  {"superquadric", "superquadric(r = [5, 5, 2], e = 1, n = 0);", 0, 0, 0, true, ROWS(super_cylinder_rows)},
  {"superquadric", "superquadric(r = [5, 5, 5], e = 0, n = 1);", 0, 0, 0, true, ROWS(super_prism_rows)},
  {"superquadric", "superquadric(r = [2, 2, 2], e = 0.5, n = 0.5);", 0, 0, 0, true, ROWS(super_general_rows)},
};

#endif
