/* quoin: types shared by every public header: status, allocator, diagnostics, numbers. C99-clean. */
#ifndef QUOIN_TYPES_H
#define QUOIN_TYPES_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define QUOIN_API __attribute__((visibility("default")))
#else
#define QUOIN_API
#endif

/* What a call came to. Every call that can fail returns one; nothing in the library aborts, prints or exits. */
typedef enum quoin_status {
  QUOIN_OK = 0,
  QUOIN_E_MEMORY,    /* an allocation was refused, or the memory limit was met; the call had no effect */
  QUOIN_E_ARGUMENT,  /* an argument is not allowed (null, not finite, a zero direction, a bad node); no effect */
  QUOIN_E_MODEL,     /* the model has errors; its diagnostics say which and where */
  QUOIN_E_LIMIT,     /* a named limit was met; a diagnostic names it */
  QUOIN_E_IO,        /* reading or writing failed; errno is as the system left it */
  QUOIN_E_CANCELLED, /* the progress callback asked to stop */
  QUOIN_E_NUMBER     /* a text is not a number */
} quoin_status;

/* A short fixed English text for a status ("out of memory"). Never null. */
QUOIN_API const char *quoin_status_text(quoin_status status);

/* The library's version, "0.1.0". */
QUOIN_API const char *quoin_version(void);

/* A caller's allocator. All three functions are called from any thread that uses the objects made with it, the library's own among them, so also at the
   same time; with the size that was asked for, never 0, and never a null block. Blocks are aligned as malloc's. alloc and resize return null to refuse;
   the block of a refused resize stays as it was. alloc null: malloc, and only `limit` counts. A null quoin_allocator pointer means malloc (and large pages).
   GMP and MPFR use their own allocator for temporaries while a model is being read. */
typedef struct quoin_allocator {
  void *(*alloc)(void *user, size_t size);
  void *(*resize)(void *user, void *block, size_t old_size, size_t new_size);
  void (*release)(void *user, void *block, size_t size);
  void *user;
  size_t limit; /* bytes in use at once, after which allocation is refused; 0: none */
} quoin_allocator;

/* Called during long work, once at least, from the calling thread only. done runs from 0 to 1. Return non-zero to stop:
   the work ends with QUOIN_E_CANCELLED. */
typedef struct quoin_progress {
  int (*report)(void *user, double done);
  void *user;
} quoin_progress;

typedef enum quoin_severity { QUOIN_NOTE, QUOIN_WARNING, QUOIN_ERROR } quoin_severity;

/* A diagnostic: file:line:col: error: problem (reason); way out [code]. Strings live as long as the object that was
   asked. Absent parts are empty strings, never null; line 0 means "no place". Columns count bytes from 1. */
typedef struct quoin_diag {
  quoin_severity severity;
  const char *code; /* "Q0103"; the table is docs/language.md */
  const char *file;
  uint32_t line, column, length; /* length: bytes to mark from column, at least 1 */
  const char *problem, *reason, *way_out;
  const char *source; /* the source line without its end, or "" */
} quoin_diag;

/* Formats a diagnostic as text with the source line and a caret, at most size bytes with the final NUL; returns the
   length it needs without the NUL, as snprintf does; nothing, and 0, of no diagnostic. */
QUOIN_API size_t quoin_diag_format(const quoin_diag *diag, char *text, size_t size);

/* Receives output text. Return 0, or non-zero to stop with QUOIN_E_IO. */
typedef int (*quoin_write_fn)(void *user, const char *text, size_t length);

#ifdef __cplusplus
}
#endif
#endif
