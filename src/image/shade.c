#include "image/shade.h"

#include <string.h>

extern const qn_shade qn_shade_sse2, qn_shade_avx2, qn_shade_avx512;

const qn_shade *qn_shade_of(const char *name) {
  const qn_shade *const bodies[] = {
#ifndef QN_NO_AVX512
    &qn_shade_avx512,
#endif
    &qn_shade_avx2};
  for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++) {
    if (strcmp(name, bodies[i]->name) == 0) {
      return bodies[i];
    }
  }
  return &qn_shade_sse2;
}
