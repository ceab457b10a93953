#include "grid.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int bench_camera_read(const char *path, bench_camera *out) {
  FILE *f = fopen(path, "r");
  char line[2048];
  int read = f && fgets(line, sizeof line, f);
  if (f) {
    fclose(f);
  }
  if (!read || strncmp(line, "ortho ", 6) != 0) {
    fprintf(stderr, "%s: not a camera file\n", path);
    return 0;
  }
  double v[14];
  char *at = line + 6;
  for (int i = 0; i < 14; i++) {
    char *end;
    v[i] = strtod(at, &end);
    if (end == at) {
      fprintf(stderr, "%s: 14 numbers expected\n", path);
      return 0;
    }
    at = end;
  }
  memcpy(out->o, v, 3 * sizeof *v);
  memcpy(out->u, v + 3, 3 * sizeof *v);
  memcpy(out->v, v + 6, 3 * sizeof *v);
  memcpy(out->d, v + 9, 3 * sizeof *v);
  out->width = (unsigned)v[12];
  out->height = (unsigned)v[13];
  return out->width > 0 && out->height > 0;
}
