/* The gates of the program read as sets (scene/normal.h says how), and lists of them found by box. */
#include "scene/draw.h"

#include <math.h>
#include <string.h>

/* --- gates ---------------------------------------------------------------------------------------------------------- */

static int is_true(const qn_drawing *m, uint32_t set) { /* with every leaf outside */
  return set < m->gates ? m->truth[set] : m->scene->leaves[set - m->gates].negated;
}

void qn_set_box(const qn_drawing *m, uint32_t set, double box[6]) {
  if (set < m->gates) {
    memcpy(box, m->box[set], 6 * sizeof *box);
  } else {
    const qn_leaf *l = &m->scene->leaves[set - m->gates];
    memcpy(box, l->min, sizeof l->min);
    memcpy(box + 3, l->max, sizeof l->max);
  }
}

int qn_set_is_met(const qn_drawing *m, uint32_t gate, uint32_t kid) {
  return is_true(m, kid) != (m->scene->program.gates[gate].is_and != 0);
}

/* The gate's set is a union of all its children's; else a meet of those children of which qn_set_is_met is true minus the others. */
static int is_union(const qn_drawing *m, uint32_t gate) {
  for (uint32_t i = m->kid0[gate]; i < m->kid0[gate + 1]; i++) {
    if (qn_set_is_met(m, gate, m->kids[i])) {
      return 0;
    }
  }
  return 1;
}

static void box_join(double a[6], const double b[6]) {
  for (int i = 0; i < 3; i++) {
    a[i] = fmin(a[i], b[i]), a[3 + i] = fmax(a[3 + i], b[3 + i]);
  }
}

int qn_sets_read(qn_drawing *m) {
  const qn_program *p = &m->scene->program;
  size_t leaves = m->scene->leaf_count;
  m->kid0 = qn_alloc_zeroed(m->mem, (m->gates + 2) * sizeof *m->kid0);
  m->kids = qn_alloc(m->mem, (m->gates + leaves) * sizeof *m->kids);
  m->box = qn_alloc(m->mem, m->gates * sizeof *m->box);
  m->shared = qn_alloc(m->mem, 2 * m->gates * sizeof *m->shared);
  m->truth = qn_alloc(m->mem, m->gates);
  m->joins = qn_alloc(m->mem, m->gates);
  uint32_t *depth = qn_alloc_zeroed(m->mem, m->gates * sizeof *depth);
  if (!m->kid0 || !m->kids || !m->box || !m->shared || !m->truth || !m->joins || !depth) {
    qn_free(m->mem, depth, m->gates * sizeof *depth);
    return qn_draw_refuse(m);
  }
  memset(m->shared, 0xff, 2 * m->gates * sizeof *m->shared);
  int deep = 0;
  for (size_t g = 0; g < m->gates; g++) {
    m->truth[g] = p->gates[g].base >= p->gates[g].need;
    if (g > 0) {
      depth[g] = depth[p->gates[g].parent] + 1;
      deep |= depth[g] > QN_NORMAL_DEPTH;
      m->kid0[p->gates[g].parent + 2]++;
    }
  }
  qn_free(m->mem, depth, m->gates * sizeof *depth);
  if (deep) {
    return 0;
  }
  for (size_t i = 0; i < leaves; i++) {
    m->kid0[m->scene->leaves[i].gate + 2]++;
  }
  for (size_t g = 0; g <= m->gates; g++) {
    m->kid0[g + 1] += m->kid0[g];
  }
  for (size_t g = 1; g < m->gates; g++) {
    m->kids[m->kid0[p->gates[g].parent + 1]++] = (uint32_t)g;
  }
  for (size_t i = 0; i < leaves; i++) {
    m->kids[m->kid0[m->scene->leaves[i].gate + 1]++] = (uint32_t)(m->gates + i);
  }
  for (size_t g = m->gates; g-- > 0;) { /* children before parents */
    double *box = m->box[g];
    int join = m->joins[g] = (uint8_t)is_union(m, (uint32_t)g);
    for (int i = 0; i < 6; i++) {
      box[i] = (i < 3) == join ? INFINITY : -INFINITY;
    }
    for (uint32_t i = m->kid0[g]; i < m->kid0[g + 1]; i++) {
      double kid[6];
      qn_set_box(m, m->kids[i], kid);
      if (join) {
        box_join(box, kid);
      } else if (qn_set_is_met(m, (uint32_t)g, m->kids[i])) {
        qn_box_meet(box, kid);
      }
    }
  }
  return 1;
}

void qn_sets_free(qn_drawing *m) {
  size_t gates = m->gates;
  qn_free(m->mem, m->kid0, (gates + 2) * sizeof *m->kid0);
  qn_free(m->mem, m->kids, (gates + m->scene->leaf_count) * sizeof *m->kids);
  qn_free(m->mem, m->box, gates * sizeof *m->box);
  qn_free(m->mem, m->shared, 2 * gates * sizeof *m->shared);
  qn_free(m->mem, m->truth, gates);
  qn_free(m->mem, m->joins, gates);
}

/* --- lists ---------------------------------------------------------------------------------------------------------- */

void qn_set_index_free(qn_drawing *m, qn_set_index *x) {
  qn_bvh_free(&x->bvh, m->mem);
  qn_free(m->mem, x->sets, x->capacity * sizeof *x->sets);
}

int qn_set_index_make(qn_drawing *m, const uint32_t *list, size_t list_count, size_t asked, qn_set_index *x) {
  for (size_t i = 0; i < list_count; i++) {
    uint32_t set = list[i];
    int open = set < m->gates && m->joins[set];
    const uint32_t *from = open ? m->kids + m->kid0[set] : &list[i];
    size_t count = open ? m->kid0[set + 1] - m->kid0[set] : 1;
    if (!qn_grow(m->mem, &x->sets, &x->capacity, x->count + count)) {
      return qn_draw_refuse(m);
    }
    memcpy(x->sets + x->count, from, count * sizeof *from);
    x->count += count;
  }
  if (x->count <= 32 || asked <= 8) {
    return 1;
  }
  size_t narrow = 0;
  double (*boxes)[6] = qn_alloc(m->mem, x->count * sizeof *boxes);
  if (!boxes) {
    return qn_draw_refuse(m);
  }
  for (size_t i = 0; i < x->count; i++) {
    qn_set_box(m, x->sets[i], boxes[narrow]);
    if (qn_box_is_finite(boxes[narrow])) {
      uint32_t s = x->sets[i];
      memmove(x->sets + narrow + 1, x->sets + narrow, (i - narrow) * sizeof s);
      x->sets[narrow++] = s;
    }
  }
  x->open = x->sets + narrow;
  x->open_count = x->count - narrow;
  quoin_status s = qn_build_over(m, &x->bvh, narrow, boxes);
  qn_free(m->mem, boxes, x->count * sizeof *boxes);
  return s == QUOIN_OK || qn_draw_refuse(m);
}

