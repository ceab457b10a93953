/* A compiled scene as stable text: surfaces with their exact integers, leaves, gates. For reading and for tests. */
#include "scene/scene.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

typedef struct writer {
  quoin_write_fn write;
  void *user;
  int failed;
} writer;

static void put(writer *w, const char *text) {
  if (!w->failed && w->write(w->user, text, strlen(text))) {
    w->failed = 1;
  }
}

static void putf(writer *w, const char *format, ...) QN_PRINTF(2, 3);
static void putf(writer *w, const char *format, ...) {
  char text[256];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  put(w, text);
}

static void put_box(writer *w, const double min[3], const double max[3]) {
  putf(w, "[%.17g, %.17g, %.17g] to [%.17g, %.17g, %.17g]", min[0], min[1], min[2], max[0], max[1], max[2]);
}

/* Integers as they are; of a rounded surface, whose integers are long, the ratio to the largest. */
static int put_exact(writer *w, qn_ctx *ctx, const qn_exact_surface *e) {
  int largest = 0;
  for (int c = 1; c < 10; c++) {
    largest = qn_int_cmp(qn_int_abs(e->q[c]), qn_int_abs(e->q[largest])) > 0 ? c : largest;
  }
  for (int c = e->plane ? 6 : 0; c < 10; c++) {
    if (!e->rounded) {
      qn_mark mark = qn_arena_mark(&ctx->arena);
      const char *text = qn_int_text(ctx, e->q[c]);
      if (!text) {
        return 0;
      }
      put(w, " ");
      put(w, text);
      qn_arena_release(&ctx->arena, mark);
    } else {
      double m, n;
      int64_t me, ne;
      qn_int_frexp(e->q[c], &m, &me);
      qn_int_frexp(qn_int_abs(e->q[largest]), &n, &ne);
      putf(w, " %.9g", m == 0 ? 0 : ldexp(m / n, me - ne < -2000 ? -2000 : (int)(me - ne)));
    }
  }
  if (e->rounded) {
    put(w, " rounded");
  }
  return 1;
}

static quoin_status put_surface(writer *w, const quoin_scene *s, uint32_t i) {
  const qn_surface *surface = &s->surfaces[i];
  const qn_leaf *leaf = &s->leaves[surface->leaf];
  putf(w, "surface %" PRIu32 ": ", i);
  if (surface->kind == QN_SUPER_BODY) {
    const qn_quadric_shadow *q = &s->quadrics[s->halves[surface->half].shadow];
    putf(w, "superquadric e %.17g n %.17g at [%.17g, %.17g, %.17g]", q->s[0], q->s[1], leaf->pivot[0], leaf->pivot[1], leaf->pivot[2]);
  } else {
    const qn_exact_surface *e = qn_scene_exact(s, i, NULL);
    if (!e) {
      return qn_scene_no_exact(s, i);
    }
    qn_ctx ctx;
    qn_ctx_init(&ctx, s->mem);
    put(w, e->plane ? "plane" : "quadric");
    int done = put_exact(w, &ctx, e);
    qn_ctx_free(&ctx);
    if (!done) {
      return QUOIN_E_MEMORY;
    }
  }
  putf(w, ", users %" PRIu32 "\n", surface->users);
  return QUOIN_OK;
}

static void put_leaf(writer *w, const quoin_scene *s, uint32_t i) {
  const qn_leaf *leaf = &s->leaves[i];
  putf(w, "leaf %" PRIu32 ": %s \"", i, qn_prims[leaf->prim].word);
  put(w, quoin_part_name(s, i));
  putf(w, "\" gate %" PRIu32 "%s material %" PRIu32 " box ", leaf->gate, leaf->negated ? " outside" : "", leaf->material);
  put_box(w, leaf->min, leaf->max);
  put(w, "\n");
  for (uint32_t h = leaf->half0; h < leaf->half0 + leaf->halves; h++) {
    char role[32];
    quoin_role_text(s->halves[h].role, role, sizeof role);
    putf(w, "  %s: %c surface %" PRIu32 "\n", role, s->halves[h].side > 0 ? '+' : '-', s->halves[h].surface);
  }
}

QUOIN_API quoin_status quoin_scene_write_text(const quoin_scene *s, quoin_write_fn write, void *user) {
  if (!s || !write) {
    return QUOIN_E_ARGUMENT;
  }
  writer w = {write, user, 0};
  quoin_status status = QUOIN_OK;
  putf(&w, "scene: %zu leaves, %zu surfaces, %zu distinct%s\n", s->leaf_count, s->half_count, s->surface_count, s->empty ? ", empty" : "");
  if (!s->empty) {
    put(&w, "box ");
    put_box(&w, s->min, s->max);
    put(&w, "\n");
  }
  for (uint32_t i = 0; i < s->material_count; i++) {
    const qn_material *m = &s->materials[i];
    putf(&w, "material %" PRIu32 ": color [%.9g, %.9g, %.9g, %.9g] ambient %.9g diffuse %.9g specular %.9g shininess %.9g\n", i, m->color[0],
         m->color[1], m->color[2], m->color[3], m->ambient, m->diffuse, m->specular, m->shininess);
  }
  for (uint32_t i = 0; i < s->surface_count && status == QUOIN_OK && !w.failed; i++) {
    status = put_surface(&w, s, i);
  }
  for (uint32_t i = 0; i < s->leaf_count && status == QUOIN_OK && !w.failed; i++) {
    put_leaf(&w, s, i);
  }
  for (uint32_t i = 0; i < s->program.gate_count && status == QUOIN_OK && !w.failed; i++) {
    const qn_gate *g = &s->program.gates[i];
    putf(&w, "gate %" PRIu32 ": %s of %" PRIu32, i, g->is_and ? "all" : "any", g->kids);
    if (g->parent != QN_NO_GATE) {
      putf(&w, " in gate %" PRIu32, g->parent);
    }
    put(&w, "\n");
  }
  return status != QUOIN_OK ? status : w.failed ? QUOIN_E_IO : QUOIN_OK;
}
