/* Wide code's certificates against exact arithmetic. Random pieces and packets, biased towards tangents, apexes, generators, cancellation, thin
   and far ones; every stored number is taken to be off by what its contract allows. A lane that is called sure must be right: a miss leaves no
   stretch of positive length; a hit is one stretch, whose ends are the named roots within `error` of the exact ones.
   Names of the bounds as in base/bounds.h. */
#define QN_LANES_NOW 64
#if !defined(QN_ISA_AVX2) && !defined(QN_ISA_AVX512) /* those that the machine has run too: tests/CMakeLists.txt */
#define QN_ISA_SSE2 /* products and sums rounded apart: the worst of the bodies */
#endif
#include "dice.h"
#include "share.h"
#include "wide/facts.h"

#include <gmp.h>
#include <mpfr.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

static double part(void) { return part_of(3, 4); } /* in [-1, 1], with few or many bits */

/* --- exact half-spaces along a line ------------------------------------------------------------------------------------- */

enum { BITS = 500, MOST = 8 };

/* q <= 0 with q = A t^2 + 2 H t + C exactly. */
typedef struct exact_half {
  int plane;
  mpq_t row[3][4], s[3], l, k; /* a plane is row[0] */
  uint32_t surface;
  mpq_t a, h, c, disc;
  mpfr_t root[2];
  int roots, first_in, vague; /* first_in: holds before the first root */
} exact_half;

static exact_half halves[MOST];
static int half_count;
static mpq_t q_x, q_y, q_o[3], q_d[3], q_X, q_D;
static mpfr_t f_x, f_y, f_a[2], f_b[2];

static void start_exact(void) {
  mpfr_set_default_prec(BITS);
  mpq_inits(q_x, q_y, q_X, q_D, NULL);
  mpfr_inits(f_x, f_y, f_a[0], f_a[1], f_b[0], f_b[1], NULL);
  for (int i = 0; i < 3; i++) {
    mpq_inits(q_o[i], q_d[i], NULL);
  }
  for (int n = 0; n < MOST; n++) {
    exact_half *e = &halves[n];
    mpq_inits(e->l, e->k, e->a, e->h, e->c, e->disc, NULL);
    mpfr_inits(e->root[0], e->root[1], NULL);
    for (int i = 0; i < 3; i++) {
      mpq_init(e->s[i]);
      for (int j = 0; j < 4; j++) {
        mpq_init(e->row[i][j]);
      }
    }
  }
}

/* A number that v may stand for: v (1 + theta u), |theta| <= 1, or 0. */
static void nearly(mpq_t out, double v) {
  mpq_set_d(out, v);
  mpq_set_d(q_x, one_in(3) ? 0 : one_in(2) ? part() : one_in(2) ? 1 : -1);
  mpq_div_2exp(q_x, q_x, 53);
  mpq_mul(q_x, q_x, out);
  mpq_add(out, out, q_x);
}

static void row_along(mpq_t row[4], mpq_t X, mpq_t D) {
  mpq_set(X, row[3]);
  mpq_set_ui(D, 0, 1);
  for (int j = 0; j < 3; j++) {
    mpq_mul(q_x, row[j], q_o[j]);
    mpq_add(X, X, q_x);
    mpq_mul(q_x, row[j], q_d[j]);
    mpq_add(D, D, q_x);
  }
}

/* Its roots along the line in q_o (from the pivot) and q_d. */
static void solve_exactly(exact_half *e) {
  mpq_set_ui(e->a, 0, 1);
  mpq_set_ui(e->h, 0, 1);
  mpq_set_ui(e->c, 0, 1);
  e->roots = e->vague = 0;
  if (e->plane) {
    row_along(e->row[0], e->c, e->h);
    mpq_div_2exp(e->h, e->h, 1);
  } else {
    mpq_set(e->c, e->k);
    for (int i = 0; i < 3; i++) {
      row_along(e->row[i], q_X, q_D);
      mpq_mul(q_y, e->s[i], q_D);
      mpq_mul(q_x, q_y, q_D);
      mpq_add(e->a, e->a, q_x);
      mpq_mul(q_x, q_y, q_X);
      mpq_add(e->h, e->h, q_x);
      mpq_mul(q_y, e->s[i], q_X);
      mpq_mul(q_y, q_y, q_X);
      mpq_add(e->c, e->c, q_y);
    }
    mpq_mul(q_x, e->l, q_D); /* of row 2 */
    mpq_add(e->h, e->h, q_x);
    mpq_mul(q_x, e->l, q_X);
    mpq_mul_2exp(q_x, q_x, 1);
    mpq_add(e->c, e->c, q_x);
  }
  if (mpq_sgn(e->a) == 0) {
    e->first_in = mpq_sgn(e->h) > 0;
    if (mpq_sgn(e->h) == 0) {
      e->first_in = mpq_sgn(e->c) <= 0;
      e->vague = mpq_sgn(e->c) == 0;
      return;
    }
    mpq_div(q_x, e->c, e->h);
    mpq_div_2exp(q_x, q_x, 1);
    mpq_neg(q_x, q_x);
    mpfr_set_q(e->root[0], q_x, MPFR_RNDN);
    e->roots = 1;
    return;
  }
  e->first_in = mpq_sgn(e->a) < 0;
  mpq_mul(e->disc, e->h, e->h);
  mpq_mul(q_x, e->a, e->c);
  mpq_sub(e->disc, e->disc, q_x);
  if (mpq_sgn(e->disc) <= 0) {
    return; /* a touch changes nothing */
  }
  e->roots = 2;
  mpfr_set_q(f_x, e->disc, MPFR_RNDN);
  mpfr_sqrt(f_x, f_x, MPFR_RNDN);
  mpfr_set_q(f_y, e->h, MPFR_RNDN);
  int low = mpq_sgn(e->a) > 0 ? 0 : 1;
  /* the one without cancellation, the other by the product of the roots */
  int far = mpfr_sgn(f_y) > 0 ? 0 : 1;
  far ? mpfr_sub(f_x, f_x, f_y, MPFR_RNDN) : mpfr_add(f_x, f_x, f_y, MPFR_RNDN); /* |h| + sqrt disc */
  mpq_div(q_x, e->c, e->a);
  mpfr_t *one = &e->root[far ? 1 - low : low], *other = &e->root[far ? low : 1 - low];
  mpfr_div_q(*one, f_x, e->a, MPFR_RNDN);
  if (!far) {
    mpfr_neg(*one, *one, MPFR_RNDN);
  }
  mpfr_set_q(*other, q_x, MPFR_RNDN);
  mpfr_div(*other, *other, *one, MPFR_RNDN);
  assert_true(mpfr_cmp(e->root[0], e->root[1]) <= 0);
}

/* The meet of all halves as at most 8 stretches; -inf and inf where it has no end. */
typedef struct exact_stretch { mpfr_t a, b; int ha, hb, ra, rb; } exact_stretch; /* halves and roots of the ends, -1: none */
static exact_stretch list[2][16];
static int list_count;

static int later(int h1, int r1, int h2, int r2) { /* of two entries; -1 is -inf */
  return h1 >= 0 && (h2 < 0 || mpfr_cmp(halves[h1].root[r1], halves[h2].root[r2]) > 0);
}
static int sooner(int h1, int r1, int h2, int r2) {
  return h1 >= 0 && (h2 < 0 || mpfr_cmp(halves[h1].root[r1], halves[h2].root[r2]) < 0);
}

/* Returns 1 when the line runs in a surface that matters. */
static int meet_exactly(void) {
  int now = 0, vague = 0;
  list_count = 1;
  list[0][0].ha = list[0][0].hb = -1;
  for (int n = 0; n < half_count; n++) {
    exact_half *e = &halves[n];
    vague |= e->vague;
    int out = 0;
    for (int i = 0; i < list_count; i++) {
      for (int p = e->first_in ? 0 : 1; p <= e->roots; p += 2) { /* the part between root p - 1 and root p */
        exact_stretch *s = &list[1 - now][out], *from = &list[now][i];
        s->ha = from->ha, s->ra = from->ra, s->hb = from->hb, s->rb = from->rb;
        if (p > 0 && later(n, p - 1, s->ha, s->ra)) {
          s->ha = n, s->ra = p - 1;
        }
        if (p < e->roots && sooner(n, p, s->hb, s->rb)) {
          s->hb = n, s->rb = p;
        }
        out += s->ha < 0 || s->hb < 0 || mpfr_cmp(halves[s->ha].root[s->ra], halves[s->hb].root[s->rb]) < 0;
        assert_true(out < 15);
      }
    }
    now = 1 - now;
    list_count = out;
  }
  if (now) {
    for (int i = 0; i < list_count; i++) {
      list[0][i].ha = list[1][i].ha, list[0][i].ra = list[1][i].ra, list[0][i].hb = list[1][i].hb, list[0][i].rb = list[1][i].rb;
    }
  }
  return vague && list_count > 0;
}

static quoin_scene scene; /* its box is all that is used */
static walk state_of_walk;

/* --- judging a stretch ---------------------------------------------------------------------------------------------------- */

typedef struct census { unsigned lanes, hits, misses, unsure, ends, split, vague; double ratio; } census;

static void judge_end(double t, double error, double payload, int h, int r, census *c) {
  uint64_t bits;
  memcpy(&bits, &payload, sizeof bits);
  if (h < 0 || fabs(t) == QN_FAR) { /* planes that are met beyond reach only need not be there */
    assert_true(fabs(t) == QN_FAR && (h < 0 || fabs(mpfr_get_d(halves[h].root[r], MPFR_RNDN)) > state_of_walk.f.reach));
    assert_int_equal((uint32_t)bits, QN_NOBODY);
    return;
  }
  mpfr_set_d(f_x, t, MPFR_RNDN);
  mpfr_sub(f_x, f_x, halves[h].root[r], MPFR_RNDN);
  mpfr_abs(f_x, f_x, MPFR_RNDN);
  mpfr_div_d(f_y, f_x, error, MPFR_RNDN);
  double ratio = error > 0 ? mpfr_get_d(f_y, MPFR_RNDU) : mpfr_zero_p(f_x) ? 0 : INFINITY;
  if (!(ratio <= 1)) {
    print_message("an end is off by %g of its error: t %.17g, error %g, half %d (%s) root %d of %d\n", ratio, t, error, h, halves[h].plane ? "plane" : "body", r, halves[h].roots);
  }
  assert_true(ratio <= 1);
  assert_int_equal((uint32_t)bits, halves[h].surface);
  assert_int_equal((bits & QN_LARGER_ROOT) != 0, r);
  c->ratio = fmax(c->ratio, ratio);
  c->ends++;
}

/* The places nearest to the exact ones are 0.5 ulp off at best, so an error below is out of the question; far from 1 it is loose. */
static void judge(const qn_packet *p, const double pivot[3], const stretch *s, int g, census *c) {
  _Alignas(64) double a[QN_W], b[QN_W], pa[QN_W], pb[QN_W], error[QN_W];
  vstore(a, s->a), vstore(b, s->b), vstore(pa, s->pa), vstore(pb, s->pb), vstore(error, s->error);
  unsigned hit = vbits(s->hit), unsure = vbits(s->unsure);
  assert_int_equal(hit & unsure, 0);
  for (int i = 0; i < QN_W; i++) {
    c->lanes++;
    if (unsure >> i & 1) {
      c->unsure++;
      continue;
    }
    for (int j = 0; j < 3; j++) {
      mpq_set_d(q_o[j], p->o[j][g * QN_W + i]);
      mpq_set_d(q_x, pivot[j]);
      mpq_sub(q_o[j], q_o[j], q_x);
      mpq_set_d(q_d[j], p->d[j][g * QN_W + i]);
    }
    for (int n = 0; n < half_count; n++) {
      solve_exactly(&halves[n]);
    }
    int vague = meet_exactly();
    c->vague += (unsigned)vague;
    c->split += list_count > 1;
    if (!(hit >> i & 1)) {
      if (list_count != 0) {
        print_message("a miss that is none, lane %d: %d stretches, %a %a %a  %a %a %a\n", g * QN_W + i, list_count, p->o[0][g * QN_W + i], p->o[1][g * QN_W + i], p->o[2][g * QN_W + i],
                      p->d[0][g * QN_W + i], p->d[1][g * QN_W + i], p->d[2][g * QN_W + i]);
      }
      assert_int_equal(list_count, 0);
      c->misses++;
      continue;
    }
    assert_false(vague);
    assert_int_equal(list_count, 1);
    judge_end(a[i], error[i], pa[i], list[0][0].ha, list[0][0].ra, c);
    judge_end(b[i], error[i], pb[i], list[0][0].hb, list[0][0].rb, c);
    c->hits++;
  }
}

/* --- pieces and packets ----------------------------------------------------------------------------------------------------- */

typedef struct piece {
  double pivot[3], row[3][4], s[3], l, k, cap[2][4], reach, size[3]; /* the leaf is within |X_i| <= size[i] */
  int caps, bodies;
  double back[3][3]; /* world y = back . (X - b) */
} piece;

static void turn(double m[3][3]) {
  double q[4] = {part(), part(), part(), part()}, n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  if (one_in(2) || n < 0.01) { /* along the axes */
    int a = below(3), b = (a + 1 + below(2)) % 3;
    memset(m, 0, 9 * sizeof(double));
    m[0][a] = one_in(2) ? 1 : -1, m[1][b] = one_in(2) ? 1 : -1, m[2][3 - a - b] = one_in(2) ? 1 : -1;
    return;
  }
  double w = q[0], x = q[1], y = q[2], z = q[3], s = 2 / n;
  double r[3][3] = {{1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)},
                    {s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)},
                    {s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)}};
  memcpy(m, r, sizeof r);
}

/* A canonical body in its frame, under a turn and a scale along its axes. */
static void make_piece(piece *p, double far) {
  static const struct { double s[3], l, k, size[3], caps[2][2]; int count; } bodies[] = {
    {{1, 1, 1}, 0, -1, {1, 1, 1}, {{0, 0}, {0, 0}}, 0},          /* ellipsoid */
    {{1, 1, 0}, 0, -1, {1, 1, 2}, {{-1, 0}, {1, -2}}, 2},        /* cylinder: 0 <= X2 <= 2 */
    {{1, 1, -1}, 0, 0, {2, 2, 2}, {{-1, 0}, {1, -2}}, 2},        /* cone, with its apex in a cap */
    {{1, 1, -1}, 0, 0, {2, 2, 2}, {{-1, 0.5}, {1, -2}}, 2},      /* frustum */
    {{1, 1, -1}, 0, 0, {2, 2, 2}, {{-1, -2}, {1, -2}}, 2},       /* both nappes */
    {{1, 1, 0}, -0.5, 0, {2, 2, 4}, {{1, -4}, {0, 0}}, 1},       /* paraboloid */
    {{1, 1, -1}, 0, -1, {2.3, 2.3, 2}, {{-1, -2}, {1, -2}}, 2},  /* one sheet */
    {{1, 1, -1}, 0, 1, {2, 2, 2}, {{-1, -2}, {1, -2}}, 2},       /* two sheets */
    {{1, 1, -1}, 0, 1, {2, 2, 2}, {{-1, 0}, {1, -2}}, 2},        /* one of two sheets */
    {{1, 0.25, 0}, 0, -1, {1, 2, 2}, {{-1, 0}, {1, -2}}, 2},     /* elliptic cylinder */
  };
  memset(p, 0, sizeof *p);
  int kind = below((int)(sizeof bodies / sizeof *bodies));
  double r[3][3], scale[3], common = ldexp(1, one_in(3) ? below(40) - 20 : 0);
  turn(r);
  for (int i = 0; i < 3; i++) {
    scale[i] = common * (one_in(3) ? 1 + 0.3 * part() : 1);
  }
  if (one_in(4)) {
    scale[below(3)] *= ldexp(1, -below(24));
  }
  for (int i = 0; i < 3; i++) {
    p->pivot[i] = one_in(3) ? 0 : far * part();
    p->s[i] = bodies[kind].s[i], p->size[i] = bodies[kind].size[i];
    p->row[i][3] = one_in(2) ? 0 : ldexp(part(), -below(54));
    for (int j = 0; j < 3; j++) {
      p->row[i][j] = r[i][j] / scale[i];
      p->back[j][i] = r[i][j] * scale[i];
    }
  }
  p->l = bodies[kind].l, p->k = bodies[kind].k, p->caps = bodies[kind].count;
  double unit = one_in(3) ? 1 + 0.3 * part() : 1; /* the form times any positive number */
  for (int i = 0; i < 3; i++) {
    p->s[i] *= unit;
  }
  p->l *= unit, p->k *= unit;
  p->bodies = 1;
  for (int c = 0; c < p->caps; c++) {
    for (int j = 0; j < 4; j++) {
      p->cap[c][j] = bodies[kind].caps[c][0] * p->row[2][j];
    }
    p->cap[c][3] += bodies[kind].caps[c][1];
  }
  for (int i = 0; i < 3; i++) {
    p->reach += p->size[i] * p->size[i];
  }
  p->reach = sqrt(p->reach) * 1.001;
}

static void to_world(const piece *p, const double X[3], int point, double out[3]) {
  for (int j = 0; j < 3; j++) {
    out[j] = point ? p->pivot[j] : 0;
    for (int i = 0; i < 3; i++) {
      out[j] += p->back[j][i] * (X[i] - (point ? p->row[i][3] : 0));
    }
  }
}

/* A point of interest of the piece in its own frame, and a direction in which a line through it is special. */
static void aim(const piece *p, double X[3], double D[3]) {
  double angle = one_in(2) ? 0.78539816339744831 * below(8) : 3.14159265 * part(), c = cos(angle), s = sin(angle);
  double z = one_in(3) ? (p->caps ? 2 * below(2) : 0) : 2 * part();
  double rad2 = p->s[0] > 0 ? -(p->k + p->s[2] * z * z + 2 * p->l * z) / p->s[0] : 1;
  double rad = rad2 > 0 ? sqrt(rad2) : 0;
  X[0] = rad * c, X[1] = rad * s * (p->s[1] > 0 ? sqrt(p->s[0] / p->s[1]) : 1), X[2] = z;
  switch (below(6)) {
  case 0: D[0] = -s, D[1] = c, D[2] = 0; break;                          /* tangent */
  case 1: D[0] = X[0], D[1] = X[1], D[2] = one_in(2) ? z : 1; break;      /* a generator of a cone */
  case 2: D[0] = D[1] = 0, D[2] = 1; break;                              /* along the axis */
  case 3: D[0] = 1, D[1] = 0, D[2] = one_in(2) ? 1 : 0; break;
  case 4: D[0] = c - s, D[1] = s + c, D[2] = 1; break;                   /* a ruling of the hyperboloid, where z = 0 */
  default: D[0] = part(), D[1] = part(), D[2] = part(); break;
  }
  if (one_in(4)) { /* nearly */
    double off = ldexp(1, -below(60));
    for (int i = 0; i < 3; i++) {
      X[i] += off * part();
    }
  }
  if (one_in(4)) {
    double off = ldexp(1, -below(60));
    for (int i = 0; i < 3; i++) {
      D[i] += off * part();
    }
  }
  if (D[0] == 0 && D[1] == 0 && D[2] == 0) {
    D[0] = 1;
  }
}

static void make_packet(const piece *p, qn_packet *k) {
  double X[3], D[3], o[3], d[3], u[3], v[3];
  aim(p, X, D);
  int converging = one_in(2), wild = one_in(6), same = one_in(6);
  double back = one_in(3) ? ldexp(1, below(40)) : 4 * part(), wide = same ? 0 : ldexp(1, one_in(2) ? 0 : -below(40)), lift = one_in(3) ? ldexp(1, below(60) - 30) : 1;
  for (int lane = 0; lane < QN_LANES; lane++) {
    if (wild) {
      aim(p, X, D);
    }
    to_world(p, X, 1, o), to_world(p, D, 0, d);
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), size = 0;
    if (lane == 0) {
      for (int i = 0; i < 3; i++) {
        u[i] = one_in(2) ? 0 : part(), v[i] = one_in(2) ? 0 : part();
      }
    }
    for (int i = 0; i < 3; i++) {
      size = fmax(size, fabs(p->back[i][0]) + fabs(p->back[i][1]) + fabs(p->back[i][2]));
    }
    double x = qn_lane_column((unsigned)lane) - 3.0, y = qn_lane_row((unsigned)lane) - 4.0; /* lane 0 up to rounding is not the one aimed at: lane (3, 4) is */
    for (int i = 0; i < 3; i++) {
      double step = wide * (x * u[i] + y * v[i]);
      double towards = d[i] / length + (converging ? step : 0);
      k->o[i][lane] = o[i] - back * size * d[i] / length + (converging ? 0 : step * size);
      k->d[i][lane] = lift * size * towards;
    }
    if (k->d[0][lane] == 0 && k->d[1][lane] == 0 && k->d[2][lane] == 0) {
      k->d[0][lane] = lift * size;
    }
    k->from[lane] = -INFINITY, k->to[lane] = INFINITY;
  }
  k->live = ~(uint64_t)0;
  k->few = 0, k->tile = QN_TILE_NONE, k->new_origins = k->new_directions = 1, k->kept_ranges = 0;
}

/* --- the tests ---------------------------------------------------------------------------------------------------------------- */

static void report(const char *name, const census *c) {
  print_message("%-8s lanes %u: hits %u, misses %u, unsure %u (%.1f%%), two stretches %u, worst error/bound %.4f\n", name, c->lanes, c->hits, c->misses, c->unsure,
                100.0 * c->unsure / c->lanes, c->split, c->ratio);
}

static qn_packet packet;
/* Facts of the packet, in a scene whose box holds the piece. 0: out of range. */
static int facts_of(const piece *p) {
  for (int j = 0; j < 3; j++) {
    double size = 0;
    for (int i = 0; i < 3; i++) {
      size += fabs(p->back[j][i]) * (p->size[i] + fabs(p->row[i][3])) * 1.001;
    }
    scene.min[j] = p->pivot[j] - size, scene.max[j] = p->pivot[j] + size;
  }
  state_of_walk.scene = &scene;
  return facts(&state_of_walk, &packet);
}

static void exact_plane(int n, const double row[4], uint32_t surface) {
  halves[n].plane = 1, halves[n].surface = surface;
  for (int j = 0; j < 4; j++) {
    nearly(halves[n].row[0][j], row[j]);
  }
}

static void bodies_and_caps(void **state) {
  (void)state;
  census c = {0};
  size_t slabs = 0;
  for (int round = 0; round < share_of(1500); round++) {
    piece p;
    make_piece(&p, one_in(4) ? ldexp(1, below(50)) : 1);
    make_packet(&p, &packet);
    if (!facts_of(&p)) {
      continue;
    }
    plane_constants caps[2];
    slab_constants both;
    body_constants body;
    const int slab = p.caps == 2 && one_in(2) && p.cap[0][0] == -p.cap[1][0] && p.cap[0][1] == -p.cap[1][1] && p.cap[0][2] == -p.cap[1][2];
    half_count = 0;
    if (slab) {
      slab_prepare(&state_of_walk.f, p.pivot, p.cap[0], p.cap[0][3], p.cap[1][3], 10, 11, 3, &both);
      slabs++;
    }
    for (int n = 0; n < p.caps; n++) {
      plane_prepare(&state_of_walk.f, p.pivot, p.cap[n], p.cap[n][3], 10 + (uint32_t)n, 3, &caps[n]);
      exact_plane(half_count++, p.cap[n], 10 + (uint32_t)n);
    }
    if (p.bodies) {
      body_prepare(&state_of_walk.f, p.pivot, (const double(*)[4])p.row, p.s, p.l, p.k, p.reach, 7, 3, &body);
      exact_half *e = &halves[half_count++];
      e->plane = 0, e->surface = 7;
      for (int i = 0; i < 3; i++) {
        nearly(e->s[i], p.s[i]);
        for (int j = 0; j < 4; j++) {
          nearly(e->row[i][j], p.row[i][j]);
        }
      }
      nearly(e->l, p.l), nearly(e->k, p.k);
    }
    for (int g = 0; g < QN_GROUPS; g++) {
      const vd nobody = vset(payload_bits(QN_NOBODY));
      stretch s = {.a = vset(-QN_FAR), .b = vset(QN_FAR), .pa = nobody, .pb = nobody, .error = vset(0), .hit = vmask(QN_ALL_BITS), .unsure = vmask(0)};
      vd y[3], d[3];
      for (int i = 0; i < 3; i++) {
        y[i] = vsub(vload(packet.o[i] + g * QN_W), vset(p.pivot[i])), d[i] = vload(packet.d[i] + g * QN_W);
      }
      if (slab) {
        slab_meet(&state_of_walk.f, &both, y, d, &s);
      }
      for (int n = 0; n < p.caps && !slab; n++) {
        plane_meet(&state_of_walk.f, &caps[n], y, d, &s);
      }
      if (p.bodies) {
        body_meet(&body, y, d, &s);
      }
      stretch_settle(&s);
      judge(&packet, p.pivot, &s, g, &c);
    }
  }
  report("bodies", &c);
  assert_true(c.hits > share_min(10000) && c.misses > share_min(10000) && c.unsure > share_min(1000) && c.unsure < c.lanes / 2 && slabs > share_min(200));
}

static void spheres(void **state) {
  (void)state;
  census c = {0};
  for (int round = 0; round < share_of(800); round++) {
    piece p;
    do {
      make_piece(&p, one_in(4) ? ldexp(1, below(50)) : 1);
    } while (p.caps);
    double r = ldexp(1 + 0.5 * part(), below(40) - 20), off = one_in(2) ? 0 : ldexp(r, -20 - below(40));
    for (int i = 0; i < 3; i++) {
      p.size[i] = 1, p.row[i][3] = 0;
      for (int j = 0; j < 3; j++) {
        p.row[i][j] = i == j ? 1 / r : 0, p.back[i][j] = i == j ? r : 0;
      }
      p.s[i] = 1;
    }
    p.k = -1, p.l = 0;
    make_packet(&p, &packet);
    if (!facts_of(&p)) {
      continue;
    }
    qn_piece_sphere stored = {.head = {QN_PIECE_SPHERE, 0, 3}, .centre = {p.pivot[0], p.pivot[1], p.pivot[2]}, .r2 = r * r, .off = qn_round_up(off), .surface = 7};
    sphere_constants k;
    sphere_prepare(&state_of_walk.f, &stored, &k);
    half_count = 1;
    exact_half *e = &halves[0];
    e->plane = 0, e->surface = 7;
    for (int i = 0; i < 3; i++) { /* |y - centre|^2 - r^2, the centre off by `off`, the radius' square by 8u, each square by 5u: see stored.h */
      for (int j = 0; j < 4; j++) {
        mpq_set_d(e->row[i][j], i == j ? 1 : j == 3 ? off * (one_in(3) ? 1 : part()) : 0);
      }
      mpq_set_d(e->s[i], 1 + (one_in(2) ? 0 : 4 * part() * 0x1p-52));
    }
    mpq_set_ui(e->l, 0, 1);
    mpq_set_d(e->k, -r * r);
    mpq_set_d(q_x, 1 + (one_in(2) ? 0 : 4 * part() * 0x1p-52));
    mpq_mul(e->k, e->k, q_x);
    for (int g = 0; g < QN_GROUPS; g++) {
      stretch s = sphere_solve(&state_of_walk.f, &k, g);
      judge(&packet, p.pivot, &s, g, &c);
    }
  }
  report("spheres", &c);
  assert_true(c.hits > share_min(5000) && c.misses > share_min(5000) && c.unsure > share_min(100) && c.unsure < c.lanes / 2);
}

static void boxes(void **state) {
  (void)state;
  census c = {0};
  for (int round = 0; round < share_of(800); round++) {
    piece p;
    do {
      make_piece(&p, one_in(4) ? ldexp(1, below(50)) : 1);
    } while (p.caps);
    qn_piece_box stored = {.head = {.kind = QN_PIECE_BOX, .flags = 3}, .off = one_in(2) ? 0 : ldexp(1, -20 - below(40))};
    for (int i = 0; i < 3; i++) {
      double size = ldexp(1 + 0.5 * part(), one_in(3) ? -below(30) : 0);
      stored.lo[i] = p.pivot[i] - size, stored.hi[i] = p.pivot[i] + size;
      stored.surface[2 * i] = 10 + 2 * (uint32_t)i, stored.surface[2 * i + 1] = 11 + 2 * (uint32_t)i;
      p.size[i] = 1.0 + stored.off / size, p.row[i][3] = 0;
      for (int j = 0; j < 3; j++) {
        p.row[i][j] = i == j ? 1 / size : 0, p.back[i][j] = i == j ? size : 0;
      }
    }
    make_packet(&p, &packet);
    if (one_in(2)) { /* along edges and faces */
      int axis = below(3);
      for (int lane = 0; lane < QN_LANES; lane++) {
        for (int i = 0; i < 3; i++) {
          packet.d[i][lane] = i == axis ? 1 : 0;
          packet.o[i][lane] = one_in(3) ? stored.lo[i] : one_in(2) ? stored.hi[i] : p.pivot[i] + part() * 2;
        }
      }
    }
    if (!facts_of(&p)) {
      continue;
    }
    box_constants k;
    box_prepare(&state_of_walk.f, &stored, &k);
    half_count = 6;
    for (int n = 0; n < 6; n++) {
      exact_half *e = &halves[n];
      int axis = n / 2, high = n & 1;
      e->plane = 1, e->surface = stored.surface[n];
      for (int j = 0; j < 3; j++) {
        mpq_set_si(e->row[0][j], j == axis ? (high ? 1 : -1) : 0, 1);
      }
      mpq_set_d(e->row[0][3], (high ? stored.hi : stored.lo)[axis]); /* from the pivot, off by `off` */
      mpq_set_d(q_x, p.pivot[axis]);
      mpq_sub(e->row[0][3], e->row[0][3], q_x);
      mpq_set_d(q_x, stored.off * (one_in(3) ? 1 : part()));
      mpq_add(e->row[0][3], e->row[0][3], q_x);
      if (high) {
        mpq_neg(e->row[0][3], e->row[0][3]);
      }
    }
    for (int g = 0; g < QN_GROUPS; g++) {
      stretch s = box_solve(&state_of_walk.f, &k, g);
      judge(&packet, p.pivot, &s, g, &c);
    }
  }
  report("boxes", &c);
  assert_true(c.hits > share_min(5000) && c.misses > share_min(5000) && c.unsure > share_min(100));
}

/* Planes in any number and place, within a ball: edges, corners, planes that the line nearly runs in. */
static void planes(void **state) {
  (void)state;
  census c = {0};
  for (int round = 0; round < share_of(1500); round++) {
    piece p;
    do {
      make_piece(&p, one_in(4) ? ldexp(1, below(50)) : 1);
    } while (p.caps);
    int count = 1 + below(5);
    plane_constants k[5];
    make_packet(&p, &packet);
    if (!facts_of(&p)) {
      continue;
    }
    sphere_constants ball; /* of the box of the scene, so that what is beyond reach does not count */
    qn_piece_sphere stored = {.head = {QN_PIECE_SPHERE, 0, 3}, .centre = {p.pivot[0], p.pivot[1], p.pivot[2]}, .surface = 30};
    for (int j = 0; j < 3; j++) {
      double size = 0.5 * (scene.max[j] - scene.min[j]) * 0.9;
      stored.r2 = j == 0 ? size * size : fmin(stored.r2, size * size);
    }
    sphere_prepare(&state_of_walk.f, &stored, &ball);
    half_count = 0;
    for (int n = 0; n < count; n++) {
      double X[3], D[3], row[4] = {0, 0, 0, 0}, *o[3] = {packet.o[0], packet.o[1], packet.o[2]};
      aim(&p, X, D);
      for (int i = 0; i < 3; i++) {
        row[i] = one_in(3) ? 0 : part();
      }
      if (one_in(2)) { /* nearly, or just, along lane 35 */
        row[0] = packet.d[1][35], row[1] = -packet.d[0][35], row[2] = 0;
        double most_of_it = fmax(fabs(row[0]), fabs(row[1]));
        if (most_of_it > 0) {
          row[0] /= most_of_it, row[1] /= most_of_it;
        }
      }
      if (row[0] == 0 && row[1] == 0 && row[2] == 0) {
        row[2] = 1;
      }
      for (int i = 0; i < 3; i++) {
        row[3] -= row[i] * (one_in(2) ? o[i][35] - p.pivot[i] : p.back[i][0] * part());
      }
      plane_prepare(&state_of_walk.f, p.pivot, row, row[3], 10 + (uint32_t)n, 3, &k[n]);
      exact_plane(half_count++, row, 10 + (uint32_t)n);
    }
    exact_half *e = &halves[half_count++];
    e->plane = 0, e->surface = 30;
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 4; j++) {
        mpq_set_ui(e->row[i][j], i == j, 1);
      }
      mpq_set_ui(e->s[i], 1, 1);
    }
    mpq_set_ui(e->l, 0, 1);
    mpq_set_d(e->k, -stored.r2);
    for (int g = 0; g < QN_GROUPS; g++) {
      stretch s = sphere_solve(&state_of_walk.f, &ball, g);
      vm unsure = s.unsure; /* there the ball's ends are none */
      vd y[3], d[3];
      for (int i = 0; i < 3; i++) {
        y[i] = vsub(vload(packet.o[i] + g * QN_W), vset(p.pivot[i])), d[i] = vload(packet.d[i] + g * QN_W);
      }
      for (int n = 0; n < count; n++) {
        plane_meet(&state_of_walk.f, &k[n], y, d, &s);
      }
      stretch_settle(&s);
      s.unsure = vor(s.unsure, unsure), s.hit = vandnot(s.hit, unsure);
      judge(&packet, p.pivot, &s, g, &c);
    }
  }
  report("planes", &c);
  assert_true(c.hits > share_min(5000) && c.misses > share_min(5000) && c.unsure > share_min(500));
}

static void floats_outward(void **state) {
  (void)state;
  static const double hard[] = {0, 0x1p-1074, 0x1p-160, 0x1p-149, 0x1.8p-150, 0x1p-126, 1, 1 + 0x1p-25, 0x1.ffffffp127, 0x1.fffffefp127, 0x1p128, 1e39, 0x1p500, DBL_MAX, INFINITY};
  for (size_t i = 0; i < sizeof hard / sizeof *hard; i++) {
    for (int sign = -1; sign <= 1; sign += 2) {
      double v = sign * hard[i];
      assert_true((double)down(v) <= v && (double)up(v) >= v); /* not where one is a NaN */
    }
  }
}

/* From the inverse to 9/8 of it, of powers of two and what lies next to them, of the worst, 3/2 of one, and of any. */
static void inverses_from_above(void **state) {
  (void)state;
  _Alignas(64) double x[QN_W], y[QN_W];
  mpq_t product, most;
  mpq_inits(product, most, NULL);
  mpq_set_ui(most, 9, 8);
  size_t equal = 0, worst = 0;
  for (int power = -1021; power < 1022; power++) {
    for (int kind = 0; kind < 6; kind++) {
      for (int i = 0; i < QN_W; i++) {
        const double one = ldexp(1, power);
        x[i] = kind == 0 ? one : kind == 1 ? nextafter(one, HUGE_VAL) : kind == 2 && power > -1021 ? nextafter(one, 0) : kind == 3 ? 1.5 * one : (1.5 + 0.5 * part()) * one;
      }
      vstore(y, vinverse_above(vload(x)));
      for (int i = 0; i < QN_W; i++) {
        mpq_set_d(product, x[i]);
        mpq_set_d(q_x, y[i]);
        mpq_mul(product, product, q_x);
        equal += mpq_cmp_ui(product, 1, 1) == 0, worst += mpq_cmp(product, most) == 0;
        assert_true(mpq_cmp_ui(product, 1, 1) >= 0 && mpq_cmp(product, most) <= 0);
      }
    }
  }
  assert_true(equal >= 2043 * QN_W && worst >= 2043 * QN_W);
  mpq_clears(product, most, NULL);
}

int main(void) {
  start_exact();
  const struct CMUnitTest tests[] = {cmocka_unit_test(spheres), cmocka_unit_test(boxes), cmocka_unit_test(planes), cmocka_unit_test(bodies_and_caps),
                                     cmocka_unit_test(floats_outward), cmocka_unit_test(inverses_from_above)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
