/* Calls a target on each file given (a folder: on its files), or on standard input, which is how AFL++ calls it. */
#include "fuzz.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#ifdef __AFL_FUZZ_TESTCASE_LEN
#include <unistd.h>
__AFL_FUZZ_INIT();
#endif

static size_t count;

static void one_file(FILE *f, const char *name) {
  size_t size = 0, capacity = 1 << 16;
  uint8_t *data = malloc(capacity);
  for (size_t n = 1; data && n > 0; size += n) {
    if (size == capacity) {
      uint8_t *more = realloc(data, capacity *= 2);
      if (!more) {
        free(data);
      }
      data = more;
    }
    n = data ? fread(data + size, 1, capacity - size, f) : 0;
  }
  uint8_t *exact = malloc(size ? size : 1); /* a block of its size, so that a byte read behind it is seen */
  if (!data || !exact) {
    fputs("out of memory\n", stderr);
    exit(2);
  }
  memcpy(exact, data, size);
  free(data);
  if (getenv("QUOIN_FUZZ_SAY")) {
    fprintf(stderr, "%s\n", name);
  }
  LLVMFuzzerTestOneInput(exact, size);
  free(exact);
  count++;
}

static void one_path(const char *path) {
  struct stat what;
  if (stat(path, &what) == 0 && S_ISDIR(what.st_mode)) {
    DIR *folder = opendir(path);
    for (const struct dirent *e; folder && (e = readdir(folder));) {
      char name[4096];
      if (e->d_name[0] != '.' && snprintf(name, sizeof name, "%s/%s", path, e->d_name) < (int)sizeof name) {
        FILE *f = fopen(name, "rb");
        if (f && fstat(fileno(f), &what) == 0 && S_ISREG(what.st_mode)) {
          one_file(f, name);
        }
        if (f) {
          fclose(f);
        }
      }
    }
    if (folder) {
      closedir(folder);
    }
    return;
  }
  FILE *f = fopen(path, "rb");
  if (!f) {
    perror(path);
    exit(2);
  }
  one_file(f, path);
  fclose(f);
}

int main(int argc, char **argv) {
#ifdef __AFL_FUZZ_TESTCASE_LEN
  if (argc < 2) {
    __AFL_INIT();
    const uint8_t *shared = __AFL_FUZZ_TESTCASE_BUF;
    while (__AFL_LOOP(2000)) {
      LLVMFuzzerTestOneInput(shared, (size_t)__AFL_FUZZ_TESTCASE_LEN);
    }
    return 0;
  }
#endif
  for (int i = 1; i < argc; i++) {
    one_path(argv[i]);
  }
  if (argc < 2) {
    one_file(stdin, "standard input");
  }
  printf("%zu inputs\n", count);
  return count ? 0 : 2;
}
