/* A leaf some of whose half-spaces were moved: its box, and its making.

   Planes only. Old planes m_i.y <= 1, new ones m'_i.y <= 1, y = x - c, for a place c strictly inside both. With B = was - c, let eps be at least
   every |(m_i - m'_i).y| for y in 2B, and eps < 1. A point of the new leaf on the boundary of 2B would have m_i.y <= 1 + eps for all i, so y / (1 + eps)
   would be in the old leaf and y in (1 + eps) B, which is inside 2B: there is none. The new leaf is convex and has c, so it lies inside 2B,
   and then, by the same line, in (1 + eps) B.

   A body s0 X0^2 + s1 X1^2 <= g(Z) = -(s2 Z^2 + 2 l Z + k), s0, s1 > 0, X and Z its rows, and caps a.X + d <= 0. On the leaf, by Cauchy and
   Schwarz, a2 Z + d <= e sqrt g(Z), e^2 = a0^2 / s0 + a1^2 / s1: so either a2 Z + d <= 0, or
     (a2^2 + e^2 s2) Z^2 + 2 (a2 d + e^2 l) Z + d^2 + e^2 k <= 0,
   which bounds Z on the side of the cap where the first factor is positive; and g(Z) >= 0 bounds it too. Between bounds of Z, X is in an ellipse of
   size sqrt g. With x = W (X - b), the extent along axis k at a given Z is W_k2 Z +- sqrt g(Z) (W_k0^2 / s0 + W_k1^2 / s1)^(1/2). */
#include "scene/snap.h"

#include "scene/compile.h"

#include <math.h>
#include <string.h>

static qn_num add(qn_ctx *ctx, qn_num a, qn_num b) { return qn_num_add(ctx, a, b); }
static qn_num sub(qn_ctx *ctx, qn_num a, qn_num b) { return qn_num_sub(ctx, a, b); }
static qn_num mul(qn_ctx *ctx, qn_num a, qn_num b) { return qn_num_mul(ctx, a, b); }
static qn_num divide(qn_ctx *ctx, qn_num a, qn_num b) { return qn_num_div(ctx, a, b); }
static qn_num root(qn_ctx *ctx, qn_num a) { return qn_num_sign(a) > 0 ? qn_num_sqrt(ctx, a) : QN_NUM_ZERO; }
static qn_num larger(qn_ctx *ctx, qn_num a, qn_num b) { return qn_num_cmp(ctx, a, b) > 0 ? a : b; }
static qn_num smaller(qn_ctx *ctx, qn_num a, qn_num b) { return qn_num_cmp(ctx, a, b) < 0 ? a : b; }

/* Two steps outward: one for the rounding to a double, one for roots known to 256 bits. */
static double up(qn_num a) {
  return nextafter(nextafter(qn_num_to_double(a), INFINITY), INFINITY);
}
static double down(qn_num a) {
  return nextafter(nextafter(qn_num_to_double(a), -INFINITY), -INFINITY);
}

/* --- planes only ----------------------------------------------------------------------------------------------------- */

/* The value of a plane at a place. */
static qn_num plane_at(qn_ctx *ctx, const qn_half_form *h, const qn_num at[3]) {
  return add(ctx, qn_num_dot(ctx, 3, h->row[0], at), h->row[0][3]);
}

/* A place amid the planes, by steps away from the nearest one; for the exact test to judge. */
static void find_inside(const qn_half_form *now, size_t count, const qn_region *was, double c[3]) {
  enum { STEPS = 64 };
  double size = 0;
  for (int k = 0; k < 3; k++) {
    c[k] = 0.5 * was->min[k] + 0.5 * was->max[k];
    size = fmax(size, was->max[k] - was->min[k]);
  }
  double best[3] = {c[0], c[1], c[2]}, best_room = -INFINITY;
  for (int step = 0; step < STEPS; step++) {
    double room = INFINITY, away[3] = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
      double n[3], length = 0, v = qn_num_to_double(now[i].row[0][3]);
      for (int k = 0; k < 3; k++) {
        n[k] = qn_num_to_double(now[i].row[0][k]);
        v += n[k] * c[k];
        length += n[k] * n[k];
      }
      length = sqrt(length);
      if (-v / length < room) {
        room = -v / length;
        for (int k = 0; k < 3; k++) {
          away[k] = -n[k] / length;
        }
      }
    }
    if (room > best_room) {
      best_room = room;
      memcpy(best, c, sizeof best);
    }
    if (step == 0 && count == 6 && room > 0.2 * size) {
      break;
    }
    for (int k = 0; k < 3; k++) {
      c[k] += away[k] * size * 0.25 / (1 + step);
    }
  }
  memcpy(c, best, sizeof best);
}

static int same_plane(const qn_half_form *a, const qn_half_form *b) {
  int same = 1;
  for (int k = 0; k < 4; k++) {
    same &= qn_num_equal(a->row[0][k], b->row[0][k]);
  }
  return same;
}

static int box_of_planes(qn_ctx *ctx, const qn_half_form *old, const qn_half_form *now, size_t count, const qn_region *was, qn_region *box) {
  double inside[3];
  qn_num c[3], low[3], high[3], reach[3], eps = QN_NUM_ZERO;
  find_inside(now, count, was, inside);
  for (int k = 0; k < 3; k++) {
    if (!isfinite(inside[k]) || !isfinite(was->min[k]) || !isfinite(was->max[k]) || !(was->min[k] < inside[k] && inside[k] < was->max[k])) {
      return 0;
    }
    c[k] = qn_num_from_double(ctx, inside[k]);
    low[k] = sub(ctx, qn_num_from_double(ctx, was->min[k]), c[k]);
    high[k] = sub(ctx, qn_num_from_double(ctx, was->max[k]), c[k]);
    reach[k] = mul(ctx, qn_num_from_int(ctx, 2), larger(ctx, qn_num_neg(ctx, low[k]), high[k]));
  }
  for (size_t i = 0; i < count; i++) {
    qn_num before = qn_num_neg(ctx, plane_at(ctx, &old[i], c)), after = qn_num_neg(ctx, plane_at(ctx, &now[i], c));
    if (qn_num_sign(before) <= 0 || qn_num_sign(after) <= 0) {
      return 0;
    }
    if (same_plane(&old[i], &now[i])) {
      continue;
    }
    qn_num sum = QN_NUM_ZERO;
    for (int k = 0; k < 3; k++) {
      qn_num e = sub(ctx, divide(ctx, old[i].row[0][k], before), divide(ctx, now[i].row[0][k], after));
      sum = add(ctx, sum, mul(ctx, qn_num_abs(ctx, e), reach[k]));
    }
    eps = larger(ctx, eps, sum);
  }
  if (ctx->failed != QUOIN_OK || qn_num_cmp(ctx, eps, QN_NUM_ONE) >= 0) {
    return 0;
  }
  qn_num grow = add(ctx, QN_NUM_ONE, eps);
  for (int k = 0; k < 3; k++) {
    box->max[k] = up(add(ctx, c[k], mul(ctx, grow, high[k])));
    box->min[k] = down(add(ctx, c[k], mul(ctx, grow, low[k])));
  }
  return ctx->failed == QUOIN_OK;
}

/* --- a body and caps ------------------------------------------------------------------------------------------------- */

typedef struct slab { qn_num lo, hi; int has_lo, has_hi; } slab;

static void at_most(qn_ctx *ctx, slab *z, qn_num v) {
  z->hi = z->has_hi ? smaller(ctx, z->hi, v) : v;
  z->has_hi = 1;
}
static void at_least(qn_ctx *ctx, slab *z, qn_num v) {
  z->lo = z->has_lo ? larger(ctx, z->lo, v) : v;
  z->has_lo = 1;
}

/* The roots of a z^2 + 2 h z + c, a > 0, moved apart by what they may be wrong; 0: none. */
static int roots(qn_ctx *ctx, qn_num a, qn_num h, qn_num c, qn_num out[2]) {
  qn_num disc = sub(ctx, mul(ctx, h, h), mul(ctx, a, c));
  if (qn_num_sign(disc) < 0) {
    return 0;
  }
  qn_num r = root(ctx, disc), slack = QN_NUM_ZERO;
  if (qn_num_is_rounded(r)) {
    slack = mul(ctx, add(ctx, qn_num_abs(ctx, h), r), qn_num_from_double(ctx, 0x1p-190));
  }
  r = add(ctx, r, slack);
  out[0] = divide(ctx, sub(ctx, qn_num_neg(ctx, h), r), a);
  out[1] = divide(ctx, sub(ctx, r, h), a);
  return 1;
}

static int invert(qn_ctx *ctx, qn_num row[3][4], qn_num W[3][3]) {
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < 3; i++) {
      int a = (i + 1) % 3, b = (i + 2) % 3, c = (k + 1) % 3, d = (k + 2) % 3;
      qn_num u[2] = {row[a][c], qn_num_neg(ctx, row[a][d])}, v[2] = {row[b][d], row[b][c]};
      W[k][i] = qn_num_dot(ctx, 2, u, v);
    }
  }
  qn_num column[3] = {W[0][0], W[1][0], W[2][0]}, det = qn_num_dot(ctx, 3, row[0], column);
  if (qn_num_is_zero(det)) {
    return 0;
  }
  for (int i = 0; i < 9; i++) {
    W[i / 3][i % 3] = divide(ctx, W[i / 3][i % 3], det);
  }
  return 1;
}

static void cut_by_cap(qn_ctx *ctx, const qn_half_form *body, qn_num W[3][3], const qn_half_form *cap, slab *z) {
  qn_num a[3], d = cap->row[0][3];
  for (int i = 0; i < 3; i++) {
    qn_num column[3] = {W[0][i], W[1][i], W[2][i]};
    a[i] = qn_num_dot(ctx, 3, cap->row[0], column);
    d = sub(ctx, d, mul(ctx, a[i], body->row[i][3]));
  }
  int side = qn_num_sign(a[2]);
  if (side == 0) {
    return;
  }
  qn_num end = qn_num_neg(ctx, divide(ctx, d, a[2])), r[2];
  qn_num e2 = add(ctx, divide(ctx, mul(ctx, a[0], a[0]), body->s[0]), divide(ctx, mul(ctx, a[1], a[1]), body->s[1]));
  if (!qn_num_is_zero(e2)) {
    qn_num A = add(ctx, mul(ctx, a[2], a[2]), mul(ctx, e2, body->s[2])), h = add(ctx, mul(ctx, a[2], d), mul(ctx, e2, body->l));
    if (qn_num_sign(A) <= 0) {
      return;
    }
    if (roots(ctx, A, h, add(ctx, mul(ctx, d, d), mul(ctx, e2, body->k)), r)) {
      end = side > 0 ? larger(ctx, end, r[1]) : smaller(ctx, end, r[0]);
    }
  }
  if (side > 0) {
    at_most(ctx, z, end);
  } else {
    at_least(ctx, z, end);
  }
}

static qn_num g_at(qn_ctx *ctx, const qn_half_form *b, qn_num z) {
  qn_num v = add(ctx, mul(ctx, b->s[2], mul(ctx, z, z)), mul(ctx, qn_num_from_int(ctx, 2), mul(ctx, b->l, z)));
  v = qn_num_neg(ctx, add(ctx, v, b->k));
  return qn_num_sign(v) < 0 ? QN_NUM_ZERO : v;
}

/* Whether sqrt g is convex: cylinders, cones, hyperboloids of one sheet. */
static int is_saddle_like(qn_ctx *ctx, const qn_half_form *b) {
  if (qn_num_sign(b->s[2]) == 0) {
    return qn_num_is_zero(b->l);
  }
  /* -s2 > 0: the least of g, -k + l^2 / s2, is not negative */
  return qn_num_sign(b->s[2]) < 0 && qn_num_sign(sub(ctx, divide(ctx, mul(ctx, b->l, b->l), b->s[2]), b->k)) >= 0;
}

static int box_of_body(qn_ctx *ctx, const qn_half_form *now, size_t count, size_t body, qn_region *box) {
  qn_half_form b = now[body];
  qn_num W[3][3], r[2];
  slab z = {QN_NUM_ZERO, QN_NUM_ZERO, 0, 0};
  if (qn_num_sign(b.s[0]) <= 0 || qn_num_sign(b.s[1]) <= 0 || !invert(ctx, b.row, W)) {
    return 0;
  }
  for (size_t i = 0; i < count; i++) {
    if (i != body) {
      cut_by_cap(ctx, &b, W, &now[i], &z);
    }
  }
  if (qn_num_sign(b.s[2]) > 0) {
    if (!roots(ctx, b.s[2], b.l, b.k, r)) {
      return 0;
    }
    at_least(ctx, &z, r[0]);
    at_most(ctx, &z, r[1]);
  } else if (qn_num_is_zero(b.s[2]) && !qn_num_is_zero(b.l)) {
    qn_num end = qn_num_neg(ctx, divide(ctx, b.k, mul(ctx, qn_num_from_int(ctx, 2), b.l)));
    if (qn_num_sign(b.l) > 0) {
      at_most(ctx, &z, end);
    } else {
      at_least(ctx, &z, end);
    }
  }
  if (!z.has_lo || !z.has_hi || ctx->failed != QUOIN_OK || qn_num_cmp(ctx, z.lo, z.hi) > 0) {
    return 0;
  }
  qn_num g[2] = {g_at(ctx, &b, z.lo), g_at(ctx, &b, z.hi)}, most = larger(ctx, g[0], g[1]);
  if (qn_num_sign(b.s[2]) > 0) { /* the top, whether it is between the ends or not */
    most = larger(ctx, most, sub(ctx, divide(ctx, mul(ctx, b.l, b.l), b.s[2]), b.k));
  }
  int ends = is_saddle_like(ctx, &b);
  for (int k = 0; k < 3; k++) {
    qn_num shift = QN_NUM_ZERO, c2 = add(ctx, divide(ctx, mul(ctx, W[k][0], W[k][0]), b.s[0]), divide(ctx, mul(ctx, W[k][1], W[k][1]), b.s[1]));
    for (int i = 0; i < 3; i++) {
      shift = sub(ctx, shift, mul(ctx, W[k][i], b.row[i][3]));
    }
    qn_num at[2] = {mul(ctx, W[k][2], z.lo), mul(ctx, W[k][2], z.hi)}, wide[2];
    for (int i = 0; i < 2; i++) {
      wide[i] = root(ctx, mul(ctx, c2, ends ? g[i] : most));
    }
    qn_num high = larger(ctx, add(ctx, at[0], wide[0]), add(ctx, at[1], wide[1]));
    qn_num low = smaller(ctx, sub(ctx, at[0], wide[0]), sub(ctx, at[1], wide[1]));
    if (qn_num_sign(b.s[2]) > 0 && qn_num_is_zero(b.l)) { /* an ellipsoid's own extent */
      c2 = add(ctx, c2, divide(ctx, mul(ctx, W[k][2], W[k][2]), b.s[2]));
      qn_num extent = root(ctx, qn_num_neg(ctx, mul(ctx, b.k, c2)));
      high = smaller(ctx, high, extent);
      low = larger(ctx, low, qn_num_neg(ctx, extent));
    }
    box->max[k] = up(add(ctx, shift, high));
    box->min[k] = down(add(ctx, shift, low));
  }
  return ctx->failed == QUOIN_OK;
}

int qn_snap_box(qn_ctx *ctx, const qn_half_form *old, const qn_half_form *now, size_t count, const qn_region *was, qn_region *box) {
  size_t bodies = 0, body = 0;
  int super = 0;
  for (size_t i = 0; i < count; i++) {
    super |= now[i].kind == QN_SUPER_BODY;
    if (now[i].kind != QN_PLANE) {
      bodies++;
      body = i;
    }
  }
  int bounded = !super && (bodies == 0 ? box_of_planes(ctx, old, now, count, was, box) : bodies == 1 && box_of_body(ctx, now, count, body, box));
  for (int k = 0; k < 3; k++) {
    bounded = bounded && isfinite(box->min[k]) && isfinite(box->max[k]);
  }
  for (int k = 0; k < 3 && !bounded; k++) {
    box->min[k] = -INFINITY;
    box->max[k] = INFINITY;
  }
  return bounded;
}

/* --- the leaf -------------------------------------------------------------------------------------------------------- */

/* Under the identity, of half-spaces that are in world coordinates already. */
static quoin_status add_in_world(qn_maker *m, qn_half_form *halves, size_t count, qn_leaf *leaf, qn_form_result *result) {
  qn_local *l = &m->local;
  l->node = QN_NO_NODE; /* what is there is nobody's */
  l->halves = halves;
  l->count = count;
  l->placed = NULL;
  for (size_t h = 0; h < count; h++) {
    for (size_t i = 0; i < (halves[h].kind == QN_PLANE ? 1 : 3); i++) {
      for (size_t j = 0; j < 4; j++) {
        l->rows[h][i][j] = qn_ball_from_num(&l->ctx, halves[h].row[i][j]);
      }
    }
  }
  quoin_status status = l->ctx.failed;
  if (status == QUOIN_OK && !m->plain.stack) {
    status = qn_maps_init(&m->plain, m->model, m->mem);
  }
  if (status == QUOIN_OK) {
    qn_maps maps = m->maps;
    m->maps = m->plain;
    status = qn_leaf_add(m, leaf, result);
    m->plain = m->maps;
    m->maps = maps;
  }
  return status;
}

quoin_status qn_leaf_snapped(qn_maker *m, uint32_t node, qn_leaf *leaf, qn_form_result *result) {
  const qn_num *map;
  qn_maps_settle(&m->maps);
  quoin_status status = qn_local_make(m, node);
  *result = m->local.result;
  if (status != QUOIN_OK || *result != QN_FORM_OK) {
    return status;
  }
  qn_region was, box;
  qn_leaf_box(m, was.min, was.max);
  status = qn_maps_exact(&m->maps, &map);
  if (status != QUOIN_OK) {
    return status;
  }
  size_t count = m->local.count;
  qn_ctx *ctx = &m->maps.scratch;
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_half_form *old = qn_arena_take(&ctx->arena, count * sizeof *old), *now = qn_arena_take(&ctx->arena, count * sizeof *now);
  status = old && now ? QUOIN_OK : QUOIN_E_MEMORY;
  if (status == QUOIN_OK) {
    memcpy(old, m->local.halves, count * sizeof *old);
    int there = qn_map_forms(ctx, map, old, count);
    memcpy(now, old, count * sizeof *now);
    there = there && qn_snaps_apply(ctx, m->kept_maps, m->model, m->snaps, node, now, count);
    if (there) {
      leaf->bounded = (uint8_t)qn_snap_box(ctx, old, now, count, &was, &box);
      memcpy(leaf->min, box.min, sizeof leaf->min);
      memcpy(leaf->max, box.max, sizeof leaf->max);
    }
    *result = there ? QN_FORM_OK : QN_FORM_EMPTY;
    status = ctx->failed;
    if (there && status == QUOIN_OK) {
      status = add_in_world(m, now, count, leaf, result);
    }
  }
  qn_arena_release(&ctx->arena, mark);
  return status;
}
