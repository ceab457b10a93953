/* Packets of 8 rays: single rays, and those that go together with few. */
#define QN_LANES_NOW 8
#define QN_FIRST QN_OF_ISA(qn_few)
#include "wide/packet_body.h"
