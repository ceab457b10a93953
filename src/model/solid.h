/* The solid tree: what the user said. Nodes in one array, numbers in another; built by the reader or by calls. */
#ifndef QN_MODEL_SOLID_H
#define QN_MODEL_SOLID_H

#include "base/diag.h"
#include "number/num.h"
#include "quoin/model.h"
#include "shape/prim.h"

#include <stdatomic.h>

typedef enum qn_node_kind {
  QN_NODE_UNION,
  QN_NODE_DIFFERENCE,
  QN_NODE_INTERSECTION,
  QN_NODE_TRANSLATE,   /* 3 numbers */
  QN_NODE_ROTATE,      /* 3 angles in degrees, about x, then y, then z */
  QN_NODE_ROTATE_AXIS, /* angle, then the axis */
  QN_NODE_SCALE,       /* 3 */
  QN_NODE_MIRROR,      /* 3: the normal */
  QN_NODE_MULTMATRIX,  /* 12: rows of [M | t] */
  QN_NODE_COLOR,       /* payload: material; also material() {...} */
  QN_NODE_NAME,        /* payload: name */
  QN_NODE_LEAF         /* payload: primitive; numbers: its arguments, then 6 more when placed */
} qn_node_kind;
/* All but the Booleans and the leaf act on the union of their children. */

enum {
  QN_MOD_BACKGROUND = 1, /* %: counts as absent */
  QN_MOD_HIGHLIGHT = 2,  /* #: no geometric effect */
  QN_MOD_ONLY = 4,       /* !: only this subtree; * never gets here */
  QN_NODE_PLACED = 8     /* a leaf with base and axis */
};

#define QN_NO_NODE UINT32_MAX

typedef struct qn_node {
  uint8_t kind, flags;
  uint16_t unused;
  uint32_t payload;           /* by kind */
  uint32_t parent;            /* QN_NO_NODE for the root */
  uint32_t first, last, next; /* children in order; QN_NO_NODE at the end */
  uint32_t number0, numbers;  /* in model->numbers */
  qn_loc loc;
} qn_node;

enum { QN_HAS_COLOR = 1, QN_HAS_AMBIENT = 2, QN_HAS_DIFFUSE = 4, QN_HAS_SPECULAR = 8, QN_HAS_SHININESS = 16 };

/* What color() and material() say; only parts named in `has` are said. An outer one wins over an inner one, as in OpenSCAD. */
typedef struct qn_material {
  unsigned has;
  double color[4]; /* linear in what the user wrote: sRGB components, alpha */
  double ambient, diffuse, specular, shininess;
} qn_material;

typedef struct qn_light { double at[3], direction[3], color[3]; int directional; } qn_light; /* direction: the way the light travels */

typedef struct qn_view { /* camera(...), background(...) of the text */
  int has_camera, has_up, has_look, has_fov, has_projection, has_background;
  double eye[3], look[3], up[3], fov, near, background[3];
  int orthographic;
} qn_view;

struct quoin_model {
  qn_mem mem;
  atomic_int users; /* the model's owner and each scene */
  int frozen;
  qn_diags diags;
  qn_ctx ctx;       /* owns the numbers */
  qn_arena arena;   /* owns the names */
  qn_node *nodes;
  size_t node_count, node_capacity; /* node 0: the root, a union */
  qn_num *numbers;
  size_t number_count, number_capacity;
  const char **names;
  size_t name_count, name_capacity;
  qn_material *materials;
  size_t material_count, material_capacity;
  qn_light *lights;
  size_t light_count, light_capacity;
  size_t leaf_count;
  uint32_t only;    /* the node marked with '!', or QN_NO_NODE: then this node alone is the solid, and nothing around it counts */
  qn_view view;
};

/* The node around it in the solid: none around the root, and around what is marked with '!'. */
QN_INLINE uint32_t qn_above(const struct quoin_model *m, uint32_t node) { return node == m->only ? QN_NO_NODE : m->nodes[node].parent; }

/* Adds a node as parent's last child with room for `numbers` numbers (copied from `from`, whose numbers already live in model->ctx).
   Returns QN_NO_NODE when memory is refused. */
uint32_t qn_solid_add(quoin_model *model, uint32_t parent, qn_node_kind kind, uint32_t payload, qn_loc loc, const qn_num *from, size_t numbers);

/* The exact map of one transform node, rows of [M | t]; the identity for nodes that are not transforms. */
void qn_solid_map(qn_ctx *ctx, const quoin_model *model, uint32_t node, qn_num map[12]);

void qn_model_retain(quoin_model *model);
void qn_model_release(quoin_model *model); /* quoin_model_free is this */

#endif
