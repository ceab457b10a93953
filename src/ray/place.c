/* The order of places on the line: by enclosures where they are apart (scratch.h, qn_bound_cmp), by identity where both
   are the same root of the same surface, else exactly. */
#include "ray/scratch.h"

#include <math.h>

qn_root qn_bound_root(qn_scratch *s, const qn_bound *b) {
  const qn_solved *v = &s->solved[b->solved];
  if (v->kind == QN_SOLVED_SURFACE) {
    return (qn_root){qn_solved_quad(s, b->solved), (int)b->which};
  }
  qn_quad *quad = qn_arena_take(&s->ctx.arena, sizeof *quad);
  if (!quad) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return (qn_root){NULL, 0};
  }
  qn_int num = v->num, den = v->den;
  if (!v->rational) {
    qn_exact_double(&s->ctx, s->roots[v->root0 + b->which].t, &num, &den);
  }
  qn_quad_make(&s->ctx, qn_x(qn_int_from(&s->ctx, 0)), qn_x(den), qn_x(qn_int_neg(qn_int_shl(&s->ctx, num, 1))), quad);
  return (qn_root){quad, 0};
}

int qn_bound_cmp_slow(qn_scratch *s, const qn_bound *a, const qn_bound *b) {
  int by_double = (a->t > b->t) - (a->t < b->t);
  if (a->solved == b->solved && a->solved != QN_NO_SOLVED) {
    return (a->which > b->which) - (a->which < b->which);
  }
  if (a->solved == QN_NO_SOLVED || b->solved == QN_NO_SOLVED) {
    return by_double; /* an infinity */
  }
  const qn_solved *x = &s->solved[a->solved], *y = &s->solved[b->solved];
  if (x->kind == QN_SOLVED_EXACTLY && y->kind == QN_SOLVED_EXACTLY && !x->rational && !y->rational) {
    return by_double;
  }
  if (x->kind == QN_SOLVED_SURFACE && y->kind == QN_SOLVED_SURFACE && x->surface == y->surface && x->surface != QN_NO_SURFACE) {
    return (a->which > b->which) - (a->which < b->which);
  }
  qn_root p = qn_bound_root(s, a), q = qn_bound_root(s, b);
  if (!p.q || !q.q || s->ctx.failed) {
    return by_double; /* the question fails: its status says so */
  }
  s->counts.exact_orders++;
  return qn_root_cmp(&s->ctx, p, q);
}

int qn_bound_order(qn_scratch *s, const qn_bound *a, const qn_bound *b) {
  const int order = qn_bound_cmp(s, a, b);
  if (order || a->solved == b->solved || a->solved == QN_NO_SOLVED || b->solved == QN_NO_SOLVED) {
    return order;
  }
  const qn_solved *x = &s->solved[a->solved], *y = &s->solved[b->solved];
  if (x->kind == QN_SOLVED_EXACTLY && y->kind == QN_SOLVED_EXACTLY) {
    return 0;
  }
  const qn_root p = qn_bound_root(s, a), q = qn_bound_root(s, b);
  if (!p.q || !q.q || s->ctx.failed || !(qn_root_rounded(p) || qn_root_rounded(q))) {
    return 0;
  }
  s->rounded_ties = 1;
  return qn_root_cmp_stored(&s->ctx, p, q);
}

void qn_bound_between(qn_scratch *s, const qn_bound *a, const qn_bound *b, qn_int *num, qn_int *den) {
  qn_root none = {NULL, 0};
  qn_root x = a->solved == QN_NO_SOLVED ? none : qn_bound_root(s, a), y = b->solved == QN_NO_SOLVED ? none : qn_bound_root(s, b);
  *num = qn_int_from(&s->ctx, 0);
  *den = qn_int_from(&s->ctx, 1);
  if (x.q && y.q) {
    qn_root_between(&s->ctx, x, y, num, den);
  } else if (x.q) {
    qn_root_above(&s->ctx, x, num, den);
  } else if (y.q) {
    qn_root_below(&s->ctx, y, num, den);
  }
}

int qn_place_cmp(const quoin_scene *scene, qn_scratch *s, qn_line *line, const qn_place *a, const qn_place *b) {
  (void)scene;
  if (s->line != line) {
    qn_solve_begin(s, line);
  }
  size_t solved = s->solved_count, roots = s->root_count; /* bounds for the places live during this call */
  qn_bound x = qn_bound_from_place(s, a), y = qn_bound_from_place(s, b);
  int order = qn_bound_cmp(s, &x, &y);
  s->solved_count = solved;
  s->root_count = roots;
  return order;
}
