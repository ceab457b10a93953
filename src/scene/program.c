#include "scene/program.h"

#include <string.h>

/* --- making a program ------------------------------------------------------------------------------------------ */

/* Settles constants, children before parents (they come later in prefix order). live[i]: children of gate i that are not
   constant. */
static void fold(qn_term *terms, size_t count, uint32_t *live) {
  for (size_t i = count; i-- > 0;) {
    qn_term *t = &terms[i];
    if ((t->kind == QN_TERM_OR || t->kind == QN_TERM_AND) && live[i] == 0) {
      t->kind = t->kind == QN_TERM_OR ? QN_TERM_FALSE : QN_TERM_TRUE;
    }
    if (i == 0) {
      return;
    }
    qn_term *parent = &terms[t->parent];
    switch ((qn_term_kind)t->kind) {
    case QN_TERM_OR: case QN_TERM_AND: case QN_TERM_LEAF:
      live[t->parent]++;
      break;
    case QN_TERM_FALSE:
      if (parent->kind == QN_TERM_AND) {
        parent->kind = QN_TERM_FALSE;
      }
      break;
    case QN_TERM_TRUE:
      if (parent->kind == QN_TERM_OR) {
        parent->kind = QN_TERM_TRUE;
      }
      break;
    }
  }
}

/* Adds a gate below `parent` (QN_NO_GATE: it is the root). */
static uint32_t add_gate(qn_program *program, uint32_t parent, int is_and) {
  program->gates[program->gate_count] = (qn_gate){.parent = parent, .is_and = (uint8_t)is_and};
  if (parent != QN_NO_GATE) {
    program->gates[parent].kids++;
  }
  return (uint32_t)program->gate_count++;
}

/* Gives every gate term that is left its gate in place[]: that of its parent when it has one child or is of its parent's
   kind, else a new one. A constant, and whatever is under one, gets QN_NO_GATE. */
static void number(qn_program *program, qn_term *terms, size_t count, const uint32_t *live, uint32_t *place) {
  const uint32_t NO_ROOT_YET = UINT32_MAX - 1;
  for (size_t i = 0; i < count; i++) {
    qn_term *t = &terms[i];
    uint32_t up = i ? place[t->parent] : NO_ROOT_YET;
    t->gate = QN_NO_GATE;
    place[i] = QN_NO_GATE;
    if (up == QN_NO_GATE || t->kind == QN_TERM_FALSE || t->kind == QN_TERM_TRUE) {
      continue;
    }
    if (t->kind == QN_TERM_LEAF) {
      if (up == NO_ROOT_YET) {
        up = add_gate(program, QN_NO_GATE, 0);
      }
      t->gate = up;
      program->gates[up].kids++;
      program->gates[up].base += t->negated != 0;
    } else if (live[i] == 1) {
      place[i] = up;
    } else if (up == NO_ROOT_YET) {
      place[i] = add_gate(program, QN_NO_GATE, t->kind == QN_TERM_AND);
    } else {
      place[i] = program->gates[up].is_and == (t->kind == QN_TERM_AND) ? up : add_gate(program, up, t->kind == QN_TERM_AND);
    }
  }
}

quoin_status qn_program_build(qn_program *program, qn_mem *mem, qn_term *terms, size_t count) {
  *program = (qn_program){0};
  if (count >= UINT32_MAX / 2) {
    return QUOIN_E_LIMIT;
  }
  uint32_t *live = qn_alloc_zeroed(mem, count * sizeof *live), *place = qn_alloc(mem, count * sizeof *place);
  size_t room = 1;
  if (live && place) {
    fold(terms, count, live);
    for (size_t i = 0; i < count; i++) {
      room += terms[i].kind == QN_TERM_OR || terms[i].kind == QN_TERM_AND;
    }
    program->gates = qn_alloc(mem, room * sizeof *program->gates);
  }
  quoin_status status = program->gates ? QUOIN_OK : QUOIN_E_MEMORY;
  if (status == QUOIN_OK) {
    number(program, terms, count, live, place);
    if (program->gate_count == 0) {
      add_gate(program, QN_NO_GATE, count > 0 && terms[0].kind == QN_TERM_TRUE);
    }
    for (size_t i = program->gate_count; i-- > 0;) {
      qn_gate *g = &program->gates[i];
      g->need = g->is_and ? g->kids : 1;
      if (g->parent != QN_NO_GATE) {
        program->gates[g->parent].base += g->base >= g->need;
      }
    }
    program->base = program->gates[0].base >= program->gates[0].need;
    qn_gate *fitted = qn_resize(mem, program->gates, room * sizeof *fitted, program->gate_count * sizeof *fitted);
    if (fitted) {
      program->gates = fitted;
    } else { /* refused to shrink */
      qn_free(mem, program->gates, room * sizeof *fitted);
      *program = (qn_program){0};
      status = QUOIN_E_MEMORY;
    }
  }
  qn_free(mem, live, count * sizeof *live);
  qn_free(mem, place, count * sizeof *place);
  return status;
}

void qn_program_free(qn_program *program, qn_mem *mem) {
  qn_free(mem, program->gates, program->gate_count * sizeof *program->gates);
  *program = (qn_program){0};
}

/* --- running it ------------------------------------------------------------------------------------------------ */

int qn_eval_init(qn_eval *eval, const qn_program *program, qn_mem *mem) {
  size_t n = program->gate_count;
  *eval = (qn_eval){.program = program, .capacity = n, .value = program->base};
  eval->count = qn_alloc(mem, n * sizeof *eval->count);
  eval->touched = qn_alloc(mem, n * sizeof *eval->touched);
  eval->listed = qn_alloc_zeroed(mem, n);
  if (!eval->count || !eval->touched || !eval->listed) {
    qn_eval_free(eval, mem);
    return 0;
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
  *eval = (qn_eval){0};
}

void qn_eval_reset(qn_eval *eval) {
  for (size_t i = 0; i < eval->touched_count; i++) {
    uint32_t g = eval->touched[i];
    eval->count[g] = eval->program->gates[g].base;
    eval->listed[g] = 0;
  }
  eval->touched_count = 0;
  eval->value = eval->program->base;
}

int qn_eval_change(qn_eval *eval, uint32_t gate, int to_true) {
  const qn_gate *gates = eval->program->gates;
  int up = to_true > 0;
  for (uint32_t g = gate;; g = gates[g].parent) {
    if (!eval->listed[g]) {
      eval->listed[g] = 1;
      eval->touched[eval->touched_count++] = g;
    }
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
