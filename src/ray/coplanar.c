/* Stretches of a line that runs in surfaces (S7).

   Between two events nothing changes along the line, so one point of a stretch stands for it; a rational one is taken. What
   the solid is next to it, with the surfaces in which the line runs as unknown sides, is the question of S6: inside if
   all realisable sides say so, outside likewise, else the stretch lies in the boundary. Only stretches on which a leaf with
   such a surface is undecided are asked about; on the others the program decides as ever. */
#include "ray/around.h"
#include "ray/scratch.h"

#include <math.h>

typedef struct active { uint32_t leaf; uint8_t vague; } active;

typedef struct state {
  active *leaves;
  size_t count, vague;
  qn_near_leaf *near;
  uint32_t *halves;
  size_t half_capacity;
} state;

static void toggle(qn_scratch *s, state *st, const qn_event *e) {
  const qn_leaf *leaf = &s->scene->leaves[e->leaf];
  if (e->enter) {
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
    (void)qn_eval_change(&s->weave, leaf->gate, e->enter != leaf->negated ? 1 : -1);
  }
}

/* The side at a point between a and b, where the leaves of the state hold. */
static quoin_side side_between(qn_scratch *s, state *st, const qn_bound *a, const qn_bound *b) {
  qn_int num, den;
  qn_bound_between(s, a, b, &num, &den);
  qn_line_make_exact(&s->ctx, s->line);
  qn_point point;
  for (int j = 0; j < 3; j++) {
    point.x[j] = qn_int_add(&s->ctx, qn_int_mul(&s->ctx, s->line->origin[j], den), qn_int_mul(&s->ctx, s->line->direction[j], num));
  }
  point.w = qn_int_mul(&s->ctx, s->line->w, den);
  size_t halves = 0;
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
    quoin_status status = qn_around(s->scene, s, &point, st->near, st->count, st->halves, halves, &side);
    if (status != QUOIN_OK) {
      qn_scratch_fail(s, status);
    }
  }
  return side;
}

/* The side between two successive places, within the range: what was not woven outside of it must not be asked. Beside the range, up to its
   end, the leaves of the state are those next to that end; they say whether the solid ends there too. */
static quoin_side side_of(qn_scratch *s, state *st, const qn_bound *a, const qn_bound *b, const qn_bound *from, const qn_bound *to) {
  if (st->vague == 0) {
    return s->weave.value ? QUOIN_INSIDE : QUOIN_OUTSIDE;
  }
  const qn_bound *low = qn_bound_cmp(s, a, from) < 0 ? from : a, *high = qn_bound_cmp(s, to, b) < 0 ? to : b;
  return qn_bound_cmp(s, low, high) < 0 ? side_between(s, st, low, high) : side_between(s, st, a, b);
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
  return st->leaves && st->near && st->halves;
}

void qn_weave_coplanar(qn_scratch *s, const qn_bound *from, const qn_bound *to) {
  const qn_event begin = {{-HUGE_VAL, 0, QN_NO_SOLVED, QN_NO_HALF, 0}, QN_NO_LEAF, 1, 0};
  const qn_event end_of_line = {{HUGE_VAL, 0, QN_NO_SOLVED, QN_NO_HALF, 0}, QN_NO_LEAF, 0, 0};
  state st;
  if (!make_state(s, &st)) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return;
  }
  qn_event open = begin;
  quoin_side side = s->weave.value ? QUOIN_INSIDE : QUOIN_OUTSIDE;
  for (size_t i = 0, end; i < s->event_count && qn_scratch_status(s) == QUOIN_OK; i = end) {
    end = qn_weave_group(s, i);
    /* The group's changes are made one by one, so that the end is named after the leaf at whose change the side last changed, as
       where the line runs in no surface. The next place: its group is put in order when its turn comes. */
    const qn_bound *next = end < s->event_count ? &s->events[end].at : &end_of_line.at;
    const qn_event *here = &s->events[i];
    quoin_side now = side;
    for (size_t k = i; k < end; k++) {
      toggle(s, &st, &s->events[k]);
      quoin_side then = side_of(s, &st, &s->events[i].at, next, from, to);
      here = then != now ? &s->events[k] : here;
      now = then;
    }
    if (now == side) {
      continue;
    }
    if (side != QUOIN_OUTSIDE) {
      qn_weave_add(s, side == QUOIN_BOUNDARY, &open, here, from, to);
    }
    open = *here;
    side = now;
  }
  if (side != QUOIN_OUTSIDE) {
    qn_weave_add(s, side == QUOIN_BOUNDARY, &open, &end_of_line, from, to);
  }
  qn_eval_reset(&s->weave);
}
