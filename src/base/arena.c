// arena.c -- chunks filled front to back and freed together.
//
// A request too large for what is left of the newest chunk opens another one. A request larger than a standard chunk gets a chunk of its
// own size behind the newest, so that the newest goes on being filled.

#include "base/arena.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { CHUNK_BYTES = 16384, SMALL_ALIGNMENT = 16 };

struct pls_arena_chunk
{
    pls_arena_chunk *next; ///< older
    size_t size;           ///< bytes of `data`
    _Alignas(PLS_ALIGNMENT) char data[];
};

static pls_status new_chunk(pls_arena_chunk **chunk, size_t size, const char *what)
{
    size_t total;
    if (__builtin_add_overflow(size, sizeof(pls_arena_chunk), &total)) total = SIZE_MAX; // too large either way; the allocator says so
    PLS_TRY(pls_allocate(chunk, total, 1, what));
    (*chunk)->size = size;
    return PLS_OK;
}

pls_status pls_arena_allocate(pls_arena *arena, void *block, size_t count, size_t size, const char *what)
{
    void *result = NULL;
    memcpy(block, &result, sizeof result);
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes)) return pls_allocate(block, count, size, what); // fails with the right message
    if (bytes == 0) return PLS_OK;

    size_t alignment = size >= PLS_ALIGNMENT ? PLS_ALIGNMENT : SMALL_ALIGNMENT;
    size_t offset = (arena->used + alignment - 1) / alignment * alignment;
    bool fits = arena->chunks && offset <= arena->chunks->size && bytes <= arena->chunks->size - offset;
    if (fits)
    {
        result = arena->chunks->data + offset;
        arena->used = offset + bytes;
    }
    else
    {
        pls_arena_chunk *chunk;
        PLS_TRY(new_chunk(&chunk, bytes > CHUNK_BYTES ? bytes : CHUNK_BYTES, what));
        if (bytes > CHUNK_BYTES && arena->chunks)
        {
            chunk->next = arena->chunks->next;
            arena->chunks->next = chunk;
        }
        else
        {
            chunk->next = arena->chunks;
            arena->chunks = chunk;
            arena->used = bytes;
        }
        result = chunk->data;
    }
    memcpy(block, &result, sizeof result);
    return PLS_OK;
}

pls_status pls_arena_copy_text(pls_arena *arena, const char **copy, const char *text)
{
    size_t size = strlen(text) + 1;
    char *data;
    *copy = NULL;
    PLS_TRY(pls_arena_allocate(arena, &data, size, 1, "a text"));
    memcpy(data, text, size);
    *copy = data;
    return PLS_OK;
}

pls_status pls_arena_print(pls_arena *arena, const char **text, const char *format, ...)
{
    *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (length < 0) return pls_fail(PLS_INVALID_ARGUMENT, "cannot format a text with \"%s\"", format);

    char *data;
    size_t size = (size_t)length + 1;
    PLS_TRY(pls_arena_allocate(arena, &data, size, 1, "a text"));
    va_start(arguments, format);
    vsnprintf(data, size, format, arguments);
    va_end(arguments);
    *text = data;
    return PLS_OK;
}

void pls_arena_clear(pls_arena *arena)
{
    while (arena->chunks)
    {
        pls_arena_chunk *next = arena->chunks->next;
        pls_release(&arena->chunks);
        arena->chunks = next;
    }
    arena->used = 0;
}
