/* The stretches of a packet merged by plans, for programs of several gates. Static code of the packet body; what it leaves is for who merges lane by lane
   (query/sheaf.c), whose rules these are.

   Neighbouring lanes mostly meet the same leaves in the same order. A plan is made for one lane: which leaves it meets, the order of their ends, and which of these ends
   change the solid's value. It serves every lane that meets just these leaves, once their ends are certainly in that order: each further from the one before by
   more than the tolerance, or, where the plan's lane has two at one place, the same root of the same surface. That is asked of a whole group at once. Plans are kept
   from group to group and packet to packet. */
#ifndef QN_WIDE_SPANS_PLAN_H
#define QN_WIDE_SPANS_PLAN_H

#include "wide/spans_merge.h"

_Static_assert((int)QN_PLAN_LEAVES <= (int)MERGE_MOST, "a plan's numbers are small");

/* An end in a plan: the place of its leaf among the lane's, whether it is where the leaf is left, whether it is where the end before it is. */
enum { END_LEAVES = 1, END_TIED = 2, END_LEAF = 4 };

typedef struct planning {
  const struct quoin_scene *scene;
  uint32_t *count; /* by gate: true children; at rest between plans */
  const qn_span_slot *slot[QN_PLAN_LEAVES];
  const double *ends[QN_PLAN_LEAVES];
  uint32_t leaves;
} planning;

/* A leaf is entered or left: whether the solid's value changes. */
QN_INLINE int plan_change(const planning *p, const qn_span_slot *slot, int enters) {
  const qn_gate *gates = p->scene->program.gates;
  const int up = enters != slot->negated;
  for (uint32_t g = slot->gate;; g = gates[g].parent) {
    const uint32_t before = p->count[g], after = up ? before + 1 : before - 1;
    p->count[g] = after;
    if ((before >= gates[g].need) == (after >= gates[g].need)) {
      return 0;
    }
    if (gates[g].parent == QN_NO_GATE) {
      return 1;
    }
  }
}

/* Whether any order of the ends in a group's leaves makes the solid: the program only rises with its literals, so it holds nowhere when it does not with all leaves entered and none
   left that is taken away. It is false where every leaf is outside. */
static QN_NOINLINE int plan_may_hold(const planning *p, const qn_span_slot *slot, uint32_t slots) {
  int value = 0;
  for (int pass = 0; pass < 2; pass++) { /* and back to rest */
    for (uint32_t k = 0; k < slots; k++) {
      if (!slot[k].negated) {
        const int other = plan_change(p, &slot[k], !pass);
        value ^= pass ? 0 : other;
      }
    }
  }
  return value;
}

/* Ends [from, to) of the plan lie at one place: made in the order of the leaves. Returns the one that is named where the value is another afterwards, or -1. */
static int plan_group(const planning *p, const qn_span_plan *plan, uint32_t from, uint32_t to) {
  uint16_t e[2 * QN_PLAN_LEAVES];
  uint32_t n = 1;
  e[0] = plan->end[from];
  int flips = 0, last = -1;
  for (uint32_t i = from + 1; i < to; i++) {
    uint32_t j = n++;
    for (; j > 0 && p->slot[e[j - 1] / END_LEAF]->leaf > p->slot[plan->end[i] / END_LEAF]->leaf; j--) {
      e[j] = e[j - 1];
    }
    e[j] = plan->end[i];
  }
  for (uint32_t i = 0; i < n; i++) {
    if (plan_change(p, p->slot[e[i] / END_LEAF], !(e[i] & END_LEAVES))) {
      flips++, last = e[i];
    }
  }
  return flips & 1 ? last : -1;
}

/* The lane's leaves that may change the solid, in any order of the ends: those below no gate that is false with all leaves entered and none left that is taken away. Returns how
   many; none where the solid is not held at all. */
static uint32_t plan_alive(const planning *p, uint8_t which[QN_PLAN_LEAVES]) {
  const qn_gate *gates = p->scene->program.gates;
  uint32_t n = 0;
  for (uint32_t k = 0; k < p->leaves; k++) {
    if (!p->slot[k]->negated) {
      plan_change(p, p->slot[k], 1);
    }
  }
  for (uint32_t k = 0; k < p->leaves; k++) {
    uint32_t g = p->slot[k]->gate;
    while (p->count[g] >= gates[g].need && gates[g].parent != QN_NO_GATE) {
      g = gates[g].parent;
    }
    which[n] = (uint8_t)k;
    n += p->count[g] >= gates[g].need;
  }
  for (uint32_t k = 0; k < p->leaves; k++) {
    if (!p->slot[k]->negated) {
      plan_change(p, p->slot[k], 0);
    }
  }
  return n;
}

QN_INLINE uint32_t plan_insert(qn_span_plan *plan, double *t, uint32_t n, double at, uint32_t end) {
  uint32_t j = n;
  for (; j > 0 && t[j - 1] > at; j--) {
    t[j] = t[j - 1], plan->end[j] = plan->end[j - 1];
  }
  t[j] = at, plan->end[j] = (uint16_t)end;
  return n + 1;
}

/* The plan of the leaves, for an order to come. */
static QN_NOINLINE void plan_begin(const planning *p, qn_span_plan *plan) {
  plan->leaves = p->leaves;
  for (uint32_t k = 0; k < p->leaves; k++) {
    plan->leaf[k] = p->slot[k]->leaf;
  }
  plan->alives = plan_alive(p, plan->alive);
}

/* The plan is to be of the order of a group's lane. */
static QN_NOINLINE void plan_make(const planning *p, double tolerance, unsigned lane, qn_span_plan *plan) {
  double begins[QN_PLAN_LEAVES], t[2 * QN_PLAN_LEAVES];
  uint8_t order[QN_PLAN_LEAVES];
  const uint8_t *alive = plan->alive;
  const uint32_t count = plan->alives;
  plan->ends = plan->drops = plan->rows = 0;
  for (uint32_t k = 0; k < count; k++) {
    const double a = p->ends[alive[k]][lane];
    uint32_t j = k;
    for (; j > 0 && begins[j - 1] > a; j--) {
      begins[j] = begins[j - 1], order[j] = order[j - 1];
    }
    begins[j] = a, order[j] = alive[k];
  }
  double a = 0, b = -INFINITY;
  uint32_t gate = QN_NO_GATE, n = 0;
  uint8_t widest = 0;
  for (uint32_t j = 0; j < count; j++) {
    const uint8_t k = order[j];
    const double enter = begins[j], leave = p->ends[k][QN_W + lane];
    const qn_span_slot *slot = p->slot[k];
    if ((slot->gate == gate) & (enter - a > tolerance) & (b - leave > tolerance)) { /* nothing changes there */
      plan->drop[plan->drops][0] = k, plan->drop[plan->drops++][1] = widest;
      continue;
    }
    n = plan_insert(plan, t, n, enter, k * (uint32_t)END_LEAF);
    n = plan_insert(plan, t, n, leave, k * (uint32_t)END_LEAF | END_LEAVES);
    if (slot->settles && !(slot->gate == gate && leave < b)) {
      gate = slot->gate, a = enter, b = leave, widest = k;
    }
  }
  plan->ends = n;
  for (uint32_t i = 1; i < n; i++) {
    plan->end[i] |= t[i] - t[i - 1] > tolerance ? 0 : END_TIED;
  }
  for (uint32_t i = 0, to; i < n; i = to) {
    for (to = i + 1; to < n && plan->end[to] & END_TIED;) {
      to++;
    }
    const int named = plan_group(p, plan, i, to);
    if (named >= 0) {
      plan->row[plan->rows++] = (uint16_t)named;
    }
  }
}

/* Of the lanes in `which`, those whose ends are certainly in the plan's order. */
QN_INLINE vm plan_holds(const planning *p, const qn_span_plan *plan, vd tolerance, vm which) {
  if (plan->ends == 0) {
    return which;
  }
  const double *before = p->ends[plan->end[0] / END_LEAF]; /* the first one begins a stretch */
  vd t = vload(before);
  which = vand(which, vlt(vset(-QN_FAR), t));
  for (uint32_t i = 1; i < plan->ends; i++) {
    const uint32_t end = plan->end[i];
    const double *at = p->ends[end / END_LEAF] + (end & END_LEAVES) * (uint32_t)QN_W;
    const vd next = vload(at);
    const vm apart = vlt(tolerance, vsub(next, t));
    if (QN_UNLIKELY(end & END_TIED)) { /* ends that are not there have one name, and may lie on either side */
      which = vand(which, vandnot(vsame(vload(at + ENTERS_AT), vload(before + ENTERS_AT), MERGE_SAME), vor(apart, vlt(tolerance, vsub(t, next)))));
    } else {
      which = vand(which, apart);
    }
    t = next, before = at;
  }
  which = vand(which, vlt(t, vset(QN_FAR)));
  for (uint32_t i = 0; i < plan->drops; i++) {
    const double *in = p->ends[plan->drop[i][0]], *of = p->ends[plan->drop[i][1]];
    which = vand(which, vand(vlt(tolerance, vsub(vload(in), vload(of))), vlt(tolerance, vsub(vload(of + QN_W), vload(in + QN_W)))));
  }
  return which;
}

QN_INLINE const double *plan_end(const planning *p, uint32_t end) { return p->ends[end / END_LEAF] + (end & END_LEAVES) * (uint32_t)QN_W; }

/* The plan's stretches become rows of the lanes in `which`. */
QN_INLINE void plan_write(merging *m, const planning *p, const qn_span_plan *plan, vm which) {
  const int o = m->group * QN_W;
  qn_packet_spans *out = m->out;
  if (plan->rows == 0) {
    return;
  }
  const vd reach = vset(m->w->f.reach), first = vload(plan_end(p, plan->row[0])), last = vload(plan_end(p, plan->row[plan->rows - 1]));
  vm whole = vand(vand(clearly_before(m, vload(m->w->f.p->from + o), first), clearly_before(m, last, vload(m->w->f.p->to + o))),
                  vand(vle(vabs(first), reach), vle(vabs(last), reach)));
  whole = vand(which, whole);
  const unsigned bits = vbits(whole), cut = vbits(vandnot(which, whole));
  if (QN_UNLIKELY(cut)) {
    for (uint32_t j = 0; j + 1 < plan->rows; j += 2) {
      const double *a = plan_end(p, plan->row[j]), *b = plan_end(p, plan->row[j + 1]);
      add_stretch(m, vmask(cut), vload(a), vload(a + ENTERS_AT), vload(b), vload(b + ENTERS_AT));
    }
  }
  for (uint32_t j = 0; bits && j < plan->rows; j++) {
    const double *from = plan_end(p, plan->row[j]);
    double *t = out->row_t + (size_t)j * QN_LANES + o, *name = out->row_name + (size_t)j * QN_LANES + o;
    if (bits == QN_ALL_BITS) {
      vstore(t, vload(from)), vstore(name, vload(from + ENTERS_AT));
    } else {
      vstore(t, vpick(whole, vload(from), vload(t))), vstore(name, vpick(whole, vload(from + ENTERS_AT), vload(name)));
    }
  }
  for (unsigned left = bits; left; left &= left - 1) {
    out->row_count[o + (int)qn_trailing_zeros(left)] = plan->rows;
  }
}

/* The leaves that a lane of a group meets; *with: the lanes that meet just these. Returns what the leaves hash to, or -1: too many. */
QN_INLINE int plan_leaves(const qn_span_slot *slot, uint32_t slots, const double *doubles, unsigned lane, planning *p, unsigned *with) {
  uint64_t h = 0;
  unsigned same = *with;
  uint32_t n = 0;
  for (uint32_t k = 0; k < slots; k++) {
    const unsigned hit = slot[k].hit;
    if (!(hit >> lane & 1)) {
      same &= ~hit;
      continue;
    }
    if (QN_UNLIKELY(n == QN_PLAN_LEAVES)) {
      return -1;
    }
    same &= hit;
    p->slot[n] = &slot[k], p->ends[n++] = doubles + (size_t)k * SLOT_DOUBLES;
    h = (h + slot[k].leaf) * 0x9e3779b97f4a7c15u;
  }
  p->leaves = n, *with = same;
  return (int)(h >> (64 - QN_PLAN_BITS));
}

QN_INLINE int plan_is_of(const planning *p, const qn_span_plan *plan) {
  uint32_t differ = plan->leaves ^ p->leaves;
  for (uint32_t k = 0; !differ && k < p->leaves; k++) {
    differ = plan->leaf[k] ^ p->slot[k]->leaf;
  }
  return !differ;
}

/* A group's rows in the lanes of `todo`. Returns the lanes that are left. */
static unsigned plan_group_rows(merging *m, const qn_span_slot *slot, uint32_t slots, unsigned todo, planning *p) {
  const double *tolerance = m->w->tolerance + (size_t)m->group * QN_W;
  unsigned left = 0;
  int asked = 0; /* whether all leaves of the group may hold */
  while (todo) {
    const unsigned lane = qn_trailing_zeros(todo);
    unsigned with = todo;
    const int place = plan_leaves(slot, slots, m->ends, lane, p, &with);
    if (place < 0) {
      todo &= todo - 1, left |= 1u << lane;
      continue;
    }
    qn_span_plan *plan = &m->out->plans[place];
    const int known = plan_is_of(p, plan);
    if (!known) {
      if (!asked && p->leaves < slots && !plan_may_hold(p, slot, slots)) {
        break;
      }
      asked = 1;
      plan_begin(p, plan);
      plan_make(p, tolerance[lane], lane, plan);
    }
    unsigned good = with;
    if (plan->alives) {
      good = vbits(plan_holds(p, plan, m->tolerance, vmask(with)));
      if (!(good >> lane & 1) && known) {
        plan_make(p, tolerance[lane], lane, plan);
        good = vbits(plan_holds(p, plan, m->tolerance, vmask(with)));
      }
      plan_write(m, p, plan, vmask(good));
    }
    left |= ~good & 1u << lane;
    todo &= ~(good | 1u << lane);
  }
  return left | m->left;
}

/* Rows for all groups; out->merged: the lanes that they answer. */
static QN_NOINLINE void plan_groups(const walk *w, qn_packet_spans *out) {
  planning p; /* large, and filled in group by group */
  p.scene = w->scene, p.count = out->gate_count, p.leaves = 0;
  for (int g = 0; g < QN_GROUPS; g++) {
    merging m;
    m.w = w, m.out = out, m.ends = out->ends + (size_t)g * out->capacity * SLOT_DOUBLES, m.group = g, m.meet = 1, m.left = 0; /* lanes have rows of their own */
    m.tolerance = vload(w->tolerance + g * QN_W);
    const unsigned in = (unsigned)((w->f.p->live & ~w->unsure) >> (g * QN_W)) & QN_ALL_BITS;
    const unsigned left = out->count[g] ? plan_group_rows(&m, out->slots + (size_t)g * out->capacity, out->count[g], in, &p) : 0;
    for (unsigned bits = left; bits; bits &= bits - 1) {
      out->row_count[g * QN_W + (int)qn_trailing_zeros(bits)] = 0;
    }
    out->merged |= (uint64_t)(in & ~left) << (g * QN_W);
  }
}

#endif
