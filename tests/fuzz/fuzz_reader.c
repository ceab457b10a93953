/* Text to tree. Laws: diagnostics have places and texts; a text with errors adds nothing; a tree's print reads back to the same print. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

static void look_at_diagnostics(const quoin_model *model, quoin_status status) {
  size_t errors = 0, n = quoin_model_diag_count(model);
  for (size_t i = 0; i < n; i++) {
    quoin_diag d;
    char line[2000];
    if (quoin_model_diag(model, i, &d) != QUOIN_OK || !d.code[0] || !d.problem[0] || d.length == 0 || (d.line == 0) != (d.column == 0)) {
      fuzz_wrong("diagnostic %zu has no code, text or place", i);
    }
    size_t need = quoin_diag_format(&d, line, sizeof line);
    if (strlen(line) != (need < sizeof line ? need : sizeof line - 1)) {
      fuzz_wrong("diagnostic %zu: its length is not %zu", i, need);
    }
    errors += d.severity == QUOIN_ERROR;
  }
  if (status != QUOIN_E_MEMORY && (errors != 0) != (status != QUOIN_OK)) {
    fuzz_wrong("%zu errors, but the status is %s", errors, quoin_status_text(status));
  }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_begin(data, size);
  fuzz_bytes tail;
  size_t length = fuzz_split(data, size, &tail);
  fuzz_scene first, second;
  int good = fuzz_read(data, length, &first);
  fuzz_text once = {0}, twice = {0};
  look_at_diagnostics(first.model, first.status);
  if (fuzz_answered(quoin_model_write_tree(first.model, fuzz_append, &once), "printing the tree")) {
    if (!good && once.length != 0) {
      fuzz_wrong("a text with errors added something: %.*s", (int)(once.length < 200 ? once.length : 200), once.at);
    }
    if (good && !fuzz_late()) {
      if (!fuzz_read((const uint8_t *)(once.at ? once.at : ""), once.length, &second)) {
        quoin_diag d = {0};
        quoin_model_diag(second.model, 0, &d);
        fuzz_wrong("the tree does not read back: %s at %u:%u", d.problem ? d.problem : "out of memory", (unsigned)d.line, (unsigned)d.column);
      }
      if (fuzz_answered(quoin_model_write_tree(second.model, fuzz_append, &twice), "printing the tree again") &&
          (once.length != twice.length || (once.length && memcmp(once.at, twice.at, once.length) != 0))) {
        fuzz_wrong("the tree reads back to another");
      }
      fuzz_close(&second);
    }
  }
  free(once.at);
  free(twice.at);
  fuzz_close(&first);
  fuzz_end();
  return 0;
}
