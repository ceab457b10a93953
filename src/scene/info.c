#include "scene/scene.h"

#include <math.h>
#include <stdio.h>

QUOIN_API void quoin_scene_get_info(const quoin_scene *s, quoin_scene_info *out) {
  *out = (quoin_scene_info){.leaves = s->leaf_count,
                            .surfaces = s->half_count,
                            .distinct_surfaces = s->surface_count,
                            .empty = s->empty,
                            .memory = s->bytes,
                            .dropped = s->dropped,
                            .gates = s->program.gate_count,
                            .terms = s->normal.term_count,
                            .copies = s->normal.copies,
                            .shared = s->normal.shared};
  for (int k = 0; k < 3; k++) {
    out->box_min[k] = s->min[k];
    out->box_max[k] = s->max[k];
    out->unbounded |= !s->empty && (isinf(s->min[k]) || isinf(s->max[k]));
  }
}

QUOIN_API const char *quoin_part_name(const quoin_scene *s, quoin_part part) {
  return s && part < s->leaf_count ? s->name_text + s->part_names[part] : "";
}

QUOIN_API int quoin_role_text(uint32_t role, char *text, size_t size) {
  switch (role) {
  case QUOIN_BODY: return snprintf(text, size, "body");
  case QUOIN_CAP0: return snprintf(text, size, "cap0");
  case QUOIN_CAP1: return snprintf(text, size, "cap1");
  default: return snprintf(text, size, "face %lu", (unsigned long)(role - QUOIN_FACE));
  }
}
