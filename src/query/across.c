#include "query/across.h"

#include <math.h>
#include <string.h>

enum { AXIS_BITS = 10, RAY_BITS = 12, DIGIT_BITS = 10 };
_Static_assert(QN_ACROSS_MOST == 1 << RAY_BITS && 2 * AXIS_BITS + RAY_BITS == 32 && 2 * AXIS_BITS == 2 * DIGIT_BITS, "a place and a ray's number are one word");

/* Bits 0 to 9 of two numbers in turn: those of x at the even places, those of y at the odd ones. */
static uint32_t weave(uint32_t x, uint32_t y) {
  uint64_t both = x | (uint64_t)y << 32;
  both = (both | both << 8) & UINT64_C(0x00ff00ff00ff00ff);
  both = (both | both << 4) & UINT64_C(0x0f0f0f0f0f0f0f0f);
  both = (both | both << 2) & UINT64_C(0x3333333333333333);
  both = (both | both << 1) & UINT64_C(0x5555555555555555);
  return (uint32_t)(both | both >> 31);
}

/* Of a place not below the lowest one; the last step where rays are as far apart as doubles are, and there is no number. */
static uint32_t step_of(float above, float scale) {
  const float y = above * scale, last = (1 << AXIS_BITS) - 1;
  return (uint32_t)(int32_t)(y < last ? y : last);
}

/* Two directions across d, of about its length; about: they decide only what is faster. */
static void across(const double d[3], double u[3], double v[3]) {
  const double x = fabs(d[0]), y = fabs(d[1]), z = fabs(d[2]);
  const int least = x <= y && x <= z ? 0 : y <= z ? 1 : 2, a = (least + 1) % 3, b = (least + 2) % 3;
  const double size = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), e[3] = {d[0] / size, d[1] / size, d[2] / size};
  u[least] = 0, u[a] = -e[b], u[b] = e[a];
  v[0] = e[1] * u[2] - e[2] * u[1], v[1] = e[2] * u[0] - e[0] * u[2], v[2] = e[0] * u[1] - e[1] * u[0];
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void qn_sort_across(const quoin_ray *rays, size_t n, uint16_t *which, qn_across_room *room) {
  double u[3], v[3];
  across(rays[which[0]].d, u, v);
  const double *first = rays[which[0]].o, from[2] = {dot(first, u), dot(first, v)}; /* floats that are small where rays are near */
  float low[2] = {0, 0}, high[2] = {0, 0}, (*at)[2] = room->at;
  for (size_t i = 0; i < n; i++) {
    const double *o = rays[which[i]].o;
    const float x = (float)(dot(o, u) - from[0]), y = (float)(dot(o, v) - from[1]);
    at[i][0] = x, at[i][1] = y;
    low[0] = x < low[0] ? x : low[0], high[0] = x > high[0] ? x : high[0];
    low[1] = y < low[1] ? y : low[1], high[1] = y > high[1] ? y : high[1];
  }
  const float wide = high[0] - low[0] > high[1] - low[1] ? high[0] - low[0] : high[1] - low[1], scale = (1 << AXIS_BITS) / wide;
  uint32_t count[2][1 << DIGIT_BITS];
  memset(count, 0, sizeof count);
  for (size_t i = 0; i < n; i++) {
    const uint32_t place = weave(step_of(at[i][0] - low[0], scale), step_of(at[i][1] - low[1], scale));
    room->key[0][i] = place << RAY_BITS | which[i];
    count[0][place & ((1 << DIGIT_BITS) - 1)]++, count[1][place >> DIGIT_BITS]++;
  }
  for (int pass = 0; pass < 2; pass++) {
    uint32_t sum = 0;
    for (size_t k = 0; k < 1 << DIGIT_BITS; k++) {
      const uint32_t here = count[pass][k];
      count[pass][k] = sum, sum += here;
    }
    for (size_t i = 0; i < n; i++) {
      const uint32_t key = room->key[pass][i];
      room->key[!pass][count[pass][key >> (RAY_BITS + pass * DIGIT_BITS) & ((1 << DIGIT_BITS) - 1)]++] = key;
    }
  }
  for (size_t i = 0; i < n; i++) {
    which[i] = (uint16_t)(room->key[0][i] & (QN_ACROSS_MOST - 1));
  }
}
