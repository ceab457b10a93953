/* The general quadric, brought to the diagonal form by Lagrange's reduction: a rational congruence with the square completed,
   exact.

   Legend: q = sum m_ij y_i y_j + 2 sum g_i y_i + j over the variables that are left; each y_i is a linear form in x, y, z (row i of
   `form`), at first x, y, z themselves.

   A variable with m_ii not 0:  m_ii (y_i + (sum_k m_ik y_k + g_i) / m_ii)^2 takes y_i out, and leaves
       m_kl - m_ik m_il / m_ii,   g_k - m_ik g_i / m_ii,   j - g_i^2 / m_ii.
   The diagonal all small against some m_ab: y_a = s + t, y_b = s - t, s = (y_a + y_b)/2, t = (y_a - y_b)/2, gives m_ss = m_aa +
   m_bb + 2 m_ab and
   m_tt = m_aa + m_bb - 2 m_ab, one of which is at least 2 |m_ab| - |m_aa + m_bb|. Small means below 16/25 of |m_ab| (about
   (1 + sqrt 17)/8, Bunch and Parlett's choice), so that the reduction is tame in the doubles made of it, too.
   When no quadratic part is left, the rest is 2 g.y + j: with g not 0 it is 2 l X2, l = 1, X2 = g.y + j/2; row 2 is free then,
   since
   at most two squares were made. Without squares it is the plane 2 g.y + j itself. */
#include "shape/exact.h"
#include "shape/rows.h"

typedef struct reduction {
  qn_num m[3][3], g[3], j;
  qn_num form[3][3]; /* y_i = form[i] . (x, y, z) */
  int left[3];       /* y_i is still there */
} reduction;

static void start(qn_ctx *ctx, const qn_num q[10], reduction *r) {
  static const int mixed[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  *r = (reduction){.j = q[9], .left = {1, 1, 1}};
  for (int i = 0; i < 3; i++) {
    int a = mixed[i][0], b = mixed[i][1];
    r->m[i][i] = q[i];
    r->m[a][b] = r->m[b][a] = half(ctx, q[3 + i]);
    r->g[i] = half(ctx, q[6 + i]);
    r->form[i][i] = QN_NUM_ONE;
  }
}

/* The largest |m_ii| and the largest |m_ab|, a < b, of what is left; -1 where all are 0. */
static void largest(qn_ctx *ctx, const reduction *r, int *diagonal, int *a, int *b) {
  *diagonal = *a = *b = -1;
  for (int i = 0; i < 3; i++) {
    for (int k = i; k < 3; k++) {
      if (!r->left[i] || !r->left[k] || qn_num_is_zero(r->m[i][k])) {
        continue;
      }
      qn_num size = qn_num_abs(ctx, r->m[i][k]);
      if (i == k) {
        if (*diagonal < 0 || qn_num_cmp(ctx, size, qn_num_abs(ctx, r->m[*diagonal][*diagonal])) > 0) {
          *diagonal = i;
        }
      } else if (*a < 0 || qn_num_cmp(ctx, size, qn_num_abs(ctx, r->m[*a][*b])) > 0) {
        *a = i;
        *b = k;
      }
    }
  }
}

static void turn_pair(qn_ctx *ctx, reduction *r, int a, int b) {
  qn_num maa = r->m[a][a], mbb = r->m[b][b], mab2 = add(ctx, r->m[a][b], r->m[a][b]), sum = add(ctx, maa, mbb);
  r->m[a][a] = add(ctx, sum, mab2);
  r->m[b][b] = sub(ctx, sum, mab2);
  r->m[a][b] = r->m[b][a] = sub(ctx, maa, mbb);
  int c = 3 - a - b;
  qn_num mac = r->m[a][c], mbc = r->m[b][c], ga = r->g[a], gb = r->g[b];
  r->m[a][c] = r->m[c][a] = add(ctx, mac, mbc);
  r->m[b][c] = r->m[c][b] = sub(ctx, mac, mbc);
  r->g[a] = add(ctx, ga, gb);
  r->g[b] = sub(ctx, ga, gb);
  for (int i = 0; i < 3; i++) {
    qn_num fa = r->form[a][i], fb = r->form[b][i];
    r->form[a][i] = half(ctx, add(ctx, fa, fb));
    r->form[b][i] = half(ctx, sub(ctx, fa, fb));
  }
}

/* row = sum of c_k form_k over the variables left, with a constant */
static void combine(qn_ctx *ctx, const reduction *r, const qn_num c[3], qn_num constant, qn_num row[4]) {
  for (int i = 0; i < 3; i++) {
    qn_num column[3] = {r->form[0][i], r->form[1][i], r->form[2][i]};
    row[i] = qn_num_dot(ctx, 3, c, column);
  }
  row[3] = constant;
}

static void take_square(qn_ctx *ctx, reduction *r, int i, qn_half_form *out, int slot) {
  qn_num pivot = r->m[i][i], share[3] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO};
  qn_num shift = qn_num_div(ctx, r->g[i], pivot);
  for (int k = 0; k < 3; k++) {
    if (r->left[k]) {
      share[k] = k == i ? QN_NUM_ONE : qn_num_div(ctx, r->m[i][k], pivot);
    }
  }
  combine(ctx, r, share, shift, out->row[slot]);
  out->s[slot] = pivot;
  r->left[i] = 0;
  for (int k = 0; k < 3; k++) {
    if (!r->left[k] || qn_num_is_zero(r->m[i][k])) {
      continue;
    }
    for (int l = k; l < 3; l++) {
      if (r->left[l]) {
        r->m[k][l] = r->m[l][k] = sub(ctx, r->m[k][l], mul(ctx, share[k], r->m[i][l]));
      }
    }
    r->g[k] = sub(ctx, r->g[k], mul(ctx, share[k], r->g[i]));
  }
  r->j = sub(ctx, r->j, mul(ctx, shift, r->g[i]));
}

qn_form_result qn_quadric_diagonal(qn_ctx *ctx, const qn_num q[10], qn_half_form *out) {
  reduction r;
  start(ctx, q, &r);
  *out = (qn_half_form){.kind = QN_QUADRIC_BODY, .role = QUOIN_BODY};
  const qn_num tame = qn_num_div(ctx, qn_num_from_int(ctx, 16), qn_num_from_int(ctx, 25));
  int squares = 0;
  while (squares < 3) {
    int diagonal, a, b;
    largest(ctx, &r, &diagonal, &a, &b);
    if (diagonal < 0 && a < 0) {
      break;
    }
    if (a >= 0 && (diagonal < 0 || qn_num_cmp(ctx, qn_num_abs(ctx, r.m[diagonal][diagonal]),
                                              mul(ctx, tame, qn_num_abs(ctx, r.m[a][b]))) < 0)) {
      turn_pair(ctx, &r, a, b);
      largest(ctx, &r, &diagonal, &a, &b);
      if (diagonal < 0) { /* memory ran out: sums are zero */
        break;
      }
    }
    take_square(ctx, &r, diagonal, out, squares++);
  }
  qn_num g[3];
  int linear = 0;
  for (int i = 0; i < 3; i++) {
    g[i] = r.left[i] ? r.g[i] : QN_NUM_ZERO;
    linear |= !qn_num_is_zero(g[i]);
  }
  if (linear && squares == 0) {
    *out = (qn_half_form){.kind = QN_PLANE, .role = QUOIN_BODY, .row = {{q[6], q[7], q[8], q[9]}}};
    return QN_FORM_OK;
  }
  if (linear) {
    combine(ctx, &r, g, half(ctx, r.j), out->row[2]);
    out->l = QN_NUM_ONE;
    return QN_FORM_OK;
  }
  out->k = r.j;
  int up = 0, down = 0, k = qn_num_sign(r.j);
  for (int i = 0; i < squares; i++) {
    up |= qn_num_sign(out->s[i]) > 0;
    down |= qn_num_sign(out->s[i]) < 0;
  }
  if (!up && k <= 0) {
    return QN_FORM_ALL; /* but for a lower-dimensional set at most, q < 0 */
  }
  return !down && k >= 0 ? QN_FORM_EMPTY : QN_FORM_OK;
}

qn_form_result qn_quadric_form(qn_ctx *ctx, const qn_num *args, size_t n, const qn_placement *placement, qn_half_form **halves,
                               size_t *count) {
  (void)n, (void)placement;
  *count = 0;
  qn_half_form *h = qn_halves_new(ctx, 1);
  if (!h) {
    return QN_FORM_EMPTY;
  }
  qn_form_result result = qn_quadric_diagonal(ctx, args, h);
  *halves = h;
  *count = result == QN_FORM_OK;
  return result;
}
