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
  qn_num *planes;       /* 4 each, distinct */
  size_t plane_count;
} body;

static qn_num cross_component(qn_ctx *ctx, const qn_num *a, const qn_num *b, size_t i) {
  size_t j = (i + 1) % 3, k = (i + 2) % 3;
  qn_num x[2] = {a[j], a[k]}, y[2] = {b[k], qn_num_neg(ctx, b[j])};
  return qn_num_dot(ctx, 2, x, y);
}

enum { EFFORT_SIDE = 256, EFFORT_TURN = 2048 }; /* QN_MAX_EFFORT: some 1800 faces of 900 points, or two faces of 700 */

/* The sign of n.p - d. */
static int side(qn_ctx *ctx, const qn_num plane[4], const qn_num *p) {
  qn_ctx_spend(ctx, 1, EFFORT_SIDE);
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_num x[4] = {plane[0], plane[1], plane[2], plane[3]}, y[4] = {p[0], p[1], p[2], qn_num_from_int(ctx, -1)};
  int sign = qn_num_sign(qn_num_dot(ctx, 4, x, y));
  qn_arena_release(&ctx->arena, mark);
  return sign;
}

/* The outward plane of a loop of points; 0 when it has no area. */
static int plane_of(qn_ctx *ctx, const qn_num *points, const uint32_t *corners, size_t count, qn_num plane[4]) {
  const qn_num *origin = points + (size_t)3 * corners[0];
  qn_num n[3] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO};
  qn_num a[3], b[3];
  for (size_t i = 0; i + 1 < count; i++) { /* relative to the first point: smaller numbers, and its own terms are zero */
    const qn_num *p = points + (size_t)3 * corners[i], *q = points + (size_t)3 * corners[i + 1];
    for (size_t k = 0; k < 3; k++) {
      a[k] = qn_num_sub(ctx, p[k], origin[k]);
      b[k] = qn_num_sub(ctx, q[k], origin[k]);
    }
    for (size_t k = 0; k < 3; k++) {
      n[k] = qn_num_sub(ctx, n[k], cross_component(ctx, a, b, k));
    }
  }
  size_t lead = 0;
  while (lead < 3 && qn_num_is_zero(n[lead])) {
    lead++;
  }
  if (lead == 3) {
    return 0;
  }
  qn_num by = qn_num_abs(ctx, n[lead]);
  for (size_t k = 0; k < 3; k++) {
    plane[k] = qn_num_div(ctx, n[k], by);
  }
  plane[3] = qn_num_dot(ctx, 3, plane, origin);
  return 1;
}

size_t qn_polyhedron_face(qn_ctx *ctx, const qn_num plane[4], const qn_num *vertices, size_t m, uint32_t *corners) {
  size_t count = 0;
  for (size_t i = 0; i < m; i++) {
    if (side(ctx, plane, vertices + 3 * i) == 0) {
      corners[count++] = (uint32_t)i;
    }
  }
  /* The corner after `here` is the one that has every other on its right: (next - here) x (other - here) . n < 0. */
  for (size_t k = 0; k + 1 < count; k++) {
    const qn_num *here = vertices + (size_t)3 * corners[k];
    for (size_t j = k + 2; j < count && qn_ctx_spend(ctx, 1, EFFORT_TURN); j++) {
      qn_mark mark = qn_arena_mark(&ctx->arena);
      const qn_num *next = vertices + (size_t)3 * corners[k + 1], *other = vertices + (size_t)3 * corners[j];
      qn_num d[3], e[3], cross[3];
      for (size_t i = 0; i < 3; i++) {
        d[i] = qn_num_sub(ctx, next[i], here[i]);
        e[i] = qn_num_sub(ctx, other[i], here[i]);
      }
      for (size_t i = 0; i < 3; i++) {
        cross[i] = cross_component(ctx, d, e, i);
      }
      if (qn_num_sign(qn_num_dot(ctx, 3, cross, plane)) > 0) {
        uint32_t swap = corners[k + 1];
        corners[k + 1] = corners[j];
        corners[j] = swap;
      }
      qn_arena_release(&ctx->arena, mark);
    }
  }
  return count;
}

static void *room(body *b, size_t size) {
  void *p = qn_arena_take(&b->ctx->arena, size);
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

/* Finds points that are equal: heap sort, as qsort takes no context. */
static int find_same(body *b) {
  size_t n = b->point_count;
  uint32_t *heap = room(b, n * sizeof *heap);
  b->same = room(b, n * sizeof *b->same);
  b->used = room(b, n * sizeof *b->used);
  if (!heap || !b->same || !b->used) {
    return 0;
  }
  memset(b->used, 0, n);
  for (size_t i = 0; i < n; i++) {
    heap[i] = (uint32_t)i;
  }
  for (size_t start = n / 2, end = n; end > 1;) {
    if (start > 0) {
      start--;
    } else {
      end--;
      uint32_t swap = heap[0];
      heap[0] = heap[end];
      heap[end] = swap;
    }
    for (size_t at = start, child; (child = 2 * at + 1) < end; at = child) {
      const qn_num *here = b->points + (size_t)3 * heap[at];
      if (child + 1 < end) {
        int c = order(b->ctx, b->points + (size_t)3 * heap[child], b->points + (size_t)3 * heap[child + 1]);
        child += c < 0 || (c == 0 && heap[child] < heap[child + 1]);
      }
      int c = order(b->ctx, here, b->points + (size_t)3 * heap[child]);
      if (c > 0 || (c == 0 && heap[at] >= heap[child])) {
        break;
      }
      uint32_t swap = heap[at];
      heap[at] = heap[child];
      heap[child] = swap;
    }
  }
  for (size_t i = 0; i < n; i++) {
    int equal = i > 0 && order(b->ctx, b->points + (size_t)3 * heap[i - 1], b->points + (size_t)3 * heap[i]) == 0;
    b->same[heap[i]] = equal ? b->same[heap[i - 1]] : heap[i];
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

static int equal_planes(qn_ctx *ctx, const qn_num *a, const qn_num *b) {
  for (size_t k = 0; k < 4; k++) {
    if (qn_num_cmp(ctx, a[k], b[k]) != 0) {
      return 0;
    }
  }
  return 1;
}

/* The distinct planes, outward; 0 on an error. */
static int find_planes(body *b) {
  b->planes = room(b, (b->loop_count + 1) * 4 * sizeof *b->planes);
  if (!b->planes) {
    return 0;
  }
  size_t inside_out = 0, right = 0;
  for (size_t f = 0; f < b->loop_count; f++) {
    const loop *l = &b->loops[f];
    qn_num *plane = b->planes + 4 * b->plane_count;
    if (l->count < 3 || !plane_of(b->ctx, b->points, b->corners + l->first, l->count, plane)) {
      continue; /* no area: it adds nothing but its edges */
    }
    for (uint32_t i = 0; i < l->count; i++) {
      if (side(b->ctx, plane, b->points + (size_t)3 * b->corners[l->first + i]) != 0) {
        qn_arg_tell(b->call, QN_Q0512, FACES, "its points are taken exactly as they are written",
                    "split it into triangles", "face %zu is not plane", f);
        return 0;
      }
    }
    int below = 0, above = 0;
    for (size_t i = 0; i < b->point_count && !(below && above) && !b->ctx->failed; i++) {
      if (b->used[i]) {
        int s = side(b->ctx, plane, b->points + 3 * i);
        below |= s < 0;
        above |= s > 0;
      }
    }
    if (b->ctx->failed) {
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
    }
    size_t same = 0;
    while (same < b->plane_count && !equal_planes(b->ctx, b->planes + 4 * same, plane)) {
      same++;
    }
    b->plane_count += same == b->plane_count;
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
static int is_corner(body *b, const qn_num *p) {
  qn_mark mark = qn_arena_mark(&b->ctx->arena);
  const qn_num *first = NULL;
  qn_num cross[3];
  int have_two = 0, found = 0;
  for (size_t i = 0; i < b->plane_count && !found; i++) {
    const qn_num *plane = b->planes + 4 * i;
    if (side(b->ctx, plane, p) != 0) {
      continue;
    }
    if (!first) {
      first = plane;
    } else if (!have_two) {
      for (size_t k = 0; k < 3; k++) {
        cross[k] = cross_component(b->ctx, first, plane, k);
      }
      have_two = !(qn_num_is_zero(cross[0]) && qn_num_is_zero(cross[1]) && qn_num_is_zero(cross[2]));
    } else {
      found = !qn_num_is_zero(qn_num_dot(b->ctx, 3, cross, plane));
    }
  }
  qn_arena_release(&b->ctx->arena, mark);
  return found;
}

static uint32_t finish(body *b) {
  size_t n = b->plane_count, m = 0;
  qn_num *out = room(b, (2 + 4 * n + 3 * b->point_count) * sizeof *out);
  uint32_t *corners = room(b, (b->point_count + 1) * sizeof *corners);
  if (!out || !corners) {
    return QN_NO_NODE;
  }
  qn_num *vertices = out + 2 + 4 * n;
  for (size_t i = 0; i < b->point_count && !b->ctx->failed; i++) {
    if (b->used[i] && is_corner(b, b->points + 3 * i)) {
      memcpy(vertices + 3 * m++, b->points + 3 * i, 3 * sizeof *vertices);
    }
  }
  out[0] = qn_num_from_int(b->ctx, (int64_t)n);
  out[1] = qn_num_from_int(b->ctx, (int64_t)m);
  for (size_t f = 0; f < n && !b->ctx->failed; f++) {
    memcpy(out + 2 + 4 * f, b->planes + 4 * f, 4 * sizeof *out);
    size_t count = qn_polyhedron_face(b->ctx, b->planes + 4 * f, vertices, m, corners);
    if (count >= 3) {
      plane_of(b->ctx, vertices, corners, count, out + 2 + 4 * f);
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
