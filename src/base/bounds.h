/* Every error bound: its name, its constant, its inequality. Derivations: docs/bounds.md, under the same names; tests:
   tests/ray/test_bounds.c, under the same names, in rationals; proofs: tests/bounds/. No other tolerance stands anywhere in the code. */
#ifndef QN_BASE_BOUNDS_H
#define QN_BASE_BOUNDS_H

#define QN_U 0x1p-53 /* unit roundoff, round to nearest */

/* A hit's point o + t d in doubles, t rounded to nearest, and that point moved and rounded again, is within
   QN_SHADE_POINT (|t d_i| + |point_i|) of the true one, coordinate by coordinate. Of use to pictures only. */
#define QN_SHADE_POINT 0x1p-51

/* The double shadow of an exact number x != 0 is within QN_SHADOW |x| of it, QN_SHADOW >= u (1 + 2^-42); a size beyond
   QN_SHADOW_LARGEST = 2^QN_SHADOW_EXPONENT, or under its inverse, is given as that. */
#define QN_SHADOW (QN_U * (1 + 0x1p-40))
#define QN_SHADOW_EXPONENT 1000
#define QN_SHADOW_LARGEST 0x1p+1000

/* Fingerprints of surfaces (scene/fingerprint.c). QN_PRINT_TERM >= 22u: a world coefficient's error, relative to the sum of its terms'
   magnitudes. A fingerprint's error is at most QN_PRINT_GROW times the sum of those errors; it is used when that is at most
   QN_PRINT_ERROR. Cells of candidates are QN_PRINT_CELL wide. */
#define QN_PRINT_TERM (24 * QN_U)
#define QN_PRINT_GROW 128
#define QN_PRINT_ERROR 0x1p-36
#define QN_PRINT_CELL 0x1p-33

/* Polyhedra as they are written (src/model/polyhedron_face.c): n.p - d from the doubles nearest to its numbers, each 0 or of a size between
   QN_POLYHEDRON_LARGEST and its inverse, is within QN_POLYHEDRON_SIDE >= 7u times the sum of its terms' sizes, all as computed. */
#define QN_POLYHEDRON_SIDE (8 * QN_U)
#define QN_POLYHEDRON_LARGEST 0x1p+300

/* Ray and box. QN_BOX_SLACK >= 6.05u: relative widening of the parameters at which a line meets the planes of a box.
   QN_BOX_LARGEST: an axis with |o| or 1/|d| beyond it is not used. QN_BOX_TINY >= any loss by underflow within that range. */
#define QN_BOX_SLACK (8 * QN_U)
#define QN_BOX_LARGEST 0x1p+400
#define QN_BOX_TINY 0x1p-1000

/* Support functions (shape/). A sum of terms with magnitudes T, each made by at most n - 2 roundings of relative u, is increased by
   QN_SUPPORT_SLACK(n) T and is then not below the true sum. QN_SUPPORT_TINY: a term below it gets that magnitude. */
#define QN_SUPPORT_SLACK(n) ((n) * QN_U)
#define QN_SUPPORT_TINY 0x1p-960

/* The superquadric's norm G = ((|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n))^(n/2) as computed, x, y, z each within 2u of itself, the
   exponents within u: |G^ - G| <= QN_SUPER_NORM(e, n) G. Assumes pow within 1 ulp (2u). */
#define QN_SUPER_NORM(e, n) ((11 + 2 * (e) + 2 * (n)) * QN_U)
/* t = min/max below QN_SUPER_RATIO may have lost bits to underflow; where t^p then still counts, no bound is given. */
#define QN_SUPER_RATIO 0x1p-1000
/* phi(r) = (1 + r^p)^(1/p - 1), p = 2/e, r within 3u: relative error at most QN_SUPER_SLOPE(e, p) (1 + |ln r|); at QN_SUPER_SLOPE_MOST
   and beyond it is not computed. */
#define QN_SUPER_SLOPE(e, p) ((16 + 8 * (p) + 4 * (e)) * QN_U)
#define QN_SUPER_SLOPE_MOST 0x1p-12
/* Widths, as shares of the longest stretch of a line of the ray's direction in the solid's box: below QN_SUPER_NARROW a stretch is not divided (S10 promises 2^-40);
   a root is refined in MPFR when doubles leave it wider than QN_SUPER_FINE. */
#define QN_SUPER_NARROW 0x1p-46
#define QN_SUPER_FINE 0x1p-44
#define QN_SUPER_MARGIN 0x1p-30 /* the stretch is widened by this share at either end */
/* The superquadric's f = rho^q + z^q along a line as computed (src/shape/superquadric_line.c), s = e/n where rho^q takes a second power, else 0:
     |f^ - f| <= (QN_SUPER_VALUE(s, q) + QN_SUPER_BEYOND max(f^ - 1, 0)) f^ + QN_SUPER_VALUE_0
   which also holds two roundings of each coordinate, relatively 2u; in long doubles of 64 bits and more, QN_SUPER_FINER times that. Each
   addend of df/dt is within QN_SUPER_RATE of itself and QN_SUPER_FADED max |D_i| (underflow). A tangent's step is shortened by QN_SUPER_TANGENT of itself.
   QN_SUPER_LEAST, QN_SUPER_MOST: the range of exponents for that (0 too for e), s at most QN_SUPER_QUOTIENT; QN_SUPER_SHORT, QN_SUPER_LONG: |O_i| and |D_i| that are not 0
   are at least the one, |D_i| at most the other. */
#define QN_SUPER_VALUE(s, q) ((6 + 12 * (s) + 4 * (q)) * QN_U)
#define QN_SUPER_VALUE_0 (6 * QN_U)
#define QN_SUPER_BEYOND (8 * QN_U)
#define QN_SUPER_FINER 0x1p-10
#define QN_SUPER_RATE 0x1p-38
#define QN_SUPER_FADED 0x1p-300
#define QN_SUPER_TANGENT (32 * QN_U)
#define QN_SUPER_LEAST 0x1p-9
#define QN_SUPER_MOST 0x1p+3
#define QN_SUPER_QUOTIENT 0x1p+9
#define QN_SUPER_SHORT 0x1p-200
#define QN_SUPER_LONG 0x1p+200
/* A line whose largest |D_i| is below 2^-QN_SUPER_USUAL or beyond 2^QN_SUPER_USUAL is scaled to about 1. */
#define QN_SUPER_USUAL 64
/* Bits of MPFR along a ray: a sign is given when |G - 1| passes the bound above with 2^-QN_SUPER_BITS for u. */
#define QN_SUPER_BITS 256
/* A line in the solid's frame, as pairs of doubles: |O_i - (O_i^ + o_i^)| <= QN_SUPER_FRAME times the sum of its terms' sizes, D_i alike. A coordinate O_i + t D_i of these is
   within 2u of itself, QN_SUPER_LOW (|O_i| + |t D_i|) and the pairs' own errors; that sum over |X_i| is at most QN_SUPER_CRUDE where f is given at all with an exponent beyond 2.
   QN_SUPER_GAP: the share of the size to either side of a coordinate plane on which a piece begins. */
#define QN_SUPER_FRAME 0x1p-99
#define QN_SUPER_LOW 0x1p-104
#define QN_SUPER_CRUDE 0x1p-6
#define QN_SUPER_GAP 0x1p-47
#define QN_SUPER_FAR 0x1p+6 /* sizes: a line whose t's on the solid are beyond that is begun anew there */

/* One step outward: x + QN_STEP |x| + 2^-1074 is at least the next double above x. */
#define QN_STEP 0x1p-52

/* The filter along a line (ray/filter.c). Legend: y the line's origin relative to a leaf's pivot, W its weight (|y^ - y| <= u W, |y^| <= W);
   X = row . (y, 1), Omega = sum |row_j| W_j + |row_3|; D = row . d, Delta likewise; Omega' = |X^| + QN_MAP_E Omega, Delta' = |D^| + QN_MAP_E Delta;
   p(s) = a s^2 + 2 h s + c, S = |s_i|. Stored entries are within u (1 + 2^-40), relatively.
     |X^ - X| <= QN_MAP_E Omega, |D^ - D| <= QN_MAP_E Delta
     |a^ - a| <= QN_QUAD_A_E sum S Delta' Delta
     |h^ - h| <= QN_QUAD_H_E (sum S (Omega' Delta + Omega Delta') + |l| Delta_2)
     |c^ - c| <= QN_QUAD_C_E (sum S Omega' Omega + |l| Omega_2) + QN_QUAD_K_E |k| */
#define QN_MAP_E (6.25 * QN_U)
#define QN_QUAD_A_E (17.25 * QN_U)
#define QN_QUAD_H_E (9.25 * QN_U)
#define QN_QUAD_C_E (20.25 * QN_U)
#define QN_QUAD_K_E (2.25 * QN_U)
/* |disc^ - disc| <= Ed = QN_SLACK ((2|h|+Eh) Eh + (|a|+Ea) Ec + |c| Ea + QN_DISC_E (h^2 + |a c| + |disc^|)) + QN_TINY */
#define QN_DISC_E (1.25 * QN_U)
/* The root nearest to s is within R / sqrt(disc^ - Ed), and of a = 0 within R / (2 (|h| - Eh)), with
   R = |p^(s)| + Ea s^2 + 2 Eh |s| + Ec + QN_ROOT_E (|a| s^2 + 2 |h s| + |c|) + QN_TINY, times QN_SLACK. */
#define QN_ROOT_E (4.25 * QN_U)
/* Over the roundings made in evaluating a bound. */
#define QN_SLACK (1 + 0x1p-20)
/* Over any loss by underflow there. */
#define QN_TINY 0x1p-1060
/* The filter's range: a number beyond QN_FILTER_LARGEST passes all on; one below QN_FLUSH counts as 0 with the weight
   QN_FLUSH_WEIGHT = QN_FLUSH / u; a line is not moved by a product below QN_SHIFT_LEAST. */
#define QN_FILTER_LARGEST 0x1p+64
#define QN_FLUSH 0x1p-64
#define QN_FLUSH_WEIGHT 0x1p-11
#define QN_SHIFT_LEAST 0x1p-128

/* Rounding a place (ray/round.c). Legend: x = o + t d in double-doubles, X_j = |o_j| + |t d_j|, M = sum |K_i| times the monomial i of X
   (K the surface's coefficients), M' = sum of |d_j| times the like sum for the gradient's component j, A = the quadratic part of M at |d|.
     |p^(t) - p(t)| <= QN_DD_EVAL M + QN_DD_TINY, |p'^ - p'| <= QN_SLOPE_E M'
   and the root r nearest to t, |r - t| <= e, is within (QN_SLOPE_E M' e + A e^2 + QN_DD_EVAL M + QN_DD_TINY)/|p'^| + 4u |p^/p'^|
   of t - p^/p'^, times QN_SLACK. QN_DD_LARGEST: beyond it, or below its inverse, nothing is tried. */
#define QN_DD_EVAL 0x1p-98
#define QN_DD_TINY 0x1p-500
#define QN_SLOPE_E (12 * QN_U)
#define QN_DD_LARGEST 0x1p+100

/* Wide code (src/wide/). QN_WIDE_ROUND >= 14: a formula of wide code, its inputs with relative error up to 6u, is within
   QN_WIDE_ROUND u times the sum of its terms' magnitudes. QN_WIDE_SHY: discriminants under so many times their bound are not
   solved there; it trades rays given up against the error of the roots that are kept, and no answer depends on it.
   QN_WIDE_STEEP, QN_WIDE_FLAT: a slope or square term under that share of its terms' magnitudes is not divided by; each is 2^24 times
   its relative error and more, so that QN_WIDE_SLACK covers the second order and the roundings of every bound.
   QN_WIDE_SLOW, QN_WIDE_MOVE: X = O^ + t0 D^ is within QN_WIDE_MOVE QN_WIDE_ROUND u (Omega + R) of O + t0 D, |X| <= R, while
   |D|^2 > QN_WIDE_SLOW times its packet's bound: QN_WIDE_MOVE QN_WIDE_ROUND >= 6.1 + 5.2 / sqrt(QN_WIDE_SLOW).
   QN_WIDE_LARGEST: coordinates, components and pieces' numbers beyond it, or (not coordinates) under its inverse, are left to others;
   then QN_WIDE_TINY exceeds any loss by underflow. QN_WIDE_FLOAT >= 3 2^-24: relative widening of a slab's 1/d.
   QN_WIDE_SPOT >= 4u: a place's point, relative to its terms. QN_FLOAT_STEP > 2^-24, QN_FLOAT_TINY > 2^-150: past a float's own rounding. */
#define QN_WIDE_ROUND 32
#define QN_WIDE_SHY 0x1p14
#define QN_WIDE_SHY_ROOT 0x1p-7 /* 1 / sqrt(QN_WIDE_SHY) */
#define QN_WIDE_STEEP 0x1p-24
#define QN_WIDE_FLAT 0x1p-20
#define QN_WIDE_SLACK (1 + 0x1p-10)
#define QN_WIDE_SLOW 0x1p-10
#define QN_WIDE_MOVE 8
#define QN_WIDE_LARGEST 0x1p+100
#define QN_WIDE_TINY 0x1p-400
#define QN_WIDE_FLOAT 0x1p-20
#define QN_WIDE_SPOT 0x1p-40
#define QN_FLOAT_STEP 0x1p-22f
#define QN_FLOAT_TINY 0x1p-126f

/* Near surfaces (scene/near_item.c), from shadows. A unit normal's components are within QN_NEAR_NORMAL. Unit rows with a determinant above QN_NEAR_FLAT,
   and forms whose terms are not more than 1/QN_NEAR_FLAT times their quadratic part, are looked at; of a plane's offset, and of a centre where no
   entry of the rows' inverse is 2 or more, the error is QN_NEAR_PLACE and 4 QN_NEAR_PLACE of the terms' magnitudes, else of a centre 1/QN_NEAR_FLAT times that. f of a
   quadratic part is within QN_NEAR_SHAPE. */
#define QN_NEAR_NORMAL 0x1p-46
#define QN_NEAR_PLACE 0x1p-40
#define QN_NEAR_FLAT 0x1p-16
#define QN_NEAR_SHAPE 0x1p-24

/* Rounding places in wide code (src/wide/newton.h, scene/rounding.h). Legend: y = o - c + t d with c the surface's pivot; over the
   coordinates that occur, S = sum |o_j - c_j| + |t d_j|, D = sum |d_j|; K2, K1, K0 the surface's SQUARE, LINEAR and CONSTANT; a = q2(d).
     |p^(t) - p(t)| <= QN_ROUND_EVAL (K2 S^2 + K1 S + K0) + u |p^|,  |p'^ - p'| <= QN_ROUND_SLOPE D (2 K2 S + K1),  |a| <= K2 D^2
   for S <= QN_ROUND_LARGEST and D within QN_ROUND_WIDEST and its inverse. Coefficients below 2^QN_ROUND_DROP are dropped: the three
   sizes named tiny, added to K2, K1 and K0, cover that and any underflow. */
#define QN_ROUND_EVAL 0x1p-98
/* QN_ROUND_PAIR_EVAL instead, and S with sum |o_j| more, where o and d are pairs of doubles within 2^-104 of the line's numbers. */
#define QN_ROUND_PAIR_EVAL 0x1p-97
#define QN_ROUND_SLOPE (32 * QN_U)
#define QN_ROUND_DROP (-240)
#define QN_ROUND_SQUARE_TINY 0x1p-236
#define QN_ROUND_LINEAR_TINY 0x1p-80
#define QN_ROUND_TINY 0x1p-56
#define QN_ROUND_LARGEST 0x1p+42
/* A place (X - o) / d on a plane across an axis (src/wide/spans_flat.h) is within QN_ROUND_FLAT (|X| + |o|) |fl(1/d)| of the sum that is rounded, while |X - o| and 1/|d| are
   within QN_ROUND_WIDEST and its inverse and |X| + |o| is below it. */
#define QN_ROUND_FLAT 0x1p-99
#define QN_ROUND_WIDEST 0x1p+400

/* Rounding places on a ball (wide/round_ball.h). Legend: rho the power of two with rho <= sqrt(r2) < 2 rho, p = |y|^2 - r^2, y = o - c + t d, S = y . d, d_most
   as in a packet. Where |t| + e <= QN_BALL_FAR rho / d_most and no coordinate of the centre exceeds QN_BALL_FAR sqrt(r2), and |p^| <= rho^2,
     |p^ - p| <= QN_BALL_EVAL rho^2 + QN_BALL_OFF rho off + u |p^|,  |S^ - S| <= QN_BALL_SLOPE rho d_most
   QN_BALL_GRID rho: added and taken away, rounds to multiples of 2^-24 rho; QN_BALL_GRID_2 rho^2: to the squares of such. Rests are 0 or at least QN_BALL_LEAST, so
   that they do not underflow as floats. */
#define QN_BALL_EVAL 0x1p-70
#define QN_BALL_OFF 0x1p-20
#define QN_BALL_SLOPE 0x1p-48
#define QN_BALL_FAR 0x1p+24
#define QN_BALL_GRID 0x1.8p+28
#define QN_BALL_GRID_2 24.0
#define QN_BALL_LEAST 0x1p-100

/* Rays of one direction d and balls, seen along d (wide/outline.h). Legend: e two axes across d, y from the tile's first lane, O the sum of the origins' largest coordinates.
   Where e . y of a ball's centre is farther than r + off + half + QN_OUTLINE_PLACE (|y|_1 + O) from the middle of four lanes, which are within half, they all miss the ball. |e . d| <= QN_OUTLINE_SKEW |d|.
   QN_OUTLINE_FLOAT, of the tile's width, QN_OUTLINE_SQUARE: what floats round. */
#define QN_OUTLINE_SKEW 0x1p-44
#define QN_OUTLINE_PLACE 0x1p-40
#define QN_OUTLINE_FLOAT 0x1p-21
#define QN_OUTLINE_SQUARE (1 + 0x1p-19)

/* A point against a leaf's shadow (query/point.c). Legend as above with W the point's weight (|true y - y| <= u W, |y| <= W);
   Omega' = |X^| + QN_POINT_MAP_E Omega. Wherever every Omega and every |s|, |l| is at most QN_POINT_LARGEST,
     |X^ - X| <= QN_POINT_MAP_E Omega + QN_POINT_TINY
     |q^ - q| <= QN_POINT_FORM_E (sum S Omega' Omega + |l| Omega_2 + |k|) + QN_POINT_TINY */
#define QN_POINT_MAP_E (7 * QN_U)
#define QN_POINT_FORM_E (24 * QN_U)
#define QN_POINT_LARGEST 0x1p+100
#define QN_POINT_TINY 0x1p-700
/* A point against a ball and an aligned box of wide code (wide/inside.h). y the point from the centre as stored, e = off + u weight:
     | |y|^2 - r2 | is within QN_POINT_BALL_E (|y|^2 + r2) + e (3 sum |y_i| + 4 e) + QN_POINT_TINY of the truth,
   and the distance to a face is within QN_POINT_BOX_SLACK e + QN_POINT_TINY of it where it exceeds that. */
#define QN_POINT_BALL_E (10 * QN_U)
#define QN_POINT_BOX_SLACK (1 + 0x1p-10)

#endif
