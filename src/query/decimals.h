/* Rays given as decimals, for packets: pairs of doubles, the line itself when it is wanted. */
#ifndef QN_QUERY_DECIMALS_H
#define QN_QUERY_DECIMALS_H

#include "query/work.h"

/* A decimal as the nearest double and its rest, to 2^-104 of it (docs/bounds.md, QN_ROUND_PAIR_EVAL). 0: it is none, or has too many digits or too
   unusual an exponent for this. */
int qn_decimal_pair(const char *text, double *high, double *low);

/* The exact line of six decimals, origin and direction; after qn_query_begin. */
quoin_status qn_decimal_line(quoin_work *work, const char *const text[6], qn_line *line);

#endif
