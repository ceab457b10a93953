/* The solid tree: storage, and the exact maps of its transforms. */
#include "model/solid.h"

#include "base/limits.h"
#include "model/words.h"

#include <string.h>

QUOIN_API quoin_status quoin_model_new(const quoin_allocator *allocator, quoin_model **out) {
  if (!out || (allocator && allocator->alloc && (!allocator->resize || !allocator->release))) {
    return QUOIN_E_ARGUMENT;
  }
  *out = NULL;
  qn_mem mem;
  qn_mem_init(&mem, allocator);
  quoin_model *m = qn_alloc_zeroed(&mem, sizeof *m);
  if (!m) {
    return QUOIN_E_MEMORY;
  }
  qn_mem_init(&m->mem, allocator);
  atomic_store(&m->mem.used, sizeof *m);
  atomic_init(&m->users, 1);
  qn_diags_init(&m->diags, &m->mem);
  qn_ctx_init(&m->ctx, &m->mem);
  m->ctx.max_bits = QN_MAX_BITS;
  qn_arena_init(&m->arena, &m->mem);
  m->only = QN_NO_NODE;
  if (!qn_grow(&m->mem, &m->nodes, &m->node_capacity, 16)) {
    qn_model_release(m);
    return QUOIN_E_MEMORY;
  }
  m->nodes[0] = (qn_node){.kind = QN_NODE_UNION, .parent = QN_NO_NODE, .first = QN_NO_NODE, .last = QN_NO_NODE, .next = QN_NO_NODE};
  m->node_count = 1;
  *out = m;
  return QUOIN_OK;
}

void qn_model_retain(quoin_model *model) {
  atomic_fetch_add(&model->users, 1);
}

void qn_model_release(quoin_model *m) {
  if (!m || atomic_fetch_sub(&m->users, 1) > 1) {
    return;
  }
  qn_mem *mem = &m->mem;
  qn_free(mem, m->nodes, m->node_capacity * sizeof *m->nodes);
  qn_free(mem, m->numbers, m->number_capacity * sizeof *m->numbers);
  qn_free(mem, (void *)m->names, m->name_capacity * sizeof *m->names);
  qn_free(mem, m->materials, m->material_capacity * sizeof *m->materials);
  qn_free(mem, m->lights, m->light_capacity * sizeof *m->lights);
  qn_diags_free(&m->diags);
  qn_ctx_free(&m->ctx);
  qn_arena_free(&m->arena);
  quoin_allocator a = mem->a; /* the model holds its own allocator */
  a.release(a.user, m, sizeof *m);
}

QUOIN_API void quoin_model_free(quoin_model *model) {
  qn_model_release(model);
}

QUOIN_API size_t quoin_model_diag_count(const quoin_model *model) {
  return model ? model->diags.count : 0;
}

QUOIN_API quoin_status quoin_model_diag(const quoin_model *model, size_t index, quoin_diag *out) {
  if (!model || !out || index >= model->diags.count) {
    return QUOIN_E_ARGUMENT;
  }
  *out = model->diags.items[index];
  return QUOIN_OK;
}

uint32_t qn_solid_add(quoin_model *m, uint32_t parent, qn_node_kind kind, uint32_t payload, qn_loc loc, const qn_num *from,
                      size_t numbers) {
  if (m->node_count >= QN_NO_NODE || m->number_count + numbers >= UINT32_MAX ||
      !qn_grow(&m->mem, &m->nodes, &m->node_capacity, m->node_count + 1) ||
      !qn_grow(&m->mem, &m->numbers, &m->number_capacity, m->number_count + numbers)) {
    return QN_NO_NODE;
  }
  uint32_t n = (uint32_t)m->node_count++;
  m->nodes[n] = (qn_node){.kind = (uint8_t)kind, .payload = payload, .parent = parent, .first = QN_NO_NODE, .last = QN_NO_NODE,
                          .next = QN_NO_NODE, .number0 = (uint32_t)m->number_count, .numbers = (uint32_t)numbers, .loc = loc};
  if (numbers) {
    memcpy(m->numbers + m->number_count, from, numbers * sizeof *from);
    m->number_count += numbers;
  }
  m->leaf_count += kind == QN_NODE_LEAF;
  qn_node *p = &m->nodes[parent];
  if (p->last == QN_NO_NODE) {
    p->first = n;
  } else {
    m->nodes[p->last].next = n;
  }
  p->last = n;
  return n;
}

uint32_t qn_solid_name(quoin_model *m, const char *text, size_t length) {
  const char *copy = qn_arena_text(&m->arena, text, length);
  if (!copy || !qn_grow(&m->mem, &m->names, &m->name_capacity, m->name_count + 1)) {
    return UINT32_MAX;
  }
  m->names[m->name_count] = copy;
  return (uint32_t)m->name_count++;
}

uint32_t qn_solid_material(quoin_model *m, const qn_material *material) {
  if (!qn_grow(&m->mem, &m->materials, &m->material_capacity, m->material_count + 1)) {
    return UINT32_MAX;
  }
  m->materials[m->material_count] = *material;
  return (uint32_t)m->material_count++;
}

/* --- maps: rows of [M | t] ------------------------------------------------------------------------------------------
   Legend: c, s cosine and sine; Rx turns y to z, Ry z to x, Rz x to y. ROTATE is Rz Ry Rx, OpenSCAD's order:
       cz cy   cz sy sx - sz cx   cz sy cx + sz sx
       sz cy   sz sy sx + cz cx   sz sy cx - cz sx
        -sy         cy sx              cy cx
   ROTATE_AXIS by a about v, n = v.v (Rodrigues): c I + ((1 - c) / n) v v^T + (s / sqrt n) [v]x. The last factor is exact where
   its square is the square of a rational: sin 120 / sqrt 3 = 1/2.
   MIRROR in the plane through 0 with normal v: I - (2 / n) v v^T. */

static qn_num two_terms(qn_ctx *ctx, qn_num a, qn_num b, qn_num c, qn_num d) {
  qn_num x[2] = {a, c}, y[2] = {b, d};
  return qn_num_dot(ctx, 2, x, y);
}

static void rotate(qn_ctx *ctx, const qn_num a[3], qn_num m[12]) {
  qn_num c[3], s[3];
  for (int i = 0; i < 3; i++) {
    c[i] = qn_num_cos(ctx, a[i]);
    s[i] = qn_num_sin(ctx, a[i]);
  }
  qn_num cz_sy = qn_num_mul(ctx, c[2], s[1]), sz_sy = qn_num_mul(ctx, s[2], s[1]);
  m[0] = qn_num_mul(ctx, c[2], c[1]);
  m[1] = two_terms(ctx, cz_sy, s[0], qn_num_neg(ctx, s[2]), c[0]);
  m[2] = two_terms(ctx, cz_sy, c[0], s[2], s[0]);
  m[4] = qn_num_mul(ctx, s[2], c[1]);
  m[5] = two_terms(ctx, sz_sy, s[0], c[2], c[0]);
  m[6] = two_terms(ctx, sz_sy, c[0], qn_num_neg(ctx, c[2]), s[0]);
  m[8] = qn_num_neg(ctx, s[1]);
  m[9] = qn_num_mul(ctx, c[1], s[0]);
  m[10] = qn_num_mul(ctx, c[1], c[0]);
}

static void rotate_axis(qn_ctx *ctx, const qn_num a[4], qn_num m[12]) {
  const qn_num *v = a + 1;
  qn_num n = qn_num_dot(ctx, 3, v, v);
  if (qn_num_sign(n) <= 0) {
    return;
  }
  qn_num c = qn_num_cos(ctx, a[0]), s = qn_num_sin_over_sqrt(ctx, a[0], n);
  qn_num k = qn_num_div(ctx, qn_num_sub(ctx, QN_NUM_ONE, c), n);
  for (size_t i = 0; i < 3; i++) {
    for (size_t j = 0; j < 3; j++) {
      qn_num vv = qn_num_mul(ctx, v[i], v[j]);
      if (i == j) {
        m[5 * i] = two_terms(ctx, k, vv, c, QN_NUM_ONE);
      } else { /* [v]x has -v[k] at (i, j) for (i, j, k) in turn, v[k] at (j, i) */
        qn_num turn = v[3 - i - j];
        m[4 * i + j] = two_terms(ctx, k, vv, s, (i + 1) % 3 == j ? qn_num_neg(ctx, turn) : turn);
      }
    }
  }
}

static void mirror(qn_ctx *ctx, const qn_num v[3], qn_num m[12]) {
  qn_num n = qn_num_dot(ctx, 3, v, v);
  if (qn_num_sign(n) <= 0) {
    return;
  }
  qn_num k = qn_num_div(ctx, qn_num_from_int(ctx, -2), n);
  for (size_t i = 0; i < 3; i++) {
    for (size_t j = 0; j < 3; j++) {
      m[4 * i + j] = two_terms(ctx, k, qn_num_mul(ctx, v[i], v[j]), i == j ? QN_NUM_ONE : QN_NUM_ZERO, QN_NUM_ONE);
    }
  }
}

void qn_solid_map(qn_ctx *ctx, const quoin_model *model, uint32_t node, qn_num map[12]) {
  const qn_node *d = &model->nodes[node];
  const qn_num *v = d->numbers ? model->numbers + d->number0 : NULL;
  for (size_t i = 0; i < 12; i++) {
    map[i] = i % 5 == 0 ? QN_NUM_ONE : QN_NUM_ZERO;
  }
  switch ((qn_node_kind)d->kind) {
  case QN_NODE_TRANSLATE:
    for (size_t i = 0; i < 3; i++) {
      map[4 * i + 3] = v[i];
    }
    break;
  case QN_NODE_ROTATE: rotate(ctx, v, map); break;
  case QN_NODE_ROTATE_AXIS: rotate_axis(ctx, v, map); break;
  case QN_NODE_SCALE:
    for (size_t i = 0; i < 3; i++) {
      map[5 * i] = v[i];
    }
    break;
  case QN_NODE_MIRROR: mirror(ctx, v, map); break;
  case QN_NODE_MULTMATRIX: memcpy(map, v, 12 * sizeof *map); break;
  case QN_NODE_UNION:
  case QN_NODE_DIFFERENCE:
  case QN_NODE_INTERSECTION:
  case QN_NODE_COLOR:
  case QN_NODE_NAME:
  case QN_NODE_LEAF: break;
  }
}
