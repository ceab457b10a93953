/* Sets drawn: a set within a box as drafts of terms. A union is its children's drafts; a meet multiplies its children's, and takes from
   each draft what is left of the others within the draft's box. When copies run out a union is shared instead, unclipped. */
#include "scene/draw.h"

#include <math.h>
#include <string.h>

static int boxes_meet(const double a[6], const double b[6]) {
  return a[0] <= b[3] && b[0] <= a[3] && a[1] <= b[4] && b[1] <= a[4] && a[2] <= b[5] && b[2] <= a[5];
}

static int push(qn_drawing *m, const qn_draft *d) {
  if (m->status || !qn_grow(m->mem, &m->drafts, &m->draft_capacity, m->draft_count + 1)) {
    return qn_draw_refuse(m);
  }
  m->drafts[m->draft_count++] = *d;
  return 1;
}
static int push_leaf(qn_drawing *m, uint32_t leaf) {
  if (!qn_grow(m->mem, &m->names, &m->name_capacity, m->name_count + 1)) {
    return qn_draw_refuse(m);
  }
  m->names[m->name_count++] = leaf;
  return 1;
}

/* --- listed sets ---------------------------------------------------------------------------------------------------- */

typedef struct listing { qn_drawing *m; const qn_set_index *x; uint32_t *found; size_t count, capacity; int failed; } listing;
static void list_one(void *user, uint32_t item) {
  listing *l = user;
  if (!qn_grow(l->m->mem, &l->found, &l->capacity, l->count + 1)) {
    l->failed = 1;
    return;
  }
  l->found[l->count++] = l->x->sets[item];
}

/* Draws the indexed sets that meet a box. */
/* NOLINTNEXTLINE(misc-no-recursion): as deep as QN_NORMAL_DEPTH */
static int draw_indexed(qn_drawing *m, const qn_set_index *x, const double clip[6]) {
  if (!x->bvh.nodes) {
    for (size_t i = 0; i < x->count; i++) {
      if (!qn_draw(m, x->sets[i], clip)) {
        return 0;
      }
    }
    return 1;
  }
  for (size_t i = 0; i < x->open_count; i++) {
    if (!qn_draw(m, x->open[i], clip)) {
      return 0;
    }
  }
  listing l = {.m = m, .x = x};
  uint64_t nodes = 0;
  qn_bvh_point(&x->bvh, clip, clip + 3, list_one, &l, &nodes);
  int good = !l.failed || qn_draw_refuse(m);
  for (size_t i = 0; good && i < l.count; i++) {
    good = qn_draw(m, l.found[i], clip);
  }
  qn_free(m->mem, l.found, l.capacity * sizeof *l.found);
  return good;
}

/* --- a meet ----------------------------------------------------------------------------------------------------------- */

/* The union of some sets, unclipped, made once: what is left to do when copies have run out. */
/* NOLINTNEXTLINE(misc-no-recursion): as deep as QN_NORMAL_DEPTH */
static uint32_t share(qn_drawing *m, uint32_t *slot, const uint32_t *sets, size_t count, const double clip[6]) {
  if (*slot == QN_NO_UNION) {
    size_t first = m->draft_count;
    for (size_t i = 0; i < count; i++) {
      if (!qn_draw(m, sets[i], clip)) {
        return QN_NO_UNION;
      }
    }
    *slot = qn_union_make(m, first);
    m->n->shared++;
  }
  return *slot;
}

/* NOLINTNEXTLINE(misc-no-recursion): as deep as QN_NORMAL_DEPTH */
static int multiply(qn_drawing *m, size_t first, uint32_t set) {
  size_t end = m->draft_count;
  qn_set_index x = {0};
  int good = qn_set_index_make(m, &set, 1, end - first, &x);
  for (size_t i = first; good && i < end; i++) {
    qn_draft left = m->drafts[i];
    if (m->instances + m->name_count > m->budget && set < m->gates) {
      static const double all[6] = {-INFINITY, -INFINITY, -INFINITY, INFINITY, INFINITY, INFINITY};
      uint32_t u = share(m, &m->shared[m->gates + set], &set, 1, all);
      if (m->status) {
        good = 0;
      } else if (u != QN_NO_UNION) {
        good = qn_list_extend(m, &left.plus0, &left.plus, &u, 1) && push(m, &left);
      }
      continue;
    }
    size_t from = m->draft_count;
    const double clip[6] = {left.min[0], left.min[1], left.min[2], left.max[0], left.max[1], left.max[2]};
    good = draw_indexed(m, &x, clip);
    for (size_t j = from; good && j < m->draft_count; j++) {
      qn_draft d = m->drafts[j];
      uint32_t leaf0 = (uint32_t)m->name_count;
      for (uint32_t k = 0; good && k < left.leaves; k++) {
        good = push_leaf(m, m->names[left.leaf0 + k]);
      }
      for (uint32_t k = 0; good && k < d.leaves; k++) {
        good = push_leaf(m, m->names[d.leaf0 + k]);
      }
      uint32_t plus0 = left.plus0, plus = left.plus, minus0 = left.minus0, minus = left.minus;
      good = good && qn_list_extend(m, &plus0, &plus, d.plus ? m->n->lists + d.plus0 : NULL, d.plus);
      good = good && qn_list_extend(m, &minus0, &minus, d.minus ? m->n->lists + d.minus0 : NULL, d.minus);
      m->drafts[j] = (qn_draft){{d.min[0], d.min[1], d.min[2]}, {d.max[0], d.max[1], d.max[2]}, leaf0, left.leaves + d.leaves, plus0, plus, minus0, minus};
    }
  }
  qn_set_index_free(m, &x);
  if (good) {
    memmove(m->drafts + first, m->drafts + end, (m->draft_count - end) * sizeof *m->drafts);
    m->draft_count -= end - first;
  }
  return good;
}

/* NOLINTNEXTLINE(misc-no-recursion): as deep as QN_NORMAL_DEPTH */
static int draw_meet(qn_drawing *m, uint32_t gate, const double clip[6]) {
  size_t first = m->draft_count, all = m->kid0[gate + 1] - m->kid0[gate], met = 0;
  uint32_t *sets = qn_alloc(m->mem, all * sizeof *sets);
  if (!sets) {
    return qn_draw_refuse(m);
  }
  for (int leaf = 1; leaf >= 0; leaf--) { /* leaves first: they clip the rest */
    for (uint32_t i = m->kid0[gate]; i < m->kid0[gate + 1]; i++) {
      uint32_t k = m->kids[i];
      if (qn_set_is_met(m, gate, k) && (k >= m->gates) == leaf) {
        sets[met++] = k;
      }
    }
  }
  size_t taken = met;
  for (uint32_t i = m->kid0[gate]; i < m->kid0[gate + 1]; i++) {
    if (!qn_set_is_met(m, gate, m->kids[i])) {
      sets[taken++] = m->kids[i];
    }
  }
  int good = met > 0 ? qn_draw(m, sets[0], clip) : 0;
  for (size_t i = 1; good && i < met; i++) {
    good = multiply(m, first, sets[i]);
  }
  if (good && all > met) {
    qn_set_index x = {0};
    size_t end = m->draft_count;
    good = qn_set_index_make(m, sets + met, all - met, end - first, &x);
    for (size_t i = first; good && i < end; i++) {
      qn_draft d = m->drafts[i];
      uint32_t u;
      if (m->instances + m->name_count > m->budget && end - first > 1) {
        u = share(m, &m->shared[gate], sets + met, all - met, m->box[gate]);
      } else {
        const double box[6] = {d.min[0], d.min[1], d.min[2], d.max[0], d.max[1], d.max[2]};
        size_t from = m->draft_count;
        good = draw_indexed(m, &x, box);
        u = good ? qn_union_make(m, from) : QN_NO_UNION;
      }
      good = good && !m->status && (u == QN_NO_UNION || qn_list_extend(m, &d.minus0, &d.minus, &u, 1));
      m->drafts[i] = d;
    }
    qn_set_index_free(m, &x);
  }
  qn_free(m->mem, sets, all * sizeof *sets);
  return good && !m->status;
}

/* NOLINTNEXTLINE(misc-no-recursion): as deep as QN_NORMAL_DEPTH */
int qn_draw(qn_drawing *m, uint32_t set, const double clip[6]) {
  double box[6];
  qn_set_box(m, set, box);
  if (!boxes_meet(box, clip)) {
    return 1;
  }
  if (set >= m->gates) {
    qn_box_meet(box, clip);
    qn_draft d = {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}, (uint32_t)m->name_count, 1, 0, 0, 0, 0};
    return push_leaf(m, (uint32_t)(set - m->gates)) && push(m, &d);
  }
  if (m->joins[set]) {
    for (uint32_t i = m->kid0[set]; i < m->kid0[set + 1]; i++) {
      if (!qn_draw(m, m->kids[i], clip)) {
        return 0;
      }
    }
    return 1;
  }
  return draw_meet(m, set, clip);
}
