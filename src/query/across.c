#include "query/across.h"

#include <emmintrin.h>
#include <math.h>
#include <string.h>

enum { AXIS_BITS = 10, RAY_BITS = 12, DIGIT_BITS = 10 };
_Static_assert(QN_ACROSS_MOST == 1 << RAY_BITS && 2 * AXIS_BITS + RAY_BITS == 32 && 2 * AXIS_BITS == 2 * DIGIT_BITS, "a place and a ray's number are one word");

/* Bits 0 to 9 of two numbers in turn, of x at the even places and of y at the odd ones, in the lower word of each half: x0, y0, x1, y1. */
static __m128i weave(__m128i both) {
  static const uint32_t KEPT[4] = {0x00ff00ffu, 0x0f0f0f0fu, 0x33333333u, 0x55555555u};
  for (int i = 0; i < 4; i++) {
    both = _mm_and_si128(_mm_or_si128(both, _mm_slli_epi32(both, 8 >> i)), _mm_set1_epi32((int)KEPT[i]));
  }
  return _mm_or_si128(both, _mm_srli_epi64(both, 31));
}

/* Two directions across d, of about its length; about: they decide only what is faster. */
static void across(const double d[3], double u[3], double v[3]) {
  const double x = fabs(d[0]), y = fabs(d[1]), z = fabs(d[2]);
  const int least = x <= y && x <= z ? 0 : y <= z ? 1 : 2, a = (least + 1) % 3, b = (least + 2) % 3;
  const double size = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), e[3] = {d[0] / size, d[1] / size, d[2] / size};
  u[least] = 0, u[a] = -e[b], u[b] = e[a];
  v[0] = e[1] * u[2] - e[2] * u[1], v[1] = e[2] * u[0] - e[0] * u[2], v[2] = e[0] * u[1] - e[1] * u[0];
}

/* Places of rays seen from the first one, along both directions: floats that are small where rays are near; about, and anything where they are no numbers.
   Returns the lowest of each and the largest extent. */
static float see_places(const quoin_ray *rays, size_t n, const uint16_t *which, float (*at)[2], float low[2]) {
  double u[3], v[3];
  across(rays[which[0]].d, u, v);
  __m128d way[3], from = _mm_setzero_pd();
  for (int k = 0; k < 3; k++) {
    way[k] = _mm_set_pd(v[k], u[k]);
    from = _mm_add_pd(from, _mm_mul_pd(way[k], _mm_set1_pd(rays[which[0]].o[k])));
  }
  __m128 least = _mm_setzero_ps(), most = _mm_setzero_ps();
  for (size_t i = 0; i < n; i++) {
    const double *o = rays[which[i]].o;
    const __m128d place = _mm_add_pd(_mm_add_pd(_mm_mul_pd(way[0], _mm_set1_pd(o[0])), _mm_mul_pd(way[1], _mm_set1_pd(o[1]))), _mm_mul_pd(way[2], _mm_set1_pd(o[2])));
    const __m128 seen = _mm_cvtpd_ps(_mm_sub_pd(place, from));
    const int64_t both = _mm_cvtsi128_si64(_mm_castps_si128(seen));
    memcpy(at[i], &both, sizeof both);
    least = _mm_min_ps(seen, least), most = _mm_max_ps(seen, most); /* what is no number is passed over */
  }
  float x[4], y[4];
  _mm_storeu_ps(x, least), _mm_storeu_ps(y, most);
  low[0] = x[0], low[1] = x[1];
  return y[0] - x[0] > y[1] - x[1] ? y[0] - x[0] : y[1] - x[1];
}

void qn_sort_across(const quoin_ray *rays, size_t n, uint16_t *which, qn_across_room *room) {
  float low[2];
  const float wide = see_places(rays, n, which, room->at, low);
  const __m128 scale = _mm_set1_ps((1 << AXIS_BITS) / wide), lowest = _mm_setr_ps(low[0], low[1], low[0], low[1]), last = _mm_set1_ps((1 << AXIS_BITS) - 1);
  uint32_t count[2][1 << DIGIT_BITS];
  memset(count, 0, sizeof count);
  memset(room->at[n], 0, sizeof room->at[n]); /* the second of the last two */
  for (size_t i = 0; i < n; i += 2) {
    /* the last step where rays are as far apart as floats are, and there is no number */
    const __m128 step = _mm_min_ps(_mm_mul_ps(_mm_sub_ps(_mm_loadu_ps(room->at[i]), lowest), scale), last);
    _Alignas(16) uint32_t place[4];
    _mm_store_si128((void *)place, weave(_mm_cvttps_epi32(step)));
    for (size_t k = 0; k < 2 && i + k < n; k++) {
      const uint32_t here = place[2 * k] & ((1 << 2 * AXIS_BITS) - 1);
      room->key[0][i + k] = here << RAY_BITS | which[i + k];
      count[0][here & ((1 << DIGIT_BITS) - 1)]++, count[1][here >> DIGIT_BITS]++;
    }
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
