/* Packets: up to 64 rays that go the same way, solved together. A packet answers what doubles can certify; a ray with a
   comparison that they cannot is marked `unsure` and answered whole by the woven path (src/ray/weave.h). Nothing that a
   packet answers depends on the instruction set: only which rays it marks does.

   Order of the lanes: lane i is column x, row y of an 8 by 8 tile with x = bits 0, 2, 4 of i and y = bits 1, 3, 5, so that each
   QN_W neighbours in memory are neighbours in the tile. */
#ifndef QN_WIDE_PACKET_H
#define QN_WIDE_PACKET_H

#include "scene/normal.h"
#include "scene/scene.h"

enum { QN_LANES = 64, QN_FEW = 8 };
enum { QN_MANY_LANES, QN_FEW_LANES, QN_ONE_LANE, QN_EACH_LANE }; /* how many lanes of a packet are there: QN_LANES, QN_FEW or 1; or each live one goes by itself */

QN_INLINE unsigned qn_lane_column(unsigned lane) { return (lane & 1) | (lane >> 1 & 2) | (lane >> 2 & 4); }
QN_INLINE unsigned qn_lane_row(unsigned lane) { return (lane >> 1 & 1) | (lane >> 2 & 2) | (lane >> 3 & 4); }
QN_INLINE unsigned qn_lane_of(unsigned column, unsigned row) {
  return (column & 1) | (row & 1) << 1 | (column & 2) << 1 | (row & 2) << 2 | (column & 4) << 2 | (row & 4) << 3;
}

typedef struct qn_ends { _Alignas(64) double t[QN_LANES], p[QN_LANES]; } qn_ends; /* places and payloads (walk.h) */

/* Where the walk of a tile may begin in place of the root: boxes of a cut through the hierarchy, which hold all that any ray of some neighbouring tiles may meet in their range. */
enum { QN_ENTRY_NODES = 12, QN_ENTRY_BOXES = 8 * QN_ENTRY_NODES };
typedef struct qn_entry {
  qn_bvh_node nodes[QN_ENTRY_NODES];                     /* of eight boxes each, the nearest first */
  uint32_t parent[QN_ENTRY_BOXES], slot[QN_ENTRY_BOXES]; /* of the hierarchy, whose children these are */
  unsigned count;                                        /* nodes in use; none: nothing is met */
} qn_entry;

typedef struct qn_packet {
  _Alignas(64) double o[3][QN_LANES], d[3][QN_LANES]; /* d finite, not the zero vector */
  _Alignas(64) double from[QN_LANES], to[QN_LANES];
  uint32_t on[QN_LANES]; /* the surface that the place at `from` lies on, where that is known; else UINT32_MAX */
  uint64_t live; /* lanes in use; the others' numbers are finite all the same */
  /* What the body derives from the rays. Whoever fills a packet says what is new: a tile that keeps its origins or its
     directions keeps what follows from them. */
  int new_origins, new_directions;
  int kept_ranges; /* from, to and on are as they were when the body last saw them */
  int any; /* not the first boundary: whether the ray is in the solid anywhere in its range; only `found` and `unsure` are answered */
  int few; /* QN_FEW_LANES, QN_ONE_LANE: only the first ones are there; QN_EACH_LANE: live lanes, and the body sets nothing of what it derives */
  /* A tile: o or d (the other is the same in all lanes) of column x and row y is across[.][x] + up[.][y], both monotone along each axis; the
     body fills it in. TILE_NONE: o and d are filled in by whoever made the packet. TILE_PAIRS: so they are, and are rounded; the lines are o + olow and
     d + dlow, to 2^-104 of each number, and |olow| is at most u |o|, |dlow| at most u |d|. TILE_MOVED: so they are, and the line's o is within u moved of this one, component
     by component; only for packets with `any`. */
  enum { QN_TILE_NONE, QN_TILE_ORIGINS, QN_TILE_DIRECTIONS, QN_TILE_PAIRS, QN_TILE_MOVED } tile;
  const qn_entry *entry; /* of tiles of o or d alone: null, or what holds for them and the hierarchy that is walked */
  double moved[3];
  _Alignas(64) double across[3][8], up[3][8];
  _Alignas(64) double olow[3][QN_LANES], dlow[3][QN_LANES];
  _Alignas(64) double idd[QN_LANES], inv[3][QN_LANES]; /* 1 / (d . d); 1 / d_i, or 0 where d_i = 0 */
  _Alignas(64) float omin[3][8], omax[3][8], imin[3][8], imax[3][8]; /* of each eight lanes, rounded outward; i: of inv, widened */
  double low[3], high[3], dabs[3], dd_min, dd_max; /* of all lanes: origins, |d_i|, d . d */
  float all_imin[3], all_imax[3]; /* of all lanes */
  double d_most, idd_most, shy;   /* at least sqrt(dd_max), 1 / dd_min and 1 / sqrt(QN_WIDE_SHY dd_min) */
  int axis[3];
  int one_way; /* all lanes have one direction */
  double plane[2][3]; /* where they have: unit vectors across it and each other (outline.h) */
  qn_ends start; /* where the range begins, within what ends are taken for */
  _Alignas(64) double stop[QN_LANES];
  float soonest, latest; /* of all lanes: start and stop, rounded outward */
  uint64_t empty;        /* lanes without a range of any length */
} qn_packet;

/* What became of each lane. A lane is in at most one of `found` and `unsure`. */
typedef struct qn_packet_hits {
  uint64_t found, leaving, unsure;
  uint64_t tied;         /* of the found: leaves tie there, and the woven path may name another of them */
  uint64_t tied_surface; /* of the tied: where another surface passes there, too, the woven path may name that one */
  _Alignas(64) double t[QN_LANES];      /* approximate: within `error` of the true parameter */
  _Alignas(64) double error[QN_LANES];
  uint32_t surface[QN_LANES], leaf[QN_LANES]; /* leaf: one with that surface at the hit */
  uint64_t far_end; /* lanes whose surface is where the ray leaves that leaf (the larger root) */
} qn_packet_hits;

/* budget: leaves that each QN_W lanes may solve before all lanes are given up; 0: no limit. Enter and leave call each other, so a term taken away from a
   term, and so on through many levels that overlap, may be walked a number of times that doubles with each. */
/* lost: how many rays of those that go each by itself were given up for that. */
typedef struct qn_wide_counts { uint64_t nodes, leaves, packets, budget, lost; } qn_wide_counts;

/* The first boundary at or after `from` and not after `to`. */
typedef void (*qn_first_fn)(const struct quoin_scene *scene, qn_packet *packet, qn_packet_hits *hits, qn_wide_counts *counts);

/* The entry of the tiles whose columns and rows lie between the first and the last ones of this packet, a tile of o or d with the range of them all: to the scene's set, or to all
   leaves (qn_spans_fn). 0: there is none, or it would gain nothing. */
typedef int (*qn_enter_fn)(const struct quoin_scene *scene, qn_packet *packet, int leaves, qn_entry *entry, qn_wide_counts *counts);

/* The doubles nearest to the hits of `lanes` (all of them found ones, in a packet that has been through its body), into t (aligned to 64); the lanes for which it is certain that
   they are. The other lanes' t is arbitrary: they go through qn_place_round. *made is increased by the exact forms made. */
typedef uint64_t (*qn_round_fn)(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, uint64_t lanes, double t[QN_LANES],
                                uint64_t *made);

/* The same for the first lane alone, which is found: whether *t is certainly the nearest. */
typedef int (*qn_round_one_fn)(const struct quoin_scene *scene, const qn_packet *packet, const qn_packet_hits *hits, double *t, uint64_t *made);

/* Every stretch of each lane in each leaf that it meets: for whoever merges them (query/sheaf.h). Lanes lie in groups of `width`; slot s of
   group g holds one leaf's stretches, four times `width` doubles from ends + ((g capacity + s) 4 width): where they begin, where they
   end, and the payloads of both (below). An end that is not there lies at -QN_SPAN_FAR or QN_SPAN_FAR, its payload means nothing. */
typedef struct qn_span_slot {
  uint32_t leaf, gate;
  uint8_t negated, settles, hit; /* settles: in the leaf the gate has its value whatever the others do; hit: the lanes of the group that meet the leaf */
} qn_span_slot;
/* An order of the ends of leaves that lanes meet, and what it makes of the solid (wide/spans_plan.h). From zeros: that of no leaves. */
enum { QN_PLAN_LEAVES = 64, QN_PLAN_BITS = 5 };
typedef struct qn_span_plan {
  uint32_t leaves, alives, ends, drops, rows;
  uint32_t leaf[QN_PLAN_LEAVES];     /* in the order in which they are met */
  uint16_t end[2 * QN_PLAN_LEAVES];  /* in order */
  uint16_t row[2 * QN_PLAN_LEAVES];  /* where the solid is entered and left, in turn */
  uint8_t drop[QN_PLAN_LEAVES][2];   /* the first one's stretch changes nothing while it lies well within the other's */
  uint8_t alive[QN_PLAN_LEAVES];     /* the leaves that may change the solid in some order; none: these leaves make no solid */
} qn_span_plan;
/* A plane across an axis, as rounding takes it: some that were asked for, each in the place of its number's lowest bits. */
enum { QN_FLAT_BITS = 8, QN_FLAT_NONE = 3, QN_FLAT_BALL = 4 };
typedef struct qn_span_flat { double place[2]; uint32_t surface, axis; } qn_span_flat; /* place: scene/rounding.h; surface: QUOIN_NO_SURFACE where there is none; axis: or QN_FLAT_BALL of a sphere, QN_FLAT_NONE of what else is no such plane */
typedef struct qn_packet_spans {
  double *ends;          /* aligned to 64 */
  qn_span_slot *slots;   /* slot s of group g is slots[g capacity + s] */
  uint32_t capacity;     /* slots for each group */
  uint32_t count[QN_LANES / 2]; /* slots in use, by group */
  int full;              /* there were not enough slots: the answer is void */
  int limited;           /* some leaf was solved in the solid's box only: what is found out of that box means nothing */
  uint64_t unsure;       /* lanes given up */
  double reach;          /* nothing that is found at a larger |t| means anything */
  _Alignas(64) double tolerance[QN_LANES]; /* two places further apart than this are in the order of their doubles; half of it bounds each error */
  /* The solid's own stretches in the lanes of `merged`: of lane i, ends 0 to row_count[i] - 1, in order, end j at row_t[j QN_LANES + i], its payload
     as bits likewise. Of simple programs (wide/spans_merge.h), or by plans (wide/spans_plan.h). There is room for 2 capacity + 2 rows. */
  double *row_t, *row_name; /* aligned to 64 */
  uint32_t row_count[QN_LANES];
  uint64_t merged;
  qn_span_plan *plans;  /* 1 << QN_PLAN_BITS of them, kept from packet to packet of one scene; null: none */
  uint32_t *gate_count; /* with plans: for each gate of the program its `base`, before and after */
  qn_span_flat *flats;  /* 1 << QN_FLAT_BITS of them, kept likewise */
  uint64_t *pending; /* by row, of the first `rows`: the lanes whose t is to be rounded yet (qn_round_rows_fn) */
  uint32_t rows;
} qn_packet_spans;
#define QN_SPAN_FAR 0x1p+500
#define QN_SPAN_CUT UINT64_MAX /* instead of a payload, in a row: where the ray's range cuts the stretch */
/* A payload: the surface (low half), the leaf, and whether it is the larger of the surface's two roots on that ray. */
#define QN_SPAN_LARGER ((uint64_t)1 << 62)
#define QN_SPAN_LEAF 0x3fffffffu /* of the upper half */

/* The ends of all rows get the double nearest to the true t, where that is certain; the others are `pending`. *made is increased by the exact forms made. */
typedef void (*qn_round_rows_fn)(const struct quoin_scene *scene, const qn_packet *packet, qn_packet_spans *spans, uint64_t *made);

/* Which part and role a payload is: some that were asked for, by hash. */
typedef struct qn_span_role { uint64_t name; double word; } qn_span_role; /* a payload without QN_SPAN_LARGER, or QN_SPAN_CUT for none; a quoin_end's bits after its t */
enum { QN_SPAN_ROLE_BITS = 9 };
/* The rows of lane i become the intervals from out + first[i] on. */
typedef void (*qn_write_rows_fn)(const struct quoin_scene *scene, const qn_packet_spans *spans, qn_span_role known[1 << QN_SPAN_ROLE_BITS], const uint32_t first[QN_LANES],
                                 quoin_interval *out);

/* Fills spans; live lanes must have from < to or are not solved. A tile's origins are filled in unless nothing is near. */
typedef void (*qn_spans_fn)(const struct quoin_scene *scene, qn_packet *packet, qn_packet_spans *spans, qn_wide_counts *counts);
struct qn_point_walk;
/* The sides of points, as far as doubles certify them: wide/points.h. */
typedef void (*qn_points_fn)(const struct quoin_scene *scene, struct qn_point_walk *walk, size_t n, const double *points, const double *weights, uint8_t *verdict,
                             qn_wide_counts *counts);
/* The spots of a whole tile into eight rows of eight, `stride` apart: of the lanes in `met`, at t (aligned to 64); nothing in the others. */
typedef void (*qn_spots_fn)(const qn_packet_hits *hits, uint64_t met, const double t[QN_LANES], quoin_spot *out, size_t stride);

/* What is seen of rays as they are put into a packet (gather.wide.c). Start from zeros, and keep it with the packet while its body sees every filling. */
typedef struct qn_gathered {
  int rays;                  /* each has finite numbers, a direction and a range; else nothing below means anything */
  int one_way, one_range;    /* all have the same direction, the same range */
  int new_ways, new_ranges;  /* they are not those of the packet before */
  int together;              /* none goes more than some tens of degrees off the first */
  double width2;             /* how far apart lines are from the first one's, across it, at most: the square, times its direction's */
} qn_gathered;
/* n rays, n > 0, into the lanes: as an 8 by 8 tile, row after row; or where `which` is not null the rays that it lists, in the lanes' order. The last is repeated
   in the lanes that are left. Origins, directions and ranges are set and nothing else. */
typedef void (*qn_gather_fn)(const quoin_ray *rays, const uint16_t *which, unsigned n, qn_packet *packet, qn_gathered *seen);
/* Moves the starts of all lanes, which go one way, along their lines (blocked.c in query): the tile becomes QN_TILE_MOVED, ranges with it. */
typedef void (*qn_move_fn)(qn_packet *packet);

typedef struct qn_wide {
  const char *name;
  qn_first_fn first; /* all QN_LANES lanes: every lane's numbers must be there, live or not */
  qn_first_fn few;   /* the first QN_FEW lanes alone, as quick as those need; no tiles */
  qn_first_fn one;   /* the first lane alone */
  qn_first_fn each;  /* each live lane alone, several of them at a time; the same answers as theirs one by one, and zeros where nothing is found; no tiles */
  qn_enter_fn enter;
  qn_round_fn round;
  qn_spans_fn spans, spans_few; /* of all lanes; of the first QN_FEW */
  unsigned width;               /* lanes of a group in qn_packet_spans */
  qn_points_fn points; /* wide/points.h */
  qn_spots_fn spots;
  qn_round_one_fn round_one;
  qn_gather_fn gather;
  qn_move_fn move;
  qn_round_rows_fn round_rows;
  qn_write_rows_fn write_rows;
} qn_wide;
/* The widest body this machine runs, or the one QUOIN_ISA names ("sse2", "avx2", "avx512") when it runs it. */
const qn_wide *qn_wide_pick(void);

#endif
