/* The cells along the plane T of a class of surfaces with parallel gradients (one surface or more).

   Legend: G the class's normal; a member's germ, turned so that its gradient points along G and divided by the
   gradient's size m, is 2 g.u + uᵗHu with one g for all. On u = e v + s G, v in T, e -> 0, its zero is the graph
       s = -e^2 k / (2 g.G) + O(e^3),    k = vᵗHv,
   so in the direction v the member with the larger k lies lower, and a point above i + 1 graphs and below the rest has those
   signs: a class of m members has m + 1 cells there. Ties: the difference of two germs is uᵗDu exactly (D is the difference
   of the two H). On a member's graph its sign is that of
       e^2 vᵗDv + 2 e s vᵗDG + s^2 GᵗDG,
   whose terms are looked at in turn; s has the sign of -k. If k = 0 and vᵗDv = 0, v runs in both surfaces, and if that is so
   for all v near, both contain T.

   The directions of T are +-(A + t B). Along t the order of the graphs, and the sides of the other surfaces, change only
   where a form has a root: each other class's normal (linear), each cone's H (quadratic), and D of each pair (quadratic). Between
   two roots one rational direction stands for all. A cone that contains T is there a plane of its own: a member with k = 0 whose
   gradient is along or against G by the sign of vᵗHG.

   At a root itself: where only one thing changes, both sides of it show all the cells. Where more meet, or a
   D has a double root (the order is kept but at its next term), the direction is looked at by itself (tangent.c) if it is
   rational; else the signs that meet there are left open. */
#include "ray/around_cells.h"

typedef struct member {
  uint32_t germ;
  int flat;      /* a cone that contains T */
  int orient;    /* along G or against; of a flat one, in the direction at hand */
  qn_xint size, h[6]; /* turned along G, not divided */
} member;

enum { PASS, TIE };
typedef struct turning {
  qn_quad quad;
  uint8_t kind, twice, linear;
  uint32_t a, b; /* PASS: a germ, its class's first. TIE: two members (indices in circle.members) */
} turning;

typedef struct circle {
  qn_cells *cells;
  uint32_t class;
  const qn_int *normal;
  qn_int along[3], across[3]; /* A and B */
  member *members;
  uint32_t *order;            /* members from the lowest graph up */
  size_t count;
  turning *turns;
  size_t turn_count;
  qn_walk_mark *marks;
  size_t mark_count;
  int at_infinity; /* a form has its root at B itself: another B is needed */
} circle;

static void *take(qn_ctx *ctx, size_t n, size_t size) {
  void *p = n > SIZE_MAX / 2 / size ? NULL : qn_arena_take(&ctx->arena, n * size);
  if (!p) {
    ctx->failed = QUOIN_E_MEMORY;
  }
  return p;
}

static void member_difference(qn_ctx *ctx, const member *a, const member *b, qn_xint d[6]) {
  for (int k = 0; k < 6; k++) {
    d[k] = qn_x_sub(ctx, qn_x_mul(ctx, b->size, a->h[k]), qn_x_mul(ctx, a->size, b->h[k]));
  }
}

/* --- the members and the changes ----------------------------------------------------------------------------------- */

static void note(circle *c, turning *turn, int shape) {
  c->turn_count++;
  qn_quad *quad = &c->turns[c->turn_count - 1].quad;
  int roots = shape == QN_QUAD_TWO ? 2 : shape == QN_QUAD_LINEAR || shape == QN_QUAD_DOUBLE ? 1 : 0;
  turn->twice |= shape == QN_QUAD_DOUBLE;
  for (int which = 0; which < roots; which++) {
    c->marks[c->mark_count++] = (qn_walk_mark){{quad, which}, (uint32_t)(c->turn_count - 1)};
  }
}

/* g.v on T; 0 when it is zero on all of T. */
static int add_linear(circle *c, const qn_xint g[3], int kind, int twice, uint32_t a, uint32_t b) {
  qn_ctx *ctx = c->cells->ctx;
  turning *turn = &c->turns[c->turn_count];
  *turn = (turning){.kind = (uint8_t)kind, .twice = (uint8_t)twice, .linear = 1, .a = a, .b = b};
  qn_xint at_a = qn_dot_x(ctx, g, c->along), at_b = qn_dot_x(ctx, g, c->across);
  int sa = qn_x_sign(at_a), sb = qn_x_sign(at_b);
  if (sa == 0 && sb == 0) {
    return 0;
  }
  if (sb == 0) {
    c->at_infinity = 1;
    return 1;
  }
  qn_quad_make(ctx, qn_x((qn_int){0, NULL}), at_b, qn_x_scale(ctx, at_a, 2), &turn->quad);
  note(c, turn, QN_QUAD_LINEAR);
  return 1;
}

/* vᵗHv on T; 0 when it is zero on all of T. */
static int add_form(circle *c, const qn_xint h[6], int kind, int twice, uint32_t a, uint32_t b) {
  qn_ctx *ctx = c->cells->ctx;
  turning *turn = &c->turns[c->turn_count];
  *turn = (turning){.kind = (uint8_t)kind, .twice = (uint8_t)twice, .a = a, .b = b};
  qn_quad_make(ctx, qn_form_x(ctx, h, c->across, c->across), qn_form_x(ctx, h, c->along, c->across), qn_form_x(ctx, h, c->along, c->along),
               &turn->quad);
  qn_quad_shape shape = qn_quad_kind(&turn->quad);
  if (shape == QN_QUAD_ZERO) {
    return 0;
  }
  if (turn->quad.sign_a == 0) {
    c->at_infinity = 1;
    return 1;
  }
  note(c, turn, (int)shape);
  return 1;
}

/* A pair's order changes at the roots of D on T; if D is zero there, where a term of its successors changes. */
static void add_tie(circle *c, uint32_t i, uint32_t j) {
  qn_ctx *ctx = c->cells->ctx;
  qn_xint d[6];
  member_difference(ctx, &c->members[i], &c->members[j], d);
  if (!add_form(c, d, TIE, 0, i, j) && add_form(c, c->members[i].h, TIE, 1, i, j)) {
    qn_xint slope[3];
    qn_form_apply(ctx, d, c->normal, slope);
    add_linear(c, slope, TIE, 1, i, j);
  }
}

static void add_member(circle *c, uint32_t germ) {
  const qn_germ *g = &c->cells->germs[germ];
  member *m = &c->members[c->count++];
  *m = (member){.germ = germ, .orient = g->orient, .size = g->size};
  for (int k = 0; k < 6; k++) {
    m->h[k] = g->orient < 0 ? qn_x_neg(g->h[k]) : g->h[k];
  }
}

static void add_flat(circle *c, uint32_t germ) {
  qn_ctx *ctx = c->cells->ctx;
  member *m = &c->members[c->count++];
  *m = (member){.germ = germ, .flat = 1, .orient = 1, .size = qn_x(qn_int_from(ctx, 1))};
  for (int k = 0; k < 6; k++) {
    m->h[k] = qn_x((qn_int){0, NULL});
  }
}

/* All members and marks for the basis A, B. */
static void gather(circle *c) {
  qn_cells *cells = c->cells;
  qn_ctx *ctx = cells->ctx;
  c->count = c->turn_count = c->mark_count = 0;
  c->at_infinity = 0;
  for (uint32_t i = 0; i < cells->n; i++) {
    const qn_germ *g = &cells->germs[i];
    if (g->class == c->class) {
      add_member(c, i);
    } else if (g->singular) {
      qn_xint slope[3];
      if (!add_form(c, g->h, PASS, 0, i, i) && cells->singular_count == 1) {
        qn_form_apply(ctx, g->h, c->normal, slope);
        if (add_linear(c, slope, PASS, 1, i, i)) {
          add_flat(c, i);
        }
      }
    }
  }
  for (uint32_t k = 0; k < cells->class_count; k++) {
    if (k != c->class) {
      uint32_t first = cells->classes[k].first;
      add_linear(c, cells->germs[first].g, PASS, 0, first, first);
    }
  }
  for (uint32_t i = 0; i < c->count; i++) {
    for (uint32_t j = i + 1; j < c->count && qn_cells_spend(cells, 1, QN_WORK_DEFINITE); j++) {
      add_tie(c, i, j);
    }
  }
}

/* --- one direction between changes --------------------------------------------------------------------------------- */

/* -1: a's graph lies below b's in the direction v. */
static int graph_order(const circle *c, const qn_int v[3], const member *a, const member *b) {
  qn_ctx *ctx = c->cells->ctx;
  qn_xint d[6];
  (void)qn_cells_spend(c->cells, 1, QN_WORK_ORDER);
  member_difference(ctx, a, b, d);
  int sign = qn_x_sign(qn_form_x(ctx, d, v, v));
  if (sign != 0) {
    return -sign;
  }
  int k = qn_x_sign(qn_form_x(ctx, a->h, v, v));
  if (k == 0) {
    return 0;
  }
  sign = qn_x_sign(qn_form_x(ctx, d, v, c->normal));
  if (sign != 0) {
    return k * sign;
  }
  return -qn_x_sign(qn_form_x(ctx, d, c->normal, c->normal));
}

/* The signs of all surfaces that are not of the class, and the order of those that are. */
static void look(circle *c, const qn_int v[3]) {
  qn_cells *cells = c->cells;
  qn_ctx *ctx = cells->ctx;
  if (!qn_cells_spend(cells, cells->n, 1)) {
    return;
  }
  for (uint32_t i = 0; i < cells->n; i++) {
    const qn_germ *g = &cells->germs[i];
    cells->signs[i] = 0;
    if (g->opaque || g->class == c->class) {
      continue;
    }
    if (!g->singular) {
      cells->signs[i] = (int8_t)(g->orient * qn_germ_sign(ctx, &cells->germs[cells->classes[g->class].first], v));
    } else if (cells->singular_count == 1) {
      int sign = qn_germ_sign(ctx, g, v);
      cells->signs[i] = (int8_t)(sign != 0 ? sign : qn_x_sign(qn_form_x(ctx, g->h, c->normal, c->normal)));
    }
  }
  for (size_t i = 0; i < c->count; i++) {
    member *m = &c->members[i];
    if (m->flat) {
      m->orient = qn_x_sign(qn_form_x(ctx, cells->germs[m->germ].h, v, c->normal));
    }
    size_t at = i;
    while (at > 0 && !qn_cells_done(cells) && graph_order(c, v, m, &c->members[c->order[at - 1]]) < 0) {
      c->order[at] = c->order[at - 1];
      at--;
    }
    c->order[at] = (uint32_t)i;
  }
}

/* The point above the graphs order[0 .. low), below order[high ..), open between. */
static void give_level(circle *c, size_t low, size_t high) {
  for (size_t i = 0; i < c->count; i++) {
    const member *m = &c->members[c->order[i]];
    c->cells->signs[m->germ] = (int8_t)(i < low ? m->orient : i < high ? 0 : -m->orient);
  }
  qn_cells_give(c->cells);
}

static void give_gap(circle *c, const qn_int v[3]) {
  look(c, v);
  for (size_t level = 0; level <= c->count && !qn_cells_done(c->cells); level++) {
    if (level == 0 || level == c->count ||
        graph_order(c, v, &c->members[c->order[level - 1]], &c->members[c->order[level]]) != 0) {
      give_level(c, level, level);
    }
  }
}

/* --- the places of change ------------------------------------------------------------------------------------------ */

/* More meets here than the two sides show. */
static int is_crowded(const circle *c, size_t first, size_t end) {
  size_t ties = 0, passes = 0, twice = 0, full = 0;
  const qn_cells *cells = c->cells;
  for (size_t i = first; i < end; i++) {
    const turning *turn = &c->turns[c->marks[i].tag];
    ties += turn->kind == TIE;
    passes += turn->kind == PASS;
    twice += turn->twice;
    if (turn->kind == PASS && !cells->germs[turn->a].singular) {
      full += cells->classes[cells->germs[turn->a].class].members > 1 && c->count > 1;
    }
  }
  return twice != 0 || full != 0 || ties > 1 || passes > 1 || (ties != 0 && passes != 0);
}

/* p A + q B, settled. */
static void direction(const circle *c, qn_xint p, qn_xint q, qn_int v[3]) {
  qn_ctx *ctx = c->cells->ctx;
  for (int k = 0; k < 3; k++) {
    v[k] = qn_settled(qn_x_add(ctx, qn_x_mul(ctx, p, qn_x(c->along[k])), qn_x_mul(ctx, q, qn_x(c->across[k]))));
  }
}

/* The direction of a mark when it is rational. */
static int rational_direction(const circle *c, const qn_walk_mark *mark, qn_int v[3]) {
  qn_ctx *ctx = c->cells->ctx;
  const qn_quad *q = mark->root.q;
  switch (qn_quad_kind(q)) {
    case QN_QUAD_LINEAR: /* t = -c / 2h */
      direction(c, qn_x_scale(ctx, q->h, 2), qn_x_neg(q->c), v);
      return 1;
    case QN_QUAD_DOUBLE: /* t = -h / a */
      direction(c, q->a, qn_x_neg(q->h), v);
      return 1;
    case QN_QUAD_TWO: {
      if (q->disc.v.n <= 0 || q->disc.mag != QN_EXACT) {
        return 0;
      }
      int exact = 0;
      qn_xint root = qn_x(qn_int_sqrt(ctx, q->disc.v, &exact));
      int minus = (mark->root.which == 0) == (q->sign_a > 0);
      direction(c, q->a, qn_x_sub(ctx, minus ? qn_x_neg(root) : root, q->h), v);
      return exact;
    }
    case QN_QUAD_ZERO:
    case QN_QUAD_CONSTANT:
    case QN_QUAD_NONE:
      break;
  }
  return 0;
}

/* At an irrational direction: what meets is left open, beside the direction v just before it. */
static void give_open(circle *c, const qn_int v[3], size_t first, size_t end) {
  qn_cells *cells = c->cells;
  look(c, v);
  for (size_t i = first; i < end; i++) {
    const turning *pass = &c->turns[c->marks[i].tag];
    for (uint32_t k = 0; k < cells->n && pass->kind == PASS; k++) {
      const qn_germ *g = &cells->germs[k];
      if (k == pass->a || (g->class != UINT32_MAX && g->class == cells->germs[pass->a].class)) {
        cells->signs[k] = 0;
      }
    }
  }
  for (size_t i = first; i < end && !qn_cells_done(cells); i++) {
    const turning *tie = &c->turns[c->marks[i].tag];
    size_t low = c->count, high = 0;
    if (tie->kind != TIE) {
      continue;
    }
    /* Members that tie lie side by side in the order before the place: the stretch of all that are linked. */
    for (size_t before = 0; high - low != before;) {
      before = high - low;
      for (size_t j = first; j < end; j++) {
        const turning *other = &c->turns[c->marks[j].tag];
        size_t a = 0, b = 0;
        if (other->kind != TIE) {
          continue;
        }
        for (size_t k = 0; k < c->count; k++) {
          a = c->order[k] == other->a ? k : a;
          b = c->order[k] == other->b ? k : b;
        }
        size_t from = a < b ? a : b, to = (a < b ? b : a) + 1;
        if (other == tie || (from < high && to > low)) {
          low = from < low ? from : low;
          high = to > high ? to : high;
        }
      }
    }
    give_level(c, low, high);
  }
}

/* In a direction v of T in which D has a double root, the order is kept beside v but for what bends away from it: on u = e v + e^2 z B + s G, B in T, the
   difference of two members is, when v runs in their surfaces (k = 0),
       e^4 (z^2 BᵗDB - 2 z (vᵗHB / g.G) vᵗDG) + O(e^5),    s = -e^3 z vᵗHB / g.G + O(e^4),
   which has both signs unless vᵗHB or vᵗDG is 0. */
static int bends(const circle *c, const qn_int v[3], const qn_xint h[6], const qn_xint d[6]) {
  qn_ctx *ctx = c->cells->ctx;
  return qn_x_sign(qn_form_x(ctx, h, v, v)) == 0 && qn_x_sign(qn_form_x(ctx, d, v, c->normal)) != 0 &&
         (qn_x_sign(qn_form_x(ctx, h, v, c->along)) != 0 || qn_x_sign(qn_form_x(ctx, h, v, c->across)) != 0) &&
         qn_x_sign(qn_form_x(ctx, d, v, v)) == 0 && qn_x_sign(qn_form_x(ctx, d, v, c->along)) == 0 && qn_x_sign(qn_form_x(ctx, d, v, c->across)) == 0;
}

/* Whether two members part so about a direction of change. */
static int any_bends(const circle *c, const qn_int v[3], size_t first, size_t end) {
  for (size_t i = first; i < end; i++) {
    const turning *turn = &c->turns[c->marks[i].tag];
    if (turn->kind != TIE || !turn->twice || turn->linear) { /* a cone that touches T along v: qn_cells_direction has it */
      continue;
    }
    qn_xint d[6];
    member_difference(c->cells->ctx, &c->members[turn->a], &c->members[turn->b], d);
    const int flat = qn_x_sign(qn_form_x(c->cells->ctx, d, c->along, c->along)) == 0 && qn_x_sign(qn_form_x(c->cells->ctx, d, c->across, c->across)) == 0;
    if (!flat && bends(c, v, c->members[turn->a].h, d)) { /* a D that is 0 on T changes its sign with s: the two sides show that */
      return 1;
    }
  }
  return 0;
}

static void visit(circle *c, const qn_int v[3], size_t first, size_t end) {
  qn_cells *cells = c->cells;
  qn_int at[3], back[3];
  for (size_t i = first; i < end; i++) {
    if (rational_direction(c, &c->marks[i], at)) {
      for (int k = 0; k < 3; k++) {
        back[k] = qn_int_neg(at[k]);
      }
      qn_cells_direction(cells, at);
      qn_cells_direction(cells, back);
      if (!any_bends(c, at, first, end)) {
        return;
      }
      break;
    }
  }
  for (int k = 0; k < 3; k++) {
    back[k] = qn_int_neg(v[k]);
  }
  give_open(c, v, first, end);
  give_open(c, back, first, end);
}

static void walk(circle *c) {
  qn_cells *cells = c->cells;
  qn_ctx *ctx = cells->ctx;
  for (size_t at = 0;;) {
    qn_mark memory = qn_arena_mark(&ctx->arena);
    qn_int num, den, v[3] = {c->across[0], c->across[1], c->across[2]}, back[3]; /* the gap about t = infinity: B itself */
    if (at != 0 && at < c->mark_count) {
      qn_walk_between(ctx, c->marks, at, &num, &den);
      qn_combine_int(ctx, den, c->along, num, c->across, v);
    }
    for (int k = 0; k < 3; k++) {
      back[k] = qn_int_neg(v[k]);
    }
    give_gap(c, v);
    give_gap(c, back);
    if (at >= c->mark_count || qn_cells_done(cells)) {
      return;
    }
    size_t end = qn_walk_group(ctx, c->mark_count, c->marks, at);
    if (is_crowded(c, at, end)) {
      visit(c, v, at, end);
    }
    at = end;
    qn_arena_release(&ctx->arena, memory);
  }
}

void qn_cells_circle(qn_cells *cells, uint32_t class) {
  qn_ctx *ctx = cells->ctx;
  const qn_class *k = &cells->classes[class];
  circle c = {.cells = cells, .class = class, .normal = k->normal};
  size_t most = (size_t)k->members + 1, changes = cells->class_count + 2 * cells->singular_count + 2 * most * most;
  c.members = take(ctx, most, sizeof *c.members);
  c.order = take(ctx, most, sizeof *c.order);
  c.turns = take(ctx, changes + 1, sizeof *c.turns);
  c.marks = take(ctx, 2 * changes + 1, sizeof *c.marks);
  if (ctx->failed != QUOIN_OK) {
    return;
  }
  uint32_t z = k->axis, x = (z + 1) % 3, y = (z + 2) % 3;
  const qn_int zero = {0, NULL}, one = qn_int_from(ctx, 1);
  c.along[x] = c.across[y] = k->normal[z];
  c.along[y] = c.across[x] = zero;
  c.along[z] = qn_int_neg(k->normal[x]);
  c.across[z] = qn_int_neg(k->normal[y]);
  for (gather(&c); c.at_infinity && ctx->failed == QUOIN_OK; gather(&c)) { /* finitely many forms, two roots each */
    qn_combine_int(ctx, one, c.along, one, c.across, c.across);
  }
  qn_walk_sort(cells, c.mark_count, c.marks);
  walk(&c);
}
