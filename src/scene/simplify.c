/* Terms that cannot matter become constants.

   Legend. A term T has two boxes: in(T) holds the set T, out(T) holds its complement.
       leaf: in = its box.   its complement: out = its box.
       AND: in = meet of the children's in, out = hull of their out.   OR: the other way round.
   The reach C(T) is where T's value can matter: all of space at the root; a child of AND: C(T) and in(T), for elsewhere the
   AND is false; a child of OR: C(T) and out(T), for elsewhere the OR is true. A term whose in is apart from its reach is
   replaced by false, one whose out is apart from it by true.
   Why all replacements may be made at once. At least one of in(T) and out(T) is all of space (by induction: a meet with
   another in has a child with another in, whose out is all of space; then so is the meet's). So a child of AND with a box
   in(T) never becomes true while its reach is not nothing: replacements never let the set grow out of the old in(T), nor its
   complement out of the old out(T). A point outside in(T) is then still outside T, which is what the reaches of the other
   children of an AND count on; and in its reach no term changes its value.
   Boxes that touch are not apart: the test is strict, and boxes are rounded outward. */
#include "scene/compile.h"

#include <math.h>
#include <string.h>

typedef struct box { double min[3], max[3]; } box;

static const box SPACE = {{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};
static const box NOTHING = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void meet(box *a, const box *b) {
  for (int k = 0; k < 3; k++) {
    a->min[k] = b->min[k] > a->min[k] ? b->min[k] : a->min[k];
    a->max[k] = b->max[k] < a->max[k] ? b->max[k] : a->max[k];
  }
}
static void hull(box *a, const box *b) {
  for (int k = 0; k < 3; k++) {
    a->min[k] = b->min[k] < a->min[k] ? b->min[k] : a->min[k];
    a->max[k] = b->max[k] > a->max[k] ? b->max[k] : a->max[k];
  }
}
static int apart(const box *a, const box *b) {
  for (int k = 0; k < 3; k++) {
    if (a->min[k] > b->max[k] || b->min[k] > a->max[k]) {
      return 1;
    }
  }
  return 0;
}
static int is_nothing(const box *a) {
  return a->min[0] > a->max[0] || a->min[1] > a->max[1] || a->min[2] > a->max[2];
}

/* Both boxes of every gate, while they are gathered. */
typedef struct both { box in, out; } both;

static void boxes_of(const qn_building *b, const qn_term *t, const both *gates, size_t i, box *in, box *out) {
  *in = *out = SPACE;
  switch ((qn_term_kind)t->kind) {
  case QN_TERM_OR: case QN_TERM_AND:
    *in = gates[i].in;
    *out = gates[i].out;
    break;
  case QN_TERM_LEAF: {
    const qn_leaf *leaf = &b->scene->leaves[t->leaf];
    box *own = t->negated ? out : in;
    memcpy(own->min, leaf->min, sizeof own->min);
    memcpy(own->max, leaf->max, sizeof own->max);
    break;
  }
  case QN_TERM_FALSE:
    *in = NOTHING;
    break;
  case QN_TERM_TRUE:
    *out = NOTHING;
    break;
  }
}

/* gates[place[i]] are the boxes of gate term i. */
static void gather(const qn_building *b, const uint32_t *place, both *gates) {
  for (size_t i = 0; i < b->term_count; i++) {
    const qn_term *t = &b->terms[i];
    if (t->kind == QN_TERM_OR) {
      gates[place[i]] = (both){NOTHING, SPACE};
    } else if (t->kind == QN_TERM_AND) {
      gates[place[i]] = (both){SPACE, NOTHING};
    }
  }
  for (size_t i = b->term_count; i-- > 1;) {
    const qn_term *t = &b->terms[i], *parent = &b->terms[t->parent];
    box in, out;
    boxes_of(b, t, gates, place[i], &in, &out);
    if (parent->kind == QN_TERM_AND) {
      meet(&gates[place[t->parent]].in, &in);
      hull(&gates[place[t->parent]].out, &out);
    } else if (parent->kind == QN_TERM_OR) {
      hull(&gates[place[t->parent]].in, &in);
      meet(&gates[place[t->parent]].out, &out);
    }
  }
}

/* Replaces terms by constants, from the root down; reach[place[i]] is the reach of the children of gate term i. Returns how
   many. */
static size_t replace(qn_building *b, const uint32_t *place, const both *gates, box *reach) {
  size_t replaced = 0;
  for (size_t i = 0; i < b->term_count; i++) {
    qn_term *t = &b->terms[i];
    box in, out, here = i ? reach[place[t->parent]] : SPACE;
    if (t->kind == QN_TERM_FALSE || t->kind == QN_TERM_TRUE) {
      if (place[i] != UINT32_MAX) {
        reach[place[i]] = NOTHING;
      }
      continue;
    }
    boxes_of(b, t, gates, place[i], &in, &out);
    int gate = t->kind != QN_TERM_LEAF;
    if (is_nothing(&here) || is_nothing(&in) || apart(&in, &here)) {
      t->kind = QN_TERM_FALSE;
      replaced++;
    } else if (is_nothing(&out) || apart(&out, &here)) {
      t->kind = QN_TERM_TRUE;
      replaced++;
    } else if (gate) {
      reach[place[i]] = here;
      meet(&reach[place[i]], t->kind == QN_TERM_AND ? &in : &out);
      continue;
    }
    if (gate) {
      reach[place[i]] = NOTHING;
    }
  }
  return replaced;
}

quoin_status qn_simplify(qn_building *b, double min[3], double max[3]) {
  size_t gate_count = 0;
  uint32_t *place = qn_alloc(b->mem, b->term_count * sizeof *place);
  if (!place) {
    return QUOIN_E_MEMORY;
  }
  for (size_t i = 0; i < b->term_count; i++) {
    int gate = b->terms[i].kind == QN_TERM_OR || b->terms[i].kind == QN_TERM_AND;
    place[i] = gate ? (uint32_t)gate_count++ : UINT32_MAX;
  }
  both *gates = qn_alloc(b->mem, gate_count * sizeof *gates);
  box *reach = qn_alloc(b->mem, gate_count * sizeof *reach);
  quoin_status status = gates && reach ? QUOIN_OK : QUOIN_E_MEMORY;
  if (status == QUOIN_OK) {
    gather(b, place, gates);
    if (replace(b, place, gates, reach)) {
      gather(b, place, gates);
    }
    box in, out;
    boxes_of(b, &b->terms[0], gates, place[0], &in, &out);
    for (int k = 0; k < 3; k++) {
      min[k] = in.min[k];
      max[k] = in.max[k];
    }
  }
  qn_free(b->mem, gates, gate_count * sizeof *gates);
  qn_free(b->mem, reach, gate_count * sizeof *reach);
  qn_free(b->mem, place, b->term_count * sizeof *place);
  return status;
}
