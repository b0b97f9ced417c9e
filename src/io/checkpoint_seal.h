// checkpoint_seal.h -- the first 512 bytes of a checkpoint: what it is, how long it is, and the hash of all that follows.
#ifndef PLS_IO_CHECKPOINT_SEAL_H
#define PLS_IO_CHECKPOINT_SEAL_H

#include <particls/status.h>
#include <stddef.h>

/// Smallest user block of HDF5.
enum { PLS_SEAL_SIZE = 512 };

/// Make the seal of the bytes that follow it.
void pls_seal_make(const void *data, size_t size, char seal[PLS_SEAL_SIZE]);

/// Read the whole file and compare. NOT_FOUND, CORRUPT (with what is wrong), VERSION (another format of checkpoints).
pls_status pls_seal_check(const char *path);

#endif
