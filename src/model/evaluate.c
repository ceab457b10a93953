/* Statements to nodes of the solid tree, with a stack of its own: nesting costs memory only.

   Scopes: an assignment holds in the whole of its scope and in inner ones; of several to one name the last expression counts, at the
   place of the first (OpenSCAD). Assignments are evaluated when their scope is entered. An argument whose name begins
   with '$' is seen by the children too. */
#include "base/limits.h"
#include "model/words.h"

#include <stdio.h>
#include <string.h>

void qn_bind(qn_evaluator *ev, uint32_t name, qn_value value) {
  if (!qn_grow(ev->mem, &ev->undo, &ev->undo_capacity, ev->undo_count + 1)) {
    ev->failed = QUOIN_E_MEMORY;
    return;
  }
  qn_binding *b = &ev->bindings[name];
  ev->undo[ev->undo_count++] = (qn_undo){name, b->bound, b->value};
  b->value = value;
  b->bound = 1;
}

static void unbind_to(qn_evaluator *ev, size_t count) {
  while (ev->undo_count > count) {
    const qn_undo *u = &ev->undo[--ev->undo_count];
    ev->bindings[u->name].value = u->value;
    ev->bindings[u->name].bound = u->bound;
  }
}

/* Evaluates the assignments of a scope. */
static void enter_scope(qn_evaluator *ev, const qn_statement *st) {
  const qn_syntax *s = ev->syntax;
  ev->plan_count = 0;
  ev->scopes++;
  for (uint32_t i = st->assignment; i != QN_NO_STATEMENT; i = s->assignments[i].next) {
    const qn_argument *a = &s->assignments[i].value;
    qn_binding *b = &ev->bindings[a->name];
    if (b->scope == ev->scopes) {
      qn_loc first = qn_source_loc(ev->source, ev->plan[b->plan].offset, &ev->hint);
      char reason[64];
      snprintf(reason, sizeof reason, "first on line %u; the last value counts everywhere", (unsigned)first.line);
      qn_tell(ev->reporter, QN_Q0308, a->offset, s->names.items[a->name].length, reason, NULL, "'%.60s' is assigned twice in one scope",
              s->names.items[a->name].text);
      ev->plan[b->plan].from = a->from; /* the place stays the first one's */
      ev->plan[b->plan].to = a->to;
      continue;
    }
    if (!qn_grow(ev->mem, &ev->plan, &ev->plan_capacity, ev->plan_count + 1)) {
      ev->failed = QUOIN_E_MEMORY;
      return;
    }
    b->scope = ev->scopes;
    b->plan = (uint32_t)ev->plan_count;
    b->later = a->offset + 1;
    ev->plan[ev->plan_count++] = *a;
  }
  for (size_t i = 0; i < ev->plan_count && !ev->failed && !ev->reporter->stop; i++) {
    const qn_argument a = ev->plan[i];
    qn_value v = qn_evaluate_expression(ev, a.from, a.to);
    ev->bindings[a.name].later = 0;
    qn_bind(ev, a.name, v);
  }
}

/* --- one statement ------------------------------------------------------------------------------------------------- */

static void unknown_word(qn_evaluator *ev, const qn_statement *st) {
  const qn_name *name = &ev->syntax->names.items[st->word];
  if (name->declared || ev->syntax->includes) {
    return; /* told where it was declared or included */
  }
  const char *near = qn_words_near(name->text);
  char way_out[128] = "docs/language.md lists the words";
  if (ev->functions[st->word]) {
    snprintf(way_out, sizeof way_out, "it is a function; use it in an expression");
  } else if (near) {
    snprintf(way_out, sizeof way_out, "did you mean '%.60s'?", near);
  }
  qn_tell(ev->reporter, QN_Q0401, st->offset, name->length, NULL, way_out, "unknown word '%.60s'", name->text);
}

static int is_special(const qn_evaluator *ev, uint32_t name) {
  return name != QN_WORD_NONE && ev->syntax->names.items[name].text[0] == '$';
}

/* Evaluates the arguments of a call into its parameters. */
static void bind_arguments(qn_call *call, size_t word) {
  qn_evaluator *ev = call->ev;
  const qn_word *w = call->word;
  const uint32_t *parameters = ev->parameters + ev->parameter0[word];
  const char *only_named = strchr(w->parameters, '|');
  size_t count = (size_t)(ev->parameter0[word + 1] - ev->parameter0[word]), positional = 0;
  call->parameter_count = count;
  for (size_t i = 0; i < count; i++) {
    call->value[i] = QN_UNDEF;
    call->place[i] = 0;
    call->name[i] = parameters[i];
  }
  for (const char *at = w->parameters; *at && at != only_named; at++) { /* words before the '|' */
    positional += *at != ' ' && (at == w->parameters || at[-1] == ' ');
  }
  const qn_binding *fn = &ev->bindings[QN_WORD_FN];
  call->fn = fn->value;
  size_t next = 0;
  int too_many = 0;
  for (uint32_t i = 0; i < call->statement->arguments; i++) {
    qn_argument a = ev->syntax->arguments[call->statement->argument0 + i];
    qn_value v = qn_evaluate_expression(ev, a.from, a.to);
    if (is_special(ev, a.name)) {
      if (a.name == QN_WORD_FN) {
        call->fn = v;
        call->fn_place = a.offset;
      }
      if (w->class == QN_CLASS_GROUP || w->class == QN_CLASS_SAY) {
        qn_bind(ev, a.name, v);
      }
      call->bad |= v.kind == QN_V_BAD;
      continue;
    }
    size_t at = count;
    if (a.name == QN_WORD_NONE) {
      if (next < positional) {
        at = next++;
      } else if (!too_many) {
        too_many = 1;
        qn_tell(ev->reporter, QN_Q0404, a.offset, 1, "it is ignored", NULL, "%s: too many arguments without a name", w->word);
      }
    } else {
      for (at = 0; at < count && parameters[at] != a.name;) {
        at++;
      }
      if (at == count) {
        const qn_name *name = &ev->syntax->names.items[a.name];
        const char *best = NULL;
        unsigned least = 2;
        for (size_t k = 0; k < count; k++) {
          const char *other = ev->syntax->names.items[parameters[k]].text;
          unsigned d = qn_names_distance(name->text, other, 1);
          if (d < least && strlen(other) > 1) {
            least = d;
            best = other;
          }
        }
        char way_out[96];
        snprintf(way_out, sizeof way_out, "did you mean '%.60s'?", best ? best : "");
        qn_tell(ev->reporter, QN_Q0403, a.offset, name->length, "it is ignored", best ? way_out : NULL,
                "%s: unknown argument '%.60s'", w->word,
                name->text);
      }
    }
    if (at < count) {
      if (call->place[at]) {
        qn_tell(ev->reporter, QN_Q0405, a.offset, 1, "the last one counts", NULL, "%s: '%s' is given twice", w->word,
                ev->syntax->names.items[parameters[at]].text);
      }
      call->value[at] = v;
      call->place[at] = a.offset;
    }
    call->bad |= v.kind == QN_V_BAD;
  }
}

static int at_top(const qn_evaluator *ev) {
  return ev->level_count == 1;
}

/* What a scene word or a primitive may not have. */
static int children_refused(qn_call *call) {
  const qn_statement *st = call->statement;
  if (st->first == QN_NO_STATEMENT) {
    return 0;
  }
  const qn_statement *child = &call->ev->syntax->statements[st->first];
  const qn_name *name = &call->ev->syntax->names.items[child->word];
  qn_tell(call->ev->reporter, QN_Q0407, child->offset, name->length, NULL, "is a ';' missing before it?", "%s takes no children",
          call->word->word);
  return 1;
}

/* Evaluates a statement's arguments and makes its node. *into: where its children go, QN_NO_NODE when they are not looked at. */
static void begin(qn_evaluator *ev, const qn_statement *st, uint32_t parent, uint32_t *into) {
  *into = QN_NO_NODE;
  size_t word = ev->words[st->word];
  if (word == 0) {
    unknown_word(ev, st);
    for (uint32_t i = 0; i < st->arguments; i++) { /* for their errors */
      const qn_argument *a = &ev->syntax->arguments[st->argument0 + i];
      qn_evaluate_expression(ev, a->from, a->to);
    }
    *into = ev->syntax->names.items[st->word].declared ? QN_NO_NODE : parent;
    return;
  }
  const qn_word *w = &qn_words[--word];
  switch (w->class) {
  case QN_CLASS_QUIET:
    return;
  case QN_CLASS_LATER:
  case QN_CLASS_FLATTENED:
  case QN_CLASS_LATER_GROUP:
    qn_tell(ev->reporter, QN_Q0402, st->offset, ev->syntax->names.items[st->word].length, w->what,
            w->class == QN_CLASS_FLATTENED ? QN_FLATTEN : NULL, "'%s' is not supported yet", w->word);
    *into = w->class == QN_CLASS_LATER_GROUP ? parent : QN_NO_NODE;
    return;
  case QN_CLASS_SOLID:
  case QN_CLASS_GROUP:
  case QN_CLASS_SCENE:
  case QN_CLASS_SAY:
    break;
  }
  qn_call call;
  call.ev = ev;
  call.word = w;
  call.statement = st;
  call.parent = parent;
  call.loc = qn_source_loc(ev->source, st->offset, &ev->hint);
  call.fn_place = 0;
  call.bad = (st->flags & QN_STATEMENT_BAD) != 0;
  call.not_finite = call.empty = 0;
  if (w->class != QN_CLASS_SAY || w->parameters[0]) {
    bind_arguments(&call, word);
  }
  if (call.bad) { /* told; the children are still looked at */
    *into = w->class == QN_CLASS_GROUP || w->class == QN_CLASS_SAY ? parent : QN_NO_NODE;
    if (w->class != QN_CLASS_GROUP && w->class != QN_CLASS_SAY && st->first != QN_NO_STATEMENT && !(st->flags & QN_STATEMENT_BAD)) {
      children_refused(&call);
    }
    return;
  }
  if (w->class == QN_CLASS_SCENE && !at_top(ev)) {
    qn_tell(ev->reporter, QN_Q0409, st->offset, ev->syntax->names.items[st->word].length, "it is no solid, and transforms do not move it",
            "write it outside all braces", "%s stands inside a solid", w->word);
    return;
  }
  if ((w->class == QN_CLASS_SOLID || w->class == QN_CLASS_SCENE) && children_refused(&call)) {
    return;
  }
  uint32_t node = w->make(&call);
  quoin_status failed = ev->ctx.failed ? ev->ctx.failed : ev->model->ctx.failed;
  if (failed == QUOIN_E_LIMIT && qn_too_much(ev, st->offset)) {
    return;
  }
  if (failed == QUOIN_E_LIMIT) {
    ev->ctx.failed = ev->model->ctx.failed = QUOIN_OK;
    qn_arg_tell(&call, QN_Q0904, -1, "an exact result of more than 131072 bits", NULL, "exact number too large");
  } else if (failed) {
    ev->failed = failed;
  }
  if (node == QN_NO_NODE || ev->failed) {
    return;
  }
  quoin_model *m = ev->model;
  m->nodes[node].flags |= (uint8_t)(st->flags & (QN_SIGN_BACKGROUND | QN_SIGN_HIGHLIGHT));
  if (st->flags & QN_SIGN_ONLY) {
    if (m->only == QN_NO_NODE) {
      m->only = node;
      m->nodes[node].flags |= QN_MOD_ONLY;
    } else {
      qn_tell(ev->reporter, QN_Q0411, st->offset, ev->syntax->names.items[st->word].length, "only the first one counts", NULL,
              "a second '!'");
    }
  }
  if (w->class == QN_CLASS_GROUP || w->class == QN_CLASS_SAY) {
    *into = node;
  }
}

static int open_level(qn_evaluator *ev, uint32_t statement, uint32_t node, size_t undo, qn_mark mark) {
  if (!qn_grow(ev->mem, &ev->levels, &ev->level_capacity, ev->level_count + 1)) {
    ev->failed = QUOIN_E_MEMORY;
    return 0;
  }
  const qn_statement *st = &ev->syntax->statements[statement];
  ev->levels[ev->level_count++] = (qn_level){.statement = statement, .child = st->first, .node = node, .undo = undo, .mark = mark};
  enter_scope(ev, st);
  return 1;
}

static void run(qn_evaluator *ev, uint32_t root) {
  if (!open_level(ev, 0, root, ev->undo_count, qn_arena_mark(&ev->ctx.arena))) {
    return;
  }
  while (ev->level_count > 0 && !ev->failed && !ev->reporter->stop) {
    qn_level *level = &ev->levels[ev->level_count - 1];
    if (level->child == QN_NO_STATEMENT) {
      unbind_to(ev, level->undo);
      qn_arena_release(&ev->ctx.arena, level->mark);
      ev->level_count--;
      continue;
    }
    uint32_t n = level->child;
    const qn_statement *st = &ev->syntax->statements[n];
    level->child = st->next;
    if (st->flags & QN_SIGN_DISABLE) {
      continue;
    }
    qn_mark mark = qn_arena_mark(&ev->ctx.arena);
    size_t undo = ev->undo_count;
    uint32_t into;
    begin(ev, st, level->node, &into);
    if (ev->failed) {
      return;
    }
    if (into != QN_NO_NODE && (st->first != QN_NO_STATEMENT || st->assignment != QN_NO_STATEMENT)) {
      open_level(ev, n, into, undo, mark);
    } else {
      unbind_to(ev, undo);
      qn_arena_release(&ev->ctx.arena, mark);
    }
  }
}

/* --- set-up ------------------------------------------------------------------------------------------------------- */

static int find(qn_evaluator *ev, const char *name, uint32_t *out) {
  *out = qn_names_find(&ev->syntax->names, name, strlen(name));
  return *out != QN_NO_NAME;
}

/* Names of the language first, then the tables by name, which need to know how many names there are. */
static int set_up(qn_evaluator *ev) {
  static const char *const constants[] = {"PI", "$fn", "$fa", "$fs", "$t", "$preview"};
  static const int values[] = {0, 0, 12, 2, 0, 0};
  enum { CONSTANTS = sizeof constants / sizeof constants[0] };
  uint32_t name[CONSTANTS];
  for (int i = 0; i < CONSTANTS; i++) {
    if (!find(ev, constants[i], &name[i])) {
      return 0;
    }
  }
  if (!qn_words_init(ev)) {
    return 0;
  }
  /* The functions' names add at most qn_function_count. */
  size_t most = ev->syntax->names.count + qn_function_count;
  ev->name_capacity = most;
  ev->bindings = qn_alloc_zeroed(ev->mem, most * sizeof *ev->bindings);
  ev->words = qn_alloc_zeroed(ev->mem, most * sizeof *ev->words);
  ev->functions = qn_alloc_zeroed(ev->mem, most * sizeof *ev->functions);
  if (!ev->bindings || !ev->words || !ev->functions || !qn_functions_init(ev)) {
    return 0;
  }
  ev->name_count = ev->syntax->names.count;
  for (size_t i = 0; i < qn_word_count; i++) {
    uint32_t word;
    if (!find(ev, qn_words[i].word, &word)) {
      return 0;
    }
    ev->words[word] = (uint16_t)(i + 1);
  }
  for (int i = 0; i < CONSTANTS; i++) {
    qn_bind(ev, name[i], i == 0   ? qn_value_number(qn_num_pi(&ev->ctx))
                         : i == 5 ? qn_value_bool(0)
                                  : qn_value_number(qn_num_from_int(&ev->ctx, values[i])));
  }
  return !ev->failed && !ev->ctx.failed;
}

quoin_status qn_evaluate(quoin_model *model, uint32_t parent, qn_syntax *syntax, const qn_source *source, qn_reporter *reporter,
                         const quoin_read_options *options) {
  qn_evaluator ev = {.model = model, .mem = &model->mem, .syntax = syntax, .source = source, .reporter = reporter, .options = *options};
  qn_ctx_init(&ev.ctx, ev.mem);
  ev.ctx.max_bits = QN_MAX_BITS;
  ev.ctx.max_effort = QN_MAX_EFFORT + QN_EFFORT_PER_BYTE * (uint64_t)source->length;
  if (set_up(&ev)) {
    run(&ev, parent);
  } else {
    ev.failed = QUOIN_E_MEMORY;
  }
  qn_mem *mem = ev.mem;
  qn_free(mem, ev.stack, ev.stack_capacity * sizeof *ev.stack);
  qn_free(mem, ev.bindings, ev.name_capacity * sizeof *ev.bindings);
  qn_free(mem, ev.words, ev.name_capacity * sizeof *ev.words);
  qn_free(mem, ev.functions, ev.name_capacity * sizeof *ev.functions);
  qn_free(mem, ev.undo, ev.undo_capacity * sizeof *ev.undo);
  qn_free(mem, ev.levels, ev.level_capacity * sizeof *ev.levels);
  qn_free(mem, ev.plan, ev.plan_capacity * sizeof *ev.plan);
  qn_ctx_free(&ev.ctx);
  return ev.failed;
}
