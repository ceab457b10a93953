/* Memory: the books against the limit, blocks that grow, lines, arenas with their marks; each with refusals. */
#include "base/mem.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void the_limit_is_kept(void **state) {
  (void)state;
  qn_mem mem;
  qn_mem_init(&mem, &(quoin_allocator){.limit = 1000});
  void *a = qn_alloc(&mem, 600);
  assert_non_null(a);
  assert_null(qn_alloc(&mem, 401));
  assert_null(qn_alloc(&mem, SIZE_MAX)); /* the sum would wrap */
  void *b = qn_alloc(&mem, 400);
  assert_non_null(b);
  assert_int_equal(mem.used, 1000);
  assert_null(qn_resize(&mem, b, 400, 401)); /* b is left as it was */
  b = qn_resize(&mem, b, 400, 100);
  assert_non_null(b);
  assert_int_equal(mem.used, 700);
  b = qn_resize(&mem, b, 100, 400);
  assert_non_null(b);
  qn_free(&mem, a, 600);
  qn_free(&mem, b, 400);
  qn_free(&mem, NULL, 5);
  assert_int_equal(mem.used, 0);
  void *nothing = qn_alloc(&mem, 0), *other = qn_alloc(&mem, 0);
  assert_non_null(nothing);
  assert_ptr_not_equal(nothing, other);
  qn_free(&mem, nothing, 0);
  qn_free(&mem, other, 0);
  assert_int_equal(mem.used, 0);
}

static void blocks_grow(void **state) {
  (void)state;
  qn_mem mem;
  qn_mem_init(&mem, &(quoin_allocator){.limit = 1 << 20});
  uint32_t *items = NULL;
  size_t capacity = 0, count = 0;
  while (qn_grow(&mem, &items, &capacity, count + 1)) {
    assert_true(capacity > count);
    items[count] = (uint32_t)count;
    count++;
  }
  assert_true(count > (1 << 20) / 4 / 3); /* a refusal comes when half as much again does not fit */
  for (size_t i = 0; i < count; i++) {
    assert_int_equal(items[i], i);
  }
  assert_false(qn_grow(&mem, &items, &capacity, SIZE_MAX / 2)); /* its bytes cannot be counted */
  qn_free(&mem, items, capacity * sizeof *items);
  assert_int_equal(mem.used, 0);
}

static void lines_are_aligned(void **state) {
  (void)state;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  enum { N = 100 };
  char *blocks[N];
  for (size_t i = 0; i < N; i++) {
    blocks[i] = qn_alloc_line(&mem, 7 * i);
    assert_non_null(blocks[i]);
    assert_int_equal((uintptr_t)blocks[i] % 64, 0);
    memset(blocks[i], (int)i, 7 * i);
  }
  for (size_t i = 0; i < N; i++) {
    for (size_t k = 0; k < 7 * i; k++) {
      assert_int_equal(blocks[i][k], (int)i);
    }
    qn_free_line(&mem, blocks[i], 7 * i);
  }
  assert_null(qn_alloc_line(&mem, SIZE_MAX - 8));
  assert_int_equal(mem.used, 0);
}

static void arenas_go_back_to_their_marks(void **state) {
  (void)state;
  qn_mem mem;
  qn_mem_init(&mem, NULL);
  qn_arena arena;
  qn_arena_init(&arena, &mem);
  const qn_mark empty = qn_arena_mark(&arena);
  char *first = qn_arena_text(&arena, "first", 5);
  assert_string_equal(first, "first");
  for (int round = 0; round < 50; round++) {
    const qn_mark mark = qn_arena_mark(&arena);
    char *blocks[40];
    for (size_t i = 0; i < 40; i++) { /* some far larger than a chunk */
      size_t size = i % 7 == 6 ? 100000 : 1 + 37 * i;
      blocks[i] = qn_arena_take(&arena, size);
      assert_non_null(blocks[i]);
      assert_int_equal((uintptr_t)blocks[i] % 16, 0);
      memset(blocks[i], (int)i, size);
    }
    for (size_t i = 0; i < 40; i++) {
      assert_int_equal(blocks[i][i % 7 == 6 ? 99999 : 37 * i], (int)i);
    }
    qn_arena_release(&arena, mark);
    assert_true(mem.used < 2500000); /* of a round's chunks one is kept */
    assert_string_equal(first, "first");
  }
  qn_arena_release(&arena, empty);
  qn_arena_free(&arena);
  assert_int_equal(mem.used, 0);
}

static void arenas_are_refused(void **state) {
  (void)state;
  for (size_t limit = 1; limit < 100000; limit += 3001) {
    qn_mem mem;
    qn_mem_init(&mem, &(quoin_allocator){.limit = limit});
    qn_arena arena;
    qn_arena_init(&arena, &mem);
    size_t taken = 0;
    while (qn_arena_take(&arena, 1000)) {
      taken += 1000;
      assert_true(taken <= limit);
    }
    assert_null(qn_arena_take(&arena, SIZE_MAX / 2 + 100));
    qn_arena_free(&arena);
    assert_int_equal(mem.used, 0);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_limit_is_kept), cmocka_unit_test(blocks_grow), cmocka_unit_test(lines_are_aligned),
    cmocka_unit_test(arenas_go_back_to_their_marks), cmocka_unit_test(arenas_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
