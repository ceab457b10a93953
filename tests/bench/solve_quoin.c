/* The library's own solver of one half-space along one line, from the inside: filter, exact tier, order and rounding. */
#include "ray/scratch.h"
#include "solvers.h"

#include <stdlib.h>

#define UNFILTERED 0x1p70 /* outside the filter's range */

struct library {
  quoin_model *model;
  quoin_scene *scene;
  qn_scratch *scratch;
  const solver_case *cases;
};

static int add(quoin_model *m, const placed *s) {
  quoin_node at, in;
  double matrix[12], q[10] = {s->s[0], s->s[1], s->s[2], 0, 0, 0, 0, 0, 2 * s->l, s->k};
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 4; j++) {
      matrix[4 * i + j] = j < 3 ? s->M[i][j] : 0;
    }
  }
  return quoin_add_translate(m, QUOIN_ROOT, s->p, &at) == QUOIN_OK && quoin_add_multmatrix(m, at, matrix, &in) == QUOIN_OK &&
         quoin_add_quadric(m, in, q, NULL) == QUOIN_OK;
}

library *library_new(size_t n, const solver_case *cases) {
  library *lib = calloc(1, sizeof *lib);
  int ok = lib && quoin_model_new(NULL, &lib->model) == QUOIN_OK;
  for (size_t i = 0; ok && i < n; i++) {
    ok = add(lib->model, &cases[i].solid) && add(lib->model, &cases[i].partner);
  }
  ok = ok && quoin_scene_compile(lib->model, NULL, &lib->scene) == QUOIN_OK && lib->scene->leaf_count == 2 * n &&
       qn_scratch_new(lib->scene, &lib->scratch) == QUOIN_OK;
  if (!ok) {
    library_free(lib);
    return NULL;
  }
  lib->cases = cases;
  return lib;
}

void library_free(library *lib) {
  if (lib) {
    qn_scratch_free(lib->scratch);
    quoin_scene_free(lib->scene);
    quoin_model_free(lib->model);
    free(lib);
  }
}

static uint32_t solve(library *lib, size_t leaf) {
  const qn_leaf *l = &lib->scene->leaves[leaf];
  qn_filter_leaf frame;
  qn_filter_leaf_begin(&lib->scratch->filter, l->pivot, &frame);
  return qn_solve_half(lib->scratch, l, &frame, l->half0);
}

static void begin(library *lib, size_t i, int exact, qn_line *line) {
  const solver_case *c = &lib->cases[i];
  double scale = exact ? UNFILTERED : 1, d[3] = {c->d[0] * scale, c->d[1] * scale, c->d[2] * scale};
  qn_scratch_begin(lib->scratch);
  qn_line_from_doubles(c->o, d, line);
  qn_solve_begin(lib->scratch, line);
}

static qn_bound bound_of(library *lib, size_t leaf, uint32_t solved, uint32_t which) {
  const qn_root_at *root = &lib->scratch->roots[lib->scratch->solved[solved].root0 + which];
  return (qn_bound){root->t, root->e, solved, lib->scene->leaves[leaf].half0, which};
}

solved_roots library_solve(library *lib, size_t i, int rounded, int exact) {
  qn_line line;
  begin(lib, i, exact, &line);
  uint32_t at = solve(lib, 2 * i);
  solved_roots out = {0, {0, 0}, {0, 0}};
  if (at == QN_NO_SOLVED) {
    return out;
  }
  const qn_solved *v = &lib->scratch->solved[at];
  out.count = (int)v->roots + v->touches;
  double scale = exact ? UNFILTERED : 1;
  for (int k = 0; k < out.count; k++) {
    qn_bound b = bound_of(lib, 2 * i, at, (uint32_t)k);
    if (rounded) {
      qn_place place = qn_bound_place(lib->scratch, &b);
      out.t[k] = qn_place_round(lib->scene, lib->scratch, &line, &place) * scale;
    } else {
      out.t[k] = b.t * scale;
    }
  }
  if (out.count == 1) {
    out.t[1] = out.t[0];
  }
  return out;
}

int library_order(library *lib, size_t i, int exact) {
  qn_line line;
  begin(lib, i, exact, &line);
  uint32_t a = solve(lib, 2 * i), b = solve(lib, 2 * i + 1);
  const qn_solved *v = lib->scratch->solved;
  if (a == QN_NO_SOLVED || b == QN_NO_SOLVED || v[a].roots == 0 || v[b].roots == 0) {
    return 2;
  }
  qn_bound x = bound_of(lib, 2 * i, a, 0), y = bound_of(lib, 2 * i + 1, b, 0);
  return qn_bound_cmp(lib->scratch, &x, &y);
}

void library_exact(library *lib, double *solved, double *rounded) {
  qn_counts *c = qn_scratch_counts(lib->scratch);
  *solved = (double)c->exact_signs;
  *rounded = (double)c->exact_roundings;
  c->exact_signs = c->exact_roundings = 0;
}
