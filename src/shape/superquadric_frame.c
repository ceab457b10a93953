/* A line taken into a superquadric's frame: sums of products in twice the precision of doubles (Ogita, Rump, Oishi 2005), with what that leaves.

   X = sum r_j y_j + b with pairs r_j, y_j, b: the products of first parts and their sums are exact with their remainders; the remainders and the products with second parts
   are added in doubles. Where none of these is other than 0 the result is exact. docs/bounds.md, QN_SUPER_FRAME. */
#include "shape/super_frame.h"

#include "base/bounds.h"
#include "number/dd.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

/* A number's half in 26 bits, whose products with another are exact, as those of the rest (Dekker 1971). */
static double top_of(double a) {
  double c = 134217729.0 * a; /* 2^27 + 1 */
  return c - (c - a);
}

static int in_range(double v) { return v == 0 || (fabs(v) >= QN_SUPER_SHORT && fabs(v) <= QN_SUPER_LONG); }

void qn_super_rows_finish(qn_super_rows *rows) {
  rows->fit = 1;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      double r = rows->row[i][j][0];
      rows->fit &= in_range(r);
      rows->top[i][j] = top_of(r), rows->bottom[i][j] = r - top_of(r);
    }
  }
}

/* The pair and its error; 0: out of range. rests: of the magnitudes of what went into lo; size: of the terms. */
static int finish(double hi, double lo, double rests, double size, double out[2], double *off) {
  qn_dd r = qn_dd_quick_sum(hi, lo);
  *off = rests == 0 ? 0 : QN_SUPER_FRAME * size;
  out[0] = r.hi, out[1] = r.lo;
  if (r.lo != 0 && fabs(r.lo) < QN_SUPER_SHORT) {
    *off += QN_SUPER_SHORT;
    out[1] = 0;
  }
  return size == 0 || (size >= QN_SUPER_SHORT && size <= QN_SUPER_LONG);
}

int qn_super_frame_make(const qn_super_rows *rows, const double o[3], const double d[3], qn_super_frame *out) {
  double y[3][2], rest[3], top[3][2], bottom[3][2]; /* x - pivot with what that leaves, and d */
  int fit = rows->fit;
  for (int j = 0; j < 3; j++) {
    qn_dd at = qn_dd_two_sum(o[j], -rows->pivot[j]);
    fit &= in_range(at.hi) & in_range(at.lo) & in_range(d[j]);
    y[j][0] = at.hi, y[j][1] = d[j], rest[j] = at.lo;
    for (int k = 0; k < 2; k++) {
      top[j][k] = top_of(y[j][k]), bottom[j][k] = y[j][k] - top[j][k];
    }
  }
  for (int i = 0; i < 3; i++) {
    const double *b = rows->row[i][3];
    double hi[2] = {b[0], 0}, lo[2] = {b[1], 0}, rests[2] = {fabs(b[1]), 0}, size[2] = {fabs(b[0]), 0}; /* of O, of D */
    for (int j = 0; j < 3; j++) {
      double r = rows->row[i][j][0], r_rest = rows->row[i][j][1], r_top = rows->top[i][j], r_bottom = rows->bottom[i][j];
      if (r == 0) {
        continue;
      }
      double first = r * rest[j];
      for (int k = 0; k < 2; k++) {
        double p = r * y[j][k], second = r_rest * y[j][k], s = hi[k] + p, t = s - hi[k];
        double left = ((r_top * top[j][k] - p) + r_top * bottom[j][k] + r_bottom * top[j][k]) + r_bottom * bottom[j][k];
        double lost = (hi[k] - (s - t)) + (p - t);
        hi[k] = s;
        lo[k] += second + (lost + left);
        rests[k] += fabs(second) + (fabs(lost) + fabs(left));
        size[k] += fabs(p);
      }
      lo[0] += first;
      rests[0] += fabs(first);
    }
    fit &= finish(hi[0], lo[0], rests[0], size[0], out->O[i], &out->O_off[i]);
    fit &= finish(hi[1], lo[1], rests[1], size[1], out->D[i], &out->D_off[i]);
  }
  out->e[0] = rows->e[0], out->e[1] = rows->e[1];
  out->n[0] = rows->n[0], out->n[1] = rows->n[1];
  const double most = fmax(fabs(out->D[0][0]), fmax(fabs(out->D[1][0]), fabs(out->D[2][0])));
  return fit && most >= ldexp(1, -QN_SUPER_USUAL) && most <= ldexp(1, QN_SUPER_USUAL);
}

void qn_super_frame_begin(const qn_super_frame *frame, double t, qn_super_frame *out) {
  *out = *frame;
  for (int i = 0; i < 3; i++) {
    const double *O = frame->O[i], *D = frame->D[i];
    const qn_dd product = qn_dd_two_prod(D[0], t), sum = qn_dd_two_sum(O[0], product.hi);
    const double second = D[1] * t, rests = fabs(sum.lo) + fabs(product.lo) + fabs(second) + fabs(O[1]);
    const int fit = finish(sum.hi, sum.lo + (product.lo + (second + O[1])), rests, fabs(O[0]) + fabs(product.hi), out->O[i], &out->O_off[i]);
    out->O_off[i] = fit ? out->O_off[i] + (frame->O_off[i] + 1.5 * fabs(t) * frame->D_off[i]) : INFINITY;
  }
}

void qn_super_exact_begin(qn_super_exact *line, double t) {
  const qn_num from = qn_num_from_double(line->ctx, t);
  for (int i = 0; i < 3; i++) {
    line->O[i] = qn_num_add(line->ctx, line->O[i], qn_num_mul(line->ctx, line->D[i], from));
  }
}

/* A number's power of two, about; INT_MIN: it is 0. */
static int power_of(qn_ctx *ctx, qn_num a) {
  const qn_rat r = qn_num_rat(ctx, a);
  return qn_num_is_zero(a) ? INT_MIN : (int)qn_int_bits(r.num) - (int)qn_int_bits(r.den);
}

int qn_super_exact_scale(qn_super_exact *line) {
  qn_ctx *ctx = line->ctx;
  int most = INT_MIN;
  for (int i = 0; i < 3; i++) {
    const int power = power_of(ctx, line->D[i]);
    most = power > most ? power : most;
  }
  if (most == INT_MIN || abs(most) <= QN_SUPER_USUAL || ctx->failed) {
    return 0;
  }
  const qn_int one = qn_int_from(ctx, 1), much = qn_int_shl(ctx, one, (size_t)abs(most));
  const qn_num by = most < 0 ? qn_num_from_rat(ctx, much, one, 0) : qn_num_from_rat(ctx, one, much, 0);
  for (int i = 0; i < 3; i++) {
    line->D[i] = qn_num_mul(ctx, line->D[i], by);
  }
  return most;
}

/* A number as a pair, and what it leaves: 2^-106 of it, and what underflows. */
static double pair_of(qn_ctx *ctx, qn_num a, double out[2]) {
  qn_num_to_dd(ctx, a, &out[0], &out[1]);
  double off = out[1] == 0 ? (fabs(out[0]) < QN_SUPER_SHORT && !qn_num_is_zero(a) ? 0x1p-1070 : 0) : QN_U * QN_U * fabs(out[0]);
  if (out[1] != 0 && fabs(out[1]) < QN_SUPER_SHORT) {
    off += QN_SUPER_SHORT;
    out[1] = 0;
  }
  return off;
}

void qn_super_frame_from_exact(const qn_super_exact *line, qn_super_frame *out) {
  for (int i = 0; i < 3; i++) {
    out->O_off[i] = pair_of(line->ctx, line->O[i], out->O[i]);
    out->D_off[i] = pair_of(line->ctx, line->D[i], out->D[i]);
  }
  qn_num_to_dd(line->ctx, line->e, &out->e[0], &out->e[1]);
  qn_num_to_dd(line->ctx, line->n, &out->n[0], &out->n[1]);
}
