/* Finding near surfaces. Doubles propose pairs, exact forms decide (gap.c).

   Surfaces are taken from the largest region to the smallest, those of one size in the order of the file. Each asks an index of those before
   it for candidates, and is then put into the index (of QN_NEAR_SNAP, when it stands).

   Legend: y = x - O, O amid the scene; h the half extents of a region, c its middle; T the limit.

   Planes: n.y + d, |n| = 1. Where |s1 - s2| <= T all over the region, its gradient e = n1 -+ n2 has |e_k| h_k <= T, so |e| <= sqrt 3 T / min h.
   Normals of one direction (to 2^-40) are one group; groups are found by cells of normals, as wide as the angle asked for, at one of
   several levels; a surface asks at its own level, and a group is in the cells of all levels that are asked at. In a group the
   planes are in cells of d: at c the standing plane must pass within T of the other, which says what its d is.

   Curved surfaces: equal quadratic parts have equal f = (w.A)^2 / A.A; their centres (of cylinders: the nearest place of the axis to O; of
   paraboloids: the vertex) are no further apart than the gap. With e = q(centre) the radius is R = sqrt(|e| / |A|), for paraboloids 0: no point of the
   surface is nearer to the centre (the axis), since |u'Au| <= |A| |u|^2. The gap is at least |R2 / R1 - 1| times the distance of the farthest corner of the smaller
   one's region, or, of spheres and round cylinders, times r1 >= R1; so |R1 - R2| <= T where that corner is no nearer than R1, as it is where
   the region holds any of the surface. Cells of f, of the centre and of R; a surface whose centre or R is less well known is in wider cells, at a level of its own, and
   all ask at all levels from their own up.

   Every number here is a double with a bound of its error in the filter; none of them decides. */
#include "scene/near_parts.h"

#include "base/limits.h"

#include <stdlib.h>
#include <string.h>

/* How many candidates are compared, in doubles (some 15 ns each) and exactly (weighed: some 3 us each), and as many for each surface, before the search for all pairs is
   cut, and how many pairs are kept. A search for a snap is refused when it compares more; of exact comparisons it counts those in vain: each surface is then moved
   by one that is not, and what comes near without being so is a model made of that (surfaces of 10,000 shapes that doubles do not tell apart). */
enum { COMPARED = 1 << 25, COMPARED_EACH = 256, SNAP_EACH = 1024, COMPARED_EXACTLY = 1 << 19, SNAP_EXACTLY_EACH = 64, KEPT = 1 << 18, COMPARED_USERS = 4096 };

static int is_aligned(const qn_exact_surface *plane) {
  return (qn_int_sign(plane->q[6]) != 0) + (qn_int_sign(plane->q[7]) != 0) + (qn_int_sign(plane->q[8]) != 0) == 1;
}

/* What a comparison counts: planes at an angle are compared over a region; rounded and other long numbers take longer. */
static size_t weight_of(const qn_exact_surface *x, const qn_exact_surface *y) {
  size_t limbs = 0;
  for (int c = 0; c < 10; c++) {
    size_t a = (size_t)(qn_int_abs(x->q[c]).n), b = (size_t)(qn_int_abs(y->q[c]).n);
    limbs = a > limbs ? a : limbs;
    limbs = b > limbs ? b : limbs;
  }
  return (x->plane && y->plane && !(is_aligned(x) && is_aligned(y)) ? 16U : 1U) + (limbs > 1 ? 2 * limbs : 0);
}

/* --- one surface ----------------------------------------------------------------------------------------------------- */

/* Users of the two whose boxes come close; where there are very many, their hulls answer. */
static int users_close(qn_near_finder *f, uint32_t x, uint32_t y, uint32_t leaf[2]) {
  const qn_leaf *leaves = f->scene->leaves;
  const uint32_t *a = f->users + f->users_of[x], *b = f->users + f->users_of[y];
  size_t n = f->users_of[x + 1] - f->users_of[x], m = f->users_of[y + 1] - f->users_of[y];
  const qn_region *r = &f->items[x].region, *s = &f->items[y].region;
  leaf[0] = a[0], leaf[1] = b[0];
  if (!qn_near_close(f, r->min, r->max, s->min, s->max)) {
    return 0;
  }
  if (n * m > COMPARED_USERS) {
    return 1;
  }
  for (size_t i = 0; i < n; i++) {
    for (size_t j = 0; j < m; j++) {
      const qn_leaf *p = &leaves[a[i]], *q = &leaves[b[j]];
      if (qn_near_close(f, p->min, p->max, q->min, q->max)) {
        leaf[0] = a[i], leaf[1] = b[j];
        return 1;
      }
    }
  }
  return 0;
}

static int by_number(const void *a, const void *b) {
  uint32_t x = ((const qn_near_candidate *)a)->what, y = ((const qn_near_candidate *)b)->what;
  return (x > y) - (x < y);
}
static int by_least(const void *a, const void *b) {
  const qn_near_candidate *x = a, *y = b;
  return x->least != y->least ? (x->least > y->least) - (x->least < y->least) : by_number(a, b);
}

/* More was compared than is due to so many surfaces. */
static int is_too_much(const qn_near_finder *f) {
  size_t n = f->scene->surface_count;
  if (f->want == QN_NEAR_ALL) {
    return f->compared > COMPARED + COMPARED_EACH * n || f->compared_exactly >= COMPARED_EXACTLY;
  }
  return f->compared > COMPARED + SNAP_EACH * n || f->compared_exactly > COMPARED_EXACTLY + SNAP_EXACTLY_EACH * n;
}

static quoin_status keep(qn_near_finder *f, const qn_near_pair *pair) {
  if (f->want == QN_NEAR_ALL && f->out->count >= KEPT) {
    f->out->cut = 1;
    return QUOIN_OK;
  }
  if (!qn_grow(f->mem, &f->out->items, &f->out->capacity, f->out->count + 1)) {
    return QUOIN_E_MEMORY;
  }
  f->out->items[f->out->count++] = *pair;
  return QUOIN_OK;
}

/* The number as text where it is exact and short. */
static const char *exactly(qn_near_finder *f, qn_num gap) {
  enum { LONGEST = 40, BITS = 140 };
  if (qn_num_is_rounded(gap) || (gap.kind == QN_NUM_BIG && qn_int_bits(gap.u.big->num) + qn_int_bits(gap.u.big->den) > BITS)) {
    return "";
  }
  const char *text = qn_num_text(&f->ctx, gap);
  size_t length = text ? strlen(text) : 0;
  text = length && length <= LONGEST ? qn_arena_text(&f->out->texts, text, length) : "";
  if (!text) { /* said to be unknown, it would be another answer */
    f->ctx.failed = QUOIN_E_MEMORY;
  }
  return text;
}

/* Compares with the candidates. *stands: no surface of the index stands for this one. */
static quoin_status compare(qn_near_finder *f, uint32_t i, int *stands) {
  qn_near_pair best = {.small = i, .stands = QN_NEAR_NONE};
  quoin_status status = QUOIN_OK;
  if (f->found_count > 1) {
    qsort(f->found, f->found_count, sizeof *f->found, f->want == QN_NEAR_ALL ? by_number : by_least);
  }
  for (size_t k = 0; k < f->found_count && status == QUOIN_OK && !f->out->cut; k++) {
    uint32_t other = f->found[k].what, leaf[2] = {f->scene->surfaces[i].leaf, f->scene->surfaces[other].leaf};
    if (f->want == QN_NEAR_SNAP && best.stands != QN_NEAR_NONE && f->found[k].least > best.gap) {
      break; /* its gap, rounded, is at least that, and so above the best one rounded */
    }
    if ((k && other == f->found[k - 1].what) || (f->want == QN_NEAR_ALL && !users_close(f, i, other, leaf))) {
      continue;
    }
    const qn_exact_surface *x = qn_scene_exact(f->scene, i, NULL), *y = qn_scene_exact(f->scene, other, NULL);
    if (!x || !y) {
      return qn_scene_no_exact(f->scene, x ? other : i);
    }
    if (is_too_much(f)) {
      f->out->cut = 1;
      break;
    }
    qn_mark mark = qn_arena_mark(&f->ctx.arena);
    qn_num gap;
    int turn, near = qn_gap(&f->ctx, x, y, &f->items[i].region, &f->items[other].region, &gap, &turn) && qn_num_cmp(&f->ctx, gap, f->limit) <= 0;
    qn_near_pair pair = {i, other, {leaf[0], leaf[1]}, (int8_t)turn, near ? qn_num_to_double(gap) : 0, near ? exactly(f, gap) : ""};
    qn_arena_release(&f->ctx.arena, mark);
    status = f->ctx.failed;
    f->compared_exactly += f->want == QN_NEAR_ALL || !near ? weight_of(x, y) : 0;
    if (near && status == QUOIN_OK && f->want == QN_NEAR_ALL) {
      status = keep(f, &pair);
    }
    /* of equally near ones that of the larger region, then the first in the file: neither hangs on the order of comparing */
    if (near && (best.stands == QN_NEAR_NONE || pair.gap < best.gap ||
                 (pair.gap == best.gap && qn_near_order(f, other, best.stands) < 0))) {
      best = pair;
    }
  }
  *stands = best.stands == QN_NEAR_NONE;
  if (status == QUOIN_OK && f->out->cut && f->want == QN_NEAR_SNAP) {
    return QUOIN_E_LIMIT;
  }
  return status == QUOIN_OK && f->want == QN_NEAR_SNAP && !*stands ? keep(f, &best) : status;
}

static quoin_status take(qn_near_finder *f, uint32_t i) {
  const qn_near_item *it = &f->items[i];
  int stands = 1;
  if (it->kind == QN_NEAR_NOT) {
    return QUOIN_OK;
  }
  f->found_count = 0;
  int good = 1;
  if (f->out->cut || is_too_much(f)) {
    f->out->cut = 1;
    return f->want == QN_NEAR_ALL ? QUOIN_OK : QUOIN_E_LIMIT;
  }
  if (it->kind == QN_NEAR_PLANE) {
    /* where boxes told all that is near at an angle, only parallel planes are left, which for a snap may be anywhere */
    int told;
    good = qn_near_boxes(f, i, &told) &&
           ((told && f->want == QN_NEAR_ALL) || qn_near_planes(f, it, told ? QN_NEAR_LEVELS - 1 : it->level));
  } else {
    good = qn_near_curved(f, it);
  }
  quoin_status status = good ? compare(f, i, &stands) : QUOIN_E_MEMORY;
  if (status == QUOIN_OK && (stands || f->want == QN_NEAR_ALL) && !qn_near_add(f, i)) {
    status = QUOIN_E_MEMORY;
  }
  return status;
}

static int by_small(const void *a, const void *b) {
  const qn_near_pair *x = a, *y = b;
  return (x->small > y->small) - (x->small < y->small);
}

quoin_status qn_near_find(const quoin_scene *scene, qn_num limit, qn_near_want want, qn_near_pairs *out) {
  qn_near_finder f = {.scene = scene, .mem = scene->mem, .want = want, .limit = limit, .out = out};
  *out = (qn_near_pairs){0};
  qn_arena_init(&out->texts, scene->mem);
  qn_ctx_init(&f.ctx, scene->mem);
  f.ctx.max_bits = QN_MAX_SCENE_BITS;
  quoin_status status = qn_near_items_make(&f);
  for (size_t i = 0; i < scene->surface_count && status == QUOIN_OK; i++) {
    status = take(&f, f.order[i]);
  }
  qn_free(f.mem, f.items, scene->surface_count * sizeof *f.items);
  qn_free(f.mem, f.order, scene->surface_count * sizeof *f.order);
  qn_free(f.mem, f.next_in_group, scene->surface_count * sizeof *f.next_in_group);
  qn_free(f.mem, f.users, scene->half_count * sizeof *f.users);
  qn_free(f.mem, f.users_of, (scene->surface_count + 1) * sizeof *f.users_of);
  qn_free(f.mem, f.found, f.found_capacity * sizeof *f.found);
  qn_near_index_free(&f);
  qn_ctx_free(&f.ctx);
  if (want == QN_NEAR_SNAP && out->count > 1) {
    qsort(out->items, out->count, sizeof *out->items, by_small);
  }
  if (status != QUOIN_OK) {
    int cut = out->cut;
    qn_near_pairs_free(out, scene->mem);
    out->cut = cut;
  }
  return status;
}

void qn_near_pairs_free(qn_near_pairs *pairs, qn_mem *mem) {
  qn_free(mem, pairs->items, pairs->capacity * sizeof *pairs->items);
  qn_arena_free(&pairs->texts);
  *pairs = (qn_near_pairs){0};
}

double qn_near_usual(const quoin_scene *scene) {
  double most = 0;
  for (size_t i = 0; i < scene->leaf_count; i++) {
    for (int k = 0; k < 3 && scene->leaves[i].bounded; k++) {
      most = fmax(most, fmax(fabs(scene->leaves[i].min[k]), fabs(scene->leaves[i].max[k])));
    }
  }
  return most / 100000;
}
