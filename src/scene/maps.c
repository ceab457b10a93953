/* The maps along the path from the root, composed in balls; exactly where balls lose too much or where it costs nothing.

   Legend: [A | t] rows of a map; outer after inner is [Ao Ai | Ao ti + to]. inverse(A) = adj(A) / det(A). */
#include "scene/compile.h"

#include "base/bounds.h"
#include "base/limits.h"

#include <math.h>
#include <string.h>

/* Errors of a composed map's balls, in units of 2^-253, beyond which it is taken from exact numbers anew: what is left,
   2^-193, pays for a pivot's offset, which cancels 53 bits and more. */
#define RENEW 0x1p60

static void identity(qn_num map[12]) {
  for (int i = 0; i < 12; i++) {
    map[i] = i % 5 == 0 ? QN_NUM_ONE : QN_NUM_ZERO;
  }
}

void qn_map_compose(qn_ctx *ctx, const qn_num outer[12], const qn_num inner[12], qn_num out[12]) {
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 4; j++) {
      qn_num a[4], b[4];
      size_t n = 0;
      for (int k = 0; k < 3; k++) {
        if (!qn_num_is_zero(outer[4 * i + k]) && !qn_num_is_zero(inner[4 * k + j])) {
          a[n] = outer[4 * i + k];
          b[n++] = inner[4 * k + j];
        }
      }
      if (j == 3 && !qn_num_is_zero(outer[4 * i + 3])) {
        a[n] = outer[4 * i + 3];
        b[n++] = QN_NUM_ONE;
      }
      out[4 * i + j] = n == 0 ? QN_NUM_ZERO : n == 1 ? qn_num_mul(ctx, a[0], b[0]) : qn_num_dot(ctx, n, a, b);
    }
  }
}

int qn_map_forms(qn_ctx *ctx, const qn_num m[12], qn_half_form *halves, size_t count) {
  /* adj[k][j]: entry (k, j) of the adjugate. */
  qn_num adj[3][3];
  for (int k = 0; k < 3; k++) {
    for (int j = 0; j < 3; j++) {
      int r0 = (j + 1) % 3, r1 = (j + 2) % 3, c0 = (k + 1) % 3, c1 = (k + 2) % 3;
      qn_num a[2] = {m[4 * r0 + c0], m[4 * r0 + c1]}, b[2] = {m[4 * r1 + c1], qn_num_neg(ctx, m[4 * r1 + c0])};
      adj[k][j] = qn_num_dot(ctx, 2, a, b);
    }
  }
  qn_num column[3] = {adj[0][0], adj[1][0], adj[2][0]};
  qn_num det = qn_num_dot(ctx, 3, m, column);
  if (qn_num_is_zero(det)) {
    return 0;
  }
  for (int k = 0; k < 3; k++) {
    for (int j = 0; j < 3; j++) {
      if (!qn_num_is_zero(adj[k][j])) {
        adj[k][j] = qn_num_div(ctx, adj[k][j], det);
      }
    }
  }
  for (size_t h = 0; h < count; h++) {
    for (int i = 0; i < (halves[h].kind == QN_PLANE ? 1 : 3); i++) {
      qn_num *row = halves[h].row[i], world[4];
      for (int j = 0; j < 3; j++) {
        qn_num inverse[3] = {adj[0][j], adj[1][j], adj[2][j]};
        world[j] = qn_num_dot(ctx, 3, row, inverse);
      }
      qn_num a[4] = {world[0], world[1], world[2], row[3]};
      qn_num b[4] = {qn_num_neg(ctx, m[3]), qn_num_neg(ctx, m[7]), qn_num_neg(ctx, m[11]), QN_NUM_ONE};
      world[3] = qn_num_dot(ctx, 4, a, b);
      memcpy(row, world, sizeof world);
    }
  }
  return 1;
}

/* --- the stack --------------------------------------------------------------------------------------------------- */

static qn_composed *top_of(qn_maps *maps) {
  return &maps->stack[maps->count - 1];
}

static int one_in_each(const qn_num map[12]) {
  int columns = 0, all = 1;
  for (int i = 0; i < 3; i++) {
    int in_row = 0;
    for (int j = 0; j < 3; j++) {
      if (!qn_num_is_zero(map[4 * i + j])) {
        in_row++;
        columns |= 1 << j;
      }
    }
    all &= in_row == 1;
  }
  return all && columns == 7;
}

static int all_small(const qn_num map[12]) {
  for (int i = 0; i < 12; i++) {
    if (map[i].kind != QN_NUM_SMALL) {
      return 0;
    }
  }
  return 1;
}

static int same_numbers(const quoin_model *model, uint32_t a, uint32_t b) {
  const qn_node *x = &model->nodes[a], *y = &model->nodes[b];
  int same = x->kind == y->kind && x->numbers == y->numbers;
  for (uint32_t i = 0; same && i < x->numbers; i++) {
    same = qn_num_equal(model->numbers[x->number0 + i], model->numbers[y->number0 + i]);
  }
  return same;
}

/* The map of a rotation: often that of one a little before. */
static const qn_num *turn_of(qn_maps *maps, uint32_t node) {
  const qn_node *d = &maps->model->nodes[node];
  uint64_t hash = d->kind;
  for (uint32_t i = 0; i < d->numbers; i++) {
    qn_num n = maps->model->numbers[d->number0 + i];
    hash = (hash ^ (n.kind == QN_NUM_SMALL ? (uint64_t)n.u.m : 1) ^ (uint64_t)(uint16_t)n.a << 32) * UINT64_C(0x9E3779B97F4A7C15);
  }
  qn_turn *t = &maps->turns[hash >> 60];
  if (t->there && same_numbers(maps->model, t->node, node)) {
    return t->map;
  }
  if (maps->turns_made++ == QN_TURNS_MADE) {
    qn_arena_release(&maps->turned.arena, (qn_mark){NULL, NULL});
    memset(maps->turns, 0, sizeof maps->turns);
    maps->turns_made = 1;
  }
  qn_solid_map(&maps->turned, maps->model, node, t->map);
  t->node = node;
  t->there = maps->turned.failed == QUOIN_OK;
  return t->map;
}

/* The local map of a node, into ctx, or where turns are kept until the next one is asked for. */
static void local_map(qn_maps *maps, qn_ctx *ctx, uint32_t node, qn_num map[12]) {
  if (node == QN_NO_NODE) {
    identity(map);
  } else if (maps->model->nodes[node].kind == QN_NODE_ROTATE || maps->model->nodes[node].kind == QN_NODE_ROTATE_AXIS) {
    memcpy(map, turn_of(maps, node), 12 * sizeof *map);
    if (maps->turned.failed != QUOIN_OK && ctx->failed == QUOIN_OK) {
      ctx->failed = maps->turned.failed;
    }
    for (int i = 0; i < 12; i++) { /* a product with 1 is the number itself, so it may be kept longer than the turn */
      map[i] = qn_num_copy(ctx, map[i]);
    }
  } else {
    qn_solid_map(ctx, maps->model, node, map);
  }
}

/* Exact entries for the top and whatever of the stack it rests on. */
static quoin_status make_exact(qn_maps *maps) {
  size_t from = maps->count - 1;
  while (!maps->stack[from].has_exact) {
    from--; /* the root has them */
  }
  for (size_t i = from + 1; i < maps->count; i++) {
    qn_composed *c = &maps->stack[i];
    qn_num inner[12];
    c->mark = qn_arena_mark(&maps->exact.arena);
    local_map(maps, &maps->exact, c->node, inner);
    qn_map_compose(&maps->exact, maps->stack[i - 1].exact, inner, c->exact);
    if (maps->exact.failed != QUOIN_OK) {
      return maps->exact.failed;
    }
    c->has_exact = 1;
  }
  return QUOIN_OK;
}

static void balls_from(qn_maps *maps, qn_composed *c, const qn_num map[12]) {
  for (int i = 0; i < 12; i++) {
    c->map[i] = qn_ball_from_num(&maps->scratch, map[i]);
  }
}

static int good_enough(const qn_composed *c) {
  for (int i = 0; i < 12; i++) {
    if (!(c->map[i].err <= RENEW)) {
      return 0;
    }
  }
  return 1;
}

static void compose_balls(const qn_composed *outer, const qn_ball inner[12], qn_composed *out) {
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 4; j++) {
      qn_ball sum = j == 3 ? outer->map[4 * i + 3] : QN_BALL_ZERO;
      for (int k = 0; k < 3; k++) {
        if (outer->map[4 * i + k].sign && inner[4 * k + j].sign) {
          qn_ball product;
          qn_ball_mul(&outer->map[4 * i + k], &inner[4 * k + j], &product);
          qn_ball_add(&sum, &product, &sum);
        }
      }
      out->map[4 * i + j] = sum;
    }
  }
}

static int is_tame(const qn_ball *a) {
  return a->sign == 0 || (a->e <= 400 && a->e > -400);
}

static void settle(qn_composed *c) {
  c->tame = c->shift_only = 1;
  for (int i = 0; i < 12; i++) {
    const qn_ball *a = &c->map[i];
    c->shadow[i] = qn_ball_to_double(a);
    c->tame = c->tame && is_tame(a);
    if (i % 4 != 3) {
      c->shift_only &= i % 5 == 0 ? a->err == 0 && c->shadow[i] == 1 && !(a->m[0] | a->m[1] | a->m[2] | a->m[3] << 1) : a->sign == 0;
    }
  }
}

quoin_status qn_maps_init(qn_maps *maps, const quoin_model *model, qn_mem *mem) {
  *maps = (qn_maps){.model = model, .inverse_of = SIZE_MAX};
  qn_ctx_init(&maps->exact, mem);
  qn_ctx_init(&maps->scratch, mem);
  qn_ctx_init(&maps->turned, mem);
  maps->exact.max_bits = maps->scratch.max_bits = maps->turned.max_bits = QN_MAX_SCENE_BITS;
  maps->exact.max_effort = maps->scratch.max_effort = QN_MAX_SCENE_EFFORT + QN_SCENE_EFFORT_PER_NODE * (uint64_t)model->node_count;
  if (!qn_grow(mem, &maps->stack, &maps->capacity, 1)) {
    return QUOIN_E_MEMORY;
  }
  qn_composed *root = &maps->stack[maps->count++];
  *root = (qn_composed){.node = QN_NO_NODE, .has_exact = 1, .aligned = 1, .mark = qn_arena_mark(&maps->exact.arena)};
  identity(root->exact);
  balls_from(maps, root, root->exact);
  settle(root);
  root->settled = 1;
  return QUOIN_OK;
}

void qn_maps_free(qn_maps *maps, qn_mem *mem) {
  qn_free(mem, maps->stack, maps->capacity * sizeof *maps->stack);
  qn_ctx_free(&maps->exact);
  qn_ctx_free(&maps->scratch);
  qn_ctx_free(&maps->turned);
}

static quoin_status compose(qn_maps *maps, const qn_composed *outer, qn_composed *c, uint32_t node) {
  qn_num inner[12];
  quoin_status status = QUOIN_OK;
  local_map(maps, &maps->scratch, node, inner);
  if (outer->aligned && one_in_each(inner) && all_small(inner)) {
    qn_map_compose(&maps->exact, outer->exact, inner, c->exact);
    c->has_exact = c->aligned = all_small(c->exact) != 0;
    qn_arena_release(&maps->exact.arena, c->mark);
  }
  if (c->has_exact) {
    balls_from(maps, c, c->exact);
  } else {
    qn_ball balls[12];
    for (int i = 0; i < 12; i++) {
      balls[i] = qn_ball_from_num(&maps->scratch, inner[i]);
    }
    compose_balls(outer, balls, c);
    if (!good_enough(c)) {
      status = make_exact(maps);
      balls_from(maps, c, c->exact);
    }
  }
  settle(c);
  return status;
}

/* The commonest case, a translation under an aligned map: A stays. 0: the place is not a small number. */
static int translate(qn_maps *maps, const qn_composed *outer, qn_composed *c, uint32_t node) {
  const qn_num *by = maps->model->numbers + maps->model->nodes[node].number0;
  qn_num place[3];
  for (int i = 0; i < 3; i++) {
    int j = i;
    if (!outer->shift_only) {
      for (j = 0; qn_num_is_zero(outer->exact[4 * i + j]); j++) {
      }
    }
    qn_num way = outer->shift_only ? by[j] : qn_num_mul(&maps->scratch, outer->exact[4 * i + j], by[j]);
    place[i] = qn_num_add(&maps->scratch, outer->exact[4 * i + 3], way);
    if (place[i].kind != QN_NUM_SMALL) {
      return 0;
    }
  }
  memcpy(c->exact, outer->exact, sizeof c->exact);
  for (int i = 0; i < 3; i++) {
    c->exact[4 * i + 3] = place[i];
  }
  c->shift_only = outer->shift_only;
  c->has_exact = c->aligned = 1;
  c->settled = 0;
  return 1;
}

/* What translate() left undone. */
static void settle_translation(qn_maps *maps, const qn_composed *outer, qn_composed *c) {
  memcpy(c->map, outer->map, sizeof c->map);
  memcpy(c->shadow, outer->shadow, sizeof c->shadow);
  c->tame = outer->tame;
  for (int i = 3; i < 12; i += 4) {
    c->map[i] = qn_ball_from_num(&maps->scratch, c->exact[i]);
    c->shadow[i] = qn_ball_to_double(&c->map[i]);
    c->tame = c->tame && is_tame(&c->map[i]);
  }
  c->settled = 1;
}

static void settle_up_to(qn_maps *maps, size_t last) {
  size_t from = last;
  while (!maps->stack[from].settled) {
    from--; /* the root is */
  }
  while (from < last) {
    from++;
    settle_translation(maps, &maps->stack[from - 1], &maps->stack[from]);
  }
}

void qn_maps_settle(qn_maps *maps) {
  settle_up_to(maps, maps->count - 1);
}

quoin_status qn_maps_push(qn_maps *maps, qn_mem *mem, uint32_t node) {
  if (!qn_grow(mem, &maps->stack, &maps->capacity, maps->count + 1)) {
    return QUOIN_E_MEMORY;
  }
  qn_composed *outer = top_of(maps), *c = outer + 1;
  maps->count++;
  c->node = node;
  c->has_exact = c->aligned = 0;
  c->mark = qn_arena_mark(&maps->exact.arena);
  qn_mark mark = qn_arena_mark(&maps->scratch.arena);
  quoin_status status = QUOIN_OK;
  if (!(outer->aligned && maps->model->nodes[node].kind == QN_NODE_TRANSLATE && translate(maps, outer, c, node))) {
    settle_up_to(maps, maps->count - 2);
    status = compose(maps, outer, c, node);
    c->settled = 1;
  }
  status = status != QUOIN_OK ? status : maps->scratch.failed != QUOIN_OK ? maps->scratch.failed : maps->exact.failed;
  qn_arena_release(&maps->scratch.arena, mark);
  if (maps->inverse_of == maps->count - 1) {
    maps->inverse_of = SIZE_MAX; /* it was of an earlier map at this level */
  }
  return status;
}

void qn_maps_pop(qn_maps *maps) {
  qn_composed *c = top_of(maps);
  if (c->has_exact && !c->aligned) {
    qn_arena_release(&maps->exact.arena, c->mark);
  }
  maps->count--;
}

quoin_status qn_maps_exact(qn_maps *maps, const qn_num **map) {
  quoin_status status = make_exact(maps);
  *map = top_of(maps)->exact;
  return status;
}

/* --- the inverse ------------------------------------------------------------------------------------------------- */

static int invert(const qn_ball map[12], qn_ball inverse[9]) {
  qn_ball adj[9], det = QN_BALL_ZERO, p;
  for (int k = 0; k < 3; k++) {
    for (int j = 0; j < 3; j++) {
      int r0 = (j + 1) % 3, r1 = (j + 2) % 3, c0 = (k + 1) % 3, c1 = (k + 2) % 3;
      qn_ball *a = &adj[3 * k + j];
      qn_ball_mul(&map[4 * r0 + c0], &map[4 * r1 + c1], a);
      qn_ball_mul(&map[4 * r0 + c1], &map[4 * r1 + c0], &p);
      qn_ball_sub(a, &p, a);
    }
  }
  for (int k = 0; k < 3; k++) {
    qn_ball_mul(&map[k], &adj[3 * k], &p);
    qn_ball_add(&det, &p, &det);
  }
  if (det.sign == 0) {
    return 0;
  }
  int known = qn_ball_known(&det);
  for (int i = 0; i < 9; i++) {
    qn_ball_div(&adj[i], &det, &inverse[i]);
    known &= inverse[i].sign == 0 || qn_ball_known(&inverse[i]);
  }
  return known ? 1 : -1;
}

int qn_maps_inverse(qn_maps *maps) {
  qn_maps_settle(maps);
  if (maps->inverse_of != maps->count - 1) {
    maps->inverse_state = invert(top_of(maps)->map, maps->inverse);
    maps->inverse_of = maps->count - 1;
  }
  return maps->inverse_state;
}
