/* A single ray: the same body over numbers instead of vectors; nodes' eight boxes are still tested at once. */
#define QN_SCALAR
#define QN_LANES_NOW 1
#define QN_FIRST QN_OF_ISA(qn_one)
#include "wide/packet_body.h"
