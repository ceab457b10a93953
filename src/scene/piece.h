/* Pieces: what wide code needs of each leaf of the normal form, in the order in which it is walked, in units of a cache
   line so that a plain leaf is one line. Made once, from the shadows; every value a copy of them, so no new rounding. */
#ifndef QN_SCENE_PIECE_H
#define QN_SCENE_PIECE_H

#include "base/mem.h"

typedef enum qn_piece_kind {
  QN_PIECE_SPHERE, /* one line: |x - centre|^2 <= r2 */
  QN_PIECE_BOX,    /* two lines: lo <= x <= hi, in world coordinates */
  QN_PIECE_ROUND,  /* four lines: a quadric body and a pair of parallel caps on its third row (either may be missing) */
  QN_PIECE_MEET,   /* one line: any convex meet of planes and quadrics, read from the scene's halves */
  QN_PIECE_HARD    /* one line: not for wide code (superquadrics): every ray that meets its box is answered by the woven path */
} qn_piece_kind;

/* The most half-spaces of each kind in a meet. */
enum { QN_MEET_PLANES = 20, QN_MEET_BODIES = 4 };

typedef struct qn_piece_head {
  uint16_t kind, flags; /* flags: QN_BALL_.. */
  uint32_t leaf;
} qn_piece_head;
/* Of spheres, so that a hit is described without its leaf: one written as a sphere and only shifted (its own coordinates are x - centre - rest), and whether
   its leaf is negated. */
enum { QN_BALL_SHIFTED = 1, QN_BALL_NEGATED = 2 };

typedef struct qn_piece_sphere {
  qn_piece_head head;
  double centre[3]; /* the pivot: the true centre is within `off` of it, axis by axis */
  double r2;        /* relative error 8u at most, the squares' shares included */
  /* For rounding (wide/round_ball.h): the true centre is centre + rest, the true r^2 is r2 + r2_rest, each rest within 2^-23 of itself.
     r2_rest infinite: nothing of the kind is known, or the centre is QN_BALL_FAR radii from 0. */
  float rest[3], r2_rest;
  float off;
  uint32_t surface;
} qn_piece_sphere;

typedef struct qn_piece_box {
  qn_piece_head head;
  uint32_t surface[6]; /* -x, +x, -y, +y, -z, +z */
  uint32_t unused[2];
  double lo[3], hi[3];  /* within `off` of the true planes */
  double off;
  double unused2[4];
} qn_piece_box;

typedef struct qn_piece_round {
  qn_piece_head head;
  uint32_t surface[3]; /* body, low cap, high cap; UINT32_MAX: no such cap */
  uint32_t unused;
  double pivot[3];
  double row[3][4];    /* as in qn_quadric_shadow */
  double s[3], l, k;
  double cap[2][4];    /* low and high cap as in qn_plane_shadow: n . (x - pivot) + d <= 0 */
  double reach;        /* at least sqrt(X0^2 + X1^2 + X2^2) anywhere in the leaf; infinite when it is unbounded */
} qn_piece_round;

typedef struct qn_piece_meet {
  qn_piece_head head;
  uint32_t unused[14];
} qn_piece_meet;

_Static_assert(sizeof(qn_piece_sphere) == 64 && sizeof(qn_piece_box) == 128 && sizeof(qn_piece_meet) == 64, "whole cache lines");
_Static_assert(sizeof(qn_piece_round) == 256, "whole cache lines");

struct quoin_scene;
struct quoin_model;
struct qn_leaf;
/* The kind of a leaf's piece, from its half-spaces and shadows. */
qn_piece_kind qn_piece_kind_of(const struct quoin_scene *scene, const struct qn_leaf *leaf);
/* Fills scene->lines and scene->line_of (by leaf), in the order of the normal form's leaves. kinds: by leaf. */
QN_NODISCARD quoin_status qn_pieces_build(struct quoin_scene *scene, const struct quoin_model *model, qn_mem *mem, const uint8_t *kinds, unsigned threads);

#endif
