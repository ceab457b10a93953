/* Normal form: the scene as a union of terms, each a meet of leaves minus unions of terms, under hierarchies of boxes.

   A *term* is   (leaf and leaf and ...) and (union and ...) minus (union or union or ...)   inside its box. Along a line a
   convex leaf is one interval, so a term's positive part is one interval too, and two questions that call each other walk
   everything: the first place in a union at or after t, and the place where the last term that holds t is left.

   Subtrahends are clipped to the box of the term they are taken from; that copies them. Copies are bounded by a budget
   (QN_COPY_BUDGET times the leaves): where it would be passed a union is shared instead, unclipped, and a product of
   unions stays a product. Nothing is lost either way; shared unions are only walked a little longer.

   How a gate is read: with every leaf outside, a gate is either false or true. A set is the gate where it is false there, and
   its complement where it is true; so a set never holds the far field (half-spaces and the like aside), and every gate is
   either a union of its children's sets, or a meet of some children's sets minus the union of the others'. */
#ifndef QN_SCENE_NORMAL_H
#define QN_SCENE_NORMAL_H

#include "scene/bvh.h"
#include "base/mem.h"

#define QN_COPY_BUDGET 8
#define QN_COPY_FLOOR 4096 /* and so many more, so that small scenes never share */
/* Gates nested deeper than this get no normal form: rays then take the woven path. */
#define QN_NORMAL_DEPTH 128

typedef struct qn_nterm {
  float min[3], max[3];        /* holds the term, rounded outward; infinite where unbounded */
  uint32_t leaf0, leaves;      /* in qn_normal.leaves: the leaves whose meet it is; none: all of space */
  uint32_t plus0, plus;        /* in qn_normal.lists: unions that must hold too */
  uint32_t minus0, minus;      /* in qn_normal.lists: unions taken away */
} qn_nterm;

typedef struct qn_union {
  uint32_t root;               /* node of its hierarchy; QN_NO_ROOT when it has only `wide` terms */
  uint32_t term0, terms;       /* in the order of the hierarchy's walk */
  uint32_t wide0, wide;        /* terms without a bounded box: always met */
} qn_union;
#define QN_NO_ROOT UINT32_MAX

typedef struct qn_normal {
  qn_nterm *terms; size_t term_count, term_capacity;
  uint32_t *leaves; size_t leaf_count, leaf_capacity;  /* leaf numbers */
  uint32_t *lists; size_t list_count, list_capacity;   /* union numbers */
  qn_union *unions; size_t union_count, union_capacity;
  qn_bvh_node *nodes; size_t node_count, node_capacity; /* child QN_BVH_LEAF | term number */
  uint32_t root;      /* the union that is the scene's set */
  int complement;     /* the solid is the complement of that set */
  int kin;            /* the root's terms are leaves, from which the same sets are taken: whatever of them passes through a place in two of the terms is taken from both */
  int made;           /* 0: too deep, or not made */
  size_t copies;      /* leaf instances beyond one a leaf */
  size_t shared;      /* unions shared because the budget was met */
  int borrowed;       /* nodes are the scene's bvh, which owns them */
} qn_normal;

struct quoin_scene;
/* Makes the normal form of a compiled scene. Deterministic for any number of threads. */
QN_NODISCARD quoin_status qn_normal_build(qn_normal *normal, const struct quoin_scene *scene, qn_mem *mem, unsigned threads);
/* The same with a budget of its own: unions are shared when more leaf instances than this have been made. */
QN_NODISCARD quoin_status qn_normal_build_within(qn_normal *normal, const struct quoin_scene *scene, qn_mem *mem, unsigned threads, size_t budget);
void qn_normal_free(qn_normal *normal, qn_mem *mem);
size_t qn_normal_bytes(const qn_normal *normal);

#endif
