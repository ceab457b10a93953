/* The table: one row a primitive. */
#include "shape/rows.h"

#define ROW(name) qn_##name##_form, qn_##name##_support, qn_##name##_uv

const qn_prim_row qn_prims[QN_PRIM_COUNT] = {
  /*                    word            args round bounded faces */
  [QN_SPHERE] =       {"sphere",         1, 1, 1,  1, ROW(sphere)},
  [QN_ELLIPSOID] =    {"ellipsoid",      3, 1, 1,  1, ROW(ellipsoid)},
  [QN_CUBE] =         {"cube",           4, 0, 1,  6, ROW(cube)},
  [QN_CYLINDER] =     {"cylinder",       6, 1, 1,  3, ROW(cylinder)},
  [QN_PRISM] =        {"cylinder",       5, 1, 1, -1, ROW(prism)},
  [QN_PARABOLOID] =   {"paraboloid",     4, 1, 1,  2, ROW(paraboloid)},
  [QN_HYPERBOLOID1] = {"hyperboloid",    3, 1, 1,  3, ROW(hyperboloid1)},
  [QN_HYPERBOLOID2] = {"hyperboloid",    3, 1, 1,  3, ROW(hyperboloid2)},
  [QN_SADDLE] =       {"saddle",         2, 0, 0,  1, ROW(saddle)},
  [QN_QUADRIC] =      {"quadric",       10, 0, 0,  1, ROW(quadric)},
  [QN_HALFSPACE] =    {"halfspace",      4, 0, 0,  1, ROW(halfspace)},
  [QN_WEDGE] =        {"wedge",          4, 0, 1,  5, ROW(wedge)},
  [QN_SUPERQUADRIC] = {"superquadric",   5, 0, 1,  8, ROW(superquadric)},
  [QN_POLYHEDRON] =   {"polyhedron",    -1, 0, 1, -1, ROW(polyhedron)},
};
