/* One thread's scratch: its making and its questions' beginnings. */
#include "base/limits.h"
#include "ray/scratch.h"

quoin_status qn_scratch_new(const quoin_scene *scene, qn_scratch **out) {
  *out = NULL;
  qn_mem *mem = scene->mem;
  qn_scratch *s = qn_alloc_zeroed(mem, sizeof *s);
  if (!s) {
    return QUOIN_E_MEMORY;
  }
  s->scene = scene;
  s->mem = mem;
  qn_ctx_init(&s->ctx, mem);
  s->memo = qn_alloc_zeroed(mem, scene->surface_count * sizeof *s->memo);
  s->range = qn_alloc_zeroed(mem, scene->half_count);
  int evals = qn_eval_init(&s->eval, &scene->program, mem) + qn_eval_init(&s->weave, &scene->program, mem);
  if (!s->memo || !s->range || evals < 2) {
    qn_scratch_free(s);
    return QUOIN_E_MEMORY;
  }
  *out = s;
  return QUOIN_OK;
}

void qn_scratch_free(qn_scratch *s) {
  if (!s) {
    return;
  }
  qn_mem *mem = s->mem;
  qn_ctx_free(&s->ctx);
  qn_eval_free(&s->eval, mem);
  qn_eval_free(&s->weave, mem);
  qn_free(mem, s->memo, s->scene->surface_count * sizeof *s->memo);
  qn_free(mem, s->range, s->scene->half_count);
  qn_free(mem, s->solved, s->solved_capacity * sizeof *s->solved);
  qn_free(mem, s->roots, s->root_capacity * sizeof *s->roots);
  qn_free(mem, s->candidates, s->candidate_capacity * sizeof *s->candidates);
  qn_free(mem, s->sorted, s->sorted_capacity * sizeof *s->sorted);
  qn_free(mem, s->spans, s->span_capacity * sizeof *s->spans);
  qn_free(mem, s->events, s->event_capacity * sizeof *s->events);
  qn_free(mem, s->sorting, s->sorting_capacity * sizeof *s->sorting);
  qn_free(mem, s->keys, s->key_capacity * sizeof *s->keys);
  qn_free(mem, s->touches, s->touch_capacity * sizeof *s->touches);
  qn_free(mem, s->inside, s->inside_capacity * sizeof *s->inside);
  qn_free(mem, s->boundary, s->boundary_capacity * sizeof *s->boundary);
  qn_free(mem, s->contacts, s->contact_capacity * sizeof *s->contacts);
  qn_free(mem, s, sizeof *s);
}

qn_counts *qn_scratch_counts(qn_scratch *s) { return &s->counts; }
qn_ctx *qn_scratch_ctx(qn_scratch *s) { return &s->ctx; }
qn_eval *qn_scratch_eval(qn_scratch *s) { return &s->eval; }

void qn_scratch_begin(qn_scratch *s) {
  qn_arena_release(&s->ctx.arena, (qn_mark){NULL, NULL});
  s->ctx.failed = QUOIN_OK;
  s->ctx.effort = 0;
  s->status = QUOIN_OK;
  s->line = NULL;
}

int qn_scratch_spend(qn_scratch *s, size_t count, unsigned each) {
  (void)qn_ctx_spend(&s->ctx, count, each);
  if (QN_UNLIKELY(s->ctx.effort > QN_MAX_QUESTION_EFFORT + QN_QUESTION_EFFORT_PER_LEAF * (uint64_t)s->scene->leaf_count)) {
    qn_scratch_fail(s, QUOIN_E_LIMIT);
    s->ctx.failed = s->status;
    return 0;
  }
  return 1;
}
