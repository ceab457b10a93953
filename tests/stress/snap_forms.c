#include "snap_forms.h"

#include "model/solid.h"
#include "scene/scene.h"

#include <stdlib.h>

int snap_forms(const quoin_scene *scene, void (*each)(void *user, const snap_half *half), void *user) {
  uint32_t *number = calloc(scene->model->node_count + 1, sizeof *number), leaves = 0;
  int fine = number != NULL;
  for (uint32_t n = 0; fine && n < scene->model->node_count; n++) {
    number[n] = leaves;
    leaves += scene->model->nodes[n].kind == QN_NODE_LEAF;
  }
  for (uint32_t i = 0; fine && i < scene->leaf_count; i++) {
    const qn_leaf *leaf = &scene->leaves[i];
    for (uint32_t h = 0; fine && h < leaf->halves; h++) {
      const qn_half *half = &scene->halves[leaf->half0 + h];
      const qn_exact_surface *exact = qn_scene_exact(scene, half->surface, NULL);
      fine = exact != NULL;
      mpz_t q[10];
      snap_half out = {number[leaf->node], h, half->surface, half->side, {NULL}};
      for (int k = 0; fine && k < 10; k++) {
        out.q[k] = mpz_roinit_n(q[k], exact->q[k].d, exact->q[k].n);
      }
      if (fine) {
        each(user, &out);
      }
    }
  }
  free(number);
  return fine;
}
