/* The tree as canonical text that reads back to the same tree: one node a line, numbers as qn_num_text writes them.
   Walks by the nodes' own links, so depth costs nothing. */
#include "model/polyhedron.h"

#include <stdio.h>
#include <string.h>

enum { BUFFER = 1 << 14, DEEPEST_INDENT = 40 /* levels; a chain of 100,000 would otherwise be 10^10 blanks */ };

typedef struct printer {
  const quoin_model *m;
  quoin_write_fn write;
  void *user;
  qn_ctx ctx; /* texts of numbers */
  size_t used;
  quoin_status status;
  char buffer[BUFFER];
} printer;

static void flush(printer *p) {
  if (p->status == QUOIN_OK && p->used && p->write(p->user, p->buffer, p->used)) {
    p->status = QUOIN_E_IO;
  }
  p->used = 0;
}

static void put(printer *p, const char *text, size_t length) {
  while (length) {
    if (p->used == BUFFER) {
      flush(p);
    }
    size_t n = BUFFER - p->used < length ? BUFFER - p->used : length;
    memcpy(p->buffer + p->used, text, n);
    p->used += n;
    text += n;
    length -= n;
  }
}

static void say(printer *p, const char *text) {
  put(p, text, strlen(text));
}

static void number(printer *p, qn_num n) {
  qn_mark mark = qn_arena_mark(&p->ctx.arena);
  const char *text = qn_num_text(&p->ctx, n);
  if (text) {
    say(p, text);
  } else {
    p->status = QUOIN_E_MEMORY;
  }
  qn_arena_release(&p->ctx.arena, mark);
}

/* [a, b, ...] */
static void list(printer *p, const qn_num *n, size_t count) {
  say(p, "[");
  for (size_t i = 0; i < count; i++) {
    say(p, i ? ", " : "");
    number(p, n[i]); /* NOLINT(clang-analyzer-core.NullDereference): null only for kinds without numbers, which list none */
  }
  say(p, "]");
}

/* The shortest decimal that reads back to the double. */
static void real(printer *p, double d) {
  char text[40];
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(text, sizeof text, "%.*g", digits, d);
    double back;
    /* NOLINTNEXTLINE(cert-err34-c): the text was printed from a finite double */
    if (sscanf(text, "%lf", &back) == 1 && back == d) {
      break;
    }
  }
  say(p, text);
}

static void reals(printer *p, const double *d, size_t count) {
  say(p, "[");
  for (size_t i = 0; i < count; i++) {
    say(p, i ? ", " : "");
    real(p, d[i]);
  }
  say(p, "]");
}

static void quoted(printer *p, const char *text) {
  say(p, "\"");
  for (; *text; text++) {
    unsigned char c = (unsigned char)*text;
    char escape[8];
    if (c == '"' || c == '\\') {
      escape[0] = '\\';
      escape[1] = (char)c;
      put(p, escape, 2);
    } else if (c == '\n' || c == '\t' || c == '\r') {
      say(p, c == '\n' ? "\\n" : c == '\t' ? "\\t" : "\\r");
    } else if (c < 32 || c == 127) {
      snprintf(escape, sizeof escape, "\\x%02x", (unsigned)c);
      say(p, escape);
    } else {
      put(p, text, 1);
    }
  }
  say(p, "\"");
}

static void indent(printer *p, size_t depth) {
  static const char blanks[] = "                                                                                ";
  put(p, blanks, 2 * (depth < DEEPEST_INDENT ? depth : DEEPEST_INDENT));
}

static void material(printer *p, const qn_material *m) {
  if (m->has == QN_HAS_COLOR) {
    say(p, "color(");
    reals(p, m->color, 4);
    say(p, ")");
    return;
  }
  static const char *const words[] = {"color = ", "ambient = ", "diffuse = ", "specular = ", "shininess = "};
  const double values[] = {0, m->ambient, m->diffuse, m->specular, m->shininess};
  int any = 0;
  say(p, "material(");
  for (int i = 0; i < 5; i++) {
    if (m->has & (1u << i)) {
      say(p, any ? ", " : "");
      say(p, words[i]);
      if (i == 0) {
        reals(p, m->color, 4);
      } else {
        real(p, values[i]);
      }
      any = 1;
    }
  }
  say(p, ")");
}

static void named_number(printer *p, const char *name, qn_num n) {
  say(p, name);
  number(p, n);
}

/* One radius, or two semi-axes. */
static void radii(printer *p, const char *name, const qn_num *r) {
  say(p, name);
  if (qn_num_equal(r[0], r[1])) {
    number(p, r[0]);
  } else {
    list(p, r, 2);
  }
}

static void truth(printer *p, const char *name, qn_num n) {
  if (!qn_num_is_zero(n)) {
    say(p, name);
    say(p, "true");
  }
}

/* Points, and the faces as they follow from the planes. */
static void polyhedron(printer *p, const qn_num *a) {
  int64_t n = 0, m = 0;
  qn_num_is_integer(a[0], &n);
  qn_num_is_integer(a[1], &m);
  const qn_num *planes = a + 2, *vertices = planes + 4 * n;
  say(p, "points = [");
  for (int64_t i = 0; i < m; i++) {
    say(p, i ? ", " : "");
    list(p, vertices + 3 * i, 3);
  }
  say(p, "], faces = [");
  qn_mark mark = qn_arena_mark(&p->ctx.arena);
  uint32_t *corners = qn_arena_take(&p->ctx.arena, (size_t)m * sizeof *corners);
  double (*near)[3] = qn_arena_take(&p->ctx.arena, (size_t)m * sizeof *near);
  if (!corners || !near) {
    p->status = QUOIN_E_MEMORY;
    return;
  }
  for (int64_t i = 0; i < m; i++) {
    qn_polyhedron_shadow(3, vertices + 3 * i, near[i]);
  }
  for (int64_t f = 0; f < n; f++) {
    size_t count = qn_polyhedron_face(&p->ctx, planes + 4 * f, vertices, near, (size_t)m, corners);
    say(p, f ? ", [" : "[");
    for (size_t k = 0; k < count; k++) {
      char text[24];
      snprintf(text, sizeof text, k ? ", %lu" : "%lu", (unsigned long)corners[k]);
      say(p, text);
    }
    say(p, "]");
  }
  qn_arena_release(&p->ctx.arena, mark);
  say(p, "]");
}

static void leaf(printer *p, const qn_node *d) {
  const qn_num *a = p->m->numbers + d->number0;
  switch ((qn_prim)d->payload) {
  case QN_SPHERE: named_number(p, "sphere(r = ", a[0]); break;
  case QN_ELLIPSOID:
    say(p, "ellipsoid(r = ");
    list(p, a, 3);
    break;
  case QN_CUBE:
  case QN_WEDGE:
    say(p, d->payload == QN_CUBE ? "cube(size = " : "wedge(size = ");
    list(p, a, 3);
    truth(p, ", center = ", a[3]);
    break;
  case QN_CYLINDER:
    named_number(p, "cylinder(h = ", a[0]);
    radii(p, ", r1 = ", a + 1);
    radii(p, ", r2 = ", a + 3);
    truth(p, ", center = ", a[5]);
    say(p, ", $fn = 0"); /* round, whatever $fn is where this text is put */
    break;
  case QN_PRISM:
    named_number(p, "cylinder(h = ", a[1]);
    named_number(p, ", r1 = ", a[2]);
    named_number(p, ", r2 = ", a[3]);
    truth(p, ", center = ", a[4]);
    named_number(p, ", $fn = ", a[0]);
    break;
  case QN_PARABOLOID:
    named_number(p, "paraboloid(h = ", a[0]);
    radii(p, ", r = ", a + 1);
    truth(p, ", center = ", a[3]);
    break;
  case QN_HYPERBOLOID1:
  case QN_HYPERBOLOID2:
    named_number(p, "hyperboloid(h = ", a[0]);
    named_number(p, ", r = ", a[1]);
    named_number(p, d->payload == QN_HYPERBOLOID1 ? ", rc = " : ", gap = ", a[2]);
    break;
  case QN_SADDLE:
    named_number(p, "saddle(a = ", a[0]);
    named_number(p, ", b = ", a[1]);
    break;
  case QN_QUADRIC:
    say(p, "quadric(");
    list(p, a, 10);
    break;
  case QN_HALFSPACE:
    say(p, "halfspace(n = ");
    list(p, a, 3);
    named_number(p, ", d = ", a[3]);
    break;
  case QN_SUPERQUADRIC:
    say(p, "superquadric(r = ");
    list(p, a, 3);
    named_number(p, ", e = ", a[3]);
    named_number(p, ", n = ", a[4]);
    break;
  case QN_POLYHEDRON:
    say(p, "polyhedron(");
    polyhedron(p, a);
    break;
  case QN_PRIM_COUNT: break;
  }
  if (d->flags & QN_NODE_PLACED) {
    say(p, ", base = ");
    list(p, a + d->numbers - 6, 3);
    say(p, ", axis = ");
    list(p, a + d->numbers - 3, 3);
  }
  say(p, ")");
}

static void head(printer *p, const qn_node *d) {
  const qn_num *a = d->numbers ? p->m->numbers + d->number0 : NULL;
  say(p, d->flags & QN_MOD_BACKGROUND ? "%" : "");
  say(p, d->flags & QN_MOD_HIGHLIGHT ? "#" : "");
  say(p, d->flags & QN_MOD_ONLY ? "!" : "");
  switch ((qn_node_kind)d->kind) {
  case QN_NODE_UNION: say(p, "union()"); break;
  case QN_NODE_DIFFERENCE: say(p, "difference()"); break;
  case QN_NODE_INTERSECTION: say(p, "intersection()"); break;
  case QN_NODE_TRANSLATE:
  case QN_NODE_ROTATE:
  case QN_NODE_SCALE:
  case QN_NODE_MIRROR:
    say(p, d->kind == QN_NODE_TRANSLATE ? "translate("
           : d->kind == QN_NODE_ROTATE  ? "rotate("
           : d->kind == QN_NODE_SCALE   ? "scale("
                                        : "mirror(");
    list(p, a, 3);
    say(p, ")");
    break;
  case QN_NODE_ROTATE_AXIS:
    named_number(p, "rotate(a = ", a[0]); /* NOLINT(clang-analyzer-core.NullDereference): this kind has four numbers */
    say(p, ", v = ");
    list(p, a + 1, 3);
    say(p, ")");
    break;
  case QN_NODE_MULTMATRIX:
    say(p, "multmatrix([");
    for (size_t i = 0; i < 3; i++) {
      say(p, i ? ", " : "");
      list(p, a + 4 * i, 4);
    }
    say(p, "])");
    break;
  case QN_NODE_COLOR: material(p, &p->m->materials[d->payload]); break;
  case QN_NODE_NAME:
    say(p, "name(");
    quoted(p, p->m->names[d->payload]);
    say(p, ")");
    break;
  case QN_NODE_LEAF: leaf(p, d); break;
  }
}

static void scene_words(printer *p) {
  const qn_view *v = &p->m->view;
  if (v->has_camera) {
    say(p, "camera(eye = ");
    reals(p, v->eye, 3);
    if (v->has_look) {
      say(p, ", look = ");
      reals(p, v->look, 3);
    }
    if (v->has_up) {
      say(p, ", up = ");
      reals(p, v->up, 3);
    }
    if (v->has_fov) {
      say(p, ", fov = ");
      real(p, v->fov);
    }
    if (v->near != 0) {
      say(p, ", near = ");
      real(p, v->near);
    }
    if (v->has_projection) {
      say(p, v->orthographic ? ", projection = \"ortho\"" : ", projection = \"persp\"");
    }
    say(p, ");\n");
  }
  if (v->has_background) {
    say(p, "background(");
    reals(p, v->background, 3);
    say(p, ");\n");
  }
  for (size_t i = 0; i < p->m->light_count; i++) {
    const qn_light *l = &p->m->lights[i];
    say(p, l->directional ? "light(direction = " : "light(at = ");
    reals(p, l->directional ? l->direction : l->at, 3);
    say(p, ", color = ");
    reals(p, l->color, 3);
    say(p, ");\n");
  }
}

QUOIN_API quoin_status quoin_model_write_tree(const quoin_model *model, quoin_write_fn write, void *user) {
  if (!model || !write) {
    return QUOIN_E_ARGUMENT;
  }
  qn_mem mem;
  qn_mem_init(&mem, &model->mem.a); /* a count of its own: the model is not touched */
  printer *p = qn_alloc(&mem, sizeof *p);
  if (!p) {
    return QUOIN_E_MEMORY;
  }
  p->m = model;
  p->write = write;
  p->user = user;
  p->used = 0;
  p->status = QUOIN_OK;
  qn_ctx_init(&p->ctx, &mem);
  scene_words(p);
  size_t depth = 0;
  uint32_t n = model->nodes[0].first;
  while (n != QN_NO_NODE && n != 0 && p->status == QUOIN_OK) {
    const qn_node *d = &model->nodes[n];
    indent(p, depth);
    head(p, d);
    if (d->first != QN_NO_NODE) {
      say(p, " {\n");
      depth++;
      n = d->first;
      continue;
    }
    say(p, ";\n");
    while (n != 0 && model->nodes[n].next == QN_NO_NODE) {
      n = model->nodes[n].parent;
      if (n != 0) {
        indent(p, --depth);
        say(p, "}\n");
      }
    }
    n = n ? model->nodes[n].next : 0;
  }
  flush(p);
  quoin_status status = p->ctx.failed ? p->ctx.failed : p->status;
  qn_ctx_free(&p->ctx);
  qn_free(&mem, p, sizeof *p);
  return status;
}
