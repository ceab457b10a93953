/* What the laws' files share: a scene from a tree, rays and answers kept, comparisons, and the state of one trial. */
#ifndef QN_STRESS_LAWS_H
#define QN_STRESS_LAWS_H

#include "quoin/quoin.h"
#include "trees.h"

#include <math.h>

enum { ENDS = 96, RAYS = 64, ISAS = 3 };

typedef struct scene {
  quoin_model *model;
  quoin_scene *scene;
  quoin_work *work;
} scene;

typedef struct said {
  quoin_status status;
  size_t n, boundary;             /* stretches */
  quoin_end end[ENDS], side[ENDS]; /* of the stretches inside; of those in the boundary */
} said;

/* One trial: a tree that is a union of at least three operands, rays, and what was found wrong. */
typedef struct trial {
  const tree *tree;
  size_t n;
  const quoin_ray *rays;
  uint64_t seed;     /* for what the law draws itself */
  text first, second; /* the models compared */
  char why[1500];
  int wrong;         /* set by the first failure */
  uint64_t asked;    /* rays asked, about */
  uint64_t checks;   /* comparisons made */
} trial;

typedef struct law {
  const char *name;
  void (*run)(trial *t);
  int super; /* holds for superquadrics too */
} law;
extern const law SAME_ANSWER_LAWS[], SET_LAWS[], PLACE_LAWS[];
extern const size_t SAME_ANSWER_COUNT, SET_COUNT, PLACE_COUNT;
extern const char *const ISA_NAMES[ISAS];

void blame(trial *t, const char *format, ...);
/* Compiles a text; 0 when it is refused (which is blamed). */
int scene_open(trial *t, const char *model, unsigned threads, scene *out);
void scene_close(scene *s);
/* The operand of the trial's tree as text, appended. */
void put_operand(text *out, const trial *t, int k);
void clear_text(text *t);

void keep(said *to, quoin_status status, const quoin_intervals *got);
void ask_one(const scene *s, const quoin_ray *ray, said *out);
/* The ray times a decimal, and moved by three (null: none), asked as decimals. */
void ask_decimals(const scene *s, const quoin_ray *ray, const char *times, const char *const add[3], said *out);
enum { SAME_T = 0, SAME_PARTS = 1 };
/* Blames when the two differ. what: of which ray. */
int alike(trial *t, const said *a, const said *b, int parts, const char *what, const quoin_ray *ray);
double infinity(void);
#endif
