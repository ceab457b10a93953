/* The gap of two surfaces, from their exact forms.

   Legend: a plane is N.x + d = 0, |N|^2 = p. A curved surface is q = x'Mx / 2 + g.x + j = 0, M symmetric; y's form is scaled so that both
   have the same M, or there is no gap. w spans the kernel of M where M has rank 2; then g = beta + w (g.w) / w.w.

     planes, parallel      the distance |d1 - d2| / sqrt p
     planes, other         s_i = (N_i.x + d_i) / |N_i| is the signed distance from plane i; the gap is the greatest |s1 - s2| over x's region,
                           which is taken at a corner, or how far the two regions are apart along an axis, if that is more. With A = N1.x + d1,
                           C = N2.x + d2 of one sign there,
                             |s1 - s2| = |A^2 p2 - C^2 p1| / (sqrt p1 sqrt p2 (|A| sqrt p2 + |C| sqrt p1)),
                           whose numerator is rational, so that nothing cancels
     rank 3                centre c = -inverse(M) g, level e = q(c); t = c1 - c2.
                           spheres (M = m I): |t| + |r1 - r2|, r^2 = -2 e / m;  equal levels: |t|;
                           else y's surface is x's, drawn from the centre by s = sqrt(e2 / e1) and moved by t: |t| + |s - 1| rho, rho the greatest
                           distance of a corner of the region from the centre (levels of one sign only)
     rank 2, g.w = 0       the same in the plane across w: cylinders
     rank 2, g.w equal     paraboloids: the distance of the vertices

   |sqrt a - sqrt b| is taken as |a - b| / (sqrt a + sqrt b). */
#include "scene/near.h"

#include <math.h>

typedef struct vec { qn_num v[3]; } vec;
typedef struct form { qn_num m[3][3], j; vec g; } form;

static qn_num dot(qn_ctx *ctx, const vec *a, const vec *b) {
  return qn_num_dot(ctx, 3, a->v, b->v);
}
static qn_num times(qn_ctx *ctx, qn_num a, qn_num b) {
  return qn_num_mul(ctx, a, b);
}
static vec minus(qn_ctx *ctx, const vec *a, const vec *b) {
  vec d;
  for (int i = 0; i < 3; i++) {
    d.v[i] = qn_num_sub(ctx, a->v[i], b->v[i]);
  }
  return d;
}
static qn_num length(qn_ctx *ctx, const vec *a) {
  return qn_num_sqrt(ctx, dot(ctx, a, a));
}
static qn_num number(qn_ctx *ctx, const qn_exact_surface *s, int c) {
  return qn_int_sign(s->q[c]) ? qn_num_from_rat(ctx, s->q[c], qn_int_from(ctx, 1), s->rounded) : QN_NUM_ZERO;
}
/* |sqrt a - sqrt b|, a, b >= 0, one of them not 0 */
static qn_num root_difference(qn_ctx *ctx, qn_num a, qn_num b) {
  qn_num sum = qn_num_add(ctx, qn_num_sqrt(ctx, a), qn_num_sqrt(ctx, b));
  return qn_num_div(ctx, qn_num_abs(ctx, qn_num_sub(ctx, a, b)), sum);
}

static int is_bounded(const qn_region *r) {
  int bounded = 1;
  for (int k = 0; k < 3; k++) {
    bounded &= isfinite(r->min[k]) && isfinite(r->max[k]);
  }
  return bounded;
}
static vec corner(qn_ctx *ctx, const qn_region *r, int which) {
  vec x;
  for (int k = 0; k < 3; k++) {
    x.v[k] = qn_num_from_double(ctx, which >> k & 1 ? r->max[k] : r->min[k]);
  }
  return x;
}

/* --- planes -------------------------------------------------------------------------------------------------------- */

typedef struct plane { vec n; qn_num d, p, root; } plane;

static plane plane_of(qn_ctx *ctx, const qn_exact_surface *s) {
  plane f;
  for (int k = 0; k < 3; k++) {
    f.n.v[k] = number(ctx, s, 6 + k);
  }
  f.d = number(ctx, s, 9);
  f.p = dot(ctx, &f.n, &f.n);
  f.root = qn_num_sqrt(ctx, f.p);
  return f;
}

static qn_num gap_at(qn_ctx *ctx, const plane *x, const plane *y, int turn, const vec *at) {
  qn_num a = qn_num_add(ctx, dot(ctx, &x->n, at), x->d), c = qn_num_add(ctx, dot(ctx, &y->n, at), y->d);
  int opposite = qn_num_sign(a) * qn_num_sign(c) * turn <= 0;
  a = qn_num_abs(ctx, a), c = qn_num_abs(ctx, c);
  if (opposite) {
    return qn_num_add(ctx, qn_num_div(ctx, a, x->root), qn_num_div(ctx, c, y->root));
  }
  qn_num top = qn_num_sub(ctx, times(ctx, times(ctx, a, a), y->p), times(ctx, times(ctx, c, c), x->p));
  qn_num sum = qn_num_add(ctx, times(ctx, a, y->root), times(ctx, c, x->root));
  return qn_num_div(ctx, qn_num_abs(ctx, top), times(ctx, times(ctx, x->root, y->root), sum));
}

static int plane_gap(qn_ctx *ctx, const qn_exact_surface *sx, const qn_exact_surface *sy, const qn_region *own, const qn_region *theirs, qn_num *gap,
                     int *turn) {
  plane x = plane_of(ctx, sx), y = plane_of(ctx, sy);
  vec cross;
  int parallel = 1, largest = 0;
  for (int k = 0; k < 3; k++) {
    int a = (k + 1) % 3, b = (k + 2) % 3;
    qn_num u[2] = {x.n.v[a], qn_num_neg(ctx, x.n.v[b])}, v[2] = {y.n.v[b], y.n.v[a]};
    cross.v[k] = qn_num_dot(ctx, 2, u, v);
    parallel &= qn_num_is_zero(cross.v[k]);
    if (qn_num_cmp(ctx, qn_num_abs(ctx, x.n.v[k]), qn_num_abs(ctx, x.n.v[largest])) > 0) {
      largest = k;
    }
  }
  if (ctx->failed != QUOIN_OK) {
    return 0;
  }
  if (parallel) {
    qn_num factor = qn_num_div(ctx, x.n.v[largest], y.n.v[largest]);
    *turn = qn_num_sign(factor);
    *gap = qn_num_div(ctx, qn_num_abs(ctx, qn_num_sub(ctx, x.d, times(ctx, factor, y.d))), x.root);
    return 1;
  }
  qn_num limit = qn_num_div(ctx, times(ctx, x.p, y.p), qn_num_from_int(ctx, 1 << QN_NEAR_ANGLE));
  if (!is_bounded(own) || qn_num_cmp(ctx, dot(ctx, &cross, &cross), limit) > 0) {
    return 0;
  }
  *turn = qn_num_sign(dot(ctx, &x.n, &y.n));
  *gap = QN_NUM_ZERO;
  for (int i = 0; i < 8; i++) {
    vec at = corner(ctx, own, i);
    qn_num here = gap_at(ctx, &x, &y, *turn, &at);
    *gap = qn_num_cmp(ctx, here, *gap) > 0 ? here : *gap;
  }
  for (int k = 0; k < 3; k++) {
    double low = own->min[k] > theirs->min[k] ? own->min[k] : theirs->min[k], high = own->max[k] < theirs->max[k] ? own->max[k] : theirs->max[k];
    if (low > high) {
      qn_num apart = qn_num_sub(ctx, qn_num_from_double(ctx, low), qn_num_from_double(ctx, high));
      *gap = qn_num_cmp(ctx, apart, *gap) > 0 ? apart : *gap;
    }
  }
  return 1;
}

/* --- curved -------------------------------------------------------------------------------------------------------- */

/* Both forms with the quadratic part of x; 0 when theirs differ. */
static int same_shape(qn_ctx *ctx, const qn_exact_surface *x, const qn_exact_surface *y, form *f, form *h, int *turn) {
  static const int entry[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  qn_num a[10], b[10];
  int largest = 0;
  for (int c = 0; c < 10; c++) {
    a[c] = number(ctx, x, c);
    b[c] = number(ctx, y, c);
    if (c < 6 && qn_num_cmp(ctx, qn_num_abs(ctx, a[c]), qn_num_abs(ctx, a[largest])) > 0) {
      largest = c;
    }
  }
  if (qn_num_is_zero(a[largest]) || qn_num_is_zero(b[largest])) {
    return 0;
  }
  qn_num factor = qn_num_div(ctx, a[largest], b[largest]);
  for (int c = 0; c < 6; c++) {
    if (qn_num_cmp(ctx, a[c], times(ctx, factor, b[c])) != 0) {
      return 0;
    }
  }
  *turn = qn_num_sign(factor);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      f->m[i][j] = i == j ? qn_num_add(ctx, a[i], a[i]) : a[entry[i][j]];
      h->m[i][j] = f->m[i][j];
    }
    f->g.v[i] = a[6 + i];
    h->g.v[i] = times(ctx, factor, b[6 + i]);
  }
  f->j = a[9];
  h->j = times(ctx, factor, b[9]);
  return ctx->failed == QUOIN_OK;
}

static qn_num adjugate(qn_ctx *ctx, qn_num m[3][3], qn_num adj[3][3]) {
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      int r0 = (j + 1) % 3, r1 = (j + 2) % 3, c0 = (i + 1) % 3, c1 = (i + 2) % 3;
      qn_num u[2] = {m[r0][c0], qn_num_neg(ctx, m[r0][c1])}, v[2] = {m[r1][c1], m[r1][c0]};
      adj[i][j] = qn_num_dot(ctx, 2, u, v);
    }
  }
  qn_num column[3] = {adj[0][0], adj[1][0], adj[2][0]};
  return qn_num_dot(ctx, 3, m[0], column);
}

/* -inverse(m) g */
static vec solve(qn_ctx *ctx, qn_num adj[3][3], qn_num det, const vec *g) {
  vec x;
  for (int i = 0; i < 3; i++) {
    x.v[i] = qn_num_neg(ctx, qn_num_div(ctx, qn_num_dot(ctx, 3, adj[i], g->v), det));
  }
  return x;
}

static qn_num level(qn_ctx *ctx, const form *f, const vec *g, const vec *centre) {
  return qn_num_add(ctx, f->j, qn_num_div(ctx, dot(ctx, g, centre), qn_num_from_int(ctx, 2)));
}

/* m = value (I - ww'/w.w), w null for I alone: a sphere, a round cylinder. */
static int is_round(qn_ctx *ctx, qn_num m[3][3], const vec *w, qn_num *value) {
  qn_num trace = qn_num_add(ctx, m[0][0], qn_num_add(ctx, m[1][1], m[2][2])), ww = w ? dot(ctx, w, w) : QN_NUM_ONE;
  *value = qn_num_div(ctx, trace, qn_num_from_int(ctx, w ? 2 : 3));
  int round = 1;
  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++) {
      qn_num want = i == j ? ww : QN_NUM_ZERO;
      want = w ? qn_num_sub(ctx, want, times(ctx, w->v[i], w->v[j])) : want;
      round &= qn_num_cmp(ctx, times(ctx, m[i][j], ww), times(ctx, *value, want)) == 0;
    }
  }
  return round;
}

/* The greatest square of a corner's distance from the centre, across w where it is given. */
static qn_num reach(qn_ctx *ctx, const qn_region *own, const vec *centre, const vec *w) {
  qn_num most = QN_NUM_ZERO;
  for (int i = 0; i < 8; i++) {
    vec at = corner(ctx, own, i), y = minus(ctx, &at, centre);
    qn_num square = dot(ctx, &y, &y);
    if (w) {
      qn_num along = dot(ctx, &y, w);
      square = qn_num_sub(ctx, square, qn_num_div(ctx, times(ctx, along, along), dot(ctx, w, w)));
    }
    most = qn_num_cmp(ctx, square, most) > 0 ? square : most;
  }
  return most;
}

/* The gap of two surfaces of one shape with centres c[] and levels e[]. */
static int central_gap(qn_ctx *ctx, form *f, const vec *w, const vec c[2], const qn_num e[2], const qn_region *own, qn_num *gap) {
  vec t = minus(ctx, &c[0], &c[1]);
  qn_num m;
  *gap = length(ctx, &t);
  if (is_round(ctx, f->m, w, &m)) {
    qn_num minus2 = qn_num_div(ctx, qn_num_from_int(ctx, -2), m), a = times(ctx, minus2, e[0]), b = times(ctx, minus2, e[1]);
    if (qn_num_sign(a) <= 0 || qn_num_sign(b) <= 0) {
      return 0;
    }
    *gap = qn_num_add(ctx, *gap, root_difference(ctx, a, b));
    return 1;
  }
  if (qn_num_cmp(ctx, e[0], e[1]) == 0) {
    return 1;
  }
  if (qn_num_sign(e[0]) * qn_num_sign(e[1]) <= 0 || !is_bounded(own)) {
    return 0;
  }
  qn_num scale = root_difference(ctx, qn_num_div(ctx, e[1], e[0]), QN_NUM_ONE);
  *gap = qn_num_add(ctx, *gap, times(ctx, scale, qn_num_sqrt(ctx, reach(ctx, own, &c[0], w))));
  return 1;
}

static int curved_gap(qn_ctx *ctx, const qn_exact_surface *x, const qn_exact_surface *y, const qn_region *own, qn_num *gap, int *turn) {
  form f[2];
  qn_num adj[3][3], e[2];
  vec c[2];
  if (!same_shape(ctx, x, y, &f[0], &f[1], turn)) {
    return 0;
  }
  qn_num det = adjugate(ctx, f[0].m, adj);
  if (!qn_num_is_zero(det)) {
    for (int i = 0; i < 2; i++) {
      c[i] = solve(ctx, adj, det, &f[i].g);
      e[i] = level(ctx, &f[i], &f[i].g, &c[i]);
    }
    return central_gap(ctx, &f[0], NULL, c, e, own, gap);
  }
  int k = 0; /* adj = ww' up to a factor */
  for (int i = 1; i < 3; i++) {
    k = qn_num_cmp(ctx, qn_num_abs(ctx, adj[i][i]), qn_num_abs(ctx, adj[k][k])) > 0 ? i : k;
  }
  if (qn_num_is_zero(adj[k][k])) {
    return 0; /* rank 1: parabolic cylinders, pairs of parallel planes */
  }
  vec w = {{adj[0][k], adj[1][k], adj[2][k]}};
  qn_num ww = dot(ctx, &w, &w), along[2], filled[3][3], most = QN_NUM_ZERO;
  for (int i = 0; i < 9; i++) {
    qn_num size = qn_num_abs(ctx, f[0].m[i / 3][i % 3]);
    most = qn_num_cmp(ctx, size, most) > 0 ? size : most;
  }
  qn_num share_of_w = qn_num_div(ctx, most, ww); /* of M's size: rounded numbers have 256 bits */
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      filled[i][j] = qn_num_add(ctx, f[0].m[i][j], times(ctx, share_of_w, times(ctx, w.v[i], w.v[j])));
    }
  }
  det = adjugate(ctx, filled, adj);
  for (int i = 0; i < 2; i++) {
    along[i] = dot(ctx, &f[i].g, &w);
    vec beta = f[i].g;
    qn_num share = qn_num_div(ctx, along[i], ww);
    for (int n = 0; n < 3; n++) {
      beta.v[n] = qn_num_sub(ctx, beta.v[n], times(ctx, share, w.v[n]));
    }
    c[i] = solve(ctx, adj, det, &beta);
    e[i] = level(ctx, &f[i], &beta, &c[i]);
  }
  if (qn_num_is_zero(along[0]) && qn_num_is_zero(along[1])) {
    return central_gap(ctx, &f[0], &w, c, e, own, gap);
  }
  if (qn_num_is_zero(along[0]) || qn_num_cmp(ctx, along[0], along[1]) != 0) {
    return 0;
  }
  for (int i = 0; i < 2; i++) { /* q(c + w z) = e + along z */
    qn_num z = qn_num_neg(ctx, qn_num_div(ctx, e[i], along[i]));
    for (int n = 0; n < 3; n++) {
      c[i].v[n] = qn_num_add(ctx, c[i].v[n], times(ctx, z, w.v[n]));
    }
  }
  vec t = minus(ctx, &c[0], &c[1]);
  *gap = length(ctx, &t);
  return 1;
}

int qn_gap(qn_ctx *ctx, const qn_exact_surface *x, const qn_exact_surface *y, const qn_region *own, const qn_region *theirs, qn_num *gap, int *turn) {
  *gap = QN_NUM_ZERO;
  *turn = 1;
  if (x->plane != y->plane) {
    return 0;
  }
  int there = x->plane ? plane_gap(ctx, x, y, own, theirs, gap, turn) : curved_gap(ctx, x, y, own, gap, turn);
  return there && ctx->failed == QUOIN_OK;
}
