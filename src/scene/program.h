/* The program: the solid tree as gates over leaf literals, complements pushed down to the leaves, so that a change of
   one leaf is a walk towards the root that stops at the first gate that keeps its value; in a deep program, a walk from path to
   path (scene/paths.c).

   A gate is AND or OR of its children (gates or leaf literals), flattened: no gate has a child of its own kind, and none
   has fewer than two children, but gate 0, the root, which may have one or none: an OR of none is false (an empty scene),
   an AND of none is true (all of space). A parent's number is below its children's. */
#ifndef QN_SCENE_PROGRAM_H
#define QN_SCENE_PROGRAM_H

#include "base/mem.h"

#define QN_NO_GATE UINT32_MAX

typedef struct qn_gate {
  uint32_t parent; /* QN_NO_GATE for the root */
  uint32_t need;   /* true children that make it true: 1 for OR, all for AND */
  uint32_t kids;
  uint32_t base;   /* true children when every leaf is outside */
  uint8_t is_and;
} qn_gate;

typedef struct qn_program {
  qn_gate *gates;
  size_t gate_count;
  int base; /* the root's value when every leaf is outside */
  struct qn_paths *paths; /* of a program deeper than QN_PROGRAM_DEEP; else null */
} qn_program;

/* Levels of gates from which on paths are made. The longest walk costs 3 ns a level and a path under 10 ns, so the longest walk in a program without
   paths is some 50 ns; a change that stops at once, as most do, costs the same 30 ns either way, or a tenth more with paths. */
#define QN_PROGRAM_DEEP 16

/* What a program is made of: a tree in prefix order (a parent before its children), in negation normal form. */
typedef enum qn_term_kind { QN_TERM_OR, QN_TERM_AND, QN_TERM_LEAF, QN_TERM_FALSE, QN_TERM_TRUE } qn_term_kind;
typedef struct qn_term {
  uint32_t parent;  /* QN_NO_GATE for term 0, the root */
  uint32_t leaf;    /* of a LEAF: the caller's number, not looked at */
  uint32_t gate;    /* result: of a LEAF that was kept, its gate; else QN_NO_GATE */
  uint8_t kind;
  uint8_t negated;  /* of a LEAF: the literal is "outside the leaf" */
} qn_term;

/* Folds constants, flattens, and numbers the gates in prefix order. Writes terms[].gate, and may turn gates of the terms into
   constants. Linear, no recursion. QUOIN_E_MEMORY or QUOIN_OK. */
QN_NODISCARD quoin_status qn_program_build(qn_program *program, qn_mem *mem, qn_term *terms, size_t count);
void qn_program_free(qn_program *program, qn_mem *mem);

/* The gates cut into heavy paths: each gate goes on to the child with the most gates below it, so a gate is at most log2(gates) paths
   away from the root. See paths.c. */
typedef struct qn_paths {
  uint32_t *place;  /* by gate: path after path, each from its head down */
  uint32_t *at;     /* gate by place */
  uint32_t *head;   /* by gate: of its path */
  uint32_t *pass;   /* by gate: the true children beside the next one of the path with which it has that one's value; QN_NEVER at a path's end */
  uint32_t *base;   /* by gate: those children when every leaf is outside */
  uint8_t *truth;   /* by gate, of heads: value when every leaf is outside */
  uint64_t *stops;  /* a bit a place: the gate has a value of its own; and above it a bit a word that is not 0, up to one word */
  size_t words;     /* of stops, all levels */
  size_t gates;
} qn_paths;
#define QN_NEVER UINT32_MAX

/* What qn_program_build does for a deep program; it may be done for any. */
QN_NODISCARD quoin_status qn_paths_build(qn_program *program, qn_mem *mem);
void qn_paths_free(qn_paths *paths, qn_mem *mem); /* null is allowed */
size_t qn_paths_bytes(const qn_paths *paths);

/* One thread's evaluation. Starts with every leaf outside. */
typedef struct qn_eval {
  const qn_program *program;
  uint32_t *count;   /* true children now, by gate; with paths, beside the next one of the path */
  uint32_t *touched; /* gates whose count may differ from base, each once */
  uint8_t *listed;   /* by gate: is in touched */
  size_t touched_count;
  uint64_t *stops;   /* with paths: as there, now */
  uint8_t *truth;    /* likewise */
  size_t capacity, words; /* of the arrays */
  int value;         /* the root's */
} qn_eval;

QN_NODISCARD int qn_eval_init(qn_eval *eval, const qn_program *program, qn_mem *mem); /* 0 when memory is refused */
void qn_eval_free(qn_eval *eval, qn_mem *mem);
void qn_eval_reset(qn_eval *eval); /* every leaf outside again; cost: what was touched */
/* The literal of a leaf at `gate` becomes true (+1) or false (-1). Returns the root's value after it. Cost: the gates that
   change; with paths, the paths on which a gate changes. */
int qn_eval_change(qn_eval *eval, uint32_t gate, int to_true);

#endif
