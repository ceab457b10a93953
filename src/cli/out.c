#define _XOPEN_SOURCE 700 /* realpath */
#include "cli/out.h"
#include "cli/say.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { ENOUGH = 1 << 16 }; /* bytes kept before a write */

static void fail(cli_out *out, int error) {
  if (!out->error) {
    out->error = error ? error : EIO;
  }
}

/* Opens a temporary file beside out->target, with the rights the target has or would get. */
static void open_temporary(cli_out *out, const struct stat *old) {
  static const char name[] = ".quoin-XXXXXX"; /* short: a name as long as the system allows still has its temporary */
  const char *slash = strrchr(out->target, '/');
  size_t folder = slash ? (size_t)(slash - out->target) + 1 : 0;
  out->temporary = malloc(folder + sizeof name);
  if (!out->temporary) {
    fail(out, ENOMEM);
    return;
  }
  memcpy(out->temporary, out->target, folder);
  memcpy(out->temporary + folder, name, sizeof name);
  out->fd = mkstemp(out->temporary);
  if (out->fd < 0) {
    fail(out, errno);
    free(out->temporary);
    out->temporary = NULL;
    return;
  }
  mode_t mask = umask(0);
  umask(mask);
  if (fchmod(out->fd, old ? old->st_mode & 0777 : 0666 & ~mask)) {
    fail(out, errno);
  }
}

void cli_out_open(cli_out *out, const char *path) {
  *out = (cli_out){.fd = STDOUT_FILENO};
  if (!path || strcmp(path, "-") == 0) {
    return;
  }
  out->path = path;
  out->fd = -1;
  struct stat old;
  int there = stat(path, &old) == 0;
  if (there && S_ISDIR(old.st_mode)) {
    fail(out, EISDIR);
  } else if (there && !S_ISREG(old.st_mode)) { /* a device or a pipe is written to, never replaced */
    out->fd = open(path, O_WRONLY | O_CLOEXEC);
    if (out->fd < 0) {
      fail(out, errno);
    }
  } else {
    out->target = there ? realpath(path, NULL) : strdup(path);
    if (out->target) {
      open_temporary(out, there ? &old : NULL);
    } else {
      fail(out, errno);
    }
  }
}

static void write_all(cli_out *out, const char *bytes, size_t length) {
  while (length && !out->error) {
    ssize_t done = write(out->fd, bytes, length);
    if (done >= 0) {
      bytes += done;
      length -= (size_t)done;
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) { /* someone made the pipe non-blocking: wait for the reader */
      struct pollfd wait = {.fd = out->fd, .events = POLLOUT};
      poll(&wait, 1, -1);
    } else if (errno != EINTR) {
      fail(out, errno);
    }
  }
}

int cli_out_flush(cli_out *out) {
  write_all(out, out->buffer.data, out->buffer.length);
  out->buffer.length = 0;
  return out->error ? -1 : 0;
}

int cli_out_write(cli_out *out, const char *bytes, size_t length) {
  if (length >= ENOUGH) {
    cli_out_flush(out);
    write_all(out, bytes, length);
  } else {
    cli_put(&out->buffer, bytes, length);
    if (out->buffer.failed) {
      fail(out, ENOMEM);
    } else if (out->buffer.length >= ENOUGH) {
      cli_out_flush(out);
    }
  }
  return out->error ? -1 : 0;
}

int cli_out_text(cli_out *out, const cli_text *text) {
  if (text->failed) {
    fail(out, ENOMEM);
    return -1;
  }
  return cli_out_write(out, text->data, text->length);
}

int cli_out_close(cli_out *out, int keep) {
  if (keep || !out->path) {
    cli_out_flush(out);
  }
  /* Some file systems (quotas, networks) tell of a failed write only here. */
  if (out->fd >= 0 && close(out->fd) && errno != EINTR) {
    fail(out, errno);
  }
  out->fd = -1;
  if (out->temporary) {
    if (keep && !out->error && rename(out->temporary, out->target)) {
      fail(out, errno);
    }
    if (!keep || out->error) {
      unlink(out->temporary);
    }
  }
  if (out->error && !(out->error == EPIPE && !out->path)) {
    cli_quoted q;
    cli_error("cannot write %s: %s", out->path ? cli_quote(&q, out->path) : "standard output", strerror(out->error));
  }
  free(out->temporary);
  free(out->target);
  cli_text_free(&out->buffer);
  return out->error ? CLI_IO : CLI_OK;
}
