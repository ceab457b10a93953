/* What the files that find near surfaces share; near.c says how they work together. */
#ifndef QN_SCENE_NEAR_PARTS_H
#define QN_SCENE_NEAR_PARTS_H

#include "base/bounds.h"
#include "scene/near.h"

#include <math.h>

#define QN_NEAR_NONE UINT32_MAX

/* Levels of cells: of normals 2^-6 to 2^-36 wide by steps of 2^-3; of centres by steps of 2^4. */
enum { QN_NEAR_LEVELS = 11, QN_NEAR_CENTRE_LEVELS = 16 };
/* Leaves that a plane's box meets at most where these are looked through. */
enum { QN_NEAR_FEW_MET = 64 };
/* Widths of cells of f, and of the normals of one group. */
#define QN_NEAR_SHAPE_CELL 0x1p-20
#define QN_NEAR_GROUP_CELL 0x1p-40

typedef enum qn_near_kind { QN_NEAR_NOT, QN_NEAR_PLANE, QN_NEAR_CURVED } qn_near_kind;

typedef struct qn_near_item {
  qn_region region;
  double size;
  double n[3], d;       /* of a plane; of a curved surface its centre and f */
  double radius, reach; /* of a curved surface: how large it is, and how far another's radius may be from that */
  double error;         /* of d; of the centre and the radius */
  uint8_t kind, level, indexed;
} qn_near_item;

typedef struct qn_near_entry { uint64_t hash; uint32_t what, next; } qn_near_entry; /* what: surface or group */
typedef struct qn_near_table {
  qn_near_entry *entries;
  size_t count, capacity;
  uint32_t *heads;
  size_t head_count;
} qn_near_table;

typedef struct qn_near_group { double n[3]; uint32_t first; } qn_near_group;

/* A surface that doubles propose, and what its gap is at least. */
typedef struct qn_near_candidate { double least; uint32_t what; } qn_near_candidate;

typedef struct qn_near_finder {
  const quoin_scene *scene;
  qn_mem *mem;
  qn_near_want want;
  qn_num limit;
  double most;        /* of the limit, rounded up */
  double offset_cell, centre_cell;
  double plane_error; /* the largest */
  double origin[3];
  qn_near_item *items;
  uint32_t *order, *next_in_group;
  qn_near_group *groups;
  size_t group_count, group_capacity;
  qn_near_table directions, exact_directions, offsets, centres;
  unsigned levels, centre_levels; /* bits: those that are asked at */
  qn_near_candidate *found;
  size_t found_count, found_capacity;
  size_t compared, compared_exactly; /* the latter weighed; for a snap those alone that were not near */
  uint32_t *users, *users_of; /* leaves by surface, from users_of[i] to users_of[i + 1] */
  double unit;
  const qn_near_item *asking; /* of qn_near_boxes */
  uint32_t met_leaves[QN_NEAR_FEW_MET];
  size_t met;
  int refused;
  qn_ctx ctx;
  qn_near_pairs *out;
} qn_near_finder;

/* --- near_item.c ----------------------------------------------------------------------------------------------------- */

/* Everything of the finder but the index: items, users, the order in which surfaces are taken. */
QN_NODISCARD quoin_status qn_near_items_make(qn_near_finder *f);
/* The greatest angle (as a distance of unit normals) at which another plane can be near this one. */
double qn_near_angle(const qn_near_finder *f, const qn_near_item *it);
double qn_near_direction_cell(int level);
double qn_near_centre_cell(const qn_near_finder *f, int level);
/* Which comes first: the larger, then the first in the file. */
int qn_near_order(const qn_near_finder *f, uint32_t x, uint32_t y);

QN_INLINE double qn_near_middle(const qn_region *r, int k) {
  return 0.5 * r->min[k] + 0.5 * r->max[k];
}
QN_INLINE double qn_near_half_extent(const qn_region *r, int k) {
  return (0.5 * r->max[k] - 0.5 * r->min[k]) * (1 + 0x1p-50);
}

/* Whether boxes come within the limit of one another, or nearly so. */
QN_INLINE int qn_near_close(const qn_near_finder *f, const double min[3], const double max[3], const double other_min[3], const double other_max[3]) {
  for (int k = 0; k < 3; k++) {
    if (nextafter(min[k] - f->most, -INFINITY) > other_max[k] || nextafter(other_min[k] - f->most, -INFINITY) > max[k]) {
      return 0;
    }
  }
  return 1;
}

/* --- near_index.c ---------------------------------------------------------------------------------------------------- */

/* Puts a surface into the index. 0: memory was refused, also of those below. */
int qn_near_add(qn_near_finder *f, uint32_t i);
/* Finds candidates in the index, into found. */
int qn_near_planes(qn_near_finder *f, const qn_near_item *it, int level);
int qn_near_curved(qn_near_finder *f, const qn_near_item *it);
/* Likewise planes by walking the boxes of leaves, all that are near at an angle; *told 0: none was found so, ask the index. */
int qn_near_boxes(qn_near_finder *f, uint32_t i, int *told);
void qn_near_index_free(qn_near_finder *f);

#endif
