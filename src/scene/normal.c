/* The normal form of a scene: of a union of leaves from the hierarchy that is there, of anything else drawn from the root. */
#include "scene/draw.h"

#include "base/thread.h"

#include <math.h>

/* --- a union of leaves ------------------------------------------------------------------------------------------------ */

/* The commonest scene: a union of leaves, and the hierarchy over them is there already. */
static int is_leaf_union(const quoin_scene *s) {
  const qn_gate *root = &s->program.gates[0]; /* every leaf is its child; base counts the negated ones; a meet of these is a union's complement */
  return s->program.gate_count == 1 && root->base == (root->is_and ? root->kids : 0) && s->leaf_count > 0 && s->bvh.node_count &&
         s->bvh.item_count + s->unbounded_count == s->leaf_count;
}

enum { STRETCH = 1024 }; /* nodes a thread takes at once */

/* The terms below a stretch of nodes; their boxes are the leaves', rounded as the nodes have them. */
static quoin_status terms_of_nodes(void *user, unsigned thread, size_t number) {
  (void)thread;
  const qn_drawing *m = user;
  const qn_bvh *bvh = &m->scene->bvh;
  size_t end = (number + 1) * STRETCH < bvh->node_count ? (number + 1) * STRETCH : bvh->node_count;
  for (size_t i = number * STRETCH; i < end; i++) {
    const qn_bvh_node *node = &bvh->nodes[i];
    for (int c = 0; c < QN_BVH_WIDE; c++) {
      uint32_t at = node->child[c] & ~QN_BVH_LEAF;
      if (node->child[c] == QN_BVH_NONE || !(node->child[c] & QN_BVH_LEAF)) {
        continue;
      }
      m->n->leaves[at] = bvh->items[at];
      m->n->terms[at] = (qn_nterm){.min = {node->min[0][c], node->min[1][c], node->min[2][c]},
                                   .max = {node->max[0][c], node->max[1][c], node->max[2][c]}, .leaf0 = at, .leaves = 1};
    }
  }
  return QUOIN_OK;
}

static quoin_status leaf_union(qn_drawing *m) {
  qn_normal *n = m->n;
  const quoin_scene *s = m->scene;
  size_t narrow = s->bvh.item_count;
  if (s->leaf_count >= QN_BVH_LEAF) {
    return QUOIN_E_LIMIT;
  }
  if (!qn_grow(m->mem, &n->unions, &n->union_capacity, 1)) {
    return QUOIN_E_MEMORY;
  }
  n->terms = qn_alloc(m->mem, s->leaf_count * sizeof *n->terms);
  n->term_count = n->term_capacity = s->leaf_count;
  n->leaves = qn_alloc(m->mem, s->leaf_count * sizeof *n->leaves);
  n->leaf_count = n->leaf_capacity = s->leaf_count;
  if (!n->terms || !n->leaves) {
    return QUOIN_E_MEMORY;
  }
  n->nodes = s->bvh.nodes;
  n->node_count = n->node_capacity = s->bvh.node_count;
  n->borrowed = 1;
  n->unions[n->union_count++] = (qn_union){.root = 0, .terms = (uint32_t)narrow, .wide0 = (uint32_t)narrow, .wide = (uint32_t)s->unbounded_count};
  for (size_t i = 0; i < s->unbounded_count; i++) {
    const qn_leaf *l = &s->leaves[s->unbounded[i]];
    n->leaves[narrow + i] = s->unbounded[i];
    n->terms[narrow + i] = (qn_nterm){.min = {qn_round_down(l->min[0]), qn_round_down(l->min[1]), qn_round_down(l->min[2])},
                                      .max = {qn_round_up(l->max[0]), qn_round_up(l->max[1]), qn_round_up(l->max[2])}, .leaf0 = (uint32_t)(narrow + i), .leaves = 1};
  }
  n->made = 1;
  return qn_parallel(m->threads, (s->bvh.node_count + STRETCH - 1) / STRETCH, terms_of_nodes, m, NULL);
}

/* --- the whole --------------------------------------------------------------------------------------------------------- */

/* NOLINTNEXTLINE(misc-no-recursion): as deep as QN_NORMAL_DEPTH */
static int is_union_of_leaves(const qn_drawing *m, uint32_t set) {
  int leaves = set >= m->gates || m->joins[set];
  for (uint32_t i = set < m->gates && leaves ? m->kid0[set] : 0; set < m->gates && leaves && i < m->kid0[set + 1]; i++) {
    leaves = is_union_of_leaves(m, m->kids[i]);
  }
  return leaves;
}

static int are_kin(const qn_drawing *m) {
  int met = 0, leaves = !m->joins[0];
  for (uint32_t i = m->kid0[0]; leaves && i < m->kid0[1]; i++) {
    const int is_met = qn_set_is_met(m, 0, m->kids[i]);
    met += is_met;
    leaves = !is_met || is_union_of_leaves(m, m->kids[i]);
  }
  return leaves && met == 1;
}

static void from_root(qn_drawing *m) {
  static const double all[6] = {-INFINITY, -INFINITY, -INFINITY, INFINITY, INFINITY, INFINITY};
  qn_normal *n = m->n;
  if (m->kid0[1] != m->kid0[0] && !qn_draw(m, 0, all)) {
    return;
  }
  n->kin = m->kid0[1] != m->kid0[0] && are_kin(m);
  n->root = qn_union_make(m, 0);
  if (!m->status && n->root == QN_NO_UNION) { /* nothing: a union of no terms */
    if (!qn_grow(m->mem, &n->unions, &n->union_capacity, n->union_count + 1)) {
      qn_draw_refuse(m);
      return;
    }
    n->unions[n->union_count] = (qn_union){.root = QN_NO_ROOT};
    n->root = (uint32_t)n->union_count++;
  }
  n->made = !m->status;
  n->copies = n->leaf_count > m->scene->leaf_count ? n->leaf_count - m->scene->leaf_count : 0;
}

quoin_status qn_normal_build(qn_normal *normal, const struct quoin_scene *scene, qn_mem *mem, unsigned threads) {
  return qn_normal_build_within(normal, scene, mem, threads, QN_COPY_BUDGET * scene->leaf_count + QN_COPY_FLOOR);
}

quoin_status qn_normal_build_within(qn_normal *normal, const struct quoin_scene *scene, qn_mem *mem, unsigned threads, size_t budget) {
  *normal = (qn_normal){0};
  qn_drawing m = {.scene = scene, .mem = mem, .n = normal, .threads = threads, .gates = scene->program.gate_count, .budget = budget};
  if (is_leaf_union(scene)) {
    normal->complement = scene->program.gates[0].is_and;
    m.status = leaf_union(&m);
  } else if (qn_sets_read(&m)) {
    normal->complement = m.truth[0];
    from_root(&m);
  }
  qn_sets_free(&m);
  qn_free(mem, m.drafts, m.draft_capacity * sizeof *m.drafts);
  qn_free(mem, m.names, m.name_capacity * sizeof *m.names);
  if (m.status) {
    qn_normal_free(normal, mem);
  }
  return m.status;
}

void qn_normal_free(qn_normal *n, qn_mem *mem) {
  qn_free(mem, n->terms, n->term_capacity * sizeof *n->terms);
  qn_free(mem, n->leaves, n->leaf_capacity * sizeof *n->leaves);
  qn_free(mem, n->lists, n->list_capacity * sizeof *n->lists);
  qn_free(mem, n->unions, n->union_capacity * sizeof *n->unions);
  if (!n->borrowed) {
    qn_free_line(mem, n->nodes, n->node_capacity * sizeof *n->nodes);
  }
  *n = (qn_normal){0};
}

size_t qn_normal_bytes(const qn_normal *n) {
  return n->term_capacity * sizeof *n->terms + n->leaf_capacity * sizeof *n->leaves + n->list_capacity * sizeof *n->lists +
         n->union_capacity * sizeof *n->unions + (n->borrowed ? 0 : n->node_capacity * sizeof *n->nodes);
}
