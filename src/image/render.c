/* The picture, tile by tile over threads. Each pixel is a function of the scene and of its place, so threads and their order
   do not show. Three passes with a wait between them: a sample a pixel; which pixels to refine; their samples. */
#include "base/limits.h"
#include "base/thread.h"
#include "image/colour.h"
#include "image/refine.h"
#include "image/trace.h"
#include "query/look.h"

#include <math.h>
#include <string.h>

enum { TILE = QN_TILE, TILE_PIXELS = TILE * TILE, BLOCK = 8 };
enum { FEW_PIXELS = 300 }; /* to be refined: sooner done than other threads are started */

/* A sample's place in its pixel, and the sides that it is next to. */
typedef struct sample { double x, y; unsigned sides; } sample;

typedef struct rendering {
  const quoin_render_options *options;
  qn_picture picture;
  qn_tone tone;
  qn_first_pass pass;      /* its arrays are pixels and surfaces, to be read */
  unsigned char *pixels, background[4];
  uint32_t *surfaces;
  unsigned char *marks;    /* by pixel: QN_REFINE_WANTED, QN_REFINE_DONE or 0 */
  unsigned char *sides;    /* by pixel: QN_REFINE_LEFT and so on */
  uint32_t *wanted;        /* by tile: pixels that are wanted now, or some number where it is not 0 */
  unsigned char *sided;    /* by tile: some pixel of it has sides */
  uint16_t turns[TILE_PIXELS]; /* the pixels of a tile along a Z curve: row * TILE + column */
  size_t tiles_across, tiles;
  unsigned side;           /* side * side samples a refined pixel, */
  sample *pattern;
  unsigned enough;         /* unless its first ones differ by at most so many levels */
  qn_crew crew;
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
    status = qn_tracer_new(&r->picture, &r->tracers[thread]);
  }
  *out = r->tracers[thread];
  return status;
}

/* The first pass's colours and surfaces of a block. */
static void put_block(const rendering *r, const qn_tracer *tracer, size_t x0, size_t y0, uint64_t live) {
  const qn_spots *s = &tracer->spots;
  if (!tracer->hits) { /* as many are */
    for (size_t y = y0; y < y0 + BLOCK && y < r->pass.height; y++) {
      for (size_t x = x0; x < x0 + BLOCK && x < r->pass.width; x++) {
        memcpy(r->pixels + y * r->pass.row_bytes + 4 * x, r->background, 4);
        r->surfaces[y * r->pass.width + x] = QUOIN_NO_SURFACE;
      }
    }
    return;
  }
  for (uint64_t m = live; m; m &= m - 1) {
    const unsigned lane = qn_trailing_zeros(m);
    const size_t x = x0 + qn_lane_column(lane), y = y0 + qn_lane_row(lane);
    const double light[3] = {s->light[0][lane], s->light[1][lane], s->light[2][lane]};
    put(r, x, y, light);
    r->surfaces[y * r->pass.width + x] = s->surface[lane];
  }
}

/* The same rays as a tile's, when that is too wide an angle for a packet. */
static qn_packet *one_by_one(const rendering *r, qn_tracer *tracer, size_t x0, size_t y0, uint64_t live) {
  double x[QN_LANES], y[QN_LANES];
  for (unsigned lane = 0; lane < QN_LANES; lane++) {
    x[lane] = (double)(x0 + qn_lane_column(lane)) + 0.5, y[lane] = (double)(y0 + qn_lane_row(lane)) + 0.5;
  }
  qn_trace_places(&r->picture, tracer, QN_LANES, x, y);
  tracer->samples.live = live;
  return &tracer->samples;
}

static quoin_status first_tile(void *user, unsigned thread, size_t number) {
  rendering *r = user;
  const tile t = tile_at(r, number);
  qn_tracer *tracer;
  quoin_status status = tracer_of(r, thread, &tracer);
  qn_entry entry;
  int entered = 0;
  if (status == QUOIN_OK && r->picture.narrow) {
    qn_frustum_block(&r->picture.frustum, t.x0, t.y0, t.x1, t.y1, &tracer->tile);
    entered = qn_look_enter(tracer->work, &tracer->tile, 0, &entry);
  }
  for (size_t y = t.y0; status == QUOIN_OK && y < t.y1; y += BLOCK) {
    for (size_t x = t.x0; status == QUOIN_OK && x < t.x1; x += BLOCK) {
      qn_packet *rays = &tracer->tile;
      qn_frustum_tile(&r->picture.frustum, x, y, t.x1, t.y1, rays);
      const uint64_t live = rays->live;
      rays->entry = entered ? &entry : NULL;
      if (!r->picture.narrow) {
        rays = one_by_one(r, tracer, x, y, live);
      }
      status = qn_trace(&r->picture, tracer, rays);
      if (status == QUOIN_OK) {
        put_block(r, tracer, x, y, live);
      }
    }
  }
  return status;
}

static quoin_status mark_tile(void *user, unsigned thread, size_t number) {
  (void)thread;
  rendering *r = user;
  const tile t = tile_at(r, number);
  r->wanted[number] = (uint32_t)qn_refine_mark(&r->pass, t.x0, t.y0, t.x1, t.y1, r->marks);
  for (size_t y = t.y0; y < t.y1; y++) {
    memset(r->sides + y * r->pass.width + t.x0, 0, t.x1 - t.x0);
  }
  return QUOIN_OK;
}

/* Looks for what is beyond sides of pixels of this tile and its neighbours. */
static quoin_status follow_tile(void *user, unsigned thread, size_t number) {
  (void)thread;
  rendering *r = user;
  const size_t column = number % r->tiles_across;
  const int some = r->sided[number] || (column > 0 && r->sided[number - 1]) || (column + 1 < r->tiles_across && r->sided[number + 1]) ||
                   (number >= r->tiles_across && r->sided[number - r->tiles_across]) ||
                   (number + r->tiles_across < r->tiles && r->sided[number + r->tiles_across]);
  r->wanted[number] = 0;
  if (some) {
    const tile t = tile_at(r, number);
    r->wanted[number] = (uint32_t)qn_refine_follow(&r->pass, t.x0, t.y0, t.x1, t.y1, r->sides, r->marks);
  }
  return QUOIN_OK;
}

/* --- a tile's pixels refined ----------------------------------------------------------------------------------------- */

/* A pixel in work. */
typedef struct refined {
  double sum[3];
  double low[3], high[3];   /* of the samples' light */
  double under[3], over[3]; /* light from here on, or under this, is QN_REFINE_LEVELS from the centre's level and more */
  unsigned char centre[3], sides;
  uint16_t x, y; /* in the tile */
} refined;

/* Samples that are being gathered, with the pixel each belongs to. */
typedef struct batch {
  size_t count;
  double x[QN_LANES], y[QN_LANES];
  struct { refined *pixel; unsigned sides; } owner[QN_LANES];
} batch;

/* Traces what was gathered and adds it to the pixels it belongs to. */
static quoin_status flush_batch(const rendering *r, qn_tracer *tracer, batch *b) {
  if (b->count == 0) {
    return QUOIN_OK;
  }
  qn_trace_places(&r->picture, tracer, b->count, b->x, b->y);
  const quoin_status status = qn_trace(&r->picture, tracer, &tracer->samples);
  for (size_t k = 0; status == QUOIN_OK && k < b->count; k++) {
    refined *p = b->owner[k].pixel;
    int far = 0;
    for (int c = 0; c < 3; c++) {
      const double light = tracer->spots.light[c][k];
      p->sum[c] += light;
      p->low[c] = light < p->low[c] ? light : p->low[c], p->high[c] = light > p->high[c] ? light : p->high[c];
      far |= light < p->under[c] || light >= p->over[c];
    }
    p->sides |= (unsigned char)(far ? b->owner[k].sides : 0);
  }
  b->count = 0;
  return status;
}

/* Takes samples from to end - 1 of every pixel in the list. */
static quoin_status take_samples(const rendering *r, qn_tracer *tracer, const tile *t, size_t count, refined *const *list, unsigned from, unsigned end) {
  quoin_status status = QUOIN_OK;
  batch b = {.count = 0};
  for (size_t i = 0; i < count; i++) {
    const double x = (double)(t->x0 + list[i]->x), y = (double)(t->y0 + list[i]->y);
    for (unsigned k = from; status == QUOIN_OK && k < end; k++) {
      const sample *s = &r->pattern[k];
      b.x[b.count] = x + s->x, b.y[b.count] = y + s->y;
      b.owner[b.count].pixel = list[i];
      b.owner[b.count++].sides = s->sides;
      if (b.count == QN_LANES) {
        status = flush_batch(r, tracer, &b);
      }
    }
  }
  return status == QUOIN_OK ? flush_batch(r, tracer, &b) : status;
}

static void make_turns(uint16_t turns[TILE_PIXELS]) {
  for (uint32_t k = 0; k < TILE_PIXELS; k++) {
    uint32_t column = 0, row = 0;
    for (uint32_t bit = 0; TILE >> bit > 1; bit++) { /* the even and the odd bits of k */
      column |= (k >> 2 * bit & 1) << bit;
      row |= (k >> (2 * bit + 1) & 1) << bit;
    }
    turns[k] = (uint16_t)(row * TILE + column);
  }
}

/* The pixels of a tile that are wanted, along a Z curve, so that samples that are asked together are neighbours both ways. */
static size_t list_wanted(const rendering *r, const tile *t, refined pixels[TILE_PIXELS]) {
  size_t count = 0;
  for (uint32_t k = 0; k < TILE_PIXELS; k++) {
    const uint32_t column = r->turns[k] % TILE, row = r->turns[k] / TILE;
    const size_t x = t->x0 + column, y = t->y0 + row;
    if (x < t->x1 && y < t->y1 && r->marks[y * r->pass.width + x] == QN_REFINE_WANTED) {
      refined *p = &pixels[count++];
      memset(p, 0, sizeof *p);
      memcpy(p->centre, r->pixels + y * r->pass.row_bytes + 4 * x, 3);
      for (int c = 0; c < 3; c++) {
        const int level = p->centre[c];
        p->low[c] = 1, p->high[c] = 0;
        p->under[c] = level > QN_REFINE_LEVELS ? r->tone.step[level - QN_REFINE_LEVELS - 1] : 0;
        p->over[c] = level + QN_REFINE_LEVELS < 255 ? r->tone.step[level + QN_REFINE_LEVELS] : INFINITY;
      }
      p->x = (uint16_t)column, p->y = (uint16_t)row;
    }
  }
  return count;
}

static quoin_status refine_tile(void *user, unsigned thread, size_t number) {
  rendering *r = user;
  const tile t = tile_at(r, number);
  refined pixels[TILE_PIXELS], *list[TILE_PIXELS];
  const size_t count = r->wanted[number] ? list_wanted(r, &t, pixels) : 0;
  if (count == 0) {
    return QUOIN_OK;
  }
  qn_tracer *tracer;
  quoin_status status = tracer_of(r, thread, &tracer);
  for (size_t i = 0; i < count; i++) {
    list[i] = &pixels[i];
  }
  const unsigned first = qn_refine_corners(r->side), all = r->side * r->side;
  if (status == QUOIN_OK) {
    status = take_samples(r, tracer, &t, count, list, 0, first);
  }
  size_t open = 0;
  for (size_t i = 0; i < count && first < all; i++) {
    const refined *p = &pixels[i];
    int most = 0;
    for (int c = 0; c < 3; c++) {
      const int low = qn_tone_byte(&r->tone, p->low[c]), high = qn_tone_byte(&r->tone, p->high[c]), centre = p->centre[c];
      const int spread = (high > centre ? high : centre) - (low < centre ? low : centre);
      most = spread > most ? spread : most;
    }
    if (most > (int)r->enough) {
      list[open++] = &pixels[i];
    }
  }
  if (status == QUOIN_OK) {
    status = take_samples(r, tracer, &t, open, list, first, all);
  }
  for (size_t i = 0, next = 0; status == QUOIN_OK && i < count; i++) {
    const refined *p = &pixels[i];
    const int whole = next < open && list[next] == p;
    next += (size_t)whole;
    const size_t x = t.x0 + p->x, y = t.y0 + p->y, at = y * r->pass.width + x;
    double mean[3];
    for (int c = 0; c < 3; c++) {
      mean[c] = p->sum[c] / (whole ? all : first);
    }
    put(r, x, y, mean);
    r->marks[at] = QN_REFINE_DONE;
    r->sides[at] = p->sides;
    r->sided[number] |= p->sides;
  }
  tracer->refined_pixels += count;
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
  return qn_crew_run(&r->crew, qn_thread_count(r->options->threads), r->tiles, body, r, &progress);
}

static void add_stats(quoin_stats *sum, const quoin_stats *one) {
  sum->rays += one->rays;
  sum->points += one->points;
  sum->packets += one->packets;
  sum->nodes += one->nodes;
  sum->leaves += one->leaves;
  sum->filter_sure += one->filter_sure;
  sum->exact_signs += one->exact_signs;
  sum->exact_orders += one->exact_orders;
  sum->exact_rays += one->exact_rays;
  sum->exact_points += one->exact_points;
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
      stats->hits += r->tracers[i]->hit_count;
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
  const unsigned threads = qn_thread_count(r->options->threads);
  if (status == QUOIN_OK && antialias) {
    status = qn_crew_run(&r->crew, threads, r->tiles, mark_tile, r, NULL);
  }
  for (int round = 0; status == QUOIN_OK && antialias && round <= QN_REFINE_ROUNDS; round++) {
    size_t wanted = 0;
    for (size_t i = 0; i < r->tiles; i++) {
      wanted += r->wanted[i];
    }
    if (wanted == 0) {
      break;
    }
    const unsigned now = wanted < FEW_PIXELS ? 1 : threads;
    memset(r->sided, 0, r->tiles);
    status = round == 0 ? run_pass(r, refine_tile, 0.5, 0.5) : qn_crew_run(&r->crew, now, r->tiles, refine_tile, r, NULL);
    if (status == QUOIN_OK) {
      status = qn_crew_run(&r->crew, now, r->tiles, follow_tile, r, NULL);
    }
  }
  return status;
}

/* NOLINTNEXTLINE(readability-non-const-parameter): the pixels are written through a task */
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
  r.marks = qn_alloc(scene->mem, 2 * count);
  r.sides = r.marks ? r.marks + count : NULL;
  r.enough = qn_refine_enough(r.side ? r.side : 1);
  const size_t samples = (size_t)r.side * r.side;
  r.pattern = qn_alloc(scene->mem, samples * sizeof *r.pattern);
  for (size_t k = 0; r.pattern && k < samples; k++) {
    qn_refine_place(r.side, (unsigned)k, &r.pattern[k].x, &r.pattern[k].y);
    r.pattern[k].sides = qn_refine_sides(r.side, (unsigned)k);
  }
  r.wanted = qn_alloc(scene->mem, r.tiles * sizeof *r.wanted);
  r.sided = qn_alloc(scene->mem, r.tiles);
  if (r.surfaces && r.marks && r.wanted && r.sided && r.pattern) {
    make_turns(r.turns);
    qn_tone_make(&r.tone);
    for (int c = 0; c < 3; c++) {
      r.background[c] = qn_tone_byte(&r.tone, r.picture.background[c]);
    }
    r.background[3] = 255;
    r.pass = (qn_first_pass){options->width, options->height, row_bytes, pixels, r.surfaces};
    qn_crew_open(&r.crew);
    status = render_passes(&r);
    qn_crew_close(&r.crew);
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
  qn_free(scene->mem, r.marks, 2 * count);
  qn_free(scene->mem, r.pattern, samples * sizeof *r.pattern);
  qn_free(scene->mem, r.wanted, r.tiles * sizeof *r.wanted);
  qn_free(scene->mem, r.sided, r.tiles);
  qn_picture_free(&r.picture);
  return status;
}
