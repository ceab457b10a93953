/* A scene as tools/bench.d/scenes.py flattens it: leaves and a tree, read without any code of the library. */
#ifndef BENCH_FLAT_H
#define BENCH_FLAT_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* kind 'S': centre(3) r; 'B': min(3) size(3); 'C': base(3) axis(3) h r. text: the decimals, which are the truth; v: the same as doubles. */
typedef struct flat_leaf {
  const char *text;
  double v[8];
  double centre[3], radius; /* a ball that holds the leaf with room to spare */
  uint32_t parent;          /* node; FLAT_NONE at the root */
  uint8_t kind, first;      /* first: the first child of its parent */
} flat_leaf;
#define FLAT_NONE UINT32_MAX

typedef struct flat_node {
  uint32_t parent;
  uint8_t op, first; /* op 'u' or 'd' */
} flat_node;

typedef struct flat_scene {
  char *bytes;
  flat_leaf *leaves;
  size_t leaf_count;
  flat_node *nodes;
  size_t node_count;
} flat_scene;

int flat_numbers(uint8_t kind); /* how many numbers a leaf has */
/* 0 when the file is missing or wrong (message on stderr unless it is missing). */
int flat_read(const char *path, flat_scene *out);
void flat_free(flat_scene *scene);

#ifdef __cplusplus
}
#endif
#endif
