/* Snapping (design S4): surfaces of a scene moved onto others within a limit, when the user asks. docs/decisions/0007-snap.md.

   The leaves are made once to see which surfaces they have (the survey); near.c says which move; the scene is then made anew, each
   moved half-space being, from its exact form on, that of the surface that stands. So whatever comes after does not know of snapping. */
#ifndef QN_SCENE_SNAP_H
#define QN_SCENE_SNAP_H

#include "scene/near.h"

#define QN_SNAP_GONE UINT32_MAX

/* Half-space `half` of the leaf of `node` is replaced by half-space `to_half` of the leaf of `to_node`, whose form is taken turn times.
   half QN_SNAP_GONE: the leaf is nothing, two of its faces having become the two sides of one surface. */
typedef struct qn_snap { uint32_t node, half, to_node, to_half; int8_t turn; } qn_snap;

typedef struct qn_snaps {
  qn_snap *items; /* by node, then half */
  size_t count, capacity;
} qn_snaps;

/* Those of a node; snaps may be null. */
size_t qn_snaps_of(const qn_snaps *snaps, uint32_t node, const qn_snap **first);
/* Replaces what is moved of the node's half-spaces in world coordinates. 0: the leaf is nothing. ctx->failed is to be looked at. */
int qn_snaps_apply(qn_ctx *ctx, qn_kept_maps *maps, const quoin_model *model, const qn_snaps *snaps, uint32_t node, qn_half_form *halves, size_t count);

void qn_half_turn_over(qn_ctx *ctx, qn_half_form *half); /* its complement */

/* What is to be moved in a surveyed scene; *list says it to the user. */
QN_NODISCARD quoin_status qn_snaps_find(const quoin_scene *survey, qn_num limit, qn_snaps *out, quoin_near_list **list);
void qn_snaps_free(qn_snaps *snaps, qn_mem *mem);
/* Adds the list to the model's diagnostics, as far as they are kept. */
void qn_snaps_tell(quoin_model *model, const qn_snaps *snaps, const quoin_near_list *list);

/* snap_box.c: a box that holds the meet of half-spaces given in world coordinates, of which `was` (bounded) held the meet before some were moved,
   from the old forms. Returns whether it is bounded; else infinite. */
int qn_snap_box(qn_ctx *ctx, const qn_half_form *old, const qn_half_form *now, size_t count, const qn_region *was, qn_region *box);

/* near_list.c */
typedef struct qn_near_face { const char *name; uint32_t role, node; } qn_near_face;
typedef struct qn_near_row { double gap; const char *exact; qn_near_face face[2]; int opposite; } qn_near_row;
struct quoin_near_list {
  qn_mem *mem;
  const quoin_model *model; /* for places; the scene keeps it alive */
  qn_arena arena;
  qn_near_row *rows;
  size_t count, capacity;
  double limit;
  int cut;
};
/* Makes a list of pairs, which it takes the texts of. */
QN_NODISCARD quoin_status qn_near_list_make(const quoin_scene *scene, qn_near_pairs *pairs, qn_num limit, quoin_near_list **out);

size_t qn_near_list_bytes(const quoin_near_list *list); /* but for its texts */
/* The limit, a decimal: QUOIN_E_NUMBER when it is none, QUOIN_E_ARGUMENT when it is negative. */
QN_NODISCARD quoin_status qn_snap_limit(qn_ctx *ctx, const char *text, qn_num *out);

#endif
