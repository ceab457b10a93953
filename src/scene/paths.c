/* Heavy paths: a program so deep that walking from a leaf towards the root would be long.

   Along a path every gate but the last has its next one as a child. What a gate makes of that child's value x is one of three things, by
   the number of its other children that are true: false, true, or x itself. It *passes* when it is x: an AND all of whose others
   are true, an OR none of whose others is. So the path's value is that of its first gate that does not pass (the last never
   does), and it has that value by itself. Those gates are bits by place along the path; the first from the head on is found by words,
   and by words of words, so a change costs some ten operations for each path it crosses, however long they are.

   A gate's number of paths up to the root is at most log2 of the gates: each step to another path at least doubles the gates below
   (Sleator and Tarjan 1983). */
#include "scene/program.h"

#include <string.h>

/* The words of all levels over n bits. */
static size_t words_over(size_t n) {
  size_t all = 0;
  do {
    n = (n + 63) / 64;
    all += n;
  } while (n > 1);
  return all;
}

/* Marks what each gate's path goes on with: the child with the most gates, the first of these. */
static void find_next(const qn_program *p, uint32_t *below, uint32_t *next) {
  size_t n = p->gate_count;
  for (size_t i = 0; i < n; i++) {
    below[i] = 1;
    next[i] = QN_NO_GATE;
  }
  for (size_t i = n; i-- > 1;) {
    uint32_t up = p->gates[i].parent;
    below[up] += below[i]; /* all of i's children have been added to it */
    if (next[up] == QN_NO_GATE || below[next[up]] <= below[i]) {
      next[up] = (uint32_t)i;
    }
  }
}

static void lay_out(const qn_program *p, const uint32_t *next, qn_paths *out) {
  uint32_t place = 0;
  for (uint32_t i = 0; i < p->gate_count; i++) {
    if (i > 0 && next[p->gates[i].parent] == i) {
      continue; /* not a head */
    }
    for (uint32_t g = i; g != QN_NO_GATE; g = next[g], place++) {
      out->place[g] = place;
      out->at[place] = g;
      out->head[g] = i;
    }
  }
}

static void find_values(const qn_program *p, const uint32_t *next, qn_paths *out) {
  size_t from = 0;
  memset(out->stops, 0, out->words * sizeof *out->stops);
  for (size_t i = 0; i < p->gate_count; i++) {
    const qn_gate *g = &p->gates[i];
    const qn_gate *h = next[i] == QN_NO_GATE ? NULL : &p->gates[next[i]];
    out->pass[i] = h ? g->need - 1 : QN_NEVER;
    out->base[i] = g->base - (h && h->base >= h->need);
    out->truth[i] = g->base >= g->need;
    if (out->base[i] != out->pass[i]) {
      out->stops[out->place[i] / 64] |= (uint64_t)1 << out->place[i] % 64;
    }
  }
  for (size_t n = (p->gate_count + 63) / 64; n > 1; n = (n + 63) / 64) {
    for (size_t i = 0; i < n; i++) {
      out->stops[from + n + i / 64] |= (uint64_t)(out->stops[from + i] != 0) << i % 64;
    }
    from += n;
  }
}

quoin_status qn_paths_build(qn_program *program, qn_mem *mem) {
  size_t n = program->gate_count;
  qn_paths *p = qn_alloc_zeroed(mem, sizeof *p);
  uint32_t *below = qn_alloc(mem, n * sizeof *below), *next = qn_alloc(mem, n * sizeof *next);
  quoin_status status = QUOIN_E_MEMORY;
  if (p && below && next) {
    p->gates = n;
    p->words = words_over(n);
    p->place = qn_alloc(mem, n * sizeof *p->place);
    p->at = qn_alloc(mem, n * sizeof *p->at);
    p->head = qn_alloc(mem, n * sizeof *p->head);
    p->pass = qn_alloc(mem, n * sizeof *p->pass);
    p->base = qn_alloc(mem, n * sizeof *p->base);
    p->truth = qn_alloc(mem, n);
    p->stops = qn_alloc(mem, p->words * sizeof *p->stops);
    if (p->place && p->at && p->head && p->pass && p->base && p->truth && p->stops) {
      find_next(program, below, next);
      lay_out(program, next, p);
      find_values(program, next, p);
      program->paths = p;
      status = QUOIN_OK;
    }
  }
  if (status != QUOIN_OK) {
    qn_paths_free(p, mem);
  }
  qn_free(mem, below, n * sizeof *below);
  qn_free(mem, next, n * sizeof *next);
  return status;
}

void qn_paths_free(qn_paths *p, qn_mem *mem) {
  if (!p) {
    return;
  }
  qn_free(mem, p->place, p->gates * sizeof *p->place);
  qn_free(mem, p->at, p->gates * sizeof *p->at);
  qn_free(mem, p->head, p->gates * sizeof *p->head);
  qn_free(mem, p->pass, p->gates * sizeof *p->pass);
  qn_free(mem, p->base, p->gates * sizeof *p->base);
  qn_free(mem, p->truth, p->gates);
  qn_free(mem, p->stops, p->words * sizeof *p->stops);
  qn_free(mem, p, sizeof *p);
}

size_t qn_paths_bytes(const qn_paths *p) {
  return p ? sizeof *p + p->gates * (5 * sizeof(uint32_t) + 1) + p->words * sizeof *p->stops : 0;
}
