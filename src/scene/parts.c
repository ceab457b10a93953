/* What a part is called and what it looks like. */
#include "scene/compile.h"

#include <string.h>

/* --- materials: each distinct one once --------------------------------------------------------------------------- */

typedef struct qn_material_table {
  uint32_t *slots; /* index + 1, 0 empty */
  size_t slot_count;
} qn_material_table;

/* What is not said: a warm yellow, and the usual weights of the Phong model. */
static const qn_material DEFAULT = {0, {0.976, 0.843, 0.172, 1}, 0.2, 0.8, 0.3, 30};

static uint64_t mix(uint64_t h, uint64_t v) {
  h = (h ^ v) * 0x9E3779B97F4A7C15u;
  return h ^ h >> 32;
}
static uint64_t bits_of(double v) {
  uint64_t u;
  v = v == 0 ? 0 : v; /* -0 is 0 */
  memcpy(&u, &v, sizeof u);
  return u;
}
static uint64_t hash_of(const qn_material *m) {
  uint64_t h = mix(1, m->has);
  for (int i = 0; i < 4; i++) {
    h = mix(h, bits_of(m->color[i]));
  }
  return mix(mix(mix(mix(h, bits_of(m->ambient)), bits_of(m->diffuse)), bits_of(m->specular)), bits_of(m->shininess));
}
static int same(const qn_material *x, const qn_material *y) {
  int equal = x->has == y->has && x->ambient == y->ambient && x->diffuse == y->diffuse && x->specular == y->specular &&
              x->shininess == y->shininess;
  for (int i = 0; i < 4; i++) {
    equal &= x->color[i] == y->color[i];
  }
  return equal;
}

static uint32_t add_material(qn_building *b, const qn_material *m) {
  quoin_scene *s = b->scene;
  qn_material_table *t = b->material_table;
  if (!t && !(t = b->material_table = qn_alloc_zeroed(b->mem, sizeof *t))) {
    return UINT32_MAX;
  }
  if (2 * (s->material_count + 1) > t->slot_count) {
    size_t n = t->slot_count ? t->slot_count * 2 : 16;
    uint32_t *slots = qn_alloc_zeroed(b->mem, n * sizeof *slots);
    if (!slots) {
      return UINT32_MAX;
    }
    qn_free(b->mem, t->slots, t->slot_count * sizeof *t->slots);
    t->slots = slots;
    t->slot_count = n;
    for (size_t i = 0; i < s->material_count; i++) {
      size_t at = (size_t)hash_of(&s->materials[i]) & (n - 1);
      while (slots[at]) {
        at = (at + 1) & (n - 1);
      }
      slots[at] = (uint32_t)i + 1;
    }
  }
  size_t at = (size_t)hash_of(m) & (t->slot_count - 1);
  while (t->slots[at]) {
    if (same(&s->materials[t->slots[at] - 1], m)) {
      return t->slots[at] - 1;
    }
    at = (at + 1) & (t->slot_count - 1);
  }
  if (!qn_grow(b->mem, &s->materials, &b->material_capacity, s->material_count + 1)) {
    return UINT32_MAX;
  }
  s->materials[s->material_count++] = *m;
  t->slots[at] = (uint32_t)s->material_count;
  return t->slots[at] - 1;
}

uint32_t qn_material_under(qn_building *b, uint32_t outer, const qn_material *inner) {
  if (!inner) {
    return add_material(b, &DEFAULT);
  }
  qn_material m = b->scene->materials[outer];
  unsigned news = inner->has & ~m.has;
  if (!news) {
    return outer;
  }
  if (news & QN_HAS_COLOR) {
    memcpy(m.color, inner->color, sizeof m.color);
  }
  m.ambient = news & QN_HAS_AMBIENT ? inner->ambient : m.ambient;
  m.diffuse = news & QN_HAS_DIFFUSE ? inner->diffuse : m.diffuse;
  m.specular = news & QN_HAS_SPECULAR ? inner->specular : m.specular;
  m.shininess = news & QN_HAS_SHININESS ? inner->shininess : m.shininess;
  m.has |= news;
  return add_material(b, &m);
}

void qn_materials_free(qn_building *b) {
  qn_material_table *t = b->material_table;
  if (t) {
    qn_free(b->mem, t->slots, t->slot_count * sizeof *t->slots);
    qn_free(b->mem, t, sizeof *t);
    b->material_table = NULL;
  }
}

/* --- names ------------------------------------------------------------------------------------------------------- */

uint32_t qn_name_add(qn_building *b, const char *text) {
  quoin_scene *s = b->scene;
  size_t length = strlen(text) + 1;
  if (s->name_size + length >= UINT32_MAX || !qn_grow(b->mem, &s->name_text, &b->name_capacity, s->name_size + length)) {
    return UINT32_MAX;
  }
  memcpy(s->name_text + s->name_size, text, length);
  s->name_size += length;
  return (uint32_t)(s->name_size - length);
}

/* A million names are made of them. */
static char *put_number(char *at, uint64_t v) {
  char digits[24];
  int n = 0;
  do {
    digits[n++] = (char)('0' + v % 10);
  } while ((v /= 10) != 0);
  while (n) {
    *at++ = digits[--n];
  }
  return at;
}

static size_t digits_of(uint64_t v) {
  size_t n = 1;
  while (v >= 10) {
    v /= 10;
    n++;
  }
  return n;
}

size_t qn_name_of_leaf(const quoin_model *model, uint32_t node, size_t ordinal, char text[QN_PLACE_NAME]) {
  const qn_node *n = &model->nodes[node];
  char *at = text;
  for (const char *c = qn_prims[n->payload].word; *c; c++) {
    *at++ = *c;
  }
  if (n->loc.line) {
    *at++ = '@';
    at = put_number(at, n->loc.line);
    *at++ = ':';
    at = put_number(at, n->loc.column);
  } else { /* built by calls */
    *at++ = '#';
    at = put_number(at, ordinal);
  }
  *at++ = '\0';
  return (size_t)(at - text);
}

size_t qn_name_length(const quoin_model *model, uint32_t node, size_t ordinal) {
  const qn_node *n = &model->nodes[node];
  size_t word = strlen(qn_prims[n->payload].word);
  return word + (n->loc.line ? 3 + digits_of(n->loc.line) + digits_of(n->loc.column) : 2 + digits_of(ordinal));
}
