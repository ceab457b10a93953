/* Compiler attributes: the only place where an extension of C17 is spelt. */
#ifndef QN_BASE_ATTRS_H
#define QN_BASE_ATTRS_H

#if defined(__GNUC__)
#define QN_PRINTF(fmt, args) __attribute__((format(printf, fmt, args)))
#define QN_NODISCARD __attribute__((warn_unused_result))
#define QN_LIKELY(x) __builtin_expect(!!(x), 1)
#define QN_UNLIKELY(x) __builtin_expect(!!(x), 0)
#define QN_NOINLINE __attribute__((noinline))
#define QN_INLINE static inline __attribute__((always_inline))
#define QN_UNUSED __attribute__((unused))
#else
#define QN_PRINTF(fmt, args)
#define QN_NODISCARD
#define QN_LIKELY(x) (x)
#define QN_UNLIKELY(x) (x)
#define QN_NOINLINE
#define QN_INLINE static inline
#define QN_UNUSED
#endif

#endif
