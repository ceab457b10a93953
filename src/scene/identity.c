/* Equal surfaces become one (design S2, S3).

   Half-spaces are taken in order. An aligned plane is known by its key. Any other, and the first of each key, is a new surface when
   its fingerprint is alone (crowd.c); else it looks up those surfaces whose fingerprints are within reach, and for each of them
   the exact forms decide. A new surface gets the next number.

   Exact forms are normalised (qn_exact_surface): rational ones are equal when their integers are. When a rounding of S2 went
   into either, they are the same when their vectors c, d (space in units of the scene's size) agree: with i the place of the
   largest |c_i|, |c_j d_i - d_j c_i| < 2^-200 |c_i d_i| for all j. */
#include "scene/identity.h"

#include "base/bounds.h"

#include <math.h>
#include <string.h>

#define NONE UINT32_MAX

typedef struct link { uint32_t surface, next; } link;

typedef struct finder {
  qn_building *b;
  qn_print_frame frame;
  qn_crowd crowd;
  qn_forms forms;
  size_t surface_room;
  link *links;         /* crowded surfaces, in chains */
  size_t link_count, link_capacity;
  uint32_t *chains;    /* by hash of the cell; a power of two */
  size_t chain_count;
  uint32_t *by_key;    /* surface, by key */
  int8_t *key_side;    /* side of a half-space with the key whose normal's sign is + */
} finder;

/* --- exact forms --------------------------------------------------------------------------------------------------- */

static void clear(qn_ctx *ctx) {
  qn_arena_release(&ctx->arena, (qn_mark){NULL, NULL});
}

/* The surface's exact form: made, and kept in the scene. */
static quoin_status surface_form(finder *f, uint32_t surface, const qn_exact_surface **out) {
  quoin_scene *s = f->b->scene;
  qn_surface *surf = &s->surfaces[surface];
  *out = atomic_load_explicit(&surf->exact, memory_order_relaxed);
  if (*out) {
    return QUOIN_OK;
  }
  qn_half_form other;
  quoin_status status = qn_forms_other(&f->forms, surf->leaf, surf->half, &other);
  if (status == QUOIN_OK) {
    qn_exact_surface form;
    int side;
    qn_exact_of(&f->forms.other, &other, &form, &side);
    status = f->forms.other.failed;
    if (status == QUOIN_OK && !(*out = qn_scene_publish(s, surface, &form, NULL))) {
      status = QUOIN_E_MEMORY;
    }
  }
  return status;
}

/* Powers of the scene's unit in the ten coefficients, less than two of it: A..F, G..I, J. */
static size_t shift_of(int c, int scale) {
  int power = c < 6 ? 2 : c < 9 ? 1 : 0;
  return scale >= 0 ? (size_t)(power * scale) : (size_t)((power - 2) * scale);
}

/* 1 when the forms are the same surface, with the same orientation; -1 with opposite ones; 0 when they are not. */
static int agree(qn_ctx *ctx, const qn_exact_surface *x, const qn_exact_surface *y, int scale) {
  if (!x->rounded && !y->rounded) {
    int equal = 1;
    for (int c = 0; c < 10 && equal; c++) {
      equal = qn_int_equal(x->q[c], y->q[c]);
    }
    return equal;
  }
  qn_int p[10], q[10];
  int largest = 0;
  for (int c = 0; c < 10; c++) {
    p[c] = qn_int_shl(ctx, x->q[c], shift_of(c, scale));
    q[c] = qn_int_shl(ctx, y->q[c], shift_of(c, scale));
    largest = qn_int_cmp(qn_int_abs(p[c]), qn_int_abs(p[largest])) > 0 ? c : largest;
  }
  int same = qn_int_sign(p[largest]) * qn_int_sign(q[largest]);
  qn_int bound = qn_int_abs(qn_int_mul(ctx, p[largest], q[largest]));
  for (int c = 0; c < 10 && same; c++) {
    qn_int d = qn_int_sub(ctx, qn_int_mul(ctx, p[c], q[largest]), qn_int_mul(ctx, q[c], p[largest]));
    if (qn_int_cmp(qn_int_shl(ctx, qn_int_abs(d), QN_S2_BITS), bound) >= 0) {
      same = 0;
    }
  }
  return same;
}

/* Superquadrics are one surface only when they are written alike. */
static int same_super(qn_ctx *ctx, const qn_half_form *x, const qn_half_form *y) {
  int same = qn_num_cmp(ctx, x->s[0], y->s[0]) == 0 && qn_num_cmp(ctx, x->s[1], y->s[1]) == 0;
  for (int i = 0; i < 12 && same; i++) {
    same = qn_num_cmp(ctx, x->row[i / 4][i % 4], y->row[i / 4][i % 4]) == 0;
  }
  return same;
}

/* --- one half-space ------------------------------------------------------------------------------------------------ */

typedef struct subject {
  uint32_t leaf, half, key;
  const double *print;
  int side;                 /* against its own normalised form; 0: not known yet */
  int has_exact;
  qn_exact_surface exact;   /* in f->forms.ctx */
} subject;

static quoin_status exact_of(finder *f, subject *s) {
  if (s->has_exact) {
    return QUOIN_OK;
  }
  const qn_half_form *form;
  quoin_status status = qn_forms_half(&f->forms, s->leaf, s->half, &form);
  if (status == QUOIN_OK) {
    qn_exact_of(&f->forms.ctx, form, &s->exact, &s->side);
    status = f->forms.ctx.failed;
    s->has_exact = 1;
  }
  return status;
}

/* --- chains of surfaces with fingerprints in one cell --------------------------------------------------------------- */

static size_t chain_of(const finder *f, int64_t cell) {
  uint64_t h = (uint64_t)cell * 0x9E3779B97F4A7C15u;
  return (size_t)(h >> 24) & (f->chain_count - 1);
}
static int64_t cell_of(double print) {
  return (int64_t)floor(print / QN_PRINT_CELL);
}

/* Whether the subject is surface `i`: 1, -1 (opposite orientation), 0. */
static quoin_status compare(finder *f, subject *s, uint32_t i, int *same) {
  const quoin_scene *scene = f->b->scene;
  const qn_surface *other = &scene->surfaces[i];
  const double *print = f->crowd.prints[other->half];
  *same = 0;
  int super = scene->halves[s->half].kind == QN_SUPER_BODY;
  if ((s->key && f->b->keys[other->half]) || super != (other->kind == QN_SUPER_BODY)) {
    return QUOIN_OK; /* two keys that differ: two planes */
  }
  if (fabs(s->print[0] - print[0]) > 2 * QN_PRINT_ERROR || fabs(s->print[1] - print[1]) > 2 * QN_PRINT_ERROR) {
    return QUOIN_OK;
  }
  qn_ctx *ctx = &f->forms.other;
  if (super) {
    const qn_half_form *mine;
    qn_half_form theirs;
    quoin_status status = qn_forms_half(&f->forms, s->leaf, s->half, &mine);
    status = status == QUOIN_OK ? qn_forms_other(&f->forms, other->leaf, other->half, &theirs) : status;
    if (status == QUOIN_OK) {
      *same = same_super(ctx, mine, &theirs);
      status = ctx->failed;
    }
    return status;
  }
  const qn_exact_surface *theirs;
  quoin_status status = exact_of(f, s);
  status = status == QUOIN_OK ? surface_form(f, i, &theirs) : status;
  if (status == QUOIN_OK) {
    clear(ctx);
    *same = agree(ctx, &s->exact, theirs, f->frame.scale);
    status = ctx->failed;
  }
  return status;
}

static quoin_status find(finder *f, subject *s, uint32_t *surface, int *same) {
  int64_t low = cell_of(s->print[0] - 2 * QN_PRINT_ERROR), high = cell_of(s->print[0] + 2 * QN_PRINT_ERROR);
  *surface = NONE;
  for (int64_t cell = low; cell <= high; cell++) {
    size_t chain = chain_of(f, cell);
    if (cell > low && chain == chain_of(f, low)) {
      continue;
    }
    for (uint32_t l = f->chains[chain]; l != NONE; l = f->links[l].next) {
      quoin_status status = compare(f, s, f->links[l].surface, same);
      if (status != QUOIN_OK) {
        return status;
      }
      if (*same) {
        *surface = f->links[l].surface;
        return QUOIN_OK;
      }
    }
  }
  return QUOIN_OK;
}

static void link_in(finder *f, uint32_t l) {
  size_t chain = chain_of(f, cell_of(f->crowd.prints[f->b->scene->surfaces[f->links[l].surface].half][0]));
  f->links[l].next = f->chains[chain];
  f->chains[chain] = l;
}

static int more_chains(finder *f) {
  size_t n = f->chain_count ? 2 * f->chain_count : 256;
  uint32_t *chains = qn_alloc(f->b->mem, n * sizeof *chains);
  if (!chains) {
    return 0;
  }
  qn_free(f->b->mem, f->chains, f->chain_count * sizeof *chains);
  f->chains = chains;
  f->chain_count = n;
  memset(chains, 0xff, n * sizeof *chains);
  for (uint32_t l = 0; l < f->link_count; l++) {
    link_in(f, l);
  }
  return 1;
}

/* There is room: see start(). */
static uint32_t add_surface(finder *f, uint32_t leaf, uint32_t half) {
  quoin_scene *scene = f->b->scene;
  qn_surface *s = &scene->surfaces[scene->surface_count];
  s->leaf = leaf;
  s->half = half;
  s->users = 0;
  s->kind = scene->halves[half].kind;
  atomic_init(&s->exact, NULL);
  atomic_init(&s->rounding, NULL);
  return (uint32_t)scene->surface_count++;
}

static int add_link(finder *f, uint32_t surface) {
  if (!qn_grow(f->b->mem, &f->links, &f->link_capacity, f->link_count + 1) || (f->link_count >= f->chain_count && !more_chains(f))) {
    return 0;
  }
  f->links[f->link_count].surface = surface;
  link_in(f, (uint32_t)f->link_count++);
  return 1;
}

/* A half-space in a crowd: its surface, new or not, and its side. */
static quoin_status identify_in_crowd(finder *f, uint32_t leaf, uint32_t half, uint32_t *surface, int8_t *side) {
  subject s = {.leaf = leaf, .half = half, .key = f->b->keys[half], .print = f->crowd.prints[half], .side = f->crowd.side[half]};
  int same = 0;
  quoin_status status = find(f, &s, surface, &same);
  if (status == QUOIN_OK && s.side == 0) {
    status = exact_of(f, &s);
  }
  if (status == QUOIN_OK && *surface == NONE) {
    *surface = add_surface(f, leaf, half);
    status = add_link(f, *surface) ? QUOIN_OK : QUOIN_E_MEMORY;
    same = 1;
  }
  *side = (int8_t)(s.side * same);
  return status;
}

static int normal_sign(const qn_plane_shadow *p) {
  for (int k = 0; k < 3; k++) {
    if (p->n[k] != 0) {
      return p->n[k] > 0 ? 1 : -1;
    }
  }
  return 1;
}

static quoin_status identify(finder *f, uint32_t leaf, uint32_t half) {
  quoin_scene *scene = f->b->scene;
  qn_half *h = &scene->halves[half];
  uint32_t key = f->b->keys[half] & ~QN_KEY_FIRST, surface = NONE;
  int normal = key ? normal_sign(&scene->planes[h->shadow]) : 1;
  if (key && f->by_key[key] != NONE) {
    surface = f->by_key[key];
    h->side = (int8_t)(f->key_side[key] * normal);
  } else {
    if (!(atomic_load_explicit(&f->crowd.is[half], memory_order_relaxed) & QN_CROWDED)) {
      surface = add_surface(f, leaf, half);
      h->side = f->crowd.side[half];
    } else {
      quoin_status status = identify_in_crowd(f, leaf, half, &surface, &h->side);
      if (status != QUOIN_OK) {
        return status;
      }
    }
    if (key) {
      f->by_key[key] = surface;
      f->key_side[key] = (int8_t)(h->side * normal);
    }
  }
  h->surface = surface;
  qn_surface *s = &scene->surfaces[surface];
  s->users++;
  return QUOIN_OK;
}

static quoin_status start(finder *f, qn_building *b) {
  *f = (finder){.b = b};
  qn_forms_init(&f->forms, b);
  qn_print_frame_of(b->scene, &f->frame);
  size_t keys = b->key_count;
  f->by_key = qn_alloc(b->mem, keys * sizeof *f->by_key);
  f->key_side = qn_alloc_zeroed(b->mem, keys);
  if (!f->by_key || !f->key_side || !more_chains(f)) {
    return QUOIN_E_MEMORY;
  }
  memset(f->by_key, 0xff, keys * sizeof *f->by_key);
  f->surface_room = keys - 1; /* at most one surface for each key, and one for each half-space without */
  for (size_t i = 0; i < b->scene->half_count; i++) {
    f->surface_room += b->keys[i] == 0;
  }
  b->scene->surfaces = qn_alloc(b->mem, f->surface_room * sizeof *b->scene->surfaces);
  b->scene->surface_room = f->surface_room;
  return b->scene->surfaces ? qn_crowd_find(&f->crowd, b, &f->frame) : QUOIN_E_MEMORY;
}

quoin_status qn_identify(qn_building *b) {
  finder f;
  quoin_scene *s = b->scene;
  quoin_status status = start(&f, b);
  for (uint32_t i = 0; i < s->leaf_count && status == QUOIN_OK; i++) {
    for (uint32_t h = 0; h < s->leaves[i].halves && status == QUOIN_OK; h++) {
      status = identify(&f, i, s->leaves[i].half0 + h);
    }
  }
  qn_crowd_free(&f.crowd, b->mem);
  qn_free(b->mem, f.links, f.link_capacity * sizeof *f.links);
  qn_free(b->mem, f.chains, f.chain_count * sizeof *f.chains);
  qn_free(b->mem, f.by_key, b->key_count * sizeof *f.by_key);
  qn_free(b->mem, f.key_side, b->key_count);
  qn_forms_free(&f.forms);
  return status;
}
