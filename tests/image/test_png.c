/* PNG files: what is read back is what was written; a file that cannot be written leaves the old one and no other. */
#include "quoin/render.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>
#include <png.h>
#include <signal.h>

static char folder[64];

static int make_folder(void **state) {
  (void)state;
  strcpy(folder, "/tmp/quoin-png-XXXXXX");
  return mkdtemp(folder) ? 0 : -1;
}
static int remove_folder(void **state) {
  (void)state;
  return rmdir(folder); /* fails, and with it the test, if a file was left */
}

static const char *in_folder(const char *name) {
  static char path[128];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static size_t files_in_folder(void) {
  size_t n = 0;
  DIR *d = opendir(folder);
  assert_non_null(d);
  for (struct dirent *e; (e = readdir(d));) {
    n += e->d_name[0] != '.';
  }
  closedir(d);
  return n;
}

enum { W = 37, H = 23, ROW = 4 * W + 12 };
static unsigned char picture[H * ROW];

static void fill_picture(void) {
  for (size_t i = 0; i < sizeof picture; i++) {
    picture[i] = (unsigned char)(i * i * 31 + i / 7);
  }
}

static void assert_reads_back(const char *path) {
  png_image image = {.version = PNG_IMAGE_VERSION};
  assert_true(png_image_begin_read_from_file(&image, path));
  assert_int_equal(image.width, W);
  assert_int_equal(image.height, H);
  image.format = PNG_FORMAT_RGBA;
  unsigned char back[W * H * 4];
  assert_true(png_image_finish_read(&image, NULL, back, W * 4, NULL));
  for (size_t y = 0; y < H; y++) {
    assert_memory_equal(back + y * W * 4, picture + y * ROW, W * 4);
  }
}

static void reads_back(void **state) {
  (void)state;
  fill_picture();
  const char *path = in_folder("a.png");
  assert_int_equal(quoin_write_png(path, W, H, picture, ROW), QUOIN_OK);
  assert_reads_back(path);
  assert_int_equal(files_in_folder(), 1);
  /* over itself, and by way of a link, which stays a link */
  char link_path[128];
  snprintf(link_path, sizeof link_path, "%s/l.png", folder);
  assert_int_equal(symlink("a.png", link_path), 0);
  picture[0] ^= 255;
  assert_int_equal(quoin_write_png(link_path, W, H, picture, ROW), QUOIN_OK);
  assert_reads_back(path);
  struct stat s;
  assert_int_equal(lstat(link_path, &s), 0);
  assert_true(S_ISLNK(s.st_mode));
  assert_int_equal(files_in_folder(), 2);
  unlink(link_path);
  unlink(path);
}

static void bad_arguments(void **state) {
  (void)state;
  const char *path = in_folder("b.png");
  assert_int_equal(quoin_write_png(NULL, W, H, picture, ROW), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_write_png(path, 0, H, picture, ROW), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_write_png(path, W, 0, picture, ROW), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_write_png(path, W, H, NULL, ROW), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_write_png(path, W, H, picture, 4 * W - 1), QUOIN_E_ARGUMENT);
  assert_int_equal(quoin_write_png(path, (size_t)1 << 40, H, picture, (size_t)1 << 43), QUOIN_E_ARGUMENT);
  assert_int_equal(files_in_folder(), 0);
}

static void places_that_cannot_be_written(void **state) {
  (void)state;
  assert_int_equal(quoin_write_png(in_folder("none/such.png"), W, H, picture, ROW), QUOIN_E_IO);
  assert_int_equal(errno, ENOENT);
  assert_int_equal(quoin_write_png(folder, W, H, picture, ROW), QUOIN_E_IO);
  assert_int_equal(errno, EISDIR);
  assert_int_equal(files_in_folder(), 0);
#ifdef __linux__
  assert_int_equal(quoin_write_png("/dev/full", W, H, picture, ROW), QUOIN_E_IO);
  assert_int_equal(errno, ENOSPC);
  struct stat s;
  assert_int_equal(stat("/dev/full", &s), 0);
  assert_true(S_ISCHR(s.st_mode)); /* still the device */
#endif
}

/* The disk is full half way (a limit on the file's size stands for it): the old file is as it was, and no other is left. */
static void keeps_the_old_file(void **state) {
  (void)state;
  fill_picture();
  const char *path = in_folder("c.png");
  assert_int_equal(quoin_write_png(path, W, H, picture, ROW), QUOIN_OK);
  enum { SIDE = 300 };
  unsigned char *large = malloc(4 * SIDE * SIDE);
  assert_non_null(large);
  uint32_t seed = 1;
  for (size_t i = 0; i < 4 * SIDE * SIDE; i++) { /* noise does not compress */
    seed = seed * 1664525 + 1013904223;
    large[i] = (unsigned char)(seed >> 24);
  }
  struct rlimit old, small;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
  small = old;
  small.rlim_cur = 50000;
  void (*before)(int) = signal(SIGXFSZ, SIG_IGN);
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
  const quoin_status status = quoin_write_png(path, SIDE, SIDE, large, 4 * SIDE);
  const int why = errno;
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
  signal(SIGXFSZ, before);
  free(large);
  assert_int_equal(status, QUOIN_E_IO);
  assert_int_equal(why, EFBIG);
  assert_reads_back(path);
  assert_int_equal(files_in_folder(), 1);
  unlink(path);
}

/* "-" is standard output. */
static void standard_output(void **state) {
  (void)state;
  fill_picture();
  const char *path = in_folder("d.png");
  fflush(stdout);
  const int kept = dup(1), fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  assert_true(kept >= 0 && fd >= 0 && dup2(fd, 1) == 1);
  const quoin_status status = quoin_write_png("-", W, H, picture, ROW);
  assert_true(dup2(kept, 1) == 1);
  close(kept);
  close(fd);
  assert_int_equal(status, QUOIN_OK);
  assert_reads_back(path);
  unlink(path);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(reads_back), cmocka_unit_test(bad_arguments),
                                     cmocka_unit_test(places_that_cannot_be_written),
                                     cmocka_unit_test(keeps_the_old_file), cmocka_unit_test(standard_output)};
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
