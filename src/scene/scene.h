/* A compiled scene: leaves in order of the file, their half-spaces, the distinct surfaces, the program, the hierarchy.
   Immutable after compilation but for the exact forms, which are made when first needed and published atomically. */
#ifndef QN_SCENE_SCENE_H
#define QN_SCENE_SCENE_H

#include "model/solid.h"
#include "quoin/scene.h"
#include "scene/bvh.h"
#include "scene/normal.h"
#include "scene/piece.h"
#include "scene/program.h"

/* --- double shadows: the one door by which rounding enters. Every number here is an exact number rounded with a relative error of
   at most u (1 + 2^-40), u = 2^-53, or an exact zero (a structural zero is stored as 0 and means 0). A number of a size beyond 2^1000 or under 2^-1000 is
   stored as that size with its sign: filters take sizes outside [2^-100, 2^100] to the exact tier anyway. Coordinates are relative
   to the leaf's pivot: y = x - pivot, where pivot is exact as stored. ---------------------------------------------------- */
typedef struct qn_plane_shadow { double n[3], d; } qn_plane_shadow;              /* q = n . y + d */
/* X_i = row_i . (y, 1); q = sum s X^2 + 2 l X_2 + k. Of a sphere that is only shifted: k + k_rest within 2^-100 k; of others k_rest is infinite. */
typedef struct qn_quadric_shadow { double row[3][4], s[3], l, k, k_rest; } qn_quadric_shadow;
/* A superquadric uses a qn_quadric_shadow with s[0] = e, s[1] = n. */

/* One half-space of a leaf, q <= 0. q is `side` times a positive multiple of its surface's exact form. */
typedef struct qn_half {
  uint32_t surface;
  uint32_t shadow; /* in planes or quadrics */
  uint32_t role;
  int8_t side;
  uint8_t kind;    /* qn_half_kind */
} qn_half;

typedef struct qn_leaf {
  double pivot[3];
  double min[3], max[3];  /* holds the leaf; infinite where unbounded */
  uint32_t half0, halves;
  uint32_t node;          /* in the model */
  uint32_t material;      /* in materials: resolved along the path */
  uint32_t gate;          /* its place in the program */
  uint8_t negated;        /* its literal there is "outside the leaf" */
  uint8_t prim, bounded, convex; /* convex: every half-space is, so a line meets it in at most one interval */
} qn_leaf;

/* The exact form of a surface in world coordinates, homogeneous and primitive:
   A x2 + B y2 + C z2 + D xy + E xz + F yz + G xw + H yw + I zw + J w2, the first non-zero coefficient positive
   (a plane: A..F are 0 and G, H, I, J are the plane, G x + H y + I z + J w). rounded: design S2's rule applies. */
typedef struct qn_exact_surface {
  qn_int q[10];
  uint8_t plane, rounded;
  uint8_t beyond; /* it is none: its numbers pass a limit */
} qn_exact_surface;

typedef struct qn_kept_maps qn_kept_maps; /* scene/compile.h */

typedef struct qn_surface {
  uint32_t leaf, half;            /* a user: halves[half] of leaves[leaf] */
  uint32_t users;
  uint8_t kind;
  union {                         /* null until asked for */
    _Atomic(qn_exact_surface *) exact;
    _Atomic(struct qn_super_form *) super; /* of a superquadric: scene/super.h */
  };
  _Atomic(struct qn_rounding *) rounding; /* likewise: scene/rounding.h */
} qn_surface;

/* A run of terms that are one leaf each, with pieces one behind another: that of term first + i begins at line + step i. */
typedef struct qn_plain_run { uint32_t first, count, line, step; } qn_plain_run;

struct quoin_scene {
  quoin_model *model;
  qn_mem *mem; /* the model's */
  qn_leaf *leaves; size_t leaf_count;
  qn_half *halves; size_t half_count;
  qn_plane_shadow *planes; size_t plane_count;
  qn_quadric_shadow *quadrics; size_t quadric_count;
  qn_surface *surfaces; size_t surface_count, surface_room;
  qn_program program;
  qn_bvh bvh;                     /* over the bounded leaves */
  uint32_t *unbounded; size_t unbounded_count; /* the other leaves */
  qn_normal normal;
  void *lines; size_t line_count; /* pieces, in cache lines */
  uint32_t *line_of;              /* by leaf: its piece's first line */
  _Atomic(struct qn_cells *) *cells; /* null until asked for: scene/cells.h */
  uint32_t *plain; size_t plain_count; /* by term of the normal form: its piece's first line where it is one leaf and no more; else UINT32_MAX */
  qn_plain_run run;               /* the longest one in `plain` */
  qn_material *materials; size_t material_count; /* all parts filled in; 0 is the default material */
  uint32_t *part_names; /* by leaf: offset in name_text */
  char *name_text; size_t name_size;
  int empty;
  double min[3], max[3];          /* of the solid */
  size_t bytes;                   /* what the arrays above take */
  size_t dropped;                 /* leaves of the model that are none of these */
  qn_kept_maps *kept_maps;        /* exact maps of nodes, made as they are asked for */
  struct qn_snaps *snaps;         /* null: nothing was snapped */
  quoin_near_list *snapped;       /* what is told of it; null: not asked for */
};

/* The first line of a term's piece where it is one leaf and no more; else UINT32_MAX. In large scenes `plain` is far from everything else that a ray reads. */
QN_INLINE uint32_t qn_plain_line(const quoin_scene *scene, uint32_t term) {
  const uint32_t i = term - scene->run.first;
  return QN_LIKELY(i < scene->run.count) ? scene->run.line + scene->run.step * i : scene->plain[term];
}

/* Whether what rays walk through is more than the caches hold: then they are walked in turns, and memory is asked for what comes next. Measured: of what a core's caches hold, turns are 5 to 15 % slower;
   at 11 MB they are faster. */
enum { QN_CACHED_BYTES = 1 << 23 };
QN_INLINE int qn_scene_is_far(const quoin_scene *scene) { return scene->normal.node_count * sizeof(qn_bvh_node) + scene->line_count * 64 >= QN_CACHED_BYTES; }

/* The exact form of a surface, made on first use; then *made (may be null) is set to 1, else to 0. Null when memory is refused, or its numbers pass
   QN_MAX_SCENE_BITS or their making QN_MAX_SCENE_EFFORT, and for superquadrics, which have none. Threads: any. */
const qn_exact_surface *qn_scene_exact(const quoin_scene *scene, uint32_t surface, int *made);
/* Why there was none: QUOIN_E_LIMIT or QUOIN_E_MEMORY. */
quoin_status qn_scene_no_exact(const quoin_scene *scene, uint32_t surface);

/* The exact half-spaces of a leaf in world coordinates (forms under the composed exact map), into ctx: for superquadrics
   and for tests. */
qn_form_result qn_scene_leaf_forms(const quoin_scene *scene, uint32_t leaf, qn_ctx *ctx, qn_half_form **halves, size_t *count);

#endif
