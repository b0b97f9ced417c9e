// checkpoint_store.h -- the checkpoints of a run: their names, which are kept, which is the newest good one.
//
// Two kinds are kept apart. Scheduled ones (the start, what the scene asks for, the end) come at the same steps in every run of the scene; interim ones are
// written when a minute has passed or Ctrl-C was pressed. While a run goes on, the newest two of all and the newest two scheduled ones are kept; when it has
// finished only the latter, so that a disturbed run ends with the same files as an undisturbed one.
#ifndef PLS_RUN_CHECKPOINT_STORE_H
#define PLS_RUN_CHECKPOINT_STORE_H

#include "io/checkpoint.h"
#include "run/run_directory.h"

/// No step: there is no such checkpoint.
#define PLS_NO_STEP UINT64_MAX

/// Steps at which DIR has checkpoints, newest first. Zero-initialise; `pls_checkpoint_list_free` releases.
typedef struct pls_checkpoint_list
{
    uint64_t *step;
    size_t count, capacity;
} pls_checkpoint_list;

pls_status pls_checkpoint_list_make(pls_checkpoint_list *list, const char *directory);
void pls_checkpoint_list_free(pls_checkpoint_list *list);

/// DIR/checkpoint/000001000.h5
pls_status pls_checkpoint_path(char path[PLS_PATH_SIZE], const char *directory, uint64_t step);

/// Rename a checkpoint that cannot be used, so that nobody takes it for a good one.
pls_status pls_checkpoint_set_aside(const char *directory, uint64_t step);

/// Remove all but the newest `newest` checkpoints and those at the two steps `keep` (PLS_NO_STEP: none).
pls_status pls_checkpoint_prune(const char *directory, size_t newest, const uint64_t keep[2]);

#endif
