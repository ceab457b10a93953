/* One point against one piece: surely in, surely out, or not sure. Static code of the points' body.

   Legend: y = x - pivot as rounded, W_i = |y_i| + weight; X_i = row_i . (y, 1), Omega_i = sum |row_ij| W_j + |row_i3|. The bounds of planes and
   quadrics are those of query/shadow.c (docs/bounds.md, QN_POINT_MAP_E, QN_POINT_FORM_E), those of balls and boxes are
   QN_POINT_BALL_E and QN_POINT_BOX_SLACK. No fused operation stands here: what is sure is so on every machine alike. */
#ifndef QN_WIDE_INSIDE_H
#define QN_WIDE_INSIDE_H

#include "base/bounds.h"
#include "scene/piece.h"
#include "scene/scene.h"
#include "wide/points.h"

#include <emmintrin.h>
#include <math.h>

/* Of a value of q and its bound, which is not negative: in where q < 0. Which way it goes is anybody's guess: no branch hangs on it. */
QN_INLINE unsigned verdict_of(double value, double bound) {
  return (unsigned)(QN_NOT_SURE + (value < -bound) - (value > bound));
}

QN_INLINE unsigned in_sphere(const qn_piece_sphere *s, qn_wide_point p) {
  double y0 = p.x[0] - s->centre[0], y1 = p.x[1] - s->centre[1], y2 = p.x[2] - s->centre[2];
  double off = s->off + QN_U * p.weight, square = (y0 * y0 + y1 * y1) + y2 * y2;
  double bound = QN_POINT_BALL_E * (square + s->r2) + off * (3 * ((fabs(y0) + fabs(y1)) + fabs(y2)) + 4 * off) + QN_POINT_TINY;
  return verdict_of(square - s->r2, bound);
}

QN_INLINE unsigned in_box(const qn_piece_box *b, qn_wide_point p) {
  const __m128d xy = _mm_loadu_pd(p.x), z = _mm_load_sd(p.x + 2);
  const __m128d across = _mm_min_pd(_mm_sub_pd(xy, _mm_loadu_pd(b->lo)), _mm_sub_pd(_mm_loadu_pd(b->hi), xy));
  const __m128d up = _mm_min_sd(_mm_sub_sd(z, _mm_load_sd(b->lo + 2)), _mm_sub_sd(_mm_load_sd(b->hi + 2), z));
  const double depth = _mm_cvtsd_f64(_mm_min_sd(_mm_min_sd(across, _mm_unpackhi_pd(across, across)), up)); /* beneath the nearest face */
  return verdict_of(-depth, QN_POINT_BOX_SLACK * (b->off + QN_U * p.weight) + QN_POINT_TINY);
}

typedef struct framed { double y[3], w[3]; } framed; /* y and W */

QN_INLINE framed frame_of(const double pivot[3], qn_wide_point p) {
  framed f;
  for (int i = 0; i < 3; i++) {
    f.y[i] = p.x[i] - pivot[i];
    f.w[i] = fabs(f.y[i]) + p.weight;
  }
  return f;
}

QN_INLINE double row_value(const double row[4], const framed *f, double *omega) {
  *omega = ((fabs(row[0]) * f->w[0] + fabs(row[1]) * f->w[1]) + fabs(row[2]) * f->w[2]) + fabs(row[3]);
  return ((row[0] * f->y[0] + row[1] * f->y[1]) + row[2] * f->y[2]) + row[3];
}

QN_INLINE unsigned in_plane(const double row[4], const framed *f) {
  double omega, value = row_value(row, f, &omega);
  return omega <= QN_POINT_LARGEST ? verdict_of(value, QN_POINT_MAP_E * omega + QN_POINT_TINY) : QN_NOT_SURE;
}

QN_INLINE unsigned in_quadric(const double row[3][4], const double s[3], double l, double k, const framed *f) {
  double q = 0, size = fabs(k), most = fabs(l), omega = 0, x = 0;
  for (int i = 0; i < 3; i++) {
    if (s[i] == 0 && (i != 2 || l == 0)) {
      continue;
    }
    x = row_value(row[i], f, &omega);
    most = omega > most ? omega : most;
    most = fabs(s[i]) > most ? fabs(s[i]) : most;
    q += s[i] * (x * x);
    size += fabs(s[i]) * (omega * (fabs(x) + QN_POINT_MAP_E * omega));
  }
  if (l != 0) { /* x is X_2 */
    q += 2 * (l * x);
    size += fabs(l) * omega;
  }
  return most <= QN_POINT_LARGEST ? verdict_of(q + k, QN_POINT_FORM_E * size + QN_POINT_TINY) : QN_NOT_SURE;
}

static unsigned in_round(const qn_piece_round *r, qn_wide_point p) {
  framed f = frame_of(r->pivot, p);
  unsigned all = in_quadric(r->row, r->s, r->l, r->k, &f);
  for (int i = 0; i < 2 && all != QN_SURELY_OUT; i++) {
    if (r->surface[1 + i] != UINT32_MAX) {
      unsigned one = in_plane(r->cap[i], &f);
      all = one < all ? one : all;
    }
  }
  return all;
}

/* Any meet of planes and quadrics, from the scene's shadows. */
static unsigned in_meet(const struct quoin_scene *scene, uint32_t number, qn_wide_point p) {
  const qn_leaf *leaf = &scene->leaves[number];
  framed f = frame_of(leaf->pivot, p);
  unsigned all = QN_SURELY_IN;
  for (uint32_t i = leaf->half0; i < leaf->half0 + leaf->halves && all != QN_SURELY_OUT; i++) {
    const qn_half *half = &scene->halves[i];
    unsigned one = QN_NOT_SURE;
    switch ((qn_half_kind)half->kind) {
    case QN_PLANE: {
      const qn_plane_shadow *s = &scene->planes[half->shadow];
      const double row[4] = {s->n[0], s->n[1], s->n[2], s->d};
      one = in_plane(row, &f);
      break;
    }
    case QN_QUADRIC_BODY: {
      const qn_quadric_shadow *s = &scene->quadrics[half->shadow];
      one = in_quadric(s->row, s->s, s->l, s->k, &f);
      break;
    }
    case QN_SUPER_BODY: break;
    }
    all = one < all ? one : all;
  }
  return all;
}

QN_INLINE unsigned in_piece(const struct quoin_scene *scene, const qn_piece_head *head, qn_wide_point p) {
  switch ((qn_piece_kind)head->kind) { /* NOLINT(clang-analyzer-core.NullDereference): every piece is there */
  case QN_PIECE_SPHERE: return in_sphere((const qn_piece_sphere *)(const void *)head, p);
  case QN_PIECE_BOX: return in_box((const qn_piece_box *)(const void *)head, p);
  case QN_PIECE_ROUND: return in_round((const qn_piece_round *)(const void *)head, p);
  case QN_PIECE_MEET: case QN_PIECE_HARD: break;
  }
  return in_meet(scene, head->leaf, p);
}

#endif
