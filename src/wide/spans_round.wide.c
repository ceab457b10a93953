/* Ends of rows, rounded to the nearest double: those on planes across an axis (spans_flat.h) and on spheres (round_ball.h) group by group, the others row by row as first hits
   are (round.wide.c). */
#include "scene/rounding.h"
#include "wide/packet.h"
#include "wide/round_ball.h"
#include "wide/spans_flat.h"

#include <string.h>

enum { GROUPS = QN_LANES / QN_W };

uint64_t QN_OF_ISA(qn_round)(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes,
                             double t[QN_LANES], uint64_t *made); /* round.wide.c */

QN_INLINE double payload_cut(void) {
  const uint64_t cut = QN_SPAN_CUT;
  double bits;
  memcpy(&bits, &cut, sizeof bits);
  return bits;
}

/* --- spheres --------------------------------------------------------------------------------------------------------- */

/* A leaf that all lanes of a row were on, and its sphere if it is one. */
enum { SEEN = 4 };
typedef struct seen_ball { uint32_t leaf; int is_ball; ball ball; } seen_ball;

/* What is rounded here, and the spheres that were met last: mostly where a stretch begins and where it ends are on one, and neighbours' ends are. */
typedef struct rounding_rows {
  const struct quoin_scene *scene;
  const qn_packet *packet;
  const double *tolerance;
  qn_span_flat *flats;
  uint64_t *made;
  int planes, balls; /* whether there may be any */
  seen_ball one[SEEN]; /* by the leaf's last bits; UINT32_MAX: none yet */
  unsigned in;       /* the lanes of `leaves`, payloads, whose leaves are spheres, those of `ball`; `not_in`: those whose leaves are none */
  unsigned not_in;
  vd leaves;
  ball ball;
} rounding_rows;

static const qn_piece_sphere *sphere_of(const struct quoin_scene *scene, uint32_t leaf) {
  const qn_piece_head *head = (const qn_piece_head *)(const void *)((const char *)scene->lines + (size_t)scene->line_of[leaf] * 64);
  return head->kind == QN_PIECE_SPHERE ? (const qn_piece_sphere *)(const void *)head : NULL;
}

static QN_NOINLINE void see_one_ball(const rounding_rows *r, uint32_t leaf, seen_ball *one) {
  const qn_piece_sphere *s = sphere_of(r->scene, leaf);
  one->leaf = leaf, one->is_ball = s != NULL;
  if (s) {
    one->ball = ball_of_one(r->packet, s);
  }
}

static QN_NOINLINE void see_balls(rounding_rows *r, const double *names, unsigned active) {
  const qn_piece_sphere *of[QN_W], *some = NULL;
  r->in = 0, r->leaves = vload(names);
  for (unsigned i = 0; i < QN_W; i++) {
    uint64_t name;
    memcpy(&name, &names[i], sizeof name);
    of[i] = active >> i & 1 ? sphere_of(r->scene, (uint32_t)(name >> 32) & QN_SPAN_LEAF) : NULL;
    some = of[i] ? of[i] : some, r->in |= (unsigned)(of[i] != NULL) << i;
  }
  r->not_in = active & ~r->in;
  if (some) {
    for (unsigned i = 0; i < QN_W; i++) {
      of[i] = of[i] ? of[i] : some;
    }
    r->ball = ball_of_each(r->packet, of);
  }
}

/* Rounds those lanes of `on` that it can; returns the others. All are on the spheres of b. */
QN_INLINE unsigned row_on_balls(const rounding_rows *r, const ball *b, double *t, int at, unsigned on) {
  const qn_packet *p = r->packet;
  const vd o[3] = {vload(p->o[0] + at), vload(p->o[1] + at), vload(p->o[2] + at)}, d[3] = {vload(p->d[0] + at), vload(p->d[1] + at), vload(p->d[2] + at)};
  const vd rough = vload(t);
  vd out;
  const vm sure = vand(ball_round(p, b, o, d, rough, vmul(vload(r->tolerance + at), vset(0.5)), &out), vmask(on));
  vstore(t, vpick(sure, out, rough));
  return on & ~vbits(sure);
}

/* --- planes across an axis --------------------------------------------------------------------------------------------- */

/* A sphere's exact form is not asked for. */
static QN_NOINLINE void see_flat(const rounding_rows *r, uint32_t surface, uint32_t leaf, qn_span_flat *f) {
  if (r->balls && sphere_of(r->scene, leaf)) {
    *f = (qn_span_flat){{0, 0}, surface, QN_FLAT_BALL};
    return;
  }
  const qn_rounding *of = qn_scene_rounding(r->scene, surface, r->made);
  const int flat = of && of->kind == QN_ROUNDING_AXIS;
  *f = (qn_span_flat){{flat ? of->place[0] : 0, flat ? of->place[1] : 0}, of ? surface : QUOIN_NO_SURFACE, flat ? of->axis[0] : (uint32_t)QN_FLAT_NONE};
}

QN_INLINE const qn_span_flat *flat_of(const rounding_rows *r, uint64_t name) {
  const uint32_t surface = (uint32_t)name;
  qn_span_flat *f = &r->flats[surface & ((1u << QN_FLAT_BITS) - 1)];
  if (QN_UNLIKELY(f->surface != surface)) {
    see_flat(r, surface, (uint32_t)(name >> 32) & QN_SPAN_LEAF, f);
  }
  return f;
}

/* All lanes on one plane: rounds those of `on` that it can; returns the others. */
QN_INLINE unsigned row_on_plane(const rounding_rows *r, const qn_span_flat *f, double *t, int at, unsigned on) {
  const uint32_t axis = f->axis;
  const qn_packet *packet = r->packet;
  vd out;
  const unsigned sure = flat_round(vset(f->place[0]), vset(f->place[1]), vload(packet->o[axis] + at), vload(packet->d[axis] + at), vload(packet->inv[axis] + at), &out) & on;
  vstore(t, vpick(vmask(sure), out, vload(t)));
  return on & ~sure;
}

QN_INLINE vd of_axes(const double from[3][QN_LANES], int at, uint64_t on) {
  return vpick(vmask((unsigned)on & QN_ALL_BITS), vload(from[0] + at), vpick(vmask((unsigned)(on >> 8) & QN_ALL_BITS), vload(from[1] + at), vload(from[2] + at)));
}

/* Lanes on surfaces of their own: rounds those of `active` that it can; returns the others. *balls: those on spheres. */
QN_INLINE unsigned row_on_planes(const rounding_rows *r, double *t, const double *names, int at, unsigned active, unsigned *balls) {
  const qn_packet *packet = r->packet;
  _Alignas(64) double high[QN_W], low[QN_W], ends[QN_W];
  uint64_t on = 0; /* by axis, eight bits each */
  vstore(ends, vpick(vmask(active), vload(names), vset(names[qn_trailing_zeros(active)])));
  for (unsigned i = 0; i < QN_W; i++) {
    uint64_t name;
    memcpy(&name, &ends[i], sizeof name);
    const qn_span_flat *f = flat_of(r, name);
    high[i] = f->place[0], low[i] = f->place[1];
    on |= (uint64_t)1 << (8 * f->axis + i);
  }
  *balls = active & (unsigned)(on >> (8 * QN_FLAT_BALL));
  const unsigned flat = active & (unsigned)(on | on >> 8 | on >> 16);
  if (!flat) {
    return active;
  }
  vd out;
  const unsigned sure = flat_round(vload(high), vload(low), of_axes(packet->o, at, on), of_axes(packet->d, at, on), of_axes(packet->inv, at, on), &out) & flat;
  vstore(t, vpick(vmask(sure), out, vload(t)));
  return active & ~sure;
}

/* --- rows ------------------------------------------------------------------------------------------------------------------ */

/* Row j of a group where not all lanes end on one surface. */
static QN_NOINLINE unsigned row_of_many(rounding_rows *r, double *t, const double *names, int at, unsigned active) {
  active &= ~vbits(vsame(vload(names), vset(payload_cut()), UINT64_MAX));
  unsigned balls = r->balls ? active : 0;
  if (r->planes && active) {
    active = row_on_planes(r, t, names, at, active, &balls);
  }
  if (balls) {
    const unsigned known = r->in | r->not_in, same = vbits(vsame(vload(names), r->leaves, (uint64_t)QN_SPAN_LEAF << 32));
    if ((balls & known & same) != balls) {
      see_balls(r, names, balls);
    }
    const unsigned on = balls & r->in;
    active = (active & ~on) | (on ? row_on_balls(r, &r->ball, t, at, on) : 0);
  }
  return active;
}

/* All lanes on one leaf, which may be a sphere. */
QN_INLINE unsigned row_on_ball(rounding_rows *r, uint32_t leaf, double *t, int at, unsigned active) {
  seen_ball *one = &r->one[leaf % SEEN];
  if (leaf != one->leaf) {
    see_one_ball(r, leaf, one);
  }
  return one->is_ball ? row_on_balls(r, &one->ball, t, at, active) : active;
}

/* Row j of a group: rounds what it can of the lanes in `active`; returns the others that lie on a surface. */
QN_INLINE unsigned row_of_group(rounding_rows *r, double *t, const double *names, int at, unsigned active) {
  const double first = names[qn_trailing_zeros(active)];
  uint64_t name;
  memcpy(&name, &first, sizeof name);
  if (QN_UNLIKELY((active & ~vbits(vsame(vload(names), vset(first), UINT64_MAX))) || name == QN_SPAN_CUT)) {
    return row_of_many(r, t, names, at, active);
  }
  const uint32_t leaf = (uint32_t)(name >> 32) & QN_SPAN_LEAF;
  if (!r->planes) {
    return r->balls ? row_on_ball(r, leaf, t, at, active) : active;
  }
  const qn_span_flat *f = flat_of(r, name);
  return f->axis < QN_FLAT_NONE ? row_on_plane(r, f, t, at, active) : f->axis == QN_FLAT_BALL ? row_on_ball(r, leaf, t, at, active) : active;
}

/* The lanes of a group that have a row j. */
QN_INLINE unsigned lanes_with(const uint32_t *count, uint32_t j) {
  unsigned with = 0;
  for (unsigned i = 0; i < QN_W; i++) {
    with |= (unsigned)(j < count[i]) << i;
  }
  return with;
}

/* The ends that are rounded here; pending: the others. */
static void round_groups(rounding_rows *r, qn_packet_spans *spans) {
  uint32_t rows = 0;
  for (int at = 0; at < QN_LANES; at += QN_W) {
    const uint32_t *count = spans->row_count + at;
    uint32_t least = count[0], most = count[0];
    for (unsigned i = 1; i < QN_W; i++) {
      least = count[i] < least ? count[i] : least, most = count[i] > most ? count[i] : most;
    }
    for (; rows < most; rows++) {
      spans->pending[rows] = 0;
    }
    for (uint32_t j = 0; j < most; j++) {
      const unsigned active = j < least ? QN_ALL_BITS : lanes_with(count, j);
      spans->pending[j] |= (uint64_t)row_of_group(r, spans->row_t + (size_t)j * QN_LANES + at, spans->row_name + (size_t)j * QN_LANES + at, at, active) << at;
    }
  }
  spans->rows = rows;
}

static int no_rows(const qn_packet_spans *spans) {
  uint32_t some = 0;
  for (int i = 0; i < QN_LANES; i++) {
    some |= spans->row_count[i];
  }
  return !some;
}

/* Row j's pending lanes, as first hits are. */
static void round_row(const struct quoin_scene *scene, const qn_packet *packet, qn_packet_spans *spans, uint32_t j, qn_packet_hits *hits, uint64_t *made) {
  double *t = spans->row_t + (size_t)j * QN_LANES;
  const double *names = spans->row_name + (size_t)j * QN_LANES;
  const uint64_t pending = spans->pending[j];
  _Alignas(64) double rounded[QN_LANES];
  for (int at = 0; at < QN_LANES; at += 8) {
    if (!(pending >> at & 255)) {
      continue;
    }
    uint64_t name[8];
    memcpy(name, names + at, sizeof name);
    for (int i = 0; i < 8; i++) {
      hits->t[at + i] = t[at + i];
      hits->surface[at + i] = (uint32_t)name[i], hits->leaf[at + i] = (uint32_t)(name[i] >> 32) & QN_SPAN_LEAF;
    }
  }
  const uint64_t sure = QN_OF_ISA(qn_round)(scene, packet, hits, pending, rounded, made) & pending;
  for (int at = 0; at < QN_LANES; at += QN_W) {
    const unsigned bits = (unsigned)(sure >> at) & QN_ALL_BITS;
    if (bits) {
      vstore(t + at, vpick(vmask(bits), vload(rounded + at), vload(t + at)));
    }
  }
  spans->pending[j] = pending & ~sure;
}

void QN_OF_ISA(qn_round_rows)(const struct quoin_scene *scene, const qn_packet *packet, qn_packet_spans *spans, uint64_t *made);
void QN_OF_ISA(qn_round_rows)(const struct quoin_scene *scene, const qn_packet *packet, qn_packet_spans *spans, uint64_t *made) {
  const int exact = packet->tile != QN_TILE_PAIRS;
  rounding_rows r; /* large: what is seen is filled in as it is met */
  r.scene = scene, r.packet = packet, r.tolerance = spans->tolerance, r.flats = spans->flats, r.made = made;
  r.planes = exact && scene->plane_count > 0, r.balls = exact && scene->quadric_count > 0, r.in = r.not_in = 0;
  for (int i = 0; i < SEEN; i++) {
    r.one[i].leaf = UINT32_MAX;
  }
  qn_packet_hits hits;
  uint64_t some = 0;
  spans->rows = 0;
  if (no_rows(spans)) {
    return;
  }
  round_groups(&r, spans);
  for (uint32_t j = 0; j < spans->rows; j++) {
    some |= spans->pending[j];
  }
  if (!some) {
    return;
  }
  for (int at = 0; at < QN_LANES; at += QN_W) {
    vstore(hits.error + at, vmul(vload(spans->tolerance + at), vset(0.5)));
  }
  for (uint32_t j = 0; j < spans->rows; j++) {
    if (spans->pending[j]) {
      round_row(scene, packet, spans, j, &hits, made);
    }
  }
}
