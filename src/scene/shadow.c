/* The one door of rounding: a leaf's exact half-spaces under its composed map become doubles relative to a pivot.

   Legend: M = [A | t], world x = A local + t. A local row (n, d) means X = n.local + d, in the world X = r.(x - t) + d with
   r = n inverse(A); with y = x - p, p the pivot, X = r.y + b, b = r.(p - t) + d. p - t is small and has lost t's leading bits,
   so t is held to 192 bits and more; p is exact. Every number is rounded once, from a ball that is sure to 2^-103 or from the
   exact number (docs/bounds.md, QN_SHADOW). */
#include "scene/compile.h"

#include "base/bounds.h"
#include "number/dd.h"

#include <math.h>
#include <string.h>

/* --- the local half-spaces --------------------------------------------------------------------------------------- */

static int same_numbers(const quoin_model *model, uint32_t a, uint32_t b) {
  const qn_node *x = &model->nodes[a], *y = &model->nodes[b];
  if (x->payload != y->payload || x->numbers != y->numbers || (x->flags & QN_NODE_PLACED) != (y->flags & QN_NODE_PLACED)) {
    return 0;
  }
  for (uint32_t i = 0; i < x->numbers; i++) {
    if (!qn_num_equal(model->numbers[x->number0 + i], model->numbers[y->number0 + i])) {
      return 0;
    }
  }
  return 1;
}

static int usual_size(double v, int is_zero) {
  return is_zero || (fabs(v) < 0x1p400 && fabs(v) > 0x1p-400);
}

quoin_status qn_local_make(qn_maker *m, uint32_t node) {
  qn_local *l = &m->local;
  if (l->node != QN_NO_NODE && same_numbers(m->model, l->node, node)) {
    return QUOIN_OK;
  }
  const qn_node *n = &m->model->nodes[node];
  const qn_num *numbers = m->model->numbers + n->number0;
  size_t count = n->numbers - (n->flags & QN_NODE_PLACED ? 6 : 0);
  l->node = QN_NO_NODE;
  l->prim = n->payload;
  qn_arena_release(&l->ctx.arena, (qn_mark){NULL, NULL});
  if (!qn_grow(m->mem, &l->args, &l->args_capacity, count + 1)) {
    return QUOIN_E_MEMORY;
  }
  l->tame = 1;
  l->args_count = count;
  for (size_t i = 0; i < count; i++) {
    l->args[i] = qn_num_to_double(numbers[i]);
    l->tame &= usual_size(l->args[i], qn_num_is_zero(numbers[i]));
  }
  qn_placement placement;
  l->placed = NULL;
  if (n->flags & QN_NODE_PLACED) {
    l->placed = l->placement;
    for (size_t i = 0; i < 6; i++) {
      (i < 3 ? placement.base : placement.axis)[i % 3] = numbers[count + i];
      l->placement[i] = qn_num_to_double(numbers[count + i]);
      l->tame &= usual_size(l->placement[i], qn_num_is_zero(numbers[count + i]));
    }
  }
  l->halves = NULL;
  l->count = 0;
  l->result = qn_prims[l->prim].form(&l->ctx, numbers, count, l->placed ? &placement : NULL, &l->halves, &l->count);
  if (l->ctx.failed != QUOIN_OK) {
    return l->ctx.failed;
  }
  if (l->result == QN_FORM_OK) {
    if (!qn_grow(m->mem, &l->rows, &l->rows_capacity, l->count)) {
      return QUOIN_E_MEMORY;
    }
    for (size_t h = 0; h < l->count; h++) {
      for (size_t i = 0; i < (l->halves[h].kind == QN_PLANE ? 1 : 3); i++) {
        for (size_t j = 0; j < 4; j++) {
          l->rows[h][i][j] = qn_ball_from_num(&l->ctx, l->halves[h].row[i][j]);
        }
      }
    }
    if (l->ctx.failed != QUOIN_OK) {
      return l->ctx.failed;
    }
  }
  l->node = node;
  return QUOIN_OK;
}

/* --- the box ----------------------------------------------------------------------------------------------------- */

/* At least t + h + e, exactly. */
static double sum_up(double t, double h, double e) {
  if (isinf(h) || isinf(e)) {
    return INFINITY;
  }
  qn_dd s = qn_dd_two_sum(t, h);
  if (s.lo <= 0 && e == 0) {
    return s.hi;
  }
  return nextafter(s.hi + 2 * ((s.lo > 0 ? s.lo : 0) + e), INFINITY); /* twice: pays for the roundings of the small terms */
}

static int is_double(const qn_ball *a) {
  return a->sign == 0 || (a->err == 0 && !(a->m[0] | a->m[1] | a->m[2]) && !(a->m[3] & 0x7ff));
}

int qn_leaf_box(const qn_maker *m, double min[3], double max[3]) {
  const qn_local *l = &m->local;
  const qn_composed *map = &m->maps.stack[m->maps.count - 1];
  const qn_prim_row *row = &qn_prims[l->prim];
  for (int k = 0; k < 3; k++) {
    min[k] = -INFINITY;
    max[k] = INFINITY;
  }
  if (!l->tame || !map->tame) {
    return 0;
  }
  int bounded = 1;
  double reach[3] = {-1, -1, -1}; /* of the solid along the local axes, made when needed */
  for (int k = 0; k < 3; k++) {
    const double *v = &map->shadow[4 * k];
    double minus[3] = {-v[0], -v[1], -v[2]}, e = 0, t = map->shadow[4 * k + 3];
    for (int j = 0; j < 3; j++) {
      if (is_double(&map->map[4 * k + j])) {
        continue;
      }
      if (reach[j] < 0) {
        double axis[3] = {0, 0, 0};
        axis[j] = 1;
        double up = row->support(l->args, l->args_count, l->placed, axis);
        axis[j] = -1;
        double down = row->support(l->args, l->args_count, l->placed, axis);
        reach[j] = fmax(fabs(up), fabs(down));
      }
      e += QN_SHADOW * fabs(v[j]) * reach[j]; /* h(v + dv) <= h(v) + sum |dv_j| reach_j */
    }
    if (!is_double(&map->map[4 * k + 3])) {
      e += QN_SHADOW * fabs(t);
    }
    double up = row->support(l->args, l->args_count, l->placed, v), down = row->support(l->args, l->args_count, l->placed, minus);
    max[k] = sum_up(t, up, e);
    min[k] = 0 - sum_up(-t, down, e); /* not -0 */
    if (!(min[k] <= max[k])) { /* not numbers */
      min[k] = -INFINITY;
      max[k] = INFINITY;
    }
    bounded &= !isinf(min[k]) && !isinf(max[k]);
  }
  return bounded;
}

/* A double point near the leaf: the image of its local origin (or base), rounded, unless that is far from the box. */
static void choose_pivot(const qn_maker *m, qn_leaf *leaf) {
  const qn_composed *map = &m->maps.stack[m->maps.count - 1];
  double size = 0;
  for (int k = 0; k < 3; k++) {
    const double *v = &map->shadow[4 * k];
    double p = v[3];
    for (int j = 0; j < 3 && m->local.placed; j++) {
      p += v[j] * m->local.placed[j];
    }
    leaf->pivot[k] = isfinite(p) ? p : 0;
    size = leaf->bounded ? fmax(size, leaf->max[k] - leaf->min[k]) : INFINITY;
  }
  int far = 0;
  for (int k = 0; k < 3; k++) {
    far |= leaf->pivot[k] < leaf->min[k] - size || leaf->pivot[k] > leaf->max[k] + size;
  }
  for (int k = 0; far && k < 3; k++) {
    leaf->pivot[k] = 0.5 * leaf->min[k] + 0.5 * leaf->max[k];
  }
}

/* --- the shadows ------------------------------------------------------------------------------------------------- */

static double shadow_of(qn_num a) {
  double v = qn_num_to_double(a);
  if (qn_num_is_zero(a)) {
    return 0;
  }
  if (!(fabs(v) < QN_SHADOW_LARGEST)) {
    return qn_num_sign(a) * QN_SHADOW_LARGEST;
  }
  return fabs(v) < 1 / QN_SHADOW_LARGEST ? qn_num_sign(a) / QN_SHADOW_LARGEST : v;
}

/* One row by balls; 0 when they cannot tell. shift: p - t. inverse: null for the identity. */
static int row_by_balls(const qn_ball row[4], const qn_ball *inverse, const qn_ball shift[3], double out[4]) {
  qn_ball b = row[3];
  for (int j = 0; j < 3; j++) {
    qn_ball r = QN_BALL_ZERO, p;
    if (!inverse) {
      r = row[j];
    } else {
      for (int k = 0; k < 3; k++) {
        if (row[k].sign && inverse[3 * k + j].sign) {
          qn_ball_mul(&row[k], &inverse[3 * k + j], &p);
          qn_ball_add(&r, &p, &r);
        }
      }
    }
    if (!qn_ball_known(&r)) {
      return 0;
    }
    out[j] = qn_ball_to_double(&r);
    if (r.sign && shift[j].sign) {
      qn_ball_mul(&r, &shift[j], &p);
      qn_ball_add(&b, &p, &b);
    }
  }
  out[3] = qn_ball_to_double(&b);
  return qn_ball_known(&b);
}

static size_t rows_of(const qn_half_form *h) {
  return h->kind == QN_PLANE ? 1 : 3;
}

/* All rows of the leaf by balls: rows[half][i][j]. 1, 0 when they cannot tell, -1 when the map is singular. */
static int rows_by_balls(qn_maker *m, const qn_leaf *leaf, double (*rows)[3][4]) {
  const qn_composed *map = &m->maps.stack[m->maps.count - 1];
  const qn_ball *inverse = NULL;
  if (!map->shift_only) {
    int state = qn_maps_inverse(&m->maps);
    if (state <= 0) {
      return state == 0 ? -1 : 0;
    }
    inverse = m->maps.inverse;
  }
  qn_ball shift[3];
  for (int k = 0; k < 3; k++) {
    qn_ball p = qn_ball_from_double(leaf->pivot[k]);
    qn_ball_sub(&p, &map->map[4 * k + 3], &shift[k]);
    if (!qn_ball_known(&shift[k])) {
      return 0;
    }
  }
  for (size_t h = 0; h < m->local.count; h++) {
    for (size_t i = 0; i < rows_of(&m->local.halves[h]); i++) {
      if (!row_by_balls(m->local.rows[h][i], inverse, shift, rows[h][i])) {
        return 0;
      }
    }
  }
  return 1;
}

/* The same in exact arithmetic. */
static int rows_by_numbers(qn_maker *m, const qn_leaf *leaf, double (*rows)[3][4], quoin_status *status) {
  const qn_num *map;
  *status = qn_maps_exact(&m->maps, &map);
  if (*status != QUOIN_OK) {
    return 0;
  }
  qn_ctx *ctx = &m->maps.scratch;
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_half_form *halves = qn_arena_take(&ctx->arena, m->local.count * sizeof *halves);
  int regular = 1;
  if (!halves) {
    *status = QUOIN_E_MEMORY;
  } else {
    memcpy(halves, m->local.halves, m->local.count * sizeof *halves);
    qn_num point[4] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ONE};
    for (int k = 0; k < 3; k++) {
      point[k] = qn_num_from_double(ctx, leaf->pivot[k]);
    }
    regular = qn_map_forms(ctx, map, halves, m->local.count);
    for (size_t h = 0; regular && h < m->local.count; h++) {
      for (size_t i = 0; i < rows_of(&halves[h]); i++) {
        for (int j = 0; j < 3; j++) {
          rows[h][i][j] = shadow_of(halves[h].row[i][j]);
        }
        rows[h][i][3] = shadow_of(qn_num_dot(ctx, 4, halves[h].row[i], point));
      }
    }
    *status = ctx->failed;
  }
  qn_arena_release(&ctx->arena, mark);
  return regular ? 1 : -1;
}

/* The key of a plane, 0 for one that is not aligned. An aligned plane also bounds the box, exactly. */
static uint32_t key_of(qn_maker *m, const qn_half_form *h, const double row[4], qn_leaf *leaf) {
  int axis = qn_row_axis(h->row[0]);
  if (axis < 0 || !m->maps.stack[m->maps.count - 1].aligned) {
    return 0;
  }
  qn_ctx *ctx = &m->maps.scratch;
  qn_mark mark = qn_arena_mark(&ctx->arena);
  qn_num at;
  int world = qn_world_place(m, h->row[0], axis, QN_NUM_ZERO, &at);
  uint32_t key = UINT32_MAX;
  if (ctx->failed == QUOIN_OK) {
    if (leaf->bounded) {
      qn_bound_by_plane(m, leaf, world, at, row[world] > 0);
    }
    key = qn_key_of(m, world, at);
  }
  qn_arena_release(&ctx->arena, mark);
  return key;
}

/* e and n of a superquadric; rounded to a double a little more would pass. */
static int at_most_two(qn_num exponent) {
  double hi, lo;
  return qn_num_quick_pair(exponent, &hi, &lo) ? hi < 2 || (hi == 2 && lo <= 0) : qn_num_to_double(exponent) < 2;
}

static int is_convex(const qn_half_form *h) {
  if (h->kind == QN_PLANE) {
    return 1;
  }
  if (h->kind == QN_SUPER_BODY) { /* exponents up to 2 */
    return at_most_two(h->s[0]) && at_most_two(h->s[1]);
  }
  return qn_num_sign(h->s[0]) >= 0 && qn_num_sign(h->s[1]) >= 0 && qn_num_sign(h->s[2]) >= 0;
}

int qn_batch_room(qn_maker *m) {
  qn_batch *b = m->batch;
  return qn_grow(m->mem, &b->halves, &b->half_capacity, b->half_count + 1) && qn_grow(m->mem, &b->keys, &b->key_capacity, b->half_count + 1);
}

/* X^2 + Y^2 + Z^2 + k of rows that are the identity but for the shift, exactly. */
static int is_shifted_sphere(const qn_maker *m, const qn_half_form *h) {
  int same = h->kind == QN_QUADRIC_BODY && m->maps.stack[m->maps.count - 1].shift_only && qn_num_is_zero(h->l);
  for (int i = 0; same && i < 3; i++) {
    same = qn_num_equal(h->s[i], QN_NUM_ONE);
    for (int j = 0; same && j < 3; j++) {
      same = qn_num_equal(h->row[i][j], i == j ? QN_NUM_ONE : QN_NUM_ZERO);
    }
  }
  return same;
}

static quoin_status add_half(qn_maker *m, const qn_half_form *h, double rows[3][4], qn_leaf *leaf) {
  qn_batch *b = m->batch;
  if (!qn_batch_room(m)) {
    return QUOIN_E_MEMORY;
  }
  qn_half *out = &b->halves[b->half_count];
  *out = (qn_half){.role = h->role, .kind = (uint8_t)h->kind};
  uint32_t key = 0;
  if (h->kind == QN_PLANE) {
    if (!qn_grow(m->mem, &b->planes, &b->plane_capacity, b->plane_count + 1) || (key = key_of(m, h, rows[0], leaf)) == UINT32_MAX) {
      return QUOIN_E_MEMORY;
    }
    out->shadow = (uint32_t)b->plane_count;
    qn_plane_shadow *p = &b->planes[b->plane_count++];
    memcpy(p->n, rows[0], sizeof p->n);
    p->d = rows[0][3];
  } else {
    if (!qn_grow(m->mem, &b->quadrics, &b->quadric_capacity, b->quadric_count + 1)) {
      return QUOIN_E_MEMORY;
    }
    out->shadow = (uint32_t)b->quadric_count;
    qn_quadric_shadow *q = &b->quadrics[b->quadric_count++];
    memcpy(q->row, rows, sizeof q->row);
    for (int i = 0; i < 3; i++) {
      q->s[i] = shadow_of(h->s[i]);
    }
    q->l = shadow_of(h->l);
    q->k = shadow_of(h->k);
    q->k_rest = is_shifted_sphere(m, h) ? qn_num_to_double(qn_num_sub(&m->maps.scratch, h->k, qn_num_from_double(&m->maps.scratch, q->k))) : INFINITY;
  }
  b->keys[b->half_count++] = key;
  return QUOIN_OK;
}

quoin_status qn_leaf_add(qn_maker *m, qn_leaf *leaf, qn_form_result *result) {
  const qn_local *l = &m->local;
  choose_pivot(m, leaf);
  qn_ctx *ctx = &m->maps.scratch;
  qn_mark mark = qn_arena_mark(&ctx->arena);
  double(*rows)[3][4] = qn_arena_take(&ctx->arena, l->count * sizeof *rows);
  quoin_status status = rows ? QUOIN_OK : QUOIN_E_MEMORY;
  int done = 0;
  if (status == QUOIN_OK && (done = rows_by_balls(m, leaf, rows)) == 0) {
    done = rows_by_numbers(m, leaf, rows, &status);
  }
  *result = done < 0 ? QN_FORM_EMPTY : QN_FORM_OK;
  leaf->half0 = (uint32_t)m->batch->half_count;
  leaf->halves = (uint32_t)l->count;
  leaf->convex = 1;
  for (size_t h = 0; status == QUOIN_OK && done > 0 && h < l->count; h++) {
    leaf->convex &= (uint8_t)is_convex(&l->halves[h]);
    status = m->batch->half_count < UINT32_MAX / 2 ? add_half(m, &l->halves[h], rows[h], leaf) : QUOIN_E_LIMIT;
  }
  if (status == QUOIN_OK && done > 0) {
    qn_leaf_extent(m, leaf);
  }
  qn_arena_release(&ctx->arena, mark);
  return status;
}
