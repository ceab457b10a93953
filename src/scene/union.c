/* Drafts made into unions: terms laid in the order of a hierarchy over them. */
#include "scene/draw.h"

#include <math.h>
#include <string.h>

int qn_box_is_finite(const double a[6]) {
  double sum = 0;
  for (int i = 0; i < 6; i++) {
    sum += a[i] * 0;
  }
  return sum == 0;
}

static int add_term(qn_drawing *m, const qn_draft *d) {
  qn_normal *n = m->n;
  if (!qn_grow(m->mem, &n->terms, &n->term_capacity, n->term_count + 1) || !qn_grow(m->mem, &n->leaves, &n->leaf_capacity, n->leaf_count + d->leaves)) {
    return qn_draw_refuse(m);
  }
  qn_nterm *t = &n->terms[n->term_count++];
  *t = (qn_nterm){.leaf0 = (uint32_t)n->leaf_count, .leaves = d->leaves, .plus0 = d->plus0, .plus = d->plus, .minus0 = d->minus0, .minus = d->minus};
  for (int i = 0; i < 3; i++) {
    t->min[i] = qn_round_down(d->min[i]), t->max[i] = qn_round_up(d->max[i]);
  }
  memcpy(n->leaves + n->leaf_count, m->names + d->leaf0, d->leaves * sizeof *n->leaves);
  n->leaf_count += d->leaves;
  m->instances += d->leaves;
  return 1;
}

/* A hierarchy of few terms is one node. */
static void one_node(qn_bvh_node *node, const qn_nterm *terms, uint32_t term0, size_t count) {
  memset(node, 0, sizeof *node); /* padding too: equal scenes are equal bytes */
  for (size_t i = 0; i < QN_BVH_WIDE; i++) {
    for (int k = 0; k < 3; k++) {
      node->min[k][i] = i < count ? terms[term0 + i].min[k] : INFINITY;
      node->max[k][i] = i < count ? terms[term0 + i].max[k] : -INFINITY;
    }
    node->child[i] = i < count ? QN_BVH_LEAF | (uint32_t)(term0 + i) : QN_BVH_LEAF;
  }
}

quoin_status qn_build_over(qn_drawing *m, qn_bvh *bvh, size_t count, double (*boxes)[6]) {
  uint32_t *numbers = qn_alloc(m->mem, count * sizeof *numbers);
  if (!numbers) {
    return QUOIN_E_MEMORY;
  }
  for (size_t i = 0; i < count; i++) {
    numbers[i] = (uint32_t)i;
  }
  quoin_status s = qn_bvh_build(bvh, m->mem, count, (const double (*)[6])boxes, numbers, m->threads);
  qn_free(m->mem, numbers, count * sizeof *numbers);
  return s;
}

/* Room for `more` nodes, each a whole number of cache lines. */
static int grow_nodes(qn_drawing *m, size_t more) {
  qn_normal *n = m->n;
  size_t want = n->node_count + more;
  if (want <= n->node_capacity) {
    return 1;
  }
  size_t room = n->node_capacity + n->node_capacity / 2;
  room = room < want ? want : room;
  qn_bvh_node *moved = room < SIZE_MAX / sizeof *moved ? qn_alloc_line(m->mem, room * sizeof *moved) : NULL;
  if (!moved || want >= QN_BVH_LEAF) {
    qn_free_line(m->mem, moved, room * sizeof *moved);
    return qn_draw_refuse(m);
  }
  if (n->nodes) {
    memcpy(moved, n->nodes, n->node_count * sizeof *moved);
    qn_free_line(m->mem, n->nodes, n->node_capacity * sizeof *moved);
  }
  n->nodes = moved;
  n->node_capacity = room;
  return 1;
}

uint32_t qn_union_make(qn_drawing *m, size_t first) {
  qn_normal *n = m->n;
  size_t count = m->draft_count - first, narrow = 0;
  if (count == 0 || m->status) {
    return QN_NO_UNION;
  }
  for (size_t i = first; i < m->draft_count; i++) { /* the unbounded ones last */
    const double b[6] = {m->drafts[i].min[0], m->drafts[i].min[1], m->drafts[i].min[2], m->drafts[i].max[0], m->drafts[i].max[1], m->drafts[i].max[2]};
    if (qn_box_is_finite(b)) {
      qn_draft d = m->drafts[i];
      m->drafts[i] = m->drafts[first + narrow];
      m->drafts[first + narrow++] = d;
    }
  }
  if (!qn_grow(m->mem, &n->unions, &n->union_capacity, n->union_count + 1)) {
    return qn_draw_refuse(m), QN_NO_UNION;
  }
  qn_union u = {.root = QN_NO_ROOT, .term0 = (uint32_t)n->term_count, .terms = (uint32_t)narrow};
  int made = 1;
  if (narrow > QN_BVH_WIDE) {
    double (*boxes)[6] = qn_alloc(m->mem, narrow * sizeof *boxes);
    qn_bvh bvh = {0};
    made = boxes != NULL || qn_draw_refuse(m);
    for (size_t i = 0; made && i < narrow; i++) {
      memcpy(boxes[i], m->drafts[first + i].min, 3 * sizeof(double));
      memcpy(boxes[i] + 3, m->drafts[first + i].max, 3 * sizeof(double));
    }
    if (made && qn_build_over(m, &bvh, narrow, boxes) != QUOIN_OK) {
      made = qn_draw_refuse(m);
    }
    qn_free(m->mem, boxes, narrow * sizeof *boxes);
    made = made && grow_nodes(m, bvh.node_count);
    if (made) {
      u.root = (uint32_t)n->node_count;
      for (size_t i = 0; i < bvh.node_count; i++) {
        qn_bvh_node node = bvh.nodes[i];
        for (int c = 0; c < QN_BVH_WIDE; c++) {
          node.child[c] += node.child[c] & QN_BVH_LEAF ? u.term0 : u.root;
        }
        n->nodes[n->node_count + i] = node;
      }
      n->node_count += bvh.node_count;
      for (size_t i = 0; made && i < narrow; i++) {
        made = add_term(m, &m->drafts[first + bvh.items[i]]);
      }
    }
    qn_bvh_free(&bvh, m->mem);
  } else if (narrow) {
    for (size_t i = 0; made && i < narrow; i++) {
      made = add_term(m, &m->drafts[first + i]);
    }
    made = made && grow_nodes(m, 1);
    if (made) {
      u.root = (uint32_t)n->node_count;
      one_node(&n->nodes[n->node_count++], n->terms, u.term0, narrow);
    }
  }
  u.wide0 = (uint32_t)n->term_count;
  u.wide = (uint32_t)(count - narrow);
  for (size_t i = narrow; made && i < count; i++) {
    made = add_term(m, &m->drafts[first + i]);
  }
  m->name_count = m->drafts[first].leaf0;
  for (size_t i = first; i < m->draft_count; i++) {
    m->name_count = m->drafts[i].leaf0 < m->name_count ? m->drafts[i].leaf0 : m->name_count;
  }
  m->draft_count = first;
  if (!made || n->term_count >= QN_BVH_LEAF) {
    return qn_draw_refuse(m), QN_NO_UNION;
  }
  n->unions[n->union_count] = u;
  return (uint32_t)n->union_count++;
}

int qn_list_extend(qn_drawing *m, uint32_t *list0, uint32_t *count, const uint32_t *more, uint32_t more_count) {
  qn_normal *n = m->n;
  if (more_count == 0) {
    return 1;
  }
  size_t at = n->list_count;
  if (*count && *list0 + *count == at) {
    at = *list0;
  }
  uint32_t keep[8];
  const uint32_t *from = more;
  if (more_count <= 8) { /* `more` may point into the list that grows */
    memcpy(keep, more, more_count * sizeof *keep);
    from = keep;
  }
  size_t from_list = more_count > 8 && more >= n->lists && more < n->lists + n->list_count ? (size_t)(more - n->lists) : SIZE_MAX;
  if (!qn_grow(m->mem, &n->lists, &n->list_capacity, n->list_count + *count + more_count)) {
    return qn_draw_refuse(m);
  }
  if (from_list != SIZE_MAX) {
    from = n->lists + from_list;
  }
  if (at == n->list_count && *count) {
    memcpy(n->lists + at, n->lists + *list0, *count * sizeof *n->lists);
    n->list_count += *count;
  }
  *list0 = (uint32_t)at;
  memcpy(n->lists + n->list_count, from, more_count * sizeof *n->lists);
  n->list_count += more_count;
  *count += more_count;
  return 1;
}
