/* Blocks of megabytes in large pages, where the system has them: memory that is met in no order then costs no walk through page tables. */
#ifndef QN_BASE_LARGE_H
#define QN_BASE_LARGE_H

#include <stddef.h>

/* Whether blocks of this size are made here. */
int qn_large_is(size_t size);
/* Null when refused. The block begins at a page. */
void *qn_large_alloc(size_t size);
void qn_large_free(void *block, size_t size);

#endif
