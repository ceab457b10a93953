/* quoin: a model, the solid tree as the user said it: read from text or built by calls. */
#ifndef QUOIN_MODEL_H
#define QUOIN_MODEL_H

#include "quoin/types.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct quoin_model quoin_model;

/* A place in the tree. The root is a union and is always there. */
typedef uint32_t quoin_node;
#define QUOIN_ROOT ((quoin_node)0)

typedef enum quoin_op { QUOIN_UNION, QUOIN_DIFFERENCE, QUOIN_INTERSECTION } quoin_op;

/* What to do with $fn on a cylinder or cone. AUTO: $fn from 1 to 12 means that polygon (of at least 3 sides), more is a quality hint and is ignored with a
   note. HONOUR: every $fn means its polygon. IGNORE: none does. */
typedef enum quoin_facets { QUOIN_FACETS_AUTO, QUOIN_FACETS_HONOUR, QUOIN_FACETS_IGNORE } quoin_facets;

typedef struct quoin_read_options {
  quoin_facets facets;
  size_t max_errors; /* stop after so many errors; 0: the default, 100 */
} quoin_read_options;
QUOIN_API quoin_read_options quoin_read_options_default(void);

/* Makes an empty model. allocator may be null (malloc); it is copied. A model is used by one thread at a time until
   it is compiled; a compiled scene keeps what it needs of the model alive, and from then on the model is frozen
   (adding to it returns QUOIN_E_ARGUMENT). */
QUOIN_API quoin_status quoin_model_new(const quoin_allocator *allocator, quoin_model **out);
QUOIN_API void quoin_model_free(quoin_model *model); /* null is allowed */

/* Reads model text and adds its solids under `parent`. `name` stands in diagnostics ("text" when null). options may be null.
   QUOIN_E_MODEL: the text has errors, all of which are among the diagnostics; QUOIN_E_LIMIT: one of them is a limit. Nothing was added then, and since the
   errors stay among the diagnostics the model can no longer be compiled: read into a new one.
   Cost: linear in length. Numbers are read exactly. */
QUOIN_API quoin_status quoin_model_read_text(quoin_model *model, quoin_node parent, const char *name, const char *text,
                                             size_t length, const quoin_read_options *options);
/* The same from a file; "-" is standard input. QUOIN_E_IO: it cannot be read; a diagnostic says why (an error as any other). */
QUOIN_API quoin_status quoin_model_read_file(quoin_model *model, quoin_node parent, const char *path,
                                             const quoin_read_options *options);

/* Diagnostics so far, in the order of their places in the text. */
QUOIN_API size_t quoin_model_diag_count(const quoin_model *model);
QUOIN_API quoin_status quoin_model_diag(const quoin_model *model, size_t index, quoin_diag *out);

/* Building by calls. Every double means exactly itself (0.1 is 0x1.999999999999ap-4); for decimals use
   quoin_model_read_text with a piece of text. Each call adds a node under `parent` (a union, a difference, an
   intersection, a transform, or another wrapper; not a primitive) as its last child and gives its number in *out,
   which may be null. Numbers and names are copied. Angles are degrees. A size of zero or less makes an empty solid, with a warning.
   QUOIN_E_ARGUMENT: a number is not finite, parent cannot have children, a half-space's normal is zero, or a superquadric's exponent is negative. */
QUOIN_API quoin_status quoin_add_boolean(quoin_model *m, quoin_node parent, quoin_op op, quoin_node *out);
QUOIN_API quoin_status quoin_add_translate(quoin_model *m, quoin_node parent, const double v[3], quoin_node *out);
/* matrix: 3 rows of 4, row after row: x' = M x + t. A singular one makes its subtree empty, with a warning. */
QUOIN_API quoin_status quoin_add_multmatrix(quoin_model *m, quoin_node parent, const double matrix[12], quoin_node *out);
/* OpenSCAD's: about x, then y, then z, degrees. */
QUOIN_API quoin_status quoin_add_rotate(quoin_model *m, quoin_node parent, const double degrees[3], quoin_node *out);
QUOIN_API quoin_status quoin_add_scale(quoin_model *m, quoin_node parent, const double v[3], quoin_node *out);
QUOIN_API quoin_status quoin_add_color(quoin_model *m, quoin_node parent, const double rgba[4], quoin_node *out);
/* name: UTF-8, which is not checked; quoin_model_write_tree's text does not read back with another. */
QUOIN_API quoin_status quoin_add_name(quoin_model *m, quoin_node parent, const char *name, quoin_node *out);

QUOIN_API quoin_status quoin_add_sphere(quoin_model *m, quoin_node parent, double r, quoin_node *out);
QUOIN_API quoin_status quoin_add_ellipsoid(quoin_model *m, quoin_node parent, const double r[3], quoin_node *out);
QUOIN_API quoin_status quoin_add_cube(quoin_model *m, quoin_node parent, const double size[3], int center, quoin_node *out);
QUOIN_API quoin_status quoin_add_wedge(quoin_model *m, quoin_node parent, const double size[3], int center, quoin_node *out);
/* Frustum about z from z = 0 (or -h/2 when centred) with radius r1 at the bottom and r2 at the top. */
QUOIN_API quoin_status quoin_add_cylinder(quoin_model *m, quoin_node parent, double h, double r1, double r2, int center,
                                          quoin_node *out);
QUOIN_API quoin_status quoin_add_paraboloid(quoin_model *m, quoin_node parent, double h, double r, quoin_node *out);
/* One sheet, waist rc at z = 0, r at z = -h and z = h. */
QUOIN_API quoin_status quoin_add_hyperboloid(quoin_model *m, quoin_node parent, double h, double r, double rc, quoin_node *out);
/* Two sheets, vertices at z = -gap and z = gap, r at z = -h and z = h. QUOIN_E_ARGUMENT also where gap < 0 or gap >= h > 0: there is no such solid. */
QUOIN_API quoin_status quoin_add_hyperboloid2(quoin_model *m, quoin_node parent, double h, double r, double gap, quoin_node *out);
QUOIN_API quoin_status quoin_add_saddle(quoin_model *m, quoin_node parent, double a, double b, quoin_node *out);
/* A x2 + B y2 + C z2 + D xy + E xz + F yz + G x + H y + I z + J <= 0. */
QUOIN_API quoin_status quoin_add_quadric(quoin_model *m, quoin_node parent, const double coefficients[10], quoin_node *out);
/* n . x <= d */
QUOIN_API quoin_status quoin_add_halfspace(quoin_model *m, quoin_node parent, const double n[3], double d, quoin_node *out);
QUOIN_API quoin_status quoin_add_superquadric(quoin_model *m, quoin_node parent, const double r[3], double e, double n,
                                              quoin_node *out);

/* Canonical text of the tree; it reads back to the same tree, numbers exactly. */
QUOIN_API quoin_status quoin_model_write_tree(const quoin_model *model, quoin_write_fn write, void *user);

#ifdef __cplusplus
}
#endif
#endif
