/* Stretches of a line that runs in surfaces (S7).

   Between two events, or turns (turn.c), nothing changes along the line, so one point of a stretch stands for it. What the solid is next to it, with the
   surfaces in which the line runs as unknown sides, is the question of S6: inside if all realisable combinations of sides (cells) say
   so, outside likewise, else the stretch lies in the boundary.

   Mostly the cells are the same all along the line. Then the line is woven once in each cell, those surfaces taken at its signs, and what
   the weaves say at an event is what S6 says after it: however many leaves share a face, each costs a few steps of the program. Why they are the same:
   - planes: which they are does not depend on the place. Two have all four combinations, more are a fan about the line (around_fan.c);
   - one quadric: it has both signs next to every place, but where its form is semidefinite everywhere. For its gradient on the line is linear in t:
     it is zero at one place at most, where both signs come near, or everywhere, and then the surface does not change along the line;
   - two surfaces whose gradients are parallel at single places only: all four combinations elsewhere, and so there too, where others might be
     added that no stretch of the line has;
   - two that do not change along the line (cylinders that touch along it: H d = 0, so q(x + t d) = q(x)).
   Else cells are listed at a rational point of each stretch on which a leaf with such a surface is undecided. */
#include "base/limits.h"
#include "ray/around_cells.h"
#include "ray/scratch.h"

#include <math.h>
#include <string.h>

/* --- in one cell after another --------------------------------------------------------------------------------------- */

/* A half-space in whose surface the line runs: its q is `side` times the form of the surface with this number here. */
typedef struct literal { uint32_t surface; int8_t side; } literal;

/* Events, and what the solid is after each, in the cells that were given. */
typedef struct weaving {
  qn_scratch *s;
  const qn_event *events;
  size_t count;
  size_t *first;      /* by event, and one more: of its leaf's literals */
  literal *literals;
  uint32_t *surfaces; /* of the scene: those in which the line runs */
  size_t n;
  uint8_t *seen;      /* by event: 1: after it the solid is away in some cell, 2: there in some, 4: that is one for all cells */
} weaving;

static int make_weaving(weaving *w, qn_scratch *s, const qn_event *events, size_t count) {
  qn_arena *arena = &s->ctx.arena;
  size_t halves = 0;
  for (size_t i = 0; i < count; i++) {
    halves += events[i].vague ? s->scene->leaves[events[i].leaf].halves : 0;
  }
  *w = (weaving){.s = s, .events = events, .count = count};
  (void)qn_scratch_spend(s, count + s->solved_count / 16, QN_EFFORT_CHANGE);
  w->first = qn_arena_take(arena, (count + 1) * sizeof *w->first);
  w->literals = qn_arena_take(arena, (halves + 1) * sizeof *w->literals);
  w->surfaces = qn_arena_take(arena, (s->solved_count + 1) * sizeof *w->surfaces);
  w->seen = qn_arena_take(arena, count + 1);
  uint32_t *number = qn_arena_take(arena, (s->solved_count + 1) * sizeof *number); /* by solved surface, and one more */
  if (!w->first || !w->literals || !w->surfaces || !w->seen || !number) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return 0;
  }
  memset(w->seen, 0, count + 1);
  memset(number, 0, (s->solved_count + 1) * sizeof *number);
  halves = 0;
  size_t vague = 0;
  for (size_t i = 0; i < count; i++) {
    vague += events[i].enter ? (size_t)events[i].vague : (size_t)0 - events[i].vague;
    w->seen[i] = vague == 0 ? 4 : 0;
    const qn_leaf *leaf = &s->scene->leaves[events[i].leaf];
    w->first[i] = halves;
    for (uint32_t h = leaf->half0; events[i].vague && h < leaf->half0 + leaf->halves; h++) {
      const qn_half *half = &s->scene->halves[h];
      uint32_t solved = s->memo[half->surface].solved;
      if (s->solved[solved].sign != 0) {
        continue;
      }
      if (number[solved] == 0) {
        w->surfaces[w->n++] = half->surface;
        number[solved] = (uint32_t)w->n;
      }
      w->literals[halves++] = (literal){number[solved] - 1, half->side};
    }
  }
  w->first[count] = halves;
  return 1;
}

static int weave_in_cell(void *user, const int8_t *signs) {
  weaving *w = user;
  qn_eval *eval = &w->s->eval;
  if (!qn_scratch_spend(w->s, w->count, QN_EFFORT_CHANGE)) {
    return 1;
  }
  const qn_leaf *leaves = w->s->scene->leaves;
  unsigned open = 0; /* after some event, not all that may be was seen */
  for (size_t i = 0; i < w->count; i++) {
    const qn_event *e = &w->events[i];
    int holds = 1;
    for (size_t k = w->first[i]; k < w->first[i + 1] && holds; k++) {
      /* cppcheck-suppress nullPointer ; there are signs for the surfaces that literals name */
      holds = w->literals[k].side * signs[w->literals[k].surface] < 0;
    }
    if (holds) {
      (void)qn_eval_change(eval, leaves[e->leaf].gate, e->enter != leaves[e->leaf].negated ? 1 : -1);
    }
    w->seen[i] |= eval->value ? 2u : 1u;
    open |= w->seen[i] < 3;
  }
  qn_eval_reset(eval);
  return !open;
}

static quoin_side side_seen(unsigned seen) {
  seen &= 3;
  return seen == 3 ? QUOIN_BOUNDARY : seen == 2 ? QUOIN_INSIDE : QUOIN_OUTSIDE;
}

/* --- cells that are the same all along the line ---------------------------------------------------------------------- */

/* The germs of the surfaces at the point t of the line; 0: memory. */
static int germs_at(weaving *w, int t, qn_germ *germs) {
  qn_scratch *s = w->s;
  qn_ctx *ctx = &s->ctx;
  qn_line_make_exact(ctx, s->line);
  qn_point point = {.w = s->line->w};
  for (int j = 0; j < 3; j++) {
    point.x[j] = qn_int_add(ctx, s->line->origin[j], qn_int_mul(ctx, s->line->direction[j], qn_int_from(ctx, t)));
  }
  for (size_t i = 0; i < w->n; i++) {
    int made = 0;
    const qn_exact_surface *form = qn_scene_exact(s->scene, w->surfaces[i], &made);
    s->counts.exact_forms += (uint64_t)made;
    if (!form) {
      qn_scratch_fail(s, qn_scene_no_exact(s->scene, w->surfaces[i]));
      return 0;
    }
    qn_surface_germ_at(ctx, form, &point, &germs[i]);
  }
  return ctx->failed == QUOIN_OK;
}

/* Whether a surface that holds the line is the same all along it. */
static int unchanged(qn_scratch *s, const qn_germ *germ) {
  qn_xint image[3];
  qn_form_apply(&s->ctx, germ->h, s->line->direction, image);
  return qn_x_sign(image[0]) == 0 && qn_x_sign(image[1]) == 0 && qn_x_sign(image[2]) == 0;
}

static void weave_in_all(weaving *w) {
  for (int k = 0; k < 1 << w->n; k++) {
    const int8_t signs[2] = {(int8_t)(k & 1 ? 1 : -1), (int8_t)(k & 2 ? 1 : -1)};
    if (weave_in_cell(w, signs)) {
      return;
    }
  }
}

/* Weaves in each cell of the line. 0: its cells are not known to be the same everywhere, or a failure. */
static int weave_in_cells(weaving *w) {
  qn_scratch *s = w->s;
  int planes = 1;
  for (size_t i = 0; i < w->n; i++) {
    planes &= s->scene->surfaces[w->surfaces[i]].kind == QN_PLANE;
  }
  if (planes && w->n <= 2) { /* no need of their forms */
    weave_in_all(w);
    return 1;
  }
  if (!planes && w->n > 2) {
    return 0;
  }
  qn_germ *germs = qn_arena_take(&s->ctx.arena, w->n * sizeof *germs);
  if (!germs) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return 0;
  }
  if (w->n == 2) {
    for (int t = -1; t <= 1; t++) { /* the gradients' cross product is quadratic in t: not zero at all three, or zero everywhere */
      if (!germs_at(w, t, germs)) {
        return 0;
      }
      if (!qn_parallel_x(&s->ctx, germs[0].g, germs[1].g)) {
        weave_in_all(w);
        return 1;
      }
    }
    if (!unchanged(s, &germs[0]) || !unchanged(s, &germs[1])) {
      return 0;
    }
  }
  if (!germs_at(w, 0, germs)) {
    return 0;
  }
  int listed = planes ? qn_cells_fan(&s->ctx, w->n, germs, s->line->direction, weave_in_cell, w) : qn_cells_list(&s->ctx, w->n, germs, s->line->direction, weave_in_cell, w);
  return listed && s->ctx.failed == QUOIN_OK;
}

/* --- cells that are asked for at each stretch ------------------------------------------------------------------------ */

typedef struct active { uint32_t leaf; uint8_t vague; } active;

typedef struct state {
  active *leaves;
  size_t count, vague;
  qn_near_leaf *near;
  uint32_t *halves;
  size_t half_capacity;
} state;

static void toggle(qn_scratch *s, state *st, const qn_event *e, int enter) {
  const qn_leaf *leaf = &s->scene->leaves[e->leaf];
  if (enter) {
    st->leaves[st->count++] = (active){e->leaf, e->vague};
    st->vague += e->vague;
  } else {
    size_t k = 0;
    while (k < st->count && st->leaves[k].leaf != e->leaf) {
      k++;
    }
    if (k < st->count) {
      st->leaves[k] = st->leaves[--st->count];
      st->vague -= e->vague;
    }
  }
  if (!e->vague) {
    (void)qn_eval_change(&s->weave, leaf->gate, enter != leaf->negated ? 1 : -1);
  }
}

static void point_between(qn_scratch *s, const qn_bound *a, const qn_bound *b, qn_point *point) {
  qn_int num, den;
  qn_bound_between(s, a, b, &num, &den);
  qn_line_make_exact(&s->ctx, s->line);
  for (int j = 0; j < 3; j++) {
    point->x[j] = qn_int_add(&s->ctx, qn_int_mul(&s->ctx, s->line->origin[j], den), qn_int_mul(&s->ctx, s->line->direction[j], num));
  }
  point->w = qn_int_mul(&s->ctx, s->line->w, den);
}

/* The side at a point between a and b, where the leaves of the state hold. */
static quoin_side side_between(qn_scratch *s, state *st, const qn_bound *a, const qn_bound *b) {
  qn_point point;
  point_between(s, a, b, &point);
  size_t halves = 0;
  (void)qn_scratch_spend(s, st->count, QN_EFFORT_CHANGE);
  for (size_t i = 0; i < st->count; i++) {
    const qn_leaf *leaf = &s->scene->leaves[st->leaves[i].leaf];
    st->near[i] = (qn_near_leaf){st->leaves[i].leaf, (uint32_t)halves, 0};
    for (uint32_t h = leaf->half0; st->leaves[i].vague && h < leaf->half0 + leaf->halves; h++) {
      const qn_solved *v = &s->solved[s->memo[s->scene->halves[h].surface].solved];
      if (v->sign == 0 && halves < st->half_capacity) {
        st->halves[halves++] = h;
        st->near[i].count++;
      }
    }
  }
  quoin_side side = QUOIN_OUTSIDE;
  if (s->status == QUOIN_OK && s->ctx.failed == QUOIN_OK) {
    quoin_status status = qn_around(s->scene, s, &point, st->near, st->count, st->halves, halves, QN_AROUND_LINE, &side);
    if (status != QUOIN_OK) {
      qn_scratch_fail(s, status);
    }
  }
  return side;
}

/* The part of [a, b] within the range: what was not woven outside of it must not be asked. Beside the range, up to its
   end, the leaves of the state are those next to that end; they say whether the solid ends there too. */
static void narrow(qn_scratch *s, const qn_bound **a, const qn_bound **b, const qn_bound *from, const qn_bound *to) {
  const qn_bound *low = qn_bound_cmp(s, *a, from) < 0 ? from : *a, *high = qn_bound_cmp(s, to, *b) < 0 ? to : *b;
  if (qn_bound_cmp(s, low, high) < 0) {
    *a = low, *b = high;
  }
}

static int make_state(qn_scratch *s, state *st) {
  size_t n = s->event_count, halves = 0;
  for (size_t i = 0; i < n; i++) {
    halves += s->events[i].vague && s->events[i].enter ? s->scene->leaves[s->events[i].leaf].halves : 0;
  }
  *st = (state){.half_capacity = halves};
  st->leaves = qn_arena_take(&s->ctx.arena, (n + 1) * sizeof *st->leaves);
  st->near = qn_arena_take(&s->ctx.arena, (n + 1) * sizeof *st->near);
  st->halves = qn_arena_take(&s->ctx.arena, (halves + 1) * sizeof *st->halves);
  if (!st->leaves || !st->near || !st->halves) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return 0;
  }
  return 1;
}

/* Which of the group's n events made the side what it is after the last: woven from the state before the group on, in the cells at one point. */
static size_t last_change(qn_scratch *s, state *st, const qn_event *group, size_t n, const qn_point *point, quoin_side now) {
  qn_mark mark = qn_arena_mark(&s->ctx.arena);
  for (size_t k = n; k-- > 0;) {
    toggle(s, st, &group[k], !group[k].enter);
  }
  size_t last = 0, count = st->count + n;
  qn_event *events = qn_arena_take(&s->ctx.arena, (count + 1) * sizeof *events);
  weaving w;
  if (!events) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return 0;
  }
  for (size_t i = 0; i < st->count; i++) {
    events[i] = (qn_event){.leaf = st->leaves[i].leaf, .enter = 1, .vague = st->leaves[i].vague};
  }
  memcpy(events + st->count, group, n * sizeof *events);
  if (make_weaving(&w, s, events, count)) {
    qn_germ *germs = qn_arena_take(&s->ctx.arena, (w.n + 1) * sizeof *germs);
    for (size_t i = 0; germs && i < w.n; i++) {
      const qn_exact_surface *form = qn_scene_exact(s->scene, w.surfaces[i], NULL);
      if (!form) {
        qn_scratch_fail(s, qn_scene_no_exact(s->scene, w.surfaces[i]));
        germs = NULL;
        break;
      }
      qn_surface_germ_at(&s->ctx, form, point, &germs[i]);
    }
    int listed = 0;
    if (!germs) {
      qn_scratch_fail(s, QUOIN_E_MEMORY);
    } else if (w.n == 0) {
      const int8_t none[1] = {0};
      (void)weave_in_cell(&w, none);
      listed = 1;
    } else {
      listed = qn_cells_list(&s->ctx, w.n, germs, s->line->direction, weave_in_cell, &w);
    }
    last = listed ? n - 1 : 0;
    while (last > 0 && side_seen(w.seen[st->count + last - 1]) == now) {
      last--;
    }
  }
  for (size_t k = 0; k < n; k++) {
    toggle(s, st, &group[k], group[k].enter);
  }
  qn_arena_release(&s->ctx.arena, mark);
  return last;
}

/* --- the line --------------------------------------------------------------------------------------------------------- */

static const qn_event BEGIN = {{-HUGE_VAL, 0, QN_NO_SOLVED, QN_NO_HALF, 0}, QN_NO_LEAF, 1, 0};
static const qn_event END = {{HUGE_VAL, 0, QN_NO_SOLVED, QN_NO_HALF, 0}, QN_NO_LEAF, 0, 0};

/* What the solid is between successive places, as it comes out. */
typedef struct run { qn_event open; quoin_side side; } run;

static void change(qn_scratch *s, run *r, const qn_event *here, quoin_side now, const qn_bound *from, const qn_bound *to) {
  if (r->side != QUOIN_OUTSIDE) {
    qn_weave_add(s, r->side == QUOIN_BOUNDARY, &r->open, here, from, to);
  }
  r->open = *here;
  r->side = now;
}

/* Each end is named after the leaf at whose change the side last changed within its group, as where the line runs in no surface. */
static void take_seen(qn_scratch *s, const weaving *w, const size_t *ends, run *r, const qn_bound *from, const qn_bound *to) {
  for (size_t i = 0, end; i < w->count; i = end) {
    end = ends[i];
    quoin_side now = side_seen(w->seen[end - 1]);
    if (now != r->side) {
      size_t last = end - 1;
      while (last > i && side_seen(w->seen[last - 1]) == now) {
        last--;
      }
      change(s, r, &s->events[last], now, from, to);
    }
  }
}

/* The side of the state between a and b. */
static quoin_side side_of(qn_scratch *s, state *st, const qn_bound **a, const qn_bound **b, const qn_bound *from, const qn_bound *to) {
  narrow(s, a, b, from, to);
  return st->vague != 0 ? side_between(s, st, *a, *b) : s->weave.value ? QUOIN_INSIDE : QUOIN_OUTSIDE;
}

/* The turns that are left, and where a stretch from a place on ends: at the next of them, or at next. */
typedef struct ahead { qn_event *turns; size_t count, at; } ahead;

static const qn_bound *stop_after(qn_scratch *s, ahead *h, const qn_bound *place, const qn_bound *next) {
  while (h->at < h->count && qn_bound_cmp(s, &h->turns[h->at].at, place) <= 0) {
    h->at++;
  }
  return h->at < h->count && qn_bound_cmp(s, &h->turns[h->at].at, next) < 0 ? &h->turns[h->at].at : next;
}

static void take_stretches(qn_scratch *s, const size_t *ends, run *r, const qn_bound *from, const qn_bound *to) {
  state st;
  ahead turns = {0};
  if (!make_state(s, &st)) {
    return;
  }
  if (!qn_find_turns(s, &turns.turns, &turns.count)) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return;
  }
  for (size_t i = 0, end; i < s->event_count && qn_scratch_status(s) == QUOIN_OK; i = end) {
    end = ends[i];
    for (size_t k = i; k < end; k++) {
      toggle(s, &st, &s->events[k], s->events[k].enter);
    }
    const qn_bound *next = end < s->event_count ? &s->events[end].at : &END.at, *stop = stop_after(s, &turns, &s->events[i].at, next);
    const qn_bound *a = &s->events[i].at, *b = stop;
    quoin_side now = side_of(s, &st, &a, &b, from, to);
    if (now != r->side) {
      qn_point point;
      point_between(s, a, b, &point);
      change(s, r, &s->events[i + last_change(s, &st, &s->events[i], end - i, &point, now)], now, from, to);
    }
    while (stop != next && qn_scratch_status(s) == QUOIN_OK) {
      const qn_event here = {*stop, turns.turns[turns.at].leaf, 0, 0};
      stop = stop_after(s, &turns, &here.at, next);
      a = &here.at, b = stop;
      now = side_of(s, &st, &a, &b, from, to);
      if (now != r->side) {
        change(s, r, &here, now, from, to);
      }
    }
  }
  qn_eval_reset(&s->weave);
}

void qn_weave_coplanar(qn_scratch *s, const qn_bound *from, const qn_bound *to) {
  run r = {BEGIN, s->weave.value ? QUOIN_INSIDE : QUOIN_OUTSIDE};
  weaving w;
  size_t *ends = qn_arena_take(&s->ctx.arena, (s->event_count + 1) * sizeof *ends); /* by a group's first event */
  if (!ends) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return;
  }
  for (size_t i = 0; i < s->event_count; i = ends[i]) {
    ends[i] = qn_weave_group(s, i);
  }
  if (!make_weaving(&w, s, s->events, s->event_count)) {
    return;
  }
  int fixed = weave_in_cells(&w);
  if (qn_scratch_status(s) != QUOIN_OK) {
    return;
  }
  if (fixed) {
    take_seen(s, &w, ends, &r, from, to);
  } else {
    take_stretches(s, ends, &r, from, to);
  }
  if (r.side != QUOIN_OUTSIDE) {
    qn_weave_add(s, r.side == QUOIN_BOUNDARY, &r.open, &END, from, to);
  }
}
