/* A packet's stretches merged, lane by lane.

   What the weave does (ray/weave.c), with ends from wide code: sorted by their doubles, which is their true order where neighbours are
   apart by more than the lane's tolerance. Nearer neighbours are at one place when they are the same root of the same surface; otherwise the
   lane is given up. Ends at one place are one event: changes are made in the order of the leaves, the last to change the solid's value is named.
   A stretch that runs in a surface is never certified by wide code, so a lane that is answered has none (S7). */
#include "query/sheaf.h"

#include "base/bounds.h"
#include "query/look.h"

#include <limits.h>
#include <math.h>
#include <string.h>

typedef qn_sheaf_event event;
enum { FEW_SLOTS = QN_SHEAF_FEW, RUN = 48, SLOTS_AT_FIRST = 30, MOST_SLOTS = 1 << 12 };
#define SAME_PLACE (QN_SPAN_LARGER | 0xffffffffu)

/* --- room ------------------------------------------------------------------------------------------------------------ */

static size_t ends_size(const qn_packet_spans *s) { return (size_t)s->capacity * QN_LANES * 4 * sizeof *s->ends; }
static size_t slots_size(const qn_packet_spans *s) { return (size_t)s->capacity * QN_LANES / 2 * sizeof *s->slots; }
static size_t rows_size(const qn_packet_spans *s) { return (2 * (size_t)s->capacity + 2) * QN_LANES * sizeof *s->row_t; }

static void free_slots(quoin_work *work) {
  qn_packet_spans *s = &work->sheaf->spans;
  qn_free_line(work->mem, s->ends, ends_size(s));
  qn_free(work->mem, s->slots, slots_size(s));
  qn_free_line(work->mem, s->row_t, rows_size(s));
  qn_free_line(work->mem, s->row_name, rows_size(s));
  qn_free(work->mem, s->pending, rows_size(s) / QN_LANES);
  s->pending = NULL;
  s->ends = s->row_t = s->row_name = NULL, s->slots = NULL, s->capacity = 0;
}

static int room_for_slots(quoin_work *work, uint32_t capacity) {
  qn_packet_spans *s = &work->sheaf->spans;
  free_slots(work);
  s->capacity = capacity;
  s->ends = qn_alloc_line(work->mem, ends_size(s));
  s->slots = qn_alloc(work->mem, slots_size(s));
  s->row_t = qn_alloc_line(work->mem, rows_size(s));
  s->row_name = qn_alloc_line(work->mem, rows_size(s));
  s->pending = qn_alloc(work->mem, rows_size(s) / QN_LANES);
  if (!s->ends || !s->slots || !s->row_t || !s->row_name || !s->pending) {
    free_slots(work);
    return 0;
  }
  memset(s->row_name, 0, rows_size(s)); /* compilers read the names of lanes without a row j before they ask whether there is one: valgrind tells of it */
  return 1;
}

static int make(quoin_work *work) {
  if (work->sheaf) {
    return work->sheaf->spans.capacity > 0 || room_for_slots(work, SLOTS_AT_FIRST);
  }
  const qn_program *program = &work->scene->program;
  work->sheaf = qn_alloc_line(work->mem, sizeof *work->sheaf);
  if (!work->sheaf) {
    return 0;
  }
  memset(work->sheaf, 0, sizeof *work->sheaf);
  for (size_t i = 0; i < sizeof work->sheaf->roles / sizeof *work->sheaf->roles; i++) {
    work->sheaf->roles[i].name = QN_SPAN_CUT;
  }
  for (size_t i = 0; i < sizeof work->sheaf->flats / sizeof *work->sheaf->flats; i++) {
    work->sheaf->flats[i].surface = QUOIN_NO_SURFACE;
  }
  work->sheaf->spans.flats = work->sheaf->flats;
  work->sheaf->count = qn_alloc(work->mem, program->gate_count * sizeof *work->sheaf->count);
  work->sheaf->deep = program->paths ? qn_scratch_eval(work->scratch) : NULL;
  work->sheaf->spans.plans = work->sheaf->deep ? NULL : work->sheaf->plans, work->sheaf->spans.gate_count = work->sheaf->count;
  if (!work->sheaf->count || !room_for_slots(work, SLOTS_AT_FIRST)) {
    qn_sheaf_free(work);
    return 0;
  }
  for (size_t i = 0; i < program->gate_count; i++) {
    work->sheaf->count[i] = program->gates[i].base;
  }
  return 1;
}

void qn_sheaf_free(quoin_work *work) {
  qn_sheaf *s = work->sheaf;
  if (!s) {
    return;
  }
  free_slots(work);
  qn_free(work->mem, s->count, work->scene->program.gate_count * sizeof *s->count);
  qn_free(work->mem, s->events, s->event_capacity * sizeof *s->events);
  qn_free(work->mem, s->sorting, s->sorting_capacity * sizeof *s->sorting);
  qn_free(work->mem, s->found, s->found_capacity * sizeof *s->found);
  qn_free(work->mem, s->boundary, s->boundary_capacity * sizeof *s->boundary);
  qn_free(work->mem, s->found_of, s->run_capacity * sizeof *s->found_of);
  qn_free(work->mem, s->boundary_of, s->boundary_run_capacity * sizeof *s->boundary_of);
  qn_free_line(work->mem, s, sizeof *s);
  work->sheaf = NULL;
}

/* --- a lane's ends in order -------------------------------------------------------------------------------------------- */

QN_INLINE size_t insert(event *e, size_t n, double t, uint64_t name) {
  size_t j = n;
  for (; j > 0 && e[j - 1].t > t; j--) {
    e[j] = e[j - 1];
  }
  e[j] = (event){t, name};
  return n + 1;
}

static void merge_runs(event *e, event *spare, size_t n, size_t width) {
  for (; width < n; width *= 2) {
    for (size_t begin = 0; begin + width < n; begin += 2 * width) {
      size_t middle = begin + width, end = middle + width < n ? middle + width : n, left = middle - begin;
      memcpy(spare, e + begin, left * sizeof *e);
      size_t i = 0, j = middle, k = begin;
      while (i < left && j < end) {
        e[k++] = e[j].t < spare[i].t ? e[j++] : spare[i++];
      }
      memcpy(e + k, spare + i, (left - i) * sizeof *e);
    }
  }
}

QN_INLINE uint64_t name_at(const double *payload, uint32_t slot, uint64_t enters) {
  uint64_t v;
  memcpy(&v, payload, 8);
  return (v & SAME_PLACE) | (uint64_t)slot << 32 | enters;
}

/* Slots by where their stretches begin in the first of their lanes: nearly the order of all lanes of the group. */
static void order_slots(qn_sheaf *s, unsigned width, unsigned g) {
  const qn_span_slot *slot = s->spans.slots + (size_t)g * s->spans.capacity;
  const double *ends = s->spans.ends + (size_t)g * s->spans.capacity * 4 * width;
  double key[FEW_SLOTS];
  for (uint32_t k = 0; k < s->spans.count[g]; k++, ends += 4 * (size_t)width) {
    double t = ends[qn_trailing_zeros(slot[k].hit)];
    uint32_t j = k;
    for (; j > 0 && key[j - 1] > t; j--) {
      key[j] = key[j - 1], s->order[j] = s->order[j - 1];
    }
    key[j] = t, s->order[j] = (uint8_t)k;
  }
}

/* A stretch that lies well within the one before it, of a leaf that settles the gate of both, is left out: nothing changes there. */
static size_t gather_few(qn_sheaf *s, unsigned width, unsigned lane) {
  const unsigned g = lane / width, i = lane % width;
  const qn_span_slot *slot = s->spans.slots + (size_t)g * s->spans.capacity;
  const double *ends = s->spans.ends + (size_t)g * s->spans.capacity * 4 * width + i, tolerance = s->spans.tolerance[lane];
  const uint32_t slots = s->spans.count[g];
  event begins[FEW_SLOTS]; /* of stretches; name: the slot */
  size_t count = 0, n = 0;
  for (uint32_t j = 0; j < slots; j++) {
    const uint32_t k = s->order[j];
    if (slot[k].hit >> i & 1) {
      count = insert(begins, count, ends[4 * (size_t)width * k], k);
    }
  }
  double a = 0, b = -HUGE_VAL;
  uint32_t gate = QN_NO_GATE;
  for (size_t j = 0; j < count; j++) {
    const uint32_t k = (uint32_t)begins[j].name;
    const double *at = ends + 4 * (size_t)width * k, enter = begins[j].t, leave = at[width];
    if ((slot[k].gate == gate) & (enter - a > tolerance) & (b - leave > tolerance)) {
      continue;
    }
    n = insert(s->events, n, enter, name_at(at + 2 * width, k, QN_SHEAF_ENTERS));
    n = insert(s->events, n, leave, name_at(at + 3 * width, k, 0));
    if (slot[k].settles && !(slot[k].gate == gate && leave < b)) {
      gate = slot[k].gate, a = enter, b = leave;
    }
  }
  return n;
}

/* The lane's ends into s->events, sorted; how many. */
static size_t gather(qn_sheaf *s, unsigned width, unsigned lane) {
  const unsigned g = lane / width, i = lane % width;
  const uint32_t slots = s->spans.count[g];
  if (slots <= FEW_SLOTS) {
    if (s->ordered != g) {
      order_slots(s, width, g);
      s->ordered = g;
    }
    return gather_few(s, width, lane);
  }
  const qn_span_slot *slot = s->spans.slots + (size_t)g * s->spans.capacity;
  const double *ends = s->spans.ends + (size_t)g * s->spans.capacity * 4 * width + i;
  event *e = s->events;
  size_t n = 0, run = 0;
  for (uint32_t k = 0; k < slots; k++, ends += 4 * (size_t)width) {
    if (!(slot[k].hit >> i & 1)) {
      continue;
    }
    n = run + insert(e + run, n - run, ends[0], name_at(ends + 2 * width, k, QN_SHEAF_ENTERS));
    n = run + insert(e + run, n - run, ends[width], name_at(ends + 3 * width, k, 0));
    run = n - run >= RUN ? n : run;
  }
  if (run) {
    merge_runs(e, s->sorting, n, RUN);
  }
  return n;
}

/* --- the weave of a lane ------------------------------------------------------------------------------------------------ */

/* A lane on its way through its ends. */
typedef struct lane_walk {
  const quoin_scene *scene;
  qn_sheaf *sheaf;
  const qn_span_slot *slots; /* of its group */
  double from, to, tolerance;
  unsigned lane;
  int sure;
  double open_t; uint64_t open;
} lane_walk;

QN_INLINE const qn_span_slot *slot_of(const lane_walk *w, uint64_t name) { return &w->slots[name >> 32 & QN_SPAN_LEAF]; }

/* A leaf is entered or left: whether the solid's value changes. */
QN_INLINE int change(const lane_walk *w, uint64_t name) {
  const qn_span_slot *slot = slot_of(w, name);
  const int up = (name >> 63 != 0) != slot->negated;
  if (QN_UNLIKELY(w->sheaf->deep != NULL)) {
    int was = w->sheaf->deep->value;
    return qn_eval_change(w->sheaf->deep, slot->gate, up ? 1 : -1) != was;
  }
  const qn_gate *gates = w->scene->program.gates;
  uint32_t *count = w->sheaf->count;
  for (uint32_t g = slot->gate;; g = gates[g].parent) {
    uint32_t before = count[g], after = up ? before + 1 : before - 1;
    count[g] = after;
    if ((before >= gates[g].need) == (after >= gates[g].need)) {
      return 0;
    }
    if (gates[g].parent == QN_NO_GATE) {
      return 1;
    }
  }
}

/* The ends e[0] to e[n - 1] lie at one place: put into the order of the leaves, and made. Returns whether the value is another afterwards; *last is then
   the end that is named. */
static int change_group(const lane_walk *w, event *e, size_t n, uint64_t *last) {
  int flips = 0;
  for (size_t i = 1; i < n; i++) {
    event x = e[i];
    size_t j = i;
    for (; j > 0 && slot_of(w, e[j - 1].name)->leaf > slot_of(w, x.name)->leaf; j--) {
      e[j] = e[j - 1];
    }
    e[j] = x;
  }
  for (size_t i = 0; i < n; i++) {
    if (change(w, e[i].name)) {
      flips++;
      *last = e[i].name;
    }
  }
  return flips & 1;
}

/* Whether a place is where the packet's findings mean something, when some leaf was solved in the solid's box only. */
static int in_box(const qn_sheaf *s, const quoin_scene *scene, unsigned lane, double t) {
  for (int i = 0; i < 3; i++) {
    double step = t * s->packet.d[i][lane], x = s->packet.o[i][lane] + step;
    double slack = (fabs(step) + fabs(x)) * QN_WIDE_SPOT + s->spans.tolerance[lane] * fabs(s->packet.d[i][lane]);
    if (!(x >= scene->min[i] - slack && x <= scene->max[i] + slack)) {
      return 0;
    }
  }
  return 1;
}

static uint64_t payload_of(const lane_walk *w, uint64_t name) {
  return name == QN_SPAN_CUT ? name : (name & SAME_PLACE) | (uint64_t)slot_of(w, name)->leaf << 32;
}

/* The value changes back: a stretch from what is open to t, cut to the range. There is room for it: a stretch for every second end, and one more. */
QN_INLINE void add(lane_walk *w, double t, uint64_t name) {
  qn_sheaf *s = w->sheaf;
  double a = w->open_t, b = t;
  uint64_t pa = w->open, pb = name;
  w->sure &= (fabs(a - w->from) > w->tolerance || pa == QN_SPAN_CUT) & (fabs(b - w->to) > w->tolerance || pb == QN_SPAN_CUT) &
             (fabs(b - w->from) > w->tolerance) & (fabs(a - w->to) > w->tolerance);
  if (b <= w->from || a >= w->to) {
    return;
  }
  if (a < w->from) {
    a = w->from, pa = QN_SPAN_CUT;
  }
  if (b > w->to) {
    b = w->to, pb = QN_SPAN_CUT;
  }
  w->sure &= fabs(a) <= s->spans.reach && fabs(b) <= s->spans.reach;
  const size_t at = (size_t)s->spans.row_count[w->lane] * QN_LANES + w->lane;
  const uint64_t na = payload_of(w, pa), nb = payload_of(w, pb);
  s->spans.row_t[at] = a, s->spans.row_t[at + QN_LANES] = b;
  memcpy(&s->spans.row_name[at], &na, sizeof na), memcpy(&s->spans.row_name[at + QN_LANES], &nb, sizeof nb);
  s->spans.row_count[w->lane] += 2;
}

/* Whether the sorted ends' order is certain; ends at one place come in a row. */
QN_INLINE int in_order(const event *e, size_t n, double tolerance) {
  for (size_t i = 1; i < n; i++) {
    if (QN_UNLIKELY(!(e[i].t - e[i - 1].t > tolerance)) && ((e[i].name ^ e[i - 1].name) & SAME_PLACE) && !(e[i].t == e[i - 1].t && fabs(e[i].t) == QN_SPAN_FAR)) {
      return 0;
    }
  }
  return 1;
}

/* 0: the lane is not for doubles. Its stretches become rows. */
static int weave(quoin_work *work, unsigned lane) {
  qn_sheaf *s = work->sheaf;
  const quoin_scene *scene = work->scene;
  const size_t n = gather(s, work->wide->width, lane);
  event *e = s->events;
  s->spans.row_count[lane] = 0;
  lane_walk w = {scene, s, s->spans.slots + (size_t)(lane / work->wide->width) * s->spans.capacity, s->packet.from[lane], s->packet.to[lane], s->spans.tolerance[lane], lane, 1, -HUGE_VAL, QN_SPAN_CUT};
  if (!in_order(e, n, w.tolerance)) {
    return 0;
  }
  int value = scene->program.base;
  size_t i = 0;
  for (; i < n && e[i].t == -QN_SPAN_FAR; i++) {
    value ^= change(&w, e[i].name);
  }
  for (size_t end; i < n && e[i].t != QN_SPAN_FAR; i = end) {
    uint64_t name = e[i].name;
    double t = e[i].t;
    end = i + 1;
    int other;
    if (QN_UNLIKELY(end < n && !(e[end].t - t > w.tolerance))) {
      while (end < n && !(e[end].t - e[end - 1].t > w.tolerance)) {
        end++;
      }
      other = change_group(&w, e + i, end - i, &name);
    } else {
      other = change(&w, name);
    }
    if (other) {
      if (value) {
        add(&w, t, name);
      } else {
        w.open_t = t, w.open = name;
      }
      value = !value;
    }
  }
  if (value) {
    add(&w, HUGE_VAL, QN_SPAN_CUT);
  }
  for (; i < n; i++) { /* back to rest */
    change(&w, e[i].name);
  }
  return w.sure;
}

/* --- parameters, correctly rounded, and answers ----------------------------------------------------------------------------- */

/* How the lines of a packet are had when not from its doubles. */
typedef struct bundle {
  qn_sheaf_line line;
  const void *user;
} bundle;

static quoin_status round_alone(quoin_work *work, const bundle *b, unsigned lane, double e, uint64_t name, double *t) {
  qn_query_begin(work);
  qn_line line;
  quoin_status status = QUOIN_OK;
  if (b->line) {
    status = b->line(work, b->user, lane, &line);
  } else {
    const qn_packet *p = &work->sheaf->packet;
    const double o[3] = {p->o[0][lane], p->o[1][lane], p->o[2][lane]}, d[3] = {p->d[0][lane], p->d[1][lane], p->d[2][lane]};
    qn_line_from_doubles(o, d, &line);
  }
  if (status != QUOIN_OK) {
    return status;
  }
  const qn_place place = {.t = *t, .e = e, .surface = (uint32_t)name, .which = (name & QN_SPAN_LARGER) != 0};
  *t = qn_place_round(work->scene, work->scratch, &line, &place);
  return qn_scratch_ctx(work->scratch)->failed;
}

/* What wide code leaves. */
static quoin_status round_rest(quoin_work *work, const bundle *b) {
  const qn_packet_spans *s = &work->sheaf->spans;
  quoin_status status = QUOIN_OK;
  for (uint32_t j = 0; j < s->rows; j++) {
    for (uint64_t m = s->pending[j]; m && status == QUOIN_OK; m &= m - 1) {
      const unsigned lane = qn_trailing_zeros(m);
      const size_t at = (size_t)j * QN_LANES + lane;
      uint64_t name;
      memcpy(&name, &s->row_name[at], sizeof name);
      status = round_alone(work, b, lane, s->tolerance[lane] / 2, name, &s->row_t[at]);
    }
  }
  return status;
}

/* --- the packet ------------------------------------------------------------------------------------------------------------ */

static quoin_status solve(quoin_work *work) {
  qn_sheaf *s = work->sheaf;
  qn_counts *counts = qn_scratch_counts(work->scratch);
  for (;;) {
    qn_wide_counts wide = {0};
    (s->packet.few ? work->wide->spans_few : work->wide->spans)(work->scene, &s->packet, &s->spans, &wide);
    counts->nodes += wide.nodes, counts->leaves += wide.leaves, counts->packets++;
    if (!s->spans.full) {
      return QUOIN_OK;
    }
    if (s->spans.capacity >= MOST_SLOTS) { /* so many that woven rays are no worse */
      s->spans.unsure = s->packet.live;
      return QUOIN_OK;
    }
    if (!room_for_slots(work, 4 * s->spans.capacity)) {
      return QUOIN_E_MEMORY;
    }
  }
}

/* Whether the solid may hold any of a group's lanes: the program only rises with its literals, so where it is false with all leaves that any lane meets entered, and none
   left that is taken away, no order of ends makes it true. */
static int may_hold(quoin_work *work, unsigned g) {
  const qn_sheaf *s = work->sheaf;
  const lane_walk w = {.scene = work->scene, .sheaf = work->sheaf, .slots = s->spans.slots + (size_t)g * s->spans.capacity};
  int value = work->scene->program.base;
  for (int pass = 0; pass < 2; pass++) { /* and back to rest */
    for (uint32_t k = 0; k < s->spans.count[g]; k++) {
      if (!w.slots[k].negated) {
        const int other = change(&w, (uint64_t)k << 32 | (pass ? 0 : QN_SHEAF_ENTERS));
        value ^= pass ? 0 : other;
      }
    }
  }
  return value;
}

static int in_boxes(const quoin_work *work, unsigned lane) {
  const qn_packet_spans *s = &work->sheaf->spans;
  int in = 1;
  for (uint32_t j = 0; in && j < s->row_count[lane]; j++) {
    in = in_box(work->sheaf, work->scene, lane, s->row_t[(size_t)j * QN_LANES + lane]);
  }
  return in;
}

/* The packet's rows, rounded; of the lanes in *sure. */
static quoin_status make_rows(quoin_work *work, const bundle *b, uint64_t *sure) {
  qn_sheaf *s = work->sheaf;
  const uint64_t live = s->packet.live;
  quoin_status status = solve(work);
  if (status != QUOIN_OK) {
    return status;
  }
  const int simple = work->scene->program.gate_count == 1;
  uint64_t lanes = s->spans.merged, rest = live & ~(s->spans.merged | s->spans.unsure);
  if (QN_UNLIKELY(rest)) {
    uint32_t most = 0;
    for (unsigned g = 0; g < QN_LANES / work->wide->width; g++) {
      most = s->spans.count[g] > most ? s->spans.count[g] : most;
    }
    if (!qn_grow(work->mem, &s->events, &s->event_capacity, 2 * (size_t)most) || !qn_grow(work->mem, &s->sorting, &s->sorting_capacity, 2 * (size_t)most)) {
      return QUOIN_E_MEMORY;
    }
    s->ordered = UINT32_MAX;
    unsigned asked = UINT_MAX, holds = 1;
    for (; rest; rest &= rest - 1) {
      const unsigned lane = qn_trailing_zeros(rest), g = lane / work->wide->width;
      if (g != asked && !simple) {
        asked = g, holds = (unsigned)may_hold(work, g);
      }
      if (!holds || !(s->packet.from[lane] < s->packet.to[lane])) {
        s->spans.row_count[lane] = 0;
        lanes |= (uint64_t)1 << lane;
      } else {
        lanes |= (uint64_t)weave(work, lane) << lane;
      }
    }
  }
  for (uint64_t m = s->spans.limited ? lanes : 0; m; m &= m - 1) {
    const unsigned lane = qn_trailing_zeros(m);
    lanes &= ~((uint64_t)!in_boxes(work, lane) << lane);
  }
  *sure = lanes;
  for (uint64_t m = ~lanes; m; m &= m - 1) {
    s->spans.row_count[qn_trailing_zeros(m)] = 0;
  }
  qn_counts *counts = qn_scratch_counts(work->scratch);
  const uint64_t answered = qn_bits_set(lanes);
  counts->rays += answered;
  counts->exact_rays += qn_bits_set(live) - answered;
  work->wide->round_rows(work->scene, &s->packet, &s->spans, &counts->exact_forms);
  return s->spans.rows ? round_rest(work, b) : QUOIN_OK;
}

/* All rows into found, after the `before` stretches that are there. */
static quoin_status write_rows(quoin_work *work, size_t before) {
  qn_sheaf *s = work->sheaf;
  size_t count = before;
  for (unsigned lane = 0; lane < QN_LANES; lane++) {
    s->first[lane] = (uint32_t)count;
    count += s->spans.row_count[lane] / 2;
  }
  s->first[QN_LANES] = (uint32_t)count;
  if (count > UINT32_MAX || !qn_grow(work->mem, &s->found, &s->found_capacity, count)) {
    return QUOIN_E_MEMORY;
  }
  s->found_count = count;
  if (count > before) {
    work->wide->write_rows(work->scene, &s->spans, s->roles, s->first, s->found);
  }
  return QUOIN_OK;
}

quoin_status qn_sheaf_rays(quoin_work *work, size_t n, const quoin_ray *rays, double (*low)[6], int kept, qn_sheaf_line line, const void *user, uint64_t *sure) {
  *sure = 0;
  if (!make(work)) {
    return QUOIN_E_MEMORY;
  }
  qn_sheaf *s = work->sheaf;
  const size_t lanes = n <= QN_FEW ? QN_FEW : QN_LANES;
  if (kept) {
    qn_packet_move(&s->packet, lanes, n, rays, low);
  } else {
    qn_packet_fill(&s->packet, lanes, n, rays, low);
  }
  quoin_status status = make_rows(work, &(bundle){line, user}, sure);
  return status == QUOIN_OK ? write_rows(work, 0) : status;
}

qn_packet *qn_sheaf_packet(quoin_work *work) { return make(work) ? &work->sheaf->packet : NULL; }

quoin_status qn_sheaf_tile(quoin_work *work, uint64_t *sure) {
  quoin_status status = make_rows(work, &(bundle){NULL, NULL}, sure);
  return status == QUOIN_OK && work->sheaf->spans.rows ? write_rows(work, work->sheaf->found_count) : status;
}
