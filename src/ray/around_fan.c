/* The cells of planes through one line, and of one more plane across it: a sort by angle, where the general list (around_cells.c) takes
   the cube of their number. Slices about an axis meet so.

   Derivation. a is the line, N_i are normals, all orthogonal to it; turned (N or -N) they lie in the half turn that begins with N_0,
   so that M_i comes before M_j when (M_i x M_j).a > 0, and no two are at one angle, for the planes are distinct. In a direction v that turns about the
   line, from a quarter before N_0 on, M_0.v becomes positive first, then M_1.v, and so on; half a turn later they become negative in the same
   order. So n planes have 2n cells. A plane across the line meets each of them on both its sides.

   Curved surfaces that all hold the line, and have distinct tangent planes at P, are such a fan too: with coordinates (r, s) across the line each is
   g.(r, s) + (terms that vanish on the line) near P, so it is a graph over its tangent plane with a slope as small as one likes, and none crosses another but in
   the line. */
#include "ray/around_cells.h"

#include <string.h>

typedef struct fan {
  qn_ctx *ctx;
  const qn_germ *germs;
  uint32_t *order, *other; /* the planes of the line; room for the sort */
  int8_t *turned;          /* by germ: 1 or -1 */
  size_t count;
  int drop, way;           /* (M x M').a has the sign of component `drop` of M x M', times `way` */
  int tie;                 /* two were found at one angle: S2 made them so */
} fan;

static int turn(const fan *f, size_t a, size_t b) {
  int x = (f->drop + 1) % 3, y = (f->drop + 2) % 3;
  const qn_xint *p = f->germs[a].g, *q = f->germs[b].g;
  return f->way * qn_x_sign(qn_x_sub(f->ctx, qn_x_mul(f->ctx, p[x], q[y]), qn_x_mul(f->ctx, p[y], q[x])));
}

static int before(fan *f, uint32_t a, uint32_t b) {
  qn_mark mark = qn_arena_mark(&f->ctx->arena);
  int sign = f->turned[a] * f->turned[b] * turn(f, a, b);
  qn_arena_release(&f->ctx->arena, mark);
  f->tie |= sign == 0;
  return sign > 0;
}

static void sort(fan *f) {
  for (size_t width = 1; width < f->count; width *= 2) {
    for (size_t begin = 0; begin < f->count; begin += 2 * width) {
      size_t middle = begin + width < f->count ? begin + width : f->count, end = middle + width < f->count ? middle + width : f->count;
      size_t i = begin, j = middle, k = begin;
      while (i < middle && j < end) {
        f->other[k++] = before(f, f->order[j], f->order[i]) ? f->order[j++] : f->order[i++];
      }
      memcpy(f->other + k, f->order + i, (middle - i) * sizeof *f->order);
      k += middle - i;
      memcpy(f->other + k, f->order + j, (end - j) * sizeof *f->order);
    }
    uint32_t *sorted = f->other;
    f->other = f->order, f->order = sorted;
  }
}

/* Whether the planes but at most one, *across (n: none), hold the line in which planes i and j meet. */
static int share_line(fan *f, size_t n, size_t i, size_t j, size_t *across) {
  qn_ctx *ctx = f->ctx;
  qn_xint line[3];
  size_t most = 0;
  qn_cross_x(ctx, f->germs[i].g, f->germs[j].g, line);
  for (int k = 0; k < 3; k++) {
    qn_int part = qn_settled(line[k]);
    if (qn_int_bits(part) > most) {
      most = qn_int_bits(part);
      f->drop = k;
      f->way = qn_int_sign(part);
    }
  }
  *across = n;
  for (size_t k = 0; k < n && most != 0; k++) {
    if (k != i && k != j && qn_x_sign(qn_product_x(ctx, f->germs[k].g, line)) != 0) {
      if (*across != n) {
        return 0;
      }
      *across = k;
    }
  }
  return most != 0;
}

static int give(int8_t *signs, size_t n, size_t across, int (*emit)(void *user, const int8_t *signs), void *user) {
  if (across == n) {
    return emit(user, signs);
  }
  signs[across] = 1;
  if (emit(user, signs)) {
    return 1;
  }
  signs[across] = -1;
  return emit(user, signs);
}

static int smooth(const qn_germ *g) {
  return !g->opaque && (qn_x_sign(g->g[0]) != 0 || qn_x_sign(g->g[1]) != 0 || qn_x_sign(g->g[2]) != 0);
}

int qn_cells_fan(qn_ctx *ctx, size_t n, const qn_germ *germs, const qn_int *line, int (*emit)(void *user, const int8_t *signs), void *user) {
  fan f = {.ctx = ctx, .germs = germs};
  size_t across = n, first = 0;
  int planes = 1;
  for (size_t i = 0; i < n; i++) {
    planes &= germs[i].plane;
    if (!germs[i].plane && !(line && smooth(&germs[i]))) {
      return 0;
    }
  }
  qn_mark mark = qn_arena_mark(&ctx->arena);
  if (n < 3 || !(share_line(&f, n, 0, 1, &across) || share_line(&f, n, 0, 2, &across) || share_line(&f, n, 1, 2, &across)) || ctx->failed != QUOIN_OK ||
      (across != n && !planes)) {
    qn_arena_release(&ctx->arena, mark);
    return 0;
  }
  uint32_t *room = qn_arena_take(&ctx->arena, 2 * n * sizeof *room);
  int8_t *signs = qn_arena_take(&ctx->arena, 2 * n);
  if (!room || !signs) {
    ctx->failed = QUOIN_E_MEMORY;
    return 0;
  }
  f.order = room, f.other = room + n, f.turned = signs + n;
  first = across == 0;
  for (size_t i = first; i < n; i++) {
    if (i != across) {
      int side = i == first ? 1 : turn(&f, first, i);
      f.tie |= side == 0;
      f.turned[i] = (int8_t)(side > 0 ? 1 : -1);
      f.order[f.count++] = (uint32_t)i;
    }
  }
  sort(&f);
  for (size_t i = 0; i < n; i++) {
    signs[i] = (int8_t)-f.turned[i];
  }
  int stop = f.tie || ctx->failed != QUOIN_OK;
  for (size_t k = 0; k < 2 * f.count && !stop; k++) {
    uint32_t plane = f.order[k % f.count];
    signs[plane] = (int8_t)-signs[plane];
    stop = give(signs, n, across, emit, user);
  }
  int listed = !f.tie;
  qn_arena_release(&ctx->arena, mark);
  return listed;
}
