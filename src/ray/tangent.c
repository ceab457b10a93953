/* The cells next to P + e v for a direction v in which the leading forms of several surfaces vanish: second order.

   Derivation. Put u = e v + e^2 w, e > 0 small. A smooth surface with g.v = 0 has
       q = e^2 (2 g.w + k) + O(e^3),    k = vᵗHv,
   so to second order it is the line 2 g.w + k = 0 in the plane of w (w counts modulo v, so two coordinates of it do). A
   cone with vᵗHv = 0 has q = 2 e^3 vᵗHw + O(e^4): the line Hv.w = 0. The cells of these lines are cells next to P. They are
   listed as those of a class's plane are: along each line, between its crossings with others, to both sides of it.

   Where three lines or more meet in a point, or two are one, third-order terms might open further cells, and what
   meets there is left open, unless
   - every surface contains the line P + t v (k = 0 for all: q vanishes on it exactly). Then next to each point of it the surfaces
     are a fan about one line, whose sides first order shows already; but where a cone and a curved surface have one tangent
     plane along it, their order within the fan is left open; or
   - the surfaces that meet share a curve: with a plane among them, their conics in it are the same; or they are of one
     pencil. Then they are a fan about that curve. */
#include "ray/around_cells.h"

typedef struct line {
  qn_xint a[3]; /* a0 x + a1 y + a2 = 0 */
  uint32_t germ;
  uint8_t same;  /* is the line being walked */
  int8_t orient; /* then: along it or against */
} line;

typedef struct fan {
  qn_cells *cells;
  const qn_int *v;
  line *lines;
  size_t count;
  int curved;     /* some surface leaves the line P + t v */
  int cones, bent; /* how many are cones, and smooth but no planes */
  uint32_t *meet; /* lines that meet in a point: indices in lines */
  size_t meet_count;
} fan;

static void *take(qn_ctx *ctx, size_t n, size_t size) {
  void *p = n > SIZE_MAX / 2 / size ? NULL : qn_arena_take(&ctx->arena, n * size);
  if (!p) {
    ctx->failed = QUOIN_E_MEMORY;
  }
  return p;
}

/* a0 b1 - a1 b0: not zero when the lines cross. */
static qn_xint slope(qn_ctx *ctx, const line *a, const line *b) {
  return qn_x_sub(ctx, qn_x_mul(ctx, a->a[0], b->a[1]), qn_x_mul(ctx, a->a[1], b->a[0]));
}

/* The signs of surfaces that v leaves, and the lines of those it touches. */
static void gather(fan *f) {
  qn_cells *cells = f->cells;
  qn_ctx *ctx = cells->ctx;
  int drop = 0;
  while (drop < 2 && f->v[drop].n == 0) {
    drop++;
  }
  int x = (drop + 1) % 3, y = (drop + 2) % 3;
  for (uint32_t i = 0; i < cells->n; i++) {
    const qn_germ *g = &cells->germs[i];
    cells->signs[i] = 0;
    if (g->opaque || (g->singular && cells->singular_count > 1)) {
      continue;
    }
    cells->signs[i] = (int8_t)qn_germ_sign(ctx, g, f->v);
    if (cells->signs[i] != 0) {
      continue;
    }
    line *l = &f->lines[f->count];
    *l = (line){.germ = i};
    if (g->singular) {
      qn_xint image[3];
      qn_form_apply(ctx, g->h, f->v, image);
      l->a[0] = image[x], l->a[1] = image[y], l->a[2] = qn_x((qn_int){0, NULL});
      f->cones++;
      f->count += qn_x_sign(image[x]) != 0 || qn_x_sign(image[y]) != 0; /* else its singular line: left open */
    } else {
      l->a[0] = qn_x_scale(ctx, g->g[x], 2), l->a[1] = qn_x_scale(ctx, g->g[y], 2);
      l->a[2] = qn_form_x(ctx, g->h, f->v, f->v);
      f->curved |= qn_x_sign(l->a[2]) != 0;
      f->bent += !g->plane;
      f->count++;
    }
  }
}

/* --- do the surfaces that meet share a curve? ---------------------------------------------------------------------- */

/* The conic of a germ in the plane spanned by p and q. */
static void conic(qn_ctx *ctx, const qn_germ *g, const qn_int p[3], const qn_int q[3], qn_xint out[5]) {
  out[0] = qn_dot_x(ctx, g->g, p);
  out[1] = qn_dot_x(ctx, g->g, q);
  out[2] = qn_form_x(ctx, g->h, p, p);
  out[3] = qn_form_x(ctx, g->h, p, q);
  out[4] = qn_form_x(ctx, g->h, q, q);
}

static int one_conic(const fan *f, size_t plane) {
  qn_ctx *ctx = f->cells->ctx;
  const qn_germ *base = &f->cells->germs[f->lines[f->meet[plane]].germ];
  const qn_class *k = &f->cells->classes[base->class];
  qn_int p[3];
  qn_cross_int(ctx, k->normal, f->v, p); /* v and p span the plane */
  qn_xint one[5];
  int have = 0;
  for (size_t i = 0; i < f->meet_count; i++) {
    if (i == plane) {
      continue;
    }
    qn_xint other[5];
    /* cppcheck-suppress legacyUninitvar ; conic writes it */
    conic(ctx, &f->cells->germs[f->lines[f->meet[i]].germ], f->v, p, have ? other : one);
    /* out[1] = g.p is not zero: the gradient crosses the plane's and is orthogonal to v. */
    for (int j = 0; j < 5 && have; j++) {
      if (qn_x_sign(qn_x_sub(ctx, qn_x_mul(ctx, one[1], other[j]), qn_x_mul(ctx, one[j], other[1]))) != 0) {
        return 0;
      }
    }
    have = 1;
  }
  return 1;
}

static int one_pencil(const fan *f) {
  qn_ctx *ctx = f->cells->ctx;
  const line *i = &f->lines[f->meet[0]], *j = &f->lines[f->meet[1]];
  const qn_germ *gi = &f->cells->germs[i->germ], *gj = &f->cells->germs[j->germ];
  for (size_t m = 2; m < f->meet_count; m++) {
    const line *k = &f->lines[f->meet[m]];
    const qn_germ *gk = &f->cells->germs[k->germ];
    /* C gk = A gi + B gj by Cramer's rule; is C Hk = A Hi + B Hj too? */
    qn_xint a = slope(ctx, k, j), b = slope(ctx, i, k), c = slope(ctx, i, j);
    for (int e = 0; e < 6; e++) {
      qn_xint sum = qn_x_add(ctx, qn_x_mul(ctx, a, gi->h[e]), qn_x_mul(ctx, b, gj->h[e]));
      if (qn_x_sign(qn_x_sub(ctx, qn_x_mul(ctx, c, gk->h[e]), sum)) != 0) {
        return 0;
      }
    }
  }
  return 1;
}

static int share_a_curve(const fan *f) {
  size_t plane = f->meet_count;
  for (size_t i = 0; i < f->meet_count; i++) {
    const line *l = &f->lines[f->meet[i]];
    if (f->cells->germs[l->germ].singular) {
      return 0;
    }
    plane = f->cells->germs[l->germ].plane ? i : plane;
    for (size_t j = 0; j < i; j++) {
      if (qn_x_sign(slope(f->cells->ctx, l, &f->lines[f->meet[j]])) == 0) {
        return 0;
      }
    }
  }
  return (plane < f->meet_count && one_conic(f, plane)) || one_pencil(f);
}

/* --- along one line ------------------------------------------------------------------------------------------------ */

/* Signs at the point (x, y)/n of the walked line, or just off the point where its last number is 0 (a direction) towards `foot`:
   of lines that do not contain it; those that are the line itself take `side` along its normal. */
static void look(fan *f, const qn_int point[3], const qn_int foot[3], int side) {
  qn_ctx *ctx = f->cells->ctx;
  (void)qn_cells_spend(f->cells, f->count, 1);
  for (size_t i = 0; i < f->count; i++) {
    const line *l = &f->lines[i];
    int sign = l->same ? l->orient * side : qn_x_sign(qn_dot_x(ctx, l->a, point));
    if (sign == 0 && !l->same && point[2].n == 0) { /* parallel to the walked line */
      sign = qn_x_sign(qn_dot_x(ctx, l->a, foot));
    }
    f->cells->signs[l->germ] = (int8_t)sign;
  }
}

static void give_vertex(fan *f, const qn_int before[3], const qn_int foot[3], size_t first, size_t end, const qn_walk_mark *marks) {
  f->meet_count = 0;
  for (size_t i = 0; i < f->count; i++) {
    if (f->lines[i].same) {
      f->meet[f->meet_count++] = (uint32_t)i;
    }
  }
  for (size_t i = first; i < end; i++) {
    f->meet[f->meet_count++] = marks[i].tag;
  }
  (void)qn_cells_spend(f->cells, f->meet_count * f->meet_count, 1);
  if (f->meet_count < 3 || qn_cells_done(f->cells) || share_a_curve(f)) {
    return;
  }
  look(f, before, foot, 0);
  for (size_t i = 0; i < f->meet_count; i++) {
    f->cells->signs[f->lines[f->meet[i]].germ] = 0;
  }
  qn_cells_give(f->cells);
}

static void walk(fan *f, size_t walked) {
  qn_cells *cells = f->cells;
  qn_ctx *ctx = cells->ctx;
  const line *base = &f->lines[walked];
  const qn_int a = qn_settled(base->a[0]), b = qn_settled(base->a[1]), c = qn_settled(base->a[2]);
  /* The point t of the line is (-c a + t b, -c b - t a)/n, n = a^2 + b^2. */
  const qn_int n = qn_int_add(ctx, qn_int_mul(ctx, a, a), qn_int_mul(ctx, b, b));
  const qn_int foot[3] = {qn_int_neg(qn_int_mul(ctx, c, a)), qn_int_neg(qn_int_mul(ctx, c, b)), n};
  const qn_int way[3] = {b, qn_int_neg(a), {0, NULL}};
  qn_quad *quads = take(ctx, f->count, sizeof *quads);
  qn_walk_mark *marks = take(ctx, f->count, sizeof *marks);
  size_t mark_count = 0, same = 0;
  int cone = 0, bent = 0;
  if (ctx->failed != QUOIN_OK || !qn_cells_spend(cells, f->count, QN_WORK_ORDER)) {
    return;
  }
  for (size_t i = 0; i < f->count; i++) {
    line *l = &f->lines[i];
    qn_xint rise = qn_dot_x(ctx, l->a, way);
    l->same = 0;
    if (i == walked || qn_parallel_x(ctx, l->a, base->a)) {
      if (i < walked) {
        return; /* walked already */
      }
      qn_xint along = qn_x_add(ctx, qn_x_mul(ctx, l->a[0], base->a[0]), qn_x_mul(ctx, l->a[1], base->a[1]));
      l->same = 1;
      l->orient = (int8_t)qn_x_sign(along);
      same++;
      cone |= cells->germs[l->germ].singular;
      bent |= !cells->germs[l->germ].singular && !cells->germs[l->germ].plane;
    } else if (qn_x_sign(rise) != 0) {
      qn_quad_make(ctx, qn_x((qn_int){0, NULL}), rise, qn_x_scale(ctx, qn_dot_x(ctx, l->a, foot), 2), &quads[mark_count]);
      marks[mark_count] = (qn_walk_mark){{&quads[mark_count], 0}, (uint32_t)i};
      mark_count++;
    }
  }
  if (!f->curved && !(cone && bent)) {
    return; /* first order shows it all */
  }
  qn_walk_sort(cells, mark_count, marks);
  for (size_t at = 0; !qn_cells_done(cells);) {
    qn_int num, den, point[3];
    if (at != 0 && at < mark_count) {
      qn_walk_between(ctx, marks, at, &num, &den);
      qn_combine_int(ctx, den, foot, num, way, point);
    } else { /* the limit at t = -infinity or infinity */
      for (int k = 0; k < 3; k++) {
        point[k] = at == 0 ? qn_int_neg(way[k]) : way[k];
      }
    }
    look(f, point, foot, same > 1 ? 0 : -1); /* lines that are one: left open */
    qn_cells_give(cells);
    if (same == 1) {
      look(f, point, foot, 1);
      qn_cells_give(cells);
    }
    if (at >= mark_count) {
      return;
    }
    size_t end = qn_walk_group(ctx, mark_count, marks, at);
    if (f->curved) {
      give_vertex(f, point, foot, at, end, marks);
    }
    at = end;
  }
}

void qn_cells_direction(qn_cells *cells, const qn_int v[3]) {
  qn_ctx *ctx = cells->ctx;
  fan f = {.cells = cells, .v = v};
  f.lines = take(ctx, cells->n, sizeof *f.lines);
  f.meet = take(ctx, cells->n, sizeof *f.meet);
  if (ctx->failed != QUOIN_OK) {
    return;
  }
  (void)qn_cells_spend(cells, cells->n, 4);
  gather(&f);
  if (!f.curved && (f.cones == 0 || f.bent == 0)) {
    return; /* first order shows it all, whichever line is walked */
  }
  for (size_t i = 0; i < f.count && !qn_cells_done(cells); i++) {
    qn_mark mark = qn_arena_mark(&ctx->arena);
    walk(&f, i);
    qn_arena_release(&ctx->arena, mark);
  }
}
