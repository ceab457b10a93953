/* Vectors of integers and quadratic forms on them, exactly: products, parallels, definiteness.

   Legend: a form is h = (xx, yy, zz, xy, xz, yz) of a symmetric matrix H. qn_form_axes is Lagrange's reduction: vectors
   f0, f1, f2 with fiᵗHfj = 0 for i != j; by Sylvester's law the signs of fiᵗHfi are those of H's eigenvalues. */
#include "ray/around_cells.h"

qn_int qn_settled(qn_xint a) {
  return qn_x_sign(a) == 0 ? (qn_int){0, NULL} : a.v;
}

qn_xint qn_dot_x(qn_ctx *ctx, const qn_xint g[3], const qn_int v[3]) {
  qn_xint sum = qn_x_mul(ctx, g[0], qn_x(v[0]));
  sum = qn_x_add(ctx, sum, qn_x_mul(ctx, g[1], qn_x(v[1])));
  return qn_x_add(ctx, sum, qn_x_mul(ctx, g[2], qn_x(v[2])));
}

void qn_form_apply(qn_ctx *ctx, const qn_xint h[6], const qn_int v[3], qn_xint out[3]) {
  const qn_xint rows[3][3] = {{h[0], h[3], h[4]}, {h[3], h[1], h[5]}, {h[4], h[5], h[2]}};
  for (int i = 0; i < 3; i++) {
    out[i] = qn_dot_x(ctx, rows[i], v);
  }
}

qn_xint qn_form_x(qn_ctx *ctx, const qn_xint h[6], const qn_int u[3], const qn_int v[3]) {
  qn_xint image[3];
  qn_form_apply(ctx, h, v, image);
  return qn_dot_x(ctx, image, u);
}

void qn_cross_int(qn_ctx *ctx, const qn_int a[3], const qn_int b[3], qn_int out[3]) {
  qn_int c[3];
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    c[i] = qn_int_sub(ctx, qn_int_mul(ctx, a[j], b[k]), qn_int_mul(ctx, a[k], b[j]));
  }
  out[0] = c[0], out[1] = c[1], out[2] = c[2];
}

void qn_cross_x(qn_ctx *ctx, const qn_xint a[3], const qn_xint b[3], qn_xint out[3]) {
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    out[i] = qn_x_sub(ctx, qn_x_mul(ctx, a[j], b[k]), qn_x_mul(ctx, a[k], b[j]));
  }
}

qn_xint qn_product_x(qn_ctx *ctx, const qn_xint a[3], const qn_xint b[3]) {
  qn_xint sum = qn_x_mul(ctx, a[0], b[0]);
  sum = qn_x_add(ctx, sum, qn_x_mul(ctx, a[1], b[1]));
  return qn_x_add(ctx, sum, qn_x_mul(ctx, a[2], b[2]));
}

void qn_combine_int(qn_ctx *ctx, qn_int a, const qn_int v[3], qn_int b, const qn_int w[3], qn_int out[3]) {
  for (int i = 0; i < 3; i++) {
    out[i] = qn_int_add(ctx, qn_int_mul(ctx, a, v[i]), qn_int_mul(ctx, b, w[i]));
  }
}

int qn_parallel_x(qn_ctx *ctx, const qn_xint a[3], const qn_xint b[3]) {
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3;
    if (qn_x_sign(qn_x_sub(ctx, qn_x_mul(ctx, a[i], b[j]), qn_x_mul(ctx, a[j], b[i]))) != 0) {
      return 0;
    }
  }
  return 1;
}

/* Divides a vector by the power of two that all of it has: lengths stay short. */
static void shorten(qn_ctx *ctx, qn_int v[3]) {
  size_t zeros = SIZE_MAX;
  for (int i = 0; i < 3; i++) {
    if (v[i].n != 0) {
      size_t z = qn_int_trailing_zeros(v[i]);
      zeros = z < zeros ? z : zeros;
    }
  }
  if (zeros == SIZE_MAX || zeros == 0) {
    return;
  }
  for (int i = 0; i < 3; i++) {
    v[i] = qn_int_shr(ctx, v[i], zeros);
  }
}

void qn_form_axes(qn_ctx *ctx, const qn_xint h[6], qn_int axes[3][3], int signs[3]) {
  const qn_int one = qn_int_from(ctx, 1), zero = {0, NULL};
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      axes[i][j] = i == j ? one : zero;
    }
    signs[i] = 0;
  }
  for (int step = 0; step < 3; step++) {
    int pivot = -1;
    for (int i = step; i < 3 && pivot < 0; i++) {
      signs[step] = qn_x_sign(qn_form_x(ctx, h, axes[i], axes[i]));
      pivot = signs[step] != 0 ? i : -1;
    }
    /* No square is left: a mixed term makes one of f_i + f_j. */
    for (int i = step; i < 3 && pivot < 0; i++) {
      for (int j = i + 1; j < 3 && pivot < 0; j++) {
        int sign = qn_x_sign(qn_form_x(ctx, h, axes[i], axes[j]));
        if (sign != 0) {
          qn_combine_int(ctx, one, axes[i], one, axes[j], axes[i]);
          signs[step] = sign;
          pivot = i;
        }
      }
    }
    if (pivot < 0) {
      return; /* the form is zero on the rest */
    }
    for (int j = 0; j < 3 && pivot != step; j++) {
      qn_int swap = axes[pivot][j];
      axes[pivot][j] = axes[step][j];
      axes[step][j] = swap;
    }
    qn_int square = qn_form_x(ctx, h, axes[step], axes[step]).v;
    for (int i = step + 1; i < 3; i++) {
      qn_int mixed = qn_form_x(ctx, h, axes[step], axes[i]).v;
      if (mixed.n != 0) {
        qn_combine_int(ctx, square, axes[i], qn_int_neg(mixed), axes[step], axes[i]);
        shorten(ctx, axes[i]);
      }
    }
  }
}

int qn_form_definite(qn_ctx *ctx, const qn_xint h[6]) {
  qn_int axes[3][3];
  int signs[3], plus = 0, minus = 0;
  qn_form_axes(ctx, h, axes, signs);
  for (int i = 0; i < 3; i++) {
    plus += signs[i] > 0;
    minus += signs[i] < 0;
  }
  if (plus != 0 && minus != 0) {
    return 0;
  }
  return plus != 0 ? 1 : minus != 0 ? -1 : 2;
}

int qn_germ_sign(qn_ctx *ctx, const qn_germ *germ, const qn_int v[3]) {
  return qn_x_sign(germ->singular ? qn_form_x(ctx, germ->h, v, v) : qn_dot_x(ctx, germ->g, v));
}
