/* The small set of vector operations that wide code is written over, once; compiled for each instruction set by defining
   QN_ISA_SSE2, QN_ISA_AVX2 or QN_ISA_AVX512. Everything here is static: nothing wide leaks out of its object.

   Legend: vd: QN_W doubles; vm: QN_W lane masks; bits: lane i is bit i. vf8: eight floats, whatever the width of vd
   (a node has eight children). Rounding is to nearest; fma rounds once where the machine can and twice in the baseline:
   it stands only where an error bound allows both. */
#ifndef QN_WIDE_VEC_H
#define QN_WIDE_VEC_H

#include "base/attrs.h"

#include <immintrin.h>
#include <math.h>
#include <stdint.h>

#if (defined(QN_ISA_AVX2) || defined(QN_ISA_AVX512)) && !defined(QN_FUSED)
#define QN_FUSED /* a fused operation rounds once */
#endif

#define QN_INVERSE_BITS 0x7fe0000000000000 /* vinverse_above; the exponents of a number and of its inverse add up to this */

#if defined(QN_SCALAR) /* one lane: a body for a single ray, with the same formulas */
#include <string.h>
#define QN_W 1
typedef double vd;
typedef unsigned vm;
QN_INLINE uint64_t vword(vd a) {
  uint64_t w;
  memcpy(&w, &a, sizeof w);
  return w;
}
QN_INLINE vd vset(double a) { return a; }
QN_INLINE vd vload(const double *p) { return *p; }
QN_INLINE vd vcollect(const double *const p[QN_W], int i) { return p[0][i]; }
QN_INLINE void vstore(double *p, vd a) { *p = a; }
QN_INLINE vd vadd(vd a, vd b) { return a + b; }
QN_INLINE vd vsub(vd a, vd b) { return a - b; }
QN_INLINE vd vmul(vd a, vd b) { return a * b; }
QN_INLINE vd vdiv(vd a, vd b) { return a / b; }
QN_INLINE vd vsqrt(vd a) { return __builtin_sqrt(a); }
#if defined(QN_FUSED)
QN_INLINE vd vfma(vd a, vd b, vd c) { return __builtin_fma(a, b, c); }
QN_INLINE vd vfms(vd a, vd b, vd c) { return __builtin_fma(a, b, -c); }
#else
QN_INLINE vd vfma(vd a, vd b, vd c) { return a * b + c; }
QN_INLINE vd vfms(vd a, vd b, vd c) { return a * b - c; }
#endif
QN_INLINE vd vmin(vd a, vd b) { return a < b ? a : b; }
QN_INLINE vd vmax(vd a, vd b) { return a > b ? a : b; }
QN_INLINE vd vabs(vd a) { return __builtin_fabs(a); }
QN_INLINE vm vlt(vd a, vd b) { return a < b; }
QN_INLINE vm vle(vd a, vd b) { return a <= b; }
QN_INLINE vm veq(vd a, vd b) { return a == b; }
QN_INLINE vm vand(vm a, vm b) { return a & b; }
QN_INLINE vm vor(vm a, vm b) { return a | b; }
QN_INLINE vm vandnot(vm a, vm b) { return a & ~b; }
QN_INLINE vd vpick(vm m, vd a, vd b) { return m ? a : b; }
QN_INLINE unsigned vbits(vm m) { return m; }
QN_INLINE unsigned vsigns(vd a) { return (unsigned)(vword(a) >> 63); }
QN_INLINE unsigned vsecond(vd a) { return (unsigned)(vword(a) >> 62 & 1); }
QN_INLINE vm vsame(vd a, vd b, uint64_t where) { return !((vword(a) ^ vword(b)) & where); }
QN_INLINE vm vmask(unsigned bits) { return bits; }
QN_INLINE vd vpower(vd a) { /* the power of two at or below a, normal and positive */
  uint64_t w = vword(a) & UINT64_C(0x7ff0000000000000);
  memcpy(&a, &w, sizeof a);
  return a;
}
QN_INLINE vd vcollect_floats(const float *const p[QN_W], int i) { return p[0][i]; }
QN_INLINE vd vinverse_above(vd a) { /* at least 1/a and at most 9/8 of it, of an a from 2^-1021 to 2^1022: linear in the significand, 2 - m where 2/m is meant */
  const uint64_t w = QN_INVERSE_BITS - vword(a);
  memcpy(&a, &w, sizeof a);
  return a;
}

#elif defined(QN_ISA_AVX512)
#define QN_W 8
typedef __m512d vd;
typedef __mmask8 vm;
QN_INLINE vd vset(double a) { return _mm512_set1_pd(a); }
QN_INLINE vd vload(const double *p) { return _mm512_load_pd(p); }
QN_INLINE vd vcollect(const double *const p[QN_W], int i) { /* lane j is p[j][i] */
  return _mm512_set_pd(p[7][i], p[6][i], p[5][i], p[4][i], p[3][i], p[2][i], p[1][i], p[0][i]);
}
QN_INLINE vd vcollect_floats(const float *const p[QN_W], int i) {
  return _mm512_cvtps_pd(_mm256_set_ps(p[7][i], p[6][i], p[5][i], p[4][i], p[3][i], p[2][i], p[1][i], p[0][i]));
}
QN_INLINE vd vpower(vd a) { return _mm512_and_pd(a, _mm512_set1_pd(INFINITY)); } /* the power of two at or below a, normal and positive */
QN_INLINE vd vinverse_above(vd a) { return _mm512_castsi512_pd(_mm512_sub_epi64(_mm512_set1_epi64(QN_INVERSE_BITS), _mm512_castpd_si512(a))); }
QN_INLINE void vstore(double *p, vd a) { _mm512_store_pd(p, a); }
QN_INLINE vd vadd(vd a, vd b) { return _mm512_add_pd(a, b); }
QN_INLINE vd vsub(vd a, vd b) { return _mm512_sub_pd(a, b); }
QN_INLINE vd vmul(vd a, vd b) { return _mm512_mul_pd(a, b); }
QN_INLINE vd vdiv(vd a, vd b) { return _mm512_div_pd(a, b); }
QN_INLINE vd vsqrt(vd a) { return _mm512_sqrt_pd(a); }
QN_INLINE vd vfma(vd a, vd b, vd c) { return _mm512_fmadd_pd(a, b, c); }
QN_INLINE vd vfms(vd a, vd b, vd c) { return _mm512_fmsub_pd(a, b, c); }
QN_INLINE vd vmin(vd a, vd b) { return _mm512_min_pd(a, b); }
QN_INLINE vd vmax(vd a, vd b) { return _mm512_max_pd(a, b); }
QN_INLINE vd vabs(vd a) { return _mm512_abs_pd(a); }
QN_INLINE vm vlt(vd a, vd b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
QN_INLINE vm vle(vd a, vd b) { return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ); }
QN_INLINE vm veq(vd a, vd b) { return _mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ); }
QN_INLINE vm vand(vm a, vm b) { return (vm)(a & b); }
QN_INLINE vm vor(vm a, vm b) { return (vm)(a | b); }
QN_INLINE vm vandnot(vm a, vm b) { return (vm)(a & ~b); } /* a and not b */
QN_INLINE vd vpick(vm m, vd a, vd b) { return _mm512_mask_blend_pd(m, b, a); } /* m ? a : b */
QN_INLINE unsigned vbits(vm m) { return m; }
QN_INLINE unsigned vsigns(vd a) { return _mm512_movepi64_mask(_mm512_castpd_si512(a)); } /* lanes with the sign bit set */
QN_INLINE vm vmask(unsigned bits) { return (vm)bits; }
QN_INLINE unsigned vsecond(vd a) { return _mm512_movepi64_mask(_mm512_slli_epi64(_mm512_castpd_si512(a), 1)); } /* the bit below the sign */
QN_INLINE vd vbitor(vd a, vd b) { return _mm512_or_pd(a, b); }
QN_INLINE vd vwords(const uint32_t *p) { return _mm512_castsi512_pd(_mm512_cvtepu32_epi64(_mm256_loadu_si256((const __m256i *)(const void *)p))); } /* zero-extended */
/* Lanes whose bits are the same where `where` has ones. */
QN_INLINE vm vsame(vd a, vd b, uint64_t where) {
  return _mm512_testn_epi64_mask(_mm512_xor_si512(_mm512_castpd_si512(a), _mm512_castpd_si512(b)), _mm512_set1_epi64((long long)where));
}
QN_INLINE vd vlanes(vd v, int a, int b, int c, int d, int e, int f, int g, int h) { return _mm512_permutex2var_pd(v, _mm512_set_epi64(h, g, f, e, d, c, b, a), v); } /* those lanes of v */
QN_INLINE vd vswap(vd a) { return _mm512_permutex2var_pd(a, _mm512_set_epi64(6, 7, 4, 5, 2, 3, 0, 1), a); } /* neighbours change places: lanes 0 and 1, 2 and 3, ... */
/* Lanes j and j + 1 of a and b in turn: a0 b0 a1 b1 into to[0], a2 b2 a3 b3 into to[1], and so on; no alignment. */
QN_INLINE void vweave(vd a, vd b, double *const to[QN_W / 2]) {
  const __m512i even = _mm512_set_epi64(11, 3, 10, 2, 9, 1, 8, 0), odd = _mm512_set_epi64(15, 7, 14, 6, 13, 5, 12, 4);
  __m512d x = _mm512_permutex2var_pd(a, even, b), y = _mm512_permutex2var_pd(a, odd, b);
  _mm256_storeu_pd(to[0], _mm512_castpd512_pd256(x)), _mm256_storeu_pd(to[1], _mm512_extractf64x4_pd(x, 1));
  _mm256_storeu_pd(to[2], _mm512_castpd512_pd256(y)), _mm256_storeu_pd(to[3], _mm512_extractf64x4_pd(y, 1));
}
/* Lane j of a and of b to to[j]; no alignment. */
QN_INLINE void vdeal(vd a, vd b, double *const to[QN_W]) {
  const __m256d a0 = _mm512_castpd512_pd256(a), a1 = _mm512_extractf64x4_pd(a, 1), b0 = _mm512_castpd512_pd256(b), b1 = _mm512_extractf64x4_pd(b, 1);
  const __m256d x[4] = {_mm256_unpacklo_pd(a0, b0), _mm256_unpackhi_pd(a0, b0), _mm256_unpacklo_pd(a1, b1), _mm256_unpackhi_pd(a1, b1)};
  for (int k = 0; k < 4; k++) {
    const int j = 2 * (k & 2) + (k & 1);
    _mm_storeu_pd(to[j], _mm256_castpd256_pd128(x[k])), _mm_storeu_pd(to[j + 2], _mm256_extractf128_pd(x[k], 1));
  }
}

#elif defined(QN_ISA_AVX2)
#define QN_W 4
typedef __m256d vd;
typedef __m256d vm;
QN_INLINE vd vset(double a) { return _mm256_set1_pd(a); }
QN_INLINE vd vload(const double *p) { return _mm256_load_pd(p); }
QN_INLINE vd vcollect(const double *const p[QN_W], int i) { return _mm256_set_pd(p[3][i], p[2][i], p[1][i], p[0][i]); }
QN_INLINE vd vcollect_floats(const float *const p[QN_W], int i) { return _mm256_cvtps_pd(_mm_set_ps(p[3][i], p[2][i], p[1][i], p[0][i])); }
QN_INLINE vd vpower(vd a) { return _mm256_and_pd(a, _mm256_set1_pd(INFINITY)); }
QN_INLINE vd vinverse_above(vd a) { return _mm256_castsi256_pd(_mm256_sub_epi64(_mm256_set1_epi64x(QN_INVERSE_BITS), _mm256_castpd_si256(a))); }
QN_INLINE vd vfour(double a, double b, double c, double d) { return _mm256_set_pd(d, c, b, a); }
QN_INLINE void vstore(double *p, vd a) { _mm256_store_pd(p, a); }
QN_INLINE vd vadd(vd a, vd b) { return _mm256_add_pd(a, b); }
QN_INLINE vd vsub(vd a, vd b) { return _mm256_sub_pd(a, b); }
QN_INLINE vd vmul(vd a, vd b) { return _mm256_mul_pd(a, b); }
QN_INLINE vd vdiv(vd a, vd b) { return _mm256_div_pd(a, b); }
QN_INLINE vd vsqrt(vd a) { return _mm256_sqrt_pd(a); }
QN_INLINE vd vfma(vd a, vd b, vd c) { return _mm256_fmadd_pd(a, b, c); }
QN_INLINE vd vfms(vd a, vd b, vd c) { return _mm256_fmsub_pd(a, b, c); }
QN_INLINE vd vmin(vd a, vd b) { return _mm256_min_pd(a, b); }
QN_INLINE vd vmax(vd a, vd b) { return _mm256_max_pd(a, b); }
QN_INLINE vd vabs(vd a) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a); }
QN_INLINE vm vlt(vd a, vd b) { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
QN_INLINE vm vle(vd a, vd b) { return _mm256_cmp_pd(a, b, _CMP_LE_OQ); }
QN_INLINE vm veq(vd a, vd b) { return _mm256_cmp_pd(a, b, _CMP_EQ_OQ); }
QN_INLINE vm vand(vm a, vm b) { return _mm256_and_pd(a, b); }
QN_INLINE vm vor(vm a, vm b) { return _mm256_or_pd(a, b); }
QN_INLINE vm vandnot(vm a, vm b) { return _mm256_andnot_pd(b, a); }
QN_INLINE vd vpick(vm m, vd a, vd b) { return _mm256_blendv_pd(b, a, m); }
QN_INLINE unsigned vbits(vm m) { return (unsigned)_mm256_movemask_pd(m); }
QN_INLINE unsigned vsigns(vd a) { return (unsigned)_mm256_movemask_pd(a); }
QN_INLINE unsigned vsecond(vd a) { return (unsigned)_mm256_movemask_pd(_mm256_castsi256_pd(_mm256_slli_epi64(_mm256_castpd_si256(a), 1))); }
QN_INLINE vd vbitor(vd a, vd b) { return _mm256_or_pd(a, b); }
QN_INLINE vd vwords(const uint32_t *p) { return _mm256_castsi256_pd(_mm256_cvtepu32_epi64(_mm_loadu_si128((const __m128i *)(const void *)p))); }
QN_INLINE vm vsame(vd a, vd b, uint64_t where) {
  const __m256i differ = _mm256_and_si256(_mm256_xor_si256(_mm256_castpd_si256(a), _mm256_castpd_si256(b)), _mm256_set1_epi64x((long long)where));
  return _mm256_castsi256_pd(_mm256_cmpeq_epi64(differ, _mm256_setzero_si256()));
}
QN_INLINE vd vswap(vd a) { return _mm256_permute_pd(a, 5); }
QN_INLINE void vweave(vd a, vd b, double *const to[QN_W / 2]) {
  __m256d x = _mm256_unpacklo_pd(a, b), y = _mm256_unpackhi_pd(a, b); /* a0 b0 a2 b2, a1 b1 a3 b3 */
  _mm256_storeu_pd(to[0], _mm256_permute2f128_pd(x, y, 0x20)), _mm256_storeu_pd(to[1], _mm256_permute2f128_pd(x, y, 0x31));
}
QN_INLINE void vdeal(vd a, vd b, double *const to[QN_W]) {
  const __m256d x = _mm256_unpacklo_pd(a, b), y = _mm256_unpackhi_pd(a, b); /* a0 b0 a2 b2, a1 b1 a3 b3 */
  _mm_storeu_pd(to[0], _mm256_castpd256_pd128(x)), _mm_storeu_pd(to[2], _mm256_extractf128_pd(x, 1));
  _mm_storeu_pd(to[1], _mm256_castpd256_pd128(y)), _mm_storeu_pd(to[3], _mm256_extractf128_pd(y, 1));
}
QN_INLINE vm vmask(unsigned bits) {
  const __m256i lane = _mm256_set_epi64x(8, 4, 2, 1);
  return _mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(_mm256_set1_epi64x((long long)bits), lane), lane));
}

#else
#define QN_W 2
typedef __m128d vd;
typedef __m128d vm;
QN_INLINE vd vset(double a) { return _mm_set1_pd(a); }
QN_INLINE vd vload(const double *p) { return _mm_load_pd(p); }
QN_INLINE vd vcollect(const double *const p[QN_W], int i) { return _mm_set_pd(p[1][i], p[0][i]); }
QN_INLINE vd vcollect_floats(const float *const p[QN_W], int i) { return _mm_set_pd(p[1][i], p[0][i]); }
QN_INLINE vd vpower(vd a) { return _mm_and_pd(a, _mm_set1_pd(INFINITY)); }
QN_INLINE vd vinverse_above(vd a) { return _mm_castsi128_pd(_mm_sub_epi64(_mm_set1_epi64x(QN_INVERSE_BITS), _mm_castpd_si128(a))); }
QN_INLINE void vstore(double *p, vd a) { _mm_store_pd(p, a); }
QN_INLINE vd vadd(vd a, vd b) { return _mm_add_pd(a, b); }
QN_INLINE vd vsub(vd a, vd b) { return _mm_sub_pd(a, b); }
QN_INLINE vd vmul(vd a, vd b) { return _mm_mul_pd(a, b); }
QN_INLINE vd vdiv(vd a, vd b) { return _mm_div_pd(a, b); }
QN_INLINE vd vsqrt(vd a) { return _mm_sqrt_pd(a); }
QN_INLINE vd vfma(vd a, vd b, vd c) { return _mm_add_pd(_mm_mul_pd(a, b), c); }
QN_INLINE vd vfms(vd a, vd b, vd c) { return _mm_sub_pd(_mm_mul_pd(a, b), c); }
QN_INLINE vd vmin(vd a, vd b) { return _mm_min_pd(a, b); }
QN_INLINE vd vmax(vd a, vd b) { return _mm_max_pd(a, b); }
QN_INLINE vd vabs(vd a) { return _mm_andnot_pd(_mm_set1_pd(-0.0), a); }
QN_INLINE vm vlt(vd a, vd b) { return _mm_cmplt_pd(a, b); }
QN_INLINE vm vle(vd a, vd b) { return _mm_cmple_pd(a, b); }
QN_INLINE vm veq(vd a, vd b) { return _mm_cmpeq_pd(a, b); }
QN_INLINE vm vand(vm a, vm b) { return _mm_and_pd(a, b); }
QN_INLINE vm vor(vm a, vm b) { return _mm_or_pd(a, b); }
QN_INLINE vm vandnot(vm a, vm b) { return _mm_andnot_pd(b, a); }
QN_INLINE vd vpick(vm m, vd a, vd b) { return _mm_or_pd(_mm_and_pd(m, a), _mm_andnot_pd(m, b)); }
QN_INLINE unsigned vbits(vm m) { return (unsigned)_mm_movemask_pd(m); }
QN_INLINE unsigned vsigns(vd a) { return (unsigned)_mm_movemask_pd(a); }
QN_INLINE unsigned vsecond(vd a) { return (unsigned)_mm_movemask_pd(_mm_castsi128_pd(_mm_slli_epi64(_mm_castpd_si128(a), 1))); }
QN_INLINE vd vbitor(vd a, vd b) { return _mm_or_pd(a, b); }
QN_INLINE vd vwords(const uint32_t *p) { return _mm_castsi128_pd(_mm_set_epi64x((long long)p[1], (long long)p[0])); }
QN_INLINE vm vsame(vd a, vd b, uint64_t where) {
  const __m128i differ = _mm_and_si128(_mm_xor_si128(_mm_castpd_si128(a), _mm_castpd_si128(b)), _mm_set1_epi64x((long long)where));
  const __m128i halves = _mm_cmpeq_epi32(differ, _mm_setzero_si128());
  return _mm_castsi128_pd(_mm_and_si128(halves, _mm_shuffle_epi32(halves, _MM_SHUFFLE(2, 3, 0, 1))));
}
QN_INLINE vd vswap(vd a) { return _mm_shuffle_pd(a, a, 1); }
QN_INLINE void vweave(vd a, vd b, double *const to[QN_W / 2]) {
  _mm_storeu_pd(to[0], _mm_unpacklo_pd(a, b)), _mm_storeu_pd(to[0] + 2, _mm_unpackhi_pd(a, b));
}
QN_INLINE void vdeal(vd a, vd b, double *const to[QN_W]) { _mm_storeu_pd(to[0], _mm_unpacklo_pd(a, b)), _mm_storeu_pd(to[1], _mm_unpackhi_pd(a, b)); }
QN_INLINE vm vmask(unsigned bits) {
  return _mm_castsi128_pd(_mm_set_epi64x(bits & 2 ? -1 : 0, bits & 1 ? -1 : 0));
}
#endif

#define QN_ALL_BITS ((1u << QN_W) - 1)

/* The name of a function that every instruction set has its own body of: QN_OF_ISA(qn_first) is qn_first_avx2 and so on. */
#define QN_JOIN_AGAIN_(name, isa) name##_##isa
#define QN_JOIN_(name, isa) QN_JOIN_AGAIN_(name, isa)
#define QN_OF_ISA(name) QN_JOIN_(name, QN_ISA_NAME)

/* --- exact sums and products: hi the rounded result, lo what it lacks (number/dd.h has the sources) ----------------- */
typedef struct vdd { vd hi, lo; } vdd;
QN_INLINE vdd vtwo_sum(vd a, vd b) {
  vd s = vadd(a, b), t = vsub(s, a);
  return (vdd){s, vadd(vsub(a, vsub(s, t)), vsub(b, t))};
}
QN_INLINE vdd vtwo_difference(vd a, vd b) {
  vd s = vsub(a, b), t = vsub(s, a);
  return (vdd){s, vsub(vsub(a, vsub(s, t)), vadd(b, t))};
}
/* Exact barring over- and underflow. */
QN_INLINE vdd vtwo_product(vd a, vd b) {
  vd p = vmul(a, b);
#if defined(QN_FUSED)
  return (vdd){p, vfms(a, b, p)};
#else
  const vd split = vset(134217729.0); /* 2^27 + 1 */
  vd ca = vmul(split, a), ah = vsub(ca, vsub(ca, a)), al = vsub(a, ah);
  vd cb = vmul(split, b), bh = vsub(cb, vsub(cb, b)), bl = vsub(b, bh);
  return (vdd){p, vadd(vadd(vadd(vsub(vmul(ah, bh), p), vmul(ah, bl)), vmul(al, bh)), vmul(al, bl))};
#endif
}

/* --- eight floats ----------------------------------------------------------------------------------------------- */
/* fnarrow: of eight doubles, rounded. fleast, fmost: of eight. veights: the least (most: the largest) of each eight of 64 doubles.
   vfour_most: the largest of the sums of four doubles each, in those of four lanes; of none -2^126: finite, so that floats stay numbers.
   ftable: the sums, rounded twice, of two columns and four rows: x0 + y0, x0 + y1, x1 + y0, x1 + y1, and the same with y2 and y3. */
#if defined(QN_ISA_AVX2) || defined(QN_ISA_AVX512)
typedef __m256 vf8;
QN_INLINE vf8 fset(float a) { return _mm256_set1_ps(a); }
QN_INLINE vf8 fload(const float *p) { return _mm256_load_ps(p); }
QN_INLINE void fstore(float *p, vf8 a) { _mm256_store_ps(p, a); }
QN_INLINE vf8 fadd(vf8 a, vf8 b) { return _mm256_add_ps(a, b); }
QN_INLINE vf8 fsub(vf8 a, vf8 b) { return _mm256_sub_ps(a, b); }
QN_INLINE vf8 fmul(vf8 a, vf8 b) { return _mm256_mul_ps(a, b); }
QN_INLINE vf8 ffma(vf8 a, vf8 b, vf8 c) { return _mm256_fmadd_ps(a, b, c); }
QN_INLINE vf8 fmin8(vf8 a, vf8 b) { return _mm256_min_ps(a, b); }
QN_INLINE vf8 fmax8(vf8 a, vf8 b) { return _mm256_max_ps(a, b); }
QN_INLINE unsigned fle(vf8 a, vf8 b) { return (unsigned)_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ)); }
QN_INLINE vf8 fnarrow(const double v[8]) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(_mm256_load_pd(v))), _mm256_cvtpd_ps(_mm256_load_pd(v + 4)), 1);
}
QN_INLINE float fleast(vf8 v) {
  __m128 x = _mm_min_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
  x = _mm_min_ps(x, _mm_movehl_ps(x, x));
  return _mm_cvtss_f32(_mm_min_ss(x, _mm_shuffle_ps(x, x, 1)));
}
QN_INLINE float fmost(vf8 v) { return -fleast(_mm256_sub_ps(_mm256_setzero_ps(), v)); }
QN_INLINE __m256d further(__m256d a, __m256d b, int most) { return most ? _mm256_max_pd(a, b) : _mm256_min_pd(a, b); }
QN_INLINE void veights(const double v[64], int most, double out[8]) {
  for (int half = 0; half < 8; half += 4, v += 32) {
    __m256d x[4];
    for (int k = 0; k < 4; k++) {
      x[k] = further(_mm256_load_pd(v + 8 * k), _mm256_load_pd(v + 8 * k + 4), most);
    }
    const __m256d a = further(_mm256_unpacklo_pd(x[0], x[1]), _mm256_unpackhi_pd(x[0], x[1]), most);
    const __m256d b = further(_mm256_unpacklo_pd(x[2], x[3]), _mm256_unpackhi_pd(x[2], x[3]), most);
    _mm256_store_pd(out + half, further(_mm256_permute2f128_pd(a, b, 0x20), _mm256_permute2f128_pd(a, b, 0x31), most));
  }
}
QN_INLINE double vfour_most(const double x[4], const double y[4], unsigned lanes) {
  const __m256i lane = _mm256_set_epi64x(8, 4, 2, 1), in = _mm256_cmpeq_epi64(_mm256_and_si256(_mm256_set1_epi64x((long long)lanes), lane), lane);
  const __m256d sum = _mm256_blendv_pd(_mm256_set1_pd(-0x1p+126), _mm256_add_pd(_mm256_load_pd(x), _mm256_load_pd(y)), _mm256_castsi256_pd(in));
  const __m128d most = _mm_max_pd(_mm256_castpd256_pd128(sum), _mm256_extractf128_pd(sum, 1));
  return _mm_cvtsd_f64(_mm_max_sd(most, _mm_unpackhi_pd(most, most)));
}
QN_INLINE vf8 ftable(const double x[2], const double y[4]) {
  const __m256d pair = _mm256_blend_pd(_mm256_set1_pd(x[0]), _mm256_set1_pd(x[1]), 0xc); /* not set_pd: gcc 12 takes wrong lanes of eight for it (tests/house/objects.sh) */
  const __m256d first = _mm256_add_pd(pair, _mm256_set_pd(y[1], y[0], y[1], y[0])), second = _mm256_add_pd(pair, _mm256_set_pd(y[3], y[2], y[3], y[2]));
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(first)), _mm256_cvtpd_ps(second), 1);
}
#else
typedef struct vf8 { __m128 a, b; } vf8;
QN_INLINE vf8 fset(float a) { return (vf8){_mm_set1_ps(a), _mm_set1_ps(a)}; }
QN_INLINE vf8 fload(const float *p) { return (vf8){_mm_load_ps(p), _mm_load_ps(p + 4)}; }
QN_INLINE void fstore(float *p, vf8 v) { _mm_store_ps(p, v.a), _mm_store_ps(p + 4, v.b); }
QN_INLINE vf8 fadd(vf8 x, vf8 y) { return (vf8){_mm_add_ps(x.a, y.a), _mm_add_ps(x.b, y.b)}; }
QN_INLINE vf8 fsub(vf8 x, vf8 y) { return (vf8){_mm_sub_ps(x.a, y.a), _mm_sub_ps(x.b, y.b)}; }
QN_INLINE vf8 fmul(vf8 x, vf8 y) { return (vf8){_mm_mul_ps(x.a, y.a), _mm_mul_ps(x.b, y.b)}; }
QN_INLINE vf8 ffma(vf8 x, vf8 y, vf8 z) { return fadd(fmul(x, y), z); } /* rounds twice */
QN_INLINE vf8 fmin8(vf8 x, vf8 y) { return (vf8){_mm_min_ps(x.a, y.a), _mm_min_ps(x.b, y.b)}; }
QN_INLINE vf8 fmax8(vf8 x, vf8 y) { return (vf8){_mm_max_ps(x.a, y.a), _mm_max_ps(x.b, y.b)}; }
QN_INLINE unsigned fle(vf8 x, vf8 y) {
  return (unsigned)_mm_movemask_ps(_mm_cmple_ps(x.a, y.a)) | (unsigned)_mm_movemask_ps(_mm_cmple_ps(x.b, y.b)) << 4;
}
QN_INLINE vf8 fnarrow(const double v[8]) {
  return (vf8){_mm_movelh_ps(_mm_cvtpd_ps(_mm_load_pd(v)), _mm_cvtpd_ps(_mm_load_pd(v + 2))), _mm_movelh_ps(_mm_cvtpd_ps(_mm_load_pd(v + 4)), _mm_cvtpd_ps(_mm_load_pd(v + 6)))};
}
QN_INLINE float fleast(vf8 v) {
  __m128 x = _mm_min_ps(v.a, v.b);
  x = _mm_min_ps(x, _mm_movehl_ps(x, x));
  return _mm_cvtss_f32(_mm_min_ss(x, _mm_shuffle_ps(x, x, 1)));
}
QN_INLINE float fmost(vf8 v) { return -fleast((vf8){_mm_sub_ps(_mm_setzero_ps(), v.a), _mm_sub_ps(_mm_setzero_ps(), v.b)}); }
QN_INLINE __m128d further(__m128d a, __m128d b, int most) { return most ? _mm_max_pd(a, b) : _mm_min_pd(a, b); }
QN_INLINE void veights(const double v[64], int most, double out[8]) {
  for (int k = 0; k < 8; k++, v += 8) {
    const __m128d x = further(further(_mm_load_pd(v), _mm_load_pd(v + 2), most), further(_mm_load_pd(v + 4), _mm_load_pd(v + 6), most), most);
    _mm_store_sd(out + k, further(x, _mm_unpackhi_pd(x, x), most));
  }
}
QN_INLINE double vfour_most(const double x[4], const double y[4], unsigned lanes) {
  double most = -0x1p+126;
  for (unsigned i = 0; i < 4; i++) {
    const double sum = lanes >> i & 1 ? x[i] + y[i] : most;
    most = sum > most ? sum : most;
  }
  return most;
}
QN_INLINE vf8 ftable(const double x[2], const double y[4]) {
  const __m128d left = _mm_set1_pd(x[0]), right = _mm_set1_pd(x[1]), first = _mm_set_pd(y[1], y[0]), second = _mm_set_pd(y[3], y[2]);
  return (vf8){_mm_movelh_ps(_mm_cvtpd_ps(_mm_add_pd(left, first)), _mm_cvtpd_ps(_mm_add_pd(right, first))),
               _mm_movelh_ps(_mm_cvtpd_ps(_mm_add_pd(left, second)), _mm_cvtpd_ps(_mm_add_pd(right, second)))};
}
#endif

#endif
