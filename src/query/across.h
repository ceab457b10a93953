/* Rays of one direction in the order of a Z curve across it: neighbours in that order pass close to one another. */
#ifndef QN_QUERY_ACROSS_H
#define QN_QUERY_ACROSS_H

#include "quoin/quoin.h"

enum { QN_ACROSS_MOST = 4096 };
typedef struct qn_across_room { uint32_t key[2][QN_ACROSS_MOST]; float at[QN_ACROSS_MOST + 1][2]; } qn_across_room;

/* which: the numbers of n rays, at most QN_ACROSS_MOST, each number below that; put in order. What is not a finite place goes anywhere. */
void qn_sort_across(const quoin_ray *rays, size_t n, uint16_t *which, qn_across_room *room);

/* Whether two rays have the same direction, number by number. */
static inline int qn_same_way(const quoin_ray *a, const quoin_ray *b) { return a->d[0] == b->d[0] && a->d[1] == b->d[1] && a->d[2] == b->d[2]; }

#endif
