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

/* Effort of the arithmetic in one text: QN_MAX_EFFORT and QN_EFFORT_PER_BYTE for each byte of the text. The unit is some half of a nanosecond: a result of n limbs
   counts n^2 of them, an element of a vector made or compared QN_EFFORT_ELEMENT, which bounds memory too, a byte of a string that is looked at QN_EFFORT_BYTE. Without
   it a vector of two vectors of two vectors ... is 2^60 numbers in a text of 1000 bytes. Met: Q0910 "too much arithmetic". */
#define QN_MAX_EFFORT (UINT64_C(1) << 30)
#define QN_EFFORT_PER_BYTE 1024
#define QN_EFFORT_ELEMENT 256
#define QN_EFFORT_BYTE 4
#define QN_EFFORT_NAME 16 /* a byte of a name of a part, which is kept */

/* Bits of one exact number while maps and surfaces of a scene are composed: transforms nested in transforms multiply. Met:
   QUOIN_E_LIMIT from the compilation, or from a question that needs that surface exactly. */
#define QN_MAX_SCENE_BITS ((size_t)1 << 22)

/* Effort, as above, of composing one thread's maps exactly: in all, and for each node of the model; of one surface made on demand. A tower of 100,000 scalings by 3 would keep
   numbers of 20 kB at every step. Met: QUOIN_E_LIMIT as above. */
#define QN_MAX_SCENE_EFFORT (UINT64_C(1) << 31)
#define QN_SCENE_EFFORT_PER_NODE (1 << 15)

/* Effort, as above, of one question, a ray or a point: in all, and for each leaf of the scene. What costs more than the number of leaves
   counts: cells next to points in hundreds of surfaces, and stretches or contacts of a line in as many. Met: QUOIN_E_LIMIT from the question. */
#define QN_MAX_QUESTION_EFFORT (UINT64_C(3) << 30)
#define QN_QUESTION_EFFORT_PER_LEAF (1 << 15)
#define QN_EFFORT_CELL 192  /* a sign of a cell, which is the sign of some products */
#define QN_EFFORT_CHANGE 24 /* a half-space or an event looked at in a cell, and what it changes in the program */

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
