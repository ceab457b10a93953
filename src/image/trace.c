/* Samples of the picture, a batch at a time: all camera rays of the batch, then for each lamp all its shadow rays, so that
   rays that go the same way are asked together.

   What is hidden: a shadow ray's first boundary inside its range hides the lamp. A boundary that is left at t = 0 exactly is
   the hit's own surface, touched from outside, and hides nothing. No shadow ray is sent to a lamp behind the surface, nor to
   a headlight.

   A wall seen from inside the solid (the eye or the near plane is in it) is shown with its normal turned to the viewer and
   takes the light of every lamp on that side, without shadows: the solid around it would make all of them dark. */
#include "image/trace.h"
#include "image/colour.h"
#include "image/vec.h"

#include <string.h>

static const double default_background[3] = {0.925, 0.933, 0.945}; /* sRGB: a soft light grey */

quoin_status qn_picture_make(const quoin_scene *scene, const quoin_render_options *options, qn_picture *out) {
  qn_picture p = {.scene = scene, .shadows = options->shadows};
  const quoin_model *model = scene->model;
  quoin_camera camera = options->camera;
  if (!options->has_camera) {
    qn_camera_of_scene(scene, (double)options->width / (double)options->height, &camera);
  }
  const quoin_status status = qn_frustum_make(&camera, options->width, options->height, &p.frustum);
  if (status != QUOIN_OK) {
    return status;
  }
  for (int i = 0; i < 3; i++) {
    p.background[i] = qn_srgb_to_linear(model->view.has_background ? model->view.background[i] : default_background[i]);
  }
  p.finish_count = scene->material_count;
  p.finishes = qn_alloc(scene->mem, p.finish_count * sizeof *p.finishes);
  const size_t lamps = model->light_count > QN_DEFAULT_LAMPS ? model->light_count : QN_DEFAULT_LAMPS;
  if (!p.finishes || !qn_grow(scene->mem, &p.lamps, &p.lamp_capacity, lamps)) {
    qn_picture_free(&p);
    return QUOIN_E_MEMORY;
  }
  for (size_t i = 0; i < p.finish_count; i++) {
    qn_finish_from_material(&scene->materials[i], &p.finishes[i]);
  }
  for (size_t i = 0; i < model->light_count; i++) {
    p.lamp_count += (size_t)qn_lamp_from_light(&model->lights[i], &p.lamps[p.lamp_count]);
  }
  if (model->light_count == 0) {
    qn_lamps_default(&p.frustum, p.lamps);
    p.lamp_count = QN_DEFAULT_LAMPS;
  }
  *out = p;
  return QUOIN_OK;
}

void qn_picture_free(qn_picture *p) {
  qn_free(p->scene->mem, p->finishes, p->finish_count * sizeof *p->finishes);
  qn_free(p->scene->mem, p->lamps, p->lamp_capacity * sizeof *p->lamps);
}

quoin_status qn_tracer_new(const quoin_scene *scene, qn_tracer **out) {
  qn_tracer *t = qn_alloc_zeroed(scene->mem, sizeof *t);
  if (!t) {
    return QUOIN_E_MEMORY;
  }
  const quoin_status status = quoin_work_new(scene, &t->work);
  if (status != QUOIN_OK) {
    qn_free(scene->mem, t, sizeof *t);
    return status;
  }
  *out = t;
  return QUOIN_OK;
}

void qn_tracer_free(const quoin_scene *scene, qn_tracer *tracer) {
  if (tracer) {
    quoin_work_free(tracer->work);
    qn_free(scene->mem, tracer, sizeof *tracer);
  }
}

static const qn_finish *finish_of(const qn_picture *p, const qn_seen *hit) {
  return &p->finishes[p->scene->leaves[hit->leaf].material];
}

/* The spot of a hit: normals turned to the viewer on a wall seen from inside; at a singular point the view direction serves. */
static void make_spot(const quoin_scene *scene, const quoin_ray *ray, const qn_seen *hit, qn_spot *spot) {
  qn_seen_normal(scene, ray, hit, spot->normal);
  for (int i = 0; i < 3; i++) {
    spot->point[i] = ray->o[i] + hit->t * ray->d[i];
    spot->viewer[i] = -ray->d[i];
    spot->normal[i] = hit->leaving ? -spot->normal[i] : spot->normal[i];
  }
  (void)qn_unit3(spot->viewer); /* of a direction, which is not zero */
  if (!qn_unit3(spot->normal)) {
    memcpy(spot->normal, spot->viewer, sizeof spot->normal);
  }
}

static int found(const qn_seen *hit) {
  return hit->surface != QUOIN_NO_SURFACE;
}
static int hidden(const qn_seen *hit) {
  return found(hit) && !(hit->leaving && hit->t == 0);
}

/* Adds one lamp's light to the batch. */
static quoin_status add_lamp(const qn_picture *p, qn_tracer *t, size_t n, const qn_lamp *lamp, qn_sample *out) {
  size_t waiting = 0;
  for (size_t i = 0; i < n; i++) {
    double towards[3], cosine;
    const qn_spot *spot = &t->spots[i];
    if (!found(&t->hits[i]) || !qn_light_towards(lamp, spot, towards, &cosine)) {
      continue;
    }
    if (!p->shadows || lamp->headlight || t->hits[i].leaving) {
      qn_light_add(finish_of(p, &t->hits[i]), lamp, spot, towards, cosine, out[i].light);
      continue;
    }
    quoin_ray *ray = &t->shadow_rays[waiting];
    qn_shadow_ray(&t->rays[i], t->hits[i].t, spot->point, spot->normal, lamp, ray);
    if (ray->d[0] == 0 && ray->d[1] == 0 && ray->d[2] == 0) {
      continue; /* the lamp is at the spot */
    }
    memcpy(t->towards[waiting], towards, sizeof towards);
    t->cosine[waiting] = cosine;
    t->starts_on[waiting] = t->hits[i].surface;
    t->lit[waiting++] = (uint32_t)i;
  }
  const quoin_status status = waiting ? qn_look(t->work, waiting, t->shadow_rays, t->starts_on, QN_LOOK_ANY, t->shadow_hits) : QUOIN_OK;
  if (status != QUOIN_OK) {
    return status;
  }
  t->shadow_ray_count += waiting;
  for (size_t k = 0; k < waiting; k++) {
    const uint32_t i = t->lit[k];
    if (!hidden(&t->shadow_hits[k])) {
      qn_light_add(finish_of(p, &t->hits[i]), lamp, &t->spots[i], t->towards[k], t->cosine[k], out[i].light);
    }
  }
  return QUOIN_OK;
}

quoin_status qn_trace(const qn_picture *p, qn_tracer *t, size_t n, const double (*xy)[2], qn_sample *out) {
  for (size_t i = 0; i < n; i++) {
    qn_frustum_ray(&p->frustum, xy[i][0], xy[i][1], &t->rays[i]);
  }
  quoin_status status = qn_look(t->work, n, t->rays, NULL, QN_LOOK_T, t->hits);
  t->camera_rays += n;
  for (size_t i = 0; status == QUOIN_OK && i < n; i++) {
    const qn_seen *hit = &t->hits[i];
    if (found(hit)) {
      make_spot(p->scene, &t->rays[i], hit, &t->spots[i]);
      qn_light_ambient(finish_of(p, hit), out[i].light);
      out[i].surface = (uint64_t)hit->surface << 32 | p->scene->leaves[hit->leaf].material;
    } else {
      memcpy(out[i].light, p->background, sizeof out[i].light);
      out[i].surface = QN_NO_SURFACE_SEEN;
    }
  }
  for (size_t k = 0; status == QUOIN_OK && k < p->lamp_count; k++) {
    status = add_lamp(p, t, n, &p->lamps[k], out);
  }
  for (size_t i = 0; status == QUOIN_OK && i < n; i++) {
    for (int c = 0; c < 3; c++) {
      out[i].light[c] = fmin(out[i].light[c], 1);
    }
  }
  return status;
}
