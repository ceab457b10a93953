/* A program made of terms: constants folded, gates flattened and numbered. */
#include "scene/program.h"

#include <string.h>

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

/* Gives the program its paths where gates are nested deeply. */
static quoin_status deepen(qn_program *program, qn_mem *mem) {
  size_t n = program->gate_count, deepest = 0;
  uint32_t *depth = qn_alloc(mem, n * sizeof *depth);
  if (!depth) {
    return QUOIN_E_MEMORY;
  }
  for (size_t i = 0; i < n; i++) {
    depth[i] = i ? depth[program->gates[i].parent] + 1 : 1;
    deepest = depth[i] > deepest ? depth[i] : deepest;
  }
  qn_free(mem, depth, n * sizeof *depth);
  return deepest > QN_PROGRAM_DEEP ? qn_paths_build(program, mem) : QUOIN_OK;
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
  if (status == QUOIN_OK && live && place) { /* the gates are there only when both are */
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
  status = status == QUOIN_OK ? deepen(program, mem) : status;
  if (status != QUOIN_OK) {
    qn_program_free(program, mem);
  }
  return status;
}

void qn_program_free(qn_program *program, qn_mem *mem) {
  qn_paths_free(program->paths, mem);
  qn_free(mem, program->gates, program->gate_count * sizeof *program->gates);
  *program = (qn_program){0};
}
