// csv.c -- see csv.h.

#include "io/csv.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static pls_status fail_errno(const pls_csv *csv, const char *what, int error)
{
    if (error == ENOSPC || error == EDQUOT || error == EFBIG)
    {
        return pls_fail(
            PLS_DISK_FULL,
            "cannot %s \"%s\": the disk is full, or a quota or file size limit is reached (%s); the rows before are intact: free "
            "space and resume the run",
            what, csv->path, strerror(error));
    }
    return pls_fail(PLS_IO, "cannot %s \"%s\": %s; check that the folder exists and may be written", what, csv->path, strerror(error));
}

/// Text with a comma, a quote or a line break stands in quotes, its quotes doubled (RFC 4180).
static pls_status add_name(pls_text *line, const char *name)
{
    if (!strpbrk(name, ",\"\r\n")) return pls_text_append(line, name, strlen(name));
    PLS_TRY(pls_text_append(line, "\"", 1));
    for (const char *c = name; *c; ++c) PLS_TRY(pls_text_append(line, *c == '"' ? "\"\"" : c, *c == '"' ? 2 : 1));
    return pls_text_append(line, "\"", 1);
}

static pls_status make_first_line(pls_text *line, const pls_csv_column *columns, size_t count)
{
    pls_text name = {0};
    pls_status status = PLS_OK;
    line->size = 0;
    for (size_t k = 0; k < count && status == PLS_OK; ++k)
    {
        name.size = 0;
        status = columns[k].unit[0] ? pls_text_print(&name, "%s [%s]", columns[k].name, columns[k].unit)
                                    : pls_text_print(&name, "%s", columns[k].name);
        if (status == PLS_OK && k > 0) status = pls_text_append(line, ",", 1);
        if (status == PLS_OK) status = add_name(line, name.data);
    }
    if (status == PLS_OK) status = pls_text_append(line, "\n", 1);
    pls_text_free(&name);
    return status;
}

/// Write the whole line. When only a part fits, the part is taken back, so that the file ends with a whole line.
static pls_status write_line(pls_csv *csv)
{
    size_t done = 0;
    while (done < csv->line.size)
    {
        ssize_t written = write(csv->descriptor, csv->line.data + done, csv->line.size - done);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0)
        {
            int error = written < 0 ? errno : EIO;
            if (done > 0 && ftruncate(csv->descriptor, (off_t)csv->size) != 0) return fail_errno(csv, "cut back a torn row of", errno);
            return fail_errno(csv, "write", error);
        }
        done += (size_t)written;
    }
    csv->size += csv->line.size;
    return PLS_OK;
}

static pls_status open_file(pls_csv *csv, const char *path, int flags)
{
    *csv = (pls_csv){.descriptor = -1};
    PLS_TRY(pls_copy_text(&csv->path, path, "a file name"));
    csv->descriptor = open(path, flags | O_CLOEXEC, 0666);
    if (csv->descriptor >= 0) return PLS_OK;
    int error = errno;
    pls_status status = error == ENOENT && !(flags & O_CREAT)
                            ? pls_fail(PLS_CORRUPT, "\"%s\" is gone, though the checkpoint knows of it", path)
                            : fail_errno(csv, "open", error);
    pls_csv_close(csv);
    return status;
}

pls_status pls_csv_create(pls_csv *csv, const char *path, const pls_csv_column *columns, size_t count)
{
    PLS_TRY(open_file(csv, path, O_WRONLY | O_CREAT | O_TRUNC | O_APPEND));
    pls_status status = make_first_line(&csv->line, columns, count);
    if (status == PLS_OK) status = write_line(csv);
    if (status != PLS_OK) pls_csv_close(csv);
    return status;
}

/// Read `size` bytes at `offset`; false when they are not there.
static bool read_at(int descriptor, char *bytes, size_t size, uint64_t offset)
{
    size_t done = 0;
    while (done < size)
    {
        ssize_t got = pread(descriptor, bytes + done, size - done, (off_t)(offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        done += (size_t)got;
    }
    return true;
}

/// Is the file one that this run wrote, at least `size` bytes long, with a line ending there?
static pls_status check_content(pls_csv *csv, uint64_t size)
{
    struct stat there;
    if (fstat(csv->descriptor, &there) != 0) return fail_errno(csv, "read", errno);
    if ((uint64_t)there.st_size < size)
    {
        return pls_fail(PLS_CORRUPT, "\"%s\" has %llu bytes, but had %llu when the checkpoint was written", csv->path,
                        (unsigned long long)there.st_size, (unsigned long long)size);
    }
    char last = 0;
    if (size == 0 || !read_at(csv->descriptor, &last, 1, size - 1) || last != '\n')
    {
        return pls_fail(PLS_CORRUPT, "\"%s\" does not end a line at byte %llu as it did when the checkpoint was written: it was changed",
                        csv->path, (unsigned long long)size);
    }
    char *first = NULL;
    PLS_TRY(pls_allocate(&first, csv->line.size, 1, "the first line of a series"));
    bool same =
        csv->line.size <= size && read_at(csv->descriptor, first, csv->line.size, 0) && memcmp(first, csv->line.data, csv->line.size) == 0;
    pls_release(&first);
    return same ? PLS_OK : pls_fail(PLS_CORRUPT, "\"%s\" has other columns than the run writes: it was changed", csv->path);
}

pls_status pls_csv_reopen(pls_csv *csv, const char *path, uint64_t size, const pls_csv_column *columns, size_t count)
{
    PLS_TRY(open_file(csv, path, O_RDWR | O_APPEND));
    pls_status status = make_first_line(&csv->line, columns, count);
    if (status == PLS_OK) status = check_content(csv, size);
    if (status == PLS_OK && ftruncate(csv->descriptor, (off_t)size) != 0) status = fail_errno(csv, "cut back", errno);
    csv->size = size;
    if (status != PLS_OK) pls_csv_close(csv);
    return status;
}

pls_status pls_csv_row(pls_csv *csv, const double *values, size_t count)
{
    csv->line.size = 0;
    for (size_t k = 0; k < count; ++k)
    {
        char number[32];
        pls_format_double(number, values[k]);
        if (k > 0) PLS_TRY(pls_text_append(&csv->line, ",", 1));
        PLS_TRY(pls_text_append(&csv->line, number, strlen(number)));
    }
    PLS_TRY(pls_text_append(&csv->line, "\n", 1));
    return write_line(csv);
}

pls_status pls_csv_sync(pls_csv *csv)
{
    while (fsync(csv->descriptor) != 0)
    {
        if (errno != EINTR) return fail_errno(csv, "sync", errno);
    }
    return PLS_OK;
}

void pls_csv_close(pls_csv *csv)
{
    if (csv->path && csv->descriptor >= 0) close(csv->descriptor); // every row was written, or its failure told, before
    pls_release(&csv->path);
    pls_text_free(&csv->line);
    *csv = (pls_csv){.descriptor = -1};
}
