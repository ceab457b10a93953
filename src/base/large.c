/* A block has pages of its own, fresh ones: memory that has been given back lies in small pages already and keeps them, whatever is asked of it. */
#if defined(__linux__)
#define _DEFAULT_SOURCE /* NOLINT(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp): madvise */
#endif
#include "base/large.h"

#if defined(__linux__)
#include <stdint.h>
#include <sys/mman.h>
#endif

#if defined(__linux__) && defined(MADV_HUGEPAGE)

enum { PAGE = 1 << 21, LEAST = PAGE + PAGE / 2 }; /* smaller blocks would leave more than a third empty */

static size_t whole_pages(size_t size) { return (size + PAGE - 1) / PAGE * PAGE; }

int qn_large_is(size_t size) { return size >= LEAST && size <= SIZE_MAX / 2; }

void *qn_large_alloc(size_t size) {
  const size_t whole = whole_pages(size);
  char *map = mmap(NULL, whole + PAGE, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (map == MAP_FAILED) {
    return NULL;
  }
  const size_t before = (PAGE - ((uintptr_t)map & (PAGE - 1))) & (PAGE - 1), after = PAGE - before; /* what is out of whole pages is given back */
  if (before) {
    (void)munmap(map, before);
  }
  if (after) {
    (void)munmap(map + before + whole, after);
  }
  (void)madvise(map + before, whole, MADV_HUGEPAGE); /* advice: refused, the pages are small */
  return map + before;
}

void qn_large_free(void *block, size_t size) { (void)munmap(block, whole_pages(size)); }

#else

int qn_large_is(size_t size) {
  (void)size;
  return 0;
}
void *qn_large_alloc(size_t size) {
  (void)size;
  return NULL;
}
void qn_large_free(void *block, size_t size) { (void)block, (void)size; }

#endif
