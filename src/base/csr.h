// csr.h -- compressed sparse rows: for each of `rows` rows, the entries start[row] .. start[row + 1].
#ifndef PLS_BASE_CSR_H
#define PLS_BASE_CSR_H

#include "base/alloc.h"
#include <stdint.h>

/// Zero-initialise; `pls_csr_free` releases.
typedef struct pls_csr
{
    uint32_t *start; ///< rows + 1
    uint32_t *entry; ///< start[rows] entries
    uint32_t rows;
    size_t start_capacity, entry_capacity;
} pls_csr;

/// Build from `count` (row, entry) pairs; entries of a row keep the order of the input. Reuses the memory of an earlier build.
pls_status pls_csr_build(pls_csr *csr, uint32_t rows, const uint32_t *row_of, const uint32_t *entry_of, size_t count);
void pls_csr_free(pls_csr *csr);

#endif
