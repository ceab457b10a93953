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
/* A benchmark builds the bodies once more without bounds and doubts, wrong wherever doubles are, to see what certainty costs (tests/bench). */
#if defined(QN_UNCHECKED)
enum { CHECKED = 0 };
#else
enum { CHECKED = 1 };
#endif
enum { AXIS_UP, AXIS_DOWN, AXIS_FLAT, AXIS_MIXED }; /* how a packet's directions lie on an axis */
#define QN_FAR QN_SPAN_FAR /* an end that is not there */
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
  double reach; /* no |t| at which a ray is in the solid's box is larger; infinite in unbounded scenes */
  double share[3]; /* QN_TILE_PAIRS: the largest |o_i|, whose rounding counts with |o_i - pivot_i|; QN_TILE_MOVED: `moved`; else 0 */
} packet_facts;

QN_INLINE double least(double a, double b) { return b < a ? b : a; }
QN_INLINE double most(double a, double b) { return b > a ? b : a; }
/* At least the largest |o_i - pivot_i| of a packet. */
QN_INLINE double farthest(const packet_facts *f, int i, double pivot) { return most(fabs(f->p->low[i] - pivot), fabs(f->p->high[i] - pivot)) + f->share[i]; }

/* A stretch of QN_W rays in a piece. Lanes not in `hit` and not in `unsure` surely miss. */
typedef struct stretch { vd a, b, pa, pb, error; vm hit, unsure; } stretch;

/* Lanes that are doubted, and a bound. */
QN_INLINE vm doubt(vm m) { return CHECKED ? m : vmask(0); }
QN_INLINE vd bound(double e) { return vset(CHECKED ? e : 0); }

/* Lanes of which it is not certain that x and y are apart. */
QN_INLINE vm near_each_other(vd x, vd y, vd tolerance) { return doubt(vandnot(vmask(QN_ALL_BITS), vlt(tolerance, vabs(vsub(x, y))))); }

/* --- sphere ------------------------------------------------------------------------------------------------------ */
typedef struct sphere_constants { vd cx, cy, cz, r2, ed_low, ed_high, error, pa, pb; } sphere_constants;

QN_INLINE void sphere_prepare(const packet_facts *f, const qn_piece_sphere *s, sphere_constants *k) {
  double Y = 0, H = 0;
  for (int i = 0; i < 3; i++) {
    double y = farthest(f, i, s->centre[i]);
    Y += y;
    H += y * f->p->dabs[i];
  }
  const double r = sqrt(s->r2), d = f->p->d_most, idd = f->p->idd_most;
  /* | |m^| - |m| | <= delta with m = y - (y.d / d.d) d from the true centre; lanes with |m^| > 2r are sure misses while delta < r/8. */
  double delta = 4 * (QN_WIDE_ROUND * QN_U * (Y + H * d * idd) + s->off) + QN_WIDE_TINY;
  double ed = delta < r / 8 ? 8 * r * delta + 3 * delta * delta + QN_WIDE_ROUND * QN_U * 5 * s->r2 : INFINITY;
  double root_error = sqrt(ed) * f->p->shy; /* of sqrt((r2 - m.m) / d.d) where r2 - m.m > QN_WIDE_SHY ed; twice what it is */
  k->cx = vset(s->centre[0]), k->cy = vset(s->centre[1]), k->cz = vset(s->centre[2]);
  k->r2 = vset(s->r2);
  k->ed_low = bound(-ed), k->ed_high = bound(QN_WIDE_SHY * ed);
  k->error = bound((QN_WIDE_ROUND * QN_U * (H + r * d) + 3 * s->off * d) * idd + 2 * root_error + QN_WIDE_TINY);
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
  const vd half = vsqrt(vmul(vpick(hit, rest, vset(0)), idd));
  return (stretch){vsub(vset(0), vadd(middle, half)), vsub(half, middle), k->pa, k->pb, k->error, hit, doubt(vandnot(vandnot(vmask(QN_ALL_BITS), vlt(rest, k->ed_low)), hit))};
}

/* --- a plane's place, added to a stretch -------------------------------------------------------------------------- */
typedef struct plane_constants { vd n[3], d, en, eden, steep; vd px; } plane_constants;

/* Sums of |n_i| times the largest |o_i - pivot_i|, and times the largest |d_i|. */
QN_INLINE double weighed(const packet_facts *f, const double pivot[3], const double n[3]) {
  return (fabs(n[0]) * farthest(f, 0, pivot[0]) + fabs(n[1]) * farthest(f, 1, pivot[1])) + fabs(n[2]) * farthest(f, 2, pivot[2]);
}
QN_INLINE double steepest(const packet_facts *f, const double n[3]) { return (fabs(n[0]) * f->p->dabs[0] + fabs(n[1]) * f->p->dabs[1]) + fabs(n[2]) * f->p->dabs[2]; }

/* n . (x - pivot) + d <= 0 */
QN_INLINE void plane_prepare(const packet_facts *f, const double pivot[3], const double n[3], double d, uint32_t surface, uint32_t leaf, plane_constants *k) {
  const double en = weighed(f, pivot, n) + fabs(d), eden = steepest(f, n);
  k->n[0] = vset(n[0]), k->n[1] = vset(n[1]), k->n[2] = vset(n[2]);
  k->d = vset(d);
  k->en = bound(QN_WIDE_ROUND * QN_U * en + QN_WIDE_TINY);
  k->eden = bound(QN_WIDE_ROUND * QN_U * eden);
  k->steep = bound(QN_WIDE_STEEP * eden);
  k->px = vset(payload_bits(payload_of(surface, leaf, 0)));
}

/* Of the lanes that do not cross the plane, or only so slantwise that it is not solved: those that surely do not meet it within reach are in
   or out by num's sign, the others unsure. A slope is exactly 0 where each of its terms is: then there is no end to the reach. */
QN_INLINE void plane_beside(const packet_facts *f, const vd n[3], vd en, vd eden, const vd d[3], vd num, vd den, vm crosses, stretch *s) {
  const vd zero = vset(0);
  vd terms = vadd(vadd(vabs(vmul(n[0], d[0])), vabs(vmul(n[1], d[1]))), vabs(vmul(n[2], d[2])));
  vd drift = vadd(en, vpick(vlt(zero, terms), vmul(vadd(vabs(den), eden), vset(f->reach)), zero));
  vm in = vlt(num, vsub(zero, drift)), out = vandnot(vlt(drift, num), crosses);
  s->unsure = doubt(vandnot(vor(s->unsure, vandnot(vandnot(s->hit, crosses), in)), out));
  s->hit = vandnot(s->hit, out);
}

/* Meets s with the half-space; y: origins from the pivot. */
QN_INLINE void plane_meet(const packet_facts *f, const plane_constants *k, const vd y[3], const vd d[3], stretch *s) {
  const vd zero = vset(0), far = vset(QN_FAR), one = vset(1);
  vd num = vfma(k->n[0], y[0], vfma(k->n[1], y[1], vfma(k->n[2], y[2], k->d)));
  vd den = vfma(k->n[0], d[0], vfma(k->n[1], d[1], vmul(k->n[2], d[2])));
  vm crosses = vlt(k->steep, vabs(den));
  if (vbits(crosses) != QN_ALL_BITS) {
    plane_beside(f, k->n, k->en, k->eden, d, num, den, crosses, s);
  }
  vd inv = vdiv(one, vpick(crosses, den, one));
  vd t = vsub(zero, vmul(num, inv));
  vd error = CHECKED ? vmul(vfma(vabs(t), k->eden, k->en), vmul(vabs(inv), vset(QN_WIDE_SLACK))) : zero;
  s->error = vmax(s->error, vpick(crosses, error, zero));
  vm enters = vand(crosses, vlt(den, zero)), leaves = vandnot(crosses, enters);
  vd two = vmul(s->error, vset(2));
  vd ta = vpick(enters, t, vsub(zero, far)), tb = vpick(leaves, t, far);
  s->unsure = vor(s->unsure, vand(s->hit, vor(vand(enters, near_each_other(ta, s->a, two)), vand(leaves, near_each_other(tb, s->b, two)))));
  vm later = vlt(s->a, ta), sooner = vlt(tb, s->b);
  s->a = vpick(later, ta, s->a), s->pa = vpick(later, k->px, s->pa);
  s->b = vpick(sooner, tb, s->b), s->pb = vpick(sooner, k->px, s->pb);
}

/* Two planes that face apart, n . (x - pivot) + d0 <= 0 and -n . (x - pivot) + d1 <= 0, as the first that a whole line is met with: one division for both, and nothing that
   their places could be too near to. The numerators take one rounding more than a plane's. */
typedef struct slab_constants { vd n[3], d0, d1, en, eden, steep, p0, p1; } slab_constants;

QN_INLINE void slab_prepare(const packet_facts *f, const double pivot[3], const double n[3], double d0, double d1, uint32_t surface0, uint32_t surface1, uint32_t leaf,
                            slab_constants *k) {
  const double en = weighed(f, pivot, n) + most(fabs(d0), fabs(d1)), eden = steepest(f, n);
  k->n[0] = vset(n[0]), k->n[1] = vset(n[1]), k->n[2] = vset(n[2]);
  k->d0 = vset(d0), k->d1 = vset(d1);
  k->en = bound(QN_WIDE_ROUND * QN_U * en + QN_WIDE_TINY);
  k->eden = bound(QN_WIDE_ROUND * QN_U * eden);
  k->steep = bound(QN_WIDE_STEEP * eden);
  k->p0 = vset(payload_bits(payload_of(surface0, leaf, 0))), k->p1 = vset(payload_bits(payload_of(surface1, leaf, 0)));
}

/* s: a whole line. */
QN_INLINE void slab_meet(const packet_facts *f, const slab_constants *k, const vd y[3], const vd d[3], stretch *s) {
  const vd zero = vset(0), one = vset(1);
  vd place = vfma(k->n[0], y[0], vfma(k->n[1], y[1], vmul(k->n[2], y[2])));
  vd den = vfma(k->n[0], d[0], vfma(k->n[1], d[1], vmul(k->n[2], d[2])));
  vd num0 = vadd(place, k->d0), num1 = vsub(k->d1, place);
  vm crosses = vlt(k->steep, vabs(den));
  const int all = vbits(crosses) == QN_ALL_BITS;
  vd inv = vdiv(one, all ? den : vpick(crosses, den, one));
  vd t0 = vsub(zero, vmul(num0, inv)), t1 = vmul(num1, inv);
  vm falls = vlt(den, zero);
  s->a = vpick(falls, t0, t1), s->b = vpick(falls, t1, t0);
  s->pa = vpick(falls, k->p0, k->p1), s->pb = vpick(falls, k->p1, k->p0);
  s->error = CHECKED ? vmul(vfma(vmax(vabs(t0), vabs(t1)), k->eden, k->en), vmul(vabs(inv), vset(QN_WIDE_SLACK))) : zero;
  if (!all) {
    const vd nobody = vset(payload_bits(QN_NOBODY));
    s->a = vpick(crosses, s->a, vset(-QN_FAR)), s->b = vpick(crosses, s->b, vset(QN_FAR));
    s->pa = vpick(crosses, s->pa, nobody), s->pb = vpick(crosses, s->pb, nobody);
    s->error = vpick(crosses, s->error, zero);
    plane_beside(f, k->n, k->en, k->eden, d, num0, den, crosses, s);
    plane_beside(f, k->n, k->en, k->eden, d, num1, vsub(zero, den), crosses, s);
  }
}

/* After all parts are met: a stretch needs positive length, surely. What a part was unsure of does not matter when the others leave nothing:
   it could only take more away. */
QN_INLINE void stretch_settle(stretch *s) {
  vd two = vmul(s->error, vset(2)), length = vsub(s->b, s->a);
  vm none = vlt(length, vsub(vset(0), two)), some = vlt(two, length);
  s->unsure = doubt(vandnot(vor(s->unsure, vandnot(s->hit, some)), none));
  s->hit = vandnot(vand(s->hit, some), s->unsure);
}

/* --- box --------------------------------------------------------------------------------------------------------- */
QN_INLINE vd box_error(vd en, vd inv) { return vmul(vmul(en, vabs(inv)), vset(QN_WIDE_SLACK)); }

/* one_way: along that axis no lane goes back or stands: lo is then the plane that they meet first, which may be the upper one. error: of every lane, where `shared` says that they
   have one direction. */
typedef struct box_constants {
  vd lo[3], hi[3], en[3], plo[3], phi[3], error;
  int one_way[3], shared;
} box_constants;

QN_INLINE void box_prepare(const packet_facts *f, const qn_piece_box *b, box_constants *k) {
  k->shared = CHECKED && QN_LANES_NOW > 1 && f->p->tile == QN_TILE_ORIGINS;
  k->error = vset(0);
  for (int i = 0; i < 3; i++) {
    double size = most(fabs(b->lo[i]), fabs(b->hi[i])) + farthest(f, i, 0);
    const int back = QN_LANES_NOW > 1 && f->p->axis[i] == AXIS_DOWN;
    k->one_way[i] = back || (QN_LANES_NOW > 1 && f->p->axis[i] == AXIS_UP);
    k->lo[i] = vset(back ? b->hi[i] : b->lo[i]), k->hi[i] = vset(back ? b->lo[i] : b->hi[i]);
    k->en[i] = bound(QN_WIDE_ROUND * QN_U * size + 2 * b->off + QN_WIDE_TINY);
    k->plo[i] = vset(payload_bits(payload_of(b->surface[2 * i + back], b->head.leaf, 0)));
    k->phi[i] = vset(payload_bits(payload_of(b->surface[2 * i + 1 - back], b->head.leaf, 0)));
    if (k->shared) {
      k->error = vmax(k->error, box_error(k->en[i], vset(f->p->inv[i][0])));
    }
  }
}

QN_INLINE stretch box_solve(const packet_facts *f, const box_constants *k, int g) {
  const qn_packet *p = f->p;
  int at = g * QN_W;
  const vd zero = vset(0), far = vset(QN_FAR), near = vset(-QN_FAR), nobody = vset(payload_bits(QN_NOBODY));
  stretch s = {.a = near, .b = far, .pa = nobody, .pb = nobody, .error = k->error, .hit = vmask(QN_ALL_BITS), .unsure = vmask(0)};
  vd a[3], b[3], pa[3], pb[3];
  for (int i = 0; i < 3; i++) {
    vd o = vload(p->o[i] + at), inv = vload(p->inv[i] + at);
    if (CHECKED && !k->shared) {
      s.error = vmax(s.error, box_error(k->en[i], inv));
    }
    if (k->one_way[i]) {
      a[i] = vmul(vsub(k->lo[i], o), inv), b[i] = vmul(vsub(k->hi[i], o), inv);
      pa[i] = k->plo[i], pb[i] = k->phi[i];
      continue;
    }
    vm flat = vandnot(vmask(QN_ALL_BITS), vor(vlt(inv, zero), vlt(zero, inv))), down = vlt(inv, zero);
    vd low = vsub(k->lo[i], o), high = vsub(k->hi[i], o);
    vd t0 = vmul(low, inv), t1 = vmul(high, inv);
    a[i] = vpick(down, t1, t0), b[i] = vpick(down, t0, t1);
    pa[i] = vpick(down, k->phi[i], k->plo[i]), pb[i] = vpick(down, k->plo[i], k->phi[i]);
    if (vbits(flat)) { /* along the slab: in it, out of it, or too near to tell */
      vm out = vor(vlt(k->en[i], low), vlt(high, vsub(zero, k->en[i])));
      vm in = vand(vlt(low, vsub(zero, k->en[i])), vlt(k->en[i], high));
      s.hit = vandnot(s.hit, vand(flat, out));
      s.unsure = doubt(vor(s.unsure, vandnot(vandnot(flat, in), out)));
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
  vm apart = vor(vlt(two, vsub(s.a, second)), vle(second, near)); /* the first one stands alone */
  vm sooner = vlt(b[1], b[0]);
  first = vmin(b[0], b[1]), second = vmax(b[0], b[1]);
  s.pb = vpick(sooner, pb[1], pb[0]);
  sooner = vlt(b[2], first);
  second = vmin(second, vmax(first, b[2]));
  s.b = vmin(first, b[2]), s.pb = vpick(sooner, pb[2], s.pb);
  apart = vand(apart, vor(vlt(two, vsub(second, s.b)), vle(far, second)));
  /* A stretch needs positive length, surely; an edge counts only on a ray that meets the box. */
  const vd length = vsub(s.b, s.a);
  s.hit = vandnot(s.hit, vlt(length, vsub(zero, two)));
  s.unsure = doubt(vandnot(s.hit, vandnot(vand(apart, vlt(two, length)), s.unsure)));
  s.hit = vand(vandnot(s.hit, s.unsure), vlt(two, length));
  return s;
}

/* --- quadric body ------------------------------------------------------------------------------------------------ */
typedef struct body_constants {
  vd row[3][4], s[3], l, k, reach2, far2, ed_low, ed_high, ea, eh, ec, flat, gap, two_ed, slow, steep, plow, phigh;
  int sound;  /* 0: the bounds say nothing here, every lane is unsure */
  int linear; /* a = 0 in every lane, exactly */
} body_constants;

/* reach: no place of the leaf has a larger |X|. */
QN_INLINE void body_prepare(const packet_facts *f, const double pivot[3], const double row[3][4], const double s[3], double l, double k0, double reach,
                            uint32_t surface, uint32_t leaf, body_constants *k) {
  /* Sums in pairs, and nothing stored until all is read: this is a chain that the first lanes wait for. */
  double omega[3], delta[3], size[3];
  for (int i = 0; i < 3; i++) {
    omega[i] = weighed(f, pivot, row[i]) + fabs(row[i][3]);
    delta[i] = steepest(f, row[i]);
    size[i] = fabs(s[i]);
  }
  const double c = QN_WIDE_ROUND * QN_U, R = 2 * reach, D = (delta[0] + delta[1]) + delta[2], S = (size[0] + size[1]) + size[2];
  const double A = (size[0] * (delta[0] * delta[0]) + size[1] * (delta[1] * delta[1])) + size[2] * (delta[2] * delta[2]);
  const double H = fabs(l) * delta[2] + R * ((size[0] * delta[0] + size[1] * delta[1]) + size[2] * delta[2]);
  const double C = (2 * fabs(l) * R + fabs(k0)) + S * (R * R);
  /* Each coordinate of X is within e of O + t0 D for the very t0 that was computed: only the move's own rounding counts, which grows with |t0| and so
     as |D| shrinks; lanes with |D|^2 <= QN_WIDE_SLOW D^2 are not solved. */
  const double e = QN_WIDE_MOVE * c * (((omega[0] + omega[1]) + omega[2]) + R) + QN_WIDE_TINY;
  const double ea = c * A, eh = c * H + e * (D * S), ec = c * C + e * (S * (2 * R + e) + 2 * fabs(l));
  const double ed = QN_WIDE_SLACK * (((2 * H + eh) * eh + (A + ea) * ec) + (C * ea + c * (H * H + A * C))) + QN_WIDE_TINY * QN_WIDE_TINY;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 4; j++) {
      k->row[i][j] = vset(row[i][j]);
    }
    k->s[i] = vset(s[i]);
  }
  k->sound = !CHECKED || (isfinite(ed) && e <= R / 8);
  k->linear = A == 0 && l != 0;
  k->l = vset(l), k->k = vset(k0);
  k->reach2 = vset(R * R), k->far2 = vset(4 * R * R * QN_WIDE_SLACK);
  k->ed_low = bound(-ed), k->ed_high = bound(QN_WIDE_SHY * ed);
  k->ea = bound(ea), k->eh = bound(eh), k->ec = bound(ec);
  k->flat = bound(QN_WIDE_FLAT * A);
  k->gap = bound(QN_WIDE_SLACK * (eh + c * (2 * H + sqrt(A * C))));
  k->two_ed = bound(2 * QN_WIDE_SLACK * ed);
  k->slow = vset(QN_WIDE_SLOW * D * D);
  if (k->linear) { /* h = l D_2 alone */
    k->eh = vset(c * fabs(l) * delta[2]), k->steep = vset(QN_WIDE_STEEP * fabs(l) * delta[2]);
  }
  k->plow = vset(payload_bits(payload_of(surface, leaf, 0)));
  k->phigh = vset(payload_bits(payload_of(surface, leaf, QN_LARGER_ROOT)));
}

/* What a body leaves of a stretch, before it is met: the part from ta to tb; lanes that surely miss the leaf; lanes that it cannot tell. */
typedef struct body_part { vd ta, tb, pa, pb, error; vm out, bad; } body_part;

/* The lanes of `flat`, whose square term is too small to divide by. Where the constant outweighs the rest all over the part of the ray that can be in
   the leaf, |t - t0| <= v, they are in or out by its sign; a stretch that is elsewhere already misses the leaf. */
QN_INLINE void body_flat(const body_constants *k, vd t0, vd a, vd h, vd c, vd length2, vm flat, const stretch *s, body_part *part) {
  const vd zero = vset(0);
  vd v = vsqrt(vdiv(k->far2, length2));
  vd drift = vfma(vfma(vadd(vabs(a), k->ea), v, vmul(vset(2), vadd(vabs(h), k->eh))), v, k->ec);
  vm in = vlt(c, vsub(zero, drift)), out = vlt(drift, c);
  const vd error = vmul(s->error, vset(2));
  vm elsewhere = vor(vlt(error, vsub(s->a, vadd(t0, v))), vlt(error, vsub(vsub(t0, v), s->b)));
  out = vand(flat, vor(out, elsewhere));
  part->out = vor(part->out, out);
  part->bad = vor(part->bad, vandnot(vandnot(flat, in), out));
}

/* a = 0: one root, which has index 0. */
QN_INLINE void body_line(const body_constants *k, vd t0, vd h, vd c, vd length2, const stretch *s, body_part *part) {
  const vd zero = vset(0), one = vset(1);
  vm solved = vlt(k->steep, vabs(h)), rises = vand(solved, vlt(zero, h));
  vd inv = vdiv(vset(0.5), vpick(solved, h, one)), r = vmul(c, inv), t = vsub(t0, r);
  vd error = vmul(vfma(vmul(vset(2), vabs(r)), k->eh, k->ec), vmul(vabs(inv), vset(QN_WIDE_SLACK)));
  part->error = CHECKED ? vpick(solved, vfma(vabs(t0), vset(8 * QN_U), error), zero) : zero;
  part->tb = vpick(rises, t, part->tb), part->pb = k->plow;
  part->ta = vpick(vandnot(solved, rises), t, part->ta);
  vm beside = vandnot(vmask(QN_ALL_BITS), solved);
  if (vbits(beside)) {
    body_flat(k, t0, zero, h, c, length2, beside, s, part);
  }
}

/* A body that opens is outside its roots: the part before the first or after the second, whichever the rest of the leaf leaves. Where it leaves both, that is
   not for wide code. */
QN_INLINE void body_split(const body_constants *k, vd low, vd high, vd two, vm split, const stretch *s, body_part *part) {
  vm before = vlt(s->a, vsub(low, two)), after = vlt(vadd(high, two), s->b);
  vm not_before = vlt(vadd(low, two), s->a), not_after = vlt(s->b, vsub(high, two));
  vm only_before = vand(split, vand(before, not_after)), only_after = vand(split, vand(after, not_before));
  part->out = vor(part->out, vand(split, vand(not_before, not_after)));
  part->bad = vor(part->bad, vandnot(split, vor(vor(only_before, only_after), vand(not_before, not_after))));
  part->tb = vpick(only_before, low, part->tb), part->pb = vpick(only_before, k->plow, part->pb);
  part->ta = vpick(only_after, high, part->ta), part->pa = vpick(only_after, k->phigh, part->pa);
}

QN_INLINE void body_roots(const body_constants *k, vd t0, vd a, vd h, vd c, vd length2, const stretch *s, body_part *part) {
  const vd zero = vset(0), one = vset(1);
  vd disc = vsub(vmul(h, h), vmul(a, c));
  vm flat = vle(vabs(a), k->flat), real = vandnot(vlt(k->ed_high, disc), flat), none = vandnot(vlt(disc, k->ed_low), flat);
  vm opens = vlt(a, zero);
  part->bad = vor(part->bad, vandnot(vmask(QN_ALL_BITS), vor(flat, vor(real, none))));
  part->out = vor(part->out, vandnot(none, opens));
  vd inv = vdiv(one, vpick(real, a, one)), root = vsqrt(vpick(real, disc, zero));
  vd r0 = vmul(vsub(zero, vadd(h, root)), inv), r1 = vmul(vsub(root, h), inv);
  vd low = vadd(t0, vmin(r0, r1)), high = vadd(t0, vmax(r0, r1)), size = vabs(inv);
  vd error = vmul(size, vfma(k->ea, vmul(vset(2), vmax(vabs(r0), vabs(r1))), vfma(k->two_ed, vinverse_above(root), k->gap)));
  part->error = CHECKED ? vpick(real, vfma(vabs(t0), vset(8 * QN_U), error), zero) : zero;
  vm between = vandnot(real, opens), split = vand(vand(real, opens), s->hit);
  part->ta = vpick(between, low, part->ta), part->tb = vpick(between, high, part->tb);
  if (vbits(split)) {
    body_split(k, low, high, vmul(vset(2), vmax(s->error, part->error)), split, s, part);
  }
  flat = vandnot(flat, part->bad);
  if (vbits(flat)) {
    body_flat(k, t0, a, h, c, length2, flat, s, part);
  }
}

QN_INLINE void body_meet(const body_constants *k, const vd y[3], const vd d[3], stretch *s) {
  const vd zero = vset(0), one = vset(1);
  const vm all = vmask(QN_ALL_BITS);
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
  vm slow = vandnot(all, vlt(k->slow, length2));
  length2 = vpick(slow, one, length2);
  vd t0 = vsub(zero, vdiv(vfma(O[0], D[0], vfma(O[1], D[1], vmul(O[2], D[2]))), length2));
  for (int i = 0; i < 3; i++) {
    O[i] = vfma(t0, D[i], O[i]);
  }
  vd away2 = vfma(O[0], O[0], vfma(O[1], O[1], vmul(O[2], O[2])));
  body_part part = {.ta = vset(-QN_FAR), .tb = vset(QN_FAR), .pa = k->plow, .pb = k->phigh, .error = zero, .bad = slow};
  part.out = vlt(k->reach2, away2); /* nowhere within twice the leaf's reach */
  vd h = vmul(k->l, D[2]), c = vfma(vadd(k->l, k->l), O[2], k->k), a = zero;
  for (int i = 0; i < 3; i++) {
    vd sd = vmul(k->s[i], D[i]), so = vmul(k->s[i], O[i]);
    a = vfma(sd, D[i], a), h = vfma(sd, O[i], h), c = vfma(so, O[i], c);
  }
  if (k->linear) {
    body_line(k, t0, h, c, length2, s, &part);
  } else {
    body_roots(k, t0, a, h, c, length2, s, &part);
  }
  if (QN_UNLIKELY(vbits(slow))) { /* no bound holds for what was computed there: the lane is unsure, and keeps the whole line, so that nothing else comes out as certain */
    part.out = vandnot(part.out, slow);
    part.ta = vpick(slow, vset(-QN_FAR), part.ta), part.tb = vpick(slow, vset(QN_FAR), part.tb);
    part.error = vpick(slow, zero, part.error);
  }
  s->hit = vandnot(s->hit, part.out);
  s->error = vmax(s->error, part.error);
  vd two = vmul(s->error, vset(2));
  vm tied = vor(vand(vlt(vset(-QN_FAR), part.ta), near_each_other(part.ta, s->a, two)), vand(vlt(part.tb, vset(QN_FAR)), near_each_other(part.tb, s->b, two)));
  s->unsure = doubt(vandnot(vor(s->unsure, vand(s->hit, vor(part.bad, tied))), part.out));
  vm later = vlt(s->a, part.ta), sooner = vlt(part.tb, s->b);
  s->a = vpick(later, part.ta, s->a), s->pa = vpick(later, part.pa, s->pa);
  s->b = vpick(sooner, part.tb, s->b), s->pb = vpick(sooner, part.pb, s->pb);
}

#endif
