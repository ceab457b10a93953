/* Packets of 64 rays: tiles. */
#define QN_LANES_NOW 64
#define QN_FIRST QN_OF_ISA(qn_first)
#define QN_SPANS QN_OF_ISA(qn_spans)
#include "wide/packet_body.h"
#include "wide/spans_body.h"

#include "wide/entry_body.h"
