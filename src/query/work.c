/* Scratch: its making, its end, its counts. */
#include "query/sheaf.h"

static double apart(const quoin_scene *scene) {
  double volume = 1;
  for (int k = 0; k < 3; k++) {
    volume *= scene->max[k] - scene->min[k];
  }
  double each = cbrt(volume / (double)scene->leaf_count);
  return each > 0 && each < HUGE_VAL ? each : HUGE_VAL;
}

quoin_status quoin_work_new(const quoin_scene *scene, quoin_work **out) {
  if (!scene || !out) {
    return QUOIN_E_ARGUMENT;
  }
  *out = NULL;
  quoin_work *work = qn_alloc_zeroed(scene->mem, sizeof *work);
  if (!work) {
    return QUOIN_E_MEMORY;
  }
  work->scene = scene;
  work->mem = scene->mem;
  work->wide = qn_wide_pick();
  work->apart = apart(scene);
  work->takes_turns = qn_scene_is_far(scene);
  work->stamp = qn_alloc_zeroed(work->mem, scene->surface_count * sizeof *work->stamp);
  work->sign = qn_alloc_zeroed(work->mem, scene->surface_count);
  quoin_status status = work->stamp && work->sign ? qn_scratch_new(scene, &work->scratch) : QUOIN_E_MEMORY;
  if (status != QUOIN_OK) {
    quoin_work_free(work);
    return status;
  }
  *out = work;
  return QUOIN_OK;
}

void quoin_work_free(quoin_work *work) {
  if (!work) {
    return;
  }
  qn_mem *mem = work->mem;
  qn_scratch_free(work->scratch);
  qn_free(mem, work->stamp, work->scene->surface_count * sizeof *work->stamp);
  qn_free(mem, work->sign, work->scene->surface_count);
  qn_free(mem, work->candidates, work->candidate_capacity * sizeof *work->candidates);
  qn_free(mem, work->near, work->near_capacity * sizeof *work->near);
  qn_free(mem, work->near_halves, work->near_half_capacity * sizeof *work->near_halves);
  qn_free(mem, work->inside, work->inside_capacity * sizeof *work->inside);
  qn_free(mem, work->boundary, work->boundary_capacity * sizeof *work->boundary);
  qn_free(mem, work->contacts, work->contact_capacity * sizeof *work->contacts);
  qn_free_line(mem, work->point_walk, sizeof *work->point_walk);
  qn_query_locals_free(work);
  qn_sheaf_free(work);
  qn_text_rays_free(work);
  qn_free(mem, work, sizeof *work);
}

void quoin_work_stats(const quoin_work *work, quoin_stats *out) {
  const qn_counts *c = qn_scratch_counts(work->scratch);
  *out = (quoin_stats){.rays = c->rays, .points = c->points, .packets = c->packets, .exact_points = c->exact_points, .nodes = c->nodes, .leaves = c->leaves,
                       .filter_sure = c->filter_sure, .exact_signs = c->exact_signs, .exact_orders = c->exact_orders,
                       .exact_rays = c->exact_rays, .exact_roundings = c->exact_roundings, .exact_forms = c->exact_forms};
}
