// snapshot.h -- a world saved to memory and put back, through the same door checkpoints use (step/persist.h).
#ifndef PLS_TESTS_SUPPORT_SNAPSHOT_H
#define PLS_TESTS_SUPPORT_SNAPSHOT_H

#include "step/persist.h"

enum { SNAPSHOT_MAX_FIELDS = 64 };

/// Zero-initialise; `snapshot_free` releases.
typedef struct snapshot
{
    pls_persist_header header;
    void *data[PLS_TABLE_COUNT][SNAPSHOT_MAX_FIELDS]; ///< one block per persistent field
} snapshot;

/// OUT_OF_MEMORY when the snapshot's own memory runs out, else what the library says. What was taken must be released also on failure.
pls_status snapshot_take(pls_world *world, snapshot *copy);
pls_status snapshot_put(pls_world *world, const snapshot *copy);
void snapshot_free(snapshot *copy);

#endif
