/* Random scenes of small integers, where ties abound, against an evaluator of its own in many bits; and boxes, whose faces the
   lines run in and whose corners they touch, against a look at the eight octants of a point. */
#include "rays.h"
#include "share.h"

#include <mpfr.h>

static uint64_t seed = 0x2545f4914f6cdd1du;
static uint64_t next(void) {
  seed ^= seed << 13;
  seed ^= seed >> 7;
  seed ^= seed << 17;
  return seed;
}
static int64_t below(int64_t n) { return (int64_t)(next() % (uint64_t)n); }

/* A half-space of a leaf: A..J of the general quadric in world coordinates. */
typedef struct form { int64_t q[10]; } form;
typedef struct leaf { form forms[6]; int count; } leaf;
typedef struct tree { int op, left, right, leaf; } tree; /* op: 'u', 'd', 'i', or 'l' for a leaf */

enum { LEAVES = 6, NODES = 2 * LEAVES };
static leaf leaves[LEAVES];
static int leaf_total;
static tree nodes[NODES];
static int node_total;

static void add_form(leaf *l, int64_t A, int64_t B, int64_t C, int64_t G, int64_t H, int64_t I, int64_t J, const int64_t at[3]) {
  /* moved by at: x -> x - at */
  form *f = &l->forms[l->count++];
  memset(f, 0, sizeof *f);
  f->q[0] = A, f->q[1] = B, f->q[2] = C;
  f->q[6] = G - 2 * A * at[0], f->q[7] = H - 2 * B * at[1], f->q[8] = I - 2 * C * at[2];
  f->q[9] = J + A * at[0] * at[0] + B * at[1] * at[1] + C * at[2] * at[2] - G * at[0] - H * at[1] - I * at[2];
}

static void random_leaf(leaf *l, char *text, size_t size) {
  int64_t at[3] = {below(7) - 3, below(7) - 3, below(7) - 3}, r = 1 + below(4), h = 1 + below(4);
  char body[200];
  l->count = 0;
  switch (below(6)) {
  case 0:
    add_form(l, 1, 1, 1, 0, 0, 0, -r * r, at);
    snprintf(body, sizeof body, "sphere(%d);", (int)r);
    break;
  case 1:
  case 2: {
    int64_t s[3] = {r, h, 1 + below(4)};
    for (int k = 0; k < 3; k++) {
      add_form(l, 0, 0, 0, -(k == 0), -(k == 1), -(k == 2), 0, at);
      add_form(l, 0, 0, 0, k == 0, k == 1, k == 2, -s[k], at);
    }
    snprintf(body, sizeof body, "cube([%d, %d, %d]);", (int)s[0], (int)s[1], (int)s[2]);
    break;
  }
  case 3:
    add_form(l, 1, 1, 0, 0, 0, 0, -r * r, at);
    add_form(l, 0, 0, 0, 0, 0, -1, 0, at);
    add_form(l, 0, 0, 0, 0, 0, 1, -h, at);
    snprintf(body, sizeof body, "cylinder(h = %d, r = %d);", (int)h, (int)r);
    break;
  case 4: /* x^2 + y^2 <= (h - z)^2 */
    add_form(l, 1, 1, -1, 0, 0, 2 * h, -h * h, at);
    add_form(l, 0, 0, 0, 0, 0, -1, 0, at);
    add_form(l, 0, 0, 0, 0, 0, 1, -h, at);
    snprintf(body, sizeof body, "cylinder(h = %d, r1 = %d, r2 = 0);", (int)h, (int)h);
    break;
  default: /* one sheet or two, or a cone of two nappes: not convex, not bounded */
    r = below(3) - 1;
    add_form(l, 1, 1, -1, 0, 0, 0, -r, at);
    snprintf(body, sizeof body, "quadric([1, 1, -1, 0, 0, 0, 0, 0, 0, %d]);", (int)-r);
    break;
  }
  snprintf(text, size, "translate([%d, %d, %d]) %s", (int)at[0], (int)at[1], (int)at[2], body);
}

/* A tree over leaves first .. first + n - 1; its text. */
static int random_tree(int first, int n, char texts[LEAVES][300], char *text, size_t size) {
  int me = node_total++;
  if (n == 1) {
    nodes[me] = (tree){'l', 0, 0, first};
    snprintf(text, size, "%s", texts[first]);
    return me;
  }
  static const char *const words[3] = {"union", "difference", "intersection"};
  int op = (int)below(3), split = 1 + (int)below(n - 1);
  char left[4000], right[4000];
  int a = random_tree(first, split, texts, left, sizeof left), b = random_tree(first + split, n - split, texts, right, sizeof right);
  nodes[me] = (tree){words[op][0], a, b, 0};
  snprintf(text, size, "%s() { %.1900s %.1900s }", words[op], left, right);
  return me;
}

static int value_of(int node, const int *inside) {
  const tree *t = &nodes[node];
  if (t->op == 'l') {
    return inside[t->leaf];
  }
  int a = value_of(t->left, inside), b = value_of(t->right, inside);
  return t->op == 'u' ? a | b : t->op == 'd' ? a & !b : a & b;
}

/* Twice the form along the line: a t^2 + b t + c. */
static void along(const form *f, const int64_t o[3], const int64_t d[3], int64_t p[3]) {
  p[0] = p[1] = 0;
  p[2] = f->q[9];
  for (int k = 0; k < 3; k++) {
    p[0] += f->q[k] * d[k] * d[k];
    p[1] += 2 * f->q[k] * o[k] * d[k] + f->q[6 + k] * d[k];
    p[2] += f->q[k] * o[k] * o[k] + f->q[6 + k] * o[k];
  }
}

enum { BITS = 400, ROOTS = 2 * 6 * LEAVES + 2 };

static int sign_of(const int64_t p[3], mpfr_t t) {
  mpfr_t v;
  mpfr_init2(v, 3 * BITS);
  mpfr_mul_si(v, t, (long)p[0], MPFR_RNDN);
  mpfr_add_si(v, v, (long)p[1], MPFR_RNDN);
  mpfr_mul(v, v, t, MPFR_RNDN);
  mpfr_add_si(v, v, (long)p[2], MPFR_RNDN);
  int s = mpfr_sgn(v);
  mpfr_clear(v);
  return s;
}

static int by_value(const void *a, const void *b) {
  mpfr_srcptr x = a, y = b;
  return mpfr_cmp(x, y);
}

/* The answer by sampling between all roots; 0 when the line runs in a surface. */
static int evaluate(int root, const int64_t o[3], const int64_t d[3], const double range[2], char *out, size_t size, unsigned *ties) {
  mpfr_t roots[ROOTS], x, t;
  int n = 0, runs = 0;
  mpfr_inits2(BITS, x, t, (mpfr_ptr)0);
  for (int i = 0; i < ROOTS; i++) {
    mpfr_init2(roots[i], BITS);
  }
  for (int k = 0; k < 2; k++) {
    if (isfinite(range[k])) {
      mpfr_set_d(roots[n++], range[k], MPFR_RNDN);
    }
  }
  for (int i = 0; i < leaf_total; i++) {
    for (int k = 0; k < leaves[i].count; k++) {
      int64_t p[3];
      along(&leaves[i].forms[k], o, d, p);
      int64_t disc = p[1] * p[1] - 4 * p[0] * p[2];
      runs |= p[0] == 0 && p[1] == 0 && p[2] == 0;
      if (p[0] != 0 && disc >= 0) {
        for (int s = -1; s <= 1; s += 2) {
          mpfr_set_si(x, (long)disc, MPFR_RNDN);
          mpfr_sqrt(x, x, MPFR_RNDN);
          mpfr_mul_si(x, x, s, MPFR_RNDN);
          mpfr_sub_si(x, x, (long)p[1], MPFR_RNDN);
          mpfr_div_si(roots[n++], x, (long)(2 * p[0]), MPFR_RNDN);
        }
      } else if (p[0] == 0 && p[1] != 0) {
        mpfr_set_si(x, (long)-p[2], MPFR_RNDN);
        mpfr_div_si(roots[n++], x, (long)p[1], MPFR_RNDN);
      }
    }
  }
  qsort(roots, (size_t)n, sizeof *roots, by_value);
  int kept = 0;
  for (int i = 0; i < n; i++) {
    if (kept) {
      mpfr_sub(x, roots[i], roots[kept - 1], MPFR_RNDN);
      if (mpfr_zero_p(x) || mpfr_get_exp(x) < -BITS / 2) {
        ++*ties;
        continue;
      }
    }
    mpfr_set(roots[kept++], roots[i], MPFR_RNDN);
  }
  out[0] = '\0';
  int was = 0;
  for (int i = 0; i <= kept; i++) { /* the stretch before root i */
    if (kept == 0) {
      mpfr_set_si(t, 0, MPFR_RNDN);
    } else if (i == 0) {
      mpfr_sub_si(t, roots[0], 1, MPFR_RNDN);
    } else if (i == kept) {
      mpfr_add_si(t, roots[kept - 1], 1, MPFR_RNDN);
    } else {
      mpfr_add(t, roots[i - 1], roots[i], MPFR_RNDN);
      mpfr_div_si(t, t, 2, MPFR_RNDN);
    }
    int inside[LEAVES];
    for (int k = 0; k < leaf_total; k++) {
      inside[k] = 1;
      for (int f = 0; f < leaves[k].count; f++) {
        int64_t p[3];
        along(&leaves[k].forms[f], o, d, p);
        inside[k] &= sign_of(p, t) < 0;
      }
    }
    int now = value_of(root, inside) && mpfr_cmp_d(t, range[0]) > 0 && mpfr_cmp_d(t, range[1]) < 0;
    if (now != was) {
      double end = i == 0 ? -HUGE_VAL : mpfr_get_d(roots[i - 1], MPFR_RNDN);
      add_number(out, size, end == 0 ? 0 : end);
    }
    was = now;
  }
  if (was) {
    add_number(out, size, HUGE_VAL);
  }
  for (int i = 0; i < ROOTS; i++) {
    mpfr_clear(roots[i]);
  }
  mpfr_clears(x, t, (mpfr_ptr)0);
  return !runs;
}

static void inside_of(stage *st, qn_line *line, const qn_range *range, unsigned want, char *out, size_t size) {
  qn_woven w;
  assert_int_equal(qn_weave(st->scene, st->scratch, line, range, want, &w), QUOIN_OK);
  out[0] = '\0';
  for (size_t i = 0; i < w.inside_count; i++) {
    add_number(out, size, qn_place_round(st->scene, st->scratch, line, &w.inside[i].enter.place));
    add_number(out, size, qn_place_round(st->scene, st->scratch, line, &w.inside[i].leave.place));
  }
}

static void test_random_scenes(void **state) {
  (void)state;
  unsigned rays = 0, in_surface = 0, with_answer = 0, ties = 0, wrong = 0, many = 0, cut = 0;
  qn_counts counts = {0};
  for (int n = 0; n < share_of(600); n++) {
    char texts[LEAVES][300], text[4000];
    leaf_total = 1 + (int)below(LEAVES);
    node_total = 0;
    for (int i = 0; i < leaf_total; i++) {
      random_leaf(&leaves[i], texts[i], sizeof texts[i]);
    }
    int root = random_tree(0, leaf_total, texts, text, sizeof text);
    stage st = stage_open(text);
    for (int k = 0; k < 60; k++) {
      int64_t o[3], d[3];
      int aimed = below(2) == 0;
      do {
        for (int j = 0; j < 3; j++) {
          o[j] = below(15) - 7;
          d[j] = aimed ? below(7) - 2 - o[j] : below(3) == 0 ? 0 : below(9) - 4;
        }
      } while (d[0] == 0 && d[1] == 0 && d[2] == 0);
      double range[2] = {-HUGE_VAL, HUGE_VAL}, od[3], dd[3];
      if (below(4) == 0) {
        range[0] = (double)(below(17) - 8) / 4;
      }
      if (below(4) == 0) {
        range[1] = (isfinite(range[0]) ? range[0] : -2) + (double)(1 + below(12)) / 4;
      }
      cut += isfinite(range[0]) || isfinite(range[1]);
      for (int j = 0; j < 3; j++) {
        od[j] = (double)o[j];
        dd[j] = (double)d[j];
      }
      char want[2000], got[2000], first[2000];
      int plain = evaluate(root, o, d, range, want, sizeof want, &ties);
      qn_range part = WHOLE_LINE;
      part.from.t = range[0];
      part.to.t = range[1];
      qn_line line;
      qn_scratch_begin(st.scratch);
      qn_line_from_doubles(od, dd, &line);
      inside_of(&st, &line, &part, 0, got, sizeof got);
      rays++;
      if (!plain) {
        in_surface++;
        continue;
      }
      with_answer += want[0] != 0;
      many += strchr(want, ' ') && strchr(strchr(want, ' ') + 1, ' ');
      int same = strcmp(want, got) == 0;
      if (same) { /* with more wanted, and with less */
        inside_of(&st, &line, &part, QUOIN_WANT_BOUNDARY | QUOIN_WANT_CONTACTS, got, sizeof got);
        same = strcmp(want, got) == 0;
        inside_of(&st, &line, &part, QN_WANT_FIRST, first, sizeof first);
        same &= strncmp(want, first, strlen(first)) == 0 && (first[0] != 0) == (want[0] != 0);
      }
      if (!same && wrong++ < 10) {
        print_error("%s\n  o %d %d %d d %d %d %d range %g %g\n  want [%s]\n  got  [%s]\n", text, (int)o[0], (int)o[1], (int)o[2], (int)d[0], (int)d[1], (int)d[2], range[0],
                    range[1], want, got);
      }
    }
    const qn_counts *c = qn_scratch_counts(st.scratch);
    counts.filter_sure += c->filter_sure;
    counts.exact_signs += c->exact_signs;
    counts.exact_orders += c->exact_orders;
    counts.exact_roundings += c->exact_roundings;
    stage_close(&st);
  }
  print_message("%u rays, %u in a surface, %u with an answer, %u of many pieces, %u cut, %u ties; sure %llu, exact signs %llu, orders %llu, roundings %llu\n", rays, in_surface,
                with_answer, many, cut, ties, (unsigned long long)counts.filter_sure, (unsigned long long)counts.exact_signs, (unsigned long long)counts.exact_orders,
                (unsigned long long)counts.exact_roundings);
  assert_int_equal(wrong, 0);
  assert_true(in_surface > share_min(500) && with_answer > share_min(3000) && many > share_min(300) && cut > share_min(5000) && ties > share_min(10000));
}

/* --- boxes: what is beside a line that runs in faces or touches corners, by the eight octants of a point -------------- */

/* The side at t: 0 outside, 1 boundary, 2 inside. */
static int octants(int root, const int64_t o[3], const int64_t d[3], mpfr_t t) {
  int in = 0;
  for (int v = 0; v < 8; v++) {
    int inside[LEAVES];
    for (int k = 0; k < leaf_total; k++) {
      inside[k] = 1;
      for (int f = 0; f < leaves[k].count; f++) {
        int64_t p[3];
        const int64_t *q = leaves[k].forms[f].q;
        along(&leaves[k].forms[f], o, d, p);
        mpfr_t value;
        mpfr_init2(value, BITS);
        mpfr_mul_si(value, t, (long)p[1], MPFR_RNDN);
        mpfr_add_si(value, value, (long)p[2], MPFR_RNDN);
        int sign = mpfr_zero_p(value) || mpfr_get_exp(value) < -BITS / 2 ? 0 : mpfr_sgn(value);
        mpfr_clear(value);
        if (sign == 0) { /* the face's normal is along one axis */
          for (int j = 0; j < 3; j++) {
            sign += (int)q[6 + j] * (v >> j & 1 ? 1 : -1);
          }
        }
        inside[k] &= sign < 0;
      }
    }
    in += value_of(root, inside);
  }
  return in == 8 ? 2 : in > 0;
}

static void boxes_answer(int root, const int64_t o[3], const int64_t d[3], const double range[2], char *out, size_t size, unsigned *on, unsigned *at) {
  mpfr_t roots[ROOTS], t;
  int n = 0, side[ROOTS], runs = 0, touches = 0;
  int seen[ROOTS];
  mpfr_init2(t, BITS);
  for (int k = 0; k < 2; k++) {
    if (isfinite(range[k])) {
      mpfr_init2(roots[n], BITS);
      mpfr_set_d(roots[n++], range[k], MPFR_RNDN);
    }
  }
  for (int i = 0; i < leaf_total; i++) {
    for (int k = 0; k < leaves[i].count; k++) {
      int64_t p[3];
      along(&leaves[i].forms[k], o, d, p);
      if (p[1]) {
        mpfr_init2(roots[n], BITS);
        mpfr_set_si(t, (long)-p[2], MPFR_RNDN);
        mpfr_div_si(roots[n++], t, (long)p[1], MPFR_RNDN);
      }
    }
  }
  qsort(roots, (size_t)n, sizeof *roots, by_value);
  int kept = 0;
  for (int i = 0; i < n; i++) {
    if (kept == 0 || !mpfr_equal_p(roots[i], roots[kept - 1])) {
      mpfr_swap(roots[kept++], roots[i]);
    }
  }
  for (int i = 0; i <= kept; i++) {
    if (i == 0) {
      mpfr_sub_si(t, roots[0], 1, MPFR_RNDN);
    } else if (i == kept) {
      mpfr_add_si(t, roots[kept - 1], 1, MPFR_RNDN);
    } else {
      mpfr_add(t, roots[i - 1], roots[i], MPFR_RNDN);
      mpfr_div_si(t, t, 2, MPFR_RNDN);
    }
    side[i] = octants(root, o, d, t);
    seen[i] = mpfr_cmp_d(t, range[0]) > 0 && mpfr_cmp_d(t, range[1]) < 0 ? side[i] : 0;
  }
  out[0] = '\0';
  for (int wanted = 2; wanted >= 1; wanted--) {
    for (int i = 1; i <= kept; i++) {
      if ((seen[i] == wanted) != (seen[i - 1] == wanted)) {
        if (wanted == 1 && !runs++) {
          snprintf(out + strlen(out), size - strlen(out), "%son", out[0] ? " " : "");
        }
        double end = mpfr_get_d(roots[i - 1], MPFR_RNDN);
        add_number(out, size, end == 0 ? 0 : end);
      }
    }
  }
  for (int i = 0; i < kept; i++) {
    if (side[i] == 0 && side[i + 1] == 0 && mpfr_cmp_d(roots[i], range[0]) >= 0 && mpfr_cmp_d(roots[i], range[1]) <= 0 && octants(root, o, d, roots[i])) {
      if (!touches++) {
        snprintf(out + strlen(out), size - strlen(out), "%sat", out[0] ? " " : "");
      }
      double touch = mpfr_get_d(roots[i], MPFR_RNDN);
      add_number(out, size, touch == 0 ? 0 : touch);
    }
  }
  *on += runs > 0;
  *at += touches > 0;
  for (int i = 0; i < n; i++) {
    mpfr_clear(roots[i]);
  }
  mpfr_clear(t);
}

static void stretches_of(stage *st, qn_line *line, const qn_range *range, char *out, size_t size) {
  qn_woven w;
  assert_int_equal(qn_weave(st->scene, st->scratch, line, range, QUOIN_WANT_BOUNDARY, &w), QUOIN_OK);
  out[0] = '\0';
  for (size_t i = 0; i < w.inside_count + w.boundary_count; i++) {
    const qn_stretch *piece = i < w.inside_count ? &w.inside[i] : &w.boundary[i - w.inside_count];
    if (i == w.inside_count) {
      snprintf(out + strlen(out), size - strlen(out), "%son", out[0] ? " " : "");
    }
    add_number(out, size, qn_place_round(st->scene, st->scratch, line, &piece->enter.place));
    add_number(out, size, qn_place_round(st->scene, st->scratch, line, &piece->leave.place));
  }
}

static void test_boxes(void **state) {
  (void)state;
  unsigned rays = 0, on = 0, at = 0, answers = 0, wrong = 0;
  for (int n = 0; n < share_of(200); n++) {
    char texts[LEAVES][300], text[4000];
    leaf_total = 1 + (int)below(LEAVES);
    node_total = 0;
    for (int i = 0; i < leaf_total; i++) {
      int64_t corner[3] = {below(4), below(4), below(4)}, s[3] = {1 + below(3), 1 + below(3), 1 + below(3)};
      leaves[i].count = 0;
      for (int k = 0; k < 3; k++) {
        add_form(&leaves[i], 0, 0, 0, -(k == 0), -(k == 1), -(k == 2), 0, corner);
        add_form(&leaves[i], 0, 0, 0, k == 0, k == 1, k == 2, -s[k], corner);
      }
      snprintf(texts[i], sizeof texts[i], "translate([%d, %d, %d]) cube([%d, %d, %d]);", (int)corner[0], (int)corner[1], (int)corner[2], (int)s[0], (int)s[1], (int)s[2]);
    }
    int root = random_tree(0, leaf_total, texts, text, sizeof text);
    stage st = stage_open(text);
    for (int k = 0; k < 40; k++) {
      int64_t o[3], d[3];
      int aligned = below(2) == 0;
      do {
        for (int j = 0; j < 3; j++) {
          o[j] = below(8) - 1;
          d[j] = aligned ? (below(2) ? 0 : below(3) - 1) : below(5) - 2;
        }
      } while (d[0] == 0 && d[1] == 0 && d[2] == 0);
      double od[3], dd[3];
      for (int j = 0; j < 3; j++) {
        od[j] = (double)o[j];
        dd[j] = (double)d[j];
      }
      char want[2000], got[2000];
      double range[2] = {-HUGE_VAL, HUGE_VAL};
      if (below(4) == 0) {
        range[0] = (double)(below(21) - 10) / 2;
      }
      if (below(4) == 0) {
        range[1] = (isfinite(range[0]) ? range[0] : -4) + (double)(1 + below(12)) / 2;
      }
      boxes_answer(root, o, d, range, want, sizeof want, &on, &at);
      qn_range part = WHOLE_LINE;
      part.from.t = range[0];
      part.to.t = range[1];
      qn_line line;
      qn_scratch_begin(st.scratch);
      qn_line_from_doubles(od, dd, &line);
      answer_of(&st, &line, &part, got, sizeof got);
      if (strncmp(want, got, strlen(want)) == 0) { /* without contacts, which are woven in another way */
        stretches_of(&st, &line, &part, got, sizeof got);
        char *at_end = strstr(want, "at");
        if (at_end) {
          *(at_end == want ? at_end : at_end - 1) = '\0';
        }
      }
      rays++;
      answers += want[0] != 0;
      if (strcmp(want, got) != 0 && wrong++ < 10) {
        print_error("%s\n  o %d %d %d d %d %d %d\n  want [%s]\n  got  [%s]\n", text, (int)o[0], (int)o[1], (int)o[2], (int)d[0], (int)d[1], (int)d[2], want, got);
      }
    }
    stage_close(&st);
  }
  print_message("%u rays, %u with an answer, %u on a boundary, %u contacts\n", rays, answers, on, at);
  assert_int_equal(wrong, 0);
  assert_true(rays == 40 * (unsigned)share_of(200) && answers > share_min(500) && on > share_min(300) && at > share_min(200));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_random_scenes), cmocka_unit_test(test_boxes)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
