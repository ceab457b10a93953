/* One surface along the line: solved once a question, by the filter where it is certain, else exactly. */
#include "base/bounds.h"
#include "ray/scratch.h"
#include "scene/super.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* What the filter makes of a half-space's stored numbers. */
enum { RANGE_UNKNOWN = 0, RANGE_PLAIN, RANGE_TINY, RANGE_WILD };

static uint8_t half_range(const quoin_scene *scene, const qn_leaf *leaf, const qn_half *half) {
  double v[20];
  size_t n;
  if (half->kind == QN_PLANE) {
    const qn_plane_shadow *p = &scene->planes[half->shadow];
    memcpy(v, p->n, sizeof p->n);
    v[3] = p->d;
    n = 4;
  } else {
    const qn_quadric_shadow *q = &scene->quadrics[half->shadow];
    memcpy(v, q->row, sizeof q->row);
    memcpy(v + 12, q->s, sizeof q->s);
    v[15] = q->l;
    v[16] = q->k;
    n = 17;
  }
  int range = qn_filter_range(v, n);
  if (range == 0 || qn_filter_range(leaf->pivot, 3) == 0) { /* a tiny pivot is only subtracted */
    return RANGE_WILD;
  }
  return range == 2 ? RANGE_TINY : RANGE_PLAIN;
}

void qn_solve_begin(qn_scratch *s, qn_line *line) {
  s->line = line;
  s->stamp++;
  if (s->stamp == 0) { /* after 2^32 questions */
    memset(s->memo, 0, s->scene->surface_count * sizeof *s->memo);
    s->stamp = 1;
  }
  s->solved_count = s->root_count = 0;
  s->rounded_ties = 0;
  qn_filter_line_make(line, &s->filter);
  s->counts.exact_rays += (uint64_t)s->filter.wild;
}

/* Room for a solved surface and its roots; QN_NO_SOLVED when refused. */
static uint32_t add_solved(qn_scratch *s, size_t roots) {
  if (!qn_grow(s->mem, &s->solved, &s->solved_capacity, s->solved_count + 1) ||
      !qn_grow(s->mem, &s->roots, &s->root_capacity, s->root_count + roots + 1)) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return QN_NO_SOLVED;
  }
  qn_solved *v = &s->solved[s->solved_count];
  memset(v, 0, sizeof *v);
  v->surface = QN_NO_SURFACE;
  v->root0 = (uint32_t)s->root_count;
  v->roots = (uint32_t)roots;
  s->root_count += roots + 1; /* one more, so that a touching place has room */
  return (uint32_t)s->solved_count++;
}

/* The double nearest to a root with its error; beyond the doubles' range, an enclosure that decides nothing. */
static qn_root_at nearest(qn_ctx *ctx, qn_root root) {
  double t = qn_root_to_double(ctx, root);
  if (fabs(t) > DBL_MAX) {
    return (qn_root_at){copysign(DBL_MAX, t), HUGE_VAL};
  }
  return (qn_root_at){t, QN_SLACK * QN_U * fabs(t) + QN_TINY};
}

static const qn_quad *make_quad(qn_scratch *s, uint32_t surface) {
  int made = 0;
  const qn_exact_surface *form = qn_scene_exact(s->scene, surface, &made);
  s->counts.exact_forms += (uint64_t)made;
  qn_quad *quad = qn_arena_take(&s->ctx.arena, sizeof *quad);
  if (!form || !quad) {
    qn_scratch_fail(s, form ? QUOIN_E_MEMORY : qn_scene_no_exact(s->scene, surface));
    return NULL;
  }
  qn_line_make_exact(&s->ctx, s->line);
  qn_line_quad(&s->ctx, s->line, form, quad);
  return quad;
}

const qn_quad *qn_solved_quad(qn_scratch *s, uint32_t solved) {
  qn_solved *v = &s->solved[solved];
  if (!v->quad) {
    v->quad = make_quad(s, v->surface);
  }
  return v->quad;
}

static uint32_t solve_exactly(qn_scratch *s, uint32_t surface) {
  const qn_quad *quad = make_quad(s, surface);
  if (!quad) {
    return QN_NO_SOLVED;
  }
  s->counts.exact_signs++;
  size_t roots = 0;
  int sign = 0, touches = 0;
  switch (qn_quad_kind(quad)) {
  case QN_QUAD_ZERO: break;
  case QN_QUAD_CONSTANT: sign = quad->sign_c; break;
  case QN_QUAD_LINEAR:
    roots = 1;
    sign = -quad->sign_h;
    break;
  case QN_QUAD_NONE: sign = quad->sign_a; break;
  case QN_QUAD_DOUBLE:
    touches = 1;
    sign = quad->sign_a;
    break;
  case QN_QUAD_TWO:
    roots = 2;
    sign = quad->sign_a;
    break;
  }
  uint32_t at = add_solved(s, roots);
  if (at != QN_NO_SOLVED) {
    qn_solved *v = &s->solved[at];
    v->sign = (int8_t)sign;
    v->touches = (uint8_t)touches;
    v->quad = quad;
    for (size_t i = 0; i < roots + (size_t)touches; i++) {
      s->roots[v->root0 + i] = nearest(&s->ctx, (qn_root){quad, (int)i});
    }
  }
  return at;
}

enum { SUPER_ROOTS = 32 };

typedef struct super_asked {
  qn_scratch *s;
  const qn_super_form *form;
  int begun, power; /* begun: in doubles, whose t's are kept; else 2^power times t is asked for */
} super_asked;

/* The line in the solid's frame: X_i = row_i . ((origin + t direction)/w, 1). */
static int super_exactly(void *user, qn_super_exact *out) {
  super_asked *a = user;
  qn_ctx *ctx = &a->s->ctx;
  qn_line *line = a->s->line;
  a->s->counts.exact_signs++;
  qn_line_make_exact(ctx, line);
  qn_num o[4] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ONE}, d[3];
  for (int j = 0; j < 3 && !ctx->failed; j++) {
    o[j] = qn_num_from_rat(ctx, line->origin[j], line->w, 0);
    d[j] = qn_num_from_rat(ctx, line->direction[j], line->w, 0);
  }
  *out = (qn_super_exact){.ctx = ctx, .e = a->form->e, .n = a->form->n};
  for (int i = 0; i < 3 && !ctx->failed; i++) {
    out->O[i] = qn_num_dot(ctx, 4, a->form->row[i], o);
    out->D[i] = qn_num_dot(ctx, 3, a->form->row[i], d);
  }
  a->power = a->begun || ctx->failed ? 0 : qn_super_exact_scale(out);
  return !ctx->failed;
}

static uint32_t solve_super(qn_scratch *s, uint32_t surface) {
  quoin_status status = QUOIN_OK;
  const qn_super_form *form = qn_scene_super(s->scene, surface, &status);
  if (!form) {
    qn_scratch_fail(s, status);
    return QN_NO_SOLVED;
  }
  qn_super_frame frame;
  double found[SUPER_ROOTS][2], places[SUPER_ROOTS];
  int made = !s->line->rounded && qn_super_frame_make(&form->rows, s->line->o, s->line->d, &frame);
  super_asked asked = {s, form, made, 0};
  size_t n = qn_superquadric_roots(made ? &frame : NULL, super_exactly, &asked, found, SUPER_ROOTS), kept = 0;
  for (size_t i = 0; i < n; i++) { /* S10: a place is its double; a pair in one double is no stretch */
    double t = fmax(-DBL_MAX, fmin(ldexp(found[i][0] + 0.5 * (found[i][1] - found[i][0]), -asked.power), DBL_MAX));
    if (kept && places[kept - 1] == t) {
      kept--;
    } else {
      places[kept++] = t;
    }
  }
  uint32_t at = add_solved(s, kept);
  if (at != QN_NO_SOLVED) {
    qn_solved *v = &s->solved[at];
    v->kind = QN_SOLVED_EXACTLY;
    v->sign = 1;
    for (size_t i = 0; i < kept; i++) {
      s->roots[v->root0 + i] = (qn_root_at){places[i] == 0 ? 0 : places[i], 0};
    }
  }
  return at;
}

uint32_t qn_solve_half(qn_scratch *s, const qn_leaf *leaf, qn_filter_leaf *frame, uint32_t index) {
  const qn_half *half = &s->scene->halves[index];
  qn_memo *memo = &s->memo[half->surface];
  if (memo->stamp == s->stamp) {
    return memo->solved;
  }
  uint32_t at;
  if (half->kind == QN_SUPER_BODY) {
    at = solve_super(s, half->surface);
  } else {
    if (s->range[index] == RANGE_UNKNOWN) {
      s->range[index] = half_range(s->scene, leaf, half);
    }
    int range = s->range[index];
    qn_filtered f;
    int certain = 0;
    if (range != RANGE_WILD && !s->filter.wild) {
      certain = half->kind == QN_PLANE ? qn_filter_plane(&s->filter, frame, &s->scene->planes[half->shadow], range == RANGE_TINY, &f)
                                       : qn_filter_quadric(&s->filter, frame, &s->scene->quadrics[half->shadow], range == RANGE_TINY, &f);
    }
    if (certain) {
      s->counts.filter_sure++;
      at = add_solved(s, (size_t)f.count);
      if (at != QN_NO_SOLVED) {
        /* cppcheck-suppress uninitStructMember ; the filters write all of it when they are certain */
        s->solved[at].sign = (int8_t)(half->side * f.sign);
        for (int i = 0; i < f.count; i++) {
          s->roots[s->solved[at].root0 + (size_t)i] = f.at[i];
        }
      }
    } else {
      at = solve_exactly(s, half->surface);
    }
  }
  if (at != QN_NO_SOLVED) {
    s->solved[at].surface = half->surface;
    *memo = (qn_memo){s->stamp, at};
  }
  return at;
}

qn_bound qn_bound_from_place(qn_scratch *s, const qn_place *p) {
  qn_bound b = {p->t, p->e, QN_NO_SOLVED, QN_NO_HALF, 0};
  if (p->surface == QN_NO_SURFACE && isinf(p->t) && qn_int_sign(p->den) == 0) {
    return b;
  }
  if (p->surface != QN_NO_SURFACE && s->memo[p->surface].stamp == s->stamp) {
    b.solved = s->memo[p->surface].solved;
    b.which = (uint32_t)p->which;
    return b;
  }
  uint32_t at = add_solved(s, (size_t)p->which + 1);
  if (at == QN_NO_SOLVED) {
    return b;
  }
  qn_solved *v = &s->solved[at];
  v->surface = p->surface;
  v->kind = p->surface == QN_NO_SURFACE && !p->turn ? QN_SOLVED_EXACTLY : QN_SOLVED_SURFACE;
  v->quad = p->turn;
  if (qn_int_sign(p->den) > 0) {
    v->rational = 1;
    v->num = p->num;
    v->den = p->den;
  }
  b.solved = at;
  b.which = (uint32_t)p->which;
  s->roots[v->root0 + b.which] = (qn_root_at){b.t, b.e};
  return b;
}

qn_bound qn_bound_from_root(qn_scratch *s, qn_root root) {
  qn_root_at at = nearest(&s->ctx, root);
  const qn_place place = {.t = at.t, .e = at.e, .surface = QN_NO_SURFACE, .which = root.which, .turn = root.q};
  return qn_bound_from_place(s, &place);
}

qn_place qn_bound_place(const qn_scratch *s, const qn_bound *b) {
  qn_place p = {.t = b->t, .e = b->e, .surface = QN_NO_SURFACE};
  if (b->solved != QN_NO_SOLVED) {
    const qn_solved *v = &s->solved[b->solved];
    if (v->kind == QN_SOLVED_SURFACE) {
      p.surface = v->surface;
      p.which = (int)b->which;
      p.turn = v->surface == QN_NO_SURFACE ? v->quad : NULL;
    } else if (v->rational) {
      p.num = v->num;
      p.den = v->den;
    }
  }
  return p;
}
