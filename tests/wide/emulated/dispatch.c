/* The pick of a body as on a machine that has everything, where AVX2 is there to emulate it with. */
#define __builtin_cpu_supports(feature) (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
#include "wide/dispatch.c"
