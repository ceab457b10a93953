/* Design S9: answers do not depend on the order of operands, the number of threads, the instruction set, the way rays are batched, the
   path that answers (packets or woven), the direction in which a ray is walked, or on where it is split. Byte for byte, parts too. */
#include "laws.h"

#include <pthread.h>

static void whole_model(trial *t) {
  clear_text(&t->first);
  tree_put(&t->first, t->tree, NULL);
}

/* A first hit as the intervals have it. */
static void hit_of(const said *s, quoin_hit *h) {
  *h = (quoin_hit){0};
  if (s->status == QUOIN_OK && s->n) {
    int leaving = s->end[0].part == QUOIN_NO_PART;
    const quoin_end *e = &s->end[leaving];
    if (e->part != QUOIN_NO_PART) {
      h->found = 1, h->leaving = leaving, h->t = e->t, h->part = e->part, h->role = e->role;
    }
  }
}
static void same_hit(trial *t, const quoin_hit *a, const quoin_hit *b, const char *what, const quoin_ray *r) {
  t->checks++;
  if (a->found != b->found || (a->found && (a->leaving != b->leaving || memcmp(&a->t, &b->t, sizeof a->t) != 0 || a->part != b->part || a->role != b->role))) {
    blame(t, "%s: ray %.17g %.17g %.17g  %.17g %.17g %.17g  from %.17g to %.17g\n//  found %d leaving %d t %.17g part %d role %d\n//  found %d leaving %d t %.17g part %d role %d", what, r->o[0], r->o[1],
          r->o[2], r->d[0], r->d[1], r->d[2], r->from, r->to, a->found, a->leaving, a->t, (int)a->part, (int)a->role, b->found, b->leaving, b->t, (int)b->part, (int)b->role);
  }
}

static int keep_each(void *user, size_t i, const quoin_intervals *got) {
  keep(&((said *)user)[i], QUOIN_OK, got);
  return 0;
}
static said *many(trial *t, const scene *s, size_t n, const quoin_ray *rays, unsigned want) {
  said *out = calloc(n, sizeof *out);
  if (!out) {
    exit(2);
  }
  quoin_status status = quoin_ray_intervals_many(s->scene, s->work, n, rays, want, keep_each, out);
  if (status != QUOIN_OK) {
    blame(t, "many rays: %s", quoin_status_text(status));
  }
  t->asked += n;
  return out;
}

/* First boundaries in short, whether rays are blocked, many rays as decimals: as the intervals say. */
static void other_calls(trial *t) {
  scene s;
  whole_model(t);
  if (!scene_open(t, t->first.at, 1, &s)) {
    return;
  }
  quoin_spot spots[RAYS], near[RAYS];
  uint8_t blocked[RAYS];
  quoin_status status = quoin_first_spots(s.scene, s.work, t->n, t->rays, QUOIN_WANT_T, spots);
  if (status == QUOIN_OK) {
    status = quoin_first_spots(s.scene, s.work, t->n, t->rays, 0, near);
  }
  if (status == QUOIN_OK) {
    status = quoin_rays_blocked(s.scene, s.work, t->n, t->rays, NULL, blocked);
  }
  if (status != QUOIN_OK) {
    blame(t, "spots: %s", quoin_status_text(status));
  }
  t->asked += 4 * t->n;
  for (size_t i = 0; i < t->n && !t->wrong; i++) {
    const quoin_ray *r = &t->rays[i];
    said all;
    quoin_hit want;
    ask_one(&s, r, &all);
    hit_of(&all, &want);
    t->checks += 3;
    char what[200];
    snprintf(what, sizeof what, "ray %.17g %.17g %.17g  %.17g %.17g %.17g  from %g to %g", r->o[0], r->o[1], r->o[2], r->d[0], r->d[1], r->d[2], r->from, r->to);
    if ((spots[i].surface != QUOIN_NO_SURFACE) != want.found || (want.found && ((int)spots[i].leaving != want.leaving || memcmp(&spots[i].t, &want.t, sizeof want.t) != 0))) {
      blame(t, "spot: t %.17g leaving %d, interval: found %d t %.17g leaving %d: %s", spots[i].t, (int)spots[i].leaving, want.found, want.t, want.leaving, what);
    }
    if (near[i].surface != spots[i].surface || (want.found && near[i].leaving != spots[i].leaving)) {
      blame(t, "spots with and without t: surfaces %u, %u: %s", spots[i].surface, near[i].surface, what);
    }
    if ((blocked[i] != 0) != (all.n != 0)) {
      blame(t, "blocked %d, but %zu intervals: %s", (int)blocked[i], all.n, what);
    }
  }
  scene_close(&s);
}

/* Alone through decimals (always woven), alone, 1, 8 and 64 at a time; first hits likewise. */
static void batching(trial *t) {
  scene s;
  whole_model(t);
  if (!scene_open(t, t->first.at, 1, &s)) {
    return;
  }
  static const size_t sizes[] = {1, 3, 8, 17, 64};
  said *alone = calloc(t->n, sizeof *alone);
  if (!alone) {
    exit(2);
  }
  for (size_t i = 0; i < t->n && !t->wrong; i++) {
    said woven;
    ask_one(&s, &t->rays[i], &alone[i]);
    ask_decimals(&s, &t->rays[i], "1", NULL, &woven);
    alike(t, &woven, &alone[i], SAME_PARTS, "as decimals against as doubles", &t->rays[i]);
    quoin_hit want, got;
    hit_of(&alone[i], &want);
    got = want;
    quoin_status status = quoin_first_hit(s.scene, s.work, &t->rays[i], &got);
    if (status != QUOIN_OK) {
      blame(t, "first hit: %s", quoin_status_text(status));
    }
    same_hit(t, &want, &got, "intervals against first hit", &t->rays[i]);
  }
  t->asked += 3 * t->n;
  for (int want = 0; want < 2; want++) {
    for (size_t k = 0; k < 5 && !t->wrong; k++) {
      for (size_t at = 0; at < t->n && !t->wrong; at += sizes[k]) {
        size_t n = t->n - at < sizes[k] ? t->n - at : sizes[k];
        said *batch = many(t, &s, n, t->rays + at, want ? QUOIN_WANT_BOUNDARY : 0);
        quoin_hit hits[RAYS];
        quoin_status status = quoin_first_hits(s.scene, s.work, n, t->rays + at, hits);
        if (status != QUOIN_OK) {
          blame(t, "first hits: %s", quoin_status_text(status));
        }
        t->asked += n;
        for (size_t i = 0; i < n && !t->wrong; i++) {
          said one = alone[at + i];
          if (!want) {
            one.boundary = 0;
          }
          quoin_hit hit;
          hit_of(&one, &hit);
          char what[80];
          snprintf(what, sizeof what, "alone against %zu at a time, want %d", sizes[k], want);
          alike(t, &one, &batch[i], SAME_PARTS, what, &t->rays[at + i]);
          same_hit(t, &hit, &hits[i], "intervals against first hits", &t->rays[at + i]);
        }
        free(batch);
      }
    }
  }
  free(alone);
  scene_close(&s);
}

static void instruction_sets(trial *t) {
  scene s;
  whole_model(t);
  if (!scene_open(t, t->first.at, 1, &s)) {
    return;
  }
  said *of[ISAS] = {0};
  quoin_hit hits[ISAS][RAYS];
  quoin_side sides[ISAS][RAYS];
  double points[3 * RAYS];
  for (size_t i = 0; i < t->n; i++) {
    for (int k = 0; k < 3; k++) {
      points[3 * i + (size_t)k] = t->rays[i].o[k] + (double)(i % 5) * t->rays[i].d[k];
    }
  }
  for (int k = 0; k < ISAS && !t->wrong; k++) {
    quoin_work *work = NULL, *usual = s.work;
    setenv("QUOIN_ISA", ISA_NAMES[k], 1);
    quoin_status status = quoin_work_new(s.scene, &work);
    unsetenv("QUOIN_ISA");
    if (status == QUOIN_OK) {
      s.work = work;
      of[k] = many(t, &s, t->n, t->rays, t->seed & 1 ? QUOIN_WANT_BOUNDARY : 0);
      status = quoin_first_hits(s.scene, work, t->n, t->rays, hits[k]);
      if (status == QUOIN_OK) {
        status = quoin_point_sides(s.scene, work, t->n, points, sides[k]);
      }
      s.work = usual;
      quoin_work_free(work);
    }
    if (status != QUOIN_OK) {
      blame(t, "%s: %s", ISA_NAMES[k], quoin_status_text(status));
    }
    for (size_t i = 0; k && i < t->n && !t->wrong; i++) {
      alike(t, &of[0][i], &of[k][i], SAME_PARTS, ISA_NAMES[k], &t->rays[i]);
      same_hit(t, &hits[0][i], &hits[k][i], ISA_NAMES[k], &t->rays[i]);
      if (hits[0][i].found && !t->wrong && (memcmp(hits[0][i].normal, hits[k][i].normal, sizeof hits[0][i].normal) != 0 || memcmp(hits[0][i].uv, hits[k][i].uv, sizeof hits[0][i].uv) != 0)) {
        blame(t, "%s: normal or (u, v) of ray %zu", ISA_NAMES[k], i);
      }
      if (sides[0][i] != sides[k][i]) {
        blame(t, "%s: the side of %.17g %.17g %.17g: %d, %d", ISA_NAMES[k], points[3 * i], points[3 * i + 1], points[3 * i + 2], (int)sides[0][i], (int)sides[k][i]);
      }
    }
  }
  for (size_t i = 0; i < t->n && !t->wrong; i++) { /* and points as one by one */
    quoin_side side;
    if (quoin_point_side(s.scene, s.work, points + 3 * i, &side) != QUOIN_OK || side != sides[0][i]) {
      blame(t, "one point against many: %.17g %.17g %.17g", points[3 * i], points[3 * i + 1], points[3 * i + 2]);
    }
    t->checks++;
  }
  for (int k = 0; k < ISAS; k++) {
    free(of[k]);
  }
  scene_close(&s);
}

/* Grids: as rays one by one; columns and rows of any size. */
static void grids(trial *t) {
  scene s;
  whole_model(t);
  if (!scene_open(t, t->first.at, 1, &s)) {
    return;
  }
  dice d = {t->seed};
  const quoin_ray *r = &t->rays[0];
  quoin_grid g = {.converging = roll(&d, 2), .width = (size_t)from_to(&d, 1, 20), .height = (size_t)from_to(&d, 1, 20), .from = r->from, .to = r->to};
  for (int i = 0; i < 3; i++) {
    g.o[i] = r->o[i], g.d[i] = r->d[i], g.u[i] = from_to(&d, -4, 4), g.v[i] = from_to(&d, -4, 4);
  }
  size_t x0 = (size_t)roll(&d, (int)g.width), y0 = (size_t)roll(&d, (int)g.height), x1 = (size_t)from_to(&d, (int)x0, (int)g.width), y1 = (size_t)from_to(&d, (int)y0, (int)g.height);
  quoin_spot spots[400];
  quoin_status status = quoin_grid_hits(s.scene, s.work, &g, x0, y0, x1, y1, QUOIN_WANT_T, spots);
  quoin_grid_answer whole;
  quoin_work *other = NULL; /* whose answer is to hold while the other one is asked */
  if (quoin_work_new(s.scene, &other) != QUOIN_OK || quoin_grid_intervals(s.scene, other, &g, x0, y0, x1, y1, QUOIN_WANT_BOUNDARY, &whole) != status) {
    blame(t, "all intervals of a grid %zu x %zu: another status than its first hits", g.width, g.height);
  }
  int still = 0; /* a grid one of whose directions is zero is refused */
  for (size_t y = y0; y < y1 && !t->wrong; y++) {
    for (size_t x = x0; x < x1 && !t->wrong; x++) {
      double sx = ((double)x + 0.5) / (double)g.width, sy = ((double)y + 0.5) / (double)g.height;
      quoin_ray one = {.from = g.from, .to = g.to};
      for (int i = 0; i < 3; i++) {
        double across = (g.converging ? g.d[i] : g.o[i]) + sx * g.u[i], both = across + sy * g.v[i];
        one.o[i] = g.converging ? g.o[i] : both, one.d[i] = g.converging ? both : g.d[i];
      }
      if (one.d[0] == 0 && one.d[1] == 0 && one.d[2] == 0) {
        still = 1;
        continue;
      }
      if (status != QUOIN_OK) {
        continue;
      }
      said all;
      quoin_hit want;
      ask_one(&s, &one, &all);
      hit_of(&all, &want);
      const quoin_spot *spot = &spots[(y - y0) * (x1 - x0) + (x - x0)];
      const size_t k = (y - y0) * (x1 - x0) + (x - x0);
      const quoin_run in = whole.inside_of[k], on = whole.boundary_of[k];
      said block;
      keep(&block, QUOIN_OK, &(quoin_intervals){.count = in.count, .inside = in.count ? whole.inside + in.first : NULL, .boundary_count = on.count, .boundary = on.count ? whole.boundary + on.first : NULL});
      alike(t, &block, &all, SAME_PARTS, "all intervals of a grid", &one);
      t->checks++, t->asked += 3;
      if ((spot->surface != QUOIN_NO_SURFACE) != want.found || (want.found && ((int)spot->leaving != want.leaving || memcmp(&spot->t, &want.t, sizeof want.t) != 0))) {
        blame(t, "grid %zu x %zu, column %zu, row %zu, converging %d, ray %.17g %.17g %.17g  %.17g %.17g %.17g from %g to %g: t %.17g leaving %d, alone found %d t %.17g leaving %d", g.width, g.height,
              x, y, g.converging, one.o[0], one.o[1], one.o[2], one.d[0], one.d[1], one.d[2], one.from, one.to, spot->t, (int)spot->leaving, want.found, want.t, want.leaving);
      }
    }
  }
  if (status != QUOIN_OK && !still) {
    blame(t, "a grid is refused: %s", quoin_status_text(status));
  }
  quoin_work_free(other);
  scene_close(&s);
}

typedef struct worker { const scene *s; size_t n; const quoin_ray *rays; said *out; quoin_status status; } worker;
static void *work_on(void *user) {
  worker *w = user;
  scene mine = *w->s;
  w->status = quoin_work_new(mine.scene, &mine.work);
  if (w->status == QUOIN_OK) {
    w->status = quoin_ray_intervals_many(mine.scene, mine.work, w->n, w->rays, 0, keep_each, w->out);
    quoin_work_free(mine.work);
  }
  return NULL;
}
/* Four threads on one scene at once, and a scene compiled by four threads. */
static void threads(trial *t) {
  enum { THREADS = 4 };
  scene s, other;
  whole_model(t);
  if (!scene_open(t, t->first.at, 4, &s)) {
    return;
  }
  pthread_t id[THREADS];
  worker w[THREADS];
  int started = 0;
  for (int k = 0; k < THREADS; k++) {
    w[k] = (worker){&s, t->n, t->rays, calloc(t->n, sizeof(said)), QUOIN_OK};
    if (!w[k].out || pthread_create(&id[k], NULL, work_on, &w[k]) != 0) {
      break;
    }
    started++;
  }
  for (int k = 0; k < started; k++) {
    pthread_join(id[k], NULL);
  }
  if (scene_open(t, t->first.at, 1, &other)) {
    said *want = many(t, &other, t->n, t->rays, 0);
    for (int k = 0; k < started; k++) {
      if (w[k].status != QUOIN_OK) {
        blame(t, "a thread: %s", quoin_status_text(w[k].status));
      }
      for (size_t i = 0; i < t->n && !t->wrong; i++) {
        alike(t, &want[i], &w[k].out[i], SAME_PARTS, "one of four threads against one", &t->rays[i]);
      }
    }
    free(want);
    scene_close(&other);
  }
  t->asked += (uint64_t)started * t->n;
  for (int k = 0; k < started; k++) {
    free(w[k].out);
  }
  scene_close(&s);
}

static void operand_order(trial *t) {
  scene a, b;
  dice d = {t->seed};
  whole_model(t);
  clear_text(&t->second);
  tree_put(&t->second, t->tree, &d);
  if (!scene_open(t, t->first.at, 1, &a)) {
    return;
  }
  if (scene_open(t, t->second.at, 1, &b)) {
    for (size_t i = 0; i < t->n && !t->wrong; i++) {
      said x, y;
      ask_one(&a, &t->rays[i], &x);
      ask_one(&b, &t->rays[i], &y);
      alike(t, &x, &y, SAME_T, "operands in another order", &t->rays[i]);
      quoin_side p, q;
      if (quoin_point_side(a.scene, a.work, t->rays[i].o, &p) != QUOIN_OK || quoin_point_side(b.scene, b.work, t->rays[i].o, &q) != QUOIN_OK || p != q) {
        blame(t, "operands in another order: the side of %.17g %.17g %.17g", t->rays[i].o[0], t->rays[i].o[1], t->rays[i].o[2]);
      }
    }
    t->asked += 2 * t->n;
    scene_close(&b);
  }
  scene_close(&a);
}

static void turn_round(said *s) {
  for (int list = 0; list < 2; list++) {
    quoin_end *e = list ? s->side : s->end;
    size_t n = 2 * (list ? s->boundary : s->n);
    for (size_t i = 0; i < n / 2 && n <= ENDS; i++) {
      quoin_end k = e[i];
      e[i] = e[n - 1 - i], e[n - 1 - i] = k;
    }
    for (size_t i = 0; i < n && i < ENDS; i++) {
      e[i].t = 0.0 - e[i].t;
    }
  }
}
static void reversal(trial *t) {
  scene s;
  whole_model(t);
  if (!scene_open(t, t->first.at, 1, &s)) {
    return;
  }
  for (size_t i = 0; i < t->n && !t->wrong; i++) {
    quoin_ray back = t->rays[i];
    for (int k = 0; k < 3; k++) {
      back.d[k] = -back.d[k];
    }
    back.from = -t->rays[i].to, back.to = -t->rays[i].from;
    said x, y;
    ask_one(&s, &t->rays[i], &x);
    ask_one(&s, &back, &y);
    turn_round(&y);
    for (size_t e = 0; e < 2 * x.n && e < ENDS; e++) {
      x.end[e].t += 0.0; /* no -0 */
    }
    alike(t, &x, &y, SAME_T, "reversed", &t->rays[i]);
  }
  t->asked += 2 * t->n;
  scene_close(&s);
}

/* Two stretches that meet at the split are one. */
static size_t joined(const said *a, const said *b, int list, double at, quoin_end *out) {
  const quoin_end *x = list ? a->side : a->end, *y = list ? b->side : b->end;
  size_t n = 2 * (list ? a->boundary : a->n), m = 2 * (list ? b->boundary : b->n), k = 0;
  for (size_t i = 0; i < n; i++) {
    out[k++] = x[i];
  }
  size_t from = 0;
  if (n && m && x[n - 1].t == at && x[n - 1].part == QUOIN_NO_PART && y[0].t == at && y[0].part == QUOIN_NO_PART) {
    k--, from = 1;
  }
  for (size_t i = from; i < m; i++) {
    out[k++] = y[i];
  }
  return k;
}
static void split(trial *t) {
  scene s;
  whole_model(t);
  if (!scene_open(t, t->first.at, 1, &s)) {
    return;
  }
  dice d = {t->seed};
  for (size_t i = 0; i < t->n && !t->wrong; i++) {
    const quoin_ray *r = &t->rays[i];
    said all, a, b, both = {0};
    ask_one(&s, r, &all);
    if (all.n > ENDS / 4 || all.boundary > ENDS / 4) {
      continue;
    }
    double at = all.n && chance(&d, 50) ? all.end[roll(&d, (int)(2 * all.n))].t : 0.25 * from_to(&d, -40, 40); /* an end itself, or anywhere */
    if (!(at > r->from && at < r->to)) {
      continue;
    }
    quoin_ray x = *r, y = *r;
    x.to = at, y.from = at;
    ask_one(&s, &x, &a);
    ask_one(&s, &y, &b);
    both.n = joined(&a, &b, 0, at, both.end) / 2, both.boundary = joined(&a, &b, 1, at, both.side) / 2;
    char what[60];
    snprintf(what, sizeof what, "split at %.17g", at);
    /* An end that rounds to the split may lie on either side of it; a stretch shorter than that is cut in two. Compared where the
       whole is not: every end of the whole is there, and nothing else but ends that are exactly the split. */
    int list_wrong = 0;
    for (int list = 0; list < 2; list++) {
      const quoin_end *p = list ? all.side : all.end, *q = list ? both.side : both.end;
      size_t n = 2 * (list ? all.boundary : all.n), m = 2 * (list ? both.boundary : both.n), j = 0;
      for (size_t k = 0; k < m; k++) {
        if (j < n && memcmp(&p[j].t, &q[k].t, sizeof p[j].t) == 0) {
          j++;
        } else if (q[k].t != at) {
          list_wrong = 1;
        }
      }
      list_wrong |= j != n;
    }
    t->checks++;
    if (list_wrong) {
      alike(t, &all, &both, SAME_T, what, r);
    }
  }
  t->asked += 3 * t->n;
  scene_close(&s);
}

const law SAME_ANSWER_LAWS[] = {{"batching", batching, 1}, {"other calls", other_calls, 1}, {"instruction sets", instruction_sets, 1}, {"grids", grids, 1}, {"threads", threads, 1},
                                {"operand order", operand_order, 1}, {"reversal", reversal, 0}, {"split", split, 0}};
const size_t SAME_ANSWER_COUNT = sizeof SAME_ANSWER_LAWS / sizeof *SAME_ANSWER_LAWS;
