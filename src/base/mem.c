#include "base/mem.h"

#include "base/large.h"

#include <stdlib.h>
#include <string.h>

static void *plain_alloc(void *user, size_t size) {
  (void)user;
  return malloc(size);
}
static void *plain_resize(void *user, void *block, size_t old_size, size_t new_size) {
  (void)user, (void)old_size;
  return realloc(block, new_size);
}
static void plain_release(void *user, void *block, size_t size) {
  (void)user, (void)size;
  free(block);
}

void qn_mem_init(qn_mem *mem, const quoin_allocator *allocator) {
  if (allocator && allocator->alloc) {
    mem->a = *allocator;
  } else {
    mem->a = (quoin_allocator){plain_alloc, plain_resize, plain_release, NULL, allocator ? allocator->limit : 0};
  }
  atomic_init(&mem->used, 0);
}

/* Books size bytes against the limit; 0 when that would pass it. */
static int book(qn_mem *mem, size_t size) {
  size_t before = atomic_fetch_add_explicit(&mem->used, size, memory_order_relaxed);
  if (mem->a.limit && (size > mem->a.limit || before > mem->a.limit - size)) {
    atomic_fetch_sub_explicit(&mem->used, size, memory_order_relaxed);
    return 0;
  }
  return 1;
}

void *qn_alloc(qn_mem *mem, size_t size) {
  if (size == 0) {
    size = 1;
  }
  if (!book(mem, size)) {
    return NULL;
  }
  void *block = mem->a.alloc(mem->a.user, size);
  if (!block) {
    atomic_fetch_sub_explicit(&mem->used, size, memory_order_relaxed);
  }
  return block;
}

void *qn_alloc_zeroed(qn_mem *mem, size_t size) {
  void *block = qn_alloc(mem, size);
  if (block) {
    memset(block, 0, size ? size : 1);
  }
  return block;
}

void *qn_resize(qn_mem *mem, void *block, size_t old_size, size_t new_size) {
  if (!block) {
    return qn_alloc(mem, new_size);
  }
  old_size = old_size ? old_size : 1;
  new_size = new_size ? new_size : 1;
  if (new_size > old_size && !book(mem, new_size - old_size)) {
    return NULL;
  }
  void *moved = mem->a.resize(mem->a.user, block, old_size, new_size);
  if (moved ? new_size < old_size : new_size > old_size) {
    size_t difference = moved ? old_size - new_size : new_size - old_size;
    atomic_fetch_sub_explicit(&mem->used, difference, memory_order_relaxed);
  }
  return moved;
}

void qn_free(qn_mem *mem, void *block, size_t size) {
  if (block) {
    size = size ? size : 1;
    mem->a.release(mem->a.user, block, size);
    atomic_fetch_sub_explicit(&mem->used, size, memory_order_relaxed);
  }
}

int qn_grow_(qn_mem *mem, void **items, size_t *capacity, size_t want, size_t item) {
  size_t grown = *capacity + *capacity / 2 + 16;
  if (grown < want) {
    grown = want;
  }
  if (grown > SIZE_MAX / item) {
    return 0;
  }
  void *moved = qn_resize(mem, *items, *items ? *capacity * item : 0, grown * item);
  if (!moved) {
    return 0;
  }
  *items = moved;
  *capacity = grown;
  return 1;
}

enum { LINE = 64 };

/* Blocks of lines never grow, so that large ones may have pages of their own; but not where the caller has an allocator of their own. */
static int is_large(const qn_mem *mem, size_t size) { return mem->a.alloc == plain_alloc && qn_large_is(size); }

void *qn_alloc_line(qn_mem *mem, size_t size) {
  if (size > SIZE_MAX - 2 * LINE) {
    return NULL;
  }
  if (is_large(mem, size)) {
    if (!book(mem, size)) {
      return NULL;
    }
    void *pages = qn_large_alloc(size);
    if (!pages) {
      atomic_fetch_sub_explicit(&mem->used, size, memory_order_relaxed);
    }
    return pages;
  }
  char *block = qn_alloc(mem, size + LINE);
  if (!block) {
    return NULL;
  }
  size_t shift = LINE - ((uintptr_t)block & (LINE - 1)); /* 1 to LINE: the byte before the block keeps it */
  block[shift - 1] = (char)shift;
  return block + shift;
}

void qn_free_line(qn_mem *mem, void *block, size_t size) {
  if (block && is_large(mem, size)) {
    qn_large_free(block, size);
    atomic_fetch_sub_explicit(&mem->used, size, memory_order_relaxed);
  } else if (block) {
    char *line = block;
    qn_free(mem, line - line[-1], size + LINE);
  }
}

struct qn_chunk {
  qn_chunk *older;
  size_t size; /* of the whole block */
  _Alignas(16) char data[];
};

enum { FIRST_CHUNK = 4096, LARGEST_STEP = 1 << 20 };

void qn_arena_init(qn_arena *arena, qn_mem *mem) {
  *arena = (qn_arena){.mem = mem};
}

static void free_chunk(qn_arena *arena, qn_chunk *chunk) {
  if (chunk) {
    qn_free(arena->mem, chunk, chunk->size);
  }
}

void qn_arena_free(qn_arena *arena) {
  for (qn_chunk *c = arena->chunk, *older; c; c = older) {
    older = c->older;
    free_chunk(arena, c);
  }
  free_chunk(arena, arena->spare);
  qn_arena_init(arena, arena->mem);
}

void *qn_arena_slow_(qn_arena *arena, size_t size) {
  if (size > SIZE_MAX / 2) {
    return NULL;
  }
  size_t need = sizeof(qn_chunk) + size;
  qn_chunk *chunk = NULL;
  if (arena->spare && arena->spare->size >= need) {
    chunk = arena->spare;
    arena->spare = NULL;
  } else {
    size_t step = arena->chunk ? arena->chunk->size * 2 : FIRST_CHUNK;
    step = step > LARGEST_STEP ? LARGEST_STEP : step;
    step = step < need ? need : step;
    chunk = qn_alloc(arena->mem, step);
    if (!chunk) {
      return NULL;
    }
    chunk->size = step;
  }
  chunk->older = arena->chunk;
  arena->chunk = chunk;
  arena->at = chunk->data + size;
  arena->end = (char *)chunk + chunk->size;
  return chunk->data;
}

qn_mark qn_arena_mark(const qn_arena *arena) {
  return (qn_mark){arena->chunk, arena->at};
}

void qn_arena_release(qn_arena *arena, qn_mark mark) {
  while (arena->chunk != mark.chunk) {
    qn_chunk *c = arena->chunk;
    arena->chunk = c->older;
    if (!arena->spare || arena->spare->size < c->size) {
      free_chunk(arena, arena->spare);
      arena->spare = c;
    } else {
      free_chunk(arena, c);
    }
  }
  arena->at = mark.at;
  arena->end = arena->chunk ? (char *)arena->chunk + arena->chunk->size : NULL;
}

char *qn_arena_text(qn_arena *arena, const char *text, size_t length) {
  char *copy = qn_arena_take(arena, length + 1);
  if (copy) {
    memcpy(copy, text, length);
    copy[length] = '\0';
  }
  return copy;
}
