/* Every error bound: its name, its constant, its inequality. Derivations: docs/bounds.md, under the same names; tests:
   tests/ray/test_bounds.c, under the same names, in rationals. No other tolerance stands anywhere in the code. */
#ifndef QN_BASE_BOUNDS_H
#define QN_BASE_BOUNDS_H

#define QN_U 0x1p-53 /* unit roundoff, round to nearest */

#endif
