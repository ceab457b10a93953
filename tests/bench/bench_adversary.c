/* Trees made to hurt: what a ray through them costs, beside what solving just the leaves that it meets would cost.

   heap       n overlapping solids minus n overlapping ones; heap-wide: less overlapping, heap-box: turned boxes
   alternate  differences and unions by turns, n deep, one solid a level; alternate-4: four a level
   meets      intersections and unions by turns, n deep
   chain      a solid minus n ones, one difference in another: from the left
   nest       from the right: a - (b - (c - ...)), n deep
   flush      a row of n boxes of many lengths with one face in one plane, and rays in that plane: their answers are boundary, and are not judged here

   Answers are judged by a plain evaluation that shares no code with the library: every leaf solved in long doubles, the tree
   evaluated between every two ends. */
#include "grid.h"
#include "ray/scratch.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char USAGE[] =
    "usage: bench_adversary [options]\n"
    "  --only A,B      only these families\n"
    "  --rays N        rays; default 200\n"
    "  --seconds S     of each measurement; default 0.3\n"
    "  --only-ask A    first, all or solve: nothing else is measured (for profiles)\n"
    "  --csv FILE      appends rows: family,leaves,bytes_a_leaf,compile_s,met,solved_first,solved_all,solve_ns,first_ns,first_times,all_ns,all_times,wrong,judged\n"
    "  --judge N       rays judged; default 40\n"
    "  --tiny          small sizes, and no times: bytes and leaves solved must keep their limits (for tests)\n"
    "Times are nanoseconds of processor time a ray, on one thread: `solve` is the time to solve the leaves that a ray meets, and no others. `x` are\n"
    "ratios to it. The three are measured in turn over the same rays; medians of the turns. Exit status 1: a wrong answer, or a limit passed.\n";

/* --- a tree of one's own ----------------------------------------------------------------------------------------------- */

enum { OP_UNION, OP_DIFFERENCE, OP_MEET, LEAF };
typedef struct node { uint32_t parent; uint8_t op, first; } node; /* prefix order; first: the first child of its parent */
typedef struct ball { double c[3], r; int box; double m[3][3]; } ball; /* a ball; or a box of half-size r, turned by m */

typedef struct tree {
  node *nodes;
  ball *balls; /* by node */
  size_t count, capacity;
  quoin_model *model;
  quoin_node *made; /* by node */
} tree;

static void must(int good) {
  if (!good) {
    fputs("bench_adversary: out of memory, or a call failed\n", stderr);
    exit(2);
  }
}

static uint32_t add(tree *t, uint32_t parent, uint8_t op, const ball *b) {
  if (t->count == t->capacity) {
    t->capacity = t->capacity ? 2 * t->capacity : 1024;
    t->nodes = realloc(t->nodes, t->capacity * sizeof *t->nodes);
    t->balls = realloc(t->balls, t->capacity * sizeof *t->balls);
    t->made = realloc(t->made, t->capacity * sizeof *t->made);
    must(t->nodes && t->balls && t->made);
  }
  uint32_t at = (uint32_t)t->count++;
  t->nodes[at] = (node){parent, op, 1};
  for (uint32_t i = at; i-- > parent + 1 && parent != UINT32_MAX;) {
    if (t->nodes[i].parent == parent) {
      t->nodes[at].first = 0;
      break;
    }
  }
  quoin_node under = parent == UINT32_MAX ? QUOIN_ROOT : t->made[parent], in;
  quoin_status s;
  if (op != LEAF) {
    s = quoin_add_boolean(t->model, under, op == OP_UNION ? QUOIN_UNION : op == OP_MEET ? QUOIN_INTERSECTION : QUOIN_DIFFERENCE, &t->made[at]);
  } else if (!b->box) {
    s = quoin_add_translate(t->model, under, b->c, &in);
    s = s == QUOIN_OK ? quoin_add_sphere(t->model, in, b->r, &t->made[at]) : s;
    t->balls[at] = *b;
  } else {
    const double size[3] = {2 * b->r, 2 * b->r, 2 * b->r};
    double m[12];
    for (int i = 0; i < 3; i++) {
      memcpy(m + 4 * i, b->m[i], sizeof b->m[i]);
      m[4 * i + 3] = b->c[i];
    }
    s = quoin_add_multmatrix(t->model, under, m, &in);
    s = s == QUOIN_OK ? quoin_add_cube(t->model, in, size, 1, &t->made[at]) : s;
    t->balls[at] = *b;
  }
  must(s == QUOIN_OK);
  return at;
}

static void random_leaf(tree *t, uint32_t parent, uint64_t *g, double spread, double low, double high, int box) {
  ball b = {.r = bench_between(g, low, high), .box = box};
  for (int i = 0; i < 3; i++) {
    b.c[i] = bench_between(g, -spread, spread);
  }
  double a = bench_between(g, 0, 6.28), c = bench_between(g, 0, 6.28);
  double x[3][3] = {{cos(a), -sin(a), 0}, {sin(a) * cos(c), cos(a) * cos(c), -sin(c)}, {sin(a) * sin(c), cos(a) * sin(c), cos(c)}};
  memcpy(b.m, x, sizeof x);
  add(t, parent, LEAF, &b);
}

typedef struct family { const char *name; void (*make)(tree *t, uint64_t *g, size_t n); size_t n, tiny; int flush; } family;

static void heap(tree *t, uint64_t *g, size_t n, double spread, double low, double high, int box) {
  uint32_t root = add(t, UINT32_MAX, OP_DIFFERENCE, NULL);
  for (int side = 0; side < 2; side++) {
    uint32_t all = add(t, root, OP_UNION, NULL);
    for (size_t i = 0; i < n; i++) {
      random_leaf(t, all, g, spread, low, high, box);
    }
  }
}
static void heap_close(tree *t, uint64_t *g, size_t n) { heap(t, g, n, 60, 30, 50, 0); }
static void heap_wide(tree *t, uint64_t *g, size_t n) { heap(t, g, n, 60, 5, 15, 0); }
static void heap_box(tree *t, uint64_t *g, size_t n) { heap(t, g, n, 60, 20, 40, 1); }

static void levels(tree *t, uint64_t *g, size_t n, uint8_t even, uint8_t odd, int each, int last) {
  uint32_t up = UINT32_MAX;
  for (size_t i = 0; i < n; i++) {
    up = add(t, up, i % 2 ? odd : even, NULL);
    for (int k = 0; k < each && !last; k++) {
      random_leaf(t, up, g, 20, 20, 60, 0);
    }
    if (i + 1 == n) {
      random_leaf(t, up, g, 20, 20, 60, 0);
    }
  }
}
static void alternate(tree *t, uint64_t *g, size_t n) { levels(t, g, n, OP_DIFFERENCE, OP_UNION, 1, 0); }
static void alternate_4(tree *t, uint64_t *g, size_t n) { levels(t, g, n, OP_DIFFERENCE, OP_UNION, 4, 0); }
static void meets(tree *t, uint64_t *g, size_t n) { levels(t, g, n, OP_MEET, OP_UNION, 1, 0); }
static void nest(tree *t, uint64_t *g, size_t n) { levels(t, g, n, OP_DIFFERENCE, OP_DIFFERENCE, 1, 0); }
static void chain(tree *t, uint64_t *g, size_t n) {
  uint32_t up = UINT32_MAX, *all = malloc(n * sizeof *all);
  must(all != NULL);
  for (size_t i = 0; i < n; i++) {
    up = all[i] = add(t, up, OP_DIFFERENCE, NULL);
  }
  ball b = {.r = 100};
  add(t, up, LEAF, &b);
  for (size_t i = n; i-- > 0;) {
    random_leaf(t, all[i], g, 80, 5, 15, 0);
    t->nodes[t->count - 1].first = 0;
  }
  free(all);
}

static void flush(tree *t, uint64_t *g, size_t n) { /* all of them hold 0 < x < r in their lower halves, y = 0 is their face */
  const double plain_axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  uint32_t all = add(t, UINT32_MAX, OP_UNION, NULL);
  for (size_t i = 0; i < n; i++) {
    double size = floor(bench_between(g, 8, 40));
    ball b = {.c = {floor(bench_between(g, -40, 40)), size, 0}, .r = size, .box = 1};
    memcpy(b.m, plain_axes, sizeof b.m);
    add(t, all, LEAF, &b);
  }
}

static const family FAMILIES[] = {{"heap", heap_close, 1000, 60, 0},     {"heap-wide", heap_wide, 1000, 60, 0},     {"heap-box", heap_box, 1000, 40, 0},
                                  {"alternate", alternate, 100, 100, 0}, {"alternate-4", alternate_4, 100, 100, 0}, {"meets", meets, 100, 100, 0},
                                  {"chain", chain, 10000, 1000, 0},      {"nest", nest, 120, 120, 0},               {"nest-long", nest, 10000, 1000, 0},
                                  {"flush", flush, 1000, 100, 1}};
enum { FAMILY_COUNT = sizeof FAMILIES / sizeof *FAMILIES };

/* --- the plain evaluation ---------------------------------------------------------------------------------------------- */

typedef struct stretch { long double a, b; } stretch;

static stretch solve_plain(const ball *s, const quoin_ray *ray) {
  long double o[3], d[3], low = -INFINITY, high = INFINITY;
  for (int i = 0; i < 3; i++) {
    o[i] = (long double)ray->o[i] - s->c[i], d[i] = ray->d[i];
  }
  if (!s->box) {
    long double a = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], h = (o[0] * d[0] + o[1] * d[1] + o[2] * d[2]) / a;
    long double p = 0;
    for (int i = 0; i < 3; i++) {
      long double x = o[i] - h * d[i];
      p += x * x;
    }
    long double disc = ((long double)s->r * s->r - p) / a;
    return disc > 0 ? (stretch){-h - sqrtl(disc), -h + sqrtl(disc)} : (stretch){1, 0};
  }
  for (int k = 0; k < 3; k++) { /* columns of m are the box's axes, of unit length but for their rounding: m is solved for, by Cramer */
    const double (*m)[3] = s->m;
    long double n[3] = {(long double)m[1][(k + 1) % 3] * m[2][(k + 2) % 3] - (long double)m[2][(k + 1) % 3] * m[1][(k + 2) % 3],
                        (long double)m[2][(k + 1) % 3] * m[0][(k + 2) % 3] - (long double)m[0][(k + 1) % 3] * m[2][(k + 2) % 3],
                        (long double)m[0][(k + 1) % 3] * m[1][(k + 2) % 3] - (long double)m[1][(k + 1) % 3] * m[0][(k + 2) % 3]};
    long double det = n[0] * m[0][k] + n[1] * m[1][k] + n[2] * m[2][k];
    long double at = (n[0] * o[0] + n[1] * o[1] + n[2] * o[2]) / det, way = (n[0] * d[0] + n[1] * d[1] + n[2] * d[2]) / det;
    long double x = (-s->r - at) / way, y = (s->r - at) / way;
    low = fmaxl(low, fminl(x, y)), high = fminl(high, fmaxl(x, y));
  }
  return (stretch){low, high};
}

static int by_place(const void *x, const void *y) {
  long double a = *(const long double *)x, b = *(const long double *)y;
  return (a > b) - (a < b);
}

/* Stretches inside along the whole line; their number. value: room for a byte a node. */
static size_t plain(const tree *t, const quoin_ray *ray, stretch *spans, long double *ends, uint8_t *value, stretch *out) {
  size_t n = 0, count = 0;
  for (size_t i = 0; i < t->count; i++) {
    if (t->nodes[i].op == LEAF) {
      spans[i] = solve_plain(&t->balls[i], ray);
      if (spans[i].a < spans[i].b) {
        ends[n++] = spans[i].a, ends[n++] = spans[i].b;
      }
    }
  }
  qsort(ends, n, sizeof *ends, by_place);
  int was = 0;
  for (size_t e = 0; e < n; e++) {
    int now = 0;
    if (e + 1 < n) {
      long double at = (ends[e] + ends[e + 1]) / 2;
      for (size_t i = 0; i < t->count; i++) {
        value[i] = t->nodes[i].op == LEAF ? spans[i].a < at && at < spans[i].b : t->nodes[i].op != OP_UNION;
      }
      for (size_t i = t->count; i-- > 1;) {
        uint32_t up = t->nodes[i].parent;
        uint8_t v = t->nodes[up].op == OP_DIFFERENCE && !t->nodes[i].first ? !value[i] : value[i];
        value[up] = t->nodes[up].op == OP_UNION ? value[up] | v : value[up] & v;
      }
      now = value[0];
    }
    if (now && !was) {
      out[count].a = ends[e];
    } else if (!now && was) {
      out[count++].b = ends[e];
    }
    was = now;
  }
  return count;
}

static int same(long double want, double got) {
  return fabsl(want - got) <= 1e-9L * fmaxl(1, fabsl(want));
}

/* --- measuring --------------------------------------------------------------------------------------------------------- */

typedef struct met { uint32_t *leaves; size_t count; } met;

static quoin_ray random_ray(uint64_t *g, int in_face) {
  quoin_ray ray = {.from = 0, .to = INFINITY};
  if (in_face) {
    quoin_ray along = {{-400, 0, floor(bench_between(g, -30, 30)) + 0.5}, {400 + bench_between(g, -40, 40), 0, bench_between(g, -40, 40)}, 0, INFINITY};
    return along;
  }
  double z = bench_between(g, -1, 1), p = bench_between(g, 0, 6.283185307179586), q = sqrt(1 - z * z);
  const double from[3] = {400 * q * cos(p), 400 * q * sin(p), 400 * z};
  for (int i = 0; i < 3; i++) {
    ray.o[i] = from[i];
    ray.d[i] = (bench_between(g, -40, 40) - from[i]) / 400;
  }
  return ray;
}

static size_t wrong_answers(const tree *t, const quoin_scene *scene, quoin_work *work, const quoin_ray *rays, size_t n) {
  size_t wrong = 0;
  stretch *spans = malloc(t->count * sizeof *spans), *out = malloc(t->count * sizeof *out);
  long double *ends = malloc(2 * t->count * sizeof *ends);
  uint8_t *value = malloc(t->count);
  must(spans && out && ends && value);
  for (size_t r = 0; r < n; r++) {
    size_t count = plain(t, &rays[r], spans, ends, value, out);
    quoin_intervals got;
    quoin_hit hit;
    must(quoin_ray_intervals(scene, work, &rays[r], 0, &got) == QUOIN_OK);
    int good = got.count == count;
    for (size_t i = 0; good && i < count; i++) {
      good = same(out[i].a, got.inside[i].enter.t) && same(out[i].b, got.inside[i].leave.t);
    }
    must(quoin_first_hit(scene, work, &rays[r], &hit) == QUOIN_OK);
    good = good && hit.found == (count > 0) && (!hit.found || same(out[0].a, hit.t));
    wrong += !good;
  }
  free(spans), free(out), free(ends), free(value);
  return wrong;
}

typedef struct bundled { quoin_interval *all; size_t count, capacity, firsts[17]; } bundled;
static int keep(void *user, size_t i, const quoin_intervals *answer) {
  bundled *b = user;
  for (size_t k = 0; k < answer->count && b->count < b->capacity; k++) {
    b->all[b->count++] = answer->inside[k];
  }
  b->firsts[i + 1] = b->count;
  return 0;
}

/* Rays beside one another, together and one by one: the same bytes. */
static size_t wrong_bundles(const quoin_scene *scene, quoin_work *work, const quoin_ray *rays, size_t n, uint64_t *g) {
  size_t wrong = 0;
  bundled b = {.capacity = 16 * scene->leaf_count + 16};
  b.all = malloc(b.capacity * sizeof *b.all);
  must(b.all != NULL);
  for (size_t r = 0; r < n; r++) {
    quoin_ray beside[16];
    quoin_hit hits[16], hit;
    for (int i = 0; i < 16; i++) {
      beside[i] = rays[r];
      for (int k = 0; k < 3; k++) {
        beside[i].o[k] += bench_between(g, -1, 1);
      }
    }
    b.count = 0;
    must(quoin_ray_intervals_many(scene, work, 16, beside, 0, keep, &b) == QUOIN_OK);
    must(quoin_first_hits(scene, work, 16, beside, hits) == QUOIN_OK);
    for (size_t i = 0; i < 16; i++) {
      quoin_intervals got;
      must(quoin_ray_intervals(scene, work, &beside[i], 0, &got) == QUOIN_OK);
      int good = got.count == b.firsts[i + 1] - b.firsts[i];
      for (size_t k = 0; good && k < got.count; k++) {
        const quoin_interval *x = &b.all[b.firsts[i] + k], *y = &got.inside[k];
        good = x->enter.t == y->enter.t && x->leave.t == y->leave.t && x->enter.part == y->enter.part && x->leave.part == y->leave.part;
      }
      must(quoin_first_hit(scene, work, &beside[i], &hit) == QUOIN_OK);
      good = good && hit.found == hits[i].found && (!hit.found || (hit.t == hits[i].t && hit.part == hits[i].part));
      good = good && hit.found == (got.count > 0) && (!hit.found || hit.t == got.inside[0].enter.t);
      wrong += !good;
    }
  }
  free(b.all);
  return wrong;
}

static int wanted(const char *only, const char *name) {
  size_t n = strlen(name);
  for (const char *at = only; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
    if (strncmp(at, name, n) == 0 && (at[n] == ',' || at[n] == 0)) {
      return 1;
    }
  }
  return only == NULL;
}

typedef struct meter { const quoin_scene *scene; quoin_work *work; qn_scratch *scratch; const quoin_ray *rays; const met *met; } meter;

static void solve_met(const meter *m, size_t r) {
  qn_line line;
  qn_scratch_begin(m->scratch);
  qn_line_from_doubles(m->rays[r].o, m->rays[r].d, &line);
  qn_solve_begin(m->scratch, &line);
  for (size_t i = 0; i < m->met[r].count; i++) {
    const qn_span *spans;
    int vague;
    (void)qn_leaf_spans(m->scratch, m->met[r].leaves[i], 0, &spans, &vague);
  }
}
static void ask_first(const meter *m, size_t r) {
  quoin_hit hit;
  must(quoin_first_hit(m->scene, m->work, &m->rays[r], &hit) == QUOIN_OK);
}
static void ask_intervals(const meter *m, size_t r) {
  quoin_intervals got;
  must(quoin_ray_intervals(m->scene, m->work, &m->rays[r], 0, &got) == QUOIN_OK);
}

static double processor_now(void) { /* seconds of this thread: others on the machine count less */
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

enum { SOLVE, FIRST, ALL, WAYS, TURNS = 15 };
static const char *const WAY_NAMES[WAYS] = {"solve", "first", "all"};
static void (*const WAY[WAYS])(const meter *m, size_t r) = {solve_met, ask_first, ask_intervals};

static int by_size(const void *x, const void *y) {
  double a = *(const double *)x, b = *(const double *)y;
  return (a > b) - (a < b);
}
static double median(double v[TURNS]) {
  qsort(v, TURNS, sizeof *v, by_size);
  return v[TURNS / 2];
}

typedef struct times { double ns[WAYS], ratio[WAYS]; } times; /* ratio: to SOLVE */

/* In each turn every way asks all rays as often as fills its share of the time. */
static times measure(const meter *m, size_t n, double seconds, const char *only) {
  double ns[WAYS][TURNS] = {{0}}, ratio[WAYS][TURNS] = {{0}};
  times out;
  for (int turn = -1; turn < TURNS; turn++) { /* the first warms up */
    for (int w = 0; w < WAYS; w++) {
      double begin = processor_now(), now = begin;
      size_t done = 0;
      while (!(only && strcmp(only, WAY_NAMES[w]) != 0) && (done == 0 || now - begin < seconds / TURNS)) {
        for (size_t r = 0; r < n; r++) {
          WAY[w](m, r);
        }
        done += n;
        now = processor_now();
      }
      if (turn >= 0) {
        ns[w][turn] = done ? (now - begin) * 1e9 / (double)done : NAN;
        ratio[w][turn] = ns[w][turn] / ns[SOLVE][turn];
      }
    }
  }
  for (int w = 0; w < WAYS; w++) {
    out.ns[w] = median(ns[w]), out.ratio[w] = median(ratio[w]);
  }
  return out;
}

static uint64_t leaves_of(quoin_work *work) {
  quoin_stats s;
  quoin_work_stats(work, &s);
  return s.leaves;
}

typedef struct options { const char *only, *ask, *csv; size_t rays, judge; double seconds; int tiny; } options;

static int run(const family *f, const options *opt) {
  const size_t rays_wanted = opt->rays;
  const int tiny = opt->tiny;
  uint64_t g = 20261122;
  tree t = {0};
  quoin_scene *scene;
  quoin_work *work;
  qn_scratch *scratch = NULL;
  must(quoin_model_new(NULL, &t.model) == QUOIN_OK);
  f->make(&t, &g, tiny ? f->tiny : f->n);
  quoin_compile_options how = {.threads = 1};
  double begin = bench_now();
  must(quoin_scene_compile(t.model, &how, &scene) == QUOIN_OK);
  double compile = bench_now() - begin;
  must(quoin_work_new(scene, &work) == QUOIN_OK && qn_scratch_new(scene, &scratch) == QUOIN_OK);
  quoin_scene_info info;
  quoin_scene_get_info(scene, &info);

  quoin_ray *rays = malloc(rays_wanted * sizeof *rays);
  met *all = calloc(rays_wanted, sizeof *all);
  must(rays && all);
  size_t met_leaves = 0;
  meter m = {scene, work, scratch, rays, all};
  for (size_t r = 0; r < rays_wanted; r++) {
    rays[r] = random_ray(&g, f->flush);
    all[r].leaves = malloc(scene->leaf_count * sizeof *all[r].leaves);
    must(all[r].leaves != NULL);
    qn_line line;
    qn_scratch_begin(scratch);
    qn_line_from_doubles(rays[r].o, rays[r].d, &line);
    qn_solve_begin(scratch, &line);
    for (uint32_t i = 0; i < scene->leaf_count; i++) {
      const qn_span *spans;
      int vague;
      if (qn_leaf_spans(scratch, i, 0, &spans, &vague) > 0) {
        all[r].leaves[all[r].count++] = i;
      }
    }
    met_leaves += all[r].count;
  }
  size_t judged = opt->judge < rays_wanted ? opt->judge : rays_wanted;
  size_t wrong = (f->flush ? 0 : wrong_answers(&t, scene, work, rays, judged)) + wrong_bundles(scene, work, rays, judged, &g);
  double per_leaf = (double)info.memory / (double)(info.leaves ? info.leaves : 1), per_ray = (double)met_leaves / (double)rays_wanted;
  uint64_t before = leaves_of(work);
  for (size_t r = 0; r < rays_wanted; r++) {
    ask_first(&m, r);
  }
  uint64_t middle = leaves_of(work);
  for (size_t r = 0; r < rays_wanted; r++) {
    ask_intervals(&m, r);
  }
  double first_leaves = (double)(middle - before) / (double)rays_wanted, all_leaves = (double)(leaves_of(work) - middle) / (double)rays_wanted;
  printf("%-12s %7zu %8.0f %7.2f %8.1f %9.1f %9.1f", f->name, info.leaves, per_leaf, compile * 1e3, per_ray, first_leaves, all_leaves);
  int good = wrong == 0;
  if (!tiny) {
    times got = measure(&m, rays_wanted, opt->seconds, opt->ask);
    printf(" %9.0f %9.0f %6.2f %9.0f %6.2f", got.ns[SOLVE], got.ns[FIRST], got.ratio[FIRST], got.ns[ALL], got.ratio[ALL]);
    FILE *csv = opt->csv ? fopen(opt->csv, "a") : NULL;
    must(!opt->csv || csv);
    if (csv) {
      fprintf(csv, "%s,%zu,%.0f,%.6f,%.2f,%.2f,%.2f,%.0f,%.0f,%.3f,%.0f,%.3f,%zu,%zu\n", f->name, info.leaves, per_leaf, compile, per_ray, first_leaves, all_leaves,
              got.ns[SOLVE], got.ns[FIRST], got.ratio[FIRST], got.ns[ALL], got.ratio[ALL], wrong, judged);
      must(fclose(csv) == 0);
    }
  } else { /* counts do not depend on the machine */
    good = good && per_leaf < 4096 && first_leaves <= 4 * per_ray + 8 && all_leaves <= 4 * per_ray + 8;
  }
  printf("  %zu/%zu%s\n", wrong, judged, wrong ? " WRONG" : good ? "" : " OVER");
  fflush(stdout);
  for (size_t r = 0; r < rays_wanted; r++) {
    free(all[r].leaves);
  }
  free(rays), free(all), free(t.nodes), free(t.balls), free(t.made);
  qn_scratch_free(scratch);
  quoin_work_free(work);
  quoin_scene_free(scene);
  quoin_model_free(t.model);
  return good;
}

int main(int argc, char **argv) {
  options opt = {.rays = 200, .judge = 40, .seconds = 0.3};
  int good = 1;
  for (int i = 1; i < argc; i++) {
    const char *v = i + 1 < argc ? argv[i + 1] : NULL;
    if (strcmp(argv[i], "--tiny") == 0) {
      opt.tiny = 1;
    } else if (v && strcmp(argv[i], "--only") == 0) {
      opt.only = v, i++;
    } else if (v && strcmp(argv[i], "--only-ask") == 0) {
      opt.ask = v, i++;
    } else if (v && strcmp(argv[i], "--csv") == 0) {
      opt.csv = v, i++;
    } else if (v && strcmp(argv[i], "--rays") == 0) {
      opt.rays = strtoul(v, NULL, 10), i++;
    } else if (v && strcmp(argv[i], "--judge") == 0) {
      opt.judge = strtoul(v, NULL, 10), i++;
    } else if (v && strcmp(argv[i], "--seconds") == 0) {
      opt.seconds = strtod(v, NULL), i++;
    } else {
      fputs(USAGE, stderr);
      return 2;
    }
  }
  if (opt.rays < 1) {
    fputs(USAGE, stderr);
    return 2;
  }
  printf("%-12s %7s %8s %7s %8s %9s %9s", "family", "leaves", "bytes/lf", "ms", "met/ray", "solved1", "solved");
  printf(opt.tiny ? "  wrong\n" : " %9s %9s %6s %9s %6s  wrong\n", "solve", "first", "x", "all", "x");
  for (size_t i = 0; i < FAMILY_COUNT; i++) {
    if (wanted(opt.only, FAMILIES[i].name)) {
      good &= run(&FAMILIES[i], &opt);
    }
  }
  return !good;
}
