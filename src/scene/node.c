// node.c -- look-ups in the tree and messages that show the place.

#include "scene/node.h"

#include "base/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum {
    MESSAGE_SIZE = 1200, ///< the sentence itself
    EXCERPT_WIDTH = 110, ///< characters of a source line that are shown
    CONTEXT_BEFORE = 60  ///< of which at most so many in front of the mark when the line is longer
};

pls_node *pls_node_get(const pls_node *map, const char *key)
{
    if (!map || map->kind != PLS_NODE_MAP) return NULL;
    for (size_t k = 0; k < map->count; ++k)
    {
        if (strcmp(map->key[k]->text, key) == 0) return map->child[k];
    }
    return NULL;
}

const pls_node *pls_node_key(const pls_node *map, const char *key)
{
    if (!map || map->kind != PLS_NODE_MAP) return NULL;
    for (size_t k = 0; k < map->count; ++k)
    {
        if (strcmp(map->key[k]->text, key) == 0) return map->key[k];
    }
    return NULL;
}

bool pls_node_is_null(const pls_node *node)
{
    if (node->kind != PLS_NODE_SCALAR || node->quoted) return false;
    return node->text[0] == '\0' || strcmp(node->text, "~") == 0 || strcmp(node->text, "null") == 0;
}

const char *pls_node_describe(const pls_node *node)
{
    if (node->kind == PLS_NODE_LIST) return "a list";
    if (node->kind == PLS_NODE_MAP) return "a map";
    if (pls_node_is_null(node)) return "nothing";
    double number;
    if (!node->quoted && pls_parse_double(node->text, &number)) return "a number";
    if (!node->quoted && (strcmp(node->text, "true") == 0 || strcmp(node->text, "false") == 0)) return "a boolean";
    return "a text";
}

pls_status pls_node_new(pls_arena *arena, pls_node_kind kind, const pls_node *like, pls_node **node)
{
    PLS_TRY(pls_arena_allocate(arena, node, 1, sizeof **node, "a scene node"));
    (*node)->kind = kind;
    (*node)->text = "";
    if (!like) return PLS_OK;
    (*node)->source = like->source;
    (*node)->line = like->line;
    (*node)->column = like->column;
    return PLS_OK;
}

pls_status pls_node_append(pls_arena *arena, pls_node *parent, pls_node *key, pls_node *child)
{
    // Capacity is the power of two at or above the count, so it need not be stored.
    if ((parent->count & (parent->count - 1)) == 0)
    {
        size_t room = parent->count ? 2 * parent->count : 1;
        pls_node **grown;
        PLS_TRY(pls_arena_allocate(arena, &grown, room, sizeof *grown, "scene nodes"));
        if (parent->count) memcpy(grown, parent->child, parent->count * sizeof(pls_node *));
        parent->child = grown;
        if (parent->kind == PLS_NODE_MAP)
        {
            PLS_TRY(pls_arena_allocate(arena, &grown, room, sizeof *grown, "scene nodes"));
            if (parent->count) memcpy(grown, parent->key, parent->count * sizeof(pls_node *));
            parent->key = grown;
        }
    }
    if (parent->kind == PLS_NODE_MAP) parent->key[parent->count] = key;
    parent->child[parent->count++] = child;
    return PLS_OK;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// messages

static bool starts_character(char byte) { return ((unsigned char)byte & 0xC0U) != 0x80U; }

/// Start and size in bytes of a line (from 1), without its end. Empty when there is none.
static void find_line(const pls_source *source, int line, const char **start, size_t *size)
{
    const char *at = source->text, *end = source->text + source->size;
    for (int k = 1; k < line && at < end; ++k)
    {
        const char *next = memchr(at, '\n', (size_t)(end - at));
        at = next ? next + 1 : end;
    }
    const char *stop = at < end ? memchr(at, '\n', (size_t)(end - at)) : NULL;
    if (!stop) stop = end;
    if (stop > at && stop[-1] == '\r') --stop;
    *start = at;
    *size = (size_t)(stop - at);
}

/// The source line and a mark under the column: "   14 |   ball: {...}\n      |          ^". Long lines are cut around the mark.
static void format_excerpt(const pls_source *source, int line, int column, char *out, size_t size)
{
    const char *text;
    size_t bytes;
    find_line(source, line, &text, &bytes);
    int characters = 0;
    for (size_t k = 0; k < bytes; ++k) characters += starts_character(text[k]);
    int first = 1;
    if (characters > EXCERPT_WIDTH && column > CONTEXT_BEFORE) first = column - CONTEXT_BEFORE + 1;

    size_t used = (size_t)snprintf(out, size, "%5d | %s", line, first > 1 ? "..." : "");
    int at = 0;
    for (size_t k = 0; k < bytes && used + 8 < size; ++k)
    {
        at += starts_character(text[k]);
        if (at < first) continue;
        if (at >= first + EXCERPT_WIDTH) break;
        out[used++] = (char)(text[k] == '\t' ? ' ' : text[k]);
    }
    out[used] = '\0';
    int indent = column - first + (first > 1 ? 3 : 0);
    snprintf(out + used, size - used, "%s\n      | %*s^", characters >= first + EXCERPT_WIDTH ? "..." : "", indent > 0 ? indent : 0, "");
}

static pls_status fail_at_place(const pls_source *source, int line, int column, const char *hint, const char *message)
{
    const char *gap = hint && *hint ? "\n  " : "";
    if (!hint) hint = "";
    if (!source || !source->has_lines) return pls_fail(PLS_SCENE, "%s: %s%s%s", source ? source->name : "scene", message, gap, hint);
    char excerpt[640];
    format_excerpt(source, line, column, excerpt, sizeof excerpt);
    return pls_fail(PLS_SCENE, "%s:%d:%d: %s\n%s%s%s", source->name, line, column, message, excerpt, gap, hint);
}

pls_status pls_source_fail(const pls_source *source, int line, int column, const char *hint, const char *format, ...)
{
    char message[MESSAGE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return fail_at_place(source, line, column, hint, message);
}

pls_status pls_node_fail(const pls_node *at, const char *hint, const char *format, ...)
{
    char message[MESSAGE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return fail_at_place(at->source, at->line, at->column, hint, message);
}

pls_status pls_node_fail_at(const pls_node *at, size_t offset, const char *hint, const char *format, ...)
{
    char message[MESSAGE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    int column = at->column;
    if (at->exact)
    {
        column += at->quoted;
        for (size_t k = 0; k < offset && at->text[k]; ++k) column += starts_character(at->text[k]);
    }
    return fail_at_place(at->source, at->line, column, hint, message);
}

/// The last message, with the place in front and, unless something within showed its own, the source line below.
static pls_status show_place(pls_status status, const pls_node *at, const char *what)
{
    const char *gap = *what ? ": " : "";
    if (!at->source->has_lines) return pls_fail_context(status, "%s: %s%s", at->source->name, what, gap);
    const bool shown = strchr(pls_last_message(), '\n') != NULL;
    pls_fail_context(status, "%s:%d:%d: %s%s", at->source->name, at->line, at->column, what, gap);
    if (shown) return status;
    char excerpt[640];
    format_excerpt(at->source, at->line, at->column, excerpt, sizeof excerpt);
    return pls_fail(status, "%s\n%s", pls_last_message(), excerpt);
}

pls_status pls_node_context(pls_status status, const pls_node *at, const char *format, ...)
{
    if (status == PLS_OK || status == PLS_OUT_OF_MEMORY) return status;
    char message[MESSAGE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    if (!at->source) return pls_fail_context(status, "%s: ", message);
    return show_place(status, at, message);
}
