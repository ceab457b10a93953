/* A text that grows, and the few forms in which the commands print names and numbers. */
#ifndef QN_CLI_TEXT_H
#define QN_CLI_TEXT_H

#include <stddef.h>

/* data holds length bytes; it is not ended by NUL. When memory runs out, `failed` is set and the rest is dropped: who
   prints the text looks at it once, at the end. Start from zeros. */
typedef struct cli_text {
  char *data;
  size_t length, capacity;
  int failed;
} cli_text;

void cli_text_free(cli_text *text);

void cli_put(cli_text *text, const char *bytes, size_t length);
void cli_puts(cli_text *text, const char *words);
void cli_putf(cli_text *text, const char *format, ...); /* up to 255 bytes */

/* %.17g: the double comes back from it bit for bit; "inf" and "-inf" where it is. */
void cli_put_number(cli_text *text, double x);
/* A name as one field between tabs: control bytes and backslashes are written \t, \n, \r, \\ or \xHH. */
void cli_put_field(cli_text *text, const char *name);

/* JSON: a string in quotes, always valid UTF-8 (a wrong byte becomes U+FFFD); a number, with "inf" and "-inf" in quotes. */
void cli_put_json(cli_text *text, const char *string);
void cli_put_json_number(cli_text *text, double x);

#endif
