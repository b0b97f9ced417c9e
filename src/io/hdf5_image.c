// hdf5_image.c -- HDF5's driver for files in memory, with our memory below it.

#include "io/hdf5_image.h"

#include "io/hdf5_quiet.h"

#include <string.h>

/// The file's size is rounded up to a multiple of this [bytes]. Small, because growing costs nothing: the memory is set aside.
static const size_t increment = 8;

static void *resize(void *block, size_t size, H5FD_file_image_op_t operation, void *context)
{
    (void)block; // always that of the image
    (void)operation;
    pls_hdf5_image *image = context;
    if (pls_reserve(&image->data, &image->capacity, size, 1, "a checkpoint") != PLS_OK) return NULL;
    image->size = size;
    return image->data;
}

static void *allocate(size_t size, H5FD_file_image_op_t operation, void *context) { return resize(NULL, size, operation, context); }

static void *copy(void *to, const void *from, size_t size, H5FD_file_image_op_t operation, void *context)
{
    (void)operation;
    (void)context;
    return memcpy(to, from, size);
}

/// HDF5 is done with the bytes; we are not.
static herr_t keep(void *block, H5FD_file_image_op_t operation, void *context)
{
    (void)block;
    (void)operation;
    (void)context;
    return 0;
}

static void *same_context(void *context) { return context; }

static herr_t keep_context(void *context)
{
    (void)context;
    return 0;
}

pls_status pls_hdf5_image_create(pls_hdf5_image *image, size_t expected, size_t user_block, hid_t *file)
{
    *image = (pls_hdf5_image){0};
    PLS_TRY(pls_reserve(&image->data, &image->capacity, expected, 1, "a checkpoint"));
    H5FD_file_image_callbacks_t callbacks = {allocate, copy, resize, keep, same_context, keep_context, image};
    hid_t creation = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_userblock(creation, user_block);
    H5Pset_obj_track_times(creation, false);
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);
    H5Pset_fapl_core(access, increment, false);
    H5Pset_file_image_callbacks(access, &callbacks);
    *file = H5Fcreate("checkpoint", H5F_ACC_TRUNC, creation, access); // the name is never used
    H5Pclose(access);
    H5Pclose(creation);
    return *file >= 0 ? PLS_OK : pls_hdf5_fail(PLS_IO, "make", "a checkpoint in memory");
}

void pls_hdf5_image_free(pls_hdf5_image *image)
{
    pls_release(&image->data);
    *image = (pls_hdf5_image){0};
}
