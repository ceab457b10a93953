#include "cli/memory.h"

#include <stdio.h>
#include <stdlib.h>

void cli_memory_init(cli_memory *memory, size_t limit) {
  memory->limit = limit;
  atomic_init(&memory->used, 0);
  atomic_init(&memory->met, 0);
}

static void unbook(cli_memory *memory, size_t size) {
  atomic_fetch_sub_explicit(&memory->used, size, memory_order_relaxed);
}

/* 0 when size more bytes would pass the limit. */
static int book(cli_memory *memory, size_t size) {
  size_t before = atomic_fetch_add_explicit(&memory->used, size, memory_order_relaxed);
  if (memory->limit && (size > memory->limit || before > memory->limit - size)) {
    unbook(memory, size);
    atomic_store_explicit(&memory->met, 1, memory_order_relaxed);
    return 0;
  }
  return 1;
}

void *cli_memory_take(cli_memory *memory, size_t size) {
  if (!book(memory, size)) {
    return NULL;
  }
  void *block = malloc(size);
  if (!block) {
    unbook(memory, size);
  }
  return block;
}

void cli_memory_free(cli_memory *memory, void *block, size_t size) {
  if (block) {
    free(block);
    unbook(memory, size);
  }
}

static void *alloc(void *user, size_t size) {
  return cli_memory_take(user, size);
}

static void *resize(void *user, void *block, size_t old_size, size_t new_size) {
  cli_memory *memory = user;
  if (new_size > old_size && !book(memory, new_size - old_size)) {
    return NULL;
  }
  void *moved = realloc(block, new_size);
  if (moved ? new_size < old_size : new_size > old_size) {
    unbook(memory, moved ? old_size - new_size : new_size - old_size);
  }
  return moved;
}

static void release(void *user, void *block, size_t size) {
  cli_memory_free(user, block, size);
}

quoin_allocator cli_memory_allocator(cli_memory *memory) {
  if (!memory->limit) { /* nothing to count: the library's own way, which has large pages */
    return (quoin_allocator){0};
  }
  return (quoin_allocator){.alloc = alloc, .resize = resize, .release = release, .user = memory};
}

const char *cli_memory_status(cli_memory *memory, quoin_status status, cli_why *buffer) {
  if (status != QUOIN_E_MEMORY || !atomic_load_explicit(&memory->met, memory_order_relaxed)) {
    return quoin_status_text(status);
  }
  snprintf(buffer->text, sizeof buffer->text, "out of memory: it takes more than the %zu bytes of --max-memory", memory->limit);
  return buffer->text;
}
