// atomic_file.c -- write beside, sync, rename, sync the folder.
//
// The order matters: without the first sync a crash may leave the new name on an empty file; without the second the rename itself may be
// lost. Every call is checked, because a full disk may only show at the flush, the sync or the close.

#include "base/atomic_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool is_disk_full(int error) { return error == ENOSPC || error == EDQUOT || error == EFBIG; }

/// Record why `file` could not be written, and abandon it.
static pls_status fail_write(pls_atomic_file *file, int error)
{
    pls_status status;
    if (is_disk_full(error))
    {
        status =
            pls_fail(PLS_DISK_FULL,
                     "cannot write \"%s\": the disk is full, or a quota or file size limit is reached (%s); nothing was lost, a file of "
                     "that name is untouched: free space in \"%s\" and try again",
                     file->path, strerror(error), file->folder);
    }
    else
    {
        status =
            pls_fail(PLS_IO,
                     "cannot write \"%s\": %s; nothing was lost, a file of that name is untouched: check that the folder \"%s\" exists "
                     "and may be written",
                     file->path, strerror(error), file->folder);
    }
    pls_atomic_abandon(file);
    return status;
}

static void release_names(pls_atomic_file *file)
{
    pls_release(&file->path);
    pls_release(&file->temporary);
    pls_release(&file->folder);
}

static pls_status set_names(pls_atomic_file *file, const char *path)
{
    static const char suffix[] = ".tmp";
    size_t size = strlen(path);
    PLS_TRY(pls_copy_text(&file->path, path, "a file name"));
    PLS_TRY(pls_allocate(&file->temporary, size + sizeof suffix, 1, "a file name"));
    memcpy(file->temporary, path, size);
    memcpy(file->temporary + size, suffix, sizeof suffix);

    const char *slash = strrchr(path, '/');
    if (!slash) return pls_copy_text(&file->folder, ".", "a file name");
    size_t folder_size = slash == path ? 1 : (size_t)(slash - path);
    PLS_TRY(pls_allocate(&file->folder, folder_size + 1, 1, "a file name"));
    memcpy(file->folder, path, folder_size);
    return PLS_OK;
}

pls_status pls_atomic_open(pls_atomic_file *file, const char *path)
{
    *file = (pls_atomic_file){0};
    struct stat there;
    if (stat(path, &there) == 0 && !S_ISREG(there.st_mode))
    {
        // Renaming over a device such as /dev/null would replace the device.
        return pls_fail(PLS_INVALID_ARGUMENT, "cannot write \"%s\": it is not a regular file; give the name of a file", path);
    }
    pls_status status = set_names(file, path);
    if (status != PLS_OK)
    {
        release_names(file);
        return status;
    }
    file->stream = fopen(file->temporary, "wb");
    return file->stream ? PLS_OK : fail_write(file, errno);
}

pls_status pls_atomic_write(pls_atomic_file *file, const void *data, size_t size)
{
    if (!file->stream) return pls_fail(PLS_INVALID_ARGUMENT, "cannot write to a file that is not open");
    if (size == 0) return PLS_OK;
    errno = 0;
    if (fwrite(data, 1, size, file->stream) == size) return PLS_OK;
    return fail_write(file, errno ? errno : EIO);
}

pls_status pls_atomic_print(pls_atomic_file *file, const char *format, ...)
{
    if (!file->stream) return pls_fail(PLS_INVALID_ARGUMENT, "cannot write to a file that is not open");
    va_list arguments;
    va_start(arguments, format);
    errno = 0;
    int written = vfprintf(file->stream, format, arguments);
    int error = errno;
    va_end(arguments);
    return written >= 0 ? PLS_OK : fail_write(file, error ? error : EIO);
}

static int sync_descriptor(int descriptor)
{
    while (fsync(descriptor) != 0)
    {
        if (errno != EINTR) return errno;
    }
    return 0;
}

/// Returns 0 or an errno. Some file systems cannot sync a folder and say EINVAL; there is nothing more to be done on them.
static int sync_folder(const char *folder)
{
    int descriptor = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return errno;
    int error = sync_descriptor(descriptor);
    if (close(descriptor) != 0 && error == 0) error = errno;
    return error == EINVAL || error == ENOTSUP ? 0 : error;
}

/// Flush, sync and close the stream; returns 0 or the first errno.
static int finish_stream(pls_atomic_file *file)
{
    FILE *stream = file->stream;
    int error = 0;
    if (fflush(stream) != 0) error = errno;
    if (error == 0) error = sync_descriptor(fileno(stream));
    file->stream = NULL;
    if (fclose(stream) != 0 && error == 0) error = errno;
    return error;
}

pls_status pls_atomic_commit(pls_atomic_file *file)
{
    if (!file->stream) return pls_fail(PLS_INVALID_ARGUMENT, "cannot put a file in place that is not open");
    int error = finish_stream(file);
    if (error == 0 && rename(file->temporary, file->path) != 0) error = errno;
    if (error != 0) return fail_write(file, error);

    pls_status status = PLS_OK;
    error = sync_folder(file->folder);
    if (error != 0)
    {
        status = pls_fail(is_disk_full(error) ? PLS_DISK_FULL : PLS_IO,
                          "cannot sync the folder \"%s\": %s; \"%s\" is written, but may be lost if the machine stops now: check the disk",
                          file->folder, strerror(error), file->path);
    }
    release_names(file);
    return status;
}

void pls_atomic_abandon(pls_atomic_file *file)
{
    if (file->stream) fclose(file->stream); // its content is unwanted, so is its status
    file->stream = NULL;
    if (file->temporary) unlink(file->temporary);
    release_names(file);
}

pls_status pls_write_file(const char *path, const void *data, size_t size)
{
    pls_atomic_file file;
    PLS_TRY(pls_atomic_open(&file, path));
    PLS_TRY(pls_atomic_write(&file, data, size));
    return pls_atomic_commit(&file);
}

static pls_status fail_read(const char *path, int error)
{
    pls_status status = error == ENOENT || error == ENOTDIR ? PLS_NOT_FOUND : PLS_IO;
    return pls_fail(status, "cannot read \"%s\": %s; check the name and that it may be read", path, strerror(error));
}

/// Read to the end of `stream`; pipes have no size to ask for, so the block grows as needed.
static pls_status read_stream(FILE *stream, const char *path, char **text, size_t *capacity, size_t *size)
{
    for (;;)
    {
        PLS_TRY(pls_reserve(text, capacity, *size + 2, 1, "the content of a file")); // a byte to find the end by, and the terminator
        errno = 0;
        size_t got = fread(*text + *size, 1, *capacity - *size - 1, stream);
        *size += got;
        if (got > 0) continue;
        if (ferror(stream)) return fail_read(path, errno ? errno : EIO);
        (*text)[*size] = '\0';
        return PLS_OK;
    }
}

pls_status pls_read_file(const char *path, char **text, size_t *size)
{
    *text = NULL;
    *size = 0;
    FILE *stream = fopen(path, "rb");
    if (!stream) return fail_read(path, errno);
    struct stat there;
    size_t capacity = 0;
    size_t expected = 4096;
    if (fstat(fileno(stream), &there) == 0 && there.st_size > 0) expected = (size_t)there.st_size;
    pls_status status = pls_reserve(text, &capacity, expected + 2, 1, "the content of a file");
    if (status == PLS_OK) status = read_stream(stream, path, text, &capacity, size);
    fclose(stream); // only read: closing cannot lose anything
    if (status != PLS_OK)
    {
        pls_release(text);
        *size = 0;
    }
    return status;
}

/// Make one folder, its parent being there.
static pls_status make_one(const char *path)
{
    if (mkdir(path, 0777) == 0) return PLS_OK;
    int error = errno;
    struct stat there;
    if (stat(path, &there) == 0)
    {
        if (S_ISDIR(there.st_mode)) return PLS_OK;
        error = ENOTDIR;
    }
    return pls_fail(is_disk_full(error) ? PLS_DISK_FULL : PLS_IO,
                    "cannot make the folder \"%s\": %s; check the name, the space and the rights", path, strerror(error));
}

pls_status pls_make_directory(const char *path)
{
    if (!*path) return pls_fail(PLS_INVALID_ARGUMENT, "cannot make a folder without a name");
    char *prefix;
    PLS_TRY(pls_copy_text(&prefix, path, "a file name"));
    pls_status status = PLS_OK;
    for (char *slash = strchr(prefix + 1, '/'); slash && status == PLS_OK; slash = strchr(slash + 1, '/'))
    {
        *slash = '\0';
        status = make_one(prefix);
        *slash = '/';
    }
    if (status == PLS_OK) status = make_one(prefix);
    pls_release(&prefix);
    return status;
}

bool pls_file_exists(const char *path)
{
    struct stat there;
    return stat(path, &there) == 0;
}
