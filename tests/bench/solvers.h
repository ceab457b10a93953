/* One quadric against one line: the ways that are compared, the cases they are compared on, and the truth.

   A case: the canonical quadric q(X) = s0 X0^2 + s1 X1^2 + s2 X2^2 + 2 l X2 + k placed by x = M X + p, and the line o + t d. All numbers are
   doubles and mean themselves; the truth is taken from them in rationals. Constants that a way prepares once for each solid (M's inverse, the
   expanded matrix) are given to it rounded correctly, which no textbook's code achieves: the errors seen are those of the solving alone. */
#ifndef BENCH_SOLVERS_H
#define BENCH_SOLVERS_H

#include "number/dd.h"

#include <gmp.h>
#include <mpfr.h>
#include <stddef.h>

typedef struct placed {
  double M[3][3], p[3], s[3], l, k;
} placed;

typedef struct solver_case {
  placed solid, partner; /* partner: a like solid, moved a little along the line; for orders */
  double o[3], d[3];
} solver_case;

/* What ways prepare once for a solid. */
typedef struct prepared {
  double world[10];                 /* q(x) = sum, order of xx yy zz xy xz yz x y z 1 with the mixed ones counted once */
  double A[3][3], b[3];             /* X = A x + b */
  double p[3], s[3], l, k;          /* X = A (x - p) */
  qn_dd Ad[3][3];
} prepared;

/* count: 0, 1 (touching, or one root) or 2; t ascending, t + rest where a way knows more than a double. */
typedef struct solved_roots {
  int count;
  double t[2], rest[2];
} solved_roots;

typedef struct truth {
  int count;
  mpfr_t t[2]; /* 600 bits */
} truth;

/* --- families.c --- */
typedef struct family { const char *name; int (*make)(uint64_t *state, int kind, solver_case *out); } family;
extern const family FAMILIES[];
extern const size_t FAMILY_COUNT;
enum { KINDS = 6 };

/* --- truth.c --- */
void prepare(const placed *solid, prepared *out);
void truth_init(truth *t);
void truth_clear(truth *t);
void truth_of(const placed *solid, const double o[3], const double d[3], truth *out);
int truth_order(const truth *a, const truth *b); /* of the first roots; equal within 2^-400 is equal */
double truth_ulps(const truth *t, int which, double value); /* |value - root| in ulps of the root */

/* --- textbook.c --- */
typedef solved_roots (*solve_fn)(const prepared *solid, const double o[3], const double d[3]);
solved_roots solve_world(const prepared *solid, const double o[3], const double d[3]);
solved_roots solve_textbook(const prepared *solid, const double o[3], const double d[3]);
solved_roots solve_stable(const prepared *solid, const double o[3], const double d[3]);
solved_roots solve_shifted(const prepared *solid, const double o[3], const double d[3]);
solved_roots solve_dd(const prepared *solid, const double o[3], const double d[3]);

/* --- solve_quoin.c: the library's own, over a scene of all solids of a family --- */
typedef struct library library;
library *library_new(size_t n, const solver_case *cases); /* null on failure */
void library_free(library *lib);
/* Case i. rounded: t correctly rounded, else as the decisions take it. exact: the line's direction is given times 2^70, which takes every
   decision to exact arithmetic; t is scaled back. */
solved_roots library_solve(library *lib, size_t i, int rounded, int exact);
int library_order(library *lib, size_t i, int exact); /* of the first roots of solid and partner; 2: one of them has none */
/* Surfaces solved exactly since the last call, and roots rounded exactly. */
void library_exact(library *lib, double *solved, double *rounded);

#endif
