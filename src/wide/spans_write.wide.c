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

/* What was not among those known. A place where the range ends is nobody's, and no negative zero. */
static QN_NOINLINE double find(const struct quoin_scene *scene, uint64_t key, qn_span_role *at, double *t) {
  if (key == (QN_SPAN_CUT & ~QN_SPAN_LARGER)) {
    *t = *t == 0 ? 0 : *t;
    return word_of(QUOIN_NO_PART, QUOIN_BODY);
  }
  const uint32_t part = (uint32_t)(key >> 32) & QN_SPAN_LEAF;
  const qn_leaf *leaf = &scene->leaves[part];
  const qn_half *half = &scene->halves[leaf->half0];
  for (uint32_t i = 1; i < leaf->halves && half->surface != (uint32_t)key; i++) {
    half++;
  }
  *at = (qn_span_role){key, word_of(part, half->role)};
  return at->word;
}

/* What a payload is in an interval, beside its place. Which face of a box it is cannot be guessed, so that some are kept. */
QN_INLINE double named(const struct quoin_scene *scene, qn_span_role *known, double payload, double *t) {
  uint64_t name;
  memcpy(&name, &payload, sizeof name);
  const uint64_t key = name & ~QN_SPAN_LARGER;
  qn_span_role *at = &known[key * 0x9e3779b97f4a7c15u >> (64 - QN_SPAN_ROLE_BITS)];
  return QN_LIKELY(at->name == key) ? at->word : find(scene, key, at, t);
}

/* Rows of one name in all lanes of a group, as long as there are such, up to row `least`. Returns where they end; *t, *names: that row. */
QN_INLINE uint32_t write_alike(const struct quoin_scene *scene, qn_span_role *known, uint32_t least, const double **t, const double **names, double *to[QN_W]) {
  uint32_t j = 0;
  for (; j < least; j++, *t += QN_LANES, *names += QN_LANES) {
    const double first = **names;
    uint64_t name;
    memcpy(&name, &first, sizeof name);
    if (vbits(vsame(vload(*names), vset(first), ~QN_SPAN_LARGER)) != QN_ALL_BITS || name == QN_SPAN_CUT) {
      break;
    }
    double unused = 0;
    vdeal(vload(*t), vset(named(scene, known, first, &unused)), to);
    for (unsigned i = 0; i < QN_W; i++) {
      to[i] += 2;
    }
  }
  return j;
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
    double *to[QN_W]; /* where the end of row j goes */
    for (unsigned i = 0; i < QN_W; i++) {
      to[i] = (double *)(void *)(out + first[at + (int)i]);
    }
    const uint32_t begin = write_alike(scene, known, least, &t, &names, to);
    for (unsigned i = 0; begin < most && i < QN_W; i++) {
      const double *place = t + i, *name = names + i;
      double *end = to[i];
      for (uint32_t j = begin; j < count[i]; j++, place += QN_LANES, name += QN_LANES, end += 2) {
        end[0] = *place;
        end[1] = named(scene, known, *name, end);
      }
    }
  }
}
