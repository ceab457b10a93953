#include "oracle.h"

#include <math.h>
#include <mpfr.h>
#include <stdlib.h>
#include <string.h>

enum { BITS = 640, TIE = 200, TEMPS = 24 };
#define RN MPFR_RNDN

typedef struct event { mpfr_t t; uint32_t leaf; } event;
typedef struct node_state { uint32_t first, others; } node_state; /* children that are true */

struct oracle {
  const flat_scene *scene;
  node_state *nodes;
  uint8_t *leaf_on;
  int root_on;
  event *events;
  size_t made, count;
  double *x, *y, *z, *r2; /* balls that hold the leaves */
  mpfr_t temp[TEMPS];
  mpfr_t o[3], d[3], lo, hi;
};

/* --- the tree -------------------------------------------------------------------------------------------------------- */

static int value_of(const oracle *o, uint32_t node) {
  const node_state *s = &o->nodes[node];
  return o->scene->nodes[node].op == 'u' ? s->first + s->others > 0 : s->first > 0 && s->others == 0;
}

static void toggle(oracle *o, uint32_t leaf) {
  const flat_leaf *l = &o->scene->leaves[leaf];
  int on = o->leaf_on[leaf] ^= 1, first = l->first;
  uint32_t node = l->parent;
  while (node != FLAT_NONE) {
    int before = value_of(o, node);
    uint32_t *count = first ? &o->nodes[node].first : &o->nodes[node].others;
    *count += on ? 1u : UINT32_MAX; /* one less */
    int after = value_of(o, node);
    if (after == before) {
      return;
    }
    on = after;
    first = o->scene->nodes[node].first;
    node = o->scene->nodes[node].parent;
  }
  o->root_on = on;
}

/* --- numbers --------------------------------------------------------------------------------------------------------- */

static void numbers_of(const flat_leaf *l, mpfr_t *v) {
  char *at = (char *)(uintptr_t)l->text;
  for (int i = 0; i < flat_numbers(l->kind); i++) {
    mpfr_strtofr(v[i], at, &at, 10, RN);
  }
}
static void dot(mpfr_t out, mpfr_t *a, mpfr_t *b, mpfr_t t) {
  mpfr_mul(out, a[0], b[0], RN);
  for (int i = 1; i < 3; i++) {
    mpfr_mul(t, a[i], b[i], RN);
    mpfr_add(out, out, t, RN);
  }
}
/* Whether a is 0 beside numbers of size `size`. */
static int nothing(const mpfr_t a, const mpfr_t size) {
  return mpfr_zero_p(a) || (!mpfr_zero_p(size) && mpfr_get_exp(a) < mpfr_get_exp(size) - TIE);
}
/* -1, 0, 1 with ties. */
static int compare(mpfr_t a, mpfr_t b, mpfr_t t) {
  mpfr_sub(t, a, b, RN);
  if (nothing(t, mpfr_cmpabs(a, b) > 0 ? a : b)) {
    return 0;
  }
  return mpfr_sgn(t) > 0 ? 1 : -1;
}

/* --- leaves: each cuts lo..hi down; returns 0 when nothing is left, -1 when the ray runs in a surface, else 1 ----------------- */

static int cut(oracle *o, mpfr_t a, mpfr_t b, mpfr_t t) { /* a <= b */
  if (mpfr_cmp(a, o->lo) > 0) {
    mpfr_set(o->lo, a, RN);
  }
  if (mpfr_cmp(b, o->hi) < 0) {
    mpfr_set(o->hi, b, RN);
  }
  return compare(o->lo, o->hi, t) < 0;
}

/* 0 <= p + t q <= h; size: what p and p - h are small beside. t: four temporaries. */
static int slab(oracle *o, mpfr_t p, mpfr_t q, mpfr_t h, mpfr_t q_size, mpfr_t size, mpfr_t *t) {
  if (nothing(q, q_size)) {
    mpfr_sub(t[0], p, h, RN);
    if (nothing(p, size) || nothing(t[0], size)) {
      return -1;
    }
    return mpfr_sgn(p) > 0 && mpfr_sgn(t[0]) < 0;
  }
  mpfr_neg(t[0], p, RN);
  mpfr_div(t[0], t[0], q, RN);
  mpfr_sub(t[1], h, p, RN);
  mpfr_div(t[1], t[1], q, RN);
  return mpfr_sgn(q) > 0 ? cut(o, t[0], t[1], t[2]) : cut(o, t[1], t[0], t[2]);
}

/* a t^2 + 2 h t + c <= 0 with a > 0 or, when a is 0, h = 0 too. t: four temporaries. */
static int body(oracle *o, mpfr_t a, mpfr_t h, mpfr_t c, mpfr_t a_size, mpfr_t c_size, mpfr_t *t) {
  if (nothing(a, a_size)) {
    return nothing(c, c_size) ? -1 : mpfr_sgn(c) < 0;
  }
  mpfr_mul(t[0], h, h, RN);
  mpfr_mul(t[1], a, c, RN);
  mpfr_sub(t[2], t[0], t[1], RN);
  mpfr_mul(t[3], a, c_size, RN);
  if (nothing(t[2], mpfr_cmpabs(t[0], t[3]) > 0 ? t[0] : t[3]) || mpfr_sgn(t[2]) < 0) {
    return 0;
  }
  mpfr_sqrt(t[2], t[2], RN);
  mpfr_add(t[0], h, t[2], RN);
  mpfr_neg(t[0], t[0], RN);
  mpfr_div(t[0], t[0], a, RN);
  mpfr_sub(t[1], t[2], h, RN);
  mpfr_div(t[1], t[1], a, RN);
  return cut(o, t[0], t[1], t[3]);
}

static int leaf_interval(oracle *o, const flat_leaf *l) {
  mpfr_t *v = o->temp, *y = o->temp + 8, *t = o->temp + 11, *w = o->temp + 15;
  mpfr_set_inf(o->lo, -1);
  mpfr_set_inf(o->hi, 1);
  numbers_of(l, v);
  for (int i = 0; i < 3; i++) {
    mpfr_sub(y[i], o->o[i], v[i], RN);
  }
  if (l->kind == 'B') {
    int state = 1;
    for (int i = 0; i < 3 && state == 1; i++) {
      state = slab(o, y[i], o->d[i], v[3 + i], o->d[i], v[3 + i], t);
    }
    return state;
  }
  if (l->kind == 'S') {
    dot(w[0], o->d, o->d, t[0]);
    dot(w[1], y, o->d, t[0]);
    dot(w[2], y, y, t[0]);
    mpfr_mul(w[3], v[3], v[3], RN);
    mpfr_sub(w[4], w[2], w[3], RN);
    return body(o, w[0], w[1], w[4], w[0], mpfr_cmp(w[2], w[3]) > 0 ? w[2] : w[3], t);
  }
  /* |x|^2 s - (x.k)^2 <= r^2 s with s = k.k; 0 <= x.k <= h sqrt s */
  mpfr_t *k = v + 3;
  dot(w[0], k, k, t[0]);     /* s */
  dot(w[1], y, k, t[0]);     /* y.k */
  dot(w[2], o->d, k, t[0]);  /* d.k */
  mpfr_sqrt(w[3], w[0], RN);
  mpfr_mul(w[3], w[3], v[6], RN);
  int state = slab(o, w[1], w[2], w[3], w[2], w[3], t);
  if (state != 1) {
    return state;
  }
  dot(w[4], o->d, o->d, t[0]);
  mpfr_mul(w[4], w[4], w[0], RN); /* size of a */
  mpfr_mul(w[5], w[2], w[2], RN);
  mpfr_sub(w[5], w[4], w[5], RN); /* a */
  dot(w[6], y, o->d, t[0]);
  mpfr_mul(w[6], w[6], w[0], RN);
  mpfr_mul(w[7], w[1], w[2], RN);
  mpfr_sub(w[6], w[6], w[7], RN); /* h */
  dot(w[7], y, y, t[0]);
  mpfr_mul(w[7], w[7], w[0], RN);
  mpfr_mul(w[8], w[1], w[1], RN);
  mpfr_sub(w[7], w[7], w[8], RN);
  mpfr_mul(w[8], v[7], v[7], RN);
  mpfr_mul(w[8], w[8], w[0], RN);
  mpfr_sub(w[7], w[7], w[8], RN); /* c */
  return body(o, w[5], w[6], w[7], w[4], w[8], t);
}

/* --- the ray --------------------------------------------------------------------------------------------------------- */

static int by_place(const void *a, const void *b) {
  const event *x = *(event *const *)a, *y = *(event *const *)b;
  return mpfr_cmp(x->t, y->t);
}

static int add(oracle *o, mpfr_t t, uint32_t leaf) {
  if (o->count == o->made) {
    size_t room = o->made * 2 + 64;
    event *events = realloc(o->events, room * sizeof *events);
    if (!events) {
      return 0;
    }
    o->events = events;
    for (; o->made < room; o->made++) {
      mpfr_init2(events[o->made].t, BITS);
    }
  }
  mpfr_set(o->events[o->count].t, t, RN);
  o->events[o->count++].leaf = leaf;
  return 1;
}

static void settle(oracle *o) {
  for (size_t i = 0; i < o->count; i++) {
    if (o->leaf_on[o->events[i].leaf]) {
      toggle(o, o->events[i].leaf);
    }
  }
}

long oracle_ray(oracle *o, const double origin[3], const double direction[3], size_t max, oracle_interval *out, int *entered_at_zero) {
  double dd = 0;
  o->count = 0;
  *entered_at_zero = 0;
  for (int i = 0; i < 3; i++) {
    mpfr_set_d(o->o[i], origin[i], RN);
    mpfr_set_d(o->d[i], direction[i], RN);
    dd += direction[i] * direction[i];
  }
  const double idd = 1 / dd;
  for (size_t i = 0; i < o->scene->leaf_count; i++) {
    double x = origin[0] - o->x[i], y = origin[1] - o->y[i], z = origin[2] - o->z[i];
    double along = x * direction[0] + y * direction[1] + z * direction[2];
    if (x * x + y * y + z * z - along * along * idd > o->r2[i]) {
      continue;
    }
    int state = leaf_interval(o, &o->scene->leaves[i]);
    if (state < 0) {
      return -1;
    }
    if (state && mpfr_sgn(o->hi) > 0) {
      if (!add(o, o->lo, (uint32_t)i) || !add(o, o->hi, (uint32_t)i)) {
        return -1;
      }
    }
  }
  event **sorted = malloc((o->count + 1) * sizeof *sorted);
  if (!sorted) {
    return -1;
  }
  for (size_t i = 0; i < o->count; i++) {
    sorted[i] = &o->events[i];
  }
  qsort(sorted, o->count, sizeof *sorted, by_place);
  long found = 0;
  int inside = 0;
  double enter = 0;
  for (size_t i = 0; i < o->count;) {
    size_t j = i;
    while (j < o->count && (j == i || compare(sorted[i]->t, sorted[j]->t, o->temp[0]) == 0)) {
      toggle(o, sorted[j++]->leaf);
    }
    if (o->root_on != inside) {
      inside = o->root_on;
      int ahead = mpfr_sgn(sorted[i]->t) > 0;
      double t = ahead ? mpfr_get_d(sorted[i]->t, RN) : 0;
      if (inside) {
        enter = t;
        if (!ahead) {
          *entered_at_zero = 1;
        }
      } else if (ahead) {
        if ((size_t)found < max) {
          out[found] = (oracle_interval){enter, t};
        }
        found++;
      } else {
        *entered_at_zero = 0;
      }
    }
    i = j;
  }
  free(sorted);
  settle(o);
  return found;
}

int oracle_point(oracle *o, const double point[3]) {
  /* A line through the point; the leaves that hold it are those whose interval has 0 inside. */
  static const double along[3] = {1, 0.5, 0.25};
  int on_surface = 0;
  o->count = 0;
  for (int i = 0; i < 3; i++) {
    mpfr_set_d(o->o[i], point[i], RN);
    mpfr_set_d(o->d[i], along[i], RN);
  }
  for (size_t i = 0; i < o->scene->leaf_count && !on_surface; i++) {
    const flat_leaf *l = &o->scene->leaves[i];
    double x = point[0] - o->x[i], y = point[1] - o->y[i], z = point[2] - o->z[i];
    if (x * x + y * y + z * z > o->r2[i]) {
      continue;
    }
    int state = leaf_interval(o, l);
    mpfr_set_d(o->temp[0], l->radius, RN);
    on_surface = state < 0 || (state && (nothing(o->lo, o->temp[0]) || nothing(o->hi, o->temp[0])));
    if (!on_surface && state && mpfr_sgn(o->lo) < 0 && mpfr_sgn(o->hi) > 0) {
      if (!add(o, o->lo, (uint32_t)i)) {
        return -1;
      }
      toggle(o, (uint32_t)i);
    }
  }
  int side = on_surface ? -1 : o->root_on ? 2 : 0;
  settle(o);
  return side;
}

oracle *oracle_new(const flat_scene *scene) {
  oracle *o = calloc(1, sizeof *o);
  if (!o) {
    return NULL;
  }
  o->scene = scene;
  o->nodes = calloc(scene->node_count + 1, sizeof *o->nodes);
  o->leaf_on = calloc(scene->leaf_count + 1, 1);
  o->x = calloc(4 * scene->leaf_count + 1, sizeof *o->x);
  for (int i = 0; i < TEMPS; i++) {
    mpfr_init2(o->temp[i], BITS);
  }
  for (int i = 0; i < 3; i++) {
    mpfr_init2(o->o[i], BITS);
    mpfr_init2(o->d[i], BITS);
  }
  mpfr_init2(o->lo, BITS);
  mpfr_init2(o->hi, BITS);
  if (!o->nodes || !o->leaf_on || !o->x) {
    oracle_free(o);
    return NULL;
  }
  o->y = o->x + scene->leaf_count;
  o->z = o->y + scene->leaf_count;
  o->r2 = o->z + scene->leaf_count;
  for (size_t i = 0; i < scene->leaf_count; i++) {
    const flat_leaf *l = &scene->leaves[i];
    o->x[i] = l->centre[0];
    o->y[i] = l->centre[1];
    o->z[i] = l->centre[2];
    o->r2[i] = l->radius * l->radius;
  }
  return o;
}

void oracle_free(oracle *o) {
  if (o) {
    for (int i = 0; i < TEMPS; i++) {
      mpfr_clear(o->temp[i]);
    }
    for (int i = 0; i < 3; i++) {
      mpfr_clear(o->o[i]);
      mpfr_clear(o->d[i]);
    }
    mpfr_clear(o->lo);
    mpfr_clear(o->hi);
    for (size_t i = 0; i < o->made; i++) {
      mpfr_clear(o->events[i].t);
    }
    free(o->events);
    free(o->nodes);
    free(o->leaf_on);
    free(o->x);
    free(o);
  }
}
