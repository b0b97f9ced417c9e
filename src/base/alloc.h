// alloc.h -- checked allocation through the injectable allocator of <particls/memory.h>.
//
// Blocks are 64-byte aligned (a cache line, an AVX-512 vector) and zeroed. A 64-byte header in front of each block holds its size,
// so that releasing needs no size and the bytes in use are known. Sizes are computed with overflow checks.
#ifndef PLS_BASE_ALLOC_H
#define PLS_BASE_ALLOC_H

#include <particls/memory.h>
#include <stddef.h>

enum { PLS_ALIGNMENT = 64 };

/// Allocate `count` zeroed items of `size` bytes into `*block` (any pointer type's address; set to null on failure).
/// `what` names the thing in the error message ("the pair list"). A count of zero gives null and PLS_OK.
pls_status pls_allocate(void *block, size_t count, size_t size, const char *what);

/// Grow or shrink `*block` from `old_count` to `new_count` items, keeping contents and zeroing what is new. On failure the old block stays.
pls_status pls_reallocate(void *block, size_t old_count, size_t new_count, size_t size, const char *what);

/// Make room for `needed` items: capacity grows by half at least. `*capacity` is updated. On failure nothing changes.
pls_status pls_reserve(void *block, size_t *capacity, size_t needed, size_t size, const char *what);

/// Release `*block` (null is fine) and set it to null.
void pls_release(void *block);

/// A copy of `text`.
pls_status pls_copy_text(char **copy, const char *text, const char *what);

#endif
