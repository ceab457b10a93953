/* Contacts: places where the closed solid is touched between two stretches outside it.

   Candidates are the places where half-spaces of a leaf meet without a stretch, where a line touches a surface, and where
   leaves begin or end without a change of the answer. A candidate away from every stretch is a contact when the solid has
   points next to it (S6). At a rational place that is asked exactly. An irrational place is a simple root of every
   surface that vanishes there, and all those surfaces have proportional forms along the line (the tie lemma,
   docs/exactness.md): with one such surface its two sides are realisable, with two all four combinations are,
   unless their gradients are parallel there. Parallel gradients, and three surfaces or more, are given up: no contact is
   reported there (docs/exactness.md says so).

   Places are taken in their order along the line. The program is kept with the leaves in whose interiors the place lies; only leaves with a half-space that
   vanishes there are looked at: those that begin, end or touch there, and those in whose surfaces the line runs. So the cost of a place is theirs, not that of all
   leaves which hold it.

   Legend: the gradient of a surface at w-times the point of t is g0 + t g1; two gradients' cross product has components
   c0 + c1 t + c2 t^2; it vanishes at an irrational root of a t^2 + 2 h t + c when it is a multiple of that, or zero. */
#include "base/limits.h"
#include "ray/around.h"
#include "ray/scratch.h"

#include <string.h>

/* The leaves with a half-space that vanishes at the place at hand, and those half-spaces. */
typedef struct nearby {
  qn_near_leaf *leaves;
  size_t count, capacity;
  uint32_t *halves;
  size_t half_count, half_capacity;
} nearby;

/* What happens at a place to a candidate: it has a surface there; its interior, or a stretch in one of its surfaces, begins; or has ended before. */
enum { MEETS, BEGINS, ENDS, BEGINS_IN_SURFACE, ENDS_IN_SURFACE };
typedef struct step { uint32_t place, candidate; uint8_t what; } step;

typedef struct sweep {
  qn_scratch *s;
  qn_bound *places; /* in order, each once, all of them away from stretches */
  size_t count;
  step *found;
  size_t step_count, step_capacity;
  step *steps;      /* those found, by place */
  size_t *first;    /* by place, and one more: of its steps */
  uint8_t *inside;  /* by candidate: 1: the program holds it, 2: it does but for this place */
  uint32_t *seen;   /* by candidate: 1 + the last place at which it was looked at */
  uint32_t *in_surface; /* candidates in whose surfaces the line runs here */
  uint32_t *at;         /* by candidate: where among them */
  size_t in_surface_count;
  nearby near;
} sweep;

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

static void hold(sweep *w, uint32_t candidate, int inside) {
  const qn_leaf *leaf = &w->s->scene->leaves[w->s->candidates[candidate]];
  w->inside[candidate] = (uint8_t)inside;
  if (leaf->gate != QN_NO_GATE) {
    (void)qn_eval_change(&w->s->eval, leaf->gate, inside != leaf->negated ? 1 : -1);
  }
}

/* Adds a candidate if its closed solid holds the place and has a surface there. 0: a failure. */
static int add_near(sweep *w, uint32_t candidate, uint32_t place) {
  qn_scratch *s = w->s;
  nearby *near = &w->near;
  const uint32_t number = s->candidates[candidate];
  const qn_leaf *leaf = &s->scene->leaves[number];
  if (w->seen[candidate] == place + 1) {
    return 1;
  }
  w->seen[candidate] = place + 1;
  if (!qn_scratch_spend(s, leaf->halves, QN_EFFORT_CHANGE)) {
    return 0;
  }
  if (!qn_grow(s->mem, &near->leaves, &near->capacity, near->count + 1) || !qn_grow(s->mem, &near->halves, &near->half_capacity, near->half_count + leaf->halves)) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return 0;
  }
  qn_filter_leaf frame;
  qn_filter_leaf_begin(&s->filter, leaf->pivot, &frame);
  qn_near_leaf found = {number, (uint32_t)near->half_count, 0};
  for (uint32_t h = leaf->half0; h < leaf->half0 + leaf->halves; h++) {
    uint32_t solved = qn_solve_half(s, leaf, &frame, h);
    if (solved == QN_NO_SOLVED) {
      return 0;
    }
    int sign = sign_at(s, h, solved, &w->places[place]);
    if (sign > 0) {
      return 1;
    }
    if (sign == 0) {
      near->halves[found.first + found.count++] = h;
    }
  }
  if (found.count != 0) {
    near->leaves[near->count++] = found;
    near->half_count += found.count;
    if (w->inside[candidate] == 1) { /* it is touched from within */
      hold(w, candidate, 0);
      w->inside[candidate] = 2;
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
    quoin_status status = qn_around(s->scene, s, &point, n->leaves, n->count, n->halves, n->half_count, QN_AROUND_HELD, &side);
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
    for (int undo = 0; undo < 2; undo++) {
      for (size_t i = 0; i < n->count; i++) {
        const qn_near_leaf *near = &n->leaves[i];
        const qn_leaf *leaf = &s->scene->leaves[near->leaf];
        int inside = leaf->gate != QN_NO_GATE;
        for (uint32_t k = near->first; k < near->first + near->count; k++) {
          const qn_half *half = &halves[n->halves[k]];
          /* cppcheck-suppress uninitvar ; a leaf that is near has a half-space, and its surface was entered above */
          unsigned bit = half->surface == surfaces[0] ? 0 : 1;
          inside &= (half->side > 0) == (signs >> bit & 1); /* bit set: the form is negative there */
        }
        if (inside) {
          (void)qn_eval_change(&s->eval, leaf->gate, leaf->negated == undo ? 1 : -1);
        }
      }
      found |= s->eval.value && !undo;
    }
  }
  return found;
}

static void classify(sweep *w, const qn_bound *at) {
  qn_scratch *s = w->s;
  const nearby *n = &w->near;
  if (n->half_count == 0) {
    return;
  }
  qn_root root = qn_bound_root(s, at);
  qn_int num, den;
  if (!root.q) {
    return;
  }
  int touched = qn_root_rational(&s->ctx, root, &num, &den) ? touches_at_rational(s, n, num, den) : touches_at_irrational(s, n, root.q);
  if (!touched) {
    return;
  }
  if (!qn_grow(s->mem, &s->contacts, &s->contact_capacity, s->contact_count + 1)) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return;
  }
  qn_stop stop = {qn_bound_place(s, at), QN_NO_LEAF, QN_NO_HALF};
  for (size_t i = 0; i < n->count; i++) { /* the first leaf, in the order of the file, that has a surface there */
    if (n->leaves[i].leaf < stop.leaf) {
      stop.leaf = n->leaves[i].leaf;
      stop.half = n->halves[n->leaves[i].first];
    }
  }
  s->contacts[s->contact_count++] = stop;
}

/* --- places ----------------------------------------------------------------------------------------------------------- */

/* Leaves out the places, in order, that lie in a stretch of the list; its stretches are in order too. */
static size_t keep_away(qn_scratch *s, qn_bound *places, size_t count, const qn_stretch *list, size_t n) {
  size_t kept = 0, i = 0;
  for (size_t k = 0; k < n; k++) {
    qn_bound enter = qn_bound_from_place(s, &list[k].enter.place), leave = qn_bound_from_place(s, &list[k].leave.place);
    while (i < count && qn_bound_cmp(s, &places[i], &enter) < 0) {
      places[kept++] = places[i++];
    }
    while (i < count && qn_bound_cmp(s, &places[i], &leave) <= 0) {
      i++;
    }
  }
  while (i < count) {
    places[kept++] = places[i++];
  }
  return kept;
}

/* Touches and ends of the range, in order, each once, but those in stretches. 0: a failure. */
static int find_places(sweep *w, const qn_bound *from, const qn_bound *to) {
  qn_scratch *s = w->s;
  size_t n = s->touch_count + s->event_count, count = 0;
  qn_event *found = qn_arena_take(&s->ctx.arena, (n + 1) * sizeof *found);
  w->places = qn_arena_take(&s->ctx.arena, (n + 1) * sizeof *w->places);
  if (!found || !w->places || n >= UINT32_MAX) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return 0;
  }
  for (size_t i = 0; i < n; i++) {
    qn_bound b = i < s->touch_count ? s->touches[i] : s->events[i - s->touch_count].at;
    if (b.solved != QN_NO_SOLVED && qn_bound_cmp(s, &b, from) >= 0 && qn_bound_cmp(s, to, &b) >= 0) {
      found[count++] = (qn_event){.at = b};
    }
  }
  qn_order_places(s, found, count);
  for (size_t i = 0; i < count && qn_scratch_status(s) == QUOIN_OK; i++) {
    if (w->count == 0 || qn_bound_cmp(s, &w->places[w->count - 1], &found[i].at) != 0) {
      w->places[w->count++] = found[i].at;
    }
  }
  w->count = keep_away(s, w->places, w->count, s->inside, s->inside_count);
  w->count = keep_away(s, w->places, w->count, s->boundary, s->boundary_count);
  return qn_scratch_status(s) == QUOIN_OK;
}

/* The first place that is not before the bound, or, if `beyond`, that is after it. */
static size_t search(const sweep *w, const qn_bound *b, int beyond) {
  size_t low = 0, high = w->count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (qn_bound_cmp(w->s, &w->places[middle], b) < beyond) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

static void add_step(sweep *w, size_t place, size_t candidate, int what) {
  qn_scratch *s = w->s;
  if (!qn_grow(s->mem, &w->found, &w->step_capacity, w->step_count + 1)) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return;
  }
  w->found[w->step_count++] = (step){(uint32_t)place, (uint32_t)candidate, (uint8_t)what};
}

/* The steps of one candidate. */
static void find_steps(sweep *w, size_t candidate) {
  qn_scratch *s = w->s;
  const qn_span *spans;
  int vague;
  s->touch_count = 0;
  size_t n = qn_leaf_spans(s, s->candidates[candidate], 1, &spans, &vague);
  s->counts.leaves--; /* it was counted when the line was woven */
  for (size_t i = 0; i < n; i++) {
    size_t begin = search(w, &spans[i].lo, 0), end = search(w, &spans[i].hi, 1);
    if (!vague && begin < end && qn_bound_cmp(s, &w->places[begin], &spans[i].lo) == 0) {
      add_step(w, begin++, candidate, MEETS);
    }
    if (!vague && begin < end && qn_bound_cmp(s, &w->places[end - 1], &spans[i].hi) == 0) {
      add_step(w, --end, candidate, MEETS);
    }
    if (begin < end) {
      add_step(w, begin, candidate, vague ? BEGINS_IN_SURFACE : BEGINS);
      add_step(w, end, candidate, vague ? ENDS_IN_SURFACE : ENDS);
    }
  }
  for (size_t i = 0; i < s->touch_count; i++) {
    size_t at = search(w, &s->touches[i], 0);
    if (at < w->count && qn_bound_cmp(s, &w->places[at], &s->touches[i]) == 0) {
      add_step(w, at, candidate, MEETS);
    }
  }
}

/* By place, else in the order in which they were found. 0: memory. */
static int order_steps(sweep *w) {
  w->steps = qn_arena_take(&w->s->ctx.arena, (w->step_count + 1) * sizeof *w->steps);
  if (!w->steps) {
    qn_scratch_fail(w->s, QUOIN_E_MEMORY);
    return 0;
  }
  for (size_t i = 0; i < w->step_count; i++) { /* those at w->count have no place: nobody asks for them */
    w->first[w->found[i].place + 1]++;
  }
  for (size_t p = 0; p <= w->count; p++) {
    w->first[p + 1] += w->first[p];
  }
  for (size_t i = 0; i < w->step_count; i++) {
    w->steps[w->first[w->found[i].place]++] = w->found[i];
  }
  for (size_t p = w->count + 1; p > 0; p--) { /* each had come to where the next begins */
    w->first[p] = w->first[p - 1];
  }
  w->first[0] = 0;
  return 1;
}

/* --- in order ------------------------------------------------------------------------------------------------------------ */

static void take_place(sweep *w, uint32_t place) {
  const step *steps = w->steps + w->first[place];
  size_t n = w->first[place + 1] - w->first[place];
  w->near.count = w->near.half_count = 0;
  for (size_t i = 0; i < n; i++) {
    uint32_t c = steps[i].candidate;
    if (steps[i].what == BEGINS || steps[i].what == ENDS) {
      hold(w, c, steps[i].what == BEGINS);
    } else if (steps[i].what == BEGINS_IN_SURFACE) {
      w->at[c] = (uint32_t)w->in_surface_count;
      w->in_surface[w->in_surface_count++] = c;
    } else if (steps[i].what == ENDS_IN_SURFACE) {
      uint32_t last = w->in_surface[--w->in_surface_count];
      w->in_surface[w->at[c]] = last;
      w->at[last] = w->at[c];
    }
  }
  int good = 1;
  for (size_t i = 0; i < n && good; i++) {
    good = steps[i].what != MEETS || add_near(w, steps[i].candidate, place);
  }
  for (size_t i = 0; i < w->in_surface_count && good; i++) {
    good = add_near(w, w->in_surface[i], place);
  }
  if (good) {
    classify(w, &w->places[place]);
  }
  for (size_t i = 0; i < n; i++) {
    if (w->inside[steps[i].candidate] == 2) {
      hold(w, steps[i].candidate, 1);
    }
  }
}

void qn_weave_contacts(qn_scratch *s, const qn_bound *from, const qn_bound *to) {
  sweep w = {.s = s};
  size_t n = s->candidate_count;
  if (!find_places(&w, from, to) || w.count == 0) {
    return;
  }
  w.first = qn_arena_take(&s->ctx.arena, (w.count + 2) * sizeof *w.first);
  w.inside = qn_arena_take(&s->ctx.arena, n + 1);
  w.seen = qn_arena_take(&s->ctx.arena, (n + 1) * sizeof *w.seen);
  w.in_surface = qn_arena_take(&s->ctx.arena, (n + 1) * sizeof *w.in_surface);
  w.at = qn_arena_take(&s->ctx.arena, (n + 1) * sizeof *w.at);
  if (!w.first || !w.inside || !w.seen || !w.in_surface || !w.at) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return;
  }
  memset(w.first, 0, (w.count + 2) * sizeof *w.first);
  memset(w.inside, 0, n + 1);
  memset(w.seen, 0, (n + 1) * sizeof *w.seen);
  for (size_t i = 0; i < n && qn_scratch_status(s) == QUOIN_OK; i++) {
    find_steps(&w, i);
  }
  if (qn_scratch_status(s) == QUOIN_OK && order_steps(&w)) {
    for (uint32_t i = 0; i < w.count && qn_scratch_status(s) == QUOIN_OK; i++) {
      take_place(&w, i);
    }
  }
  qn_eval_reset(&s->eval);
  qn_free(s->mem, w.found, w.step_capacity * sizeof *w.found);
  qn_free(s->mem, w.near.leaves, w.near.capacity * sizeof *w.near.leaves);
  qn_free(s->mem, w.near.halves, w.near.half_capacity * sizeof *w.near.halves);
}
