// text.h -- growing text buffers and number formatting.
#ifndef PLS_BASE_TEXT_H
#define PLS_BASE_TEXT_H

#include "base/alloc.h"

/// A growing, always terminated text. Zero-initialise; `pls_text_free` releases. `data` may be null while empty.
typedef struct pls_text
{
    char *data;
    size_t size; ///< without the terminator
    size_t capacity;
} pls_text;

pls_status pls_text_print(pls_text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));
pls_status pls_text_append(pls_text *text, const char *data, size_t size);
void pls_text_free(pls_text *text);

/// Shortest decimal that reads back as the same double ("0.1", "1e-05", "nan", "inf"), locale-independent. `buffer` holds 32 bytes.
const char *pls_format_double(char buffer[32], double value);
/// Locale-independent strtod of the whole text: a decimal number, "inf" or "nan", with or without a sign. False for anything else: blanks,
/// hexadecimal, text behind the number, a number too large for a double.
int pls_parse_double(const char *text, double *value);

#endif
