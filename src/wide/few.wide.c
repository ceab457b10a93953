/* Packets of 8 rays: single rays, and those that go together with few. */
#define QN_LANES_NOW 8
#define QN_FIRST QN_OF_ISA(qn_few)
#define QN_SPANS QN_OF_ISA(qn_spans_few)
#include "wide/packet_body.h"
#include "wide/spans_body.h"
