/* Ranges of boxes and how they are split: what the making of a hierarchy is built of. */
#ifndef QN_SCENE_SPLIT_H
#define QN_SCENE_SPLIT_H

#include "scene/bvh.h"
#include "scene/four.h"

/* Four lanes, the last one idle, so that a minimum of two boxes is one instruction. */
typedef struct qn_box4 { _Alignas(16) float min[4], max[4]; } qn_box4;

typedef struct qn_range {
  size_t begin, end;
  qn_box4 bounds;
  qn_box4 middles; /* holds min + max of each item: its middle, twice */
} qn_range;

typedef struct qn_split {
  qn_mem *mem;
  qn_bvh_item *items, *spare; /* spare: room for as many */
  unsigned threads;           /* for ranges larger than QN_SPLIT_LARGE */
} qn_split;

/* Ranges larger than this are split by several threads; others are split by one, and are tasks of their own. */
enum { QN_SPLIT_LARGE = 1 << 15 };

/* The whole as a range. */
QN_NODISCARD quoin_status qn_split_whole(const qn_split *s, size_t n, qn_range *out);
/* Splits a range into *count = 2 to 8 parts: where the expected cost of a walk is least (by_area), or in halves. A range of up to 8 items
   into its items. */
QN_NODISCARD quoin_status qn_split_wide(const qn_split *s, const qn_range *range, int by_area, qn_range parts[QN_BVH_WIDE], size_t *count);

#endif
