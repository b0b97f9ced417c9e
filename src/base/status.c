// status.c -- status codes and the failure message of each thread.
//
// The message lives in a thread-local array, so that recording one can never fail, also not when memory has run out. A new message is
// formatted beside the old one first, because its arguments may point into the old one ("%s", pls_last_message()).

#include <particls/status.h>

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum {
    BUFFER_SIZE = 2048,
    MESSAGE_LIMIT = 2000 ///< characters kept, as promised by pls_fail
};

static _Thread_local char last_message[BUFFER_SIZE];

const char *pls_status_text(pls_status status)
{
    static const char *const texts[] = {
#define PLS_STATUS_TEXT(name, text) text,
        PLS_STATUS_LIST(PLS_STATUS_TEXT)
#undef PLS_STATUS_TEXT
    };
    return (unsigned)status < PLS_STATUS_COUNT ? texts[status] : "unknown status";
}

const char *pls_status_name(pls_status status)
{
    static const char *const names[] = {
#define PLS_STATUS_NAME(name, text) #name,
        PLS_STATUS_LIST(PLS_STATUS_NAME)
#undef PLS_STATUS_NAME
    };
    return (unsigned)status < PLS_STATUS_COUNT ? names[status] : "UNKNOWN";
}

const char *pls_last_message(void) { return last_message; }

/// Cut `text` at MESSAGE_LIMIT bytes, or just before them where that would split a UTF-8 character.
static void cut(char *text)
{
    if (strlen(text) <= MESSAGE_LIMIT) return;
    size_t end = MESSAGE_LIMIT;
    while (end > 0 && ((unsigned char)text[end] & 0xC0U) == 0x80U) --end;
    text[end] = '\0';
}

static void format_message(char text[BUFFER_SIZE], const char *format, va_list arguments)
{
    // vsnprintf fails only for text that cannot be converted; the format is then the best there is.
    if (vsnprintf(text, BUFFER_SIZE, format, arguments) < 0) snprintf(text, BUFFER_SIZE, "%s", format);
    cut(text);
}

pls_status pls_fail(pls_status status, const char *format, ...)
{
    char text[BUFFER_SIZE];
    va_list arguments;
    va_start(arguments, format);
    format_message(text, format, arguments);
    va_end(arguments);
    memcpy(last_message, text, strlen(text) + 1);
    return status;
}

pls_status pls_fail_context(pls_status status, const char *format, ...)
{
    if (status == PLS_OK) return status; // so that a call's result can be passed straight through
    char text[BUFFER_SIZE];
    va_list arguments;
    va_start(arguments, format);
    format_message(text, format, arguments);
    va_end(arguments);

    size_t used = strlen(text);
    size_t kept = strlen(last_message);
    if (kept > BUFFER_SIZE - 1 - used) kept = BUFFER_SIZE - 1 - used;
    memcpy(text + used, last_message, kept);
    text[used + kept] = '\0';
    cut(text);
    memcpy(last_message, text, strlen(text) + 1);
    return status;
}
