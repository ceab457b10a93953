/* Every limit of the library: its purpose, its unit, and what is said when it is met. Nothing else bounds an input. */
#ifndef QN_BASE_LIMITS_H
#define QN_BASE_LIMITS_H

/* Nesting of braces and parentheses in a text, levels. The reader and everything behind it iterate or keep stacks of
   their own on the heap, so this bounds memory, not the C stack. Met: Q0901 "nested too deeply". */
#define QN_MAX_DEPTH 200000

/* Digits of one number literal (without leading zeros). Met: Q0902 "number too long". */
#define QN_MAX_DIGITS 10000

/* Decimal exponent of a literal or a result, either sign. Numbers beyond it would only slow exact arithmetic down.
   Met: Q0903 "number out of range". */
#define QN_MAX_EXPONENT 4000

/* Bits of the numerator or denominator of one exact number during evaluation (`x = 3 ^ 100000;`).
   Met: Q0904 "exact number too large". */
#define QN_MAX_BITS (1 << 17)

/* Bits of the numerator or denominator of a number that is kept in a model, so that every number which a tree prints
   has fewer than QN_MAX_DIGITS digits and can be read again. Met: Q0904 "exact number too large". */
#define QN_MAX_KEPT_BITS (1 << 15)

/* Bits of one exact number while maps and surfaces of a scene are composed: transforms nested in transforms multiply. Met:
   QUOIN_E_LIMIT from the compilation, or from a question that needs that surface exactly. */
#define QN_MAX_SCENE_BITS ((size_t)1 << 22)

/* Vectors within vectors as values, levels; arithmetic on them may recurse so deep. Met: Q0901 "nested too deeply". */
#define QN_MAX_VECTOR_DEPTH 64

/* Bytes of one model text; places are kept in 32 bits. Met: Q0905 "file too large". */
#define QN_MAX_TEXT ((size_t)1 << 31)

/* Texts and files read into one model whose names are kept apart in diagnostics: a place holds 12 bits for them. More may be
   read; met, the names of further ones are given as "(another text)". */
#define QN_MAX_FILES 4095

/* Leaves of one model. Met: Q0906 "too many primitives". */
#define QN_MAX_LEAVES ((size_t)1 << 28)

/* Faces of one polygonal primitive ($fn of a prism). Met: Q0907. */
#define QN_MAX_FACES 4096

/* Worker threads. More are not refused, only not used. */
#define QN_MAX_THREADS 256

#endif
