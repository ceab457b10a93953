/* A packet's rows as intervals: a row's end is a parameter and one word, the same in neighbouring lanes more often than not. */
#include "wide/packet.h"
#include "wide/vec.h"

#include <stddef.h>
#include <string.h>

_Static_assert(sizeof(quoin_end) == 16 && offsetof(quoin_end, part) == 8 && sizeof(quoin_interval) == 2 * sizeof(quoin_end), "an end is its parameter and one more word");

QN_INLINE double word_of(uint32_t part, uint32_t role) {
  const quoin_end end = {0, part, role};
  double word;
  memcpy(&word, (const char *)&end + offsetof(quoin_end, part), sizeof word);
  return word;
}

static QN_NOINLINE void find_role(const struct quoin_scene *scene, uint64_t key, qn_span_role *at) {
  const uint32_t part = (uint32_t)(key >> 32) & QN_SPAN_LEAF;
  const qn_leaf *leaf = &scene->leaves[part];
  const qn_half *half = &scene->halves[leaf->half0];
  for (uint32_t i = 1; i < leaf->halves && half->surface != (uint32_t)key; i++) {
    half++;
  }
  *at = (qn_span_role){key, word_of(part, half->role)};
}

/* What a payload is in an interval, beside its place. Which face of a box it is cannot be guessed, so that some are kept. */
QN_INLINE double named(const struct quoin_scene *scene, qn_span_role *known, double payload) {
  uint64_t name;
  memcpy(&name, &payload, sizeof name);
  const uint64_t key = name & ~QN_SPAN_LARGER;
  qn_span_role *at = &known[key * 0x9e3779b97f4a7c15u >> (64 - QN_SPAN_ROLE_BITS)];
  if (QN_UNLIKELY(at->name != key)) {
    find_role(scene, key, at);
  }
  return at->word;
}

/* The lanes of `active` one by one: some are named otherwise, or lie where the range ends. */
static QN_NOINLINE void lane_words(const struct quoin_scene *scene, qn_span_role *known, const double *names, unsigned active, double t[QN_W], double words[QN_W]) {
  for (; active; active &= active - 1) {
    const unsigned i = qn_trailing_zeros(active);
    uint64_t name;
    memcpy(&name, &names[i], sizeof name);
    if (name == QN_SPAN_CUT) {
      words[i] = word_of(QUOIN_NO_PART, QUOIN_BODY), t[i] = t[i] == 0 ? 0 : t[i]; /* no negative zero */
    } else {
      words[i] = named(scene, known, names[i]);
    }
  }
}

/* Row j of a group, which the lanes of `active` have: their ends, to where they go. */
QN_INLINE void write_row(const struct quoin_scene *scene, qn_span_role *known, const double *row_t, const double *names, unsigned active, double *const to[QN_W]) {
  const double first = names[qn_trailing_zeros(active)];
  const vd t = vload(row_t);
  uint64_t name;
  memcpy(&name, &first, sizeof name);
  if (QN_LIKELY(!(active & ~vbits(vsame(vload(names), vset(first), ~QN_SPAN_LARGER))) && name != QN_SPAN_CUT)) {
    vdeal(t, vset(named(scene, known, first)), to);
  } else {
    _Alignas(64) double places[QN_W], words[QN_W] = {0};
    vstore(places, t);
    lane_words(scene, known, names, active, places, words);
    vdeal(vload(places), vload(words), to);
  }
}

void QN_OF_ISA(qn_write_rows)(const struct quoin_scene *scene, const qn_packet_spans *spans, qn_span_role *known, const uint32_t first[QN_LANES], quoin_interval *out);
void QN_OF_ISA(qn_write_rows)(const struct quoin_scene *scene, const qn_packet_spans *spans, qn_span_role *known, const uint32_t first[QN_LANES], quoin_interval *out) {
  for (int at = 0; at < QN_LANES; at += QN_W) {
    const uint32_t *count = spans->row_count + at;
    uint32_t least = count[0], most = count[0];
    for (unsigned i = 1; i < QN_W; i++) {
      least = count[i] < least ? count[i] : least, most = count[i] > most ? count[i] : most;
    }
    if (!most) {
      continue;
    }
    const double *t = spans->row_t + at, *names = spans->row_name + at;
    double nowhere[2], *to[QN_W]; /* where the end of row j goes */
    for (unsigned i = 0; i < QN_W; i++) {
      to[i] = (double *)(void *)(out + first[at + (int)i]);
    }
    for (uint32_t j = 0; j < least; j++, t += QN_LANES, names += QN_LANES) {
      write_row(scene, known, t, names, QN_ALL_BITS, to);
      for (unsigned i = 0; i < QN_W; i++) {
        to[i] += 2;
      }
    }
    for (uint32_t j = least; j < most; j++, t += QN_LANES, names += QN_LANES) {
      unsigned active = 0;
      for (unsigned i = 0; i < QN_W; i++) {
        active |= (unsigned)(j < count[i]) << i;
        to[i] = j < count[i] ? to[i] : nowhere;
      }
      write_row(scene, known, t, names, active, to);
      for (unsigned i = 0; i < QN_W; i++) {
        to[i] += j < count[i] ? 2 : 0;
      }
    }
  }
}
