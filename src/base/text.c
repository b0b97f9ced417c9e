// text.c -- growing texts, and numbers as text in any locale.
//
// A program around the library may have set a locale with a decimal comma. Reading and writing of numbers therefore happens with the "C"
// locale put on for the calling thread alone.

#include "base/text.h"

#include <errno.h>
#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

pls_status pls_text_print(pls_text *text, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (length < 0) return pls_fail(PLS_INVALID_ARGUMENT, "cannot format a text with \"%s\"", format);

    size_t size = (size_t)length;
    PLS_TRY(pls_reserve(&text->data, &text->capacity, text->size + size + 1, 1, "a text"));
    va_start(arguments, format);
    vsnprintf(text->data + text->size, size + 1, format, arguments);
    va_end(arguments);
    text->size += size;
    return PLS_OK;
}

pls_status pls_text_append(pls_text *text, const char *data, size_t size)
{
    size_t needed;
    if (__builtin_add_overflow(text->size + 1, size, &needed))
        return pls_fail(PLS_OUT_OF_MEMORY, "cannot append %zu bytes to a text", size);
    PLS_TRY(pls_reserve(&text->data, &text->capacity, needed, 1, "a text"));
    if (size > 0) memcpy(text->data + text->size, data, size);
    text->size += size;
    text->data[text->size] = '\0';
    return PLS_OK;
}

void pls_text_free(pls_text *text)
{
    pls_release(&text->data);
    *text = (pls_text){0};
}

/// Put on the "C" locale for this thread; returns the one to go back to. The C library keeps its "C" locale as a constant, so this neither
/// allocates nor fails; should it ever fail, the thread's locale stays.
static locale_t enter_c_locale(locale_t *c_locale)
{
    *c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    return *c_locale ? uselocale(*c_locale) : (locale_t)0;
}

static void leave_c_locale(locale_t c_locale, locale_t before)
{
    if (!c_locale) return;
    uselocale(before);
    freelocale(c_locale);
}

const char *pls_format_double(char buffer[32], double value)
{
    enum { SIZE = 32 };
    if (isnan(value)) return strcpy(buffer, "nan");
    if (isinf(value)) return strcpy(buffer, value > 0 ? "inf" : "-inf");
    locale_t c_locale;
    locale_t before = enter_c_locale(&c_locale);
    // 15 digits always survive in a normal number, and %g drops the zeros among them; subnormal numbers may need fewer.
    int digits = fabs(value) < DBL_MIN ? 1 : DBL_DIG;
    for (; digits <= DBL_DECIMAL_DIG; ++digits)
    {
        snprintf(buffer, SIZE, "%.*g", digits, value);
        if (strtod(buffer, NULL) == value) break;
    }
    leave_c_locale(c_locale, before);
    return buffer;
}

/// The value of `text` without its sign when it is one of the names.
static int parse_name(const char *text, double *value)
{
    if (strcmp(text, "inf") == 0)
        *value = INFINITY;
    else if (strcmp(text, "nan") == 0)
        *value = NAN;
    else
        return 0;
    return 1;
}

int pls_parse_double(const char *text, double *value)
{
    const char *digits = text + (*text == '+' || *text == '-');
    double result;
    if (parse_name(digits, &result))
    {
        *value = *text == '-' ? -result : result;
        return 1;
    }
    // strtod also takes blanks, hexadecimal and "infinity"; none of them passes here.
    if (!*digits || digits[strspn(digits, "0123456789.eE+-")] != '\0') return 0;

    locale_t c_locale;
    locale_t before = enter_c_locale(&c_locale);
    int errno_before = errno;
    char *end;
    result = strtod(text, &end);
    errno = errno_before;
    leave_c_locale(c_locale, before);
    if (end == text || *end != '\0' || isinf(result)) return 0; // infinite: too large for a double
    *value = result;
    return 1;
}
