/* The picture, tile by tile over threads. Each pixel is a function of the scene and of its place, so threads and their order
   do not show. Three passes with a wait between them: a sample a pixel; which pixels to refine; their samples. */
#include "base/limits.h"
#include "base/thread.h"
#include "image/colour.h"
#include "image/refine.h"
#include "image/trace.h"

#include <string.h>

enum { TILE = 32, TILE_PIXELS = TILE * TILE };

typedef struct rendering {
  const quoin_render_options *options;
  qn_picture picture;
  qn_tone tone;
  qn_first_pass pass;      /* its arrays are pixels and surfaces, to be read */
  unsigned char *pixels;
  uint64_t *surfaces;
  unsigned char *refine;   /* by pixel: 1 where more samples are wanted */
  size_t tiles_across, tiles;
  unsigned side;           /* side * side samples a refined pixel */
  qn_tracer *tracers[QN_MAX_THREADS]; /* each made by its thread when it first has work */
} rendering;

typedef struct tile { size_t x0, y0, x1, y1; } tile;

static tile tile_at(const rendering *r, size_t i) {
  tile t = {i % r->tiles_across * TILE, i / r->tiles_across * TILE, 0, 0};
  t.x1 = t.x0 + TILE < r->pass.width ? t.x0 + TILE : r->pass.width;
  t.y1 = t.y0 + TILE < r->pass.height ? t.y0 + TILE : r->pass.height;
  return t;
}

static void put(const rendering *r, size_t x, size_t y, const double light[3]) {
  unsigned char *pixel = r->pixels + y * r->pass.row_bytes + 4 * x;
  for (int c = 0; c < 3; c++) {
    pixel[c] = qn_tone_byte(&r->tone, light[c]);
  }
  pixel[3] = 255;
}

static quoin_status tracer_of(rendering *r, unsigned thread, qn_tracer **out) {
  quoin_status status = QUOIN_OK;
  if (!r->tracers[thread]) {
    status = qn_tracer_new(r->picture.scene, &r->tracers[thread]);
  }
  *out = r->tracers[thread];
  return status;
}

/* Pixels of a tile are visited along a Z curve, so that any 64 in turn from a multiple of 64 are an 8 x 8 block: rays that are asked
   together are neighbours both ways. k < TILE_PIXELS; column and row are the even and the odd bits of k. 0: outside the picture. */
static int pixel_at(const tile *t, uint32_t k, size_t *x, size_t *y) {
  size_t column = 0, row = 0;
  for (uint32_t bit = 0; TILE >> bit > 1; bit++) {
    column |= (size_t)(k >> 2 * bit & 1) << bit;
    row |= (size_t)(k >> (2 * bit + 1) & 1) << bit;
  }
  *x = t->x0 + column;
  *y = t->y0 + row;
  return *x < t->x1 && *y < t->y1;
}

/* A batch of samples that is being gathered, with the pixel (its k within the tile) each belongs to. */
typedef struct batch {
  size_t count;
  double xy[QN_BATCH][2];
  uint32_t owner[QN_BATCH];
  qn_sample samples[QN_BATCH];
} batch;

static void add_sample(batch *b, double x, double y, uint32_t owner) {
  b->xy[b->count][0] = x;
  b->xy[b->count][1] = y;
  b->owner[b->count++] = owner;
}

/* Traces what was gathered and puts it into the picture as it is. */
static quoin_status flush_first(rendering *r, qn_tracer *tracer, const tile *t, batch *b) {
  const quoin_status status = qn_trace(&r->picture, tracer, b->count, (const double(*)[2])b->xy, b->samples);
  for (size_t i = 0; status == QUOIN_OK && i < b->count; i++) {
    size_t x, y;
    (void)pixel_at(t, b->owner[i], &x, &y);
    put(r, x, y, b->samples[i].light);
    r->surfaces[y * r->pass.width + x] = b->samples[i].surface;
  }
  b->count = 0;
  return status;
}

static quoin_status first_tile(void *user, unsigned thread, size_t number) {
  rendering *r = user;
  const tile t = tile_at(r, number);
  qn_tracer *tracer;
  quoin_status status = tracer_of(r, thread, &tracer);
  batch b = {.count = 0};
  for (uint32_t k = 0; status == QUOIN_OK && k < TILE_PIXELS; k++) {
    size_t x, y;
    if (pixel_at(&t, k, &x, &y)) {
      add_sample(&b, (double)x + 0.5, (double)y + 0.5, k);
    }
    if (b.count == QN_BATCH || (b.count && k == TILE_PIXELS - 1)) {
      status = flush_first(r, tracer, &t, &b);
    }
  }
  return status;
}

static quoin_status mark_tile(void *user, unsigned thread, size_t number) {
  (void)thread;
  rendering *r = user;
  const tile t = tile_at(r, number);
  for (size_t y = t.y0; y < t.y1; y++) {
    for (size_t x = t.x0; x < t.x1; x++) {
      r->refine[y * r->pass.width + x] = (unsigned char)qn_refine_needed(&r->pass, x, y);
    }
  }
  return QUOIN_OK;
}

/* Traces what was gathered and adds it to the sums of the pixels it belongs to. */
static quoin_status flush_batch(rendering *r, qn_tracer *tracer, batch *b, double (*sums)[3]) {
  const quoin_status status = qn_trace(&r->picture, tracer, b->count, (const double(*)[2])b->xy, b->samples);
  for (size_t k = 0; status == QUOIN_OK && k < b->count; k++) {
    for (int c = 0; c < 3; c++) {
      sums[b->owner[k]][c] += b->samples[k].light[c];
    }
  }
  b->count = 0;
  return status;
}

static quoin_status refine_tile(void *user, unsigned thread, size_t number) {
  rendering *r = user;
  const tile t = tile_at(r, number);
  qn_tracer *tracer;
  quoin_status status = tracer_of(r, thread, &tracer);
  double sums[TILE_PIXELS][3];
  memset(sums, 0, sizeof sums);
  batch b = {.count = 0};
  const unsigned samples = r->side * r->side;
  for (uint32_t k = 0; k < TILE_PIXELS; k++) {
    size_t x, y;
    if (!pixel_at(&t, k, &x, &y) || !r->refine[y * r->pass.width + x]) {
      continue;
    }
    for (unsigned i = 0; status == QUOIN_OK && i < samples; i++) {
      double across, down;
      qn_refine_place(r->side, i, &across, &down);
      add_sample(&b, (double)x + across, (double)y + down, k);
      if (b.count == QN_BATCH) {
        status = flush_batch(r, tracer, &b, sums);
      }
    }
  }
  if (status == QUOIN_OK && b.count) {
    status = flush_batch(r, tracer, &b, sums);
  }
  for (uint32_t k = 0; status == QUOIN_OK && k < TILE_PIXELS; k++) {
    size_t x, y;
    if (pixel_at(&t, k, &x, &y) && r->refine[y * r->pass.width + x]) {
      for (int c = 0; c < 3; c++) {
        sums[k][c] /= samples;
      }
      put(r, x, y, sums[k]);
      tracer->refined_pixels++;
    }
  }
  return status;
}

/* A pass's share of the whole, for the caller's progress. */
typedef struct share { const quoin_progress *progress; double from, size; } share;
static int report_share(void *user, double done) {
  const share *s = user;
  return s->progress->report(s->progress->user, s->from + s->size * done);
}

static quoin_status run_pass(rendering *r, quoin_status (*body)(void *, unsigned, size_t), double from, double size) {
  share s = {&r->options->progress, from, size};
  const quoin_progress progress = {r->options->progress.report ? report_share : NULL, &s};
  return qn_parallel(qn_thread_count(r->options->threads), r->tiles, body, r, &progress);
}

static void add_stats(quoin_stats *sum, const quoin_stats *one) {
  sum->rays += one->rays;
  sum->points += one->points;
  sum->nodes += one->nodes;
  sum->leaves += one->leaves;
  sum->filter_sure += one->filter_sure;
  sum->exact_signs += one->exact_signs;
  sum->exact_orders += one->exact_orders;
  sum->exact_rays += one->exact_rays;
  sum->exact_roundings += one->exact_roundings;
  sum->exact_forms += one->exact_forms;
}

static void gather_stats(const rendering *r, quoin_render_stats *stats) {
  *stats = (quoin_render_stats){0};
  for (size_t i = 0; i < QN_MAX_THREADS; i++) {
    if (r->tracers[i]) {
      quoin_stats one;
      quoin_work_stats(r->tracers[i]->work, &one);
      add_stats(&stats->work, &one);
      stats->camera_rays += r->tracers[i]->camera_rays;
      stats->shadow_rays += r->tracers[i]->shadow_ray_count;
      stats->refined_pixels += r->tracers[i]->refined_pixels;
    }
  }
}

quoin_render_options quoin_render_options_default(void) {
  return (quoin_render_options){.width = 800, .height = 600, .antialias = 1, .samples = 16, .shadows = 1};
}

static quoin_status render_passes(rendering *r) {
  const int antialias = r->options->antialias;
  quoin_status status = run_pass(r, first_tile, 0, antialias ? 0.5 : 1);
  if (status == QUOIN_OK && antialias) {
    status = qn_parallel(qn_thread_count(r->options->threads), r->tiles, mark_tile, r, NULL);
    if (status == QUOIN_OK) {
      status = run_pass(r, refine_tile, 0.5, 0.5);
    }
  }
  return status;
}

quoin_status quoin_render(const quoin_scene *scene, const quoin_render_options *options, unsigned char *pixels, size_t row_bytes,
                          quoin_render_stats *stats) {
  if (!scene || !options || !pixels || options->width == 0 || options->height == 0 || options->width > SIZE_MAX / 8 / options->height ||
      row_bytes < 4 * options->width || row_bytes > SIZE_MAX / options->height) {
    return QUOIN_E_ARGUMENT;
  }
  const size_t count = options->width * options->height;
  rendering r = {.options = options, .pixels = pixels, .side = options->antialias ? qn_refine_side(options->samples) : 1};
  r.tiles_across = (options->width - 1) / TILE + 1;
  r.tiles = r.tiles_across * ((options->height - 1) / TILE + 1);
  if (r.side == 0) {
    return QUOIN_E_ARGUMENT;
  }
  quoin_status status = qn_picture_make(scene, options, &r.picture);
  if (status != QUOIN_OK) {
    return status;
  }
  r.surfaces = qn_alloc(scene->mem, count * sizeof *r.surfaces);
  r.refine = qn_alloc(scene->mem, count);
  if (r.surfaces && r.refine) {
    qn_tone_make(&r.tone);
    r.pass = (qn_first_pass){options->width, options->height, row_bytes, pixels, r.surfaces};
    status = render_passes(&r);
  } else {
    status = QUOIN_E_MEMORY;
  }
  if (stats) {
    gather_stats(&r, stats);
  }
  for (size_t i = 0; i < QN_MAX_THREADS; i++) {
    qn_tracer_free(scene, r.tracers[i]);
  }
  qn_free(scene->mem, r.surfaces, count * sizeof *r.surfaces);
  qn_free(scene->mem, r.refine, count);
  qn_picture_free(&r.picture);
  return status;
}
