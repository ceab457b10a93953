#include "quoin/types.h"

QUOIN_API const char *quoin_status_text(quoin_status status) {
  switch (status) {
  case QUOIN_OK: return "done";
  case QUOIN_E_MEMORY: return "out of memory";
  case QUOIN_E_ARGUMENT: return "bad argument";
  case QUOIN_E_MODEL: return "the model has errors";
  case QUOIN_E_LIMIT: return "a limit was met";
  case QUOIN_E_IO: return "reading or writing failed";
  case QUOIN_E_CANCELLED: return "cancelled";
  case QUOIN_E_NUMBER: return "not a number";
  }
  return "unknown status";
}

QUOIN_API const char *quoin_version(void) {
  return QUOIN_VERSION;
}
