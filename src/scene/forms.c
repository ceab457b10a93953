/* Exact half-spaces of leaves for comparing. */
#include "scene/compile.h"
#include "scene/identity.h"

#include "base/limits.h"
#include "scene/snap.h"

#include <string.h>

static void clear(qn_ctx *ctx) {
  qn_arena_release(&ctx->arena, (qn_mark){NULL, NULL});
}

static quoin_status forms_of(qn_forms *f, qn_ctx *ctx, uint32_t leaf, qn_half_form **forms) {
  qn_num map[12];
  size_t count;
  const quoin_scene *scene = f->b->scene;
  uint32_t node = scene->leaves[leaf].node;
  clear(ctx);
  qn_path_map(ctx, scene->kept_maps, node, map);
  if (ctx->failed == QUOIN_OK && qn_node_forms(ctx, f->b->model, node, map, forms, &count) == QN_FORM_OK) {
    qn_snaps_apply(ctx, scene->kept_maps, f->b->model, scene->snaps, node, *forms, count);
  }
  return ctx->failed;
}

quoin_status qn_forms_half(qn_forms *f, uint32_t leaf, uint32_t half, const qn_half_form **form) {
  quoin_status status = QUOIN_OK;
  if (f->leaf != leaf) {
    f->leaf = QN_NO_LEAF;
    status = forms_of(f, &f->ctx, leaf, &f->forms);
    f->leaf = status == QUOIN_OK ? leaf : QN_NO_LEAF;
  }
  if (status == QUOIN_OK) {
    *form = &f->forms[half - f->b->scene->leaves[leaf].half0];
  }
  return status;
}

quoin_status qn_forms_other(qn_forms *f, uint32_t leaf, uint32_t half, qn_half_form *form) {
  const quoin_scene *scene = f->b->scene;
  uint64_t spared;
  clear(&f->other);
  (void)qn_node_half(&f->other, scene->kept_maps, f->b->model, scene->snaps, scene->leaves[leaf].node, half - scene->leaves[leaf].half0, form, &spared);
  return f->other.failed;
}

void qn_forms_init(qn_forms *f, const qn_building *b) {
  *f = (qn_forms){.b = b, .leaf = QN_NO_LEAF};
  qn_ctx *all[] = {&f->ctx, &f->other};
  for (size_t i = 0; i < 2; i++) {
    qn_ctx_init(all[i], b->mem);
    all[i]->max_bits = QN_MAX_SCENE_BITS;
    /* A leaf under four irrational turns, compared with its equal, takes 60,000; five nodes of it may take ten times that. */
    all[i]->max_effort = QN_MAX_SCENE_EFFORT + (uint64_t)4 * QN_SCENE_EFFORT_PER_NODE * b->model->node_count;
  }
}

void qn_forms_free(qn_forms *f) {
  if (!f->b) {
    return;
  }
  qn_ctx_free(&f->ctx);
  qn_ctx_free(&f->other);
}
