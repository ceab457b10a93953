/* Products and sums rounded apart. One lane: no instruction set is asked for. */
#define QN_SCALAR
#include "bounds_of_balls.h"
