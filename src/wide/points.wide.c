/* The points' body: where each of a batch of points lies. Compiled once for each instruction set.

   Many questions "is this point in that union" walk the hierarchies together. A walk keeps entries (question, node) on a stack and takes them
   off in runs: whatever a run's nodes give, children and terms, is appended without a branch, so that neither a mispredicted branch nor a
   memory access holds up the next entry. Points need not lie together for that. A question whose answer is "surely in" asks no more.

   Kleene's logic holds throughout: a union is the largest of its terms' verdicts, a meet the least, a complement the mirror image. What is
   sure stays sure whatever the exact answer to what is not. A term's questions to the unions that it is met with, or that are taken away, are
   walked together as well, one level of nesting at a time (at most QN_NORMAL_DEPTH). */
#include "wide/points.h"

#include "wide/inside.h"
#include "wide/vec.h"

#include <stddef.h>
#include <string.h>

enum {
  RUN = 32,                 /* entries taken at once */
  FEW = 2,                  /* terms of a union that are asked without its hierarchy */
  PAIRS = 8 * RUN /* QN_BVH_WIDE a node: questions and terms that a run gives, at most */
};
_Static_assert(sizeof(qn_nterm) >= 32 && offsetof(qn_nterm, max) == 12, "both corners of a term's box can be read as four floats");
_Static_assert((int)PAIRS <= (int)QN_POINTS && (int)PAIRS == (int)QN_BVH_WIDE * (int)RUN, "a run's terms can all be asked about at once");

typedef struct walk {
  const struct quoin_scene *scene;
  const double *points, *weights;
  qn_point_walk *room;
  size_t top; /* entries on the stack */
  qn_wide_counts counts;
} walk;

#define NOWHERE (UINT32_MAX - 1) /* the cell of a question that is not asked of a grid */

QN_INLINE qn_wide_point point_of(const walk *w, size_t i) {
  return (qn_wide_point){w->points + 3 * i, w->weights[i]};
}

/* n questions: is point[i] in the union un[i]? */
typedef struct questions { size_t n; uint32_t point[QN_POINTS], un[QN_POINTS]; uint8_t verdict[QN_POINTS]; } questions;

/* --- a node's children that may hold a point -------------------------------------------------------------------------- */

#if defined(QN_ISA_AVX512)
QN_INLINE unsigned children_at(const qn_bvh_node *n, const float box[8]) {
  __mmask8 m = _mm256_cmp_ps_mask(_mm256_load_ps(n->min[0]), _mm256_set1_ps(box[4]), _CMP_LE_OQ);
  m = _mm256_mask_cmp_ps_mask(m, _mm256_load_ps(n->max[0]), _mm256_set1_ps(box[0]), _CMP_GE_OQ);
  m = _mm256_mask_cmp_ps_mask(m, _mm256_load_ps(n->min[1]), _mm256_set1_ps(box[5]), _CMP_LE_OQ);
  m = _mm256_mask_cmp_ps_mask(m, _mm256_load_ps(n->max[1]), _mm256_set1_ps(box[1]), _CMP_GE_OQ);
  m = _mm256_mask_cmp_ps_mask(m, _mm256_load_ps(n->min[2]), _mm256_set1_ps(box[6]), _CMP_LE_OQ);
  return _mm256_mask_cmp_ps_mask(m, _mm256_load_ps(n->max[2]), _mm256_set1_ps(box[2]), _CMP_GE_OQ);
}
#elif defined(QN_ISA_AVX2)
QN_INLINE unsigned children_at(const qn_bvh_node *n, const float box[8]) {
  __m256 m[3];
  for (int i = 0; i < 3; i++) {
    m[i] = _mm256_and_ps(_mm256_cmp_ps(_mm256_load_ps(n->min[i]), _mm256_set1_ps(box[4 + i]), _CMP_LE_OQ),
                         _mm256_cmp_ps(_mm256_load_ps(n->max[i]), _mm256_set1_ps(box[i]), _CMP_GE_OQ));
  }
  return (unsigned)_mm256_movemask_ps(_mm256_and_ps(_mm256_and_ps(m[0], m[1]), m[2]));
}
#else
QN_INLINE unsigned children_at(const qn_bvh_node *n, const float box[8]) {
  unsigned m = 0xff;
  for (int i = 0; i < 3; i++) {
    m &= fle(fload(n->min[i]), fset(box[4 + i])) & fle(fset(box[i]), fload(n->max[i]));
  }
  return m;
}
#endif

/* Appends the child numbers of the slots in m, and `query` as often, at place `at` of two arrays with eight entries of room. */
#if defined(QN_ISA_AVX512)
QN_INLINE void append(const uint32_t child[8], unsigned m, uint32_t query, uint32_t *queries, uint32_t *numbers, size_t at) {
  __m256i packed = _mm256_maskz_compress_epi32((__mmask8)m, _mm256_load_si256((const void *)child));
  _mm256_storeu_si256((void *)(numbers + at), packed);
  _mm256_storeu_si256((void *)(queries + at), _mm256_set1_epi32((int)query));
}
#elif defined(QN_ISA_AVX2)
/* By mask: the numbers of its set bits from the lowest up, four bits each. */
static const uint32_t PACK[256] = {
  0x0u, 0x0u, 0x1u, 0x10u, 0x2u, 0x20u, 0x21u, 0x210u, 0x3u, 0x30u, 0x31u, 0x310u, 0x32u, 0x320u, 0x321u, 0x3210u, 0x4u, 0x40u,
  0x41u, 0x410u, 0x42u, 0x420u, 0x421u, 0x4210u, 0x43u, 0x430u, 0x431u, 0x4310u, 0x432u, 0x4320u, 0x4321u, 0x43210u, 0x5u,
  0x50u, 0x51u, 0x510u, 0x52u, 0x520u, 0x521u, 0x5210u, 0x53u, 0x530u, 0x531u, 0x5310u, 0x532u, 0x5320u, 0x5321u, 0x53210u,
  0x54u, 0x540u, 0x541u, 0x5410u, 0x542u, 0x5420u, 0x5421u, 0x54210u, 0x543u, 0x5430u, 0x5431u, 0x54310u, 0x5432u, 0x54320u,
  0x54321u, 0x543210u, 0x6u, 0x60u, 0x61u, 0x610u, 0x62u, 0x620u, 0x621u, 0x6210u, 0x63u, 0x630u, 0x631u, 0x6310u, 0x632u,
  0x6320u, 0x6321u, 0x63210u, 0x64u, 0x640u, 0x641u, 0x6410u, 0x642u, 0x6420u, 0x6421u, 0x64210u, 0x643u, 0x6430u, 0x6431u,
  0x64310u, 0x6432u, 0x64320u, 0x64321u, 0x643210u, 0x65u, 0x650u, 0x651u, 0x6510u, 0x652u, 0x6520u, 0x6521u, 0x65210u, 0x653u,
  0x6530u, 0x6531u, 0x65310u, 0x6532u, 0x65320u, 0x65321u, 0x653210u, 0x654u, 0x6540u, 0x6541u, 0x65410u, 0x6542u, 0x65420u,
  0x65421u, 0x654210u, 0x6543u, 0x65430u, 0x65431u, 0x654310u, 0x65432u, 0x654320u, 0x654321u, 0x6543210u, 0x7u, 0x70u, 0x71u,
  0x710u, 0x72u, 0x720u, 0x721u, 0x7210u, 0x73u, 0x730u, 0x731u, 0x7310u, 0x732u, 0x7320u, 0x7321u, 0x73210u, 0x74u, 0x740u,
  0x741u, 0x7410u, 0x742u, 0x7420u, 0x7421u, 0x74210u, 0x743u, 0x7430u, 0x7431u, 0x74310u, 0x7432u, 0x74320u, 0x74321u,
  0x743210u, 0x75u, 0x750u, 0x751u, 0x7510u, 0x752u, 0x7520u, 0x7521u, 0x75210u, 0x753u, 0x7530u, 0x7531u, 0x75310u, 0x7532u,
  0x75320u, 0x75321u, 0x753210u, 0x754u, 0x7540u, 0x7541u, 0x75410u, 0x7542u, 0x75420u, 0x75421u, 0x754210u, 0x7543u, 0x75430u,
  0x75431u, 0x754310u, 0x75432u, 0x754320u, 0x754321u, 0x7543210u, 0x76u, 0x760u, 0x761u, 0x7610u, 0x762u, 0x7620u, 0x7621u,
  0x76210u, 0x763u, 0x7630u, 0x7631u, 0x76310u, 0x7632u, 0x76320u, 0x76321u, 0x763210u, 0x764u, 0x7640u, 0x7641u, 0x76410u,
  0x7642u, 0x76420u, 0x76421u, 0x764210u, 0x7643u, 0x76430u, 0x76431u, 0x764310u, 0x76432u, 0x764320u, 0x764321u, 0x7643210u,
  0x765u, 0x7650u, 0x7651u, 0x76510u, 0x7652u, 0x76520u, 0x76521u, 0x765210u, 0x7653u, 0x76530u, 0x76531u, 0x765310u, 0x76532u,
  0x765320u, 0x765321u, 0x7653210u, 0x7654u, 0x76540u, 0x76541u, 0x765410u, 0x76542u, 0x765420u, 0x765421u, 0x7654210u,
  0x76543u, 0x765430u, 0x765431u, 0x7654310u, 0x765432u, 0x7654320u, 0x7654321u, 0x76543210u};
QN_INLINE void append(const uint32_t child[8], unsigned m, uint32_t query, uint32_t *queries, uint32_t *numbers, size_t at) {
  __m256i order = _mm256_srlv_epi32(_mm256_set1_epi32((int)PACK[m]), _mm256_set_epi32(28, 24, 20, 16, 12, 8, 4, 0));
  _mm256_storeu_si256((void *)(numbers + at), _mm256_permutevar8x32_epi32(_mm256_load_si256((const void *)child), order));
  _mm256_storeu_si256((void *)(queries + at), _mm256_set1_epi32((int)query));
}
#else
QN_INLINE void append(const uint32_t child[8], unsigned m, uint32_t query, uint32_t *queries, uint32_t *numbers, size_t at) {
  for (; m; m &= m - 1, at++) {
    numbers[at] = child[qn_trailing_zeros(m)];
    queries[at] = query;
  }
}
#endif

/* The slots whose children are terms. */
QN_INLINE unsigned terms_among(const uint32_t child[8]) {
#if defined(QN_ISA_AVX2) || defined(QN_ISA_AVX512)
  return (unsigned)_mm256_movemask_ps(_mm256_load_ps((const float *)(const void *)child));
#else
  return (unsigned)_mm_movemask_ps(_mm_load_ps((const float *)(const void *)child)) |
         (unsigned)_mm_movemask_ps(_mm_load_ps((const float *)(const void *)(child + 4))) << 4;
#endif
}

/* --- terms ------------------------------------------------------------------------------------------------------------ */

static void ask(walk *w, questions *q);

/* NOLINTBEGIN(misc-no-recursion): as deep as lists stand within lists, at most QN_NORMAL_DEPTH */

/* A term whose leaves leave its verdict open or in, and which has lists. */
typedef struct open_term { uint32_t query, term; uint8_t verdict; } open_term;

/* The lists of some terms, all terms' first unions together, then all second ones, as long as their verdicts can still change an answer. common: the term
   that all of them are, or null. */
QN_INLINE void ask_lists_of(walk *w, questions *q, open_term *open, size_t count, const qn_nterm *common) {
  const qn_normal *normal = &w->scene->normal;
  questions below;
  for (uint32_t i = 0; count; i++) {
    below.n = count;
    for (size_t k = 0; k < count; k++) {
      const qn_nterm *t = common ? common : &normal->terms[open[k].term];
      below.point[k] = q->point[open[k].query];
      below.un[k] = normal->lists[i < t->minus ? t->minus0 + i : t->plus0 + (i - t->minus)];
    }
    ask(w, &below);
    size_t left = 0;
    for (size_t k = 0; k < count; k++) { /* which way an answer goes is anybody's guess: no branch hangs on it */
      open_term o = open[k];
      const qn_nterm *t = common ? common : &normal->terms[o.term];
      uint8_t *answer = &q->verdict[o.query], v = below.verdict[k];
      v = i < t->minus ? (uint8_t)(QN_SURELY_IN - v) : v;
      o.verdict = v < o.verdict ? v : o.verdict;
      if (i + 1 == t->minus + t->plus) {
        *answer = o.verdict > *answer ? o.verdict : *answer;
      } else {
        open[left] = o;
        left += o.verdict > *answer;
      }
    }
    count = left;
  }
}
static QN_NOINLINE void ask_lists(walk *w, questions *q, open_term *open, size_t count) { ask_lists_of(w, q, open, count, NULL); }

QN_INLINE const qn_piece_head *piece_at(const struct quoin_scene *scene, uint32_t leaf) {
  return (const qn_piece_head *)(const void *)((const char *)scene->lines + (size_t)scene->line_of[leaf] * 64);
}

/* Asks for a piece's other cache lines. */
QN_INLINE void fetch_piece(const qn_piece_head *head) {
  const char *line = (const char *)head;
  if (head->kind == QN_PIECE_ROUND || head->kind == QN_PIECE_BOX) {
    QN_FETCH(line + 64), QN_FETCH(line + 128), QN_FETCH(line + 192);
  }
}

/* Whether the floats about a point meet a term's box. */
QN_INLINE unsigned term_meets(const qn_nterm *t, const float box[8]) {
  __m128 in = _mm_and_ps(_mm_cmple_ps(_mm_loadu_ps(t->min), _mm_load_ps(box + 4)), _mm_cmple_ps(_mm_load_ps(box), _mm_loadu_ps(t->max)));
  return (_mm_movemask_ps(in) & 7) == 7; /* the fourth are other fields */
}

/* One pair: the answer goes into the question's verdict, or into *open, then 1 is returned. first: the piece of the term's first leaf. */
QN_INLINE size_t settle_pair(walk *w, questions *q, uint32_t query, uint32_t term, const qn_piece_head *first, open_term *open) {
  const struct quoin_scene *scene = w->scene;
  const qn_nterm *t = &scene->normal.terms[term];
  qn_wide_point p = point_of(w, q->point[query]);
  unsigned answer = q->verdict[query], all = QN_SURELY_IN;
  for (uint32_t i = 0; i < t->leaves && all > answer; i++) {
    unsigned one = in_piece(scene, i ? piece_at(scene, scene->normal.leaves[t->leaf0 + i]) : first, p);
    all = one < all ? one : all;
    w->counts.leaves++;
  }
  if (all <= answer) {
    return 0;
  }
  if (t->minus + t->plus) {
    *open = (open_term){query, term, (uint8_t)all};
    return 1;
  }
  q->verdict[query] = (uint8_t)all;
  return 0;
}

/* Answers to (question, term) pairs go into the questions' verdicts. Each stage asks memory for what the next one reads, for all pairs. The
   arrays are used up. */
static void settle_pairs(walk *w, questions *q, size_t count, uint32_t *query, uint32_t *term) {
  const struct quoin_scene *scene = w->scene;
  const qn_nterm *terms = scene->normal.terms;
  const uint32_t *leaves = scene->normal.leaves;
  const float (*box)[8] = (const float (*)[8])w->room->box;
  const qn_piece_head *first[PAIRS];
  open_term open[PAIRS];
  size_t opened = 0, met = 0;
  for (size_t k = 0; k < count; k++) {
    term[k] &= ~QN_BVH_LEAF; /* NOLINT(clang-analyzer-core.uninitialized.Assign): append wrote as many as it counted */
    QN_FETCH(&terms[term[k]]);
  }
  for (size_t k = 0; k < count; k++) {
    uint32_t one = term[k], asks = query[k];
    query[met] = asks, term[met] = one;
    met += term_meets(&terms[one], box[q->point[asks]]);
  }
  for (size_t k = 0; k < met; k++) {
    const qn_nterm *t = &terms[term[k]];
    first[k] = t->leaves ? piece_at(scene, leaves[t->leaf0]) : NULL;
    QN_FETCH(first[k]);
  }
  for (size_t k = 0; k < met; k++) {
    if (first[k]) {
      fetch_piece(first[k]);
    }
  }
  for (size_t k = 0; k < met; k++) {
    opened += settle_pair(w, q, query[k], term[k], first[k], &open[opened]);
  }
  if (opened) {
    ask_lists(w, q, open, opened);
  }
}

/* All questions about one term, whose box is not looked at: its leaves say as much. */
static void settle_term(walk *w, questions *q, uint32_t term) {
  const struct quoin_scene *scene = w->scene;
  const qn_nterm *t = &scene->normal.terms[term];
  const qn_piece_head *first = t->leaves ? piece_at(scene, scene->normal.leaves[t->leaf0]) : NULL;
  open_term open[QN_POINTS];
  size_t opened = 0;
  if (t->leaves == 1 && t->minus + t->plus && first->kind == QN_PIECE_BOX) { /* a block that things are taken from: without a branch */
    const qn_piece_box block = *(const qn_piece_box *)(const void *)first;
    w->counts.leaves += q->n;
    for (size_t i = 0; i < q->n; i++) {
      unsigned one = in_box(&block, point_of(w, q->point[i]));
      open[opened] = (open_term){(uint32_t)i, term, (uint8_t)one};
      opened += one > q->verdict[i];
    }
  } else {
    for (size_t i = 0; i < q->n; i++) {
      opened += settle_pair(w, q, (uint32_t)i, term, first, &open[opened]);
    }
  }
  if (opened) {
    const qn_nterm one = *t;
    ask_lists_of(w, q, open, opened, &one);
  }
}

/* --- the walk --------------------------------------------------------------------------------------------------------- */

/* The cell of the floats about a point, or QN_NO_GRID when they are in two. */
QN_INLINE uint32_t cell_at(const qn_cell_grid *g, const float box[8]) {
  const __m128 low = _mm_load_ps(g->low), scale = _mm_load_ps(g->scale), last = _mm_load_ps(g->last), zero = _mm_setzero_ps();
  __m128 from = _mm_min_ps(_mm_max_ps(_mm_mul_ps(_mm_sub_ps(_mm_load_ps(box), low), scale), zero), last);
  __m128 to = _mm_min_ps(_mm_max_ps(_mm_mul_ps(_mm_sub_ps(_mm_load_ps(box + 4), low), scale), zero), last);
  __m128i a = _mm_cvttps_epi32(from), b = _mm_cvttps_epi32(to);
  if (QN_UNLIKELY(_mm_movemask_epi8(_mm_cmpeq_epi32(a, b)) != 0xffff)) {
    return QN_NO_GRID;
  }
  uint32_t x = (uint32_t)_mm_cvtsi128_si32(a), y = (uint32_t)_mm_cvtsi128_si32(_mm_shuffle_epi32(a, 1)), z = (uint32_t)_mm_cvtsi128_si32(_mm_shuffle_epi32(a, 2));
  return g->first + x + y * g->across + z * g->layer;
}

/* (question, term) pairs that wait to be settled, with room for what one more question may add without a look. */
typedef struct waiting { size_t n; uint32_t query[PAIRS + QN_CELL_MOST], term[PAIRS + QN_CELL_MOST]; } waiting;

QN_INLINE void settle_waiting(walk *w, questions *q, waiting *p, size_t room) {
  if (p->n + room > PAIRS) {
    settle_pairs(w, q, p->n, p->query, p->term);
    p->n = 0;
  }
}

/* The terms in the cells of some questions. A cell that does not say, or none, puts the union's root on the stack, whose top is returned. */
static size_t ask_cells(walk *w, questions *q, const uint32_t *cell, size_t top, waiting *p) {
  const uint32_t *const start = w->room->cells->start, *const term = w->room->cells->term;
  const size_t n = q->n;
  w->top = top + n; /* no further than this */
  for (size_t i = 0; i < n; i++) {
    if (cell[i] == NOWHERE) {
      continue;
    }
    const uint32_t *first = cell[i] == QN_NO_GRID ? NULL : term + start[cell[i]];
    size_t count = first ? start[cell[i] + 1] - start[cell[i]] : 0;
    if (QN_UNLIKELY(!first || (count && *first == QN_CELL_CROWDED))) {
      w->room->query[top] = (uint32_t)i, w->room->node[top++] = w->scene->normal.unions[q->un[i]].root;
      continue;
    }
    settle_waiting(w, q, p, QN_CELL_MOST);
    for (int k = 0; k < QN_CELL_MOST; k += 4) {
      _mm_storeu_si128((void *)(p->term + p->n + k), _mm_loadu_si128((const void *)(first + k)));
      _mm_storeu_si128((void *)(p->query + p->n + k), _mm_set1_epi32((int)i));
    }
    p->n += count;
  }
  return top;
}

/* Whether all questions are about one union that has cells and no terms beside them. */
static int one_with_cells(const walk *w, const questions *q) {
  const qn_cells *cells = w->room->cells;
  if (!cells || q->n == 0) {
    return 0;
  }
  const qn_union *u = &w->scene->normal.unions[q->un[0]];
  if (u->wide || u->terms <= FEW || cells->grid[q->un[0]] == QN_NO_GRID) {
    return 0;
  }
  uint32_t other = 0;
  for (size_t i = 1; i < q->n; i++) {
    other |= q->un[i] ^ q->un[0];
  }
  return other == 0;
}

/* Starts the questions: terms without a place in a hierarchy, the terms of unions of very few, and those listed in cells are asked at once; the
   roots of the other hierarchies go on the stack, whose top is returned. */
static size_t start(walk *w, questions *q, size_t top) {
  const qn_normal *normal = &w->scene->normal;
  const qn_cells *cells = w->room->cells;
  uint32_t cell[QN_POINTS];
  waiting p;
  size_t in_cells = 0;
  p.n = 0;
  w->top = top + q->n; /* the stack may grow by so much meanwhile */
  memset(q->verdict, QN_SURELY_OUT, q->n);
  if (one_with_cells(w, q)) {
    const qn_cell_grid grid = cells->grids[cells->grid[q->un[0]]];
    for (size_t i = 0; i < q->n; i++) {
      cell[i] = cell_at(&grid, w->room->box[q->point[i]]);
      QN_FETCH(&cells->start[cell[i] == QN_NO_GRID ? 0 : cell[i]]);
    }
    top = ask_cells(w, q, cell, top, &p);
    if (p.n) {
      settle_pairs(w, q, p.n, p.query, p.term);
    }
    return top;
  }
  for (size_t i = 0; i < q->n; i++) {
    const qn_union *u = &normal->unions[q->un[i]];
    cell[i] = NOWHERE;
    for (uint32_t k = 0; k < u->wide && q->verdict[i] != QN_SURELY_IN; k++) {
      settle_waiting(w, q, &p, 1);
      p.query[p.n] = (uint32_t)i, p.term[p.n++] = u->wide0 + k;
    }
    if (u->terms <= FEW) {
      settle_waiting(w, q, &p, FEW);
      for (uint32_t k = 0; k < u->terms; k++) {
        p.query[p.n] = (uint32_t)i, p.term[p.n++] = u->term0 + k;
      }
    } else if (cells && cells->grid[q->un[i]] != QN_NO_GRID) {
      cell[i] = cell_at(&cells->grids[cells->grid[q->un[i]]], w->room->box[q->point[i]]);
      QN_FETCH(&cells->start[cell[i] == QN_NO_GRID ? 0 : cell[i]]);
      in_cells = 1;
    } else {
      w->room->query[top] = (uint32_t)i, w->room->node[top++] = u->root;
    }
  }
  top = in_cells ? ask_cells(w, q, cell, top, &p) : top;
  if (p.n) {
    settle_pairs(w, q, p.n, p.query, p.term);
  }
  return top;
}

/* Fills the verdicts. Runs of entries at the top of the stack are taken until it is as low as before. */
static void ask(walk *w, questions *q) {
  const qn_normal *normal = &w->scene->normal;
  qn_point_walk *room = w->room;
  size_t bottom = w->top, top;
  if (bottom + q->n + PAIRS > QN_POINT_ROOM) {
    memset(q->verdict, QN_NOT_SURE, q->n);
    return;
  }
  top = start(w, q, bottom);
  while (top > bottom) {
    uint32_t query[RUN], node[RUN], pair_query[PAIRS + QN_BVH_WIDE], pair_term[PAIRS + QN_BVH_WIDE];
    size_t run = top - bottom < RUN ? top - bottom : RUN, pairs = 0;
    top -= run;
    if (top + PAIRS + QN_BVH_WIDE > QN_POINT_ROOM) { /* who has no room is not sure, unless sure already */
      for (size_t i = 0; i < q->n; i++) {
        q->verdict[i] = q->verdict[i] == QN_SURELY_IN ? QN_SURELY_IN : QN_NOT_SURE;
      }
      break;
    }
    memcpy(query, room->query + top, sizeof query); /* a run's length, whatever is in it */
    memcpy(node, room->node + top, sizeof node);
    for (size_t i = 0; i < run; i++) {
      const char *n = (const char *)&normal->nodes[node[i]];
      QN_FETCH(n), QN_FETCH(n + 64), QN_FETCH(n + 128), QN_FETCH(n + 192);
    }
    for (size_t i = 0; i < run; i++) {
      if (q->verdict[query[i]] == QN_SURELY_IN) {
        continue;
      }
      const qn_bvh_node *n = &normal->nodes[node[i]];
      unsigned m = children_at(n, room->box[q->point[query[i]]]), terms = m & terms_among(n->child);
      m ^= terms;
      append(n->child, m, query[i], room->query, room->node, top);
      top += (size_t)__builtin_popcount(m);
      append(n->child, terms, query[i], pair_query, pair_term, pairs);
      pairs += (size_t)__builtin_popcount(terms);
    }
    w->counts.nodes += run;
    if (pairs) {
      w->top = top;
      settle_pairs(w, q, pairs, pair_query, pair_term);
    }
  }
  w->top = bottom;
}
/* NOLINTEND(misc-no-recursion) */

/* --- a batch ---------------------------------------------------------------------------------------------------------- */

/* The floats about a point: 2u weight to either side, then outward by more than a float's rounding, which moves by under 2^-24 of it or by
   under the smallest normal float; the fourth is any number. exact: its weight is 0. 0 for a point beyond the range of the bounds, or not all of numbers. */
QN_INLINE size_t box_of(qn_wide_point p, int exact, float box[8]) {
  const __m128 size = _mm_castsi128_ps(_mm_set1_epi32(0x7fffffff)), step = _mm_set1_ps(QN_FLOAT_STEP), tiny = _mm_set1_ps(QN_FLOAT_TINY), most = _mm_set1_ps((float)QN_WIDE_LARGEST);
  const __m128d xy = _mm_loadu_pd(p.x), z = _mm_load_sd(p.x + 2), e = _mm_set1_pd(exact ? 0 : 2 * QN_U * p.weight);
  __m128 low = _mm_movelh_ps(_mm_cvtpd_ps(exact ? xy : _mm_sub_pd(xy, e)), _mm_cvtpd_ps(exact ? z : _mm_sub_pd(z, e)));
  __m128 high = exact ? low : _mm_movelh_ps(_mm_cvtpd_ps(_mm_add_pd(xy, e)), _mm_cvtpd_ps(_mm_add_pd(z, e)));
  const __m128 under = _mm_add_ps(_mm_mul_ps(_mm_and_ps(low, size), step), tiny), over = exact ? under : _mm_add_ps(_mm_mul_ps(_mm_and_ps(high, size), step), tiny);
  low = _mm_sub_ps(low, under), high = _mm_add_ps(high, over);
  _mm_store_ps(box, low);
  _mm_store_ps(box + 4, high);
  __m128 small = _mm_and_ps(_mm_cmple_ps(_mm_and_ps(low, size), most), _mm_cmple_ps(_mm_and_ps(high, size), most));
  return (_mm_movemask_ps(small) & 7) == 7;
}

/* The points that can be asked about become questions about a union. */
QN_INLINE void start_questions(const walk *w, size_t n, int exact, uint32_t un, questions *q) {
  q->n = 0;
  for (size_t i = 0; i < n; i++) {
    q->point[q->n] = (uint32_t)i;
    q->un[q->n] = un;
    q->n += box_of(point_of(w, i), exact, w->room->box[i]);
  }
}

void QN_OF_ISA(qn_points)(const struct quoin_scene *scene, qn_point_walk *room, size_t n, const double *points, const double *weights, uint8_t *verdict, qn_wide_counts *counts);
void QN_OF_ISA(qn_points)(const struct quoin_scene *scene, qn_point_walk *room, size_t n, const double *points, const double *weights, uint8_t *verdict, qn_wide_counts *counts) {
  static const double NO_WEIGHT[QN_POINTS] = {0};
  walk w = {.scene = scene, .points = points, .weights = weights ? weights : NO_WEIGHT, .room = room};
  questions q;
  if (weights) {
    start_questions(&w, n, 0, scene->normal.root, &q);
  } else {
    start_questions(&w, n, 1, scene->normal.root, &q);
  }
  const qn_union *root = &scene->normal.unions[scene->normal.root];
  if (root->terms + root->wide <= FEW) {
    memset(q.verdict, QN_SURELY_OUT, q.n);
    for (uint32_t k = 0; k < root->terms + root->wide; k++) {
      settle_term(&w, &q, k < root->terms ? root->term0 + k : root->wide0 + (k - root->terms));
    }
  } else {
    ask(&w, &q);
  }
  if (q.n < n) {
    memset(verdict, QN_NOT_SURE, n);
  }
  for (size_t i = 0; i < q.n; i++) {
    verdict[q.point[i]] = scene->normal.complement ? (uint8_t)(QN_SURELY_IN - q.verdict[i]) : q.verdict[i];
  }
  counts->nodes += w.counts.nodes, counts->leaves += w.counts.leaves;
}
