// parallel.h -- blocks of fixed size over threads.
//
// Work is cut into blocks whose size does not depend on the number of threads; a block writes only what belongs to it, or its own entry of
// a per-block result, which is then combined in block order. So every result is the same for any number of threads (DESIGN contract 1).
// A `for` over blocks is written at the call site as
//
//     #pragma omp parallel for schedule(static)
//     for (size_t block = 0; block < pls_block_count(n, PLS_BLOCK); ++block) { ... }
#ifndef PLS_BASE_PARALLEL_H
#define PLS_BASE_PARALLEL_H

#include <particls/status.h>
#include <particls/threads.h>
#include <stddef.h>

/// Items per block for cheap loops over bodies and for sums.
enum { PLS_BLOCK = 1024 };

static inline size_t pls_block_count(size_t count, size_t block) { return (count + block - 1) / block; }
static inline size_t pls_block_end(size_t index, size_t block, size_t count)
{
    size_t end = (index + 1) * block;
    return end < count ? end : count;
}

/// Sum of `count` values: plain sums within blocks of PLS_BLOCK, the block sums added in order. `stride` in doubles.
double pls_sum(const double *values, size_t count, size_t stride);

#endif
