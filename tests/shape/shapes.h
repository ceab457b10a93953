/* What the tests of shape/ share: exact numbers from text, random decimals, and the sign of half-spaces at exact points. */
#ifndef SHAPES_H
#define SHAPES_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/bounds.h"
#include "shape/prim.h"

typedef struct bench { qn_mem mem; qn_ctx ctx; uint64_t random; } bench;

static inline void bench_init(bench *b) {
  qn_mem_init(&b->mem, NULL);
  qn_ctx_init(&b->ctx, &b->mem);
  b->random = 1;
}
static inline void bench_free(bench *b) {
  assert_int_equal(b->ctx.failed, QUOIN_OK);
  qn_ctx_free(&b->ctx);
  assert_int_equal(b->mem.used, 0);
}

static inline uint64_t bits(bench *b) { /* splitmix64 */
  uint64_t z = (b->random += UINT64_C(0x9e3779b97f4a7c15));
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return z ^ (z >> 31);
}
static inline int below(bench *b, int n) { return (int)(bits(b) % (uint64_t)n); }
static inline double real(bench *b, double lo, double hi) { return lo + (hi - lo) * ((double)(bits(b) >> 11) * 0x1p-53); }

/* "3", "-0.25", "1e-3", "2/7". */
static inline qn_num num(bench *b, const char *text) {
  const char *slash = strchr(text, '/');
  size_t length = slash ? (size_t)(slash - text) : strlen(text);
  qn_num a;
  quoin_status status = QUOIN_OK;
  assert_int_equal(qn_num_read(&b->ctx, text, length, &a, &status), length);
  return slash ? qn_num_div(&b->ctx, a, num(b, slash + 1)) : a;
}
/* k / d with |k| <= most. */
static inline qn_num ratio(bench *b, int most, int d) {
  return qn_num_div(&b->ctx, qn_num_from_int(&b->ctx, below(b, 2 * most + 1) - most), qn_num_from_int(&b->ctx, d));
}
/* A positive decimal with up to two digits behind the point, 0.01 to 9.99. */
static inline qn_num size(bench *b) {
  return qn_num_div(&b->ctx, qn_num_from_int(&b->ctx, 1 + below(b, 999)), qn_num_from_int(&b->ctx, below(b, 2) ? 100 : 10));
}

/* Arithmetic, short. */
#define ADD(x, y) qn_num_add(&b->ctx, x, y)
#define SUB(x, y) qn_num_sub(&b->ctx, x, y)
#define MUL(x, y) qn_num_mul(&b->ctx, x, y)
#define DIV(x, y) qn_num_div(&b->ctx, x, y)
#define SQ(x) qn_num_mul(&b->ctx, x, x)
#define INT(k) qn_num_from_int(&b->ctx, k)
#define CMP(x, y) qn_num_cmp(&b->ctx, x, y)

static inline qn_num row_at(bench *b, const qn_num row[4], const qn_num x[3]) {
  qn_num p[4] = {x[0], x[1], x[2], QN_NUM_ONE};
  return qn_num_dot(&b->ctx, 4, row, p);
}
static inline qn_num form_at(bench *b, const qn_half_form *h, const qn_num x[3]) {
  if (h->kind == QN_PLANE) {
    return row_at(b, h->row[0], x);
  }
  assert_int_equal(h->kind, QN_QUADRIC_BODY);
  qn_num q = h->k;
  for (int i = 0; i < 3; i++) {
    q = ADD(q, MUL(h->s[i], SQ(row_at(b, h->row[i], x))));
  }
  return ADD(q, MUL(MUL(INT(2), h->l), row_at(b, h->row[2], x)));
}

typedef struct solid {
  qn_prim prim;
  qn_num args[16];
  size_t n;
  qn_half_form *halves;
  size_t count;
  qn_form_result result;
} solid;

static inline void make(bench *b, solid *s, const qn_placement *placement) {
  s->halves = NULL;
  s->result = qn_prims[s->prim].form(&b->ctx, s->args, s->n, placement, &s->halves, &s->count);
  if (s->result != QN_FORM_OK) {
    assert_int_equal(s->count, 0);
  } else if (qn_prims[s->prim].faces >= 0) {
    assert_true(s->count >= 1 && s->count <= (size_t)qn_prims[s->prim].faces);
  }
}
/* Arguments as texts, ended by a null. */
static inline solid solid_of(bench *b, qn_prim prim, ...) {
  solid s = {.prim = prim};
  va_list list;
  va_start(list, prim);
  for (const char *text; (text = va_arg(list, const char *)) != NULL;) {
    s.args[s.n++] = num(b, text);
  }
  va_end(list);
  make(b, &s, NULL);
  return s;
}

/* -1 inside, 0 on the boundary, 1 outside: the greatest sign of the half-spaces. */
static inline int side(bench *b, const solid *s, const qn_num x[3]) {
  if (s->result != QN_FORM_OK) {
    return s->result == QN_FORM_ALL ? -1 : 1;
  }
  int most = -1;
  for (size_t i = 0; i < s->count; i++) {
    int sign = qn_num_sign(form_at(b, s->halves + i, x));
    most = sign > most ? sign : most;
  }
  return most;
}
static inline int side_at(bench *b, const solid *s, const char *x, const char *y, const char *z) {
  qn_num p[3] = {num(b, x), num(b, y), num(b, z)};
  return side(b, s, p);
}
#define IN(s, x, y, z) assert_int_equal(side_at(b, s, x, y, z), -1)
#define ON(s, x, y, z) assert_int_equal(side_at(b, s, x, y, z), 0)
#define OUT(s, x, y, z) assert_int_equal(side_at(b, s, x, y, z), 1)

static inline int larger(int a, int b) { return a > b ? a : b; }

#endif
