// run_directory.h -- the folder a run lives in: its names, its lock, and what may be removed from it.
//
// The first file of a run is scene.used.yaml, complete or not there; from then on the run can be resumed. When an earlier run is overwritten, that
// file goes first, so that a mixture of two runs can never be resumed. Only files that a run writes are ever removed.
#ifndef PLS_RUN_RUN_DIRECTORY_H
#define PLS_RUN_RUN_DIRECTORY_H

#include "base/alloc.h"

#include <stdbool.h>

enum {
    PLS_PATH_SIZE = 4096 ///< longest path of the system, terminator included
};

/// Zero-initialise; `pls_run_directory_close` releases.
typedef struct pls_run_directory
{
    char *path; ///< null while not open
    int lock;   ///< descriptor of the lock file, meaningful while `path` is set
} pls_run_directory;

/// DIR/..., formatted. LIMIT_EXCEEDED when it is too long.
pls_status pls_run_path(char path[PLS_PATH_SIZE], const char *directory, const char *format, ...) __attribute__((format(printf, 3, 4)));

/// DUPLICATE when `path` holds a run already; fine when there is no such folder.
pls_status pls_run_directory_check_free(const char *path);

/// Open and lock; `make` makes a folder that is missing, else that is NOT_FOUND. DUPLICATE when another process runs there.
/// The lock goes with the process, however it ends.
pls_status pls_run_directory_open(pls_run_directory *directory, const char *path, bool make);
void pls_run_directory_close(pls_run_directory *directory);

/// Remove the results of an earlier run; `scene_too` also scene.used.yaml, first of all.
pls_status pls_run_directory_clear(const pls_run_directory *directory, bool scene_too);

/// Remove files that a killed process left half-written (*.tmp).
pls_status pls_run_directory_remove_temporaries(const pls_run_directory *directory);

/// Call `function` with the name of every file of DIR/folder, in no order; fine when there is no such folder. Stops at the first failure.
pls_status pls_run_each_file(const char *directory, const char *folder,
                             pls_status (*function)(void *context, const char *path, const char *name), void *context);

/// Remove a file; fine when it is not there.
pls_status pls_run_remove(const char *path);

#endif
