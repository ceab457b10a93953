/* The search for near surfaces: its doubles within their bounds, and no pair overlooked, judged by the exact gaps of all pairs. */
#include "scene/near_parts.h"
#include "scene/reading.h"
#include "share.h"

#include <gmp.h>
#include <stdlib.h>

static uint64_t state = 0x1234567fedcba9u;
static uint64_t next(void) {
  state ^= state << 13, state ^= state >> 7, state ^= state << 17;
  return state;
}
static int below(int n) {
  return (int)(next() % (uint64_t)n);
}

/* A solid at a place that others share, or nearly: under a common map, moved, turned and resized a little. */
static void put_solid(char *text, double scale, double off, int map) {
  static const char *const maps[] = {"", "rotate([10,20,30]) ", "scale([1,2,0.5]) ", "multmatrix([[1,0.3,0,0],[0,1,0.2,0],[0.1,0,1,0]]) ",
                                     "scale([1000,1,1]) rotate([0,0,40]) "};
  double jitter[4];
  for (int k = 0; k < 4; k++) {
    jitter[k] = (below(5) - 2) * off;
  }
  text += sprintf(text, "%stranslate([%.17g,%.17g,%.17g]) ", maps[below(8) ? map : below(5)], scale * below(2) + jitter[0], jitter[1], jitter[2]);
  if (below(3) == 0) {
    text += sprintf(text, "rotate([%.9g,0,%.9g]) ", below(2) * jitter[3] / scale * 30, below(2) * jitter[1] / scale * 30);
  }
  double r = scale * (1 + below(2)) + jitter[3], h = scale * (1 + below(3));
  switch (below(4) == 0 ? 1 : 2 + below(6)) {
  case 0: case 1: sprintf(text, "cube([%.17g,%.17g,%.17g]);\n", r, h, scale); break;
  case 2: sprintf(text, "wedge([%.17g,%.17g,%.17g]);\n", r, h, scale); break;
  case 3: sprintf(text, "cylinder(h=%.17g,r=%.17g);\n", h, r); break;
  case 4: sprintf(text, "cylinder(h=%.17g,r1=%.17g,r2=%.17g);\n", h, 2 * h, h); break;
  case 5: sprintf(text, "paraboloid(h=%.17g,r=%.17g);\n", h, h); break;
  case 6: sprintf(text, "ellipsoid([%.17g,%.17g,%.17g]);\n", r, 2 * r, r); break;
  default: sprintf(text, "sphere(%.17g);\n", r); break;
  }
}

static int users_near(const quoin_scene *s, uint32_t x, uint32_t y, double limit) {
  for (uint32_t i = 0; i < s->half_count; i++) {
    for (uint32_t j = 0; s->halves[i].surface == x && j < s->half_count; j++) {
      if (s->halves[j].surface != y) {
        continue;
      }
      const qn_leaf *p = NULL, *q = NULL;
      for (uint32_t l = 0; l < s->leaf_count; l++) {
        p = i - s->leaves[l].half0 < s->leaves[l].halves ? &s->leaves[l] : p;
        q = j - s->leaves[l].half0 < s->leaves[l].halves ? &s->leaves[l] : q;
      }
      int close = 1;
      for (int k = 0; k < 3; k++) {
        close &= p->min[k] - q->max[k] <= limit && q->min[k] - p->max[k] <= limit;
      }
      if (close) {
        return 1;
      }
    }
  }
  return 0;
}

/* Bodies about one centre or axis, whose sizes differ by about the limit: their places tell nothing of them. */
static void put_shell(char *text, double scale, double off, int map) {
  static const char *const maps[] = {"", "rotate([10,20,30]) ", "scale([1,2,0.5]) ", "multmatrix([[1,0.3,0,0],[0,1,0.2,0],[0.1,0,1,0]]) ", "scale([1000,1,1]) "};
  double r = scale + (below(24) - 12) * off, more = below(3) ? 0 : (below(5) - 2) * off, h = scale * (below(3) ? 2 : 1e13);
  text += sprintf(text, "%stranslate([%.17g,0,%.17g]) ", maps[map], more, more);
  switch (below(6)) {
  case 5: sprintf(text, "quadric([1,1,1,0,0,0,0,0,%.17g,%.17g]);\n", 2 * scale, scale * scale - r * r); break; /* a sphere about another place */
  case 0: sprintf(text, "sphere(%.17g);\n", r); break;
  case 1: sprintf(text, "ellipsoid([%.17g,%.17g,%.17g]);\n", r, 2 * r, 3 * r); break;
  case 2: sprintf(text, "cylinder(h=%.17g,r=%.17g);\n", h, r); break;
  case 3: sprintf(text, "hyperboloid(h=%.17g,r=%.17g,rc=%.17g);\n", r, 2 * r, r); break;
  default: sprintf(text, "cylinder(h=%.17g,r1=%.17g,r2=%.17g);\n", r, r, 2 * r); break;
  }
}

static void look_for_pairs(void (*put)(char *text, double scale, double off, int map), int rounds, int shells) {
  enum { N = 20 };
  size_t pairs = 0, curved = 0, tilted = 0;
  for (int round = 0; round < rounds; round++) {
    char text[N * 300];
    double scale = ldexp(1, 10 * (below(7) - 3)), off = ldexp(scale, -4 * (2 + below(8))), limit = 5 * off;
    int map = below(5);
    text[0] = '\0';
    for (int i = 0; i < N; i++) {
      put(text + strlen(text), scale, off, map);
    }
    quoin_scene *s = scene_of(text);
    qn_ctx ctx;
    qn_ctx_init(&ctx, s->mem);
    qn_num within = qn_num_from_double(&ctx, limit);
    qn_near_pairs found;
    assert_int_equal(qn_near_find(s, within, QN_NEAR_ALL, &found), QUOIN_OK);
    assert_false(found.cut);
    qn_near_finder f = {.scene = s, .mem = s->mem, .want = QN_NEAR_ALL, .limit = within};
    assert_int_equal(qn_near_items_make(&f), QUOIN_OK);
    size_t n = 0;
    for (uint32_t x = 0; x < s->surface_count; x++) {
      for (uint32_t y = 0; y < s->surface_count; y++) {
        qn_num gap;
        int turn;
        if (x == y || qn_near_order(&f, y, x) > 0) {
          continue;
        }
        const qn_exact_surface *e = qn_scene_exact(s, x, NULL), *g = qn_scene_exact(s, y, NULL);
        if (!qn_gap(&ctx, e, g, &f.items[x].region, &f.items[y].region, &gap, &turn) || qn_num_cmp(&ctx, gap, within) > 0 || !users_near(s, x, y, limit)) {
          continue;
        }
        int there = 0;
        for (size_t i = 0; i < found.count; i++) {
          there |= found.items[i].small == x && found.items[i].stands == y && found.items[i].turn == turn && found.items[i].gap == qn_num_to_double(gap);
        }
        if (!there) {
          fail_msg("surfaces %u and %u, %g apart, of\n%s", (unsigned)x, (unsigned)y, qn_num_to_double(gap), text);
        }
        n++;
        curved += !e->plane;
        tilted += f.items[x].n[0] != f.items[y].n[0] && f.items[x].n[0] != -f.items[y].n[0];
      }
    }
    assert_int_equal(n, found.count); /* and none that is not */
    pairs += n;
    qn_free(f.mem, f.items, s->surface_count * sizeof *f.items);
    qn_free(f.mem, f.order, s->surface_count * sizeof *f.order);
    qn_free(f.mem, f.next_in_group, s->surface_count * sizeof *f.next_in_group);
    qn_free(f.mem, f.users, s->half_count * sizeof *f.users);
    qn_free(f.mem, f.users_of, (s->surface_count + 1) * sizeof *f.users_of);
    qn_near_pairs_free(&found, s->mem);
    qn_ctx_free(&ctx);
    quoin_scene_free(s);
  }
  print_message("%zu pairs, %zu curved, %zu tilted\n", pairs, curved, tilted);
  assert_true(pairs > share_min(2000) && (shells ? curved > share_min(400) : curved > share_min(100) && tilted > share_min(200)));
}
static void no_pair_overlooked(void **unused) {
  (void)unused;
  look_for_pairs(put_solid, share_of(200), 0);
}
static void no_shell_overlooked(void **unused) {
  (void)unused;
  look_for_pairs(put_shell, share_of(200), 1);
}

/* Normals and offsets of planes against 300-bit numbers. */
static void planes_within_bounds(void **unused) {
  (void)unused;
  double most_normal = 0, most_offset = 0;
  mpf_set_default_prec(400);
  for (int round = 0; round < share_of(60); round++) {
    char text[4000];
    text[0] = '\0';
    for (int i = 0; i < 10; i++) {
      sprintf(text + strlen(text), "translate([%d.%d,%d.%d,%d]) rotate([%d,%d,%d]) cube([%d,1.%d,0.%d1]);\n", below(1000000), below(1000), below(100), below(1000),
              -below(1000), below(360), below(360), below(360), 1 + below(9), below(1000), below(100));
    }
    quoin_scene *s = scene_of(text);
    qn_ctx ctx;
    qn_ctx_init(&ctx, s->mem);
    qn_near_finder f = {.scene = s, .mem = s->mem, .limit = qn_num_from_double(&ctx, 1)};
    assert_int_equal(qn_near_items_make(&f), QUOIN_OK);
    for (uint32_t i = 0; i < s->surface_count; i++) {
      const qn_exact_surface *e = qn_scene_exact(s, i, NULL);
      mpf_t n[3], d, length, t;
      mpz_t z;
      mpf_inits(d, length, t, NULL);
      for (int k = 0; k < 3; k++) {
        mpf_init(n[k]);
        mpf_set_z(n[k], mpz_roinit_n(z, e->q[6 + k].d, e->q[6 + k].n));
        mpf_mul(t, n[k], n[k]);
        mpf_add(length, length, t);
      }
      mpf_sqrt(length, length);
      if (s->halves[s->surfaces[i].half].side < 0) {
        mpf_neg(length, length);
      }
      mpf_set_z(d, mpz_roinit_n(z, e->q[9].d, e->q[9].n));
      for (int k = 0; k < 3; k++) {
        mpf_set_d(t, f.origin[k]);
        mpf_mul(t, t, n[k]);
        mpf_add(d, d, t);
        mpf_div(n[k], n[k], length);
        mpf_set_d(t, f.items[i].n[k]);
        mpf_sub(t, t, n[k]);
        most_normal = fmax(most_normal, fabs(mpf_get_d(t)));
        mpf_clear(n[k]);
      }
      mpf_div(d, d, length);
      mpf_set_d(t, f.items[i].d);
      mpf_sub(t, t, d);
      most_offset = fmax(most_offset, fabs(mpf_get_d(t)) / f.items[i].error);
      mpf_clears(d, length, t, NULL);
    }
    qn_free(f.mem, f.items, s->surface_count * sizeof *f.items);
    qn_free(f.mem, f.order, s->surface_count * sizeof *f.order);
    qn_free(f.mem, f.next_in_group, s->surface_count * sizeof *f.next_in_group);
    qn_free(f.mem, f.users, s->half_count * sizeof *f.users);
    qn_free(f.mem, f.users_of, (s->surface_count + 1) * sizeof *f.users_of);
    qn_ctx_free(&ctx);
    quoin_scene_free(s);
  }
  assert_true(most_normal <= QN_NEAR_NORMAL && (!share_whole() || most_normal > QN_NEAR_NORMAL / 0x1p10));
  assert_true(most_offset <= 1 && (!share_whole() || most_offset > 0x1p-16));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(no_pair_overlooked), cmocka_unit_test(no_shell_overlooked), cmocka_unit_test(planes_within_bounds)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
