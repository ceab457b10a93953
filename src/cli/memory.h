/* --max-memory: an allocator that refuses beyond a limit, and remembers that it did. */
#ifndef QN_CLI_MEMORY_H
#define QN_CLI_MEMORY_H

#include <quoin/quoin.h>

#include <stdatomic.h>

typedef struct cli_memory {
  size_t limit; /* bytes in use at once; 0: none */
  atomic_size_t used;
  atomic_int met; /* something was refused by it */
} cli_memory;

void cli_memory_init(cli_memory *memory, size_t limit);

/* For quoin_model_new. The memory must outlive what is made with it. */
quoin_allocator cli_memory_allocator(cli_memory *memory);

/* A block of the command's own, counted with the rest; null when refused. Freed with the same size. */
void *cli_memory_take(cli_memory *memory, size_t size);
void cli_memory_free(cli_memory *memory, void *block, size_t size);

/* The words for a status: when it is about memory and the limit was met, they name the option. Returns buffer or a fixed text. */
typedef struct cli_why { char text[96]; } cli_why;
const char *cli_memory_status(cli_memory *memory, quoin_status status, cli_why *buffer);

#endif
