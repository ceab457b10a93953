#include <quoin/quoin.h>
#include <stdio.h>
int main(void) {
  quoin_model *m = NULL; quoin_scene *s = NULL; quoin_work *w = NULL; quoin_side side = QUOIN_OUTSIDE;
  static const char text[] = "difference() { cube(2, center = true); sphere(0.1); }";
  const char *const point[3] = {"0.1", "0", "0"};
  int bad = quoin_model_new(NULL, &m) || quoin_model_read_text(m, QUOIN_ROOT, "text", text, sizeof text - 1, NULL) ||
            quoin_scene_compile(m, NULL, &s) || quoin_work_new(s, &w) || quoin_point_side_text(s, w, point, &side);
  printf("%s %s\n", quoin_version(), bad ? "failed" : side == QUOIN_BOUNDARY ? "boundary" : "wrong");
  quoin_work_free(w); quoin_scene_free(s); quoin_model_free(m);
  return bad || side != QUOIN_BOUNDARY;
}
