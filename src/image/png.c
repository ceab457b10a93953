/* PNG files, by libpng. A file is whole or not there: it is written under another name in the same folder and renamed. What
   is not a regular file (a device, a pipe) cannot be replaced and is written to directly. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "quoin/render.h"

#include <errno.h>
#include <fcntl.h>
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#define LARGEST_SIDE 0x7fffffff  /* the format's: 31 bits */
/* One filter (the difference from the row above) and a low level of compression: with libpng's defaults, all filters tried in each row and level 6,
   a picture of 800 x 600 took 22 ms in place of 4.5, for 20 % fewer bytes (docs/decisions/0006-pictures.md). */
#define COMPRESSION 3
#define TEMPORARY_NAMES 10000    /* tries for a name that is free */

/* What the callbacks of libpng know: where to go on an error, and what it was. */
typedef struct sink {
  FILE *file;
  int saved_errno; /* of the write that failed, else 0 */
  int no_memory;
  jmp_buf back;
} sink;

static void on_error(png_structp png, png_const_charp text) {
  (void)text;
  sink *s = png_get_error_ptr(png);
  longjmp(s->back, 1);
}
static void on_warning(png_structp png, png_const_charp text) {
  (void)png, (void)text;
}

static png_voidp take(png_structp png, png_alloc_size_t size) {
  void *block = malloc(size);
  if (!block) {
    ((sink *)png_get_mem_ptr(png))->no_memory = 1;
  }
  return block;
}
static void give_back(png_structp png, png_voidp block) {
  (void)png;
  free(block);
}

static void on_write(png_structp png, png_bytep data, size_t size) {
  sink *s = png_get_io_ptr(png);
  if (fwrite(data, 1, size, s->file) != size) {
    s->saved_errno = errno;
    png_error(png, "write failed");
  }
}
static void on_flush(png_structp png) {
  (void)png;
}

static int is_opaque(size_t width, size_t height, const unsigned char *pixels, size_t row_bytes) {
  for (size_t y = 0; y < height; y++) {
    unsigned char all = 255;
    for (size_t x = 0; x < width; x++) {
      all &= pixels[y * row_bytes + 4 * x + 3];
    }
    if (all != 255) {
      return 0;
    }
  }
  return 1;
}

/* All calls that may jump back. Returns 0 after a jump. Nothing here changes between the setjmp and a jump but *s. */
static int encode(sink *s, png_structp png, png_infop info, png_uint_32 width, png_uint_32 height, const unsigned char *pixels,
                  size_t row_bytes, int opaque) {
  if (setjmp(s->back)) {
    return 0;
  }
  png_set_write_fn(png, s, on_write, on_flush);
  png_set_user_limits(png, LARGEST_SIDE, LARGEST_SIDE);
  png_set_IHDR(png, info, width, height, 8, opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
  png_set_compression_level(png, COMPRESSION);
  png_set_compression_strategy(png, Z_DEFAULT_STRATEGY);
  png_write_info(png, info);
  if (opaque) {
    png_set_filler(png, 0, PNG_FILLER_AFTER); /* the fourth byte is left out */
  }
  for (png_uint_32 y = 0; y < height; y++) {
    png_write_row(png, pixels + (size_t)y * row_bytes);
  }
  png_write_end(png, info);
  return 1;
}

/* The picture into an open stream. On QUOIN_E_IO errno is the reason. */
static quoin_status write_stream(FILE *file, size_t width, size_t height, const unsigned char *pixels, size_t row_bytes) {
  sink s = {.file = file};
  if (setjmp(s.back)) { /* libpng's start has failed */
    return QUOIN_E_MEMORY;
  }
  png_structp png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &s, on_error, on_warning, &s, take, give_back);
  if (!png) {
    return QUOIN_E_MEMORY;
  }
  png_infop info = png_create_info_struct(png);
  const int done = info && encode(&s, png, info, (png_uint_32)width, (png_uint_32)height, pixels, row_bytes, is_opaque(width, height, pixels, row_bytes));
  const int no_memory = s.no_memory || !info; /* before info is freed and cleared */
  png_destroy_write_struct(&png, &info);
  if (done && fflush(file) == 0) {
    return QUOIN_OK;
  }
  if (done) {
    return QUOIN_E_IO; /* errno is fflush's */
  }
  errno = s.saved_errno ? s.saved_errno : EIO;
  return no_memory ? QUOIN_E_MEMORY : QUOIN_E_IO;
}

/* Writes through a descriptor, which is closed in any case. */
static quoin_status write_and_close(int fd, size_t width, size_t height, const unsigned char *pixels, size_t row_bytes) {
  FILE *file = fdopen(fd, "wb");
  if (!file) {
    const int why = errno;
    close(fd);
    errno = why;
    return QUOIN_E_IO;
  }
  quoin_status status = write_stream(file, width, height, pixels, row_bytes);
  const int why = errno;
  if (fclose(file) != 0 && status == QUOIN_OK) {
    return QUOIN_E_IO;
  }
  errno = why;
  return status;
}

/* Opens a new file beside `path`; its name, malloced, into *name. -1 with errno. */
static int open_beside(const char *path, char **name) {
  const size_t size = strlen(path) + 64;
  char *text = malloc(size);
  if (!text) {
    errno = ENOMEM;
    return -1;
  }
  for (int i = 0; i < TEMPORARY_NAMES; i++) {
    (void)snprintf(text, size, "%s.%ld-%d.tmp", path, (long)getpid(), i);
    const int fd = open(text, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd >= 0) {
      *name = text;
      return fd;
    }
    if (errno != EEXIST) {
      break;
    }
  }
  const int why = errno;
  free(text);
  errno = why;
  return -1;
}

/* A regular file, or one that is not there yet: the whole picture, or nothing changed. */
static quoin_status replace_file(const char *path, size_t width, size_t height, const unsigned char *pixels, size_t row_bytes) {
  char *name = NULL;
  const int fd = open_beside(path, &name);
  if (fd < 0) {
    return errno == ENOMEM ? QUOIN_E_MEMORY : QUOIN_E_IO;
  }
  quoin_status status = write_and_close(fd, width, height, pixels, row_bytes);
  if (status == QUOIN_OK && rename(name, path) != 0) {
    status = QUOIN_E_IO;
  }
  if (status != QUOIN_OK) {
    const int why = errno;
    (void)unlink(name);
    errno = why;
  }
  free(name);
  return status;
}

quoin_status quoin_write_png(const char *path, size_t width, size_t height, const unsigned char *pixels, size_t row_bytes) {
  if (!path || !pixels || width == 0 || height == 0 || width > LARGEST_SIDE / 4 || height > LARGEST_SIDE || row_bytes < 4 * width ||
      row_bytes > SIZE_MAX / height) {
    return QUOIN_E_ARGUMENT;
  }
  if (strcmp(path, "-") == 0) {
    return write_stream(stdout, width, height, pixels, row_bytes);
  }
  struct stat there;
  if (stat(path, &there) != 0) {
    if (errno != ENOENT) {
      return QUOIN_E_IO;
    }
    return replace_file(path, width, height, pixels, row_bytes);
  }
  if (S_ISDIR(there.st_mode)) {
    errno = EISDIR;
    return QUOIN_E_IO;
  }
  if (!S_ISREG(there.st_mode)) {
    const int fd = open(path, O_WRONLY | O_CLOEXEC);
    return fd < 0 ? QUOIN_E_IO : write_and_close(fd, width, height, pixels, row_bytes);
  }
  char *target = realpath(path, NULL); /* a link keeps being a link: its target is replaced */
  if (!target) {
    return errno == ENOMEM ? QUOIN_E_MEMORY : QUOIN_E_IO;
  }
  const quoin_status status = replace_file(target, width, height, pixels, row_bytes);
  const int why = errno;
  free(target);
  errno = why;
  return status;
}
