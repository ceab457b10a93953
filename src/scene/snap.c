/* The table of moved half-spaces: made from the pairs that were found, and applied to exact forms. */
#include "scene/snap.h"

#include "scene/compile.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

size_t qn_snaps_of(const qn_snaps *snaps, uint32_t node, const qn_snap **first) {
  if (!snaps) {
    return 0;
  }
  size_t low = 0, high = snaps->count, n = 0;
  while (low < high) {
    size_t mid = low + (high - low) / 2;
    if (snaps->items[mid].node < node) {
      low = mid + 1;
    } else {
      high = mid;
    }
  }
  *first = snaps->items + low;
  while (low + n < snaps->count && snaps->items[low + n].node == node) {
    n++;
  }
  return n;
}

void qn_half_turn_over(qn_ctx *ctx, qn_half_form *h) {
  if (h->kind == QN_PLANE) {
    for (int j = 0; j < 4; j++) {
      h->row[0][j] = qn_num_neg(ctx, h->row[0][j]);
    }
    return;
  }
  for (int i = 0; i < 3; i++) {
    h->s[i] = qn_num_neg(ctx, h->s[i]);
  }
  h->l = qn_num_neg(ctx, h->l);
  h->k = qn_num_neg(ctx, h->k);
}

int qn_snaps_apply(qn_ctx *ctx, qn_kept_maps *maps, const quoin_model *model, const qn_snaps *snaps, uint32_t node, qn_half_form *halves, size_t count) {
  const qn_snap *s = NULL;
  size_t n = qn_snaps_of(snaps, node, &s), made = 0;
  qn_half_form *forms = NULL;
  for (size_t i = 0; i < n && ctx->failed == QUOIN_OK; i++) {
    if (s[i].half == QN_SNAP_GONE) {
      return 0;
    }
    if (i == 0 || s[i].to_node != s[i - 1].to_node) {
      qn_num map[12];
      qn_path_map(ctx, maps, s[i].to_node, map);
      if (qn_node_forms(ctx, model, s[i].to_node, map, &forms, &made) != QN_FORM_OK) {
        return 0; /* memory */
      }
    }
    if (s[i].half < count && s[i].to_half < made) {
      uint32_t role = halves[s[i].half].role;
      halves[s[i].half] = forms[s[i].to_half];
      halves[s[i].half].role = role;
      if (s[i].turn < 0) {
        qn_half_turn_over(ctx, &halves[s[i].half]);
      }
    }
  }
  return 1;
}

/* --- from pairs to the table ----------------------------------------------------------------------------------------- */

static int by_node(const void *a, const void *b) {
  const qn_snap *x = a, *y = b;
  return x->node != y->node ? (x->node > y->node) - (x->node < y->node) : (x->half > y->half) - (x->half < y->half);
}

/* Where each surface goes: to[i] = i where it stands. */
typedef struct moves { const quoin_scene *scene; uint32_t *to; int8_t *turn; } moves;

/* Two sides of one surface among the leaf's half-spaces: seen[] holds, by surface, leaf + 1 and its side there. */
static int is_gone(const moves *m, uint32_t leaf, uint32_t *seen, int8_t *side) {
  const quoin_scene *s = m->scene;
  const qn_leaf *l = &s->leaves[leaf];
  int gone = 0, moved = 0;
  for (uint32_t h = l->half0; h < l->half0 + l->halves; h++) {
    uint32_t from = s->halves[h].surface, to = m->to[from];
    int8_t now = (int8_t)(s->halves[h].side * m->turn[from]);
    moved |= from != to;
    gone |= seen[to] == leaf + 1 && side[to] != now;
    seen[to] = leaf + 1;
    side[to] = now;
  }
  return gone && moved;
}

static quoin_status fill(const moves *m, qn_snaps *out, uint32_t *seen, int8_t *side) {
  const quoin_scene *s = m->scene;
  for (uint32_t i = 0; i < s->leaf_count; i++) {
    const qn_leaf *leaf = &s->leaves[i];
    if (!qn_grow(s->mem, &out->items, &out->capacity, out->count + leaf->halves + 1)) {
      return QUOIN_E_MEMORY;
    }
    if (is_gone(m, i, seen, side)) {
      out->items[out->count++] = (qn_snap){leaf->node, QN_SNAP_GONE, leaf->node, 0, 1};
      continue;
    }
    for (uint32_t h = leaf->half0; h < leaf->half0 + leaf->halves; h++) {
      uint32_t from = s->halves[h].surface, to = m->to[from];
      if (to != from) {
        const qn_surface *target = &s->surfaces[to];
        const qn_leaf *other = &s->leaves[target->leaf];
        /* a half-space is its side times its surface's form */
        int8_t turn = (int8_t)(s->halves[h].side * m->turn[from] * s->halves[target->half].side);
        out->items[out->count++] = (qn_snap){leaf->node, h - leaf->half0, other->node, target->half - other->half0, turn};
      }
    }
  }
  if (out->count > 1) {
    qsort(out->items, out->count, sizeof *out->items, by_node);
  }
  return QUOIN_OK;
}

quoin_status qn_snaps_find(const quoin_scene *survey, qn_num limit, qn_snaps *out, quoin_near_list **list) {
  qn_near_pairs pairs;
  *out = (qn_snaps){0};
  quoin_status status = qn_near_find(survey, limit, QN_NEAR_SNAP, &pairs);
  if (status == QUOIN_E_LIMIT && pairs.cut) {
    qn_report report = {.severity = QUOIN_ERROR, .code = "Q1104", .reason = "finding what is nearest to each would take too long", .way_out = "snap with less"};
    qn_diags_add(&survey->model->diags, &report, "too many surfaces are near one another, or nearly, to be snapped");
  }
  if (status != QUOIN_OK) {
    return status;
  }
  size_t n = survey->surface_count;
  qn_mem *mem = survey->mem;
  moves m = {survey, qn_alloc(mem, n * sizeof *m.to), qn_alloc(mem, n)};
  uint32_t *seen = qn_alloc_zeroed(mem, n * sizeof *seen);
  int8_t *side = qn_alloc_zeroed(mem, n);
  status = m.to && m.turn && seen && side ? QUOIN_OK : QUOIN_E_MEMORY;
  for (uint32_t i = 0; i < n && status == QUOIN_OK; i++) {
    m.to[i] = i;
    m.turn[i] = 1;
  }
  for (size_t i = 0; i < pairs.count && status == QUOIN_OK; i++) {
    m.to[pairs.items[i].small] = pairs.items[i].stands;
    m.turn[pairs.items[i].small] = pairs.items[i].turn;
  }
  status = status == QUOIN_OK ? fill(&m, out, seen, side) : status;
  status = status == QUOIN_OK ? qn_near_list_make(survey, &pairs, limit, list) : status;
  qn_free(mem, m.to, n * sizeof *m.to);
  qn_free(mem, m.turn, n);
  qn_free(mem, seen, n * sizeof *seen);
  qn_free(mem, side, n);
  qn_near_pairs_free(&pairs, mem);
  if (status != QUOIN_OK) {
    qn_snaps_free(out, mem);
  }
  return status;
}

void qn_snaps_free(qn_snaps *snaps, qn_mem *mem) {
  qn_free(mem, snaps->items, snaps->capacity * sizeof *snaps->items);
  *snaps = (qn_snaps){0};
}

/* --- told ------------------------------------------------------------------------------------------------------------ */

enum { TOLD = 20 }; /* diagnostics of one kind */

void qn_snaps_tell(quoin_model *model, const qn_snaps *snaps, const quoin_near_list *list) {
  for (size_t i = 0; i < list->count && i < TOLD; i++) {
    const qn_near_row *r = &list->rows[i];
    const qn_loc to = model->nodes[r->face[1].node].loc;
    char role[2][32], gap[64], place[256] = "";
    for (int k = 0; k < 2; k++) {
      quoin_role_text(r->face[k].role, role[k], sizeof role[k]);
    }
    if (to.line) {
      snprintf(place, sizeof place, " at %.200s:%lu:%lu", to.file ? model->diags.files[to.file - 1] : "", (unsigned long)to.line,
               (unsigned long)to.column);
    }
    snprintf(gap, sizeof gap, "%.17g", r->gap);
    qn_report report = {.severity = QUOIN_NOTE, .code = "Q1101", .loc = model->nodes[r->face[0].node].loc};
    qn_diags_add(&model->diags, &report, "%s of '%.200s' moved by %s onto %s of '%.200s'%s", role[0], r->face[0].name,
                 r->exact[0] ? r->exact : gap, role[1], r->face[1].name, place);
  }
  if (list->count > TOLD) {
    qn_report rest = {.severity = QUOIN_NOTE, .code = "Q0909"};
    qn_diags_add(&model->diags, &rest, "%zu more of Q1101 are not shown (a surface was moved onto another)", list->count - TOLD);
  }
  size_t gone = 0;
  for (size_t i = 0; i < snaps->count; i++) {
    if (snaps->items[i].half == QN_SNAP_GONE && gone++ < TOLD) {
      qn_report report = {.severity = QUOIN_WARNING, .code = "Q1102", .loc = model->nodes[snaps->items[i].node].loc,
                          .reason = "two of its faces became one surface", .way_out = "snap with less to keep it"};
      qn_diags_add(&model->diags, &report, "snapping leaves nothing of this solid");
    }
  }
  if (gone > TOLD) {
    qn_report rest = {.severity = QUOIN_NOTE, .code = "Q0909"};
    qn_diags_add(&model->diags, &rest, "%zu more of Q1102 are not shown (snapping leaves nothing of a solid)", gone - TOLD);
  }
}
