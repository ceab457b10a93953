/* Every double shadow against the exact number it stands for (QN_SHADOW), and every leaf's box against its exact extent. */
#include "base/bounds.h"
#include "scene/reading.h"
#include "share.h"

#include <gmp.h>
#include <math.h>
#include <stdlib.h>

static uint64_t state = 777;
static uint64_t rnd(void) {
  state ^= state << 13, state ^= state >> 7, state ^= state << 17;
  return state * 0x2545F4914F6CDD1Du;
}
static int in(int low, int high) {
  return low + (int)(rnd() % (uint64_t)(high - low + 1));
}

static void set_int(mpz_t out, qn_int a) {
  mpz_set_ui(out, 0);
  if (a.n) {
    mpz_import(out, (size_t)(a.n < 0 ? -a.n : a.n), -1, sizeof(mp_limb_t), 0, 0, a.d);
  }
  if (a.n < 0) {
    mpz_neg(out, out);
  }
}
static void set_num(qn_ctx *ctx, mpq_t out, qn_num a) {
  qn_rat r = qn_num_rat(ctx, a);
  set_int(mpq_numref(out), r.num);
  set_int(mpq_denref(out), r.den);
}

static size_t numbers, zeros, roundings;

/* |shadow - exact| <= QN_SHADOW |exact|, and one is 0 when the other is. Of a rounded number, which the two routes round at
   2^-256 apart, a hair more. */
static void check(qn_ctx *ctx, double shadow, qn_num exact, int rounded) {
  numbers++;
  if (qn_num_is_zero(exact)) {
    zeros++;
    assert_true(shadow == 0);
    return;
  }
  assert_true(shadow != 0);
  mpq_t x, d, bound;
  mpq_inits(x, d, bound, NULL);
  set_num(ctx, x, exact);
  mpq_set_d(d, shadow);
  mpq_sub(d, d, x);
  mpq_abs(d, d);
  mpq_set_d(bound, rounded ? QN_U * (1 + 0x1p-39) : QN_SHADOW);
  mpq_mul(bound, bound, x);
  mpq_abs(bound, bound);
  roundings += mpq_sgn(d) != 0;
  assert_true(mpq_cmp(d, bound) <= 0);
  mpq_clears(x, d, bound, NULL);
}

static void check_row(qn_ctx *ctx, const double *row, double b, const qn_num exact[4], const double pivot[3]) {
  qn_num point[4] = {qn_num_from_double(ctx, pivot[0]), qn_num_from_double(ctx, pivot[1]), qn_num_from_double(ctx, pivot[2]), QN_NUM_ONE};
  int rounded = 0;
  for (int j = 0; j < 4; j++) {
    rounded |= qn_num_is_rounded(exact[j]);
  }
  for (int j = 0; j < 3; j++) {
    check(ctx, row[j], exact[j], rounded);
  }
  check(ctx, b, qn_num_dot(ctx, 4, exact, point), rounded);
}

static unsigned rests; /* of shifted spheres, looked at */

static void check_shadows(const quoin_scene *s) {
  qn_ctx ctx;
  qn_ctx_init(&ctx, s->mem);
  for (uint32_t i = 0; i < s->leaf_count; i++) {
    const qn_leaf *leaf = &s->leaves[i];
    qn_half_form *forms;
    size_t count;
    assert_int_equal(qn_scene_leaf_forms(s, i, &ctx, &forms, &count), QN_FORM_OK);
    assert_int_equal(count, leaf->halves);
    for (size_t h = 0; h < count; h++) {
      const qn_half *half = &s->halves[leaf->half0 + h];
      assert_int_equal(half->kind, forms[h].kind);
      assert_int_equal(half->role, forms[h].role);
      if (half->kind == QN_PLANE) {
        check_row(&ctx, s->planes[half->shadow].n, s->planes[half->shadow].d, forms[h].row[0], leaf->pivot);
        continue;
      }
      const qn_quadric_shadow *q = &s->quadrics[half->shadow];
      for (int r = 0; r < 3; r++) {
        check_row(&ctx, q->row[r], q->row[r][3], forms[h].row[r], leaf->pivot);
        check(&ctx, q->s[r], forms[h].s[r], qn_num_is_rounded(forms[h].s[r]));
      }
      check(&ctx, q->l, forms[h].l, qn_num_is_rounded(forms[h].l));
      check(&ctx, q->k, forms[h].k, qn_num_is_rounded(forms[h].k));
      if (isfinite(q->k_rest)) { /* k + k_rest within 2^-100 k */
        const qn_num both = qn_num_add(&ctx, qn_num_from_double(&ctx, q->k), qn_num_from_double(&ctx, q->k_rest));
        assert_true(fabs(qn_num_to_double(qn_num_sub(&ctx, both, forms[h].k))) <= fabs(q->k) * 0x1p-100);
        rests++;
      }
    }
    assert_int_equal(ctx.failed, QUOIN_OK);
  }
  qn_ctx_free(&ctx);
}

/* The ten coefficients of a half-space. */
static void coefficients(qn_ctx *ctx, const qn_half_form *f, mpq_t c[10]) {
  static const int pair[10][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}, {3, 3}};
  mpq_t r[3][4], s[3], l, k, t;
  mpq_inits(l, k, t, NULL);
  set_num(ctx, l, f->l);
  set_num(ctx, k, f->k);
  for (int i = 0; i < 3; i++) {
    mpq_init(s[i]);
    set_num(ctx, s[i], f->s[i]);
    for (int j = 0; j < 4; j++) {
      mpq_init(r[i][j]);
      if (i == 0 || f->kind != QN_PLANE) {
        set_num(ctx, r[i][j], f->row[i][j]);
      }
    }
  }
  for (int n = 0; n < 10; n++) {
    int a = pair[n][0], b = pair[n][1];
    mpq_set_ui(c[n], 0, 1);
    if (f->kind == QN_PLANE) {
      if (b == 3) {
        mpq_set(c[n], r[0][a]);
      }
      continue;
    }
    for (int i = 0; i < 3; i++) {
      mpq_mul(t, r[i][a], r[i][b]);
      mpq_mul(t, t, s[i]);
      mpq_add(c[n], c[n], t);
    }
    if (a != b) {
      mpq_add(c[n], c[n], c[n]);
    }
    if (b == 3) {
      mpq_mul(t, l, r[2][a]);
      mpq_add(t, t, t);
      mpq_add(c[n], c[n], t);
    }
    if (n == 9) {
      mpq_add(c[n], c[n], k);
    }
  }
  for (int i = 0; i < 3; i++) {
    mpq_clear(s[i]);
    for (int j = 0; j < 4; j++) {
      mpq_clear(r[i][j]);
    }
  }
  mpq_clears(l, k, t, NULL);
}

/* The exact surface is side times a positive multiple of the half-space's own form, exactly; of rounded ones, to 2^-180. */
static void check_sides(const quoin_scene *s) {
  qn_ctx ctx;
  qn_ctx_init(&ctx, s->mem);
  mpq_t own[10], x, y, largest;
  mpq_inits(x, y, largest, NULL);
  for (int c = 0; c < 10; c++) {
    mpq_init(own[c]);
  }
  for (uint32_t i = 0; i < s->leaf_count; i++) {
    const qn_leaf *leaf = &s->leaves[i];
    qn_half_form *forms;
    size_t count;
    assert_int_equal(qn_scene_leaf_forms(s, i, &ctx, &forms, &count), QN_FORM_OK);
    for (size_t h = 0; h < count; h++) {
      const qn_half *half = &s->halves[leaf->half0 + h];
      assert_true(half->side == 1 || half->side == -1);
      if (half->kind == QN_SUPER_BODY) {
        continue;
      }
      const qn_exact_surface *e = qn_scene_exact(s, half->surface, NULL);
      assert_non_null(e);
      coefficients(&ctx, &forms[h], own);
      int first = 0, big = 0;
      for (int c = 0; c < 10; c++) {
        first = first ? first : qn_int_sign(e->q[c]);
        mpq_abs(x, own[c]);
        mpq_abs(y, own[big]);
        big = mpq_cmp(x, y) > 0 ? c : big;
      }
      assert_int_equal(first, 1);
      assert_int_equal(mpq_sgn(own[big]) * qn_int_sign(e->q[big]), half->side);
      set_int(mpq_numref(largest), e->q[big]);
      mpz_set_ui(mpq_denref(largest), 1);
      for (int c = 0; c < 10; c++) {
        mpz_set_ui(mpq_denref(x), 1);
        set_int(mpq_numref(x), e->q[c]);
        mpq_mul(x, x, own[big]);
        mpq_mul(y, own[c], largest);
        mpq_sub(x, x, y);
        mpq_mul(y, largest, own[big]);
        mpq_abs(x, x);
        mpq_abs(y, y);
        mpq_div_2exp(y, y, 180);
        assert_true(e->rounded ? mpq_cmp(x, y) <= 0 : mpq_sgn(x) == 0);
      }
    }
    assert_int_equal(ctx.failed, QUOIN_OK);
  }
  for (int c = 0; c < 10; c++) {
    mpq_clear(own[c]);
  }
  mpq_clears(x, y, largest, NULL);
  qn_ctx_free(&ctx);
}

/* --- random models ------------------------------------------------------------------------------------------------- */

static char text[1 << 16];
static size_t at;
static void put(const char *format, ...) {
  va_list args;
  va_start(args, format);
  at += (size_t)vsnprintf(text + at, sizeof text - at, format, args);
  va_end(args);
  assert_true(at < sizeof text);
}

static const char *number(char out[64]) {
  switch (in(0, 5)) {
  case 0: snprintf(out, 64, "%d", in(-5, 5)); break;
  case 1: snprintf(out, 64, "%d.%d", in(-20, 20), in(0, 9)); break;
  case 2: snprintf(out, 64, "%.17g", (double)(int64_t)rnd() * 0x1p-60); break;
  case 3: snprintf(out, 64, "%d/%d", in(-9, 9), in(1, 9)); break;
  case 4: snprintf(out, 64, "%d.%06d", in(-3, 3), in(0, 999999)); break;
  default: snprintf(out, 64, "%de%d", in(-9, 9), in(-6, 6)); break;
  }
  return out;
}
static const char *positive(char out[64]) {
  snprintf(out, 64, in(0, 1) ? "%d.%d" : "%d/%d", in(1, 20), in(1, 9));
  return out;
}

static void random_transform(void) {
  char a[64], b[64], c[64];
  switch (in(0, 7)) {
  case 0: case 1: case 2: put("translate([%s,%s,%s]) ", number(a), number(b), number(c)); break;
  case 3: put("rotate([%d,%d,%d]) ", 15 * in(0, 24), 90 * in(0, 3), in(0, 1) ? 0 : in(0, 359)); break;
  case 4: put("rotate(a=%d,v=[%d,%d,%d]) ", 30 * in(0, 12), in(0, 1), in(0, 1), in(1, 2)); break;
  case 5: put("scale([%s,%s,%s]) ", positive(a), positive(b), positive(c)); break;
  case 6: put("mirror([%d,%d,%d]) ", in(0, 1), in(-1, 1), in(1, 2)); break;
  default: put("multmatrix([[0.6,0.8,0,%s],[-0.8,0.6,0,%s],[0,0.25,1.125,%s]]) ", number(a), number(b), number(c)); break;
  }
}

static void random_leaf(void) {
  char a[64], b[64], c[64];
  switch (in(0, 9)) {
  case 0: put("sphere(r=%s);\n", positive(a)); break;
  case 1: put("cube([%s,%s,%s],center=%s);\n", positive(a), positive(b), positive(c), in(0, 1) ? "true" : "false"); break;
  case 2: put("cylinder(h=%s,r=%s);\n", positive(a), positive(b)); break;
  case 3: put("cylinder(h=%s,r1=%s,r2=%s,base=[%d,0.5,-3],axis=[%d,%d,1]);\n", positive(a), positive(b), positive(c), in(-4, 4), in(0, 1), in(0, 2)); break;
  case 4: put("ellipsoid(r=[%s,%s,%s]);\n", positive(a), positive(b), positive(c)); break;
  case 5: put("paraboloid(h=%s,r=%s);\n", positive(a), positive(b)); break;
  case 6: put("hyperboloid(h=%s,r=30,rc=%s);\n", positive(a), positive(b)); break;
  case 7: put("quadric([1,2,%d,0.5,%d,1,0.1,-3,%d,-7]);\n", in(-1, 1), in(0, 1), in(-5, 5)); break;
  case 8: put("halfspace(n=[%d,%d,0.1],d=%s);\n", in(-3, 3), in(0, 3), number(a)); break;
  default: put("superquadric(r=[%s,%s,1],e=0.5,n=1.2);\n", positive(a), positive(b)); break;
  }
}

static void QN_SHADOW_random_models(void **unused) {
  (void)unused;
  size_t leaves = 0;
  for (int round = 0; round < share_of(150); round++) {
    at = 0;
    for (int i = in(1, 10); i; i--) {
      for (int depth = in(0, 5); depth; depth--) {
        random_transform();
      }
      random_leaf();
    }
    quoin_scene *s = scene_of(text);
    leaves += s->leaf_count;
    check_shadows(s);
    check_sides(s);
    quoin_scene_free(s);
  }
  print_message("%zu leaves, %zu numbers, %zu exact zeros, %zu rounded\n", leaves, numbers, zeros, roundings);
  assert_true(leaves > share_min(500) && numbers > share_min(10000) && zeros > share_min(2000) && roundings > share_min(2000));
}

/* Sums that cancel, exactly or nearly; and sizes that leave the range of doubles. */
static void hard_numbers(void **unused) {
  (void)unused;
  static const char *const models[] = {
    "translate([5,5,8.1-9+0.9]) sphere(1);",
    "translate([8.1,0,0]) translate([-9,0,0]) translate([0.9,0,0]) cube(1);",
    "translate([1e20,0.1,0]) translate([-1e20,0,0]) sphere(0.1);",
    "translate([1/3,1/7,0]) translate([-1/3,0,1e-30]) sphere(r=1/3);",
    "rotate([0,0,30]) rotate([0,0,60]) cube([1,2,3]);",
    "rotate([0,0,30]) translate([1,0,0]) rotate([0,0,-30]) translate([-sqrt(3)/2,-0.5,0]) cube([1,2,3]);",
    "rotate([17,23,31]) translate([1e-9,1e9,0.1]) rotate([31,-23,5]) cylinder(h=1,r=0.1);",
    "multmatrix([[1,0.1,0,0],[10,1.0000000001,0,0],[0,0,1,0]]) sphere(1);",
    "cylinder(h=5,r=2,base=[4,3,-4],axis=[1,0,0]); cylinder(h=5,r=2,base=[4.1,3.7,-1e6],axis=[1,2,3]);",
    "scale(1e-40) sphere(r=1e30); scale([1e-30,1,1e30]) cube(1);",
    "quadric([0,0,0,1,0,0,0,0,0,-1]); quadric([0,0,0,1,1,1,1,1,1,1]); saddle(a=2,b=3);",
    "translate([1e9,1e9,1e9]) hyperboloid(h=3,r=5,gap=1);",
  };
  for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
    quoin_scene *s = scene_of(models[i]);
    assert_true(s->leaf_count >= 1);
    check_shadows(s);
    check_sides(s);
    quoin_scene_free(s);
  }
  quoin_scene *s = scene_of("translate([5,5,8.1-9+0.9]) sphere(1);");
  assert_true(s->leaves[0].pivot[2] == 0);
  const double *b = &s->quadrics[0].row[0][3];
  assert_true(b[0] == 0 && b[4] == 0 && b[8] == 0); /* a translation by doubles leaves no offset */
  quoin_scene_free(s);
}

/* A number beyond 2^1000 or below 2^-1000 is that size, never 0 or infinite; the boxes are then not relied on. */
static void sizes_beyond_doubles(void **unused) {
  (void)unused;
  quoin_scene *s = scene_of("sphere(r=1e200); translate([0,0,1]) sphere(r=1e-200); scale(1e-350) sphere(1);");
  assert_int_equal(s->leaf_count, 3);
  assert_true(s->quadrics[0].k == -QN_SHADOW_LARGEST);
  assert_true(s->quadrics[1].k == -1 / QN_SHADOW_LARGEST);
  assert_true(s->quadrics[2].row[0][0] == QN_SHADOW_LARGEST);
  for (int i = 0; i < 3; i++) {
    assert_false(s->leaves[i].bounded);
  }
  quoin_scene_free(s);
}

/* Integers beyond 2^100 000 made by nesting: composed exactly, or refused with a status. */
static void deep_products(void **unused) {
  (void)unused;
  at = 0;
  for (int i = 0; i < 300; i++) {
    put("rotate([0,0,37]) translate([0.1,0,1/3]) ");
  }
  put("cube(1);");
  quoin_scene *s = scene_of(text);
  check_shadows(s);
  quoin_scene_free(s);
  at = 0;
  for (int i = 0; i < 600; i++) {
    put("scale([1.1,0.9,1.3]) translate([1e-3,0,1]) ");
  }
  put("cube(1);");
  s = scene_of(text);
  check_shadows(s);
  quoin_scene_free(s);
}

/* What spheres' radii lack of doubles: by the short way, placed, under long and irrational numbers; none is claimed where a map is more than a shift, by however little. */
static void rests_of_spheres(void **unused) {
  (void)unused;
  rests = 0;
  quoin_scene *s = scene_of("translate([0.1,0.2,0.3]) sphere(0.1); sphere(1/3); translate([1/7,0,0]) sphere(0.123456789012345678901234567890); sphere(sqrt(2));"
                            "translate([sqrt(3),0,1]) sphere(cos(20)); sphere(r = 0.7, base = [0.1,0.2,0.3]); sphere(3); ellipsoid(r = [0.3,0.3,0.3]);");
  check_shadows(s);
  assert_int_equal(rests, 8);
  assert_true(s->quadrics[6].k_rest == 0 && s->quadrics[0].k_rest != 0);
  quoin_scene_free(s);
  s = scene_of("scale(1 + 1e-30) sphere(0.1); rotate([0,0,1e-30]) sphere(0.1); scale([1,1,1 + 1e-30]) translate([5,0,0]) sphere(0.1);");
  check_shadows(s);
  assert_int_equal(rests, 8);
  quoin_scene_free(s);
}

/* --- boxes ------------------------------------------------------------------------------------------------------------ */

/* Exact extents of a cube [0, size] under the leaf's exact map: the corners of its three slabs. From the forms: |r_i . x|
   solved is more work than trying the eight corners of the known solid, mapped. */
static void boxes_hold_corners(void **unused) {
  (void)unused;
  size_t tight = 0;
  for (int round = 0; round < share_of(300); round++) {
    at = 0;
    int n = in(0, 3), steps[4][6];
    for (int i = 0; i < n; i++) {
      for (int k = 0; k < 6; k++) {
        steps[i][k] = in(-30, 30);
      }
      steps[i][3] |= 1;
      /* A shear and a shift, in tenths. */
      put("multmatrix([[%d/10,%d/10,0,%d/10],[0,1,%d/10,%d/10],[0.1,0,1,%d/10]]) ", steps[i][3], steps[i][4], steps[i][0], steps[i][5], steps[i][1], steps[i][2]);
    }
    put("cube([1,2,0.3]);");
    quoin_scene *s = scene_of(text);
    if (s->leaf_count == 0) { /* singular */
      quoin_scene_free(s);
      continue;
    }
    const qn_leaf *leaf = &s->leaves[0];
    assert_true(leaf->bounded);
    mpq_t x[3], y[3], low[3], high[3], t, u;
    mpq_inits(t, u, NULL);
    for (int k = 0; k < 3; k++) {
      mpq_inits(x[k], y[k], low[k], high[k], NULL);
    }
    for (int corner = 0; corner < 8; corner++) {
      mpq_set_si(x[0], corner & 1, 1);
      mpq_set_si(x[1], corner & 2, 1);
      mpq_set_si(x[2], corner & 4 ? 3 : 0, 10);
      mpq_canonicalize(x[2]);
      for (int i = n; i-- > 0;) {
        const int *p = steps[i];
        int m[3][4] = {{p[3], p[4], 0, p[0]}, {0, 10, p[5], p[1]}, {1, 0, 10, p[2]}};
        for (int r = 0; r < 3; r++) {
          mpq_set_si(y[r], m[r][3], 10);
          mpq_canonicalize(y[r]);
          for (int k = 0; k < 3; k++) {
            mpq_set_si(t, m[r][k], 10);
            mpq_canonicalize(t);
            mpq_mul(t, t, x[k]);
            mpq_add(y[r], y[r], t);
          }
        }
        for (int k = 0; k < 3; k++) {
          mpq_set(x[k], y[k]);
        }
      }
      for (int k = 0; k < 3; k++) {
        mpq_set_d(t, leaf->min[k]);
        mpq_set_d(u, leaf->max[k]);
        assert_true(mpq_cmp(t, x[k]) <= 0 && mpq_cmp(x[k], u) <= 0);
        if (corner == 0 || mpq_cmp(x[k], low[k]) < 0) {
          mpq_set(low[k], x[k]);
        }
        if (corner == 0 || mpq_cmp(x[k], high[k]) > 0) {
          mpq_set(high[k], x[k]);
        }
      }
    }
    for (int k = 0; k < 3; k++) { /* and not wide of it */
      double size = fabs(leaf->min[k]) + fabs(leaf->max[k]) + 1000;
      tight += leaf->max[k] - mpq_get_d(high[k]) < 64 * QN_U * size && mpq_get_d(low[k]) - leaf->min[k] < 64 * QN_U * size;
    }
    for (int k = 0; k < 3; k++) {
      mpq_clears(x[k], y[k], low[k], high[k], NULL);
    }
    mpq_clears(t, u, NULL);
    quoin_scene_free(s);
  }
  assert_true(tight > share_min(800));
}

static void boxes_of_aligned_solids_are_exact(void **unused) {
  (void)unused;
  quoin_scene *s = scene_of("translate([1,2,3]) cube([10,20,30]);");
  for (int k = 0; k < 3; k++) {
    assert_true(s->leaves[0].min[k] == k + 1 && s->leaves[0].max[k] == k + 1 + 10 * (k + 1));
    assert_true(s->min[k] == k + 1 && s->max[k] == k + 1 + 10 * (k + 1));
  }
  quoin_scene_free(s);
  s = scene_of("rotate([0,90,0]) cylinder(h=7,r=3); ellipsoid(r=[4,5,6]); sphere(0.1);");
  const double max[3][3] = {{7, 3, 3}, {4, 5, 6}, {0.1, 0.1, 0.1}}, min[3][3] = {{0, -3, -3}, {-4, -5, -6}, {-0.1, -0.1, -0.1}};
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++) {
      assert_true(s->leaves[i].max[k] == max[i][k] && s->leaves[i].min[k] == min[i][k]); /* the double 0.1 is above 1/10 */
    }
  }
  quoin_scene_free(s);
}

static void boxes_without_bound(void **unused) {
  (void)unused;
  quoin_scene *s = scene_of("halfspace(n=[0,0,1],d=2);");
  assert_false(s->leaves[0].bounded);
  assert_int_equal(s->unbounded_count, 1);
  assert_true(s->leaves[0].max[2] >= 2 && s->leaves[0].max[2] < 2.0001 && isinf(s->leaves[0].min[2]) && isinf(s->leaves[0].max[0]));
  quoin_scene_info info;
  quoin_scene_get_info(s, &info);
  assert_true(info.unbounded && !info.empty);
  quoin_scene_free(s);
  s = scene_of("rotate([10,0,0]) halfspace(n=[0,0,1],d=2);");
  assert_true(isinf(s->leaves[0].max[2]));
  quoin_scene_free(s);
  s = scene_of("intersection() { cube(10); halfspace(n=[0,0,1],d=2); }"); /* the tree's box is the meet */
  assert_true(s->min[2] == 0 && s->max[2] >= 2 && s->max[2] < 2.0001);
  quoin_scene_get_info(s, &info);
  assert_false(info.unbounded);
  quoin_scene_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(QN_SHADOW_random_models), cmocka_unit_test(hard_numbers), cmocka_unit_test(sizes_beyond_doubles),
    cmocka_unit_test(deep_products), cmocka_unit_test(rests_of_spheres), cmocka_unit_test(boxes_hold_corners), cmocka_unit_test(boxes_of_aligned_solids_are_exact),
    cmocka_unit_test(boxes_without_bound),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
