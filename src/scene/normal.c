#include "scene/normal.h"

#include "base/thread.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

/* Legend: a set is a gate's set or a leaf, numbered gates first: set s < gate_count is a gate, else leaf s - gate_count. A draft is
   a term being made; drafts, and the leaves they name, live on two stacks that a union's making pops. */

typedef struct draft {
  double min[3], max[3];
  uint32_t leaf0, leaves; /* on the stack of leaves */
  uint32_t plus0, plus, minus0, minus; /* in normal->lists */
} draft;

typedef struct index {  /* a hierarchy over a gate's children that are taken away or met with */
  qn_bvh bvh;
  uint32_t *sets;       /* by item number */
  size_t count, capacity;
  uint32_t *open; size_t open_count; /* sets without a bounded box */
} index;

typedef struct maker {
  const struct quoin_scene *scene;
  qn_mem *mem;
  qn_normal *n;
  unsigned threads;
  size_t gates;
  uint32_t *kid0, *kids;  /* by gate: its children's sets, kids[kid0[g]] to kids[kid0[g + 1]] */
  double (*box)[6];       /* by gate */
  uint32_t *shared;       /* by gate: the union of what a meet takes away, made once; by gate + gates: the gate's own set */
  uint8_t *truth;         /* by gate: true with every leaf outside */
  draft *drafts; size_t draft_count, draft_capacity;
  uint32_t *names; size_t name_count, name_capacity;
  size_t instances, budget;
  quoin_status status;
} maker;

#define NONE UINT32_MAX

static int refuse(maker *m) {
  m->status = QUOIN_E_MEMORY;
  return 0;
}

/* --- the gates, read as sets ---------------------------------------------------------------------------------------- */

static int set_is_true(const maker *m, uint32_t set) { /* with every leaf outside */
  return set < m->gates ? m->truth[set] : m->scene->leaves[set - m->gates].negated;
}

static void set_box(const maker *m, uint32_t set, double box[6]) {
  if (set < m->gates) {
    memcpy(box, m->box[set], 6 * sizeof *box);
  } else {
    const qn_leaf *l = &m->scene->leaves[set - m->gates];
    memcpy(box, l->min, sizeof l->min);
    memcpy(box + 3, l->max, sizeof l->max);
  }
}

/* The set is a union of all its children's; else a meet of those children of which `is_met` is true minus the others. */
static int set_is_union(const maker *m, uint32_t gate) {
  for (uint32_t i = m->kid0[gate]; i < m->kid0[gate + 1]; i++) {
    if (set_is_true(m, m->kids[i]) != (m->scene->program.gates[gate].is_and != 0)) {
      return 0;
    }
  }
  return 1;
}
static int is_met(const maker *m, uint32_t gate, uint32_t kid) {
  return set_is_true(m, kid) != (m->scene->program.gates[gate].is_and != 0);
}

static int boxes_meet(const double a[6], const double b[6]) {
  return a[0] <= b[3] && b[0] <= a[3] && a[1] <= b[4] && b[1] <= a[4] && a[2] <= b[5] && b[2] <= a[5];
}
static void box_meet(double a[6], const double b[6]) {
  for (int i = 0; i < 3; i++) {
    a[i] = fmax(a[i], b[i]), a[3 + i] = fmin(a[3 + i], b[3 + i]);
  }
}
static void box_join(double a[6], const double b[6]) {
  for (int i = 0; i < 3; i++) {
    a[i] = fmin(a[i], b[i]), a[3 + i] = fmax(a[3 + i], b[3 + i]);
  }
}
static int box_is_finite(const double a[6]) {
  double sum = 0;
  for (int i = 0; i < 6; i++) {
    sum += a[i] * 0;
  }
  return sum == 0;
}

static int read_gates(maker *m) {
  const qn_program *p = &m->scene->program;
  size_t leaves = m->scene->leaf_count;
  m->kid0 = qn_alloc_zeroed(m->mem, (m->gates + 2) * sizeof *m->kid0);
  m->kids = qn_alloc(m->mem, (m->gates + leaves) * sizeof *m->kids);
  m->box = qn_alloc(m->mem, m->gates * sizeof *m->box);
  m->shared = qn_alloc(m->mem, 2 * m->gates * sizeof *m->shared);
  m->truth = qn_alloc(m->mem, m->gates);
  uint32_t *depth = qn_alloc_zeroed(m->mem, m->gates * sizeof *depth);
  if (!m->kid0 || !m->kids || !m->box || !m->shared || !m->truth || !depth) {
    qn_free(m->mem, depth, m->gates * sizeof *depth);
    return refuse(m);
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
    int join = set_is_union(m, (uint32_t)g);
    for (int i = 0; i < 6; i++) {
      box[i] = (i < 3) == join ? INFINITY : -INFINITY;
    }
    for (uint32_t i = m->kid0[g]; i < m->kid0[g + 1]; i++) {
      double kid[6];
      set_box(m, m->kids[i], kid);
      if (join) {
        box_join(box, kid);
      } else if (is_met(m, (uint32_t)g, m->kids[i])) {
        box_meet(box, kid);
      }
    }
  }
  return 1;
}

/* --- unions --------------------------------------------------------------------------------------------------------- */

static int add_term(maker *m, const draft *d) {
  qn_normal *n = m->n;
  if (!qn_grow(m->mem, &n->terms, &n->term_capacity, n->term_count + 1) || !qn_grow(m->mem, &n->leaves, &n->leaf_capacity, n->leaf_count + d->leaves)) {
    return refuse(m);
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
  for (size_t i = 0; i < QN_BVH_WIDE; i++) {
    for (int k = 0; k < 3; k++) {
      node->min[k][i] = i < count ? terms[term0 + i].min[k] : INFINITY;
      node->max[k][i] = i < count ? terms[term0 + i].max[k] : -INFINITY;
    }
    node->child[i] = i < count ? QN_BVH_LEAF | (uint32_t)(term0 + i) : QN_BVH_LEAF;
  }
}

static quoin_status build_over(maker *m, qn_bvh *bvh, size_t count, double (*boxes)[6]) {
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
static int grow_nodes(maker *m, size_t more) {
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
    return refuse(m);
  }
  if (n->nodes) {
    memcpy(moved, n->nodes, n->node_count * sizeof *moved);
    qn_free_line(m->mem, n->nodes, n->node_capacity * sizeof *moved);
  }
  n->nodes = moved;
  n->node_capacity = room;
  return 1;
}

/* Makes a union of the drafts from `first` on and pops them. Returns its number, or NONE for an empty one or on refusal. */
static uint32_t make_union(maker *m, size_t first) {
  qn_normal *n = m->n;
  size_t count = m->draft_count - first, narrow = 0;
  if (count == 0 || m->status) {
    return NONE;
  }
  for (size_t i = first; i < m->draft_count; i++) { /* the unbounded ones last */
    const double b[6] = {m->drafts[i].min[0], m->drafts[i].min[1], m->drafts[i].min[2], m->drafts[i].max[0], m->drafts[i].max[1], m->drafts[i].max[2]};
    if (box_is_finite(b)) {
      draft d = m->drafts[i];
      m->drafts[i] = m->drafts[first + narrow];
      m->drafts[first + narrow++] = d;
    }
  }
  if (!qn_grow(m->mem, &n->unions, &n->union_capacity, n->union_count + 1)) {
    return refuse(m), NONE;
  }
  qn_union u = {.root = QN_NO_ROOT, .term0 = (uint32_t)n->term_count, .terms = (uint32_t)narrow};
  int made = 1;
  if (narrow > QN_BVH_WIDE) {
    double (*boxes)[6] = qn_alloc(m->mem, narrow * sizeof *boxes);
    qn_bvh bvh = {0};
    made = boxes != NULL || refuse(m);
    for (size_t i = 0; made && i < narrow; i++) {
      memcpy(boxes[i], m->drafts[first + i].min, 3 * sizeof(double));
      memcpy(boxes[i] + 3, m->drafts[first + i].max, 3 * sizeof(double));
    }
    if (made && build_over(m, &bvh, narrow, boxes) != QUOIN_OK) {
      made = refuse(m);
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
    return refuse(m), NONE;
  }
  n->unions[n->union_count] = u;
  return (uint32_t)n->union_count++;
}

/* Appends `more` to a list of unions; lists are never changed once another follows, so the old part is copied. */
static int extend(maker *m, uint32_t *list0, uint32_t *count, const uint32_t *more, uint32_t more_count) {
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
    return refuse(m);
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

/* --- drafts --------------------------------------------------------------------------------------------------------- */

static int push(maker *m, const draft *d) {
  if (m->status || !qn_grow(m->mem, &m->drafts, &m->draft_capacity, m->draft_count + 1)) {
    return refuse(m);
  }
  m->drafts[m->draft_count++] = *d;
  return 1;
}
static int push_name(maker *m, uint32_t leaf) {
  if (!qn_grow(m->mem, &m->names, &m->name_capacity, m->name_count + 1)) {
    return refuse(m);
  }
  m->names[m->name_count++] = leaf;
  return 1;
}

static int draw(maker *m, uint32_t set, const double clip[6]);

/* --- a gate's children by box ----------------------------------------------------------------------------------------- */

static void index_free(maker *m, index *x) {
  qn_bvh_free(&x->bvh, m->mem);
  qn_free(m->mem, x->sets, x->capacity * sizeof *x->sets);
}

/* Lists sets, the children of unions in their place, and puts a hierarchy over them when it will be asked often. */
static int index_make(maker *m, const uint32_t *list, size_t list_count, size_t asked, index *x) {
  for (size_t i = 0; i < list_count; i++) {
    uint32_t set = list[i];
    int open = set < m->gates && set_is_union(m, set);
    const uint32_t *from = open ? m->kids + m->kid0[set] : &list[i];
    size_t count = open ? m->kid0[set + 1] - m->kid0[set] : 1;
    if (!qn_grow(m->mem, &x->sets, &x->capacity, x->count + count)) {
      return refuse(m);
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
    return refuse(m);
  }
  for (size_t i = 0; i < x->count; i++) {
    set_box(m, x->sets[i], boxes[narrow]);
    if (box_is_finite(boxes[narrow])) {
      uint32_t s = x->sets[i];
      memmove(x->sets + narrow + 1, x->sets + narrow, (i - narrow) * sizeof s);
      x->sets[narrow++] = s;
    }
  }
  x->open = x->sets + narrow;
  x->open_count = x->count - narrow;
  quoin_status s = build_over(m, &x->bvh, narrow, boxes);
  qn_free(m->mem, boxes, x->count * sizeof *boxes);
  return s == QUOIN_OK || refuse(m);
}

typedef struct listing { maker *m; const index *x; uint32_t *found; size_t count, capacity; int failed; } listing;
static void list_one(void *user, uint32_t item) {
  listing *l = user;
  if (!qn_grow(l->m->mem, &l->found, &l->capacity, l->count + 1)) {
    l->failed = 1;
    return;
  }
  l->found[l->count++] = l->x->sets[item];
}

/* Draws the indexed sets that meet a box. */
static int draw_indexed(maker *m, const index *x, const double clip[6]) {
  if (!x->bvh.nodes) {
    for (size_t i = 0; i < x->count; i++) {
      if (!draw(m, x->sets[i], clip)) {
        return 0;
      }
    }
    return 1;
  }
  for (size_t i = 0; i < x->open_count; i++) {
    if (!draw(m, x->open[i], clip)) {
      return 0;
    }
  }
  listing l = {.m = m, .x = x};
  uint64_t nodes = 0;
  qn_bvh_point(&x->bvh, clip, clip + 3, list_one, &l, &nodes);
  int good = !l.failed || refuse(m);
  for (size_t i = 0; good && i < l.count; i++) {
    good = draw(m, l.found[i], clip);
  }
  qn_free(m->mem, l.found, l.capacity * sizeof *l.found);
  return good;
}

/* --- a meet ----------------------------------------------------------------------------------------------------------- */

/* The union of some sets, unclipped, made once: what is left to do when copies have run out. */
static uint32_t share(maker *m, uint32_t *slot, const uint32_t *sets, size_t count, const double clip[6]) {
  if (*slot == NONE) {
    size_t first = m->draft_count;
    for (size_t i = 0; i < count; i++) {
      if (!draw(m, sets[i], clip)) {
        return NONE;
      }
    }
    *slot = make_union(m, first);
    m->n->shared++;
  }
  return *slot;
}

static int multiply(maker *m, size_t first, uint32_t set) {
  size_t end = m->draft_count;
  index x = {0};
  int good = index_make(m, &set, 1, end - first, &x);
  for (size_t i = first; good && i < end; i++) {
    draft left = m->drafts[i];
    if (m->instances + m->name_count > m->budget && set < m->gates) {
      static const double all[6] = {-INFINITY, -INFINITY, -INFINITY, INFINITY, INFINITY, INFINITY};
      uint32_t u = share(m, &m->shared[m->gates + set], &set, 1, all);
      if (m->status) {
        good = 0;
      } else if (u != NONE) {
        good = extend(m, &left.plus0, &left.plus, &u, 1) && push(m, &left);
      }
      continue;
    }
    size_t from = m->draft_count;
    const double clip[6] = {left.min[0], left.min[1], left.min[2], left.max[0], left.max[1], left.max[2]};
    good = draw_indexed(m, &x, clip);
    for (size_t j = from; good && j < m->draft_count; j++) {
      draft d = m->drafts[j];
      uint32_t leaf0 = (uint32_t)m->name_count;
      for (uint32_t k = 0; good && k < left.leaves; k++) {
        good = push_name(m, m->names[left.leaf0 + k]);
      }
      for (uint32_t k = 0; good && k < d.leaves; k++) {
        good = push_name(m, m->names[d.leaf0 + k]);
      }
      uint32_t plus0 = left.plus0, plus = left.plus, minus0 = left.minus0, minus = left.minus;
      good = good && extend(m, &plus0, &plus, d.plus ? m->n->lists + d.plus0 : NULL, d.plus);
      good = good && extend(m, &minus0, &minus, d.minus ? m->n->lists + d.minus0 : NULL, d.minus);
      m->drafts[j] = (draft){{d.min[0], d.min[1], d.min[2]}, {d.max[0], d.max[1], d.max[2]}, leaf0, left.leaves + d.leaves, plus0, plus, minus0, minus};
    }
  }
  index_free(m, &x);
  if (good) {
    memmove(m->drafts + first, m->drafts + end, (m->draft_count - end) * sizeof *m->drafts);
    m->draft_count -= end - first;
  }
  return good;
}

static int draw_meet(maker *m, uint32_t gate, const double clip[6]) {
  size_t first = m->draft_count, all = m->kid0[gate + 1] - m->kid0[gate], met = 0;
  uint32_t *sets = qn_alloc(m->mem, all * sizeof *sets);
  if (!sets) {
    return refuse(m);
  }
  for (int leaf = 1; leaf >= 0; leaf--) { /* leaves first: they clip the rest */
    for (uint32_t i = m->kid0[gate]; i < m->kid0[gate + 1]; i++) {
      uint32_t k = m->kids[i];
      if (is_met(m, gate, k) && (k >= m->gates) == leaf) {
        sets[met++] = k;
      }
    }
  }
  size_t taken = met;
  for (uint32_t i = m->kid0[gate]; i < m->kid0[gate + 1]; i++) {
    if (!is_met(m, gate, m->kids[i])) {
      sets[taken++] = m->kids[i];
    }
  }
  int good = met > 0 ? draw(m, sets[0], clip) : 0;
  for (size_t i = 1; good && i < met; i++) {
    good = multiply(m, first, sets[i]);
  }
  if (good && all > met) {
    index x = {0};
    size_t end = m->draft_count;
    good = index_make(m, sets + met, all - met, end - first, &x);
    for (size_t i = first; good && i < end; i++) {
      draft d = m->drafts[i];
      uint32_t u;
      if (m->instances + m->name_count > m->budget && end - first > 1) {
        u = share(m, &m->shared[gate], sets + met, all - met, m->box[gate]);
      } else {
        const double box[6] = {d.min[0], d.min[1], d.min[2], d.max[0], d.max[1], d.max[2]};
        size_t from = m->draft_count;
        good = draw_indexed(m, &x, box);
        u = good ? make_union(m, from) : NONE;
      }
      good = good && !m->status && (u == NONE || extend(m, &d.minus0, &d.minus, &u, 1));
      m->drafts[i] = d;
    }
    index_free(m, &x);
  }
  qn_free(m->mem, sets, all * sizeof *sets);
  return good && !m->status;
}

/* Pushes drafts whose union is the set within `clip`. Depth is bounded by QN_NORMAL_DEPTH. */
static int draw(maker *m, uint32_t set, const double clip[6]) {
  double box[6];
  set_box(m, set, box);
  if (!boxes_meet(box, clip)) {
    return 1;
  }
  if (set >= m->gates) {
    box_meet(box, clip);
    draft d = {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}, (uint32_t)m->name_count, 1, 0, 0, 0, 0};
    return push_name(m, (uint32_t)(set - m->gates)) && push(m, &d);
  }
  if (set_is_union(m, set)) {
    for (uint32_t i = m->kid0[set]; i < m->kid0[set + 1]; i++) {
      if (!draw(m, m->kids[i], clip)) {
        return 0;
      }
    }
    return 1;
  }
  return draw_meet(m, set, clip);
}

/* --- a union of leaves ------------------------------------------------------------------------------------------------ */

/* The commonest scene: a union of leaves, and the hierarchy over them is there already. */
static int is_plain_union(const maker *m) {
  const quoin_scene *s = m->scene;
  return m->gates == 1 && s->leaf_count > 0 && s->bvh.item_count + s->unbounded_count == s->leaf_count && s->bvh.node_count && set_is_union(m, 0);
}

enum { STRETCH = 1024 }; /* nodes a thread takes at once */

/* The terms below a stretch of nodes; their boxes are the leaves', rounded as the nodes have them. */
static quoin_status terms_of_nodes(void *user, unsigned thread, size_t number) {
  (void)thread;
  const maker *m = user;
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

static quoin_status plain_union(maker *m) {
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

static void from_root(maker *m) {
  static const double all[6] = {-INFINITY, -INFINITY, -INFINITY, INFINITY, INFINITY, INFINITY};
  qn_normal *n = m->n;
  if (m->kid0[1] != m->kid0[0] && !draw(m, 0, all)) {
    return;
  }
  n->root = make_union(m, 0);
  if (!m->status && n->root == NONE) { /* nothing: a union of no terms */
    if (!qn_grow(m->mem, &n->unions, &n->union_capacity, n->union_count + 1)) {
      refuse(m);
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
  maker m = {.scene = scene, .mem = mem, .n = normal, .threads = threads, .gates = scene->program.gate_count, .budget = budget};
  if (read_gates(&m)) {
    normal->complement = m.truth[0];
    if (is_plain_union(&m)) {
      m.status = plain_union(&m);
    } else {
      from_root(&m);
    }
  }
  size_t gates = m.gates;
  qn_free(mem, m.kid0, (gates + 2) * sizeof *m.kid0);
  qn_free(mem, m.kids, (gates + scene->leaf_count) * sizeof *m.kids);
  qn_free(mem, m.box, gates * sizeof *m.box);
  qn_free(mem, m.shared, 2 * gates * sizeof *m.shared);
  qn_free(mem, m.truth, gates);
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
