// sort.h -- stable radix sort and permutations. Stable and keyed by integers, so equal input gives equal output on any number of threads.
#ifndef PLS_BASE_SORT_H
#define PLS_BASE_SORT_H

#include <particls/status.h>
#include <stddef.h>
#include <stdint.h>

/// Sort `count` pairs (key, value) by key, ascending, stable (least significant digit first, 8 bits at a time; digits that are the same
/// in all keys are skipped). Allocates `count` pairs of scratch.
pls_status pls_radix_sort_u64(uint64_t *keys, uint32_t *values, size_t count);
pls_status pls_radix_sort_u32(uint32_t *keys, uint32_t *values, size_t count);

enum { PLS_SORT_SCRATCH = sizeof(uint64_t) + sizeof(uint32_t) };
/// The same with the caller's scratch, PLS_SORT_SCRATCH bytes per pair, aligned for keys: within steps nothing is allocated.
void pls_radix_sort_u64_in(uint64_t *keys, uint32_t *values, size_t count, void *scratch);

/// Exclusive prefix sum in place over `count` + 1 entries: entry k becomes the sum of entries before it, the last one the total.
/// LIMIT_EXCEEDED if the total passes UINT32_MAX.
pls_status pls_prefix_sum_u32(uint32_t *counts, size_t count);

#endif
