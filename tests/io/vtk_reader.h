// vtk_reader.h -- an independent reader of the arrays of a .vtp file, after the description of the format (VTK file formats, XML, appended data).
#ifndef PLS_TESTS_IO_VTK_READER_H
#define PLS_TESTS_IO_VTK_READER_H

#include "base/atomic_file.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/// Decode the array `name` of the file in `text` into `out`, which has room for `room` bytes. Returns its bytes, or -1 when there is no such array or it is
/// not well-formed.
static inline long read_vtk_array(const char *text, size_t size, const char *name, void *out, size_t room)
{
    char key[128];
    snprintf(key, sizeof key, " Name=\"%s\"", name);
    const char *element = strstr(text, key);
    const char *offset = element ? strstr(element, " offset=\"") : NULL;
    const char *data = strstr(text, "<AppendedData encoding=\"raw\">\n_");
    if (!offset || !data) return -1;
    data += strlen("<AppendedData encoding=\"raw\">\n_") + strtoul(offset + 9, NULL, 10);
    uint64_t head[3]; // blocks, block size, size of the last block if partial
    if (data + sizeof head > text + size) return -1;
    memcpy(head, data, sizeof head);
    const char *sizes = data + sizeof head;
    const char *block = sizes + head[0] * sizeof(uint64_t);
    size_t done = 0;
    for (uint64_t k = 0; k < head[0]; ++k)
    {
        uint64_t packed;
        memcpy(&packed, sizes + k * sizeof packed, sizeof packed);
        uLongf got = (uLongf)(room - done);
        if (block + packed > text + size || uncompress((Bytef *)out + done, &got, (const Bytef *)block, (uLong)packed) != Z_OK) return -1;
        if (got != (k + 1 == head[0] && head[2] ? head[2] : head[1])) return -1;
        done += got;
        block += packed;
    }
    return (long)done;
}

#endif
