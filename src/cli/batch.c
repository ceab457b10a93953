#include "cli/batch.h"
#include "cli/say.h"
#include "cli/stats.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
  MOST_THREADS = 256, /* the library uses no more either */
  BLOCK = 1 << 22, /* bytes of input taken at once, and the longest line */
  CHUNK = 3 << 16, /* bytes of input one thread takes at once, at most: some 4000 lines of rays */
  FEWEST = 1 << 8, /* and at least */
  SPILL = 1 << 20 /* bytes of answers a thread keeps while others have to write first */
};

/* A block of lines is cut into chunks. Threads take chunks in order and each answers its chunk into a slot; slots are
   written in order by whichever thread completes the first one not yet written. Not more than `slots` chunks are between
   taken and written, and a slot beyond SPILL bytes waits until it is first, so memory stays bounded however long answers are. */
typedef struct chunk {
  char *begin, *end;
  uint64_t line; /* number of its first line */
} chunk;

typedef struct slot {
  cli_text text;
  int ready;
  cli_fault fault;
} slot;

typedef struct block {
  cli_batch *batch;
  cli_out *out;
  const char *file;
  chunk *chunks;
  size_t chunk_count;
  slot *slots;
  size_t slot_count;
  pthread_mutex_t lock;
  pthread_cond_t moved; /* head or stop changed */
  size_t next, head; /* the next chunk to take; the first not written */
  int stop, code; /* code: the exit code when stopped */
} block;

static unsigned thread_count(unsigned wish) {
  long n = wish ? (long)wish : sysconf(_SC_NPROCESSORS_ONLN);
  return n < 1 ? 1 : n > MOST_THREADS ? MOST_THREADS : (unsigned)n;
}

int cli_batch_start(cli_batch *batch) {
  batch->threads = thread_count(batch->common->threads);
  batch->works = calloc(batch->threads, sizeof *batch->works);
  if (!batch->works) {
    cli_error("%s", quoin_status_text(QUOIN_E_MEMORY));
    return CLI_IO;
  }
  return CLI_OK;
}

quoin_work *cli_batch_work(cli_batch *batch, unsigned thread) {
  if (!batch->works[thread] && quoin_work_new(batch->scene, &batch->works[thread]) != QUOIN_OK) {
    batch->works[thread] = NULL;
  }
  return batch->works[thread];
}

static void say_stats(const cli_batch *batch, const cli_loaded *loaded, double seconds) {
  cli_stats stats = {.json = batch->json};
  quoin_stats sum = {0};
  for (unsigned i = 0; batch->works && i < batch->threads; i++) {
    cli_add_work_stats(batch->works[i], &sum);
  }
  cli_stats_load(&stats, loaded);
  cli_stats_seconds(&stats, "answer_seconds", seconds);
  cli_stats_work(&stats, &sum);
  cli_stats_say(&stats);
}

void cli_batch_free(cli_batch *batch) {
  for (unsigned i = 0; batch->works && i < batch->threads; i++) {
    quoin_work_free(batch->works[i]);
  }
  free(batch->works);
  batch->works = NULL;
}

/* --- a block -------------------------------------------------------------------------------------------------------- */

/* Waits until slot i is the first not written (or all stops), then writes what it has got. */
static void spill(block *b, size_t i, slot *s) {
  pthread_mutex_lock(&b->lock);
  while (b->head != i && !b->stop) {
    pthread_cond_wait(&b->moved, &b->lock);
  }
  int stop = b->stop;
  pthread_mutex_unlock(&b->lock);
  if (!stop) {
    cli_out_write(b->out, s->text.data, s->text.length); /* a failure is seen when the slot is completed */
  }
  s->text.length = 0;
}

/* Rows of a chunk that wait to be answered together. */
typedef struct rows {
  size_t count;
  cli_row row[CLI_ROWS];
  uint64_t line[CLI_ROWS];
  const char *numbers[CLI_ROWS * CLI_MAX_NUMBERS + CLI_ROW_ROOM]; /* row after row; the last one may be one too long */
} rows;

static quoin_status answer_rows(block *b, unsigned thread, quoin_work *work, const rows *r, cli_text *text, size_t first, size_t *done) {
  cli_batch *batch = b->batch;
  const char *const *numbers = r->numbers + first * batch->kind.numbers;
  size_t before = text->length;
  quoin_status status;
  if (batch->answer_many) {
    status = batch->answer_many(batch->user, thread, work, r->count - first, numbers, text, done);
  } else {
    status = batch->answer(batch->user, thread, work, numbers, text);
    *done = status == QUOIN_OK;
    text->length = status == QUOIN_OK ? text->length : before;
  }
  if (text->failed) {
    *done = 0;
    text->length = before;
    return QUOIN_E_MEMORY;
  }
  return status;
}

/* Answers the rows that wait; a fault of one of them is set. */
static void answer_waiting(block *b, unsigned thread, size_t i, quoin_work *work, rows *r, slot *s) {
  for (size_t at = 0; at < r->count && s->fault.status == QUOIN_OK;) {
    size_t done = 0;
    quoin_status status = answer_rows(b, thread, work, r, &s->text, at, &done);
    at += done;
    if (status != QUOIN_OK) {
      cli_row_refused(&r->row[at], b->batch->scene, work, status, r->line[at], &s->fault);
    } else if (s->text.length >= SPILL) {
      spill(b, i, s);
    }
  }
  r->count = 0;
}

/* Answers chunk i into its slot. */
static void answer(block *b, unsigned thread, size_t i, slot *s) {
  const cli_row_kind *kind = &b->batch->kind;
  quoin_work *work = cli_batch_work(b->batch, thread);
  s->fault.status = work ? QUOIN_OK : QUOIN_E_MEMORY;
  uint64_t number = b->chunks[i].line;
  size_t most = b->batch->answer_many ? CLI_ROWS : 1;
  rows r;
  r.count = 0;
  for (char *line = b->chunks[i].begin, *end; line < b->chunks[i].end && s->fault.status == QUOIN_OK; line = end + 1, number++) {
    end = memchr(line, '\n', (size_t)(b->chunks[i].end - line));
    end = end ? end : b->chunks[i].end; /* the last line of a file may lack its end; the byte after it is ours */
    cli_row *row = &r.row[r.count];
    cli_row_cut(row, r.numbers + r.count * kind->numbers, line, end);
    if (row->count == 0) {
      continue;
    }
    cli_fault fault;
    if (cli_row_fault(row, kind, number, &fault)) { /* the rows before it come first */
      answer_waiting(b, thread, i, work, &r, s);
      s->fault = s->fault.status == QUOIN_OK ? fault : s->fault;
      return;
    }
    r.line[r.count++] = number;
    if (r.count == most) {
      answer_waiting(b, thread, i, work, &r, s);
    }
  }
  if (s->fault.status == QUOIN_OK) {
    answer_waiting(b, thread, i, work, &r, s);
  }
}

static void stop(block *b, int code) {
  b->stop = 1;
  b->code = code;
  pthread_cond_broadcast(&b->moved);
}

/* Slot i is complete: if it is the first not written, writes it and those ready behind it. Called with the lock held;
   the lock is free while bytes are written, and head, which alone gives the right to write, stays. */
static void complete(block *b, size_t i) {
  b->slots[i % b->slot_count].ready = 1;
  if (b->head != i) {
    return;
  }
  while (b->head < b->chunk_count && b->slots[b->head % b->slot_count].ready && !b->stop) {
    slot *s = &b->slots[b->head % b->slot_count];
    pthread_mutex_unlock(&b->lock);
    int failed = cli_out_write(b->out, s->text.data, s->text.length);
    int code = failed ? (int)CLI_IO : cli_code(s->fault.status);
    if (!failed && code != CLI_OK) { /* what was answered before the fault is out before it is said */
      cli_out_flush(b->out);
      if (s->fault.status == QUOIN_E_MEMORY) {
        cli_error("%s", quoin_status_text(QUOIN_E_MEMORY));
      } else {
        cli_say_fault(&s->fault, b->file);
      }
    }
    s->text.length = 0;
    pthread_mutex_lock(&b->lock);
    s->ready = 0;
    if (code != CLI_OK) {
      stop(b, code);
    }
    b->head++;
    pthread_cond_broadcast(&b->moved);
  }
}

static void work_off(block *b, unsigned thread) {
  pthread_mutex_lock(&b->lock);
  for (;;) {
    while (!b->stop && b->next < b->chunk_count && b->next >= b->head + b->slot_count) {
      pthread_cond_wait(&b->moved, &b->lock);
    }
    if (b->stop || b->next == b->chunk_count) {
      break;
    }
    size_t i = b->next++;
    slot *s = &b->slots[i % b->slot_count];
    pthread_mutex_unlock(&b->lock);
    answer(b, thread, i, s);
    pthread_mutex_lock(&b->lock);
    complete(b, i);
  }
  pthread_mutex_unlock(&b->lock);
}

typedef struct helper {
  block *b;
  unsigned thread;
  pthread_t id;
} helper;

static void *help(void *arg) {
  helper *h = arg;
  work_off(h->b, h->thread);
  return NULL;
}

/* Cuts [text, text + length) into chunks and answers them all. Returns the number of lines. */
static uint64_t run_block(block *b, char *text, size_t length, uint64_t line, helper *helpers) {
  size_t size = length / (8 * (size_t)b->batch->threads) + 1; /* some chunks a thread, so that all end at about one time */
  size = size > CHUNK ? CHUNK : size < FEWEST ? FEWEST : size;
  b->chunk_count = 0;
  uint64_t first = line;
  for (char *at = text, *end = text + length; at < end;) {
    chunk *c = &b->chunks[b->chunk_count++];
    char *stop_at = (size_t)(end - at) > size ? memchr(at + size - 1, '\n', (size_t)(end - at) - size + 1) : NULL;
    *c = (chunk){at, stop_at ? stop_at + 1 : end, line};
    for (const char *n = at; n < c->end && (n = memchr(n, '\n', (size_t)(c->end - n))) != NULL; n++) {
      line++;
    }
    at = c->end;
  }
  b->next = b->head = 0;
  unsigned started = 1;
  for (; started < b->batch->threads && started < b->chunk_count; started++) {
    helpers[started] = (helper){.b = b, .thread = started};
    if (pthread_create(&helpers[started].id, NULL, help, &helpers[started])) {
      break; /* those there are do its work */
    }
  }
  work_off(b, 0);
  for (unsigned i = 1; i < started; i++) {
    pthread_join(helpers[i].id, NULL);
  }
  return line - first;
}

/* --- the input ------------------------------------------------------------------------------------------------------ */

typedef struct input {
  int fd;
  char *text; /* BLOCK + 1 bytes: the last number of a file needs its NUL */
  size_t length;
  int ended;
} input;

/* Reads until the block is full, the input ends, or it has something but would make us wait. -1: errno tells. */
static int fill(input *in) {
  while (in->length < BLOCK) {
    ssize_t got = read(in->fd, in->text + in->length, BLOCK - in->length);
    if (got < 0) {
      if (errno == EAGAIN || errno == EWOULDBLOCK) {
        struct pollfd wait = {.fd = in->fd, .events = POLLIN};
        poll(&wait, 1, -1);
      } else if (errno != EINTR) {
        return -1;
      }
      continue;
    }
    if (got == 0) {
      in->ended = 1;
      return 0;
    }
    in->length += (size_t)got;
    struct pollfd more = {.fd = in->fd, .events = POLLIN};
    if (poll(&more, 1, 0) <= 0) {
      return 0;
    }
  }
  return 0;
}

/* The bytes of whole lines that are there. */
static size_t whole_lines(const input *in) {
  size_t length = in->length;
  while (length && in->text[length - 1] != '\n') {
    length--;
  }
  return length;
}

static void say_too_long(const char *file, uint64_t line) {
  cli_fault fault = {.line = line, .column = 1, .length = 1, .reason = "", .code = "Q1005"};
  snprintf(fault.problem, sizeof fault.problem, "a line of more than %d bytes", BLOCK);
  cli_say_fault(&fault, file);
}

static int run_lines(block *b, input *in, helper *helpers) {
  uint64_t line = 1;
  while (!in->ended) {
    if (fill(in)) {
      int error = errno;
      cli_quoted q;
      cli_out_flush(b->out);
      cli_error("cannot read %s: %s", cli_quote(&q, b->file), strerror(error));
      return CLI_IO;
    }
    size_t length = in->ended ? in->length : whole_lines(in);
    if (length == 0 && in->length == BLOCK) {
      say_too_long(b->file, line);
      return CLI_USAGE;
    }
    line += run_block(b, in->text, length, line, helpers);
    if (b->stop || cli_out_flush(b->out)) {
      return b->stop ? b->code : CLI_IO;
    }
    in->length -= length;
    memmove(in->text, in->text + length, in->length);
  }
  return CLI_OK;
}

int cli_batch_lines(cli_batch *batch, const char *path, cli_out *out) {
  int is_stdin = strcmp(path, "-") == 0;
  input in = {.fd = is_stdin ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC)};
  if (in.fd < 0) {
    cli_quoted q;
    cli_error("cannot read %s: %s", cli_quote(&q, path), strerror(errno));
    return CLI_IO;
  }
  block b = {.batch = batch, .out = out, .file = is_stdin ? "<stdin>" : path, .slot_count = 4 * (size_t)batch->threads};
  helper *helpers = calloc(batch->threads, sizeof *helpers);
  in.text = malloc(BLOCK + 1);
  b.chunks =
    malloc((8 * (size_t)batch->threads + BLOCK / CHUNK + 2) * sizeof *b.chunks); /* a chunk is CHUNK bytes or an 8th of a thread's share */
  b.slots = calloc(b.slot_count, sizeof *b.slots);
  int code = CLI_IO;
  if (helpers && in.text && b.chunks && b.slots) {
    pthread_mutex_init(&b.lock, NULL);
    pthread_cond_init(&b.moved, NULL);
    code = run_lines(&b, &in, helpers);
    pthread_cond_destroy(&b.moved);
    pthread_mutex_destroy(&b.lock);
  } else {
    cli_error("%s", quoin_status_text(QUOIN_E_MEMORY));
  }
  for (size_t i = 0; b.slots && i < b.slot_count; i++) {
    cli_text_free(&b.slots[i].text);
  }
  free(b.slots);
  free(b.chunks);
  free(in.text);
  free(helpers);
  if (!is_stdin) {
    close(in.fd);
  }
  return code;
}

/* --- arguments ------------------------------------------------------------------------------------------------------ */

/* Says why row `index` of the arguments has no answer; returns the exit code. */
static int say_refused(const cli_batch *batch, quoin_work *work, quoin_status status, const char *const *numbers, unsigned count,
                       unsigned long index) {
  cli_quoted q;
  int by_number = status == QUOIN_E_NUMBER || status == QUOIN_E_LIMIT;
  unsigned bad = by_number ? cli_first_bad_number(batch->scene, work, numbers, count) : count;
  if (bad < count) {
    cli_error("%s is not a number (%s %lu, number %u; %s)", cli_quote(&q, numbers[bad]), batch->kind.what, index, bad + 1,
              CLI_NUMBER_RULE(status));
    return CLI_USAGE;
  }
  if (status == QUOIN_E_NUMBER) { /* all are, but there are too few */
    cli_error("the last %s has %u number%s of %u: %s", batch->kind.what, count, count == 1 ? "" : "s", batch->kind.numbers,
              batch->kind.shape);
  } else if (status == QUOIN_E_ARGUMENT && count == 6 && cli_is_zero(numbers[3]) && cli_is_zero(numbers[4]) && cli_is_zero(numbers[5])) {
    cli_error("the direction of ray %lu is zero", index);
  } else {
    cli_error("no answer for %s %lu: %s", batch->kind.what, index, quoin_status_text(status));
  }
  return cli_code(status);
}

int cli_batch_arguments(cli_batch *batch, cli_out *out) {
  const char *numbers[CLI_MAX_NUMBERS];
  unsigned count = 0;
  unsigned long index = 0;
  quoin_work *work = cli_batch_work(batch, 0);
  cli_text text = {0};
  cli_quoted q;
  int code = work ? CLI_OK : CLI_IO;
  if (!work) {
    cli_error("%s", quoin_status_text(QUOIN_E_MEMORY));
  }
  for (int i = 1; i < batch->common->operand_count && code == CLI_OK; i++) {
    /* "1,2,3" or "1 2 3" in one argument is three numbers, as on a line. */
    char *rest = batch->common->operands[i];
    int any = 0;
    for (char *word; code == CLI_OK && (word = strtok_r(rest, ", \t", &rest)) != NULL; any = 1) {
      numbers[count++] = word;
      if (count < batch->kind.numbers) {
        continue;
      }
      index++;
      quoin_status status = batch->answer(batch->user, 0, work, numbers, &text);
      status = status == QUOIN_OK && text.failed ? QUOIN_E_MEMORY : status;
      if (status == QUOIN_OK) {
        cli_out_write(out, text.data, text.length);
      } else {
        cli_out_flush(out);
        code = say_refused(batch, work, status, numbers, count, index);
      }
      text.length = 0;
      count = 0;
    }
    if (!any && code == CLI_OK) {
      cli_error("%s is not a number", cli_quote(&q, ""));
      code = CLI_USAGE;
    }
  }
  if (code == CLI_OK && count) {
    cli_out_flush(out);
    code = say_refused(batch, work, QUOIN_E_NUMBER, numbers, count, index + 1);
  }
  cli_text_free(&text);
  return code;
}

/* --- the whole command ---------------------------------------------------------------------------------------------- */

int cli_batch_run(cli_batch *batch, const cli_command *command, const cli_common *common, const char *source,
                  int (*prepare)(cli_batch *batch)) {
  const char *path = cli_model_operand(command, common);
  if (!path) {
    return CLI_USAGE;
  }
  int from_arguments = common->operand_count > 1;
  if (from_arguments && source) {
    cli_error("%ss are given both as arguments and by --input; leave one out", batch->kind.what);
    return cli_try_help(command);
  }
  source = source ? source : "-";
  if (!from_arguments && strcmp(path, "-") == 0 && strcmp(source, "-") == 0) {
    cli_error("the model and the %ss cannot both come from standard input; use --input FILE or arguments", batch->kind.what);
    return cli_try_help(command);
  }
  cli_loaded loaded;
  cli_out out;
  batch->common = common;
  int code = cli_load(common, path, 1, &loaded);
  double start = cli_clock();
  cli_out_open(&out, NULL);
  if (code == CLI_OK) {
    batch->scene = loaded.scene;
    code = cli_batch_start(batch);
    code = code == CLI_OK && prepare ? prepare(batch) : code;
    if (code == CLI_OK) {
      code = from_arguments ? cli_batch_arguments(batch, &out) : cli_batch_lines(batch, source, &out);
    }
    if (common->stats) {
      say_stats(batch, &loaded, cli_clock() - start);
    }
    cli_batch_free(batch);
  }
  int closed = cli_out_close(&out, 1);
  cli_unload(&loaded);
  return closed != CLI_OK ? closed : code;
}
