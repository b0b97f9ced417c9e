// hdf5_image.h -- an HDF5 file made in memory.
//
// HDF5 must never meet a full disk: after a failed write its library cannot even be closed. So it writes into memory, and we write the bytes to the
// disk, where a failure is known, said and undone. The image is made in place, without a second copy.
#ifndef PLS_IO_HDF5_IMAGE_H
#define PLS_IO_HDF5_IMAGE_H

#include "base/alloc.h"

#include <hdf5.h>

/// Zero-initialise; `pls_hdf5_image_free` releases, after the HDF5 file is closed.
typedef struct pls_hdf5_image
{
    char *data;
    size_t size; ///< bytes of the file, right once it was flushed
    size_t capacity;
} pls_hdf5_image;

/// Make an empty HDF5 file with a user block of `user_block` bytes in front. `expected` bytes are set aside at once, so that memory runs out here or not at
/// all. Nothing in the file depends on the time at which it is made.
pls_status pls_hdf5_image_create(pls_hdf5_image *image, size_t expected, size_t user_block, hid_t *file);
void pls_hdf5_image_free(pls_hdf5_image *image);

#endif
