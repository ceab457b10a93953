/* What tests of trees share: reading, printing, and comparing trees node by node. */
#ifndef TESTS_MODEL_TREE_H
#define TESTS_MODEL_TREE_H

#include "model/solid.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct tree_text { char *at; size_t length, capacity; } tree_text;

static inline int tree_write(void *user, const char *text, size_t length) {
  tree_text *t = user;
  if (t->length + length + 1 > t->capacity) {
    t->capacity = 2 * (t->length + length + 1);
    t->at = realloc(t->at, t->capacity);
    assert_non_null(t->at);
  }
  memcpy(t->at + t->length, text, length);
  t->length += length;
  t->at[t->length] = '\0';
  return 0;
}

/* The model of a text that has no errors. */
static inline quoin_model *tree_read(const char *text, size_t length) {
  quoin_model *m;
  assert_int_equal(quoin_model_new(NULL, &m), QUOIN_OK);
  quoin_status status = quoin_model_read_text(m, QUOIN_ROOT, "t", text, length, NULL);
  if (status != QUOIN_OK) {
    for (size_t i = 0; i < quoin_model_diag_count(m); i++) {
      quoin_diag d;
      char line[2000];
      quoin_model_diag(m, i, &d);
      quoin_diag_format(&d, line, sizeof line);
      print_message("%s", line);
    }
    fail_msg("cannot read %.*s", length < 500 ? (int)length : 500, text);
  }
  return m;
}

static inline tree_text tree_print(const quoin_model *m) {
  tree_text t = {calloc(1, 1), 0, 1};
  assert_int_equal(quoin_model_write_tree(m, tree_write, &t), QUOIN_OK);
  return t;
}

/* The same tree: kinds, flags, links, numbers by form, names, materials, view and lights by value. */
static inline void tree_equal(const quoin_model *a, const quoin_model *b) {
  assert_int_equal(a->node_count, b->node_count);
  assert_int_equal(a->leaf_count, b->leaf_count);
  assert_int_equal(a->only, b->only);
  for (size_t i = 0; i < a->node_count; i++) {
    const qn_node *x = &a->nodes[i], *y = &b->nodes[i];
    assert_int_equal(x->kind, y->kind);
    assert_int_equal(x->flags, y->flags);
    assert_int_equal(x->parent, y->parent);
    assert_int_equal(x->first, y->first);
    assert_int_equal(x->last, y->last);
    assert_int_equal(x->next, y->next);
    assert_int_equal(x->numbers, y->numbers);
    for (size_t k = 0; k < x->numbers; k++) {
      assert_true(qn_num_equal(a->numbers[x->number0 + k], b->numbers[y->number0 + k]));
    }
    if (x->kind == QN_NODE_LEAF) {
      assert_int_equal(x->payload, y->payload);
    } else if (x->kind == QN_NODE_NAME) {
      assert_string_equal(a->names[x->payload], b->names[y->payload]);
    } else if (x->kind == QN_NODE_COLOR) {
      const qn_material *p = &a->materials[x->payload], *q = &b->materials[y->payload];
      assert_int_equal(p->has, q->has);
      for (int k = 0; k < 4; k++) {
        assert_true(p->color[k] == q->color[k]);
      }
      assert_true(p->ambient == q->ambient && p->diffuse == q->diffuse && p->specular == q->specular && p->shininess == q->shininess);
    }
  }
  assert_int_equal(a->light_count, b->light_count);
  for (size_t i = 0; i < a->light_count; i++) {
    const qn_light *p = &a->lights[i], *q = &b->lights[i];
    assert_int_equal(p->directional, q->directional);
    for (int k = 0; k < 3; k++) {
      assert_true(p->color[k] == q->color[k]);
      assert_true(p->directional ? p->direction[k] == q->direction[k] : p->at[k] == q->at[k]);
    }
  }
  const qn_view *v = &a->view, *w = &b->view;
  assert_true(v->has_camera == w->has_camera && v->has_up == w->has_up && v->has_look == w->has_look && v->has_fov == w->has_fov &&
              v->has_projection == w->has_projection && v->has_background == w->has_background && v->orthographic == w->orthographic);
  assert_true(v->fov == w->fov && v->near == w->near);
  for (int k = 0; k < 3; k++) {
    assert_true(v->eye[k] == w->eye[k] && v->background[k] == w->background[k]);
    assert_true((!v->has_look || v->look[k] == w->look[k]) && (!v->has_up || v->up[k] == w->up[k]));
  }
}

/* Printing and reading gives the same tree, and printing that the same text. */
static inline void tree_round(const quoin_model *m) {
  tree_text one = tree_print(m);
  quoin_model *again = tree_read(one.at, one.length);
  tree_equal(m, again);
  tree_text two = tree_print(again);
  assert_int_equal(one.length, two.length);
  assert_memory_equal(one.at, two.at, one.length);
  quoin_model_free(again);
  free(one.at);
  free(two.at);
}

#endif
