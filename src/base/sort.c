// sort.c -- stable radix sort.
//
// One counting pass over the keys fills the histograms of all digits; a digit that is the same in all keys (the common case for the
// high digits of ids and cells) costs no pass over the data. Written once for both key widths: `width` is a constant at each inlined use.

#include "base/sort.h"
#include "base/alloc.h"

#include <string.h>

enum { DIGIT_BITS = 8, DIGIT_VALUES = 1 << DIGIT_BITS };

#define ALWAYS_INLINE static inline __attribute__((always_inline))

ALWAYS_INLINE uint64_t get_key(const void *keys, size_t index, size_t width)
{
    return width == 8 ? ((const uint64_t *)keys)[index] : ((const uint32_t *)keys)[index];
}

ALWAYS_INLINE void put_key(void *keys, size_t index, size_t width, uint64_t key)
{
    if (width == 8)
    {
        ((uint64_t *)keys)[index] = key;
    }
    else
    {
        ((uint32_t *)keys)[index] = (uint32_t)key;
    }
}

ALWAYS_INLINE size_t digit_of(uint64_t key, size_t digit) { return (size_t)(key >> (digit * DIGIT_BITS)) & (DIGIT_VALUES - 1); }

/// Move all pairs to their places by one digit. `place` holds the digit's histogram and is used up.
ALWAYS_INLINE void scatter(const void *keys, const uint32_t *values, void *to_keys, uint32_t *to_values, size_t count, size_t width,
                           size_t digit, size_t place[DIGIT_VALUES])
{
    size_t sum = 0;
    for (size_t value = 0; value < DIGIT_VALUES; ++value)
    {
        size_t here = place[value];
        place[value] = sum;
        sum += here;
    }
    for (size_t i = 0; i < count; ++i)
    {
        uint64_t key = get_key(keys, i, width);
        size_t to = place[digit_of(key, digit)]++;
        put_key(to_keys, to, width, key);
        to_values[to] = values[i];
    }
}

/// `scratch`: room for `count` pairs, keys first, as they need the larger alignment.
ALWAYS_INLINE void radix_sort(void *keys, uint32_t *values, size_t count, size_t width, char *scratch)
{
    if (count < 2) return;
    size_t histogram[8][DIGIT_VALUES] = {{0}};
    for (size_t i = 0; i < count; ++i)
    {
        uint64_t key = get_key(keys, i, width);
        for (size_t digit = 0; digit < width; ++digit) ++histogram[digit][digit_of(key, digit)];
    }

    void *from_keys = keys;
    uint32_t *from_values = values;
    void *to_keys = scratch;
    uint32_t *to_values = (uint32_t *)(void *)(scratch + count * width);
    for (size_t digit = 0; digit < width; ++digit)
    {
        if (histogram[digit][digit_of(get_key(keys, 0, width), digit)] == count) continue;
        scatter(from_keys, from_values, to_keys, to_values, count, width, digit, histogram[digit]);
        void *swap_keys = from_keys;
        uint32_t *swap_values = from_values;
        from_keys = to_keys;
        from_values = to_values;
        to_keys = swap_keys;
        to_values = swap_values;
    }
    if (from_keys != keys)
    {
        memcpy(keys, from_keys, count * width);
        memcpy(values, from_values, count * sizeof *values);
    }
}

ALWAYS_INLINE pls_status sort_with_own_scratch(void *keys, uint32_t *values, size_t count, size_t width)
{
    if (count < 2) return PLS_OK;
    char *scratch;
    PLS_TRY(pls_allocate(&scratch, count, width + sizeof *values, "the scratch of a sort"));
    radix_sort(keys, values, count, width, scratch);
    pls_release(&scratch);
    return PLS_OK;
}

pls_status pls_radix_sort_u64(uint64_t *keys, uint32_t *values, size_t count)
{
    return sort_with_own_scratch(keys, values, count, sizeof *keys);
}

pls_status pls_radix_sort_u32(uint32_t *keys, uint32_t *values, size_t count)
{
    return sort_with_own_scratch(keys, values, count, sizeof *keys);
}

void pls_radix_sort_u64_in(uint64_t *keys, uint32_t *values, size_t count, void *scratch)
{
    radix_sort(keys, values, count, sizeof *keys, scratch);
}

pls_status pls_prefix_sum_u32(uint32_t *counts, size_t count)
{
    uint64_t total = 0;
    for (size_t i = 0; i < count; ++i) total += counts[i];
    if (total > UINT32_MAX)
    {
        return pls_fail(PLS_LIMIT_EXCEEDED, "cannot index %llu entries: a list holds at most %u", (unsigned long long)total, UINT32_MAX);
    }
    uint32_t sum = 0;
    for (size_t i = 0; i < count; ++i)
    {
        uint32_t here = counts[i];
        counts[i] = sum;
        sum += here;
    }
    counts[count] = sum;
    return PLS_OK;
}
