/* The stretches of one leaf: the meet of its half-spaces' stretches along the line.

   A half-space q <= 0 holds where its sign is negative: from the beginning or from the first root, and by turns from there
   on. Stretches are closed; two that only touch meet in a place, not in a stretch, and are dropped (S5). A half-space
   in whose surface the line runs is taken as satisfied here and settled later (S7). Where two half-spaces make one end
   at one place the earlier one is named. */
#include "ray/scratch.h"

#include <math.h>

static const qn_bound BEGIN = {-HUGE_VAL, 0, QN_NO_SOLVED, QN_NO_HALF, 0};
static const qn_bound END = {HUGE_VAL, 0, QN_NO_SOLVED, QN_NO_HALF, 0};

static qn_bound root_bound(const qn_scratch *s, const qn_solved *v, uint32_t solved, uint32_t half, uint32_t which) {
  qn_root_at at = s->roots[v->root0 + which];
  return (qn_bound){at.t, at.e, solved, half, which};
}

static void add_touch(qn_scratch *s, qn_bound b) {
  if (!qn_grow(s->mem, &s->touches, &s->touch_capacity, s->touch_count + 1)) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return;
  }
  s->touches[s->touch_count++] = b;
}

/* The meet of n stretches with one; into out, returns how many. */
static size_t meet_one(qn_scratch *s, const qn_span *in, size_t n, qn_bound lo, qn_bound hi, int touches, qn_span *out) {
  size_t kept = 0;
  for (size_t i = 0; i < n; i++) {
    qn_span m = in[i];
    if (lo.solved != QN_NO_SOLVED && qn_bound_cmp(s, &m.lo, &lo) < 0) {
      m.lo = lo;
    }
    if (hi.solved != QN_NO_SOLVED && qn_bound_cmp(s, &hi, &m.hi) < 0) {
      m.hi = hi;
    }
    int order = qn_bound_cmp(s, &m.lo, &m.hi);
    if (order < 0) {
      out[kept++] = m;
    } else if (order == 0 && touches) {
      add_touch(s, m.lo);
    }
  }
  return kept;
}

/* Room for two buffers of `want` stretches, the first of which keeps its `n`. */
static int room(qn_scratch *s, size_t want, size_t n, size_t *each, qn_span **now) {
  if (want <= *each) {
    return 1;
  }
  size_t offset = (size_t)(*now - s->spans), grown = 2 * want;
  if (!qn_grow(s->mem, &s->spans, &s->span_capacity, 2 * grown)) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return 0;
  }
  for (size_t i = 0; i < n; i++) { /* offset is 0 or *each: moving down is safe in this order */
    s->spans[i] = s->spans[offset + i];
  }
  *each = s->span_capacity / 2;
  *now = s->spans;
  return 1;
}

size_t qn_leaf_spans(qn_scratch *s, uint32_t leaf_number, int touches, const qn_span **spans, int *vague) {
  const qn_leaf *leaf = &s->scene->leaves[leaf_number];
  qn_filter_leaf frame;
  qn_filter_leaf_begin(&s->filter, leaf->pivot, &frame);
  size_t each = s->span_capacity / 2, n = 0;
  qn_span *now = s->spans;
  *vague = 0;
  *spans = NULL;
  s->counts.leaves++;
  if (!room(s, 4, 0, &each, &now)) {
    return 0;
  }
  now[n++] = (qn_span){BEGIN, END};
  for (uint32_t half = leaf->half0; half < leaf->half0 + leaf->halves; half++) {
    uint32_t at = qn_solve_half(s, leaf, &frame, half);
    if (at == QN_NO_SOLVED) {
      return 0;
    }
    qn_solved v = s->solved[at];
    int sense = s->scene->halves[half].side * v.sign; /* of q before the first root */
    if (v.touches && touches) {
      add_touch(s, root_bound(s, &v, at, half, 0));
    }
    if (v.roots == 0) {
      *vague |= sense == 0;
      if (sense > 0) {
        return 0;
      }
      continue;
    }
    size_t pieces = v.roots / 2 + 1;
    if (!room(s, n + pieces, n, &each, &now)) {
      return 0;
    }
    qn_span *out = now == s->spans ? s->spans + each : s->spans;
    size_t kept = 0;
    /* the half-space holds between root `from` and the next; from = -1: before the first */
    for (int64_t from = sense < 0 ? -1 : 0; from < (int64_t)v.roots; from += 2) {
      qn_bound lo = from < 0 ? BEGIN : root_bound(s, &v, at, half, (uint32_t)from);
      qn_bound hi = from + 1 >= (int64_t)v.roots ? END : root_bound(s, &v, at, half, (uint32_t)(from + 1));
      kept += meet_one(s, now, n, lo, hi, touches, out + kept);
    }
    now = out;
    n = kept;
    if (n == 0) {
      return 0;
    }
  }
  *spans = now;
  return n;
}
