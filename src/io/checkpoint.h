// checkpoint.h -- the whole state of a run in one HDF5 file that is either good or known to be damaged.
//
//     bytes 0..511     user block, which HDF5 leaves alone: "particls checkpoint", format, size of the file, hash of all bytes behind the block
//     /                attributes: particls version, scene hash, state hash, step, time, dt, ...
//     /bodies/position ... one group per table of the world, one dataset per persistent field, with unit and meaning; rows in order of ids
//     /run             text of the run itself: lengths of series, numbers of frames
//
// The hash is checked before HDF5 sees the file, so a damaged file is found whatever byte is wrong, and HDF5 never reads garbage. Nothing in the file
// depends on when or where it was written: equal states give equal bytes.
#ifndef PLS_IO_CHECKPOINT_H
#define PLS_IO_CHECKPOINT_H

#include "step/persist.h"

/// An open checkpoint. Zero-initialise; `pls_checkpoint_close` releases.
typedef struct pls_checkpoint
{
    int64_t file; ///< HDF5's handle
    char *path;
    char version[32]; ///< of the particls that wrote it
    uint64_t scene_hash, state_hash;
    pls_persist_header header;
    char *run; ///< text of the run, terminated
} pls_checkpoint;

/// Write the state of `world` atomically. DISK_FULL when there is no room; the file that was there before is then untouched.
pls_status pls_checkpoint_write(const char *path, pls_world *world, uint64_t scene_hash, const char *run);

/// Check the whole file and read its header. NOT_FOUND, CORRUPT (cut off or changed), VERSION (another format).
pls_status pls_checkpoint_open(pls_checkpoint *checkpoint, const char *path);

/// Bring `world`, just built from the same scene, into the saved state.
pls_status pls_checkpoint_restore(const pls_checkpoint *checkpoint, pls_world *world);

/// Read one field, rows in order of ids, components packed; `out` holds header.rows[table] * components values. VERSION when the file does not hold it so.
pls_status pls_checkpoint_read_field(const pls_checkpoint *checkpoint, pls_table_kind table, const pls_field *field, void *out);

/// Does nothing when none is open.
void pls_checkpoint_close(pls_checkpoint *checkpoint);

#endif
