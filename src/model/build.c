/* Building a tree by calls. A double means itself, exactly. */
#include "base/limits.h"
#include "model/words.h"

#include <math.h>
#include <string.h>

static const qn_code empty_code = QN_Q0501, singular_code = QN_Q0503;

static int may_add(const quoin_model *m, quoin_node parent) {
  return m && !m->frozen && parent < m->node_count && m->nodes[parent].kind != QN_NODE_LEAF;
}

static int finite(const double *v, size_t n) {
  for (size_t i = 0; i < n; i++) {
    if (!isfinite(v[i])) {
      return 0;
    }
  }
  return 1;
}

static void warn(quoin_model *m, qn_code code, const char *problem) {
  qn_report report = {.severity = qn_codes[code].severity, .code = qn_codes[code].text};
  qn_diags_add(&m->diags, &report, "%s", problem);
}

/* A node with the exact values of n doubles. */
static quoin_status add(quoin_model *m, quoin_node parent, qn_node_kind kind, uint32_t payload, const double *v, size_t n,
                        quoin_node *out) {
  qn_num numbers[16];
  qn_mark mark = qn_arena_mark(&m->ctx.arena);
  for (size_t i = 0; i < n; i++) {
    numbers[i] = qn_num_from_double(&m->ctx, v[i]);
  }
  uint32_t node = m->ctx.failed ? QN_NO_NODE : qn_solid_add(m, parent, kind, payload, QN_NO_LOC, numbers, n);
  if (node == QN_NO_NODE) {
    m->ctx.failed = QUOIN_OK;
    qn_arena_release(&m->ctx.arena, mark);
    return QUOIN_E_MEMORY;
  }
  if (out) {
    *out = node;
  }
  return QUOIN_OK;
}

/* A transform; a singular one is an intersection with nothing, which stays empty whatever is added. */
static quoin_status add_transform(quoin_model *m, quoin_node parent, qn_node_kind kind, const double *v, size_t n, int singular,
                                  quoin_node *out) {
  if (!singular) {
    return add(m, parent, kind, 0, v, n, out);
  }
  quoin_node node;
  if (!qn_grow(&m->mem, &m->nodes, &m->node_capacity, m->node_count + 2)) {
    return QUOIN_E_MEMORY;
  }
  quoin_status status = add(m, parent, QN_NODE_INTERSECTION, 0, NULL, 0, &node);
  if (status == QUOIN_OK) {
    status = add(m, node, QN_NODE_UNION, 0, NULL, 0, NULL);
  }
  if (status == QUOIN_OK) {
    warn(m, singular_code, "a singular transform flattens its children, so the solid is empty");
    if (out) {
      *out = node;
    }
  }
  return status;
}

/* A leaf; one of a size that is zero or less is an empty union, with a warning. */
static quoin_status add_leaf(quoin_model *m, quoin_node parent, qn_prim prim, const double *v, size_t n, int empty, quoin_node *out) {
  if (m->leaf_count >= QN_MAX_LEAVES) {
    return QUOIN_E_LIMIT;
  }
  if (!empty) {
    return add(m, parent, QN_NODE_LEAF, (uint32_t)prim, v, n, out);
  }
  quoin_status status = add(m, parent, QN_NODE_UNION, 0, NULL, 0, out);
  if (status == QUOIN_OK) {
    warn(m, empty_code, "a size is zero or less, so the solid is empty");
  }
  return status;
}

static int any_not_positive(const double *v, size_t n) {
  for (size_t i = 0; i < n; i++) {
    if (!(v[i] > 0)) {
      return 1;
    }
  }
  return 0;
}

static int allowed(const quoin_model *m, quoin_node parent, const double *v, size_t n) {
  return may_add(m, parent) && v && finite(v, n);
}

QUOIN_API quoin_status quoin_add_boolean(quoin_model *m, quoin_node parent, quoin_op op, quoin_node *out) {
  if (!may_add(m, parent) || op < QUOIN_UNION || op > QUOIN_INTERSECTION) {
    return QUOIN_E_ARGUMENT;
  }
  static const qn_node_kind kinds[] = {
    [QUOIN_UNION] = QN_NODE_UNION, [QUOIN_DIFFERENCE] = QN_NODE_DIFFERENCE, [QUOIN_INTERSECTION] = QN_NODE_INTERSECTION};
  return add(m, parent, kinds[op], 0, NULL, 0, out);
}

QUOIN_API quoin_status quoin_add_translate(quoin_model *m, quoin_node parent, const double v[3], quoin_node *out) {
  if (!allowed(m, parent, v, 3)) {
    return QUOIN_E_ARGUMENT;
  }
  return add(m, parent, QN_NODE_TRANSLATE, 0, v, 3, out);
}

QUOIN_API quoin_status quoin_add_multmatrix(quoin_model *m, quoin_node parent, const double matrix[12], quoin_node *out) {
  if (!allowed(m, parent, matrix, 12)) {
    return QUOIN_E_ARGUMENT;
  }
  qn_mark mark = qn_arena_mark(&m->ctx.arena);
  qn_num n[12], first[3], minors[3];
  for (size_t i = 0; i < 12; i++) {
    n[i] = qn_num_from_double(&m->ctx, matrix[i]);
  }
  for (size_t j = 0; j < 3; j++) {
    size_t k = (j + 1) % 3, l = (j + 2) % 3;
    qn_num x[2] = {n[4 + k], n[4 + l]}, y[2] = {n[8 + l], qn_num_neg(&m->ctx, n[8 + k])};
    minors[j] = qn_num_dot(&m->ctx, 2, x, y);
    first[j] = n[j];
  }
  int singular = qn_num_is_zero(qn_num_dot(&m->ctx, 3, first, minors));
  quoin_status failed = m->ctx.failed;
  m->ctx.failed = QUOIN_OK;
  qn_arena_release(&m->ctx.arena, mark);
  return failed ? failed : add_transform(m, parent, QN_NODE_MULTMATRIX, matrix, 12, singular, out);
}

QUOIN_API quoin_status quoin_add_rotate(quoin_model *m, quoin_node parent, const double degrees[3], quoin_node *out) {
  if (!allowed(m, parent, degrees, 3)) {
    return QUOIN_E_ARGUMENT;
  }
  return add(m, parent, QN_NODE_ROTATE, 0, degrees, 3, out);
}

QUOIN_API quoin_status quoin_add_scale(quoin_model *m, quoin_node parent, const double v[3], quoin_node *out) {
  if (!allowed(m, parent, v, 3)) {
    return QUOIN_E_ARGUMENT;
  }
  return add_transform(m, parent, QN_NODE_SCALE, v, 3, v[0] == 0 || v[1] == 0 || v[2] == 0, out);
}

QUOIN_API quoin_status quoin_add_color(quoin_model *m, quoin_node parent, const double rgba[4], quoin_node *out) {
  if (!allowed(m, parent, rgba, 4)) {
    return QUOIN_E_ARGUMENT;
  }
  qn_material material = {.has = QN_HAS_COLOR};
  memcpy(material.color, rgba, sizeof material.color);
  uint32_t n = qn_solid_material(m, &material);
  if (n == UINT32_MAX) {
    return QUOIN_E_MEMORY;
  }
  quoin_status status = add(m, parent, QN_NODE_COLOR, n, NULL, 0, out);
  m->material_count -= status != QUOIN_OK;
  return status;
}

QUOIN_API quoin_status quoin_add_name(quoin_model *m, quoin_node parent, const char *name, quoin_node *out) {
  if (!may_add(m, parent) || !name) {
    return QUOIN_E_ARGUMENT;
  }
  uint32_t n = qn_solid_name(m, name, strlen(name));
  if (n == UINT32_MAX) {
    return QUOIN_E_MEMORY;
  }
  quoin_status status = add(m, parent, QN_NODE_NAME, n, NULL, 0, out);
  m->name_count -= status != QUOIN_OK;
  return status;
}

QUOIN_API quoin_status quoin_add_sphere(quoin_model *m, quoin_node parent, double r, quoin_node *out) {
  if (!allowed(m, parent, &r, 1)) {
    return QUOIN_E_ARGUMENT;
  }
  return add_leaf(m, parent, QN_SPHERE, &r, 1, !(r > 0), out);
}

QUOIN_API quoin_status quoin_add_ellipsoid(quoin_model *m, quoin_node parent, const double r[3], quoin_node *out) {
  if (!allowed(m, parent, r, 3)) {
    return QUOIN_E_ARGUMENT;
  }
  return add_leaf(m, parent, QN_ELLIPSOID, r, 3, any_not_positive(r, 3), out);
}

static quoin_status box(quoin_model *m, quoin_node parent, qn_prim prim, const double size[3], int center, quoin_node *out) {
  if (!allowed(m, parent, size, 3)) {
    return QUOIN_E_ARGUMENT;
  }
  double v[4] = {size[0], size[1], size[2], center ? 1 : 0};
  return add_leaf(m, parent, prim, v, 4, any_not_positive(size, 3), out);
}

QUOIN_API quoin_status quoin_add_cube(quoin_model *m, quoin_node parent, const double size[3], int center, quoin_node *out) {
  return box(m, parent, QN_CUBE, size, center, out);
}

QUOIN_API quoin_status quoin_add_wedge(quoin_model *m, quoin_node parent, const double size[3], int center, quoin_node *out) {
  return box(m, parent, QN_WEDGE, size, center, out);
}

QUOIN_API quoin_status quoin_add_cylinder(quoin_model *m, quoin_node parent, double h, double r1, double r2, int center, quoin_node *out) {
  double v[6] = {h, r1, r1, r2, r2, center ? 1 : 0};
  if (!allowed(m, parent, v, 6)) {
    return QUOIN_E_ARGUMENT;
  }
  return add_leaf(m, parent, QN_CYLINDER, v, 6, !(h > 0) || r1 < 0 || r2 < 0 || (r1 == 0 && r2 == 0), out);
}

QUOIN_API quoin_status quoin_add_paraboloid(quoin_model *m, quoin_node parent, double h, double r, quoin_node *out) {
  double v[4] = {h, r, r, 0};
  if (!allowed(m, parent, v, 4)) {
    return QUOIN_E_ARGUMENT;
  }
  return add_leaf(m, parent, QN_PARABOLOID, v, 4, any_not_positive(v, 2), out);
}

QUOIN_API quoin_status quoin_add_hyperboloid(quoin_model *m, quoin_node parent, double h, double r, double rc, quoin_node *out) {
  double v[3] = {h, r, rc};
  if (!allowed(m, parent, v, 3)) {
    return QUOIN_E_ARGUMENT;
  }
  return add_leaf(m, parent, QN_HYPERBOLOID1, v, 3, any_not_positive(v, 2) || rc < 0, out);
}

QUOIN_API quoin_status quoin_add_hyperboloid2(quoin_model *m, quoin_node parent, double h, double r, double gap, quoin_node *out) {
  double v[3] = {h, r, gap};
  if (!allowed(m, parent, v, 3) || gap < 0 || (h > 0 && gap >= h)) {
    return QUOIN_E_ARGUMENT;
  }
  return add_leaf(m, parent, QN_HYPERBOLOID2, v, 3, any_not_positive(v, 2), out);
}

QUOIN_API quoin_status quoin_add_saddle(quoin_model *m, quoin_node parent, double a, double b, quoin_node *out) {
  double v[2] = {a, b};
  if (!allowed(m, parent, v, 2)) {
    return QUOIN_E_ARGUMENT;
  }
  return add_leaf(m, parent, QN_SADDLE, v, 2, any_not_positive(v, 2), out);
}

QUOIN_API quoin_status quoin_add_quadric(quoin_model *m, quoin_node parent, const double coefficients[10], quoin_node *out) {
  if (!allowed(m, parent, coefficients, 10)) {
    return QUOIN_E_ARGUMENT;
  }
  return add_leaf(m, parent, QN_QUADRIC, coefficients, 10, 0, out);
}

QUOIN_API quoin_status quoin_add_halfspace(quoin_model *m, quoin_node parent, const double n[3], double d, quoin_node *out) {
  if (!allowed(m, parent, n, 3)) {
    return QUOIN_E_ARGUMENT;
  }
  double v[4] = {n[0], n[1], n[2], d};
  if (!isfinite(d) || (n[0] == 0 && n[1] == 0 && n[2] == 0)) {
    return QUOIN_E_ARGUMENT;
  }
  return add_leaf(m, parent, QN_HALFSPACE, v, 4, 0, out);
}

QUOIN_API quoin_status quoin_add_superquadric(quoin_model *m, quoin_node parent, const double r[3], double e, double n, quoin_node *out) {
  if (!allowed(m, parent, r, 3)) {
    return QUOIN_E_ARGUMENT;
  }
  double v[5] = {r[0], r[1], r[2], e, n};
  if (!finite(v, 5) || e < 0 || n < 0) {
    return QUOIN_E_ARGUMENT;
  }
  return add_leaf(m, parent, QN_SUPERQUADRIC, v, 5, any_not_positive(v, 3), out);
}
