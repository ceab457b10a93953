/* What doubles know of surfaces: where they are used, their place and direction with a bound of its error, how wide a search they ask for, and
   their order. */
#include "scene/near_parts.h"

#include "scene/compile.h"
#include "scene/fingerprint.h"

#include <string.h>

/* --- what doubles know of a surface ---------------------------------------------------------------------------------- */

static void look_at_plane(const qn_near_finder *f, const qn_leaf *leaf, const qn_plane_shadow *p, qn_near_item *it) {
  double length = sqrt(p->n[0] * p->n[0] + p->n[1] * p->n[1] + p->n[2] * p->n[2]), d = p->d, size = fabs(p->d);
  for (int k = 0; k < 3; k++) {
    double term = p->n[k] * (leaf->pivot[k] - f->origin[k]);
    d -= term;
    size += fabs(term);
    it->n[k] = p->n[k] / length;
  }
  it->d = d / length;
  it->error = QN_NEAR_PLACE * size / length;
  it->kind = isfinite(it->error) && length > 0x1p-400 && length < 0x1p400 ? QN_NEAR_PLANE : QN_NEAR_NOT;
}

/* Columns of the inverse of the rows' 3x3 part; 0 where rows are too nearly dependent for doubles. */
static int invert(double row[3][4], double inverse[3][3]) {
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < 3; i++) {
      int a = (i + 1) % 3, b = (i + 2) % 3, c = (k + 1) % 3, d = (k + 2) % 3;
      inverse[k][i] = row[a][c] * row[b][d] - row[a][d] * row[b][c];
    }
  }
  double det = 0;
  for (int k = 0; k < 3; k++) {
    det += row[0][k] * inverse[k][0];
  }
  for (int i = 0; i < 9; i++) {
    inverse[i / 3][i % 3] /= det;
  }
  return fabs(det) > QN_NEAR_FLAT; /* of unit rows */
}

/* The radius of a curved surface (near.c), with X2 at its centre, l and s2 of unit rows, A = |quadratic part|, w its axis when it is a cylinder, off_axis
   the error of that. */
static void look_at_radius(const qn_near_finder *f, const qn_quadric_shadow *q, double s2, double l, double X2, double A, double magnitude, const double *w,
                           double off_axis, qn_near_item *it) {
  double e = s2 != 0 || l == 0 ? q->k + l * X2 : 0, off = s2 != 0 || l == 0 ? QN_NEAR_NORMAL * (fabs(q->k) + fabs(l * X2)) : 0;
  double least = 0, far2 = 0;
  it->radius = sqrt(fabs(e)) / sqrt(A);
  /* |sqrt a - sqrt b| is at most sqrt |a - b|, and |a - b| / sqrt a */
  it->error += QN_NEAR_PLACE * it->radius * (magnitude / A) + (off > 0 ? fmin(sqrt(off / A), off / (it->radius * A)) : 0);
  it->reach = f->most;
  for (int which = 0; which < 8; which++) { /* the region's corner farthest from the centre, across the axis */
    double y[3], square = 0, size2 = 0, along = 0, w2 = 0;
    for (int k = 0; k < 3; k++) {
      y[k] = (which >> k & 1 ? it->region.max[k] : it->region.min[k]) - f->origin[k] - it->n[k];
      size2 += y[k] * y[k];
      along += w ? y[k] * w[k] : 0;
      w2 += w ? w[k] * w[k] : 0;
    }
    for (int k = 0; k < 3; k++) {
      double across = y[k] - (w ? along / w2 * w[k] : 0);
      square += across * across;
    }
    least = fmax(least, sqrt(square));
    far2 = fmax(far2, size2);
  }
  least -= it->error + off_axis * sqrt(far2);
  if (isfinite(far2) && !(least >= it->radius)) { /* the region does not come to the surface, or hardly */
    it->reach = least > 0 ? f->most * (it->radius / least) : INFINITY;
  }
  if (!isfinite(it->reach)) {
    it->reach = INFINITY; /* unlike what is not a number */
  }
}

static void look_at_body(const qn_near_finder *f, const qn_leaf *leaf, const qn_quadric_shadow *q, qn_near_item *it) {
  static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  static const double weight[6] = {0.7548776662466927, 0.5698402909980532, 0.8191725133961644, 0.6710436067037893, 0.5497004779019703, 0.9318321442141524};
  double row[3][4], s[3], inverse[3][3], X[3] = {0, 0, 0}, l = q->l;
  it->kind = QN_NEAR_NOT;
  const int axis = q->s[2] == 0 && l == 0; /* a cylinder: its third row says nothing of it, and is 0 where it was written as a quadric */
  for (int i = 0; i < 3 - axis; i++) {
    const double *r = q->row[i];
    double length = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    if (!(length > 0x1p-200 && length < 0x1p200)) {
      return;
    }
    for (int j = 0; j < 4; j++) {
      row[i][j] = r[j] / length;
    }
    s[i] = q->s[i] * length * length;
    l = i == 2 ? q->l * length : l;
  }
  if (axis) { /* any row across the others will do: of the axis only the line counts */
    double length = 0;
    for (int k = 0; k < 3; k++) {
      int a = (k + 1) % 3, b = (k + 2) % 3;
      row[2][k] = row[0][a] * row[1][b] - row[0][b] * row[1][a];
      length += row[2][k] * row[2][k];
    }
    for (int k = 0; k < 3; k++) {
      row[2][k] /= sqrt(length); /* 0: there is no inverse */
    }
    row[2][3] = s[2] = 0;
  }
  if (!invert(row, inverse) || s[0] == 0 || s[1] == 0) {
    return;
  }
  X[2] = s[2] != 0 ? -l / s[2] : l != 0 ? -q->k / (2 * l) : 0;
  double size = 0, along = 0, w2 = 0;
  for (int k = 0; k < 3; k++) {
    double at = leaf->pivot[k] - f->origin[k];
    size += fabs(at);
    for (int i = 0; i < 3; i++) {
      double term = inverse[k][i] * (X[i] - row[i][3]);
      at += term;
      size += fabs(inverse[k][i]) * (fabs(X[i]) + fabs(row[i][3]));
    }
    it->n[k] = at;
    along += at * inverse[k][2];
    w2 += inverse[k][2] * inverse[k][2];
  }
  if (axis) { /* of it, the place nearest to O */
    for (int k = 0; k < 3; k++) {
      it->n[k] -= along / w2 * inverse[k][2];
    }
  }
  double most = 0;
  for (int i = 0; i < 9; i++) {
    most = fmax(most, fabs(inverse[i / 3][i % 3]));
  }
  const double off = 4 * QN_NEAR_PLACE * (most < 2 ? 1 : 1 / QN_NEAR_FLAT); /* below 2: rows nearly orthogonal, the usual thing */
  it->error = off * size;
  double A2 = 0, wA = 0, magnitude = 0;
  for (int c = 0; c < 6; c++) {
    double a = 0;
    for (int i = 0; i < 3; i++) {
      double term = s[i] * row[i][pair[c][0]] * row[i][pair[c][1]] * (c < 3 ? 1 : 2);
      a += term;
      magnitude += fabs(term);
    }
    A2 += a * a;
    wA += weight[c] * a;
  }
  it->d = wA * wA / A2;
  const double w[3] = {inverse[0][2], inverse[1][2], inverse[2][2]};
  look_at_radius(f, q, s[2], l, X[2], sqrt(A2), magnitude, axis ? w : NULL, 2 * off, it);
  if (isfinite(it->error) && isfinite(it->d) && isfinite(it->radius) && QN_NEAR_FLAT * magnitude < sqrt(A2)) {
    it->kind = QN_NEAR_CURVED;
  }
}

/* To 20 bits: boxes are rounded, and parts of one size should count as that. */
static double rounded_size(double size) {
  if (!isfinite(size)) {
    return size;
  }
  uint64_t bits;
  memcpy(&bits, &size, sizeof bits);
  bits += 0xffffffffu + (bits >> 33 & 1); /* to nearest, ties to even, of the 33 bits that go */
  bits &= ~(uint64_t)0x1ffffffff;
  memcpy(&size, &bits, sizeof size);
  return size;
}

static void look_at(const qn_near_finder *f, uint32_t i, qn_near_item *it) {
  const quoin_scene *s = f->scene;
  const qn_surface *surface = &s->surfaces[i];
  const qn_leaf *leaf = &s->leaves[surface->leaf];
  const qn_half *half = &s->halves[surface->half];
  if (surface->kind == QN_PLANE) {
    look_at_plane(f, leaf, &s->planes[half->shadow], it);
  } else if (surface->kind == QN_QUADRIC_BODY) {
    look_at_body(f, leaf, &s->quadrics[half->shadow], it);
  }
  it->size = 0;
  for (int k = 0; k < 3; k++) {
    it->size += it->region.max[k] - it->region.min[k];
  }
  it->size = it->size >= 0 ? rounded_size(it->size) : INFINITY;
}

/* The greatest angle (as a distance of unit normals) at which another plane can be near this one. */
double qn_near_angle(const qn_near_finder *f, const qn_near_item *it) {
  double least = INFINITY;
  for (int k = 0; k < 3; k++) {
    least = fmin(least, qn_near_half_extent(&it->region, k));
  }
  double angle = 4 * QN_NEAR_NORMAL + (isfinite(least) && isfinite(it->size) ? 2 * (f->most + it->error) / least : 0), widest = ldexp(1, -QN_NEAR_ANGLE / 2 + 1);
  return angle < widest ? angle : widest; /* also when it is not a number */
}
double qn_near_direction_cell(int level) {
  return ldexp(1, 2 - QN_NEAR_ANGLE / 2 - 3 * level); /* twice the widest angle, then finer */
}
static uint8_t level_of(const qn_near_finder *f, const qn_near_item *it) {
  double angle = qn_near_angle(f, it);
  int level = 0;
  while (level + 1 < QN_NEAR_LEVELS && qn_near_direction_cell(level + 1) >= 2 * (angle + 2 * QN_NEAR_GROUP_CELL)) {
    level++;
  }
  return (uint8_t)level;
}

int qn_near_order(const qn_near_finder *f, uint32_t x, uint32_t y) {
  const qn_near_item *items = f->items;
  return items[x].size != items[y].size ? (items[x].size < items[y].size) - (items[x].size > items[y].size) : (x > y) - (x < y);
}

/* f->order by qn_near_order: a merge sort, stable, of sizes kept beside the numbers (a million items are in no cache). */
static int sort_order(qn_near_finder *f, size_t n) {
  typedef struct key { double size; uint32_t item; } key;
  key *keys = qn_alloc(f->mem, 2 * n * sizeof *keys), *from = keys, *to = keys ? keys + n : NULL;
  if (!keys) {
    return 0;
  }
  for (uint32_t i = 0; i < n; i++) {
    keys[i] = (key){f->items[i].size, i};
  }
  for (size_t width = 1; width < n; width *= 2) {
    for (size_t i = 0; i < n; i += 2 * width) {
      size_t a = i, a_end = i + width < n ? i + width : n, b = a_end, b_end = i + 2 * width < n ? i + 2 * width : n;
      for (size_t k = i; k < b_end; k++) {
        to[k] = a < a_end && (b == b_end || from[a].size >= from[b].size) ? from[a++] : from[b++];
      }
    }
    key *swap = from;
    from = to;
    to = swap;
  }
  for (size_t i = 0; i < n; i++) {
    f->order[i] = from[i].item;
  }
  qn_free(f->mem, keys, 2 * n * sizeof *keys);
  return 1;
}

double qn_near_centre_cell(const qn_near_finder *f, int level) {
  return ldexp(f->centre_cell, 4 * level);
}
static void gather_regions(qn_near_finder *f) {
  const quoin_scene *s = f->scene;
  for (size_t i = 0; i < s->surface_count; i++) {
    f->items[i].region = (qn_region){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
  }
  for (size_t i = 0; i < s->leaf_count; i++) {
    const qn_leaf *leaf = &s->leaves[i];
    for (uint32_t h = leaf->half0; h < leaf->half0 + leaf->halves; h++) {
      qn_region *r = &f->items[s->halves[h].surface].region;
      for (int k = 0; k < 3; k++) {
        r->min[k] = leaf->min[k] < r->min[k] ? leaf->min[k] : r->min[k];
        r->max[k] = leaf->max[k] > r->max[k] ? leaf->max[k] : r->max[k];
      }
    }
  }
}

static int gather_users(qn_near_finder *f) {
  const quoin_scene *s = f->scene;
  f->users = qn_alloc(f->mem, s->half_count * sizeof *f->users);
  f->users_of = qn_alloc_zeroed(f->mem, (s->surface_count + 1) * sizeof *f->users_of);
  if (!f->users || !f->users_of) {
    return 0;
  }
  for (uint32_t i = 0, n = 0; i < s->surface_count; i++) { /* first where they begin, and then, each moved on by its users, where they end */
    f->users_of[i] = n;
    n += s->surfaces[i].users;
  }
  for (uint32_t i = 0; i < s->leaf_count; i++) {
    for (uint32_t h = s->leaves[i].half0; h < s->leaves[i].half0 + s->leaves[i].halves; h++) {
      f->users[f->users_of[s->halves[h].surface]++] = i;
    }
  }
  memmove(f->users_of + 1, f->users_of, s->surface_count * sizeof *f->users_of);
  f->users_of[0] = 0;
  return 1;
}

quoin_status qn_near_items_make(qn_near_finder *f) {
  size_t n = f->scene->surface_count;
  qn_print_frame frame;
  qn_print_frame_of(f->scene, &frame);
  memcpy(f->origin, frame.origin, sizeof f->origin);
  double unit = f->unit = ldexp(1, frame.scale);
  f->most = nextafter(qn_num_to_double(f->limit), INFINITY);
  f->offset_cell = 2 * f->most + 0x1p-36 * unit;
  f->centre_cell = 4 * f->most + 0x1p-34 * unit;
  f->items = qn_alloc_zeroed(f->mem, n * sizeof *f->items);
  f->order = qn_alloc(f->mem, n * sizeof *f->order);
  f->next_in_group = qn_alloc(f->mem, n * sizeof *f->next_in_group);
  if (!f->items || !f->order || !f->next_in_group) {
    return QUOIN_E_MEMORY;
  }
  gather_regions(f);
  if (!gather_users(f)) {
    return QUOIN_E_MEMORY;
  }
  for (uint32_t i = 0; i < n; i++) {
    qn_near_item *it = &f->items[i];
    look_at(f, i, it);
    if (it->kind == QN_NEAR_PLANE) {
      it->level = level_of(f, it);
      f->levels |= 1u << it->level | 1u << (QN_NEAR_LEVELS - 1);
      f->plane_error = fmax(f->plane_error, it->error);
    } else if (it->kind == QN_NEAR_CURVED) {
      while (it->level + 1 < QN_NEAR_CENTRE_LEVELS && it->error > qn_near_centre_cell(f, it->level) / 16) {
        it->level++;
      }
      if (it->error > qn_near_centre_cell(f, it->level) / 16) {
        it->kind = QN_NEAR_NOT;
        continue;
      }
      f->centre_levels |= 1u << it->level;
    }
  }
  return sort_order(f, n) ? QUOIN_OK : QUOIN_E_MEMORY;
}
