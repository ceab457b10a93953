/* Numbers as text. */
#ifndef QN_CLI_NUMBER_H
#define QN_CLI_NUMBER_H

#include <stddef.h>

enum { CLI_NUMBER_SIZE = 32 }; /* holds any double as %.17g */
/* What printf("%.17g", x) writes in the C locale, without a NUL where it is not printf that writes it; returns the bytes. Cost: some 20 ns for 1e-38 < |x| < 1e17. */
size_t cli_format_number(char out[CLI_NUMBER_SIZE], double x);

#endif
