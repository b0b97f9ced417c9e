/// @file memory.h
/// The allocator the library uses. Replace it once, before anything else is called.
#ifndef PARTICLS_MEMORY_H
#define PARTICLS_MEMORY_H

#include <particls/status.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Source of memory. `allocate` returns a block aligned to `alignment` (a power of two) or null; `release` gets the same size back.
/// Both may be called from several threads at once.
typedef struct pls_allocator
{
    void *(*allocate)(void *context, size_t size, size_t alignment);
    void (*release)(void *context, void *block, size_t size);
    void *context;
} pls_allocator;

/// Use `allocator` (copied) from now on; null brings back the C library's. Fails with INVALID_ARGUMENT while blocks are in use.
pls_status pls_set_allocator(const pls_allocator *allocator);

/// Bytes the library holds now, and the most it has held since the last `pls_memory_reset_peak()`.
size_t pls_memory_in_use(void);
size_t pls_memory_peak(void);
void pls_memory_reset_peak(void);

#ifdef __cplusplus
}
#endif
#endif
