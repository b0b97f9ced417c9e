// csv.h -- series files: rows of numbers that are never torn and never lost.
//
// A row goes out in one write(2), so whoever reads the file while the run goes on (or after it was killed) finds whole lines. The length in
// bytes is known at any time: a checkpoint notes it, and a resumed run cuts the file back to it.
#ifndef PLS_IO_CSV_H
#define PLS_IO_CSV_H

#include "base/text.h"

#include <stdint.h>

/// One column: `time [s]`, or just `contacts` when `unit` is empty.
typedef struct pls_csv_column
{
    const char *name;
    const char *unit;
} pls_csv_column;

/// Zero-initialise; `pls_csv_close` releases.
typedef struct pls_csv
{
    char *path;     ///< null while no file is open
    int descriptor; ///< meaningful while `path` is set
    uint64_t size;  ///< bytes in the file
    pls_text line;  ///< the row being made
} pls_csv;

/// Start a new file (an old one of that name is emptied) with the first line of names and units.
/// All functions fail with DISK_FULL when space, a quota or a file size limit is used up, with IO for other reasons; the file then still
/// holds the rows written before.
pls_status pls_csv_create(pls_csv *csv, const char *path, const pls_csv_column *columns, size_t count);

/// Go on with a file: cut it back to `size` bytes and append from there. CORRUPT when the file is shorter, when `size` is not the end of a
/// line, or when its first line is not that of `columns`.
pls_status pls_csv_reopen(pls_csv *csv, const char *path, uint64_t size, const pls_csv_column *columns, size_t count);

/// Append one row; numbers as the shortest text that reads back as the same double.
pls_status pls_csv_row(pls_csv *csv, const double *values, size_t count);

/// Wait until all rows are on the disk.
pls_status pls_csv_sync(pls_csv *csv);

/// Does nothing when no file is open.
void pls_csv_close(pls_csv *csv);

#endif
