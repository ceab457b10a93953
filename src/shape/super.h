/* The superquadric's norm, shared by its value, its sign and its roots.

   Legend: p = 2/e, q = 2/n; rho = (|x|^p + |y|^p)^(1/p); G = (rho^q + |z|^q)^(1/q), limits at e = 0 or n = 0 maxima. Barr's
   inside-outside
   function is f = (|x|^p + |y|^p)^(e/n) + |z|^q = G^q, so f - 1 and G - 1 have one sign; G is homogeneous of degree 1, which
   keeps its
   rounding error apart from q (docs/bounds.md, QN_SUPER_NORM). */
#ifndef QN_SHAPE_SUPER_H
#define QN_SHAPE_SUPER_H

#include "base/bounds.h"
#include "number/num.h"

#include <mpfr.h>

typedef struct qn_super { double e, n, p, q; } qn_super;
qn_super qn_super_make(double e, double n);

/* G at X and dG/dX. Relative error of G at most QN_SUPER_NORM(e, n), infinite bound (*error) where that cannot be vouched for. A
   component of
   the gradient that is infinite or undefined on a coordinate plane is 0 there (the mean of both sides). */
double qn_super_norm(const qn_super *s, const double X[3], double g[3], double *error);

/* phi(r) = d (a^p + b^p)^(1/p) / da at b/a = r, p = 2/e: (1 + r^p)^(1/p - 1), r in [0, inf]. Decreasing for p > 1, increasing for
   p < 1. */
double qn_super_slope(double e, double p, double r);

/* The same norm in MPFR. Exponents are set once; then signs are taken at points. */
typedef struct qn_super_mp {
  mpfr_t e, n, p, q;      /* e, n >= 0; p, q set when they are > 0 */
  mpfr_t x[3], g[3], norm, rho, r0, r1, t, w, c, bound;
  mpfr_prec_t precision;
} qn_super_mp;
void qn_super_mp_init(qn_super_mp *mp, mpfr_prec_t precision);
void qn_super_mp_free(qn_super_mp *mp);
void qn_super_mp_exponents(qn_super_mp *mp); /* after e and n were set */
/* The sign of G - 1 at mp->x, each rounded to nearest from the exact; 0 when the bound leaves it open. Fills norm and g (dG/dx,
   as above). */
int qn_super_mp_sign(qn_super_mp *mp);

/* An exact number, rounded to nearest. */
void qn_super_mp_set(qn_ctx *ctx, mpfr_t out, qn_num a);

#endif
