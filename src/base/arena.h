// arena.h -- many small allocations with one lifetime (the scene's texts, a rebuild's scratch).
#ifndef PLS_BASE_ARENA_H
#define PLS_BASE_ARENA_H

#include "base/alloc.h"

typedef struct pls_arena_chunk pls_arena_chunk;

/// Zero-initialise; `pls_arena_clear` frees all.
typedef struct pls_arena
{
    pls_arena_chunk *chunks;
    size_t used; ///< bytes used of the newest chunk
} pls_arena;

/// `count` zeroed items of `size` bytes, 16-byte aligned (64 when the item is 64 bytes or larger).
pls_status pls_arena_allocate(pls_arena *arena, void *block, size_t count, size_t size, const char *what);
pls_status pls_arena_copy_text(pls_arena *arena, const char **copy, const char *text);
pls_status pls_arena_print(pls_arena *arena, const char **text, const char *format, ...) __attribute__((format(printf, 3, 4)));
void pls_arena_clear(pls_arena *arena);

#endif
