/* Fingerprints of surfaces: two numbers in doubles that equal surfaces share within QN_PRINT_ERROR, whatever pivot, frame,
   factor or sign their half-spaces are written with. Only half-spaces with equal fingerprints are ever compared exactly.

   Legend: c the ten coefficients in the scene's frame, which has its origin amid the leaves and 2^scale for a unit (A..F, G..I
   2^-scale, J 2^-2scale); w fixed weights in [0, 1].
       f = (w.c)^2 / c.c
   f is the same for every multiple of c. Its error: docs/bounds.md, QN_PRINT_ERROR. A superquadric takes its rows in place of c. */
#include "scene/fingerprint.h"

#include "base/bounds.h"

#include <math.h>
#include <stdlib.h>

static const int PAIR[10][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}, {3, 3}};

/* No pattern: equal fingerprints of unequal surfaces should be accidents. */
static const double WEIGHTS[2][QN_PRINT_SIZE] = {
  {0.7548776662466927, 0.5698402909980532, 0.8191725133961644, 0.6710436067037893, 0.5497004779019703, 0.9318321442141524, 0.3651206287402175,
   0.4503177862049613, 0.7261537081927402, 0.9003276482914503, 0.2817504413826029, 0.5139074426103877, 0.6207310592384186, 0.8372918860417433},
  {0.4159265358979323, 0.9183281828459045, 0.3147806995940213, 0.7724538509055160, 0.6180339887498949, 0.2360679774997897, 0.8414709848078965,
   0.5403023058681398, 0.9092974268256817, 0.4794255386042030, 0.7390851332151607, 0.3678794411714423, 0.5671432904097838, 0.9159655941772190},
};

/* Inside this range no product below leaves the range of doubles. */
static int fit_for_doubles(double v) {
  return (v == 0) | ((fabs(v) < 0x1p100) & (fabs(v) > 0x1p-100));
}

/* The constant of a row in the frame's coordinates, with the sum of magnitudes. */
static double constant(const double *r, double b, const double pivot[3], const double origin[3], double *magnitude) {
  double v = b;
  *magnitude = fabs(b);
  for (int j = 0; j < 3; j++) {
    double p = r[j] * (pivot[j] - origin[j]);
    v -= p;
    *magnitude += fabs(p);
  }
  return v;
}

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

void qn_print_frame_of(const quoin_scene *scene, qn_print_frame *out) {
  enum { SAMPLE = 255 };
  double places[3][SAMPLE], sizes[SAMPLE];
  size_t step = scene->leaf_count / SAMPLE + 1, n = 0;
  *out = (qn_print_frame){{0, 0, 0}, 0};
  for (size_t i = 0; i < scene->leaf_count && n < SAMPLE; i += step, n++) {
    for (int k = 0; k < 3; k++) {
      places[k][n] = scene->leaves[i].pivot[k];
    }
  }
  for (int k = 0; k < 3 && n; k++) {
    qsort(places[k], n, sizeof places[k][0], by_size);
    out->origin[k] = places[k][n / 2];
  }
  n = 0;
  for (size_t i = 0; i < scene->leaf_count && n < SAMPLE; i += step, n++) {
    const qn_leaf *leaf = &scene->leaves[i];
    sizes[n] = 0;
    for (int k = 0; k < 3; k++) {
      double extent = leaf->bounded ? leaf->max[k] - leaf->min[k] : 0;
      sizes[n] = fmax(sizes[n], fmax(fabs(leaf->pivot[k] - out->origin[k]), extent));
    }
  }
  if (n) {
    qsort(sizes, n, sizeof sizes[0], by_size);
    double size = sizes[n / 2];
    if (size > 0x1p-100 && size < 0x1p100) {
      frexp(size, &out->scale);
    }
  }
}

/* Each row along its own axis: a sphere that is only shifted, and many others. */
static int is_upright(const qn_quadric_shadow *q) {
  return ((q->row[0][1] != 0) | (q->row[0][2] != 0) | (q->row[1][0] != 0) | (q->row[1][2] != 0) | (q->row[2][0] != 0) | (q->row[2][1] != 0)) == 0;
}

/* qn_vector_of for such a body: the same sums without what is 0. */
static int upright_vector(const qn_quadric_shadow *q, const qn_leaf *leaf, const qn_print_frame *frame, double unit, qn_vector *out) {
  int fit = fit_for_doubles(q->l) & fit_for_doubles(q->k);
  double v = q->k, m = fabs(v);
  for (int i = 0; i < 3; i++) {
    double d = q->row[i][i], e = q->row[i][3], s = q->s[i];
    fit &= fit_for_doubles(d) & fit_for_doubles(e) & fit_for_doubles(s);
    double p = d * (leaf->pivot[i] - frame->origin[i]), w = e - p, wm = fabs(e) + fabs(p), l = i == 2 ? q->l : 0;
    out->c[i] = s * (d * d);
    out->magnitude[i] = fabs(out->c[i]);
    out->c[6 + i] = 2 * unit * (s * (d * w) + l * d);
    out->magnitude[6 + i] = 2 * unit * (fabs(s) * (fabs(d) * wm) + fabs(l) * fabs(d));
    v += s * (w * w) + 2 * l * w;
    m += fabs(s) * (wm * wm) + 2 * fabs(l) * wm;
  }
  out->c[9] = v * unit * unit;
  out->magnitude[9] = m * unit * unit;
  return fit;
}

int qn_vector_of(const quoin_scene *scene, const qn_leaf *leaf, const qn_half *half, const qn_print_frame *frame, qn_vector *out) {
  int fit = fit_for_doubles(leaf->pivot[0]) && fit_for_doubles(leaf->pivot[1]) && fit_for_doubles(leaf->pivot[2]);
  double unit = ldexp(1, -frame->scale), units[4] = {1, 1, 1, unit};
  *out = (qn_vector){0};
  if (half->kind == QN_PLANE) {
    const qn_plane_shadow *p = &scene->planes[half->shadow];
    double m;
    out->c[9] = constant(p->n, p->d, leaf->pivot, frame->origin, &m) * unit;
    out->magnitude[9] = m * unit;
    fit = fit && fit_for_doubles(p->d);
    for (int j = 0; j < 3; j++) {
      fit = fit && fit_for_doubles(p->n[j]);
      out->c[6 + j] = p->n[j];
      out->magnitude[6 + j] = fabs(p->n[j]);
    }
    return fit;
  }
  const qn_quadric_shadow *q = &scene->quadrics[half->shadow];
  if (half->kind == QN_QUADRIC_BODY && is_upright(q)) {
    return fit & upright_vector(q, leaf, frame, unit, out);
  }
  double r[3][4], m[3][4];
  for (int i = 0; i < 3; i++) {
    fit = fit && fit_for_doubles(q->s[i]);
    for (int j = 0; j < 4; j++) {
      fit = fit && fit_for_doubles(q->row[i][j]);
      r[i][j] = q->row[i][j];
      m[i][j] = fabs(r[i][j]);
    }
    r[i][3] = constant(q->row[i], q->row[i][3], leaf->pivot, frame->origin, &m[i][3]);
  }
  fit = fit && fit_for_doubles(q->l) && fit_for_doubles(q->k);
  if (half->kind == QN_SUPER_BODY) {
    for (int i = 0; i < 12; i++) {
      out->c[i] = r[i / 4][i % 4] * units[i % 4];
      out->magnitude[i] = m[i / 4][i % 4] * units[i % 4];
    }
    for (int i = 0; i < 2; i++) {
      out->c[12 + i] = out->magnitude[12 + i] = q->s[i];
    }
    return fit;
  }
  for (int c = 0; c < 10; c++) {
    int a = PAIR[c][0], b = PAIR[c][1];
    double v = 0, size = 0, factor = (a == b ? 1 : 2) * units[a] * units[b];
    for (int i = 0; i < 3; i++) {
      v += q->s[i] * (r[i][a] * r[i][b]);
      size += fabs(q->s[i]) * (m[i][a] * m[i][b]);
    }
    if (b == 3) { /* 2 l X_2: a half to each of (a, w) and (w, a) */
      double l = c == 9 ? 2 * q->l : q->l;
      v += l * r[2][a];
      size += fabs(l) * m[2][a];
    }
    if (c == 9) {
      v += q->k;
      size += fabs(q->k);
    }
    out->c[c] = v * factor;
    out->magnitude[c] = size * factor;
  }
  return fit;
}

int qn_vector_sign(const qn_vector *v) {
  for (int i = 0; i < 10; i++) {
    if (v->magnitude[i] > 0) {
      return fabs(v->c[i]) > QN_PRINT_TERM * v->magnitude[i] ? (v->c[i] > 0 ? 1 : -1) : 0;
    }
  }
  return 0;
}

int qn_print_of(const qn_vector *v, double print[2]) {
  double largest = 0, sums[2] = {0, 0}, square = 0, error = 0;
  for (int i = 0; i < QN_PRINT_SIZE; i++) {
    largest = fabs(v->c[i]) > largest ? fabs(v->c[i]) : largest;
  }
  if (!(largest < 0x1p900 && largest > 0x1p-900)) {
    return 0;
  }
  int e;
  frexp(largest, &e);
  double unit = ldexp(1, -e);
  for (int i = 0; i < QN_PRINT_SIZE; i++) {
    double c = v->c[i] * unit; /* what underflows here is below 2^-100 of the largest */
    square += c * c;
    error += QN_PRINT_TERM * (v->magnitude[i] * unit);
    sums[0] += WEIGHTS[0][i] * c;
    sums[1] += WEIGHTS[1][i] * c;
  }
  for (int i = 0; i < 2; i++) {
    print[i] = sums[i] * sums[i] / square;
  }
  return QN_PRINT_GROW * error <= QN_PRINT_ERROR;
}
