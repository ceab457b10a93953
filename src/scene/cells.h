/* Cells: for each large union of the normal form a grid whose cells list the terms with boxes that meet them, so that a point finds the few
   terms that may hold it without a walk. Made when first asked for; where terms crowd, or differ too much in size, the hierarchy serves.

   Which cell a coordinate is in is the same monotone function of floats for terms' boxes and for points: x <= y lies in no later cell than y. So a
   point between lo and hi, whose lo and hi fall into one cell, is in no term that is not listed there, whatever was rounded. */
#ifndef QN_SCENE_CELLS_H
#define QN_SCENE_CELLS_H

#include "scene/normal.h"

enum {
  QN_CELL_FEWEST = 64, /* terms in a union that gets a grid */
  QN_CELL_MOST = 8     /* terms that a cell lists; one that meets more lists none and says QN_CELL_CROWDED */
};

/* The cell along axis k: (x - low) scale, at least 0, at most last, cut off to a whole number. */
typedef struct qn_cell_grid {
  _Alignas(16) float low[4], scale[4], last[4]; /* [3] is 0 */
  uint32_t across, layer; /* cells in a row along x, and in a layer of such rows */
  uint32_t first;         /* of its cells, in qn_cells.start */
} qn_cell_grid;

typedef struct qn_cells {
  uint32_t *grid;                    /* by union: its grid, or QN_NO_GRID */
  qn_cell_grid *grids; size_t grid_count, grid_room, union_count;
  uint32_t *start; size_t start_count, start_capacity; /* of cell c: its terms are term[start[c]] to term[start[c + 1]] */
  uint32_t *term; size_t term_count, term_capacity;   /* and QN_CELL_MOST more entries, so that so many can be read from any place */
} qn_cells;
#define QN_NO_GRID UINT32_MAX
/* In a cell's only entry. */
#define QN_CELL_CROWDED UINT32_MAX

struct quoin_scene;
/* The cells of a scene, made on first use. Null when memory is refused or no union is large. Threads: any. */
const qn_cells *qn_scene_cells(const struct quoin_scene *scene);
QN_NODISCARD quoin_status qn_cells_build(const qn_normal *normal, qn_mem *mem, qn_cells **out);
void qn_cells_free(qn_cells *cells, qn_mem *mem);

#endif
