// group.c -- see group.h.

#include "observe/group.h"

#include "base/registry.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/// Groups that a message compares with and lists; more would not be read.
enum { MOST_NAMES = 64, LIST_SIZE = 600 };

static void append(char *text, size_t size, const char *format, ...) __attribute__((format(printf, 3, 4)));
static void append(char *text, size_t size, const char *format, ...)
{
    size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, size - used, format, arguments);
    va_end(arguments);
}

void pls_describe_names(char *text, size_t size, const char *wrong, const char *const *names, size_t count)
{
    text[0] = '\0';
    const char *nearest = pls_nearest_word(wrong, names, count);
    if (nearest) append(text, size, " (did you mean '%s'?)", nearest);
    append(text, size, "%s", count > 0 ? "; there are " : "; there are none");
    for (size_t k = 0; k < count; ++k)
    {
        if (strlen(text) + strlen(names[k]) + 16 > size)
        {
            append(text, size, " ...");
            return;
        }
        append(text, size, "%s%s", k > 0 ? ", " : "", names[k]);
    }
}

pls_status pls_find_observed_group(const pls_world *world, const char *name, uint32_t *index1)
{
    *index1 = 0;
    if (name[0] == '\0' || strcmp(name, "all") == 0) return PLS_OK;
    *index1 = pls_world_find_group(world, name).index1;
    if (*index1 != 0) return PLS_OK;

    const char *names[MOST_NAMES];
    size_t count = 0;
    const char *next;
    while (count < MOST_NAMES && (next = pls_world_group_name(world, (pls_group_id){(uint32_t)count + 1}))[0]) names[count++] = next;
    char list[LIST_SIZE];
    pls_describe_names(list, sizeof list, name, names, count);
    return pls_fail(PLS_NOT_FOUND, "there is no group '%s'%s", name, list);
}
