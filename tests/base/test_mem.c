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

/* Blocks with pages of their own: counted, limited, freed like others, and only where the caller has no allocator. */
static int asked_of_caller;
static void *callers_alloc(void *user, size_t size) {
  (void)user;
  asked_of_caller++;
  return malloc(size);
}
static void *callers_resize(void *user, void *block, size_t old_size, size_t new_size) {
  (void)user, (void)old_size;
  return realloc(block, new_size);
}
static void callers_release(void *user, void *block, size_t size) {
  (void)user, (void)size;
  asked_of_caller--;
  free(block);
}

static void large_blocks(void **state) {
  (void)state;
  const quoin_allocator callers = {callers_alloc, callers_resize, callers_release, NULL, 0}, *const allocators[2] = {NULL, &callers};
  for (int which = 0; which < 2; which++) {
    qn_mem mem;
    qn_mem_init(&mem, allocators[which]);
    for (size_t size = (size_t)1 << 20; size < (size_t)20 << 20; size += 777777) {
      char *a = qn_alloc_line(&mem, size), *b = qn_alloc_line(&mem, size);
      assert_true(a && b && (uintptr_t)a % 64 == 0 && (uintptr_t)b % 64 == 0);
      memset(a, 1, size), memset(b, 2, size);
      assert_true(a[0] == 1 && a[size - 1] == 1 && mem.used >= 2 * size);
      assert_int_equal(asked_of_caller, 2 * which);
      qn_free_line(&mem, a, size);
      assert_true(b[0] == 2 && b[size / 2] == 2 && b[size - 1] == 2);
      qn_free_line(&mem, b, size);
      assert_int_equal(mem.used, 0);
      assert_int_equal(asked_of_caller, 0);
    }
  }
  qn_mem mem;
  qn_mem_init(&mem, &(quoin_allocator){.limit = 10000000});
  char *a = qn_alloc_line(&mem, 6000000);
  assert_non_null(a);
  assert_null(qn_alloc_line(&mem, 6000000));
  qn_free_line(&mem, a, 6000000);
  assert_int_equal(mem.used, 0);
  assert_null(qn_alloc_line(&mem, SIZE_MAX / 4)); /* more than there is, booked nowhere */
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
    cmocka_unit_test(the_limit_is_kept), cmocka_unit_test(blocks_grow), cmocka_unit_test(lines_are_aligned), cmocka_unit_test(large_blocks),
    cmocka_unit_test(arenas_go_back_to_their_marks), cmocka_unit_test(arenas_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
