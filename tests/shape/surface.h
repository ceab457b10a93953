/* Rational points on the surfaces of the unplaced primitives. */
#ifndef SURFACE_H
#define SURFACE_H

#include "shapes.h"

/* A rational point of the unit circle: ((1 - t^2)/(1 + t^2), 2t/(1 + t^2)), t near tan(angle / 2). */
static inline void circle_at(bench *b, double angle, qn_num cs[2]) {
  qn_num t = qn_num_from_double(&b->ctx, tan(0.5 * angle)), t2 = SQ(t), d = ADD(INT(1), t2);
  cs[0] = DIV(SUB(INT(1), t2), d);
  cs[1] = DIV(ADD(t, t), d);
}
static inline void circle_point(bench *b, qn_num cs[2]) {
  circle_at(b, (double)(1 + below(b, 400)) / 64, cs);
}

/* A rational point on the surface (body, cap, rim or apex); 0 where none is known for this primitive. */
static inline int surface_point(bench *b, qn_prim prim, const qn_num *a, qn_num x[3]) {
  qn_num c[2], d[2], zero = INT(0), share = DIV(INT(below(b, 9)), INT(8));
  circle_point(b, c);
  circle_point(b, d);
  switch (prim) {
    case QN_SPHERE:
    case QN_ELLIPSOID:
      x[0] = MUL(a[0], MUL(c[0], d[0]));
      x[1] = MUL(a[prim == QN_SPHERE ? 0 : 1], MUL(c[1], d[0]));
      x[2] = MUL(a[prim == QN_SPHERE ? 0 : 2], d[1]);
      return 1;
    case QN_CUBE: {
      int face = below(b, 6);
      for (int i = 0; i < 3; i++) {
        qn_num s = i == face / 2 ? INT(face % 2) : DIV(INT(below(b, 9)), INT(8));
        x[i] = MUL(a[i], qn_num_is_zero(a[3]) ? s : SUB(s, DIV(INT(1), INT(2))));
      }
      return 1;
    }
    case QN_WEDGE: {
      qn_num s[3] = {share, DIV(INT(below(b, 9)), INT(8)), SUB(INT(1), share)};
      for (int i = 0; i < 3; i++) {
        x[i] = MUL(a[i], qn_num_is_zero(a[3]) ? s[i] : SUB(s[i], DIV(INT(1), INT(2))));
      }
      return 1;
    }
    case QN_CYLINDER:
      x[0] = MUL(c[0], ADD(a[1], MUL(share, SUB(a[3], a[1]))));
      x[1] = MUL(c[1], ADD(a[2], MUL(share, SUB(a[4], a[2]))));
      x[2] = MUL(a[0], qn_num_is_zero(a[5]) ? share : SUB(share, DIV(INT(1), INT(2))));
      return 1;
    case QN_PARABOLOID:
      x[0] = MUL(c[0], MUL(share, a[1]));
      x[1] = MUL(c[1], MUL(share, a[2]));
      x[2] = SUB(MUL(a[0], SQ(share)), qn_num_is_zero(a[3]) ? zero : DIV(a[0], INT(2)));
      return 1;
    case QN_HYPERBOLOID1: { /* the rims, the waist, the caps */
      int k = below(b, 3) - 1;
      qn_num r = k ? MUL(a[1], share) : a[2];
      x[0] = MUL(c[0], r);
      x[1] = MUL(c[1], r);
      x[2] = MUL(INT(k), a[0]);
      return 1;
    }
    case QN_HYPERBOLOID2: {
      int k = below(b, 4);
      qn_num r = k < 2 ? MUL(a[1], share) : zero;
      x[0] = MUL(c[0], r);
      x[1] = MUL(c[1], r);
      x[2] = MUL(INT(k % 2 ? 1 : -1), a[k < 2 ? 0 : 2]);
      return 1;
    }
    case QN_SADDLE:
      x[0] = ratio(b, 20, 7);
      x[1] = ratio(b, 20, 3);
      x[2] = SUB(SQ(DIV(x[0], a[0])), SQ(DIV(x[1], a[1])));
      return 1;
    case QN_HALFSPACE: {
      int k = 0;
      while (k < 2 && qn_num_is_zero(a[k])) {
        k++;
      }
      if (qn_num_is_zero(a[k])) {
        return 0;
      }
      qn_num rest = a[3];
      for (int i = 0; i < 3; i++) {
        x[i] = ratio(b, 9, 4);
        rest = i == k ? rest : SUB(rest, MUL(a[i], x[i]));
      }
      x[k] = DIV(rest, a[k]);
      return 1;
    }
    default: return 0;
  }
}

#endif
