/* A scene in the making: what the files of this station share while one is compiled. Nothing of it outlives the compilation. */
#ifndef QN_SCENE_COMPILE_H
#define QN_SCENE_COMPILE_H

#include "scene/ball.h"
#include "scene/scene.h"

/* --- maps.c: the maps composed along the path from the root ------------------------------------------------------ */

/* World x = M local x, for the subtree under one transform. Rows of [A | t]. */
typedef struct qn_composed {
  qn_ball map[12];    /* known, all of them */
  double shadow[12];  /* rounded (QN_SHADOW) */
  qn_num exact[12];   /* when has_exact */
  qn_mark mark;       /* of maps->exact before them */
  uint32_t node;      /* the transform; QN_NO_NODE for the root's identity */
  uint8_t has_exact;
  uint8_t aligned;    /* every axis goes to an axis, and `exact` is there in small numbers: planes have keys */
  uint8_t shift_only; /* A is the identity */
  uint8_t tame;       /* every non-zero entry's size is within 2^-400 and 2^400: boxes may be taken in doubles */
} qn_composed;

typedef struct qn_maps {
  const quoin_model *model;
  qn_ctx exact;   /* owns the exact entries, last in, first out */
  qn_ctx scratch;
  qn_composed *stack;
  size_t count, capacity;
  qn_ball inverse[9]; /* of A of stack[inverse_of] */
  size_t inverse_of;  /* SIZE_MAX: of none */
  int inverse_state;  /* see qn_maps_inverse */
} qn_maps;

QN_NODISCARD quoin_status qn_maps_init(qn_maps *maps, const quoin_model *model, qn_mem *mem);
void qn_maps_free(qn_maps *maps, qn_mem *mem);
QN_NODISCARD quoin_status qn_maps_push(qn_maps *maps, qn_mem *mem, uint32_t node);
void qn_maps_pop(qn_maps *maps);
/* The exact entries of the top. */
QN_NODISCARD quoin_status qn_maps_exact(qn_maps *maps, const qn_num **map);
/* The inverse of the top's A: 1, or 0 when A is singular, or -1 when balls cannot tell. */
int qn_maps_inverse(qn_maps *maps);

/* out = outer after inner; out may be neither. */
void qn_map_compose(qn_ctx *ctx, const qn_num outer[12], const qn_num inner[12], qn_num out[12]);
/* Rows in the local frame of `map` brought to the world's. 0: the map is singular. */
int qn_map_forms(qn_ctx *ctx, const qn_num map[12], qn_half_form *halves, size_t count);

/* --- shadow.c: the door of rounding ------------------------------------------------------------------------------ */

/* The half-spaces of one primitive before any map, kept for the next leaf with the same numbers. */
typedef struct qn_local {
  qn_ctx ctx;
  uint32_t prim;
  uint32_t node;           /* whose they are; QN_NO_NODE: none */
  qn_form_result result;
  qn_half_form *halves;
  size_t count;
  qn_ball (*rows)[3][4];   /* by half-space */
  size_t rows_capacity;
  double *args;            /* the arguments, rounded to nearest */
  size_t args_count, args_capacity;
  double placement[6];
  const double *placed;    /* placement or null */
  int tame;                /* arguments are of usual size: their box may be taken in doubles */
} qn_local;

typedef struct qn_building {
  quoin_model *model;
  quoin_scene *scene;
  qn_mem *mem;
  qn_maps maps;
  qn_local local;
  size_t leaf_capacity, half_capacity, plane_capacity, quadric_capacity, material_capacity, name_capacity;
  uint32_t *keys; /* by half-space: an aligned plane's key, equal keys for equal planes; 0 none */
  size_t key_capacity;
  struct qn_key_table *key_table;
  struct qn_material_table *material_table;
  qn_term *terms;
  size_t term_count, term_capacity;
} qn_building;

/* Makes the local half-spaces of a leaf in b->local. */
QN_NODISCARD quoin_status qn_local_make(qn_building *b, uint32_t node);
/* The box of the leaf whose half-spaces are in b->local, under the top map; infinite where it is not bounded or not certain.
   Returns whether it is bounded. */
int qn_leaf_box(const qn_building *b, double min[3], double max[3]);
/* Adds the leaf's half-spaces and shadows to the scene, and their keys. *result: QN_FORM_EMPTY under a singular map. */
QN_NODISCARD quoin_status qn_leaf_add(qn_building *b, qn_leaf *leaf, qn_form_result *result);

/* --- keys.c: aligned planes have names that can be compared without arithmetic ------------------------------------ */

/* The key of the plane x_axis = at; 0 when `at` is not a small number. UINT32_MAX: memory was refused. */
uint32_t qn_key_of(qn_building *b, int axis, qn_num at);
void qn_keys_free(qn_building *b);

/* --- parts.c: names and materials --------------------------------------------------------------------------------- */

/* Material `inner` (a node's) seen from inside material `outer` (an index into the scene's); null: the default one, index 0
   when it is the first. UINT32_MAX: memory was refused. */
uint32_t qn_material_under(qn_building *b, uint32_t outer, const qn_material *inner);
void qn_materials_free(qn_building *b);
/* Adds a name's text; its offset, UINT32_MAX when memory is refused or the texts are too long. */
uint32_t qn_name_add(qn_building *b, const char *text);
uint32_t qn_name_of_leaf(qn_building *b, uint32_t node, size_t ordinal);

/* --- simplify.c --------------------------------------------------------------------------------------------------- */

/* Turns terms that cannot matter into constants: parts of a meet that are apart, complements out of reach. Gives the box of
   the solid. */
QN_NODISCARD quoin_status qn_simplify(qn_building *b, double min[3], double max[3]);

/* --- identity.c --------------------------------------------------------------------------------------------------- */

/* Numbers the distinct surfaces in the order of their first use, and gives each half-space its surface and side. */
QN_NODISCARD quoin_status qn_identify(qn_building *b);

/* --- exact.c ------------------------------------------------------------------------------------------------------ */

/* The exact form of a half-space given in world coordinates (not of a superquadric), primitive; *side: 1 when it is a positive
   multiple of the half-space's own, else -1. Zero q everywhere when the context failed. */
void qn_exact_of(qn_ctx *ctx, const qn_half_form *half, qn_exact_surface *out, int *side);
void qn_exact_free(qn_mem *mem, qn_exact_surface *exact);
/* The map from a node's own frame to the world: its ancestors' transforms composed. */
void qn_path_map(qn_ctx *ctx, const quoin_model *model, uint32_t node, qn_num map[12]);
/* The exact half-spaces of a primitive's node under `map`. */
qn_form_result qn_node_forms(qn_ctx *ctx, const quoin_model *model, uint32_t node, const qn_num map[12], qn_half_form **halves,
                             size_t *count);
/* Makes `form` (copied) the surface's exact form unless it has one; returns the one it has. */
const qn_exact_surface *qn_scene_publish(const quoin_scene *scene, uint32_t surface, const qn_exact_surface *form, int *made);
/* A copy in one block of its own. */
qn_exact_surface *qn_exact_keep(qn_mem *mem, const qn_exact_surface *from);

#endif
