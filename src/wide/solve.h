/* One piece against QN_W rays: the stretch [a, b] of each ray in it, certified. Static code, included by the packet body.

   Legend: y = o - pivot; O = A y + b, D = A d; X = O + t0 D is the place nearest the piece's origin in its own metric, where the
   quadric is solved (numerics: the shift is worth three digits, and seven for far origins); p(t0 + v) = a v^2 + 2 h v + c. Capital
   letters and e.. are bounds, taken once per packet and piece from the packet's box of origins and directions. Each formula's
   rounding is bounded by QN_WIDE_ROUND u times the sum of its terms' magnitudes (docs/bounds.md). */
#ifndef QN_WIDE_SOLVE_H
#define QN_WIDE_SOLVE_H

#include "base/bounds.h"
#include "scene/piece.h"
#include "wide/packet.h"
#include "wide/vec.h"

#include <math.h>
#include <string.h>

enum { QN_GROUPS = QN_LANES_NOW / QN_W };
#define QN_FAR 0x1p+500 /* an end that is not there */
#define QN_NOBODY 0xffffffffu

/* A payload is the surface (low half), the leaf, and in a bit near the top whether it is the larger of the surface's two roots; it
   travels in the lanes of a vd as bits, moved and never computed with. */
#define QN_LARGER_ROOT ((uint64_t)1 << 62)
#define QN_LEAF_BITS 0x3fffffffu /* of the upper half */
#define QN_STARTS_ON ((uint64_t)1 << 63) /* the place where a ray starts on a surface: it equals either root there */
QN_INLINE double payload_bits(uint64_t payload) {
  double d;
  memcpy(&d, &payload, sizeof d);
  return d;
}
QN_INLINE uint64_t payload_of(uint32_t surface, uint32_t leaf, uint64_t larger) {
  return surface | (uint64_t)leaf << 32 | larger;
}

/* What is known of a packet before any piece is met. */
typedef struct packet_facts {
  const qn_packet *p;
  double reach; /* no |t| of interest is larger; infinite in unbounded scenes */
} packet_facts;

QN_INLINE double least(double a, double b) { return b < a ? b : a; }
QN_INLINE double most(double a, double b) { return b > a ? b : a; }
/* The largest |o_i - pivot_i| of a packet. */
QN_INLINE double farthest(const packet_facts *f, int i, double pivot) { return most(fabs(f->p->low[i] - pivot), fabs(f->p->high[i] - pivot)); }

/* A stretch of QN_W rays in a piece. Lanes not in `hit` and not in `unsure` surely miss. */
typedef struct stretch { vd a, b, pa, pb, error; vm hit, unsure; } stretch;

QN_INLINE vm near_each_other(vd x, vd y, vd tolerance) { return vle(vabs(vsub(x, y)), tolerance); }

/* --- sphere ------------------------------------------------------------------------------------------------------ */
typedef struct sphere_constants { vd cx, cy, cz, r2, ed_low, ed_high, error, pa, pb; } sphere_constants;

QN_INLINE void sphere_prepare(const packet_facts *f, const qn_piece_sphere *s, sphere_constants *k) {
  double Y = 0, H = 0;
  for (int i = 0; i < 3; i++) {
    double y = farthest(f, i, s->centre[i]);
    Y += y;
    H += y * f->p->dabs[i];
  }
  double r = sqrt(s->r2), d = sqrt(f->p->dd_max);
  /* m = y - (y.d / d.d) d: each coordinate within delta; lanes with |m| > 2r are sure misses while delta < r/8. */
  double delta = 4 * (QN_WIDE_ROUND * QN_U * (Y + H * d / f->p->dd_min) + s->off);
  double ed = delta < r / 8 ? 8 * r * delta + 3 * delta * delta + QN_WIDE_ROUND * QN_U * 5 * s->r2 : INFINITY;
  double solved = QN_WIDE_SHY * ed;
  double s_error = ed / sqrt(solved * f->p->dd_max); /* of sqrt((r2 - m.m) / d.d) where r2 - m.m > solved; ed/(2 sqrt solved), doubled */
  k->cx = vset(s->centre[0]), k->cy = vset(s->centre[1]), k->cz = vset(s->centre[2]);
  k->r2 = vset(s->r2);
  k->ed_low = vset(-ed), k->ed_high = vset(solved);
  k->error = vset((QN_WIDE_ROUND * QN_U * (H + r * d) + 3 * s->off * d) / f->p->dd_min + 2 * s_error * sqrt(f->p->dd_max / f->p->dd_min));
  k->pa = vset(payload_bits(payload_of(s->surface, s->head.leaf, 0)));
  k->pb = vset(payload_bits(payload_of(s->surface, s->head.leaf, QN_LARGER_ROOT)));
}

QN_INLINE stretch sphere_solve(const packet_facts *f, const sphere_constants *k, int g) {
  const qn_packet *p = f->p;
  int at = g * QN_W;
  vd dx = vload(p->d[0] + at), dy = vload(p->d[1] + at), dz = vload(p->d[2] + at), idd = vload(p->idd + at);
  vd x = vsub(vload(p->o[0] + at), k->cx), y = vsub(vload(p->o[1] + at), k->cy), z = vsub(vload(p->o[2] + at), k->cz);
  vd middle = vmul(vfma(x, dx, vfma(y, dy, vmul(z, dz))), idd); /* -t of the nearest place */
  x = vsub(x, vmul(middle, dx)), y = vsub(y, vmul(middle, dy)), z = vsub(z, vmul(middle, dz));
  vd rest = vsub(k->r2, vfma(x, x, vfma(y, y, vmul(z, z))));
  vm hit = vlt(k->ed_high, rest);
  stretch s = {.pa = k->pa, .pb = k->pb, .error = k->error, .hit = hit, .unsure = vandnot(vandnot(vmask(QN_ALL_BITS), vlt(rest, k->ed_low)), hit)};
  vd half = vsqrt(vmul(vpick(hit, rest, vset(0)), idd));
  s.a = vsub(vset(0), vadd(middle, half));
  s.b = vsub(half, middle);
  return s;
}

/* --- a plane's place, added to a stretch -------------------------------------------------------------------------- */
typedef struct plane_constants { vd n[3], d, en, eden, steep; vd px; } plane_constants;

/* n . (x - pivot) + d <= 0 */
QN_INLINE void plane_prepare(const packet_facts *f, const double pivot[3], const double n[3], double d, uint32_t surface, uint32_t leaf, plane_constants *k) {
  double en = fabs(d), eden = 0;
  for (int i = 0; i < 3; i++) {
    en += fabs(n[i]) * farthest(f, i, pivot[i]);
    eden += fabs(n[i]) * f->p->dabs[i];
    k->n[i] = vset(n[i]);
  }
  k->d = vset(d);
  k->en = vset(QN_WIDE_ROUND * QN_U * en);
  k->eden = vset(QN_WIDE_ROUND * QN_U * eden);
  k->steep = vset(0x1p-24 * eden);
  k->px = vset(payload_bits(payload_of(surface, leaf, 0)));
}

/* Meets s with the half-space; y: origins from the pivot. */
QN_INLINE void plane_meet(const packet_facts *f, const plane_constants *k, const vd y[3], const vd d[3], stretch *s) {
  const vd zero = vset(0), far = vset(QN_FAR), one = vset(1);
  vd num = vfma(k->n[0], y[0], vfma(k->n[1], y[1], vfma(k->n[2], y[2], k->d)));
  vd den = vfma(k->n[0], d[0], vfma(k->n[1], d[1], vmul(k->n[2], d[2])));
  vd size = vabs(den);
  vm crosses = vlt(k->steep, size);
  vd inv = vdiv(one, vpick(crosses, den, one));
  vd t = vsub(zero, vmul(num, inv));
  vd error = vmul(vfma(vabs(t), k->eden, k->en), vmul(vabs(inv), vset(1 + 0x1p-10)));
  /* Parallel, or so nearly that within reach the plane is not met: in or out by the sign of num. */
  vd drift = vadd(k->en, vpick(vlt(zero, size), vmul(vadd(size, k->eden), vset(f->reach)), zero));
  vm in = vlt(num, vsub(zero, drift)), out = vlt(drift, num);
  s->hit = vandnot(s->hit, vandnot(out, crosses));
  s->unsure = vandnot(vor(s->unsure, vandnot(vandnot(vandnot(s->hit, crosses), in), out)), vandnot(out, crosses));
  s->error = vmax(s->error, vpick(crosses, error, zero));
  vm enters = vand(crosses, vlt(den, zero)), leaves = vandnot(crosses, enters);
  vd two = vmul(s->error, vset(2));
  vd ta = vpick(enters, t, vsub(zero, far)), tb = vpick(leaves, t, far);
  s->unsure = vor(s->unsure, vand(s->hit, vor(vand(enters, near_each_other(ta, s->a, two)), vand(leaves, near_each_other(tb, s->b, two)))));
  vm later = vlt(s->a, ta), sooner = vlt(tb, s->b);
  s->a = vpick(later, ta, s->a), s->pa = vpick(later, k->px, s->pa);
  s->b = vpick(sooner, tb, s->b), s->pb = vpick(sooner, k->px, s->pb);
}

/* After all parts are met: a stretch needs positive length, surely. */
QN_INLINE void stretch_settle(stretch *s) {
  vd two = vmul(s->error, vset(2)), length = vsub(s->b, s->a);
  vm none = vlt(length, vsub(vset(0), two)), some = vlt(two, length);
  s->unsure = vor(s->unsure, vandnot(vandnot(s->hit, some), none));
  s->hit = vandnot(vand(s->hit, some), s->unsure);
}

/* --- box --------------------------------------------------------------------------------------------------------- */
typedef struct box_constants { vd lo[3], hi[3], en[3], plo[3], phi[3]; } box_constants;

QN_INLINE void box_prepare(const packet_facts *f, const qn_piece_box *b, box_constants *k) {
  for (int i = 0; i < 3; i++) {
    double size = most(fabs(b->lo[i]), fabs(b->hi[i])) + farthest(f, i, 0);
    k->lo[i] = vset(b->lo[i]), k->hi[i] = vset(b->hi[i]);
    k->en[i] = vset(QN_WIDE_ROUND * QN_U * size + 2 * b->off);
    k->plo[i] = vset(payload_bits(payload_of(b->surface[2 * i], b->head.leaf, 0)));
    k->phi[i] = vset(payload_bits(payload_of(b->surface[2 * i + 1], b->head.leaf, 0)));
  }
}

QN_INLINE stretch box_solve(const packet_facts *f, const box_constants *k, int g) {
  const qn_packet *p = f->p;
  int at = g * QN_W;
  const vd zero = vset(0), far = vset(QN_FAR), near = vset(-QN_FAR), nobody = vset(payload_bits(QN_NOBODY));
  stretch s = {.a = near, .b = far, .pa = nobody, .pb = nobody, .error = zero, .hit = vmask(QN_ALL_BITS), .unsure = vmask(0)};
  vd a[3], b[3], pa[3], pb[3];
  for (int i = 0; i < 3; i++) {
    vd o = vload(p->o[i] + at), inv = vload(p->inv[i] + at);
    vm flat = vandnot(vmask(QN_ALL_BITS), vor(vlt(inv, zero), vlt(zero, inv))), down = vlt(inv, zero);
    vd low = vsub(k->lo[i], o), high = vsub(k->hi[i], o);
    vd t0 = vmul(low, inv), t1 = vmul(high, inv);
    a[i] = vpick(down, t1, t0), b[i] = vpick(down, t0, t1);
    pa[i] = vpick(down, k->phi[i], k->plo[i]), pb[i] = vpick(down, k->plo[i], k->phi[i]);
    s.error = vmax(s.error, vmul(vmul(k->en[i], vabs(inv)), vset(1 + 0x1p-10)));
    if (vbits(flat)) { /* along the slab: in it, out of it, or too near to tell */
      vm out = vor(vlt(k->en[i], low), vlt(high, vsub(zero, k->en[i])));
      vm in = vand(vlt(low, vsub(zero, k->en[i])), vlt(k->en[i], high));
      s.hit = vandnot(s.hit, vand(flat, out));
      s.unsure = vor(s.unsure, vandnot(vandnot(flat, in), out));
      a[i] = vpick(flat, near, a[i]), b[i] = vpick(flat, far, b[i]);
      pa[i] = vpick(flat, nobody, pa[i]), pb[i] = vpick(flat, nobody, pb[i]);
    }
  }
  vd two = vmul(s.error, vset(2));
  vm later = vlt(a[0], a[1]);
  vd first = vmax(a[0], a[1]), second = vmin(a[0], a[1]);
  s.pa = vpick(later, pa[1], pa[0]);
  later = vlt(first, a[2]);
  second = vmax(second, vmin(first, a[2]));
  s.a = vmax(first, a[2]), s.pa = vpick(later, pa[2], s.pa);
  vm tied = vand(near_each_other(s.a, second, two), vlt(near, second));
  vm sooner = vlt(b[1], b[0]);
  first = vmin(b[0], b[1]), second = vmax(b[0], b[1]);
  s.pb = vpick(sooner, pb[1], pb[0]);
  sooner = vlt(b[2], first);
  second = vmin(second, vmax(first, b[2]));
  s.b = vmin(first, b[2]), s.pb = vpick(sooner, pb[2], s.pb);
  tied = vor(tied, vand(near_each_other(s.b, second, two), vlt(second, far)));
  /* An edge counts only on a ray that meets the box. */
  vm none = vlt(vadd(s.b, two), s.a);
  s.hit = vandnot(s.hit, none);
  s.unsure = vand(vor(s.unsure, tied), s.hit);
  stretch_settle(&s);
  return s;
}

/* --- quadric body ------------------------------------------------------------------------------------------------ */
typedef struct body_constants {
  vd row[3][4], s[3], l, k, reach2, ed_low, ed_high, ea, flat, gap, slope, eh_far, ec_far, plow, phigh;
  int sound; /* 0: the bounds say nothing here, every lane is unsure */
} body_constants;

QN_INLINE void body_prepare(const packet_facts *f, const double pivot[3], const double row[3][4], const double s[3], double l, double k0, double reach,
                            uint32_t surface, uint32_t leaf, body_constants *k) {
  double omega = 0, delta[3], D = 0;
  for (int i = 0; i < 3; i++) {
    double w = fabs(row[i][3]);
    delta[i] = 0;
    for (int j = 0; j < 3; j++) {
      w += fabs(row[i][j]) * farthest(f, j, pivot[j]);
      delta[i] += fabs(row[i][j]) * f->p->dabs[j];
      k->row[i][j] = vset(row[i][j]);
    }
    k->row[i][3] = vset(row[i][3]);
    omega += w;
    D += delta[i];
    k->s[i] = vset(s[i]);
  }
  const double c = QN_WIDE_ROUND * QN_U;
  double R = 2 * reach, A = 0, H = fabs(l) * delta[2], C = 2 * fabs(l) * R + fabs(k0), S = 0;
  for (int i = 0; i < 3; i++) {
    A += fabs(s[i]) * delta[i] * delta[i];
    H += fabs(s[i]) * R * delta[i];
    C += fabs(s[i]) * R * R;
    S += fabs(s[i]);
  }
  /* X is within e of O + t0 D for the t0 that was computed, whatever its error: only the shift's own rounding counts. It is at
     most c (omega + D |t0|), and |t0| <= 4 (omega + R) / D' where D' is the least length of D; that is left to `slope` below. */
  double e = c * 8 * (omega + R);
  double ea = c * A, eh = c * H + e * D * S + c * fabs(l) * delta[2], ec = c * C + 2 * S * R * e + S * e * e + 2 * fabs(l) * e;
  double ed = 2 * H * eh + eh * eh + A * ec + C * ea + ea * ec + c * (H * H + A * C);
  double solved = QN_WIDE_SHY * ed;
  k->sound = isfinite(ed) && ed > 0;
  k->l = vset(l), k->k = vset(k0);
  k->reach2 = vset(R * R);
  k->ed_low = vset(-ed), k->ed_high = vset(solved);
  k->ea = vset(ea);
  k->flat = vset(0x1p-20 * A);
  k->gap = vset(eh + 2 * ed / sqrt(solved) + c * (2 * H + sqrt(A * C)));
  k->slope = vset(0x1p-12 * D * D);
  k->eh_far = vset(eh), k->ec_far = vset(ec);
  k->plow = vset(payload_bits(payload_of(surface, leaf, 0)));
  k->phigh = vset(payload_bits(payload_of(surface, leaf, QN_LARGER_ROOT)));
}

QN_INLINE void body_meet(const packet_facts *f, const body_constants *k, const vd y[3], const vd d[3], stretch *s) {
  const vd zero = vset(0), far = vset(QN_FAR), near = vset(-QN_FAR), one = vset(1);
  if (!k->sound) {
    s->unsure = vor(s->unsure, s->hit);
    return;
  }
  vd O[3], D[3];
  for (int i = 0; i < 3; i++) {
    O[i] = vfma(k->row[i][0], y[0], vfma(k->row[i][1], y[1], vfma(k->row[i][2], y[2], k->row[i][3])));
    D[i] = vfma(k->row[i][0], d[0], vfma(k->row[i][1], d[1], vmul(k->row[i][2], d[2])));
  }
  vd length2 = vfma(D[0], D[0], vfma(D[1], D[1], vmul(D[2], D[2])));
  vm slow = vle(length2, k->slope); /* D so much shorter than its packet's bound that e would not hold */
  vd t0 = vsub(zero, vdiv(vfma(O[0], D[0], vfma(O[1], D[1], vmul(O[2], D[2]))), vpick(slow, one, length2)));
  for (int i = 0; i < 3; i++) {
    O[i] = vfma(t0, D[i], O[i]);
  }
  vd away2 = vfma(O[0], O[0], vfma(O[1], O[1], vmul(O[2], O[2])));
  vm away = vlt(k->reach2, away2); /* twice out of reach: a sure miss of the whole leaf */
  vd a = zero, h = vmul(k->l, D[2]), c = vfma(vadd(k->l, k->l), O[2], k->k);
  for (int i = 0; i < 3; i++) {
    vd sd = vmul(k->s[i], D[i]), so = vmul(k->s[i], O[i]);
    a = vfma(sd, D[i], a), h = vfma(sd, O[i], h), c = vfma(so, O[i], c);
  }
  vd disc = vsub(vmul(h, h), vmul(a, c));
  vm all = vmask(QN_ALL_BITS);
  vm flat = vle(vabs(a), k->flat), real = vlt(k->ed_high, disc), none = vlt(disc, k->ed_low);
  vm bad = vor(slow, vandnot(vandnot(all, vor(real, none)), flat));
  /* Flat: no root within reach when the constant outweighs the rest; in or out by its sign. */
  vd v = vadd(vset(f->reach), vabs(t0)); /* |t - t0| of interest */
  vd drift = vadd(vfma(vfma(vadd(vabs(a), k->ea), v, vadd(vabs(vadd(h, h)), vadd(k->eh_far, k->eh_far))), v, k->ec_far), zero);
  vm flat_in = vand(flat, vlt(c, vsub(zero, drift))), flat_out = vand(flat, vlt(drift, c));
  bad = vor(bad, vandnot(vandnot(flat, flat_in), flat_out));
  /* Roots. */
  vm rooted = vandnot(real, flat);
  vd inv = vdiv(one, vpick(flat, one, a)), root = vsqrt(vpick(real, disc, zero));
  vd r0 = vsub(vmul(vsub(zero, vadd(h, root)), inv), zero), r1 = vmul(vsub(root, h), inv);
  vd low = vadd(t0, vmin(r0, r1)), high = vadd(t0, vmax(r0, r1));
  vd ia = vabs(inv);
  vd error = vfma(vmul(k->ea, ia), vmul(vset(2), vmax(vabs(r0), vabs(r1))), vmul(k->gap, vmul(ia, vset(1 + 0x1p-8))));
  error = vfma(vabs(t0), vset(8 * QN_U), error);
  s->error = vmax(s->error, vpick(rooted, error, zero));
  vd two = vmul(s->error, vset(2));
  vm opens = vlt(a, zero); /* inside is outside the roots */
  vm out = vor(vor(away, flat_out), vandnot(vandnot(none, flat), opens));
  vm bounded = vandnot(rooted, opens), split = vand(rooted, opens);
  s->hit = vandnot(s->hit, out);
  vm clash = vmask(0);
  /* Between the roots. */
  vd ta = vpick(bounded, low, near), tb = vpick(bounded, high, far), pa = k->plow, pb = k->phigh;
  clash = vor(clash, vand(bounded, vor(near_each_other(ta, s->a, two), near_each_other(tb, s->b, two))));
  if (vbits(vand(split, s->hit))) { /* before the first root or after the second, whichever the rest of the leaf leaves; both: not for wide code */
    vm before = vlt(s->a, vsub(low, two)), after = vlt(vadd(high, two), s->b);
    vm not_before = vlt(vadd(low, two), s->a), not_after = vlt(s->b, vsub(high, two));
    clash = vor(clash, vand(split, vand(before, after)));
    clash = vor(clash, vandnot(split, vand(vor(before, not_before), vor(after, not_after))));
    vm miss = vand(split, vand(not_before, not_after));
    s->hit = vandnot(s->hit, miss);
    vm only_before = vand(split, vand(before, not_after)), only_after = vand(split, vand(after, not_before));
    clash = vor(clash, vor(vand(only_before, near_each_other(low, s->b, two)), vand(only_after, near_each_other(high, s->a, two))));
    tb = vpick(only_before, low, tb), pb = vpick(only_before, k->plow, pb);
    ta = vpick(only_after, high, ta), pa = vpick(only_after, k->phigh, pa);
  }
  s->unsure = vand(vor(s->unsure, vor(bad, clash)), vandnot(all, away));
  vm later = vlt(s->a, ta), sooner = vlt(tb, s->b);
  s->a = vpick(later, ta, s->a), s->pa = vpick(later, pa, s->pa);
  s->b = vpick(sooner, tb, s->b), s->pb = vpick(sooner, pb, s->pb);
}

#endif
