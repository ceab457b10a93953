/* The superquadric's inside-outside function, its gradient and its sign. See super.h for the letters.

   One step, N(a, b) = (a^p + b^p)^(1/p) for a >= b >= 0: t = b/a, w = t^p, N = a (1 + w)^(e/2); nothing overflows that N does
   not. Its
   derivatives cost nothing more: dN/da = N / (a (1 + w)), dN/db = (w/t) dN/da. */
#include "shape/super.h"
#include "shape/outward.h"
#include "shape/prim.h"

#include <float.h>

/* Below this e the factor (1 + w)^(e/2) <= 2^(e/2) is 1 within u: the limit is taken. */
static const double least_exponent = QN_U;

qn_super qn_super_make(double e, double n) { return (qn_super){e, n, e > 0 ? 2 / e : INFINITY, n > 0 ? 2 / n : INFINITY}; }

/* N(a, b), dN/da, dN/db for a, b >= 0; *open: underflow spoilt it. */
static double pair_norm(double e, double p, double a, double b, double *da, double *db, int *open) {
  double big = a > b ? a : b, small = a > b ? b : a, d_big = 1, d_small = 0, norm = big;
  if (!(big > 0)) {
    *da = *db = 0;
    return 0;
  }
  if (e < least_exponent) {
    d_big = small == big ? 0.5 : 1; /* an edge: the mean of both normals */
    d_small = 1 - d_big;
  } else if (small == 0 && p != 1) {
    d_small = 0; /* p < 1: infinite on both sides, of opposite signs */
  } else if (p == 1) {
    norm = big + small;
    d_small = 1;
  } else {
    double t = small / big, w;
    *open |= t < QN_SUPER_RATIO && pow(fmax(t, DBL_TRUE_MIN), p) > QN_U * QN_U;
    if (p == 2) {
      w = t * t;
      norm = big * sqrt(1 + w);
    } else {
      w = pow(t, p);
      norm = big * pow(1 + w, 0.5 * e);
    }
    d_big = norm / big / (1 + w);
    d_small = t > 0 ? w / t * d_big : 0;
  }
  *da = a >= b ? d_big : d_small;
  *db = a >= b ? d_small : d_big;
  return norm;
}

double qn_super_norm(const qn_super *s, const double X[3], double g[3], double *error) {
  double x = fabs(X[0]), y = fabs(X[1]), z = fabs(X[2]), dx, dy, dr, dz;
  int open = 0;
  double rho = pair_norm(s->e, s->p, x, y, &dx, &dy, &open);
  double norm = pair_norm(s->n, s->q, rho, z, &dr, &dz, &open);
  g[0] = x > 0 ? copysign(dr * dx, X[0]) : 0;
  g[1] = y > 0 ? copysign(dr * dy, X[1]) : 0;
  g[2] = z > 0 ? copysign(dz, X[2]) : 0;
  *error = open ? INFINITY : QN_SUPER_NORM(s->e, s->n) * norm;
  return norm;
}

double qn_super_slope(double e, double p, double r) {
  if (p == 1) {
    return 1;
  }
  if (e < least_exponent) {
    return r < 1 ? 1 : 0;
  }
  if (r > 1) { /* (1 + r^p)^(1/p - 1) = r^(1 - p) (1 + r^-p)^(1/p - 1) */
    return pow(r, 1 - p) * pow(1 + pow(1 / r, p), 0.5 * e - 1);
  }
  return pow(1 + pow(r, p), 0.5 * e - 1);
}

double qn_superquadric_value(double e, double n, const double X[3], double *error) {
  qn_super s = qn_super_make(e, n);
  double g[3], bound, norm = qn_super_norm(&s, X, g, &bound);
  if (n < least_exponent && n > 0) { /* f is G^q with q beyond 2^54: 0 or infinite but next to the surface */
    *error = norm > 1 ? 0 : 0.5; /* below 1 by 10u and more: f <= exp(-20) */
    if (fabs(norm - 1) <= bound) {
      *error = INFINITY;
    }
    return norm > 1 ? INFINITY : -1;
  }
  if (n == 0) {
    *error = bound + QN_U * fabs(norm - 1);
    return norm - 1;
  }
  double f = pow(norm, s.q);
  /* f moves by q times the relative error of G and by |ln f| times that of q (2u); pow adds 2u, the last difference u. */
  double relative = s.q * bound / norm + (f > 0 && f < INFINITY ? 2 * QN_U * fabs(log(f)) : 0) + 2 * QN_U;
  if (norm == 0) { /* NOLINT(bugprone-branch-clone): infinity is exact too, but comes after what may not be */
    *error = 0;
  } else if (!(relative < 0.0625)) { /* first order no longer holds */
    *error = INFINITY;
  } else if (f > DBL_MAX) {
    *error = 0;
  } else {
    *error = 1.125 * (relative * f + QN_U * fabs(f - 1)) + DBL_MIN;
  }
  return f - 1;
}

void qn_superquadric_gradient(double e, double n, const double X[3], double g[3]) {
  qn_super s = qn_super_make(e, n);
  double bound;
  qn_super_norm(&s, X, g, &bound);
  int infinite = isinf(g[0]) || isinf(g[1]) || isinf(g[2]);
  for (int i = 0; infinite && i < 3; i++) { /* the infinite ones give the direction */
    g[i] = isinf(g[i]) ? copysign(1, g[i]) : 0;
  }
}

/* --- MPFR --------------------------------------------------------------------------------------------------------- */

void qn_super_mp_init(qn_super_mp *mp, mpfr_prec_t precision) {
  mp->precision = precision;
  mpfr_inits2(precision, mp->e, mp->n, mp->p, mp->q, mp->x[0], mp->x[1], mp->x[2], mp->g[0], mp->g[1], mp->g[2], mp->norm, mp->rho,
              mp->r0, mp->r1, mp->t, mp->w, mp->c, mp->bound, (mpfr_ptr)NULL);
}

void qn_super_mp_free(qn_super_mp *mp) {
  mpfr_clears(mp->e, mp->n, mp->p, mp->q, mp->x[0], mp->x[1], mp->x[2], mp->g[0], mp->g[1], mp->g[2], mp->norm, mp->rho, mp->r0, mp->r1,
              mp->t, mp->w, mp->c, mp->bound, (mpfr_ptr)NULL);
  mpfr_free_cache2(MPFR_FREE_LOCAL_CACHE);
}

void qn_super_mp_exponents(qn_super_mp *mp) {
  if (mpfr_sgn(mp->e) > 0) {
    mpfr_ui_div(mp->p, 2, mp->e, MPFR_RNDN);
  }
  if (mpfr_sgn(mp->n) > 0) {
    mpfr_ui_div(mp->q, 2, mp->n, MPFR_RNDN);
  }
}

/* norm = N(a, b), da, db; a, b >= 0 are kept. Uses t, w, c. */
static void mp_pair(qn_super_mp *mp, mpfr_t e, mpfr_t p, mpfr_t a, mpfr_t b, mpfr_t norm, mpfr_t da, mpfr_t db) {
  int a_big = mpfr_cmp(a, b) >= 0;
  mpfr_ptr big = a_big ? a : b, small = a_big ? b : a, d_big = a_big ? da : db, d_small = a_big ? db : da;
  if (mpfr_sgn(e) == 0 || mpfr_sgn(small) == 0) {
    int tie = mpfr_sgn(e) == 0 && mpfr_sgn(big) > 0 && mpfr_equal_p(a, b);
    mpfr_set_d(d_big, tie ? 0.5 : 1, MPFR_RNDN);
    mpfr_set_d(d_small, tie ? 0.5 : 0, MPFR_RNDN);
    mpfr_set(norm, big, MPFR_RNDN);
    return;
  }
  mpfr_div(mp->t, small, big, MPFR_RNDN);
  mpfr_pow(mp->w, mp->t, p, MPFR_RNDN);
  mpfr_div(d_small, mp->w, mp->t, MPFR_RNDN);
  mpfr_add_ui(mp->w, mp->w, 1, MPFR_RNDN);
  mpfr_div_2ui(mp->c, e, 1, MPFR_RNDN);
  mpfr_pow(mp->c, mp->w, mp->c, MPFR_RNDN);
  mpfr_div(d_big, mp->c, mp->w, MPFR_RNDN);
  mpfr_mul(d_small, d_small, d_big, MPFR_RNDN);
  mpfr_mul(norm, big, mp->c, MPFR_RNDN);
}

int qn_super_mp_sign(qn_super_mp *mp) {
  int sign[3];
  for (int i = 0; i < 3; i++) {
    sign[i] = mpfr_sgn(mp->x[i]);
    mpfr_abs(mp->x[i], mp->x[i], MPFR_RNDN);
  }
  mp_pair(mp, mp->e, mp->p, mp->x[0], mp->x[1], mp->rho, mp->g[0], mp->g[1]);
  mp_pair(mp, mp->n, mp->q, mp->rho, mp->x[2], mp->norm, mp->r0, mp->g[2]);
  mpfr_mul(mp->g[0], mp->g[0], mp->r0, MPFR_RNDN);
  mpfr_mul(mp->g[1], mp->g[1], mp->r0, MPFR_RNDN);
  for (int i = 0; i < 3; i++) {
    mpfr_mul_si(mp->g[i], mp->g[i], sign[i], MPFR_RNDN);
  }
  if (mpfr_inf_p(mp->norm)) {
    return 1;
  }
  if (mpfr_nan_p(mp->norm)) {
    return 0;
  }
  /* (10 + 2e + 2n) 2^-precision norm, doubled for the bound's own rounding */
  mpfr_add(mp->bound, mp->e, mp->n, MPFR_RNDU);
  mpfr_mul_2ui(mp->bound, mp->bound, 1, MPFR_RNDU);
  mpfr_add_ui(mp->bound, mp->bound, 10, MPFR_RNDU);
  mpfr_mul(mp->bound, mp->bound, mp->norm, MPFR_RNDU);
  mpfr_div_2ui(mp->bound, mp->bound, (unsigned long)mp->precision - 1, MPFR_RNDU);
  mpfr_sub_ui(mp->c, mp->norm, 1, MPFR_RNDN);
  return mpfr_cmpabs(mp->c, mp->bound) > 0 ? mpfr_sgn(mp->c) : 0;
}

void qn_super_mp_set(qn_ctx *ctx, mpfr_t out, qn_num a) {
  qn_rat r = qn_num_rat(ctx, a);
  mpz_t num, den;
  mpz_roinit_n(num, r.num.d, r.num.n);
  mpz_roinit_n(den, r.den.d, r.den.n);
  mpq_t q; /* a view: nothing of it is freed; reduced, as qn_rat is */
  *mpq_numref(q) = *num;
  *mpq_denref(q) = *den;
  mpfr_set_q(out, q, MPFR_RNDN);
}

int qn_superquadric_sign(qn_ctx *ctx, qn_num e, qn_num n, const qn_num X[3]) {
  int sign = 0;
  for (mpfr_prec_t precision = QN_S2_PRECISION / 4; precision <= QN_S2_PRECISION && sign == 0; precision *= 2) {
    qn_super_mp mp;
    qn_super_mp_init(&mp, precision);
    qn_super_mp_set(ctx, mp.e, e);
    qn_super_mp_set(ctx, mp.n, n);
    qn_super_mp_exponents(&mp);
    for (int i = 0; i < 3; i++) {
      qn_super_mp_set(ctx, mp.x[i], X[i]);
    }
    if (!ctx->failed) {
      sign = qn_super_mp_sign(&mp);
    }
    qn_super_mp_free(&mp);
  }
  return ctx->failed ? 0 : sign;
}
