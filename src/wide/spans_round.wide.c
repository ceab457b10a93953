/* Ends of rows on planes across an axis, rounded to the nearest double (spans_flat.h). Other ends are left to round.wide.c. */
#include "scene/rounding.h"
#include "wide/packet.h"
#include "wide/spans_flat.h"

#include <string.h>

enum { GROUPS = QN_LANES / QN_W };

/* Lanes of a row that all lie on one surface: rounds those of `active`; returns the others. */
QN_INLINE unsigned row_on_one(const qn_rounding *of, const qn_packet *packet, double *t, int at, unsigned active) {
  if (!of || of->kind != QN_ROUNDING_AXIS) {
    return active;
  }
  const int axis = of->axis[0];
  vd out;
  const unsigned sure = flat_round(vset(of->place[0]), vset(of->place[1]), vload(packet->o[axis] + at), vload(packet->d[axis] + at), vload(packet->inv[axis] + at), &out) & active;
  vstore(t, vpick(vmask(sure), out, vload(t)));
  return active & ~sure;
}

/* Row j of a group: rounds what it can of the lanes in `active`; returns the others that lie on a surface. */
QN_INLINE unsigned row_of_group(const struct quoin_scene *scene, const qn_packet *packet, double *t, const double *names, int at, unsigned active, uint64_t *made) {
  const qn_rounding *of[QN_W], *any = NULL;
  unsigned flat = 0, others = 0;
  if (!active) {
    return 0;
  }
  const double *first = &names[qn_trailing_zeros(active)];
  if (QN_LIKELY((vbits(vsame(vload(names), vset(*first), UINT64_MAX)) & active) == active)) { /* neighbours, mostly */
    uint64_t name;
    memcpy(&name, first, sizeof name);
    return name == QN_SPAN_CUT ? 0 : row_on_one(qn_scene_rounding(scene, (uint32_t)name, made), packet, t, at, active);
  }
  for (unsigned i = 0; i < QN_W; i++) {
    uint64_t name;
    memcpy(&name, &names[i], sizeof name);
    of[i] = NULL;
    if (active >> i & 1 && name != QN_SPAN_CUT) {
      of[i] = qn_scene_rounding(scene, (uint32_t)name, made);
      const unsigned is_flat = of[i] && of[i]->kind == QN_ROUNDING_AXIS;
      any = is_flat ? of[i] : any;
      flat |= is_flat << i, others |= (1 - is_flat) << i;
    }
  }
  if (!flat) {
    return others;
  }
  unsigned differ = 0;
  for (unsigned i = 0; i < QN_W; i++) {
    of[i] = flat >> i & 1 ? of[i] : any;
    differ |= of[i] != any;
  }
  vd high, low, o, d, inverse, out;
  if (differ) {
    const double *place[QN_W], *os[QN_W], *ds[QN_W], *is[QN_W];
    for (unsigned i = 0; i < QN_W; i++) {
      const int axis = of[i]->axis[0], from = at + (int)i;
      place[i] = of[i]->place, os[i] = packet->o[axis] + from, ds[i] = packet->d[axis] + from, is[i] = packet->inv[axis] + from;
    }
    high = vcollect(place, 0), low = vcollect(place, 1), o = vcollect(os, 0), d = vcollect(ds, 0), inverse = vcollect(is, 0);
  } else {
    const int axis = any->axis[0];
    high = vset(any->place[0]), low = vset(any->place[1]);
    o = vload(packet->o[axis] + at), d = vload(packet->d[axis] + at), inverse = vload(packet->inv[axis] + at);
  }
  const unsigned sure = flat_round(high, low, o, d, inverse, &out) & flat;
  vstore(t, vpick(vmask(sure), out, vload(t)));
  return others | (flat & ~sure);
}

void QN_OF_ISA(qn_round_flats)(const struct quoin_scene *scene, const qn_packet *packet, qn_packet_spans *spans, uint64_t lanes, uint64_t *made);
void QN_OF_ISA(qn_round_flats)(const struct quoin_scene *scene, const qn_packet *packet, qn_packet_spans *spans, uint64_t lanes, uint64_t *made) {
  const int planes = scene->plane_count > 0 && packet->tile != QN_TILE_PAIRS;
  uint32_t rows = 0;
  for (int g = 0; g < GROUPS; g++) {
    const int at = g * QN_W;
    const unsigned in = (unsigned)(lanes >> at) & QN_ALL_BITS;
    uint32_t count[QN_W], most = 0;
    for (unsigned i = 0; i < QN_W; i++) {
      count[i] = in >> i & 1 ? spans->row_count[at + (int)i] : 0;
      most = count[i] > most ? count[i] : most;
    }
    for (; rows < most; rows++) {
      spans->pending[rows] = 0;
    }
    for (uint32_t j = 0; j < most; j++) {
      const double *names = spans->row_name + (size_t)j * QN_LANES + at;
      unsigned active = 0;
      for (unsigned i = 0; i < QN_W; i++) {
        active |= (unsigned)(j < count[i]) << i;
      }
      if (planes) {
        active = row_of_group(scene, packet, spans->row_t + (size_t)j * QN_LANES + at, names, at, active, made);
      } else {
        for (unsigned i = 0; i < QN_W; i++) {
          uint64_t name;
          memcpy(&name, &names[i], sizeof name);
          active &= ~((unsigned)(name == QN_SPAN_CUT) << i);
        }
      }
      spans->pending[j] |= (uint64_t)active << at;
    }
  }
  spans->rows = rows;
}
