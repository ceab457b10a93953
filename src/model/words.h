/* Words: what each is, which arguments it takes, and what makes its node. The table is in words.c. */
#ifndef QN_MODEL_WORDS_H
#define QN_MODEL_WORDS_H

#include "model/evaluate.h"

enum { QN_MAX_PARAMETERS = 12 };

typedef enum qn_word_class {
  QN_CLASS_SOLID,  /* a primitive: no children */
  QN_CLASS_GROUP,  /* acts on its children */
  QN_CLASS_SCENE,  /* camera, light, background: at the top of the file, no children */
  QN_CLASS_SAY,    /* echo, assert: any children are a group */
  QN_CLASS_QUIET,  /* nothing of its own: its cause was told at its `if` */
  QN_CLASS_LATER,  /* not supported yet; its children are other things than solids, or depend on it */
  QN_CLASS_FLATTENED, /* as LATER; it is gone when OpenSCAD has flattened the file */
  QN_CLASS_LATER_GROUP /* not supported yet; its children are solids and are looked at */
} qn_word_class;

typedef struct qn_call qn_call;

typedef struct qn_word {
  const char *word;
  qn_word_class class;
  const char *parameters; /* names in the order of positions; those after '|' only by name */
  uint32_t (*make)(qn_call *call); /* the node that takes the children; QN_NO_NODE: none */
  const char *what;       /* of a LATER word: what it is */
} qn_word;

extern const qn_word qn_words[];
extern const size_t qn_word_count;

/* A statement being evaluated: its arguments by place in the word's parameters. */
struct qn_call {
  qn_evaluator *ev;
  const qn_word *word;
  const qn_statement *statement;
  uint32_t parent;
  qn_loc loc;
  size_t parameter_count;
  qn_value value[QN_MAX_PARAMETERS];  /* UNDEF when not given */
  uint32_t place[QN_MAX_PARAMETERS];  /* offset of the argument */
  uint32_t name[QN_MAX_PARAMETERS];   /* the parameter's name */
  qn_value fn;        /* $fn here: of its arguments, or of its surroundings */
  uint32_t fn_place;
  int bad;            /* an argument was in error, told */
  int not_finite;     /* an argument is inf or nan: parameter + 1 */
  int empty;          /* a size is zero or less, told */
};

/* The reader's suggestion for an unknown word, or null. */
const char *qn_words_near(const char *word);

/* --- arguments (arguments.c): each gives its default when the argument is absent, and sets call->bad (told) or
   call->not_finite when it cannot be had. ------------------------------------------------------------------------- */
int qn_arg_given(const qn_call *call, int parameter);
qn_num qn_arg_number(qn_call *call, int parameter, qn_num fallback);
int qn_arg_truth(qn_call *call, int parameter);
/* least..most numbers into out[most]; a single number fills all of them when `scalar`, missing ones stay as they are.
   Returns how many were given. */
size_t qn_arg_vector(qn_call *call, int parameter, size_t least, size_t most, int scalar, qn_num *out);
const char *qn_arg_string(qn_call *call, int parameter, size_t *length);
double qn_arg_double(qn_call *call, int parameter, double fallback);
/* A number of an argument as a double, for pictures; told where none is so large, and 0. */
double qn_arg_finite(qn_call *call, int parameter, qn_num n);
/* Tells about an argument: its place, or the word's where it was not given. */
void qn_arg_tell(qn_call *call, qn_code code, int parameter, const char *reason, const char *way_out, const char *problem, ...)
  QN_PRINTF(6, 7);
/* One number of an argument, inf and nan allowed where it says so with 2; 0 when it is none. */
int qn_arg_item(qn_call *call, int parameter, qn_value v, qn_num *out);

/* A size must be over 0; else the solid is empty, with a warning. */
void qn_arg_positive(qn_call *call, int parameter, const char *what, qn_num n);
void qn_arg_not_negative(qn_call *call, int parameter, const char *what, qn_num n);

/* --- nodes (arguments.c). Numbers are copied into the model. ------------------------------------------------------- */
uint32_t qn_call_node(qn_call *call, qn_node_kind kind, uint32_t payload, const qn_num *numbers, size_t count);
/* An empty solid in the place of this one: a union of nothing; or one that takes children and stays empty. */
uint32_t qn_call_empty(qn_call *call);
uint32_t qn_call_void(qn_call *call);
/* True when the call cannot make what it says: errors were told; inf and nan are told here. */
int qn_call_hindered(qn_call *call);
/* The leaf, or an empty solid. */
uint32_t qn_call_leaf(qn_call *call, qn_prim prim, const qn_num *numbers, size_t count);

/* Adds to a list of the model. UINT32_MAX when memory is refused. (solid.c) */
uint32_t qn_solid_name(quoin_model *model, const char *text, size_t length);
uint32_t qn_solid_material(quoin_model *model, const qn_material *material);

/* --- makers -------------------------------------------------------------------------------------------------------- */
uint32_t qn_make_union(qn_call *call);
uint32_t qn_make_difference(qn_call *call);
uint32_t qn_make_intersection(qn_call *call);
uint32_t qn_make_translate(qn_call *call);
uint32_t qn_make_rotate(qn_call *call);
uint32_t qn_make_scale(qn_call *call);
uint32_t qn_make_mirror(qn_call *call);
uint32_t qn_make_multmatrix(qn_call *call);
uint32_t qn_make_color(qn_call *call);
uint32_t qn_make_material(qn_call *call);
uint32_t qn_make_name(qn_call *call);
uint32_t qn_make_camera(qn_call *call);
uint32_t qn_make_light(qn_call *call);
uint32_t qn_make_background(qn_call *call);
uint32_t qn_make_echo(qn_call *call);
uint32_t qn_make_assert(qn_call *call);
uint32_t qn_make_cube(qn_call *call);
uint32_t qn_make_sphere(qn_call *call);
uint32_t qn_make_ellipsoid(qn_call *call);
uint32_t qn_make_cylinder(qn_call *call);
uint32_t qn_make_cone(qn_call *call);
uint32_t qn_make_paraboloid(qn_call *call);
uint32_t qn_make_hyperboloid(qn_call *call);
uint32_t qn_make_saddle(qn_call *call);
uint32_t qn_make_quadric(qn_call *call);
uint32_t qn_make_halfspace(qn_call *call);
uint32_t qn_make_superquadric(qn_call *call);
uint32_t qn_make_wedge(qn_call *call);
uint32_t qn_make_polyhedron(qn_call *call);

/* A colour's red, green, blue and alpha by its CSS name (any case). 0 when there is none. (colors.c) */
int qn_color_named(const char *name, size_t length, double rgba[4]);
const char *qn_color_near(const char *name);

#endif
