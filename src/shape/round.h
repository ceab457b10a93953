/* Frames for round primitives: placement by a base point and an axis, exactly where that is possible. See round.c. */
#ifndef QN_SHAPE_ROUND_H
#define QN_SHAPE_ROUND_H

#include "shape/exact.h"

typedef struct qn_frame {
  qn_num u[3][3];      /* u1, u2, w: orthogonal, right-handed, not of unit length */
  qn_num base[3];
  qn_num n2, nw, n1;   /* |u2|^2, |w|^2, |u1|^2 = n2 nw */
  qn_num length, flat; /* |w| and |u2|, once has_length and has_flat */
  int placed, has_length, has_flat;
} qn_frame;

/* placement null: the identity. Returns 0 when the axis is zero. */
int qn_frame_make(qn_ctx *ctx, const qn_placement *placement, qn_frame *out);
qn_num qn_frame_length(qn_ctx *ctx, qn_frame *frame);

/* A quadric about the frame's axis, in its local unit coordinates x, y, z:
   a x^2 + b y^2 + c Z^2 + 2 l Z + k <= 0 with Z = p z + q. The form that is made is a positive multiple of it. */
typedef struct qn_round_body { qn_num a, b, c, l, k, p, q; } qn_round_body;
void qn_frame_body(qn_ctx *ctx, qn_frame *frame, const qn_round_body *body, qn_half_form *out);

/* The plane z <= at (side 1) or z >= at (side -1). */
void qn_frame_cap(qn_ctx *ctx, qn_frame *frame, uint32_t role, int side, qn_num at, qn_half_form *out);

/* The plane a x + b y + c z <= d in the local unit coordinates, up to a positive multiple. */
void qn_frame_plane(qn_ctx *ctx, qn_frame *frame, uint32_t role, const qn_num abcd[4], qn_half_form *out);

/* The same frame in doubles, for support functions and (u, v). v in the frame's coordinates, and the share of the base:
   v . (base + R local) = v . base + v' . local. placement null: v unchanged. Errors: at most 34u |v| in each v'. */
void qn_frame_direction(const double placement[6], const double v[3], double local[3]);
void qn_frame_point(const double placement[6], const double x[3], double local[3]);
double qn_frame_base(const double placement[6], const double v[3], double *magnitude);

/* The support of the hull of two ellipses about the axis, z = z1 with semi-axes a1, b1 and z = z2 with a2, b2.
   size: at least the length of any point of it. */
double qn_frame_two_discs(const double placement[6], const double v[3], double z1, double a1, double b1, double z2, double a2, double b2,
                          double size);
/* The slack of a support in a frame: QN_SUPPORT_SLACK(12) unplaced, of the terms; placed QN_SUPPORT_SLACK(64), of |v| size + |v .
   base| terms. */
double qn_frame_outward(const double placement[6], const double v[3], double sum, double magnitude, double size);

#endif
