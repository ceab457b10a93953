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
  uint8_t settled;    /* map, shadow and tame are made; else only `exact`, of a translation, is */
} qn_composed;

/* Rotations made last, by what was written: their sines and cosines take longer than all the rest of a leaf. */
enum { QN_TURNS = 16, QN_TURNS_MADE = 256 };
typedef struct qn_turn { uint32_t node; int there; qn_num map[12]; } qn_turn; /* node: whose numbers they are */

typedef struct qn_maps {
  const quoin_model *model;
  qn_turn turns[QN_TURNS];
  unsigned turns_made; /* since turned was last emptied, after QN_TURNS_MADE */
  qn_ctx turned;       /* their numbers */
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
/* Makes the top's map, shadow and tame, which a translation leaves for later. */
void qn_maps_settle(qn_maps *maps);
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

/* --- tree.c: the solid tree met once, in order ------------------------------------------------------------------- */

/* A leaf as the walk met it. */
typedef struct qn_visit {
  uint32_t node, term, material;
  uint32_t name; /* of the name(...) around it, an offset in the scene's texts; QN_NO_NAME: it is called after its place */
} qn_visit;
#define QN_NO_NAME UINT32_MAX

/* A place x_axis = at where an aligned plane lies. Numbers are canonical, so equal places have equal bytes. */
typedef struct qn_place { qn_num at; uint32_t axis, hash; } qn_place;

/* Leaves that one thread makes in one go, and what it made of them, numbered from 0 in each batch. Which leaves are in a batch
   depends on the model alone, so nothing depends on the number of threads. */
typedef struct qn_batch {
  size_t visit0, visits;
  qn_half *halves; size_t half_count, half_capacity;
  qn_plane_shadow *planes; size_t plane_count, plane_capacity;
  qn_quadric_shadow *quadrics; size_t quadric_count, quadric_capacity;
  uint32_t *keys; size_t key_capacity; /* by half-space: of an aligned plane its place + 1, equal for equal planes; else 0 */
  qn_place *places; size_t place_count, place_capacity;
  uint32_t *global;                    /* by place: its key in the scene */
  size_t leaves, kept_halves, kept_planes, kept_quadrics, text; /* what the scene keeps of them; bytes of their names */
} qn_batch;

typedef struct qn_building {
  quoin_model *model;
  quoin_scene *scene;
  qn_mem *mem;
  unsigned threads;
  const quoin_progress *progress; /* may be null */
  qn_visit *visits; size_t visit_count, visit_room;
  qn_batch *batches; size_t batch_count, batch_capacity;
  qn_term *terms; size_t term_count, term_capacity;
  size_t leaf_room, material_capacity, name_capacity;
  struct qn_material_table *material_table;
  uint32_t *keys; size_t key_room;   /* by half-space of the scene: 0, or a number below key_count, equal for equal planes; and
                                        QN_KEY_FIRST with the first one of each batch */
  uint32_t key_count;
  uint8_t *kinds; size_t kind_room;  /* by leaf: qn_piece_kind */
  size_t deepest;                    /* levels of the walk */
  int whole;                         /* leaves that cannot matter are kept: for a survey of surfaces */
} qn_building;
#define QN_KEY_FIRST 0x80000000u

/* Lists the leaves and the terms, cuts the leaves into batches, makes names and materials. */
QN_NODISCARD quoin_status qn_tree_walk(qn_building *b);
/* The child to visit at or after `child`, QN_NO_NODE when there is none. */
uint32_t qn_present(const quoin_model *model, uint32_t child);
int qn_is_transform(const qn_node *node);

/* Progress of a part of the work, `done` of the whole: QUOIN_E_CANCELLED when it is to stop. */
QN_NODISCARD quoin_status qn_tell_progress(const quoin_progress *progress, double done);
/* qn_parallel whose progress runs from `from` to `to`. */
QN_NODISCARD quoin_status qn_parallel_part(qn_building *b, size_t n, quoin_status (*body)(void *user, unsigned thread, size_t i), void *user,
                                            double from, double to);

/* --- leaves.c, shadow.c, quick.c: leaves made of their nodes; the door of rounding -------------------------------- */

typedef struct qn_key_table {
  uint32_t *slots; /* place + 1, 0 empty; a power of two of them, at most half of them used */
  size_t slot_count;
} qn_key_table;

/* One thread's tools. */
typedef struct qn_maker {
  quoin_model *model;
  qn_mem *mem;
  qn_maps maps;
  qn_local local;
  qn_key_table keys; /* of the places of the batch in work */
  const struct qn_snaps *snaps; /* null: none */
  qn_kept_maps *kept_maps;
  qn_maps plain;     /* the identity, for leaves of which something was moved; stack null: not begun */
  qn_batch *batch;
} qn_maker;

/* Makes the scene's leaves, one for each visit, and the batches' half-spaces; terms of what is nothing or everything become
   constants. */
QN_NODISCARD quoin_status qn_leaves_make(qn_building *b);
void qn_batches_free(qn_building *b);

/* Makes the local half-spaces of a leaf in m->local. */
QN_NODISCARD quoin_status qn_local_make(qn_maker *m, uint32_t node);
/* The box of the leaf whose half-spaces are in m->local, under the top map; infinite where it is not bounded or not certain.
   Returns whether it is bounded. */
int qn_leaf_box(const qn_maker *m, double min[3], double max[3]);
/* extent.c: draws the box in to exact bounds, where the map takes axes to axes and numbers are rational. */
void qn_leaf_extent(qn_maker *m, qn_leaf *leaf);
void qn_bound_by_plane(qn_maker *m, qn_leaf *leaf, int world, qn_num at, int is_max);
/* The one axis that a row is about, or -1. */
int qn_row_axis(const qn_num row[4]);
/* The world axis to which the top map takes a local one, and the place on it of local x_axis = (shift - row[3]) / row[axis]. */
int qn_world_place(qn_maker *m, const qn_num row[4], int axis, qn_num shift, qn_num *at);
/* Adds the leaf's half-spaces, shadows and keys to the batch. *result: QN_FORM_EMPTY under a singular map. */
QN_NODISCARD quoin_status qn_leaf_add(qn_maker *m, qn_leaf *leaf, qn_form_result *result);
/* All of that for a leaf of the commonest kind, a sphere that is only shifted, of plain decimals. 0: it is none. */
int qn_leaf_quick(qn_maker *m, uint32_t node, qn_leaf *leaf, qn_form_result *result, quoin_status *status);
/* snap_box.c: all of that for a leaf of which something was moved. */
QN_NODISCARD quoin_status qn_leaf_snapped(qn_maker *m, uint32_t node, qn_leaf *leaf, qn_form_result *result);
/* Room for one more half-space of the batch, and one more quadric. */
QN_NODISCARD int qn_batch_room(qn_maker *m);

/* --- keys.c: aligned planes have names that can be compared without arithmetic ------------------------------------ */

/* The key in the batch of the plane x_axis = at; 0 when `at` is not a small number. UINT32_MAX: memory was refused. */
uint32_t qn_key_of(qn_maker *m, int axis, qn_num at);
/* Makes the batches' keys into keys of the scene: batch->global, b->key_count. */
QN_NODISCARD quoin_status qn_keys_join(qn_building *b);

/* --- pack.c ------------------------------------------------------------------------------------------------------- */

/* Lays the batches one behind another in the scene, without the leaves that the program does not ask for. */
QN_NODISCARD quoin_status qn_pack(qn_building *b);

/* --- parts.c: names and materials --------------------------------------------------------------------------------- */

/* Material `inner` (a node's) seen from inside material `outer` (an index into the scene's); null: the default one, index 0
   when it is the first. UINT32_MAX: memory was refused. */
uint32_t qn_material_under(qn_building *b, uint32_t outer, const qn_material *inner);
void qn_materials_free(qn_building *b);
/* Adds a name's text; its offset, UINT32_MAX when memory is refused or the texts are too long. */
uint32_t qn_name_add(qn_building *b, const char *text);
/* What a leaf without a name of its own is called; bytes with the final NUL, at most QN_PLACE_NAME. */
enum { QN_PLACE_NAME = 80 };
size_t qn_name_of_leaf(const quoin_model *model, uint32_t node, size_t ordinal, char text[QN_PLACE_NAME]);
size_t qn_name_length(const quoin_model *model, uint32_t node, size_t ordinal); /* those bytes */

/* --- simplify.c --------------------------------------------------------------------------------------------------- */

/* Turns terms that cannot matter into constants: parts of a meet that are apart, complements out of reach. Gives the box of
   the solid. */
QN_NODISCARD quoin_status qn_simplify(qn_building *b, double min[3], double max[3]);

/* --- identity.c --------------------------------------------------------------------------------------------------- */

/* Numbers the distinct surfaces in the order of their first use, and gives each half-space its surface and side. */
QN_NODISCARD quoin_status qn_identify(qn_building *b);

/* --- empty.c ------------------------------------------------------------------------------------------------------ */

/* Sets scene->empty when equal surfaces tell that no point is inside. Cost: linear in the half-spaces. */
QN_NODISCARD quoin_status qn_find_empty(qn_building *b);

/* --- exact.c ------------------------------------------------------------------------------------------------------ */

/* The exact form of a half-space given in world coordinates (not of a superquadric), primitive; *side: 1 when it is a positive
   multiple of the half-space's own, else -1. Zero q everywhere when the context failed. */
void qn_exact_of(qn_ctx *ctx, const qn_half_form *half, qn_exact_surface *out, int *side);
void qn_exact_free(qn_mem *mem, qn_exact_surface *exact);
/* kept_maps.c: the map from a node's own frame to the world, its ancestors' transforms composed. Threads: any. Returns the effort of what was found
   composed already. */
uint64_t qn_path_map(qn_ctx *ctx, qn_kept_maps *maps, uint32_t node, qn_num map[12]);
qn_kept_maps *qn_kept_maps_new(const quoin_model *model, qn_mem *mem); /* null: memory */
void qn_kept_maps_free(qn_kept_maps *maps);

/* Gives back what was taken from the context since the mark but the map's numbers: after every QN_COMPACT_STEPS maps composed, so that a deep tower of
   transforms does not keep every step. */
enum { QN_COMPACT_STEPS = 16 };
void qn_map_compact(qn_ctx *ctx, qn_mark mark, qn_num map[12]);
/* The exact half-spaces of a primitive's node under `map`. */
qn_form_result qn_node_forms(qn_ctx *ctx, const quoin_model *model, uint32_t node, const qn_num map[12], qn_half_form **halves,
                             size_t *count);
/* One of them in its place in the world, moved where it is moved. 0: there is none, or the context failed. *spared: see qn_path_map. */
int qn_node_half(qn_ctx *ctx, qn_kept_maps *maps, const quoin_model *model, const struct qn_snaps *snaps, uint32_t node, uint32_t half, qn_half_form *out,
                 uint64_t *spared);
/* A surface's exact form, in ctx, which gets its limits here. 0: the context failed. */
int qn_scene_make_exact(const quoin_scene *scene, uint32_t surface, qn_ctx *ctx, qn_exact_surface *out);
/* Makes `form` (copied) the surface's exact form unless it has one; returns the one it has. */
const qn_exact_surface *qn_scene_publish(const quoin_scene *scene, uint32_t surface, const qn_exact_surface *form, int *made);
/* A copy in one block of its own. */
qn_exact_surface *qn_exact_keep(qn_mem *mem, const qn_exact_surface *from);

#endif
