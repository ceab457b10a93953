/* Places where what is beside a line that runs in surfaces may change although it crosses no surface.

   Legend: the line o + t d; g_i(t) = g0 + t g1 the gradient along it of a surface i that holds it (d.g_i = 0 all along), H_i its Hessian. Next to a point of
   the line the surfaces are a fan of sheets about it, to first order their tangent planes. The fan's order can change only where
   - a surface has no tangent plane: g_i = 0 (an apex: behind it the other nappe begins);
   - two tangent planes are one: d.(g_i x g_j) = 0, a quadratic in t; of a pair of planes whose edge is the line (g_i = 0 all along) and a surface with g_j: a plane of the
     pair is the tangent plane, eᵗH_i e = 0 with e = d x g_j, a quadratic in t too;
   - two surfaces that touch all along the line have the same curvature across it: with e = d x g the direction in the tangent plane, and g_i : g_j as a_i : a_j,
         a_j eᵗH_i e - a_i eᵗH_j e = 0.
     Of developable surfaces e is constant and a_i, a_j are linear in t; of doubly ruled ones a_i : a_j is constant and e is linear. The
     two intersect, beside the doubled line, in a curve of degree two, which meets the line in these places.
   All of them are roots of quadratics with integers. A turn at which nothing changes does no harm. */
#include "base/limits.h"
#include "ray/around_cells.h"
#include "ray/scratch.h"

#include <string.h>

/* With more of which one changes along the line it is refused; about so many planes through a point are given up as well (QN_CELLS_WORK). */
enum { MOST_SURFACES = 160 };

typedef struct sheet {
  uint32_t solved, leaf, half;
  qn_germ germ;  /* at o */
  qn_xint g1[3]; /* the gradient's change to o + d */
  int steady;    /* g0 and g1 are parallel: so is the gradient all along */
} sheet;

typedef struct finder {
  qn_scratch *s;
  qn_ctx *ctx;
  sheet *sheets;
  size_t count, curved;
  qn_event *turns;
  size_t turn_count, turn_room;
} finder;

static int is_zero(const qn_xint v[3]) { return qn_x_sign(v[0]) == 0 && qn_x_sign(v[1]) == 0 && qn_x_sign(v[2]) == 0; }

static void settle(const qn_xint v[3], qn_int out[3]) {
  for (int i = 0; i < 3; i++) {
    out[i] = qn_settled(v[i]);
  }
}

/* The turns at the roots of a t^2 + b t + c. */
static void add_turns(finder *f, const sheet *of, qn_xint a, qn_xint b, qn_xint c) {
  qn_quad *quad = qn_arena_take(&f->ctx->arena, sizeof *quad);
  if (!quad) {
    f->ctx->failed = QUOIN_E_MEMORY;
    return;
  }
  qn_quad_make(f->ctx, qn_x_shl(f->ctx, a, 1), b, qn_x_shl(f->ctx, c, 1), quad);
  qn_quad_shape shape = qn_quad_kind(quad);
  int roots = shape == QN_QUAD_TWO ? 2 : shape == QN_QUAD_LINEAR || shape == QN_QUAD_DOUBLE;
  for (int i = 0; i < roots && f->turn_count < f->turn_room; i++) {
    qn_bound at = qn_bound_from_root(f->s, (qn_root){quad, i});
    at.half = of->half;
    f->turns[f->turn_count++] = (qn_event){.at = at, .leaf = of->leaf};
  }
}

static void apex(finder *f, const sheet *a) {
  if (!a->steady || is_zero(a->g1)) {
    return;
  }
  int k = 0;
  while (qn_x_sign(a->g1[k]) == 0) {
    k++;
  }
  add_turns(f, a, qn_x((qn_int){0, NULL}), a->g1[k], a->germ.g[k]);
}

/* a_j eᵗH_i e - a_i eᵗH_j e at u, v in place of e twice. */
static qn_xint bend(finder *f, const sheet *i, const sheet *j, qn_xint ai, qn_xint aj, const qn_int u[3], const qn_int v[3]) {
  qn_xint x = qn_x_mul(f->ctx, aj, qn_form_x(f->ctx, i->germ.h, u, v)), y = qn_x_mul(f->ctx, ai, qn_form_x(f->ctx, j->germ.h, u, v));
  return qn_x_sub(f->ctx, x, y);
}

/* e = d x g, at o and its change to o + d: the direction across the line in the tangent plane. */
static void tangent_direction(finder *f, const sheet *x, qn_int e0[3], qn_int e1[3]) {
  const qn_int *d = f->s->line->direction;
  qn_int g[3];
  settle(x->germ.g, g);
  qn_cross_int(f->ctx, d, g, e0);
  settle(x->g1, g);
  qn_cross_int(f->ctx, d, g, e1);
}

/* A pair of planes whose edge is the line, and a surface that is smooth along it. */
static void edge(finder *f, const sheet *pair, const sheet *other) {
  qn_int e0[3], e1[3];
  tangent_direction(f, other, e0, e1);
  const qn_xint *h = pair->germ.h, mixed = qn_form_x(f->ctx, h, e0, e1);
  add_turns(f, other, qn_form_x(f->ctx, h, e1, e1), qn_x_shl(f->ctx, mixed, 1), qn_form_x(f->ctx, h, e0, e0));
}

/* Two surfaces with one tangent plane all along the line, or of which one is singular there. */
static void touching(finder *f, const sheet *i, const sheet *j) {
  qn_ctx *ctx = f->ctx;
  const qn_int *d = f->s->line->direction;
  const qn_xint nought = qn_x((qn_int){0, NULL});
  const int i_edge = is_zero(i->germ.g) && is_zero(i->g1), j_edge = is_zero(j->germ.g) && is_zero(j->g1);
  if (i_edge || j_edge) {
    if (i_edge != j_edge) {
      edge(f, i_edge ? i : j, i_edge ? j : i);
    }
    return;
  }
  if (i->steady && j->steady) {
    const qn_xint *normal = is_zero(i->germ.g) ? i->g1 : i->germ.g;
    qn_int n[3], e[3];
    settle(normal, n);
    qn_cross_int(ctx, d, n, e);
    int m = 0;
    while (qn_x_sign(normal[m]) == 0) {
      m++;
    }
    add_turns(f, i, nought, bend(f, i, j, i->g1[m], j->g1[m], e, e), bend(f, i, j, i->germ.g[m], j->germ.g[m], e, e));
  } else if (!i->steady && !j->steady) {
    int m = 0;
    while (m < 2 && (qn_x_sign(i->g1[m]) == 0 || qn_x_sign(j->g1[m]) == 0)) {
      m++;
    }
    qn_int e0[3], e1[3];
    tangent_direction(f, i, e0, e1);
    qn_xint ai = i->g1[m], aj = j->g1[m], mixed = bend(f, i, j, ai, aj, e0, e1);
    add_turns(f, i, bend(f, i, j, ai, aj, e1, e1), qn_x_shl(ctx, mixed, 1), bend(f, i, j, ai, aj, e0, e0));
  }
}

static void pair(finder *f, const sheet *i, const sheet *j) {
  qn_ctx *ctx = f->ctx;
  const qn_int *d = f->s->line->direction;
  qn_xint v[3], c, b, a;
  qn_cross_x(ctx, i->germ.g, j->germ.g, v);
  c = qn_dot_x(ctx, v, d);
  qn_cross_x(ctx, i->g1, j->g1, v);
  a = qn_dot_x(ctx, v, d);
  qn_cross_x(ctx, i->germ.g, j->g1, v);
  b = qn_dot_x(ctx, v, d);
  qn_cross_x(ctx, i->g1, j->germ.g, v);
  b = qn_x_add(ctx, b, qn_dot_x(ctx, v, d));
  if (qn_x_sign(a) != 0 || qn_x_sign(b) != 0 || qn_x_sign(c) != 0) {
    add_turns(f, i, a, b, c);
  } else {
    touching(f, i, j);
  }
}

/* The surfaces that hold the line, each once. 0: memory was refused. */
static int gather(finder *f) {
  qn_scratch *s = f->s;
  uint8_t *seen = qn_arena_take(&s->ctx.arena, s->solved_count + 1);
  f->sheets = qn_arena_take(&s->ctx.arena, (s->solved_count + 1) * sizeof *f->sheets);
  if (!seen || !f->sheets) {
    return 0;
  }
  memset(seen, 0, s->solved_count + 1);
  for (size_t i = 0; i < s->event_count; i++) {
    const qn_event *e = &s->events[i];
    const qn_leaf *leaf = &s->scene->leaves[e->leaf];
    for (uint32_t h = leaf->half0; e->vague && e->enter && h < leaf->half0 + leaf->halves; h++) {
      const uint32_t solved = s->memo[s->scene->halves[h].surface].solved;
      if (s->solved[solved].sign == 0 && s->scene->halves[h].kind != QN_SUPER_BODY && !seen[solved]) {
        seen[solved] = 1;
        f->sheets[f->count++] = (sheet){.solved = solved, .leaf = e->leaf, .half = h};
        f->curved += s->scene->halves[h].kind != QN_PLANE;
      }
    }
  }
  return 1;
}

static void make_germs(finder *f) {
  qn_line *line = f->s->line;
  qn_line_make_exact(f->ctx, line);
  qn_point at = {.w = line->w}, next = {.w = line->w};
  for (int j = 0; j < 3; j++) {
    at.x[j] = line->origin[j];
    next.x[j] = qn_int_add(f->ctx, at.x[j], line->direction[j]);
  }
  for (size_t i = 0; i < f->count; i++) {
    sheet *x = &f->sheets[i];
    int made = 0;
    const qn_exact_surface *surface = qn_scene_exact(f->s->scene, f->s->scene->halves[x->half].surface, &made);
    f->s->counts.exact_forms += (uint64_t)made;
    if (!surface) {
      f->ctx->failed = qn_scene_no_exact(f->s->scene, f->s->scene->halves[x->half].surface);
      return;
    }
    qn_surface_germ_at(f->ctx, surface, &at, &x->germ);
    qn_surface_gradient_at(f->ctx, surface, &next, x->g1);
    for (int j = 0; j < 3; j++) {
      x->g1[j] = qn_x_sub(f->ctx, x->g1[j], x->germ.g[j]);
    }
    x->steady = qn_parallel_x(f->ctx, x->germ.g, x->g1);
  }
}

/* How many surfaces change along the line: of two that do not, nothing can turn. */
static size_t count_changing(const finder *f) {
  size_t n = 0;
  for (size_t i = 0; i < f->count; i++) {
    n += !is_zero(f->sheets[i].g1);
  }
  return n;
}

int qn_find_turns(qn_scratch *s, qn_event **out, size_t *count) {
  finder f = {.s = s, .ctx = &s->ctx};
  *out = NULL;
  *count = 0;
  if (!gather(&f)) {
    return 0;
  }
  if (f.curved == 0) {
    return 1;
  }
  (void)qn_scratch_spend(s, f.count, QN_EFFORT_CELL * QN_WORK_DEFINITE);
  make_germs(&f);
  if (s->ctx.failed || count_changing(&f) == 0) {
    return 1;
  }
  if (f.count > MOST_SURFACES) {
    qn_scratch_fail(s, QUOIN_E_LIMIT);
    return 1;
  }
  f.turn_room = f.curved + 2 * f.count * f.curved;
  f.turns = qn_arena_take(&s->ctx.arena, f.turn_room * sizeof *f.turns);
  if (!f.turns) {
    return 0;
  }
  (void)qn_scratch_spend(s, f.count * f.curved, QN_EFFORT_CELL * QN_WORK_DEFINITE);
  for (size_t i = 0; i < f.count && !s->ctx.failed; i++) {
    if (!f.sheets[i].germ.plane) {
      apex(&f, &f.sheets[i]);
    }
    for (size_t j = 0; j < i && !s->ctx.failed; j++) {
      if (!f.sheets[i].germ.plane || !f.sheets[j].germ.plane) {
        pair(&f, &f.sheets[i], &f.sheets[j]);
      }
    }
  }
  qn_order_places(s, f.turns, f.turn_count);
  size_t kept = 0;
  for (size_t i = 0; i < f.turn_count; i++) {
    if (kept == 0 || qn_bound_cmp(s, &f.turns[kept - 1].at, &f.turns[i].at) != 0) {
      f.turns[kept++] = f.turns[i];
    }
  }
  *out = f.turns;
  *count = kept;
  return 1;
}
