/* Rays a second through the library, one row for each path, and whether the answers are right.

   A path is first judged: on some blocks its answers must be the same bytes as those of the other paths with the same question, and on some
   rays the same as the oracle's (exact, by other code). A path that answers wrongly gets no time. */
#include "flat.h"
#include "oracle.h"
#include "paths.h"
#ifdef BENCH_CLOCKED
#include "exact_clock.h"
#endif

#include <inttypes.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char USAGE[] =
    "usage: bench_scenes MODEL.csg CAMERA [options]\n"
    "  --paths A,B     only these (single rows tiles grid-t grid intervals-single intervals grid-intervals intervals-exact shadow-single shadow\n"
    "                  random-single random random-all-single random-all spots-single spots random-spots-single random-spots\n"
    "                  blocked-single blocked points-single points);\n"
    "                  default all\n"
    "  --size N        the grid is N x N; default the camera file's\n"
    "  --seconds S     time for each path and round; default 0.3\n"
    "  --rounds N      rounds, of which the median is given; default 3\n"
    "  --threads N     default 1\n"
    "  --build-threads N   for the compilation; default 1, 0 all\n"
    "  --oracle N      rays judged by the oracle; default 100; 0 none. It reads MODEL.flat beside MODEL.csg\n"
    "  --judge 0       nothing is judged: for further rounds\n"
    "  --csv FILE      appends rows: scene,path,threads,isa,rays,seconds,Mrays_s,judged,wrong,oracle_judged,oracle_wrong,nodes,leaves,sure,\n"
    "                  exact_signs,exact_orders,exact_rays,exact_roundings (the last seven a ray),read_s,compile_s,leaves_kept,bytes;\n"
    "                  bench_exact adds the shares of the time spent in exact arithmetic, in rays and points answered one\n"
    "                  by one, and how many leaves a camera ray meets\n"
    "  --depths FILE   writes the first hits' parameters (doubles, row-major; infinite: none) of the whole grid\n"
    "  --name NAME     the scene's name in the rows\n";

enum { MOST_STRETCHES = 1024 }; /* of a ray that the oracle judges */

typedef struct options {
  const char *model, *camera, *csv, *depths, *name, *paths;
  unsigned size, threads, build_threads, rounds, judge;
  double seconds;
  size_t oracle;
} options;

typedef struct bench {
  options opt;
  bench_camera camera;
  path_job job;
  flat_scene flat;
  oracle *oracle;
  double read_s, compile_s;
  quoin_scene_info info;
  size_t judged_blocks; /* of each path */
} bench;

typedef struct verdict { size_t judged, wrong, oracle_judged, oracle_wrong; } verdict;

/* --- the order of blocks: every place alike when a path has no time for all ---------------------------------------------------- */

static size_t *shuffled(size_t n, uint64_t seed) {
  size_t *order = malloc((n + 1) * sizeof *order);
  for (size_t i = 0; order && i < n; i++) {
    size_t j = (size_t)(bench_u64(&seed) % (i + 1));
    order[i] = order[j];
    order[j] = i;
  }
  return order;
}

/* --- judging --------------------------------------------------------------------------------------------------------- */

/* What the oracle says of one ray or point of a judged block. */
typedef struct sample { size_t block, place; uint64_t places; double t; uint32_t count; } sample;

/* For one question about some rays: answers of the first path that was asked, which others must equal, and the oracle's. */
typedef struct reference {
  path_answer *answers; /* of `blocks` blocks */
  size_t blocks;
  sample *samples;
  size_t sample_count;
} reference;

/* What the oracle says of ray k in lane->asked, or point k of the block; 0 when it does not judge it. */
static int ask_oracle(bench *b, const path *p, const path_lane *lane, size_t block, size_t k, sample *out) {
  if (p->question == ASK_SIDES) {
    int side = oracle_point(b->oracle, b->job.lists.points + 3 * (block * BLOCK + k));
    out->place = k;
    out->places = (uint64_t)side;
    out->t = 0;
    out->count = 1;
    return side >= 0;
  }
  static oracle_interval found[MOST_STRETCHES];
  int zero; /* the directions of rays with the filter off are multiples of the camera's, and their answers are scaled back */
  const double *d = p->rays == RAYS_CAMERA ? b->camera.d : lane->asked[k].d;
  long n = oracle_ray(b->oracle, lane->asked[k].o, d, MOST_STRETCHES, found, &zero);
  out->place = lane->place[k];
  out->places = PATH_NO_PLACES;
  int first = p->question == ASK_HITS || p->question == ASK_SPOTS || p->question == ASK_BLOCKED;
  out->count = first ? n > 0 : (uint32_t)n;
  out->t = first && n > 0 ? zero ? found[0].leave : found[0].enter : INFINITY;
  if (first && n > 0) {
    path_places(&out->places, out->t);
  }
  for (long i = 0; p->question == ASK_INTERVALS && i < n && i < MOST_STRETCHES; i++) {
    path_places(&out->places, found[i].enter);
    path_places(&out->places, found[i].leave);
  }
  return n >= 0 && n <= MOST_STRETCHES;
}

/* Rays drawn from the judged blocks, until --oracle of them are there or five seconds have passed. */
static int draw_samples(bench *b, const path *p, reference *ref, path_lane *lane, const size_t *order) {
  uint64_t state = 2;
  double begin = bench_now();
  ref->samples = calloc(b->opt.oracle + 1, sizeof *ref->samples);
  for (size_t s = 0; ref->samples && b->oracle && s < b->opt.oracle && bench_now() - begin < 5; s++) {
    sample *one = &ref->samples[ref->sample_count];
    one->block = bench_u64(&state) % ref->blocks;
    path_answer again[BLOCK];
    lane->answers = again;
    size_t count = p->block(&b->job, lane, order[one->block]); /* fills lane->asked again */
    lane->answers = NULL;
    ref->sample_count += (size_t)ask_oracle(b, p, lane, order[one->block], bench_u64(&state) % count, one);
  }
  return ref->samples != NULL;
}

/* Whether an answer is what the oracle says. */
static int agrees(const path *p, const path_answer *a, const sample *s) {
  if (p->question == ASK_BLOCKED) { /* no ray of the lists starts inside */
    return a->count == s->count;
  }
  if (p->near) {
    return a->count == s->count && (s->count == 0 || fabs(a->t - s->t) <= PATH_NEAR * fmax(1, fabs(s->t)));
  }
  return a->count == s->count && a->places == s->places;
}

/* hits: what the first hits of the same rays are, by another call, or null. */
static int judge(bench *b, const path *p, reference *ref, const reference *hits, path_lane *lane, verdict *out) {
  size_t blocks = path_blocks(p, &b->job), n = blocks < b->judged_blocks ? blocks : b->judged_blocks;
  n = ref->answers ? ref->blocks : n;
  size_t *order = shuffled(blocks, 1);
  path_answer *answers = calloc(n + 1, BLOCK * sizeof *answers);
  memset(out, 0, sizeof *out);
  if (!order || !answers) {
    return 0;
  }
  double begin = bench_now();
  size_t done = 0;
  for (; done < n && (done == 0 || bench_now() - begin < 3); done++) {
    lane->answers = answers + done * BLOCK;
    size_t count = p->block(&b->job, lane, order[done]);
    for (size_t k = 0; ref->answers && k < count; k++) {
      out->judged++;
      out->wrong += answers[done * BLOCK + k].hash != ref->answers[done * BLOCK + k].hash;
    }
    for (size_t k = 0; hits && done < hits->blocks && k < count; k++) {
      const path_answer *a = &answers[done * BLOCK + k], *h = &hits->answers[done * BLOCK + k];
      out->judged++;
      out->wrong += !agrees(p, a, &(sample){.places = h->places, .t = h->t, .count = h->count});
    }
  }
  lane->answers = NULL;
  int first = !ref->answers, ok = 1;
  if (first) {
    ref->answers = answers;
    ref->blocks = done;
    ok = draw_samples(b, p, ref, lane, order);
  }
  for (size_t s = 0; ok && s < ref->sample_count; s++) {
    const sample *one = &ref->samples[s];
    if (one->block < done) {
      const path_answer *a = &answers[one->block * BLOCK + one->place];
      out->oracle_judged++;
      out->oracle_wrong += !agrees(p, a, one);
    }
  }
  if (!first) {
    free(answers);
  }
  free(order);
  return ok;
}

/* --- timing ---------------------------------------------------------------------------------------------------------- */

/* All paths take turns within a round, each for a part of its time: the speed of a machine that others use changes within a second, and what is compared shall see the same of it. */
enum { TURNS = 10, MOST_ROUNDS = 64 };

/* A path and what became of it. */
typedef struct timed {
  const path *p;
  verdict v;
  size_t *order;     /* of blocks; null: it is not timed, for a wrong answer */
  size_t blocks, at; /* at: the next of them */
  double rays[MOST_ROUNDS], seconds[MOST_ROUNDS];
  quoin_stats stats;
#ifdef BENCH_CLOCKED
  exact_clock clock;
#endif
} timed;

typedef struct run {
  const bench *b;
  const timed *t;
  double until;
  atomic_size_t next;
  atomic_size_t done;
} run;
typedef struct runner { run *run; path_lane *lane; } runner;

static void *run_blocks(void *user) {
  runner *r = user;
  size_t rays = 0;
  while (bench_now() < r->run->until) {
    size_t at = atomic_fetch_add(&r->run->next, 1);
    rays += r->run->t->p->block(&r->run->b->job, r->lane, r->run->t->order[at % r->run->t->blocks]);
  }
  atomic_fetch_add(&r->run->done, rays);
  return NULL;
}

static quoin_stats stats_of(path_lane **lanes, unsigned n) {
  quoin_stats sum = {0};
  for (unsigned i = 0; i < n; i++) {
    quoin_stats s;
    quoin_work_stats(lanes[i]->work, &s);
    sum.nodes += s.nodes;
    sum.leaves += s.leaves;
    sum.filter_sure += s.filter_sure;
    sum.exact_signs += s.exact_signs;
    sum.exact_orders += s.exact_orders;
    sum.exact_rays += s.exact_rays;
    sum.exact_roundings += s.exact_roundings;
  }
  return sum;
}

#define EACH_COUNT(DO) DO(nodes) DO(leaves) DO(filter_sure) DO(exact_signs) DO(exact_orders) DO(exact_rays) DO(exact_roundings)

/* One turn of a path. */
static void take_turn(const bench *b, timed *t, path_lane **lanes, unsigned round, double seconds) {
  run shared = {.b = b, .t = t, .next = t->at};
  pthread_t threads[256];
  runner runners[256];
  const quoin_stats before = stats_of(lanes, b->opt.threads);
#ifdef BENCH_CLOCKED
  const exact_clock was = bench_exact_clock;
#endif
  const double begin = bench_now();
  shared.until = begin + seconds;
  for (unsigned i = 0; i < b->opt.threads; i++) {
    runners[i] = (runner){&shared, lanes[i]};
    if (i && pthread_create(&threads[i], NULL, run_blocks, &runners[i]) != 0) {
      abort();
    }
  }
  run_blocks(&runners[0]);
  for (unsigned i = 1; i < b->opt.threads; i++) {
    pthread_join(threads[i], NULL);
  }
  t->seconds[round] += bench_now() - begin;
  t->rays[round] += (double)shared.done;
  t->at = shared.next;
  const quoin_stats after = stats_of(lanes, b->opt.threads);
#define ADD(field) t->stats.field += after.field - before.field;
  EACH_COUNT(ADD)
#ifdef BENCH_CLOCKED
  t->clock.exact += bench_exact_clock.exact - was.exact;
  t->clock.woven += bench_exact_clock.woven - was.woven;
#endif
}

static void time_all(const bench *b, size_t n, timed times[], path_lane **lanes) {
#ifdef BENCH_CLOCKED /* of the one thread; what is made once for each surface is made before */
  for (size_t i = 0; i < n; i++) {
    const double begin = bench_now();
    for (size_t k = 0; times[i].order && k < times[i].blocks && bench_now() - begin < 10 * b->opt.seconds; k++) {
      times[i].p->block(&b->job, lanes[0], times[i].order[k]);
    }
  }
#endif
  for (unsigned round = 0; round < b->opt.rounds; round++) {
    for (unsigned turn = 0; turn < TURNS; turn++) {
      for (size_t i = 0; i < n; i++) {
        if (times[i].order && times[i].seconds[round] <= b->opt.seconds * turn / TURNS) { /* else one block took several turns */
          take_turn(b, &times[i], lanes, round, b->opt.seconds / TURNS);
        }
      }
    }
  }
}

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static int report(const bench *b, const timed *t) {
  const path *p = t->p;
  const verdict *v = &t->v;
  const int right = t->order != NULL;
  double rates[MOST_ROUNDS] = {0}, all_rays = 0;
  for (unsigned r = 0; right && r < b->opt.rounds; r++) {
    rates[r] = t->rays[r] / t->seconds[r];
    all_rays += t->rays[r];
  }
  qsort(rates, b->opt.rounds, sizeof *rates, by_size);
  double rate = right ? rates[b->opt.rounds / 2] / 1e6 : NAN, each = all_rays > 0 ? 1 / all_rays : 0;
#define PER(field) ((double)t->stats.field * each)
  char judged[64];
  snprintf(judged, sizeof judged, "%zu/%zu", v->wrong + v->oracle_wrong, v->judged + v->oracle_judged);
  if (right) {
    printf("%-17s %9.3f  %14s  %8.2f %8.2f %8.2f  %9.2g %9.2g %9.2g %9.2g\n", p->name, rate, judged, PER(nodes), PER(leaves), PER(filter_sure),
           PER(exact_signs), PER(exact_orders), PER(exact_rays), PER(exact_roundings));
  } else {
    printf("%-17s     WRONG  %14s  (oracle %zu of %zu, against the first path %zu of %zu)\n", p->name, judged, v->oracle_wrong, v->oracle_judged,
           v->wrong, v->judged);
  }
#ifdef BENCH_CLOCKED
  double spent = 0;
  for (unsigned r = 0; r < b->opt.rounds; r++) {
    spent += t->seconds[r];
  }
  const double exact = spent > 0 ? t->clock.exact / spent : NAN, woven = spent > 0 ? t->clock.woven / spent : NAN;
  printf("%-17s %9.4f %% of the time in exact arithmetic, %.4f %% in rays and points answered one by one\n", "", 100 * exact, 100 * woven);
#endif
  fflush(stdout);
  if (b->opt.csv) {
    FILE *f = fopen(b->opt.csv, "a");
    if (!f) {
      perror(b->opt.csv);
      return 0;
    }
    const char *isa = getenv("QUOIN_ISA");
    fprintf(f, "%s,%s,%u,%s,%.0f,%.4f,", b->opt.name, p->name, b->opt.threads, isa ? isa : "best", all_rays, right ? all_rays / (rate * 1e6) : NAN);
    fprintf(f, "%.5g,%zu,%zu,%zu,%zu,%.4g,%.4g,%.4g,%.3g,%.3g,%.3g,%.3g,%.4f,%.4f,%zu,%zu", rate, v->judged, v->wrong, v->oracle_judged, v->oracle_wrong,
            PER(nodes), PER(leaves), PER(filter_sure), PER(exact_signs), PER(exact_orders), PER(exact_rays), PER(exact_roundings), b->read_s, b->compile_s,
            b->info.leaves, b->info.memory);
#ifdef BENCH_CLOCKED
    fprintf(f, ",%.6g,%.6g,%.6g", exact, woven, bench_leaves_met(b->job.scene, &b->camera, 1000));
#endif
    fputc('\n', f);
    fclose(f);
  }
  return right;
}

static int right_so_far(const verdict *v) {
  return v->wrong == 0 && v->oracle_wrong == 0;
}

/* --- the program ----------------------------------------------------------------------------------------------------- */

static int wanted(const options *opt, const char *name) {
  if (!opt->paths) {
    return 1;
  }
  size_t n = strlen(name);
  for (const char *at = opt->paths; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
    if (strncmp(at, name, n) == 0 && (at[n] == ',' || at[n] == 0)) {
      return 1;
    }
  }
  return 0;
}
static int wants_rays(const options *opt, path_rays rays) {
  for (size_t i = 0; i < PATH_COUNT; i++) {
    if (PATHS[i].rays == rays && wanted(opt, PATHS[i].name)) {
      return 1;
    }
  }
  return 0;
}

static int usage(void) {
  fputs(USAGE, stderr);
  return 0;
}

static int parse(int argc, char **argv, options *opt) {
  *opt = (options){.threads = 1, .build_threads = 1, .rounds = 3, .judge = 1, .seconds = 0.3, .oracle = 100};
  for (int i = 1; i < argc; i++) {
    const char *a = argv[i], *v = i + 1 < argc ? argv[i + 1] : NULL;
    if (strncmp(a, "--", 2) != 0) {
      *(!opt->model ? &opt->model : &opt->camera) = a;
      continue;
    }
    if (!v) {
      return usage();
    }
    i++;
    if (strcmp(a, "--paths") == 0) { opt->paths = v; }
    else if (strcmp(a, "--size") == 0) { opt->size = (unsigned)strtoul(v, NULL, 10); }
    else if (strcmp(a, "--seconds") == 0) { opt->seconds = strtod(v, NULL); }
    else if (strcmp(a, "--rounds") == 0) { opt->rounds = (unsigned)strtoul(v, NULL, 10); }
    else if (strcmp(a, "--threads") == 0) { opt->threads = (unsigned)strtoul(v, NULL, 10); }
    else if (strcmp(a, "--build-threads") == 0) { opt->build_threads = (unsigned)strtoul(v, NULL, 10); }
    else if (strcmp(a, "--oracle") == 0) { opt->oracle = strtoul(v, NULL, 10); }
    else if (strcmp(a, "--judge") == 0) { opt->judge = (unsigned)strtoul(v, NULL, 10); }
    else if (strcmp(a, "--csv") == 0) { opt->csv = v; }
    else if (strcmp(a, "--depths") == 0) { opt->depths = v; }
    else if (strcmp(a, "--name") == 0) { opt->name = v; }
    else { return usage(); }
  }
  if (!opt->model || !opt->camera || opt->rounds < 1 || opt->rounds > MOST_ROUNDS || opt->threads < 1 || opt->threads > 256) {
    return usage();
  }
  if (!opt->name) {
    const char *slash = strrchr(opt->model, '/');
    opt->name = slash ? slash + 1 : opt->model;
  }
  return 1;
}

static int load(bench *b, quoin_scene **scene) {
  quoin_model *model = NULL;
  double begin = bench_now();
  if (quoin_model_new(NULL, &model) != QUOIN_OK) {
    return 0;
  }
  quoin_status status = quoin_model_read_file(model, QUOIN_ROOT, b->opt.model, NULL);
  b->read_s = bench_now() - begin;
  if (status == QUOIN_OK) {
    quoin_compile_options how = quoin_compile_options_default();
    how.threads = b->opt.build_threads;
    begin = bench_now();
    status = quoin_scene_compile(model, &how, scene);
    b->compile_s = bench_now() - begin;
  }
  if (status != QUOIN_OK) {
    fprintf(stderr, "%s: %s\n", b->opt.model, quoin_status_text(status));
    quoin_diag d;
    if (quoin_model_diag_count(model) && quoin_model_diag(model, 0, &d) == QUOIN_OK) {
      fprintf(stderr, "%u:%u: %s\n", d.line, d.column, d.problem);
    }
  }
  quoin_model_free(model);
  return status == QUOIN_OK;
}

static void load_oracle(bench *b) {
  char flat[4096];
  const char *dot = strrchr(b->opt.model, '.');
  if (b->opt.oracle && b->opt.judge && dot && snprintf(flat, sizeof flat, "%.*s.flat", (int)(dot - b->opt.model), b->opt.model) < (int)sizeof flat &&
      flat_read(flat, &b->flat)) {
    b->oracle = oracle_new(&b->flat);
  }
}

static int write_depths(bench *b, path_lane *lane) {
  size_t n = (size_t)b->camera.width * b->camera.height;
  double *all = malloc(n * sizeof *all);
  FILE *f = fopen(b->opt.depths, "wb");
  if (!all || !f) {
    return 0;
  }
  for (size_t k = 0; k < n; k++) {
    quoin_ray r = {.to = INFINITY};
    quoin_hit h;
    bench_camera_ray(&b->camera, (unsigned)(k % b->camera.width), (unsigned)(k / b->camera.width), r.o);
    memcpy(r.d, b->camera.d, sizeof r.d);
    lane->status = quoin_first_hit(b->job.scene, lane->work, &r, &h);
    all[k] = h.found ? h.t : INFINITY;
  }
  int ok = fwrite(all, sizeof *all, n, f) == n;
  free(all);
  return fclose(f) == 0 && ok && lane->status == QUOIN_OK;
}

int main(int argc, char **argv) {
  bench b = {0};
  quoin_scene *scene = NULL;
  if (!parse(argc, argv, &b.opt) || !bench_camera_read(b.opt.camera, &b.camera)) {
    return 2;
  }
  if (b.opt.size) {
    b.camera.width = b.camera.height = b.opt.size;
  }
  if (!load(&b, &scene)) {
    return 3;
  }
  quoin_scene_get_info(scene, &b.info);
  b.job.scene = scene;
  b.job.camera = &b.camera;
  b.judged_blocks = 8;
  load_oracle(&b);
  path_lane *lanes[256] = {0};
  for (unsigned i = 0; i < b.opt.threads; i++) {
    lanes[i] = path_lane_new(scene);
    if (!lanes[i]) {
      fputs("out of memory\n", stderr);
      return 1;
    }
  }
  printf("%s: %zu leaves, %zu distinct surfaces, %.1f MB, read %.3f s, compiled %.3f s, grid %ux%u, %u thread%s\n", b.opt.name, b.info.leaves,
         b.info.distinct_surfaces, (double)b.info.memory / 1e6, b.read_s, b.compile_s, b.camera.width, b.camera.height, b.opt.threads,
         b.opt.threads == 1 ? "" : "s");
  int right = 1;
  if (b.opt.depths && !write_depths(&b, lanes[0])) {
    fprintf(stderr, "%s: not written\n", b.opt.depths);
    right = 0;
  }
  printf("%-17s %9s  %14s  %8s %8s %8s  %9s %9s %9s %9s\n", "path", "M/s", "wrong/judged", "nodes", "leaves", "sure", "signs", "orders", "rays", "roundings");
  size_t list = (size_t)b.camera.width * b.camera.height < 262144 ? (size_t)b.camera.width * b.camera.height : 262144;
  if (!path_lists_make(&b.job, lanes[0], list, wants_rays(&b.opt, RAYS_SHADOW), wants_rays(&b.opt, RAYS_RANDOM), wants_rays(&b.opt, RAYS_POINTS))) {
    fputs("out of memory\n", stderr);
    return 1;
  }
  static reference references[RAY_KINDS][QUESTIONS]; /* by rays and question */
  timed *times = calloc(PATH_COUNT, sizeof *times);
  size_t count = 0;
  for (size_t i = 0; i < PATH_COUNT; i++) {
    if (!wanted(&b.opt, PATHS[i].name) || path_blocks(&PATHS[i], &b.job) == 0) {
      continue;
    }
    reference *of_rays = references[PATHS[i].rays];
    const reference *hits = (PATHS[i].question == ASK_SPOTS || PATHS[i].question == ASK_BLOCKED) && of_rays[ASK_HITS].answers ? &of_rays[ASK_HITS] : NULL;
    timed *t = times ? &times[count++] : NULL;
    if (!t || (b.opt.judge && !judge(&b, &PATHS[i], &of_rays[PATHS[i].question], hits, lanes[0], &t->v))) {
      fputs("out of memory\n", stderr);
      return 1;
    }
    t->p = &PATHS[i];
    t->blocks = path_blocks(&PATHS[i], &b.job);
    t->order = right_so_far(&t->v) ? shuffled(t->blocks, 1) : NULL;
  }
  time_all(&b, count, times, lanes);
  for (size_t i = 0; i < count; i++) {
    right &= report(&b, &times[i]);
    free(times[i].order);
  }
  free(times);
  for (unsigned i = 0; i < b.opt.threads; i++) {
    if (lanes[i]->status != QUOIN_OK) {
      fprintf(stderr, "a call failed: %s\n", quoin_status_text(lanes[i]->status));
      right = 0;
    }
    path_lane_free(lanes[i]);
  }
  for (int i = 0; i < RAY_KINDS; i++) {
    for (int j = 0; j < QUESTIONS; j++) {
      free(references[i][j].answers);
      free(references[i][j].samples);
    }
  }
  path_lists_free(&b.job);
  oracle_free(b.oracle);
  flat_free(&b.flat);
  quoin_scene_free(scene);
  return right ? 0 : 1;
}
