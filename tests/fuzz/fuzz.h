/* What the fuzz targets share: a counted allocator, a model from an input, numbers from its tail, and what is said when a law fails.

   An input is a model's text and, after a line that begins with //@, the bytes from which rays and points are made: one input serves every
   target. Each target is one C file with LLVMFuzzerTestOneInput; libFuzzer calls it, or main.c does (AFL++, and the corpus in tests). */
#ifndef QN_FUZZ_FUZZ_H
#define QN_FUZZ_FUZZ_H

#include "quoin/quoin.h"

#include <math.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum {
  FUZZ_MEMORY = 256 << 20,  /* bytes that a model and all that is made of it may take */
  FUZZ_MILLISECONDS = 2000, /* of processor time for one input in a build without sanitizers */
};

/* Says why an input is a find and ends the program, as fuzzers want it. */
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2), noreturn))
#endif
void fuzz_wrong(const char *format, ...);

/* The clock of one input: begin, end. Ends the program when it took too long; fuzz_late tells whether half the time is gone, so that a target
   does not ask a slow model too many questions. */
void fuzz_begin(const uint8_t *data, size_t size);
void fuzz_end(void);
int fuzz_late(void);

/* The model's part of an input, and its tail. */
typedef struct fuzz_bytes { const uint8_t *at, *end; } fuzz_bytes;
size_t fuzz_split(const uint8_t *data, size_t size, fuzz_bytes *tail); /* the length of the text */

/* The next number of the tail: small multiples of 1/4 for printable bytes, else tenths, powers of two, neighbours of doubles, any double. Finite; 0 at
   the end. */
double fuzz_number(fuzz_bytes *tail);
int fuzz_more(const fuzz_bytes *tail);

typedef struct fuzz_scene {
  quoin_model *model;
  quoin_scene *scene;
  quoin_work *work;
  quoin_status status; /* of reading */
  int super; /* the text has superquadrics: their answers are held to less (design S10) */
} fuzz_scene;

/* Reads and compiles; 0 when the text has errors or a limit is met. What is made is freed with fuzz_close in any case. Ends the program when a status is
   none of those that the call may give. */
int fuzz_read(const uint8_t *text, size_t length, fuzz_scene *out);
int fuzz_compile(fuzz_scene *scene, const char *snap);
void fuzz_close(fuzz_scene *scene);

/* Ends the program unless the status is OK, or a refusal that a question may meet; then 0. */
int fuzz_answered(quoin_status status, const char *question);

/* A text that grows; freed by the caller. fuzz_append is a quoin_write_fn. */
typedef struct fuzz_text { char *at; size_t length, capacity; } fuzz_text;
int fuzz_append(void *user, const char *piece, size_t length);

/* The double as a decimal, exactly. */
enum { FUZZ_DECIMAL = 1200 };
void fuzz_decimal(double v, char text[FUZZ_DECIMAL]);

#endif
