/* Pictures: the time a render takes against its error, as samples grow. The reference has 32 x 32 samples in every pixel: the mean, in linear
   light, of 1024 pictures without antialiasing whose orthographic camera is moved by parts of a pixel. */
#include "grid.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char USAGE[] =
    "usage: bench_pictures MODEL CAMERA --width N [--threads N] [--seconds S] [--side N] [--csv FILE] [--name NAME] [--others LIST]\n"
    "  --width N     of the picture; its height follows from the camera file's rectangle\n"
    "  --side N      the reference has N x N samples a pixel; default 32\n"
    "  --others F    F has lines \"label seconds file.ppm\": pictures of other programs (8 bits, sRGB), judged against the same reference\n"
    "  --csv FILE    appends rows: scene,program,setting,seconds,rms,threads,rays; rms of sRGB values from 0 to 1\n";

typedef struct options {
  const char *model, *camera, *csv, *name, *others;
  unsigned width, side, threads;
  double seconds;
} options;

typedef struct studio {
  quoin_scene *scene;
  quoin_render_options how;
  double right[3], up[3]; /* a pixel's step */
  size_t bytes;
} studio;

static double linear_of[256];

static double to_srgb(double x) {
  return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
}

/* The camera file's rectangle as an orthographic camera with square pixels. */
static void place_camera(studio *s, const bench_camera *c, unsigned width) {
  double u = 0, v = 0;
  for (int k = 0; k < 3; k++) {
    u += c->u[k] * c->u[k];
    v += c->v[k] * c->v[k];
  }
  u = sqrt(u), v = sqrt(v);
  s->how = quoin_render_options_default();
  s->how.width = width;
  s->how.height = (size_t)(width * v / u + 0.5);
  s->how.has_camera = 1;
  s->how.camera.projection = QUOIN_ORTHOGRAPHIC;
  s->how.camera.fov = 90; /* at the distance of half the height */
  s->how.camera.near = 0;
  double pixel = v / (double)s->how.height;
  for (int k = 0; k < 3; k++) {
    s->how.camera.eye[k] = c->o[k] + c->u[k] / 2 + c->v[k] / 2;
    s->how.camera.look[k] = s->how.camera.eye[k] + c->d[k] * v / 2;
    s->how.camera.up[k] = c->v[k];
    s->right[k] = c->u[k] / u * pixel;
    s->up[k] = c->v[k] / v * pixel;
  }
  s->bytes = 4 * s->how.width * s->how.height;
}

static double *reference(const studio *s, unsigned side) {
  size_t n = s->how.width * s->how.height;
  unsigned char *pixels = malloc(s->bytes);
  double *sum = calloc(3 * n, sizeof *sum);
  quoin_render_options how = s->how;
  how.antialias = 0;
  how.threads = 0;
  int ok = pixels && sum;
  for (unsigned k = 0; ok && k < side * side; k++) {
    double x = (k % side + 0.5) / side - 0.5, y = (k / side + 0.5) / side - 0.5;
    for (int a = 0; a < 3; a++) {
      how.camera.eye[a] = s->how.camera.eye[a] + x * s->right[a] + y * s->up[a];
      how.camera.look[a] = s->how.camera.look[a] + x * s->right[a] + y * s->up[a];
    }
    ok = quoin_render(s->scene, &how, pixels, 4 * how.width, NULL) == QUOIN_OK;
    for (size_t i = 0; ok && i < n; i++) {
      for (int a = 0; a < 3; a++) {
        sum[3 * i + (size_t)a] += linear_of[pixels[4 * i + (size_t)a]];
      }
    }
  }
  for (size_t i = 0; ok && i < 3 * n; i++) {
    sum[i] = to_srgb(sum[i] / side / side);
  }
  free(pixels);
  if (!ok) {
    free(sum);
    return NULL;
  }
  return sum;
}

static double rms(const studio *s, const double *right, const unsigned char *pixels, size_t stride) {
  double sum = 0;
  size_t n = s->how.width * s->how.height;
  for (size_t i = 0; i < n; i++) {
    for (size_t a = 0; a < 3; a++) {
      double e = pixels[stride * i + a] / 255.0 - right[3 * i + a];
      sum += e * e;
    }
  }
  return sqrt(sum / (3 * (double)n));
}

static void row(const options *opt, const char *program, const char *setting, double seconds, double error, unsigned threads, double rays) {
  printf("  %-10s %-16s %9.4f s   rms %.6f\n", program, setting, seconds, error);
  FILE *f = opt->csv ? fopen(opt->csv, "a") : NULL;
  if (f) {
    fprintf(f, "%s,%s,%s,%.6g,%.6g,%u,%.0f\n", opt->name, program, setting, seconds, error, threads, rays);
    fclose(f);
  }
}

static int our_rows(const options *opt, const studio *s, const double *right) {
  static const unsigned samples[] = {1, 4, 9, 16, 25, 64, 144, 256};
  unsigned char *pixels = malloc(s->bytes);
  for (size_t k = 0; pixels && k < sizeof samples / sizeof *samples; k++) {
    quoin_render_options how = s->how;
    how.antialias = samples[k] > 1;
    how.samples = samples[k];
    how.threads = opt->threads;
    double best = INFINITY, begin = bench_now();
    quoin_render_stats stats;
    do {
      double from = bench_now();
      if (quoin_render(s->scene, &how, pixels, 4 * how.width, &stats) != QUOIN_OK) {
        free(pixels);
        return 0;
      }
      best = fmin(best, bench_now() - from);
    } while (bench_now() - begin < opt->seconds);
    char setting[32];
    snprintf(setting, sizeof setting, "%u samples", samples[k]);
    row(opt, "quoin", setting, best, rms(s, right, pixels, 4), opt->threads, (double)(stats.camera_rays + stats.shadow_rays));
  }
  free(pixels);
  return pixels != NULL;
}

/* An 8-bit PPM of the right size, or null. */
static unsigned char *read_ppm(const char *path, size_t width, size_t height) {
  FILE *f = fopen(path, "rb");
  unsigned char *pixels = NULL;
  unsigned long numbers[3];
  int ok = f && fgetc(f) == 'P' && fgetc(f) == '6';
  for (int i = 0; ok && i < 3; i++) {
    int c = fgetc(f);
    while (c == ' ' || c == '\n' || c == '#') {
      while (c == '#' && (c = fgetc(f)) != '\n' && c != EOF) {
        c = '#';
      }
      c = fgetc(f);
    }
    for (numbers[i] = 0; c >= '0' && c <= '9'; c = fgetc(f)) {
      numbers[i] = numbers[i] * 10 + (unsigned long)(c - '0');
    }
  }
  ok = ok && numbers[0] == width && numbers[1] == height && numbers[2] == 255;
  if (ok && (pixels = malloc(3 * width * height)) != NULL && fread(pixels, 3, width * height, f) != width * height) {
    free(pixels);
    pixels = NULL;
  }
  if (f) {
    fclose(f);
  }
  return pixels;
}

static int other_rows(const options *opt, const studio *s, const double *right) {
  FILE *f = fopen(opt->others, "r");
  char line[4096], label[256], path[2048];
  double seconds;
  while (f && fgets(line, sizeof line, f)) {
    if (sscanf(line, "%255s %lf %2047s", label, &seconds, path) == 3) {
      unsigned char *pixels = read_ppm(path, s->how.width, s->how.height);
      if (!pixels) {
        fprintf(stderr, "%s: not an 8-bit PPM of %zu by %zu\n", path, s->how.width, s->how.height);
        continue;
      }
      char *colon = strchr(label, ':');
      if (colon) {
        *colon = 0;
      }
      row(opt, label, colon ? colon + 1 : "", seconds, rms(s, right, pixels, 3), opt->threads, 0);
      free(pixels);
    }
  }
  if (f) {
    fclose(f);
  }
  return f != NULL;
}

int main(int argc, char **argv) {
  options opt = {.side = 32, .threads = 1, .seconds = 0.2, .name = "scene"};
  for (int i = 1; i < argc; i++) {
    const char *v = i + 1 < argc ? argv[i + 1] : NULL;
    if (strncmp(argv[i], "--", 2) != 0) {
      *(opt.model ? &opt.camera : &opt.model) = argv[i];
      continue;
    }
    if (v && strcmp(argv[i], "--width") == 0) { opt.width = (unsigned)strtoul(v, NULL, 10); }
    else if (v && strcmp(argv[i], "--side") == 0) { opt.side = (unsigned)strtoul(v, NULL, 10); }
    else if (v && strcmp(argv[i], "--threads") == 0) { opt.threads = (unsigned)strtoul(v, NULL, 10); }
    else if (v && strcmp(argv[i], "--seconds") == 0) { opt.seconds = strtod(v, NULL); }
    else if (v && strcmp(argv[i], "--csv") == 0) { opt.csv = v; }
    else if (v && strcmp(argv[i], "--name") == 0) { opt.name = v; }
    else if (v && strcmp(argv[i], "--others") == 0) { opt.others = v; }
    else { opt.width = 0; break; }
    i++;
  }
  bench_camera camera;
  if (!opt.model || !opt.camera || !opt.width || !opt.side || !bench_camera_read(opt.camera, &camera)) {
    fputs(USAGE, stderr);
    return 2;
  }
  for (int i = 0; i < 256; i++) {
    double v = i / 255.0;
    linear_of[i] = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
  }
  quoin_model *model = NULL;
  studio s = {0};
  if (quoin_model_new(NULL, &model) != QUOIN_OK || quoin_model_read_file(model, QUOIN_ROOT, opt.model, NULL) != QUOIN_OK ||
      quoin_scene_compile(model, NULL, &s.scene) != QUOIN_OK) {
    fprintf(stderr, "%s: not compiled\n", opt.model);
    quoin_model_free(model);
    return 3;
  }
  quoin_model_free(model);
  place_camera(&s, &camera, opt.width);
  printf("%s: %zu x %zu pixels, reference of %u samples a pixel\n", opt.name, s.how.width, s.how.height, opt.side * opt.side);
  double *right = reference(&s, opt.side);
  int ok = right && our_rows(&opt, &s, right) && (!opt.others || other_rows(&opt, &s, right));
  free(right);
  quoin_scene_free(s.scene);
  return ok ? 0 : 1;
}
