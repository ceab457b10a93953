/* All stretches of rays in packets against the woven path: every answer must be the woven path's to the last byte, ends, parts, surfaces and
   stretches in the boundary, on every instruction set this machine runs, in packets of any size, be the rays alike or not.

   Run with a number for more: query_test_sheaf [models [seed]]. Prints how many rays packets gave up. */
#include "ask.h"
#include "query/look.h"
#include "query/sheaf.h"
#include "share.h"

#include "packet_cases.h"

static size_t model_count = 250;
static uint64_t first_seed = 0x9e3779b97f4a7c15u;
static const char *isas[3];
static size_t isa_count, failures;
enum { failures_shown = 3, MOST = 600 };

static void find_isas(void) {
  static const char *const names[3] = {"sse2", "avx2", "avx512"};
  for (size_t i = 0; i < 3; i++) {
    setenv("QUOIN_ISA", names[i], 1);
    if (strcmp(qn_wide_pick()->name, names[i]) == 0) {
      isas[isa_count++] = names[i];
    }
  }
  unsetenv("QUOIN_ISA");
}

/* A work that takes the k-th of them. */
static quoin_work *work_on(size_t k, const quoin_scene *scene) {
  quoin_work *work;
  setenv("QUOIN_ISA", isas[k], 1);
  assert_int_equal(quoin_work_new(scene, &work), QUOIN_OK);
  unsetenv("QUOIN_ISA");
  return work;
}

/* A ray's answer by the woven path alone. */
typedef struct truth {
  quoin_status status;
  size_t count, boundary_count;
  quoin_interval inside[MOST], boundary[MOST];
} truth;

static void copy(size_t n, const quoin_interval *from, quoin_interval *to) { /* from may be null when n is 0 */
  for (size_t i = 0; i < n; i++) {
    to[i] = from[i];
  }
}

static void weave_ray(const ask *a, const quoin_ray *ray, truth *out) {
  quoin_intervals v;
  *out = (truth){.status = quoin_ray_intervals(a->scene, a->work, ray, QUOIN_WANT_BOUNDARY, &v)};
  if (out->status == QUOIN_OK) {
    assert_true(v.count <= MOST && v.boundary_count <= MOST);
    out->count = v.count, out->boundary_count = v.boundary_count;
    copy(v.count, v.inside, out->inside);
    copy(v.boundary_count, v.boundary, out->boundary);
  }
}

static int same_end(const quoin_end *x, const quoin_end *y) { return memcmp(&x->t, &y->t, sizeof x->t) == 0 && x->part == y->part && x->role == y->role; }
static int same(size_t n, const quoin_interval *x, size_t m, const quoin_interval *y) {
  int all = n == m;
  for (size_t i = 0; i < n && all; i++) {
    all = same_end(&x[i].enter, &y[i].enter) && same_end(&x[i].leave, &y[i].leave);
  }
  return all;
}

static size_t merged_lanes[4];
typedef struct share { uint64_t rays, unsure, stretches, cut; } share;
static share by_model[MODELS], by_bundle[BUNDLES];

static void show(const char *what, size_t n, const quoin_interval *v) {
  printf("%s %zu:", what, n);
  for (size_t i = 0; i < n; i++) {
    printf(" [%.17g (%u %u), %.17g (%u %u)]", v[i].enter.t, v[i].enter.part, v[i].enter.role, v[i].leave.t, v[i].leave.part, v[i].leave.role);
  }
  printf("\n");
}

static void blame(const char *text, const char *isa, int model, int bundle, const quoin_ray *ray, const truth *want, size_t n, const quoin_interval *got) {
  if (failures++ < failures_shown) {
    printf("%s, %s, %s\n%s", isa, MODEL_NAMES[model], BUNDLE_NAMES[bundle], text);
    printf("ray {{%a, %a, %a}, {%a, %a, %a}, %a, %a}\n", ray->o[0], ray->o[1], ray->o[2], ray->d[0], ray->d[1], ray->d[2], ray->from, ray->to);
    show("woven", want->count, want->inside);
    show("packet", n, got);
  }
}

typedef struct asked {
  const char *text, *isa;
  int model, bundle;
  const quoin_ray *rays;
  const truth *want;
  size_t answers;
} asked;

static int each(void *user, size_t i, const quoin_intervals *got) {
  asked *q = user;
  const truth *w = &q->want[i];
  if (i != q->answers++ || !same(got->count, got->inside, w->count, w->inside) || !same(got->boundary_count, got->boundary, w->boundary_count, w->boundary) || got->contact_count) {
    blame(q->text, q->isa, q->model, q->bundle, &q->rays[i], w, got->count, got->inside);
  }
  return 0;
}

static truth want[QN_LANES];

/* On works that are kept: what they keep of earlier rays must not show. */
static quoin_work *works[3];
static void ask_bundle(dice *d, const ask *a, const char *text, int model, int bundle, const quoin_ray rays[QN_LANES]) {
  for (int i = 0; i < QN_LANES; i++) {
    if (!is_line(&rays[i])) {
      return;
    }
    weave_ray(a, &rays[i], &want[i]);
    if (want[i].status != QUOIN_OK) {
      return;
    }
  }
  for (size_t k = 0; k < isa_count; k++) {
    quoin_work *work = works[k];
    asked q = {text, isas[k], model, bundle, rays, want, 0};
    size_t n = roll(d, 2) ? QN_LANES : 1 + (size_t)roll(d, QN_LANES);
    assert_int_equal(quoin_ray_intervals_many(a->scene, work, n, rays, QUOIN_WANT_BOUNDARY, each, &q), QUOIN_OK);
    assert_int_equal(q.answers, n);
    /* As packets, be they alike or not. */
    size_t first = (size_t)roll(d, QN_LANES - 8), sizes[2] = {QN_LANES, 1 + (size_t)roll(d, QN_FEW)}, begins[2] = {0, first};
    for (int pass = 0; pass < 2; pass++) {
      uint64_t sure;
      assert_int_equal(qn_sheaf_rays(work, sizes[pass], rays + begins[pass], NULL, 0, NULL, NULL, &sure), QUOIN_OK);
      const qn_sheaf *s = work->sheaf;
      for (uint64_t m = s->spans.merged & sure; m; m &= m - 1) { /* lanes merged by wide code: of some ends, and of many */
        const uint32_t ends = s->spans.row_count[qn_trailing_zeros(m)];
        merged_lanes[ends < 6 ? ends / 2 : 3]++;
      }
      for (size_t g = 0; g < a->scene->program.gate_count; g++) {
        assert_int_equal(s->count[g], a->scene->program.gates[g].base);
      }
      for (size_t i = 0; i < sizes[pass]; i++) {
        const truth *w = &want[begins[pass] + i];
        share *shares[2] = {&by_model[model], &by_bundle[bundle]};
        for (int j = 0; j < 2; j++) {
          shares[j]->rays++, shares[j]->unsure += !(sure >> i & 1), shares[j]->stretches += w->count;
          shares[j]->cut += w->count && (w->inside[0].enter.part == QUOIN_NO_PART || w->inside[w->count - 1].leave.part == QUOIN_NO_PART);
        }
        const quoin_interval *got = s->found ? s->found + s->first[i] : NULL;
        if (sure >> i & 1 && (w->boundary_count || !same(s->first[i + 1] - s->first[i], got, w->count, w->inside))) {
          blame(text, isas[k], model, bundle, &rays[begins[pass] + i], w, s->first[i + 1] - s->first[i], got);
        }
      }
    }
  }
}

/* A bundle, and the same rays the other way. */
static void one_bundle(dice *d, const ask *a, const char *text, int model, int bundle, const frame *f) {
  quoin_ray rays[QN_LANES];
  fill_bundle(d, bundle, f, rays);
  ask_bundle(d, a, text, model, bundle, rays);
  for (int i = 0; i < QN_LANES; i++) {
    const quoin_ray r = rays[i];
    rays[i] = (quoin_ray){{r.o[0], r.o[1], r.o[2]}, {-r.d[0], -r.d[1], -r.d[2]}, -r.to, -r.from};
  }
  ask_bundle(d, a, text, model, bundle, rays);
}

/* The same rays as decimals of some digits: rays that are no doubles, most of them. */
static size_t decimal_rays, decimal_woven;
static void some_decimals(dice *d, const ask *a, const char *text, int model, int bundle, const frame *f) {
  static char numbers[QN_LANES][6][40];
  const char *rays[6 * QN_LANES];
  quoin_ray doubles[QN_LANES];
  fill_bundle(d, bundle, f, doubles);
  int digits = roll(d, 3) ? 3 + roll(d, 15) : 17, nudge = roll(d, 2);
  size_t n = roll(d, 2) ? QN_LANES : 1 + (size_t)roll(d, QN_LANES);
  char from[40], to[40];
  snprintf(from, sizeof from, "%.*g", digits, doubles[0].from), snprintf(to, sizeof to, "%.*g", digits, doubles[0].to);
  const char *begin = isinf(doubles[0].from) ? NULL : from, *end = isinf(doubles[0].to) ? NULL : to;
  for (size_t i = 0; i < n; i++) {
    for (int k = 0; k < 6; k++) {
      double v = k < 3 ? doubles[i].o[k] : doubles[i].d[k - 3];
      snprintf(numbers[i][k], sizeof numbers[i][k], "%.*g", digits, nudge ? v * 1.1 : v);
      rays[6 * i + (size_t)k] = numbers[i][k];
    }
    quoin_intervals v;
    want[i] = (truth){.status = quoin_ray_intervals_text(a->scene, a->work, rays + 6 * i, begin, end, QUOIN_WANT_BOUNDARY, &v)};
    if (want[i].status != QUOIN_OK) {
      return;
    }
    want[i].count = v.count, want[i].boundary_count = v.boundary_count;
    copy(v.count, v.inside, want[i].inside);
    copy(v.boundary_count, v.boundary, want[i].boundary);
  }
  for (size_t k = 0; k < isa_count; k++) {
    quoin_work *work = work_on(k, a->scene);
    asked q = {text, isas[k], model, bundle, doubles, want, 0};
    assert_int_equal(quoin_ray_intervals_many_text(a->scene, work, n, rays, begin, end, QUOIN_WANT_BOUNDARY, each, &q), QUOIN_OK);
    assert_int_equal(q.answers, n);
    quoin_stats stats;
    quoin_work_stats(work, &stats);
    decimal_rays += n, decimal_woven += stats.exact_rays;
    quoin_work_free(work);
  }
}

/* Part of a grid in one call: its tiles are cut off at its ends. */
static size_t grid_rays, grid_stretches, grid_boundaries;
static void one_grid(dice *d, const ask *a, const char *text, int model, int bundle, const frame *f) {
  quoin_ray rays[QN_LANES];
  fill_bundle(d, bundle, f, rays);
  quoin_grid grid = {.width = 1 + (size_t)roll(d, 20), .height = 1 + (size_t)roll(d, 20), .from = rays[0].from, .to = rays[0].to};
  grid.converging = memcmp(rays[0].o, rays[63].o, sizeof rays[0].o) == 0;
  for (int i = 0; i < 3; i++) {
    grid.o[i] = rays[0].o[i], grid.d[i] = rays[0].d[i];
    const double *first = grid.converging ? rays[0].d : rays[0].o;
    grid.u[i] = (grid.converging ? rays[21].d : rays[21].o)[i] - first[i], grid.v[i] = (grid.converging ? rays[42].d : rays[42].o)[i] - first[i];
  }
  const size_t x0 = (size_t)roll(d, (int)grid.width), y0 = (size_t)roll(d, (int)grid.height), x1 = x0 + 1 + (size_t)roll(d, (int)(grid.width - x0)),
               y1 = y0 + 1 + (size_t)roll(d, (int)(grid.height - y0));
  for (size_t k = 0; k < isa_count; k++) {
    quoin_work *work = works[k];
    const unsigned boundary = roll(d, 2) ? QUOIN_WANT_BOUNDARY : 0;
    quoin_grid_answer all;
    int is_grid = 1;
    quoin_status status = quoin_grid_intervals(a->scene, work, &grid, x0, y0, x1, y1, boundary, &all);
    assert_true(status != QUOIN_OK || (all.rays == (x1 - x0) * (y1 - y0) && !all.boundary_of == !boundary));
    size_t total = 0;
    for (size_t y = y0; y < y1; y++) {
      for (size_t x = x0; x < x1; x++) {
        const double s = ((double)x + 0.5) / (double)grid.width, r = ((double)y + 0.5) / (double)grid.height;
        quoin_ray ray = {.from = grid.from, .to = grid.to};
        for (int i = 0; i < 3; i++) {
          const double across = (grid.converging ? grid.d : grid.o)[i] + s * grid.u[i], both = across + r * grid.v[i];
          ray.o[i] = grid.converging ? grid.o[i] : both, ray.d[i] = grid.converging ? both : grid.d[i];
        }
        is_grid &= is_line(&ray);
        if (status != QUOIN_OK || !is_line(&ray)) {
          continue;
        }
        weave_ray(a, &ray, &want[0]);
        const quoin_run in = all.inside_of[(y - y0) * (x1 - x0) + (x - x0)], on = boundary ? all.boundary_of[(y - y0) * (x1 - x0) + (x - x0)] : (quoin_run){0, 0};
        assert_true((size_t)in.first + in.count <= all.count && (size_t)on.first + on.count <= all.boundary_count);
        total += in.count, grid_rays++, grid_stretches += in.count, grid_boundaries += on.count;
        if (want[0].status == QUOIN_OK && (!same(in.count, all.inside ? all.inside + in.first : NULL, want[0].count, want[0].inside) ||
                                           (boundary && !same(on.count, all.boundary ? all.boundary + on.first : NULL, want[0].boundary_count, want[0].boundary)))) {
          blame(text, isas[k], model, bundle, &ray, &want[0], in.count, all.inside + in.first);
        }
      }
    }
    assert_true((status == QUOIN_OK) == is_grid && (!is_grid || total == all.count));
  }
}

static void report(const char *name, const share *s) {
  print_message("  %-22s %8llu rays, %8llu stretches, %7llu rays cut, %5.2f %% given up\n", name, (unsigned long long)s->rays, (unsigned long long)s->stretches,
                (unsigned long long)s->cut, s->rays ? 100 * (double)s->unsure / (double)s->rays : 0);
}

static void random_models(void **state) {
  (void)state;
  static char text[20000];
  for (size_t n = 0; n < model_count; n++) {
    dice d = dice_of(first_seed, n);
    frame f;
    int model = (int)(n % MODELS);
    make_frame(&d, roll(&d, 2) ? 0 : roll(&d, FRAMES), &f);
    write_model(&d, model, &f, text, sizeof text);
    ask a;
    ask_open(&a, text);
    for (size_t k = 0; k < isa_count; k++) {
      works[k] = work_on(k, a.scene);
    }
    for (int k = 0; k < 8; k++) {
      dice own = dice_of(d.state, (size_t)k);
      one_bundle(&own, &a, text, model, roll(&d, BUNDLES), &f);
    }
    for (int k = 0; k < 3; k++) {
      dice own = dice_of(d.state, (size_t)k);
      some_decimals(&own, &a, text, model, roll(&d, BUNDLES), &f);
    }
    for (int k = 0; k < 8; k++) {
      dice own = dice_of(d.state, (size_t)k);
      one_grid(&own, &a, text, model, roll(&d, BUNDLES), &f);
    }
    for (size_t k = 0; k < isa_count; k++) {
      quoin_work_free(works[k]);
    }
    ask_close(&a);
  }
  for (int i = 0; i < MODELS; i++) {
    report(MODEL_NAMES[i], &by_model[i]);
  }
  for (int i = 0; i < BUNDLES; i++) {
    report(BUNDLE_NAMES[i], &by_bundle[i]);
  }
  print_message("  %zu rays of decimals, %zu given up by their packets\n", decimal_rays, decimal_woven);
  print_message("  %zu rays of grids, %zu stretches, %zu in the boundary\n", grid_rays, grid_stretches, grid_boundaries);
  print_message("  merged by wide code: %zu rays of no stretch, %zu of one, %zu of two, %zu of more\n", merged_lanes[0], merged_lanes[1], merged_lanes[2], merged_lanes[3]);
  assert_true(merged_lanes[0] > share_min(1000) && merged_lanes[1] > share_min(1000) && merged_lanes[2] > share_min(100) && merged_lanes[3] > share_min(100));
  assert_true(grid_stretches > share_min(1000) && (!share_whole() || grid_boundaries > 20));
  assert_int_equal(failures, 0);
  assert_true(2 * decimal_woven < decimal_rays);
  for (int i = 0; i < MODELS; i++) {
    assert_true(!share_whole() || (by_model[i].stretches > 0 && by_model[i].cut > 0));
    assert_true(!share_whole() || i == SUPERQUADRICS || 10 * by_model[i].unsure < 9 * by_model[i].rays); /* superquadrics are not for packets */
  }
}

/* More stretches on a ray than there is room for at first, in leaves that share their planes; a fence seen from its end, and cut. */
static void long_rays(void **state) {
  (void)state;
  static char text[200000];
  size_t at = (size_t)snprintf(text, sizeof text, "difference() { translate([-1,-1,-1]) cube([302,3,3]); union() {\n");
  for (int i = 0; i < 150; i++) {
    at += (size_t)snprintf(text + at, sizeof text - at, "translate([%d,-2,-2]) cube([%s,5,5]); translate([%d,0,-2]) cylinder(r=0.25,h=5);\n", 2 * i, i % 3 ? "1" : "0.5", 2 * i + 1);
  }
  snprintf(text + at, sizeof text - at, "} }\n");
  ask a;
  ask_open(&a, text);
  quoin_ray rays[QN_LANES];
  for (int i = 0; i < QN_LANES; i++) {
    rays[i] = (quoin_ray){{-5, 0.011 * i - 0.3, 0.01}, {1, 0.0001 * i, 0.001}, i % 3 ? -HUGE_VAL : 20.125, i % 5 ? HUGE_VAL : 100.25};
    weave_ray(&a, &rays[i], &want[i]);
    assert_true(want[i].status == QUOIN_OK && want[i].count > 30);
  }
  for (size_t k = 0; k < isa_count; k++) {
    quoin_work *work = work_on(k, a.scene);
    asked q = {"a fence\n", isas[k], 0, 0, rays, want, 0};
    assert_int_equal(quoin_ray_intervals_many(a.scene, work, QN_LANES, rays, QUOIN_WANT_BOUNDARY, each, &q), QUOIN_OK);
    uint64_t sure;
    assert_int_equal(qn_sheaf_rays(work, QN_LANES, rays, NULL, 0, NULL, NULL, &sure), QUOIN_OK);
    assert_true(__builtin_popcountll(sure) > 60);
    quoin_work_free(work);
  }
  ask_close(&a);
  assert_int_equal(failures, 0);
}

/* Ends at one place of a leaf that is met and of one that is taken away, in either order of the file: which is named. */
static void flush_names(void **state) {
  (void)state;
  static const char text[] = "rotate([0,0,30]) intersection() { difference() { translate([0,-9,-9]) cube([5,18,18]); translate([2,-9,-9]) cube([9,18,18]);\n"
                             "translate([-3,-9,-9]) cube([4,18,18]); } translate([-1,-8,-8]) cube([3,16,16]); translate([1,-8,-8]) cube([7,16,16]); }\n";
  ask a;
  ask_open(&a, text);
  assert_int_equal(a.scene->program.gate_count, 1);
  quoin_ray rays[QN_LANES];
  size_t stretches = 0;
  for (int i = 0; i < QN_LANES; i++) {
    rays[i] = (quoin_ray){{-5, 0.011 * i - 3, 0.3}, {0.9, 0.5 + 0.0001 * i, 0.001}, 0, HUGE_VAL};
    weave_ray(&a, &rays[i], &want[i]);
    stretches += want[i].count;
  }
  assert_int_equal(stretches, QN_LANES);
  for (size_t k = 0; k < isa_count; k++) {
    quoin_work *work = work_on(k, a.scene);
    asked q = {text, isas[k], 0, 0, rays, want, 0};
    assert_int_equal(quoin_ray_intervals_many(a.scene, work, QN_LANES, rays, QUOIN_WANT_BOUNDARY, each, &q), QUOIN_OK);
    assert_true(__builtin_popcountll(work->sheaf->spans.merged) >= (int)(work->sheaf->packet.few ? 8 : 60));
    quoin_work_free(work);
  }
  ask_close(&a);
  assert_int_equal(failures, 0);
}

/* A stretch longer than the tolerance by so little that its beginning and the tolerance, added, round to its end. Two places are told apart by one difference. */
/* Several gates, faces that lie in one another, lanes with stretches of their own: plans answer the lanes, as the woven path does. */
static void plans(void **state) {
  (void)state;
  static const char text[] = "difference() { union() { cube([4,4,4]); translate([4,0,0]) cube([4,4,4]); translate([0,4,0]) cube([8,4,2]); translate([9,4,2]) sphere(3); }\n"
                             "union() { translate([1,1,0]) cylinder(r=0.5,h=4); translate([4,2,1]) cube([1,1,3]); difference() { translate([6,6,-1]) cube([1,1,3]);\n"
                             "translate([6,6,0]) cube([1,1,1]); } } }\n";
  static const double from[3][3] = {{-3, -2, 7}, {2, 2, 9}, {-5, 3, 1.5}}, to[3][3] = {{1, 0.8, -0.7}, {0.1, 0.12, -1}, {1, 0.06, 0.04}};
  ask a;
  ask_open(&a, text);
  assert_true(a.scene->program.gate_count > 1);
  for (int way = 0; way < 3; way++) {
    quoin_ray rays[QN_LANES];
    size_t stretches = 0;
    for (int i = 0; i < QN_LANES; i++) {
      rays[i] = (quoin_ray){{from[way][0], from[way][1] + 0.011 + 0.03 * (i % 8), from[way][2] + 0.017 + 0.03 * (i / 8)}, {to[way][0], to[way][1], to[way][2]}, 0, HUGE_VAL};
      weave_ray(&a, &rays[i], &want[i]);
      stretches += want[i].count;
    }
    assert_true(stretches >= QN_LANES);
    for (size_t k = 0; k < isa_count; k++) {
      quoin_work *work = work_on(k, a.scene);
      for (int again = 0; again < 2; again++) { /* with the plans of the first time */
        asked q = {text, isas[k], way, again, rays, want, 0};
        assert_int_equal(quoin_ray_intervals_many(a.scene, work, QN_LANES, rays, QUOIN_WANT_BOUNDARY, each, &q), QUOIN_OK);
        assert_true(!work->sheaf->packet.few && __builtin_popcountll(work->sheaf->spans.merged) >= 60);
      }
      quoin_work_free(work);
    }
  }
  ask_close(&a);
  assert_int_equal(failures, 0);
}

/* A plan is made for rays along which one half-space ends where the other begins; then it is asked about rays that go the other way, in whose stretches those two ends are not there:
   all that is not there has one name, but lies before everything or behind it. (Found by stress_rays, once in 500 million rays.) */
static int whole_line(void *user, size_t i, const quoin_intervals *got) {
  (void)i;
  if (got->count != 1 || got->inside[0].enter.t != -HUGE_VAL || got->inside[0].leave.t != HUGE_VAL) {
    failures++;
    show("not the whole line", got->count, got->inside);
  }
  ++*(size_t *)user;
  return 0;
}
static void plans_of_open_ends(void **state) {
  (void)state;
  ask a;
  ask_open(&a, "halfspace(n = [1, 0, 0], d = 0); halfspace(n = [-1, 1, 0], d = 0); translate([0, 0, 1000]) difference() { cube(3); sphere(1); }");
  for (size_t k = 0; k < isa_count; k++) {
    quoin_work *work = work_on(k, a.scene);
    for (int order = 0; order < 2; order++) {
      for (int way = 1; way >= -1; way -= 2) {
        quoin_ray rays[QN_LANES];
        for (int i = 0; i < QN_LANES; i++) { /* x <= 0 or x >= y: all of the line where y <= 0 */
          const double y = (way > 0) == (order == 0) ? 0 : -0.125 - (i % 8) * 0.0625;
          rays[i] = (quoin_ray){{-way * 4.0, y, (i / 8) * 0.0625}, {way, 0, 0}, -HUGE_VAL, HUGE_VAL};
        }
        size_t answers = 0;
        assert_int_equal(quoin_ray_intervals_many(a.scene, work, QN_LANES, rays, 0, whole_line, &answers), QUOIN_OK);
        assert_true(answers == QN_LANES && !work->sheaf->packet.few);
      }
    }
    quoin_work_free(work);
  }
  assert_int_equal(failures, 0);
  ask_close(&a);
}

/* A skew cylinder's exact form has rows of lengths 60 times apart: its pieces' bounds must not be as much too wide. */
static void skew_cylinder(void **state) {
  (void)state;
  ask a;
  ask_open(&a, "cylinder(base=[11.110361682241681,109.43795178130075,34.80094493390922],axis=[5.179586776376278,-22.06222842467159,18.692148937636514],"
               "h=29.376291020875748,r=9.389612343563753);\n");
  quoin_work *work;
  quoin_grid grid = {.o = {-20, 40, 80}, .u = {60, 30, 0}, .v = {-30, 60, 0}, .d = {0.1, 0.3, -0.8}, .width = 128, .height = 128, .from = 0, .to = HUGE_VAL};
  quoin_grid_answer all;
  quoin_stats stats;
  assert_int_equal(quoin_work_new(a.scene, &work), QUOIN_OK);
  assert_int_equal(quoin_grid_intervals(a.scene, work, &grid, 0, 0, 128, 128, 0, &all), QUOIN_OK);
  quoin_work_stats(work, &stats);
  print_message("skew cylinder: %zu stretches, %llu of %zu rays woven\n", all.count, (unsigned long long)stats.exact_rays, all.rays);
  assert_true(all.count > 500 && stats.exact_rays <= 4);
  quoin_work_free(work);
  ask_close(&a);
}

/* More planes than rounding keeps at hand, more names than writing does, spheres among them; rays that begin in solids and in between. */
static void many_surfaces(void **state) {
  (void)state;
  enum { SIDE = 7, RAYS = 40 };
  static char text[16384];
  size_t n = 0;
  for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
    const int x = i % SIDE, y = i / SIDE % SIDE, z = i / SIDE / SIDE;
    if ((x + y + z) % 2) {
      continue;
    }
    n += (size_t)snprintf(text + n, sizeof text - n, "translate([%d.%d,%d.%d,%d.%d])%s", 3 * x, y, 3 * y, z, 3 * z, x, i % 8 ? "cube([1.7,1.9,1.3]);\n" : "sphere(r=1.1);\n");
    assert_true(n < sizeof text);
  }
  ask a;
  ask_open(&a, text);
  assert_true(a.scene->surface_count > 1u << QN_FLAT_BITS && 5 * a.scene->leaf_count > 1u << QN_SPAN_ROLE_BITS);
  const quoin_grid grid = {.o = {-4, -2, -3}, .u = {9, 14, 0}, .v = {-4, 6, 16}, .d = {0.9, 0.31, 0.17}, .width = RAYS, .height = RAYS, .from = 4, .to = 19};
  size_t stretches = 0;
  for (size_t k = 0; k < isa_count; k++) {
    quoin_work *work = work_on(k, a.scene);
    quoin_grid_answer all;
    assert_int_equal(quoin_grid_intervals(a.scene, work, &grid, 0, 0, RAYS, RAYS, 0, &all), QUOIN_OK);
    for (size_t i = 0; i < all.rays; i++) {
      const double s = ((double)(i % RAYS) + 0.5) / RAYS, r = ((double)(i / RAYS) + 0.5) / RAYS; /* NOLINT(bugprone-integer-division): its column and row */
      quoin_ray ray = {.d = {grid.d[0], grid.d[1], grid.d[2]}, .from = grid.from, .to = grid.to};
      for (int j = 0; j < 3; j++) {
        ray.o[j] = grid.o[j] + s * grid.u[j] + r * grid.v[j];
      }
      weave_ray(&a, &ray, &want[0]);
      const quoin_run in = all.inside_of[i];
      stretches += in.count;
      if (!same(in.count, all.inside + in.first, want[0].count, want[0].inside)) {
        blame(text, isas[k], 0, 0, &ray, &want[0], in.count, all.inside + in.first);
      }
    }
    quoin_work_free(work);
  }
  assert_true(stretches > 1000 * isa_count);
  ask_close(&a);
  assert_int_equal(failures, 0);
}

static void barely_longer(void **state) {
  (void)state;
  static const char text[] = "translate([-3,0,5]) difference() {\n"
                             "cube([5.0000000037252902984619140625,1.0000000037252902984619140625,2.0000000037252902984619140625],center=true);\ncube([1,1,1]);\n}\n";
  ask a;
  ask_open(&a, text);
  quoin_ray rays[3];
  for (int i = 0; i < 3; i++) {
    rays[i] = (quoin_ray){{8186.4999999981374, -6144.5000000018626, 4100}, {-0.99999999999999933, 0.75000000000000488, -0.5}, -HUGE_VAL, HUGE_VAL};
    weave_ray(&a, &rays[i], &want[i]);
    assert_int_equal(want[i].count, 1);
  }
  for (size_t k = 0; k < isa_count; k++) {
    quoin_work *work = work_on(k, a.scene);
    asked q = {text, isas[k], 0, 0, rays, want, 0};
    assert_int_equal(quoin_ray_intervals_many(a.scene, work, 3, rays, QUOIN_WANT_BOUNDARY, each, &q), QUOIN_OK);
    quoin_work_free(work);
  }
  ask_close(&a);
  assert_int_equal(failures, 0);
}

/* A program so deep that it is walked along paths: 60 levels that add and take away in turn, many of them flush. */
static void deep_program(void **state) {
  (void)state;
  static char text[20000];
  size_t at = 0;
  for (int i = 0; i < 60; i++) {
    at += (size_t)snprintf(text + at, sizeof text - at, "%s() {\n", i % 2 ? "union" : "difference");
    if (i % 2) {
      at += (size_t)snprintf(text + at, sizeof text - at, "translate([%d,0,0]) cube([0.5,2,2]);\n", i);
    } else {
      at += (size_t)snprintf(text + at, sizeof text - at, "cube([%d.5,2,%s]);\n", 61 - i, i % 4 ? "2" : "1");
    }
  }
  at += (size_t)snprintf(text + at, sizeof text - at, "sphere(1);\n");
  for (int i = 60; i-- > 0;) {
    if (i % 2 == 0) {
      at += (size_t)snprintf(text + at, sizeof text - at, "translate([%d,0,0]) cylinder(r=0.25,h=2);\n", i);
    }
    at += (size_t)snprintf(text + at, sizeof text - at, "}\n");
  }
  ask a;
  ask_open(&a, text);
  assert_non_null(a.scene->program.paths);
  quoin_ray rays[QN_LANES];
  size_t stretches = 0;
  for (int i = 0; i < QN_LANES; i++) {
    rays[i] = (quoin_ray){{-5, 0.011 * i + 0.01, 0.02}, {1, 0.0001 * i, 0.01}, -HUGE_VAL, i % 5 ? HUGE_VAL : 30.25};
    weave_ray(&a, &rays[i], &want[i]);
    stretches += want[i].count;
  }
  assert_true(stretches > 200);
  for (size_t k = 0; k < isa_count; k++) {
    quoin_work *work = work_on(k, a.scene);
    for (int pass = 0; pass < 2; pass++) { /* the second begins where the first left the program */
      asked q = {"deep\n", isas[k], 0, 0, rays, want, 0};
      assert_int_equal(quoin_ray_intervals_many(a.scene, work, QN_LANES, rays, QUOIN_WANT_BOUNDARY, each, &q), QUOIN_OK);
    }
    uint64_t sure;
    assert_int_equal(qn_sheaf_rays(work, QN_LANES, rays, NULL, 0, NULL, NULL, &sure), QUOIN_OK);
    assert_true(__builtin_popcountll(sure) > 50);
    quoin_work_free(work);
  }
  ask_close(&a);
  assert_int_equal(failures, 0);
}

/* What the call refuses, and when: answers before a wrong ray are given. */
static void wrong_rays(void **state) {
  (void)state;
  ask a;
  ask_open(&a, "sphere(2);\n");
  quoin_ray rays[40];
  for (int i = 0; i < 40; i++) {
    rays[i] = (quoin_ray){{-5, 0.01 * i, 0}, {1, 0, 0}, 0, HUGE_VAL};
    weave_ray(&a, &rays[i], &want[i]);
  }
  rays[21].d[0] = 0;
  asked q = {"sphere(2);\n", "any", 0, 0, rays, want, 0};
  assert_int_equal(quoin_ray_intervals_many(a.scene, a.work, 40, rays, 0, each, &q), QUOIN_E_ARGUMENT);
  assert_int_equal(q.answers, 21);
  assert_int_equal(quoin_ray_intervals_many(a.scene, a.work, 40, rays, 64, each, &q), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_ray_intervals_many(a.scene, a.work, 0, NULL, 0, each, &q), QUOIN_OK);
  assert_int_equal(q.answers, 21);
  /* Decimals likewise: the 21st has a wrong number, then a direction of zero; digits beyond packets' are no wrong ones. */
  const char *text[6 * 40];
  static char y[40][8];
  for (int i = 0; i < 40; i++) {
    snprintf(y[i], sizeof y[i], "%.2f", 0.01 * i);
    const char *const one[6] = {i % 5 ? "-5" : "-5.00000000000000000000000", y[i], "0e-500", i % 7 ? "1" : "1.0", "0", "0"};
    memcpy(text + 6 * i, one, sizeof one);
    quoin_intervals v;
    assert_int_equal(quoin_ray_intervals_text(a.scene, a.work, one, "0", NULL, 0, &v), QUOIN_OK);
    want[i].count = v.count, copy(v.count, v.inside, want[i].inside);
  }
  for (int pass = 0; pass < 4; pass++) {
    text[6 * 21 + 1] = pass == 1 ? "1x" : y[21];
    text[6 * 21 + 3] = pass == 2 ? "0" : "1";
    text[6 * 21 + 5] = pass == 3 ? NULL : "0";
    q.answers = 0;
    quoin_status status = quoin_ray_intervals_many_text(a.scene, a.work, 40, text, "0", NULL, 0, each, &q);
    assert_int_equal(status, pass == 0 ? QUOIN_OK : pass == 1 ? QUOIN_E_NUMBER : QUOIN_E_ARGUMENT);
    assert_int_equal(q.answers, pass == 0 ? 40 : 21);
  }
  assert_int_equal(failures, 0);
  /* Grids. */
  quoin_grid g = {.o = {-5, -1, 0}, .u = {0, 2, 0}, .v = {0, 0, 1}, .d = {1, 0, 0}, .width = 9, .height = 9, .from = 0, .to = HUGE_VAL}, still = g, back = g;
  quoin_grid_answer all;
  still.d[0] = 0, back.to = -1;
  assert_int_equal(quoin_grid_intervals(a.scene, a.work, &g, 0, 0, 9, 9, QUOIN_WANT_BOUNDARY, &all), QUOIN_OK);
  assert_int_equal(all.rays, 81);
  assert_int_equal(quoin_grid_intervals(a.scene, a.work, &g, 3, 0, 3, 9, 0, &all), QUOIN_OK);
  assert_int_equal(all.rays, 0);
  assert_int_equal(quoin_grid_intervals(a.scene, a.work, &g, 0, 0, 10, 9, 0, &all), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_grid_intervals(a.scene, a.work, &g, 0, 0, 9, 9, QUOIN_WANT_CONTACTS, &all), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_grid_intervals(a.scene, a.work, &still, 0, 0, 9, 9, 0, &all), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_grid_intervals(a.scene, a.work, &back, 0, 0, 9, 9, 0, &all), QUOIN_E_ARGUMENT);
  ask_close(&a);
}

int main(int words, char **word) {
  model_count = words > 1 ? (size_t)strtoull(word[1], NULL, 0) : (size_t)share_of((int)model_count);
  first_seed = words > 2 ? strtoull(word[2], NULL, 0) : first_seed;
  find_isas();
  const struct CMUnitTest tests[] = {cmocka_unit_test(wrong_rays), cmocka_unit_test(long_rays), cmocka_unit_test(deep_program), cmocka_unit_test(flush_names), cmocka_unit_test(plans), cmocka_unit_test(plans_of_open_ends), cmocka_unit_test(skew_cylinder), cmocka_unit_test(many_surfaces),
                                     cmocka_unit_test(barely_longer), cmocka_unit_test(random_models)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
