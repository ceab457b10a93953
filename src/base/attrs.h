/* Compiler attributes: the only place where an extension of C17 is spelt. */
#ifndef QN_BASE_ATTRS_H
#define QN_BASE_ATTRS_H

#include <stdint.h>

#if defined(__GNUC__)
#define QN_PRINTF(fmt, args) __attribute__((format(printf, fmt, args)))
#define QN_NODISCARD __attribute__((warn_unused_result))
#define QN_LIKELY(x) __builtin_expect(!!(x), 1)
#define QN_UNLIKELY(x) __builtin_expect(!!(x), 0)
#define QN_NOINLINE __attribute__((noinline))
#define QN_INLINE static inline __attribute__((always_inline))
#define QN_UNUSED __attribute__((unused))
#define QN_FETCH(p) __builtin_prefetch(p)
#else
#define QN_PRINTF(fmt, args)
#define QN_NODISCARD
#define QN_LIKELY(x) (x)
#define QN_UNLIKELY(x) (x)
#define QN_NOINLINE
#define QN_INLINE static inline
#define QN_UNUSED
#define QN_FETCH(p) ((void)(p))
#endif

/* 128-bit integers: every supported compiler has them on its 64-bit machines. */
__extension__ typedef __int128 qn_i128;
__extension__ typedef unsigned __int128 qn_u128;

/* Zero bits above the highest and below the lowest bit set; v != 0. */
QN_INLINE unsigned qn_leading_zeros(uint64_t v) { return (unsigned)__builtin_clzll(v); }
QN_INLINE unsigned qn_trailing_zeros(uint64_t v) { return (unsigned)__builtin_ctzll(v); }
/* The bits that are set; all or none at once, where the machine's baseline counts them in a function. */
QN_INLINE unsigned qn_bits_set(uint64_t v) { return v == UINT64_MAX ? 64 : v ? (unsigned)__builtin_popcountll(v) : 0; }

#endif
