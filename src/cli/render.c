/* quoin render: a picture of a model. */
#include "cli/commands.h"
#include "cli/load.h"
#include "cli/say.h"
#include "cli/stats.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

enum { OUTPUT = CLI_OWN, IMGSIZE, CAMERA, PROJECTION, FOV, NO_ANTIALIAS, SAMPLES, NO_SHADOWS, PROGRESS };

static const cli_option options[] = {
  {OUTPUT, 'o', "output", "FILE", "the PNG file to write, whole or not at all; - is standard output"},
  {IMGSIZE, 0, "imgsize", "W,H", "the picture's size in pixels, 800,600 unless given"},
  {CAMERA, 0, "camera", "EX,EY,EZ,CX,CY,CZ", "look from the eye E to the point C, z up"},
  {PROJECTION, 0, "projection", "ortho|persp", "parallel or perspective, the default"},
  {FOV, 0, "fov", "DEG", "the vertical field of view in degrees, above 0 and below 180"},
  {NO_ANTIALIAS, 0, "no-antialias", NULL, "one sample a pixel"},
  {SAMPLES, 0, "samples", "N", "samples of a pixel at an edge: 1, 4, 9, 16 (the default), 25, ... 256"},
  {NO_SHADOWS, 0, "no-shadows", NULL, "lights cast no shadows"},
  {PROGRESS, 0, "progress", NULL, "show progress if standard error is a terminal"},
  CLI_SNAP_OPTION,
  CLI_COMMON_OPTIONS,
};

typedef struct job {
  const char *output;
  quoin_render_options options;
  int has_camera, has_projection, has_fov, progress;
  double camera[6], fov;
  quoin_projection projection;
  int shown; /* the percentage on the terminal */
} job;

static int take_size(job *j, const char *value) {
  /* A row of a PNG, and all of it in memory, are bounded by this. */
  enum { MOST = 32768 };
  unsigned long size[2] = {0, 0};
  const char *at = value;
  int good = 1;
  for (int i = 0; i < 2 && good; i++) {
    size_t digits = strspn(at, "0123456789");
    good = digits > 0 && digits < 7;
    size[i] = good ? strtoul(at, NULL, 10) : 0;
    at += digits;
    good = good && size[i] >= 1 && size[i] <= MOST && (i ? *at == '\0' : *at == ',' || *at == 'x');
    at += i == 0 && *at;
  }
  if (!good) {
    cli_quoted q;
    cli_error("%s is not a value for --imgsize; give width,height, each from 1 to %d", cli_quote(&q, value), MOST);
    return -1;
  }
  j->options.width = size[0];
  j->options.height = size[1];
  return 0;
}

static int take(void *user, int id, const char *value) {
  job *j = user;
  cli_quoted q;
  switch (id) {
  case OUTPUT: j->output = value; return 0;
  case IMGSIZE: return take_size(j, value);
  case CAMERA:
    j->has_camera = 1;
    if (cli_take_numbers("camera", value, 6, j->camera)) {
      return -1;
    }
    if (j->camera[0] == j->camera[3] && j->camera[1] == j->camera[4] && j->camera[2] == j->camera[5]) {
      cli_error("%s is not a value for --camera; the eye and the point it looks at are the same", cli_quote(&q, value));
      return -1;
    }
    return 0;
  case PROJECTION:
    j->has_projection = 1;
    if (strcmp(value, "ortho") == 0 || strcmp(value, "o") == 0) {
      j->projection = QUOIN_ORTHOGRAPHIC;
    } else if (strcmp(value, "persp") == 0 || strcmp(value, "p") == 0) {
      j->projection = QUOIN_PERSPECTIVE;
    } else {
      cli_error("%s is not a value for --projection; give ortho or persp", cli_quote(&q, value));
      return -1;
    }
    return 0;
  case FOV:
    j->has_fov = 1;
    if (cli_take_numbers("fov", value, 1, &j->fov)) {
      return -1;
    }
    if (!(j->fov > 0 && j->fov < 180)) {
      cli_error("%s is not a value for --fov; give degrees above 0 and below 180", cli_quote(&q, value));
      return -1;
    }
    return 0;
  case NO_ANTIALIAS: j->options.antialias = 0; return 0;
  case SAMPLES: {
    unsigned n, root = 1;
    if (cli_take_unsigned("samples", value, 1, 256, &n)) {
      return -1;
    }
    while (root * root < n) {
      root++;
    }
    if (root * root != n) {
      cli_error("%s is not a value for --samples; give a square number, for instance %u", cli_quote(&q, value), root * root);
      return -1;
    }
    j->options.samples = n;
    return 0;
  }
  case NO_SHADOWS: j->options.shadows = 0; return 0;
  case PROGRESS: j->progress = 1; return 0;
  default: return -1;
  }
}

/* The camera of --camera, --projection and --fov; without --camera the other two frame the solid anew. */
static void set_camera(job *j, const quoin_scene *scene) {
  if (!j->has_camera && !j->has_projection && !j->has_fov) {
    return; /* the model's, or the default view */
  }
  quoin_camera *camera = &j->options.camera;
  j->options.has_camera = 1;
  quoin_camera_fit(scene, (double)j->options.width / (double)j->options.height, j->projection, j->has_fov ? j->fov : 0, camera);
  if (j->has_camera) {
    memcpy(camera->eye, j->camera, sizeof camera->eye);
    memcpy(camera->look, j->camera + 3, sizeof camera->look);
    int vertical = camera->eye[0] == camera->look[0] && camera->eye[1] == camera->look[1];
    const double up[3] = {0, vertical, !vertical}; /* looking straight down or up, y is up in the picture */
    memcpy(camera->up, up, sizeof up);
    camera->near = 0;
  }
}

static int report(void *user, double done) {
  job *j = user;
  int percent = (int)(100 * done);
  if (percent != j->shown) {
    j->shown = percent;
    fprintf(stderr, "\rrendering %3d%%", percent);
    (void)fflush(stderr);
  }
  return 0;
}

/* A picture of the background alone is seldom what was meant. */
static void say_nothing_seen(const job *j, const quoin_scene *scene, const char *path) {
  quoin_scene_info info;
  quoin_scene_get_info(scene, &info);
  const char *elsewhere = j->options.has_camera ? "look from elsewhere, or leave --camera out" : "look from elsewhere with --camera";
  cli_say_diag(&(quoin_diag){.severity = QUOIN_WARNING,
                             .code = "Q1006",
                             .file = path,
                             .problem = "nothing is in view",
                             .reason = info.empty ? "the solid is empty" : "no ray of the camera meets the solid",
                             .way_out = info.empty ? "" : elsewhere,
                             .source = ""});
}

static int render(job *j, const cli_common *common, cli_loaded *loaded, const char *path, cli_stats *figures) {
  const quoin_scene *scene = loaded->scene;
  cli_why why;
  size_t row = 4 * j->options.width;
  unsigned char *pixels = cli_memory_take(&loaded->memory, row * j->options.height);
  if (!pixels) {
    cli_error("no picture of %zu x %zu: %s", j->options.width, j->options.height, cli_memory_status(&loaded->memory, QUOIN_E_MEMORY, &why));
    return CLI_IO;
  }
  int show = j->progress && isatty(STDERR_FILENO);
  if (show) {
    j->shown = -1;
    j->options.progress = (quoin_progress){report, j};
  }
  set_camera(j, scene);
  j->options.threads = common->threads;
  double start = cli_clock();
  quoin_render_stats stats;
  memset(&stats, 0, sizeof stats);
  quoin_status status = quoin_render(scene, &j->options, pixels, row, &stats);
  double middle = cli_clock();
  if (show) {
    fputs("\r               \r", stderr);
  }
  int code = cli_code(status);
  if (status == QUOIN_OK && stats.hits == 0 && !common->quiet) {
    say_nothing_seen(j, scene, path);
  }
  if (status != QUOIN_OK) {
    cli_error("cannot render: %s", cli_memory_status(&loaded->memory, status, &why));
  } else {
    errno = 0;
    status = quoin_write_png(j->output, j->options.width, j->options.height, pixels, row);
    int system_error = errno, to_stdout = strcmp(j->output, "-") == 0;
    if (status != QUOIN_OK && !(to_stdout && system_error == EPIPE)) {
      cli_quoted q;
      cli_error("cannot write %s: %s", to_stdout ? "standard output" : cli_quote(&q, j->output),
                status == QUOIN_E_IO && system_error ? strerror(system_error) : quoin_status_text(status));
    }
    code = cli_code(status);
    if (to_stdout && code == CLI_OK && close(STDOUT_FILENO) && errno != EINTR) {
      cli_error("cannot write standard output: %s", strerror(errno));
      code = CLI_IO;
    }
  }
  cli_memory_free(&loaded->memory, pixels, row * j->options.height);
  if (common->stats) {
    cli_stats_seconds(figures, "render_seconds", middle - start);
    cli_stats_seconds(figures, "write_seconds", cli_clock() - middle);
    cli_stats_count(figures, "camera_rays", stats.camera_rays);
    cli_stats_count(figures, "camera_hits", stats.hits);
    cli_stats_count(figures, "shadow_rays", stats.shadow_rays);
    cli_stats_count(figures, "refined_pixels", stats.refined_pixels);
    cli_stats_work(figures, &stats.work);
  }
  return code;
}

/* Whether both names are of one regular file; - is none. */
static int is_one_file(const char *a, const char *b) {
  struct stat x, y;
  return strcmp(a, "-") != 0 && strcmp(b, "-") != 0 && stat(a, &x) == 0 && stat(b, &y) == 0 && S_ISREG(x.st_mode) && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

/* Does the path's suffix say another kind of file than PNG? */
static int other_kind(const char *path) {
  static const char *const kinds[] = {"3mf", "amf", "bmp", "csg", "dxf", "gif", "jpeg", "jpg",  "obj", "off",
                                      "pdf", "pgm", "ppm", "scad", "stl", "svg", "tif", "tiff", "webp"};
  const char *slash = strrchr(path, '/'), *suffix = strrchr(slash ? slash : path, '.');
  for (size_t i = 0; suffix && i < sizeof kinds / sizeof *kinds; i++) {
    if (strcasecmp(suffix + 1, kinds[i]) == 0) {
      return 1;
    }
  }
  return 0;
}

static int run(const cli_command *self, int argc, char **argv) {
  job j = {.options = quoin_render_options_default(), .projection = QUOIN_PERSPECTIVE};
  cli_common common;
  int code = cli_parse(self, argc, argv, &common, take, &j);
  if (code >= 0) {
    return code;
  }
  const char *path = cli_model_operand(self, &common);
  if (!path) {
    return CLI_USAGE;
  }
  if (common.operand_count > 1) {
    cli_quoted q;
    cli_error("one MODEL at a time: %s is one too many", cli_quote(&q, common.operands[1]));
    return cli_try_help(self);
  }
  if (!j.output) {
    cli_error("no file to write to; add -o OUT.png");
    return cli_try_help(self);
  }
  if (is_one_file(j.output, path)) {
    cli_quoted q;
    cli_error("the picture would replace its own model %s; give another file to -o", cli_quote(&q, path));
    return cli_try_help(self);
  }
  if (other_kind(j.output)) {
    cli_quoted q;
    cli_error("%s does not name a PNG file, and no other is written; give -o a name that ends in .png", cli_quote(&q, j.output));
    return cli_try_help(self);
  }
  cli_loaded loaded;
  code = cli_load(&common, path, 1, &loaded);
  cli_stats figures = {0};
  cli_stats_load(&figures, &loaded);
  if (code == CLI_OK) {
    code = render(&j, &common, &loaded, path, &figures);
  }
  if (common.stats) {
    cli_stats_say(&figures);
  }
  cli_text_free(&figures.text);
  cli_unload(&loaded);
  return code;
}

const cli_command cli_render_command = {
  "render",
  "MODEL -o OUT.png",
  "Draw a model as a PNG picture.",
  "Without --camera the picture is taken by the model's own camera(), else from a point that frames the whole solid; so it is\n"
  "when only --projection or --fov is given. Curved surfaces are exact: there are no facets and no $fn is needed.\n"
  "Pixels next to another surface or another light get more samples. The picture does not depend on --threads.\n",
  options,
  run,
};
