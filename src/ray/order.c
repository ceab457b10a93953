/* Putting what a line meets in order: candidates by number, ends by place.

   Ends are first put in the order of their doubles, by radix; what the exact order wants changed then is next to nothing, and a merge sort with exact
   comparisons finds it so in one look at each. */
#include "ray/scratch.h"

#include <string.h>

/* --- candidates ----------------------------------------------------------------------------------------------------- */

/* Many candidates are taken in the order in which leaves lie in memory: reading them in the hierarchy's order would cost more than solving them. */
void qn_order_candidates(qn_scratch *s) {
  enum { BITS = 11, SLOTS = 1 << BITS, MANY = 256 };
  size_t n = s->candidate_count;
  if (n < MANY || !qn_grow(s->mem, &s->sorted, &s->sorted_capacity, n)) {
    return; /* any order will do */
  }
  for (int shift = 0; shift < 32 && s->scene->leaf_count >> shift; shift += BITS) {
    size_t at[SLOTS + 1] = {0};
    for (size_t i = 0; i < n; i++) {
      at[(s->candidates[i] >> shift & (SLOTS - 1)) + 1]++;
    }
    for (int k = 0; k < SLOTS; k++) {
      at[k + 1] += at[k];
    }
    for (size_t i = 0; i < n; i++) {
      s->sorted[at[s->candidates[i] >> shift & (SLOTS - 1)]++] = s->candidates[i];
    }
    uint32_t *other = s->candidates;
    size_t capacity = s->candidate_capacity;
    s->candidates = s->sorted, s->candidate_capacity = s->sorted_capacity;
    s->sorted = other, s->sorted_capacity = capacity;
  }
}

/* --- ends ----------------------------------------------------------------------------------------------------------- */

/* Whether x comes before y in a group (by leaf) or along the line (by place). Rounded places tie by a rule that is not transitive (S2): in this order those that do are neighbours either way along
   the line. */
static int before(qn_scratch *s, const qn_event *x, const qn_event *y, int by_leaf) {
  return by_leaf ? x->leaf < y->leaf : qn_bound_order(s, &x->at, &y->at) < 0;
}

/* Stable: insertion in runs, then merging. */
static void sort(qn_scratch *s, qn_event *events, size_t n, int by_leaf) {
  enum { RUN = 16 };
  for (size_t begin = 0; begin < n; begin += RUN) {
    size_t end = begin + RUN < n ? begin + RUN : n;
    for (size_t i = begin + 1; i < end; i++) {
      qn_event e = events[i];
      size_t j = i;
      for (; j > begin && before(s, &e, &events[j - 1], by_leaf); j--) {
        events[j] = events[j - 1];
      }
      events[j] = e;
    }
  }
  if (n <= RUN) {
    return;
  }
  if (!qn_grow(s->mem, &s->sorting, &s->sorting_capacity, n)) {
    qn_scratch_fail(s, QUOIN_E_MEMORY);
    return;
  }
  for (size_t width = RUN; width < n; width *= 2) {
    for (size_t begin = 0; begin + width < n; begin += 2 * width) {
      size_t middle = begin + width, end = middle + width < n ? middle + width : n, left = middle - begin;
      if (!before(s, &events[middle], &events[middle - 1], by_leaf)) {
        continue; /* in order already */
      }
      memcpy(s->sorting, events + begin, left * sizeof *events);
      size_t i = 0, j = middle, k = begin;
      while (i < left && j < end) {
        events[k++] = before(s, &events[j], &s->sorting[i], by_leaf) ? events[j++] : s->sorting[i++];
      }
      memcpy(events + k, s->sorting + i, (left - i) * sizeof *events);
    }
  }
}

/* As many bits as a float has, in the order of the numbers. */
static uint32_t key_of(double t) {
  float f = (float)t;
  uint32_t u;
  memcpy(&u, &f, sizeof u);
  return u ^ (u >> 31 ? UINT32_MAX : 0x80000000u);
}

/* The events in the order of their doubles, nearly. */
static void nearly(qn_scratch *s, size_t n) {
  enum { BITS = 8, SLOTS = 1 << BITS, PASSES = 4 };
  if (!qn_grow(s->mem, &s->keys, &s->key_capacity, 2 * n) || !qn_grow(s->mem, &s->sorting, &s->sorting_capacity, n)) {
    return; /* any order will do */
  }
  uint32_t at[PASSES][SLOTS] = {{0}};
  qn_event_key *from = s->keys, *to = s->keys + n;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t key = key_of(s->events[i].at.t);
    from[i] = (qn_event_key){key, i};
    for (int p = 0; p < PASSES; p++) {
      at[p][key >> p * BITS & (SLOTS - 1)]++;
    }
  }
  for (int p = 0; p < PASSES; p++) {
    uint32_t sum = 0;
    for (int k = 0; k < SLOTS; k++) {
      uint32_t mine = at[p][k];
      at[p][k] = sum;
      sum += mine;
    }
    for (size_t i = 0; i < n; i++) {
      to[at[p][from[i].key >> p * BITS & (SLOTS - 1)]++] = from[i];
    }
    qn_event_key *other = from;
    from = to, to = other;
  }
  for (size_t i = 0; i < n; i++) {
    s->sorting[i] = s->events[from[i].event];
  }
  qn_event *other = s->events;
  size_t capacity = s->event_capacity;
  s->events = s->sorting, s->event_capacity = s->sorting_capacity;
  s->sorting = other, s->sorting_capacity = capacity;
}

void qn_order_events(qn_scratch *s) {
  enum { MANY = 96 };
  size_t n = s->event_count;
  if (n >= MANY && n < UINT32_MAX) {
    nearly(s, n);
  }
  sort(s, s->events, n, 0);
}

void qn_order_places(qn_scratch *s, qn_event *events, size_t n) {
  sort(s, events, n, 0);
}

void qn_order_group(qn_scratch *s, qn_event *events, size_t n) {
  sort(s, events, n, 1);
}
