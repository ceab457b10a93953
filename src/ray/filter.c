/* The double filter: the roots of one half-space along a line with enclosures, or "cannot tell". Every bound used here is
   derived in docs/bounds.md under its name, and tested in rationals under it.

   Legend: y(s) = y + s d, y the line's origin relative to the leaf's pivot, for quadrics moved along the line to where it is
   nearest to the pivot: t = shift + s, shift a double taken as it is. That keeps the errors relative to the leaf and not to
   the distance of the origin. X_i = row_i . (y, 1) = O_i, D_i = row_i . d; W the weight of y: |y^ - y| <= u W. */
#include "base/bounds.h"
#include "ray/scratch.h"

#include <float.h>
#include <math.h>

int qn_filter_range(const double *v, size_t n) {
  int range = 1;
  for (size_t i = 0; i < n; i++) {
    if (!(fabs(v[i]) <= QN_FILTER_LARGEST)) {
      return 0;
    }
    if (v[i] != 0 && fabs(v[i]) < QN_FLUSH) {
      range = 2;
    }
  }
  return range;
}

/* One coordinate of the line as the filter takes it: |true - *v| <= u *weight. */
static void flush(double in, int rounded, int own_size, const qn_int *exact, double *v, double *weight) {
  *v = in;
  *weight = rounded || own_size ? fabs(in) : 0;
  if (fabs(in) < QN_FLUSH && (in != 0 || (rounded && qn_int_sign(*exact) != 0))) { /* less than the least subnormal, it may be */
    *v = 0;
    *weight = QN_FLUSH_WEIGHT;
  }
}

void qn_filter_line_make(const qn_line *line, qn_filter_line *f) {
  double dd = 0;
  f->wild = 0;
  for (int j = 0; j < 3; j++) {
    flush(line->o[j], line->rounded, 0, &line->origin[j], &f->o[j], &f->wo[j]);
    flush(line->d[j], line->rounded, 1, &line->direction[j], &f->d[j], &f->wd[j]);
    f->wild |= !(fabs(line->o[j]) <= QN_FILTER_LARGEST && fabs(line->d[j]) <= QN_FILTER_LARGEST);
    dd += f->d[j] * f->d[j];
  }
  f->inverse = dd > QN_SHIFT_LEAST ? 1 / dd : 0;
}

void qn_filter_leaf_begin(const qn_filter_line *line, const double pivot[3], qn_filter_leaf *leaf) {
  for (int j = 0; j < 3; j++) {
    double o = line->o[j] - pivot[j], w = line->wo[j];
    if (fabs(o) < QN_FLUSH && o != 0) {
      o = 0;
      w += QN_FLUSH_WEIGHT;
    }
    leaf->o[j] = o;
    leaf->wo[j] = w + fabs(o);
  }
  leaf->shifted = 0;
}

static void shift(const qn_filter_line *line, qn_filter_leaf *leaf) {
  double dot = leaf->o[0] * line->d[0] + leaf->o[1] * line->d[1] + leaf->o[2] * line->d[2];
  double t = fabs(dot) < QN_SHIFT_LEAST ? 0 : -dot * line->inverse;
  leaf->shift = t;
  double twice = 2 * fabs(t);
  for (int j = 0; j < 3; j++) {
    double y = leaf->o[j] + t * line->d[j];
    leaf->y[j] = y;
    leaf->wy[j] = leaf->wo[j] + twice * line->wd[j] + fabs(y);
  }
  leaf->shifted = 1;
}

/* An entry as the filter takes it, and its weight. */
QN_INLINE double value_of(double v, int tiny) { return tiny && fabs(v) < QN_FLUSH ? 0 : v; }
QN_INLINE double weight_of(double v, int tiny) { return tiny && v != 0 && fabs(v) < QN_FLUSH ? QN_FLUSH_WEIGHT : fabs(v); }

typedef struct mapped { double o, omega, d, delta; } mapped;

QN_INLINE mapped map_row(const double row[4], const double y[3], const double w[3], const double d[3], const double wd[3], int tiny) {
  double r0 = value_of(row[0], tiny), r1 = value_of(row[1], tiny), r2 = value_of(row[2], tiny), r3 = value_of(row[3], tiny);
  double m0 = weight_of(row[0], tiny), m1 = weight_of(row[1], tiny), m2 = weight_of(row[2], tiny), m3 = weight_of(row[3], tiny);
  return (mapped){.o = ((r0 * y[0] + r1 * y[1]) + r2 * y[2]) + r3,
                  .omega = ((m0 * w[0] + m1 * w[1]) + m2 * w[2]) + m3,
                  .d = (r0 * d[0] + r1 * d[1]) + r2 * d[2],
                  .delta = (m0 * wd[0] + m1 * wd[1]) + m2 * wd[2]};
}

/* p = 2 h s + c with certain h: the root. */
static int linear(double h, double eh, double c, double ec, double start, qn_filtered *out) {
  double s = c == 0 ? 0 : -c / (2 * h);
  double value = fabs(2 * h * s + c) + 2 * eh * fabs(s) + ec + QN_ROOT_E * (2 * fabs(h * s) + fabs(c)) + QN_TINY;
  double e = QN_SLACK * value / (2 * (fabs(h) - eh));
  double t = start + s;
  out->count = 1;
  out->sign = h > 0 ? -1 : 1;
  out->at[0] = (qn_root_at){t, QN_SLACK * (e + QN_U * fabs(t)) + QN_TINY};
  return out->at[0].e <= DBL_MAX && fabs(t) <= DBL_MAX;
}

/* p = c. */
static int constant(double c, double ec, qn_filtered *out) {
  out->count = 0;
  out->sign = (c > 0) - (c < 0);
  return fabs(c) > ec || ec == 0;
}

QN_INLINE int plane(const qn_filter_line *line, const qn_filter_leaf *leaf, const qn_plane_shadow *p, int tiny, qn_filtered *out) {
  double row[4] = {p->n[0], p->n[1], p->n[2], p->d};
  mapped m = map_row(row, leaf->o, leaf->wo, line->d, line->wd, tiny);
  double h = 0.5 * m.d, eh = 0.5 * QN_MAP_E * m.delta, ec = QN_MAP_E * m.omega;
  if (m.delta == 0) {
    return constant(m.o, ec, out);
  }
  return fabs(h) > eh && linear(h, eh, m.o, ec, 0, out);
}

int qn_filter_plane(const qn_filter_line *line, const qn_filter_leaf *leaf, const qn_plane_shadow *p, int tiny, qn_filtered *out) {
  return tiny ? plane(line, leaf, p, 1, out) : plane(line, leaf, p, 0, out);
}

/* Coefficients of p with their bounds, and its discriminant's unless a = 0. */
QN_INLINE void form(const qn_filter_line *line, qn_filter_leaf *leaf, const qn_quadric_shadow *q, int tiny, qn_filter_form *f) {
  if (!leaf->shifted) {
    shift(line, leaf);
  }
  double a = 0, h = 0, c = 0, ea = 0, eh = 0, ec = 0;
  double l = value_of(q->l, tiny), wl = weight_of(q->l, tiny);
  for (int i = 0; i < 3; i++) {
    double s = value_of(q->s[i], tiny), ws = weight_of(q->s[i], tiny);
    if (ws == 0 && (i < 2 || wl == 0)) {
      continue;
    }
    mapped m = map_row(q->row[i], leaf->y, leaf->wy, line->d, line->wd, tiny);
    double omega = fabs(m.o) + QN_MAP_E * m.omega, delta = fabs(m.d) + QN_MAP_E * m.delta; /* the primed ones */
    a += s * (m.d * m.d);
    h += s * (m.o * m.d);
    c += s * (m.o * m.o);
    ea += ws * (delta * m.delta);
    eh += ws * (omega * m.delta + m.omega * delta);
    ec += ws * (omega * m.omega);
    if (i == 2 && wl != 0) {
      h += l * m.d;
      c += 2 * (l * m.o);
      eh += wl * m.delta;
      ec += wl * m.omega;
    }
  }
  f->start = leaf->shift;
  f->a = a;
  f->h = h;
  f->c = c = c + value_of(q->k, tiny);
  f->ea = ea *= QN_QUAD_A_E;
  f->eh = eh *= QN_QUAD_H_E;
  f->ec = ec = QN_QUAD_C_E * ec + QN_QUAD_K_E * weight_of(q->k, tiny);
  double hh = h * h, ac = a * c, disc = hh - ac;
  f->disc = disc;
  f->ed = QN_SLACK * ((2 * fabs(h) + eh) * eh + (fabs(a) + ea) * ec + fabs(c) * ea + QN_DISC_E * (hh + fabs(ac) + fabs(disc))) + QN_TINY;
}

static qn_root_at enclose(const qn_filter_form *f, double inverse, double s) {
  double size = fabs(s), ss = s * s;
  double value = fabs((f->a * s + 2 * f->h) * s + f->c) + f->ea * ss + 2 * f->eh * size + f->ec +
                 QN_ROOT_E * (fabs(f->a) * ss + 2 * fabs(f->h) * size + fabs(f->c)) + QN_TINY;
  double t = f->start + s;
  return (qn_root_at){t, QN_SLACK * (value * inverse + QN_U * fabs(t)) + QN_TINY};
}

static int roots(const qn_filter_form *f, qn_filtered *out) {
  double size = fabs(f->a);
  if (f->ea == 0) {
    return f->eh == 0 ? constant(f->c, f->ec, out) : fabs(f->h) > f->eh && linear(f->h, f->eh, f->c, f->ec, f->start, out);
  }
  if (f->disc < -f->ed) {
    out->count = 0; /* no root: the sign of a, which is that of c */
    out->sign = size > f->ea ? (f->a > 0 ? 1 : -1) : f->c > 0 ? 1 : -1;
    return size > f->ea || fabs(f->c) > f->ec;
  }
  if (!(f->disc > f->ed && size > f->ea)) {
    return 0;
  }
  double root = sqrt(f->disc), inverse = 1 / sqrt(f->disc - f->ed);
  double away = -(f->h + copysign(root, f->h)); /* no cancellation */
  double s0 = away / f->a, s1 = f->c / away;
  out->count = 2;
  out->sign = f->a > 0 ? 1 : -1;
  out->at[0] = enclose(f, inverse, s0 < s1 ? s0 : s1);
  out->at[1] = enclose(f, inverse, s0 < s1 ? s1 : s0);
  return out->at[1].t - out->at[0].t > out->at[0].e + out->at[1].e && out->at[1].t <= DBL_MAX && out->at[0].t >= -DBL_MAX;
}

void qn_filter_form_make(const qn_filter_line *line, qn_filter_leaf *leaf, const qn_quadric_shadow *q, int tiny, qn_filter_form *f) {
  if (tiny) {
    form(line, leaf, q, 1, f);
  } else {
    form(line, leaf, q, 0, f);
  }
}

int qn_filter_quadric(const qn_filter_line *line, qn_filter_leaf *leaf, const qn_quadric_shadow *q, int tiny, qn_filtered *out) {
  qn_filter_form f;
  qn_filter_form_make(line, leaf, q, tiny, &f);
  return roots(&f, out);
}
