/* The stretches of a packet merged across lanes, for programs of one gate: a union of leaves, or a meet of leaves minus a union. Static code of
   the packet body; other programs, and lanes with anything that is not clear here, are for who merges lane by lane (query/sheaf.c).

   A group's stretches in the leaves that settle the gate are sorted by where they begin, each lane by itself, by insertion: they come nearly in order.
   Sweeping over them joins what overlaps to runs. A run ends where the next stretch begins later than it by more than the tolerance; those after it
   begin no sooner, so the gap is there. Ends within the tolerance of a run's own must be the same root of the same surface, else the lane is left. The run's
   beginning is named after the first leaf in the file that begins there, its end after the last one, as changes made in the order of leaves would have it. Runs are
   the answer of a union; from a meet they are taken away. */
#ifndef QN_WIDE_SPANS_MERGE_H
#define QN_WIDE_SPANS_MERGE_H

#include "wide/term.h"

enum { MERGE_MOST = 128 }; /* slots of a group */
enum { SLOT_DOUBLES = 4 * QN_W, ENTERS_AT = 2 * QN_W, LEAVES_AT = 3 * QN_W };
#define MERGE_SAME (QN_LARGER_ROOT | 0xffffffffu) /* of a payload: what ends at one place share */

/* A group on its way. Places of slots travel in the lanes of a vd as bits, as payloads do: where the slot's doubles begin. */
typedef struct merging {
  const walk *w;
  qn_packet_spans *out;
  const double *ends; /* of the group */
  int group;
  int meet;     /* runs are taken away from [at, to) */
  vd tolerance, at, p_at, to, p_to;
  vm inside;    /* lanes in which that is not empty */
  unsigned left; /* lanes that are not for this */
} merging;

/* The doubles at `part` of the slots at `from`. */
QN_INLINE vd slot_doubles(const merging *m, vd from, int part) {
  _Alignas(64) double bits[QN_W];
  const double *at[QN_W];
  vstore(bits, from);
  for (int i = 0; i < QN_W; i++) {
    uint64_t place;
    memcpy(&place, &bits[i], sizeof place);
    at[i] = m->ends + place + part + i;
  }
  return vcollect(at, 0);
}

/* Of the lanes in `near`, whose ends x and y cannot be told apart by their doubles: those whose ends are at one place. *sooner: of these, where x's leaf
   is before y's. The other lanes are left. */
static QN_NOINLINE vm one_place(merging *m, vm near, vd px, vd py, vm *sooner) {
  _Alignas(64) double x[QN_W], y[QN_W];
  unsigned bits = vbits(near), same = 0, first = 0;
  vstore(x, px), vstore(y, py);
  for (int i = 0; i < QN_W; i++) {
    uint64_t a, b;
    memcpy(&a, &x[i], 8), memcpy(&b, &y[i], 8);
    same |= (unsigned)(((a ^ b) & MERGE_SAME) == 0) << i;
    first |= (unsigned)((a >> 32 & QN_LEAF_BITS) < (b >> 32 & QN_LEAF_BITS)) << i;
  }
  m->left |= bits & ~same;
  *sooner = vmask(bits & same & first);
  return vmask(bits & same);
}

/* Whether x and y cannot be told apart, or else which comes first: by one difference, so that of two places exactly one of the three holds. x + tolerance, rounded, is no smaller than some
   y whose difference from x is above the tolerance. */
QN_INLINE vm within(const merging *m, vd x, vd y) { return vandnot(vmask(QN_ALL_BITS), vlt(m->tolerance, vabs(vsub(x, y)))); }
QN_INLINE vm clearly_before(const merging *m, vd x, vd y) { return vlt(m->tolerance, vsub(y, x)); }

/* --- what is found --------------------------------------------------------------------------------------------------- */

/* A lane's stretch that reaches over the range's ends, or may. */
static QN_NOINLINE void add_cut(merging *m, int i, double a, double pa, double b, double pb) {
  const unsigned lane = (unsigned)(m->group * QN_W + i);
  const qn_packet *p = m->w->f.p;
  qn_packet_spans *out = m->out;
  const double from = p->from[lane], to = p->to[lane], tolerance = m->w->tolerance[lane], none = payload_bits(QN_SPAN_CUT);
  if (a <= -QN_FAR) { /* no end there */
    a = -INFINITY, pa = none;
  }
  if (b >= QN_FAR) {
    b = INFINITY, pb = none;
  }
  int sure = (a == -INFINITY || fabs(a - from) > tolerance) & (b == INFINITY || fabs(b - to) > tolerance) & (fabs(b - from) > tolerance) & (fabs(a - to) > tolerance);
  if (sure && (b <= from || a >= to)) {
    return;
  }
  if (a < from) {
    a = from, pa = none;
  }
  if (b > to) {
    b = to, pb = none;
  }
  if (!sure || !(fabs(a) <= m->w->f.reach && fabs(b) <= m->w->f.reach)) {
    m->left |= 1u << i;
    return;
  }
  const size_t at = (size_t)out->row_count[lane] * QN_LANES + lane;
  out->row_t[at] = a, out->row_t[at + QN_LANES] = b;
  out->row_name[at] = pa, out->row_name[at + QN_LANES] = pb;
  out->row_count[lane] += 2;
}

/* A stretch [a, b] of the solid in each lane of `which`. fresh: it is the first of each lane. What a meet has left of it are mostly not as many in all lanes. */
QN_INLINE void add_stretch_to(merging *m, int fresh, vm which, vd a, vd pa, vd b, vd pb) {
  const int o = m->group * QN_W;
  const qn_packet *p = m->w->f.p;
  qn_packet_spans *out = m->out;
  const vd reach = vset(m->w->f.reach < QN_FAR ? m->w->f.reach : QN_FAR * 0.5);
  unsigned bits = vbits(which);
  vm whole = vand(vand(clearly_before(m, vload(p->from + o), a), clearly_before(m, b, vload(p->to + o))),
                  vand(vle(vabs(a), reach), vle(vabs(b), reach)));
  unsigned clear = bits & vbits(whole);
  uint32_t *counts = out->row_count + o, differ = !fresh && m->meet;
  for (unsigned i = 1; !fresh && !differ && i < QN_W; i++) {
    differ |= counts[i] ^ counts[0];
  }
  if (!differ && clear == bits) { /* what is left in other lanes is written over, or is past their rows */
    const size_t at = (size_t)(fresh ? 0 : counts[0]) * QN_LANES + (size_t)o;
    vstore(out->row_t + at, a), vstore(out->row_t + at + QN_LANES, b), vstore(out->row_name + at, pa), vstore(out->row_name + at + QN_LANES, pb);
    for (unsigned i = 0; i < QN_W; i++) {
      counts[i] += (clear >> i & 1) * 2;
    }
    return;
  }
  _Alignas(64) double ta[QN_W], tb[QN_W], na[QN_W], nb[QN_W];
  vstore(ta, a), vstore(tb, b), vstore(na, pa), vstore(nb, pb);
  for (unsigned i = 0; i < QN_W; i++) {
    if (clear >> i & 1) {
      const size_t at = (size_t)counts[i] * QN_LANES + (size_t)o + i;
      out->row_t[at] = ta[i], out->row_t[at + QN_LANES] = tb[i];
      out->row_name[at] = na[i], out->row_name[at + QN_LANES] = nb[i];
      counts[i] += 2;
    }
  }
  for (bits &= ~clear; QN_UNLIKELY(bits); bits &= bits - 1) {
    unsigned i = qn_trailing_zeros(bits);
    add_cut(m, (int)i, ta[i], na[i], tb[i], nb[i]);
  }
}

QN_INLINE void add_stretch(merging *m, vm which, vd a, vd pa, vd b, vd pb) { add_stretch_to(m, 0, which, a, pa, b, pb); }

/* --- runs taken away from a meet --------------------------------------------------------------------------------------- */

/* Where a run begins or ends within the tolerance of the meet: what is to be made of it. Returns the lanes in which there is more to do with the run. */
static QN_NOINLINE vm flush(merging *m, vm which, vd a, vd pa, vd b, vd pb) {
  vm sooner, same = one_place(m, vand(which, within(m, b, m->at)), m->p_at, pb, &sooner); /* the solid begins where the run ends: the last leaf makes it */
  m->p_at = vpick(sooner, pb, m->p_at);
  which = vandnot(which, same);
  same = one_place(m, vand(which, within(m, a, m->to)), pa, m->p_to, &sooner); /* it ends where the run begins: the first leaf makes it */
  m->p_to = vpick(sooner, pa, m->p_to);
  which = vandnot(which, same);
  one_place(m, vand(which, within(m, a, m->at)), pa, m->p_at, &sooner); /* both begin: nothing is between */
  return vandnot(which, vmask(m->left));
}

QN_INLINE void take_away(merging *m, vm which, vd a, vd pa, vd b, vd pb) {
  which = vand(which, m->inside);
  which = vandnot(which, vor(clearly_before(m, b, m->at), clearly_before(m, m->to, a))); /* elsewhere */
  if (QN_UNLIKELY(vbits(vand(which, vor(within(m, b, m->at), vor(within(m, a, m->to), within(m, a, m->at))))))) {
    which = flush(m, which, a, pa, b, pb);
  }
  vm gap = vand(which, clearly_before(m, m->at, a));
  if (vbits(gap)) {
    add_stretch(m, gap, m->at, m->p_at, a, pa);
  }
  m->at = vpick(which, b, m->at), m->p_at = vpick(which, pb, m->p_at);
}

/* What is left of the meet after the last run. */
static void last_of_meet(merging *m) {
  vm sooner, some = vand(m->inside, clearly_before(m, m->at, m->to)), near = vand(m->inside, within(m, m->at, m->to));
  if (vbits(near)) {
    one_place(m, near, m->p_at, m->p_to, &sooner);
  }
  if (vbits(some)) {
    add_stretch(m, some, m->at, m->p_at, m->to, m->p_to);
  }
}

/* The part of the lanes that all leaves of the meet hold. */
static void meet_of(merging *m, const qn_span_slot *slot, uint32_t slots, uint32_t needed) {
  vd met = vset(0);
  m->at = m->p_at = vset(-INFINITY), m->to = m->p_to = vset(INFINITY);
  for (uint32_t k = 0; k < slots; k++) {
    if (slot[k].settles) {
      continue;
    }
    const double *v = m->ends + (size_t)k * SLOT_DOUBLES;
    vd a = vload(v), b = vload(v + QN_W), pa = vload(v + ENTERS_AT), pb = vload(v + LEAVES_AT);
    vm hit = vmask(slot[k].hit), later = vand(hit, vlt(m->at, a)), sooner = vand(hit, vlt(b, m->to)), before, after;
    vm tied = vand(hit, within(m, a, m->at)), tied_end = vand(hit, within(m, b, m->to));
    met = vadd(met, vpick(hit, vset(1), vset(0)));
    if (QN_UNLIKELY(vbits(vor(tied, tied_end)))) {
      tied = one_place(m, tied, m->p_at, pa, &after);  /* the last leaf makes it begin */
      tied_end = one_place(m, tied_end, pb, m->p_to, &before); /* the first makes it end */
      later = vor(vandnot(later, tied), after), sooner = vor(vandnot(sooner, tied_end), before);
    }
    m->at = vpick(later, a, m->at), m->p_at = vpick(later, pa, m->p_at);
    m->to = vpick(sooner, b, m->to), m->p_to = vpick(sooner, pb, m->p_to);
  }
  m->inside = vle(vset(needed), met);
  vm near = vand(m->inside, within(m, m->at, m->to)), unused;
  if (QN_UNLIKELY(vbits(near))) {
    one_place(m, near, m->p_at, m->p_to, &unused);
  }
  m->inside = vand(m->inside, clearly_before(m, m->at, m->to));
}

/* --- runs -------------------------------------------------------------------------------------------------------------- */

typedef struct sorted { _Alignas(64) double a[MERGE_MOST * QN_W], slot[MERGE_MOST * QN_W]; } sorted; /* where stretches begin, infinite for none; and the slots */

QN_INLINE size_t put(sorted *s, size_t n, vd a, vd slot) {
  size_t j = n;
  for (; j > 0; j--) {
    vd other = vload(s->a + (j - 1) * QN_W), its_slot = vload(s->slot + (j - 1) * QN_W);
    vm before = vlt(a, other);
    if (!vbits(before)) {
      break;
    }
    vstore(s->a + j * QN_W, vpick(before, other, a)), vstore(s->slot + j * QN_W, vpick(before, its_slot, slot));
    a = vpick(before, a, other), slot = vpick(before, slot, its_slot);
  }
  vstore(s->a + j * QN_W, a), vstore(s->slot + j * QN_W, slot);
  return n + 1;
}

/* Sorts the group's stretches in leaves that settle the gate; those that lie well within the widest one met so far change nothing and are left out. */
static size_t sort_slots(const merging *m, const qn_span_slot *slot, uint32_t slots, sorted *s) {
  const vd none = vset(INFINITY);
  vd wide_a = none, wide_b = vset(-INFINITY);
  size_t n = 0;
  for (uint32_t k = 0; k < slots; k++) {
    if (!slot[k].settles) {
      continue;
    }
    const double *v = m->ends + (size_t)k * SLOT_DOUBLES;
    vd a = vload(v), b = vload(v + QN_W);
    vm hit = vandnot(vmask(slot[k].hit), vand(clearly_before(m, wide_a, a), clearly_before(m, b, wide_b)));
    if (!vbits(hit)) {
      continue;
    }
    vm wider = vand(hit, vlt(vsub(wide_b, wide_a), vsub(b, a)));
    wide_a = vpick(wider, a, wide_a), wide_b = vpick(wider, b, wide_b);
    n = put(s, n, vpick(hit, a, none), vset(payload_bits((uint64_t)k * SLOT_DOUBLES)));
  }
  return n;
}

typedef struct run { vd a, b, from, to; vm open; } run; /* from, to: the slots that make its ends */

/* Ends of a stretch within the tolerance of the run's: of those at one place, which is named. */
static QN_NOINLINE void settle_run(merging *m, run *r, vm joined, vd a, vd b, vd slot) {
  vm sooner, near = vand(joined, within(m, a, r->b));
  if (vbits(near)) { /* it begins where the run would end: no gap between */
    one_place(m, near, slot_doubles(m, slot, ENTERS_AT), slot_doubles(m, r->to, LEAVES_AT), &sooner);
  }
  near = vand(joined, within(m, a, r->a));
  if (vbits(near)) {
    one_place(m, near, slot_doubles(m, slot, ENTERS_AT), slot_doubles(m, r->from, ENTERS_AT), &sooner);
    r->from = vpick(sooner, slot, r->from), r->a = vpick(sooner, a, r->a);
  }
  near = vand(joined, within(m, b, r->b));
  if (vbits(near)) {
    one_place(m, near, slot_doubles(m, r->to, LEAVES_AT), slot_doubles(m, slot, LEAVES_AT), &sooner);
    r->to = vpick(sooner, slot, r->to), r->b = vpick(sooner, b, r->b);
  }
}

QN_INLINE void end_runs(merging *m, const run *r, vm which) {
  vd pa = slot_doubles(m, r->from, ENTERS_AT), pb = slot_doubles(m, r->to, LEAVES_AT);
  if (m->meet) {
    take_away(m, which, r->a, pa, r->b, pb);
  } else {
    add_stretch(m, which, r->a, pa, r->b, pb);
  }
}

QN_INLINE void sweep(merging *m, const sorted *s, size_t n) {
  const vd infinite = vset(INFINITY);
  run r = {.a = infinite, .b = vset(-INFINITY), .from = vset(0), .to = vset(0), .open = vmask(0)};
  for (size_t k = 0; k < n; k++) {
    vd a = vload(s->a + k * QN_W), slot = vload(s->slot + k * QN_W), b = slot_doubles(m, slot, QN_W);
    vm live = vlt(a, infinite), fresh = vand(live, clearly_before(m, r.b, a)), joined = vandnot(live, fresh);
    vm longer = vand(joined, clearly_before(m, r.b, b));
    vm near = vand(joined, vor(within(m, a, r.b), vor(within(m, a, r.a), within(m, b, r.b))));
    if (QN_UNLIKELY(vbits(near))) {
      settle_run(m, &r, joined, a, b, slot);
    }
    vm ended = vand(fresh, r.open);
    if (vbits(ended)) {
      end_runs(m, &r, ended);
    }
    longer = vor(longer, fresh);
    r.a = vpick(fresh, a, r.a), r.from = vpick(fresh, slot, r.from);
    r.b = vpick(longer, b, r.b), r.to = vpick(longer, slot, r.to);
    r.open = vor(r.open, fresh);
  }
  if (vbits(r.open)) {
    end_runs(m, &r, r.open);
  }
}

/* Whether a program is one for this. */
static int can_merge(const qn_program *program) {
  const qn_gate *root = program->gates;
  return program->gate_count == 1 && (root->is_and ? root->need > root->base : root->base == 0);
}

/* Rows for all groups; out->merged: the lanes that they answer. */
static void merge_groups(const walk *w, qn_packet_spans *out) {
  const qn_gate *root = w->scene->program.gates;
  const int simple = can_merge(&w->scene->program);
  for (int g = 0; g < QN_GROUPS; g++) {
    const uint32_t slots = out->count[g];
    const qn_span_slot *slot = out->slots + (size_t)g * out->capacity;
    if (slots == 0) { /* the value is what it is where every leaf is outside */
      out->merged |= w->scene->program.base ? 0 : (uint64_t)QN_ALL_BITS << (g * QN_W);
      continue;
    }
    if (!simple || slots > MERGE_MOST) {
      continue;
    }
    sorted s;
    merging m;
    m.w = w, m.out = out, m.ends = out->ends + (size_t)g * out->capacity * SLOT_DOUBLES, m.group = g, m.meet = root->is_and, m.left = 0;
    m.tolerance = vload(w->tolerance + g * QN_W);
    if (slots == 1 && !root->is_and) {
      add_stretch_to(&m, 1, vmask(slot->hit), vload(m.ends), vload(m.ends + ENTERS_AT), vload(m.ends + QN_W), vload(m.ends + LEAVES_AT));
    } else {
      if (root->is_and) {
        meet_of(&m, slot, slots, root->need - root->base);
      }
      sweep(&m, &s, sort_slots(&m, slot, slots, &s));
      if (root->is_and) {
        last_of_meet(&m);
      }
    }
    for (unsigned left = m.left; left; left &= left - 1) {
      out->row_count[g * QN_W + (int)qn_trailing_zeros(left)] = 0;
    }
    out->merged |= (uint64_t)(QN_ALL_BITS & ~m.left) << (g * QN_W);
  }
}

#endif
