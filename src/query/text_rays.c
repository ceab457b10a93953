/* All stretches of many rays that are given as decimals. Packets take them as the nearest doubles with rests (docs/bounds.md, "Lines of decimals"); a ray that they give
   up is answered as text.

   Rays of one direction in no order (lines of a file, shot at a solid at random) are sorted across it, a block at a time, and answered in packets of neighbours; their answers are
   kept until they can be given in the order of the questions. */
#include "query/across.h"
#include "query/decimals.h"
#include "query/look.h"
#include "query/sheaf.h"

#include <math.h>
#include <string.h>

enum { BLOCK = QN_ACROSS_MOST, FEWEST = 4 * QN_FEW, TOGETHER = QN_FEW }; /* FEWEST: rays that are worth a sort; TOGETHER: sorted ones in a packet */

/* Where a ray's answer is: `count` stretches from found[first] on; or it is not for packets. */
typedef struct kept { size_t first; uint32_t count; int sure; } kept;

struct qn_text_rays {
  quoin_ray rays[BLOCK];
  double low[BLOCK][6]; /* rests of origins and directions */
  const char *const *text; /* of rays[0] on */
  uint16_t which[BLOCK];   /* sorted */
  qn_across_room room;
  kept kept[BLOCK];
  quoin_interval *found; size_t found_count, found_capacity;
};

void qn_text_rays_free(quoin_work *work) {
  if (work->text_rays) {
    qn_free(work->mem, work->text_rays->found, work->text_rays->found_capacity * sizeof *work->text_rays->found);
    qn_free(work->mem, work->text_rays, sizeof *work->text_rays);
  }
}

/* Reads up to `most` rays; how many. It stops before one that packets do not take. */
static size_t read_block(qn_text_rays *b, size_t most, const char *const *text, double from, double to) {
  b->text = text;
  for (size_t n = 0; n < most; n++, text += 6) {
    quoin_ray *ray = &b->rays[n];
    ray->from = from, ray->to = to;
    for (int k = 0; k < 6; k++) {
      double *high = k < 3 ? &ray->o[k] : &ray->d[k - 3];
      if (n && text[k] && strcmp(text[k], text[k - 6]) == 0) { /* rays of one direction, or from one eye */
        *high = k < 3 ? ray[-1].o[k] : ray[-1].d[k - 3], b->low[n][k] = b->low[n - 1][k];
      } else if (!qn_decimal_pair(text[k], high, &b->low[n][k])) {
        return n;
      }
    }
    if (!qn_is_ray(ray)) {
      return n;
    }
  }
  return most;
}

/* An end of the range as a double; 0 when it is none. */
static int end_of_range(const char *text, double none, double *out) {
  double low;
  *out = none;
  return !text || (qn_decimal_pair(text, out, &low) && low == 0);
}

static quoin_status line_of_text(quoin_work *work, const void *user, size_t i, qn_line *line) {
  const char *const *text = user;
  return qn_decimal_line(work, text + 6 * i, line);
}

/* Of a packet of sorted rays that begins at *user. */
typedef struct sorted_lines { const qn_text_rays *b; size_t at; } sorted_lines;
static quoin_status line_of_sorted(quoin_work *work, const void *user, size_t i, qn_line *line) {
  const sorted_lines *s = user;
  return qn_decimal_line(work, s->b->text + 6 * (size_t)s->b->which[s->at + i], line);
}

/* What is asked, and who is told. */
typedef struct question {
  const quoin_scene *scene;
  quoin_work *work;
  const char *from, *to;
  unsigned want;
  int (*each)(void *user, size_t i, const quoin_intervals *answer);
  void *user;
} question;

/* Gives the answer of ray i: that of a packet, or else as text. */
static quoin_status give(const question *q, size_t i, const char *const *text, int sure, size_t count, const quoin_interval *found) {
  quoin_intervals one = {count, found, 0, q->work->boundary, 0, q->work->contacts};
  const quoin_status status = sure ? QUOIN_OK : quoin_ray_intervals_text(q->scene, q->work, text, q->from, q->to, q->want, &one);
  return status == QUOIN_OK && q->each(q->user, i, &one) != 0 ? QUOIN_E_CANCELLED : status;
}

/* n rays as they come; `at` is the first one's number for who asked. */
static quoin_status answer_in_order(const question *q, size_t n, size_t at) {
  const qn_text_rays *b = q->work->text_rays;
  quoin_status status = QUOIN_OK;
  for (size_t used = 0, alone = 0, count; used < n && status == QUOIN_OK; used += count) {
    count = qn_rays_share(q->scene, n - used, b->rays + used, &alone);
    uint64_t sure = 0;
    status = qn_sheaf_rays(q->work, count, b->rays + used, q->work->text_rays->low + used, 0, line_of_text, b->text + 6 * used, &sure);
    for (size_t i = 0; i < count && status == QUOIN_OK; i++) {
      const qn_sheaf *s = q->work->sheaf;
      status = give(q, at + used + i, b->text + 6 * (used + i), sure >> i & 1, s->first[i + 1] - s->first[i], s->found ? s->found + s->first[i] : NULL);
    }
  }
  return status;
}

/* Keeps the answers of a packet of rays which[at] on. */
static quoin_status keep(quoin_work *work, size_t at, size_t n, uint64_t sure) {
  qn_text_rays *b = work->text_rays;
  const qn_sheaf *s = work->sheaf;
  if (!qn_grow(work->mem, &b->found, &b->found_capacity, b->found_count + s->found_count)) {
    return QUOIN_E_MEMORY;
  }
  for (size_t i = 0; i < n; i++) {
    const size_t count = sure >> i & 1 ? s->first[i + 1] - s->first[i] : 0;
    b->kept[b->which[at + i]] = (kept){b->found_count, (uint32_t)count, sure >> i & 1};
    if (count) {
      memcpy(b->found + b->found_count, s->found + s->first[i], count * sizeof *b->found);
    }
    b->found_count += count;
  }
  return QUOIN_OK;
}

/* The same, sorted first; they have one direction. */
static quoin_status answer_sorted(const question *q, size_t n, size_t at) {
  qn_text_rays *b = q->work->text_rays;
  for (size_t i = 0; i < n; i++) {
    b->which[i] = (uint16_t)i;
  }
  qn_sort_across(b->rays, n, b->which, &b->room);
  quoin_status status = QUOIN_OK;
  b->found_count = 0;
  for (size_t used = 0, alone = 0, count; used < n && status == QUOIN_OK; used += count) {
    quoin_ray rays[TOGETHER];
    double low[TOGETHER][6];
    const size_t most = n - used < TOGETHER ? n - used : TOGETHER;
    for (size_t i = 0; i < most; i++) {
      const size_t from = b->which[used + i];
      rays[i] = b->rays[from];
      memcpy(low[i], b->low[from], sizeof low[i]);
    }
    count = qn_rays_share(q->scene, most, rays, &alone);
    uint64_t sure = 0;
    const sorted_lines lines = {b, used};
    status = qn_sheaf_rays(q->work, count, rays, low, used != 0, line_of_sorted, &lines, &sure);
    status = status == QUOIN_OK ? keep(q->work, used, count, sure) : status;
  }
  for (size_t i = 0; i < n && status == QUOIN_OK; i++) {
    const kept *k = &b->kept[i];
    status = give(q, at + i, b->text + 6 * i, k->sure, k->count, b->found ? b->found + k->first : NULL);
  }
  return status;
}

/* Whether n rays go one way, by their rests too, and the first ones are not neighbours already. */
static int want_sorting(const quoin_scene *scene, size_t n, const qn_text_rays *b) {
  size_t alone = 0;
  if (n < FEWEST || qn_rays_share(scene, n, b->rays, &alone) > 1) {
    return 0;
  }
  for (size_t i = 1; i < n; i++) {
    if (!qn_same_way(&b->rays[i], &b->rays[0]) || b->low[i][3] != b->low[0][3] || b->low[i][4] != b->low[0][4] || b->low[i][5] != b->low[0][5]) {
      return 0;
    }
  }
  return 1;
}

quoin_status quoin_ray_intervals_many_text(const quoin_scene *scene, quoin_work *work, size_t n, const char *const *rays, const char *from, const char *to,
                                           unsigned want, int (*each)(void *user, size_t i, const quoin_intervals *answer), void *user) {
  if (!scene || !work || work->scene != scene || !each || (n != 0 && !rays) || want > (QUOIN_WANT_BOUNDARY | QUOIN_WANT_CONTACTS)) {
    return QUOIN_E_ARGUMENT;
  }
  if (!work->text_rays && !(work->text_rays = qn_alloc_zeroed(work->mem, sizeof *work->text_rays))) {
    return QUOIN_E_MEMORY;
  }
  double begin, end;
  const int doubles = end_of_range(from, -HUGE_VAL, &begin) & end_of_range(to, HUGE_VAL, &end) & ((want & QUOIN_WANT_CONTACTS) == 0);
  const question q = {scene, work, from, to, want, each, user};
  quoin_status status = QUOIN_OK;
  for (size_t at = 0; at < n && status == QUOIN_OK;) {
    const size_t have = doubles ? read_block(work->text_rays, n - at < BLOCK ? n - at : BLOCK, rays + 6 * at, begin, end) : 0;
    if (have == 0) {
      status = give(&q, at, rays + 6 * at, 0, 0, NULL);
      at++;
    } else {
      status = (want_sorting(scene, have, work->text_rays) ? answer_sorted : answer_in_order)(&q, have, at);
      at += have;
    }
  }
  return status;
}
