/* Names and strings of a text, each kept once: a name is a number from then on. */
#ifndef QN_TEXT_NAMES_H
#define QN_TEXT_NAMES_H

#include "base/mem.h"

/* The words that syntax itself knows, at fixed numbers. 0 is "no name". */
enum {
  QN_WORD_NONE, QN_WORD_TRUE, QN_WORD_FALSE, QN_WORD_UNDEF, QN_WORD_MODULE, QN_WORD_FUNCTION, QN_WORD_FOR,
  QN_WORD_INTERSECTION_FOR, QN_WORD_IF, QN_WORD_ELSE, QN_WORD_LET, QN_WORD_ASSIGN, QN_WORD_EACH, QN_WORD_INCLUDE, QN_WORD_USE,
  QN_WORD_ASSERT, QN_WORD_ECHO, QN_WORD_FN, QN_WORD_COUNT
};

#define QN_NO_NAME UINT32_MAX

typedef struct qn_name {
  const char *text; /* with a NUL */
  uint32_t length, hash;
  uint32_t declared; /* the text says `module` or `function` of it: not unknown, only not supported */
} qn_name;

typedef struct qn_names {
  qn_arena arena;
  qn_name *items;
  size_t count, capacity;
  uint32_t *slots; /* number + 1 by hash, 0: free */
  size_t slot_count;
} qn_names;

QN_NODISCARD int qn_names_init(qn_names *names, qn_mem *mem); /* 0 when memory is refused */
void qn_names_free(qn_names *names);

/* The number of a name, QN_NO_NAME when memory is refused. */
uint32_t qn_names_find(qn_names *names, const char *text, size_t length);

/* The distance of two words for "did you mean": edits (insert, delete, replace, swap neighbours) needed, or a number over `most`. */
unsigned qn_names_distance(const char *a, const char *b, unsigned most);

#endif
