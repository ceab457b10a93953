/* Memory: one checked way to allocate, counted against a limit, and arenas for what lives and dies together. */
#ifndef QN_BASE_MEM_H
#define QN_BASE_MEM_H

#include "base/attrs.h"
#include "quoin/types.h"

#include <stdatomic.h>

/* An allocator with its count. Shared by threads. */
typedef struct qn_mem {
  quoin_allocator a;
  atomic_size_t used;
} qn_mem;

void qn_mem_init(qn_mem *mem, const quoin_allocator *allocator); /* null: malloc without a limit */

/* Null when refused; size 0 gives a unique block of one byte. Blocks are aligned for max_align_t. */
QN_NODISCARD void *qn_alloc(qn_mem *mem, size_t size);
QN_NODISCARD void *qn_alloc_zeroed(qn_mem *mem, size_t size);
QN_NODISCARD void *qn_resize(qn_mem *mem, void *block, size_t old_size, size_t new_size); /* on refusal block is left as it was */
void qn_free(qn_mem *mem, void *block, size_t size);                                      /* null is allowed */

/* Makes room for `want` items of `item` bytes in *items, whose capacity is *capacity; grows by half. 0 when refused. */
QN_NODISCARD int qn_grow_(qn_mem *mem, void **items, size_t *capacity, size_t want, size_t item);
#define qn_grow(mem, items, capacity, want) \
  ((want) <= *(capacity) || qn_grow_((mem), (void **)(items), (capacity), (want), sizeof **(items)))

/* A block with the alignment of a cache line, for wide code. Freed with qn_free_line and the same size. */
QN_NODISCARD void *qn_alloc_line(qn_mem *mem, size_t size);
void qn_free_line(qn_mem *mem, void *block, size_t size);

/* An arena: blocks are freed all at once, or back to a mark. Not shared by threads. */
typedef struct qn_chunk qn_chunk;
typedef struct qn_arena {
  qn_mem *mem;
  qn_chunk *chunk;      /* the chunk in use; it links to older ones */
  qn_chunk *spare;      /* one chunk kept from the last release */
  char *at, *end;
} qn_arena;
typedef struct qn_mark { qn_chunk *chunk; char *at; } qn_mark;

void qn_arena_init(qn_arena *arena, qn_mem *mem);
void qn_arena_free(qn_arena *arena);
QN_NODISCARD void *qn_arena_slow_(qn_arena *arena, size_t size);
qn_mark qn_arena_mark(const qn_arena *arena);
void qn_arena_release(qn_arena *arena, qn_mark mark); /* frees what was taken since the mark */

/* Aligned to 16 bytes; null when refused. */
QN_INLINE void *qn_arena_take(qn_arena *arena, size_t size) {
  size = (size + 15) & ~(size_t)15;
  if (QN_LIKELY(size <= (size_t)(arena->end - arena->at))) {
    void *p = arena->at;
    arena->at += size;
    return p;
  }
  return qn_arena_slow_(arena, size);
}
QN_NODISCARD char *qn_arena_text(qn_arena *arena, const char *text, size_t length); /* a copy with a NUL */

#endif
