/* Fused operations. One lane: no instruction set is asked for. */
#define QN_SCALAR
#define QN_FUSED
#include "bounds_of_balls.h"
