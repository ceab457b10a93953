/* The primitives' definitions as a text book writes them (unplaced), apart from the code under test: -1 inside, 0 on, 1 out. */
#ifndef TEXTBOOK_H
#define TEXTBOOK_H

#include "shapes.h"

static inline int sign_of(bench *b, qn_num x, qn_num y) { return CMP(x, y); } /* the sign of x - y */

/* z within [lo, hi] */
static inline int slab_side(bench *b, qn_num z, qn_num lo, qn_num hi) { return larger(sign_of(b, lo, z), sign_of(b, z, hi)); }

/* (x/a)^2 + (y/b)^2 */
static inline qn_num ellipse_of(bench *b, const qn_num x[3], qn_num a, qn_num c) { return ADD(SQ(DIV(x[0], a)), SQ(DIV(x[1], c))); }

static inline qn_num quadric_at(bench *b, const qn_num a[10], const qn_num x[3]) {
  qn_num q = a[9];
  q = ADD(q, ADD(MUL(a[0], SQ(x[0])), ADD(MUL(a[1], SQ(x[1])), MUL(a[2], SQ(x[2])))));
  q = ADD(q, ADD(MUL(a[3], MUL(x[0], x[1])), ADD(MUL(a[4], MUL(x[0], x[2])), MUL(a[5], MUL(x[1], x[2])))));
  return ADD(q, ADD(MUL(a[6], x[0]), ADD(MUL(a[7], x[1]), MUL(a[8], x[2]))));
}

static inline int textbook(bench *b, qn_prim prim, const qn_num *a, const qn_num x[3]) {
  switch (prim) {
    case QN_SPHERE: return sign_of(b, ADD(ADD(SQ(x[0]), SQ(x[1])), SQ(x[2])), SQ(a[0]));
    case QN_ELLIPSOID: return sign_of(b, ADD(ellipse_of(b, x, a[0], a[1]), SQ(DIV(x[2], a[2]))), INT(1));
    case QN_CUBE: {
      int most = -1;
      for (int i = 0; i < 3; i++) {
        qn_num lo = qn_num_is_zero(a[3]) ? INT(0) : DIV(a[i], INT(-2));
        most = larger(most, slab_side(b, x[i], lo, ADD(lo, a[i])));
      }
      return most;
    }
    case QN_WEDGE: {
      qn_num y[3], one = INT(1), zero = INT(0);
      for (int i = 0; i < 3; i++) { /* in shares of the size */
        y[i] = ADD(DIV(x[i], a[i]), qn_num_is_zero(a[3]) ? zero : DIV(one, INT(2)));
      }
      int most = slab_side(b, y[1], zero, one);
      most = larger(most, larger(sign_of(b, zero, y[0]), sign_of(b, zero, y[2])));
      return larger(most, sign_of(b, ADD(y[0], y[2]), one));
    }
    case QN_CYLINDER: { /* h, a1, b1, a2, b2, center: the section at the share t of the height is an ellipse */
      qn_num lo = qn_num_is_zero(a[5]) ? INT(0) : DIV(a[0], INT(-2));
      int caps = slab_side(b, x[2], lo, ADD(lo, a[0]));
      if (caps > 0) {
        return 1;
      }
      qn_num t = DIV(SUB(x[2], lo), a[0]), A = ADD(a[1], MUL(t, SUB(a[3], a[1]))), B = ADD(a[2], MUL(t, SUB(a[4], a[2])));
      if (qn_num_is_zero(A)) {
        return qn_num_is_zero(x[0]) && qn_num_is_zero(x[1]) ? 0 : 1;
      }
      return larger(caps, sign_of(b, ellipse_of(b, x, A, B), INT(1)));
    }
    case QN_PARABOLOID: {
      qn_num z = qn_num_is_zero(a[3]) ? x[2] : ADD(x[2], DIV(a[0], INT(2)));
      return larger(sign_of(b, z, a[0]), sign_of(b, ellipse_of(b, x, a[1], a[2]), DIV(z, a[0])));
    }
    case QN_HYPERBOLOID1: {
      qn_num k = DIV(SUB(SQ(a[1]), SQ(a[2])), SQ(a[0])), r2 = ADD(SQ(a[2]), MUL(k, SQ(x[2])));
      return larger(slab_side(b, x[2], SUB(INT(0), a[0]), a[0]), sign_of(b, ADD(SQ(x[0]), SQ(x[1])), r2));
    }
    case QN_HYPERBOLOID2: {
      qn_num r2 = DIV(MUL(SQ(a[1]), SUB(SQ(x[2]), SQ(a[2]))), SUB(SQ(a[0]), SQ(a[2])));
      return larger(slab_side(b, x[2], SUB(INT(0), a[0]), a[0]), sign_of(b, ADD(SQ(x[0]), SQ(x[1])), r2));
    }
    case QN_SADDLE: return sign_of(b, x[2], SUB(SQ(DIV(x[0], a[0])), SQ(DIV(x[1], a[1]))));
    case QN_HALFSPACE: return sign_of(b, ADD(ADD(MUL(a[0], x[0]), MUL(a[1], x[1])), MUL(a[2], x[2])), a[3]);
    case QN_QUADRIC: return qn_num_sign(quadric_at(b, a, x));
    default: break;
  }
  fail_msg("no definition for primitive %d", (int)prim);
  return 0;
}

#endif
