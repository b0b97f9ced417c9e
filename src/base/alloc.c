// alloc.c -- checked, counted, zeroed allocation through a replaceable allocator.
//
// All of the library's memory passes through here: one place to inject failures, to count what is held and to see leaks. The header in
// front of a block carries a mark; a block without it is not ours (or was released already) and is left alone, which shows as a leak in
// the counters instead of damaging the heap.

#include "base/alloc.h"

#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#ifdef __linux__
#include <sys/mman.h>
#endif

enum {
    LARGE_PAGE = 2 << 20, ///< bytes
    LARGE_BLOCK = 4 << 20 ///< bytes from which blocks begin on large pages
};

typedef struct header
{
    uint64_t mark;
    size_t total;   ///< bytes asked of the allocator, header included
    size_t payload; ///< bytes asked by the caller
} header;

_Static_assert(sizeof(header) <= PLS_ALIGNMENT, "the header fits in front of an aligned block");

static const uint64_t block_mark = UINT64_C(0x706c73626c6f636b);  // "plsblock"
static const uint64_t released_mark = UINT64_C(0x706c7366726565); // "plsfree"

/// Large blocks on large pages where the system has them: rows of neighbours are reached at random, and a million bodies on small pages overflow the
/// processor's table of pages.
static void *c_allocate(void *context, size_t size, size_t alignment)
{
    (void)context;
#ifdef MADV_HUGEPAGE
    if (size >= LARGE_BLOCK)
    {
        void *block = NULL;
        if (posix_memalign(&block, LARGE_PAGE, size) != 0) return NULL;
        (void)madvise(block, size / LARGE_PAGE * LARGE_PAGE, MADV_HUGEPAGE); // a wish; a system that does not grant it keeps small pages
        return block;
    }
#endif
    return aligned_alloc(alignment, size);
}

static void c_release(void *context, void *block, size_t size)
{
    (void)context;
    (void)size;
    free(block);
}

static pls_allocator current = {c_allocate, c_release, NULL};
static atomic_size_t in_use;
static atomic_size_t peak;

pls_status pls_set_allocator(const pls_allocator *allocator)
{
    size_t held = atomic_load(&in_use);
    if (held > 0)
    {
        return pls_fail(PLS_INVALID_ARGUMENT,
                        "cannot replace the allocator while %zu bytes are in use: replace it before the first other call, or after "
                        "everything has been freed",
                        held);
    }
    if (allocator && (!allocator->allocate || !allocator->release))
    {
        return pls_fail(PLS_INVALID_ARGUMENT, "cannot use this allocator: it needs both an allocate and a release function");
    }
    current = allocator ? *allocator : (pls_allocator){c_allocate, c_release, NULL};
    return PLS_OK;
}

size_t pls_memory_in_use(void) { return atomic_load(&in_use); }

size_t pls_memory_peak(void) { return atomic_load(&peak); }

void pls_memory_reset_peak(void) { atomic_store(&peak, atomic_load(&in_use)); }

static void count_bytes(size_t bytes)
{
    size_t held = atomic_fetch_add(&in_use, bytes) + bytes;
    size_t most = atomic_load(&peak);
    while (held > most && !atomic_compare_exchange_weak(&peak, &most, held))
    {
    }
}

static pls_status out_of_memory(size_t bytes, const char *what)
{
    static const char *const units[] = {"bytes", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
    size_t unit = 1;
    unsigned power = 0;
    while (power < 6 && bytes / unit >= 1024)
    {
        unit *= 1024;
        ++power;
    }
    if (!what) what = "internal use";
    if (power == 0) return pls_fail(PLS_OUT_OF_MEMORY, "cannot allocate %zu bytes for %s", bytes, what);
    // Whole numbers, because "%.1f" would follow the locale. The remainder is below 2^60, so ten times it fits.
    size_t tenths = bytes % unit * 10 / unit;
    return pls_fail(PLS_OUT_OF_MEMORY, "cannot allocate %zu.%zu %s for %s", bytes / unit, tenths, units[power], what);
}

static void store_pointer(void *block, void *value)
{
    memcpy(block, &value, sizeof value); // the caller's pointer may have any object type
}

static void *load_pointer(const void *block)
{
    void *value;
    memcpy(&value, block, sizeof value);
    return value;
}

static header *header_of(void *payload)
{
    header *head = (header *)((char *)payload - PLS_ALIGNMENT);
    return head->mark == block_mark ? head : NULL;
}

/// A new block of `count` items whose first `filled` bytes the caller will write; the rest is zeroed.
static pls_status new_block(void **payload, size_t count, size_t size, size_t filled, const char *what)
{
    *payload = NULL;
    size_t bytes;
    size_t total;
    if (__builtin_mul_overflow(count, size, &bytes) || __builtin_add_overflow(bytes, (size_t)(2 * PLS_ALIGNMENT - 1), &total))
    {
        return pls_fail(PLS_OUT_OF_MEMORY, "cannot allocate %zu items of %zu bytes for %s: more than the address space holds", count, size,
                        what ? what : "internal use");
    }
    if (bytes == 0) return PLS_OK;
    total -= total % PLS_ALIGNMENT;
    char *start = current.allocate(current.context, total, PLS_ALIGNMENT);
    if (!start) return out_of_memory(bytes, what);
    *(header *)(void *)start = (header){block_mark, total, bytes};
    memset(start + PLS_ALIGNMENT + filled, 0, total - PLS_ALIGNMENT - filled);
    count_bytes(total);
    *payload = start + PLS_ALIGNMENT;
    return PLS_OK;
}

static void release_block(void *payload)
{
    header *head = payload ? header_of(payload) : NULL;
    if (!head) return;
    size_t total = head->total;
    head->mark = released_mark;
    // The counter goes down last: while it is not zero the allocator cannot be replaced under this call.
    current.release(current.context, head, total);
    atomic_fetch_sub(&in_use, total);
}

pls_status pls_allocate(void *block, size_t count, size_t size, const char *what)
{
    void *payload;
    pls_status status = new_block(&payload, count, size, 0, what);
    store_pointer(block, payload);
    return status;
}

pls_status pls_reallocate(void *block, size_t old_count, size_t new_count, size_t size, const char *what)
{
    void *old = load_pointer(block);
    size_t kept = 0; // bytes; cannot overflow, since the old block was that large
    if (old)
    {
        kept = (old_count < new_count ? old_count : new_count) * size;
        const header *head = header_of(old);
        if (!head) return pls_fail(PLS_INVALID_ARGUMENT, "cannot resize %s: it was not allocated here", what ? what : "a block");
        if (kept > head->payload) kept = head->payload;
    }
    void *payload;
    PLS_TRY(new_block(&payload, new_count, size, kept, what));
    if (payload && old) memcpy(payload, old, kept);
    release_block(old);
    store_pointer(block, payload);
    return PLS_OK;
}

pls_status pls_reserve(void *block, size_t *capacity, size_t needed, size_t size, const char *what)
{
    if (needed <= *capacity) return PLS_OK;
    size_t grown;
    if (__builtin_add_overflow(*capacity, *capacity / 2, &grown) || grown < needed) grown = needed;
    PLS_TRY(pls_reallocate(block, *capacity, grown, size, what));
    *capacity = grown;
    return PLS_OK;
}

void pls_release(void *block)
{
    release_block(load_pointer(block));
    store_pointer(block, NULL);
}

pls_status pls_copy_text(char **copy, const char *text, const char *what)
{
    size_t size = strlen(text) + 1;
    PLS_TRY(pls_allocate(copy, size, 1, what));
    memcpy(*copy, text, size);
    return PLS_OK;
}
