#include "text/syntax.h"

int qn_syntax_init(qn_syntax *syntax, qn_mem *mem) {
  *syntax = (qn_syntax){.mem = mem};
  return qn_names_init(&syntax->names, mem);
}

void qn_syntax_free(qn_syntax *syntax) {
  qn_mem *mem = syntax->mem;
  if (!mem) {
    return;
  }
  qn_names_free(&syntax->names);
  qn_free(mem, syntax->statements, syntax->statement_capacity * sizeof *syntax->statements);
  qn_free(mem, syntax->arguments, syntax->argument_capacity * sizeof *syntax->arguments);
  qn_free(mem, syntax->assignments, syntax->assignment_capacity * sizeof *syntax->assignments);
  qn_free(mem, syntax->ops, syntax->op_capacity * sizeof *syntax->ops);
  qn_free(mem, syntax->numbers, syntax->number_capacity * sizeof *syntax->numbers);
  qn_free(mem, syntax->calls, syntax->call_capacity * sizeof *syntax->calls);
  *syntax = (qn_syntax){0};
}
