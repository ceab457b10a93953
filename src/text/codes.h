/* Every diagnostic of the language: one row a code. Documented in docs/language.md, an example of each in tests/model/golden. */
#ifndef QN_TEXT_CODES_H
#define QN_TEXT_CODES_H

#include "quoin/types.h"

/* X(enumerator and text of the code, severity, meaning) */
#define QN_CODES(X) \
  X(Q0101, QUOIN_ERROR, "the file is not text") \
  X(Q0102, QUOIN_ERROR, "a character that has no meaning here, or bytes that are not UTF-8") \
  X(Q0103, QUOIN_ERROR, "a string without its closing quote") \
  X(Q0104, QUOIN_ERROR, "a comment without its end") \
  X(Q0105, QUOIN_ERROR, "an unknown escape in a string") \
  X(Q0106, QUOIN_ERROR, "a malformed number") \
  X(Q0201, QUOIN_ERROR, "something else was expected here") \
  X(Q0202, QUOIN_ERROR, "a missing ';'") \
  X(Q0203, QUOIN_ERROR, "a bracket that is never closed") \
  X(Q0204, QUOIN_ERROR, "a closing bracket without its opening one") \
  X(Q0205, QUOIN_ERROR, "an expression was expected") \
  X(Q0206, QUOIN_ERROR, "an assignment where a solid was expected") \
  X(Q0210, QUOIN_ERROR, "a form of expression that is not supported yet") \
  X(Q0301, QUOIN_ERROR, "an unknown name") \
  X(Q0302, QUOIN_ERROR, "a name used before its value is known") \
  X(Q0303, QUOIN_ERROR, "an unknown function") \
  X(Q0304, QUOIN_ERROR, "a function that is not supported yet") \
  X(Q0305, QUOIN_ERROR, "an operation that is not defined for these values") \
  X(Q0306, QUOIN_ERROR, "an index out of range") \
  X(Q0307, QUOIN_ERROR, "wrong arguments of a function") \
  X(Q0308, QUOIN_WARNING, "a name is assigned twice in one scope") \
  X(Q0309, QUOIN_ERROR, "an assertion failed") \
  X(Q0310, QUOIN_NOTE, "echo") \
  X(Q0401, QUOIN_ERROR, "an unknown word") \
  X(Q0402, QUOIN_ERROR, "a word that is not supported yet") \
  X(Q0403, QUOIN_WARNING, "an unknown argument") \
  X(Q0404, QUOIN_WARNING, "too many arguments without a name") \
  X(Q0405, QUOIN_WARNING, "an argument is given twice") \
  X(Q0406, QUOIN_ERROR, "an argument of the wrong type") \
  X(Q0407, QUOIN_ERROR, "children of a word that takes none") \
  X(Q0408, QUOIN_WARNING, "two arguments say the same thing") \
  X(Q0409, QUOIN_ERROR, "a scene word inside a solid") \
  X(Q0410, QUOIN_WARNING, "a second camera or background") \
  X(Q0411, QUOIN_WARNING, "a second '!'") \
  X(Q0412, QUOIN_ERROR, "a missing argument") \
  X(Q0413, QUOIN_WARNING, "an unknown colour") \
  X(Q0414, QUOIN_WARNING, "a part of a colour that is not from 0 to 1") \
  X(Q0501, QUOIN_WARNING, "a size of zero or less: an empty solid") \
  X(Q0502, QUOIN_WARNING, "a number that is not finite: an empty solid") \
  X(Q0503, QUOIN_WARNING, "a singular transform: an empty solid") \
  X(Q0504, QUOIN_ERROR, "a matrix that is not affine") \
  X(Q0505, QUOIN_NOTE, "$fn is ignored, curved surfaces are exact") \
  X(Q0506, QUOIN_ERROR, "elliptic ends of different shape") \
  X(Q0508, QUOIN_ERROR, "a value that makes no such solid") \
  X(Q0509, QUOIN_ERROR, "a quadric's matrix that is not symmetric") \
  X(Q0510, QUOIN_ERROR, "a polyhedron that is not convex") \
  X(Q0511, QUOIN_ERROR, "a polyhedron that is not closed") \
  X(Q0512, QUOIN_ERROR, "a face that is not plane") \
  X(Q0513, QUOIN_ERROR, "a malformed list of points or faces") \
  X(Q0514, QUOIN_WARNING, "a polyhedron that is inside out") \
  X(Q0801, QUOIN_ERROR, "a file cannot be read") \
  X(Q0901, QUOIN_ERROR, "nested too deeply") \
  X(Q0902, QUOIN_ERROR, "number too long") \
  X(Q0903, QUOIN_ERROR, "number out of range") \
  X(Q0904, QUOIN_ERROR, "exact number too large") \
  X(Q0905, QUOIN_ERROR, "file too large") \
  X(Q0906, QUOIN_ERROR, "too many primitives") \
  X(Q0907, QUOIN_ERROR, "too many faces") \
  X(Q0908, QUOIN_NOTE, "too many errors; the rest of the file was not read") \
  X(Q0909, QUOIN_NOTE, "more diagnostics of one kind than are shown") \
  X(Q0910, QUOIN_ERROR, "too much arithmetic")

typedef enum qn_code {
#define X(code, severity, meaning) QN_##code,
  QN_CODES(X)
#undef X
  QN_CODE_COUNT
} qn_code;

typedef struct qn_code_row {
  const char *text; /* "Q0101" */
  quoin_severity severity;
  const char *meaning;
} qn_code_row;
extern const qn_code_row qn_codes[QN_CODE_COUNT];

#endif
