/* Places rounded by every wide body that this machine runs, against the exact root's nearest double: surfaces of every kind near and
   far, rational and rotated by irrational angles, rays that graze, roots in the middle between doubles, numbers out of range. */
#include "dice.h"
#include "quoin/quoin.h"
#include "number/quad.h"
#include "base/bounds.h"
#include "scene/rounding.h"
#include "share.h"
#include "wide/packet.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static double part(void) { return part_of(4, 6); } /* in [-1, 1], with few or many bits */

/* --- the bodies ---------------------------------------------------------------------------------------------------- */

static const qn_wide *bodies[3];
static size_t body_count;

static void find_bodies(void) {
  static const char *const names[] = {"sse2", "avx2", "avx512"};
  for (size_t i = 0; i < 3; i++) {
    assert_int_equal(setenv("QUOIN_ISA", names[i], 1), 0);
    const qn_wide *w = qn_wide_pick();
    if (!strcmp(w->name, names[i])) {
      bodies[body_count++] = w;
    }
  }
  assert_true(body_count >= 1); /* the baseline runs everywhere */
  unsetenv("QUOIN_ISA");
}

/* --- a scene and the exact roots of its surfaces along a ray -------------------------------------------------------- */

typedef struct stage {
  quoin_scene *scene;
  qn_ctx ctx;
  qn_mem mem;
} stage;

static void stage_open(stage *st, const char *text) {
  quoin_model *m;
  assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
  if (quoin_model_read_text(m, QUOIN_ROOT, "t", text, strlen(text), NULL) != QUOIN_OK) {
    quoin_diag d;
    char line[1000] = "";
    quoin_model_diag(m, 0, &d);
    quoin_diag_format(&d, line, sizeof line);
    fail_msg("%s\n%s", text, line);
  }
  assert_int_equal(quoin_scene_compile(m, NULL, &st->scene), QUOIN_OK);
  quoin_model_free(m);
  qn_mem_init(&st->mem, NULL);
  qn_ctx_init(&st->ctx, &st->mem);
}
static void stage_close(stage *st) {
  qn_ctx_free(&st->ctx);
  quoin_scene_free(st->scene);
}

/* The six doubles times w, a power of two: integers. */
static qn_int integers(qn_ctx *ctx, const double v[6], qn_int out[6]) {
  qn_rat r[6];
  size_t w = 0;
  for (int i = 0; i < 6; i++) {
    r[i] = qn_num_rat(ctx, qn_num_from_double(ctx, v[i]));
    size_t e = qn_int_trailing_zeros(r[i].den);
    w = e > w ? e : w;
  }
  for (int i = 0; i < 6; i++) {
    out[i] = qn_int_shl(ctx, r[i].num, w - qn_int_trailing_zeros(r[i].den));
  }
  return qn_int_shl(ctx, qn_int_from(ctx, 1), w);
}

/* w^2 q(o + t d), doubled, as a t^2 + 2 h t + c. */
static void quad_of(qn_ctx *ctx, const qn_exact_surface *form, const double o[3], const double d[3], qn_quad *out) {
  static const int pair[10][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}, {3, 3}};
  const double v[6] = {o[0], o[1], o[2], d[0], d[1], d[2]};
  qn_int n[6], w = integers(ctx, v, n), sum[3] = {qn_int_from(ctx, 0), qn_int_from(ctx, 0), qn_int_from(ctx, 0)};
  const qn_int O[4] = {n[0], n[1], n[2], w}, D[4] = {n[3], n[4], n[5], sum[0]};
  for (int i = 0; i < 10; i++) {
    int a = pair[i][0], b = pair[i][1];
    qn_int k = form->q[i];
    if (qn_int_sign(k)) {
      sum[0] = qn_int_add(ctx, sum[0], qn_int_mul(ctx, k, qn_int_mul(ctx, D[a], D[b])));
      sum[1] = qn_int_add(ctx, sum[1], qn_int_mul(ctx, k, qn_int_add(ctx, qn_int_mul(ctx, O[a], D[b]), qn_int_mul(ctx, O[b], D[a]))));
      sum[2] = qn_int_add(ctx, sum[2], qn_int_mul(ctx, k, qn_int_mul(ctx, O[a], O[b])));
    }
  }
  qn_quad_make(ctx, qn_x(qn_int_shl(ctx, sum[0], 1)), qn_x(sum[1]), qn_x(qn_int_shl(ctx, sum[2], 1)), out);
}

/* --- packets of hits ------------------------------------------------------------------------------------------------ */

typedef struct batch {
  qn_packet packet;
  qn_packet_hits hits;
  double want[QN_LANES];
  unsigned count;
} batch;

typedef struct census { unsigned lanes, sure[3]; } census;

/* Rounds what is in the batch with every body, in a random part of the lanes, and empties it. */
static void flush(stage *st, batch *b, census *c) {
  uint64_t filled = b->count == QN_LANES ? ~(uint64_t)0 : ((uint64_t)1 << b->count) - 1, lanes = one_in(2) ? filled : filled & next();
  for (unsigned i = b->count; i < QN_LANES; i++) { /* nothing that could pass for an answer */
    b->hits.t[i] = b->hits.error[i] = NAN, b->hits.surface[i] = (uint32_t)next();
    for (int j = 0; j < 3; j++) {
      b->packet.o[j][i] = b->packet.d[j][i] = 1;
    }
  }
  b->packet.d_most = sqrt(3.0);
  for (unsigned i = 0; i < b->count; i++) {
    const double size = hypot(hypot(b->packet.d[0][i], b->packet.d[1][i]), b->packet.d[2][i]) * QN_WIDE_SLACK;
    b->packet.d_most = size > 0x1p-100 && size < 0x1p+100 ? fmax(b->packet.d_most, size) : INFINITY; /* no body goes on with others */
  }
  c->lanes += (unsigned)__builtin_popcountll(lanes);
  for (size_t k = 0; k < body_count; k++) {
    _Alignas(64) double t[QN_LANES];
    uint64_t made = 0, sure = bodies[k]->round(st->scene, &b->packet, &b->hits, lanes, t, &made);
    assert_true((sure & ~lanes) == 0);
    c->sure[k] += (unsigned)__builtin_popcountll(sure);
    for (; sure; sure &= sure - 1) {
      unsigned i = qn_trailing_zeros(sure);
      if (memcmp(&t[i], &b->want[i], 8)) {
        const qn_packet *p = &b->packet;
        fail_msg("%s: surface %u: %a for %a; t %a error %a; o %a %a %a d %a %a %a", bodies[k]->name, b->hits.surface[i], t[i],
                 b->want[i], b->hits.t[i], b->hits.error[i], p->o[0][i], p->o[1][i], p->o[2][i], p->d[0][i], p->d[1][i], p->d[2][i]);
      }
    }
  }
  b->count = 0;
}

/* Adds the roots of a surface along a ray, each known to 2^-bits of itself or so; with bits < 0 as the other root, and an error that
   holds both. 0 when there are none. */
static int add(stage *st, batch *b, census *c, uint32_t surface, const double o[3], const double d[3], int bits) {
  const qn_exact_surface *form = qn_scene_exact(st->scene, surface, NULL);
  assert_non_null(form);
  qn_mark mark = qn_arena_mark(&st->ctx.arena);
  qn_quad q;
  quad_of(&st->ctx, form, o, d, &q);
  qn_quad_shape kind = qn_quad_kind(&q);
  int roots = kind == QN_QUAD_TWO ? 2 : kind == QN_QUAD_LINEAR ? 1 : 0;
  for (int which = 0; which < roots; which++) {
    if (b->count == QN_LANES) {
      flush(st, b, c);
    }
    double r = qn_root_to_double(&st->ctx, (qn_root){&q, which});
    assert_int_equal(st->ctx.failed, QUOIN_OK);
    if (!isfinite(r)) {
      continue;
    }
    unsigned i = b->count++;
    double off = fabs(r) * ldexp(1, -bits);
    b->want[i] = r;
    b->hits.t[i] = r + off * part();
    b->hits.error[i] = off + fabs(r) * 0x1p-50 + 0x1p-1074;
    if (bits < 0) {
      double other = qn_root_to_double(&st->ctx, (qn_root){&q, roots - 1 - which});
      b->hits.t[i] = other;
      b->hits.error[i] = fabs(other - r) + (fabs(r) + fabs(other)) * 0x1p-50;
    }
    b->hits.surface[i] = surface, b->hits.leaf[i] = st->scene->surfaces[surface].leaf;
    for (int j = 0; j < 3; j++) {
      b->packet.o[j][i] = o[j], b->packet.d[j][i] = d[j];
    }
  }
  qn_arena_release(&st->ctx.arena, mark);
  return roots;
}

static int has_form(const quoin_scene *s, uint32_t surface) { return s->surfaces[surface].kind != QN_SUPER_BODY; }

/* --- random rays at surfaces of every kind -------------------------------------------------------------------------- */

static const char *const SHAPES =
  "{ sphere(1.5); translate([0.1, -3.7, 2]) sphere(0.3); cube([1, 2.5, 0.7]); rotate([10, 20, 30]) cube(0.8);"
  " cylinder(h = 2, r = 0.7); rotate([0, 0, 45]) rotate([30, 0, 0]) cylinder(h = 3, r1 = 0.2, r2 = 1.1);"
  " multmatrix([[0.6, -0.8, 0, 0.3], [0.8, 0.6, 0, 0.7], [0, 0, 1, -0.1]]) cylinder(h = 1.7, r = 1 / 3);"
  " scale([1, 2, 0.3]) sphere(1.1); multmatrix([[1, 0.3, 0, 0], [0, 1, 0.7, 0], [0.1, 0, 1.3, 0]]) sphere(0.9);"
  " paraboloid(h = 2, r = 1); hyperboloid(h = 2, r = 1, rc = 0.6); rotate([77, 13, 5]) paraboloid(h = 1.3, r = 0.8);"
  " halfspace(n = [1, 2, -0.3], d = 0.1); }";

typedef struct setting { const char *place; double size, far; int bits; double least; } setting;

static void test_shapes(void **state) {
  (void)state;
  /* where; the size and the place along x, roughly; how well t is known; the share that must be sure */
  static const setting settings[] = {
    {"union()", 1, 0, 40, 0.995},
    {"union()", 1, 0, 52, 0.995},
    {"union()", 1, 0, 30, 0.8},
    {"union()", 1, 0, 12, 0.2},
    {"union()", 1, 0, 2, 0},
    {"translate([1e9, 0.1, -3])", 1, 1e9, 40, 0.995},
    {"translate([123456.789, 0, 0]) rotate([1, 2, 3])", 1, 123456.789, 45, 0.995},
    {"scale(1e-6)", 1e-6, 0, 40, 0.995},
    {"scale(1e6)", 1e6, 0, 40, 0.995},
    {"scale(1e11)", 1e11, 0, 40, 0.7},
    {"scale(1e30)", 1e30, 0, 40, 0}, /* past QN_ROUND_LARGEST: nobody is sure */
  };
  static stage st;
  static batch b;
  for (size_t s = 0; s < sizeof settings / sizeof *settings; s++) {
    const setting *set = &settings[s];
    char text[2000];
    snprintf(text, sizeof text, "%s %s", set->place, SHAPES);
    stage_open(&st, text);
    assert_true(st.scene->surface_count > 25);
    census c = {0};
    b.count = 0;
    for (int n = 0; n < share_from(400, 3000); n++) {
      uint32_t surface = (uint32_t)(next() % st.scene->surface_count);
      int run = one_in(2) ? 1 : (int)(next() % 20), axis = one_in(3) ? (int)(next() % 3) : -1;
      double away = one_in(8) ? 1e4 : 10;
      for (int i = 0; i <= run && has_form(st.scene, surface); i++) {
        double o[3], d[3];
        for (int j = 0; j < 3; j++) {
          double to = (j == 0 ? set->far : 0) + set->size * 1.5 * part();
          o[j] = (j == 0 ? set->far : 0) + set->size * away * part();
          d[j] = axis < 0 ? to - o[j] : j == axis ? 1 : 0;
          o[j] = axis < 0 || j == axis ? o[j] : to;
        }
        if (n / 500 % 2) { /* directions of about one length, as packets have them: bounds for the longest are good for all */
          const double size = fmax(fmax(fabs(d[0]), fabs(d[1])), fabs(d[2]));
          for (int j = 0; j < 3 && size > 0; j++) {
            d[j] = ldexp(d[j], -ilogb(size));
          }
        }
        if (d[0] != 0 || d[1] != 0 || d[2] != 0) {
          add(&st, &b, &c, surface, o, d, set->bits);
        }
      }
    }
    flush(&st, &b, &c);
    for (size_t k = 0; k < body_count; k++) {
      print_message("%s, t to 2^-%d: %s sure of %u of %u\n", set->place, set->bits, bodies[k]->name, c.sure[k], c.lanes);
      assert_true(c.lanes > share_min(3000) && c.sure[k] >= set->least * c.lanes);
      assert_true(set->size < 1e20 || c.sure[k] == 0);
    }
    stage_close(&st);
  }
}

/* --- spheres whose numbers are no doubles: what these lack decides --------------------------------------------------- */

static void test_balls(void **state) {
  (void)state;
  static stage st;
  static batch b;
  stage_open(&st, "translate([1000.1, 0.3, -700.7]) sphere(0.3); translate([0.1, 2000.2, 3.3]) sphere(0.7); translate([-500.1, 33.3, 0.7]) sphere(1/3);");
  census c = {0};
  b.count = 0;
  for (int n = 0; n < share_of(6000); n++) {
    const uint32_t surface = (uint32_t)(n / 3 % 3);
    const double *pivot = st.scene->leaves[st.scene->surfaces[surface].leaf].pivot;
    double d[3], o[3];
    for (int j = 0; j < 3; j++) {
      d[j] = 0.6 * part() + (j == n % 3 ? 1 : 0);
      o[j] = pivot[j] + 0.15 * part() - 3 * d[j];
    }
    add(&st, &b, &c, surface, o, d, 45);
  }
  flush(&st, &b, &c);
  print_message("balls: sure of %u of %u\n", c.sure[0], c.lanes);
  assert_true(c.lanes > share_min(5000) && c.sure[0] > 0.999 * c.lanes);
  stage_close(&st);
}

/* --- rays that graze: roots next to each other, with enclosures that hold both -------------------------------------- */

static void test_grazing(void **state) {
  (void)state;
  static stage st;
  static batch b;
  stage_open(&st, "sphere(1); translate([0, 0, 5]) scale([1, 1, 3]) sphere(1); translate([0, 0, -9]) cylinder(h = 4, r = 1);");
  census c = {0};
  unsigned apart = 0;
  b.count = 0;
  for (int n = 0; n < share_of(6000); n++) {
    uint32_t surface = (uint32_t)(next() % st.scene->surface_count);
    int k = (int)(next() % 52);
    const double o[3] = {-5 + part(), 1 - ldexp(1 + (double)(next() % 3), -k), one_in(2) ? 0 : surface == 1 ? 5 : -7}, d[3] = {1, 0, 0};
    apart += (unsigned)add(&st, &b, &c, surface, o, d, one_in(8) ? -1 : one_in(2) ? k / 2 + (int)(next() % 20) : 40 + (int)(next() % 13));
  }
  flush(&st, &b, &c);
  print_message("grazing: sure of %u of %u\n", c.sure[0], c.lanes);
  assert_true(apart > share_min(3000) && c.sure[0] > c.lanes / 4);
  stage_close(&st);
}

/* --- roots in the middle between two doubles, and 2^-j off it --------------------------------------------------------- */

static void test_middles(void **state) {
  (void)state;
  static stage st;
  static batch b;
  census c = {0};
  unsigned middles = 0;
  b.count = 0;
  for (int n = 0; n < share_of(300); n++) {
    int k = (int)(next() % 1000), off = (int)(next() % 3) - 1, bits = 54 + (int)(next() % 100);
    char text[300];
    snprintf(text, sizeof text,
             "p = 1 + %d * 2 ^ -53 + %d * 2 ^ -%d; halfspace(n = [1, 0, 0], d = p); sphere(p); cylinder(h = 1, r = p);", 2 * k + 1, off,
             bits);
    stage_open(&st, text);
    const double o[3] = {0, 0, 0.5}, z[3] = {0, 0, 0}, d[3] = {1, 0, 0};
    for (uint32_t s = 0; s < st.scene->surface_count; s++) {
      add(&st, &b, &c, s, s == 2 ? o : z, d, 45);
    }
    flush(&st, &b, &c);
    middles += off == 0;
    stage_close(&st);
  }
  print_message("middles: sure of %u of %u, %u exactly there\n", c.sure[0], c.lanes, middles);
  assert_true(middles > share_min(50) && c.lanes > share_min(500) && c.sure[0] > c.lanes / 10 && c.sure[0] < c.lanes * 2 / 3);
}

/* --- numbers at and past the edges of the range: any lane may be unsure, none wrong --------------------------------- */

static void test_range(void **state) {
  (void)state;
  static stage st;
  static batch b;
  stage_open(&st, "translate([0.1, 0, 0]) sphere(1); rotate([0, 0, 31]) cube(1); scale([1, 1, 1e-9]) cylinder(h = 3, r = 1);"
                  "halfspace(n = [1, 1e-30, 0], d = 0); translate([0, 0, 1e40]) sphere(1e-20);");
  census c = {0};
  b.count = 0;
  for (int n = 0; n < share_of(20000); n++) {
    uint32_t surface = (uint32_t)(next() % st.scene->surface_count);
    int e = (int)(next() % 2000) - 1000, f = one_in(2) ? 0 : (int)(next() % 400) - 200;
    double o[3], d[3];
    for (int j = 0; j < 3; j++) {
      o[j] = one_in(4) ? ldexp(part(), -(int)(next() % 1060)) : ldexp(part(), f);
      d[j] = one_in(4) ? ldexp(part(), (int)(next() % 2000) - 1000) : ldexp(one_in(2) ? -o[j] / ldexp(1, f) + part() : part(), e);
    }
    if ((d[0] != 0 || d[1] != 0 || d[2] != 0) && isfinite(d[0]) && isfinite(d[1]) && isfinite(d[2])) {
      add(&st, &b, &c, surface, o, d, 45);
    }
  }
  flush(&st, &b, &c);
  print_message("range: sure of %u of %u\n", c.sure[0], c.lanes);
  assert_true(c.lanes > share_min(10000) && c.sure[0] > c.lanes / 20 && c.sure[0] < c.lanes);
  stage_close(&st);
}

/* --- want of memory: nobody is sure, and with memory again everybody is ---------------------------------------------- */

static int refusing;
static void *take(void *user, size_t size) {
  (void)user;
  return refusing ? NULL : malloc(size);
}
static void *retake(void *user, void *block, size_t old_size, size_t size) {
  (void)user, (void)old_size;
  return refusing ? NULL : realloc(block, size);
}
static void give(void *user, void *block, size_t size) {
  (void)user, (void)size;
  free(block);
}

static void test_memory(void **state) {
  (void)state;
  const quoin_allocator allocator = {take, retake, give, NULL, 0};
  const char *text = "scale([1, 1, 2]) sphere(2);"; /* its numbers are not in its piece */
  quoin_model *m;
  quoin_scene *scene;
  static batch b;
  assert_int_equal(quoin_model_new(&allocator, &m), QUOIN_OK);
  assert_int_equal(quoin_model_read_text(m, QUOIN_ROOT, "t", text, strlen(text), NULL), QUOIN_OK);
  assert_int_equal(quoin_scene_compile(m, NULL, &scene), QUOIN_OK);
  for (unsigned i = 0; i < QN_LANES; i++) {
    b.hits.t[i] = 3, b.hits.error[i] = 0x1p-40, b.hits.surface[i] = b.hits.leaf[i] = 0;
    b.packet.o[0][i] = -5, b.packet.o[1][i] = b.packet.o[2][i] = 0;
    b.packet.d[0][i] = 1, b.packet.d[1][i] = b.packet.d[2][i] = 0;
  }
  for (refusing = 1; refusing >= 0; refusing--) {
    _Alignas(64) double t[QN_LANES];
    uint64_t made = 0, sure = bodies[0]->round(scene, &b.packet, &b.hits, ~(uint64_t)0, t, &made);
    assert_true(sure == (refusing ? 0 : ~(uint64_t)0));
    assert_true(refusing || (made == 1 && t[0] == 3 && t[63] == 3));
  }
  refusing = 0;
  quoin_scene_free(scene);
  quoin_model_free(m);
}

int main(void) {
  find_bodies();
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_shapes), cmocka_unit_test(test_balls), cmocka_unit_test(test_grazing), cmocka_unit_test(test_middles),
                                     cmocka_unit_test(test_range), cmocka_unit_test(test_memory)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
