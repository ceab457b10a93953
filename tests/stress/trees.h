/* Random models as trees of text, for the laws: what is drawn is a union of operands, from which each law makes the models it compares. */
#ifndef QN_STRESS_TREES_H
#define QN_STRESS_TREES_H

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct dice { uint64_t x; } dice; /* splitmix64 */
static inline uint64_t dice_next(dice *d) {
  uint64_t z = (d->x += 0x9E3779B97F4A7C15u);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}
static inline int roll(dice *d, int n) { return (int)(dice_next(d) % (uint64_t)n); }
static inline int from_to(dice *d, int lo, int hi) { return lo + roll(d, hi - lo + 1); }
static inline int chance(dice *d, int percent) { return roll(d, 100) < percent; }

/* A growing text. */
typedef struct text { char *at; size_t length, room; } text;
static inline void put(text *t, const char *format, ...) {
  for (;;) {
    va_list args;
    va_start(args, format);
    int n = vsnprintf(t->at ? t->at + t->length : NULL, t->at ? t->room - t->length : 0, format, args);
    va_end(args);
    if (t->at && t->length + (size_t)n < t->room) {
      t->length += (size_t)n;
      return;
    }
    t->room = 2 * t->room + (size_t)n + 256;
    t->at = realloc(t->at, t->room);
    if (!t->at) {
      fputs("out of memory\n", stderr);
      exit(2);
    }
  }
}

enum { TREE_UNION, TREE_DIFFERENCE, TREE_MEET, TREE_LEAF, TREE_KIDS = 12 };
typedef struct tree {
  int op, count;
  struct tree *kid[TREE_KIDS];
  char wrap[160]; /* transforms around it */
  char leaf[160];
} tree;

static inline tree *tree_new(int op) {
  tree *t = calloc(1, sizeof *t);
  if (!t) {
    fputs("out of memory\n", stderr);
    exit(2);
  }
  t->op = op;
  return t;
}
static inline void tree_free(tree *t) { /* depth is at most 12 */
  for (int i = 0; i < t->count; i++) {
    tree_free(t->kid[i]);
  }
  free(t);
}
static inline tree *tree_copy(const tree *t) {
  tree *c = tree_new(t->op);
  *c = *t;
  for (int i = 0; i < t->count; i++) {
    c->kid[i] = tree_copy(t->kid[i]);
  }
  return c;
}
/* The text; shuffle: null, or the dice that draw another order of the operands that commute. */
static inline void tree_put(text *out, const tree *t, dice *shuffle) {
  static const char *const words[] = {"union", "difference", "intersection"};
  put(out, "%s ", t->wrap);
  if (t->op == TREE_LEAF) {
    put(out, "%s\n", t->leaf);
    return;
  }
  int order[TREE_KIDS];
  for (int i = 0; i < t->count; i++) {
    order[i] = i;
  }
  for (int fixed = t->op == TREE_DIFFERENCE, i = t->count - 1; shuffle && i > fixed; i--) {
    int j = from_to(shuffle, fixed, i), k = order[i];
    order[i] = order[j], order[j] = k;
  }
  put(out, "%s() {\n", words[t->op]);
  for (int i = 0; i < t->count; i++) {
    tree_put(out, t->kid[order[i]], shuffle);
  }
  put(out, "}\n");
}

typedef struct taste { int irrational, super; } taste; /* shares in percent */

static inline void a_turn(dice *d, const taste *s, char *out, size_t size) {
  static const char *const exact[] = {"", "", "rotate([90,0,0])", "rotate([0,90,0])", "rotate([180,0,0])", "rotate([90,0,90])", "multmatrix([[0.6,-0.8,0,0],[0.8,0.6,0,0],[0,0,1,0]])",
                                      "multmatrix([[1,0,0,0],[0,0.28,-0.96,0],[0,0.96,0.28,0]])", "mirror([1,0,0])", "mirror([1,1,0])", "scale([2,1,1])", "scale([1,-1,0.5])",
                                      "multmatrix([[1,0.5,0,0],[0,1,0,0],[0,0,1,0]])"};
  static const char *const irrational[] = {"rotate([45,0,0])", "rotate([0,0,30])", "rotate([0,60,0])", "rotate(120,[1,1,1])", "rotate(17.3,[1,2,3])", "rotate([10,20,30])", "mirror([1,2,2])",
                                           "scale([sqrt(2),1,1])"};
  if (chance(d, s->irrational)) {
    snprintf(out, size, "%s", irrational[roll(d, 8)]);
  } else {
    snprintf(out, size, "%s", exact[roll(d, 13)]);
  }
}
static inline tree *a_leaf(dice *d, const taste *s) {
  tree *t = tree_new(TREE_LEAF);
  int a = 1 + roll(d, 2), b = 1 + roll(d, 3), c = 1 + roll(d, 2), x = from_to(d, -2, 2), y = from_to(d, -2, 2), z = from_to(d, -2, 2);
  char turn[120];
  a_turn(d, s, turn, sizeof turn);
  snprintf(t->wrap, sizeof t->wrap, chance(d, 20) ? "translate([%d.5,%d,%d.25]) %s" : "translate([%d,%d,%d]) %s", x, y, z, turn);
  if (chance(d, s->super)) {
    static const char *const exponents[] = {"1,1", "2,1", "1,2", "0.5,0.5", "0.2,0.7", "2,2", "1.5,0.3"};
    snprintf(t->leaf, sizeof t->leaf, "superquadric([%d,%d,%d],%s);", a, b, c, exponents[roll(d, 7)]);
    return t;
  }
  char *l = t->leaf;
  const size_t n = sizeof t->leaf;
  switch (roll(d, 20)) {
  case 0: case 1: snprintf(l, n, "cube([%d,%d,%d]%s);", a, b, c, chance(d, 30) ? ",center=true" : ""); break;
  case 2: snprintf(l, n, "wedge([%d,%d,%d]);", a, b, c); break;
  case 3: case 4: snprintf(l, n, "sphere(%d);", a); break;
  case 5: case 6: snprintf(l, n, "cylinder(r=%d,h=%d%s);", a, b, chance(d, 30) ? ",center=true" : ""); break;
  case 7: snprintf(l, n, "cylinder(r1=%d,r2=0,h=%d);", a, b); break;
  case 8: snprintf(l, n, "cylinder(r1=%d,r2=%d,h=%d);", a, 3 - a, b); break;
  case 9: snprintf(l, n, "ellipsoid([%d,%d,%d]);", a, b, c); break;
  case 10: snprintf(l, n, "paraboloid(r=%d,h=%d);", a, b); break;
  case 11: snprintf(l, n, "hyperboloid(h=%d,r=%d,rc=%d);", b, a + 1, a); break;
  case 12: snprintf(l, n, "hyperboloid(h=%d,r=%d,gap=%d);", b + 1, a, chance(d, 50) ? 1 : b); break;
  case 13: snprintf(l, n, "cylinder(h=%d,r=[%d,%d]);", b, a, c); break;
  case 14: snprintf(l, n, "cylinder(h=%d,r=%d,$fn=%d);", b, a, chance(d, s->irrational) ? from_to(d, 3, 8) : 4); break;
  case 15: snprintf(l, n, "cylinder(base=[%d,%d,%d],axis=[%d,%d,%d],r=%d,h=%d);", x, 0, z, from_to(d, 1, 2), from_to(d, -1, 1), from_to(d, -1, 1), a, b); break;
  case 16: snprintf(l, n, "cone(base=[0,0,0],axis=[0,%d,%d],h=%d,r=%d);", from_to(d, 3, 4), from_to(d, -4, 4), b, a); break;
  case 17: snprintf(l, n, "halfspace(n=[%d,%d,1],d=%d);", from_to(d, -1, 1), from_to(d, -1, 1), z); break;
  case 18: snprintf(l, n, "quadric([%d,%d,%d,%d,0,0,0,%d,%d,%d]);", from_to(d, -1, 2), from_to(d, -1, 2), from_to(d, 1, 2), from_to(d, -1, 1), from_to(d, -1, 1), from_to(d, -1, 1), from_to(d, -2, 1)); break;
  default: snprintf(l, n, "saddle(a=%d,b=%d);", a, c); break;
  }
  return t;
}
static inline tree *a_tree(dice *d, const taste *s, int leaves, int depth) {
  if (leaves <= 1) {
    return a_leaf(d, s);
  }
  tree *t = tree_new(chance(d, 45) ? TREE_UNION : chance(d, 60) ? TREE_DIFFERENCE : TREE_MEET);
  int kids = leaves > 3 && depth > 1 ? from_to(d, 2, 4) : 2;
  if (depth <= 1) {
    kids = leaves < TREE_KIDS ? leaves : TREE_KIDS;
  }
  t->count = kids;
  for (int i = 0; i < kids; i++) {
    if (i && chance(d, 20)) { /* the same again, moved by whole steps or in place */
      t->kid[i] = tree_copy(t->kid[roll(d, i)]);
      char wrap[sizeof t->wrap];
      snprintf(wrap, sizeof wrap, "translate([%d,%d,%d]) %.100s", from_to(d, -1, 1), from_to(d, -1, 1), from_to(d, -1, 1), t->kid[i]->wrap);
      if (strlen(t->kid[i]->wrap) <= 100) {
        memcpy(t->kid[i]->wrap, wrap, sizeof wrap);
      }
      continue;
    }
    int share = leaves / kids;
    t->kid[i] = a_tree(d, s, share > 1 && i == 0 ? leaves - share * (kids - 1) : share, depth - 1);
  }
  if (chance(d, 15)) {
    a_turn(d, s, t->wrap, sizeof t->wrap);
  }
  return t;
}

/* --- shrinking: every tree that is one cut smaller, until `fails` says yes ------------------------------------------- */

static inline int tree_size(const tree *t) {
  int n = 1;
  for (int i = 0; i < t->count; i++) {
    n += tree_size(t->kid[i]);
  }
  return n;
}
static inline tree *tree_at(tree *t, int *i) {
  if ((*i)-- == 0) {
    return t;
  }
  for (int k = 0; k < t->count; k++) {
    tree *found = tree_at(t->kid[k], i);
    if (found) {
      return found;
    }
  }
  return NULL;
}
/* Cut number `cut` of node `node`: 0 to 11: that child goes; 12 to 23: the node becomes that child; 24: no transforms. 0: there is no such cut. */
static inline int tree_cut(tree *root, int node, int cut) {
  tree *t = tree_at(root, &node);
  if (cut == 24) {
    int any = t->wrap[0] != 0;
    t->wrap[0] = 0;
    return any;
  }
  int k = cut % TREE_KIDS;
  if (k >= t->count || t->count < (cut < TREE_KIDS ? 2 : 1) || (t == root && (cut >= TREE_KIDS || t->count <= 3))) {
    return 0;
  }
  if (cut < TREE_KIDS) {
    tree_free(t->kid[k]);
    for (t->count--; k < t->count; k++) {
      t->kid[k] = t->kid[k + 1];
    }
    return 1;
  }
  tree *kid = t->kid[k];
  for (int i = 0; i < t->count; i++) {
    if (i != k) {
      tree_free(t->kid[i]);
    }
  }
  char wrap[sizeof t->wrap];
  if (snprintf(wrap, sizeof wrap, "%.79s %.79s", t->wrap, kid->wrap) >= (int)sizeof wrap || strlen(t->wrap) > 79 || strlen(kid->wrap) > 79) {
    snprintf(wrap, sizeof wrap, "%s", kid->wrap);
  }
  *t = *kid;
  memcpy(t->wrap, wrap, sizeof wrap);
  free(kid);
  return 1;
}
#endif
