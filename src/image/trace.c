/* Samples of the picture, a packet at a time: 64 camera rays, then for each lamp the shadow rays of those that it may light.

   What is hidden: a lamp is, when the shadow ray to it is inside the solid anywhere. (At its start it may touch the hit's own surface from outside, which hides
   nothing.) No shadow ray is sent to a lamp behind the surface, nor to a headlight.

   A wall seen from inside the solid (the eye or the near plane is in it) is shown with its normal turned to the viewer and
   takes the light of every lamp on that side, without shadows: the solid around it would make all of them dark. */
#include "image/trace.h"
#include "image/colour.h"

#include <math.h>
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
  const double step = fmax(p.frustum.half_w / p.frustum.width, p.frustum.half_h / p.frustum.height);
  p.narrow = p.frustum.orthographic || 2 * QN_TILE * step < QN_NARROW;
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

quoin_status qn_tracer_new(const qn_picture *p, qn_tracer **out) {
  qn_mem *mem = p->scene->mem;
  qn_tracer *t = qn_alloc_line(mem, sizeof *t);
  if (!t) {
    return QUOIN_E_MEMORY;
  }
  memset(t, 0, sizeof *t);
  const quoin_status status = quoin_work_new(p->scene, &t->work);
  if (status != QUOIN_OK) {
    qn_free_line(mem, t, sizeof *t);
    return status;
  }
  t->shade = qn_shade_of(t->work->wide->name);
  qn_frustum_share(&p->frustum, 1, &t->tile);
  qn_frustum_share(&p->frustum, 0, &t->samples);
  *out = t;
  return QUOIN_OK;
}

void qn_tracer_free(const quoin_scene *scene, qn_tracer *tracer) {
  if (tracer) {
    quoin_work_free(tracer->work);
    qn_free_line(scene->mem, tracer, sizeof *tracer);
  }
}

/* The live rays of a packet one behind another in t->alone; returns how many. */
static size_t list_rays(qn_tracer *t, const qn_packet *p, unsigned lane_of[QN_LANES]) {
  size_t n = 0;
  for (uint64_t m = p->live; m; m &= m - 1) {
    const unsigned lane = qn_trailing_zeros(m);
    t->alone[n] = (quoin_ray){{p->o[0][lane], p->o[1][lane], p->o[2][lane]}, {p->d[0][lane], p->d[1][lane], p->d[2][lane]}, p->from[lane], p->to[lane]};
    t->alone_on[n] = p->on[lane];
    lane_of[n++] = lane;
  }
  return n;
}

typedef struct lanes_seen { const unsigned *lane_of; qn_seen *seen; uint64_t *met; } lanes_seen;
static quoin_status set_seen(void *user, size_t i, const qn_seen *seen) {
  const lanes_seen *s = user;
  s->seen[s->lane_of[i]] = *seen;
  *s->met |= (uint64_t)(seen->surface != QUOIN_NO_SURFACE) << s->lane_of[i];
  return QUOIN_OK;
}

/* The first boundaries of camera rays, which may be too spread out to go as one packet unless they are known to be narrow. */
static quoin_status look(qn_tracer *t, qn_packet *p, int narrow, qn_seen seen[QN_LANES], uint64_t *met) {
  if (narrow || t->shade->together(p, p->live)) {
    return qn_look_packet(t->work, p, QN_LOOK_T, seen, met);
  }
  unsigned lane_of[QN_LANES];
  const size_t n = list_rays(t, p, lane_of);
  *met = 0;
  return qn_look(t->work, n, t->alone, t->alone_on, QN_LOOK_T, set_seen, &(lanes_seen){lane_of, seen, met});
}

/* The shadow rays that are inside the solid anywhere. */
static quoin_status look_blocked(qn_tracer *t, qn_packet *p, int narrow, uint64_t *blocked) {
  uint8_t is_blocked[QN_LANES];
  quoin_status status = QUOIN_OK;
  *blocked = 0;
  if (narrow || t->shade->together(p, p->live)) {
    qn_packet_hits hits;
    qn_look_run(t->work, p, &hits);
    *blocked = hits.found;
    for (uint64_t m = hits.unsure; m && status == QUOIN_OK; m &= m - 1) {
      const unsigned lane = qn_trailing_zeros(m);
      const quoin_ray ray = {{p->o[0][lane], p->o[1][lane], p->o[2][lane]}, {p->d[0][lane], p->d[1][lane], p->d[2][lane]}, p->from[lane], p->to[lane]};
      status = qn_look_woven_blocked(t->work, &ray, is_blocked);
      *blocked |= (uint64_t)(status == QUOIN_OK && is_blocked[0]) << lane;
    }
    return status;
  }
  unsigned lane_of[QN_LANES];
  const size_t n = list_rays(t, p, lane_of);
  status = qn_look_blocked(t->work, n, t->alone, t->alone_on, is_blocked);
  for (size_t i = 0; i < n && status == QUOIN_OK; i++) {
    *blocked |= (uint64_t)(is_blocked[i] != 0) << lane_of[i];
  }
  return status;
}

/* The spots of the lanes that meet something, lit by the ambient light alone; the others show the background. Returns the lanes that see a wall
   from inside. */
static uint64_t set_spots(const qn_picture *p, qn_tracer *t, uint64_t hits) {
  qn_spots *s = &t->spots;
  uint64_t leaving = 0;
  s->shiny = 0;
  for (unsigned lane = 0; lane < QN_LANES; lane++) {
    s->surface[lane] = QUOIN_NO_SURFACE;
    for (int i = 0; i < 3; i++) {
      s->light[i][lane] = p->background[i];
    }
  }
  for (uint64_t m = hits; m; m &= m - 1) {
    const unsigned lane = qn_trailing_zeros(m);
    const qn_seen *seen = &t->seen[lane];
    const qn_finish *f = &p->finishes[p->scene->leaves[seen->leaf].material];
    s->t[lane] = seen->t;
    s->surface[lane] = seen->surface;
    leaving |= (uint64_t)(seen->leaving != 0) << lane;
    for (int i = 0; i < 3; i++) {
      s->color[i][lane] = f->color[i];
      s->light[i][lane] = f->ambient * f->color[i];
    }
    s->diffuse[lane] = f->diffuse, s->specular[lane] = f->specular, s->shininess[lane] = f->shininess;
    s->shiny |= f->specular > 0;
  }
  return leaving;
}

/* Of the lanes `lit`, those that nothing hides from the lamp. */
static quoin_status cast_shadows(const qn_lamp *lamp, qn_tracer *t, const qn_packet *rays, uint64_t *lit) {
  qn_packet *shadows = &t->shadows;
  const int same_directions = lamp->directional && t->shadows_of == lamp;
  const uint64_t live = t->shade->shadow(lamp, rays, *lit, &t->spots, shadows);
  *lit = live;
  if (!live) {
    return QUOIN_OK;
  }
  for (unsigned lane = 0; lane < QN_LANES; lane++) {
    shadows->from[lane] = 0, shadows->to[lane] = lamp->directional ? INFINITY : 1;
    shadows->on[lane] = t->spots.surface[lane];
  }
  shadows->live = live;
  shadows->few = QN_MANY_LANES;
  shadows->any = 1;
  shadows->tile = QN_TILE_NONE;
  shadows->new_origins = 1, shadows->new_directions = !same_directions, shadows->kept_ranges = 0;
  uint64_t blocked;
  const quoin_status status = look_blocked(t, shadows, lamp->directional, &blocked);
  t->shadows_of = lamp->directional ? lamp : NULL;
  t->shadow_ray_count += (uint64_t)__builtin_popcountll(live);
  *lit = live & ~blocked;
  return status;
}

quoin_status qn_trace(const qn_picture *p, qn_tracer *t, qn_packet *rays) {
  uint64_t hits;
  quoin_status status = look(t, rays, p->narrow, t->seen, &hits);
  t->camera_rays += (uint64_t)__builtin_popcountll(rays->live);
  t->hits = hits;
  t->hit_count += (uint64_t)__builtin_popcountll(hits);
  rays->new_origins = rays->new_origins && (p->frustum.orthographic || !p->narrow); /* what all rays share has been seen */
  rays->new_directions = rays->new_directions && (!p->frustum.orthographic || !p->narrow);
  rays->kept_ranges = p->narrow;
  if (status != QUOIN_OK) {
    return status;
  }
  const uint64_t leaving = set_spots(p, t, hits);
  if (!hits) {
    return QUOIN_OK;
  }
  if (rays->tile != QN_TILE_NONE) { /* packets may answer without making their rays */
    double (*to)[QN_LANES] = rays->tile == QN_TILE_ORIGINS ? rays->o : rays->d;
    for (unsigned lane = 0; lane < QN_LANES; lane++) {
      for (int i = 0; i < 3; i++) {
        to[i][lane] = rays->across[i][qn_lane_column(lane)] + rays->up[i][qn_lane_row(lane)];
      }
    }
  }
  t->shade->place(p->scene, rays, hits, &t->spots);
  for (size_t k = 0; k < p->lamp_count; k++) {
    const qn_lamp *lamp = &p->lamps[k];
    uint64_t lit = t->shade->face(lamp, hits, &t->spots);
    uint64_t asked = p->shadows && !lamp->headlight ? lit & ~leaving : 0;
    if (asked) {
      lit &= ~asked;
      status = cast_shadows(lamp, t, rays, &asked);
      if (status != QUOIN_OK) {
        return status;
      }
      lit |= asked;
    }
    if (lit) {
      t->shade->add(lamp, lit, &t->spots);
    }
  }
  t->shade->clamp(&t->spots);
  return QUOIN_OK;
}

void qn_trace_places(const qn_picture *p, qn_tracer *t, size_t count, double x[QN_LANES], double y[QN_LANES]) {
  for (size_t lane = count; lane < QN_LANES; lane++) {
    x[lane] = x[count - 1], y[lane] = y[count - 1];
  }
  qn_frustum_rays(&p->frustum, x, y, &t->samples);
  t->samples.live = count == QN_LANES ? ~(uint64_t)0 : ((uint64_t)1 << count) - 1;
}
