/* The doubles nearest to places on spheres, from the spheres' pieces alone, which the walk has just read. Static code.

   Legend: c the centre, y = o - c + t d, p = |y|^2 - r^2, S = y . d, dd = d . d; rho a power of two near the radius. All that is large is
   kept on the grid of multiples of 2^-24 rho, where sums are exact and squares have at most 53 bits; what is beside the grid is so small that
   doubles hold it to 2^-77 rho. y = Y + Z, Y on the grid: |y|^2 - r^2 = (sum Y_j^2 - r2) + sum Z_j (2 Y_j + Z_j) - r2_rest, the first part exact. That is
   less precise than wide/newton.h, and takes a third of its operations; about one place in 2^16 is left to that.
   The step and its test are those of wide/newton.h, with S for half the slope. Bounds: docs/bounds.md, QN_BALL_EVAL. */
#ifndef QN_WIDE_ROUND_BALL_H
#define QN_WIDE_ROUND_BALL_H

#include "base/bounds.h"
#include "scene/piece.h"
#include "wide/packet.h"
#include "wide/vec.h"

/* A sphere's numbers as the residual takes them; of one sphere in all lanes or of one each. */
typedef struct ball {
  vd grid, shift[3]; /* o + shift_j is grid + (o - c) on the grid; */
  vd rest[3];        /* what is left of c */
  vd r2, r2_rest, rho2, error, slope_error, far;
} ball;

QN_INLINE ball ball_make(const qn_packet *p, const vd c[3], const vd c_rest[3], vd r2, vd r2_rest, vd off) {
  const vd rho = vpower(vsqrt(r2)), grid = vmul(rho, vset(QN_BALL_GRID)), rho2 = vmul(rho, rho), grid2 = vmul(rho2, vset(QN_BALL_GRID_2));
  ball b = {.grid = grid, .rho2 = rho2};
  for (int j = 0; j < 3; j++) {
    vd on = vsub(vadd(c[j], grid), grid);
    b.shift[j] = vsub(grid, on), b.rest[j] = vadd(vsub(c[j], on), c_rest[j]);
  }
  b.r2 = vsub(vadd(r2, grid2), grid2), b.r2_rest = vadd(vsub(r2, b.r2), r2_rest);
  b.error = vmul(vset(QN_SLACK), vadd(vmul(vset(QN_BALL_EVAL), rho2), vmul(vmul(vset(QN_BALL_OFF), rho), off)));
  b.slope_error = vmul(rho, vset(QN_SLACK * QN_BALL_SLOPE * p->d_most));
  b.far = vmul(rho, vset(QN_BALL_FAR / (QN_SLACK * p->d_most)));
  return b;
}

QN_INLINE ball ball_of_one(const qn_packet *p, const qn_piece_sphere *s) {
  vd c[3], rest[3];
  for (int j = 0; j < 3; j++) {
    c[j] = vset(s->centre[j]), rest[j] = vset(s->rest[j]);
  }
  return ball_make(p, c, rest, vset(s->r2), vset(s->r2_rest), vset(s->off));
}

QN_INLINE ball ball_of_each(const qn_packet *p, const qn_piece_sphere *const s[QN_W]) {
  const double *centre[QN_W], *r2[QN_W];
  const float *rest[QN_W], *r2_rest[QN_W], *off[QN_W];
  for (int i = 0; i < QN_W; i++) {
    centre[i] = s[i]->centre, r2[i] = &s[i]->r2, rest[i] = s[i]->rest, r2_rest[i] = &s[i]->r2_rest, off[i] = &s[i]->off;
  }
  vd c[3], c_rest[3];
  for (int j = 0; j < 3; j++) {
    c[j] = vcollect(centre, j), c_rest[j] = vcollect_floats(rest, j);
  }
  return ball_make(p, c, c_rest, vcollect(r2, 0), vcollect_floats(r2_rest, 0), vcollect_floats(off, 0));
}

typedef struct ball_residual { vd p, slope; vm near; } ball_residual; /* near: the bounds of p and slope hold */

QN_INLINE ball_residual ball_residual_at(const ball *b, const vd o[3], const vd d[3], vd t) {
  vd exact = vsub(vset(0), b->r2), small = vsub(vset(0), b->r2_rest), slope = vset(0);
  for (int j = 0; j < 3; j++) {
    const vd a = vadd(o[j], b->shift[j]); /* every product and sum that is on the grid is exact */
    const vd o_rest = vsub(vsub(o[j], vsub(a, b->shift[j])), b->rest[j]);
#if defined(QN_FUSED)
    const vd at = vfma(t, d[j], a), m_rest = vfms(t, d[j], vsub(at, a));
#else
    const vdd m = vtwo_product(t, d[j]);
    const vd at = vadd(a, m.hi), m_rest = vadd(vsub(m.hi, vsub(at, a)), m.lo);
#endif
    const vd Y = vsub(at, b->grid), Z = vadd(m_rest, o_rest), y = vadd(Y, Z);
    exact = vfma(Y, Y, exact);
    small = vfma(Z, vadd(y, Y), small);
    slope = vfma(y, d[j], slope);
  }
  return (ball_residual){vadd(exact, small), slope, vle(vabs(exact), b->rho2)};
}

/* The lanes whose *out is certainly the double nearest to their root, which is within e of t. */
QN_INLINE vm ball_round(const qn_packet *p, const ball *b, const vd o[3], const vd d[3], vd t, vd e, vd *out) {
  const double dd = QN_SLACK * p->d_most * p->d_most;
  const ball_residual r = ball_residual_at(b, o, d, t);
  const vd steep = vabs(r.slope), size = vabs(t);
  const vm alone = vlt(vfma(vset(dd), e, vadd(b->slope_error, b->slope_error)), steep), within = vle(vadd(size, e), b->far);
  const vd inverse = vdiv(vset(0.5), r.slope), step = vmul(r.p, inverse), length = vabs(step), over = vabs(inverse);
  const vd g = vmul(vset(2), vfma(b->error, over, length)); /* no root within e is farther than that */
  const vd bend = vfma(vset(dd), g, vadd(b->slope_error, b->slope_error));
  const vd error = vmul(vset(QN_SLACK), vfma(vfma(bend, g, b->error), over, vmul(vset(5 * QN_U), length)));
  const vd sum = vsub(t, step), low = vsub(vsub(t, sum), step), high = vabs(sum);
  const vd radius = vfma(vabs(low), vset(QN_SLACK), error);
  const vm same = veq(vsub(high, radius), high);
  *out = sum;
  return vand(vand(vand(same, alone), vand(within, r.near)), vle(length, size));
}

/* The same for QN_W lanes of a packet from `at` on. */
QN_INLINE unsigned ball_round_lanes(const qn_packet *p, const qn_packet_hits *hits, const ball *b, unsigned at, double *t) {
  vd o[3], d[3], out;
  for (int j = 0; j < 3; j++) {
    o[j] = vload(p->o[j] + at), d[j] = vload(p->d[j] + at);
  }
  const unsigned sure = vbits(ball_round(p, b, o, d, vload(hits->t + at), vload(hits->error + at), &out));
  vstore(t + at, out);
  return sure;
}

/* The sphere that a lane is on, or null. */
QN_INLINE const qn_piece_sphere *sphere_of_lane(const struct quoin_scene *scene, const qn_packet_hits *hits, unsigned lane) {
  const qn_piece_head *head = (const qn_piece_head *)(const void *)((const char *)scene->lines + (size_t)scene->line_of[hits->leaf[lane]] * 64);
  return head->kind == QN_PIECE_SPHERE ? (const qn_piece_sphere *)(const void *)head : NULL;
}

#endif
