/* Contacts: places where the closed solid is touched between two stretches outside it.

   Candidates are the places where half-spaces of a leaf meet without a stretch, where a line touches a surface, and where
   leaves begin or end without a change of the answer. A candidate away from every stretch is a contact when the solid has
   points next to it (S6). At a rational place that is asked exactly. An irrational place is a simple root of every
   surface that vanishes there, and all those surfaces have proportional forms along the line (the tie lemma,
   docs/exactness.md): with one such surface its two sides are realisable, with two all four combinations are,
   unless their gradients are parallel there. Parallel gradients, and three surfaces or more, are given up: no contact is
   reported there (docs/exactness.md says so).

   Legend: the gradient of a surface at w-times the point of t is g0 + t g1; two gradients' cross product has components
   c0 + c1 t + c2 t^2; it vanishes at an irrational root of a t^2 + 2 h t + c when it is a multiple of that, or zero. */
#include "ray/around.h"
#include "ray/scratch.h"

typedef struct nearby {
  qn_near_leaf *leaves;
  size_t count;
  uint32_t *halves;
  size_t half_count;
} nearby;

/* The sign of a half-space's q at a place; 0 where it vanishes. */
static int sign_at(qn_scratch *s, uint32_t half, uint32_t solved, const qn_bound *at) {
  qn_solved v = s->solved[solved];
  int sign = s->scene->halves[half].side * v.sign;
  for (uint32_t i = 0; i < v.roots + v.touches; i++) {
    qn_root_at r = s->roots[v.root0 + i];
    qn_bound root = {r.t, r.e, solved, half, i};
    int order = qn_bound_cmp(s, &root, at);
    if (order == 0) {
      return 0;
    }
    if (order < 0 && i < v.roots) {
      sign = -sign;
    }
  }
  return sign;
}

/* The leaves whose closed solids hold the place. */
static int find_nearby(qn_scratch *s, const qn_bound *at, nearby *out) {
  size_t halves = 0;
  for (size_t i = 0; i < s->candidate_count; i++) {
    halves += s->scene->leaves[s->candidates[i]].halves;
  }
  *out = (nearby){0};
  out->leaves = qn_arena_take(&s->ctx.arena, (s->candidate_count + 1) * sizeof *out->leaves);
  out->halves = qn_arena_take(&s->ctx.arena, (halves + 1) * sizeof *out->halves);
  if (!out->leaves || !out->halves) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return 0;
  }
  for (size_t i = 0; i < s->candidate_count; i++) {
    const qn_leaf *leaf = &s->scene->leaves[s->candidates[i]];
    qn_filter_leaf frame;
    qn_filter_leaf_begin(&s->filter, leaf->pivot, &frame);
    qn_near_leaf near = {s->candidates[i], (uint32_t)out->half_count, 0};
    int holds = 1;
    for (uint32_t h = leaf->half0; holds && h < leaf->half0 + leaf->halves; h++) {
      uint32_t solved = qn_solve_half(s, leaf, &frame, h);
      if (solved == QN_NO_SOLVED) {
        return 0;
      }
      int sign = sign_at(s, h, solved, at);
      holds = sign <= 0;
      if (sign == 0) {
        out->halves[near.first + near.count++] = h;
      }
    }
    if (holds) {
      out->leaves[out->count++] = near;
      out->half_count += near.count;
    }
  }
  return 1;
}

static int touches_at_rational(qn_scratch *s, const nearby *n, qn_int num, qn_int den) {
  qn_line_make_exact(&s->ctx, s->line);
  qn_point point;
  for (int j = 0; j < 3; j++) {
    point.x[j] = qn_int_add(&s->ctx, qn_int_mul(&s->ctx, s->line->origin[j], den), qn_int_mul(&s->ctx, s->line->direction[j], num));
  }
  point.w = qn_int_mul(&s->ctx, s->line->w, den);
  quoin_side side = QUOIN_OUTSIDE;
  if (s->ctx.failed == QUOIN_OK) {
    quoin_status status = qn_around(s->scene, s, &point, n->leaves, n->count, n->halves, n->half_count, &side);
    if (status != QUOIN_OK) {
      qn_scratch_fail(s, status);
    }
  }
  return side != QUOIN_OUTSIDE;
}

static qn_xint coefficient(const qn_exact_surface *f, int i) {
  return f->rounded && qn_int_sign(f->q[i]) != 0 ? qn_x_rounded(f->q[i]) : qn_x(f->q[i]);
}

/* g0 and g1 of a surface. */
static void gradient(qn_scratch *s, const qn_exact_surface *f, qn_xint g0[3], qn_xint g1[3]) {
  static const int row[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  qn_ctx *ctx = &s->ctx;
  for (int i = 0; i < 3; i++) {
    g1[i] = qn_x(qn_int_from(ctx, 0));
    g0[i] = coefficient(f, 6 + i);
    if (f->plane) {
      continue;
    }
    g0[i] = qn_x_mul(ctx, g0[i], qn_x(s->line->w));
    for (int j = 0; j < 3; j++) {
      qn_xint k = qn_x_shl(ctx, coefficient(f, row[i][j]), i == j ? 1 : 0);
      g0[i] = qn_x_add(ctx, g0[i], qn_x_mul(ctx, k, qn_x(s->line->origin[j])));
      g1[i] = qn_x_add(ctx, g1[i], qn_x_mul(ctx, k, qn_x(s->line->direction[j])));
    }
  }
}

static qn_xint minor(qn_ctx *ctx, qn_xint a, qn_xint b, qn_xint c, qn_xint d) {
  return qn_x_sub(ctx, qn_x_mul(ctx, a, d), qn_x_mul(ctx, b, c));
}

static int parallel_at_root(qn_scratch *s, uint32_t surface1, uint32_t surface2, const qn_quad *q) {
  int made = 0;
  const qn_exact_surface *f = qn_scene_exact(s->scene, surface1, &made), *g = qn_scene_exact(s->scene, surface2, &made);
  if (!f || !g) {
    qn_scratch_fail(s, qn_scene_no_exact(s->scene, f ? surface2 : surface1));
    return 1;
  }
  qn_ctx *ctx = &s->ctx;
  qn_xint a0[3], a1[3], b0[3], b1[3], two_h = qn_x_shl(ctx, q->h, 1);
  gradient(s, f, a0, a1);
  gradient(s, g, b0, b1);
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    qn_xint c0 = minor(ctx, a0[j], a0[k], b0[j], b0[k]), c2 = minor(ctx, a1[j], a1[k], b1[j], b1[k]);
    qn_xint c1 = qn_x_add(ctx, minor(ctx, a0[j], a0[k], b1[j], b1[k]), minor(ctx, a1[j], a1[k], b0[j], b0[k]));
    if (qn_x_sign(minor(ctx, c0, c1, q->c, two_h)) || qn_x_sign(minor(ctx, c0, c2, q->c, q->a)) || qn_x_sign(minor(ctx, c1, c2, two_h, q->a))) {
      return 0;
    }
  }
  return 1;
}

/* Whether the solid has points next to an irrational place, where at most two surfaces vanish. */
static int touches_at_irrational(qn_scratch *s, const nearby *n, const qn_quad *q) {
  uint32_t surfaces[2];
  unsigned count = 0;
  const qn_half *halves = s->scene->halves;
  for (size_t i = 0; i < n->half_count; i++) {
    uint32_t surface = halves[n->halves[i]].surface;
    if (count > 0 && (surface == surfaces[0] || (count == 2 && surface == surfaces[1]))) {
      continue;
    }
    if (count == 2) {
      return 0;
    }
    surfaces[count++] = surface;
  }
  if (count == 2 && parallel_at_root(s, surfaces[0], surfaces[1], q)) {
    return 0;
  }
  int found = 0;
  for (unsigned signs = 0; signs < 1u << count && !found; signs++) {
    for (size_t i = 0; i < n->count; i++) {
      const qn_near_leaf *near = &n->leaves[i];
      int inside = 1;
      for (uint32_t k = near->first; k < near->first + near->count; k++) {
        const qn_half *half = &halves[n->halves[k]];
        /* cppcheck-suppress uninitvar ; a leaf that is near has a half-space, and its surface was entered above */
        unsigned bit = half->surface == surfaces[0] ? 0 : 1;
        inside &= (half->side > 0) == (signs >> bit & 1); /* bit set: the form is negative there */
      }
      const qn_leaf *leaf = &s->scene->leaves[near->leaf];
      if (inside) {
        (void)qn_eval_change(&s->weave, leaf->gate, leaf->negated ? -1 : 1);
      }
    }
    found = s->weave.value;
    qn_eval_reset(&s->weave);
  }
  return found;
}

static int away_from(qn_scratch *s, const qn_stretch *list, size_t n, const qn_bound *at) {
  for (size_t i = 0; i < n; i++) {
    qn_bound enter = qn_bound_from_place(s, &list[i].enter.place), leave = qn_bound_from_place(s, &list[i].leave.place);
    if (qn_bound_cmp(s, at, &enter) >= 0 && qn_bound_cmp(s, at, &leave) <= 0) {
      return 0;
    }
  }
  return 1;
}

static void classify(qn_scratch *s, const qn_bound *at) {
  nearby n;
  if (!find_nearby(s, at, &n) || n.count == 0 || n.half_count == 0) {
    return;
  }
  qn_root root = qn_bound_root(s, at);
  qn_int num, den;
  if (!root.q) {
    return;
  }
  int touched = qn_root_rational(&s->ctx, root, &num, &den) ? touches_at_rational(s, &n, num, den) : touches_at_irrational(s, &n, root.q);
  if (!touched) {
    return;
  }
  if (!qn_grow(s->mem, &s->contacts, &s->contact_capacity, s->contact_count + 1)) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return;
  }
  qn_stop stop = {qn_bound_place(s, at), QN_NO_LEAF, QN_NO_HALF};
  for (size_t i = 0; i < n.count; i++) { /* the first leaf, in the order of the file, that has a surface there */
    if (n.leaves[i].count && n.leaves[i].leaf < stop.leaf) {
      stop.leaf = n.leaves[i].leaf;
      stop.half = n.halves[n.leaves[i].first];
    }
  }
  s->contacts[s->contact_count++] = stop;
}

void qn_weave_contacts(qn_scratch *s, const qn_bound *from, const qn_bound *to) {
  size_t n = s->touch_count + s->event_count, count = 0;
  qn_bound *places = qn_arena_take(&s->ctx.arena, (n + 1) * sizeof *places);
  if (!places) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return;
  }
  for (size_t i = 0; i < n && qn_scratch_status(s) == QUOIN_OK; i++) { /* sorted, each place once */
    qn_bound b = i < s->touch_count ? s->touches[i] : s->events[i - s->touch_count].at;
    if (b.solved == QN_NO_SOLVED || qn_bound_cmp(s, &b, from) < 0 || qn_bound_cmp(s, to, &b) < 0) {
      continue;
    }
    size_t low = 0, high = count;
    int there = 0;
    while (low < high && !there) {
      size_t middle = low + (high - low) / 2;
      int order = qn_bound_cmp(s, &places[middle], &b);
      there = order == 0;
      if (order < 0) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    if (there) {
      continue;
    }
    for (size_t k = count; k > low; k--) {
      places[k] = places[k - 1];
    }
    places[low] = b;
    count++;
  }
  for (size_t i = 0; i < count && qn_scratch_status(s) == QUOIN_OK; i++) {
    if (away_from(s, s->inside, s->inside_count, &places[i]) && away_from(s, s->boundary, s->boundary_count, &places[i])) {
      classify(s, &places[i]);
    }
  }
}
