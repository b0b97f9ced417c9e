// checkpoint_seal.c -- the seal is text, so that `head -c 200` shows it, filled up with line ends. The check makes the seal anew from the bytes
// behind it and compares all 512 bytes, so a change in the seal itself is found as well.

#include "io/checkpoint_seal.h"

#include "base/alloc.h"
#include "base/hash.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

/// Raised when files change such that an older reader would misread them.
enum {
    FORMAT = 1,
    READ_SIZE = 1 << 20 ///< bytes read at once; a multiple of 8, as continuing a hash asks for
};

static const char title[] = "particls checkpoint, format ";

/// Hash and count the bytes behind the seal.
static pls_status hash_rest(FILE *stream, const char *path, uint64_t *hash, uint64_t *size)
{
    char *buffer = NULL;
    PLS_TRY(pls_allocate(&buffer, READ_SIZE, 1, "a buffer for reading"));
    *hash = PLS_HASH_START;
    *size = 0;
    errno = 0;
    size_t got;
    while ((got = fread(buffer, 1, READ_SIZE, stream)) > 0)
    {
        *hash = pls_hash(*hash, buffer, got);
        *size += got;
    }
    pls_release(&buffer);
    return ferror(stream) ? pls_fail(PLS_IO, "cannot read \"%s\": %s", path, strerror(errno ? errno : EIO)) : PLS_OK;
}

static void print_seal(char seal[PLS_SEAL_SIZE], uint64_t size, uint64_t hash)
{
    memset(seal, '\n', PLS_SEAL_SIZE);
    int length =
        snprintf(seal, PLS_SEAL_SIZE, "%s%d\nbytes behind these %d: %llu\nhash of them: %016llx\n(HDF5 follows: h5dump shows it)\n", title,
                 FORMAT, PLS_SEAL_SIZE, (unsigned long long)size, (unsigned long long)hash);
    seal[length] = '\n'; // in place of the terminator
}

void pls_seal_make(const void *data, size_t size, char seal[PLS_SEAL_SIZE])
{
    print_seal(seal, size, pls_hash(PLS_HASH_START, data, size));
}

/// Why the seal that was found is not the right one.
static pls_status fail_seal(const char *path, const char found[PLS_SEAL_SIZE], uint64_t size)
{
    if (memcmp(found, title, sizeof title - 1) != 0)
    {
        return pls_fail(PLS_CORRUPT, "\"%s\" is damaged, or no checkpoint of particls: it does not begin as one", path);
    }
    int format = 0;
    unsigned long long expected = 0;
    char line[128];
    memcpy(line, found, sizeof line - 1);
    line[sizeof line - 1] = '\0';
    if (sscanf(line + sizeof title - 1, "%d\nbytes behind these 512: %llu", &format, &expected) == 2 && format > FORMAT)
    {
        return pls_fail(PLS_VERSION, "\"%s\" is a checkpoint of format %d, this particls reads format %d: use the particls that wrote it",
                        path, format, FORMAT);
    }
    if (size < expected)
    {
        return pls_fail(PLS_CORRUPT, "\"%s\" is damaged: it is cut off (%llu bytes are there, %llu were written)", path,
                        (unsigned long long)size + PLS_SEAL_SIZE, expected + PLS_SEAL_SIZE);
    }
    return pls_fail(PLS_CORRUPT, "\"%s\" is damaged: its content does not match its checksum", path);
}

pls_status pls_seal_check(const char *path)
{
    FILE *stream = fopen(path, "rb");
    int error = errno;
    if (!stream) return pls_fail(error == ENOENT ? PLS_NOT_FOUND : PLS_IO, "cannot read \"%s\": %s", path, strerror(error));
    pls_status status = PLS_OK;
    char found[PLS_SEAL_SIZE];
    char right[PLS_SEAL_SIZE];
    errno = 0;
    size_t got = fread(found, 1, sizeof found, stream);
    uint64_t size = 0;
    uint64_t hash = 0;
    if (got < sizeof found && errno != 0)
        status = pls_fail(PLS_IO, "cannot read \"%s\": %s", path, strerror(errno));
    else if (got < sizeof found)
        status = pls_fail(PLS_CORRUPT, "\"%s\" is damaged: it has only %zu bytes", path, got);
    else
        status = hash_rest(stream, path, &hash, &size);
    fclose(stream); // only read
    if (status != PLS_OK) return status;
    print_seal(right, size, hash);
    return memcmp(found, right, sizeof found) == 0 ? PLS_OK : fail_seal(path, found, size);
}
