/* A machine that fails when told to, for tests of the command: loaded before the C library (LD_PRELOAD), it stands in for some of its calls. What fails is
   said in the environment:
     SHIM_REFUSE=K      the K-th allocation is refused, once (0: none)
     SHIM_SEED=S SHIM_ONE_IN=N   each allocation is refused with a chance of one in N, by dice of seed S
     SHIM_READ, SHIM_WRITE = short | eintr | again | eio:K   read() and write() of all but standard error: at most 3 (7) bytes a call; every second call is
                        interrupted, or would block; the K-th and all after it fail
     SHIM_FAIL=NAMES    the named calls fail: rename, close, fclose, mkstemp, pthread_create (close: of descriptors over 2)
     SHIM_REPORT=FILE   at the end: "allocations N refused N kept N", kept being the program's own blocks that it has not given back
   Allocations of GMP and MPFR are let through: they cannot be refused without ending the process (docs/reliability.md). */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void __libc_free(void *);
ssize_t __read(int, void *, size_t);
ssize_t __write(int, const void *, size_t);
int __close(int);

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static unsigned long refuse, one_in, allocations, refused, kept;
static uint64_t dice;
static char reads[16], writes[16], fails[128];
static unsigned long reads_to, writes_to, read_calls, write_calls;
static const char *report;
static int started;
static uintptr_t block[1 << 18]; /* the program's blocks, hashed; 1: one was here */

static unsigned long number(const char *name) {
  const char *text = getenv(name);
  return text ? strtoul(text, NULL, 0) : 0;
}
static void mode(const char *name, char *out, size_t size, unsigned long *to) {
  const char *text = getenv(name);
  if (text) {
    snprintf(out, size, "%.*s", (int)strcspn(text, ":"), text);
    *to = strchr(text, ':') ? strtoul(strchr(text, ':') + 1, NULL, 0) : 0;
  }
}
__attribute__((constructor)) static void start(void) {
  refuse = number("SHIM_REFUSE"), one_in = number("SHIM_ONE_IN"), dice = number("SHIM_SEED") * 2 + 0x9e3779b97f4a7c15u;
  mode("SHIM_READ", reads, sizeof reads, &reads_to);
  mode("SHIM_WRITE", writes, sizeof writes, &writes_to);
  const char *names = getenv("SHIM_FAIL");
  snprintf(fails, sizeof fails, ",%s,", names ? names : "");
  report = getenv("SHIM_REPORT");
  started = 1;
}
__attribute__((destructor)) static void end(void) {
  started = 0;
  FILE *f = report ? fopen(report, "w") : NULL;
  if (f) {
    fprintf(f, "allocations %lu refused %lu kept %lu\n", allocations, refused, kept);
    fclose(f);
  }
}
static int fails_now(const char *name) {
  char word[40];
  snprintf(word, sizeof word, ",%s,", name);
  return started && strstr(fails, word) != NULL;
}

/* --- memory --------------------------------------------------------------------------------------------------------------- */

static size_t place(uintptr_t p) { return (size_t)((p >> 4) * 0x9e3779b97f4a7c15u >> 46); }
static void enter(const void *p, const char *who) {
  if (!p || strstr(who, "quoin") == NULL || strstr(who, ".so") != NULL) {
    return;
  }
  size_t i = place((uintptr_t)p);
  while (block[i] > 1) {
    i = (i + 1) % (sizeof block / sizeof *block);
  }
  block[i] = (uintptr_t)p;
  kept++;
}
static void leave(const void *p) {
  for (size_t i = place((uintptr_t)p); block[i]; i = (i + 1) % (sizeof block / sizeof *block)) {
    if (block[i] == (uintptr_t)p) {
      block[i] = 1;
      kept--;
      return;
    }
  }
}
static const char *caller(void *at) {
  Dl_info info;
  return dladdr(at, &info) && info.dli_fname ? info.dli_fname : "";
}
/* 1: this one is refused. */
static int refuses(const char *who) {
  if (!started || strstr(who, "libgmp") || strstr(who, "libmpfr") || strstr(who, "shim")) {
    return 0;
  }
  allocations++;
  dice ^= dice << 13, dice ^= dice >> 7, dice ^= dice << 17;
  int no = allocations == refuse || (one_in && (dice >> 20) % one_in == 0);
  refused += (unsigned long)no;
  if (no) {
    errno = ENOMEM;
  }
  return no;
}
static void *take(void *at, void *old, size_t size, int zero) {
  const char *who = caller(at);
  pthread_mutex_lock(&lock);
  void *p = NULL;
  if (!refuses(who)) {
    if (old) {
      leave(old);
    }
    p = zero ? __libc_calloc(1, size) : __libc_realloc(old, size);
    enter(p, who);
  }
  pthread_mutex_unlock(&lock);
  return p;
}
void *malloc(size_t size) { return take(__builtin_return_address(0), NULL, size, 0); }
void *calloc(size_t n, size_t size) {
  return size && n > SIZE_MAX / size ? NULL : take(__builtin_return_address(0), NULL, n * size, 1);
}
void *realloc(void *old, size_t size) { return take(__builtin_return_address(0), old, size, 0); }
void free(void *p) {
  if (p) {
    pthread_mutex_lock(&lock);
    leave(p);
    __libc_free(p);
    pthread_mutex_unlock(&lock);
  }
}

/* --- files ------------------------------------------------------------------------------------------------------------------ */

/* How many of n bytes this call may move; -1 with errno. */
static ssize_t allowed(const char *how, unsigned long to, unsigned long *calls, size_t n, size_t few) {
  const unsigned long call = ++*calls;
  if (strcmp(how, "short") == 0) {
    return (ssize_t)(n < few ? n : few);
  }
  if ((strcmp(how, "eintr") == 0 || strcmp(how, "again") == 0) && call % 2) {
    errno = how[0] == 'e' ? EINTR : EAGAIN;
    return -1;
  }
  if (strcmp(how, "eio") == 0 && call >= to) {
    errno = EIO;
    return -1;
  }
  return (ssize_t)n;
}
ssize_t read(int fd, void *to, size_t n) {
  const ssize_t now = started && n ? allowed(reads, reads_to, &read_calls, n, 3) : (ssize_t)n;
  return now < 0 ? -1 : __read(fd, to, (size_t)now);
}
ssize_t write(int fd, const void *from, size_t n) {
  const ssize_t now = started && n && fd != 2 ? allowed(writes, writes_to, &write_calls, n, 7) : (ssize_t)n;
  return now < 0 ? -1 : __write(fd, from, (size_t)now);
}
int close(int fd) {
  const int done = __close(fd);
  if (fd > 2 && fails_now("close")) {
    errno = EDQUOT;
    return -1;
  }
  return done;
}
int fclose(FILE *f) {
  static int (*next)(FILE *);
  next = next ? next : (int (*)(FILE *))dlsym(RTLD_NEXT, "fclose");
  const int done = next(f);
  if (fails_now("fclose")) {
    errno = EDQUOT;
    return EOF;
  }
  return done;
}
int rename(const char *from, const char *to) {
  static int (*next)(const char *, const char *);
  next = next ? next : (int (*)(const char *, const char *))dlsym(RTLD_NEXT, "rename");
  if (fails_now("rename")) {
    errno = EIO;
    return -1;
  }
  return next(from, to);
}
int mkstemp(char *name) {
  static int (*next)(char *);
  next = next ? next : (int (*)(char *))dlsym(RTLD_NEXT, "mkstemp");
  if (fails_now("mkstemp")) {
    errno = ENFILE;
    return -1;
  }
  return next(name);
}
int pthread_create(pthread_t *id, const pthread_attr_t *how, void *(*run)(void *), void *user) {
  static int (*next)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
  next = next ? next : (int (*)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *))dlsym(RTLD_NEXT, "pthread_create");
  return fails_now("pthread_create") ? EAGAIN : next(id, how, run, user);
}
