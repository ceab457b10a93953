/* Equal surfaces become one (design S2, S3).

   Half-spaces are taken in order. An aligned plane is known by its key. Any other, and the first of each key, looks up those
   surfaces whose fingerprints are within reach; for each of them the exact forms decide. A new surface gets the next number.

   Exact forms are normalised (qn_exact_surface): rational ones are equal when their integers are. When a rounding of S2 went
   into either, they are the same when their vectors c, d (space in units of the scene's size) agree: with i the place of the
   largest |c_i|, |c_j d_i - d_j c_i| < 2^-200 |c_i d_i| for all j. */
#include "scene/compile.h"

#include "base/bounds.h"
#include "base/limits.h"
#include "scene/fingerprint.h"

#include <math.h>
#include <string.h>

#define NONE UINT32_MAX

/* The composed exact map of a node with several children, which many leaves ask for. */
typedef struct known_map { uint32_t node; qn_num map[12]; } known_map;

typedef struct finder {
  qn_building *b;
  qn_print_frame frame;
  size_t surface_capacity;
  double (*prints)[2]; /* by surface, and so are the next two */
  size_t print_capacity;
  uint32_t *next;      /* the next one in its chain */
  size_t next_capacity;
  uint32_t *keys;      /* 0: not an aligned plane in small numbers */
  size_t key_capacity;
  uint32_t *chains;    /* by hash of the cell; a power of two */
  size_t chain_count;
  uint32_t *by_key;    /* surface, by key */
  int8_t *key_side;    /* side of a half-space with the key whose normal's sign is + */
  size_t key_room;
  qn_ctx ctx;          /* forms of the leaf in work */
  uint32_t leaf;       /* the leaf whose forms are there, or NONE */
  qn_half_form *forms;
  qn_ctx other;        /* forms of the surface compared with */
  qn_ctx maps;         /* known maps */
  known_map *known;
  size_t known_count, known_capacity;
  uint32_t *known_slots; /* index + 1, by hash of the node */
  size_t known_slot_count;
  uint32_t *path;
  size_t path_capacity;
} finder;

/* --- exact maps, remembered where they are shared ------------------------------------------------------------------ */

static size_t slot_of(uint32_t node, size_t slots) {
  return (size_t)((uint64_t)node * 0x9E3779B97F4A7C15u >> 20) & (slots - 1);
}

static const known_map *recall(const finder *f, uint32_t node) {
  if (f->known_slot_count == 0) {
    return NULL;
  }
  for (size_t i = slot_of(node, f->known_slot_count); f->known_slots[i]; i = (i + 1) & (f->known_slot_count - 1)) {
    if (f->known[f->known_slots[i] - 1].node == node) {
      return &f->known[f->known_slots[i] - 1];
    }
  }
  return NULL;
}

static int remember(finder *f, uint32_t node, const qn_num map[12]) {
  qn_mem *mem = f->b->mem;
  if (!qn_grow(mem, &f->known, &f->known_capacity, f->known_count + 1)) {
    return 0;
  }
  if (2 * (f->known_count + 1) > f->known_slot_count) {
    size_t n = f->known_slot_count ? 2 * f->known_slot_count : 64;
    uint32_t *slots = qn_alloc_zeroed(mem, n * sizeof *slots);
    if (!slots) {
      return 0;
    }
    qn_free(mem, f->known_slots, f->known_slot_count * sizeof *slots);
    f->known_slots = slots;
    f->known_slot_count = n;
    for (size_t i = 0; i < f->known_count; i++) {
      size_t at = slot_of(f->known[i].node, n);
      while (slots[at]) {
        at = (at + 1) & (n - 1);
      }
      slots[at] = (uint32_t)i + 1;
    }
  }
  known_map *k = &f->known[f->known_count++];
  k->node = node;
  for (int i = 0; i < 12; i++) {
    k->map[i] = qn_num_copy(&f->maps, map[i]);
  }
  size_t at = slot_of(node, f->known_slot_count);
  while (f->known_slots[at]) {
    at = (at + 1) & (f->known_slot_count - 1);
  }
  f->known_slots[at] = (uint32_t)f->known_count;
  return f->maps.failed == QUOIN_OK;
}

/* The map of the leaf's node into ctx. */
static quoin_status map_of(finder *f, qn_ctx *ctx, uint32_t node, qn_num map[12]) {
  const quoin_model *model = f->b->model;
  size_t depth = 0;
  const known_map *start = NULL;
  for (uint32_t n = model->nodes[node].parent; n != QN_NO_NODE && !start; n = model->nodes[n].parent) {
    start = recall(f, n);
    if (!start) {
      if (!qn_grow(f->b->mem, &f->path, &f->path_capacity, depth + 1)) {
        return QUOIN_E_MEMORY;
      }
      f->path[depth++] = n;
    }
  }
  for (int i = 0; i < 12; i++) {
    map[i] = start ? start->map[i] : i % 5 == 0 ? QN_NUM_ONE : QN_NUM_ZERO;
  }
  while (depth) {
    uint32_t n = f->path[--depth];
    if (model->nodes[n].kind >= QN_NODE_TRANSLATE && model->nodes[n].kind <= QN_NODE_MULTMATRIX) {
      qn_num inner[12], composed[12];
      qn_solid_map(ctx, model, n, inner);
      qn_map_compose(ctx, map, inner, composed);
      memcpy(map, composed, sizeof composed);
    }
    if (model->nodes[n].first != model->nodes[n].last && !remember(f, n, map)) {
      return QUOIN_E_MEMORY;
    }
  }
  return ctx->failed;
}

/* --- exact forms --------------------------------------------------------------------------------------------------- */

static void clear(qn_ctx *ctx) {
  qn_arena_release(&ctx->arena, (qn_mark){NULL, NULL});
}

static quoin_status forms_of(finder *f, qn_ctx *ctx, uint32_t leaf, qn_half_form **forms) {
  qn_num map[12];
  size_t count;
  uint32_t node = f->b->scene->leaves[leaf].node;
  quoin_status status = map_of(f, ctx, node, map);
  if (status == QUOIN_OK) {
    qn_node_forms(ctx, f->b->model, node, map, forms, &count);
    status = ctx->failed;
  }
  return status;
}

/* The exact half-space in work, in world coordinates. */
static quoin_status form_of(finder *f, uint32_t leaf, uint32_t half, const qn_half_form **form) {
  quoin_status status = QUOIN_OK;
  if (f->leaf != leaf) {
    f->leaf = NONE;
    clear(&f->ctx);
    status = forms_of(f, &f->ctx, leaf, &f->forms);
    f->leaf = status == QUOIN_OK ? leaf : NONE;
  }
  if (status == QUOIN_OK) {
    *form = &f->forms[half - f->b->scene->leaves[leaf].half0];
  }
  return status;
}

/* The surface's exact form: made, and kept in the scene. */
static quoin_status surface_form(finder *f, uint32_t surface, const qn_exact_surface **out) {
  quoin_scene *s = f->b->scene;
  qn_surface *surf = &s->surfaces[surface];
  *out = atomic_load_explicit(&surf->exact, memory_order_relaxed);
  if (*out) {
    return QUOIN_OK;
  }
  qn_half_form *forms;
  clear(&f->other);
  quoin_status status = forms_of(f, &f->other, surf->leaf, &forms);
  if (status == QUOIN_OK) {
    qn_exact_surface form;
    int side;
    qn_exact_of(&f->other, &forms[surf->half - s->leaves[surf->leaf].half0], &form, &side);
    status = f->other.failed;
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
  double print[2];
  int side;                 /* against its own normalised form; 0: not known yet */
  int has_exact;
  qn_exact_surface exact;   /* in f->ctx */
} subject;

static quoin_status exact_of(finder *f, subject *s) {
  if (s->has_exact) {
    return QUOIN_OK;
  }
  const qn_half_form *form;
  quoin_status status = form_of(f, s->leaf, s->half, &form);
  if (status == QUOIN_OK) {
    qn_exact_of(&f->ctx, form, &s->exact, &s->side);
    status = f->ctx.failed;
    s->has_exact = 1;
  }
  return status;
}

/* The vector in the frame of fingerprints from exact numbers, where doubles lose too much. */
static quoin_status careful_vector(finder *f, const subject *s, qn_vector *out) {
  const qn_half_form *form;
  quoin_status status = form_of(f, s->leaf, s->half, &form);
  if (status != QUOIN_OK) {
    return status;
  }
  qn_half_form moved = *form;
  qn_num origin[4] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ONE};
  for (int k = 0; k < 3; k++) {
    origin[k] = qn_num_from_double(&f->ctx, f->frame.origin[k]);
  }
  for (int i = 0; i < (form->kind == QN_PLANE ? 1 : 3); i++) {
    moved.row[i][3] = qn_num_dot(&f->ctx, 4, form->row[i], origin);
  }
  *out = (qn_vector){0};
  if (form->kind == QN_SUPER_BODY) {
    for (int i = 0; i < 14; i++) {
      double c = qn_num_to_double(i < 12 ? moved.row[i / 4][i % 4] : form->s[i - 12]);
      c = i < 12 && i % 4 == 3 ? ldexp(c, -f->frame.scale) : c;
      out->c[i] = c;
      out->magnitude[i] = fabs(c);
    }
    return f->ctx.failed;
  }
  qn_exact_surface exact;
  int side;
  qn_exact_of(&f->ctx, &moved, &exact, &side);
  double m[10];
  int64_t e[10], top = INT64_MIN;
  for (int c = 0; c < 10; c++) {
    qn_int_frexp(exact.q[c], &m[c], &e[c]);
    e[c] -= (int64_t)f->frame.scale * (c < 6 ? 0 : c < 9 ? 1 : 2);
    top = m[c] != 0 && e[c] > top ? e[c] : top;
  }
  for (int c = 0; c < 10; c++) {
    int64_t below = e[c] - top;
    out->c[c] = m[c] == 0 || below < -1000 ? 0 : ldexp(m[c], (int)below);
    out->magnitude[c] = fabs(out->c[c]);
  }
  return f->ctx.failed;
}

static quoin_status look_at(finder *f, subject *s) {
  const quoin_scene *scene = f->b->scene;
  const qn_half *half = &scene->halves[s->half];
  qn_vector v;
  int fit = qn_vector_of(scene, &scene->leaves[s->leaf], half, &f->frame, &v);
  s->side = half->kind == QN_SUPER_BODY ? 1 : fit ? qn_vector_sign(&v) : 0;
  if (fit && qn_print_of(&v, s->print)) {
    return QUOIN_OK;
  }
  quoin_status status = careful_vector(f, s, &v);
  if (!qn_print_of(&v, s->print)) {
    s->print[0] = s->print[1] = 0; /* sizes beyond doubles: all of these are candidates to one another */
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
  *same = 0;
  int super = scene->halves[s->half].kind == QN_SUPER_BODY;
  if ((s->key && f->keys[i]) || super != (scene->surfaces[i].kind == QN_SUPER_BODY)) {
    return QUOIN_OK; /* two keys that differ: two planes */
  }
  if (fabs(s->print[0] - f->prints[i][0]) > 2 * QN_PRINT_ERROR || fabs(s->print[1] - f->prints[i][1]) > 2 * QN_PRINT_ERROR) {
    return QUOIN_OK;
  }
  if (super) {
    const qn_half_form *mine;
    qn_half_form *theirs;
    quoin_status status = form_of(f, s->leaf, s->half, &mine);
    clear(&f->other);
    status = status == QUOIN_OK ? forms_of(f, &f->other, scene->surfaces[i].leaf, &theirs) : status;
    if (status == QUOIN_OK) {
      *same = same_super(&f->other, mine, &theirs[scene->surfaces[i].half - scene->leaves[scene->surfaces[i].leaf].half0]);
      status = f->other.failed;
    }
    return status;
  }
  const qn_exact_surface *theirs;
  quoin_status status = exact_of(f, s);
  status = status == QUOIN_OK ? surface_form(f, i, &theirs) : status;
  if (status == QUOIN_OK) {
    clear(&f->other);
    *same = agree(&f->other, &s->exact, theirs, f->frame.scale);
    status = f->other.failed;
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
    for (uint32_t i = f->chains[chain]; i != NONE; i = f->next[i]) {
      quoin_status status = compare(f, s, i, same);
      if (status != QUOIN_OK) {
        return status;
      }
      if (*same) {
        *surface = i;
        return QUOIN_OK;
      }
    }
  }
  return QUOIN_OK;
}

static int link_in(finder *f, uint32_t surface) {
  size_t chain = chain_of(f, cell_of(f->prints[surface][0]));
  f->next[surface] = f->chains[chain];
  f->chains[chain] = surface;
  return 1;
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
  for (uint32_t i = 0; i < f->b->scene->surface_count; i++) {
    link_in(f, i);
  }
  return 1;
}

static quoin_status add_surface(finder *f, const subject *s, uint32_t *surface) {
  quoin_scene *scene = f->b->scene;
  qn_mem *mem = f->b->mem;
  size_t n = scene->surface_count;
  if (!qn_grow(mem, &scene->surfaces, &f->surface_capacity, n + 1) || !qn_grow(mem, &f->prints, &f->print_capacity, n + 1) ||
      !qn_grow(mem, &f->next, &f->next_capacity, n + 1) || !qn_grow(mem, &f->keys, &f->key_capacity, n + 1) ||
      (n >= f->chain_count && !more_chains(f))) {
    return QUOIN_E_MEMORY;
  }
  scene->surfaces[n].leaf = s->leaf;
  scene->surfaces[n].half = s->half;
  scene->surfaces[n].users = 0;
  scene->surfaces[n].materials_differ = 0;
  scene->surfaces[n].kind = scene->halves[s->half].kind;
  atomic_init(&scene->surfaces[n].exact, NULL);
  atomic_init(&scene->surfaces[n].rounding, NULL);
  f->prints[n][0] = s->print[0];
  f->prints[n][1] = s->print[1];
  f->keys[n] = s->key;
  scene->surface_count++;
  link_in(f, (uint32_t)n);
  *surface = (uint32_t)n;
  return QUOIN_OK;
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
  uint32_t key = f->b->keys[half], surface = NONE;
  int normal = h->kind == QN_PLANE ? normal_sign(&scene->planes[h->shadow]) : 1;
  if (key && f->by_key[key] != NONE) {
    surface = f->by_key[key];
    h->side = (int8_t)(f->key_side[key] * normal);
  } else {
    subject s = {.leaf = leaf, .half = half, .key = key};
    int same = 0;
    quoin_status status = look_at(f, &s);
    status = status == QUOIN_OK ? find(f, &s, &surface, &same) : status;
    if (status == QUOIN_OK && s.side == 0) {
      status = exact_of(f, &s);
    }
    if (status == QUOIN_OK && surface == NONE) {
      status = add_surface(f, &s, &surface);
      same = 1;
    }
    if (status != QUOIN_OK) {
      return status;
    }
    h->side = (int8_t)(s.side * same);
    if (key) {
      f->by_key[key] = surface;
      f->key_side[key] = (int8_t)(h->side * normal);
    }
  }
  h->surface = surface;
  scene->surfaces[surface].users++;
  return QUOIN_OK;
}

static quoin_status start(finder *f, qn_building *b) {
  *f = (finder){.b = b, .leaf = NONE};
  qn_ctx *all[] = {&f->ctx, &f->other, &f->maps};
  for (size_t i = 0; i < 3; i++) {
    qn_ctx_init(all[i], b->mem);
    all[i]->max_bits = QN_MAX_SCENE_BITS;
  }
  qn_print_frame_of(b->scene, &f->frame);
  for (size_t i = 0; i < b->scene->half_count; i++) {
    f->key_room = b->keys[i] >= f->key_room ? (size_t)b->keys[i] + 1 : f->key_room;
  }
  f->by_key = qn_alloc(b->mem, f->key_room * sizeof *f->by_key);
  f->key_side = qn_alloc_zeroed(b->mem, f->key_room);
  if (!f->by_key || !f->key_side || !more_chains(f)) {
    return QUOIN_E_MEMORY;
  }
  memset(f->by_key, 0xff, f->key_room * sizeof *f->by_key);
  return QUOIN_OK;
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
  qn_free(b->mem, f.prints, f.print_capacity * sizeof *f.prints);
  qn_free(b->mem, f.next, f.next_capacity * sizeof *f.next);
  qn_free(b->mem, f.keys, f.key_capacity * sizeof *f.keys);
  qn_free(b->mem, f.chains, f.chain_count * sizeof *f.chains);
  qn_free(b->mem, f.by_key, f.key_room * sizeof *f.by_key);
  qn_free(b->mem, f.key_side, f.key_room);
  qn_free(b->mem, f.known, f.known_capacity * sizeof *f.known);
  qn_free(b->mem, f.known_slots, f.known_slot_count * sizeof *f.known_slots);
  qn_free(b->mem, f.path, f.path_capacity * sizeof *f.path);
  qn_ctx_free(&f.ctx);
  qn_ctx_free(&f.other);
  qn_ctx_free(&f.maps);
  s->surface_room = f.surface_capacity;
  return status;
}
