/* Whether nothing is left of the solid, as far as equal surfaces tell.

   A leaf is the meet of its half-spaces, so L lies in M when every half-space of M is one of L's: the same surface, the same side. Two leaves on
   opposite sides of one surface have nothing in common but surface. From these two facts, which are exact, follow
     in one AND:  L and not M is false;  L and P on opposite sides is false;
     in one OR:   not L or M is true;    not L or not P, on opposite sides, is true;
   and below a gate its own literals are known: below an AND they are true, below an OR false, for where they are not the
   gate's value is settled without its other children. So with L in M: a leaf L below a gate that says "outside M" is empty there, a
   leaf M below a gate that says "inside L" is everything there. Constants then go up.

   Pairs are found by one half-space of M, that whose surface has the fewest users; at most MOST of them are looked at for each half-space of L. What is
   not found here is only not called empty: nothing else depends on it. */
#include "scene/compile.h"

#include <string.h>

enum { MOST = 64 };
#define NONE UINT32_MAX

typedef enum known { UNKNOWN, IS_FALSE, IS_TRUE } known;

typedef struct looking {
  const quoin_scene *s;
  uint32_t *first, *next; /* by surface and side: leaves that are found by it, as a chain */
  uint32_t *last;         /* by gate: the last gate below it; gates are in prefix order */
  uint8_t *gate;          /* by gate: known */
  uint8_t *leaf;          /* by leaf: known, of its literal */
} looking;

static uint32_t key_of(const qn_half *h) { return 2 * h->surface + (h->side > 0); }

static int holds(const quoin_scene *s, const qn_leaf *outer, const qn_leaf *inner) {
  for (uint32_t i = outer->half0; i < outer->half0 + outer->halves; i++) {
    uint32_t k = inner->half0;
    while (k < inner->half0 + inner->halves && key_of(&s->halves[k]) != key_of(&s->halves[i])) {
      k++;
    }
    if (k == inner->half0 + inner->halves) {
      return 0;
    }
  }
  return 1;
}

static int is_below(const looking *x, uint32_t gate, uint32_t above) {
  return gate > above && gate <= x->last[above];
}

/* Below the literal's gate it is known that one is inside (else outside) the leaf. */
static int says_inside(const looking *x, const qn_leaf *l) {
  return (x->s->program.gates[l->gate].is_and != 0) != (l->negated != 0);
}

/* inner lies in outer. */
static void take_pair(const looking *x, uint32_t inner, uint32_t outer) {
  const qn_leaf *l = &x->s->leaves[inner], *m = &x->s->leaves[outer];
  if (l->gate == m->gate) {
    int is_and = x->s->program.gates[l->gate].is_and;
    if (is_and ? !l->negated && m->negated : l->negated && !m->negated) {
      x->gate[l->gate] = is_and ? IS_FALSE : IS_TRUE;
    }
  } else if (is_below(x, l->gate, m->gate) && !says_inside(x, m)) {
    x->leaf[inner] = l->negated ? IS_TRUE : IS_FALSE;
  } else if (is_below(x, m->gate, l->gate) && says_inside(x, l)) {
    x->leaf[outer] = m->negated ? IS_FALSE : IS_TRUE;
  }
}

static void list_leaves(const looking *x) {
  const quoin_scene *s = x->s;
  memset(x->first, 0xff, 2 * s->surface_count * sizeof *x->first);
  for (uint32_t i = 0; i < s->leaf_count; i++) {
    const qn_leaf *l = &s->leaves[i];
    uint32_t best = l->half0;
    for (uint32_t h = l->half0; h < l->half0 + l->halves; h++) {
      best = s->surfaces[s->halves[h].surface].users < s->surfaces[s->halves[best].surface].users ? h : best;
    }
    x->next[i] = NONE;
    if (l->halves) {
      x->next[i] = x->first[key_of(&s->halves[best])];
      x->first[key_of(&s->halves[best])] = i;
    }
  }
}

static void take_pairs(const looking *x) {
  const quoin_scene *s = x->s;
  for (uint32_t i = 0; i < s->leaf_count; i++) {
    const qn_leaf *l = &s->leaves[i];
    for (uint32_t h = l->half0; h < l->half0 + l->halves; h++) {
      uint32_t m = x->first[key_of(&s->halves[h])];
      for (int n = 0; n < MOST && m != NONE; n++, m = x->next[m]) {
        if (m != i && holds(s, &s->leaves[m], l)) {
          take_pair(x, i, m);
        }
      }
    }
  }
}

/* Leaves of one gate on opposite sides of a surface: of each surface, for the gate at hand, the side seen. Leaves are in the order of the file, so those of one
   gate come in runs; a run that is taken up again begins anew, which only finds less. */
static void take_opposites(const looking *x, uint32_t *seen_at, uint8_t *seen) {
  const quoin_scene *s = x->s;
  memset(seen_at, 0xff, s->surface_count * sizeof *seen_at);
  for (uint32_t i = 0; i < s->leaf_count; i++) {
    const qn_leaf *l = &s->leaves[i];
    if (!says_inside(x, l)) {
      continue; /* in an AND the positive ones count, in an OR the negated ones */
    }
    for (uint32_t h = l->half0; h < l->half0 + l->halves; h++) {
      const qn_half *half = &s->halves[h];
      if (seen_at[half->surface] != l->gate) {
        seen_at[half->surface] = l->gate;
        seen[half->surface] = 0;
      }
      seen[half->surface] |= half->side > 0 ? 1 : 2;
      if (seen[half->surface] == 3) {
        x->gate[l->gate] = s->program.gates[l->gate].is_and ? IS_FALSE : IS_TRUE;
      }
    }
  }
}

/* Constants from the leaves to the root: what the root is. */
static known settle(const looking *x, uint32_t *trues, uint32_t *falses) {
  const quoin_scene *s = x->s;
  size_t gates = s->program.gate_count;
  memset(trues, 0, gates * sizeof *trues);
  memset(falses, 0, gates * sizeof *falses);
  for (size_t i = 0; i < s->leaf_count; i++) {
    trues[s->leaves[i].gate] += x->leaf[i] == IS_TRUE;
    falses[s->leaves[i].gate] += x->leaf[i] == IS_FALSE;
  }
  known value = UNKNOWN;
  for (size_t g = gates; g-- > 0;) {
    const qn_gate *gate = &s->program.gates[g];
    uint32_t deciding = gate->is_and ? falses[g] : trues[g], others = gate->is_and ? trues[g] : falses[g];
    value = (known)x->gate[g];
    if (value == UNKNOWN && deciding) {
      value = gate->is_and ? IS_FALSE : IS_TRUE;
    } else if (value == UNKNOWN && others == gate->kids) {
      value = gate->is_and ? IS_TRUE : IS_FALSE;
    }
    if (g > 0) {
      trues[gate->parent] += value == IS_TRUE;
      falses[gate->parent] += value == IS_FALSE;
    }
  }
  return value;
}

/* A root that is an OR with a leaf of its own has that leaf. */
static int may_be_empty(const quoin_scene *s) {
  if (s->program.gates[0].is_and) {
    return 1;
  }
  for (size_t i = 0; i < s->leaf_count; i++) {
    if (s->leaves[i].gate == 0) {
      return 0;
    }
  }
  return 1;
}

quoin_status qn_find_empty(qn_building *b) {
  quoin_scene *s = b->scene;
  size_t gates = s->program.gate_count, keys = 2 * s->surface_count;
  if (s->empty || s->leaf_count == 0 || !may_be_empty(s)) {
    return QUOIN_OK;
  }
  looking x = {s, qn_alloc(b->mem, keys * sizeof *x.first), qn_alloc(b->mem, s->leaf_count * sizeof *x.next), qn_alloc(b->mem, gates * sizeof *x.last),
               qn_alloc_zeroed(b->mem, gates), qn_alloc_zeroed(b->mem, s->leaf_count)};
  uint32_t *trues = qn_alloc(b->mem, gates * sizeof *trues), *falses = qn_alloc(b->mem, gates * sizeof *falses);
  uint8_t *seen = qn_alloc(b->mem, s->surface_count);
  quoin_status status = QUOIN_E_MEMORY;
  if (x.first && x.next && x.last && x.gate && x.leaf && trues && falses && seen) {
    for (size_t g = 0; g < gates; g++) {
      x.last[g] = (uint32_t)g;
    }
    for (size_t g = gates; g-- > 1;) {
      uint32_t up = s->program.gates[g].parent;
      x.last[up] = x.last[g] > x.last[up] ? x.last[g] : x.last[up];
    }
    list_leaves(&x);
    take_pairs(&x);
    take_opposites(&x, x.first, seen);
    s->empty = settle(&x, trues, falses) == IS_FALSE;
    status = QUOIN_OK;
  }
  qn_free(b->mem, x.first, keys * sizeof *x.first);
  qn_free(b->mem, x.next, s->leaf_count * sizeof *x.next);
  qn_free(b->mem, x.last, gates * sizeof *x.last);
  qn_free(b->mem, x.gate, gates);
  qn_free(b->mem, x.leaf, s->leaf_count);
  qn_free(b->mem, trues, gates * sizeof *trues);
  qn_free(b->mem, falses, gates * sizeof *falses);
  qn_free(b->mem, seen, s->surface_count);
  return status;
}
