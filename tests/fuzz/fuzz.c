#include "fuzz.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

void fuzz_wrong(const char *format, ...) {
  va_list args;
  va_start(args, format);
  fputs("fuzz: ", stderr);
  vfprintf(stderr, format, args);
  fputc('\n', stderr);
  va_end(args);
  abort();
}

/* --- memory: every block has its size before it, so that a wrong size given back is seen ---------------------------------- */

enum { HEAD = 16 };

static size_t in_use, peak;

static void *take(void *user, size_t size) {
  (void)user;
  char *block = size <= SIZE_MAX - HEAD ? malloc(size + HEAD) : NULL;
  if (!block) {
    return NULL;
  }
  memcpy(block, &size, sizeof size);
  in_use += size;
  peak = in_use > peak ? in_use : peak;
  return block + HEAD;
}

static void give_back(void *user, void *block, size_t size) {
  (void)user;
  char *head = (char *)block - HEAD;
  size_t was;
  memcpy(&was, head, sizeof was);
  if (was != size) {
    fuzz_wrong("a block of %zu bytes is given back as %zu", was, size);
  }
  in_use -= size;
  free(head);
}

static void *change(void *user, void *block, size_t old_size, size_t new_size) {
  void *moved = take(user, new_size);
  if (moved) {
    memcpy(moved, block, old_size < new_size ? old_size : new_size);
    give_back(user, block, old_size);
  }
  return moved;
}

/* --- time --------------------------------------------------------------------------------------------------------------- */

static uint64_t executions;
static double began, slowest, total;

static double seconds(void) { /* of this program's processor time: other programs do not count */
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + (double)now.tv_nsec / 1e9;
}

static double allowed(void) {
  static double most;
  if (most == 0) {
    const char *own = getenv("QUOIN_FUZZ_MILLISECONDS");
    most = (own ? atof(own) : (double)FUZZ_MILLISECONDS) / 1000;
  }
  return most;
}

/* On standard error, or where QUOIN_FUZZ_LOG says, a line for each process. */
static void say_all(void) {
  const char *name = getenv("QUOIN_FUZZ_LOG");
  FILE *f = name ? fopen(name, "a") : stderr;
  struct rusage used;
  if (f && getrusage(RUSAGE_SELF, &used) == 0) {
    fprintf(f, "fuzz: executions %llu seconds %.1f slowest %.3f counted %zu resident %ld\n", (unsigned long long)executions, total, slowest, peak, used.ru_maxrss * 1024);
  }
  if (f && f != stderr) {
    fclose(f);
  }
}

static void keep_slow(const uint8_t *data, size_t size) {
  const char *folder = getenv("QUOIN_FUZZ_SLOW");
  char name[4096];
  FILE *f = folder && snprintf(name, sizeof name, "%s/%.2f_s", folder, slowest) < (int)sizeof name ? fopen(name, "wb") : NULL;
  if (f) {
    fwrite(data, 1, size, f);
    fclose(f);
  }
}

static const uint8_t *input;
static size_t input_size;

void fuzz_begin(const uint8_t *data, size_t size) {
  if (executions++ == 0) {
    atexit(say_all);
  }
  input = data;
  input_size = size;
  began = seconds();
}

int fuzz_late(void) {
  return seconds() - began > 0.5 * allowed();
}

void fuzz_end(void) {
  double took = seconds() - began;
  total += took;
  if (took > slowest) {
    slowest = took;
    if (took > 0.25) {
      keep_slow(input, input_size);
    }
  }
  if (in_use != 0) {
    fuzz_wrong("%zu bytes are not freed", in_use);
  }
  if (took > allowed()) {
    fuzz_wrong("too slow: %.2f s", took);
  }
}

/* --- inputs --------------------------------------------------------------------------------------------------------------- */

size_t fuzz_split(const uint8_t *data, size_t size, fuzz_bytes *tail) {
  for (size_t i = 0; i + 3 <= size; i++) {
    if (memcmp(data + i, "//@", 3) == 0 && (i == 0 || data[i - 1] == '\n')) {
      *tail = (fuzz_bytes){data + i + 3, data + size};
      return i;
    }
  }
  *tail = (fuzz_bytes){data + size, data + size};
  return size;
}

int fuzz_more(const fuzz_bytes *tail) {
  return tail->at < tail->end;
}

static unsigned byte(fuzz_bytes *tail) {
  return fuzz_more(tail) ? *tail->at++ : 79;
}

double fuzz_number(fuzz_bytes *tail) {
  unsigned b = byte(tail);
  double v = 0;
  if (b >= 224) {
    uint8_t raw[8];
    for (int i = 0; i < 8; i++) {
      raw[i] = (uint8_t)byte(tail);
    }
    memcpy(&v, raw, sizeof v);
    v = isfinite(v) ? v : 0;
  } else if (b >= 192) {
    unsigned high = byte(tail), low = byte(tail);
    v = ((double)(high * 256 + low) - 32768) / 256;
  } else if (b >= 161) { /* some doubles beside a number of one byte */
    unsigned next = byte(tail);
    v = ((double)next - 79) / 4;
    for (int i = (int)b - 176; i != 0; i += i < 0 ? 1 : -1) {
      v = nextafter(v, i < 0 ? -1e300 : 1e300);
    }
  } else if (b >= 127) {
    v = ((double)b - 143) / 10;
  } else if (b >= 32) {
    v = ((double)b - 79) / 4; /* 'O' is 0, 'S' 1, 'K' -1 */
  } else {
    v = ldexp(1, ((int)b - 16) * 4);
  }
  return v;
}

void fuzz_decimal(double v, char text[FUZZ_DECIMAL]) {
  snprintf(text, FUZZ_DECIMAL, "%.800g", v); /* a double has at most 767 digits */
}

/* --- scenes --------------------------------------------------------------------------------------------------------------- */

static int has_word(const uint8_t *text, size_t length, const char *word) {
  size_t n = strlen(word);
  for (size_t i = 0; i + n <= length; i++) {
    if (memcmp(text + i, word, n) == 0) {
      return 1;
    }
  }
  return 0;
}

int fuzz_answered(quoin_status status, const char *question) {
  if (status != QUOIN_OK && status != QUOIN_E_LIMIT && status != QUOIN_E_MEMORY) {
    fuzz_wrong("%s: %s", question, quoin_status_text(status));
  }
  return status == QUOIN_OK;
}

int fuzz_read(const uint8_t *text, size_t length, fuzz_scene *out) {
  const quoin_allocator allocator = {.alloc = take, .resize = change, .release = give_back, .limit = FUZZ_MEMORY};
  *out = (fuzz_scene){.super = has_word(text, length, "superquadric")};
  quoin_status status = quoin_model_new(&allocator, &out->model);
  if (status != QUOIN_OK) {
    fuzz_wrong("no model: %s", quoin_status_text(status));
  }
  out->status = quoin_model_read_text(out->model, QUOIN_ROOT, "input", (const char *)text, length, NULL);
  return out->status != QUOIN_E_MODEL && fuzz_answered(out->status, "reading");
}

int fuzz_compile(fuzz_scene *s, const char *snap) {
  quoin_compile_options options = quoin_compile_options_default();
  options.threads = 1;
  options.snap = snap;
  if (!fuzz_answered(quoin_scene_compile(s->model, &options, &s->scene), "compiling")) {
    return 0;
  }
  return fuzz_answered(quoin_work_new(s->scene, &s->work), "a work");
}

void fuzz_close(fuzz_scene *s) {
  quoin_work_free(s->work);
  quoin_scene_free(s->scene);
  quoin_model_free(s->model);
  *s = (fuzz_scene){0};
}

int fuzz_append(void *user, const char *piece, size_t length) {
  fuzz_text *t = user;
  if (t->length + length > t->capacity) {
    t->capacity = 2 * (t->length + length) + 256;
    char *more = realloc(t->at, t->capacity);
    if (!more) {
      return 1;
    }
    t->at = more;
  }
  memcpy(t->at + t->length, piece, length);
  t->length += length;
  return 0;
}
