// hdf5_quiet.h -- HDF5 without its printing, and its errors as ours.
#ifndef PLS_IO_HDF5_QUIET_H
#define PLS_IO_HDF5_QUIET_H

#include <hdf5.h>
#include <particls/status.h>

/// HDF5 prints its errors unless told not to. What the program around the library has chosen is put back by pls_hdf5_end.
typedef struct pls_hdf5_quiet
{
    H5E_auto2_t function;
    void *context;
} pls_hdf5_quiet;

pls_hdf5_quiet pls_hdf5_begin(void);
void pls_hdf5_end(const pls_hdf5_quiet *quiet);

/// Record that HDF5 failed to do `what` with the file `path`, with the reason HDF5 gives; returns `status`.
pls_status pls_hdf5_fail(pls_status status, const char *what, const char *path);

#endif
