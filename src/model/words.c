/* The table of words. Adding one is adding a row and its maker. */
#include "model/words.h"

#include <string.h>

#define SOLID QN_CLASS_SOLID
#define GROUP QN_CLASS_GROUP
#define SCENE QN_CLASS_SCENE

const qn_word qn_words[] = {
  {"union", GROUP, "", qn_make_union, NULL},
  {"difference", GROUP, "", qn_make_difference, NULL},
  {"intersection", GROUP, "", qn_make_intersection, NULL},
  {"group", GROUP, "", qn_make_union, NULL},
  {"render", GROUP, "convexity", qn_make_union, NULL},
  {"translate", GROUP, "v", qn_make_translate, NULL},
  {"rotate", GROUP, "a v", qn_make_rotate, NULL},
  {"scale", GROUP, "v", qn_make_scale, NULL},
  {"mirror", GROUP, "v", qn_make_mirror, NULL},
  {"multmatrix", GROUP, "m", qn_make_multmatrix, NULL},
  {"color", GROUP, "c alpha", qn_make_color, NULL},
  {"material", GROUP, "color ambient diffuse specular shininess", qn_make_material, NULL},
  {"name", GROUP, "name", qn_make_name, NULL},
  {"camera", SCENE, "eye look up fov near projection", qn_make_camera, NULL},
  {"light", SCENE, "at color | direction", qn_make_light, NULL},
  {"background", SCENE, "color", qn_make_background, NULL},
  {"cube", SOLID, "size center", qn_make_cube, NULL},
  {"sphere", SOLID, "r | d center base axis", qn_make_sphere, NULL},
  {"ellipsoid", SOLID, "r | center base axis", qn_make_ellipsoid, NULL},
  {"cylinder", SOLID, "h r1 r2 center | r d d1 d2 base axis", qn_make_cylinder, NULL},
  {"cone", SOLID, "h r center | d base axis", qn_make_cone, NULL},
  {"paraboloid", SOLID, "h r center | d base axis", qn_make_paraboloid, NULL},
  {"hyperboloid", SOLID, "h r rc | gap d center base axis", qn_make_hyperboloid, NULL},
  {"saddle", SOLID, "a b | center", qn_make_saddle, NULL},
  {"quadric", SOLID, "coefficients | matrix center", qn_make_quadric, NULL},
  {"halfspace", SOLID, "n d | center", qn_make_halfspace, NULL},
  {"superquadric", SOLID, "r e n | center", qn_make_superquadric, NULL},
  {"wedge", SOLID, "size center", qn_make_wedge, NULL},
  {"polyhedron", SOLID, "points faces convexity | triangles", qn_make_polyhedron, NULL},
  {"echo", QN_CLASS_SAY, "", qn_make_echo, NULL},
  {"assert", QN_CLASS_SAY, "condition message", qn_make_assert, NULL},
  {"else", QN_CLASS_QUIET, "", NULL, NULL},
  {"resize", QN_CLASS_LATER_GROUP, "", NULL, "scales its children to a given size"},
  {"hull", QN_CLASS_LATER_GROUP, "", NULL, "the convex hull of its children"},
  {"minkowski", QN_CLASS_LATER_GROUP, "", NULL, "the Minkowski sum of its children"},
  {"linear_extrude", QN_CLASS_LATER, "", NULL, "moves a plane figure along z"},
  {"rotate_extrude", QN_CLASS_LATER, "", NULL, "turns a plane figure about z"},
  {"module", QN_CLASS_FLATTENED, "", NULL, "defines a word"},
  {"function", QN_CLASS_FLATTENED, "", NULL, "defines a function"},
  {"children", QN_CLASS_FLATTENED, "", NULL, "the children of a module's call"},
  {"child", QN_CLASS_FLATTENED, "", NULL, "the children of a module's call"},
  {"for", QN_CLASS_FLATTENED, "", NULL, "repeats its children"},
  {"intersection_for", QN_CLASS_FLATTENED, "", NULL, "repeats its children and intersects them"},
  {"if", QN_CLASS_FLATTENED, "", NULL, "chooses by a condition"},
  {"let", QN_CLASS_FLATTENED, "", NULL, "names values for its children"},
  {"assign", QN_CLASS_FLATTENED, "", NULL, "names values for its children"},
  {"each", QN_CLASS_FLATTENED, "", NULL, "takes the elements of a list"},
  {"include", QN_CLASS_FLATTENED, "", NULL, "reads another file"},
  {"use", QN_CLASS_FLATTENED, "", NULL, "reads the definitions of another file"},
  {"import", QN_CLASS_LATER, "", NULL, "reads a mesh or a drawing from a file"},
  {"surface", QN_CLASS_LATER, "", NULL, "reads a height map from a file"},
  {"text", QN_CLASS_LATER, "", NULL, "a plane figure of letters"},
  {"projection", QN_CLASS_LATER, "", NULL, "the shadow of a solid in the plane"},
  {"offset", QN_CLASS_LATER, "", NULL, "grows or shrinks a plane figure"},
  {"square", QN_CLASS_LATER, "", NULL, "a plane figure"},
  {"circle", QN_CLASS_LATER, "", NULL, "a plane figure"},
  {"polygon", QN_CLASS_LATER, "", NULL, "a plane figure"},
  {"roof", QN_CLASS_LATER, "", NULL, "raises a plane figure"},
  {"import_dxf", QN_CLASS_LATER, "", NULL, "reads a drawing from a file"},
  {"import_stl", QN_CLASS_LATER, "", NULL, "reads a mesh from a file"},
  {"import_off", QN_CLASS_LATER, "", NULL, "reads a mesh from a file"},
  {"dxf_linear_extrude", QN_CLASS_LATER, "", NULL, "moves a drawing along z"},
  {"dxf_rotate_extrude", QN_CLASS_LATER, "", NULL, "turns a drawing about z"},
};
const size_t qn_word_count = sizeof qn_words / sizeof qn_words[0];

/* The names of a row's parameters, one after another: *at moves on. Length 0 at the end. */
static size_t parameter(const char **at, const char **name) {
  *at += strspn(*at, " |");
  *name = *at;
  size_t n = strcspn(*at, " |");
  *at += n;
  return n;
}

int qn_words_init(qn_evaluator *ev) {
  size_t total = 0;
  const char *name;
  for (size_t i = 0; i < qn_word_count; i++) {
    const char *at = qn_words[i].parameters;
    while (parameter(&at, &name) > 0) {
      total++;
    }
  }
  ev->parameters = qn_arena_take(&ev->ctx.arena, (total + 1) * sizeof *ev->parameters);
  ev->parameter0 = qn_arena_take(&ev->ctx.arena, (qn_word_count + 1) * sizeof *ev->parameter0);
  if (!ev->parameters || !ev->parameter0) {
    return 0;
  }
  qn_names *names = &ev->syntax->names;
  size_t k = 0;
  for (size_t i = 0; i < qn_word_count; i++) {
    const char *at = qn_words[i].parameters;
    ev->parameter0[i] = (uint16_t)k;
    for (size_t n; (n = parameter(&at, &name)) > 0; k++) {
      ev->parameters[k] = qn_names_find(names, name, n);
      if (ev->parameters[k] == QN_NO_NAME) {
        return 0;
      }
    }
    if (qn_names_find(names, qn_words[i].word, strlen(qn_words[i].word)) == QN_NO_NAME) {
      return 0;
    }
  }
  ev->parameter0[qn_word_count] = (uint16_t)k;
  return 1;
}

const char *qn_words_near(const char *word) {
  const char *best = NULL;
  unsigned most = strlen(word) <= 3 ? 1 : 2, least = most + 1;
  for (size_t i = 0; i < qn_word_count; i++) {
    unsigned d = qn_names_distance(word, qn_words[i].word, most);
    if (d < least) {
      least = d;
      best = qn_words[i].word;
    }
  }
  return best;
}
