/* Balls: numbers of 256 bits with a bound of their error, for composing maps and rows on the way to the double shadows. Far
   cheaper than exact rationals, and precise enough that these are needed only where terms cancel.

   Legend: a ball stands for an exact number x. Its centre is sign m 2^(e - 256), m four limbs with the top bit set, so that
   2^(e-1) <= |centre| < 2^e; |x - centre| <= err 2^-253 |centre|. sign = 0: x is exactly 0. err = 0: x is exactly the centre.
   err = infinity: nothing is known (*unknown*), and whatever is made of it is unknown too. err never exceeds QN_BALL_ERR otherwise.

   A sum that cancels by more than QN_BALL_CANCEL bits is unknown unless it is exactly 0: where a cancelled sum of rounded numbers
   (design S2) counts as zero is decided in one place, number/num. */
#ifndef QN_SCENE_BALL_H
#define QN_SCENE_BALL_H

#include "number/num.h"

enum { QN_BALL_LIMBS = 4, QN_BALL_CANCEL = 100 };
#define QN_BALL_ERR 0x1p150

typedef struct qn_ball {
  mp_limb_t m[QN_BALL_LIMBS];
  int64_t e;
  double err;
  int sign;
} qn_ball;

#define QN_BALL_ZERO ((qn_ball){{0}, 0, 0, 0})

qn_ball qn_ball_from_num(qn_ctx *ctx, qn_num a);
qn_ball qn_ball_from_double(double a); /* finite */
QN_INLINE int qn_ball_known(const qn_ball *a) { return a->err <= QN_BALL_ERR; }
void qn_ball_neg(qn_ball *a);
void qn_ball_add(const qn_ball *a, const qn_ball *b, qn_ball *out); /* out may be a or b, in all of these */
void qn_ball_sub(const qn_ball *a, const qn_ball *b, qn_ball *out);
void qn_ball_mul(const qn_ball *a, const qn_ball *b, qn_ball *out);
void qn_ball_div(const qn_ball *a, const qn_ball *b, qn_ball *out); /* b is not the exact 0 */

/* The shadow of a known ball: its relative error is at most u (1 + 2^-40) (docs/bounds.md, QN_SHADOW); 0 for an exact zero; a
   size beyond QN_SHADOW_LARGEST or under its inverse is given as that. */
double qn_ball_to_double(const qn_ball *a);

#endif
