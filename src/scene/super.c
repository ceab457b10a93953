#include "scene/super.h"

#include "base/limits.h"
#include "scene/compile.h"

static void fill(qn_super_form *f, const qn_half_form *form, const double pivot[3]) {
  qn_ctx *ctx = &f->ctx;
  qn_num point[4] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ONE};
  for (int j = 0; j < 3; j++) {
    f->rows.pivot[j] = pivot[j];
    point[j] = qn_num_from_double(ctx, pivot[j]);
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 4; j++) {
      f->row[i][j] = form->row[i][j];
      qn_num_to_dd(ctx, j < 3 ? form->row[i][j] : qn_num_dot(ctx, 4, form->row[i], point), &f->rows.row[i][j][0], &f->rows.row[i][j][1]);
    }
  }
  f->e = form->s[0], f->n = form->s[1];
  qn_num_to_dd(ctx, f->e, &f->rows.e[0], &f->rows.e[1]);
  qn_num_to_dd(ctx, f->n, &f->rows.n[0], &f->rows.n[1]);
  qn_super_rows_finish(&f->rows);
}

/* What there is of the surface: what was beyond a limit once is kept too, and not tried again. */
static const qn_super_form *known(const qn_super_form *form, quoin_status *status) {
  if (!form->beyond) {
    return form;
  }
  *status = QUOIN_E_LIMIT;
  return NULL;
}

const qn_super_form *qn_super_form_make(const quoin_scene *scene, uint32_t surface, quoin_status *status) {
  const qn_surface *s = &scene->surfaces[surface];
  const qn_leaf *leaf = &scene->leaves[s->leaf];
  qn_super_form *there = atomic_load_explicit(&scene->surfaces[surface].super, memory_order_acquire);
  if (there) {
    return known(there, status);
  }
  qn_super_form *mine = qn_alloc_zeroed(scene->mem, sizeof *mine);
  if (!mine) {
    *status = QUOIN_E_MEMORY;
    return NULL;
  }
  qn_ctx *ctx = &mine->ctx;
  qn_half_form half;
  uint64_t spared = 0;
  qn_ctx_init(ctx, scene->mem);
  ctx->max_bits = QN_MAX_SCENE_BITS;
  ctx->max_effort = QN_MAX_SCENE_EFFORT;
  int regular = qn_node_half(ctx, scene->kept_maps, scene->model, scene->snaps, leaf->node, s->half - leaf->half0, &half, &spared);
  if (regular) {
    fill(mine, &half, leaf->pivot);
  }
  if (ctx->failed == QUOIN_E_MEMORY) {
    *status = QUOIN_E_MEMORY;
    qn_super_form_free(scene->mem, mine);
    return NULL;
  }
  /* as if no map had been kept, as in qn_scene_make_exact */
  mine->beyond = (uint8_t)(!regular || ctx->failed != QUOIN_OK || spared > ctx->max_effort - ctx->effort);
  if (atomic_compare_exchange_strong_explicit(&scene->surfaces[surface].super, &there, mine, memory_order_acq_rel, memory_order_acquire)) {
    return known(mine, status);
  }
  qn_super_form_free(scene->mem, mine); /* another thread was first; its numbers are the same */
  return known(there, status);
}

void qn_super_form_free(qn_mem *mem, qn_super_form *form) {
  if (form) {
    qn_ctx_free(&form->ctx);
    qn_free(mem, form, sizeof *form);
  }
}
