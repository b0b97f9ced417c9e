// parallel.c -- the number of threads, and sums that do not depend on it.

#include "base/parallel.h"

#ifdef _OPENMP
#include <omp.h>
#endif

enum { MOST_THREADS = 4096 };

int pls_threads(void)
{
#ifdef _OPENMP
    int threads = omp_get_max_threads();
    return threads > 1 ? threads : 1;
#else
    return 1;
#endif
}

pls_status pls_set_threads(int threads)
{
    if (threads < 0 || threads > MOST_THREADS)
    {
        return pls_fail(PLS_INVALID_ARGUMENT, "cannot use %d threads: give 1 to %d, or 0 for all processors", threads, MOST_THREADS);
    }
#ifdef _OPENMP
    omp_set_num_threads(threads > 0 ? threads : omp_get_num_procs());
#endif
    return PLS_OK;
}

static double sum_block(const double *values, size_t begin, size_t end, size_t stride)
{
    double sum = 0;
    for (size_t i = begin; i < end; ++i) sum += values[i * stride];
    return sum;
}

double pls_sum(const double *values, size_t count, size_t stride)
{
    // The block sums of one round lie on the stack, so that a sum never allocates; rounds follow each other in order.
    enum { ROUND = 512 };
    double block_sum[ROUND];
    size_t blocks = pls_block_count(count, PLS_BLOCK);
    double sum = 0;
    for (size_t first = 0; first < blocks; first += ROUND)
    {
        size_t here = blocks - first < ROUND ? blocks - first : ROUND;
#pragma omp parallel for schedule(static) if (here > 1)
        for (size_t k = 0; k < here; ++k)
        {
            size_t block = first + k;
            block_sum[k] = sum_block(values, block * PLS_BLOCK, pls_block_end(block, PLS_BLOCK, count), stride);
        }
        for (size_t k = 0; k < here; ++k) sum += block_sum[k];
    }
    return sum;
}
