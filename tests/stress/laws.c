/* Laws that answers obey, whatever they are: random trees, bundles of rays on a lattice where faces, edges and tangencies are met; each
   trial tries one law. Prints one line, with its seed, that tools/stress adds up; a broken law is made small and written to a file.

   Usage: stress_laws [--seed S] [--seconds T | --trials N] [--leaves N] [--finds DIR] [--law NAME] [--again SEED] [--census] */
#include "laws.h"

#include <time.h>

double infinity(void) { return HUGE_VAL; }
const char *const ISA_NAMES[ISAS] = {"sse2", "avx2", "avx512"};

void blame(trial *t, const char *format, ...) {
  if (!t->wrong) {
    va_list args;
    va_start(args, format);
    vsnprintf(t->why, sizeof t->why, format, args);
    va_end(args);
    t->wrong = 1;
  }
}
void clear_text(text *t) {
  t->length = 0;
  put(t, "%s", "");
}
void put_operand(text *out, const trial *t, int k) { tree_put(out, t->tree->kid[k % t->tree->count], NULL); }

int scene_open(trial *t, const char *model, unsigned threads, scene *out) {
  *out = (scene){0};
  quoin_compile_options options = quoin_compile_options_default();
  options.threads = threads;
  quoin_status status = quoin_model_new(NULL, &out->model);
  if (status == QUOIN_OK) {
    status = quoin_model_read_text(out->model, QUOIN_ROOT, "stress", model, strlen(model), NULL);
  }
  if (status == QUOIN_OK) {
    status = quoin_scene_compile(out->model, &options, &out->scene);
  }
  if (status == QUOIN_OK) {
    status = quoin_work_new(out->scene, &out->work);
  }
  if (status != QUOIN_OK) {
    blame(t, "a model is refused: %s", quoin_status_text(status));
    scene_close(out);
    return 0;
  }
  return 1;
}
void scene_close(scene *s) {
  quoin_work_free(s->work);
  quoin_scene_free(s->scene);
  quoin_model_free(s->model);
  *s = (scene){0};
}

void keep(said *to, quoin_status status, const quoin_intervals *got) {
  *to = (said){.status = status};
  if (status != QUOIN_OK) {
    return;
  }
  to->n = got->count, to->boundary = got->boundary_count;
  for (size_t i = 0; i < got->count && 2 * i + 1 < ENDS; i++) {
    to->end[2 * i] = got->inside[i].enter, to->end[2 * i + 1] = got->inside[i].leave;
  }
  for (size_t i = 0; i < got->boundary_count && 2 * i + 1 < ENDS; i++) {
    to->side[2 * i] = got->boundary[i].enter, to->side[2 * i + 1] = got->boundary[i].leave;
  }
}
void ask_one(const scene *s, const quoin_ray *ray, said *out) {
  quoin_intervals got;
  quoin_status status = quoin_ray_intervals(s->scene, s->work, ray, QUOIN_WANT_BOUNDARY, &got);
  keep(out, status, &got);
}

static int same_ends(size_t n, const quoin_end *a, const quoin_end *b, int parts) {
  for (size_t i = 0; i < 2 * n && i < ENDS; i++) {
    if (memcmp(&a[i].t, &b[i].t, sizeof a[i].t) != 0 || (a[i].part == QUOIN_NO_PART) != (b[i].part == QUOIN_NO_PART) ||
        (parts && (a[i].part != b[i].part || a[i].role != b[i].role))) {
      return 0;
    }
  }
  return 1;
}
static void put_said(text *out, const said *s) {
  put(out, "%s:", quoin_status_text(s->status));
  for (size_t i = 0; i < 2 * s->n && i < ENDS; i++) {
    put(out, " %.17g(%d,%d)", s->end[i].t, (int)s->end[i].part, (int)s->end[i].role);
  }
  put(out, " ; boundary");
  for (size_t i = 0; i < 2 * s->boundary && i < ENDS; i++) {
    put(out, " %.17g", s->side[i].t);
  }
}
int alike(trial *t, const said *a, const said *b, int parts, const char *what, const quoin_ray *ray) {
  t->checks++;
  if (a->status == b->status && a->n == b->n && a->boundary == b->boundary && same_ends(a->n, a->end, b->end, parts) && same_ends(a->boundary, a->side, b->side, parts)) {
    return 1;
  }
  text x = {0}, y = {0};
  put_said(&x, a);
  put_said(&y, b);
  blame(t, "%s: ray %.17g %.17g %.17g  %.17g %.17g %.17g  from %.17g to %.17g\n//   %s\n//   %s", what, ray->o[0], ray->o[1], ray->o[2], ray->d[0], ray->d[1], ray->d[2], ray->from, ray->to, x.at,
        y.at);
  free(x.at);
  free(y.at);
  return 0;
}

/* --- rays ------------------------------------------------------------------------------------------------------------ */

static void a_ray(dice *d, quoin_ray *r) {
  *r = (quoin_ray){.from = -infinity(), .to = infinity()};
  do {
    for (int i = 0; i < 3; i++) {
      r->o[i] = chance(d, 60) ? from_to(d, -3, 3) : chance(d, 60) ? 0.5 * from_to(d, -8, 8) : ldexp(from_to(d, -4000, 4000), -10);
      r->d[i] = chance(d, 40) ? 0 : chance(d, 70) ? from_to(d, -2, 2) : ldexp(from_to(d, -4000, 4000), -10);
    }
  } while (r->d[0] == 0 && r->d[1] == 0 && r->d[2] == 0);
  double back = chance(d, 60) ? 0.25 * from_to(d, 0, 80) : chance(d, 50) ? 0 : ldexp(1, from_to(d, 5, 20)); /* 2^20 keeps all numbers doubles */
  for (int i = 0; i < 3; i++) {
    r->o[i] -= back * r->d[i];
  }
}
static const char *const BUNDLE_NAMES[] = {"any", "parallel", "from one place", "one ray", "grid", "near"};
static size_t some_rays(dice *d, quoin_ray *rays, int *kind) {
  size_t n = chance(d, 60) ? RAYS : (size_t)from_to(d, 1, RAYS);
  *kind = roll(d, 6);
  quoin_ray first;
  a_ray(d, &first);
  double step = ldexp(1, -from_to(d, 0, 6)), tiny = ldexp(1, -from_to(d, 20, 45));
  for (size_t k = 0; k < n; k++) {
    rays[k] = first;
    for (int i = 0; i < 3; i++) {
      switch (*kind) {
      case 1: rays[k].o[i] += step * from_to(d, -8, 8); break;
      case 2: rays[k].d[i] += step / 4 * from_to(d, -2, 2); break;
      case 4: rays[k].o[i] += step * (i == 0 ? (double)(k % 8) : i == 1 ? (double)(k / 8) : 0); break;
      case 5: rays[k].o[i] += tiny * from_to(d, -1, 1); break;
      default: break;
      }
    }
    if (*kind == 0) {
      a_ray(d, &rays[k]);
    }
    if (rays[k].d[0] == 0 && rays[k].d[1] == 0 && rays[k].d[2] == 0) {
      rays[k] = first;
    }
  }
  int range = roll(d, 4);
  for (size_t k = 0; k < n && range; k++) {
    rays[k].from = range == 1 ? 0 : 0.25 * from_to(d, -40, 40);
    rays[k].to = range == 3 ? rays[k].from + 0.25 * from_to(d, 0, 40) : infinity();
  }
  return n;
}

/* --- trials ---------------------------------------------------------------------------------------------------------- */

static int fails(const law *l, const trial *like, const tree *model, size_t n, const quoin_ray *rays, trial *out) {
  *out = (trial){.tree = model, .n = n, .rays = rays, .seed = like->seed};
  l->run(out);
  if (!out->wrong) {
    free(out->first.at);
    free(out->second.at);
  }
  return out->wrong;
}
/* Cuts tree and rays down while the law stays broken; then writes the file. */
static void report(const law *l, const trial *broken, uint64_t seed, const char *folder, const char *options) {
  tree *model = tree_copy(broken->tree);
  quoin_ray rays[RAYS];
  size_t n = broken->n;
  memcpy(rays, broken->rays, n * sizeof *rays);
  trial t;
  const time_t end = time(NULL) + 30;
  for (size_t half = n / 2; half > 0; half /= 2) {
    for (size_t i = 0; i + half <= n && n > half && time(NULL) < end;) {
      quoin_ray fewer[RAYS];
      memcpy(fewer, rays, i * sizeof *rays);
      memcpy(fewer + i, rays + i + half, (n - i - half) * sizeof *rays);
      if (fails(l, broken, model, n - half, fewer, &t)) {
        free(t.first.at);
        free(t.second.at);
        n -= half;
        memcpy(rays, fewer, n * sizeof *rays);
      } else {
        i += half;
      }
    }
  }
  for (int again = 1; again && time(NULL) < end;) {
    again = 0;
    for (int node = 0; node < tree_size(model) && !again; node++) {
      for (int cut = 0; cut < 25 && !again && time(NULL) < end; cut++) {
        tree *less = tree_copy(model);
        if (tree_cut(less, node, cut) && fails(l, broken, less, n, rays, &t)) {
          free(t.first.at);
          free(t.second.at);
          tree_free(model);
          model = less;
          again = 1;
        } else {
          tree_free(less);
        }
      }
    }
  }
  if (!fails(l, broken, model, n, rays, &t)) {
    t = *broken;
  }
  char path[600], name[100];
  snprintf(name, sizeof name, "%s", l->name);
  for (char *c = name; *c; c++) {
    *c = *c == ' ' ? '_' : *c;
  }
  snprintf(path, sizeof path, "%s/law_%s_%llu.csg", folder, name, (unsigned long long)seed);
  FILE *f = fopen(path, "w");
  for (int k = 0; k < 2; k++) {
    FILE *to = k ? stderr : f;
    if (to) {
      fprintf(to, "// the law of %s is broken\n// %s\n// again: stress_laws %s --again %llu\n", l->name, t.why, options, (unsigned long long)seed);
      for (size_t i = 0; i < n; i++) {
        const quoin_ray *r = &rays[i];
        fprintf(to, "// ray %.17g %.17g %.17g  %.17g %.17g %.17g  from %.17g to %.17g\n", r->o[0], r->o[1], r->o[2], r->d[0], r->d[1], r->d[2], r->from, r->to);
      }
      fprintf(to, "%s", t.first.at ? t.first.at : "");
      if (t.second.at && t.second.length) {
        fprintf(to, "// the other model:\n/*\n%s*/\n", t.second.at);
      }
    }
  }
  if (f) {
    fclose(f);
  }
  fprintf(stderr, "%s\n", path);
}

typedef struct totals { uint64_t trials, rays, checks, wrong, by_law[64]; } totals;

static const law *law_number(size_t k) {
  if (k < SAME_ANSWER_COUNT) {
    return &SAME_ANSWER_LAWS[k];
  }
  k -= SAME_ANSWER_COUNT;
  return k < SET_COUNT ? &SET_LAWS[k] : &PLACE_LAWS[k - SET_COUNT];
}

static void one(uint64_t seed, int leaves, const char *only, const char *folder, const char *options, totals *sum) {
  dice d = {seed};
  const size_t laws = SAME_ANSWER_COUNT + SET_COUNT + PLACE_COUNT;
  size_t number = (size_t)roll(&d, (int)laws);
  for (size_t i = 0; only && i < laws; i++) {
    number = strcmp(law_number(i)->name, only) == 0 ? i : number;
  }
  const law *l = law_number(number);
  taste s = {.irrational = chance(&d, 25) ? 30 : 0, .super = l->super && chance(&d, 25) ? 30 : 0};
  tree *root = tree_new(TREE_UNION);
  root->count = 3;
  int most = chance(&d, 70) ? 6 : chance(&d, 70) ? 20 : leaves;
  for (int i = 0; i < 3; i++) {
    int n = from_to(&d, 1, most < leaves ? most : leaves) / 3;
    root->kid[i] = a_tree(&d, &s, n > 0 ? n : 1, from_to(&d, 1, 11));
  }
  quoin_ray rays[RAYS];
  int kind;
  size_t n = some_rays(&d, rays, &kind);
  trial t = {.tree = root, .n = n, .rays = rays, .seed = dice_next(&d)};
  l->run(&t);
  sum->trials++, sum->rays += t.asked, sum->checks += t.checks, sum->by_law[number]++;
  if (t.wrong) {
    sum->wrong++;
    fprintf(stderr, "BROKEN: %s, rays: %s: --again %llu: %s\n", l->name, BUNDLE_NAMES[kind], (unsigned long long)seed, t.why);
    if (sum->wrong <= 3) {
      report(l, &t, seed, folder, options);
    }
  }
  free(t.first.at);
  free(t.second.at);
  tree_free(root);
}

static double now(void) {
  struct timespec ts;
  clock_gettime(CLOCK_MONOTONIC, &ts);
  return (double)ts.tv_sec + 1e-9 * (double)ts.tv_nsec;
}

int main(int argc, char **argv) {
  uint64_t seed = 1, again = 0;
  double seconds = 5;
  long trials = 0;
  int leaves = 60, census = 0, once = 0;
  const char *folder = ".", *only = NULL;
  for (int i = 1; i < argc; i++) {
    const char *a = argv[i];
    if (strcmp(a, "--census") == 0) {
      census = 1;
      continue;
    }
    if (i + 1 >= argc) {
      fprintf(stderr, "unknown option, or its value is missing: %s\n", a);
      return 2;
    }
    const char *v = argv[++i];
    if (strcmp(a, "--seed") == 0) seed = strtoull(v, NULL, 10);
    else if (strcmp(a, "--seconds") == 0) seconds = atof(v);
    else if (strcmp(a, "--trials") == 0) trials = atol(v);
    else if (strcmp(a, "--leaves") == 0) leaves = atoi(v);
    else if (strcmp(a, "--finds") == 0) folder = v;
    else if (strcmp(a, "--law") == 0) only = v;
    else if (strcmp(a, "--again") == 0) again = strtoull(v, NULL, 10), once = 1;
    else {
      fprintf(stderr, "unknown option %s\n", a);
      return 2;
    }
  }
  char options[200];
  snprintf(options, sizeof options, "--leaves %d%s%s%s", leaves, only ? " --law '" : "", only ? only : "", only ? "'" : "");
  totals sum = {0};
  if (once) {
    one(again, leaves, only, folder, options, &sum);
    fprintf(stderr, "%llu checks, %llu broken\n", (unsigned long long)sum.checks, (unsigned long long)sum.wrong);
    return sum.wrong != 0;
  }
  dice mix = {seed + 7};
  dice seeds = {dice_next(&mix)}; /* far apart in one sequence: neighbours must not share trials */
  const double begin = now();
  for (long k = 0; (trials ? k < trials : now() - begin < seconds) && sum.wrong < 10; k++) {
    one(dice_next(&seeds), leaves, only, folder, options, &sum);
  }
  printf("laws seed=%llu seconds=%.1f trials=%llu rays=%llu checks=%llu wrong=%llu\n", (unsigned long long)seed, now() - begin, (unsigned long long)sum.trials, (unsigned long long)sum.rays,
         (unsigned long long)sum.checks, (unsigned long long)sum.wrong);
  for (size_t i = 0; census && i < SAME_ANSWER_COUNT + SET_COUNT + PLACE_COUNT; i++) {
    printf("%8llu %s\n", (unsigned long long)sum.by_law[i], law_number(i)->name);
  }
  return sum.wrong != 0;
}
