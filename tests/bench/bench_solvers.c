/* Ways to solve a quadric along a line: what each costs and how wrong it is, family by family. */
#include "grid.h"
#include "solvers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char USAGE[] =
    "usage: bench_solvers [--cases N] [--seconds S] [--csv FILE]\n"
    "  --cases N     of each family; default 1200\n"
    "  --seconds S   of timing for each way and family; default 0.05\n"
    "  --csv FILE    rows: family,way,ns,median_ulps,largest_ulps,wrong_counts_per_million,wrong_orders_per_million,cases,orders,exact_share\n";

typedef struct cases {
  size_t n;
  solver_case *all;
  prepared *solids, *partners;
  truth *truths, *partner_truths;
  library *lib;
} cases;

/* --- the ways -------------------------------------------------------------------------------------------------------- */

static solved_roots run_world(cases *c, size_t i) { return solve_world(&c->solids[i], c->all[i].o, c->all[i].d); }
static solved_roots run_textbook(cases *c, size_t i) { return solve_textbook(&c->solids[i], c->all[i].o, c->all[i].d); }
static solved_roots run_stable(cases *c, size_t i) { return solve_stable(&c->solids[i], c->all[i].o, c->all[i].d); }
static solved_roots run_shifted(cases *c, size_t i) { return solve_shifted(&c->solids[i], c->all[i].o, c->all[i].d); }
static solved_roots run_dd(cases *c, size_t i) { return solve_dd(&c->solids[i], c->all[i].o, c->all[i].d); }
static solved_roots run_decided(cases *c, size_t i) { return library_solve(c->lib, i, 0, 0); }
static solved_roots run_rounded(cases *c, size_t i) { return library_solve(c->lib, i, 1, 0); }
static solved_roots run_exact(cases *c, size_t i) { return library_solve(c->lib, i, 1, 1); }

typedef struct way {
  const char *name;
  solved_roots (*run)(cases *c, size_t i);
  solve_fn partner; /* null: the library compares */
  int exact;
} way;

static const way WAYS[] = {
  {"world-space Q", run_world, solve_world, 0},
  {"textbook, local", run_textbook, solve_textbook, 0},
  {"stable, local", run_stable, solve_stable, 0},
  {"origin shift", run_shifted, solve_shifted, 0},
  {"double-double", run_dd, solve_dd, 0},
  {"quoin, decided", run_decided, NULL, 0},
  {"quoin, rounded", run_rounded, NULL, 0},
  {"always exact", run_exact, NULL, 1},
};
enum { WAY_COUNT = sizeof WAYS / sizeof *WAYS };

/* The order of the first roots, 2 when one of the solids has none by this way. */
static int order_by(cases *c, const way *w, size_t i) {
  if (!w->partner) {
    return library_order(c->lib, i, w->exact);
  }
  solved_roots a = w->run(c, i), b = w->partner(&c->partners[i], c->all[i].o, c->all[i].d);
  if (!a.count || !b.count) {
    return 2;
  }
  return a.t[0] != b.t[0] ? (a.t[0] > b.t[0]) - (a.t[0] < b.t[0]) : (a.rest[0] > b.rest[0]) - (a.rest[0] < b.rest[0]);
}

/* --- one family ------------------------------------------------------------------------------------------------------ */

static int make_cases(const family *f, size_t n, cases *c) {
  memset(c, 0, sizeof *c);
  c->all = calloc(n, sizeof *c->all);
  c->solids = calloc(n, sizeof *c->solids);
  c->partners = calloc(n, sizeof *c->partners);
  c->truths = calloc(n, sizeof *c->truths);
  c->partner_truths = calloc(n, sizeof *c->partner_truths);
  if (!c->all || !c->solids || !c->partners || !c->truths || !c->partner_truths) {
    return 0;
  }
  uint64_t state = 20260202;
  for (size_t i = 0; i < n; i++, c->n++) {
    solver_case *one = &c->all[i];
    int tries = 0;
    while (!f->make(&state, (int)(i % KINDS), one)) {
      if (++tries > 100000) {
        fprintf(stderr, "%s: no cases of kind %d\n", f->name, (int)(i % KINDS));
        return 0;
      }
    }
    prepare(&one->solid, &c->solids[i]);
    prepare(&one->partner, &c->partners[i]);
    truth_init(&c->truths[i]);
    truth_init(&c->partner_truths[i]);
    truth_of(&one->solid, one->o, one->d, &c->truths[i]);
    truth_of(&one->partner, one->o, one->d, &c->partner_truths[i]);
  }
  c->lib = library_new(n, c->all);
  return c->lib != NULL;
}

static void free_cases(cases *c) {
  for (size_t i = 0; i < c->n; i++) {
    truth_clear(&c->truths[i]);
    truth_clear(&c->partner_truths[i]);
  }
  library_free(c->lib);
  free(c->all);
  free(c->solids);
  free(c->partners);
  free(c->truths);
  free(c->partner_truths);
}

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

typedef struct row { double ns, median, largest, wrong_counts, wrong_orders, exact_share; size_t orders; } row;

static double volatile sink;

static double time_of(cases *c, const way *w, double seconds) {
  double best = INFINITY, begin = bench_now();
  do {
    double from = bench_now(), sum = 0;
    size_t done = 0;
    do {
      for (size_t i = 0; i < c->n; i++) {
        solved_roots r = w->run(c, i);
        sum += r.t[0] + r.t[1];
      }
      done += c->n;
    } while (bench_now() - from < seconds / 5);
    sink = sum;
    best = fmin(best, (bench_now() - from) / (double)done);
  } while (bench_now() - begin < seconds);
  return best * 1e9;
}

static int measure(cases *c, const way *w, double seconds, row *out) {
  double *errors = malloc(2 * c->n * sizeof *errors), exact_solved = 0, exact_rounded = 0;
  size_t count = 0, wrong = 0, wrong_orders = 0;
  if (!errors) {
    return 0;
  }
  *out = (row){0};
  library_exact(c->lib, &exact_solved, &exact_rounded);
  for (size_t i = 0; i < c->n; i++) {
    const truth *t = &c->truths[i];
    solved_roots r = w->run(c, i);
    if (r.count != t->count) {
      wrong++;
    } else {
      for (int k = 0; k < t->count && (k == 0 || t->count == 2); k++) {
        errors[count++] = truth_ulps(t, k, r.t[k]);
      }
    }
  }
  library_exact(c->lib, &exact_solved, &exact_rounded);
  out->exact_share = w->partner ? 0 : exact_solved / (double)c->n;
  for (size_t i = 0; i < c->n; i++) {
    if (c->truths[i].count == 2 && c->partner_truths[i].count == 2) {
      out->orders++;
      wrong_orders += order_by(c, w, i) != truth_order(&c->truths[i], &c->partner_truths[i]);
    }
  }
  qsort(errors, count, sizeof *errors, by_size);
  out->median = count ? errors[count / 2] : NAN;
  out->largest = count ? errors[count - 1] : NAN;
  out->wrong_counts = 1e6 * (double)wrong / (double)c->n;
  out->wrong_orders = out->orders ? 1e6 * (double)wrong_orders / (double)out->orders : NAN;
  free(errors);
  out->ns = time_of(c, w, seconds);
  return 1;
}

int main(int argc, char **argv) {
  size_t n = 1200;
  double seconds = 0.05;
  const char *csv = NULL;
  for (int i = 1; i < argc; i += 2) {
    const char *v = i + 1 < argc ? argv[i + 1] : NULL;
    if (v && strcmp(argv[i], "--cases") == 0) { n = strtoul(v, NULL, 10); }
    else if (v && strcmp(argv[i], "--seconds") == 0) { seconds = strtod(v, NULL); }
    else if (v && strcmp(argv[i], "--csv") == 0) { csv = v; }
    else {
      fputs(USAGE, stderr);
      return 2;
    }
  }
  FILE *f = csv ? fopen(csv, "w") : NULL;
  if (csv && !f) {
    perror(csv);
    return 1;
  }
  if (f) {
    fputs("family,way,ns,median_ulps,largest_ulps,wrong_counts_per_million,wrong_orders_per_million,cases,orders,exact_share\n", f);
  }
  int right = 1;
  for (size_t k = 0; k < FAMILY_COUNT; k++) {
    cases c;
    if (!make_cases(&FAMILIES[k], n, &c)) {
      return 1;
    }
    printf("%-26s %9s %10s %10s %12s %12s %7s\n", FAMILIES[k].name, "ns", "median", "largest", "counts/1e6", "orders/1e6", "exact");
    for (size_t w = 0; w < WAY_COUNT; w++) {
      row r;
      if (!measure(&c, &WAYS[w], seconds, &r)) {
        return 1;
      }
      int ours = !WAYS[w].partner;
      /* What the library promises: every count and order right, every reported root correctly rounded. */
      int kept = !ours || (r.wrong_counts == 0 && !(r.wrong_orders > 0) && (WAYS[w].run == run_decided || !(r.largest > 0.5)));
      right &= kept;
      printf("  %-24s %9.1f %10.3g %10.3g %12.0f %12.0f %7.3g%s\n", WAYS[w].name, kept ? r.ns : NAN, r.median, r.largest, r.wrong_counts, r.wrong_orders,
             r.exact_share, kept ? "" : "  WRONG");
      if (f) {
        fprintf(f, "\"%s\",\"%s\",%.4g,%.4g,%.4g,%.0f,%.0f,%zu,%zu,%.4g\n", FAMILIES[k].name, WAYS[w].name, kept ? r.ns : NAN, r.median, r.largest,
                r.wrong_counts, r.wrong_orders, n, r.orders, r.exact_share);
      }
    }
    fflush(stdout);
    free_cases(&c);
  }
  if (f) {
    fclose(f);
  }
  mpfr_free_cache();
  return right ? 0 : 1;
}
