/* The truth in rationals: with X = adj(M) (x - p) / det M, the form det^2 q is a polynomial in the doubles given. Roots to 600 bits. */
#include "solvers.h"

#include <math.h>

enum { BITS = 600, SAME = 400 };
#define RN MPFR_RNDN

typedef struct exact_solid { mpq_t adj[3][3], det, p[3], s[3], l, k; } exact_solid;

static void exact_init(exact_solid *e) {
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      mpq_init(e->adj[i][j]);
    }
    mpq_inits(e->p[i], e->s[i], NULL);
  }
  mpq_inits(e->det, e->l, e->k, NULL);
}
static void exact_clear(exact_solid *e) {
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      mpq_clear(e->adj[i][j]);
    }
    mpq_clears(e->p[i], e->s[i], NULL);
  }
  mpq_clears(e->det, e->l, e->k, NULL);
}

static void exact_of(const placed *solid, exact_solid *e) {
  mpq_t m[3][3], t, u;
  mpq_inits(t, u, NULL);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      mpq_init(m[i][j]);
      mpq_set_d(m[i][j], solid->M[i][j]);
    }
    mpq_set_d(e->p[i], solid->p[i]);
    mpq_set_d(e->s[i], solid->s[i]);
  }
  mpq_set_d(e->l, solid->l);
  mpq_set_d(e->k, solid->k);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      int r0 = (j + 1) % 3, r1 = (j + 2) % 3, c0 = (i + 1) % 3, c1 = (i + 2) % 3;
      mpq_mul(t, m[r0][c0], m[r1][c1]);
      mpq_mul(u, m[r0][c1], m[r1][c0]);
      mpq_sub(e->adj[i][j], t, u);
    }
  }
  mpq_set_ui(e->det, 0, 1);
  for (int j = 0; j < 3; j++) {
    mpq_mul(t, m[j][0], e->adj[0][j]);
    mpq_add(e->det, e->det, t);
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      mpq_clear(m[i][j]);
    }
  }
  mpq_clears(t, u, NULL);
}

/* row . v */
static void apply(mpq_t row[3], mpq_t v[3], mpq_t out, mpq_t t) {
  mpq_mul(out, row[0], v[0]);
  mpq_mul(t, row[1], v[1]);
  mpq_add(out, out, t);
  mpq_mul(t, row[2], v[2]);
  mpq_add(out, out, t);
}

void truth_init(truth *t) {
  t->count = 0;
  mpfr_init2(t->t[0], BITS);
  mpfr_init2(t->t[1], BITS);
}
void truth_clear(truth *t) {
  mpfr_clears(t->t[0], t->t[1], (mpfr_ptr)0);
}

static void quotient(mpfr_t out, mpq_t num, mpq_t den, mpq_t t) {
  mpq_div(t, num, den);
  mpfr_set_q(out, t, RN);
}

/* Roots of a t^2 + 2 h t + c. */
static void roots_of(mpq_t a, mpq_t h, mpq_t c, truth *out) {
  mpq_t disc, t;
  mpq_inits(disc, t, NULL);
  mpq_mul(disc, h, h);
  mpq_mul(t, a, c);
  mpq_sub(disc, disc, t);
  out->count = 0;
  if (mpq_sgn(a) == 0) {
    if (mpq_sgn(h) != 0) {
      out->count = 1;
      mpq_neg(disc, c);
      mpq_add(t, h, h);
      mpq_div(t, disc, t);
      mpfr_set_q(out->t[0], t, RN);
      mpfr_set(out->t[1], out->t[0], RN);
    }
  } else if (mpq_sgn(disc) == 0) {
    out->count = 1;
    mpq_neg(disc, h);
    quotient(out->t[0], disc, a, t);
    mpfr_set(out->t[1], out->t[0], RN);
  } else if (mpq_sgn(disc) > 0) {
    out->count = 2;
    mpfr_t root, q;
    mpfr_inits2(2 * BITS, root, q, (mpfr_ptr)0);
    mpfr_set_q(root, disc, RN);
    mpfr_sqrt(root, root, RN);
    mpfr_set_q(q, h, RN);
    if (mpq_sgn(h) < 0) {
      mpfr_sub(q, q, root, RN);
    } else {
      mpfr_add(q, q, root, RN);
    }
    mpfr_neg(q, q, RN);
    mpfr_div_q(out->t[0], q, a, RN);
    mpfr_set_q(root, c, RN);
    mpfr_div(out->t[1], root, q, RN);
    if (mpfr_cmp(out->t[0], out->t[1]) > 0) {
      mpfr_swap(out->t[0], out->t[1]);
    }
    mpfr_clears(root, q, (mpfr_ptr)0);
  }
  mpq_clears(disc, t, NULL);
}

void truth_of(const placed *solid, const double o[3], const double d[3], truth *out) {
  exact_solid e;
  mpq_t y[3], D[3], O, V, t, a, h, c;
  exact_init(&e);
  exact_of(solid, &e);
  mpq_inits(O, V, t, a, h, c, NULL);
  for (int i = 0; i < 3; i++) {
    mpq_inits(y[i], D[i], NULL);
    mpq_set_d(y[i], o[i]);
    mpq_sub(y[i], y[i], e.p[i]);
    mpq_set_d(D[i], d[i]);
  }
  mpq_mul(c, e.k, e.det);
  mpq_mul(c, c, e.det);
  for (int i = 0; i < 3; i++) {
    apply(e.adj[i], y, O, t);
    apply(e.adj[i], D, V, t);
    mpq_mul(t, V, V);
    mpq_mul(t, t, e.s[i]);
    mpq_add(a, a, t);
    mpq_mul(t, O, V);
    mpq_mul(t, t, e.s[i]);
    mpq_add(h, h, t);
    mpq_mul(t, O, O);
    mpq_mul(t, t, e.s[i]);
    mpq_add(c, c, t);
    if (i == 2) {
      mpq_mul(t, V, e.l);
      mpq_mul(t, t, e.det);
      mpq_add(h, h, t);
      mpq_mul(t, O, e.l);
      mpq_mul(t, t, e.det);
      mpq_add(c, c, t);
      mpq_add(c, c, t);
    }
  }
  roots_of(a, h, c, out);
  for (int i = 0; i < 3; i++) {
    mpq_clears(y[i], D[i], NULL);
  }
  mpq_clears(O, V, t, a, h, c, NULL);
  exact_clear(&e);
}

int truth_order(const truth *a, const truth *b) {
  mpfr_t gap;
  mpfr_init2(gap, BITS);
  mpfr_sub(gap, a->t[0], b->t[0], RN);
  int sign = mpfr_sgn(gap);
  if (sign && !mpfr_zero_p(a->t[0]) && mpfr_get_exp(gap) < mpfr_get_exp(a->t[0]) - SAME) {
    sign = 0;
  }
  mpfr_clear(gap);
  return sign;
}

double truth_ulps(const truth *t, int which, double value) {
  mpfr_t gap;
  mpfr_init2(gap, BITS);
  mpfr_sub_d(gap, t->t[which], value, RN);
  double error = mpfr_get_d(gap, RN), size = fabs(mpfr_get_d(t->t[which], RN)), ulp;
  int exponent;
  frexp(size, &exponent);
  ulp = size == 0 ? 0x1p-1074 : ldexp(1, exponent - 53);
  mpfr_clear(gap);
  return fabs(error) / ulp;
}

static double rounded(mpq_t a) { /* mpq_get_d truncates */
  mpfr_t t;
  mpfr_init2(t, 53);
  mpfr_set_q(t, a, RN);
  double d = mpfr_get_d(t, RN);
  mpfr_clear(t);
  return d;
}

void prepare(const placed *solid, prepared *out) {
  exact_solid e;
  mpq_t A[3][4], t, u, w[10];
  static const int PAIR[10][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}, {3, 3}};
  exact_init(&e);
  exact_of(solid, &e);
  mpq_inits(t, u, NULL);
  for (int i = 0; i < 3; i++) {
    mpq_init(A[i][3]);
    for (int j = 0; j < 3; j++) {
      mpq_init(A[i][j]);
      mpq_div(A[i][j], e.adj[i][j], e.det);
      out->A[i][j] = rounded(A[i][j]);
      mpq_set_d(t, out->A[i][j]);
      mpq_sub(t, A[i][j], t);
      out->Ad[i][j] = (qn_dd){out->A[i][j], rounded(t)};
      mpq_mul(t, A[i][j], e.p[j]);
      mpq_sub(A[i][3], A[i][3], t);
    }
    out->b[i] = rounded(A[i][3]);
    out->p[i] = solid->p[i];
    out->s[i] = solid->s[i];
  }
  out->l = solid->l;
  out->k = solid->k;
  for (int c = 0; c < 10; c++) {
    int a = PAIR[c][0], b = PAIR[c][1];
    mpq_init(w[c]);
    for (int i = 0; i < 3; i++) {
      mpq_mul(t, A[i][a], A[i][b]);
      mpq_mul(t, t, e.s[i]);
      mpq_add(w[c], w[c], t);
    }
    if (b == 3) { /* l X2 x2 in each of the two halves */
      mpq_mul(t, e.l, A[2][a]);
      mpq_add(w[c], w[c], t);
    }
    if (c == 9) {
      mpq_add(w[c], w[c], t);
      mpq_add(w[c], w[c], e.k);
    } else if (a != b) {
      mpq_add(w[c], w[c], w[c]);
    }
    out->world[c] = rounded(w[c]);
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 4; j++) {
      mpq_clear(A[i][j]);
    }
  }
  for (int c = 0; c < 10; c++) {
    mpq_clear(w[c]);
  }
  mpq_clears(t, u, NULL);
  exact_clear(&e);
}
