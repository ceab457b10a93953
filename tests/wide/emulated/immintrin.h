/* Stands before the system's immintrin.h when the bodies of 8 lanes are built for a machine without AVX-512: each intrinsic of it that
   src/ uses, on two AVX2 vectors (AVX-512VL's on AVX and plain loops), by Intel's description of what it computes. So all of the code of
   8 lanes runs, and what alone does not is the instruction that each intrinsic stands for. One that is not here does not compile ("target specific option mismatch"). */
#ifndef QN_TEST_EMULATED_IMMINTRIN_H
#define QN_TEST_EMULATED_IMMINTRIN_H

#pragma GCC system_header /* include_next is an extension */
#include_next <immintrin.h>

#include <stdint.h>
#include <string.h>

#ifdef __AVX512F__
#error "this is for building without AVX-512"
#endif
#define EMULATED static inline __attribute__((always_inline, unused))

typedef struct emulated_pd { __m256d a, b; } emulated_pd; /* lanes 0 to 3, 4 to 7 */
typedef struct emulated_si { __m256i a, b; } emulated_si;

#define EMULATED_BOTH(name, op) \
  EMULATED emulated_pd name(emulated_pd x, emulated_pd y) { return (emulated_pd){op(x.a, y.a), op(x.b, y.b)}; }
EMULATED_BOTH(emulated_add_pd, _mm256_add_pd)
EMULATED_BOTH(emulated_sub_pd, _mm256_sub_pd)
EMULATED_BOTH(emulated_mul_pd, _mm256_mul_pd)
EMULATED_BOTH(emulated_div_pd, _mm256_div_pd)
EMULATED_BOTH(emulated_min_pd, _mm256_min_pd)
EMULATED_BOTH(emulated_max_pd, _mm256_max_pd)
EMULATED_BOTH(emulated_or_pd, _mm256_or_pd)
EMULATED_BOTH(emulated_and_pd, _mm256_and_pd)
EMULATED emulated_pd emulated_sqrt_pd(emulated_pd x) { return (emulated_pd){_mm256_sqrt_pd(x.a), _mm256_sqrt_pd(x.b)}; }
EMULATED emulated_pd emulated_abs_pd(emulated_pd x) {
  const __m256d sign = _mm256_set1_pd(-0.0);
  return (emulated_pd){_mm256_andnot_pd(sign, x.a), _mm256_andnot_pd(sign, x.b)};
}
EMULATED emulated_pd emulated_fmadd_pd(emulated_pd x, emulated_pd y, emulated_pd z) {
  return (emulated_pd){_mm256_fmadd_pd(x.a, y.a, z.a), _mm256_fmadd_pd(x.b, y.b, z.b)};
}
EMULATED emulated_pd emulated_fmsub_pd(emulated_pd x, emulated_pd y, emulated_pd z) {
  return (emulated_pd){_mm256_fmsub_pd(x.a, y.a, z.a), _mm256_fmsub_pd(x.b, y.b, z.b)};
}

/* --- loads, stores, constants ------------------------------------------------------------------------------------------- */
EMULATED emulated_pd emulated_set1_pd(double x) { return (emulated_pd){_mm256_set1_pd(x), _mm256_set1_pd(x)}; }
EMULATED emulated_pd emulated_set_pd(double h, double g, double f, double e, double d, double c, double b, double a) {
  return (emulated_pd){_mm256_set_pd(d, c, b, a), _mm256_set_pd(h, g, f, e)};
}
EMULATED emulated_si emulated_set_epi64(long long h, long long g, long long f, long long e, long long d, long long c, long long b, long long a) {
  return (emulated_si){_mm256_set_epi64x(d, c, b, a), _mm256_set_epi64x(h, g, f, e)};
}
EMULATED emulated_pd emulated_load_pd(const double *p) { /* faults where 64 bytes are not aligned, as the instruction does */
  if ((uintptr_t)p % 64 != 0) {
    __builtin_trap();
  }
  return (emulated_pd){_mm256_load_pd(p), _mm256_load_pd(p + 4)};
}
EMULATED void emulated_store_pd(double *p, emulated_pd x) {
  if ((uintptr_t)p % 64 != 0) {
    __builtin_trap();
  }
  _mm256_store_pd(p, x.a), _mm256_store_pd(p + 4, x.b);
}

/* --- bits --------------------------------------------------------------------------------------------------------------- */
EMULATED emulated_si emulated_castpd_si512(emulated_pd x) { return (emulated_si){_mm256_castpd_si256(x.a), _mm256_castpd_si256(x.b)}; }
EMULATED emulated_pd emulated_castsi512_pd(emulated_si x) { return (emulated_pd){_mm256_castsi256_pd(x.a), _mm256_castsi256_pd(x.b)}; }
EMULATED emulated_si emulated_set1_epi64(long long x) { return (emulated_si){_mm256_set1_epi64x(x), _mm256_set1_epi64x(x)}; }
EMULATED emulated_si emulated_xor_si512(emulated_si x, emulated_si y) { return (emulated_si){_mm256_xor_si256(x.a, y.a), _mm256_xor_si256(x.b, y.b)}; }
EMULATED emulated_si emulated_sub_epi64(emulated_si x, emulated_si y) { return (emulated_si){_mm256_sub_epi64(x.a, y.a), _mm256_sub_epi64(x.b, y.b)}; }
EMULATED unsigned char emulated_testn_epi64_mask(emulated_si x, emulated_si y) { /* lanes in which no bit is in both */
  const __m256i zero = _mm256_setzero_si256();
  return (unsigned char)(_mm256_movemask_pd(_mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(x.a, y.a), zero))) |
                         _mm256_movemask_pd(_mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(x.b, y.b), zero))) << 4);
}
EMULATED emulated_si emulated_slli_epi64(emulated_si x, unsigned n) {
  return (emulated_si){_mm256_slli_epi64(x.a, (int)n), _mm256_slli_epi64(x.b, (int)n)};
}
EMULATED unsigned char emulated_movepi64_mask(emulated_si x) { /* the lanes' highest bits */
  return (unsigned char)(_mm256_movemask_pd(_mm256_castsi256_pd(x.a)) | _mm256_movemask_pd(_mm256_castsi256_pd(x.b)) << 4);
}
EMULATED emulated_si emulated_cvtepu32_epi64(__m256i x) {
  return (emulated_si){_mm256_cvtepu32_epi64(_mm256_castsi256_si128(x)), _mm256_cvtepu32_epi64(_mm256_extracti128_si256(x, 1))};
}
EMULATED emulated_pd emulated_cvtps_pd(__m256 x) {
  return (emulated_pd){_mm256_cvtps_pd(_mm256_castps256_ps128(x)), _mm256_cvtps_pd(_mm256_extractf128_ps(x, 1))};
}
#define emulated_cmp_pd_mask(x, y, how) \
  ((unsigned char)(_mm256_movemask_pd(_mm256_cmp_pd((x).a, (y).a, how)) | _mm256_movemask_pd(_mm256_cmp_pd((x).b, (y).b, how)) << 4))

/* --- lanes moved ---------------------------------------------------------------------------------------------------------- */
EMULATED emulated_pd emulated_mask_blend_pd(unsigned char m, emulated_pd x, emulated_pd y) { /* y where m has a bit */
  _Alignas(32) double u[8], v[8];
  _mm256_store_pd(u, x.a), _mm256_store_pd(u + 4, x.b), _mm256_store_pd(v, y.a), _mm256_store_pd(v + 4, y.b);
  for (int i = 0; i < 8; i++) {
    u[i] = m >> i & 1 ? v[i] : u[i];
  }
  return (emulated_pd){_mm256_load_pd(u), _mm256_load_pd(u + 4)};
}
EMULATED emulated_pd emulated_permutex2var_pd(emulated_pd x, emulated_si index, emulated_pd y) { /* 0 to 7: of x, 8 to 15: of y */
  _Alignas(32) double from[16], to[8];
  _Alignas(32) uint64_t at[8];
  _mm256_store_pd(from, x.a), _mm256_store_pd(from + 4, x.b), _mm256_store_pd(from + 8, y.a), _mm256_store_pd(from + 12, y.b);
  _mm256_store_si256((void *)at, index.a), _mm256_store_si256((void *)(at + 4), index.b);
  for (int i = 0; i < 8; i++) {
    memcpy(&to[i], &from[at[i] & 15], sizeof *to);
  }
  return (emulated_pd){_mm256_load_pd(to), _mm256_load_pd(to + 4)};
}
EMULATED __m256d emulated_castpd512_pd256(emulated_pd x) { return x.a; }
EMULATED __m256d emulated_extractf64x4_pd(emulated_pd x, int half) { return half ? x.b : x.a; }

/* --- AVX-512VL: masks beside eight floats or words ------------------------------------------------------------------------ */
#define emulated_cmp_ps_mask(x, y, how) ((unsigned char)_mm256_movemask_ps(_mm256_cmp_ps(x, y, how)))
#define emulated_mask_cmp_ps_mask(m, x, y, how) ((unsigned char)((m) & emulated_cmp_ps_mask(x, y, how)))
EMULATED __m256i emulated_maskz_compress_epi32(unsigned char m, __m256i x) { /* the words with a bit, one after another, then zeros */
  _Alignas(32) uint32_t from[8], to[8] = {0};
  _mm256_store_si256((void *)from, x);
  for (int i = 0, n = 0; i < 8; i++) {
    if (m >> i & 1) {
      to[n++] = from[i];
    }
  }
  return _mm256_load_si256((const void *)to);
}

#define __m512d emulated_pd
#define __m512i emulated_si
#define _mm512_add_pd emulated_add_pd
#define _mm512_sub_pd emulated_sub_pd
#define _mm512_mul_pd emulated_mul_pd
#define _mm512_div_pd emulated_div_pd
#define _mm512_min_pd emulated_min_pd
#define _mm512_max_pd emulated_max_pd
#define _mm512_or_pd emulated_or_pd
#define _mm512_and_pd emulated_and_pd
#define _mm512_cvtps_pd emulated_cvtps_pd
#define _mm512_sqrt_pd emulated_sqrt_pd
#define _mm512_abs_pd emulated_abs_pd
#define _mm512_fmadd_pd emulated_fmadd_pd
#define _mm512_fmsub_pd emulated_fmsub_pd
#define _mm512_set1_pd emulated_set1_pd
#define _mm512_set_pd emulated_set_pd
#define _mm512_set_epi64 emulated_set_epi64
#define _mm512_load_pd emulated_load_pd
#define _mm512_store_pd emulated_store_pd
#define _mm512_castpd_si512 emulated_castpd_si512
#define _mm512_castsi512_pd emulated_castsi512_pd
#define _mm512_slli_epi64 emulated_slli_epi64
#define _mm512_set1_epi64 emulated_set1_epi64
#define _mm512_sub_epi64 emulated_sub_epi64
#define _mm512_xor_si512 emulated_xor_si512
#define _mm512_testn_epi64_mask emulated_testn_epi64_mask
#define _mm512_movepi64_mask emulated_movepi64_mask
#define _mm512_cvtepu32_epi64 emulated_cvtepu32_epi64
#undef _mm512_cmp_pd_mask
#define _mm512_cmp_pd_mask emulated_cmp_pd_mask
#define _mm512_mask_blend_pd emulated_mask_blend_pd
#define _mm512_permutex2var_pd emulated_permutex2var_pd
#define _mm512_castpd512_pd256 emulated_castpd512_pd256
#undef _mm512_extractf64x4_pd
#define _mm512_extractf64x4_pd emulated_extractf64x4_pd
#undef _mm256_cmp_ps_mask
#define _mm256_cmp_ps_mask emulated_cmp_ps_mask
#undef _mm256_mask_cmp_ps_mask
#define _mm256_mask_cmp_ps_mask emulated_mask_cmp_ps_mask
#define _mm256_maskz_compress_epi32 emulated_maskz_compress_epi32

#endif
