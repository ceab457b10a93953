/* The shift to the pivot is exact: with c_j = C_j / w for integers C_j, w a power of two, the form q(c + y) times w^2 has the integers

     quadratic  w^2 A ... w^2 F
     linear     w (w G + 2 A C_0 + D C_1 + E C_2), likewise H and I
     constant   w (w J + G C_0 + H C_1 + I C_2) + A C_0^2 + B C_1^2 + C C_2^2 + D C_0 C_1 + E C_0 C_2 + F C_1 C_2. */
#include "scene/rounding.h"

#include "base/bounds.h"
#include "base/limits.h"
#include "number/quad.h"
#include "scene/compile.h"

#include <math.h>

static const int PAIR[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

static void add_product(qn_ctx *ctx, qn_int *sum, qn_int a, qn_int b) {
  if (qn_int_sign(a) && qn_int_sign(b)) {
    *sum = qn_int_add(ctx, *sum, qn_int_mul(ctx, a, b));
  }
}

/* The integers of the shifted form, a positive multiple. */
static void shift(qn_ctx *ctx, const qn_exact_surface *form, const double pivot[3], qn_int out[10]) {
  qn_rat c[3];
  size_t w = 0; /* here the exponent */
  for (int j = 0; j < 3; j++) {
    c[j] = qn_num_rat(ctx, qn_num_from_double(ctx, pivot[j]));
    size_t bits = qn_int_trailing_zeros(c[j].den);
    w = bits > w ? bits : w;
  }
  for (int j = 0; j < 3; j++) {
    c[j].num = qn_int_shl(ctx, c[j].num, w - qn_int_trailing_zeros(c[j].den));
  }
  out[9] = qn_int_shl(ctx, form->q[9], w);
  for (int j = 0; j < 3; j++) {
    out[6 + j] = qn_int_shl(ctx, form->q[6 + j], w);
    add_product(ctx, &out[9], form->q[6 + j], c[j].num);
  }
  out[9] = qn_int_shl(ctx, out[9], w);
  for (int i = 0; i < 6; i++) {
    int a = PAIR[i][0], b = PAIR[i][1];
    out[i] = qn_int_shl(ctx, form->q[i], 2 * w);
    if (qn_int_sign(form->q[i])) {
      add_product(ctx, &out[6 + a], form->q[i], c[b].num);
      add_product(ctx, &out[6 + b], form->q[i], c[a].num); /* twice the one product where a = b, as it should be */
      add_product(ctx, &out[9], form->q[i], qn_int_mul(ctx, c[a].num, c[b].num));
    }
  }
  for (int j = 0; j < 3; j++) {
    out[6 + j] = qn_int_shl(ctx, out[6 + j], w);
  }
}

/* a 2^-scale as a sum of two doubles, |a| <= 2^scale: two cuts at 53 bits, each below 2^-52 of what it cuts. */
static void split(qn_ctx *ctx, qn_int a, int64_t scale, double *hi, double *lo) {
  double m, rest = 0;
  int64_t e, f = 0;
  *hi = *lo = 0;
  qn_int_frexp(a, &m, &e);
  if (m == 0 || e - scale < QN_ROUND_DROP) {
    return;
  }
  if (e > 53) {
    qn_int top = qn_int_shl(ctx, qn_int_from(ctx, (int64_t)ldexp(m, 53)), (size_t)(e - 53));
    qn_int_frexp(qn_int_sub(ctx, a, top), &rest, &f);
  }
  double x = ldexp(m, (int)(e - scale)), y = f - scale < -1000 ? 0 : ldexp(rest, (int)(f - scale));
  *hi = x + y;
  *lo = y - (*hi - x);
}

/* The coordinates that occur, also in terms too small to keep (the bounds need the size of their coordinates), first. */
static unsigned order_axes(const qn_int q[10], uint8_t axis[3]) {
  unsigned occurs = 0, n = 0;
  for (int i = 0; i < 9; i++) {
    if (qn_int_sign(q[i])) {
      occurs |= i < 6 ? 1u << PAIR[i][0] | 1u << PAIR[i][1] : 1u << (i - 6);
    }
  }
  for (unsigned there = 2; there-- > 0;) {
    for (unsigned j = 0; j < 3; j++) {
      if ((occurs >> j & 1) == there) {
        axis[n++] = (uint8_t)j;
      }
    }
  }
  return (occurs & 1) + (occurs >> 1 & 1) + (occurs >> 2);
}

/* Where G x + J = 0 stands: the nearest double, and the double nearest to what that lacks. */
static void stand(qn_ctx *ctx, qn_int g, qn_int j, double place[2]) {
  qn_int num = qn_int_sub(ctx, qn_int_from(ctx, 0), j), den = g;
  double m;
  int64_t e;
  place[0] = qn_rat_to_double(ctx, num, den), place[1] = 0;
  if (place[0] == 0 || !isfinite(place[0])) {
    return;
  }
  m = frexp(place[0], &(int){0});
  e = ilogb(place[0]) + 1 - 53; /* place[0] = m 2^53 2^e */
  qn_int whole = qn_int_from(ctx, (int64_t)ldexp(m, 53));
  if (e >= 0) {
    whole = qn_int_shl(ctx, whole, (size_t)e);
  } else {
    num = qn_int_shl(ctx, num, (size_t)-e);
  }
  num = qn_int_sub(ctx, num, qn_int_mul(ctx, whole, den));
  place[1] = qn_rat_to_double(ctx, num, e >= 0 ? den : qn_int_shl(ctx, den, (size_t)-e));
}

static void fill(qn_ctx *ctx, const qn_exact_surface *form, const double pivot[3], qn_rounding *out) {
  static const int product[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}}; /* where the coefficient of two coordinates is */
  qn_int q[10];
  shift(ctx, form, pivot, q);
  unsigned axes = order_axes(q, out->axis);
  size_t scale = 0;
  for (int i = 0; i < 10; i++) {
    size_t bits = qn_int_bits(q[i]);
    scale = bits > scale ? bits : scale;
  }
  double *hi = out->k + QN_ROUNDING_HI, *lo = out->k + QN_ROUNDING_LO, most[3] = {0, 0, 0}; /* by degree */
  for (int i = 0; i < 10; i++) {
    int degree = i < 6 ? 2 : i < 9 ? 1 : 0;
    qn_int from = degree == 2 ? q[product[out->axis[PAIR[i][0]]][out->axis[PAIR[i][1]]]] : degree == 1 ? q[6 + out->axis[i - 6]] : q[9];
    split(ctx, from, (int64_t)scale, &hi[i], &lo[i]);
    most[degree] = fmax(most[degree], fabs(hi[i]));
  }
  for (int j = 0; j < 3; j++) {
    out->k[QN_ROUNDING_PIVOT + j] = pivot[out->axis[j]];
  }
  out->k[QN_ROUNDING_SQUARE] = form->plane ? 0 : most[2] + QN_ROUND_SQUARE_TINY;
  out->k[QN_ROUNDING_LINEAR] = most[1] + QN_ROUND_LINEAR_TINY;
  out->k[QN_ROUNDING_CONSTANT] = most[0] + QN_ROUND_TINY;
  if (form->plane) {
    out->kind = axes == 1 ? QN_ROUNDING_AXIS : QN_ROUNDING_PLANE;
    if (axes == 1) {
      stand(ctx, form->q[6 + out->axis[0]], form->q[9], out->place);
    }
  } else if (most[2] == 0) {
    out->kind = QN_ROUNDING_NONE; /* what is left would pass for a plane */
  } else if (hi[3] != 0 || hi[4] != 0 || hi[5] != 0) {
    out->kind = QN_ROUNDING_FULL;
  } else {
    out->kind = axes == 3 ? QN_ROUNDING_DIAGONAL : QN_ROUNDING_ROUND;
  }
}

const qn_rounding *qn_rounding_make(const quoin_scene *scene, uint32_t surface, uint64_t *made) {
  qn_surface *s = &scene->surfaces[surface];
  if (s->kind == QN_SUPER_BODY) {
    return NULL;
  }
  /* The exact form is not kept for this: with it a scene whose every surface is seen would take twice the memory. */
  qn_ctx ctx;
  qn_ctx_init(&ctx, scene->mem);
  ctx.max_bits = QN_MAX_SCENE_BITS;
  qn_rounding *mine = qn_alloc_zeroed(scene->mem, sizeof *mine), *there = NULL;
  const qn_exact_surface *form = atomic_load_explicit(&s->exact, memory_order_acquire);
  qn_exact_surface own = {.beyond = 1};
  if (mine && !form) {
    if (qn_scene_make_exact(scene, surface, &ctx, &own)) {
      form = &own;
      ++*made;
    }
  }
  if (mine && form && !form->beyond && ctx.failed == QUOIN_OK) {
    fill(&ctx, form, scene->leaves[s->leaf].pivot, mine);
  }
  if (mine && (!form || form->beyond || ctx.failed != QUOIN_OK)) {
    mine->kind = QN_ROUNDING_NONE;
  }
  int refused = ctx.failed == QUOIN_E_MEMORY;
  qn_ctx_free(&ctx);
  if (!mine || refused) {
    qn_free(scene->mem, mine, sizeof *mine);
    return NULL;
  }
  if (atomic_compare_exchange_strong_explicit(&s->rounding, &there, mine, memory_order_acq_rel, memory_order_acquire)) {
    return mine;
  }
  qn_free(scene->mem, mine, sizeof *mine); /* another thread was first; its numbers are the same */
  return there;
}

void qn_rounding_free(qn_mem *mem, qn_rounding *rounding) {
  qn_free(mem, rounding, sizeof *rounding);
}
