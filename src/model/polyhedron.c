/* polyhedron(points, faces), convex ones, exactly.

   Legend: a face is a loop of points, clockwise seen from outside (OpenSCAD's rule). N = sum p_i x p_(i+1) over the loop is twice
   its vector area (Newell), which points inwards; the outward normal is -N. Its plane is n.x <= d with d = n.p_0, divided by the
   size of the first component of n that is not zero, so that equal planes have equal numbers.

   The solid is the meet of its faces' half-spaces exactly when
   - every point lies in every half-space (or every one beyond: then all loops are turned the wrong way), and
   - each edge is used equally often in both directions. For then the faces, all of which lie on facets of the points'
     convex hull and are turned alike, form a closed surface, which covers each part of the hull's boundary equally often, so
     every facet is covered; and the hull is the meet of its facets' half-spaces.
   What is kept: the distinct planes in the order of the faces, and the corners (points where the normals of the planes
   through it span space) in the order of the points. Each plane is then made again from its corners in the order in which they are
   printed, so that a tree that is printed and read has the same numbers even where they are rounded. */
#include "model/polyhedron.h"

#include "base/limits.h"
#include "model/words.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS, FACES, CONVEXITY, TRIANGLES };

typedef struct edge { uint32_t low, high; int turn; } edge;
typedef struct loop { uint32_t first, count; } loop; /* of corner indices */
typedef struct meeting { uint32_t *items; size_t count; } meeting; /* the points on a plane, rising; later the planes at a point, rising */

typedef struct body {
  qn_call *call;
  qn_ctx *ctx;
  const qn_num *points; /* 3 each */
  size_t point_count;
  uint32_t *same;       /* by point: the first point with its coordinates */
  uint8_t *used;        /* by point */
  loop *loops;
  size_t loop_count;
  uint32_t *corners;
  size_t corner_count;
  double (*near)[3];    /* by point: qn_polyhedron_shadow */
  qn_num *planes;       /* 4 each, distinct */
  double (*near_planes)[4];
  meeting *on;          /* by plane */
  size_t plane_count;
} body;

static void *room(body *b, size_t size) {
  void *p = qn_arena_take(&b->ctx->arena, size + 1); /* something, even for nothing */
  if (!p) {
    b->call->ev->failed = QUOIN_E_MEMORY;
  }
  return p;
}

/* --- input ---------------------------------------------------------------------------------------------------------- */

static int read_points(body *b) {
  qn_value v = b->call->value[POINTS];
  if (v.kind == QN_V_UNDEF) {
    qn_arg_tell(b->call, QN_Q0412, -1, NULL, "write polyhedron(points = [[x, y, z], ...], faces = [[i, j, k], ...])",
                "'points' is missing");
    return 0;
  }
  qn_num *points = v.kind == QN_V_VECTOR ? room(b, 3 * (size_t)v.count * sizeof *points) : NULL;
  for (size_t i = 0; points && i < v.count; i++) {
    qn_value p = v.u.items[i];
    int good = p.kind == QN_V_VECTOR && p.count == 3;
    for (size_t k = 0; good && k < 3; k++) {
      good = qn_arg_item(b->call, POINTS, p.u.items[k], &points[3 * i + k]) != 0;
    }
    if (!good) {
      qn_arg_tell(b->call, QN_Q0513, POINTS, NULL, NULL, "point %zu is not three numbers", i);
      return 0;
    }
  }
  if (!points) {
    if (!b->call->ev->failed) {
      qn_arg_tell(b->call, QN_Q0513, POINTS, NULL, NULL, "'points' is not a vector of points");
    }
    return 0;
  }
  b->points = points;
  b->point_count = v.count;
  return !b->call->not_finite;
}

static int order(qn_ctx *ctx, const qn_num *p, const qn_num *q) {
  for (size_t k = 0; k < 3; k++) {
    int c = qn_num_cmp(ctx, p[k], q[k]);
    if (c) {
      return c;
    }
  }
  return 0;
}

static int by_place(void *user, uint32_t i, uint32_t j) {
  body *b = user;
  int c = order(b->ctx, b->points + (size_t)3 * i, b->points + (size_t)3 * j);
  return c ? c : (i > j) - (i < j);
}

/* Finds points that are equal. */
static int find_same(body *b) {
  size_t n = b->point_count;
  uint32_t *sorted = room(b, n * sizeof *sorted);
  b->same = room(b, n * sizeof *b->same);
  b->used = room(b, n * sizeof *b->used);
  b->near = room(b, n * sizeof *b->near);
  if (!sorted || !b->same || !b->used || !b->near || !qn_ctx_spend(b->ctx, n, QN_EFFORT_POINT)) {
    return 0;
  }
  memset(b->used, 0, n);
  for (size_t i = 0; i < n; i++) {
    sorted[i] = (uint32_t)i;
    qn_polyhedron_shadow(3, b->points + 3 * i, b->near[i]);
  }
  qn_polyhedron_sort(sorted, n, by_place, b);
  for (size_t i = 0; i < n; i++) {
    int equal = i > 0 && order(b->ctx, b->points + (size_t)3 * sorted[i - 1], b->points + (size_t)3 * sorted[i]) == 0;
    b->same[sorted[i]] = equal ? b->same[sorted[i - 1]] : sorted[i];
  }
  return 1;
}

static int read_faces(body *b) {
  qn_call *call = b->call;
  int which = qn_arg_given(call, FACES) ? FACES : TRIANGLES;
  qn_value v = call->value[which];
  if (v.kind != QN_V_VECTOR) {
    qn_arg_tell(call, v.kind == QN_V_UNDEF ? QN_Q0412 : QN_Q0513, v.kind == QN_V_UNDEF ? -1 : which, NULL, NULL,
                v.kind == QN_V_UNDEF ? "'faces' is missing" : "'faces' is not a vector of faces");
    return 0;
  }
  size_t corners = 0;
  for (size_t f = 0; f < v.count; f++) {
    corners += v.u.items[f].kind == QN_V_VECTOR ? v.u.items[f].count : 0;
  }
  if (v.count > QN_MAX_FACES || corners > 8 * (size_t)QN_MAX_FACES) {
    qn_arg_tell(call, QN_Q0907, which, "at most 4096 of one solid, with 32768 corners", NULL, "too many faces");
    return 0;
  }
  b->loops = room(b, v.count * sizeof *b->loops);
  b->corners = room(b, corners * sizeof *b->corners);
  if (!b->loops || !b->corners) {
    return 0;
  }
  for (size_t f = 0; f < v.count; f++) {
    qn_value face = v.u.items[f];
    if (face.kind != QN_V_VECTOR || face.count < 3) {
      qn_arg_tell(call, QN_Q0513, which, NULL, NULL, "face %zu is not a vector of at least three indices", f);
      return 0;
    }
    loop *l = &b->loops[b->loop_count++];
    l->first = (uint32_t)b->corner_count;
    for (size_t i = 0; i < face.count; i++) {
      int64_t at;
      qn_value c = face.u.items[i];
      if (c.kind != QN_V_NUMBER || !qn_num_is_integer(c.u.number, &at) || at < 0 || at >= (int64_t)b->point_count) {
        char reason[96];
        snprintf(reason, sizeof reason, "indices are whole numbers from 0 to %zu", b->point_count ? b->point_count - 1 : 0);
        qn_arg_tell(call, QN_Q0513, which, reason, NULL, "face %zu has an index that is no point", f);
        return 0;
      }
      uint32_t p = b->same[at];
      b->used[p] = 1;
      if (b->corner_count == l->first || b->corners[b->corner_count - 1] != p) {
        b->corners[b->corner_count++] = p;
      }
    }
    while (b->corner_count > l->first + 1 && b->corners[b->corner_count - 1] == b->corners[l->first]) {
      b->corner_count--;
    }
    l->count = (uint32_t)b->corner_count - l->first;
  }
  return 1;
}

/* --- checks --------------------------------------------------------------------------------------------------------- */

static int by_ends(const void *pa, const void *pb) {
  const edge *a = pa, *b = pb;
  return a->low != b->low ? (a->low < b->low ? -1 : 1) : (a->high > b->high) - (a->high < b->high);
}

static int closed(body *b) {
  edge *edges = room(b, (b->corner_count + 1) * sizeof *edges);
  if (!edges) {
    return 0;
  }
  size_t n = 0;
  for (size_t f = 0; f < b->loop_count; f++) {
    const loop *l = &b->loops[f];
    for (uint32_t i = 0; i < l->count && l->count > 1; i++) {
      uint32_t p = b->corners[l->first + i], q = b->corners[l->first + (i + 1) % l->count];
      edges[n++] = p < q ? (edge){p, q, 1} : (edge){q, p, -1};
    }
  }
  qsort(edges, n, sizeof *edges, by_ends);
  for (size_t i = 0; i < n;) {
    size_t j = i;
    int turn = 0;
    for (; j < n && edges[j].low == edges[i].low && edges[j].high == edges[i].high; j++) {
      turn += edges[j].turn;
    }
    if (turn) {
      qn_arg_tell(b->call, QN_Q0511, FACES, "each edge must belong to two faces that pass it in opposite directions", NULL,
                  "the faces do not close up at the edge from point %lu to point %lu",
                  (unsigned long)edges[i].low, (unsigned long)edges[i].high);
      return 0;
    }
    i = j;
  }
  return 1;
}

/* 1 where the numbers of two planes are equal, -1 where they are each other's negatives, else 0. */
static int same_plane(qn_ctx *ctx, const qn_num *a, const qn_num *b, int sign) {
  for (size_t k = 0; k < 4; k++) {
    if (qn_num_cmp(ctx, a[k], sign > 0 ? b[k] : qn_num_neg(ctx, b[k])) != 0) {
      return 0;
    }
  }
  return sign;
}

/* The distinct plane, outward, that this one is, or is turned over (*turn: 1, -1); plane_count when it is a new one. */
static size_t find_plane(body *b, const qn_num plane[4], const double near[4], int *turn) {
  size_t i = 0;
  qn_ctx_spend(b->ctx, b->plane_count, QN_EFFORT_QUICK);
  for (*turn = 0; i < b->plane_count; i++) {
    int may = qn_polyhedron_may_be(b->near_planes[i], near);
    qn_mark mark = qn_arena_mark(&b->ctx->arena);
    *turn = may & 1 ? same_plane(b->ctx, b->planes + 4 * i, plane, 1) : 0;
    *turn = *turn == 0 && may & 2 ? same_plane(b->ctx, b->planes + 4 * i, plane, -1) : *turn;
    qn_arena_release(&b->ctx->arena, mark);
    if (*turn) {
      break;
    }
  }
  return i;
}

/* On which sides of a new plane the used points lie (*below, *above); those on it become `on`. 0 when memory is refused or too much was done. */
static int find_sides(body *b, const qn_num plane[4], const double near[4], uint32_t *list, int *below, int *above, meeting *on) {
  size_t count = 0;
  *below = *above = 0;
  qn_ctx_spend(b->ctx, b->point_count, QN_EFFORT_QUICK);
  for (size_t i = 0; i < b->point_count && !(*below && *above) && !b->ctx->failed; i++) {
    if (b->used[i]) {
      int s = qn_polyhedron_side(b->ctx, plane, near, b->points + 3 * i, b->near[i]);
      *below |= s < 0;
      *above |= s > 0;
      list[count] = (uint32_t)i;
      count += s == 0;
    }
  }
  on->count = count;
  on->items = room(b, count * sizeof *on->items);
  if (b->ctx->failed || !on->items) {
    return 0;
  }
  memcpy(on->items, list, count * sizeof *on->items);
  return 1;
}

/* The distinct planes, outward, and the points on each; 0 on an error. */
static int find_planes(body *b) {
  b->planes = room(b, (b->loop_count + 1) * 4 * sizeof *b->planes);
  b->near_planes = room(b, (b->loop_count + 1) * sizeof *b->near_planes);
  b->on = room(b, (b->loop_count + 1) * sizeof *b->on);
  uint32_t *list = room(b, b->point_count * sizeof *list);
  if (!b->planes || !b->near_planes || !b->on || !list) {
    return 0;
  }
  size_t inside_out = 0, right = 0;
  for (size_t f = 0; f < b->loop_count; f++) {
    const loop *l = &b->loops[f];
    qn_num *plane = b->planes + 4 * b->plane_count;
    double *near = b->near_planes[b->plane_count];
    if (l->count < 3 || !qn_polyhedron_plane(b->ctx, b->points, b->corners + l->first, l->count, plane)) {
      continue; /* no area: it adds nothing but its edges */
    }
    qn_polyhedron_shadow(4, plane, near);
    for (uint32_t i = 0; i < l->count; i++) {
      uint32_t p = b->corners[l->first + i];
      if (qn_polyhedron_side(b->ctx, plane, near, b->points + (size_t)3 * p, b->near[p]) != 0) {
        qn_arg_tell(b->call, QN_Q0512, FACES, "its points are taken exactly as they are written",
                    "split it into triangles", "face %zu is not plane", f);
        return 0;
      }
    }
    int turn = 0, below = 0, above = 0;
    size_t same = find_plane(b, plane, near, &turn);
    if (same < b->plane_count) { /* its sides are known: of the kept one, outward, all points are below */
      inside_out += turn < 0;
      right += turn > 0;
      continue;
    }
    if (!find_sides(b, plane, near, list, &below, &above, &b->on[b->plane_count])) {
      return 0;
    }
    if (below && above) {
      qn_arg_tell(b->call, QN_Q0510, FACES, "points lie on both sides of a face; only convex polyhedra are supported yet",
                  "make it a union or a difference of convex ones", "the polyhedron is not convex at face %zu", f);
      return 0;
    }
    if (!below && !above) {
      b->call->empty = 1;
      qn_arg_tell(b->call, QN_Q0501, FACES, NULL, NULL, "all points lie in one plane, so the solid is empty");
      return 0;
    }
    inside_out += above != 0;
    right += below != 0;
    for (size_t k = 0; above && k < 4; k++) {
      plane[k] = qn_num_neg(b->ctx, plane[k]);
      near[k] = -near[k];
    }
    b->plane_count++;
  }
  if (inside_out && right) {
    qn_arg_tell(b->call, QN_Q0511, FACES, NULL, "list each face's points clockwise as seen from outside",
                "some faces are turned inwards and some outwards");
    return 0;
  }
  if (inside_out) {
    qn_arg_tell(b->call, QN_Q0514, FACES, "faces are clockwise seen from outside", NULL, "all faces are inside out; they are turned round");
  }
  if (b->plane_count == 0) {
    b->call->empty = 1;
    qn_arg_tell(b->call, QN_Q0501, FACES, NULL, NULL, "no face has an area, so the solid is empty");
    return 0;
  }
  return 1;
}

/* Do the normals of the planes through a point span space? */
static int is_corner(body *b, const meeting *through) {
  qn_mark mark = qn_arena_mark(&b->ctx->arena);
  const qn_num *first = NULL;
  qn_num cross[3];
  int have_two = 0, found = 0;
  for (size_t i = 0; i < through->count && !found && qn_ctx_spend(b->ctx, 1, QN_EFFORT_SIDE); i++) {
    const qn_num *plane = b->planes + (size_t)4 * through->items[i];
    if (!first) {
      first = plane;
    } else if (!have_two) {
      for (size_t k = 0; k < 3; k++) {
        cross[k] = qn_polyhedron_cross(b->ctx, first, plane, k);
      }
      have_two = !(qn_num_is_zero(cross[0]) && qn_num_is_zero(cross[1]) && qn_num_is_zero(cross[2]));
    } else {
      found = !qn_num_is_zero(qn_num_dot(b->ctx, 3, cross, plane));
    }
  }
  qn_arena_release(&b->ctx->arena, mark);
  return found;
}

/* The planes at each point, from the points on each plane. */
static meeting *planes_at(body *b) {
  meeting *at = room(b, b->point_count * sizeof *at);
  size_t total = 0;
  if (!at) {
    return NULL;
  }
  memset(at, 0, b->point_count * sizeof *at);
  for (size_t f = 0; f < b->plane_count; f++) {
    for (size_t i = 0; i < b->on[f].count; i++) {
      at[b->on[f].items[i]].count++;
    }
    total += b->on[f].count;
  }
  uint32_t *items = room(b, total * sizeof *items);
  for (size_t p = 0; items && p < b->point_count; p++) {
    at[p].items = items;
    items += at[p].count;
    at[p].count = 0;
  }
  for (size_t f = 0; items && f < b->plane_count; f++) {
    for (size_t i = 0; i < b->on[f].count; i++) {
      meeting *m = &at[b->on[f].items[i]];
      m->items[m->count++] = (uint32_t)f;
    }
  }
  return items ? at : NULL;
}

static uint32_t finish(body *b) {
  size_t n = b->plane_count, m = 0;
  qn_num *out = room(b, (2 + 4 * n + 3 * b->point_count) * sizeof *out);
  uint32_t *number = room(b, b->point_count * sizeof *number), *corners = room(b, b->point_count * sizeof *corners);
  const meeting *at = planes_at(b);
  if (!out || !number || !corners || !at) {
    return QN_NO_NODE;
  }
  qn_num *vertices = out + 2 + 4 * n;
  for (size_t i = 0; i < b->point_count && !b->ctx->failed; i++) {
    number[i] = UINT32_MAX;
    if (b->used[i] && is_corner(b, &at[i])) {
      number[i] = (uint32_t)m;
      memcpy(vertices + 3 * m++, b->points + 3 * i, 3 * sizeof *vertices);
    }
  }
  out[0] = qn_num_from_int(b->ctx, (int64_t)n);
  out[1] = qn_num_from_int(b->ctx, (int64_t)m);
  for (size_t f = 0; f < n && !b->ctx->failed; f++) {
    size_t count = 0;
    memcpy(out + 2 + 4 * f, b->planes + 4 * f, 4 * sizeof *out);
    for (size_t i = 0; i < b->on[f].count; i++) {
      corners[count] = number[b->on[f].items[i]];
      count += corners[count] != UINT32_MAX;
    }
    if (count >= 3) {
      qn_polyhedron_turn(b->ctx, b->planes + 4 * f, vertices, corners, count);
      qn_polyhedron_plane(b->ctx, vertices, corners, count, out + 2 + 4 * f);
    }
  }
  return b->ctx->failed ? QN_NO_NODE : qn_call_leaf(b->call, QN_POLYHEDRON, out, 2 + 4 * n + 3 * m);
}

uint32_t qn_make_polyhedron(qn_call *call) {
  body b = {.call = call, .ctx = &call->ev->ctx};
  if (read_points(&b) && find_same(&b) && read_faces(&b) && closed(&b) && find_planes(&b)) {
    return finish(&b);
  }
  return call->ev->failed || call->ev->ctx.failed ? QN_NO_NODE : qn_call_leaf(call, QN_POLYHEDRON, NULL, 0);
}
