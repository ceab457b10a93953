/* Tree to scene. Laws: the tree's print compiles to a scene of the same counts, box and emptiness; near surfaces are within their limit; after a
   snap fewer surfaces are distinct, never more. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

static int drop(void *user, const char *piece, size_t length) {
  (void)piece;
  *(size_t *)user += length;
  return 0;
}

static void near_surfaces(const quoin_scene *scene) {
  quoin_near_list *list;
  if (fuzz_answered(quoin_near_find(scene, NULL, &list), "near surfaces")) {
    double limit = quoin_near_limit(list), before = 0;
    for (size_t i = 0; i < quoin_near_count(list); i++) {
      quoin_near pair;
      if (quoin_near_get(list, i, &pair) != QUOIN_OK || !(pair.gap >= before) || pair.gap > limit) {
        fuzz_wrong("near pair %zu: its gap %g is out of order, or beyond %g", i, pair.gap, limit);
      }
      before = pair.gap;
    }
    quoin_near_free(list);
  }
}

static void same_box(const quoin_scene_info *a, const quoin_scene_info *b, const char *what) {
  if (a->leaves != b->leaves || a->surfaces != b->surfaces || a->distinct_surfaces != b->distinct_surfaces || a->empty != b->empty || a->unbounded != b->unbounded ||
      memcmp(a->box_min, b->box_min, sizeof a->box_min) != 0 || memcmp(a->box_max, b->box_max, sizeof a->box_max) != 0) {
    fuzz_wrong("%s: %zu leaves, %zu of %zu surfaces, empty %d, unbounded %d, against %zu, %zu of %zu, %d, %d", what, a->leaves, a->distinct_surfaces, a->surfaces, a->empty,
               a->unbounded, b->leaves, b->distinct_surfaces, b->surfaces, b->empty, b->unbounded);
  }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_begin(data, size);
  fuzz_bytes tail;
  size_t length = fuzz_split(data, size, &tail), printed = 0;
  fuzz_scene first, other = {0};
  fuzz_text tree = {0};
  quoin_scene_info info, again;
  if (fuzz_read(data, length, &first) && fuzz_answered(quoin_model_write_tree(first.model, fuzz_append, &tree), "printing the tree") && fuzz_compile(&first, NULL)) {
    quoin_scene_get_info(first.scene, &info);
    for (int i = 0; i < 3; i++) {
      if (!(info.box_min[i] <= info.box_max[i]) && !info.empty) {
        fuzz_wrong("a box from %g to %g", info.box_min[i], info.box_max[i]);
      }
    }
    fuzz_answered(quoin_scene_write_text(first.scene, drop, &printed), "printing the scene");
    quoin_camera camera;
    quoin_camera_default(first.scene, 1.5, QUOIN_PERSPECTIVE, &camera);
    if (!fuzz_late()) {
      near_surfaces(first.scene);
    }
    if (!fuzz_late() && fuzz_read((const uint8_t *)(tree.at ? tree.at : ""), tree.length, &other) && fuzz_compile(&other, NULL)) {
      quoin_scene_get_info(other.scene, &again);
      same_box(&info, &again, "the tree read back");
    }
    if (!fuzz_late() && fuzz_more(&tail)) {
      fuzz_close(&other);
      if (fuzz_read(data, length, &other) && fuzz_compile(&other, "0.001")) {
        quoin_scene_get_info(other.scene, &again);
        if (again.distinct_surfaces > info.distinct_surfaces) {
          fuzz_wrong("a snap makes %zu surfaces of %zu", again.distinct_surfaces, info.distinct_surfaces);
        }
      }
    }
  }
  fuzz_close(&first);
  fuzz_close(&other);
  free(tree.at);
  fuzz_end();
  return 0;
}
