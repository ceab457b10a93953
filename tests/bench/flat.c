#include "flat.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int flat_numbers(uint8_t kind) {
  return kind == 'S' ? 4 : kind == 'B' ? 6 : 8;
}

static char *whole_file(const char *path) {
  FILE *f = fopen(path, "rb");
  if (!f) {
    return NULL;
  }
  char *bytes = NULL;
  long size = fseek(f, 0, SEEK_END) == 0 ? ftell(f) : -1;
  if (size >= 0 && fseek(f, 0, SEEK_SET) == 0) {
    bytes = malloc((size_t)size + 1);
    if (bytes && fread(bytes, 1, (size_t)size, f) != (size_t)size) {
      free(bytes);
      bytes = NULL;
    }
    if (bytes) {
      bytes[size] = 0;
    }
  }
  fclose(f);
  return bytes;
}

static void bound(flat_leaf *l) {
  const double *v = l->v;
  double size = 0;
  for (int i = 0; i < 3; i++) {
    l->centre[i] = v[i];
    size += fabs(v[i]);
  }
  if (l->kind == 'S') {
    l->radius = v[3];
  } else if (l->kind == 'B') {
    for (int i = 0; i < 3; i++) {
      l->centre[i] += v[3 + i] / 2;
    }
    l->radius = sqrt(v[3] * v[3] + v[4] * v[4] + v[5] * v[5]) / 2;
  } else {
    double length = sqrt(v[3] * v[3] + v[4] * v[4] + v[5] * v[5]);
    for (int i = 0; i < 3; i++) {
      l->centre[i] += v[3 + i] / length * v[6] / 2;
    }
    l->radius = sqrt(v[6] * v[6] / 4 + v[7] * v[7]);
  }
  l->radius = l->radius * 1.0001 + size * 1e-6; /* only the oracle's time depends on it */
}

static int fail(const char *path, const char *what, flat_scene *out) {
  fprintf(stderr, "%s: %s\n", path, what);
  flat_free(out);
  return 0;
}

int flat_read(const char *path, flat_scene *out) {
  memset(out, 0, sizeof *out);
  char *at = out->bytes = whole_file(path);
  if (!at) {
    return 0;
  }
  size_t lines = 1;
  for (const char *p = at; (p = strchr(p, '\n')) != NULL; p++) {
    lines++;
  }
  out->leaves = calloc(lines, sizeof *out->leaves);
  out->nodes = calloc(lines, sizeof *out->nodes);
  struct level { uint32_t node, left; } *stack = calloc(lines, sizeof *stack);
  if (!out->leaves || !out->nodes || !stack) {
    free(stack);
    return fail(path, "out of memory", out);
  }
  while (*at == 'S' || *at == 'B' || *at == 'C') {
    flat_leaf *l = &out->leaves[out->leaf_count++];
    l->kind = (uint8_t)*at;
    l->text = ++at;
    for (int i = 0; i < flat_numbers(l->kind); i++) {
      l->v[i] = strtod(at, &at);
    }
    l->parent = FLAT_NONE;
    bound(l);
    at += *at == '\n';
  }
  if (strncmp(at, "T\n", 2) != 0) {
    free(stack);
    return fail(path, "no tree", out);
  }
  at += 2;
  size_t depth = 0;
  while (*at) {
    uint32_t parent = depth ? stack[depth - 1].node : FLAT_NONE;
    uint8_t first = depth && stack[depth - 1].left & 0x80000000u;
    if (depth) {
      stack[depth - 1].left = (stack[depth - 1].left & 0x7fffffffu) - 1;
    }
    if (*at == 'u' || *at == 'd') {
      flat_node *n = &out->nodes[out->node_count];
      *n = (flat_node){parent, (uint8_t)*at, first};
      uint32_t children = (uint32_t)strtoul(at + 1, &at, 10);
      stack[depth++] = (struct level){(uint32_t)out->node_count++, children | 0x80000000u};
    } else {
      size_t leaf = strtoul(at, &at, 10);
      if (leaf >= out->leaf_count) {
        free(stack);
        return fail(path, "no such leaf", out);
      }
      out->leaves[leaf].parent = parent;
      out->leaves[leaf].first = first;
    }
    while (depth && (stack[depth - 1].left & 0x7fffffffu) == 0) {
      depth--;
    }
    at += *at == '\n';
  }
  free(stack);
  return 1;
}

void flat_free(flat_scene *s) {
  free(s->bytes);
  free(s->leaves);
  free(s->nodes);
  memset(s, 0, sizeof *s);
}
