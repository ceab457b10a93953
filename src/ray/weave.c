/* The weave: ends of the leaves' stretches in exact order, and the program walked through them.

   Ends at one place are one event: the program's value before and after the whole group counts, never one in between, so
   a face shared by two solids is no wall of their union and leaves no film in their difference (S5). Within a group the
   changes are made in the order of the leaves, and the end belongs to the leaf at whose change the value last changed.
   Between two groups lies a stretch of positive length.

   Stretches that end before the range or begin after it are not woven; one that has begun by its beginning begins at -inf. */
#include "base/limits.h"
#include "ray/scratch.h"

#include <math.h>
#include <string.h>

static const qn_bound BEGIN = {-HUGE_VAL, 0, QN_NO_SOLVED, QN_NO_HALF, 0};
static const qn_bound END = {HUGE_VAL, 0, QN_NO_SOLVED, QN_NO_HALF, 0};

static void visit(void *user, uint32_t leaf) {
  qn_scratch *s = user;
  if (!qn_grow(s->mem, &s->candidates, &s->candidate_capacity, s->candidate_count + 1)) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return;
  }
  s->candidates[s->candidate_count++] = leaf;
}

/* Whether the doubles of the line do for a walk over boxes: finite, and near to the truth, relatively. */
static int walkable(const qn_line *line) {
  for (int j = 0; j < 3; j++) {
    if (!isfinite(line->o[j]) || !isfinite(line->d[j])) {
      return 0;
    }
    if (line->rounded && fabs(line->d[j]) < 0x1p-1000 && qn_int_sign(line->direction[j]) != 0) {
      return 0; /* it may have lost bits below the least normal double */
    }
  }
  return 1;
}

static void find_candidates(qn_scratch *s, const qn_line *line, const qn_bound *from, const qn_bound *to) {
  const quoin_scene *scene = s->scene;
  s->candidate_count = 0;
  if (walkable(line)) {
    qn_bvh_line(&scene->bvh, line->o, line->d, from->t - from->e, to->t + to->e, visit, s, &s->counts.nodes);
  } else {
    for (size_t i = 0; i < scene->bvh.item_count; i++) {
      visit(s, scene->bvh.items[i]);
    }
  }
  for (size_t i = 0; i < scene->unbounded_count; i++) {
    visit(s, scene->unbounded[i]);
  }
  qn_order_candidates(s);
}

static void add_event(qn_scratch *s, qn_bound at, uint32_t leaf, int enter, int vague) {
  if (!qn_grow(s->mem, &s->events, &s->event_capacity, s->event_count + 1)) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return;
  }
  s->events[s->event_count++] = (qn_event){at, leaf, (uint8_t)enter, (uint8_t)vague};
}

/* Solves the candidates. Returns whether the line runs in a surface of one that it meets. */
static int find_events(qn_scratch *s, const qn_bound *from, const qn_bound *to, int touches) {
  int any_vague = 0;
  s->event_count = s->touch_count = 0;
  for (size_t i = 0; i < s->candidate_count && s->status == QUOIN_OK; i++) {
    uint32_t leaf = s->candidates[i];
    if (s->scene->leaves[leaf].gate == QN_NO_GATE) {
      continue; /* it has no part in the answer */
    }
    const qn_span *spans;
    int vague;
    size_t n = qn_leaf_spans(s, leaf, touches, &spans, &vague);
    for (size_t k = 0; k < n; k++) {
      qn_span m = spans[k];
      if (qn_bound_cmp(s, &m.hi, from) < 0 || qn_bound_cmp(s, to, &m.lo) < 0) {
        continue;
      }
      if (m.lo.solved != QN_NO_SOLVED && qn_bound_cmp(s, &m.lo, from) < 0) {
        m.lo = BEGIN;
      }
      any_vague |= vague;
      add_event(s, m.lo, leaf, 1, vague);
      if (m.hi.solved != QN_NO_SOLVED && qn_bound_cmp(s, &m.hi, to) <= 0) {
        add_event(s, m.hi, leaf, 0, vague);
      }
    }
  }
  qn_order_events(s);
  return any_vague;
}

/* Where rounded places tie: the end of what ties with one of [at, end), itself or by others. In the order of the stored numbers that is one run; what ties need not be neighbours in it. */
static size_t all_ties(qn_scratch *s, size_t at, size_t end) {
  for (size_t next = end; next < s->event_count && qn_scratch_spend(s, next - at, QN_EFFORT_CHANGE); next++) {
    const qn_bound *b = &s->events[next].at, *last = &s->events[end - 1].at;
    if (!(b->t - last->t <= b->e + last->e + 0x1p-40 * fabs(last->t))) {
      break; /* nothing from here on is near */
    }
    size_t i = at;
    while (i < end && qn_bound_cmp(s, &s->events[i].at, b) != 0) {
      i++;
    }
    end = i < end ? next + 1 : end;
  }
  return end;
}

size_t qn_weave_group(qn_scratch *s, size_t at) {
  size_t end = at + 1;
  while (end < s->event_count && qn_bound_cmp(s, &s->events[end - 1].at, &s->events[end].at) == 0) {
    end++;
  }
  end = s->rounded_ties ? all_ties(s, at, end) : end;
  if (end - at > 1) {
    qn_order_group(s, s->events + at, end - at);
  }
  return end;
}

static qn_stop stop_at(const qn_scratch *s, const qn_event *e, const qn_bound *cut) {
  if (cut) {
    return (qn_stop){qn_bound_place(s, cut), QN_NO_LEAF, QN_NO_HALF};
  }
  int infinite = e->at.solved == QN_NO_SOLVED;
  return (qn_stop){qn_bound_place(s, &e->at), infinite ? QN_NO_LEAF : e->leaf, infinite ? QN_NO_HALF : e->at.half};
}

void qn_weave_add(qn_scratch *s, int boundary, const qn_event *enter, const qn_event *leave, const qn_bound *from, const qn_bound *to) {
  if (qn_bound_cmp(s, &enter->at, &leave->at) >= 0) {
    return; /* both at one infinity */
  }
  int cut_begin = qn_bound_cmp(s, &enter->at, from) < 0, cut_end = qn_bound_cmp(s, to, &leave->at) < 0;
  if ((cut_begin || cut_end) && qn_bound_cmp(s, cut_begin ? from : &enter->at, cut_end ? to : &leave->at) >= 0) {
    return;
  }
  qn_stretch **list = boundary ? &s->boundary : &s->inside;
  size_t *count = boundary ? &s->boundary_count : &s->inside_count;
  if (!qn_grow(s->mem, list, boundary ? &s->boundary_capacity : &s->inside_capacity, *count + 1)) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return;
  }
  (*list)[(*count)++] = (qn_stretch){stop_at(s, enter, cut_begin ? from : NULL), stop_at(s, leave, cut_end ? to : NULL)};
}

static void walk(qn_scratch *s, const qn_bound *from, const qn_bound *to, int first_only) {
  const qn_leaf *leaves = s->scene->leaves;
  qn_eval *eval = &s->weave;
  qn_event open = {BEGIN, QN_NO_LEAF, 1, 0}, close = {END, QN_NO_LEAF, 0, 0};
  for (size_t i = 0, end; i < s->event_count; i = end) {
    end = qn_weave_group(s, i);
    int was = eval->value;
    size_t last = i;
    for (size_t k = i; k < end; k++) {
      const qn_event *e = &s->events[k];
      int value = eval->value;
      if (qn_eval_change(eval, leaves[e->leaf].gate, e->enter != leaves[e->leaf].negated ? 1 : -1) != value) {
        last = k;
      }
    }
    if (eval->value == was) {
      continue;
    }
    if (eval->value) {
      open = s->events[last];
    } else {
      qn_weave_add(s, 0, &open, &s->events[last], from, to);
      if (first_only && s->inside_count) {
        break;
      }
    }
  }
  if (eval->value && !(first_only && s->inside_count)) {
    qn_weave_add(s, 0, &open, &close, from, to);
  }
  qn_eval_reset(eval);
}

static void weave(qn_scratch *s, const qn_bound *from, const qn_bound *to, int vague, unsigned want) {
  s->inside_count = s->boundary_count = 0;
  if (vague) {
    qn_weave_coplanar(s, from, to);
  } else {
    walk(s, from, to, (want & QN_WANT_FIRST) != 0);
  }
}

quoin_status qn_weave(const quoin_scene *scene, qn_scratch *s, qn_line *line, const qn_range *range, unsigned want, qn_woven *out) {
  (void)scene;
  s->counts.rays++;
  qn_solve_begin(s, line);
  qn_bound from = range ? qn_bound_from_place(s, &range->from) : BEGIN, to = range ? qn_bound_from_place(s, &range->to) : END;
  s->contact_count = 0;
  if (want & QUOIN_WANT_CONTACTS) { /* what is beside a place counts, be it out of the range: weave the whole line first */
    find_candidates(s, line, &BEGIN, &END);
    int vague = find_events(s, &BEGIN, &END, 1);
    weave(s, &BEGIN, &END, vague, 0);
    qn_weave_contacts(s, &from, &to);
    weave(s, &from, &to, vague, 0);
  } else {
    find_candidates(s, line, &from, &to);
    int vague = find_events(s, &from, &to, 0);
    weave(s, &from, &to, vague, want);
  }
  *out = (qn_woven){s->inside, s->inside_count, s->boundary, want & QUOIN_WANT_BOUNDARY ? s->boundary_count : 0, s->contacts, s->contact_count};
  return qn_scratch_status(s);
}
