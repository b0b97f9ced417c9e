// csr.c -- compressed sparse rows by counting: count per row, prefix sum, fill in input order.

#include "base/csr.h"
#include "base/sort.h"

#include <string.h>

/// Count the entries of each row into `start` and sum them up, so that start[row] is where the row begins.
static pls_status count_rows(uint32_t *start, uint32_t rows, const uint32_t *row_of, size_t count)
{
    memset(start, 0, ((size_t)rows + 1) * sizeof *start);
    for (size_t i = 0; i < count; ++i)
    {
        if (row_of[i] >= rows)
        {
            return pls_fail(PLS_INVALID_ARGUMENT, "cannot build the rows of a list: pair %zu names row %u of %u", i, row_of[i], rows);
        }
        ++start[row_of[i]];
    }
    return pls_prefix_sum_u32(start, rows);
}

pls_status pls_csr_build(pls_csr *csr, uint32_t rows, const uint32_t *row_of, const uint32_t *entry_of, size_t count)
{
    if (count > UINT32_MAX) // before counting, where a row's counter could wrap around
    {
        return pls_fail(PLS_LIMIT_EXCEEDED, "cannot index %zu entries: a list holds at most %u", count, UINT32_MAX);
    }
    PLS_TRY(pls_reserve(&csr->start, &csr->start_capacity, (size_t)rows + 1, sizeof *csr->start, "the rows of a list"));
    PLS_TRY(pls_reserve(&csr->entry, &csr->entry_capacity, count, sizeof *csr->entry, "the entries of a list"));

    uint32_t *start = csr->start;
    csr->rows = 0; // empty if the rows turn out to be wrong
    pls_status status = count_rows(start, rows, row_of, count);
    if (status != PLS_OK)
    {
        start[0] = 0;
        return status;
    }
    csr->rows = rows;
    // Filling moves each row's start to its end, which is the next row's start; shifting by one puts it right without scratch memory.
    for (size_t i = 0; i < count; ++i) csr->entry[start[row_of[i]]++] = entry_of[i];
    memmove(start + 1, start, (size_t)rows * sizeof *start);
    start[0] = 0;
    return PLS_OK;
}

void pls_csr_free(pls_csr *csr)
{
    pls_release(&csr->start);
    pls_release(&csr->entry);
    *csr = (pls_csr){0};
}
