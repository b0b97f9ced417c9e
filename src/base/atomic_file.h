// atomic_file.h -- files that are either complete or not there, and the few other things we need of the file system.
//
// An atomic file is written as "<path>.tmp" beside its final name, synced to the disk, and renamed. Whoever opens `path`, after a crash
// at any instant too, finds the whole old file or the whole new one.
#ifndef PLS_BASE_ATOMIC_FILE_H
#define PLS_BASE_ATOMIC_FILE_H

#include "base/alloc.h"

#include <stdbool.h>
#include <stdio.h>

/// A file being written. Zero-initialise; `pls_atomic_commit` or `pls_atomic_abandon` ends it and frees what it holds.
typedef struct pls_atomic_file
{
    FILE *stream;
    char *path;
    char *temporary; ///< a library that writes by name (HDF5) may overwrite this file between open and commit
    char *folder;
} pls_atomic_file;

/// Start writing `path`; its folder must exist. INVALID_ARGUMENT when `path` is something else than a regular file (a device, a folder).
/// All functions here fail with DISK_FULL when space, a quota or a file size limit is used up, and with IO for other reasons. After a failure
/// the old file is untouched and the temporary file is gone.
pls_status pls_atomic_open(pls_atomic_file *file, const char *path);
pls_status pls_atomic_write(pls_atomic_file *file, const void *data, size_t size);
pls_status pls_atomic_print(pls_atomic_file *file, const char *format, ...) __attribute__((format(printf, 2, 3)));

/// Sync and put the file in its place. On failure the file is abandoned.
pls_status pls_atomic_commit(pls_atomic_file *file);

/// Remove the temporary file; the old file stays. Does nothing when no file is open.
void pls_atomic_abandon(pls_atomic_file *file);

/// Open, write `size` bytes, commit.
pls_status pls_write_file(const char *path, const void *data, size_t size);

/// Read a whole file into `*text`, followed by a terminator that `*size` does not count; end with `pls_release(text)`.
/// NOT_FOUND when there is no such file, IO when it cannot be read.
pls_status pls_read_file(const char *path, char **text, size_t *size);

/// Make a folder and its parents; fine when it is there already.
pls_status pls_make_directory(const char *path);

/// Whether `path` names anything.
bool pls_file_exists(const char *path);

#endif
