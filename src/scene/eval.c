/* A program run: a leaf changes, and what depends on it. */
#include "scene/program.h"

#include <string.h>

int qn_eval_init(qn_eval *eval, const qn_program *program, qn_mem *mem) {
  size_t n = program->gate_count;
  const qn_paths *p = program->paths;
  *eval = (qn_eval){.program = program, .capacity = n, .words = p ? p->words : 0, .value = program->base};
  eval->count = qn_alloc(mem, n * sizeof *eval->count);
  eval->touched = qn_alloc(mem, n * sizeof *eval->touched);
  eval->listed = qn_alloc_zeroed(mem, n);
  eval->stops = p ? qn_alloc(mem, p->words * sizeof *eval->stops) : NULL;
  eval->truth = p ? qn_alloc(mem, n) : NULL;
  if (!eval->count || !eval->touched || !eval->listed || (p && (!eval->stops || !eval->truth))) {
    qn_eval_free(eval, mem);
    return 0;
  }
  if (p) {
    memcpy(eval->count, p->base, n * sizeof *p->base);
    memcpy(eval->stops, p->stops, p->words * sizeof *p->stops);
    memcpy(eval->truth, p->truth, n);
    return 1;
  }
  for (size_t i = 0; i < n; i++) {
    eval->count[i] = program->gates[i].base;
  }
  return 1;
}

void qn_eval_free(qn_eval *eval, qn_mem *mem) {
  qn_free(mem, eval->count, eval->capacity * sizeof *eval->count);
  qn_free(mem, eval->touched, eval->capacity * sizeof *eval->touched);
  qn_free(mem, eval->listed, eval->capacity);
  qn_free(mem, eval->stops, eval->words * sizeof *eval->stops);
  qn_free(mem, eval->truth, eval->capacity);
  *eval = (qn_eval){0};
}

QN_INLINE void touch(qn_eval *eval, uint32_t gate) {
  if (!eval->listed[gate]) {
    eval->listed[gate] = 1;
    eval->touched[eval->touched_count++] = gate;
  }
}

/* --- by paths (paths.c says how) ---------------------------------------------------------------------------------- */

static void reset_paths(qn_eval *eval) {
  const qn_paths *p = eval->program->paths;
  for (size_t i = 0; i < eval->touched_count; i++) {
    uint32_t g = eval->touched[i];
    eval->count[g] = p->base[g];
    eval->truth[p->head[g]] = p->truth[p->head[g]];
    eval->listed[g] = 0;
    size_t from = 0, at = p->place[g] / 64;
    for (size_t n = (p->gates + 63) / 64;; n = (n + 63) / 64, at /= 64) {
      eval->stops[from + at] = p->stops[from + at];
      from += n;
      if (n <= 1) {
        break;
      }
    }
  }
}

/* The bit at a place, and what it means to the words above it. */
static void set_stop(uint64_t *stops, size_t gates, size_t at, int stop) {
  size_t from = 0;
  for (size_t n = (gates + 63) / 64;; n = (n + 63) / 64) {
    uint64_t *word = &stops[from + at / 64], was = *word, bit = (uint64_t)1 << at % 64;
    *word = stop ? was | bit : was & ~bit;
    if ((was != 0) == (*word != 0) || n <= 1) {
      return;
    }
    from += n;
    at /= 64;
  }
}

/* The first stop at or after a place; there is one. */
static size_t first_stop(const uint64_t *stops, size_t gates, size_t at) {
  size_t start[8] = {0}, level = 0; /* where a level's words begin: 2^31 gates have 6 levels */
  uint64_t word = stops[at / 64] >> at % 64;
  for (size_t n = gates; !word; level++) { /* none left in this word: the next word that has one */
    n = (n + 63) / 64;
    start[level + 1] = start[level] + n;
    at = at / 64 + 1;
    word = stops[start[level + 1] + at / 64] >> at % 64;
  }
  at += qn_trailing_zeros(word);
  while (level > 0) {
    at = at * 64 + qn_trailing_zeros(stops[start[--level] + at]);
  }
  return at;
}

static int change_paths(qn_eval *eval, uint32_t gate, int up) {
  const qn_gate *gates = eval->program->gates;
  const qn_paths *p = eval->program->paths;
  for (uint32_t g = gate;;) {
    touch(eval, g);
    uint32_t before = eval->count[g], after = up ? before + 1 : before - 1, pass = p->pass[g];
    eval->count[g] = after;
    if ((before == pass) != (after == pass)) {
      set_stop(eval->stops, p->gates, p->place[g], after != pass);
    } else if ((before >= gates[g].need) == (after >= gates[g].need)) {
      return eval->value;
    }
    uint32_t head = p->head[g], first = p->at[first_stop(eval->stops, p->gates, p->place[head])];
    up = eval->count[first] >= gates[first].need;
    if (up == eval->truth[head]) {
      return eval->value;
    }
    eval->truth[head] = (uint8_t)up;
    if (gates[head].parent == QN_NO_GATE) {
      return eval->value = up;
    }
    g = gates[head].parent;
  }
}

/* --- gate by gate ------------------------------------------------------------------------------------------------- */

void qn_eval_reset(qn_eval *eval) {
  if (eval->program->paths) {
    reset_paths(eval);
  } else {
    for (size_t i = 0; i < eval->touched_count; i++) {
      uint32_t g = eval->touched[i];
      eval->count[g] = eval->program->gates[g].base;
      eval->listed[g] = 0;
    }
  }
  eval->touched_count = 0;
  eval->value = eval->program->base;
}

int qn_eval_change(qn_eval *eval, uint32_t gate, int to_true) {
  const qn_gate *gates = eval->program->gates;
  int up = to_true > 0;
  if (eval->program->paths) {
    return change_paths(eval, gate, up);
  }
  for (uint32_t g = gate;; g = gates[g].parent) {
    touch(eval, g);
    uint32_t before = eval->count[g], after = up ? before + 1 : before - 1;
    eval->count[g] = after;
    if ((before >= gates[g].need) == (after >= gates[g].need)) {
      return eval->value;
    }
    if (gates[g].parent == QN_NO_GATE) {
      return eval->value = up;
    }
  }
}
