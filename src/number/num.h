/* Numbers of a model (design S1, S2): exact rationals, or numbers rounded to QN_S2_PRECISION bits where an irrational
   function was met. 16 bytes each; most are small and own no memory.

   A small number is m 2^a 5^b, m without factors 2 and 5 (0 is m = a = b = 0): every decimal of up to 18 digits and every double is one.
   Anything else is a reduced fraction in the context's arena. The form is canonical: equal values have equal forms.
   An operation on a rounded number rounds its result to QN_S2_PRECISION bits; a sum that cancels to under
   2^-QN_S2_BITS of its larger term is an exact 0. An exact 0 times anything is an exact 0. */
#ifndef QN_NUMBER_NUM_H
#define QN_NUMBER_NUM_H

#include "number/xint.h"

typedef enum qn_num_kind { QN_NUM_SMALL = 0, QN_NUM_BIG, QN_NUM_ROUNDED } qn_num_kind;

typedef struct qn_rat { qn_int num, den; } qn_rat; /* den > 0, reduced */

typedef struct qn_num {
  union { int64_t m; const qn_rat *big; } u; /* BIG and ROUNDED (den a power of two) use big */
  int16_t a, b;
  int32_t kind;
} qn_num;

#define QN_NUM_ZERO ((qn_num){{0}, 0, 0, QN_NUM_SMALL})
#define QN_NUM_ONE ((qn_num){{1}, 0, 0, QN_NUM_SMALL})

qn_num qn_num_from_int(qn_ctx *ctx, int64_t v);
qn_num qn_num_from_double(qn_ctx *ctx, double v); /* finite; exactly v */
qn_num qn_num_from_rat(qn_ctx *ctx, qn_int num, qn_int den, int rounded); /* den != 0; reduces */
qn_num qn_num_copy(qn_ctx *to, qn_num a); /* into another context's arena */

/* Reads a decimal: [+-]digits[.digits][(e|E)[+-]digits], at least one digit. Returns the bytes it read, 0 when there is
   no number; *status is QUOIN_E_LIMIT when it passes QN_MAX_DIGITS or QN_MAX_EXPONENT. Fast for usual literals. */
size_t qn_num_read(qn_ctx *ctx, const char *text, size_t length, qn_num *out, quoin_status *status);

QN_INLINE int qn_num_is_zero(qn_num a) { return a.kind == QN_NUM_SMALL && a.u.m == 0; }
QN_INLINE int qn_num_is_rounded(qn_num a) { return a.kind == QN_NUM_ROUNDED; }
int qn_num_sign(qn_num a);
int qn_num_cmp(qn_ctx *ctx, qn_num a, qn_num b); /* by value; when either is rounded, equal if they agree to QN_S2_BITS of the larger */
int qn_num_equal(qn_num a, qn_num b);            /* the same form: same value and both or neither rounded */
int qn_num_is_integer(qn_num a, int64_t *out);   /* and fits */
qn_rat qn_num_rat(qn_ctx *ctx, qn_num a);        /* numerator and denominator */

qn_num qn_num_neg(qn_ctx *ctx, qn_num a);
qn_num qn_num_abs(qn_ctx *ctx, qn_num a);
qn_num qn_num_add(qn_ctx *ctx, qn_num a, qn_num b);
qn_num qn_num_sub(qn_ctx *ctx, qn_num a, qn_num b);
qn_num qn_num_mul(qn_ctx *ctx, qn_num a, qn_num b);
qn_num qn_num_div(qn_ctx *ctx, qn_num a, qn_num b); /* b != 0 */
qn_num qn_num_mod(qn_ctx *ctx, qn_num a, qn_num b); /* fmod: sign of a; b != 0 */
qn_num qn_num_floor(qn_ctx *ctx, qn_num a);
qn_num qn_num_ceil(qn_ctx *ctx, qn_num a);
qn_num qn_num_round(qn_ctx *ctx, qn_num a); /* halves away from zero */
/* The sum of a[i] b[i], cancelled terms judged against the largest term of the whole sum. */
qn_num qn_num_dot(qn_ctx *ctx, size_t n, const qn_num *a, const qn_num *b);

/* Irrational functions (irrational.c): the exact value where there is one, else correctly rounded by MPFR to
   QN_S2_PRECISION bits. Angles are degrees. */
qn_num qn_num_sqrt(qn_ctx *ctx, qn_num a); /* a >= 0; exact for squares of rationals */
qn_num qn_num_sin(qn_ctx *ctx, qn_num a);  /* exact at multiples of 30 that give rationals */
qn_num qn_num_cos(qn_ctx *ctx, qn_num a);
int qn_num_tan(qn_ctx *ctx, qn_num a, qn_num *out); /* 0 at odd multiples of 90 */
qn_num qn_num_asin(qn_ctx *ctx, qn_num a);          /* |a| <= 1 */
qn_num qn_num_acos(qn_ctx *ctx, qn_num a);
qn_num qn_num_atan(qn_ctx *ctx, qn_num a);
qn_num qn_num_atan2(qn_ctx *ctx, qn_num y, qn_num x);
qn_num qn_num_exp(qn_ctx *ctx, qn_num a);
qn_num qn_num_ln(qn_ctx *ctx, qn_num a); /* a > 0 */
int qn_num_pow(qn_ctx *ctx, qn_num a, qn_num b, qn_num *out); /* integer powers exactly, roots exactly where rational; 0 when undefined (0 to a negative, negative to a fraction) */
qn_num qn_num_pi(qn_ctx *ctx); /* rounded */
/* s / sqrt(n) for s = sin of `degrees`, exact where sin^2 / n is the square of a rational (rotation about a slanted axis). n > 0. */
qn_num qn_num_sin_over_sqrt(qn_ctx *ctx, qn_num degrees, qn_num n);

double qn_num_to_double(qn_num a); /* correctly rounded: nearest, ties to even; infinite beyond the range */
/* hi + lo: hi is the nearest double, lo the nearest double to the rest; |a - hi - lo| <= 2^-106 |a| unless lo underflows. */
void qn_num_to_dd(qn_ctx *ctx, qn_num a, double *hi, double *lo);

/* The same and its like without any memory, for small numbers of usual size; 0 for others, which are left to the functions above.
   hi, lo: as of qn_num_to_dd. down: the largest double not above a - b, up: the least not below a + b, b >= 0. out: nearest to a^2.
   Cost: 20 to 50 ns. */
QN_NODISCARD int qn_num_quick_pair(qn_num a, double *hi, double *lo);
QN_NODISCARD int qn_num_quick_span(qn_num a, qn_num b, double *down, double *up);
QN_NODISCARD int qn_num_quick_square(qn_num a, double *out);

/* The decimal at the start of a text ended by NUL, as qn_num_read takes it: the double nearest to it (ties to even), and whether that is it
   exactly. Returns the bytes read; 0 for what is no decimal, or has more than 19 digits that count or an unusual exponent, and is left to
   qn_num_read. No memory. Cost: 10 to 25 ns. */
size_t qn_decimal_quick(const char *text, double *nearest, int *exact);
/* The same, with what the nearest double lacks: to 2^-104 of the number; 0 where nothing. */
size_t qn_decimal_quick_pair(const char *text, double *high, double *low);

/* The value as the shortest text that reads back to it: "0.1", "2.5e-07", "(1/3)", and for a rounded number
   "rounded(M/2^K)" or "rounded(M*2^K)". Into the arena; null on failure. */
char *qn_num_text(qn_ctx *ctx, qn_num a);

#endif
