/* Four floats at once, where the machine's baseline has them; else one by one. The same results either way: each operation is
   IEEE's, and the smaller and larger of two are a < b ? a : b and a > b ? a : b. */
#ifndef QN_SCENE_FOUR_H
#define QN_SCENE_FOUR_H

#include "base/attrs.h"

#if defined(__SSE2__)
#include <emmintrin.h>
typedef __m128 qn_four;
QN_INLINE qn_four qn_four_load(const float v[4]) { return _mm_load_ps(v); } /* aligned to 16 bytes, as in store */
QN_INLINE void qn_four_store(float v[4], qn_four a) { _mm_store_ps(v, a); }
QN_INLINE qn_four qn_four_all(float v) { return _mm_set1_ps(v); }
QN_INLINE qn_four qn_four_min(qn_four a, qn_four b) { return _mm_min_ps(a, b); }
QN_INLINE qn_four qn_four_max(qn_four a, qn_four b) { return _mm_max_ps(a, b); }
QN_INLINE qn_four qn_four_add(qn_four a, qn_four b) { return _mm_add_ps(a, b); }
QN_INLINE qn_four qn_four_sub(qn_four a, qn_four b) { return _mm_sub_ps(a, b); }
QN_INLINE qn_four qn_four_mul(qn_four a, qn_four b) { return _mm_mul_ps(a, b); }
/* Towards zero; each within the range of int32_t. */
QN_INLINE void qn_four_whole(qn_four a, int32_t v[4]) { _mm_storeu_si128((__m128i *)(void *)v, _mm_cvttps_epi32(a)); }
#else
typedef struct qn_four { float v[4]; } qn_four;
#define QN_FOUR_(expression)    \
  do {                          \
    qn_four r;                  \
    for (int i = 0; i < 4; i++) { \
      r.v[i] = (expression);    \
    }                           \
    return r;                   \
  } while (0)
QN_INLINE qn_four qn_four_load(const float v[4]) { QN_FOUR_(v[i]); }
QN_INLINE void qn_four_store(float v[4], qn_four a) {
  for (int i = 0; i < 4; i++) {
    v[i] = a.v[i];
  }
}
QN_INLINE qn_four qn_four_all(float v) { QN_FOUR_(v); }
QN_INLINE qn_four qn_four_min(qn_four a, qn_four b) { QN_FOUR_(a.v[i] < b.v[i] ? a.v[i] : b.v[i]); }
QN_INLINE qn_four qn_four_max(qn_four a, qn_four b) { QN_FOUR_(a.v[i] > b.v[i] ? a.v[i] : b.v[i]); }
QN_INLINE qn_four qn_four_add(qn_four a, qn_four b) { QN_FOUR_(a.v[i] + b.v[i]); }
QN_INLINE qn_four qn_four_sub(qn_four a, qn_four b) { QN_FOUR_(a.v[i] - b.v[i]); }
QN_INLINE qn_four qn_four_mul(qn_four a, qn_four b) { QN_FOUR_(a.v[i] * b.v[i]); }
QN_INLINE void qn_four_whole(qn_four a, int32_t v[4]) {
  for (int i = 0; i < 4; i++) {
    v[i] = (int32_t)a.v[i];
  }
}
#undef QN_FOUR_
#endif

#endif
