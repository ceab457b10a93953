#include "text/names.h"

#include <string.h>

static const char *const fixed[QN_WORD_COUNT] = {
  [QN_WORD_NONE] = "",
  [QN_WORD_TRUE] = "true",
  [QN_WORD_FALSE] = "false",
  [QN_WORD_UNDEF] = "undef",
  [QN_WORD_MODULE] = "module",
  [QN_WORD_FUNCTION] = "function",
  [QN_WORD_FOR] = "for",
  [QN_WORD_INTERSECTION_FOR] = "intersection_for",
  [QN_WORD_IF] = "if",
  [QN_WORD_ELSE] = "else",
  [QN_WORD_LET] = "let",
  [QN_WORD_ASSIGN] = "assign",
  [QN_WORD_EACH] = "each",
  [QN_WORD_INCLUDE] = "include",
  [QN_WORD_USE] = "use",
  [QN_WORD_ASSERT] = "assert",
  [QN_WORD_ECHO] = "echo",
  [QN_WORD_FN] = "$fn",
};

int qn_names_init(qn_names *names, qn_mem *mem) {
  *names = (qn_names){0};
  qn_arena_init(&names->arena, mem);
  for (uint32_t i = 0; i < QN_WORD_COUNT; i++) {
    if (qn_names_find(names, fixed[i], strlen(fixed[i])) != i) {
      qn_names_free(names);
      return 0;
    }
  }
  return 1;
}

void qn_names_free(qn_names *names) {
  qn_mem *mem = names->arena.mem;
  qn_free(mem, names->items, names->capacity * sizeof *names->items);
  qn_free(mem, names->slots, names->slot_count * sizeof *names->slots);
  qn_arena_free(&names->arena);
  *names = (qn_names){0};
  qn_arena_init(&names->arena, mem);
}

/* Doubles the table. */
static int rehash(qn_names *names) {
  qn_mem *mem = names->arena.mem;
  size_t slot_count = names->slot_count ? names->slot_count * 2 : 256;
  uint32_t *slots = qn_alloc_zeroed(mem, slot_count * sizeof *slots);
  if (!slots) {
    return 0;
  }
  for (size_t i = 0; i < names->count; i++) {
    size_t at = names->items[i].hash & (slot_count - 1);
    while (slots[at]) {
      at = (at + 1) & (slot_count - 1);
    }
    slots[at] = (uint32_t)i + 1;
  }
  qn_free(mem, names->slots, names->slot_count * sizeof *names->slots);
  names->slots = slots;
  names->slot_count = slot_count;
  return 1;
}

uint32_t qn_names_find(qn_names *names, const char *text, size_t length) {
  if (names->count * 2 >= names->slot_count && !rehash(names)) {
    return QN_NO_NAME;
  }
  uint32_t hash = 2166136261u; /* FNV-1a */
  for (size_t i = 0; i < length; i++) {
    hash = (hash ^ (unsigned char)text[i]) * 16777619u;
  }
  hash ^= hash >> 15;
  size_t at = hash & (names->slot_count - 1);
  for (; names->slots[at]; at = (at + 1) & (names->slot_count - 1)) {
    const qn_name *name = &names->items[names->slots[at] - 1];
    if (name->hash == hash && name->length == length && memcmp(name->text, text, length) == 0) {
      return names->slots[at] - 1;
    }
  }
  if (names->count >= UINT32_MAX - 2 || !qn_grow(names->arena.mem, &names->items, &names->capacity, names->count + 1)) {
    return QN_NO_NAME;
  }
  const char *copy = qn_arena_text(&names->arena, text, length);
  if (!copy) {
    return QN_NO_NAME;
  }
  names->items[names->count] = (qn_name){copy, (uint32_t)length, hash, 0};
  names->slots[at] = (uint32_t)++names->count;
  return (uint32_t)names->count - 1;
}

unsigned qn_names_distance(const char *a, const char *b, unsigned most) {
  enum { LONGEST = 32 };
  size_t n = strlen(a), m = strlen(b);
  if (n > LONGEST || m > LONGEST || (n > m ? n - m : m - n) > most) {
    return most + 1;
  }
  unsigned row[3][LONGEST + 1] = {{0}};
  for (size_t j = 0; j <= m; j++) {
    row[0][j] = (unsigned)j;
  }
  for (size_t i = 1; i <= n; i++) {
    unsigned *now = row[i % 3];
    const unsigned *one = row[(i + 2) % 3], *two = row[(i + 1) % 3];
    now[0] = (unsigned)i;
    for (size_t j = 1; j <= m; j++) {
      unsigned best = one[j - 1] + (a[i - 1] != b[j - 1]);
      best = one[j] + 1 < best ? one[j] + 1 : best;
      best = now[j - 1] + 1 < best ? now[j - 1] + 1 : best;
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && two[j - 2] + 1 < best) {
        best = two[j - 2] + 1;
      }
      now[j] = best;
    }
  }
  return row[n % 3][m];
}
