#include "scene/piece.h"

#include "base/bounds.h"
#include "base/thread.h"
#include "scene/scene.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* The largest |row . (x - pivot, 1)| over the leaf's box. */
static double row_reach(const qn_leaf *l, const double row[4]) {
  double most = fabs(row[3]);
  for (int j = 0; j < 3; j++) {
    most += fabs(row[j]) * fmax(fabs(l->min[j] - l->pivot[j]), fabs(l->max[j] - l->pivot[j]));
  }
  return most * QN_WIDE_SLACK;
}

static int is_sphere(const quoin_scene *scene, const qn_leaf *l) {
  const qn_half *h = &scene->halves[l->half0];
  if (l->halves != 1 || h->kind != QN_QUADRIC_BODY) {
    return 0;
  }
  const qn_quadric_shadow *q = &scene->quadrics[h->shadow];
  int same = q->l == 0 && q->s[0] > 0 && q->s[0] == q->s[1] && q->s[1] == q->s[2] && q->k < 0;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      same = same && (i == j ? q->row[i][j] == q->row[0][0] && q->row[0][0] != 0 : q->row[i][j] == 0);
    }
  }
  return same;
}

/* The axis of a plane shadow that is perpendicular to one, else -1. */
static int axis_of(const qn_plane_shadow *p) {
  int axis = -1;
  for (int i = 0; i < 3; i++) {
    if (p->n[i] != 0) {
      if (axis >= 0) {
        return -1;
      }
      axis = i;
    }
  }
  return axis;
}

/* Fills `box` and returns 1 when the leaf is six planes, two across each axis. */
static int is_box(const quoin_scene *scene, const qn_leaf *l, qn_piece_box *box) {
  unsigned seen = 0;
  *box = (qn_piece_box){.head = {.kind = QN_PIECE_BOX}};
  for (uint32_t i = l->half0; l->halves == 6 && i < l->half0 + 6; i++) {
    const qn_half *h = &scene->halves[i];
    const qn_plane_shadow *p = &scene->planes[h->shadow];
    int axis = h->kind == QN_PLANE ? axis_of(p) : -1;
    if (axis < 0) {
      return 0;
    }
    int high = p->n[axis] > 0;
    double from_pivot = -p->d / p->n[axis], place = l->pivot[axis] + from_pivot;
    box->off = fmax(box->off, 8 * QN_U * (fabs(l->pivot[axis]) + fabs(from_pivot)));
    (high ? box->hi : box->lo)[axis] = place;
    box->surface[2 * axis + high] = h->surface;
    seen |= 1u << (2 * axis + high);
  }
  return seen == 63;
}

static double length_of(const double row[4]) { return sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]); }

/* Rows of a shadow may be of very different lengths (a slanted cylinder's: 2500 and 46), and wide code's bounds take all for as long as the longest. So rows are multiplied by powers of two, s and
   l by their inverses, which is exact: all |s_i| lie in [1/2, 2) then. A row without a part in the form (along a cylinder) gets between a quarter and a half of the shortest other one's length: short, so that
   the place nearest to the pivot is nearly the one nearest to the axis; not so short that a ray along it were QN_WIDE_SLOW. */
static void even_rows(qn_piece_round *round) {
  double row[3][4], s[3], l = round->l, shortest = INFINITY;
  int fine = 1;
  for (int i = 0; i < 3; i++) {
    int e;
    (void)frexp(fabs(round->s[i]), &e);
    const int k = e >= 0 ? e / 2 : -((1 - e) / 2), plays = round->s[i] != 0;
    for (int j = 0; j < 4; j++) {
      row[i][j] = ldexp(round->row[i][j], plays ? k : 0);
    }
    s[i] = ldexp(round->s[i], plays ? -2 * k : 0);
    l = ldexp(l, i == 2 && plays ? -k : 0);
    shortest = plays ? fmin(shortest, length_of(row[i])) : shortest;
  }
  for (int i = 0; i < 3; i++) {
    const double length = length_of(row[i]);
    if (s[i] == 0 && (i != 2 || l == 0) && length > 0 && isfinite(shortest)) {
      int e;
      (void)frexp(0.5 * shortest / length, &e);
      for (int j = 0; j < 4; j++) {
        row[i][j] = ldexp(row[i][j], e - 1);
      }
    }
    for (int j = 0; j < 4; j++) {
      fine &= row[i][j] == 0 || (fabs(row[i][j]) <= QN_WIDE_LARGEST && fabs(row[i][j]) >= 1 / QN_WIDE_LARGEST);
    }
  }
  fine &= l == 0 || (fabs(l) <= QN_WIDE_LARGEST && fabs(l) >= 1 / QN_WIDE_LARGEST);
  if (fine) {
    memcpy(round->row, row, sizeof row), memcpy(round->s, s, sizeof s);
    round->l = l;
  }
}

/* At least |X| anywhere in the leaf: by its box, and by the body, sum s_i X_i^2 <= -k, where that closes. */
static double reach_of(const qn_leaf *leaf, const qn_piece_round *round) {
  double idle = 0, plays = 0, least = INFINITY;
  int closes = round->l == 0 && round->k < 0;
  for (int i = 0; i < 3; i++) {
    const double most = row_reach(leaf, round->row[i]);
    *(round->s[i] == 0 ? &idle : &plays) += most * most;
    closes &= round->s[i] >= 0;
    least = round->s[i] > 0 ? fmin(least, round->s[i]) : least;
  }
  plays = closes ? fmin(plays, -round->k / least * QN_WIDE_SLACK) : plays;
  return sqrt(idle + plays) * QN_WIDE_SLACK;
}

/* A quadric body and at most two caps that face apart. */
static int is_round(const quoin_scene *scene, const qn_leaf *l, qn_piece_round *round) {
  if (l->halves < 1 || l->halves > 3) {
    return 0;
  }
  *round = (qn_piece_round){.head = {.kind = QN_PIECE_ROUND}, .surface = {UINT32_MAX, UINT32_MAX, UINT32_MAX}};
  memcpy(round->pivot, l->pivot, sizeof round->pivot);
  int caps = 0;
  for (uint32_t i = l->half0; i < l->half0 + l->halves; i++) {
    const qn_half *h = &scene->halves[i];
    if (h->kind == QN_QUADRIC_BODY && round->surface[0] == UINT32_MAX) {
      const qn_quadric_shadow *q = &scene->quadrics[h->shadow];
      memcpy(round->row, q->row, sizeof round->row);
      memcpy(round->s, q->s, sizeof round->s);
      round->l = q->l, round->k = q->k;
      round->surface[0] = h->surface;
      even_rows(round);
      round->reach = reach_of(l, round);
    } else if (h->kind == QN_PLANE && caps < 2) {
      const qn_plane_shadow *p = &scene->planes[h->shadow];
      memcpy(round->cap[caps], p->n, sizeof p->n);
      round->cap[caps][3] = p->d;
      round->surface[1 + caps++] = h->surface;
    } else {
      return 0;
    }
  }
  return round->surface[0] != UINT32_MAX && isfinite(round->reach);
}

/* Every number of the leaf well within the range of doubles, and nothing that wide code does not know. */
static int is_plain(const quoin_scene *scene, const qn_leaf *l) {
  double small = INFINITY, large = 0;
  int planes = 0, bodies = 0;
  const double *numbers;
  for (uint32_t i = l->half0; i < l->half0 + l->halves; i++) {
    const qn_half *h = &scene->halves[i];
    size_t count;
    planes += h->kind == QN_PLANE, bodies += h->kind != QN_PLANE;
    if (h->kind == QN_SUPER_BODY || planes > QN_MEET_PLANES || bodies > QN_MEET_BODIES) {
      return 0;
    }
    if (h->kind == QN_PLANE) {
      numbers = scene->planes[h->shadow].n, count = 4;
    } else {
      numbers = scene->quadrics[h->shadow].row[0], count = offsetof(qn_quadric_shadow, k_rest) / sizeof(double);
    }
    for (size_t k = 0; k < count; k++) {
      double v = fabs(numbers[k]);
      large = v > large ? v : large;
      small = v > 0 && v < small ? v : small;
    }
  }
  for (int j = 0; j < 3; j++) {
    large = fmax(large, fabs(l->pivot[j]));
  }
  return large <= QN_WIDE_LARGEST && small >= 1 / QN_WIDE_LARGEST;
}

qn_piece_kind qn_piece_kind_of(const quoin_scene *scene, const qn_leaf *l) {
  qn_piece_box box;
  qn_piece_round round;
  if (!is_plain(scene, l)) {
    return QN_PIECE_HARD;
  }
  return is_sphere(scene, l)          ? QN_PIECE_SPHERE
         : is_box(scene, l, &box)     ? QN_PIECE_BOX
         : is_round(scene, l, &round) ? QN_PIECE_ROUND
                                      : QN_PIECE_MEET;
}

static size_t lines_of(qn_piece_kind kind) {
  switch (kind) {
  case QN_PIECE_SPHERE: case QN_PIECE_MEET: case QN_PIECE_HARD: return 1;
  case QN_PIECE_BOX: return 2;
  case QN_PIECE_ROUND: return 4;
  }
  return 1;
}

static void write_sphere(const qn_leaf *l, int placed, const qn_quadric_shadow *q, uint32_t leaf, uint32_t surface, void *line) {
  const double scale = q->row[0][0];
  qn_piece_sphere s = {.head = {QN_PIECE_SPHERE, 0, leaf}, .r2 = -q->k / (q->s[0] * scale * scale), .r2_rest = (float)-q->k_rest, .surface = surface};
  double off = 0, far = 0;
  int fine = s.r2 == -q->k && isfinite(q->k_rest) && (q->k_rest == 0 || fabs(q->k_rest) > QN_BALL_LEAST);
  memcpy(s.centre, l->pivot, sizeof s.centre);
  for (int i = 0; i < 3; i++) {
    const double rest = -q->row[i][3] / scale, size = fabs(rest);
    off = size > off ? size : off, far = fabs(s.centre[i]) > far ? fabs(s.centre[i]) : far;
    s.rest[i] = (float)rest;
    fine = fine && (rest == 0 || size > QN_BALL_LEAST);
  }
  s.off = qn_round_up(off * QN_WIDE_SLACK);
  if (isfinite(q->k_rest) && l->prim == QN_SPHERE && !placed) {
    s.head.flags = (uint16_t)(QN_BALL_SHIFTED | (l->negated ? QN_BALL_NEGATED : 0));
  }
  if (!fine || far > QN_BALL_FAR * sqrt(s.r2)) {
    s.r2_rest = INFINITY;
  }
  memcpy(line, &s, sizeof s);
}

static void write_piece(const quoin_scene *scene, const quoin_model *model, uint32_t leaf, qn_piece_kind kind, void *line) {
  const qn_leaf *l = &scene->leaves[leaf];
  switch (kind) {
  case QN_PIECE_SPHERE: {
    const qn_half *h = &scene->halves[l->half0];
    const qn_quadric_shadow *q = &scene->quadrics[h->shadow];
    write_sphere(l, (model->nodes[l->node].flags & QN_NODE_PLACED) != 0, q, leaf, h->surface, line);
    return;
  }
  case QN_PIECE_BOX: {
    qn_piece_box box;
    if (is_box(scene, l, &box)) {
      box.head.leaf = leaf;
      memcpy(line, &box, sizeof box);
    }
    return;
  }
  case QN_PIECE_ROUND: {
    qn_piece_round round;
    if (is_round(scene, l, &round)) {
      round.head.leaf = leaf;
      memcpy(line, &round, sizeof round);
    }
    return;
  }
  case QN_PIECE_MEET: case QN_PIECE_HARD: {
    qn_piece_meet meet = {.head = {(uint16_t)kind, 0, leaf}};
    memcpy(line, &meet, sizeof meet);
    return;
  }
  }
}

enum { STRETCH = 4096 }; /* leaves a thread takes at once */
#define NOT_MET UINT32_MAX

typedef struct filling { quoin_scene *scene; const quoin_model *model; const uint8_t *kinds; } filling;

static quoin_status fill(void *user, unsigned thread, size_t i) {
  (void)thread;
  const filling *f = user;
  quoin_scene *s = f->scene;
  size_t end = (i + 1) * STRETCH < s->leaf_count ? (i + 1) * STRETCH : s->leaf_count;
  for (size_t leaf = i * STRETCH; leaf < end; leaf++) { /* in the order in which leaves lie in memory: they are the larger part */
    if (s->line_of[leaf] != NOT_MET) {
      write_piece(s, f->model, (uint32_t)leaf, (qn_piece_kind)f->kinds[leaf], (char *)s->lines + (size_t)s->line_of[leaf] * 64);
    }
  }
  return QUOIN_OK;
}

static quoin_status find_plain(void *user, unsigned thread, size_t i) {
  (void)thread;
  quoin_scene *s = user;
  const qn_normal *n = &s->normal;
  size_t end = (i + 1) * STRETCH < s->plain_count ? (i + 1) * STRETCH : s->plain_count;
  for (size_t k = i * STRETCH; k < end; k++) {
    const qn_nterm *t = &n->terms[k];
    s->plain[k] = t->leaves == 1 && !t->minus && !t->plus ? s->line_of[n->leaves[t->leaf0]] : UINT32_MAX;
  }
  return QUOIN_OK;
}

/* A run goes on while lines are as far apart as its first two. */
static qn_plain_run longest_run(const uint32_t *plain, size_t n) {
  qn_plain_run best = {0};
  for (size_t i = 0; i < n;) {
    qn_plain_run run = {.first = (uint32_t)i, .count = plain[i] != UINT32_MAX, .line = plain[i]};
    i++;
    if (run.count && i < n && plain[i] != UINT32_MAX && plain[i] > run.line) {
      run.step = plain[i] - run.line;
      for (; i < n && plain[i] != UINT32_MAX && plain[i] - plain[i - 1] == run.step; i++) {
        run.count++;
      }
    }
    best = run.count > best.count ? run : best;
  }
  return best;
}

quoin_status qn_pieces_build(quoin_scene *scene, const quoin_model *model, qn_mem *mem, const uint8_t *kinds, unsigned threads) {
  const qn_normal *n = &scene->normal;
  scene->line_of = qn_alloc_line(mem, scene->leaf_count * sizeof *scene->line_of);
  if (!scene->line_of) {
    return QUOIN_E_MEMORY;
  }
  memset(scene->line_of, 0xff, scene->leaf_count * sizeof *scene->line_of);
  size_t lines = 0;
  for (size_t i = 0; i < n->leaf_count; i++) {
    uint32_t leaf = n->leaves[i];
    if (scene->line_of[leaf] == NOT_MET) {
      scene->line_of[leaf] = (uint32_t)lines;
      lines += lines_of((qn_piece_kind)kinds[leaf]);
    }
  }
  for (size_t i = 0; i < scene->leaf_count; i++) { /* leaves that the normal form has no use for, but the program names (query/spans.c) */
    if (scene->line_of[i] == NOT_MET && scene->leaves[i].gate != QN_NO_GATE) {
      scene->line_of[i] = (uint32_t)lines;
      lines += lines_of((qn_piece_kind)kinds[i]);
    }
  }
  if (lines >= NOT_MET) {
    return QUOIN_E_LIMIT;
  }
  scene->line_count = lines;
  scene->lines = qn_alloc_line(mem, lines * 64);
  if (!scene->lines) {
    return QUOIN_E_MEMORY;
  }
  scene->plain = qn_alloc_line(mem, n->term_count * sizeof *scene->plain);
  if (!scene->plain) {
    return QUOIN_E_MEMORY;
  }
  scene->plain_count = n->term_count;
  filling f = {scene, model, kinds};
  quoin_status status = qn_parallel(threads, (scene->leaf_count + STRETCH - 1) / STRETCH, fill, &f, NULL);
  status = status == QUOIN_OK ? qn_parallel(threads, (n->term_count + STRETCH - 1) / STRETCH, find_plain, scene, NULL) : status;
  if (status == QUOIN_OK) {
    scene->run = longest_run(scene->plain, n->term_count);
  }
  return status;
}
